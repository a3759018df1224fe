"""All rotations of a free body with a damper's mass on a spring at its angular momentum, and where its motion
ends.

T >= E(H, x) of `equilibrium.mass_rotations` falls wherever the mass moves in the body. Below the energy of
every rotation that does not attract, each piece of the sphere of H times the line of the mass has one
rotation in it, a minimum of E, which the motion cannot leave. A motion that never moves the mass may stay
elsewhere in the piece, so that two runs show that it comes near."""
from __future__ import annotations

import math
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import Any

import numpy as np

from ...case.read import Case
from ...equilibrium.mass_rotations import DEGENERATE, BodyWithMass, MassRotation
from ...equilibrium.momentum_sphere import MINIMUM, STABLE, UNSTABLE
from ...errors import InputError
from ...numbers.vectors import cross, dot
from ...physics.coefficients import Content, content
from ...physics.scene import Scene, slices
from ...physics.states import body_momentum, moved_row
from ...reasons import Energy, Quantity, Reason, Sentence
from ..passage import MOVED
from .gyrostat import LEAST, NOT_LEAST, STEADY, GyrostatSpin, agreed
from .rotations import Rotations, SteadyRotation, constants
from .spinner import ENDED, Run, Spinner

OPEN = "undecided"
CRITICAL = Sentence(
    "critical-points-with-mass",
    "at one |H| body and mass turn as one where the energy of body, mass and spring is stationary over the "
    "sphere of H and the displacement: its minima attract; all of them are roots of polynomials, and none is "
    "missed")()
NOT_COUNTED = Sentence(
    "mass-rotations-degenerate", "two rotations meet at this |H|, so that a term of higher order decides "
    "between them")()
NEUTRAL = Sentence(
    "mass-minimum-neutral", "a small nutation about some of the minima does not move the mass: these are "
    "stable, and terms of higher order decide whether they attract")()
IN_A_PIECE = Sentence(
    "mass-below-passes", "T = {energy} is below {barrier}, the energy of the lowest rotation that does not "
    "attract: what it may reach has one rotation that does; a run comes to a hundredth of what it has above "
    "it, and a second one, from a start moved by {moved} in its last place with tolerance {tolerance}, too")
FALLS_INTO = Sentence(
    "mass-falls-below-passes", "T = {energy} is above {barrier}, the energy of the lowest rotation that does "
    "not attract: the phase decides; T falls below it where one rotation attracts, and a run comes to it; a "
    "second run, from a start moved by {moved} in its last place with tolerance {tolerance}, agrees")
NOT_REACHED = Sentence("mass-end-not-reached", "T does not come near that of a rotation that attracts by the "
                       "end of the run: {why}")
BETWEEN = Sentence(
    "between-mass-rotations", "the start is within rounding of the boundary between two rotations that "
    "attract: a run and a second one, from a start moved by {moved} in its last place with tolerance "
    "{tolerance}, end at different ones")
SECOND_RTOL = 1e-13  # tolerance of the second run
RUN_STEPS = 2_000_000  # of a run: some five seconds
TENTH = 100  # part of the energy above its end that is left when the departure is a tenth
STRIDE, SMALLEST = 0.02, 1e-9  # of a descent, in units of |H| and of the spring's length


def body_of(scene: Scene, square: Fraction) -> BodyWithMass | None:
    """The body with its mass at |H|^2 = square; None of a scene without a mass that rotations displace.
    InputError where its rotations are not all known."""
    parts = content(scene)
    if parts is None or not parts.displaced:
        return None
    if why := _unknown(parts):
        raise InputError(f"flat-spin: a rotation displaces the mass of the damper, and with {why} not all "
                         "rotations of body and mass are known: `stabilab simulate` and `stabilab when` "
                         "follow the motion")
    return BodyWithMass.of(parts.D, parts.movers[0], square)


def _unknown(parts: Content) -> str:
    """With what the rotations are not all known."""
    if any(parts.Lambda):
        return "wheels"
    if len(parts.movers) > 1 or parts.inside or parts.kappa:
        return "another damper or a liquid beside it"
    return "" if parts.movers[0].exact[1] else "no spring, which would hold the mass on its line,"


