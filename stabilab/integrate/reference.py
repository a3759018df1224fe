"""A motion to many digits, its error known: Taylor series of the exact equations, run at two precisions, and
what is looked for along them, a return and extremes. Nothing but the equations is shared with the methods
that are judged by it.

The rates of every scene are polynomials in the state with rational coefficients. The series x = sum x_n t^n
obeys (n+1) x_(n+1) = sum of c_m m_n over the monomials m, and a product's series is the convolution of its
factors'. The numbers are midpoints of python-flint's balls.
"""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from operator import mul
from typing import TYPE_CHECKING

import numpy as np

from ..errors import InputError
from ..numbers.balls import DOUBLE_BITS, Digits, working
from ..numbers.vectors import Number
from ..physics.equations import Equations, derive
from ..physics.scene import AnyScene, hold_on, slices
from ..reasons import Moment, Quantity, Reasoned, Sentence
from .guard import too_far

if TYPE_CHECKING:
    from flint import arb

RETURNED = 1e-12  # a passage through the starting plane within this share of the orbit's size is a return
PIECES = 6  # of a step, each searched for one root


AGREE = Sentence("precisions-agree", "two precisions agree at every time")()
AGREE_UP_TO = Sentence("precisions-agree-up-to",
                       "{fewer} and {more} digits agree up to {time} of {end}, and {beyond}")
NO_FURTHER = Sentence("multiplications-spent", "the multiplications allowed went no further")()
SENSITIVE = Sentence("too-sensitive", "not beyond: the motion is too sensitive")()
TOO_MUCH_WORK = Sentence("digits-take-too-long",
                         "a run in {digits} digits takes more than the {work} multiplications allowed")


class Exhausted(Exception):
    """The work allowed is used up."""


class Recursion:
    """The Taylor recursion of polynomial rates: which products to form, and the rates as sums of them."""

    def __init__(self, equations: Equations):
        from sympy import Poly, PolynomialError
        self.size, self.products, self._at = len(equations.state), [], {}
        self.rates = []
        for rate in equations.rhs:
            try:
                terms = Poly(equations.numeric(rate), *equations.state).terms()
            except PolynomialError:
                raise InputError("the reference needs rates that are polynomials in the state") from None
            self.rates.append([(self._place(powers), Fraction(int(c.p), int(c.q)))
                               for powers, c in terms if c != 0])

    def _place(self, powers: Sequence[int]):
        """Row of the monomial's series (-1: the number 1), forming the products it needs."""
        factors = tuple(i for i, n in enumerate(powers) for _ in range(n))
        return self._row(factors) if factors else -1

    def _row(self, factors: Sequence[int]):
        if len(factors) == 1:
            return factors[0]
        if factors not in self._at:
            first, second = self._row(factors[:-1]), factors[-1]
            self._at[factors] = self.size + len(self.products)
            self.products.append((first, second))
        return self._at[factors]

    def in_balls(self, numbers: Digits):
        """The rates with their coefficients as balls of this kind."""
        return [[(row, numbers.ball(c).mid()) for row, c in rate] for rate in self.rates]

    def series(self, rates, x, order):
        """Taylor coefficients 0..order of the state, one list a component."""
        rows = [[v] for v in x] + [[] for _ in self.products]
        for n in range(order):
            for into, (first, second) in zip(rows[self.size:], self.products):
                into.append(sum(map(mul, rows[first][:n + 1], rows[second][n::-1])).mid())
            for into, rate in zip(rows[:self.size], rates):
                total = sum(c * rows[row][n] for row, c in rate if row >= 0)
                total = total + sum(c for row, c in rate if row < 0) if n == 0 else total
                into.append((total / (n + 1) + x[0] * 0).mid())
        return rows[:self.size]

    def cost(self, order: int):
        """Multiplications of one series."""
        return order * (order + 1) // 2 * len(self.products) + order * sum(len(rate) for rate in self.rates)


@dataclass(frozen=True)
class Step:
    """The series about time `start` (a ball), good up to `length` later; forward or backward by its sign."""

    start: Number
    length: Number
    rows: list

    def at(self, s: arb, derivative: int = 0):
        return [value(row, s, derivative) for row in self.rows]


def value(row: Sequence[arb], s: arb, derivative: int = 0):
    """The series, or its first derivative, at s."""
    from flint import arb_poly
    series = arb_poly(row)
    return (series.derivative() if derivative else series)(s).mid()


