"""Tests of `orbit/extremes.py`: what once went wrong there, and its edges."""
from __future__ import annotations

import json

import numpy as np
import pytest

import stabilab.errors
from stabilab import Body, ConstantTorque, Gyrostat, Scene
from stabilab.answers.certificate import certificate
from stabilab.answers.digits import ask
from stabilab.verify import verify
from tests.oracles import energy
from tests.oracles.pairs import assert_extremes, exactly, scaled


def test_the_turning_point_on_a_large_circle_is_settled_in_some_number_of_bits():
    """The middle of the ball was exact, so its height's ball came out narrower than those of its neighbours,
    and four times that was never enough to see the sign change, at any precision: the certificate failed."""
    scene, problem = scaled(0.3769424341839118, 0.1628431382008905, (0, 0, -1))
    state = exactly("0x1.ab58ea425c626p+1", "-0x1.23cc00d9b9bbap+4", "0x1.43e7a7276f052p+1")
    made = certificate(scene, state)
    assert verify(json.loads(json.dumps(made))).status == "proved"
    assert_extremes(stabilab.extremes(scene, np.array(state)), energy.extremes(problem, state), 1e-11)


@pytest.mark.parametrize("scene, state, extremes, period",
                         [  # by hand, p, q, r the rates; the first three are circles
    # r = 1: p' = (1 - q)/2, q' = p/2
    (Scene(Body((2, 2, 3)), ConstantTorque((1, 0, 0))), (0, 0, 1), [(-1, 1), (0, 2), (1, 1)], 4 * np.pi),
    # r = -1/2: p' = (1 - q/2)/2, q' = p/4
    (Scene(Body((2, 2, 3)), Gyrostat((0, 0, 1)), ConstantTorque((1, 0, 0))), (1, 2, -0.5),
     [(-1, 1), (1, 3), (-0.5, -0.5)], 8 * np.pi),
    # three equal moments: omega turns about the wheel's axis at lambda/D = 1/2
    (Scene(Body((2, 2, 2)), Gyrostat((0, 1, 0))), (1, 1, 0), [(-1, 1), (1, 1), (-1, 1)], 4 * np.pi),
    # and under a torque, y the angle: q = r = 3 y/2, p^2 = 4 + 3 y - 9 y^2/2, zero at -2/3 and 4/3, the first trial
    # for a wall
    (Scene(Body((2, 2, 2)), Gyrostat((0, -3, 3)), ConstantTorque((3, 0, 0))), (-2, 0, 0),
     [(-4.5**0.5, 4.5**0.5), (-1, 2), (-1, 2)], 2 * np.pi / 4.5**0.5)])
def test_a_turning_point_that_is_a_double_itself_is_settled(scene, state, extremes, period):
    """Its height's ball is zero, so that no width about it had heights of both signs: a motion ended in
    Unclear."""
    motion = stabilab.motion(scene, state)
    np.testing.assert_allclose(motion.extremes, extremes, rtol=0, atol=1e-14)
    assert abs(motion.period / period - 1) < 1e-14
    np.testing.assert_allclose(stabilab.extremes(scene, [state, state])[1], extremes, rtol=0, atol=1e-14)
    assert ask("extremes", scene, state, 30).digits >= 30
    assert verify(json.loads(json.dumps(certificate(scene, state)))).status == "proved"
