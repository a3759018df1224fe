"""A sheet of the separatrix as a surface in two parameters: t along a branch of saddles, y along the loop of each.

A saddle S(t) = (x, z) stands on the conic of equilibria; carried along its orbit by the offset y it is

    X = x C(y) + z S(y),  Z = z C(y) + e x S(y),   C, S = cos, sin (e = -1) or cosh, sinh (e = +1),

and the loop passes there with W^2 = phi = 2 (V_saddle - V) = 2 [mu (y - S) + b (G x^2 + c x + e d z) + G dx^2/2], b = C - 1,
dx = X - x. Derivatives along the orbit are phi_y = 2 F(X, Z), phi_yy = 2 F'(X, Z); across it the saddle's own height is
stationary, which leaves phi_t = 2 [(G X + c) X_t + e d Z_t - (G x + c) x_t - e d z_t]. Values at a point come with a
bound on their rounding; bounds of second derivatives over a box are sums of sizes in floats.
"""
from __future__ import annotations

import math
from fractions import Fraction
from typing import NamedTuple

from ...numbers.vectors import Float3
from ..potential import y_minus_sin

EPS = 2.0**-52
INF = math.inf
ROUNDINGS = 48  # units in the last place of the largest terms that a value at a point is off by at most
ROUNDING = 16 * EPS
MORE = 1 + 1e-9  # on bounds of second derivatives, for their own rounding


class Point(NamedTuple):
    """phi and the squared distance `apart` in the plane of the orbit with their slopes in (t, y), in the scene's unit; `gap`:
    sqrt(max(phi, 0)) less the state's; the errors of apart, phi and gap."""

    apart: float
    apart_t: float
    apart_y: float
    phi: float
    phi_t: float
    phi_y: float
    gap: float
    off: Float3


class Seen(NamedTuple):
    """A reduction seen from a state: constants of the force and the metric, the state's place; exact and as doubles."""

    e: int
    exact: dict
    plain: dict

    @staticmethod
    def of(reduction, state):
        g, r = reduction.exact_constants, reduction
        u, v, speed = (Fraction(state[axis]) for axis in (r.j, r.k, r.axis))
        x, z, w = g["flip"] * (u + g["sj"]) / g["rx"], (v + g["sk"]) / g["rz"], g["n"] * (speed + r.s)
        exact = {"G": g["G"], "c": g["c"], "d": g["d"], "mu": g["mu"], "n2": g["n"] ** 2, "a": g["rx"] ** 2, "b": g["rz"] ** 2,
                 "X": x, "Z": z, "w": abs(w) / g["n"]}
        return Seen(reduction.e, exact, {name: float(v) for name, v in exact.items()})


class Spot(NamedTuple):
    """A saddle: its place, slopes, the sizes of the terms of x and z; (u, v) from the state, with the sizes of their terms; the
    parts (p, r) = (G x + c, G z + d) of the force, with theirs."""

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


