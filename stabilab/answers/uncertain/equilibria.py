"""Equilibria of a body known within bounds.

Their number, kind and stability follow from quantities that keep their sign as long as
these stay the same.

Off the axes: M.y = 0 and M.(D y + lambda) = 0 meet in a line along v = M x D M, on which one quadratic is
left (`gyrostat.isolated_states`); simple roots have n != 0, so they are unstable. On axis i with lambda_i =
0: with s t = K the conic's two coordinates from its centre, times a positive factor

    -(t^2/kappa) m = p t^4 + P t^3 + Q K t + q K^2,   P = p0 - p sigma/kappa,   Q = q0 - q rho/kappa,

so folds neither meet, nor pass the poles t = 0 and infinity, nor change in number while p, q, K and the
discriminant keep their signs. Numbers are of any kind; one that vanishes for every body of the box is exactly
0 and makes its own case."""
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
from ...reasons import Axis, Reason, Sentence
from ..equilibria import equilibria
from .boxes import Box, Numbers, Point, present
from .branch_and_bound import Parts, Proof, branch_and_bound, importance, whole
from .result import (
    FEWER,
    UNKNOWN,
    Answer,
    Look,
    Over,
    bracketed,
    nearest_change,
)
from .search import FEW, by_sample, by_trial
from .verdicts import joined

# --- What happens where a condition of the equilibria vanishes
TORQUE_VANISHES = Sentence("torque-vanishes", "the torque about {axis} vanishes")
MOMENTUM_VANISHES = Sentence("momentum-vanishes", "the gyrostatic moment along {axis} vanishes")
TWO_EQUAL = Sentence("two-moments-equal", "moments {first} and {second} are equal")
TORQUE_ON_AXIS = Sentence("torque-falls-on-axis", "the torque comes to lie along a principal axis")()
ONE_AT_INFINITY = Sentence("one-through-infinity",
                           "one of the equilibria passes through infinity")()
ONLY_AT_INFINITY = Sentence("only-one-through-infinity", "the equilibrium passes through infinity")()
FOLD = Sentence("two-meet-in-fold", "two equilibria meet in a fold")()
LINE_APPEARS = Sentence("line-appears", "a line of equilibria appears")()
ACROSS_EQUAL = Sentence("moments-across-equal", "the two moments across the torque are equal")()
HYPERBOLA_SPLITS = Sentence("hyperbola-splits",
                            "the hyperbola of equilibria falls apart into two lines")()
FOLD_AT_INFINITY = Sentence("fold-through-infinity", "a fold passes through infinity")()
SOME_EQUAL = Sentence("some-moments-equal", "two moments are equal")()
FOLDS_MEET = Sentence("folds-meet", "two folds meet and vanish")()
ACROSS_VANISHES = Sentence("momentum-across-vanishes",
                           "the gyrostatic moment across the torque vanishes")()
ALL_EQUAL = Sentence("all-moments-equal", "all three moments are equal")()
LINE_CHANGES = Sentence("line-changes-stability", "the whole line changes its stability")()
# --- How the equilibria over a box are known
FREE_WITH_WHEEL = Sentence(
    "free-with-wheel-over-box", "without a torque, and with a gyrostatic moment, the stability along the "
    "curve of equilibria is not followed over a box")()
EQUAL_PLANE = Sentence("torque-across-equal-moments",
                       "the torque lies across the axes in the plane of two equal moments")()
NONE_OF_EQUILIBRIA = Sentence("none-for-equilibria",
                              "no uncertain number has a part in the equilibria")()
NO_PART = Sentence("no-part-in-equilibria", "the uncertain numbers have no part in the equilibria")()
AXES_TURN = Sentence("axes-turn-over-box", "within the uncertainties the principal axes turn with the "
                     "tensor, and no proof follows that turn")()
AT_MIDDLE = Sentence("vanishes-at-middle", "at the middle itself {what}")
SIGNS_STAY = Sentence("signs-stay", "no quantity that they hang on changes its sign within the box")()
WHERE = Sentence("but-where", "where {what}")


# --- Equilibria
class Condition(NamedTuple):
    """value: keeps its sign where nothing changes; what: what happens where it vanishes. passes: True where
    the answer is the same on both sides of that surface, and only on the surface itself another."""

    value: Number
    what: Reason
    passes: bool = False


class Unknown(Exception):
    """Scenes whose equilibria have no such list here; reason: which."""

    def __init__(self, reason: Reason) -> None:
        super().__init__(str(reason))
        self.reason = reason


def conditions(box: Box, numbers: Numbers) -> list[Condition]:
    """The conditions of a box, for numbers of any kind (`Box.numbers`). Raises Unknown."""
    form = box.rates(numbers)
    acting = [i for i in range(3) if present(form.m[i])]
    D, lam, M = _balance(box, numbers, form)
    if not acting:
        return _free(D, lam)
    torque = [Condition(M[i], TORQUE_VANISHES(axis=Axis(i + 1))) for i in acting]
    if len(acting) > 1:
        return _off_axis(D, lam, M, acting)
    axis = acting[0]
    if present(lam[axis]):
        return torque + [Condition(lam[axis], MOMENTUM_VANISHES(axis=Axis(axis + 1)))]
    reduction: Any = reduction_about(form, axis)  # a torque on an axis without momentum along it has one
    return torque + (_conic(reduction) if present(reduction.kappa) else _line(reduction))


def known(result: list[Condition]) -> list[Condition]:
    """Those whose value depends on uncertain numbers."""
    return [c for c in result if isinstance(c.value, Affine)]


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
        raise Unknown(FREE_WITH_WHEEL)
    pairs = [(i, j) for i, j in ((0, 1), (1, 2), (2, 0)) if present(D[i] - D[j])]
    return [Condition(D[i] - D[j], TWO_EQUAL(first=i + 1, second=j + 1)) for i, j in pairs]


