"""Taylor series of a scene's exact equations in many digits, and what is looked for along them: a return, extremes.

The rates of every scene are polynomials in the state with rational coefficients. The series x = sum x_n t^n obeys
(n+1) x_(n+1) = sum of c_m m_n over the monomials m, and a product's series is the convolution of its factors'. The
numbers are midpoints of python-flint's balls.
"""
from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from operator import mul

from ..errors import InputError
from ..numbers.vectors import Number

RETURNED = 1e-12  # a passage through the starting plane within this share of the orbit's size is a return
PIECES = 6  # of a step, each searched for one root


class Exhausted(Exception):
    """The work allowed is used up."""


class Recursion:
    """The Taylor recursion of polynomial rates: which products to form, and the rates as sums of them."""

    def __init__(self, equations):
        from sympy import Poly, PolynomialError
        self.size, self.products, self._at = len(equations.state), [], {}
        self.rates = []
        for rate in equations.rhs:
            try:
                terms = Poly(equations.numeric(rate), *equations.state).terms()
            except PolynomialError:
                raise InputError("the reference needs rates that are polynomials in the state") from None
            self.rates.append([(self._place(powers), Fraction(int(c.p), int(c.q))) for powers, c in terms if c != 0])

    def _place(self, powers):
        """Row of the monomial's series (-1: the number 1), forming the products it needs."""
        factors = tuple(i for i, n in enumerate(powers) for _ in range(n))
        return self._row(factors) if factors else -1

    def _row(self, factors):
        if len(factors) == 1:
            return factors[0]
        if factors not in self._at:
            first, second = self._row(factors[:-1]), factors[-1]
            self._at[factors] = self.size + len(self.products)
            self.products.append((first, second))
        return self._at[factors]

    def in_balls(self, numbers):
        """The rates with their coefficients as balls of this kind."""
        return [[(row, numbers.ball(c).mid()) for row, c in rate] for rate in self.rates]

    def series(self, rates, x, order):
        """Taylor coefficients 0..order of the state, one list a component."""
        rows = [[v] for v in x] + [[] for _ in self.products]
        for n in range(order):
            for into, (first, second) in zip(rows[self.size:], self.products):
                into.append(sum(map(mul, rows[first][:n + 1], rows[second][n::-1])).mid())
            for into, rate in zip(rows[:self.size], rates):
                total = sum(c * rows[row][n] for row, c in rate if row >= 0)
                total = total + sum(c for row, c in rate if row < 0) if n == 0 else total
                into.append((total / (n + 1) + x[0] * 0).mid())
        return rows[:self.size]

    def cost(self, order):
        """Multiplications of one series."""
        return order * (order + 1) // 2 * len(self.products) + order * sum(len(rate) for rate in self.rates)


@dataclass(frozen=True)
class Step:
    """The series about time `start` (a ball), good up to `length` later; forward or backward by its sign."""

    start: Number
    length: Number
    rows: list

    def at(self, s, derivative=0):
        return [value(row, s, derivative) for row in self.rows]


def value(row, s, derivative=0):
    """The series, or its first derivative, at s, by Horner's rule."""
    total = s * 0
    for n in range(len(row) - 1, derivative - 1, -1):
        total = (total * s + (row[n] * n if derivative else row[n])).mid()
    return total


def steps(recursion, start, digits, budget, numbers, sense=1, swing=False):
    """Steps from the start at time 0, without end; raises Exhausted where the budget (a list of one count) is used up.

    numbers: the kind (`balls.Digits`), to be taken while it is the working one. swing: the way back to the start is looked for, so a step
    is no longer than what changes in it is told.
    """
    order, rates = int(1.15 * digits) + 4, recursion.in_balls(numbers)
    x, now = [numbers.ball(v) for v in start], numbers.ball(0)
    while True:
        budget[0] -= recursion.cost(order)
        if budget[0] < 0:
            raise Exhausted
        rows = recursion.series(rates, x, order)
        length = _length(rows, order, digits)
        length = sense * (min(length, _length_of_change(rows, order, digits)) if swing else length)
        step = Step(now, length, rows)
        yield step
        x, now = step.at(length), (now + length).mid()


