"""Fates on parabolas, next to the separatrix too."""
from __future__ import annotations

import importlib

import numpy as np
import pytest

import stabilab
from stabilab.orbit.landscape import landscape
from tests.oracles import energy
from tests.oracles.pairs import assert_margin, axis_of
from tests.shared import PARABOLIC

fate = importlib.import_module("stabilab.orbit.fate_arrays")
# of the others the force along a parabola is no cubic
CUBIC = sorted(set(PARABOLIC) - {"no gyrostat", "wheel on the symmetry axis", "a sphere"})


def on_the_way_to_barriers(name, count):
    """States of all sizes; every second at a relative distance of 1e-15 to 0.1 from the separatrix in the
    torque's rate, where its orbit has one."""
    (scene, problem), rng = PARABOLIC[name], np.random.default_rng(5)
    i, land = axis_of(problem), landscape(PARABOLIC[name][0])
    states = rng.normal(size=(count, 3)) * 10.0 ** rng.uniform(-1, 2, (count, 1))
    margins = stabilab.fate(scene, states).margins / land.reduction.energy_unit
    near = np.isfinite(margins) & (margins + 0.5 * states[:, i] ** 2 > 0) & (np.arange(count) % 2 == 0)
    off = 1 + 10.0 ** rng.uniform(-15, -1, count) * rng.choice([-1, 1], count)
    states[near, i] = np.sqrt(states[near, i] ** 2 + 2 * margins[near]) * off[near]
    return states, near


@pytest.mark.one_in(2)
@pytest.mark.parametrize("name", CUBIC)
def test_margins_on_parabolas_keep_twelve_digits_next_to_the_separatrix_too(name):
    """Against the potential at 60 digits."""
    (scene, problem), (states, near) = PARABOLIC[name], on_the_way_to_barriers(name, 6000)
    found = stabilab.fate(scene, states)
    for n in np.append(np.nonzero(near)[0][:20], range(1, 20, 2)):
        assert_margin(problem, states[n].tolist(), found.margins[n])
        exact = energy.margin(problem, states[n].tolist(), digits=60)
        assert exact is None or np.sign(found.margins[n]) == np.sign(float(exact))
    assert near.sum() > 100