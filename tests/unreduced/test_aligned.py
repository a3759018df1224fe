"""Motions without a reduction of their own: torques in the plane of two equal moments, off the axes, and none
at all.

The torque (3, 4, 0) turns by an exact rotation onto axis 1 of the same body; runs are SciPy's, of Euler's
equations by hand.
"""
from decimal import ROUND_CEILING, ROUND_FLOOR

import numpy as np
import pytest

import stabilab
from stabilab import Body, ConstantTorque, Fate, Gyrostat, Scene
from stabilab.answers.fate import extremes, period
from stabilab.answers.motion import motion
from stabilab.errors import InputError
from stabilab.orbit.extremes_arrays import extremes_and_periods
from stabilab.unreduced.off_axis import outward

from .spin_up.scenes import euler, run

TURN = np.array([[0.6, 0.8, 0.0], [-0.8, 0.6, 0.0], [0.0, 0.0, 1.0]])
D = (2.0, 2.0, 1.0)
# a wheel along axis 3 makes circles with barriers; its moment lies across the torque in both scenes
BETWEEN = Scene(Body(D), Gyrostat((0, 0, 2)), ConstantTorque((0.3, 0.4, 0)))
ALONG = Scene(Body(D), Gyrostat((0, 0, 2)), ConstantTorque((0.5, 0, 0)))
STATES = np.array([[0.5, -0.25, 0.75], [1.0, 2.0, -1.5], [-0.125, 0.5, 0.25]])
# (D omega) x omega = (1, -2, 1) at omega = (1, 1, 1)
OFF = Scene(Body((3, 2, 1)), ConstantTorque((-1, 2, -1)))


def run_extremes(moments, wheel, torque, state, end):
    """(3, 2) extremes over [0, end] of a dense run."""
    states = run(lambda w: euler(moments, wheel, torque, w), state, np.linspace(0, end, 4001), rtol=1e-10)
    return np.stack([states.min(axis=0), states.max(axis=0)], axis=1)


def test_a_torque_between_two_equal_axes_moves_the_body_as_one_along_an_axis():
    between, along = stabilab.fate(BETWEEN, STATES), stabilab.fate(ALONG, STATES @ TURN.T)
    assert between.labels.tolist() == along.labels.tolist() and not between.axis.any()
    np.testing.assert_allclose(between.margins, along.margins, rtol=1e-12)
    times = period(BETWEEN, STATES)
    np.testing.assert_allclose(times, period(ALONG, STATES @ TURN.T), rtol=1e-11)
    assert np.isfinite(times).all() and (between.labels == Fate.BOUNDED).all()
    found, turned = extremes(BETWEEN, STATES), extremes(ALONG, STATES @ TURN.T)
    # axis 3 is the same in both
    np.testing.assert_allclose(found[:, 2], turned[:, 2], rtol=1e-10, atol=1e-12)
    for state, time, one in zip(STATES, times, found):
        # sampled to 1/4000
        np.testing.assert_allclose(one, run_extremes(D, (0, 0, 2), (0.3, 0.4, 0), state, 1.01 * time),
                                   atol=3e-5)
        single = motion(BETWEEN, state)
        assert single.period == pytest.approx(time, rel=1e-11) and single.fate == Fate.BOUNDED
        np.testing.assert_allclose(single.extremes, one, rtol=1e-9, atol=1e-12)


# with barriers: the torque (-50, 0, 0) and the wheel (0, 1, 0), turned alike
BARRED = Scene(Body((4, 4, 2)), Gyrostat(("-0.8", "0.6", 0)), ConstantTorque((-30, -40, 0)))
BARRED_ALONG = Scene(Body((4, 4, 2)), Gyrostat((0, 1, 0)), ConstantTorque((-50, 0, 0)))
# (1, -7.5, -3.5) is on the separatrix
BESIDE = np.array([[1.0, -7.75, -3.5], [1.0, -7.0, -3.25], [0.5, -0.25, 0.75]])


def test_the_distance_from_a_separatrix_does_not_change_when_the_scene_is_turned():
    """A rotation keeps distances: the exact turn by (3/5, 4/5) puts the torque on axis 1."""
    states = BESIDE @ TURN
    found, wanted = stabilab.fate(BARRED,
                                  states).velocity_margins, stabilab.fate(BARRED_ALONG,
                                                                          BESIDE).velocity_margins
    assert np.isfinite(wanted).all() and (wanted > 0).all() and (wanted[:2] < 0.5).all()
    np.testing.assert_allclose(found, wanted, rtol=2e-9)
    for state, distance in zip(states, found):
        one = motion(BARRED, tuple(state))
        assert one.margin_velocity == pytest.approx(distance, rel=2e-9)
        witness = np.array(one.velocity_witness)
        assert np.linalg.norm(witness - state) == pytest.approx(distance, rel=2e-9)
        # the witness has the energy of a barrier
        assert abs(stabilab.fate(BARRED, witness).margins) < 1e-9 * (witness @ witness)


def test_no_change_of_a_bounded_state_below_its_distance_releases_it():
    rng, state = np.random.default_rng(3), (BESIDE @ TURN)[0]
    many, here = rng.normal(size=(500, 3)), stabilab.fate(BARRED, state)
    ways = many / np.linalg.norm(many, axis=1)[:, None]
    assert here.labels == Fate.BOUNDED and 0 < here.velocity_margins < 0.25
    assert (stabilab.fate(BARRED, state + 0.999 * here.velocity_margins * ways).labels == Fate.BOUNDED).all()


