"""Charts of loops that reach far: along the offset, along the turn, and which serves where.

Long loops of a hyperbola's saddles, which run beside an invariant plane, in coordinates in which they are
regular.

In xi = X + Z, eta = X - Z orbits are (xi e^y, eta e^-y). Along a branch on which xi is monotone the saddles
are (r, E(r)); after a way y the loop of r = xi e^-y is at (xi, E(r) e^-y), and with u = G (xi^2 + eta^2)/8 +
e1 xi - e2 eta

    n^2 W^2/2 = mu y + u(xi, eta) - u(r, E(r)),  G E^2/4 - e2 E = mu + G r^2/4 + e1 r.

In (xi, y) the branch is regular however long its loops are, while the place on the curve of saddles decides
xi by e^y, and terms of size e^2y would cancel. Where that curve meets the plane, r = 0, loops grow without
bound and the eta that is left is below e^-y: with a torque the branch is within e^(-n^2 W^2/2 mu) of the
plane eta = 0 at a rate W, never on it, but nearer than any number of digits tells. The branches
beside eta = 0 are those of the mirror image Z -> -Z, in which mu, d and the sense of the orbit change sign.

Long loops beside the saddle of a hyperbola's branch at which xi is stationary, by xi and the place on the
branch.

There neither is the place told by xi nor does the place alone tell a loop's far points well. With r(s), E(s)
the xi and eta of the saddles (`turn`), the loop of s passes xi after the way y = log(xi/r), at eta = r E/xi,
and

    n^2 W^2/2 = mu log(xi/r) + u(xi, eta) - u(r, E),  u = G (xi^2 + eta^2)/8 + e1 xi - e2 eta.

The charts of the loops of a hyperbola's branch of saddles: by the place on the branch near the saddle, by xi
or eta far along.

xi = x + z of a saddle is stationary along the hyperbola at h^2 = K/G, eta = x - z at h^2 = -K/G, and on a
line where its direction is theirs. Next to such a place the chart of the branch itself goes on as far as
loops reach.
"""
from __future__ import annotations

import math
from fractions import Fraction
from typing import NamedTuple

from .bends import Span, Turn, eta_over, far_place, shrinking, turn_place
from .curves import UNIT, Hyperbola, Point, gap_of, square_of
from .loop_charts import Chart, OpenChart, RootChart, outside


class Tube(NamedTuple):
    """About the turn of a branch, where xi = r is stationary and H = flip h: saddles that other charts have,
    all up to a depth |H| zone^2 up to the way `until`, then those whose xi is within |H| sigma^2 of r e^y,
    and from the way `turning` on those up to a depth |H| thin^2."""

    r: float
    H: float
    zone: float
    until: float
    sigma: float
    turning: float
    thin: float

    def past(self, xi, dxi, y, dy):
        """The least and the greatest xi - r e^y over a box, where they have the sign of H; by the size of H.
        """
        sign, swing = math.copysign(1.0, self.H), 4e-16 * (abs(xi) + dxi)
        low, high = sign * xi - dxi - swing, sign * xi + dxi + swing
        if not self.r:
            return low, high
        shift = sorted(sign * self.r * _grown(y + side * dy) * (1 + 1e-15 * side) for side in (-1, 1))
        return low - shift[1], high - shift[0]

    def depth(self, xi, dxi, y, dy):
        """The same of r e^-y less r, the depth in saddles: from that, or where e^y is beyond doubles from r
        itself."""
        sign = math.copysign(1.0, self.H)
        low, high = (end * math.exp((-dy if (end > 0) == (side < 0) else dy) - y) for side,
                     end in ((-1, sign * xi - dxi), (1, sign * xi + dxi)))
        swing, (least, most) = 1e-15 * (abs(low) + abs(high) + abs(self.r)), self.past(xi, dxi, y, dy)
        shed = math.exp(-y - dy), math.exp(dy - y)
        least, most = least * shed[least
                                   < 0] if least > -math.inf else least, most * shed[
                                       most > 0] if most < math.inf else most
        return max(low - sign * self.r - swing, least), min(high - sign * self.r + swing, most)

    def covers(self, past, y, dy):
        """Whether other charts have all saddles of a box; on the other side of r there are none."""
        low, high, most = y - dy, y + dy, max(past[1], 0.0) * (1 + 1e-9) / abs(self.H)
        return (most <= 0 or (low >= self.until or most <= self.zone**2 * math.exp(low))
                and (low >= self.turning or high <= self.until or most <= self.sigma**2)
                and (high <= self.turning or most <= self.thin**2 * _grown(max(low, self.turning))))


