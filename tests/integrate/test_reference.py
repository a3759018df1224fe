"""Tests of `integrate/reference.py`: what once went wrong there, and its edges."""
from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from stabilab import Body, ConstantTorque, ScaledGyrostat, Scene
from stabilab.integrate.reference import reference


def test_a_motion_from_rest_in_many_digits_starts_by_the_torque():
    found = reference(Scene(Body((3, 2, "1.5")), ConstantTorque((0, 0, 3))), (0, 0, 0), [0.25, 1.5])
    np.testing.assert_array_equal(found.states, [[0, 0, 0.5], [0, 0, 3]])  # omega3 = M3 t/D3, by hand


@pytest.mark.slow
def test_a_motion_that_grows_a_change_by_ninety_powers_of_ten_keeps_its_digits():
    """By hand: x1' = x2 x3, x2' = 1 - x3 (x1 + 1/2), x3' = x2 (x1 + 1), so (x1 + 1 + x3)' = x2 (x1 + 1 + x3):
    a change off the plane on which this is 0 grows as exp(integral of x2), some e^210, and runs in 84 and 168
    digits part. On the plane x3' = -x2 x3."""
    scene = ScaledGyrostat(Fraction(1, 2), 1, (0, 1, 0))
    found = reference(scene, (Fraction(1, 2), -1, Fraction(-3, 2)), np.linspace(0, 20, 401))
    assert found.status == "agrees" and found.digits == (168, 336)
    x1, x2, x3 = found.states.T
    assert abs(x1 + 1 + x3).max() < 1e-15
    # the trapezoidal rule
    areas = np.concatenate([[0], np.cumsum(0.5 * (x2[1:] + x2[:-1]) * np.diff(found.t))])
    np.testing.assert_allclose(np.log(x3 / x3[0]), -areas, atol=0.01)
