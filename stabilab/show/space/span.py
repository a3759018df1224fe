"""The span of time of a view: long enough to see what the headline says."""
from __future__ import annotations

import math
from collections.abc import Sequence

from ...orbit.result import Fate, Motion
from ...physics.scene import AnyScene

NATURAL = 15.0  # units of the motion's own time, where the case gives no span
PERIODS = 10  # of a motion that repeats, at most
FEWEST = 2  # periods, at least
ALONE = 3  # periods where the case gives no span
BEYOND = 1.25  # of the time to the limit, at least
LATEST = 4.0  # of the time to the limit, at most
GROWTH = 1.5  # of the time from which a spin-up is certain, at least
STRETCHED = 50.0  # times its span: a motion that spins up later than that is not followed so far


def natural(scene: AnyScene, state: Sequence[float]) -> float:
    """Some units of the time in which a torque or the rotation itself moves the body."""
    if scene.variables == "scaled":
        return NATURAL
    torque = math.hypot(*(float(v) for v in scene.vector("constant_torque"))) if scene.plain else 0.0
    rate = math.hypot(*state[:3])
    return NATURAL * (math.sqrt(sum(scene.body.inertia) / 3 / torque) if torque else 1.0 / (rate or 1.0))


def seen(span: tuple[float, ...] | None, motion: Motion, alone: float,
         reached: float | None = None) -> tuple[float, float]:
    """(from, to) in the scene's time: past the limit of the case, past the beginning of a spin-up, past the
    end of a motion that loses energy, some periods of one that repeats; otherwise the span of the case, and
    where it gives none, `alone`. reached: the time to the limit that is assumed where the case states none.
    """
    low, high = span or (0.0, alone)
    if high < low:  # followed backwards, where nothing of the headline lies
        return low, high
    if (limit := limit_time(motion)) is not None:
        return min(low, 0.0), max(BEYOND * limit, min(high, LATEST * limit))
    if motion.ending is not None and motion.ending.until is not None:
        return low, max(high if span else low, BEYOND * motion.ending.until)
    if motion.period:
        wanted = min(high, low + PERIODS * motion.period) if span else low + ALONE * motion.period
        return low, max(wanted, low + FEWEST * motion.period)
    late = max(GROWTH * spin_up_time(motion), BEYOND * (reached or 0.0))
    return low, late if high < late <= low + STRETCHED * (high - low) else high


def limit_time(motion: Motion) -> float | None:
    """When the limit of the case is reached after the start; None where it is not known to be."""
    result = None if motion.first is None else motion.first[1]
    if result is None or not math.isfinite(result.high) or not result.high > 0:
        return None
    return float(result.high)


def spin_up_time(motion: Motion) -> float:
    """From when on a spin-up is certain, or its turn never reverses again; 0 of other motions."""
    if motion.fate is not Fate.SPIN_UP:
        return 0.0
    return max(float(motion.evidence.get(name) or 0.0) for name in ("release_time", "t_certificate"))
