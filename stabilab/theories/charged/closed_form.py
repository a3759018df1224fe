"""The motion of the charged, nearly axisymmetric body in closed form, under constant body-fixed torque and
force.

The linear model of `modes`, solved with both of its rates a and b; how far to believe it: `modes.horizon`.
Every quantity is a sum of divided differences D of the exponential, regular at every resonance. With w^2 =
ab, nu+- = r0 +- w, mu = M1/D1 + i M2/D2, Pi = p + iq, k0 = (w - a) q0 + i (b - w) p0 and k1 the same of mu
(proof: Laplace transform of the linear equations, s/(s^2 + w^2) = 1/(s - iw) - iw/(s^2 + w^2)):

    n-fold integral of Gamma:
        J_n = Gamma0 D[0^n,-ir0] + Pi0 D[0^n,-ir0,iw] + mu D[0^(n+1),-ir0,iw]
              + k0 D[0^n,-ir0,iw,-iw] + k1 D[0^(n+1),-ir0,iw,-iw]
    n-fold integral of e^(ir0t) Gamma:
        Z_n = Gamma0 D[0^(n+1)] + Pi0 D[0^(n+1),inu+] + mu D[0^(n+1),ir0,inu+]
              + k0 D[0^(n+1),inu+,inu-] + k1 D[0^(n+1),ir0,inu+,inu-]

That suits a near b, where k0 and k1 are small. Where one is much larger, or ab < 0, half of Pi0 and mu goes
with -iw: s/(s^2 + w^2) = [1/(s - iw) + 1/(s + iw)]/2, and k0 = -a q0 + i b p0, k1 = -a m2 + i b m1 with m1 +
i m2 = mu.

The paper (Galal et al., charged body) keeps one frequency. Its step from (7) to (8) puts zeta1 D1 for zeta2
D2:

    p1' = A1 - W q1,  q1' = A2 + W p1,   W = zeta [r0 + Lambda/(zeta1 D1)],   p = p1/sqrt(zeta2),  q =
    q1/sqrt(zeta1)

In p and q that keeps a and replaces b = zeta2 r0 + Lambda/D2 by a zeta2/zeta1: exact for D1 = D2 and for
Lambda = 0, otherwise a wrong frequency W for sqrt(ab), and a phase error that grows with t and does not
shrink with the amplitude. `corrected` is this model, solved without further error: what the paper means where
its integrals for velocity and displacement are misprinted. `model.printed` follows the print itself. """
from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np

from ...errors import InputError
from ...numbers.divided_differences import divided_differences
from .modes import SMALL_ANGLE, ChargedBody, Modes, horizon, modes

LOPSIDED = 4.0  # a/b beyond which the even split loses less: w - a cancels against 1 by sqrt(a/b)


