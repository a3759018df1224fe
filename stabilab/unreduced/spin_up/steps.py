"""Taylor steps of motions side by side, and of a small change of each, in straight loops: eight to a batch
where numba compiles them, else any number.

w_i' = kappa_i w_j w_k + rho_i w_k + sigma_i w_j + m_i (cyclic). The coefficient of s^n of w_i stands in row 3
n + i of a table, a motion to a lane; s is the time over `scale`, a power of two near the fastest rate, so
that no coefficient overflows. The change v of a motion obeys the equation made linear. It is told to a few
per cent, so its series ends at degree SIDE: over a step, a seventh of the radius of convergence, that leaves
out 3e-7 of it.

Coefficients of a motion that hardly leaves a steady one say nothing of how fast a change there grows: beside
a saddle, 1e-45 away, they allow a step over which it grows e^100 times. So a step is no longer than the
change's own last coefficients allow, nor than a few times what the slopes of the rates allow.

Compiled, values of eight lanes are of one type, `lanes.vector_type`.
"""
from __future__ import annotations

import math

from .lanes import (
    greater,
    lesser,
    load,
    logarithm,
    minus,
    plus,
    power_of_two,
    size,
    spread,
    store,
    times,
    times_plus,
    two_to,
)

ORDER, SIDE = 20, 8
# base 2: what the last coefficients may add to a state, relative to it or to a natural unit: a sixteenth of a
# unit of rounding
TAIL = -56.0
LONGEST = 64.0        # of a step: even of a motion at rest
# base 2: what the last coefficients of a change may add to it; what is left out is then below a hundredth of
# it
BESIDE = -5.0
# base 2: of a step times the slopes: beyond, the terms left out of e^x would be greater than the last
STEEP = 3.0
STILL, LOST = 2.0**-8, 2.0**-30  # of `runs`: the tests hold them equal


def series(numbers, a):
    """The coefficients of a from those of degree 0. numbers (12, m): kappa, rho, sigma, m, three rows each,
    times the scale."""
    k0, k1, k2 = load(numbers, 0), load(numbers, 1), load(numbers, 2)
    r0, r1, r2 = load(numbers, 3), load(numbers, 4), load(numbers, 5)
    g0, g1, g2 = load(numbers, 6), load(numbers, 7), load(numbers, 8)
    m0, m1, m2 = load(numbers, 9), load(numbers, 10), load(numbers, 11)
    for n in range(ORDER):
        s0 = s1 = s2 = spread(0.0)
        half = (n + 1) // 2
        for m in range(half):
            p, q = 3 * m, 3 * (n - m)
            x0, x1, x2 = load(a, p), load(a, p + 1), load(a, p + 2)
            y0, y1, y2 = load(a, q), load(a, q + 1), load(a, q + 2)
            s0, s1, s2 = times_plus(x1, y2, s0), times_plus(x2, y0, s1), times_plus(x0, y1, s2)
            s0, s1, s2 = times_plus(y1, x2, s0), times_plus(y2, x0, s1), times_plus(y0, x1, s2)
        if n % 2 == 0:
            p = 3 * half
            x0, x1, x2 = load(a, p), load(a, p + 1), load(a, p + 2)
            s0, s1, s2 = times_plus(x1, x2, s0), times_plus(x2, x0, s1), times_plus(x0, x1, s2)
        p, over = 3 * n, spread(1.0 / (n + 1.0))
        x0, x1, x2 = load(a, p), load(a, p + 1), load(a, p + 2)
        store(a, p + 3, times(times_plus(k0, s0, times_plus(r0, x2, times_plus(g0, x1, m0))), over))
        store(a, p + 4, times(times_plus(k1, s1, times_plus(r1, x0, times_plus(g1, x2, m1))), over))
        store(a, p + 5, times(times_plus(k2, s2, times_plus(r2, x1, times_plus(g2, x0, m2))), over))
        if n == 0:
            m0 = m1 = m2 = spread(0.0)


