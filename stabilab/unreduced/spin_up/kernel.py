"""The certificate in straight loops: the search for A and z of one state, about a fixed or a moving centre.

The theorem and its inequality are those of `certificate`, the forms those of `centres`. A sum is a
table[degree, column] with the exponents (2, columns) of p^(-a/parts) q^(-b/parts): quarters about a moving
centre, whole numbers about the fixed one, where p = X and q = 1. Powers of p, q and of their greatest ratios
come from four rows of a work table, made by multiplication. All in one file: numba's cache on disk watches no
other. Functions take arrays one by one: out of a tuple, compiled code would count who holds each.
"""
from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

# rounding of the terms' values, of their majorant: four times that of the coefficients alone
COEFFICIENT = 2.0**-36
SLACK = 2.0**-30
GROWTH = 1 + 1e-7       # of A between passes: strict inequalities need room
PASSES = 25             # of the search for A and z: it is monotone and settles in ten or never
BLUR = 2.0**-50         # relative, in the place of a state: a dozen operations, each within half of 2^-52
CONDITION = 2.0**8 * BLUR  # rounding of p and q over themselves; 2^-36 in the powers that occur
MIDDLE = 200  # place of the power 0 in a row


class Form(NamedTuple):
    """The numbers of a field: D1 x' = drive + what oscillates, p = a3 x + c3, q = a2 x + c2, Om = turn_size
    p^(-turn_a/parts) q^(-turn_b/parts); reach: the greatest power in a row."""

    D1: float
    M1: float
    a2: float
    a3: float
    c2: float
    c3: float
    parts: int
    turn_a: int
    turn_b: int
    turn_size: float
    reach: int


def fill(row: np.ndarray, base: float, parts: int, reach: int):
    """base^(n/parts) at MIDDLE + n for |n| <= reach."""
    up = base if parts == 1 else math.sqrt(math.sqrt(base))
    down, item, other = 1 / up, 1.0, 1.0
    for n in range(1, reach + 1):
        item *= up
        other *= down
        row[MIDDLE + n], row[MIDDLE - n] = item, other


def prepare(rows: np.ndarray, x: float, form: Form):
    """Rows of powers, ones at first: of p and q falling, of the greatest q/p and p/q from x on rising."""
    p, q, a2, a3 = form.a3 * x + form.c3, form.a2 * x + form.c2, form.a2, form.a3
    fill(rows[0], 1 / p, form.parts, form.reach)
    if a2 > 0:
        fill(rows[1], 1 / q, form.parts, form.reach)
        fill(rows[2], max(q / p, a2 / a3), form.parts, form.reach)
        fill(rows[3], max(p / q, a3 / a2), form.parts, form.reach)


def turning(rows: np.ndarray, form: Form):
    """Om over its constant."""
    return form.turn_size * rows[0, MIDDLE + form.turn_a] * rows[1, MIDDLE + form.turn_b]


def greatest(a: int, b: int, rows: np.ndarray, a2: float):
    """A decreasing bound of the factor from here on: of mixed signs, a power of the ratio splits off."""
    if a2 == 0:
        return rows[0, MIDDLE + a] if a >= 0 else math.inf
    if a >= 0 and b >= 0:
        return rows[0, MIDDLE + a] * rows[1, MIDDLE + b]
    if a + b < 0:
        return math.inf
    return (rows[2, MIDDLE - b] * rows[0, MIDDLE + a + b] if b < 0
            else rows[3, MIDDLE - a] * rows[1, MIDDLE + a + b])


def tail(a: int, b: int, rows: np.ndarray, a2: float, a3: float, parts: int):
    """The least of four bounds of the integral of the factor over all greater x: of factors that both fall,
    one stays as it is; or a power of the ratio splits off. Infinity where it does not fall faster than
    1/x."""
    best = math.inf
    if a > parts and b >= 0:
        best = rows[1, MIDDLE + b] * rows[0, MIDDLE + a - parts] / (a3 * (a / parts - 1))
    if a2 == 0:
        return best
    if b > parts and a >= 0:
        best = min(best, rows[0, MIDDLE + a] * rows[1, MIDDLE + b - parts] / (a2 * (b / parts - 1)))
    n = (a + b) / parts
    if n > 1:
        by_p = rows[3, MIDDLE + b] if b > 0 else rows[2, MIDDLE - b]
        by_q = rows[2, MIDDLE + a] if a > 0 else rows[3, MIDDLE - a]
        best = min(best, by_p * rows[0, MIDDLE + a + b - parts] / (a3 * (n - 1)),
                   by_q * rows[1, MIDDLE + a + b - parts] / (a2 * (n - 1)))
    return best


