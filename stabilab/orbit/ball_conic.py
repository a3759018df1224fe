"""What circle and hyperbola have in common: an orbit in balls on a conic, and its equilibria."""
from __future__ import annotations

from fractions import Fraction
from functools import cached_property

from ..numbers.polynomial import Poly
from .ball_base import BallOrbit
from .potential import force_at, rise_at, slope_at


class BallConic(BallOrbit):
    """A circle or a hyperbola: place = (X, Z), Q = Z^2 - e X^2."""

    def _set_up(self, speed):
        r, ball = self.r, self.numbers.ball
        (self.sj, self.sk), ap, aq = r.centre, abs(r.p), abs(r.q)
        rp, rq = ball(ap).sqrt(), ball(aq).sqrt()
        k = r.constants_in(ball, rp, rq, rp * rq)
        self.flip, self.n, self.rx, self.rz = k.flip, k.n, k.flip * k.rx, k.rz
        self.G, self.c, self.d, self.mu = k.G, k.c, k.d, k.mu
        self.w = k.flip * k.n * ball(speed)
        self.shift_j, self.shift_k = ball(self.sj), ball(self.sk)
        self.x, self.z = self._canonical(ball(self.u + self.sj), ball(self.v + self.sk))
        # the invariant Q = Z^2 - e X^2, exactly
        self.Q = (self.v + self.sk) ** 2 / aq - r.e * (self.u + self.sj) ** 2 / ap

    def _canonical(self, u_shifted, v_shifted):
        return u_shifted / self.rx, v_shifted / self.rz

    # --- the potential along the orbit
    def _swing(self, y):
        """(sin y, cos y - 1) on a circle, (sinh y, cosh y - 1) on a hyperbola."""
        raise NotImplementedError

    def components(self, y):
        """(omega_j, omega_k) at offset y."""
        first, second = self.place(y)
        return self.rx * first - self.shift_j, self.rz * second - self.shift_k

    @property
    def spin(self) -> float:
        """Rate about the axis, less the shift, per theta'."""
        return float((self.flip / self.n).mid())

    def height(self, y):
        """V(theta_0 + y) - V(theta_0)."""
        if abs(y) < 1:
            return self._height_nearby(y)
        x, z = self.place(y)
        return -self.mu * y - (x - self.x) * (self.G * (x + self.x) / 2 + self.c) - self.r.e * self.d * (z - self.z)

    def _height_nearby(self, y):
        """The same with the exact force at the state taken out, so that a short way keeps its digits."""
        swing = self._swing(y)
        return rise_at(self.G, self.c, self.d, self.mu, self.r.e, (self.x, self.z), swing, y - swing[0], self._pull)

    @cached_property
    def _pull(self):
        """The force at the state."""
        return self.flip * self.n * self.numbers.ball(self.force_here)

    def force(self, y):
        return force_at(self.G, self.c, self.d, self.mu, *self.place(y))

    def slope(self, y):
        """dF/dtheta."""
        return slope_at(self.G, self.c, self.d, self.r.e, *self.place(y))

    # --- its equilibria
    def _found(self):
        return [(y, m) for u, v, m in self._equilibria() if (y := self._offset(u, v)) is not None]

    def _equilibria(self):
        """(omega_j + s_j, omega_k + s_k, multiplicity) as balls, of F = 0 on the conic of invariant Q."""
        r, ball = self.r, self.numbers.ball
        ap, aq = abs(r.p), abs(r.q)
        # in U = omega_j + s_j, V = omega_k + s_k:  F = kappa U V + rho_ V + sigma_ U + m_
        (rho, sigma), m = r.across, r.torque
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
        return self._way(x, z, self.force_here == 0 and u.overlaps(ball(self.u + self.sj)) and v.overlaps(ball(self.v + self.sk)))

    def _way(self, x, z, here):
        """`_offset` of the equilibrium at (X, Z); here: it is the state itself."""
        raise NotImplementedError

    def invariants(self):
        found, angle = {"Q": float(self.Q)}, self._direction()
        if angle is not None:
            energy = self.energy - self.mu * angle - self.x * (self.G * self.x / 2 + self.c) - self.r.e * self.d * self.z
            found["energy"] = float(energy.mid()) * self.r.energy_unit
        return found

    def _direction(self):
        """The turn angle from the direction X = 0; None where there is none, on an invariant plane."""
        raise NotImplementedError
