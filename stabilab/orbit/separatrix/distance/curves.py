"""A point against curves of saddles and the ring between circles: lower bounds of a distance.

Branches of saddles: curves on the conic of equilibria, with places told from the state.

A branch has a parameter t whose zero is at or near the saddle nearest to the state, and the places there, and
how far they are from the state, are differences of exact numbers.

Which saddles of circles have loops that come near a state: those about as far from the centre as the state
is.

On a circle X^2 + Z^2 is the saddle's all along the loop, and the distance of two places is at least
sqrt(min(a, b)) times that of their circles. Far from the centre that leaves a branch of saddles in a few
pieces, a share `upper`/radius of its length each; a search over all of it would halve its way there once for
every part of the loop. The difference of the squares is told from the state's place, so it keeps its digits
where both are huge.
"""
from __future__ import annotations

import math
from collections.abc import Iterator
from fractions import Fraction
from typing import Any, NamedTuple

from ...conic import planes_touched

# --- A reduction seen from a state, and what a chart of a branch says of one of its points
EPS = 2.0**-52
ROUNDINGS = 48  # units in the last place of the largest terms that a value at a point is off by at most
UNIT = ROUNDINGS * EPS


class Point(NamedTuple):
    """phi = W^2 and the squared distance `apart` in the plane of the orbit with their slopes in (t, y), in
    the scene's unit; gap: sqrt(max(phi, 0)) less the state's. off: the errors of apart, phi and gap; rough:
    those of the four slopes in their order.
    """

    apart: float
    apart_t: float
    apart_y: float
    phi: float
    phi_t: float
    phi_y: float
    gap: float
    off: tuple[float, float, float]
    rough: tuple[float, float, float, float]

    def off_square(self, w0):
        """Error of the square of the gap: next to W = 0 it is that of phi - 2 w0 sqrt(phi), where the root's
        own is large."""
        off = self.off[2]
        return min(2 * abs(self.gap) * off + off * off, self.off[1] + 2 * w0 * off)


class Constants:
    """The exact constants of a scene and a state as balls of some bits, made once for each number of bits."""

    def __init__(self, exact):
        self.exact, self.known = exact, {}

    def at(self, numbers):
        if numbers.bits not in self.known:
            self.known[numbers.bits] = {name: numbers.ball(value) for name, value in self.exact.items()}
        return self.known[numbers.bits]


class Seen(NamedTuple):
    """A reduction seen from a state: constants of the force and the metric, the state's place; exact, as
    balls and as doubles."""

    geometry: Any  # a class of `potential`
    exact: dict
    balls: Constants
    plain: dict
    touched: tuple = ()  # +1, -1: the hyperbola of equilibria touches a plane Z = -X, Z = X

    @property
    def e(self) -> int:
        """The sign of p q."""
        return self.geometry.e

    @staticmethod
    def of(reduction, state):
        g, r = reduction.exact_constants, reduction
        u, v, speed = (Fraction(state[axis]) for axis in (r.j, r.k, r.axis))
        x, z, w = g["flip"] * (u + g["sj"]) / g["rx"], (v + g["sk"]) / g["rz"], g["n"] * (speed + r.s)
        return seen_as(reduction.geometry, {"G": g["G"], "c": g["c"], "d": g["d"], "mu": g["mu"],
                                            "n2": g["n"] ** 2, "a": g["rx"] ** 2,
                                            "b": g["rz"] ** 2, "X": x, "Z": z, "w": abs(w) / g["n"]},
                       planes_touched(r))


def seen_as(geometry, exact, touched=()) -> Seen:
    return Seen(geometry, exact, Constants(exact), {name: float(value) for name, value in exact.items()},
                touched)


def gap_of(phi, off_phi, w0):
    """sqrt(max(phi, 0)) - w0 and its error, for a phi with an error."""
    w = phi**0.5 if phi > 0 else 0.0
    off = off_phi / (w + max(phi - off_phi, 0.0)**0.5 + 1e-300) if phi > 0 else off_phi**0.5
    return w - w0, min(off, off_phi**0.5) + 4 * EPS * (w + w0)


def square_of(u, v, off_u, off_v, a, b):
    """a u^2 + b v^2 and its error."""
    apart = a * u * u + b * v * v
    return apart, a * off_u * (2 * abs(u) + off_u) + b * off_v * (2 * abs(v) + off_v) + 8 * EPS * apart


