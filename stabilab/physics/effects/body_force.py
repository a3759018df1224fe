"""A force constant in the body at its centre of mass: it moves the body, it does not turn it."""
from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction
from typing import ClassVar

from ...numbers.exact import exact_vector, floats
from .base import Effect


@dataclass(frozen=True)
class BodyForce(Effect):
    """Force f, N, body frame, through the centre of mass (Galal et al., charged body: eq. (38)). The body needs a mass."""

    name: ClassVar[str] = "body_force"
    keys: ClassVar[tuple[str, ...]] = ("force",)
    works: ClassVar[bool] = False
    needs = ("position",)

    vector: tuple[float, float, float]
    exact: tuple[Fraction, Fraction, Fraction] = field(init=False, repr=False)

    def __post_init__(self):
        object.__setattr__(self, "exact", exact_vector(self.vector, "force"))
        object.__setattr__(self, "vector", floats(self.exact))

    @classmethod
    def from_case(cls, table, context):
        if context.body.mass is None and not context.stand_in:
            table.fault("a force moves the body: give body.mass in kg")
            return None
        return super().from_case(table, context)

    def parameters(self):
        return dict(zip(("f1", "f2", "f3"), self.exact))

    def force(self, motion, p):
        return p["f1"], p["f2"], p["f3"]
