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

from dataclasses import dataclass
from functools import lru_cache
from typing import Any, TypeAlias

import numpy as np

from ...errors import InputError, told
from ...numbers.double_double import Twofold, twofold

Batch: TypeAlias = Any  # a number or an array of them, with leading batch axes
FIELDS = {"inertia": 3, "spin": 0, "gyrostat": 0, "charge_moment": 0, "torque": 2, "rates": 2, "attitude": 3,
          "force": 3, "mass": 0, "velocity": 3, "position": 3}


@dataclass(frozen=True, eq=False)
class ChargedBody:
    """The body and the start of its motion; every field may carry leading batch axes, which broadcast
    together.

    inertia: D1, D2, D3, kg m^2, (..., 3). spin: r0 = r(0), rad/s. gyrostat: lambda3, kg m^2/s. charge_moment:
    k = e H l^2 cos(sigma), kg m^2/s (C T m^2). torque: M1, M2, N m, body axes (a torque about the spin axis
    would change r0: this theory has none). rates: p, q at t = 0, rad/s. attitude: psi, phi, theta at t = 0
    (3-1-2 sequence), rad. force: f1, f2, f3, N, body axes. mass: kg, None where no translation is asked for.
    velocity, position: inertial, m/s, m. Raises InputError for numbers that are not finite, and moments or
    masses that are not positive.
    """

    inertia: Batch
    spin: Batch
    gyrostat: Batch = 0.0
    charge_moment: Batch = 0.0
    torque: Batch = (0.0, 0.0)
    rates: Batch = (0.0, 0.0)
    attitude: Batch = (0.0, 0.0, 0.0)
    force: Batch = (0.0, 0.0, 0.0)
    mass: Batch | None = None
    velocity: Batch = (0.0, 0.0, 0.0)
    position: Batch = (0.0, 0.0, 0.0)

    def __post_init__(self):
        for name, components in FIELDS.items():
            value = getattr(self, name)
            if value is not None or name != "mass":
                object.__setattr__(self, name, _checked(name, value, components))
        try:
            np.broadcast_shapes(*self.shapes)
        except ValueError:
            raise InputError(f"batch axes do not broadcast together: {self.shapes}") from None
        if np.any(self.inertia <= 0):
            raise InputError(f"inertia: expected three positive moments, got {self.inertia}")
        if self.mass is not None and np.any(self.mass <= 0):
            raise InputError(f"mass: expected a positive number, got {self.mass}")

    @property
    def shapes(self) -> list:
        """The batch shape of every field."""
        present = [(getattr(self, name), bool(size))
                   for name, size in FIELDS.items() if getattr(self, name) is not None]
        return [value.shape[:-1] if vector else value.shape for value, vector in present]


def _checked(name, value, components):
    try:
        value = np.array(value, float)  # a copy: what is made of a body is kept with it
    except (TypeError, ValueError):
        raise InputError(f"{name}: expected numbers, got {told(value)}") from None
    if components and value.shape[-1:] != (components,):
        raise InputError(
            f"{name}: expected {components} components along the last axis, got the shape {value.shape}")
    if not np.all(np.isfinite(value)):
        raise InputError(f"{name}: expected finite numbers, got {value}")
    return value


@dataclass(frozen=True, eq=False)
class Modes:
    """What the body's data make of the linear model; twofold where a difference may be small.

    a, b: 1/s. X, Y: kg m^2/s. squared: ab, 1/s^2. root: sgn(a + b) sqrt|ab|, the frequency w where ab >= 0
    and the growth rate s (w = i s) where ab < 0, the unstable band.
    """

    a: Twofold
    b: Twofold
    X: Twofold
    Y: Twofold
    squared: Twofold
    root: Twofold
    unstable: np.ndarray

    @property
    def frequency(self):
        """w as a complex array: real, or imaginary in the unstable band."""
        return self.root.value() * np.where(self.unstable, 1j, 1.0)


