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

from ....potential import force_at
from ..point import UNIT, Point, gap_of, square_of
from .bends import loop_bends
from .sharp import loop_place, sharp_place, sharp_point


class Chart:
    """One sheet over a rectangle of (t, y)."""

    sharpest = False  # whether its points are exact in any case
    from_saddle = True  # whether y = 0 is the saddle, where phi and its slope vanish
    turns: float = 0  # turns from the saddle to y = 0, on circles

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
        """Whether a box is farther than `upper` for certain, by a quicker look than a Taylor polynomial."""
        return False

    def holds(self, t, y):
        """Whether the point belongs to the sheet."""
        return True

    def folded(self, t, dt, y, dy):
        """Whether the parameters may turn back over a box, so that no bound is known."""
        return False

    def steep(self, t, dt, y, dy):
        """Whether a box of which no bound is known is better halved in t."""
        return dt >= dy

    def on_sheet(self, t, y):
        return self, t, y

    def at_one(self, t, y):
        """The same chart at one t alone, and the point there."""
        return Chart(self.seen, self.curve, (t, t), self.y), t, y

    def place(self, t, y):
        """(X, Z, W/n) in floats, X and Z less the state's."""
        at = self.curve.at(t)
        s, half = self.seen.geometry.turn(y)
        b = 2 * self.seen.e * half * half
        return at.u + at.x * b + at.z * s, at.v + at.z * b + self.seen.e * at.x * s, math.sqrt(max(self.point(t, y).phi, 0.0))

    def point(self, t, y) -> Point:
        e, g = self.seen.e, self.here
        G, c, d, mu, n2, a, b2 = g["G"], g["c"], g["d"], g["mu"], g["n2"], g["a"], g["b"]
        x, z, xt, zt, sx, sz, u, v, su, sv, p, r, sp, sr = self.curve.at(t)
        s, half = self.seen.geometry.turn(y)
        b, lag = 2 * e * half * half, self.seen.geometry.lag(y, s) + 2 * math.pi * self.turns
        q = 1 + b
        X, Z, Xt, Zt = x * q + z * s, z * q + e * x * s, xt * q + zt * s, zt * q + e * xt * s
        big_s, big_b = abs(s), abs(b)
        dx, dz, dxt = z * s + x * b, z * b + e * x * s, zt * s + xt * b
        u, v = u + dx, v + dz
        # the squares of dx, with s^2 = e b (b + 2), are put to the terms in b: these are then as small as their sum
        phi = 2 * (mu * lag + b * (x * p + e * z * r) + 0.5 * G * b * b * (x * x + e * z * z) + G * b * s * x * z) / n2
        force = force_at(G, c, d, mu, X, Z)
        phi_t = 2 * (b * ((p + G * x) * xt + e * d * zt) + G * dx * dxt) / n2  # p z_t + r x_t is zero
        off_phi = 2 * UNIT * (abs(mu * lag) + big_b * (sx * sp + sz * sr) + 0.5 * abs(G) * big_b * big_b * (sx * sx + sz * sz)
                              + abs(G) * big_b * big_s * sx * sz) / n2
        off_u, off_v = UNIT * (su + sx * big_b + sz * big_s), UNIT * (sv + sz * big_b + sx * big_s)
        apart, off = square_of(u, v, off_u, off_v, a, b2)
        gap, off_w = gap_of(phi, off_phi, g["w"])
        mX, mZ, mXt, mZt = sx + abs(dx), sz + sz * big_b + sx * big_s, abs(xt) + abs(dxt), abs(zt * q) + abs(xt * s)
        ut, uy, vt, vy = (2 * UNIT * m for m in (mXt, mZ, mZt, mX))
        rough = (2 * a * (off_u * mXt + abs(u) * ut) + 2 * b2 * (off_v * mZt + abs(v) * vt),
                 2 * a * (off_u * mZ + abs(u) * uy) + 2 * b2 * (off_v * mX + abs(v) * vy),
                 4 * UNIT * (big_b * ((sp + abs(G) * sx) * abs(xt) + abs(d * zt)) + abs(G) * (sz * big_s + sx * big_b) * mXt) / n2,
                 4 * UNIT * (abs(mu) + abs(G) * mX * mZ + abs(c) * mZ + abs(d) * mX) / n2)
        return Point(apart, 2 * (a * u * Xt + b2 * v * Zt), 2 * (a * u * Z + b2 * v * e * X), phi, phi_t, 2 * force / n2, gap,
                     (off, off_phi, off_w), rough)

    def exact_point(self, t, y) -> Point:
        """The same with values to double accuracy, for exact t and y."""
        return sharp_point(self, t, y)

    def exact_place(self, t, y):
        """(X, Z, W/n) in floats, X and Z less the state's, for exact t and y."""
        return sharp_place(self, t, y)

    def sharp(self, numbers, g, t, y):
        return loop_place(g, self.seen.geometry, self.curve.sharp(numbers, g, t), y, 2 * self.turns * numbers.pi())

    @staticmethod
    def metric(g):
        """The squared lengths of the units of u and v."""
        return g["a"], g["b"]

    def bends(self, t, dt, y, dy):
        return loop_bends(self.seen, self.curve, t, dt, y, dy)


class OpenChart(Chart):
    """A sheet whose loops are hyperbolas."""

    def misses(self, t, dt, y, dy, upper):
        """By the ranges of X + Z and X - Z alone: they grow and shrink like e^y, and a Taylor polynomial over a long way tells nothing."""
        g = self.here
        wide = upper * (1 / math.sqrt(g["a"]) + 1 / math.sqrt(g["b"])) * (1 + 1e-9)
        x, rx, z, rz = self.curve.over(t, dt)[:4]
        low, high = math.exp(y - dy), math.exp(y + dy)
        return (outside(x + z, rx + rz, low, high, g["X"] + g["Z"], wide)
                or outside(x - z, rx + rz, 1 / high, 1 / low, g["X"] - g["Z"], wide))


def outside(middle, radius, low, high, place, wide):
    """Whether all products of a number within the radius and a factor in [low, high] are farther than `wide` from the place."""
    least, most = middle - radius, middle + radius
    least, most = least * (low if least > 0 else high), most * (high if most > 0 else low)
    slack = 1e-12 * (abs(least) + abs(most) + abs(place))
    return least - slack > place + wide or most + slack < place - wide
