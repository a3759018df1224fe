"""Equilibria of a body that eddy currents damp in a field at rest in space: rotations about the field.

T' = -k B^2 |omega across the field|^2, and p = H . gamma stays. Where T stays, omega = s gamma; then gamma' =
gamma x omega = 0, and D omega' = s^2 D gamma x gamma has the product s' gamma . D gamma = 0 with gamma: s
stays, and gamma is a principal axis or s = 0. So the equilibria are these alone, and every motion tends to
them (LaSalle). At one p the least T is p^2/(2 D1), of rotation about an axis of the largest moment D1, for
T >= |H|^2/(2 D1) >= p^2/(2 D1).
"""
from __future__ import annotations

from math import cos, inf, sin
from typing import Any

from ..numbers.vectors import cross_matrix
from ..physics.coefficients import Content
from .result import CurveSegment, Equilibria, EquilibriumCurve, EquilibriumPoint
from .stability import ordered

REASON = ("eddy currents take energy wherever omega is across the field: only rotations about a principal "
          "axis along the field, in either direction, and rest in every attitude are equilibria, and every "
          "motion tends to them (LaSalle)")
EQUAL = "; of two equal moments every axis in their plane is one"
LEAST = ("the kinetic energy is least here at its angular momentum along the field, which stays, and it only "
         "falls")
MORE = ("at its angular momentum along the field, which stays, rotation about the axis of the largest moment "
        "has less energy, and so have states next to this one: they leave, for energy only falls")
LOST = ("next to it are states with some angular momentum along the field: they end in rotation about a "
        "principal axis along it, however slow (open where the axis of the largest moment is along it)")
SPHERE = "all moments are equal: rotation across the field decays, and the attitude moves no further than it"


def eddy_equilibria(parts: Content) -> Equilibria:
    """Rotations about the field and rest, of the body alone; undecided beside anything else."""
    if (any(parts.M) or any(parts.Lambda) or parts.c or parts.damped or parts.inside or parts.kappa
            or any(parts.s) or parts.N or parts.E):
        return Equilibria("undecided", "undecided: of eddy currents beside wheels, a torque, a medium, a "
                                       "damper, a liquid or another field not all equilibria are known")
    curves = [_rotations(parts, i, sign) for i in range(3) for sign in (1, -1)]
    reason = REASON + EQUAL if len(set(parts.D)) < 3 else REASON
    return Equilibria("curves", reason, curves=(*curves, _rest(parts)))


def _rotations(parts: Content, i: int, sign: int) -> EquilibriumCurve:
    """About axis i, which points along the field or against it, over the rate."""
    def at(t: float) -> tuple[float, ...]:
        gamma = tuple(float(sign * (n == i)) for n in range(3))
        return (*(t * g for g in gamma), *gamma)
    verdict = ("stable", LEAST) if parts.D[i] == max(parts.D) else ("unstable", MORE)
    segment = CurveSegment((-inf, inf), verdict[0], *verdict)
    samples = tuple(EquilibriumPoint(at(t), _spectrum(parts, at(t)), verdict[0], *verdict)
                    for t in (-1.0, 1.0))
    name = f"rotation about axis {i + 1} {'along' if sign > 0 else 'against'} the field"
    return EquilibriumCurve(name, f"gamma{i + 1} = {sign}, omega = t gamma",
                            "t: rate about the field, rad/s", at, (segment,), (), samples)


def _rest(parts: Content) -> EquilibriumCurve:
    verdict = ("stable", SPHERE) if len(set(parts.D)) == 1 else ("unstable", LOST)

    def at(t: float) -> tuple[float, ...]:
        return (0.0, 0.0, 0.0, cos(t), sin(t), 0.0)
    sample = EquilibriumPoint(at(0.5), _spectrum(parts, at(0.5)), "degenerate", *verdict)
    return EquilibriumCurve("rest in every attitude", "omega = 0", "t: angle in the plane of gamma1, gamma2",
                            at, (CurveSegment((-inf, inf), "degenerate", *verdict),), (), (sample,))


def _spectrum(parts: Content, at: tuple[float, ...]) -> tuple[complex, ...]:
    """Eigenvalues of the linear motion next to an equilibrium omega = s gamma: at omega + u, gamma + v it is
    D u' = D u x omega + D omega x u + k B^2 ((u - s v) x gamma) x gamma, v' = gamma x (u - s v)."""
    import numpy as np
    D, w, g = np.diag([float(d) for d in parts.D]), np.array(at[:3]), np.array(at[3:])
    turn = lambda v: np.array(cross_matrix(v))
    s, slow = float(w @ g), float(parts.eddy) * (turn(g) @ turn(g))
    J: Any = np.block([[np.linalg.solve(D, turn(D @ w) - turn(w) @ D + slow), -s * np.linalg.solve(D, slow)],
                       [turn(g), -s * turn(g)]])
    return ordered(np.linalg.eigvals(J))
