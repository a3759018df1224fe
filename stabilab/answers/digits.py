"""Fate, extremes and period to as many digits as are asked for, in the cheapest way, checked afterwards.

A motion with a reduction: formulas in doubles, checked in ball arithmetic, whose answer takes over where they
fall short or where more digits are asked for. A motion that repeats without one: its return in a run, checked
by a Taylor series in many digits run at two precisions. Any other: a run over the span, checked by a run at
another tolerance from a start moved in its last place, and done again in many digits where that is not
enough.
"""
from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ..integrate.events import roots_of_rates
from ..integrate.reference import (
    GUARD,
    RUN_DIGITS,
    SEARCH,
    WORK,
    Exhausted,
    Recursion,
    hopeless,
    reference,
    steps,
    widen,
)
from ..integrate.to_heyoka import TAYLOR_TOLERANCE
from ..numbers.balls import Digits, working
from ..numbers.vectors import Exact3, Number
from ..orbit.fate import is_free
from ..orbit.period import free_quartic, real_period
from ..orbit.reduction import reduce
from ..orbit.result import Fate, Motion, Needs
from ..physics.coefficients import effective
from ..physics.equations import Equations
from ..physics.scene import AnyScene, QuadraticForm, Scene, time_left
from ..physics.states import checked_states, equations_and_start, moved_row
from ..reasons import Filling, Quantity, Sentence, as_reason
from ..unreduced.growth_certificate import law_extremes
from ..unreduced.near_rest import beside_rest, small_loop
from ..validation import reach_of
from .digits_asked import (
    CAUTION,
    DIGITS_MISSED,
    DOUBLE_DIGITS,
    MOST_DIGITS,
    Told,
    by_formula,
    checked_digits,
    digits_of,
    each_of,
    followed_digits,
    gap_of,
    judged,
    nothing,
    number_of,
    of_balls,
    proved,
)
from .motion import motion

SAMPLE = 16  # states of an array that are checked one by one; where all agree the formulas serve for the rest
LAW_BITS = 200  # at least, of the numbers of a law that holds for all time


IN_EQUILIBRIUM = Sentence("digits-of-equilibrium", "the state is an equilibrium")()
SAMPLED = Sentence("states-checked", "{checked} of {states} states checked")
NO_RETURN_IN_DIGITS = Sentence(
    "no-return-in-digits", "no return was found in many digits within the work allowed")()
RETURN_OF_RUN = Sentence(
    "return-of-run", "the return of a run in doubles, {error} from that of a Taylor series in {fewer} and "
    "{more} digits")
RETURN_OF_SERIES = Sentence(
    "return-of-series", "the return of a Taylor series in {fewer} and {more} digits, {error} apart")
SERIES_FROM_START = Sentence(
    "series-from-start", "its series from the start in many digits, {error} apart")
TWO_SERIES = Sentence("two-series-from-start", "two runs of its series from the start, {error} apart")
TWO_PRECISIONS = Sentence(
    "series-in-two-precisions", "Taylor series over the span in two precisions, {error} apart")
MOVED_RUN = Sentence(
    "run-from-moved-start", "a run over the span; one at rtol {rtol} from a start moved in its last place "
    "differs by {error}")


