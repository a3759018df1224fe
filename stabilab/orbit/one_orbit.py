"""The orbit of one state and its reduced potential in balls, on circles, hyperbolas and parabolas: where
doubles cannot decide, or would lose digits.

Inputs (the state's doubles or fractions, the scene's rationals) are exact; every number is a ball that surely
holds the true value (`balls`), and the mechanics is the same for any number of digits.
"""
from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

from ..numbers.balls import FIRST_BITS, START_BITS, Digits, Unclear, settled, sign
from ..numbers.polynomial import Poly
from ..numbers.vectors import Number
from .potential import derivatives_on_parabola, force_at, rise_at, slope_at
from .reduction import Reduction

if TYPE_CHECKING:
    import numpy as np
    from flint import acb, arb


class Spot(NamedTuple):
    """An equilibrium on the orbit at offset y. kind: +1 a maximum of V (barrier), -1 a minimum (well), 0
    neither."""

    y: Number
    kind: int


class BallOrbit:
    """The orbit of one state in balls: V along it as a function of the offset y = theta - theta_0, and its
    equilibria.

    numbers: the kind of ball that it computes in; to be used where that came from, inside `settled`. What a
    geometry has to say besides: its `place`, `components`, `height`, `force` and `slope` at an offset, its
    equilibria (`_found`), `tops` and `swept`.
    """

    place: Callable[..., Any]
    components: Callable[..., Any]
    height: Callable[..., Any]
    force: Callable[..., Any]
    slope: Callable[..., Any]
    on_plane: bool = False  # on an invariant plane of a hyperbola
    closed = False  # whether it comes to the same place again
    spins_purely = False  # whether nothing but the rate about the axis changes as it spins up

    def __init__(self, reduction, state, numbers):
        self.r, self.numbers = reduction, numbers
        r = reduction
        self.state = tuple(v if isinstance(v, Fraction) else float(v) for v in state)  # exact either way
        self.u, self.v = (Fraction(self.state[a]) for a in (r.j, r.k))
        self.force_here = r.kappa * self.u * self.v + r.rho * self.v + r.sigma * self.u + r.m  # exact
        self._set_up(Fraction(self.state[r.axis]) + r.s)
        self.energy = self.w * self.w / 2  # E - V(theta_0)

    def _set_up(self, speed: Fraction):
        """flip, n, w, mu and the constants of the geometry; speed: omega_i + s, exactly."""
        raise NotImplementedError

    def component_i(self, w):
        """omega_i where theta' = w."""
        return w * self.flip / self.n - self.numbers.ball(self.r.s)

    def doubles_at(self, y: arb) -> tuple[float, ...]:
        """The place at offset y as floats, in the form that `potential` takes."""
        return tuple(map(float, self.place(y)))

    # --- its equilibria
    @cached_property
    def spots(self) -> list[Spot]:
        """All equilibria on the orbit, ascending; on a circle those with offsets in (0, 2 pi]."""
        result = self._found()
        if any(0 in y and not y.is_zero() for y, _ in result):
            raise Unclear  # on which side of the state it stands is not known, and no side may pass it over
        result.sort(key=lambda item: item[0].mid())  # as doubles two that nearly meet may be one number
        for (a, _), (b, _) in zip(result, result[1:]):
            if not a < b:
                raise Unclear
        return [Spot(y, self._kind(y, m, [o for o, _ in result])) for y, m in result]

    def _found(self) -> list:
        """[(offset, multiplicity)] of the equilibria, in any order."""
        raise NotImplementedError

    def _kind(self, y: arb, multiplicity: int, others: Sequence[arb]) -> int:
        if multiplicity == 1:
            return sign(self.slope(y))
        if multiplicity % 2 == 0:
            return 0
        gap = min([abs(float((o - y).mid())) for o in others if o is not y] + [0.1])
        return sign(self.force(y + gap / 4))

    @property
    def all_spots(self) -> list[Spot]:
        """The equilibria, on a circle also those of the turn behind, ascending."""
        return self.spots

    # --- what a geometry may say otherwise
    def fall(self):
        """What the potential falls by over a turn of a circle; nothing on the others."""
        return self.w * 0

    def barriers(self) -> list[Spot]:
        """The barriers that the fate depends on: on a circle those ahead within one turn, on an invariant
        plane those ahead, else all."""
        return [s for s in self.spots if s.kind > 0]

    def margins(self) -> list:
        """Height minus energy of each of the `barriers`."""
        return [self.height(s.y) - self.energy for s in self.barriers()]

    def margin(self):
        """The margin that decides the fate: of the highest barrier on a circle, else of the one nearest in
        height; None without a barrier."""
        return min(self.margins(), key=lambda v: abs(v.mid()), default=None)

    def margins_to_tie(self, margin: arb) -> list:
        """The margins of the barriers that a motion of their energy would tend to, given that which decides
        the fate."""
        return [margin]

    def wall(self, inner: arb, side: int):
        """An offset on one side of all equilibria, from `inner` on, where the potential is higher than the
        energy; None on a circle."""
        step, outer = 1, inner + side
        while not self.height(outer) - self.energy > 0:  # nor where it may be the energy itself
            step *= 2
            outer = inner + side * step
        return outer

    def end_of_plane(self, side):
        """(offset, W^2/2 there) of the end of an invariant plane that the motion would tend to on that side,
        or None."""
        return None

    def invariants(self) -> dict[str, float]:
        """Q and the energy, as a motion's `invariants`; nothing on a parabola."""
        return {}


