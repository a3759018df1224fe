"""The state at any time from the reduced form: time as an integral over the coordinate, inverted. Nothing is stepped.

A bounded motion, or a rotation without torque, repeats: dt/dphi is a smooth periodic function, its Fourier series is
summed term by term to t(phi), and a time is folded by the period first, so that the cost does not depend on it. A
spin-up about a circle never repeats: dt is integrated over panels (Gauss's rule) from the state, or from the turning
point behind it, as far as the latest time.
"""
from __future__ import annotations

import numpy as np

from ..errors import InputError
from .extremes import _turn_back
from .fate import fate
from .landscape import TURN, landscape
from .quadrature import Modes
from .results import Fate
from .turning import interval

PANEL = TURN / 8  # of the coordinate of a spin-up
AT_ONCE = 256  # panels integrated in one go
NEWTON = 12  # steps at most; the last changes nothing
ROUNDING = 4e-16


class Closed:
    """t(phi) of a motion that repeats, from `nodes` samples of dt/dphi over a turn of phi.

    counts: evaluations of dt/dphi so far.
    """

    def __init__(self, path, nodes):
        self.path, self.counts = path, nodes
        samples = np.fft.rfft(path.rate(np.arange(nodes) * (TURN / nodes))) / nodes
        self.mean = samples[0].real
        top = nodes // 2  # the mode that the samples cannot tell from its mirror image is left out
        self.k = np.arange(1, top)
        self.sines, self.cosines = 2 * samples[1:top].real / self.k, 2 * samples[1:top].imag / self.k
        self.period = TURN * self.mean

    def time(self, phi):
        angle = np.multiply.outer(phi, self.k)
        return self.mean * phi + np.sin(angle) @ self.sines + (np.cos(angle) - 1) @ self.cosines

    def at(self, times):
        """States (n, 3)."""
        wanted = np.fmod(np.asarray(times, float), self.period) + self.time(np.array([self.path.start]))
        phi = wanted / self.mean
        for _ in range(NEWTON):
            step = (wanted - self.time(phi)) / self.path.rate(phi)
            self.counts += phi.size
            phi = phi + np.clip(step, -1, 1)
            if np.abs(step).max() <= ROUNDING * TURN:
                break
        return self.path.states(phi)


class Libration:
    """theta = middle - half cos phi between two turning points."""

    def __init__(self, land, place, w):
        span = interval(land, place, w)
        if not span.ok[0]:
            raise InputError("the turning points of this motion take more digits than doubles have")
        self.land, self.half, self.middle = land, float(span.half[0]), tuple(span.middle)
        self.modes = Modes(land, span.middle)
        centre = 0.5 * float(span.left[0] + span.right[0])
        left = min(max(-float(span.left[0]) / (2 * self.half), 0.0), 1.0)
        here = self._rate(left, 1 - left)
        self.start = float(np.arctan2(w[0] * here[0] / self.half, centre / self.half))

    def _rate(self, left, right):
        left, right = np.atleast_1d(left), np.atleast_1d(right)
        return 1 / np.sqrt(2 * self.modes.second_difference(np.full(left.shape, self.half), left, right))

    def rate(self, phi):
        """dt/dphi."""
        return self._rate(np.sin(0.5 * phi) ** 2, np.cos(0.5 * phi) ** 2)

    def states(self, phi):
        place = self.land.potential.move(tuple(np.broadcast_to(v, phi.shape) for v in self.middle), -self.half * np.cos(phi))
        return self.land.components(place, self.half * np.sin(phi) / self.rate(phi))


class Rotation:
    """theta = theta_0 + phi over all barriers, in the sense of the rate."""

    start = 0.0

    def __init__(self, land, place, w):
        self.land, self.place, self.w = land, place, float(w[0])
        self.force = land.potential.force(place)
        self.sense = 1.0 if self.w > 0 else -1.0

    def _speed(self, phi):
        return np.sqrt(self.w**2 - 2 * self.land.potential.rise(phi, tuple(np.broadcast_to(v, phi.shape) for v in self.place), self.force))

    def rate(self, phi):
        """dt/dphi."""
        return self.sense / self._speed(phi)

    def states(self, phi):
        place = self.land.potential.move(tuple(np.broadcast_to(v, phi.shape) for v in self.place), phi)
        return self.land.components(place, self.sense * self._speed(phi))


