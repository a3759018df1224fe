"""The certificate about the moving centre in straight loops: the search for A and z of one state.

The theorem and its inequality are those of `certificate`, the form that of `centres.MovingCentre`. A sum is a
table[degree, pair] with the exponents (2, pairs) of p^(-a/4) q^(-b/4); powers of p, q and of their greatest
ratios come from four rows of a work table, made by multiplication. All in one file: numba's cache on disk
watches no other.
"""
from __future__ import annotations

import math

# As of `fixed_kernel`; the tests hold them equal
SLACK, GROWTH, PASSES, COEFFICIENT, BLUR = 2.0**-30, 1 + 1e-7, 25, 2.0**-36, 2.0**-50
CONDITION = 2.0**8 * BLUR  # rounding of p and q over themselves; 2^-36 in the powers that occur
MIDDLE = 200  # place of the power 0 in a row


def fill(row, base, reach):
    """base^(n/4) at MIDDLE + n for |n| <= reach."""
    up = math.sqrt(math.sqrt(base))
    down, one, other = 1 / up, 1.0, 1.0
    row[MIDDLE] = 1.0
    for n in range(1, reach + 1):
        one *= up
        other *= down
        row[MIDDLE + n], row[MIDDLE - n] = one, other


def prepare(rows, p, q, a2, a3, reach):
    """Rows of powers: of p and q falling, of the greatest q/p and p/q from here on rising."""
    fill(rows[0], 1 / p, reach)
    if a2 > 0:
        fill(rows[1], 1 / q, reach)
        fill(rows[2], max(q / p, a2 / a3), reach)
        fill(rows[3], max(p / q, a3 / a2), reach)
    else:
        rows[1, :] = 1.0


def greatest(a, b, rows, a2):
    """A decreasing bound of the factor from here on: of mixed signs, a power of the ratio splits off."""
    if a2 == 0:
        return rows[0, MIDDLE + a] if a >= 0 else math.inf
    if a >= 0 and b >= 0:
        return rows[0, MIDDLE + a] * rows[1, MIDDLE + b]
    if a + b < 0:
        return math.inf
    return (rows[2, MIDDLE - b] * rows[0, MIDDLE + a + b] if b < 0
            else rows[3, MIDDLE - a] * rows[1, MIDDLE + a + b])


def tail(a, b, rows, a2, a3):
    """The least of four bounds of the integral of the factor over all greater x: of factors that both fall,
    one stays as it is; or a power of the ratio splits off. Infinity where it does not fall faster than
    1/x."""
    best = math.inf
    if a > 4 and b >= 0:
        best = rows[1, MIDDLE + b] * rows[0, MIDDLE + a - 4] / (a3 * (a / 4 - 1))
    if a2 == 0:
        return best
    if b > 4 and a >= 0:
        best = min(best, rows[0, MIDDLE + a] * rows[1, MIDDLE + b - 4] / (a2 * (b / 4 - 1)))
    n = (a + b) / 4
    if n > 1:
        by_p = rows[3, MIDDLE + b] if b > 0 else rows[2, MIDDLE - b]
        by_q = rows[2, MIDDLE + a] if a > 0 else rows[3, MIDDLE - a]
        best = min(best, by_p * rows[0, MIDDLE + a + b - 4] / (a3 * (n - 1)),
                   by_q * rows[1, MIDDLE + a + b - 4] / (a2 * (n - 1)))
    return best


def total(table, pairs, A, rows, a2, a3, kind, dx, p, q):
    """Sum of table[d, pair] A^d times the factor's bound (kind 0), its integral's (1), or its bound times
    steepness times dx (2)."""
    result = 0.0
    for n in range(table.shape[1]):
        part = 0.0
        for d in range(table.shape[0] - 1, -1, -1):
            part = part * A + table[d, n]
        if part != 0:
            a, b = pairs[0, n], pairs[1, n]
            factor = tail(a, b, rows, a2, a3) if kind == 1 else greatest(a, b, rows, a2)
            if kind == 2:
                factor *= (abs(a) * a3 / p + abs(b) * a2 / q) / 4 * dx
            result += part * factor
    return result


