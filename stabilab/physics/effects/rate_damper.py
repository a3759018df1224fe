"""A linear damper: a torque of the outside against the angular velocity."""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import combinations
from typing import Any, ClassVar

from ...errors import InputError
from ...numbers.exact import floats
from ...numbers.principal import SLACK, PrincipalAxes, evened, principal_minors
from ...numbers.units import MOMENTUM, in_si, vector_in_si
from ...numbers.vectors import Exact3, Given, Number, Triple, dot
from .base import Effect

ENTRIES = {"C11": (0, 0), "C22": (1, 1), "C33": (2, 2), "C12": (0, 1), "C13": (0, 2), "C23": (1, 2)}


@dataclass(frozen=True)
class RateDamper(Effect):
    """Torque -C omega, N m: C, N m s, symmetric and positive semidefinite, so that T' = -omega . C omega <= 0
    (Rayleigh's dissipation function omega . C omega/2). It is of the outside: the angular momentum falls.

    coefficient: one number, the same about every axis; three, about the axes of the body; or the rows of C.
    """

    name: ClassVar[str] = "rate_damper"
    article: ClassVar[str] = "a"
    takes: ClassVar[str] = "outside"
    agent: ClassVar[str] = "the damper"
    keys: ClassVar[tuple[str, ...]] = ("coefficient",)
    small: ClassVar[bool] = True
    keeps_volume: ClassVar[bool] = False

    coefficient: Given | Sequence[Given] | Sequence[Sequence[Given]]
    exact: tuple[Exact3, ...] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        rows = _rows(self.coefficient)
        if why := fault_of(rows):
            raise InputError(f"coefficient: {why}")
        object.__setattr__(self, "exact", rows)
        object.__setattr__(self, "coefficient", tuple(map(floats, rows)))

    @classmethod
    def from_case(cls, table: Any, context: Any) -> RateDamper | None:
        if not table.required("coefficient"):
            return None
        supplied = table.data["coefficient"]
        read = (table.number if not isinstance(supplied, list) else
                table.matrix if any(isinstance(row, list) for row in supplied) else table.vector)
        value = read("coefficient")
        why = None if value is None else fault_of(_rows(value))
        if why:
            table.fault(why, "coefficient")
        return None if value is None or why else cls(value)

    def terms(self) -> dict[str, Any]:
        return {"C": self.exact}

    def written(self) -> dict[str, Any]:
        C = self.exact
        diagonal = tuple(C[i][i] for i in range(3))
        return {"coefficient": C if any(C[i][j] for i, j in combinations(range(3), 2)) else
                diagonal if len(set(diagonal)) > 1 else diagonal[0]}

    def turned(self, frame: PrincipalAxes) -> RateDamper:
        if not isinstance(self.written()["coefficient"], tuple):
            return self
        return RateDamper(evened([[dot(a, [dot(row, b) for row in self.exact]) for b in frame.axes]
                                  for a in frame.axes], SLACK))

    def parameters(self) -> dict[str, Fraction]:
        return {name: self.exact[i][j] for name, (i, j) in ENTRIES.items()}

    def torque(self, omega: Triple, p: Mapping[str, Number]) -> Triple:
        C = {location: p[name] for name, (i, j) in ENTRIES.items() for location in ((i, j), (j, i))}
        return tuple(-sum(C[i, j] * omega[j] for j in range(3)) for i in range(3))


def _rows(supplied: Any) -> tuple[Exact3, ...]:
    """The matrix of a number, of three, or of three rows of them."""
    if isinstance(supplied, str) or not hasattr(supplied, "__iter__"):
        supplied = [in_si(supplied, MOMENTUM, "coefficient")] * 3
    rows = list(supplied)
    if len(rows) == 3 and all(hasattr(row, "__iter__") and not isinstance(row, str) for row in rows):
        return tuple(vector_in_si(row, MOMENTUM, "coefficient") for row in rows)
    diagonal = vector_in_si(rows, MOMENTUM, "coefficient")
    return tuple(tuple(diagonal[i] if i == j else Fraction(0) for j in range(3)) for i in range(3))


def fault_of(rows: Sequence[Exact3]) -> str:
    """Why a matrix is that of no damper, and what was expected; empty where it is one. What irrational axes
    leave of a zero is none."""
    for i, j in combinations(range(3), 2):
        if rows[i][j] != rows[j][i]:
            return (f"the matrix is not symmetric: {float(rows[i][j]):g} in row {i + 1} and "
                    f"{float(rows[j][i]):g} in row {j + 1}; write the same number in both places")
    size = max(abs(v) for row in rows for v in row)
    for order, minor in principal_minors(rows):
        if minor < -SLACK * size**order:
            if order == 1:
                return f"expected no negative number, got {float(minor):g}: a damper takes energy"
            return ("the matrix is not positive semidefinite: about some axis it would give energy; lessen "
                    "the numbers off its diagonal")
    return ""
