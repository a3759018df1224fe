"""Where a free gyrostat ends that something inside takes energy from, and when.

H is constant in space and T falls at every motion but the rotations at this |H| (LaSalle), so that every
motion tends to one of these; `equilibrium.momentum_sphere` has them, and the passes between two minima. T
falls through any level once, and T >= E(H), so that each time below is the one root of a monotone function:

    T at a pass: H is then on one side of it for ever, and a minimum alone is left;
    T at the least of E on the circle of directions at an angle from the end: H stays within the angle.

Where one minimum is left at the start the end is the same for everything inside that takes energy; where
there are two, the motion is followed to the pass, by two runs."""
from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property, reduce
from operator import getitem
from typing import Any

import numpy as np

from ...case.read import Case, with_data
from ...case.source import parsed
from ...equilibrium.mass_rotations import MassRotation
from ...equilibrium.momentum_sphere import MINIMUM, MomentumSphere, Rotation
from ...errors import Caveat, Kind, without
from ...numbers.exact import floats
from ...numbers.vectors import Float3, cross, dot
from ...physics.scene import Scene, slices
from ...physics.states import body_momentum
from ...physics.to_numpy import to_numpy
from ...reasons import Energy, Rate, Reason, Sentence
from ..caveats import caveats_of
from .rotations import Rotations, described, sphere_of, threshold_of, why
from .spinner import Run, Spinner
from .times import Time
from .two_runs import SECOND, TwoRuns

STEADY, CIRCLE, UNDECIDED = "steady rotation", "circle of rotations", "undecided"
LEAST = Sentence("rotation-of-least-energy-at-momentum",
                 "the start is the rotation of a minimum of the energy at its |H|, and stays")()
NOT_LEAST = Sentence(
    "rotation-left-by-losses", "the start is exactly a rotation at which the energy at its |H| is no minimum "
    "({nature}): with losses it is unstable, and a disturbance, however small, decides where it goes")
CANCELS = Sentence("momentum-zero-ends", "H = 0 stays, and the energy falls to that of the one rotation that "
                   "cancels the momentum of the wheels, ω = -D^-1 λ")()
ONE_MINIMUM = Sentence(
    "one-minimum-at-momentum", "at this |H| the energy has one minimum on the sphere of H: whatever takes "
    "energy inside, every motion tends to it, but for a set of measure zero")()
ONE_CIRCLE = Sentence(
    "one-circle-at-momentum", "two largest moments are equal: at this |H| the energy is least on a circle of "
    "rotations, to which every motion tends but for a set of measure zero; which one of them hangs on the "
    "phase alone")()
BELOW_PASS = Sentence(
    "below-the-pass", "T = {energy} is not above the {barrier} of the pass between the two minima of the "
    "energy on the sphere of H: it stays on its side, whatever takes energy inside, and tends to the minimum "
    "there")
ABOVE_TRAP = Sentence(
    "above-an-inflection", "the energy has one minimum on the sphere of H and an inflection below T, to "
    "which an open set of motions tends: exactly at the size of the wheels' momentum at which two minima "
    "become one")()
PASS_FALLS = Sentence(
    "falls-below-the-pass", "two rotations attract, and T = {energy} is above the {barrier} of the pass "
    "between them: the phase decides; T falls below it on the side of {rates}, where it stays; a second "
    "run, from a start moved by {moved} in its last place with tolerance {tolerance}, agrees")
PASS_NOT_REACHED = Sentence("pass-not-reached", "two rotations attract, and T does not fall to the "
                            "{barrier} of the pass between them by the end of the run: {why}")
BETWEEN_MINIMA = Sentence(
    "between-two-minima", "the start is within rounding of the boundary between two rotations that attract: "
    "a run and a second one, from a start moved by {moved} in its last place with tolerance {tolerance}, end "
    "at different ones")
