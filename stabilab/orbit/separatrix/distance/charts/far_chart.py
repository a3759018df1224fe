"""Long loops of a hyperbola's saddles, which run beside an invariant plane, in coordinates in which they are regular.

In xi = X + Z, eta = X - Z orbits are (xi e^y, eta e^-y). Along a branch on which xi is monotone the saddles are (r, E(r)); after
a way y the loop of r = xi e^-y is at (xi, E(r) e^-y), and with u = G (xi^2 + eta^2)/8 + e1 xi - e2 eta

    n^2 W^2/2 = mu y + u(xi, eta) - u(r, E(r)),  G E^2/4 - e2 E = mu + G r^2/4 + e1 r.

In (xi, y) the sheet is regular however long its loops are, while the place on the branch decides xi by e^y, and terms of size
e^2y would cancel. Where the branch meets the plane, r = 0, loops grow without bound and the eta that is left is below e^-y: with a torque
the sheet is within e^(-n^2 W^2/2 mu) of the plane eta = 0 at a rate W, never on it, but nearer than any number of digits tells.
The sheets beside eta = 0 are those of the mirror image Z -> -Z, in which mu, d and the sense of the orbit change sign.
"""
from __future__ import annotations

import math
from typing import NamedTuple

from ..point import UNIT, Point, gap_of, square_of
from .bends import Span, shrinking
from .loop_chart import Chart, outside
from .sharp import far_place


