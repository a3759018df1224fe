"""Ensembles: the same motions as one by one, whatever the company, and failures that stay with the motion
that fails."""
import sys

import numpy as np
import pytest

from stabilab import Body, ConstantTorque, Gyrostat, ScaledGyrostat, Scene, trajectory
from stabilab.errors import InputError
from stabilab.integrate import ensemble as ensembles
from stabilab.integrate import trajectory as trajectories
from stabilab.integrate.ensemble import LANES, ensemble
from stabilab.integrate.to_heyoka import heyoka_available
from stabilab.physics.effects import effect_class
from tests.oracles import model, taylor

SCENE = Scene(Body((3, 2, "1.5")), Gyrostat(("0.3", "-0.2", "0.5")), ConstantTorque(("0.1", "0.2", "0.1")))
STATES = np.random.default_rng(4).normal(size=(2 * LANES + 3, 3))
TIMES = [3.0, 2.0, 0.5, 0.0, -1.0]
needs_heyoka = pytest.mark.skipif(not heyoka_available(), reason="heyoka is not installed")


def test_states_agree_with_thirty_digit_integration():
    right = model.physical((3, 2, "1.5"), ("0.3", "-0.2", "0.5"), ("0.1", "0.2", "0.1"))
    found = ensemble(SCENE, STATES[:3], [0.5, 3.0])
    exact = np.array([[[float(v) for v in row] for row in taylor.integrate(right, x, [0.5, 3.0], digits=25)]
                      for x in STATES[:3]])
    assert np.abs(found.states - exact).max() <= 2e-13 * np.abs(exact).max()
    assert found.status == "reached" and found.reached.all() and not found.stopped


@pytest.mark.one_in(2)
@pytest.mark.parametrize("scene, states", [
    (SCENE, STATES), (ScaledGyrostat("0.2", "0.4", (1, 0, 1)), STATES),
    (Scene(Body((3, 2, "1.5")), effect_class("newtonian_field")("0.3")),
     np.hstack([STATES, STATES[:, ::-1]]))],
    ids=["physical", "scaled", "with gamma"])
def test_an_ensemble_is_its_motions_one_by_one(scene, states):
    found = ensemble(scene, states, TIMES)
    singles = [trajectory(scene, x, TIMES) for x in states]
    # heyoka's scalar code contracts products otherwise than its vector code: some ulps over some ten steps
    assert np.abs(found.states - [run.states for run in singles]).max() < 1e-13 * np.abs(found.states).max()
    if heyoka_available():
        assert found.counters["steps"] == sum(run.counters["steps"] for run in singles)


@needs_heyoka
def test_any_number_of_workers_gives_the_same_bytes():
    one = ensemble(SCENE, STATES, TIMES)
    for workers in (2, 3, 0):
        other = ensemble(SCENE, STATES, TIMES, workers=workers)
        assert other.states.tobytes() == one.states.tobytes() and other.counters == one.counters


@needs_heyoka
def test_a_motion_does_not_depend_on_its_company():
    together = ensemble(SCENE, STATES, TIMES).states
    for i in (0, 7, len(STATES) - 1):
        assert (ensemble(SCENE, STATES[i:i + 1], TIMES).states[0] == together[i]).all()
    assert (ensemble(SCENE, STATES[::-1], TIMES).states[::-1] == together).all()


def test_a_motion_that_overflows_stops_alone():
    states = STATES.copy()
    states[5], states[9] = 1e200, 1e160
    found, sound = ensemble(SCENE, states, TIMES), ensemble(SCENE, STATES, TIMES)
    assert list(found.stopped) == [5, 9] and "overflow" in found.stopped[5] and found.status == "stopped"
    others = np.delete(np.arange(len(states)), [5, 9])
    assert (found.states[others] == sound.states[others]).all() and found.reached[others].all()
    assert found.reached[5].tolist() == [t == 0 for t in TIMES]
    assert np.isposinf(found.states[5][~found.reached[5]]).all() and (found.states[5, 3] == 1e200).all()


@needs_heyoka
def test_a_lane_that_ends_in_no_number_is_followed_alone(monkeypatch):
    """Though heyoka calls it finished."""
    propagated = ensembles._Rows._propagated

    def spoilt(self, ta, lanes, grid):
        points, outcomes, steps = propagated(self, ta, lanes, grid)
        points[-1, 1, lanes == 9] = np.nan
        return points, outcomes, steps
    sound = ensemble(SCENE, STATES, TIMES)
    monkeypatch.setattr(ensembles._Rows, "_propagated", spoilt)
    found = ensemble(SCENE, STATES, TIMES)
    assert found.status == "reached" and (found.states[9] == trajectory(SCENE, STATES[9], TIMES).states).all()
    others = np.delete(np.arange(len(STATES)), 9)
    assert (found.states[others] == sound.states[others]).all()


def test_an_ensemble_of_overflows_answers():
    found = ensemble(SCENE, np.full((3, 3), 1e200), [1.0])
    assert list(found.stopped) == [0, 1, 2] and not found.reached.any()


