"""Motions under a torque of any direction, followed until their spin-up is certified: one loop serves one
state and many.

Beside each motion a small change tells by how much the way magnifies it (`drift`), and with it how far the
run's rounding may have carried the motion from the true one: a certificate counts when it holds for the whole
ball of that radius about the state. What rounding does along the motion is a delay: it alters the time at
which the inequality holds, given as the blur of the clock, and nothing else.
"""
from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np

from ...integrate.guard import too_far, why_given_up
from ...numbers.exact import floats
from ...orbit import one_state
from ...orbit.reduction import reduce
from ...orbit.result import Fate, Needs
from ...physics.coefficients import effective, three_floats
from ...physics.own_unit import natural
from ...physics.scene import AnyScene
from ...physics.states import checked_states
from ...reasons import Axis, Quantity, Reason, Sentence
from ...validation import checked_scene
from ..enclosure import proved
from .certificate import ADVANCE, DECIDE, Certifier, Tests, exactly, tests_of
from .drift import Leaps, Runs
from .form import island, recurs, seen
from .result import SpinUp, Trap

if TYPE_CHECKING:
    from .centres import FixedCentre, MovingCentre

NATURAL_TIMES, BUDGET = 1e9, 600_000
# steps that show the pace of a motion, where it is followed to a time that somebody names
SETTLED = 1_000_000
FARTHEST = 1e150  # natural units: a run in doubles holds no squares of larger rates
# s of a processor: a step of one motion in plain Python, and a test of one
STEP, TEST = 5e-5, 1.2e-4
LEVELS = ("undecided", "certified", "exact", "proved")
# steps between tests: a share of those before (early, later), at least and at most so many
FIRST, EARLY, SHARES, MOST = 4, 600, (0.25, 0.1), 2000
# Which tests a stage asks: (every so many stages, from so many steps on, name in `Tests`), the last that
# applies. What costs more comes later.
LAST = 20_000
PLAN = ((1, 0, "often"), (3, 48, "high"), (4, 3000, "all"), (8, LAST, "last"))


RATE_TOO_LARGE = Sentence(
    "rate-too-large", "a rate exceeds {most} natural units of {unit}: no run in doubles holds it")
BOUNDED_BY_LAW = Sentence("bounded-by-law", "bounded by the law of a torque along a principal axis")()
BROKE_OFF = Sentence(
    "run-broke-off", "a run in doubles broke off after {steps} steps, as its numbers left their range: "
    "nothing is seen of the motion")
FOLLOWED = Sentence(
    "followed", "followed for {time}, {steps} steps, over which a small change of the start grew {growth} "
    "times")
ROUNDING_DECIDES = Sentence("rounding-decides",
                            "so that rounding errors decide what a run shows at its end")()
CERTIFIED_ABOUT = Sentence(
    "spin-up-certified", "spin-up about {axis} is certified: an inequality that the motion meets holds for "
    "ever")
CERTIFIED_EQUATOR = Sentence(
    "spin-up-in-equator-certified", "spin-up in the equator, across the axis of symmetry, is certified: an "
    "inequality that the motion meets holds for ever")()
BY_INEQUALITY = Sentence(
    "inequality-orders", "the inequality is that of the normal form about the {form}, energy to order "
    "{energy}, amplitude to order {amplitude}")


@dataclass
class Chased:
    """Columns (n,): which test fired (-1 none) as index into `tests.asked`, time, steps, condition, state
    there; constants (6, n) of it; largest and least (n, 48) size of the state during each doubling of the
    steps; passed: steps that the way takes one by one; blur: of the time; reach: how far from the state the
    rounding may have carried the true one; given_up: row -> why it was not followed to its time."""

    tests: Tests
    fired: np.ndarray
    t: np.ndarray
    steps: np.ndarray
    condition: np.ndarray
    states: np.ndarray
    constants: np.ndarray
    largest: np.ndarray
    least: np.ndarray
    passed: np.ndarray
    blur: np.ndarray
    reach: np.ndarray
    given_up: dict[int, Reason] = field(default_factory=dict)
    # of each test that was asked: itself, its index, and what it works in
    tools: dict[tuple, tuple[Certifier, int, tuple[np.ndarray, ...]]] = field(default_factory=dict)


