"""Tests of `verify/malformed.py`: what once went wrong there, and its edges."""
from __future__ import annotations

import pytest

from stabilab import Body, ConstantTorque, Scene
from stabilab.verify import verify
from stabilab.verify.numbers import Malformed
from tests.shared import written

SPINNING = Scene(Body((3, 2, 1)), ConstantTorque((0, 0, 1)))


@pytest.mark.parametrize("part, key",
                         [("motion", "extremes"), ("equilibria", "points"), ("equilibria", "curves")])
@pytest.mark.parametrize("nonsense", [5, True, "abc", {"a": 1}, [5], [[["1", "2"], ["1", "2"]]] * 4],
                         ids=repr)
def test_nonsense_in_a_certificate_is_malformed(part, key, nonsense):
    claimed = written(SPINNING, (1, 1, 1))
    claimed[part][key] = nonsense
    with pytest.raises(Malformed):
        verify(claimed)
