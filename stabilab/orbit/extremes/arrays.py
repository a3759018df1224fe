"""Extremes of each component and the period, by roots on the reduced potential: no sampling, no running.

omega_i is extreme where the potential is lowest inside the allowed interval; omega_j and omega_k at the turning points
and where their own derivative along the orbit vanishes inside it.
"""
from __future__ import annotations

import numpy as np

from ...numbers.roots import bracketed_newton
from ..ball_orbit import Orbit
from ..fine.motion import fine_boxes
from ..fine.rows_kernel import BOX
from ..fine.rows_numba import one_by_one
from ..landscape import Landscape
from ..result import Fate
from .balls import precise_extremes
from .guards import DIGITS, EXTREMES_SHARE, SPIN_UP_SHARE, clear_of_barriers, into, near_separatrix, needs_digits, on_top, picked, trapped_rows
from .turning_points import interval, spots_along, turning_point


def extremes_of_chunk(land: Landscape, states, decided, start, span=None, twofold=True):
    """span: the intervals of all `trapped_rows`, where they are known already; twofold: whether to try rows in twofold numbers before balls."""
    out = np.repeat(states[:, :, None], 2, axis=2)
    place, w, size = start
    share = np.where(decided.labels == Fate.SPIN_UP, SPIN_UP_SHARE, EXTREMES_SHARE)
    precise = needs_digits(land, states) | land.beside_centre(place) | near_separatrix(land, place, w, decided, share)
    precise |= (decided.labels == Fate.SEPARATRIX) | on_top(land, place)
    precise &= decided.labels != Fate.EQUILIBRIUM
    labels = np.where(precise, -1, decided.labels)
    rows = trapped_rows(land, decided)
    trapped, rotating = rows & (labels == Fate.BOUNDED), ~rows & (labels == Fate.BOUNDED)
    into(out, rotating, _rotating(land, *picked(place, w, rotating)))
    span = None if span is None else span.take(trapped[rows])
    values, found = _trapped(land, *picked(place, w, trapped), span)  # type: ignore[call-arg]
    into(out, trapped, values)
    precise[np.nonzero(trapped)[0][~found]] = True
    spinning = labels == Fate.SPIN_UP
    into(out, spinning, _spinning(land, *picked(place, w, spinning)))
    if precise.any():
        fine = np.nonzero(precise & rows)[0] if twofold and land.conic is not None else np.zeros(0, int)
        if fine.size:
            values, found = fine_boxes(land, states[fine])
            out[fine[found]], precise[fine[found]] = values[found], False
            rest = fine[~found]
            values, found = one_by_one(land, states[rest], BOX)
            out[rest[found]], precise[rest[found]] = values[found], False
        for index in np.nonzero(precise)[0]:
            out[index] = precise_extremes(Orbit(land.reduction, states[index]), int(decided.labels[index]))
    out[:, :, 0] = np.minimum(out[:, :, 0], states)  # rounding must not exclude the state itself
    out[:, :, 1] = np.maximum(out[:, :, 1], states)
    return out


def _components(land, low, high, w_low, w_high):
    """(n, 3, 2) from canonical ranges, whatever signs the change of variables has."""
    a, b = land.components(low, w_low), land.components(high, w_high)
    return np.stack([np.minimum(a, b), np.maximum(a, b)], axis=2)


def _trapped(land, place, w, span=None):
    """Extremes of motions between two turning points, and where both were found."""
    if not len(w):
        return np.empty((0, 3, 2)), np.empty(0, bool)
    span = interval(land, place, w) if span is None else span
    top = np.sqrt(2 * span.fastest)
    low, high = _place_range(land, place, span.left, span.right, span.left_place, span.right_place)
    values = _components(land, low, high, -top, top)
    return values, span.ok & clear_of_barriers(land, place, w, span, EXTREMES_SHARE) & _sharp(land, span, values)


def _sharp(land, span, values):
    """(n,) True where rounding leaves the extremes `DIGITS` against each component's size."""
    r, blur = land.reduction, span.blur
    ends = span.left_place, span.right_place
    with np.errstate(all="ignore"):
        size = np.abs(values).max(axis=2)
        good = span.haze <= DIGITS * 2 * span.fastest
        good &= (land.errors(ends, blur) <= DIGITS * size[:, (r.j, r.k)].T).all(axis=0)
    return good


def _place_range(land, place, left, right, left_place, right_place):
    """Canonical (X, Z) or (omega_j, omega_k) ranges over [left, right]: ends, and interior stationary points."""
    ends = np.array(land.xz(left_place)), np.array(land.xz(right_place))
    low, high = np.minimum(*ends), np.maximum(*ends)
    for row, value, inside in land.stationary(place, left, right):
        low[row] = np.where(inside, np.minimum(low[row], value), low[row])
        high[row] = np.where(inside, np.maximum(high[row], value), high[row])
    return land.place(*low), land.place(*high)


