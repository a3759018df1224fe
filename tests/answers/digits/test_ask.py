"""Tests of `answers/digits.py`: what once went wrong there, and its edges."""
from __future__ import annotations

import json

import numpy as np
import pytest

import stabilab
from stabilab import ScaledGyrostat
from stabilab.answers.digits import ask, ask_all
from tests.shared import MARGIN, PERIOD, SCALED_MINOR, answer

TENTH = """
title = "a state that no double holds"
source = "own"
[scaled]
a = 0.2
b = 0.4
mu = [0, 0, 1]
[motion]
x = [2.5, 4.0, 0.1]
tau = [0, 1]
"""


@pytest.mark.parametrize("question, expected", [("period", PERIOD), ("fate", MARGIN)])
def test_thirty_digits_are_those_of_the_decimals_as_written(question, expected, tmp_path):
    assert expected in json.dumps(answer(question, tmp_path, TENTH, "--digits", "30"))

MINOR = ScaledGyrostat("0.2", "0.4", (0, 0, 1))


@pytest.mark.parametrize("digits", [9, 20])
def test_an_infinite_extreme_has_every_digit(digits):
    told = ask("extremes", MINOR, (0.5, 0.5, 1.0), digits)  # A^2 < 2: it spins up, x3' = 1 - ... > 0 at once
    x3 = told.values[2]
    assert float(x3[1]) == np.inf and float(x3[0]) == 1.0 and told.digits >= digits
    assert (told.decimals is None) == (digits < 16) and (told.decimals is None
                                                         or told.decimals[2][1] == "inf")


def test_what_has_no_number_is_told_for_states_and_rows_alike():
    one = ask("period", SCALED_MINOR, (0.5, 0.5, 0.0), 20)  # A^2 < 2: it spins up
    assert one.values is None and "does not repeat" in one.because
    states = np.array([[0.5, 0.5, 0.0], [2.5, 4.0, 0.1]])
    rows = ask_all("period", SCALED_MINOR, states, 20, stabilab.period(SCALED_MINOR, states))
    assert rows.values[0] == np.inf and rows.values[1] == pytest.approx(
        float(stabilab.period(SCALED_MINOR, np.array([2.5, 4.0, 0.1]))), rel=1e-12)