def series_beside(numbers, a, v):
    """The coefficients of a change v beside those of the motion a."""
    k0, k1, k2 = load(numbers, 0), load(numbers, 1), load(numbers, 2)
    r0, r1, r2 = load(numbers, 3), load(numbers, 4), load(numbers, 5)
    g0, g1, g2 = load(numbers, 6), load(numbers, 7), load(numbers, 8)
    for n in range(SIDE):
        s0 = s1 = s2 = spread(0.0)
        for m in range(n + 1):
            p, q = 3 * m, 3 * (n - m)
            x0, x1, x2 = load(a, p), load(a, p + 1), load(a, p + 2)
            y0, y1, y2 = load(v, q), load(v, q + 1), load(v, q + 2)
            s0, s1, s2 = times_plus(x1, y2, s0), times_plus(x2, y0, s1), times_plus(x0, y1, s2)
            s0, s1, s2 = times_plus(y1, x2, s0), times_plus(y2, x0, s1), times_plus(y0, x1, s2)
        p, over = 3 * n, spread(1.0 / (n + 1.0))
        x0, x1, x2 = load(v, p), load(v, p + 1), load(v, p + 2)
        store(v, p + 3, times(times_plus(k0, s0, times_plus(r0, x2, times(g0, x1))), over))
        store(v, p + 4, times(times_plus(k1, s1, times_plus(r1, x0, times(g1, x2))), over))
        store(v, p + 5, times(times_plus(k2, s2, times_plus(r2, x1, times(g2, x0))), over))


def to_scale(given, numbers, a, work):
    """The numbers for one step: times the scale, whose inverse goes to work row 4."""
    fastest = greater(greater(size(load(a, 0)), size(load(a, 1))), greater(size(load(a, 2)), spread(1.0)))
    fastest = power_of_two(lesser(fastest, spread(1e300)))
    store(work, 4, fastest)
    scale = two_to(minus(spread(0.0), logarithm(fastest)))  # both exact at powers of two
    for n in range(12):
        store(numbers, n, times(load(given, n), scale))


def largest_of(table, n, least):
    """The greatest size in the row of degree n of three polynomials, at least `least`."""
    p = 3 * n
    return greater(greater(size(load(table, p)), size(load(table, p + 1))),
                   greater(size(load(table, p + 2)), spread(least)))


def allowed(table, order, least, share):
    """The logarithm of the step over which each of the last two coefficients adds to the state, or to
    `least`, at most its share (a logarithm)."""
    most = plus(logarithm(largest_of(table, 0, least)), spread(share))
    last, other = logarithm(largest_of(table, order, 1e-290)), logarithm(largest_of(table, order - 1, 1e-290))
    return lesser(times(minus(most, last), spread(1.0 / order)),
                  times(minus(most, other), spread(1.0 / (order - 1))))


def steepest(numbers, a):
    """The greatest sum of sizes in a row of the rates' derivative."""
    x, y, z = load(a, 0), load(a, 1), load(a, 2)
    s0 = plus(size(times_plus(load(numbers, 0), z, load(numbers, 6))),
              size(times_plus(load(numbers, 0), y, load(numbers, 3))))
    s1 = plus(size(times_plus(load(numbers, 1), x, load(numbers, 7))),
              size(times_plus(load(numbers, 1), z, load(numbers, 4))))
    s2 = plus(size(times_plus(load(numbers, 2), y, load(numbers, 8))),
              size(times_plus(load(numbers, 2), x, load(numbers, 5))))
    return greater(greater(s0, s1), greater(s2, spread(1e-290)))


def length(numbers, a, v, work, beside):
    """The step that the last two coefficients of each lane allow, over the scale, to work row 3; rows 0 to 2:
    spans, what of them has passed, senses."""
    h = lesser(allowed(a, ORDER, 1.0, TAIL), minus(spread(STEEP), logarithm(steepest(numbers, a))))
    if beside:
        h = lesser(h, allowed(v, SIDE, 1e-200, BESIDE))
    fastest, span, passed = load(work, 4), load(work, 0), load(work, 1)
    left = minus(span, passed)
    scale = two_to(minus(spread(0.0), logarithm(fastest)))
    h = lesser(times(two_to(lesser(h, spread(100.0))), scale), spread(LONGEST))
    h = lesser(h, left)
    store(work, 5, minus(left, h))  # 0 where the span ends
    store(work, 1, plus(passed, h))
    store(work, 3, times(times(h, load(work, 2)), fastest))


