"""Motions without a torque that no orbit serves: a gyrostatic moment with no zero component. They are closed,
and one return to the first extreme gives the period and every extreme.

Squares of rates beyond some 1e150 are no doubles. Such a motion is followed in its own unit 2^k of rate,
where its numbers are of order one: with rates and gyrostatic moment over u the motion is the same in a time
that runs u times as fast, and for a power of two the change is exact. What is no double in the scene's own
units in the end is NaN in arrays, and said in words of one motion.
"""
from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import numpy as np

from ..errors import InputError
from ..integrate.events import RateRoots, roots_of_rates
from ..orbit.fate import as_double, at_rest, free_fate, scaled_double
from ..orbit.fate_arrays import fates as free_fates
from ..orbit.one_state import LOST, NONE_IN_DOUBLES, powered
from ..orbit.result import (
    ALL_TIME,
    BOX,
    OVER_SPAN,
    ROUND,
    Fate,
    Motion,
    Needs,
    finite,
    judged,
    pairs,
    repeats,
)
from ..orbit.separatrix.distance import has_no_saddle
from ..physics.coefficients import three_floats
from ..physics.own_unit import far, in_unit, mass_unit, own_exponent
from ..physics.scene import QuadraticForm, Scene, rests
from ..physics.states import equilibrium_mask, three_numbers
from ..reasons import Reason, Sentence, Span
from .evidence import STEP_BUDGET
from .near_rest import beside_rest, small_loop

NO_BRANCHES = Sentence(
    "no-branches-of-free-gyrostat", "not known: the separatrix of a free gyrostat whose moment has no zero "
    "component is known by its energy on each momentum sphere, not as branches")()
NO_SEPARATRIX_OF_SPHERE = Sentence(
    "sphere-without-separatrix", "with three equal moments there is no separatrix")()
# Two points of a closed orbit are the same where they agree to this share of the orbit's size.
SAME_POINT = 1e-9


PERIOD_OPEN = Sentence("period-open", "its period is not known: {why}")
NO_RETURN = Sentence("no-return", "no return within {steps} steps: next to a separatrix")
DOES_NOT_RETURN = Sentence("separatrix-no-return", "on a separatrix it does not return")()
RESTS = Sentence("rests-exactly", "equilibrium: every angular acceleration is exactly 0")()
CLOSED_SMALL = Sentence(
    "closed-small", "no torque: the motion is closed and periodic; followed in many digits, as its rates are "
    "small")()
CLOSED_MOTION = Sentence("closed-motion", "no torque: the motion is closed and periodic")()


@dataclass(frozen=True)
class PeriodExtremes:
    """extremes: (3, 2) over `over` (all time or the span searched); period: inf on a separatrix, NaN where
    no return was found."""

    extremes: np.ndarray
    period: float
    over: Reason
    reason: Reason


def extremes_over_period(scene, state) -> PeriodExtremes:
    """Period and extremes of a motion without torque (any gyrostatic moment), from one return to its first
    extreme.

    Each extreme is polished on the two invariants of the state, so it does not carry the run's drift. An
    equilibrium has period 0; a motion on a separatrix has period inf, one next to it that does not return
    within the step budget NaN, and their extremes are over the span run. Numbers that are no doubles are NaN.
    Raises InputError where a torque acts, and where rates and gyrostatic moment are so far apart that no unit
    makes doubles of both.
    """
    form, supplied = scene.quadratic(), list(state)
    state = three_numbers(state)
    if any(form.m):
        raise InputError("the period by return is for motions without torque; this scene has one")
    exact = [Fraction(v) for v in supplied]
    if not any(form.rate(exact)):
        return PeriodExtremes(np.stack([state, state], axis=1), 0.0, ALL_TIME, RESTS)
    k, mass = far(own_exponent(exact, form.rate(exact))) or 0, mass_unit(scene)
    if k or mass != 1:
        unit = Fraction(2) ** k
        scene, exact, state = in_unit(scene, unit,
                                      mass), [v / unit
                                              for v in exact], np.array([as_double(v / unit) for v in exact])
    form = scene.quadratic()
    if beside_rest(form, exact) and (loop := small_loop(form, exact)):
        period, swings = loop
        return PeriodExtremes(np.array([[scaled_double(v, k) for v in pair] for pair in swings]),
                              _no_double_is_nan(scaled_double(period, -k)),
                              ALL_TIME, CLOSED_SMALL)
    tied = scene.variables == "physical" and free_fate(scene, exact).label == Fate.SEPARATRIX
    follow = _without_return if tied else _by_return
    return _in_scene_unit(follow(scene, form, state, k), k)