def _grown(y):
    return math.exp(y) if y < 700 else math.inf


class Reach(NamedTuple):
    """A piece of a branch on which xi is monotone: a saddle (r0, E0), in its middle or at a turn of the
    branch beside it, xi from low to high, the middle and radius of eta; line: the slope of E where the branch
    is straight, else None; exact: r0, E0 and line as Fractions; rising: the sign of G E/2 - e2 on it; tube:
    about a turn."""

    r0: float
    E0: float
    low: float
    high: float
    E: tuple[float, float]
    line: float | None
    exact: tuple
    rising: float
    tube: Tube | None = None


class FarChart(Chart):
    """xi (less the state's) and y over a rectangle, for the saddles of a reach; flip: -1 in the mirror image.
    """

    from_saddle = False

    def __init__(self, seen, reach, t, y, flip):
        super().__init__(seen, None, t, y)
        g, exact = self.here, seen.exact
        self.reach, self.flip, self.mu, d = reach, flip, flip * g["mu"], flip * g["d"]
        self.e1, self.e2 = 0.5 * (g["c"] + d), 0.5 * (d - g["c"])
        self.xi0, self.eta0 = float(exact["X"]
                                    + int(flip) * exact["Z"]), float(exact["X"] - int(flip) * exact["Z"])
        self.rate0 = 0.0 if reach.tube else 0.5 * g["G"] * reach.E0 - self.e2
        self.wide = 1 / math.sqrt(g["a"]) + 1 / math.sqrt(g["b"])

    def boxes(self):
        (t0, t1), (y0, y1) = self.t, self.y
        while y0 < y1:  # a way may be 1e20, and its beginning must not be lost in doubles
            last = min(4 * y0, y1)
            yield self, 0.5 * (t0 + t1), 0.5 * (t1 - t0), 0.5 * (y0 + last), 0.5 * (last - y0)
            y0 = last

    def misses(self, t, dt, y, dy, upper):
        """Whether a box holds no saddle's loop, or none that another chart does not cover, or is farther than
        `upper` in eta for certain."""
        tube = self.reach.tube
        if tube and tube.covers(tube.past(self.xi0 + t, dt, y, dy), y, dy):
            return True
        low, high = math.exp(-(y + dy)), math.exp(dy - y)
        middle, half = 0.5 * (self.reach.low + self.reach.high), 0.5 * (self.reach.high - self.reach.low)
        return (outside(self.xi0 + t, dt, low, high, middle, half * (1 + 1e-12))
                or outside(*self.reach.E, low, high, self.eta0, self.wide * upper * (1 + 1e-9)))

    def holds(self, t, y):
        return self.reach.low <= (self.xi0 + t) * math.exp(-y) <= self.reach.high

    def folded(self, t, dt, y, dy):
        """Whether xi may be stationary along the branch for a saddle of the box."""
        return self.reach.line is None and self._square(t, dt, y, dy)[0] <= 0

    def coarse(self, t, dt, y, dy):
        """A lower bound of the squared distance over a box by the ranges of xi, eta and W alone."""
        less, E, xi, g = shrinking(y, dy), Span(*self.reach.E), Span(self.xi0 + t, dt), self.here
        r = xi * less
        eta, gap = E * less, E * less - self.eta0
        u, v = 0.5 * (gap + Span(t, dt)), 0.5 * (Span(t, dt) - gap)
        eighth = 0.125 * g["G"]
        phi = (self.mu * Span(y, dy) + xi * (eighth * xi + self.e1) + eta * (eighth * eta - self.e2)
               - r * (eighth * r + self.e1)
               - E * (eighth * E - self.e2)) * (2 / g["n2"])
        if phi.m + phi.r < 0:
            return math.inf
        beside = max(math.sqrt(max(phi.m - phi.r, 0.0)) - g["w"], g["w"] - math.sqrt(phi.m + phi.r), 0.0)
        return (sum(w * max(abs(s.m) - s.r, 0.0) ** 2 for w, s in ((g["a"], u), (g["b"], v)))
                + beside * beside) * (1 - 1e-12)

    def steep(self, t, dt, y, dy):
        """Whether the saddle of a box moves more with xi than with y."""
        tube = self.reach.tube
        if not tube:
            return dt >= abs(self.xi0 + t) * dy
        return (dt >= (abs(tube.r) and abs(tube.r) * _grown(y + dy)) * dy
                and (dy < 0.5 or self.folded(t, dt, y, dy)))

    def place(self, t, y):
        less = math.exp(-y)
        gap = self._saddle((self.xi0 + t) * less)[0] * less - self.eta0
        return 0.5 * (t + gap), self.flip * 0.5 * (t - gap), math.sqrt(max(self.point(t, y).phi, 0.0))

    def root(self):
        """E of the saddle on the plane xi = 0."""
        return self._saddle(0.0)[0]

    def _lift(self, r):
        """(G r^2/4 + e1 r) less its value at r0."""
        return (r - self.reach.r0) * (0.25 * self.here["G"] * (r + self.reach.r0) + self.e1)

    def _saddle(self, r):
        """E, E', E'' at r, for floats."""
        G, (r0, E0), line = self.here["G"], self.reach[:2], self.reach.line
        if line is not None:
            return E0 + line * (r - r0), line, 0.0
        lift = self._lift(r)
        rate = math.copysign(math.sqrt(self.rate0 * self.rate0 + G * lift), self.reach.rising)
        first = (0.5 * G * r + self.e1) / rate
        return E0 + 2 * lift / (rate + self.rate0), first, 0.5 * G * (1 - first * first) / rate

    def point(self, t, y) -> Point:
        g, xi = self.here, self.xi0 + t
        G, e1, e2, k, a, b = g["G"], self.e1, self.e2, 2 / g["n2"], g["a"], g["b"]
        less = math.exp(-y)
        r = xi * less
        E, E1, E2 = self._saddle(r)
        eta = E * less
        eta_t, eta_y = E1 * less * less, -(E + r * E1) * less
        gap_eta = eta - self.eta0
        u, v = 0.5 * (t + gap_eta), 0.5 * (t - gap_eta)
        ut, uy, vt, vy = 0.5 * (1 + eta_t), 0.5 * eta_y, 0.5 * (1 - eta_t), -0.5 * eta_y
        pull_xi, pull_eta = 0.25 * G * xi + e1, 0.25 * G * eta - e2
        own = 0.25 * G * r + e1 + E1 * (0.25 * G * E - e2)
        phi = k * (self.mu * y + xi * (0.125 * G * xi + e1) + eta * (0.125 * G * eta - e2)
                   - r * (0.125 * G * r + e1) - E * (0.125 * G * E - e2))
        most, high, G1 = abs(self.xi0) + abs(t), abs(self.reach.E0) + abs(E), abs(G)
        off_E = UNIT * (high + abs(E1) * (most * less + abs(self.reach.r0)))
        tall = G1 * high + abs(e2)
        off_phi = (k * (UNIT * (abs(self.mu * y) + most * (G1 * (abs(xi) + most * less) + abs(e1))
                                + high * tall) + off_E * tall))
        off_u = UNIT * (abs(t) + abs(self.eta0) + abs(eta)) + off_E * less
        apart, off = square_of(u, v, off_u, off_u, a, b)
        gap, off_w = gap_of(phi, off_phi, g["w"])
        own_most, eta_most = G1 * most * less + abs(e1) + abs(E1) * tall, (
            high + most * less * (abs(E1) + abs(E2) * most * less)) * less
        off_eta = 8 * (UNIT * eta_most + off_E * less)
        change = 8 * UNIT * (abs(E1) + abs(E2) * most * less) * less * less
        share = off_u * (a + b) + (a * abs(u) + b * abs(v)) * UNIT
        rough = (share * (1 + abs(eta_t)) + (a * abs(u) + b * abs(v)) * change,
                 share * eta_most + (a * abs(u) + b * abs(v)) * off_eta,
                 8 * UNIT * k * (G1 * most + abs(e1) + (abs(e2) + G1 * abs(eta)) * abs(eta_t)
                                 + own_most * less)
                 + 8 * k * (abs(pull_eta) + tall) * change,
                 8 * k * (UNIT * (abs(self.mu) + tall * eta_most + own_most * most * less) + tall * off_eta))
        return Point(apart, 2 * (a * u * ut + b * v * vt), 2 * (a * u * uy + b * v * vy), phi,
                     k * (pull_xi + pull_eta * eta_t - own * less),
                     k * (self.mu + pull_eta * eta_y + own * r), gap,
                     (off, off_phi, off_w), rough)

    def sharp(self, numbers, g, t, y):
        return far_place(numbers, g, self.reach, self.flip, t, y)

    def _feet(self, t, dt, y, dy):
        """The xi of the saddles of a box."""
        return Span(self.xi0 + t, dt) * shrinking(y, dy)

    def bends(self, t, dt, y, dy):
        g, xi = self.here, Span(self.xi0 + t, dt)
        G, e1, e2, k, a, b = g["G"], self.e1, self.e2, 2 / g["n2"], g["a"], g["b"]
        less = shrinking(y, dy)
        r = xi * less
        E, E1, E2 = self._saddles(r, () if self.reach.line is not None else self._square(t, dt, y, dy))
        eta = E * less
        less2 = less * less
        eta_t, eta_y = E1 * less2, -((E + r * E1) * less)
        eta_tt, eta_ty = E2 * less * less2, -(less2 * (r * E2 + 2 * E1))
        eta_yy = less * (E + 3 * (r * E1) + r * r * E2)
        gap = eta - self.eta0
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

    def _square(self, t, dt, y, dy):
        """The least and the greatest square of the rate G E/2 - e2 over a box."""
        G, tube = self.here["G"], self.reach.tube
        if tube:  # G^2 d (H + d/4) for d = r - r_T
            (least, most), size = tube.depth(self.xi0 + t, dt, y, dy), abs(tube.H)
            if least <= 0:
                return 0.0, math.inf
            return G * G * least * (size + 0.25
                                    * least) * (1 - 1e-12), G * G * most * (size + 0.25 * most) * (1 + 1e-12)
        r = self._feet(t, dt, y, dy)
        middle, slope = self.rate0 * self.rate0 + G * self._lift(r.m), G * (0.5 * G * r.m + self.e1)
        swing = (abs(slope) * r.r + 0.25 * G * G * r.r * r.r
                 + 2.0**-40 * (self.rate0 * self.rate0 + abs(middle)))
        return middle - swing, middle + swing

    def _saddles(self, r, square):
        """E, E', E'' over a span of r; square: that of the rate there."""
        G, line = self.here["G"], self.reach.line
        if line is not None:
            return Span(self._saddle(r.m)[0], r.r), Span(line), Span(0.0)
        least, most = map(math.sqrt, square)
        sign, thin, wide = math.copysign(0.5, self.reach.rising), 1 / most, 1 / least
        rate, over = Span(sign * (least + most),
                          0.5 * (most - least)), Span(sign * (wide + thin), 0.5 * (wide - thin))
        E1 = (0.5 * G * r + self.e1) * over
        if self.reach.tube:  # E = 2 (rate + e2)/G
            E = (2 / G) * (rate + self.e2)
        else:
            E = Span(self._saddle(r.m)[0], (abs(E1.m) + E1.r) * r.r)
        return E, E1, (0.5 * G) * (1 - E1 * E1) * over


