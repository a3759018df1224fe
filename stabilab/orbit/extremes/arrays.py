"""Extremes and periods of rows that no two turning points hold: at rest, round a circle without torque,
spinning up; by NumPy.

What doubles would lose, next to a separatrix or far from the centre of the orbits, is left open for balls.
"""
from __future__ import annotations

import numpy as np

from ...numbers.constants import TURN
from ..landscape import Landscape, spots_along
from ..result import Fate

# closer to the separatrix than this share of the energy terms, rounding costs extremes 1e-12
EXTREMES_SHARE = 1e-7
# the same for the least rate of a motion that just passes a barrier: the root of a difference
SPIN_UP_SHARE = 1e-4
PERIOD_SHARE = 1e-5  # the same for a period, 1e-11
ON_TOP = 1e-13  # of the terms of the force, some hundreds of roundings
# canonical variables lose this factor of accuracy to the shift before the precise path takes over
SHIFT_LIMIT = 1e4
# relative, of the sums over so many nodes and twice as many: the error left is its square; rounding leaves
# some 1e-13
AGREE = 1e-12
MOST_NODES = 1 << 15  # more than the peaks of the integrand ask for at `PERIOD_SHARE`


def trapped_rows(land, decided):
    """(n,) True for motions between two turning points."""
    trapped = decided.labels == Fate.BOUNDED
    return trapped & (decided.margins >= 0) if land.may_rotate else trapped


def needs_digits(land: Landscape, states):
    """(n,) True where the canonical shift is so large that doubles would lose digits (nearly equal moments,
    or a wheel on the axis of symmetry of a body that hardly turns about it)."""
    r = land.reduction
    shift, along = r.parabolic_shift_size, abs(float(r.s))
    lost = np.zeros(len(states), bool)
    if shift:
        lost |= shift > SHIFT_LIMIT * np.maximum(np.abs(states).max(axis=1), 1e-300)
    return lost | (along > SHIFT_LIMIT * np.abs(states[:, r.axis])) if along else lost


def on_top(land: Landscape, place):
    """(n,) True where the state is at the place of a barrier to rounding: before it or behind, doubles do not
    tell."""
    pot = land.potential
    return (np.abs(pot.force(place)) <= ON_TOP * pot.terms(place)) & (pot.slope(place) > 0)


def near_separatrix(land, place, w, margins, share):
    """(n,) True where the margin is below `share` of the energy's terms: turning points and periods magnify
    its rounding there."""
    return np.abs(margins) <= share * land.reduction.energy_unit * land.energy_terms(place, w)


def open_extremes(land: Landscape, states, labels, margins):
    """Extremes (n, 3, 2) of rows that are not `trapped_rows`; NaN where these are left to balls."""
    out = np.repeat(states[:, :, None], 2, axis=2)
    moving = np.nonzero((labels != Fate.EQUILIBRIUM) & (labels != Fate.UNDECIDED))[0]
    if not moving.size:
        return out
    states, labels, margins = states[moving], labels[moving], margins[moving]
    place, w, _ = land.start(states)
    share = np.where(labels == Fate.SPIN_UP, SPIN_UP_SHARE, EXTREMES_SHARE)
    doubtful = (needs_digits(land, states) | land.beside_centre(place)
                | near_separatrix(land, place, w, margins, share))
    doubtful |= on_top(land, place)
    values = np.full((len(states), 3, 2), np.nan)
    for label, extremes in ((Fate.BOUNDED, _rotating), (Fate.SPIN_UP, SPINNING[land.e])):
        rows = (labels == label) & ~doubtful
        if rows.any():
            values[rows] = extremes(land, tuple(v[rows] for v in place), w[rows])
    out[moving] = values
    return out


