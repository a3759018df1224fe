"""All rotations of a free gyrostat at its angular momentum, in exact numbers: the critical points of the
energy on the sphere of the momentum, which of them losses inside attract to, and between which a motion goes.

H is the angular momentum in the body, lambda the gyrostatic moment, D the moments of the whole. With no part
moving relative to the body but the wheels, H = D omega + lambda, and the energy is

    E(H) = (H - lambda) . D^-1 (H - lambda)/2.

What turns inside adds to it: T >= E(H). On |H| = h a critical point has omega = D^-1 (H - lambda) = m H, so

    H_i = lambda_i/(1 - m D_i),    sum lambda_i^2/(1 - m D_i)^2 = h^2,

of degree 6 in m. A moment d whose axes carry no lambda gives, at m = 1/d, the others' H_i and, where these
leave some of h^2, two points, or a circle where two axes share d. As |H| is the same,

    E(H) - E(K) = (H - K) . A (H - K)/2,    A = D^-1 - m,    for every H and a critical point K.

So K is a minimum, a maximum or a saddle as A is across K. The sum f(m) is convex between its poles, so that
f'(m) = 0 is a fold of two rotations, where E has an inflection. Where m = 1/d without an own H_i the energy
along that axis begins with a fourth power, of the sign of f'.

Passes. Let D1 > D2 >= D3, K a critical point with 1/D1 < m <= 1/D2. Then A has one negative entry, that of
axis 1, and E(H) <= E(K) is a double cone (for m = 1/D2 two wedges) with its apex in K, of which one half has
H_1 > K_1 and one H_1 < K_1. Each half is convex, and a ray from K meets the sphere at most once more, so that
each meets it in one piece. So below E(K) the sphere falls into two parts, by the sign of
H_1 - K_1, and what has T <= E(K) stays in its own. For m <= 1/D1 A is not negative and K is the least; for
1/D2 < m < 1/D3 two entries are negative, and what is below E(K) is one piece, for what is above it, a double
cone as before, is two discs. So there are two minima where there is a pass, and one elsewhere.

All wheels s times as fast have sum s^2 lambda_i^2/(1 - m D_i)^2: a pass needs s^2 min f < h^2, the least over
1/D1 <= m <= 1/D2. Hence the speed from which on one minimum is left."""
from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import NamedTuple

from ..numbers.exact import floats, sign_of, sqrt_fraction
from ..numbers.polynomial import EPS, Poly, halved, real_roots
from ..numbers.vectors import Exact3, Float3, dot
from .stability import sign_at

BITS = 512  # of a root: some hundred digits of its H_i are left beside a moment without a wheel
MOST_BITS = 1 << 14
CLOSE = Fraction(1, 2**120)  # to which |H| of a rotation must be that of the sphere
ONE = Poly((1,))
STABLE, UNSTABLE = "stable", "unstable"
MINIMUM, MAXIMUM, SADDLE, INFLECTION = "minimum", "maximum", "saddle", "inflection"


@dataclass(frozen=True)
class Rotation:
    """A critical point of the energy on the sphere, a circle of them, or all of it.

    nature: "minimum", "maximum", "saddle" or "inflection" (a fold of two rotations). momentum, omega: along
    the principal axes, good to a hundred bits, exact where they are rational; of a circle one of its points.
    energy: J. multiplier: m of omega = m H, None where H = 0. axis: 1 to 3, about which a circle of them
    lies, else 0; everywhere: whether every point of the sphere is one. root: (P, m, bits) of an irrational
    one, as of `sign_at`; one_sided: of an inflection, whether it attracts on one side, where energy is lost.
    """

    nature: str
    momentum: Exact3
    omega: Exact3
    energy: Fraction
    multiplier: Fraction | None
    axis: int = 0
    everywhere: bool = False
    root: tuple[Poly, Fraction, int] | None = None
    one_sided: bool = False

    @property
    def with_losses(self) -> str:
        """Whether it is stable where something inside takes energy; of a circle, as a set."""
        return STABLE if self.nature == MINIMUM else UNSTABLE

    @property
    def without_losses(self) -> str:
        """Whether it is stable where nothing takes energy. The points of a circle are not: a little momentum
        along its axis turns the body round it."""
        return UNSTABLE if self.axis or self.nature in (SADDLE, INFLECTION) else STABLE


