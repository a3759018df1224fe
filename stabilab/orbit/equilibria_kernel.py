"""Equilibria along an orbit of any kind, one motion at a time, and margins against its barriers, as straight
lines of floats that numba compiles.

In T = tanh(n y/2)/n (tan on circles, y/2 on parabolas) S1 = 2 T/(1 - e T^2), S2 = 2 T^2/(1 - e T^2), and the
force K' of `arc_kernel` times (1 - e T^2)^2 is one quartic on all of them,

    f0 + 2 f1 T + (2 (F + 3 c) - 2 e f0) T^2 + (4 g - 2 e f1) T^3 + e (e f0 - 2 F + 2 c) T^4.           (4)

Its real roots by Rolle's theorem: those of its second derivative cut the line for the first, these for the
quartic. Two charts, T/R and R/T with R the mean size of the roots, have all between -1 and 1. A pair of
equilibria that rounding loses differs in height by rounding. A margin is K at a barrier, in twofold numbers
where doubles give it too few digits: a small motion keeps its digits though the orbit is any number of times
as large. What that does not settle, next to a fold, a barrier or an invariant plane, is marked and left to
balls. Every function is plain Python too.
"""
from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..numbers.error_free import Pair, value
from . import arc_kernel
from .arc_kernel import (
    ALONG_U,
    BEND_U,
    F0,
    INFINITY,
    OVER,
    ROUNDINGS,
    ULP,
    E,
    base_of,
    kinetic,
    moved,
    rounded,
    twofold_error,
)

BELOW = (arc_kernel,)  # modules whose functions `margins` calls

# columns of a point of equilibrium: its arc from the base, K there and the error of that, dF/d alpha
ARC, HEIGHT, ERROR, SLOPE = range(4)
POINTS = 16  # room for so many: four roots, on a circle a turn earlier or later too
BISECTIONS = 80
# relative: a last step of Newton's method whose square is next to nothing; a bracket that is one
STEP, BRACKET = 1e-6, 1e-14
NEWTON_STEPS = 3  # from a root to its equilibrium
LAST_STEP = 1e-7  # of an arc: K at an equilibrium is second order in it
CLEAR = 64.0  # times its error, so far a height is from the energy where the barrier's side is certain
LONG_ARC = 16.0  # of n y: farther from the throat of a hyperbola twofold numbers lose exp(2 n y)
BESIDE = 1.37  # no root of a sphere's quartic, nor of one with a single term less, stands at that times R
DOUBT = 1e-10  # of its terms: where the force comes so near to zero, exact numbers say how often it vanishes
MARGIN_SHARE = 5e-13  # of kinetic energy and barrier: half of the rounding that `fate` admits
BESIDE_BARRIER = 1e-9  # of a radian: nearer to one, exact numbers say on which side of it a state is


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


def roots_between(q: Sequence[float], doubts: Sequence[float], cuts: np.ndarray, count: int,
                  roots: np.ndarray):
    """Fill roots with those of a quartic between neighbours of so many cuts, at whose inner ones it is
    stationary; how many there are, -1 where it nearly vanishes at a cut, by what each coefficient is in doubt
    of."""
    total, last, careful = 0, quartic(q, cuts[0])[0], max(doubts) > 0
    if careful and abs(last) < quartic(doubts, abs(cuts[0]))[0]:
        return -1
    for n in range(1, count):
        now = quartic(q, cuts[n])[0]
        if careful and abs(now) < quartic(doubts, abs(cuts[n]))[0]:
            return -1
        if (last < 0 < now) or (now < 0 < last):
            roots[total] = root_between(q, cuts[n - 1], cuts[n], last)
            total += 1
        elif now == 0 and n < count - 1:
            roots[total] = cuts[n]
            total += 1
        last = now
    return total


def real_roots(q: Sequence[float], doubts: Sequence[float], low: float, high: float, cuts: np.ndarray,
               roots: np.ndarray):
    """Fill roots with those of a quartic between low and high, ascending; how many there are, -1 in doubt.
    cuts: room (2, 8)."""
    first, second = cuts[0], cuts[1]
    first[0], count = low, 1
    c, d, e = q[2], q[3], q[4]
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
    count = roots_between(derivative(q), derivative(doubts), first, count + 1, second[1:])
    if count < 0:
        return -1
    second[0], second[count + 1] = low, high
    return roots_between(q, doubts, second, count + 2, roots)


def derivative(q: Sequence[float]):
    return q[1], 2 * q[2], 3 * q[3], 4 * q[4], 0.0 * q[0]


def stretched(q: Sequence[float], R: float):
    """The coefficients in x/R of a quartic in x."""
    return q[0], q[1] * R, q[2] * R * R, q[3] * R * R * R, q[4] * R * R * R * R


