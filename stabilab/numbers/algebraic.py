"""Real algebraic numbers, polynomials over the field of one, and critical values: real roots in order, none
twice.

An element of Q(alpha) is one of flint's rational polynomials, reduced by the irreducible polynomial of alpha;
a polynomial over the field is a list of them, lowest power first.

Two such polynomials have their greatest common divisor from its images modulo primes: Euclid's algorithm over
the field doubles the length of its coefficients at every step, modulo a prime they have none. Where the
polynomial of the number keeps its degree and has no double root modulo the prime, and both polynomials are
integral there, one with an invertible leading coefficient, a common factor has an image of its own degree: so
the degree of the images is never too low. What is put together from them is the answer if it divides both,
and that is tried exactly.
"""
from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from math import isqrt
from typing import Any, NamedTuple, TypeAlias

from flint import acb_poly, arb, arb_poly, fmpq, fmpq_mpoly, fmpq_poly, fmpz, nmod_poly

from .balls import Unclear, fraction, narrowed, rational, real_roots_of, settled, working

Element: TypeAlias = Any  # a polynomial of the algebraic number, over the rationals or modulo a prime
FieldPoly: TypeAlias = list[Any]  # of fmpq_poly
Powers: TypeAlias = list[tuple[Any, int]]  # (square-free FieldPoly, how often it counts)

FIRST = 1 << 61  # the primes are below


def field_gcd(number: fmpq_poly, f: FieldPoly, g: FieldPoly) -> FieldPoly:
    """The monic one. number: an irreducible polynomial of the algebraic number; f, g: not zero, reduced by
    it."""
    full = [int(c) for c in number.numer().coeffs()]
    size, product, rows, tried = 0, 1, [[0]], 1
    for prime in (at for at in range(FIRST - 1, 1, -2) if fmpz(at).is_prime()):
        image = _image(full, prime, f, g)
        if image is None or (size and len(image) > size):
            continue
        if len(image) == 1:
            return [number * 0 + 1]
        if len(image) != size:
            size, product, tried = len(image), 1, 1
            rows = [[0] * (len(full) - 1) for _ in image]
        inverse = pow(product, -1, prime)
        for row, c in zip(rows, image):
            for n in range(len(row)):
                row[n] += product * ((int(c[n]) - row[n]) * inverse % prime)
        product *= prime
        if product.bit_length() >= 61 * tried:
            tried *= 2
            built = _rational(rows, product)
            if built is not None and not any(divided(number, h, built)[1] for h in (f, g)):
                return built
    raise AssertionError  # there are always more primes


def _image(full: list[int], prime: int, f: list[fmpq_poly], g: list[fmpq_poly]) -> list[nmod_poly] | None:
    """The monic divisor modulo a prime, by Euclid; None where the prime does not serve."""
    modulus = nmod_poly(full, prime)
    if modulus.degree() < len(full) - 1 or modulus.gcd(modulus.derivative()).degree() > 0:
        return None
    if any(int(c.denom()) % prime == 0 for h in (f, g) for c in h):
        return None
    item, two = ([nmod_poly([int(n) for n in c.numer().coeffs()],
                           prime) * pow(int(c.denom()), -1, prime) % modulus for c in h] for h in (f, g))
    if all(_inverse(h[-1], modulus) is None for h in (item, two)):
        return None
    while two:
        lead = _inverse(two[-1], modulus)
        if lead is None:
            return None
        two = [c * lead % modulus for c in two]
        item, two = two, divided(modulus, item, two)[1]
    return item


def _inverse(element: nmod_poly, modulus: nmod_poly) -> nmod_poly | None:
    common, result, _ = element.xgcd(modulus)
    return result * pow(int(common[0]), -1, int(modulus.modulus())) if common.degree() == 0 else None


