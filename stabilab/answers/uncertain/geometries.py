"""Margins of bodies of a box, many at once, whose moments may change places within it.

Under a torque along a principal axis without momentum along it, the signs of p and q (`orbit.reduction`) say
whether a motion runs on a circle (they differ) or on a hyperbola. On a circle a barrier decides
(`boxes.Family`), on a hyperbola or parabola a motion is bounded but for a set of measure zero.
"""
from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ...numbers.affine import lifted
from ...orbit.reduction import reduction_about
from .boxes import Box
from .branch_and_bound import Family
from .result import UNKNOWN, corners

SEED, DRAWN, STARTS = 8, 2048, 16  # of a search for the least margin: points at random, the least of them
PLACES = (-1.0, -0.5, 0.0, 0.5, 1.0)
FINEST, ROUNDS = 0.02, 60  # step of that search, in half-widths, and steps at most


def margins(box: Box, axis: int, points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(margin, sense, possible) of points (n, places), in floats, as of `Family.margins` but for a positive
    factor: inf on hyperbolas and parabolas; not possible where there is no reduction or no rigid body."""
    n = len(points)
    margin, sense, possible = np.full(n, np.inf), np.ones(n, int), np.ones(n, bool)
    with np.errstate(all="ignore"):
        numbers = box.numbers(points, np.zeros_like(points))
        reduction: Any = reduction_about(box.rates(numbers), axis)
        possible &= ~np.broadcast_to(box.impossible(numbers), n) & box.rigid(points)
        p, q = (np.broadcast_to(lifted(v).c, n) for v in (reduction.p, reduction.q))
    for sign in (1, -1):
        rows = np.flatnonzero((np.sign(p) == sign) & (np.sign(q) == -sign) & possible)
        if len(rows):
            height, sense[rows], possible[rows] = Family(box, axis, (sign, -sign)).margins(points[rows])
            # of the canonical variables, whose unit vanishes with two equal moments: a rate squared
            margin[rows] = height / np.abs(p[rows] * q[rows])
    return margin, sense, possible & ~np.isnan(margin)


def codes(box: Box, axis: int, points: np.ndarray) -> np.ndarray:
    """0 for bounded, else the sense of the spin-up, or UNKNOWN, of points (n, places)."""
    margin, sense, possible = margins(box, axis, points)
    return np.where(possible, np.where(margin > 0, 0, sense), UNKNOWN)


def deepest(margins: Callable[[np.ndarray], np.ndarray], n: int) -> np.ndarray:
    """The point (n,) of the box [-1, 1]^n at which a margin is least, as far as a search finds it: corners,
    points drawn at random, and from the least of these on one number at a time, in smaller and smaller steps.
    margins: points -> (m,), NaN or inf where there is none."""
    smallest = lambda points: np.nan_to_num(margins(points), nan=np.inf)
    rng = np.random.default_rng(SEED)
    tried = np.concatenate([corners(n), rng.uniform(-1, 1, (DRAWN, n)), rng.choice(PLACES, (DRAWN, n))])
    heights = smallest(tried)
    first = np.argsort(heights, kind="stable")[:STARTS]
    result, heights = tried[first], heights[first]
    step = 0.5
    for _ in range(ROUNDS):
        moves = step * np.concatenate([np.eye(n), -np.eye(n)])
        nearby = np.clip(result[:, None, :] + moves, -1, 1)
        beside = smallest(nearby.reshape(-1, n)).reshape(len(result), -1)
        best, rows = beside.argmin(1), np.arange(len(result))
        lower = beside[rows, best] < heights
        result = np.where(lower[:, None], nearby[rows, best], result)
        heights = np.where(lower, beside[rows, best], heights)
        step = step if lower.any() else step / 2
        if step < FINEST:
            break
    return result[heights.argmin()]