def rotation_periods(land: Landscape, states, margins):
    """Periods (n,) of motions without torque over all barriers of a circle; NaN where these are left to
    balls."""
    place, w, _ = land.start(states)
    values = np.full(len(states), np.nan)
    doubtful = needs_digits(land, states) | near_separatrix(land, place, w, margins, PERIOD_SHARE)
    live, before, nodes = np.nonzero(~doubtful)[0], np.full(np.count_nonzero(~doubtful), np.nan), 16
    force = land.potential.force(place)
    # the integrand is periodic: the plain sum converges geometrically
    while live.size and nodes <= MOST_NODES:
        now, one = np.zeros(len(live)), tuple(v[live] for v in place)
        for angle in np.arange(nodes) * (TURN / nodes):
            with np.errstate(all="ignore"):
                rise = land.potential.rise(np.full(len(live), angle), one, force[live])
                now += 1 / np.sqrt(np.maximum(w[live] ** 2 - 2 * rise, 0))
        now *= TURN / nodes
        done = np.abs(now - before) <= AGREE * now
        values[live[done]] = now[done]
        live, before, nodes = live[~done], now[~done], 2 * nodes
    return values


def _components(land, low, high, w_low, w_high):
    """(n, 3, 2) from canonical ranges, whatever signs the change of variables has."""
    a, b = land.components(low, w_low), land.components(high, w_high)
    return np.stack([np.minimum(a, b), np.maximum(a, b)], axis=2)


def _rotating(land, place, w):
    """Torque-free motions over all barriers of the circle: the whole circle, one sign of W."""
    spots = spots_along(land, place, w)
    energy = np.where(spots.there, spots.energy, np.nan)
    with np.errstate(all="ignore"):
        energies = np.concatenate([energy, 0.5 * w[:, None] ** 2], axis=1)
        slow, fast = np.sqrt(2 * np.nanmin(energies, axis=1)), np.sqrt(2 * np.nanmax(energies, axis=1))
    radius = np.hypot(*place)
    sign = np.sign(w)
    return _components(land, (-radius, -radius), (radius, radius), sign * slow, sign * fast)


def _spinning_round(land, place, w):
    """Over the future of a spin-up, W -> +inf, on a circle: all of it, from the slowest rate on."""
    radius = np.hypot(*place)
    return _components(land, (-radius, -radius), (radius, radius), _slowest_ahead(land, place, w),
                       np.full(len(w), np.inf))


def _slowest_ahead(land, place, w):
    """The least W over the future: over the barriers ahead, or on the way to the turning point behind if W <
    0."""
    spots = spots_along(land, place, w)
    slowest = _over_barriers_ahead(spots, w)
    back = w < 0
    if back.any():
        # the wells between the turning point on the left and the state
        fastest = _fastest_behind(land, tuple(v[back] for v in place), w[back])
        slowest[back] = -np.sqrt(2 * fastest)
    return slowest


def _over_barriers_ahead(spots, w):
    ahead = np.where(spots.there & (spots.offset > 0), spots.energy, np.inf)
    with np.errstate(all="ignore"):
        return np.minimum(w, np.sqrt(2 * np.maximum(ahead.min(axis=1, initial=np.inf), 0)))


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
    """On the decaying plane xi = 0: eta shrinks to 0. Balls tell the excursion back to a turning point
    behind."""
    eta, zero = place[1], np.zeros(len(w))
    slowest = _over_barriers_ahead(spots_along(land, place, w), w)
    slowest[(w < 0) & (eta != 0)] = np.nan
    return _components(land, (zero, np.minimum(eta, 0)), (zero, np.maximum(eta, 0)), slowest,
                       np.full(len(w), np.inf))


def _spinning_purely(land, place, w):
    """Along a parabola whose force does not change: both other rates stay."""
    sense, start = land.sense, land.components(place, w)
    spun = np.arange(3) == land.reduction.axis
    low, high = (-np.inf, start) if sense < 0 else (start, np.inf)
    return np.stack([np.where(spun, low, start), np.where(spun, high, start)], axis=2)


SPINNING = {-1: _spinning_round, 1: _spinning_on_plane, 0: _spinning_purely}
