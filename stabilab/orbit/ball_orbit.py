"""The reduced potential of one state in ball arithmetic: where doubles cannot decide, or would lose digits.

Inputs (the state's doubles or fractions, the scene's rationals) are exact; every number is a ball that surely holds the true
value (`balls`). The mechanics is the same for balls of doubles and of many digits.
"""
from __future__ import annotations

from fractions import Fraction
from functools import cached_property
from typing import NamedTuple

from ..numbers.balls import START_BITS, settled, sign
from ..numbers.double_ball import Unclear
from ..numbers.polynomial import Poly
from .potential import derivatives_on_parabola

MOST_BITS = 1 << 17  # where balls end
TIE_BITS = 4096  # with so many the extremes of a motion on the separatrix are worked out


class Spot(NamedTuple):
    """An equilibrium on the orbit at offset y. kind: +1 a maximum of V (barrier), -1 a minimum (well), 0 neither."""

    y: object
    kind: int


class Orbit:
    """The orbit of one state (three doubles or Fractions, taken exactly), built once in each kind of number that a question asks for."""

    def __init__(self, reduction, state):
        self.reduction, self.state, self._built = reduction, state, {}

    def settled(self, question, bits: int = START_BITS, most: int = MOST_BITS):
        """question(orbit) of its `BallOrbit`, as `balls.settled` asks: with more bits as long as it is `Unclear`."""
        return settled(lambda numbers: question(self._in(numbers)), bits, most)

    def _in(self, numbers):
        if numbers not in self._built:
            self._built[numbers] = BallOrbit(self.reduction, self.state, numbers)
        return self._built[numbers]


