"""Motions that need no steps: those with a closed solution, judged by the rates alone, and those of one
degree of freedom, as the motion of one state in its potential, in balls.

The laws of closed solutions. free: no torque, so that sum D x^2 is constant. sphere: the rates are x' = m - n
x x with a fixed n (or none); the part along n grows at the rate m . n/|n|, the part across goes round a
circle. axis of symmetry: x_i' = m_i, and the two others turn at the rate w = kappa_j x_i + sigma_j under a
constant push: where m_i is not zero w' is constant, so that (van der Corput) their size stays below that of
the start and 8 |push|/|w'|^(1/2); where it is, w is constant. """
from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache, partial
from types import SimpleNamespace
from typing import Any

from flint import acb, arb, ctx, fmpq_poly, fmpz_poly

from .numbers import (
    AHEAD,
    Malformed,
    Open,
    Rates,
    above,
    ball,
    below,
    exact_sign,
    hull,
    number,
    numbers,
    optional,
    q,
    shown,
    sign,
    word,
    working,
)

LAWS = ("free", "sphere", "axis of symmetry")
BITS = 192


@dataclass(frozen=True)
class ClosedClaims:
    """law; direction of the growth (any length), gain: it grows at least so fast, most: what is across it, or
    the whole rate of a bounded motion, is never larger. None where nothing is claimed."""

    law: str
    direction: list[Fraction] | None
    gain: Fraction | None
    most: Fraction | None


@dataclass(frozen=True)
class Truth:
    """What holds: direction (None: bounded), square of the gain, balls whose sum bounds the size."""

    direction: list[Fraction] | None
    gain_square: Fraction | None
    most: object
    reason: str


def closed_of(table: Mapping[str, Any]) -> ClosedClaims:
    """The claims on a closed solution. Raises `Malformed` before anything is worked out."""
    where = "motion.closed"
    if not isinstance(table, dict):
        raise Malformed(f"{where}: expected an object, got {shown(table)}")
    law = word(table, "law", where, LAWS)
    sizes = [optional(table, key, partial(number, where=f"{where}.{key}")) for key in ("gain", "most")]
    direction = optional(table, "direction", partial(numbers, where=f"{where}.direction", count=3))
    return ClosedClaims(law, direction, *sizes)


def check_closed(rates: Rates, state: Sequence[Fraction], claims: ClosedClaims,
                 note: Callable[[str, str], None]):
    """Findings on a closed solution; (fate, axis, sense, reason) that it proves, or (None, 0, 0, why it
    proves nothing)."""
    with working(BITS):
        truth = _truth(rates, state, claims.law)
        if isinstance(truth, str):
            note(f"law: {claims.law}", "refuted", truth)
            for name in ("direction", "gain", "most"):
                if getattr(claims, name) is not None:
                    note(name, "not checked", truth)
            return None, 0, 0, truth
        note(f"law: {claims.law}", "proved", truth.reason)
        _check_numbers(claims, truth, note)
    axis, sense = _axis(truth.direction)
    return ("spin-up" if truth.direction else "bounded"), axis, sense, truth.reason


def _check_numbers(claims: ClosedClaims, truth: Truth, note: Callable[[str, str], None]):
    if claims.direction is not None:
        right = (truth.direction is not None and any(claims.direction)
                 and _parallel(claims.direction, truth.direction))
        note("direction", "proved" if right else "refuted",
             "the growth has this direction" if right else "it is not that of the growth")
    if claims.gain is not None:
        right = truth.gain_square is not None and 0 < claims.gain and claims.gain**2 <= truth.gain_square
        note("gain", "proved" if right else "refuted",
             f"the rate {'grows' if right else 'does not grow'} at least as fast")
    if claims.most is not None:
        right = bool(truth.most <= ball(claims.most))
        note("most", "proved" if right else "not checked",
             "the size worked out anew is below it" if right else "the size worked out anew is not below it")