def _rotating(land, place, w):
    """Torque-free motions over all barriers of the circle: the whole circle, one sign of W."""
    if not len(w):
        return np.empty((0, 3, 2))
    spots = spots_along(land, place, w)
    energy = np.where(spots.there, spots.energy, np.nan)
    with np.errstate(all="ignore"):
        slow = np.sqrt(2 * np.nanmin(np.concatenate([energy, 0.5 * w[:, None] ** 2], axis=1), axis=1))
        fast = np.sqrt(2 * np.nanmax(np.concatenate([energy, 0.5 * w[:, None] ** 2], axis=1), axis=1))
    radius = np.hypot(*place)
    sign = np.sign(w)
    return _components(land, (-radius, -radius), (radius, radius), sign * slow, sign * fast)


def _spinning(land, place, w):
    """Extremes over the future of motions that spin up: W -> +inf in canonical variables."""
    n = len(w)
    if not n:
        return np.empty((0, 3, 2))
    return SPINNING[land.e](land, place, w)


def _spinning_round(land, place, w):
    """On a circle: all of it, from the slowest rate on."""
    slowest = _slowest_ahead(land, place, w)
    radius = np.hypot(*place)
    return _components(land, (-radius, -radius), (radius, radius), slowest, np.full(len(w), np.inf))


def _spinning_purely(land, place, w):
    """Along a parabola whose force does not change: both other rates stay."""
    sense, start = land.sense, land.components(place, w)
    return np.stack([np.where(np.arange(3) == land.reduction.axis, np.where(sense > 0, start, -np.inf), start),
                     np.where(np.arange(3) == land.reduction.axis, np.where(sense > 0, np.inf, start), start)], axis=2)


def _slowest_ahead(land, place, w):
    """The least W over the future: over the barriers ahead, or on the way to the turning point behind if W < 0."""
    spots = spots_along(land, place, w)
    ahead = np.where(spots.there & (spots.offset > 0), spots.energy, np.inf)
    with np.errstate(all="ignore"):
        slowest = np.minimum(w, np.sqrt(2 * np.maximum(ahead.min(axis=1, initial=np.inf), 0)))
    back = w < 0
    if back.any():
        place, w = picked(place, w, back)
        # the wells between the turning point on the left and the state
        behind_energy = _fastest_behind(land, place, w)
        slowest[back] = -np.sqrt(2 * behind_energy)
    return slowest


def _fastest_behind(land, place, w):
    """Largest W^2/2 between the turning point behind and the state, for W < 0 on a tilted circle.

    Wells further back than one turn are higher by 2 pi mu, so the first turn behind decides.
    """
    best, blocked = 0.5 * w * w, np.zeros(len(w), bool)
    spots = spots_along(land, place, w)
    for column in range(spots.offset.shape[1] - 1, -1, -1):
        here = spots.there[:, column] & (spots.offset[:, column] < 0)
        blocked |= here & spots.barrier[:, column] & (spots.energy[:, column] < 0)
        well = here & ~blocked & ~spots.barrier[:, column]
        best = np.where(well, np.maximum(best, spots.energy[:, column]), best)
    return best


def _spinning_on_plane(land, place, w):
    """On the decaying plane xi = 0: eta shrinks to 0 after at most one excursion back to the turning point."""
    n = len(w)
    xi, eta = place
    low_w, far = np.array(w), np.array(eta)
    spots = spots_along(land, place, w)
    with np.errstate(all="ignore"):
        ahead = np.where(spots.there & (spots.offset > 0), spots.energy, np.inf).min(axis=1, initial=np.inf)
        low_w = np.where(w >= 0, np.minimum(w, np.sqrt(2 * np.maximum(ahead, 0))), w)
    back = (w < 0) & (eta != 0)
    if back.any():
        one, speed = picked(place, w, back)
        offset, fastest = _turn_back(land, one, speed)
        low_w[back], far[back] = -np.sqrt(2 * fastest), eta[back] * np.exp(-offset)
    zero = np.zeros(n)
    return _components(land, (zero, np.minimum(far, 0)), (zero, np.maximum(far, 0)), low_w, np.full(n, np.inf))


def _turn_back(land, place, w):
    """(offset of the turning point behind, largest W^2/2 on the way) for W < 0 on the decaying plane."""
    spots = spots_along(land, place, w)
    offset, _, found, *_ = turning_point(land, spots, place, w, -1)
    bare = ~found  # no equilibrium on the plane: the potential falls all the way, so it is monotone behind the state
    if bare.any():
        level, force = 0.5 * w[bare] ** 2, land.potential.force(place)[bare]
        one = tuple(v[bare] for v in place)
        reach = np.ones(level.shape)
        while (short := land.potential.rise(-reach, one, force) < level).any():
            reach[short] *= 2

        def fun(t, level, force, *one):
            return (land.potential.rise(-t, one, force) - level,
                    land.potential.force(land.potential.move(one, -t)))
        offset[bare] = -bracketed_newton(fun, np.zeros(level.shape), reach, 0.5 * reach, (level, force, *one))
    passed = spots.there & (spots.offset < 0) & (spots.offset > offset[:, None])
    fastest = np.where(passed, spots.energy, -np.inf).max(axis=1, initial=-np.inf)
    return offset, np.maximum(fastest, 0.5 * w * w)


SPINNING = {-1: _spinning_round, 1: _spinning_on_plane, 0: _spinning_purely}
