"""Parameters along a separatrix, and how much they bend within a box.

Bounds of second derivatives over boxes: numbers within a radius of a middle, in doubles, where every radius
is a box's own.

Those of a loop chart are written out, as sums of sizes without differences of nearly equal terms.

A point of a branch in balls of many digits, where the rounding of doubles would decide how near it is.

Each chart gives the place of (t, y) less the state's, (u, v), and phi = W^2 with their slopes; t and y are
exact: doubles, or Fractions beside a point that doubles do not resolve. The formulas are the plain ones: what
cancels costs bits, not digits.
"""
from __future__ import annotations

import math
from fractions import Fraction
from typing import Any, NamedTuple

from ....numbers.balls import working
from ....numbers.exact import sqrt_fraction
from ...potential import force_at, slope_at
from .curves import EPS, ROUNDING, Point

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
    return (Span(base * math.cosh(dy), base * math.sinh(dy)) if dy < 600
            else Span(0.5 * math.exp(dy - y), 0.5 * math.exp(dy - y)))


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
        """What the way y itself adds: p (C - 1) + o S; a short way adds little, so it is no difference of
        two."""
        return p * less + o * s, rp * abs(less) + ro * abs(s) + ROUNDING * (abs(p * less) + abs(o * s))
    X, rX, Z, rZ = turned(e, turn, x, rx, z, rz)
    X1, rX1, Z1, rZ1 = turned(e, turn, x1, rx1, z1, rz1)
    X2, rX2, Z2, rZ2 = turned(e, turn, x2, rx2, z2, rz2)
    xb, zs, zb, xs = x * less, z * s, z * less, e * x * s
    u, v = u + (xb + zs), v + (zb + xs)
    rX, rZ = rX + ROUNDING * (abs(X) + su + abs(xb)
                              + abs(zs)), rZ + ROUNDING * (abs(Z) + sv + abs(zb) + abs(xs))
    mX, mZ, mX1, mZ1, mX2, mZ2 = abs(X) + rX, abs(Z) + rZ, abs(X1) + rX1, abs(Z1) + rZ1, abs(X2) + rX2, abs(
        Z2) + rZ2
    tt = 2 * (a * (X1 * X1 + u * X2) + b2 * (Z1 * Z1 + v * Z2))
    rtt = (2 * (a * (rX1 * (mX1 + abs(X1)) + rX * mX2 + abs(u) * rX2)
                + b2 * (rZ1 * (mZ1 + abs(Z1)) + rZ * mZ2 + abs(v) * rZ2)))
    ty = 2 * (a * (X1 * Z + u * Z1) + e * b2 * (Z1 * X + v * X1))
    rty = (2 * (a * (rX1 * mZ + abs(X1) * rZ + rX * mZ1 + abs(u) * rZ1)
                + b2 * (rZ1 * mX + abs(Z1) * rX + rZ * mX1 + abs(v) * rX1)))
    yy = 2 * (a * (Z * Z + e * u * X) + b2 * (X * X + e * v * Z))
    ryy = (2 * (a * (rZ * (mZ + abs(Z)) + rX * mX + abs(u) * rX)
                + b2 * (rX * (mX + abs(X)) + rZ * mZ + abs(v) * rZ)))
    pull, rpull, k = G * X + c, abs(G) * rX, 2 / n2
    (dX1, rdX1), (dX2, rdX2) = on(x1, rx1, z1, rz1), on(x2, rx2, z2, rz2)
    sum1, rsum1, tilt = X1 + x1, rX1 + rx1, G * z + d
    ptt = k * (G * dX1 * sum1 + pull * dX2 + s * x2 * tilt + less * (G * x * x2 + e * d * z2))
    rptt = k * (abs(G) * (rdX1 * (abs(sum1) + rsum1) + abs(dX1) * rsum1) + rpull * (abs(dX2) + rdX2)
                + abs(pull) * rdX2
                + abs(s) * (rx2 * (abs(tilt) + abs(G) * rz) + abs(x2 * G) * rz)
                + abs(less) * (abs(G) * (rx * (abs(x2) + rx2) + abs(x) * rx2) + abs(d) * rz2)
                + ROUNDING * (abs(s * x2) * (abs(G * z) + abs(d))
                              + abs(less) * (abs(G * x * x2) + abs(d * z2))))
    # along the orbit phi_tt changes at the rate 2 F_tt, whose terms nearly cancel where moments are nearly
    # equal
    rptt += (k * dy * (2 * abs(G) * mX1 * mZ1 + (abs(G * Z + d) + abs(G) * rZ) * mX2
                       + (abs(pull) + rpull) * mZ2))
    pty = k * ((G * Z + d) * X1 + pull * Z1)
    rpty = k * (abs(G) * rZ * mX1 + abs(G * Z + d) * rX1 + rpull * mZ1 + abs(pull) * rZ1)
    pyy = k * slope_at(G, c, d, e, X, Z)
    rpyy = k * (abs(G) * (rZ * (mZ + abs(Z)) + rX * (mX + abs(X))) + abs(c) * rX + abs(d) * rZ)
    return widened(((tt, rtt), (ty, rty), (yy, ryy), (ptt, rptt), (pty, rpty), (pyy, rpyy)))