def steps(recursion: Recursion, start: Sequence[float | Fraction] | np.ndarray, digits: int,
          budget: list[int], numbers: Digits, sense: int = 1, swing: bool = False):
    """Steps from the start at time 0, without end; raises Exhausted where the budget (a list of one count) is
    used up.

    numbers: the kind (`balls.Digits`), to be taken while it is the working one. sense: -1 steps back in
    time. swing: the return to the start is looked for, so a step is no longer than its changes are resolved.
    """
    order, rates = int(1.15 * digits) + 4, recursion.in_balls(numbers)
    x, now = [numbers.ball(v) for v in start], numbers.ball(0)
    while True:
        budget[0] -= recursion.cost(order)
        if budget[0] < 0:
            raise Exhausted
        rows = recursion.series(rates, x, order)
        length = _length(rows, order, digits)
        length = sense * (min(length, _length_of_change(rows, order, digits)) if swing else length)
        step = Step(now, length, rows)
        yield step
        x, now = step.at(length), (now + length).mid()


def _length(rows: Sequence[list[arb]], order: int, digits: int):
    """The last two coefficients bound the tail: it is 10^-digits of the state's size."""
    from flint import arb
    size, shortest = max(abs(row[0]) for row in rows), arb(10) ** 9
    size = size if size > 0 else max(abs(row[1]) for row in rows)
    for n in (order - 1, order):
        top = max(abs(row[n]) for row in rows)
        if top > 0:
            shortest = min(shortest, (size * arb(10) ** -digits / top).root(n))
    return shortest.mid()


def _length_of_change(rows: Sequence[list[arb]], order: int, digits: int):
    """Twice the step whose tail is 10^-digits of the largest of its first terms: a swing may be as small as
    it likes beside the state."""
    from flint import arb
    top, longest = max(abs(row[order]) for row in rows), arb(0)
    for n in (1, 2, 3):
        largest = max(abs(row[n]) for row in rows)
        if largest > 0 and top > 0:
            longest = max(longest, (largest * arb(10) ** -digits / top).root(order - n))
    return (2 * longest).mid() if longest > 0 else arb(10) ** 9


class Loop:
    """Watches a motion until it returns to its start: the time of return and the extremes on the way."""

    def __init__(self):
        self.closed, self.period, self.extremes = False, None, None

    def take(self, step: Step):
        if self.extremes is None:
            self.home, self.normal = step.at(step.length * 0), [row[1] for row in step.rows]
            self.extremes = [[v, v] for v in self.home[:3]]
        end = step.length
        for s in self._passages(step):
            size = max(high - low for low, high in self.extremes)  # of what was passed before this step
            if max(abs(a - b) for a, b in zip(step.at(s), self.home)) < size * RETURNED:
                self.closed, self.period, end = True, (step.start + s).mid(), s
                break
        widen(self.extremes, step, end)

    def _passages(self, step: Step):
        """Later passages, in the direction of the motion, of the plane across the first velocity."""
        row = [sum(map(mul, self.normal, column)) for column in zip(*step.rows)]
        row[0] = row[0] - sum(map(mul, self.normal, self.home))
        after = 1e-9 if step.start == 0 else 0.0
        return [s for s in _roots(row, step.length) if s > step.length * after and value(row, s, 1) > 0]


def widen(pairs: Sequence[list[arb]], step: Step, end: arb):
    """Let the least and greatest values of the first components take in a step as far as `end` after its
    start. The multiplications that this took."""
    work = 0
    for row, pair in zip(step.rows, pairs):
        slopes, tried = [n * c for n, c in enumerate(row)][1:], [0]
        for s in [*_roots(slopes, step.length, tried), end]:
            if abs(s) <= abs(end):
                v = value(row, s)
                pair[0], pair[1] = min(pair[0], v), max(pair[1], v)
        work += (PIECES + 2 + 2 * tried[0]) * len(row)
    return work


def _roots(row: Sequence[arb], length: arb, tried: Sequence[int] | None = None):
    """Simple roots of a series inside (0, length]: bracketed by pieces, closed in on by Newton's method.
    tried: a list whose one number counts the steps of that."""
    ends = [length * k / PIECES for k in range(PIECES + 1)]
    values = [value(row, s) for s in ends]
    rows = []
    for a, b, fa, fb in zip(ends, ends[1:], values, values[1:]):
        if (fa < 0) != (fb < 0) or fb == 0:
            rows.append(_root(row, a.mid(), b.mid(), fa, tried or [0]))
    return rows


