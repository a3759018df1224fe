"""Models of the charged, nearly axisymmetric body under constant body-fixed torque and force.

They are closed forms, and the paper's formulas as they stand in print, misprints and all.

The linear model of `charged_modes`, solved with both of its rates a and b; how far to believe it:
`charged_modes.horizon`. Every quantity is a sum of divided differences D of the exponential, regular at every
resonance. With w^2 = ab, nu+- = r0 +- w, mu = M1/D1 + i M2/D2, Pi = p + iq, k0 = (w - a) q0 + i (b - w) p0
and k1 the same of mu (proof: Laplace transform of the linear equations, s/(s^2 + w^2) = 1/(s - iw) - iw/(s^2
+ w^2)):

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
its integrals for velocity and displacement are misprinted. `printed` follows the print itself.

The formulas as printed (`printed`):

Galal et al., charged body, (11)-(13), (20)-(26), (33), (35), (43)-(51), (58)-(66). The formulas are those of
the audit's file on the paper (`theories/printed/papers/charged-axisymmetric.toml`), which holds each against
the equations of motion; here they are put together. Supplied is only what print leaves open: zeta3 and zeta4
of (64), not defined: (sqrt(zeta1) +- sqrt(zeta2))/(2 zeta) as in (49); the bracket of (45) and (60) that does
not close, closed as in (46). The short form (Elneklawy) prints the same, but for the second zeta of (46).
`corrected` has the integrals that the paper means."""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np

from ..answers.simulate import Simulation
from ..errors import InputError, Refused
from ..numbers.double_double import divided_differences
from ..reasons import Angle, Inertia, Reason, Reasoned, Sentence, Time
from .charged_modes import SMALL_ANGLE, ChargedBody, Modes, horizon, modes, spin_reason
from .printed.evaluate import printed_formulas

if TYPE_CHECKING:
    from ..physics.scene import Scene

NEED_AN_EXTREME = Sentence(
    "charged-needs-extreme",
    "the paper's formulas need D3 above both D1 and D2, or below both; got {moments}")
TAKE_ROOTS = Sentence(
    "charged-takes-roots",
    "the printed formulas take roots of ζ1 and ζ2: D3 must exceed D1 and D2; got {moments}")

# --- Closed forms
LOPSIDED = 4.0  # a/b beyond which the even split loses less: w - a cancels against 1 by sqrt(a/b)


class Terms:
    """The divided differences at the times t and the coefficients in front of them."""

    def __init__(self, body: ChargedBody, t: np.ndarray | float, m: Modes):
        self.body, self.t = body, t
        self.p0, self.q0 = body.rates.tolist()
        self.m1, self.m2 = (body.torque / body.inertia[:2]).tolist()
        self.a, self.b = float(m.a), float(m.b)
        self.nodes, self.low = _nodes(m, body.spin)
        a, b = abs(m.a), abs(m.b)
        even = m.unstable or a > LOPSIDED * b or b > LOPSIDED * a
        self.share = 0.5 if even else 1.0
        self.above, self.below = map(float, (-m.a, m.b) if even else (m.root - m.a, m.b - m.root))

    def _tables(self, names: str, counts: Sequence[tuple[int, int]] | set[tuple[int, ...]]):
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

    def _sums(self, names: str, folds: Mapping[int, Any], Gamma0: complex):
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

    def Z(self, *folds, start: float | None = None):
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


def _nodes(m: Modes, spin: float):
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
class AxisymmetricMotion(Reasoned):
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

    @property
    def tilt(self) -> np.ndarray:
        """|Gamma|, rad, (...)."""
        return tilt_of(self.angles)


def solution(body: ChargedBody, t: float | np.ndarray) -> AxisymmetricMotion:
    """The motion at times t (s, any shape).

    Raises InputError where the unstable motion exceeds the largest double.
    """
    t = times(t)
    terms = Terms(body, t, modes(body))
    return _motion_of(terms, terms.momentum())