WIDE = 1e-30  # radius of a ball of ways from which its terms are not just added


# --- What circle and hyperbola have in common: an orbit in balls on a conic, and its equilibria
class BallConic(BallOrbit):
    """A circle or a hyperbola: place = (X, Z), Q = Z^2 - e X^2."""

    def _set_up(self, speed: Fraction):
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

    def _canonical(self, u_shifted: arb, v_shifted: arb):
        return u_shifted / self.rx, v_shifted / self.rz

    # --- the potential along the orbit
    def _swing(self, y: arb):
        """(sin y, cos y - 1) on a circle, (sinh y, cosh y - 1) on a hyperbola."""
        raise NotImplementedError

    def components(self, y: arb):
        """(omega_j, omega_k) at offset y."""
        first, second = self.place(y)
        return self.rx * first - self.shift_j, self.rz * second - self.shift_k

    @property
    def spin(self) -> float:
        """Rate about the axis, less the shift, per theta'."""
        return float((self.flip / self.n).mid())

    def height(self, y: arb):
        """V(theta_0 + y) - V(theta_0)."""
        if abs(y) < 1:
            return self._height_nearby(y)
        x, z = self.place(y)
        return (-self.mu * y - (x - self.x) * (self.G * (x + self.x) / 2 + self.c)
                - self.r.e * self.d * (z - self.z))

    def _height_nearby(self, y: arb):
        """The same with the exact force at the state taken out, so that a short way keeps its digits."""
        swing = self._swing(y)
        return rise_at(self.G, self.c, self.d, self.mu, self.r.e, (self.x, self.z), swing, y - swing[0],
                       self._pull)

    @cached_property
    def _pull(self):
        """The force at the state."""
        return self.flip * self.n * self.numbers.ball(self.force_here)

    def _sine(self, y: arb | acb):
        """(sin y/y, cos y) on a circle, (sinh y/y, cosh y) on a hyperbola."""
        raise NotImplementedError

    def mean_force(self, start: arb, way: arb | acb):
        """The mean of F over a way from `start`, -(V(start + way) - V(start))/way, without cancellation; a
        way may be complex. With h half of it and X, Z at its middle, differences of X, Z and X^2 are 2 sin h
        times Z, e X and 2 cos h X Z."""
        half = way / 2
        sine, cosine = self._sine(half)
        x, z = self.place(start + half)
        mean = self.mu + sine * (z * (self.G * cosine * x + self.c) + self.d * x)
        if float(abs(way).rad()) < WIDE:
            return mean
        other = self._wide_mean(start, way)  # either may be the narrower one
        if not mean.is_finite() or not other.is_finite():
            return other if other.is_finite() else mean
        return type(other)(mean.real.intersection(other.real), mean.imag.intersection(other.imag))

    def _wide_mean(self, start: arb, way: acb):
        """The same of a wide ball of ways, by two terms of Taylor's series about its middle w: the mean's
        derivative there is (F(start + w) - mean)/w, and half the slope at the start where w = 0."""
        from flint import acb
        way = acb(way)
        middle = acb(way.real.mid(), way.imag.mid())
        if way.contains(0):
            middle = middle * 0
        off = way - middle
        first = self.mean_force(start, middle)
        change = (self.slope(start) / 2 if middle == 0
                  else (self.force(start + middle) - first) / middle)
        bend, _ = self.bends(start + way.union(acb(0)))
        return first + off * (change + off * bend / 6)

    def force(self, y: arb):
        return force_at(self.G, self.c, self.d, self.mu, *self.place(y))

    def slope(self, y: arb):
        """dF/dtheta."""
        return slope_at(self.G, self.c, self.d, self.r.e, *self.place(y))

    def bends(self, y: arb | acb):
        """The second and third derivative of F by theta."""
        (x, z), e = self.place(y), self.r.e
        return (e * (4 * self.G * x * z + self.c * z + self.d * x),
                4 * e * self.G * (z * z + e * x * x) + self.c * x + e * self.d * z)

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
            for v, many in self.numbers.real_roots((square * bottom * bottom
                                                    - top * top * (Fraction(r.e) / ap)).c):
                yield -(ball(rho) * v + ball(m)) / (ball(r.kappa) * v + ball(sigma)), v, many
        elif rho:
            yield from self._on_line_v(-m / rho)

    def _on_two_lines(self, u: Fraction, v: Fraction):
        """The equilibria with omega_j + s_j = u or omega_k + s_k = v; one with both counts once, as often as
        on both lines."""
        rows = [*self._on_line_v(v), *self._on_line_u(u)]
        if v * v / abs(self.r.q) - self.r.e * u * u / abs(self.r.p) == self.Q:
            both = tuple(map(self.numbers.ball, (u, v)))
            meets = [item[0].overlaps(both[0]) and item[1].overlaps(both[1]) for item in rows]
            yield *both, sum(many for (*_, many), meet in zip(rows, meets) if meet)
            rows = [item for item, meet in zip(rows, meets) if not meet]
        yield from rows

    def _on_line_v(self, v: Fraction):
        """The equilibria with omega_k + s_k = v."""
        r = self.r
        for u, many in self.numbers.real_roots([v * v / abs(r.q) - self.Q, 0, Fraction(-r.e) / abs(r.p)]):
            yield u, self.numbers.ball(v), many

    def _on_line_u(self, u: Fraction):
        r = self.r
        for v, many in self.numbers.real_roots([-self.Q - r.e * u * u / abs(r.p), 0, 1 / abs(r.q)]):
            yield self.numbers.ball(u), v, many

    def _offset(self, u: arb, v: arb):
        """Offset at which the orbit passes the equilibrium, or None where it is on another branch."""
        (x, z), ball = self._canonical(u, v), self.numbers.ball
        return self._way(x, z, self.force_here == 0 and u.overlaps(ball(self.u + self.sj))
                         and v.overlaps(ball(self.v + self.sk)))

    def _way(self, x: arb, z: arb, here: bool):
        """`_offset` of the equilibrium at (X, Z); here: it is the state itself."""
        raise NotImplementedError

    def invariants(self):
        result, angle = {"Q": float(self.Q)}, self._direction()
        if angle is not None:
            energy = (self.energy - self.mu * angle - self.x * (self.G * self.x / 2 + self.c)
                      - self.r.e * self.d * self.z)
            result["energy"] = float(energy.mid()) * self.r.energy_unit
        return result

    def _direction(self):
        """The turn angle from the direction X = 0; None where there is none, on an invariant plane."""
        raise NotImplementedError


