"""The first time at which a quantity of an enclosed motion reaches a limit.

The motion comes by in pieces, one after another, made by Taylor series in integers (`integer_flow`) or by
compiled steps (`unreduced.enclosure`).

A limit is found by roots, and nothing is sampled. On a piece the quantity less its limit is a polynomial
g(s), 0 <= s <= 1, known to within err. From a place where g + err < 0 a bound B of |g''| tells how far g +
err stays below 0: to the root of g + err + g' s + B s^2 / 2. These steps end at the first root of g + err
from below, quadratically where it is simple, and pass whatever only comes near. A place behind where g - err
> 0 is the upper end.
"""
from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

from ..numbers.vectors import Number

SHORT = 72  # a step below 2^-72 of the piece has arrived: a crossing lies between neighbouring doubles
WIDE = 20  # up to 2^-20 of the piece behind the lower end the upper one is looked for at once
SHORTER = 1.0 - 2.0**-30  # less than what rounding adds to a step's length
# Where a motion goes along its limit steps become very short. PLACES: looked at on a piece; then what is
# ahead counts as near the limit. BEHIND: looked at behind the lower end on all pieces; then only their ends
PLACES, BEHIND = 4_000, 20_000


@dataclass(frozen=True)
class Piece:
    """The motion over one step: component i is sum_n rows[i][n] s^n 2^-bits, 0 <= s <= 1, and at most
    radii[i] 2^-bits off.

    start, length: in the motion's own time, exact; sizes: sum_n |rows[i][n]|, which is not below |component
    i|. Components 0, 1, 2 are the rates in their own unit; 3, 4, 5 those of the direction, where one is
    followed.
    """

    start: Fraction
    length: Fraction
    bits: int
    rows: list[list[int]]
    radii: list[int]
    sizes: list[int]


@dataclass(frozen=True)
class Threshold:
    """A quantity and its limit: sum_r c_r (a_r . y)^2, or a . y of the one term where it is `linear`, reaches
    `limit` from below, or from above where it `falls`.

    y: the components of a `Piece`, in the motion's own unit; terms: ((c_r, a_r), ...), positive c_r, a_r as
    many rationals as there are components.
    """

    terms: tuple[tuple[Fraction, tuple[Fraction, ...]], ...]
    limit: Fraction
    falls: bool = False
    linear: bool = False

    def passed(self, y: Sequence[Number]) -> bool:
        """Whether exact components reach the limit."""
        values = [(c, sum(a * v for a, v in zip(vector, y))) for c, vector in self.terms]
        value = values[0][1] if self.linear else sum(c * v * v for c, v in values)
        return value <= self.limit if self.falls else value >= self.limit


@dataclass(frozen=True)
class Crossing:
    """low, high: of the first crossing, exact; high None: not found before `until`, and low is None or a
    place where the limit is touched. until: the last time that was looked at; done: whether the search has
    come to its end; steps: that it took."""

    low: Fraction | None
    high: Fraction | None
    until: Fraction
    done: bool
    steps: int = 0

    @classmethod
    def of(cls, searches: Sequence[Search], until: Fraction, done: bool, steps: int = 0) -> Crossing:
        """The first of several."""
        low, high = (min((t for t in ends if t is not None), default=None)
                     for ends in ([search.low for search in searches], [search.high for search in searches]))
        return cls(low, high, until, done, steps)


class Search:
    """The first crossing of one threshold, as the pieces of a motion come by. low, high: in the motion's own
    time; None as long as not found.

    exactly: whether the error of the pieces is taken into account; else they are taken at their word.
    """

    def __init__(self, threshold: Threshold, exactly: bool = True) -> None:
        self.threshold, self.exactly, self.left = threshold, exactly, BEHIND
        self.low: Fraction | None = None
        self.high: Fraction | None = None

    def take(self, piece: Piece) -> bool:
        """Look at the next piece; whether the crossing is known from both sides."""
        if _far_below(self.threshold, piece, self.exactly):
            return False
        g = _Excess(self.threshold, piece, self.exactly)
        if g.stays_below():
            return False
        s = 0
        if self.low is None:
            first = g.reaches(1)
            if first is None:
                return False
            s = first
            self.low = piece.start + piece.length * Fraction(s, 1 << piece.bits)
        before = g.looked
        beyond = g.surely_beyond(s, before + min(PLACES, self.left))
        self.left -= min(g.looked - before, self.left)
        if beyond is None:
            return False
        self.high = piece.start + piece.length * Fraction(beyond, 1 << piece.bits)
        return True


