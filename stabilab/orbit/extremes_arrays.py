"""Extremes and periods of many states: fates first, then librations row by row, the rest by NumPy, and
balls for what these leave open.

NumPy answers the rows that no two turning points bound: at rest, round a circle without torque, spinning
up. Librations go to `rows_kernel`, which numba compiles.

Balls take what doubles would lose, next to a separatrix or far from the centre of the orbits."""
from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from ..errors import InputError
from ..numbers.double_double import TURN
from ..numbers.numba_door import compiled, installed
from ..physics.coefficients import effective
from ..physics.states import checked_states
from . import rows_kernel
from .arc_kernel import INLINED
from .extremes import precise_extremes, precise_period
from .fate_arrays import CHUNK, COLD, WARM, FateResult, fate_on_orbit, fates, rows_beyond_doubles
from .landscape import (
    CircleLandscape,
    ConicLandscape,
    HyperbolaLandscape,
    Landscape,
    ParabolaLandscape,
    Spots,
    landscape,
    spots_along,
)
from .one_orbit import Orbit
from .one_state import far_numbers
from .reduction import reduce
from .result import Fate, without_return
from .rows_kernel import BOX, PERIOD

if TYPE_CHECKING:
    from ..physics.scene import AnyScene

# --- Rows by NumPy: at rest, round a circle without torque, spinning up
# closer to the separatrix than this share of the energy terms, rounding costs extremes 1e-12
EXTREMES_SHARE = 1e-7
# the same for the least rate of a motion that just passes a barrier: the root of a difference
SPIN_UP_SHARE = 1e-4
PERIOD_SHARE = 1e-5  # the same for a period, 1e-11
ON_TOP = 1e-13  # of the terms of the force, some hundreds of roundings
# canonical variables lose this factor of accuracy to the shift before the precise path takes over
SHIFT_LIMIT = 1e4
# relative, of the sums over so many nodes and twice as many: the error left is its square; rounding leaves
# some 1e-13
AGREE = 1e-12
MOST_NODES = 1 << 15  # more than the peaks of the integrand ask for at `PERIOD_SHARE`


def trapped_rows(land: Landscape, decided: FateResult):
    """(n,) True for motions between two turning points."""
    trapped = decided.labels == Fate.BOUNDED
    return trapped & (decided.margins >= 0) if land.may_rotate else trapped


def needs_digits(land: Landscape, states: np.ndarray):
    """(n,) True where the canonical shift is so large that doubles would lose digits (nearly equal moments,
    or a wheel on the axis of symmetry of a body that hardly turns about it)."""
    r = land.reduction
    shift, along = r.parabolic_shift_size, abs(float(r.s))
    lost = np.zeros(len(states), bool)
    if shift:
        lost |= shift > SHIFT_LIMIT * np.maximum(np.abs(states).max(axis=1), 1e-300)
    return lost | (along > SHIFT_LIMIT * np.abs(states[:, r.axis])) if along else lost


def on_top(land: Landscape, location: Sequence[np.ndarray]):
    """(n,) True where the state is at the place of a barrier to rounding: before it or behind, doubles do not
    tell."""
    pot = land.potential
    return (np.abs(pot.force(location)) <= ON_TOP * pot.terms(location)) & (pot.slope(location) > 0)


def near_separatrix(land: Landscape, location: Sequence[np.ndarray], w: np.ndarray, margins: np.ndarray,
                    fraction: float | np.ndarray):
    """(n,) True where the margin is below `fraction` of the energy's terms: turning points and periods
    magnify its rounding there."""
    return np.abs(margins) <= fraction * land.reduction.energy_unit * land.energy_terms(location, w)


