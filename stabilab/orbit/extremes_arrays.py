"""Extremes and periods of many states: fates first, then row by row what swings between two turning points
(`rows_kernel`) or goes round a circle (`turns_kernel`), which numba compiles, the rest by NumPy, and balls
for what these leave open."""
from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from ..errors import InputError
from ..numbers.numba_door import Kernel, installed
from ..physics.coefficients import effective
from ..physics.states import checked_states
from . import rows_kernel, turns_kernel
from .arc_kernel import BASE, ENTRIES, INLINED
from .extremes import precise_extremes
from .fate_arrays import CHUNK, FateResult, fate_on_orbit, fates, rows_beyond_doubles
from .landscape import Landscape, landscape
from .one_orbit import Orbit
from .one_state import far_numbers
from .period import precise_period
from .reduction import reduce
from .result import Fate, without_return
from .rows_kernel import BOX, PERIOD

if TYPE_CHECKING:
    from ..physics.scene import AnyScene

# --- Rows by NumPy: at rest, along a parabola without a force that changes
def trapped_rows(land: Landscape, decided: FateResult):
    """(n,) True for motions between two turning points."""
    trapped = decided.labels == Fate.BOUNDED
    return trapped & (decided.margins >= 0) if land.may_rotate else trapped


def open_extremes(land: Landscape, states: np.ndarray, labels: np.ndarray):
    """Extremes (n, 3, 2) of rows that neither two turning points bound nor a circle; NaN where these are left
    to balls, as on an invariant plane."""
    out, spins = np.repeat(states[:, :, None], 2, axis=2), labels == Fate.SPIN_UP
    if land.conic is None:  # along a parabola whose force does not change both other rates stay
        out[spins, land.reduction.axis, 1 if land.sense > 0 else 0] = land.sense * np.inf
    out[(labels == Fate.BOUNDED) | (labels == Fate.SEPARATRIX) | (spins & (land.conic is not None))] = np.nan
    return out


# --- Row by row, by the kernels
REACH = 3.45  # of t: beyond, the weights of double-exponential nodes are 1e-20
LAST_LEVEL = 8  # of these nodes, whose steps are 2^-level
HALVED = 8, 16, 32, 64  # intervals whose midpoints are added to the trapezoidal nodes of eight
KERNELS = {"rows": Kernel(rows_kernel, "rows", 5.3, INLINED, options=ENTRIES, below=BASE),
           "turns": Kernel(turns_kernel, "turns", 3.2, INLINED, options=ENTRIES, below=BASE)}
# s of a processor: a row in plain Python, and what its period takes beside
ROW, PERIOD_OF_ROW = {"rows": 4.2e-4, "turns": 2.5e-4}, {"rows": 1e-4, "turns": 4.5e-3}


def settle_rows(land: Landscape, states: np.ndarray, boxes: np.ndarray, periods: np.ndarray,
                left_open: np.ndarray, by_numba: bool | None = None, kernel: str = "rows"):
    """Fill boxes (n, 3, 2) and periods (n,), each unless it is empty, of the open ones of states (n, 3):
    librations, or by the kernel of turns motions all round a circle.

    left_open: (n,) bits, `BOX` and `PERIOD`, of which those that are settled are cleared. by_numba: whether
    compiled code serves, where numba is installed; None: where the rows of this process repay loading it
    (`Kernel`). The bytes are the same.
    """
    rows = np.nonzero(left_open)[0]
    if not rows.size:
        return
    loops = KERNELS[kernel]
    work = ROW[kernel] * rows.size + PERIOD_OF_ROW[kernel] * np.count_nonzero(left_open & PERIOD)
    function = loops.functions(loops.pays(work, by_numba and installed()))[kernel]
    with np.errstate(all="ignore"):
        function(states, rows, *land.kernel_input, rules(), boxes, periods, left_open)


