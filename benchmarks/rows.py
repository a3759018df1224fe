"""One comparison, and the body that most of them use."""
from __future__ import annotations

import statistics
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from stabilab import ScaledGyrostat

from .timing import Ratio

A, B = 0.2, 0.4  # the paper's minor-axis body at lambda1 = 100
SCENE = ScaledGyrostat(A, B, (0, 0, 1))


@dataclass(frozen=True)
class Row:
    """One comparison: ours, theirs, the ratio theirs/ours with its range, the errors of both.

    key: names the row for good, in results.json and in the links of the pages; unit: `s`, `each` (s a piece)
    or `bytes`, of ours and theirs; other: what theirs is; theirs, ratio: None where ours stands alone;
    wanted: the ratio aimed at, 0 where none is; note: how both were run and what limits the ratio, for the
    page and not for the table.
    """

    key: str
    what: str
    ours: float
    unit: str = "each"
    theirs: float | None = None
    other: str = ""
    ratio: float | None = None
    low: float | None = None
    high: float | None = None
    error: str = ""
    wanted: float = 0.0
    note: str = ""


def against(key: str, what: str, timed: Ratio, other: str, error: str = "", wanted: float = 0.0,
            note: str = "", unit: str = "each") -> Row:
    """A row of two contestants that took turns."""
    return Row(key, what, timed.ours, unit, timed.theirs, other, timed.ratio, timed.low, timed.high, error,
               wanted, note)


def allowed(key: str, what: str, times: Sequence[float], limit: float, note: str = "") -> Row:
    """A row of seconds beside what is allowed."""
    ratios = sorted(limit / t for t in times)
    return Row(key, what, statistics.median(times), "s", limit, "allowed", statistics.median(ratios),
               ratios[0], ratios[-1], "none: the same answers", 1.0, note)


def random_states(n, seed=20261121):
    """States in the box |x1|, |x2| <= 5, |x3| <= 6: about half of them bounded."""
    return np.random.default_rng(seed).uniform([-5, -5, -6], [5, 5, 6], (n, 3))


# Of a fresh process: the most memory that it had, bytes. Not `ru_maxrss` where Linux has better, which counts
# what the process that started it had
PEAK = '''
import resource
def peak():
    try:
        with open("/proc/self/status") as status:
            return 1024.0 * next(int(line.split()[1]) for line in status if line.startswith("VmHWM"))
    except OSError:
        return 1024.0 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
'''


def numba_available() -> bool:
    """Whether numba is installed."""
    from importlib.util import find_spec
    return find_spec("numba") is not None