BITS, MOST_BITS = 256, 4096
TIGHT = 2.0**-60  # relative: a ball as narrow is a double


class Place(NamedTuple):
    """(u, v) and phi with their slopes in t and y; balls."""

    u: object
    v: object
    ut: object
    uy: object
    vt: object
    vy: object
    phi: object
    phi_t: object
    phi_y: object


def sharp_point(chart, t, y) -> Point:
    """The point of a chart with values to double accuracy, or as near as MOST_BITS bring it."""
    bits = BITS
    while True:
        with working(bits) as numbers:
            g = chart.seen.balls.at(numbers)
            found = _point(chart.sharp(numbers, g, numbers.ball(t), numbers.ball(y)), *chart.metric(g),
                           g["w"])
        if bits >= MOST_BITS or _tight(found):
            return found
        bits *= 4


def sharp_place(chart, t, y):
    """(u, v, W) as doubles."""
    with working(4 * BITS) as numbers:
        found = chart.sharp(numbers, chart.seen.balls.at(numbers), numbers.ball(t), numbers.ball(y))
        return float(found.u.mid()), float(found.v.mid()), float(
            found.phi.mid())**0.5 if found.phi > 0 else 0.0


def _tight(p):
    return (p.off[0] <= 8 * EPS * p.apart and p.off[1] <= 8 * EPS * abs(p.phi)
            and p.off[2] <= 8 * EPS * abs(p.gap))


def _point(s, a, b, w0):
    apart = a * s.u * s.u + b * s.v * s.v
    apart_t, apart_y = 2 * (a * s.u * s.ut + b * s.v * s.vt), 2 * (a * s.u * s.uy + b * s.v * s.vy)
    root = s.phi.sqrt() if s.phi > 0 else s.phi * 0
    gap = root - w0
    values = [_double(n) for n in (apart, apart_t, apart_y, s.phi, s.phi_t, s.phi_y, gap)]
    off = [e for _, e in values]
    if not s.phi > 0 and not s.phi < 0:
        off[6] += math.sqrt(abs(values[3][0]) + off[3]) * (1 + 4 * EPS)
    return Point(*(v for v, _ in values), (off[0], off[3], off[6]), (off[1], off[2], off[4], off[5]))


def _double(ball):
    """(the nearest double, a bound of its error)."""
    value = float(ball.mid())
    if not math.isfinite(value):
        raise OverflowError
    return value, (float(ball.rad()) + EPS * abs(value)) * (1 + 4 * EPS)


def loop_place(g, geometry, saddle, y, turned=0) -> Place:
    """On a circle or hyperbola, from a saddle (x, z, x_t, z_t); turned: the angle of whole turns from it to y
    = 0."""
    x, z, xt, zt = saddle
    e, (C, S) = geometry.e, geometry.turned(y)
    X, Z, Xt, Zt = x * C + z * S, z * C + e * x * S, xt * C + zt * S, zt * C + e * xt * S
    G, c, d, mu, k = g["G"], g["c"], g["d"], g["mu"], 2 / g["n2"]
    phi = k * (mu * (y + turned) + G * (X * X - x * x) / 2 + c * (X - x) + e * d * (Z - z))
    phi_t = k * (G * (X * Xt - x * xt) + c * (Xt - xt) + e * d * (Zt - zt))
    return Place(X - g["X"], Z - g["Z"], Xt, Z, Zt, e * X, phi, phi_t, k * force_at(G, c, d, mu, X, Z))


