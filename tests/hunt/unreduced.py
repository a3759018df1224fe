"""Scenes without a reduction, and how far a scene and its twin part: free gyrostats, torques with a
gyrostatic component along them, and torques between two equal moments."""
from __future__ import annotations

import math

import numpy as np

import stabilab
import stabilab.orbit.landscape
from stabilab import Fate
from stabilab.answers.motion import Needs
from stabilab.answers.motion import motion as motion_of
from stabilab.errors import InputError
from tests.hunt.disagreements import MARGIN, NO_QUESTION, WRONG, _twins_of, worst
from tests.hunt.problems import wide
from tests.oracles.pairs import physical

FASTEST = 30.0  # in the motion's own unit: beyond it a search for a certificate takes seconds and more


def problem_of(knobs):
    """(scene, oracle's model, state) of a point in [0, 1]^14."""
    pick = [min(max(float(v), 0.0), 1.0) for v in knobs]
    shape = [10.0 ** (2 * (v - 0.5)) for v in pick[1:4]]
    inertia = [sum(shape) - part for part in shape]
    momentum = [wide(v, 1.5) or 1.0 for v in pick[4:7]]
    if pick[0] < 1 / 3:
        torque = [0.0] * 3
    elif pick[0] < 2 / 3:
        axis = int(2.999 * pick[7])
        torque = [wide(pick[8], 1) if i == axis else 0.0 for i in range(3)]
        # no component across the torque: the standard form; else a run of a million units is the evidence
        if pick[9] > 0.05:
            momentum = [v if i == axis else 0.0 for i, v in enumerate(momentum)]
    else:
        inertia[1] = inertia[0]
        size = wide(pick[8], 1)
        torque = [3 * size, 4 * size, 0.0]
        momentum = [-4 * momentum[0], 3 * momentum[0], momentum[2] if pick[9] > 0.8 else 0.0]
    scene, problem = physical(inertia, momentum, torque)
    return scene, problem, tuple(wide(v, 2) for v in pick[10:13])


def unreduced(scene, problem, state):
    """Renamed, mirrored and rescaled twins: the same fate; where both margins are finite, the same margin."""
    if stabilab.orbit.landscape.landscape(scene) is not None:
        return NO_QUESTION
    torque = max((abs(float(v)) for v in problem.m), default=0.0)
    if max(map(abs, state)) > FASTEST * math.sqrt(torque) > 0:
        return NO_QUESTION
    one = stabilab.fate(scene, np.array([state]))
    found = [_against(one, problem, state, name, *made) for name, made in _twins_of(scene, state).items()]
    found.append(_alone(one, scene, state))
    return worst(*found)


def _against(one, problem, state, name, other, image, order, signs, rate, unit):
    two = stabilab.fate(other, np.array([image]))
    labels = {int(one.labels[0]), int(two.labels[0])}
    if len(labels) > 1 and Fate.UNDECIDED not in labels:
        return WRONG, f"{name}: {[Fate(v).word for v in labels]}"
    if Fate.UNDECIDED in labels:
        return NO_QUESTION  # rounding decides which of two neighbours is told
    if one.axis[0]:
        axis, sense = order.index(int(one.axis[0]) - 1), int(one.sense[0]) * signs[int(one.axis[0]) - 1]
        if (axis + 1, sense) != (int(two.axis[0]), int(two.sense[0])):
            return WRONG, f"{name}: about {one.axis[0], one.sense[0]} and {two.axis[0], two.sense[0]}"
    margins = float(one.margins[0]), float(two.margins[0]) / unit
    return _apart(problem, state, *margins, name)


def _apart(problem, state, margin, other, name):
    if math.isinf(margin) or math.isinf(other):
        return (NO_QUESTION if margin == other else (WRONG, f"{name}: margins {margin, other}"))
    terms = sum(float(d) * v * v for d, v in zip(problem.weight, state)) / 2 + abs(margin)
    size = abs(margin - other) / (4 * MARGIN * terms) if terms else 0.0
    return size, f"{name}: margins {margin, other}"


def _alone(one, scene, state):
    """The array's answer against the one for a single state."""
    try:
        single = motion_of(scene, state, needs=Needs.QUICK)
    except InputError:
        return NO_QUESTION
    return (WRONG, f"alone {single.fate.word}") if single.fate != one.labels[0] else NO_QUESTION
