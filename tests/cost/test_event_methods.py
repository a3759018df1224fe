"""Tests of `cost/methods.py`: what once went wrong there, and its edges."""
from __future__ import annotations

import numpy as np
import pytest

import stabilab
from stabilab.cost.methods import fate_methods, known_period, problem
from stabilab.errors import InputError
from stabilab.theories.theory import side_by_side
from tests.shared import CASES


def test_what_has_no_reduction_has_no_period_and_no_energies_to_measure():
    task = problem(stabilab.load(CASES / "off-axis-two.toml"), 3)
    assert known_period(task) is None and fate_methods(task) == []
    with pytest.raises(InputError):
        side_by_side(task.case, np.array([np.nan]))
