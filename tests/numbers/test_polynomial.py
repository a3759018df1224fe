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
    assert len(found) == 4 and all(abs(f - w) <= abs(w) / 2**64 for f, w in zip(found, wanted)) and found == sorted(found)
    assert real_roots(Poly((5,))) == [] and real_roots(Poly((0, 0, 3))) == [0]
