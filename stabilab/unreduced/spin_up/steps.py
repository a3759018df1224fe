"""Taylor steps of motions side by side, and of a small change of each, in straight loops that numba compiles.

w_i' = kappa_i w_j w_k + rho_i w_k + sigma_i w_j + m_i (cyclic). The motions go in LANES: one where the loops
run as they are written, several where they are compiled: a processor then works on the lanes of a row
together. A lane whose motion is at its end takes the next one. No lane reads another, and all do the same
operations in the same order: the bits of a motion depend neither on its neighbours nor on how many lanes
there are.

The coefficient of s^n of w_i stands in row ZEROS + n of a, at i LANES + lane; s is the time over `scale`, a
power of two near the fastest rate, so that no coefficient overflows. A row goes on with w_1 and w_2 once
more, so that w_(i+1) and w_(i+2) stand LANES and 2 LANES farther on for every i. The rows before hold zeros:
products of series are summed BLOCK terms at a time, and those that the last block has too many are zero (what
stands above degree n is finite, from the step before).

The change v of a motion obeys the equation made linear. It is known to a few per cent, so its series ends at
degree SIDE: over a step, a seventh of the radius of convergence, that leaves out 3e-7 of it.

Coefficients of a motion that hardly leaves a steady one say nothing of how fast a change there grows: beside
a saddle, 1e-45 away, they allow a step over which it grows e^100 times. So a step is no longer than the
change's own last coefficients allow, nor than a few times what the slopes of the rates allow.
"""
from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

ORDER, SIDE = 20, 8
BLOCK, ZEROS = 4, 3  # both orders are multiples of BLOCK; ZEROS is one less
LANES = 1
# of compiled loops, from so many motions on: lanes that nobody fills take as long as others
SIDE_BY_SIDE, FROM = 32, 6
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
# bits of a double's exponent and fraction, and of 1.0 and 2^52, to which a whole number is added in last bits
EXPONENT, FRACTION = 0x7FF0000000000000, 0x000FFFFFFFFFFFFF
ONE, WHOLE, BIAS = 0x3FF0000000000000, 0x4330000000000000, 2.0**52 + 1023.0


class Work(NamedTuple):
    """Arrays of a run, zeros at first: coefficients a and v of the motions and of their changes (ZEROS +
    degree + 1, 5 LANES), those of the equations, spread over the lanes and in the time of each, c (4, 3
    LANES), a sum and the step ahead (3 LANES,), numbers and their exponents (7 LANES,), as bits too; of
    each lane the scale, as bits too, the step, what is left of its span and what has passed, the sign of
    both, the greatest, the least and the last |omega|^2, the row whose motion it holds (-1: none) and the
    steps due to it."""

    a: np.ndarray
    v: np.ndarray
    spread: np.ndarray
    c: np.ndarray
    total: np.ndarray
    ahead: np.ndarray
    logs: np.ndarray
    log_bits: np.ndarray
    whole: np.ndarray
    whole_bits: np.ndarray
    scale: np.ndarray
    scale_bits: np.ndarray
    step: np.ndarray
    left: np.ndarray
    passed: np.ndarray
    sign: np.ndarray
    most: np.ndarray
    least: np.ndarray
    now: np.ndarray
    held: np.ndarray
    due: np.ndarray


def complete(table: np.ndarray, row: int):
    """The first two rates of a row once more, behind the third."""
    for j in range(2 * LANES):
        table[row, 3 * LANES + j] = table[row, j]


def series(c: np.ndarray, a: np.ndarray, total: np.ndarray):
    """The coefficients of a from those of degree 0. c (4, 3 LANES): kappa, rho, sigma, m, times the scale."""
    for n in range(ORDER):
        for j in range(3 * LANES):
            total[j] = 0.0
        for m in range(0, n + 1, BLOCK):
            up, down = ZEROS + m, ZEROS + n - m
            for j in range(3 * LANES):
                y, z = j + LANES, j + 2 * LANES
                total[j] = (total[j] + a[up, y] * a[down, z] + a[up + 1, y] * a[down - 1, z]
                            + a[up + 2, y] * a[down - 2, z] + a[up + 3, y] * a[down - 3, z])
        row, over, first = ZEROS + n, 1.0 / (n + 1.0), 1.0 if n == 0 else 0.0
        for j in range(3 * LANES):
            a[row + 1, j] = (c[0, j] * total[j] + c[1, j] * a[row, j + 2 * LANES]
                             + c[2, j] * a[row, j + LANES] + first * c[3, j]) * over
        complete(a, row + 1)


