"""One state without arrays: balls of doubles hold the truth, and answers are those of the arrays."""
import math
import random
from fractions import Fraction

import mpmath
import numpy as np
import pytest

import stabilab
from stabilab import Body, ConstantTorque, Gyrostat, ScaledGyrostat, Scene
from stabilab.answers.motion import motion
from stabilab.numbers.balls import DOUBLE_BITS, START_BITS, settled
from stabilab.numbers.double_ball import Ball, Doubles, Unclear
from stabilab.orbit.ball_orbit import Orbit
from stabilab.orbit.fate.balls import decide
from stabilab.orbit.reduction import reduce
from stabilab.orbit.result import Fate
from stabilab.orbit.separatrix.distance.ask import distance_of

SCENES = {
    "circle": ScaledGyrostat("0.2", "0.4", (0, 0, 1)),
    "circle, major axis": Scene(Body((3, 2, 1)), Gyrostat(("0", "0.3", "0.1")), ConstantTorque((1, 0, 0))),
    "circle, no torque": Scene(Body((3, 2, 1)), Gyrostat(("0.5", 0, 0))),
    "hyperbola": ScaledGyrostat("0.2", "0.4", (0, 1, 0)),
    "hyperbola with saddles": ScaledGyrostat(0, 3, (0, 1, 0)),
    "parabola": Scene(Body((2, 2, 1)), Gyrostat((0, "0.25", "0.5")), ConstantTorque(("0.5", 0, 0))),
}


def holds(ball, truth) -> bool:
    return abs(mpmath.mpf(ball.m) - truth) <= ball.r


def test_balls_of_doubles_hold_the_exact_result_of_arithmetic():
    rng = random.Random(1)
    for _ in range(300):
        number = exact = None
        for _ in range(12):
            value = Fraction(rng.randint(-999, 999), rng.randint(1, 999))
            if number is None:
                number, exact = Doubles.ball(value), value
                continue
            which = rng.choice("+-*/")
            if which == "/" and not value:
                continue
            other = Doubles.ball(value)
            number = {"+": number.__add__, "-": number.__sub__, "*": number.__mul__, "/": number.__truediv__}[which](other)
            exact = {"+": exact + value, "-": exact - value, "*": exact * value, "/": value and exact / value}[which]
        assert abs(Fraction(number.m) - exact) <= Fraction(number.r)  # rationals share no code with the balls


@pytest.mark.parametrize("name", ["sqrt", "exp", "log", "atan", "sin", "cos"])
def test_balls_of_doubles_hold_the_functions_over_the_whole_ball(name):
    rng = random.Random(2)
    with mpmath.workdps(40):  # mpmath shares no code with the balls
        for _ in range(300):
            m, r = rng.uniform(0.1, 30), 10 ** rng.uniform(-17, -2)
            x = Ball(m, r)
            got = dict(zip(("sin", "cos"), x.sin_cos())).get(name) or getattr(x, name)()
            for part in (-1, -0.3, 0, 1):
                assert holds(got, getattr(mpmath, name)(mpmath.mpf(m) + mpmath.mpf(r) * part * (1 - 1e-16)))


def test_a_comparison_of_balls_is_true_only_where_it_is_certain():
    wide = Ball(1.0, 0.5)
    assert not wide > 1 and not wide < 1 and 1 in wide and wide > 0.4 and wide < 1.6 and not wide > 0.6


def test_roots_are_enclosed_and_double_ones_left_to_many_digits():
    def expanded(roots):
        c = [Fraction(1)]
        for root in roots:
            c = [a - root * b for a, b in zip([Fraction(0), *c], [*c, Fraction(0)])]
        return c
    roots = [Fraction(-7, 3), Fraction(1, 10), Fraction(2, 3), Fraction(50)]
    found = Doubles.real_roots(expanded(roots))
    assert len(found) == 4 and all(abs(Fraction(ball.m) - root) <= Fraction(ball.r) and ball.r < 1e-12 * abs(ball.m) for (ball, _), root in zip(found, roots))
    with pytest.raises(Unclear):
        Doubles.real_roots(expanded([Fraction(1, 3), Fraction(1, 3), Fraction(2)]))


def test_an_unclear_question_is_asked_again_in_many_digits():
    asked = []

    def question(numbers):
        asked.append(numbers.bits)
        if numbers.bits < 200:
            raise Unclear
        return numbers.bits
    assert settled(question, DOUBLE_BITS) == 2 * START_BITS and asked == [DOUBLE_BITS, START_BITS, 2 * START_BITS]


@pytest.mark.one_in(3)
@pytest.mark.parametrize("name", SCENES)
def test_one_state_has_the_fate_extremes_and_period_of_the_arrays(name):
    scene, rng = SCENES[name], np.random.default_rng(7)
    states = rng.uniform(-3, 3, (12, 3))
    decided, ranges, times = stabilab.fate(scene, states), stabilab.extremes(scene, states), stabilab.period(scene, states)
    for state, label, because, margin, axis, sense, pairs, time in zip(
            states, decided.labels, decided.because, decided.margins, decided.axis, decided.sense, ranges, times):
        one = motion(scene, state)
        assert (one.fate, one.axis, one.sense) == (label, axis, sense) and one.because.startswith(because)
        assert (one.margin_energy is None) == (not math.isfinite(margin))
        # both bound their own error by about 1e-12 of the terms; the arrays' formulas share no arithmetic with the balls
        assert one.margin_energy is None or abs(one.margin_energy - margin) < 1e-10 * (1 + abs(margin))
        assert np.allclose(np.array(one.extremes), pairs, rtol=2e-12, atol=2e-12 * np.abs(state).max())
        assert (one.period or math.inf) == pytest.approx(time if time > 0 else math.inf, rel=3e-11)


def test_next_to_the_separatrix_doubles_hand_over_and_the_label_is_right():
    scene = SCENES["circle"]
    reduction, state = reduce(scene), [2.0, 1.0, 0.0]
    margin = motion(scene, state).margin_energy
    edge = math.sqrt(2 * margin)  # the scaled energy is x3^2/2 + U: from here the motion just reaches the barrier
    for side, label in ((-1, Fate.BOUNDED), (1, Fate.SPIN_UP)):
        near = [2.0, 1.0, edge * (1 + side * 1e-13)]
        assert decide(Orbit(reduction, near), DOUBLE_BITS).bits > DOUBLE_BITS
        assert motion(scene, near).fate == label


def test_a_state_at_an_equilibrium_stays():
    found = motion(ScaledGyrostat(0, 0, (0, 0, 1)), (-1.0, 1.0, 0.0))  # x2 x1 = -1, x3 = 0
    assert found.fate == Fate.EQUILIBRIUM and found.extremes == ((-1.0, -1.0), (1.0, 1.0), (0.0, 0.0)) and found.period is None


@pytest.mark.parametrize("state", [(-15.1, 13.8, 7.3), (1.0, -8.0, -2.0), (-5.0, 3.0, -7.0)])
def test_no_vertex_of_a_fine_mesh_is_nearer_than_the_distance_from_the_separatrix(state):
    scene = SCENES["hyperbola with saddles"]
    distance = distance_of(reduce(scene), state).upper
    vertices = np.concatenate([s.points.reshape(-1, 3) for s in stabilab.separatrix(scene, reach=12, shape=(160, 201)).sheets])
    nearest = np.linalg.norm(vertices[np.isfinite(vertices).all(axis=1)] - np.array(state), axis=1).min()
    assert distance <= nearest * (1 + 1e-9)