# --- An orbit in balls on each of the three geometries of the reduction: circle, hyperbola, parabola
# exp(-OUTERMOST) is nothing against any double: an offset that stands for the end of an invariant plane
OUTERMOST = 1 << 13


class BallCircle(BallConic):
    """A circle: what is ahead comes again every turn, lower by the torque's tilt."""

    closed = True

    def _swing(self, y: arb):
        half = (y / 2).sin()
        return y.sin(), -2 * half * half

    def _sine(self, y: arb | acb):
        return y.sinc(), y.cos()

    def place(self, y: arb):
        """(X, Z) at offset y."""
        s, c = y.sin_cos()
        return self.x * c + self.z * s, self.z * c - self.x * s

    def _way(self, x: arb, z: arb, here: bool):
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

    def _is_turn(self, y: arb):
        return self.force_here == 0 and y.overlaps(2 * self.numbers.pi())

    def margin(self):
        margins = self.margins()
        if not margins:
            return None
        margin = margins[0]
        for other in margins[1:]:
            margin = margin.max(other)
        return margin

    def margins_to_tie(self, margin: arb):
        """Without a torque a motion tends to whichever barrier its energy equals, be another one higher or
        not."""
        return [margin] if self.r.sense else self.margins()

    def wall(self, inner: arb, side: int):
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

    def swept(self, left: arb | None) -> list:
        """Offsets among which both components are least and greatest on the way of a spin-up, which turned
        back at `left` (or never)."""
        return [self.energy * 0, *self.tops()]

    def _direction(self):
        return self.energy * 0 if self.Q == 0 else self.numbers.angle(self.x, self.z)


