"""A motion whose squares leave the range of doubles, followed in its own unit of rate: rates change by a power of two, time by its inverse."""
from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from ...errors import InputError
from ...physics.coefficients import effective
from ..far_states import BEYOND, ORDINARY, powered, scene_exponent
from .periodic import Motion


def exponent(scene, state) -> int | None:
    """The exponent k of the own unit 2^k of the motion from three floats, as of `far_exponent`; None where its size is ordinary."""
    found = [math.frexp(v)[1] for v in state if v]
    if (own := _of_scene(scene)) is not None:
        found.append(own)
    size = max(found, default=0)
    return None if -ORDINARY <= size <= ORDINARY else size


@lru_cache(maxsize=64)
def _of_scene(scene):
    return scene_exponent(effective(scene))


class InOwnUnit(Motion):
    """A motion in the scene's unit, from the same one in the unit 2^k."""

    def __init__(self, motion: Motion, k: int):
        self.motion, self.k, self.evaluations, self.sense = motion, k, motion.evaluations, getattr(motion, "sense", 0.0)
        self.period = powered(motion.period, -k)
        if math.isnan(self.period):
            raise InputError(f"the period of this motion is {BEYOND}: choose another unit of time")

    def at(self, t):
        return [powered(v, self.k) for v in self.motion.at(self._time(t))]

    def follow(self, times):
        states, way = self.motion.follow(np.array([self._time(t) for t in times.tolist()]))
        return np.ldexp(states, self.k), way

    def _time(self, t):
        """The time in the own unit. Raises InputError where it is no double."""
        try:
            return math.ldexp(t, self.k)
        except OverflowError:
            raise InputError(f"at t = {t:.3g} the motion has gone further than doubles can count: ask for earlier times") from None
