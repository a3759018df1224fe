"""States whose labels, extremes and periods are asked of the program and of the potential in 60 to 200
digits."""
from __future__ import annotations

import numpy as np
import pytest

import stabilab
from tests.oracles import energy
from tests.oracles.pairs import WORDS
from tests.orbit.extremes.test_extremes import assert_extremes


def agrees(pair, states, digits=120, extremes=True, tolerance=1e-11, period=True):
    """Labels, and for states that are not equilibria their extremes and (bounded) periods, equal the
    oracle's. Returns the words."""
    scene, problem = pair
    states = np.atleast_2d(np.asarray(states, float))
    words = [energy.label(problem, tuple(s), digits=digits) for s in states.tolist()]
    np.testing.assert_array_equal(stabilab.fate(scene, states).labels, [WORDS[w] for w in words])
    margins = np.asarray(stabilab.fate(scene, states).margins)
    assert not np.any(np.isnan(margins))
    if extremes:
        boxes, periods = stabilab.extremes(scene, states), stabilab.period(scene, states)
        for state, word, box, got in zip(states.tolist(), words, boxes, periods):
            if word in ("bounded", "spin-up"):
                assert_extremes(box, energy.extremes(problem, state, digits=digits), tolerance)
            if word == "bounded" and period:
                assert got == pytest.approx(float(energy.period(problem, state, digits=digits)),
                                            rel=tolerance)
    return words
