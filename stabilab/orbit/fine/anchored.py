"""The potential about an equilibrium whose slope of the force is known to all its digits: heights of a shallow well lose none.

From an equilibrium (X, Z) with F' = s, and S = sin y, h = sin(y/2) on a circle (e = -1), of sinh on a hyperbola (e = +1):
V(y) = -2 s h^2 - mu (y - S) - e (2 A S h^2 + 4 B h^4), A = G X Z, B = G (Z^2 + e X^2)/2. The terms of s, which nearly cancel, are summed before.
"""
from __future__ import annotations

import math

import numpy as np

from ...numbers.constants import EPS
from ..potential import y_minus_sin

ROUNDED = 8  # units of rounding of a height, by the size of its terms
LAG = 0.3  # below it y - sinh y is a series


class Anchored:
    """As a `potential` of anchors: tuples (X, Z, s, f, t) of equilibria, f and t what the force there and its slope s may be off by, or
    (X, Z, s, f, t, y) of places y away from these."""

    def __init__(self, reduction):
        g = reduction.constants
        self.e, self.G, self.mu = reduction.e, g["G"], g["mu"]

    def _swing(self, y):
        """(S, h)."""
        return (np.sin(y), np.sin(0.5 * y)) if self.e < 0 else (np.sinh(y), np.sinh(0.5 * y))

    def _lag(self, y, s):
        if self.e < 0:
            return y_minus_sin(y)
        t = y * y
        return np.where(np.abs(y) < LAG, -y * t / 6 * (1 + t / 20 * (1 + t / 42 * (1 + t / 72 * (1 + t / 110)))), y - s)

    def modes(self, x, z):
        """(A, B)."""
        return self.G * x * z, 0.5 * self.G * ((z - x) * (z + x) if self.e < 0 else z * z + x * x)

    def _terms(self, y, anchor):
        (s, h), (a, b) = self._swing(y), self.modes(*anchor[:2])
        h2 = h * h
        return -2 * anchor[2] * h2, -self.mu * self._lag(y, s), -self.e * 2 * a * s * h2, -self.e * 4 * b * h2 * h2

    def rise(self, y, anchor, force=0.0):
        """V(y) - V(0)."""
        return sum(self._terms(y, anchor))

    def rounding(self, y, anchor):
        """Size of the error of `rise`: of its terms, which grow like an exponential of y, and of what the anchor is off by."""
        s, h = self._swing(y)
        return (ROUNDED + 2 * np.abs(y)) * EPS * sum(map(np.abs, self._terms(y, anchor))) + anchor[3] * np.abs(s) + 2 * anchor[4] * h * h

    def move(self, anchor, y):
        """The place y away."""
        return *anchor[:5], np.broadcast_to(y, np.shape(anchor[0]))

    def force(self, place):
        """F y away from an anchor; nothing at the anchor itself."""
        if len(place) < 6:
            return np.zeros(np.shape(place[0]))
        (s, h), (a, b) = self._swing(place[5]), self.modes(*place[:2])
        h2 = h * h
        return place[2] * s + self.e * h2 * (6 * a - 2 * self.mu + 4 * b * s) + 8 * a * h2 * h2

    def slope(self, anchor):
        """F' at an anchor."""
        return anchor[2]

    def taylor(self, anchor, count):
        """(count, n) coefficients of y^2, y^3, ... of V."""
        (a, b), s, out = self.modes(*anchor[:2]), anchor[2], []
        for n in range(2, count + 2):
            m, odd = divmod(n - 1, 2)
            grown = 4.0**m
            out.append(-(self.e**m) * (s + (2 * grown - 2) * b if odd else (grown - 1) * a - self.mu) / math.factorial(n))
        return np.array(out)
