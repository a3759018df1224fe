"""Elimination of what oscillates in the rate of a quantity (the fields are those of `centres`): a corrected
energy and a corrected amplitude, to any order, take away what oscillates about the centre.

Quantities are sums of c zeta^j zeta*^k p^(-a/4) q^(-b/4); p and q are linear in the spin x. Along the motion,
with `Algebra`'s names,

    zeta' = i om p^(-turn_a/4) q^(-turn_b/4) zeta + x' carried + drift,        x' = x_rate,
    d/dt  = i Om (zeta d - zeta* d*) + x' [d/dx + along carried] + along drift.

An oscillating term c zeta^j zeta*^k f(x) of a rate (j != k) is taken away by adding -c/(i Om (j - k)) zeta^j
zeta*^k f(x) to the quantity: its rate then holds -c zeta^j zeta*^k f(x) and the price, what the rest of d/dt
makes of the added term, smaller by at least one power of the spin. What does not oscillate (j = k) stays.
Level of a term: four times the power of 1/x with which it falls. What is added in one level makes terms of
higher levels alone, so levels are gone through once, from the lowest on. Rates are real: their terms come
with their conjugates, and half of them, j >= k, need be followed.

Rounding. Beside each coefficient goes its majorant, formed by the same operations on sizes, without
subtraction: a coefficient is a sum of products, its majorant the sum of the same products' sizes. Each
product is formed by fewer than 2^14 roundings (orders below 40: some ten to a level, and sums of fewer than
300 terms at each), so a coefficient in doubles errs by less than 2^-38 of its majorant. Tables have |c| +
ROUNDING majorant, ROUNDING = 2^-32, which covers that 64 times over.

The few terms that an elimination begins with are in dicts (`Terms`), the many that it makes in flat tables
(`elimination_kernel`). How large these have to be follows from how far one step moves a term at most."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np

from ...numbers.numba_door import Kernel
from . import elimination_kernel as kernel

# {(j, k, a, b): (c, majorant of c)}
Terms = dict[tuple[int, int, int, int], tuple[complex, float]]
ELIMINATE = Kernel(kernel, "eliminate", 1.2, options={
    "allocating": False, "entries": {"eliminate", "tabulate"}} | kernel.LOOPS)


def terms_of(table: dict) -> Terms:
    """Terms from {(j, k, a, b): c}."""
    return {key: (c, abs(c)) for key, c in table.items()}


def total(*parts: Terms) -> Terms:
    """The sum of sums of terms."""
    result: Terms = {}
    for part in parts:
        for key, (c, m) in part.items():
            before = result.get(key)
            result[key] = (c, m) if before is None else (before[0] + c, before[1] + m)
    return result


def product(item: Terms, other: Terms) -> Terms:
    """The product of two sums of terms."""
    result: Terms = {}
    for (j, k, a, b), (c, m) in item.items():
        for (p, q, r, s), (d, n) in other.items():
            key = j + p, k + q, a + r, b + s
            before = result.get(key)
            result[key] = (c * d, m * n) if before is None else (before[0] + c * d, before[1] + m * n)
    return result


def times(terms: Terms, factor: complex, step: tuple[int, int, int, int] = (0, 0, 0, 0)) -> Terms:
    """Each coefficient times a number, and times one monomial."""
    p, q, r, s = step
    return {(j + p, k + q, a + r, b + s): (c * factor, m * abs(factor))
            for (j, k, a, b), (c, m) in terms.items()}


def conjugate(terms: Terms) -> Terms:
    """The conjugate of a sum: zeta^j zeta*^k becomes zeta^k zeta*^j."""
    return {(k, j, a, b): (c.conjugate(), m) for (j, k, a, b), (c, m) in terms.items()}


def half(terms: Terms) -> Terms:
    """Of a real sum, whose terms come with their conjugates, those with j >= k."""
    return {key: value for key, value in terms.items() if key[0] >= key[1]}


@dataclass(frozen=True)
class Algebra:
    """What the time derivative of a form is made of.

    lift: 1/om; turn: (a, b) of the turning rate Om = om p^(-a/4) q^(-b/4); fall: the factors of d/dx,
    -slope/4 of p and of q; x_rate: terms of x'; carried: terms of zeta' over x'; drift: its other terms,
    where none are carried; unit, sheared: of `Grid`.
    """

    lift: float
    turn: tuple[int, int]
    fall: tuple[float, float]
    x_rate: Terms
    carried: Terms
    drift: Terms
    unit: int
    sheared: bool

    def slope(self, terms: Terms) -> Terms:
        """d/dx of terms at constant zeta."""
        return total(*(times({key: (c * key[which], m * abs(key[which])) for key, (c, m) in terms.items()
                              if key[which]}, fall, (0, 0, *step))
                       for step, fall, which in (((4, 0), self.fall[0], 2), ((0, 4), self.fall[1], 3))
                       if fall))

    @cached_property
    def moves(self) -> tuple[Moves, Moves]:
        """What a term that is added is multiplied with, by one of its exponents and after that, to give the
        rest of its rate. The first holds by how much the exponents of what is added exceed those of the
        rate."""
        along = terms_of({(0, 0, 0, 0): 1.0}) if self.carried else self.x_rate
        zeta, lifted = self.carried or self.drift, (-self.turn[0], -self.turn[1])
        parts = [(0, times(zeta, 1.0, (-1, 0, *lifted))), (1, times(conjugate(zeta), 1.0, (0, -1, *lifted)))]
        parts += [(which, times(along, fall, (0, 0, lifted[0] + a, lifted[1] + b)))
                  for (a, b), fall, which in (((4, 0), self.fall[0], 2), ((0, 4), self.fall[1], 3)) if fall]
        return _moves(self, parts), _moves(self, [(4, self.x_rate)] if self.carried else [])

    @cached_property
    def reach(self) -> tuple[tuple[int, int, int, int], ...]:
        """By how much both together can raise the level; and at most the degree, at least and at most the
        column of a term beside it."""
        rows = {(degree + more, level + higher, column + farther)
                for degree, level, column in self.moves[0].steps.tolist()
                for more, higher, farther in self.moves[1].steps.tolist() or [(0, 0, 0)]}
        parts: dict[int, list[tuple[int, int]]] = {}
        for degree, level, column in rows:
            parts.setdefault(level, []).append((degree, column))
        return tuple((level, max(part)[0], min(column for _, column in part),
                      max(column for _, column in part)) for level, part in sorted(parts.items()))

    def level(self, a: int, b: int) -> int:
        """The level of exponents, in its unit."""
        return (a + b) // self.unit


class Moves(NamedTuple):
    """Monomials that terms are multiplied with: the kind of the exponent that is a factor (n,); steps (n, 3)
    in degree, level and column; step in k (n,); factors (3, n): real, imaginary part and majorant. lowest:
    step in level, of so many levels; conjugate, farthest: greatest step in k, and in column, either way."""

    kinds: np.ndarray
    steps: np.ndarray
    conjugates: np.ndarray
    factors: np.ndarray
    lowest: int
    levels: int
    conjugate: int
    farthest: int

    def placed(self, grid: kernel.Grid, lifted: int) -> tuple[np.ndarray, np.ndarray]:
        """`moves` and `factors` of the kernel; lifted: less in levels."""
        moves = np.empty((3, len(self.kinds)), np.int64)
        moves[0], moves[1] = self.kinds, self.steps[:, 1] - lifted
        moves[2] = (self.steps[:, 0] * grid.conjugates + self.conjugates) * grid.columns + self.steps[:, 2]
        return moves, self.factors


def _moves(algebra: Algebra, parts: Sequence[tuple[int, Terms]]) -> Moves:
    """Of terms by the kind of their factor."""
    rows = [(kind, j + k, (a + b) // algebra.unit, (a + j + k) // 2 if algebra.sheared else 0, k)
            for kind, terms in parts for j, k, a, b in terms]
    factors = [(c.real, c.imag, m) for _, terms in parts for c, m in terms.values()]
    kinds, degrees, levels, columns, conjugates = zip(*rows) if rows else ((),) * 5
    return Moves(np.array(kinds, np.int64), np.array([degrees, levels, columns], np.int64).T,
                 np.array(conjugates, np.int64), np.array(factors).reshape(-1, 3).T.copy(),
                 min(levels, default=0), 1 + max(levels, default=0) - min(levels, default=0),
                 max(conjugates, default=0), max(map(abs, columns), default=0))


class Tables(NamedTuple):
    """What is added to a quantity and what is left of its rate, for the kernel of the certificate. Exponents
    (2, columns) over `parts`; sums of sizes, of majorants (degrees, columns); twice the real and imaginary
    parts of the terms with j > k (2, columns, powers), which have j and k (2, powers)."""

    exponents: np.ndarray
    sums: np.ndarray
    largest: np.ndarray
    values: np.ndarray
    degrees: np.ndarray
    left_exponents: np.ndarray
    left_sums: np.ndarray
    reach: int  # the greatest sum of sizes of two exponents


class Elimination:
    """What oscillates taken out of a rate.

    rate: real, its terms come with their conjugates, unless it is half; added: such terms that were added
    before, of levels that the rate does not have; drive: a term that is left out of what is left; over: (a,
    b, size) of what is left is divided by size p^(-a/4) q^(-b/4)."""

    def __init__(self, algebra: Algebra, rate: Terms, added: Terms | None = None,
                 drive: tuple[int, int, int, int] | None = None, over: tuple[int, int, float] = (0, 0, 1.0)):
        self.algebra, self.over = algebra, over
        # j = k stands for itself and its conjugate
        self.rate = [(key, c * 0.5, m * 0.5) if key[0] == key[1] else (key, c, m)
                     for key, (c, m) in half(rate).items()]
        a, b = algebra.turn  # where the rate would be of which it is taken
        self.added = [((j, k, r + a, s + b), c, m) for (j, k, r, s), (c, m) in (added or {}).items() if j > k]
        self.drive = drive and algebra.level(*drive[2:])
        self.start = tuple(sorted({(algebra.level(a, b), j + k, (a + j + k) // 2 if algebra.sheared else 0)
                                   for (j, k, a, b), *_ in self.rate + self.added})) or ((0, 0, 0),)

    def grid(self, order: int) -> tuple[kernel.Grid, np.ndarray]:
        """The grid for everything up to x^-order; the greatest degree of each level."""
        algebra, (one, two) = self.algebra, self.algebra.moves
        lowest, last, highest, tops, low, high = _room(self.start, algebra.reach, 4 * order // algebra.unit)
        degrees = max(tops)
        return kernel.Grid(
            len(tops), 1 + max(highest, algebra.reach[-1][0]), one.levels if algebra.carried else 0,
            one.lowest, 1 + degrees, degrees // 2 + 1 + one.conjugate + two.conjugate,
            # a first product goes beyond by no more than one of its steps, and raises no degree
            1 + high + one.farthest - low + one.farthest, lowest, low - one.farthest, algebra.unit,
            int(algebra.sheared), *algebra.turn, last,
            -1 if self.drive is None else self.drive - lowest), np.array(tops, np.int64)

    def to(self, order: int, parts: int, fast: bool = False) -> Tables:
        """Tables after everything oscillating up to x^-order, with exponents in that part of a whole. fast:
        by compiled code."""
        functions, algebra, (grid, tops) = ELIMINATE.functions(fast), self.algebra, self.grid(order)
        one, two = algebra.moves
        size = grid.degrees * grid.conjugates * grid.columns
        table = np.zeros((3, (grid.present + grid.between) * size))
        for (j, k, a, b), c, m in self.rate:
            column = (a + j + k) // 2 - grid.first if grid.sheared else 0
            slot = ((algebra.level(a, b) - grid.lowest) * size
                    + ((j + k) * grid.conjugates + k) * grid.columns + column)
            table[0, slot], table[1, slot], table[2, slot] = c.real, c.imag, m
        # of each level half the terms are added at most, and all of those at the end are left
        room = size * (grid.levels // 2 + max(grid.present, 2))
        exponents, values = np.empty((2, 6, room), np.int64), np.empty((2, 3, room))
        counts = np.zeros(7, np.int64)
        for n, ((j, k, a, b), c, m) in enumerate(self.added):
            mark = algebra.level(a, b) - grid.lowest
            if grid.sheared:
                mark += (a + grid.degrees - 2 * grid.first) * grid.levels
            exponents[0, :, n] = (j + k, k, mark, j * grid.conjugates + k, a - grid.turn_a, b - grid.turn_b)
            values[0, :, n] = c.real, c.imag, m
            counts[0], counts[2] = n + 1, max(counts[2], j + k + 1)
        pairs_of_exponents = (2 * grid.columns + grid.degrees if grid.sheared else 1) * grid.levels
        marks = np.zeros((2, pairs_of_exponents), np.int64)
        pairs = np.zeros(grid.degrees * grid.conjugates, np.int64)
        functions["eliminate"](
            table, algebra.lift, np.array(grid, np.int64), tops,
            *one.placed(grid, grid.lifted if grid.between else 0), *two.placed(grid, 0), exponents, values,
            marks, pairs, counts, np.empty(size, np.int64), np.ones((5, size)), np.empty((3, size)))
        # of no terms one that is 0
        _, _, degrees, left_degrees, columns, left_columns, terms = np.maximum(counts, 1).tolist()
        tables = (np.zeros((2, columns), np.int64), np.zeros((degrees, columns)),
                  np.zeros((degrees, columns)), np.zeros((2, columns, terms)), np.zeros((2, terms), np.int64),
                  np.zeros((2, left_columns), np.int64), np.zeros((left_degrees, left_columns)))
        a, b, divisor = self.over
        return Tables(*tables, functions["tabulate"](
            exponents, values, marks, pairs, counts, -a, -b, 2 if parts == 1 else 0, divisor, *tables))


@lru_cache(maxsize=256)  # the same for nearly all scenes
def _room(start: tuple[tuple[int, int, int], ...], reach: tuple[tuple[int, int, int, int], ...], end: int):
    """How far terms come that begin with these levels, degrees and columns, where those up to the level `end`
    are moved on: (lowest level; from there on the last that is moved, the highest at the start; the greatest
    degree of each level, -1 for none; least and greatest column)."""
    lowest, highest = min(start)[0], max(start)[0] - min(start)[0]
    last = end - lowest
    levels = 1 + max(highest, last + reach[-1][0])
    degrees, low, high = [-1] * levels, [0] * levels, [0] * levels
    for level, degree, column in start:
        n = level - lowest
        degrees[n], low[n] = max(degrees[n], degree), min(low[n], column)
        high[n] = max(high[n], column)
    for number in range(last + 1):
        degree, least, most = degrees[number], low[number], high[number]
        for level, more, lower, upper in reach if degree > 0 else ():
            n = number + level
            degrees[n], low[n] = max(degrees[n], degree + more), min(low[n], least + lower)
            high[n] = max(high[n], most + upper)
    return lowest, last, highest, tuple(degrees), min(low), max(high)
