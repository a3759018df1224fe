"""The first root of an expression along a run in machine precision, whatever the scene.

With heyoka the Taylor polynomial of the expression over each step is searched for all its real roots; SciPy's stand-in looks for sign
changes on the step's own interpolant, sixteen to a step.
"""
from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..physics.to_numpy import form, lambdified, to_numpy
from .extrema import SUBSAMPLES
from .stand_in import root_between, sign_changes, stand_in
from .to_heyoka import TAYLOR_TOLERANCE, heyoka_available, taylor_events
from .trajectory import FALLBACK_RTOL

TOGETHER = 400  # steps between looks at what was found
LONGEST = 1e6  # natural times a step may take: a motion that is a polynomial of time has steps without end, whose powers overflow


@dataclass(frozen=True)
class FirstRoot:
    """t: the first root, None where none was found; until: the time that the run reached; ended: whether that is the time asked for; steps: taken."""

    t: float | None
    until: float
    ended: bool
    steps: int


def first_root(equations, state, expressions, t_max: float, steps: int, tolerance: float = TAYLOR_TOLERANCE) -> FirstRoot:
    """The first time in (0, t_max] at which one of the expressions (SymPy, in the equations' state and rationals) is zero.

    state: (N,) at time 0; steps: after so many the run is given up.
    """
    system, state = to_numpy(equations), np.asarray(state, float)
    with np.errstate(all="ignore"):
        changes = np.asarray(system(state), float)
    return root_of(form(equations, (*equations.rhs, *expressions)), system.rate, state, changes, t_max, steps, tolerance)


def root_of(forms, rate, state, changes, t_max: float, steps: int, tolerance: float = TAYLOR_TOLERANCE) -> FirstRoot:
    """The same of a form, the rates first and then the expressions; rate: of a list of floats; changes: (N,) the rates at time 0."""
    longest = _longest(np.asarray(changes, float), state)
    if heyoka_available():
        return _by_taylor(forms, state, t_max, steps, tolerance, longest)
    return _by_scipy(forms, rate, state, t_max, steps, tolerance)


def _by_taylor(forms, state, t_max, steps, tolerance, longest):
    with taylor_events(forms, tolerance) as (integrator, found), np.errstate(all="ignore"):
        integrator.time, done = 0.0, 0
        integrator.state[:] = state
        while True:
            outcome, _, _, taken, *_ = integrator.propagate_until(t_max, max_steps=min(TOGETHER, steps - done), max_delta_t=longest)
            done += taken
            hits = [t for t, *_ in found if t > 0]
            if hits:
                return FirstRoot(min(hits), float(integrator.time), True, done)
            alive = np.isfinite(integrator.state).all()
            if outcome.name != "step_limit" or done >= steps or not alive:
                return FirstRoot(None, float(integrator.time) if alive else 0.0, outcome.name == "time_limit" and bool(alive), done)


def _longest(changes, state) -> float:
    """The longest step, by the rates of the start and the roots of their changes."""
    changes = np.abs(changes[:3])
    size = max(float(np.abs(state[:3]).max()), math.sqrt(float(changes.max())) if np.isfinite(changes).all() else 1.0)
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
