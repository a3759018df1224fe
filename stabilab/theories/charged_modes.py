"""The linear theory of a spinning, nearly axisymmetric charged body with small tilt: its two rates a and b,
its frequencies and resonances, how long it can be believed, and where the body points on average.

Euler's equations (Galal et al., charged body: eq. (1)) with r = r0 and the small-angle kinematics (15):

    p' = M1/D1 - a q,    q' = M2/D2 + b p,    Gamma' + i r0 Gamma = p + i q,    Gamma = psi + i phi

    a = [(D3 - D2) r0 + Lambda] / D1,   b = [(D3 - D1) r0 + Lambda] / D2,   Lambda = lambda3 - k,   k = e H
    l^2 cos(sigma)

With X = D3 r0 + Lambda and Y = X - (D1 + D2) r0:   D1 a = X - D2 r0,   D2 b = X - D1 r0,
r0^2 - ab = -XY/(D1 D2),   (b - a)/2 = (D1 - D2) Y/(2 D1 D2).

Where r0, X and w = sqrt(ab) differ from zero and ab > 0 the tilt is a sum of four rotating parts,
Gamma = steady + coning e^(-i r0 t) + B e^(iwt) + C e^(-iwt), and everything below is read off their sizes.
"""
from __future__ import annotations

from cmath import exp
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache
from math import atan2, hypot, inf, isnan, sqrt
from typing import Any

import numpy as np

from ..errors import InputError, told
from ..numbers.exact import sqrt_fraction
from ..reasons import Inertia, Rate, Reason, Reasoned, Sentence

FIELDS = {"inertia": 3, "spin": 0, "gyrostat": 0, "charge_moment": 0, "torque": 2, "rates": 2, "attitude": 3,
          "force": 3, "mass": 0, "velocity": 3, "position": 3}


@dataclass(frozen=True, eq=False)
class ChargedBody:
    """The body and the start of its motion.

    inertia: D1, D2, D3, kg m^2. spin: r0 = r(0), rad/s. gyrostat: lambda3, kg m^2/s. charge_moment: k = e H
    l^2 cos(sigma), kg m^2/s (C T m^2). torque: M1, M2, N m, body axes (a torque about the spin axis would
    change r0: this theory has none). rates: p, q at t = 0, rad/s. attitude: psi, phi, theta at t = 0 (3-1-2
    sequence), rad. force: f1, f2, f3, N, body axes. mass: kg, None where no translation is asked for.
    velocity, position: inertial, m/s, m; vectors are kept as arrays. Raises InputError for numbers that are
    not finite, and moments or masses that are not positive.
    """

    inertia: Any
    spin: float
    gyrostat: float = 0.0
    charge_moment: float = 0.0
    torque: Any = (0.0, 0.0)
    rates: Any = (0.0, 0.0)
    attitude: Any = (0.0, 0.0, 0.0)
    force: Any = (0.0, 0.0, 0.0)
    mass: float | None = None
    velocity: Any = (0.0, 0.0, 0.0)
    position: Any = (0.0, 0.0, 0.0)

    def __post_init__(self):
        for name, components in FIELDS.items():
            value = getattr(self, name)
            if value is not None or name != "mass":
                object.__setattr__(self, name, _checked(name, value, components))
        if np.any(self.inertia <= 0):
            raise InputError(f"inertia: expected three positive moments, got {self.inertia}")
        if self.mass is not None and self.mass <= 0:
            raise InputError(f"mass: expected a positive number, got {self.mass}")

    @property
    def pull(self) -> complex:
        """M1 + i M2."""
        return complex(*self.torque)

    @property
    def swing(self) -> complex:
        """p + i q at the start."""
        return complex(*self.rates)

    @property
    def tilt(self) -> complex:
        """Gamma = psi + i phi at the start."""
        return complex(*self.attitude[:2])

    @property
    def across(self) -> complex:
        """D1 p + i D2 q at the start."""
        return complex(*(self.inertia[:2] * self.rates))

    @property
    def turn(self) -> complex:
        """e^(i theta) at the start."""
        return exp(1j * self.attitude[2])

    @property
    def along(self) -> float:
        """H3 = D3 r0 + lambda3, rounded once."""
        return float(Fraction(self.inertia[2]) * Fraction(self.spin) + Fraction(self.gyrostat))


