"""The memory that a fate map takes, as a multiple of its input."""
from __future__ import annotations

import tracemalloc
from functools import partial

from stabilab import fate

from .rows import SCENE, Row, random_states

MOST = 3  # input included


def measurements(small=False):
    return [partial(fate_map, 6000 if small else 1_000_000)]


def fate_map(size=1_000_000) -> Row:
    """Peak of a fate map: its input (n, 3), its result and all work arrays."""
    states = random_states(size)
    fate(SCENE, states)  # the table is made once
    tracemalloc.start()
    try:
        answer = fate(SCENE, states)
        peak = states.nbytes + tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    kept = sum(getattr(answer, name).nbytes for name in ("labels", "margins", "axis", "sense", "reasons"))
    ratio = MOST * states.nbytes / peak
    return Row("memory-fate", f"peak of a fate map of {size} states, input included", peak, "bytes",
               float(MOST * states.nbytes), f"allowed, {MOST} times the input", ratio, ratio, ratio,
               f"the result alone is {kept / states.nbytes:.2f} times the input", 1.0)
