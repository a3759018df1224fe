"""Taylor steps of a motion, and of a small change of it, in straight loops that numba compiles.

w_i' = kappa_i w_j w_k + rho_i w_k + sigma_i w_j + m_i (cyclic). The coefficient of s^n of w_i stands in a[n,
i]; s is the time over `scale`, a power of two near the fastest rate, so that no coefficient overflows. The
change v of a motion obeys the equation made linear. It is known to a few per cent, so its series ends at
degree SIDE: over a step, a seventh of the radius of convergence, that leaves out 3e-7 of it.

Coefficients of a motion that hardly leaves a steady one say nothing of how fast a change there grows: beside
a saddle, 1e-45 away, they allow a step over which it grows e^100 times. So a step is no longer than the
change's own last coefficients allow, nor than a few times what the slopes of the rates allow.
"""
from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np

ORDER, SIDE = 20, 8
# base 2: what the last coefficients may add to a state, relative to it or to a natural unit: a sixteenth of a
# unit of rounding
TAIL = -56.0
LONGEST = 64.0        # of a step: even of a motion at rest
# base 2: what the last coefficients of a change may add to it; what is left out is then below a hundredth of
# it
START_EXPONENT = -5.0
# base 2: of a step times the slopes: beyond, the terms left out of e^x would be greater than the last
STEEP = 3.0
STILL = 2.0**-8  # rates per size (or per natural unit) below which no delay is told from a change
LOST = 2.0**-30  # what lies across a motion is taken to be no less, relative to the change


def logarithm(x: float):
    """Of positive x to the base 2: exact at powers of 2, linear between them, so at most 0.09 below; 1024
    where x is beyond doubles."""
    if not x < math.inf:
        return 1024.0
    fraction, power = math.frexp(x)
    return power - 2.0 + 2.0 * fraction


def two_to(y: float):
    """2^y for |y| < 1000, within 0.3 per cent; exact for whole y."""
    full = math.floor(y)
    part = y - full
    return math.ldexp(1.0 + part * (0.6565 + 0.3435 * part), int(full))


def series(c: np.ndarray, a: np.ndarray):
    """The coefficients of a from those of degree 0. c (4, 3): kappa, rho, sigma, m, times the scale."""
    for n in range(ORDER):
        s0 = s1 = s2 = 0.0
        for m in range(n + 1):
            s0 += a[m, 1] * a[n - m, 2]
            s1 += a[m, 2] * a[n - m, 0]
            s2 += a[m, 0] * a[n - m, 1]
        s0 = c[0, 0] * s0 + c[1, 0] * a[n, 2] + c[2, 0] * a[n, 1]
        s1 = c[0, 1] * s1 + c[1, 1] * a[n, 0] + c[2, 1] * a[n, 2]
        s2 = c[0, 2] * s2 + c[1, 2] * a[n, 1] + c[2, 2] * a[n, 0]
        if n == 0:
            s0, s1, s2 = s0 + c[3, 0], s1 + c[3, 1], s2 + c[3, 2]
        over = 1.0 / (n + 1.0)
        a[n + 1, 0], a[n + 1, 1], a[n + 1, 2] = s0 * over, s1 * over, s2 * over


def series_beside(c: np.ndarray, a: np.ndarray, v: np.ndarray):
    """The coefficients of a change v beside those of the motion a."""
    for n in range(SIDE):
        s0 = s1 = s2 = 0.0
        for m in range(n + 1):
            s0 += a[m, 1] * v[n - m, 2] + v[n - m, 1] * a[m, 2]
            s1 += a[m, 2] * v[n - m, 0] + v[n - m, 2] * a[m, 0]
            s2 += a[m, 0] * v[n - m, 1] + v[n - m, 0] * a[m, 1]
        over = 1.0 / (n + 1.0)
        v[n + 1, 0] = (c[0, 0] * s0 + c[1, 0] * v[n, 2] + c[2, 0] * v[n, 1]) * over
        v[n + 1, 1] = (c[0, 1] * s1 + c[1, 1] * v[n, 0] + c[2, 1] * v[n, 2]) * over
        v[n + 1, 2] = (c[0, 2] * s2 + c[1, 2] * v[n, 1] + c[2, 2] * v[n, 0]) * over


def largest_of(table: np.ndarray, n: int, smallest: float):
    """The greatest size in row n of a table, at least `smallest`."""
    return max(abs(table[n, 0]), abs(table[n, 1]), abs(table[n, 2]), smallest)


def allowed(table: np.ndarray, order: int, smallest: float, fraction: float):
    """The logarithm of the step over which each of the last two coefficients adds to the state, or to
    `smallest`, at most its share (a logarithm)."""
    largest = logarithm(largest_of(table, 0, smallest)) + fraction
    return min((largest - logarithm(largest_of(table, order, 1e-290))) / order,
               (largest - logarithm(largest_of(table, order - 1, 1e-290))) / (order - 1))


