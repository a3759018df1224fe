"""The fast top's first approximation as Amer et al. 2023 (fast top) print it: eqs. (4), (10), (41), (42), (43).

For comparison only. What is wrong in it:

- (18), (22), (23): the generating solution has the permanent tilt P0 = y1 C/(C* - A) in p1; (22), (23) and (41) drop it, so
  for l_x != 0 p is wrong at its leading order, gamma1, gamma1', gamma1'' at their first;
- (41): cos tau with tau = r0 t; the frequency nu = 1 + O(eps^2) is missing, so the phase is lost after 1/eps^2 revolutions;
- (41): gamma1' has second-order terms X(y0'/a + lambda2 M3 sin tau) that no equation gives: gamma1'(0) != 0 and |gamma| != 1;
- (41): gamma1'' has y1 where P0 belongs, and a term y1 y3; with (10) it is right to second order for l_x = l_z = 0 only;
- (10): X and Omega^2 are cut off after the first power of l_z/r0 (C* = C + l_z/r0 in place of C makes them exact);
- (42): 1 - gamma'^2 under psi' stands for 1 - gamma''^2; (43): csc(eps theta0) stands for csc theta0, kept as printed;
- (43): wrong signs of the y0' terms, sin r0 t in theta2 and cos r0 t in psi2 (and so in phi2); theta1 carries y1 where P0
  belongs; psi1 is not 0 (it integrates P0 cos tau); psi3 lacks factors 1/r0;
- the text's "no singular points for any frequency": Omega = 0, Omega = 1 and C = B are poles of (41) itself.
"""
from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...errors import InputError
from .lindstedt import times_row
from .scaling import fast_top


@dataclass(frozen=True)
class PaperNumbers:
    """The dimensionless numbers of eqs. (4) and (10) as printed, for one scene and start; h: the start's place in
    the paper's time, s (its tau = 0 has gamma' = 0)."""

    r0: float
    c: float
    gamma0: float
    epsilon: float
    x: float
    y: float
    z: float
    k: float
    a: float
    b: float
    A1: float
    B1: float
    C1: float
    X: float
    Omega2: float
    lambda_: float
    lambda1: float
    lambda2: float
    y1: float
    y3: float
    M3: float
    h: float


@dataclass(frozen=True)
class PrintedMotion:
    """The printed solution at t (n,), s: omega (n, 3) rad/s, gamma (n, 3) (not of length 1), psi, theta, phi (n,) rad of
    (43) with psi0 = 0. status: "as printed" or "pole" (a divisor is 0: no numbers, empty arrays); reason in words."""

    t: np.ndarray
    omega: np.ndarray
    gamma: np.ndarray
    psi: np.ndarray
    theta: np.ndarray
    phi: np.ndarray
    epsilon: float
    status: str
    reason: str


def paper_numbers(scene, state) -> PaperNumbers:
    """Eqs. (4) and (10) for a scene with gravity, gamma0'' > 0 and l_y = 0. Raises InputError elsewhere, and
    ZeroDivisionError at the poles C = B, Omega^2 = 0 and Omega^2 = 1."""
    top = fast_top(scene, state)
    gamma0 = float(top.gamma[2])
    if not any(top.force) or gamma0 <= 0:
        raise InputError("the printed solution divides by sqrt(M g L gamma0''): it needs gravity and a third component of gamma "
                         f"above 0, got M g L/(C r0^2) = {math.hypot(*map(float, top.force)):g} and gamma0'' = {gamma0:g}")
    if top.tilt[1]:
        raise InputError("the printed solution has the gyrostatic moment (l_x, 0, l_z); the scene's has a second component")
    r0, a, b, lz = float(top.r0), float(top.a), float(top.b), float(top.wheel)
    length = math.hypot(*map(float, top.force))
    x, y, z = (float(f) / length for f in top.force)
    c = math.sqrt(length) * abs(r0)
    k = float(top.field) * r0**2 * gamma0 / c**2
    A1, B1, C1 = float((1 - top.b) / top.a), float((top.a - 1) / top.b), float(top.b - top.a)
    # l_z/(A r0) = lz/a and l_z/(B r0) = lz/b
    X = (1 - lz / (a * A1)) / A1
    Omega2 = -A1 * B1 + (A1 / b - B1 / a) * lz
    lambda1 = (z * (A1 / b - 1 / a) + k * (A1 + A1 * B1) + (z / b + k * B1) * lz / a) / (1 - Omega2)
    share = c * math.sqrt(gamma0) / r0
    M3 = math.sqrt(max(0.0, 1 - gamma0**2)) / gamma0
    h = (math.atan2(float(top.gamma[0]), float(top.gamma[1])) - math.pi / 2) / r0
    return PaperNumbers(r0, c, gamma0, share, x, y, z, k, a, b, A1, B1, C1, X, Omega2, x * (A1 + lz / a) / (b * Omega2),
                        lambda1, lambda1 + z / a - k * A1, float(top.tilt[0]) / share, lz / share, M3, h)


