"""Fair timing: two contestants in turn, warmed up, medians with spread."""
from __future__ import annotations

import statistics
import time
from dataclasses import dataclass


@dataclass(frozen=True)
class Ratio:
    """Medians (s per item) of ours and theirs over the rounds, and the ratio theirs/ours with its range."""

    ours: float
    theirs: float
    ratio: float
    low: float
    high: float
    rounds: int


def side_by_side(ours, theirs, our_items, their_items, rounds=7, clock=time.perf_counter) -> Ratio:
    """Run both callables alternately; each returns nothing, items are what one call works off. clock:
    `time.thread_time` where both work in one thread, which other work on the machine then disturbs less."""
    ours(), theirs()
    pairs = [(_time(ours, clock) / our_items, _time(theirs, clock) / their_items) for _ in range(rounds)]
    ratios = sorted(b / a for a, b in pairs)
    return Ratio(statistics.median(a for a, _ in pairs), statistics.median(b for _, b in pairs),
                 statistics.median(ratios), ratios[0], ratios[-1], rounds)


def _time(call, clock) -> float:
    start = clock()
    call()
    return clock() - start
