"""The loops of a branch of saddles as surfaces over two parameters, in balls: of a point the squared distance
R from a state in the plane of the orbit, and phi = W^2, with their derivatives.

On a circle, and near the saddle of a hyperbola, the parameters are the saddle's t and the offset y from it.
Farther along a hyperbola they are the saddle's t and xi = X + Z of the point, over places with |xi| >= |eta|,
eta = X - Z; its mirror image Z -> -Z, in which mu, d and the sense of the orbit change sign, covers the
others. With (r, E) the xi and eta of the saddle the
loop is at eta = Q/xi, Q = r E, after the offset y = log(xi/r), so

    n^2 W^2/2 = mu y + u(xi, eta) - u(r, E),  u = G (xi^2 + eta^2)/8 + e1 xi - e2 eta.

Where r vanishes along the branch, loops run on beside the plane eta = 0 without end and W grows like the root
of y: there the parameter of the saddles is tau, with t = t0 +- exp(-tau).

With two equal moments orbits are parabolas and the potential is a quartic. With D_k = D_i (p = 0, q = -kappa,
rho = -q0) let q = kappa omega_j + rho and N = kappa omega_k + sigma. Then q grows by kappa a y along the
orbit (a = p0), equilibria have q N = K := sigma rho - kappa m, and from a saddle (s, N), a N > s^2,

    W^2 = 2 (V_saddle - V) = y^2 [a N - (s + kappa a y/2)^2],  kappa omega_k + sigma = N - kappa s y - kappa^2
    a y^2/2.

So there is a separatrix wherever a is not zero: the valley of the quartic has a barrier between two wells for
all |N| beyond the fold |a| |N|^3 = K^2. With D_j = D_i instead the two components change roles.
"""
from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from .nearest import INF, SLACK, double, ends_of, halves, least_of

if TYPE_CHECKING:
    from flint import arb

OFFSET_CHART = 1.0  # offsets on hyperbolas up to which loops are parametrised by them


class Ranges(NamedTuple):
    """Over a box: the least R, the least and greatest phi; parts: what second derivatives are made of, None
    where nothing is known of them; side: 0 or 1, the one that is better halved then."""

    apart: float
    phi: tuple[float, float]
    parts: Any
    side: int = 0


class Chart:
    """Over t and y within a rectangle (each a least and a greatest ball); g: constants of the force and the
    metric and the state's place, as balls."""

    def __init__(self, g: Mapping[str, arb], curve: Hyperbola | Logarithmic | Straight | None,
                 t: Sequence[arb], y: Sequence[arb] | None):
        self.g, self.curve, self.t, self.y = g, curve, t, y

    def boxes(self):
        """(t, half of its range, y, half of its range) of the first boxes."""
        yield *middle_of(*self.t), *middle_of(*self.y)

    def halves(self, y: arb, dy: float):
        """The parts of the range of y of a box."""
        return halves(y, dy)

    def holds(self, t: arb, y: arb):
        """Whether there is a point."""
        return True


def middle_of(low: arb, high: arb):
    """The middle of an interval and half of its length."""
    return ((low + high) / 2).mid(), ends_of((high - low) / 2)[1]