LIQUID_PHASE = Sentence(
    "liquid-phase-open", "two rotations attract, and T = {energy} is above the {barrier} of the pass between "
    "them: the phase decides, and beside a wheel the law of the liquid takes energy to first order in κ "
    "only, so that no run shows it")
LIQUID_AS_LOSS = Sentence(
    "liquid-as-any-loss", "of a liquid that keeps H and takes energy; its law here does so to first order in "
    "κ")()
ENDS_ALIKE = Sentence("ends-alike", "of {drawn} motions drawn from their box {same} end at this rotation and "
                      "{others} elsewhere")
OPEN_OVER_BOX = Sentence("gyrostat-end-open-over-box", "the uncertain numbers leave it open: {found}")
SAME_OVER_BOX = Sentence("gyrostat-end-over-box", "uncertain numbers: {found}; samples, no proof")
RUN_STEPS = 5_000_000  # of a run: some ten seconds
DRAWN = 32  # motions from the box of uncertain numbers
DRAWN_STEPS = 6_000_000  # of all of them
SMALLEST = 1e-11  # of T, what is above that of the end: less is lost in the rounding of T
AROUND = 3600  # directions on the circle about an end


@dataclass(frozen=True, eq=False, repr=False)
class GyrostatSpin(Rotations):
    """Where a free gyrostat ends that something inside takes energy from.

    outcome: "steady rotation", "circle of rotations" (which one hangs on the phase) or "undecided"; level:
    "exact", "run" or "undecided"; reason: how it is known. end: which of `rotations` it is, None where
    undecided; reachable: all that its energy allows at the start. rates: rad/s, along the principal
    axes, in the end, None where undecided or on a circle. energy, final_energy: J, now and in the end;
    barrier: of the pass between two minima, None where there is one. within: rad, and settles: when H is
    within that angle of where it ends in the body, and stays; crosses: when T is that of the pass; each None
    where it is past at the start, or not reached; tenth: where it starts within the angle, when what it has
    above the energy of its end is a hundredth, and so its departure a tenth, of that at the start. steps: of
    the first run."""

    outcome: str = UNDECIDED
    level: str = "undecided"
    end: int | None = None
    reachable: tuple[int, ...] = ()
    rates: Float3 | None = None
    energy: float = 0.0
    final_energy: float | None = None
    barrier: float | None = None
    within: float = 0.0
    crosses: Time | None = None
    settles: Time | None = None
    tenth: Time | None = None
    steps: int = 0

    @property
    def lost(self) -> float | None:
        """The energy that is lost in all, J."""
        return None if self.final_energy is None else self.energy - self.final_energy


@dataclass(frozen=True)
class Gyrostat(Spinner):
    """A spinner with wheels."""

    @cached_property
    def momentum(self) -> tuple[Fraction, ...]:
        """H, exact, wheels included."""
        wheel = self.scene.vector("gyrostat")
        return tuple(h + l for h, l in zip(super().momentum, wheel))

    @cached_property
    def sphere(self) -> MomentumSphere:
        return sphere_of(self.scene, dot(self.momentum, self.momentum))

    @property
    def pace(self) -> float:
        """Of the motion, rad/s: wheels turn H in a body at rest, too."""
        least = min(self.scene.body.inertia)
        wheel = math.hypot(*floats(self.scene.vector("gyrostat")))
        return float(np.linalg.norm(self.start[:3])) + wheel / least

    @cached_property
    def slowest(self) -> float:
        """The slowest decay at a rotation that attracts, s; 0 where there is none."""
        decays = (item.decay for item in described(self.scene, self.sphere))
        return max((decay for decay in decays if decay), default=0.0)

    def ratios(self, states: np.ndarray) -> np.ndarray:
        """2 T/|H|^2 of states (..., N), |H| that of the start: in doubles that of a run may be lost beside
        the wheels'."""
        return 2 * to_numpy(self.scene).invariants(states)["energy"] / float(self.sphere.square)

    def ahead(self, ratio: float, level: float) -> float:
        """As of `Spinner`, at the pace of the decay towards the least energy."""
        least = float(2 * self.sphere.rotations[0].energy / self.sphere.square)
        if not least < level < ratio:
            return 0.0
        return self.slowest / 2 * math.log((ratio - least) / (level - least))

    def side_of(self, state: np.ndarray, at: Rotation) -> int:
        """On which side of a rotation between two minima the momentum of a state is."""
        blocks = {name: state[part] for name, part in slices(self.scene.blocks).items()}
        i = self.sphere.top
        return int(np.sign(body_momentum(self.scene, blocks)[i] - float(at.momentum[i])))

    def ratio_of(self, energy: float) -> float:
        """2 T/|H|^2."""
        return 2 * energy / float(self.sphere.square)


