"""The door of `kernel`, compiled where there is a compiler, and its validated steps with a centre of as many
bits as are asked for, by python-flint: without a compiler, or farther than doubles reach.

Method, proof and bounds are those of the kernel. The centre and its Taylor coefficients are midpoints of
flint's balls; in place of FINE stands 2^(20 - bits): a coefficient takes fewer than 4 (N + 10) operations,
each within 2^-bits of its size. All else is in doubles, as there.
"""
from __future__ import annotations

from fractions import Fraction
from functools import lru_cache
from math import frexp, ldexp, sqrt
from operator import mul

import numpy as np

from ...numbers.balls import rational, working
from ...numbers.numba_door import compiled, installed
from . import kernel
from .kernel import COARSE, DONE, ENDLESS, GOING, HALVINGS, LOST, ORDER, WIDER

GUARD = 20  # bits that the roundings of a coefficient may use up


@lru_cache(maxsize=1)
def functions() -> dict:
    """The kernel's functions by name, compiled where numba is installed, else as they are."""
    return compiled(kernel) if installed() else vars(kernel)


def loaded() -> bool:
    """Whether the kernel is at hand, without loading it."""
    return bool(functions.cache_info().currsize)


def advance():
    """`kernel.advance`, compiled; None without numba."""
    return functions()["advance"] if installed() else None


def helpers():
    """What the steps in many digits take from the kernel."""
    table = functions()
    return tuple(table[name] for name in ("judged", "taken_along", "turned", "end_of_variations", "longest"))


def twofold(values):
    """Exact numbers, nested lists of them, as two arrays of doubles whose sum they are to 105 bits."""
    values = np.array(values, dtype=object)
    high = np.array([float(v) for v in values.ravel()])
    low = np.array([float(v - Fraction(h)) for v, h in zip(values.ravel(), high.tolist())])
    return high.reshape(values.shape), low.reshape(values.shape)


def rows_of(own):
    """(4, 3) exact numbers: kappa, rho, sigma, m of the rates."""
    form = own.quadratic()
    return [form.kappa, form.rho, form.sigma, form.m]


def energy_of(own):
    """(4,) roots of the moments, and the greatest rate at which the root of the sum of D omega^2 grows; zeros
    for scaled variables."""
    if own.variables == "scaled":
        return np.zeros(4)
    D, M = (np.array([float(v) for v in vector])
            for vector in (own.body.exact, own.vector("constant_torque")))
    return np.append(np.sqrt(D), sqrt(float((M * M / D).sum())))


class DigitSteps:
    """The set, in a scene's natural unit; `advance` and `box` as those of `run.Doubles`."""

    def __init__(self, own, start, unit, bits):
        self.bits, self.fine = bits, 2.0 ** (GUARD - bits)
        self.energy = energy_of(own)
        with working(bits):
            self.numbers = [[_middle(v) for v in row] for row in rows_of(own)]
            self.centre = [_middle(v / Fraction(unit)) for v in start]
        self.floats = np.array([[float(v) for v in row] for row in self.numbers])
        self.B = np.eye(3)
        self.rad = np.abs([float(v) for v in self.centre]) * 2.0 ** (1 - bits) + kernel.TINY

    def box(self):
        """(centre, what is left of it, radius), (3,) each."""
        with working(self.bits):
            middle = np.array([float(v) for v in self.centre])
            rest = np.array([float((v - float(v)).mid()) for v in self.centre])
        return middle, rest, (np.abs(self.B) @ self.rad + np.abs(middle) * 2.0**-104) * WIDER

    def advance(self, t, t_end, grain, steps, times, polynomials, radii):
        """As `kernel.advance`, of this set."""
        with working(self.bits):
            for number in range(steps):
                if t >= t_end:
                    return DONE, t, number
                status, h = self._step(t, t_end, grain, number, polynomials, radii)
                if status != GOING:
                    return status, t, number
                t += h
                if len(times):
                    times[number] = t
        return (DONE if t >= t_end else GOING), t, steps

    def _step(self, t, t_end, grain, number, polynomials, radii):
        middle = np.array([float(v) for v in self.centre])
        quadratic, linear, constant = (float(np.abs(self.floats[rows]).max())
                                       for rows in (slice(0, 1), slice(1, 3), slice(3, 4)))
        fastest = max(quadratic * float(np.abs(middle).max()), linear, constant**0.5)
        if not kernel.LEAST < fastest < kernel.MOST:
            return LOST, 0.0
        unit = ldexp(1.0, -frexp(fastest)[1])
        rows = self._series(unit)
        a = np.array([[float(v) for v in row] for row in rows])
        V = self._variations(unit, a)
        judged, taken_along, turned, end_of_variations, longest = helpers()
        error, spread, moved, P, E, M = np.zeros(3), np.zeros(3), np.zeros(3), np.zeros(3), np.zeros(
            (3, 3)), np.empty((3, 3))
        h = longest(a, self.fine * 16) * unit
        for _ in range(HALVINGS):
            h = min(h, t_end - t)
            if h < t_end - t:
                h = float(int(h / grain)) * grain
            if not h > 0:
                return ENDLESS, 0.0
            if judged(self.floats, self.energy, self.fine, a, V, self.B, self.rad, h, h / unit, error, spread,
                      moved, E, P):
                break
            h *= 0.5
        else:
            return LOST, 0.0
        x = h / unit
        end_of_variations(V, x, M)
        self.centre = [_value(row, x) for row in rows]
        moved = moved + E @ self.rad * WIDER
        if not taken_along(M, moved, self.rad, self.B):
            turned(M, moved, self.rad, self.B)
        if len(radii):
            polynomials[number] = a * x ** np.arange(ORDER + 1)
            radii[number] = (error + spread + COARSE * P) * WIDER
        return GOING, h

    def _series(self, unit):
        """Taylor coefficients of the three rates, time over `unit`."""
        rows = [[v] for v in self.centre]
        kappa, rho, sigma, m = self.numbers
        for n in range(ORDER):
            products = [sum(map(mul, rows[(i + 1) % 3], rows[(i + 2) % 3][n::-1])) for i in range(3)]
            new = [kappa[i] * products[i] + rho[i] * rows[(i + 2) % 3][n] + sigma[i] * rows[(i + 1) % 3][n]
                   + (0 if n else m[i]) for i in range(3)]
            for row, value in zip(rows, new):
                row.append((value * unit / (n + 1)).mid())
        return rows

    def _variations(self, unit, a):
        V = np.zeros((ORDER + 1, 3, 3))
        V[0] = self.B
        kappa, rho, sigma, _ = self.floats
        for n in range(ORDER):
            for i in range(3):
                j, k = (i + 1) % 3, (i + 2) % 3
                sums = a[j, n::-1] @ V[:n + 1, k] + a[k, n::-1] @ V[:n + 1, j]
                V[n + 1, i] = (kappa[i] * sums + rho[i] * V[n, k] + sigma[i] * V[n, j]) * (unit / (n + 1))
        return V


def _middle(value):
    from flint import arb
    return arb(rational(Fraction(value))).mid()


def _value(row, x):
    """The polynomial's value at x, by Horner's rule."""
    total = row[-1]
    for c in row[-2::-1]:
        total = (total * x + c).mid()
    return total
