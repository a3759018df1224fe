"""The first crossing by roots along a run of machine precision; a second run from a start moved in its last
place says how well it is known."""
from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from functools import lru_cache
from itertools import combinations_with_replacement
from typing import Any

import numpy as np

from ...integrate.events import SUBSAMPLES, first_root, root_of
from ...integrate.quadratic_series import in_unit, mass_unit, own_unit
from ...integrate.to_heyoka import TAYLOR_TOLERANCE, heyoka_available, taylor_events
from ...integrate.trajectory import stand_in
from ...numbers.vectors import CYCLE
from ...physics.equations import Equations, derive, rotation
from ...physics.scene import AnyScene
from ...physics.states import equations_and_start, moved_row, to_space
from ...physics.to_numpy import Form, to_numpy
from .limit import Limit
from .result import Found

STEPS = 300_000  # of each of the two runs
MOVED = 2.0  # places by which the second run's start is moved
WIDER = 4.0  # times what the two runs differ by
ROUNDING = 2.0**-50  # relative, of a time that both find alike
CHUNK = 256  # steps between two looks at what was found
PRODUCTS = tuple(combinations_with_replacement(range(3), 2))  # of two rates


def by_run(scene: AnyScene, start: Any, limit: Limit, t_max: float = math.inf, steps: int = STEPS) -> Found:
    """The first crossing of the motion of any scene. start: numbers or blocks, as `trajectory` takes them;
    t_max: the scene's time."""
    return by_run_of(scene, start, limit, t_max, steps)[0]


def by_run_of(scene: AnyScene, start: Any, limit: Limit, t_max: float = math.inf,
              steps: int = STEPS) -> tuple[Found, int]:
    """The same, and the steps that the first run took."""
    equations, state, unit, expressions = _asked(scene, start, limit)
    end = t_max * unit if math.isfinite(t_max) else 1e300
    one = first_root(equations, state, expressions, end, steps)
    words = f"{limit.words}: roots along a run in machine precision"
    if one.t is None:
        far = "t_max" if one.ended else f"{steps} steps"
        low = one.until * (1 - ROUNDING) / unit
        return Found(low, math.nan, "run",
                     f"{words}: not reached by t = {one.until / unit:.6g} {scene.time_unit} ({far})"), one.steps
    two = first_root(equations, moved_row(state, MOVED), expressions, end, 2 * steps, 4 * TAYLOR_TOLERANCE)
    if two.t is None:
        return Found(0.0, math.nan, "undecided",
                     f"{words} find it at {one.t / unit:.6g} {scene.time_unit}, a second run from a start "
                     f"moved in its "
                                                 "last place does not: more than a run in doubles "
                                                 "can tell"), one.steps
    blur = WIDER * abs(one.t - two.t) + ROUNDING * one.t
    return Found(max(0.0, one.t - blur) / unit, (one.t + blur) / unit, "run",
                 f"{words}, the error from a second one"), one.steps


def run_once(scene: AnyScene, state: Sequence[float], limit: Limit, t_max: float = math.inf,
             steps: int = STEPS) -> tuple[float, float]:
    """(time of the first crossing by one run, inf where none was found; the time until which none was): no
    word on their error.

    scene: wheel and torque; state: three floats; t_max: the scene's time.
    """
    if limit.kind == "tilt":
        equations, start, unit, expressions = _asked(scene, state, limit)
        found = first_root(equations, start, expressions, t_max * unit if math.isfinite(t_max) else 1e300,
                           steps)
    else:
        own, unit, start = _in_own_unit(scene, state)
        forms, rate = _quadratic(own, limit.parts, Fraction(unit) ** 2), own.quadratic().rate
        found = root_of(forms, rate, start, rate(start.tolist()),
                        t_max * unit if math.isfinite(t_max) else 1e300, steps)
    until = t_max if found.t is None and found.ended and math.isfinite(t_max) else found.until / unit
    return (math.inf, until) if found.t is None else (found.t / unit, math.inf)


def largest_rate(scene: AnyScene, state: Sequence[float], until: float, budget: int) -> tuple[float, float]:
    """(largest |omega| from 0 to `until`, rad/s; the time that the run reached, s): at its ends and where it
    is stationary."""
    own, unit, start = _in_own_unit(scene, state)
    sizes, reached = (_turning if heyoka_available() else _sampled)(own, start, until * unit, budget)
    return max(v for v in sizes if math.isfinite(v)) * unit, reached / unit


def _turning(scene: AnyScene, start: np.ndarray, end: float, budget: int) -> tuple[list[float], float]:
    """(|omega| at the ends and wherever it is stationary, time reached)."""
    sizes, steps = [float(np.linalg.norm(start))], 0
    with taylor_events(_quadratic(scene)) as (run, found), np.errstate(all="ignore"):
        run.time, run.state[:] = 0.0, start
        while steps < budget and run.time < end and np.isfinite(run.state).all():
            steps += max(run.propagate_until(end, max_steps=min(CHUNK, budget - steps))[3], 1)
            sizes.append(max((float(np.linalg.norm(state)) for _, _, state in found), default=0.0))
            found.clear()
        return [*sizes, float(np.linalg.norm(run.state))], float(run.time)