@pytest.mark.parametrize("scene, state, wanted", [
    # a wheel along the torque: no equilibrium
    (Scene(Body((2, 2, 1)), Gyrostat((3, 4, 0)), ConstantTorque((3, 4, 0))), (0.1, 0.2, 0.3), np.inf),
    (Scene(Body((3, 2, 1)), Gyrostat((1, 0, 0)), ConstantTorque((1, 0, 0))), (0.1, 0.2, 0.3), np.inf),
    # off the axes nothing is known, at rest neither
    (OFF, (0.1, 0.2, 0.3), np.nan), (OFF, (1.0, 1.0, 1.0), np.nan)])
def test_the_distance_from_a_separatrix_is_infinite_only_where_there_is_none(scene, state, wanted):
    np.testing.assert_array_equal(stabilab.fate(scene, np.array(state)).velocity_margins, wanted)
    assert motion(scene, state).margin_velocity is None
    assert np.isinf(wanted) or motion(scene, state).velocity_because.startswith("not known")


def test_rest_between_the_axes_is_exact():
    # (D2 - D3) omega_2 omega_3 = -|M| on the turned axes: (0, 5, -1) there is (-4, 3, -1) here
    scene, state = Scene(Body((2, 2, 1)), ConstantTorque((3, 4, 0))), np.array([-4.0, 3.0, -1.0])
    assert stabilab.fate(scene, state).labels == Fate.EQUILIBRIUM and period(scene, state) == 0
    np.testing.assert_array_equal(extremes(scene, state), np.stack([state, state], axis=1))
    found = motion(scene, state)
    assert found.fate == Fate.EQUILIBRIUM and found.period is None
    assert found.extremes == ((-4, -4), (3, 3), (-1, -1))


def test_a_spin_along_a_torque_between_the_axes_needs_a_span_for_its_extremes():
    """omega = (omega0 + M t/D): the exact solution while omega_3 = 0 and no rate lies across the torque."""
    scene, state = Scene(Body((2, 2, 1)), ConstantTorque((3, 4, 0))), np.array([3.0, 4.0, 0.0])
    assert motion(scene, state).fate == Fate.SPIN_UP and motion(scene, state).extremes is None
    assert period(scene, state) == np.inf
    assert np.isnan(extremes(scene, state)).all() and "give span=T" in extremes(scene, state).reason
    with pytest.raises(InputError, match="span"):
        extremes(scene, states=[state])
    wanted = [[3, 3 + 1.5 * 4], [4, 4 + 2 * 4], [0, 0]]
    np.testing.assert_allclose(extremes(scene, state, span=4.0), wanted, rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(motion(scene, state, (0, 4)).extremes, wanted, rtol=1e-12, atol=1e-12)


def test_off_the_axes_rest_is_exact_and_the_rest_is_searched_over_a_span():
    """The second state spins up about axis 3 (certified); a run of 60 s by DOP853 shows it and stays within
    the bounds for all times."""
    rest, state = np.array([1.0, 1.0, 1.0]), np.array([1.0, 0.5, -0.25])
    both = np.stack([rest, state])
    assert period(OFF, both).tolist() == [0.0, np.inf]
    assert stabilab.fate(OFF, both).labels.tolist() == [Fate.EQUILIBRIUM, Fate.SPIN_UP]
    np.testing.assert_array_equal(extremes(OFF, rest[None]), [[[1, 1]] * 3])
    found = extremes(OFF, both, span=3.0)
    np.testing.assert_array_equal(found[0], [[1, 1]] * 3)
    np.testing.assert_allclose(found[1], run_extremes((3, 2, 1), (0, 0, 0), (-1, 2, -1), state, 3.0),
                               atol=3e-6)
    assert motion(OFF, rest).extremes == ((1, 1),) * 3
    single = motion(OFF, state, (0, 3))
    assert single.fate == Fate.SPIN_UP and (single.axis, single.sense) == (3, -1)
    np.testing.assert_allclose(single.extremes, found[1], rtol=1e-12)
    always, long = np.array(motion(OFF, state).extremes), run_extremes((3, 2, 1), (0, 0, 0), (-1, 2, -1),
                                                                       state, 60.0)
    assert (always[:, 0] <= long[:, 0]).all() and (long[:, 1] <= always[:, 1]).all()
    assert always[2, 0] == -np.inf and long[2, 0] < -40  # the spin grows as M3/D3 t
    np.testing.assert_array_equal(extremes(OFF, both), [[[1, 1]] * 3, always])


@pytest.mark.parametrize("bound", [1 / 3, -1 / 3, 0.1, 2.0, -2.5, 1e-300, 123456789.0123456789, 0.0, np.inf])
def test_bounds_are_rounded_to_their_safe_side(bound):
    assert outward(bound, ROUND_FLOOR) <= bound <= outward(bound, ROUND_CEILING)
    np.testing.assert_allclose([outward(bound, ROUND_FLOOR), outward(bound, ROUND_CEILING)], bound, rtol=2e-9)


def test_boxes_and_periods_together_are_for_scenes_with_a_reduction():
    with pytest.raises(InputError, match="no reduction"):
        extremes_and_periods(OFF, STATES)


def test_a_state_in_a_row_of_its_own_is_that_state():
    row, flat = (motion(ALONG, state) for state in (np.array([[0.5, 0.25, 1.0]]), (0.5, 0.25, 1.0)))
    assert row == flat
    for bad in ((0.5, 0.25), (0.5, "fast", 1.0), (0.5, np.nan, 1.0), None):
        with pytest.raises(InputError):
            motion(ALONG, bad)
