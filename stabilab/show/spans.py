"""The one span of time that every view of a motion shows, long enough to see what its headline says; where
on a curve of equilibria to look."""
from __future__ import annotations

import math
from typing import Any

from ..orbit.result import Fate, Motion

NATURAL = 15.0  # units of the motion's own time, where the case gives no span
PERIODS = 10  # of a motion that repeats, at most
FEWEST = 2  # periods, at least
ALONE = 3  # periods where the case gives no span
BEYOND = 1.25  # of the time to the limit, at least
LATEST = 4.0  # of the time to the limit, at most
GROWTH = 1.5  # of the time from which a spin-up is certain, at least
STRETCHED = 50.0  # times its span: a motion that spins up later than that is not followed so far


def natural(scene: Any, state: Any) -> float:
    """Some units of the time in which a torque or the rotation itself moves the body."""
    if scene.variables == "scaled":
        return NATURAL
    torque = math.hypot(*(float(v) for v in scene.vector("constant_torque"))) if scene.plain else 0.0
    rate = math.hypot(*state[:3])
    return NATURAL * (math.sqrt(sum(scene.body.inertia) / 3 / torque) if torque else 1.0 / (rate or 1.0))


def seen(span: tuple[float, ...] | None, motion: Motion, alone: float) -> tuple[float, float]:
    """(from, to) in the scene's time: past the limit of the case, past the beginning of a spin-up, some
    periods of a motion that repeats; otherwise the span of the case, and where it gives none, `alone`."""
    low, high = span or (0.0, alone)
    if high < low:  # followed backwards, where nothing of the headline lies
        return low, high
    if (limit := limit_time(motion)) is not None:
        return min(low, 0.0), max(BEYOND * limit, min(high, LATEST * limit))
    if motion.period:
        wanted = min(high, low + PERIODS * motion.period) if span else low + ALONE * motion.period
        return low, max(wanted, low + FEWEST * motion.period)
    late = GROWTH * spin_up_time(motion)
    return low, late if high < late <= low + STRETCHED * (high - low) else high


def limit_time(motion: Motion) -> float | None:
    """When the limit of the case is reached after the start; None where it is not known to be."""
    found = None if motion.first is None else motion.first[1]
    if found is None or not math.isfinite(found.high) or not found.high > 0:
        return None
    return float(found.high)


def spin_up_time(motion: Motion) -> float:
    """From when on a spin-up is certain, or its turn never reverses again; 0 of other motions."""
    if motion.fate is not Fate.SPIN_UP:
        return 0.0
    return max(float(motion.evidence.get(name) or 0.0) for name in ("release_time", "t_certificate"))


def spread(low: float, high: float, number: int) -> list[float]:
    """Parameters inside (low, high), dense at both ends, geometric towards an infinite end; towards two of
    them so many on each side of zero."""
    if math.isfinite(low) and math.isfinite(high):
        return [low + (high - low) * (1 - math.cos(1e-3 + (math.pi - 2e-3) * n / (number - 1))) / 2
                for n in range(number)]
    away = [10 ** (-4 + 8 * n / (number - 1)) for n in range(number)]
    if math.isfinite(low):
        return [low + v * max(1.0, abs(low)) for v in away]
    if math.isfinite(high):
        return [high - v * max(1.0, abs(high)) for v in reversed(away)]
    return [*(-v for v in reversed(away)), *away]
