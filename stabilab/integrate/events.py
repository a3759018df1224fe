"""The zeros that a motion passes: of its rates, where its components are extreme, or of other expressions.

With heyoka the Taylor polynomial of each expression over each step is searched for all its real roots, so
that none is lost. SciPy's stand-in looks for changes of sign on the step's own interpolant, sixteen to a
step, and can miss two roots that are closer.
"""
from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ..physics.states import equations_and_start
from ..physics.to_numpy import Form, evaluate, to_numpy
from ..reasons import Reason, Sentence
from .guard import STEPS_NOT_ENOUGH, Guard, full
from .own_units import in_units, scale_of, units_of
from .to_heyoka import TAYLOR_TOLERANCE, heyoka_available, taylor_events
from .trajectory import FALLBACK_RTOL, NUMBERS_OVERFLOWED, floor, root_between, sign_changes, stand_in

if TYPE_CHECKING:
    from ..numbers.vectors import Float3
    from ..physics.scene import AnyScene

SUBSAMPLES = 16
STEP_LIMIT = 1_000_000  # each of which costs ten times one of a run, for its roots are searched
TOGETHER = 400  # steps between looks at what was found
SETTLED, PATIENCE = 100_000, 2  # of `guard`: a search that does not come to its end shows little
# natural times a step may take: a motion that is a polynomial of time has steps without end, whose powers
# overflow
LONGEST = 1e6

STOPPED = Sentence("search-stopped", "stopped: {why}")
RATES_OVERFLOW = Sentence("rates-overflow", "the rates overflow at the start")()


@dataclass(frozen=True)
class Passed:
    """A run and the zeros on its way, in the order of the run.

    times: (m,) theirs; which: (m,) of the expressions; states: (m, N) there; t, state: where it ended; steps:
    taken; reason: why it ended before its time, else None."""

    times: np.ndarray
    which: np.ndarray
    states: np.ndarray
    t: float
    state: np.ndarray
    steps: int
    reason: Reason | None

    @property
    def first(self) -> float | None:
        """The time of the first of them."""
        return float(self.times[0]) if len(self.times) else None


def _passed(zeros: Sequence[tuple[float, int, np.ndarray]], t: float, state: np.ndarray, steps: int,
            reason: Reason | None) -> Passed:
    """zeros: (time, which of the expressions, state) each."""
    return Passed(*_columns(zeros, len(state)), t, state, steps, reason)


