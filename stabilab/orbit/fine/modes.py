"""Second divided differences of the potential about an equilibrium, as a polynomial: those of a shallow well, whose modes nearly cancel."""
from __future__ import annotations

import numpy as np

from ..period.modes import Modes

TERMS = 30  # of the series of V from the second power on: within 1.5 of the equilibrium the next is 1e-18


class TaylorModes(Modes):
    """V[l, r, theta] = sum of c_k t^k, t = theta less the equilibrium. data: the c_k, then t of the left end; sizes: those of their terms."""

    @classmethod
    def between(cls, pot, anchor, left, right) -> TaylorModes:
        """Of intervals from `left` to `right` of equilibria, both (n,)."""
        v = pot.taylor(tuple(anchor), TERMS)
        return cls(np.array([*_collected(v, left, right), left]), np.array([*_collected(np.abs(v), np.abs(left), np.abs(right)), left]))

    def second_difference(self, rho, left, right):
        t = np.where(left < right, self.data[-1] + 2 * rho * left, self.data[-1] + 2 * rho - 2 * rho * right)
        return _horner(self.data[:-1], t)

    def terms(self, rho, left, right):
        return _horner(np.abs(self.sizes[:-1]), np.maximum(np.abs(self.data[-1]), np.abs(self.data[-1] + 2 * rho)))

    def rounding(self, rho, left, right):
        return self.terms(rho, left, right)

    def pair(self, rho, whole, share, narrow):
        low, high = (_horner(self.data[:-1], self.data[-1] + 2 * rho * s) for s in (share, 1 - share))
        return 0.5 * (low + high), 0.5 * (low - high)


class HeldModes(Modes):
    """Modes of an interval with what H is off at three places taken from it: they are known better there.

    held: (4, n) what is off at the left and at the right end, the factor of the parabola that vanishes at both, and H over a barrier inside
    (inf without one)."""

    def __init__(self, modes: Modes, held):
        super().__init__(modes.data, modes.sizes)
        self.modes, self.held = modes, held

    @property
    def least(self):
        """(n,) H over the barrier inside."""
        return self.held[3]

    def take(self, rows) -> HeldModes:
        return HeldModes(self.modes.take(rows), self.held[:, rows])

    def second_difference(self, rho, left, right):
        first, last, bent, _ = self.held
        return self.modes.second_difference(rho, left, right) + (first * right + last * left + bent * left * right)

    def terms(self, rho, left, right):
        return self.modes.rounding(rho, left, right)

    def rounding(self, rho, left, right):
        return self.modes.rounding(rho, left, right)

    def whole(self, rho):
        return self.modes.whole(rho)

    def pair(self, rho, whole, share, narrow):
        (even, odd), (first, last, bent, _) = self.modes.pair(rho, whole, share, narrow), self.held
        return even + (0.5 * (first + last) + share * (1 - share) * bent), odd + (0.5 - share) * (first - last)


def _collected(v, left, right):
    """c_k = sum over n of v_n h_(n - 2 - k)(l, r), h the complete homogeneous polynomials."""
    total, power, h = np.ones(len(left)), np.ones(len(left)), [np.ones(len(left))]
    for _ in range(1, len(v)):
        power = power * right
        total = total * left + power
        h.append(total)
    return [sum(v[k + m] * h[m] for m in range(len(v) - k)) for k in range(len(v))]


def _horner(coefficients, t):
    value = np.zeros(np.shape(t))
    for c in coefficients[::-1]:
        value = value * t + c
    return value
