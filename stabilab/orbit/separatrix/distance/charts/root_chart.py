"""Long loops of the saddles about a place of a hyperbola's branch at which xi is stationary, on an invariant plane or beside it.

The saddles are r = r_T + H s^2, E = E_T - 2 H s q (`turn`): xi goes with the square of s. A loop is
at (xi, eta) = (r e^y, E e^-y) after a way y, so with s = s0 + sigma e^(-y/2)

    xi = r0 e^y + 2 H s0 sigma e^(y/2) + H sigma^2,  n^2 W^2/2 = mu y + u(xi, eta) - u(r, E),  u = G (xi^2 + eta^2)/8 + e1 xi - e2 eta,

which is regular in (sigma, y) as long as r_T e^y is no more than xi: where a fold stands on the plane, r_T = s0 = 0, for all y. In
xi the saddle would go with its root there, and the place on the branch would decide xi by e^y.
"""
from __future__ import annotations

import math

from ..point import UNIT, Point, gap_of, square_of
from .bends import Span, shrinking
from .loop_chart import Chart
from .sharp import root_place
from .turn import eta_over


class RootChart(Chart):
    """sigma as t and the way y; flip: -1 in the mirror image, where eta takes the place of xi."""

    from_saddle = False

    def __init__(self, seen, turn, ends, flip, upper, y, most):
        """ends: the least and greatest s, and that of the two, or zero, which sigma is told from (Fractions); upper: distances that
        matter; most: the greatest |s e^(y/2)| that does."""
        g, exact = seen.plain, seen.exact
        super().__init__(seen, None, (0.0, 0.0), y)
        self.flip, self.mu, d = flip, flip * g["mu"], flip * g["d"]
        self.e1, self.e2 = 0.5 * (g["c"] + d), 0.5 * (d - g["c"])
        low, high, s0 = ends
        r0 = turn.r + turn.H * s0 * s0
        self.places = turn.H, s0, r0
        self.H, self.s0, self.r0 = map(float, self.places)
        self.least, self.most = float(low), float(high)
        self.E = float(turn.E)
        self.xi0, self.eta0 = float(exact["X"] + flip * exact["Z"]), float(exact["X"] - flip * exact["Z"])
        self.wide = upper * (1 / math.sqrt(g["a"]) + 1 / math.sqrt(g["b"])) * (1 + 1e-9)
        self.t = self._range(float(low - s0), float(high - s0), float(turn.r), most)

    def _range(self, low, high, r, most):
        """The sigmas that matter."""
        end = self.y[1]
        gone = abs(r) * math.exp(end) if r else 0.0
        shift = abs(self.s0) * math.exp(0.5 * end) if self.s0 else 0.0
        far = (min(most, math.sqrt((abs(self.xi0) + self.wide + gone) / abs(self.H))) + shift) * (1 + 1e-9)
        grown = math.exp(0.5 * min(end, 1400.0))
        return max(low * grown, -far) if low else 0.0, min(high * grown, far) if high else 0.0

    def boxes(self):
        (t0, t1), (y0, y1) = self.t, self.y
        sides = [(a, b) for a, b in ((t0, min(t1, 0.0)), (max(t0, 0.0), t1)) if a < b]
        while y0 < y1:
            last = min(4 * y0, y1)
            for a, b in sides:
                yield self, 0.5 * (a + b), 0.5 * (b - a), 0.5 * (y0 + last), 0.5 * (last - y0)
            y0 = last

    def holds(self, t, y):
        return self.least <= self.s0 + t * math.exp(-0.5 * y) <= self.most

    def misses(self, t, dt, y, dy, upper):
        """Whether a box holds no saddle's loop, or is farther than `upper` in xi or eta for certain."""
        s, xi, _, E, less = self._spans(t, dt, y, dy)
        slack = 1e-12 * (abs(self.least) + abs(self.most))
        if s.m - s.r > self.most + slack or s.m + s.r < self.least - slack:
            return True
        wide = self.wide * min(1.0, upper * (1 / math.sqrt(self.here["a"]) + 1 / math.sqrt(self.here["b"])) * (1 + 1e-9) / self.wide)
        eta = E[0] * less
        return abs(xi[0].m - self.xi0) - xi[0].r > wide or abs(eta.m - self.eta0) - eta.r > wide

    def place(self, t, y):
        xi, eta = self._at(t, y)[:2]
        gap, lag = xi[0] - self.xi0, eta[0] - self.eta0
        return 0.5 * (gap + lag), self.flip * 0.5 * (gap - lag), math.sqrt(max(self.point(t, y).phi, 0.0))

    def _at(self, t, y):
        """xi, eta, r, E with their slopes in t and y, and the sizes of the terms of all three, in floats."""
        H, s0, r0, less, half = self.H, self.s0, self.r0, math.exp(-y), math.exp(-0.5 * y)
        grown, root = r0 * math.exp(y) if r0 else 0.0, s0 * math.exp(0.5 * y) if s0 else 0.0
        step = t * half
        s = s0 + step
        xi = grown + H * t * (2 * root + t), 2 * H * (root + t), grown + H * root * t
        xi_size = abs(grown) + abs(H * t) * (2 * abs(root) + abs(t)), 2 * abs(H) * (abs(root) + abs(t)), abs(grown) + abs(H * root * t)
        r = r0 + H * step * (2 * s0 + step), 2 * H * s * half, -H * s * step
        s_size = abs(s0) + abs(step)
        r_size = abs(r0) + abs(H * step) * (abs(s0) + s_size), 2 * abs(H) * s_size * half, abs(H * step) * s_size
        q = math.sqrt(1 + 0.25 * s * s)
        first = -2 * H * (1 + 0.5 * s * s) / q
        E = self.E - 2 * H * s * q, first * half, -0.5 * first * step
        E_size = abs(self.E) + 4 * abs(H) * s_size * q, 2 * abs(E[1]), 2 * abs(E[2])
        eta = E[0] * less, E[1] * less, (E[2] - E[0]) * less
        eta_size = E_size[0] * less, E_size[1] * less, (E_size[2] + E_size[0]) * less
        return xi, eta, r, E, xi_size, eta_size, r_size, E_size

    def point(self, t, y) -> Point:
        g = self.here
        G, e1, e2, k, a, b = g["G"], self.e1, self.e2, 2 / g["n2"], g["a"], g["b"]
        xi, eta, r, E, xi_size, eta_size, r_size, E_size = self._at(t, y)
        P, Q = xi[0] - self.xi0, eta[0] - self.eta0
        off_P, off_Q = UNIT * (xi_size[0] + abs(self.xi0)), UNIT * (eta_size[0] + abs(self.eta0))
        u, v = 0.5 * (P + Q), 0.5 * (P - Q)
        apart, off = square_of(u, v, 0.5 * (off_P + off_Q), 0.5 * (off_P + off_Q), a, b)
        phi, phi_t, phi_y, off_phi, rough_t, rough_y = self.mu * y, 0.0, self.mu, abs(self.mu * y), 0.0, abs(self.mu)
        for sign, e, value, size in ((1, e1, xi, xi_size), (1, -e2, eta, eta_size), (-1, e1, r, r_size), (-1, -e2, E, E_size)):
            pull, steep = 0.25 * G * value[0] + e, abs(G) * size[0] + abs(e)
            phi += sign * value[0] * (0.125 * G * value[0] + e)
            phi_t, phi_y = phi_t + sign * pull * value[1], phi_y + sign * pull * value[2]
            off_phi += 2 * size[0] * steep
            rough_t, rough_y = rough_t + 2 * steep * size[1], rough_y + 2 * steep * size[2]
        phi, off_phi = k * phi, k * UNIT * off_phi
        gap, off_w = gap_of(phi, off_phi, g["w"])
        wide, share = a * abs(u) + b * abs(v), (a + b) * (off_P + off_Q)
        rough = tuple(share * (abs(xi[n]) + abs(eta[n])) + 2 * UNIT * wide * (xi_size[n] + eta_size[n]) for n in (1, 2))
        return Point(apart, a * u * (xi[1] + eta[1]) + b * v * (xi[1] - eta[1]), a * u * (xi[2] + eta[2]) + b * v * (xi[2] - eta[2]),
                     phi, k * phi_t, k * phi_y, gap, (off, off_phi, off_w), (*rough, k * UNIT * rough_t, k * UNIT * rough_y))

    def sharp(self, numbers, g, t, y):
        return root_place(numbers, g, self.places, self.flip, t, y)

    def _spans(self, t, dt, y, dy):
        """s; xi, r and E with their first and second derivatives (t, y, tt, ty, yy); e^-y."""
        H, s0, r0, more = self.H, self.s0, self.r0, Span(t, dt)
        less, half = shrinking(y, dy), shrinking(0.5 * y, 0.5 * dy)
        step = more * half
        s = step + s0
        grown = shrinking(-y, dy) * r0 if r0 else Span(0.0)
        root = shrinking(-0.5 * y, 0.5 * dy) * s0 if s0 else Span(0.0)
        mixed = H * (root * more)
        xi = (grown + 2 * mixed + H * (more * more), (2 * H) * (root + more), grown + mixed, Span(2 * H), H * root, grown + 0.5 * mixed)
        both = H * (s0 * step)
        square = H * (step * step)
        r = (2 * both + square + r0, (2 * H) * (s * half), -both - square, (2 * H) * less, -(H * ((s + step) * half)), 0.5 * both + square)
        eta, first, second = eta_over(H, self.E, s)
        pulled = second * step
        E = (eta, first * half, -0.5 * (first * step), second * less, -0.5 * ((pulled + first) * half),
             0.25 * ((pulled + first) * step))
        return s, xi, r, E, less

    def bends(self, t, dt, y, dy):
        g = self.here
        G, e1, e2, k, a, b = g["G"], self.e1, self.e2, 2 / g["n2"], g["a"], g["b"]
        _, xi, r, E, less = self._spans(t, dt, y, dy)
        eta = (E[0] * less, E[1] * less, (E[2] - E[0]) * less, E[3] * less, (E[4] - E[1]) * less, (E[5] - 2 * E[2] + E[0]) * less)
        P, Q = xi[0] - self.xi0, eta[0] - self.eta0
        u, v = 0.5 * (P + Q), 0.5 * (P - Q)
        x, z = [0.5 * (m + n) for m, n in zip(xi, eta)], [0.5 * (m - n) for m, n in zip(xi, eta)]
        apart = [(2 * a) * (x[m] * x[n] + u * x[at]) + (2 * b) * (z[m] * z[n] + v * z[at]) for m, n, at in SECOND]
        phi = [Span(0.0) for _ in SECOND]
        for sign, e, value in ((1, e1, xi), (1, -e2, eta), (-1, e1, r), (-1, -e2, E)):
            pull = 0.25 * G * value[0] + e
            phi = [sum_ + sign * (pull * value[at] + (0.25 * G) * (value[m] * value[n])) for sum_, (m, n, at) in zip(phi, SECOND)]
        return tuple(n.pair() for n in (*apart, *(k * one for one in phi)))


SECOND = (1, 1, 3), (1, 2, 4), (2, 2, 5)  # of what is listed by derivatives: the two slopes and the place of their derivative

