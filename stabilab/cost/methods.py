"""The ways to follow a motion that are compared, and those to find period, extremes and fate.

Each has a name, a ladder of settings, and how to make a run.

`prepare(problem, setting)` returns a callable run(times) -> Answer; what is done once for all runs of a scene
(compiling, series) happens in it. The counters of an Answer are exact.

Period, extremes and fate come from the general integrators with events, from the reduced form and from ball
arithmetic.

A run follows the motion a little further than one period, notes where each rate vanishes and where it passes
the plane through the start across the first velocity; the passage nearest the known period is its period."""
from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np

from ..answers.digits_run import ladder
from ..answers.motions.rows import extremes, fates, periods
from ..errors import InputError
from ..integrate.to_heyoka import (
    TAYLOR_TOLERANCE,
    heyoka,
    heyoka_available,
    heyoka_form,
    in_loops,
    taylor_events,
    to_taylor,
)
from ..integrate.trajectory import ATOL_SHARE, SCIPY_METHODS
from ..orbit.extremes import precise_extremes
from ..orbit.fate import decide, free_margin, is_free
from ..orbit.flow import reduced_motion
from ..orbit.landscape import landscape
from ..orbit.one_orbit import Orbit
from ..orbit.period import precise_period
from ..orbit.result import Fate
from ..physics.equations import Equations
from ..physics.scene import slices
from ..physics.states import equations_and_start, quaternion, start_of
from ..physics.to_numpy import form, to_numpy
from ..theories.follow import follow, models_of

LANES = 4  # of the batch: doubles in one AVX register
NUDGE = 2.0**-20  # relative difference between neighbouring lanes, so that they do not share one motion
TAYLOR_LADDER = (1e-3, 1e-5, 1e-7, 1e-9, 1e-11, 1e-13, 1e-15, TAYLOR_TOLERANCE)
SCIPY_LADDER = tuple(10.0**-n for n in range(3, 14))
STOP = 400_000  # rate evaluations after which a SciPy run is given up
IMPLICIT = ("Radau", "BDF", "LSODA")


@dataclass(frozen=True)
class Problem:
    """A case's motion as numbers: start (N,) at time 0 (taken as exact), times (n,) away from 0."""

    case: Any
    equations: Equations
    start: np.ndarray
    times: np.ndarray

    @cached_property
    def system(self):
        return to_numpy(self.equations)

    @cached_property
    def slices(self) -> dict:
        return slices(self.equations.blocks)

    @property
    def scene(self):
        return self.case.scene


def problem(case, count: int) -> Problem:
    """The motion of a case at `count` times from 0 (left out) to the end of its span. InputError without a
    motion."""
    if case.state is None or case.span is None:
        raise InputError(
            f"{case.path}: motion: expected a state and a span (or tau) in [motion]; precision needs both")
    scaled = case.scene.variables == "scaled"
    equations, start = equations_and_start(case.scene, case.state if scaled
                                           else start_of(case.scene, case.state, case.blocks))
    end = max(case.span, key=abs)
    return Problem(case, equations, start, end * np.arange(1, count + 1) / count)


@dataclass(frozen=True)
class Answer:
    """parts: block -> (n, m) states at the times of the run; steps, evaluations: of the rates (Taylor:
    coefficients of the state's series; reduced form: of dt/dtheta; models: None)."""

    parts: dict
    steps: int | None = None
    evaluations: int | None = None


@dataclass(frozen=True)
class Method:
    """name; setting: what its ladder is in ("rtol", "nodes", "order", "formula"); ladder: coarse to fine;
    prepare: see the module; lanes: motions followed at once."""

    name: str
    setting: str
    ladder: tuple
    prepare: Callable = field(repr=False)
    lanes: int = 1


FINE = {"taylor": 1, "reduced": 1}  # a rung of these costs little: every so-manieth is taken at least


def methods(task: Problem, every: int = 1) -> list[Method]:
    """Every method that applies to a motion. every: rungs of each ladder to take, the last always."""
    rows = []
    if heyoka_available():
        rows += [Method("taylor", "rtol", TAYLOR_LADDER, _taylor),
                  Method("taylor-batch", "rtol", TAYLOR_LADDER[1::2], _batch, LANES)]
    rows += [Method(name, "rtol", SCIPY_LADDER, _scipy(name)) for name in SCIPY_METHODS]
    rows += _reduced(task) + _models(task)
    return [thinned(m, min(every, FINE.get(m.name, every))) for m in rows]


def thinned(method: Method, every: int) -> Method:
    """The method with every so-manieth rung of its ladder, and the last."""
    ladder = method.ladder
    return (replace(method, ladder=tuple(dict.fromkeys((*ladder[:-1:every], ladder[-1])))) if len(ladder) > 2
            else method)


