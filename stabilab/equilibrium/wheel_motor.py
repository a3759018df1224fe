"""Steady rotation while a motor turns a wheel: there is none, but where an outer torque takes the momentum.

With D omega' = (D omega + Lambda + h) x omega + M - u and h' = u the rates stay only if u x omega = 0, for h
grows along u. Then the component of the equation along u is u . M = |u|^2.
"""
from __future__ import annotations

from ..numbers.vectors import dot
from ..physics.coefficients import Content
from ..reasons import Sentence
from .result import Equilibria

NONE = Sentence(
    "motor-no-equilibrium",
    "the wheel takes momentum along u at the motor's torque: rates that stay are along u for that, and then "
    "u . M - |u|², the torques on the body along u, would have to vanish")()
FED = Sentence(
    "motor-may-be-fed",
    "undecided: the outer torque has the motor's component along its line, and may feed the wheel while the "
    "body keeps its rates")()
MOTOR_WITH_OTHERS = Sentence(
    "equilibria-motor-beside",
    "undecided: of a running wheel motor beside a medium, a damper, a liquid or a field not all equilibria "
    "are known")()


def equilibria_with_a_motor(parts: Content) -> Equilibria:
    """None where wheels and a torque act besides that has not the motor's component along its line; undecided
    beside anything else."""
    if parts.without_motor.kind != "gyrostat" or parts.kappa:
        return Equilibria("undecided", reason=MOTOR_WITH_OTHERS)
    if dot(parts.u, parts.M) == dot(parts.u, parts.u):
        return Equilibria("undecided", reason=FED)
    return Equilibria("none", reason=NONE)
