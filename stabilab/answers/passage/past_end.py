"""When a motion first reaches a limit in which an effect stops acting on the way."""
from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np

from ...integrate.trajectory import integrated
from ...physics.ending import stopped, time_left
from ...physics.equations import Equations
from ...physics.scene import AnyScene, slices
from ...physics.states import REST, equations_and_start, moved_row, to_space
from .limit import Limit
from .never import never
from .run import MOVED, ROUNDING, Found, by_run

AFTER = "roots along a run in machine precision over the end of an effect"


def past_the_end(scene: AnyScene, state: Any, limit: Limit, last: float) -> Found:
    """The first crossing by `last` along runs, the second of them from the end of the effect on."""
    start, direction = _blocks(*equations_and_start(scene, state)), limit.direction
    left = time_left(scene, start)
    if left is None or last <= left:
        return by_run(scene, start, limit, last)
    attitude = start.get("attitude", np.array(REST["attitude"]))
    start = {name: start[name] for name in scene.blocks}
    if direction is not None:
        start["attitude"] = attitude
        origin = to_space(attitude, [float(v) for v in direction])
        limit = replace(limit, origin=tuple(origin.tolist()))
    found = by_run(scene, start, limit, left) if left else Found(0.0, math.nan, "run", "")
    if math.isfinite(found.high) or found.level == "undecided" or found.low < left * (1 - 2 * ROUNDING):
        return found
    equations, row = equations_and_start(scene, start)
    ends = [_blocks(equations, integrated(scene, _blocks(equations, one), [left], laws=False).states[-1])
            for one in (row, moved_row(row, MOVED))]
    after, there = stopped(scene, ends[0])
    rates = tuple(there["omega"])
    if after.plain and (surely := never(after, rates, tuple(map(Fraction, rates)), limit)[0]) is not None:
        return replace(surely, level="run", words=f"{surely.words}, from the end of an effect on",
                       steps=found.steps)
    later = by_run(after, rates if after.plain and direction is None else there, limit, last - left,
                   beside=np.concatenate([ends[1][name] for name in there]))
    words = (f"{limit.words}: {AFTER}" if math.isfinite(later.high) else
             f"{limit.words}: {AFTER}: not reached by t = {left + later.low:.6g} s")
    return replace(later, low=left + later.low, high=left + later.high, words=words,
                   steps=found.steps + later.steps)


def _blocks(equations: Equations, row: np.ndarray) -> dict[str, np.ndarray]:
    return {name: row[part] for name, part in slices(equations.blocks).items()}