def columns(table: np.ndarray, A: float, row: np.ndarray):
    """Sum of table[d, n] A^d over d, into row[n]."""
    for n in range(table.shape[1]):
        row[n] = 0.0
    for d in range(table.shape[0] - 1, -1, -1):
        for n in range(table.shape[1]):
            row[n] = row[n] * A + table[d, n]


def summed(row: np.ndarray, exponents: np.ndarray, rows: np.ndarray, form: Form):
    """Sum of the columns in a row times the bounds of their factors."""
    result = 0.0
    for n in range(exponents.shape[1]):
        if row[n] != 0:
            result += row[n] * greatest(exponents[0, n], exponents[1, n], rows, form.a2)
    return result


def total(table: np.ndarray, exponents: np.ndarray, A: float, rows: np.ndarray, form: Form, row: np.ndarray):
    """Sum of table[d, n] A^d times the factor's bound."""
    columns(table, A, row)
    return summed(row, exponents, rows, form)


def integrated(table: np.ndarray, exponents: np.ndarray, A: float, rows: np.ndarray, form: Form,
               row: np.ndarray):
    """Sum of table[d, n] A^d times the bound of the factor's integral."""
    columns(table, A, row)
    result = 0.0
    for n in range(exponents.shape[1]):
        if row[n] != 0:
            result += row[n] * tail(exponents[0, n], exponents[1, n], rows, form.a2, form.a3, form.parts)
    return result


def steepness(a: float, b: float, x: float, form: Form):
    """How fast the factor changes with x, over itself."""
    p, q = form.a3 * x + form.c3, form.a2 * x + form.c2
    return (abs(a) * form.a3 / p + abs(b) * form.a2 / q) / form.parts


def value_of(exponents: np.ndarray, terms: np.ndarray, degrees: np.ndarray, zeta: complex, rows: np.ndarray,
             powers: np.ndarray, pair: np.ndarray):
    """The value of a quantity whose terms come with their conjugates: terms[0] and [1] (columns, powers) are
    real and imaginary parts of the coefficients of zeta^j zeta*^k, j >= k in degrees (2, powers), doubled for
    their conjugates. powers, pair (2, at least powers): to work in."""
    powers[0] = 1
    for j in range(1, powers.size):
        powers[j] = powers[j - 1] * zeta
    for m in range(terms.shape[2]):
        pair[0, m] = pair[1, m] = 0.0
    for n in range(exponents.shape[1]):
        factor = rows[0, MIDDLE + exponents[0, n]] * rows[1, MIDDLE + exponents[1, n]]
        for m in range(terms.shape[2]):
            pair[0, m] += terms[0, n, m] * factor
        for m in range(terms.shape[2]):
            pair[1, m] += terms[1, n, m] * factor
    result = 0.0
    for m in range(terms.shape[2]):
        power = powers[degrees[0, m]] * powers[degrees[1, m]].conjugate()
        result += pair[0, m] * power.real - pair[1, m] * power.imag
    return result


def blurred(exponents: np.ndarray, sums: np.ndarray, largest: np.ndarray, terms: np.ndarray,
            degrees: np.ndarray, zeta: complex, size: float, x: float, low: float, dx: float, form: Form,
            rows: np.ndarray, powers: np.ndarray, pair: np.ndarray, row: np.ndarray):
    """(value, blur) of a quantity at a place known within dx and within size - |zeta|. sums, largest
    (degrees, columns): of sizes, of majorants."""
    prepare(rows, x, form)
    value = value_of(exponents, terms, degrees, zeta, rows, powers, pair)
    prepare(rows, low, form)
    inner = total(sums, exponents, abs(zeta), rows, form, row)
    outer = total(sums, exponents, size, rows, form, row)
    for n in range(exponents.shape[1]):
        row[n] *= steepness(exponents[0, n], exponents[1, n], low, form)
    moved = summed(row, exponents, rows, form) * dx
    return value, ((outer - inner) + moved * (1 + SLACK) + SLACK * outer
                   + COEFFICIENT * total(largest, exponents, size, rows, form, row))


def drives(exponents: np.ndarray, drive: np.ndarray, rows: np.ndarray):
    """(least, greatest) of the drive from here on: its terms are constant or fall."""
    low = high = 0.0
    for n in range(drive.size):
        a, b = exponents[0, n], exponents[1, n]
        value = drive[n] * rows[0, MIDDLE + a] * rows[1, MIDDLE + b]
        constant = a == 0 and b == 0
        low += value if constant else min(value, 0.0)
        high += value if constant else max(value, 0.0)
    return low, high


def weight_within(exponents: np.ndarray, drive: np.ndarray, form: Form, x: float, low: float, dx: float,
                  rows: np.ndarray):
    """A bound of the weight, the drive over M1, within dx."""
    result = 0.0
    prepare(rows, x, form)
    for n in range(drive.size):
        a, b = exponents[0, n], exponents[1, n]
        result += drive[n] * rows[0, MIDDLE + a] * rows[1, MIDDLE + b]
    prepare(rows, low, form)
    for n in range(drive.size):
        a, b = exponents[0, n], exponents[1, n]
        result += (abs(drive[n]) * rows[0, MIDDLE + a] * rows[1, MIDDLE + b]
                   * (steepness(a, b, low, form) * dx + CONDITION))
    return result / form.M1


