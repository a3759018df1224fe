"""What uncertain numbers of a case do to the fate of its motion, and to all its verdicts.

A case may state inertia, gyrostatic moment, torque and state with half-widths; together they span a box. For
the whole box a verdict holds (proved), or it depends (with a point of the box on each side), or it stays
undecided (with the reason); and the smallest change that flips it is bracketed: proved to be safe below one
factor of the stated uncertainties, seen to flip at another.
"""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from ...caveat import Caveat
from ...errors import InputError
from ...numbers.affine import Affine, lifted, sign_over
from ...numbers.vectors import Number
from ...orbit.fate.one_state import REASONS, Reason, fate_of
from ...orbit.one_orbit import Orbit
from ...orbit.potential import derivatives_on_parabola
from ...orbit.reduction import Reduction, reduce, reduction_about
from ...orbit.result import Fate
from ...physics.scene import QuadraticForm
from ..fate import fate
from ..kinds import kind_of
from .box import Box, Numbers, Point, box_of, present
from .branch_and_bound import Family, Proof, orbit_of, prove
from .equilibria import equilibria_over
from .result import (
    STRETCHES,
    UNKNOWN,
    Answer,
    Look,
    Over,
    Witness,
    bracketed,
    by_sample,
    by_trial,
    nearest_change,
)

UNBOUNDED = "unbounded"


def fate_over(box: Box) -> Over | None:
    """What becomes of the motion over the box; None where the box has no state. See `uncertain.uncertain`."""
    if "state" not in box.middle:
        return None
    look = partial(look_at, box)
    answer: Answer = lambda point: look(point)[0]
    if box.frame is not None:
        return by_sample(box, answer(np.zeros(len(box.places))), look,
                         "within the uncertainties the principal axes turn with the tensor, and no proof "
                         "follows that turn")
    numbers = _root(box)
    form = box.rates(numbers)
    acting = [i for i in range(3) if present(form.m[i])]
    here = answer(np.zeros(len(box.places)))
    if not acting:
        return Over("holds", here, REASONS[Reason.TORQUE_FREE], proved=np.inf)
    if len(acting) > 1:
        axes = " and ".join(str(i + 1) for i in acting)
        return by_sample(box, here, look,
                         f"the torque may act about axes {axes} together, off the principal axes, where "
                         "motions are followed one by one: the middle's answer is no proof for the box")
    reduction = reduction_about(form, acting[0])
    if reduction is None:
        return _under_law(box, look, numbers, form, acting[0])
    signs = _signs(reduction)
    if signs is None:
        return by_trial(box, here, look, "two of the moments of inertia may be equal within the box, where "
                                         "the geometry of the motion changes from circles to hyperbolas: no "
                                         "proof is known")
    if signs[0] * signs[1] >= 0:
        return _between_walls(box, here, look, reduction, numbers, signs)
    return _on_circles(box, here, answer, Family(box, acting[0], signs))


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
        one = fate(scene, np.array(state))
        return words(Fate(int(one.labels)), int(one.axis), int(one.sense)), float(one.margins)
    # asked of boxes that have a state
    found = fate_of(scene, Orbit(reduction, state))  # type: ignore[arg-type]
    return words(found.label, found.axis, found.sense), found.margin


def words(label: Fate, axis: int, sense: int) -> str:
    """A fate in words; a state at rest is bounded."""
    if label == Fate.EQUILIBRIUM:
        return Fate.BOUNDED.word
    if label == Fate.SPIN_UP and axis:
        return f"spin-up about axis {axis}, {'positive' if sense > 0 else 'negative'} direction"
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

    def attempt(stretch: float, most: int) -> Proof:
        senses = _senses(box, family, stretch)
        if senses is None or (claim == "spin-up" and len(senses) > 1):
            return Proof(None, 0)
        return prove(family, claim, senses, stretch, most)

    steady = int(codes(np.zeros((1, len(box.places))))[0]) == 0
    if here == Fate.SEPARATRIX.word or steady != (claim == "bounded"):
        return _tie(box, here, answer, _against_gradient(family))
    change = nearest_change(box, codes, answer, here, _against_gradient(family))
    return bracketed(box, here, answer, change, attempt,
                     REASONS[Reason.BELOW_BARRIER if claim == "bounded" else Reason.ABOVE_BARRIER])


