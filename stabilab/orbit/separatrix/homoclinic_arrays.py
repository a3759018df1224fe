"""Homoclinic orbits of many saddles, NumPy.

Where the loops of many saddles end: `circle.loop_end` on arrays, a row a saddle.

The same equilibria, the same order of decisions, the same Newton's method in a bracket; rows that have
converged are left out.

Homoclinic loops: where the motion that leaves a saddle turns back, and the points of the loop in between.

Along a loop W = +-sqrt(2 (V_saddle - V(theta))), the difference formed without cancellation, so points lie on
the separatrix to rounding.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...numbers.constants import TURN
from ..potential import y_minus_sin
from .circle import ENDS, LEVEL, LOST, NONE, OWN, SHARED, SHARPEST, SPREAD, crossing, real_cubic
from .far_centre import replaced, residual_far
from .homoclinic import loop_end
from .seams import PINCH, pinched_shares

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


MANY = 48  # saddles, from which on arrays find the ends of loops on circles sooner than one by one


def polished(land, saddle, s):
    """Return the points of the conic after each was moved along its orbit to where the force vanishes. The
    fold itself stays where it is."""
    moved = land.polished(saddle)
    return tuple(np.where(s > 0, m, v) for m, v in zip(moved, saddle))


def loop_ends(land, saddle, side):
    """(offset of the far end of the loop (n,), centre place (2, n), found (n,), shared (n,)) for saddles (2,
    n), each on its side, or all on one; shared: it ends at a saddle there, for which this is the loop on the
    other side."""
    pot, n = land.potential, len(saddle[0])
    side = np.broadcast_to(np.asarray(side, float), n)
    if n >= MANY and land.turn < np.inf:  # orbits that close, on circles
        ends, centres, kind = ends_on_circles(pot, land.sense, saddle, side)
    else:
        ends, centres, kind = np.zeros(n), np.zeros(n), np.zeros(n, int)
        for row, (x, z, toward) in enumerate(zip(*(v.tolist() for v in (*saddle, side)))):
            found = loop_end(pot, land.sense, (x, z), toward)
            if found:
                ends[row], centres[row], kind[row] = found
    return side * ends, np.array(land.polished(pot.move(saddle,
                                                        side * centres))), kind != NONE, kind == SHARED


@dataclass(frozen=True)
class Loops:
    """First halves of loops, from the saddle to the far end, in k strips of n rows and m columns.

    saddle, centre: places (2, k, n); end: (k, n) offsets of the far ends; found: (k, n) whether there is a
    loop; shared: (k, n) whether the far end is a saddle too; offset, w: (k, n, m) offsets and W; points: (k,
    n, m, 3). saddle_state, centre_state: (k, n, 3) the same as states; ways: (k, n, 2) those of
    `far_centre.Orbits` where states and points are told from them, and not from places; else nan.
    """

    saddle: np.ndarray
    centre: np.ndarray
    end: np.ndarray
    found: np.ndarray
    shared: np.ndarray
    offset: np.ndarray
    w: np.ndarray
    points: np.ndarray
    saddle_state: np.ndarray
    centre_state: np.ndarray
    ways: np.ndarray

    @property
    def far(self) -> np.ndarray:
        """(k, n) True where `far_centre` told the loop."""
        return np.isfinite(self.ways[..., 0])

    def at_rows(self, rows) -> Loops:
        """The loops of some rows only."""
        return Loops(*(v[:, :, rows] if name in ("saddle", "centre") else v[:, rows] for name,
                       v in vars(self).items()))

    def of(self, strip) -> Loops:
        """The loops of one strip only."""
        return Loops(*(v[:, strip:strip + 1] if name in ("saddle", "centre") else v[strip:strip + 1] for name,
                       v in vars(self).items()))


def loops(land, strips, s, u) -> Loops:
    """The loops of strips (`seams.Part`, or pairs of branch and side) at parameters s (k, n) along them and u
    (k, m) round them.

    A loop shared with the saddle at its far end is found from the left one only; at s = 0, the fold, it is a
    point.
    """
    k, n = s.shape
    place = np.array([np.broadcast_arrays(*strip[0].place(row)) for strip, row in zip(strips, s)], float)
    saddle = np.array(polished(land, (place[:, 0].ravel(), place[:, 1].ravel()), s.ravel())).reshape(2, k, n)
    sides = np.array([strip[1] for strip in strips])
    end, centre, found, shared = loop_ends(land, tuple(saddle.reshape(2, -1)), np.repeat(sides, n))
    end, found, shared = end.reshape(k, n), found.reshape(k, n), shared.reshape(k, n)
    centre = centre.reshape(2, k, n)
    found &= ~(shared & (sides[:, None] > 0))
    fold = s == 0
    found |= fold
    end = np.where(fold | ~found, 0.0, end)
    centre = np.where(fold, saddle, centre)
    cut = [len(strip) > 2 and strip.seam != 0 for strip in strips]
    sharpest = np.where(cut, 1 / PINCH, SHARPEST)
    shares = _shares(land, saddle, end, shared, u[:, None, :], sharpest)
    for strip in (n for n, part in enumerate(strips) if cut[n] and part.over):
        shares[strip] = pinched_shares(land.potential, saddle[:, strip], end[strip], sides[strip], u[strip])
    offset = end[:, :, None] * shares
    spot = saddle[0][:, :, None], saddle[1][:, :, None]
    with np.errstate(all="ignore"):
        w = np.sqrt(2 * np.maximum(-land.potential.rise(offset, spot), 0))
    w[:, :, 0] = w[:, :, -1] = 0.0
    points = land.components(land.potential.move(spot, offset), sides[:, None, None] * w)
    states = (land.components(one, np.zeros((k, n))) for one in (saddle, centre))
    made = Loops(saddle, centre, end, found, shared, offset, w, points, *states, np.full((k, n, 2), np.nan))
    return replaced(land, strips, s, u, made, lambda sharp, at, rows: _by_turning(sharp, at, sharpest[rows]))


def _shares(land, saddle, end, shared, u, sharpest):
    """(k, n, m) shares of the way to the far end at which columns u (k, 1, m), 0 to 1, stand.

    At the far end, distance t away, W^2 = 2 F t + K t^2 + ...: F the force there, K its slope. That is a
    hyperbola with t = (F/K)(cosh q - 1), and equal steps of q turn the loop's direction evenly, however sharp
    the bend; columns then run along the bend from row to row. No bend tighter than the way over
    sharpest (k,) is followed. Where the far end is a saddle itself, columns crowd at both ends alike.
    """
    if shared.any():
        return np.broadcast_to(np.sin(0.5 * np.pi * u) ** 2, end.shape + u.shape[-1:])
    far = land.potential.move(saddle, end)
    with np.errstate(all="ignore"):
        sharp = np.abs(end) * land.potential.slope(far) / np.abs(land.potential.force(far))
    return _by_turning(sharp, u, sharpest[:, None])


def _by_turning(sharp, u, sharpest):
    """(..., m) shares at columns u, from K/F times the way to the far end, (...,)."""
    sharp = np.clip(np.nan_to_num(sharp), 1e-8, sharpest)
    half = 0.5 * np.log1p(sharp + np.sqrt(sharp * (sharp + 2)))[..., None]  # arccosh(1 + sharp)
    return 1 - (np.sinh(half * (1 - u)) / np.sinh(half)) ** 2


def residual(land, loops):
    """(k, n, m) energy of the rounded points above their saddle's, relative to the size of the energy's
    terms; their offsets from the saddle tell the turn that the angle of a rounded point belongs to. On a
    hyperbola the larger of xi, eta tells the place: next to an open plane the smaller one is all rounding.
    How far the other lies from the saddle's hyperbola, relative to the size of the point, is the residual
    where that is more.
    """
    place, w, size = land.start(loops.points)
    spot = tuple(v[:, :, None] for v in loops.saddle)
    pot = land.potential
    with np.errstate(all="ignore"):
        departure = np.abs(0.5 * w * w + pot.rise(land.way(spot, place, loops.offset), spot))
        shaken, beside = land.blurred(spot, place, size)
        scale = (0.5 * w * w + np.abs(pot.G) * (size[0] ** 2 + size[1] ** 2)
                 + pot.slopes * (size[0] + size[1]) + pot.mu + shaken)
        found = np.fmax(np.where(departure > 0, departure / scale, 0.0), beside)
    if loops.far.any():
        found[loops.far] = residual_far(land, loops)
    return found
