"""The attitude of a case at t = 0 as a quaternion, for a run that is asked to carry it."""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from ..errors import InputError
from ..physics.states import as_quaternion, quaternion, scalar_last
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
    return replace(case, blocks=quaternion_blocks(case.blocks))


def quaternion_blocks(blocks: Mapping[str, Sequence[float]]) -> dict[str, Sequence[float]]:
    """The blocks of a state with their attitude, that of their vertical with theta = 0, or identity, as a
    unit quaternion with its scalar last; one that is given so stays."""
    given, vertical = blocks.get("attitude"), blocks.get("gamma")
    if given is not None and as_quaternion(given):
        return dict(blocks)
    angles = given or (attitude_of(vertical) if vertical else (0.0, 0.0, 0.0))
    return {**blocks, "attitude": tuple(scalar_last(quaternion(*angles)).tolist())}