@lru_cache(maxsize=64)
def modes(body: ChargedBody) -> Modes:
    """The two rates and the frequency, with relative error far below the last place of the data."""
    D1, D2, D3 = (twofold(body.inertia[..., i]) for i in range(3))
    r0 = twofold(body.spin)
    Lam = twofold(body.gyrostat) - body.charge_moment
    a, b = ((D3 - D2) * r0 + Lam) / D1, ((D3 - D1) * r0 + Lam) / D2
    squared = a * b
    sign = np.where((a + b).high < 0, -1.0, 1.0)
    root = (squared * np.sign(squared.high)).sqrt() * sign
    return Modes(a, b, D3 * r0 + Lam, (D3 - D1 - D2) * r0 + Lam, squared, root, squared.high < 0)


NEAR = 1e-6  # of a resonance


@lru_cache(maxsize=64)
def resonances(body: ChargedBody) -> tuple[str, ...]:
    """The resonances and the unstable band that the data (any member of the batch) meet, in words, to `NEAR`
    of the largest rate among r0, a, b. Nothing is singular at a resonance: the closed forms pass through
    it."""
    m = modes(body)
    a, b, r0 = m.a.value(), m.b.value(), body.spin
    small = NEAR * np.maximum(np.maximum(np.abs(a), np.abs(b)), np.abs(r0))
    sides = np.sqrt(body.inertia[..., 0] * body.inertia[..., 1])
    found = {
        "r0 = 0: no spin; a transverse torque tilts the body without bound": np.abs(r0) <= small,
        "omega = 0: a or b vanishes; p or q grows steadily under a torque, or the motion drifts":
            np.abs(m.root.value()) <= small,
        "r0 = -omega, D3 r0 + Lambda = 0: no axial momentum is left to hold the axis; the tilt grows "
        "steadily":
            np.abs(m.X.value()) <= small * sides,
        "r0 = omega, D3 r0 + Lambda = (D1 + D2) r0: frequencies meet, a = b, nothing grows":
            np.abs(m.Y.value()) <= small * sides,
        "unstable band: a b < 0, the spin axis lies between the two others; p and q grow exponentially":
            m.unstable & (np.abs(m.root.value()) > 0),
    }
    return tuple(words for words, here in found.items() if np.any(here))


SMALL_ANGLE = 0.1  # rad: cos differs from 1 by 0.5 %, and so the linear rates from the true ones


@lru_cache(maxsize=64)
def horizon(body: ChargedBody):
    """Time in s until which the tilt |Gamma| stays below SMALL_ANGLE, over the batch; inf where it does
    for ever.

    Root of |Gamma0| + |Pi0| t + |mu| t^2/2 = SMALL_ANGLE: for D1 = D2 a lower bound of the true time
    (rotation does not lengthen vectors), for D1 near D2 its leading order; from rest sqrt(2
    SMALL_ANGLE/|mu|).
    """
    room = SMALL_ANGLE - np.hypot(body.attitude[..., 0], body.attitude[..., 1])
    rate = np.hypot(body.rates[..., 0], body.rates[..., 1])
    push = np.hypot(body.torque[..., 0] / body.inertia[..., 0], body.torque[..., 1] / body.inertia[..., 1])
    below = rate + np.sqrt(rate**2 + 2 * push * np.maximum(room, 0.0))
    until = np.where(room <= 0, 0.0, 2 * np.maximum(room, 0.0) / np.where(below == 0, 1.0, below))
    return np.where((largest_tilt(body) <= SMALL_ANGLE) | ((below == 0) & (room > 0)), np.inf, until)


def largest_tilt(body: ChargedBody):
    """The tilt in rad that the motion never exceeds, over the batch: |steady| + |coning| + |B| + |C|, inf
    where it grows.

    For D1 = D2 and r0/w irrational the motion comes as near to it as one likes. From rest and for D1 = D2 it
    is 2 |M/D| / (product of the two smallest among |r0|, |w|, |r0 + w|).
    """
    parts = tilt_parts(body)
    at_start = np.abs(body.attitude[..., 0] + 1j * body.attitude[..., 1])
    bound = sum(np.abs(x) for x in (parts.steady, parts.coning, parts.B, parts.C))
    return np.where(parts.undriven, at_start, np.where(parts.regular, bound, np.inf))