def turned(q: Sequence[float], times: int):
    """The coefficients in 1/x of a quartic in x, over so many powers of it."""
    q = q[4], q[3], q[2], q[1], q[0]
    for _ in range(times):
        q = q[1], q[2], q[3], q[4], 0.0 * q[0]
    return q


# --- Arcs to the equilibria
def arc_of(T: float, inverse: bool, n: float, e: float):
    """y of T, or of 1/T."""
    if e < 0:
        return 2 * (np.arctan2(n if T >= 0 else -n, abs(T)) if inverse else np.arctan(n * T)) / n
    if e > 0:
        return 2 * np.arctanh(n / T if inverse else n * T) / n
    return 2 / T if inverse else 2 * T


def force_quartic(series: Sequence[float], doubt: float):
    """The coefficients of (4), and so much of the size of their terms."""
    _, f0, f1, f2, c, g, e = series
    q = f0, 2 * f1, 2 * (f2 + 3 * c) - 2 * e * f0, 4 * g - 2 * e * f1, e * (e * f0 - 2 * f2 + 2 * c)
    f0, f1, f2 = doubt * abs(f0), doubt * abs(f1), doubt * abs(f2)
    c, g, e = doubt * abs(c), doubt * abs(g), abs(e)
    return q, (f0, 2 * f1, 2 * (f2 + 3 * c) + 2 * e * f0, 4 * g + 2 * e * f1, e * (e * f0 + 2 * f2 + 2 * c))


def equilibria(series: Sequence[float], doubt: float, cuts: np.ndarray, roots: np.ndarray, arcs: np.ndarray):
    """Fill arcs with those from a base to the equilibria of its orbit, once round, in no order; how many
    there are, -1 where rounding of so much of the terms of (4) may make or unmake one."""
    e, (q, doubts) = series[6], force_quartic(series, doubt)
    n = np.sqrt(abs(e))
    low, high = 0, 4
    while low < 4 and q[low] == 0:
        low += 1
    while high > 0 and q[high] == 0:
        high -= 1
    if low >= high or (q[4] == 0 and doubts[4] > 0):
        return -1 if doubt > 0 else 0
    R, edge = BESIDE * abs(q[low] / q[high]) ** (1.0 / (high - low)), INFINITY
    if e > 0:  # T is less than 1/n on a hyperbola
        edge = 1 / n
        R = min(R, edge)
    if not 0 < R < INFINITY:
        return -1 if doubt > 0 else 0
    q, doubts = stretched(q, R), stretched(doubts, R)
    total = real_roots(q, doubts, -1.0, 1.0, cuts, roots)
    for k in range(total):
        arcs[k] = arc_of(roots[k] * R, False, n, e)
    missing = 4 - high if n == 0 else 0  # a root at infinity is none on a parabola, half a turn on a circle
    q, doubts = turned(q, missing), turned(doubts, missing)
    for side in range((2 if edge < INFINITY else 1) if R < edge else 0):
        first, last = -1.0, 1.0
        if edge < INFINITY:
            first, last = (R / edge, 1.0) if side else (-1.0, -R / edge)
        count = real_roots(q, doubts, first, last, cuts, roots)
        if count < 0 or total < 0:
            return -1
        for k in range(count):
            arcs[total] = arc_of(roots[k] / R, True, n, e)
            total += 1
    return total


def equilibria_from_throat(series: Sequence[float], doubt: float, cuts: np.ndarray, roots: np.ndarray,
                           arcs: np.ndarray):
    """As `equilibria`, far from the throat of a hyperbola, where the base is: there T crowds at 1/n, and K'
    is a quartic in exp(n y) over exp(2 n y). Not for small n: its coefficients go with 1/e."""
    _, f0, f1, f2, c, g, e = series
    n = np.sqrt(e)
    even, odd = 0.5 * (f2 - c) / e, 0.5 * (f1 - g / e) / n
    end, tilt = 0.5 * c / e, 0.25 * g / (n * e)
    q = end - tilt, even - odd, f0 - f2 / e, even + odd, end + tilt
    size = doubt * (0.5 * (abs(f2) + abs(c)) / e + 0.5 * (abs(f1) + abs(g) / e) / n)
    doubts = (doubt * (abs(end) + abs(tilt)), size, doubt * (abs(f0) + abs(f2) / e), size,
              doubt * (abs(end) + abs(tilt)))
    if q[0] == 0 or q[4] == 0:
        return -1 if doubt > 0 else 0
    R, total = BESIDE * abs(q[0] / q[4]) ** 0.25, 0
    q, doubts = stretched(q, R), stretched(doubts, R)
    for side in range(2):
        count = real_roots(q, doubts, 0.0, 1.0, cuts, roots)
        if count < 0:
            return -1
        for k in range(count):
            arcs[total] = np.log(R / roots[k] if side else R * roots[k]) / n
            total += 1
        q, doubts = turned(q, 0), turned(doubts, 0)
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


