"""Common divisors over the field of an algebraic number: of products that are made to have them."""
from __future__ import annotations

import numpy as np
import pytest
from flint import fmpq, fmpq_poly

from stabilab.numbers.algebraic import field_gcd

ROOT_TWO = fmpq_poly([-2, 0, 1])


def times(number, f, g):
    out = [fmpq_poly([0])] * (len(f) + len(g) - 1)
    for n, a in enumerate(f):
        for k, b in enumerate(g):
            out[n + k] = (out[n + k] + a * b) % number
    return out


def test_a_root_that_two_polynomials_share_is_found():
    # (x - r)(x^2 + 1) and (x - r)(x + 3) for r the square root of two; with x + r in the place of one x - r
    # they share none
    line, other = [fmpq_poly([0, -1]), fmpq_poly([1])], [fmpq_poly([0, 1]), fmpq_poly([1])]
    f, g = times(ROOT_TWO, line,
                 [fmpq_poly([c]) for c in (1, 0, 1)]), times(ROOT_TWO, line, [fmpq_poly([c]) for c in (3, 1)])
    assert field_gcd(ROOT_TWO, f, g) == line
    assert field_gcd(ROOT_TWO, f, times(ROOT_TWO, other, g)) == line
    assert field_gcd(ROOT_TWO, f,
                     times(ROOT_TWO, other, [fmpq_poly([3]), fmpq_poly([1])])) == [fmpq_poly([1])]


@pytest.mark.parametrize("seed", range(6))
def test_the_divisor_of_random_products_is_the_factor_they_share(seed):
    rng = np.random.default_rng(seed)
    number = fmpq_poly([*(int(v) for v in rng.integers(-50, 50, 7)), 1])
    while len(number.factor()[1]) > 1 or number.factor()[1][0][1] > 1:
        number += 1
    element = lambda: fmpq_poly([fmpq(int(a), int(b)) for a,
                                 b in zip(rng.integers(-99, 99, 7), rng.integers(1, 20, 7))])
    shared = [*(element() for _ in range(int(rng.integers(1, 4)))), fmpq_poly([1])]
    f, g = (times(number, shared, [element() for _ in range(4)]) for _ in range(2))
    assert field_gcd(number, f, g) == shared
    assert field_gcd(number, g, f) == shared