class BallOrbit:
    """The orbit of one state in balls: V along it as a function of the offset y = theta - theta_0, and its equilibria.

    numbers: the kind of ball that it computes in; to be used where that came from, inside `settled`.
    """

    def __init__(self, reduction, state, numbers):
        self.r, self.numbers = reduction, numbers
        r, ball = reduction, numbers.ball
        self.state = tuple(v if isinstance(v, Fraction) else float(v) for v in state)  # exact either way
        self.u, self.v = (Fraction(self.state[a]) for a in (r.j, r.k))
        speed = Fraction(self.state[r.axis]) + r.s
        self.force_here = r.kappa * self.u * self.v + r.rho * self.v + r.sigma * self.u + r.m  # exact
        if r.e == 0:
            self.flip, self.n, self.w, self.mu = 1, 1, ball(speed), ball(r.m)
            self.on_plane = False
            self._set_up_parabola()
        else:
            self._set_up_conic(speed)
        self.energy = self.w * self.w / 2  # E - V(theta_0)

    def _set_up_parabola(self):
        r, u, v, ball = self.r, self.u, self.v, self.numbers.ball
        a, b = r.p * v + r.p0, r.q * u + r.q0
        first, second, third = derivatives_on_parabola(r, u, v)
        self.taylor = self.force_here, first, second / 2, third / 6
        self.coefficients = [ball(c) for c in self.taylor]
        self.speeds = [ball(c) for c in (u, a, r.p * b / 2, v, b, r.q * a / 2)]

    def _set_up_conic(self, speed):
        r, ball = self.r, self.numbers.ball
        ap, aq, sp = abs(r.p), abs(r.q), 1 if r.p > 0 else -1
        rp, rq = ball(ap).sqrt(), ball(aq).sqrt()
        self.sj, self.sk = r.q0 / r.q, r.p0 / r.p
        torque = r.m + r.kappa * self.sj * self.sk - r.rho * self.sk - r.sigma * self.sj
        flip = self.flip = -1 if torque < 0 else 1
        self.n, self.rx, self.rz = rp * rq, flip * rp, sp * rq
        self.G = ball(r.kappa * sp * ap * aq)
        self.c = flip * sp * ball((r.rho - r.kappa * self.sj) * aq) * rp
        self.d = ball((r.sigma - r.kappa * self.sk) * ap) * rq
        self.mu = flip * self.n * ball(torque)
        self.w = flip * self.n * ball(speed)
        self.shift_j, self.shift_k = ball(self.sj), ball(self.sk)
        self.x, self.z = self._canonical(ball(self.u + self.sj), ball(self.v + self.sk))
        # the invariant Q = Z^2 - e X^2, exactly
        self.Q = (self.v + self.sk) ** 2 / aq - r.e * (self.u + self.sj) ** 2 / ap
        self.on_plane = r.e > 0 and self.Q == 0
        if r.e > 0:
            self.xi, self.eta = self._light_cone(self.x, self.z)

    def _canonical(self, u_shifted, v_shifted):
        return u_shifted / self.rx, v_shifted / self.rz

    def _light_cone(self, x, z):
        """(xi, eta); on an invariant plane the one that vanishes is exactly zero."""
        xi, eta = x + z, x - z
        if not self.on_plane or (x.is_zero() and z.is_zero()):
            return xi, eta
        if 0 in xi and 0 in eta:
            raise Unclear
        return (xi * 0, eta) if 0 in xi else (xi, eta * 0)

    # --- the potential along the orbit
    def place(self, y):
        """(X, Z), or (omega_j, omega_k) on a parabola, at offset y."""
        if self.r.e < 0:
            s, c = y.sin_cos()
            return self.x * c + self.z * s, self.z * c - self.x * s
        if self.r.e > 0:
            grow = y.exp()
            xi, eta = self.xi * grow, self.eta / grow
            return (xi + eta) / 2, (xi - eta) / 2
        u, a, pb, v, b, qa = self.speeds
        return u + y * (a + pb * y), v + y * (b + qa * y)

    def components(self, y):
        """(omega_j, omega_k) at offset y."""
        first, second = self.place(y)
        if self.r.e == 0:
            return first, second
        return self.rx * first - self.shift_j, self.rz * second - self.shift_k

    def component_i(self, w):
        """omega_i where theta' = w."""
        return w * self.flip / self.n - self.numbers.ball(self.r.s)

    def height(self, y):
        """V(theta_0 + y) - V(theta_0)."""
        if self.r.e == 0:
            f0, f1, f2, f3 = self.coefficients
            return -y * (f0 + y * (f1 / 2 + y * (f2 / 3 + y * f3 / 4)))
        if abs(y) < 1:
            return self._height_nearby(y)
        x, z = self.place(y)
        return -self.mu * y - (x - self.x) * (self.G * (x + self.x) / 2 + self.c) - self.r.e * self.d * (z - self.z)

    def _height_nearby(self, y):
        """The same with the exact force at the state taken out, so that a short way keeps its digits."""
        half = (y / 2).sin() if self.r.e < 0 else (y / 2).sinh()
        s, b = (y.sin(), -2 * half * half) if self.r.e < 0 else (y.sinh(), 2 * half * half)
        dx = self.z * s + self.x * b
        force = self.flip * self.n * self.numbers.ball(self.force_here)
        return (-self.mu * (y - s) - force * s - b * (self.G * self.x * self.x + self.c * self.x + self.r.e * self.d * self.z)
                - self.G * dx * dx / 2)

    def force(self, y):
        if self.r.e == 0:
            f0, f1, f2, f3 = self.coefficients
            return f0 + y * (f1 + y * (f2 + y * f3))
        x, z = self.place(y)
        return self.mu + self.G * x * z + self.c * z + self.d * x

    def slope(self, y):
        """dF/dtheta."""
        if self.r.e == 0:
            _, f1, f2, f3 = self.coefficients
            return f1 + y * (2 * f2 + y * 3 * f3)
        x, z = self.place(y)
        return self.G * (z * z + self.r.e * x * x) + self.r.e * self.c * x + self.d * z

    # --- its equilibria
    @cached_property
    def spots(self) -> list[Spot]:
        """All equilibria on the orbit, ascending; on a circle those with offsets in (0, 2 pi]."""
        if self.r.e == 0:
            found = [(y, m) for y, m in self.numbers.real_roots(self.taylor)]
            if self.force_here == 0:
                found = [(y * 0 if 0 in y else y, m) for y, m in found]
        else:
            found = [(y, m) for u, v, m in self._equilibria() if (y := self._offset(u, v)) is not None]
        if any(0 in y and not y.is_zero() for y, _ in found):
            raise Unclear  # on which side of the state it stands is not known, and no side may pass it over
        found.sort(key=lambda one: float(one[0].mid()))
        for (a, _), (b, _) in zip(found, found[1:]):
            if not a < b:
                raise Unclear
        return [Spot(y, self._kind(y, m, [o for o, _ in found])) for y, m in found]

    def _equilibria(self):
        """(omega_j + s_j, omega_k + s_k, multiplicity) as balls, of F = 0 on the conic of invariant Q."""
        r, ball = self.r, self.numbers.ball
        ap, aq = abs(r.p), abs(r.q)
        # in U = omega_j + s_j, V = omega_k + s_k:  F = kappa U V + rho_ V + sigma_ U + m_
        rho, sigma = r.rho - r.kappa * self.sj, r.sigma - r.kappa * self.sk
        m = r.m + r.kappa * self.sj * self.sk - r.rho * self.sk - r.sigma * self.sj
        if r.kappa and r.kappa * m == rho * sigma:
            yield from self._on_two_lines(-rho / r.kappa, -sigma / r.kappa)
        elif r.kappa or sigma:  # U = -(rho V + m)/(kappa V + sigma) in V^2/aq - e U^2/ap = Q
            top, bottom, square = Poly((m, rho)), Poly((sigma, r.kappa)), Poly((-self.Q, 0, 1 / aq))
            for v, many in self.numbers.real_roots((square * bottom * bottom - top * top * (Fraction(r.e) / ap)).c):
                yield -(ball(rho) * v + ball(m)) / (ball(r.kappa) * v + ball(sigma)), v, many
        elif rho:
            yield from self._on_line_v(-m / rho)

    def _on_two_lines(self, u, v):
        """The equilibria with omega_j + s_j = u or omega_k + s_k = v; one with both counts once, as often as on both lines."""
        found = [*self._on_line_v(v), *self._on_line_u(u)]
        if v * v / abs(self.r.q) - self.r.e * u * u / abs(self.r.p) == self.Q:
            both = tuple(map(self.numbers.ball, (u, v)))
            meets = [one[0].overlaps(both[0]) and one[1].overlaps(both[1]) for one in found]
            yield *both, sum(many for (*_, many), meet in zip(found, meets) if meet)
            found = [one for one, meet in zip(found, meets) if not meet]
        yield from found

    def _on_line_v(self, v):
        """The equilibria with omega_k + s_k = v."""
        r = self.r
        for u, many in self.numbers.real_roots([v * v / abs(r.q) - self.Q, 0, Fraction(-r.e) / abs(r.p)]):
            yield u, self.numbers.ball(v), many

    def _on_line_u(self, u):
        r = self.r
        for v, many in self.numbers.real_roots([-self.Q - r.e * u * u / abs(r.p), 0, 1 / abs(r.q)]):
            yield self.numbers.ball(u), v, many

    def _offset(self, u, v):
        """Offset at which the orbit passes the equilibrium, or None where it is on another branch."""
        (x, z), ball = self._canonical(u, v), self.numbers.ball
        here = self.force_here == 0 and u.overlaps(ball(self.u + self.sj)) and v.overlaps(ball(self.v + self.sk))
        if self.r.e < 0:
            return self._angle(x, z, here)
        xi, eta = self._light_cone(x, z)
        if any(sign(a) != sign(b) for a, b in ((xi, self.xi), (eta, self.eta))):
            return None
        if here:
            return x * 0
        ways = [f * (a / b).log() for f, a, b in ((1, xi, self.xi), (-1, eta, self.eta)) if not b.is_zero()]
        return max(ways, key=lambda y: y.rel_accuracy_bits())

    def _angle(self, x, z, here):
        """Angle in (0, 2 pi] from the state to (x, z) on the circle."""
        pi = self.numbers.pi()
        sine, cosine = x * self.z - z * self.x, x * self.x + z * self.z
        if here:
            return 2 * pi
        if cosine > 0:
            return (sine / cosine).atan() + (0 if sign(sine) > 0 else 2 * pi)
        if cosine < 0:
            return pi + (sine / cosine).atan()
        return (pi / 2 if sign(sine) > 0 else 3 * pi / 2) - (cosine / sine).atan()

    def _kind(self, y, multiplicity, others) -> int:
        if multiplicity == 1:
            return sign(self.slope(y))
        if multiplicity % 2 == 0:
            return 0
        gap = min([abs(float((o - y).mid())) for o in others if o is not y] + [0.1])
        return sign(self.force(y + gap / 4))

    @cached_property
    def all_spots(self) -> list[Spot]:
        """The equilibria, on a circle also those of the turn behind, ascending."""
        if self.r.e >= 0:
            return self.spots
        behind = [Spot(y * 0 if self._is_turn(y) else y - 2 * self.numbers.pi(), k) for y, k in ((s.y, s.kind) for s in self.spots)]
        return behind + self.spots

    def _is_turn(self, y):
        return self.force_here == 0 and y.overlaps(2 * self.numbers.pi())

    def barriers(self) -> list[Spot]:
        """The barriers that the fate depends on: on a circle those ahead within one turn, on an invariant plane those ahead,
        else all."""
        return [s for s in self.spots if s.kind > 0 and not (self.on_plane and s.y < 0)]

    def margins(self) -> list:
        """Height minus energy of each of the `barriers`."""
        return [self.height(s.y) - self.energy for s in self.barriers()]
