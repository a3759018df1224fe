"""A motion that repeats, as polynomials in time over equal parts of its period: a state for some thirty multiplications."""
from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from .periodic import Motion
from .profile import TURN

PARTS = (48, 96, 192, 384)
DEGREE = 11
SETTLED = 2e-15  # last coefficients against the largest value: what rounding of the samples leaves of them
CHUNK = 1024


def tabulated(motion: Motion) -> Motion:
    """The motion from a table; itself where it does not repeat or turns too sharply for one (next to a separatrix)."""
    if not 0 < motion.period < math.inf:
        return motion
    nodes, fit, powers = _rule()
    for parts in PARTS:
        times = (np.arange(parts)[:, None] + 0.5 * (1 + nodes)) * (motion.period / parts)
        states, way = motion.follow(times.ravel())
        rows = fit @ np.column_stack([states, way]).reshape(parts, DEGREE + 1, 4)
        if (np.abs(rows[:, -2:]).max(axis=(0, 1)) <= SETTLED * np.abs(rows).max(axis=(0, 1))).all():
            return Tabulated(motion, powers @ rows, motion.evaluations + times.size)
    return motion


@lru_cache(maxsize=1)
def _rule():
    """(nodes in (-1, 1), matrix from values there to Chebyshev's coefficients, matrix from those to powers)."""
    cheb = np.polynomial.chebyshev
    nodes, powers = cheb.chebpts1(DEGREE + 1), np.zeros((DEGREE + 1, DEGREE + 1))
    for k in range(DEGREE + 1):
        powers[:k + 1, k] = cheb.cheb2poly(np.eye(DEGREE + 1)[k, :k + 1])
    return nodes, np.linalg.inv(cheb.chebvander(nodes, DEGREE)), powers


class Tabulated(Motion):
    """rows (parts, DEGREE + 1, 4): coefficients of the states and of the way of the coordinate."""

    def __init__(self, motion, rows, evaluations):
        self.period, self.sense, self.evaluations = motion.period, motion.sense, evaluations
        self.axis, self.spin = motion.axis, motion.spin
        self.parts, self.rows = len(rows), np.ascontiguousarray(rows.transpose(1, 2, 0))
        self._cells = [tuple(map(tuple, cell[:, :3].T.tolist())) for cell in rows]
        self._scale = self.parts / self.period

    def at(self, t):
        place = math.fmod(t, self.period) * self._scale
        if place < 0:
            place += self.parts
        n = int(place)
        x = 2 * (place - n) - 1
        return [a + x * (b + x * (c + x * (d + x * (e + x * (f + x * (g + x * (h + x * (i + x * (j + x * (k + x * m))))))))))
                for a, b, c, d, e, f, g, h, i, j, k, m in self._cells[n if n < self.parts else 0]]

    def states(self, times):
        return self._rows_at(np.asarray(times, float), 3).T

    def follow(self, times):
        out, turns = self._rows_at(times, 4), np.floor(times / self.period)
        return out[:3].T, out[3] + self.sense * TURN * turns

    def _rows_at(self, times, count):
        """The first so many rows (count, n) of the table at times."""
        table = np.ascontiguousarray(self.rows[:, :count])
        out, scale, parts = np.empty((count, len(times))), self._scale, self.parts
        for first in range(0, len(times), CHUNK):
            part = slice(first, first + CHUNK)
            place = np.fmod(times[part], self.period)
            place *= scale
            place += parts * (place < 0)
            n = np.minimum(place.astype(np.intp), parts - 1)
            x = 2 * (place - n) - 1
            total = np.take(table[-1], n, axis=1, mode="clip")
            buffer = np.empty_like(total)
            for row in table[-2::-1]:
                total *= x
                total += np.take(row, n, axis=1, mode="clip", out=buffer)
            out[:, part] = total
        return out
