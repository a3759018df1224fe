"""The paper's formulas for tilt, velocity and displacement of the charged axisymmetric body, typed as they stand in print.

For the comparison of print and truth only; what is wrong with each is said in `axisymmetric_printed.MISPRINTS`.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..errors import InputError
from .axisymmetric import times
from .axisymmetric_modes import ChargedBody


def literal(body: ChargedBody, t) -> dict:
    """Angles, velocity and position exactly as typed in (24)-(25), (43)-(51) and (58)-(66), misprints and all.

    {"angles", "velocity", "position"}: arrays (..., 3). Only two things are supplied: zeta3, zeta4 of (64), and Lambda in the
    exponent of (46) without its second zeta. Raises InputError without a mass, for D3 not above D1 and D2, and at r0 = 0,
    W = 0, r0 = +-W, where the typed formulas divide by zero (near these they lose digits: they are partial fractions).
    """
    if body.mass is None:
        raise InputError("the printed translation formulas need a mass: give mass = ... in kg")
    t, (D1, D2, D3) = times(t), np.moveaxis(body.inertia, -1, 0)
    zeta1, zeta2, r0 = (D3 - D2) / D1, (D3 - D1) / D2, body.spin
    if np.any((zeta1 <= 0) | (zeta2 <= 0)):
        raise InputError(f"the printed formulas take roots of zeta1 and zeta2: D3 must exceed D1 and D2; got {body.inertia}")
    zeta, root1, root2 = np.sqrt(zeta1 * zeta2), np.sqrt(zeta1), np.sqrt(zeta2)
    W = zeta * (r0 + (body.gyrostat - body.charge_moment) / (zeta1 * D1))
    up, down = W + r0, r0 - W
    if np.any(r0 * W * up * down == 0):
        raise InputError("r0 = 0, W = 0 or r0 = +-W: the printed formulas divide by zero here; use printed() or solution()")
    typed = Typed(t, r0, W, up, down, body.rates[..., 0] * root2 + 1j * body.rates[..., 1] * root1,
                   body.torque[..., 0] * root2 / D1 + 1j * body.torque[..., 1] * root1 / D2)
    plus, minus = (root1 + root2) / (2 * zeta), (root1 - root2) / (2 * zeta)
    both = lambda first, second: plus * first() + minus * second()  # noqa: E731
    return _assembled(body, t, {"Gamma": both(typed.I1_Gamma, typed.I2_Gamma), "omega": both(typed.I1_omega, typed.I2_omega),
                                "3omega": both(typed.I4_omega, typed.I5_omega), "eta": both(typed.I1_eta, typed.I2_eta),
                                "3eta": both(typed.I4_eta, typed.I5_eta)})


def _assembled(body, t, I):
    """(20), (43), (47), (58) and (63) from their integrals I."""
    r0, m, turn = body.spin, body.mass, np.exp(1j * body.attitude[..., 2])
    Gamma0 = body.attitude[..., 0] + 1j * body.attitude[..., 1]
    f, f3 = body.force[..., 0] + 1j * body.force[..., 1], body.force[..., 2]
    v0, x0 = body.velocity, body.position
    e, back = np.exp(1j * r0 * t), np.exp(-1j * r0 * t)
    Gamma = Gamma0 * back + back * I["Gamma"]
    omega = 1j * turn / m * (f / r0 * (1 - e) - f3 * (Gamma0 * t + I["omega"]))
    under = 1j * Gamma0 / r0 * (back - 1) + I["3omega"]
    eta = 1j * turn * f * t / (m * r0) + turn / m * (f * (e - 1) / r0**2 - 1j * f3 * (Gamma0 * t**2 / 2 + I["eta"]))
    under_eta = 1j * Gamma0 / r0 * (1j * (back - 1) / r0 - t) + I["3eta"]
    along = lambda z: (1j / 2 * (np.conj(f) * z - f * np.conj(z))).real / m  # noqa: E731
    three = lambda x, y, z: np.stack(np.broadcast_arrays(x, y, z), axis=-1)  # noqa: E731
    return {"angles": three(Gamma.real, Gamma.imag, body.attitude[..., 2] + r0 * t),
            "velocity": v0 + three(omega.real, omega.imag, f3 * t / m + along(under)),
            "position": x0 + v0 * t[..., None] + three(eta.real, eta.imag, f3 * t**2 / (2 * m) + along(under_eta))}


@dataclass(frozen=True, eq=False)
class Typed:
    """The paper's integrals as typed; up = W + r0, down = r0 - W."""

    t: np.ndarray
    r0: np.ndarray
    W: np.ndarray
    up: np.ndarray
    down: np.ndarray
    Pi10: np.ndarray
    A: np.ndarray

    def _e(self, x):
        return np.exp(1j * x * self.t)

    def _omega(self, x, sign):
        return sign * 1j * (1 - self._e(x)) / x - self.t

    def I1_Gamma(self):  # (24)
        e = (self._e(self.up) - 1) / self.up
        return -1j * self.Pi10 * e + self.A / self.W * ((self._e(self.r0) - 1) / self.r0 - e)

    def I2_Gamma(self):  # (25)
        e = (self._e(self.down) - 1) / self.down
        return -1j * np.conj(self.Pi10) * e - np.conj(self.A) / self.W * ((self._e(self.r0) - 1) / self.r0 - e)

    def _omegas(self, x, Pi10, A, first, last):
        return (-1j * Pi10 / x * self._omega(x, first)
                + A / self.W * (self._omega(self.r0, 1) / self.r0 - self._omega(x, last) / x))

    def I1_omega(self):  # (45)
        return self._omegas(self.up, self.Pi10, self.A, 1, 1)

    def I2_omega(self):  # (46)
        return self._omegas(self.down, np.conj(self.Pi10), -np.conj(self.A), -1, -1)

    def I4_omega(self):  # (50)
        return self._omegas(self.up, self.Pi10, self.A, -1, -1)

    def I5_omega(self):  # (51)
        return self._omegas(self.down, np.conj(self.Pi10), -np.conj(self.A), 1, 1)

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
