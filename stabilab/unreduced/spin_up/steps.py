"""Taylor steps of motions side by side, and of a small change of each, that numba compiles.

w_i' = kappa_i w_j w_k + rho_i w_k + sigma_i w_j + m_i (cyclic). The motions go in LANES: one where the text
runs as it is written, eight where it is compiled: what a step does to a lane, from its state to its next one,
is a straight line of operations, so that a processor does each of them to all lanes at once. A lane whose
motion is at its end takes the next one. No lane reads another, and all do the same operations in the same
order: the bits of a motion depend neither on its neighbours nor on how many lanes there are.

The line has a name for every coefficient (`x1_7`: of s^7 of w_2; `v1_7` of its change), for a coefficient in
a name stays in a register, and an entry of an array does not. `written_out` writes it, from the same sums
over degrees that stand in a book. s is the time over `scale`, a power of two near the fastest rate, so that
no coefficient overflows.

The change v of a motion obeys the equation made linear. It is known to a few per cent, so its series ends at
degree SIDE: over a step, a seventh of the radius of convergence, that leaves out 3e-7 of it.

Coefficients of a motion that hardly leaves a steady one say nothing of how fast a change there grows: beside
a saddle, 1e-45 away, they allow a step over which it grows e^100 times. So a step is no longer than the
change's own last coefficients allow, nor than a few times what the slopes of the rates allow.
"""
from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

ORDER, SIDE = 20, 8
LANES = 1
SIDE_BY_SIDE = 8  # of compiled code: doubles of the widest vectors there are
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
# bits of a double's exponent and fraction, and of 1.0
EXPONENT, FRACTION, ONE = 0x7FF0000000000000, 0x000FFFFFFFFFFFFF, 0x3FF0000000000000
# a motion leaves its lane to others that wait after such a part of the steps, but not before so many
PART, AT_LEAST = 0.25, 16
# Rows of the memory of a run, LANES numbers each: state, change, what is left of the span and what has
# passed, the sign of both, the greatest, the least and the last |omega|^2, the steps due, how many of these
# are left to later. Behind them stand the coefficients of the equations, twelve numbers for all lanes.
STATE, CHANGE, LEFT, PASSED, SIGN, LARGEST, SMALLEST, NOW, DUE, LATER, EQUATIONS = (
    0, 3, 6, 7, 8, 9, 10, 11, 12, 13, 14)


def power_of_two(size: float):
    """The greatest power of two that is no greater than a positive number."""
    return float(np.int64(np.float64(size).view(np.int64) & EXPONENT).view(np.float64))


def logarithm(size: float):
    """Of a positive number to the base 2: exact at powers of 2, linear between them, so at most 0.09 below;
    1024 of infinity."""
    bits = np.float64(size).view(np.int64)
    return float(np.int64(bits & FRACTION | ONE).view(np.float64)) + (float(bits >> 52) - 1024.0)


def two_to(exponent: float):
    """2^y for |y| < 1022, within 0.3 per cent; exact for whole y."""
    whole = math.floor(exponent)
    part = exponent - whole
    power = float(np.int64((int(whole) + 1023) << 52).view(np.float64))
    return (1.0 + part * (0.6565 + 0.3435 * part)) * power