def _root(row, a, b, fa, tried):
    """The root between a and b: Newton's method, held in the bracket, until it moves no more."""
    s = ((a + b) / 2).mid()
    for _ in range(400):
        tried[0] += 1
        f = value(row, s)
        if f == 0:
            break
        if (f < 0) == (fa < 0):
            a = s
        else:
            b = s
        slope = value(row, s, 1)
        new = (s - f / slope).mid() if slope != 0 else a
        if not (a < new < b):
            new = ((a + b) / 2).mid()
        if abs(new - s) <= abs(b) * 2.0**-1000 or new == s:
            break
        moved, s = abs(new - s), new
        if moved < abs(s) * _unit():
            break
    return s


def _unit():
    from flint import arb, ctx
    return arb(2) ** (4 - ctx.prec)


RUN_DIGITS = (30, 42, 84, 168, 336)  # of successive runs; each is checked by the one before
# two runs agree where they differ by less than this share of the state: far below a double's 1e-16
AGREEMENT = 1e-19
WORK = 60_000_000  # multiplications of all runs together, some ten seconds
SETTLED = 20  # the share of a run's work that shows a motion's pace
SEARCH = 20  # evaluations of a series that the search for its roots takes in a step
GUARD = 8  # digits that the roundings of a run may use up


@dataclass(frozen=True)
class Reference(Reasoned):
    """States (n, N) at times t (n,) as unevaluated sums states + rest of two doubles.

    error: (n,) the difference between the last two runs, relative as of `relative_errors`; digits: of those
    two runs. period: (time, rest, error) of the first return, or None; extremes: least and greatest of each
    of the first three components over that period as (3, 2, 2) sums of two doubles, or None, extremes_error
    relative. status: "agrees" or "stopped", where t holds the longest part of the span on which they agree
    (reason says why it ends). work: multiplications.
    """

    t: np.ndarray
    states: np.ndarray
    rest: np.ndarray
    error: np.ndarray
    digits: tuple[int, int]
    slices: dict = field(repr=False)
    period: tuple | None = None
    extremes: np.ndarray | None = None
    extremes_error: float | None = None
    status: str = "agrees"
    work: int = 0


def one_run(recursion: Recursion, start: Sequence[float | Fraction] | np.ndarray,
            times: np.ndarray | Sequence[Fraction], digits: int, budget: list[int], orbit: bool = False):
    """(states at the times reached, (period, extremes) or None) as balls at `digits` decimal digits.

    times: of one sign, moving away from 0. orbit: the motion is known to repeat: its return is found, and
    later times are folded by the period, so that they cost nothing.
    """
    result, passed, loop, taken, begun = [], [], Loop() if orbit else None, 0, budget[0]
    with working(int((digits + GUARD) * 3.33)) as numbers:
        wanted = [numbers.ball(t) for t in times]
        try:
            for step in steps(recursion, start, digits, budget, numbers,
                              -1 if len(times) and times[-1] < 0 else 1, orbit):
                while len(result) < len(wanted) and abs(wanted[len(result)] - step.start) <= abs(step.length):
                    result.append(step.at((wanted[len(result)] - step.start).mid()))
                if loop:
                    passed.append(step)
                    budget[0] -= SEARCH * (recursion.size + 1) * len(step.rows[0])
                    loop.take(step)
                    if loop.closed:
                        result += [_folded(passed, t, loop.period) for t in wanted[len(result):]]
                if len(result) == len(wanted) and (loop is None or loop.closed):
                    break
                taken += 1
                left = wanted[len(result)] - step.start - step.length if len(result) < len(wanted) else 0
                if loop is None and hopeless(left, step.length, taken, begun, budget[0]):
                    break
        except Exhausted:
            pass
        return result, (loop.period, loop.extremes) if loop and loop.closed else None


def hopeless(left: arb | int, length: arb, taken: int, begun: int, budget: int) -> bool:
    """Whether the time left, a ball, at steps of the length of the last, is farther than what is left of the
    budget comes by far. taken, begun: steps so far, and the budget before them."""
    cost = max(1, begun - budget) / taken
    return too_far(taken, float(abs(left / length)), budget / cost, begun / cost / SETTLED)


def _folded(passed: Sequence[Step], time: arb, period: arb):
    """State at a time beyond the first return."""
    within = (time - (time / period).floor() * period).mid()
    step = next((s for s in passed if s.start <= within and within - s.start <= s.length), passed[-1])
    return step.at((within - step.start).mid())


def relative_errors(values: np.ndarray, states: np.ndarray, rest: np.ndarray,
                    slices: Mapping[str, slice]) -> np.ndarray:
    """(n,) error of states (n, N): in each block the largest component's distance over the block's largest
    size in the run, the worst block counting."""
    worst = np.zeros(len(states))
    for part in slices.values():
        size = np.abs(states[:, part]).max(initial=0.0)
        gap = np.abs((values[:, part] - states[:, part]) - rest[:, part]).max(axis=1)
        worst = np.maximum(worst, gap / size if size else gap)
    return worst


