"""Extremes and periods of bounded rows on orbits of any kind, one row at a time, as straight lines of floats
that numba compiles.

With the formulas of `arc_kernel` about the state: its equilibria, by these the ends of the motion, between a
well and a barrier that K = E - V falls to zero on the way to. Then the base moves to the middle of the
motion, ends are made sharp there, and the period comes from Taylor's series about it, or, next to a
separatrix, piece by piece from stop to stop. What 32 digits do not settle is marked and left to balls. Every
function is plain Python too.
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
    F0,
    F1,
    INFINITY,
    MAX_COEFFICIENTS,
    OVER,
    ROUNDINGS,
    SHIFT,
    STEP_CHANGE,
    STOP_COLUMNS,
    ULP,
    E,
    U,
    V,
    base_of,
    component,
    fill_stop,
    force_error,
    kinetic,
    moved,
    period_about,
    period_in_pieces,
    rounded,
    stationary,
    stop_at,
    twofold_error,
)
from .equilibria_kernel import (
    ARC,
    BESIDE,
    CLEAR,
    ERROR,
    HEIGHT,
    LONG_ARC,
    POINTS,
    SLOPE,
    points_along,
    sharpened,
    to_throat,
)

BELOW = arc_kernel, equilibria_kernel  # modules whose functions `rows` calls
BOX, PERIOD = 1, 2  # bits: wanted, and left open
BOUNDED, UNBOUNDED, UNCLEAR = 1, 2, 0
DIGITS, PERIOD_DIGITS = 1e-12, 1e-11  # promised, relative: rounding that leaves less leaves a row open
SHORT_ARC = 3.0  # of n y: up to it terms of K do not outgrow K
DOUBLINGS, LONGEST = 1100, 1e300  # of an arc towards a wall; without one so far there is none
STEPS = 100


# --- Ends of a motion
def crossing(inner: float, outer: float, series: Sequence[float]):
    """The arc between inner, where K is not negative, and outer, where it is, at which it vanishes; K falls
    from the one to the other. Newton's method in a bracket, from the parabola about the nearer height."""
    side = 1.0 if outer > inner else -1.0
    at, force, slope, _ = kinetic(inner, series)
    beyond, _, slope_beyond, _ = kinetic(outer, series)
    if -beyond < at and slope_beyond > 0:
        y = outer - side * np.sqrt(-2 * beyond / slope_beyond)
    else:
        square = force * force - 2 * at * slope
        y = inner + side * 2 * at / (np.sqrt(max(square, 0.0)) - side * force)
    low, high = min(inner, outer), max(inner, outer)
    if not low < y < high:
        y = 0.5 * (low + high)
    for _ in range(STEPS):
        over, force, slope, _ = kinetic(y, series)
        if (over < 0) == (side > 0):
            high = y
        else:
            low = y
        step = over / force
        new = y - step
        if (over == 0 or 0.5 * abs(slope / force) * step * step <= ULP * abs(y)
                or high - low <= 2 * ULP * abs(y)):
            return new if low <= new <= high else y
        y = new if low < new < high else 0.5 * (low + high)
    return y


def turning_point(side: float, start: float, base: Sequence[Pair], series: Sequence[float], count: int,
                  points: np.ndarray, turn: float, fine: np.ndarray):
    """(`BOUNDED`, `UNBOUNDED` where there is none, or `UNCLEAR`; the arc; the largest K before it) of the end
    of a motion on a side, from the arc of its state."""
    inner, fastest = start, 0.0
    for n in range(count):
        point = points[n if side > 0 else count - 1 - n]
        if (point[ARC] - start) * side <= 0:
            continue
        barrier = point[SLOPE] > 0
        if barrier and abs(point[HEIGHT]) <= CLEAR * point[ERROR]:
            sharpened(point, base, fine)
            if not abs(point[HEIGHT]) > CLEAR * point[ERROR]:
                return UNCLEAR, inner, fastest
        if point[HEIGHT] < 0:
            if not barrier:
                return UNCLEAR, inner, fastest
            return BOUNDED, crossing(inner, point[ARC], series), fastest
        inner, fastest = point[ARC], max(fastest, point[HEIGHT])
    if turn < INFINITY:
        return UNBOUNDED, inner, fastest
    # towards the wall; from a well of a motion at rest the other end may be just twice as far
    arc, over = 1.0 if inner == start else BESIDE * abs(inner - start), 0.0
    for _ in range(DOUBLINGS):
        over = kinetic(inner + side * arc, series)[0]
        if not over >= 0:
            break
        arc *= 2
    if not over < 0:
        return UNBOUNDED if arc > LONGEST else UNCLEAR, inner, fastest
    return BOUNDED, crossing(inner, inner + side * arc, series), fastest