def ask(question: str, scene: AnyScene, state: Any, digits: int, span: Any = None,
        resolved: Motion | None = None, exact: Exact3 | None = None, aim: bool = False,
        tell: Callable[[float], None] | None = None) -> Told:
    """The extremes, the period, or the margin of the "fate" of one state, to `digits` decimal digits: 1 to
    10,000 where a formula gives them, to 50 where the motion is followed in time.

    state, span, exact: as of `motion`; resolved: what `motion` found, where that is at hand. Digits of
    extremes are relative to the size of their component. aim: nobody asked for the digits, so a run that
    misses them by `DIGITS_MISSED` is not done again. tell: is given the seconds that a long answer will take.
    Told.digits may be below what was asked: see Told.required.
    """
    digits = checked_digits(digits, MOST_DIGITS)
    twin = effective(scene)  # it turns alike and has nothing but a wheel and a torque, if `plain`
    if resolved is None:  # by a reduction none of the three questions needs the distance from the separatrix
        reduced = twin.plain and reduce(twin)
        resolved = motion(scene, state, span, needs=Needs.RETURN if reduced else Needs.ALL, exact=exact)
    if (item := by_formula(question, twin, resolved, digits, exact, tell)) is not None:
        return item
    if resolved.fate == Fate.EQUILIBRIUM:
        return Told(question, number_of(question, resolved), digits, math.inf, "exact",
                    reason=IN_EQUILIBRIUM)
    if question == "period" and resolved.period and is_free(twin):
        body: Any = twin  # that is free is no scene in scaled variables
        quartic = free_quartic(body.body.exact, body.vector("gyrostat"), exact or resolved.at[:3])
        return proved(question, real_period(quartic, max(digits, DOUBLE_DIGITS) + 1), digits)
    bits = max(LAW_BITS, int(3.33 * digits) + LAW_BITS // 4)
    if question == "extremes" and (balls := law_extremes(twin, exact or resolved.at[:3],
                                                         resolved.evidence.get("certificate"), bits)):
        return judged(question, resolved.extremes, [list(pair) for pair in balls], digits)
    followed_digits(digits, "this motion")
    if resolved.period:
        return _by_return(question, twin, resolved, digits, exact or resolved.at[:3])
    return _over_span(scene, state, span, resolved, digits, exact, DIGITS_MISSED * aim)


def ask_all(question: str, scene: AnyScene, states: Any, digits: int, values: Any, span: Any = None) -> Told:
    """The same for an array of states (..., 3); values (..., 3, 2) or (...,): what the formulas say of them;
    span: a time. Of many states a sample is checked."""
    array = checked_states(states)
    rows = array.reshape(-1, 3)
    picked = np.unique(np.linspace(0, len(rows) - 1, min(SAMPLE, len(rows))).astype(int))
    full = None if span is None else (0.0, float(span))
    printed = [ask(question, scene, rows[i], digits, full) for i in picked]
    if len(picked) < len(rows) and not all(t.method in ("formulas", "none") for t in printed):
        printed = [ask(question, scene, row, digits, full) for row in rows]
    values = np.reshape(values, (len(rows), *np.shape(values)[array.ndim - 1:]))
    if len(printed) == len(rows):
        values = np.array([old if t.values is None else t.values
                           for old, t in zip(values, printed)]).reshape(values.shape)
    judged = [t for t in printed if t.digits is not None]
    worst = min(judged, key=lambda t: t.digits or 0.0) if judged else printed[0]
    sampled = SAMPLED(checked=len(printed), states=len(rows)) if len(printed) < len(rows) else None
    shape = array.shape[:-1]
    texts = (None if worst.decimals is None
             else np.array([t.decimals for t in printed],
                           dtype=object).reshape((*shape, *np.shape(worst.decimals))))
    return replace(worst, values=values.reshape((*shape, *values.shape[1:])),
                   reason=worst.reason.then(sampled), decimals=texts)


# -- motions without a reduction


def _by_return(question: str, scene: AnyScene, resolved: Any, digits: int, state: Any) -> Told:
    """A closed motion: its return in doubles against the return of a Taylor series in many digits."""
    values = number_of(question, resolved)
    if beside_rest(scene.quadratic(), state):
        return _by_small_loop(question, scene.quadratic(), values, digits, state)
    exact: Any = reference(scene, state, [0.5 * resolved.period], orbit=True)
    if exact.period is None:
        return Told(question, values, digits, 0.0, "run",
                    reason=NO_RETURN_IN_DIGITS)
    with working(400) as numbers:
        add = lambda pair: numbers.ball(float(pair[0])) + numbers.ball(float(pair[1]))
        result = (add(exact.period) if question == "period"
                 else [[add(v) for v in pair] for pair in exact.extremes])
        # two doubles hold 32 digits
        own = max(exact.period[2] if question == "period" else exact.extremes_error, 1e-31)
        error = max(gap_of(values, result), own)
        pair: dict[str, Filling] = {"fewer": int(exact.digits[0]), "more": int(exact.digits[1])}
        if digits <= DOUBLE_DIGITS and error <= 10.0**-digits:
            reason = RETURN_OF_RUN(**pair, error=Quantity(error, digits=2))
            return Told(question, values, digits, digits_of(error), "run", reason=reason)
        return of_balls(question, result, digits, digits_of(own, 31.0), "many digits",
                         RETURN_OF_SERIES(**pair, error=Quantity(own, digits=1)))


def _by_small_loop(question: str, form: QuadraticForm, values: Any, digits: int, state: Any) -> Told:
    """A closed motion that starts next to an equilibrium: two runs of its series from the start, the second
    with more digits."""
    more = max(digits, DOUBLE_DIGITS) + 8
    with working(2 * int(3.33 * more) + 400):
        rows = [loop and loop[question != "period"]
                 for loop in (small_loop(form, state, n) for n in (more, more + 8))]
        if None in rows:
            return Told(question, values, digits, 0.0, "run",
                        reason=NO_RETURN_IN_DIGITS)
        error = max(_balls_apart(rows[1], rows[0]), 10.0**-more)
        if digits <= DOUBLE_DIGITS and (gap := max(gap_of(values, rows[1]), error)) <= 10.0**-digits:
            return Told(question, values, digits, digits_of(gap), "run",
                        reason=SERIES_FROM_START(error=Quantity(gap, digits=2)))
        return of_balls(question, rows[1], digits, digits_of(error, more), "many digits",
                         TWO_SERIES(error=Quantity(error, digits=1)))


def _over_span(scene: AnyScene, state: Any, span: Any, resolved: Motion, digits: int, exact: Exact3 | None,
               slack: float) -> Told:
    """The extremes over the span: by a second run where its difference from the first is small enough, else
    in many digits. slack: digits that may be missing."""
    if resolved.extremes is None or span is None and resolved.bounds:
        return nothing("extremes", digits, resolved.over)
    if scene.variables != "scaled":  # a force at the centre of mass does not turn the body
        scene = Scene(scene.body, *(e for e in scene.effects if e.name != "body_force"))
    length = reach_of(span) or 0.0
    equations, start = equations_and_start(scene, resolved.at)
    # a spin-up may have been run on to where its least rate is certain
    length = max(length, resolved.evidence.get("span", length))
    values = np.array(resolved.extremes)
    other = roots_of_rates(scene, moved_row(start), length, 8 * TAYLOR_TOLERANCE)
    error = CAUTION * _apart(values, other.extremes()) if not other.reason else math.inf
    reason = MOVED_RUN(rtol=Quantity(8 * TAYLOR_TOLERANCE, digits=2),
                       error=Quantity(error / CAUTION, digits=2))
    if digits <= DOUBLE_DIGITS and error <= 10.0 ** (slack - digits):
        return Told("extremes", values, digits, digits_of(error), "run", reason=reason)
    left = time_left(scene)
    one_law = left is None or left >= length
    result = (_many_digits(equations, [*(exact or start[:3]), *start[3:]], length, digits)
             if one_law else None)
    return (_unbounded_again(result, values) if result
            else Told("extremes", values, digits, digits_of(error), "run",
                      reason=as_reason(other.reason or reason)))


def _apart(values: Any, other: Any) -> float:
    """Largest distance of what is finite among the values from the other's, relative to the size of its
    component."""
    finite = np.isfinite(values)
    size = np.where(finite, np.abs(values), 0.0).max(axis=-1, keepdims=True)
    return float((np.where(finite, np.abs(np.where(finite, values, 0.0) - other),
                           0.0) / np.where(size > 0, size, 1.0)).max())


def _unbounded_again(text: Told, values: Any) -> Told:
    """What a run found, with the entries that are known to be infinite."""
    resolved = values.tolist()

    def put(result: Any, kind: Callable[[Any], Any]) -> tuple[tuple[Any, ...], ...]:
        return tuple(tuple(kind(old) if math.isinf(old) else new for new, old in zip(*both))
                     for both in zip(result, resolved))
    return replace(text, values=put(text.values, float), decimals=text.decimals and put(text.decimals, str))


def _many_digits(equations: Equations, start: Sequence[Number], length: float, digits: int) -> Told | None:
    """Extremes over the span by a Taylor series, each precision checked by the one before; None where the
    work allowed is not enough."""
    recursion, before = Recursion(equations), None
    for n in RUN_DIGITS:
        budget = [WORK // 12 if before is None else WORK // 4]  # the second run costs twice the first
        with working(int((n + GUARD) * 3.33)) as numbers:
            try:
                now = _series_extremes(recursion, start, length, n, budget, numbers)
            except Exhausted:
                return None
            error = max(_balls_apart(now, before), 10.0**-n) if before else 1.0
            if before and error <= 10.0**-digits:
                return of_balls("extremes", now, digits, digits_of(error, n), "many digits",
                                 TWO_PRECISIONS(error=Quantity(error, digits=1)))
            before = now
    return None


def _balls_apart(now: Any, before: Any) -> float:
    """Largest distance of balls, relative to the size of their component."""
    return max(float(abs(a - b) / abs(size)) if size != 0 else 0.0
               for (a, size), (b, _) in zip(each_of(now), each_of(before)))


def _series_extremes(recursion: Recursion, start: Sequence[Number], length: float, digits: int,
                     budget: list[int], numbers: Digits) -> list[list[Any]]:
    pairs, left = [[numbers.ball(v)] * 2 for v in start[:3]], numbers.ball(length)
    taken, begun = 0, budget[0]
    for step in steps(recursion, start, digits, budget, numbers):
        work = widen(pairs, step, min(step.length, left))
        budget[0] -= max(SEARCH * len(pairs) * len(step.rows[0]), work)
        left, taken = (left - step.length).mid(), taken + 1
        if left <= 0:
            break
        if hopeless(left, step.length, taken, begun, budget[0]):
            raise Exhausted
    return pairs
