"""Number, kind and stability of the equilibria of a body that is known only within bounds, by quantities that
keep their sign as long as these stay the same.

Off the axes: M.y = 0 and M.(D y + lambda) = 0 meet in a line along v = M x D M, on which one quadratic is
left (`isolated_equilibria`); simple roots have n != 0, so they are unstable. On axis i with lambda_i = 0:
with s t = K the conic's two coordinates from its centre, times a positive factor

    -(t^2/kappa) m = p t^4 + P t^3 + Q K t + q K^2,   P = p0 - p sigma/kappa,   Q = q0 - q rho/kappa,

so folds neither meet, nor pass the poles t = 0 and infinity, nor change in number while p, q, K and the
discriminant keep their signs. Numbers are of any kind; one that vanishes for every body of the box is exactly
0 and makes its own case.
"""
from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from ...errors import InputError
from ...numbers.affine import Affine, lifted, squared
from ...numbers.vectors import CYCLE, Number, Triple, cross, dot
from ...orbit.reduction import Reduction, reduction_about
from ...physics.scene import QuadraticForm
from ..equilibria import equilibria
from .box import Box, Numbers, Point, present
from .branch_and_bound import Parts, Proof, branch_and_bound, importance, whole
from .result import FEWER, UNKNOWN, Answer, Look, Over, bracketed, by_sample, by_trial, nearest_change


class Condition(NamedTuple):
    """value: keeps its sign where nothing changes; what: what happens where it vanishes. passes: True where
    the answer is the same on both sides of that surface, and only on the surface itself another."""

    value: Number
    what: str
    passes: bool = False


class Unknown(Exception):
    """Scenes whose equilibria have no such list here; the text says which."""


def conditions(box: Box, numbers: Numbers) -> list[Condition]:
    """The conditions of a box, for numbers of any kind (`Box.numbers`). Raises Unknown."""
    form = box.rates(numbers)
    acting = [i for i in range(3) if present(form.m[i])]
    D, lam, M = _balance(box, numbers, form)
    if not acting:
        return _free(D, lam)
    torque = [Condition(M[i], f"the torque about axis {i + 1} vanishes") for i in acting]
    if len(acting) > 1:
        return _off_axis(D, lam, M, acting)
    axis = acting[0]
    if present(lam[axis]):
        return torque + [Condition(lam[axis], f"the gyrostatic moment along axis {axis + 1} vanishes")]
    reduction: Any = reduction_about(form, axis)  # a torque on an axis without momentum along it has one
    return torque + (_conic(reduction) if present(reduction.kappa) else _line(reduction))


def known(found: list[Condition]) -> list[Condition]:
    """Those whose value hangs on uncertain numbers."""
    return [c for c in found if isinstance(c.value, Affine)]


def _balance(box: Box, numbers: Numbers, form: QuadraticForm) -> tuple[Triple, Triple, Triple]:
    """(D, lambda, M) of (D y + lambda) x y + M = 0 (`pencil`)."""
    if box.variables == "physical":
        D = numbers["inertia"]
        return D, numbers["momentum"], tuple(d * m for d, m in zip(D, form.m))
    b, a = form.rho[2], -form.sigma[1]
    zero, half = Fraction(0), Fraction(1, 2)
    return (half, zero, Fraction(1)), ((b - a) * half, zero, zero), form.m


def _free(D: Sequence[Number], lam: Sequence[Number]) -> list[Condition]:
    if any(map(present, lam)):
        raise Unknown("without a torque, and with a gyrostatic moment, the stability along the curve of "
                      "equilibria is not followed over a box")
    pairs = [(i, j) for i, j in ((0, 1), (1, 2), (2, 0)) if present(D[i] - D[j])]
    return [Condition(D[i] - D[j], f"moments {i + 1} and {j + 1} are equal") for i, j in pairs]


