"""A run that looks for a certificate of growth."""
from __future__ import annotations

import math
from fractions import Fraction

from ..physics.equations import derive
from ..physics.scene import ScaledGyrostat
from .growth_certificates import certificate

# Units of rounding by which a step of the run (a Taylor polynomial of 20 terms) may move the motion: generous, for the boundary is met seldom.
STEP_ROUNDINGS = 64
# Steps of the search: several seconds where the fate hangs on it, one or two where only the time of release does.
STEP_BUDGET, RELEASE_BUDGET = 5_000_000, 2_000_000


def search_certificate(c, y, t_max):
    """(certificate or "none", its time, state there, last reversal of the turn, steps): run until one holds."""
    if found := certificate(c, y):
        return found, 0.0, y, 0.0, 0
    if not math.isfinite(sum(v * v for v in y) * (1 + c * c)):
        return "none", None, y, 0.0, 0
    run, t, last, steps = _runner(c, y), 0.0, 0.0, 0
    budget = STEP_BUDGET if c < 0 else RELEASE_BUDGET
    while t < t_max and steps < budget:
        t = min(t_max, t + max(1.0 / (1 + abs(c) + max(map(abs, y))), 0.2 * t))
        t, y, reversal, taken = run(t, budget - steps)
        last, steps = reversal if reversal is not None else last, steps + taken
        if not all(map(math.isfinite, y)):
            break
        if found := certificate(c, y):
            return found, t, y, last, steps
    return "none", None, y, last, steps


def nearest_other(c, y, t_max, name, steps):
    """The relative change of the state within the run's rounding that leads to another end; None where there is none."""
    reach = STEP_ROUNDINGS * 2.0**-52 * (steps + 1)
    length = reach * (max(map(abs, y)) + abs(c))
    for i in range(3):
        for move in (-length, length):
            if search_certificate(c, (*y[:i], y[i] + move, *y[i + 1:]), t_max)[0] != name:
                return reach
    return None


def _runner(c, y):
    """run(t, step limit) -> (time reached, state, last reversal of the turn on the way or None, steps)."""
    from ..integrate.to_heyoka import heyoka_available
    from ..physics.to_numpy import form
    equations = derive(ScaledGyrostat(Fraction(c) / -2, Fraction(c) / 2, (1, 0, 0)))
    _, x2, x3 = equations.state
    turn = x2 * equations.rhs[2] - x3 * equations.rhs[1]  # R^2 phi'
    maker = _taylor_runner if heyoka_available() else _scipy_runner
    return maker(equations, form(equations, (*equations.rhs, turn)), y)


def _taylor_runner(equations, forms, y):
    from ..integrate.to_heyoka import taylor_events
    at = [0.0, y]

    def run(t, limit):
        with taylor_events(forms) as (integrator, found):
            integrator.time = at[0]
            integrator.state[:] = at[1]
            steps = integrator.propagate_until(t, max_steps=limit)[3]
            at[:] = integrator.time, tuple(integrator.state.tolist())
            reversals = [time for time, *_ in found]
        return at[0], at[1], max(reversals, default=None), steps
    return run


def _scipy_runner(equations, forms, y):
    import numpy as np
    from scipy.optimize import brentq

    from ..integrate.stand_in import stand_in
    from ..integrate.trajectory import ATOL_SHARE, FALLBACK_RTOL
    from ..physics.to_numpy import to_numpy
    system, at = to_numpy(equations), [0.0, np.array(y)]

    def turn(x):
        rate = system.rate(list(x))
        return x[1] * rate[2] - x[2] * rate[1]

    def run(t, limit):
        solver = stand_in(system.rate, at[1], t, at[0], atol=FALLBACK_RTOL * ATOL_SHARE)
        steps, last = 0, None
        while solver.status == "running" and steps < limit:
            solver.step()
            steps += 1
            dense, times = solver.dense_output(), np.linspace(solver.t_old, solver.t, 9)
            values = np.array([turn(x) for x in dense(times).T])
            for n in np.nonzero(values[:-1] * values[1:] < 0)[0]:
                last = brentq(lambda s, dense=dense: turn(dense(s)), times[n], times[n + 1])
        at[:] = solver.t, solver.y
        return solver.t, tuple(solver.y.tolist()), last, steps
    return run
