"""The arithmetic of an elimination (`elimination`): sums of very many terms, from a rate to the tables of a
certificate. What goes through all terms of a level is here twice, by NumPy and as loops that numba compiles
(`LOOPS`): loops in plain Python would take longer than all else. Both do the same operations on a number in
the same order, so that they give the same bytes.

The rate of which something is taken out stands in a flat table (3, levels x size): real and imaginary parts
of the coefficients, and their majorants; a term is there if its majorant is not 0. Within a level the index
of a term is linear in its exponents (`Grid`): a product with one monomial moves all terms of a level by one
and the same number, to one and the same level. Only so many levels are there as terms are moved to at once.
What leaves the table goes to a list: exponents (6, n), which are j + k, k, a number for the pair a and b and
one for j and k (in their order), a and b, and values (3, n) as in the table."""
from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np

ROUNDING = 2.0**-32
TINY = 2.0**-500  # more than the root of a square that vanishes, in natural units


class Grid(NamedTuple):
    """Which terms stand where. zeta^j zeta*^k p^(-a/4) q^(-b/4) has the index ((j + k) conjugates + k)
    columns + column in its level. unit (lowest + number of the level) is a where b is 0, and the column is 0;
    or (sheared) a + b, and the column is (a + j + k)/2 - first. levels: how many are gone through, of which
    `present` are in the table at once; behind them there are those `between` two products, the lowest of
    which is `lifted` above what was multiplied. What is added has turn_a, turn_b less in a and b than the
    rate it is taken from. last: of the levels out of which something is taken; dropped: one whose constant is
    left out."""

    levels: int
    present: int
    between: int
    lifted: int
    degrees: int
    conjugates: int
    columns: int
    lowest: int
    first: int
    unit: int
    sheared: int
    turn_a: int
    turn_b: int
    last: int
    dropped: int


# --- By NumPy
def take(rate: np.ndarray, base: int, number: int, top: int, lift: float, grid: Grid, exponents: np.ndarray,
         values: np.ndarray, counts: np.ndarray, slots: np.ndarray, powers: np.ndarray):
    """A level taken out of the table, which begins at base and has degrees up to the top. Half of its real
    sum is there: a term with j < k is added to its conjugate first, and one with j = k to its own. Up to the
    last level i lift/(j - k) times what oscillates is added to the quantity; the index and the exponents of
    each of these terms come to slots and to the first rows of powers. All else is left of the rate. exponents
    (2, 6, .), values (2, 3, .), counts: of what is added and what is left (how many terms of each, how many
    degrees of each); returns the first of what is added."""
    (equal, below, above), known = positions(grid)
    size, start, height = known.shape[1], int(counts[0]), grid.unit * (grid.lowest + number)
    level = rate[:, base:base + size]
    level[0, above] += level[0, below]
    level[1, above] -= level[1, below]
    level[2, above] += level[2, below]
    level[0, equal] *= 2.0
    level[1, equal] = 0.0
    level[2, equal] *= 2.0
    level[2, below] = 0.0
    here = np.flatnonzero(level[2])
    terms, numbers = level[:, here], known[:, here]
    level[:] = 0.0
    apart = numbers[6]
    if grid.sheared:
        numbers[2] += number
        numbers[5] = height - numbers[4]
    else:
        numbers[2], numbers[4] = number, height
    left = np.arange(here.size)
    if number <= grid.last:
        chosen, left = np.flatnonzero(apart), np.flatnonzero(apart == 0)
        n, part, (x, y, z) = start + chosen.size, numbers[:, chosen], terms[:, chosen]
        factor = lift / part[6]
        part[4] -= grid.turn_a
        part[5] -= grid.turn_b
        exponents[0, :, start:n], slots[:chosen.size] = part[:6], here[chosen]
        added = values[0, :, start:n]
        added[0], added[1], added[2] = -y * factor, x * factor, z * np.abs(factor)
        powers[:4, :chosen.size] = part[[7, 1, 4, 5]]
        counts[0], counts[2] = n, max(counts[2], 1 + part[0].max(initial=-1))
    if number == grid.dropped:
        left = left[numbers[0, left] > 0]
    if left.size:
        first, n = counts[1], counts[1] + left.size
        exponents[1, :, first:n], values[1, :, first:n] = numbers[:6, left], terms[:, left]
        counts[1], counts[3] = n, max(counts[3], 1 + numbers[0, left].max())
    return start