def _off_axis(D: Sequence[Number], lam: Sequence[Number], M: Sequence[Number],
              acting: Sequence[int]) -> list[Condition]:
    """Of a torque about several axes: the signs of the quadratic on the line along v."""
    if not any(present(D[i] - D[acting[0]]) for i in acting[1:]):
        raise Unknown(EQUAL_PLANE)
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
    plane = Condition(area, TORQUE_ON_AXIS)
    if present(q2):
        return [plane, Condition(q2, ONE_AT_INFINITY, True),
                Condition(squared(q1) - 4 * (q2 * q0), FOLD)]
    if present(q1):
        return [plane, Condition(q1, ONLY_AT_INFINITY, True)]
    return [plane, Condition(q0, LINE_APPEARS)]


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
    rows = [Condition(k, ACROSS_EQUAL),
             Condition(N, HYPERBOLA_SPLITS)]
    for lead, low in ((p, P), (q, Q)):
        rows += [Condition(value, FOLD_AT_INFINITY if value is low else SOME_EQUAL)
                  for value in (lead if present(lead) else low,) if present(value)]
    return rows + ([Condition(disc, FOLDS_MEET)] if present(disc) else [])


def _line(r: Reduction) -> list[Condition]:
    """The line of equilibria where the two moments across the torque are equal (kappa = 0)."""
    across = squared(r.rho) + squared(r.sigma)
    if not present(across):
        return []
    rows = [Condition(across, ACROSS_VANISHES)]
    if present(r.p):
        return rows + [Condition(r.p, ALL_EQUAL)]
    level = r.rho * r.q0 + r.sigma * r.p0
    return rows + ([Condition(level, LINE_CHANGES)] if present(level) else [])


def equilibria_over(box: Box) -> Over:
    """What the box does to the equilibria: their kind, number, and verdicts. See `uncertain.uncertain`."""
    middle, half = ({name: numbers for name, numbers in of.items() if name != "state"}
                    for of in (box.middle, box.half))
    box = replace(box, middle=middle, half=half)
    look = lambda point: (signature_at(box, point), np.nan)
    here, _ = look(np.zeros(len(box.places)))
    if not box.places:
        return Over("holds", here, reason=NONE_OF_EQUILIBRIA, proved=np.inf)
    if box.frame is not None:
        return by_sample(box, here, look, AXES_TURN, FEW)
    try:
        return _by_conditions(box, here, look)
    except Unknown as unknown:
        return by_trial(box, here, look, unknown.reason, most=FEW)


def signature_at(box: Box, point: Point) -> str | None:
    """Kind, number and verdicts of the equilibria at a point, by the ordinary exact code; None where there is
    no such body."""
    try:
        return signature(equilibria(box.at(point)[0]))
    except InputError:
        return None


def signature(result: Any) -> str:
    """Kind, number and verdicts in words: of points, and of the segments of each curve in order."""
    points = [p.verdict for p in result.points]
    curves = [f"{c.name} ({', '.join(s.verdict for s in c.segments)})" for c in result.curves]
    parts = ([f"{len(points)} isolated: {', '.join(points)}"] if points else []) + curves
    return f"{result.kind}: {'; '.join(parts)}" if parts else result.kind


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
        return Over("holds", here, reason=NO_PART, proved=np.inf)
    if 0 in signs:
        vanishing = joined((c.what for c, sign in zip(first, signs) if not sign), "; ")
        return by_trial(box, here, look, AT_MIDDLE(what=vanishing), most=FEW)
    answer: Answer = lambda point: look(point)[0]
    change = nearest_change(box, codes, answer, here)
    strict, passing = partial(_proof, all_of, box, first, signs), [c for c in first if c.passes]
    result = bracketed(box, here, answer, change, partial(strict, passes=True), SIGNS_STAY)
    if result.answer != "holds" or not passing or strict(1.0, FEWER).holds:
        return result
    return replace(result, exception=joined((WHERE(what=c.what) for c in passing), "; "))


def _conditions(box: Box, centres: np.ndarray, widths: np.ndarray, stretch: float = 1.0) -> list[Condition]:
    with np.errstate(all="ignore"):
        return known(conditions(box, box.numbers(centres, widths, stretch)))


def _proof(all_of: Callable[..., list[Condition]], box: Box, first: Any, signs: Any, stretch: float,
           largest: int, passes: bool = False) -> Proof:
    """Whether every condition keeps its sign over the stretched box; passes: but those that may pass through
    zero."""
    retained = [(k, sign) for k, sign in enumerate(signs) if not (passes and first[k].passes)]

    def judge(parts: Parts) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        values = all_of(parts.centres, parts.widths, stretch)
        none = np.broadcast_to(box.impossible(box.numbers(parts.centres, parts.widths, stretch)),
                               len(parts.angle))
        settled = np.ones(len(none), bool)
        worst, weights = np.full(len(none), np.inf), np.zeros((len(none), len(box.places) + 1)) - 1.0
        for k, sign in retained:
            value = values[k].value
            settled &= value.sign == sign
            clear = np.nan_to_num(value.c * sign / value.reach, nan=-np.inf)
            lower = clear < worst
            fraction = importance(np.broadcast_to(value.g, parts.widths.shape),
                               np.broadcast_to(value.e, len(none)), parts.widths)
            worst = np.where(lower, clear, worst)
            weights[:, :-1] = np.where(lower[:, None], fraction, weights[:, :-1])
        return settled | none, np.zeros(len(none), bool), weights  # contrary cases are the search's to find
    return branch_and_bound(whole(box), judge, largest)
