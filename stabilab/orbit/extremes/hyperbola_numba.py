"""Extremes and periods of many orbits on hyperbolas by a compiled kernel: the door of numba (the extra `fast`), and the table that the kernel reads.

What `hyperbola_kernel` leaves open goes to the rows in twofold numbers (`fine.rows_numba`), and from there the way of the arrays.
"""
from __future__ import annotations

from functools import lru_cache
from math import frexp

import numpy as np

from ...numbers.numba_door import compiled, wanted
from ..fine.places import twofold_constant
from ..fine.rows_numba import kernel_input as rows_input
from ..landscape import Landscape
from . import hyperbola_kernel
from .circle_kernel import LANE_NODES
from .circle_numba import COLD, WARM
from .hyperbola_kernel import BOX, CELLS, COLUMNS, OCTAVES, PERIOD

INLINED = {"exact_sum", "exact_product", "add", "times", "logarithm", "log_of", "grown", "sinh_lag", "rise", "kinetic", "converged"}  # else no loop vectorises
GRADED, FINEST = 4, 36  # knots an octave of the distance from a fold, octaves below an eighth of its invariant
BESIDE = 2.0**-40  # relative: a cell of the table that comes as near to a fold has none


def by_kernel(land: Landscape, states, boxes, periods, fast=None):
    """As `circle_numba.by_kernel`."""
    if not wanted(len(states), fast, bool(kernel.cache_info().currsize), COLD, WARM) or not len(states) or kernel_input(land) is None:
        return None
    asked = (BOX if len(boxes) else 0) | (PERIOD if len(periods) else 0)
    return run_kernel(kernel(), land, states, asked, boxes, periods)


@lru_cache(maxsize=16)
def kernel_input(land: Landscape):
    """What `hyperbola_kernel.orbits` takes of a landscape, but for the states; None where it has no kernel."""
    rows = rows_input(land) if land.base == "hyperbola" else None
    if rows is None:
        return None
    fine, form, axes, numbers, _, folds = rows
    g = land.reduction.exact_constants
    numbers = *numbers, float((g["c"] + g["d"]) / 2), float((g["d"] - g["c"]) / 2), float(g["G"] / 8)
    exact = map(twofold_constant, (g["mu"], (g["c"] + g["d"]) / 2, (g["d"] - g["c"]) / 2, g["G"] / 4))
    twofold = tuple(float(part) for number in exact for part in (number.high, number.low))
    return fine, form, axes, numbers, twofold, *_table(land.conic, folds)


def _table(conic, folds):
    """(cells (4, n, COLUMNS), bits of the first, graded knots (2, m) of |Q| beside folds, their cells (4, m - 1, COLUMNS)); of each branch, whose number is
    the sum of 2 where xi > 0 and 1 where eta > 0."""
    scale = max(abs(conic.c / conic.G), abs(conic.shift), abs(conic.K / conic.G) ** 0.5, 1e-100) ** 2
    first = min(max(frexp(scale)[1] - OCTAVES // 2 + 1023, 1), 2046 - OCTAVES) * CELLS
    even = (np.arange(first, first + CELLS * OCTAVES + 1, dtype=np.int64) << 48).view(np.float64)
    edges = [np.array([abs(fold) for fold in folds if fold * sign > 0]) for sign in (1, -1)]
    ways = 2.0 ** (np.arange(-FINEST * GRADED, 1) / GRADED - 3)
    graded = [np.unique(np.concatenate([edge * (1 + np.concatenate([-ways, ways])) for edge in found] or [np.array([1.0, 2.0])])) for found in edges]
    knots = np.full((2, max(map(len, graded))), np.inf)
    for n, some in enumerate(graded):
        knots[n, :len(some)] = some
    cells, beside = np.zeros((4, len(even) - 1, COLUMNS)), np.zeros((4, knots.shape[1] - 1, COLUMNS))
    with np.errstate(all="ignore"):
        for n, sign in enumerate((1, -1)):
            fill(conic, sign, even, edges[n], cells)
            fill(conic, sign, graded[n], edges[n], beside)
    return cells, first, knots, beside


def fill(conic, sign, knots, edges, cells):
    """Of the branches with Q = -xi eta of this sign, each interval between knots of |Q|: the number of equilibria (0 where it is not the same all over it, or
    not 1 or 3), |xi| at the left well, the barrier and the right well where it begins, and what these change by."""
    found = conic.critical_places(sign * knots)
    size, barrier = np.full((2, len(found), len(knots)), np.inf), np.zeros((len(found), 1), bool)
    for n, (x, z, exists, high) in enumerate(found):
        xi, eta = x + z, x - z
        xi = np.where(np.abs(xi) >= np.abs(eta), xi, -sign * knots / eta)
        barrier[n] = high
        for side in range(2):
            size[side, n] = np.where(exists & ((xi > 0) == (side > 0)) & (xi != 0), np.abs(xi), np.inf)
    clear = np.ones(len(knots) - 1, bool)
    for edge in edges:
        clear &= (knots[1:] < edge * (1 - BESIDE)) | (knots[:-1] > edge * (1 + BESIDE))
    for side in range(2):
        wells, tops = (np.sort(np.where(kind, size[side], np.inf), axis=0) for kind in (~barrier, barrier))
        lows, highs = np.isfinite(wells).sum(axis=0), np.isfinite(tops).sum(axis=0)
        three = (lows == 2) & (highs == 1)
        kind = np.where((lows == 1) & (highs == 0), 1.0, np.where(three, 3.0, 0.0))
        places = np.array([wells[0], np.where(three, tops[0] if len(tops) else 0.0, wells[0]), np.where(three, wells[min(1, len(wells) - 1)], wells[0])])
        good = (kind[1:] == kind[:-1]) & (kind[1:] > 0) & clear
        one = cells[2 * side + (1 - side if sign > 0 else side)]
        one[:len(good)][good, 0], one[:len(good)][good, 1:4] = kind[:-1][good], places[:, :-1].T[good]
        one[:len(good)][good, 4:7] = (places[:, 1:] - places[:, :-1]).T[good]


@lru_cache(maxsize=1)
def kernel():
    """`hyperbola_kernel.orbits`, compiled."""
    return compiled(hyperbola_kernel, INLINED)["orbits"]


def run_kernel(orbits, land, states, asked, boxes, periods):
    """Call `hyperbola_kernel.orbits`, compiled or plain; (n,) bits of what it left open."""
    left_open = np.zeros(len(states), np.uint8)
    orbits(states, *kernel_input(land), asked, LANE_NODES, boxes, periods, left_open)
    return left_open
