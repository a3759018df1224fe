"""A motion that repeats, at any time: librations between two turning points, rotations without torque.

Well away from a separatrix the phase phi (offset = middle - half cos phi, or the angle itself) differs from the mean
phase psi = 2 pi t/T by a Fourier series in psi. Its coefficients are means over phi, d_k = <exp(-i k psi(phi))>/(i k)
(as Bessel's for Kepler's equation), so nothing is inverted: one sum gives the state at any time. Next to a separatrix,
where the series is long, the panels of `passages` take over.
"""
from __future__ import annotations

import math

import numpy as np

from .passages import Panels, Passing, Turning, turning_offset
from .relief import TURN, Arrays, Plain

SAMPLES = (64, 128, 256, 512)
NOISE = 4e-16  # coefficients of phi below this are rounding
DIP = 1e-3  # kinetic energy over a hill against the largest: below it the hill's own coordinate is needed
CHUNK = 4096


class Phase:
    """phi(psi) - psi as a Fourier series from samples of dt/dphi over a turn of phi; even: so is dt/dphi; settled: the
    series is as long as doubles need."""

    def __init__(self, rate, even):
        n = len(rate)
        k = np.arange(1, n // 2)
        spectrum = np.fft.rfft(rate) / n
        self.mean = float(spectrum[0].real)
        slow = np.zeros(n // 2 + 1, complex)
        slow[1:-1] = spectrum[1:-1] / (1j * k * self.mean)
        lead = np.fft.irfft(slow * n, n)  # psi - phi at the samples, but for a constant
        psi = np.arange(n) * (TURN / n) + (lead - lead[0])
        top = k[: n // 3]
        series = np.exp(-1j * np.multiply.outer(top, psi)).mean(axis=1) / (1j * top)
        constant = float(((np.arange(n) * (TURN / n) - psi) * rate).mean() / self.mean)
        size = np.abs(series)
        self.settled = bool(size[-len(top) // 4:].max() <= NOISE and np.abs(slow[-n // 8:]).max() <= 4 * NOISE)
        kept = int(np.nonzero(size > NOISE / 8)[0].max(initial=-1)) + 1
        self.sines, self.cosines = (-2 * series.imag[:kept]).tolist(), (2 * series.real[:kept]).tolist()
        self.constant = constant
        self.to_psi = lambda phi: phi + _lead(slow, phi) - _lead(slow, 0.0)
        self.even, self.evaluations = even, n

    def __call__(self, psi, f):
        sine, twice = f.sin(psi), 2 * f.cos(psi)
        one = two = 0.0
        for coefficient in self.sines[::-1]:
            one, two = twice * one - two + coefficient, one
        phi = psi + sine * one
        if self.even:
            return phi
        one = two = 0.0
        for coefficient in self.cosines[::-1]:
            one, two = twice * one - two + coefficient, one
        return phi + self.constant + (0.5 * twice * one - two)


def _lead(slow, phi):
    """Sum of the real Fourier series with one-sided coefficients at one angle."""
    k = np.arange(len(slow))
    return float(2 * (slow * np.exp(1j * k * phi)).real.sum())


class Between:
    """offset = middle - half cos phi between turning points a (from spot `left`) and b (from `right`)."""

    even = True

    def __init__(self, left, a, right, b):
        self.left, self.a, self.right, self.b = left, a, right, b
        self.half = 0.5 * (right.at - left.at + (b - a))

    def samples(self, n):
        """dt/dphi at n even angles: mirror images about phi = 0."""
        phi = np.arange(n // 2 + 1) * (TURN / n)
        part = n // 4 + 1
        first = self._rate(self.left, self.a, 1, phi[:part])
        second = self._rate(self.right, self.b, -1, np.pi - phi[part:])
        rate = np.concatenate([first, second])
        return np.concatenate([rate, rate[-2:0:-1]])

    def _rate(self, spot, a, sense, phi):
        """From the turning point at phi = 0: K = way * share, and half sin phi = sqrt(way (2 half - way))."""
        way = 2 * self.half * np.sin(0.5 * phi) ** 2
        return np.sqrt(self.half * np.cos(0.5 * phi) ** 2 / (sense * spot.share(a, sense * way, Arrays)))

    def phase(self, w):
        """phi of the state."""
        left = self.a + self.left.at <= 0 and -self.left.at - self.a <= self.half
        spot, a, sense = (self.left, self.a, 1) if left else (self.right, self.b, -1)
        way = max(sense * (-spot.at - a), 0.0)
        small = 2 * math.atan2(abs(w) / math.sqrt(2 * sense * spot.share(a, sense * way, Plain)),
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
        for mine, spot, a, sense, root in ((low, self.left, self.a, 1, np.sin), (~low, self.right, self.b, -1, np.cos)):
            angle = phi[mine]
            way = sense * 2 * self.half * root(0.5 * angle) ** 2
            w = np.copysign(np.sqrt(2 * way * spot.share(a, way, Arrays)), np.sin(angle))
            out[mine], offsets[mine] = np.array(spot.state(a + way, w, Arrays)).T, spot.at + a + way
        return out, offsets


class Around:
    """The angle itself, from the hill nearest in height, all round a circle without torque."""

    even = False

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
    """at(t): (omega_1, omega_2, omega_3) at one time; follow(times): (states (n, 3), way of the coordinate since time 0 (n,));
    period: inf where it does not repeat; evaluations: of the integrand, in all."""

    evaluations = 0

    def states(self, times):
        """(n, 3)."""
        return self.follow(np.asarray(times, float))[0]


class BySeries(Motion):
    """A motion on `path` whose phase is a series; sense: of its rotation, 0 for a libration."""

    def __init__(self, path, phase, w, sense=0.0):
        self.path, self.phase, self.sense, self.evaluations = path, phase, sense, phase.evaluations
        self.period = TURN * phase.mean
        self.start = phase.to_psi(path.phase(w))
        self.pace = (sense or 1.0) / phase.mean

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
