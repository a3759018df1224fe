"""Laws of rows in twofold numbers on circles and hyperbolas, run as plain Python: against ball arithmetic and a potential in many digits.

Nothing looks at the clock.
"""
import numpy as np
import pytest

import stabilab
from benchmarks.random_scenes import drawn
from stabilab import Fate, fate
from stabilab.errors import InputError
from stabilab.numbers import numba_door
from stabilab.orbit.ball_orbit import Orbit
from stabilab.orbit.extremes.balls import precise_extremes
from stabilab.orbit.extremes_and_periods import extremes_and_periods
from stabilab.orbit.fine import rows_numba
from stabilab.orbit.fine.rows_numba import kernel_input, settle_rows
from stabilab.orbit.landscape import landscape
from stabilab.orbit.period.balls import precise_period
from tests.oracles import energy
from tests.oracles.pairs import brink, exactly, physical, scaled
from tests.orbit.extremes.test_extremes import assert_extremes
from tests.orbit.fate.test_fate import FAMILIES, sample
from tests.orbit.fine.test_rows_kernel import plain
from tests.orbit.test_batches_of_random_scenes import beside_and_anywhere

BODY = (2000, 1500, 1000)


def bounded(one, states):
    return states[fate(one, states).labels == Fate.BOUNDED]


def assert_exact(one, states, boxes, periods, left):
    """Of what is settled, the promise: extremes to 1e-12, periods to 1e-11, against balls."""
    for state, box, time, bits in zip(states, boxes, periods, left):
        orbit = Orbit(landscape(one).reduction, state)
        if not bits & 1:
            exact = np.array(precise_extremes(orbit, Fate.BOUNDED), float)
            assert (np.abs(box - exact).max(axis=1) <= 1e-12 * np.abs(exact).max(axis=1)).all(), state.tolist()
        if not bits & 2:
            assert time == pytest.approx(precise_period(orbit, Fate.BOUNDED), rel=1e-11), state.tolist()


@pytest.mark.parametrize("sign", [-1, 1])
@pytest.mark.parametrize("axis, wheel", [(2, (100, 0, 0)), (2, (60, 90, 0)), (0, (0, 70, 0)), (0, (0, 50, -90)),
                                         (1, (100, 0, 0)), (1, (60, 0, 90))])
def test_rows_about_every_axis_are_settled_and_have_the_digits_of_balls(sign, axis, wheel):
    """Circles about the minor and the major axis, hyperbolas about the intermediate one, either direction of the torque."""
    one = physical(BODY, wheel, tuple(200.0 * sign if n == axis else 0 for n in range(3)))[0]
    states = bounded(one, np.random.default_rng(5).uniform(-1, 1, (60, 3)))[:10]
    boxes, periods, left = plain(one, states)
    assert (left == 0).mean() > 0.9
    assert_exact(one, states[:5], boxes, periods, left)


@pytest.mark.parametrize("scale", [1e-6, 1e3, 1e6])
@pytest.mark.parametrize("axis", [1, 2])
def test_scaling_the_scene_scales_the_answers(scale, axis):
    """omega, lambda ~ s and M ~ s^2 leave D omega' = (D omega + lambda) x omega + M as it is in the time t/s."""
    torque = np.where(np.arange(3) == axis, 200.0, 0.0)
    one = physical(BODY, (100, 0, 0), tuple(torque))[0]
    twin = physical(BODY, (100 * scale, 0, 0), tuple(torque * scale * scale))[0]
    states = bounded(one, np.random.default_rng(5).uniform(-1, 1, (60, 3)))[:12]
    boxes, periods, left = plain(one, states)
    other, times, open_ = plain(twin, states * scale)
    same = (left == 0) & (open_ == 0)
    assert same.sum() >= 8
    size = np.abs(boxes[same]).max(axis=2, keepdims=True)
    assert np.all(np.abs(other[same] / scale - boxes[same]) <= 2e-12 * size)
    np.testing.assert_allclose(times[same] * scale, periods[same], rtol=1e-11)


@pytest.mark.parametrize("name", ["minor scaled +", "minor physical", "major physical"])
@pytest.mark.parametrize("decades", [3, 6, 9, 12, 15])
def test_next_to_the_separatrix_extremes_and_periods_keep_their_digits_or_stay_open(name, decades):
    one, problem = FAMILIES[name]
    rng, found = np.random.default_rng(11), []
    while len(found) < 2:
        state = brink(problem, rng.normal(size=2) * 2, -(10.0**-decades))
        if state is not None and int(fate(one, np.array(state, float)).labels) == Fate.BOUNDED:
            found.append(state)
    states = np.array(found, float)
    assert_exact(one, states, *plain(one, states))


