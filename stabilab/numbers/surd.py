"""Numbers p + q sqrt(d) with rational p, q and d >= 0: roots of a quadratic, signs decided exactly."""
from __future__ import annotations

from fractions import Fraction

from ..record import record
from .exact import sqrt_fraction
from .vectors import Number


@record
class Surd:
    """p + q sqrt(d). Arithmetic joins surds of one d and rationals."""

    p: Fraction
    q: Fraction = Fraction(0)
    d: Fraction = Fraction(0)

    def __add__(self, other: Number) -> Surd:
        if isinstance(other, Surd):
            return Surd(self.p + other.p, self.q + other.q, self.d)
        return Surd(self.p + other, self.q, self.d)

    def __mul__(self, other: Number) -> Surd:
        if isinstance(other, Surd):
            return Surd(self.p * other.p + self.q * other.q * self.d, self.p * other.q + self.q * other.p, self.d)
        return Surd(self.p * other, self.q * other, self.d)

    def __neg__(self) -> Surd:
        return Surd(-self.p, -self.q, self.d)

    def __sub__(self, other: Number) -> Surd:
        return self + -other

    __radd__, __rmul__ = __add__, __mul__

    @property
    def sign(self) -> int:
        """-1, 0 or 1, exactly."""
        second = 0 if not self.d else _sign(self.q)
        first = _sign(self.p)
        if first * second >= 0:
            return first or second
        return first * _sign(self.p * self.p - self.q * self.q * self.d)

    def fraction(self) -> Fraction:
        """A rational within about 2**-200 relative; where the two terms oppose, by the conjugate, without
        cancellation."""
        if not self.sign:
            return Fraction(0)
        term = self.q * sqrt_fraction(self.d)
        if self.p * term >= 0:
            return self.p + term
        return (self.p * self.p - self.q * self.q * self.d) / (self.p - term)


def _sign(value: Fraction) -> int:
    return (value > 0) - (value < 0)
