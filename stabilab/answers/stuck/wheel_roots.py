"""Where the start of a motion lies on a separatrix as the momentum s of a wheel across the torque's axis changes: all such s, by roots.

On a circle (torque on the major or minor axis, `orbit.reduction`) the motion is bounded exactly if the potential somewhere within one turn ahead
rises over the start by more than its energy, R(y, s) > E. The fate can change only where the highest barrier is as high as the energy:

    R(y, s) = E  and  dR/dy = -F(y, s) = 0   for a y in (0, 2 pi],   or, where E = 0, where the start itself is an equilibrium, F(0, s) = 0.

Shifts, c and d of the reduction are linear in s, so both are quadratics in s whose coefficients are functions of y. Their resultant in s is a
function of y alone; its zeros are isolated by balls of it and of its derivative: a cell of y is left out where they exclude a zero, holds
one where the derivative has a sign and Newton's step contracts, and is halved otherwise. With h = y/2, S = sin h, K = cos h, and at the start
w = Z K - X S, u = X K + Z S,

    R = -mu y - 2 S [w (G (X + S w) + c) + d u],

and the terms in s^2 of R and of F vanish at S = 0 like S^2 and S, because the rate at the start is linear in s. So sigma = S s is the
unknown: both quadratics are regular on the whole turn, and no zero stands for an infinite s.

A zero may be double. From rest, or from a spin about the torque's axis alone, R and F are even in s and share
two roots at once, s and -s; along a change of that spin alone F does not depend on s. A cell with such a zero is
halved until it is `NARROW`, and every real root of f there is a candidate: one too many changes no fate. Without
energy (no rate about the torque's axis) y = 0 is a zero for every s. There, and as near to it as `NARROW`, only
an equilibrium at the start itself changes the fate.
"""
from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any, Protocol, TypeAlias

from ...numbers.balls import working
from ...numbers.vectors import Number, Triple
from ...orbit.reduction import Reduction

BITS = 128
CELLS = 16  # the turn at first
ORDER = 12  # of Taylor's polynomial: the balls' overestimate is less by the cell's reach to this power
NARROW = 1e-13  # a cell of h as narrow holds a zero as far as anybody can see
MOST = 2_000  # cells that are looked at
Pair: TypeAlias = Callable[[Any], tuple[Triple, Triple]]  # half a turn h -> the two quadratics, highest coefficient first


class Line(Protocol):
    """Starts or scenes along a line, told by s."""

    def pair(self, ball: Callable[[Any], Any]) -> Pair: ...
    def unit(self, h: float) -> float: ...
    def others(self) -> list[float]: ...


class Circle:
    """The two quadratics along one line of wheel momenta: `at_0`, `at_1` are the reductions at s = 0 and 1; state: exact. Numbers are Fractions, linear ones
    pairs (at s = 0, change per unit of s)."""

    def __init__(self, at_0: Reduction, at_1: Reduction, state: Sequence[Fraction]) -> None:
        (g0, x0, z0), (g1, x1, z1) = _place(at_0, state), _place(at_1, state)
        self.G, self.mu = g0["G"], g0["mu"]
        self.c, self.d = ((g0[name], g1[name] - g0[name]) for name in "cd")
        self.x, self.z = (x0, x1 - x0), (z0, z1 - z0)
        speed = g0["n"] * (state[at_0.axis] + at_0.s)
        self.energy = speed * speed / 2

    def pair(self, ball: Callable[[Any], Any]) -> Pair:
        """The two quadratics with its numbers as balls."""
        numbers = tuple(map(ball, (self.G, self.mu, self.energy, *self.c, *self.d, *self.x, *self.z)))
        return lambda h: quadratics(numbers, h)

    def unit(self, h: float) -> float:
        """What s is multiplied by in the unknown of the quadratics."""
        return math.sin(h)

    def others(self) -> list[float]:
        """The s at which the torque is balanced at the start, F(0, s) = 0, if there is one."""
        (c0, c1), (d0, d1), (x0, x1), (z0, z1), G = self.c, self.d, self.x, self.z, self.G
        level = self.mu + G * x0 * z0 + c0 * z0 + d0 * x0
        slope = G * (x0 * z1 + x1 * z0) + c0 * z1 + c1 * z0 + d0 * x1 + d1 * x0
        return [float(-level / slope)] if slope else []


def _place(reduction: Reduction, state: Sequence[Fraction]) -> Triple:
    g = reduction.exact_constants
    return g, g["flip"] * (state[reduction.j] + g["sj"]) / g["rx"], (state[reduction.k] + g["sk"]) / g["rz"]


