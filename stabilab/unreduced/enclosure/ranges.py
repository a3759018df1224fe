"""Bounds of the rates over a whole span: what the bands of the steps cannot leave.

A polynomial on [0, 1] lies between the least and the greatest of its Bernstein coefficients, which are positive sums of those of its powers. Each
step is cut into PIECES of equal length; a coefficient formed in doubles errs by less than 2^-44 of the sum of sizes.
"""
from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from . import kernel
from .run import Band, Course, allowed

PIECES = 8


@lru_cache(maxsize=1)
def _to_bernstein():
    """(PIECES (N + 1), N + 1): powers of x on [0, 1] to Bernstein coefficients on each piece; entries are not negative and at most 1."""
    n = kernel.ORDER
    bernstein = np.array([[math.comb(i, k) / math.comb(n, k) if k <= i else 0.0 for k in range(n + 1)] for i in range(n + 1)])
    rows = []
    for piece in range(PIECES):
        shifted = np.array([[math.comb(k, m) * (piece / PIECES) ** (k - m) / PIECES**m if m <= k else 0.0 for k in range(n + 1)] for m in range(n + 1)])
        rows.append(bernstein @ shifted)
    return np.concatenate(rows)


def ranges(band: Band) -> np.ndarray:
    """(3, 2) least and greatest that each rate may have during the steps of a band."""
    values = band.polynomials @ _to_bernstein().T
    blur = (band.radii + 2.0**-44 * np.abs(band.polynomials).sum(axis=2)) * (1 + 2.0**-30)
    return np.stack([(values.min(axis=2) - blur).min(axis=0), (values.max(axis=2) + blur).max(axis=0)], axis=1)


def ranges_until(scene, state, t: float, steps: int | None = None) -> np.ndarray | None:
    """(3, 2) bounds of each rate over [0, t]; None where the steps do not reach. Arguments as of `run.enclose`."""
    course, out = Course(scene, state, t), np.array([[math.inf, -math.inf]] * 3)
    steps = allowed(course.bits) if steps is None else steps
    while course.status == kernel.GOING and course.steps < steps:
        band = course.advance(t, steps - course.steps, band=True)
        if band is not None:
            found = ranges(band)
            out = np.stack([np.minimum(out[:, 0], found[:, 0]), np.maximum(out[:, 1], found[:, 1])], axis=1)
    return out if course.status == kernel.DONE else None
