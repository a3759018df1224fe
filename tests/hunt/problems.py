"""From a point of the unit cube to a scene and a state, with the hard corners of the theory a moderate way
off.

Every coordinate is one knob: family, sizes over many decades, how nearly two moments are equal, how near to a
separatrix, an equilibrium or an invariant plane. An optimiser turns them all.
"""
from __future__ import annotations

import math
from fractions import Fraction

import numpy as np

import stabilab
from tests.oracles.model import CYCLE
from tests.oracles.pairs import physical, scaled

KNOBS = 14


def problem_of(knobs):
    """(scene, oracle's model, state) of a point in [0, 1]^14. Raises stabilab's InputError where there is no
    such body."""
    pick = [min(max(float(v), 0.0), 1.0) for v in knobs]
    scene, problem = _scaled(pick) if pick[0] < 0.5 else _physical(pick)
    return scene, problem, state_of(scene, problem, pick)


def wide(knob, decades):
    """A number of either sign, of size 10^-decades to 10^decades; zero at the very middle."""
    if abs(knob - 0.5) < 0.01:
        return 0.0
    return math.copysign(10.0 ** (decades * (4 * abs(knob - 0.5) - 1)), knob - 0.5)


def _scaled(pick):
    a = wide(pick[1], 8 if pick[3] > 0.9 else 1)
    torque = (1 if pick[4] > 0.5 else -1) * (1.0 if pick[5] < 0.5 else 10.0 ** (12 * (pick[5] - 0.75) * 4))
    mu = [0.0, 0.0, 0.0]
    mu[2 if pick[0] < 0.25 else 1] = torque
    return scaled(a, a + wide(pick[2], 1.5), mu)


def _physical(pick):
    axis = min(int(6 * (pick[0] - 0.5)), 2)
    first, second = CYCLE[axis]
    shape = [10.0 ** (3 * (v - 0.5)) for v in (pick[1], 1 - pick[2], pick[2])]
    inertia = [sum(shape) - part for part in shape]
    if pick[3] > 0.8:  # nearly or exactly equal moments
        gap = 0.0 if pick[3] > 0.95 else 10.0 ** (-16 * (pick[3] - 0.8) / 0.15)
        inertia[first] = inertia[(axis, second)[pick[4] > 0.5]] * (1 + gap)
    rate = 10.0 ** (12 * (pick[6] - 0.5)) if pick[5] > 0.5 else 1.0
    momentum, torque = [0.0] * 3, [0.0] * 3
    momentum[first], momentum[second] = wide(pick[4], 2) * rate, wide(pick[6], 2) * rate
    torque[axis] = wide(pick[5], 3) * rate * rate
    return physical(inertia, momentum, torque)


def state_of(scene, problem, pick):
    """A state round the centre of its conic: anywhere, next to a separatrix, an equilibrium, or an invariant
    plane."""
    acting = [i for i in range(3) if problem.m[i]]
    axis = acting[0] if acting else min(int(3 * pick[0]), 2)
    j, k = CYCLE[axis]
    scale = abs(float(problem.m[axis])) ** 0.5 if acting else 1.0
    radius = scale * 10.0 ** (8 * (pick[7] - 0.5) if pick[8] < 0.8 else 16 * (pick[7] - 0.5))
    angle = 2 * math.pi * pick[9]
    centre = [0.0, 0.0, 0.0]
    if problem.kappa[j] and problem.kappa[k]:
        centre[k], centre[j] = float(-problem.rho[j]
                                     / problem.kappa[j]), float(-problem.sigma[k] / problem.kappa[k])
    state = [0.0, 0.0, 0.0]
    state[j], state[k] = centre[j] + radius * math.sin(angle), centre[k] + radius * math.cos(angle)
    place, near = pick[10], 10.0 ** (-17 * pick[11])
    if 0.5 < place < 0.65:
        _to_plane(problem, state, centre, j, k, near, pick[12])
    elif 0.65 <= place < 0.8:
        _to_equilibrium(problem, state, axis, j, k)
    side = 1 if pick[12] > 0.5 else -1
    state[axis] = side * scale * 10.0 ** (8 * (pick[13] - 0.5))
    if 0.65 <= place < 0.8:
        state[axis] *= near
    elif place >= 0.8 and acting:
        state[axis] = _brink(scene, problem, state, axis, side, near if pick[13] > 0.5 else -near)
    return tuple(state)


def _to_plane(problem, state, centre, j, k, near, knob):
    """x_j so that C, the difference of two squares, nearly vanishes."""
    ratio = problem.kappa[j] / problem.kappa[k] if problem.kappa[k] else Fraction(0)
    if ratio > 0:
        state[j] = (centre[j] + math.copysign(math.sqrt(ratio),
                                              knob - 0.5) * (state[k] - centre[k]) * (1 + near))


def _to_equilibrium(problem, state, axis, j, k):
    """x_j so that the torque's own rate vanishes up to rounding."""
    slope = problem.kappa[axis] * Fraction(state[k]) + problem.sigma[axis]
    if slope:
        value = -(problem.rho[axis] * Fraction(state[k]) + problem.m[axis]) / slope
        if abs(value) < 1e150:
            state[j] = float(value)


def _brink(scene, problem, state, axis, side, distance):
    """The rate about the torque's axis at which the motion just reaches the barrier, off by a relative
    distance."""
    still = list(state)
    still[axis] = 0.0
    margin = float(stabilab.fate(scene, np.array(still)).margins)
    if not (math.isfinite(margin) and margin > 0):
        return state[axis]
    return side * math.sqrt(2 * margin / float(problem.weight[axis])) * (1 + distance)
