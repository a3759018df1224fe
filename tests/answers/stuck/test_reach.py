"""The plain runs that a search is made of."""
import math

import pytest

from stabilab import Body, ConstantTorque, Gyrostat, Scene
from stabilab.answers.stuck.reach import first_time, largest_rate
from tests.answers.stuck.brute import Craft

FEEBLE = """[body]
inertia = [12, 9, 5]
[[thrusters]]
name = "A"
position = [1, 0, 0.2]
direction = [0, 1, 0]
force = 1e-30
stuck = true
[[wheels]]
axis = [1, 0, 0]
momentum = 0.8
[motion]
angular_velocity = [0.1, 0.05, 0.3]
"""


def test_a_feeble_torque_leaves_stdout_to_the_answer(capfd):
    """In the unit of 1e-15 rad/s that this torque alone would have, the search for roots fails, and says so on stdout."""
    craft = Craft(FEEBLE)
    scene = Scene(Body((12, 9, 5)), Gyrostat((0.8, 0, 0)), ConstantTorque(tuple(craft.torque())))
    largest, reached = largest_rate(scene, (0.1, 0.05, 0.3), 200.0, 1000)
    assert capfd.readouterr() == ("", "")
    assert reached == 200 and largest == pytest.approx(craft.run(200.0, limit=False)[2], rel=1e-3)
    assert largest >= math.sqrt(0.1025) and first_time(scene, (0.1, 0.05, 0.3), 1.01 * largest, None, 200.0, 1000) == math.inf