def value_of(table, degrees, pairs, zeta, rows, powers):
    """The value of a quantity whose terms come with their conjugates: table[power, pair] of zeta^j zeta*^k, j
    >= k."""
    powers[0] = 1
    for j in range(1, powers.size):
        powers[j] = powers[j - 1] * zeta
    result = 0.0
    for row in range(table.shape[0]):
        inner = 0j
        for n in range(table.shape[1]):
            inner += table[row, n] * (rows[0, MIDDLE + pairs[0, n]] * rows[1, MIDDLE + pairs[1, n]])
        result += (inner * powers[degrees[0, row]] * powers[degrees[1, row]].conjugate()).real
    return result


def drives(drive, p, q):
    """(least, greatest) of G0 from here on; drive (3, n): a, b, c of its terms."""
    low = high = 0.0
    for n in range(drive.shape[1]):
        a, b, c = drive[0, n], drive[1, n], drive[2, n]
        if a == 0 and b == 0:
            low += c
            high += c
        else:
            value = c * p ** (-a / 4) * q ** (-b / 4)
            low, high = low + min(value, 0.0), high + max(value, 0.0)
    return low, high


def weight_within(drive, p, q, p_low, q_low, a2, a3, dx, M1):
    """A bound of G0/M1 within dx."""
    result = 0.0
    for n in range(drive.shape[1]):
        a, b, c = drive[0, n], drive[1, n], drive[2, n]
        steep = (abs(a) * a3 / p_low + abs(b) * a2 / q_low) / 4
        result += (c * p ** (-a / 4) * q ** (-b / 4)
                   + abs(c) * p_low ** (-a / 4) * q_low ** (-b / 4) * (steep * dx + CONDITION))
    return result / M1


def search(x, zeta, dx, dz, D1, M1, a2, a3, c, reach, drive, value_e, degrees_e, value_b, degrees_b, pairs_e,
           e_sums, e_most, pairs_b,
           b_sums, b_most, pairs_r, r_sums, pairs_k, k_sums, rows, powers, out):
    """Whether the inequality holds at one place, and its constants A, z, eta, z_up, eta_up, k in out (6,)."""
    low, top = x - dx, x + dx
    p, q, p_low, q_low = a3 * x + c, a2 * x + c, a3 * low + c, a2 * low + c
    well = p_low > 0 and q_low > 0 and p_low * 256 > a3 * low + abs(c) and q_low * 256 > a2 * low + abs(c)
    if not (well and low > 0 and dx < x / 8):
        return False
    size, turning = abs(zeta) * (1 + SLACK) + dz, math.sqrt(p_low * q_low)
    prepare(rows, p_low, q_low, a2, a3, reach)
    if not total(k_sums, pairs_k, size, rows, a2, a3, 0, 0.0, p, q) < drives(drive, p_low, q_low)[1]:
        return False
    ends = (0.0, 0.0, 0.0, 0.0)
    for which in range(2):
        prepare(rows, p, q, a2, a3, reach)
        if which == 0:
            value = value_of(value_e, degrees_e, pairs_e, zeta, rows, powers)
        else:
            value = value_of(value_b, degrees_b, pairs_b, zeta, rows, powers)
        prepare(rows, p_low, q_low, a2, a3, reach)
        sums, pairs = (e_sums, pairs_e) if which == 0 else (b_sums, pairs_b)
        most = e_most if which == 0 else b_most
        wide = total(sums, pairs, size, rows, a2, a3, 0, 0.0, p, q)
        blur = wide - total(sums, pairs, abs(zeta), rows, a2, a3, 0, 0.0, p, q) + SLACK * wide
        blur += total(sums, pairs, size, rows, a2, a3, 2, dx, p_low, q_low) * (1 + SLACK)
        blur += COEFFICIENT * total(most, pairs, size, rows, a2, a3, 0, 0.0, p, q)
        ends = (value - blur, value + blur, ends[2],
                ends[3]) if which == 0 else (ends[0], ends[1], value - blur, value + blur)
    energy, energy_up = ends[0], ends[1]
    amplitude = weight_within(drive, p, q, p_low, q_low, a2, a3, dx, M1) * size * size * (1 + SLACK) + ends[3]
    A, z, growth = size * GROWTH, low / GROWTH, 1e-6
    for _ in range(PASSES):
        step = min(1e-2, growth)
        growth *= 4
        for _ in range(2):
            if not valid(z, a2, a3, c):
                z = low
            pz, qz = a3 * z + c, a2 * z + c
            prepare(rows, pz, qz, a2, a3, reach)
            need = (max(total(e_sums, pairs_e, A, rows, a2, a3, 0, 0.0, p, q) - energy, 0.0) * (GROWTH + step)
                    + 1e-7 * low * turning)
            z = low - 2 * need / (D1 * (turning + math.sqrt(pz * qz)))
            if not valid(z, a2, a3, c):
                z = low
        if not z < low:
            return False
        pz, qz = a3 * z + c, a2 * z + c
        prepare(rows, pz, qz, a2, a3, reach)
        k = total(k_sums, pairs_k, A, rows, a2, a3, 0, 0.0, p, q)
        least_drive, most_drive = drives(drive, pz, qz)
        eta, least = least_drive - k - SLACK * (M1 + k), least_drive / M1 - SLACK
        if not (eta > 0 and least > 0):
            return False
        b, r = total(b_sums, pairs_b, A, rows, a2, a3, 0, 0.0, p,
                     q), total(r_sums, pairs_r, A, rows, a2, a3, 1, 0.0, p, q)
        F = (amplitude + b + r * D1 / eta) / least
        if not F < 1e100:
            return False
        if F * (1 + SLACK) < A * A and size < A:
            e = total(e_sums, pairs_e, A, rows, a2, a3, 0, 0.0, p, q)
            gained = D1 * (low - z) * (turning + math.sqrt(pz * qz)) / 2
            if gained * (1 - SLACK) - SLACK * D1 * low * turning * 2.0**-8 > e - energy:
                out[0], out[1], out[2], out[5] = A, z * (1 - SLACK), eta, k
                out[3] = top + (e + energy_up) / (D1 * turning) * (1 + SLACK) + SLACK * top
                out[4] = (most_drive + k) * (1 + SLACK)
                return True
        A = max(A, math.sqrt(max(F, 0.0))) * (1 + step)
    return False


