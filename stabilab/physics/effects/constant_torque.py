"""A torque constant in the body: a thruster stuck open."""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar

from ...errors import InputError
from ...numbers.exact import floats
from ...numbers.principal import PrincipalAxes
from ...numbers.units import TORQUE, vector_in_si
from ...numbers.vectors import Exact3, Given, Number, Triple
from .base import Effect


@dataclass(frozen=True)
class ConstantTorque(Effect):
    """Body-fixed torque M, N m, body frame (paper: Amer et al. 2024, eq. (1))."""

    name: ClassVar[str] = "constant_torque"
    article: ClassVar[str] = "a"
    keys: ClassVar[tuple[str, ...]] = ("torque", "mu")
    symbols: ClassVar[tuple[str, ...]] = ("M1", "M2", "M3")
    small: ClassVar[bool] = True

    vector: Sequence[Given]
    exact: Exact3 = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "exact", vector_in_si(self.vector, TORQUE, "torque"))
        object.__setattr__(self, "vector", floats(self.exact))

    @classmethod
    def from_case(cls, table: Any, context: Any) -> ConstantTorque | None:
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
            return None

    def terms(self) -> dict[str, Any]:
        return {"M": self.exact}

    def turned(self, frame: PrincipalAxes) -> ConstantTorque:
        return ConstantTorque(frame.turned(self.exact))

    def torque(self, omega: Triple, p: Mapping[str, Number]) -> Triple:
        return tuple(p[name] for name in self.symbols)
