"""Periods of bounded motions: the integral of dtheta/W between two turning points.

With theta = middle - half cos(phi) the root singularities cancel: T = 2 int_0^pi dphi / sqrt(2 H), where
H = (E - V)/((theta - l)(r - theta)) is the second divided difference of V at (l, r, theta). It is formed from closed
expressions (products of sines), never by subtracting energies. The midpoint rule then converges geometrically; close to
a separatrix the integrand peaks at an end, and the double-exponential rule takes over.
"""
from __future__ import annotations

import numpy as np

from ...numbers.constants import EPS, TURN
from ..ball_orbit import Orbit
from ..extremes.circle_kernel import ENOUGH, NARROW, NODES, divided_pair
from ..extremes.guards import clear_of_barriers, near_separatrix, needs_digits, picked, trapped_rows
from ..extremes.turning_points import interval
from ..landscape import Landscape
from ..result import Fate
from .balls import precise_period
from .modes import modes_of

PERIOD_SHARE = 1e-5  # closer to the separatrix than this share of the energy terms, rounding costs the period 1e-11
DIGITS = 1e-11  # rounding that leaves less than this goes to ball arithmetic
TOLERANCE = 4e-15  # two successive rules agree to this: some twenty roundings
PAIR_CHUNK = 2048  # a dozen arrays of so many doubles stay in the processor's second cache
MIDPOINT_NODES = (16, 32, 64, 128, 256)


def period_chunk(land: Landscape, states, decided, start, span=None):
    """(n,) periods of states with known fates and `land.start`; span: the intervals of the motions between two turning
    points, where they are known already."""
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
    values = (_circle_periods if modes.mirrored else _midpoint)(modes, half)
    clear = span.ok & clear_of_barriers(land, place, w, span, PERIOD_SHARE)
    return values, clear & np.isfinite(values) & _sharp(modes, half) & _well_placed(modes, half, span.blur)


def _well_placed(modes, rho, blur):
    """(n,) True where the rounding of both ends' offsets moves H, as far as it changes along the interval, by little."""
    with np.errstate(all="ignore"):
        values = np.array([modes.second_difference(rho, left, 1 - left) for left in (0.0, 0.5, 1.0)])
        return blur.sum(axis=0) * np.ptp(values, axis=0) <= DIGITS * rho * values.min(axis=0)


def _sharp(modes, rho):
    """(n,) True where H keeps its digits: rounding is small against H at the ends, and moves the middle, where the
    curvature is taken, by little."""
    with np.errstate(all="ignore"):
        good = True
        for left, power in ((0.0, 1), (1.0, 1), (0.5, 2)):
            value, terms = modes.second_difference(rho, left, 1 - left), modes.terms(rho, left, 1 - left)
            good &= (EPS * terms**power <= DIGITS * value**power) & (EPS * modes.rounding(rho, left, 1 - left) <= DIGITS * value)
        return good


def _midpoint(modes, half):
    n = len(half)
    values, live = np.full(n, np.nan), np.arange(n)
    before = None
    for nodes in MIDPOINT_NODES:
        phi = (np.arange(nodes) + 0.5) * (np.pi / nodes)
        now = np.zeros(len(live))
        part, rho = modes.take(live), half[live]
        for angle in phi:
            now += inverse_speed(part, rho, np.sin(0.5 * angle) ** 2, np.cos(0.5 * angle) ** 2)
        now *= 2 * np.pi / nodes
        if before is not None:
            with np.errstate(invalid="ignore"):  # both infinite where a square overflowed: not settled here
                done = np.abs(now - before) <= TOLERANCE * now * max(1, nodes / 32)
            values[live[done]] = now[done]
            live, now = live[~done], now[~done]
            if not len(live):
                return values
        before = now
    values[live] = _double_exponential(modes.take(live), half[live])
    return values


