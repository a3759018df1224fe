"""Polynomials in one variable with exact coefficients, and all their real roots: python-flint's, which know
no Fraction."""
from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from functools import reduce
from operator import mul
from typing import TYPE_CHECKING

from .balls import Digits, Unclear, fraction, polynomial, rational, real_roots_of, settled
from .vectors import Number

if TYPE_CHECKING:
    from flint import fmpq, fmpq_poly


class Poly:
    """Polynomial with rational coefficients, lowest power first; joins with rationals. flint: the library's
    own."""

    __slots__ = ("flint",)

    def __init__(self, coefficients: Iterable[Number] = ()) -> None:
        self.flint: fmpq_poly = polynomial(*coefficients)

    @classmethod
    def of(cls, flint: fmpq_poly) -> Poly:
        """That of the library."""
        made = cls.__new__(cls)
        made.flint = flint
        return made

    def __reduce__(self) -> tuple[type, tuple[tuple[Fraction, ...]]]:
        return Poly, (self.c,)  # the library's own goes to no other process

    @property
    def c(self) -> tuple[Fraction, ...]:
        """Its coefficients; the zero polynomial has none."""
        return tuple(map(fraction, self.flint.coeffs()))

    @property
    def degree(self) -> int:
        return int(self.flint.degree())

    def __bool__(self) -> bool:
        return self.degree >= 0

    def __call__(self, t: Fraction) -> Fraction:
        return fraction(self.flint(rational(t)))

    def __add__(self, other: Number) -> Poly:
        return Poly.of(self.flint + _flint(other))

    def __mul__(self, other: Number) -> Poly:
        return Poly.of(self.flint * _flint(other))

    def __neg__(self) -> Poly:
        return Poly.of(-self.flint)

    def __sub__(self, other: Number) -> Poly:
        return Poly.of(self.flint - _flint(other))

    def __rsub__(self, other: Number) -> Poly:
        return -self + other

    def __floordiv__(self, other: Poly) -> Poly:
        return Poly.of(self.flint // other.flint)

    __radd__, __rmul__ = __add__, __mul__

    def derivative(self) -> Poly:
        return Poly.of(self.flint.derivative())

    def gcd(self, other: Poly) -> Poly:
        """The greatest common divisor, monic."""
        return Poly.of(self.flint.gcd(other.flint))

    def without_root(self, root: Fraction) -> Poly:
        """The polynomial with every factor (t - root) divided out."""
        out = self
        while out.degree > 0 and not out(root):
            out = out // Poly((-root, 1))
        return out


def _flint(value: Number) -> fmpq_poly | fmpq:
    return value.flint if isinstance(value, Poly) else rational(value)


def real_roots(p: Poly, bits: int = 160) -> list[Fraction]:
    """Every real root of a nonzero polynomial once, rising, within 2**-bits relative, rational ones exactly;
    none is missed and none is invented."""
    from flint import arb
    factors = [factor for factor, _ in p.flint.factor()[1]]
    if not factors:
        return []
    simple = reduce(mul, factors)
    exact = sorted(-factor[0] / factor[1] for factor in factors if factor.degree() == 1)

    def found(digits: Digits) -> list[Fraction]:
        balls = [ball for ball, _ in real_roots_of(simple)]
        if not all(first < second for first, second in zip(balls, balls[1:])):
            raise Unclear
        known = [next((root for root in exact if ball.overlaps(arb(root))), None) for ball in balls]
        if [root for root in known if root is not None] != exact:
            raise Unclear  # a rational as a ball meets those of two roots
        return [fraction(ball.mid().fmpq() if root is None else root) for ball, root in zip(balls, known)]
    return settled(found, bits + 8)
