"""Integrators with a fixed step, in doubles as the tools run them: to show what of a printed number is its
integrator's error."""
from __future__ import annotations

import math

from ...numbers.vectors import CYCLE
from .enclose import cross


def reproduced(printed, time: float, rates=None) -> list[float]:
    """The quantity (omega or sigma) at a time as the method and step of `printed.cause` leave it. rates: the
    exact ones there, for the leapfrog rule."""
    motion, step = printed.motion, float(printed.cause["step"])
    degrees = 180 / math.pi if motion.unit == "deg/s" else 1.0
    if printed.cause["method"] == "leapfrog":
        return [w * degrees for w in _half_a_step_later(_rates(motion), [w / degrees for w in rates], step)]
    start = [float(w) / degrees for w in motion.omega]
    if printed.quantity == "sigma":
        state = run(_rates_and_attitude(motion), [*map(float, motion.sigma), *start], step,
                    round(time / step), rk4, shortest)
        return state[:3]
    return [w * degrees for w in run(_rates(motion), start, step, round(time / step),
                                     RULES[printed.cause["method"]])]


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
WORDS = {"rk4": "the classical Runge-Kutta rule of order 4 at {step} s",
         "ab2": "the Adams-Bashforth rule of order 2, begun by Euler's, at {step} s",
         "leapfrog": "rates at the middle of the next step of {step} s, as a leapfrog rule leaves them (- "
                     "h^2/24 omega'')"}


def _half_a_step_later(rates, omega, step):
    """The exact rates half a step later less step^2 omega''/24: what differences over whole steps, centred,
    make of them."""
    (later, _), tiny = rk4(rates, omega, step / 2), step / 8
    ahead, behind = (rates(rk4(rates, later, s)[0]) for s in (tiny, -tiny))
    return [w - step * step / 24 * (a - b) / (2 * tiny) for w, a, b in zip(later, ahead, behind)]


def _rates(motion):
    moments, torque = [float(v) for v in motion.inertia], [float(v) for v in motion.torque]
    return lambda w: [((moments[j] - moments[k]) * w[j] * w[k] + torque[i]) / moments[i] for i,
                      (j, k) in enumerate(CYCLE)]


def _rates_and_attitude(motion):
    spin = _rates(motion)

    def rates(x):
        s, w = x[:3], x[3:]
        square, along = sum(v * v for v in s), sum(a * b for a, b in zip(s, w))
        return [*(0.25 * ((1 - square) * a + 2 * b + 2 * along * c) for a, b, c in zip(w, cross(s, w), s)),
                *spin(w)]
    return rates


def shortest(state) -> list[float]:
    """The parameters of the same attitude that are within the unit sphere."""
    square = sum(v * v for v in state[:3])
    return [-v / square for v in state[:3]] + state[3:] if square > 1 else state
