"""Quantities that other tools print (rates, modified Rodrigues parameters, angles), enclosed in balls, and as
the integrators with a fixed step leave them that the tools seem to use: what of a printed number is its
integrator's error.

A recorded motion is followed by the Taylor series in integers of `integrate.integer_flow`; a body whose
wheels are driven by motors by Taylor series in balls with a proved remainder. With I the moments of the body
and its wheels less the wheels' own about their axes, and h the wheels' whole momenta about these,

    I omega' = -omega x (I omega + h) - u,    h' = u,    n' = n x omega      (u motor torques, n a direction
    at rest in space).

A box about the start that x0 + [0, H] f(box) does not leave holds the motion over the step H; the last Taylor
coefficient over the box bounds the remainder.
"""
from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from operator import mul
from typing import TYPE_CHECKING

from ...answers.attitude import attitude
from ...answers.circular_orbit import circular_orbit
from ...answers.limit import flow_of
from ...case.read import load
from ...numbers.balls import Digits, working
from ...numbers.vectors import CYCLE, cross, dot
from ...physics.own_unit import exact_unit

if TYPE_CHECKING:
    from flint import arb

    from ...integrate.crossing import Piece


def reproduced(printed, time: float, rates=None) -> list[float]:
    """The quantity (omega or sigma) at a time as the method and step of `printed.scheme` leave it. rates: the
    exact ones there, for the leapfrog rule."""
    if printed.scheme["method"] == "rod":
        return [math.sqrt(3) / 2 * float(printed.scheme["of"])]
    motion, step = printed.motion, float(printed.scheme["step"])
    degrees = 180 / math.pi if motion.unit == "deg/s" else 1.0
    if printed.scheme["method"] == "leapfrog":
        return [w * degrees for w in _half_a_step_later(_rates(motion), [w / degrees for w in rates], step)]
    start = [float(w) / degrees for w in motion.omega]
    if printed.quantity == "sigma":
        state = run(_rates_and_attitude(motion), [*map(float, motion.sigma), *start], step,
                    round(time / step), rk4, shortest)
        return state[:3]
    return [w * degrees for w in run(_rates(motion), start, step, round(time / step),
                                     RULES[printed.scheme["method"]])]


def run(rates, state, step, count, rule, after=None) -> list[float]:
    """The state after `count` steps. after: what a tool does to the state at the end of each."""
    memory = None
    for _ in range(count):
        state, memory = rule(rates, state, step, memory)
        state = after(state) if after else state
    return state


def rk4(rates, x, h, _=None):
    """A step of the classical rule of order four."""
    k1 = rates(x)
    k2 = rates([a + h / 2 * b for a, b in zip(x, k1)])
    k3 = rates([a + h / 2 * b for a, b in zip(x, k2)])
    k4 = rates([a + h * b for a, b in zip(x, k3)])
    return [a + h / 6 * (p + 2 * q + 2 * r + s) for a, p, q, r, s in zip(x, k1, k2, k3, k4)], None


def ab2(rates, x, h, before=None):
    """A step of the rule of Adams and Bashforth of order two, the first by Euler's."""
    now = rates(x)
    if before is None:
        return [a + h * b for a, b in zip(x, now)], now
    return [a + h * (1.5 * b - 0.5 * c) for a, b, c in zip(x, now, before)], now


RULES = {"rk4": rk4, "ab2": ab2}
METHOD_LABELS = {"rk4": "the classical Runge-Kutta rule of order 4 at {step} s",
         "ab2": "the Adams-Bashforth rule of order 2, begun by Euler's, at {step} s",
         "leapfrog": "rates at the middle of the next step of {step} s, as a leapfrog rule leaves them (- "
                     "h^2/24 omega'')",
         "rod": "sqrt(3)/2 of the period in plane, {of} s, the ratio of a thin rod,"}


def _half_a_step_later(rates: Callable[[list[float]], list[float]], omega: Sequence[float], step: float):
    """The exact rates half a step later less step^2 omega''/24: what differences over whole steps, centred,
    make of them."""
    (later, _), tiny = rk4(rates, omega, step / 2), step / 8
    ahead, behind = (rates(rk4(rates, later, s)[0]) for s in (tiny, -tiny))
    return [w - step * step / 24 * (a - b) / (2 * tiny) for w, a, b in zip(later, ahead, behind)]


