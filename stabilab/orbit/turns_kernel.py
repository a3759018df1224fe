"""Extremes and periods of rows that go all round a circle, one row at a time, as straight lines of floats
that numba compiles: spin-ups under a torque, and without one rotations over all barriers.

Both components across the axis pass over the circle. K = E - V at the equilibria of one turn, by the formulas
of `arc_kernel`, has the least rate of a spin-up, and both of a rotation; the period of a rotation is the time
from one equilibrium to the next, once round. What 32 digits do not settle is left to balls. Every function is
plain Python too.
"""
from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..numbers.error_free import Pair, value
from . import arc_kernel, equilibria_kernel
from .arc_kernel import (
    ALONG_U,
    ALONG_V,
    BEND_U,
    BEND_V,
    INFINITY,
    OVER,
    SHIFT,
    STOP_COLUMNS,
    ULP,
    E,
    base_of,
    component,
    period_in_pieces,
    rounded,
    stationary,
    stop_at,
)
from .equilibria_kernel import ARC, ERROR, HEIGHT, POINTS, SLOPE, points_along, sharpened
from .rows_kernel import BOX, DIGITS, PERIOD, PERIOD_DIGITS

BELOW = arc_kernel, equilibria_kernel  # modules whose functions `turns` calls


def full_range(at: float, speed: float, bend: float, n: float, e: float):
    """(least, most, error) of a component at + speed S1 + bend S2 over a circle."""
    y, half = stationary(speed, bend, n, e, 0.0)
    one, terms, _ = component(at, speed, bend, e, y)
    other, other_terms, _ = component(at, speed, bend, e, y + half)
    return min(one, other), max(one, other), 4 * ULP * max(terms, other_terms)


def settled_height(point: np.ndarray, base: Sequence[Pair], fine: np.ndarray):
    """K at an equilibrium, with its digits."""
    if not point[ERROR] <= 0.1 * DIGITS * abs(point[HEIGHT]):
        sharpened(point, base, fine)
    return point[HEIGHT] if point[ERROR] <= DIGITS * abs(point[HEIGHT]) else np.nan


def slowest_ahead(energy: float, direction: float, base: Sequence[Pair], count: int, points: np.ndarray,
                  fine: np.ndarray):
    """The least K of a spin-up that goes in the torque's direction: here, or over a barrier ahead; NaN where
    that is unclear."""
    slowest = energy
    for n in range(count):
        point = points[n]
        if point[SLOPE] > 0 and point[ARC] * direction > 0 and not point[HEIGHT] - point[ERROR] > slowest:
            height = settled_height(point, base, fine)
            slowest = min(slowest, height) if height > 0 else np.nan
    return slowest


def fastest_behind(energy: float, direction: float, base: Sequence[Pair], count: int, points: np.ndarray,
                   fine: np.ndarray):
    """The largest K between the turning point behind a spin-up and its state; NaN where that is unclear.

    Wells further back than one turn are higher, so the first turn behind decides."""
    fastest = energy
    for k in range(count):
        point = points[count - 1 - k if direction > 0 else k]
        if not point[ARC] * direction < 0:
            continue
        height = settled_height(point, base, fine)
        if not abs(height) > 0:
            return np.nan
        if height < 0 and point[SLOPE] > 0:
            break
        fastest = max(fastest, height)
    return fastest


def rate_of(over: float, energy: float, w: float, sign: float):
    """omega_i + s of so much K; the state's own, to the last digit, where K is that of the state."""
    return w if over == energy else sign * np.sqrt(2 * over)


def spin_range(w: float, energy: float, direction: float, base: Sequence[Pair], count: int,
               points: np.ndarray, fine: np.ndarray):
    """(least, most) of omega_i + s over the future; NaN where one is unclear."""
    if direction != 0:
        if w * direction < 0:
            over, sign = fastest_behind(energy, direction, base, count, points, fine), -direction
        else:
            over, sign = slowest_ahead(energy, direction, base, count, points, fine), direction
        slowest = rate_of(over, energy, w, sign)
        return (slowest, INFINITY) if direction > 0 else (-INFINITY, slowest)
    slow, fast = energy, energy
    for n in range(count):
        height = settled_height(points[n], base, fine)
        slow, fast = min(slow, height) if height > 0 else np.nan, max(fast, height)
    sign = np.copysign(1.0, w)
    one, other = rate_of(slow, energy, w, sign), rate_of(fast, energy, w, sign)
    return min(one, other), max(one, other)


