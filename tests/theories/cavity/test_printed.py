"""Tests of `theories/cavity/printed.py`: what once went wrong there, and its edges."""
from __future__ import annotations

import numpy as np


def test_a_departure_at_the_first_time_is_that_time():
    from stabilab.theories.cavity.printed import _first
    t = np.array([1.0, 2.0, 4.0])
    assert _first(t, np.array([2.0, 3.0, 4.0]), np.ones(3), 1.0) == 1.0
    assert _first(t, np.array([0.0, 0.5, 1.5]), np.ones(3), 1.0) == 3.0  # half-way by the straight line
    assert _first(t, np.zeros(3), np.ones(3), 1.0) is None
