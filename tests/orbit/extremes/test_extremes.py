"""Extremes and periods against the reduced potential at 60 digits and against tight integration with roots of
rates."""
from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest

import stabilab
from tests.oracles import energy
from tests.oracles.pairs import assert_extremes, brink, paper
from tests.shared import FAMILIES, sample


@pytest.mark.one_in(3)
@pytest.mark.parametrize("name", ["minor scaled +", "minor physical", "major physical"])
@pytest.mark.parametrize("decades", [3, 9, 15, *(pytest.param(n, marks=pytest.mark.slow) for n in (6, 12))])
def test_extremes_and_period_just_inside_the_separatrix_keep_their_digits(name, decades):
    """The far turning point merges with the saddle: root finding on w^2 there loses half of the digits."""
    scene, problem = FAMILIES[name]
    rng, found = np.random.default_rng(11), 0
    while found < 1 + (decades % 6 == 0):  # those of the default suite have one state each
        state = brink(problem, rng.normal(size=2) * 2, -(10.0 ** -decades))
        if state is None or energy.label(problem, state) != "bounded":
            continue
        found += 1
        assert_extremes(stabilab.extremes(scene, np.array(state)), energy.extremes(problem, state), 1e-11)
        exact = float(energy.period(problem, state, nodes=30))
        assert stabilab.period(scene, np.array(state)) == pytest.approx(exact, rel=1e-11)


def test_period_grows_like_the_logarithm_of_the_distance_from_the_separatrix():
    """One passage of the saddle a period: dT = -ln(dE)/nu, nu^2 = dF/dalpha there = X2 (h) terms = (h^4 - c h
    - 1)/h^2."""
    scene, problem = paper(0, (0, 0, 1))
    # a = b = 0: equilibria X = -1/h; saddle h^4 > 1. Circle through the saddle h = 2, X = -1/2; the loop's
    # other points
    # are found on the same circle at x = (-2, 1/2, .) (the centre h = 1/2), an exact double.
    nu = np.sqrt((2.0 ** 4 - 1) / 2.0 ** 2)
    periods = []
    for decades in (4, 7, 10, 13):
        state = brink(problem, (-2.0, 0.5), -(10.0 ** -decades))
        axis_energy = energy.margin(problem, state)
        periods.append((float(mp.log(axis_energy)), float(stabilab.period(scene, np.array(state)))))
    slopes = [(q[1] - p[1]) / (p[0] - q[0]) for p, q in zip(periods, periods[1:])]
    # first order in the distance, whose largest value is 1e-4
    np.testing.assert_allclose(slopes, 1 / nu, rtol=2e-3)
    np.testing.assert_allclose(slopes[1:], 1 / nu, rtol=1e-5)


@pytest.mark.one_in(2)
@pytest.mark.parametrize("name", ["minor scaled +", "middle scaled -, |c| above the cusp", "major physical"])
def test_a_batch_answers_as_its_states_one_by_one(name):
    scene, _ = FAMILIES[name]
    states = sample(name, 24).reshape(2, 3, 4, 3)
    whole, boxes = stabilab.fate(scene, states), stabilab.extremes(scene, states)
    periods = stabilab.period(scene, states)
    assert whole.labels.shape == whole.margins.shape == periods.shape == (2, 3, 4)
    assert boxes.shape == (2, 3, 4, 3, 2) and whole.labels.dtype == np.int8
    for index in np.ndindex(2, 3, 4):
        one = stabilab.fate(scene, states[index])
        assert one.labels.shape == one.margins.shape == () and one.labels == whole.labels[index]
        # a margin may be evaluated by another route for one state: to 1e-12 of its terms
        assert one.margins == pytest.approx(whole.margins[index], rel=1e-11, abs=1e-11)
        np.testing.assert_allclose(stabilab.extremes(scene, states[index]), boxes[index], rtol=1e-12,
                                   atol=1e-14)
        np.testing.assert_allclose(stabilab.period(scene, states[index]), periods[index], rtol=1e-12)


@pytest.mark.parametrize("shape", [(0, 3), (4, 0, 3)])
def test_no_states_give_empty_answers(shape):
    scene, states = FAMILIES["minor scaled +"][0], np.empty(shape)
    found = stabilab.fate(scene, states)
    assert found.labels.shape == found.margins.shape == shape[:-1]
    assert stabilab.extremes(scene, states).shape == (*shape, 2)
    assert stabilab.period(scene, states).shape == shape[:-1]
