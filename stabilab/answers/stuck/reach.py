"""Plain runs of one motion, by roots of the steps' own polynomials: the first time at a limit, for searches, and the largest rate on the way."""
from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import numpy as np

from ...integrate.motion_units import in_unit, mass_unit, own_unit
from ...integrate.stand_in import root_between, stand_in
from ...integrate.to_heyoka import heyoka_available, taylor_events
from ...numbers.vectors import CYCLE, Number
from ...physics.scene import AnyScene
from ...physics.to_numpy import Form

CHUNK = 256  # steps between two looks at what was found


def first_time(scene: AnyScene, state: Sequence[float], limit: Any, rows: Any, t_max: float, budget: int) -> float:
    """The time at which a run first comes to its limit, s, without a bracket; inf where not until t_max, and where the `budget` of steps ends before
    that, the time it got to.

    state: three floats, scene's axes; limit: rad/s, of |omega|, or three of the components along rows (3, 3).
    """
    own, unit = _in_its_own(scene, state)
    limits = tuple(v / unit for v in (limit if isinstance(limit, tuple) else (limit,)))
    start = [v / unit for v in state]
    if _passed(start, limits, rows):
        return 0.0
    found, _, end = _run(own, start, limits, rows, t_max * unit, budget)
    return found / unit if found is not None else math.inf if end >= t_max * unit else end / unit


def largest_rate(scene: AnyScene, state: Sequence[float], until: float, budget: int) -> tuple[float, float]:
    """(largest |omega| from 0 to `until`, rad/s; the time that the run reached, s): at its ends and where it is stationary."""
    own, unit = _in_its_own(scene, state)
    _, largest, end = _run(own, [v / unit for v in state], None, None, until * unit, budget)
    return largest * unit, end / unit


def _in_its_own(scene: AnyScene, state: Sequence[float]) -> tuple[AnyScene, Any]:
    """(the scene in the motion's own unit of rates, that unit): that of a feeble torque alone would make numbers whose events are not found."""
    unit = own_unit(scene, state, scene.quadratic().rate(list(state)))
    return in_unit(scene, unit, mass_unit(scene)), unit


def _passed(state: Sequence[float], limits: Any, rows: Any) -> bool:
    if len(limits) == 1:
        return math.hypot(*state) >= limits[0]
    return any(abs(sum(r * v for r, v in zip(row, state))) >= most for row, most in zip(rows, limits))


def _run(scene: AnyScene, start: Sequence[float], limits: Any, rows: Any, t_max: float, budget: int) -> tuple[float | None, float, float]:
    """(time at the limit or None, largest |omega|, time reached), in the scene's unit."""
    return (_taylor if heyoka_available() else _scipy)(scene, start, limits, rows, t_max, budget)


def _taylor(scene: AnyScene, start: Sequence[float], limits: Any, rows: Any, t_max: float, budget: int) -> tuple[float | None, float, float]:
    asked = "turning" if limits is None else "components" if len(limits) == 3 else "rate"
    numbers = [*sum(zip(*scene.quadratic().coefficients), ()), *_event_numbers(limits, rows)]
    state, symbols, expressions = _structure(asked)
    largest, steps = math.hypot(*start), 0
    with taylor_events(Form(state, expressions, symbols, tuple(numbers))) as (ta, found), np.errstate(all="ignore"):
        ta.time, ta.state[:] = 0.0, start
        while steps < budget and ta.time < t_max and np.isfinite(ta.state).all():
            outcome, _, _, done, *_ = ta.propagate_until(t_max, max_steps=min(CHUNK, budget - steps))
            steps += max(done, 1)
            t = min((h[0] for h in found if h[0] > 0 and limits is not None), default=None)
            passed = [h for h in found if (t is None or h[0] <= t) and np.isfinite(h[2]).all()]
            largest = max([largest, *(float(np.linalg.norm(h[2])) for h in passed)])
            if t is not None:
                return t, largest, t
            found.clear()
        end = float(np.linalg.norm(ta.state))
        return None, max(largest, end) if math.isfinite(end) else largest, float(ta.time)


def _event_numbers(limits: Any, rows: Any) -> Any:
    if limits is None:
        return []
    squares = [v * v for v in limits]
    return [*(v for row in rows for v in row), *squares] if len(limits) == 3 else squares


@lru_cache(maxsize=3)
def _structure(asked: str) -> Any:
    """State, coefficients, and rates followed by events: where |omega| is stationary ("turning"), or where it ("rate") or one of its components is at
    its limit. All scenes have the same twelve coefficients, so that it is compiled once."""
    from sympy import symbols
    more = {"turning": 0, "rate": 1, "components": 12}[asked]
    extra: Any
    x, c, extra = symbols("x1:4", real=True), symbols("c0:12", real=True), symbols(f"e0:{more}", real=True) if more else ()
    rates = [c[4 * i] * x[j] * x[k] + c[4 * i + 1] * x[k] + c[4 * i + 2] * x[j] + c[4 * i + 3] for i, (j, k) in enumerate(CYCLE)]
    if asked == "turning":
        events = [sum(v * rate for v, rate in zip(x, rates))]
    elif asked == "components":
        events = [sum(extra[3 * n + i] * x[i] for i in range(3)) ** 2 - extra[9 + n] for n in range(3)]
    else:
        events = [sum(v * v for v in x) - extra[0]]
    return x, (*c, *extra), (*rates, *events)


def _scipy(scene: AnyScene, start: Sequence[float], limits: Any, rows: Any, t_max: float, budget: int) -> tuple[float | None, float, float]:
    """Where heyoka is not installed: sign changes on SciPy's interpolant."""
    solver = stand_in(scene.quadratic().rate, np.array(start, float), t_max, rtol=3e-14, atol=1e-16)
    largest = math.hypot(*start)

    def over(y: Number) -> float:
        if len(limits) == 1:
            return float(y @ y) - limits[0] ** 2
        return max(abs(float(np.dot(row, y))) - most for row, most in zip(rows, limits))
    for _ in range(budget):
        if solver.status != "running":
            break
        with np.errstate(all="ignore"):
            solver.step()
        if not np.isfinite(solver.y).all():
            return None, largest, float(solver.t_old or 0.0)
        dense, times = solver.dense_output(), np.linspace(solver.t_old, solver.t, 17)
        states = dense(times).T
        if limits is not None:
            beyond = np.array([over(y) for y in states]) >= 0
            if beyond.any():
                n = max(int(np.argmax(beyond)), 1)
                t = root_between(over, dense, times[n - 1], times[n])
                return float(t), max(largest, float(np.linalg.norm(dense(t)))), float(t)
        largest = max(largest, float(np.linalg.norm(states, axis=1).max()))
    return None, largest, float(solver.t)