def _truth(rates: Rates, state: Sequence[Fraction], law: str):
    """What holds by a law, or why the law is not that of the scene."""
    if rates.parallel is None:
        return "the scene has no body"
    if law == "free":
        return _free(rates, state)
    return _sphere(rates, state) if law == "sphere" else _symmetric(rates, state)


def _free(rates: Rates, state: Sequence[Fraction]):
    if any(rates.m):
        return "a torque acts"
    D = rates.parallel[0]
    return Truth(None, None, ball(sum((d * x * x for d, x in zip(D, state)), Fraction(0)) / min(D)).sqrt(),
                 "without torque the energy is constant")


def _sphere(rates: Rates, state: Sequence[Fraction]):
    if any(rates.kappa) or not any(rates.m):
        return "the moments are not all equal, or no torque acts"
    turn = [rates.rho[k] for _, k in AHEAD]  # lambda/D: rho_k = lambda_i/D with i ahead of k
    if [-v for v in turn] != [rates.sigma[j] for j, _ in AHEAD]:
        return "the rates are not those of a turn"
    if not any(turn):
        return Truth(list(rates.m), _dot(rates.m, rates.m), _across(state, rates.m),
                     "equal moments without a wheel: the rates are constant")
    along, square = _dot(rates.m, turn), _dot(turn, turn)
    size = _across(state, turn) + 2 * _across(rates.m, turn) / ball(square).sqrt()
    if not along:
        return Truth(None, None, size + ball(_dot(state, turn) ** 2 / square).sqrt(),
                     "equal moments, the torque across the wheel: the rates go round a circle")
    return Truth([v if along > 0 else -v for v in turn], along**2 / square, size,
                 "equal moments: the rate along the wheel's momentum grows steadily")


def _symmetric(rates: Rates, state: Sequence[Fraction]):
    if not any(rates.m):
        return "no torque acts"
    rows = [i for i in range(3) if not rates.kappa[i] and not rates.rho[i] and not rates.sigma[i]]
    if len(rows) != 1:
        return "no axis, or more than one, about which the spin obeys the torque alone"
    (i,) = rows
    j, k = AHEAD[i]
    if rates.rho[j] or rates.sigma[k] or rates.kappa[j] != -rates.kappa[k] or rates.sigma[j] != -rates.rho[
        k] or not rates.kappa[j]:
        return "the other two rates do not turn as a body of revolution's"
    flat = [v * (n != i) for n, v in enumerate(rates.m)]
    cone, push = (ball(_dot(v, v)).sqrt() for v in ([x * (n != i) for n, x in enumerate(state)], flat))
    if rates.m[i]:
        size = cone + 8 * push / ball(abs(rates.kappa[j] * rates.m[i])).sqrt()
        unit = [Fraction((n == i) * (1 if rates.m[i] > 0 else -1)) for n in range(3)]
        return Truth(unit, rates.m[i] ** 2, size, "the spin about the axis of symmetry is linear in time")
    turn = rates.kappa[j] * state[i] + rates.sigma[j]
    if turn:
        return Truth(None, None, cone + 2 * push / ball(abs(turn)) + ball(abs(state[i])),
                     "the turn about the axis of symmetry is steady")
    return Truth(flat, _dot(flat, flat), _across(state, flat),
                 "the transverse rates do not turn: they grow along the torque")


def _axis(direction):
    """(axis 1, 2, 3 or 0, sense; 0, 1 for a direction along none; 0, 0 for none)."""
    if direction is None:
        return 0, 0
    entries = [n for n in range(3) if direction[n]]
    return (entries[0] + 1, 1 if direction[entries[0]] > 0 else -1) if len(entries) == 1 else (0, 1)


def _dot(a, b):
    return sum((x * y for x, y in zip(a, b)), Fraction(0))


def _across(vector, along):
    """The size of the part of a vector across another, a ball."""
    return ball(_dot(vector, vector) - _dot(vector, along) ** 2 / _dot(along, along)).sqrt()


def _parallel(a, b):
    """Whether two vectors have one direction and sense, exactly."""
    return all(a[j] * b[k] == a[k] * b[j] for j, k in AHEAD) and _dot(a, b) > 0


