"""Motions that spin up about the axis of a torque, at any time: their turns are summed in closed form.

Each turn of the circle adds the same work, so at one place the kinetic energies of successive turns are C (a
+ n) with C = 2 pi mu, and the time n turns take is an integral over one turn of sums of (a + n)^(-1/2). By
Euler and Maclaurin

    sum of (a + n)^(-1/2), n = 0 ... N - 1,  = Z(a + N) - Z(a),   Z(a) = 2 sqrt(a) - a^(-1/2)/2 - a^(-3/2)/24
    + ...,

to the last digit once a >= 12, whatever the height of the hills; the dozen turns before that are summed one
by one. The turn in which the motion comes from rest, or the state lies, is cut into panels of its own
(`Panels`).

Time along a motion in one degree of freedom goes from passage to passage, panel by panel.

A motion is a chain of passages, each in a coordinate in which dt/dx is smooth: the offset from a hill that it
passes, or the root of the way from the point where it turns. A passage is cut into panels until Gauss's rule
sees the end of its own series on each; next to a separatrix the panels shrink towards the hill, some forty of
them for a distance of 1e-12."""
from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from functools import cached_property, lru_cache

import numpy as np

from ..errors import InputError
from ..numbers.polynomial import held_newton
from .profile import EPS, TOO_FINE, TURN, Motion, OnCircle, Relief, Spot

NODES = 16
FIXED, MOST_PARTS = TURN / 8, 64  # longest panel of an angle; most of one way before any is cut
SETTLED = 4e-15  # last coefficients against the first: some ten times what rounding leaves of them mostly
ROUNDED = 1e-12  # the most that rounding may leave of them
DEEPEST = 80  # halvings of a passage; 1e-12 from a separatrix takes 20
CROWD = 200  # panels of one size that are still cut: then it is rounding that keeps them from settling
NEWTON = 12
# of -1 to 1: nearer to the beginning of the first panel its series loses more than a digit of the way from
# there
EARLY = -0.9


class Passing:
    """Over a spot with kinetic energy `kinetic` there; x is the offset from it, from lo to hi; at: that
    of the spot from the state."""

    def __init__(self, spot: OnCircle, kinetic: float, lo: float, hi: float, at: float | None = None):
        self.spot, self.kinetic, self.at_zero = spot, kinetic, spot.at if at is None else at
        # about the spot panels shrink, and keep their digits
        self.cuts = (lo, 0.0, hi) if lo < 0 < hi else (lo, hi)

    def energy(self, x: np.ndarray):
        return self.kinetic + x * self.spot.share(0.0, x)

    def rate(self, x: np.ndarray):
        """dt/dx."""
        return 1 / np.sqrt(2 * self.energy(x))

    def at(self, x: np.ndarray):
        """(offset, W)."""
        return x, np.sqrt(2 * self.energy(x))

    def x_of(self, y: float, w: float):
        return y


class Turning:
    """From (sense 1) or to (sense -1) the turning point at offset a of a spot: offset a + sense x^2, to
    `far`; at: as of `Passing`."""

    def __init__(self, spot: Spot, a: float, sense: int, far: float, at: float | None = None):
        self.spot, self.a, self.sense, self.at_zero = spot, a, sense, spot.at if at is None else at
        reach = math.sqrt(max(sense * (far - a), 0.0))
        self.cuts = (0.0, reach) if sense > 0 else (-reach, 0.0)

    def _share(self, x):
        return 2 * self.sense * self.spot.share(self.a, self.sense * x * x)

    def rate(self, x: np.ndarray):
        return 2 / np.sqrt(self._share(x))

    def at(self, x: np.ndarray):
        return self.a + self.sense * x * x, np.abs(x) * np.sqrt(self._share(x))

    def x_of(self, y: float, w: float):
        """From the rate, which keeps its digits next to the turning point."""
        fraction = self._share(math.sqrt(max(self.sense * (y - self.a), 0.0)))
        return self.sense * abs(w) / math.sqrt(fraction)


