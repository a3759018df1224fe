"""What the burns of drawn cases leave, when they reach a limit, and by when they must close."""
from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

import numpy as np

from ...answers.stuck.burn import closing_time, crossing_time, what_is_left
from ...answers.stuck.chain import Chain, links_of
from ...case.read import Burning, Case
from ...numbers.units import RATE, TIME, in_si
from ...orbit.result import Fate
from ..plan import Plan

of_one = None  # a burn is one motion after another, whatever its scene


@dataclass(frozen=True)
class Drawn:
    """A case of a plan, each part worked out when a column reads it."""

    plan: Plan
    case: Case

    def _asked(self, name: str, unit: Any) -> Fraction | None:
        text = dict(self.plan.burn or ()).get(name)
        return None if text is None else in_si(text, unit, name)

    @cached_property
    def when(self) -> tuple[float, float]:
        """Between which times the limit is first reached, s."""
        limit = self.plan.limit_of(self.case)
        chain = Chain(Burning(self.case), self._asked("stop", TIME))
        found = crossing_time(chain, limit.ask, limit.until)  # type: ignore[union-attr]
        return float(found.low), float(found.high)

    @cached_property
    def _left(self) -> Any:
        chain = Chain(Burning(self.case), self._asked("stop", TIME))
        return what_is_left(chain, list(links_of(chain)))

    @property
    def fate(self) -> Fate:
        """Of the motion after the last closing."""
        return self._left.motion.fate

    @property
    def largest(self) -> float:
        """The largest |omega|, before the last closing and after it."""
        left = self._left
        if left.motion.fate == Fate.SPIN_UP:
            return math.inf
        known = None not in (left.largest_rate, left.largest_before)
        return max(left.largest_rate, left.largest_before) if known else math.nan

    @property
    def size(self) -> float:
        """|omega| at the start."""
        return math.hypot(*map(float, self.case.state or ()))

    @cached_property
    def closing(self) -> tuple[float, float]:
        """Between which times the latest closing lies that keeps |omega| below a rate for ever."""
        chain = Chain(Burning(self.case), self._asked("stop", TIME))
        below = self._asked("below", RATE)
        found = closing_time(chain, list(links_of(chain)), below)  # type: ignore[arg-type]
        return found.low, found.high


def of_many(plan: Plan, case: Case, states: np.ndarray) -> Drawn:
    """Of the case itself: each draw of a burn is one."""
    return Drawn(plan, case)
