"""Bounds over a span hold the motion all along it, and are nearly its extremes."""
import random

import numpy as np
import pytest

from stabilab.answers.motion import motion
from stabilab.unreduced.off_axis import ranges_until

from ..spin_up.scenes import EXAMPLE, random_scene, rates_of, run, sphere


@pytest.mark.parametrize("n", range(4))
def test_ranges_hold_the_motion_closely(n):
    rng = random.Random(n)
    scene, state = random_scene(rng, .1), sphere(rng, (1, 8)[n % 2])
    found = ranges_until(scene, state, 2.0)
    states = run(rates_of(scene), state, np.linspace(0, 2, 20001))  # DOP853
    least, greatest = states.min(axis=0), states.max(axis=0)
    assert (found[:, 0] <= least + 1e-9).all() and (found[:, 1] >= greatest - 1e-9).all()
    assert (greatest - least + 1e-3 >= 0.99 * (found[:, 1] - found[:, 0])).all()


def test_ranges_that_are_not_reached_are_none():
    assert ranges_until(EXAMPLE, (.1, 1, 2), 50.0, steps=5) is None


def test_a_motion_is_proved_when_asked_and_its_bounds_are_what_it_cannot_leave():
    plain, proved = motion(EXAMPLE, (.1, 1, 2)), motion(EXAMPLE, (.1, 1, 2), proof=True)
    assert (plain.level, proved.level) == ("certified",
                                           "proved") and (plain.axis,
                                                          plain.sense) == (proved.axis, proved.sense)
    states = run(rates_of(EXAMPLE), (.1, 1, 2), np.linspace(0, 30, 30001))  # DOP853
    for i, (low, high) in enumerate(proved.bounds):
        assert low <= states[:, i].min() and states[:, i].max() <= high