def ahead_by(table, order, work):
    """The values of three polynomials after the step, to the rows of degree 0."""
    h, p = load(work, 3), 3 * order
    s0, s1, s2 = load(table, p), load(table, p + 1), load(table, p + 2)
    for n in range(order - 1, -1, -1):
        p = 3 * n
        s0 = times_plus(s0, h, load(table, p))
        s1 = times_plus(s1, h, load(table, p + 1))
        s2 = times_plus(s2, h, load(table, p + 2))
    store(table, 0, s0)
    store(table, 1, s1)
    store(table, 2, s2)


def square(a):
    """|omega|^2 in each lane."""
    x, y, z = load(a, 0), load(a, 1), load(a, 2)
    return times_plus(x, x, times_plus(y, y, times(z, z)))


def run(given, numbers, a, v, work, steps, beside):
    """So many steps of the motions in row 0 to 2 of a and, if `beside`, of the changes in v; fewer where all
    have come to the end of their spans. The greatest and the least |omega|^2 that was met goes to work rows 6
    and 7."""
    store(work, 6, square(a))
    store(work, 7, square(a))
    for number in range(steps):
        to_scale(given, numbers, a, work)
        series(numbers, a)
        if beside:
            series_beside(numbers, a, v)
        length(numbers, a, v, work, beside)
        if beside:
            ahead_by(v, SIDE, work)
        ahead_by(a, ORDER, work)
        store(work, 6, greater(load(work, 6), square(a)))
        store(work, 7, lesser(load(work, 7), square(a)))
        if number % 4 == 3:
            going = False
            for lane in range(work.shape[1]):
                going = going or work[5, lane] > 0.0
            if not going:
                return


