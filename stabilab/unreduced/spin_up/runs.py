"""Many motions of one scene, each by its own steps, and how much a small change of each has grown: heyoka's batches, or SciPy row by row."""
from __future__ import annotations

from functools import lru_cache

import numpy as np

from ...integrate.ensemble import LANES
from ...integrate.stand_in import stand_in
from ...integrate.to_heyoka import TAYLOR_TOLERANCE, borrowed_taylor, heyoka_available
from ...integrate.trajectory import FALLBACK_RTOL
from ...numbers.vectors import CYCLE
from ...physics.to_numpy import Form

WIDE = 32  # lanes where there are so many rows: the calls, not the steps, are what short advances cost
# A twin starts so far from its motion, relative to the state or to the natural rate, anew at every advance. It only tells a growth, and takes
# steps of 1e-8: over the two thousand of an advance they move it by a tenth of that. Farther apart than FAR it tells none.
APART, LOOSE, FAR = 2.0**-12, 1e-8, 2.0**-3


class Runs:
    """States (n, 3) and times (n,) of motions that `advance` carries on; rows that cannot go on are not finite any more.

    The rows advance by steps, not to common times: no step is cut short, and no lane waits for another. growth (n,): by how much a
    small change of the start has grown, along the direction that it turned to; inf where it could not be told any more.
    """

    def __init__(self, scene, states):
        self.quadratic = scene.quadratic()
        self.coefficients = [np.array(row) for row in self.quadratic.coefficients]
        self.states, self.times = np.array(states, float), np.zeros(len(states))
        self.growth, self.ahead = np.ones(len(states)), np.tile([1.0, -1.0, 1.0], (len(states), 1))  # direction of the change, largest entry 1
        self.taylor = heyoka_available()
        self.form = _form(self.quadratic)
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
        times, states = self.times[rows], self.states[rows]
        apart = APART * np.maximum(np.abs(states).max(axis=1, initial=0.0), 1.0)[:, None]
        twins = states + apart * self.ahead[rows]
        if self.taylor:
            ends = np.where(times < pause, min(pause, t_max), t_max)
            self.states[rows], self.times[rows] = self._batches(states, times, ends, steps, TAYLOR_TOLERANCE)
            known = np.isfinite(self.times[rows])  # rates beyond doubles leave a motion without a time, and its twin with nothing to reach
            twins[known], _ = self._batches(twins[known], times[known], self.times[rows][known], 8 * steps, LOOSE)
            twins[~known] = np.nan
        else:
            for n, row in enumerate(rows):
                self._alone(row, steps, t_max)
                twins[n] = self._twin_alone(twins[n], times[n], self.times[row])
        with np.errstate(all="ignore"):
            change = twins - self.states[rows]
            size = np.abs(change).max(axis=1)
            size[~(size < FAR / APART * apart[:, 0])] = np.inf
            self.growth[rows] *= size / apart[:, 0]
            self.ahead[rows] = np.where(np.isfinite(size) & (size > 0), change.T / size, self.ahead[rows].T).T

    def _batches(self, states, times, ends, steps, tolerance):
        """(states, times) after so many steps, or at the ends (n,)."""
        out, reached, n = np.empty_like(states), np.empty_like(times), len(states)
        wide = n - n % WIDE if n >= WIDE else 0
        for lanes, part in ((WIDE, np.arange(wide)), (LANES, np.arange(wide, n))):
            if not part.size:
                continue
            filled = np.append(part, np.repeat(part[-1:], -len(part) % lanes)).reshape(-1, lanes)
            with borrowed_taylor(self.form, tolerance, lanes) as ta, np.errstate(all="ignore"):
                for group in filled:
                    ta.set_time(times[group])
                    ta.state[:] = states[group].T
                    ta.propagate_until(ends[group], max_steps=steps)
                    out[group], reached[group] = ta.state.T, ta.time
        return out, reached

    def _alone(self, row, steps, t_max):
        if self.solvers[row] is None:
            self.solvers[row] = self._solver(self.states[row], 0.0, t_max, FALLBACK_RTOL)
        solver = self.solvers[row]
        for _ in range(steps):
            if solver.status == "running":
                solver.step()
        self.states[row] = solver.y if solver.status != "failed" else np.nan
        self.times[row] = solver.t

    def _twin_alone(self, state, start, end):
        if not (end > start and np.isfinite(state).all()):
            return state
        solver = self._solver(state, start, end, LOOSE)
        while solver.status == "running":
            solver.step()
        return solver.y if solver.status == "finished" else np.full(3, np.nan)

    def _solver(self, state, start, end, rtol):
        return stand_in(self.quadratic.rate, state, end, start, rtol)


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
