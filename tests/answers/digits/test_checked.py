"""Tests of `answers/digits_asked.py`: what once went wrong there, and its edges."""
from __future__ import annotations

import math

import pytest

from stabilab.answers.digits_asked import digits_of


def test_digits_of_an_error_are_its_negative_logarithm_within_what_numbers_hold():
    assert digits_of(1e-7) == pytest.approx(7) and digits_of(0.0) > 15 and digits_of(math.nan) == digits_of(
        5.0) == 0.0
