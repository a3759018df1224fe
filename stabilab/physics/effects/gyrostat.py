"""A momentum wheel (rotor): angular momentum of constant size and direction in the body."""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar

from ...numbers.exact import floats
from ...numbers.principal import PrincipalAxes
from ...numbers.units import MOMENTUM, vector_in_si
from ...numbers.vectors import Exact3, Given, Number, Triple
from .base import Effect


@dataclass(frozen=True)
class Gyrostat(Effect):
    """Gyrostatic moment lambda, body frame, kg m^2/s, any direction (paper: Amer et al. 2024, eq. (1), along
    axis 1).

    moment: three numbers or exact strings. It adds lambda to the angular momentum H = D omega + lambda; its
    torque lambda x omega does no work. Raises InputError for what is no vector of numbers.
    """

    name: ClassVar[str] = "gyrostat"
    article: ClassVar[str] = "a"
    keys: ClassVar[tuple[str, ...]] = ("momentum",)
    symbols: ClassVar[tuple[str, ...]] = ("lambda1", "lambda2", "lambda3")
    works: ClassVar[bool] = False

    moment: Sequence[Given]
    exact: Exact3 = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "exact", vector_in_si(self.moment, MOMENTUM, "momentum"))
        object.__setattr__(self, "moment", floats(self.exact))

    def terms(self) -> dict[str, Any]:
        return {"Lambda": self.exact}

    def turned(self, frame: PrincipalAxes) -> Gyrostat:
        return Gyrostat(frame.turned(self.exact))

    def momentum(self, p: Mapping[str, Number]) -> Triple:
        return tuple(p[name] for name in self.symbols)
