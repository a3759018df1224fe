"""Tests of `numbers/balls.py`: what once went wrong there, and its edges."""
from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from stabilab.numbers.balls import DOUBLE_BITS, Digits, settled
from stabilab.numbers.double_ball import Unclear


def test_real_roots_stand_in_order_where_some_are_multiple():
    product = np.polynomial.polynomial.polyfromroots([1, 2, 2, 3])  # oracle: the roots it is made from
    assert [(float(root.mid()), many) for root, many in Digits.real_roots(product.tolist())] == [(1, 1), (2, 2), (3, 1)]


def test_a_question_that_stays_unclear_is_unclear_in_the_end():
    asked = []

    def never(numbers):
        asked.append(numbers.bits)
        raise Unclear
    with pytest.raises(Unclear):
        settled(never, 128, 512)
    assert asked == [128, 256, 512]
    with pytest.raises(Unclear):
        settled(never, DOUBLE_BITS, DOUBLE_BITS)
    assert asked[3:] == [DOUBLE_BITS] and Digits.real_roots([Fraction(3)]) == [] and Digits.real_roots([]) == []
