"""Periodic motions at any time, as series and tables.

A motion that repeats, at any time: librations between two turning points, rotations without torque.

Well away from a separatrix the time is a short Fourier series of the phase phi (offset = middle - half cos
phi, or the angle itself): one time is inverted by Newton's method. For many, phi less the mean phase psi = 2
pi t/T is a series in psi with the coefficients d_k = <exp(-i k psi(phi))>/(i k), means over phi (as Bessel's
for Kepler's equation), so nothing is inverted. Next to a separatrix, where the series are long, the panels of
`passages` take over.
"""
from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Callable
from functools import cached_property, lru_cache

import numpy as np

from ...errors import InputError
from ...physics.coefficients import effective
from ..far_states import BEYOND, ORDINARY, powered, scene_exponent
from .profile import NOISE, TURN, Arrays, EvenPhase, Phase, Plain, Rule

SAMPLES = (48, 96, 192)  # over a turn of phi, for the time
PHASES = (48, 96, 192, 384)  # for the phase
ROTATION_SAMPLES = (64, 128, 256, 512)
NEWTON = 20
DIP = 1e-3  # kinetic energy over a hill against the largest: below it the hill's own coordinate is needed
CHUNK = 4096
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
            share = self.left.share(self.a * rule.low + self.b * rule.high, way, Arrays)
        else:
            share = np.concatenate([self.left.share(self.a, way[:part], Arrays),
                                    self.right.share(self.b, way[part:], Arrays)])
        return np.sqrt(rule.near * self.half / share)

    def phase(self, w):
        """phi of the state."""
        left = -self.left.at - self.a <= self.half  # by rounding a state at a turning point may lie beyond it
        spot, a, sense = (self.left, self.a, 1) if left else (self.right, self.b, -1)
        way = max(sense * (-spot.at - a), 0.0)
        steep = 2 * sense * spot.share(a, sense * way, Plain)
        if not steep > 0:
            raise InputError(TOO_FINE)
        small = 2 * math.atan2(abs(w) / math.sqrt(steep),
                               math.sqrt(max(2 * self.half - way, 0.0)))
        return math.copysign(small if left else math.pi - small, w)

    def at(self, phi):
        """(spot, offset, W) at one phase."""
        low = math.cos(phi) >= 0
        spot, a, sense = (self.left, self.a, 1) if low else (self.right, self.b, -1)
        root = math.sin(0.5 * phi) if low else math.cos(0.5 * phi)
        way = sense * 2 * self.half * root * root
        w = math.sqrt(2 * way * spot.share(a, way, Plain))
        return spot, a + way, math.copysign(w, math.sin(phi))

    def follow(self, phi):
        """(states (n, 3), offsets from the state (n,)) at phases."""
        out, offsets = np.empty((len(phi), 3)), np.empty(len(phi))
        low = np.cos(phi) >= 0
        for mine, spot, a, sense, root in ((low, self.left, self.a, 1, np.sin),
                                           (~low, self.right, self.b, -1, np.cos)):
            angle = phi[mine]
            way = sense * 2 * self.half * root(0.5 * angle) ** 2
            w = np.copysign(np.sqrt(2 * way * spot.share(a, way, Arrays)), np.sin(angle))
            out[mine], offsets[mine] = np.array(spot.state(a + way, w, Arrays)).T, spot.at + a + way
        return out, offsets


class Around:
    """The angle itself, from the hill nearest in height, all round a circle without torque."""

    def __init__(self, spot, sense):
        self.spot, self.sense = spot, sense

    def samples(self, n):
        phi = np.arange(n) * (TURN / n)
        return 1 / np.sqrt(2 * self.spot.energy(phi, Arrays))

    def phase(self, w):
        return -self.spot.at

    def at(self, phi):
        return self.spot, phi, self.sense * math.sqrt(2 * self.spot.energy(phi, Plain))

    def follow(self, phi):
        w = self.sense * np.sqrt(2 * self.spot.energy(phi, Arrays))
        return np.array(self.spot.state(phi, w, Arrays)).T, self.spot.at + phi


