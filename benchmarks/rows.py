"""One comparison, and the body that most of them use."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stabilab import ScaledGyrostat

A, B = 0.2, 0.4  # the paper's minor-axis body at lambda1 = 100
SCENE = ScaledGyrostat(A, B, (0, 0, 1))


@dataclass(frozen=True)
class Row:
    """One comparison: ours, theirs (with units), the ratio theirs/ours with its range, the errors of both.

    wanted: the ratio aimed at, 0 where none is; note: what limits a ratio below it, or how the other was run.
    """

    name: str
    ours: str
    theirs: str
    ratio: float
    spread: tuple[float, float]
    error: str
    wanted: float = 0.0
    note: str = ""


def random_states(n, seed=20261121):
    """States in the box |x1|, |x2| <= 5, |x3| <= 6: about half of them bounded."""
    return np.random.default_rng(seed).uniform([-5, -5, -6], [5, 5, 6], (n, 3))


def each(seconds) -> str:
    """Seconds a piece, in a unit that reads well."""
    for size, unit in ((1.0, "s"), (1e-3, "ms"), (1e-6, "us")):
        if seconds >= size:
            return f"{seconds / size:.3g} {unit} each"
    return f"{seconds * 1e9:.3g} ns each"


def numba_available() -> bool:
    """Whether numba is installed."""
    from importlib.util import find_spec
    return find_spec("numba") is not None