def chase(scene: AnyScene, tests: Tests, starts: np.ndarray, t_max: float, budget: int, after: float = 0.0,
          tell: Callable[..., Any] | None = None, fast: bool | None = None) -> Chased:
    """Follow the motions from starts (n, 3) of a scene in natural units, each until a test fires at a time no
    earlier than `after`, t_max, or `budget` steps. tell(least time, steps, motions left): called after every
    stage. fast: steps are taken and judged by compiled loops; None: from where these pay (`Kernel`)."""
    n = len(starts)
    runs = Runs(scene, starts)
    out = Chased(tests, np.full(n, -1), runs.times, runs.steps, np.ones(n), runs.states,
                 np.full((6, n), np.nan), np.zeros((n, 48)), np.full((n, 48), np.inf),
                 runs.rounded, runs.twins.blur, np.zeros(n))
    open_, stage, leaps, leapt, counted = np.arange(n), 0, Leaps(runs), np.arange(0), 0
    while open_.size:
        runs.fast = ADVANCE.pays(STEP * (runs.counted - counted), fast)
        counted = runs.counted
        over = runs.measure(open_, out, t_max, budget)
        ready = open_ if after <= 0 else open_[out.t[open_] >= after]
        which = [name for every, since, name in PLAN if stage % every == 0 and runs.steps_done >= since][-1]
        # rows that have just leapt: a test costs less than what they passed
        far = np.intersect1d(ready, leapt) if leapt.size else leapt
        _ask(out, np.setdiff1d(ready, far) if far.size else ready, getattr(tests, which), fast)
        if far.size:
            _ask(out, far, tests.last, fast)
        left = out.fired[open_] < 0
        if not left.all():
            open_, over = open_[left], over[left]
        if budget > BUDGET:
            over |= _hopeless(out, open_, t_max, budget)
        if over.any():  # the last word is that of all tests that so much work is worth
            request = tests.last if runs.steps_done >= LAST else tests.all
            _ask(out, open_[over & (out.t[open_] >= after)], request, fast)
            open_ = open_[~over]
        if open_.size:
            leapt = leaps.advance(open_, t_max, after)
            rows = np.setdiff1d(open_, leapt) if leapt.size else open_
            if rows.size:
                fraction = SHARES[runs.steps_done >= EARLY]
                runs.advance(rows,
                             int(min(max(FIRST, runs.steps_done * fraction), MOST,
                                     max(1, budget - runs.steps[rows].min()))), t_max, after, budget)
            if tell:
                tell(float(out.t[open_].min()), runs.steps_done, open_.size)
        stage += 1
    return out


def _hopeless(out: Chased, rows: np.ndarray, t_max: float, budget: int):
    """(m,) which of rows cannot come to a time that somebody names, for which many steps are allowed."""
    result = np.zeros(len(rows), bool)
    for n, row in enumerate(rows.tolist()):
        steps, t = int(out.steps[row]), float(out.t[row])
        left = steps * (t_max - t) / t if t > 0 else 0.0
        result[n] = steps >= SETTLED and too_far(steps, left, budget, SETTLED)
        if result[n]:
            out.given_up[row] = why_given_up(steps, left, budget)
    return result


def _ask(out: Chased, rows: np.ndarray, which: Sequence[tuple[FixedCentre | MovingCentre, tuple[int, int]]],
         fast: bool | None):
    """Ask tests for rows, one after another for those that none has fired for; what fires is written down."""
    left = rows.size
    for item in which:
        if not left:
            break
        if item not in out.tools:
            test = out.tests.certifier(*item, fast)
            out.tools[item] = test, out.tests.asked.index(item), test.work()
        test, number, work = out.tools[item]
        left = test.decide(rows, out.states, out.reach, out.fired, number, out.constants,
                           DECIDE.pays(TEST * left, fast), work)


