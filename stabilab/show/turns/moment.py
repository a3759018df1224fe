"""The moment of a motion that its pictures and films slow down for: when it reaches its limit, turns over, or
begins to spin up for good."""
from __future__ import annotations

from ...orbit.result import Fate, Motion
from ..space.span import limit_time, spin_up_time

LIMIT, CROSSES, OVER, CERTAIN = "limit", "separatrix crossed", "turning over", "spin-up certain"
SETTLES, TENTH, ASSUMED = "settled", "a tenth left", "assumed limit"


def moment(motion: Motion, assumed: float | None = None) -> tuple[float, str] | None:
    """(time in the scene's time, what happens then); None where nothing is known to. assumed: when the limit
    is reached that pictures assume where the file states none. A body that goes into a
    flat spin without a separatrix on its route turns over between leaving its axis and settling."""
    if (limit := limit_time(motion)) is not None:
        return limit, LIMIT
    if motion.ending is not None:
        crosses, leaves, settles, tenth = map(motion.ending.time, ("crosses", "leaves", "settles", "tenth"))
        if crosses is not None:
            return float(crosses), CROSSES
        if leaves is not None and settles is not None:
            return (leaves + settles) / 2, OVER
        if settles is not None:
            return float(settles), SETTLES
        if tenth is not None:
            return float(tenth), TENTH
    if assumed is not None:
        return assumed, ASSUMED
    if motion.fate is Fate.SPIN_UP and (certain := spin_up_time(motion)) > 0:
        return certain, CERTAIN
    return None