def corrected(body: ChargedBody, t: np.ndarray) -> AxisymmetricMotion:
    """The motion with the paper's one frequency, its integrals corrected: momentum by (33), velocity and
    position by the integrals that the paper means. Evaluated without loss at its own resonances too.

    Raises InputError where D3 lies between D1 and D2 or equals one of them: the paper divides by zeta1 and
    zeta2 and takes the root of their product.
    """
    terms = Terms(body, times(t), one_frequency(body))
    return _motion_of(terms, momentum(body, terms.angular_velocity(), terms.angles()))


def _motion_of(terms, momentum) -> AxisymmetricMotion:
    body, angles = terms.body, terms.angles()
    velocity, position = terms.translation() if body.mass is not None else (None, None)
    status, reason = verdict(tilt_of(angles), terms.t, horizon(body))
    return AxisymmetricMotion(terms.t, terms.angular_velocity(), angles, momentum, velocity, position, status,
                              reason=reason)


def one_frequency(body: ChargedBody) -> Modes:
    """The modes with the paper's b: a zeta2/zeta1."""
    m, (D1, D2, D3) = modes(body), map(Fraction, body.inertia)
    zeta1, zeta2 = (D3 - D2) / D1, (D3 - D1) / D2
    if zeta1 * zeta2 <= 0:
        raise Refused(NEED_AN_EXTREME(moments=Inertia(tuple(map(float, body.inertia)))))
    return replace(m, b=m.a * zeta2 / zeta1)


def momentum(body: ChargedBody, omega: np.ndarray, angles: np.ndarray):
    """(33): G = e^(i theta) [D1 p + i D2 q - i Gamma (D3 r0 + lambda3)]."""
    D1, D2, D3 = body.inertia
    H3 = D3 * body.spin + body.gyrostat
    G = np.exp(1j * angles[..., 2]) * (D1 * omega[..., 0] + 1j * D2 * omega[..., 1]
                                       - 1j * (angles[..., 0] + 1j * angles[..., 1]) * H3)
    return np.stack(np.broadcast_arrays(G.real, G.imag, H3), axis=-1)


def tilt_of(angles: np.ndarray):
    """|Gamma| = |psi + i phi|."""
    return np.hypot(angles[..., 0], angles[..., 1])


def times(t: float | np.ndarray):
    """t as an array of finite numbers (s); InputError otherwise."""
    t = np.asarray(t, float)
    if not np.all(np.isfinite(t)):
        raise InputError(f"times: expected finite numbers, got {t}")
    return t


NOT_REACHED_BEFORE = Sentence(
    "tilt-not-reached-before", "a tilt of {angle} is not reached before t = {time} (estimate from the torque "
    "and the start)")
STAYS_BELOW = Sentence("tilt-stays-below", "the tilt stays below {angle} for all time")
EXCEEDED = Sentence(
    "small-angles-exceeded", "the model's tilt reaches {largest} and exceeds {angle} at t = {time} or "
    "before: the small-angle equations no longer describe the body")
OF_MODEL = Sentence("linear-model-status", "{status}: {why}")
NO_ANGLES = Sentence("rates-without-angles", "the rates ask for no small angles")()
ANGLE_HELD = Sentence("charge-angle-held", "the charge's angle is held at its first value")()


def verdict(tilt, t, until) -> tuple[str, Reason]:
    """Status and reason of a motion with this tilt at the times t."""
    small = Angle(SMALL_ANGLE)
    promise = (STAYS_BELOW(angle=small) if until == np.inf
               else NOT_REACHED_BEFORE(angle=small, time=Time(float(until)).lower))
    if np.isnan(tilt).any():  # the case is asked for the number that is to blame
        raise OverflowError("the linear model leaves the range of doubles")
    if np.all(tilt <= SMALL_ANGLE):
        return WITHIN, promise
    first = float(np.min(np.abs(t[tilt > SMALL_ANGLE])))
    return BEYOND, EXCEEDED(largest=Angle(float(np.max(tilt)), digits=4), angle=small,
                            time=Time(first).upper).then(promise)