def spin_words(body: ChargedBody, omega, t) -> str:
    """How far the spin r, held at r0, is from constant: D3 r' = (D1 - D2) p q, so |r - r0| <= |D1 - D2|
    max(p^2 + q^2) |t|/(2 D3) along the rates omega (n, 3) at the times t (n,)."""
    D1, D2, D3 = body.inertia
    if D1 == D2:
        return "D1 = D2: r is constant and p, q are those of Euler's equations"
    change = (abs(D1 - D2) / (2 * D3) * float((omega[..., 0]**2 + omega[..., 1]**2).max(initial=0.0))
              * float(np.abs(t).max(initial=0.0)))
    return (f"r is held at r0; with D1 - D2 = {D1 - D2:.6g} kg m^2 it changes by {change:.2g} rad/s at most "
            "over these times, by the model's p and q")


@dataclass(frozen=True, eq=False)
class TiltParts:
    """The complex amplitudes of the tilt (rad) and of p + iq = rate + plus e^(iwt) + minus e^(-iwt) (rad/s),
    over the batch.

    regular: where they exist (elsewhere they are 0); undriven: where p, q and M are zero and only the coning
    is left.
    """

    steady: np.ndarray
    coning: np.ndarray
    B: np.ndarray
    C: np.ndarray
    rate: np.ndarray
    plus: np.ndarray
    minus: np.ndarray
    frequency: np.ndarray
    regular: np.ndarray
    undriven: np.ndarray


def tilt_parts(body: ChargedBody) -> TiltParts:
    """The four rotating parts of the tilt, from the poles of the linear model; finite through r0 = w."""
    m, r0 = modes(body), body.spin
    D1, D2 = body.inertia[..., 0], body.inertia[..., 1]
    a, b, X, Y, root = (z.value() for z in (m.a, m.b, m.X, m.Y, m.root))
    M = body.torque[..., 0] + 1j * body.torque[..., 1]
    Pi0 = body.rates[..., 0] + 1j * body.rates[..., 1]
    regular = ~m.unstable & (root != 0) & (X != 0) & ((r0 != 0) | (M == 0))
    one = lambda z: np.where(regular & (z != 0), z, 1.0)
    rate = np.where(regular, 1j * body.torque[..., 0] / one(D1 * a) - body.torque[..., 1] / one(D2 * b), 0)
    w, away = one(root), Pi0 - rate
    alpha, beta = (a + b) / 2, (D1 - D2) * Y / (2 * D1 * D2)
    lopsided = (beta * away / one(alpha + w) + np.conj(away)) / (2 * w)
    plus, minus = away + beta * lopsided, -beta * lopsided
    high, low = r0 + w, r0 - w
    # the one of the two that may be small: XY = -D1 D2 (r0 + w)(r0 - w)
    meet = np.where(r0 * w > 0, low, high)
    meet = np.where(r0 * w == 0, meet, -X * Y / (D1 * D2 * one(np.where(r0 * w > 0, high, low))))
    B = plus / (1j * one(np.where(r0 * w > 0, high, meet)))
    C = np.where(r0 * w > 0, (D1 - D2) * high * lopsided / (2j * X * 1.0 + (X == 0)), minus / (1j * one(low)))
    L0 = D1 * body.rates[..., 0] + 1j * D2 * body.rates[..., 1]
    steady = np.where(r0 == 0, 0, rate / (1j * one(r0)))
    coning = body.attitude[..., 0] + 1j * body.attitude[..., 1] + 1j * (L0 + 1j * M / one(r0)) / one(X)
    values = (np.where(regular, z, 0) for z in (steady, coning, B, C, rate, plus, minus, root))
    return TiltParts(*values, regular, (Pi0 == 0) & (M == 0) & np.ones_like(regular))  # type: ignore[call-arg]


# --- Where the body points on average, and how its spin angle runs away from r0 t: for frequencies 0, r0, w
# that differ, read off the four rotating parts of the tilt
@dataclass(frozen=True, eq=False)
class Pointing:
    """Mean directions, over the batch of the body; status "mean exists" or "no mean" (reason: which
    resonance).

    momentum: mean inertial angular momentum across the axis, G1 + i G2, kg m^2/s; momentum_error: the angle
    in rad between it (with G3) and the inertial axis 3. momentum_radius: radius of the circle that a torque
    makes it describe, kg m^2/s. velocity_ratio: (v1 + i v2)/v3 as t grows, 0 where nothing pushes along the
    axis. Elements without a mean hold inf.
    """

    momentum: np.ndarray
    momentum_error: np.ndarray
    momentum_radius: np.ndarray
    velocity_ratio: np.ndarray
    status: str
    reason: str


