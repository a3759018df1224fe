"""A symmetric body in a field, with an axis that stays at its lean: at which rates it precesses.

D_j = D_k = A, D_i = C; weight and wheels act along axis i, and e is that axis, from the fixed point to the
centre of mass (without a weight axis i itself). With u the cosine of the lean, between e and the upward
vertical -gamma, and the letters of `coefficients`,

    L = (C omega + Lambda) . e + E u,    V'(u) = |s| + N (C - A) u:

a wheel and a charge add to the momentum about the axis, a Newtonian centre below to the weight. By Lagrange's
equation of the lean (Landau & Lifshitz, Mechanics, section 35, there without wheel and field) at constant
lean and spin omega . e, which stays,

    A W^2 u - L W + V' = 0    where the axis precesses at the rate W about the upward vertical,

with real W where L^2 >= 4 A u V'. Upright (u = 1) and hanging (u = -1) the axis stays near the vertical where
L^2 > 4 A u V' (`equilibrium.field_balance`: Lagrange's cubic).

The momentum about the vertical is constant, too, G(u) = A (1 - u^2) W with G' = -L(u), so that the lean moves
in U = G^2/(2 A (1 - u^2)) + V with U' = A W^2 u - L W + V' and, where that is zero,

    U'' = (2 A u W - L)^2/(A (1 - u^2)) + A W^2 - E W + N (C - A).

The lean stays near it where U'' > 0, at whatever small change of the constants, and a small nutation then
has the rate ((1 - u^2) U''/A)^(1/2); it leaves where U'' < 0. Without field and charge U'' > 0 always."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import acos, degrees, sqrt
from typing import NamedTuple

from ..errors import InputError
from ..numbers.exact import sqrt_fraction
from ..numbers.vectors import CYCLE, Exact3, dot
from .coefficients import content
from .scene import AnyScene

# of a cosine: nearer to zero the axis is level, as far as its angle is written
LEVEL = Fraction(1, 1 << 120)
# of a cosine: nearer to one the axis is on the vertical, as far as doubles distinguish it
UPRIGHT = Fraction(1, 1 << 50)
# of the terms of U'': where their sum is smaller, its sign is not known
CANCELLED = Fraction(1, 1 << 100)
SLOW, FAST = "slow", "fast"


class Precession(NamedTuple):
    """Steady precessions at one lean. rates: rad/s about the upward vertical, the slow one first; one where
    the axis is level or both are the same; none where no real root is. spins: (highest below, lowest above)
    from which on there are some, rad/s about the axis; None where there are at every spin."""

    rates: tuple[Fraction, ...]
    spins: tuple[Fraction, Fraction] | None


class TopRates(NamedTuple):
    """Of a top at one state. spin: of the body about its axis, rad/s; lean: from the upward vertical, rad;
    steady, spins: the rates of steady precession at this lean, and the spins (at most, at least) that have
    some, as of `Precession`; stable: of each rate, whether the lean stays near, None where a term of higher
    order decides; nutation: of each, the rate of a small nutation about it, rad/s, None where it is not
    stable. upright, hanging: (lower, upper) spin between which the axis is unstable there, None where at
    none."""

    spin: float
    lean: float
    steady: tuple[float, ...]
    stable: tuple[bool | None, ...]
    nutation: tuple[float | None, ...]
    spins: tuple[float, float] | None
    upright: tuple[float, float] | None
    hanging: tuple[float, float] | None


@dataclass(frozen=True)
class SymmetricTop:
    """axis: 0 to 2; side: +1 or -1, of e along it; A, C, wheel: of L; weight, field: |s| and N (C - A);
    charge: E."""

    axis: int
    side: int
    A: Fraction
    C: Fraction
    wheel: Fraction
    weight: Fraction
    field: Fraction
    charge: Fraction

    @classmethod
    def of(cls, scene: AnyScene) -> SymmetricTop | None:
        """That of a scene; None where the body is not symmetric, or something else acts on it."""
        parts = content(scene)
        if parts is None or parts.kind != "directed" or any(parts.M) or parts.kappa:
            return None
        D, along = parts.D, [i for i, v in enumerate(parts.s) if v]
        if len(along) > 1:
            return None
        for i in along or (2, 0, 1):
            j, k = CYCLE[i]
            if D[j] == D[k] and not parts.Lambda[j] and not parts.Lambda[k] and (i == 2 or not parts.E):
                side = -1 if parts.s[i] < 0 else 1
                return cls(i, side, D[j], D[i], side * parts.Lambda[i], abs(parts.s[i]),
                           parts.N * (D[i] - D[j]), parts.E)
        return None

    @property
    def direction(self) -> Exact3:
        """e, along the principal axes."""
        return tuple(Fraction(self.side * (i == self.axis)) for i in range(3))

    def momentum(self, spin: Fraction, u: Fraction) -> Fraction:
        """L, N m s."""
        return self.C * spin + self.wheel + self.charge * u

    def pull(self, u: Fraction) -> Fraction:
        """V'(u), N m: downwards where it is positive."""
        return self.weight + self.field * u

    def seen(self, omega: Exact3, gamma: Exact3) -> tuple[Fraction, Fraction]:
        """(spin, u) of a state."""
        e = self.direction
        return dot(omega, e), -dot(gamma, e) / sqrt_fraction(dot(gamma, gamma))

    def precession(self, spin: Fraction, u: Fraction) -> Precession:
        """The steady precessions of a spin at a lean whose cosine is u."""
        L, pull = self.momentum(spin, u), self.pull(u)
        if abs(u) < LEVEL:
            return Precession((pull / L,) if L else (), None)
        fourth = 4 * self.A * u * pull
        spins = None
        if fourth > 0:
            bound, offset = sqrt_fraction(fourth), self.wheel + self.charge * u
            spins = (-bound - offset) / self.C, (bound - offset) / self.C
        if L * L < fourth:
            return Precession((), spins)
        root = sqrt_fraction(L * L - fourth)
        larger = L + root if L >= 0 else L - root  # without cancellation; L = 0: the first of two of one size
        if not larger:
            return Precession((Fraction(0),), spins)
        slow, fast = 2 * pull / larger, larger / (2 * self.A * u)
        return Precession((slow,) if not root else (slow, fast), spins)

    def bend(self, spin: Fraction, u: Fraction, W: Fraction) -> Fraction:
        """U'' at a steady precession off the vertical, N m: zero where its terms cancel."""
        turn = 2 * self.A * u * W - self.momentum(spin, u)
        terms = (turn * turn / (self.A * (1 - u * u)), self.A * W * W, -self.charge * W, self.field)
        total = sum(terms, Fraction(0))
        return total if abs(total) > CANCELLED * sum(map(abs, terms)) else Fraction(0)

    def critical(self, u: int) -> tuple[Fraction, Fraction] | None:
        """(lower, upper) spin, rad/s, between which the axis upright (u = 1) or hanging (-1) is unstable;
        None where it is at none."""
        return self.precession(Fraction(0), Fraction(u)).spins

    def at(self, omega: Exact3, gamma: Exact3) -> TopRates:
        """What is known of the spin and lean of a state."""
        spin, u = self.seen(omega, gamma)
        found = Precession((), None) if abs(u) > 1 - UPRIGHT else self.precession(spin, u)
        bends = [self.bend(spin, u, W) for W in found.rates]
        return TopRates(float(spin), acos(max(-1.0, min(1.0, float(u)))), tuple(map(float, found.rates)),
                        tuple(bend > 0 if bend else None for bend in bends),
                        tuple(sqrt((1 - u * u) * bend / self.A) if bend > 0 else None for bend in bends),
                        _floats(found.spins), _floats(self.critical(1)), _floats(self.critical(-1)))

    def leans(self, spin: Fraction) -> list[tuple[float, float]]:
        """The leans, deg, at which a spin has a steady precession, rising."""
        # L^2 - 4 A u V' = a u^2 + b u + c
        start = self.C * spin + self.wheel
        a = self.charge**2 - 4 * self.A * self.field
        b, c = 2 * start * self.charge - 4 * self.A * self.weight, start**2
        ends = sorted({-1.0, 1.0, *(u for u in _roots(float(a), float(b), float(c)) if -1 < u < 1)})
        allowed = [(low, high) for low, high in zip(ends, ends[1:])
                   if a * Fraction((low + high) / 2) ** 2 + b * Fraction((low + high) / 2) + c >= 0]
        return [(degrees(acos(high)), degrees(acos(low))) for low, high in reversed(allowed)]

    def start(self, spin: Fraction, cosine: Fraction, which: str, towards: Exact3) -> tuple[Exact3, Exact3]:
        """(omega, gamma) along the principal axes of the steady precession of a spin at a lean, whose axis
        leans towards a vector of any length. which: SLOW or FAST.

        Raises InputError where there is none, with the range that there is; its first word is the key at
        fault.
        """
        e, u = self.direction, cosine
        along = dot(towards, e)
        across = tuple(t - along * v for t, v in zip(towards, e))
        size = sqrt_fraction(dot(across, across))
        if not size:
            raise InputError("towards: it lies along the axis of the top; give a direction across it")
        rates, _ = self.precession(spin, u)
        if not rates:
            raise self._none(spin, u)
        if which == FAST and abs(u) < LEVEL:
            raise InputError('precession: a level axis has one rate of steady precession: give precession = '
                             '"slow"')
        W = rates[0] if which == SLOW else rates[-1]
        sine = sqrt_fraction(max(Fraction(0), 1 - u * u))
        b = tuple(v / size for v in across)
        return (tuple(spin * p - W * sine * q for p, q in zip(e, b)),
                tuple(sine * q - u * p for p, q in zip(e, b)))

    def _none(self, spin: Fraction, u: Fraction) -> InputError:
        leans = " or ".join(f"from {low:.6g} to {high:.6g} deg" for low, high in self.leans(spin))
        with_this = f"with this one at a lean {leans}" if leans else "with this one at no lean"
        spins = self.precession(spin, u).spins
        if spins is None:
            return InputError("spin: with this spin the momentum about the axis is zero, and a level axis "
                              "falls: give another spin or lean")
        low, high = map(float, spins)
        return InputError("spin: at this lean the top precesses steadily with a spin of at least "
                          f"{high:.10g} rad/s ({degrees(high):.10g} deg/s), or at most {low:.10g} rad/s "
                          f"({degrees(low):.10g} deg/s), and {with_this}")


def top_rates(scene: AnyScene, start: Sequence[float | Fraction]) -> TopRates | None:
    """What is known of the spin and lean of a scene at a start, which begins with omega and gamma; None where
    it is no symmetric top."""
    omega, gamma = (tuple(Fraction(v) for v in part) for part in (start[:3], start[3:6]))
    top = SymmetricTop.of(scene) if len(gamma) == 3 and any(gamma) else None
    return None if top is None else top.at(omega, gamma)


def _floats(ends: tuple[Fraction, Fraction] | None) -> tuple[float, float] | None:
    return None if ends is None else (float(ends[0]), float(ends[1]))


def _roots(a: float, b: float, c: float) -> list[float]:
    """The real roots of a x^2 + b x + c."""
    if not a:
        return [-c / b] if b else []
    inside = b * b - 4 * a * c
    if inside < 0:
        return []
    larger = -(b + (sqrt(inside) if b >= 0 else -sqrt(inside))) / 2
    return [larger / a, *([c / larger] if larger else [])]
