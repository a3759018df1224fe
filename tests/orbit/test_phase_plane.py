"""The plane of one motion: the place of a single state is that of the same state in a row of states."""
import math

import numpy as np
import pytest

from stabilab import Body, ConstantTorque, Gyrostat, Scene, load
from stabilab.orbit.landscape import landscape
from stabilab.orbit.phase_plane import phase_plane
from tests.shared import CASES

NAMES = ("minor-axis-100", "middle-axis-plane-100", "middle-axis-equal-100", "middle-axis-spin-up",
         "symmetric-spin-up", "two-wheels-minor-axis")


@pytest.mark.parametrize("name", NAMES)
def test_a_single_state_has_its_place_among_many(name):
    case = load(str(CASES / f"{name}.toml"))
    land, state = landscape(case.scene), np.asarray(case.state, float)
    if land is None:
        pytest.skip("no orbit")
    alone, among = land.start(state), land.start(np.stack([state, state]))
    for one, many in zip(np.ravel(alone[0]), np.array(among[0])[..., 0].ravel()):
        assert one == many
    assert alone[1] == among[1][0]
    phase_plane(case.scene, case.state)


def test_a_single_state_that_exact_arithmetic_places_on_a_plane_has_its_place():
    """Far from the wheel's share doubles lose the difference of X and Z, so exact arithmetic forms it: here
    it is zero by construction."""
    scene = Scene(Body((3, 2, 1)), Gyrostat((1, 0, 0)), ConstantTorque((0, 1, 0)))
    land = landscape(scene)
    state = np.array([2.0, 0.5, 3.0])
    alone, among = land.start(state), land.start(state[None])
    assert np.ravel(alone[0]).tolist() == np.ravel(among[0]).tolist()


@pytest.mark.parametrize("wheel", [100, 300, 500])
def test_the_centre_on_an_invariant_plane_is_where_the_torque_balances(wheel):
    """Middle axis, x1 + b = x3: on it x2' = 1 + (b - a) x3 - x3^2 by the equations of motion, x3 = x3(0) e^y.
    Doubles leave 2e-16 of the invariant."""
    case = load(str(CASES / f"middle-axis-plane-{wheel}.toml"))
    c = float(case.scene.b - case.scene.a)
    plane = phase_plane(case.scene, case.start)
    assert plane.saddles == [] and abs(plane.Q) < 1e-15
    assert plane.centres == pytest.approx([math.log((c + math.sqrt(c * c + 4)) / 2 / case.state[2])],
                                          abs=1e-14)