def _rates(motion):
    moments, torque = [float(v) for v in motion.inertia], [float(v) for v in motion.torque]
    return lambda w: [((moments[j] - moments[k]) * w[j] * w[k] + torque[i]) / moments[i]
                      for i, (j, k) in enumerate(CYCLE)]


def _rates_and_attitude(motion):
    spin = _rates(motion)

    def rates(x: Sequence[float]):
        s, w = x[:3], x[3:]
        square, along = sum(v * v for v in s), sum(a * b for a, b in zip(s, w))
        return [*(0.25 * ((1 - square) * a + 2 * b + 2 * along * c) for a, b, c in zip(w, cross(s, w), s)),
                *spin(w)]
    return rates


def shortest(state) -> list[float]:
    """The parameters of the same attitude that are within the unit sphere."""
    square = sum(v * v for v in state[:3])
    return [-v / square for v in state[:3]] + state[3:] if square > 1 else state


BITS, ORDER, STEP = 256, 30, Fraction(1, 16)
RPM = Fraction(6000)  # the speed at which a wheel has its nominal momentum


def wheels_at(motion, times) -> list:
    """[(rates, turned rows)] at increasing times (rationals, s), as of `At`."""
    result, wheels = [], motion.wheels
    with working(BITS) as numbers:
        # moment of a wheel about its axis
        own = numbers.ball(wheels.momentum) / (numbers.ball(RPM) * numbers.pi() / 30)
        moments = [numbers.ball(v) - own for v in motion.inertia]
        omega = [numbers.ball(v) for v in motion.omega]
        momenta = [own * (numbers.ball(v) * numbers.pi() / 30 + w) for v, w in zip(wheels.speed, omega)]
        state, now = omega + momenta + [numbers.ball(int(i == k)) for k in range(3)
                                        for i in range(3)], Fraction(0)
        for until in times:
            while now < until:
                driven = now < wheels.until
                step = min(STEP, until - now, *([wheels.until - now] if driven else []))
                motor = [numbers.ball(v if driven else 0) for v in wheels.motor]
                state, now = _step(moments, motor, state, numbers.ball(step)), now + step
            result.append((tuple(state[:3]),
                          tuple(tuple(state[6 + 3 * k + i] for k in range(3)) for i in range(3))))
    return result


def _step(moments: Sequence[arb], motor: Sequence[arb], state: Sequence[arb], length: arb):
    from flint import arb
    within, box = arb(length / 2, length / 2), state
    while True:
        wider = [x + within * rate
                 for x, rate in zip(state, (row[1] for row in _series(moments, motor, box, 1)))]
        if all(b.contains(w) for b, w in zip(box, wider)):
            break
        box = [arb(w.mid(), w.rad() * 1.25 + arb(2) ** -80) for w in wider]
    rows, last = _series(moments, motor, state, ORDER - 1), _series(moments, motor, box, ORDER)
    result = []
    for row, beyond in zip(rows, last):
        total = beyond[ORDER]
        for c in reversed(row):
            total = total * length + c
        result.append(total)
    return result


def _series(moments: Sequence[arb], motor: Sequence[arb], state: Sequence[arb], order: int):
    """Taylor coefficients 0..order of every component."""
    rows = [[v] for v in state]
    product = lambda a, b, n: sum(map(mul, rows[a], reversed(rows[b][:n + 1])))
    for n in range(order):
        new = []
        for i, (j, k) in enumerate(CYCLE):
            turn = product(j, k, n) * (moments[k] - moments[j]) + product(j, 3 + k, n) - product(k, 3 + j, n)
            new.append((-turn - (motor[i] if n == 0 else 0)) / moments[i] / (n + 1))
        new += [motor[i] if n == 0 else motor[i] * 0 for i in range(3)]
        for start in (6, 9, 12):
            new += [(product(start + j, k, n) - product(start + k, j, n)) / (n + 1) for j, k in CYCLE]
        for row, value in zip(rows, new):
            row.append(value)
    return rows


# bits at first; that the enclosure is to keep; beyond what the error grew by
FIRST_BITS, KEPT, SPARE = 112, 60, 48
BALL_BITS = 400  # of what is formed from an enclosure
UNITS = ((1, 0, 0), (0, 1, 0))  # directions at rest in space, body frame; the third by their cross product


