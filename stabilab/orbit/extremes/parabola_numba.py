"""Extremes and periods of many orbits on parabolas by a compiled kernel: the door of numba.

What `parabola_kernel` leaves open goes the way of the arrays.
"""
from __future__ import annotations

from fractions import Fraction
from functools import lru_cache

import numpy as np

from ...numbers.numba_door import compiled, wanted
from ..landscape import Landscape
from . import parabola_kernel
from .parabola_kernel import BOX, PERIOD

# Loading numba and its cached code costs 1 to 2 s, compiling it once per machine some ten; NumPy takes some 5 us an orbit.
COLD, WARM = 1_000_000, 20_000
INLINED = {"exact_sum", "quartic", "cubic", "bend", "haze_of", "blur_of_force"}
NAMES = "p", "p0", "q", "q0", "kappa", "rho", "sigma", "m"


def by_kernel(land: Landscape, states, boxes, periods, fast=None):
    """Fill boxes (n, 3, 2) and periods (n,), each unless it is empty, for states (n, 3). Returns (n,) bits of what the kernel left open (1 box, 2 period),
    or None where it does not serve this scene or so few states. fast: as of `rows_numba.by_rows`."""
    if not wanted(len(states), fast, bool(kernel.cache_info().currsize), COLD, WARM) or not len(states) or not land.sense:
        return None
    asked = (BOX if len(boxes) else 0) | (PERIOD if len(periods) else 0)
    return run_kernel(kernel(), land, states, asked, boxes, periods)


@lru_cache(maxsize=1)
def kernel():
    """`parabola_kernel.orbits`, compiled."""
    return compiled(parabola_kernel, INLINED)["orbits"]


def run_kernel(orbits, land, states, wanted, boxes, periods):
    """Call `parabola_kernel.orbits`, compiled or plain; (n,) bits of what it left open."""
    r, left_open = land.reduction, np.zeros(len(states), np.uint8)
    shift = float(r.s)
    form = (*(float(getattr(r, name)) for name in NAMES), shift, float(r.s - Fraction(shift)))
    orbits(states, (r.j, r.k, r.axis), form, wanted, np.empty(3), np.empty(3), boxes, periods, left_open)
    return left_open
