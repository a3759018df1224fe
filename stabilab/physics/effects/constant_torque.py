"""A torque constant in the body: a thruster stuck open."""
from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction
from typing import ClassVar

from ...errors import InputError
from ...numbers.exact import exact_vector, floats
from .base import Effect


@dataclass(frozen=True)
class ConstantTorque(Effect):
    """Body-fixed torque M, N m, body frame (paper: Amer et al. 2024, eq. (1))."""

    name: ClassVar[str] = "constant_torque"
    keys: ClassVar[tuple[str, ...]] = ("torque", "mu")
    small: ClassVar[bool] = True

    vector: tuple[float, float, float]
    exact: tuple[Fraction, Fraction, Fraction] = field(init=False, repr=False)

    def __post_init__(self):
        object.__setattr__(self, "exact", exact_vector(self.vector, "torque"))
        object.__setattr__(self, "vector", floats(self.exact))

    @classmethod
    def from_case(cls, table, context):
        key = table.one_of("torque", "mu")
        if key is None:
            if not table.data:
                table.fault("expected torque = [M1, M2, M3] in N m, or mu = [mu1, mu2, mu3]")
            return None
        vector = table.vector(key)
        if vector is None:
            return None
        if key == "torque":
            return cls(vector)
        try:
            return cls(context.torque_from_mu(vector))
        except InputError as error:
            table.fault(f"{error}; give torque in N m", key)

    def turned(self, frame):
        return ConstantTorque(frame.turned(self.exact))

    def parameters(self):
        return dict(zip(("M1", "M2", "M3"), self.exact))

    def torque(self, omega, p):
        return (p["M1"], p["M2"], p["M3"])