def open_extremes(land: Landscape, states, labels, margins):
    """Extremes (n, 3, 2) of rows that are not `trapped_rows`; NaN where these are left to balls."""
    out = np.repeat(states[:, :, None], 2, axis=2)
    moving = np.nonzero((labels != Fate.EQUILIBRIUM) & (labels != Fate.UNDECIDED))[0]
    if not moving.size:
        return out
    states, labels, margins = states[moving], labels[moving], margins[moving]
    location, w, _ = land.start(states)
    fraction = np.where(labels == Fate.SPIN_UP, SPIN_UP_SHARE, EXTREMES_SHARE)
    doubtful = (needs_digits(land, states) | land.beside_centre(location)
                | near_separatrix(land, location, w, margins, fraction))
    doubtful |= on_top(land, location)
    values = np.full((len(states), 3, 2), np.nan)
    ranges: tuple[tuple[Fate, Callable[..., np.ndarray]], ...] = (
        (Fate.BOUNDED, _rotating), (Fate.SPIN_UP, SPINNING[land.e]))
    for label, extremes in ranges:
        rows = (labels == label) & ~doubtful
        if rows.any():
            values[rows] = extremes(land, tuple(v[rows] for v in location), w[rows])
    out[moving] = values
    return out


def rotation_periods(land: Landscape, states: np.ndarray, margins: np.ndarray):
    """Periods (n,) of motions without torque over all barriers of a circle; NaN where these are left to
    balls."""
    location, w, _ = land.start(states)
    values = np.full(len(states), np.nan)
    doubtful = needs_digits(land, states) | near_separatrix(land, location, w, margins, PERIOD_SHARE)
    live, before, nodes = np.nonzero(~doubtful)[0], np.full(np.count_nonzero(~doubtful), np.nan), 16
    force = land.potential.force(location)
    # the integrand is periodic: the plain sum converges geometrically
    while live.size and nodes <= MOST_NODES:
        now, item = np.zeros(len(live)), tuple(v[live] for v in location)
        for angle in np.arange(nodes) * (TURN / nodes):
            with np.errstate(all="ignore"):
                rise = land.potential.rise(np.full(len(live), angle), item, force[live])
                now += 1 / np.sqrt(np.maximum(w[live] ** 2 - 2 * rise, 0))
        now *= TURN / nodes
        done = np.abs(now - before) <= AGREE * now
        values[live[done]] = now[done]
        live, before, nodes = live[~done], now[~done], 2 * nodes
    return values


def _components(land: ConicLandscape, low: Sequence[np.ndarray], high: Sequence[np.ndarray],
                w_low: np.ndarray, w_high: np.ndarray):
    """(n, 3, 2) from canonical ranges, whatever signs the change of variables has."""
    a, b = land.components(low, w_low), land.components(high, w_high)
    return np.stack([np.minimum(a, b), np.maximum(a, b)], axis=2)


def _rotating(land: CircleLandscape, location: Sequence[np.ndarray], w: np.ndarray):
    """Torque-free motions over all barriers of the circle: the whole circle, one sign of W."""
    spots = spots_along(land, location, w)
    energy = np.where(spots.there, spots.energy, np.nan)
    with np.errstate(all="ignore"):
        energies = np.concatenate([energy, 0.5 * w[:, None] ** 2], axis=1)
        slow, fast = np.sqrt(2 * np.nanmin(energies, axis=1)), np.sqrt(2 * np.nanmax(energies, axis=1))
    radius = np.hypot(*location)
    sign = np.sign(w)
    return _components(land, (-radius, -radius), (radius, radius), sign * slow, sign * fast)


def _spinning_round(land: CircleLandscape, location: Sequence[np.ndarray], w: np.ndarray):
    """Over the future of a spin-up, W -> +inf, on a circle: all of it, from the slowest rate on."""
    radius = np.hypot(*location)
    return _components(land, (-radius, -radius), (radius, radius), _slowest_ahead(land, location, w),
                       np.full(len(w), np.inf))


def _slowest_ahead(land: CircleLandscape, location: Sequence[np.ndarray], w: np.ndarray):
    """The least W over the future: over the barriers ahead, or on the way to the turning point behind if W <
    0."""
    spots = spots_along(land, location, w)
    slowest = _over_barriers_ahead(spots, w)
    back = w < 0
    if back.any():
        # the wells between the turning point on the left and the state
        fastest = _fastest_behind(land, tuple(v[back] for v in location), w[back])
        slowest[back] = -np.sqrt(2 * fastest)
    return slowest