def valid(x: float, form: Form):
    """Where p and q are positive, well formed, and x is."""
    p, q = form.a3 * x + form.c3, form.a2 * x + form.c2
    return (x > 0 and p > 0 and q > 0 and p * 256 > form.a3 * x + abs(form.c3)
            and q * 256 > form.a2 * x + abs(form.c2))


def search(x: float, zeta: complex, dx: float, dz: float, form: Form, drive_exponents: np.ndarray,
           drive: np.ndarray, e_exponents: np.ndarray, e_sums: np.ndarray, e_largest: np.ndarray,
           e_terms: np.ndarray, e_degrees: np.ndarray, b_exponents: np.ndarray, b_sums: np.ndarray,
           b_largest: np.ndarray, b_terms: np.ndarray, b_degrees: np.ndarray, r_exponents: np.ndarray,
           r_sums: np.ndarray, k_exponents: np.ndarray, k_sums: np.ndarray, rows: np.ndarray,
           powers: np.ndarray, pair: np.ndarray, retained: np.ndarray, row: np.ndarray, out: np.ndarray):
    """Whether the inequality holds at one place, and its constants A, z, eta, z_up, eta_up, k in out (6,):
    see `certificate`. drive_exponents (2, n), drive (n,): terms of the drive; e_: of the energy, b_: of the
    amplitude (`blurred`); r_, k_: of what is left of their rates. rows and those after: to work in."""
    low, top, D1, M1 = x - dx, x + dx, form.D1, form.M1
    if not (dx < x / 8 and valid(low, form)):
        return False
    size = abs(zeta) * (1 + SLACK) + dz
    prepare(rows, low, form)
    turn = turning(rows, form)
    if not total(k_sums, k_exponents, size, rows, form, row) < drives(drive_exponents, drive, rows)[0]:
        return False  # necessary, for k grows with A and as z falls: nothing else need be looked at
    value, blur = blurred(e_exponents, e_sums, e_largest, e_terms, e_degrees, zeta, size, x, low, dx, form,
                          rows, powers, pair, row)
    start, start_up = value - blur, value + blur
    A, z, growth, wide = size * GROWTH, low / GROWTH, 1e-6, 0.0
    for number in range(PASSES):
        step = min(1e-2, growth)  # ever faster past a slow approach
        growth *= 4
        columns(e_sums, A, retained)
        for _ in range(2):  # the equation for z is nearly linear
            if not valid(z, form):
                z = low
            prepare(rows, z, form)
            need = (max(summed(retained, e_exponents, rows, form) - start, 0.0) * (GROWTH + step)
                    + 1e-7 * low * turn)
            z = low - 2 * need / (D1 * (turn + turning(rows, form)))
            if not valid(z, form):
                z = low
        if not z < low:
            return False
        prepare(rows, z, form)
        left = total(k_sums, k_exponents, A, rows, form, row)
        least_drive, most_drive = drives(drive_exponents, drive, rows)
        eta, smallest = least_drive - left - SLACK * (M1 + left), least_drive / M1 - SLACK
        if not (eta > 0 and smallest > 0):
            return False
        if number == 0:  # its value costs most, and half of the searches end before
            value, blur = blurred(b_exponents, b_sums, b_largest, b_terms, b_degrees, zeta, size, x, low, dx,
                                  form, rows, powers, pair, row)
            weight = weight_within(drive_exponents, drive, form, x, low, dx, rows)
            wide = weight * size * size * (1 + SLACK) + value + blur
            prepare(rows, z, form)
        F = (wide + total(b_sums, b_exponents, A, rows, form, row)
             + integrated(r_sums, r_exponents, A, rows, form, row) * D1 / eta) / smallest
        if not F < 1e100:
            return False
        if F * (1 + SLACK) < A * A and size < A:
            e = summed(retained, e_exponents, rows, form)
            gained = D1 * (low - z) * (turn + turning(rows, form)) / 2
            if gained * (1 - SLACK) - SLACK * D1 * low * turn * 2.0**-8 > e - start:
                out[0], out[1], out[2], out[5] = A, z * (1 - SLACK), eta, left
                out[3] = top + (e + start_up) / (D1 * turn) * (1 + SLACK) + SLACK * top
                out[4] = (most_drive + left) * (1 + SLACK)
                return True
        A = max(A, math.sqrt(max(F, 0.0))) * (1 + step)
    return False