def _columns(zeros: Sequence[tuple[float, int, np.ndarray]],
             n: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(times, which, states) of (time, which, state)s: numbers in rows take a tenth of the memory."""
    times, which, states = zip(*zeros) if zeros else ((), (), ())
    return np.array(times, float), np.array(which, int), np.array(states, float).reshape(-1, n)


def zeros_passed(forms: Form, state: np.ndarray, rates: np.ndarray | Sequence[float], t_end: float,
                 steps: int, tolerance: float = TAYLOR_TOLERANCE, first: bool = False,
                 whole: bool = False, look: int = TOGETHER) -> Passed:
    """The motion from `state` (N,) at t = 0 to t_end, of either sign, and the zeros on its way of those
    expressions of a form that stand behind its N rates; those of the start itself do not count.

    rates: (N,) near the start; steps: after so many the run is given up; first: it ends soon after the first
    zero; whole: it is given up as soon as it shows that it will not come to t_end (`guard`). look: steps
    until what was passed is first looked at; later looks are a quarter of the way apart, up to TOGETHER.
    """
    with np.errstate(all="ignore"):
        if heyoka_available():
            return _by_taylor(forms, state, float(t_end), steps, tolerance, first, whole,
                              _longest(rates, state), look)
        return _by_scipy(forms, state, float(t_end), steps, tolerance, first, whole)


def _by_taylor(forms, state, t_end, steps, tolerance, first, entire, longest, look) -> Passed:
    parts, done, noted, why, size = [], 0, 0, None, len(forms.state)
    guard = Guard(t_end, steps, SETTLED, PATIENCE)
    with taylor_events(forms, tolerance) as (integrator, result):
        integrator.time = 0.0
        integrator.state[:] = state
        while True:
            outcome, _, _, taken, *_ = integrator.propagate_until(
                t_end, max_steps=min(TOGETHER, max(look, done // 4), steps - done), max_delta_t=longest)
            done += taken
            met = [zero for zero in result if zero[0] != 0 and np.isfinite(zero[2]).all()]
            result.clear()
            parts += [_columns(met, size)] if met else []
            noted += len(met)
            if outcome.name != "step_limit" or done >= steps or (first and parts):
                break
            why = guard.look_in_time(done, float(integrator.time)) if entire else None
            why = why or full(noted, size + 2)
            if why:
                break
        now, end = float(integrator.time), integrator.state.copy()
    times, which, states = map(np.concatenate, zip(*parts)) if parts else _columns((), size)
    order = np.argsort(np.abs(times), kind="stable")
    times, which, states = times[order], which[order], states[order]
    if not np.isfinite(end).all():
        now, end = (float(times[-1]), states[-1]) if len(times) else (0.0, state)
    reason = (None if outcome.name == "time_limit" else STOPPED(why=why) if why
              else STOPPED(why=STEPS_NOT_ENOUGH(steps=steps)) if outcome.name == "step_limit"
              else STOPPED(why=outcome.name))
    return Passed(times, which, states, now, end, done, reason)


def _longest(rates: np.ndarray | Sequence[float], state: np.ndarray) -> float:
    """The longest step, by the size of the first three components and the roots of their rates."""
    changes = np.abs(rates[:3])
    size = max(float(np.abs(state[:3]).max()),
               math.sqrt(float(changes.max())) if np.isfinite(changes).all() else 1.0)
    return LONGEST / size if size > 0 else math.inf


def _by_scipy(forms: Form, state: np.ndarray, t_end: float, steps: int, tolerance: float, first: bool,
              entire: bool) -> Passed:
    n, rtol = len(forms.state), max(tolerance, FALLBACK_RTOL)
    atol = floor(state, rtol)
    moving, behind = (Form(forms.state, part, forms.symbols, forms.numbers)
                      for part in (forms.expressions[:n], forms.expressions[n:]))

    def run(t: float, y: np.ndarray, end: float):
        return stand_in(lambda x: moving.function(*x, *moving.numbers), y, end, t, rtol, atol)

    if t_end == 0:
        return _passed([], 0.0, state, 0, None)
    solver, zeros, done, guard = run(0.0, state, t_end), [], 0, Guard(t_end, steps, SETTLED, PATIENCE)
    while solver.status == "running" and done < steps and not (first and zeros):
        begin, before = solver.t, solver.y.copy()
        solver.step()
        if solver.status == "failed" or not np.isfinite(solver.y).all():
            return _passed(zeros, begin, before, done, STOPPED(why=NUMBERS_OVERFLOWED))
        done += 1
        zeros += sorted(_zeros_of_step(behind, solver, before, run), key=lambda zero: abs(zero[0]))
        why = (guard.look_in_time(done, float(solver.t)) if entire else None) or full(len(zeros), n + 30)
        if why:
            return _passed(zeros, float(solver.t), solver.y, done, STOPPED(why=why))
    reason = None if solver.status == "finished" else STOPPED(why=STEPS_NOT_ENOUGH(steps=steps))
    return _passed(zeros, float(solver.t), solver.y, done, reason)


def _zeros_of_step(behind, solver, before, run):
    """Changes of sign within one step, each with the state there."""
    dense, zeros = solver.dense_output(), []
    times = np.linspace(solver.t_old, solver.t, SUBSAMPLES + 1)
    values = evaluate(behind, dense(times).T)
    for i, row in enumerate(values.T):
        for left in sign_changes(row):
            t = root_between(lambda y, i=i: evaluate(behind, y)[i], dense, times[left], times[left + 1])
            zeros.append((t, i, _land(run, solver.t_old, before, t)))
        if np.abs(row).max() > 0:
            zeros += [(times[n], i, dense(times[n])) for n in np.nonzero(row[1:] == 0)[0] + 1]
    return zeros


def _land(run: Callable[[float, np.ndarray, float], Any], t: float, y: np.ndarray, t_end: float):
    """The state at t_end by steps of the method that end there (free of the interpolant's error)."""
    if t == t_end:
        return y
    solver = run(t, y, t_end)
    while solver.status == "running":
        solver.step()
    return solver.y


@dataclass(frozen=True)
class RateRoots:
    """Roots of the rates of all components of the state, in the order of the motion.

    t: (n,) times; component: (n,) index of the rate that vanishes; states: (n, N) there; start, end: (N,)
    states at t = 0 and at t_reached (the end of the span, or earlier where the run had to stop: `reason` says
    why); method: "taylor" or "DOP853".
    """

    t: np.ndarray
    component: np.ndarray
    states: np.ndarray
    start: np.ndarray
    end: np.ndarray
    t_reached: float
    method: str
    steps: int
    reason: Reason | None

    def extremes(self, components: Sequence[int] = (0, 1, 2)):
        """(m, 2) smallest and largest value of the components over the span, its two ends included."""
        result = np.sort(np.stack([self.start[list(components)], self.end[list(components)]], axis=1), axis=1)
        for n, i in enumerate(components):
            values = self.states[self.component == i, i]
            if values.size:
                result[n] = min(result[n, 0], values.min()), max(result[n, 1], values.max())
        return result


def roots_of_rates(scene: AnyScene, state: np.ndarray | Sequence[float] | Mapping[str, Float3], t_end: float,
                   tolerance: float = TAYLOR_TOLERANCE) -> RateRoots:
    """Every root of x_i' for 0 < |t| < |t_end|, for the motion that is at `state` (as `trajectory` takes it)
    at t = 0.

    t_end: s (tau when scaled), of either sign. Raises InputError for a state that is none. Rates
    that vanish identically have no roots.
    """
    equations, state = equations_and_start(scene, state)
    if getattr(scene, "ending", ()):  # equations may stand for a scene
        from .trajectory import roots_through_the_end
        search = lambda *motion: roots_of_rates(*motion, tolerance)
        if (entire := roots_through_the_end(scene, equations, state, float(t_end), search)) is not None:
            return entire
    with np.errstate(all="ignore"):
        rates = to_numpy(equations)(state)
    if not np.isfinite(rates).all():
        return _roots(_passed([], 0.0, state, 0, STOPPED(why=RATES_OVERFLOW)), state, "none")
    units = units_of(equations, state)
    scale, system = scale_of(equations, units), to_numpy(in_units(equations, units))
    passed = zeros_passed(system.motion_and_rates, state / scale, rates / scale / units.pace,
                          float(units.times(float(t_end))), STEP_LIMIT, tolerance, whole=True)
    passed = replace(passed, times=passed.times / units.pace, states=passed.states * scale,
                     t=passed.t / units.pace, state=np.array(passed.state) * scale)
    return _roots(passed, state, "taylor" if heyoka_available() else "DOP853")


def _roots(passed: Passed, start: np.ndarray, method: str) -> RateRoots:
    return RateRoots(passed.times, passed.which, passed.states, np.array(start), np.array(passed.state),
                     passed.t, method, passed.steps, passed.reason)