def test_without_heyoka_dop853_takes_over(monkeypatch):
    monkeypatch.setitem(sys.modules, "heyoka", None)
    found = ensemble(SCENE, STATES[:3], TIMES, workers=2)
    assert found.method == "DOP853"
    assert (found.states == [trajectory(SCENE, x, TIMES).states for x in STATES[:3]]).all()


@pytest.mark.parametrize("arguments, words", [
    (((1, 2, 3), [1.0]), "rows of 3 numbers"), (([[1, 2]], [1.0]), "shape"), (([], [1.0]), "rows"),
    (([["a", 1, 2]], [1.0]), "rows"),
    (([[1, 2, 3], [1, np.nan, 3]], [1.0]), "row 1 is not finite"), (([[1, 2, 3]], [1.0, 1.0]), "strictly"),
    (([[1, 2, 3]], [1.0], 2.0), "rtol"), (([[1, 2, 3]], [1.0], None, -1), "workers"),
    (([[1, 2, 3]], [1.0], None, "two"), "workers")])
def test_bad_input_is_named(arguments, words):
    with pytest.raises(InputError, match=words):
        ensemble(SCENE, *arguments)


@needs_heyoka
def test_rows_hold_motions_of_like_pace(monkeypatch):
    """The slowest motion of a row keeps the others waiting: the paces of two rows must not interleave."""
    from stabilab.physics.to_numpy import to_numpy
    rows, together = [], ensembles._Rows.__call__

    def counted(self, groups):
        rows.extend(groups)
        return together(self, groups)
    monkeypatch.setattr(ensembles._Rows, "__call__", counted)
    ensemble(SCENE, STATES, TIMES)
    rows = np.array(rows)
    assert rows.shape == (3, LANES) and set(rows.ravel()) == set(range(len(STATES)))
    pace = np.linalg.norm(STATES, axis=1) + np.linalg.norm(to_numpy(SCENE)(STATES), axis=1)
    assert all(pace[a].max() <= pace[b].min() for a, b in zip(rows, rows[1:]))


def test_motions_of_very_different_pace_are_followed_each_in_its_own_unit():
    scene, times = Scene(Body((3, 2, 1))), np.array([0.0, 1e-150, 2e-150])
    states = np.array([[1.0, 0.5, 0.25], [1e150, 5e149, 2.5e149]])
    found = ensemble(scene, states, times)
    # Euler's equations are homogeneous: omega(t) -> s omega(s t)
    exact = trajectory(scene, states[0], [0.0, 1.0, 2.0]).states
    np.testing.assert_allclose(found.states[1] / 1e150, exact, rtol=1e-12)
    np.testing.assert_allclose(found.states[0], np.tile(states[0], (3, 1)), rtol=1e-15)
    alone = trajectory(scene, states[1], times)
    np.testing.assert_allclose(alone.states, found.states[1], rtol=1e-12)


@needs_heyoka
@pytest.mark.parametrize("coefficient, size", [("0.25", 1e15), ("1000", 1e-20), ("1000", 1e15), ("0.25", 1e-20)])
def test_spheres_slow_down_exponentially_however_fast_the_medium_beside_the_rates(coefficient, size):
    """Closed form, exp(-c t); their pace is c, whatever the rates."""
    starts, pace = size * np.array([(1, 2, -1), (1e-3, 0, 1), (0, 0, 1e-8)]), float(coefficient)
    times = np.array([0.25, 1.25, 5.0]) / pace
    found = ensemble(Scene(Body((2, 2, 2)), effect_class("resistance")(coefficient)), starts, times).states
    exact = starts[:, None] * np.exp(-pace * times)[:, None]
    assert np.abs(found - exact).max() <= 1e-14 * size


@needs_heyoka
def test_a_motion_of_endless_turns_is_given_up_by_its_pace(monkeypatch):
    """Its first steps tell how many there would be; the other motion of its row has the bytes that it has
    alone."""
    steps, propagated = [], ensembles._Rows._propagated

    def counted(*arguments):
        steps.append(propagated(*arguments))
        return steps[-1]
    monkeypatch.setattr(ensembles._Rows, "_propagated", counted)
    for module in (ensembles, trajectories):
        monkeypatch.setattr(module, "REPORT", 1000)
    scene, ends = Scene(Body((1.063, 1.569, 1.802)), Gyrostat((0, 53.99, 0))), [1.0, 1e9]
    found = ensemble(scene, [(0, 0, -652), (0, 1, 0)], ends)
    assert list(found.stopped) == [0] and "the rest would take some" in found.stopped[
        0] and found.reached.tolist() == [[True, False], [True, True]]
    assert max(max(taken) for *_, taken in steps) <= 1000
    assert (found.states[1] == ensemble(scene, [(0, 1, 0)], ends).states[0]).all()


def test_more_workers_than_there_are_rows_are_not_made(monkeypatch):
    monkeypatch.setattr(ensembles, "ThreadPoolExecutor",
                        lambda workers: pytest.fail(f"{workers} workers for one row"))
    assert ensemble(SCENE, STATES[:LANES], TIMES, workers=10**400).status == "reached"