@dataclass(frozen=True)
class At:
    """The motion at a time (s): rates in rad/s (3 balls), and how space has turned, body frame: rows (3, 3)
    of balls, the columns being what the body's axes of the start have become."""

    time: Fraction
    omega: tuple = ()
    turned: tuple = ()


def at(motion, times) -> list[At]:
    """The motion at increasing times (rationals, s); a case that is asked as it stands is not followed."""
    if motion.case:
        return [At(time) for time in times]
    if motion.wheels:
        return [At(time, *result) for time, result in zip(times, wheels_at(motion, times))]
    runs = [_run(motion, times, axis) for axis in UNITS]
    with working(BALL_BITS):
        return [At(time, tuple(item[0]), _rows(item[1], two[1])) for time, item, two in zip(times, *runs)]


def _rows(first: Sequence[arb], second: Sequence[arb]):
    columns = first, second, cross(first, second)
    return tuple(tuple(column[i] for column in columns) for i in range(3))


def _run(motion, times, axis):
    """[(rates, direction)] at the times, as many bits as it takes."""
    bits = FIRST_BITS
    while True:
        result, lost = _attempt(motion, times, axis, bits)
        if bits - lost >= KEPT:
            return result
        bits = lost + KEPT + SPARE


def _attempt(motion, times, axis, bits):
    scene = motion.scene
    unit = exact_unit(scene, motion.omega)
    flow = flow_of(scene, motion.omega, bits, unit, tuple(map(Fraction, axis)))
    result, lost = [], 0
    with working(BALL_BITS) as numbers:
        # of a unit of omega; a free motion runs so much faster
        rate = numbers.pi() / 180 if motion.unit == "deg/s" else numbers.ball(1)
        waiting = [(numbers.ball(t) - numbers.ball(motion.begins)) * numbers.ball(unit) * rate for t in times]
        while len(result) < len(waiting):
            piece = flow.step()
            while len(result) < len(waiting) and waiting[len(result)] < numbers.ball(flow.now):
                values = values_of(piece, waiting[len(result)], numbers)
                result.append(([v * numbers.ball(unit) * rate for v in values[:3]], values[3:]))
                lost = max(lost, *(r.bit_length() for r in piece.radii))
            if flow.error.bit_length() > 900 - 64:
                return result, flow.error.bit_length()
    return result, lost


def values_of(piece: Piece, now: arb, numbers: Digits) -> list:
    """The components of a piece at a time of the motion's own, a ball; balls, while `numbers` is the working
    kind."""
    from flint import arb
    s, scale, result = (now
                       - numbers.ball(piece.start)) / numbers.ball(piece.length), arb(2) ** -piece.bits, []
    for row, radius in zip(piece.rows, piece.radii):
        total = arb(0)
        for c in reversed(row):
            total = total * s + c
        result.append((total + arb(0, radius)) * scale)
    return result


DEGREES = "deg/s"
DAY, HOUR = 86400, 3600  # s
CLOSED = Fraction(1, 10**12)  # of a number in doubles from a closed form: far more than it is off


def rotation_period(motion, at: At, numbers) -> list:
    """The period of rotation of a free body, h."""
    return [_closed(attitude(load(motion.case)).rotation_period / HOUR, numbers)]


def half_precession(motion, at: At, numbers) -> list:
    """The time in which the axis of a free symmetric body precesses by half a turn, s."""
    return [_closed(attitude(load(motion.case)).precession_period / 2, numbers)]


def libration_periods(motion, at: At, numbers) -> list:
    """The longer two periods of the first stable attitude on a circular orbit, days."""
    first = circular_orbit(motion.case).equilibria.points[0]
    return [_closed(2 * math.pi / rate / DAY, numbers) for rate in first.frequencies[:2]]


def rotation_and_precession(motion, at: At, numbers) -> list:
    """The periods with which the rates of a free body repeat and its axis goes round the momentum, s."""
    result = attitude(load(motion.case))
    return [_closed(value, numbers, result.error)
            for value in (result.rotation_period, result.precession_period)]


def cone(motion, at: At, numbers) -> list:
    """The largest angle between the axis of the mode and the angular momentum, deg."""
    result = attitude(load(motion.case))
    return [_closed(math.degrees(result.cone[1]), numbers, result.error)]


def libration_in_plane(motion, at: At, numbers) -> list:
    """The longer period of the first stable family of attitudes on a circular orbit, s: it is in plane."""
    return [_closed(2 * math.pi / _librations(motion)[0], numbers)]


