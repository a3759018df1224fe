"""Number, kind and stability of the equilibria of a body that is known only within bounds."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from ...errors import InputError
from ...numbers.affine import lifted
from ..equilibria import equilibria
from .box import Box, Point
from .branch_and_bound import Parts, Proof, branch_and_bound, importance, whole
from .conditions import Condition, Unknown, conditions, known
from .result import FEWER, Over, bracketed, by_sample, by_trial
from .search import UNKNOWN, Answer, confirmed, nearest_change


def equilibria_over(box: Box) -> Over:
    """What the box does to the equilibria: their kind, number, and verdicts. See `uncertain.uncertain`."""
    box = _without_state(box)
    answer = partial(signature_at, box)
    here = answer(np.zeros(len(box.places)))
    if not box.places:
        return Over("holds", here, "no uncertain number has a part in the equilibria", proved=np.inf)
    if box.frame is not None:
        return by_sample(box, here, lambda point: (answer(point), np.nan), "within the uncertainties the principal axes turn with the tensor, and no "
                                                                           "proof follows that turn")
    try:
        return _by_conditions(box, here, answer)
    except Unknown as unknown:
        return by_trial(box, here, answer, str(unknown))


def _without_state(box: Box) -> Box:
    keep = lambda numbers: {name: v for name, v in numbers.items() if name != "state"}
    return replace(box, middle=keep(box.middle), half=keep(box.half))


def signature_at(box: Box, point: Point) -> str | None:
    """Kind, number and verdicts of the equilibria at a point, by the ordinary exact code; None where there is no such body."""
    try:
        return signature(equilibria(box.at(point)[0]))
    except InputError:
        return None


def signature(found: Any) -> str:
    """Kind, number and verdicts in words: of points, and of the segments of each curve in order."""
    points = [p.verdict for p in found.points]
    curves = [f"{c.name} ({', '.join(s.verdict for s in c.segments)})" for c in found.curves]
    parts = ([f"{len(points)} isolated: {', '.join(points)}"] if points else []) + curves
    return f"{found.kind}: {'; '.join(parts)}" if parts else found.kind


def _by_conditions(box: Box, here: Any, answer: Answer) -> Over:
    n = len(box.places)
    all_of = partial(_conditions, box)
    first = all_of(np.zeros((1, n)), np.zeros((1, n)))
    signs = [int(np.ravel(c.value.sign)[0]) for c in first]

    def codes(points: np.ndarray) -> np.ndarray:
        with np.errstate(all="ignore"):
            numbers = box.numbers(points, np.zeros_like(points))
            values = [np.broadcast_to(lifted(c.value).c, len(points)) for c in known(conditions(box, numbers))]
            odd = np.broadcast_to(box.impossible(numbers), len(points)) | ~np.all([np.isfinite(v) for v in values], axis=0)
        signs = [np.sign(np.nan_to_num(v)).astype(int) for v, c in zip(values, first) if not c.passes]
        return np.where(odd, UNKNOWN, sum(3**k * (sign + 1) for k, sign in enumerate(signs)))

    if not first:
        return Over("holds", here, "the uncertain numbers have no part in the equilibria", proved=np.inf)
    if 0 in signs:
        vanishing = "; ".join(c.what for c, sign in zip(first, signs) if not sign)
        return by_trial(box, here, answer, f"at the middle itself {vanishing}")
    change = nearest_change(codes, int(codes(np.zeros((1, n)))[0]), n)
    change = change and confirmed(change, lambda p: answer(p) or here, here)
    strict, passing = partial(_proof, all_of, box, first, signs), [c for c in first if c.passes]
    found = bracketed(box, here, answer, change, partial(strict, passes=True),
                      "no quantity that they hang on changes its sign within the box")
    if found.answer != "holds" or not passing or strict(1.0, FEWER).holds:
        return found
    return Over(**{**vars(found), "but": "; ".join(f"where {c.what}" for c in passing)})


def _conditions(box: Box, centres: np.ndarray, widths: np.ndarray, stretch: float = 1.0) -> list[Condition]:
    with np.errstate(all="ignore"):
        return known(conditions(box, box.numbers(centres, widths, stretch)))


def _proof(all_of: Callable[..., list[Condition]], box: Box, first: Any, signs: Any, stretch: float, most: int, passes: bool = False) -> Proof:
    """Whether every condition keeps its sign over the stretched box; passes: but those that may pass through zero."""
    kept = [(k, sign) for k, sign in enumerate(signs) if not (passes and first[k].passes)]

    def judge(parts: Parts) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        values = all_of(parts.centres, parts.widths, stretch)
        none = np.broadcast_to(box.impossible(box.numbers(parts.centres, parts.widths, stretch)), len(parts.angle))
        settled = np.ones(len(none), bool)
        worst, weights = np.full(len(none), np.inf), np.zeros((len(none), len(box.places) + 1)) - 1.0
        for k, sign in kept:
            value = values[k].value
            settled &= value.sign == sign
            clear = np.nan_to_num(value.c * sign / value.reach, nan=-np.inf)
            lower = clear < worst
            share = importance(np.broadcast_to(value.g, parts.widths.shape), np.broadcast_to(value.e, len(none)), parts.widths)
            worst, weights[:, :-1] = np.where(lower, clear, worst), np.where(lower[:, None], share, weights[:, :-1])
        return settled | none, np.zeros(len(none), bool), weights  # contrary cases are the search's to find
    return branch_and_bound(whole(box), judge, most)
