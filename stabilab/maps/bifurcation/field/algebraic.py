"""Real algebraic numbers, and polynomials over the field of one: how many roots these have, and how often each counts, exactly.

An element of Q(alpha) is one of flint's rational polynomials, reduced by the irreducible polynomial of alpha; a polynomial over the field is a
list of them, lowest power first.
"""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

from ....numbers.balls import Unclear, real_roots_of, working
from .gcd import field_gcd

if TYPE_CHECKING:
    from flint import arb, fmpq_poly

FieldPoly = list  # of fmpq_poly
Powers = list  # of (square-free FieldPoly, how often it counts)


@dataclass(frozen=True)
class Algebraic:
    """The real root number `index`, in rising order, of an irreducible polynomial with rational coefficients."""

    polynomial: fmpq_poly
    index: int

    @property
    def rational(self) -> Fraction | None:
        """The number itself where it is rational."""
        if self.polynomial.degree() != 1:
            return None
        low, lead = self.polynomial[0], self.polynomial[1]
        value = -low / lead
        return Fraction(int(value.p), int(value.q))

    def ball(self, bits: int) -> arb:
        """A ball of so many bits about it, to be used in the same precision."""
        with working(bits):
            return real_roots_of(self.polynomial)[self.index][0]

    def __float__(self) -> float:
        exact = self.rational
        return float(exact) if exact is not None else float(self.ball(256).mid())

    def reduced(self, element: fmpq_poly) -> fmpq_poly:
        """The element of the field with powers of alpha below its degree."""
        return element % self.polynomial

    def trimmed(self, coefficients: Sequence[fmpq_poly]) -> FieldPoly:
        """A polynomial over the field without leading zeros."""
        out = [self.reduced(c) for c in coefficients]
        while out and out[-1] == 0:
            out.pop()
        return out

    def inverse(self, element: fmpq_poly) -> fmpq_poly:
        """1/element."""
        _, found, _ = element.xgcd(self.polynomial)
        return self.reduced(found)

    def monic(self, f: FieldPoly) -> FieldPoly:
        """The polynomial over its leading coefficient."""
        lead = self.inverse(f[-1])
        return [self.reduced(c * lead) for c in f]

    def divided(self, f: FieldPoly, g: FieldPoly) -> tuple[FieldPoly, FieldPoly]:
        """Quotient and remainder; g is not zero."""
        rest, lead, n = list(f), self.inverse(g[-1]), len(g)
        quotient = [lead * 0] * max(0, len(f) - n + 1)
        for i in range(len(quotient) - 1, -1, -1):
            quotient[i] = factor = self.reduced(rest[i + n - 1] * lead)
            for j, c in enumerate(g):
                rest[i + j] = self.reduced(rest[i + j] - factor * c)
        return quotient, self.trimmed(rest[:n - 1])

    def gcd(self, f: FieldPoly, g: FieldPoly) -> FieldPoly:
        """The greatest common divisor, monic."""
        if f and g and (found := field_gcd(self.polynomial, f, g)) is not None:
            return found
        while g:
            f, g = g, self.divided(f, g)[1]
        return self.monic(f)

    def powers(self, f: FieldPoly) -> Powers:
        """(square-free factor, how often it counts) of a polynomial that is not zero, by Yun's algorithm; constants are left out."""
        out: list[tuple[FieldPoly, int]] = []
        slope = derivative(f)
        if not slope:
            return out
        common = self.gcd(f, slope)
        b, c = self.divided(f, common)[0], self.divided(slope, common)[0]
        d, times = self._less(c, derivative(b)), 1
        while len(b) > 1:
            common = self.gcd(b, d) if d else self.monic(b)
            if len(common) > 1:
                out.append((common, times))
            b, c = self.divided(b, common)[0], self.divided(d, common)[0] if d else []
            d, times = self._less(c, derivative(b)), times + 1
        return out

    def _less(self, f: FieldPoly, g: FieldPoly) -> FieldPoly:
        size = max(len(f), len(g))
        zero = self.polynomial * 0
        take = lambda h, n: h[n] if n < len(h) else zero
        return self.trimmed([take(f, n) - take(g, n) for n in range(size)])

    def real_roots(self, powers: Powers, bits: int) -> list[tuple[arb, int]]:
        """(ball, how often it counts) of the distinct real roots of a polynomial, given its `powers`, rising. Unclear where the bits do not isolate them."""
        from flint import acb, acb_poly, arb_poly
        at, found = self.ball(bits), []
        for factor, times in powers:
            values = [arb_poly(c)(at) for c in factor]
            try:
                roots = acb_poly([acb(v) for v in values]).roots()
            except ValueError:
                raise Unclear from None
            # conjugates are roots as well, so a ball that meets the real axis and no other root holds a real one
            found += [(sharpened(values, root.real), times) for root in roots if root.imag.contains(0)]
        return sorted(found, key=lambda one: one[0].mid())


def derivative(f: FieldPoly) -> FieldPoly:
    """Of a polynomial over the field."""
    return [c * n for n, c in enumerate(f)][1:]


def sharpened(coefficients: Sequence[arb], root: arb) -> arb:
    """A narrower ball about a simple root, by Newton's method over balls (the part of the step that the ball does not hold has no root)."""
    from flint import arb_poly
    f = arb_poly(list(coefficients))
    slope = f.derivative()
    for _ in range(60):
        middle = root.mid()
        rate = slope(root)
        if rate.contains(0):
            return root
        step = middle - f(middle) / rate
        if not step.overlaps(root):
            return root
        new = step.intersection(root)
        if not new.rad() < root.rad() / 2:
            return new
        root = new
    return root
