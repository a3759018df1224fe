"""Many motions of one scene followed together, how much a small change of each has grown, and their drift
over many revolutions at once.

They are followed by Taylor steps (`steps`).

A change along a motion is a mere delay. It alters nothing in what the motion comes to, but it grows (the
faster of two turns round ever farther ahead), and a large delay would be taken for a change across. So the
two are separated: what lies across the motion is followed from advance to advance, and gives the growth; the
delay is a blur of the time. Where a motion hardly moves, all is across. Over steps the change obeys the
linear equation beside the motion; over a window of many revolutions (`drift`) a twin runs from close by.

Where it is less work than step by step, motions are carried on over many revolutions at once, by powers of
a map that is near the identity.

A motion that goes round much faster than it drifts returns to a plane across it near to where it left: x(n +
1) = x(n) + d(x(n)), d small. As long as no resonance is felt (what it would make falls faster than any power
of d) x(n) lies on a smooth curve, and so does d along it. On a window of N revolutions d is taken to be the
polynomial in n/N through its values at the `NODES` + 1 Chebyshev points, and x(n) its sum, which the formula
of Euler and Maclaurin gives exactly for polynomials:

    x(n) = x(0) + sum_(i<n) d(i) = x(0) + int_0^n d - [d]/2 + [d']/12 - [d''']/720 + ...   ([f] = f(n) -
    f(0)),

so that x at the nodes is a matrix times d at the nodes. The two are solved for each other by turns, which
contracts like the drift over the window over the number of the turn. The time is summed with the place. What
the polynomial leaves out of d is held below the rounding of one revolution's steps: by its last coefficients,
and by d itself at a place between two nodes.

The map is the return to a section, the surface on which n . omega' = 0: where the motion is at its farthest
against the unit vector n. A drift of the whole path in space shifts it by its speed over that of going round
only, so that small circles that drift far stay on it."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from math import factorial
from typing import TYPE_CHECKING, Any

import numpy as np

from . import steps as kernel
from .certificate import ADVANCE

if TYPE_CHECKING:
    from ...physics.scene import AnyScene

# --- Motions and a small change of each, step by step
STEP_ERROR = 2.0**-52  # units of rounding by which a step may move a motion: a Taylor polynomial of 20 terms
REVOLUTION = 40  # steps that a return takes, about
NEXT, LAST = np.array([1, 2, 0]), np.array([2, 0, 1])  # of three components
NO_GROWTH = 2.0**-6    # changes beyond this share of the size, or delays of so many radians, tell no growth


def work(lanes: int) -> tuple[np.ndarray, np.ndarray]:
    """What `steps.run` works in, for so many lanes; from the start of a line of the processor's memory on."""
    size = kernel.EQUATIONS * lanes + 12
    memory = np.zeros(size + 8)
    start = -memory.ctypes.data // 8 % 8
    return memory[start:start + size], np.zeros(lanes, np.int64)


