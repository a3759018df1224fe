"""Arrays of states of random scenes, by NumPy and compiled, against each state alone in balls: labels,
margins, extremes and periods keep what they promise, at every closeness to a separatrix."""
from __future__ import annotations

import math

import numpy as np
import pytest

import stabilab
from benchmarks.random_scenes import drawn
from stabilab import Fate
from stabilab.numbers.numba_door import installed
from stabilab.orbit.extremes import precise_extremes
from stabilab.orbit.extremes_arrays import extremes_and_periods
from stabilab.orbit.fate import decide, fate_of
from stabilab.orbit.one_orbit import Orbit
from stabilab.orbit.period import precise_period
from stabilab.orbit.reduction import reduce
from tests.hunt.disagreements import between
from tests.shared import later

# promised of extremes and periods, relative to themselves, and of margins, relative to kinetic energy and
# barrier
DIGITS, MARGIN = 1e-11, 1e-12
SCENES, STATES, FEW = 200, 300, 24
FAST = (False, True) if installed() else (False,)
DEFAULT = range(0, SCENES, 33)
numbers = pytest.mark.parametrize("number",
                                  [*DEFAULT, *later(n for n in range(SCENES) if n not in DEFAULT)])


def alone(scene, state):
    """(label, axis, sense, margin, extremes, period) of one state, all but the label from balls."""
    orbit = Orbit(reduce(scene), state)
    told = fate_of(scene, orbit)
    margin = decide(orbit).margin * reduce(scene).energy_unit if told.label != Fate.EQUILIBRIUM else 0.0
    box = [(v, v) for v in state] if told.label == Fate.EQUILIBRIUM else precise_extremes(orbit, told.label)
    return told, margin, np.array(box, float), precise_period(orbit, told.label)


def disagreements(number, count):
    """[(size in units of what is promised, words)] of the rows that part by more than that; the largest size
    of all."""
    one = drawn(number + 1)[number]
    scene, axis = one.scene, next(i for i in range(3) if one.torque[i])
    states = one.beside(one.states(count))
    singles = [alone(scene, state) for state in states.tolist()]
    wrong, largest = [], 0.0
    for fast in FAST:
        many, (boxes, periods) = stabilab.fate(scene, states,
                                               fast=fast), extremes_and_periods(scene, states, by_numba=fast)
        for n, (told, margin, box, period) in enumerate(singles):
            sizes = [_margins(many.margins[n], margin, 0.5 * one.moments[axis] * states[n, axis] ** 2),
                     *(between(*pair, "", DIGITS)[0] for pair in zip(boxes[n], box)),
                     between([periods[n]], [period], "", DIGITS)[0]]
            if (told.label, told.axis, told.sense) != (many.labels[n], many.axis[n], many.sense[n]):
                sizes.append(math.inf)
            largest = max(largest, *sizes)
            if max(sizes) > 1:
                wrong.append((max(sizes),
                              f"{one.name} from {states[n].tolist()}, fast={fast}: {told.label.word}, "
                              f"{Fate(int(many.labels[n])).word}; margins"
                                          f" {margin, many.margins[n]}, extremes "
                                          f"{box.tolist(), boxes[n].tolist()}, periods {period, periods[n]}"))
    return wrong, largest


def _margins(one, other, kinetic):
    if math.isfinite(one) and math.isfinite(other):
        return abs(one - other) / (MARGIN * (kinetic + abs(other + kinetic)))
    return 0.0 if math.isinf(one) == math.isinf(other) else math.inf


@numbers
def test_arrays_of_a_random_scene_answer_as_each_state_alone_in_balls(number):
    wrong, _ = disagreements(number, FEW)
    assert not wrong, wrong[0]
