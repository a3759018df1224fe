"""Many motions of one scene by Taylor steps (`steps`), and how much a small change of each has grown.

A change along a motion is a mere delay. It alters nothing in what the motion comes to, but it grows (the
faster of two turns round ever farther ahead), and a large delay would be taken for a change across. So the
two are told apart: what lies across the motion is followed from advance to advance, and tells the growth; the
delay is a blur of the time. Where a motion hardly moves, all is across. Over steps the change obeys the
linear equation beside the motion; over a window of many revolutions (`drift`) a twin runs from close by.
"""
from __future__ import annotations

import numpy as np

from . import steps as kernel
from .lanes import WIDE, functions

STEP_ERROR = 2.0**-52  # units of rounding by which a step may move a motion: a Taylor polynomial of 20 terms
BROADEST = 256  # motions side by side where nothing is compiled
STILL = 2.0**-8  # rates per size (or per natural unit) below which no delay is told from a change
FAR = 2.0**-6    # changes beyond this share of the size, or delays of so many radians, tell no growth
LOST = 2.0**-30  # what lies across a motion is taken to be no less, relative to the change


class Runs:
    """States (n, 3) and times (n,) of motions that `advance` carries on; rows that cannot go on are not
    finite any more.

    The rows advance by steps, not to common times: no step is cut short, and no row depends on another. steps
    (n,): computed; rounded (n,): those that running all the way would have taken, each of which rounds. fast:
    compiled steps.
    """

    def __init__(self, scene, states, fast: bool = False):
        self.coefficients = np.array([np.array(row, float) for row in scene.quadratic().coefficients])
        self.states, self.times, self.fast = np.array(states, float), np.zeros(len(states)), fast
        self.twins = Twins(len(states), self.rates)
        self.steps_done = 0  # of a row that never leapt
        # computed, and passed, of each row
        self.steps, self.rounded = np.zeros(len(states), int), np.zeros(len(states))
        self.met = np.repeat([[0.0], [np.inf]], len(states), axis=1)  # sizes since the last look

    def _call(self, name, *arguments):
        with np.errstate(all="ignore"):
            functions(kernel, self.fast)[name](*arguments)

    def _work(self, n):
        """Arrays to work in, for n motions."""
        wide = WIDE if self.fast else min(n, BROADEST)
        count = 3 * (kernel.ORDER + 1)
        return [np.empty((rows, wide)) for rows in (12, 12, count, count, 8)]

    def advance(self, rows, steps: int, t_max: float, pause: float = 0.0):
        """Carry the given rows (indices) on by so many steps, or to t_max; a row that has not passed the time
        `pause` stops there."""
        self.steps_done += steps
        twins, work = self.twins, self._work(len(rows))
        changes = twins.growth, twins.most, twins.ahead, twins.blur
        starts = np.empty((work[0].shape[1], 3))
        self._call("advance", self.coefficients, rows, steps, t_max, pause, STEP_ERROR, self.states,
                   self.times, *changes, self.met, self.steps, self.rounded, starts, *work, *np.empty((2, 3)))

    def carried(self, states, spans, most: int):
        """(states, times) of motions from states (m, 3) after spans (m,) of time, forth or back, or after the
        most steps."""
        out, times = np.empty_like(states), np.empty_like(spans)
        states, work = np.ascontiguousarray(states), self._work(len(states))
        self._call("carry", self.coefficients, states, spans, most, out, times, *work)
        return out, times

    def measure(self, rows, out):
        """Note in columns (n,) of `follow.Chased` how much a small change of rows has grown, how far their
        rounding reaches, and (n, 48) their sizes."""
        self._call("measure", rows, self.states, self.steps, self.rounded, self.twins.growth, self.met,
                   STEP_ERROR, out.condition, out.reach, out.largest, out.least)

    def over(self, rows, t_max: float, budget: int):
        """(m,) which of rows are at the end of their time or of their steps, or beyond doubles."""
        out = np.empty(len(rows), bool)
        self._call("over", rows, self.states, self.times, self.steps, t_max, budget, out)
        return out

    def compare(self, rows, starts, twins, delays, apart):
        """Take note of how twins have gone apart, and say where they tell nothing (`Twins.compare`)."""
        error = STEP_ERROR * self.rounded[rows] * np.sqrt((starts**2).sum(axis=1))
        return self.twins.compare(rows, starts, self.states[rows], twins, delays, apart, error)

    def rates(self, states):
        """The rates of change at states (m, 3)."""
        y, z = states[:, [1, 2, 0]], states[:, [2, 0, 1]]
        c = self.coefficients
        return c[0] * y * z + c[1] * z + c[2] * y + c[3]

    def slopes(self, states, directions):
        """How the rates change along directions (m, 3)."""
        y, z, v, w = states[:, [1, 2, 0]], states[:,
                                                  [2, 0, 1]], directions[:,
                                                                         [1, 2, 0]], directions[:, [2, 0, 1]]
        c = self.coefficients
        return c[0] * (y * w + v * z) + c[1] * w + c[2] * v

    def slopes_back(self, states, weights):
        """The gradient of the rates' sum with weights (m, 3)."""
        c = [row * weights for row in self.coefficients[:3]]
        y, z = states[:, [1, 2, 0]], states[:, [2, 0, 1]]
        return (c[0] * z + c[2])[:, [2, 0, 1]] + (c[0] * y + c[1])[:, [1, 2, 0]]