@lru_cache(maxsize=16)  # of all tests of a scene
def positions(grid: Grid) -> tuple[tuple[np.ndarray, ...], np.ndarray]:
    """Of the terms of a level: (which have j = k; which have j < k, and their conjugates; (8, n) what lists
    have of exponents, as far as it is the same in all levels, j - k, j)."""
    here = np.arange(grid.degrees * grid.conjugates * grid.columns)
    row, zero = here // grid.columns, np.zeros_like(here)
    degree, k = row // grid.conjugates, row % grid.conjugates
    apart = degree - 2 * k
    below = np.flatnonzero((apart < 0) & (k <= degree))
    a = 2 * (here % grid.columns + grid.first) - degree if grid.sheared else zero
    mark = (a + grid.degrees - 2 * grid.first) * grid.levels if grid.sheared else zero
    return ((np.flatnonzero(apart == 0), below, below + apart[below] * grid.columns),
            np.stack([degree, k, mark, (degree - k) * grid.conjugates + k, a, zero, apart, degree - k]))


def spread(table: np.ndarray, base: int, number: int, levels: int, size: int, n: int, slots: np.ndarray,
           values: np.ndarray, first: int, powers: np.ndarray, moves: np.ndarray, factors: np.ndarray):
    """n terms of a level, from the first of values on, times each of some monomials, added to the levels of a
    table that begin at base. moves (3, m): which of the term's exponents it is multiplied with (the last row
    of powers: 1), by how much its level and its index grow; factors (3, m)."""
    power = powers[moves[0], :n]
    factor, term = np.nonzero(power)  # those of one factor after those of another
    power = power[factor, term]
    level = number + moves[1]
    place = slots[term] + (base + np.where(level < levels, level, level - levels) * size + moves[2])[factor]
    real, imaginary = power * factors[0, factor], power * factors[1, factor]
    x, y, z = values[:, first:first + n][:, term]
    np.add.at(table[0], place, x * real - y * imaginary)
    np.add.at(table[1], place, x * imaginary + y * real)
    np.add.at(table[2], place, z * (np.abs(power) * factors[2, factor]))


def collect(table: np.ndarray, start: int, size: int, slots: np.ndarray, values: np.ndarray):
    """A level taken out of a table: to slots and values; returns how many terms it has."""
    level = table[:, start:start + size]
    here = np.flatnonzero(level[2])
    slots[:here.size], values[:, :here.size] = here, level[:, here]
    level[:, here] = 0.0
    return here.size


def number_all(chosen: np.ndarray, marks: np.ndarray):
    """How many different numbers there are among the chosen ones; marks, 0 at first, has how many of them are
    no greater, at each."""
    marks[chosen] = 1
    here = np.flatnonzero(marks)
    marks[here] = np.arange(1, here.size + 1)
    return here.size


def fill(exponents: np.ndarray, values: np.ndarray, n: int, marks: np.ndarray, up_a: int, up_b: int,
         halved: int, divisor: float, columns: np.ndarray, sums: np.ndarray):
    """Bounds of the sizes of n terms and of their conjugates over a divisor, summed by degree and by
    exponents (degrees, columns); to columns (2, columns) the exponents plus up_a and up_b, halved so many
    times. Returns the greatest sum of sizes of both."""
    degree, k, mark, _, a, b = exponents[:, :n]
    x, y, z = values[:, :n]
    column = marks[mark] - 1
    columns[0, column], columns[1, column] = (a + up_a) >> halved, (b + up_b) >> halved
    bound = (np.sqrt(x * x + y * y) + TINY + ROUNDING * z) / divisor
    np.add.at(sums, (degree, column), np.where(degree == 2 * k, bound, 2.0 * bound))
    return int(np.abs(columns).sum(axis=0).max())


def spell(exponents: np.ndarray, values: np.ndarray, n: int, marks: np.ndarray, pairs: np.ndarray,
          largest: np.ndarray, terms: np.ndarray, degrees: np.ndarray):
    """Of n terms, all with j > k: sums of majorants as those of `fill`; terms (2, columns, powers) twice
    their real and imaginary parts, degrees (2, powers) j and k."""
    degree, k, mark, pair = exponents[:4, :n]
    column, power = marks[mark] - 1, pairs[pair] - 1
    degrees[0, power], degrees[1, power] = degree - k, k
    terms[0, column, power], terms[1, column, power] = 2.0 * values[0, :n], 2.0 * values[1, :n]
    np.add.at(largest, (degree, column), 2.0 * values[2, :n])


