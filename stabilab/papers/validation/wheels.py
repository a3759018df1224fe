"""A body whose wheels are driven by motors, enclosed: Taylor series in balls with a proved remainder.

With I the moments of the body and its wheels less the wheels' own about their axes, and h the wheels' whole
momenta about these,

    I omega' = -omega x (I omega + h) - u,    h' = u,    n' = n x omega      (u motor torques, n a direction
    at rest in space).

A box about the start that x0 + [0, H] f(box) does not leave holds the motion over the step H; the last Taylor
coefficient over the box bounds the remainder.
"""
from __future__ import annotations

from fractions import Fraction
from operator import mul

from ...numbers.balls import working
from ...numbers.vectors import CYCLE

BITS, ORDER, STEP = 256, 30, Fraction(1, 16)
RPM = Fraction(6000)  # the speed at which a wheel has its nominal momentum


def wheels_at(motion, times) -> list:
    """[(rates, turned rows)] at increasing times (rationals, s), as of `enclose.At`."""
    found, wheels = [], motion.wheels
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
            found.append((tuple(state[:3]),
                          tuple(tuple(state[6 + 3 * k + i] for k in range(3)) for i in range(3))))
    return found


def _step(moments, motor, state, length):
    from flint import arb
    within, box = arb(length / 2, length / 2), state
    while True:
        wider = [x + within * rate for x,
                 rate in zip(state, (row[1] for row in _series(moments, motor, box, 1)))]
        if all(b.contains(w) for b, w in zip(box, wider)):
            break
        box = [arb(w.mid(), w.rad() * 1.25 + arb(2) ** -80) for w in wider]
    rows, last = _series(moments, motor, state, ORDER - 1), _series(moments, motor, box, ORDER)
    found = []
    for row, beyond in zip(rows, last):
        total = beyond[ORDER]
        for c in reversed(row):
            total = total * length + c
        found.append(total)
    return found


def _series(moments, motor, state, order):
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
