"""Tests of `orbit/reduction.py`: what once went wrong there, and its edges."""
from __future__ import annotations

import pytest

from stabilab.orbit.reduction import reduce
from tests.oracles.pairs import physical


@pytest.mark.parametrize("inertia, momentum, torque", [
    ((3, 2, 1), (0.5, 0, 0), (0.2, 0, 0)), ((3, 2, 1), (0, 0.5, 0), (0, 0.2, 0)),
    ((3, 2, 1), (0, 0, 0), (1, 1, 0)),
    ((3, 2, 2), (0.5, 0.1, 0), (0.2, 0, 0)), ((2, 2, 1), (0.5, 0, 0), (0.2, 0, 0)),
    ((3, 2, 1), (1, 1, 1), (0, 0, 0))])
def test_no_reduction_where_the_other_two_rates_share_no_factor(inertia, momentum, torque):
    """D_j w_j' = (D_k - D_i) w_k (w_i - s) ...: a wheel along the torque's axis asks for D_j = D_k and
    nothing across it."""
    assert reduce(physical(inertia, momentum, torque)[0]) is None
