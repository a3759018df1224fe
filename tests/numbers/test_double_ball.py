"""Balls of doubles at the ends of what doubles hold: they contain the truth or say that they cannot.

Truths are mpmath's and Fraction's, which share no code with the balls.
"""
import math
import random
from fractions import Fraction

import mpmath
import pytest

from stabilab.numbers.double_ball import LEAST, Ball, Doubles, Unclear, real_roots_of


def covers(ball, truth) -> bool:
    return abs(Fraction(ball.m) - Fraction(truth)) <= Fraction(ball.r)


@pytest.mark.parametrize("m, r", [(1e291, 0.0), (-1e291, 0.0), (1e-291, 0.0), (-5e-324, 0.0), (1.0, math.inf), (math.nan, 0.0), (1.0, math.nan)])
def test_a_number_beyond_the_range_of_full_accuracy_is_left_to_many_digits(m, r):
    with pytest.raises(Unclear):
        Ball(m, r)


@pytest.mark.parametrize("one, other, how", [(1e-200, 1e-200, "__mul__"), (1e200, 1e200, "__mul__"), (1e-200, 1e200, "__truediv__"),
                                             (1e200, 1e-200, "__truediv__"), (9e289, 9e289, "__add__"), (1.0, 0.0, "__truediv__")])
def test_a_result_that_doubles_cannot_hold_is_left_to_many_digits(one, other, how):
    with pytest.raises(Unclear):
        getattr(Ball(one), how)(Ball(other))


@pytest.mark.parametrize("bad", [lambda: Ball(1.0) / Ball(1e-3, 1e-2), lambda: 1 / Ball(0.0, 1.0), lambda: Ball(1.0, 2.0).sqrt(), lambda: Ball(-1.0).sqrt(),
                                 lambda: Ball(1.0, 1.0).log(), lambda: Ball(-2.0).log(), lambda: Ball(700.0).exp(), lambda: Ball(710.0).exp(),
                                 lambda: Ball(599.0, 2.0).sinh(), lambda: Ball(-601.0).sinh()])
def test_a_function_beyond_its_range_is_left_to_many_digits(bad):
    with pytest.raises(Unclear):
        bad()


def test_integers_beyond_doubles_are_inside_their_balls():
    for value in (2**53 + 1, -(2**80) - 1, 3**60, 7):
        assert covers(Doubles.ball(value), value) and covers(Ball(0.0) + Doubles.ball(value), value)
    assert Doubles.ball(7).r == Doubles.ball(Fraction(7, 4)).r == Doubles.ball(0.1).r == 0 < Doubles.ball(Fraction(1, 10)).r


def test_an_exponential_too_small_for_doubles_is_a_ball_about_zero():
    with mpmath.workdps(30):
        for m in (-670.0, -700.0, -745.0, -1e6):
            ball = Ball(m, 1e-3).exp()
            assert abs(mpmath.mpf(ball.m) - mpmath.exp(mpmath.mpf(m) + mpmath.mpf("1e-3"))) <= ball.r <= LEAST and 0 in ball


def test_balls_hold_hyperbolic_sines_and_angles_over_the_whole_ball():
    rng = random.Random(3)
    with mpmath.workdps(40):
        for _ in range(200):
            m, r = rng.uniform(-40, 40), 10 ** rng.uniform(-16, -1)
            got = Ball(m, r).sinh()
            for part in (-1, 0, 1):
                assert abs(got.m - mpmath.sinh(mpmath.mpf(m) + part * mpmath.mpf(r))) <= got.r
            turn, size, blur = rng.uniform(-3, 3), 10 ** rng.uniform(-3, 3), 10 ** rng.uniform(-15, -3)
            y, x = (Ball(size * f(turn), size * blur) for f in (math.sin, math.cos))
            angle = Doubles.angle(y, x)
            for p in (-1, 1):
                for q in (-1, 1):
                    exact = mpmath.atan2(mpmath.mpf(y.m) + p * mpmath.mpf(y.r), mpmath.mpf(x.m) + q * mpmath.mpf(x.r))
                    assert abs(angle.m - exact) <= angle.r


@pytest.mark.parametrize("y, x", [(Ball(0.0, 1.0), Ball(0.5)), (Ball(0.0), Ball(0.0)), (Ball(0.0, 1e-9), Ball(-1.0)), (Ball(1e-10, 1e-9), Ball(-1.0))])
def test_the_angle_of_a_ball_about_the_origin_or_across_the_cut_is_left_open(y, x):
    with pytest.raises(Unclear):
        Doubles.angle(y, x)


def test_an_exact_zero_behind_the_origin_has_the_angle_pi():
    angle = Doubles.angle(Ball(0.0), Ball(-1.0, 0.25))
    assert abs(angle.m - mpmath.pi) <= angle.r < 1e-15


def test_the_least_and_the_greatest_of_two_balls_and_a_size_hold_those_of_all_their_numbers():
    rng = random.Random(4)
    for _ in range(300):
        a, b = (Ball(rng.uniform(-2, 2), rng.choice([0.0, rng.uniform(0, 2)])) for _ in range(2))
        for p in (-1, 0, 1):
            for q in (-1, 0, 1):
                u, v = (Fraction(x.m) + s * Fraction(x.r) for x, s in ((a, p), (b, q)))
                assert covers(a.min(b), min(u, v)) and covers(a.max(b), max(u, v)) and covers(abs(a), abs(u))
        assert a.abs_lower() <= abs(a.m) <= a.abs_upper()
    assert Ball(2.0).min(Ball(3.0, 0.5)).r == Ball(3.0).max(Ball(2.0, 0.5)).r == 0


def test_accuracy_is_infinite_for_an_exact_number_and_none_about_zero():
    assert Ball(3.0).rel_accuracy_bits() == Ball(0.0).rel_accuracy_bits() == math.inf
    assert Ball(0.0, 1.0).rel_accuracy_bits() == -math.inf and Ball(1024.0, 1.0).rel_accuracy_bits() == 10


def test_balls_are_equal_only_as_exact_numbers():
    assert Ball(1.0) == Ball(1.0) and Ball(1.0) != Ball(1.0, 1e-9) and Ball(1.0) != 1.0
    with pytest.raises(TypeError):
        hash(Ball(1.0))


def test_polynomials_without_a_root_and_of_first_degree():
    assert Doubles.real_roots([Fraction(3)]) == Doubles.real_roots([Fraction(2), 0, Fraction(1)]) == real_roots_of([]) == []
    ((root, many),) = Doubles.real_roots([Fraction(1, 3), Fraction(7), 0, 0])
    assert many == 1 and covers(root, Fraction(-1, 21)) and root.r < 1e-15
    roots = [ball for ball, _ in Doubles.real_roots([0, Fraction(-4), 0, Fraction(1)])]
    assert [r.m for r in roots] == [-2.0, 0.0, 2.0] and all(covers(r, t) for r, t in zip(roots, (-2, 0, 2)))


@pytest.mark.parametrize("bend", [Fraction(1, 10**7), Fraction(0)])
def test_a_root_that_is_nearly_triple_is_left_to_many_digits(bend):
    with pytest.raises(Unclear):  # (t - 1)^3 + bend (t - 1) rises everywhere, but hardly at its root
        Doubles.real_roots([-1 - bend, 3 + bend, -3, 1])


def test_a_polynomial_whose_terms_leave_the_doubles_is_left_to_many_digits():
    with pytest.raises(Unclear):
        Doubles.real_roots([Fraction(-1), Fraction(10) ** 150, 0, Fraction(-1, 10**250)])  # 1e349 at its turns
