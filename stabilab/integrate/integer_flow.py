"""The motion of a gyrostat under constant torque, enclosed by a Taylor series in integers with a proved bound
of its error.

Numbers are integers in units of 2^-bits. Any polynomial p obeys p' = f(p) + defect, and here the defect is
bounded term by term: what rounds each coefficient, and what the products have beyond the order. The
difference e of two solutions of

    x_i' = kappa_i x_j x_k + rho_i x_k + sigma_i x_j + m_i        (i, j, k cyclic)

in the norm (sum q_i e_i^2)^(1/2), q weights with sum q_i kappa_i = 0 (the moments of inertia), grows at most
by the factor exp(integral of mu),

    mu = (4/3 sum S_jk^2 / (q_j q_k))^(1/2),    2 S_jk = (q_j kappa_j + q_k kappa_k) x_i + q_j sigma_j + q_k
    rho_k

(proof: docs/mathematics/numbers.md; in physical variables the wheel drops out). With bits to spare for that
factor the enclosure is as narrow as wanted, and no set has to be turned. A direction n at rest in space obeys
n' = n x omega, and its error grows by that of omega alone: |e_n|' <= |n| |e_omega|.
"""
from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from operator import mul
from typing import TYPE_CHECKING

from ..numbers.vectors import CYCLE
from .crossing import Piece

if TYPE_CHECKING:
    from ..physics.scene import QuadraticForm

CLOCK = 40  # bits of a step's length: a multiple of 2^-40 in the motion's own time
SLACK = 16  # bits by which the last coefficient of a step may exceed the last place
FIRST = 2.0**-5  # first step times the size of the start
LONGER = 1.5  # most by which a step may exceed the one before
MORE = 1.0 + 2.0**-40  # more than the rounding of a few doubles
# Beside rates of 1 the numbers of an ordinary motion are below 2^STIFF; those above 2^STIFFEST would need
# steps shorter than the clock's. LEAST: of the weights beside the largest, whose roots stay doubles
STIFF, STIFFEST, LEAST = 20, CLOCK - 6, 2.0**-900


