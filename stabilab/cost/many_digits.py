"""What digits far beyond those of doubles cost where formulas give them: period and extremes of a motion with
a reduction, in balls, every digit proved."""
from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass

from ..orbit.extremes import extreme_balls
from ..orbit.landscape import landscape
from ..orbit.one_orbit import Orbit
from ..orbit.period import period_ball
from ..orbit.result import Fate
from .methods import Problem

LADDER = (15, 30, 50, 100, 300, 1000, 3000, 10_000)
REPEATS, ENOUGH = 5, 0.1  # runs of a rung, and seconds after which fewer do


@dataclass(frozen=True)
class Digits:
    """So many digits of a question, each proved, in so many seconds (processor time, the fastest run)."""

    question: str
    digits: int
    seconds: float


def with_many_digits(task: Problem, allowed: float) -> tuple[Digits, ...]:
    """Period and extremes of a motion that repeats to more and more digits, as long as the next run does not
    seem to take more than `allowed` seconds; none where no formula gives them."""
    land = landscape(task.scene) if task.equations.blocks == ("omega",) else None
    if land is None:
        return ()
    reduction, rows = land.reduction, []
    questions: dict[str, Callable[[int], object]] = {
        "period": lambda digits: period_ball(Orbit(reduction, task.start), digits),
        "extremes": lambda digits: extreme_balls(Orbit(reduction, task.start), Fate.BOUNDED,
                                                 math.ceil(digits * math.log2(10)))}
    for question, call in questions.items():
        call(LADDER[0])  # warms up
        last = 0.0
        for before, digits in zip((LADDER[0], *LADDER), LADDER):
            if last * (digits / before) ** 2 > allowed:
                break
            last = _fastest(call, digits)
            rows.append(Digits(question, digits, last))
    return tuple(rows)


def _fastest(call: Callable[[int], object], digits: int) -> float:
    seconds: list[float] = []
    while len(seconds) < REPEATS and sum(seconds) < ENOUGH:
        begun = time.process_time()
        call(digits)
        seconds.append(time.process_time() - begun)
    return min(seconds)
