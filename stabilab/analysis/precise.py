"""The same reduction in many digits, one state at a time: where doubles cannot decide, or would lose digits.

Everything is evaluated as it stands, without care for cancellation, at a precision that is doubled until the question
is settled: inputs (the state's doubles, the scene's rationals) are taken as exact.
"""
from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

MAX_DIGITS = 800


def _mp():
    from mpmath import mp
    return mp


class PreciseOrbit:
    """The orbit of one state in `digits` digits: V along it, its equilibria, margin, turning points, period."""

    def __init__(self, reduction, state, digits: int = 60):
        self.r, self.digits, self.state = reduction, digits, tuple(float(v) for v in state)
        self.mp = _mp().clone() if hasattr(_mp(), "clone") else _mp()
        self.mp.dps = digits
        self._set_up()

    def number(self, value):
        value = Fraction(value)
        return self.mp.mpf(value.numerator) / value.denominator

    def _set_up(self):
        r, mp, num = self.r, self.mp, self.number
        u, v = (Fraction(self.state[a]) for a in (r.j, r.k))
        w = Fraction(self.state[r.axis]) + r.s
        self.u, self.v = num(u), num(v)
        if r.e == 0:
            self.flip, self.w, self.mu = 1, num(w), num(r.m)
            force = r.kappa * u * v + r.rho * v + r.sigma * u + r.m
            a, b = r.p * v + r.p0, r.q * u + r.q0
            first = r.kappa * (a * v + u * b) + r.rho * b + r.sigma * a
            second = r.kappa * (2 * a * b + r.p * b * v + u * r.q * a) + r.rho * r.q * a + r.sigma * r.p * b
            third = 3 * r.kappa * (r.q * a * a + r.p * b * b)
            self.local = tuple(num(c) for c in (force, first, second, third))
            self.ab = num(a), num(b)
            return
        ap, aq, sp = abs(r.p), abs(r.q), 1 if r.p > 0 else -1
        rp, rq = mp.sqrt(num(ap)), mp.sqrt(num(aq))
        sj, sk = r.q0 / r.q, r.p0 / r.p
        torque = r.m + r.kappa * sj * sk - r.rho * sk - r.sigma * sj
        self.flip = -1 if torque < 0 else 1
        n = rp * rq
        self.n, self.rx, self.rz, self.sj, self.sk = n, rp, sp * rq, num(sj), num(sk)
        self.G = num(r.kappa * sp * ap * aq)
        self.c = self.flip * sp * num(r.rho - r.kappa * sj) * num(aq) * rp
        self.d = num(r.sigma - r.kappa * sk) * num(ap) * rq
        self.mu = self.flip * n * num(torque)
        self.x = self.flip * num(u + sj) / rp
        self.z = num(v + sk) / self.rz
        self.w = self.flip * n * num(w)
        self.on_plane = r.e > 0 and r.exact_invariant_sign(self.state) == 0
        if self.on_plane:  # the roots' rounding must not lift the orbit off its plane
            self.z = self.x if self.x * self.z > 0 else -self.x

    # --- the potential along the orbit, from the state: y = theta - theta_0
    def place(self, y):
        """(X, Z), or (omega_j, omega_k) for a parabola, at offset y."""
        mp = self.mp
        if self.r.e < 0:
            c, s = mp.cos(y), mp.sin(y)
            return self.x * c + self.z * s, self.z * c - self.x * s
        if self.r.e > 0:
            c, s = mp.cosh(y), mp.sinh(y)
            return self.x * c + self.z * s, self.z * c + self.x * s
        a, b = self.ab
        p, q = self.number(self.r.p), self.number(self.r.q)
        return self.u + y * (a + p * b * y / 2), self.v + y * (b + q * a * y / 2)

    def height(self, y):
        """V(theta_0 + y) - V(theta_0)."""
        if self.r.e == 0:
            f0, f1, f2, f3 = self.local
            return -y * (f0 + y * (f1 / 2 + y * (f2 / 6 + y * f3 / 24)))
        x, z = self.place(y)
        return (-self.mu * y - (x - self.x) * (self.G * (x + self.x) / 2 + self.c) - self.r.e * self.d * (z - self.z))

    def force(self, y):
        if self.r.e == 0:
            f0, f1, f2, f3 = self.local
            return f0 + y * (f1 + y * (f2 / 2 + y * f3 / 6))
        x, z = self.place(y)
        return self.mu + self.G * x * z + self.c * z + self.d * x

    def slope(self, y):
        if self.r.e == 0:
            _, f1, f2, f3 = self.local
            return f1 + y * (f2 + y * f3 / 2)
        x, z = self.place(y)
        return self.G * (z * z + self.r.e * x * x) + self.r.e * self.c * x + self.d * z

    @cached_property
    def critical(self) -> list:
        """Offsets of all equilibria on the orbit, ascending; elliptic: those in (0, 2 pi]."""
        mp = self.mp
        if self.r.e == 0:
            f0, f1, f2, f3 = self.local
            roots = self._real(self._roots([f3 / 6, f2 / 2, f1, f0]))
            return sorted(self._newton(y) for y in roots)
        i = mp.j if self.r.e < 0 else mp.mpf(1)
        x, z, e = self.x, self.z, self.r.e
        # F = a0 + a1 C + b1 S + a2 C2 + b2 S2 with X = x C + z S, Z = z C + e x S
        a1, b1 = self.c * z + self.d * x, self.c * e * x + self.d * z
        a2, b2 = self.G * x * z, self.G * (z * z + e * x * x) / 2
        a0 = self.mu
        poly = [a2 / 2 + b2 / (2 * i), a1 / 2 + b1 / (2 * i), a0, a1 / 2 - b1 / (2 * i), a2 / 2 - b2 / (2 * i)]
        found = []
        for root in self._roots(poly):
            if root == 0:
                continue
            if self.r.e < 0:
                if abs(abs(root) - 1) < mp.mpf(10) ** (-self.digits // 4):
                    y = mp.arg(root)
                    found.append(self._newton(y))
            else:
                if abs(mp.im(root)) <= abs(root) * mp.mpf(10) ** (-self.digits // 4) and mp.re(root) > 0:
                    found.append(self._newton(mp.log(mp.re(root))))
        if self.r.e < 0:
            turn = 2 * mp.pi
            found = [y - turn * mp.floor(y / turn) or turn for y in found]
        return sorted(found)

    def _roots(self, poly):
        mp = self.mp
        size = max((abs(a) for a in poly), default=0)
        poly = list(poly)
        while poly and abs(poly[0]) <= size * mp.mpf(10) ** (-2 * self.digits):
            poly.pop(0)
        while poly and abs(poly[-1]) <= size * mp.mpf(10) ** (-2 * self.digits):
            poly.pop()
        if len(poly) < 2:
            return []
        try:
            return mp.polyroots(poly, maxsteps=400, extraprec=8 * self.digits)
        except mp.NoConvergence:
            return mp.polyroots(poly, maxsteps=4000, extraprec=30 * self.digits)

    def _real(self, roots):
        mp = self.mp
        return [mp.re(y) for y in roots if abs(mp.im(y)) <= (abs(y) + mp.eps) * mp.mpf(10) ** (-self.digits // 4)]

    def _newton(self, y):
        for _ in range(3):
            slope = self.slope(y)
            if slope == 0:
                break
            step = self.force(y) / slope
            if abs(step) > 0.1:
                break
            y -= step
        return y

    def barriers(self):
        """Offsets of the maxima of V: on a circle those ahead within one turn, on a plane those ahead, else all."""
        ahead = self.r.e > 0 and self.on_plane
        return [y for y in self.critical if self.slope(y) > 0 and (y > 0 or not ahead)]

    @cached_property
    def energy(self):
        """E - V(theta_0) = W^2/2."""
        return self.w * self.w / 2

    @cached_property
    def margin(self):
        """Highest barrier ahead minus energy (elliptic), or the barrier nearest in height (else); None without one."""
        heights = [self.height(y) - self.energy for y in self.barriers()]
        if not heights:
            return None
        return max(heights) if self.r.e < 0 else min(heights, key=abs)

    @property
    def noise(self):
        """A bound, with room, on the rounding error of `margin` at this precision."""
        y = 2 * self.mp.pi
        sizes = [self.energy, abs(self.mu) * y]
        if self.r.e:
            size = abs(self.x) + abs(self.z)
            sizes += [abs(self.G) * size**2, (abs(self.c) + abs(self.d)) * size]
        else:
            sizes += [abs(self.height(y)) for y in self.barriers()]
        return sum(sizes) * self.mp.mpf(10) ** (4 - self.digits)


@dataclass(frozen=True)
class Tie:
    """Sign of a margin settled in many digits: sign 0 means that `digits` digits show no difference."""

    sign: int
    margin: float
    digits: int


def decide(reduction, state) -> Tie:
    """Sign of the margin of one state, doubling the digits until it is clear; sign -1 with margin -inf: no barrier."""
    digits = 40
    while True:
        orbit = PreciseOrbit(reduction, state, digits)
        margin = orbit.margin
        if margin is None:
            return Tie(-1, float("-inf"), digits)
        if abs(margin) > orbit.noise:
            return Tie(1 if margin > 0 else -1, float(margin), digits)
        if digits >= MAX_DIGITS:
            return Tie(0, 0.0, digits)
        digits *= 2
