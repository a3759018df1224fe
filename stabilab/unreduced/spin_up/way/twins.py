"""How much a small change of each motion has grown: a twin runs beside it, started anew from close by at every advance.

A change along a motion is a mere delay. It alters nothing in what the motion comes to, but it grows (the faster of two turns round ever farther
ahead), and what a finite twin shows of a large delay would be taken for a change across. So the two are told apart: what lies across the motion
is followed from advance to advance, and tells the growth; the delay is a blur of the time. Where a motion hardly moves, all is across.
"""
from __future__ import annotations

import numpy as np

STILL = 2.0**-8  # rates per size (or per natural unit) below which no delay is told from a change
FAR = 2.0**-6    # changes beyond this share of the size, or delays of so many radians, tell no growth
LOST = 2.0**-30  # what lies across a motion is taken to be no less, relative to the change


class Twins:
    """growth (n,): of a small change of the start across the motion, along the direction `ahead` that it turned to (largest entry 1); inf where it
    could not be told any more; most (n,): the most it was. blur (n,): of the time. rates: function of states (m, 3)."""

    def __init__(self, n: int, rates):
        self.growth, self.most, self.ahead = np.ones(n), np.ones(n), np.tile([1.0, -1.0, 1.0], (n, 1))
        self.blur, self.rates = np.zeros(n), rates

    def start(self, rows, states, apart: float):
        """(twins (m, 3), how far they are (m,)) of rows at their states; apart: relative to these, or to the natural rate."""
        unit = self._along(states)
        across = self.ahead[rows] - unit * (self.ahead[rows] * unit).sum(axis=1)[:, None]
        none = np.abs(across).max(axis=1) < LOST
        if none.any():
            other = np.cross(unit[none], np.roll(unit[none], 1, axis=1) + [0.0, 0.0, 0.1])
            across[none] = LOST * other / np.sqrt((other**2).sum(axis=1))[:, None]
        far = apart * _size(states) / np.abs(across).max(axis=1)
        return states + far[:, None] * across, far

    def compare(self, rows, starts, states, twins, delays, apart, error):
        """Take note of what has become of changes of the size `apart` (m,): states (m, 3), and twins, which passed the same place delays (m,) later.
        error (m,): of the places, in all, but for the growth. Returns (m,) where they tell nothing: nothing is noted there."""
        unit, change, told = self._along(states), twins - states, np.ones(len(rows), bool)
        speed, room = (self.rates(states) * unit).sum(axis=1), FAR * _size(states)
        for _ in range(2):  # the twin where it was, or will be, beside the motion: to second order in the delay
            more = np.where(speed > 0, -(change * unit).sum(axis=1) / speed, 0.0)
            rate = self.rates(states + change)
            change, delays = change + more[:, None] * self.rates(states + change + 0.5 * more[:, None] * rate), delays + more
            told &= np.abs(more) * speed < room
        size, first = np.abs(change).max(axis=1), np.sqrt((self.rates(starts)**2).sum(axis=1))
        told &= size < room
        yes = rows[told]
        self.blur[yes] += (error * self.most[rows] * (np.abs(delays) / apart + np.where(first > STILL * _size(starts), 1 / first, 0.0)))[told]
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
