"""The steps of a run that looks for a certificate of growth, with the last reversal of its turn: by Taylor series, or by SciPy in their place."""
from __future__ import annotations

from fractions import Fraction

import numpy as np

from ...integrate import to_heyoka
from ...integrate.stand_in import stand_in
from ...integrate.trajectory import ATOL_SHARE, FALLBACK_RTOL
from ...physics.equations import derive
from ...physics.scene import ScaledGyrostat
from ...physics.to_numpy import form, to_numpy


def runner(c, y):
    """run(t, step limit) -> (time reached, state, last reversal of the turn on the way or None, steps)."""
    equations = derive(ScaledGyrostat(Fraction(c) / -2, Fraction(c) / 2, (1, 0, 0)))
    _, x2, x3 = equations.state
    turn = x2 * equations.rhs[2] - x3 * equations.rhs[1]  # R^2 phi'
    maker = _taylor_runner if to_heyoka.heyoka_available() else _scipy_runner
    return maker(equations, form(equations, (*equations.rhs, turn)), y)


def _taylor_runner(equations, forms, y):
    at = [0.0, y]

    def run(t, limit):
        with to_heyoka.taylor_events(forms) as (integrator, found):
            integrator.time = at[0]
            integrator.state[:] = at[1]
            steps = integrator.propagate_until(t, max_steps=limit)[3]
            at[:] = integrator.time, tuple(integrator.state.tolist())
            reversals = [time for time, *_ in found]
        return at[0], at[1], max(reversals, default=None), steps
    return run


def _scipy_runner(equations, forms, y):
    from scipy.optimize import brentq
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
