"""Tests of `equilibrium/isolated.py`: what once went wrong there, and its edges."""
from __future__ import annotations

from fractions import Fraction as F

import stabilab
from stabilab import Body, ConstantTorque, Gyrostat, Scene
from stabilab.equilibrium.result import decimal


def test_a_discriminant_beyond_the_doubles_is_still_told():
    u = F(10) ** 60
    scene = Scene(Body((4, 2, 3)), Gyrostat((-u * 3 / 10, 4 * u, 2 * u)), ConstantTorque((-u * u, 2 * u * u, -4 * u * u)))
    assert stabilab.equilibria(scene).kind == "none"  # law: as for u = 1
    assert decimal(F(10) ** 400 * F(-2, 3)) == "-6.66667e+399" and decimal(F(10) ** -400 / 7) == "1.42857e-401"
