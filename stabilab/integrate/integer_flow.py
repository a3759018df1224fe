"""The motion of a gyrostat under constant torque, enclosed by a Taylor series in integers with a proved bound
of its error, and the first time at which a quantity of it reaches a limit.

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

A limit is found by roots, and nothing is sampled. On a piece the quantity less its limit is a polynomial
g(s), 0 <= s <= 1, known to within err. From a place where g + err < 0 a bound B of |g''| tells how far g +
err stays below 0: to the root of g + err + g' s + B s^2 / 2. These steps end at the first root of g + err
from below, quadratically where it is simple, and pass whatever only comes near. A place behind where g - err
> 0 is the upper end.
"""
from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from operator import mul

from ..numbers.vectors import CYCLE

CLOCK = 40  # bits of a step's length: a multiple of 2^-40 in the motion's own time
SLACK = 16  # bits by which the last coefficient of a step may exceed the last place
FIRST = 2.0**-5  # first step times the size of the start
LONGER = 1.5  # most by which a step may exceed the one before
MORE = 1.0 + 2.0**-40  # more than the rounding of a few doubles
# Beside rates of 1 the numbers of an ordinary motion are below 2^STIFF; those above 2^STIFFEST would need
# steps shorter than the clock's. LEAST: of the weights beside the largest, whose roots stay doubles
STIFF, STIFFEST, LEAST = 20, CLOCK - 6, 2.0**-900


@dataclass(frozen=True)
class Piece:
    """The motion over one step: component i is sum_n rows[i][n] s^n 2^-bits, 0 <= s <= 1, and at most
    radii[i] 2^-bits off.

    start, length: in the motion's own time, exact; sizes: sum_n |rows[i][n]|, which is not below |component
    i|. Components 0, 1, 2 are the rates in their own unit; 3, 4, 5 those of the direction, where one is
    followed.
    """

    start: Fraction
    length: Fraction
    bits: int
    rows: list
    radii: list
    sizes: list


class IntegerFlow:
    """The pieces of the motion from an exact start, by `step`.

    form: `physics.scene.QuadraticForm`; weights: q above, positive rationals; start: three rationals;
    unit: one of the motion's own rates in the scene's, a rational (the motion's own time runs `unit` times as
    fast); direction: n at the start, three rationals, or None. work: multiplications done.
    """

    def __init__(self, form, weights, start, bits: int, unit: Fraction = Fraction(1), direction=None):
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

    def _series(self, length):
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

    def _widen(self, rows, products, sizes, h):
        """Let the error grow over a step: the defect is taken as if all of it stood at the start."""
        N, pairs, one = self.order, self._pairs(), 2.0**-self.bits
        tails = [_tail(rows[a], rows[b], N, self.bits) for a, b in pairs]
        rounding = N * (N + 1) / 2 + N + 1  # of the divisions by n + 1, and of the step's length
        defects = []
        for i, (j, k) in enumerate(CYCLE):
            kappa, rho, sigma = (abs(row[i]) * one for row in (self.kappa, self.rho, self.sigma))
            # products cut, sums cut, coefficients rounded
            inexact = kappa * N + N + 1 + (sum(map(abs, products[i])) + N + sizes[j] + sizes[k]) * one
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

    def _growth(self, sizes):
        """Bound of mu over a step."""
        total = sum((a * size * 2.0**-self.bits + b) ** 2 for (a, b), size in zip(self.shear, sizes))
        return math.sqrt(4 / 3 * total) * MORE


def _rounded(values, bits, by=1):
    return [round(Fraction(v) / by * (1 << bits)) for v in values]


def _shear(form, q, unit, i, j, k):
    """(a, b) with |S_jk| (q_j q_k)^(-1/2) <= a |x_i| + b."""
    root = 2 * math.sqrt(float(q[j] * q[k])) / MORE
    through = q[j] * form.kappa[j] + q[k] * form.kappa[k]
    constant = (q[j] * form.sigma[j] + q[k] * form.rho[k]) / unit
    return abs(float(through)) / root * MORE, abs(float(constant)) / root * MORE


def _tail(first, second, order, bits):
    """Bound of the sum of |first_i| |second_j| over i + j >= order, in units of 2^-bits."""
    total, rest = 0, 0
    # a is first's coefficient order - j where b is second's j; rest gathers |first_i|, i >= order - j
    for a, b in zip(reversed(first), second):
        rest += abs(a)
        total += rest * abs(b)
    return (total >> bits) + 1


SHORT = 72  # a step below 2^-72 of the piece has arrived: a crossing lies between neighbouring doubles
WIDE = 20  # up to 2^-20 of the piece behind the lower end the upper one is looked for at once
SHORTER = 1.0 - 2.0**-30  # less than what rounding adds to a step's length


@dataclass(frozen=True)
class Threshold:
    """A quantity and its limit: sum_r c_r (a_r . y)^2 reaches `limit` from below, or, with `falls`, a . y
    reaches it from above.

    y: the components of a `Piece`, in the motion's own unit; terms: ((c_r, a_r), ...), positive c_r, a_r as
    many rationals as there are components.
    """

    terms: tuple
    limit: Fraction
    falls: bool = False

    def passed(self, y) -> bool:
        """Whether exact components reach the limit."""
        values = [(c, sum(a * v for a, v in zip(vector, y))) for c, vector in self.terms]
        return values[0][1] <= self.limit if self.falls else sum(c * v * v for c, v in values) >= self.limit


