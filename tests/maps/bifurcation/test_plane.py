"""A diagram over two numbers: its cusps by hand, the number in its regions by exact elimination, its curves
by the diagram over one."""
from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

import stabilab
from stabilab.maps.bifurcation.plane import count_at
from tests.maps.bifurcation.test_line import exactly, random_numbers, written
from tests.shared import CASES


def test_the_cusp_of_the_middle_axis_is_the_papers():
    # |c| = 4 * 3^(-3/4); there g^4 + c g + 1 has the double root g = -3^(-1/4), x3 = g and x1 + b = c + 1/g
    # (docs/mathematics)
    found = stabilab.bifurcation(CASES / "middle-axis-double-well.toml", {"b": "0:4", "x[1]": "-3:3"})
    (cusp,) = found.cusps
    c, g = 4 * 3**-0.75, -(3**-0.25)
    assert cusp.at[0] == pytest.approx(c, rel=1e-15)
    assert cusp.state == pytest.approx((1 / g, 0.0, g), rel=1e-14, abs=1e-15)  # x1 = c + 1/g - b, and b = c
    # the start is on the hyperbola of the cusp: (x1 + b)^2 - x3^2 is the same
    start = (cusp.at[1], 0.2, -1.6)
    assert (start[0] + c)**2 - start[2]**2 == pytest.approx((cusp.state[0] + c)**2 - g**2, rel=1e-12)


def test_the_border_of_the_double_well_is_the_discriminant_of_its_quartic():
    # by hand with a = 0, g = x3, x1 = mu/g: m = x1 (x1 + b) + x3^2 = (g^4 + b mu g + mu^2)/g^2, whose quartic
    # has a double root
    # where 256 (mu^2)^3 = 27 (b mu)^4
    found = stabilab.bifurcation(CASES / "middle-axis-double-well.toml",
                                 {"b": (Fraction(1, 10), 4), "mu[2]": (Fraction(1, 10), 3)}, curve=True)
    assert "27*p^4 - 256*q^2" in [str(curve) for curve in found.curves]
    for b, mu in ((1, Fraction(1, 5)), (2, Fraction(13, 10)), (2, Fraction(12, 10)), (3, Fraction(29, 10)),
                  (3, Fraction(1, 2))):
        assert count_at(found, Fraction(b), Fraction(mu)) == (2 if 27 * b**4 > 256 * mu**2 else 0)


@pytest.fixture
def check(tmp_path):
    def one(seed, places):
        """Places of the plane of one random scene off the axes that were checked."""
        rng = np.random.default_rng(seed)
        D, lam, M = random_numbers(rng)
        i, j = (int(n) for n in rng.integers(3, size=2))
        if len(set(D)) < 3 or sum(m != 0 for n, m in enumerate(M) if n != i) < 2:
            return 0
        first, second = (M, i), (lam, j)
        ends = [(row[n] - 2, row[n] + 2) for row, n in (first, second)]
        found = stabilab.bifurcation(written(tmp_path, D, lam, M),
                                     {f"torque[{i + 1}]": ends[0], f"momentum[{j + 1}]": ends[1]})
        for _ in range(places):
            p, q = (low + (high - low) * Fraction(int(rng.integers(1, 10**6)), 10**6) for low, high in ends)
            M[i], lam[j] = p, q
            assert count_at(found, p, q) == exactly(D, lam, M), (seed, float(p), float(q))
        return places
    return one


@pytest.mark.parametrize("seeds, places", [(range(6), 10), pytest.param(range(100, 140), 50, marks=pytest.mark.slow),
                                           pytest.param(range(140, 200), 50, marks=[pytest.mark.slow, pytest.mark.long])])
def test_regions_off_the_axes_have_the_number_that_elimination_gives(check, seeds, places):
    # tests/oracles, nothing of the package
    assert sum(check(seed, places) for seed in seeds) >= 0.4 * places * len(seeds)


def test_a_plane_in_which_moments_become_equal_is_told():
    # where D1 = D2 the equations of the motion's curve lose their highest power for every torque: no cusp
    # stands there
    found = stabilab.bifurcation(CASES / "symmetric-spin-up.toml",
                                 {"inertia[1]": ("1.92", "2.08"), "torque[3]": ("-0.1", "0.3")})
    assert found.strips and not found.cusps
