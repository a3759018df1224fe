"""The three eigenvalues of a traceless Jacobian, from z^3 + m z + n = 0 with exact m and n."""
from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from ..numbers.exact import sqrt_fraction
from ..numbers.vectors import Number
from ..physics.quadratic import QuadraticForm

BITS = 220  # working precision; far above double, so that each printed part is rounded once


def invariants(form: QuadraticForm, x: Sequence[Number], w: Number = 1) -> tuple[Number, Number]:
    """(m, n) of the characteristic polynomial z^3 + m z + n of the Jacobian at x / w, times w^2 and w^3.

    form: QuadraticForm. x, w: rationals, surds of one root, or polynomials (a rational curve, w its denominator).
    """
    k, r, s = form.kappa, form.rho, form.sigma
    j12, j13 = k[0] * x[2] + s[0] * w, k[0] * x[1] + r[0] * w
    j23, j21 = k[1] * x[0] + s[1] * w, k[1] * x[2] + r[1] * w
    j31, j32 = k[2] * x[1] + s[2] * w, k[2] * x[0] + r[2] * w
    m = -(j12 * j21 + j13 * j31 + j23 * j32)
    n = -(j12 * j23 * j31 + j13 * j21 * j32)
    return m, n


def eigenvalues(m: Fraction, n: Fraction) -> tuple[complex, ...]:
    """Roots of z^3 + m z + n, each part correct to rounding, sums of real parts zero by structure.

    n = 0 gives an exact 0 and an exactly real or exactly imaginary pair; a complex pair is exactly conjugate.
    """
    if not m and not n:
        return 0j, 0j, 0j
    if not n:
        root = float(sqrt_fraction(abs(m)))
        return (0j, complex(0.0, root), complex(0.0, -root)) if m > 0 else (0j, complex(root, 0.0), complex(-root, 0.0))
    r = real_root(m, n)
    # the other two solve z^2 + r z + (r^2 + m) = 0; the sign of its discriminant is that of -4 m^3 - 27 n^2
    kind = -4 * m**3 - 27 * n * n
    if not kind:
        double = complex(float(-3 * n / (2 * m)), 0.0)
        return complex(float(3 * n / m), 0.0), double, double
    half, gap = -r / 2, sqrt_fraction(abs(3 * r * r / 4 + m))
    if kind < 0:
        return complex(float(r), 0.0), complex(float(half), float(gap)), complex(float(half), -float(gap))
    far = half + gap if half > 0 else half - gap
    return complex(float(r), 0.0), complex(float(far), 0.0), complex(float(-n / (r * far)), 0.0)


def real_root(m: Fraction, n: Fraction) -> Fraction:
    """The real root of sign -n that is simple and, where all are real, the largest in size; to about 2**-200.

    Newton from above on the convex side of z^3 + m z - |n|, so it falls steadily to the root.
    """
    size = abs(n)
    cube = _cube_root_above(size)
    z = min(size / m, cube) if m > 0 else 2 * max(sqrt_fraction(-m, 60), cube)
    for _ in range(60):
        step = (z * z * z + m * z - size) / (3 * z * z + m)
        z = _rounded(z - step)
        if abs(step) < z / 2**(BITS // 2 + 4):
            break
    return -z if n > 0 else z


def _cube_root_above(value: Fraction) -> Fraction:
    """A power of two times a double, a little above the cube root."""
    shift = (value.numerator.bit_length() - value.denominator.bit_length()) // 3
    scaled = float(value / Fraction(2) ** (3 * shift))
    return Fraction(scaled ** (1 / 3) * 1.001) * Fraction(2) ** shift


def _rounded(value: Fraction) -> Fraction:
    """`value` with BITS leading bits, rounded."""
    shift = BITS - value.numerator.bit_length() + value.denominator.bit_length()
    scaled = (value.numerator << shift) // value.denominator if shift >= 0 else value.numerator // (value.denominator << -shift)
    return Fraction(scaled) * Fraction(2) ** -shift
