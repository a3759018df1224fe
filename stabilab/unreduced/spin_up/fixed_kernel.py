"""The certificate about the fixed centre in straight loops: elimination over dense tables, and the search for
A and z of one state.

The theorem and its inequality are those of `certificate`, elimination and its rounding those of
`elimination`. c[j, k, n] is the coefficient of zeta^j zeta*^k X^(1 - n), and beside it stands its majorant
m[j, k, n]; index n = 1 + power of 1/X. Corrected are two quantities:

Energy D1 X^2/2. Its rate is X G = M1 X + m* + what is left, G = D1 X' = M1 + gam Im zeta^2 + Re(kap* zeta).
Order 0 is the classical D1 X^2/2 + (gam/2om) Re zeta^2 - Im(kap* zeta)/om - Im(nu zeta)/(om^2 X): what is
taken at X^1 is all of X (G - M1), at X^0 what h and mu make of it, Re(nu zeta)/om, and m* = -Im(kap* mu)/om
stays exactly. It is formed exactly in `form.drag` and left out of the rate here with M1 X: the drive.

Amplitude |zeta|^2 (1 + m*/(M1 X)). It starts from |zeta|^2 + R/(om X), R = h Re zeta^2 - 2 Im(mu* zeta),
which takes out of (|zeta|^2)' = 2 h Im zeta^2 + 2 Re(mu* zeta) all there is at X^0. The price at X^-1 is
[along i h zeta* + mu] of R, and that vanishes identically: h Re zeta^2 gives 2 h Re(mu zeta), and -2 Im(mu*
zeta) gives -2 h Re(mu zeta). So the rate is -X' R/(om X^2), written down so, with no term at X^-1 at all, and
every term left falls as X^-2 or faster. The weight (which does not stand among the added terms) adds (m*/M1)
(|zeta|^2/X)', whose mean part -m* |zeta|^2/(D1 X^2) cancels that of -X' R/(om X^2) up to rounding (which the
sums hold): the flow keeps volume, so its mean does.

numba's cache on disk watches this file alone.
"""
from __future__ import annotations

import math

ROUNDING = 2.0**-32     # of coefficients over their majorants, as `elimination.ROUNDING`
# rounding of the terms' values, of their majorant: four times that of the coefficients alone
COEFFICIENT = 2.0**-36
SLACK = 2.0**-30
GROWTH = 1 + 1e-7       # of A between passes: strict inequalities need room
PASSES = 25             # of the search for A and z: it is monotone and settles in ten or never
BLUR = 2.0**-50         # relative, in the place of a state: a dozen operations, each within half of 2^-52


def put(c, m, j, k, n, value, size):
    """Add a term to a table."""
    c[j, k, n] += value
    m[j, k, n] += size


def price(c, m, j, k, n, value, size, numbers, rest):
    """Add to the table of a rate what the rest of d/dt makes of a term: all but the turning.

    numbers: (D1, M1, gam, h); rest: (mu, kap), complex. X' = (M1 + gam Im zeta^2 + Re(kap* zeta))/D1, zeta' =
    i h zeta* + mu.
    """
    D1, M1, gam, h = numbers[0], numbers[1], numbers[2], numbers[3]
    mu, kap = rest[0], rest[1]
    fall = n - 1.0
    if fall != 0:
        f, s = -fall * value / D1, abs(fall) * size / D1
        put(c, m, j, k, n + 1, f * M1, s * abs(M1))
        put(c, m, j + 2, k, n + 1, f * (-0.5j * gam), s * abs(0.5 * gam))
        put(c, m, j, k + 2, n + 1, f * (0.5j * gam), s * abs(0.5 * gam))
        put(c, m, j + 1, k, n + 1, f * (0.5 * kap.conjugate()), s * abs(0.5 * kap))
        put(c, m, j, k + 1, n + 1, f * (0.5 * kap), s * abs(0.5 * kap))
    if j:
        put(c, m, j - 1, k + 1, n, j * value * (1j * h), j * size * abs(h))
        put(c, m, j - 1, k, n, j * value * mu, j * size * abs(mu))
    if k:
        put(c, m, j + 1, k - 1, n, k * value * (-1j * h), k * size * abs(h))
        put(c, m, j, k - 1, n, k * value * mu.conjugate(), k * size * abs(mu))


def eliminate(c, m, added, most, order, om, numbers, rest):
    """Take everything oscillating up to X^-order out of the rate (c, m); what is added to the quantity goes
    to (added, most)."""
    top = c.shape[0]
    lift = 1j / om
    for n in range(order + 2):
        for degree in range(2 * top - 1):
            for j in range(max(0, degree - top + 1), min(degree, top - 1) + 1):
                k = degree - j
                if j == k or m[j, k, n] == 0:
                    continue
                value, size = c[j, k, n] * lift / (j - k), m[j, k, n] * abs(lift) / abs(j - k)
                c[j, k, n], m[j, k, n] = 0, 0
                put(added, most, j, k, n + 1, value, size)
                price(c, m, j, k, n + 1, value, size, numbers, rest)