def _tie(box: Box, here: Any, answer: Answer, corners: Sequence[np.ndarray]) -> Over:
    """The middle lies on the separatrix (or at rest on a saddle): what lies on either side."""
    because, n = "the middle lies on the separatrix itself", len(box.places)
    sides: dict[str, Any] = {}
    for stretch in STRETCHES:
        for direction in (*corners, *np.eye(n), *-np.eye(n)):
            word = answer(direction * stretch)
            if word not in (None, Fate.SEPARATRIX.word):
                sides.setdefault(word, Witness(word, box.values(direction * stretch)))
        if len(sides) > 1:
            return Over("depends", here, because, changes_at=0.0, witnesses=tuple(sides.values()))
    return Over("undecided", here, f"{because}, and only one side of it was found")


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
            return Over("holds", here, REASONS[Reason.PURE_SPIN], proved=1.0)
        return by_trial(box, here, look,
                        "the middle lies on a set of measure zero, and no proof covers what is around it")
    if not curved:
        return Over("holds", here, REASONS[Reason.WALLS], proved=1.0,
                    but="where the force is the same all along the parabola, nothing holds the spin back")
    u, v = loose
    certain = not any(isinstance(n, Affine) for n in (u, v, r.p, r.q))
    if certain and v * v * abs(r.p) == u * u * abs(r.q):
        return by_sample(box, here, look,
                         "every motion of the box lies on an invariant plane Q = 0, where a barrier decides, "
                         "and the plane's motions are not followed over a box")
    with np.errstate(all="ignore"):
        orbit = orbit_of(r, state, signs)
        clear = all(_sign(lifted(side)) for side in (orbit.x + orbit.z, orbit.x - orbit.z))
    but = ("" if clear
           else "the box meets an invariant plane Q = 0, where a motion may spin up or tend to a saddle")
    return Over("holds", here, REASONS[Reason.WALLS], proved=1.0, but=but)


# -- no reduction


def _under_law(box: Box, look: Look, numbers: Numbers, form: QuadraticForm, axis: int) -> Over:
    """A gyrostatic moment along the torque: |H|^2/2 - D_i T grows at the rate lambda_i M_i."""
    along = numbers["momentum"][axis] if box.variables == "physical" else -form.sigma[1] - form.rho[2]
    if _sign(along * form.m[axis]):
        return Over("holds", UNBOUNDED,
                    f"{REASONS[Reason.UNBOUNDED_LAW]}; the axis it ends about is not followed over the box",
                    proved=1.0)

    def whether(point: Point) -> tuple[str | None, float]:
        word, _ = look(point)
        return UNBOUNDED if word and word.startswith("spin-up") else word, np.nan
    return by_trial(box, whether(np.zeros(len(box.places)))[0], whether,
                    f"the gyrostatic moment along axis {axis + 1}, the torque's, may vanish or not: where it "
                    "does not, there is no reduction to one degree of freedom, and no motion is bounded")


@dataclass(frozen=True)
class Uncertainty:
    """numbers: the uncertain numbers of the case; equilibria, fate: what they do to each, None where not
    asked (and the fate where there is no state). caveats: that samples stand in place of a proof, where they
    do."""

    numbers: tuple[Any, ...]
    equilibria: Over | None
    fate: Over | None

    @property
    def caveats(self) -> tuple[Caveat, ...]:
        sampled = ((name, over.samples)
                   for name, over in (("equilibria", self.equilibria), ("fate", self.fate)) if over)
        return tuple(Caveat("samples",
                            f"{name} over the uncertain numbers by samples, not by proof: {found.words}")
                     for name, found in sampled if found)


def uncertain(case: Any, questions: Sequence[str] = ("equilibria", "fate")) -> Uncertainty | None:
    """What the uncertain numbers of a Case do to its verdicts, None where it has none; questions: those to be
    answered."""
    if not case.uncertain:
        return None
    ask = {"equilibria": equilibria_over, "fate": fate_over}
    asked = [name for name in questions if name == "equilibria" or case.state is not None]
    try:
        box = box_of(case)
        found = {name: ask[name](box) for name in asked}
    except InputError as error:
        found = {name: Over("undecided", None, str(error)) for name in asked}
    return Uncertainty(case.uncertain, found.get("equilibria"), found.get("fate"))