def libration_out_of_plane(motion, at: At, numbers) -> list:
    """The shorter one, out of plane."""
    return [_closed(2 * math.pi / _librations(motion)[1], numbers)]


def _librations(motion):
    return circular_orbit(motion.case).equilibria.families[0].frequencies


def _closed(value: float, numbers: Digits, error: float = 0.0):
    """A ball about a number in doubles; error: relative, where it is larger than that of a closed form."""
    share = max(CLOSED, Fraction(error))
    return numbers.around(numbers.ball(Fraction(value)), numbers.ball(Fraction(value) * share))


def omega(motion, at: At, numbers) -> list:
    """Rates in the unit that the motion is given in."""
    return [w * 180 / numbers.pi() if motion.unit == DEGREES else w for w in at.omega]


def sigma(motion, at: At, numbers) -> list:
    """Modified Rodrigues parameters of the attitude, of the rotation by less than half a turn."""
    start = _start(motion, numbers)
    c = [[sum(row[m] * start[m][k] for m in range(3)) for k in range(3)] for row in at.turned]
    twice = (1 + c[0][0] + c[1][1] + c[2][2]).sqrt()  # 2 cos(half the angle)
    return [(c[j][k] - c[k][j]) / (2 * twice) / (1 + twice / 2) for j, k in ((1, 2), (2, 0), (0, 1))]


def _start(motion, numbers):
    """Rows (3, 3) of the matrix that takes components in space to those in the body at the start."""
    if motion.against_momentum:
        return _against_momentum(motion, numbers)
    s = [numbers.ball(v) for v in motion.sigma]
    square = dot(s, s)
    columns = []
    for k in range(3):
        e = [numbers.ball(int(i == k)) for i in range(3)]
        once = cross(s, e)
        twice = cross(s, once)
        columns.append([a + (8 * c - 4 * (1 - square) * b) / (1 + square) ** 2
                        for a, b, c in zip(e, once, twice)])
    return [[column[i] for column in columns] for i in range(3)]


def _against_momentum(motion, numbers):
    third = _unit([-numbers.ball(m * w) for m, w in zip(motion.inertia, motion.omega)])
    second = _unit([-third[1] / third[0], numbers.ball(1), numbers.ball(0)])
    first = _unit(cross(second, third))
    return [[column[i] for column in (first, second, third)] for i in range(3)]


def _unit(vector: Sequence[arb]):
    length = dot(vector, vector).sqrt()
    return [v / length for v in vector]


def rate3(motion, at: At, numbers) -> list:
    """The rate about axis 3."""
    return [at.omega[2]]


def angle3(motion, at: At, numbers) -> list:
    """The angle about axis 3, turned at a constant rate until the motion begins, and by less than half a turn
    from then on."""
    return [numbers.ball(motion.omega[2] * motion.begins) + numbers.angle(-at.turned[1][0], at.turned[0][0])]


def off_linear(motion, at: At, numbers) -> list:
    """The angle between the attitude and that of a rotation at the initial rate."""
    w = [numbers.ball(v) for v in motion.omega]
    size = dot(w, w).sqrt()
    axis, turn = [v / size for v in w], -size * numbers.ball(at.time)
    trace = numbers.ball(0)
    for k in range(3):
        e = [numbers.ball(int(i == k)) for i in range(3)]
        linear = [a * turn.cos() + b * turn.sin() + n * axis[k] * (1 - turn.cos())
                  for a, b, n in zip(e, cross(axis, e), axis)]
        trace += sum(a * row[k] for a, row in zip(linear, at.turned))
    return [2 * ((3 - trace) / 4).sqrt().asin()]


def momentum_turn(motion, at: At, numbers) -> list:
    """The angle between the angular momentum in space and that of the start; zero by theory, and here at most
    the width of the enclosure."""
    start = [numbers.ball(m * w) for m, w in zip(motion.inertia, motion.omega)]
    body = [numbers.ball(m) * w for m, w in zip(motion.inertia, at.omega)]
    space = [sum(at.turned[i][k] * body[i] for i in range(3)) for k in range(3)]
    across = sum(v * v for v in cross(start, space))
    return [numbers.around(numbers.ball(0),
                           (numbers.upper(across).sqrt() / sum(v * v for v in start)).asin())]
