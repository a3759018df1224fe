"""The plain runs that a search is made of."""
import math
from fractions import Fraction

import numpy as np
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


def test_a_run_with_vectors_in_doubles_is_that_of_the_scene_that_has_them():
    """To the last bit, for a scene's numbers are quotients of fractions, each rounded once: so are these.
    Moments of many digits, momenta that vanish, motions of all paces."""
    rng = np.random.default_rng(4)
    for n in range(12):
        moments = [Fraction(int(v), 10**6 + n) for v in rng.integers(2 * 10**6, 3 * 10**6, 3)]
        pace = 10.0 ** rng.uniform(-9, 9)
        wheel, torque, state = (tuple((rng.normal(size=3) * pace**power).tolist()) for power in (1, 2, 1))
        wheel = (0.0,) * 3 if n % 3 == 0 else wheel
        moment = Gyrostat(tuple(map(Fraction, wheel)))
        scene = Scene(Body(tuple(moments)), moment, ConstantTorque(tuple(map(Fraction, torque))))
        limit, other = asked(scene, rate=2 * math.hypot(*state)), ConstantTorque((1.0, 2.0, 3.0))
        expected = run_once(scene, state, limit, math.inf, 2000)
        assert run_once(Scene(Body(tuple(moments))), state, limit, math.inf, 2000, torque, wheel) == expected
        assert run_once(Scene(scene.body, moment, other), state, limit, math.inf, 2000,
                        torque) == expected
        assert math.isfinite(expected[0]) or expected[1] > 0
