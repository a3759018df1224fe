"""A cavity filled with a very viscous liquid: the torque of the liquid carried along the undisturbed motion."""
from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction
from typing import ClassVar

from ..errors import InputError
from ..exact import exact, precise
from .base import Effect, cross

TORQUES = ("consistent", "printed")


@dataclass(frozen=True)
class LiquidCavity(Effect):
    """Torque kappa (omega'' + omega x omega'), kappa = density P0/viscosity, N m s^3: the rates of omega taken along
    the motion without the small effects, as Chernousko's derivation for small Reynolds numbers demands.

    density, kg/m^3; viscosity, kinematic, m^2/s; P0, m^7 (8 pi h^7/525 for a sphere of radius h). torque: "consistent",
    or "printed" (Galal et al., liquid cavity: eq. (3)), which holds for a body without rotor and charge only: its
    undisturbed motion is the free one, whatever else acts.
    """

    name: ClassVar[str] = "liquid_cavity"
    keys: ClassVar[tuple[str, ...]] = ("density", "viscosity", "P0", "radius", "torque")
    small: ClassVar[bool] = True
    keeps_volume: ClassVar[bool] = False

    density: float
    viscosity: float
    P0: float
    law: str = "consistent"
    exact: Fraction = field(init=False, repr=False)

    def __post_init__(self):
        density, viscosity, P0 = exact(self.density), exact(self.viscosity), exact(self.P0)
        for name, value in (("density", density), ("viscosity", viscosity), ("P0", P0)):
            if value < 0 or (value == 0 and name == "viscosity"):
                raise InputError(f"{name}: expected a positive number, got {float(value):g}")
        if self.law not in TORQUES:
            raise InputError(f'torque: expected "consistent" or "printed", got {self.law!r}')
        object.__setattr__(self, "exact", density * P0 / viscosity)
        for name, value in (("density", density), ("viscosity", viscosity), ("P0", P0)):
            object.__setattr__(self, name, float(value))

    @classmethod
    def of_sphere(cls, density, viscosity, radius, law: str = "consistent"):
        """The cavity as a sphere of this radius, m."""
        return cls(density, viscosity, 8 * precise("pi") * exact(radius) ** 7 / 525, law)

    @classmethod
    def from_case(cls, table, context):
        complete, shape = table.required("density", "viscosity"), table.one_of("P0", "radius")
        if shape is None and not ("P0" in table or "radius" in table):
            table.fault("expected P0 (m^7) or the radius of a spherical cavity (m)")
        values = {key: table.positive(key, zero=key != "viscosity") for key in ("density", "viscosity", "P0", "radius")}
        law = table.text("torque", "consistent")
        if law not in TORQUES:
            table.fault(f'expected "consistent" or "printed", got "{law}"', "torque")
        if not complete or shape is None or law not in TORQUES or None in (values["density"], values["viscosity"], values[shape]):
            return None
        make = cls if shape == "P0" else cls.of_sphere
        return make(values["density"], values["viscosity"], values[shape], law)

    def parameters(self):
        return {"kappa": self.exact}

    def torque_along(self, motion, p):
        first, second = motion.undisturbed(free=self.law == "printed")
        return tuple(p["kappa"] * (a + b) for a, b in zip(second, cross(motion.omega, first)))
