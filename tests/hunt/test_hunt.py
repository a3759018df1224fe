"""Tests of `hunt/hunt.py`: what once went wrong there, and its edges."""
from __future__ import annotations

import json
import math
import os
import signal

import numpy as np
import pytest

import stabilab.errors
from tests.hunt.__main__ import SEARCHES, Hunt, aim, evolve, main
from tests.hunt.problems import KNOBS


@pytest.mark.one_in(2)
@pytest.mark.parametrize("how", [evolve, aim], ids=["differential evolution", "hypothesis"])
def test_the_search_finds_a_disagreement_that_was_put_there(how, tmp_path):
    """A function that exceeds its promise where |x1| is within a tenth of a decade of 10^2.5 only, with a
    slope towards it."""
    def planted(scene, problem, state):
        return 1.5 * math.exp(-8 * abs(math.log10(abs(state[0]) or 1e-9) - 2.5)), "planted"
    hunt = Hunt("planted", planted, tmp_path)
    hunt.go(how, 600, seed=3, questions=1000)
    assert hunt.kept
    kept = json.loads((tmp_path / "planted-0.json").read_text())
    assert kept["words"] == "planted" and 10**2.4 < abs(float.fromhex(kept["state"][0])) < 10**2.6


def test_an_answer_that_ends_in_a_traceback_is_found(tmp_path):
    def broken(scene, problem, state):
        raise ZeroDivisionError("here")
    hunt = Hunt("broken", broken, tmp_path)
    hunt.go(evolve, 600, seed=1, questions=3)
    assert "ZeroDivisionError: here" in hunt.kept[0]["words"] and hunt.kept[0]["size"] == math.inf


def test_a_hunt_that_is_ended_says_what_it_found(tmp_path, monkeypatch, capsys):
    def ended(scene, problem, state):
        os.kill(os.getpid(), signal.SIGTERM)
        return 0.5, "half of what is promised"
    monkeypatch.setitem(SEARCHES, "methods", (ended, SEARCHES["methods"][1]))
    before = signal.getsignal(signal.SIGTERM)
    try:
        with pytest.raises(SystemExit, match="1"):
            main(600, str(tmp_path), 7, "methods", "twins")
    finally:
        signal.signal(signal.SIGTERM, before)
    said = capsys.readouterr().out
    assert said.startswith("methods: 1 questions") and said.endswith("ended early: nothing found\n")


@pytest.mark.parametrize("name", [pytest.param(name, marks=[pytest.mark.slow] * (n % 2 > 0 or name == "unreduced"))
                                  for n, name in enumerate(SEARCHES)])
def test_two_ways_to_an_answer_keep_their_promise_on_random_problems(name):
    (function, make), rng, asked = SEARCHES[name], np.random.default_rng(5), 0
    while asked < 4:
        try:
            scene, problem, state = make(rng.random(KNOBS))
        except stabilab.errors.InputError:
            continue
        size, words = function(scene, problem, state)
        assert size <= 1, words
        asked += 1
