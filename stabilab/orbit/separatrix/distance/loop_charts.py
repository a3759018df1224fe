"""Charts of a separatrix: loops about a saddle, whole turns, roots at a turning point.

A branch of the separatrix as a surface in two parameters: t along a curve of saddles, y along the loop of
each.

A saddle S(t) = (x, z) stands on the conic of equilibria; carried along its orbit by the offset y it is

    X = x C(y) + z S(y),  Z = z C(y) + e x S(y),   C, S = cos, sin (e = -1) or cosh, sinh (e = +1),

and the loop passes there with W^2 = phi = 2 (V_saddle - V) = 2 [mu (y - S) + b (G x^2 + c x + e d z) + G
dx^2/2], b = C - 1, dx = X - x. Derivatives along the orbit are phi_y = 2 F(X, Z), phi_yy = 2 F'(X, Z); across
it the saddle's own height is stationary, which leaves phi_t = 2 [(G X + c) X_t + e d Z_t - (G x + c) x_t - e
d z_t]. Values at a point come with a bound on their rounding; bounds of second derivatives over a box are
sums of sizes in floats.

Where a loop on a circle comes round to its saddle again, and where it passes opposite to it: charts with y
told from there.

On a circle much wider than the distance no doubles near pi and 2 pi tell its places apart. After a whole turn
a loop has the same place, and phi is less by 2 |mu| 2 pi/n^2. Opposite to the saddle the place (X, Z) is that
of the chart turned by pi: with (X', Z') = -(X, Z) and y from there

    phi = phi of the chart at (X', Z') + (2/n^2) [mu (y - y') - 2 c X' + 2 d Z'],

and its distance from the state is that of (X', Z') from the state's mirror image in the centre, from which
the branch of saddles is told.

Long loops of the saddles about a place of a hyperbola's branch at which xi is stationary, on an invariant
plane or beside it.

The saddles are r = r_T + H s^2, E = E_T - 2 H s q (`turn`): xi goes with the square of s. A loop is
at (xi, eta) = (r e^y, E e^-y) after a way y, so with s = s0 + sigma e^(-y/2)

    xi = r0 e^y + 2 H s0 sigma e^(y/2) + H sigma^2,  n^2 W^2/2 = mu y + u(xi, eta) - u(r, E),  u = G (xi^2 +
    eta^2)/8 + e1 xi - e2 eta,

which is regular in (sigma, y) as long as r_T e^y is no more than xi: where a fold stands on the plane, r_T =
s0 = 0, for all y. In xi the saddle would go with its root there, and the place on the branch would decide xi
by e^y.
"""
from __future__ import annotations

import math

from ...potential import force_at
from .bends import (
    Span,
    eta_over,
    loop_bends,
    loop_place,
    opposite_place,
    root_place,
    sharp_place,
    sharp_point,
    shrinking,
    turned,
    widened,
)
from .curves import UNIT, Point, Seen, gap_of, seen_as, square_of