class Threshold(NamedTuple):
    """From which size of the gyrostatic moment on, its direction and |H| as they are, one minimum is left.

    factor: of the moment as it is; moment: N m s; omega: rad/s, of the rotation that is left, there."""

    factor: Fraction
    moment: Fraction
    omega: Float3


@dataclass(frozen=True)
class MomentumSphere:
    """D, wheel: principal moments of the whole and gyrostatic moment, exact; square: |H|^2."""

    D: Exact3
    wheel: Exact3
    square: Fraction

    @cached_property
    def weights(self) -> dict[Fraction, Fraction]:
        """Moment -> lambda^2 along its axes, the largest moment first."""
        return {d: sum((l * l for e, l in zip(self.D, self.wheel) if e == d), Fraction(0))
                for d in sorted(set(self.D), reverse=True)}

    @cached_property
    def active(self) -> dict[Fraction, Fraction]:
        """Those moments that carry some."""
        return {d: w for d, w in self.weights.items() if w}

    def energy(self, momentum: Sequence[Fraction]) -> Fraction:
        """E(H)."""
        return sum(((h - l) ** 2 / (2 * d) for h, l, d in zip(momentum, self.wheel, self.D)), Fraction(0))

    @cached_property
    def rotations(self) -> tuple[Rotation, ...]:
        """All of them, that of the least energy first."""
        if not self.square:
            return (self._at(MINIMUM, (Fraction(0),) * 3, None),)
        if not self.active and len(self.weights) == 1:
            h, zero = sqrt_fraction(self.square), Fraction(0)
            return (self._at(MINIMUM, (zero, zero, h), 1 / self.D[0], everywhere=True),)
        result = [*self._at_roots(), *(point for d in self.weights if d not in self.active
                                       for point in self._beside(d))]
        return tuple(sorted(result, key=lambda rotation: rotation.energy))

    def _at(self, nature: str, momentum: Exact3, multiplier: Fraction | None, axis: int = 0,
            everywhere: bool = False, root: tuple[Poly, Fraction, int] | None = None,
            one_sided: bool = False) -> Rotation:
        omega = (tuple((h - l) / d for h, l, d in zip(momentum, self.wheel, self.D))
                 if multiplier is None else tuple(multiplier * h for h in momentum))
        energy = sum((d * w * w for d, w in zip(self.D, omega)), Fraction(0)) / 2
        return Rotation(nature, momentum, omega, energy, multiplier, axis, everywhere, root, one_sided)

    # --- Where the multiplier is no 1/d of a moment without a wheel
    def _product(self, power: int, but: Fraction | None = None) -> Poly:
        """prod (1 - m d)^power of the moments with a wheel, but for one."""
        out = ONE
        for d in self.active:
            for _ in range(power if d != but else 0):
                out = out * Poly((1, -d))
        return out

    def _at_roots(self) -> list[Rotation]:
        if not self.active:
            return []
        P = self._product(2) * self.square
        for d, w in self.active.items():
            P = P - self._product(2, d) * w
        return [self._at_root(P, m, bits) for m, bits in self._precise(P)]

    def _precise(self, P: Poly) -> list[tuple[Fraction, int]]:
        """(root, its bits) of all real roots, each so precise that its |H| is that of the sphere."""
        bits = BITS
        while True:
            roots = real_roots(P, bits)
            sizes = [sum(h * h for h in self._momentum(m)) for m in roots]
            if all(abs(size - self.square) <= CLOSE * self.square for size in sizes) or bits >= MOST_BITS:
                return [(m, bits) for m in roots]
            bits *= 2

    def _momentum(self, m: Fraction) -> Exact3:
        return tuple(l / (1 - m * d) if l else Fraction(0) for l, d in zip(self.wheel, self.D))

    def _at_root(self, P: Poly, m: Fraction, bits: int) -> Rotation:
        sign = lambda R: sign_at(R, P, m, bits)
        across = {d: sign(Poly((1, -d))) for d in self.weights}  # the signs of A
        slope = ONE * 0
        for d, w in self.active.items():
            slope = slope + self._product(3, d) * (w * d)
        rising = sign(slope)
        for d in self.active:
            rising *= across[d]
        signs = [s for d, s in across.items() for _ in range(self.D.count(d) - (d in self.active))]
        flat = 0 in signs  # axes without a wheel along which the energy begins with a fourth power
        signs = [s or rising for s in signs]
        inner = 1
        for d in self.active:
            inner *= across[d]
        fold = False
        if len(self.active) == 2:
            fold = not rising
            signs += [] if fold else [inner * rising]
        elif len(self.active) == 3:
            trace = sign(self._trace())
            fold = not rising
            signs += [trace] if fold else [trace, trace * inner * rising]
        nature = _nature(signs, fold)
        exact = not P(m)
        return self._at(nature, self._momentum(m), m, root=None if exact else (P, m, bits),
                        one_sided=fold and all(s > 0 for s in signs if s) and not (flat and rising < 0))

    def _trace(self) -> Poly:
        """That of A across H, times |H|^2 and the squares of all 1 - m d: a polynomial in m."""
        full, out = self._product(2) * self.square, Poly(())
        for d, w in self.active.items():
            out = out + Poly((1 / d, -1)) * (full - self._product(2, d) * w)
        return out

    # --- Where it is
    def _beside(self, d: Fraction) -> list[Rotation]:
        """Those with H also along axes of a moment d that carry no wheel; none where nothing is left for
        them."""
        momentum = [l / (1 - e / d) if l else Fraction(0) for l, e in zip(self.wheel, self.D)]
        rest = self.square - sum(h * h for h in momentum)
        if rest <= 0:
            return []
        own = [i for i, e in enumerate(self.D) if e == d]
        nature = _nature([sign_of(d - e) for e in self.D if e != d], False)
        circle = 6 - sum(i + 1 for i in own) if len(own) == 2 else 0
        size, result = sqrt_fraction(rest, BITS), []
        for side in (1,) if circle else (1, -1):
            at = tuple(side * size if i == own[0] else h for i, h in enumerate(momentum))
            energy = self._at(nature, at, 1 / d, circle)
            # of rational H^2 the energy is rational
            exact = sum((e * (h * h if i != own[0] else rest) for i, (e, h) in enumerate(zip(self.D, at))),
                        Fraction(0)) / (2 * d * d)
            result.append(Rotation(nature, energy.momentum, energy.omega, exact, 1 / d, circle))
        return result

    # --- How a motion lies to them
    def above(self, energy: Fraction, rotation: Rotation) -> int:
        """The exact sign of an energy less that of a rotation."""
        if rotation.root is None:
            return sign_of(energy - rotation.energy)
        P, m, bits = rotation.root
        R = self._product(2) * (2 * energy)
        for d, w in self.active.items():
            R = R - Poly((0, 0, 1)) * self._product(2, d) * (w * d)
        return sign_at(R, P, m, bits)

    @property
    def top(self) -> int:
        """The axis of the largest moment, 0 to 2."""
        return max(range(3), key=lambda i: self.D[i])

    @cached_property
    def passes(self) -> tuple[Rotation, ...]:
        """The rotations over which motions go from one minimum to the other, of one energy: saddles, or a
        circle; empty where there is one minimum."""
        return tuple(rotation for rotation in self._between()
                     if rotation.nature == SADDLE or rotation.axis)

    @cached_property
    def trap(self) -> Rotation | None:
        """An inflection at which an open set of motions ends; None where there is none."""
        return next((rotation for rotation in self._between()
                     if rotation.nature == INFLECTION and rotation.one_sided), None)

    def _between(self) -> list[Rotation]:
        """Those with 1/D1 < m <= 1/D2, where one axis alone has the largest moment."""
        first, *others = sorted(self.D, reverse=True)
        if first == others[0] or not self.square:
            return []
        return [rotation for rotation in self.rotations
                if self._sign(rotation, Poly((1, -first))) < 0
                and self._sign(rotation, Poly((1, -others[0]))) >= 0]

    def _sign(self, rotation: Rotation, R: Poly) -> int:
        """The exact sign of a polynomial of the multiplier."""
        if rotation.root is None:
            return sign_of(R(rotation.multiplier)) if rotation.multiplier is not None else 0
        P, m, bits = rotation.root
        return sign_at(R, P, m, bits)

    def side(self, momentum: Sequence[Fraction], at: Rotation) -> int:
        """The exact sign of H_1 - K_1, K a rotation between two minima."""
        i = self.top
        if not self.wheel[i]:
            return sign_of(momentum[i])
        if at.root is None:
            return sign_of(momentum[i] - at.momentum[i])
        below = Poly((1, -self.D[i]))
        return self._sign(at, below * momentum[i] - self.wheel[i]) * self._sign(at, below)

    @cached_property
    def minima(self) -> tuple[Rotation, ...]:
        """Where motions end that lose energy; of two, that with the greater H_1 first."""
        least = [rotation for rotation in self.rotations if rotation.nature == MINIMUM]
        return tuple(sorted(least, key=lambda rotation: -rotation.momentum[self.top]))

    # --- From which size of the gyrostatic moment on there is one
    @cached_property
    def threshold(self) -> Threshold | None:
        """None without a wheel, and at |H| = 0."""
        if not self.active or not self.square:
            return None
        least = self._least()
        factor = Fraction(0) if least is None else sqrt_fraction(self.square / least)
        size = sqrt_fraction(dot(self.wheel, self.wheel))
        return Threshold(factor, factor * size, self._left(factor))

    def _left(self, factor: Fraction) -> Float3:
        """omega of the rotation of least energy with the wheels so much faster, where one minimum is left."""
        D, h = floats(self.D), float(sqrt_fraction(self.square))
        wheel = [float(factor * l) for l in self.wheel]
        at = lambda m: [l / (1 - m * d) if l else 0.0 for l, d in zip(wheel, D)]
        # the sum rises from 0 at m = -inf to more than h^2 before 1/D1, or to h^2 there
        above = lambda m: math.hypot(*at(m)) - h
        high = (1 / max(D)) * (1 - EPS)
        low = -1.0 / max(D)
        while above(low) > 0:
            low *= 2
        m = halved(above, low, high) if above(high) > 0 else high
        rates = tuple(m * v for v in at(m))
        return rates if factor else (0.0,) * 3

    def _least(self) -> Fraction | None:
        """The least of sum lambda_i^2/(1 - m D_i)^2 between 1/D1 and 1/D2; None where it is infinite."""
        low, high = (1 / d for d in sorted(self.D, reverse=True)[:2])
        slope = ONE * 0
        for d, w in self.active.items():
            slope = slope + self._product(3, d) * (w * d)
        inner = [m for m in (real_roots(slope, BITS) if slope.degree > 0 else ()) if low < m < high]
        ends = [m for m in (low, high) if 1 / m not in self.active]
        return min((sum((w / (1 - m * d) ** 2 for d, w in self.active.items()), Fraction(0))
                    for m in (*inner, *ends)), default=None)


def _nature(signs: Sequence[int], fold: bool) -> str:
    """By the signs of the energy's growth across H."""
    if fold or 0 in signs:
        return INFLECTION
    return MINIMUM if min(signs) > 0 else MAXIMUM if max(signs) < 0 else SADDLE


def nature_at(D: Exact3, wheel: Exact3, omega: Sequence[Fraction]) -> str:
    """The nature of the energy at a rotation that is none of a fold or a crossing: exact, where omega is."""
    H = [d * w + l for d, w, l in zip(D, omega, wheel)]
    square = dot(H, H)
    if not square:
        return MINIMUM
    A = [square / d - dot(omega, H) for d in D]  # times |H|^2
    across = sum(H[i] * H[i] * A[(i + 1) % 3] * A[(i + 2) % 3] for i in range(3))
    if across < 0:
        return SADDLE
    return _nature([sign_of(sum((a * (square - h * h) for a, h in zip(A, H)), Fraction(0)))], not across)
