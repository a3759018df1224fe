"""Sheets of the separatrix by compiled kernels: the door of numba (the extra `fast`) to `circle_kernel` and `within_kernel`.

In a given shape, on circles with a torque, the grading is that of `grid`, number by number, and points agree with those of the arrays to rounding. Within an
accuracy, on circles with a torque and on hyperbolas, each sheet is graded as `within` grades a sheet that is alone: the same rows and columns to rounding,
in a tenth to a twentieth of the time; rows whose orbits are centred far away are told as `far_centre` tells them.
"""
from __future__ import annotations

from functools import lru_cache
from threading import local

import numpy as np

from ....numbers.numba_door import compiled, compiled_together
from ...potential import Parabola
from .. import circle_kernel as circle_loops
from ..far_centre import FAR, asymptotes, saddles_of
from ..grid import DENSE, FLOOR, STRAIGHT, TRIAL, UNIFORM, shrinks
from ..saddles import OPEN
from . import far_kernel as far_loops
from . import hyperbola_kernel
from . import within_kernel as within_loops

GRADING = (FLOOR, STRAIGHT, UNIFORM, DENSE)
WITHIN = {"circle": (circle_loops, far_loops, within_loops), "hyperbola": (circle_loops, far_loops, within_loops, hyperbola_kernel)}
INLINED = {"force", "slope", "moved", "y_minus_sin", "rise", "risen", "xz", "place_of", "invariant", "far_series"}
EVEN = np.linspace(0, 1, TRIAL)
KEPT = 2**19  # numbers, 4 MB: a grid of 35,000 places
_THREAD = local()


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
    """(g, conic, sense, units) of a landscape for the kernels."""
    pot, conic, r = land.potential, land.conic, land.reduction
    c = r.constants
    g = (pot.G, pot.c, pot.d, pot.mu) if land.base == "circle" else (pot.G, pot.e1, pot.e2, pot.mu)
    units = tuple(float(v) for v in (c["flip"] * c["rx"], c["sj"], c["rz"], c["sk"], c["flip"] / c["n"], r.s))
    return (tuple(map(float, g)), tuple(float(v) for v in (conic.G, conic.c, conic.K, conic.shift)), int(land.sense), (*units, r.j, r.k, r.axis))


def sheets_by_kernel(land, strips, shape, names=None):
    """(points (k, n, m, 3) all round, residual (k, n, m), saddle and centre places (k, n, 2) each, found (k, n), cut, error (k,))
    of strips, pairs (branch, side), in the shape (rows, columns of a half). names: of the functions, compiled or plain."""
    names = names or kernel()
    scene = kernel_input(land)
    k = len(strips)
    where, sides = np.array([_line(branch) for branch, _ in strips]), np.array([float(side) for _, side in strips])
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


def serves_within(land) -> bool:
    """Whether the kernel draws a landscape's sheets within an accuracy: without a torque loops on circles run from saddle to saddle."""
    return land.sense != 0 or land.turn == np.inf


@lru_cache(maxsize=64)
def far_input(land):
    """What `far_kernel` takes of a landscape."""
    r, c, found = Parabola(land.reduction), land.reduction.constants, asymptotes(land)
    first, second, product = found or (0.0, 0.0, 0.0)
    near = land.reduction.parabolic_shift_size / FAR if found else -1.0
    return tuple(map(float, (r.p, r.q, r.p0, r.q0, r.kappa, r.rho, r.sigma, r.m, first, second, product, c["rz"], near, 2 * (abs(first) + abs(second)),
                             c["n"], c["flip"])))


@lru_cache(maxsize=2)
def kernel_within(base):
    """The compiled names of `within_kernel` on circles or hyperbolas."""
    return compiled_together(WITHIN[base], INLINED, base)


def sheet_by_kernel(land, part, rows, accuracy, names=None):
    """(points (n, 2 m - 1, 3), residual (n, 2 m - 1), equilibria (2, n, 3), saddles and centres, invariants (n,), found (n,), cut, how far facets stray) of
    a part of a sheet, from its trial rows on. names: of the functions, compiled or plain."""
    names = names or kernel_within(land.base)
    cut_off = part.seam <= 0 and part.branch.far == OPEN
    numbers = np.array((part.side, part.low, part.high, part.seam, part.over, cut_off), float)
    return names["sheet"](*kernel_input(land), far_input(land), np.array(_line(part.branch)), numbers, rows, EVEN, float(accuracy), _kept_room())


def _kept_room():
    """Room for the grids of a sheet, kept for the next one of the same thread: the system takes as long to give it as the kernel to fill it."""
    if not hasattr(_THREAD, "room"):
        _THREAD.room = np.empty(KEPT)
    return _THREAD.room


def _line(branch):
    """A branch as the kernels take it."""
    return (branch.start, branch.end, *((1.0, *branch.line) if branch.line else (0.0,) * 5))