def written_out() -> str:
    """The text of `step_ahead`: see above."""
    cycle = (0, 1, 2), (1, 2, 0), (2, 0, 1)
    lines: list[str] = []
    write = lines.append
    for n, name in enumerate("krsm"):
        lines += [f"{name}{i} = memory[EQUATIONS * LANES + {3 * n + i}]" for i in range(3)]
    write("for lane in range(LANES):")
    for i in range(3):
        lines += [f" x{i}_0 = memory[{i} * LANES + lane]", f" v{i}_0 = memory[(CHANGE + {i}) * LANES + lane]"]
    write(" fastest = max(abs(x0_0), abs(x1_0), abs(x2_0), 1.0)")
    write(" scale = power_of_two(fastest if fastest < 1e300 else 1e300)")
    write(" unit = 1.0 / scale")
    # in the time of the lane: kappa, rho, sigma and m are K, R, S and M
    lines += [f" {name.upper()}{i} = {name}{i} * unit" for name in "krsm" for i in range(3)]
    for n in range(ORDER):
        constant = "" if n else " + M{i}"
        for i, y, z in cycle:
            products = " + ".join(f"x{y}_{m}*x{z}_{n - m}" for m in range(n + 1))
            write(f" x{i}_{n + 1} = (K{i}*({products}) + R{i}*x{z}_{n} + S{i}*x{y}_{n}{constant.format(i=i)})"
                  f" * {1 / (n + 1)!r}")
    for n in range(SIDE):
        for i, y, z in cycle:
            products = " + ".join(f"(x{y}_{m}*v{z}_{n - m} + v{y}_{n - m}*x{z}_{m})" for m in range(n + 1))
            write(f" v{i}_{n + 1} = (K{i}*({products}) + R{i}*v{z}_{n} + S{i}*v{y}_{n}) * {1 / (n + 1)!r}")
    # the greatest sum of sizes in a row of the rates' derivative
    slopes = (f"abs(K{i}*x{z}_0 + S{i}) + abs(K{i}*x{y}_0 + R{i})" for i, y, z in cycle)
    write(f" step = min(STEEP - logarithm(max({', '.join(slopes)}, 1e-290)), 100.0)")
    for x, order, smallest, tail in ("x", ORDER, 1.0, "TAIL"), ("v", SIDE, 1e-200, "START_EXPONENT"):
        # each of the last two coefficients adds at most its part to the state, or to what stands for it
        size, last, before = (f"logarithm(max(abs({x}0_{n}), abs({x}1_{n}), abs({x}2_{n}), {bound}))"
                              for n, bound in ((0, smallest), (order, 1e-290), (order - 1, 1e-290)))
        write(f" room = {size} + {tail}")
        write(f" step = min(step, (room - {last}) / {order}, (room - {before}) / {order - 1})")
    write(" step = min(two_to(step) / scale, LONGEST, memory[LEFT * LANES + lane])")
    write(" memory[PASSED * LANES + lane] += step")
    write(" memory[LEFT * LANES + lane] -= step")
    write(" ahead = step * scale * memory[SIGN * LANES + lane]")
    for x, order, row in ("v", SIDE, "CHANGE"), ("x", ORDER, "STATE"):
        for i in range(3):
            value = f"{x}{i}_{order}"
            for n in reversed(range(order)):
                value = f"({value}*ahead + {x}{i}_{n})"
            lines += [f" {x}{i} = {value}", f" memory[({row} + {i}) * LANES + lane] = {x}{i}"]
    write(" now, most = x0*x0 + x1*x1 + x2*x2, memory[LARGEST * LANES + lane]")
    write(" least = memory[SMALLEST * LANES + lane]")
    write(" memory[NOW * LANES + lane] = now")
    write(" memory[LARGEST * LANES + lane] = now if now > most else most")
    write(" memory[SMALLEST * LANES + lane] = now if now < least else least")
    write(" memory[DUE * LANES + lane] -= 1.0")
    return "def step_ahead(memory):\n" + "".join(f" {line}\n" for line in lines)


def _made(text: str, name: str) -> Callable[..., None]:
    """A function of this module from its text. It bears this file's name, by which numba keeps its code."""
    names = dict(globals())
    exec(compile(text, __file__, "exec"), names)
    return names[name]


step_ahead = _made(written_out(), "step_ahead")  # one step of every lane


def ended(memory: np.ndarray, lane: int):
    """Whether a lane's motion is at the end of its span, of its steps, or beyond doubles."""
    return not (memory[LEFT * LANES + lane] > 0.0 and memory[NOW * LANES + lane] < math.inf
                and memory[DUE * LANES + lane] > 0.0)


def load(memory: np.ndarray, lane: int, row: int, states: np.ndarray, changes: np.ndarray, spans: np.ndarray,
         left: np.ndarray, due: np.ndarray, reached: np.ndarray, met: np.ndarray):
    """A row of motions into a lane, with all steps that are due to it."""
    for i in range(3):
        memory[(STATE + i) * LANES + lane] = states[row, i]
        memory[(CHANGE + i) * LANES + lane] = changes[row, i]
    memory[LEFT * LANES + lane], memory[PASSED * LANES + lane] = left[row], reached[row]
    memory[SIGN * LANES + lane] = math.copysign(1.0, spans[row])
    memory[LARGEST * LANES + lane], memory[SMALLEST * LANES + lane] = met[0, row], met[1, row]
    memory[NOW * LANES + lane], memory[DUE * LANES + lane] = 0.0, float(due[row])


def unload(memory: np.ndarray, lane: int, row: int, states: np.ndarray, changes: np.ndarray,
           left: np.ndarray, due: np.ndarray, reached: np.ndarray, met: np.ndarray):
    """What has become of it so far."""
    for i in range(3):
        states[row, i] = memory[(STATE + i) * LANES + lane]
        changes[row, i] = memory[(CHANGE + i) * LANES + lane]
    left[row], reached[row] = memory[LEFT * LANES + lane], memory[PASSED * LANES + lane]
    met[0, row], met[1, row] = memory[LARGEST * LANES + lane], memory[SMALLEST * LANES + lane]
    due[row] = int(memory[DUE * LANES + lane])