class _Excess:
    """g over one piece: in units of 2^(-2 bits) for squares, 2^-bits for what is linear. Of what falls to its
    limit g is the limit less the quantity."""

    def __init__(self, threshold: Threshold, piece: Piece, exactly: bool) -> None:
        self.bits, self.linear, self.one, self.looked = piece.bits, threshold.linear, 1 << piece.bits, 0
        self.sign = -1 if threshold.falls else 1
        built = [_combined(vector, piece) for _, vector in threshold.terms]
        self.rows, self.sizes = [row for row, _ in built], [sum(map(abs, row)) for row, _ in built]
        radii = [radius for _, radius in built]
        self.weights = [round(c * self.one) for c, _ in threshold.terms]
        self.limit = round(threshold.limit * self.one)
        slack = 2 * max(map(len, self.rows))  # of Horner's rule, twice
        off = [(radius if exactly else 0) + slack for radius in radii]
        self.size = self.sizes[0] if self.linear else self._sum([v * v for v in self.sizes])
        if self.linear:
            self.err = off[0] + 1
        else:  # squares, then weights and limit rounded
            self.err = (self._sum([2 * v * r + r * r for v, r in zip(self.sizes, off)])
                        + sum((v * v >> self.bits) + 1 for v in self.sizes) + self.one)

    def _sum(self, values: Iterable[int]) -> int:
        return sum(c * v for c, v in zip(self.weights, values)) + self.one - 1 >> self.bits

    @cached_property
    def bend(self) -> int:
        """A bound of |g''|."""
        first = [sum(n * abs(v) for n, v in enumerate(row)) for row in self.rows]
        second = [sum(n * (n - 1) * abs(v) for n, v in enumerate(row)) for row in self.rows]
        return (second[0] if self.linear
                else 2 * self._sum([f * f + v * w for f, v, w in zip(first, self.sizes, second)]))

    @cached_property
    def rough(self) -> int:
        """What rounding may take from the slope."""
        terms = max(map(len, self.rows))
        steep = [sum(n * abs(v) for n, v in enumerate(row)) for row in self.rows]
        return (terms * (terms + 1) if self.linear
                else 2 * self._sum([terms * (terms + 1) * v + terms * w for v, w in zip(self.sizes, steep)])
                + 2)

    def stays_below(self) -> bool:
        """Whether bounds of the components alone keep g below 0."""
        if self.linear:
            row = self.rows[0]
            return (self.sign * row[0] + (self.size - abs(row[0])) + self.err
                    < self.sign * self.limit)
        if self.sign > 0:
            return self.size + self.err < self.limit << self.bits
        smallest = [max(0, 2 * abs(row[0]) - size) for row, size in zip(self.rows, self.sizes)]
        return self._sum([v * v for v in smallest]) - 1 - self.err > self.limit << self.bits

    def value(self, s: int) -> tuple[int, int]:
        """(g, g') at s, an integer in units of 2^-bits; g' is not too small, and rounding of g is part of
        err."""
        rows = []
        self.looked += 1
        for row in self.rows:
            v = slope = 0
            for c in reversed(row):
                slope = (slope * s >> self.bits) + v
                v = (v * s >> self.bits) + c
            rows.append((v, slope))
        if self.linear:
            return self.sign * (rows[0][0] - self.limit), self.sign * rows[0][1] + self.rough
        value = self._sum([v * v for v, _ in rows]) - (self.limit << self.bits)
        return self.sign * value, self.sign * 2 * self._sum([v * slope for v, slope in rows]) + self.rough

    def reaches(self, sign: int, s: int = 0, allowed: int = PLACES) -> int | None:
        """The last place that the steps reach from s before g + sign err may be 0, or that so many of them
        reach; None where there is no such place in the piece."""
        while self.looked < allowed:
            value, slope = self.value(s)
            gap = -(value + sign * self.err)
            if gap <= 0:
                return s
            ahead = self._safe(gap, slope)
            s += max(ahead, 1)
            if s >= self.one:
                return None
            if ahead < self.one >> SHORT:
                return s - max(ahead, 1)
        return s

    def _safe(self, gap: int, slope: int) -> int:
        scale = max(gap, abs(slope), self.bend, 1)
        a, b, c = gap / scale, slope / scale, self.bend / scale
        root = math.sqrt(b * b + 2 * c * a)
        ahead = 2 * a / (root + b) if b > 0 else (root - b) / c if c else 2.0
        return int(min(ahead, 2.0) * SHORTER * self.one)

    def surely_beyond(self, start: int, allowed: int) -> int | None:
        """A place from s on where g - err > 0, as near as can be found by so many looked at, else the end;
        None where the piece has none."""
        s: int | None = start
        while s is not None and self.looked < allowed:
            for places in range(SHORT - 2, WIDE, -1):
                behind = min(s + (self.one >> places), self.one)
                if self.value(behind)[0] > self.err:
                    return behind
            s += self.one >> WIDE
            s = self.reaches(-1, s, allowed) if s < self.one else None
        return self.one if s is not None and self.value(self.one)[0] > self.err else None


def _far_below(threshold: Threshold, piece: Piece, exactly: bool) -> bool:
    """Whether the sizes of the components alone keep squares below half of their limit, in doubles: most
    pieces of a motion are far from it, and to combine their rows takes long."""
    if threshold.linear or threshold.falls:
        return False
    unit, rounded = 2.0**-piece.bits, 4 * max(map(len, piece.rows)) + 8  # no less than in `_Excess`
    try:
        largest = 0.0
        for c, vector in threshold.terms:
            size = sum(abs(float(a)) * size + math.ceil(abs(a)) * (radius if exactly else 0)
                       for a, size, radius in zip(vector, piece.sizes, piece.radii))
            largest += float(c) * ((size + rounded) * unit) ** 2
        return largest + len(threshold.terms) * 4 * unit < float(threshold.limit) / 2
    except OverflowError:
        return False


def _combined(vector: Sequence[Fraction], piece: Piece) -> tuple[list[int], int]:
    """(the row of a . y, how far it may be off), in units of 2^-bits."""
    used = [(Fraction(a), row, radius, size)
            for a, row, radius, size in zip(vector, piece.rows, piece.radii, piece.sizes) if a]
    if len(used) == 1 and abs(used[0][0]) == 1:
        a, row, radius, _ = used[0]
        return (row if a > 0 else [-v for v in row]), radius
    factors = [round(a * (1 << piece.bits)) for a, *_ in used]
    rows = [sum(f * v for f, v in zip(factors, column)) >> piece.bits
            for column in zip(*(row for _, row, _, _ in used))]
    radius = sum(math.ceil(abs(a)) * r + (size >> piece.bits) + 1 for a, _, r, size in used) + len(rows)
    return rows, radius