def series_beside(c: np.ndarray, a: np.ndarray, v: np.ndarray, total: np.ndarray):
    """The coefficients of a change v beside those of the motion a."""
    for n in range(SIDE):
        for j in range(3 * LANES):
            total[j] = 0.0
        for m in range(0, n + 1, BLOCK):
            up, down = ZEROS + m, ZEROS + n - m
            for j in range(3 * LANES):
                y, z = j + LANES, j + 2 * LANES
                total[j] = (total[j] + (a[up, y] * v[down, z] + v[down, y] * a[up, z])
                            + (a[up + 1, y] * v[down - 1, z] + v[down - 1, y] * a[up + 1, z])
                            + (a[up + 2, y] * v[down - 2, z] + v[down - 2, y] * a[up + 2, z])
                            + (a[up + 3, y] * v[down - 3, z] + v[down - 3, y] * a[up + 3, z]))
        row, over = ZEROS + n, 1.0 / (n + 1.0)
        for j in range(3 * LANES):
            v[row + 1, j] = (c[0, j] * total[j] + c[1, j] * v[row, j + 2 * LANES]
                             + c[2, j] * v[row, j + LANES]) * over
        complete(v, row + 1)


def ahead_by(table: np.ndarray, order: int, ahead: np.ndarray, total: np.ndarray):
    """The values of the polynomials at `ahead`, to the row of degree 0."""
    for j in range(3 * LANES):
        total[j] = table[ZEROS + order, j]
    for row in range(ZEROS + order - BLOCK, ZEROS - 1, -BLOCK):
        for j in range(3 * LANES):
            total[j] = (((total[j] * ahead[j] + table[row + 3, j]) * ahead[j] + table[row + 2, j]) * ahead[j]
                        + table[row + 1, j]) * ahead[j] + table[row, j]
    for j in range(3 * LANES):
        table[ZEROS, j] = total[j]
    complete(table, ZEROS)


def sizes(table: np.ndarray, smallest: float, logs: np.ndarray, first: int):
    """The greatest size in the rows of degree 0, the last and the last but one, of each lane, at least
    `smallest` and 1e-290, to logs from `first` on."""
    for n in range(3):
        row, bound = (table.shape[0] - n, 1e-290) if n else (ZEROS, smallest)
        for k in range(LANES):
            logs[first + n * LANES + k] = max(abs(table[row, k]), abs(table[row, LANES + k]),
                                              abs(table[row, 2 * LANES + k]), bound)


def steepest(c: np.ndarray, a: np.ndarray, total: np.ndarray, logs: np.ndarray):
    """The greatest sum of sizes in a row of the rates' derivative, or 1e-290, to logs from 3 LANES on."""
    for j in range(3 * LANES):
        total[j] = (abs(c[0, j] * a[ZEROS, j + 2 * LANES] + c[2, j])
                    + abs(c[0, j] * a[ZEROS, j + LANES] + c[1, j]))
    for k in range(LANES):
        logs[3 * LANES + k] = max(total[k], total[LANES + k], total[2 * LANES + k], 1e-290)


def logarithms(logs: np.ndarray, bits: np.ndarray, whole: np.ndarray, whole_bits: np.ndarray):
    """Of positive numbers (7 LANES,) to the base 2, in their place: exact at powers of 2, linear between
    them, so at most 0.09 below; 1024 of infinity."""
    for k in range(7 * LANES):
        whole_bits[k] = bits[k] >> 52 | WHOLE
    for k in range(7 * LANES):
        bits[k] = bits[k] & FRACTION | ONE
    for k in range(7 * LANES):
        logs[k] += whole[k] - (BIAS + 1.0)


def allowed(step: np.ndarray, logs: np.ndarray, first: int, order: int, fraction: float):
    """Cut the logarithms of steps to those over which each of the last two coefficients adds to the state, or
    to what stands for it, at most its share (a logarithm); logs: of `sizes`, from `first` on."""
    for k in range(LANES):
        room = logs[first + k] + fraction
        step[k] = min(step[k], (room - logs[first + LANES + k]) / order,
                      (room - logs[first + 2 * LANES + k]) / (order - 1))


def two_to(step: np.ndarray, whole: np.ndarray, whole_bits: np.ndarray):
    """2^y for |y| < 1000, within 0.3 per cent, in its place; exact for whole y."""
    for k in range(LANES):
        whole[k] = np.floor(step[k])
    for k in range(LANES):
        part = step[k] - whole[k]
        step[k] = 1.0 + part * (0.6565 + 0.3435 * part)
    for k in range(LANES):
        whole[k] += BIAS
    for k in range(LANES):
        whole_bits[k] = (whole_bits[k] & 0x7FF) << 52
    for k in range(LANES):
        step[k] *= whole[k]


