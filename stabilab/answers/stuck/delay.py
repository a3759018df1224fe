"""Where no momentum of a wheel keeps a motion bounded: the one that delays the limit most, within what the wheel may be expected to take."""
from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from typing import TypeAlias

import numpy as np

from ...numbers.roots import golden_section
from ...numbers.vectors import Exact3, Number
from .fate import time_under
from .reach import first_time
from .scenario import Scenario

Bracket: TypeAlias = tuple[float, float]
RANGE = 2  # times the momentum that the wheel has now, either way; one at rest is tried up to the body's own
PLACES, CLOSER = 41, 24  # momenta that are tried over the range, and nearer and nearer to the best of them
PATIENCE = 100  # times the time without a change: a limit that is not reached by then counts as never
BUDGET = 20_000  # steps of each run
SAME = 1e-6  # relative: a run that ends so much sooner than the limit has not come to it


def delayed(scenario: Scenario, torque: Sequence[Fraction], axis: Exact3, now: Fraction, time: Bracket | None
            ) -> tuple[float, Bracket | None, float | None, Bracket, bool] | None:
    """(best momentum, N m s, bracket of its time or None, gain in s or None, the range searched, whether its run came to the limit), or None where
    there is nothing to search, or nothing better was found.

    axis: exact unit vector of the wheel, scene's axes; now: its momentum; time: bracket of the limit as things are.
    """
    if scenario.limit is None or time is None or time[0] <= 0:
        return None
    others = [w - now * a for w, a in zip(scenario.wheel, axis)]
    reach = RANGE * abs(float(now)) or _own(scenario, torque)

    def until(s: Number) -> float:
        wheel = [w + Fraction(float(s)) * a for w, a in zip(others, axis)]
        return first_time(scenario.scene(torque, wheel), scenario.start, scenario.limit, scenario.rows, PATIENCE * time[0], BUDGET)
    places = np.linspace(-reach, reach, PLACES)
    times = [until(s) for s in places]
    best = int(np.argmax(times))
    s, longest = float(places[best]), times[best]
    if math.isfinite(times[best]):
        closer = golden_section(lambda s: -until(s), places[max(best - 1, 0)], places[min(best + 1, PLACES - 1)], CLOSER)
        s, longest = min((s, -longest), *closer, key=lambda one: one[1])
        s, longest = float(s), -longest
    told = time_under(scenario, torque, [w + Fraction(s) * a for w, a in zip(others, axis)])
    gain = None if told is None else told[0] - time[0]
    if gain is not None and gain <= 0:
        return None
    return s, told, gain, (-reach, reach), told is None or not longest < told[0] * (1 - SAME)


def _own(scenario: Scenario, torque: Sequence[Fraction]) -> float:
    """For a wheel at rest: the momentum of the body itself, and of what its torque makes of it."""
    weight = max(scenario.body.inertia)
    return weight * max(math.hypot(*scenario.start), math.sqrt(math.hypot(*map(float, torque)) / weight))