@lru_cache(maxsize=1)
def rules():
    """(shares sin(phi/2)^2 <= 1/2 of the trapezoidal nodes of eight intervals, then of the midpoints of these
    and of twice as many; distances of the double-exponential nodes from the nearer end, negative where that
    is the inner one, their weights, and where levels begin)."""
    phi = np.concatenate([np.arange(5) * (np.pi / 8)]
                         + [(np.arange(n // 2) + 0.5) * (np.pi / n) for n in HALVED])
    levels = [double_exponential_nodes(level) for level in range(LAST_LEVEL + 1)]
    nearby, weights = (np.concatenate(parts) for parts in zip(*levels))
    return np.sin(0.5 * phi) ** 2, nearby, weights, np.cumsum([0] + [len(route) for route, _ in levels])


def double_exponential_nodes(level: int):
    """(signed distances over the length, weights) of the nodes that a level adds."""
    k = np.arange(-int(REACH * 2**level), int(REACH * 2**level) + 1)
    if level:
        k = k[k % 2 != 0]
    t = k * 2.0**-level
    u = 0.5 * np.pi * np.sinh(t)
    # x = 1/(1 + exp(-2 u)), dx = pi/2 cosh t / (2 cosh(u)^2) dt
    nearby = 1 / (1 + np.exp(2 * np.abs(u)))
    return np.where(t > 0, -nearby, nearby), 0.25 * np.pi * np.cosh(t) / np.cosh(u) ** 2


# --- All rows in one pass
def extremes_and_periods(scene: AnyScene, states: np.ndarray, *, box: bool = True, period: bool = True,
                         by_numba: bool | None = None):
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
    nearby = np.nonzero(~far)[0]
    for start in range(0, len(nearby), CHUNK):
        rows = nearby[start:start + CHUNK]
        some, times = _of_chunk(scene, flat[rows], box, period, by_numba)
        boxes[rows if box else []], periods[rows if period else []] = some, times
    return boxes.reshape(array.shape
                         + (2,)) if box else None, periods.reshape(array.shape[:-1]) if period else None


def _of_chunk(scene: AnyScene, states: np.ndarray, box: bool, period: bool, by_numba: bool | None):
    """(boxes (n, 3, 2), periods (n,)) of one chunk, each empty where it is not asked for."""
    land = landscape(scene)
    decided = fate_on_orbit(scene, land, states)
    boxes, periods = np.empty((len(states) if box else 0, 3, 2)), np.empty(len(states) if period else 0)
    bounded, trapped = decided.labels == Fate.BOUNDED, trapped_rows(land, decided)
    spinning = (decided.labels == Fate.SPIN_UP) & (land.turn < np.inf)
    left_open = np.where(trapped, BOX * box + PERIOD * period, 0).astype(np.uint8)
    settle_rows(land, states, boxes, periods, left_open, by_numba)
    turning = np.where(bounded & ~trapped, BOX * box + PERIOD * period, BOX * box * spinning).astype(np.uint8)
    settle_rows(land, states, boxes, periods, turning, by_numba, "turns")
    left_open |= turning
    if box:
        others = ~bounded & ~spinning
        boxes[others] = open_extremes(land, states[others], decided.labels[others])
        for index in np.nonzero((left_open & BOX > 0) | (others & np.isnan(boxes).any(axis=(1, 2))))[0]:
            boxes[index] = precise_extremes(Orbit(land.reduction, states[index]), int(decided.labels[index]))
        boxes[:, :, 0] = np.minimum(boxes[:, :, 0], states)  # rounding must not exclude the state itself
        boxes[:, :, 1] = np.maximum(boxes[:, :, 1], states)
    if period:
        periods[~bounded] = [without_return(label) for label in decided.labels[~bounded]]
        for index in np.nonzero(left_open & PERIOD)[0]:
            periods[index] = precise_period(Orbit(land.reduction, states[index]), Fate.BOUNDED)
    return boxes, periods


# --- Many states of a scene with an orbit: fates, extremes and periods of rows (n, 3)
__all__ = ["extremes", "fates", "periods"]


def extremes(scene, states, span=None, fast: bool | None = None):
    """(n, 3, 2) over t >= 0; `span` and `fast` are not needed."""
    return extremes_and_periods(scene, states, period=False)[0]


def periods(scene: AnyScene, states: np.ndarray, fast: bool | None = None):
    """(n,); inf where the motion does not repeat, 0 at an equilibrium, NaN where it is undecided; `fast` is
    not needed."""
    return extremes_and_periods(scene, states, box=False)[1]
