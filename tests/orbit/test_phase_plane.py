"""The plane of one motion."""
import math

import pytest

from stabilab import load
from stabilab.orbit.phase_plane import phase_plane
from tests.shared import CASES


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
