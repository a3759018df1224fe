"""Fate: labels and margins against the reduced potential at 60-100 digits and against tight integration."""
from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

import stabilab
from stabilab import Body, ConstantTorque, Fate, Gyrostat, ScaledGyrostat, Scene
from stabilab.answers.motion import motion
from tests.oracles import energy
from tests.oracles.pairs import WORDS, brink, physical, scaled
from tests.shared import FAMILIES

BOUNDED, SPIN_UP, SEPARATRIX, EQUILIBRIUM, UNDECIDED = (int(f) for f in Fate)


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


@pytest.mark.parametrize("bad",
                         [np.zeros(2), np.zeros((3, 4)), np.float64(1.0), [[0, 0, np.nan]], [[np.inf, 0, 0]]])
def test_states_that_are_not_three_finite_numbers_are_refused(bad):
    from stabilab.errors import InputError
    with pytest.raises(InputError):
        stabilab.fate(FAMILIES["minor scaled +"][0], bad)


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


@pytest.mark.parametrize("mu", [(0, 1, 1), (1, 0, 0.5), (1, 1, 1), (1e-9, 0, 1), (0, 1e-300, 1)])
def test_torque_off_the_principal_axes_has_a_reason_and_no_margin(mu):
    """Spin-up is told where a certificate was met, "undecided" elsewhere; no barrier is known either way."""
    scene, _ = scaled(0.2, 0.4, mu)
    result = stabilab.fate(scene, np.ones((3, 3)), follow=20)
    assert np.all((result.labels == UNDECIDED)
                  | (result.labels == SPIN_UP)) and np.all(np.isnan(result.margins))
    assert all("principal" in str(reason) for reason in np.ravel(result.because))


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
