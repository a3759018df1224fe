"""The averaged models of a body with a liquid as models of a case, and the Taylor polynomials as printed.

Galal, Amer, Elneklawy, El-Kafly, "Studying the influence of a gyrostatic moment on the motion of a charged
rigid body containing a viscous incompressible liquid", eqs (13), (14), (24)-(29). The formulas are
those of the audit's file on the paper (`theories/printed/papers/liquid-cavity.toml`), which holds each
against the equations of motion. What is wrong in print, and how it is read here:
- (20), (24), (27): the term of (D1' - D2')/4 lacks the factor a^2/2 that averaging (18) gives: kept as
printed (its dimension is wrong).
- (20)-(22), (24)-(28): the liquid torque is that of a body without rotor and charge, the average of a
frequency that
  contains both; terms of the same order are missing: kept as printed.
- (24): "- eps lambda a" for "- eps zeta a" of (20), (27); lambda is nowhere defined: read as zeta.
- (25): B' for D2'; (19): A' for D1'; (7): D3' for D1': read so.
- (24)-(26): braces that do not close: closed so that (24)-(26) are the Taylor polynomials of (20)-(22), which
they are otherwise.
- after (13): sin phi0 lacks the sign of (13): the phase is taken from (13), so the motion starts at the given
state.
- (13), (14): the amplitude is that of p alone, with a square root of (D1' r - g)/(D2' r - g): no real motion
where
  that is negative, and none at D2' r = g, though the true motion is regular there.
The polynomials are of second degree in t and turn back, the phase among them: they hold for short times only.
"""
from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...answers.simulate import Simulation
from ...errors import InputError
from ...physics.states import numbers_in_a_row
from ..printed.evaluate import printed_formulas
from .averaged import AveragedMotion, averaged, omega_of
from .normal_form import check, constants


@dataclass(frozen=True)
class PrintedMotion:
    """The printed solution at the asked-for times.

    t: (n,) s, up to where it exists; amplitude a of p, rad/s, spin r, rad/s, phase phi, rad: (n,); omega: (n,
    3) rad/s, body frame, by (14). status: "reached" or "stopped"; reason: why.
    """

    t: np.ndarray
    amplitude: np.ndarray
    spin: np.ndarray
    phase: np.ndarray
    omega: np.ndarray
    status: str = "reached"
    reason: str = "all times reached"


@dataclass(frozen=True)
class Polynomials:
    """(24)-(26) of one scene and start: Taylor coefficients of a, r, phi in t, in s (tau = eps t, so eps
    drops out)."""

    a: tuple
    r: tuple
    phi: tuple
    d: tuple
    gamma: float
    J0: float

    @classmethod
    def of(cls, scene, omega) -> Polynomials:
        check(scene)
        n = {k: float(v) for k, v in constants(scene).items()}
        exact, (p, q, r) = scene.body.exact, omega
        d1, d2 = float(exact[0] - exact[2]), float(exact[1] - exact[2])
        x1, x2 = d1 * r - n["Gamma"], d2 * r - n["Gamma"]
        if not x1 * x2 > 0:
            raise InputError("the printed solution does not exist here: it needs (D1'r - g)(D2'r - g) > 0 at "
                             f"the start, got {x1 * x2:.3g}")
        formula, om = formulas(), math.sqrt(x1 * x2) / n["J0"]
        # eps = 1, so that d1, d2 are the differences themselves; lambda of (24) and B' of (25) read as zeta
        # and D2'
        values = {"ep": 1.0, "J0": n["J0"], "g": n["Gamma"], "zt": n["zeta"], "lam": n["zeta"], "M3": n["M3"],
                  "d1": d1, "d2": d2, "d3": d2, "r": r,
                  "Lam": n["kappa"] / n["J0"] ** 3}  # (23)
        # (13)
        a, phi = formula("a_13", values, p0=p, q0=x2 / n["J0"] * q,
                         om=om), math.atan2(-q * math.copysign(math.sqrt(x2 / x1), x2), p)
        f1, f2 = formula("f1_27", values, a=a), formula("f2_28", values, a=a)
        second = [formula(name, values, a=a, f1=f1, f2=f2) for name in ("a2_24", "r2_26", "phi2_25")]
        return cls((a, formula("a1_24", values, a=a), second[0] / 2), (r, f2, second[1] / 2),
                   (phi, formula("f3_29", values), second[2] / 2), (d1, d2),
                   n["Gamma"], n["J0"])

    def at(self, t):
        """(a, r, phi, omega) at the times t (n,); rows of omega are NaN where (14) has no real value."""
        a, r, phi = (np.polyval(c[::-1], t) for c in (self.a, self.r, self.phi))
        x1, x2 = (d * r - self.gamma for d in self.d)
        with np.errstate(all="ignore"):
            om = np.sqrt(np.where(x1 * x2 > 0, x1 * x2, np.nan)) / self.J0
            # (14)
            q = formulas()("q_13", {"J0": self.J0, "a": a, "om": om, "ph": phi, "d2": self.d[1], "r0": r,
                                    "g": self.gamma})
        return a, r, phi, np.stack([a * np.cos(phi), q, r], axis=-1)


def formulas():
    """The paper's formulas; SymPy is imported with the first of them."""
    return printed_formulas("liquid-cavity")


def printed(scene, state, times) -> PrintedMotion:
    """The paper's solution from `state` (three numbers, rad/s, or {"omega": ...}) at times (n,) >= 0,
    increasing, s.

    Raises InputError where the scene is not the paper's (as `averaged`) and where the printed formulas have
    no real value at the start.
    """
    omega, times = omega_of(state), numbers_in_a_row(times, "times")
    if (times < 0).any() or (np.diff(times) <= 0).any():
        raise InputError("times: expected increasing times, 0 or later")
    poly = Polynomials.of(scene, omega)
    a, r, phi, w = poly.at(times)
    good = np.isfinite(w).all(axis=1)
    count = len(times) if good.all() else int(np.argmin(good))
    reason = ("all times reached" if count == len(times) else
              f"the printed q has no real value at t = {times[count]:.6g}: (D1'r - g)(D2'r - g) is not "
              f"positive there")
    return PrintedMotion(times[:count], a[:count], r[:count], phi[:count], w[:count],
                         "reached" if count == len(times) else "stopped", reason)


# --- The averaged models of a body with a liquid or a resistance, as models of a case
MODELS = ("averaged1", "averaged2", "printed")


def applies(scene) -> bool:
    """Whether averaging covers the scene."""
    if not {e.name for e in scene.effects} & {"liquid_cavity", "resistance"}:
        return False
    try:
        check(scene)
    except InputError:
        return False
    return True


def follow(model, case, times, order=None) -> Simulation:
    """The case's motion by an averaged model, or by the paper's polynomials."""
    run: PrintedMotion | AveragedMotion
    error = {}
    if model == "printed":
        run = printed(case.scene, case.state, times)
        how, reason = "Galal et al. (24)-(26)", run.reason
    else:
        found = run = averaged(case.scene, case.state, times, order=int(model[-1]))
        error = {"omega": np.array(found.floor), "amplitude": np.array(found.floor[0]),
                 "spin": np.array(found.floor[2])}
        how, reason = (f"averaged equations of order {found.order}, eps = {found.eps:.6g}",
                       f"{found.reason}; {found.horizon}")
    state = {"omega": run.omega, "amplitude": run.amplitude, "spin": run.spin, "phase": run.phase}
    return Simulation(np.asarray(run.t), state, model, how, None, status=run.status, reason=reason,
                      error=error)
