"""Where a bounded motion turns: the ends of its interval of the reduced coordinate, next to separatrices too."""
from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from ...numbers.constants import EPS
from ...numbers.roots import bracketed_newton
from ..fine.rows_kernel import way_of_cosine
from ..landscape import Landscape


@dataclass(frozen=True)
class Interval:
    """The allowed interval of theta, as offsets from the state: left <= 0 <= right (n,), with places (2, n) there;
    fastest (n,): the largest W^2/2 inside; middle: place (2, n) half-way; half: half the length; ok: (n,) False where no
    interval was found (rounding at a fold, say). blur: (2, n) rounding error of both ends' offsets, left first;
    haze: (n,) that of `fastest`; closest: (n,) least difference between the energy and a barrier's height."""

    left: np.ndarray
    right: np.ndarray
    left_place: np.ndarray
    right_place: np.ndarray
    fastest: np.ndarray
    middle: np.ndarray
    half: np.ndarray
    ok: np.ndarray
    blur: np.ndarray
    haze: np.ndarray
    closest: np.ndarray

    def take(self, rows) -> Interval:
        """Those of some of the states."""
        return Interval(**{field.name: getattr(self, field.name)[..., rows] for field in fields(self)})


@dataclass(frozen=True)
class Spots:
    """Equilibria along the orbit, ascending in offset (n, m): places (2, n, m), energy above each (n, m) =
    E - V(spot), barrier or well; `there` marks the real ones (the rest are padding at +inf)."""

    offset: np.ndarray
    place: np.ndarray
    energy: np.ndarray
    barrier: np.ndarray
    there: np.ndarray


def spots_along(land: Landscape, place, w) -> Spots:
    """All equilibria near the state along its orbit, on a circle those of one turn behind and one ahead."""
    offset, spot, barrier = land.critical(place)
    energy = np.full(offset.shape, np.nan)
    kinetic = 0.5 * w * w
    with np.errstate(all="ignore"):
        offset = land.unrolled(place, offset, spot)
        for column in range(offset.shape[1]):
            energy[:, column] = kinetic + land.potential.rise(-offset[:, column], spot[:, :, column])
        offset, spot, energy, barrier = land.repeated(offset, spot, energy, barrier)
    order = np.argsort(np.where(np.isnan(offset), np.inf, offset), axis=1, kind="stable")
    take = lambda a: np.take_along_axis(a, order, axis=1)
    offset = take(offset)
    there = ~np.isnan(offset)
    return Spots(np.where(there, offset, np.inf), np.stack([take(spot[0]), take(spot[1])]), take(energy),
                 take(barrier) & there, there)


def interval(land: Landscape, place, w) -> Interval:
    """The allowed interval of each bounded state; places, w: (n,) arrays in canonical variables."""
    spots = spots_along(land, place, w)
    ends = {}
    for side in (1, -1):
        ends[side] = turning_point(land, spots, place, w, side)
    right, right_place, ok_r, blur_r, haze_r = ends[1]
    left, left_place, ok_l, blur_l, haze_l = ends[-1]
    right, left = np.maximum(right, 0.0), np.minimum(left, 0.0)
    inside = spots.there & ~spots.barrier & (spots.offset >= left[:, None]) & (spots.offset <= right[:, None])
    wells = np.where(inside, spots.energy, -np.inf)
    fastest = np.maximum(wells.max(axis=1, initial=-np.inf), 0.5 * w * w)
    closest = np.where(spots.barrier, np.abs(spots.energy), np.inf).min(axis=1, initial=np.inf)
    # from an anchor that the search put nowhere near the state the way to the end may leave the doubles
    told = np.isfinite(left_place).all(axis=0) & np.isfinite(right_place).all(axis=0)
    half = 0.5 * (right - left)
    with np.errstate(all="ignore"):
        middle = np.array(land.potential.move(place, 0.5 * (right + left)))
    return Interval(left, right, left_place, right_place, fastest, middle, half, ok_r & ok_l & told & np.isfinite(half),
                    np.array([blur_l, blur_r]), np.maximum(haze_l, haze_r) + EPS * fastest, closest)


