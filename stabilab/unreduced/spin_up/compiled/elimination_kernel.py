"""Elimination about the moving centre in straight loops that numba compiles.

The same formulas as `elimination.corrected`, where they are derived. A real quantity is followed by its half j >= k: its terms
c zeta^j zeta*^k p^(-a/4) q^(-b/4) stand in rows, one pair of exponents (a, b) that occurs to a row, at the place `cell` of (j, k), a coefficient's majorant
in a table beside it. place (SPAN, SPAN): the row of a pair, -1 for one that has not occurred. pairs (3, rows): a, b, and whether something oscillates there.
"""
from __future__ import annotations

SPAN = 256  # exponents a, b from -128 to 127
ROWS = 1024


def cell(j, k):
    """The place of (j, k), k <= j, among those ordered by degree."""
    degree = j + k
    return ((degree + 1) // 2) * (degree // 2 + 1) + k


def row_of(a, b, place, pairs, count):
    """The row of a pair of exponents, a new one where it has not occurred; -1 where there is no room. count (1,): rows that are taken."""
    m, n = a + SPAN // 2, b + SPAN // 2
    if not (0 <= m < SPAN and 0 <= n < SPAN):
        return -1
    if place[m, n] < 0:
        row = count[0]
        if row == pairs.shape[1]:
            return -1
        place[m, n], pairs[0, row], pairs[1, row] = row, a, b
        count[0] = row + 1
    return place[m, n]


def spread(jk, values, sizes, many, a, b, steps, rates, majors, c, m, place, pairs, count):
    """Add so many terms with the exponents a, b times each term of a sum, and the conjugates of all, to a quantity; False where there is no room. jk
    (2, many): j, k of the terms, values and sizes (many,) of them; steps (4, n): j, k, a, b of the sum, rates and majors (n,) of it."""
    for n in range(rates.size):
        row = row_of(a + steps[2, n], b + steps[3, n], place, pairs, count)
        if row < 0:
            return False
        dj, dk, rate, major = steps[0, n], steps[1, n], rates[n], majors[n]
        for i in range(many):
            j, k, value, size = jk[0, i] + dj, jk[1, i] + dk, values[i] * rate, sizes[i] * major
            if j < k:
                j, k, value = k, j, value.conjugate()
            elif j == k:
                value, size = value + value.conjugate(), size + size
            at = cell(j, k)
            if at >= c.shape[1]:
                return False
            c[row, at] += value
            m[row, at] += size
            if j > k:
                pairs[2, row] = 1
    return True


def times(jk, values, sizes, many, factor, major, out_jk, out_values, out_sizes):
    """So many terms times a number."""
    for i in range(many):
        out_jk[0, i], out_jk[1, i], out_values[i], out_sizes[i] = jk[0, i], jk[1, i], values[i] * factor, sizes[i] * major


def along(jk, values, sizes, many, which, dj, dk, factor, major, out_jk, out_values, out_sizes):
    """The derivative of so many terms by zeta (which 0) or its conjugate (1), times one term; returns how many are left."""
    n = 0
    for i in range(many):
        power = jk[which, i]
        if power > 0:
            out_jk[0, n], out_jk[1, n] = jk[0, i] + dj, jk[1, i] + dk
            out_jk[which, n] -= 1
            out_values[n], out_sizes[n] = power * values[i] * factor, power * sizes[i] * major
            n += 1
    return n


def price(jk, values, sizes, many, a, b, fall, x_steps, x_rates, x_majors, steps, rates, majors, c, m, place, pairs, count, new_jk, new_values, new_sizes):
    """Add to a rate what x' = x_rate and zeta' = x' carried make of so many terms of a quantity, all with the exponents a, b; steps (4, n): of carried."""
    for which in range(2):
        factor = (a if which == 0 else b) * fall[which]
        if factor != 0:
            times(jk, values, sizes, many, factor, abs(factor), new_jk, new_values, new_sizes)
            if not spread(new_jk, new_values, new_sizes, many, a + 4 * (1 - which), b + 4 * which, x_steps, x_rates, x_majors, c, m, place, pairs, count):
                return False
    for n in range(rates.size):
        for which in range(2):
            rate = rates[n] if which == 0 else rates[n].conjugate()
            left = along(jk, values, sizes, many, which, steps[which, n], steps[1 - which, n], rate, majors[n], new_jk, new_values, new_sizes)
            if left and not spread(new_jk, new_values, new_sizes, left, a + steps[2, n], b + steps[3, n], x_steps, x_rates, x_majors, c, m,
                                   place, pairs, count):
                return False
    return True


def fill(c, m, powers, values, sizes, place, pairs, count):
    """Put the half j >= k of a sum of terms into a table; powers (4, n): j, k, a, b."""
    for n in range(values.size):
        row = row_of(powers[2, n], powers[3, n], place, pairs, count)
        at = cell(powers[0, n], powers[1, n])
        if row < 0 or at >= c.shape[1]:
            return False
        c[row, at], m[row, at] = values[n], sizes[n]
        if powers[0, n] > powers[1, n]:
            pairs[2, row] = 1
    return True


def taken(row, degrees, lift, c, m, jk, values, sizes):
    """What oscillates in a row of a rate, taken out of it; what is added to the quantity for it goes to a list. Returns how many terms there are."""
    n = 0
    for degree in range(1, degrees):
        for k in range((degree + 1) // 2):
            j, at = degree - k, cell(degree - k, k)
            if m[row, at] != 0:
                jk[0, n], jk[1, n], values[n], sizes[n] = j, k, c[row, at] * lift / (j - k), m[row, at] * abs(lift) / (j - k)
                c[row, at], m[row, at] = 0, 0
                n += 1
    return n


def eliminate(limit, lift, turn, fall, weights, degrees, x_steps, x_rates, x_majors, steps, rates, majors, c, m, added_c, added_m, place, pairs, count,
              jk, values, sizes, new_jk, new_values, new_sizes):
    """Take what oscillates up to a level out of the rate (c, m), and add to the quantity (added_c, added_m) what does so; False where there is no room.
    jk, values, sizes and the new ones: lists for work."""
    while True:
        level, found = limit + 1, False
        for row in range(count[0]):
            here = weights[0] * pairs[0, row] + weights[1] * pairs[1, row]
            if pairs[2, row] and here < level:
                level, found = here, True
        if not found:
            return True
        for row in range(count[0]):
            if not pairs[2, row] or weights[0] * pairs[0, row] + weights[1] * pairs[1, row] != level:
                continue
            pairs[2, row] = 0
            many = taken(row, degrees, lift, c, m, jk, values, sizes)
            a, b = pairs[0, row] - turn[0], pairs[1, row] - turn[1]
            to = row_of(a, b, place, pairs, count)
            if to < 0:
                return False
            for i in range(many):
                at = cell(jk[0, i], jk[1, i])
                added_c[to, at] += values[i]
                added_m[to, at] += sizes[i]
            if not price(jk, values, sizes, many, a, b, fall, x_steps, x_rates, x_majors, steps, rates, majors, c, m, place, pairs, count,
                         new_jk, new_values, new_sizes):
                return False


def whole(c, m, degrees, pairs, rows, powers, values, sizes):
    """A quantity's terms, those with j < k as well: their powers (4, n): j, k, a, b. Returns how many there are."""
    n = 0
    for row in range(rows):
        for degree in range(degrees):
            for k in range(degree // 2 + 1):
                j, at = degree - k, cell(degree - k, k)
                if m[row, at] == 0:
                    continue
                powers[0, n], powers[1, n], powers[2, n], powers[3, n] = j, k, pairs[0, row], pairs[1, row]
                values[n], sizes[n] = c[row, at], m[row, at]
                n += 1
                if j > k:
                    powers[0, n], powers[1, n], powers[2, n], powers[3, n] = k, j, pairs[0, row], pairs[1, row]
                    values[n], sizes[n] = c[row, at].conjugate(), m[row, at]
                    n += 1
    return n
