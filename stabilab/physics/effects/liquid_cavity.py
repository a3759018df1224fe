"""A cavity filled with viscous liquid, and how fast the motion of the body without it changes."""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from math import pi
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, ClassVar

from ...errors import InputError
from ...numbers.exact import precise
from ...numbers.units import DENSITY, LENGTH, LENGTH_7, VISCOSITY, in_si
from ...numbers.vectors import Given, Number, Triple, cross, cross_matrix, dot
from ...reasons import Quantity, Sentence
from .base import Effect, Limit

if TYPE_CHECKING:
    from ..equations import MotionView
    from ..scene import Scene


# --- How fast a scene's motion goes: the rate by which the series behind an approximate law is judged
def pace(scene: Scene, state: Mapping[str, Sequence[Number]], without: Effect) -> Number:
    """The fastest rate of the motion at a state, 1/s, for any shape of its components; `without`: the effect
    that asks.

    |omega| + |A| + sqrt(|tau|/D): A is the derivative of omega' by omega along the motion without that effect
    (Frobenius norm: wheel, charge, resistance, the body's own turning), tau the torque at omega = 0 of
    effects that are not small, D the least moment. So |omega'' + omega x omega'| is at most pace times
    |omega'| where nothing but omega sets the torque.
    """
    D = tuple(map(float, scene.body.inertia))
    omega = state["omega"]
    zero = omega[0] * 0.0
    carried, still, slope = [0.0] * 3, [zero] * 3, [[zero] * 3 for _ in range(3)]
    for effect in scene.effects:
        if effect is without or any(block not in state for block in effect.needs if block in ("gamma",)):
            continue
        p = {name: float(value) for name, value in effect.parameters().items()}
        carried = [a + b for a, b in zip(carried, effect.momentum(p) or (0.0,) * 3)]
        first = _torque(effect, D, state, (zero, zero, zero), p)
        still = still if effect.small else [a + b for a, b in zip(still, first)]
        for j in range(3):
            unit = tuple(zero + (i == j) for i in range(3))
            slope_j = _torque(effect, D, state, unit, p)
            for i in range(3):
                slope[i][j] = slope[i][j] + slope_j[i] - first[i]
    H = [d * w + h for d, w, h in zip(D, omega, carried)]
    turn, spin = cross_matrix(H), cross_matrix(omega)  # of H x omega
    entries = [(slope[i][j] + turn[i][j] - spin[i][j] * D[j]) / D[i] for i in range(3) for j in range(3)]
    squares = sum(entry * entry for entry in entries)  # beyond 1e154 infinite, where ** 2 is an error
    return dot(omega, omega) ** 0.5 + squares ** 0.5 + (dot(still, still) ** 0.5 / min(D)) ** 0.5


def _torque(effect: Effect, D: Sequence[float], state: Mapping[str, Sequence[Number]],
            omega: Sequence[Number], p: Mapping[str, Number]) -> Triple:
    """The torque of an effect that is linear in omega, in numbers, with that of a part inside."""
    motion = SimpleNamespace(**{**state, "omega": omega}, D=D)
    torque = effect.torque_along(motion, p) or (0.0,) * 3
    part = effect.part(motion, p) if set(effect.needs) <= set(state) else None
    return torque if part is None else tuple(a + b for a, b in zip(torque, part.torque))


# --- A cavity filled with a very viscous liquid: the torque of the liquid carried along the undisturbed
# motion
TORQUES = ("consistent", "printed")
# of the Reynolds number: the next term of the series over the one that is kept, for a sphere
NEXT_TERM = 2 / 45
REYNOLDS = Sentence("liquid-reynolds-number", "Reynolds number n h²/ν of the liquid")()
TOO_THIN = Sentence(
    "liquid-too-thin", "the liquid's torque is the first term of a series in this number (the next is "
    "{share} of it times as large), so a liquid this thin does not move as computed")(
        share=Quantity(NEXT_TERM, digits=2))
TORQUE_RATIO = Sentence("liquid-torque-ratio", "torque of the liquid over the body's own, κ n/D")()
OUTWEIGHS = Sentence(
    "liquid-torque-outweighs",
    "the liquid's torque is taken along the body's motion without liquid, which it would outweigh")()
MOMENT_RATIO = Sentence("liquid-moment-ratio", "moment of the liquid over the least of the body")()
NO_SUCH_BODY = Sentence("liquid-without-body", "no body has these moments and holds this liquid")()
SOURCE = "Chernousko's expansion for small Reynolds numbers; Galal et al., liquid cavity: sections 1 and 2"


