"""Extremes and periods of bounded rows in twofold numbers, one row at a time: the door of numba.

It serves circles and hyperbolas with a torque whose equilibria lie on a conic that is no pair of lines. What it leaves open goes the way of the arrays.
"""
from __future__ import annotations

from fractions import Fraction
from functools import lru_cache, partial

import numpy as np

from ...numbers.numba_door import compiled, twins, wanted
from ..landscape import CENTRE, Landscape
from ..period.rules import FIRST_LEVEL, LAST_LEVEL, NODES, nodes_of
from . import rows_kernel
from .places import twofold_constant

# Else loops call instead of adding
INLINED = {"exact_sum", "exact_product", "add", "times", "scaled", "less", "value", "swing", "lag", "sinc_cos", "sinc_minus_cos", "sinhc_and_rest",
           "way_of_cosine", "converged", "horner", "rounding_of"}
# Loading the code from disk costs some 0.3 s of a processor, compiling it once per machine some ten for each geometry; arrays take 5 to 50 us a row.
COLD, WARM = 1_000_000, 100
STRAIGHT = 1e-6  # of the slopes, as in `conic`: a circle so small hardly sees the bend of its equilibria


def by_rows(land: Landscape, states, boxes, periods, fast=None):
    """Fill boxes (n, 3, 2) and periods (n,), each unless it is empty, of bounded states (n, 3).

    Returns (n,) bits of what is left open (1 box, 2 period), None where it does not serve this scene or so few states. fast: True, or None for "where
    it pays and numba is installed"; InputError where True finds no numba.
    """
    if land.base not in COMPILED:
        return None
    loaded = bool(COMPILED[land.base].cache_info().currsize)
    if not len(states) or not wanted(len(states), fast, loaded, COLD, WARM) or kernel_input(land) is None:
        return None
    asked = (rows_kernel.BOX if len(boxes) else 0) | (rows_kernel.PERIOD if len(periods) else 0)
    left_open = np.full(len(states), asked, np.uint8)
    settle_rows(kernel, land, states, boxes, periods, left_open)
    return left_open


@lru_cache(maxsize=64)
def kernel_input(land: Landscape):
    """(numbers of a landscape as `rows_kernel.rows` takes them, from the constants to the invariants of folds); None where it has no kernel."""
    conic = land.conic
    if conic is None or not land.sense or conic.lines or not conic.pieces:
        return None
    r, g, fine = land.reduction, land.reduction.constants, land.twofold  # type: ignore[attr-defined]  # of circles and hyperbolas
    slopes = float(np.hypot(conic.c, conic.d))
    thin = max(STRAIGHT * slopes / abs(conic.G), 1e-150) ** 2
    centre = CENTRE * (abs(conic.c) + abs(conic.d)) / abs(conic.G)
    beside = centre if conic.mu <= (abs(conic.c) + abs(conic.d)) * centre else 0.0
    kinetic = twofold_constant(r.exact_constants["n"] ** 2 / 2)
    parts = np.array([part for number in (*fine, kinetic) for part in (float(number.high), float(number.low))])
    shift = float(r.s)
    form = g["flip"] * g["rx"], g["rz"], g["flip"] / g["n"], shift, float(r.s - Fraction(shift)), thin
    pieces = np.array([(piece.sign, piece.inner, piece.outer, piece.rising, piece.barrier, *_between(conic, piece)) for piece in conic.pieces], float)
    numbers = tuple(map(float, (conic.c, conic.d, conic.G, conic.mu, conic.K, conic.shift, beside)))
    return parts, form, (r.j, r.k, r.axis), numbers, pieces, np.array(conic.fold_invariants + conic.tangents, float)


def _between(conic, piece):
    """The invariants between which a piece meets an orbit."""
    at = lambda size: float(conic.invariant(piece.sign * size))
    ends = at(piece.inner) if piece.inner else -conic.e * np.inf, at(piece.outer) if np.isfinite(piece.outer) else np.inf
    return ends if piece.rising else ends[::-1]


@lru_cache(maxsize=1)
def rules():
    """(shares of the trapezoidal nodes; distances of the double-exponential ones from the nearer end, negative where that is the inner one, their
    weights, and where levels begin)."""
    made = [nodes_of(level) for level in range(FIRST_LEVEL, LAST_LEVEL + 1)]
    near = np.concatenate([np.where(inner, -way, way) for way, _, inner in made])
    return NODES, near, np.concatenate([weight for _, weight, _ in made]), np.cumsum([0] + [len(way) for way, _, _ in made])


def _compiled(base: str):
    geometry = rows_kernel.GEOMETRIES[base]
    return compiled(rows_kernel, INLINED, geometry.__name__, **rows_kernel.functions_of(geometry))["rows"]


COMPILED = {base: lru_cache(maxsize=1)(partial(_compiled, base)) for base in rows_kernel.GEOMETRIES}


def kernel(base: str):
    """`rows_kernel.rows` on a geometry, named as landscapes name it, compiled."""
    return COMPILED[base]()


def one_by_one(land: Landscape, states, asked):
    """(boxes (n, 3, 2) or periods (n,), as asked; which of them are settled (n,)) of the few rows that arrays leave open, in plain Python: two milliseconds
    for a row of which balls take three to thirty."""
    none, left_open = np.empty(0), np.full(len(states), asked, np.uint8)
    values = np.empty((len(states), 3, 2) if asked == rows_kernel.BOX else len(states))
    if len(states) and kernel_input(land) is not None:
        with np.errstate(all="ignore"):
            settle_rows(plain, land, states, *((values, none) if asked == rows_kernel.BOX else (none, values)), left_open)
    return values, left_open == 0


@lru_cache(maxsize=2)
def plain(base: str):
    """The same in plain Python."""
    return twins(rows_kernel, lambda name, twin: twin, **rows_kernel.functions_of(rows_kernel.GEOMETRIES[base]))["rows"]


def settle_rows(way, land: Landscape, states, boxes, periods, left_open):
    """Fill boxes (n, 3, 2) and periods (n,), each unless it is empty, of the open ones of states (n, 3), and clear their bits in left_open (n,).

    way: `kernel` or `plain`.
    """
    asked = (rows_kernel.BOX if len(boxes) else 0) | (rows_kernel.PERIOD if len(periods) else 0)
    way(land.base)(states, np.nonzero(left_open)[0], *kernel_input(land), asked, rules(), boxes, periods, left_open)
