"""Where the loops of many saddles end: `circle.loop_end` on arrays, a row a saddle.

The same equilibria, the same order of decisions, the same Newton's method in a bracket; rows that have
converged are left out.
"""
from __future__ import annotations

import numpy as np

from ...numbers.constants import TURN
from ..potential import y_minus_sin
from .circle import ENDS, LEVEL, LOST, NONE, OWN, SHARED, SPREAD, crossing, real_cubic

TINY_STEP = 1e-9   # relative: convergence is quadratic, the next step would be its square
MOST_STEPS = 12    # of all rows together; of the few that are left each goes on by itself
FEW = 4            # rows that are sooner found one by one
SMALL = 0.7        # below, y - sin y is its series


def ends_on_circles(pot, sense, saddle, side):
    """(distances (n,) to the far ends of loops, distances to their deepest wells, NONE or ENDS or SHARED) of
    saddles (2, n) on sides (n,)."""
    x, z = saddle
    n, curved = len(x), pot.G * x * x + pot.c * x - pot.d * z
    low, high, deep, centre = np.zeros(n), np.full(n, TURN), np.full(n, np.inf), np.zeros(n)
    end, kind, decided = np.zeros(n), np.full(n, NONE), np.zeros(n, bool)
    others = _others(pot, x, z, side)
    known = np.isfinite(others)
    over, at = _risen(pot, x, z, curved, side * np.where(known, others, 0.0))
    barriers = known & (pot.slope(at) > 0)
    level = np.zeros(known.shape, bool)
    if sense == 0:
        size = x * x + z * z
        level = barriers & (np.abs(over) <= LEVEL * (np.abs(pot.G) * size + pot.slopes * np.sqrt(size)))
    stops = barriers & ((over >= 0) | level)
    for t, height, there, barrier, stop, same in zip(others, over, known, barriers, stops, level):
        there = there & ~decided
        if sense == 0:
            shared = there & same & (low > 0)
            end, kind = np.where(shared, t, end), np.where(shared, SHARED, kind)
        stop, well = there & stop, there & ~barrier
        high, low = np.where(stop, t, high), np.where(well, t, low)
        deeper = well & (height < deep)
        deep, centre = np.where(deeper, height, deep), np.where(deeper, t, centre)
        decided |= stop
    free = (kind == NONE) & (low > 0)
    if sense == 0:
        whole = free & (high == TURN)
        end, kind = np.where(whole, TURN, end), np.where(whole, SHARED, kind)
        free &= ~whole
    free &= _risen(pot, x, z, curved, side * high)[0] > 0  # towards the torque the next turn lies lower
    rows = np.flatnonzero(free)
    if len(rows):
        end[rows] = _crossings(pot, *(v[rows] for v in (x, z, curved, side, low, high)))
        kind[rows] = ENDS
    return end, np.where(kind == NONE, 0.0, centre), kind


def _risen(pot, x, z, curved, y):
    """(height y away from saddles over theirs, the place there): `Circle.rise` and `Circle.move` with one
    sine and one cosine."""
    half = 0.5 * y
    sine = np.sin(half)
    s, b = 2 * sine * np.cos(half), -2 * sine * sine
    dx = z * s + x * b
    small = np.abs(y) < SMALL
    lag = y - s
    if small.any():
        lag[small] = y_minus_sin(y[small])
    return -pot.mu * lag - b * curved - 0.5 * pot.G * (dx * dx), (x + dx, z + (z * b - x * s))


def _crossings(pot, x, z, curved, side, low, high):
    """Where the potential rises through the saddles' heights between wells at `low` and `high`; rows that
    take long are left to `crossing`."""
    rows, out = np.arange(len(low)), np.empty(len(low))
    t = np.minimum(1.5 * low, 0.5 * (low + high))
    for _ in range(MOST_STEPS):
        value, there = _risen(pot, x, z, curved, side * t)
        high, low = np.where(value > 0, t, high), np.where(value < 0, t, low)
        steep = -side * pot.force(there)
        with np.errstate(all="ignore"):
            new = np.where(steep > 0, t - value / steep, low)
        new = np.where(value == 0, t, new)
        done = np.abs(new - t) <= TINY_STEP * t
        t = np.where(done | ((low < new) & (new < high)), new, 0.5 * (low + high))
        if done.any():
            out[rows[done]] = t[done]
            left = ~done
            rows, x, z, curved, side, low, high, t = (v[left]
                                                      for v in (rows, x, z, curved, side, low, high, t))
        if len(rows) < FEW:
            break
    g = float(pot.G), float(pot.c), float(pot.d), float(pot.mu)
    for row, *one in zip(rows.tolist(), *(v.tolist() for v in (x, z, side, low, high))):
        out[row] = crossing(g, *one)
    return out


def _others(pot, x, z, side):
    """(3, n) distances to the other equilibria within one turn on one side, ascending, inf where there is
    none (`circle.others`)."""
    along, across = pot.G * (z - x) * (z + x), pot.d * z - pot.c * x
    a0, a3 = along + across, -(pot.c * z + pot.d * x)
    a1, a2 = a3 - 4 * pot.G * x * z, across - along
    tangent = np.abs(a0) <= np.abs(a3)  # else the cubic is that of the cotangent
    roots = real_cubics(*np.where(tangent, (a3, a2, a1, a0), (a0, a1, a2, a3)))
    with np.errstate(all="ignore"):
        y = side * 2 * np.where(tangent, np.arctan(roots), np.arctan2(1.0, roots))
        y = np.where(y < 0, y + TURN, y)
        return np.sort(np.where(y > OWN, y, np.inf), axis=0)


def real_cubics(a, b, c, d):
    """(3, n) real roots of a t^3 + b t^2 + c t + d, nan in place of those that are not (`circle.real_cubic`).
    """
    with np.errstate(all="ignore"):
        p, q, r = b / a, c / a, d / a
        third = p / 3
        square, half = third * third - q / 3, third * (third * third - 0.5 * q) + 0.5 * r
        rest = half * half - square * square * square
        size = np.sqrt(square)
        angle = np.arccos(np.clip(half / (size * size * size), -1, 1)) / 3
        roots = -2 * size * np.cos(angle + np.array([0.0, TURN / 3, -TURN / 3])[:, None]) - third
        single = -np.copysign((np.abs(half) + np.sqrt(rest)) ** (1 / 3), half)
        one = rest >= 0
        roots[0] = np.where(one, single + np.where(single != 0, square / single, 0.0) - third, roots[0])
        roots[1:, one] = np.nan
        step = (((roots + p) * roots + q) * roots + r) / ((3 * roots + 2 * p) * roots + q)
        roots = np.where(np.abs(step) < 1e-4 * np.abs(roots), roots - step, roots)
        least, most = np.fmin.reduce(np.abs(roots)), np.fmax.reduce(np.abs(roots))
        # few
        for row in np.flatnonzero((a != 0)
                                  & ((least < SPREAD * most) | one & (rest <= LOST * half * half))).tolist():
            roots[:, row] = real_cubic(*(float(v[row]) for v in (a, b, c, d)))
        flat = a == 0
        if flat.any():
            roots[:, flat] = _real_quadratics(b[flat], c[flat], d[flat])
    return roots


def _real_quadratics(b, c, d):
    """The same where the cube is missing."""
    far = -0.5 * (c + np.copysign(np.sqrt(c * c - 4 * b * d), c))
    straight, none = b == 0, np.full(len(b), np.nan)
    return np.array([np.where(straight, np.where(c != 0, -d / c, np.nan), np.where(far != 0, far / b, 0.0)),
                     np.where(straight | (far == 0), np.nan, d / far), none])