# --- The same as loops
def take_in_turn(rate: np.ndarray, base: int, number: int, top: int, lift: float, grid: Grid,
                 exponents: np.ndarray, values: np.ndarray, counts: np.ndarray, slots: np.ndarray,
                 powers: np.ndarray):
    """As `take`."""
    start, height = counts[0], grid.unit * (grid.lowest + number)
    for degree in range(top + 1):
        for k in range(min((degree >> 1) + 1, grid.conjugates)):
            row, apart = (degree * grid.conjugates + k) * grid.columns, degree - 2 * k
            mirrored = apart * grid.columns if degree - k < grid.conjugates else 0
            for column in range(grid.columns):
                slot = base + row + column
                x, y, z = rate[0, slot], rate[1, slot], rate[2, slot]
                rate[0, slot] = rate[1, slot] = rate[2, slot] = 0.0
                if apart == 0:
                    x, y, z = 2.0 * x, 0.0, 2.0 * z
                elif mirrored:
                    other = slot + mirrored
                    x, y, z = x + rate[0, other], y - rate[1, other], z + rate[2, other]
                    rate[0, other] = rate[1, other] = rate[2, other] = 0.0
                if z == 0:
                    continue
                a, mark, which = height, number, 1
                if grid.sheared:
                    a = 2 * (column + grid.first) - degree
                    mark += (a + grid.degrees - 2 * grid.first) * grid.levels
                b = height - a
                if number <= grid.last and apart:
                    factor, which, m = lift / apart, 0, counts[0] - start
                    x, y, z = -y * factor, x * factor, z * abs(factor)
                    a, b, slots[m] = a - grid.turn_a, b - grid.turn_b, row + column
                    powers[0, m], powers[1, m], powers[2, m], powers[3, m] = degree - k, k, a, b
                elif degree == 0 and number == grid.dropped:
                    continue
                n = counts[which]
                for i, item in enumerate((degree, k, mark, (degree - k) * grid.conjugates + k, a, b)):
                    exponents[which, i, n] = item
                for i, part in enumerate((x, y, z)):
                    values[which, i, n] = part
                counts[which], counts[2 + which] = n + 1, max(counts[2 + which], degree + 1)
    return start


def spread_in_turn(table: np.ndarray, base: int, number: int, levels: int, size: int, n: int,
                   slots: np.ndarray, values: np.ndarray, first: int, powers: np.ndarray, moves: np.ndarray,
                   factors: np.ndarray):
    """As `spread`."""
    for factor in range(moves.shape[1]):
        kind, level = moves[0, factor], number + moves[1, factor]
        if level >= levels:
            level -= levels
        shift = base + level * size + moves[2, factor]
        x, y, z = factors[0, factor], factors[1, factor], factors[2, factor]
        for term in range(n):
            power = powers[kind, term]
            if power != 0:
                slot, real, imaginary = shift + slots[term], power * x, power * y
                u, v = values[0, first + term], values[1, first + term]
                table[0, slot] += u * real - v * imaginary
                table[1, slot] += u * imaginary + v * real
                table[2, slot] += values[2, first + term] * (abs(power) * z)


def collect_in_turn(table: np.ndarray, start: int, size: int, slots: np.ndarray, values: np.ndarray):
    """As `collect`."""
    n = 0
    for slot in range(start, start + size):
        if table[2, slot] != 0:
            slots[n] = slot - start
            for i in range(3):
                values[i, n], table[i, slot] = table[i, slot], 0.0
            n += 1
    return n


def number_in_turn(chosen: np.ndarray, marks: np.ndarray):
    """As `number_all`."""
    n = 0
    for item in chosen:
        marks[item] = 1
    for item in range(marks.size):
        n += marks[item]
        marks[item] = n
    return n


def fill_in_turn(exponents: np.ndarray, values: np.ndarray, n: int, marks: np.ndarray, up_a: int, up_b: int,
                 halved: int, divisor: float, columns: np.ndarray, sums: np.ndarray):
    """As `fill`."""
    reach = 0
    for term in range(n):
        degree, column = exponents[0, term], marks[exponents[2, term]] - 1
        a, b = (exponents[4, term] + up_a) >> halved, (exponents[5, term] + up_b) >> halved
        columns[0, column], columns[1, column], reach = a, b, max(reach, abs(a) + abs(b))
        x, y = values[0, term], values[1, term]
        bound = (math.sqrt(x * x + y * y) + TINY + ROUNDING * values[2, term]) / divisor
        sums[degree, column] += bound if degree == 2 * exponents[1, term] else 2.0 * bound
    return reach