def reference(scene: AnyScene, start: Sequence[float | Fraction] | np.ndarray,
              times: np.ndarray | Sequence[float], blocks: Sequence[str] = (), orbit: bool = False,
              work: int = WORK) -> Reference:
    """The motion from `start` (N numbers, taken as exact) at increasing (or decreasing) times of one sign.

    blocks: blocks of state beyond those the scene needs. orbit: the motion is known to repeat: find its
    period and extremes as well, and fold later times by the period. work: multiplications allowed. Where two
    precisions do not agree within it, the longest part of the span that does is returned, with status
    "stopped". Raises InputError for rates that are no polynomials, and for times after the end of an effect.
    """
    equations = derive(scene, blocks)
    recursion, times, budget = Recursion(equations), np.asarray(times, float), [work]
    hold_on(scene, times.max(), "reference")
    parts, before, best = slices(equations.blocks), None, None
    orbit = orbit and not (times < 0).any()
    empty = np.empty((0, recursion.size))
    for digits in RUN_DIGITS:
        if before is None:  # a third of the work: the second run, which checks the first, costs twice as much
            budget[0], later = budget[0] - budget[0] * 2 // 3, budget[0] * 2 // 3
            now = one_run(recursion, start, times, digits, budget, orbit)
            budget[0] = max(budget[0], 0) + later
        else:
            now = one_run(recursion, start, times, digits, budget, orbit)
        if before is not None:
            result = _compared(times, before, now, parts, work - budget[0], scene.time_unit)
            best = result if best is None or len(result.t) >= len(best.t) else best
        if budget[0] < 0 or (best and best.status == "agrees"
                             and (best.period is None or best.period[2] <= AGREEMENT)):
            break
        before = digits, now
    return best or Reference(np.empty(0), empty, empty, np.empty(0), RUN_DIGITS[:2], parts, status="stopped",
                             work=work - budget[0],
                             reason=TOO_MUCH_WORK(digits=RUN_DIGITS[0], work=Quantity(work, digits=1)))


def _compared(times, before, now, parts, work, unit: str) -> Reference:
    """The part of the times on which two runs agree, (digits, run) of the one before and the one now. unit:
    of the times."""
    (low_digits, (low, low_loop)), (high, loop) = before, now
    n = min(len(low), len(high))
    states, rest = pairs(high[:n])
    lower, lower_rest = pairs(low[:n])
    error = relative_errors(lower, states, rest - lower_rest, parts) if n else np.empty(0)
    error = np.maximum(error, 10.0**-low_digits)
    good = error <= AGREEMENT
    reach = n if good.all() else int(np.argmin(good))
    ok, end = reach == len(times), times[reach - 1] if reach else 0.0
    high_digits = RUN_DIGITS[RUN_DIGITS.index(low_digits) + 1]
    why = AGREE if ok else AGREE_UP_TO(
        fewer=low_digits, more=high_digits, time=Moment(float(end)).lower,
        end=Quantity(float(times[-1]), unit), beyond=NO_FURTHER if reach == n else SENSITIVE)
    period, extremes, extremes_error = _orbits(low_loop, loop)
    return Reference(times[:reach], states[:reach], rest[:reach], error[:reach], (low_digits, high_digits),
                     parts, period, extremes,
                     extremes_error, "agrees" if ok else "stopped", work, reason=why)


def pairs(rows: Sequence[list[arb]]):
    """Lists of balls as two arrays of doubles whose sum they are."""
    with working(DOUBLE_BITS):
        high = np.array([[float(v) for v in row] for row in rows])
        low = np.array([[float((v - float(v)).mid()) for v in row] for row in rows])
    return high, low


def _orbits(low: tuple[arb, list[list[arb]]] | None, high: tuple[arb, list[list[arb]]] | None):
    """((period, rest, relative error), extremes (3, 2, 2), their relative error) of two runs, or three Nones.
    """
    if low is None or high is None:
        return None, None, None
    (t0, pairs0), (t1, pairs1) = low, high
    with working(DOUBLE_BITS):
        period = float(t1), float(t1 - float(t1)), float(abs(t1 - t0) / t1)
        extremes = np.array([[[float(v), float(v - float(v))] for v in pair] for pair in pairs1])
        gap = max(float(abs(a - b)) for item, two in zip(pairs0, pairs1) for a, b in zip(item, two))
    size = np.abs(extremes[..., 0]).max()
    return period, extremes, gap / size if size else gap
