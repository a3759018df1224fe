"""Bounds of what is linear in a step are bounds, and numbers keep more than a hundred bits."""
import random
from fractions import Fraction

import mpmath
import numpy as np
import pytest

from stabilab.unreduced.enclosure import kernel
from stabilab.unreduced.enclosure.run import twofold


def test_the_bound_of_a_flow_is_one():
    generator = np.random.default_rng(4)
    for _ in range(50):
        M = np.abs(generator.normal(size=(3, 3))) * 10.0 ** generator.uniform(-4, 1)
        G = np.empty((3, 3))
        kernel.bound_of_flow(M, G)
        with mpmath.workdps(60):
            true = mpmath.expm(mpmath.matrix(M.tolist()))
            # mpmath's
            assert all(true[i, j] <= G[i, j] <= true[i, j] * (1 + 1e-6) + 1e-8 for i in range(3)
                       for j in range(3))


@pytest.mark.parametrize("name", ["turned", "taken_along"])
def test_a_set_in_new_directions_holds_the_old_one(name):
    rng, taken = random.Random(5), 0
    for n in range(40):
        M = np.array([[rng.gauss(0, 1) for _ in range(3)] for _ in range(3)])
        if n % 4 == 0:
            M[:, 1] = M[:, 0] * (1 + 1e-9 * rng.random())  # edges nearly along each other
        old, rest = [10.0 ** rng.uniform(-20, -5)
                     for _ in range(3)], [10.0 ** rng.uniform(-25, -8) for _ in range(3)]
        rad, B = np.array(old), np.empty((3, 3))
        if getattr(kernel, name)(M, np.array(rest), rad, B) is False:
            assert rad.tolist() == old  # nothing is changed
            continue
        taken += 1
        with mpmath.workdps(60):
            inverse = mpmath.matrix(B.tolist()) ** -1
            for _ in range(8):
                edge, beside = ([mpmath.mpf(v) * rng.choice((-1, 1)) for v in lengths]
                                for lengths in (old, rest))
                corner = mpmath.matrix([sum(mpmath.mpf(float(M[i, c])) * edge[c] for c in range(3))
                                        + beside[i] for i in range(3)])
                r = inverse * corner
                assert all(abs(r[i]) <= rad[i] for i in range(3))  # exact arithmetic to 60 digits
    assert taken >= 29


def test_numbers_are_kept_to_more_than_a_hundred_bits():
    for value in (Fraction(1, 3), Fraction(-2, 7) * 10**9, Fraction(0), Fraction(10**30, 7)):
        (high,), (low,) = twofold([value])
        assert abs(Fraction(high) + Fraction(low) - value) <= abs(value) / 2**104
