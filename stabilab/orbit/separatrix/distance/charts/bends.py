"""Bounds of second derivatives over boxes: numbers within a radius of a middle, in doubles, where every radius is a box's own.

Those of a loop chart are written out, as sums of sizes without differences of nearly equal terms.
"""
from __future__ import annotations

import math

from ....potential import slope_at
from ..curves import ROUNDING

MORE = 2.0**-40  # of a middle: what the rounding of a dozen operations stays far below
OUTWARD = 1 + 1e-9  # on radii, for their own rounding


class Span:
    """All numbers within r of m."""

    __slots__ = ("m", "r")

    def __init__(self, m, r=0.0):
        self.m, self.r = m, r

    def __add__(self, other):
        if isinstance(other, Span):
            return Span(self.m + other.m, self.r + other.r + MORE * (abs(self.m) + abs(other.m)))
        return Span(self.m + other, self.r + MORE * (abs(self.m) + abs(other)))

    def __neg__(self):
        return Span(-self.m, self.r)

    def __sub__(self, other):
        return self + -other

    def __rsub__(self, other):
        return -self + other

    def __mul__(self, other):
        if isinstance(other, Span):
            m = self.m * other.m
            return Span(m, abs(self.m) * other.r + self.r * (abs(other.m) + other.r) + MORE * abs(m))
        m = self.m * other
        return Span(m, self.r * abs(other) + MORE * abs(m))

    __radd__, __rmul__ = __add__, __mul__

    def inverse(self):
        """One over it; a radius of inf where it holds zero."""
        least = abs(self.m) - self.r
        if not least > 0:
            return Span(0.0, float("inf"))
        m = 1 / self.m
        return Span(m, self.r * abs(m) / least + MORE * abs(m))

    def pair(self):
        return self.m, self.r * (1 + 1e-9)


def widened(bends):
    """(middle, radius) with the radii's own rounding."""
    return tuple((m, r * OUTWARD + 1e-9 * abs(m)) for m, r in bends)


def shrinking(y, dy):
    """e^-y over a span."""
    base = math.exp(-y)
    return Span(base * math.cosh(dy), base * math.sinh(dy)) if dy < 600 else Span(0.5 * math.exp(dy - y), 0.5 * math.exp(dy - y))


def turned(e, turn, p, rp, o, ro):
    """p C + o S and o C + e p S with radii; turn: (S, C) with theirs."""
    s, q, rs, rq = turn
    ms, mq = abs(s) + rs, abs(q) + rq
    return (p * q + o * s, rp * mq + abs(p) * rq + ro * ms + abs(o) * rs,
            o * q + e * p * s, ro * mq + abs(o) * rq + rp * ms + abs(p) * rs)


def loop_bends(seen, curve, t, dt, y, dy):
    """((middle, radius) of apart_tt, apart_ty, apart_yy), the same of phi over the box about (t, y)."""
    e, g = seen.e, seen.plain
    G, c, d, n2, a, b2 = g["G"], g["c"], g["d"], g["n2"], g["a"], g["b"]
    x, rx, z, rz, x1, rx1, z1, rz1, x2, rx2, z2, rz2, u, v, su, sv = curve.over(t, dt)
    s, q, half, rs, rq = seen.geometry.turns(y, dy)
    less = 2 * e * half * half
    turn = s, q, rs, rq

    def on(p, rp, o, ro):
        """What the way y itself adds: p (C - 1) + o S; a short way adds little, so it is no difference of two."""
        return p * less + o * s, rp * abs(less) + ro * abs(s) + ROUNDING * (abs(p * less) + abs(o * s))
    X, rX, Z, rZ = turned(e, turn, x, rx, z, rz)
    X1, rX1, Z1, rZ1 = turned(e, turn, x1, rx1, z1, rz1)
    X2, rX2, Z2, rZ2 = turned(e, turn, x2, rx2, z2, rz2)
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
    pyy = k * slope_at(G, c, d, e, X, Z)
    rpyy = k * (abs(G) * (rZ * (mZ + abs(Z)) + rX * (mX + abs(X))) + abs(c) * rX + abs(d) * rZ)
    return widened(((tt, rtt), (ty, rty), (yy, ryy), (ptt, rptt), (pty, rpty), (pyy, rpyy)))
