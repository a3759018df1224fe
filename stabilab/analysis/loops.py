"""Homoclinic loops: where the motion that leaves a saddle turns back, and the points of the loop in between.

Along a loop W = +-sqrt(2 (V_saddle - V(theta))), the difference formed without cancellation, so points lie on the
separatrix to rounding.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .landscape import EPS, TURN
from .rootfind import bracketed_newton
from .turning import spots_along

OWN = 1e-9        # offsets below this are the saddle itself
LEVEL = 64 * EPS  # saddles whose heights differ by less, relative to the terms of the energy, are at one height
SHARPEST = 1e3    # bends tighter than the loop's length over this are not resolved


def polished(land, saddle, s):
    """The conic's points moved along their orbits to where the force vanishes (all but the fold itself)."""
    moved = land._polish(saddle)
    return tuple(np.where(s > 0, m, v) for m, v in zip(moved, saddle))


def loop_end(land, saddle, side):
    """(offset of the far end of the loop (n,), centre place (2, n), found (n,), shared (n,)) for saddles (2, n), one side.

    The loop ends where the potential, beyond the wells on that side, is back at the saddle's height; shared: it ends at
    a saddle there, for which this is the loop on the other side.
    """
    n = len(saddle[0])
    if land.e < 0 and land.sense and side < 0:
        return (*_end_on_tilted_circle(land, saddle), np.zeros(n, bool))
    spots = spots_along(land, saddle, np.zeros(n))
    end, centre = np.zeros(n), np.array(saddle, float)
    outward = np.argsort(np.where(spots.there, spots.offset * side, np.inf), axis=1, kind="stable")
    take = lambda a: np.take_along_axis(a, outward, axis=1)
    offset, energy, barrier = take(spots.offset * side), take(spots.energy), take(spots.barrier)
    ahead = take(spots.there) & (offset > OWN)
    level = ahead & barrier & _at_one_height(land, saddle, offset, energy)
    stops = ahead & barrier & ((energy <= 0) | level | (np.abs(offset - TURN) < OWN))
    rows, width = np.arange(n), offset.shape[1]
    if width == 0:
        return end, centre, np.zeros(n, bool), np.zeros(n, bool)
    stopped = stops.any(axis=1)
    stop = np.where(stopped, np.argmax(stops, axis=1), width)
    wells = ahead & ~barrier & (np.arange(width) < stop[:, None])
    found = wells.any(axis=1)
    deepest = np.argmax(np.where(wells, energy, -np.inf), axis=1)
    low = offset[rows, width - 1 - np.argmax(wells[:, ::-1], axis=1)]
    high = offset[rows, np.minimum(stop, width - 1)]
    centre[:, found] = np.array([take(v) for v in spots.place])[:, rows, deepest][:, found]
    shared = found & stopped & level[rows, np.minimum(stop, width - 1)]
    if land.e < 0:
        right_round = found & (~stopped | (np.abs(high - TURN) < OWN))
        high = np.where(right_round, TURN, high)  # one turn back the saddle stands again, higher by 2 pi mu
        shared |= right_round & (land.sense == 0)
        end[shared] = side * high[shared]
    else:
        for row in np.nonzero(found & ~stopped)[0]:
            wall = _wall(land, tuple(np.array([v[row]]) for v in saddle), low[row], side)
            found[row], high[row] = wall is not None, wall or 0.0
    solve = found & (end == 0)

    def fun(t, *spot):
        return land.potential.rise(side * t, spot), -side * land.potential.force(land.potential.move(spot, side * t))
    end[solve] = side * _root(fun, low[solve], high[solve], tuple(v[solve] for v in saddle))
    return end, centre, found, shared


