"""The expansion of a fast top as a model of a case, and its first approximation as Amer et al. 2023 (fast
top) print it: eqs. (4), (10), (41), (42), (43), for comparison only.

The formulas are those of the audit's file on the paper
(`theories/printed/papers/newtonian-field-top.toml`), which holds each against the equations of motion. What
is wrong in it:

- (18), (22), (23): the generating solution has the permanent tilt P0 = y1 C/(C* - A) in p1; (22), (23) and
(41) drop it, so
  for l_x != 0 p is wrong at its leading order, gamma1, gamma1', gamma1'' at their first;
- (41): cos tau with tau = r0 t; the frequency nu = 1 + O(eps^2) is missing, so the phase is lost after
1/eps^2 revolutions;
- (41): gamma1' has second-order terms X(y0'/a + lambda2 M3 sin tau) that no equation gives: gamma1'(0) != 0
and |gamma| != 1;
- (41): gamma1'' has y1 where P0 belongs, and a term y1 y3; with (10) it is right to second order for l_x =
l_z = 0 only;
- (10): X and Omega^2 are cut off after the first power of l_z/r0 (C* = C + l_z/r0 in place of C makes them
exact);
- (42) is read as meant, 1 - gamma''^2 under psi'; (43): csc(eps theta0) stands for csc theta0, kept as
printed;
- (43): wrong signs of the y0' terms, sin r0 t in theta2 and cos r0 t in psi2 (and so in phi2); theta1 carries
y1 where P0
  belongs; psi1 is not 0 (it integrates P0 cos tau); psi3 lacks factors 1/r0;
- the text's "no singular points for any frequency": Omega = 0, Omega = 1 and C = B are poles of (41) itself.
"""
from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..answers.simulate import Simulation
from ..errors import InputError, Refused
from ..physics.states import numbers_in_a_row
from ..reasons import Quantity, Reasoned, Sentence
from .printed.evaluate import printed_formulas
from .top_expansion import fast_top
from .top_lindstedt import LindstedtMotion, lindstedt

if TYPE_CHECKING:
    from ..case.read import Case
    from ..numbers.vectors import Float3
    from ..physics.scene import AnyScene, Scene


NEEDS_GRAVITY = Sentence(
    "printed-top-needs-gravity", "the printed solution divides by √(M g L γ0''): it needs gravity and a "
    "third component of γ above 0, got M g L/(C r0²) = {weight} and γ0'' = {third}")
AS_PRINTED = Sentence(
    "top-as-printed", "eqs. (10), (41) and (43) as they stand in print, misprints and all")()
DIVIDES_BY_ZERO = Sentence(
    "top-divides-by-zero", "C = B, Ω = 0 or Ω = 1: the printed solution divides by 0")()
OF_EXPANSION = Sentence("expansion-status", "{status}: {why}")


@dataclass(frozen=True)
class PrintedMotion(Reasoned):
    """The printed solution at t (n,), s: omega (n, 3) rad/s, gamma (n, 3) (not of length 1), psi, theta, phi
    (n,) rad of (43) with psi0 = 0. status: "as printed" or "pole" (a divisor is 0: no numbers, empty arrays);
    reason in words."""

    t: np.ndarray
    omega: np.ndarray
    gamma: np.ndarray
    psi: np.ndarray
    theta: np.ndarray
    phi: np.ndarray
    epsilon: float
    status: str


def paper_numbers(scene: AnyScene, state: Mapping[str, Float3]) -> dict[str, float]:
    """The dimensionless numbers of eqs. (4) and (10) as printed, under the names that the formulas have for
    them, for a scene with gravity, gamma0'' > 0 and l_y = 0; t0: the start's place in the paper's time, s
    (its tau = 0 has gamma' = 0); g0: gamma0''. Raises InputError elsewhere, and ZeroDivisionError at the
    poles C = B, Omega^2 = 0 and Omega^2 = 1."""
    top = fast_top(scene, state)
    gamma0 = float(top.gamma[2])
    if not any(top.force) or gamma0 <= 0:
        raise Refused(NEEDS_GRAVITY(weight=Quantity(math.hypot(*map(float, top.force))),
                                    third=Quantity(gamma0)))
    if top.tilt[1]:
        raise InputError("the printed solution has the gyrostatic moment (l_x, 0, l_z); the scene's has a "
                         "second component")
    r0, a, b, lz = float(top.r0), float(top.a), float(top.b), float(top.wheel)
    length = math.hypot(*map(float, top.force))
    x, y, z = (float(f) / length for f in top.force)
    c = math.sqrt(length) * abs(r0)
    A1, B1, C1 = float((1 - top.b) / top.a), float((top.a - 1) / top.b), float(top.b - top.a)
    part, M3 = c * math.sqrt(gamma0) / r0, math.sqrt(max(0.0, 1 - gamma0**2)) / gamma0
    # in units of C and 1/r0: C = 1, s/r0 = eps, and l_z/r0 = lz
    formula = formulas()
    values = {"A": a, "B": b, "a": a, "b": b, "A1": A1, "B1": B1, "om": -A1 * B1, "xs": x, "zs": z,
              "k": float(top.field) * r0**2 * gamma0 / c**2, "ep": part, "s": part, "lz": lz}
    X, Omega2 = formula("X_10", values), formula("Om_10", values)
    lambda_, lambda1 = formula("lam_10", values, Om=Omega2), formula("lam1_10", values, Om=Omega2)
    return {"ep": part, "r0": r0, "c": c, "g0": gamma0, "xs": x, "ys": y, "k": values["k"], "a": a, "b": b,
            "A1": A1, "C1": C1, "Xs": X, "Om": Omega2, "lam": lambda_, "lam1": lambda1,
            "lam2": formula("lam2_10", values, lam1=lambda1), "y1": float(top.tilt[0]) / part,
            "y3": lz / part, "M3": M3, "th": math.atan(M3),
            "t0": (math.atan2(float(top.gamma[0]), float(top.gamma[1])) - math.pi / 2) / r0}