def of_case(case: Case, angle: float) -> GyrostatSpin:
    """The end of a case with wheels and something inside that takes energy; angle: rad, of `settles`."""
    spinner = Gyrostat.of(case)
    result = _answered(case, spinner, angle)
    result = replace(result, caveats=(*without(case.caveats, Kind.UNCERTAIN), *result.caveats))
    return _over_the_box(case, spinner, result) if case.uncertain and result.end is not None else result


def at_start(case: Case) -> Rotations:
    """All rotations at the angular momentum of the start of a free body with wheels, without a run."""
    spinner = Gyrostat.made(case)
    sphere = spinner.sphere
    return Rotations(float(spinner.size), described(spinner.scene, sphere), threshold_of(case, sphere),
                     reason=why(sphere))


def _answered(case: Case, spinner: Gyrostat, angle: float) -> GyrostatSpin:
    sphere = spinner.sphere
    result = GyrostatSpin(
        float(spinner.size), described(spinner.scene, sphere), threshold_of(case, sphere), reason=why(sphere),
        energy=float(spinner.energy), within=angle)
    if not any(spinner.momentum):
        return with_end_at(result, 0, "exact", CANCELS)
    if not spinner.moves_inside and not any(cross(spinner.momentum, spinner.omega)):
        return _at_rest(spinner, result)
    indices = [n for n, rotation in enumerate(sphere.rotations) if rotation.nature == MINIMUM]
    if not sphere.passes:
        return _toward_one(spinner, replace(result, reachable=tuple(indices)), indices[0])
    barrier = sphere.passes[0]
    result = replace(result, barrier=float(barrier.energy), reachable=tuple(indices))
    energies = {"energy": Energy(result.energy), "barrier": Energy(float(barrier.energy))}
    if sphere.above(spinner.energy, barrier) <= 0:
        end = _on_side(sphere, sphere.side(spinner.momentum, barrier))
        result = with_end_at(replace(result, reachable=(end,)), end, "exact", BELOW_PASS(**energies))
        return _timed(spinner, result)
    if _has_liquid(spinner.scene):
        return replace(result, reason=LIQUID_PHASE(**energies))
    return _timed(spinner, result)


def _has_liquid(scene: Scene) -> bool:
    return scene.effect("liquid_cavity") is not None


def _at_rest(spinner: Gyrostat, result: GyrostatSpin) -> GyrostatSpin:
    """A start that is a rotation itself."""
    H, least = floats(spinner.momentum), spinner.sphere.rotations
    at = min(range(len(least)), key=lambda n: apart(H, least[n]))
    if least[at].nature == MINIMUM:
        return staying(spinner, result, at)
    return replace(result, reason=NOT_LEAST(nature=least[at].nature))


def staying(spinner: Spinner, result: GyrostatSpin, at: int) -> GyrostatSpin:
    """Of a start that is a minimum itself, on a circle one of its points."""
    stays = with_end_at(replace(result, reachable=(at,)), at, "exact", LEAST)
    return replace(stays, outcome=STEADY, rates=floats(spinner.omega))


