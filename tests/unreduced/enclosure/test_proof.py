"""Proved spin-up: the motion, run in 50 digits by another code, is where the proof says and stays where it
says."""
import random
from fractions import Fraction

import numpy as np
import pytest

from stabilab import Body, ConstantTorque, Scene
from stabilab.numbers.numba_door import installed
from stabilab.unreduced import enclosure_kernel
from stabilab.unreduced.enclosure import _up, _Way, proved
from stabilab.unreduced.spin_up.certificate import Certifier
from stabilab.unreduced.spin_up.follow import LEVELS, spin_up, spin_up_many
from tests.oracles.pairs import model_of
from tests.oracles.taylor import integrate

from ..spin_up import scenes
from ..spin_up.scenes import EXAMPLE, random_scene, rates_of, sphere


@pytest.mark.one_in(2)
@pytest.mark.parametrize("n", (0, 1, 2, 4))
def test_random_motions_are_proved_to_spin_up_and_do(n):
    rng = random.Random(60 + n)
    scene, state = random_scene(rng, (0, .1)[n % 2]), sphere(rng, (3, .3)[n % 3 % 2])
    found = spin_up(scene, state, t_max=200, budget=4000, proof=True)
    assert found.level == "proved" and "is proved" in found.cause and "enclosed, within" in found.cause
    # a run in 50 digits
    true = np.array(integrate(model_of(scene), state, [found.t])[0], float) if found.t else np.array(state)
    assert np.abs(true - found.state).max() < 1e-13 * max(1, np.abs(true).max())
    times = np.linspace(0, 20, 201)
    spin = found.sense * scenes.run(rates_of(scene), true, times)[:, found.axis - 1]  # DOP853
    lines = np.array([found.trap.line(found.t + t) for t in times])
    assert (lines[:, 0] - 1e-7 <= spin).all() and (spin <= lines[:, 1] + 1e-7).all()


def test_a_proof_takes_fractions_and_decimals_at_their_word():
    found = [spin_up(EXAMPLE, state, proof=True)
             for state in (("0.5", "-0.7", "1.1"), (Fraction(1, 2), Fraction(-7, 10), Fraction(11, 10)))]
    assert found[0].level == found[1].level == "proved" and found[0].state == found[1].state
    at = spin_up(EXAMPLE, ("6", "0.1", "-0.1"), proof=True)  # where the inequality holds at the start itself
    assert at.level == "proved" and at.t == 0 and at.state == (6, .1, -.1)


def test_what_cannot_be_enclosed_stays_certified_and_says_so():
    found = spin_up(EXAMPLE, (.5, -.7, 1.))
    short = proved(EXAMPLE, (.5, -.7, 1.), found, steps=2)
    assert found.level == short.level == "certified" and short.trap == found.trap
    assert "not proved: after 2 validated steps" in short.cause and "used up" in short.cause


def test_a_set_that_is_too_wide_for_the_inequality_is_not_proved(monkeypatch):
    state = (.5, -.7, 1.)
    found = spin_up(EXAMPLE, state)
    sound = Certifier.constants
    wide = lambda self, middle, near, fast: sound(self, middle, near + 3.0, fast)
    monkeypatch.setattr(Certifier, "constants", wide)
    assert "does not hold for the whole set" in proved(EXAMPLE, state, found).cause


def test_exact_and_undecided_answers_stay_what_they_are():
    sphere_ = Scene(Body((1, 1, 1)), ConstantTorque((.1, .2, .3)))
    assert spin_up(sphere_, (1, 0, 0), proof=True).level == "exact"
    assert spin_up(EXAMPLE, (-9, 1, 1), t_max=.1, proof=True).level == "undecided"


def share_of(count, wheel, seed, **limits):
    """(proved, certified) of so many random motions."""
    rng, levels = random.Random(seed), []
    for _ in range(count):
        scene = random_scene(rng, wheel)
        levels.append(spin_up(scene, sphere(rng, rng.choice((.1, 1, 3, 10))), proof=True, **limits).level)
    return levels.count("proved"), count - levels.count("undecided")


@pytest.mark.skipif(not installed(), reason="thousands of steps take the compiled kernel")
@pytest.mark.slow
def test_motions_without_a_wheel_are_proved_and_nearly_all_others():
    alone, certified = share_of(100, 0, 11)
    assert certified == 100 and alone >= 99
    some, certified = share_of(60, None, 12, t_max=5e3, budget=60_000)
    assert some >= 0.92 * 60 and some >= certified - 1


@pytest.mark.skipif(not installed(), reason="thousands of steps take the compiled kernel")
def test_what_is_certified_is_proved():
    some, certified = share_of(12, .1, 13, t_max=200, budget=4000)
    assert some == certified >= 10


def test_many_are_proved_as_one_by_one():
    states = [sphere(random.Random(n), 2) for n in range(4)] + [(-9, 1, 1)]
    many = spin_up_many(EXAMPLE, states, t_max=12, proof=True)
    for number, state in enumerate(states):
        one, row = spin_up(EXAMPLE, state, t_max=12, proof=True), many.row(number)
        assert LEVELS[many.level[number]] == one.level == row.level and row.axis == one.axis == many.axis[
            number]
    assert set(many.level.tolist()) == {LEVELS.index("proved"), LEVELS.index("undecided")}
    assert len(spin_up_many(EXAMPLE, np.empty((0, 3)), proof=True).level) == 0


def test_the_radius_of_a_ball_does_not_vanish_in_small_units():
    for small in (Fraction(1), Fraction(1, 10**170), Fraction(1, 10**300)):
        assert _up([3 * small, 4 * small]) == pytest.approx(float(5 * small), rel=1e-11)  # Pythagoras
        assert _up(np.array([3.0, 4.0]) * float(small)) >= 5 * small


@pytest.mark.parametrize("length, steps", (
    (lambda n: 1e3 / (1e3 + n), 2 * 8192),  # shorter and shorter
    (lambda n: 1.0, 8 * 8192), (lambda n: 1.0 + n, 8 * 8192)))  # as long as ever, longer: followed
def test_a_way_whose_steps_grow_shorter_is_given_up_where_those_left_cannot_reach(length, steps):
    """Steps of lengths that are written here, summed here; a million time units are too far for the first two."""
    class Course:
        t, steps, status = 0.0, 0, enclosure_kernel.GOING

        def advance(self, t, steps):
            for _ in range(steps):
                self.t, self.steps = self.t + length(self.steps), self.steps + 1
    way = object.__new__(_Way)
    way.course = Course()
    assert way._slows_down(1e6, 150_000) == (steps < 8 * 8192) and way.course.steps == steps
