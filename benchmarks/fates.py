"""The fate of many states."""
from __future__ import annotations

import numpy as np

from stabilab import Fate, fate

from .contestants import BatchFate
from .rows import SCENE, A, B, Row, each, random_states
from .timing import side_by_side


def rows(small=False) -> list[Row]:
    return [against_batch(2000, 50, 2) if small else against_batch()]


def against_batch(size=1_000_000, sample=10_000, rounds=7) -> Row:
    """Labels of `size` states against heyoka's batch mode with compaction on `sample` of them."""
    states = random_states(size)
    batch = BatchFate(A, B)
    part = states[:sample]
    timed = side_by_side(lambda: fate(SCENE, states), lambda: batch(part), size, sample, rounds)
    answer, brute = fate(SCENE, part), batch(part)
    clear = np.abs(answer.margins) > 1e-9
    wrong = int(((answer.labels == Fate.SPIN_UP) != (brute == 1))[clear].sum())
    return Row(f"fate of {size} states, NumPy", each(timed.ours), f"{each(timed.theirs)} heyoka batch with compaction",
               timed.ratio, (timed.low, timed.high), f"{wrong} of {int(clear.sum())} labels differ")
