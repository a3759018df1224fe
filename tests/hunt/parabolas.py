"""Bodies with two equal moments and a torque across their symmetry axis, where the reduced potential is a
polynomial of the fourth degree: fates, margins, extremes and periods of arrays against that polynomial in
many digits."""
from __future__ import annotations

import math

import numpy as np

import stabilab
from tests.hunt.disagreements import ELEVEN_DIGITS, WRONG, _digits, between, oracle, worst
from tests.hunt.problems import state_of, wide
from tests.hunt.returns import lateness
from tests.oracles import energy
from tests.oracles.model import CYCLE
from tests.oracles.pairs import physical


def problem_of(knobs):
    """(scene, oracle's model, state) of a point in [0, 1]^14."""
    pick = [min(max(float(v), 0.0), 1.0) for v in knobs]
    axis = min(int(3 * pick[0]), 2)
    j, k = CYCLE[axis]
    equal, third = (j, k) if pick[1] > 0.5 else (k, j)
    inertia, momentum, torque = [1.0] * 3, [0.0] * 3, [0.0] * 3
    # a needle's, or any up to the flat disc's
    inertia[third] = 2 * 10.0 ** (-10 * (pick[2] - 0.25)) if pick[2] > 0.25 else 2e-3 + 7.99 * pick[2]
    if pick[3] > 0.9:
        inertia = [v * 10.0 ** (80 * (pick[3] - 0.95)) for v in inertia]
    rate = 10.0 ** (12 * (pick[6] - 0.5)) if pick[3] < 0.2 else 1.0
    momentum[j], momentum[k] = wide(pick[4], 2) * rate, wide(pick[6], 2) * rate
    torque[axis] = (wide(pick[5], 3) or 1.0) * rate * rate
    scene, problem = physical(inertia, momentum, torque)
    return scene, problem, state_of(scene, problem, pick)


def parabolas(scene, problem, state):
    """Of NumPy and of the compiled kernels; extremes and periods by the roots and by quadrature of the
    polynomial."""
    found = [oracle(scene, problem, state)]
    digits = _digits(state)
    word = energy.label(problem, state, digits=digits)
    if word not in ("bounded", "spin-up") or found[0][0] == WRONG:
        return worst(*found)
    try:
        box = energy.extremes(problem, state, digits=digits)
    except ValueError:  # a component across the axis grows without bound: the oracle has none
        box = None
    time = energy.period(problem, state, digits=60) if word == "bounded" else math.inf
    for fast in (False, True):
        (period,), boxes = stabilab.period(scene, np.array([state]),
                                           fast=fast), stabilab.extremes(scene, np.array([state]),
                                                                         fast=fast)[0]
        told = between([period], [time], f"period, fast={fast}", ELEVEN_DIGITS)
        # next to a flat place the quadrature may miss a narrow peak: the motion itself tells who is right
        if 1 < told[0] < math.inf:
            told = min(told, (float(abs(lateness(problem, state, float(period)))) / period / ELEVEN_DIGITS,
                              told[1]))
        found.append(told)
        found += [between(boxes[i], box[i], f"component {i + 1}, fast={fast}", ELEVEN_DIGITS)
                  for i in range(3) if box]
    return worst(*found)