def apart(H: Sequence[float], rotation: Rotation | MassRotation) -> float:
    """How far a momentum is from that of a rotation, or of its circle."""
    K = tuple(map(float, rotation.momentum))
    if not rotation.axis:
        return math.dist(H, K)
    i = rotation.axis - 1
    across = lambda v: math.hypot(*(v[n] for n in range(3) if n != i))
    return math.hypot(H[i] - K[i], across(H) - across(K))


def _toward_one(spinner: Gyrostat, result: GyrostatSpin, end: int) -> GyrostatSpin:
    trap = spinner.sphere.trap
    if trap is not None and spinner.sphere.above(spinner.energy, trap) > 0:
        return replace(result, reason=ABOVE_TRAP)
    reason = ONE_CIRCLE if result.rotations[end].axis else ONE_MINIMUM
    return _timed(spinner, with_end_at(result, end, "exact", reason))


def _on_side(sphere: MomentumSphere, side: int) -> int:
    """Which of the rotations is the minimum on a side of the pass."""
    return sphere.rotations.index(sphere.minima[0 if side > 0 else 1])


def with_end_at(result: GyrostatSpin, end: int, level: str, reason: Reason) -> GyrostatSpin:
    """With an end, and why."""
    item = result.rotations[end]
    return replace(result, outcome=CIRCLE if item.axis else STEADY, level=level, end=end, reason=reason,
                   rates=None if item.axis else item.rates, final_energy=item.energy)


# --- The times, by two runs
def _timed(spinner: Gyrostat, result: GyrostatSpin) -> GyrostatSpin:
    """With the times of a motion that goes on, and with its end where a run shows that."""
    if _has_liquid(spinner.scene):
        return replace(result, reason=result.reason.then(LIQUID_AS_LOSS))
    runs = TwoRuns(spinner, RUN_STEPS, spinner.pace)
    crossed: Time | None = None
    if result.end is None:
        result, crossed = _passed(spinner, result, runs)
    elif result.barrier is not None:
        result = replace(result, reachable=(result.end,))
    name, times = ("settles", None) if result.end is None else _settled(spinner, result, runs)
    found: dict[str, Any] = {"crosses": crossed, name: times}
    return replace(result, steps=runs.first.steps, **found,
                   caveats=caveats_of(spinner.scene, validity=runs.first.validity))


def _passed(spinner: Gyrostat, result: GyrostatSpin, runs: TwoRuns) -> tuple[GyrostatSpin, Time | None]:
    """Both runs to the pass: with the end on whose side they are then."""
    barrier = spinner.sphere.passes[0]
    height = float(barrier.energy)
    reached = runs.falls(spinner.ratio_of(height))
    if reached is None:
        return replace(result, reason=PASS_NOT_REACHED(barrier=Energy(height), why=runs.why)), None
    first, second = runs.come_to(lambda state: spinner.side_of(state, barrier))
    if first != second:
        return replace(result, reason=BETWEEN_MINIMA(**SECOND)), reached
    end = _on_side(spinner.sphere, first)
    reason = PASS_FALLS(energy=Energy(result.energy), barrier=Energy(height),
                        rates=Rate(result.rotations[end].rates), **SECOND)
    return with_end_at(result, end, "run", reason), reached


def _settled(spinner: Gyrostat, result: GyrostatSpin, runs: TwoRuns) -> tuple[str, Time | None]:
    """("settles", when both are within the angle of the end), or, where they are at the start, ("tenth", when
    their departure is a tenth of it); None where they are not."""
    end = spinner.sphere.rotations[result.end or 0]
    name, height = "settles", near(spinner.sphere, end, result.within)
    if spinner.energy < height:
        name, height = "tenth", float(end.energy + (spinner.energy - end.energy) / 100)
    if height - end.energy < SMALLEST * spinner.energy:
        return name, None
    return name, runs.falls(spinner.ratio_of(height))