class Motion:
    """at(t): (omega_1, omega_2, omega_3) at one time; follow(times): (states (n, 3), way of the coordinate
    since time 0 (n,)); period: inf where it does not repeat; evaluations: of the integrand, in all."""

    evaluations = 0
    period: float
    follow: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]

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
        self.rates, self.times = rates.tolist(), found[2 * m:]
        self.mean = found[0]
        noise = NOISE * self.mean
        self.settled = max(map(abs, found[2 * m - 1 - m // 4:2 * m - 1])) <= noise  # false for NaN
        kept = m - 1
        while kept > 1 and abs(found[m + kept - 1]) <= noise / 8:
            kept -= 1
        self._rows = list(zip(found[m + kept - 1:m:-1], found[kept - 1:0:-1]))
        self._slow = found[m:2 * m]
        self.period = TURN * self.mean
        phi = between.phase(w)
        self.start = math.copysign(self._time(abs(phi))[0], phi)

    def _time(self, phi):
        """(time since phi = 0, dt/dphi)."""
        twice = 2 * math.cos(phi)
        s = ss = c = cc = 0.0
        for slow, fast in self._rows:
            s, ss = twice * s - ss + slow, s
            c, cc = twice * c - cc + fast, c
        return self.mean * phi + s * math.sin(phi), self.mean + 0.5 * twice * c - cc

    def _phi(self, time):
        """phi at a time in [0, T/2]: from cubics between the samples, by Newton's method."""
        times, rates, angles = self.times, self.rates, self.rule.angles
        n = min(max(bisect_right(times, time) - 1, 0), len(times) - 2)
        step = times[n + 1] - times[n]
        u = (time - times[n]) / step
        v = 1 - u
        phi = (angles[n] * v * v * (1 + 2 * u) + angles[n + 1] * u * u * (1 + 2 * v)
               + step * u * v * (v / rates[n] - u / rates[n + 1]))
        for _ in range(NEWTON):
            found, rate = self._time(phi)
            moved = (found - time) / rate
            phi -= moved
            if -1e-8 <= moved <= 1e-8:  # the next step would square that
                break
        return phi

    def _place(self, t):
        """Phase in [-pi, pi]."""
        time = math.remainder(t, self.period) + self.start
        if abs(time) > 0.5 * self.period:
            time -= math.copysign(self.period, time)
        return math.copysign(self._phi(abs(time)), time)

    def at(self, t):
        spot, y, w = self.path.at(self._place(t))
        return spot.state(y, w, Plain)

    @cached_property
    def phase(self) -> EvenPhase | None:
        """None where the series of the phase is too long."""
        slow, mean, rule = np.array(self._slow), self.mean, self.rule
        for n in PHASES:
            if n > 2 * len(rule.phi) - 2:
                rule, slow = Rule(n), np.append(slow, np.zeros(n // 2 + 1 - len(slow)))
            if (phase := EvenPhase(rule, slow, mean)).settled:
                return phase
        return None

    def follow(self, times):
        out, way = np.empty((len(times), 3)), np.empty(len(times))
        for first in range(0, len(times), CHUNK):
            part = slice(first, first + CHUNK)
            if self.phase is None:
                phi = np.array([self._place(t) for t in times[part].tolist()])
            else:
                phi = self.phase((self.start + np.fmod(times[part], self.period)) / self.mean, Arrays)
            out[part], way[part] = self.path.follow(phi)
        return out, way


class Rotation(Motion):
    """All round a circle without torque, the phase being a series; n samples a turn."""

    def __init__(self, path, w, n):
        self.path, self.sense = path, path.sense
        self.phase, self.evaluations = Phase(path.samples(n)), n
        self.settled, self.period = self.phase.settled, TURN * self.phase.mean
        self.start, self.pace = self.phase.to_psi(path.phase(w)), path.sense / self.phase.mean

    def at(self, t):
        spot, y, w = self.path.at(self.phase(self.start + self.pace * math.fmod(t, self.period), Plain))
        return spot.state(y, w, Plain)

    def follow(self, times):
        out, way = np.empty((len(times), 3)), np.empty(len(times))
        for first in range(0, len(times), CHUNK):
            part = slice(first, first + CHUNK)
            psi = self.start + self.pace * np.fmod(times[part], self.period)
            out[part], way[part] = self.path.follow(self.phase(psi, Arrays))
        return out, way + self.sense * TURN * np.trunc(times / self.period)


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

    def at(self, t):
        time, sign, _ = self._folded(np.array([t]))
        spot, y, w = self.panels.at(float(time[0]))
        return spot.state(y, w * float(sign[0]), Plain)

    def follow(self, times):
        time, sign, turns = self._folded(times)
        states, offsets = self.panels.follow(time, sign)
        return states, offsets + TURN * turns


class Resting(Motion):
    """A state whose rates are all zero."""

    period = 0.0

    def __init__(self, state):
        self.state = tuple(map(float, state))

    def at(self, t):
        return self.state

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
            raise InputError(
                f"at t = {t:.3g} the motion has gone further than doubles can count: ask for "
                f"earlier times") from None


# --- A motion that repeats, as polynomials in time over equal parts of its period: a state for some thirty
# multiplications
PARTS = (48, 96, 192, 384)
DEGREE = 11
SETTLED = 2e-15  # last coefficients against the largest value: what rounding of the samples leaves of them
TABLE_CHUNK = 1024


def tabulated(motion: Motion) -> Motion:
    """The motion from a table; itself where it does not repeat or turns too sharply for one (next to a
    separatrix)."""
    if not 0 < motion.period < math.inf:
        return motion
    nodes, fit, powers = _rule()
    for parts in PARTS:
        times = (np.arange(parts)[:, None] + 0.5 * (1 + nodes)) * (motion.period / parts)
        states, way = motion.follow(times.ravel())
        rows = fit @ np.column_stack([states, way]).reshape(parts, DEGREE + 1, 4)
        if (np.abs(rows[:, -2:]).max(axis=(0, 1)) <= SETTLED * np.abs(rows).max(axis=(0, 1))).all():
            return Tabulated(motion, powers @ rows, motion.evaluations + times.size)
    return motion


@lru_cache(maxsize=1)
def _rule():
    """(nodes in (-1, 1), matrix from values there to Chebyshev's coefficients, matrix from those to powers).
    """
    cheb = np.polynomial.chebyshev
    nodes, powers = cheb.chebpts1(DEGREE + 1), np.zeros((DEGREE + 1, DEGREE + 1))
    for k in range(DEGREE + 1):
        powers[:k + 1, k] = cheb.cheb2poly(np.eye(DEGREE + 1)[k, :k + 1])
    return nodes, np.linalg.inv(cheb.chebvander(nodes, DEGREE)), powers


class Tabulated(Motion):
    """rows (parts, DEGREE + 1, 4): coefficients of the states and of the way of the coordinate."""

    def __init__(self, motion, rows, evaluations):
        self.period, self.sense, self.evaluations = motion.period, motion.sense, evaluations
        self.axis, self.spin = motion.axis, motion.spin
        self.parts, self.rows = len(rows), np.ascontiguousarray(rows.transpose(1, 2, 0))
        self._cells = [tuple(map(tuple, cell[:, :3].T.tolist())) for cell in rows]
        self._scale = self.parts / self.period

    def at(self, t):
        place = math.fmod(t, self.period) * self._scale
        if place < 0:
            place += self.parts
        n = int(place)
        x = 2 * (place - n) - 1
        return [a + x
                * (b + x * (c
                            + x * (d + x
                                   * (e + x * (f
                                               + x * (g + x * (h + x * (i + x * (j + x * (k + x * m))))))))))
                for a, b, c, d, e, f, g, h, i, j, k, m in self._cells[n if n < self.parts else 0]]

    def states(self, times):
        return self._rows_at(np.asarray(times, float), 3).T

    def follow(self, times):
        out, turns = self._rows_at(times, 4), np.floor(times / self.period)
        return out[:3].T, out[3] + self.sense * TURN * turns

    def _rows_at(self, times, count):
        """The first so many rows (count, n) of the table at times."""
        table = np.ascontiguousarray(self.rows[:, :count])
        out, scale, parts = np.empty((count, len(times))), self._scale, self.parts
        for first in range(0, len(times), TABLE_CHUNK):
            part = slice(first, first + TABLE_CHUNK)
            place = np.fmod(times[part], self.period)
            place *= scale
            place += parts * (place < 0)
            n = np.minimum(place.astype(np.intp), parts - 1)
            x = 2 * (place - n) - 1
            total = np.take(table[-1], n, axis=1, mode="clip")
            buffer = np.empty_like(total)
            for row in table[-2::-1]:
                total *= x
                total += np.take(row, n, axis=1, mode="clip", out=buffer)
            out[:, part] = total
        return out
