"""Equilibria along an orbit of any kind, one motion at a time, as straight lines of floats that numba
compiles.

In T = tanh(n y/2)/n (tan on circles, y/2 on parabolas) S1 = 2 T/(1 - e T^2), S2 = 2 T^2/(1 - e T^2), and the
force K' of `arc_kernel` times (1 - e T^2)^2 is one quartic on all of them,

    f0 + 2 f1 T + (2 (F + 3 c) - 2 e f0) T^2 + (4 g - 2 e f1) T^3 + e (e f0 - 2 F + 2 c) T^4.           (4)

Its real roots by Rolle's theorem: those of its second derivative cut the line for the first, these for the
quartic. Two charts, T/R and R/T with R the mean size of the roots, have all between -1 and 1. A pair of
equilibria that rounding loses differs in height by rounding. Every function is plain Python too.
"""
from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .arc_kernel import INFINITY, ROUNDINGS, ULP, kinetic

# columns of a point of equilibrium: its arc from the base, K there and the error of that, dF/d alpha
ARC, HEIGHT, ERROR, SLOPE = range(4)
POINTS = 16  # room for so many: four roots, on a circle a turn earlier or later too
BISECTIONS = 80
# relative: a last step of Newton's method whose square is next to nothing; a bracket that is one
STEP, BRACKET = 1e-9, 1e-14
NEWTON_STEPS = 3  # from a root to its equilibrium
LAST_STEP = 1e-7  # of an arc: K at an equilibrium is second order in it
BESIDE = 1.37  # no root of a sphere's quartic, nor of one with a single term less, stands at that times R


# --- Real roots of a quartic
def quartic(q: Sequence[float], x: float):
    """(value, slope) of a quartic, lowest coefficient first."""
    a, b, c, d, e = q
    return a + x * (b + x * (c + x * (d + x * e))), b + x * (2 * c + x * (3 * d + x * 4 * e))


def root_between(q: Sequence[float], low: float, high: float, at_low: float):
    """The root of a quartic that is monotone on an interval with a change of sign, at_low its value at one
    end."""
    x = 0.5 * (low + high)
    for _ in range(BISECTIONS):
        result, slope = quartic(q, x)
        if (result > 0) == (at_low > 0):
            low = x
        else:
            high = x
        # before the bracket: a converged step leaves that by a rounding
        step = result / slope
        if abs(step) <= STEP * abs(x) or result == 0 or high - low <= BRACKET * abs(x):
            return x - step if low <= x - step <= high else x
        x = x - step if low < x - step < high else 0.5 * (low + high)
    return x


def roots_between(q: Sequence[float], cuts: np.ndarray, count: int, roots: np.ndarray):
    """Fill roots with those of a quartic between neighbours of so many cuts, at whose inner ones it is
    stationary; how many there are."""
    total, last = 0, quartic(q, cuts[0])[0]
    for n in range(1, count):
        now = quartic(q, cuts[n])[0]
        if (last < 0 < now) or (now < 0 < last):
            roots[total] = root_between(q, cuts[n - 1], cuts[n], last)
            total += 1
        elif now == 0 and n < count - 1:
            roots[total] = cuts[n]
            total += 1
        last = now
    return total


def real_roots(q: Sequence[float], low: float, high: float, cuts: np.ndarray, roots: np.ndarray):
    """Fill roots with those of a quartic between low and high, ascending; how many there are. cuts: room
    (2, 8)."""
    _, b, c, d, e = q
    first, second = cuts[0], cuts[1]
    first[0], count = low, 1
    square = 9 * d * d - 24 * c * e
    if square > 0:
        w = -(3 * d + (np.sqrt(square) if d > 0 else -np.sqrt(square)))
        one, other = (w / (12 * e) if e != 0 else INFINITY), (2 * c / w if w != 0 else INFINITY)
        if low < min(one, other) < high:
            first[count] = min(one, other)
            count += 1
        if low < max(one, other) < high:
            first[count] = max(one, other)
            count += 1
    first[count] = high
    count = roots_between((b, 2 * c, 3 * d, 4 * e, 0.0), first, count + 1, second[1:])
    second[0], second[count + 1] = low, high
    return roots_between(q, second, count + 2, roots)


# --- Arcs to the equilibria
def arc_of(T: float, inverse: bool, n: float, e: float):
    """y of T, or of 1/T."""
    if e < 0:
        return 2 * (np.arctan2(n if T >= 0 else -n, abs(T)) if inverse else np.arctan(n * T)) / n
    if e > 0:
        return 2 * np.arctanh(n / T if inverse else n * T) / n
    return 2 / T if inverse else 2 * T


def force_quartic(series: Sequence[float]):
    """The coefficients of (4)."""
    _, f0, f1, f2, c, g, e = series
    return f0, 2 * f1, 2 * (f2 + 3 * c) - 2 * e * f0, 4 * g - 2 * e * f1, e * (e * f0 - 2 * f2 + 2 * c)


def stretched(q: Sequence[float], R: float):
    """The coefficients in x/R of a quartic in x."""
    return q[0], q[1] * R, q[2] * R * R, q[3] * R * R * R, q[4] * R * R * R * R


