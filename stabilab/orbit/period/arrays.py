"""Periods of bounded motions: the integral of dtheta/W between two turning points.

With theta = middle - half cos(phi) the root singularities cancel: T = 2 int_0^pi dphi / sqrt(2 H), where
H = (E - V)/((theta - l)(r - theta)) is the second divided difference of V at (l, r, theta). It is formed from closed
expressions (products of sines), never by subtracting energies; `rules` sums over the nodes.
"""
from __future__ import annotations

import numpy as np

from ...numbers.constants import EPS, TURN
from ..ball_orbit import Orbit
from ..extremes.guards import clear_of_barriers, near_separatrix, needs_digits, picked, trapped_rows
from ..extremes.turning_points import interval
from ..fine.motion import fine_periods
from ..fine.rows_kernel import PERIOD
from ..fine.rows_numba import one_by_one
from ..landscape import Landscape
from ..result import Fate
from .balls import precise_period
from .modes import modes_of
from .rules import librations

PERIOD_SHARE = 1e-5  # closer to the separatrix than this share of the energy terms, rounding costs the period 1e-11
DIGITS = 1e-11  # rounding that leaves less than this goes to ball arithmetic


def period_chunk(land: Landscape, states, decided, start, span=None, twofold=True):
    """(n,) periods of states with known fates and `land.start`; span: the intervals of the motions between two turning
    points, where they are known already; twofold: whether to try rows in twofold numbers before balls."""
    out = np.full(len(states), np.inf)
    out[decided.labels == Fate.EQUILIBRIUM] = 0.0
    out[decided.labels == Fate.UNDECIDED] = np.nan
    place, w, _ = start
    bounded = decided.labels == Fate.BOUNDED
    precise = (needs_digits(land, states) | land.beside_centre(place) | near_separatrix(land, place, w, decided, PERIOD_SHARE)) & bounded
    rows = trapped_rows(land, decided)
    trapped, rotating = rows & ~precise, bounded & ~rows & ~precise
    out[rotating] = _rotation_period(land, *picked(place, w, rotating))
    spot, speed = picked(place, w, trapped)
    values, found = libration_period(land, spot, speed, None if span is None else span.take(trapped[rows]))
    out[trapped] = values
    precise[np.nonzero(trapped)[0][~found]] = True
    if precise.any():
        fine = np.nonzero(precise & rows)[0] if twofold and land.conic is not None else np.zeros(0, int)
        if fine.size:
            values, found = fine_periods(land, states[fine])
            out[fine[found]], precise[fine[found]] = values[found], False
            rest = fine[~found]
            values, found = one_by_one(land, states[rest], PERIOD)
            out[rest[found]], precise[rest[found]] = values[found], False
        for index in np.nonzero(precise)[0]:
            out[index] = precise_period(Orbit(land.reduction, states[index]), int(decided.labels[index]))
    return out


def libration_period(land: Landscape, place, w, span=None):
    """(periods (n,), found (n,)) of motions between two turning points; span: their intervals where known already."""
    if not len(w):
        return np.empty(0), np.empty(0, bool)
    span = interval(land, place, w) if span is None else span
    half = np.maximum(span.half, 1e-300)
    modes = modes_of(land, span.middle)
    values, shape, peaks = librations(modes, half)
    good = span.ok & clear_of_barriers(land, place, w, span, PERIOD_SHARE)
    good &= np.isfinite(values) & _sharp(modes, half, shape) & _well_placed(half, span.blur, shape)
    good[peaks.rows] &= _over_barriers(modes, half, span.blur, shape, peaks)
    return values, good


def _over_barriers(modes, rho, blur, shape, peaks):
    """(k,) True of rows with a peak where rounding of H there, of its terms and of the ends, costs the period less than `DIGITS`: on a long hyperbola H over a
    barrier may be far less than at both ends and in the middle, and the terms of the energy at the state tell nothing of those at the ends."""
    rows = peaks.rows
    one, half, left = modes.take(rows), rho[rows], peaks.share
    with np.errstate(all="ignore"):
        terms = np.maximum(one.terms(half, left, 1 - left), one.rounding(half, left, 1 - left))
        return (EPS * terms + blur[:, rows].sum(axis=0) * np.ptp(shape[:, rows], axis=0) / half) * peaks.weight <= DIGITS


def _well_placed(rho, blur, shape):
    """(n,) True where the rounding of both ends' offsets moves H, as far as it changes along the interval, by little."""
    with np.errstate(all="ignore"):
        return blur.sum(axis=0) * np.ptp(shape, axis=0) <= DIGITS * rho * shape.min(axis=0)


def _sharp(modes, rho, shape):
    """(n,) True where H keeps its digits: rounding is small against H at the ends and in the middle."""
    with np.errstate(all="ignore"):
        good = True
        for left, value in zip((0.0, 0.5, 1.0), shape):
            good &= (EPS * modes.terms(rho, left, 1 - left) <= DIGITS * value) & (EPS * modes.rounding(rho, left, 1 - left) <= DIGITS * value)
        return good


def _rotation_period(land, place, w):
    """Torque-free motions once round the circle: the integrand is periodic, the plain sum converges geometrically."""
    n = len(w)
    values, live, before = np.full(n, np.nan), np.arange(n), None
    if not n:
        return values
    nodes = 16
    force = land.potential.force(place)
    while nodes <= 1 << 17:
        now = np.zeros(len(live))
        one = tuple(v[live] for v in place)
        for angle in np.arange(nodes) * (TURN / nodes):
            with np.errstate(all="ignore"):
                rise = land.potential.rise(np.full(len(live), angle), one, force[live])
                now += 1 / np.sqrt(np.maximum(w[live] ** 2 - 2 * rise, 0))
        now *= TURN / nodes
        if before is not None:
            done = np.abs(now - before) <= 1e-14 * now
            values[live[done]] = now[done]
            live, now = live[~done], now[~done]
            if not len(live):
                break
        before, nodes = now, 2 * nodes
    values[live] = before if len(live) else values[live]
    return values
