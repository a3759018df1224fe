"""How high the barrier stands over a place: saddles in closed form (quartics) in 50 digits, of the scaled
minor and middle axis and of a torque about the major axis; from the equations of motion, sharing nothing with
the analysis.

A place is the pair of components across the torque's axis, two doubles taken exactly. The motion turns back
before the barrier iff v^2/2 < height, v the component along the axis.
"""
from __future__ import annotations

from fractions import Fraction

import mpmath as mp
import numpy as np

DIGITS = 50
APART = mp.mpf(10) ** -6  # nearer to a fold than this, roots are too close to be told as saddle and centre


def _num(v):
    return mp.mpf(Fraction(v).numerator) / Fraction(v).denominator


def _real(coefficients):
    """Real roots, highest power first: found in doubles, each made exact by Newton's method; those that
    doubles leave in doubt (a pair about to merge) raise Unclear."""
    found = []
    for guess in np.roots([float(c) for c in coefficients]).tolist():
        if abs(guess.imag) > 1e-4 * abs(guess):
            continue
        if guess.imag:
            raise Unclear
        x = mp.mpf(guess.real)
        for _ in range(60):
            value, slope = mp.polyval(coefficients, x, derivative=True)
            step = value / slope
            x -= step
            if abs(step) <= abs(x) * mp.mpf(10) ** (8 - DIGITS):
                break
        if not abs(x - guess.real) < 1e-3 * abs(x) or any(abs(x - other) < 1e-6 * abs(x) for other in found):
            raise Unclear
        found.append(x)
    return found


class Unclear(ArithmeticError):
    """Too near to a fold."""


def minor(a, b, x1, x2):
    """Torque mu3 = 1: X = x1 + a = A sin t, x2 = A cos t, t' = x3, t'' = 1 + x2 (X + c); the saddles X = -(c
    + 1/h), x2 = h with h^4 > c h + 1. Height of the highest one within a turn ahead (None without): U = -t -
    X (X + 2 c)/2."""
    with mp.workdps(DIGITS):
        c, X, z = _num(Fraction(b) - Fraction(a)), _num(Fraction(x1) + Fraction(a)), _num(x2)
        here, heights = mp.atan2(X, z), []
        for h in _real([1, 0, c * c - X * X - z * z, 2 * c, 1]):
            kind = h ** 4 - c * h - 1
            if abs(kind) < APART:
                return None
            if kind > 0:
                Xs = -(c + 1 / h)
                way = mp.atan2(Xs, h) - here
                way += 2 * mp.pi if way <= 0 else 0
                heights.append(-way - (Xs - X) * (Xs + X + 2 * c) / 2)
        return max(heights, default=None)


def middle(a, b, x3, x1):
    """Torque mu2 = 1: Y = x1 + b, Y' = x3, x3' = Y along the angle t, t' = x2, t'' = 1 - x3 (Y - c); the
    saddles x3 = g, Y = c + 1/g with g^4 + c g + 1 < 0, on the branch of the place. U = -t + Y^2/2 - c Y."""
    with mp.workdps(DIGITS):
        c, Y, z = _num(Fraction(b) - Fraction(a)), _num(Fraction(x1) + Fraction(b)), _num(x3)
        for g in _real([1, 0, Y * Y - z * z - c * c, -2 * c, -1]):
            Ys, kind = c + 1 / g, g ** 4 + c * g + 1
            if kind < -APART and (Ys + g) * (Y + z) > 0 and (Ys - g) * (Y - z) > 0:
                way = mp.log((Ys + g) / (Y + z))
                return -way + (Ys - Y) * (Ys + Y) / 2 - c * (Ys - Y)
        return None


def major(inertia, momentum, torque, w2, w3):
    """Torque M > 0 about axis 1, gyrostatic moment across it: u = w2 + s2, v = w3 + s3 with u' = p v, v' = q
    u along the angle; U = (D2 w2^2 + D3 w3^2)/2 - M t. Height in units of D1, of the highest saddle within a
    turn ahead."""
    with mp.workdps(DIGITS):
        D1, D2, D3 = map(_num, inertia)
        M, s2, s3 = _num(torque), _num(momentum[1]) / (D2 - D1), _num(momentum[2]) / (D3 - D1)
        p, q = (D3 - D1) / D2, (D1 - D2) / D3
        k, u0, v0 = mp.sqrt(-p * q), _num(w2) + s2, _num(w3) + s3
        # u = u0 cos + (p/k) v0 sin, v = v0 cos + (q/k) u0 sin of k t; with T = tan(k t/2) the torque's
        # balance is a quartic
        U, V, one = [-u0, 2 * p * v0 / k, u0], [-v0, 2 * q * u0 / k, v0], [1, 0, 1]
        times = lambda f, g: [sum(f[i] * g[n - i] for i in range(3) if 0 <= n - i < 3) for n in range(5)]
        balance = [(D2 * p + D3 * q) * uv - D2 * p * s2 * v - D3 * q * s3 * u - M * w
                   for uv, v, u, w in zip(times(U, V), times(V, one), times(U, one), times(one, one))]
        heights = []
        for T in _real(balance):
            u, v = (mp.polyval(f, T) / (1 + T * T) for f in (U, V))
            bend = D2 * p * (q * u * (u - s2) + p * v * v) + D3 * q * (p * v * (v - s3) + q * u * u)
            if abs(bend) < APART * M:
                return None
            if bend < 0:
                way = 2 * mp.atan(T) / k
                way += 2 * mp.pi / k if way <= 0 else 0
                heights.append((D2 * ((u - s2) ** 2 - (u0 - s2) ** 2) + D3 * ((v - s3) ** 2 - (v0 - s3) ** 2))
                               / 2 - M * way)
        return max(heights) / D1 if heights else None
