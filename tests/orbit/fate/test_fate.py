"""Fate: labels and margins against the reduced potential at 60-100 digits and against tight integration."""
from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import stabilab
from stabilab import Body, ConstantTorque, Fate, Gyrostat, ScaledGyrostat, Scene
from stabilab.answers.motion import motion
from tests.oracles import brute, energy
from tests.oracles.pairs import PAPER_BODY, WORDS, assert_margin, axis_of, brink, physical, scaled

BOUNDED, SPIN_UP, SEPARATRIX, EQUILIBRIUM, UNDECIDED = (int(f) for f in Fate)

# Every way the paper's two solvable cases and their generalisation come: name -> (scene, model).
FAMILIES = {
    "minor scaled +": scaled(0.2, 0.4, (0, 0, 1)),
    "minor scaled -": scaled(-0.7, 1.1, (0, 0, -0.6)),
    "minor scaled a=b": scaled(0.5, 0.5, (0, 0, 2.0)),
    "middle scaled +": scaled(0.2, 0.4, (0, 1, 0)),
    "middle scaled -, |c| above the cusp": scaled(0.5, 3.1, (0, -0.8, 0)),
    "middle scaled, |c| far above": scaled(-1.0, -5.0, (0, 1, 0)),
    "minor physical": physical(PAPER_BODY, (100, 50, 0), (0, 0, 204.1)),
    "minor physical, other sign": physical((3.0, 2.0, 1.5), (-0.4, 0.7, 0), (0, 0, -0.3)),
    "minor on axis 1": physical((1.0, 1.5, 2.0), (0, 0.3, -0.2), (0.25, 0, 0)),
    "middle physical": physical((3.0, 2.0, 1.5), (0.4, 0, -0.9), (0, 0.3, 0)),
    "middle physical, other sign": physical((1.4, 2.2, 3.1), (2.0, 0, 1.5), (0, -0.1, 0)),
    "major physical": physical((3.0, 2.0, 1.5), (0, 0.8, 0.6), (0.2, 0, 0)),
    "major physical, other sign": physical((1.3, 2.0, 2.9), (-1.8, 0.6, 0), (0, 0, -0.15)),
    "major without gyrostat": physical((3.0, 2.0, 1.5), (0, 0, 0), (-0.2, 0, 0)),
}
ELLIPTIC = [name for name in FAMILIES if not name.startswith("middle")]
families = pytest.mark.parametrize("name", FAMILIES)


def sample(name, count, spread=2.5):
    return np.random.default_rng(sorted(FAMILIES).index(name)).normal(size=(count, 3)) * spread


@pytest.mark.one_in(3)
@families
def test_labels_and_margins_of_random_states_equal_the_potential_oracle(name):
    scene, problem = FAMILIES[name]
    states = sample(name, 25)
    found = stabilab.fate(scene, states)
    for state, label, margin in zip(states.tolist(), found.labels, found.margins):
        assert label == WORDS[energy.label(problem, tuple(state), digits=60)]
        assert_margin(problem, state, margin)


@pytest.mark.one_in(2)
@pytest.mark.parametrize("name", ["minor scaled +", "minor physical", "middle scaled +",
                                  "major physical, other sign"])
def test_labels_equal_tight_integration(name):
    pytest.importorskip("heyoka")
    scene, problem = FAMILIES[name]
    states = np.random.default_rng(99).normal(size=(120, 3)) * 2
    result = stabilab.fate(scene, states)
    for state, label, margin in zip(states.tolist(), result.labels, result.margins):
        if abs(margin) > 1e-9:  # closer to the separatrix double-precision integration cannot tell
            assert WORDS[brute.label(problem, state)] == label, state


def test_outcomes_are_the_words_of_the_labels_in_their_shape():
    scene = stabilab.ScaledGyrostat("1/5", "2/5", (0, 0, 1))  # the two starts of docs/start.md
    found = stabilab.fate(scene, [[[2.5, 4, 0.1]], [[2.5, 4, 9]]])
    assert found.outcome.tolist() == [["bounded"], ["spin-up"]] and found.outcome.shape == found.labels.shape
    assert stabilab.fate(scene, [2.5, 4, 0.1]).outcome == "bounded"


def test_consecutive_doubles_across_the_separatrix_change_label_exactly_once_and_never_tie():
    """An exact tie would make an angle with algebraic cosine algebraic (Lindemann): no double is on the
    separatrix."""
    scene, problem = FAMILIES["minor scaled +"]
    u, v, w = -3.0, 1.0, brink(problem, (-3.0, 1.0), 0.0)[2]
    speeds = [w]
    for _ in range(6):
        speeds = [np.nextafter(speeds[0], -np.inf), *speeds, np.nextafter(speeds[-1], np.inf)]
    states = np.array([(u, v, s) for s in speeds])
    expected = [WORDS[energy.label(problem, tuple(s))] for s in states.tolist()]
    assert set(expected) == {BOUNDED, SPIN_UP} and expected == sorted(expected)
    np.testing.assert_array_equal(stabilab.fate(scene, states).labels, expected)


