"""The part of a sheet beside an invariant plane of the hyperbolic geometry, where loops grow without bound.

In xi = X + Z, eta = X - Z orbits are (xi e^y, eta e^-y). Beside a saddle S* = (0, eta*) on the plane xi = 0 saddles
(r, E(r)) stand on the conic, and their loops run far along it: after a way y the loop of r = xi e^-y is at (xi, E(r) e^-y). In
the coordinates (xi, y) the sheet is regular however long its loops are, and the eta that is left is below e^-y:

    n^2 W^2/2 = mu y + u(xi, eta) - u(r, E(r)),  u = G (xi^2 + eta^2)/8 + e1 xi - e2 eta.

So at a rate W the sheet is within e^(-n^2 W^2/2 mu) of the plane eta = 0: never on it, but nearer than any number of digits tells.
The sheets beside eta = 0 are those of the mirror image Z -> -Z, in which mu, d and the sense of the orbit change sign.
"""
from __future__ import annotations

import math

from .sheet_chart import EPS, ROUNDINGS, Chart, Point
from .spans import Span


class PlaneChart(Chart):
    """One saddle S* on a plane: xi (less the state's) and y over a rectangle; mirrored: S* on the plane eta = 0."""

    def __init__(self, seen, root, t, y, mirrored):
        super().__init__(seen, None, t, y)
        g = self.here
        flip = -1.0 if mirrored else 1.0
        self.mu, d, self.Z = flip * g["mu"], flip * g["d"], flip * g["Z"]
        self.e1, self.e2, self.flip, self.root = 0.5 * (g["c"] + d), 0.5 * (d - g["c"]), flip, root
        self.xi0 = g["X"] + self.Z

    def boxes(self):
        (t0, t1), (y0, y1) = self.t, self.y
        yield self, 0.5 * (t0 + t1), 0.5 * (t1 - t0), 0.5 * (y0 + y1), 0.5 * (y1 - y0)

    def misses(self, t, dt, y, dy, upper):
        return False

    def place(self, t, y):
        less = math.exp(-y)
        gap = self._saddle((self.xi0 + t) * less)[0] * less - (self.here["X"] - self.Z)
        return 0.5 * (t + gap), self.flip * 0.5 * (t - gap), math.sqrt(max(self.point(t, y).phi, 0.0))

    def _saddle(self, r):
        """E, E', E'' at r, for floats."""
        G, e1, e2 = self.here["G"], self.e1, self.e2
        # G/4 E^2 - e2 E - (mu + G r^2/4 + e1 r) = 0 on the branch of S*
        lift = r * (0.25 * G * r + e1)
        side = math.copysign(1.0, 0.5 * G * self.root - e2)
        rate = side * math.sqrt(max((0.5 * G * self.root - e2) ** 2 + G * lift, 0.0))
        E = self.root + 2 * lift / (rate + 0.5 * G * self.root - e2)
        first = (0.5 * G * r + e1) / rate  # F_eta = -rate
        return E, first, 0.5 * G * (1 - first * first) / rate

    def point(self, t, y) -> Point:
        g, xi = self.here, self.xi0 + t
        G, e1, e2, k, a, b = g["G"], self.e1, self.e2, 2 / g["n2"], g["a"], g["b"]
        less = math.exp(-y)
        r = xi * less
        E, E1, E2 = self._saddle(r)
        eta = E * less
        eta_t, eta_y = E1 * less * less, -(E + r * E1) * less
        gap_eta = eta - (g["X"] - self.Z)
        u, v = 0.5 * (t + gap_eta), 0.5 * (t - gap_eta)
        ut, uy, vt, vy = 0.5 * (1 + eta_t), 0.5 * eta_y, 0.5 * (1 - eta_t), -0.5 * eta_y
        pull_xi, pull_eta = 0.25 * G * xi + e1, 0.25 * G * eta - e2
        own = 0.25 * G * r + e1 + E1 * (0.25 * G * E - e2)
        phi = k * (self.mu * y + xi * (0.125 * G * xi + e1) + eta * (0.125 * G * eta - e2)
                   - r * (0.125 * G * r + e1) - E * (0.125 * G * E - e2))
        sizes = (abs(self.mu * y) + abs(xi) * (abs(G * xi) + abs(e1)) + abs(E) * (abs(G * E) + abs(e2))) * (1 + abs(E1))
        unit = ROUNDINGS * EPS
        off_phi, off_u = abs(k) * unit * sizes, unit * (abs(t) + abs(E) + abs(g["X"]) + abs(self.Z))
        apart = a * u * u + b * v * v
        off = off_u * (a * (2 * abs(u) + off_u) + b * (2 * abs(v) + off_u)) + 8 * EPS * apart
        w = math.sqrt(phi) if phi > 0 else 0.0
        off_w = min(off_phi / (w + 1e-300), math.sqrt(off_phi)) + 4 * EPS * (w + g["w"])
        return Point(apart, 2 * (a * u * ut + b * v * vt), 2 * (a * u * uy + b * v * vy), phi,
                     k * (pull_xi + pull_eta * eta_t - own * less), k * (self.mu + pull_eta * eta_y + own * r),
                     w - g["w"], (off, off_phi, off_w))

    def bends(self, t, dt, y, dy):
        g, xi = self.here, Span(self.xi0 + t, dt)
        G, e1, e2, k, a, b = g["G"], self.e1, self.e2, 2 / g["n2"], g["a"], g["b"]
        base = math.exp(-y)
        less = Span(base * math.cosh(dy), base * math.sinh(dy)) if dy < 600 else Span(0.5 * math.exp(dy - y), 0.5 * math.exp(dy - y))
        r = xi * less
        E, E1, E2 = self._saddles(r)
        eta = E * less
        less2 = less * less
        eta_t, eta_y = E1 * less2, -((E + r * E1) * less)
        eta_tt, eta_ty = E2 * less * less2, -(less2 * (r * E2 + 2 * E1))
        eta_yy = less * (E + 3 * (r * E1) + r * r * E2)
        gap = eta - (g["X"] - self.Z)
        u, v = 0.5 * (gap + t + Span(0.0, dt)), 0.5 * (Span(t, dt) - gap)
        ut, vt, uy = 0.5 * (1 + eta_t), 0.5 * (1 - eta_t), 0.5 * eta_y
        side = 0.5 * (a * u - b * v)
        tt = a * (ut * ut) + b * (vt * vt) + side * eta_tt
        ty = a * (ut * uy) - b * (vt * uy) + side * eta_ty
        yy = (a + b) * (uy * uy) + side * eta_yy
        pull = 0.25 * G * eta - e2
        own1 = 0.25 * G * r + e1 + E1 * (0.25 * G * E - e2)
        own2 = 0.25 * G * (1 + E1 * E1) + E2 * (0.25 * G * E - e2)
        f_tt = 0.25 * G * (1 + eta_t * eta_t) + pull * eta_tt - own2 * less2
        f_ty = 0.25 * G * (eta_t * eta_y) + pull * eta_ty + less * (own1 + r * own2)
        f_yy = 0.25 * G * (eta_y * eta_y) + pull * eta_yy - r * (own1 + r * own2)
        return tuple(n.pair() for n in (2 * tt, 2 * ty, 2 * yy, k * f_tt, k * f_ty, k * f_yy))

    def _saddles(self, r):
        """E, E', E'' over a span of r."""
        G, far = self.here["G"], abs(r.m) + r.r
        rate0 = 0.5 * G * self.root - self.e2
        change = far * (0.25 * abs(G) * far + abs(self.e1))
        square = rate0 * rate0 - abs(G) * change
        if not square > 0:
            return Span(0.0, math.inf), Span(0.0, math.inf), Span(0.0, math.inf)
        least = math.sqrt(square)
        most = math.sqrt(rate0 * rate0 + abs(G) * change)
        rate = Span(math.copysign(0.5 * (least + most), rate0), 0.5 * (most - least))
        over = rate.inverse()
        E1 = (0.5 * G * r + self.e1) * over
        return Span(self.root, 2 * change / (least + abs(rate0))), E1, (0.5 * G) * (1 - E1 * E1) * over


def plane_roots(g, mirrored):
    """eta of the saddles S* = (0, eta) on the plane xi = 0 (mirrored: xi of those on eta = 0)."""
    flip = -1.0 if mirrored else 1.0
    G, mu, e2 = g["G"], flip * g["mu"], 0.5 * (flip * g["d"] - g["c"])
    disc = e2 * e2 + G * mu
    if disc < 0 or not G:
        return []
    far = 0.5 * (e2 + math.copysign(math.sqrt(disc), e2))  # of G/4 eta^2 - e2 eta - mu = 0
    found = {4 * far / G, -mu / far if far else 0.0}
    return [eta for eta in found if eta * (0.5 * G * eta - e2) > 0]
