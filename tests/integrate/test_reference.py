"""Tests of `integrate/reference.py`: what once went wrong there, and its edges."""
from __future__ import annotations

import numpy as np

from stabilab import Body, ConstantTorque, Scene
from stabilab.integrate.reference import reference


def test_a_motion_from_rest_in_many_digits_starts_by_the_torque():
    found = reference(Scene(Body((3, 2, "1.5")), ConstantTorque((0, 0, 3))), (0, 0, 0), [0.25, 1.5])
    np.testing.assert_array_equal(found.states, [[0, 0, 0.5], [0, 0, 3]])  # omega3 = M3 t/D3, by hand