class BallHyperbola(BallConic):
    """A hyperbola with its two invariant planes, in xi = X + Z and eta = X - Z, which grow and decay like
    exp(+-theta)."""

    def _set_up(self, speed: Fraction):
        super()._set_up(speed)
        self.on_plane = self.Q == 0
        self.xi, self.eta = self._light_cone(self.x, self.z)

    def _light_cone(self, x: arb, z: arb):
        """(xi, eta); on an invariant plane the one that vanishes is exactly zero."""
        xi, eta = x + z, x - z
        if not self.on_plane or (x.is_zero() and z.is_zero()):
            return xi, eta
        if 0 in xi and 0 in eta:
            raise Unclear
        return (xi * 0, eta) if 0 in xi else (xi, eta * 0)

    def _swing(self, y: arb):
        half = (y / 2).sinh()
        return y.sinh(), 2 * half * half

    def _sine(self, y: arb | acb):
        from flint import acb
        turned = acb(0, 1) * y
        return turned.sinc(), turned.cos()

    def _at(self, y: arb):
        """(xi, eta) at offset y."""
        grow = y.exp()
        return self.xi * grow, self.eta / grow

    def place(self, y: arb):
        """(X, Z) at offset y."""
        xi, eta = self._at(y)
        return (xi + eta) / 2, (xi - eta) / 2

    def doubles_at(self, y: arb) -> tuple[float, ...]:
        """(xi, eta) at offset y as floats, in the form that `potential` takes."""
        return tuple(map(float, self._at(y)))

    def _way(self, x: arb, z: arb, here: bool):
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

    def swept(self, left: arb | None) -> list:
        """On the decaying plane: from where it is, or where it turns back, to the plane's end."""
        zero = self.energy * 0
        return [zero, *([] if left is None else [left]), zero + OUTERMOST]

    def end_of_plane(self, side):
        decays = self.on_plane and self.mu.is_zero() and sign(self.xi if side < 0 else self.eta)
        if not decays:
            return None
        zero, limit = self.energy * 0, self.x * (self.G * self.x / 2 + self.c) + self.d * self.z
        return None if limit > self.energy else (zero + side * OUTERMOST, (self.energy - limit).max(zero))

    def _direction(self):
        return None if self.on_plane else (abs(self.xi) / abs(self.eta)).log() / 2