def _end_on_tilted_circle(land, saddle):
    """(offset of the far end, centre place, found) against the torque, where a loop ends within the turn: one turn back the
    saddle stands again, higher by 2 pi mu.

    Of the other equilibria on the circle there are three (well, barrier, well) or one: half their angle from the saddle
    has a tangent t with a cubic, for along the orbit F(y) = 2 sin(y/2) (a0 C^3 + a1 C^2 S + a2 C S^2 + a3 S^3) with
    C = cos(y/2), S = sin(y/2).
    """
    pot, (x, z) = land.potential, saddle
    along, across = pot.G * (z - x) * (z + x), pot.d * z - pot.c * x
    a0, a3 = along + across, -(pot.c * z + pot.d * x)
    back = TURN - _angles_of_cubic(a0, a3 - 4 * pot.G * x * z, across - along, a3)  # distances against the torque
    back = np.sort(np.where(back > 0, back, np.inf), axis=0)
    low, centre, high = back[0], back[0], np.full(len(x), TURN)
    three = np.nonzero(back[2] < np.inf)[0]
    if three.size:
        spot = x[three], z[three]
        first, barrier, last = (pot.rise(-t[three], spot) for t in back)
        low, high, centre = low.copy(), high.copy(), centre.copy()
        held = barrier >= 0  # the barrier on the way is as high as the saddle
        high[three[held]] = back[1, three[held]]
        low[three[~held]] = back[2, three[~held]]
        deeper = ~held & (last < first)
        centre[three[deeper]] = back[2, three[deeper]]
    found = (a0 > 0) & (low > OWN) & (low < high)
    ends = np.zeros(len(x))

    def fun(t, x, z):
        return pot.rise(-t, (x, z)), pot.force(pot.move((x, z), -t))
    if found.all():
        ends = -_root(fun, low, high, saddle)
    elif found.any():
        ends[found] = -_root(fun, low[found], high[found], tuple(v[found] for v in saddle))
    wells = np.array(land._polish(pot.move(saddle, np.where(found, -centre, 0.0))))
    return ends, np.where(found, wells, saddle), found


def _angles_of_cubic(a0, a1, a2, a3):
    """(3, n) angles in [0, 2 pi) twice those at which a0 C^3 + a1 C^2 S + a2 C S^2 + a3 S^3 vanishes (C cosine, S sine);
    nan where only one is real. In closed form, for the cotangent where the tangent may be infinite."""
    swap = np.abs(a0) > np.abs(a3)
    lead = np.where(swap, a0, a3)
    with np.errstate(all="ignore"):
        p, q, r = np.where(swap, a1, a2) / lead, np.where(swap, a2, a1) / lead, np.where(swap, a3, a0) / lead
        third = p / 3
        square, half = third * third - q / 3, third * (third * third - 0.5 * q) + 0.5 * r
        rest = half * half - square ** 3
        single = -np.copysign(np.cbrt(np.abs(half) + np.sqrt(np.maximum(rest, 0))), half)
        roots = np.full((3, len(lead)), np.nan)
        roots[0] = single + np.where(single == 0, 0, square / single) - third
        three = rest < 0
        if three.any():
            size, angle = np.sqrt(square[three]), half[three]
            turn = np.arccos(np.clip(angle / size ** 3, -1, 1)) / 3
            roots[:, three] = -2 * size * np.cos(turn + np.array([[0.0], [TURN / 3], [-TURN / 3]])) - third[three]
    angle = 2 * np.where(swap, np.arctan2(1.0, roots), np.arctan(roots))
    return np.where(angle < 0, angle + TURN, angle)


def _root(fun, low, high, args, steps=9):
    """Where fun rises through zero between a well at `low` and `high` (n,): plain Newton, the safe search for the rest.

    The first guess is exact for the cubic potential next to a fold, whose loop is half as long again as the way to
    the well.
    """
    t = np.minimum(1.5 * low, 0.5 * (low + high))
    with np.errstate(all="ignore"):
        for _ in range(steps):
            value, slope = fun(t, *args)
            step = value / slope
            t = t - step
            size = np.abs(step)
            if (size <= 1e-10 * t).all():
                break
    # a last step of 1e-10 leaves 1e-20 where convergence is quadratic
    rest = ~((size <= 1e-10 * t) & (t > low) & (t < high))
    if rest.any():
        t[rest] = bracketed_newton(fun, low[rest], high[rest], 0.5 * (low[rest] + high[rest]), tuple(v[rest] for v in args))
    return t


def _at_one_height(land, saddle, offset, energy):
    """(n, m) where a spot is as high as the saddle, as only the periodic potential of a circle without torque has it."""
    if land.e > 0 or land.sense:
        return np.zeros(offset.shape, bool)
    pot, Q = land.potential, land.invariant(saddle)[:, None]
    return np.abs(energy) <= LEVEL * (np.abs(pot.G) * Q + (np.abs(pot.c) + np.abs(pot.d)) * np.sqrt(Q))


def _wall(land, spot, low, side):
    """A distance at which the wall beyond the last well is higher than the saddle; None beside an open plane."""
    step = 1.0
    with np.errstate(all="ignore"):
        while step < 700:
            if land.potential.rise(np.array([side * (low + step)]), spot)[0] > 0:
                return low + step
            step *= 2
    return None


