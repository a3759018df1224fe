"""Tests of `equilibrium/field/verdict.py`: what once went wrong there, and its edges."""
from __future__ import annotations

import numpy as np
import pytest

from stabilab import Body, Gyrostat, Scene
from stabilab.answers.equilibria import equilibria
from stabilab.physics.effects.gravity import Gravity


@pytest.mark.parametrize("wheel", [1, 30])
def test_a_sphere_with_its_weight_along_the_wheel_sleeps_upside_down_but_for_slow_spins(wheel):
    """Lagrange's sleeping top: (Lambda - D Omega)^2 > 4 D M g z with gamma = -e3."""
    curves = equilibria(Scene(Body((3, 3, 3)), Gravity(20, (0, 0, "0.1")), Gyrostat((0, 0, wheel)))).curves
    (upright,) = [c for c in curves if c.point(0.0)[5] == -1]
    (unstable,) = [s.t for s in upright.segments if s.verdict == "unstable"]
    np.testing.assert_allclose(unstable, [(wheel - 24**0.5) / 3, (wheel + 24**0.5) / 3], rtol=1e-14)
    assert {s.verdict for s in upright.segments if s.t != unstable} == {"stable"}
