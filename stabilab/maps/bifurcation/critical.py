"""The values of one number at which the equilibria may change: every real root of the critical polynomials, in order, none twice."""
from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

from ...numbers.balls import Unclear, rational, real_roots_of, settled
from .field.algebraic import Algebraic

if TYPE_CHECKING:
    from flint import arb, fmpq_poly


@dataclass(frozen=True)
class Cut:
    """A critical value, with a rational on either side of it and nearer to it than any other."""

    number: Algebraic
    low: Fraction
    high: Fraction


def cuts(polynomials: Iterable[fmpq_poly], low: Fraction, high: Fraction) -> list[Cut]:
    """The real roots in [low, high] of irreducible polynomials, rising."""
    unique = {str(monic): monic for f in polynomials if f.degree() > 0 for monic in [f / f.leading_coefficient()]}
    return settled(lambda digits: _ordered(list(unique.values()), low, high))


def _ordered(polynomials, low, high) -> list[Cut]:
    found: list[tuple[arb, Algebraic]] = []
    for f in polynomials:
        for index, (ball, _) in enumerate(real_roots_of(f)):
            number = Algebraic(f, index)
            if _inside(number, ball, low, high):
                found.append((ball, number))
    found.sort(key=lambda one: one[0].mid())
    for (first, _), (second, _) in zip(found, found[1:]):
        if not first < second:
            raise Unclear
    return [Cut(number, _end(ball.lower()), _end(ball.upper())) for ball, number in found]


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


def _end(value: arb) -> Fraction:
    exact = value.fmpq()
    return Fraction(int(exact.p), int(exact.q))


def between(first: Fraction, second: Fraction) -> Fraction:
    """A short rational in the open interval, near its middle."""
    middle, room = (first + second) / 2, (second - first) / 4
    step = Fraction(1)
    while step > room:
        step /= 10
    while step * 10 <= room:
        step *= 10
    return Fraction(round(middle / step)) * step
