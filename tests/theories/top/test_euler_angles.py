"""Tests of `theories/euler_angles.py`: what once went wrong there, and its edges."""
from __future__ import annotations

import math

import numpy as np
import pytest

from stabilab.errors import InputError
from stabilab.theories.euler_angles import euler_angles


def spinning(t):
    """Samples of a body that turns at rate 2 about axis 3, tilted by 0.3: gamma turns back in the body, psi'
    = 0."""
    t = np.asarray(t, float)
    gamma = np.stack([math.sin(0.3) * np.sin(2 * t), math.sin(0.3) * np.cos(2 * t),
                      np.full(t.shape, math.cos(0.3))], axis=-1)
    return t, np.tile([0.0, 0.0, 2.0], (t.size, 1)), gamma


def test_samples_that_are_none_are_refused():
    t, omega, gamma = spinning(np.linspace(0, 1, 9))
    for bad in ((t, omega[:-1], gamma), (t[:, None], omega, gamma), (t[:0], omega[:0], gamma[:0]),
                (t, omega, gamma[:, :2])):
        with pytest.raises(InputError, match="shapes"):
            euler_angles(*bad)
    for times in (t[::-1], np.zeros(9)):
        with pytest.raises(InputError, match="increasing"):
            euler_angles(times, omega, gamma)
    with pytest.raises(InputError, match="other than zero"):
        euler_angles(t, omega, 0 * gamma)


def test_angles_of_one_sample_and_of_a_pure_spin():
    one, many = (euler_angles(*spinning(t)) for t in ([0.25], np.linspace(0.25, 3, 56)))
    for found in (one, many):
        np.testing.assert_allclose(found.psi, 0, atol=1e-9)  # omega along axis 3 alone turns phi, not psi
        np.testing.assert_allclose(found.theta, 0.3, rtol=1e-12)
    np.testing.assert_allclose(np.diff(many.phi), 0.1, rtol=1e-9)