def steepest(c: np.ndarray, a: np.ndarray):
    """The greatest sum of sizes in a row of the rates' derivative."""
    x, y, z = a[0, 0], a[0, 1], a[0, 2]
    return max(abs(c[0, 0] * z + c[2, 0]) + abs(c[0, 0] * y + c[1, 0]),
               abs(c[0, 1] * x + c[2, 1]) + abs(c[0, 1] * z + c[1, 1]),
               abs(c[0, 2] * y + c[2, 2]) + abs(c[0, 2] * x + c[1, 2]), 1e-290)


def ahead_by(table: np.ndarray, order: int, h: float):
    """The values of three polynomials at h, to row 0."""
    for i in range(3):
        total = table[order, i]
        for n in range(order - 1, -1, -1):
            total = total * h + table[n, i]
        table[0, i] = total


def square(a: np.ndarray):
    """|omega|^2."""
    return a[0, 0] * a[0, 0] + a[0, 1] * a[0, 1] + a[0, 2] * a[0, 2]


def run(coefficients: np.ndarray, a: np.ndarray, v: np.ndarray, span: float, steps: int, beside: bool,
        scaled: np.ndarray, met: np.ndarray):
    """Up to so many steps, over a span of time (back where it is negative), of the motion in row 0 of a and,
    if `beside`, of the change in v; returns the time that has passed. The greatest and the least |omega|^2
    that was met goes to met (2,); scaled (4, 3): for work."""
    met[0] = met[1] = square(a)
    left, passed = abs(span), 0.0
    for _ in range(steps):
        fastest = largest_of(a, 0, 1.0)
        scale = math.ldexp(1.0, math.frexp(fastest if fastest < 1e300 else 1e300)[1] - 1)
        for n in range(4):
            for i in range(3):
                scaled[n, i] = coefficients[n, i] / scale
        series(scaled, a)
        h = min(allowed(a, ORDER, 1.0, TAIL), STEEP - logarithm(steepest(scaled, a)))
        if beside:
            series_beside(scaled, a, v)
            h = min(h, allowed(v, SIDE, 1e-200, START_EXPONENT))
        h = min(two_to(min(h, 100.0)) / scale, LONGEST, left)
        passed, left = passed + h, left - h
        ahead = math.copysign(h * scale, span)
        if beside:
            ahead_by(v, SIDE, ahead)
        ahead_by(a, ORDER, ahead)
        now = square(a)
        met[0], met[1] = max(met[0], now), min(met[1], now)
        if left <= 0.0 or not now < math.inf:
            break
    return span if left <= 0.0 else math.copysign(passed, span)


def carry(coefficients: np.ndarray, states: np.ndarray, spans: np.ndarray, steps: int, out: np.ndarray,
          reached: np.ndarray, a: np.ndarray, v: np.ndarray, scaled: np.ndarray, met: np.ndarray):
    """Motions from states (n, 3) over spans (n,) of time, forth or back, in at most so many steps: states to
    out, times to reached."""
    for row in range(spans.size):
        a[0] = states[row]
        reached[row] = run(coefficients, a, v, spans[row], steps, False, scaled, met)
        out[row] = a[0]


def rates_at(c: np.ndarray, x: float, y: float, z: float, out: np.ndarray):
    """The rates of change at one state; returns (their size, the state's greatest or 1)."""
    out[0] = c[0, 0] * y * z + c[1, 0] * z + c[2, 0] * y + c[3, 0]
    out[1] = c[0, 1] * z * x + c[1, 1] * x + c[2, 1] * z + c[3, 1]
    out[2] = c[0, 2] * x * y + c[1, 2] * y + c[2, 2] * x + c[3, 2]
    return math.sqrt(out[0] * out[0] + out[1] * out[1] + out[2] * out[2]), max(abs(x), abs(y), abs(z), 1.0)


def across(c: np.ndarray, states: np.ndarray, ahead: np.ndarray, row: int, rate: np.ndarray, out: np.ndarray):
    """The part of a row's direction `ahead` across its motion (`drift.Twins.start`)."""
    speed, largest = rates_at(c, states[row, 0], states[row, 1], states[row, 2], rate)
    out[0], out[1], out[2] = ahead[row, 0], ahead[row, 1], ahead[row, 2]
    if speed > STILL * largest:
        u, v, w = rate[0] / speed, rate[1] / speed, rate[2] / speed
        along = out[0] * u + out[1] * v + out[2] * w
        out[0], out[1], out[2] = out[0] - along * u, out[1] - along * v, out[2] - along * w
        if max(abs(out[0]), abs(out[1]), abs(out[2])) < LOST:
            x, y, z = w, u, v + 0.1
            out[0], out[1], out[2] = v * z - w * y, w * x - u * z, u * y - v * x
            fraction = LOST / math.sqrt(out[0] ** 2 + out[1] ** 2 + out[2] ** 2)
            out[0], out[1], out[2] = fraction * out[0], fraction * out[1], fraction * out[2]


