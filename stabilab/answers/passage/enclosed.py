"""The first crossing with the motion enclosed in integers, of as many bits as it takes, as long as the work
allowed reaches; beyond that by compiled steps, for rates along principal axes alone."""
from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from ...integrate.integer_flow import IntegerFlow, Search
from ...numbers.exact import sqrt_fraction
from ...numbers.numba_door import installed
from ...numbers.vectors import Exact3, Number
from ...physics.scene import AnyScene
from ...unreduced.enclosure.bands import Crossing, first_crossing
from .limit import Limit, along_axes

FIRST_BITS, MOST_BITS = 112, 720
KEPT = 58  # bits that the enclosure of the state is to keep
MARGIN = KEPT + 18  # beyond the growth of the error, for the rounding of a longer series
WORK = 30_000_000  # multiplications; two to four seconds
# after this part of the work a way that would take so many times what is left is given up
TRIED, HOPELESS = 16, 8
STEADY = 1.125  # steps that grow faster than this are those of the first search for a length
STEPS = 60_000  # validated ones; some two seconds


@dataclass(frozen=True)
class Enclosed:
    """low, high: of the first crossing, in the scene's time, exact; high None: not found before `until`, and
    low is None or a place where the limit is touched. until: the last time that was looked at; done: whether
    that is the time asked for."""

    low: Fraction | None
    high: Fraction | None
    until: Fraction
    done: bool


def enclosed(scene: AnyScene, start: Sequence[Number], limit: Limit, t_max: Fraction | None = None,
             work: int = WORK,
             earliest: Fraction = Fraction(0), later: Sequence[tuple[Fraction, AnyScene]] = ()) -> Enclosed:
    """The first crossing of the motion of a plain scene from three rationals, proved; or until when there is
    none.

    t_max: None where only the work is to end the search. earliest: a time before which it is known not to
    happen: a way that would not come so far with the work is given up soon. later: times, in order, from
    which on another scene holds, of the same body and wheels. A first attempt, at few bits, is carried on
    beyond what its bits can prove, to learn how many it takes.
    """
    unit = max(own_unit(one, start) for one in (scene, *(one for _, one in later)))
    switches = [(time * unit, one.quadratic()) for time, one in later]
    bits, best, spent = FIRST_BITS, Enclosed(None, None, Fraction(0), False), 0
    while True:
        attempt = _Attempt(flow_of(scene, start, bits, unit, limit.direction), limit, unit, t_max, earliest,
                           switches)
        found = attempt.run(work - spent)
        spent += attempt.flow.work
        best = found if found.high is not None or found.until > best.until or found.done else best
        if best.high is not None or best.done or attempt.needs is None or spent > work:
            return best
        bits = max(attempt.needs, bits + KEPT)


def flow_of(scene: AnyScene, start: Sequence[Number], bits: int, unit: Fraction,
            direction: Exact3 | None = None) -> IntegerFlow:
    """The motion of a plain scene from three rationals; bits, unit, direction: as of IntegerFlow."""
    weights = (Fraction(1), Fraction(2), Fraction(1)) if scene.variables == "scaled" else scene.body.exact
    return IntegerFlow(scene.quadratic(), weights, start, bits, unit, direction)


def own_unit(scene: AnyScene, start: Sequence[Number]) -> Fraction:
    """A power of two near the largest rate, or near the root of its rate of change."""
    form = scene.quadratic()
    # its square may be beyond doubles
    change = sqrt_fraction(max(map(abs, form.rate([Fraction(v) for v in start]))))
    size = max(float(max(map(abs, start))), float(change))
    return Fraction(2) ** math.frexp(size)[1] if size else Fraction(1)


class _Attempt:
    """One run at a number of bits. needs: the bits that a proof would have taken, where these were too few;
    None otherwise."""

    def __init__(self, flow: IntegerFlow, limit: Limit, unit: Fraction, t_max: Fraction | None,
                 earliest: Fraction, switches: Sequence[tuple[Fraction, Any]]) -> None:
        self.flow, self.unit, self.switches = flow, unit, [*switches]
        self.needs: int | None = None
        self.end = None if t_max is None else t_max * unit
        self.earliest = (earliest if t_max is None else min(earliest, t_max)) * unit
        self.thresholds = limit.thresholds(unit)
        self.proved = [Search(one) for one in self.thresholds]

    def run(self, work: int) -> Enclosed:
        """Proved as far as the bits reach, then on, at its word, to where a proof would end."""
        until, lost, flow = Fraction(0), 0, self.flow
        searches, proving, length = self.proved, True, math.inf
        while True:
            needs = lost + flow.error.bit_length() + MARGIN
            if flow.work * (1 if proving else 1 + (needs / flow.bits) ** 2) > work or needs > MOST_BITS:
                return self._answer(until, False)
            if proving and flow.error.bit_length() > flow.bits - KEPT:
                proving, searches = False, [Search(one, exactly=False) for one in self.thresholds]
            before = flow.work
            try:
                piece = flow.step(self.switches[0][0] if self.switches else None)
            except OverflowError:  # the error of one step is beyond doubles: what was proved before stays
                return self._answer(until, False)
            hit = [search.take(piece) for search in searches]
            now, shorter, length = flow.now, length, float(piece.length)
            if self.switches and now == self.switches[0][0]:
                flow.turn_on(self.switches.pop(0)[1])
            if (flow.work * TRIED > work and length < STEADY * shorter and (self.earliest - piece.start)
                    * (flow.work - before) > HOPELESS * (work - flow.work) * piece.length):
                return self._answer(until, False)  # steps like this one would take much more than is left
            if proving:
                until = now
            elif (excess := flow.error.bit_length() - flow.bits) > 0:
                flow.forget(excess)
                lost += excess
            ended = self.end is not None and now >= self.end
            if any(hit) or ended:
                if proving:
                    return self._answer(until, ended)
                self.needs = needs + 1
                return self._answer(until, False)

    def _answer(self, until: Fraction, done: bool) -> Enclosed:
        low = min((one.low for one in self.proved if one.low is not None), default=None)
        high = min((one.high for one in self.proved if one.high is not None), default=None)
        if self.end is not None and low is not None and low > self.end:
            low = high = None
        scale = lambda t: None if t is None else t / self.unit
        until = min(until, self.end) if done and self.end is not None else until
        return Enclosed(scale(low), scale(high), until / self.unit, done)


def banded(scene: AnyScene, start: Sequence[Number], limit: Limit, t_max: float,
           steps: int = STEPS) -> Crossing | None:
    """low and high of the first crossing (high inf where none is found before low) of the motion from three
    rationals; None where numba is not there to compile the steps, or the limit is of another kind."""
    if limit.kind == "tilt" or not installed() or any(not along_axes(terms) for terms, _ in limit.parts):
        return None
    found = [first_crossing(scene, start, math.sqrt(most), along_axes(terms), t_max=t_max, steps=steps)
             for terms, most in limit.parts]
    first = min(found, key=lambda one: one.low)
    return Crossing(first.low, min(one.high for one in found), first.because, sum(one.steps for one in found))