def points_along(series: Sequence[float], turn: float, drift: float, at_throat: bool, doubt: float,
                 cuts: np.ndarray, roots: np.ndarray, arcs: np.ndarray, points: np.ndarray):
    """Fill points with the equilibria along an orbit in ascending order; how many there are, -1 where
    rounding has lost or invented one.

    doubt: of its terms, so near to zero a force may be so; 0 where a pair of equilibria that differ in height
    by rounding does not count. turn: after so much of the arc an orbit comes to the same location again,
    where K has changed by `drift` a radian; on a circle the equilibria of the turn on either side of the base
    are there too.
    """
    if at_throat:
        total = equilibria_from_throat(series, doubt, cuts, roots, arcs)
    else:
        total = equilibria(series, doubt, cuts, roots, arcs)
    count = 0 if total >= 0 else -1
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
    if turn == INFINITY and (count <= 0 or points[0, SLOPE] > 0 or points[count - 1, SLOPE] > 0):
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


def sharpened(point: np.ndarray, base: Sequence[Pair], fine: np.ndarray):
    """K at an equilibrium, and its error, in twofold numbers."""
    there = moved(base, point[ARC], fine)
    force = value(there[F0])
    point[HEIGHT] = value(there[OVER]) - 0.5 * force * force / point[SLOPE]
    point[ERROR] = twofold_error(point[ARC], base, fine) + ULP * abs(point[HEIGHT])


def to_throat(base: Sequence[Pair], n: float):
    """The arc of a base from the throat of its hyperbola; inf on an invariant plane."""
    along, across = n * base[ALONG_U][0], base[BEND_U][0]
    if abs(along) == abs(across):
        return INFINITY
    return np.arctanh(along / across if abs(along) < abs(across) else across / along) / n


# --- Margins
def rank(height: float, round_a_circle: bool):
    """The larger, the more a barrier with K of so much decides."""
    return -height if round_a_circle else -abs(height)


def nearest_margin(start: float, direction: float, turn: float, energy: float, base: Sequence[Pair],
                   count: int, points: np.ndarray, fine: np.ndarray):
    """(margin, whether it is certain) of a state at an arc from a base. On a circle: of the highest barrier
    within one turn ahead, -inf without one; else of the one that is nearest in height, inf without one."""
    round_a_circle, margin, best = turn < INFINITY, -INFINITY if turn < INFINITY else INFINITY, -INFINITY
    for n in range(count):
        point = points[n]
        ahead = (point[ARC] - start) * direction
        if point[SLOPE] > 0 and (not round_a_circle or BESIDE_BARRIER < ahead < turn - BESIDE_BARRIER):
            best = max(best, rank(point[HEIGHT], round_a_circle) - point[ERROR])
    for n in range(count):
        point = points[n]
        ahead = (point[ARC] - start) * direction
        if not point[SLOPE] > 0 or (round_a_circle and not -BESIDE_BARRIER < ahead < turn + BESIDE_BARRIER):
            continue
        if rank(point[HEIGHT], round_a_circle) + point[ERROR] < best:  # another decides, to whatever digits
            continue
        if min(abs(ahead), abs(ahead - turn)) <= BESIDE_BARRIER:
            return margin, False
        enough = MARGIN_SHARE * (energy + abs(energy - point[HEIGHT]))
        if not point[ERROR] <= min(0.01 * enough, abs(point[HEIGHT]) / CLEAR):
            sharpened(point, base, fine)
            if not point[ERROR] <= min(enough, abs(point[HEIGHT]) / CLEAR):
                return margin, False
        height = -point[HEIGHT]
        if height > margin if round_a_circle else abs(height) < abs(margin):
            margin = height
    return margin, True


def margins(states: np.ndarray, open_rows: np.ndarray, axes: Sequence[int], fine: np.ndarray, turn: float,
            drift: float, results: np.ndarray, settled: np.ndarray):
    """Fill results (n,) with the margins of the open rows of states (n, 3) that are certain, per unit of
    (omega_i + s)^2/2, and mark these in settled (n,).

    axes, fine, turn, drift: as of `rows_kernel.rows`.
    """
    cuts, roots, arcs, points = np.empty((2, 8)), np.empty(8), np.empty(POINTS), np.empty((POINTS, 4))
    e = fine[E, 0]
    n = np.sqrt(abs(e))
    direction = -1.0 if drift < 0 else 1.0
    for row in open_rows:
        base, start = base_of(states[row], axes, fine), 0.0 * n
        energy = value(base[OVER])
        for again in range(2 if e > 0 else 1):
            if again:
                start = to_throat(base, n)
                if not abs(n * start) <= LONG_ARC:
                    break
                base = moved(base, -start, fine)
            count = points_along(rounded(base, e), turn, drift, again > 0, DOUBT, cuts, roots, arcs, points)
            if count < 0:
                continue
            results[row], settled[row] = nearest_margin(start, direction, turn, energy, base, count, points,
                                                        fine)
            if settled[row]:
                break
