"""An orbit in balls on each of the three geometries of the reduction: circle, hyperbola, parabola."""
from __future__ import annotations

from functools import cached_property

from ..numbers.balls import Unclear, sign
from .ball_base import BallOrbit, Spot
from .ball_conic import BallConic
from .potential import derivatives_on_parabola

FAR = 1 << 13  # exp(-FAR) is nothing against any double: an offset that stands for the end of an invariant plane


class BallCircle(BallConic):
    """A circle: what is ahead comes again every turn, lower by the torque's tilt."""

    closed = True

    def _swing(self, y):
        half = (y / 2).sin()
        return y.sin(), -2 * half * half

    def place(self, y):
        """(X, Z) at offset y."""
        s, c = y.sin_cos()
        return self.x * c + self.z * s, self.z * c - self.x * s

    def _way(self, x, z, here):
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

    @cached_property
    def all_spots(self):
        turn = 2 * self.numbers.pi()
        behind = [Spot(s.y * 0 if self._is_turn(s.y) else s.y - turn, s.kind) for s in self.spots]
        if any(0 in s.y and not s.y.is_zero() for s in behind):
            raise Unclear  # just ahead it would count as passed, just behind as reached
        return behind + self.spots

    def _is_turn(self, y):
        return self.force_here == 0 and y.overlaps(2 * self.numbers.pi())

    def margin(self):
        margins = self.margins()
        if not margins:
            return None
        margin = margins[0]
        for other in margins[1:]:
            margin = margin.max(other)
        return margin

    def margins_to_tie(self, margin):
        """Without a torque a motion tends to whichever barrier its energy equals, be another one higher or not."""
        return [margin] if self.r.sense else self.margins()

    def wall(self, inner, side):
        return None

    def fall(self):
        return 2 * self.numbers.pi() * self.mu

    def tops(self) -> list:
        """Offsets where X or Z is stationary."""
        x, z = self.x, self.z
        if x.is_zero() and z.is_zero():
            return []
        angle, quarter = self.numbers.angle(x, z), self.numbers.pi() / 2
        return [k * quarter - angle for k in range(-8, 9)]

    def swept(self, left) -> list:
        """Offsets among which both components are least and greatest on the way of a spin-up, which turned back at `left` (or never)."""
        return [self.energy * 0, *self.tops()]

    def _direction(self):
        return self.energy * 0 if self.Q == 0 else self.numbers.angle(self.x, self.z)


class BallHyperbola(BallConic):
    """A hyperbola with its two invariant planes, in xi = X + Z and eta = X - Z, which grow and decay like exp(+-theta)."""

    def _set_up(self, speed):
        super()._set_up(speed)
        self.on_plane = self.Q == 0
        self.xi, self.eta = self._light_cone(self.x, self.z)

    def _light_cone(self, x, z):
        """(xi, eta); on an invariant plane the one that vanishes is exactly zero."""
        xi, eta = x + z, x - z
        if not self.on_plane or (x.is_zero() and z.is_zero()):
            return xi, eta
        if 0 in xi and 0 in eta:
            raise Unclear
        return (xi * 0, eta) if 0 in xi else (xi, eta * 0)

    def _swing(self, y):
        half = (y / 2).sinh()
        return y.sinh(), 2 * half * half

    def _at(self, y):
        """(xi, eta) at offset y."""
        grow = y.exp()
        return self.xi * grow, self.eta / grow

    def place(self, y):
        """(X, Z) at offset y."""
        xi, eta = self._at(y)
        return (xi + eta) / 2, (xi - eta) / 2

    def doubles_at(self, y) -> tuple[float, ...]:
        """(xi, eta) at offset y as floats, in the form that `potential` takes."""
        return tuple(map(float, self._at(y)))

    def _way(self, x, z, here):
        xi, eta = self._light_cone(x, z)
        if any(sign(a) != sign(b) for a, b in ((xi, self.xi), (eta, self.eta))):
            return None
        if here:
            return x * 0
        ways = [f * (a / b).log() for f, a, b in ((1, xi, self.xi), (-1, eta, self.eta)) if not b.is_zero()]
        return max(ways, key=lambda y: y.rel_accuracy_bits())

    def barriers(self):
        return [s for s in self.spots if s.kind > 0 and not (self.on_plane and s.y < 0)]

    @property
    def spins_purely(self) -> bool:  # type: ignore[override]  # a constant of the others
        return sign(self.xi) == sign(self.eta) == 0

    def tops(self) -> list:
        """Offsets where X or Z is stationary."""
        return [(abs(self.eta) / abs(self.xi)).log() / 2] if sign(self.xi) and sign(self.eta) else []

    def swept(self, left) -> list:
        """On the decaying plane: from where it is, or where it turns back, to the plane's end."""
        zero = self.energy * 0
        return [zero, *([] if left is None else [left]), zero + FAR]

    def end_of_plane(self, side):
        decays = self.on_plane and self.mu.is_zero() and sign(self.xi if side < 0 else self.eta)
        if not decays:
            return None
        zero, limit = self.energy * 0, self.x * (self.G * self.x / 2 + self.c) + self.d * self.z
        return None if limit > self.energy else (zero + side * FAR, (self.energy - limit).max(zero))

    def _direction(self):
        return None if self.on_plane else (abs(self.xi) / abs(self.eta)).log() / 2


