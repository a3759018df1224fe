"""Classical Euler angles of a top along a run: precession psi, nutation theta, self-rotation phi, followed
through whole turns however far apart its times are.

gamma = (sin theta sin phi, sin theta cos phi, cos theta); phi' + psi' cos theta = r, and

    psi' = (p gamma + q gamma')/(1 - gamma''^2)

(Amer et al. 2023, fast top: eq. (42) prints 1 - gamma'^2). Where theta is 0 or pi, psi and phi have no values
of their own, but psi + phi has at theta = 0 and psi - phi at theta = pi. What is integrated is therefore psi
+ phi where gamma'' >= 0 and psi - phi where it is negative, with rates that stay regular there, and psi
follows by taking off phi. At a sample with sin theta < 1e-8 phi keeps its last value; `status` is then
"singular" and `reason` says when.
"""
from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from ..errors import InputError
from ..integrate.trajectory import ALL_REACHED
from ..reasons import Angle, Reason, Reasoned, Sentence, Time, chained
from .follow import follow

if TYPE_CHECKING:
    from ..case.read import Case

SINGULAR = 1e-8  # below this sin(theta) rounding decides phi
AWAY = 0.1  # 1 +- gamma'' beyond this is far enough from the pole for a smooth rate
COARSE = 1e-3  # rad: an estimated error of psi above this is said
FINEST = 2**16  # samples of one revolution, at the most


@dataclass(frozen=True)
class EulerAngles(Reasoned):
    """psi, theta, phi (n,), rad, at t (n,), s; theta in [0, pi], psi and phi unwrapped, psi = 0 at the
    first time. error: estimated error of psi, rad. status: "regular",
    "singular" (theta reaches 0 or pi), "coarse" (the samples are too far apart for psi); reason: in words."""

    t: np.ndarray
    psi: np.ndarray
    theta: np.ndarray
    phi: np.ndarray
    error: float
    status: str


def euler_angles(t: np.ndarray, omega: np.ndarray, gamma: np.ndarray) -> EulerAngles:
    """Angles along samples of any motion.

    t: (n,) strictly increasing, s; omega: (n, 3) rad/s and gamma: (n, 3), body frame. psi is the integral of
    its rate through a cubic spline of the samples, so they must resolve the motion (some twenty to a
    revolution; the error is estimated from every other sample). Raises InputError for arrays of other shapes
    and for times that do not increase.
    """
    t, omega, gamma = (np.asarray(x, float) for x in (t, omega, gamma))
    if t.ndim != 1 or not t.size or omega.shape != (t.size, 3) or gamma.shape != (t.size, 3):
        raise InputError(f"expected t (n,), omega (n, 3), gamma (n, 3); got shapes {t.shape}, {omega.shape}, "
                         f"{gamma.shape}")
    if not (np.diff(t) > 0).all():
        raise InputError("t: expected strictly increasing times")
    gamma = _unit(gamma)
    phi, singular = _phi(t, omega, gamma)
    psi = _psi(t, omega, gamma, phi)
    error = (float(np.abs(_psi(t[::2], omega[::2], gamma[::2], phi[::2]) - psi[::2]).max()) / 15
             if t.size > 4 else 0.0)
    status, reason = _verdict(t[singular], error)
    return EulerAngles(t, psi, _theta(gamma), phi, error, status, reason=reason)


def _unit(gamma: np.ndarray):
    length = np.linalg.norm(gamma, axis=1)
    if not (length > 0).all():
        raise InputError("gamma: expected vectors other than zero")
    return gamma / length[:, None]


def _theta(gamma: np.ndarray):
    return np.arctan2(np.hypot(gamma[:, 0], gamma[:, 1]), gamma[:, 2])


THETA_SINGULAR = Sentence(
    "theta-singular", "θ is 0 or π at t = {time}: there only the sum (or difference) of ψ and φ means "
    "something; φ keeps its last value")
TOO_COARSE = Sentence("samples-too-coarse", "the samples are too far apart: ψ is known to about {error}")
THETA_REGULAR = Sentence("theta-regular", "θ stays away from 0 and π at all samples")()
WITH_ANGLES = Sentence("with-euler-angles", "Euler angles: {angles}, ψ known to about {error}")


def _verdict(times, error) -> tuple[str, Reason]:
    if times.size:
        return "singular", THETA_SINGULAR(time=Time(float(times[0])))
    if error > COARSE:
        return "coarse", TOO_COARSE(error=Angle(float(error), digits=2))
    return "regular", THETA_REGULAR


def _moment(omega: np.ndarray, gamma: np.ndarray):
    return omega[:, 0] * gamma[:, 0] + omega[:, 1] * gamma[:, 1]


def _rates(omega: np.ndarray, gamma: np.ndarray):
    """Rates of psi + phi and of psi - phi; each held finite where the other one is in use."""
    m, r, g3 = _moment(omega, gamma), omega[:, 2], gamma[:, 2]
    return r + m / np.maximum(1 + g3, AWAY), -r + m / np.maximum(1 - g3, AWAY)


