"""The fate of many torque-free motions: the margin of `free_gyrostat` in doubles, and in many digits where these are not enough.

With the saddle omega* of speed s on the motion's momentum sphere the first-order terms drop out of the difference of their kinetic
energies, and what is left has neither the large terms of the gyrostatic moment nor, to first order, the error of s:

    margin = sum D_i (D_i - s)/(2 s) (omega_i - omega*_i)^2,     omega*_i = lambda_i/(s - D_i).

About a middle axis without a gyrostatic moment s = D_i, and that component drops out. Other saddles lie between the least and
the greatest moment, on a branch on either side of the middle one, along which |H| runs one way; s is measured from the
middle moment, so that its distance from the pole there keeps its digits.
"""
from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ...numbers.constants import EPS
from ...numbers.roots import bracketed_newton
from ..result import Fate
from .free_margin import free_margin, free_middle
from .reasons import Reason

SURE = 16  # times the estimate of rounding: so far from zero a margin's sign is certain
OWN = 1e9  # times that estimate a margin exceeds it, or many digits are asked: so it keeps nine of its own, near a saddle too
MARGIN_SHARE = 5e-13 / 4  # of both kinetic energies: the estimate counts single roundings, of which a margin may have four times as many
LEAST = 1e-290  # smaller terms may have lost digits to underflow


class Branch(NamedTuple):
    """Saddles with s = middle + side r, 0 < r < end; |H| falls from `high` (inf at a pole) to `low` as r grows."""

    side: int
    end: float
    low: float
    high: float


class Saddles(NamedTuple):
    """The saddles of a scene: moments, gyrostatic moment and |H| over `unit`, the middle moment, its distance from each (3,), the
    branches, and the least |H| of rotations about a middle axis without a gyrostatic moment (inf where there is no such axis)."""

    D: np.ndarray
    lam: np.ndarray
    unit: float
    middle: float
    gaps: np.ndarray
    branches: tuple
    least: float


@lru_cache(maxsize=64)
def saddles_of(scene) -> Saddles:
    """The saddles of a torque-free scene (cached)."""
    D, lam, middle = scene.body.exact, scene.vector("gyrostat"), sorted(scene.body.exact)[1]
    largest = float(max(map(abs, lam)))
    unit = 2.0 ** min(int(np.frexp(largest)[1]), 1023) if largest else 1.0
    floats = lambda values: np.array([float(v) for v in values])
    found = Saddles(floats(D), floats(lam) / unit, unit, float(middle), floats(middle - d for d in D), (), np.inf)
    with np.errstate(all="ignore"):
        if free_middle(D, lam):
            found = found._replace(least=float(_momentum(found, np.zeros(1))[0]))
        return found._replace(branches=tuple(filter(None, (_branch(found, side) for side in (-1, 1)))))


def _parts(saddles, t):
    """(s - D_i, omega*_i), each (3, n), for s = middle + t."""
    gap = t + saddles.gaps[:, None]
    return gap, np.where(saddles.lam[:, None] == 0, 0.0, saddles.lam[:, None] / gap)


def _momentum(saddles, t):
    """|H| (n,) of the permanent rotations of speed middle + t."""
    return (saddles.middle + t) * np.sqrt((_parts(saddles, t)[1] ** 2).sum(axis=0))


def _fall(saddles, t):
    """sum lambda_i^2 D_i/(s - D_i)^3: (|H|^2)' over -2 s, falling in s between two poles."""
    gap, omega = _parts(saddles, t)
    return np.where(saddles.lam[:, None] == 0, 0.0, saddles.D[:, None] * omega * omega / gap).sum(axis=0)


def _branch(saddles, side) -> Branch | None:
    """The branch on one side of the middle moment: where `side` times the fall is positive."""
    reach = float((-side * saddles.gaps).max())
    pole = bool((saddles.lam[saddles.gaps == 0] != 0).any())
    rising = lambda r: side * _fall(saddles, side * np.array([r]))[0] > 0
    if not reach > 0 or not saddles.lam.any() or not (pole or rising(0.0)):
        return None
    end = reach if (saddles.lam[-side * saddles.gaps == reach] == 0).all() and rising(reach) else _fold(rising, reach)
    low, high = (float(_momentum(saddles, side * np.array([r]))[0]) for r in (end, 0.0))
    return Branch(side, end, low, np.inf if pole else high)


def _fold(rising, reach) -> float:
    """r below `reach` up to which |H| falls, to rounding."""
    low, high = 0.0, reach
    for power in range(1, 1000):
        if rising(reach * 2.0**-power):
            low = reach * 2.0**-power
            break
        high = reach * 2.0**-power
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if rising(middle) else (low, middle)
    return low


