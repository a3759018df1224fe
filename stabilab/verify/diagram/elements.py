"""Coefficients of the equations while a number t varies: rational functions of t, or what they are at one algebraic value of it."""
from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from flint import fmpq_poly


@dataclass(frozen=True)
class Ratio:
    """top/bottom, polynomials in t without a common factor. Whoever divides by one notes its top: there the division fails."""

    top: fmpq_poly
    bottom: fmpq_poly

    @classmethod
    def of(cls, polynomial) -> Ratio:
        """A polynomial in t."""
        return cls(polynomial, polynomial * 0 + 1)

    def __bool__(self) -> bool:
        return self.top != 0

    def __add__(self, other: Ratio) -> Ratio:
        return _reduced(self.top * other.bottom + other.top * self.bottom, self.bottom * other.bottom)

    def __sub__(self, other: Ratio) -> Ratio:
        return _reduced(self.top * other.bottom - other.top * self.bottom, self.bottom * other.bottom)

    def __mul__(self, other: Ratio) -> Ratio:
        return _reduced(self.top * other.top, self.bottom * other.bottom)

    def inverse(self) -> Ratio:
        """1 over it; it is not zero."""
        return _reduced(self.bottom, self.top)

    def over(self, whole: int) -> Ratio:
        """It, over a whole number."""
        return Ratio(self.top / whole, self.bottom)


def _reduced(top, bottom) -> Ratio:
    common = top.gcd(bottom)
    lead = (bottom / common).leading_coefficient()
    return Ratio(top / common / lead, bottom / common / lead)


@dataclass(frozen=True)
class Residue:
    """What a polynomial in t is at a zero of an irreducible one, `at`: of degree one at a rational value."""

    value: fmpq_poly
    at: fmpq_poly

    def __bool__(self) -> bool:
        return self.value != 0

    def __add__(self, other: Residue) -> Residue:
        return Residue(self.value + other.value, self.at)

    def __sub__(self, other: Residue) -> Residue:
        return Residue(self.value - other.value, self.at)

    def __mul__(self, other: Residue) -> Residue:
        return Residue(self.value * other.value % self.at, self.at)

    def inverse(self) -> Residue:
        """1 over it; it is not zero."""
        _, found, _ = self.value.xgcd(self.at)
        return Residue(found % self.at, self.at)

    def over(self, whole: int) -> Residue:
        """It, over a whole number."""
        return Residue(self.value / whole, self.at)