class Turn:
    """The passages of one turn of a circle, each over a hill from well to well (on a circle without hills,
    one from the state round to itself). Passage m * hills + h is over hill h of turn m, the turn ahead of the
    state being 0."""

    def __init__(self, relief: Relief):
        self.relief, half = relief, len(relief.spots) // 2
        self.hills = [s for s in relief.spots[half:] if s.kind > 0] or [relief.here]
        self.behind = [s.at for s in relief.spots[:half] if s.kind > 0] or [-TURN]
        wells = [s.at for s in relief.spots[half:] if s.kind < 0]
        wells = [w + n * TURN for n in (-1, 0, 1) for w in wells]
        self.sides = [(hill.at - max(w for w in wells if w < hill.at),
                       min(w for w in wells if w > hill.at) - hill.at)
                      if wells else (0.0, TURN) for hill in self.hills]

    def where(self):
        """(number of the passage that the state is in, offset of the state there)."""
        count = len(self.hills)
        rows = [(m * count + h, -at) for m, row in ((0, [hill.at for hill in self.hills]), (-1, self.behind))
                 for h, at in enumerate(row)]
        outside = [max(-y - self.sides[n % count][0], y - self.sides[n % count][1]) for n, y in rows]
        return rows[outside.index(min(outside))]

    def passing(self, number, lo=None) -> Passing:
        """Passage `number`, from offset lo on or from its beginning."""
        turn, h = divmod(number, len(self.hills))
        behind, ahead = self.sides[h]
        return Passing(self.hills[h], self.hills[h].kinetic + turn * self.relief.turn,
                       -behind if lo is None else lo, ahead,
                       self.hills[h].at + turn * TURN)


def turning_offset(point: Spot, sense: int, reach: float | None = None) -> float | None:
    """Offset from the spot, on the side `sense`, at which W = 0; reach: no further than that (None: search
    outwards).

    The spot is a well with kinetic energy, or a hill without enough. None where the motion does not turn.
    """
    rising = point.kinetic < 0

    def beyond(t: float):
        with np.errstate(all="ignore"):
            value = float(point.energy(sense * t))
        value = -math.inf if math.isnan(value) or value == math.inf else value
        return value, (value > 0) == rising

    if reach is None:
        reach = 1.0
        while not beyond(reach)[1]:
            reach *= 2
            if reach > 1e160 or (type(point).__name__ == "OnHyperbola" and reach > 2000):
                return None

    def look(t):
        value, past = beyond(t)
        return value, float(sense * point.share(sense * t, 0.0)) if math.isfinite(value) else 0.0, past
    start = min(math.sqrt(2 * abs(point.kinetic) / (abs(point.bend) or 1.0)), 0.5 * reach)
    return sense * held_newton(look, 0.0, reach, 1.0, EPS, start)


@lru_cache(maxsize=32)
def rule(points: int):
    """(nodes and weights of Gauss, matrix to the Chebyshev coefficients of the integrand, matrix to those of
    its integral from
    -1); both matrices act on rows from the right."""
    cheb = np.polynomial.chebyshev
    nodes, weights = np.polynomial.legendre.leggauss(points)
    forward = np.linalg.inv(cheb.chebvander(nodes, points - 1))
    return nodes, weights, forward.T.copy(), cheb.chebint(forward, lbnd=-1).T.copy()


def _edges(cuts: Sequence[float]):
    """The cuts and what divides the ways between them into parts no longer than `FIXED`, or `MOST_PARTS`: the
    coordinate of a parabola is no angle, and may run over any length."""
    parts = [np.linspace(a, b, min(math.ceil((b - a) / FIXED), MOST_PARTS) + 1)[:-1]
             for a, b in zip(cuts, cuts[1:])]
    return np.concatenate([*parts, cuts[-1:]])


def clenshaw(c, x):
    """Sum of c[k] T_k(x): floats, or rows of arrays."""
    item = two = 0.0
    double = 2 * x
    for coefficient in c[:0:-1]:
        item, two = double * item - two + coefficient, item
    return x * item - two + c[0]


def inverted(integral: np.ndarray, rate: np.ndarray, half: np.ndarray, wanted: np.ndarray):
    """xi in [-1, 1] at which half * (the integral's series) = wanted; coefficients as of `clenshaw`."""
    xi = 2 * wanted / (half * sum(integral)) - 1
    for _ in range(NEWTON):
        step = (half * clenshaw(integral, xi) - wanted) / (half * clenshaw(rate, xi))
        new = np.clip(xi - step, -1, 1)
        moved = np.abs(new - xi).max(initial=0.0)
        xi = new
        if moved <= 1e-8:  # the next step would square that
            return xi
    return xi


