"""Tests of `orbit/separatrix/homoclinic.py`: what once went wrong there, and its edges."""
from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest

import stabilab
from stabilab.orbit.landscape import landscape
from stabilab.orbit.separatrix.homoclinic import real_cubic, settled
from tests.hunt.disagreements import off_surface
from tests.oracles.pairs import scaled
from tests.shared import SCALED_MINOR


@pytest.mark.parametrize("roots", [(1.0, 2.0, 4.0), (-3.0, 0.5, 0.5 + 1e-3), (2.0,), (-1.0, 5.0), ()])
def test_real_roots_of_cubics_and_of_what_is_left_of_them(roots):
    pairs = {0: [0.0, 1.0, 0.0, 1.0], 1: [0.0, 0.0, 3.0, -6.0]}  # t^2 + 1 and 3 t - 6
    c = pairs[len(roots)] if len(roots) < 2 else [*([0.0] * (3 - len(roots))), *np.poly(roots)]
    found = sorted(t for t in real_cubic(*c) if not math.isnan(t))
    np.testing.assert_allclose(found, roots, rtol=1e-9)
    # (t - 1)(t^2 + t + 2)
    assert sorted(t for t in real_cubic(1.0, 0.0, 1.0, -2.0) if not math.isnan(t)) == pytest.approx([1.0])
    assert all(map(math.isnan, real_cubic(0.0, 0.0, 0.0, 1.0))) and 0.0 in real_cubic(0.0, 1.0, 0.0, 0.0)


@pytest.mark.parametrize("roots", [(-2.7e9, 1.5, 5.7e-10), (9.8e9, -10.2, 1.04e-9), (2.9e8, -1.27, 4.4e-9),
                                   (1e6, 1.0, 1.0 + 1e-6),
                                   (1.0, 1e-5, -1e-5), (1e4, None)])
def test_roots_of_cubics_keep_their_digits_beside_much_larger_ones(roots):
    """Coefficients of products in exact arithmetic, rounded once; two roots as near as 1e-6 keep nine of
    their digits in these, and beside 1e4 stand those of t^2 + t + 1."""
    big, *small = (Fraction(t) for t in roots if t is not None)
    first, second = (-sum(small), small[0] * small[1]) if small else (Fraction(1), Fraction(1))
    c = [float(v) for v in (1, first - big, second - big * first, -big * second)]
    found = sorted(t for t in real_cubic(*c) if not math.isnan(t))
    digits = 1e-9 if roots[-1] == 1 + 1e-6 else 1e-14
    np.testing.assert_allclose(found, sorted(t for t in roots if t is not None), rtol=digits)


def test_a_loop_beside_the_centre_of_its_hyperbola_ends_where_the_potential_is_back():
    """mu = 3e-7 and c = 18.5: equilibria stand 1e9 to 1 and 1 to 1e9 in exp(y). The saddle's height and the
    potential at 50 digits are the check."""
    scene, problem = scaled(3.1287795379262113, 21.64743733428723, (0, 3.2175766464241995e-07, 0))
    branches = stabilab.separatrix(scene, shape=(7, 9)).branches
    assert {branch.name for branch in branches} >= {"branch 2, left loop", "branch 2, right loop"}
    for branch in branches:
        for row in (1, 2, 4):
            size, words = off_surface(problem, 1, branch, row, 4)
            assert size <= 1, words


@pytest.mark.parametrize("off", [0.0, 1e-9, 1e-3, 0.05])
def test_a_place_near_an_equilibrium_moves_onto_it_and_no_other(off):
    land = landscape(SCALED_MINOR)
    pot = land.potential
    # an equilibrium on the conic G X Z + c Z + d X + mu = 0 at Z = 2
    z = 2.0
    x = -(pot.c * z + pot.mu) / (pot.G * z + pot.d)
    found = settled(pot, pot.move((x, z), off))
    assert abs(pot.force(found)) < 1e-9 and math.hypot(*found) == pytest.approx(math.hypot(x, z), rel=1e-12)
    np.testing.assert_allclose(found, (x, z), atol=1e-8)
    flat = (0.05, 0.05)  # A^2 < 2: no equilibrium on this circle
    np.testing.assert_allclose(math.hypot(*settled(pot, flat)), math.hypot(*flat), rtol=1e-9)
