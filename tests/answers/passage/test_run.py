"""The plain runs that a search is made of."""
import math

import pytest

from stabilab import Body, ConstantTorque, Gyrostat, Scene
from stabilab.answers.limit import asked
from stabilab.answers.passage import largest_rate, run_once
from tests.answers.stuck.brute import Craft
from tests.shared import craft_file

FEEBLE = craft_file([12, 9, 5], ([1, 0, 0.2], [0, 1, 0], 1e-30), [([1, 0, 0], 0.8)], [0.1, 0.05, 0.3])


def test_a_feeble_torque_leaves_stdout_to_the_answer(capfd):
    """In the unit of 1e-15 rad/s that this torque alone would have, the search for roots fails, and says so
    on stdout."""
    craft = Craft(FEEBLE)
    scene = Scene(Body((12, 9, 5)), Gyrostat((0.8, 0, 0)), ConstantTorque(tuple(craft.torque())))
    largest, reached = largest_rate(scene, (0.1, 0.05, 0.3), 200.0, 1000)
    assert capfd.readouterr() == ("", "")
    assert reached == 200 and largest == pytest.approx(craft.run(200.0, limit=False)[2], rel=1e-3)
    assert largest >= math.sqrt(0.1025) and run_once(scene, (0.1, 0.05, 0.3),
                                                     asked(scene, rate=1.01 * largest), 200.0,
                                                     1000) == (math.inf, 200)
