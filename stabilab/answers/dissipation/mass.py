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

import numpy as np

from ...case.read import Case
from ...equilibrium.mass_rotations import DEGENERATE, BodyWithMass, MassRotation
from ...equilibrium.momentum_sphere import MINIMUM, STABLE, UNSTABLE
from ...errors import InputError
from ...numbers.exact import floats
from ...numbers.vectors import cross, dot
from ...physics.coefficients import Content, content
from ...physics.scene import Scene, slices
from ...physics.states import body_momentum
from ...reasons import Energy, Reason, Sentence
from .gyrostat import NOT_LEAST, GyrostatSpin, apart, at_angle, staying, with_end_at
from .rotations import Rotations, SteadyRotation, constants
from .spinner import Spinner
from .times import Time
from .two_runs import SECOND, TwoRuns

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
RUN_STEPS = 2_000_000  # of a run: some five seconds
TENTH = 100  # part of the energy above its end that is left when the departure is a tenth
SAME_END = 1e-3  # of |H| and of the spring's length: a descent comes much nearer to a rotation
AROUND, TRIED, ROUNDS = 180, 41, 4  # directions about an end, displacements of each, ever closer ones
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

    def near(self, end: int, angle: float) -> float:
        """The energy, J, below which H is within an angle of where an end has it, and stays: the least of E
        at that angle, at any displacement, or the lowest pass."""
        body, item = self.body, self.body.rotations[end]
        D, J1, J2 = body.matrices
        k, H = float(body.k), at_angle(np.array(item.momentum), item.axis, angle, AROUND)
        widest = math.sqrt(2 * body.rotations[-1].energy / k)
        x, width = np.zeros(len(H)), widest
        rows = np.arange(len(H))
        for _ in range(ROUNDS):
            tried = x[:, None] + width * np.linspace(-1, 1, TRIED)
            J = D + tried[..., None, None] * J1 + (tried**2)[..., None, None] * J2
            w = np.linalg.solve(J, np.broadcast_to(H[:, None, :, None], (*tried.shape, 3, 1)))[..., 0]
            heights = (w * H[:, None]).sum(axis=-1) / 2 + k * tried**2 / 2
            best = heights.argmin(axis=1)
            x, width = tried[rows, best], 2 * width / (TRIED - 1)
        return min(float(heights[rows, best].min()), body.lowest_pass)

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
        away = {n: apart(H.tolist(), item) / size + abs(item.displacement - x) / unit
                for n, item in enumerate(body.rotations) if item.nature == MINIMUM}
        return next((n for n in sorted(away, key=away.__getitem__) if away[n] < SAME_END), None)


def of_case(case: Case, angle: float) -> GyrostatSpin | None:
    """The end of a case whose damper has a mass that rotations displace; None of another one. angle: rad, of
    `settles`."""
    if case.variables != "physical" or case.state is None:
        return None
    parts = content(case.scene)
    if parts is None or not parts.displaced or not parts.movers:
        return None
    spinner = MassSpin.of(case, displaced=True)
    return replace(_answered(spinner, angle), caveats=case.caveats)


def _answered(spinner: MassSpin, angle: float) -> GyrostatSpin:
    body, energy = spinner.body, float(spinner.energy)
    barrier = body.lowest_pass
    rows = described(spinner.scene, body)
    result = GyrostatSpin(spinner.size, rows, reason=_why(body, rows), energy=energy,
                          barrier=barrier if math.isfinite(barrier) else None, reachable=body.minima,
                          within=angle)
    if (at := _resting(spinner)) is not None:
        if body.rotations[at].nature == MINIMUM:
            return staying(spinner, result, at)
        return replace(result, reason=NOT_LEAST(nature=body.rotations[at].nature))
    return _followed(spinner, result)


def _followed(spinner: MassSpin, result: GyrostatSpin) -> GyrostatSpin:
    """With the end that two runs come to."""
    body, energy, barrier = spinner.body, result.energy, spinner.body.lowest_pass
    runs = TwoRuns(spinner, RUN_STEPS)
    above = energy >= barrier
    crossed = runs.falls(spinner.ratio_of(barrier)) if above else None
    result = replace(result, steps=runs.first.steps, crosses=crossed)
    if above and crossed is None:
        return replace(result, reason=NOT_REACHED(why=runs.why))
    end, other = runs.come_to(spinner.minimum_below)
    if end != other:
        return replace(result, reason=BETWEEN(**SECOND))
    if end is None:
        return replace(result, reason=NOT_REACHED(why=runs.why))
    least = body.rotations[end].energy
    levels = {"tenth": least + (energy - least) / TENTH, "settles": spinner.near(end, result.within)}
    ahead = sorted((name for name, level in levels.items() if least < level <= energy),
                   key=lambda name: -levels[name])
    times: dict[str, Time | None] = {name: runs.falls(spinner.ratio_of(levels[name])) for name in ahead}
    if times["tenth"] is None:
        return replace(result, reason=NOT_REACHED(why=runs.why))
    reason = (FALLS_INTO if above else IN_A_PIECE)(energy=Energy(energy), barrier=Energy(barrier), **SECOND)
    result = replace(result, reachable=result.reachable if above else (end,), steps=runs.first.steps,
                     tenth=times["tenth"], settles=times.get("settles"))
    return with_end_at(result, end, "run", reason)


def _resting(spinner: MassSpin) -> int | None:
    """Which rotation the start is, exactly, with the spring relaxed; None where it is none."""
    if spinner.moves_inside or any(cross(spinner.momentum, spinner.omega)):
        return None
    r, n, w = spinner.body.r, spinner.body.line, spinner.omega
    if dot(r, n) * dot(w, w) != dot(r, w) * dot(n, w):  # the pull on the mass
        return None
    relaxed = [n for n, item in enumerate(spinner.body.rotations) if not item.displacement]
    H = floats(spinner.momentum)
    return min(relaxed, key=lambda n: apart(H, spinner.body.rotations[n]))