@dataclass(frozen=True)
class LiquidCavity(Effect):
    """Torque kappa (omega'' + omega x omega'), kappa = density P0/viscosity, N m s^3: the rates of omega
    taken along the motion without the small effects, as Chernousko's derivation for small Reynolds numbers
    demands.

    density, kg/m^3; viscosity, kinematic, m^2/s; P0, m^7 (8 pi h^7/525 for a sphere of radius h). torque:
    "consistent", or "printed" (Galal et al., liquid cavity: eq. (3)), which holds for a body without rotor
    and charge only: its undisturbed motion is the free one, whatever else acts.
    """

    name: ClassVar[str] = "liquid_cavity"
    article: ClassVar[str] = "a"
    takes: ClassVar[str] = "inside"
    agent: ClassVar[str] = "the liquid"
    keys: ClassVar[tuple[str, ...]] = ("density", "viscosity", "P0", "radius", "torque")
    certain: ClassVar[tuple[str, ...]] = ("torque",)
    symbols: ClassVar[tuple[str, ...]] = ("kappa",)
    isotropic: ClassVar[bool] = True
    small: ClassVar[bool] = True
    keeps_volume: ClassVar[bool] = False
    approximate: ClassVar[bool] = True

    density: Given
    viscosity: Given
    P0: Given
    law: str = "consistent"
    exact: Fraction = field(init=False, repr=False)

    def __post_init__(self) -> None:
        density, P0 = in_si(self.density, DENSITY, "density"), in_si(self.P0, LENGTH_7, "P0")
        viscosity = in_si(self.viscosity, VISCOSITY, "viscosity")
        for name, value in (("density", density), ("viscosity", viscosity), ("P0", P0)):
            if value < 0 or (value == 0 and name == "viscosity"):
                raise InputError(f"{name}: expected a positive number, got {float(value):g}")
        if not isinstance(self.law, str) or self.law not in TORQUES:
            raise InputError(f'torque: expected "consistent" or "printed", got {self.law!r}')
        object.__setattr__(self, "exact", density * P0 / viscosity)
        for name, value in (("density", density), ("viscosity", viscosity), ("P0", P0)):
            object.__setattr__(self, name, float(value))

    @classmethod
    def of_sphere(cls, density: Given, viscosity: Given, radius: Given,
                  law: str = "consistent") -> LiquidCavity:
        """The cavity as a sphere of this radius, m."""
        length = in_si(radius, LENGTH, "radius")
        if length < 0:
            raise InputError(f"radius: expected a positive number, got {float(length):g}")
        return cls(density, viscosity, 8 * precise("pi") * length**7 / 525, law)

    @classmethod
    def from_case(cls, table: Any, context: Any) -> LiquidCavity | None:
        complete, shape = table.required("density", "viscosity"), table.one_of("P0", "radius")
        if shape is None and not ("P0" in table or "radius" in table):
            table.fault("expected P0 (m^7) or the radius of a spherical cavity (m)")
        values = {key: table.positive(key, zero=key != "viscosity")
                  for key in ("density", "viscosity", "P0", "radius")}
        law = table.text("torque", "consistent")
        if law not in TORQUES:
            table.fault(f'expected "consistent" or "printed", got "{law}"', "torque")
        supplied = complete and shape is not None and law in TORQUES
        if not supplied or None in (values["density"], values["viscosity"], values[shape]):
            return None
        make = cls if shape == "P0" else cls.of_sphere
        return make(values["density"], values["viscosity"], values[shape], law)

    def terms(self) -> dict[str, Any]:
        return {"kappa": self.exact, "printed": self.law == "printed"}

    def written(self) -> dict[str, Any]:
        return {"density": self.density, "viscosity": self.viscosity, "P0": self.P0, "torque": self.law}

    def torque_along(self, motion: SimpleNamespace | MotionView, p: Mapping[str, Number]) -> Triple:
        first, second = motion.undisturbed(free=self.law == "printed")
        return tuple(p["kappa"] * (a + b) for a, b in zip(second, cross(motion.omega, first)))

    @property
    def radius(self) -> float:
        """Of the cavity, or of the sphere that has its P0, m."""
        return (525 * self.P0 / (8 * pi)) ** (1 / 7)

    @property
    def moment(self) -> float:
        """Moment of inertia of the liquid as if frozen, kg m^2: part of the body's."""
        return 8 * pi / 15 * self.density * self.radius**5

    def limits(self, scene: Scene) -> tuple[Limit, ...]:
        """Three numbers, with n the pace of the motion (`pace`), h the radius, D the least moment.

        Seen from space the liquid's angular momentum is a series in h^2 d/dt/nu: with z^2 = h^2 s/nu, a
        sphere that turns as exp(s t) gives its liquid the share 5 i2(z)/(z i1(z)) = 1 - z^2/35 + 2 z^4/1575 -
        ... of rigid rotation (i1, i2 modified spherical Bessel functions). The second term is the law, kappa
        = moment h^2/(35 nu); the third over it 2/45 of h^2 s/nu. The rates in it are those of the body
        without liquid, so its torque must be small beside the body's own; and the liquid, frozen, is part of
        the body.
        """
        lower, square, kappa = min(scene.body.inertia), self.radius**2 / self.viscosity, float(self.exact)
        return (
            Limit(REYNOLDS, 1.0, lambda state: square * pace(scene, state, self), TOO_THIN, SOURCE),
            Limit(TORQUE_RATIO, 1.0, lambda state: kappa / lower * pace(scene, state, self), OUTWEIGHS,
                  SOURCE),
            Limit(MOMENT_RATIO, 1.0, lambda state: self.moment / lower, NO_SUCH_BODY, SOURCE))
