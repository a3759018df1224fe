"""Many states of a scene with an orbit: fates, extremes and periods of rows (n, 3)."""
from __future__ import annotations

from .extremes_and_periods import extremes_and_periods
from .fate.arrays import fates

__all__ = ["extremes", "fates", "periods"]


def extremes(scene, states, span=None, fast: bool | None = None):
    """(n, 3, 2) over t >= 0; `span` and `fast` are not needed."""
    return extremes_and_periods(scene, states, period=False)[0]


def periods(scene, states, fast: bool | None = None):
    """(n,); inf where the motion does not repeat, 0 at an equilibrium, NaN where it is undecided; `fast` is
    not needed."""
    return extremes_and_periods(scene, states, box=False)[1]