def _over_barriers_ahead(spots: Spots, w: np.ndarray):
    ahead = np.where(spots.there & (spots.offset > 0), spots.energy, np.inf)
    with np.errstate(all="ignore"):
        return np.minimum(w, np.sqrt(2 * np.maximum(ahead.min(axis=1, initial=np.inf), 0)))


def _fastest_behind(land: CircleLandscape, location: Sequence[np.ndarray], w: np.ndarray):
    """Largest W^2/2 between the turning point behind and the state, for W < 0 on a tilted circle.

    Wells further back than one turn are higher by 2 pi mu, so the first turn behind decides.
    """
    best, blocked = 0.5 * w * w, np.zeros(len(w), bool)
    spots = spots_along(land, location, w)
    for column in range(spots.offset.shape[1] - 1, -1, -1):
        here = spots.there[:, column] & (spots.offset[:, column] < 0)
        blocked |= here & spots.barrier[:, column] & (spots.energy[:, column] < 0)
        well = here & ~blocked & ~spots.barrier[:, column]
        best = np.where(well, np.maximum(best, spots.energy[:, column]), best)
    return best


def _spinning_on_plane(land: HyperbolaLandscape, location: Sequence[np.ndarray], w: np.ndarray):
    """On the decaying plane xi = 0: eta shrinks to 0. Balls tell the excursion back to a turning point
    behind."""
    eta, zero = location[1], np.zeros(len(w))
    slowest = _over_barriers_ahead(spots_along(land, location, w), w)
    slowest[(w < 0) & (eta != 0)] = np.nan
    return _components(land, (zero, np.minimum(eta, 0)), (zero, np.maximum(eta, 0)), slowest,
                       np.full(len(w), np.inf))


def _spinning_purely(land: ParabolaLandscape, location: Sequence[np.ndarray], w: np.ndarray):
    """Along a parabola whose force does not change: both other rates stay."""
    sense, start = land.sense, land.components(location, w)
    spun = np.arange(3) == land.reduction.axis
    low, high = (-np.inf, start) if sense < 0 else (start, np.inf)
    return np.stack([np.where(spun, low, start), np.where(spun, high, start)], axis=2)


SPINNING: dict[int, Callable[..., np.ndarray]] = {
    -1: _spinning_round, 1: _spinning_on_plane, 0: _spinning_purely}


# --- Librations row by row, by the kernel
REACH = 3.45  # of t: beyond, the weights of double-exponential nodes are 1e-20
LAST_LEVEL = 8  # of these nodes, whose steps are 2^-level
HALVED = 8, 16, 32, 64  # intervals whose midpoints are added to the trapezoidal nodes of eight


def settle_rows(land: Landscape, states: np.ndarray, boxes: np.ndarray, periods: np.ndarray,
                left_open: np.ndarray, by_numba: bool | None = None):
    """Fill boxes (n, 3, 2) and periods (n,), each unless it is empty, of the librations of states (n, 3) that
    are open.

    left_open: (n,) bits, `BOX` and `PERIOD`, of which those that are settled are cleared. by_numba: whether
    compiled code serves, where numba is installed; None: where so many rows repay loading it.
    """
    rows = np.nonzero(left_open)[0]
    if not rows.size:
        return
    if by_numba is None:
        by_numba = rows.size >= (WARM if compiled_rows.cache_info().currsize else COLD)
    kernel = compiled_rows() if by_numba and installed() else rows_kernel.rows
    with np.errstate(all="ignore"):
        kernel(states, rows, *land.kernel_input, rules(), boxes, periods, left_open)


@lru_cache(maxsize=1)
def compiled_rows():
    """`rows_kernel.rows` compiled."""
    return compiled(rows_kernel, INLINED)["rows"]


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


def periods(scene: AnyScene, states: np.ndarray, fast: bool | None = None):
    """(n,); inf where the motion does not repeat, 0 at an equilibrium, NaN where it is undecided; `fast` is
    not needed."""
    return extremes_and_periods(scene, states, box=False)[1]
