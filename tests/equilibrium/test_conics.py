"""Tests of `equilibrium/conics.py`: what once went wrong there, and its edges."""
from __future__ import annotations

import numpy as np

from stabilab import Body, ConstantTorque, Gyrostat, Scene
from stabilab.answers.equilibria import equilibria


def test_a_sphere_has_a_line_of_equilibria_where_its_wheel_lies_across_the_torque():
    """D equal: lambda x omega + M = 0 is solved by (lambda x M)/|lambda|^2 + s lambda iff lambda . M = 0."""
    wheel, torque = np.array([3.0, 0.0, -1.0]), np.array([1.0, 2.0, 3.0])
    (line,) = equilibria(Scene(Body((2, 2, 2)), Gyrostat(wheel), ConstantTorque(torque))).curves
    for sample in line.samples:
        foot = np.cross(wheel, torque) / 10
        np.testing.assert_allclose(np.cross(np.array(sample.at) - foot, wheel), 0, atol=1e-12 * (1 + np.abs(sample.at).max()))
    assert equilibria(Scene(Body((2, 2, 2)), Gyrostat((3, 0, 1)), ConstantTorque(torque))).kind == "none"