def _no_double_is_nan(period: float) -> float:
    """A period that is known; NaN where its double is 0 or inf, which say something else."""
    return period if 0 < period < math.inf else math.nan


def _in_scene_unit(result: PeriodExtremes, k: int) -> PeriodExtremes:
    """What was found in the unit 2^k, in the scene's own."""
    if not k:
        return result
    with np.errstate(over="ignore", under="ignore"):
        box = np.ldexp(result.extremes, k)
    return replace(result, extremes=np.where(np.isfinite(box), box, np.nan),
                   period=result.period if math.isinf(result.period) else powered(result.period, -k))


def _by_return(scene: Scene, form: QuadraticForm, state: np.ndarray, k: int) -> PeriodExtremes:
    """By a run to the first return; extremes and period in the unit 2^k of the scene asked for, in which this
    one is, words in its own."""
    span, roots = _first_span(form, state), None
    while roots is None or (roots.steps < STEP_BUDGET and not roots.reason):
        roots = roots_of_rates(scene, state, span)
        closing = _return(roots, state)
        if closing is not None:
            return _one_period(scene, roots, closing)
        span *= 4
    return PeriodExtremes(roots.extremes(), math.nan,
                          OVER_SPAN(span=Span(0.0, powered(roots.t_reached, -k), scene.time_unit)),
                          NO_RETURN(steps=roots.steps))


def _without_return(scene: Scene, form: QuadraticForm, state: np.ndarray, k: int) -> PeriodExtremes:
    """On a separatrix: a run would leave it by its rounding and return, which the motion never does."""
    roots = roots_of_rates(scene, state, _first_span(form, state))
    return PeriodExtremes(roots.extremes(), math.inf,
                          OVER_SPAN(span=Span(0.0, powered(roots.t_reached, -k), scene.time_unit)),
                          DOES_NOT_RETURN)


def _first_span(form: QuadraticForm, x: np.ndarray):
    """A few turns: the inverse of the largest frequency that the Jacobian can show at this size."""
    size = np.abs(x).max()
    kappa, rho, sigma, _ = form.coefficients
    return 40.0 / (size * max(map(abs, kappa)) + max(map(abs, (*rho, *sigma))))


def _return(roots: RateRoots, state: np.ndarray):
    """Index of the root at which the motion is back at its first root; None where it is not."""
    if not len(roots.t):
        return None
    size = max(np.ptp(np.vstack([roots.states, state]), axis=0).max(), 1e-300)
    apart = np.abs(roots.states[1:] - roots.states[0]).max(axis=1)
    same = (roots.component[1:] == roots.component[0]) & (apart <= SAME_POINT * size)
    result = np.nonzero(same)[0]
    return int(result[0]) + 1 if result.size else None


def _one_period(scene: Scene, roots: RateRoots, closing: int):
    inertia, momentum = _quadrics(scene)
    polished = np.array([_polish(scene.quadratic(), inertia, momentum, roots.start, x, i)
                         for x, i in zip(roots.states[:closing], roots.component[:closing])])
    extremes = np.stack([roots.start, roots.start], axis=1)
    for i in range(3):
        values = polished[roots.component[:closing] == i, i]
        if values.size:
            extremes[i] = values.min(), values.max()
    return PeriodExtremes(extremes, float(abs(roots.t[closing] - roots.t[0])), ALL_TIME,
                          CLOSED_MOTION)


