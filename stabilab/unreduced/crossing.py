"""When a motion enclosed in compiled steps (`enclosure`) first reaches a limit.

The steps of which Bernstein coefficients leave open whether the limit is reached are searched as pieces in
integers (`integrate.crossing`); the others surely stay below it. A polynomial on [0, 1] lies between the
least and the greatest of its Bernstein coefficients, which are positive sums of those of its powers, so that
one formed in doubles errs by less than BLUR of the sum of sizes."""
from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from functools import lru_cache
from typing import Any

import numpy as np

from ..integrate.crossing import Crossing, Search, Threshold
from ..numbers.polynomial import bernstein
from ..numbers.vectors import Exact3
from ..physics.own_unit import natural
from ..physics.scene import AnyScene
from . import enclosure_kernel
from .enclosure import Band, Course, allowed

LAST_TIME = 2.0**24  # natural units of time: beyond what any number of steps reaches
BLUR, PIECES = 2.0**-40, 8


def first_crossing(scene: AnyScene, state: Sequence[Any], thresholds: Sequence[Threshold],
                   unit: Fraction = Fraction(1), direction: Exact3 | None = None,
                   t_max: float | None = None, steps: int | None = None) -> Crossing:
    """The first time, in the scene's unit, at which one of the thresholds is reached; these are of rates over
    `unit`, a power of two.

    scene, state, direction: as of `enclosure.Course`. t_max: how far to look (None: as far as so many steps
    reach; these None: as many as take some seconds).
    """
    end = t_max if t_max is not None else LAST_TIME / natural(scene)[1]
    course, searches = Course(scene, state, end, direction=direction), [Search(item) for item in thresholds]
    steps = allowed() if steps is None else steps
    while course.status == enclosure_kernel.GOING and course.steps < steps:
        band = course.advance(end, steps - course.steps, band=True)
        if band is not None and _found(searches, band, unit):
            break
    return Crossing.of(searches, Fraction(course.t), course.status == enclosure_kernel.DONE, course.steps)


def _found(searches: Sequence[Search], band: Band, unit: Fraction) -> bool:
    """Whether one of the limits is surely reached in this band."""
    open_at = [_open(item.threshold, band, float(unit)) for item in searches]
    for i in range(len(band.radii)):
        piece = None
        for search, places in zip(searches, open_at):
            if places[i] or search.low is not None:
                piece = piece or band.piece(i, unit)
                if search.take(piece):
                    return True
    return False


def _open(threshold: Threshold, band: Band, unit: float) -> np.ndarray:
    """(n,) whether each step may reach it."""
    scale = np.array([unit] * 3 + [1.0] * (band.radii.shape[1] - 3))  # a direction has no unit
    result = np.zeros(len(band.radii), bool)
    near = np.flatnonzero(_near(threshold, band, scale))
    scaled = Band(band.times, band.polynomials[near] / scale[:, None], band.radii[near] / scale)
    if threshold.linear:
        rows, radii, _ = scaled.along(threshold.terms[0][1])
    else:
        rows, radii = scaled.form(threshold.terms)
    sign = -1.0 if threshold.falls else 1.0
    rows, largest = sign * rows, sign * float(threshold.limit)
    radii = radii + BLUR * np.abs(rows).sum(axis=1) + 2.0**-50 * abs(largest)
    # most steps are surely below at once, the others are divided
    open_at = np.flatnonzero((rows @ bernstein_of(rows.shape[1] - 1, 1).T).max(axis=1, initial=-math.inf)
                             + radii >= largest)
    values = rows[open_at] @ bernstein_of(rows.shape[1] - 1, PIECES).T
    result[near[open_at]] = values.max(axis=1, initial=-math.inf) + radii[open_at] >= largest
    return result


def _near(threshold: Threshold, band: Band, scale: np.ndarray) -> np.ndarray:
    """(n,) whether the sizes of a step's coefficients, of which sums are no less than any Bernstein
    coefficient, leave open that it reaches the limit."""
    if threshold.falls:
        return np.ones(len(band.radii), bool)
    sizes = (np.abs(band.polynomials).sum(axis=2) + band.radii) / scale
    reach = [(float(c), sizes[:, :len(a)] @ np.abs([float(v) for v in a])) for c, a in threshold.terms]
    bound = reach[0][1] if threshold.linear else sum(c * row * row for c, row in reach)
    return bound * (1 + 2.0**-20) >= float(threshold.limit)  # far more than all that is rounded here


@lru_cache(maxsize=4)
def bernstein_of(degree: int, pieces: int) -> np.ndarray:
    """(pieces (degree + 1), degree + 1): powers of x on [0, 1] to Bernstein coefficients on each of so many
    equal pieces; entries are not negative and at most 1."""
    rows = []
    for piece in range(pieces):
        shifted = np.array([[math.comb(k, m) * (piece / pieces) ** (k - m) / pieces**m if m <= k else 0.0
                             for k in range(degree + 1)] for m in range(degree + 1)])
        rows.append(bernstein(degree) @ shifted)
    return np.concatenate(rows)