class TurnChart(Chart):
    """xi (less the state's) as t and s, less s0, as y; flip: -1 in the mirror image, where eta takes the
    place of xi."""

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
            yield self, 0.5 * (a
                               + b) - self.xi0, 0.5 * (b
                                                       - a) * (1 + 1e-15) + 1e-16 * abs(self.xi0), 0.5 * (
                                                           y0 + y1), 0.5 * (y1 - y0)

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
        return abs(self.r0) + abs(self.H * y) * (abs(self.s0)
                                                 + far), abs(self.E) + 4 * abs(self.H) * far * (1 + far)

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
        off_phi = (k * UNIT * (m1 * (2 + abs(math.log(xi / r)) + most / abs(xi) + thin / abs(r))
                               + most * steep + 4 * size * tall))
        off_eta = UNIT * thin * tall_E * (1 + most / abs(xi)) / abs(xi)
        off_u = UNIT * (abs(t) + abs(self.eta0)) + off_eta
        apart, off = square_of(u, v, off_u, off_u, a, b)
        gap, off_w = gap_of(phi, off_phi, g["w"])
        wide, along = a * abs(u) + b * abs(v), 2 * (abs(r1) * tall_E + thin * abs(E1)
                                                    + abs(self.H) * UNIT * tall_E) / abs(xi)
        rough = ((off_u * (a + b) + wide * UNIT) * (1 + abs(eta_t)) + wide * 4 * off_eta / abs(xi),
                 (off_u * (a + b) + wide * UNIT * (3 + most / abs(xi))) * along,
                 8 * k * (UNIT * (m1 / abs(xi) * (1 + most / abs(xi)) + G1 * most + abs(e1))
                          + (abs(pull_eta) + tall) * off_eta / abs(xi)),
                 8 * k * UNIT * ((abs(pull_eta) + tall) * along * (2 + most / abs(xi))
                                 + m1 * abs(r1 / r) * (1 + thin / abs(r)) + tall * turn))
        return Point(apart, a * u * (1 + eta_t) + b * v * (1 - eta_t), (a * u - b * v) * eta_y, phi,
                     k * (self.mu / xi + pull_xi + pull_eta * eta_t), k * (pull_eta * eta_y - own), gap,
                     (off, off_phi, off_w), rough)

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
        f_yy = (0.25 * G * (eta_y * eta_y) + pull * eta_yy - mu * (r2 * ebb - slow * slow)
                - 0.25 * G * (r1 * r1 + E1 * E1)
                - (0.25 * G * r + e1) * r2 - (0.25 * G * E - e2) * E2)
        return tuple(n.pair() for n in (tt, ty, yy, k * f_tt, k * f_ty, k * f_yy))


