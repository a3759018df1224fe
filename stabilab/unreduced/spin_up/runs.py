"""Many motions of one scene, each by its own steps: heyoka's batches, or SciPy row by row where heyoka is not installed."""
from __future__ import annotations

from functools import lru_cache

import numpy as np

from ...integrate.ensemble import LANES
from ...integrate.to_heyoka import borrowed_taylor, heyoka_available
from ...integrate.trajectory import ATOL_SHARE, FALLBACK_RTOL
from ...numbers.vectors import CYCLE
from ...physics.to_numpy import Form


class Runs:
    """States (n, 3) and times (n,) of motions that `advance` carries on; rows that cannot go on are not finite any more.

    The rows advance by steps, not to common times: no step is cut short, and no lane waits for another.
    """

    def __init__(self, scene, states):
        self.quadratic = scene.quadratic()
        self.coefficients = [np.array(row) for row in self.quadratic.coefficients]
        self.states, self.times = np.array(states, float), np.zeros(len(states))
        self.taylor = heyoka_available()
        self.steps_done = 0  # of each row
        if not self.taylor:
            self.solvers = [None] * len(states)

    # Units of rounding by which a step may move the motion: a Taylor polynomial of 20 terms; what DOP853 is asked for.
    @property
    def step_error(self) -> float:
        return 2.0**-52 if self.taylor else 4 * FALLBACK_RTOL

    def advance(self, rows, steps: int, t_max: float, pause: float = 0.0):
        """Carry the given rows (indices) on by so many steps, or to t_max; a row that has not passed the time `pause` stops there."""
        self.steps_done += steps
        if self.taylor:
            self._batches(rows, steps, t_max, pause)
        else:
            for row in rows:
                self._alone(row, steps, t_max)

    def rates(self, rows):
        """The rates of the given rows now, (m, 3)."""
        (kappa, rho, sigma, m), x = self.coefficients, self.states[rows]
        j, k = x[:, [1, 2, 0]], x[:, [2, 0, 1]]
        return kappa * j * k + rho * k + sigma * j + m

    def _batches(self, rows, steps, t_max, pause):
        filled = np.append(rows, np.repeat(rows[-1:], -len(rows) % LANES)).reshape(-1, LANES)
        with borrowed_taylor(_form(self.quadratic), lanes=LANES) as ta, np.errstate(all="ignore"):
            for group in filled:
                times = self.times[group]
                ta.set_time(times)
                ta.state[:] = self.states[group].T
                ta.propagate_until(np.where(times < pause, min(pause, t_max), t_max), max_steps=steps)
                self.states[group], self.times[group] = ta.state.T, ta.time

    def _alone(self, row, steps, t_max):
        from scipy.integrate import DOP853
        if self.solvers[row] is None:
            size = np.abs(self.states[row]).max() or 1.0
            self.solvers[row] = DOP853(lambda _, y: np.array(self.quadratic.rate(y.tolist())), 0.0, self.states[row], t_max,
                                       rtol=FALLBACK_RTOL, atol=FALLBACK_RTOL * ATOL_SHARE * size)
        solver = self.solvers[row]
        for _ in range(steps):
            if solver.status == "running":
                solver.step()
        self.states[row] = solver.y if solver.status != "failed" else np.nan
        self.times[row] = solver.t


def _form(quadratic) -> Form:
    """The rates for heyoka. Every scene has the same twelve coefficients, zeros too: it is compiled once for all."""
    state, symbols, expressions = _structure()
    return Form(state, expressions, symbols, sum(zip(*quadratic.coefficients), ()))


@lru_cache(maxsize=1)
def _structure():
    from sympy import symbols
    x, c = symbols("x1:4", real=True), symbols("c0:12", real=True)
    rates = [c[4 * i] * x[j] * x[k] + c[4 * i + 1] * x[k] + c[4 * i + 2] * x[j] + c[4 * i + 3] for i, (j, k) in enumerate(CYCLE)]
    return x, c, tuple(rates)