def waiting(due: np.ndarray, row: int):
    """The next row after one, from the first again, that has steps due and is in no lane; -1 for none."""
    for _ in range(due.size):
        row = row + 1 if row + 1 < due.size else 0
        if due[row] > 0:
            return row
    return -1


def run(coefficients: np.ndarray, states: np.ndarray, changes: np.ndarray, spans: np.ndarray, due: np.ndarray,
        left: np.ndarray, reached: np.ndarray, met: np.ndarray, memory: np.ndarray, held: np.ndarray):
    """Up to so many steps due (n,), over spans (n,) of time (back where negative), of motions from states (n,
    3) and of changes (n, 3) of them, all in their place, with what is left of the spans; the times that have
    passed to reached (n,), the greatest and the least |omega|^2 that was met to met (2, n). memory: its rows,
    see above; held (LANES,): the row whose motion a lane has (-1: none), both to work in.

    Motions take turns, so that all lanes have one to the end: ten of them would fill eight lanes once and two
    lanes a second time."""
    for n in range(4):
        for i in range(3):
            memory[EQUATIONS * LANES + 3 * n + i] = coefficients[n, i]
    for lane in range(LANES):
        held[lane], memory[LEFT * LANES + lane] = -1, 0.0
    for row in range(spans.size):
        left[row], reached[row] = abs(spans[row]), 0.0
        met[0, row] = met[1, row] = (states[row, 0] * states[row, 0] + states[row, 1] * states[row, 1]
                                     + states[row, 2] * states[row, 2])
    largest = 0
    for row in range(spans.size):
        largest = max(largest, due[row])
    part = max(PART * largest, AT_LEAST) if spans.size > LANES > 1 else math.inf
    following, busy = -1, spans.size
    while True:
        for lane in range(LANES):
            if not ended(memory, lane) and memory[DUE * LANES + lane] > memory[LATER * LANES + lane]:
                continue
            row = held[lane]
            if row >= 0:
                unload(memory, lane, row, states, changes, left, due, reached, met)
                if ended(memory, lane):
                    reached[row] = spans[row] if left[row] <= 0.0 else math.copysign(reached[row], spans[row])
                    due[row], busy = 0, busy - 1
            row = held[lane] = waiting(due, following)
            if row >= 0:
                load(memory, lane, row, states, changes, spans, left, due, reached, met)
                memory[LATER * LANES + lane] = max(due[row] - part, 0.0)
                following, due[row] = row, 0
            else:  # it stands still, and is never at its end
                for n in range(EQUATIONS):
                    memory[n * LANES + lane] = 0.0
                memory[LEFT * LANES + lane] = memory[DUE * LANES + lane] = math.inf
        if busy == 0:
            break
        step_ahead(memory)


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
            smallest: np.ndarray, clock: np.ndarray, t_max: float, budget: int, over: np.ndarray):
    """Take note of rows (`follow.Chased`): condition (n,), reach (n,) of the rounding, largest and least (n,
    48) size of the state by doublings of the steps. met (2, n): of `advance`; what it says is used up. over
    (m,): which of rows have come to the end of their time or of their steps, or beyond doubles."""
    for n in range(rows.size):
        row = rows[n]
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
        over[n] = clock[row] >= t_max or steps[row] >= budget or not abs(x) + abs(y) + abs(z) < math.inf


def advance(coefficients: np.ndarray, rows: np.ndarray, steps: int, t_max: float, pause: float, budget: int,
            step_error: float, states: np.ndarray, clock: np.ndarray, ahead: np.ndarray, growth: np.ndarray,
            largest: np.ndarray, blur: np.ndarray, lengths: np.ndarray, done: np.ndarray, rounded: np.ndarray,
            ends: np.ndarray, times: np.ndarray, met: np.ndarray, due: np.ndarray, work: np.ndarray,
            memory: np.ndarray, held: np.ndarray):
    """Carry rows (m,) on by so many steps, or to t_max, as `begin`, `run` and `end` have it, and none beyond
    the budget of steps. ends (2, m, 3), times (3, m), met (2, m), due (2, m), work (3, 3), memory, held: to
    work in."""
    for n in range(rows.size):
        due[0, n] = due[1, n] = min(max(budget - done[rows[n]], 1), steps)
    begin(coefficients, rows, t_max, pause, states, clock, ahead, ends[0], ends[1], times[0], work[0],
          work[1])
    run(coefficients, ends[0], ends[1], times[0], due[0], times[1], times[2], met, memory, held)
    end(coefficients, rows, due[1], t_max, pause, step_error, ends[0], ends[1], times[0], times[2], met,
        states, clock, growth, largest, ahead, blur, lengths, done, rounded, work[0], work[1], work[2])
