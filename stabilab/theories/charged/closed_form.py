"""Closed-form motion of the charged, nearly axisymmetric body under constant body-fixed torque and force.

The linear model of `axisymmetric_modes`, solved with both of its rates a and b (the paper's equation (8)
keeps one of them: `axisymmetric_corrected`); the formulas are in `axisymmetric_terms`, how far to believe
them in `axisymmetric_limits`.
"""
from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ...errors import InputError
from .modes import ChargedBody, modes, resonances
from .partial_fractions import fractions
from .terms import Terms
from .validity import SMALL_ANGLE, horizon

WITHIN, BEYOND = "small angles", "beyond small angles"


@dataclass(frozen=True, eq=False)
class AxisymmetricMotion:
    """The motion in the linear model at the asked-for times; arrays (..., 3) over the batch of the body and
    of t.

    omega: p, q, r, rad/s, body axes. angles: psi, phi, theta of the 3-1-2 sequence, rad, theta unwrapped.
    momentum: angular momentum (body and rotor, without the charge), kg m^2/s, inertial, first order in the
    tilt. velocity, position: inertial, m/s and m, None without a mass. tilt: |Gamma|, rad, (...). horizon: s,
    until when the tilt stays small (`axisymmetric_limits.horizon`). status: "small angles" or "beyond small
    angles"; reason says from when on and why; resonances: those that the data meet, in words.
    """

    t: np.ndarray
    omega: np.ndarray
    angles: np.ndarray
    momentum: np.ndarray
    velocity: np.ndarray | None
    position: np.ndarray | None
    tilt: np.ndarray
    horizon: np.ndarray
    status: str
    reason: str
    resonances: tuple[str, ...] = field(default=())


def solution(body: ChargedBody, t, small_angle: float = SMALL_ANGLE) -> AxisymmetricMotion:
    """The motion at times t (s, any shape, broadcast against the batch of the body).

    small_angle: the tilt in rad up to which the model counts as valid; it decides status, reason and horizon,
    nothing else. Raises InputError where the unstable motion exceeds the largest double.
    """
    t = times(t)
    omega, angles, momentum, velocity, position = _parts(body, t)
    tilt = np.hypot(angles[..., 0], angles[..., 1])
    until = horizon(body, small_angle)
    status, reason = verdict(tilt, t, until, small_angle)
    return AxisymmetricMotion(t, omega, angles, momentum, velocity, position, tilt, until, status, reason,
                              resonances(body))


def _parts(body, t):
    """Rates, angles, momentum, velocity and position: late times as combinations that are formed once per
    body, the start as it was given, what is left by divided differences at each time."""
    late = fractions(body)
    far = np.abs(t) >= late.wide if late is not None else np.zeros(t.shape, bool)
    if not far.any():
        return _terms(body, t)
    parts = np.empty((5 if body.mass is not None else 3, *t.shape, 3))
    parts[:, far] = late(t[far])
    if (start := t == 0).any():
        parts[:, start] = late.start[:, None]
    if (near := ~far & ~start).any():
        parts[:, near] = [part for part in _terms(body, t[near]) if part is not None]
    return (*parts, None, None)[:5]


def _terms(body, t):
    terms = Terms(body, t, modes(body))
    places = terms.translation() if body.mass is not None else (None, None)
    return terms.angular_velocity(), terms.angles(), terms.momentum(), *places


def times(t):
    """t as an array of finite numbers (s); InputError otherwise."""
    t = np.asarray(t, float)
    if not np.all(np.isfinite(t)):
        raise InputError(f"times: expected finite numbers, got {t}")
    return t


def verdict(tilt, t, until, small):
    """Status and reason of a motion with this tilt at the times t."""
    promise = (
        f"a tilt of {small:g} rad is not reached before t = {np.min(until):.6g} s (estimate from the torque "
        f"and the start)")
    if np.all(np.isinf(until)):
        promise = f"the tilt stays below {small:g} rad for all time"
    if np.all(tilt <= small):
        return WITHIN, promise
    first = np.min(np.abs(np.broadcast_to(t, tilt.shape)[tilt > small]))
    return BEYOND, (f"the model's tilt reaches {np.max(tilt):.4g} rad and exceeds {small:g} rad at t = "
                    f"{first:.6g} s or before: "
                    f"the small-angle equations no longer describe the body; {promise}")
