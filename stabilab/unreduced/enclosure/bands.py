"""What the bands of validated steps say: when a rate, or a sum of squares of rates, first reaches a limit,
and bounds of the rates over a whole span.

A polynomial on [0, 1] lies between the least and the greatest of its Bernstein coefficients, which are
positive sums of those of its powers.

First crossing. During each step the quantity lies within a radius of a polynomial, and so within that of
Bernstein coefficients. A step that stays below the limit is passed; the first that may reach it is halved,
left half first, until a piece too short to halve cannot be told from one that reaches it: there the time
begins. It ends at the first of some points beyond at which the limit is surely reached. Halving takes means
of coefficients (de Casteljau), so what rounding adds in all is less than HALVINGS (2 N + 1) 2^-53 < 2^-40 of
the greatest of them.

Ranges. Each step is cut into PIECES of equal length; a coefficient formed in doubles errs by less than 2^-44
of the sum of sizes.
"""
from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ...errors import InputError
from ...numbers.roots import bernstein, bernstein_halves
from ..spin_up.certificate import natural
from . import kernel
from .run import WHY, Band, Course, allowed

HALVINGS = 40  # of a step
FAR = 2.0**24  # natural units of time: beyond what any number of steps reaches
BLUR = 2.0**-40
ROOT = 2.0**-50  # of the limit's square: the limit may itself be a rounded root
PIECES = 8
POINTS = 16  # of a step beyond the one in which the limit may first be reached


@dataclass(frozen=True)
class Crossing:
    """low, high: between these times, in the scene's unit, the limit is first reached; high is inf where that
    was not seen, and surely it is not reached before low.

    because: what ended the search. steps: validated ones.
    """

    low: float
    high: float
    because: str
    steps: int


def first_crossing(scene, state, limit: float, weights=(1.0, 1.0, 1.0), t_max: float | None = None,
                   steps: int | None = None) -> Crossing:
    """The first time at which the root of the sum of weights_i omega_i^2 (of ones: |omega|) reaches `limit`.

    scene, state: as of `run.Course`. t_max: how far to look (None: as far as so many steps reach; these None:
    as many as take some seconds). Raises InputError for a limit that is not above 0.
    """
    if not (isinstance(limit, (int, float)) and 0 < limit < math.inf):
        raise InputError(f"limit: expected a number above 0, got {limit!r:.80}")
    end = t_max if t_max is not None else FAR / natural(scene)[1]
    course, search = Course(scene, state, end), _Search(float(limit) ** 2, weights)
    steps = allowed() if steps is None else steps
    while course.status == kernel.GOING and course.steps < steps:
        band = course.advance(end, steps - course.steps, band=True)
        if band is not None and search.found_in(band):
            return Crossing(search.low, search.high, "it is reached between these times", course.steps)
    words = ("it stays below" if search.low is None
             else "it comes nearer than is known, and is not surely reached")
    ended = "" if course.status == kernel.DONE else f" ({WHY[course.status]})"
    return Crossing(course.t if search.low is None else search.low, math.inf,
                    f"{words} up to t = {course.t:.6g}{ended}", course.steps)


class _Search:
    """Looks for the first time in bands one after another."""

    def __init__(self, level, weights):
        self.below, self.above, self.weights = level * (1 - ROOT), level * (1 + ROOT), weights
        self.low = self.high = None

    def found_in(self, band) -> bool:
        """Whether the limit is surely reached in this band, or was before."""
        rows, radii = band.form(self.weights)
        values = rows @ bernstein(rows.shape[1] - 1).T
        radii = radii + BLUR * np.abs(rows).sum(axis=1)
        for i in np.flatnonzero((values.max(axis=1) + radii >= self.below) | (self.low is not None)):
            begin, end = band.times[i:i + 2].tolist()
            points = np.arange(1, POINTS + 1) / POINTS
            if self.low is None:
                x = _first_open(values[i], radii[i] - self.below, 0.0, 1.0)
                if x is None:
                    continue
                self.low = max(0.0, _at(begin, end, x) * (1 - 2.0**-50))
                points = np.minimum(x + 2.0 ** np.arange(-HALVINGS, 1.0), 1.0)
            reached = np.flatnonzero(np.polynomial.polynomial.polyval(points, rows[i])
                                     - radii[i] >= self.above)
            if reached.size:
                self.high = _at(begin, end, float(points[reached[0]])) * (1 + 2.0**-50)
                return True
        return False


def _at(begin, end, x):
    return begin + x * (end - begin)


def _first_open(values, over, a, b):
    """Where the first piece of [a, b] begins that is too short to halve and has a coefficient above -over;
    None where there is none."""
    if values.max() + over < 0:
        return None
    if b - a <= 2.0**-HALVINGS:
        return a
    (left, right), middle = bernstein_halves(values), (a + b) / 2
    found = _first_open(left, over, a, middle)
    return _first_open(right, over, middle, b) if found is None else found


@lru_cache(maxsize=1)
def _to_bernstein():
    """(PIECES (N + 1), N + 1): powers of x on [0, 1] to Bernstein coefficients on each piece; entries are not
    negative and at most 1."""
    n = kernel.ORDER
    rows = []
    for piece in range(PIECES):
        shifted = np.array([[math.comb(k, m) * (piece / PIECES) ** (k - m) / PIECES**m if m <= k else 0.0
                             for k in range(n + 1)] for m in range(n + 1)])
        rows.append(bernstein(n) @ shifted)
    return np.concatenate(rows)


def ranges(band: Band) -> np.ndarray:
    """(3, 2) least and greatest that each rate may have during the steps of a band."""
    values = band.polynomials @ _to_bernstein().T
    blur = (band.radii + 2.0**-44 * np.abs(band.polynomials).sum(axis=2)) * (1 + 2.0**-30)
    return np.stack([(values.min(axis=2) - blur).min(axis=0), (values.max(axis=2) + blur).max(axis=0)],
                    axis=1)


def ranges_until(scene, state, t: float, steps: int | None = None) -> np.ndarray | None:
    """(3, 2) bounds of each rate over [0, t]; None where the steps do not reach. Arguments as of
    `run.Course`."""
    course, out = Course(scene, state, t), np.array([[math.inf, -math.inf]] * 3)
    steps = allowed() if steps is None else steps
    while course.status == kernel.GOING and course.steps < steps:
        band = course.advance(t, steps - course.steps, band=True)
        if band is not None:
            found = ranges(band)
            out = np.stack([np.minimum(out[:, 0], found[:, 0]), np.maximum(out[:, 1], found[:, 1])], axis=1)
    return out if course.status == kernel.DONE else None