def in_their_time(a: np.ndarray, spread: np.ndarray, c: np.ndarray, ahead: np.ndarray, scale: np.ndarray,
                  scale_bits: np.ndarray):
    """The scale of each lane, and the coefficients of its equations for it; ahead: to work in."""
    for k in range(LANES):
        fastest = max(abs(a[ZEROS, k]), abs(a[ZEROS, LANES + k]), abs(a[ZEROS, 2 * LANES + k]), 1.0)
        scale[k] = fastest if fastest < 1e300 else 1e300
    for k in range(LANES):
        scale_bits[k] &= EXPONENT
    for i in range(3):
        for k in range(LANES):
            ahead[i * LANES + k] = 1.0 / scale[k]
    for n in range(4):
        for j in range(3 * LANES):
            c[n, j] = spread[n, j] * ahead[j]


def step_ahead(beside: bool, a: np.ndarray, v: np.ndarray, spread: np.ndarray, c: np.ndarray,
               total: np.ndarray, ahead: np.ndarray, logs: np.ndarray, log_bits: np.ndarray,
               whole: np.ndarray, whole_bits: np.ndarray, scale: np.ndarray, scale_bits: np.ndarray,
               step: np.ndarray, left: np.ndarray, passed: np.ndarray, sign: np.ndarray, most: np.ndarray,
               least: np.ndarray, now: np.ndarray, due: np.ndarray):
    """One step of every lane; returns how many are at their end."""
    in_their_time(a, spread, c, ahead, scale, scale_bits)
    series(c, a, total)
    sizes(a, 1.0, logs, 0)
    steepest(c, a, total, logs)
    if beside:
        series_beside(c, a, v, total)
        sizes(v, 1e-200, logs, 4 * LANES)
    logarithms(logs, log_bits, whole, whole_bits)
    for k in range(LANES):
        step[k] = min(STEEP - logs[3 * LANES + k], 100.0)
    allowed(step, logs, 0, ORDER, TAIL)
    if beside:
        allowed(step, logs, 4 * LANES, SIDE, START_EXPONENT)
    two_to(step, whole, whole_bits)
    for k in range(LANES):
        step[k] = min(step[k] / scale[k], LONGEST, left[k])
    for k in range(LANES):
        passed[k] += step[k]
    for k in range(LANES):
        left[k] -= step[k]
    for i in range(3):
        for k in range(LANES):
            ahead[i * LANES + k] = step[k] * scale[k] * sign[k]
    if beside:
        ahead_by(v, SIDE, ahead, total)
    ahead_by(a, ORDER, ahead, total)
    squares(a, now)
    for k in range(LANES):
        most[k] = now[k] if now[k] > most[k] else most[k]
    for k in range(LANES):
        least[k] = now[k] if now[k] < least[k] else least[k]
    for k in range(LANES):
        due[k] -= 1
    ended = 0
    for k in range(LANES):
        ended += 0 if left[k] > 0.0 and now[k] < math.inf and due[k] > 0 else 1
    return ended


def squares(a: np.ndarray, now: np.ndarray):
    """|omega|^2 of each lane."""
    for k in range(LANES):
        x, y, z = a[ZEROS, k], a[ZEROS, LANES + k], a[ZEROS, 2 * LANES + k]
        now[k] = x * x + y * y + z * z


def load(lane: int, row: int, states: np.ndarray, table: np.ndarray):
    """A row of states (n, 3) into a lane, at degree 0."""
    for i in range(5):
        table[ZEROS, i * LANES + lane] = states[row, i % 3]


def unload(lane: int, row: int, states: np.ndarray, table: np.ndarray):
    """A lane at degree 0 to a row of states (n, 3). Zeros take the place of coefficients that are beyond
    doubles, so that the lane's next motion meets none of them."""
    size = 0.0
    for i in range(3):
        states[row, i] = table[ZEROS, i * LANES + lane]
        size += abs(states[row, i])
    if not size < math.inf:
        for n in range(table.shape[0]):
            for i in range(5):
                table[n, i * LANES + lane] = 0.0