def note(c: np.ndarray, start: np.ndarray, states: np.ndarray, row: int, change: np.ndarray, error: float,
         rate: np.ndarray, growth: np.ndarray, upper: np.ndarray, ahead: np.ndarray, blur: np.ndarray):
    """What became of a change of size 1 (3,): its part across the motion is the growth, the delay a blur
    (`drift.Twins.compare`)."""
    first, largest = rates_at(c, start[0], start[1], start[2], rate)
    late = 1.0 / first if first > STILL * largest else 0.0
    speed, largest = rates_at(c, states[row, 0], states[row, 1], states[row, 2], rate)
    if speed > STILL * largest:
        delay = -(change[0] * rate[0] + change[1] * rate[1] + change[2] * rate[2]) / (speed * speed)
        for i in range(3):
            change[i] += delay * rate[i]
        late += abs(delay)
    far = max(abs(change[0]), abs(change[1]), abs(change[2]))
    if not far < math.inf:
        growth[row] = math.inf
        return
    blur[row] += error * upper[row] * late
    growth[row] *= far
    upper[row] = max(upper[row], growth[row])
    if far > 0.0:
        for i in range(3):
            ahead[row, i] = change[i] / far


def advance(coefficients: np.ndarray, rows: np.ndarray, steps: int, t_max: float, pause: float,
            step_error: float, states: np.ndarray, clock: np.ndarray, growth: np.ndarray, largest: np.ndarray,
            ahead: np.ndarray, blur: np.ndarray, sizes: np.ndarray, done: np.ndarray, rounded: np.ndarray,
            a: np.ndarray, v: np.ndarray, scaled: np.ndarray, met: np.ndarray, start: np.ndarray,
            rate: np.ndarray, change: np.ndarray):
    """Carry rows on by so many steps, or to t_max (to `pause` those before it), and note how a small change
    of each has grown. done, rounded (n,): steps computed and passed; sizes (2, n): greatest and least |omega|
    on the way. a, v, scaled, met, start, rate, change: for work."""
    for row in rows:
        done[row] += steps
        rounded[row] += steps
        end = min(pause, t_max) if clock[row] < pause else t_max
        left = max(0.0, end - clock[row])
        across(coefficients, states, ahead, row, rate, change)
        for i in range(3):
            start[i] = a[0, i] = states[row, i]
            v[0, i] = change[i]
        passed = run(coefficients, a, v, left, steps, True, scaled, met)
        for i in range(3):
            states[row, i], change[i] = a[0, i], v[0, i]
        clock[row] = end if passed >= left else clock[row] + passed
        sizes[0, row], sizes[1, row] = math.sqrt(met[0]), math.sqrt(met[1])
        error = step_error * rounded[row] * math.sqrt(start[0] ** 2 + start[1] ** 2 + start[2] ** 2)
        note(coefficients, start, states, row, change, error, rate, growth, largest, ahead, blur)


def measure(rows: np.ndarray, states: np.ndarray, steps: np.ndarray, rounded: np.ndarray, growth: np.ndarray,
            met: np.ndarray, step_error: float, condition: np.ndarray, reach: np.ndarray, largest: np.ndarray,
            smallest: np.ndarray):
    """Take note of rows (`follow.Chased`): condition (n,), reach (n,) of the rounding, largest and least (n,
    48) size of the state by doublings of the steps. met (2, n): of `advance`; what it says is used up."""
    for row in rows:
        if growth[row] > condition[row]:
            condition[row] = growth[row]
        x, y, z = states[row, 0], states[row, 1], states[row, 2]
        upper = max(abs(x), abs(y), abs(z), 1.0)
        reach[row] = step_error * (1.0 + rounded[row]) * condition[row] * upper if rounded[row] > 0.0 else 0.0
        far = math.sqrt(x * x + y * y + z * z)
        doubling, left = 0, (1 + steps[row]) >> 1
        while left:
            doubling, left = doubling + 1, left >> 1
        largest[row, doubling] = max(largest[row, doubling], far, met[0, row])
        smallest[row, doubling] = min(smallest[row, doubling], far, met[1, row])
        met[0, row], met[1, row] = 0.0, math.inf


def over(rows: np.ndarray, states: np.ndarray, clock: np.ndarray, done: np.ndarray, t_max: float, budget: int,
         out: np.ndarray):
    """Which of rows have come to the end of their time or of their steps, or beyond doubles."""
    for n in range(rows.size):
        row = rows[n]
        size = abs(states[row, 0]) + abs(states[row, 1]) + abs(states[row, 2])
        out[n] = clock[row] >= t_max or done[row] >= budget or not size < math.inf