def near(sphere: MomentumSphere, end: Rotation, angle: float) -> float:
    """The energy, J, below which H is within an angle of where an end has it, on its side of a pass."""
    D, K = (np.array(floats(v)) for v in (sphere.D, end.momentum))
    H = at_angle(K, end.axis, angle, AROUND)
    # the difference of energies, by its quadratic form
    A = 1 / D - float(end.multiplier or 0)
    above = ((H - K) ** 2 * A).sum(axis=1) / 2
    if sphere.passes:
        barrier = sphere.passes[0]
        height, i = float(barrier.energy - end.energy), sphere.top
        on_side = (H[:, i] - float(barrier.momentum[i])) * float(end.momentum[i] - barrier.momentum[i]) > 0
        above = np.append(above[on_side], height)
    return float(end.energy) + float(above.min())


def at_angle(K: np.ndarray, axis: int, angle: float, around: int) -> np.ndarray:
    """(n, 3) momenta of the size of K at an angle from it, so many around it; axis: 1 to 3, from the circle
    about that axis through K, one on either side, 0 of a point."""
    size = float(np.linalg.norm(K))
    if axis:
        up, i = math.asin(max(-1.0, min(1.0, K[axis - 1] / size))), axis - 1
        j = (i + 1) % 3
        H = np.zeros((2, 3))
        for row, lean in zip(H, (up - angle, up + angle)):
            row[i], row[j] = size * math.sin(lean), size * math.cos(lean)
        return H
    first = np.cross(K, np.eye(3)[int(np.argmin(np.abs(K)))])
    first /= np.linalg.norm(first)
    other = np.cross(K / size, first)
    phase = np.linspace(0, 2 * math.pi, around, endpoint=False)[:, None]
    return K * math.cos(angle) + size * math.sin(angle) * (np.cos(phase) * first + np.sin(phase) * other)


# --- Uncertain numbers
def _over_the_box(case: Case, spinner: Gyrostat, result: GyrostatSpin) -> GyrostatSpin:
    """With what uncertain numbers do: undecided where motions drawn from their box end elsewhere."""
    draws, alike = np.random.default_rng(1), 0
    drawn = max(4, min(DRAWN, DRAWN_STEPS // max(1, result.steps)))
    end = spinner.sphere.rotations[result.end or 0]
    for _ in range(drawn):
        data = parsed(case.path, case.text)[0]
        for item in case.uncertain:
            *tables, last = item.path
            fraction = Fraction(draws.uniform(-1, 1))
            reduce(getitem, tables, data)[last] = str(item.middle + item.half * fraction)
        alike += _ends_at(Gyrostat.of(with_data(case.path, case.text, data)), end)
    found = ENDS_ALIKE(drawn=drawn, same=alike, others=drawn - alike)
    if alike < drawn:
        return replace(result, outcome=UNDECIDED, level="undecided", end=None, rates=None, final_energy=None,
                       reason=OPEN_OVER_BOX(found=found))
    return replace(result, caveats=(*result.caveats, Caveat(Kind.UNCERTAIN, SAME_OVER_BOX(found=found))))


def _ends_at(spinner: Gyrostat, end: Rotation) -> bool:
    """Whether a motion ends at the minimum that is nearest to this one."""
    sphere = spinner.sphere
    if not sphere.passes or not sphere.square:
        return sphere.trap is None
    barrier = sphere.passes[0]
    if sphere.above(spinner.energy, barrier) <= 0:
        side = sphere.side(spinner.momentum, barrier)
    else:
        run = Run(spinner, spinner.start, None, RUN_STEPS, spinner.pace)
        if _has_liquid(spinner.scene) or run.falls(spinner.ratio_of(float(barrier.energy))) is None:
            return False
        side = spinner.side_of(run.state, barrier)
    nearest = min(sphere.minima, key=lambda item: math.dist(floats(item.momentum), floats(end.momentum)))
    return sphere.rotations[_on_side(sphere, side)] == nearest