def quadratics(numbers: Sequence[Number], h: Number) -> tuple[Triple, Triple]:
    """((f2, f1, f0), (g2, g1, g0)) in sigma at half the turn h (a ball, or a series of balls): f = R - E and g = S F."""
    G, mu, E, c0, c1, d0, d1, x0, x1, z0, z1 = numbers
    S, K = h.sin_cos()
    w0, w1, u0, u1 = z0 * K - x0 * S, z1 * K - x1 * S, x0 * K + z0 * S, x1 * K + z1 * S
    i0, i1 = G * (x0 + S * w0) + c0, G * (x1 + S * w1) + c1
    bend = (x1 * (G * x1 + c1) - d1 * z1) - G * w1 * w1
    f = 2 * bend, -2 * (w0 * i1 + w1 * i0 + d0 * u1 + d1 * u0), -2 * S * (w0 * i0 + d0 * u0) - 2 * mu * h - E
    sine, cosine = 2 * S * K, 1 - 2 * S * S
    X0, X1, Z0, Z1 = x0 * cosine + z0 * sine, x1 * cosine + z1 * sine, z0 * cosine - x0 * sine, z1 * cosine - x1 * sine
    F0, F1 = mu + G * X0 * Z0 + c0 * Z0 + d0 * X0, G * (X0 * Z1 + X1 * Z0) + c0 * Z1 + c1 * Z0 + d0 * X1 + d1 * X0
    return f, (-2 * (K * bend + S * (G * w1 * u1)), F1, S * F0)


def resultant(f: Sequence[Number], g: Sequence[Number]) -> Number:
    """Of two quadratics (highest coefficient first): zero where they share a root."""
    (f2, f1, f0), (g2, g1, g0) = f, g
    cross = f2 * g0 - g2 * f0
    return cross * cross - (f2 * g1 - g2 * f1) * (f1 * g0 - g1 * f0)


def candidates(line: Line) -> list[float] | None:
    """Every s at which the start may lie on a separatrix, ascending, in doubles; None where `MOST` cells do not tell."""
    with working(BITS, ORDER + 1) as numbers:
        pair = line.pair(numbers.ball)
        kept = _isolated(pair)
        found = None if kept is None else [s for h in kept for s in _roots_at(pair, h, line.unit(h))]
    return None if found is None else sorted([*found, *line.others()])


def _isolated(pair: Pair) -> list[float] | None:
    """The h in [0, pi] at which the resultant may vanish."""
    step = math.pi * (1 + 1e-15) / CELLS
    cells = [(n * step, (n + 1) * step) for n in range(CELLS)]
    found: list[float] = []
    for _ in range(MOST):
        if not cells:
            return found
        low, high = cells.pop()
        left = _narrowed(pair, low, high)
        if left is None:
            continue
        if left[1] - left[0] < NARROW:
            found.append((left[0] + left[1]) / 2)
        elif left[1] - left[0] < 0.5 * (high - low):
            cells.append(left)
        else:
            middle = (left[0] + left[1]) / 2
            cells += [(left[0], middle), (middle, left[1])]
    return None


def expansion(pair: Pair, middle: Number, half: Number) -> list[Number]:
    """Coefficients of the resultant in the distance from the middle of a cell of h: Taylor's at the middle, and in front of the power `ORDER` a ball that holds
    the rest over the whole cell. The balls of a whole cell alone do not see what cancels, which is nearly all where two moments are nearly equal."""
    from flint import arb, arb_series
    rest = resultant(*pair(arb_series([arb(middle, half), 1], ORDER + 1)))
    here = resultant(*pair(arb_series([arb(middle), 1], ORDER)))
    return [*(here[n] for n in range(ORDER)), rest[ORDER]]


def _narrowed(pair: Pair, low: Number, high: Number) -> tuple[Number, Number] | None:
    """The part of a cell of h that may hold a zero; None where it holds none."""
    from flint import arb
    middle, half = (low + high) / 2, (high - low) / 2 * (1 + 1e-12)
    value, slope, *bend = expansion(pair, middle, half)
    reach, about = arb(half), lambda size: arb(0, size.abs_upper())
    if 0 not in value + about(sum((abs(c) * reach**n for n, c in enumerate((slope, *bend), 1)), arb(0))):
        return None
    slope += about(sum((n * abs(c) * reach**(n - 1) for n, c in enumerate(bend, 2)), arb(0)))
    if 0 in slope:
        return low, high
    step = value / slope  # Newton's: the zero is within middle - step
    least, most = middle - float((step.mid() + step.rad()).upper()), middle - float((step.mid() - step.rad()).lower())
    low, high = max(low, least - 1e-15), min(high, most + 1e-15)
    return (low, high) if low <= high else None


def _roots_at(pair: Pair, h: float, unit: float) -> list[float]:
    """The s at which the start may lie on a separatrix with a zero at h: real roots of f, one or both shared by g."""
    from flint import arb
    if h < NARROW or not unit:
        return []
    return [s / unit for s in real_roots([float(v.mid()) for v in pair(arb(h))[0]])]


def real_roots(quadratic: Sequence[float]) -> list[float]:
    """Its finite real roots (highest coefficient first), a double one twice, also where rounding hides it."""
    a, b, c = quadratic
    q = -0.5 * (b + math.copysign(math.sqrt(max(b * b - 4 * a * c, 0.0)), b))
    return [s for top, bottom in ((q, a), (c, q)) if bottom for s in [top / bottom] if math.isfinite(s)]