# --- The formulas as printed
PARTS = ("omega", "angles", "momentum", "velocity", "position")
# equation of the paper: (what it gives, what is wrong in print, what `corrected` takes instead)
MISPRINTS = {
    "(8)": ("frequency W",
            "zeta1 D1 stands in both lines of (7): not an approximation for D1 near D2, the phase is off",
            "it as it stands"),
    "(11)": ("p1 + i q1", "", "as printed"),
    "(13)": ("p, q", "the second form of q lacks 1/i", "q = Im Pi1 / sqrt(zeta1), its first form"),
    "(20)-(26)": ("psi, phi, theta", "", "as printed"),
    "(30), (38)": ("rotation",
                   "R23 = sin(theta) sin(phi) - cos(theta) sin(psi) cos(phi); printed with cos(theta) "
                   "sin(phi)",
                   "the true R23, which (31), (33) and (40) use"),
    "(33)": ("G1 + i G2", "", "as printed"),
    "(35)": ("G1 + i G2",
             "leaves out the charge, G0 and theta0: it holds for k = 0, a start from rest and theta0 = "
             "0 only",
             "(33), which has them"),
    "(37)": ("acceleration", "lacks 1/m", "(40), which has it"),
    "(42)": ("velocity", "lacks its value at t = 0", "(43), which has it"),
    "(46)": ("I2 omega", "sign of both exponential terms; a second zeta before Lambda in the exponent",
             "the integral of (25)"),
    "(50), (51)": ("I4, I5 omega",
                   "e^(-i r0 t) under the integral is left out; sign of the exponential terms in (50)",
                   "the integral of e^(-i r0 t) times (24), (25)"),
    "(53), (54)": ("velocity ratio", "hold for Lambda = 0 only: D3 r0 stands for D3 r0 + Lambda",
                   "D3 r0 + Lambda in its place"),
    "(58)": ("transverse displacement",
             "sign of f (e^(i r0 t) - 1)/r0^2; Gamma0 t for Gamma0 tau under the integral",
             "the integral of (43)"),
    "(61)": ("I2 eta", "1 - e^(...) - 1 for e^(...) - 1", "the integral of the true (46)"),
    "(64)": ("I3 eta", "zeta3 and zeta4 are not defined: (sqrt(zeta1) +- sqrt(zeta2))/(2 zeta)",
             "the integral of (48)"),
    "(65), (66)": ("I4, I5 eta",
                   "e^(-i r0 t) left out: (65) repeats (60); Pi10 for its conjugate and wrong signs in (66)",
                   "the integrals of the true (50), (51)"),
}


def printed(body: ChargedBody, t: np.ndarray, parts: Sequence[str] = PARTS) -> AxisymmetricMotion:
    """The paper's formulas for the asked-for parts of the state at times t (s, any shape): omega by (13), q
    by its first form; angles (26); momentum (33); velocity (43), (47); position (58), (63).

    Raises InputError for D3 not above D1 and D2 (the paper takes roots of zeta1 and zeta2), for velocity or
    position without a mass, and where the formulas of a part divide by zero (near that they lose digits: they
    are partial fractions).
    """
    t = times(t)
    values = numbers(body, t)
    omega, result = _rates(values), dict.fromkeys(PARTS[1:])
    if set(parts) & set(PARTS[1:]):
        result["angles"] = _angles(body, values)
    if "momentum" in parts:
        result["momentum"] = momentum(body, omega, result["angles"])
    if set(parts) & {"velocity", "position"}:
        result |= _translation(body, values)
    tilt = np.zeros(omega.shape[:-1]) if result["angles"] is None else tilt_of(result["angles"])
    status, reason = verdict(tilt, t, horizon(body))
    return AxisymmetricMotion(t, omega, **result, status=status, reason=reason)