def _checked(name, value, components):
    try:
        value = np.array(value, float)  # a copy: what is made of a body is kept with it
    except (TypeError, ValueError):
        raise InputError(f"{name}: expected numbers, got {told(value)}") from None
    if value.shape != ((components,) if components else ()):
        wanted = f"{components} components" if components else "one number"
        raise InputError(f"{name}: expected {wanted}, got the shape {value.shape}")
    if not np.all(np.isfinite(value)):
        raise InputError(f"{name}: expected finite numbers, got {value}")
    return value if components else float(value)


@dataclass(frozen=True)
class Modes:
    """What the body's data make of the linear model, exactly.

    a, b: 1/s. X, Y: kg m^2/s. root: sgn(a + b) sqrt|ab|, good to 240 bits: the frequency w where ab >= 0 and
    the growth rate s (w = i s) where ab < 0, the unstable band.
    """

    a: Fraction
    b: Fraction
    X: Fraction
    Y: Fraction

    @property
    def unstable(self) -> bool:
        return self.a * self.b < 0

    @cached_property
    def root(self) -> Fraction:
        return sqrt_fraction(abs(self.a * self.b)) * (-1 if self.a + self.b < 0 else 1)


@lru_cache(maxsize=64)
def modes(body: ChargedBody) -> Modes:
    """The two rates and the frequency."""
    D1, D2, D3 = map(Fraction, body.inertia)
    r0, Lam = Fraction(body.spin), Fraction(body.gyrostat) - Fraction(body.charge_moment)
    return Modes(((D3 - D2) * r0 + Lam) / D1, ((D3 - D1) * r0 + Lam) / D2, D3 * r0 + Lam,
                 (D3 - D1 - D2) * r0 + Lam)


RESONANCE_WIDTH = 1e-6  # of a resonance


NO_SPIN = Sentence("resonance-no-spin", "r0 = 0: no spin; a transverse torque tilts the body without bound")()
NO_FREQUENCY = Sentence(
    "resonance-no-frequency", "ω = 0: a or b vanishes; p or q grows steadily under a torque, or the motion "
    "drifts")()
NO_AXIAL_MOMENTUM = Sentence(
    "resonance-no-axial-momentum", "r0 = -ω, D3 r0 + Λ = 0: no axial momentum is left to hold the axis; the "
    "tilt grows steadily")()
FREQUENCIES_MEET = Sentence(
    "resonance-frequencies-meet", "r0 = ω, D3 r0 + Λ = (D1 + D2) r0: frequencies meet, a = b, nothing "
    "grows")()
UNSTABLE_BAND = Sentence(
    "unstable-band", "unstable band: a b < 0, the spin axis lies between the two others; p and q grow "
    "exponentially")()
SPIN_CONSTANT = Sentence("spin-constant", "D1 = D2: r is constant and p, q are those of Euler's equations")()
SPIN_HELD = Sentence(
    "spin-held", "r is held at r0; with D1 - D2 = {difference} it changes by {change} at most over these "
    "times, by the model's p and q")


def resonances(body: ChargedBody) -> tuple[Reason, ...]:
    """The resonances and the unstable band that the data meet, to `RESONANCE_WIDTH` of the largest rate among
    r0, a, b. Nothing is singular at a resonance: the closed forms pass through it."""
    m, r0 = modes(body), body.spin
    small = RESONANCE_WIDTH * max(map(abs, (m.a, m.b, Fraction(r0))))
    sides = sqrt(body.inertia[0] * body.inertia[1])
    entries = {NO_SPIN: abs(r0) <= small, NO_FREQUENCY: abs(m.root) <= small,
             NO_AXIAL_MOMENTUM: abs(m.X) <= small * sides, FREQUENCIES_MEET: abs(m.Y) <= small * sides,
             UNSTABLE_BAND: m.unstable}
    return tuple(reason for reason, here in entries.items() if here)


SMALL_ANGLE = 0.1  # rad: cos differs from 1 by 0.5 %, and so the linear rates from the true ones