def spin_up(scene: AnyScene, state: Any, t_max: float | None = None, budget: int | None = None,
            after: float = 0.0, proof: bool = False,
            tell: Callable[..., Any] | None = None, fast: bool | None = None) -> SpinUp:
    """Whether and how the motion from a state spins up, decided by a certificate (`certificate`)
    or not at all.

    scene: gyrostat and constant torque, physical or scaled. state: three rates at t = 0, taken at their word.
    t_max: how long the motion is followed, in the scene's time (None: 1e9 natural units, of the root of mean
    moment over torque); budget: in how many steps (None: 600,000). Slow drifts are run over many revolutions
    at once (`drift`). after: the inequality is to hold for a state at this time or later: bounds and clocks
    of a later trap are narrower. proof: enclose the way to the inequality, so that nothing rests on a run in
    machine precision: level "proved" where that succeeds. A state of Fractions or of decimals in strings is
    then taken exactly. tell(time, steps, motions left): called on the way. fast: True for loops compiled by
    numba, False for the same loops as they are written, None for these until the steps of this process
    repay loading what is compiled. The motions are the same to the last bit. Raises InputError for scenes
    with other effects than turn the body as wheel and torque do, and for states that are none.
    """
    supplied, scene, state = state, effective(checked_scene(scene)), three_floats(state)
    scene.quadratic()  # says which effect of the scene is not covered
    if answer := exactly(scene, state):
        return answer
    own, unit = natural(scene)
    tests = tests_of(own)
    if not tests:
        return SpinUp(Fate.UNDECIDED, 0, 0, None, "undecided", None, 0.0, state, 0, 1.0,
                      reason=seen(scene, state))
    if not follows(state, unit):
        reason = RATE_TOO_LARGE(most=Quantity(FARTHEST), unit=Quantity(unit, f"1/{scene.time_unit}", 3))
        return SpinUp(Fate.UNDECIDED, 0, 0, None, "undecided", None, 0.0, state, 0, 1.0, reason=reason)
    result = chase(own, tests, np.array([state]) / unit, NATURAL_TIMES if t_max is None else t_max * unit,
                  BUDGET if budget is None else budget, after * unit,
                  tell and (lambda t, steps, left: tell(t / unit, steps, left)), fast)
    start = supplied if isinstance(supplied, (list, tuple)) else state
    answer = kept_by_law(scene, start, answer_of(scene, unit, result, 0))
    return proved(scene, start, answer, fast=DECIDE.pays(0.0, fast)) if proof else answer


def kept_by_law(scene: AnyScene, state: Sequence[Any], answer: SpinUp) -> SpinUp:
    """The answer, or, where no inequality came true and the law of a torque along a principal axis keeps the
    motion bounded, that."""
    if answer.fate != Fate.UNDECIDED or reduce(scene) is None:
        return answer
    exactly_at = tuple(map(Fraction, state))  # next to a separatrix the double may lie on its other side
    resolved = one_state.motion(scene, floats(exactly_at), exact=exactly_at, needs=Needs.FATE)
    if resolved.fate not in (Fate.BOUNDED, Fate.EQUILIBRIUM):
        return answer
    return replace(answer, fate=Fate.BOUNDED, level="exact",
                   reason=BOUNDED_BY_LAW.then(resolved.reason, ": "))


def follows(state: Sequence[float], unit: float) -> bool:
    """Whether a run in doubles can hold a state; unit: one natural unit of rates in those of the state."""
    return all(abs(v) / FARTHEST < unit for v in state)


def answer_of(scene: AnyScene, unit: float, result: Chased, row: int) -> SpinUp:
    """The answer of one row of what `chase` found."""
    t, state = float(result.t[row]) / unit, tuple((result.states[row] * unit).tolist())
    steps, condition, passed = int(result.steps[row]), float(result.condition[row]), float(result.passed[row])
    if result.fired[row] < 0 and not all(map(math.isfinite, (t, *state))):
        return SpinUp(Fate.UNDECIDED, 0, 0, None, "undecided", None, t, state, steps, condition, passed,
                      reason=BROKE_OFF(steps=steps))
    if result.fired[row] < 0:
        recurrent = recurs(result.largest[row].tolist(), result.least[row].tolist(), steps)
        reason = seen(scene, state, island(scene, t) if recurrent else None).then(FOLLOWED(
            time=Quantity(t, scene.time_unit).lower, steps=steps, growth=Quantity(condition, digits=3)))
        if not condition * (1 + passed) * 2.0**-52 < 1 / 16:
            reason = reason.then(ROUNDING_DECIDES, ", ")
        if row in result.given_up:
            reason = reason.then(result.given_up[row])
        return SpinUp(Fate.UNDECIDED, 0, 0, None, "undecided", None, t, state, steps, condition,
                      passed, reason=reason)
    field, orders = result.tests.asked[result.fired[row]]
    trap = Trap(field, field.name, orders, *map(float, result.constants[:, row]), unit, t,
                float(result.blur[row]) / unit)  # type: ignore[call-arg]  # six constants
    direction = tuple(field.basis[0].tolist())
    axis, sense = (0, 1) if field.axis is None else (field.axis + 1, field.sense)
    reason = (CERTIFIED_ABOUT(axis=Axis(axis)) if axis else CERTIFIED_EQUATOR).then(
        BY_INEQUALITY(form=field.name, energy=orders[0], amplitude=orders[1]))
    return SpinUp(Fate.SPIN_UP, axis, sense, direction, "certified", trap, t, state, steps, condition,
                  passed, reason=reason)