class Return:
    """theta = theta_l + s^2 from the turning point behind a motion that spins up: smooth where it starts at rest or goes back first."""

    def __init__(self, land, place, w):
        offset = min(float(_turn_back(land, place, w)[0][0]), 0.0)
        self.land, self.place = land, tuple(land.potential.move(place, offset))
        self.force = land.potential.force(self.place)
        self.start = float(np.copysign(np.sqrt(-offset), w[0]))

    def _share(self, s):
        """(E - V)/(theta - theta_l)."""
        y = np.where(s == 0, 1.0, s * s)
        place = tuple(np.broadcast_to(v, s.shape) for v in self.place)
        return np.where(s == 0, self.force, -self.land.potential.rise(y, place, self.force) / y)

    def rate(self, s):
        """dt/ds."""
        return 2 / np.sqrt(2 * self._share(s))

    def states(self, s):
        place = self.land.potential.move(tuple(np.broadcast_to(v, s.shape) for v in self.place), s * s)
        return self.land.components(place, s * np.sqrt(2 * self._share(s)))


class Open:
    """t(s) of a spin-up: panels of Gauss's rule with `nodes` points each."""

    def __init__(self, path, nodes):
        self.path, self.counts = path, 0
        self.points, self.weights = np.polynomial.legendre.leggauss(nodes)

    def _over(self, a, b):
        """Integrals of the rate over the intervals (a, b)."""
        half = 0.5 * (b - a)
        sigma = (0.5 * (a + b))[:, None] + half[:, None] * self.points
        self.counts += sigma.size
        return half * (self.path.rate(sigma.ravel()).reshape(sigma.shape) @ self.weights)

    def _knots(self, latest):
        """(knots, times there) as far as the latest time."""
        knots, passed = [np.array([self.path.start])], [np.zeros(1)]
        while passed[-1][-1] < latest:
            first = knots[-1][-1]
            new = self._panels(first)
            times = passed[-1][-1] + np.cumsum(self._over(np.concatenate([[first], new[:-1]]), new))
            enough = int(np.searchsorted(times, latest)) + 1
            knots.append(new[:enough])
            passed.append(times[:enough])
        return np.concatenate(knots), np.concatenate(passed)

    @staticmethod
    def _panels(first):
        """Ends of panels, even in theta = s^2 once the motion is far from its turning point."""
        small, out = np.sqrt(PANEL), []
        for _ in range(AT_ONCE):
            first = first + min(small, PANEL / (2 * abs(first)) if first else small)
            out.append(first)
        return np.array(out)

    def at(self, times):
        """States (n, 3) at times of no negative sign."""
        times = np.asarray(times, float)
        knots, passed = self._knots(times.max(initial=0.0))
        panel = np.clip(np.searchsorted(passed, times, side="right") - 1, 0, len(knots) - 1)
        base, sigma = knots[panel], knots[panel]
        for _ in range(NEWTON):
            step = (times - passed[panel] - self._over(base, sigma)) / self.path.rate(sigma)
            self.counts += sigma.size
            sigma = sigma + step
            if (np.abs(step) <= ROUNDING * np.maximum(np.abs(sigma), 1)).all():
                break
        return self.path.states(sigma)


def path_of(scene, state):
    """The motion as an integral over a coordinate: Closed or Open and its path. Raises InputError where there is none."""
    if not scene.plain:
        raise InputError("the scene has effects outside the reduced form")
    land = landscape(scene)
    if land is None:
        raise InputError("the scene has no reduction to one degree of freedom")
    states = np.asarray(state, float)[None]
    decided = fate(scene, states)
    label, (place, w, _) = Fate(int(decided.labels[0])), land.start(states)
    if label == Fate.BOUNDED:
        rotating = land.e < 0 and land.sense == 0 and decided.margins[0] < 0
        return Closed, (Rotation if rotating else Libration)(land, place, w)
    if label == Fate.SPIN_UP and land.e < 0:
        return Open, Return(land, place, w)
    raise InputError(f"the reduced form is set up for motions that repeat and for spin-up round a circle; this one: {label.word}")


def reduced(scene, state, nodes: int):
    """The motion with `at(times)` and `counts`, at a resolution of `nodes` samples a turn (bounded) or points a panel."""
    kind, path = path_of(scene, state)
    return kind(path, nodes)


def ladder(scene, state) -> tuple[int, ...]:
    """Resolutions worth trying for this motion."""
    return (8, 16, 32, 64, 128, 256) if path_of(scene, state)[0] is Closed else (2, 4, 6, 8, 12, 16)