class Panels:
    """Time from the start of a chain of passages; with fewer than `NODES` points a panel none is cut
    further.

    evaluations: of dt/dx; starts: times at the panels' beginnings; owner: the passage of each; low, half:
    their ends and half lengths; values (n, points): dt/dx at the nodes; rates, integrals: Chebyshev
    coefficients of dt/dx and of t."""

    def __init__(self, chain: Sequence[Passing | Turning], points: int = NODES):
        self.chain, self.points, self.evaluations = chain, points, 0
        rows = [self._cut(passage, points >= NODES) for passage in chain]
        self.owner = [n for n, part in enumerate(rows) for _ in part[0]]
        columns = rows[0] if len(rows) == 1 else [np.concatenate(column) for column in zip(*rows)]
        self.low, self.half, self.values, self.rates = columns
        if not len(self.low):
            raise InputError(TOO_FINE)
        self.integrals = self.values @ rule(points)[3]
        ends = np.cumsum(self.half * self.integrals.sum(axis=1))
        self.total = float(ends[-1])
        self.starts = np.concatenate([[0.0], ends[:-1]])

    def _cut(self, passage, adaptive):
        """(low ends, half lengths, dt/dx (n, points), its coefficients (n, points)) of a passage's panels, in
        order."""
        nodes, _, forward, _ = rule(self.points)
        edges = _edges(passage.cuts)
        low, high, done, before = edges[:-1], edges[1:], [], np.inf
        for depth in range(DEEPEST + 1):
            half, middle = 0.5 * (high - low), 0.5 * (low + high)
            x = middle[:, None] + half[:, None] * nodes
            with np.errstate(all="ignore"):
                values = passage.rate(x.ravel()).reshape(x.shape)
            self.evaluations += x.size
            if not np.isfinite(values).all():
                raise InputError(TOO_FINE)
            rate = values @ forward
            last = np.abs(rate[:, -2:]).max(axis=1) / np.abs(rate[:, 0]) if adaptive else np.zeros(len(low))
            # what no half has less of than the whole is rounding
            good = (last <= SETTLED) | (last > 0.5 * before) & (last <= ROUNDED)
            if good.all():
                done.append((low, half, values, rate))
                break
            if depth == DEEPEST or len(low) > CROWD:
                raise InputError("the reduced form of this motion takes more panels than it is set up for")
            done.append((low[good], half[good], values[good], rate[good]))
            low, middle, high, before = low[~good], middle[~good], high[~good], np.tile(last[~good], 2)
            low, high = np.concatenate([low, middle]), np.concatenate([middle, high])
        if len(done) == 1:
            return done[0]
        columns = [np.concatenate(column) for column in zip(*done)]
        order = np.argsort(columns[0])
        return [column[order] for column in columns]

    def time_at(self, number: int, x: float) -> float:
        """Time at coordinate x of passage `number`."""
        mine = [n for n, owner in enumerate(self.owner) if owner == number]
        n = mine[max(bisect_right(self.low[mine].tolist(), x) - 1, 0)]
        x = min(max(x, self.low[n]), self.low[n] + 2 * self.half[n])
        return float(self.starts[n] + self._integral(self.chain[number], self.low[n], np.array([x]))[0])

    def _integral(self, passage: Passing | Turning, low: float, x: np.ndarray):
        """Times from coordinate low to x (n,), right to their last digits however short."""
        nodes, weights, *_ = rule(self.points)
        half = 0.5 * (x - low)
        self.evaluations += x.size * len(nodes)
        return (half
                * (passage.rate((low + half[:, None] * (1 + nodes)).ravel()).reshape(len(x), -1) @ weights))

    def _sharpened(self, x: np.ndarray, time: np.ndarray):
        """Coordinates x (n,) of the first panel, rounded with the panel's own size, as times (n,) since its
        beginning demand."""
        passage, low = self.chain[0], self.low[0]
        return np.maximum(x + (time - self._integral(passage, low, x)) / passage.rate(x), low)

    def follow(self, times: np.ndarray, signs: np.ndarray):
        """(states (n, 3) at times in [0, total], W times the signs; offsets of their places (n,))."""
        n = np.maximum(np.searchsorted(self.starts, times, side="right") - 1, 0)
        half, out, offsets = self.half[n], np.empty((len(times), 3)), np.empty(len(times))
        xi = inverted(self.integrals[n].T, self.rates[n].T, half, times - self.starts[n])
        x, owner = self.low[n] + half * (1 + xi), np.array(self.owner)[n]
        early = np.nonzero((n == 0) & (xi < EARLY))[0]
        if len(early):
            x[early] = self._sharpened(x[early], times[early])
        for number, passage in enumerate(self.chain):
            mine = owner == number
            if mine.any():
                y, w = passage.at(x[mine])
                out[mine] = np.array(passage.spot.state(y, w * signs[mine])).T
                offsets[mine] = passage.at_zero + y
        return out, offsets


