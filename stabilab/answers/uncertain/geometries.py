"""Margins of bodies of a box, many at once, whose moments may change places within it.

Under a torque along a principal axis without momentum along it, the signs of p and q (`orbit.reduction`) say
whether a motion runs on a circle (they differ) or on a hyperbola. On a circle a barrier decides
(`boxes.Family`), on a hyperbola or parabola a motion is bounded but for a set of measure zero.
"""
from __future__ import annotations

from typing import Any

import numpy as np

from ...numbers.affine import lifted
from ...orbit.reduction import reduction_about
from .boxes import Box, Family
from .result import UNKNOWN


def margins(box: Box, axis: int, points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(margin, sense, possible) of points (n, places), in floats, as of `Family.margins`: inf on hyperbolas
    and parabolas; not possible where there is no reduction or no rigid body."""
    n = len(points)
    margin, sense, possible = np.full(n, np.inf), np.ones(n, int), np.ones(n, bool)
    with np.errstate(all="ignore"):
        numbers = box.numbers(points, np.zeros_like(points))
        reduction: Any = reduction_about(box.rates(numbers), axis)
        possible &= ~np.broadcast_to(box.impossible(numbers), n) & box.rigid(points)
        p, q = (np.sign(np.broadcast_to(lifted(v).c, n)) for v in (reduction.p, reduction.q))
    for sign in (1, -1):
        rows = np.flatnonzero((p == sign) & (q == -sign) & possible)
        if len(rows):
            margin[rows], sense[rows], possible[rows] = Family(box, axis, (sign, -sign)).margins(points[rows])
    return margin, sense, possible & ~np.isnan(margin)


def codes(box: Box, axis: int, points: np.ndarray) -> np.ndarray:
    """0 for bounded, else the sense of the spin-up, or UNKNOWN, of points (n, places)."""
    margin, sense, possible = margins(box, axis, points)
    return np.where(possible, np.where(margin > 0, 0, sense), UNKNOWN)