INF = math.inf
ROUNDING = 16 * EPS


class Spot(NamedTuple):
    """A saddle: its place, slopes, the sizes of the terms of x and z; (u, v) from the state, with the sizes
    of their terms; the parts (p, r) = (G x + c, G z + d) of the force, with theirs."""

    x: float
    z: float
    xt: float
    zt: float
    sx: float
    sz: float
    u: float
    v: float
    su: float
    sv: float
    p: float
    r: float
    sp: float
    sr: float


class _Remembered:
    """A curve of saddles remembers its last place: a box needs that of its middle twice, and its neighbour
    the same one."""

    last: tuple[float, Spot | None] = (math.nan, None)

    def at(self, t) -> Spot:
        known, spot = self.last
        if known != t:
            spot = self.found(t)
            self.last = t, spot
        return spot

    def found(self, t) -> Spot:
        raise NotImplementedError


class Hyperbola(_Remembered):
    """Saddles X = (K/h - c)/G, Z = h - shift for h = h0 exp(t), |h| within [inner, outer].

    h0 is, of the ends of the branch and the saddles level with the state, the one nearest to the state; the
    places there, and how far they are from the state, are differences of exact numbers. So doubles resolve
    the branch next to the state, however far from the centre both are: with two moments equal to a share g,
    the saddles near the state have h alike to that share.
    """

    def __init__(self, seen, inner, outer, sign):
        g = seen.exact
        self.seen, self.sign = seen, sign
        self.K, self.shift = g["c"] * g["d"] / g["G"] - g["mu"], g["d"] / g["G"]
        self.plain = tuple(map(float, (self.K, g["c"], g["G"], self.shift)))
        self.h0 = self._anchor(inner, outer)
        k0 = self.K / (self.h0 * g["G"])
        x, z = k0 - g["c"] / g["G"], self.h0 - self.shift
        self.first = tuple(map(float, (self.h0, k0, x, z, x - g["X"], z - g["Z"])))
        self.low, self.high, self.ends = self.to(inner), self.to(outer), (inner, outer)

    def _anchor(self, inner, outer):
        g = self.seen.exact
        pull = g["G"] * g["X"] + g["c"]
        level = [self.sign * (self.shift + g["Z"]), self.sign * self.K / pull if pull else None]
        found = [short(h) for h in (inner, outer, *level) if h and 0 < h < INF and inner <= h <= outer]

        def apart(h):
            h = self.sign * h
            return (g["a"] * ((self.K / h - g["c"]) / g["G"] - g["X"]) ** 2
                    + g["b"] * (h - self.shift - g["Z"]) ** 2)
        return self.sign * min(found, key=apart, default=short(Fraction(math.sqrt(abs(self.K)) or 1.0)))

    def to(self, size):
        """t of the saddle with |h| = size."""
        if not 0 < size < INF:
            return INF if size else -INF
        more = Fraction(size) / abs(self.h0) - 1
        return (math.log1p(more) if abs(more) < 0.5
                else math.log((more + 1).numerator) - math.log((more + 1).denominator))

    def found(self, t) -> Spot:
        K, c, G, shift = self.plain
        h0, k0, x0, z0, u0, v0 = self.first
        up, down = math.expm1(t), math.expm1(-t)
        h, k, dh, dk = h0 + h0 * up, k0 + k0 * down, h0 * up, k0 * down
        if abs(t) > 1:
            h, k = h0 * math.exp(t), k0 * math.exp(-t)
        p, r = G * k, G * h
        return Spot(x0 + dk, z0 + dh, -k, h, abs(x0) + abs(dk), abs(z0) + abs(dh), u0 + dk, v0 + dh,
                    abs(u0) + abs(dk), abs(v0) + abs(dh), p, r, abs(p), abs(r))

    def exact(self, t):
        """(x, z) of a saddle at t, or beside it, as Fractions; at the ends of the branch those of the ends.
        """
        return self.place(self.h_at(t))

    def h_at(self, t):
        """h there."""
        h = (self.ends[0] if t == self.low else self.ends[1] if t == self.high
             else short(abs(self.h0) * Fraction(math.exp(t))))
        return self.sign * Fraction(h)

    def place(self, h):
        """(x, z) of the saddle at h, as Fractions."""
        g = self.seen.exact
        return (self.K / h - g["c"]) / g["G"], h - self.shift

    def sharp(self, numbers, g, t):
        """x, z, x_t, z_t as balls."""
        h = numbers.ball(self.h0) * t.exp()
        k = numbers.ball(self.K) / (h * g["G"])
        return k - g["c"] / g["G"], h - numbers.ball(self.shift), -k, h

    def window(self, reach):
        """t of the saddles within `reach` of the centre; the first above the second where there is none."""
        g, reach = self.seen.exact, Fraction(reach) * (1 + Fraction(1, 10**12))
        low, high = (self.sign * self.shift + side * reach for side in (-1, 1))
        side = 1 if self.sign * self.K > 0 else -1
        least, most = (side * g["c"] + n * abs(g["G"]) * reach for n in (-1, 1))
        if high <= 0 or most <= 0:
            return INF, -INF
        low = max(low, abs(self.K) / most)
        return self.to(low), self.to(min(high, abs(self.K) / least) if least > 0 else high)

    def over(self, t, dt):
        """Middles and radii of x, z, x_t, z_t, x_tt, z_tt over [t - dt, t + dt]; what x and z are there less
        the state's, and the sizes of the terms of these."""
        s = self.at(t)
        half, r = math.sinh(0.5 * dt), math.sinh(dt)
        more, m = 2 * half * half, math.cosh(dt)
        km, kr, hm, hr = -s.xt * m, abs(s.xt) * r, s.zt * m, abs(s.zt) * r
        return (s.x - s.xt * more, kr + ROUNDING * s.sx, s.z + s.zt * more, hr + ROUNDING * s.sz,
                -km, kr, hm, hr, km, kr, hm, hr, s.u - s.xt * more, s.v + s.zt * more, s.su + kr, s.sv + hr)


