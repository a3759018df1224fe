"""The profile of a reduced motion: its hills and wells, each with the kinetic energy above it, from exact
inputs; and motions that repeat, at any time.

About an equilibrium the potential is V(0) - V(y) = R(y), and only divided differences (R(a + d) - R(a))/d are
ever formed, from closed expressions that keep their digits however small a and d are: the kinetic energy is K
+ y R[0, y] where the motion passes the equilibrium with K, and d R[a, a + d] where it turns at a. Energies
are never subtracted. Offsets and heights come from ball arithmetic and are rounded once, so a state next to a
separatrix costs no digits.

Motions that repeat are librations between two turning points, and rotations without torque."""
from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from ..errors import InputError
from ..numbers.balls import Unclear
from .one_orbit import TIE_BITS, BallCircle, BallHyperbola, BallParabola, Orbit
from .one_state import BEYOND, powered

if TYPE_CHECKING:
    from flint import arb

# --- Hills and wells of one orbit
SURE_BITS = 60  # relative accuracy of a ball that is rounded to a double
FLOOR_BITS = 90  # a sum of terms whose ball is smaller than its terms by so many bits counts as zero
EPS = float(np.finfo(float).eps)
TURN = 2 * math.pi


def over(sine: float | np.ndarray, t: float | np.ndarray):
    """sine/t, 1 at t = 0; sine = sin(t)."""
    return np.where(t == 0, 1.0, sine / np.where(t == 0, 1.0, t))


def _rest(t: float | np.ndarray):
    """1 - sin(t)/t."""
    small = np.abs(t) < 0.7
    return np.where(small, _sinc_series(np.where(small, t * t, 0.0)), 1 - over(np.sin(t), t))


def _growth(t: float | np.ndarray):
    """(exp(t) - 1)/t."""
    return over(np.expm1(t), t)


def _growth_rest(t: float | np.ndarray):
    """(exp(t) - 1)/t - 1."""
    small = np.abs(t) < 0.7
    return np.where(small, _growth_series(np.where(small, t, 0.0)), _growth(t) - 1)


def _sinc_series(t2: np.ndarray):
    return t2 / 6 * (1 - t2 / 20 * (1 - t2 / 42 * (1 - t2 / 72 * (1 - t2 / 110 * (1 - t2 / 156)))))


def _growth_series(t):
    total = 0.0
    for n in range(17, 1, -1):
        total = (1 + total) * t / n
    return total


@dataclass(frozen=True)
class Spot:
    """An equilibrium (or, on a circle without any, the state itself) and what surrounds it along the orbit.

    at: its offset from the state; kinetic: W^2/2 of the motion there (negative: the motion does not get
    there); kind: +1 hill,
    -1 well, 0 neither; force: of the potential there, 0 at an equilibrium; base: omega_j, omega_k there;
    shape and curve: coefficients of R and of the components, by geometry; spin: omega_i = spin W - shift.
    """

    at: float
    kinetic: float
    kind: int
    force: float
    base: tuple
    shape: tuple
    curve: tuple
    axes: tuple
    spin: tuple

    def energy(self, y):
        """W^2/2 at offset y of a motion that passes here."""
        return self.kinetic + y * self.share(0.0, y)

    def state(self, y, w):
        """(omega_1, omega_2, omega_3) at offset y with rate W."""
        out, (i, j, k) = [None] * 3, self.axes
        out[j], out[k] = self.components(y)
        out[i] = self.spin[0] * w - self.spin[1]
        return out

    # of the geometry, in its class
    terms: ClassVar[Any]
    bend: ClassVar[Any]

    @property
    def blur(self) -> float:
        """Relative rounding error of R near the equilibrium, where its terms cancel."""
        return 0.0 if self.force else EPS * self.terms / max(abs(self.bend), 1e-300)


class OnCircle(Spot):
    """R = force sin y + mu (y - sin y) + B u - P u^2 + Q u sin y with u = 1 - cos y; shape (mu, B, P, Q), B =
    R''."""

    @property
    def bend(self):
        return self.shape[1]

    @property
    def terms(self):
        return abs(self.shape[1])

    def share(self, a: float, d: float | np.ndarray):
        mu, bend, p, q = self.shape
        b, middle = a + d, a + 0.5 * d
        half, low, left, right = np.sin(0.5 * d), np.sin(0.5 * middle), np.sin(0.5 * a), np.sin(0.5 * b)
        sinc = over(half, 0.5 * d)
        u_a, u_b, u_middle = 2 * left * left, 2 * right * right, 2 * low * low
        bent = (np.sin(middle) * sinc * (bend - p * (u_a + u_b) + q * np.sin(b))
                + q * u_a * (1 - u_middle) * sinc)
        if mu:
            bent = bent + mu * (_rest(0.5 * d) + u_middle * sinc)
        return bent + self.force * (1 - u_middle) * sinc if self.force else bent

    def components(self, y: np.ndarray):
        jx, jz, kx, kz = self.curve
        half = np.sin(0.5 * y)
        s, b = np.sin(y), 2 * half * half
        return self.base[0] + (jz * s - jx * b), self.base[1] - (kx * s + kz * b)