def formulas():
    """The paper's formulas; SymPy is imported with the first of them."""
    return printed_formulas("newtonian-field-top")


def printed(scene: AnyScene, state: Mapping[str, Float3], times: np.ndarray) -> PrintedMotion:
    """The paper's (41) and (43) at the times, s, through r and gamma of the state at t = 0 (arguments as of
    `top_lindstedt`; its p, q are not free). Raises InputError without gravity, for gamma0'' not between 0 and
    1, and for l_y."""
    times, top = numbers_in_a_row(times, "times"), fast_top(scene, state)
    try:
        values = paper_numbers(scene, state)
    except ZeroDivisionError:
        empty = np.empty(0)
        return PrintedMotion(empty, np.empty((0, 3)), np.empty((0, 3)), empty, empty, empty, top.epsilon,
                             "pole", reason=DIVIDES_BY_ZERO)
    formula, r0 = formulas(), values["r0"]
    tau = r0 * (times + values["t0"])
    omega, gamma = ([np.broadcast_to(formula(f"{name}_41", values, tau=tau), times.shape) for name in names]
                    for names in (("p1", "q1", "r1"), ("g1", "g2", "g3")))
    psi, theta, phi = _angles(values, times)
    scale = values["c"] * math.sqrt(values["g0"])
    return PrintedMotion(times, np.stack([scale * omega[0], scale * omega[1], r0 * omega[2]], -1),
                         values["g0"] * np.stack(gamma, -1), psi, theta, phi, values["ep"], "as printed",
                         reason=AS_PRINTED)


def _angles(values: Mapping[str, float], t: np.ndarray):
    """Eq. (43), csc(eps theta0) and all: psi (0 at t = 0), theta, phi. psi1 = phi1 = 0, phi2 = psi2, phi4 =
    psi3 as printed."""
    if values["th"] == 0:
        raise InputError("the printed angles divide by sin(theta0), which is 0 for this start")
    formula, start = formulas(), values["t0"]

    def gained(name: str):
        """What a term has more than at the start."""
        at = lambda t: formula(f"{name}_43", values, t=t + start, tau=values["r0"] * (t + start))
        return at(t) - at(0.0)

    terms = {"dth1": gained("theta1"), "dth2": gained("theta2"), "dps2": gained("psi2"),
             "dps3": gained("psi3"), "dph3": gained("phi3")}
    return tuple(formula(f"{angle}_43", values, t=t, **terms) for angle in ("psi", "theta", "phi"))


# --- The periodic motion of a fast top as a model of a case: expanded to any order, and the printed first
# order
MODELS = ("lindstedt", "printed")
ORDER = 4
COVERED = {"gravity", "newtonian_field", "gyrostat"}


def applies(scene: Scene) -> bool:
    """Whether the expansion covers the scene: gravity or a Newtonian field, a gyrostat perhaps, nothing else.
    """
    names = {e.name for e in scene.effects}
    return (names <= COVERED and bool(names & {"gravity", "newtonian_field"})
            and "attitude" not in scene.blocks)


def state_of(case: Case) -> dict:
    """The start as the expansion takes it."""
    return {"omega": case.state, "gamma": case.blocks.get("gamma", (0.0, 0.0, 1.0))}


def follow(model: str, case: Case, times: np.ndarray, order: int | None = None) -> Simulation:
    """The case's motion by the expansion (order 4 unless asked for otherwise), or as printed."""
    state = state_of(case)
    run: PrintedMotion | LindstedtMotion
    if model == "printed":
        run = printed(case.scene, state, times)
        how, reason = "Amer et al. 2023, first order", run.reason
    else:
        result = run = lindstedt(case.scene, state, times, ORDER if order is None else order)
        how, reason = (f"expansion of order {result.order}",
                       OF_EXPANSION(status=result.status, why=result.reason))
    reached = "reached" if len(run.t) == len(times) else "stopped"
    return Simulation(run.t, {"omega": run.omega, "gamma": run.gamma}, model, how, None, status=reached,
                      reason=reason)
