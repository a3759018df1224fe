"""Motions that pass so close to the centre of their hyperbola that the doubles of the conic cannot place an
equilibrium there."""
from __future__ import annotations

from itertools import product

import numpy as np
import pytest

import stabilab
from tests.oracles import energy
from tests.oracles.pairs import physical

D, WHEEL = (1.6268060205249877, 1.7001997084098248,
            1.2138327454194524), (0.0, -0.2649180421135625, -0.22016329912160304)
# the pure spin to which the hyperbola's asymptotes belong, to rounding
CENTRE = (0.0, 3.6095480380989766, -0.5331175463238882)


# each torque and each distance; all pairs are slow
FEW = {(0.0, 0.0), (0.0, 1e-12), (1e-30, 0.0), (1e-18, 1e-15), (-1e-17, 0.0), (1e-15, 1e-12)}


@pytest.mark.one_in(3)
@pytest.mark.parametrize("torque, off", [pytest.param(*pair, marks=() if pair in FEW else pytest.mark.slow)
                                         for pair in product((0.0, 1e-30, 1e-18, -1e-17, 1e-15),
                                                             (0.0, 1e-15, 1e-12))])
def test_extremes_and_period_beside_the_centre_of_a_hyperbola(torque, off):
    """Beside it all else vanishes, so that the smallest torque makes barriers; arrays lost them, and with
    them which way the motion goes."""
    scene, model = physical(D, WHEEL, (torque, 0.0, 0.0))
    state = (off, CENTRE[1] + 3 * off, CENTRE[2] - off)
    label = energy.label(model, state)
    assert int(stabilab.fate(scene, state).labels) == {"bounded": 0, "spin-up": 1}[label]
    assert stabilab.motion(scene, state).fate == stabilab.Fate(int(stabilab.fate(scene, state).labels))
    expected = np.array(energy.extremes(model, state), float)  # potential in 100 digits, no code shared
    assert stabilab.extremes(scene, [state])[0] == pytest.approx(expected, rel=1e-11)
    if torque:
        margin = energy.margin(model, state)
        ours = float(stabilab.fate(scene, state).margins)
        assert ours == pytest.approx(float("inf") if margin is None else float(margin), rel=1e-6, abs=1e-28)
    if label == "bounded":
        assert float(stabilab.period(scene,
                                     state)) == pytest.approx(float(energy.period(model, state)), rel=1e-9)