@dataclass(frozen=True)
class SpinUps:
    """Columns (n,) of what `spin_up` says of each state.

    fate: int8 of `Fate`; axis: 1, 2, 3 or 0; sense: +1, -1 or 0; level: int8, index into LEVELS; t, steps,
    condition as of `SpinUp`, states (n, 3) at t;
    """

    fate: np.ndarray
    axis: np.ndarray
    sense: np.ndarray
    level: np.ndarray
    t: np.ndarray
    steps: np.ndarray
    condition: np.ndarray
    states: np.ndarray
    scene: AnyScene = field(repr=False)
    unit: float = field(repr=False)
    chased: Chased | None = field(repr=False)
    exact: tuple = field(repr=False)

    def row(self, number: int) -> SpinUp:
        """All that is known of one state: trap, cause, direction."""
        return (self.exact[number] if self.chased is None
                else answer_of(self.scene, self.unit, self.chased, number))


def spin_up_many(scene, states, t_max: float | None = None, budget: int | None = None, tell=None,
                 fast: bool | None = None,
                 proof: bool = False) -> SpinUps:
    """`spin_up` for states (n, 3), in batches; every motion leaves its batch as soon as it is decided. Limits
    as there. proof: enclose the way of each that is certified, one after another."""
    states, covered = checked_states(states).reshape(-1, 3), effective(checked_scene(scene))
    covered.quadratic()  # says which effect of the scene is not covered
    own, unit = natural(covered)
    tests = tests_of(own)
    # of all states of the scene or of none
    closed = bool(len(states)) and exactly(covered, states[0].tolist()) is not None
    if closed or not tests or not (np.abs(states) / FARTHEST < unit).all():
        return _of_rows(scene, (spin_up(scene, state, t_max, budget, fast=fast, proof=proof)
                                for state in states.tolist()))
    result = chase(own, tests, states / unit, NATURAL_TIMES if t_max is None else t_max * unit,
                  BUDGET if budget is None else budget,
                  tell=tell and (lambda t, steps, left: tell(t / unit, steps, left)), fast=fast)
    good = result.fired >= 0
    axes = np.array([0 if field.axis is None else field.axis + 1 for field, _ in tests.asked] + [0])
    senses = np.array([field.sense for field, _ in tests.asked] + [0])
    out = SpinUps(np.where(good, Fate.SPIN_UP, Fate.UNDECIDED).astype(np.int8),
                  axes[result.fired].astype(np.int8), senses[result.fired].astype(np.int8),
                  good.astype(np.int8), result.t / unit, result.steps, result.condition, result.states * unit,
                  scene, unit, result, ())
    by_law = not good.all() and reduce(covered) is not None
    if not by_law and not proof:
        return out
    return _of_rows(scene, (kept_by_law(covered, state, out.row(number)) if by_law
                            else proved(scene, state, out.row(number), fast=DECIDE.pays(0.0, fast))
                            for number, state in enumerate(states.tolist())))


def _of_rows(scene: AnyScene, supplied: Iterable[SpinUp]) -> SpinUps:
    """Columns of answers that were found one by one."""
    rows = tuple(supplied)
    kinds = np.array([(row.fate, row.axis, row.sense, LEVELS.index(row.level)) for row in rows], np.int8)
    columns = [np.array([getattr(row, name) for row in rows]) for name in ("t", "steps", "condition")]
    states = np.array([row.state for row in rows], float).reshape(-1, 3)
    return SpinUps(*kinds.reshape(-1, 4).T, *columns, states, scene, 1.0, None, rows)
