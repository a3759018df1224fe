"""The paper's own motion of the charged axisymmetric body: one frequency where the linear equations have two rates.

Galal et al., charged body. Its step from (7) to (8) puts zeta1 D1 for zeta2 D2:

    p1' = A1 - W q1,  q1' = A2 + W p1,   W = zeta [r0 + Lambda/(zeta1 D1)],   p = p1/sqrt(zeta2),  q = q1/sqrt(zeta1)

In p and q that keeps a and replaces b = zeta2 r0 + Lambda/D2 by zeta2 r0 + Lambda zeta2/(zeta1 D1) = a zeta2/zeta1: exact
for D1 = D2 and for Lambda = 0, otherwise a wrong frequency W for sqrt(ab), and a phase error that grows with t and does
not shrink with the amplitude. `printed` is this model, solved without further error; `axisymmetric_typed.literal` types the
formulas as they stand in print. MISPRINTS says what is wrong with each and what was taken instead.
"""
from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..errors import InputError
from .axisymmetric import times, verdict
from .axisymmetric_limits import SMALL_ANGLE, horizon
from .axisymmetric_modes import ChargedBody, modes
from .axisymmetric_terms import Terms
from .twofold import twofold

# equation of the paper: (what it gives, what is wrong in print, what `printed` takes)
MISPRINTS = {
    "(8)": ("frequency W", "zeta1 D1 stands in both lines of (7): not an approximation for D1 near D2, the phase is off", "as printed"),
    "(11)": ("p1 + i q1", "", "as printed"),
    "(13)": ("p, q", "the second form of q lacks 1/i", "q = Im Pi1 / sqrt(zeta1), its first form"),
    "(20)-(26)": ("psi, phi, theta", "", "as printed"),
    "(30), (38)": ("rotation", "R23 = sin(theta) sin(phi) - cos(theta) sin(psi) cos(phi); printed with cos(theta) sin(phi)",
                   "the true R23, which (31), (33) and (40) use"),
    "(33)": ("G1 + i G2", "", "as printed"),
    "(35)": ("G1 + i G2", "leaves out the charge, G0 and theta0: it holds for k = 0, a start from rest and theta0 = 0 only",
             "as printed: momentum_circle"),
    "(37)": ("acceleration", "lacks 1/m", "(40), which has it"),
    "(42)": ("velocity", "lacks its value at t = 0", "(43), which has it"),
    "(46)": ("I2 omega", "sign of both exponential terms; a second zeta before Lambda in the exponent", "the integral of (25)"),
    "(50), (51)": ("I4, I5 omega", "e^(-i r0 t) under the integral is left out; sign of the exponential terms in (50)",
                   "the integral of e^(-i r0 t) times (24), (25)"),
    "(53), (54)": ("velocity ratio", "hold for Lambda = 0 only: D3 r0 stands for D3 r0 + Lambda", "pointing(body).velocity_ratio"),
    "(58)": ("transverse displacement", "sign of f (e^(i r0 t) - 1)/r0^2; Gamma0 t for Gamma0 tau under the integral",
             "the integral of (43)"),
    "(61)": ("I2 eta", "1 - e^(...) - 1 for e^(...) - 1", "the integral of the true (46)"),
    "(64)": ("I3 eta", "zeta3 and zeta4 are not defined: (sqrt(zeta1) +- sqrt(zeta2))/(2 zeta)", "the integral of (48)"),
    "(65), (66)": ("I4, I5 eta", "e^(-i r0 t) left out: (65) repeats (60); Pi10 for its conjugate and wrong signs in (66)",
                   "the integrals of the true (50), (51)"),
}


@dataclass(frozen=True, eq=False)
class PrintedMotion:
    """The paper's model at the asked-for times; units, frames and shapes as in `AxisymmetricMotion`.

    momentum: by (33). momentum_circle: by (35), (..., 2), kg m^2/s, inf for r0 = 0. frequency: W, rad/s, over the batch.
    velocity, position: the integrals that the paper means (None without a mass); see MISPRINTS. status, reason: how far
    this model's own tilt is small.
    """

    t: np.ndarray
    omega: np.ndarray
    angles: np.ndarray
    momentum: np.ndarray
    momentum_circle: np.ndarray
    velocity: np.ndarray | None
    position: np.ndarray | None
    frequency: np.ndarray
    status: str
    reason: str


def printed(body: ChargedBody, t, small_angle: float = SMALL_ANGLE) -> PrintedMotion:
    """The paper's single-frequency motion at times t (s, any shape), evaluated without loss at its own resonances too.

    Raises InputError where D3 lies between D1 and D2 or equals one of them: the paper divides by zeta1 and zeta2 and takes
    the root of their product.
    """
    t = times(t)
    m = one_frequency(body)
    terms = Terms(body, t, m)
    omega, angles = terms.angular_velocity(), terms.angles()
    velocity, position = terms.translation() if body.mass is not None else (None, None)
    r0, M = body.spin, body.torque[..., 0] + 1j * body.torque[..., 1]
    swing = terms.vector(*_parts(1j * M * (1 - np.exp(1j * r0 * t)) / np.where(r0 == 0, 1.0, r0)))
    circle = np.where(np.broadcast_to(r0 == 0, terms.shape)[..., None], np.inf, swing)
    frequency = np.abs(m.root.value()) * np.sign(terms.a) * np.sign(body.inertia[..., 2] - body.inertia[..., 0])
    return PrintedMotion(t, omega, angles, _momentum(body, omega, angles), circle, velocity, position, frequency,
                         *verdict(np.hypot(angles[..., 0], angles[..., 1]), t, horizon(body, small_angle), small_angle))


def one_frequency(body: ChargedBody):
    """The modes with the paper's b: a zeta2/zeta1 (twofold)."""
    m = modes(body)
    D1, D2, D3 = (twofold(body.inertia[..., i]) for i in range(3))
    zeta1, zeta2 = (D3 - D2) / D1, (D3 - D1) / D2
    if np.any(zeta1.high * zeta2.high <= 0):
        raise InputError(f"the paper's formulas need D3 above both D1 and D2, or below both; got {body.inertia}")
    b = m.a * zeta2 / zeta1
    squared = m.a * b
    root = squared.sqrt() * np.where(m.a.high < 0, -1.0, 1.0)
    return replace(m, b=b, squared=squared, root=root, unstable=squared.high < 0)


def _momentum(body, omega, angles):
    """(33): G = e^(i theta) [D1 p + i D2 q - i Gamma (D3 r0 + lambda3)]."""
    D1, D2, D3 = np.moveaxis(body.inertia, -1, 0)
    H3 = D3 * body.spin + body.gyrostat
    G = np.exp(1j * angles[..., 2]) * (D1 * omega[..., 0] + 1j * D2 * omega[..., 1]
                                       - 1j * (angles[..., 0] + 1j * angles[..., 1]) * H3)
    return np.stack(np.broadcast_arrays(G.real, G.imag, H3), axis=-1)


def _parts(z):
    return z.real, z.imag
