"""Tests of `orbit/period.py`: what once went wrong there, and its edges."""
from __future__ import annotations

import math

import pytest
from flint import arb
from scipy.optimize import brentq

import stabilab
from stabilab import ScaledGyrostat
from stabilab.numbers.balls import Unclear, settled, working
from stabilab.orbit import period as balls
from stabilab.orbit.one_orbit import ball_orbit
from stabilab.orbit.period import _rate

WIDTH = 0.1  # of a peak, against an interval of 1


def test_a_rate_below_a_barrier_is_asked_for_again_with_more_bits():
    scene, state = ScaledGyrostat(1, 2, (0, 0, 1)), (0.3, 0.2, 0.1)
    orbit = settled(lambda numbers: ball_orbit(stabilab.orbit.reduction.reduce(scene), state, numbers), 128)
    side = 1 if float(orbit.force_here) < 0 else -1  # uphill
    with pytest.raises(Unclear):
        _rate(orbit, orbit.energy * 0 + side)


def test_two_steps_that_agree_by_chance_do_not_end_the_rule():
    """The error of a sum over nodes changes its sign as a peak moves past the nodes: in between two steps
    agree, and say nothing of the error."""
    def total(level, centre):
        """The rule's sum at one step, of a peak at the centre, in doubles."""
        step, sums = 2.0**-level, 0.0
        for k in range(-int(3.4 / step), int(3.4 / step) + 1):
            far = 1 / (1 + math.exp(math.pi * math.sinh(k * step)))
            sums += math.pi * math.cosh(k * step) * far * (1 - far) / (1 + ((1 - far - centre) / WIDTH) ** 2)
        return sums * step

    def strayed(centre):
        return total(3, centre) - total(2, centre)
    centres = [0.5 + 0.002 * n for n in range(60)]
    left, right = next((a, b) for a, b in zip(centres, centres[1:]) if strayed(a) * strayed(b) < 0)
    centre = brentq(strayed, left, right, xtol=1e-16)

    def peak(near, a, b):
        return 1 / (1 + ((near + (a if near > 0 else b) - centre) / WIDTH) ** 2)
    # the integral in closed form
    exact = WIDTH * (math.atan((1 - centre) / WIDTH) + math.atan(centre / WIDTH))
    assert abs(strayed(centre)) < 1e-14 and abs(total(3, centre) - exact) > 1e-6 * exact  # by chance
    with working(200):
        assert float(balls._tanh_sinh(peak, arb(0), arb(1), 9).mid()) == pytest.approx(exact, rel=1e-14)


def test_the_error_by_rate_is_the_power_that_squares_with_every_doubling():
    """A geometric rule: changes of 1e-1, 1e-2, 1e-4 leave 1e-8; by chance the last is nothing, and the change
    before tells."""
    assert balls.power_of_error(-1.0, -2.0, -4.0) == pytest.approx(-8.0)
    assert balls.power_of_error(-1.0, -2.0, -30.0) == pytest.approx(-8.0)
    assert balls.power_of_error(-1.0, -15.0, -4.0) > 0
