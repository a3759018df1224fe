"""Extremes and periods of rows of bounded motions, from equilibria in twofold numbers: where doubles lose digits and balls would take a millisecond."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...numbers.constants import EPS
from ..extremes.guards import DIGITS
from ..extremes.turning_points import turning_point
from ..landscape import Landscape
from ..period.modes import modes_of
from ..period.rules import librations
from .anchored import Anchored
from .modes import HeldModes, TaylorModes
from .spots import FineSpots, fine_spots

CLEAR = 64  # times its error: so far a height is from the energy where the barrier's side is certain
FAR = 1.5  # of theta: ends farther from their anchor have no period by series
PERIOD_DIGITS = 1e-11  # as of the periods of arrays
SCATTERED = 1e-9  # of H, which is known at the ends and over a barrier: what single nodes lose beside these is scattered, and a part of the integral


class _Anchors:
    """What `turning_point` asks of a landscape."""

    def __init__(self, land):
        self.potential, self.turn, self.farther = Anchored(land.reduction), land.turn, land.farther

    def haze(self, spot, start, y):
        return self.potential.rounding(y, spot)


@dataclass(frozen=True)
class FineInterval:
    """As `Interval`, of offsets from the states alone."""

    left: np.ndarray
    right: np.ndarray
    fastest: np.ndarray
    blur: np.ndarray
    haze: np.ndarray
    ok: np.ndarray
    forces: np.ndarray  # (2, n) F at both ends
    found: FineSpots


def fine_interval(land: Landscape, states) -> FineInterval:
    """The intervals of bounded states (n, 3) on circles or hyperbolas."""
    found, anchors = fine_spots(land, states), _Anchors(land)
    spots, w = found.spots, found.w
    ends = [turning_point(anchors, spots, (found.x, found.z), w, side) for side in (-1, 1)]
    left, right = np.minimum(ends[0][0], 0.0), np.maximum(ends[1][0], 0.0)
    inside = spots.there & (spots.offset >= left[:, None]) & (spots.offset <= right[:, None])
    fastest = np.maximum(np.where(inside & ~spots.barrier, spots.energy, -np.inf).max(axis=1, initial=-np.inf), 0.5 * w * w)
    off, astray = _anchors_errors(found, inside, fastest)
    blur, haze, forces = [], [], []
    for _, place, _, unsure, rounding in ends:
        with np.errstate(all="ignore"):
            forces.append(anchors.potential.force(tuple(place)))
            blur.append(unsure + off / np.abs(forces[-1]) + astray)
        haze.append(rounding + off)
    with np.errstate(invalid="ignore"):
        clear = (~spots.there | ~spots.barrier | (np.abs(spots.energy) > CLEAR * found.error)).all(axis=1)
    ok = found.sure & ends[0][2] & ends[1][2] & clear & np.isfinite(left) & np.isfinite(right)
    return FineInterval(left, right, fastest, np.array(blur), np.maximum(*haze) + EPS * fastest, ok, np.array(forces), found)


def _anchors_errors(found, inside, fastest):
    """(n,) errors of the energy over the equilibria from which ends are told, and of the ways to these: those inside and next to these, no farther
    from the energy."""
    near = inside.copy()
    near[:, 1:] |= inside[:, :-1]
    near[:, :-1] |= inside[:, 1:]
    with np.errstate(invalid="ignore"):
        told = near & (np.abs(found.spots.energy) <= fastest[:, None])
        return tuple(np.where(told, error, 0.0).max(axis=1, initial=0.0) for error in (found.error, found.astray))


def fine_boxes(land: Landscape, states):
    """(extremes (n, 3, 2), which of them have their digits (n,)) of bounded states (n, 3)."""
    span, r, g = fine_interval(land, states), land.reduction, land.reduction.constants
    at = [span.left, span.right, *_stationary(land, span)]
    changes = np.array([_change(land, span.found, y) for y in at])  # (k, 2, n)
    out, top = np.empty((len(states), 3, 2)), np.sqrt(2 * span.fastest)
    good = span.ok & (span.haze <= DIGITS * 2 * span.fastest)
    blurs = [*span.blur] + [0.0] * (len(at) - 2)  # a value that is stationary depends on its place by the square
    blurred = np.max([_change_errors(land, span.found, y, blur) for y, blur in zip(at, blurs)], axis=0)
    for row, axis, factor in ((0, r.j, g["flip"] * g["rx"]), (1, r.k, g["rz"])):
        ends = factor * changes[:, row]
        out[:, axis, 0], out[:, axis, 1] = states[:, axis] + ends.min(axis=0, initial=0.0), states[:, axis] + ends.max(axis=0, initial=0.0)
        good &= abs(factor) * blurred[row] + 4 * EPS * (np.abs(states[:, axis]) + np.abs(ends).max(axis=0)) <= DIGITS * np.abs(out[:, axis]).max(axis=1)
    rates = np.array([r.component_i(-top), r.component_i(top)])
    out[:, r.axis] = np.sort(rates, axis=0).T
    return out, good & np.isfinite(out).all(axis=(1, 2))


def fine_periods(land: Landscape, states):
    """(periods (n,), which of them have their digits (n,)) of bounded states (n, 3)."""
    span, values, sure = fine_interval(land, states), np.full(len(states), np.nan), np.zeros(len(states), bool)
    spots, rows = span.found.spots, np.arange(len(states))
    inside = spots.there & ~spots.barrier & (spots.offset >= span.left[:, None]) & (spots.offset <= span.right[:, None])
    anchor = np.argmax(np.where(inside, spots.energy, -np.inf), axis=1)
    with np.errstate(invalid="ignore"):
        left, right = (end - spots.offset[rows, anchor] for end in (span.left, span.right))
        fits = span.ok & inside.any(axis=1) & (np.maximum(np.abs(left), np.abs(right)) <= FAR) & (right > left)
        wide = span.ok & inside.any(axis=1) & ~fits & (span.right > span.left)
    for which in (fits, wide):
        some = np.nonzero(which)[0]
        if some.size:
            half = 0.5 * (span.right - span.left)[some]
            modes = (TaylorModes.between(Anchored(land.reduction), spots.place[:, rows, anchor][:, some], left[some], right[some]) if which is fits
                     else _modes_of_intervals(land, span, some))
            modes = _held(modes, span, some, half)
            values[some], shape, _ = librations(modes, half)
            unknown = spots.place[3:, rows, anchor][:, some].sum(axis=0)
            sure[some] = np.isfinite(values[some]) & _vouched(modes, half, span.blur[:, some], shape) & (unknown <= PERIOD_DIGITS * shape.min(axis=0))
    return values, sure


def _vouched(modes, half, blur, shape):
    """(n,) True where single nodes keep H to `SCATTERED` at the ends, in the middle and over a barrier, and it hardly moves with the ends' error."""
    with np.errstate(all="ignore"):
        good = blur.sum(axis=0) * np.ptp(shape, axis=0) <= PERIOD_DIGITS * half * np.minimum(shape[0], shape[2])
        for left, value in zip((0.0, 0.5, 1.0), shape):
            good &= 8 * EPS * modes.terms(half, left, 1 - left) <= SCATTERED * value
        return good & (8 * EPS * modes.terms(half, 0.5, 0.5) <= SCATTERED * modes.least)