def rotations_with_mass(case: Case, size: Fraction) -> Rotations | None:
    """All rotations at |H| = size > 0, N m s; None of another scene."""
    body = body_of(case.scene, size * size)  # type: ignore[arg-type]
    if body is None:
        return None
    rows = described(case.scene, body)  # type: ignore[arg-type]
    return Rotations(float(size), rows, reason=_why(body, rows), caveats=case.caveats)


def _why(body: BodyWithMass, rows: tuple[SteadyRotation, ...]) -> Reason:
    neutral = any(item.nature == MINIMUM and item.decay is None for item in rows)
    return CRITICAL.then(None if body.counted else NOT_COUNTED).then(NEUTRAL if neutral else None)


def described(scene: Scene, body: BodyWithMass) -> tuple[SteadyRotation, ...]:
    """The rotations with the time constants of the scene."""
    return tuple(_described(scene, item) for item in body.rotations)


def _described(scene: Scene, item: MassRotation) -> SteadyRotation:
    growth, decay = constants(scene, item.omega, 2 if item.axis else 1, item.displacement)
    least = item.nature == MINIMUM
    lossy = STABLE if least else UNSTABLE if growth and item.nature != DEGENERATE else OPEN
    alone = STABLE if least and not item.axis else UNSTABLE if item.axis or item.downward % 2 else OPEN
    return SteadyRotation(item.nature, item.omega, item.momentum, item.energy, lossy,
                          OPEN if item.nature == DEGENERATE else alone, item.axis,
                          growth=None if least else growth, decay=decay if least else None,
                          displacement=item.displacement)


@dataclass(frozen=True)
class MassSpin(Spinner):
    """A spinner whose damper has a mass that rotations displace."""

    @cached_property
    def body(self) -> BodyWithMass:
        built = body_of(self.scene, dot(self.momentum, self.momentum))
        if built is None:
            raise InputError("flat-spin: no rotation displaces a mass here")
        return built

    @cached_property
    def slowest(self) -> float:
        """The slowest decay at a rotation that attracts, s; 0 where there is none."""
        return max((item.decay for item in described(self.scene, self.body) if item.decay), default=0.0)

    def ahead(self, ratio: float, level: float) -> float:
        """As of `Spinner`, at the pace of the slowest decay."""
        least = 2 * self.body.rotations[0].energy / float(self.body.square)
        if not least < level < ratio:
            return 0.0
        return self.slowest / 2 * math.log((ratio - least) / (level - least))

    def ratio_of(self, energy: float) -> float:
        """2 T/|H|^2."""
        return 2 * energy / float(self.body.square)

    def place(self, state: np.ndarray) -> tuple[np.ndarray, float]:
        """(H, x) of a state."""
        blocks = {name: state[part] for name, part in slices(self.scene.blocks).items()}
        return np.array(body_momentum(self.scene, blocks), float), float(blocks["damper_mass"][0])

    def minimum_below(self, state: np.ndarray) -> int | None:
        """Which rotation a descent of E from a state comes to, in small steps."""
        body, (H, x) = self.body, self.place(state)
        D, J1, J2 = body.matrices
        k, size = float(body.k), float(np.linalg.norm(H))
        unit = size / math.sqrt(k * float(min(body.D)))  # m, of the spring that holds the energy of the turn
        stride, here = STRIDE, body.energy(H, x)
        while stride > SMALLEST:
            J = D + x * J1 + x * x * J2
            w = np.linalg.solve(J, H)
            pull = k * x - w @ (J1 + 2 * x * J2) @ w / 2
            slope = np.append((w - (w @ H) * H / size**2) * size, pull * unit)
            length = float(np.linalg.norm(slope))
            if not length:
                break
            step = stride * slope / length
            to = H - step[:3] * size
            to, at = to * (size / np.linalg.norm(to)), x - step[3] * unit
            if (lower := body.energy(to, at)) < here:
                H, x, here, stride = to, at, lower, min(STRIDE, stride * 1.5)
            else:
                stride /= 2
        apart = [math.dist(item.momentum, H) / size + abs(item.displacement - x) / unit
                 for item in (body.rotations[n] for n in body.minima)]
        n = int(np.argmin(apart)) if apart else -1
        return body.minima[n] if apart and apart[n] < 1e-3 else None


