"""The attitude of a case at t = 0 as a quaternion, for a run that is asked to carry it."""
from __future__ import annotations

from dataclasses import replace

from ..errors import InputError
from ..physics.states import quaternion, scalar_last
from .read import Case, attitude_of


def with_quaternion(case: Case) -> Case:
    """The case with its own attitude, that of its vertical with theta = 0, or identity, as a unit quaternion
    with its scalar last.

    Raises InputError where the variables are scaled: a system without moments has no attitude.
    """
    if case.variables == "scaled":
        raise InputError(
            f"{case.place}: --attitude: scaled variables have no attitude: give the motion as "
            f"angular_velocity, in rad/s")
    vertical = case.blocks.get("gamma")
    angles = case.blocks.get("attitude") or (attitude_of(vertical) if vertical else (0.0, 0.0, 0.0))
    return replace(case, blocks={**case.blocks, "attitude": tuple(scalar_last(quaternion(*angles)).tolist())})