def tables(orders, om, drag, numbers, rest, added_e, most_e, rate_e, rise_e, added_b, most_b, rate_b, rise_b):
    """Corrected energy and amplitude of orders (2,): each is (added terms, their majorants, terms of the
    rate, theirs), zeros at the start."""
    D1, M1, gam, h = numbers[0], numbers[1], numbers[2], numbers[3]
    mu, kap = rest[0], rest[1]
    put(rate_e, rise_e, 2, 0, 0, -0.5j * gam, abs(0.5 * gam))  # X (G - M1)
    put(rate_e, rise_e, 0, 2, 0, 0.5j * gam, abs(0.5 * gam))
    put(rate_e, rise_e, 1, 0, 0, 0.5 * kap.conjugate(), abs(0.5 * kap))
    put(rate_e, rise_e, 0, 1, 0, 0.5 * kap, abs(0.5 * kap))
    eliminate(rate_e, rise_e, added_e, most_e, orders[0], om, numbers, rest)
    rate_e[0, 0, 1], rise_e[0, 0, 1] = 0, 0  # m*, the drive's
    for j, k, value in ((2, 0, 0.5 * h / om + 0j), (0, 2, 0.5 * h / om + 0j),
                        (1, 0, 1j * mu.conjugate() / om), (0, 1, -1j * mu / om)):
        size = abs(value)
        put(added_b, most_b, j, k, 2, value, size)  # R/(om X)
        f, s = -value / D1, size / D1               # its rate is -X' R/(om X^2)
        put(rate_b, rise_b, j, k, 3, f * M1, s * abs(M1))
        put(rate_b, rise_b, j + 2, k, 3, f * (-0.5j * gam), s * abs(0.5 * gam))
        put(rate_b, rise_b, j, k + 2, 3, f * (0.5j * gam), s * abs(0.5 * gam))
        put(rate_b, rise_b, j + 1, k, 3, f * (0.5 * kap.conjugate()), s * abs(0.5 * kap))
        put(rate_b, rise_b, j, k + 1, 3, f * (0.5 * kap), s * abs(0.5 * kap))
    if drag != 0:
        price(rate_b, rise_b, 1, 1, 2, drag / M1 + 0j, abs(drag / M1), numbers, rest)
    eliminate(rate_b, rise_b, added_b, most_b, orders[1], om, numbers, rest)


def columns(table, A, row):
    """Sum of table[d, n] A^d over d, into row[n]."""
    for n in range(table.shape[1]):
        result = 0.0
        for d in range(table.shape[0] - 1, -1, -1):
            result = result * A + table[d, n]
        row[n] = result


def falling(row, count, over, first):
    """Sum of row[n] over^(first + n), n < count."""
    result = 0.0
    for n in range(count - 1, -1, -1):
        result = result * over + row[n]
    for _ in range(first):
        result *= over
    return result / over if first < 0 else result  # -1 at the least


def total(table, first, A, over, shift, row):
    """Sum of table[d, n - first] A^d z^(1 - n - shift), over = 1/z."""
    columns(table, A, row)
    return falling(row, table.shape[1], over, first + shift - 1)


def value_of(weights, terms, first, zeta, x, powers, row):
    """The value of a quantity whose terms come with their conjugates: terms[m, n - first] of zeta^j zeta*^k,
    weights (2, m): j, k."""
    powers[0] = 1
    for j in range(1, powers.size):
        powers[j] = powers[j - 1] * zeta
    count = terms.shape[1]
    for n in range(count):
        row[n] = 0.0
    for m in range(weights.shape[1]):
        factor = powers[weights[0, m]] * powers[weights[1, m]].conjugate()
        for n in range(count):
            row[n] += terms[m, n].real * factor.real - terms[m, n].imag * factor.imag
    return falling(row, count, 1 / x, first - 1)


def blurred(weights, terms, sums, majorant, first, zeta, size, x, low, dx, powers, row):
    """(value, blur) of a quantity at a place known within dx and within size - |zeta|."""
    value = value_of(weights, terms, first, zeta, x, powers, row)
    over = 1 / low
    inner = total(sums, first, abs(zeta), over, 0, row)
    most = total(sums, first, size, over, 0, row)
    for n in range(sums.shape[1]):
        row[n] *= abs(n + first - 1.0)
    moved = falling(row, sums.shape[1], over, first) * dx
    return value, ((most - inner) + moved * (1 + SLACK) + SLACK * most
                   + COEFFICIENT * total(majorant, first, size, over, 0, row))