class Tube(NamedTuple):
    """About the turn of a branch, where xi = r is stationary and H = flip h: saddles that other charts have, all up to a depth |H| zone^2 up to the
    way `until`, then those whose xi is within |H| sigma^2 of r e^y, and from the way `turning` on those up to a depth |H| thin^2."""

    r: float
    H: float
    zone: float
    until: float
    sigma: float
    turning: float
    thin: float

    def past(self, xi, dxi, y, dy):
        """The least and the greatest xi - r e^y over a box, where they have the sign of H; by the size of H."""
        sign, swing = math.copysign(1.0, self.H), 4e-16 * (abs(xi) + dxi)
        low, high = sign * xi - dxi - swing, sign * xi + dxi + swing
        if not self.r:
            return low, high
        shift = sorted(sign * self.r * _grown(y + side * dy) * (1 + 1e-15 * side) for side in (-1, 1))
        return low - shift[1], high - shift[0]

    def depth(self, xi, dxi, y, dy):
        """The same of r e^-y less r, the depth in saddles: from that, or where e^y is beyond doubles from r itself."""
        sign = math.copysign(1.0, self.H)
        low, high = (end * math.exp((-dy if (end > 0) == (side < 0) else dy) - y) for side, end in ((-1, sign * xi - dxi), (1, sign * xi + dxi)))
        swing, (least, most) = 1e-15 * (abs(low) + abs(high) + abs(self.r)), self.past(xi, dxi, y, dy)
        shed = math.exp(-y - dy), math.exp(dy - y)
        least, most = least * shed[least < 0] if least > -math.inf else least, most * shed[most > 0] if most < math.inf else most
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
    """A piece of a branch on which xi is monotone: a saddle (r0, E0), in its middle or at a turn of the branch beside it, xi from low to
    high, the middle and radius of eta; line: the slope of E where the branch is straight, else None; exact: r0, E0 and line as Fractions; rising:
    the sign of G E/2 - e2 on it; tube: about a turn."""

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
    """xi (less the state's) and y over a rectangle, for the saddles of a reach; flip: -1 in the mirror image."""

    from_saddle = False

    def __init__(self, seen, reach, t, y, flip):
        super().__init__(seen, None, t, y)
        g, exact = self.here, seen.exact
        self.reach, self.flip, self.mu, d = reach, flip, flip * g["mu"], flip * g["d"]
        self.e1, self.e2 = 0.5 * (g["c"] + d), 0.5 * (d - g["c"])
        self.xi0, self.eta0 = float(exact["X"] + int(flip) * exact["Z"]), float(exact["X"] - int(flip) * exact["Z"])
        self.rate0 = 0.0 if reach.tube else 0.5 * g["G"] * reach.E0 - self.e2
        self.wide = 1 / math.sqrt(g["a"]) + 1 / math.sqrt(g["b"])

    def boxes(self):
        (t0, t1), (y0, y1) = self.t, self.y
        while y0 < y1:  # a way may be 1e20, and its beginning must not be lost in doubles
            last = min(4 * y0, y1)
            yield self, 0.5 * (t0 + t1), 0.5 * (t1 - t0), 0.5 * (y0 + last), 0.5 * (last - y0)
            y0 = last

    def misses(self, t, dt, y, dy, upper):
        """Whether a box holds no saddle's loop, or none that another chart does not cover, or is farther than `upper` in eta for certain."""
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
        phi = (self.mu * Span(y, dy) + xi * (eighth * xi + self.e1) + eta * (eighth * eta - self.e2) - r * (eighth * r + self.e1)
               - E * (eighth * E - self.e2)) * (2 / g["n2"])
        if phi.m + phi.r < 0:
            return math.inf
        beside = max(math.sqrt(max(phi.m - phi.r, 0.0)) - g["w"], g["w"] - math.sqrt(phi.m + phi.r), 0.0)
        return (sum(w * max(abs(s.m) - s.r, 0.0) ** 2 for w, s in ((g["a"], u), (g["b"], v))) + beside * beside) * (1 - 1e-12)

    def steep(self, t, dt, y, dy):
        """Whether the saddle of a box moves more with xi than with y."""
        tube = self.reach.tube
        if not tube:
            return dt >= abs(self.xi0 + t) * dy
        return dt >= (abs(tube.r) and abs(tube.r) * _grown(y + dy)) * dy and (dy < 0.5 or self.folded(t, dt, y, dy))

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
        off_phi = k * (UNIT * (abs(self.mu * y) + most * (G1 * (abs(xi) + most * less) + abs(e1)) + high * tall) + off_E * tall)
        off_u = UNIT * (abs(t) + abs(self.eta0) + abs(eta)) + off_E * less
        apart, off = square_of(u, v, off_u, off_u, a, b)
        gap, off_w = gap_of(phi, off_phi, g["w"])
        own_most, eta_most = G1 * most * less + abs(e1) + abs(E1) * tall, (high + most * less * (abs(E1) + abs(E2) * most * less)) * less
        off_eta = 8 * (UNIT * eta_most + off_E * less)
        change = 8 * UNIT * (abs(E1) + abs(E2) * most * less) * less * less
        share = off_u * (a + b) + (a * abs(u) + b * abs(v)) * UNIT
        rough = (share * (1 + abs(eta_t)) + (a * abs(u) + b * abs(v)) * change, share * eta_most + (a * abs(u) + b * abs(v)) * off_eta,
                 8 * UNIT * k * (G1 * most + abs(e1) + (abs(e2) + G1 * abs(eta)) * abs(eta_t) + own_most * less)
                 + 8 * k * (abs(pull_eta) + tall) * change,
                 8 * k * (UNIT * (abs(self.mu) + tall * eta_most + own_most * most * less) + tall * off_eta))
        return Point(apart, 2 * (a * u * ut + b * v * vt), 2 * (a * u * uy + b * v * vy), phi,
                     k * (pull_xi + pull_eta * eta_t - own * less), k * (self.mu + pull_eta * eta_y + own * r), gap,
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
            return G * G * least * (size + 0.25 * least) * (1 - 1e-12), G * G * most * (size + 0.25 * most) * (1 + 1e-12)
        r = self._feet(t, dt, y, dy)
        middle, slope = self.rate0 * self.rate0 + G * self._lift(r.m), G * (0.5 * G * r.m + self.e1)
        swing = abs(slope) * r.r + 0.25 * G * G * r.r * r.r + 2.0**-40 * (self.rate0 * self.rate0 + abs(middle))
        return middle - swing, middle + swing

    def _saddles(self, r, square):
        """E, E', E'' over a span of r; square: that of the rate there."""
        G, line = self.here["G"], self.reach.line
        if line is not None:
            return Span(self._saddle(r.m)[0], r.r), Span(line), Span(0.0)
        least, most = map(math.sqrt, square)
        sign, thin, wide = math.copysign(0.5, self.reach.rising), 1 / most, 1 / least
        rate, over = Span(sign * (least + most), 0.5 * (most - least)), Span(sign * (wide + thin), 0.5 * (wide - thin))
        E1 = (0.5 * G * r + self.e1) * over
        if self.reach.tube:  # E = 2 (rate + e2)/G
            E = (2 / G) * (rate + self.e2)
        else:
            E = Span(self._saddle(r.m)[0], (abs(E1.m) + E1.r) * r.r)
        return E, E1, (0.5 * G) * (1 - E1 * E1) * over