def turned_box(state: np.ndarray, axes: Sequence[int], base: Sequence[Pair], n: float, low: float,
               high: float, fine: np.ndarray, box: np.ndarray):
    """Fill a box (3, 2) of a motion round a circle with omega_i + s between low and high; whether it has its
    digits."""
    j, k, i = axes
    e, shift = fine[E, 0], fine[SHIFT, 0]
    own, error = state[i] + shift, 0.0
    low_u, high_u, error_u = full_range(state[j], value(base[ALONG_U]), value(base[BEND_U]), n, e)
    low_v, high_v, error_v = full_range(state[k], value(base[ALONG_V]), value(base[BEND_V]), n, e)
    box[j, 0], box[j, 1] = min(low_u, state[j]), max(high_u, state[j])
    box[k, 0], box[k, 1] = min(low_v, state[k]), max(high_v, state[k])
    for end in range(2):
        rate = high if end else low
        box[i, end] = state[i] if rate == own else rate - shift
        if rate != own and abs(rate) < INFINITY:  # where a shift cancels, the state's own alone keeps digits
            error = max(error, 4 * ULP * (abs(rate) + abs(shift)))
    box[i, 0], box[i, 1] = min(box[i, 0], state[i]), max(box[i, 1], state[i])
    return (error_u <= DIGITS * max(abs(box[j, 0]), abs(box[j, 1]))
            and error_v <= DIGITS * max(abs(box[k, 0]), abs(box[k, 1]))
            and error <= DIGITS * min(abs(box[i, 0]), abs(box[i, 1])))


def turns(states: np.ndarray, open_rows: np.ndarray, axes: Sequence[int], fine: np.ndarray, turn: float,
          drift: float, rules: Sequence[np.ndarray], boxes: np.ndarray, periods: np.ndarray,
          left_open: np.ndarray):
    """Fill boxes and periods, of rotations alone, of the open rows of states; arguments as of
    `rows_kernel.rows`."""
    _, nearby, weights, levels = rules
    cuts, roots, arcs, points = np.empty((2, 8)), np.empty(8), np.empty(POINTS), np.empty((POINTS, 4))
    stops = np.empty((POINTS, STOP_COLUMNS))
    e, direction = fine[E, 0], np.sign(drift)
    n = np.sqrt(abs(e))
    for row in open_rows:
        request, state = int(left_open[row]), states[row]
        base = base_of(state, axes, fine)
        energy = value(base[OVER])
        series = rounded(base, e)
        count = points_along(series, turn, drift, False, 0.0, cuts, roots, arcs, points)
        # without a torque no force at all, or one that vanishes somewhere
        uniform = direction == 0 and not (series[1] or series[2] or series[3] or series[4] or series[5])
        if count < 0 or (count == 0 and direction == 0 and not uniform):
            continue
        if request & BOX:
            w = state[axes[2]] + fine[SHIFT, 0]
            low, high = spin_range(w, energy, direction, base, count, points, fine)
            if low <= high and turned_box(state, axes, base, n, low, high, fine, boxes[row]):
                request -= BOX
        if request & PERIOD and uniform:
            periods[row] = turn / np.sqrt(2 * energy)
            request -= PERIOD
        elif request & PERIOD and direction == 0:
            total = count // 2 + 1  # from one equilibrium to the same a turn later
            for k in range(total):
                stop_at(stops[k], base, points[k, ARC], False, fine)
            period, error = period_in_pieces(stops, total, nearby, weights, levels, False)
            if error <= PERIOD_DIGITS:
                periods[row] = 0.5 * period
                request -= PERIOD
        left_open[row] = request