def label_free(scene, states, out) -> int:
    """Fill the columns of `out` for states (n, 3), as the labellers of `fate` do; returns how many were decided in many digits."""
    margins, doubtful = free_margins(scene, states)
    ties = np.zeros(len(states), bool)
    for index in np.nonzero(doubtful)[0]:
        found = free_margin(scene, states[index].tolist())
        margins[index], ties[index] = found.double, found.tie
    out["margins"][:], out["axis"][:], out["sense"][:] = margins, 0, 0
    out["labels"][:] = np.where(ties, Fate.SEPARATRIX, Fate.BOUNDED)
    out["reasons"][:] = np.where(ties, Reason.TIE, Reason.TORQUE_FREE)
    return int(doubtful.sum())


def free_margins(scene, states):
    """(margins (n,) in J, doubtful (n,)) of states (n, 3): inf where the momentum sphere has no saddle; doubtful where rounding
    may cost the sign, or a margin its twelve digits against the kinetic energies of the motion and of the saddle."""
    saddles = saddles_of(scene)
    with np.errstate(all="ignore"):
        omega = (states / saddles.unit).T
        H = saddles.D[:, None] * omega + saddles.lam[:, None]
        size = np.sqrt((H * H).sum(axis=0))
        blur = 4 * EPS * (np.abs(saddles.D[:, None] * omega) + np.abs(saddles.lam[:, None])).sum(axis=0)
        energy = 0.5 * (saddles.D[:, None] * omega * omega).sum(axis=0)
        best, rounding, doubtful = np.full(size.shape, np.inf), np.zeros(size.shape), ~np.isfinite(energy + size * size)
        for there, unsure, margin, error in _candidates(saddles, omega, size, blur):
            doubtful |= unsure | there & ~np.isfinite(margin + error)
            doubtful |= there & (np.abs(np.abs(margin) - np.abs(best)) <= SURE * (error + rounding)) & (margin * best < 0)
            nearer = there & (np.abs(margin) < np.abs(best))
            best, rounding = np.where(nearer, margin, best), np.where(nearer, error, rounding)
        known = np.isinf(best) | (np.abs(best) > OWN * rounding) & (rounding <= MARGIN_SHARE * (energy + np.abs(best + energy)))
        margins = best * saddles.unit * saddles.unit
        lost = np.isfinite(best) & (best != 0) & ~(np.isfinite(margins) & (margins != 0))  # in J, a margin that is no double
        return margins, doubtful | ~known | lost


def _candidates(saddles, omega, size, blur):
    """(there, unsure whether, margin, rounding), arrays (n,), of each kind of saddle."""
    if np.isfinite(saddles.least):
        there = size >= saddles.least
        yield (there & (size > 0), np.abs(size - saddles.least) <= SURE * blur,
               *_margin(saddles, omega, np.zeros(size.shape), np.zeros(size.shape)))
    for branch in saddles.branches:
        there = (branch.low < size) & (size < branch.high)
        unsure = np.minimum(np.abs(size - branch.low), np.abs(size - branch.high)) <= SURE * blur + SURE * EPS * size
        margin, error = np.full(size.shape, np.nan), np.zeros(size.shape)
        r = _solved(saddles, branch, size[there])
        margin[there], error[there] = _margin(saddles, omega[:, there], branch.side * r, size[there] * (blur + EPS * size)[there])
        yield there, unsure, margin, error


def _solved(saddles, branch, size):
    """r (n,) on a branch where |H| is `size`: Newton's method in 1/|H|, which is nearly linear in r next to the pole."""
    pole = float(np.hypot.reduce(saddles.lam[saddles.gaps == 0])) if np.isinf(branch.high) else 0.0
    least = (saddles.middle - branch.end if branch.side < 0 else saddles.middle) * pole / size

    def fun(r, size):
        t = branch.side * r
        here = _momentum(saddles, t)
        return 1 / here - 1 / size, branch.side * (saddles.middle + t) * _fall(saddles, t) / here**3
    low = np.minimum(0.99 * least, branch.end)
    start = np.minimum(saddles.middle * pole / size, 0.5 * branch.end) if pole else np.full(size.shape, 0.5 * branch.end)
    return bracketed_newton(fun, low, np.full(size.shape, branch.end), np.maximum(start, low), (size,))


def _margin(saddles, omega, t, residue):
    """(margin, rounding), (n,) each, over the square of the unit; residue: error of |H|^2/2, and so of s."""
    gap, star = _parts(saddles, t)
    s = saddles.middle + t
    share, way = saddles.D[:, None] * np.abs(gap) / (2 * s), omega - star
    loss = np.where(gap == 0, 0.0, (np.abs(t) + np.abs(saddles.gaps[:, None])) / np.abs(gap))
    rounding = EPS * (share * np.abs(way) * ((2 + loss) * np.abs(way) + 2 * np.abs(omega) + (2 + 2 * loss) * np.abs(star))).sum(axis=0)
    bend = np.where(residue == 0, 0.0, residue**2 / (s**3 * np.abs(_fall(saddles, t))))
    return -(np.sign(gap) * share * way * way).sum(axis=0), rounding + bend + LEAST
