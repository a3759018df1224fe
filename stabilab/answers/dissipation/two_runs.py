"""A motion followed twice, the second time from a start moved in its last places and with another tolerance:
what both runs come to is taken for known, and the times of the first to how far they are apart."""
from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import numpy as np

from ...physics.states import moved_row
from ...reasons import Quantity, Reason
from ..passage import MOVED, WIDER
from .spinner import ENDED, Run, Spinner
from .times import Time

SECOND_RTOL = 1e-13  # tolerance of the second run
SECOND: dict[str, Any] = {"moved": int(MOVED), "tolerance": Quantity(SECOND_RTOL, digits=1)}  # in sentences

T = TypeVar("T")


class TwoRuns:
    """Both runs of a spinner, each of at most so many steps; pace: of the motion, rad/s, None for that of its
    rates."""

    def __init__(self, spinner: Spinner, most: int, pace: float | None = None) -> None:
        self.first = Run(spinner, spinner.start, None, most, pace)
        self.second = Run(spinner, moved_row(spinner.start, MOVED), SECOND_RTOL, most, pace)

    @property
    def why(self) -> Reason:
        """Why one of them went no farther."""
        return self.first.why or self.second.why or ENDED

    def falls(self, level: float) -> Time | None:
        """When 2 T/|H|^2 falls to a level; None where one of them does not reach it."""
        if self.first.why is not None or self.second.why is not None:
            return None
        first = self.first.falls(level)
        second = None if first is None else self.second.falls(level)
        return None if first is None or second is None else agreed(first, second)

    def come_to(self, end: Callable[[np.ndarray], T]) -> tuple[T, T]:
        """What a function says of the states where they are."""
        return end(self.first.state), end(self.second.state)


def agreed(first: float, second: float) -> Time:
    """The time of the first of two runs, known to how far they are apart."""
    return Time(first, WIDER * abs(first - second) + 1e-15 * first)