class Terms:
    """The divided differences at the times t and the coefficients in front of them."""

    def __init__(self, body: ChargedBody, t, m: Modes):
        self.body, self.t = body, t
        self.p0, self.q0 = body.rates.tolist()
        self.m1, self.m2 = (body.torque / body.inertia[:2]).tolist()
        self.a, self.b = float(m.a), float(m.b)
        self.nodes, self.low = _nodes(m, body.spin)
        a, b = abs(m.a), abs(m.b)
        even = m.unstable or a > LOPSIDED * b or b > LOPSIDED * a
        self.share = 0.5 if even else 1.0
        self.above, self.below = map(float, (-m.a, m.b) if even else (m.root - m.a, m.b - m.root))

    def _tables(self, names, counts):
        return divided_differences([self.nodes[n] for n in names], counts, self.t,
                                   [self.low[n] for n in names])

    def vector(self, *components):
        return np.stack([np.broadcast_to(c, self.t.shape) for c in components], axis=-1)

    def angular_velocity(self):
        """p, q of the real form: cos(wt), sin(wt)/w and (1 - cos(wt))/w^2 are even in w and real in the
        unstable band too."""
        plus, minus, S, S2 = ((0, 1, 0), (0, 0, 1), (0, 1, 1), (1, 1, 1))
        D = {c: v.real for c, v in self._tables("0+-", [plus, minus, S, S2]).items()}
        C, S, S2 = (D[plus] + D[minus]) / 2, D[S], D[S2]
        p = self.p0 * C + (self.m1 - self.a * self.q0) * S - self.a * self.m2 * S2
        q = self.q0 * C + (self.m2 + self.b * self.p0) * S + self.b * self.m1 * S2
        return self.vector(p, q, self.body.spin)

    def _sums(self, names, folds, Gamma0):
        """The divided differences of each fold with the coefficients Gamma0, Pi0, mu, k0, k1 of the module's
        formulas."""
        D = self._tables(names, {counts for each in folds.values() for counts in each})
        k0 = self.above * self.q0 + 1j * self.below * self.p0
        k1 = self.above * self.m2 + 1j * self.below * self.m1
        Pi0, mu, rest = self.p0 + 1j * self.q0, self.m1 + 1j * self.m2, 1 - self.share
        factors = (Gamma0, self.share * Pi0, rest * Pi0, self.share * mu, rest * mu, k0, k1)
        return {n: sum(factor * D[counts] for factor, counts in zip(factors, each))
                for n, each in folds.items()}

    def J(self, *folds):
        """The n-fold integrals of Gamma, for the n in folds."""
        counts = {n: ((n, 1, 0, 0), (n, 1, 1, 0), (n, 1, 0, 1), (n + 1, 1, 1, 0), (n + 1, 1, 0, 1),
                      (n, 1, 1, 1), (n + 1, 1, 1, 1))
                  for n in folds}
        return self._sums("0b+-", counts, self.body.tilt)

    def Z(self, *folds, start=None):
        """The n-fold integrals of e^(i r0 t) Gamma, for the n in folds; start: another tilt in place of
        Gamma0."""
        counts = {n: ((n + 1, 0, 0, 0), (n + 1, 0, 1, 0), (n + 1, 0, 0, 1), (n + 1, 1, 1, 0),
                      (n + 1, 1, 0, 1), (n + 1, 0, 1, 1),
                      (n + 1, 1, 1, 1)) for n in folds}
        return self._sums("0fhl", counts, self.body.tilt if start is None else start)

    def angles(self):
        """psi, phi, theta."""
        Gamma = self.J(0)[0]
        return self.vector(Gamma.real, Gamma.imag, self.body.attitude[2] + self.body.spin * self.t)

    def momentum(self):
        """From the balance (e^(i theta) (L - i Gamma X))' = e^(i theta) M, in which the charge is the -k of X
        = H3 - k:

        G = e^(i theta0) [L0 - i Gamma0 H3 + M D[0,ir0] - i k (Z_0 - Gamma0)],   L = D1 p + i D2 q,   H3 = D3
        r0 + lambda3.
        """
        body, wheel = self.body, self._tables("0f", [(1, 1)])[1, 1]
        away = self.Z(0, start=0.0)[0]  # what the tilt adds to Gamma0 in inertial axes
        still = body.across - 1j * body.tilt * body.along  # G at the start, in axes turned by theta0
        G = body.turn * (still + body.pull * wheel - 1j * body.charge_moment * away)
        return self.vector(G.real, G.imag, body.along)

    def translation(self):
        """Velocity and position from m v' = R f, R the rotation to first order in the tilt."""
        body, t = self.body, self.t
        f, f3 = complex(*body.force[:2]), body.force[2]
        wheel, J, Z = self._tables("0f", [(1, 1), (2, 1)]), self.J(1, 2), self.Z(1, 2)
        moved = []
        for n in (1, 2):
            across = body.turn * (f * wheel[n, 1] - 1j * f3 * Z[n])
            along = f3 * t**n / n - (f.conjugate() * J[n]).imag
            moved.append(self.vector(across.real, across.imag, along) / body.mass)
        return body.velocity + moved[0], body.position + body.velocity * t[..., None] + moved[1]


def _nodes(m, spin):
    """Nodes by letter and what rounding took from them: 0, + and - for +-iw, f and b for +-ir0, h and l for i
    nu+-."""
    r0, (w, s) = Fraction(spin), (0, m.root) if m.unstable else (m.root, 0)
    both = {"0": (0, 0), "+": (-s, w), "-": (s, -w), "f": (0, r0), "b": (0, -r0), "h": (-s, r0 + w),
            "l": (s, r0 - w)}
    rest = lambda v: float(v - Fraction(float(v)))
    return ({name: complex(float(re), float(im)) for name, (re, im) in both.items()},
            {name: complex(rest(re), rest(im)) for name, (re, im) in both.items()})


WITHIN, BEYOND = "small angles", "beyond small angles"


