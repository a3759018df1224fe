"""Tests of `orbit/extremes/balls.py`: what once went wrong there, and its edges."""
from __future__ import annotations

import json

import numpy as np

import stabilab.errors
from stabilab.answers.certificate import certificate
from stabilab.verify import verify
from tests.oracles import energy
from tests.oracles.pairs import exactly, scaled
from tests.orbit.extremes.test_extremes import assert_extremes


def test_the_turning_point_on_a_large_circle_is_settled_in_some_number_of_bits():
    """The middle of the ball was exact, so its height's ball came out narrower than those of its neighbours, and four times
    that was never enough to see the sign change, at any precision: the certificate failed."""
    scene, problem = scaled(0.3769424341839118, 0.1628431382008905, (0, 0, -1))
    state = exactly("0x1.ab58ea425c626p+1", "-0x1.23cc00d9b9bbap+4", "0x1.43e7a7276f052p+1")
    made = certificate(scene, state)
    assert verify(json.loads(json.dumps(made))).status == "proved"
    assert_extremes(stabilab.extremes(scene, np.array(state)), energy.extremes(problem, state), 1e-11)