def circle(body: ChargedBody, t) -> np.ndarray:
    """G1, G2 of (35), (..., 2), kg m^2/s: i M (1 - e^(i r0 t))/r0. Raises InputError for r0 = 0, where (35)
    divides by it."""
    if body.spin == 0:
        raise InputError("r0 = 0: the printed (35) divides by it")
    M1, M2 = body.torque
    G = formulas()("G_35", {"M1": M1, "M2": M2, "r0": body.spin, "t": times(t)})
    return np.stack([G.real, G.imag], axis=-1)


def numbers(body: ChargedBody, t: np.ndarray) -> dict:
    """The paper's symbols at the times t, by name: (4), (6), (10) and what the start gives. Errors as of
    `printed`."""
    D1, D2, D3 = body.inertia
    zeta1, zeta2, r0 = (D3 - D2) / D1, (D3 - D1) / D2, body.spin
    if zeta1 <= 0 or zeta2 <= 0:
        raise Refused(TAKE_ROOTS(moments=Inertia(tuple(map(float, body.inertia)))))
    root1, root2, Lam = np.sqrt(zeta1), np.sqrt(zeta2), body.gyrostat - body.charge_moment
    if root1 * root2 * (r0 + Lam / (zeta1 * D1)) == 0:
        raise InputError("W = 0: the printed formulas divide by their frequency (8), which is zero here")
    roots = np.array([root2, root1])
    return {"t": t, "D1": D1, "zeta1": zeta1, "zeta2": zeta2, "r0": r0, "Lam": Lam,
            "th0": body.attitude[2], "f3": body.force[2],
            "m": body.mass, "P10": complex(*(body.rates * roots)),
            "A": complex(*(body.torque * roots / body.inertia[:2])), "G0": body.tilt,
            "f": complex(*body.force[:2]), "w0": complex(*body.velocity[:2])}


def formulas():
    """The paper's formulas; SymPy is imported with the first of them."""
    return printed_formulas("charged-axisymmetric")


def _rates(values: Mapping[str, float | np.ndarray]):
    """(11)-(13), q by its first form."""
    Pi1 = formulas()("Pi1_11", values)
    return _three(Pi1.real / np.sqrt(values["zeta2"]), Pi1.imag / np.sqrt(values["zeta1"]), values["r0"])


def _angles(body: ChargedBody, values: Mapping[str, float | np.ndarray]):
    """(20), (23), (26)."""
    r0, root = values["r0"], np.sqrt(values["zeta1"] * values["zeta2"])
    W = root * (r0 + values["Lam"] / (values["zeta1"] * values["D1"]))
    if r0 * (W + r0) * (r0 - W) == 0:
        raise InputError(
            "r0 = 0 or r0 = +-W: the printed formulas for angles, velocity and position divide by zero here")
    Gamma = formulas()("Gamma_20", values, IG=_both(values, "I1G_24", "I2G_25"))
    return _three(Gamma.real, Gamma.imag, body.attitude[2] + r0 * values["t"])


def _translation(body: ChargedBody, values: Mapping[str, float | np.ndarray]) -> dict:
    """(43), (47), (58) and (63), with the integrals of (44), (48), (49), (59) and (64)."""
    if body.mass is None:
        raise InputError("the printed translation formulas need a mass: give mass = ... in kg")
    formula, t = formulas(), values["t"]
    w = formula("w_43", values, Iw=_both(values, "I1w_45", "I2w_46"))
    along = formula("w3_47", values, IGam=formula("IG0_48", values) + _both(values, "I4w_50", "I5w_51"))
    eta = formula("eta_58", values, Ieta=_both(values, "I1e_60", "I2e_61"))
    eta3 = formula("eta3_63", values, IIGam=formula("IIG0_64", values) + _both(values, "I4e_65", "I5e_66"))
    v3 = body.velocity[2]
    return {"velocity": _three(w.real, w.imag, v3 + along.real),
            "position": body.position + _three(eta.real, eta.imag, v3 * t + eta3.real)}