class Chart:
    """One branch over a rectangle of (t, y)."""

    sharpest = False  # whether its points are exact in any case
    from_saddle = True  # whether y = 0 is the saddle, where phi and its slope vanish
    turns: float = 0  # turns from the saddle to y = 0, on circles

    def __init__(self, seen, curve, t, y):
        self.seen, self.curve, self.t, self.y, self.here = seen, curve, t, y, seen.plain

    def boxes(self):
        """The boxes (chart, t, half its length, y, half its length) to begin with; y = 0, the saddle, is at
        an edge."""
        (t0, t1), (y0, y1) = self.t, self.y
        for low, high in ((y0, min(y1, 0.0)), (max(y0, 0.0), y1)):
            if low < high:
                half = 0.5 * (high - low)
                yield self, 0.5 * (t0 + t1), 0.5 * (t1 - t0), low + half if high else -half, half

    def misses(self, t, dt, y, dy, upper):
        """Whether a box is farther than `upper` for certain, by a quicker look than a Taylor polynomial."""
        return False

    def holds(self, t, y):
        """Whether the point belongs to the branch."""
        return True

    def folded(self, t, dt, y, dy):
        """Whether the parameters may turn back over a box, so that no bound is known."""
        return False

    def steep(self, t, dt, y, dy):
        """Whether a box of which no bound is known is better halved in t."""
        return dt >= dy

    def on_branch(self, t, y):
        return self, t, y

    def at_one(self, t, y):
        """The same chart at one t alone, and the point there."""
        return Chart(self.seen, self.curve, (t, t), self.y), t, y

    def place(self, t, y):
        """(X, Z, W/n) in floats, X and Z less the state's."""
        at = self.curve.at(t)
        s, half = self.seen.geometry.turn(y)
        b = 2 * self.seen.e * half * half
        return at.u + at.x * b + at.z * s, at.v + at.z * b + self.seen.e * at.x * s, math.sqrt(
            max(self.point(t, y).phi, 0.0))

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
        # the squares of dx, with s^2 = e b (b + 2), are put to the terms in b: these are then as small as
        # their sum
        phi = (2 * (mu * lag + b * (x * p + e * z * r) + 0.5 * G * b * b * (x * x + e * z * z)
                    + G * b * s * x * z) / n2)
        force = force_at(G, c, d, mu, X, Z)
        phi_t = 2 * (b * ((p + G * x) * xt + e * d * zt) + G * dx * dxt) / n2  # p z_t + r x_t is zero
        off_phi = 2 * UNIT * (abs(mu * lag) + big_b * (sx * sp + sz * sr)
                              + 0.5 * abs(G) * big_b * big_b * (sx * sx + sz * sz)
                              + abs(G) * big_b * big_s * sx * sz) / n2
        off_u, off_v = UNIT * (su + sx * big_b + sz * big_s), UNIT * (sv + sz * big_b + sx * big_s)
        apart, off = square_of(u, v, off_u, off_v, a, b2)
        gap, off_w = gap_of(phi, off_phi, g["w"])
        mX, mZ, mXt, mZt = sx + abs(dx), sz + sz * big_b + sx * big_s, abs(xt) + abs(dxt), abs(zt * q) + abs(
            xt * s)
        ut, uy, vt, vy = (2 * UNIT * m for m in (mXt, mZ, mZt, mX))
        rough = (2 * a * (off_u * mXt + abs(u) * ut) + 2 * b2 * (off_v * mZt + abs(v) * vt),
                 2 * a * (off_u * mZ + abs(u) * uy) + 2 * b2 * (off_v * mX + abs(v) * vy),
                 4 * UNIT * (big_b * ((sp + abs(G) * sx) * abs(xt) + abs(d * zt))
                             + abs(G) * (sz * big_s + sx * big_b) * mXt) / n2,
                 4 * UNIT * (abs(mu) + abs(G) * mX * mZ + abs(c) * mZ + abs(d) * mX) / n2)
        return Point(apart, 2 * (a * u * Xt + b2 * v * Zt), 2 * (a * u * Z + b2 * v * e * X), phi, phi_t,
                     2 * force / n2, gap,
                     (off, off_phi, off_w), rough)

    def exact_point(self, t, y) -> Point:
        """The same with values to double accuracy, for exact t and y."""
        return sharp_point(self, t, y)

    def exact_place(self, t, y):
        """(X, Z, W/n) in floats, X and Z less the state's, for exact t and y."""
        return sharp_place(self, t, y)

    def sharp(self, numbers, g, t, y):
        return loop_place(g, self.seen.geometry, self.curve.sharp(numbers, g, t), y,
                          2 * self.turns * numbers.pi())

    @staticmethod
    def metric(g):
        """The squared lengths of the units of u and v."""
        return g["a"], g["b"]

    def bends(self, t, dt, y, dy):
        return loop_bends(self.seen, self.curve, t, dt, y, dy)


class OpenChart(Chart):
    """A branch whose loops are hyperbolas."""

    def misses(self, t, dt, y, dy, upper):
        """By the ranges of X + Z and X - Z alone: they grow and shrink like e^y, and a Taylor polynomial over
        a long way tells nothing."""
        g = self.here
        wide = upper * (1 / math.sqrt(g["a"]) + 1 / math.sqrt(g["b"])) * (1 + 1e-9)
        x, rx, z, rz = self.curve.over(t, dt)[:4]
        low, high = math.exp(y - dy), math.exp(y + dy)
        return (outside(x + z, rx + rz, low, high, g["X"] + g["Z"], wide)
                or outside(x - z, rx + rz, 1 / high, 1 / low, g["X"] - g["Z"], wide))


def outside(middle, radius, low, high, place, wide):
    """Whether all products of a number within the radius and a factor in [low, high] are farther than `wide`
    from the place."""
    least, most = middle - radius, middle + radius
    least, most = least * (low if least > 0 else high), most * (high if most > 0 else low)
    slack = 1e-12 * (abs(least) + abs(most) + abs(place))
    return least - slack > place + wide or most + slack < place - wide


