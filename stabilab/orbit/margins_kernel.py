"""Margins of rows against the barriers of their orbits, of any kind, one row at a time, as straight lines of
floats that numba compiles.

K = E - V at a barrier by the formulas of `arc_kernel`, in twofold numbers where doubles give it too few
digits: a small motion keeps its digits though the orbit is any number of times as large. What that does not
settle, next to a fold, a barrier or an invariant plane, is marked and left to balls. Every function is plain
Python too.
"""
from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..numbers.error_free import Pair, value
from . import arc_kernel, equilibria_kernel
from .arc_kernel import INFINITY, OVER, E, base_of, moved, rounded
from .equilibria_kernel import (
    ARC,
    CLEAR,
    ERROR,
    HEIGHT,
    LONG_ARC,
    POINTS,
    SLOPE,
    points_along,
    sharpened,
    to_throat,
)

BELOW = arc_kernel, equilibria_kernel  # modules whose functions `margins` calls
DOUBT = 1e-10  # of its terms: where the force comes so near to zero, exact numbers say how often it vanishes
MARGIN_SHARE = 5e-13  # of kinetic energy and barrier: half of the rounding that `fate` admits
BESIDE_BARRIER = 1e-9  # of a radian: nearer to one, exact numbers say on which side of it a state is


def nearest_margin(start: float, direction: float, turn: float, energy: float, base: Sequence[Pair],
                   count: int, points: np.ndarray, fine: np.ndarray):
    """(margin, whether it is certain) of a state at an arc from a base. On a circle: of the highest barrier
    within one turn ahead, -inf without one; else of the one that is nearest in height, inf without one."""
    round_a_circle, margin = turn < INFINITY, -INFINITY if turn < INFINITY else INFINITY
    for n in range(count):
        point = points[n]
        ahead = (point[ARC] - start) * direction
        if not point[SLOPE] > 0 or (round_a_circle and not -BESIDE_BARRIER < ahead < turn + BESIDE_BARRIER):
            continue
        if min(abs(ahead), abs(ahead - turn)) <= BESIDE_BARRIER:
            return margin, False
        enough = MARGIN_SHARE * (energy + abs(energy - point[HEIGHT]))
        if not point[ERROR] <= min(0.01 * enough, abs(point[HEIGHT]) / CLEAR):
            sharpened(point, base, fine)
            if not point[ERROR] <= min(enough, abs(point[HEIGHT]) / CLEAR):
                return margin, False
        height = -point[HEIGHT]
        if height > margin if round_a_circle else abs(height) < abs(margin):
            margin = height
    return margin, True


def margins(states: np.ndarray, open_rows: np.ndarray, axes: Sequence[int], fine: np.ndarray, turn: float,
            drift: float, results: np.ndarray, settled: np.ndarray):
    """Fill results (n,) with the margins of the open rows of states (n, 3) that are certain, per unit of
    (omega_i + s)^2/2, and mark these in settled (n,).

    axes, fine, turn, drift: as of `rows_kernel.rows`.
    """
    cuts, roots, arcs, points = np.empty((2, 8)), np.empty(8), np.empty(POINTS), np.empty((POINTS, 4))
    e = fine[E, 0]
    n = np.sqrt(abs(e))
    direction = -1.0 if drift < 0 else 1.0
    for row in open_rows:
        base, start = base_of(states[row], axes, fine), 0.0 * n
        energy = value(base[OVER])
        for again in range(2 if e > 0 else 1):
            if again:
                start = to_throat(base, n)
                if not abs(n * start) <= LONG_ARC:
                    break
                base = moved(base, -start, fine)
            count = points_along(rounded(base, e), turn, drift, again > 0, DOUBT, cuts, roots, arcs, points)
            if count < 0:
                continue
            results[row], settled[row] = nearest_margin(start, direction, turn, energy, base, count, points,
                                                        fine)
            if settled[row]:
                break
