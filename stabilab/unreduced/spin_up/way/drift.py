"""Motions carried on over many revolutions at once, beside their twins, where that is less work than step by step."""
from __future__ import annotations

import numpy as np

from .collocation import NODES, window
from .returns import Returns
from .runs import Runs

FROM = 20_000                      # steps that a motion is followed plainly first: to find out that it would not leap takes half as many
LEAST, FIRST, MOST = 512.0, 1024.0, 2.0**40  # revolutions of a window: fewer are hardly less work than step by step
AGAIN = 1.6                        # after how many times its steps a motion that would not leap is asked again

APART = 2.0**-26                   # of a twin, relative: a window of a million revolutions leaves it near


class Leaps:
    """The windows of the rows of `runs`: counts (n,) of revolutions of the next, periods (n,), steps (n,) of a revolution."""

    def __init__(self, runs: Runs):
        n = len(runs.states)
        self.runs, self.returns = runs, Returns(runs)
        self.counts, self.periods, self.steps = np.zeros(n), np.full(n, np.nan), np.zeros(n)
        self.due = np.full(n, FROM)

    def advance(self, rows, t_max: float, pause: float = 0.0):
        """The rows (of indices) that were carried on, each by one window; the others are left as they are, to go on step by step."""
        rows = rows[self.runs.steps[rows] >= self.due[rows]] if self.runs.taylor else rows[:0]
        if not rows.size:
            return rows
        with np.errstate(all="ignore"):
            self._find(rows[np.isnan(self.periods[rows])])
            ends = np.where(self.runs.times[rows] < pause, min(pause, t_max), t_max)
            counts = np.floor(np.fmin(np.fmin(self.counts[rows], MOST), (ends - self.runs.times[rows]) / self.periods[rows] * 0.9))
            able = counts >= LEAST
            done = np.zeros(len(rows), bool)
            if able.any():
                done[able] = self._leap(rows[able], counts[able])
            self._give_up(rows[~done & ((self.counts[rows] < LEAST) | np.isnan(self.periods[rows]) | ~able)])
        return rows[done]

    def _find(self, rows):
        """The first return of rows, and a first guess of how many are worth a window."""
        if not rows.size:
            return
        runs = self.runs
        self.periods[rows], self.steps[rows] = self.returns.first(runs.states[rows])
        runs.steps[rows] += self.steps[rows].astype(int)
        self.counts[rows] = np.where(np.isfinite(self.periods[rows]), FIRST, 0.0)

    def _give_up(self, rows):
        self.periods[rows], self.due[rows] = np.nan, (AGAIN * self.runs.steps[rows]).astype(int)

    def _leap(self, rows, counts):
        """Which rows went over a window of so many revolutions; the next window's are set for all."""
        runs, m = self.runs, len(rows)
        states = runs.states[rows]
        twins, apart = runs.twins.start(rows, states, APART)
        found = window(self.returns, np.concatenate([states, twins]), *(np.tile(v, 2) for v in (counts, self.periods[rows], self.steps[rows])))
        good, turns = found.good[:m] & found.good[m:], found.turns[:m]
        runs.steps[rows] += (turns * (NODES * self.steps[rows])).astype(int)
        done, passed, delays = rows[good], found.times[:m][good], (found.times[m:] - found.times[:m])[good]
        runs.rounded[done] += counts[good] * self.steps[done]
        runs.states[done], runs.times[done] = found.states[:m][good], runs.times[done] + passed
        lost = runs.compare(done, states[good], found.states[m:][good], delays, apart[good])
        runs.twins.growth[done[lost]] = np.inf
        runs.twins.blur[done] += runs.step_error * runs.rounded[done] * passed
        self.periods[done] = found.periods[:m][good]
        self.counts[rows] = np.where(good, counts * np.where(turns <= 8, 2.0, np.where(turns <= 11, 1.0, 0.5)), counts / 2)
        return good
