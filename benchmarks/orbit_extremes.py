"""Extremes of many bounded orbits."""
from __future__ import annotations

import numpy as np

from stabilab import extremes, fate

from .contestants import EventExtremes
from .rows import SCENE, A, B, Row, each, random_states
from .timing import side_by_side


def rows(small=False) -> list[Row]:
    return [against_events(100, 5, 2) if small else against_events()]


def against_events(size=20_000, sample=400, rounds=7) -> Row:
    """Extremes of bounded orbits against heyoka with events at the roots of the rates."""
    states = random_states(4 * size)
    states = states[fate(SCENE, states).margins > 1e-3][:size]
    part = states[:sample]
    events = EventExtremes(A, B)
    timed = side_by_side(lambda: extremes(SCENE, states), lambda: events(part), len(states), len(part), rounds)
    difference = np.abs(extremes(SCENE, part) - events(part)).max() / np.abs(part).max()
    return Row(f"extremes of {len(states)} orbits, NumPy", each(timed.ours), f"{each(timed.theirs)} heyoka with events",
               timed.ratio, (timed.low, timed.high), f"largest relative difference {difference:.1e}")
