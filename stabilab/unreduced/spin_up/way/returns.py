"""The return map: where a motion that goes round is as far to one side again as it was, and when.

The section is the surface on which n . omega' = 0: where the motion is at its farthest against the unit vector n. A drift of the whole path in
space shifts it by its speed over that of going round only, so that small circles that drift far stay on it.
"""
from __future__ import annotations

import numpy as np

from .runs import Runs

MOST = 500      # steps that a return may take
ENDLESS = 1e300
NEWTON = 6      # corrections of its time by the Taylor series; the last is a formula
NEAR = 1e-6     # share of a radian, below which that formula errs by less than a unit of rounding
CLOSED = 2e-2   # a return is told from other passages of the section: it comes so close to its start, as a share of the way round


class Returns:
    """The map of sections to themselves along the motions of `runs`; every row has its own section, all are independent of each other."""

    def __init__(self, runs: Runs):
        self.runs = runs

    def __call__(self, states, normals, guesses):
        """(states, times, good): of states (m, 3) on the sections of normals (m, 3), the return that is expected after about guesses (m,)."""
        good = np.isfinite(guesses) & (guesses > 0) & np.isfinite(states).all(axis=1)
        times, states = np.where(good, guesses, 0.0), np.where(good[:, None], states, 1.0)
        places, reached = self.runs.carried(states, times, MOST)
        good &= np.abs(reached - times) <= 1e-9 * times
        for _ in range(NEWTON):
            late, turned = self._late(places, normals)
            good &= np.isfinite(late) & ~(np.abs(late) > 0.3 * times)
            rows = np.flatnonzero(good & (turned > NEAR))
            if not rows.size:
                break
            places[rows], _ = self.runs.carried(places[rows], -late[rows], MOST)
            times[rows] -= late[rows]
        late, turned = self._late(places, normals)
        good &= turned <= NEAR
        rates = self.runs.rates(places)
        rates = self.runs.rates(places - 0.5 * late[:, None] * rates)  # the midpoint formula
        return places - late[:, None] * rates, times - late, good & (np.abs(times / guesses - 1) < 0.5)

    def _late(self, places, normals):
        """(time since the section was passed, the angle turned since), (m,) each, to first order."""
        rates = self.runs.rates(places)
        bend = self.runs.slopes(places, rates)
        late = (rates * normals).sum(axis=1) / (bend * normals).sum(axis=1)
        return late, np.abs(late) * np.sqrt((bend**2).sum(axis=1) / (rates**2).sum(axis=1))

    def normals(self, states):
        """Unit vectors across the motions at states (m, 3), toward where they bend: these states lie on the sections."""
        rates = self.runs.rates(states)
        bend = self.runs.slopes(states, rates)
        bend -= rates * ((bend * rates).sum(axis=1) / (rates**2).sum(axis=1))[:, None]
        return bend / np.sqrt((bend**2).sum(axis=1))[:, None]

    def on_section(self, states, normals):
        """The nearest places on the sections: what is off them is rounding, which sums over many revolutions would gather."""
        for _ in range(2):
            off = (self.runs.rates(states) * normals).sum(axis=1)
            up = self.runs.slopes_back(states, normals)
            states = states - up * (off / (up**2).sum(axis=1))[:, None]
        return states

    def first(self, states):
        """(times, steps): of states (m, 3) the first return to their sections, and the steps on the way; nan where none is near."""
        normals = self.normals(states)
        times, steps = np.full(len(states), np.nan), np.zeros(len(states), int)
        places, now, far = states.copy(), np.zeros(len(states)), np.zeros(len(states))
        before, open_ = np.zeros(len(states)), np.arange(len(states))
        for number in range(1, MOST):
            places[open_], passed = self.runs.carried(places[open_], np.full(open_.size, ENDLESS), 1)
            now[open_] += passed
            gone = places[open_] - states[open_]
            far[open_] = np.fmax(far[open_], np.sqrt((gone**2).sum(axis=1)))
            height = (self.runs.rates(places[open_]) * normals[open_]).sum(axis=1)
            rows = open_[(before[open_] < 0) & (height >= 0)]
            before[open_] = height
            if rows.size:
                late, _ = self._late(places[rows], normals[rows])
                back, found, good = self(states[rows], normals[rows], now[rows] - late)
                good &= np.sqrt(((back - states[rows])**2).sum(axis=1)) < CLOSED * far[rows]
                times[rows[good]], steps[rows[good]] = found[good], number
                open_ = np.setdiff1d(open_, rows[good])
            if not open_.size:
                break
        return times, steps