class Twins:
    """growth (n,): of a small change of the start across the motion, along the direction `ahead` that it
    turned to (largest entry 1); inf where it could not be told any more; most (n,): the most it was. blur
    (n,): of the time. rates: function of states (m, 3)."""

    def __init__(self, n: int, rates):
        self.growth, self.most, self.ahead = np.ones(n), np.ones(n), np.tile([1.0, -1.0, 1.0], (n, 1))
        self.blur, self.rates = np.zeros(n), rates

    def start(self, rows, states, apart: float):
        """(twins (m, 3), how far they are (m,)) of rows at their states; apart: relative to these, or to the
        natural rate."""
        unit = self._along(states)
        across = self.ahead[rows] - unit * (self.ahead[rows] * unit).sum(axis=1)[:, None]
        none = np.abs(across).max(axis=1) < LOST
        if none.any():
            other = np.cross(unit[none], np.roll(unit[none], 1, axis=1) + [0.0, 0.0, 0.1])
            across[none] = LOST * other / np.sqrt((other**2).sum(axis=1))[:, None]
        far = apart * _size(states) / np.abs(across).max(axis=1)
        return states + far[:, None] * across, far

    def compare(self, rows, starts, states, twins, delays, apart, error):
        """Take note of what has become of changes of the size `apart` (m,): states (m, 3), and twins, which
        passed the same place delays (m,) later. error (m,): of the places, in all, but for the growth.
        Returns (m,) where they tell nothing: nothing is noted there."""
        unit, change, told = self._along(states), twins - states, np.ones(len(rows), bool)
        speed, room = (self.rates(states) * unit).sum(axis=1), FAR * _size(states)
        # the twin where it was, or will be, beside the motion: to second order in the delay
        for _ in range(2):
            more = np.where(speed > 0, -(change * unit).sum(axis=1) / speed, 0.0)
            rate = self.rates(states + change)
            change, delays = change + more[:,
                                           None] * self.rates(states + change
                                                              + 0.5 * more[:, None] * rate), delays + more
            told &= np.abs(more) * speed < room
        size, first = np.abs(change).max(axis=1), np.sqrt((self.rates(starts)**2).sum(axis=1))
        told &= size < room
        yes = rows[told]
        self.blur[yes] += (error * self.most[rows]
                           * (np.abs(delays) / apart
                              + np.where(first > STILL * _size(starts), 1 / first, 0.0)))[told]
        self.growth[yes] *= (size / apart)[told]
        self.most[yes] = np.fmax(self.most[yes], self.growth[yes])
        turned = told & (size > 0)
        self.ahead[rows[turned]] = change[turned] / size[turned, None]
        return ~told

    def _along(self, states):
        """Unit vectors along the motions (m, 3); zero where they hardly move."""
        rates = self.rates(states)
        speed = np.sqrt((rates**2).sum(axis=1))
        return np.where((speed > STILL * _size(states))[:, None], rates / speed[:, None], 0.0)


def _size(states):
    return np.maximum(np.abs(states).max(axis=1, initial=0.0), 1.0)
