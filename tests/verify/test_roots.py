"""Zeros that the checker tells apart: however close two irrational ones lie, up to the halvings and the work
it is willing to take. Oracle: squares of integers."""
from __future__ import annotations

from fractions import Fraction
from math import isqrt

import pytest

from stabilab.verify import roots
from stabilab.verify.numbers import Malformed
from stabilab.verify.roots import TooLarge, Work, real_roots

flint = pytest.importorskip("flint")


def real_zeros(polynomial):
    return real_roots(polynomial, Work())


def squares(*values):
    """prod (x^2 - v): its zeros are +-sqrt v, irrational where v is no square of a fraction."""
    poly = flint.fmpq_poly([1])
    for value in map(Fraction, values):
        poly *= flint.fmpq_poly([-flint.fmpq(value.numerator, value.denominator), 0, 1])
    return poly


@pytest.mark.parametrize("apart", [Fraction(1, 10), Fraction(1, 10**30), Fraction(1, 10**300)])
def test_zeros_of_two_factors_come_rising_and_apart_however_close_they_lie(apart):
    near, far = Fraction(2), 2 + apart
    zeros = real_zeros(squares(far, near))
    assert len(zeros) == 4 and all(a.high < b.low for a, b in zip(zeros, zeros[1:]))
    # sqrt of the value lies in the bracket: its ends' squares lie on both sides
    for zero, value in zip(zeros, (far, near, near, far)):
        ends = sorted(end * end for end in (zero.low, zero.high))
        assert ends[0] <= value <= ends[1]
    assert all(a.before(b) and not b.before(a) for a, b in ((zeros[0], zeros[1]), (zeros[2], zeros[3])))
    # enclosed apart from each other, so that their brackets may overlap
    lesser, larger = real_zeros(squares(near))[1], real_zeros(squares(far))[1]
    assert lesser.before(larger) and not larger.before(lesser)


@pytest.mark.parametrize("bits", [40, 400, 4000])
def test_an_irrational_zero_is_within_two_fractions_only_if_their_squares_say_so(bits):
    below = Fraction(isqrt(2 << 2 * bits), 1 << bits)
    step = Fraction(1, 1 << bits)
    assert below**2 < 2 < (below + step) ** 2
    negative, zero = real_zeros(squares(2))
    assert zero.within(below,
                       below + step) and zero.within(Fraction(1),
                                                     Fraction(2)) and negative.within(-below - step, -below)
    assert not zero.within(below - step, below) and not zero.within(below + step, Fraction(2))
    assert not negative.within(below, below + step)


def test_a_rational_zero_is_exact_and_lies_within_its_own_bounds():
    (zero,) = real_zeros(flint.fmpq_poly([-1, 3]))
    third = Fraction(1, 3)
    assert (zero.low, zero.high) == (third, third) and zero.within(third, third)
    assert not zero.within(third + Fraction(1, 10**40), Fraction(1))


def test_what_the_most_halvings_do_not_tell_apart_is_refused_with_the_reason(monkeypatch):
    monkeypatch.setattr(roots, "HALVINGS", 100)
    _, zero = real_zeros(squares(2))
    end = Fraction(isqrt(2 << 400), 1 << 200)
    with pytest.raises(Malformed, match="a bracket whose end 100 halvings do not tell from a zero"):
        zero.within(end, Fraction(2))


def test_zeros_that_ask_for_too_much_work_are_given_up():
    with pytest.raises(TooLarge):
        real_zeros(squares(2, 2 + Fraction(1, 1 << 20_000)))