def valid(x, a2, a3, c):
    """Where p and q are positive, well formed, and x is."""
    p, q = a3 * x + c, a2 * x + c
    return p > 0 and q > 0 and p * 256 > a3 * abs(x) + abs(c) and q * 256 > a2 * abs(x) + abs(c) and x > 0


def decide(chosen, states, reach, fired, number, found, basis, frame, D1, M1, a2, a3, c, reach_of_powers,
           drive, value_e, degrees_e, value_b, degrees_b,
           pairs_e, e_sums, e_most, pairs_b, b_sums, b_most, pairs_r, r_sums, pairs_k, k_sums, rows, powers,
           constants):
    """As `fixed_kernel.decide`; basis (3, 3), frame (9,): s, wheel, torque, roots, n2, n3 of the form."""
    s, l2, l3, M2, M3 = frame[0], frame[1], frame[2], frame[3], frame[4]
    r2, r3, n2, n3 = frame[5], frame[6], frame[7], frame[8]
    for n in chosen:
        if fired[n] >= 0:
            continue
        w1, w2, w3 = states[n, 0], states[n, 1], states[n, 2]
        size = abs(w1) + abs(w2) + abs(w3)
        x, y, z = (basis[0, 0] * w1 + basis[0, 1] * w2 + basis[0, 2] * w3,
                   basis[1, 0] * w1 + basis[1, 1] * w2 + basis[1, 2] * w3,
                   basis[2, 0] * w1 + basis[2, 1] * w2 + basis[2, 2] * w3)
        p, q = a3 * x + c, a2 * x + c
        near = reach[n] + BLUR * size
        if not (x > 0 and p > 0 and q > 0 and near * max(a3 / p, a2 / q) < 1 / 64):
            continue
        rho = math.sqrt(math.sqrt(q / p))
        eta = complex(r2 * rho * (y - s * (l2 * x - M3) / q), s * r3 / rho * (z - s * (l3 * x + M2) / p))
        moved2 = CONDITION * (size + (abs(l2 * x) + abs(M3)) / q) + near * (1 + abs(n3) / (q * q))
        moved3 = CONDITION * (size + (abs(l3 * x) + abs(M2)) / p) + near * (1 + abs(n2) / (p * p))
        turned = near * abs(c * (a2 - a3)) / (4 * p * q)
        dz = 1.25 * (r2 * rho * moved2 + r3 / rho * moved3 + (turned + CONDITION) * abs(eta))
        if search(x, eta, near, dz, D1, M1, a2, a3, c, reach_of_powers, drive, value_e, degrees_e, value_b,
                  degrees_b, pairs_e, e_sums, e_most, pairs_b,
                  b_sums, b_most, pairs_r, r_sums, pairs_k, k_sums, rows, powers, constants):
            fired[n] = number
            for i in range(6):
                found[i, n] = constants[i]
