"""Many motions of one scene, each by its own steps, and how much a small change of each has grown: heyoka's batches, or SciPy row by row."""
from __future__ import annotations

from functools import lru_cache

import numpy as np

from ....integrate.ensemble import LANES
from ....integrate.stand_in import stand_in
from ....integrate.to_heyoka import TAYLOR_TOLERANCE, borrowed_taylor, heyoka_available
from ....integrate.trajectory import FALLBACK_RTOL
from ....numbers.vectors import CYCLE
from ....physics.to_numpy import Form
from .twins import STILL, Twins

WIDE = 32  # lanes where there are so many rows: the calls, not the steps, are what short advances cost

# Of twins, relative: over the two thousand steps of an advance the tolerance of their steps moves them by a hundredth of that, and a delay of a
# thousand times that is still small.
APART, LOOSE, CLOSE = 2.0**-16, 1e-10, 2.0**-28  # those that go too far apart are run again, closer
TOLD = 8.0  # of a change beside a steady motion, the logarithm of its growth over an advance: a close twin is then still beside the motion
BEYOND = 2.0**60  # growth of which nothing more need be known: no certificate holds for a ball of its size
STEEP = 8.0  # of a step times the slopes of the rates: a motion that hardly leaves a steady one has coefficients that would allow any


class Runs:
    """States (n, 3) and times (n,) of motions that `advance` carries on; rows that cannot go on are not finite any more.

    The rows advance by steps, not to common times: no step is cut short, and no lane waits for another. steps (n,): computed; rounded (n,): those that
    running all the way would have taken, each of which rounds.
    """

    def __init__(self, scene, states):
        self.quadratic = scene.quadratic()
        self.coefficients = [np.array(row) for row in self.quadratic.coefficients]
        self.states, self.times = np.array(states, float), np.zeros(len(states))
        self.twins = Twins(len(states), self.rates)
        self.taylor = heyoka_available()
        self.form = _form(self.quadratic)
        self.steps_done = 0  # of a row that never leapt
        self.steps, self.rounded = np.zeros(len(states), int), np.zeros(len(states))  # computed, and passed, of each row
        if not self.taylor:
            self.solvers = [None] * len(states)

    # Units of rounding by which a step may move the motion: a Taylor polynomial of 20 terms; what DOP853 is asked for.
    @property
    def step_error(self) -> float:
        return 2.0**-52 if self.taylor else 4 * FALLBACK_RTOL

    def advance(self, rows, steps: int, t_max: float, pause: float = 0.0):
        """Carry the given rows (indices) on by so many steps, or to t_max; a row that has not passed the time `pause` stops there."""
        self.steps_done += steps
        self.steps[rows] += steps
        self.rounded[rows] += steps
        starts, times, ends = self.states[rows], self.times[rows], np.where(self.times[rows] < pause, min(pause, t_max), t_max)
        with np.errstate(all="ignore"):
            ends = np.minimum(ends, times + self._spans(rows, starts))
            if self.taylor:
                self.states[rows], self.times[rows] = self._batches(starts, times, ends, steps, TAYLOR_TOLERANCE)
            else:
                for row, end in zip(rows, ends):
                    self._alone(row, steps, t_max, end)
            left = np.arange(len(rows))
            for apart, tolerance in ((APART, LOOSE), (CLOSE, TAYLOR_TOLERANCE)):
                twins, far = self.twins.start(rows[left], starts[left], apart)
                twins = self._twins(twins, times[left], self.times[rows[left]], 8 * steps, tolerance)
                left = left[self.compare(rows[left], starts[left], twins, 0.0, far)]
            self.twins.growth[rows[left]] = np.inf

    def _spans(self, rows, starts):
        """(m,) how long rows may be carried on at once. A twin beside a steady motion that is none (a saddle) leaves it, goes round, and comes back close to it
        in the end: what is seen there is not the growth. Over the span in which the linear change grows e^TOLD times a close twin has not left."""
        out = np.full(len(rows), np.inf)
        still = np.sqrt((self.rates(starts) ** 2).sum(axis=1)) <= STILL * np.maximum(np.abs(starts).max(axis=1), 1.0)
        still &= (self.twins.growth[rows] < BEYOND) & np.isfinite(starts).all(axis=1)
        if still.any():
            out[still] = TOLD / np.maximum(np.linalg.eigvals(self.derivatives(starts[still])).real.max(axis=1), 1e-300)
        return out

    def _twins(self, twins, times, ends, steps, tolerance):
        """Where twins come to at the ends; not finite where these are not: rates beyond doubles leave a motion without a time."""
        known, out = np.isfinite(ends), np.full_like(twins, np.nan)
        if self.taylor:
            out[known], _ = self._batches(twins[known], times[known], ends[known], steps, tolerance)
        else:
            for n in np.flatnonzero(known):
                out[n] = self._twin_alone(twins[n], times[n], ends[n], steps, tolerance)
        return out

    def compare(self, rows, starts, twins, delays, apart):
        """Take note of how twins have gone apart, and say where they tell nothing (`Twins.compare`)."""
        error = self.step_error * self.rounded[rows] * np.sqrt((starts**2).sum(axis=1))
        return self.twins.compare(rows, starts, self.states[rows], twins, delays, apart, error)

    def measure(self, rows, out):
        """Note in columns (n,) of `chase.Chased` how much a small change of rows has grown, how far their rounding reaches, and (n, 48) their sizes."""
        out.condition[rows] = np.fmax(out.condition[rows], self.twins.growth[rows])
        doubling = np.log2(1.0 + self.steps[rows]).astype(int)
        with np.errstate(all="ignore"):
            most, size = np.maximum(np.abs(self.states[rows]).max(axis=1), 1.0), np.sqrt((self.states[rows] ** 2).sum(axis=1))
            out.reach[rows] = np.where(self.rounded[rows] > 0, self.step_error * (1 + self.rounded[rows]) * out.condition[rows] * most, 0.0)
        out.largest[rows, doubling] = np.fmax(out.largest[rows, doubling], size)
        out.least[rows, doubling] = np.fmin(out.least[rows, doubling], size)

    def over(self, rows, t_max: float, budget: int):
        """(m,) which of rows are at the end of their time or of their steps, or beyond doubles."""
        return (self.times[rows] >= t_max) | (self.steps[rows] >= budget) | ~np.isfinite(self.states[rows]).all(axis=1)

    def rates(self, states):
        """The rates of change at states (m, 3)."""
        y, z = states[:, [1, 2, 0]], states[:, [2, 0, 1]]
        c = self.coefficients
        return c[0] * y * z + c[1] * z + c[2] * y + c[3]

    def slopes(self, states, directions):
        """How the rates change along directions (m, 3)."""
        y, z, v, w = states[:, [1, 2, 0]], states[:, [2, 0, 1]], directions[:, [1, 2, 0]], directions[:, [2, 0, 1]]
        c = self.coefficients
        return c[0] * (y * w + v * z) + c[1] * w + c[2] * v

    def derivatives(self, states):
        """(m, 3, 3) of the rates at states (m, 3)."""
        y, z, out = states[:, [1, 2, 0]], states[:, [2, 0, 1]], np.zeros((len(states), 3, 3))
        c = self.coefficients
        out[:, [0, 1, 2], [1, 2, 0]], out[:, [0, 1, 2], [2, 0, 1]] = c[0] * z + c[2], c[0] * y + c[1]
        return out

    def steepest(self, states):
        """(m,) greatest sums of sizes in a row of the rates' derivative at states (m, 3)."""
        return np.abs(self.derivatives(states)).sum(axis=2).max(axis=1)

    def slopes_back(self, states, weights):
        """The gradient of the rates' sum with weights (m, 3)."""
        c = [row * weights for row in self.coefficients[:3]]
        y, z = states[:, [1, 2, 0]], states[:, [2, 0, 1]]
        return (c[0] * z + c[2])[:, [2, 0, 1]] + (c[0] * y + c[1])[:, [1, 2, 0]]

    def carried(self, states, spans, most: int):
        """(states, times) of motions from states (m, 3) after spans (m,) of time, forth or back, or after the most steps."""
        return self._batches(states, np.zeros(len(states)), spans, most, TAYLOR_TOLERANCE)

    def _batches(self, states, times, ends, steps, tolerance):
        """(states, times) after so many steps, or at the ends (n,)."""
        out, reached, n = np.empty_like(states), np.empty_like(times), len(states)
        wide = n - n % WIDE if n >= WIDE else 0
        with np.errstate(all="ignore"):
            longest = np.nan_to_num(STEEP / self.steepest(states), nan=np.inf, posinf=np.inf)
        for lanes, part in ((WIDE, np.arange(wide)), (LANES, np.arange(wide, n))):
            if not part.size:
                continue
            filled = np.append(part, np.repeat(part[-1:], -len(part) % lanes)).reshape(-1, lanes)
            with borrowed_taylor(self.form, tolerance, lanes) as ta, np.errstate(all="ignore"):
                for group in filled:
                    ta.set_time(times[group])
                    ta.state[:] = states[group].T
                    ta.propagate_until(ends[group], max_steps=steps, max_delta_t=longest[group])
                    out[group], reached[group] = ta.state.T, ta.time
        return out, reached

    def _alone(self, row, steps, t_max, end):
        if self.solvers[row] is None:
            self.solvers[row] = self._solver(self.states[row], 0.0, t_max, FALLBACK_RTOL)
        solver = self.solvers[row]
        solver.max_step = self._longest(solver.y)
        for _ in range(steps):
            if solver.status == "running" and solver.t < end:
                solver.step()
        self.states[row] = solver.y if solver.status != "failed" else np.nan
        self.times[row] = solver.t

    def _twin_alone(self, state, start, end, steps: int, rtol):
        if not (end > start and np.isfinite(state).all()):
            return state
        solver = self._solver(state, start, end, max(rtol, FALLBACK_RTOL))
        solver.max_step = self._longest(state)
        for _ in range(steps):  # a twin that needs more has left its motion, and tells nothing of it
            if solver.status == "running":
                solver.step()
        return solver.y if solver.status == "finished" else np.full(3, np.nan)

    def _longest(self, state):
        """As of Taylor steps: the solver's error beside a steady motion would allow any."""
        with np.errstate(all="ignore"):
            return float(np.nan_to_num(STEEP / self.steepest(state[None])[0], nan=np.inf, posinf=np.inf))

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