def _circle_periods(modes, half):
    """`_midpoint` for circles: trapezoidal sums over mirrored pairs of nodes, which nest, doubled until the change says
    that the next change would be rounding; the double-exponential rule takes the rest."""
    values = np.empty(len(half))
    for start in range(0, len(half), PAIR_CHUNK):
        part = np.arange(start, min(start + PAIR_CHUNK, len(half)))
        for narrow in (False, True):
            rows = part[(half[part] < NARROW) == narrow]
            if len(rows):
                values[rows] = _pair_sums(modes, half, rows, narrow)
    return values


def _pair_sums(modes, half, rows, narrow):
    values, live = np.full(len(rows), np.nan), np.arange(len(rows))
    rho, (p1, q1, p2, q2) = half[rows], modes.data[:, rows]
    whole_s, whole_c, total, before = np.sin(rho), np.cos(rho), np.zeros(len(rows)), None
    first, size = 0, 8
    while first < len(NODES):
        last = first + size // 2 if first else 5
        for node in range(first, last):
            u = rho * NODES[node]
            fu = np.sin(u) / u if NODES[node] else np.ones_like(u)
            even, odd = divided_pair(u, fu, np.cos(u), rho, whole_s, whole_c, p1, q1, p2, q2, narrow)
            weight = 0.5 if node in (0, 4) else 1.0  # the ends of [0, pi], and its middle, which is its own mirror image
            with np.errstate(all="ignore"):
                total += weight * (1 / np.sqrt(2 * (even + odd)) + 1 / np.sqrt(2 * (even - odd)))
        size, first = size * 2 if first else size, last
        now = total * (TURN / size)
        if before is not None:
            with np.errstate(invalid="ignore"):  # both infinite where rounding leaves no depth to the well: not settled here
                done = np.abs(now - before) <= ENOUGH * now
            values[live[done]] = now[done]
            if done.all():
                return values
            rest = ~done
            live, now = live[rest], now[rest]
            rho, p1, q1, p2, q2, whole_s, whole_c, total = (
                a[rest] for a in (rho, p1, q1, p2, q2, whole_s, whole_c, total))
        before = now
    values[live] = _double_exponential(modes.take(rows[live]), half[rows[live]])
    return values


def inverse_speed(modes, rho, left, right):
    """1/sqrt(2 H) at theta = l + 2 rho left = r - 2 rho right (left + right = 1, each accurate near its end)."""
    with np.errstate(all="ignore"):
        return 1 / np.sqrt(2 * modes.second_difference(rho, left, right))


def _double_exponential(modes, rho):
    """The integral over phi in (0, pi) by the tanh-sinh rule, step halved until two levels agree."""
    total, before = np.zeros(len(rho)), None
    step = 0.5
    for level in range(9):
        k = np.arange(-int(6.2 / step), int(6.2 / step) + 1)
        if level:
            k = k[k % 2 != 0]
        for t in k * step:
            u = 0.5 * np.pi * np.sinh(t)
            # phi = pi/(1 + exp(-2u)), pi - phi = pi/(1 + exp(2u)), dphi = pi/2 * (pi/2 cosh t)/cosh(u)^2 dt
            if abs(u) > 300:
                continue
            near, far = np.pi / (1 + np.exp(2 * abs(u))), np.pi / (1 + np.exp(-2 * abs(u)))
            small, large = np.sin(0.5 * near) ** 2, np.sin(0.5 * far) ** 2
            left, right = (large, small) if u > 0 else (small, large)
            weight = 0.25 * np.pi * np.pi * np.cosh(t) / np.cosh(u) ** 2
            if weight < 1e-40:
                continue
            total += weight * inverse_speed(modes, rho, left, right)
        now = 2 * step * total
        with np.errstate(invalid="ignore"):
            settled = before is not None and level > 2 and (np.abs(now - before) <= 3e-14 * np.abs(now)).all()
        if settled:
            return now
        before, step = now, 0.5 * step
    return before


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