def _sampled(scene: AnyScene, start: np.ndarray, end: float, budget: int) -> tuple[list[float], float]:
    """The same where heyoka is not installed: at sixteen places of every step."""
    solver, sizes = stand_in(scene.quadratic().rate, start, end, rtol=3e-14,
                             atol=1e-16), [float(np.linalg.norm(start))]
    for _ in range(budget):
        if solver.status != "running":
            break
        with np.errstate(all="ignore"):
            solver.step()
        if not np.isfinite(solver.y).all():
            return sizes, float(solver.t_old or 0.0)
        states = solver.dense_output()(np.linspace(solver.t_old, solver.t, SUBSAMPLES + 1)).T
        sizes.append(float(np.linalg.norm(states, axis=1).max()))
    return sizes, float(solver.t)


def _in_own_unit(scene: AnyScene, state: Sequence[float]) -> tuple[AnyScene, float, np.ndarray]:
    """(the scene in the motion's own unit of rates, that unit, the start in it).

    In the unit of a feeble torque alone the events of the numbers would not be found."""
    unit = own_unit(scene, state, scene.quadratic().rate(list(state)))
    return in_unit(scene, unit, mass_unit(scene)), unit, np.array(state, float) / unit


def _quadratic(scene: AnyScene, parts: Sequence[Any] = (), square: Fraction = Fraction(1)) -> Form:
    """The rates of a scene of wheel and torque, and the limit's parts over the square of the unit."""
    state, symbols, expressions = _structure(len(parts))
    numbers = [*sum(zip(*scene.quadratic().coefficients), ())]
    for terms, most in parts:
        numbers += ([float(sum(c * a[i] * a[j] * (1 + (i != j)) for c, a in terms)) for i, j in PRODUCTS]
                    + [float(most / square)])
    return Form(state, expressions, symbols, tuple(numbers))


@lru_cache(maxsize=4)
def _structure(parts: int) -> Any:
    """(state, coefficients, rates followed by events): where so many quadratic forms are at their limits;
    without any, where |omega| is stationary. All scenes have the same coefficients, so that it is compiled
    once."""
    from sympy import symbols
    extra: Any = symbols(f"e0:{7 * parts}", real=True) if parts else ()
    x, c = symbols("x1:4", real=True), symbols("c0:12", real=True)
    rates = [c[4 * i] * x[j] * x[k] + c[4 * i + 1] * x[k] + c[4 * i + 2] * x[j] + c[4 * i + 3] for i,
             (j, k) in enumerate(CYCLE)]
    events = [sum(e * x[i] * x[j] for e, (i, j) in zip(extra[7 * n:], PRODUCTS)) - extra[7 * n + 6]
              for n in range(parts)]
    return x, (*c, *extra), (*rates, *(events or [sum(v * rate for v, rate in zip(x, rates))]))


def _asked(scene: AnyScene, start: Any, limit: Limit) -> tuple[Equations, np.ndarray, float, list[Any]]:
    """(equations, state, unit, expressions that vanish at the limit), in units near the motion's own where
    these are known."""
    tilted = limit.kind == "tilt"
    if tilted and not isinstance(start, dict):
        start = ({"omega": tuple(start)[:3]}
                 | ({"gamma": tuple(start)[3:6]} if "gamma" in scene.blocks else {}))
    if tilted:
        start = {"attitude": (1.0, 0.0, 0.0, 0.0), **start}
    equations, state = equations_and_start(scene, start)
    unit = 1.0
    if set(equations.blocks) <= {"omega", "attitude"}:
        with np.errstate(all="ignore"):
            unit = own_unit(scene, state[:3].tolist(), np.asarray(to_numpy(equations)(state))[:3].tolist())
        mass = mass_unit(scene)
        if unit != 1 or mass != 1:
            changed = in_unit(scene, unit, mass)
            equations = derive(changed, equations.blocks)
            state = np.concatenate([state[:3] / unit, state[3:]])
    return equations, state, unit, _expressions(limit, equations, state, unit)


def _expressions(limit: Limit, equations: Equations, state: Sequence[float] | np.ndarray,
                 unit: float) -> list[Any]:
    from sympy import Float, Rational, cos
    rational = lambda v: Rational(v.numerator, v.denominator)
    if limit.kind != "tilt":
        omega = equations.state[:3]
        power = rational(Fraction(unit)) ** 2
        return [sum(rational(c) * sum(rational(a) * w for a, w in zip(vector, omega) if a) ** 2 for c,
                    vector in terms) - rational(most) / power
                for terms, most in limit.parts]
    at = 3 + (3 if "gamma" in equations.blocks else 0)
    q = equations.state[at:at + 4]
    direction = limit.direction or ()
    first = to_space(state[at:at + 4], [float(v) for v in direction])
    rows = rotation(q)
    turned = sum(Rational(float(f)) * rational(a) * entry for f, row in zip(first, rows) for a,
                 entry in zip(direction, row) if a)
    return [turned - Rational(float(cos(Float(rational(limit.parts[0][1]), 30))))]