def spread_numbers(coefficients, given):
    """The numbers (4, 3) of a scene in all lanes (12, m)."""
    for n in range(12):
        for lane in range(given.shape[1]):
            given[n, lane] = coefficients[n // 3, n % 3]


def carry(coefficients, states, spans, steps, out, reached, given, numbers, a, v, work):
    """Motions from states (n, 3) over spans (n,) of time, forth or back, in at most so many steps: states to
    out, times to reached."""
    spread_numbers(coefficients, given)
    n, wide = spans.size, a.shape[1]
    for first in range(0, n, wide):
        for lane in range(wide):
            row = min(first + lane, n - 1)
            a[0, lane], a[1, lane], a[2, lane] = states[row, 0], states[row, 1], states[row, 2]
            work[0, lane], work[1, lane], work[2, lane] = abs(spans[row]), 0.0, math.copysign(1.0, spans[row])
        run(given, numbers, a, v, work, steps, False)
        for lane in range(min(wide, n - first)):
            row = first + lane
            out[row, 0], out[row, 1], out[row, 2] = a[0, lane], a[1, lane], a[2, lane]
            reached[row] = spans[row] if work[5, lane] <= 0.0 else math.copysign(work[1, lane], spans[row])


def rates_at(c, x, y, z, out):
    """The rates of change at one state; returns (their size, the state's greatest or 1)."""
    out[0] = c[0, 0] * y * z + c[1, 0] * z + c[2, 0] * y + c[3, 0]
    out[1] = c[0, 1] * z * x + c[1, 1] * x + c[2, 1] * z + c[3, 1]
    out[2] = c[0, 2] * x * y + c[1, 2] * y + c[2, 2] * x + c[3, 2]
    return math.sqrt(out[0] * out[0] + out[1] * out[1] + out[2] * out[2]), max(abs(x), abs(y), abs(z), 1.0)


def across(c, states, ahead, row, rate, out):
    """The part of a row's direction `ahead` across its motion (`runs.Twins.start`)."""
    speed, largest = rates_at(c, states[row, 0], states[row, 1], states[row, 2], rate)
    out[0], out[1], out[2] = ahead[row, 0], ahead[row, 1], ahead[row, 2]
    if speed > STILL * largest:
        u, v, w = rate[0] / speed, rate[1] / speed, rate[2] / speed
        along = out[0] * u + out[1] * v + out[2] * w
        out[0], out[1], out[2] = out[0] - along * u, out[1] - along * v, out[2] - along * w
        if max(abs(out[0]), abs(out[1]), abs(out[2])) < LOST:
            x, y, z = w, u, v + 0.1
            out[0], out[1], out[2] = v * z - w * y, w * x - u * z, u * y - v * x
            share = LOST / math.sqrt(out[0] ** 2 + out[1] ** 2 + out[2] ** 2)
            out[0], out[1], out[2] = share * out[0], share * out[1], share * out[2]


def note(c, start, states, row, change, error, rate, growth, most, ahead, blur):
    """What became of a change of size 1 (3,): its part across the motion is the growth, the delay a blur
    (`runs.Twins.compare`)."""
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
    blur[row] += error * most[row] * late
    growth[row] *= far
    most[row] = max(most[row], growth[row])
    if far > 0.0:
        for i in range(3):
            ahead[row, i] = change[i] / far


def advance(coefficients, rows, steps, t_max, pause, step_error, states, clock, growth, most, ahead, blur,
            met, done, rounded, starts, given, numbers, a, v, work, rate, change):
    """Carry rows on by so many steps, or to t_max (to `pause` those before it), and note how a small change
    of each has grown. done, rounded (n,): steps computed and passed; met (2, n): greatest and least |omega|
    on the way. starts: (m, 3) for work."""
    spread_numbers(coefficients, given)
    n, wide = rows.size, a.shape[1]
    for row in rows:
        done[row] += steps
        rounded[row] += steps
    for first in range(0, n, wide):
        for lane in range(wide):
            row = rows[min(first + lane, n - 1)]
            end = min(pause, t_max) if clock[row] < pause else t_max
            across(coefficients, states, ahead, row, rate, change)
            for i in range(3):
                starts[lane, i] = a[i, lane] = states[row, i]
                v[i, lane] = change[i]
            work[0, lane], work[1, lane], work[2, lane] = max(0.0, end - clock[row]), 0.0, 1.0
        run(given, numbers, a, v, work, steps, True)
        for lane in range(min(wide, n - first)):
            row = rows[first + lane]
            end = min(pause, t_max) if clock[row] < pause else t_max
            for i in range(3):
                states[row, i], change[i] = a[i, lane], v[i, lane]
            clock[row] = end if work[5, lane] <= 0.0 else clock[row] + work[1, lane]
            met[0, row], met[1, row] = math.sqrt(work[6, lane]), math.sqrt(work[7, lane])
            start = starts[lane]
            error = step_error * rounded[row] * math.sqrt(start[0] ** 2 + start[1] ** 2 + start[2] ** 2)
            note(coefficients, start, states, row, change, error, rate, growth, most, ahead, blur)


def measure(rows, states, steps, rounded, growth, met, step_error, condition, reach, largest, least):
    """Take note of rows (`follow.Chased`): condition (n,), reach (n,) of the rounding, largest and least (n,
    48) size of the state by doublings of the steps. met (2, n): of `advance`; what it says is used up."""
    for row in rows:
        if growth[row] > condition[row]:
            condition[row] = growth[row]
        x, y, z = states[row, 0], states[row, 1], states[row, 2]
        most = max(abs(x), abs(y), abs(z), 1.0)
        reach[row] = step_error * (1.0 + rounded[row]) * condition[row] * most if rounded[row] > 0.0 else 0.0
        far = math.sqrt(x * x + y * y + z * z)
        doubling, left = 0, (1 + steps[row]) >> 1
        while left:
            doubling, left = doubling + 1, left >> 1
        largest[row, doubling] = max(largest[row, doubling], far, met[0, row])
        least[row, doubling] = min(least[row, doubling], far, met[1, row])
        met[0, row], met[1, row] = 0.0, math.inf


def over(rows, states, clock, done, t_max, budget, out):
    """Which of rows have come to the end of their time or of their steps, or beyond doubles."""
    for n in range(rows.size):
        row = rows[n]
        size = abs(states[row, 0]) + abs(states[row, 1]) + abs(states[row, 2])
        out[n] = clock[row] >= t_max or done[row] >= budget or not size < math.inf
