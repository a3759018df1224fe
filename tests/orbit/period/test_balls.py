"""Tests of `orbit/period/balls.py`: what once went wrong there, and its edges."""
from __future__ import annotations

import pytest

import stabilab
from stabilab import ScaledGyrostat
from stabilab.numbers.balls import settled
from stabilab.numbers.double_ball import Unclear
from stabilab.orbit.ball_orbit import ball_orbit
from stabilab.orbit.period.balls import _rate


def test_a_rate_below_a_barrier_is_asked_for_again_with_more_bits():
    scene, state = ScaledGyrostat(1, 2, (0, 0, 1)), (0.3, 0.2, 0.1)
    orbit = settled(lambda numbers: ball_orbit(stabilab.orbit.reduction.reduce(scene), state, numbers), 128)
    side = 1 if float(orbit.force_here) < 0 else -1  # uphill
    with pytest.raises(Unclear):
        _rate(orbit, orbit.energy * 0 + side)
