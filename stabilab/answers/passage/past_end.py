"""When a motion first reaches a limit in which an effect stops acting on the way."""
from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np

from ...integrate.trajectory import integrated
from ...physics.law_limits import stopped
from ...physics.scene import AnyScene, slices
from ...physics.states import moved_row
from .limit import Limit
from .never import never
from .run import MOVED, ROUNDING, Found, by_run

AFTER = "roots along a run in machine precision over the end of an effect"


def past_the_end(scene: AnyScene, state: dict[str, Any], limit: Limit, last: float, left: float) -> Found:
    """The first crossing by `last` along runs, the second of them from the end of the first on, at `left`."""
    found = by_run(scene, state, limit, left) if left else Found(0.0, math.nan, "run", "")
    if math.isfinite(found.high) or found.level == "undecided" or found.low < left * (1 - 2 * ROUNDING):
        return found
    if limit.kind == "tilt":
        return replace(found, words=f"{found.words}; from the end of an effect there on it is not followed")
    row = np.concatenate([state[name] for name in scene.blocks])
    ends = []
    for start in (row, moved_row(row, MOVED)):
        run = integrated(scene, start, [0.0, left], laws=False)
        ends.append({name: run.states[-1][part] for name, part in slices(scene.blocks).items()})
    after, there = stopped(scene, ends[0])
    rates = tuple(there["omega"])
    if after.plain and (surely := never(after, rates, tuple(map(Fraction, rates)), limit)[0]) is not None:
        return replace(surely, level="run", words=f"{surely.words}, from the end of an effect on",
                       steps=found.steps)
    start, beside = (np.concatenate([end[name] for name in there]) for end in ends)
    later = by_run(after, start, limit, last - left, beside=beside)
    words = (f"{limit.words}: {AFTER}" if math.isfinite(later.high) else
             f"{limit.words}: {AFTER}: not reached by t = {left + later.low:.6g} s")
    return replace(later, low=left + later.low, high=left + later.high, words=words,
                   steps=found.steps + later.steps)
