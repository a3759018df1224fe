"""Real zeros of polynomials with rational coefficients: by irreducible factors, so that a rational zero is exact."""
from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from .numbers import Malformed, fraction
from .precision import working
from .zeros import above, below

START_BITS, MOST_BITS = 64, 1 << 15


@dataclass(frozen=True)
class Zero:
    """A real zero of an irreducible factor: order in the polynomial, low <= zero <= high (equal where it is rational)."""

    factor: Any
    order: int
    low: Fraction
    high: Fraction

    def within(self, low: Fraction, high: Fraction) -> bool:  # type: ignore[return]  # the loop ends in an answer
        """Whether the zero lies in [low, high]; irrational zeros are enclosed more closely until it is plain."""
        for zero in self._closer():
            if zero.high < low or high < zero.low:
                return False
            if low <= zero.low and zero.high <= high:
                return True

    def before(self, other: Zero) -> bool:  # type: ignore[return]  # the loop ends in an answer
        """Whether it is less than a zero of another irreducible factor."""
        for one, two in zip(self._closer(), other._closer()):
            if one.high < two.low or two.high < one.low:
                return one.high < two.low

    def _closer(self):
        """The same zero, enclosed more and more closely."""
        bits, zero = START_BITS, self
        while bits <= MOST_BITS:
            yield zero
            bits *= 2
            zero = next(z for z in _zeros_of(self.factor, self.order, bits) if z.low <= zero.high and zero.low <= z.high)
        raise Malformed(f"curve: a zero of m that {MOST_BITS} bits do not tell from another number of the certificate")


def real_zeros(polynomial) -> list[Zero]:
    """The distinct real zeros, rising, their brackets apart."""
    factors = polynomial.factor()[1] if polynomial.degree() > 0 else []
    bits = START_BITS
    while bits <= MOST_BITS:
        found = sorted((z for f, order in factors for z in _zeros_of(f, order, bits)), key=lambda z: z.low)
        if all(a.high < b.low for a, b in zip(found, found[1:])):
            return found
        bits *= 2
    raise Malformed(f"curve: zeros of m that {MOST_BITS} bits do not tell apart")


def _zeros_of(factor, order, bits) -> list[Zero]:
    from flint import arb
    if factor.degree() == 1:
        exact = -fraction(factor[0] / factor[1])
        return [Zero(factor, order, exact, exact)]
    with working(bits):
        balls = [arb(z.real) for z, _ in factor.complex_roots() if z.imag.is_zero()]
    return [Zero(factor, order, below(b), above(b)) for b in balls]
