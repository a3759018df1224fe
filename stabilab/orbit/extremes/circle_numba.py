"""Extremes and periods of many orbits by a compiled kernel: the door of numba (the extra `fast`).

Scenes whose orbits run on circles have this kernel (`circle_kernel`), hyperbolas and parabolas their own; what a kernel
leaves open goes the way of rows in twofold numbers, and from there of the arrays.
"""
from __future__ import annotations

from functools import lru_cache

import numpy as np

from ...numbers.numba_door import compiled, wanted
from ..landscape import Landscape
from . import circle_kernel
from .circle_kernel import BOX, LANE_NODES, LINE, PERIOD

# Loading numba and its cached code costs 1 to 2 s, compiling it once per machine some ten; NumPy takes some 5 us an orbit.
COLD, WARM = 1_000_000, 20_000
INLINED = {"shifted", "sinc_cos", "sinc_minus_cos", "y_minus_sin", "angle_of", "contains", "divided_pair",
           "way_of_cosine", "converged"}  # else no loop vectorises
FOLD_GUARD = 1e-4  # this close to a fold, relative, Newton's plain steps are not trusted


def by_kernel(land: Landscape, states, boxes, periods, fast=None):
    """Fill boxes (n, 3, 2) and periods (n,), each unless it is empty, for states (n, 3). Returns (n,) bits of what the
    kernel left open (1 box, 2 period), or None where it does not serve this scene or so few states.

    fast: True, or None for "where it pays and numba is installed". InputError where True finds no numba.
    """
    if not wanted(len(states), fast, bool(kernel.cache_info().currsize), COLD, WARM) or not len(states) or kernel_input(land) is None:
        return None
    asked = (BOX if len(boxes) else 0) | (PERIOD if len(periods) else 0)
    return run_kernel(kernel(), land, states, asked, boxes, periods)


@lru_cache(maxsize=64)
def kernel_input(land: Landscape):
    """(numbers, axes, pieces, folds) of a landscape for the kernel; None where it has no kernel."""
    if land.turn == np.inf:
        return None
    conic, r, g = land.conic, land.reduction, land.reduction.constants
    pieces = [_open_piece(conic, piece) for piece in conic.pieces]
    if None in pieces or not (pieces or conic.lines):  # without equilibria there is nothing to compile
        return None
    pieces += [(LINE, side, line.x0, line.z0, line.dx, line.dz, 0.0, 0.0) for line in conic.lines for side in (-1.0, 1.0)]
    thin = 0.0
    if conic.pieces and conic.limit is not None:  # as Conic does where the conic is nearly a line
        thin = 1e-6 * float(np.hypot(conic.c, conic.d)) / abs(conic.G)
    numbers = tuple(float(v) for v in (conic.G, conic.c, conic.d, conic.mu, conic.K, conic.shift, g["rx"], g["sj"], g["rz"],
                                       g["sk"], g["n"], r.s, g["flip"], thin, *r.shift_remainders))
    return numbers, (r.j, r.k, r.axis), tuple(pieces), tuple(map(float, conic.fold_invariants + conic.tangents))


def _open_piece(conic, piece):
    """A row for the kernel's `meet`; None for a piece between two folds, or from end to end."""
    if (piece.inner > 0) == np.isfinite(piece.outer):
        return None
    fold = piece.inner or piece.outer
    least = float(conic.invariant(piece.sign * fold))
    if piece.inner:  # from Z's asymptote, t = h
        return (0.0, float(piece.sign), conic.shift, 1.0, conic.c, 1 / conic.G, least, fold * (1 + FOLD_GUARD))
    side = float(piece.sign * (1 if conic.K > 0 else -1))  # from X's, t = K/h
    return 1.0, side, conic.c, 1 / conic.G, conic.shift, 1.0, least, abs(conic.K) / (fold * (1 - FOLD_GUARD))


@lru_cache(maxsize=1)
def kernel():
    """`circle_kernel.orbits`, compiled."""
    return compiled(circle_kernel, INLINED)["orbits"]


def run_kernel(orbits, land, states, wanted, boxes, periods):
    """Call `circle_kernel.orbits`, compiled or plain; (n,) bits of what it left open."""
    numbers, axes, pieces, folds = kernel_input(land)
    left_open = np.zeros(len(states), np.uint8)
    folds = np.array(folds, float)  # numba compiles no loop over an empty tuple: a scene without folds
    orbits(states, numbers, axes, pieces, folds, wanted, LANE_NODES, boxes, periods, left_open)
    return left_open
