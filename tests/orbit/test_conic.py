"""Tests of `orbit/conic.py`: what once went wrong there, and its edges."""
from __future__ import annotations

import numpy as np
import pytest

import stabilab.errors
from stabilab.answers.motion import Needs
from stabilab.answers.motion import motion as motion_of
from stabilab.orbit.reduction import reduce
from tests.oracles import energy, sphere
from tests.oracles.pairs import assert_extremes, exactly, physical

# Free bodies with two moments equal to 1e-11 and better: the equilibria were looked for from where two far
# lines cross, or a piece of
# their curve was told a well from a sum that cancels; arrays saw no barrier (margin -inf or inf) where one
# state did.
FREE_AND_NEARLY_EQUAL = {
    "1e-14, on circles": (physical((25.273702030355615, 32.29741709646918, 32.297417096469324),
                                   (0, 0, -2.3532746107177696), (0, 0, 0)),
                          exactly("-0x1.fa4c571ef478cp-12", "-0x1.762fd8d4bd2d1p-9", "0x1.3ded3f3fbfa69p+2")),
    "1e-16, on hyperbolas": (physical((16.48872499724158, 24.322645214207345, 24.322645214207352),
                                      (0.014074513397013778, 0, -9.173254340866082),
                                      (0, 0, 0)), exactly("-0x1.6cbf173b94456p+12", "-0x1.017d357c6e739p+13",
                                                          "-0x1.af54eb630e024p+0")),
    "3e-12, the other line": (physical((12.308781068493856, 13.716141968863074, 12.30878106910472),
                                       (0, 0, 0.4429275768211725), (0, 0, 0)),
                              exactly("0x1.4f29093db6615p-4", "-0x1.f8a88aff523f9p-4",
                                      "-0x1.13f46b0c2e45ep+1")),
}


@pytest.mark.parametrize("name", FREE_AND_NEARLY_EQUAL)
def test_the_saddle_of_a_free_body_is_found_however_nearly_equal_two_moments_are(name):
    (scene, problem), state = FREE_AND_NEARLY_EQUAL[name]
    axis = reduce(scene).axis
    exact = float(sphere.margin(*(scene.body.exact, scene.vector("gyrostat")), state, digits=200))
    for found in (stabilab.fate(scene, np.array([state])).margins[0],
                  motion_of(scene, state, needs=Needs.QUICK).margin_energy):
        assert found == pytest.approx(exact, rel=1e-11)
    box = stabilab.extremes(scene, np.array([state]))[0]
    assert_extremes(box, energy.extremes(problem, state, digits=200, axis=axis), 1e-11)