@dataclass(frozen=True)
class Loops:
    """First halves of loops, from the saddle to the far end, in k strips of n rows and m columns.

    saddle, centre: places (2, k, n); end: (k, n) offsets of the far ends; found: (k, n) whether there is a loop;
    shared: (k, n) whether the far end is a saddle too; offset, w: (k, n, m) offsets and W; points: (k, n, m, 3).
    """

    saddle: np.ndarray
    centre: np.ndarray
    end: np.ndarray
    found: np.ndarray
    shared: np.ndarray
    offset: np.ndarray
    w: np.ndarray
    points: np.ndarray

    def at_rows(self, rows) -> "Loops":
        """The loops of some rows only."""
        return Loops(*(v[:, :, rows] if name in ("saddle", "centre") else v[:, rows] for name, v in vars(self).items()))


def loops(land, strips, s, u) -> Loops:
    """The loops of strips, pairs (branch, side), at parameters s (k, n) along them and u (k, m) round them.

    A loop shared with the saddle at its far end is found from the left one only; at s = 0, the fold, it is a point.
    """
    k, n = s.shape
    place = np.array([np.broadcast_arrays(*branch.place(row)) for (branch, _), row in zip(strips, s)], float)
    saddle = np.array(polished(land, (place[:, 0].ravel(), place[:, 1].ravel()), s.ravel())).reshape(2, k, n)
    sides = np.array([side for _, side in strips])
    end, centre, found, shared = np.empty((k, n)), np.empty((2, k, n)), np.empty((k, n), bool), np.empty((k, n), bool)
    for side in set(sides.tolist()):  # one search for all strips of a side
        pick = sides == side
        one = loop_end(land, tuple(saddle[:, pick].reshape(2, -1)), side)
        end[pick], found[pick], shared[pick] = (v.reshape(-1, n) for v in (one[0], one[2], one[3]))
        centre[:, pick] = one[1].reshape(2, -1, n)
    found &= ~(shared & (sides[:, None] > 0))
    fold = s == 0
    found |= fold
    end = np.where(fold | ~found, 0.0, end)
    centre = np.where(fold, saddle, centre)
    offset = end[:, :, None] * _shares(land, saddle, end, shared, u[:, None, :])
    spot = saddle[0][:, :, None], saddle[1][:, :, None]
    with np.errstate(all="ignore"):
        w = np.sqrt(2 * np.maximum(-land.potential.rise(offset, spot), 0))
    w[:, :, 0] = w[:, :, -1] = 0.0
    points = land.components(land.potential.move(spot, offset), sides[:, None, None] * w)
    return Loops(saddle, centre, end, found, shared, offset, w, points)


def _shares(land, saddle, end, shared, u):
    """(k, n, m) shares of the way to the far end at which columns u (k, 1, m), 0 to 1, stand.

    At the far end, distance t away, W^2 = 2 F t + K t^2 + ...: F the force there, K its slope. That is a hyperbola with
    t = (F/K)(cosh q - 1), and equal steps of q turn the loop's direction evenly, however sharp the bend; columns then
    run along the bend from row to row. Where the far end is a saddle itself, columns crowd at both ends alike.
    """
    if shared.any():
        return np.broadcast_to(np.sin(0.5 * np.pi * u) ** 2, end.shape + u.shape[-1:])
    far = land.potential.move(saddle, end)
    with np.errstate(all="ignore"):
        sharp = np.abs(end) * land.potential.slope(far) / np.abs(land.potential.force(far))
        half = 0.5 * np.arccosh(1 + np.clip(np.nan_to_num(sharp), 1e-8, SHARPEST))[:, :, None]
    return 1 - (np.sinh(half * (1 - u)) / np.sinh(half)) ** 2


def residual(land, loops):
    """(k, n, m) energy of the rounded points above their saddle's, relative to the size of the energy's terms; their
    offsets from the saddle tell the turn that the angle of a rounded point belongs to."""
    place, w, size = land.start(loops.points)
    spot = tuple(v[:, :, None] for v in loops.saddle)
    pot = land.potential
    with np.errstate(all="ignore"):
        if land.e < 0:
            angle = np.arctan2(place[0] * spot[1] - place[1] * spot[0], place[0] * spot[0] + place[1] * spot[1])
            seen, slopes = angle + TURN * np.round((loops.offset - angle) / TURN), abs(pot.c) + abs(pot.d)
        else:
            big = np.abs(spot[0]) >= np.abs(spot[1])
            seen = np.where(big, np.log(np.abs(place[0] / spot[0])), -np.log(np.abs(place[1] / spot[1])))
            slopes = abs(pot.e1) + abs(pot.e2)
        departure = np.abs(0.5 * w * w + pot.rise(seen, spot))
        scale = 0.5 * w * w + np.abs(pot.G) * (size[0] ** 2 + size[1] ** 2) + slopes * (size[0] + size[1]) + pot.mu
        return np.where(departure > 0, departure / scale, 0.0)
