"""The charged axisymmetric body by the paper's formulas, typed as they stand in print, misprints and all.

Galal et al., charged body, (11)-(13), (20)-(26), (33), (35), (43)-(51), (58)-(66). MISPRINTS says what is wrong with each.
Supplied is only what print leaves open: zeta3 and zeta4 of (64), not defined: (sqrt(zeta1) +- sqrt(zeta2))/(2 zeta) as in
(49); the bracket of (45) and (60) that does not close, closed as in (46). The short form (Elneklawy) prints the same, but
for the second zeta of (46). `axisymmetric_corrected` has the integrals that the paper means.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...errors import InputError
from .closed_form import times, verdict
from .corrected import momentum
from .modes import ChargedBody
from .validity import SMALL_ANGLE, horizon

PARTS = ("omega", "angles", "momentum", "velocity", "position")
# equation of the paper: (what it gives, what is wrong in print, what `axisymmetric_corrected` takes instead)
MISPRINTS = {
    "(8)": ("frequency W", "zeta1 D1 stands in both lines of (7): not an approximation for D1 near D2, the phase is off", "as printed"),
    "(11)": ("p1 + i q1", "", "as printed"),
    "(13)": ("p, q", "the second form of q lacks 1/i", "q = Im Pi1 / sqrt(zeta1), its first form"),
    "(20)-(26)": ("psi, phi, theta", "", "as printed"),
    "(30), (38)": ("rotation", "R23 = sin(theta) sin(phi) - cos(theta) sin(psi) cos(phi); printed with cos(theta) sin(phi)",
                   "the true R23, which (31), (33) and (40) use"),
    "(33)": ("G1 + i G2", "", "as printed"),
    "(35)": ("G1 + i G2", "leaves out the charge, G0 and theta0: it holds for k = 0, a start from rest and theta0 = 0 only",
             "as printed: circle"),
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
    """The printed motion at the asked-for times; units, frames and shapes as in `AxisymmetricMotion`, None where not asked for.

    omega: (13), q by its first form. angles: (26). momentum: (33). velocity: (43), (47). position: (58), (63). status,
    reason: how far this motion's own tilt is small, and what is to be known of the print.
    """

    t: np.ndarray
    omega: np.ndarray
    angles: np.ndarray | None
    momentum: np.ndarray | None
    velocity: np.ndarray | None
    position: np.ndarray | None
    status: str
    reason: str


def printed(body: ChargedBody, t, parts=PARTS, small_angle: float = SMALL_ANGLE) -> PrintedMotion:
    """The paper's formulas for the asked-for parts of the state at times t (s, any shape).

    Raises InputError for D3 not above D1 and D2 (the paper takes roots of zeta1 and zeta2), for velocity or position without
    a mass, and where the formulas of a part divide by zero (near that they lose digits: they are partial fractions).
    """
    t, typed = times(t), Typed.of(body, times(t))
    omega, found = typed.rates(), dict.fromkeys(PARTS[1:])
    if set(parts) & set(PARTS[1:]):
        found["angles"] = typed.angles()
    if "momentum" in parts:
        found["momentum"] = momentum(body, omega, found["angles"])
    if set(parts) & {"velocity", "position"}:
        found |= typed.translation()
    tilt = np.zeros(omega.shape[:-1]) if found["angles"] is None else np.hypot(*np.moveaxis(found["angles"], -1, 0)[:2])
    status, reason = verdict(tilt, t, horizon(body, small_angle), small_angle)
    return PrintedMotion(t, omega, **found, status=status, reason=reason)


def circle(body: ChargedBody, t) -> np.ndarray:
    """G1, G2 of (35), (..., 2), kg m^2/s: i M (1 - e^(i r0 t))/r0. Raises InputError for r0 = 0, where (35) divides by it."""
    if np.any(body.spin == 0):
        raise InputError("r0 = 0: the printed (35) divides by it")
    M = body.torque[..., 0] + 1j * body.torque[..., 1]
    G = 1j * M * (1 - np.exp(1j * body.spin * times(t))) / body.spin
    return np.stack([G.real, G.imag], axis=-1)


@dataclass(frozen=True, eq=False)
class Typed:
    """The numbers of the paper at the times t, and its integrals as typed.

    up = W + r0, down = r0 - W; again: what stands for `down` in the exponents of (46), with a second zeta before Lambda.
    """

    body: ChargedBody
    t: np.ndarray
    r0: np.ndarray
    W: np.ndarray
    again: np.ndarray
    roots: tuple  # of zeta1 and zeta2
    Pi10: np.ndarray
    A: np.ndarray

    @classmethod
    def of(cls, body, t):
        """(4), (6), (10) and the frequency of (8)."""
        D1, D2, D3 = np.moveaxis(body.inertia, -1, 0)
        zeta1, zeta2, r0 = (D3 - D2) / D1, (D3 - D1) / D2, body.spin
        if np.any((zeta1 <= 0) | (zeta2 <= 0)):
            raise InputError(f"the printed formulas take roots of zeta1 and zeta2: D3 must exceed D1 and D2; got {body.inertia}")
        root1, root2 = np.sqrt(zeta1), np.sqrt(zeta2)
        zeta, Lambda = root1 * root2, (body.gyrostat - body.charge_moment) / (zeta1 * D1)
        W = zeta * (r0 + Lambda)
        if np.any(W == 0):
            raise InputError("W = 0: the printed formulas divide by their frequency (8), which is zero here")
        return cls(body, t, r0, W, r0 - zeta * (r0 + zeta * Lambda), (root1, root2),
                   body.rates[..., 0] * root2 + 1j * body.rates[..., 1] * root1,
                   body.torque[..., 0] * root2 / D1 + 1j * body.torque[..., 1] * root1 / D2)

    @property
    def up(self):
        return self.W + self.r0

    @property
    def down(self):
        return self.r0 - self.W

    def rates(self):
        """(11)-(13), q by its first form."""
        turn = self._e(self.W)
        Pi1 = self.Pi10 * turn + 1j * self.A / self.W * (1 - turn)
        return _three(Pi1.real / self.roots[1], Pi1.imag / self.roots[0], self.r0)

    def angles(self):
        """(20), (23), (26)."""
        if np.any(self.r0 * self.up * self.down == 0):
            raise InputError("r0 = 0 or r0 = +-W: the printed formulas for angles, velocity and position divide by zero here")
        Gamma = self._e(-self.r0) * (self._tilt0 + self._both(self.I1_Gamma, self.I2_Gamma))
        return _three(Gamma.real, Gamma.imag, self.body.attitude[..., 2] + self.r0 * self.t)

    def translation(self) -> dict:
        """(43), (47), (58) and (63)."""
        body, t, r0, m, Gamma0 = self.body, self.t, self.r0, self.body.mass, self._tilt0
        if m is None:
            raise InputError("the printed translation formulas need a mass: give mass = ... in kg")
        f, f3, turn = body.force[..., 0] + 1j * body.force[..., 1], body.force[..., 2], np.exp(1j * body.attitude[..., 2])
        e, back = self._e(r0), self._e(-r0)
        omega = 1j * turn / m * (f / r0 * (1 - e) - f3 * (Gamma0 * t + self._both(self.I1_omega, self.I2_omega)))
        under = 1j * Gamma0 / r0 * (back - 1) + self._both(self.I4_omega, self.I5_omega)
        eta = (1j * turn * f * t / (m * r0)
               + turn / m * (f * (e - 1) / r0**2 - 1j * f3 * (Gamma0 * t**2 / 2 + self._both(self.I1_eta, self.I2_eta))))
        under_eta = 1j * Gamma0 / r0 * (1j * (back - 1) / r0 - t) + self._both(self.I4_eta, self.I5_eta)
        along = lambda z: (1j / 2 * (np.conj(f) * z - f * np.conj(z))).real / m
        v0, x0 = body.velocity, body.position
        return {"velocity": v0 + _three(omega.real, omega.imag, f3 * t / m + along(under)),
                "position": x0 + v0 * t[..., None] + _three(eta.real, eta.imag, f3 * t**2 / (2 * m) + along(under_eta))}

    @property
    def _tilt0(self):
        return self.body.attitude[..., 0] + 1j * self.body.attitude[..., 1]

    def _both(self, first, second):
        """(23), (44), (49), (59), (64)."""
        root1, root2 = self.roots
        return ((root1 + root2) * first() + (root1 - root2) * second()) / (2 * root1 * root2)

    def _e(self, x):
        return np.exp(1j * x * self.t)

    def _omega(self, x, sign, within=None):
        """sign i (1 - e^(i x t))/x - t, with another frequency within the exponent where print has one."""
        return sign * 1j * (1 - self._e(x if within is None else within)) / x - self.t

    def I1_Gamma(self):  # (24)
        e = (self._e(self.up) - 1) / self.up
        return -1j * self.Pi10 * e + self.A / self.W * ((self._e(self.r0) - 1) / self.r0 - e)

    def I2_Gamma(self):  # (25)
        e = (self._e(self.down) - 1) / self.down
        return -1j * np.conj(self.Pi10) * e - np.conj(self.A) / self.W * ((self._e(self.r0) - 1) / self.r0 - e)

    def _omegas(self, x, Pi10, A, sign, within=None):
        term = self._omega(x, sign, within)
        return -1j * Pi10 / x * term + A / self.W * (self._omega(self.r0, 1) / self.r0 - term / x)

    def I1_omega(self):  # (45)
        return self._omegas(self.up, self.Pi10, self.A, 1)

    def I2_omega(self):  # (46)
        return self._omegas(self.down, np.conj(self.Pi10), -np.conj(self.A), -1, self.again)

    def I4_omega(self):  # (50)
        return self._omegas(self.up, self.Pi10, self.A, -1)

    def I5_omega(self):  # (51)
        return self._omegas(self.down, np.conj(self.Pi10), -np.conj(self.A), 1)

    def _etas(self, x, Pi10, A, bracket):
        t, r0 = self.t, self.r0
        term = 1j / x * (t + 1j * bracket / x) - t**2 / 2
        spin = 1j / r0 * (t - 1j / r0 * (1 - self._e(r0))) - t**2 / 2
        return -1j * Pi10 / x * term + A / self.W * (spin / r0 - term / x)

    def I1_eta(self):  # (60)
        return self._etas(self.up, self.Pi10, self.A, self._e(self.up) - 1)

    def I2_eta(self):  # (61)
        return self._etas(self.down, np.conj(self.Pi10), -np.conj(self.A), 1 - self._e(self.down) - 1)

    def I4_eta(self):  # (65)
        return self._etas(self.up, self.Pi10, self.A, self._e(self.up) - 1)

    def I5_eta(self):  # (66)
        return self._etas(self.down, self.Pi10, -np.conj(self.A), 1 - self._e(self.down))


def _three(x, y, z):
    return np.stack(np.broadcast_arrays(x, y, z), axis=-1)