class LoopChart(Chart):
    """On a circle (e = -1) or hyperbola (1); y: the offset from the saddle; curve: the saddles' (x, z) and
    their first and second derivatives in t."""

    def __init__(self, g: Mapping[str, arb], curve: Hyperbola | Straight, t: Sequence[arb],
                 y: Sequence[arb] | None, e: float):
        super().__init__(g, curve, t, y)
        self.e = e

    def boxes(self):
        """No longer than half a turn each."""
        t, (low, high) = middle_of(*self.t), self.y
        number = max(1, math.ceil(float((high - low).mid()) / math.pi - SLACK))
        step = (high - low) / number
        for n in range(number):
            yield *t, *middle_of(low + n * step, low + (n + 1) * step)

    def _moved(self, t: arb, y: arb):
        x, z, *slopes = self.curve.at(t)
        S, C = y.sin_cos() if self.e < 0 else y.sinh_cosh()
        return x, z, *slopes, S, C, x * C + z * S, z * C + self.e * x * S

    def _phi(self, y: arb, x: arb, z: arb, X: arb, Z: arb):
        g = self.g
        return g["k"] * (g["mu"] * y + (X - x) * (g["G"] * (X + x) / 2 + g["c"]) + self.e * g["d"] * (Z - z))

    def ranges(self, t: arb, y: arb, most: float):
        g, (x, z) = self.g, self.curve.at(t)[:2]
        if self.e < 0:
            beside = max(ends_of(abs((x * x + z * z).sqrt() - g["radius"]))[0], 0.0)
            if beside * beside * g["least"] > most:
                return None
        x, z, x1, z1, x2, z2, S, C, X, Z = parts = self._moved(t, y)
        u, v = X - g["X"], Z - g["Z"]
        apart = ends_of(g["a"] * u * u + g["b"] * v * v)[0]
        return None if apart > most else Ranges(apart, ends_of(self._phi(y, x, z, X, Z)), (*parts, u, v))

    def bends(self, parts: Sequence[arb]):
        x, z, x1, z1, x2, z2, S, C, X, Z, u, v = parts
        g, e = self.g, self.e
        G, c, d, a, b, k = g["G"], g["c"], g["d"], g["a"], g["b"], g["k"]
        less = C - 1
        dX, dX1, dX2, dZ2 = x * less + z * S, x1 * less + z1 * S, x2 * less + z2 * S, z2 * less + e * x2 * S
        X1, Z1, X2, Z2 = x1 + dX1, z1 * C + e * x1 * S, x2 + dX2, z2 + dZ2
        apart = (2 * (a * (X1 * X1 + u * X2) + b * (Z1 * Z1 + v * Z2)),
                 2 * (a * (X1 * Z + u * Z1) + e * b * (Z1 * X + v * X1)),
                 2 * (a * (Z * Z + e * u * X) + b * (X * X + e * v * Z)))
        along, across = G * X + c, G * Z + d
        phi = (k * (G * (dX1 * (X1 + x1) + dX * X2 + x * dX2) + c * dX2 + e * d * dZ2),
               k * (across * X1 + along * Z1), k * (Z * across + e * X * along))
        return tuple(map(double, apart)), tuple(map(double, phi))

    def point(self, t: arb, y: arb):
        x, z, x1, z1, _, _, S, C, X, Z = self._moved(t, y)
        g, e = self.g, self.e
        X1, Z1, u, v = x1 * C + z1 * S, z1 * C + e * x1 * S, X - g["X"], Z - g["Z"]
        au, bv, G, c, d, k = g["a"] * u, g["b"] * v, g["G"], g["c"], g["d"], g["k"]
        return (au * u + bv * v, 2 * (au * X1 + bv * Z1), 2 * (au * Z + e * bv * X), self._phi(y, x, z, X, Z),
                k * (G * (X * X1 - x * x1) + c * (X1 - x1) + e * d * (Z1 - z1)),
                k * (g["mu"] + G * X * Z + c * Z + d * X))

    def place(self, t: arb, y: arb):
        """(X, Z) less the state's."""
        X, Z = self._moved(t, y)[-2:]
        return X - self.g["X"], Z - self.g["Z"]