@pytest.mark.parametrize("number", [13, 28, 39, 82])
def test_rows_that_just_reach_their_barrier_keep_their_digits_or_stay_open(number):
    """Rates off by 1e-3 to 1e-12 of themselves from those with which the barrier is just reached."""
    one = drawn(number + 1)[number]
    states = bounded(one.scene, beside_and_anywhere(one, 96)[::2])[:12]
    boxes, periods, left = plain(one.scene, states)
    assert (left == 0).any()
    assert_exact(one.scene, states, boxes, periods, left)


@pytest.mark.parametrize("decades", [2, 6, 10, 12])
@pytest.mark.parametrize("number", [1, 31, 82, 24, 89])
def test_small_motions_about_a_well_keep_their_digits_or_stay_open(number, decades):
    """So many decades smaller than the rates: of these the ends are known, but not their distance."""
    one = drawn(number + 1)[number]
    land = landscape(one.scene)
    place, _, _ = land.start(one.states(8))
    _, spots, barrier = land.critical(place)
    wells = np.where(barrier, np.nan, spots[0])
    column = np.nanargmin(np.where(np.isnan(wells), np.inf, np.abs(wells)), axis=1)
    well = spots[:, np.arange(8), column]
    states = bounded(one.scene, land.components(land.potential.move(tuple(well), 10.0**-decades), np.full(8, 10.0**-decades)))[:5]
    assert len(states)
    assert_exact(one.scene, states, *plain(one.scene, states))


@pytest.mark.parametrize("pair, state", [
    (physical((3, 2, 1), (3, 0, 0), (0, 0, -1)), (0, -3, 4)), (physical((2, 3, 1), (1, 0, 0), (0, -0.25, 0)), (0, 0, 2)),
    (physical((1, 2, 3), (-1, -1, 0), (0, 0, 0.25)), (-1.5, 1.5, -0.5)),
    (physical((4.845, 4.842, 3.945), (0, -0.849, 0.291), (1.0328, 0, 0)), (0.08901751458670247, -1.249736256580412, -0.1355491972910896)),
    ((drawn(24)[23].scene, None), (0.062022077246017424, -2.40730533121281, 1.7694966114961876)),
    ((drawn(2)[1].scene, None), (18.42036219, -4.97608147, 5.74449751))])
def test_ends_that_steps_of_the_third_order_missed_are_found_or_left_open(pair, state):
    """Ends 1e-10 to 2e-8 away from where such steps stopped; a well where the force bends sharply; an end eleven e-foldings away."""
    states = np.array([state], float)
    assert_exact(pair[0], states, *plain(pair[0], states))
    if pair[1] is not None:
        true = float(energy.period(pair[1], tuple(map(float, state))))
        assert abs(extremes_and_periods(pair[0], states, fast=False)[1][0] / true - 1) < 1e-12


def test_motions_over_a_slope_before_their_wall_have_the_digits_of_balls():
    """A shallow well far from the wall."""
    one = drawn(11)[10].scene
    states = bounded(one, drawn(11)[10].states(100))[:12]
    boxes, periods, left = plain(one, states)
    assert (left == 0).mean() > 0.7
    assert_exact(one, states, boxes, periods, left)


@pytest.mark.parametrize("number", [7, 28])
def test_any_split_of_the_rows_gives_the_same_bytes_and_either_question_those_of_both(number):
    one = drawn(number + 1)[number]
    states, land = bounded(one.scene, one.states(150))[:40], landscape(one.scene)
    whole = plain(one.scene, states)
    parts = [plain(one.scene, part) for part in np.split(states, (1, 13))]
    for column, pieces in zip(whole, zip(*parts)):
        np.testing.assert_array_equal(np.concatenate(pieces), column)
    boxes, periods = np.full((len(states), 3, 2), np.nan), np.full(len(states), np.nan)
    box_left, time_left = np.full(len(states), 1, np.uint8), np.full(len(states), 2, np.uint8)
    with np.errstate(all="ignore"):
        settle_rows(rows_numba.plain, land, states, boxes, np.empty(0), box_left)
        settle_rows(rows_numba.plain, land, states, np.empty((0, 3, 2)), periods, time_left)
    np.testing.assert_array_equal(box_left | time_left, whole[2])
    np.testing.assert_array_equal(boxes[box_left == 0], whole[0][box_left == 0])
    np.testing.assert_array_equal(periods[time_left == 0], whole[1][time_left == 0])


