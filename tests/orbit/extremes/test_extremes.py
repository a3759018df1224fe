"""Extremes and periods against the reduced potential at 60 digits and against tight integration with roots of
rates."""
from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import stabilab
from tests.oracles import brute, energy
from tests.oracles.pairs import as_floats, brink, paper, physical
from tests.orbit.fate.test_fate import FAMILIES, sample

families = pytest.mark.parametrize("name", FAMILIES)


def assert_extremes(got, exact, tolerance):
    """Relative to the larger of a component's two finite extremes, or to the whole motion's where both nearly
    vanish."""
    exact = as_floats(exact)
    finite = np.isfinite(exact)
    np.testing.assert_array_equal(np.where(finite, 0.0, got), np.where(finite, 0.0, exact))
    for row in range(3):
        size = np.max(np.abs(exact[row][finite[row]]), initial=0.0)
        off = np.abs(got[row][finite[row]] - exact[row][finite[row]])
        assert np.all(off <= tolerance * size), (row, got[row], exact[row], off)


@pytest.mark.one_in(3)
@families
def test_extremes_of_random_states_equal_the_potential_oracle(name):
    scene, problem = FAMILIES[name]
    states = sample(name, 25)
    got = stabilab.extremes(scene, states)
    assert got.shape == (25, 3, 2)
    for state, answer in zip(states.tolist(), got):
        assert_extremes(answer, energy.extremes(problem, state, digits=60), 1e-11)


@pytest.mark.one_in(3)
@families
def test_periods_of_random_states_equal_the_quadrature_oracle(name):
    scene, problem = FAMILIES[name]
    states = sample(name, 8)
    for state, got in zip(states.tolist(), stabilab.period(scene, states)):
        assert got == pytest.approx(float(energy.period(problem, state)), rel=1e-11)


@pytest.mark.one_in(2)
@pytest.mark.parametrize("name", ["minor scaled +", "middle scaled +", "major physical"])
def test_extremes_and_period_equal_tight_integration(name):
    pytest.importorskip("heyoka")
    scene, problem = FAMILIES[name]
    states = sample(name, 60)
    labels = stabilab.fate(scene, states).labels
    margins = stabilab.fate(scene, states).margins
    for state, label, margin, got, period in zip(states.tolist(), labels, margins,
                                                 stabilab.extremes(scene, states),
                                                 stabilab.period(scene, states)):
        if label == stabilab.Fate.BOUNDED and abs(margin) > 1e-3:
            assert np.max(np.abs(got - brute.extremes(problem, state))) < 1e-11 * np.max(np.abs(got))
            assert period == pytest.approx(brute.period(problem, state), rel=1e-11)


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
    states = sample(name, 12).reshape(3, 4, 3)
    boxes, periods = stabilab.extremes(scene, states), stabilab.period(scene, states)
    assert boxes.shape == (3, 4, 3, 2) and periods.shape == (3, 4)
    for index in np.ndindex(3, 4):
        np.testing.assert_allclose(stabilab.extremes(scene, states[index]), boxes[index], rtol=1e-12,
                                   atol=1e-14)
        np.testing.assert_allclose(stabilab.period(scene, states[index]), periods[index], rtol=1e-12)


@pytest.mark.parametrize("shape", [(0, 3), (2, 0, 3)])
def test_no_states_give_empty_answers(shape):
    scene, _ = FAMILIES["minor scaled +"]
    assert stabilab.extremes(scene, np.empty(shape)).shape == (*shape, 2)
    assert stabilab.period(scene, np.empty(shape)).shape == shape[:-1]


component = st.floats(-8, 8).map(lambda x: round(x, 9))


@settings(deadline=None, max_examples=40, derandomize=True)
@given(parts=st.tuples(*[st.integers(1, 1 << 12)] * 3), axis=st.integers(0, 2),
       lam=st.tuples(component, component),
       torque=st.tuples(st.sampled_from([-1, 1]), st.integers(-6, 4)),
       state=st.tuples(component, component, component))
def test_extremes_of_any_body_gyrostat_and_torque_equal_the_potential_oracle(parts, axis, lam, torque, state):
    a, b, c = parts
    momentum, moment = [0.0] * 3, [0.0] * 3
    momentum[(axis + 1) % 3], momentum[(axis + 2) % 3] = lam
    moment[axis] = torque[0] * 10.0 ** torque[1]
    scene, problem = physical([(b + c) / 1024, (a + c) / 1024, (a + b) / 1024], momentum, moment)
    if energy.label(problem, state) in ("separatrix", "equilibrium"):
        return
    margin = energy.margin(problem, state)
    tolerance = 1e-11 if margin is None or abs(margin) > 1e-6 else 1e-9
    assert_extremes(stabilab.extremes(scene, np.array(state)), energy.extremes(problem, state), tolerance)