def _modes_of_intervals(land, span, some):
    """The modes about the middles of intervals that are too long for a series."""
    with np.errstate(all="ignore"):
        return modes_of(land, land.potential.move(tuple(v[some] for v in span.found.place), 0.5 * (span.left + span.right)[some]))


def _held(modes, span, some, half):
    """The modes made to give at both ends the force that is known there, and at the highest barrier inside the energy over it."""
    spots, rows = span.found.spots, np.arange(len(some))
    offset, energy = spots.offset[some], spots.energy[some]
    inside = spots.barrier[some] & (offset > span.left[some, None]) & (offset < span.right[some, None])
    at, there = np.argmin(np.where(inside, energy, np.inf), axis=1), inside.any(axis=1)
    with np.errstate(all="ignore"):
        share = np.where(there, (offset[rows, at] - span.left[some]) / (2 * half), 0.5)
        dip = energy[rows, at] / (4 * half * half * share * (1 - share))
        known = np.array([span.forces[0, some] / (2 * half), np.where(there, dip, np.nan), -span.forces[1, some] / (2 * half)])
        off = known - [modes.second_difference(half, t, 1 - t) for t in (np.zeros(len(some)), share, np.ones(len(some)))]
        off[1] = np.where(there, off[1], 0.5 * (off[0] + off[2]))
    return HeldModes(modes, np.array([off[0], off[2], (off[1] - off[0] * (1 - share) - off[2] * share) / (share * (1 - share)), np.where(there, dip, np.inf)]))


def _change(land, found, y):
    """(2, n) what X and Z change by on the way y from the states."""
    if land.e > 0:  # next to a plane the terms of the sum over sinh and cosh would cancel
        with np.errstate(over="ignore", invalid="ignore"):
            grown, decayed = found.xi * np.expm1(y), found.eta * np.expm1(-y)
            return 0.5 * np.array([grown + decayed, grown - decayed])
    s, less = np.sin(y), -2 * np.sin(0.5 * y) ** 2
    return np.array([found.z * s + found.x * less, found.z * less - found.x * s])


def _change_errors(land, found, y, blur):
    """(2, n) what X and Z at the end of the way y are off by where y is off by `blur`, and by rounding."""
    with np.errstate(over="ignore", invalid="ignore"):
        dx, dz = _change(land, found, y)
        if land.e > 0:
            terms = 0.5 * np.abs([found.xi * np.expm1(y), found.eta * np.expm1(-y)]).sum(axis=0) * (4 + np.abs(y))
            rounding = np.array([terms, terms])
        else:
            s, less = np.abs(np.sin(y)), 2 * np.sin(0.5 * y) ** 2
            rounding = 4 * np.abs([np.abs(found.z) * s + np.abs(found.x) * less, np.abs(found.z) * less + np.abs(found.x) * s])
        return np.abs([found.z + dz, found.x + dx]) * blur + EPS * rounding


def _stationary(land, span):
    """Offsets (n,) where X or Z is stationary inside the interval, 0 where there is none."""
    x, z, xi, eta = span.found.x, span.found.z, span.found.xi, span.found.eta
    with np.errstate(all="ignore"):
        if land.e < 0:
            found = [np.arctan(ratio) + k * np.pi for ratio in (z / x, -x / z) for k in range(-3, 4)]
        else:
            found = [np.where(np.abs(near) < 0.5, np.arctanh(near), 0.5 * np.log(far)) for near, far in ((-z / x, eta / xi), (-x / z, -eta / xi))]
    return [np.where(np.isfinite(y) & (y > span.left) & (y < span.right), y, 0.0) for y in found]
