"""Many motions of one scene by compiled Taylor steps, a small change of each carried beside it: `way.runs.Runs` for batches."""
from __future__ import annotations

import numpy as np

from ..way.runs import Runs
from . import lanes, steps
from .door import functions


class CompiledRuns(Runs):
    """As `Runs`; the change beside a motion obeys its linear equation and needs no second run."""

    def __init__(self, scene, states, table: dict | None = None):
        super().__init__(scene, states)
        self.table = functions(steps) if table is None else table
        self.taylor, self.numbers = True, np.array(self.coefficients, float)
        count = 3 * (steps.ORDER + 1)
        self.work = [np.empty(shape) for shape in ((12, lanes.WIDE), (12, lanes.WIDE), (count, lanes.WIDE), (count, lanes.WIDE), (6, lanes.WIDE))]
        self.small = np.empty((lanes.WIDE, 3)), np.empty(3), np.empty(3)

    def advance(self, rows, steps: int, t_max: float, pause: float = 0.0):
        self.steps_done += steps
        twins, (starts, *vectors) = self.twins, self.small
        self.table["advance"](self.numbers, rows, steps, t_max, pause, self.step_error, self.states, self.times, twins.growth, twins.most, twins.ahead,
                              twins.blur, self.steps, self.rounded, starts, *self.work, *vectors)

    def measure(self, rows, out):
        self.table["measure"](rows, self.states, self.steps, self.rounded, self.twins.growth, self.step_error, out.condition, out.reach, out.largest, out.least)

    def over(self, rows, t_max: float, budget: int):
        out = np.empty(len(rows), bool)
        self.table["over"](rows, self.states, self.times, self.steps, t_max, budget, out)
        return out

    def _batches(self, states, times, ends, steps, tolerance):
        out, spans = np.empty_like(states), np.empty_like(times)
        self.table["carry"](self.numbers, np.ascontiguousarray(states), ends - times, steps, out, spans, *self.work)
        return out, np.where(spans == ends - times, ends, times + spans)