def spanned(base: Sequence[Pair], n: float, turn: float, drift: float, fine: np.ndarray, cuts: np.ndarray,
            roots: np.ndarray, arcs: np.ndarray, points: np.ndarray):
    """(whether it is bounded, the base that arcs are from, the state's arc, those of both ends, the largest
    K, how many points) of a motion from the state of a base.

    Far from the throat of a hyperbola terms grow like exp(2 n y), and the throat is the base then; not
    otherwise: that of a flat one is so far away that all digits would be lost.
    """
    e, energy, force = fine[E, 0], value(base[OVER]), value(base[F0])
    start, count, left, right, fastest, bounded = 0.0 * n, 0, 0.0 * n, 0.0 * n, energy, UNCLEAR
    for again in range(2 if e > 0 else 1):
        if again:
            start = to_throat(base, n)
            if not abs(n * start) <= LONG_ARC:
                return UNCLEAR, base, start, left, right, fastest, count
            base = moved(base, -start, fine)
        series = rounded(base, e)
        count = points_along(series, turn, drift, again > 0, 0.0, cuts, roots, arcs, points)
        left, right, fastest = start, start, energy
        bounded = BOUNDED if count >= 0 else UNCLEAR
        for end in range(2 if bounded else 0):
            side = 2.0 * end - 1
            if energy == 0 and force * side < 0:  # from rest it goes to one side
                continue
            result, y, faster = turning_point(side, start, base, series, count, points, turn, fine)
            fastest, left, right = max(fastest, faster), min(left, y), max(right, y)
            if result == UNCLEAR or bounded == UNCLEAR:
                bounded = UNCLEAR
            elif result == UNBOUNDED:
                bounded = UNBOUNDED
        if bounded == BOUNDED and n * max(abs(left), abs(right)) <= SHORT_ARC:
            break
    return bounded, base, start, left, right, fastest, count


# --- From the middle of the motion
def end_of(y: float, series: Sequence[float]):
    """(arc, force, its slope, error of the arc; whether Newton's method is sure) of an end of a motion, from
    a guess, in doubles."""
    over, force, slope, terms = kinetic(y, series)
    step = over / force
    if not abs(slope * step) < STEP_CHANGE * abs(force):  # next to a barrier rounding would lead anywhere
        return y, force, slope, INFINITY, False
    y -= step
    over, force, slope, terms = kinetic(y, series)
    step = over / force
    y -= step
    error = ULP * (ROUNDINGS * terms / abs(force) + abs(y))
    return y, force, slope, error, abs(slope) * (abs(step) + error) < STEP_CHANGE * abs(force)


def sharp_end(end: Sequence[float], base: Sequence[Pair], fine: np.ndarray):
    """An end again in twofold numbers."""
    y, force, slope, _, _ = end
    noise, error = twofold_error(y, base, fine), INFINITY
    for _ in range(4):
        there = moved(base, y, fine)
        at, bend = value(there[F0]), value(there[F1])
        step = -value(there[OVER]) / at
        if not abs(step * bend) < STEP_CHANGE * abs(at):
            return y, force, slope, INFINITY, False
        y += step
        rest = step * step * abs(bend / at)
        error = noise / abs(at) + rest + ULP * abs(y)
        if rest <= ULP * abs(y):
            break
    return y, force, slope, error, error < INFINITY