class HyperbolaChart(Chart):
    """curve: the saddles' (r, E) and their derivatives; y: |xi|; sign: that of xi; flip: -1 in the mirror
    image."""

    def __init__(self, g: Mapping[str, arb], curve: Logarithmic, t: Sequence[arb], y: Sequence[arb],
                 sign: int, flip: int):
        super().__init__(g, curve, t, y)
        self.sign, self.flip, self.mu = sign, flip, g["mu"] * flip
        self.torque, d = float(self.mu.mid()), g["d"] * flip
        self.e1, self.e2, self.quarter = (g["c"] + d) / 2, (d - g["c"]) / 2, g["G"] / 4
        self.xi0, self.eta0 = g["X"] + g["Z"] * flip, g["X"] - g["Z"] * flip
        self.far = abs(float(self.xi0.mid())) + abs(float(self.eta0.mid()))

    def boxes(self):
        """From xi = 0 a power of two wide, so that all parts begin there exactly; a curve without end in
        parts, so that doubles do not lose its beginning."""
        low, high = self.y
        half = 2.0 ** math.ceil(math.log2(float(high) / 2))
        y = middle_of(low, high) if low > 0 else (low + half, half)
        start, end = self.t
        length = 32.0 if self.curve.open else INF
        while start < end:
            last = min(start + length, end) if length < INF else end
            yield *middle_of(start, last), *y
            start, length = last, 4 * length

    def halves(self, y: arb, dy: float):
        """Next to xi = 0 the sizes of xi count."""
        smallest = float((y - dy).mid())
        power = round(math.log2(smallest / (smallest + 2 * dy)) / 2 - 0.5) if smallest > 0 else -8
        return halves(y, dy, 2.0 ** min(power, -1))

    def holds(self, t: arb, y: arb):
        return y > 0

    def _height(self, xi: arb, eta: arb):
        eighth = self.quarter / 2
        return xi * (eighth * xi + self.e1) + eta * (eighth * eta - self.e2)

    def ranges(self, t, y, most):
        from flint import arb
        r, E, *slopes = self.curve.at(t)
        low, high = ends_of(y)
        if r * self.sign < 0:  # orbits do not cross a plane
            return None
        xi, resolved = y * self.sign, y > 0
        eta = r * E / xi if resolved else None
        smallest, most_eta = ends_of(eta) if resolved else (-INF, INF)
        smallest, most_eta = max(smallest, 0.0 if E > 0 else -high), min(most_eta, 0.0 if E < 0 else high)
        if smallest > most_eta:
            return None
        about, half = 0.5 * (smallest + most_eta), 0.5 * (most_eta - smallest) * (1 + SLACK)
        apart = self._least_apart(xi, arb(about, half))
        if apart > most:
            return None
        close, far = self.curve.logarithms(t, r)
        low_log, high_log, (fallen, risen) = _log(low), _log(high), logarithms(abs(E))
        # of the offset log(xi/r) = log(E/eta)
        start, end = max(low_log - far, fallen - high_log), high_log - close
        # a `LoopChart` has what is near a saddle
        if start > end or -OFFSET_CHART <= start and end <= OFFSET_CHART:
            return None
        within = arb(self.sign * (low + high) / 2, (high - low) / 2)
        smallest, most = ends_of(self._height(within, arb(about, half)) - self._height(r, E))
        if self.torque:
            offsets = self.torque * start, self.torque * end
            smallest, most = smallest + min(offsets), most + max(offsets)
        parts = (r, E, *slopes, xi, eta) if resolved and (r * self.sign > 0 or not self.torque) else None
        if resolved:
            # far along a loop xi alone counts
            side = 1 if self.curve.open and half < 0.02 * (high - low) and high_log - low_log > 1 else 0
        else:  # until the box is small beside the way to the state, then until r and E do not vanish
            vanish = any(low == -INF and top > high_log - 8 for low, top in ((close, far), (fallen, risen)))
            side = 0 if self.torque and high < 0.01 * self.far and vanish else 1
        return Ranges(apart, self._scaled(smallest, most), parts, side)

    def _scaled(self, smallest: float, largest: float):
        """Of n^2 W^2/2 those of W^2."""
        k, off = self.g["rate"], SLACK * (abs(smallest) + abs(largest))
        if off < INF:
            return k * (smallest - off), k * (largest + off)
        return k * smallest if smallest == smallest else -INF, k * largest if largest == largest else INF

    def _least_apart(self, xi, eta):
        """The least R over ranges of xi and eta."""
        (p, dp), (q, dq) = double(xi - self.xi0), double(eta - self.eta0)
        u, v, (a, b) = 0.5 * (p + q), 0.5 * (p - q), self.g["metric"]
        own, mixed = (0.5 * (a + b), 0.0), (0.5 * (a - b), 0.0)
        return max(least_of(a * u * u + b * v * v, a * u + b * v, a * u - b * v, own, mixed, own,
                            dp * (1 + SLACK), dq * (1 + SLACK)), 0.0)

    def bends(self, parts: Sequence[arb]):
        r, E, r1, E1, r2, E2, xi, eta = parts
        g, quarter, over = self.g, self.quarter, 1 / xi
        a, b, k = g["a"], g["b"], g["k"]
        P, Q = xi - self.xi0, eta - self.eta0
        side = (a * (P + Q) - b * (P - Q)) / 2
        Q1, Q2 = r1 * E + r * E1, r2 * E + 2 * r1 * E1 + r * E2
        eta_t, eta_y = Q1 * over, -eta * over
        up, down = 1 + eta_y, 1 - eta_y
        apart = (eta_t * eta_t * (a + b) / 2 + Q2 * over * side,
                 eta_t * ((a * up - b * down) / 2 - over * side),
                 (a * up * up + b * down * down) / 2 - 2 * eta_y * over * side)
        pull, own = quarter * eta - self.e2, quarter * E - self.e2
        if self.torque:
            shed = 1 / r
            phi_tt = (Q2 * (pull * over - own * shed)
                      + Q1 * (quarter * (Q1 * over * over - E1 * shed) + own * r1 * shed * shed))
        else:
            phi_tt = (quarter * (eta_t * eta_t - r1 * r1 - E1 * E1) + pull * Q2 * over
                      - (quarter * r + self.e1) * r2 - own * E2)
        phi = (k * phi_tt, -k * Q1 * over * over * (pull + quarter * eta),
               k * (quarter * (1 + eta_y * eta_y) + (2 * eta * pull - self.mu) * over * over))
        return self._signed(apart), self._signed(phi)

    def _signed(self, bends: Sequence[arb]):
        """Of second derivatives in xi those in |xi|."""
        tt, ty, yy = map(double, bends)
        return tt, (self.sign * ty[0], ty[1]), yy

    def point(self, t: arb, y: arb):
        r, E, r1, E1, _, _ = self.curve.at(t)
        g, quarter, xi = self.g, self.quarter, y * self.sign
        over = 1 / xi
        a, b, k, eta = g["a"], g["b"], g["k"], r * E * over
        P, Q = xi - self.xi0, eta - self.eta0
        u, v = (P + Q) / 2, (P - Q) / 2
        eta_t, eta_y = (r1 * E + r * E1) * over, -eta * over
        pull = quarter * eta - self.e2
        phi = self._height(xi, eta) - self._height(r, E)
        phi_t = pull * eta_t - (quarter * r + self.e1) * r1 - (quarter * E - self.e2) * E1
        if self.torque:
            phi, phi_t = phi + self.mu * (xi / r).log(), phi_t - self.mu * r1 / r
        elif not r * self.sign > 0:
            phi = phi * 0 - 1
        phi_y = (self.mu + xi * (quarter * xi + self.e1) - eta * pull) * over
        apart_y = a * u * (1 + eta_y) + b * v * (1 - eta_y)
        return (a * u * u + b * v * v, eta_t * (a * u - b * v), apart_y * self.sign, k * phi, k * phi_t,
                k * phi_y * self.sign)

    def place(self, t: arb, y: arb):
        """(X, Z) less the state's."""
        r, E = self.curve.at(t)[:2]
        xi = y * self.sign
        P, Q = xi - self.xi0, r * E / xi - self.eta0
        return (P + Q) / 2, self.flip * (P - Q) / 2


