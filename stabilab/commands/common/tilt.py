"""What a tilt of the torque does to a motion: an angle as typed, or what the case states."""
from __future__ import annotations

from ...answers.when import with_tilt
from ...case.limit_options import stated_angle
from ...case.read import blamed_on


def with_angle(case, motion, angle: str | None):
    """The motion with what a tilt up to the angle does to it; None: the angle that the case states."""
    with blamed_on(case):
        return with_tilt(case, motion, None if angle is None else stated_angle(angle, "tilt"))