NEAR = 1.0  # the way along loops up to which the place on the branch is a good parameter
SHORT = 3.0  # loops that reach no farther need no other
ZONE = 0.25  # of s, about the log of h, beside the place where xi is stationary
SHARE = 1 / 64  # of the xi that matter: a tube about that place, as wide
NOWHERE = 1e-90  # of a place beside a plane: nearer makes no difference
ZERO = 1e-9  # of the parameter log|h|: what rounding leaves between a turn and a fold that are one
NO_END = 720.0  # e^-y is gone in doubles


def planes_met(seen, curve, low, high):
    """(distance, place) of the planes that the loops of a branch come exponentially near to, where the foot
    of the perpendicular is reached at the state's own rate after a way so long that nothing in doubles is
    left of eta."""
    for flip in (-1, 1):
        side = Side(seen, curve, flip, math.inf, low, high)
        yield from (found for a, b, turning in side.pieces() if not turning
                    and (found := side.on_plane(a, b)))


def loops_of(seen, curve, low, high, upper):
    """Charts of all loops of the branch t from low to high that may come within `upper` of the state."""
    ends, far = [], []
    for flip in (-1, 1):  # against the orbit eta grows, along it xi
        side = Side(seen, curve, flip, upper, low, high)
        way = side.way(low, high)
        ends.append(way if way <= SHORT else NEAR)
        if way > SHORT:
            far += side.charts()
    yield OpenChart(seen, curve, (low, high), (-ends[0], ends[1]))
    yield from far