def _off_axis(D: Sequence[Number], lam: Sequence[Number], M: Sequence[Number],
              acting: Sequence[int]) -> list[Condition]:
    """Of a torque about several axes: the signs of the quadratic on the line along v."""
    if not any(present(D[i] - D[acting[0]]) for i in acting[1:]):
        raise Unknown("the torque lies across the axes in the plane of two equal moments")
    gaps = [D[j] - D[k] for j, k in CYCLE]
    v = [-(M[j] * M[k] * gaps[i]) for i, (j, k) in enumerate(CYCLE)]
    area = sum((squared(c) for c in v), Fraction(0))
    DM, load = [d * m for d, m in zip(D, M)], dot(lam, M)
    foot = [load * (dot(M, DM) * m - dot(M, M) * dm) / area if present(load) else load
            for m, dm in zip(M, DM)]
    pair = lambda x, y: sum((M[i] * gaps[i] * x[j] * y[k] for i, (j, k) in enumerate(CYCLE)), Fraction(0))
    turn = lambda x: dot(M, cross(lam, x))
    q2, q1 = pair(v, v), pair(v, foot) + pair(foot, v) + turn(v)
    q0 = pair(foot, foot) + turn(foot) + sum((squared(m) for m in M), Fraction(0))
    plane = Condition(area, "the torque comes to lie along a principal axis")
    if present(q2):
        return [plane, Condition(q2, "one of the equilibria passes through infinity", True),
                Condition(squared(q1) - 4 * (q2 * q0), "two equilibria meet in a fold")]
    if present(q1):
        return [plane, Condition(q1, "the equilibrium passes through infinity", True)]
    return [plane, Condition(q0, "a line of equilibria appears")]


def _conic(r: Reduction) -> list[Condition]:
    """The conic of a torque on a principal axis with two different moments across it."""
    k, p, q = r.kappa, r.p, r.q
    N = r.rho * r.sigma - r.m * k                  # kappa^2 K
    P, Q = k * r.p0 - p * r.sigma, k * r.q0 - q * r.rho   # times kappa
    PQ, P2, Q2 = P * Q, squared(P), squared(Q)
    # discriminant over K^3, times kappa^6
    first = 256 * (p * q) * squared(p * q) * squared(N) - 192 * (squared(p * q) * PQ * N)
    second = 27 * squared(p * Q2) + 6 * (p * q) * (P2 * Q2) + 27 * squared(q * P2)
    disc = (first - second) * N - 4 * PQ * squared(PQ)
    found = [Condition(k, "the two moments across the torque are equal"),
             Condition(N, "the hyperbola of equilibria falls apart into two lines")]
    for lead, low in ((p, P), (q, Q)):
        found += [Condition(value, "a fold passes through infinity" if value is low
                            else "two moments are equal")
                  for value in (lead if present(lead) else low,) if present(value)]
    return found + ([Condition(disc, "two folds meet and vanish")] if present(disc) else [])


def _line(r: Reduction) -> list[Condition]:
    """The line of equilibria where the two moments across the torque are equal (kappa = 0)."""
    across = squared(r.rho) + squared(r.sigma)
    if not present(across):
        return []
    found = [Condition(across, "the gyrostatic moment across the torque vanishes")]
    if present(r.p):
        return found + [Condition(r.p, "all three moments are equal")]
    level = r.rho * r.q0 + r.sigma * r.p0
    return found + ([Condition(level, "the whole line changes its stability")] if present(level) else [])


def equilibria_over(box: Box) -> Over:
    """What the box does to the equilibria: their kind, number, and verdicts. See `uncertain.uncertain`."""
    middle, half = ({name: numbers for name, numbers in of.items() if name != "state"}
                    for of in (box.middle, box.half))
    box = replace(box, middle=middle, half=half)
    look = lambda point: (signature_at(box, point), np.nan)
    here, _ = look(np.zeros(len(box.places)))
    if not box.places:
        return Over("holds", here, "no uncertain number has a part in the equilibria", proved=np.inf)
    if box.frame is not None:
        return by_sample(box, here, look, "within the uncertainties the principal axes turn with the tensor, "
                                          "and no proof follows that turn")
    try:
        return _by_conditions(box, here, look)
    except Unknown as unknown:
        return by_trial(box, here, look, str(unknown))


