"""Bounds of rounding: a margin within them is decided in exact arithmetic, one outside by its doubles; both
to a factor of few."""
from __future__ import annotations

import importlib
from itertools import islice

import numpy as np
import pytest

import stabilab
from tests.oracles import energy
from tests.oracles.pairs import assert_margin, axis_of, brink, scaled
from tests.shared import ELLIPTIC, FAMILIES, PARABOLIC

fate = importlib.import_module("stabilab.orbit.fate_arrays")


def brinks(name, problem, count=3):
    """States on the separatrix, on circles of a tenth to a thousand times the unit; on orbits known to have a
    barrier."""
    rng = np.random.default_rng(0)
    pairs = (PAIRS[name] if name in PAIRS
             else [rng.normal(size=2) * 10.0 ** rng.uniform(-1, 3) for _ in range(40)])
    return list(islice((state for pair in pairs if (state := brink(problem, pair, 0.0)) is not None), count))


PAIRS = {"middle scaled -, |c| above the cusp": [(-1.25, -1.25), (-0.75, -1.875)],
         "middle scaled, |c| far above": [(2.5, 1.5), (-3.25, 1.0)],
         "far centre": [(3 - 1e5, -2.0), (5 - 1e5, -3.0)],
         **{name: [(2.25, -11.25), (-21.25, -2.0), (8.5, -4.125), (-2.75, -2.125), (0.0625, -0.0625)]
            for name in PARABOLIC}}
BARRIERS = {"far centre": scaled(1e5, 1e5 + 0.25, (0, 0, 1)),
            **{name: (FAMILIES | PARABOLIC)[name] for name in (
                *ELLIPTIC, "middle scaled -, |c| above the cusp", "middle scaled, |c| far above",
                "first axis",
                "first axis, other sign", "second axis", "third axis", "oblate")}}


def test_margins_near_the_poles_of_circles_of_any_size_keep_twelve_digits_and_seldom_need_many():
    rng, asked, count = np.random.default_rng(11), 0, 0
    for name in ELLIPTIC:
        scene, problem = FAMILIES[name]
        i = axis_of(problem)
        angle = rng.integers(0, 4, 6) * np.pi / 2 + rng.choice([-1, 1], 6) * 10.0 ** rng.uniform(-8, -0.5, 6)
        states = np.zeros((6, 3))
        states[:, [i - 2, i - 1]] = 10.0 ** rng.uniform(0, 8,
                                                        (6, 1)) * np.stack([np.sin(angle), np.cos(angle)],
                                                                           axis=1)
        states[::2, i] = rng.normal(size=3) * 10.0 ** rng.uniform(-2, 2, 3)
        found = stabilab.fate(scene, states)
        asked, count = asked + found.precise, count + len(states)
        for state, margin in zip(states.tolist(), found.margins):
            assert_margin(problem, state, margin, digits=100)
    assert asked <= 0.1 * count


@pytest.mark.one_in(2)
@pytest.mark.parametrize("name",
                         ["middle scaled -, |c| above the cusp", "middle scaled, |c| far above", *PARABOLIC])
def test_margins_of_slow_motions_nearly_as_high_as_a_barrier_keep_twelve_digits_of_their_terms(name):
    """At rest in the torque's coordinate the terms of a margin are the height itself, however large those it
    is made of."""
    scene, problem = BARRIERS[name] if name in BARRIERS else (FAMILIES | PARABOLIC)[name]
    i = axis_of(problem)
    for state in brinks(name, problem):
        slow = np.array(state)
        slow[i] = 0.0
        for low, high in zip(*_ray(scene, slow, i)):
            for share in 10.0 ** -np.arange(2, 12, 2.0):
                here = low + (high - low) * share
                exact, margin = energy.margin(problem, here.tolist(),
                                              digits=80), stabilab.fate(scene, here).margins
                if exact is not None and np.isfinite(margin):
                    assert abs(margin
                               - float(exact)) <= 1e-12 * abs(float(exact)), [v.hex() for v in here.tolist()]


def _ray(scene, state, i):
    """States at rest on either side of the barrier's level, along a line through `state`: (level, away),
    lists."""
    ends = [state * (1 + np.eye(3)[(i + k) % 3] * s) for k in (1, 2) for s in (0.5, -0.5, 3.0)]
    found = [], []
    for end in ends:
        margins = stabilab.fate(scene, np.stack([state, end])).margins
        if np.isfinite(margins).all() and margins[0] * margins[1] < 0:
            low, high = state, end
            for _ in range(60):
                middle = 0.5 * (low + high)
                low, high = (middle,
                             high) if stabilab.fate(scene, middle).margins * margins[0] > 0 else (low, middle)
            found[0].append(low)
            found[1].append(end)
    return found
