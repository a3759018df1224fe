"""A force constant in the body at its centre of mass: it moves the body, it does not turn it."""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar

from ...numbers.exact import floats
from ...numbers.units import FORCE, vector_in_si
from ...numbers.vectors import Exact3, Given, Number, Triple
from .base import Effect

if TYPE_CHECKING:
    pass


@dataclass(frozen=True)
class BodyForce(Effect):
    """Force f, N, body frame, through the centre of mass (Galal et al., charged body: eq. (38)). The body
    needs a mass."""

    name: ClassVar[str] = "body_force"
    article: ClassVar[str] = "a"
    keys: ClassVar[tuple[str, ...]] = ("force",)
    symbols: ClassVar[tuple[str, ...]] = ("f1", "f2", "f3")
    works: ClassVar[bool] = False
    needs = ("position",)

    vector: Sequence[Given]
    exact: Exact3 = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "exact", vector_in_si(self.vector, FORCE, "force"))
        object.__setattr__(self, "vector", floats(self.exact))

    @classmethod
    def from_case(cls, table: Any, context: Any) -> Effect | None:
        if context.body.mass is None and not context.stand_in:
            table.fault("a force moves the body: give body.mass in kg")
            return None
        return super().from_case(table, context)

    def terms(self) -> dict[str, Any]:
        return {"forced": True}

    def force(self, motion: Any, p: Mapping[str, Number]) -> Triple:
        return tuple(p[name] for name in self.symbols)