class IntegerFlow:
    """The pieces of the motion from an exact start, by `step`.

    form: `physics.scene.QuadraticForm`; weights: q above, positive rationals; start: three rationals;
    unit: one of the motion's own rates in the scene's, a rational (the motion's own time runs `unit` times as
    fast); direction: n at the start, three rationals, or None. work: multiplications done.
    """

    def __init__(self, form: QuadraticForm, weights: Sequence[Fraction], start: Sequence[Fraction], bits: int,
                 unit: Fraction = Fraction(1), direction: Sequence[Fraction] | None = None):
        self.bits, self.order, self.work, self.unit = bits, 6 + int(0.35 * bits), 0, unit
        self.kappa, self.rho, self.sigma, self.m = (_rounded(row, bits, by) for row, by in (
            (form.kappa, 1), (form.rho, unit), (form.sigma, unit), (form.m, unit * unit)))
        self.x = _rounded(start, bits, unit) + _rounded(direction or (), bits)
        self.now, self.error, self.turned = Fraction(0), 0, 0
        self.stiff = max(abs(v).bit_length() for v in (*self.kappa, *self.rho, *self.sigma, *self.m)) - bits
        largest = max(weights)
        q = [Fraction(w) / largest for w in weights]
        self.apart = self.stiff > STIFFEST or min(q) < LEAST
        if self.apart:
            return
        if sum(w * k for w, k in zip(q, form.kappa)):
            raise ValueError("the weights do not make the cubic terms cancel")
        self.q = [float(w) for w in q]
        self.shear = [_shear(form, q, unit, i, j, k) for i, (j, k) in enumerate(CYCLE)]
        self.least = math.sqrt(min(self.q)) / MORE
        self.error = math.ceil(math.sqrt(sum(self.q)) * MORE)  # the start is within half a last place
        self.turned = 2
        self.turns = math.sqrt(sum(float(v) ** 2 for v in direction)) * MORE if direction else 0.0
        self.h = FIRST / max(1.0, max(abs(v) for v in self.x[:3]) / (1 << bits))
        if self.stiff > STIFF:
            self.h *= 2.0**-self.stiff

    def turn_on(self, form):
        """From here on the constant torque of this form acts, of the same body and wheels."""
        self.m = _rounded(form.m, self.bits, self.unit * self.unit)

    def step(self, until: Fraction | None = None) -> Piece:
        """The next piece; until: the own time, exact, beyond which it does not go. Raises OverflowError where
        the motion's numbers are too far apart, or its error leaves the range of doubles."""
        if self.apart:
            raise OverflowError("the numbers of the motion are too far apart for its steps")
        while True:
            ticks = max(1, int(self.h * (1 << CLOCK)))
            length = Fraction(ticks, 1 << CLOCK)
            cut = until is not None and self.now + length >= until
            if cut:
                length = until - self.now
            rows, products = self._series(length)
            top = max(abs(row[-1]).bit_length() for row in rows)
            if top <= 2 * SLACK or ticks == 1:
                break
            self.h *= 0.5 ** max(1.0, (top - SLACK) / self.order)
        h = float(length)
        sizes = [sum(map(abs, row)) for row in rows]
        self._widen(rows, products, sizes, h)
        radius = math.ceil(self.error / self.least * MORE)
        radii = ([math.ceil(self.error / math.sqrt(q) * MORE) for q in self.q]
                 + [self.turned] * (len(rows) - 3))
        piece = Piece(self.now, length, self.bits, rows, radii, sizes)
        if radius.bit_length() > 900:
            raise OverflowError("the error has grown beyond the range of doubles")
        self.x, self.now = [sum(row) for row in rows], self.now + piece.length
        if not cut:  # a short last piece says nothing of the next one's length
            self.h = h * min(LONGER, 2.0 ** ((SLACK - top) / self.order))
        return piece

    def forget(self, bits: int):
        """Take the error as 2^-bits of what it is: from here on pieces are taken at their word, and only its
        growth is of interest."""
        self.error >>= bits

    def _pairs(self):
        """(row, row, which of them) of every product that the rates are made of."""
        pairs = [CYCLE[i] for i in range(3)]
        return (pairs + [(3 + a, b) for j, k in CYCLE for a, b in ((j, k), (k, j))] if len(self.x) > 3
                else pairs)

    def _series(self, length: Fraction):
        """(coefficients of each component times the step's powers, those of every product)."""
        bits, h, over = self.bits, length.numerator, length.denominator
        rows, pairs = [[v] for v in self.x], self._pairs()
        products = [[] for _ in pairs]
        for n in range(self.order):
            for into, (a, b) in zip(products, pairs):
                into.append(sum(map(mul, rows[a], reversed(rows[b]))) >> bits)
            new = []
            for i, (j, k) in enumerate(CYCLE):
                rate = self.kappa[i] * products[i][n] + self.rho[i] * rows[k][n] + self.sigma[i] * rows[j][n]
                new.append(((rate + (self.m[i] << bits if n == 0 else 0)) * h // (over << bits)) // (n + 1))
            for i in range(len(rows) - 3):
                new.append(((products[3 + 2 * i][n] - products[4 + 2 * i][n]) * h // over) // (n + 1))
            for row, value in zip(rows, new):
                row.append(value)
        self.work += self.order * (self.order + 8) // 2 * len(pairs)
        return rows, products

    def _widen(self, rows: Sequence[list[int]], products: Sequence[list[int]], sizes: Sequence[int],
               h: float):
        """Let the error grow over a step: the defect is taken as if all of it stood at the start."""
        N, pairs, item = self.order, self._pairs(), 2.0**-self.bits
        tails = [_tail(rows[a], rows[b], N, self.bits) for a, b in pairs]
        rounding = N * (N + 1) / 2 + N + 1  # of the divisions by n + 1, and of the step's length
        defects = []
        for i, (j, k) in enumerate(CYCLE):
            kappa, rho, sigma = (abs(row[i]) * item for row in (self.kappa, self.rho, self.sigma))
            # products cut, sums cut, coefficients rounded
            inexact = kappa * N + N + 1 + (sum(map(abs, products[i])) + N + sizes[j] + sizes[k]) * item
            beyond = kappa * tails[i] + rho * abs(rows[k][N]) + sigma * abs(rows[j][N])
            defects.append((rounding + h * (inexact + beyond)) * MORE)
        before = self.error
        grown = (before
                 + math.sqrt(sum(q * d * d for q,
                                 d in zip(self.q, defects)))) * math.exp(h * self._growth(sizes) * MORE)
        self.error = math.ceil(grown * MORE)
        if len(rows) > 3:
            cut = [rounding + h * (2 * N + tails[3 + 2 * i] + tails[4 + 2 * i]) for i in range(3)]
            turned = (self.turned + math.sqrt(sum(c * c for c in cut))
                      + h * (self.turns + 2.0**-40) * self.error / self.least)
            self.turned = math.ceil(turned * MORE)

    def _growth(self, sizes: Sequence[int]):
        """Bound of mu over a step."""
        total = sum((a * size * 2.0**-self.bits + b) ** 2 for (a, b), size in zip(self.shear, sizes))
        return math.sqrt(4 / 3 * total) * MORE


def _rounded(values: Sequence[Fraction], bits: int, by: int | Fraction = 1):
    return [round(Fraction(v) / by * (1 << bits)) for v in values]


def _shear(form: QuadraticForm, q: Sequence[Fraction], unit: Fraction, i: int, j: int, k: int):
    """(a, b) with |S_jk| (q_j q_k)^(-1/2) <= a |x_i| + b."""
    root = 2 * math.sqrt(float(q[j] * q[k])) / MORE
    through = q[j] * form.kappa[j] + q[k] * form.kappa[k]
    constant = (q[j] * form.sigma[j] + q[k] * form.rho[k]) / unit
    return abs(float(through)) / root * MORE, abs(float(constant)) / root * MORE


def _tail(first: Sequence[int], second: Sequence[int], order: int, bits: int):
    """Bound of the sum of |first_i| |second_j| over i + j >= order, in units of 2^-bits."""
    total, rest = 0, 0
    # a is first's coefficient order - j where b is second's j; rest gathers |first_i|, i >= order - j
    for a, b in zip(reversed(first), second):
        rest += abs(a)
        total += rest * abs(b)
    return (total >> bits) + 1
