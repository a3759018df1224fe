"""Equilibria of a body that a liquid in a cavity or a resisting medium takes energy from.

`liquid` has the balance with a liquid, `medium` that with a resisting medium alone; here is what both
together or a body in a field leave to say. The liquid does no work against rest, and for Lambda = 0 it only
takes energy: T' <= M . omega - 2 c T.
"""
from __future__ import annotations

from fractions import Fraction

from ..numbers.balls import many_digits
from ..numbers.vectors import dot
from ..physics.coefficients import Content
from .field_balance import Field, blocks, rotations_at
from .field_states import around
from .liquid import balanced_equilibria, liquid_equilibria
from .medium import resisted_equilibria
from .result import CurveSegment, Equilibria, EquilibriumCurve, EquilibriumPoint

MINIMUM = ("asymptotically stable",
           "the potential energy has a strict minimum here and the medium takes energy at every rotation "
           "(LaSalle)")
NO_MINIMUM = ("unstable",
              "the potential energy is not least here and the medium takes energy at every rotation: states "
              "of less energy next to "
                          "this one leave and do not come back")
CONTINUUM = ("stable",
             "rest positions of one energy, strictly least across them: they attract their neighbourhood "
             "(the others of the eigenvalues "
                       "lie on the left), so each of them is stable")
OPEN = ("undecided",
        "the second variation of the potential energy is degenerate: a term of higher order decides")


def dissipative_equilibria(parts: Content) -> Equilibria:
    """Equilibria of the angular velocity with resistance, a liquid or both, a wheel, a constant charge and a
    torque."""
    if not parts.kappa:
        return resisted_equilibria(parts)
    if parts.unproved_loss:
        return Equilibria("undecided", parts.unproved_loss)
    if not parts.c and not any(parts.M):
        return liquid_equilibria(parts)
    if not any(parts.M) and not any(parts.Lambda):
        return _rest_with_liquid(parts)
    return balanced_equilibria(parts)


def held_in_a_field(parts: Content) -> Equilibria:
    """Equilibria of a body in a field that a liquid or a medium takes energy from."""
    if parts.kappa:
        return Equilibria("undecided",
                          "undecided: where the body carries a liquid, the torque of a field or of a turning "
                          "charge enters the liquid's own "
                                       "torque, and equilibria beyond those of the body without liquid are "
                                       "not excluded")
    if any(parts.M):
        return Equilibria("undecided",
                          "undecided: a constant torque and a field hold a turning body against the medium "
                          "only where four equations in omega "
                                       "and gamma meet; no closed form is known")
    return rest_positions(parts)


def _rest_with_liquid(parts: Content) -> Equilibria:
    c = -float(parts.c)
    rest = EquilibriumPoint((0.0,) * 3, (complex(c, 0.0),) * 3, "stable", "asymptotically stable",
                            "every motion tends to it: T' <= -2 c T, since the liquid only takes energy and "
                            "the medium takes 2 c T")
    return Equilibria("points", "T' <= -2 c T, so only rest is an equilibrium", (rest,))


def rest_positions(parts: Content) -> Equilibria:
    """Rest positions of a body in a field with a resisting medium: (omega, gamma) with omega = 0."""
    with many_digits():
        field = Field.of(parts)
        found = [(rotation, _rest(parts, field, rotation)) for rotation in rotations_at(field, Fraction(0))]
    points = tuple(point for rotation, point in found if not rotation.circle)
    curves = tuple(_continuum(rotation, point) for rotation, point in found if rotation.circle)
    reason = ("the medium takes energy at every rotation, so only rest is an equilibrium: gamma where the "
              "torque of the field vanishes, "
              "(N D + mu) gamma = s, by one polynomial in mu whose real roots are certified")
    return Equilibria("curves" if curves else "points", reason, points, curves)


def _rest(parts, field, rotation) -> EquilibriumPoint:
    """Verdict by the second variation of the potential energy on the tangent plane of |gamma| = 1."""
    n = [k - rotation.mu for k in field.stiffness(0 * field.N)]
    squares = [g * g for g in rotation.gamma]
    trace = -dot(n, [1 - x for x in squares])
    determinant = n[1] * n[2] * squares[0] + n[2] * n[0] * squares[1] + n[0] * n[1] * squares[2]
    at = (0.0, 0.0, 0.0, *(float(g.mid()) for g in rotation.gamma))
    if len(rotation.circle) == 3:
        word, verdict = "degenerate", CONTINUUM
    elif rotation.circle:
        word, verdict = "degenerate", CONTINUUM if trace > 0 else NO_MINIMUM if trace < 0 else OPEN
    elif determinant > 0 and trace > 0:
        word, verdict = "stable", MINIMUM
    elif determinant < 0 or (determinant > 0 and trace < 0):
        word, verdict = "unstable", NO_MINIMUM
    else:
        word, verdict = "degenerate", OPEN
    return EquilibriumPoint(at, _spectrum(parts, field, rotation), word, *verdict)


def _spectrum(parts, field, rotation):
    import numpy as np
    A, B = (np.array([[float(v) if not hasattr(v, "mid") else float(v.mid()) for v in row] for row in block])
            for block in blocks(field, 0 * field.N, rotation.gamma))
    x, y, z = (float(g.mid()) for g in rotation.gamma)
    turn = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    J = np.block([[A - float(parts.c) * np.eye(3), B], [turn, np.zeros((3, 3))]])
    return tuple(complex(v) for v in np.linalg.eigvals(J))


def _continuum(rotation, point: EquilibriumPoint) -> EquilibriumCurve:
    name = "every direction" if len(rotation.circle) == 3 else "circle of rest positions"
    segment = CurveSegment((float("-inf"), float("inf")), point.linear, point.verdict, point.because)
    equation, parametrisation, run = around(Fraction(0), rotation)
    return EquilibriumCurve(name, equation, parametrisation, run, (segment,), (), (point,))
