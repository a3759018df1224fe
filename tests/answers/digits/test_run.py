"""Tests of `answers/digits_run.py`: what once went wrong there, and its edges."""
from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import stabilab
from stabilab.answers import digits_run as precision_digits
from stabilab.answers.digits_run import OWN
from tests.shared import case


def test_a_check_that_stops_early_shows_no_digit(monkeypatch):
    one, plain = case("minor-axis-100"), precision_digits._integrated

    def stops(case, times, method, rtol):
        run = plain(case, times, method, rtol)
        return run if case is one else replace(run, status="stopped")
    monkeypatch.setattr(precision_digits, "_integrated", stops)
    found = precision_digits._checked(one, np.array([0.0, 1.0]), *OWN, 9)
    assert found.digits == 0 and not found.enough and "stopped early" in found.because


@pytest.mark.parametrize("status, turned",
                         [("stopped", 0.0), ("reached", 2.0)])  # 2 rad are more than COUNTED
def test_attitudes_in_many_digits_need_a_run_that_counts_their_turns(monkeypatch, status, turned):
    one, times = case("charged-body-attitude"), np.array([0.0, 0.1])
    assert precision_digits._many_digits(one, times, 12).enough
    near = precision_digits._integrated(one, times, *OWN)
    state = {**near.state, "angles": near.state["angles"] + turned}
    monkeypatch.setattr(precision_digits, "_integrated",
                        lambda *asked: replace(near, status=status, state=state))
    assert precision_digits._many_digits(one, times, 12) is None


def test_digits_that_no_way_gives_are_told(tmp_path):
    path = tmp_path / "case.toml"
    path.write_text(
        "[scaled]\na = 0.2\nb = 0.4\nmu = [0, 0, 1]\n[motion]\nx = [2.5, 4.0, 0.1]\ntau = [0, 5]\n")
    case = stabilab.load(path)
    assert precision_digits._many_digits(case, np.array([-1.0, 1.0]), 20) is None  # one run goes one way
    run = SimpleNamespace(status="stopped", because="it ran out of steps")
    words = [precision_digits.missed(SimpleNamespace(run=one, asked=12, digits=3.25, reason="a check"))
             for one in (run, SimpleNamespace(status="reached", because=""))]
    assert words[0].endswith("it ran out of steps") and "12 digits asked for, 3.2 reached (a check)" in words[
        1]
