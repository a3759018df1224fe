"""Extrema and events along a motion.

Local extremes of a motion's components: every root of every rate over a span, none lost between samples.

With heyoka the Taylor polynomial of each rate over each step is searched for all its real roots. SciPy's
stand-in looks for sign changes on the step's own interpolant, which can miss a pair of roots closer than a
sixteenth of a step.

The first root of an expression along a run in machine precision, whatever the scene.

With heyoka the Taylor polynomial of the expression over each step is searched for all its real roots; SciPy's
stand-in looks for sign changes on the step's own interpolant, sixteen to a step.
"""
from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from ..physics.states import equations_and_start
from ..physics.to_numpy import lambdified, to_numpy
from .quadratic_series import in_unit, mass_unit, own_unit
from .to_heyoka import TAYLOR_TOLERANCE, heyoka_available, taylor_events
from .trajectory import FALLBACK_RTOL, STEP_LIMIT, floor, root_between, sign_changes, stand_in

SUBSAMPLES = 16


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
    reason: str

    def extremes(self, components=(0, 1, 2)):
        """(m, 2) smallest and largest value of the components over the span, its two ends included."""
        result = np.sort(np.stack([self.start[list(components)], self.end[list(components)]], axis=1), axis=1)
        for n, i in enumerate(components):
            values = self.states[self.component == i, i]
            if values.size:
                result[n] = min(result[n, 0], values.min()), max(result[n, 1], values.max())
        return result


def roots_of_rates(scene, state, t_end: float, tolerance: float = TAYLOR_TOLERANCE) -> RateRoots:
    """Every root of x_i' for 0 < |t| < |t_end|, for the motion that is at `state` (as `trajectory` takes it)
    at t = 0.

    t_end: s (tau when scaled), of either sign. Raises InputError for a state that is none. Rates
    that vanish identically have no roots.
    """
    equations, state = equations_and_start(scene, state)
    with np.errstate(all="ignore"):
        rates = to_numpy(equations)(state)
    if not np.isfinite(rates).all():
        return _sorted([], state, state, 0.0, "none", 0, "stopped: the rates overflow at the start")
    if equations.blocks == ("omega",):
        unit, mass = own_unit(scene, state.tolist(), rates.tolist()), mass_unit(scene)
        if unit != 1 or mass != 1:
            return _in_unit(scene, state, float(t_end), tolerance, unit, mass)
    search = _taylor_roots if heyoka_available() else _scipy_roots
    return search(equations, state, float(t_end), tolerance)


def _in_unit(scene, state, t_end, tolerance, unit, mass) -> RateRoots:
    """The same in the motion's own units: exact, as they are powers of two."""
    found = roots_of_rates(in_unit(scene, unit, mass), state / unit, t_end * unit, tolerance)
    return replace(found, t=found.t / unit, states=found.states * unit, start=state, end=found.end * unit,
                   t_reached=found.t_reached / unit)


def _taylor_roots(equations, state, t_end, tolerance):
    with taylor_events(to_numpy(equations).motion_and_rates,
                       tolerance) as (integrator, found), np.errstate(all="ignore"):
        integrator.time = 0.0
        integrator.state[:] = state
        outcome, _, _, steps, *_ = integrator.propagate_until(t_end, max_steps=STEP_LIMIT)
        end, t_reached, hits = integrator.state.copy(), integrator.time, list(found)
    hits = [h for h in hits if h[0] != 0.0 and np.isfinite(h[2]).all()]
    if not np.isfinite(end).all():
        t_reached, _, end = hits[-1] if hits else (0.0, 0, state)
    reason = "" if outcome.name == "time_limit" else f"stopped: {outcome.name}"
    return _sorted(hits, state, end, t_reached, "taylor", steps, reason)


def _sorted(hits, start, end, t_reached, method, steps, reason):
    hits = sorted(hits, key=lambda h: abs(h[0]))
    return RateRoots(np.array([h[0] for h in hits]), np.array([h[1] for h in hits], int),
                     np.array([h[2] for h in hits]).reshape(-1, len(start)), np.array(start), np.array(end),
                     float(t_reached),
                     method, int(steps), reason)


def _scipy_roots(equations, state, t_end, tolerance):
    system, rtol = to_numpy(equations), max(tolerance, FALLBACK_RTOL)

    def run(t, y, end):
        return stand_in(system.rate, y, end, t, rtol, floor(state, rtol))

    if t_end == 0:
        return _sorted([], state, state, 0.0, "DOP853", 0, "")
    solver, hits, steps = run(0.0, state, t_end), [], 0
    with np.errstate(all="ignore"):
        while solver.status == "running" and steps < STEP_LIMIT:
            before = solver.y.copy()
            solver.step()
            if solver.status == "failed" or not np.isfinite(solver.y).all():
                return _sorted(hits, state, before, solver.t_old or 0.0, "DOP853", steps,
                               "stopped: the numbers overflowed")
            steps += 1
            hits += _step_roots(system, solver, before, run)
    reason = "" if solver.status == "finished" else f"stopped: {STEP_LIMIT} steps were not enough"
    return _sorted(hits, state, solver.y, solver.t, "DOP853", steps, reason)


