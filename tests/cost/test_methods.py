"""Tests of `cost/methods.py`: what once went wrong there, and its edges."""
from __future__ import annotations

import pytest

import stabilab
from stabilab.cost.methods import problem
from stabilab.errors import InputError


def test_a_precision_needs_a_motion(case_file):
    path = case_file("[scaled]\na = 0.2\nb = 0.4\nmu = [0, 0, 1]\n")
    with pytest.raises(InputError, match="motion"):
        problem(stabilab.load(path), 5)