class Hyperbola:
    """Saddles X = (K/h - c)/G, Z = h - shift for h = h0 exp(t), |h| within [inner, outer].

    h0 is, of the ends of the branch and the saddles level with the state, the one nearest to the state; the places there, and how far they
    are from the state, are differences of exact numbers. So doubles resolve the branch next to the state, however far from the
    centre both are: with two moments equal to a share g, the saddles near the state have h alike to that share.
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
        self.low, self.high = self.to(inner), self.to(outer)

    def _anchor(self, inner, outer):
        g = self.seen.exact
        pull = g["G"] * g["X"] + g["c"]
        level = [self.sign * (self.shift + g["Z"]), self.sign * self.K / pull if pull else None]
        found = [short(h) for h in (inner, outer, *level) if h and 0 < h < INF and inner <= h <= outer]

        def apart(h):
            h = self.sign * h
            return g["a"] * ((self.K / h - g["c"]) / g["G"] - g["X"]) ** 2 + g["b"] * (h - self.shift - g["Z"]) ** 2
        return self.sign * min(found, key=apart, default=short(Fraction(math.sqrt(abs(self.K)) or 1.0)))

    def to(self, size):
        """t of the saddle with |h| = size."""
        if not 0 < size < INF:
            return INF if size else -INF
        more = Fraction(size) / abs(self.h0) - 1
        return math.log1p(more) if abs(more) < 0.5 else math.log((more + 1).numerator) - math.log((more + 1).denominator)

    def at(self, t) -> Spot:
        K, c, G, shift = self.plain
        h0, k0, x0, z0, u0, v0 = self.first
        up, down = math.expm1(t), math.expm1(-t)
        h, k, dh, dk = h0 + h0 * up, k0 + k0 * down, h0 * up, k0 * down
        if abs(t) > 1:
            h, k = h0 * math.exp(t), k0 * math.exp(-t)
        p, r = G * k, G * h
        return Spot(x0 + dk, z0 + dh, -k, h, abs(x0) + abs(dk), abs(z0) + abs(dh), u0 + dk, v0 + dh,
                    abs(u0) + abs(dk), abs(v0) + abs(dh), p, r, abs(p), abs(r))

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
        """Middles and radii of x, z, x_t, z_t, x_tt, z_tt over [t - dt, t + dt]; what x and z are there less the state's, and the
        sizes of the terms of these."""
        s = self.at(t)
        half, r = math.sinh(0.5 * dt), math.sinh(dt)
        more, m = 2 * half * half, math.cosh(dt)
        km, kr, hm, hr = -s.xt * m, abs(s.xt) * r, s.zt * m, abs(s.zt) * r
        return (s.x - s.xt * more, kr + ROUNDING * s.sx, s.z + s.zt * more, hr + ROUNDING * s.sz,
                -km, kr, hm, hr, km, kr, hm, hr, s.u - s.xt * more, s.v + s.zt * more, s.su + kr, s.sv + hr)


class Straight:
    """Saddles (x0 + t dx, z0 + t dz) on a line."""

    def __init__(self, seen, line):
        self.here, self.plain = seen.plain, tuple(line)

    def at(self, t) -> Spot:
        x0, z0, dx, dz = self.plain
        g = self.here
        x, z, sx, sz = x0 + t * dx, z0 + t * dz, abs(x0) + abs(t * dx), abs(z0) + abs(t * dz)
        return Spot(x, z, dx, dz, sx, sz, x - g["X"], z - g["Z"], sx + abs(g["X"]), sz + abs(g["Z"]), g["G"] * x + g["c"],
                    g["G"] * z + g["d"], abs(g["G"]) * sx + abs(g["c"]), abs(g["G"]) * sz + abs(g["d"]))

    def over(self, t, dt):
        s = self.at(t)
        return (s.x, abs(s.xt) * dt + ROUNDING * s.sx, s.z, abs(s.zt) * dt + ROUNDING * s.sz, s.xt, 0.0, s.zt, 0.0,
                0.0, 0.0, 0.0, 0.0, s.u, s.v, s.su, s.sv)

    def window(self, reach):
        x0, z0, dx, dz = self.plain
        far = (reach + math.hypot(x0, z0)) / math.hypot(dx, dz) * (1 + 1e-12)
        return -far, far


def short(number):
    """A positive Fraction near another, with 160 bits."""
    number = Fraction(number)
    bits = 160 - number.numerator.bit_length() + number.denominator.bit_length()
    return Fraction(round(number * Fraction(2) ** bits)) / Fraction(2) ** bits


class Chart:
    """One sheet over a rectangle of (t, y)."""

    def __init__(self, seen, curve, t, y):
        self.seen, self.curve, self.t, self.y, self.here = seen, curve, t, y, seen.plain

    def boxes(self):
        """The boxes (chart, t, half its length, y, half its length) to begin with; y = 0, the saddle, is at an edge."""
        (t0, t1), (y0, y1) = self.t, self.y
        for low, high in ((y0, min(y1, 0.0)), (max(y0, 0.0), y1)):
            if low < high:
                half = 0.5 * (high - low)
                yield self, 0.5 * (t0 + t1), 0.5 * (t1 - t0), low + half if high else -half, half

    def misses(self, t, dt, y, dy, upper):
        """Whether a box of a hyperbola's sheet is farther than `upper` for certain, by the ranges of X + Z and X - Z alone:
        they grow and shrink like e^y, and a Taylor polynomial over a long way tells nothing."""
        if self.seen.e < 0:
            return False
        g = self.here
        wide = upper * (1 / math.sqrt(g["a"]) + 1 / math.sqrt(g["b"])) * MORE
        x, rx, z, rz = self.curve.over(t, dt)[:4]
        low, high = math.exp(y - dy), math.exp(y + dy)
        return (_apart(x + z, rx + rz, low, high, g["X"] + g["Z"], wide)
                or _apart(x - z, rx + rz, 1 / high, 1 / low, g["X"] - g["Z"], wide))

    def at_one(self, t):
        """The same chart at one t alone."""
        return Chart(self.seen, self.curve, (t, t), self.y)

    def place(self, t, y):
        """(X, Z, W/n) in floats, X and Z less the state's."""
        at = self.curve.at(t)
        s, half = (math.sin(y), math.sin(0.5 * y)) if self.seen.e < 0 else (math.sinh(y), math.sinh(0.5 * y))
        b = 2 * self.seen.e * half * half
        return at.u + at.x * b + at.z * s, at.v + at.z * b + self.seen.e * at.x * s, math.sqrt(max(self.point(t, y).phi, 0.0))

    def point(self, t, y) -> Point:
        e, g = self.seen.e, self.here
        G, c, d, mu, n2, a, b2 = g["G"], g["c"], g["d"], g["mu"], g["n2"], g["a"], g["b"]
        x, z, xt, zt, sx, sz, u, v, su, sv, p, r, sp, sr = self.curve.at(t)
        if e < 0:
            s, half = math.sin(y), math.sin(0.5 * y)
            b, lag = -2 * half * half, y_minus_sin(y)
        else:
            s, half = math.sinh(y), math.sinh(0.5 * y)
            b, lag = 2 * half * half, y - s if abs(y) > 0.3 else _less_sinh(y)
        q = 1 + b
        X, Z, Xt, Zt = x * q + z * s, z * q + e * x * s, xt * q + zt * s, zt * q + e * xt * s
        big_s, big_b = abs(s), abs(b)
        dx, dz, dxt = z * s + x * b, z * b + e * x * s, zt * s + xt * b
        u, v = u + dx, v + dz
        # the squares of dx, with s^2 = e b (b + 2), are put to the terms in b: these are then as small as their sum
        phi = 2 * (mu * lag + b * (x * p + e * z * r) + 0.5 * G * b * b * (x * x + e * z * z) + G * b * s * x * z) / n2
        force = mu + G * X * Z + c * Z + d * X
        phi_t = 2 * (b * ((p + G * x) * xt + e * d * zt) + G * dx * dxt) / n2  # p z_t + r x_t is zero
        off_phi = 2 * (abs(mu * lag) + big_b * (sx * sp + sz * sr) + 0.5 * abs(G) * big_b * big_b * (sx * sx + sz * sz)
                       + abs(G) * big_b * big_s * sx * sz) / n2 * ROUNDINGS * EPS
        off_u = ROUNDINGS * EPS * (su + sx * big_b + sz * big_s)
        off_v = ROUNDINGS * EPS * (sv + sz * big_b + sx * big_s)
        apart = a * u * u + b2 * v * v
        off = a * off_u * (2 * abs(u) + off_u) + b2 * off_v * (2 * abs(v) + off_v) + 8 * EPS * apart
        w0 = g["w"]
        w = math.sqrt(phi) if phi > 0 else 0.0
        gap = w - w0
        off_w = (off_phi / (w + math.sqrt(max(phi - off_phi, 0.0)) + 1e-300) if phi > 0 else math.sqrt(off_phi)) + 4 * EPS * (w + w0)
        return Point(apart, 2 * (a * u * Xt + b2 * v * Zt), 2 * (a * u * Z + b2 * v * e * X), phi, phi_t, 2 * force / n2, gap,
                     (off, off_phi, min(off_w, math.sqrt(off_phi) + 4 * EPS * (w + w0))))

    def bends(self, t, dt, y, dy):
        """((mid, radius) of apart_tt, apart_ty, apart_yy), the same of phi over the box about (t, y)."""
        e, g = self.seen.e, self.here
        G, c, d, n2, a, b2 = g["G"], g["c"], g["d"], g["n2"], g["a"], g["b"]
        x, rx, z, rz, x1, rx1, z1, rz1, x2, rx2, z2, rz2, u, v, su, sv = self.curve.over(t, dt)
        if e < 0:
            s, q = math.sin(y), math.cos(y)
            rs, rq, half = dy * min(1.0, abs(q) + dy), dy * min(1.0, abs(s) + dy), math.sin(0.5 * y)
        else:
            s, q, half = math.sinh(y), math.cosh(y), math.sinh(0.5 * y)
            rs, rq = dy * math.cosh(abs(y) + dy), dy * math.sinh(abs(y) + dy)
        less = 2 * e * half * half
        ms, mq = abs(s) + rs, abs(q) + rq

        def turned(p, rp, o, ro):
            """p C + o S and o C + e p S with radii."""
            return (p * q + o * s, rp * mq + abs(p) * rq + ro * ms + abs(o) * rs,
                    o * q + e * p * s, ro * mq + abs(o) * rq + rp * ms + abs(p) * rs)

        def on(p, rp, o, ro):
            """What the way y itself adds: p (C - 1) + o S; a short way adds little, so it is no difference of two."""
            return p * less + o * s, rp * abs(less) + ro * abs(s) + ROUNDING * (abs(p * less) + abs(o * s))
        X, rX, Z, rZ = turned(x, rx, z, rz)
        X1, rX1, Z1, rZ1 = turned(x1, rx1, z1, rz1)
        X2, rX2, Z2, rZ2 = turned(x2, rx2, z2, rz2)
        xb, zs, zb, xs = x * less, z * s, z * less, e * x * s
        u, v = u + (xb + zs), v + (zb + xs)
        rX, rZ = rX + ROUNDING * (abs(X) + su + abs(xb) + abs(zs)), rZ + ROUNDING * (abs(Z) + sv + abs(zb) + abs(xs))
        mX, mZ, mX1, mZ1, mX2, mZ2 = abs(X) + rX, abs(Z) + rZ, abs(X1) + rX1, abs(Z1) + rZ1, abs(X2) + rX2, abs(Z2) + rZ2
        tt = 2 * (a * (X1 * X1 + u * X2) + b2 * (Z1 * Z1 + v * Z2))
        rtt = 2 * (a * (rX1 * (mX1 + abs(X1)) + rX * mX2 + abs(u) * rX2) + b2 * (rZ1 * (mZ1 + abs(Z1)) + rZ * mZ2 + abs(v) * rZ2))
        ty = 2 * (a * (X1 * Z + u * Z1) + e * b2 * (Z1 * X + v * X1))
        rty = 2 * (a * (rX1 * mZ + abs(X1) * rZ + rX * mZ1 + abs(u) * rZ1) + b2 * (rZ1 * mX + abs(Z1) * rX + rZ * mX1 + abs(v) * rX1))
        yy = 2 * (a * (Z * Z + e * u * X) + b2 * (X * X + e * v * Z))
        ryy = 2 * (a * (rZ * (mZ + abs(Z)) + rX * mX + abs(u) * rX) + b2 * (rX * (mX + abs(X)) + rZ * mZ + abs(v) * rZ))
        pull, rpull, k = G * X + c, abs(G) * rX, 2 / n2
        (dX1, rdX1), (dX2, rdX2) = on(x1, rx1, z1, rz1), on(x2, rx2, z2, rz2)
        sum1, rsum1, tilt = X1 + x1, rX1 + rx1, G * z + d
        ptt = k * (G * dX1 * sum1 + pull * dX2 + s * x2 * tilt + less * (G * x * x2 + e * d * z2))
        rptt = k * (abs(G) * (rdX1 * (abs(sum1) + rsum1) + abs(dX1) * rsum1) + rpull * (abs(dX2) + rdX2) + abs(pull) * rdX2
                    + abs(s) * (rx2 * (abs(tilt) + abs(G) * rz) + abs(x2 * G) * rz)
                    + abs(less) * (abs(G) * (rx * (abs(x2) + rx2) + abs(x) * rx2) + abs(d) * rz2)
                    + ROUNDING * (abs(s * x2) * (abs(G * z) + abs(d)) + abs(less) * (abs(G * x * x2) + abs(d * z2))))
        # along the orbit phi_tt changes at the rate 2 F_tt, whose terms nearly cancel where moments are nearly equal
        rptt += k * dy * (2 * abs(G) * mX1 * mZ1 + (abs(G * Z + d) + abs(G) * rZ) * mX2 + (abs(pull) + rpull) * mZ2)
        pty = k * ((G * Z + d) * X1 + pull * Z1)
        rpty = k * (abs(G) * rZ * mX1 + abs(G * Z + d) * rX1 + rpull * mZ1 + abs(pull) * rZ1)
        pyy = k * (G * (Z * Z + e * X * X) + e * c * X + d * Z)
        rpyy = k * (abs(G) * (rZ * (mZ + abs(Z)) + rX * (mX + abs(X))) + abs(c) * rX + abs(d) * rZ)
        return tuple((m, r * MORE + 1e-9 * abs(m)) for m, r in ((tt, rtt), (ty, rty), (yy, ryy), (ptt, rptt), (pty, rpty), (pyy, rpyy)))


def _apart(middle, radius, low, high, place, wide):
    """Whether all products of a number within the radius and a factor in [low, high] are farther than `wide` from the place."""
    least, most = middle - radius, middle + radius
    least, most = least * (low if least > 0 else high), most * (high if most > 0 else low)
    slack = 1e-12 * (abs(least) + abs(most) + abs(place))
    return least - slack > place + wide or most + slack < place - wide


def _less_sinh(y):
    """y - sinh y for |y| <= 0.3."""
    t = y * y
    return -y * t / 6 * (1 + t / 20 * (1 + t / 42 * (1 + t / 72 * (1 + t / 110))))
