"""Tests of `orbit/flow/periodic.py`: what once went wrong there, and its edges."""
from __future__ import annotations

import math

import numpy as np

from stabilab.orbit.flow.periodic import tabulated


class Circling:
    """A toy motion, (cos, sin, sharp) of one period: `sharp` is smooth, or has a corner that no table
    resolves."""

    evaluations, sense, spin, axis = 0, 1.0, (1.0, 0.0), 0

    def __init__(self, period, sharp):
        self.period, self.sharp = period, sharp

    def follow(self, times):
        t = np.asarray(times) * (2 * np.pi / self.period)
        return np.stack([np.cos(t), np.sin(t), self.sharp(t)], axis=1), np.sin(t)


def test_a_motion_is_tabulated_where_it_repeats_smoothly():
    smooth, corner, never = Circling(3.0,
                                     lambda t: np.cos(2 * t)), Circling(3.0,
                                                                        lambda t: np.abs(
                                                                            np.sin(7.3 * t))), Circling(
                                                                                math.inf, np.cos)
    assert tabulated(corner) is corner and tabulated(never) is never
    table, times = tabulated(smooth), np.linspace(0, 2.9, 57)
    np.testing.assert_allclose(table.follow(times)[0], smooth.follow(times)[0], atol=1e-12)
