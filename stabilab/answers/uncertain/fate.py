"""What a body known within bounds does: the fate of its motion, and the number, kind and stability of its
equilibria.

A case may state inertia, gyrostatic moment, torque and state with half-widths; together they span a box. For
the whole box a verdict holds (proved), or it depends (with a point of the box on each side), or it stays
undecided (with the reason); and the smallest change that flips it is bracketed: proved to be safe below one
factor of the stated uncertainties, seen to flip at another.

The number, kind and stability of the equilibria follow from quantities that keep their sign as long as
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
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from ...errors import Caveat, InputError, Kind, refusal_of
from ...numbers.affine import Affine, lifted, sign_over, squared
from ...numbers.vectors import CYCLE, Number, Triple, cross, dot
from ...orbit.fate import REASONS, Basis, fate_of
from ...orbit.one_orbit import Orbit
from ...orbit.potential import derivatives_on_parabola
from ...orbit.reduction import Reduction, reduce, reduction_about
from ...orbit.result import Fate
from ...physics.scene import QuadraticForm
from ...reasons import Axis, Reason, Sentence
from ..equilibria import equilibria
from ..kinds import kind_of
from ..motions.rows import fates
from .boxes import (
    Box,
    Family,
    Numbers,
    Parts,
    Point,
    Proof,
    box_of,
    branch_and_bound,
    importance,
    orbit_of,
    present,
    prove,
    whole,
)
from .geometries import codes as codes_of
from .geometries import deepest
from .geometries import margins as margins_of
from .neighbours import beside
from .result import (
    FEWER,
    STRETCHES,
    UNKNOWN,
    Answer,
    Change,
    Look,
    Over,
    Witness,
    bracketed,
    confirmed,
    nearest_change,
    worst,
)
from .search import FEW, by_sample, by_trial
from .verdicts import SPIN_UPS, joined, reason_of

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

# --- How the fate over a box is known
OFF_AXES = Sentence(
    "torque-off-axes-over-box", "the torque may act about {axes} together, off the principal axes, where "
    "motions are followed one by one: the middle's answer is no proof for the box")
GEOMETRY_CHANGES = Sentence(
    "geometry-changes-over-box", "two of the moments of inertia may be equal within the box, where the "
    "geometry of the motion changes from circles to hyperbolas: no proof is known")()
ON_SEPARATRIX = Sentence("middle-on-separatrix", "the middle lies on the separatrix itself")()
ON_SADDLE = Sentence("middle-on-saddle",
                     "the middle is bounded as it is, at rest on a saddle or without a torque")()
ONE_SIDE = Sentence("one-side-found", "and only one side of it was found")()
MEASURE_ZERO = Sentence("middle-of-measure-zero", "the middle lies on a set of measure zero, and no proof "
                        "covers what is around it")()
SAME_FORCE = Sentence("same-force-along-parabola", "where the force is the same all along the parabola, "
                      "nothing holds the spin back")()
ON_PLANE = Sentence("box-on-plane", "every motion of the box lies on an invariant plane Q = 0, where a "
                    "barrier decides, and the plane's motions are not followed over a box")()
MEETS_PLANE = Sentence("box-meets-plane", "the box meets an invariant plane Q = 0, where a motion may spin "
                       "up or tend to a saddle")()
AXIS_OPEN = Sentence("axis-open-over-box", "the axis it ends about is not followed over the box")()
MAY_VANISH = Sentence(
    "momentum-may-vanish", "the gyrostatic moment along {axis}, the torque's, may vanish or not: where it "
    "does not, there is no reduction to one degree of freedom, and no motion is bounded")
OBSERVED_START = Sentence(
    "box-of-observed-start", "what uncertain numbers do to the fate under a torque is known of a start in "
    "rates alone, and this one is stated as it is observed; stabilab sweep --samples draws from them")()
BY_SAMPLES = Sentence("box-by-samples",
                      "{question} over the uncertain numbers by samples, not by proof: {found}")
ELSEWHERE = Sentence("box-elsewhere", "within the uncertainties {what}")
NOT_THE_SAME = Sentence("box-not-the-same",
                        "{question} not the same for all that the uncertain numbers may be: also {others}")
LEFT_OPEN = Sentence("box-undecided", "{question} undecided over the uncertain numbers: {why}")


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


# --- The fate
UNBOUNDED = "unbounded"


def fate_over(box: Box) -> Over | None:
    """What becomes of the motion over the box; None where the box has no state. See `uncertain.uncertain`.

    A box around an equilibrium is judged by its neighbours too: `neighbours.beside`."""
    return beside(box, _fate_over(box)) if "state" in box.middle else None


def _fate_over(box: Box) -> Over:
    look = partial(look_at, box)
    answer: Answer = lambda point: look(point)[0]
    if box.frame is not None:
        return by_sample(box, answer(np.zeros(len(box.places))), look, AXES_TURN)
    numbers = _root(box)
    form = box.rates(numbers)
    acting = [i for i in range(3) if present(form.m[i])]
    here = answer(np.zeros(len(box.places)))
    if not acting:
        return Over("holds", here, reason=REASONS[Basis.TORQUE_FREE], proved=np.inf)
    if len(acting) > 1:
        reason = OFF_AXES(axes=tuple(Axis(i + 1) for i in acting))
        within = _on_an_axis(box, form, acting)
        if within is not None and within.answer == "depends":
            return replace(within, reason=reason.then(within.reason), proved=0.0)
        return by_sample(box, here, look, reason, FEW)
    reduction = reduction_about(form, acting[0])
    if reduction is None:
        return _under_law(box, look, numbers, form, acting[0])
    signs = _signs(reduction)
    if signs is None:
        return by_trial(box, here, look, GEOMETRY_CHANGES, _over_geometries(box, here, answer, acting[0]))
    if signs[0] * signs[1] >= 0:
        return _between_walls(box, here, look, reduction, numbers, signs)
    return _on_circles(box, here, answer, Family(box, acting[0], signs))


def _on_an_axis(box: Box, form: QuadraticForm, acting: Sequence[int]) -> Over | None:
    """What the part of the box says in which the torque stays on the axis of the middle's: its witnesses are
    in the box. None where there is no such part."""
    name = "torque" if "torque" in box.middle else "mu"
    held = [i for i in range(3) if not box.middle[name][i]]
    if len(held) != 2:
        return None
    half = {**box.half, name: tuple(Fraction(0) if i in held else h for i, h in enumerate(box.half[name]))}
    part = replace(box, half=half)
    return _fate_over(part) if part.places else None


def _over_geometries(box: Box, here: Any, answer: Answer, axis: int) -> Change | None:
    """The nearest change that a search over arrays finds where the moments may change places."""
    codes, n = partial(codes_of, box, axis), len(box.places)
    if (int(codes(np.zeros((1, n)))[0]) == 0) != (here == Fate.BOUNDED.word):
        return None
    margins = _sided(partial(margins_of, box, axis), 1 if here == Fate.BOUNDED.word else -1)
    point = deepest(margins, n)
    result = nearest_change(box, codes, answer, here, [point / (np.abs(point).max() or 1.0)])
    if (result is None or result.stretch > 1) and not margins(point[None])[0] > 0:
        size = float(np.abs(point).max())
        result = confirmed(Change(point / size, size, 0.0), answer, here)
    return result


def _sided(margins: Callable[..., Any], side: int) -> Callable[[np.ndarray], np.ndarray]:
    """The margins of points, of the given sign at the middle, as numbers that fall towards a change; NaN
    where there is none."""
    def found(points: np.ndarray) -> np.ndarray:
        margin, _, possible = margins(points)
        return np.where(possible, side * margin, np.nan)
    return found


def look_at(box: Box, point: Point) -> tuple[str | None, float]:
    """(fate at a point of the box by the ordinary exact code, None where there is no such body; barrier minus
    energy, NaN where the motion has none)."""
    try:
        scene, state = box.at(point)
    except InputError:
        return None, np.nan
    if kind_of(scene) == "growth":
        return UNBOUNDED, np.nan  # about which axis is a question for a run, not for the law
    reduction = reduce(scene)
    if reduction is None:
        item = fates(scene, np.array(state))
        return words(Fate(int(item.labels)), int(item.axis), int(item.sense)), float(item.margins)
    # asked of boxes that have a state
    result = fate_of(scene, Orbit(reduction, state))  # type: ignore[arg-type]
    return words(result.label, result.axis, result.sense), result.margin


def words(label: Fate, axis: int, sense: int) -> str:
    """A fate in words; a state at rest is bounded."""
    if label == Fate.EQUILIBRIUM:
        return Fate.BOUNDED.word
    if label == Fate.SPIN_UP and axis:
        return str(SPIN_UPS[axis, 1 if sense > 0 else -1])
    return label.word


def _root(box: Box, stretch: float = 1.0) -> Any:
    n = len(box.places)
    with np.errstate(all="ignore"):
        return box.numbers(np.zeros((1, n)), np.ones((1, n)), stretch)


def _sign(number: Number) -> int:
    """Over the whole box; 0 where it is open."""
    return int(np.ravel(sign_over(number))[0])


def _signs(r: Reduction) -> tuple[int, ...] | None:
    """(sign of p, sign of q) over the whole box, or None."""
    signs = [_sign(v) for v in (r.p, r.q)]
    return None if any(s == 0 and present(v) for s, v in zip(signs, (r.p, r.q))) else tuple(signs)


# -- circles


def _on_circles(box: Box, here: Any, answer: Answer, family: Family) -> Over:
    """Elliptic reduction: bounded iff a barrier stands ahead."""
    claim = "bounded" if here == Fate.BOUNDED.word else "spin-up"

    def codes(points: np.ndarray) -> np.ndarray:
        margin, sense, possible = family.margins(points)
        return np.where(possible, np.where(margin > 0, 0, sense), UNKNOWN)

    def attempt(stretch: float, largest: int) -> Proof:
        senses = _senses(box, family, stretch)
        if senses is None or (claim == "spin-up" and len(senses) > 1):
            return Proof(None, 0)
        return prove(family, claim, senses, stretch, largest)

    steady = int(codes(np.zeros((1, len(box.places))))[0]) == 0
    if here == Fate.SEPARATRIX.word or steady != (claim == "bounded"):
        return _tie(box, here, answer, _against_gradient(family))
    favoured = [*_against_gradient(family),
                worst(_sided(family.margins, 1 if steady else -1), len(box.places))]
    change = nearest_change(box, codes, answer, here, favoured)
    return bracketed(box, here, answer, change, attempt,
                     REASONS[Basis.BELOW_BARRIER if claim == "bounded" else Basis.ABOVE_BARRIER])


def _tie(box: Box, here: Any, answer: Answer, corners: Sequence[np.ndarray]) -> Over:
    """The middle lies on the separatrix (or at rest on a saddle): what lies on either side."""
    n = len(box.places)
    reason = ON_SEPARATRIX if here == Fate.SEPARATRIX.word else ON_SADDLE
    sides: dict[str, Any] = {}
    for stretch in STRETCHES:
        for direction in (*corners, *np.eye(n), *-np.eye(n)):
            word = answer(direction * stretch)
            if word not in (None, Fate.SEPARATRIX.word):
                sides.setdefault(word, Witness(word, box.values(direction * stretch)))
        if len(sides) > 1:
            return Over("depends", here, reason=reason, changes_at=0.0, witnesses=tuple(sides.values()))
    other = sides.get(next((word for word in sides if word != here), ""))
    if other and here != Fate.SEPARATRIX.word:
        middle = Witness(here, box.values(np.zeros(n)))
        return Over("depends", here, reason=reason, changes_at=0.0, witnesses=(middle, other))
    return Over("undecided", here, reason=reason.then(ONE_SIDE, ", "))


def _senses(box: Box, family: Family, stretch: float) -> tuple[int, ...] | None:
    """Signs the torque may have over the box, (1,), (-1,) or (1, -1); None where the geometry itself may
    change."""
    with np.errstate(all="ignore"):
        numbers = _root(box, stretch)
        r = reduction_about(box.rates(numbers), family.axis)
        if r is None or _signs(r) != family.signs:
            return None
        sign = _sign(r.m)
    return (sign,) if sign else (1, -1)


def _against_gradient(family: Family) -> tuple[np.ndarray, np.ndarray]:
    """The corners towards which the margin falls and rises fastest."""
    n, step = len(family.box.places), 1e-4
    ahead, behind = (family.margins(s * step * np.eye(n))[0] for s in (1, -1))
    slope = np.nan_to_num(ahead - behind)
    corner = np.where(slope > 0, 1.0, -1.0)
    return corner, -corner


# -- hyperbolas and parabolas


def _between_walls(box: Box, here: Any, look: Look, r: Reduction, numbers: Numbers, signs: Any) -> Over:
    """The potential grows on both sides: bounded, but for a set of measure zero."""
    state, curved = numbers["state"], bool(signs[0] * signs[1])
    # they vanish where nothing holds a spin back: a pure one, or one force all along the parabola
    loose = ([state[n] + shift for n, shift in zip((r.j, r.k), r.centre)] if curved
             else derivatives_on_parabola(r, state[r.j], state[r.k]))
    if here != Fate.BOUNDED.word:
        if not any(map(present, loose)) and here.startswith("spin-up") and _sign(r.m):
            return Over("holds", here, reason=REASONS[Basis.PURE_SPIN], proved=1.0)
        return by_trial(box, here, look, MEASURE_ZERO)
    if not curved:
        return Over("holds", here, reason=REASONS[Basis.WALLS], proved=1.0, exception=SAME_FORCE)
    u, v = loose
    certain = not any(isinstance(n, Affine) for n in (u, v, r.p, r.q))
    if certain and v * v * abs(r.p) == u * u * abs(r.q):
        return by_sample(box, here, look, ON_PLANE)
    with np.errstate(all="ignore"):
        orbit = orbit_of(r, state, signs)
        clear = all(_sign(lifted(side)) for side in (orbit.x + orbit.z, orbit.x - orbit.z))
    return Over("holds", here, reason=REASONS[Basis.WALLS], proved=1.0,
                exception=None if clear else MEETS_PLANE)


# -- no reduction


def _under_law(box: Box, look: Look, numbers: Numbers, form: QuadraticForm, axis: int) -> Over:
    """A gyrostatic moment along the torque: |H|^2/2 - D_i T grows at the rate lambda_i M_i."""
    along = numbers["momentum"][axis] if box.variables == "physical" else -form.sigma[1] - form.rho[2]
    if _sign(along * form.m[axis]):
        return Over("holds", UNBOUNDED, reason=REASONS[Basis.UNBOUNDED_LAW].then(AXIS_OPEN), proved=1.0)

    def whether(point: Point) -> tuple[str | None, float]:
        word, _ = look(point)
        return UNBOUNDED if word and word.startswith("spin-up") else word, np.nan
    return by_trial(box, whether(np.zeros(len(box.places)))[0], whether,
                    MAY_VANISH(axis=Axis(axis + 1)))


@dataclass(frozen=True)
class Uncertainty:
    """numbers: the uncertain numbers of the case; equilibria, fate: what they do to each, None where not
    asked (and the fate where there is no state). caveats: what else there is, where it is not the same all
    over, and that samples stand in place of a proof, where they do."""

    numbers: tuple[Any, ...]
    equilibria: Over | None
    fate: Over | None

    @property
    def caveats(self) -> tuple[Caveat, ...]:
        both = ((name, over) for name, over in (("equilibria", self.equilibria), ("fate", self.fate)) if over)
        return tuple(result for name, over in both if (result := _caveat(name, over)))


def _caveat(name: str, over: Over) -> Caveat | None:
    """That the answer is another elsewhere in the box or open, or that samples stand in place of a proof."""
    if over.answer == "depends":
        others = dict.fromkeys(witness.verdict for witness in over.witnesses[1:])
        return Caveat(Kind.UNCERTAIN, ELSEWHERE(what=over.elsewhere) if name == "fate" else
                      NOT_THE_SAME(question=name, others=joined(map(reason_of, others), " or ")))
    if over.answer == "undecided":
        return Caveat(Kind.UNCERTAIN, LEFT_OPEN(question=name, why=over.reason))
    return None if over.samples is None else Caveat(
        Kind.SAMPLES, BY_SAMPLES(question=name, found=over.samples.reason))


def _of_observed(box: Box) -> Over:
    """What becomes over the box of a motion whose start is stated as it is observed."""
    if not any(present(m) for m in box.rates(_root(box)).m):
        return Over("holds", Fate.BOUNDED.word, reason=REASONS[Basis.TORQUE_FREE], proved=np.inf)
    return Over("undecided", None, reason=OBSERVED_START)


def uncertain(case: Any, questions: Sequence[str] = ("equilibria", "fate")) -> Uncertainty | None:
    """What the uncertain numbers of a Case do to its verdicts, None where it has none; questions: those to be
    answered."""
    if not case.uncertain:
        return None
    ask = {"equilibria": equilibria_over, "fate": fate_over}
    request = [name for name in questions if name == "equilibria" or case.state is not None]
    try:
        box = box_of(case)
        entries = {name: ask[name](box) for name in request}
        if case.observed and "fate" in request:
            entries["fate"] = _of_observed(box)
    except InputError as error:
        entries = {name: Over("undecided", None, reason=refusal_of(error)) for name in request}
    return Uncertainty(case.uncertain, entries.get("equilibria"), entries.get("fate"))