@pytest.mark.parametrize("name", ["minor scaled +", "middle scaled -, |c| above the cusp", "major physical"])
def test_a_batch_answers_as_its_states_one_by_one(name):
    scene, _ = FAMILIES[name]
    states = sample(name, 24).reshape(2, 3, 4, 3)
    whole = stabilab.fate(scene, states)
    assert whole.labels.shape == whole.margins.shape == (2, 3, 4)
    assert whole.labels.dtype == np.int8
    for index in np.ndindex(2, 3, 4):
        one = stabilab.fate(scene, states[index])
        assert one.labels.shape == one.margins.shape == ()
        assert one.labels == whole.labels[index]
        # a margin may be evaluated by another route for one state: to 1e-12 of its terms
        assert one.margins == pytest.approx(whole.margins[index], rel=1e-11, abs=1e-11)


@pytest.mark.parametrize("shape", [(0, 3), (4, 0, 3)])
def test_no_states_give_empty_answers(shape):
    scene, _ = FAMILIES["minor scaled +"]
    result = stabilab.fate(scene, np.empty(shape))
    assert result.labels.shape == result.margins.shape == shape[:-1]


@pytest.mark.parametrize("bad",
                         [np.zeros(2), np.zeros((3, 4)), np.float64(1.0), [[0, 0, np.nan]], [[np.inf, 0, 0]]])
def test_states_that_are_not_three_finite_numbers_are_refused(bad):
    from stabilab.errors import InputError
    with pytest.raises(InputError):
        stabilab.fate(FAMILIES["minor scaled +"][0], bad)