class BallParabola(BallOrbit):
    """A parabola, or a line: place = (omega_j, omega_k), and V is a polynomial of degree four or less."""

    spin = 1.0
    spins_purely = True  # a parabola without walls has a constant force, and both rates stay

    def _set_up(self, speed: Fraction):
        r, u, v, ball = self.r, self.u, self.v, self.numbers.ball
        self.flip, self.n, self.w, self.mu = 1, 1, ball(speed), ball(r.m)
        a, b = r.p * v + r.p0, r.q * u + r.q0
        first, second, third = derivatives_on_parabola(r, u, v)
        self.taylor = self.force_here, first, second / 2, third / 6
        self.coefficients = [ball(c) for c in self.taylor]
        self.speeds = [ball(c) for c in (u, a, r.p * b / 2, v, b, r.q * a / 2)]

    def place(self, y: arb):
        """(omega_j, omega_k) at offset y."""
        u, a, pb, v, b, qa = self.speeds
        return u + y * (a + pb * y), v + y * (b + qa * y)

    def components(self, y: arb):
        """(omega_j, omega_k) at offset y."""
        return self.place(y)

    def height(self, y: arb):
        """V(theta_0 + y) - V(theta_0)."""
        f0, f1, f2, f3 = self.coefficients
        return -y * (f0 + y * (f1 / 2 + y * (f2 / 3 + y * f3 / 4)))

    def force(self, y: arb):
        f0, f1, f2, f3 = self.coefficients
        return f0 + y * (f1 + y * (f2 + y * f3))

    def slope(self, y: arb):
        """dF/dtheta."""
        _, f1, f2, f3 = self.coefficients
        return f1 + y * (2 * f2 + y * 3 * f3)

    def _found(self):
        rows = [(y, m) for y, m in self.numbers.real_roots(self.taylor)]
        if self.force_here == 0:
            rows = [(y * 0 if 0 in y else y, m) for y, m in rows]
        return rows

    def tops(self) -> list:
        """Offsets where a component is stationary."""
        _, a, pb, _, b, qa = self.speeds
        return [-speed / (2 * bend) for speed, bend in ((a, pb), (b, qa)) if sign(bend)]


GEOMETRIES = {-1: BallCircle, 1: BallHyperbola, 0: BallParabola}


def ball_orbit(reduction: Reduction, state: np.ndarray | Sequence[float | Fraction],
               numbers: Digits) -> BallOrbit:
    """The orbit of one state (three doubles or Fractions, taken exactly) in this kind of ball."""
    return GEOMETRIES[reduction.e](reduction, state, numbers)


# --- The orbit of one state, built once in each kind of number that its questions ask for
MOST_BITS = 1 << 17  # where balls end
TIE_BITS = 4096  # with so many the extremes of a motion on the separatrix are worked out


class Orbit:
    """The orbit of one state (three doubles or Fractions, taken exactly), built once in each kind of number
    that a question asks for."""

    def __init__(self, reduction: Reduction, state: Sequence[Number]) -> None:
        self.reduction, self.state = reduction, state
        self._built: dict[Any, BallOrbit] = {}

    def settled(self, question: Callable[[BallOrbit], Any], bits: int = START_BITS,
                most: int = MOST_BITS) -> Any:
        """question(orbit) of its `BallOrbit`, as `balls.settled` asks: with more bits as long as it is
        `Unclear`."""
        return settled(lambda numbers: question(self._in(numbers)), bits, most)

    def invariants(self) -> dict[str, float]:
        """Q (the squared radius of the circle, or Z^2 - X^2 on a hyperbola) in canonical units, and the
        energy W^2/2 + V in the scene's, with the turn angle counted from the direction X = 0; nothing on a
        parabola."""
        return self.settled(lambda result: result.invariants(), FIRST_BITS)

    def _in(self, numbers: Digits) -> BallOrbit:
        if numbers not in self._built:
            self._built[numbers] = ball_orbit(self.reduction, self.state, numbers)
        return self._built[numbers]
