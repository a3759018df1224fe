"""A motion that spins up about the axis of a torque, at any time: its turns are summed in closed form.

Each turn of the circle adds the same work, so at one place the kinetic energies of successive turns are C (a + n) with
C = 2 pi mu, and the time n turns take is an integral over one turn of sums of (a + n)^(-1/2). By Euler and Maclaurin

    sum of (a + n)^(-1/2), n = 0 ... N - 1,  = Z(a + N) - Z(a),   Z(a) = 2 sqrt(a) - a^(-1/2)/2 - a^(-3/2)/24 + ...,

to the last digit once a >= 12, whatever the height of the hills; the dozen turns before that are summed one by one. The turn in
which the motion comes from rest, or the state lies, is cut into panels of its own (`passages`).
"""
from __future__ import annotations

import math
from bisect import bisect_right
from dataclasses import replace
from fractions import Fraction
from functools import lru_cache

import numpy as np

from ..errors import InputError
from .passages import POINTS, Panels, Turn, Turning, _rule, clenshaw, inverted, turning_offset
from .relief import TURN, Arrays, Plain
from .repeating_motion import Motion

SMOOTH = 12.0  # kinetic energy in units of a turn's work: beyond it `TERMS` of the sum below end at 1e-17
TERMS = 9
FROM_REST = 64  # turns behind a state that moves ahead, up to which its motion is told from its rest
MOST_TURNS = 2.0**50


@lru_cache(maxsize=1)
def _terms():
    """Coefficients of a^(1/2) x^n, x = a^(-2), in Z(a) - 2 a^(1/2) + a^(-1/2)/2, from n = 1, and of 1/a."""
    bernoulli, out, rising = [Fraction(1)], [], Fraction(1)
    for m in range(1, 2 * TERMS + 1):
        bernoulli.append(-sum(math.comb(m + 1, k) * b for k, b in enumerate(bernoulli)) / (m + 1))
    for m in range(1, 2 * TERMS):
        rising *= Fraction(2 * m - 1, 2) if m > 1 else Fraction(1, 2)
        if m % 2:
            out.append(float(-bernoulli[m + 1] / math.factorial(m + 1) * rising))
    return out


def partial(a):
    """Z(a) for arrays with a >= SMOOTH: Z(a + 1) - Z(a) = a^(-1/2)."""
    x = 1 / a
    x2, least = x * x, float(a.min())
    total = 0.0
    for coefficient in _terms()[_needed(least) - 1::-1]:
        total = total * x2 + coefficient
    return np.sqrt(a) * (2 - 0.5 * x + total * x2)


def _needed(least) -> int:
    """Terms that count at a >= least."""
    return TERMS if least < 100 else 4 if least < 1e4 else 2


