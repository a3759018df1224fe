"""Taylor series in mpmath's numbers: the motions that enclosures are judged by; no code is shared with them.
"""
from fractions import Fraction

import mpmath

ORDER = 45


def run(rows, start, times, digits=50):
    """States at increasing times of x_i' = kappa_i x_j x_k + rho_i x_k + sigma_i x_j + m_i (rows: kappa, rho,
    sigma, m; exact numbers) from an exact start."""
    out = []
    with mpmath.workdps(digits):
        number = lambda v: mpmath.mpf(Fraction(v).numerator) / Fraction(v).denominator
        kappa, rho, sigma, m = [list(map(number, row)) for row in rows]
        x, now = list(map(number, start)), mpmath.mpf(0)
        for end in map(number, times):
            while now < end:
                a = [[v] for v in x]
                for n in range(ORDER):
                    products = [mpmath.fsum(p * q for p,
                                            q in zip(a[(i + 1) % 3], a[(i + 2) % 3][::-1], strict=True))
                                for i in range(3)]
                    new = [(kappa[i] * products[i] + rho[i] * a[(i + 2) % 3][n] + sigma[i] * a[(i + 1) % 3][n]
                            + (0 if n else m[i])) / (n + 1)
                           for i in range(3)]
                    for row, value in zip(a, new):
                        row.append(value)
                top, size = max(abs(row[ORDER]) for row in a), max(map(abs, x)) or mpmath.mpf(1)
                h = (min(end - now, (size * mpmath.mpf(10) ** (12 - digits) / top) ** (mpmath.mpf(1) / ORDER))
                     if top else end - now)
                x, now = [mpmath.polyval(row[::-1], h) for row in a], now + h
            out.append(x)
    return out


def shares(middle, rest, radius, true, digits=50):
    """|true - (middle + rest)|/radius of three rates: at most 1 where the enclosure holds."""
    with mpmath.workdps(digits):
        return [float(abs(mpmath.mpf(float(m)) + mpmath.mpf(float(r)) - x) / mpmath.mpf(float(e))) for m, r,
                e, x in zip(middle, rest, radius, true)]