def pointing(body: ChargedBody) -> Pointing:
    """Mean pointing of the angular momentum and of the velocity.

    G = e^(i theta0) [L0 - i Gamma0 X + i M/r0 - i k coning] on average. The velocity grows along -i f3 e^(i
    theta0) coning across the axis and f3 - f1 Im steady + f2 Re steady along it; from rest and without force
    across the axis the ratio is i M/(r0 (D3 r0 + Lambda)), the paper's (53)-(54) with D3 r0 in place of D3 r0
    + Lambda.
    """
    parts, r0 = tilt_parts(body), body.spin
    exists = parts.regular & (r0 != 0)
    turn, k = np.exp(1j * body.attitude[..., 2]), body.charge_moment
    M = body.torque[..., 0] + 1j * body.torque[..., 1]
    L0 = body.inertia[..., 0] * body.rates[..., 0] + 1j * body.inertia[..., 1] * body.rates[..., 1]
    Gamma0 = body.attitude[..., 0] + 1j * body.attitude[..., 1]
    H3 = body.inertia[..., 2] * r0 + body.gyrostat
    swing = 1j * M / np.where(r0 == 0, 1.0, r0)
    mean = turn * (L0 - 1j * Gamma0 * (H3 - k) + swing - 1j * k * parts.coning)
    f1, f2, f3 = np.moveaxis(body.force, -1, 0)
    across, along = -1j * f3 * turn * parts.coning, f3 - f1 * parts.steady.imag + f2 * parts.steady.real
    ratio = np.where(along == 0, 0, across / np.where(along == 0, 1.0, along))
    values = (mean, np.arctan2(np.abs(mean), H3), np.abs(swing), ratio)
    # four
    return Pointing(*(np.where(exists, v, np.inf) for v in values), *_mean(exists))  # type: ignore[arg-type]


@dataclass(frozen=True, eq=False)
class SpinDrift:
    """How theta leaves theta0 + r0 t in the second order of the tilt, averaged over the oscillations, over
    the batch.

    rate: rad/s; acceleration: rad/s^2 of the mean spin rate, not zero when M1 M2 (D1 - D2) is not (then rate
    is its value at t = 0). Elements without a mean hold inf. status "mean exists" or "no mean".
    """

    rate: np.ndarray
    acceleration: np.ndarray
    status: str
    reason: str


def spin_drift(body: ChargedBody) -> SpinDrift:
    """Mean of theta' - r0 = r0 (psi^2 - phi^2)/2 - p phi + r2 with D3 r2' = (D1 - D2) p q, along the linear
    motion.

    Averages pair frequencies that cancel: <Gamma^2> = steady^2 + 2 B C, <Pi Gamma> = rate steady + plus C +
    minus B, <conj(Pi) Gamma> = conj(rate) steady + conj(plus) B + conj(minus) C.
    """
    z, r0 = tilt_parts(body), body.spin
    D1, D2, D3 = np.moveaxis(body.inertia, -1, 0)
    exists = z.regular & (r0 != 0) & (np.abs(r0) != np.abs(z.frequency))
    w = np.where(exists, z.frequency, 1.0)
    tilting = r0 * (z.steady**2 + 2 * z.B * z.C).real / 2
    with_rate = (z.rate * z.steady + z.plus * z.C + z.minus * z.B
                 + np.conj(z.rate) * z.steady + np.conj(z.plus) * z.B + np.conj(z.minus) * z.C).imag / 2
    asymmetry = (D1 - D2) / D3
    # the integral of pq = Im(Pi^2)/2 from 0 swings about a mean of its own
    spun = asymmetry * (2 * z.rate * (z.plus - z.minus) + (z.plus**2 - z.minus**2) / 2).real / (2 * w)
    acceleration = asymmetry * (z.rate**2 + 2 * z.plus * z.minus).imag / 2
    drift, acceleration = (np.where(exists, v, np.inf) for v in (tilting - with_rate + spun, acceleration))
    return SpinDrift(drift, acceleration, *_mean(exists))


def _mean(exists):
    if np.all(exists):
        return "mean exists", "r0, D3 r0 + Lambda and omega differ from zero, and a b > 0"
    return "no mean", "r0 = 0, omega = 0, r0 = -omega or a b <= 0 for some data: the tilt grows or stands"
