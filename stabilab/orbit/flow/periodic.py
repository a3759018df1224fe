"""A motion that repeats, at any time: librations between two turning points, rotations without torque."""
from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from ...errors import InputError
from ..far_states import BEYOND, powered
from .profile import TURN

TOO_FINE = "the reduced form of this motion takes more digits than doubles have; take method taylor"


class Motion:
    """at(t): (omega_1, omega_2, omega_3) at one time; follow(times): (states (n, 3), way of the coordinate
    since time 0 (n,)); period: inf where it does not repeat; evaluations: of the integrand, in all."""

    evaluations = 0
    period: float
    axis: int
    spin: tuple[float, float]
    follow: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]

    def at(self, t):
        return self.follow(np.array([t], float))[0][0].tolist()

    def states(self, times):
        """(n, 3)."""
        return self.follow(np.asarray(times, float))[0]


class ByPanels(Motion):
    """A motion that runs a chain of passages to and fro (sense 0), or over and over in one sense."""

    def __init__(self, panels, start, sense=0.0):
        self.panels, self.sense, self.start = panels, sense, start
        self.period = panels.total if sense else 2 * panels.total

    def _folded(self, times):
        """(times in the chain, signs of W, turns done) of an array."""
        passed = self.start + (self.sense or 1.0) * np.fmod(times, self.period)
        folded = np.mod(passed, self.period)
        if self.sense:
            turns = np.round((passed - folded) / self.period) + self.sense * np.trunc(times / self.period)
            return np.minimum(folded, self.panels.total), np.full(folded.shape, self.sense), turns
        back = folded > self.panels.total
        return np.where(back, self.period - folded, folded), np.where(back, -1.0, 1.0), 0.0

    def follow(self, times):
        time, sign, turns = self._folded(times)
        states, offsets = self.panels.follow(time, sign)
        return states, offsets + TURN * turns


class Resting(Motion):
    """A state whose rates are all zero."""

    period = 0.0

    def __init__(self, state):
        self.state = tuple(map(float, state))

    def follow(self, times):
        return np.tile(self.state, (len(times), 1)), np.zeros(len(times))


# --- A motion whose squares leave the range of doubles, followed in its own unit of rate: rates change by a
# power of two, time by its inverse
class InOwnUnit(Motion):
    """A motion in the scene's unit, from the same one in the unit 2^k."""

    def __init__(self, motion: Motion, k: int):
        self.motion, self.k, self.evaluations, self.sense = motion, k, motion.evaluations, getattr(
            motion, "sense", 0.0)
        self.period = powered(motion.period, -k)
        if math.isnan(self.period):
            raise InputError(f"the period of this motion is {BEYOND}: choose another unit of time")

    def follow(self, times):
        states, way = self.motion.follow(np.array([self._time(t) for t in times.tolist()]))
        return np.ldexp(states, self.k), way

    def _time(self, t):
        """The time in the own unit. Raises InputError where it is no double."""
        try:
            return math.ldexp(t, self.k)
        except OverflowError:
            raise InputError(
                f"at t = {t:.3g} the motion has gone further than doubles can count: ask for "
                f"earlier times") from None