def inner(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """(m,) scalar products of rows (m, 3): a sum along the rows of few takes longer than all the rest."""
    x, y, z = (a * b).T
    return x + y + z


def largest(rows: np.ndarray) -> np.ndarray:
    """(m,) the largest size in each of rows (m, 3)."""
    x, y, z = np.abs(rows).T
    return np.maximum(np.maximum(x, y), z)


class Runs:
    """States (n, 3) and times (n,) of motions that `advance` carries on; rows that cannot go on are not
    finite any more.

    The rows advance by steps, not to common times: no step is cut short, and no row depends on another. steps
    (n,): computed; rounded (n,): those that running all the way would have taken, each of which rounds. fast:
    compiled steps. counted: steps of all rows, computed here or on the way to a return.
    """

    def __init__(self, scene: AnyScene, states: np.ndarray, fast: bool = False):
        self.coefficients = np.array([np.array(row, float) for row in scene.quadratic().coefficients])
        self.states, self.times, self.fast = np.array(states, float), np.zeros(len(states)), fast
        self.twins = Twins(len(states), self.rates)
        self.steps_done, self.counted = 0, 0  # of a row that never leapt; of all
        self._work: dict[bool, tuple] = {}
        # computed, and passed, of each row
        self.steps, self.rounded = np.zeros(len(states), int), np.zeros(len(states))
        self.met = np.repeat([[0.0], [np.inf]], len(states), axis=1)  # sizes since the last look

    def _call(self, name: str, *arguments):
        function = ADVANCE.functions(self.fast)[name]
        if self.fast:  # compiled code warns of nothing
            function(*arguments)
            return
        with np.errstate(all="ignore"):
            function(*arguments)

    @property
    def _memory(self) -> tuple:
        """What `steps.run` works in."""
        if self.fast not in self._work:
            made = work(kernel.SIDE_BY_SIDE if self.fast else 1)
            # plain Python reads plain numbers out of memory twice as fast
            self._work[self.fast] = made if self.fast else tuple(
                memoryview(array) for array in made)  # type: ignore[arg-type]  # read and written alike
        return self._work[self.fast]

    def advance(self, rows: np.ndarray, steps: int, t_max: float, pause: float = 0.0,
                budget: int = 2**62):
        """Carry the given rows (indices) on by so many steps, or to t_max; a row that has not passed the time
        `pause` stops there, and none takes more than `budget` steps in all."""
        self.steps_done += steps
        self.counted += steps * len(rows)
        twins, m = self.twins, len(rows)
        self._call("advance", self.coefficients, rows, steps, t_max, pause, budget, STEP_ERROR, self.states,
                   self.times, twins.ahead, twins.growth, twins.most, twins.blur, self.met, self.steps,
                   self.rounded, np.empty((2, m, 3)), np.empty((3, m)), np.empty((2, m)),
                   np.empty((2, m), np.int64), np.empty((3, 3)), *self._memory)

    def carried(self, states: np.ndarray, spans: np.ndarray, most: int):
        """(states, times) of motions from states (m, 3) after spans (m,) of time, forth or back, or after the
        most steps."""
        out, (left, times) = np.array(states, order="C"), np.empty((2, len(spans)))
        self.counted += min(most, REVOLUTION) * len(states)
        self._call("run", self.coefficients, out, np.zeros_like(out), spans, np.full(len(spans), most), left,
                   times, np.empty((2, len(spans))), *self._memory)
        return out, times

    def measure(self, rows, out, t_max: float, budget: int) -> np.ndarray:
        """Note in columns (n,) of `follow.Chased` how much a small change of rows (m,) has grown, how far
        their rounding reaches, and (n, 48) their sizes; (m,) which of them are at the end of their time or of
        their steps, or beyond doubles."""
        over = np.empty(len(rows), bool)
        self._call("measure", rows, self.states, self.steps, self.rounded, self.twins.growth, self.met,
                   STEP_ERROR, out.condition, out.reach, out.largest, out.least, self.times, t_max, budget,
                   over)
        return over

    def compare(self, rows, starts, twins, delays, apart):
        """Take note of how twins have gone apart, and say where they tell nothing (`Twins.compare`)."""
        error = STEP_ERROR * self.rounded[rows] * np.sqrt(inner(starts, starts))
        return self.twins.compare(rows, starts, self.states[rows], twins, delays, apart, error)

    def rates(self, states: np.ndarray):
        """The rates of change at states (m, 3)."""
        y, z = states.take(NEXT, axis=1), states.take(LAST, axis=1)
        c = self.coefficients
        return c[0] * y * z + c[1] * z + c[2] * y + c[3]

    def slopes(self, states, directions):
        """How the rates change along directions (m, 3)."""
        y, z = states.take(NEXT, axis=1), states.take(LAST, axis=1)
        v, w = directions.take(NEXT, axis=1), directions.take(LAST, axis=1)
        c = self.coefficients
        return c[0] * (y * w + v * z) + c[1] * w + c[2] * v

    def slopes_back(self, states, weights):
        """The gradient of the rates' sum with weights (m, 3)."""
        c = [row * weights for row in self.coefficients[:3]]
        y, z = states.take(NEXT, axis=1), states.take(LAST, axis=1)
        return (c[0] * z + c[2]).take(LAST, axis=1) + (c[0] * y + c[1]).take(NEXT, axis=1)


class Twins:
    """growth (n,): of a small change of the start across the motion, along the direction `ahead` that it
    turned to (largest entry 1); inf where it could not be told any more; most (n,): the most it was. blur
    (n,): of the time. rates: function of states (m, 3)."""

    def __init__(self, n: int, rates: Callable[..., Any]):
        self.growth, self.most, self.ahead = np.ones(n), np.ones(n), np.tile([1.0, -1.0, 1.0], (n, 1))
        self.blur, self.rates = np.zeros(n), rates

    def start(self, rows, states, apart: float):
        """(twins (m, 3), how far they are (m,)) of rows at their states; apart: relative to these, or to the
        natural rate."""
        unit = self._along(states)
        across = self.ahead[rows] - unit * inner(self.ahead[rows], unit)[:, None]
        none = largest(across) < kernel.LOST
        if none.any():
            other = np.cross(unit[none], np.roll(unit[none], 1, axis=1) + [0.0, 0.0, 0.1])
            across[none] = kernel.LOST * other / np.sqrt(inner(other, other))[:, None]
        far = apart * _size(states) / largest(across)
        return states + far[:, None] * across, far

    def compare(self, rows, starts, states, twins, delays, apart, error):
        """Take note of what has become of changes of the size `apart` (m,): states (m, 3), and twins, which
        passed the same place delays (m,) later. error (m,): of the places, in all, but for the growth.
        Returns (m,) where they tell nothing: nothing is noted there."""
        unit, change, printed = self._along(states), twins - states, np.ones(len(rows), bool)
        speed, room = inner(self.rates(states), unit), NO_GROWTH * _size(states)
        # the twin where it was, or will be, beside the motion: to second order in the delay
        for _ in range(2):
            more = np.where(speed > 0, -inner(change, unit) / speed, 0.0)
            rate = self.rates(states + change)
            change, delays = change + more[:,
                                           None] * self.rates(states + change
                                                              + 0.5 * more[:, None] * rate), delays + more
            printed &= np.abs(more) * speed < room
        size, first = largest(change), np.sqrt(inner(*[self.rates(starts)] * 2))
        printed &= size < room
        yes = rows[printed]
        self.blur[yes] += (error * self.most[rows]
                           * (np.abs(delays) / apart
                              + np.where(first > kernel.STILL * _size(starts), 1 / first, 0.0)))[printed]
        self.growth[yes] *= (size / apart)[printed]
        self.most[yes] = np.fmax(self.most[yes], self.growth[yes])
        turned = printed & (size > 0)
        self.ahead[rows[turned]] = change[turned] / size[turned, None]
        return ~printed

    def _along(self, states: np.ndarray):
        """Unit vectors along the motions (m, 3); zero where they hardly move."""
        rates = self.rates(states)
        speed = np.sqrt(inner(rates, rates))
        return np.where((speed > kernel.STILL * _size(states))[:, None], rates / speed[:, None], 0.0)


def _size(states: np.ndarray):
    return np.maximum(largest(states), 1.0)


# --- Many revolutions at once
# steps that a motion is followed plainly first: to find out that it would not leap takes half as many
FROM = 20_000
# revolutions of a window: fewer are hardly less work than step by step
LEAST, FIRST, MOST = 512.0, 1024.0, 2.0**40
# after how many times its steps a motion that would not leap is asked again
AGAIN = 1.6
APART = 2.0**-26                   # of a twin, relative: a window of a million revolutions leaves it near

NODES, TURNS = 16, 16
BERNOULLI = {2: 1 / 6, 4: -1 / 30, 6: 1 / 42, 8: -1 / 30}
BETWEEN = 0.37  # of the window: the place between nodes that is looked at
UNIT = 2.0**-52

MOST_STEPS = 500  # that a return may take
ENDLESS = 1e300
NEWTON = 6      # corrections of its time by the Taylor series; the last is a formula
SERIES_BELOW = 1e-6     # share of a radian, below which that formula errs by less than a unit of rounding
# a return is told from other passages of the section: it comes so close to its start, as a share of the way
# round
CLOSED = 2e-2


class Returns:
    """The map of sections to themselves along the motions of `runs`; every row has its own section, all are
    independent of each other."""

    def __init__(self, runs: Runs):
        self.runs = runs

    def __call__(self, states, normals, guesses):
        """(states, times, good): of states (m, 3) on the sections of normals (m, 3), the return that is
        expected after about guesses (m,)."""
        good = np.isfinite(guesses) & (guesses > 0) & np.isfinite(states).all(axis=1)
        times, states = np.where(good, guesses, 0.0), np.where(good[:, None], states, 1.0)
        places, reached = self.runs.carried(states, times, MOST_STEPS)
        good &= np.abs(reached - times) <= 1e-9 * times
        for _ in range(NEWTON):
            late, turned = self._late(places, normals)
            good &= np.isfinite(late) & ~(np.abs(late) > 0.3 * times)
            rows = np.flatnonzero(good & (turned > SERIES_BELOW))
            if not rows.size:
                break
            places[rows], _ = self.runs.carried(places[rows], -late[rows], MOST_STEPS)
            times[rows] -= late[rows]
        late, turned = self._late(places, normals)
        good &= turned <= SERIES_BELOW
        rates = self.runs.rates(places)
        rates = self.runs.rates(places - 0.5 * late[:, None] * rates)  # the midpoint formula
        return places - late[:, None] * rates, times - late, good & (np.abs(times / guesses - 1) < 0.5)

    def _late(self, places, normals):
        """(time since the section was passed, the angle turned since), (m,) each, to first order."""
        rates = self.runs.rates(places)
        bend = self.runs.slopes(places, rates)
        late = inner(rates, normals) / inner(bend, normals)
        return late, np.abs(late) * np.sqrt(inner(bend, bend) / inner(rates, rates))

    def normals(self, states: np.ndarray):
        """Unit vectors across the motions at states (m, 3), toward where they bend: these states lie on the
        sections."""
        rates = self.runs.rates(states)
        bend = self.runs.slopes(states, rates)
        bend -= rates * (inner(bend, rates) / inner(rates, rates))[:, None]
        return bend / np.sqrt(inner(bend, bend))[:, None]

    def on_section(self, states, normals):
        """The nearest places on the sections: what is off them is rounding, which sums over many revolutions
        would gather."""
        for _ in range(2):
            off = inner(self.runs.rates(states), normals)
            up = self.runs.slopes_back(states, normals)
            states = states - up * (off / inner(up, up))[:, None]
        return states

    def first(self, states: np.ndarray):
        """(times, steps): of states (m, 3) the first return to their sections, and the steps on the way; nan
        where none is near."""
        normals = self.normals(states)
        times, steps = np.full(len(states), np.nan), np.zeros(len(states), int)
        places, now, far = states.copy(), np.zeros(len(states)), np.zeros(len(states))
        before, open_ = np.zeros(len(states)), np.arange(len(states))
        for number in range(1, MOST_STEPS):
            places[open_], passed = self.runs.carried(places[open_], np.full(open_.size, ENDLESS), 1)
            now[open_] += passed
            gone = places[open_] - states[open_]
            far[open_] = np.fmax(far[open_], np.sqrt(inner(gone, gone)))
            height = inner(self.runs.rates(places[open_]), normals[open_])
            rows = open_[(before[open_] < 0) & (height >= 0)]
            before[open_] = height
            if rows.size:
                late, _ = self._late(places[rows], normals[rows])
                back, result, good = self(states[rows], normals[rows], now[rows] - late)
                good &= np.sqrt(inner(*[back - states[rows]] * 2)) < CLOSED * far[rows]
                times[rows[good]], steps[rows[good]] = result[good], number
                open_ = np.setdiff1d(open_, rows[good])
            if not open_.size:
                break
        return times, steps


@dataclass(frozen=True)
class Window:
    """states (m, 3), times (m,) passed, periods (m,) of the last return; good (m,); turns (m,) that it took.
    """

    states: np.ndarray
    times: np.ndarray
    periods: np.ndarray
    good: np.ndarray
    turns: np.ndarray


@lru_cache(maxsize=1)
def matrices():
    """(sums, powers, coefficients, between): x(n) - x(0) = sum_k N^powers[k] sums[k] @ d at the nodes;
    coefficients @ d those of Chebyshev's polynomials; between @ values at the nodes the value at BETWEEN."""
    from numpy.polynomial import chebyshev
    places = -np.cos(np.pi * np.arange(NODES + 1) / NODES)
    values, coefficients = chebyshev.chebvander(places,
                                                NODES), np.linalg.inv(chebyshev.chebvander(places, NODES))
    integral, slope = np.zeros((NODES + 2, NODES + 1)), np.zeros((NODES + 1, NODES + 1))
    for k, item in enumerate(np.eye(NODES + 1)):
        up, down = chebyshev.chebint(item, lbnd=-1) / 2, chebyshev.chebder(item) * 2
        integral[:up.size, k], slope[:down.size, k] = up, down
    sums = [chebyshev.chebvander(places, NODES + 1) @ integral @ coefficients,
            -0.5 * _from_start(np.eye(NODES + 1))]
    sums += [b / factorial(k) * _from_start(values @ np.linalg.matrix_power(slope, k - 1) @ coefficients)
             for k, b in BERNOULLI.items()]
    return np.array(sums), np.array([1, 0,
                                     *(1 - k for k in BERNOULLI)]), coefficients, chebyshev.chebvander(
                                         2 * BETWEEN - 1, NODES) @ coefficients


def _from_start(matrix):
    return matrix - matrix[0]


def window(returns: Returns, states, counts, periods, steps) -> Window:
    """The motions from states (m, 3) after so many revolutions: counts (m,), whole numbers from 16 on.
    periods (m,): of the first of them; steps (m,): how many a revolution takes. Each row is computed as if
    alone."""
    sums, powers, _, _ = matrices()
    m = len(states)
    normals, size = returns.normals(states), np.sqrt(inner(states, states))
    matrix = (counts[:, None, None, None] ** powers[:, None, None].astype(float) * sums).sum(axis=1)
    x = np.zeros((m, NODES + 1, 4))
    x[:, :, :3] = states[:, None]
    d, guesses = np.zeros_like(x), np.repeat(periods[:, None], NODES + 1, axis=1)
    good, turns, open_ = np.zeros(m, bool), np.zeros(m, int), np.arange(m)
    before = np.full(m, np.inf)
    for turn in range(1, TURNS + 1):
        nodes = slice(turn > 1, None)  # the first node stays where it is
        if turn == 2:  # the faster, the sooner round: good enough to find the return by
            guesses *= size[:, None] / np.sqrt((x[:, :, :3]**2).sum(axis=2))
        d[open_, nodes], guesses[open_, nodes], fine = _drift(returns, x[open_, nodes, :3], normals[open_],
                                                              guesses[open_, nodes])
        after = x[open_, :1] + matrix[open_] @ d[open_]
        after[:, 1:, :3] = _projected(returns, after[:, 1:, :3], normals[open_])
        change = np.abs(after - x[open_])[:, :, :3].max(axis=(1, 2)) / size[open_]
        x[open_], turns[open_] = after, turn
        settled = fine & (change <= UNIT * (8 + counts[open_]))
        good[open_[settled]] = True
        # turns to come, at the pace of the last
        left = np.log(change / (UNIT * counts[open_])) / np.log(before[open_] / change)
        going = fine & ~settled & ((turn < 3) | (change < 0.5 * before[open_]) & (turn + left < TURNS))
        before[open_] = change
        open_ = open_[going]
        if not open_.size:
            break
    good &= _smooth(returns, x, d, normals, guesses, size * UNIT * steps, good)
    return Window(x[:, -1, :3], x[:, -1, 3], guesses[:, -1], good, turns)


def _drift(returns, x, normals, guesses):
    """(d (m, nodes, 4), times of return, rows where all is well)."""
    m, nodes = guesses.shape
    flat = x.reshape(-1, 3)
    back, times, fine = returns(flat, np.repeat(normals, nodes, axis=0), guesses.ravel())
    return np.concatenate([back - flat, times[:, None]],
                          axis=1).reshape(m, nodes,
                                          4), times.reshape(m, nodes), fine.reshape(m, nodes).all(axis=1)


def _projected(returns, x, normals):
    return returns.on_section(x.reshape(-1, 3), np.repeat(normals, x.shape[1], axis=0)).reshape(x.shape)


def _smooth(returns, x, d, normals, guesses, allowed, good):
    """Whether the polynomial follows the drift to within `allowed` (m,)."""
    _, _, coefficients, between = matrices()
    rows = np.flatnonzero(good)
    out = np.zeros(len(good), bool)
    if rows.size:
        tail = np.abs(coefficients[-3:] @ d[rows])[:, :, :3].max(axis=(1, 2))
        index, expected = _projected(returns, (between @ x[rows])[:, :, :3], normals[rows]), between @ d[rows]
        visited, _, fine = _drift(returns, index, normals[rows], guesses[rows, NODES // 2:NODES // 2 + 1])
        missed = np.abs(visited - expected)[:, 0, :3].max(axis=1)
        out[rows] = fine & (tail <= allowed[rows]) & (missed <= allowed[rows])
    return out


class Leaps:
    """The windows of the rows of `runs`: counts (n,) of revolutions of the next, periods (n,), steps (n,) of
    a revolution."""

    def __init__(self, runs: Runs):
        n = len(runs.states)
        self.runs, self.returns = runs, Returns(runs)
        self.counts, self.periods, self.steps = np.zeros(n), np.full(n, np.nan), np.zeros(n)
        self.due = np.full(n, FROM)

    def advance(self, rows: np.ndarray, t_max: float, pause: float = 0.0):
        """The rows (of indices) that were carried on, each by one window; the others are left as they are, to
        go on step by step."""
        rows = rows[self.runs.steps[rows] >= self.due[rows]]
        if not rows.size:
            return rows
        with np.errstate(all="ignore"):
            self._find(rows[np.isnan(self.periods[rows])])
            ends = np.where(self.runs.times[rows] < pause, min(pause, t_max), t_max)
            counts = np.floor(np.fmin(np.fmin(self.counts[rows], MOST),
                                      (ends - self.runs.times[rows]) / self.periods[rows] * 0.9))
            able = counts >= LEAST
            done = np.zeros(len(rows), bool)
            if able.any():
                done[able] = self._leap(rows[able], counts[able])
            self._give_up(rows[~done & ((self.counts[rows] < LEAST) | np.isnan(self.periods[rows]) | ~able)])
        return rows[done]

    def _find(self, rows):
        """The first return of rows, and a first guess of how many are worth a window."""
        if not rows.size:
            return
        runs = self.runs
        self.periods[rows], self.steps[rows] = self.returns.first(runs.states[rows])
        runs.steps[rows] += self.steps[rows].astype(int)
        self.counts[rows] = np.where(np.isfinite(self.periods[rows]), FIRST, 0.0)

    def _give_up(self, rows):
        self.periods[rows], self.due[rows] = np.nan, (AGAIN * self.runs.steps[rows]).astype(int)

    def _leap(self, rows, counts):
        """Which rows went over a window of so many revolutions; the next window's are set for all."""
        runs, m = self.runs, len(rows)
        states = runs.states[rows]
        twins, apart = runs.twins.start(rows, states, APART)
        result = window(self.returns, np.concatenate([states, twins]),
                       *(np.tile(v, 2) for v in (counts, self.periods[rows], self.steps[rows])))
        good, turns = result.good[:m] & result.good[m:], result.turns[:m]
        runs.steps[rows] += (turns * (NODES * self.steps[rows])).astype(int)
        done, passed, delays = rows[good], result.times[:m][good], (result.times[m:] - result.times[:m])[good]
        runs.rounded[done] += counts[good] * self.steps[done]
        runs.states[done], runs.times[done] = result.states[:m][good], runs.times[done] + passed
        lost = runs.compare(done, states[good], result.states[m:][good], delays, apart[good])
        runs.twins.growth[done[lost]] = np.inf
        runs.twins.blur[done] += STEP_ERROR * runs.rounded[done] * passed
        self.periods[done] = result.periods[:m][good]
        self.counts[rows] = np.where(good,
                                     counts * np.where(turns <= 8, 2.0, np.where(turns <= 11, 1.0, 0.5)),
                                     counts / 2)
        return good
