"""Where the start of a motion lies on a separatrix as its rates change along a line, w0 + s e: all such s, by roots.

As in `wheel_roots`, with the scene as it is: at the start x, z and the rate about the torque's axis are linear in s, c and d are constant. So the rise of the
potential less the energy, f = R(y, s) - E(s), and the torque F(y, s) are quadratics in s whose coefficients are functions of y, regular on the whole
turn: f2 = -2 S w1 G (x1 + S w1) - E2, F2 = G X1 Z1, and so on. Where they share a root their resultant vanishes.
"""
from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any

from ...numbers.vectors import Number, Triple
from ...orbit.reduction import Reduction
from .wheel_roots import Pair, real_roots


class Ray:
    """The two quadratics along a line of starts; state: at s = 0, step: its change per unit of s, exact."""

    def __init__(self, reduction: Reduction, state: Sequence[Fraction], step: Sequence[Fraction]) -> None:
        g, j, k = reduction.exact_constants, reduction.j, reduction.k
        self.G, self.mu, self.c, self.d = g["G"], g["mu"], g["c"], g["d"]
        self.x = g["flip"] * (state[j] + g["sj"]) / g["rx"], g["flip"] * step[j] / g["rx"]
        self.z = (state[k] + g["sk"]) / g["rz"], step[k] / g["rz"]
        self.speed = g["n"] * (state[reduction.axis] + reduction.s), g["n"] * step[reduction.axis]
        v0, v1 = self.speed
        self.energy = v1 * v1 / 2, v0 * v1, v0 * v0 / 2

    def pair(self, ball: Callable[[Any], Any]) -> Pair:
        """The two quadratics with its numbers as balls."""
        numbers = tuple(map(ball, (self.G, self.mu, self.c, self.d, *self.x, *self.z, *self.energy)))
        return lambda h: quadratics(numbers, h)

    def unit(self, h: float) -> float:
        """What s is multiplied by in the unknown of the quadratics."""
        return 1.0

    def others(self) -> list[float]:
        """The s at which the start may be an equilibrium: no energy, or the torque is balanced, F(0, s) = 0."""
        (v0, v1), (x0, x1), (z0, z1), G, c, d = self.speed, self.x, self.z, self.G, self.c, self.d
        slope, level = G * (x0 * z1 + x1 * z0) + c * z1 + d * x1, self.mu + G * x0 * z0 + c * z0 + d * x0
        balance = G * x1 * z1, slope, level
        return [*([float(-v0 / v1)] if v1 else []), *real_roots([float(v) for v in balance])]


def quadratics(numbers: Sequence[Number], h: Number) -> tuple[Triple, Triple]:
    """((f2, f1, f0), (F2, F1, F0)) in s at half the turn h (a ball, or a series of balls)."""
    G, mu, c, d, x0, x1, z0, z1, e2, e1, e0 = numbers
    S, K = h.sin_cos()
    w0, w1, u0, u1 = z0 * K - x0 * S, z1 * K - x1 * S, x0 * K + z0 * S, x1 * K + z1 * S
    i0, i1 = G * (x0 + S * w0) + c, G * (x1 + S * w1)
    f = -2 * S * w1 * i1 - e2, -2 * S * (w0 * i1 + w1 * i0 + d * u1) - e1, -2 * S * (w0 * i0 + d * u0) - 2 * mu * h - e0
    sine, cosine = 2 * S * K, 1 - 2 * S * S
    X0, X1, Z0, Z1 = x0 * cosine + z0 * sine, x1 * cosine + z1 * sine, z0 * cosine - x0 * sine, z1 * cosine - x1 * sine
    return f, (G * X1 * Z1, G * (X0 * Z1 + X1 * Z0) + c * Z1 + d * X1, mu + G * X0 * Z0 + c * Z0 + d * X0)
