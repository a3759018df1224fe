"""A resisting medium: a torque against the angular momentum of the body."""
from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import TYPE_CHECKING, Any, ClassVar

from ...errors import InputError
from ...numbers.units import PER_SECOND, in_si
from ...numbers.vectors import Given, Number, Triple
from .base import Effect

if TYPE_CHECKING:

    pass


@dataclass(frozen=True)
class Resistance(Effect):
    """Torque -c D omega, N m, with c > 0 in 1/s (Galal et al., liquid cavity: eq. (2), where c is eps^2
    zeta)."""

    name: ClassVar[str] = "resistance"
    takes: ClassVar[str] = "outside"
    agent: ClassVar[str] = "the medium"
    keys: ClassVar[tuple[str, ...]] = ("coefficient",)
    symbols: ClassVar[tuple[str, ...]] = ("zeta",)
    isotropic: ClassVar[bool] = True
    small: ClassVar[bool] = True
    keeps_volume: ClassVar[bool] = False

    coefficient: Given
    exact: Fraction = field(init=False, repr=False)

    def __post_init__(self) -> None:
        value = in_si(self.coefficient, PER_SECOND, "coefficient")
        if value < 0:
            raise InputError(f"coefficient: expected a number that is not negative, got {float(value):g}")
        object.__setattr__(self, "exact", value)
        object.__setattr__(self, "coefficient", float(value))

    @classmethod
    def from_case(cls, table: Any, context: Any) -> Resistance | None:
        value = table.positive("coefficient", zero=True) if table.required("coefficient") else None
        return None if value is None else cls(value)

    def terms(self) -> dict[str, Any]:
        return {"c": self.exact}

    def torque_along(self, motion: Any, p: Mapping[str, Number]) -> Triple:
        return tuple(-p["zeta"] * d * w for d, w in zip(motion.D, motion.omega))
