"""The compiled steps do what is written, operation by operation, and their bounds of what is linear are
bounds."""
import random
from fractions import Fraction

import mpmath
import numpy as np
import pytest

from stabilab.numbers.numba_door import installed
from stabilab.unreduced.enclosure import kernel
from stabilab.unreduced.enclosure.digits import functions, twofold


@pytest.mark.skipif(not installed(), reason="nothing is compiled without numba")
def test_the_compiler_fuses_and_rearranges_nothing():
    """Python itself rounds each operation by itself: thousands of them, in the same order, give the same
    bits."""
    generator, table = np.random.default_rng(3), functions()
    numbers, low = generator.normal(size=(4, 3)), generator.normal(size=(4, 3)) * 2.0**-54
    def both(name, make, *changed):
        one, two = make(), make()
        got = [getattr(kernel, name)(*one), table[name](*two)]
        assert got[0] == got[1]
        for i in changed:
            assert one[i].tobytes() == two[i].tobytes(), name
        return one
    start = generator.normal(size=3)
    def fresh():
        a, rest = np.zeros((3, kernel.ORDER + 1)), np.zeros((3, kernel.ORDER + 1))
        a[:, 0], rest[:, 0] = start, start * 2.0**-55
        return numbers, low, 0.25, a, rest
    a = both("series", fresh, 3, 4)
    B = np.linalg.qr(generator.normal(size=(3, 3)))[0]
    V = both("variations", lambda: (numbers, 0.25, a[3], B, np.zeros((kernel.ORDER + 1, 3, 3))), 4)[4]
    rad = np.array([1e-20, 1e-24, 1e-22])
    out = lambda: [np.zeros(3), np.zeros(3), np.zeros(3), np.zeros((3, 3)), np.zeros(3)]
    made = both("judged", lambda: [numbers, np.ones(4), kernel.FINE, a[3], V, B, rad, 0.0625, 0.25, *out()],
                9, 10, 11, 12, 13)
    assert made[9].max() > 0
    M = both("end_of_variations", lambda: [V, 0.25, np.zeros((3, 3))], 2)[2]
    both("taken_along", lambda: [M, made[11], rad.copy(), B.copy()], 2, 3)
    both("turned", lambda: [M, made[11], rad.copy(), B.copy()], 2, 3)
    both("at_end", lambda: [a[3], a[4], 0.25, np.zeros(3), np.zeros(3)], 3, 4)


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
