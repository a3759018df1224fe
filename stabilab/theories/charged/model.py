"""The closed forms of the charged axisymmetric body as models of a case, and the paper's formulas as they
stand in print, misprints and all.

Galal et al., charged body, (11)-(13), (20)-(26), (33), (35), (43)-(51), (58)-(66). The formulas are those of
the audit's file on the paper (`theories/printed/papers/charged-axisymmetric.toml`), which holds each against
the equations of motion; here they are put together. Supplied is only what print leaves open: zeta3 and zeta4
of (64), not defined: (sqrt(zeta1) +- sqrt(zeta2))/(2 zeta) as in (49); the bracket of (45) and (60) that does
not close, closed as in (46). The short form (Elneklawy) prints the same, but for the second zeta of (46).
`corrected` has the integrals that the paper means.
"""
from __future__ import annotations

from fractions import Fraction

import numpy as np

from ...answers.simulate import Simulation
from ...errors import InputError
from ..printed.evaluate import printed_formulas
from .closed_form import AxisymmetricMotion, corrected, momentum, solution, tilt_of, times, verdict
from .modes import ChargedBody, horizon, spin_words

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


def printed(body: ChargedBody, t, parts=PARTS) -> AxisymmetricMotion:
    """The paper's formulas for the asked-for parts of the state at times t (s, any shape): omega by (13), q
    by its first form; angles (26); momentum (33); velocity (43), (47); position (58), (63).

    Raises InputError for D3 not above D1 and D2 (the paper takes roots of zeta1 and zeta2), for velocity or
    position without a mass, and where the formulas of a part divide by zero (near that they lose digits: they
    are partial fractions).
    """
    t = times(t)
    values = numbers(body, t)
    omega, found = _rates(values), dict.fromkeys(PARTS[1:])
    if set(parts) & set(PARTS[1:]):
        found["angles"] = _angles(body, values)
    if "momentum" in parts:
        found["momentum"] = momentum(body, omega, found["angles"])
    if set(parts) & {"velocity", "position"}:
        found |= _translation(body, values)
    tilt = np.zeros(omega.shape[:-1]) if found["angles"] is None else tilt_of(found["angles"])
    status, reason = verdict(tilt, t, horizon(body))
    return AxisymmetricMotion(t, omega, **found, status=status, reason=reason)


def circle(body: ChargedBody, t) -> np.ndarray:
    """G1, G2 of (35), (..., 2), kg m^2/s: i M (1 - e^(i r0 t))/r0. Raises InputError for r0 = 0, where (35)
    divides by it."""
    if body.spin == 0:
        raise InputError("r0 = 0: the printed (35) divides by it")
    M1, M2 = body.torque
    G = formulas()("G_35", {"M1": M1, "M2": M2, "r0": body.spin, "t": times(t)})
    return np.stack([G.real, G.imag], axis=-1)


def numbers(body: ChargedBody, t) -> dict:
    """The paper's symbols at the times t, by name: (4), (6), (10) and what the start gives. Errors as of
    `printed`."""
    D1, D2, D3 = body.inertia
    zeta1, zeta2, r0 = (D3 - D2) / D1, (D3 - D1) / D2, body.spin
    if zeta1 <= 0 or zeta2 <= 0:
        raise InputError("the printed formulas take roots of zeta1 and zeta2: D3 must exceed D1 and D2; got "
                         f"{body.inertia.tolist()}")
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


def _rates(values):
    """(11)-(13), q by its first form."""
    Pi1 = formulas()("Pi1_11", values)
    return _three(Pi1.real / np.sqrt(values["zeta2"]), Pi1.imag / np.sqrt(values["zeta1"]), values["r0"])


def _angles(body, values):
    """(20), (23), (26)."""
    r0, root = values["r0"], np.sqrt(values["zeta1"] * values["zeta2"])
    W = root * (r0 + values["Lam"] / (values["zeta1"] * values["D1"]))
    if r0 * (W + r0) * (r0 - W) == 0:
        raise InputError(
            "r0 = 0 or r0 = +-W: the printed formulas for angles, velocity and position divide by zero here")
    Gamma = formulas()("Gamma_20", values, IG=_both(values, "I1G_24", "I2G_25"))
    return _three(Gamma.real, Gamma.imag, body.attitude[2] + r0 * values["t"])


def _translation(body, values) -> dict:
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


def _both(values, first, second):
    """(23), (44), (49), (59), (64)."""
    formula = formulas()
    return formula("both_23", values, X1=formula(first, values), X2=formula(second, values))


def _three(x, y, z):
    return np.stack(np.broadcast_arrays(x, y, z), axis=-1)


# --- The closed forms of the charged, nearly axisymmetric body as models of a case
MODELS = ("linear", "corrected", "printed")
NEARLY = Fraction(1, 10)  # D1 - D2 over D1 up to which a body counts as nearly axisymmetric
COVERED = {"charge", "gyrostat", "constant_torque", "body_force"}


def applies(scene) -> bool:
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
    held = "the charge's angle is held at its first value" if held else ""
    angles = f"{run.status}: {run.reason}" if "angles" in parts else "the rates ask for no small angles"
    told = angles, spin_words(body, run.omega, run.t)
    return Simulation(run.t, parts, model, how, None, status="reached",
                      reason="; ".join(filter(None, (*told, held))))


def _motion(model, body, times, wanted):
    """The motion by the model, and how it was found."""
    if model == "printed":
        return printed(body, times,
                       wanted), "Galal et al., charged body: formulas as printed, misprints and all"
    if model == "corrected":
        return corrected(body,
                         times), "Galal et al., charged body: its single frequency (8), integrals corrected"
    return solution(body, times), "closed forms of the linear model, both rates"
