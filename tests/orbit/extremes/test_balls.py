"""Tests of `orbit/extremes/one_state.py`: what once went wrong there, and its edges."""
from __future__ import annotations

import json

import numpy as np
import pytest

import stabilab.errors
from stabilab import Body, ConstantTorque, Gyrostat, Scene
from stabilab.answers.certificate import certificate
from stabilab.answers.digits.ask import ask
from stabilab.numbers.balls import Digits, working
from stabilab.orbit.extremes.one_state import solve
from stabilab.verify import verify
from tests.oracles import energy
from tests.oracles.pairs import exactly, scaled
from tests.orbit.extremes.test_extremes import assert_extremes


def test_the_turning_point_on_a_large_circle_is_settled_in_some_number_of_bits():
    """The middle of the ball was exact, so its height's ball came out narrower than those of its neighbours,
    and four times that was never enough to see the sign change, at any precision: the certificate failed."""
    scene, problem = scaled(0.3769424341839118, 0.1628431382008905, (0, 0, -1))
    state = exactly("0x1.ab58ea425c626p+1", "-0x1.23cc00d9b9bbap+4", "0x1.43e7a7276f052p+1")
    made = certificate(scene, state)
    assert verify(json.loads(json.dumps(made))).status == "proved"
    assert_extremes(stabilab.extremes(scene, np.array(state)), energy.extremes(problem, state), 1e-11)


@pytest.mark.parametrize("a, b, mu, state", [
    (7.768996654585626, 10.165882106248802, 1.0,
     ("-0x1.058db91dbca8ap+3", "-0x1.00fc3c12ad089p-1", "0x1.a349f724ad939p-49")),
    (-9.999994510210845, -9.876687960809653, -3.639303335324426e-07,
     ("0x1.3c0e04a151d73p+3", "0x1.00a9ac2c5d301p-6", "-0x1.48b15c35cfdd4p-52")),
    (-0.15256615775308, -0.960289699001265, 1.0,
     ("0x1.ebb9d88a448fdp-1", "-0x1.159c8ae4099eep+13", "0x1.c827ac0759fcfp-53"))])
def test_a_spin_up_that_hardly_passes_a_barrier_has_its_least_rate(a, b, mu, state):
    """Its square had a ball of both signs, whose root is no number, and no number was taken for settled."""
    scene, problem = scaled(a, b, (0, 0, mu))
    state = exactly(*state)
    expected = energy.extremes(problem, state, digits=80)
    assert_extremes(stabilab.extremes(scene, np.array(state)), expected, 1e-11)
    assert_extremes(np.array(stabilab.motion(scene, state, brief=True).extremes), expected, 1e-11)


@pytest.mark.parametrize("scene, state, extremes, period",
                         [  # by hand, p, q, r the rates; all three are circles
    # r = 1: p' = (1 - q)/2, q' = p/2
    (Scene(Body((2, 2, 3)), ConstantTorque((1, 0, 0))), (0, 0, 1), [(-1, 1), (0, 2), (1, 1)], 4 * np.pi),
    # r = -1/2: p' = (1 - q/2)/2, q' = p/4
    (Scene(Body((2, 2, 3)), Gyrostat((0, 0, 1)), ConstantTorque((1, 0, 0))), (1, 2, -0.5),
     [(-1, 1), (1, 3), (-0.5, -0.5)], 8 * np.pi),
    # three equal moments: omega turns about the wheel's axis at lambda/D = 1/2
    (Scene(Body((2, 2, 2)), Gyrostat((0, 1, 0))), (1, 1, 0), [(-1, 1), (1, 1), (-1, 1)], 4 * np.pi)])
def test_a_turning_point_that_is_a_double_itself_is_settled(scene, state, extremes, period):
    """Its height's ball is zero, so that no width about it had heights of both signs: a motion ended in
    Unclear."""
    motion = stabilab.motion(scene, state)
    np.testing.assert_allclose(motion.extremes, extremes, rtol=0, atol=1e-14)
    assert abs(motion.period / period - 1) < 1e-14
    np.testing.assert_allclose(stabilab.extremes(scene, [state, state])[1], extremes, rtol=0, atol=1e-14)
    assert ask("extremes", scene, state, 30).digits >= 30
    assert verify(json.loads(json.dumps(certificate(scene, state)))).status == "proved"


@pytest.mark.parametrize("barrier", [1, -1])
def test_a_turning_point_hundreds_of_powers_of_two_nearer_than_the_barrier_takes_few_steps(barrier):
    """Height y^2 and energy 2^-3000 beside a barrier 1 away: the root is 2^-1500 by hand, and Newton's method
    from afar halves y at each step."""
    asked = []

    class Well:
        numbers = Digits(128)

        def height(self, y):
            asked.append(y)
            return y * y

        def force(self, y):
            return -2 * y

    with working(128):
        from flint import arb
        Well.energy = arb((1, -3000))
        found = solve(Well(), arb(0), arb(barrier))
        assert abs(barrier * found * arb((1, 1500)) - 1) < 1e-30
    assert len(asked) < 200
