"""The reduced form as one of the ways to follow a motion: `reduced_motion` at a given resolution."""
from __future__ import annotations

import math
from typing import Any

from ...errors import InputError
from ...orbit.flow.flow import reduced_motion
from ...physics.scene import AnyScene

SAMPLES = (8, 16, 32, 64, 128, 256, 512)  # of the phase over a turn, for motions that repeat
POINTS = (2, 4, 6, 8, 12, 16)  # of Gauss's rule on each panel of a spin-up


class Reduced:
    """The motion with at(times) -> states (n, 3), its period, and `counts`: evaluations of the integrand in
    its preparation."""

    def __init__(self, motion: Any) -> None:
        self.at, self.period, self.counts = motion.states, motion.period, motion.evaluations


def reduced(scene: AnyScene, state: Any, nodes: int) -> Reduced:
    """At a resolution of `nodes` samples a turn (motions that repeat) or points a panel (spin-up). Raises
    InputError where the motion has no reduced form."""
    return Reduced(reduced_motion(scene, state, nodes))


def ladder(scene: AnyScene, state: Any) -> tuple[int, ...]:
    """Resolutions worth trying for this motion."""
    if reduced_motion(scene, state).period == 0:
        raise InputError("the state is an equilibrium: there is nothing to follow")
    return SAMPLES if math.isfinite(reduced_motion(scene, state).period) else POINTS