class OnHyperbola(Spot):
    """V = -mu y + sum of u_s exp(s y), s = 1, -1, 2, -2; shape u_s."""

    @property
    def bend(self):
        return -sum(s * s * u for s, u in zip((1, -1, 2, -2), self.shape))

    @property
    def terms(self):
        return sum(s * s * abs(u) for s, u in zip((1, -1, 2, -2), self.shape))

    def share(self, a: float, d: float | np.ndarray):
        total = self.force
        for s, u in zip((1, -1, 2, -2), self.shape):
            if u:
                total = total - s * u * (np.expm1(s * a) * _growth(s * d) + _growth_rest(s * d))
        return total

    def components(self, y: np.ndarray):
        jx, je, kx, ke = self.curve  # times xi/2 and eta/2
        up, down = np.expm1(y), np.expm1(-y)
        return self.base[0] + (jx * up + je * down), self.base[1] + (kx * up - ke * down)


class OnParabola(Spot):
    """R = f_1 y^2/2 + f_2 y^3/3 + f_3 y^4/4; shape f_n."""

    @property
    def bend(self):
        return self.shape[0]

    @property
    def terms(self):
        return abs(self.shape[0])

    def share(self, a: float, d: float | np.ndarray):
        f1, f2, f3 = self.shape
        b = a + d
        return (self.force + f1 / 2 * (a + b) + f2 / 3 * (a * a + a * b + b * b)
                + f3 / 4 * (a + b) * (a * a + b * b))

    def components(self, y: np.ndarray):
        ju, jb, kv, ka = self.curve
        return self.base[0] + y * (ju + jb * y), self.base[1] + y * (kv + ka * y)


@dataclass(frozen=True)
class Relief:
    """spots in ascending order, on a circle those of one turn behind and of one ahead; w: rate of the state;
    closed: whether the orbit is a circle; turn: what the potential falls by over a turn of a circle, behind:
    by how many whole turns each spot of the turn ahead lies above the place where the motion came from
    rest."""

    spots: tuple
    w: float
    closed: bool
    turn: float
    here: Spot
    drops: tuple


def relief(orbit: Orbit) -> Relief:
    """The relief of one state's orbit. Raises InputError where energies tie (on a separatrix)."""
    return orbit.settled(_relief)


def _relief(orbit) -> Relief:
    zero, bits = orbit.w * 0, orbit.numbers.bits
    kinetic = [orbit.energy - orbit.height(s.y) for s in orbit.spots]
    turn = orbit.fall()
    spots = [_spot(orbit, s.y, s.kind, value, bits) for s, value in zip(orbit.spots, kinetic)]
    drops = ()
    here = _spot(orbit, zero, 0, orbit.energy, bits,
                 force=orbit.numbers.ball(orbit.force_here) * orbit.n * orbit.flip)
    if orbit.closed:
        behind = [replace(point, at=_offset(item.y), kinetic=_rounded(value - turn, bits))
                  for point, value, item in zip(spots, kinetic, orbit.all_spots)]
        if orbit.mu != 0:
            rows = [(s, v) for s, v in zip(spots, kinetic) if s.kind > 0] or [(here, orbit.energy)]
            drops = tuple(_drop(point, value, turn, bits) for point, value in rows)
        spots = behind + spots
    return Relief(tuple(spots), _rounded(orbit.w, bits), orbit.closed, float(turn.mid()), here, drops)


def _drop(point: Spot, kinetic: arb, turn: arb, bits: int):
    """(spot, m, kinetic energy m turns behind it): over an equilibrium the first m with a negative one, else
    the last with none."""
    fraction = kinetic / turn
    full = fraction.floor().unique_fmpz()
    if full is None:
        raise Unclear
    m = int(full) + (1 if point.force == 0 else 0)
    return point, m, _rounded(kinetic - m * turn, bits)


def _offset(y: arb):
    if y.is_zero():
        return 0.0
    if y.rel_accuracy_bits() < SURE_BITS:
        raise Unclear
    return float(y.mid())


def _rounded(value: arb, bits: int):
    """A ball as a double; zero only where it is exactly that, or where no number of bits tells."""
    if value.is_zero():
        return 0.0
    if value.rel_accuracy_bits() < SURE_BITS:
        if bits >= TIE_BITS and 0 in value:
            return 0.0
        raise Unclear
    return float(value.mid())


def _sum(terms: Sequence[arb]):
    """A sum of balls as a double; what cancels beyond `FLOOR_BITS` is zero."""
    total = sum(terms[1:], terms[0])
    size = max(float(abs(t).mid()) for t in terms)
    if total.rel_accuracy_bits() >= SURE_BITS:
        return float(total.mid())
    if float(total.rad()) + abs(float(total.mid())) <= size * 2.0**-FLOOR_BITS:
        return 0.0
    raise Unclear


def _spot(orbit, y, kind, kinetic, bits, force=None) -> Spot:
    r = orbit.r
    value = 0.0 if force is None else _rounded(force, bits)
    spin = orbit.spin, float(r.s)
    base = tuple(float(part.mid()) for part in orbit.components(y))
    point, printed = SPOTS[r.e]
    shape, curve = printed(orbit, y)
    return point(_offset(y), _rounded(kinetic, bits), kind, value, base, shape, curve, (r.axis, r.j, r.k),
                spin)