def opposite_place(g, geometry, saddle, y, turned) -> Place:
    """On a circle beside the place opposite to its saddle, where y = 0; g: of the state's mirror image in the
    centre."""
    p: Any = loop_place(g, geometry, saddle, y, turned)
    k, c, d, X, Z = 4 / g["n2"], g["c"], g["d"], p.u + g["X"], p.v + g["Z"]
    return Place(-p.u, -p.v, -p.ut, -p.uy, -p.vt, -p.vy, p.phi + k * (d * Z - c * X),
                 p.phi_t + k * (d * p.vt - c * p.ut), p.phi_y + k * (d * p.vy - c * p.uy))


def far_place(numbers, g, reach, flip, t, y) -> Place:
    """On a hyperbola's loops in xi and y."""
    G, mu, d, k = g["G"], flip * g["mu"], flip * g["d"], 2 / g["n2"]
    e1, e2 = (g["c"] + d) / 2, (d - g["c"]) / 2
    xi, less = g["X"] + flip * g["Z"] + t, (-y).exp()
    r = xi * less
    r0, E0 = (numbers.ball(v) for v in reach.exact[:2])
    if reach.line is not None:
        E1 = numbers.ball(reach.exact[2])
        E = E0 + E1 * (r - r0)
    else:
        rate0 = G * E0 / 2 - e2 if reach.tube is None else G * 0
        lift = (r - r0) * (G * (r + r0) / 4 + e1)
        square = rate0 * rate0 + G * lift
        rate = square.sqrt() if reach.rising > 0 else -square.sqrt()
        E, E1 = E0 + 2 * lift / (rate + rate0), (G * r / 2 + e1) / rate
    eta = E * less
    eta_t, eta_y = E1 * less * less, -(E + r * E1) * less
    own = G * r / 4 + e1 + E1 * (G * E / 4 - e2)
    pull_xi, pull_eta = G * xi / 4 + e1, G * eta / 4 - e2
    phi = (k * (mu * y + xi * (G * xi / 8 + e1) + eta * (G * eta / 8 - e2) - r * (G * r / 8 + e1)
                - E * (G * E / 8 - e2)))
    gap = eta - (g["X"] - flip * g["Z"])
    return Place((t + gap) / 2, flip * (t - gap) / 2, (1 + eta_t) / 2, eta_y / 2, flip * (1 - eta_t) / 2,
                 -flip * eta_y / 2,
                 phi, k * (pull_xi + pull_eta * eta_t - own * less), k * (mu + pull_eta * eta_y + own * r))


def turn_place(numbers, g, places, flip, t, y) -> Place:
    """On a hyperbola's loops by xi and the saddle, about the place where xi of these is stationary; places:
    (H, s0, r0) of `turn_chart`."""
    H, s0, r0 = map(numbers.ball, places)
    G, mu, d, k = g["G"], flip * g["mu"], flip * g["d"], 2 / g["n2"]
    e1, e2, xi = (g["c"] + d) / 2, (d - g["c"]) / 2, g["X"] + flip * g["Z"] + t
    s = s0 + y
    q = (1 + s * s / 4).sqrt()
    r, E, r1, E1 = r0 + H * y * (2 * s0
                                 + y), 2 * e2 / G - 2 * H * s * q, 2 * H * s, -2 * H * (1 + s * s / 2) / q
    eta, eta_t, eta_y = r * E / xi, -r * E / (xi * xi), (r1 * E + r * E1) / xi
    gap, pull = eta - (g["X"] - flip * g["Z"]), G * eta / 4 - e2
    phi = (k * (mu * (xi / r).log() + xi * (G * xi / 8 + e1) + eta * (G * eta / 8 - e2) - r * (G * r / 8 + e1)
                - E * (G * E / 8 - e2)))
    return Place((t + gap) / 2, flip * (t - gap) / 2, (1 + eta_t) / 2, eta_y / 2, flip * (1 - eta_t) / 2,
                 -flip * eta_y / 2, phi,
                 k * (mu / xi + G * xi / 4 + e1 + pull * eta_t),
                 k * (pull * eta_y - mu * r1 / r - (G * r / 4 + e1) * r1 - (G * E / 4 - e2) * E1))