def about_middle(base: Sequence[Pair], left: float, right: float, e: float, fine: np.ndarray):
    """(the base half-way between two arcs; the ends of the motion from there), given guesses of these."""
    at = 0.5 * (left + right)
    middle = moved(base, at, fine)
    series = rounded(middle, e)
    return middle, end_of(left - at, series), end_of(right - at, series)


def ends_about_middle(base: Sequence[Pair], left: float, right: float, e: float, fine: np.ndarray):
    """The same with the base so near the middle of the motion as 32 digits bring it."""
    middle, first, last = about_middle(base, left, right, e, fine)
    for _ in range(2):
        if not (first[4] and last[4] and abs(first[0] + last[0])
                > 1e-14 * 0.5 * (last[0] - first[0]) + first[3] + last[3]):
            break
        at = 0.5 * (left + right)
        left, right = at + first[0], at + last[0]
        middle, first, last = about_middle(base, left, right, e, fine)
    return middle, first, last


# --- Extremes
def range_of(at: float, speed: float, bend: float, n: float, e: float, left: Sequence[float],
             right: Sequence[float]):
    """(least, most, error) of such a component between the two ends of a motion."""
    y, terms, slope = component(at, speed, bend, e, left[0])
    other, other_terms, other_slope = component(at, speed, bend, e, right[0])
    low, high = min(y, other), max(y, other)
    error = max(4 * ULP * terms + abs(slope) * left[3], 4 * ULP * other_terms + abs(other_slope) * right[3])
    y, step = stationary(speed, bend, n, e, left[0])
    while y < right[0]:
        if y > left[0]:
            top, terms, _ = component(at, speed, bend, e, y)
            low, high, error = min(low, top), max(high, top), max(error, 4 * ULP * terms)
        y += step
    return low, high, error


def fastest_of(energy: float, fastest: float, left: float, right: float, count: int, points: np.ndarray,
               base: Sequence[Pair], fine: np.ndarray):
    """(largest K of a motion, its error), sharpened where doubles give it too few digits."""
    error = ULP * energy
    for n in range(count):
        point = points[n]
        if left < point[ARC] < right and point[HEIGHT] >= fastest * (1 - 1e-9):
            if point[ERROR] > 0.25 * DIGITS * fastest:
                sharpened(point, base, fine)
                fastest = max(energy, point[HEIGHT])
            error = max(error, point[ERROR])
    return fastest, error


def boxed(state: np.ndarray, axes: Sequence[int], middle: Sequence[Pair], n: float, left: Sequence[float],
          right: Sequence[float], fastest: float, error: float, fine: np.ndarray, box: np.ndarray):
    """Fill a box (3, 2) of a motion; whether it has its digits."""
    j, k, i = axes
    e, shift = fine[E, 0], fine[SHIFT, 0]
    low_u, high_u, error_u = range_of(value(middle[U]), value(middle[ALONG_U]), value(middle[BEND_U]), n, e,
                                      left, right)
    low_v, high_v, error_v = range_of(value(middle[V]), value(middle[ALONG_V]), value(middle[BEND_V]), n, e,
                                      left, right)
    top = np.sqrt(2 * fastest)
    error_w = top * (0.5 * error / fastest + ULP) + ULP * abs(shift)
    box[j, 0], box[j, 1] = min(low_u, state[j]), max(high_u, state[j])
    box[k, 0], box[k, 1] = min(low_v, state[k]), max(high_v, state[k])
    box[i, 0], box[i, 1] = min(-top - shift, state[i]), max(top - shift, state[i])
    return (error_u <= DIGITS * max(abs(box[j, 0]), abs(box[j, 1]))
            and error_v <= DIGITS * max(abs(box[k, 0]), abs(box[k, 1]))
            and error_w <= DIGITS * max(abs(box[i, 0]), abs(box[i, 1])))