def _phi(t: np.ndarray, omega: np.ndarray, gamma: np.ndarray):
    """(phi unwrapped along its rate, where it has no value)."""
    phi, sine = np.arctan2(gamma[:, 0], gamma[:, 1]), np.hypot(gamma[:, 0], gamma[:, 1])
    singular = sine < SINGULAR
    if singular.any():
        last = np.maximum.accumulate(np.where(singular, 0, np.arange(t.size)))
        phi = phi[last] if not singular[0] else np.where(last > 0, phi[last], phi[np.argmin(singular)])
    rate = omega[:, 2] - _moment(omega, gamma) * gamma[:, 2] / np.maximum(sine, SINGULAR)**2
    expected = np.diff(t) * (rate[1:] + rate[:-1]) / 2
    step = np.diff(phi)
    # Beside a pole the rate says nothing: there the shorter way round is taken.
    blind = (singular[1:] | singular[:-1]
             | (np.abs(expected - np.diff(t) * (omega[1:, 2] + omega[:-1, 2]) / 2) > np.pi))
    turns = np.where(blind, -np.round(step / (2 * np.pi)), np.round((expected - step) / (2 * np.pi)))
    return phi + 2 * np.pi * np.concatenate([[0.0], np.cumsum(turns)]), singular


def _psi(t: np.ndarray, omega: np.ndarray, gamma: np.ndarray, phi: np.ndarray):
    """psi - psi(first), by the integral of psi + phi or psi - phi, whichever is regular."""
    if t.size == 1:
        return np.zeros(1)
    from scipy.interpolate import CubicSpline
    total, difference = (np.diff(CubicSpline(t, rate).antiderivative()(t)) for rate in _rates(omega, gamma))
    turn = np.diff(phi)
    upper = gamma[1:, 2] + gamma[:-1, 2] >= 0
    return np.concatenate([[0.0], np.cumsum(np.where(upper, total - turn, difference + turn))])


def mean_precession(motion) -> float:
    """Mean of psi' over a period of a `LindstedtMotion`, rad/s. Where theta passes through 0 or pi it is the
    mean of (psi +- phi)' less that of phi' counted at the samples. Raises InputError where the axis stays
    within 1e-8 of the vertical."""
    n = 64
    while True:
        s = np.linspace(0, 2 * np.pi, n + 1)  # the phase of the motion
        omega, gamma = motion.at(s / motion.frequency)
        omega, gamma = omega / motion.frequency, _unit(gamma)
        phi, _ = _phi(s, omega, gamma)
        low, high = gamma[:, 2].min(), gamma[:, 2].max()
        # of phi in the sum that is regular; 0: neither is
        sign = 1 if low > AWAY - 1 else -1 if high < 1 - AWAY else 0
        rate = (_rates(omega, gamma)[0 if sign > 0 else 1] if sign else
                _moment(omega, gamma) / np.maximum(1 - gamma[:, 2]**2, SINGULAR**2))
        waves = np.abs(np.fft.rfft(rate[:-1]))
        settled = waves[n // 4:].max() < 1e-15 * waves.max() and np.abs(np.diff(phi)).max() < 1
        if settled or n >= FINEST:
            break
        n *= 2
    if (np.hypot(gamma[:, 0], gamma[:, 1]) < SINGULAR).mean() > 0.5:
        raise InputError("the axis stays within 1e-8 rad of the vertical: psi has no rate of its own there; "
                         "start further off")
    return motion.frequency * float(rate[:-1].mean() - sign * (phi[-1] - phi[0]) / (2 * np.pi))


TO_A_TURN = 60  # points to a turn of the fastest rate: psi is then known to some 1e-7
MAX_STEPS = 400_000


def with_euler_angles(case, run, model: str = "exact", order: int | None = None):
    """The run with a part "euler", (n, 3), rad: precession psi (0 at t = 0), nutation theta, rotation phi of
    the weight's direction gamma (Amer et al. 2023, fast top: eq. (42), corrected); its reason says where they
    are singular.

    The motion is followed again at times close enough for psi. Raises InputError where the state has no
    gamma.
    """
    if "gamma" not in run.state:
        raise InputError("angles: psi, theta, phi of the vertical need gamma in the state: an effect that "
                         "needs it (gravity, "
                         "newtonian_field, a charge with angle = \"attitude\"), or vertical in [motion]")
    if not len(run.t):
        return replace(run, state=run.state | {"euler": np.empty((0, 3))})
    result = angles_along(case, run.t, model, order)
    at, start = np.searchsorted(result.t, run.t), int(np.argmin(np.abs(result.t)))
    angles = np.stack([result.psi - result.psi[start], result.theta, result.phi], axis=-1)[at]
    reason = chained(None if run.reason == ALL_REACHED else run.reason,
                     WITH_ANGLES(angles=result.reason, error=Angle(result.error, digits=1)))
    return replace(run, state=run.state | {"euler": angles}, reason=reason)


def angles_along(case: Case, times: np.ndarray, model: str = "exact",
                 order: int | None = None) -> EulerAngles:
    """The angles from 0 to the farthest of the times (n,), s, on both sides of 0 where they lie so; at those
    times, at 0, and close enough for psi."""
    times = np.asarray(times, float)
    reach, row = float(np.abs(times).max()), np.asarray(follow(case, times, model,
                                                               order=order).state["omega"])
    fastest = float(np.linalg.norm(np.vstack([row, case.state]), axis=1).max())
    count = int(min(MAX_STEPS, 2 + np.ceil(reach * fastest * TO_A_TURN / (2 * np.pi))))
    sides = [sign * np.linspace(0.0, reach, count) for sign in (1, -1) if (sign * times > 0).any()]
    full = follow(case, np.unique(np.concatenate([[0.0], times, *sides])), model, order=order)
    return euler_angles(full.t, full.state["omega"], full.state["gamma"])
