"""One motion under a torque of any direction, followed until its spin-up is certified."""
from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from ...asked import checked_scene
from ...numbers.numba_door import wanted
from ...orbit import one_state as law
from ...orbit.reduction import reduce
from ...orbit.result import Fate
from ...physics.coefficients import effective
from ...physics.scene import AnyScene
from ...physics.state import three_floats
from ..enclosure.proof import proved
from .cause import seen
from .chase import Chased, chase
from .clock import Trap
from .fields import natural, tests_of
from .island import recurs
from .island import words as island_words
from .result import SpinUp
from .symmetric import exactly

NATURAL_TIMES, BUDGET = 1e9, 600_000
FARTHEST = 1e150  # natural units: a run in doubles holds no squares of larger rates


def spin_up(scene: AnyScene, state: Any, t_max: float | None = None, budget: int | None = None, after: float = 0.0, proof: bool = False,
            tell: Callable[..., Any] | None = None, fast: bool | None = None) -> SpinUp:
    """Whether and how the motion from a state spins up, decided by a certificate (`certificate`, `symmetric`) or not at all.

    scene: gyrostat and constant torque, physical or scaled. state: three rates at t = 0, taken at their word. t_max: how long the motion
    is followed, in the scene's time (None: 1e9 natural units, of the root of mean moment over torque); budget: in how many steps
    (None: 600,000). Slow drifts are run over many revolutions at once (`way`). after: the inequality is to hold for a state at this
    time or later: bounds and clocks of a later trap are narrower.
    proof: enclose the way to the inequality, so that nothing rests on a run in machine precision: level "proved" where that succeeds. A state
    of Fractions or of decimals in strings is then taken exactly. tell(time, steps, motions left): called on the way. fast: True for
    steps and tests compiled by numba; loading it costs a second, so for one state NumPy serves unless proof is asked for, which
    loads it anyway. The two have steps of slightly different lengths, so they fire at slightly different times.
    Raises InputError for scenes with other effects than turn the body as wheel and torque do, and for states that are none.
    """
    given, scene, state = state, effective(checked_scene(scene)), three_floats(state)
    scene.quadratic()  # says which effect of the scene is not covered
    if answer := exactly(scene, state):
        return answer
    own, unit = natural(scene)
    tests = tests_of(own)
    if not tests:
        return SpinUp(Fate.UNDECIDED, 0, 0, None, "undecided", None, 0.0, state, 0, seen(scene, state), 1.0)
    if not follows(state, unit):
        words = f"a rate exceeds {FARTHEST:g} natural units of {unit:.3g} 1/{scene.time_unit}: no run in doubles holds it"
        return SpinUp(Fate.UNDECIDED, 0, 0, None, "undecided", None, 0.0, state, 0, words, 1.0)
    loops = wanted(1, fast, proof, 2, 1)
    found = chase(own, tests, np.array([state]) / unit, NATURAL_TIMES if t_max is None else t_max * unit, BUDGET if budget is None else budget, after * unit,
                  tell and (lambda t, steps, left: tell(t / unit, steps, left)), loops)
    answer = kept_by_law(scene, state, answer_of(scene, unit, found, 0))
    return proved(scene, given if isinstance(given, (list, tuple)) else state, answer, fast=loops) if proof else answer


def kept_by_law(scene: AnyScene, state: tuple[float, ...], answer: SpinUp) -> SpinUp:
    """The answer, or, where no inequality came true and the law of a torque along a principal axis keeps the motion bounded, that."""
    if answer.fate != Fate.UNDECIDED or reduce(scene) is None:
        return answer
    known = law.motion(scene, state, brief=True)
    if known.fate not in (Fate.BOUNDED, Fate.EQUILIBRIUM):
        return answer
    return replace(answer, fate=Fate.BOUNDED, level="exact", cause=f"bounded by the law of a torque along a principal axis: {known.because}")


def follows(state, unit: float) -> bool:
    """Whether a run in doubles can hold a state; unit: one natural unit of rates in those of the state."""
    return all(abs(v) / FARTHEST < unit for v in state)


def answer_of(scene, unit: float, found: Chased, row: int) -> SpinUp:
    """The answer of one row of what `chase` found."""
    t, state = float(found.t[row]) / unit, tuple((found.states[row] * unit).tolist())
    steps, condition, passed = int(found.steps[row]), float(found.condition[row]), float(found.passed[row])
    if found.fired[row] < 0 and not math.isfinite(t):
        words = f"a run in doubles broke off after {steps} steps, as its numbers left their range: nothing is seen of the motion"
        return SpinUp(Fate.UNDECIDED, 0, 0, None, "undecided", None, t, state, steps, words, condition, passed)
    if found.fired[row] < 0:
        recurrent = recurs(found.largest[row].tolist(), found.least[row].tolist(), steps)
        words = (f"{seen(scene, state, island_words(scene, t) if recurrent else '')}; followed for {t:.6g} {scene.time_unit}, {steps} steps, over which a "
                 f"small change grew {condition:.3g} times")
        if not condition * (1 + passed) * 2.0**-52 < 1 / 16:
            words += ": more than a run in doubles can tell"
        return SpinUp(Fate.UNDECIDED, 0, 0, None, "undecided", None, t, state, steps, words, condition, passed)
    field, orders = found.tests.asked[found.fired[row]]
    trap = Trap(field, field.name, orders, *map(float, found.constants[:, row]), unit, t, float(found.blur[row]) / unit)  # type: ignore[call-arg]  # six constants
    direction = tuple(field.basis[0].tolist())
    axis, sense = (0, 1) if field.axis is None else (field.axis + 1, field.sense)
    where = "in the equator, across the axis of symmetry" if not axis else f"about axis {axis}"
    words = f"spin-up {where} is certified about the {field.name} at orders {orders[0]} and {orders[1]}: the inequality holds for ever"
    return SpinUp(Fate.SPIN_UP, axis, sense, direction, "certified", trap, t, state, steps, words, condition, passed)