class SpinUp(Motion):
    """States of a spin-up. from_rest: told from where it came from rest (any time), else from the state (none before)."""

    period = math.inf

    def __init__(self, relief, points=POINTS, backwards=False):
        self.relief, self.work = relief, relief.turn
        self.round = Turn(relief)
        number, y = self.round.where()
        rest = max(relief.drops, key=lambda drop: drop[0].at - TURN * drop[1])
        self.from_rest = relief.w < 0 or backwards or rest[1] <= FROM_REST
        first = self._rest_passage(*rest) if self.from_rest else (self.round.passing(number, y), number)
        self._run_up(*first, points)
        self.start = self._time_of(number, y) if self.from_rest else 0.0
        self.sense = -1.0 if relief.w < 0 else 1.0
        self.evaluations = self.early.evaluations + self.late.evaluations

    def _rest_passage(self, spot, drop, kinetic):
        """(passage from the turning point, its number)."""
        if drop > MOST_TURNS:
            raise InputError(f"this motion came from rest {drop:.3g} turns ago: more than doubles can count")
        h = self.round.hills.index(spot)
        below = replace(spot, kinetic=kinetic)
        if spot.force:
            a = turning_offset(below, -1, TURN) if kinetic > 0 else 0.0
        else:
            a = turning_offset(below, 1, self.round.sides[h][1])
        return Turning(below, a, 1, self.round.sides[h][1], spot.at - drop * TURN), h - drop * len(self.round.hills)

    def _run_up(self, first, number, points):
        """Panels to the end of the first turn, and those of the turn after, which serve all that follow: they are smoother."""
        count, self.first = len(self.round.hills), number
        self.turn = number // count + 1
        self.early = Panels([first, *map(self.round.passing, range(number + 1, self.turn * count))], points)
        self.late = late = Panels([self.round.passing(self.turn * count + h) for h in range(count)], points)
        nodes, weights = np.polynomial.legendre.leggauss(points)
        x, owner = late.low[:, None] + late.half[:, None] * (1 + nodes), np.array(late.owner)
        self.weights = (late.half[:, None] * weights).ravel()
        self.a = np.concatenate([p.energy(x[owner == n].ravel(), Arrays) for n, p in enumerate(late.chain)]) / self.work
        self.unit = 1 / math.sqrt(2 * self.work)
        self.steep = max(math.ceil(SMOOTH - float(self.a.min())), 0)
        one_by_one = self.unit / np.sqrt(self.a + np.arange(self.steep)[:, None]) @ self.weights
        self.table = np.concatenate([[0.0], np.cumsum(one_by_one)]).tolist()
        self.passed = float(self.weights @ partial(self.a + self.steep))
        self.level = float(self.weights @ self.a) / TURN

    def _time_of(self, number, y):
        """Time from the start of the chain to offset y of passage `number`."""
        if number < self.turn * len(self.round.hills):
            n = number - self.first
            return self.early.time_at(n, self.early.chain[n].x_of(y, self.relief.w))
        turns, h = divmod(number - self.turn * len(self.round.hills), len(self.round.hills))
        integral, rate = self._panels(self._rates(turns))
        mine = [n for n, owner in enumerate(self.late.owner) if owner == h]
        n = mine[max(bisect_right(self.late.low[mine].tolist(), y) - 1, 0)]
        lengths = self.late.half * integral.sum(axis=1)
        xi = (y - self.late.low[n]) / self.late.half[n] - 1
        within = lengths[:n].sum() + self.late.half[n] * clenshaw(integral[n].tolist(), xi)
        return self.early.total + self._turns_take(turns) + float(within)

    # --- many turns on
    def _turns_take(self, turns):
        if turns <= self.steep:
            return self.table[turns]
        return self.table[-1] + self.unit * (float(self.weights @ partial(self.a + turns)) - self.passed)

    def _rates(self, turns):
        """dt/dx at the nodes (panels, points)."""
        return (self.unit / np.sqrt(self.a + turns)).reshape(-1, self.late.points)

    def _panels(self, rates):
        _, forward, integral = _rule(self.late.points)
        return rates @ integral.T, rates @ forward.T

    def _turns(self, left) -> int:
        """About how many turns are done in a time."""
        if left < self.table[-1]:
            return bisect_right(self.table, left) - 1
        root = ((left - self.table[-1]) / self.unit + self.passed) / (2 * TURN)
        return max(math.floor(root * root + 0.5 - self.level), self.steep)

    def _late(self, left):
        """(spot, offset, W, way to the spot) at a time after the run-up."""
        turns, moved = self._turns(left), 0
        while True:
            within = left - self._turns_take(turns) if turns else left
            rates = self._rates(turns)
            ends = np.cumsum(rates.ravel() * self.weights)[self.late.points - 1::self.late.points].tolist()
            if within < 0 and turns and moved <= 0:
                turns, moved = turns - 1, -1
            elif within >= ends[-1] and moved >= 0:
                turns, moved = turns + 1, 1
            else:
                break
        within = min(max(within, 0.0), ends[-1])
        n = min(bisect_right(ends, within), len(ends) - 1)
        _, forward, integral = _rule(self.late.points)
        half = float(self.late.half[n])
        within -= ends[n - 1] if n else 0.0
        xi = inverted((integral @ rates[n]).tolist(), (forward @ rates[n]).tolist(), half, within, Plain)
        passage = self.late.chain[self.late.owner[n]]
        y = float(self.late.low[n]) + half * (1 + xi)
        energy = passage.energy(y, Plain) + turns * self.work
        return passage.spot, y, math.sqrt(2 * energy), passage.at_zero + TURN * turns

    def at(self, t):
        time = self.start + self.sense * t
        sign = self.sense if time >= 0 else -self.sense
        spot, y, w = (self.early.at(abs(time)) if abs(time) < self.early.total
                      else self._late(abs(time) - self.early.total)[:3])
        return spot.state(y, w * sign, Plain)

    def follow(self, times):
        passed = self.start + self.sense * times
        signs, passed = np.where(passed >= 0, self.sense, -self.sense), np.abs(passed)
        soon, out, way = passed < self.early.total, np.empty((len(times), 3)), np.empty(len(times))
        if soon.any():
            out[soon], way[soon] = self.early.follow(passed[soon], signs[soon])
        for row in np.nonzero(~soon)[0]:
            spot, y, w, at_zero = self._late(float(passed[row]) - self.early.total)
            out[row], way[row] = spot.state(y, w * signs[row], Plain), at_zero + y
        return out, way
