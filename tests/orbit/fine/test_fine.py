"""Rows whose orbit is far larger than their motion: answers from twofold numbers against ball arithmetic,
which proves its digits."""
from __future__ import annotations

import numpy as np
import pytest

from stabilab import Body, ConstantTorque, Gyrostat, Scene, extremes, fate
from stabilab.orbit import extremes_and_periods as both
from stabilab.orbit.extremes.one_state import precise_extremes
from stabilab.orbit.fate.one_state import decide
from stabilab.orbit.fine.margins import MARGIN_SHARE, valley_margins
from stabilab.orbit.landscape import landscape
from stabilab.orbit.one_orbit import Orbit


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
HYPERBOLAS = [name for name in SCENES if name.startswith("hyper")]


def states_of(name, count, seed=4, label=None):
    """States of a tenth to ten times the rates that the wheel brings about."""
    one, rng = SCENES[name], np.random.default_rng(seed)
    rate = float(np.linalg.norm([float(v) for v in one.vector("gyrostat")])) / float(min(one.body.exact))
    states = rng.normal(size=(count, 3)) * rate * 10 ** rng.uniform(-1.3, 0.7, (count, 1))
    return states if label is None else states[fate(one, states).labels == label]


@pytest.mark.parametrize("name", HYPERBOLAS)
def test_margins_from_twofold_numbers_are_those_of_balls(name):
    land, states = landscape(SCENES[name]), states_of(name, 60)
    found, sure = valley_margins(land, states)
    assert sure.mean() > 0.9
    for state, margin in zip(states[sure], found[sure]):
        tie, energy = decide(Orbit(land.reduction, state)), 0.5 * land.reduction.canonical(state)[2] ** 2
        if not np.isfinite(tie.margin):  # no barrier: balls say -inf on either geometry
            assert margin == np.inf
            continue
        assert tie.sign == np.sign(margin) and abs(margin
                                                   - tie.margin) <= 2 * MARGIN_SHARE * (
                                                       energy + abs(tie.margin + energy))


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


def test_a_margin_over_a_way_of_many_foldings_keeps_its_digits():
    """The way to the barrier is the logarithm of 6e-5: taken from the change, which is nearly -1, it would
    lose four digits."""
    one = scene((1.3047591344225173, 0.9790930727768938, 1.635402623597301),
                (0, 0.3187059744908893, 8.182100222806493), 0, -0.7205405624075971)
    land, state = landscape(one), (-218.13766952905002, 1430.8522001870313, 1073.2570610894782)
    assert valley_margins(land,
                          np.array([state]))[0][0] == pytest.approx(
                              decide(Orbit(land.reduction, state)).margin, rel=1e-13)


