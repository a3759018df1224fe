"""Facts about extremes that small faults break: turning points, bounds of their rounding, and what goes to ball arithmetic."""
from __future__ import annotations

import importlib

import mpmath as mp
import numpy as np
import pytest

import stabilab
from stabilab import Fate
from stabilab.analysis import turning
from stabilab.analysis.landscape import EPS, landscape
from stabilab.analysis.numba_door import installed
from stabilab.analysis.reduction import reduce

from .oracles import energy
from .oracles.energy import Reduced, _inner
from .oracles.pairs import physical, scaled
from .test_extremes import assert_extremes
from .test_fate import ELLIPTIC, FAMILIES, axis_of, sample
from .test_small_faults import PARABOLIC

extremes = importlib.import_module("stabilab.analysis.extremes")
ALL = FAMILIES | PARABOLIC


def librations(name, count, low, high):
    """Bounded states at relative distances 10^low to 10^high from wells."""
    scene, rng = ALL[name][0], np.random.default_rng(3)
    points = [p for c in stabilab.equilibria(scene).curves for p in c.samples]
    wells = [p.at for p in points if p.linear == "stable" and max(map(abs, p.at)) < 100]
    at = np.array([wells[n] for n in rng.integers(len(wells), size=8 * count)])
    size = 10.0 ** rng.uniform(low, high, (8 * count, 1)) * np.abs(at).max(axis=1, keepdims=True)
    states = at + rng.normal(size=at.shape) * size
    return states[stabilab.fate(scene, states).labels == Fate.BOUNDED][:count]


@pytest.mark.parametrize("name", ["minor scaled +", "minor scaled -", "minor physical", "minor on axis 1", "major physical"])
def test_a_small_libration_keeps_its_digits_on_either_side_of_its_well(name):
    """A well just behind the state is not a whole turn ahead: over a turn 2 pi mu swamps the small energy above it."""
    scene, problem = FAMILIES[name]
    states = librations(name, 8, -4, -2.5)
    found = [stabilab.extremes(scene, states, fast=fast) for fast in ((False, True) if installed() else (False,))]
    for n, state in enumerate(states.tolist()):
        exact = energy.extremes(problem, state, digits=40)
        for boxes in found:
            assert_extremes(boxes[n], exact, 3e-12)


def test_the_energy_above_a_well_behind_drowns_in_that_of_a_turn():
    """The case is hard: taken from the copy a turn ahead, the energy of a libration of 1e-3 keeps seven digits."""
    scene, problem = FAMILIES["minor scaled +"]
    state = np.array([[-2.794653878935768, 0.417874152676454, 0.0009299997902537878]])
    land = landscape(scene)
    place, w, _ = land.start(state)
    offsets, spots, _ = land.critical(place)
    column = np.nanargmax(offsets[0])
    naive = 0.5 * w[0] ** 2 + land.potential.rise(-offsets[:, column], spots[:, :, column])[0] - 2 * np.pi * land.potential.mu
    with mp.workdps(40):
        motion = Reduced(problem, state[0].tolist(), 40)
        exact = float(max(motion.g(a) for a, kind in motion.stationary() if abs(a) < 0.1) / 2) * motion.k0 ** 2
        assert abs(naive / exact - 1) > 1e-10
    span = turning.interval(land, place, w)
    assert span.fastest[0] == pytest.approx(float(exact), rel=1e-12)