def _split(task: Problem, states: np.ndarray) -> dict:
    return {name: states[:, part] for name, part in task.slices.items()}


def _taylor(task: Problem, tolerance: float):
    integrator = to_taylor(task.equations, (), tolerance)

    def run(times: np.ndarray):
        integrator.time = 0.0
        integrator.state[:] = task.start
        _, _, _, steps, *_, out = integrator.propagate_grid(np.concatenate([[0.0], times]))
        return Answer(_split(task, np.asarray(out).reshape(-1, task.start.size)[1:]), steps,
                      steps * integrator.order)
    return run


def _batch(task: Problem, tolerance: float):
    """One lane is the motion, the others start next to it; cost is counted for one lane."""
    rates = form(task.equations, task.equations.rhs)
    variables, expressions = heyoka_form(rates.state, rates.symbols, rates.expressions)
    spread = task.start[:, None] * (1 + NUDGE * np.arange(LANES))
    integrator = heyoka().taylor_adaptive_batch(list(zip(variables, expressions)), spread.copy(),
                                                tol=tolerance, compact_mode=in_loops(rates.expressions),
                                              pars=np.repeat(np.array(rates.numbers)[:, None], LANES, axis=1))

    def run(times: np.ndarray):
        integrator.set_time(0.0)
        integrator.state[:] = spread
        _, out = integrator.propagate_grid(np.repeat(np.concatenate([[0.0], times])[:, None], LANES, axis=1))
        steps = int(np.max([row[3] for row in integrator.propagate_res]))
        return Answer(_split(task, np.ascontiguousarray(out[1:, :, 0])), steps, steps * integrator.order)
    return run


def _scipy(name: str):
    def prepare(task: Problem, rtol: float):
        from scipy import integrate
        rate, floor = task.system.rate, rtol * ATOL_SHARE * (np.abs(task.start).max() or 1.0)
        options = {"jac": lambda _, y: task.system.jacobian(y)} if name in IMPLICIT else {}

        def run(times: np.ndarray):
            solver = getattr(integrate, name)(lambda _, y: rate(y.tolist()), 0.0, task.start, times[-1],
                                              rtol=rtol, atol=floor, **options)
            out, done, steps = np.full((len(times), task.start.size), np.nan), 0, 0
            while solver.status == "running" and solver.nfev < STOP:
                solver.step()
                steps += 1
                stop = int(np.searchsorted(np.abs(times), abs(solver.t), side="right"))
                if stop > done and solver.status != "failed":
                    dense = solver.dense_output() if times[done] != solver.t else None
                    for i in range(done, stop):
                        out[i] = solver.y if times[i] == solver.t else dense(times[i])
                    done = stop
            return Answer(_split(task, out), steps, int(solver.nfev))
        return run
    return prepare


def _reduced(task: Problem) -> list[Method]:
    if task.times[-1] < 0 or task.equations.blocks != ("omega",):
        return []
    try:
        rungs = ladder(task.scene, task.start)
    except InputError:
        return []

    def prepare(task: Problem, nodes: int):
        def run(times: np.ndarray):
            # its series belong to the cost of an answer
            orbit = reduced_motion(task.scene, task.start, nodes)
            counts = orbit.evaluations
            return Answer({"omega": orbit.states(times)}, None, counts)
        return run
    return [Method("reduced", "nodes", rungs, prepare)]


def _models(task: Problem) -> list[Method]:
    """The analytic models of the case that have an answer for this motion."""
    rows = []
    for name in models_of(task.scene)[1:]:
        ladder, setting = ((1, 2, 3, 4, 6, 8), "order") if name == "lindstedt" else ((1,), "formula")
        try:
            follow(task.case, task.times[:1], name, order=ladder[0] if name == "lindstedt" else None)
        except InputError:
            continue
        rows.append(Method(name, setting, ladder, _model(name)))
    return rows


def _model(name):
    def prepare(task, setting):
        def run(times: np.ndarray):
            answer = follow(task.case, times, name, order=setting if name == "lindstedt" else None)
            resolved = {part: _filled(answer.state[part], len(times)) for part in task.slices
                     if part in answer.state}
            if "attitude" in task.slices and "angles" in answer.state:
                resolved["attitude"] = _filled(quaternion(*np.asarray(answer.state["angles"], float).T).T,
                                            len(times))
            return Answer(resolved)
        return run
    return prepare


def _filled(values, count):
    """(count, m) states; a model that stopped before the end has none after it (nan)."""
    values = np.asarray(values, float)
    return np.vstack([values, np.full((count - len(values), values.shape[1]), np.nan)])


OVERRUN = 1.02  # periods to run: a coarse run comes home late
EARLY = 0.25  # periods before which a passage of the plane is no return
EVENT_METHODS = ("RK45", "DOP853", "LSODA")