def horizon(body: ChargedBody) -> float:
    """Time in s until which the tilt |Gamma| stays below SMALL_ANGLE; inf where it does for ever.

    Root of |Gamma0| + |Pi0| t + |mu| t^2/2 = SMALL_ANGLE: for D1 = D2 a lower bound of the true time
    (rotation does not lengthen vectors), for D1 near D2 its leading order; from rest sqrt(2
    SMALL_ANGLE/|mu|).
    """
    room = SMALL_ANGLE - abs(body.tilt)
    if largest_tilt(body) <= SMALL_ANGLE:
        return inf
    if room <= 0:
        return 0.0
    below = abs(body.swing) + sqrt(abs(body.swing)**2 + 2 * hypot(*(body.torque / body.inertia[:2])) * room)
    return 2 * room / below if below else inf


def largest_tilt(body: ChargedBody) -> float:
    """The tilt in rad that the motion never exceeds: |steady| + |coning| + |B| + |C|, inf where it grows.

    For D1 = D2 and r0/w irrational the motion comes as near to it as one likes. From rest and for D1 = D2 it
    is 2 |M/D| / (product of the two smallest among |r0|, |w|, |r0 + w|).
    """
    if body.swing == 0 == body.pull:  # the coning alone is left
        return abs(body.tilt)
    parts = tilt_parts(body)
    return inf if parts is None else sum(map(abs, (parts.steady, parts.coning, parts.B, parts.C)))


def spin_reason(body: ChargedBody, omega, t) -> Reason:
    """How far the spin r, held at r0, is from constant: D3 r' = (D1 - D2) p q, so |r - r0| <= |D1 - D2|
    max(p^2 + q^2) |t|/(2 D3) along the rates omega (n, 3) at the times t (n,)."""
    D1, D2, D3 = body.inertia
    if D1 == D2:
        return SPIN_CONSTANT
    change = (abs(D1 - D2) / (2 * D3) * float((omega[..., 0]**2 + omega[..., 1]**2).max(initial=0.0))
              * float(np.abs(t).max(initial=0.0)))
    return SPIN_HELD(difference=Inertia(D1 - D2), change=Rate(change, digits=2).upper)


@dataclass(frozen=True)
class TiltParts:
    """The complex amplitudes of the tilt (rad) and of p + iq = rate + plus e^(iwt) + minus e^(-iwt) (rad/s),
    and w."""

    steady: complex
    coning: complex
    B: complex
    C: complex
    rate: complex
    plus: complex
    minus: complex
    frequency: float


def tilt_parts(body: ChargedBody) -> TiltParts | None:
    """The four rotating parts of the tilt, from the poles of the linear model; finite through r0 = w. None
    where the tilt is no sum of them."""
    m, r0, M = modes(body), body.spin, body.pull
    if m.unstable or not m.root or not m.X or (not r0 and M):
        return None
    (D1, D2, _), (a, b, X, Y, w) = body.inertia.tolist(), map(float, (m.a, m.b, m.X, m.Y, m.root))
    rate = 1j * M.real / (D1 * a) - M.imag / (D2 * b)
    away = body.swing - rate
    alpha, beta = (a + b) / 2, (D1 - D2) * Y / (2 * D1 * D2)
    lopsided = (beta * away / (alpha + w) + away.conjugate()) / (2 * w)
    plus, minus = away + beta * lopsided, -beta * lopsided
    high, low = r0 + w, r0 - w  # XY = -D1 D2 high low: the one that may be small is got from the other
    if r0 * w > 0:
        C = (D1 - D2) * high * lopsided / (2j * X)
    else:
        high, C = -X * Y / (D1 * D2 * low) if r0 else high, minus / (1j * low)
    coning = body.tilt + 1j * (body.across + 1j * M / (r0 or 1.0)) / X
    return TiltParts(rate / (1j * r0) if r0 else 0j, coning, plus / (1j * high), C, rate, plus, minus, w)


# --- Where the body points on average, and how its spin angle runs away from r0 t: for frequencies 0, r0, w
# that differ, read off the four rotating parts of the tilt
MEAN = Sentence("mean-exists", "r0, D3 r0 + Λ and ω differ from zero, and a b > 0")()
NO_MEAN = Sentence("no-mean", "r0 = 0, ω = 0, r0 = -ω or a b ≤ 0 for some data: the tilt grows or stands")()