class Straight(_Remembered):
    """Saddles on one of the lines that the conic degenerates to, at a point of it plus t times its direction.

    The point is the foot of the orbits, where a cone may have its tip, or the place nearest to the state
    where the state is much nearer to that. knots: t of the foot and of where two lines cross; between them
    all of the line are saddles or none.
    """

    def __init__(self, seen, fixed):
        """fixed: "x" or "z" for the line on which it is constant, None for c Z + d X + mu = 0."""
        g, self.seen, self.here = seen.exact, seen, seen.plain
        G, c, d = g["G"], g["c"], g["d"]
        base, way = {"x": ((-c / G, 0), (0, 1)), "z": ((0, -d / G), (1, 0))}[fixed] if fixed else (
            (-g["mu"] * d / (c * c + d * d), -g["mu"] * c / (c * c + d * d)), (-c, d))
        cross = {"x": -d / G, "z": -c / G}[fixed] if fixed else None
        square = way[1] ** 2 - seen.e * way[0] ** 2
        foot = -(base[1] * way[1] - seen.e * base[0] * way[0]) / square if square else Fraction(0)
        level = self._level(g, base, way)
        start = (short(level) if 1000**2 * self._apart(g, base, way, level) < self._apart(g, base, way, foot)
                 else foot)
        self.base, self.way = tuple(b + start * w for b, w in zip(base, way)), tuple(map(Fraction, way))
        self.knots = sorted({float(t - start) for t in (foot, cross) if t is not None})
        x, z = self.base
        self.plain = tuple(map(float, (x, z, *self.way, x - g["X"], z - g["Z"])))

    @staticmethod
    def _level(g, base, way):
        """The t nearest to the state."""
        over = g["a"] * way[0] * (g["X"] - base[0]) + g["b"] * way[1] * (g["Z"] - base[1])
        return over / (g["a"] * way[0] ** 2 + g["b"] * way[1] ** 2)

    @staticmethod
    def _apart(g, base, way, t):
        return g["a"] * (base[0] + t * way[0] - g["X"]) ** 2 + g["b"] * (base[1] + t * way[1] - g["Z"]) ** 2

    def found(self, t) -> Spot:
        x0, z0, dx, dz, u0, v0 = self.plain
        g, tx, tz = self.here, t * dx, t * dz
        x, z, sx, sz = x0 + tx, z0 + tz, abs(x0) + abs(tx), abs(z0) + abs(tz)
        return Spot(x, z, dx, dz, sx, sz, u0 + tx, v0 + tz, abs(u0) + abs(tx), abs(v0) + abs(tz),
                    g["G"] * x + g["c"],
                    g["G"] * z + g["d"], abs(g["G"]) * sx + abs(g["c"]), abs(g["G"]) * sz + abs(g["d"]))

    def over(self, t, dt):
        s = self.at(t)
        return (s.x, abs(s.xt) * dt + ROUNDING * s.sx, s.z, abs(s.zt) * dt + ROUNDING * s.sz, s.xt, 0.0, s.zt,
                0.0,
                0.0, 0.0, 0.0, 0.0, s.u, s.v, s.su, s.sv)

    def exact(self, t):
        return tuple(b + Fraction(t) * w for b, w in zip(self.base, self.way))

    def sharp(self, numbers, g, t):
        (x, z), (dx, dz) = (tuple(map(numbers.ball, pair)) for pair in (self.base, self.way))
        return x + t * dx, z + t * dz, dx, dz

    def window(self, reach):
        x0, z0, dx, dz = self.plain[:4]
        far = (reach + math.hypot(x0, z0)) / math.hypot(dx, dz) * (1 + 1e-12)
        return -far, far