class TurnedChart(Chart):
    """A branch beside the saddles, after a whole turn back."""

    from_saddle, turns = False, -1

    def on_branch(self, t, y):
        return Chart(self.seen, self.curve, self.t, (-2 * math.pi, 0.0)), t, y - 2 * math.pi


class OppositeChart(Chart):
    """A branch beside the places opposite to the saddles, after half a turn back; `seen` and the curve are of
    the state's mirror image."""

    from_saddle, turns = False, -0.5

    def on_branch(self, t, y):
        return _FromSaddle(self.seen, self.curve, self.t, self.y), t, y - math.pi

    def place(self, t, y):
        u, v, w = super().place(t, y)
        return -u, -v, w

    def point(self, t, y) -> Point:
        p, g = super().point(t, y), self.here
        c, d, k = g["c"], g["d"], 4 / g["n2"]
        at = self.curve.at(t)
        s, half = self.seen.geometry.turn(y)
        q = 1 - 2 * half * half
        X, Z, Xt, Zt = at.x * q + at.z * s, at.z * q - at.x * s, at.xt * q + at.zt * s, at.zt * q - at.xt * s
        phi = p.phi + k * (d * Z - c * X)
        C, D, size, slopes = abs(c), abs(d), at.sx + at.sz, abs(at.xt) + abs(at.zt)
        off_phi = p.off[1] + k * UNIT * (C + D) * size + UNIT * abs(p.phi)
        gap, off_w = gap_of(phi, off_phi, g["w"])
        rough = (*p.rough[:2], p.rough[2] + k * UNIT * (C + D) * slopes,
                 p.rough[3] + k * UNIT * (C + D) * size)
        return Point(p.apart, p.apart_t, p.apart_y, phi, p.phi_t + k * (d * Zt - c * Xt),
                     p.phi_y - k * (d * X + c * Z), gap,
                     (p.off[0], off_phi, off_w), rough)

    def sharp(self, numbers, g, t, y):
        return opposite_place(g, self.seen.geometry, self.curve.sharp(numbers, g, t), y, -numbers.pi())

    def bends(self, t, dt, y, dy):
        g = self.here
        c, d, k = g["c"], g["d"], 4 / g["n2"]
        x, rx, z, rz, x1, rx1, z1, rz1, x2, rx2, z2, rz2 = self.curve.over(t, dt)[:12]
        s, q, _, rs, rq = self.seen.geometry.turns(y, dy)
        turn = s, q, rs, rq
        X, rX, Z, rZ = turned(-1, turn, x, rx, z, rz)
        X1, rX1, Z1, rZ1 = turned(-1, turn, x1, rx1, z1, rz1)
        X2, rX2, Z2, rZ2 = turned(-1, turn, x2, rx2, z2, rz2)
        C, D = abs(c), abs(d)
        more = ((d * Z2 - c * X2, D * rZ2 + C * rX2), (-d * X1 - c * Z1, D * rX1 + C * rZ1),
                (c * X - d * Z, C * rX + D * rZ))
        own = loop_bends(self.seen, self.curve, t, dt, y, dy)
        return (*own[:3], *widened((m + k * n, r + k * o + 1e-15 * k * abs(n)) for (m, r),
                                   (n, o) in zip(own[3:], more)))


class _FromSaddle(Chart):
    """The loops of the opposite chart from their saddles on, which a shade asks for phi."""

    def at_one(self, t, y):
        return OppositeChart(self.seen, self.curve, (t, t), self.y), t, y + math.pi


def mirrored(seen: Seen) -> Seen:
    """The reduction seen from the state's mirror image in the centre of the circles."""
    return seen_as(seen.geometry, seen.exact | {"X": -seen.exact["X"], "Z": -seen.exact["Z"]}, seen.touched)


