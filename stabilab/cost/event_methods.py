"""Period, extremes and fate by the general integrators with events, by the reduced form and in ball
arithmetic.

A run follows the motion a little further than one period, notes where each rate vanishes and where it passes
the plane through the start across the first velocity; the passage nearest the known period is its period.
"""
from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..answers.extremes import extremes, period
from ..answers.fate import fate
from ..errors import InputError
from ..integrate.to_heyoka import heyoka_available, taylor_events
from ..integrate.trajectory import ATOL_SHARE
from ..orbit.extremes.one_state import precise_extremes
from ..orbit.fate.one_state import decide, free_margin, is_free
from ..orbit.landscape import landscape
from ..orbit.one_orbit import Orbit
from ..orbit.period import precise_period
from ..orbit.result import Fate
from ..physics.to_numpy import form
from .methods import IMPLICIT, SCIPY_LADDER, TAYLOR_LADDER, Answer, Method, Problem, thinned

OVERRUN = 1.02  # periods to run: a coarse run comes home late
EARLY = 0.25  # periods before which a passage of the plane is no return
EVENT_METHODS = ("RK45", "DOP853", "LSODA")


def answer_methods(task: Problem, period: float, every: int = 1) -> list[Method]:
    """Ways to the period and the extremes of a motion that repeats; run(None) gives parts "period" (1,) and
    "extremes" (3, 2)."""
    found = [Method("taylor", "rtol", TAYLOR_LADDER, _taylor(period))] if heyoka_available() else []
    found += [Method(name, "rtol", SCIPY_LADDER[:10], _scipy(name, period)) for name in EVENT_METHODS]
    found = [thinned(m, every) for m in found]
    return found + [Method("reduced", "formula", (1,), _roots), Method("balls", "formula", (1,), _balls)]


def _taylor(period) -> Callable:
    def prepare(task, tolerance):
        from sympy import Rational
        state, start = task.equations.state, [Rational(float(v)) for v in task.start]
        velocity = [Rational(float(v)) for v in task.system(task.start)]
        plane = sum(n * (x - x0) for n, x, x0 in zip(velocity, state, start))
        forms = form(task.equations, (*task.equations.rhs, *task.equations.rhs[:3], plane))
        with taylor_events(forms, tolerance):
            pass  # compiles

        def run(times):
            with taylor_events(forms, tolerance) as (integrator, found):
                integrator.time = 0.0
                integrator.state[:] = task.start
                steps = integrator.propagate_until(OVERRUN * period)[3]
                return _answer(task, period, list(found), steps, steps * integrator.order)
        return run
    return prepare


def _scipy(name, period) -> Callable:
    def prepare(task, rtol):
        from scipy.integrate import solve_ivp
        velocity, rate = task.system(task.start), task.system.rate
        events = [lambda _, y, i=i: rate(y.tolist())[i] for i in range(3)]
        # the plane is met at the start itself, where rounding upsets SciPy's search: it counts from a quarter
        # period on
        events.append(lambda t, y: float(velocity @ (y - task.start)) if t > EARLY * period else 1.0)
        options = {"jac": lambda _, y: task.system.jacobian(y)} if name in IMPLICIT else {}

        def run(times):
            try:
                run = solve_ivp(lambda _, y: rate(y.tolist()), (0.0, OVERRUN * period), task.start,
                                method=name, rtol=rtol,
                                atol=rtol * ATOL_SHARE * np.abs(task.start).max(), events=events, **options)
            except ValueError:  # its event search: "f(a) and f(b) must have different signs"
                return Answer({"period": np.array([np.nan]), "extremes": np.full((3, 2), np.nan)})
            found = [(t, i, y) for i in range(4) for t, y in zip(run.t_events[i], run.y_events[i])]
            return _answer(task, period, found, len(run.t) - 1, run.nfev)
        return run
    return prepare


def _answer(task, period, found, steps, evaluations) -> Answer:
    """Period and extremes of the events (time, index, state); nan where the motion was not seen to come home.
    """
    velocity = task.system(task.start)
    homes = [t for t, i, y in found if i == 3 and t > EARLY * period
             and task.system(np.asarray(y)) @ velocity > 0]
    home = min(homes, key=lambda t: abs(t - period), default=np.nan)
    extremes = np.repeat(task.start[:3, None], 2, axis=1)
    for t, i, y in found:
        if i < 3 and not t > home:
            extremes[i] = min(extremes[i, 0], y[i]), max(extremes[i, 1], y[i])
    return Answer({"period": np.array([home]), "extremes": extremes}, int(steps), int(evaluations))


def _roots(task, _):
    return lambda times: Answer({"period": np.array([float(period(task.scene, task.start))]),
                                 "extremes": extremes(task.scene, task.start)})


def _balls(task, _):
    reduction = landscape(task.scene).reduction

    def run(times):
        return Answer({"period": np.array([precise_period(Orbit(reduction, task.start), Fate.BOUNDED)]),
                       "extremes": precise_extremes(Orbit(reduction, task.start), Fate.BOUNDED)})
    return run


def known_period(task: Problem):
    """The period of a motion that repeats, or None where the question does not arise (or no reduction answers
    it)."""
    if _landscape(task) is None:
        return None
    found = float(period(task.scene, task.start))
    return found if 0 < found < np.inf else None


def _landscape(task: Problem):
    try:
        return landscape(task.scene) if task.equations.blocks == ("omega",) else None
    except InputError:
        return None


def fate_methods(task: Problem) -> list:
    """(name, call) of the ways to the fate: by energy in doubles, and by energy in balls; call() -> its word.
    """
    if (found := _landscape(task)) is None:
        return []
    reduction = found.reduction

    def in_balls():
        margin = (float(free_margin(task.scene, task.start)) if is_free(task.scene)
                  else decide(Orbit(reduction, task.start)).sign)
        return ("at the barrier" if not margin else "below the barrier" if margin > 0
                else "above the barrier, or none stands ahead")
    return [("energy", lambda: Fate(int(fate(task.scene, task.start).labels)).word), ("balls", in_balls)]