def signature_at(box: Box, point: Point) -> str | None:
    """Kind, number and verdicts of the equilibria at a point, by the ordinary exact code; None where there is
    no such body."""
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


def _by_conditions(box: Box, here: Any, look: Look) -> Over:
    """As long as every condition keeps its sign the equilibria stay as they are: how far the box may be
    stretched before one may change it."""
    n = len(box.places)
    all_of = partial(_conditions, box)
    first = all_of(np.zeros((1, n)), np.zeros((1, n)))
    signs = [int(np.ravel(c.value.sign)[0]) for c in first]

    def codes(points: np.ndarray) -> np.ndarray:
        with np.errstate(all="ignore"):
            numbers = box.numbers(points, np.zeros_like(points))
            values = [np.broadcast_to(lifted(c.value).c, len(points))
                      for c in known(conditions(box, numbers))]
            odd = (np.broadcast_to(box.impossible(numbers), len(points))
                   | ~np.all([np.isfinite(v) for v in values], axis=0))
        signs = [np.sign(np.nan_to_num(v)).astype(int) for v, c in zip(values, first) if not c.passes]
        return np.where(odd, UNKNOWN, sum(3**k * (sign + 1) for k, sign in enumerate(signs)))

    if not first:
        return Over("holds", here, "the uncertain numbers have no part in the equilibria", proved=np.inf)
    if 0 in signs:
        vanishing = "; ".join(c.what for c, sign in zip(first, signs) if not sign)
        return by_trial(box, here, look, f"at the middle itself {vanishing}")
    answer: Answer = lambda point: look(point)[0]
    change = nearest_change(box, codes, answer, here)
    strict, passing = partial(_proof, all_of, box, first, signs), [c for c in first if c.passes]
    found = bracketed(box, here, answer, change, partial(strict, passes=True),
                      "no quantity that they hang on changes its sign within the box")
    if found.answer != "holds" or not passing or strict(1.0, FEWER).holds:
        return found
    return Over(**{**vars(found), "but": "; ".join(f"where {c.what}" for c in passing)})


def _conditions(box: Box, centres: np.ndarray, widths: np.ndarray, stretch: float = 1.0) -> list[Condition]:
    with np.errstate(all="ignore"):
        return known(conditions(box, box.numbers(centres, widths, stretch)))


def _proof(all_of: Callable[..., list[Condition]], box: Box, first: Any, signs: Any, stretch: float,
           most: int, passes: bool = False) -> Proof:
    """Whether every condition keeps its sign over the stretched box; passes: but those that may pass through
    zero."""
    kept = [(k, sign) for k, sign in enumerate(signs) if not (passes and first[k].passes)]

    def judge(parts: Parts) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        values = all_of(parts.centres, parts.widths, stretch)
        none = np.broadcast_to(box.impossible(box.numbers(parts.centres, parts.widths, stretch)),
                               len(parts.angle))
        settled = np.ones(len(none), bool)
        worst, weights = np.full(len(none), np.inf), np.zeros((len(none), len(box.places) + 1)) - 1.0
        for k, sign in kept:
            value = values[k].value
            settled &= value.sign == sign
            clear = np.nan_to_num(value.c * sign / value.reach, nan=-np.inf)
            lower = clear < worst
            share = importance(np.broadcast_to(value.g, parts.widths.shape),
                               np.broadcast_to(value.e, len(none)), parts.widths)
            worst = np.where(lower, clear, worst)
            weights[:, :-1] = np.where(lower[:, None], share, weights[:, :-1])
        return settled | none, np.zeros(len(none), bool), weights  # contrary cases are the search's to find
    return branch_and_bound(whole(box), judge, most)