def _length(rows, order, digits):
    """The last two coefficients bound the tail: it is 10^-digits of the state's size."""
    from flint import arb
    size, shortest = max(abs(row[0]) for row in rows), arb(10) ** 9
    size = size if size > 0 else max(abs(row[1]) for row in rows)
    for n in (order - 1, order):
        top = max(abs(row[n]) for row in rows)
        if top > 0:
            shortest = min(shortest, (size * arb(10) ** -digits / top).root(n))
    return shortest.mid()


def _length_of_change(rows, order, digits):
    """Twice the step whose tail is 10^-digits of the largest of its first terms: a swing may be as small as it likes beside the state."""
    from flint import arb
    top, longest = max(abs(row[order]) for row in rows), arb(0)
    for n in (1, 2, 3):
        most = max(abs(row[n]) for row in rows)
        if most > 0 and top > 0:
            longest = max(longest, (most * arb(10) ** -digits / top).root(order - n))
    return (2 * longest).mid() if longest > 0 else arb(10) ** 9


class Loop:
    """Watches a motion until it returns to its start: the time of return and the extremes on the way."""

    def __init__(self):
        self.closed, self.period, self.extremes = False, None, None

    def take(self, step):
        if self.extremes is None:
            self.home, self.normal = step.at(step.length * 0), [row[1] for row in step.rows]
            self.extremes = [[v, v] for v in self.home[:3]]
        end = step.length
        for s in self._passages(step):
            size = max(high - low for low, high in self.extremes)  # of what was passed before this step
            if max(abs(a - b) for a, b in zip(step.at(s), self.home)) < size * RETURNED:
                self.closed, self.period, end = True, (step.start + s).mid(), s
                break
        widen(self.extremes, step, end)

    def _passages(self, step):
        """Later passages, in the direction of the motion, of the plane across the first velocity."""
        row = [sum(map(mul, self.normal, column)) for column in zip(*step.rows)]
        row[0] = row[0] - sum(map(mul, self.normal, self.home))
        after = 1e-9 if step.start == 0 else 0.0
        return [s for s in _roots(row, step.length) if s > step.length * after and value(row, s, 1) > 0]


def widen(pairs, step, end):
    """Let the least and greatest values of the first components take in a step as far as `end` after its start."""
    for row, pair in zip(step.rows, pairs):
        slopes = [n * c for n, c in enumerate(row)][1:]
        for s in [*_roots(slopes, step.length), end]:
            if abs(s) <= abs(end):
                v = value(row, s)
                pair[0], pair[1] = min(pair[0], v), max(pair[1], v)


def _roots(row, length):
    """Simple roots of a series inside (0, length]: bracketed by pieces, closed in on by Newton's method."""
    ends = [length * k / PIECES for k in range(PIECES + 1)]
    values = [value(row, s) for s in ends]
    found = []
    for a, b, fa, fb in zip(ends, ends[1:], values, values[1:]):
        if (fa < 0) != (fb < 0) or fb == 0:
            found.append(_root(row, a.mid(), b.mid(), fa))
    return found


def _root(row, a, b, fa):
    """The root between a and b: Newton's method, held in the bracket, until it moves no more."""
    s = ((a + b) / 2).mid()
    for _ in range(400):
        f = value(row, s)
        if f == 0:
            break
        if (f < 0) == (fa < 0):
            a = s
        else:
            b = s
        slope = value(row, s, 1)
        new = (s - f / slope).mid() if slope != 0 else a
        if not (a < new < b):
            new = ((a + b) / 2).mid()
        if abs(new - s) <= abs(b) * 2.0**-1000 or new == s:
            break
        moved, s = abs(new - s), new
        if moved < abs(s) * _unit():
            break
    return s


def _unit():
    from flint import arb, ctx
    return arb(2) ** (4 - ctx.prec)
