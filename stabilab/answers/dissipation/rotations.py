"""All rotations of a free body, with or without wheels, at one size of its angular momentum: which of them
are stable where something inside takes energy, which where nothing does, how fast a departure grows or fades,
and from which speed of its wheels on one alone attracts. The theory is in the text of
`equilibrium.momentum_sphere`."""
from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from ...case.read import Case
from ...equilibrium.momentum_sphere import MINIMUM, MomentumSphere, Rotation
from ...errors import InputError
from ...numbers.exact import floats
from ...numbers.vectors import Exact3, Float3
from ...physics.effects.base import effect_words
from ...physics.scene import Scene, slices
from ...physics.to_numpy import to_numpy
from ...reasons import Reasoned, Sentence
from ...representation import Answer, Compared
from ..caveats import of_case as caveats_of_case

NO_GROWTH = 1e-9  # of the fastest eigenvalue: a real part that is none
CRITICAL = Sentence(
    "critical-points-of-energy",
    "at one |H| a rotation stays where the energy is stationary on the sphere of H: with losses inside its "
    "minima attract, without losses maxima are stable, too, and saddles never are")()
NO_MOMENTUM = Sentence(
    "momentum-zero-rotation", "at H = 0 the one rotation is that which cancels the momentum of the wheels, "
    "ω = -D^-1 λ, with losses and without")()
EVERY_ROTATION = Sentence(
    "every-rotation-stays", "three equal moments and no wheel: every rotation stays as it is")()


@dataclass(frozen=True)
class SteadyRotation:
    """One rotation at this |H|, or a circle of them.

    nature: of the energy on the sphere of H, "minimum", "maximum", "saddle" or "inflection". rates: rad/s,
    and momentum: N m s, along the principal axes; of a circle one of its points. energy: J, of body and
    wheels without the wheels' own. with_losses, without_losses: "stable" or "unstable", of a circle with
    losses as a set. axis: 1 to 3, about which a circle lies, else 0; everywhere: whether every direction of H
    is one. growth, decay: s, time constants of the fastest growing, or of the slowest fading departure at
    this |H|, of all parts of the scene; None where it has none. displacement: of a damper's mass along its
    line, m; None without one. With such a mass stability may be "undecided", and the nature "degenerate".
    """

    nature: str
    rates: Float3
    momentum: Float3
    energy: float
    with_losses: str
    without_losses: str
    axis: int = 0
    everywhere: bool = False
    growth: float | None = None
    decay: float | None = None
    displacement: float | None = None


@dataclass(frozen=True)
class WheelThreshold:
    """From which gyrostatic moment on, |H| and the moment's direction as they are, one rotation alone is
    stable with losses.

    factor: of the moment as it is; moment: N m s; rates: rad/s, of that rotation, there; wheels: (name, speed
    in rad/s there) of those whose inertia the case states. at_rate: the moment, N m s, from which on a
    rotation about the wheels' own principal axis attracts alone at the rate that the start has about it,
    rate, rad/s; None where the moment is along no principal axis, there is no start, it turns against it,
    or no moment does; at_rate_factor: of the moment as it is; at_rate_wheels: as wheels."""

    factor: float
    moment: float
    rates: Float3
    wheels: tuple[tuple[str, float], ...] = ()
    rate: float | None = None
    at_rate: float | None = None
    at_rate_factor: float | None = None
    at_rate_wheels: tuple[tuple[str, float], ...] = ()


@dataclass(frozen=True, eq=False, repr=False)
class Rotations(Answer, Compared, Reasoned):
    """All rotations of a free body at one |H|.

    momentum: |H|, N m s. rotations: the least energy first. threshold: None without wheels.
    """

    momentum: float
    rotations: tuple[SteadyRotation, ...]
    threshold: WheelThreshold | None = None

    @property
    def stable(self) -> int:
        """How many attract where something inside takes energy; a circle counts as one."""
        return sum(item.with_losses == "stable" for item in self.rotations)


def sphere_of(scene: Scene, square: Fraction) -> MomentumSphere:
    """The sphere of the momentum H, |H|^2 = square, of a scene."""
    return MomentumSphere(scene.body.exact, scene.vector("gyrostat"), square)


