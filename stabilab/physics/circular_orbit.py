"""A satellite with momentum wheels on a circular orbit, where the gravity gradient turns it."""
from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from ..numbers.exact import sqrt_fraction
from ..numbers.vectors import Exact3


@dataclass(frozen=True)
class Satellite:
    """moments: principal, about the centre of mass, kg m^2; momentum: of the wheels relative to the body, N m
    s, along the principal axes; rate_squared: of the orbit, 1/s^2, whose root may be irrational."""

    moments: Exact3
    momentum: Exact3
    rate_squared: Fraction

    @property
    def rate(self) -> Fraction:
        """The orbital rate n, rad/s, exactly where it is rational, else to 240 bits."""
        return sqrt_fraction(self.rate_squared)

    def rounded(self, bits: int) -> Satellite:
        """With numbers of so many significant bits; zero and equal numbers stay so."""
        def short(value: Fraction) -> Fraction:
            unit = Fraction(2) ** (abs(value.numerator).bit_length() - value.denominator.bit_length() - bits)
            return round(value / unit) * unit
        return Satellite(tuple(map(short, self.moments)), tuple(map(short, self.momentum)),
                         short(self.rate_squared))