def _rational(rows: list[list[int]], product: int) -> list[fmpq_poly] | None:
    """Fractions with these residues, of numerators and denominators below the root of half the product; None
    where there are none."""
    bound = isqrt(product // 2)
    out = []
    for row in rows:
        values = []
        for residue in row:
            a, b, u, v = product, residue % product, 0, 1
            while b > bound:
                q = a // b
                a, b, u, v = b, a - q * b, v, u - q * v
            if abs(v) > bound or v == 0:
                return None
            values.append(fmpq(b if v > 0 else -b, abs(v)))
        out.append(fmpq_poly(values))
    return out


def divided(number: Element, f: list[Element], monic: list[Element]) -> tuple[list[Element], list[Element]]:
    """Quotient and remainder by a monic polynomial. number: what coefficients are reduced by."""
    rest, n = list(f), len(monic) - 1
    for k in range(len(rest) - 1, n - 1, -1):
        for m, c in enumerate(monic[:-1]):
            rest[k - n + m] = (rest[k - n + m] - rest[k] * c) % number
    return rest[n:], _trimmed(rest[:n])


def _trimmed(f: list[Element]) -> list[Element]:
    """Without leading zeros."""
    while f and f[-1].degree() < 0:
        f.pop()
    return f


@dataclass(frozen=True)
class Algebraic:
    """The real root number `index`, in rising order, of an irreducible polynomial with rational coefficients.
    """

    polynomial: fmpq_poly
    index: int

    @property
    def rational(self) -> Fraction | None:
        """The number itself where it is rational."""
        return fraction(-self.polynomial[0] / self.polynomial[1]) if self.polynomial.degree() == 1 else None

    def ball(self, bits: int) -> arb:
        """A ball of so many bits about it, to be used in the same precision."""
        with working(bits):
            return real_roots_of(self.polynomial)[self.index][0]

    def __float__(self) -> float:
        exact = self.rational
        return float(exact) if exact is not None else float(self.ball(256).mid())

    @property
    def whole(self) -> tuple[int, ...]:
        """Whole coefficients of its polynomial, lowest power first."""
        return tuple(int(c) for c in self.polynomial.numer().coeffs())

    def reduced(self, element: fmpq_poly) -> fmpq_poly:
        """The element of the field with powers of alpha below its degree."""
        return element % self.polynomial

    def trimmed(self, coefficients: Sequence[fmpq_poly]) -> FieldPoly:
        """A polynomial over the field without leading zeros."""
        return _trimmed([self.reduced(c) for c in coefficients])

    def inverse(self, element: fmpq_poly) -> fmpq_poly:
        """1/element."""
        _, result, _ = element.xgcd(self.polynomial)
        return self.reduced(result)

    def monic(self, f: FieldPoly) -> FieldPoly:
        """The polynomial over its leading coefficient."""
        lead = self.inverse(f[-1])
        return [self.reduced(c * lead) for c in f]

    def divided(self, f: FieldPoly, monic: FieldPoly) -> FieldPoly:
        """The quotient by a monic polynomial."""
        return divided(self.polynomial, f, monic)[0]

    def gcd(self, f: FieldPoly, g: FieldPoly) -> FieldPoly:
        """The greatest common divisor, monic; one of them may be zero."""
        return field_gcd(self.polynomial, f, g) if f and g else self.monic(f or g)

    def powers(self, f: FieldPoly) -> Powers:
        """(square-free factor, how often it counts) of a polynomial that is not zero; constants are left out.
        """
        if len(f) < 2:
            return []
        rest = self.gcd(f, [c * n for n, c in enumerate(f)][1:])
        once, out, times = self.divided(f, rest), [], 1
        while len(once) > 1:
            more = self.gcd(once, rest)
            factor = self.divided(once, more)
            if len(factor) > 1:
                out.append((factor, times))
            once, rest, times = more, self.divided(rest, more), times + 1
        return out

    def real_roots(self, powers: Powers, bits: int) -> list[tuple[arb, int]]:
        """(ball, how often it counts) of the distinct real roots of a polynomial, given its `powers`, rising.
        Unclear where the bits do not isolate them."""
        at, result = self.ball(bits), []
        for factor, times in powers:
            result += [(root, times) for root in real_balls(arb_poly([arb_poly(c)(at) for c in factor]))]
        return sorted(result, key=lambda item: item[0].mid())


def real_balls(f: arb_poly) -> list[arb]:
    """Balls about the real roots of a polynomial without double ones. Unclear where its balls do not isolate
    them."""
    try:
        roots = acb_poly(f).roots()
    except ValueError:
        raise Unclear from None
    # conjugates are roots as well, so a ball that meets the real axis and no other root holds a real one
    slope = f.derivative()
    return [narrowed(f, slope, root.real) for root in roots if root.imag.contains(0)]


@dataclass(frozen=True)
class Cut:
    """A critical value, with a rational on either side of it and nearer to it than any other."""

    number: Algebraic
    low: Fraction
    high: Fraction


def cuts(polynomials: Iterable[fmpq_poly], low: Fraction, high: Fraction) -> list[Cut]:
    """The real roots in [low, high] of irreducible polynomials, rising."""
    unique = {str(monic): monic for f in polynomials if f.degree() > 0
              for monic in [f / f.leading_coefficient()]}
    return settled(lambda digits: _ordered(list(unique.values()), low, high))


def _ordered(polynomials: Sequence[fmpq_poly], low: Fraction, high: Fraction) -> list[Cut]:
    result: list[tuple[arb, Algebraic]] = []
    for f in polynomials:
        for index, (ball, _) in enumerate(real_roots_of(f)):
            number = Algebraic(f, index)
            if _inside(number, ball, low, high):
                result.append((ball, number))
    result.sort(key=lambda item: item[0].mid())
    for (first, _), (second, _) in zip(result, result[1:]):
        if not first < second:
            raise Unclear
    return [Cut(number, fraction(ball.lower().fmpq()), fraction(ball.upper().fmpq()))
            for ball, number in result]


def _inside(number: Algebraic, ball: arb, low: Fraction, high: Fraction) -> bool:
    exact = number.rational
    if exact is not None:
        return low <= exact <= high
    first, last = rational(low), rational(high)  # an irrational number is none of the ends
    if ball > first and ball < last:
        return True
    if ball < first or ball > last:
        return False
    raise Unclear


class Gap(NamedTuple):
    """An open interval without cuts: its ends, and a value inside."""

    low: float
    high: float
    sample: Fraction


def gaps(result: Sequence[Cut], low: Fraction, high: Fraction) -> list[Gap | None]:
    """Those before, between and after the cuts of a range; None where a cut stands at its end."""
    inner = [(cut.low, cut.high, float(cut.number)) for cut in result]
    ends = [(low, low, float(low)), *inner, (high, high, float(high))]
    sides = pairwise(ends)
    return [Gap(first, last, between(a, b)) if a < b else None for (_, a, first), (b, _, last) in sides]


def between(first: Fraction, second: Fraction) -> Fraction:
    """A short rational in the open interval, near its middle."""
    middle, room = (first + second) / 2, (second - first) / 4
    step = Fraction(1)
    while step > room:
        step /= 10
    while step * 10 <= room:
        step *= 10
    return Fraction(round(middle / step)) * step


def coefficients(f: fmpq_mpoly, variable: int, size: int = 1) -> list[fmpq_mpoly]:
    """Those of the powers of one variable, lowest first, at least so many."""
    rows: list[dict[tuple[int, ...], Any]] = [{} for _ in range(max(size, f.degrees()[variable] + 1))]
    for powers, c in f.to_dict().items():
        rows[powers[variable]][(*powers[:variable], 0, *powers[variable + 1:])] = c
    return [f.context().from_dict(row) for row in rows]


def univariate(f: fmpq_mpoly, variable: int = 0) -> fmpq_poly:
    """As a polynomial in one variable, which is all it has."""
    row: list[Any] = [0] * (max(f.degrees()[variable], 0) + 1)
    for powers, c in f.to_dict().items():
        row[powers[variable]] = c
    return fmpq_poly(row)
