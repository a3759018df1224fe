"""Real roots of exact polynomials against the factors that the polynomials are made of."""
from __future__ import annotations

from fractions import Fraction as F

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stabilab.numbers.polynomial import Poly, real_roots

TINY = F(1, 10**180)  # products of these vanish in doubles
ROOTS = {
    "none": [], "zero": [0], "zero three times": [0, 0, 0], "zero and another": [0, 5], "opposite": [-3, 3],
    "twice": [1, 1, -2], "three times": [3, 3, 3], "decades apart": [F(1, 3), 10**40, F(-1, 10**40)],
    "close": [2, 2 + F(1, 10**9), 2 + F(2, 10**9)], "tiny": [TINY, 2 * TINY, 10 * TINY],
    **{f"2^-{n} apart": [F(-7, 3), 0, F(10, 7), F(10, 7) + F(1, 2**n)] for n in (20, 300, 900)},
    **{f"2^-{n} from a trial point": [1, 1 + F(3, 2**n)] for n in (20, 300)}}


def assert_roots(roots, scale):
    product = Poly((scale,)) * Poly((1, 0, 1)) * Poly((F(7, 10**9), 0, 3))  # no real root of theirs
    for root in roots:
        product = product * Poly((-root, 1))
    found, wanted = real_roots(Poly((*product.c, 0, 0)), 64), sorted(set(roots))
    assert found == sorted(found) and len(found) == len(wanted)
    assert all(abs(one - root) <= abs(root) / 2**64 for one, root in zip(found, wanted))


@pytest.mark.parametrize("scale", [F(1), F(10)**-400, -F(10)**310], ids=["1", "1e-400", "-1e310"])
@pytest.mark.parametrize("roots", ROOTS.values(), ids=ROOTS)
def test_each_root_is_found_once_however_close_to_others(roots, scale):
    assert_roots(roots, scale)


@settings(max_examples=60, deadline=None)
@given(st.lists(st.tuples(st.fractions(-1000, 1000, max_denominator=10**6), st.integers(-12, 12)),
                min_size=1, max_size=6, unique=True),
       st.integers(1, 3), st.fractions(1, 1000), st.integers(-300, 300))
def test_products_of_linear_factors_have_their_roots_however_often(parts, power, scale, decades):
    roots = [value * F(10)**n for value, n in parts]
    assert_roots(roots + roots[:1] * (power - 1), scale * F(10)**decades)


@pytest.mark.parametrize("power", [1, 2])
def test_a_root_has_as_many_digits_as_are_wanted(power):
    """The squares of what is returned lie about 2 by hand."""
    square = Poly((-2, 0, 1))
    low, high = real_roots(square if power == 1 else square * square, 4096)
    assert low == -high and abs(high * high - 2) < F(8, 2**4096)


def test_roots_of_other_factors_that_nearly_meet_stand_in_order():
    """(x^2 - 2)(x^2 - 2 - t) for t = 2^-700: the squares of the roots are 2 and 2 + t."""
    t = F(1, 2**700)
    found = real_roots(Poly((-2, 0, 1)) * Poly((-2 - t, 0, 1)), 60)
    assert len(found) == 4 and found == sorted(found) and len(set(found)) == 4
    assert abs(found[3] ** 2 - 2 - t) < t / 4 and abs(found[2] ** 2 - 2) < t / 4
