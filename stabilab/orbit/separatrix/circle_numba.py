"""Sheets of the separatrix on circles by a compiled kernel: the door of numba (the extra `fast`) to `circle_kernel`.

The grading is that of `grid`, number by number, and points agree with those of the arrays to rounding; an accuracy in place of a shape is left to
`within`, which knows better how far facets stray. It stays beside the arrays although these take some 5 ms a surface: a view that draws the surface
anew at every move of a hand has 16 ms a picture for everything, and this leaves it 15 of them.
"""
from __future__ import annotations

from functools import lru_cache

import numpy as np

from ...numbers.numba_door import compiled
from . import circle_kernel as circle_loops
from .far_centre import saddles_of
from .grid import DENSE, FLOOR, STRAIGHT, TRIAL, UNIFORM, shrinks

GRADING = (FLOOR, STRAIGHT, UNIFORM, DENSE)
EVEN = np.linspace(0, 1, TRIAL)


def serves(land, strips) -> bool:
    """Whether the kernel draws a landscape's sheets: circles with a torque, where each saddle has one loop, a point at the
    fold, and no centre is so far that `far_centre` tells them."""
    if len(land.conic.sides(land.sense)) > 1 or any(saddles_of(land, branch, np.zeros(1))[1][0] for branch, _ in strips):
        return False
    return all(shrinks(land, *strip) for strip in strips)


@lru_cache(maxsize=1)
def kernel():
    """The compiled names of `circle_loops`."""
    return compiled(circle_loops, {"force", "slope", "moved", "y_minus_sin", "rise", "stray"})


@lru_cache(maxsize=64)
def kernel_input(land):
    """(g, conic, sense, units) of a landscape for the kernel."""
    pot, conic, r = land.potential, land.conic, land.reduction
    c = r.constants
    units = tuple(float(v) for v in (c["flip"] * c["rx"], c["sj"], c["rz"], c["sk"], c["flip"] / c["n"], r.s))
    return (tuple(float(v) for v in (pot.G, pot.c, pot.d, pot.mu)),
            tuple(float(v) for v in (conic.G, conic.c, conic.K, conic.shift)), int(land.sense), (*units, r.j, r.k, r.axis))


def sheets_by_kernel(land, strips, shape, names=None):
    """(points (k, n, m, 3) all round, residual (k, n, m), saddle and centre places (k, n, 2) each, found (k, n), cut, error (k,))
    of strips, pairs (branch, side), in the shape (rows, columns of a half). names: of the functions, compiled or plain."""
    names = names or kernel()
    scene = kernel_input(land)
    k = len(strips)
    lines = [(branch.start, branch.end, *((1.0, *branch.line) if branch.line else (0.0,) * 5)) for branch, _ in strips]
    where, sides = np.array(lines), np.array([float(side) for _, side in strips])
    s, columns, rows = (np.empty((k, TRIAL)) for _ in range(3))
    names["trial"](*scene, where, sides, GRADING, s, columns, rows, _room(k))
    n, m = shape
    found, places, points = np.empty((k, n), np.bool_), np.empty((k, n, 5)), np.empty((k, n, 2 * m - 1, 3))
    residual, strays = np.empty((k, n, 2 * m - 1)), np.empty((2, k))
    names["finished"](*scene, where, sides, s, EVEN, columns, rows, np.empty(n), np.empty(m), found, places, points, residual,
                      strays, np.empty((m + 1, 5)))
    best = int(np.argmin(strays.max(axis=1)))
    return points, residual, places[..., :2], places[..., 2:4], found, (1, -1)[best], strays[best]


def _room(k):
    """Arrays for `circle_loops.trial`: columns, dense way, found, places, points, no residual, a row to spare, densities."""
    return (EVEN, np.empty(DENSE), np.empty((k, TRIAL), np.bool_), np.empty((TRIAL, 5)), np.empty((k, TRIAL, TRIAL, 3)),
            np.empty((TRIAL, 0)), np.empty((TRIAL + 1, 5)), np.empty((k, 2, TRIAL)))
