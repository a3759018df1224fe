"""What extremes of spin-ups leave to ball arithmetic: next to separatrices, at barriers, far from the centre.
"""
from __future__ import annotations

import numpy as np
import pytest

import stabilab
from stabilab.orbit import extremes_and_periods as both
from stabilab.orbit.extremes import arrays as guards
from stabilab.orbit.extremes.one_state import precise_extremes
from stabilab.orbit.extremes_and_periods import extremes_and_periods
from stabilab.orbit.landscape import landscape
from stabilab.orbit.one_orbit import Orbit
from stabilab.orbit.period import period_ball
from stabilab.orbit.reduction import reduce
from tests.oracles.pairs import brink, scaled
from tests.orbit.fate.test_fate import FAMILIES
from tests.shared import PARABOLIC


def flip_of(values, accepted):
    """The largest of the rising values that is accepted; those below are, those above are not."""
    accepted = np.asarray(accepted)
    assert accepted[0] and not accepted[-1] and (np.diff(accepted.astype(int)) <= 0).all()
    return values[np.nonzero(accepted)[0][-1]]


def test_states_ten_thousand_times_smaller_than_the_shift_go_to_balls():
    """The scaled circle's centre is x1 = -a (and 0): the canonical X has lost four digits there."""
    land = landscape(scaled(100.0, 100.25, (0, 0, 1))[0])
    sizes = 10.0 ** np.arange(-4, 1, 0.02)
    for column in range(3):
        states = np.zeros((len(sizes), 3))
        states[:, column] = -sizes
        assert flip_of(sizes, guards.needs_digits(land, states)) == pytest.approx(1e-2, rel=0.06)
    assert not guards.needs_digits(landscape(PARABOLIC["first axis"][0]), np.zeros((2, 3))).any()


@pytest.mark.parametrize("name", ["minor scaled +", "middle scaled, |c| far above"])
def test_states_at_the_place_of_a_barrier_go_to_balls_and_those_at_a_well_do_not(name):
    land = landscape(FAMILIES[name][0])
    place, _, _ = land.start(np.array([[2.5, 0.8, 1.5]] if land.e > 0 else [[2.5, 1.0, 0.3]]))
    _, spots, barrier = land.critical(place)
    off = 10.0 ** np.arange(-17, 0, 0.05)
    pot = land.potential
    for column in np.nonzero(~np.isnan(land.critical(place)[0][0]))[0]:
        spot = tuple(np.full(len(off), v) for v in spots[:, 0, column])
        for side in (-1, 1):
            near = pot.move(spot, side * off)
            found = guards.on_top(land, near)
            if barrier[0, column]:
                edge = flip_of(off, found)
                assert edge * pot.slope(tuple(spots[:, 0, column])) / pot.terms(
                    tuple(spots[:, 0, column])) == pytest.approx(1e-13, rel=0.2)
            else:
                assert not found.any()


def test_spin_ups_within_their_share_of_the_separatrix_are_left_to_balls(monkeypatch):
    """Nearer than the share of the terms: the torque's, the force's along the orbit, the kinetic energy."""
    (scene, problem), asked = FAMILIES["minor scaled +"], []
    monkeypatch.setattr(both, "precise_extremes", lambda orbit,
                        label: asked.append(tuple(orbit.state)) or precise_extremes(orbit, label))
    off = 10.0 ** np.arange(-9, -1.5, 0.5)
    edge = np.array(brink(problem, (-3.0, 1.0), 0.0))
    states = np.array([[*edge[:2], edge[2] * (1 + d)] for d in off])
    stabilab.extremes(scene, states)
    x, z = -3.0 + 0.2, 1.0
    scale = edge[2] ** 2 / 2 + 1 + (x * x + z * z) + 0.2 * np.hypot(x, z)
    near = edge[2] ** 2 * off <= 1e-4 * scale
    np.testing.assert_array_equal([tuple(s) in asked for s in states.tolist()], near)


def test_an_end_beyond_the_doubles_beside_an_equilibrium_of_nearly_equal_moments_is_left_to_balls_without_a_warning():
    """A wild scene: the search for the well ended elsewhere on the hyperbola. The second rate swings by the
    7.2e-15 rad/s that balls find."""
    scene = stabilab.Scene(stabilab.Body((1.1358912034371995, 1.1358912034372006, 1.369444431794344)),
                           stabilab.Gyrostat((15.42395050522702, 0.0, 0.006658581675073356)),
                           stabilab.ConstantTorque((0.0, 142451.4621787088, 0.0)))
    state = tuple(map(float.fromhex, ("0x1.fa74aefe3b0dfp+9", "0x0.0p+0", "-0x1.4217b28358025p+9")))
    box, periods = extremes_and_periods(scene, np.array([state]))
    np.testing.assert_allclose(box[0, 1], np.array((-7.199010478703518e-15, 7.199010478703518e-15)),
                               rtol=1e-9)
    assert periods[0] == pytest.approx(float(period_ball(Orbit(reduce(scene), state), 20).mid()), rel=1e-12)