@dataclass(frozen=True)
class Pointing(Reasoned):
    """Mean directions; status "mean exists" or "no mean" (reason: which resonance).

    momentum: mean inertial angular momentum across the axis, G1 + i G2, kg m^2/s; momentum_error: the angle
    in rad between it (with G3) and the inertial axis 3. momentum_radius: radius of the circle that a torque
    makes it describe, kg m^2/s. velocity_ratio: (v1 + i v2)/v3 as t grows, 0 where nothing pushes along the
    axis. All are inf without a mean.
    """

    momentum: complex
    momentum_error: float
    momentum_radius: float
    velocity_ratio: complex
    status: str


def pointing(body: ChargedBody) -> Pointing:
    """Mean pointing of the angular momentum and of the velocity.

    G = e^(i theta0) [L0 - i Gamma0 X + i M/r0 - i k coning] on average. The velocity grows along -i f3 e^(i
    theta0) coning across the axis and f3 - f1 Im steady + f2 Re steady along it; from rest and without force
    across the axis the ratio is i M/(r0 (D3 r0 + Lambda)), the paper's (53)-(54) with D3 r0 in place of D3 r0
    + Lambda.
    """
    parts, r0, k = tilt_parts(body), body.spin, body.charge_moment
    if parts is None or not r0:
        return Pointing(inf, inf, inf, inf, "no mean", reason=NO_MEAN)
    swing = 1j * body.pull / r0
    mean = body.turn * (body.across - 1j * body.tilt * (body.along - k) + swing - 1j * k * parts.coning)
    f1, f2, f3 = body.force.tolist()
    across, along = -1j * f3 * body.turn * parts.coning, f3 - f1 * parts.steady.imag + f2 * parts.steady.real
    return Pointing(mean, atan2(abs(mean), body.along), abs(swing), across / along if along else 0j,
                    "mean exists", reason=MEAN)


@dataclass(frozen=True)
class SpinDrift(Reasoned):
    """How theta leaves theta0 + r0 t in the second order of the tilt, averaged over the oscillations.

    rate: rad/s; acceleration: rad/s^2 of the mean spin rate, not zero when M1 M2 (D1 - D2) is not (then rate
    is its value at t = 0). Both are inf without a mean. status "mean exists" or "no mean".
    """

    rate: float
    acceleration: float
    status: str


def spin_drift(body: ChargedBody) -> SpinDrift:
    """Mean of theta' - r0 = r0 (psi^2 - phi^2)/2 - p phi + r2 with D3 r2' = (D1 - D2) p q, along the linear
    motion.

    Averages pair frequencies that cancel: <Gamma^2> = steady^2 + 2 B C, <Pi Gamma> = rate steady + plus C +
    minus B, <conj(Pi) Gamma> = conj(rate) steady + conj(plus) B + conj(minus) C.
    """
    z, r0 = tilt_parts(body), body.spin
    if z is None or not r0 or abs(r0) == abs(z.frequency):
        return SpinDrift(inf, inf, "no mean", reason=NO_MEAN)
    D1, D2, D3 = body.inertia.tolist()
    tilting = r0 * (z.steady**2 + 2 * z.B * z.C).real / 2
    with_rate = (z.rate * z.steady + z.plus * z.C + z.minus * z.B + z.rate.conjugate() * z.steady
                 + z.plus.conjugate() * z.B + z.minus.conjugate() * z.C).imag / 2
    asymmetry = (D1 - D2) / D3
    # the integral of pq = Im(Pi^2)/2 from 0 swings about a mean of its own
    spun = (asymmetry * (2 * z.rate * (z.plus - z.minus) + (z.plus**2 - z.minus**2) / 2).real
            / (2 * z.frequency))
    rate, acceleration = tilting - with_rate + spun, asymmetry * (z.rate**2 + 2 * z.plus * z.minus).imag / 2
    if isnan(rate + acceleration):  # the case is asked for the number that is to blame
        raise OverflowError("the mean of the linear model leaves the range of doubles")
    return SpinDrift(rate, acceleration, "mean exists", reason=MEAN)
