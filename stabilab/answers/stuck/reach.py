"""The first time at which the rate reaches its limit, and the largest rate before: by roots of the steps' own polynomials.

A run in doubles follows the motion, and three more that start a little aside (along each axis): by how much the time moves with the start says what
the run's rounding, step by step, may have done to it, and so how wide the bracket of the time is.
"""
from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ...integrate.to_heyoka import heyoka_available, taylor_events
from ...numbers.vectors import CYCLE
from ...physics.to_numpy import Form
from ...unreduced.spin_up.fields import natural

ASIDE = 2.0**-30  # of the neighbours' starts, relative to the state or the natural rate
ROUNDING = 2.0**-50  # a step may move the motion by so much of its size: four units of rounding
UNSURE = 1e-3  # of the time: a bracket wider than this tells nothing
CHUNK = 256  # steps between two looks at what was found


@dataclass(frozen=True)
class Reached:
    """time: (low, high) of the first time at the limit, s, or None where it is not reached (or `unsure`) until `followed`; largest: |omega| up to that
    time or to the end, rad/s."""

    time: tuple[float, float] | None
    largest: float
    followed: float
    steps: int
    unsure: str = ""


def reach(scene, state, limit, rows, t_max: float, budget: int) -> Reached:
    """Follow the motion until |omega| = limit (or |component n| = limit[n] along rows[n]), to t_max (s) at the most, in `budget` steps.

    state: three floats, scene's axes; limit: rad/s, a number, three, or None (then the run goes to t_max); rows: (3, 3) the axes of the
    file's frame in the scene's.
    """
    own, unit = natural(scene)
    size = max(1.0, *(abs(v) / unit for v in state))
    limits = None if limit is None else tuple(v / unit for v in (limit if isinstance(limit, tuple) else (limit,)))
    start = [v / unit for v in state]
    if limits is not None and _passed(start, limits, rows):
        return Reached((0.0, 0.0), math.hypot(*state), 0.0, 0)
    first = _run(own, start, limits, rows, t_max * unit, budget)
    if first.t is None:
        return Reached(None, first.largest * unit, first.end / unit, first.steps)
    moved = []
    for i in range(3):
        aside = list(start)
        aside[i] += ASIDE * size
        other = _run(own, aside, limits, rows, min(t_max * unit, 1.01 * first.t + 1e-3), 2 * first.steps + CHUNK)
        moved.append(math.inf if other.t is None else abs(other.t - first.t))
    half = ROUNDING * (1 + first.steps) * (sum(moved) / ASIDE + first.t)
    largest, followed = first.largest * unit, first.t / unit
    if not half < UNSURE * first.t:
        unsure = f"a run comes to the limit at about {followed:.6g} s, and its rounding may have moved that by more than a thousandth"
        return Reached(None, largest, followed, first.steps, unsure)
    return Reached(((first.t - half) / unit, (first.t + half) / unit), largest, followed, first.steps)


def first_time(scene, state, limit, rows, t_max: float, budget: int) -> float:
    """The time at which a plain run first comes to its limit, s; inf where not until t_max or in `budget` steps. For searches: without a bracket."""
    own, unit = natural(scene)
    limits = tuple(v / unit for v in (limit if isinstance(limit, tuple) else (limit,)))
    start = [v / unit for v in state]
    if _passed(start, limits, rows):
        return 0.0
    found = _run(own, start, limits, rows, t_max * unit, budget).t
    return math.inf if found is None else found / unit


def _passed(state, limits, rows) -> bool:
    if len(limits) == 1:
        return math.hypot(*state) >= limits[0]
    return any(abs(sum(r * v for r, v in zip(row, state))) >= most for row, most in zip(rows, limits))


@dataclass(frozen=True)
class _Run:
    t: float | None
    largest: float
    end: float
    steps: int


def _run(scene, start, limits, rows, t_max, budget) -> _Run:
    return (_taylor if heyoka_available() else _scipy)(scene, start, limits, rows, t_max, budget)


def _taylor(scene, start, limits, rows, t_max, budget):
    components = limits is not None and len(limits) == 3
    numbers = [*sum(zip(*scene.quadratic().coefficients), ()), *_event_numbers(limits, rows, components)]
    state, symbols, expressions = _structure(components)
    largest, steps = math.hypot(*start), 0
    with taylor_events(Form(state, expressions, symbols, tuple(numbers))) as (ta, found), np.errstate(all="ignore"):
        ta.time, ta.state[:] = 0.0, start
        while steps < budget and ta.time < t_max and np.isfinite(ta.state).all():
            outcome, _, _, done, *_ = ta.propagate_until(t_max, max_steps=min(CHUNK, budget - steps))
            steps += max(done, 1)
            hits = [h for h in found if h[1] > 0 and limits is not None and h[0] > 0]
            t = min((h[0] for h in hits), default=None)
            passed = [h for h in found if h[1] == 0 and (t is None or h[0] <= t)] + [h for h in hits if h[0] == t]
            largest = max([largest, *(float(np.linalg.norm(h[2])) for h in passed if np.isfinite(h[2]).all())])
            if t is not None:
                return _Run(t, largest, t, steps)
            found.clear()
        end = float(np.linalg.norm(ta.state))
        return _Run(None, max(largest, end) if math.isfinite(end) else largest, float(ta.time), steps)


def _event_numbers(limits, rows, components):
    if limits is None:
        return [-1.0]  # |omega|^2 + 1 has no root
    squares = [v * v for v in limits]
    return [*(v for row in rows for v in row), *squares] if components else squares


@lru_cache(maxsize=2)
def _structure(components):
    """State, coefficients, and rates followed by events: where |omega| is stationary, and where it (or a component) is at its limit."""
    from sympy import symbols
    x, c, extra = symbols("x1:4", real=True), symbols("c0:12", real=True), symbols(f"e0:{12 if components else 1}", real=True)
    rates = [c[4 * i] * x[j] * x[k] + c[4 * i + 1] * x[k] + c[4 * i + 2] * x[j] + c[4 * i + 3] for i, (j, k) in enumerate(CYCLE)]
    # x . x' without its cubic terms: these cancel for no form of rates in general, so they stay
    turning = sum(v * rate for v, rate in zip(x, rates))
    if components:
        events = [sum(extra[3 * n + i] * x[i] for i in range(3)) ** 2 - extra[9 + n] for n in range(3)]
    else:
        events = [sum(v * v for v in x) - extra[0]]
    return x, (*c, *extra), (*rates, turning, *events)


def _scipy(scene, start, limits, rows, t_max, budget):
    """Where heyoka is not installed: roots of SciPy's interpolant."""
    from scipy.integrate import solve_ivp
    rate = scene.quadratic().rate
    t_max = min(t_max, 1e6)

    def at_limit(t, y):
        if limits is None:
            return 1.0
        if len(limits) == 1:
            return float(y @ y) - limits[0] ** 2
        return max(abs(float(np.dot(row, y))) - most for row, most in zip(rows, limits))

    def turning(t, y):
        return float(np.dot(y, rate(y.tolist())))
    at_limit.terminal = True
    run = solve_ivp(lambda t, y: rate(y.tolist()), (0.0, t_max), start, "DOP853", rtol=3e-14, atol=1e-16, events=(at_limit, turning))
    sizes = [math.hypot(*start), math.hypot(*run.y[:, -1]), *(math.hypot(*y) for y in run.y_events[1])]
    t = float(run.t_events[0][0]) if len(run.t_events[0]) else None
    return _Run(t, max(sizes), float(run.t[-1]), 100 * len(run.t))