def run(coefficients: np.ndarray, states: np.ndarray, changes: np.ndarray, spans: np.ndarray,
        steps: np.ndarray, beside: bool, reached: np.ndarray, met: np.ndarray, a: np.ndarray, v: np.ndarray,
        spread: np.ndarray, c: np.ndarray, total: np.ndarray, ahead: np.ndarray, logs: np.ndarray,
        log_bits: np.ndarray, whole: np.ndarray, whole_bits: np.ndarray, scale: np.ndarray,
        scale_bits: np.ndarray, step: np.ndarray, left: np.ndarray, passed: np.ndarray, sign: np.ndarray,
        most: np.ndarray, least: np.ndarray, now: np.ndarray, held: np.ndarray, due: np.ndarray):
    """Up to so many steps (n,), over spans (n,) of time (back where negative), of motions from states (n, 3)
    and, if `beside`, of changes (n, 3) of them, all in their place; the times that have passed to reached
    (n,), the greatest and the least |omega|^2 that was met to met (2, n). a and what follows: `Work`."""
    for lane in range(LANES):
        held[lane], left[lane] = -1, 0.0
        for n in range(4):
            for i in range(3):
                spread[n, i * LANES + lane] = coefficients[n, i]
    following, busy, ended = 0, 0, LANES
    while True:
        for lane in range(LANES if ended else 0):
            if left[lane] > 0.0 and now[lane] < math.inf and due[lane] > 0:
                continue
            row = held[lane]
            if row >= 0:
                reached[row] = spans[row] if left[lane] <= 0.0 else sign[lane] * passed[lane]
                met[0, row], met[1, row] = most[lane], least[lane]
                unload(lane, row, states, a)
                if beside:
                    unload(lane, row, changes, v)
                busy -= 1
            if following < spans.size:
                row, following, busy = following, following + 1, busy + 1
                load(lane, row, states, a)
                if beside:
                    load(lane, row, changes, v)
                held[lane], due[lane], left[lane] = row, steps[row], abs(spans[row])
                passed[lane], sign[lane] = 0.0, math.copysign(1.0, spans[row])
                most[lane] = least[lane] = (states[row, 0] * states[row, 0] + states[row, 1] * states[row, 1]
                                            + states[row, 2] * states[row, 2])
            else:  # it stays as it is, and is never at its end
                held[lane], due[lane], left[lane], sign[lane] = -1, 2**62, math.inf, 0.0
        if busy == 0:
            break
        ended = step_ahead(beside, a, v, spread, c, total, ahead, logs, log_bits, whole, whole_bits, scale,
                           scale_bits, step, left, passed, sign, most, least, now, due)


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


def begin(coefficients: np.ndarray, rows: np.ndarray, t_max: float, pause: float, states: np.ndarray,
          clock: np.ndarray, ahead: np.ndarray, starts: np.ndarray, changes: np.ndarray, spans: np.ndarray,
          rate: np.ndarray, change: np.ndarray):
    """What rows (m,) are carried on from: starts, changes across them (m, 3), spans (m,) to t_max (to `pause`
    of those before it). rate, change (3,): to work in."""
    for n in range(rows.size):
        row = rows[n]
        across(coefficients, states, ahead, row, rate, change)
        for i in range(3):
            starts[n, i], changes[n, i] = states[row, i], change[i]
        spans[n] = max(0.0, end_of(clock[row], t_max, pause) - clock[row])


def end_of(now: float, t_max: float, pause: float):
    """Where a motion stops that has come to a time."""
    return min(pause, t_max) if now < pause else t_max


def end(coefficients: np.ndarray, rows: np.ndarray, steps: np.ndarray, t_max: float, pause: float,
        step_error: float, ends: np.ndarray, changes: np.ndarray, spans: np.ndarray, reached: np.ndarray,
        met: np.ndarray, states: np.ndarray, clock: np.ndarray, growth: np.ndarray, largest: np.ndarray,
        ahead: np.ndarray, blur: np.ndarray, lengths: np.ndarray, done: np.ndarray, rounded: np.ndarray,
        rate: np.ndarray, start: np.ndarray, change: np.ndarray):
    """What has become of rows (m,) after so many steps (m,): ends, changes (m, 3), times reached (m,) and met
    (2, m) of `run`; and how a small change of each has grown. done, rounded (n,): steps computed and passed;
    lengths (2, n): greatest and least |omega| on the way. rate, start, change (3,): to work in."""
    for n in range(rows.size):
        row = rows[n]
        done[row] += steps[n]
        rounded[row] += steps[n]
        for i in range(3):
            start[i], states[row, i], change[i] = states[row, i], ends[n, i], changes[n, i]
        clock[row] = end_of(clock[row], t_max, pause) if reached[n] >= spans[n] else clock[row] + reached[n]
        lengths[0, row], lengths[1, row] = math.sqrt(met[0, n]), math.sqrt(met[1, n])
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