def logarithms(size: arb):
    """The least and the greatest logarithm of a ball that is no negative number; of doubles those of small
    numbers are lost."""
    from flint import arb
    if size > 0:
        return ends_of(size.log())
    largest = arb(size.upper())
    return -INF, ends_of(largest.log())[1] if largest > 0 else -INF


def _log(v: float):
    return math.log(v) if v > 0 else -INF


class ParabolaChart(Chart):
    """t: log |N|, y: from the saddle along the loops of both sides."""

    def _parts(self, t: arb, y: arb):
        g = self.g
        N = t.exp() * g["sign"]
        s, half = g["K"] / N, g["ka"] * y / 2
        lift = s + half
        return N, s, half, lift, s + 2 * half - g["u"], N - g["kappa"] * y * lift - g["v"], y

    def ranges(self, t: arb, y: arb, most: float):
        N, _, _, lift, u, v, _ = parts = self._parts(t, y)
        g = self.g
        apart = ends_of((u * u + v * v) * g["k2"])[0]
        return None if apart > most else Ranges(apart, ends_of(y * y * (g["a"] * N - lift * lift)), parts)

    def bends(self, parts: Sequence[arb]):
        N, s, half, lift, u, v, y = parts
        g = self.g
        a, kappa, ka, twice = g["a"], g["kappa"], g["ka"], 2 * g["k2"]
        v_t, v_y, aN, y2 = N + kappa * y * s, -kappa * (s + 2 * half), a * N, y * y
        apart = (twice * (s * s + u * s + v_t * v_t + v * (N - kappa * y * s)),
                 twice * (v_t * v_y - s * ka + v * (kappa * s)),
                 twice * (ka * ka + v_y * v_y - v * (kappa * ka)))
        phi = (y2 * (aN - 2 * s * s - 2 * lift * s), 2 * y * (aN + 2 * lift * s) + y2 * (ka * s),
               2 * (aN - lift * lift) - 4 * ka * y * lift - y2 * (ka * ka) / 2)
        return tuple(map(double, apart)), tuple(map(double, phi))

    def point(self, t: arb, y: arb):
        N, s, half, lift, u, v, y = self._parts(t, y)
        g = self.g
        kappa, ka, twice, deep = g["kappa"], g["ka"], 2 * g["k2"], g["a"] * N - lift * lift
        v_t, v_y = N + kappa * y * s, -kappa * (s + 2 * half)
        return ((u * u + v * v) * g["k2"], twice * (v * v_t - u * s), twice * (u * ka + v * v_y),
                y * y * deep, y * y * (g["a"] * N + 2 * lift * s), 2 * y * deep - y * y * ka * lift)

    def place(self, t: arb, y: arb):
        """(first, second) rate less the state's."""
        u, v = self._parts(t, y)[4:6]
        return u / self.g["kappa"], v / self.g["kappa"]


