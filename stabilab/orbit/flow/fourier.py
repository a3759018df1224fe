"""Fourier series of a phase: the time over it, and the phase over the time, from samples of dt/dphi at even angles."""
from __future__ import annotations

from functools import lru_cache

import numpy as np

from .profile import TURN

NOISE = 4e-16  # coefficients of phi below this are rounding
TINY = 1e-290  # no way at all, but not 0/0


@lru_cache(maxsize=16)
class Rule:
    """Even functions of phi from their values at phi_m = m 2 pi/n, m = 0 ... n/2.

    matrix: to their n/2 + 1 coefficients (of cos k phi), to those of the integral less its mean (of sin k phi), and to the
    integral at the nodes. low, high: 1 where the phase is told from the turning point on the left, or the right; way: from
    there in units of 2 half, signed; near: cos^2 (phi/2) seen from there, signed.
    """

    def __init__(self, n):
        last = n // 2
        phi, k = np.arange(last + 1) * (TURN / n), np.arange(last + 1)
        weights = np.where((k == 0) | (k == last), 0.5, 1.0)
        fourier = 2.0 / last * np.cos(np.outer(k, phi)) * weights[:, None] * weights
        slow = fourier * np.where((k > 0) & (k < last), 1 / np.maximum(k, 1), 0.0)[:, None]
        self.sines = np.sin(np.outer(phi, k))
        self.matrix = np.vstack([fourier, slow, np.outer(phi, fourier[0]) + self.sines @ slow])
        self.phi, self.angles, self.k, self.weights = phi, phi.tolist(), k, weights / last
        part = last // 2 + 1
        self.low = (k < part).astype(float)
        self.high = 1 - self.low
        back = np.pi - phi
        self.way = np.where(k < part, np.maximum(np.sin(0.5 * phi) ** 2, TINY), -np.maximum(np.sin(0.5 * back) ** 2, TINY))
        self.near = np.where(k < part, np.cos(0.5 * phi) ** 2, -np.cos(0.5 * back) ** 2)


class EvenPhase:
    """phi(psi) - psi as a sine series, from phi - psi at the samples of a `Rule`; settled: it is as long as doubles need."""

    def __init__(self, rule, slow, mean):
        psi = rule.phi + rule.sines @ slow / mean
        top = rule.k[1: 2 * len(rule.k) // 3]
        series = np.cos(np.multiply.outer(top, psi)) @ rule.weights * (2 / top)
        self.settled = _settled(series)
        self.sines = _kept(series)

    def __call__(self, psi, f):
        return psi + f.sin(psi) * _clenshaw(self.sines, 2 * f.cos(psi))[0]


class Phase:
    """phi(psi) - psi as a Fourier series from samples of dt/dphi over a turn of phi; settled: it is as long as doubles need."""

    def __init__(self, rate):
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
        self.constant = float(((np.arange(n) * (TURN / n) - psi) * rate).mean() / self.mean)
        self.settled = _settled(series) and bool(np.abs(slow[-n // 8:]).max() <= 4 * NOISE)
        kept = len(_kept(series))
        self.sines, self.cosines = (-2 * series.imag[:kept]).tolist(), (2 * series.real[:kept]).tolist()
        self.to_psi = lambda phi: phi + _lead(slow, phi) - _lead(slow, 0.0)

    def __call__(self, psi, f):
        twice = 2 * f.cos(psi)
        one, two = _clenshaw(self.cosines, twice)
        return psi + f.sin(psi) * _clenshaw(self.sines, twice)[0] + self.constant + (0.5 * twice * one - two)


def _settled(series) -> bool:
    return bool(np.abs(series[-len(series) // 4:]).max() <= NOISE)


def _kept(series) -> list:
    """The series without the rounding at its end."""
    return series[:int(np.nonzero(np.abs(series) > NOISE / 8)[0].max(initial=-1)) + 1].tolist()


def _clenshaw(coefficients, twice):
    """(b_1, b_2) of Clenshaw's sum with twice = 2 cos psi."""
    one = two = 0.0
    for coefficient in coefficients[::-1]:
        one, two = twice * one - two + coefficient, one
    return one, two


def _lead(slow, phi):
    """Sum of the real Fourier series with one-sided coefficients at one angle."""
    k = np.arange(len(slow))
    return float(2 * (slow * np.exp(1j * k * phi)).real.sum())
