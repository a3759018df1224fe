"""What a body known within bounds does: the fate of its motion, and the number, kind and stability of its
equilibria.

A case may state inertia, gyrostatic moment, torque and state with half-widths; together they span a box. For
the whole box a verdict holds (proved), or it depends (with a point of the box on each side), or it stays
undecided (with the reason); and the smallest change that flips it is bracketed: proved to be safe below one
factor of the stated uncertainties, seen to flip at another."""
from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial
from typing import Any

import numpy as np

from ...errors import Caveat, InputError, Kind, refusal_of
from ...numbers.affine import Affine, lifted, sign_over
from ...numbers.vectors import Number
from ...orbit.fate import REASONS, Basis, fate_of
from ...orbit.one_orbit import Orbit
from ...orbit.potential import derivatives_on_parabola
from ...orbit.reduction import Reduction, reduce, reduction_about
from ...orbit.result import Fate
from ...physics.scene import QuadraticForm
from ...reasons import Axis, Sentence
from ..kinds import kind_of
from ..motions.rows import fates
from .boxes import Box, Numbers, Point, box_of, present
from .branch_and_bound import Family, Proof, orbit_of, prove
from .equilibria import AXES_TURN, equilibria_over
from .geometries import codes as codes_of
from .geometries import deepest
from .geometries import margins as margins_of
from .neighbours import beside
from .result import (
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
