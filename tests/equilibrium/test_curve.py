"""Tests of `equilibrium/result.py`: what once went wrong there, and its edges."""
from __future__ import annotations

import math
from fractions import Fraction as F

import pytest

from stabilab.equilibrium.result import sample_parameters

INTERVALS = [(None, None), (F(-3), None), (F(0), None), (F(2, 7), None), (F(-3), F(2)), (F(0), F(1, 3)),
             (F(1, 1000), F(1000)),
             (F(1, 10), F(20)), (F(1), F(50)), (F(5), F(6)), (F(1), F(100)),
             (F(1, 10**9), F(10**9)), (F(-2), F(3, 10**7)), (F(0), F(10**7))]


@pytest.mark.parametrize("lo, hi", INTERVALS)
def test_samples_lie_inside_their_interval_rising_and_mirrored(lo, hi):
    for a, b in ((lo, hi), tuple(None if end is None else -end for end in (hi, lo))):
        samples = sample_parameters(a, b, F(1))
        assert len(samples) >= 4 and all(F(float(t)) == t for t in samples)
        assert samples == sorted(set(samples)) and (a is None
                                                    or samples[0] > a) and (b is None or samples[-1] < b)
        assert samples == [-t
                           for t in reversed(sample_parameters(None if b is None else -b,
                                                               None if a is None else -a, F(1)))]


@pytest.mark.parametrize("lo, hi",
                         [(F(1, 1000), F(1000)), (F(1, 10**9), F(10**9)), (F(3), F(301)), (F(1, 10), F(20)),
                                    (F(7), F(7000))])
def test_samples_of_a_wide_interval_are_spread_over_its_decades(lo, hi):
    places = [math.log(t / lo) / math.log(hi / lo) for t in sample_parameters(lo, hi, F(1))]
    assert places[0] < 0.1 and places[-1] > 0.9 and max(b - a for a, b in zip(places, places[1:])) < 0.5


def test_samples_next_to_a_pole_at_zero_reach_four_decades_towards_it():
    samples = sample_parameters(F(0), F(5), F(1))
    assert 1e-5 < samples[0] / 5 < 1e-3 and samples[-1] / 5 > 0.5


@pytest.mark.parametrize("start, size", [(F(0), 7), (F(3), 3), (F(-3), 3)])
def test_samples_towards_infinity_go_in_decades_of_the_size_of_the_near_end(start, size):
    away = [(t - start) / size for t in sample_parameters(start, None, F(7))]
    assert away[0] <= F(1, 50) and away[-1] >= 1000 and any(F(1, 2) <= t <= 2 for t in away)
