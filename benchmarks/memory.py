"""The memory that a fate map takes, as a multiple of its input."""
from __future__ import annotations

import tracemalloc

from stabilab import fate

from .rows import SCENE, Row, random_states

MOST = 3  # input included


def rows(small=False) -> list[Row]:
    size = 6000 if small else 1_000_000
    return [fate_map(size)]


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
    return Row(f"memory of a fate map of {size} states",
               f"{peak / 1e6:.3g} MB peak, input included",
               f"{MOST} x {states.nbytes / 1e6:.3g} MB of input", ratio, (ratio, ratio),
               f"peak is {peak / states.nbytes:.2f} times the input, the result alone "
               f"{kept / states.nbytes:.2f}", wanted=1.0,
               note="the ratio is the allowance over the peak")
