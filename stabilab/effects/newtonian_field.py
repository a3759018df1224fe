"""A distant centre of Newtonian attraction: its torque on the body to second order in size over distance."""
from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction
from typing import ClassVar

from ..exact import exact
from .base import Effect, cross


@dataclass(frozen=True)
class NewtonianField(Effect):
    """Torque N gamma x D gamma, N m, with N = 3 lambda/R^3 in 1/s^2; gamma along the line to the centre (Amer et al.
    2023, fast top: eq. (2); its eq. (1) has the opposite sign). Potential energy N gamma . D gamma/2."""

    name: ClassVar[str] = "newtonian_field"
    keys: ClassVar[tuple[str, ...]] = ("strength", "lambda", "R")
    needs = ("gamma",)

    strength: float
    exact: Fraction = field(init=False, repr=False)

    def __post_init__(self):
        object.__setattr__(self, "exact", exact(self.strength))
        object.__setattr__(self, "strength", float(self.exact))

    @classmethod
    def from_case(cls, table, context):
        if table.one_of("strength", "lambda") == "strength":
            if "R" in table:
                table.fault("R goes with lambda; strength is N = 3 lambda/R^3 already", "R")
            value = table.number("strength")
        elif not table.data:
            table.fault("expected strength (N = 3 lambda/R^3, 1/s^2), or lambda (m^3/s^2) and R (m)")
            return None
        elif not table.required("lambda", "R"):
            return None
        else:
            attraction, distance = table.number("lambda"), table.positive("R")
            value = None if None in (attraction, distance) else 3 * attraction / distance**3
        return None if value is None else cls(value)

    def parameters(self):
        return {"N": self.exact}

    def torque_along(self, motion, p):
        spread = tuple(d * g for d, g in zip(motion.D, motion.gamma))
        return tuple(p["N"] * t for t in cross(motion.gamma, spread))

    def potential(self, motion, p):
        return p["N"] * sum(d * g**2 for d, g in zip(motion.D, motion.gamma)) / 2

    def area(self, motion, p):
        return 0 * motion.gamma[0]