@pytest.mark.one_in(2)
@pytest.mark.parametrize("places", [2, pytest.param(6, marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", ["minor scaled +", "middle scaled +", "minor scaled -", "minor physical",
                                  "major physical"])
def test_the_doubles_next_to_an_equilibrium_have_the_fate_of_exact_arithmetic(name, places):
    """Oracle: the potential at 100 digits, for the doubles themselves; a rounded equilibrium is as little one
    as its neighbours."""
    scene, problem = FAMILIES[name]
    axis = axis_of(problem)
    j, k = (axis + 1) % 3, (axis + 2) % 3
    rng, states = np.random.default_rng(3), []
    for v in (rng.normal(size=6) * 3).tolist()[:places]:
        # F = (kappa v + sigma) u + rho v + m = 0, solved exactly for u
        u = (-(problem.rho[axis] * Fraction(v) + problem.m[axis])
             / (problem.kappa[axis] * Fraction(v) + problem.sigma[axis]))
        for steps in (0, 1, -1, 3):
            state = [0.0] * 3
            state[j], state[k] = float(u) + steps * np.spacing(abs(float(u))), v
            states.append(state)
    words = [energy.label(problem, tuple(s), digits=100) for s in states]
    found = stabilab.fate(scene, np.array(states))
    np.testing.assert_array_equal(found.labels, [WORDS[w] for w in words])
    assert "equilibrium" not in words
    if problem.kappa[j] * problem.kappa[k] < 0:  # circles, where a negative margin means release
        assert set(words) <= {"bounded",
                              "spin-up"} and ((found.margins > 0) == (found.labels == BOUNDED)).all()
    assert [motion(scene, s).fate for s in states] == found.labels.tolist()


@pytest.mark.parametrize("x2, word", [("-1.99999999999999999", "spin-up"), ("-2", "equilibrium"),
                                      ("-2.00000000000000001", "bounded")])
def test_decimals_next_to_a_saddle_are_told_from_it(x2, word):
    """x3' = x2 (x1 + b) + 1 at x1 = x3 = 0 is 1 + x2/2: it vanishes at -2 alone, and pushes away from there
    (a saddle, by hand: the slope of the force is X2^2 - X1^2 - c X1 > 0)."""
    scene, state = ScaledGyrostat("1/4", "1/2", (0, 0, 1)), tuple(map(Fraction, (0, x2, 0)))
    found = motion(scene, tuple(map(float, state)), exact=state)
    assert found.fate.word == word
    assert (found.margin_energy > 0, found.margin_energy < 0) == (word == "bounded", word == "spin-up")
    assert (found.period is None) == (word != "bounded")


def test_nothing_rests_where_the_scene_has_no_equilibrium():
    """One moment for all axes: omega . M and |H|^2 grow for ever. Nearly one: the balance at rates of 1 asks
    for 1e-20 = 2e-20."""
    bodies = Body((1, 1, 1)), Body(("1.00000000000000000003", "1.00000000000000000001", 1))
    torques = ("1e-20", 0, 0), ("1e-20", "2e-20", "1e-20")
    for body, torque, word in zip(bodies, torques, ("spin-up", "undecided")):
        scene = Scene(body, Gyrostat((1, 1, 1)), ConstantTorque(torque))
        found = stabilab.fate(scene, (1, 1, 1), follow=20), motion(scene, (1, 1, 1), follow=20)
        assert Fate(int(found[0].labels)).word == found[1].fate.word == word


@pytest.mark.parametrize("state", [(2.0, 0.0, 0.0), (0.0, -1.5, 0.0), (0.0, 0.0, 0.3), (0.0, 0.0, 0.0)])
def test_torque_free_spin_about_a_principal_axis_is_an_equilibrium(state):
    scene, _ = physical((6.0, 5.0, 3.0))
    assert stabilab.fate(scene, state).labels == EQUILIBRIUM


@pytest.mark.parametrize("mu", [(0, 1, 1), (1, 0, 0.5), (1, 1, 1), (1e-9, 0, 1)])
def test_torque_off_the_principal_axes_has_a_reason_and_no_margin(mu):
    """Spin-up is told where a certificate was met, "undecided" elsewhere; no barrier is known either way."""
    scene, _ = scaled(0.2, 0.4, mu)
    result = stabilab.fate(scene, np.ones((3, 3)), follow=20)
    assert np.all((result.labels == UNDECIDED)
                  | (result.labels == SPIN_UP)) and np.all(np.isnan(result.margins))
    assert all("principal" in str(reason) for reason in np.ravel(result.because))


@pytest.mark.parametrize("name", ["minor scaled -", "major physical", "minor physical"])
def test_spin_up_is_about_the_torque_axis_in_its_sense(name):
    scene, problem = FAMILIES[name]
    result = stabilab.fate(scene, sample(name, 30))
    axis, spins = axis_of(problem), result.labels == SPIN_UP
    assert spins.any() and not spins.all()
    np.testing.assert_array_equal(result.axis, np.where(spins, axis + 1, 0))
    np.testing.assert_array_equal(result.sense, np.where(spins, 1 if problem.m[axis] > 0 else -1, 0))


dyadic = st.integers(1, 1 << 16)
exponent = st.integers(-30, 30)
component = st.floats(-8, 8).map(lambda x: round(x, 9))


@settings(deadline=None, max_examples=60, derandomize=True)
@given(parts=st.tuples(dyadic, dyadic, dyadic), size=exponent, axis=st.integers(0, 2),
       lam=st.tuples(component, component),
       torque=st.tuples(st.sampled_from([-1, 1]), st.integers(-12, 6)),
       state=st.tuples(component, component, component))
def test_labels_of_any_body_gyrostat_and_torque_equal_the_potential_oracle(parts, size, axis, lam, torque,
                                                                           state):
    a, b, c = parts
    # exact: the triangle inequality holds
    inertia = [float(n) * 2.0 ** (size - 16) for n in (b + c, a + c, a + b)]
    momentum, moment = [0.0] * 3, [0.0] * 3
    scale = 2.0 ** size
    momentum[(axis + 1) % 3], momentum[(axis + 2) % 3] = lam[0] * scale, lam[1] * scale
    moment[axis] = torque[0] * 10.0 ** torque[1] * scale
    scene, problem = physical(inertia, momentum, moment)
    word = energy.label(problem, state)
    assert int(stabilab.fate(scene, np.array(state)).labels) == WORDS[word]


def test_scenes_that_differ_in_an_exact_number_alone_are_different_scenes():
    """"0.2" is a fifth, 0.2 a double beside it: equal floats must not make one scene answer for the other
    from memory."""
    fifth, double = stabilab.ScaledGyrostat("0.2", "0.4",
                                            (0, 0, 1)), stabilab.ScaledGyrostat(0.2, 0.4, (0, 0, 1))
    assert fifth != double and fifth == stabilab.ScaledGyrostat("1/5", "2/5", (0, 0, "1"))
    assert stabilab.Gyrostat(("0.1", 0, 0)) != stabilab.Gyrostat((0.1, 0, 0))
    state = brink(FAMILIES["minor scaled +"][1], (-3.0, 1.0), -1e-14)
    stabilab.fate(fifth, np.array(state))
    margin = float(stabilab.fate(double, np.array(state)).margins)
    assert margin == pytest.approx(float(energy.margin(FAMILIES["minor scaled +"][1], state)), rel=1e-6)
