"""Periods, and extremes with periods, of many bounded orbits."""
from __future__ import annotations

from functools import partial

import numpy as np

from stabilab import period
from stabilab.orbit.extremes_arrays import extremes_and_periods

from .contestants import EventExtremes, TurningTimes
from .orbit_extremes import SciPyEvents, bounded_states
from .rows import SCENE, A, B, Row, against
from .timing import side_by_side

ALONE, TOGETHER = 8, 13  # times as fast as heyoka


def measurements(small=False):
    sizes = (100, 5, 2) if small else (200_000, 4000, 7)
    return [partial(alone, *sizes), partial(together, *sizes),
            partial(against_scipy, *((100, 2, 2) if small else (20_000, 10, 7)))]


def alone(size, sample, rounds) -> Row:
    """Periods against heyoka with one event, at the reversals of the turn."""
    states = bounded_states(size)
    part, events = states[:sample], TurningTimes(SCENE)
    timed = side_by_side(lambda: period(SCENE, states), lambda: events(part), len(states), len(part), rounds)
    off = np.abs(period(SCENE, part) / events(part) - 1).max()
    return against("periods", f"periods of {len(states)} orbits", timed,
                   "heyoka with events at the turns only", f"largest relative difference {off:.1e}", ALONE,
                   "the fair control: heyoka places the turns only, which is cheaper than all extremes; the "
                   "sum over 16 or more nodes is what limits ours")


def together(size, sample, rounds) -> Row:
    """Extremes and periods in one go against heyoka with events at the roots of the rates, whose run shows
    both."""
    states = bounded_states(size)
    part, events, turns = states[:sample], EventExtremes(A, B), TurningTimes(SCENE)
    timed = side_by_side(lambda: extremes_and_periods(SCENE, states), lambda: events(part), len(states),
                         len(part), rounds)
    boxes, periods = extremes_and_periods(SCENE, part)
    off = max(np.abs(boxes - events(part)).max() / np.abs(part).max(),
              np.abs(periods / turns(part) - 1).max())
    return against("extremes-and-periods", f"extremes and periods of {len(states)} orbits", timed,
                   "heyoka with events", f"largest relative difference {off:.1e}", TOGETHER)


def against_scipy(size, sample, rounds) -> Row:
    """Extremes and periods against SciPy with events, stopped at the end of a period."""
    states = bounded_states(size)
    part, events = states[:sample], SciPyEvents(A, B)
    timed = side_by_side(lambda: extremes_and_periods(SCENE, states), lambda: events(part), len(states),
                         len(part), rounds)
    exact = TurningTimes(SCENE)(part)
    ours, theirs = (np.abs(periods / exact - 1).max() for periods in (period(SCENE, part), events(part)[1]))
    return against("extremes-and-periods-scipy", f"extremes and periods of {len(states)} orbits", timed,
                   "SciPy DOP853 with events",
                   f"periods differ from heyoka's by {ours:.1e}, SciPy's (1e-12) by {theirs:.1e}", 8000)