def _circle(orbit: BallCircle, y: arb):
    x, z = orbit.place(y)
    G, c, d = orbit.G, orbit.c, orbit.d
    shape = (float(orbit.mu.mid()), _sum([G * z * z, -G * x * x, -c * x, d * z]),
             _sum([G * z * z / 2, -G * x * x / 2]), _sum([-G * x * z]))
    return shape, tuple(float(v.mid()) for v in (orbit.rx * x, orbit.rx * z, orbit.rz * x, orbit.rz * z))


def _hyperbola(orbit: BallHyperbola, y: arb):
    grow = y.exp()
    xi, eta = orbit.xi * grow, orbit.eta / grow
    up, down = (orbit.c + orbit.d) / 2, (orbit.d - orbit.c) / 2
    quarter = -orbit.G / 8
    shape = (_sum([-up * xi]), _sum([down * eta]), _sum([quarter * xi * xi]), _sum([quarter * eta * eta]))
    half_x, half_e = xi / 2, eta / 2
    return shape, tuple(float(v.mid())
                        for v in (orbit.rx * half_x, orbit.rx * half_e, orbit.rz * half_x, orbit.rz * half_e))


def _parabola(orbit: BallParabola, y: arb):
    f0, f1, f2, f3 = orbit.coefficients
    u, a, pb, v, b, qa = orbit.speeds
    shape = (_sum([f1, 2 * f2 * y, 3 * f3 * y * y]), _sum([f2, 3 * f3 * y]), _sum([f3]))
    return shape, tuple(float(w.mid()) for w in (a + 2 * pb * y, pb, b + 2 * qa * y, qa))


SPOTS: dict[int, tuple[Callable[..., Spot], Callable[..., tuple]]] = {
    -1: (OnCircle, _circle), 1: (OnHyperbola, _hyperbola), 0: (OnParabola, _parabola)}


TOO_FINE = "the reduced form of this motion takes more digits than doubles have; take method taylor"


# --- Motions that repeat
class Motion:
    """at(t): (omega_1, omega_2, omega_3) at one time; follow(times): (states (n, 3), way of the coordinate
    since time 0 (n,)); period: inf where it does not repeat; evaluations: of the integrand, in all."""

    evaluations = 0
    period: float
    axis: int
    spin: tuple[float, float]
    follow: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]

    def at(self, t: float):
        return self.follow(np.array([t], float))[0][0].tolist()

    def states(self, times: np.ndarray):
        """(n, 3)."""
        return self.follow(np.asarray(times, float))[0]


class ByPanels(Motion):
    """A motion that runs a chain of passages to and fro (sense 0), or over and over in one sense."""

    def __init__(self, panels, start, sense=0.0):
        self.panels, self.sense, self.start = panels, sense, start
        self.period = panels.total if sense else 2 * panels.total

    def _folded(self, times: np.ndarray):
        """(times in the chain, signs of W, turns done) of an array."""
        passed = self.start + (self.sense or 1.0) * np.fmod(times, self.period)
        folded = np.mod(passed, self.period)
        if self.sense:
            turns = np.round((passed - folded) / self.period) + self.sense * np.trunc(times / self.period)
            return np.minimum(folded, self.panels.total), np.full(folded.shape, self.sense), turns
        back = folded > self.panels.total
        return np.where(back, self.period - folded, folded), np.where(back, -1.0, 1.0), 0.0

    def follow(self, times: np.ndarray):
        time, sign, turns = self._folded(times)
        states, offsets = self.panels.follow(time, sign)
        return states, offsets + TURN * turns


class Resting(Motion):
    """A state whose rates are all zero."""

    period = 0.0

    def __init__(self, state: Sequence[float]):
        self.state = tuple(map(float, state))

    def follow(self, times: np.ndarray):
        return np.tile(self.state, (len(times), 1)), np.zeros(len(times))


# --- A motion whose squares leave the range of doubles, followed in its own unit of rate: rates change by a
# power of two, time by its inverse
class InOwnUnit(Motion):
    """A motion in the scene's unit, from the same one in the unit 2^k."""

    def __init__(self, motion: Motion, k: int):
        self.motion, self.k, self.evaluations, self.sense = motion, k, motion.evaluations, getattr(
            motion, "sense", 0.0)
        self.period = powered(motion.period, -k)
        if math.isnan(self.period):
            raise InputError(f"the period of this motion is {BEYOND}: choose another unit of time")

    def follow(self, times: np.ndarray):
        states, route = self.motion.follow(np.array([self._time(t) for t in times.tolist()]))
        return np.ldexp(states, self.k), route

    def _time(self, t: float):
        """The time in the own unit. Raises InputError where it is no double."""
        try:
            return math.ldexp(t, self.k)
        except OverflowError:
            raise InputError(
                f"at t = {t:.3g} the motion has gone further than doubles can count: ask for "
                f"earlier times") from None