def search(x, zeta, dx, dz, D1, M1, drag, weights_e, terms_e, weights_b, terms_b, e_sums, e_most, b_sums,
           b_most, r_tails, k_sums, firsts, powers, kept, row, out):
    """Whether the inequality holds at one place, and its constants A, z, eta, z_up, eta_up, k in out (6,):
    see `certificate`. firsts (4,): of the quantities e, b, r, k the index n of the first column. r_tails: for
    the integrals of the factors over all greater X. kept, row (most of their columns,): for work."""
    low, top = x - dx, x + dx
    if not (low > 0 and dx < x / 8):
        return False
    first_e, first_b, first_r, first_k = firsts[0], firsts[1], firsts[2], firsts[3]
    count_e = e_sums.shape[1]
    size = abs(zeta) * (1 + SLACK) + dz
    if not total(k_sums, first_k, size, 1 / low, 1, row) < M1 + min(0.0, drag) / low:
        return False  # necessary, for k grows with A and as z falls: nothing else need be looked at
    value, blur = blurred(weights_e, terms_e, e_sums, e_most, first_e, zeta, size, x, low, dx, powers, row)
    energy, energy_up = value - blur, value + blur
    A, z, growth, amplitude = size * GROWTH, low / GROWTH, 1e-6, 0.0
    for number in range(PASSES):
        step = min(1e-2, growth)  # ever faster past a slow approach
        growth *= 4
        columns(e_sums, A, kept)
        for _ in range(2):  # the equation for z is nearly linear
            need = (max(falling(kept, count_e, 1 / z, first_e - 1) - energy, 0.0) * (GROWTH + step)
                    + 1e-7 * low * low)
            z = low - 2 * need / (D1 * (low + (z if z > 0 else low)))
            if not z > 0:
                z = low
        if not z < low:
            return False
        over = 1 / z
        k = total(k_sums, first_k, A, over, 1, row)
        eta = M1 + min(0.0, drag) / z - k - SLACK * (M1 + k)
        least = 1 + min(0.0, drag) / (M1 * z) - SLACK
        if not (eta > 0 and least > 0):
            return False
        if number == 0:  # its value costs most, and half of the searches end before
            value, blur = blurred(weights_b, terms_b, b_sums, b_most, first_b, zeta, size, x, low, dx, powers,
                                  row)
            mean = drag / M1
            weight = 1 + mean / x + abs(mean) * (dx / (low * low) + BLUR / x) + BLUR
            amplitude = weight * size * size * (1 + SLACK) + value + blur
        F = (amplitude + total(b_sums, first_b, A, over, 0, row)
             + total(r_tails, first_r, A, over, -1, row) * D1 / eta)
        F /= least
        if not F < 1e100:
            return False
        if F * (1 + SLACK) < A * A and size < A:
            e = falling(kept, count_e, over, first_e - 1)
            gained = D1 * (low - z) * (low + z) / 2
            if gained * (1 - SLACK) - SLACK * D1 * low * low * 2.0**-8 > e - energy:
                out[0], out[1], out[2], out[5] = A, z * (1 - SLACK), eta, k
                out[3] = top + (e + energy_up) / (D1 * low) * (1 + SLACK) + SLACK * top
                out[4] = (M1 + max(0.0, drag) / z + k) * (1 + SLACK)
                return True
        A = max(A, math.sqrt(max(F, 0.0))) * (1 + step)
    return False


def decide(rows, states, reach, fired, number, found, order, frame, D1, M1, drag, weights_e, terms_e,
           weights_b, terms_b, e_sums, e_most, b_sums, b_most, r_tails, k_sums, firsts, powers, kept, row,
           constants):
    """Ask for those of rows that no test has fired for: fired (n,) becomes `number`, found (6, n) the
    constants, where the inequality holds for the whole ball of radius reach (n,) about the state. order (3,),
    frame (8,): turn, shift, centre, scale of the form."""
    most = max(abs(frame[6]), abs(frame[7]))
    for n in rows:
        if fired[n] >= 0:
            continue
        w1, w2 = frame[0] * states[n, order[0]], frame[1] * states[n, order[1]]
        w3, near = frame[2] * states[n, order[2]], reach[n]
        x = w1 + frame[3]
        if not x > 0:
            continue
        size = abs(w1) + abs(w2) + abs(w3) + abs(frame[4]) + abs(frame[5])
        zeta = complex(frame[6] * (w2 - frame[4]), frame[7] * (w3 - frame[5]))
        if search(x, zeta, BLUR * (abs(w1) + abs(frame[3])) + near, most * (BLUR * size + near), D1, M1, drag,
                  weights_e, terms_e, weights_b, terms_b, e_sums, e_most, b_sums, b_most, r_tails, k_sums,
                  firsts, powers, kept, row, constants):
            fired[n] = number
            for i in range(6):
                found[i, n] = constants[i]
