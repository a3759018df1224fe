"""Why a motion has the fate it has, in words; and whether a state is at rest, decided exactly."""
from __future__ import annotations

from enum import IntEnum


class Reason(IntEnum):
    """Why a label was given; `REASONS` has the words."""

    BELOW_BARRIER = 0
    ABOVE_BARRIER = 1
    NO_BARRIER = 2
    WALLS = 3
    PLANE_CAPTURED = 4
    PLANE_ESCAPES = 5
    PURE_SPIN = 6
    TIE = 7
    AT_REST = 8
    TORQUE_FREE = 9
    UNBOUNDED_LAW = 10
    OFF_AXIS = 11
    TURN_ROUNDS = 12
    CERTIFIED = 13
    CLOSED_FORM = 14


REASONS = {
    Reason.BELOW_BARRIER: "the energy is below the barrier of the reduced potential that stands ahead of it in the direction of the torque",
    Reason.ABOVE_BARRIER: "the energy exceeds every barrier of the reduced potential within one turn ahead, and each later turn is lower still",
    Reason.NO_BARRIER: "the orbit's circle carries no equilibrium, so the reduced potential falls all the way in the direction of the torque",
    Reason.WALLS: "the reduced potential grows without bound on both sides of the motion",
    Reason.PLANE_CAPTURED: "on the invariant plane Q = 0, below the barrier that stands ahead",
    Reason.PLANE_ESCAPES: "on the invariant plane Q = 0 that decays in the direction of the torque, above any barrier: a set of measure zero",
    Reason.PURE_SPIN: "pure spin about the torque's axis: the other two rates stay where the torque does not see them",
    Reason.TIE: "the energy equals the barrier's: the motion tends to the saddle equilibrium",
    Reason.AT_REST: "every rate vanishes at the state, exactly",
    Reason.TORQUE_FREE: "no torque: the kinetic energy is constant, and it is positive definite",
    Reason.UNBOUNDED_LAW: "|H|^2/2 - D_i T grows steadily at the rate lambda_i M_i: no motion is bounded",
    Reason.OFF_AXIS: "the torque is off the principal axes, where no integral of motion is known, and no certificate of spin-up was met",
    Reason.TURN_ROUNDS: "the energy is within 1e-36 of a barrier's, and the turn that puts the torque on an axis has irrational numbers, "
                        "carried to 240 bits",
    Reason.CERTIFIED: "the torque is off the principal axes, and the motion meets an inequality that stays true for ever",
    Reason.CLOSED_FORM: "the torque is off the principal axes, and equal moments leave a closed solution",
}


def margin_at_rest(scene, margin: float) -> float:
    """The margin of an equilibrium from the barriers that `margin` knows, those beyond the state itself.

    Where these are lower and a torque acts, its neighbours on one side are released and it is not: it lies on the separatrix.
    """
    return max(margin, 0.0) if any(scene.quadratic().m) else margin