class Search:
    """The first crossing of one threshold, as the pieces of a motion come by. low, high: in the motion's own
    time; None as long as not found.

    exactly: whether the error of the pieces is taken into account; else they are taken at their word.
    """

    def __init__(self, threshold: Threshold, exactly: bool = True):
        self.threshold, self.exactly = threshold, exactly
        self.low: Fraction | None = None
        self.high: Fraction | None = None

    def take(self, piece: Piece) -> bool:
        """Look at the next piece; whether the crossing is known from both sides."""
        g = _Excess(self.threshold, piece, self.exactly)
        if g.stays_below():
            return False
        s = 0
        if self.low is None:
            s = g.reaches(1)
            if s is None:
                return False
            self.low = piece.start + piece.length * Fraction(s, 1 << piece.bits)
        s = g.surely_beyond(s)
        if s is None:
            return False
        self.high = piece.start + piece.length * Fraction(s, 1 << piece.bits)
        return True


class _Excess:
    """g over one piece: in units of 2^(-2 bits) for squares, 2^-bits for what falls."""

    def __init__(self, threshold, piece, exactly):
        self.bits, self.falls, self.one = piece.bits, threshold.falls, 1 << piece.bits
        made = [_combined(vector, piece) for _, vector in threshold.terms]
        self.rows, self.sizes = [row for row, _ in made], [sum(map(abs, row)) for row, _ in made]
        radii = [radius for _, radius in made]
        self.weights = [round(c * self.one) for c, _ in threshold.terms]
        self.limit = round(threshold.limit * self.one)
        slack = 2 * max(map(len, self.rows))  # of Horner's rule, twice
        off = [(radius if exactly else 0) + slack for radius in radii]
        self.size = self.sizes[0] if self.falls else self._sum([v * v for v in self.sizes])
        if self.falls:
            self.err = off[0] + 1
        else:  # squares, then weights and limit rounded
            self.err = (self._sum([2 * v * r + r * r for v, r in zip(self.sizes, off)])
                        + sum((v * v >> self.bits) + 1 for v in self.sizes) + self.one)
        self.bend, self.rough = self._bend(), self._rough(max(map(len, self.rows)))

    def _sum(self, values):
        return sum(c * v for c, v in zip(self.weights, values)) + self.one - 1 >> self.bits

    def _bend(self):
        first = [sum(n * abs(v) for n, v in enumerate(row)) for row in self.rows]
        second = [sum(n * (n - 1) * abs(v) for n, v in enumerate(row)) for row in self.rows]
        return (second[0] if self.falls
                else 2 * self._sum([f * f + v * w for f, v, w in zip(first, self.sizes, second)]))

    def _rough(self, terms):
        """What rounding may take from the slope."""
        steep = [sum(n * abs(v) for n, v in enumerate(row)) for row in self.rows]
        return (terms * (terms + 1) if self.falls
                else 2 * self._sum([terms * (terms + 1) * v + terms * w for v, w in zip(self.sizes, steep)])
                + 2)

    def stays_below(self):
        """Whether bounds of the components alone keep g below 0."""
        if self.falls:
            row = self.rows[0]
            return row[0] - (self.size - abs(row[0])) - self.err > self.limit
        return self.size + self.err < self.limit << self.bits

    def value(self, s):
        """(g, g') at s, an integer in units of 2^-bits; g' is not too small, and rounding of g is part of
        err."""
        found = []
        for row in self.rows:
            v = slope = 0
            for c in reversed(row):
                slope = (slope * s >> self.bits) + v
                v = (v * s >> self.bits) + c
            found.append((v, slope))
        if self.falls:
            return self.limit - found[0][0], self.rough - found[0][1]
        value = self._sum([v * v for v, _ in found]) - (self.limit << self.bits)
        return value, 2 * self._sum([v * slope for v, slope in found]) + self.rough

    def reaches(self, sign, s=0):
        """The last place that the steps reach from s before g + sign err may be 0; None where there is no
        such place in the piece."""
        while True:
            value, slope = self.value(s)
            gap = -(value + sign * self.err)
            if gap <= 0:
                return s
            ahead = self._safe(gap, slope)
            s += max(ahead, 1)
            if s >= self.one:
                return None
            if ahead < self.one >> SHORT:
                return s - max(ahead, 1)

    def _safe(self, gap, slope):
        scale = max(gap, abs(slope), self.bend, 1)
        a, b, c = gap / scale, slope / scale, self.bend / scale
        root = math.sqrt(b * b + 2 * c * a)
        ahead = 2 * a / (root + b) if b > 0 else (root - b) / c if c else 2.0
        return int(min(ahead, 2.0) * SHORTER * self.one)

    def surely_beyond(self, s):
        """A place from s on where g - err > 0, as near as can be found; None where the piece has none."""
        while s is not None:
            for places in range(SHORT - 2, WIDE, -1):
                behind = min(s + (self.one >> places), self.one)
                if self.value(behind)[0] > self.err:
                    return behind
            s += self.one >> WIDE
            s = self.reaches(-1, s) if s < self.one else None
        return None


def _combined(vector, piece):
    """(the row of a . y, how far it may be off), in units of 2^-bits."""
    used = [(Fraction(a), row, radius, size)
            for a, row, radius, size in zip(vector, piece.rows, piece.radii, piece.sizes) if a]
    if len(used) == 1 and abs(used[0][0]) == 1:
        a, row, radius, _ = used[0]
        return (row if a > 0 else [-v for v in row]), radius
    factors = [round(a * (1 << piece.bits)) for a, *_ in used]
    rows = [sum(f * v for f, v in zip(factors, column)) >> piece.bits
            for column in zip(*(row for _, row, _, _ in used))]
    radius = sum(math.ceil(abs(a)) * r + (size >> piece.bits) + 1 for a, _, r, size in used) + len(rows)
    return rows, radius