def test_states_that_doubles_cannot_settle_are_left_open():
    """a = b = 0: an equilibrium (h = 1/2, X = -2) and a pure spin; (2 - 3) 1 1 = -1: the torque is met, by hand."""
    for one, states in ((scaled(0, 0, (0, 0, 1))[0], [[-2.0, 0.5, 0.0], [0.0, 0.0, 1.0]]),
                        (physical((3, 2, 4), (0, 0, 0), (0, 0, -1))[0], [[1.0, 1.0, 0.0]])):
        if kernel_input(landscape(one)) is not None:
            assert (plain(one, np.array(states))[2] == 3).all()
    rest = np.array([[1.0, 1.0, 0.0]] * 2)
    assert stabilab.period(physical((3, 2, 4), (0, 0, 0), (0, 0, -1))[0], rest)[0] == 0


def test_the_search_for_a_turning_point_does_not_end_on_a_barrier():
    """The well is so flat that a first guess lay beyond the barrier: the least rate about axis 2 was -5.83 for -3.03."""
    one, problem = physical((2, 3, 4), (0, 2, 0), (0, 0, 0))
    assert_extremes(stabilab.extremes(one, np.array([(4.0, 0, 2)]), fast=False)[0], energy.extremes(problem, (4.0, 0.0, 2.0)), 1e-12)


def test_fates_show_in_the_extremes_exactly(kernels):
    """Bounded motions have finite extremes and periods, spin-ups infinite ones, as an oracle's potential decides."""
    one, problem = FAMILIES["minor scaled +"]
    states = sample("minor scaled +", 60)
    boxes, periods = extremes_and_periods(one, states, fast=True)
    spins = np.array([energy.label(problem, tuple(state), digits=60) == "spin-up" for state in states.tolist()])
    np.testing.assert_array_equal(np.isinf(boxes).any(axis=(1, 2)), spins)
    np.testing.assert_array_equal(np.isinf(periods), spins)


def test_without_numba_fast_is_refused_and_none_takes_the_arrays(monkeypatch):
    monkeypatch.setattr(numba_door, "installed", lambda: False)
    one, states = FAMILIES["minor scaled +"][0], sample("minor scaled +", 5)
    with pytest.raises(InputError, match="pip install numba"):
        stabilab.extremes(one, states, fast=True)
    monkeypatch.setattr(rows_numba, "COLD", 1)
    assert np.isfinite(stabilab.extremes(one, states)).any()


def test_equilibria_between_two_folds_have_the_extremes_of_the_potential(kernels):
    one, problem = physical((1.28, 2.85, 1.98), (5.59, 0, -1.92), (0, 14.32, 0))
    assert len(landscape(one).conic.folds) == 4
    states = np.random.default_rng(1).normal(size=(12, 3)) * 3
    for box, state in zip(stabilab.extremes(one, states, fast=True), states.tolist()):
        assert_extremes(box, energy.extremes(problem, state), 1e-11)


def test_circles_without_a_fold_are_served(kernels):
    """Moment along both equal axes, D1 = D3, torque about the other: an empty tuple of folds."""
    one, problem = physical((31.654399378285476, 0.063245553203366, 31.654399378285476), (-100, 0, -100), (0, -1000, 0))
    state = exactly("0x1.96c946803cb76p+1", "-0x1.9c092949740b8p-7", "0x1.952d3d56f3435p+1")
    assert_extremes(stabilab.extremes(one, np.array(state), fast=True), energy.extremes(problem, state), 1e-11)


def test_a_torque_along_an_axis_of_symmetry_has_no_rows():
    """No equilibria, an empty tuple of pieces."""
    pytest.importorskip("numba")
    one, _ = physical((5.526899912556323, 10.679241384490718, 5.526899912556323), (0, 0, 0), (0, -358.8648632605358, 0))
    found = stabilab.extremes(one, np.array([[3.0, 2.0, 4.0]] * 3), fast=True)
    np.testing.assert_allclose(found, [[[-5, 5], [-np.inf, 2], [-5, 5]]] * 3, rtol=1e-14)  # the circle of radius 5; omega2 falls steadily
    assert np.isinf(stabilab.period(one, np.array([[3.0, 2.0, 4.0]]), fast=True)).all()