def turning_point(land, spots, place, w, side):
    """Turning point on one side: (offset, place, found, error of the offset, error of the energy over the anchor)."""
    n, m = spots.offset.shape
    if m == 0:
        return np.zeros(n), np.array(place), np.zeros(n, bool), np.zeros(n), np.zeros(n)
    rows = np.arange(n)
    beyond = spots.there & spots.barrier & (spots.energy <= 0) & (
        (spots.offset > 0) if side > 0 else (spots.offset < 0))
    has_barrier = beyond.any(axis=1)
    b = np.argmax(beyond, axis=1) if side > 0 else m - 1 - np.argmax(beyond[:, ::-1], axis=1)
    count = spots.there.sum(axis=1)
    well = np.where(has_barrier, b - side, np.where(side > 0, count - 1, 0))
    has_well = (well >= 0) & (well < count)
    well = np.clip(well, 0, m - 1)
    has_well &= ~spots.barrier[rows, well]
    ok = has_well | has_barrier
    nearer_barrier = -spots.energy[rows, b] < np.maximum(spots.energy[rows, well], 0)
    anchored_at_barrier = has_barrier & (nearer_barrier | ~has_well)
    anchor = np.where(anchored_at_barrier, b, well)
    level = spots.energy[rows, anchor]
    level = np.where(anchored_at_barrier, np.minimum(level, 0), np.maximum(level, 0))
    spot = spots.place[:, rows, anchor]
    with np.errstate(invalid="ignore"):
        gap = np.abs(spots.offset[rows, b] - spots.offset[rows, well])
    gap = np.where(has_barrier & has_well, gap, np.where(ok, np.inf, 1.0))
    gap = np.minimum(gap, land.turn)
    towards = np.where(anchored_at_barrier, -side, side)
    reach = _reach(land, spot, level, gap, towards)
    curvature = np.maximum(np.abs(land.potential.slope(tuple(spot))), 1e-300)
    start = np.minimum(np.sqrt(2 * np.abs(level) / curvature), 0.5 * reach)
    both = has_barrier & has_well
    if both.any():
        other = np.where(anchored_at_barrier, well, b)
        start = np.where(both, _start_between(land, spots, rows, well, b, level, gap, spot, other), start)

    def fun(t, towards, level, *spot):
        rise = land.potential.rise(towards * t, spot)
        spot = land.potential.move(spot, towards * t)
        return rise - level, -towards * land.potential.force(spot)
    with np.errstate(all="ignore"):
        y = bracketed_newton(fun, np.zeros(n), reach, start, (towards, level, *spot), rising=~anchored_at_barrier,
                             enough=1e-9)
    y = np.where(level == 0, 0.0, y) * towards
    start = spots.offset[rows, anchor]
    with np.errstate(all="ignore"):
        end = np.array(land.potential.move(tuple(spot), y))
        haze = land.haze(tuple(spot), start, y)
        blur = haze / np.abs(land.potential.force(tuple(end))) + EPS * np.abs(start)
        return np.where(ok, start + y, 0.0), end, ok, blur, haze


def _start_between(land, spots, rows, well, barrier, level, gap, spot, other):
    """First guess of the way from the anchor to the turning point, where it lies between a well and a barrier."""
    bend, far_bend = (np.abs(land.potential.slope(tuple(s))) for s in (spot, spots.place[:, rows, other]))
    with np.errstate(all="ignore"):
        whole = spots.energy[rows, well] - spots.energy[rows, barrier]
        psi = 2 / np.pi * np.arcsin(np.sqrt(np.clip(np.abs(level) / whole, 0, 1)))
        near, far = (np.pi * np.sqrt(0.5 * whole / b) / gap for b in (bend, far_bend))
        guess = gap * way_of_cosine(psi, near, far)
    return np.where((guess > 0) & (guess < gap), guess, 0.5 * gap)


def _reach(land, spot, level, gap, towards):
    """A step from the spot at which the potential has surely passed the level: the gap, or a doubling search."""
    reach = np.where(np.isfinite(gap), gap, 1.0)
    open_ = ~np.isfinite(gap)
    with np.errstate(all="ignore"):
        for _ in range(1100):
            rise = land.potential.rise(towards * reach, tuple(spot))
            short = open_ & np.where(level < 0, rise > level, rise < level)
            if not short.any():
                break
            reach = np.where(short, land.farther(reach), reach)
    return reach
