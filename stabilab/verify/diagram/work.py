"""How much work the check of a diagram may take: bits times operations, counted before each, so that the same file has the same end everywhere."""
from __future__ import annotations

from typing import Any

MOST = 2_000_000_000  # some five seconds at the most; the certificates of the tests take up to a tenth


class TooLarge(Exception):
    """More work than a certificate may ask for."""


class Work:
    """What is left of it."""

    def __init__(self, left: int | None = None):
        self.left = MOST if left is None else left

    def spend(self, count: int) -> None:
        """Raises `TooLarge` when it is used up."""
        self.left -= count
        if self.left < 0:
            raise TooLarge

    def division(self, f: Any, g: Any) -> None:
        """A remainder of two polynomials: their bits, once for each degree."""
        self.spend(OVERHEAD + (bits(f) + bits(g)) * (1 + max(f.degree(), 0) + max(g.degree(), 0)))

    def common(self, f: Any, g: Any) -> None:
        """The greatest common factor of two polynomials, which is formed modulo primes."""
        self.spend(OVERHEAD + (bits(f) + bits(g)) * (1 + max(f.degree(), 0) + max(g.degree(), 0)) // 4)

    def value(self, f: Any, at: Any) -> None:
        """The value of a polynomial at a rational number."""
        degree = max(f.degree(), 0)
        self.spend(OVERHEAD + 4 * (1 + degree) * (height(f) + degree * (at.numerator.bit_length() + at.denominator.bit_length())))

    def factors(self, f: Any) -> None:
        """The irreducible factors of a polynomial."""
        degree = max(f.degree(), 0)
        self.spend(OVERHEAD + (1 + degree) ** 3 * height(f))


OVERHEAD = 2000  # of a call: as long as so many bits take


def height(f: Any) -> int:
    """The bits of the longest coefficient."""
    return int(f.numer().height_bits()) + int(f.denom().bit_length())


def bits(f: Any) -> int:
    """The bits of all coefficients."""
    return height(f) * (1 + max(f.degree(), 0))
