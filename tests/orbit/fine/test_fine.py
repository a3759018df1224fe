"""Rows whose orbit is far larger than their motion: answers from twofold numbers against ball arithmetic,
which proves its digits."""
from __future__ import annotations

import numpy as np
import pytest

from stabilab import Body, ConstantTorque, Gyrostat, Scene, extremes, fate
from stabilab.orbit import extremes_and_periods as both
from stabilab.orbit.extremes.one_state import precise_extremes
from stabilab.orbit.landscape import landscape


def scene(moments, wheel, axis, torque):
    return Scene(Body(moments), Gyrostat(wheel),
                 ConstantTorque(tuple(torque if k == axis else 0 for k in range(3))))


# moments that differ by a few per cent or thousandths: the centre of the orbits stands ten to a thousand
# times as far off as the states
SCENES = {"hyperbolas, 7.121 and 7.104": scene((7.121, 7.104, 9.259), (0, -2.586, -0.953), 0, -0.6156),
          "hyperbolas, 0.938 and 0.942": scene((0.473, 0.938, 0.942), (0, 0, 4.556), 1, 0.6802),
          "hyperbolas, 8.045 and 7.854": scene((8.045, 7.854, 4.382), (-3.961, 0, -3.388), 1, -0.0789),
          "circles, 4.642 and 4.635": scene((3.315, 4.642, 4.635), (0, 0, -1.393), 1, -0.0106),
          "circles, a rod": scene((3.895, 3.766, 0.196), (0, -2.753, -0.167), 0, -0.3551)}


def states_of(name, count, seed=4, label=None):
    """States of a tenth to ten times the rates that the wheel brings about."""
    one, rng = SCENES[name], np.random.default_rng(seed)
    rate = float(np.linalg.norm([float(v) for v in one.vector("gyrostat")])) / float(min(one.body.exact))
    states = rng.normal(size=(count, 3)) * rate * 10 ** rng.uniform(-1.3, 0.7, (count, 1))
    return states if label is None else states[fate(one, states).labels == label]


@pytest.mark.one_in(4)
@pytest.mark.parametrize("name", SCENES)
def test_hardly_a_row_of_nearly_equal_moments_goes_to_balls(name, monkeypatch):
    asked, one, states = [], SCENES[name], states_of(name, 1500, 5)
    monkeypatch.setattr(both, "precise_extremes", lambda orbit,
                        label: asked.append(label) or precise_extremes(orbit, label))
    assert fate(one, states).precise <= 3
    if one.quadratic() and landscape(one).e > 0:
        extremes(one, states)
        assert not asked