class Side:
    """Loops along which xi = X + flip Z grows, of the branch t from low to high. turn: where xi is stationary
    on it or beside it, if anywhere; rooted: so near a plane that charts go with the root of xi there."""

    def __init__(self, seen, curve, flip, upper, low, high):
        self.seen, self.curve, self.flip, self.upper = seen, curve, flip, upper
        g = seen.plain
        self.wide = upper * (1 / math.sqrt(g["a"]) + 1 / math.sqrt(g["b"])) * (1 + 1e-9)
        self.most = abs(g["X"] + flip * g["Z"]) + self.wide
        turn = self._turn_of(flip)
        self.turn = turn if turn and low - ZONE < turn.t < high + ZONE else None
        self.tube = self._tube() if self.turn else None
        self.rooted = self.tube is not None
        if self.rooted and not turn.r:  # a fold on the plane, where the branch ends
            low, high = (turn.t if abs(end - turn.t) < ZERO else end for end in (low, high))
        self.low, self.high = low, high

    def _turn_of(self, flip):
        return Turn.of(self.seen, self.curve, flip) if isinstance(self.curve, Hyperbola) else None

    def way(self, low, high):
        """How far along the loops of a piece of the branch |xi| stays below what it is within `upper` of the
        state."""
        least = self._least(low, high)
        if not least:
            return math.inf
        return max(math.log(self.most / least), 0.0) + 0.01 if self.most else 0.01

    def charts(self):
        if self.rooted:
            yield from self._about_root()
        for a, b, turning in self.pieces():
            way = self.way(a, b)
            if way > NEAR and turning:
                yield from self._beside_turn(a, b, way)
            elif way > NEAR:
                reach = self._reach(a, b)
                end = NO_END if self.on_plane(a, b) else self._end(reach, way)
                if end > NEAR:
                    yield FarChart(self.seen, reach, (-self.wide, self.wide), (NEAR, end), self.flip)

    def _beside_turn(self, a, b, way):
        if self.turn is None:  # a line along which xi does not change
            way = min(way, max(math.log(self.most / NOWHERE), SHORT))
            yield OpenChart(self.seen, self.curve, (a, b), (-way, -NEAR) if self.flip < 0 else (NEAR, way))
            return
        yield from self._by_turn(*self._places(a, b), NEAR)

    def _places(self, a, b):
        """The least and greatest s of a piece, and the one of them next to the turn that s is told from, or
        zero."""
        turn = self.turn
        ends = [turn.s_of(turn.h if t == turn.t else self.curve.h_at(t)) for t in (a, b)]
        start = min(ends, key=abs)
        return *ends, start if abs(turn.H) * start * start <= abs(turn.r) else Fraction(0)

    def _by_turn(self, low, high, start, way):
        """The chart of saddles with s between two places, from a way on; xi has one sign there."""
        if not low < high:
            return
        turn = self.turn
        chart = TurnChart(self.seen, turn, (low, high, start), self.flip)
        values = [float(turn.r + turn.H * s * s) for s in (low, high, *([0] if low < 0 < high else []))]
        least = min(map(abs, values)) * math.exp(way) * (1 - 1e-9)
        ends = (max(chart.xi0 - self.wide, least), chart.xi0 + self.wide) if values[0] > 0 else (
            chart.xi0 - self.wide, min(chart.xi0 + self.wide, -least))
        if ends[0] < ends[1]:
            yield chart.over(*ends)

    def _about_root(self):
        """Charts of the saddles of the tube, where xi tells them badly: first, as long as eta still goes with
        the root of a small xi, a part of the branch, then those about the turn that xi is near for; when r
        e^y has become large beside that, xi and the place are good parameters."""
        turn, tube = self.turn, self.tube
        end = max(NO_END if self.on_plane(a, b) else self._end(self._reach(a, b), self.way(a, b)) for a, b,
                  _ in self.pieces())
        low, high, start = self._places(self.low, self.high)
        for y0, y1, most in ((NEAR, min(tube.until, end), tube.zone * math.exp(0.5 * tube.until)),
                             (tube.until, min(tube.turning, end), tube.sigma)):
            if y0 < y1:
                chart = RootChart(self.seen, turn, (low, high, start), self.flip, self.upper, (y0, y1), most)
                if chart.t[0] < chart.t[1]:
                    yield chart
        if tube.turning < end:
            thin = Fraction(tube.thin * (1 + 1e-9))
            yield from self._by_turn(max(low, -thin), min(high, thin), start, tube.turning)

    def _tube(self):
        """None where xi is far from the plane at the turn."""
        H, r = abs(float(self.turn.H)), abs(float(self.turn.r))
        if not self.most:
            return None
        sigma, thin = math.sqrt(SHARE * self.most / H), min(ZONE, math.sqrt(0.5 * r / H))
        turning = 2 * (math.log(sigma) - math.log(thin)) if r else math.inf
        if not (turning > NEAR and 8 * r < H):
            return None
        until = max(NEAR, math.log(H / self.most) / 3 + NEAR) if self.most < math.inf else NEAR
        return Tube(float(self.turn.r), float(self.turn.H), ZONE, until, sigma, max(turning, until), thin)

    def pieces(self):
        """(a, b, turning): the branch cut where xi is stationary, or beside such places if it is not near a
        plane there."""
        low, high, turn = self.low, self.high, self.turn
        if turn is None:
            return [(low, high, not self._moves())]
        # beside it xi stays above half of its value
        zone = 0.0 if self.rooted else min(ZONE, 2 * math.asinh(0.5 * math.sqrt(0.5 * abs(turn.r / turn.H))))
        a, b = max(low, turn.t - zone), min(high, turn.t + zone)
        return [piece for piece in ((low, min(a, high), False), (a, b, True), (max(b, low), high, False))
                if piece[0] < piece[1]]

    def _moves(self):
        """Whether xi changes along the branch at all."""
        if isinstance(self.curve, Hyperbola):
            return True
        dx, dz = self.curve.way
        return abs(dx + self.flip * dz) * 10**6 > abs(dx) + abs(dz)

    def _values(self, a, b, flip):
        """The least and the greatest X + flip Z of the saddles of a piece: where it ends in a fold beside a
        plane, how near decides."""
        values = [self._value(t, flip) for t in (a, b)]
        turn = self.turn if flip == self.flip else self._turn_of(flip)
        if turn and a < turn.t < b:
            values.append(float(turn.r))
        return min(values), max(values)

    def _value(self, t, flip):
        if self.turn and flip == self.flip and t == self.turn.t:
            return float(self.turn.r)
        x, z = self.curve.exact(t)
        return float(x + flip * z)

    def _least(self, a, b):
        low, high = self._values(a, b, self.flip)
        return max(low, -high, 0.0)

    def _reach(self, a, b):
        r, E = self._values(a, b, self.flip), self._values(a, b, -self.flip)
        E = (0.5 * (E[0] + E[1]), 0.5 * (E[1] - E[0]) + 1e-15 * (abs(E[0]) + abs(E[1])))
        t = 0.5 * (a + b)
        if self.rooted:  # G E/2 - e2 = -G H sinh(tau)
            rising = -self.turn.H * self.seen.exact["G"] * (1 if t > self.turn.t else -1)
            exact = self.turn.r, self.turn.E
            return Reach(*map(float, exact), *r, E, None, (*exact, None), float(rising), self.tube)
        x, z = self.curve.exact(t)
        exact, line = (x + self.flip * z, x - self.flip * z), None
        if not isinstance(self.curve, Hyperbola):
            dx, dz = self.curve.way
            line = (dx - self.flip * dz) / (dx + self.flip * dz)
        g = self.seen.exact
        return Reach(*map(float, exact), *r, E, None if line is None else float(line), (*exact, line),
                     float(g["G"] * exact[1] - self.flip * g["d"] + g["c"]))

    def on_plane(self, a, b):
        """(distance, place) of the foot on the plane eta = 0 if the loops of a monotone piece reach it there,
        else None."""
        g, flip = self.seen.plain, self.flip
        if not g["mu"] or self._least(a, b):
            return None
        reach = self._reach(a, b)
        chart = FarChart(self.seen, reach, (0.0, 0.0), (0.0, 0.0), flip)
        x = (g["a"] * g["X"] + flip * g["b"] * g["Z"]) / (g["a"] + g["b"])
        if reach.low < 0 < reach.high:
            E = chart.root()
        elif self.rooted and self.turn.t in (a,
                                             # loops on one side of it
                                             b) and not self.turn.r and x * self.turn.H >= 0:
            E = 2 * chart.e2 / g["G"]
        else:
            return None
        energy = (0.5 * g["n2"] * g["w"] ** 2 - x * (0.5 * g["G"] * x + 2 * chart.e1)
                  + E * (0.125 * g["G"] * E - chart.e2))
        if not (chart.mu > 0 and E * (0.5 * g["G"] * E - chart.e2) > 0 and energy > 1.01 * NO_END * chart.mu):
            return None
        apart = abs(chart.eta0) * math.sqrt(g["a"] * g["b"] / (g["a"] + g["b"]))
        return apart, (x - g["X"], flip * x - g["Z"], g["w"])

    def _end(self, reach, way):
        """The way beyond which W is too great, or none is left; NO_END where it makes no difference any more.
        """
        g = self.seen.plain
        mu, G, e = self.flip * g["mu"], abs(g["G"]), 0.5 * (abs(g["c"]) + abs(g["d"]))
        if not mu:
            return min(way, NO_END)
        tall = abs(reach.E[0]) + reach.E[1]
        other = 2 * self.most * (0.125 * G * self.most + e) + 2 * tall * (0.125 * G * tall + e)
        swing = 0.5 * g["n2"] * (g["w"] + self.upper) ** 2 if mu > 0 else 0.0
        return min(way, (swing + other) / abs(mu) * (1 + 1e-9) + 1)