def equilibria(series: Sequence[float], cuts: np.ndarray, roots: np.ndarray, arcs: np.ndarray):
    """Fill arcs with those from a base to the equilibria of its orbit, once round, in no order; how many
    there are."""
    e, q = series[6], force_quartic(series)
    n = np.sqrt(abs(e))
    low, high = 0, 4
    while low < 4 and q[low] == 0:
        low += 1
    while high > 0 and q[high] == 0:
        high -= 1
    if low >= high:
        return 0
    R, edge = BESIDE * abs(q[low] / q[high]) ** (1.0 / (high - low)), INFINITY
    if e > 0:  # T is less than 1/n on a hyperbola
        edge = 1 / n
        R = min(R, edge)
    if not 0 < R < INFINITY:
        return 0
    q = stretched(q, R)
    total = 0
    count = real_roots(q, -1.0, 1.0, cuts, roots)
    for k in range(count):
        arcs[total] = arc_of(roots[k] * R, False, n, e)
        total += 1
    q = q[4], q[3], q[2], q[1], q[0]
    if e >= 0:  # there a root at infinity is none
        for _ in range(4 - high):
            q = q[1], q[2], q[3], q[4], 0.0 * q[0]
    if R < edge:
        for side in range(2 if e > 0 else 1):
            first, last = -1.0, 1.0
            if e > 0:
                first, last = (R / edge, 1.0) if side else (-1.0, -R / edge)
            count = real_roots(q, first, last, cuts, roots)
            for k in range(count):
                arcs[total] = arc_of(roots[k] / R, True, n, e)
                total += 1
    return total


def equilibria_from_throat(series: Sequence[float], cuts: np.ndarray, roots: np.ndarray, arcs: np.ndarray):
    """As `equilibria`, far from the throat of a hyperbola, where the base is: there T crowds at 1/n, and K'
    is a quartic in exp(n y) over exp(2 n y). Not for small n: its coefficients go with 1/e."""
    _, f0, f1, f2, c, g, e = series
    n = np.sqrt(e)
    even, odd = 0.5 * (f2 - c) / e, 0.5 * (f1 - g / e) / n
    q = (0.5 * c / e - 0.25 * g / (n * e), even - odd, f0 - f2 / e, even + odd,
         0.5 * c / e + 0.25 * g / (n * e))
    if q[0] == 0 or q[4] == 0:
        return 0
    R, total = BESIDE * abs(q[0] / q[4]) ** 0.25, 0
    q = stretched(q, R)
    for side in range(2):
        count = real_roots(q, 0.0, 1.0, cuts, roots)
        for k in range(count):
            arcs[total] = np.log(R / roots[k] if side else R * roots[k]) / n
            total += 1
        q = q[4], q[3], q[2], q[1], q[0]
    return total


def settled_arc(y: float, series: Sequence[float]):
    """An equilibrium's arc by Newton's method from that of a root."""
    for _ in range(NEWTON_STEPS):
        _, force, slope, _ = kinetic(y, series)
        step = force / slope
        if not abs(step) < 0.1 * abs(y) + 1e-3:
            break
        y -= step
        if abs(step) <= LAST_STEP * abs(y):
            break
    return y


def points_along(series: Sequence[float], turn: float, drift: float, at_throat: bool, cuts: np.ndarray,
                 roots: np.ndarray, arcs: np.ndarray, points: np.ndarray):
    """Fill points with the equilibria along an orbit in ascending order; how many there are, -1 where rounding
    has lost or invented one.

    turn: after so much of the arc an orbit comes to the same location again, where K has changed by `drift` a
    radian; on a circle the equilibria of the turn on either side of the base are there too.
    """
    if at_throat:
        total = equilibria_from_throat(series, cuts, roots, arcs)
    else:
        total = equilibria(series, cuts, roots, arcs)
    count = 0
    for n in range(total):
        y = settled_arc(arcs[n], series)
        height, force, slope, terms = kinetic(y, series)
        error = ROUNDINGS * ULP * terms + force * force / abs(slope)
        count = inserted(points, count, y, height, error, slope)
        if turn < INFINITY:
            away = -turn if y > 0 else turn
            count = inserted(points, count, y + away, height + drift * away,
                             error + ROUNDINGS * ULP * abs(drift * away), slope)
    # wells and barriers take turns, and the last ones before a wall are wells
    for n in range(count):
        if (n and (points[n, SLOPE] > 0) == (points[n - 1, SLOPE] > 0)) or not points[n, ERROR] < INFINITY:
            return -1
    if turn == INFINITY and (count == 0 or points[0, SLOPE] > 0 or points[count - 1, SLOPE] > 0):
        return -1
    return count


def inserted(points: np.ndarray, count: int, y: float, height: float, error: float, slope: float):
    """One more than so many points, which stay in ascending order."""
    n = count
    while n > 0 and points[n - 1, ARC] > y:
        for column in range(4):
            points[n, column] = points[n - 1, column]
        n -= 1
    points[n, ARC], points[n, HEIGHT], points[n, ERROR], points[n, SLOPE] = y, height, error, slope
    return count + 1