def short(number):
    """A Fraction near another, with 160 bits."""
    number = Fraction(number)
    if not number:
        return number
    bits = 160 - abs(number.numerator).bit_length() + number.denominator.bit_length()
    return Fraction(round(number * Fraction(2) ** bits)) / Fraction(2) ** bits


# radii, in distances: doubles do not tell the angles of the other barriers of a wider circle well enough
WIDEST = 1e14


def within(seen: Any, curve: Any, low: float, high: float, upper: float) -> list[tuple[float, float]]:
    """The pieces (from, to) of a branch over [low, high] that hold all its saddles with loops within `upper`
    of the state, in rising order."""
    g = seen.plain
    wide, radius = upper * (1 + 1e-9) / math.sqrt(min(g["a"], g["b"])), math.hypot(g["X"], g["Z"])
    if wide >= radius:
        return [(low, high)]
    if radius > WIDEST * wide:
        raise OverflowError
    pieces: list[tuple[float, float]] = []
    for start, end in _pieces(curve, (g["X"], g["Z"]), 0.5 * (low + high), 0.5 * (high - low),
                              (radius, wide)):
        if pieces and start <= pieces[-1][1]:
            pieces[-1] = pieces[-1][0], end
        else:
            pieces.append((start, end))
    return [(max(start, low), min(end, high)) for start, end in pieces]


def _pieces(curve: Any, place: tuple[float, float], t: float, dt: float,
            band: tuple[float, float]) -> Iterator[tuple[float, float]]:
    """Those of [t - dt, t + dt], halved until they are no longer than the band is wide, or doubles tell no
    more."""
    radius, wide = band
    middle, reach, rounding = _beyond(curve, place, t, dt)
    if middle - reach > wide * (2 * radius + wide) or middle + reach < -wide * (2 * radius - wide):
        return
    if not math.isfinite(reach):
        raise OverflowError
    if reach <= radius * wide + 2 * rounding or t - 0.5 * dt == t:
        yield t - dt * (1 + 1e-15) - 1e-16 * abs(t), t + dt * (1 + 1e-15) + 1e-16 * abs(t)
        return
    for side in (-0.5, 0.5):
        yield from _pieces(curve, place, t + side * dt, 0.5 * dt, band)


def _beyond(curve: Any, place: tuple[float, float], t: float, dt: float) -> tuple[float, float, float]:
    """(middle, radius) of |saddle|^2 less the state's |place|^2 over [t - dt, t + dt], and the part of the
    radius that is rounding."""
    # the slopes, as the places' own radii hold the rounding of all of a place
    x1, rx1, z1, rz1, _, _, _, _, u, v, su, sv = curve.over(t, dt)[4:]
    middle, reach, rounding = 0.0, 0.0, 0.0
    for apart, r, size, at in ((u, (abs(x1) + rx1) * dt, su, place[0]),
                               (v, (abs(z1) + rz1) * dt, sv, place[1])):
        lost = ROUNDING * size
        middle += apart * (apart + 2 * at)
        reach += (r + lost) * (2 * abs(apart + at) + r + lost)
        rounding += lost * (2 * abs(apart + at) + lost) + ROUNDING * abs(apart) * (abs(apart) + 2 * abs(at))
    return middle, reach + rounding, rounding
