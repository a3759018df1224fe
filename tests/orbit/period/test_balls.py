"""Tests of `orbit/period/balls.py`: what once went wrong there, and its edges."""
from __future__ import annotations

import pytest

import stabilab
from stabilab import Fate, ScaledGyrostat
from stabilab.numbers.balls import Digits, settled
from stabilab.numbers.double_ball import Unclear
from stabilab.orbit.ball_orbit import Orbit, ball_orbit
from stabilab.orbit.extremes.balls import turning_points
from stabilab.orbit.period import balls
from stabilab.orbit.period.balls import _rate
from stabilab.orbit.reduction import reduce


def test_a_rate_below_a_barrier_is_asked_for_again_with_more_bits():
    scene, state = ScaledGyrostat(1, 2, (0, 0, 1)), (0.3, 0.2, 0.1)
    orbit = settled(lambda numbers: ball_orbit(stabilab.orbit.reduction.reduce(scene), state, numbers), 128)
    side = 1 if float(orbit.force_here) < 0 else -1  # uphill
    with pytest.raises(Unclear):
        _rate(orbit, orbit.energy * 0 + side)


@pytest.mark.parametrize("digits", [9, 14, 20, 30, 50])
def test_a_period_in_balls_is_worked_out_once(digits, monkeypatch):
    """The last whole step of the rule stands nearer to a turning point than its terms need: with fewer bits every first try was in vain."""
    tried, orbit = [], Orbit(reduce(scene := ScaledGyrostat(1, 2, (0, 0, 1))), (0.3, 0.2, 0.1))
    assert stabilab.fate(scene, [orbit.state]).labels[0] == Fate.BOUNDED
    monkeypatch.setattr(balls, "turning_points", lambda one: tried.append(one.numbers.bits) or turning_points(one))
    found = balls.period_ball(orbit, digits)
    assert len(tried) == 1
    finer = balls.period_ball(orbit, digits + 12)
    assert abs(float((found - finer).mid())) <= 10.0**-digits * float(finer.mid())


def test_a_height_in_balls_forms_the_force_at_the_state_once(monkeypatch):
    """A period asks for some hundred heights, and the exact force took longer than the rest of each."""
    orbit, made = Orbit(reduce(ScaledGyrostat(1, 2, (0, 0, 1))), (0.3, 0.2, 0.1)), []
    ball = Digits.ball
    monkeypatch.setattr(Digits, "ball", staticmethod(lambda value: made.append(value) or ball(value)))
    balls.period_ball(orbit, 9)
    force = orbit.settled(lambda found: found.force_here)
    assert 1 <= made.count(force) <= 4
