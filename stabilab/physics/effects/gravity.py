"""Uniform gravity on a body that turns about a fixed point."""
from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar

from ...numbers.exact import exact, floats
from ...numbers.principal import PrincipalAxes
from ...numbers.units import FORCE, LENGTH, in_si, vector_in_si
from ...numbers.vectors import Exact3, Float3, Given, Number, Triple, cross, dot
from .base import Effect

if TYPE_CHECKING:
    from types import SimpleNamespace

    from ..equations import MotionView


@dataclass(frozen=True)
class Gravity(Effect):
    """Torque M g c x gamma, N m: weight M g, N, at the centre of mass c, m, body frame; gamma is the
    direction of the weight (Amer et al. 2023, fast top: eq. (2)). Potential energy -M g c . gamma."""

    name: ClassVar[str] = "gravity"
    agent: ClassVar[str] = "the weight"
    keys: ClassVar[tuple[str, ...]] = ("weight", "centre_of_mass")
    symbols: ClassVar[tuple[str, ...]] = ("Mgx", "Mgy", "Mgz")
    needs = ("gamma",)

    weight: Given
    centre_of_mass: Float3
    exact: Exact3 = field(init=False, repr=False)

    def __post_init__(self) -> None:
        weight = in_si(self.weight, FORCE, "weight")
        centre = vector_in_si(self.centre_of_mass, LENGTH, "centre_of_mass")
        object.__setattr__(self, "exact", tuple(weight * c for c in centre))
        object.__setattr__(self, "weight", float(weight))
        object.__setattr__(self, "centre_of_mass", floats(centre))

    @classmethod
    def from_case(cls, table: Any, context: Any) -> Gravity | None:
        if not table.required(*cls.keys):
            return None
        weight, centre = table.number("weight"), table.vector("centre_of_mass")
        return None if weight is None or centre is None else cls(weight, centre)

    def terms(self) -> dict[str, Any]:
        return {"s": self.exact}

    def turned(self, frame: PrincipalAxes) -> Gravity:
        weight = exact(self.weight)
        return Gravity(weight, tuple(c / weight for c in frame.turned(self.exact))) if weight else self

    def _arm(self, p: Mapping[str, Number]) -> Triple:
        return tuple(p[name] for name in self.symbols)

    def torque_along(self, motion: SimpleNamespace | MotionView, p: Mapping[str, Number]) -> Triple:
        return cross(self._arm(p), motion.gamma)

    def potential(self, motion: MotionView, p: Mapping[str, Number]) -> Number:
        return -dot(self._arm(p), motion.gamma)

    def area(self, motion: MotionView, p: Mapping[str, Number]) -> Number:
        return 0 * motion.gamma[0]