def _quadrics(scene: Scene):
    """Two invariants w . x^2 / 2 + l . x of the free motion: ((w, l), (w, l))."""
    if scene.variables == "physical":
        D, lam = np.array(scene.body.inertia), np.array([float(v) for v in scene.vector("gyrostat")])
        return (D, 0 * lam), (D * D, D * lam)
    a, b = scene.a, scene.b
    return (np.array([1.0, 1.0, 0.0]), np.array([a, 0, 0])), (np.array([1.0, 0.0, -1.0]), np.array([b, 0, 0]))


def _polish(form: QuadraticForm, first: Sequence[np.ndarray], second: Sequence[np.ndarray], start: np.ndarray,
            x: np.ndarray, i: int):
    """Newton on rate_i = 0 and the two invariants of `start`, differences formed as products; x where it does
    not help."""
    better = x.copy()
    for _ in range(3):
        residual = [w @ ((better - start) * (better + start)) / 2 + l @ (better - start) for w,
                    l in (first, second)]
        matrix = np.array([w * better + l for w, l in (first, second)] + [form.jacobian(better.tolist())[i]])
        scale = np.abs(matrix).max(axis=1)
        if not (scale > 0).all():
            return x
        try:
            better = (better - np.linalg.solve(matrix / scale[:, None],
                                               np.array([*residual, form.rate(better.tolist())[i]]) / scale))
        except np.linalg.LinAlgError:
            return x
    return better if np.abs(better - x).max() <= 1e-9 * np.abs(x).max() else x


def motion(scene, state, span=None, exact=None, needs: Needs = Needs.ALL) -> Motion:
    """See `answers.motion`: the motion is closed, and one return gives its period and every extreme."""
    state = three_floats(state)
    supplied = exact or state
    decided = free_fate(scene, supplied)
    fields: dict[str, Any] = {"velocity_reason": NO_BRANCHES}
    if decided.label == Fate.SEPARATRIX:
        fields = {"margin_velocity": 0.0, "velocity_bounds": (0.0, 0.0), "velocity_witness": state}
    elif has_no_saddle(scene):
        fields = {"velocity_reason": NO_SEPARATRIX_OF_SPHERE}
    lost, open_ = ["the margin in energy"] if math.isnan(decided.margin) else [], None
    if rests(scene.quadratic(), supplied):
        decided = at_rest(scene, decided)
        fields["extremes"] = tuple((v, v) for v in state)
    elif needs & (BOX | ROUND):
        closed = extremes_over_period(scene, supplied)
        open_ = closed.reason if math.isnan(closed.period) and closed.over != ALL_TIME else None
        full = bool(np.isfinite(closed.extremes).all())
        lost += ([] if full else ["an extreme"]) + (["the period"] if math.isnan(closed.period)
                                                     and closed.over == ALL_TIME else [])
        fields |= {"extremes": pairs(closed.extremes) if full else None, "period": repeats(closed.period),
                   "returns": closed.period,
                   "over": closed.over if full else NONE_IN_DOUBLES}
    resolved = judged(state, decided)
    resolved["reason"] = resolved["reason"].then(PERIOD_OPEN(why=open_) if open_ else None).then(
        LOST(what=", ".join(lost)) if lost else None)
    return Motion(margin_energy=finite(decided.margin), **(resolved | fields))


def fates(scene, states, fast: bool | None = None):
    """FateResult of states (n, 3): the free body's energy against that of its saddles."""
    return free_fates(scene, states, fast)


def extremes(scene, states, span=None, fast: bool | None = None):
    """(n, 3, 2) over all time; NaN on a separatrix and next to it, where a run shows its own span alone
    (`extremes_over_period`)."""
    rest = equilibrium_mask(scene, states)
    resolved = (np.stack([s, s], axis=1) if still else _for_all_time(extremes_over_period(scene, s)) for s,
             still in zip(states, rest))
    return np.array(list(resolved)).reshape(-1, 3, 2)


def _for_all_time(result: PeriodExtremes) -> np.ndarray:
    return result.extremes if result.over == ALL_TIME else np.full((3, 2), np.nan)


def periods(scene, states, fast: bool | None = None):
    """(n,); 0 at an equilibrium, inf on a separatrix, NaN where no return is found next to it."""
    rest = equilibrium_mask(scene, states)
    return np.array([0.0 if still else extremes_over_period(scene, s).period for s,
                     still in zip(states, rest)])
