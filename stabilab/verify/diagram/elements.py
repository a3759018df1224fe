"""Coefficients of the equations while a number t varies: rational functions of t, or what they are at one algebraic value of it."""
from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from .work import Work, bits

if TYPE_CHECKING:
    from flint import fmpq_poly


@dataclass(frozen=True)
class Ratio:
    """top/bottom, polynomials in t without a common factor. Whoever divides by one notes its top: there the division fails."""

    top: fmpq_poly
    bottom: fmpq_poly
    work: Work = field(compare=False)

    @classmethod
    def of(cls, polynomial, work: Work) -> Ratio:
        """A polynomial in t."""
        return cls(polynomial, polynomial * 0 + 1, work)

    def __bool__(self) -> bool:
        return self.top != 0

    def __add__(self, other: Ratio) -> Ratio:
        return _reduced(self.top * other.bottom + other.top * self.bottom, self.bottom * other.bottom, self.work)

    def __sub__(self, other: Ratio) -> Ratio:
        return _reduced(self.top * other.bottom - other.top * self.bottom, self.bottom * other.bottom, self.work)

    def __mul__(self, other: Ratio) -> Ratio:
        return _reduced(self.top * other.top, self.bottom * other.bottom, self.work)

    def inverse(self) -> Ratio:
        """1 over it; it is not zero."""
        return _reduced(self.bottom, self.top, self.work)

    def over(self, whole: int) -> Ratio:
        """It, over a whole number."""
        return Ratio(self.top / whole, self.bottom, self.work)


def _reduced(top, bottom, work: Work) -> Ratio:
    work.common(top, bottom)
    common = top.gcd(bottom)
    lead = (bottom / common).leading_coefficient()
    return Ratio(top / common / lead, bottom / common / lead, work)


@dataclass(frozen=True)
class Residue:
    """What a polynomial in t is at a zero of an irreducible one, `at`: of degree one at a rational value."""

    value: fmpq_poly
    at: fmpq_poly
    work: Work = field(compare=False)

    def __bool__(self) -> bool:
        return self.value != 0

    def __add__(self, other: Residue) -> Residue:
        return Residue(self.value + other.value, self.at, self.work)

    def __sub__(self, other: Residue) -> Residue:
        return Residue(self.value - other.value, self.at, self.work)

    def __mul__(self, other: Residue) -> Residue:
        product = self.value * other.value
        self.work.division(product, self.at)
        return Residue(product % self.at, self.at, self.work)

    def inverse(self) -> Residue:
        """1 over it; it is not zero."""
        self.work.spend((1 + self.at.degree()) * (bits(self.value) + bits(self.at)))
        self.work.division(self.value, self.at)
        _, found, _ = self.value.xgcd(self.at)
        return Residue(found % self.at, self.at, self.work)

    def over(self, whole: int) -> Residue:
        """It, over a whole number."""
        return Residue(self.value / whole, self.at, self.work)
