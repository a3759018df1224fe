"""Tests of `numbers/polynomial.py`: what once went wrong there, and its edges."""
from __future__ import annotations

from fractions import Fraction

import pytest

from stabilab.numbers.polynomial import Poly, real_roots


@pytest.mark.parametrize("gap", [Fraction(1, 10**6), Fraction(1, 2**300), Fraction(1, 2**900)])
def test_rational_roots_however_close_are_each_found(gap):
    wanted = [Fraction(-7, 3), Fraction(0), Fraction(10, 7), Fraction(10, 7) + gap]
    p = Poly((1,))
    for root in wanted:
        p = p * Poly((-root, 1))
    found = real_roots(p, 64)
    assert len(found) == 4 and all(abs(f - w) <= abs(w) / 2**64 for f,
                                   w in zip(found, wanted)) and found == sorted(found)
    assert found == wanted  # exactly, doubles or not
    assert real_roots(Poly((5,))) == [] and real_roots(Poly((0, 0, 3))) == [0]


def test_a_root_has_as_many_digits_as_are_wanted():
    """The squares of what is returned lie about 2 by hand."""
    low, high = real_roots(Poly((-2, 0, 1)), 4096)
    assert low == -high and abs(high * high - 2) < Fraction(8, 2**4096)


def test_roots_of_other_factors_that_nearly_meet_stand_in_order():
    """(x^2 - 2)(x^2 - 2 - t) for t = 2^-700: the squares of the roots are 2 and 2 + t."""
    t = Fraction(1, 2**700)
    found = real_roots(Poly((-2, 0, 1)) * Poly((-2 - t, 0, 1)), 60)
    assert len(found) == 4 and found == sorted(found) and len(set(found)) == 4
    assert abs(found[3] ** 2 - 2 - t) < t / 4 and abs(found[2] ** 2 - 2) < t / 4


@pytest.mark.parametrize("away", [20, 300])
def test_a_bracket_may_begin_at_the_root_before(away):
    """1 is a trial point itself, and the next root stands 2^-away beyond it: both by construction."""
    wanted = [Fraction(1), 1 + Fraction(3, 2**away)]
    found = real_roots(Poly((-wanted[0], 1)) * Poly((-wanted[1], 1)) * Poly((1, 0, 1)), 700)
    assert len(found) == 2 and all(abs(f - w) <= w / 2**700 for f, w in zip(found, wanted))
