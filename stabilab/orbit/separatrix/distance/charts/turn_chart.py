"""Long loops beside the saddle of a hyperbola's branch at which xi is stationary, by xi and the place on the branch.

There neither is the place told by xi nor does the place alone tell a loop's far points well. With r(s), E(s) the xi and eta of the saddles (`turn`), the
loop of s passes xi after the way y = log(xi/r), at eta = r E/xi, and

    n^2 W^2/2 = mu log(xi/r) + u(xi, eta) - u(r, E),  u = G (xi^2 + eta^2)/8 + e1 xi - e2 eta.
"""
from __future__ import annotations

import math

from ..point import UNIT, Point, gap_of, square_of
from .bends import Span
from .loop_chart import Chart
from .sharp import turn_place
from .turn import eta_over


class TurnChart(Chart):
    """xi (less the state's) as t and s, less s0, as y; flip: -1 in the mirror image, where eta takes the place of xi."""

    from_saddle = False

    def __init__(self, seen, turn, ends, flip):
        """ends: the least and greatest s, and that which y is told from (Fractions)."""
        low, high, s0 = ends
        super().__init__(seen, None, (0.0, 0.0), (float(low - s0), float(high - s0)))
        g, exact = self.here, seen.exact
        self.flip, self.mu, d = flip, flip * g["mu"], flip * g["d"]
        self.e1, self.e2 = 0.5 * (g["c"] + d), 0.5 * (d - g["c"])
        self.places = turn.H, s0, turn.r + turn.H * s0 * s0
        self.H, self.s0, self.r0 = map(float, self.places)
        self.E = float(turn.E)
        self.xi0, self.eta0 = float(exact["X"] + flip * exact["Z"]), float(exact["X"] - flip * exact["Z"])

    def over(self, low, high):
        """The chart over a range of xi."""
        self.t = low - self.xi0, high - self.xi0
        return self

    def boxes(self):
        (low, high), (y0, y1) = (self.t[0] + self.xi0, self.t[1] + self.xi0), self.y
        cuts = [low, high]
        near, far = sorted(cuts, key=abs)
        while abs(near * 4) < abs(far):  # slopes go with powers of 1/xi
            near *= 4
            cuts.append(near)
        cuts = sorted(cuts)
        for a, b in zip(cuts, cuts[1:]):
            yield self, 0.5 * (a + b) - self.xi0, 0.5 * (b - a) * (1 + 1e-15) + 1e-16 * abs(self.xi0), 0.5 * (y0 + y1), 0.5 * (y1 - y0)

    def misses(self, t, dt, y, dy, upper):
        return False

    def folded(self, t, dt, y, dy):
        """Whether r may vanish over a box."""
        r = self._branch(y, dy)[0]
        return abs(r.m) <= r.r or abs(self.xi0 + t) <= dt

    def coarse(self, t, dt, y, dy):
        return 0.0

    def steep(self, t, dt, y, dy):
        return abs(self.xi0 + t) <= dt

    def _branch(self, y, dy=0.0):
        """Spans of r, E and their first and second derivatives."""
        step, H = Span(y, dy), self.H
        s = step + self.s0
        E, E1, E2 = eta_over(H, self.E, s)
        return H * (step * (step + 2 * self.s0)) + self.r0, E, (2 * H) * s, E1, Span(2 * H), E2

    def _sizes(self, y):
        """The sizes of the terms of r and E."""
        far = abs(self.s0) + abs(y)
        return abs(self.r0) + abs(self.H * y) * (abs(self.s0) + far), abs(self.E) + 4 * abs(self.H) * far * (1 + far)

    def place(self, t, y):
        r, E = (n.m for n in self._branch(y)[:2])
        gap = r * E / (self.xi0 + t) - self.eta0
        return 0.5 * (t + gap), self.flip * 0.5 * (t - gap), math.sqrt(max(self.point(t, y).phi, 0.0))

    def point(self, t, y) -> Point:
        g, xi, (thin, tall_E) = self.here, self.xi0 + t, self._sizes(y)
        G, e1, e2, k, a, b = g["G"], self.e1, self.e2, 2 / g["n2"], g["a"], g["b"]
        r, E, r1, E1 = (n.m for n in self._branch(y)[:4])
        eta, eta_t, eta_y = r * E / xi, -r * E / (xi * xi), (r1 * E + r * E1) / xi
        gap_eta = eta - self.eta0
        u, v = 0.5 * (t + gap_eta), 0.5 * (t - gap_eta)
        pull_xi, pull_eta = 0.25 * G * xi + e1, 0.25 * G * eta - e2
        own = self.mu * r1 / r + (0.25 * G * r + e1) * r1 + (0.25 * G * E - e2) * E1
        phi = k * (self.mu * math.log(xi / r) + xi * (0.125 * G * xi + e1) + eta * (0.125 * G * eta - e2)
                   - r * (0.125 * G * r + e1) - E * (0.125 * G * E - e2))
        most, size, G1, m1 = abs(self.xi0) + abs(t), thin + tall_E, abs(G), abs(self.mu)
        steep, tall, turn = G1 * abs(xi) + abs(e1), G1 * size + abs(e2) + abs(e1), abs(r1) + abs(E1)
        off_phi = k * UNIT * (m1 * (2 + abs(math.log(xi / r)) + most / abs(xi) + thin / abs(r)) + most * steep + 4 * size * tall)
        off_eta = UNIT * thin * tall_E * (1 + most / abs(xi)) / abs(xi)
        off_u = UNIT * (abs(t) + abs(self.eta0)) + off_eta
        apart, off = square_of(u, v, off_u, off_u, a, b)
        gap, off_w = gap_of(phi, off_phi, g["w"])
        wide, along = a * abs(u) + b * abs(v), 2 * (abs(r1) * tall_E + thin * abs(E1) + abs(self.H) * UNIT * tall_E) / abs(xi)
        rough = ((off_u * (a + b) + wide * UNIT) * (1 + abs(eta_t)) + wide * 4 * off_eta / abs(xi),
                 (off_u * (a + b) + wide * UNIT * (3 + most / abs(xi))) * along,
                 8 * k * (UNIT * (m1 / abs(xi) * (1 + most / abs(xi)) + G1 * most + abs(e1)) + (abs(pull_eta) + tall) * off_eta / abs(xi)),
                 8 * k * UNIT * ((abs(pull_eta) + tall) * along * (2 + most / abs(xi)) + m1 * abs(r1 / r) * (1 + thin / abs(r)) + tall * turn))
        return Point(apart, a * u * (1 + eta_t) + b * v * (1 - eta_t), (a * u - b * v) * eta_y, phi,
                     k * (self.mu / xi + pull_xi + pull_eta * eta_t), k * (pull_eta * eta_y - own), gap, (off, off_phi, off_w), rough)

    def sharp(self, numbers, g, t, y):
        return turn_place(numbers, g, self.places, self.flip, t, y)

    def bends(self, t, dt, y, dy):
        g, xi = self.here, Span(self.xi0 + t, dt)
        G, e1, e2, k, a, b, mu = g["G"], self.e1, self.e2, 2 / g["n2"], g["a"], g["b"], self.mu
        r, E, r1, E1, r2, E2 = self._branch(y, dy)
        over, ebb = xi.inverse(), r.inverse()
        q, q1, q2 = r * E, r1 * E + r * E1, r2 * E + 2 * (r1 * E1) + r * E2
        eta, eta_t, eta_y = q * over, -(q * over * over), q1 * over
        eta_tt, eta_ty, eta_yy = 2 * (q * over * over * over), -(q1 * over * over), q2 * over
        gap = eta - self.eta0
        u, v = 0.5 * (gap + Span(t, dt)), 0.5 * (Span(t, dt) - gap)
        side = a * u - b * v
        tt = 0.5 * (a * ((1 + eta_t) * (1 + eta_t)) + b * ((1 - eta_t) * (1 - eta_t))) + side * eta_tt
        ty = 0.5 * (a * ((1 + eta_t) * eta_y) - b * ((1 - eta_t) * eta_y)) + side * eta_ty
        yy = (0.5 * (a + b)) * (eta_y * eta_y) + side * eta_yy
        pull, slow = 0.25 * G * eta - e2, r1 * ebb
        f_tt = 0.25 * G * (1 + eta_t * eta_t) - mu * (over * over) + pull * eta_tt
        f_ty = 0.25 * G * (eta_t * eta_y) + pull * eta_ty
        f_yy = (0.25 * G * (eta_y * eta_y) + pull * eta_yy - mu * (r2 * ebb - slow * slow) - 0.25 * G * (r1 * r1 + E1 * E1)
                - (0.25 * G * r + e1) * r2 - (0.25 * G * E - e2) * E2)
        return tuple(n.pair() for n in (tt, ty, yy, k * f_tt, k * f_ty, k * f_yy))