def _step_roots(system, solver, before, run):
    """Sign changes of the rates within one step, each polished on the motion itself."""
    dense, hits = solver.dense_output(), []
    times = np.linspace(solver.t_old, solver.t, SUBSAMPLES + 1)
    rates = system(dense(times).T)
    for i in range(len(before)):
        for left in sign_changes(rates[:, i]):
            t = root_between(lambda y, i=i: system.rate(y.tolist())[i], dense, times[left], times[left + 1])
            hits.append((t, i, _land(run, solver.t_old, before, t)))
        hits += [(times[n], i, dense(times[n])) for n in np.nonzero(rates[1:, i] == 0)[0] + 1
                 if np.abs(rates[:, i]).max() > 0]
    return hits


def _land(run, t, y, t_end):
    """The state at t_end by steps of the method that end there (free of the interpolant's error)."""
    if t == t_end:
        return y
    solver = run(t, y, t_end)
    while solver.status == "running":
        solver.step()
    return solver.y


TOGETHER = 400  # steps between looks at what was found
# natural times a step may take: a motion that is a polynomial of time has steps without end, whose powers
# overflow
LONGEST = 1e6


@dataclass(frozen=True)
class FirstRoot:
    """t: the first root, None where none was found; until: the time that the run reached; ended: whether that
    is the time asked for; steps: taken."""

    t: float | None
    until: float
    ended: bool
    steps: int


def root_of(forms, rate, state, t_max: float, steps: int, tolerance: float = TAYLOR_TOLERANCE) -> FirstRoot:
    """The first time in (0, t_max] at which one of the expressions of a form is zero, which stand behind its
    rates.

    rate: of a list of floats; state: (N,) at time 0; steps: after so many the run is given up.
    """
    with np.errstate(all="ignore"):
        longest = _longest(np.asarray(rate(state.tolist()), float), state)
    if heyoka_available():
        return _by_taylor(forms, state, t_max, steps, tolerance, longest)
    return _by_scipy(forms, rate, state, t_max, steps, tolerance)


def _by_taylor(forms, state, t_max, steps, tolerance, longest):
    with taylor_events(forms, tolerance) as (integrator, found), np.errstate(all="ignore"):
        integrator.time, done = 0.0, 0
        integrator.state[:] = state
        while True:
            outcome, _, _, taken, *_ = integrator.propagate_until(
                t_max, max_steps=min(TOGETHER, steps - done), max_delta_t=longest)
            done += taken
            hits = [t for t, *_ in found if t > 0]
            if hits:
                return FirstRoot(min(hits), float(integrator.time), True, done)
            alive = np.isfinite(integrator.state).all()
            if outcome.name != "step_limit" or done >= steps or not alive:
                return FirstRoot(None, float(integrator.time) if alive else 0.0,
                                 outcome.name == "time_limit" and bool(alive), done)


def _longest(changes, state) -> float:
    """The longest step, by the rates of the start and the roots of their changes."""
    changes = np.abs(changes[:3])
    size = max(float(np.abs(state[:3]).max()),
               math.sqrt(float(changes.max())) if np.isfinite(changes).all() else 1.0)
    return LONGEST / size if size > 0 else math.inf


def _by_scipy(forms, rate, state, t_max, steps, tolerance):
    values = _compiled(forms, len(forms.state))
    solver = stand_in(rate, state, t_max, rtol=max(tolerance, FALLBACK_RTOL))
    for done in range(steps):
        if solver.status != "running":
            break
        with np.errstate(all="ignore"):
            solver.step()
        if solver.status == "failed" or not np.isfinite(solver.y).all():
            return FirstRoot(None, float(solver.t_old or 0.0), False, done)
        if roots := _of_step(values, solver.dense_output(), solver.t_old, solver.t):
            return FirstRoot(float(min(roots)), float(solver.t), True, done)
    return FirstRoot(None, float(solver.t), solver.status == "finished", steps)


def _of_step(values, dense, begin, end):
    """The first sign change of each expression within one step."""
    times, roots = np.linspace(begin, end, SUBSAMPLES + 1), []
    for n, row in enumerate(np.array([values(y) for y in dense(times).T]).T):
        for left in sign_changes(row)[:1]:
            roots.append(root_between(lambda y, n=n: values(y)[n], dense, times[left], times[left + 1]))
    return roots


def _compiled(forms, count):
    function = lambdified(forms.state + forms.symbols, list(forms.expressions[count:]))
    return lambda y: function(*map(float, y), *forms.numbers)