def printed(scene, state, times) -> PrintedMotion:
    """The paper's (41) and (43) at the times, s, through r and gamma of the state at t = 0 (arguments as of `lindstedt`; its
    p, q are not free). Raises InputError without gravity, for gamma0'' not between 0 and 1, and for l_y."""
    times, top = times_row(times), fast_top(scene, state)
    try:
        n = paper_numbers(scene, state)
    except ZeroDivisionError:
        empty = np.empty(0)
        return PrintedMotion(empty, np.empty((0, 3)), np.empty((0, 3)), empty, empty, empty, top.epsilon, "pole",
                             "C = B, Omega = 0 or Omega = 1: the printed solution divides by 0")
    e, tau = n.epsilon, n.r0 * (times + n.h)
    omega, gamma = _solution(n, e, np.cos(tau), np.sin(tau), np.cos(2 * tau))
    psi, theta, phi = _angles(n, times)
    scale = n.c * math.sqrt(n.gamma0)
    return PrintedMotion(times, np.stack([scale * omega[0], scale * omega[1], n.r0 * omega[2]], -1), n.gamma0 * np.stack(gamma, -1),
                         psi, theta, phi, e, "as printed", "eqs. (10), (41) and (43) as they stand in print, misprints and all")


def _solution(n, e, cos, sin, cos2):
    """Eq. (41): (p1, q1, r1), (gamma1, gamma1', gamma1'')."""
    S11 = -2 * n.M3 * (n.x * (1 - cos) + n.y * sin) - n.k * n.M3**2 * n.C1 * (1 - cos2) / 2
    p1 = e * (n.lambda_ + n.lambda1 * n.M3 * cos)
    q1 = (e * n.X * (n.y / n.a + n.lambda2 * n.M3 * sin)
          + e**2 * n.X * (n.y / n.a - n.k * n.A1 * n.M3 * sin) * n.M3 * n.y1 * (1 - cos))
    r1 = 1 + e**2 * S11 / 2
    gamma1 = n.M3 * cos
    gamma2 = -n.M3 * sin + e**2 * (n.X * (n.y / n.a + n.lambda2 * n.M3 * sin) + n.M3 * sin * S11 / 2)
    gamma3 = (1 + e * n.M3 * n.y1 * (1 - cos)
              + e**2 * (n.a * n.lambda_ * n.M3 * (1 - cos) + n.M3**2 * (1 - cos2) * (n.a * n.lambda1 + n.b * n.X * n.lambda2) / 2
                        + n.b * n.X * n.y / n.a * n.M3 * sin - n.M3 * n.y1 * n.y3 * (1 - cos)
                        + n.M3 * (n.x * (1 - cos) + n.y * sin) + n.k * n.M3**2 * n.C1 * (1 - cos2) / 4))
    return (p1, q1, r1), (gamma1, gamma2, gamma3)


def _angles(n, t):
    """Eq. (43), csc(eps theta0) and all: psi (0 at t = 0), theta, phi."""
    theta0, e = math.atan(n.M3), n.epsilon
    difference = [_terms(n, t + n.h)[i] - _terms(n, np.array([n.h]))[i] for i in range(5)]
    theta1, theta2, psi2, psi3, phi3 = difference
    theta = theta0 - e * theta1 - e**2 * theta2
    if theta0 == 0:
        raise InputError("the printed angles divide by sin(theta0), which is 0 for this start")
    root = n.c * math.sqrt(math.cos(theta0))
    psi = root / math.sin(e * theta0) * (e * psi2 + e**2 * psi3)
    phi = (math.pi / 2 + n.r0 * n.h + n.r0 * t - root / math.tan(theta0) * e * psi2
           - e**2 * (n.M3 * phi3 + root / math.tan(theta0) * psi3))
    return psi, theta, phi


def _terms(n, t):
    """theta1, theta2, psi2, psi3, phi3 of (43); psi1 = phi1 = 0, phi2 = psi2, phi4 = psi3 as printed."""
    s, r0 = n.r0 * t, n.r0
    cos, sin, cos2, sin2 = np.cos(s), np.sin(s), np.cos(2 * s), np.sin(2 * s)
    theta2 = ((n.y1 * n.y3 - n.a * n.lambda_ - n.x) * cos - (n.b * n.X / n.a + 1) * n.y * sin
              - n.M3 * (n.a * n.lambda1 + n.b * n.X * n.lambda2 + n.k * n.C1 / 2) * cos2 / 2)
    psi2 = ((n.x * n.A1 / (n.b * n.Omega2) * sin - n.y / (n.A1 * n.a) * cos) / r0
            + n.M3 / 4 * (n.lambda1 * (2 * t + sin2 / r0) + n.lambda2 * (sin2 / (r0 * n.A1) - 2 * n.X * t)))
    psi3 = n.X * n.y1 * n.M3 / 4 * (n.y / n.a * (2 * cos - cos2 / r0)
                                    - n.k * n.A1 * n.M3 * (2 * t - (cos2 - 4 * sin**3) / r0))
    phi3 = n.x * (s - sin) - n.y * cos + n.k * n.C1 * n.M3 * (2 * s - sin2) / 8
    return -n.y1 * cos, theta2, psi2, psi3, phi3
