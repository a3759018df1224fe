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
from functools import cached_property, lru_cache

import numpy as np

from ...errors import InputError
from .panels import POINTS, Panels, Passing, Turn, Turning, clenshaw, inverted, rule, turning_offset
from .periodic import Motion
from .profile import TURN, Arrays, Plain

SMOOTH = 12.0  # kinetic energy in units of a turn's work: beyond it `TERMS` of the sum below end at 1e-17
TERMS = 9
FROM_REST = 64  # turns behind a state that moves ahead, up to which its motion is told from its rest
MOST_TURNS = 2.0**50
CHUNK = 256
FLAT, FEW = 4.0, 20  # kinetic energies of a turn that differ by less than 2 FLAT turns' work: FEW points are right to 1e-17
BEFORE = "this motion is told from its state on: ask reduced_motion for it with backwards=True"


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
        self.w, self.work, self.round = relief.w, relief.turn, Turn(relief)
        number, y = self.round.where()
        rest = max(relief.drops, key=lambda drop: drop[0].at - TURN * drop[1])
        self.from_rest = relief.w < 0 or backwards or rest[1] <= FROM_REST
        first, self.first = self._rest_passage(*rest) if self.from_rest else (self.round.passing(number, y), number)
        count = len(self.round.hills)
        self.turn = self.first // count + 1
        self.early = Panels([first, *map(self.round.passing, range(self.first + 1, self.turn * count))], points)
        self.run_up = self.early.total
        self._whole_turn([self.round.passing(self.turn * count + h) for h in range(count)], points)
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

    def _whole_turn(self, chain, points):
        """Panels of the first whole turn: they serve all that follow, which are smoother."""
        self.late = late = Panels(chain, points)
        self.weights = (late.half[:, None] * rule(points)[1]).ravel()
        self.unit = 1 / math.sqrt(2 * self.work)
        self.a = (self.unit / late.values.ravel()) ** 2
        self.steep = max(math.ceil(SMOOTH - float(self.a.min())), 0)
        one_by_one = self.unit / np.sqrt(self.a + np.arange(self.steep)[:, None]) @ self.weights
        self.table = np.concatenate([[0.0], np.cumsum(one_by_one)]).tolist()
        self.passed = float(self.weights @ partial(self.a + self.steep))
        self.level = float(self.weights @ self.a) / TURN

    def _time_of(self, number, y):
        """Time from the start of the chain to offset y of passage `number`."""
        if number < self.turn * len(self.round.hills):
            n = number - self.first
            return self.early.time_at(n, self.early.chain[n].x_of(y, self.w))
        turns, h = divmod(number - self.turn * len(self.round.hills), len(self.round.hills))
        integral = self._rates(turns) @ rule(self.late.points)[3]
        mine = [n for n, owner in enumerate(self.late.owner) if owner == h]
        n = mine[max(bisect_right(self.late.low[mine].tolist(), y) - 1, 0)]
        lengths = self.late.half * integral.sum(axis=1)
        xi = (y - self.late.low[n]) / self.late.half[n] - 1
        within = lengths[:n].sum() + self.late.half[n] * clenshaw(integral[n].tolist(), xi)
        return self.run_up + self._turns_take(turns) + float(within)

    @classmethod
    def from_here(cls, spot, w, work, points=POINTS):
        """The spin-up of a state with rate w > 0 that no hill slows down much, told from the state on, its `spot`."""
        motion = cls.__new__(cls)
        motion.w, motion.work, motion.from_rest, motion.sense = w, work, False, 1.0
        motion.early, motion.run_up, motion.start = None, 0.0, 0.0
        motion._whole_turn([Passing(spot, spot.kinetic, 0.0, TURN)], points)
        motion.evaluations = motion.late.evaluations
        return motion

    # --- many turns on
    def _turns_take(self, turns):
        if turns <= self.steep:
            return self.table[turns]
        return self.table[-1] + self.unit * (float(self.weights @ partial(self.a + turns)) - self.passed)

    def _rates(self, turns):
        """dt/dx at the nodes (panels, points)."""
        return (self.unit / np.sqrt(self.a + turns)).reshape(-1, self.late.points)

    def _turns(self, left) -> int:
        """About how many turns are done in a time."""
        if left < self.table[-1]:
            return bisect_right(self.table, left) - 1
        root = ((left - self.table[-1]) / self.unit + self.passed) / (2 * TURN)
        return max(math.floor(root * root + 0.5 - self.level), self.steep)

    def _since(self, turns, left):
        """(time since so many turns were done, dt/dx at the nodes of the turn after, times at its panels' ends)."""
        rates = self._rates(turns)
        ends = np.cumsum(rates.ravel() * self.weights)[self.late.points - 1::self.late.points].tolist()
        return left - self._turns_take(turns) if turns else left, rates, ends

    def _late(self, left):
        """(spot, offset, W) at a time after the run-up."""
        turns = self._turns(left)
        within, rates, ends = self._since(turns, left)
        if within < 0 or within >= ends[-1]:
            turns = float(self._settled(np.array([left]), np.array([float(turns)]))[0])
            within, rates, ends = self._since(turns, left)
        within = min(max(within, 0.0), ends[-1])
        n = min(bisect_right(ends, within), len(ends) - 1)
        _, _, forward, integral = rule(self.late.points)
        half = float(self.late.half[n])
        within -= ends[n - 1] if n else 0.0
        xi = inverted((rates[n] @ integral).tolist(), (rates[n] @ forward).tolist(), half, within, Plain)
        passage = self.late.chain[self.late.owner[n]]
        y = float(self.late.low[n]) + half * (1 + xi)
        energy = passage.energy(y, Plain) + turns * self.work
        return passage.spot, y, math.sqrt(2 * energy)

    def at(self, t):
        time = self.start + self.sense * t
        sign = self.sense if time >= 0 else -self.sense
        if time < 0 and not self.from_rest:
            raise InputError(BEFORE)
        spot, y, w = (self.early.at(abs(time)) if self.early and abs(time) < self.early.total
                      else self._late(abs(time) - self.run_up))
        return spot.state(y, w * sign, Plain)

    def follow(self, times):
        passed = self.start + self.sense * times
        signs, passed = np.where(passed >= 0, self.sense, -self.sense), np.abs(passed)
        if not self.from_rest and (times < 0).any():
            raise InputError(BEFORE)
        soon, out, way = passed < self.run_up, np.empty((len(times), 3)), np.empty(len(times))
        if soon.any():
            out[soon], way[soon] = self.early.follow(passed[soon], signs[soon])
        rows = np.nonzero(~soon)[0]
        for first in range(0, len(rows), CHUNK):
            part = rows[first:first + CHUNK]
            out[part], way[part] = self._follow_late(passed[part] - self.run_up, signs[part])
        return out, way

    def _follow_late(self, left, signs):
        """(states (n, 3) at times after the run-up, offsets of their places (n,))."""
        late, points = self.late, self.late.points
        turns, rates, ends, within = self._whole_turns(left)
        rows = np.arange(len(left))
        n = np.minimum((ends <= within[:, None]).sum(axis=1), ends.shape[1] - 1)
        within = within - np.where(n > 0, ends[rows, n - 1], 0.0)
        mine, (_, _, forward, integral) = rates.reshape(len(left), -1, points)[rows, n], rule(points)
        half = late.half[n]
        xi = inverted((mine @ integral).T, (mine @ forward).T, half, within, Arrays)
        x, owner = late.low[n] + half * (1 + xi), np.array(late.owner)[n]
        out, way = np.empty((len(left), 3)), np.empty(len(left))
        for number, passage in enumerate(late.chain):
            here = owner == number
            if here.any():
                w = np.sqrt(2 * (passage.energy(x[here], Arrays) + turns[here] * self.work))
                out[here] = np.array(passage.spot.state(x[here], w * signs[here], Arrays)).T
                way[here] = passage.at_zero + x[here] + TURN * turns[here]
        return out, way

    def _whole_turns(self, left):
        """(turns done at each time, dt/dx at the nodes of the turn after, times at its panels' ends, time within it)."""
        turns = self._settled(left, np.array([self._turns(t) for t in left.tolist()], float))
        rates = self.unit / np.sqrt(self.a + turns[:, None])
        ends = np.cumsum((rates * self.weights).reshape(len(left), -1, self.late.points).sum(axis=2), axis=1)
        return turns, rates, ends, np.clip(left - self._many_turns_take(turns), 0.0, ends[:, -1])

    def _settled(self, left, turns):
        """The turns done at times (n,), from about so many: by steps that double, then by halves. Where a turn's work is small
        against the hills the guess may be far off."""
        low, high, step, rows = turns, turns + 1, 1.0, np.arange(len(left))
        while len(rows := rows[(left[rows] < self._many_turns_take(low[rows])) & (low[rows] > 0)]):
            high[rows], low[rows], step = low[rows], np.maximum(low[rows] - step, 0.0), 2 * step
        step, rows = 1.0, np.arange(len(left))
        while len(rows := rows[left[rows] >= self._many_turns_take(high[rows])]):
            low[rows], high[rows], step = high[rows], high[rows] + step, 2 * step
        middle = np.floor(0.5 * (low + high))
        while len(rows := np.nonzero((low < middle) & (middle < high))[0]):  # beyond 2^53 turns neighbours are not told apart
            past = left[rows] >= self._many_turns_take(middle[rows])
            low[rows], high[rows] = np.where(past, middle[rows], low[rows]), np.where(past, high[rows], middle[rows])
            middle = np.floor(0.5 * (low + high))
        return low

    def _many_turns_take(self, turns):
        """Times of whole turns (n,)."""
        done = np.array(self.table)[np.minimum(turns, self.steep).astype(int)]
        many = turns > self.steep
        if many.any():
            a, weights = self._few
            done[many] += self.unit * (partial(a + turns[many][:, None]) @ weights - self.passed)
        return done

    @cached_property
    def _few(self):
        """(nodes, weights) of the mean over a turn, as few as functions take that are analytic from a = -`SMOOTH` on."""
        middle, reach = 0.5 * (self.a.max() + self.a.min()), 0.5 * (self.a.max() - self.a.min())
        if not 0 < reach < FLAT:
            return self.a, self.weights
        cheb = np.polynomial.chebyshev
        nodes = cheb.chebpts1(FEW)
        moments = self.weights @ cheb.chebvander((self.a - middle) / reach, FEW - 1)
        weights = moments @ (cheb.chebvander(nodes, FEW - 1).T * np.where(np.arange(FEW), 2 / FEW, 1 / FEW)[:, None])
        return middle + reach * nodes, weights * (math.fsum(self.weights) / math.fsum(weights))  # their sum to the last digit