def spell_in_turn(exponents: np.ndarray, values: np.ndarray, n: int, marks: np.ndarray, pairs: np.ndarray,
                  largest: np.ndarray, terms: np.ndarray, degrees: np.ndarray):
    """As `spell`."""
    for term in range(n):
        degree, k, column = exponents[0, term], exponents[1, term], marks[exponents[2, term]] - 1
        power = pairs[exponents[3, term]] - 1
        degrees[0, power], degrees[1, power] = degree - k, k
        terms[0, column, power], terms[1, column, power] = 2.0 * values[0, term], 2.0 * values[1, term]
        largest[degree, column] += 2.0 * values[2, term]


LOOPS = {"take": take_in_turn, "spread": spread_in_turn, "collect": collect_in_turn,
         "number_all": number_in_turn, "fill": fill_in_turn, "spell": spell_in_turn}


# --- From a rate to what is added and what is left
def eliminate(table: np.ndarray, lift: float, fields: np.ndarray, tops: np.ndarray, moves: np.ndarray,
              factors: np.ndarray,
              carried: np.ndarray, carried_factors: np.ndarray, exponents: np.ndarray, values: np.ndarray,
              marks: np.ndarray, pairs: np.ndarray, counts: np.ndarray, slots: np.ndarray, powers: np.ndarray,
              work: np.ndarray):
    """Whatever oscillates in the levels of a rate up to the last taken out: lists of what is added to the
    quantity and of what is left of the rate. What is added times its exponents and some monomials (moves,
    factors of `spread`) comes to the rate, or to the levels between and from there, times others (carried),
    to the rate. counts (7,): of the terms and of the degrees of both lists, which have those of what was
    added before; of their different pairs a and b (numbered in marks (2, .)), and of the pairs j and k of
    what is added (in pairs). fields (15,): of the grid, for a tuple takes longer to hand over than all
    arrays; tops: the greatest degree of each level. slots, powers, work: to work in."""
    grid = Grid(fields[0], fields[1], fields[2], fields[3], fields[4], fields[5], fields[6], fields[7],
                fields[8], fields[9], fields[10], fields[11], fields[12], fields[13], fields[14])
    size = grid.degrees * grid.conjugates * grid.columns
    behind = grid.present * size
    turn = -1  # of the level in the table, whose levels are used again
    for number in range(grid.levels):
        turn = turn + 1 if turn + 1 < grid.present else 0
        start = take(table, turn * size, number, tops[number], lift, grid, exponents, values, counts, slots,
                     powers)
        n, source, by, numbers = counts[0] - start, values[0], moves, factors
        base, levels, first = (behind, grid.between, 0) if grid.between else (0, grid.present, turn)
        for level in range(grid.between + 1):  # the first product, then from each of its levels
            if level:
                n = collect(table, behind + (level - 1) * size,
                            (tops[number] + 1) * grid.conjugates * grid.columns, slots, work)
                source, by, numbers, start = work, carried, carried_factors, 0
                base, levels, first = 0, grid.present, turn + grid.lifted + level - 1
            spread(table, base, first, levels, size, n, slots, source, start, powers, by, numbers)
    for which in range(2):
        counts[4 + which] = number_all(exponents[which, 2, :counts[which]], marks[which])
    counts[6] = number_all(exponents[0, 3, :counts[0]], pairs)


def tabulate(exponents: np.ndarray, values: np.ndarray, marks: np.ndarray, pairs: np.ndarray,
             counts: np.ndarray, up_a: int, up_b: int, halved: int, divisor: float, columns: np.ndarray,
             sums: np.ndarray, largest: np.ndarray, terms: np.ndarray, degrees: np.ndarray,
             left_columns: np.ndarray, left_sums: np.ndarray):
    """The tables of both lists (`elimination.Tables`), all 0 at first. What is left is divided by a number,
    and has up_a and up_b more in its exponents, all of which are halved so many times. Returns the greatest
    sum of sizes of two of these."""
    spell(exponents[0], values[0], counts[0], marks[0], pairs, largest, terms, degrees)
    reach, a, b, by, into, table = 0, 0, 0, 1.0, columns, sums
    for which in range(2):
        if which:
            a, b, by, into, table = up_a, up_b, divisor, left_columns, left_sums
        reach = max(reach, fill(exponents[which], values[which], counts[which], marks[which], a, b, halved,
                                by, into, table))
    return reach