def place_about_fixed(w1: float, w2: float, w3: float, nearby: float, frame: np.ndarray):
    """(x, zeta, how far the one and the other may be off); frame: shift, centre, scale of the form."""
    shift, centre2, centre3, scale2, scale3 = frame[0], frame[1], frame[2], frame[3], frame[4]
    size = abs(w1) + abs(w2) + abs(w3) + abs(centre2) + abs(centre3)
    return (w1 + shift, complex(scale2 * (w2 - centre2), scale3 * (w3 - centre3)),
            BLUR * (abs(w1) + abs(shift)) + nearby, max(abs(scale2), abs(scale3)) * (BLUR * size + nearby))


def place_about_moving(w1: float, w2: float, w3: float, nearby: float, frame: np.ndarray, form: Form):
    """The same; frame: s, wheel, torque, roots, n2, n3 of the form. x = 0 where there is none."""
    s, l2, l3, M2, M3 = frame[0], frame[1], frame[2], frame[3], frame[4]
    r2, r3, n2, n3 = frame[5], frame[6], frame[7], frame[8]
    size, a2, a3 = abs(w1) + abs(w2) + abs(w3), form.a2, form.a3
    p, q, nearby = a3 * w1 + form.c3, a2 * w1 + form.c2, nearby + BLUR * size
    if not (p > 0 and q > 0 and nearby * max(a3 / p, a2 / q) < 1 / 64):
        return 0.0, 0j, 0.0, 0.0
    rho = math.sqrt(math.sqrt(q / p))
    eta = complex(r2 * rho * (w2 - s * (l2 * w1 - M3) / q), s * r3 / rho * (w3 - s * (l3 * w1 + M2) / p))
    moved2 = CONDITION * (size + (abs(l2 * w1) + abs(M3)) / q) + nearby * (1 + abs(n3) / (q * q))
    moved3 = CONDITION * (size + (abs(l3 * w1) + abs(M2)) / p) + nearby * (1 + abs(n2) / (p * p))
    turned = nearby * abs(form.c3 * (a2 - a3)) / (4 * p * q)
    return w1, eta, nearby, 1.25 * (r2 * rho * moved2 + r3 / rho * moved3 + (turned + CONDITION) * abs(eta))


def decide(chosen: np.ndarray, states: np.ndarray, reach: np.ndarray, fired: np.ndarray, number: int,
           result: np.ndarray, basis: np.ndarray, frame: np.ndarray, numbers: np.ndarray,
           drive_exponents: np.ndarray, drive: np.ndarray, e_exponents: np.ndarray, e_sums: np.ndarray,
           e_largest: np.ndarray, e_terms: np.ndarray, e_degrees: np.ndarray, b_exponents: np.ndarray,
           b_sums: np.ndarray, b_largest: np.ndarray, b_terms: np.ndarray, b_degrees: np.ndarray,
           r_exponents: np.ndarray, r_sums: np.ndarray, k_exponents: np.ndarray, k_sums: np.ndarray,
           rows: np.ndarray, powers: np.ndarray, pair: np.ndarray, retained: np.ndarray, row: np.ndarray,
           out: np.ndarray):
    """Ask for those of chosen rows that no test has fired for: fired (n,) becomes `number`, found (6, n) the
    constants, where the inequality holds for the whole ball of radius reach (n,) about the state. Returns
    for how many it does not. basis: (3, 3) axes in the body, rows; frame: the numbers of the place; numbers:
    of the form, (11,), for a tuple takes longer to hand over than all arrays; the others: of `search`."""
    form, left = Form(numbers[0], numbers[1], numbers[2], numbers[3], numbers[4], numbers[5], int(numbers[6]),
                      int(numbers[7]), int(numbers[8]), numbers[9], int(numbers[10])), 0
    for n in chosen:
        if fired[n] >= 0:
            continue
        left += 1
        v1, v2, v3 = states[n, 0], states[n, 1], states[n, 2]
        w1 = basis[0, 0] * v1 + basis[0, 1] * v2 + basis[0, 2] * v3
        w2 = basis[1, 0] * v1 + basis[1, 1] * v2 + basis[1, 2] * v3
        w3 = basis[2, 0] * v1 + basis[2, 1] * v2 + basis[2, 2] * v3
        if form.parts == 1:
            x, zeta, dx, dz = place_about_fixed(w1, w2, w3, reach[n], frame)
        else:
            x, zeta, dx, dz = place_about_moving(w1, w2, w3, reach[n], frame, form)
        if x > 0 and search(x, zeta, dx, dz, form, drive_exponents, drive, e_exponents, e_sums, e_largest,
                            e_terms, e_degrees, b_exponents, b_sums, b_largest, b_terms, b_degrees,
                            r_exponents, r_sums, k_exponents, k_sums, rows, powers, pair, retained, row,
                            out):
            fired[n], left = number, left - 1
            for i in range(6):
                result[i, n] = out[i]
    return left
