"""A change of outcome along one number: bracketed from a first size, narrowed to a width."""
import math
from fractions import Fraction

import numpy as np
import pytest

from stabilab.numbers.bracket import (
    LAST_PLACE,
    Bracket,
    first_bracket,
    halved_each,
    narrowed,
    side,
)


def counted(judge):
    """The judge, and the places that it was asked at."""
    places = []

    def asked(place):
        places.append(place)
        return judge(place)
    return asked, places


@pytest.mark.parametrize("sign", [1, -1])
def test_a_change_is_found_to_the_last_place_in_few_steps_where_margins_are_known(sign):
    judge, places = counted(lambda x: float(2 - (sign * x) ** 3))
    ends = Fraction(0), Fraction(sign * 2)
    same, other, _ = narrowed(judge, Bracket(*ends, (2.0, -6.0)))
    assert (sign * same) ** 3 < 2 < (sign * other) ** 3  # exact: the real root of x^3 = 2 is between
    assert abs(other - same) <= LAST_PLACE * abs(other)
    assert len(places) <= 20  # halving takes 52


def test_halving_takes_a_step_for_each_bit():
    judge, places = counted(lambda x: side(x * x < 2))
    same, other, _ = narrowed(judge, Bracket(Fraction(1), Fraction(2)), near=Fraction(1, 1000))
    assert same * same < 2 < other * other and other - same <= other / 1000
    assert len(places) == 10  # by hand: 2^-10 < 1.41/1000 < 2^-9


def test_a_margin_of_the_wrong_size_costs_steps_but_no_digit():
    # values far from linear: the line through two of them is no guide
    judge, places = counted(lambda x: math.copysign(1e-200 if x < 0.3 else 1e200, 0.3 - x))
    same, other, _ = narrowed(judge, Bracket(Fraction(0), Fraction(1), (1e-200, -1e200)))
    assert same < 0.3 <= other and other - same <= LAST_PLACE
    assert len(places) <= 4 * 52  # every fourth step halves the bracket, whatever the others do


def test_a_change_at_zero_is_narrowed_to_the_last_place_of_the_scale():
    same, other, _ = narrowed(lambda x: side(x > 0), Bracket(Fraction(3), Fraction(0)), scale=3)
    assert other == 0 < same <= 3 * LAST_PLACE**2


def test_a_place_whose_outcome_is_open_is_the_change():
    judge = lambda x: math.nan if x == Fraction(3, 4) else float(Fraction(3, 4) - x)
    assert narrowed(judge, Bracket(Fraction(0), Fraction(1)))[:2] == (Fraction(3, 4),) * 2


@pytest.mark.parametrize("seed", range(20))
def test_the_ends_have_the_outcomes_that_they_are_said_to_have_whatever_lies_between(seed):
    rng = np.random.default_rng(seed)
    cuts = np.sort(10 ** rng.uniform(-3, 3, 2 * rng.integers(1, 4) - 1))
    judge, places = counted(lambda x: side(np.searchsorted(cuts, float(x)) % 2 == 0))
    bracket = first_bracket(judge, Fraction(float(10 ** rng.uniform(-3, 3))), most=Fraction(10**6))
    same, other, _ = narrowed(judge, bracket)
    assert judge(same) > 0 > judge(other) and 0 <= other - same <= LAST_PLACE * other
    assert any(same <= cut <= other for cut in cuts)


@pytest.mark.parametrize("first", [Fraction(1, 7), Fraction(5), Fraction(300)])
def test_sizes_grow_or_shrink_to_the_first_change(first):
    same, other, (before, beyond) = first_bracket(lambda x: float(5 - x), first)
    assert same < 5 <= other == 2 * same and (before, beyond) == (float(5 - same), float(5 - other))


def test_where_there_is_no_change_none_is_found():
    judge, places = counted(lambda x: side(True))
    assert first_bracket(judge, 1, most=10) is None
    assert places == [1, 2, 4, 8, 10]
    assert first_bracket(lambda x: side(True), Fraction(1)) is None
    assert first_bracket(lambda x: side(False), 1, least=Fraction(1, 8))[:2] == (0, Fraction(1, 8))


@pytest.mark.parametrize("by_ratio", [False, True])
def test_many_lines_are_halved_at_once(by_ratio):
    cuts = np.array([0.1, 1.0, 3.0, 7.7])
    same, other = halved_each(lambda x: x < cuts, np.full(4, 0.01), np.full(4, 10.0), 40, by_ratio)
    assert (same < cuts).all() and (cuts <= other).all()
    # by hand: 9.99 2^-40, or 7.7 times 1000^(2^-40) - 1
    assert (other - same <= (5e-11 if by_ratio else 1e-11)).all()
