"""A motion that repeats, at any time: librations between two turning points, rotations without torque.

Well away from a separatrix the time is a short Fourier series of the phase phi (offset = middle - half cos
phi, or the angle itself), which Newton's method inverts; of a rotation phi less the mean phase psi = 2 pi t/T
is a series in psi with the coefficients d_k = <exp(-i k psi(phi))>/(i k), means over phi (as Bessel's for
Kepler's equation), so nothing is inverted. Next to a separatrix, where the series are long, the panels of
`spin_up` take over.
"""
from __future__ import annotations

import math
from collections.abc import Callable
from functools import lru_cache

import numpy as np

from ...errors import InputError
from ...physics.coefficients import effective
from ..far_states import BEYOND, ORDINARY, powered, scene_exponent
from .profile import NOISE, TURN, Phase, Rule

SAMPLES = (48, 96, 192)  # over a turn of phi, for the time
ROTATION_SAMPLES = (64, 128, 256, 512)
NEWTON = 20
DIP = 1e-3  # kinetic energy over a hill against the largest: below it the hill's own coordinate is needed
TOO_FINE = "the reduced form of this motion takes more digits than doubles have; take method taylor"


class Between:
    """offset = middle - half cos phi between turning points a (from spot `left`) and b (from `right`)."""

    def __init__(self, left, a, right, b):
        self.left, self.a, self.right, self.b = left, a, right, b
        self.half = 0.5 * (right.at - left.at + (b - a))

    def samples(self, rule):
        """dt/dphi at the angles of a `Rule`, from the turning point of each half: K = way * share, and half
        sin phi = sqrt(way (2 half - way))."""
        way, part = rule.way * (2 * self.half), len(rule.angles) // 2 + 1
        if self.left is self.right:
            share = self.left.share(self.a * rule.low + self.b * rule.high, way)
        else:
            share = np.concatenate([self.left.share(self.a, way[:part]),
                                    self.right.share(self.b, way[part:])])
        return np.sqrt(rule.near * self.half / share)

    def phase(self, w):
        """phi of the state."""
        left = -self.left.at - self.a <= self.half  # by rounding a state at a turning point may lie beyond it
        spot, a, sense = (self.left, self.a, 1) if left else (self.right, self.b, -1)
        way = max(sense * (-spot.at - a), 0.0)
        steep = 2 * sense * spot.share(a, sense * way)
        if not steep > 0:
            raise InputError(TOO_FINE)
        small = 2 * math.atan2(abs(w) / math.sqrt(steep),
                               math.sqrt(max(2 * self.half - way, 0.0)))
        return math.copysign(small if left else math.pi - small, w)

    def follow(self, phi):
        """(states (n, 3), offsets from the state (n,)) at phases."""
        out, offsets = np.empty((len(phi), 3)), np.empty(len(phi))
        low = np.cos(phi) >= 0
        for mine, spot, a, sense, root in ((low, self.left, self.a, 1, np.sin),
                                           (~low, self.right, self.b, -1, np.cos)):
            angle = phi[mine]
            way = sense * 2 * self.half * root(0.5 * angle) ** 2
            w = np.copysign(np.sqrt(2 * way * spot.share(a, way)), np.sin(angle))
            out[mine], offsets[mine] = np.array(spot.state(a + way, w)).T, spot.at + a + way
        return out, offsets


class Around:
    """The angle itself, from the hill nearest in height, all round a circle without torque."""

    def __init__(self, spot, sense):
        self.spot, self.sense = spot, sense

    def samples(self, n):
        phi = np.arange(n) * (TURN / n)
        return 1 / np.sqrt(2 * self.spot.energy(phi))

    def phase(self, w):
        return -self.spot.at

    def follow(self, phi):
        w = self.sense * np.sqrt(2 * self.spot.energy(phi))
        return np.array(self.spot.state(phi, w)).T, self.spot.at + phi


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


class BySeries(Motion):
    """A libration `between` turning points whose time is a series of its phase, from n samples over a turn.
    """

    sense = 0.0

    def __init__(self, between, w, n):
        self.path, self.rule = between, Rule(n)
        self.evaluations = n // 2 + 1
        rates = between.samples(self.rule)
        found, m = (self.rule.matrix @ rates).tolist(), n // 2 + 1
        self.times = found[2 * m:]
        self.mean = found[0]
        noise = NOISE * self.mean
        self.settled = max(map(abs, found[2 * m - 1 - m // 4:2 * m - 1])) <= noise  # false for NaN
        kept = m - 1
        while kept > 1 and abs(found[m + kept - 1]) <= noise / 8:
            kept -= 1
        self._rows = list(zip(found[m + kept - 1:m:-1], found[kept - 1:0:-1]))
        self.period = TURN * self.mean
        phi = between.phase(w)
        self.start = math.copysign(float(self._time(abs(phi))[0]), phi)

    def _time(self, phi):
        """(time since phi = 0, dt/dphi)."""
        twice = 2 * np.cos(phi)
        s = ss = c = cc = 0.0
        for slow, fast in self._rows:
            s, ss = twice * s - ss + slow, s
            c, cc = twice * c - cc + fast, c
        return self.mean * phi + s * np.sin(phi), self.mean + 0.5 * twice * c - cc

    def follow(self, times):
        time = np.fmod(times, self.period) + self.start
        time = time - self.period * np.round(time / self.period)
        half = np.abs(time)
        phi = np.interp(half, self.times, self.rule.angles)
        for _ in range(NEWTON):
            found, rate = self._time(phi)
            moved = (found - half) / rate
            phi = phi - moved
            if np.abs(moved).max(initial=0.0) <= 1e-8:  # the next step would square that
                break
        return self.path.follow(np.copysign(phi, time))


class Rotation(Motion):
    """All round a circle without torque, the phase being a series; n samples a turn."""

    def __init__(self, path, w, n):
        self.path, self.sense = path, path.sense
        self.phase, self.evaluations = Phase(path.samples(n)), n
        self.settled, self.period = self.phase.settled, TURN * self.phase.mean
        self.start, self.pace = self.phase.to_psi(path.phase(w)), path.sense / self.phase.mean

    def follow(self, times):
        states, way = self.path.follow(self.phase(self.start + self.pace * np.fmod(times, self.period)))
        return states, way + self.sense * TURN * np.trunc(times / self.period)


def by_samples(kind, path, w, nodes, counts):
    """The motion of a `kind` with as many samples as it takes (None: more than `counts` has), or with
    `nodes`."""
    evaluations = 0
    for n in (nodes,) if nodes else counts:
        motion = kind(path, w, n)
        evaluations += motion.evaluations
        if motion.settled or nodes:
            motion.evaluations = evaluations
            return motion
    return None


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
def exponent(scene, state) -> int | None:
    """The exponent k of the own unit 2^k of the motion from three floats, as of `far_exponent`; None where
    its size is ordinary."""
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