SMOOTH = 12.0  # kinetic energy in units of a turn's work: beyond it `TERMS` of the sum below end at 1e-17
TERMS = 9
FROM_REST = 64  # turns behind a state that moves ahead, up to which its motion starts from its rest
MOST_TURNS = 2.0**50
CHUNK = 256
# kinetic energies of a turn that differ by less than 2 FLAT turns' work: FEW points are right to 1e-17
FLAT, FEW = 4.0, 20
BEFORE = "this motion is given from its state on: call reduced_motion with backwards=True"


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


def partial(a: np.ndarray):
    """Z(a) for arrays with a >= SMOOTH: Z(a + 1) - Z(a) = a^(-1/2)."""
    x = 1 / a
    x2, total = x * x, 0.0
    for coefficient in _terms()[::-1]:
        total = total * x2 + coefficient
    return np.sqrt(a) * (2 - 0.5 * x + total * x2)


class SpinUp(Motion):
    """States of a spin-up. from_rest: reckoned from where it came from rest (any time), else from the state
    (none before)."""

    period = math.inf

    def __init__(self, relief: Relief, points: int = NODES, backwards: bool = False):
        self.w, self.work, self.round = relief.w, relief.turn, Turn(relief)
        number, y = self.round.where()
        rest = max(relief.drops, key=lambda drop: drop[0].at - TURN * drop[1])
        self.from_rest = relief.w < 0 or backwards or rest[1] <= FROM_REST
        first, self.first = (self._rest_passage(*rest) if self.from_rest
                             else (self.round.passing(number, y), number))
        count = len(self.round.hills)
        self.turn = self.first // count + 1
        self.early = Panels([first, *map(self.round.passing, range(self.first + 1, self.turn * count))],
                            points)
        self.run_up = self.early.total
        self._whole_turn([self.round.passing(self.turn * count + h) for h in range(count)], points)
        self.start = self._time_of(number, y) if self.from_rest else 0.0
        self.sense = -1.0 if relief.w < 0 else 1.0
        self.evaluations = self.early.evaluations + self.late.evaluations

    def _rest_passage(self, point: OnCircle, drop: int, kinetic: float):
        """(passage from the turning point, its number)."""
        if drop > MOST_TURNS:
            raise InputError(f"this motion came from rest {drop:.3g} turns ago: more than doubles can count")
        h = self.round.hills.index(point)
        below = replace(point, kinetic=kinetic)
        if point.force:
            a = turning_offset(below, -1, TURN) if kinetic > 0 else 0.0
        else:
            a = turning_offset(below, 1, self.round.sides[h][1])
        return Turning(below, a, 1, self.round.sides[h][1],
                       point.at - drop * TURN), h - drop * len(self.round.hills)

    def _whole_turn(self, chain: Sequence[Passing], points: int):
        """Panels of the first whole turn: they serve all that follow, which are smoother."""
        self.late = late = Panels(chain, points)
        self.weights = (late.half[:, None] * rule(points)[1]).ravel()
        self.unit = 1 / math.sqrt(2 * self.work)
        self.a = (self.unit / late.values.ravel()) ** 2
        self.steep = max(math.ceil(SMOOTH - float(self.a.min())), 0)
        one_by_one = self.unit / np.sqrt(self.a + np.arange(self.steep)[:, None]) @ self.weights
        self.table = np.concatenate([[0.0], np.cumsum(one_by_one)])
        self.passed = float(self.weights @ partial(self.a + self.steep))
        self.level = float(self.weights @ self.a) / TURN

    def _time_of(self, number: int, y: float):
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
        return self.run_up + float(self._turns_take(np.array([turns]))[0] + within)

    # --- many turns on
    def _rates(self, turns: int):
        """dt/dx at the nodes (panels, points)."""
        return (self.unit / np.sqrt(self.a + turns)).reshape(-1, self.late.points)

    def _turns(self, left: np.ndarray):
        """About how many turns are done in times (n,)."""
        root = ((left - self.table[-1]) / self.unit + self.passed) / (2 * TURN)
        return np.where(left < self.table[-1], np.searchsorted(self.table, left, side="right") - 1,
                        np.maximum(np.floor(root * root + 0.5 - self.level), self.steep)).astype(float)

    def follow(self, times: np.ndarray):
        passed = self.start + self.sense * times
        signs, passed = np.where(passed >= 0, self.sense, -self.sense), np.abs(passed)
        if not self.from_rest and (times < 0).any():
            raise InputError(BEFORE)
        soon, out, route = passed < self.run_up, np.empty((len(times), 3)), np.empty(len(times))
        if soon.any():
            out[soon], route[soon] = self.early.follow(passed[soon], signs[soon])
        rows = np.nonzero(~soon)[0]
        for first in range(0, len(rows), CHUNK):
            part = rows[first:first + CHUNK]
            out[part], route[part] = self._follow_late(passed[part] - self.run_up, signs[part])
        return out, route

    def _follow_late(self, left, signs):
        """(states (n, 3) at times after the run-up, offsets of their places (n,))."""
        late, points = self.late, self.late.points
        turns, rates, ends, within = self._whole_turns(left)
        rows = np.arange(len(left))
        n = np.minimum((ends <= within[:, None]).sum(axis=1), ends.shape[1] - 1)
        within = within - np.where(n > 0, ends[rows, n - 1], 0.0)
        mine, (_, _, forward, integral) = rates.reshape(len(left), -1, points)[rows, n], rule(points)
        half = late.half[n]
        xi = inverted((mine @ integral).T, (mine @ forward).T, half, within)
        x, owner = late.low[n] + half * (1 + xi), np.array(late.owner)[n]
        out, route = np.empty((len(left), 3)), np.empty(len(left))
        for number, passage in enumerate(late.chain):
            here = owner == number
            if here.any():
                w = np.sqrt(2 * (passage.energy(x[here]) + turns[here] * self.work))
                out[here] = np.array(passage.spot.state(x[here], w * signs[here])).T
                route[here] = passage.at_zero + x[here] + TURN * turns[here]
        return out, route

    def _whole_turns(self, left: np.ndarray):
        """(turns done at each time, dt/dx at the nodes of the turn after, times at its panels' ends, time
        within it)."""
        turns = self._settled(left, self._turns(left))
        rates = self.unit / np.sqrt(self.a + turns[:, None])
        ends = np.cumsum((rates * self.weights).reshape(len(left), -1, self.late.points).sum(axis=2), axis=1)
        return turns, rates, ends, np.clip(left - self._turns_take(turns), 0.0, ends[:, -1])

    def _settled(self, left: np.ndarray, turns: np.ndarray):
        """The turns done at times (n,), from about so many: by steps that double, then by halves. Where a
        turn's work is small against the hills the guess may be far off."""
        low, high, step, rows = turns, turns + 1, 1.0, np.arange(len(left))
        while len(rows := rows[(left[rows] < self._turns_take(low[rows])) & (low[rows] > 0)]):
            high[rows], low[rows], step = low[rows], np.maximum(low[rows] - step, 0.0), 2 * step
        step, rows = 1.0, np.arange(len(left))
        while len(rows := rows[left[rows] >= self._turns_take(high[rows])]):
            low[rows], high[rows], step = high[rows], high[rows] + step, 2 * step
        middle = np.floor(0.5 * (low + high))
        # beyond 2^53 turns neighbours cannot be distinguished
        while len(rows := np.nonzero((low < middle) & (middle < high))[0]):
            past = left[rows] >= self._turns_take(middle[rows])
            low[rows], high[rows] = np.where(past, middle[rows],
                                             low[rows]), np.where(past, high[rows], middle[rows])
            middle = np.floor(0.5 * (low + high))
        return low

    def _turns_take(self, turns: np.ndarray):
        """Times of whole turns (n,)."""
        done = self.table[np.minimum(turns, self.steep).astype(int)]
        many = turns > self.steep
        if many.any():
            a, weights = self._few
            done[many] += self.unit * (partial(a + turns[many][:, None]) @ weights - self.passed)
        return done

    @cached_property
    def _few(self):
        """(nodes, weights) of the mean over a turn, as few as functions take that are analytic from a =
        -`SMOOTH` on."""
        middle, reach = 0.5 * (self.a.max() + self.a.min()), 0.5 * (self.a.max() - self.a.min())
        if not 0 < reach < FLAT:
            return self.a, self.weights
        cheb = np.polynomial.chebyshev
        nodes = cheb.chebpts1(FEW)
        moments = self.weights @ cheb.chebvander((self.a - middle) / reach, FEW - 1)
        weights = (moments @ (cheb.chebvander(nodes, FEW - 1).T
                              * np.where(np.arange(FEW), 2 / FEW, 1 / FEW)[:, None]))
        # their sum to the last digit
        return middle + reach * nodes, weights * (math.fsum(self.weights) / math.fsum(weights))