def root_place(numbers, g, places, flip, t, y) -> Place:
    """On a hyperbola's loops about the place where xi is stationary; places: (H, s0, r0) of `turn_chart`."""
    H, s0, r0 = map(numbers.ball, places)
    G, mu, d, k = g["G"], flip * g["mu"], flip * g["d"], 2 / g["n2"]
    e1, e2 = (g["c"] + d) / 2, (d - g["c"]) / 2
    half = (-y / 2).exp()
    less, step, root = half * half, t * half, s0 / half if places[1] else t * 0
    s, grown = s0 + step, r0 / less if places[2] else t * 0
    q = (1 + s * s / 4).sqrt()
    first = -2 * H * (1 + s * s / 2) / q
    xi, xi_t, xi_y = grown + H * t * (2 * root + t), 2 * H * (root + t), grown + H * root * t
    r, r_t, r_y = r0 + H * step * (2 * s0 + step), 2 * H * s * half, -H * s * step
    E, E_t, E_y = 2 * e2 / G - 2 * H * s * q, first * half, -first * step / 2
    eta, eta_t, eta_y = E * less, E_t * less, (E_y - E) * less
    P, Q = xi - (g["X"] + flip * g["Z"]), eta - (g["X"] - flip * g["Z"])
    phi = (mu * y + xi * (G * xi / 8 + e1) + eta * (G * eta / 8 - e2) - r * (G * r / 8 + e1)
           - E * (G * E / 8 - e2))
    pulls = G * xi / 4 + e1, G * eta / 4 - e2, -(G * r / 4 + e1), -(G * E / 4 - e2)
    phi_t, phi_y = (sum(p * n for p, n in zip(pulls, slopes))
                    for slopes in ((xi_t, eta_t, r_t, E_t), (xi_y, eta_y, r_y, E_y)))
    return Place((P + Q) / 2, flip * (P - Q) / 2, (xi_t + eta_t) / 2, (xi_y + eta_y) / 2,
                 flip * (xi_t - eta_t) / 2, flip * (xi_y - eta_y) / 2,
                 k * phi, k * phi_t, k * (phi_y + mu))


def parabola_place(g, t, y) -> Place:
    """On the loops of a parabola."""
    kappa, a = g["kappa"], g["a"]
    N = t.exp() if a > 0 else -t.exp()
    s, half = g["K"] / N, kappa * a * y / 2
    lift = s + half
    phi = y * y * (a * N - lift * lift)
    phi_t, phi_y = y * y * (a * N + 2 * lift * s), 2 * y * (a * N - lift * lift) - y * y * kappa * a * lift
    u, v = s + 2 * half - g["u"], N - kappa * y * lift - g["v"]
    return Place(u / kappa, v / kappa, -s / kappa, a, (N + kappa * y * s) / kappa, -(s + 2 * half), phi,
                 phi_t, phi_y)


# --- The place of a hyperbola's branch of saddles at which xi = X + Z (or X - Z) is stationary, and the
# saddles about it
class Turn(NamedTuple):
    """The place t of a branch where xi = X + flip Z is stationary, and there h, H = flip h, xi = r and eta =
    E.

    With s = 2 sinh(tau/2), tau from that place, and q = sqrt(1 + s^2/4) the saddles are (r + H s^2, E - 2 H s
    q).
    """

    t: float
    h: Fraction
    H: Fraction
    r: Fraction
    E: Fraction

    @staticmethod
    def of(seen, curve, flip):
        """None where xi is monotone."""
        g = seen.exact
        square = flip * curve.K / g["G"]
        if square <= 0:
            return None
        h = curve.sign * sqrt_fraction(square)
        r = 2 * flip * h - (g["c"] + flip * g["d"]) / g["G"]
        r = Fraction(0) if flip in seen.touched and abs(r) < abs(h) else r
        return Turn(curve.to(abs(h)), h, flip * h, r, (flip * g["d"] - g["c"]) / g["G"])

    def s_of(self, h):
        """s at the place h of the branch, which has the sign of the turn's."""
        return (h - self.h) / (self.h * sqrt_fraction(h / self.h))


def eta_over(H, E, s):
    """Spans of E - 2 H s q and its first two derivatives over one of s."""
    s2 = s * s
    low = max(abs(s.m) - s.r, 0.0)
    least, most = math.sqrt(1 + 0.25 * low * low), math.sqrt(1 + 0.25 * (abs(s.m) + s.r) ** 2)
    q = Span(0.5 * (least + most), 0.5 * (most - least))
    over = q.inverse()
    return (-2 * H) * (s * q) + E, (-2 * H) * ((0.5 * s2 + 1)
                                               * over), (-0.5
                                                         * H) * (s * (0.5 * s2 + 3) * (over * over * over))
