"""Tests of `orbit/separatrix/homoclinic.py`: what once went wrong there, and its edges."""
from __future__ import annotations

import math

import numpy as np
import pytest

from stabilab.orbit.landscape import landscape
from stabilab.orbit.separatrix.circle_kernel import force, moved, real_cubic
from stabilab.orbit.separatrix.circle_kernel import settled as settled_on_circle
from tests.shared import SCALED_MINOR


@pytest.mark.parametrize("roots", [(1.0, 2.0, 4.0), (-3.0, 0.5, 0.5 + 1e-3), (2.0,), (-1.0, 5.0), ()])
def test_real_roots_of_cubics_and_of_what_is_left_of_them(roots):
    pairs = {0: [0.0, 1.0, 0.0, 1.0], 1: [0.0, 0.0, 3.0, -6.0]}  # t^2 + 1 and 3 t - 6
    c = pairs[len(roots)] if len(roots) < 2 else [*([0.0] * (3 - len(roots))), *np.poly(roots)]
    found = sorted(t for t in real_cubic(*c) if not math.isnan(t))
    np.testing.assert_allclose(found, roots, rtol=1e-9)
    assert sorted(t for t in real_cubic(1.0, 0.0, 1.0, -2.0) if not math.isnan(t)) == pytest.approx([1.0])  # (t - 1)(t^2 + t + 2)
    assert all(map(math.isnan, real_cubic(0.0, 0.0, 0.0, 1.0))) and 0.0 in real_cubic(0.0, 1.0, 0.0, 0.0)


@pytest.mark.parametrize("off", [0.0, 1e-9, 1e-3, 0.05])
def test_a_place_near_an_equilibrium_moves_onto_it_and_no_other(off):
    land = landscape(SCALED_MINOR)
    pot = land.potential
    g = pot.G, pot.c, pot.d, pot.mu
    # an equilibrium on the conic G X Z + c Z + d X + mu = 0 at Z = 2
    z = 2.0
    x = -(pot.c * z + pot.mu) / (pot.G * z + pot.d)
    start = moved(x, z, off)
    found = settled_on_circle(g, *start)
    assert abs(force(g, *found)) < 1e-9 and math.hypot(*found) == pytest.approx(math.hypot(x, z), rel=1e-12)
    np.testing.assert_allclose(found, (x, z), atol=1e-8)
    flat = (0.05, 0.05)  # A^2 < 2: no equilibrium on this circle
    np.testing.assert_allclose(math.hypot(*settled_on_circle(g, *flat)), math.hypot(*flat), rtol=1e-9)