@dataclass(frozen=True, eq=False)
class AxisymmetricMotion:
    """The motion by one of the models at the asked-for times; arrays (..., 3) over t, None
    where not asked for.

    omega: p, q, r, rad/s, body axes. angles: psi, phi, theta of the 3-1-2 sequence, rad, theta unwrapped.
    momentum: angular momentum (body and rotor, without the charge), kg m^2/s, inertial, first order in the
    tilt. velocity, position: inertial, m/s and m, None without a mass. status: "small angles" or "beyond
    small angles", of the model's own tilt; reason says from when on and why.
    """

    t: np.ndarray
    omega: np.ndarray
    angles: np.ndarray | None
    momentum: np.ndarray | None
    velocity: np.ndarray | None
    position: np.ndarray | None
    status: str
    reason: str

    @property
    def tilt(self) -> np.ndarray:
        """|Gamma|, rad, (...)."""
        return tilt_of(self.angles)


def solution(body: ChargedBody, t) -> AxisymmetricMotion:
    """The motion at times t (s, any shape).

    Raises InputError where the unstable motion exceeds the largest double.
    """
    t = times(t)
    terms = Terms(body, t, modes(body))
    return _motion(terms, terms.momentum())


def corrected(body: ChargedBody, t) -> AxisymmetricMotion:
    """The motion with the paper's one frequency, its integrals corrected: momentum by (33), velocity and
    position by the integrals that the paper means. Evaluated without loss at its own resonances too.

    Raises InputError where D3 lies between D1 and D2 or equals one of them: the paper divides by zeta1 and
    zeta2 and takes the root of their product.
    """
    terms = Terms(body, times(t), one_frequency(body))
    return _motion(terms, momentum(body, terms.angular_velocity(), terms.angles()))


def _motion(terms, momentum) -> AxisymmetricMotion:
    body, angles = terms.body, terms.angles()
    places = terms.translation() if body.mass is not None else (None, None)
    status, reason = verdict(tilt_of(angles), terms.t, horizon(body))
    return AxisymmetricMotion(terms.t, terms.angular_velocity(), angles, momentum, *places, status, reason)


def one_frequency(body: ChargedBody) -> Modes:
    """The modes with the paper's b: a zeta2/zeta1."""
    m, (D1, D2, D3) = modes(body), map(Fraction, body.inertia)
    zeta1, zeta2 = (D3 - D2) / D1, (D3 - D1) / D2
    if zeta1 * zeta2 <= 0:
        raise InputError(
            f"the paper's formulas need D3 above both D1 and D2, or below both; got {body.inertia}")
    return replace(m, b=m.a * zeta2 / zeta1)


def momentum(body, omega, angles):
    """(33): G = e^(i theta) [D1 p + i D2 q - i Gamma (D3 r0 + lambda3)]."""
    D1, D2, D3 = body.inertia
    H3 = D3 * body.spin + body.gyrostat
    G = np.exp(1j * angles[..., 2]) * (D1 * omega[..., 0] + 1j * D2 * omega[..., 1]
                                       - 1j * (angles[..., 0] + 1j * angles[..., 1]) * H3)
    return np.stack(np.broadcast_arrays(G.real, G.imag, H3), axis=-1)


def tilt_of(angles):
    """|Gamma| = |psi + i phi|."""
    return np.hypot(angles[..., 0], angles[..., 1])


def times(t):
    """t as an array of finite numbers (s); InputError otherwise."""
    t = np.asarray(t, float)
    if not np.all(np.isfinite(t)):
        raise InputError(f"times: expected finite numbers, got {t}")
    return t


def verdict(tilt, t, until):
    """Status and reason of a motion with this tilt at the times t."""
    promise = (f"a tilt of {SMALL_ANGLE:g} rad is not reached before t = {until:.6g} s (estimate "
               "from the torque and the start)")
    if until == np.inf:
        promise = f"the tilt stays below {SMALL_ANGLE:g} rad for all time"
    if np.all(tilt <= SMALL_ANGLE):
        return WITHIN, promise
    first = np.min(np.abs(t[tilt > SMALL_ANGLE]))
    return BEYOND, (f"the model's tilt reaches {np.max(tilt):.4g} rad and exceeds {SMALL_ANGLE:g} rad at t = "
                    f"{first:.6g} s or before: the small-angle equations no longer describe the body; "
                    f"{promise}")
