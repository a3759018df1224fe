"""Extremes and periods of arrays in one pass: they share fates, turning points and the compiled kernel."""
from __future__ import annotations

import numpy as np

from ..errors import InputError
from ..physics.coefficients import effective
from ..physics.states import checked_states
from .extremes import parabola_numba
from .extremes.arrays import extremes_of_chunk
from .extremes.guards import picked, trapped_rows
from .extremes.turning_points import interval
from .far_states import far_numbers
from .fate.arrays import fate_on_orbit, rows_beyond_doubles
from .fate.result import CHUNK
from .fine.rows_numba import by_rows
from .landscape import landscape
from .period.arrays import period_chunk
from .reduction import reduce


def extremes_and_periods(scene, states, fast: bool | None = None, *, box=True, period=True):
    """(extremes (..., 3, 2), periods (...,)) in one go, each as the function of its name gives it; None for one that
    is not asked for. For scenes with a reduction only (InputError for others, and as `extremes` raises it)."""
    scene, array = effective(scene), checked_states(states)
    if reduce(scene) is None:
        raise InputError("extremes_and_periods: this scene has no reduction to one coordinate; ask for `extremes` with a"
                         " span, or for `period`")
    flat = np.ascontiguousarray(array.reshape(-1, 3))
    boxes, periods = np.empty((len(flat) if box else 0, 3, 2)), np.empty(len(flat) if period else 0)
    if (far := rows_beyond_doubles(scene, flat)).any():
        _fill_far(scene, flat, boxes, periods, far)
        return boxes.reshape(array.shape + (2,)) if box else None, periods.reshape(array.shape[:-1]) if period else None
    land, left_open, tried = landscape(scene), None, False
    if fast is not False and land.base == "parabola":
        left_open = parabola_numba.by_kernel(land, flat, boxes, periods, fast)
    elif fast is not False:
        left_open = by_rows(land, flat, boxes, periods, fast)
        tried = left_open is not None
    if left_open is None:
        for start in range(0, len(flat), CHUNK):
            rows = slice(start, start + CHUNK)
            _fill(land, scene, flat[rows], boxes[rows], periods[rows])
    else:
        for column, bit in ((boxes, 1), (periods, 2)):
            _fill_open(land, scene, flat, column, np.nonzero(left_open & bit)[0] if len(column) else [], bit, not tried)
    return (boxes.reshape(array.shape + (2,)) if box else None, periods.reshape(array.shape[:-1]) if period else None)


def _fill_far(scene, states, boxes, periods, far):
    """All rows, those that are `far` (their squares may be no doubles) one at a time in their own unit."""
    near = extremes_and_periods(scene, states[~far], box=len(boxes) > 0, period=len(periods) > 0) if not far.all() else (None, None)
    for column, values, which in zip((boxes, periods), near, (0, 1)):
        if len(column):
            column[far] = [far_numbers(scene, state)[which] for state in states[far].tolist()]
            column[~far] = values if values is not None else column[~far]


def _fill(land, scene, states, boxes, periods, twofold=True):
    """One chunk: boxes (n, 3, 2) and periods (n,), each unless it is empty. twofold: whether to try these rows in twofold numbers before balls."""
    decided = fate_on_orbit(scene, land, states)
    start = land.start(states)
    trapped = trapped_rows(land, decided)
    span = interval(land, *picked(start[0], start[1], trapped)) if len(boxes) and len(periods) and trapped.any() else None
    if len(boxes):
        boxes[:] = extremes_of_chunk(land, states, decided, start, span, twofold)
    if len(periods):
        periods[:] = period_chunk(land, states, decided, start, span, twofold)


def _fill_open(land, scene, states, column, rows, bit, twofold):
    """Those rows of the boxes (bit 1) or the periods (bit 2) that the compiled kernels left open: together, for a handful costs as much as a thousand."""
    for start in range(0, len(rows), CHUNK):
        part, none = rows[start:start + CHUNK], np.empty(0)
        some = np.empty((len(part),) + column.shape[1:])
        _fill(land, scene, states[part], *((some, none) if bit == 1 else (none, some)), twofold)
        column[part] = some