def of_case(case: Case) -> GyrostatSpin | None:
    """The end of a case whose damper has a mass that rotations displace; None of another one."""
    if case.variables != "physical" or case.state is None:
        return None
    parts = content(case.scene)
    if parts is None or not parts.displaced or not parts.movers:
        return None
    spinner = MassSpin.of(case, displaced=True)
    return replace(_answered(spinner), caveats=case.caveats)


def _answered(spinner: MassSpin) -> GyrostatSpin:
    body, energy = spinner.body, float(spinner.energy)
    barrier = body.lowest_pass
    rows = described(spinner.scene, body)
    result = GyrostatSpin(spinner.size, rows, reason=_why(body, rows), energy=energy,
                          barrier=barrier if math.isfinite(barrier) else None, reachable=body.minima)
    if (at := _resting(spinner)) is not None:
        if body.rotations[at].nature == MINIMUM:
            return _ending(replace(result, reachable=(at,)), at, "exact", LEAST)
        return replace(result, reason=NOT_LEAST(nature=body.rotations[at].nature))
    return _followed(spinner, result)


def _followed(spinner: MassSpin, result: GyrostatSpin) -> GyrostatSpin:
    """With the end that two runs come to."""
    body, energy, barrier = spinner.body, result.energy, spinner.body.lowest_pass
    runs = [Run(spinner, spinner.start, None, RUN_STEPS),
            Run(spinner, moved_row(spinner.start, MOVED), SECOND_RTOL, RUN_STEPS)]
    above, crossed = energy >= barrier, None
    if above:
        crossed = _both(runs, spinner.ratio_of(barrier))
    ends = [None if above and crossed is None else spinner.minimum_below(run.state) for run in runs]
    result = replace(result, steps=runs[0].steps, crosses=agreed(crossed))
    numbers: dict[str, Any] = {"moved": int(MOVED), "tolerance": Quantity(SECOND_RTOL, digits=1)}
    if ends[0] != ends[1]:
        return replace(result, reason=BETWEEN(**numbers))
    end = ends[0]
    if end is None:
        return replace(result, reason=NOT_REACHED(why=runs[0].why or runs[1].why or ENDED))
    least = body.rotations[end].energy
    tenth = _both(runs, spinner.ratio_of(least + (energy - least) / TENTH))
    if tenth is None:
        return replace(result, reason=NOT_REACHED(why=runs[0].why or runs[1].why or ENDED))
    reason = (FALLS_INTO if above else IN_A_PIECE)(energy=Energy(energy), barrier=Energy(barrier), **numbers)
    result = replace(result, reachable=result.reachable if above else (end,), tenth=agreed(tenth),
                     steps=runs[0].steps)
    return _ending(result, end, "run", reason)


def _both(runs: list[Run], level: float) -> list[float] | None:
    """When both fall to a level of 2 T/|H|^2; None where one does not."""
    times = [run.falls(level) for run in runs]
    reached = [t for t in times if t is not None]
    return reached if len(reached) == len(times) else None


def _resting(spinner: MassSpin) -> int | None:
    """Which rotation the start is, exactly, with the spring relaxed; None where it is none."""
    if spinner.moves_inside or any(cross(spinner.momentum, spinner.omega)):
        return None
    r, n, w = spinner.body.r, spinner.body.line, spinner.omega
    if dot(r, n) * dot(w, w) != dot(r, w) * dot(n, w):  # the pull on the mass
        return None
    apart = [math.dist(item.omega, map(float, w)) for item in spinner.body.rotations]
    return int(np.argmin(apart))


def _ending(result: GyrostatSpin, end: int, level: str, reason: Reason) -> GyrostatSpin:
    item = result.rotations[end]
    return replace(result, outcome=STEADY, level=level, end=end, reason=reason, rates=item.rates,
                   final_energy=item.energy)
