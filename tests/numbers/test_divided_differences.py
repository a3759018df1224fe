"""Divided differences of the exponential against the exponential of a bidiagonal matrix in ball arithmetic
(Opitz)."""
import math

import numpy as np
import pytest

from stabilab.errors import InputError
from stabilab.numbers.double_double import Twofold, divided_differences, twofold

flint = pytest.importorskip("flint")
BITS = 400
ALLOWED = 20  # times the effect of half a unit in the last place of the nodes, of t and of the answer


def divided_difference(nodes, t, low=None):
    """D[x0 ... xn](t) of one list of nodes."""
    once = (1,) * len(nodes)
    return divided_differences(nodes, [once], t, [0.0] * len(nodes) if low is None else low)[once]


def opitz(nodes, t):
    """D as the corner of exp(t B), B with the nodes on the diagonal and ones above it (Opitz 1964): no
    division at all."""
    n = len(nodes)
    B = flint.acb_mat(n, n)
    for row, node in enumerate(nodes):
        B[row, row] = node * t
        if row + 1 < n:
            B[row, row + 1] = t
    return B.exp()[0, n - 1]


def error_in_half_units(value, nodes, t):
    """Error of `value` over the change that half a unit in the last place of every node, of t and of the
    answer makes.

    dD/dx_j is D with x_j taken once more; dD/dt is a difference quotient with a step of 2^-120.
    """
    with flint.ctx.workprec(BITS):
        balls, t_ball, step = [flint.acb(z.real, z.imag)
                               for z in nodes], flint.acb(t), flint.acb(2) ** -120 * t
        exact = opitz(balls, t_ball)
        effect = abs(exact) * 2.0**-53 + abs((opitz(balls, t_ball + step) - exact) / step) * (math.ulp(t) / 2)
        for node, z in zip(balls, nodes):
            effect += abs(opitz([*balls, node], t_ball)) * (math.ulp(abs(z)) / 2)
        return float((abs(flint.acb(value.real, value.imag) - exact) / effect).mid())


def check(nodes, t):
    value = complex(divided_difference(nodes, t))
    assert error_in_half_units(value, nodes, t) <= ALLOWED, (nodes, t)


@pytest.mark.one_in(4)
@pytest.mark.parametrize("distance", [0.0, *(10.0**-n for n in range(2, 15))])
@pytest.mark.parametrize("nodes",
                         [lambda d: (0, 0, 0, 1j * d, 1.3j, 0.7j), lambda d: (0, 1j, 1j * (1 + d), -1j),
                                   lambda d: (0, 0, 0, 2j, 2j + d, 2j - d), lambda d: (d, -d, 0, 0, 0.4j)],
                         ids=["near zero", "near each other", "unstable pair", "growing pair and oscillator"])
def test_clusters_at_every_distance_keep_their_digits(nodes, distance):
    for t in (1e-12, 1e-3, 0.5, 3.0, 7.7, 40.0, 1e3):
        check([complex(z) for z in nodes(distance)], t)


def test_imaginary_nodes_keep_their_digits_from_1e_minus_12_to_1e9():
    rng = np.random.default_rng(3)
    for t in 10.0 ** np.arange(-12, 10):
        pool = [0j, *(1j * rng.uniform(-3, 3, 3))]
        pool.append(pool[1] * (1 + 10.0 ** rng.uniform(-14, -1)))
        for size in (2, 4, 6):
            check([pool[i] for i in rng.integers(len(pool), size=size)], float(t))


def test_real_and_complex_nodes_keep_their_digits():
    rng = np.random.default_rng(4)
    for _ in range(60):
        nodes = [complex(x, y) for x,
                 y in rng.uniform(-2, 2, (rng.integers(2, 7), 2)) * 10.0 ** rng.uniform(-4, 0)]
        check(nodes, float(10.0 ** rng.uniform(-2, 2)))


def test_one_call_for_many_times_agrees_with_single_calls():
    rng = np.random.default_rng(5)
    t = 10.0 ** rng.uniform(-3, 3, (2, 11))
    for w in 10.0 ** rng.uniform(-9, 2, 7):
        D = divided_differences([0, -0.4j, 1j * w, -1j * w], [(2, 1, 1, 1), (1, 0, 1, 1)], t, [0.0] * 4)
        for counts, nodes in (((2, 1, 1, 1), (0, 0, -0.4j, 1j * w, -1j * w)),
                              ((1, 0, 1, 1), (0, 1j * w, -1j * w))):
            alone = [[complex(divided_difference(nodes, y)) for y in row] for row in t]
            # the series may take a term more in a batch
            np.testing.assert_allclose(D[counts], alone, rtol=2e-14)


def test_what_nodes_lost_to_rounding_counts_in_their_difference():
    # 1 + d in twofold form: e^(it) (e^(idt) - 1)/(id) has the size |sin(d t/2)/(d/2)|; the rounded node alone
    # gives 0
    d, t = 3e-17, 1e17
    value = complex(divided_difference([1j, 1j], t, low=[0.0, 1j * d]))
    assert abs(value) == pytest.approx(abs(math.sin(d * t / 2) / (d / 2)), rel=1e-14)


def test_symmetric_in_the_nodes_and_zero_time_selects_the_single_node():
    nodes = (0.3j, -1j, 0.2, 0.3j)
    assert complex(divided_difference(nodes,
                                      1.7)) == pytest.approx(complex(divided_difference(nodes[::-1], 1.7)),
                                                             rel=1e-15)
    assert divided_difference((1j,), 0.0) == 1 and divided_difference((1j, 2j), 0.0) == 0


def test_growth_beyond_the_largest_double_is_refused():
    with pytest.raises(InputError, match="shorter times"):
        divided_difference((0, 1.0), 1000.0)


def test_twofold_numbers_keep_32_digits():
    from fractions import Fraction
    rng = np.random.default_rng(6)
    exact = lambda z: Fraction(float(z.high)) + Fraction(float(z.low))
    for _ in range(200):
        x, y = (Twofold(*map(np.float64, (v, v * 2.0**-54 * u))) for v,
                u in zip(10.0 ** rng.uniform(-5, 5, 2), rng.uniform(-1, 1, 2)))
        for got, want in ((x + y, exact(x) + exact(y)), (x - y, exact(x) - exact(y)),
                          (x * y, exact(x) * exact(y)),
                          (x / y, exact(x) / exact(y))):
            assert abs(exact(got)
                       - want) <= abs(want) * Fraction(2) ** -100 + (abs(exact(x))
                                                                     + abs(exact(y))) * Fraction(2) ** -104
    assert (1 - twofold(1e-20)).value() == 1.0 and float((1 - twofold(1e-20)).low) == -1e-20
