"""Eddy currents in a conducting body that turns in a magnetic field."""
from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import TYPE_CHECKING, Any, ClassVar

from ...errors import InputError
from ...numbers.units import EDDY, FLUX, in_si
from ...numbers.vectors import Given, Number, Triple, cross
from .base import Effect

if TYPE_CHECKING:
    from types import SimpleNamespace

    from ..equations import MotionView


@dataclass(frozen=True)
class EddyCurrents(Effect):
    """Torque k (omega x B) x B, N m, of a uniform field B at rest in space, along the vertical: B = B gamma.

    coefficient: k, N m s/T^2, alike about every axis of the body; field: B, T. Of a thin spherical shell of
    conductivity s, thickness d and radius r, k = 2 pi s d r^4/3; currents in the body itself must fade faster
    than it turns (Smith, NASA TR R-129, 1962; Wertz, Spacecraft Attitude Determination and Control, 1978,
    section 17.2; Youngquist et al., Am. J. Phys. 84, 181, 2016). T' = -k |omega x B|^2, and the angular
    momentum along the field stays: only rotation across the field is damped.
    """

    name: ClassVar[str] = "eddy_currents"
    takes: ClassVar[str] = "outside"
    agent: ClassVar[str] = "the eddy currents"
    keys: ClassVar[tuple[str, ...]] = ("coefficient", "field")
    isotropic: ClassVar[bool] = True
    small: ClassVar[bool] = True
    keeps_volume: ClassVar[bool] = False
    needs = ("gamma",)

    coefficient: Given
    field_strength: Given
    exact: tuple[Fraction, Fraction] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        k = in_si(self.coefficient, EDDY, "coefficient")
        B = in_si(self.field_strength, FLUX, "field")
        for key, value in (("coefficient", k), ("field", B)):
            if value < 0:
                raise InputError(f"{key}: expected a number that is not negative, got {float(value):g}")
        object.__setattr__(self, "exact", (k, B))
        object.__setattr__(self, "coefficient", float(k))
        object.__setattr__(self, "field_strength", float(B))

    @classmethod
    def from_case(cls, table: Any, context: Any) -> EddyCurrents | None:
        complete = table.required(*cls.keys)
        k, B = (table.positive(key, zero=True) for key in cls.keys)
        return cls(k, B) if complete and None not in (k, B) else None

    def terms(self) -> dict[str, Any]:
        return {"eddy": self.parameters()["kB2"]}

    def written(self) -> dict[str, Any]:
        return dict(zip(self.keys, self.exact))

    def parameters(self) -> dict[str, Fraction]:
        k, B = self.exact
        return {"kB2": k * B * B}

    def torque_along(self, motion: SimpleNamespace | MotionView, p: Mapping[str, Number]) -> Triple:
        return tuple(p["kB2"] * t for t in cross(cross(motion.omega, motion.gamma), motion.gamma))

    def area(self, motion: MotionView, p: Mapping[str, Number]) -> Number:
        return 0 * motion.gamma[0]