def _both(values: Mapping[str, float | np.ndarray], first: str, second: str):
    """(23), (44), (49), (59), (64)."""
    formula = formulas()
    return formula("both_23", values, X1=formula(first, values), X2=formula(second, values))


def _three(x: np.ndarray, y: np.ndarray, z: float | np.ndarray):
    return np.stack(np.broadcast_arrays(x, y, z), axis=-1)


# --- The closed forms of the charged, nearly axisymmetric body as models of a case
MODELS = ("linear", "corrected", "printed")
NEARLY = Fraction(1, 10)  # D1 - D2 over D1 up to which a body counts as nearly axisymmetric
COVERED = {"charge", "gyrostat", "constant_torque", "body_force"}


def applies(scene: Scene) -> bool:
    """Whether the linear model covers the scene: a gyrostatic moment along axis 3, a torque across it, D1
    near D2 (where a charge or a force asks for this theory it is followed beyond, and says how far r is from
    constant). Where the charge's angle follows the attitude the model holds it at its first value, as the
    paper does."""
    names = {e.name for e in scene.effects}
    if (scene.variables != "physical" or not names <= COVERED
            or any(scene.vector("gyrostat")[:2]) or scene.vector("constant_torque")[2]):
        return False
    D1, D2, _ = scene.body.exact
    return bool(names & {"charge", "body_force"}) or abs(D1 - D2) <= NEARLY * max(D1, D2)


def body_of(case):
    """The case as the closed forms take it."""
    scene, blocks = case.scene, case.blocks
    charge, force = scene.effect("charge"), scene.effect("body_force")
    p, q, r = case.state
    rest, k = (0.0, 0.0, 0.0), 0.0
    if charge is not None:
        k = charge.strength * (blocks["gamma"][2] if charge.follows_attitude else 1.0)
    return ChargedBody(scene.body.inertia, r, float(scene.vector("gyrostat")[2]), k,
                       tuple(float(v) for v in scene.vector("constant_torque")[:2]), (p, q),
                       blocks.get("attitude", rest),
                       force.vector if force else rest, scene.body.mass, blocks.get("velocity", rest),
                       blocks.get("position", rest))


def follow(model, case, times, order=None) -> Simulation:
    """The case's motion by the linear model, by the paper's single frequency with its integrals corrected, or
    as printed; the parts of the state that the exact motion has."""
    blocks, body = set(case.scene.blocks) | set(case.blocks), body_of(case)
    wanted = ["omega"] + ["angles", "momentum"] * bool(blocks & {"attitude", "velocity", "position"})
    wanted += ["velocity", "position"] * bool(blocks & {"velocity", "position"} and body.mass is not None)
    run, how = _motion(model, body, times, wanted)
    parts = {part: getattr(run, part) for part in wanted}
    held = case.scene.effect("charge") is not None and case.scene.effect("charge").follows_attitude
    angles = OF_MODEL(status=run.status, why=run.reason) if "angles" in parts else NO_ANGLES
    reason = angles.then(spin_reason(body, run.omega, run.t)).then(ANGLE_HELD if held else None)
    return Simulation(run.t, parts, model, how, None, status="reached", reason=reason)


def _motion(model: str, body: ChargedBody, times: np.ndarray, wanted: Sequence[str]):
    """The motion by the model, and how it was found."""
    if model == "printed":
        return printed(body, times,
                       wanted), "Galal et al., charged body: formulas as printed, misprints and all"
    if model == "corrected":
        return corrected(body,
                         times), "Galal et al., charged body: its single frequency (8), integrals corrected"
    return solution(body, times), "closed forms of the linear model, both rates"