def answer_methods(task: Problem, period: float, every: int = 1) -> list[Method]:
    """Ways to the period and the extremes of a motion that repeats; run(None) gives parts "period" (1,) and
    "extremes" (3, 2)."""
    result = [Method("taylor", "rtol", TAYLOR_LADDER, _taylor_events(period))] if heyoka_available() else []
    result += [Method(name, "rtol", SCIPY_LADDER[:10], _scipy_events(name, period)) for name in EVENT_METHODS]
    result = [thinned(m, every) for m in result]
    return result + [Method("reduced", "formula", (1,), _roots), Method("balls", "formula", (1,), _balls)]


def _taylor_events(period: float) -> Callable:
    def prepare(task: Problem, tolerance: float):
        from sympy import Rational
        state, start = task.equations.state, [Rational(float(v)) for v in task.start]
        velocity = [Rational(float(v)) for v in task.system(task.start)]
        plane = sum(n * (x - x0) for n, x, x0 in zip(velocity, state, start))
        forms = form(task.equations, (*task.equations.rhs, *task.equations.rhs[:3], plane))
        with taylor_events(forms, tolerance):
            pass  # compiles

        def run(times: np.ndarray):
            with taylor_events(forms, tolerance) as (integrator, result):
                integrator.time = 0.0
                integrator.state[:] = task.start
                steps = integrator.propagate_until(OVERRUN * period)[3]
                return _answer(task, period, list(result), steps, steps * integrator.order)
        return run
    return prepare


def _scipy_events(name: str, period: float) -> Callable:
    def prepare(task, rtol):
        from scipy.integrate import solve_ivp
        velocity, rate = task.system(task.start), task.system.rate
        events = [lambda _, y, i=i: rate(y.tolist())[i] for i in range(3)]
        # the plane is met at the start itself, where rounding upsets SciPy's search: it counts from a quarter
        # period on
        events.append(lambda t, y: float(velocity @ (y - task.start)) if t > EARLY * period else 1.0)
        options = {"jac": lambda _, y: task.system.jacobian(y)} if name in IMPLICIT else {}

        def run(times: np.ndarray):
            try:
                run = solve_ivp(lambda _, y: rate(y.tolist()), (0.0, OVERRUN * period), task.start,
                                method=name, rtol=rtol,
                                atol=rtol * ATOL_SHARE * np.abs(task.start).max(), events=events, **options)
            except ValueError:  # its event search: "f(a) and f(b) must have different signs"
                return Answer({"period": np.array([np.nan]), "extremes": np.full((3, 2), np.nan)})
            rows = [(t, i, y) for i in range(4) for t, y in zip(run.t_events[i], run.y_events[i])]
            return _answer(task, period, rows, len(run.t) - 1, run.nfev)
        return run
    return prepare


def _answer(task: Problem, period: float, result: Sequence[tuple[float, int, np.ndarray]], steps: int,
            evaluations: int) -> Answer:
    """Period and extremes of the events (time, index, state); nan where the motion was not seen to come home.
    """
    velocity = task.system(task.start)
    homes = [t for t, i, y in result if i == 3 and t > EARLY * period
             and task.system(np.asarray(y)) @ velocity > 0]
    home = min(homes, key=lambda t: abs(t - period), default=np.nan)
    extremes = np.repeat(task.start[:3, None], 2, axis=1)
    for t, i, y in result:
        if i < 3 and not t > home:
            extremes[i] = min(extremes[i, 0], y[i]), max(extremes[i, 1], y[i])
    return Answer({"period": np.array([home]), "extremes": extremes}, int(steps), int(evaluations))


def _roots(task: Problem, _: int):
    return lambda times: Answer({"period": np.array([float(periods(task.scene, task.start))]),
                                 "extremes": extremes(task.scene, task.start)})


def _balls(task: Problem, _: int):
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
    result = float(periods(task.scene, task.start))
    return result if 0 < result < np.inf else None


def _landscape(task: Problem):
    try:
        return landscape(task.scene) if task.equations.blocks == ("omega",) else None
    except InputError:
        return None


def fate_methods(task: Problem) -> list:
    """(name, call) of the ways to the fate: by energy in doubles, and by energy in balls; call() -> its word.
    """
    if (result := _landscape(task)) is None:
        return []
    reduction = result.reduction

    def in_balls():
        margin = (float(free_margin(task.scene, task.start)) if is_free(task.scene)
                  else decide(Orbit(reduction, task.start)).sign)
        return ("at the barrier" if not margin else "below the barrier" if margin > 0
                else "above the barrier, or none stands ahead")
    return [("energy", lambda: Fate(int(fates(task.scene, task.start).labels)).word), ("balls", in_balls)]
