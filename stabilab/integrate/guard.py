"""How far a motion is followed in time: one budget of steps and memory, and the words of what it gives up.

Whatever steps along a motion looks here: the Taylor series and SciPy (`trajectory`, `ensemble`), the search
for zeros (`events`), many digits (`reference`, `answers.tabulated`), the spin-up off the axes.

A run that cannot come to its end is given up early, not when its budget is spent. Of N steps allowed, n are
passed: at their pace the rest of the way takes L. From S steps on the run is given up where L > PATIENCE N.
A motion that slows down has longer steps later: where it comes in n steps as far as n^p, L is (n/S)^(p - 1)
times as large after S of them. A loss cubic in the rates makes these fall as t^(-1/2), and p = 2; p = 3 is
allowed for: before S steps the run is given up where L (n/S)^2 > PATIENCE N.
"""
from __future__ import annotations

import math

from ..reasons import Quantity, Reason, Sentence

PATIENCE = 5
FIRST = 400  # steps before the first look
BYTES = 2**28  # of memory that one run may fill with what it meets on the way: 256 MB
# radians or so of a motion's turn beyond which it is followed by itself, not in step with others
FARTHEST = 1e9

GIVEN_UP = Sentence(
    "given-up", "given up after {steps} steps: at their pace the rest takes some {left}, more than the "
    "{allowed} allowed")
GIVEN_UP_ENDLESS = Sentence("given-up-endless",
                            "given up after {steps} steps: at their pace the rest has no end")
MEMORY_FULL = Sentence("memory-full", "{places} of its places fill the memory allowed ({megabytes} MB)")
STEPS_NOT_ENOUGH = Sentence("steps-not-enough", "{steps} steps were not enough")


class Guard:
    """The budget of one run: how many steps are allowed, and how many of them show a motion's pace.

    end: the time that the run is to come to, of either sign; patience: as of the module."""

    def __init__(self, end: float, steps: int, settled: int, patience: float = PATIENCE):
        self.end, self.steps, self.settled, self.patience = end, steps, settled, patience
        self.passed, self.time = 0, 0.0  # at the last look

    def ahead(self, steps: int, time: float) -> float:
        """How many more steps the time ahead takes at the pace of those since the last look."""
        return (steps - self.passed) * float(abs(self.end - time) / (abs(time - self.time) or 1e-300))

    def look(self, steps: int, time: float) -> Reason | None:
        """Why a run that came to a time in so many steps is given up; None where it goes on."""
        left = self.ahead(steps, time)
        self.passed, self.time = steps, time
        return (why_given_up(steps, left, self.steps)
                if too_far(steps, left, self.steps, self.settled, self.patience) else None)

    def look_in_time(self, steps: int, time: float) -> Reason | None:
        """`look`, where it is time for the next: the pace is that of the later half of a run."""
        return self.look(steps, time) if steps - self.passed >= self.next(self.passed) else None

    def next(self, steps: int) -> int:
        """How many steps to take before the next look, after so many."""
        return max(FIRST, min(steps, self.settled - steps if steps < self.settled else self.settled))


def too_far(steps: float, left: float, allowed: float, settled: float, patience: float = PATIENCE) -> bool:
    """Whether a run is given up after so many steps, at whose pace the rest takes `left` more."""
    return left * min(steps / settled, 1.0) ** 2 > patience * allowed


def why_given_up(steps: float, left: float, allowed: float) -> Reason:
    """Why a run is given up after so many steps, at whose pace the rest takes `left` more."""
    if not math.isfinite(left):
        return GIVEN_UP_ENDLESS(steps=round(steps))
    return GIVEN_UP(steps=round(steps), left=Quantity(left, digits=1), allowed=Quantity(allowed, digits=1))


def full(noted: int, numbers: int) -> Reason | None:
    """Why a run stops that has noted so many rows of so many numbers; None where there is room."""
    return (MEMORY_FULL(places=noted, megabytes=BYTES // 2**20) if 8 * noted * numbers > BYTES else None)