class BallParabola(BallOrbit):
    """A parabola, or a line: place = (omega_j, omega_k), and V is a polynomial of degree four or less."""

    spin = 1.0
    spins_purely = True  # a parabola without walls has a constant force, and both rates stay

    def _set_up(self, speed):
        r, u, v, ball = self.r, self.u, self.v, self.numbers.ball
        self.flip, self.n, self.w, self.mu = 1, 1, ball(speed), ball(r.m)
        a, b = r.p * v + r.p0, r.q * u + r.q0
        first, second, third = derivatives_on_parabola(r, u, v)
        self.taylor = self.force_here, first, second / 2, third / 6
        self.coefficients = [ball(c) for c in self.taylor]
        self.speeds = [ball(c) for c in (u, a, r.p * b / 2, v, b, r.q * a / 2)]

    def place(self, y):
        """(omega_j, omega_k) at offset y."""
        u, a, pb, v, b, qa = self.speeds
        return u + y * (a + pb * y), v + y * (b + qa * y)

    def components(self, y):
        """(omega_j, omega_k) at offset y."""
        return self.place(y)

    def height(self, y):
        """V(theta_0 + y) - V(theta_0)."""
        f0, f1, f2, f3 = self.coefficients
        return -y * (f0 + y * (f1 / 2 + y * (f2 / 3 + y * f3 / 4)))

    def force(self, y):
        f0, f1, f2, f3 = self.coefficients
        return f0 + y * (f1 + y * (f2 + y * f3))

    def slope(self, y):
        """dF/dtheta."""
        _, f1, f2, f3 = self.coefficients
        return f1 + y * (2 * f2 + y * 3 * f3)

    def _found(self):
        found = [(y, m) for y, m in self.numbers.real_roots(self.taylor)]
        if self.force_here == 0:
            found = [(y * 0 if 0 in y else y, m) for y, m in found]
        return found

    def tops(self) -> list:
        """Offsets where a component is stationary."""
        _, a, pb, _, b, qa = self.speeds
        return [-speed / (2 * bend) for speed, bend in ((a, pb), (b, qa)) if sign(bend)]


GEOMETRIES = {-1: BallCircle, 1: BallHyperbola, 0: BallParabola}


def ball_orbit(reduction, state, numbers) -> BallOrbit:
    """The orbit of one state (three doubles or Fractions, taken exactly) in this kind of ball."""
    return GEOMETRIES[reduction.e](reduction, state, numbers)