class RootChart(Chart):
    """sigma as t and the way y; flip: -1 in the mirror image, where eta takes the place of xi."""

    from_saddle = False

    def __init__(self, seen, turn, ends, flip, upper, y, most):
        """ends: the least and greatest s, and that of the two, or zero, which sigma is told from (Fractions);
        upper: distances that matter; most: the greatest |s e^(y/2)| that does."""
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
        wide = (self.wide * min(1.0,
                                upper * (1 / math.sqrt(self.here["a"]) + 1 / math.sqrt(self.here["b"]))
                                * (1 + 1e-9) / self.wide))
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
        xi_size = (abs(grown) + abs(H * t) * (2 * abs(root) + abs(t)), 2 * abs(H) * (abs(root) + abs(t)),
                   abs(grown) + abs(H * root * t))
        r = r0 + H * step * (2 * s0 + step), 2 * H * s * half, -H * s * step
        s_size = abs(s0) + abs(step)
        r_size = abs(r0) + abs(H * step) * (abs(s0)
                                            + s_size), 2 * abs(H) * s_size * half, abs(H * step) * s_size
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
        phi, phi_t, phi_y, off_phi, rough_t, rough_y = self.mu * y, 0.0, self.mu, abs(self.mu * y), 0.0, abs(
            self.mu)
        for sign, e, value, size in ((1, e1, xi, xi_size), (1, -e2, eta, eta_size), (-1, e1, r, r_size),
                                     (-1, -e2, E, E_size)):
            pull, steep = 0.25 * G * value[0] + e, abs(G) * size[0] + abs(e)
            phi += sign * value[0] * (0.125 * G * value[0] + e)
            phi_t, phi_y = phi_t + sign * pull * value[1], phi_y + sign * pull * value[2]
            off_phi += 2 * size[0] * steep
            rough_t, rough_y = rough_t + 2 * steep * size[1], rough_y + 2 * steep * size[2]
        phi, off_phi = k * phi, k * UNIT * off_phi
        gap, off_w = gap_of(phi, off_phi, g["w"])
        wide, share = a * abs(u) + b * abs(v), (a + b) * (off_P + off_Q)
        rough = tuple(share * (abs(xi[n]) + abs(eta[n])) + 2 * UNIT * wide * (xi_size[n] + eta_size[n])
                      for n in (1, 2))
        return Point(apart, a * u * (xi[1] + eta[1]) + b * v * (xi[1] - eta[1]),
                     a * u * (xi[2] + eta[2]) + b * v * (xi[2] - eta[2]),
                     phi, k * phi_t, k * phi_y, gap, (off, off_phi, off_w),
                     (*rough, k * UNIT * rough_t, k * UNIT * rough_y))

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
        xi = (grown + 2 * mixed + H * (more * more), (2 * H) * (root + more), grown + mixed, Span(2 * H),
              H * root, grown + 0.5 * mixed)
        both = H * (s0 * step)
        square = H * (step * step)
        r = (2 * both + square + r0, (2 * H) * (s * half), -both - square, (2 * H) * less,
             -(H * ((s + step) * half)), 0.5 * both + square)
        eta, first, second = eta_over(H, self.E, s)
        pulled = second * step
        E = (eta, first * half, -0.5 * (first * step), second * less, -0.5 * ((pulled + first) * half),
             0.25 * ((pulled + first) * step))
        return s, xi, r, E, less

    def bends(self, t, dt, y, dy):
        g = self.here
        G, e1, e2, k, a, b = g["G"], self.e1, self.e2, 2 / g["n2"], g["a"], g["b"]
        _, xi, r, E, less = self._spans(t, dt, y, dy)
        eta = (E[0] * less, E[1] * less, (E[2] - E[0]) * less, E[3] * less, (E[4] - E[1]) * less,
               (E[5] - 2 * E[2] + E[0]) * less)
        P, Q = xi[0] - self.xi0, eta[0] - self.eta0
        u, v = 0.5 * (P + Q), 0.5 * (P - Q)
        x, z = [0.5 * (m + n) for m, n in zip(xi, eta)], [0.5 * (m - n) for m, n in zip(xi, eta)]
        apart = [(2 * a) * (x[m] * x[n] + u * x[at]) + (2 * b) * (z[m] * z[n] + v * z[at]) for m, n,
                 at in SECOND]
        phi = [Span(0.0) for _ in SECOND]
        for sign, e, value in ((1, e1, xi), (1, -e2, eta), (-1, e1, r), (-1, -e2, E)):
            pull = 0.25 * G * value[0] + e
            phi = [sum_ + sign * (pull * value[at] + (0.25 * G) * (value[m] * value[n])) for sum_,
                   (m, n, at) in zip(phi, SECOND)]
        return tuple(n.pair() for n in (*apart, *(k * one for one in phi)))


# of what is listed by derivatives: the two slopes and the place of their derivative
SECOND = (1, 1, 3), (1, 2, 4), (2, 2, 5)
