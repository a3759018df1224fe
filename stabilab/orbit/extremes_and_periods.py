"""Extremes and periods of many states in one pass: fates, then librations row by row, the rest by NumPy, and
balls of what these leave open."""
from __future__ import annotations

import numpy as np

from ..errors import InputError
from ..physics.coefficients import effective
from ..physics.states import checked_states
from .extremes.arrays import open_extremes, rotation_periods, trapped_rows
from .extremes.one_state import precise_extremes
from .far_states import far_numbers
from .fate.arrays import fate_on_orbit, fates, rows_beyond_doubles
from .fate.result import CHUNK
from .fine.rows_kernel import BOX, PERIOD
from .fine.rows_numba import settle_rows
from .landscape import landscape
from .one_orbit import Orbit
from .period import precise_period
from .reduction import reduce
from .result import Fate, without_return


def extremes_and_periods(scene, states, *, box=True, period=True, by_numba: bool | None = None):
    """(extremes (..., 3, 2), periods (...,)) in one go, each as the function of its name gives it; None for
    one that is not asked for. For scenes with a reduction only (InputError for others, and as `extremes`
    raises it).

    by_numba: as of `settle_rows`.
    """
    scene, array = effective(scene), checked_states(states)
    if reduce(scene) is None:
        raise InputError("extremes_and_periods: this scene has no reduction to one coordinate; ask for "
                         "`extremes` with a"
                         " span, or for `period`")
    flat = np.ascontiguousarray(array.reshape(-1, 3))
    boxes, periods = np.empty((len(flat) if box else 0, 3, 2)), np.empty(len(flat) if period else 0)
    far = rows_beyond_doubles(scene, flat)
    for index in np.nonzero(far)[0]:  # their squares may be no doubles: each in its own unit
        extremes, time = far_numbers(scene, flat[index].tolist())
        if box:
            boxes[index] = extremes
        if period:
            periods[index] = time
    near = np.nonzero(~far)[0]
    for start in range(0, len(near), CHUNK):
        rows = near[start:start + CHUNK]
        some, times = _of_chunk(scene, flat[rows], box, period, by_numba)
        boxes[rows if box else []], periods[rows if period else []] = some, times
    return boxes.reshape(array.shape
                         + (2,)) if box else None, periods.reshape(array.shape[:-1]) if period else None


def _of_chunk(scene, states, box, period, by_numba):
    """(boxes (n, 3, 2), periods (n,)) of one chunk, each empty where it is not asked for."""
    land = landscape(scene)
    decided = fate_on_orbit(scene, land, states)
    boxes, periods = np.empty((len(states) if box else 0, 3, 2)), np.empty(len(states) if period else 0)
    trapped = trapped_rows(land, decided)
    left_open = np.where(trapped, BOX * box + PERIOD * period, 0).astype(np.uint8)
    settle_rows(land, states, boxes, periods, left_open, by_numba)
    if box:
        boxes[~trapped] = open_extremes(land, states[~trapped], decided.labels[~trapped],
                                        decided.margins[~trapped])
        for index in np.nonzero((left_open & BOX > 0) | (~trapped & np.isnan(boxes).any(axis=(1, 2))))[0]:
            boxes[index] = precise_extremes(Orbit(land.reduction, states[index]), int(decided.labels[index]))
        boxes[:, :, 0] = np.minimum(boxes[:, :, 0], states)  # rounding must not exclude the state itself
        boxes[:, :, 1] = np.maximum(boxes[:, :, 1], states)
    if period:
        rotating = (decided.labels == Fate.BOUNDED) & ~trapped
        other = decided.labels != Fate.BOUNDED
        periods[other] = [without_return(label) for label in decided.labels[other]]
        periods[rotating] = rotation_periods(land, states[rotating], decided.margins[rotating])
        for index in np.nonzero((left_open & PERIOD > 0) | (rotating & np.isnan(periods)))[0]:
            periods[index] = precise_period(Orbit(land.reduction, states[index]), Fate.BOUNDED)
    return boxes, periods


# --- Many states of a scene with an orbit: fates, extremes and periods of rows (n, 3)
__all__ = ["extremes", "fates", "periods"]


def extremes(scene, states, span=None, fast: bool | None = None):
    """(n, 3, 2) over t >= 0; `span` and `fast` are not needed."""
    return extremes_and_periods(scene, states, period=False)[0]


def periods(scene, states, fast: bool | None = None):
    """(n,); inf where the motion does not repeat, 0 at an equilibrium, NaN where it is undecided; `fast` is
    not needed."""
    return extremes_and_periods(scene, states, box=False)[1]