# --- The period next to a separatrix
def stops_between(left: float, right: float, start: float, origin: Sequence[Pair], base: Sequence[Pair],
                  count: int, points: np.ndarray, fine: np.ndarray, stops: np.ndarray):
    """Fill the stops of a motion in their order, with the base where it is a throat, from which nothing
    cancels; (how many there are, what the period may be off by them). start: the arc of the state, which is
    an end itself where it is at rest; origin: the base there."""
    total, before, error = 0, left, 0.0
    for n in range(count + 2):
        end = n == 0 or n == count + 1
        y = left if n == 0 else right if end else points[n - 1, ARC]
        if not end and not left < y < right:
            continue
        if start != 0 and before < 0 < y:
            fill_stop(stops[total], base, 0.0, 0.0, fine)
            total += 1
        if end and y == start and value(origin[OVER]) == 0:
            fill_stop(stops[total], origin, y, 0.0, fine)
            error += force_error(origin, fine)
        else:
            error += stop_at(stops[total], base, y, end, fine)
        before = y
        total += 1
    return total, error


# --- Rows
def rows(states: np.ndarray, open_rows: np.ndarray, axes: Sequence[int], fine: np.ndarray, turn: float,
         drift: float, rules: Sequence[np.ndarray], boxes: np.ndarray, periods: np.ndarray,
         left_open: np.ndarray):
    """Fill boxes (n, 3, 2) and periods (n,) of the open rows of states (n, 3), as far as their bits in
    left_open (n,) ask; the bits of what is settled go.

    axes: the two across the axis and the axis; fine: (10, 2) high and low parts of the constants of the
    reduction; turn: arc of a full circle, inf on other orbits; drift: what K changes by a radian of it;
    rules: nodes and weights.
    """
    nodes, nearby, weights, levels = rules
    cuts, roots, arcs, points = np.empty((2, 8)), np.empty(8), np.empty(POINTS), np.empty((POINTS, 4))
    stops, t = np.empty((POINTS + 3, STOP_COLUMNS)), np.empty(MAX_COEFFICIENTS + 8)
    e = fine[E, 0]
    n = np.sqrt(abs(e))
    for row in open_rows:
        request, state = int(left_open[row]), states[row]
        origin = base_of(state, axes, fine)
        energy = value(origin[OVER])
        bounded, base, start, left, right, fastest, count = spanned(origin, n, turn, drift, fine, cuts, roots,
                                                                    arcs, points)
        if bounded != BOUNDED:
            continue
        middle, first, last = ends_about_middle(base, left, right, e, fine)
        series = rounded(middle, e)
        rho = 0.5 * (last[0] - first[0])
        if not rho > 0:
            continue
        settles = True
        for sharp in range(2):
            if sharp:
                first, last = sharp_end(first, middle, fine), sharp_end(last, middle, fine)
                rho = 0.5 * (last[0] - first[0])
            if not (first[4] and last[4] and first[1] > 0 > last[1]):
                continue
            if request & BOX:
                top, error = fastest_of(energy, fastest, left, right, count, points, base, fine)
                if boxed(state, axes, middle, n, first, last, top, error, fine, boxes[row]):
                    request -= BOX
            if request & PERIOD and settles:
                period, error = period_about(series, rho, first[0], last[0], t, nodes)
                settles = error < INFINITY  # else sharper ends are no help
                for end in (first, last):
                    error += end[3] * (1 / rho + abs(end[2] / end[1]))
                if error <= PERIOD_DIGITS:
                    periods[row] = period
                    request -= PERIOD
            if not request or (request == PERIOD and not settles):
                break
        if request & PERIOD:
            total, off = stops_between(left, right, start, origin, base, count, points, fine, stops)
            period, error = period_in_pieces(stops, total, nearby, weights, levels, True)
            if error + off <= PERIOD_DIGITS:
                periods[row] = period
                request -= PERIOD
        left_open[row] = request
