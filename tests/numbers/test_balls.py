"""Tests of `numbers/balls.py`: what once went wrong there, and its edges."""
from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from flint import fmpq

from stabilab.numbers import balls
from stabilab.numbers.balls import FIRST_BITS, Digits, Unclear, settled, working
from stabilab.numbers.polynomial import Poly


def test_real_roots_stand_in_order_where_some_are_multiple():
    product = np.polynomial.polynomial.polyfromroots([1, 2, 2, 3])  # oracle: the roots it is made from
    assert [(float(root.mid()), many) for root,
            many in Digits.real_roots(product.tolist())] == [(1, 1), (2, 2), (3, 1)]


def test_a_question_that_stays_unclear_is_unclear_in_the_end():
    asked = []

    def never(numbers):
        asked.append(numbers.bits)
        raise Unclear
    with pytest.raises(Unclear):
        settled(never, 128, 512)
    assert asked == [128, 256, 512]
    with pytest.raises(Unclear):
        settled(never, FIRST_BITS, FIRST_BITS)
    assert asked[3:] == [FIRST_BITS] and Digits.real_roots([Fraction(3)]) == [] and Digits.real_roots(
        []) == []


@pytest.mark.one_in(2)
@pytest.mark.parametrize("power", [200, 600, pytest.param(1200, marks=pytest.mark.slow)])
@pytest.mark.parametrize("way, known", [(2, 4), (-2, 2)])
def test_roots_that_nearly_meet_are_found_by_sturms_theorem_and_not_by_an_iteration_of_seconds(
    way, known, power, monkeypatch):
    # (x^2 - 3)((x - 1)^2 - way t^2): the roots are +-sqrt 3 and, where way = 2, 1 +- t sqrt 2
    t, asked, by_sturm = Fraction(1, 10**power), [], balls._by_sturm
    monkeypatch.setattr(balls, "_by_sturm", lambda factor: asked.append(factor) or by_sturm(factor))
    with working(8 * power):
        product = Poly((-3, 0, 1)) * Poly((1 - way * t * t, -2, 1))
        found = Digits.real_roots(product.c)
        pair = ([1 - Digits.ball(t) * Digits.ball(2).sqrt(), 1 + Digits.ball(t) * Digits.ball(2).sqrt()]
                if way > 0 else [])
        ends = Digits.ball(3).sqrt()
        assert len(found) == known and all(root.overlaps(true) and many == 1 for (root, many),
                                           true in zip(found, [-ends, *pair, ends]))
        assert not any(a.overlaps(b) for (a, _), (b, _) in zip(found, found[1:]))
    assert asked


@pytest.mark.parametrize("power", [10, 200, 1200])
def test_two_roots_that_nearly_meet_are_parted_without_halving_the_way_between_them(power, monkeypatch):
    # (x^2 - 3)((x - 1)^2 - 2 t^2): the roots are 1 +- t sqrt 2; halving takes 3.3 power steps
    t, halved, middle = Fraction(1, 10**power), [], balls._middle
    monkeypatch.setattr(balls, "_middle", lambda a, b: halved.append(a) or middle(a, b))
    product = balls.polynomial(*(Poly((-3, 0, 1)) * Poly((1 - 2 * t * t, -2, 1))).c)
    place = balls._between_two(product, fmpq(3, 5), fmpq(6, 5))
    assert (balls.fraction(place) - 1) ** 2 < 2 * t * t
    assert len(halved) < 20