def rotations_at(case: Case, size: Fraction) -> Rotations:
    """All rotations of a case at |H| = size, N m s, whatever its start. InputError for a scene in which
    something from outside acts, and for a size below zero."""
    if size < 0:
        raise InputError(f"momentum: expected a size of at least 0, got {float(size):g} N m s")
    free_only(case)
    scene: Any = case.scene  # a body: the others were refused
    sphere = sphere_of(scene, size * size)
    return Rotations(float(size), described(scene, sphere), threshold_of(case, sphere),
                     reason=why(sphere), caveats=caveats_of_case(case))


def free_only(case: Case) -> None:
    """InputError for a case that is no free body."""
    if case.variables != "physical":
        raise InputError("flat-spin: give a body with moments of inertia: a scaled case knows no momentum")
    others = [effect_words(effect.name) for effect in case.scene.effects
              if effect.takes != "inside" and effect.name != "gyrostat"]
    if others:
        raise InputError(f"flat-spin: {' and '.join(others)}: the rotations at one |H| are known of a free "
                         "body with wheels alone: leave it away")


def why(sphere: MomentumSphere) -> Any:
    """Why these are all."""
    if not sphere.square:
        return NO_MOMENTUM
    return EVERY_ROTATION if sphere.rotations[0].everywhere else CRITICAL


def described(scene: Scene, sphere: MomentumSphere) -> tuple[SteadyRotation, ...]:
    """The rotations of a sphere in doubles, with the time constants of the scene."""
    return tuple(_described(scene, rotation) for rotation in sphere.rotations)


def _described(scene: Scene, rotation: Rotation) -> SteadyRotation:
    rates = floats(rotation.omega)
    still = 2 if rotation.axis else 1
    growth, decay = (None, None) if rotation.everywhere else constants(scene, rates, still)
    return SteadyRotation(
        rotation.nature, rates, floats(rotation.momentum), float(rotation.energy), rotation.with_losses,
        rotation.without_losses, rotation.axis, rotation.everywhere,
        growth if rotation.nature != MINIMUM else None, decay if rotation.nature == MINIMUM else None)


def constants(scene: Scene, rates: Float3, still: int, displacement: float | None = None
              ) -> tuple[float | None, float | None]:
    """(time constant of the fastest growth, of the slowest decay), s, by the eigenvalues at a rotation but
    for so many that are zero: |H| may be another, and the rotation another of its circle. displacement: of a
    damper's mass, m."""
    system = to_numpy(scene)
    at = np.zeros(len(system.equations.state))
    at[:3] = rates
    if displacement is not None:
        at[slices(scene.blocks)["damper_mass"].start] = displacement
    values = sorted(map(complex, np.linalg.eigvals(system.jacobian(at))), key=abs)[still:]
    largest = max((value.real for value in values), default=0.0)
    if abs(largest) <= NO_GROWTH * max(map(abs, values), default=0.0):
        return None, None
    return (1 / largest, None) if largest > 0 else (None, -1 / largest)


def threshold_of(case: Case, sphere: MomentumSphere) -> WheelThreshold | None:
    """That of the wheels of a case; None without any, and at H = 0."""
    result = sphere.threshold
    if result is None:
        return None
    speeds = lambda factor: tuple((wheel.name, float(factor * wheel.momentum / wheel.inertia))
                                  for wheel in case.wheels if wheel.inertia)
    built = WheelThreshold(float(result.factor), float(result.moment), result.omega, speeds(result.factor))
    own = [i for i, l in enumerate(sphere.wheel) if l]
    if case.state is None or len(own) > 1:
        return built
    i, = own
    rate, moment = _exact_state(case)[i], abs(sphere.wheel[i])
    if rate * sphere.wheel[i] <= 0:
        return built
    least = _least_at(sphere.D, i, abs(rate))
    if least is None:
        return built
    return WheelThreshold(built.factor, built.moment, built.rates, built.wheels, float(rate), float(least),
                          float(least / moment), speeds(least / moment))


def _least_at(D: Exact3, i: int, rate: Fraction) -> Fraction | None:
    """From which moment on a wheel along axis i has one minimum left, where the body turns about it at a
    rate, H = D_i w + l along it; None where no moment does."""
    first, second, _ = sorted(D, reverse=True)
    if D[i] < first:  # until m = w/H < 1/D1
        return (first - D[i]) * rate
    # the turn against the wheel, H = -(D_i w + l), is a minimum as long as
    # m = (D_i w + 2 l)/(D1 (D_i w + l)) < 1/D2
    ratio = first / second - 1
    return ratio * first * rate / (1 - ratio) if ratio < 1 else None


def _exact_state(case: Case) -> Exact3:
    exact: Any = case.exact_state
    return tuple(exact)