# --- Curves of saddles
class Hyperbola:
    """Saddles x = k/h - c/G, z = h - d/G with h = sign exp(t)."""

    def __init__(self, g: Mapping[str, arb], sign: int):
        self.sign, self.k, self.x0, self.z0 = sign, sign * g["K"] / g["G"], g["c"] / g["G"], g["d"] / g["G"]

    def at(self, t: arb):
        """(x, z) with their first and second derivatives."""
        h, k = t.exp() * self.sign, (-t).exp() * self.k  # of a wide range no quotient is known
        return k - self.x0, h - self.z0, -k, h, k, h


class FromPoint:
    """A curve of saddles by (r, E), from a point of it."""

    open = False  # whether its parameter goes on without end, to where r vanishes
    touches = False  # whether r has a double zero there

    def logarithms(self, t, r):
        """The least and the greatest log |r| of its r over a range of t."""
        return logarithms(abs(r))


class Straight(FromPoint):
    """Saddles on a line, at a point of it plus t times its direction."""

    def __init__(self, base: Sequence[arb], direction: Sequence[arb]):
        self.base, self.direction = base, direction

    def at(self, t: arb):
        """As of `Hyperbola`."""
        (x, z), (dx, dz) = self.base, self.direction
        return x + t * dx, z + t * dz, dx, dz, 0 * t, 0 * t

    def seen_along(self, flip):
        """The line by (x + flip z, x - flip z)."""
        return Straight(*((p + flip * q, p - flip * q) for p, q in (self.base, self.direction)))


class FromAnchor(FromPoint):
    """The (r, E) of a hyperbola's saddles, r = x + flip z, at h = anchor exp(t); r0, E0: there. As flip h
    (rising) and k/h (falling) are separate, no digits of r are lost next to where it vanishes."""

    def __init__(self, rising: arb, falling: arb, r0: arb, E0: arb, touches: bool = False):
        self.rising, self.falling, self.r0, self.E0, self.touches = rising, falling, r0, E0, touches

    def at(self, t: arb):
        grown, shrunk = t.expm1(), (-t).expm1()
        up, down = self.rising * (grown + 1), self.falling * (shrunk + 1)
        more = grown * (self.rising - down)  # down - falling is -grown down
        return (self.r0 + more, self.E0 - self.rising * grown + self.falling * shrunk, up - down, -up - down,
                up + down, down - up)


class Logarithmic:
    """A curve at t0 + side exp(-t), in place of t."""

    open = True

    def __init__(self, curve: FromAnchor, side: int):
        self.curve, self.side = curve, side

    def logarithms(self, t: arb, r: arb):
        """By the slope between there and r = 0, where the range holds that in doubles."""
        if r != 0:
            return logarithms(abs(r))
        s = (-t).exp() * self.side
        slope, bend = self.curve.at(s.union(0 * s))[2::2]
        (smallest, top), (low, high) = logarithms(abs(bend / 2 if self.curve.touches else slope)), ends_of(t)
        order = 2 if self.curve.touches else 1
        return smallest - order * high, top - order * low

    def at(self, t: arb):
        s = (-t).exp() * self.side
        r, E, r1, E1, r2, E2 = self.curve.at(s)
        square = s * s
        return r, E, -s * r1, -s * E1, s * r1 + square * r2, s * E1 + square * E2