# --- One orbit as motion in a potential: x_j, x_k as functions of alpha with alpha' = x_i + s, and y^2/2 +
# U(alpha) = E
class Orbit:
    """The orbit of an exact state about axis i; the rates must be (x_i + s)(p x_k + p0), (x_i + s)(q x_j +
    q0) across it.

    u, v: x_j and x_k; du/dalpha = p v + p0, dv/dalpha = q u + q0; y' = F(alpha), U' = -F, U(0) = 0. kind: -1
    circle, 1 hyperbola, 0 parabola; tilt: the constant part of the force, in whose direction a circle's
    potential falls.
    """

    def __init__(self, rates, axis, state):
        shift = _shift(rates, axis)
        if shift is None:
            raise ValueError("no reduction about this axis")
        j, k = AHEAD[axis]
        self.axis, self.j, self.k, self.s = axis, j, k, shift
        self.p, self.p0, self.q, self.q0 = rates.kappa[j], rates.rho[j], rates.kappa[k], rates.sigma[k]
        self.kappa, self.rho, self.sigma, self.m = (c[axis]
                                                    for c in (rates.kappa, rates.rho, rates.sigma, rates.m))
        self.u0, self.v0, self.y0 = state[j], state[k], state[axis] + shift
        self.E = self.y0 * self.y0 / 2
        self.kind = exact_sign(self.p * self.q)
        self.F0 = self.kappa * self.u0 * self.v0 + self.rho * self.v0 + self.sigma * self.u0 + self.m
        if self.kind:
            self.a, self.b = -self.kappa / (2 * self.p), -self.kappa / (2 * self.q)
            self.c = (-self.rho - self.b * self.q0) / self.p
            self.d = (-self.sigma - self.a * self.p0) / self.q
            self.tilt = self.m + self.c * self.p0 + self.d * self.q0
            self.cu, self.cv = -self.q0 / self.q, -self.p0 / self.p
        else:
            self.tilt = self.m
            self._series()

    def _series(self):
        """Coefficients of u, v, F, U in alpha: one of p, q vanishes, so u and v are polynomials."""
        p, p0, q, q0, u0, v0 = self.p, self.p0, self.q, self.q0, self.u0, self.v0
        self.us = [u0, p * v0 + p0, p * q0 / 2 if not q else Fraction(0)]
        self.vs = [v0, q * u0 + q0, q * p0 / 2 if not p else Fraction(0)]
        F = [Fraction(0)] * 5
        for r, a in enumerate(self.us):
            for t, b in enumerate(self.vs):
                F[r + t] += self.kappa * a * b
        for r in range(3):
            F[r] += self.rho * self.vs[r] + self.sigma * self.us[r]
        F[0] += self.m
        self.Fs, self.Us = F, [Fraction(0), *(-c / (n + 1) for n, c in enumerate(F))]

    @property
    def balls(self):
        """The constants as balls at the working precision."""
        return _balls(self, ctx.prec)

    @property
    def turn(self):
        """One turn of a circle in alpha."""
        return 2 * arb.pi() / self.balls.n

    @property
    def past_a_turn(self) -> Fraction:
        """Somewhat more than a turn: at a whole one the force may vanish again, and no ball would tell its
        sign there."""
        return above(self.turn) * 65 / 64

    def constant(self, which: int) -> bool:
        """Whether u (0) or v (1) does not change along the orbit at all."""
        first, second = self.p * self.v0 + self.p0, self.q * self.u0 + self.q0
        return (first == 0 and self.p * second == 0) if which == 0 else (second == 0 and self.q * first == 0)

    def forceless(self) -> bool:
        """Whether the force vanishes all along."""
        return (not any((self.kappa, self.rho, self.sigma, self.m))
                or (self.constant(0) and self.constant(1) and not self.F0))

    def place(self, alpha: arb | acb):
        """(u, v) at a ball alpha, real or complex."""
        g = self.balls
        if self.kind == 0:
            return _poly(g.us, alpha), _poly(g.vs, alpha)
        if g.decays:  # one exponential, without the difference of two large ones
            e = (-g.decays * g.n * alpha).exp()
            return g.cu + g.du * e, g.cv + g.dv * e
        angle = g.n * alpha
        s, c = (angle.sin(), angle.cos()) if self.kind < 0 else (angle.sinh(), angle.cosh())
        return g.cu + g.du * c + g.su * s, g.cv + g.dv * c + g.sv * s

    def decays(self) -> int:
        """On a plane of a hyperbola: 1 where the place decays with growing alpha, -1 where it grows, else 0.
        """
        if self.kind < 1:
            return 0
        a, b = self.p * self.v0 + self.p0, self.q * self.u0 + self.q0
        du, dv = self.u0 - self.cu, self.v0 - self.cv
        if not (du or dv) or a * a != self.p * self.q * du * du or b * b != self.p * self.q * dv * dv:
            return 0
        return -exact_sign(a * du) or -exact_sign(b * dv)

    def spots(self, left: arb, right: arb) -> list:
        """The places between two, balls, where the force changes sign, rising; the state's own is none of
        them. Raises Open where one cannot be distinguished from an end."""
        result = _spots(self, ctx.prec)
        if self.kind < 0:
            first, last = (int(end // below(self.turn)) for end in (below(left), above(right)))
            result = [point + n * self.turn for n in range(first - 1, last + 2) for point in result]
        nearby = [point for point in result if not (point.is_zero() or point < left or point > right)]
        if not all(point > left and point < right for point in nearby):
            raise Open
        return nearby

    def _zeros(self):
        """All zeros of the force: (polynomial, place of a root of it as a ball, None where that is not of the
        orbit; places besides, each with its order)."""
        if self.kind == 0:
            return fmpq_poly([q(c) for c in self.Fs]), lambda root: root, []
        g, cu, cv, du, dv = self.balls, self.cu, self.cv, self.u0 - self.cu, self.v0 - self.cv
        if g.decays:  # a quadratic in the exponential
            slope = self.kappa * (cu * dv + cv * du) + self.rho * dv + self.sigma * du
            constant = self.kappa * cu * cv + self.rho * cv + self.sigma * cu + self.m
            return (fmpq_poly([q(c) for c in (constant, slope, self.kappa * du * dv)]),
                    lambda root: None if root <= 0 else -root.log() / (g.decays * g.n), [])
        force, rows = self._along_chords(), [[arb(c) for c in row.coeffs()] for row in self._chord()]

        def place(root: arb | acb):
            w, u, v = (_poly(row, root) for row in rows)
            return self._offset(u / w, v / w)
        beyond = 4 - force.degree()  # the line of no finite slope
        return force, place, [(self._offset(ball(self.u0), ball(2 * cv - self.v0)), beyond)] if beyond else []

    def _along_chords(self):
        """The force where the line of slope t through the state meets the conic again, times w^2 of `_chord`:
        a polynomial of degree four in t."""
        w, u, v = self._chord()
        return q(self.kappa) * u * v + (q(self.rho) * v + q(self.sigma) * u) * w + q(self.m) * w * w

    def _chord(self):
        """(w, u, v): that place is (u, v)/w."""
        du, dv = self.u0 - self.cu, self.v0 - self.cv
        t = fmpq_poly([0, 1])
        # the line of slope t through the state meets the conic again at (u, v)/w
        w = q(self.q) - q(self.p) * t * t
        step = -2 * (q(self.q * du) - q(self.p * dv) * t)
        return w, q(self.u0) * w + step, q(self.v0) * w + t * step

    def _offset(self, u: arb, v: arb):
        """alpha of a place on the conic: on a circle within a turn, None on a hyperbola's other branch."""
        g, u, v = self.balls, u - self.balls.cu, v - self.balls.cv
        if self.kind > 0:  # (u, v)' = (p v, q u): this combination goes like exp(n alpha)
            ratio = (u + g.p / g.n * v) / (g.du + g.p / g.n * g.dv)
            if not ratio > 0 and not ratio < 0:
                raise Open
            return ratio.log() / g.n if ratio > 0 else None
        det = g.du * g.sv - g.dv * g.su
        return _angle((g.du * v - g.dv * u) / det, (u * g.sv - v * g.su) / det) / g.n

    def stationary(self, which: int, right: arb) -> list:
        """Where u (0) or v (1), which is not constant, is stationary: on a circle on the last turn before a
        place."""
        g = self.balls
        if self.kind == 0:
            _, slope, bend = (self.us, self.vs)[which]
            return [ball(-slope / (2 * bend))] if bend else []
        d, s = ((g.du, g.su), (g.dv, g.sv))[which]
        if self.kind > 0:
            far, slope = ((self.u0 - self.cu, self.p * self.v0 + self.p0),
                          (self.v0 - self.cv, self.q * self.u0 + self.q0))[which]
            crossed = slope**2 < self.p * self.q * far**2  # |s| < |d|: d sinh + s cosh vanishes
            return [((d - s) / (d + s)).log() / (2 * g.n)] if crossed else []
        half, first = self.turn / 2, _angle(s, d) / g.n
        last = int((above(right) - below(first)) // below(half)) + 1
        return [first + n * half for n in range(last - 3, last + 1)]

    def force(self, alpha: arb | acb):
        """F = y'."""
        g = self.balls
        if self.kind == 0:
            return _poly(g.Fs, alpha)
        u, v = self.place(alpha)
        return g.kappa * u * v + g.rho * v + g.sigma * u + g.m

    def potential(self, alpha: arb | acb):
        """U, zero at alpha = 0."""
        g = self.balls
        if self.kind == 0:
            return _poly(g.Us, alpha)
        u, v = self.place(alpha)
        return (g.half_a * (u * u - g.u0 * g.u0) + g.half_b * (v * v - g.v0 * g.v0) + g.c * (u - g.u0)
                + g.d * (v - g.v0) - g.tilt * alpha)

    def excess(self, alpha: arb | acb):
        """U - E: negative where the motion may be."""
        return self.potential(alpha) - self.balls.E


@lru_cache(maxsize=16)
def _balls(orbit: Orbit, bits: int):
    """Every constant of an orbit as a ball of so many bits."""
    o, names = orbit, ("p", "p0", "q", "q0", "kappa", "rho", "sigma", "m", "u0", "v0", "E", "tilt")
    g = SimpleNamespace(**{name: ball(getattr(o, name)) for name in names})
    if o.kind == 0:
        g.us, g.vs, g.Fs, g.Us = ([ball(c) for c in row] for row in (o.us, o.vs, o.Fs, o.Us))
        return g
    g.n, g.decays = ball(abs(o.p * o.q)).sqrt(), o.decays()
    g.cu, g.du, g.su = ball(o.cu), ball(o.u0 - o.cu), ball(o.p * o.v0 + o.p0) / g.n
    g.cv, g.dv, g.sv = ball(o.cv), ball(o.v0 - o.cv), ball(o.q * o.u0 + o.q0) / g.n
    g.half_a, g.half_b, g.c, g.d = ball(o.a / 2), ball(o.b / 2), ball(o.c), ball(o.d)
    return g


@lru_cache(maxsize=16)
def _spots(orbit: Orbit, bits: int):
    """Where the force changes sign, balls of so many bits, rising: on a circle from 0 to a turn, exactly 0
    for the state itself. The force may vanish to any order: an even one changes no sign."""
    force, location, result = orbit._zeros()
    if force == 0:
        raise Open
    w = orbit._chord()[0] if orbit.kind and not orbit.balls.decays else fmpq_poly([1])
    result = result + [(location(root), order) for factor, order in force.factor()[1] if w % factor != 0
                     for root in _real_roots(factor)]
    result = [(point, order) for point, order in result if point is not None]
    here = [0 in point for point, _ in result]
    if not all(point.is_finite() for point, _ in result) or sum(here) != (orbit.F0 == 0):
        raise Open
    spots = [arb(0) if 0 in point else point + orbit.turn if orbit.kind < 0 and point < 0 else point
             for point, order in result if order % 2]
    return sorted(spots, key=lambda point: below(point))


def _angle(y: arb, x: arb):
    """atan2(y, x), from -pi/2 to 3 pi/2 where the cut is near."""
    return arb.atan2(y, x) if not (0 in y and not x > 0) else arb.pi() + arb.atan2(-y, -x)


def _poly(coefficients: Sequence[arb], alpha: arb | acb):
    total = alpha * 0
    for c in reversed(coefficients):
        total = total * alpha + c
    return total


def _shift(rates: Rates, axis: int):
    """s with which both rates across the axis are multiples of (x_i + s), and no torque acts there; None
    without one."""
    j, k = AHEAD[axis]
    if rates.m[j] or rates.m[k]:
        return None
    # rate j: kappa x_k x_i + rho x_i + sigma x_k;  rate k: kappa x_i x_j + rho x_j + sigma x_i
    for s in [c / d for c, d in ((rates.sigma[j], rates.kappa[j]), (rates.rho[k], rates.kappa[k]))
              if d] or [Fraction(0)]:
        if (rates.sigma[j] == s * rates.kappa[j] and s * rates.rho[j] == 0
                and rates.rho[k] == s * rates.kappa[k] and s * rates.sigma[k] == 0):
            return s
    return None


def _real_roots(factor):
    """The real roots of an irreducible polynomial with rational coefficients, as balls."""
    full = fmpz_poly([int(c * factor.denom()) for c in factor.coeffs()])
    return [root.real for root, _ in full.complex_roots() if root.imag == 0]


# --- The period of a motion between two turning points: verified quadrature, with the root at each end
# bounded by hand
def period_of(orbit: Orbit, ends: Sequence[arb], goal: int):
    """T = 2 int_l^r dalpha / sqrt(2 (E - U)) as a ball, to about `goal` bits. Raises Open where the precision
    does not do."""
    left, right = ends
    length = below(right) - above(left)
    if not length > 0:
        raise Open
    # this part of the way at each end is bounded by the force's range instead
    step = length / 2**(2 * goal // 3)
    inner_left, inner_right = above(left) + step, below(right) - step
    total = _end(orbit, left, inner_left) + _end(orbit, right, inner_right)
    return 2 * (total + _integral(orbit, ball(inner_left), ball(inner_right), goal))


def round_once(orbit, goal):
    """Time of one turn of a circle without torque, over every barrier."""
    return _integral(orbit, ball(0), orbit.turn, goal)


def _integral(orbit: Orbit, low: arb, high: arb, goal: int):
    """int dalpha / sqrt(2 (E - U)) where E - U is positive."""

    def integrand(z: acb, analytic: bool):
        # mean-value form: U's terms cancel, and over a wide ball their sum alone would be far too wide
        centre = z.mid()
        return _rsqrt(2 * (orbit.force(z) * (z - centre) - orbit.excess(centre)), analytic)
    value = acb.integral(integrand, acb(low), acb(high), rel_tol=2.0**-goal, eval_limit=200_000)
    if not value.is_finite():
        raise Open
    return value.real


def _rsqrt(w: acb, analytic: bool):
    """1/sqrt(w); not a number where the ball meets the branch cut and analyticity is asked for."""
    if analytic and not w.real > 0 and 0 in w.imag:
        return acb("nan")
    return w.rsqrt()


def _end(orbit: Orbit, turning: arb, inner: Fraction):
    """int from the turning point to `inner` of dalpha/sqrt(2 (E - U)): E - U is between f and F times the
    distance."""
    outer = below(turning) if ball(inner) > turning else above(turning)
    force = abs(orbit.force(hull(*sorted((outer, inner)))))
    if sign(force) != 1:
        raise Open
    distance = abs(ball(inner) - turning)
    # int_0^d dx/sqrt(2 f x) = sqrt(2 d/f), f somewhere in the range of the force
    return (2 * distance / force).sqrt()
