"""Where the charged axisymmetric body points on average, and how its spin angle runs away from r0 t.

Read off the four rotating parts of the tilt (`modes.tilt_parts`), for frequencies 0, r0, w that differ.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .modes import ChargedBody, tilt_parts


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
    return Pointing(*(np.where(exists, v, np.inf) for v in values), *_verdict(exists))  # type: ignore[arg-type]


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
    return SpinDrift(drift, acceleration, *_verdict(exists))


def _verdict(exists):
    if np.all(exists):
        return "mean exists", "r0, D3 r0 + Lambda and omega differ from zero, and a b > 0"
    return "no mean", "r0 = 0, omega = 0, r0 = -omega or a b <= 0 for some data: the tilt grows or stands"
