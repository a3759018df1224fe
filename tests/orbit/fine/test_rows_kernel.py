"""The compiled kernel for rows in twofold numbers, as plain Python, against ball arithmetic and against the arrays. Nothing looks at the clock."""
from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest

from benchmarks.random_scenes import drawn
from stabilab import Fate, ScaledGyrostat, extremes, fate, period
from stabilab.numbers.numba_door import twins
from stabilab.orbit.ball_orbit import Orbit
from stabilab.orbit.extremes.balls import precise_extremes
from stabilab.orbit.extremes_and_periods import extremes_and_periods
from stabilab.orbit.fine import rows_kernel, rows_numba
from stabilab.orbit.fine.rows_numba import kernel_input, settle_rows
from stabilab.orbit.landscape import landscape
from stabilab.orbit.period import arrays as period_arrays
from stabilab.orbit.period.balls import precise_period
from tests.oracles.pairs import brink
from tests.orbit.fate.test_fate import FAMILIES
from tests.orbit.fine.test_fine import HYPERBOLAS, SCENES, scene, states_of

# of the sample of random scenes: hyperbolas and circles, a rod, nearly equal moments, equilibria between two folds
SAMPLE = (0, 1, 2, 13, 39, 46, 82)


def plain(one, states):
    """(boxes, periods, bits left open) of the kernel as plain Python; NaN where it wrote nothing."""
    boxes, periods, left = np.full((len(states), 3, 2), np.nan), np.full(len(states), np.nan), np.full(len(states), 3, np.uint8)
    with np.errstate(all="ignore"):
        settle_rows(rows_numba.plain, landscape(one), states, boxes, periods, left)
    return boxes, periods, left


def bounded(number, count):
    one = drawn(number + 1)[number]
    states = one.states(3 * count)
    return one.scene, states[fate(one.scene, states).labels == Fate.BOUNDED][:count]


@pytest.mark.one_in(2)
@pytest.mark.parametrize("name", SCENES)
def test_rows_of_nearly_equal_moments_have_the_extremes_and_periods_of_balls(name):
    one, states = SCENES[name], states_of(name, 40, label=Fate.BOUNDED)[:12]
    boxes, periods, left = plain(one, states)
    assert (left == 0).sum() >= 10
    for state, box, time in zip(states[left == 0], boxes[left == 0], periods[left == 0]):
        orbit = Orbit(landscape(one).reduction, state)
        exact = np.array(precise_extremes(orbit, Fate.BOUNDED))
        assert (np.abs(box - exact).max(axis=1) <= 1e-12 * np.abs(exact).max(axis=1)).all()
        assert time == pytest.approx(precise_period(orbit, Fate.BOUNDED), rel=1e-11)


@pytest.mark.one_in(2)
@pytest.mark.parametrize("number", SAMPLE)
def test_rows_of_random_scenes_have_the_extremes_and_periods_of_arrays(number):
    one, states = bounded(number, 80)
    boxes, periods, left = plain(one, states)
    exact, times = extremes_and_periods(one, states, fast=False)
    assert (left == 0).mean() > 0.9
    known, timed = (left & 1) == 0, (left & 2) == 0
    assert (np.abs(boxes[known] - exact[known]).max(axis=2) <= 2e-12 * np.abs(exact[known]).max(axis=2)).all()
    np.testing.assert_allclose(periods[timed], times[timed], rtol=2e-11)


@pytest.mark.parametrize("name", ["hyperbolas, 0.938 and 0.942", "circles, a rod"])
def test_rows_next_to_a_barrier_have_the_period_of_balls_or_stay_open(name):
    """The nearest of four thousand to a barrier, on either side of it: the integrand has a peak, which the double-exponential rule takes."""
    one, states = SCENES[name], states_of(name, 4000, label=Fate.BOUNDED)
    near = states[np.argsort(np.abs(fate(one, states).margins) / (states**2).sum(axis=1))[:24]]
    _, periods, left = plain(one, near)
    timed = (left & 2) == 0
    assert timed.sum() >= 8
    exact = [precise_period(Orbit(landscape(one).reduction, state), Fate.BOUNDED) for state in near[timed][:10]]
    np.testing.assert_allclose(periods[timed][:10], exact, rtol=1e-11)


def test_spin_ups_states_at_rest_and_states_on_a_plane_stay_open_and_unwritten():
    """At rest: D2 w2' = lambda3 w1 + M2 = 0 at w = (2, 0, 0), the other rates vanish. Planes of D = (3, 2.5, 1) without a wheel: w3 = +-w1, for
    dw3/dw1 = ((D1 - D2)/D3) w1/(((D2 - D3)/D1) w3) = w1/w3."""
    spinning = states_of("circles, a rod", 400, label=Fate.SPIN_UP)[:20]
    for one, states in ((SCENES["circles, a rod"], spinning), (scene((3, 2, 1), (0, 0, 1), 1, -2.0), np.array([[2.0, 0.0, 0.0]])),
                        (scene((3, 2.5, 1), (0, 0, 0), 1, 0.5), np.array([[1.0, 0.3, 1.0], [-1.5, 0.2, 1.5], [0.0, 0.4, 0.0]]))):
        assert kernel_input(landscape(one)) is not None
        boxes, periods, left = plain(one, states)
        assert (left == 3).all() and np.isnan(boxes).all() and np.isnan(periods).all()


def test_a_state_whose_only_equilibrium_is_told_too_blurred_stays_open():
    """Beside a plane, 26 e-foldings from the well of its orbit: the energy over the well is all rounding, and no number says how far the end is off.
    Ball arithmetic has the second rate between -226.16 and 226.16; half of a motion was called all of it."""
    one = ScaledGyrostat(a=-0.23863090224735242, b=-0.6107161051478869, mu=(0.0, -1.0, 0.0))
    state = [float.fromhex(v) for v in ("-0x1.c39a15804066ap+7", "0x1.1f10bffa14b2dp+1", "-0x1.c4d2c54845fc5p+7")]
    boxes, _, left = plain(one, np.array([state]))
    exact = np.array(precise_extremes(Orbit(landscape(one).reduction, state), Fate.BOUNDED))
    assert exact[1] == pytest.approx([-226.1618997146982, 226.1618997146982], rel=1e-12)
    assert left[0] & 1 or (np.abs(boxes[0] - exact).max(axis=1) <= 1e-12 * np.abs(exact).max(axis=1)).all()


@pytest.mark.one_in(3)
@pytest.mark.parametrize("number", [23, 86, 0, 39, 89, 24])
def test_the_rows_of_random_scenes_nearest_to_a_separatrix_have_the_period_of_balls(number):
    """Of 4,000 states: energies over the equilibria in twofold numbers, and the integral in pieces from one of them to the next."""
    one, states = bounded(number, 4000)
    near = states[np.argsort(np.abs(fate(one, states).margins) / (states**2).sum(axis=1))[:8]]
    _, periods, left = plain(one, near)
    assert not (left & 2).any()
    exact = [precise_period(Orbit(landscape(one).reduction, state), Fate.BOUNDED) for state in near]
    np.testing.assert_allclose(periods, exact, rtol=2e-12)


@pytest.mark.parametrize("decades", [7, 9, 11, 13])
@pytest.mark.parametrize("name", ["minor physical", "major physical"])
def test_rows_so_many_decades_from_a_separatrix_have_the_period_of_balls(name, decades):
    one, problem = FAMILIES[name]
    rng, found = np.random.default_rng(decades), []
    while len(found) < 3:
        state = brink(problem, rng.normal(size=2) * 2, -(10.0**-decades))
        if state is not None and int(fate(one, state).labels) == Fate.BOUNDED:
            found.append(state)
    _, periods, left = plain(one, np.array(found, float))
    assert not (left & 2).any()
    exact = [precise_period(Orbit(landscape(one).reduction, state), Fate.BOUNDED) for state in np.array(found, float)]
    np.testing.assert_allclose(periods, exact, rtol=1e-11)


@pytest.mark.parametrize("y", [0.0, 1e-9, -0.3, 1.7, -3.1, 6.5, -12.5])
def test_the_sine_of_a_double_is_known_to_thirty_digits(y):
    with mp.workdps(60):
        for found, exact in zip(rows_kernel.sine_and_lag(y), (mp.sin(mp.mpf(y)), 1 - mp.cos(mp.mpf(y)))):
            assert abs(mp.mpf(found[0]) + mp.mpf(found[1]) - exact) <= mp.mpf(10) ** -29


@pytest.mark.parametrize("y", [0.0, 1e-9, -0.3, 1.7, 25.0, -80.5, 600.0])
def test_the_exponential_of_a_double_is_known_to_twenty_seven_digits(y):
    with mp.workdps(60):
        found, exact = rows_kernel.exponential(y), mp.exp(mp.mpf(y))
        assert abs(mp.mpf(float(found[0])) + mp.mpf(float(found[1])) - exact) <= mp.mpf(10) ** -27 * exact


@pytest.mark.slow  # compiling takes half a minute where no cache is
@pytest.mark.parametrize("number", SAMPLE)
def test_the_compiled_rows_are_those_of_plain_python_and_of_the_arrays(number):
    pytest.importorskip("numba")
    one, states = bounded(number, 400)
    boxes, periods = extremes(one, states, fast=True), period(one, states, fast=True)
    exact, times = extremes_and_periods(one, states, fast=False)
    assert (np.abs(boxes - exact).max(axis=2) <= 2e-12 * np.abs(exact).max(axis=2)).all()
    np.testing.assert_allclose(periods, times, rtol=2e-11)
    values, spans, left = plain(one, states[:30])
    if kernel_input(landscape(one)) and landscape(one).e > 0:
        np.testing.assert_allclose(spans[left == 0], periods[:30][left == 0], rtol=1e-12)
        np.testing.assert_allclose(values[left == 0], boxes[:30][left == 0], rtol=0, atol=1e-13 * np.abs(values[left == 0]).max())


def test_scenes_without_a_torque_or_with_lines_of_equilibria_have_no_kernel():
    assert kernel_input(landscape(scene((3, 2, 1), (0, 0, 1), 1, 0.0))) is None
    assert all(kernel_input(landscape(SCENES[name])) is not None for name in HYPERBOLAS)


def test_an_end_where_the_force_is_small_has_its_digits():
    """The force at an end is a thousandth of its terms here, and doubles left the end too few digits: the row went to balls, at nine milliseconds."""
    one, state = drawn(186)[185].scene, (0.7065480824112208, -0.4458277770271243, 0.007785850961628301)
    box, time, left = plain(one, np.array([state]))
    exact = np.array(precise_extremes(Orbit(landscape(one).reduction, state), Fate.BOUNDED))
    assert left[0] == 0 and (np.abs(box[0] - exact).max(axis=1) <= 1e-12 * np.abs(exact).max(axis=1)).all()
    assert time[0] == pytest.approx(precise_period(Orbit(landscape(one).reduction, state), Fate.BOUNDED), rel=1e-11)


@pytest.mark.parametrize("number", SAMPLE)
def test_ends_in_twofold_numbers_are_those_of_balls(number):
    """Of rows that would not need them too: the first look at a box is made to fail."""
    one, states = bounded(number, 12)
    land, looks = landscape(one), []

    def make(name, twin):
        if name != "boxed":
            return twin

        def boxed(*given):
            looks.append(0)
            return len(looks) % 2 == 0 and twin(*given)
        return boxed
    rows = twins(rows_kernel, make, **rows_kernel.functions_of(rows_kernel.GEOMETRIES[land.base]))["rows"]
    boxes, none, left = np.empty((len(states), 3, 2)), np.empty(0), np.full(len(states), 1, np.uint8)
    for n in range(len(states)):
        looks.clear()
        rows(states, np.array([n]), *kernel_input(land), 1, rows_numba.rules(), boxes, none, left)
    assert np.count_nonzero(left == 0) >= 0.9 * len(states)
    for state, box in zip(states[left == 0], boxes[left == 0]):
        exact = np.array(precise_extremes(Orbit(land.reduction, state), Fate.BOUNDED))
        assert (np.abs(box - exact).max(axis=1) <= 1e-12 * np.abs(exact).max(axis=1)).all()


def test_arrays_ask_balls_of_no_row_that_the_rows_in_twofold_numbers_settle(monkeypatch):
    """Of 3,000 rows of nearly equal moments a few next to the separatrix are left by the arrays; balls took three to thirty milliseconds for each."""
    one, states = bounded(114, 3000)
    asked = []
    monkeypatch.setattr(period_arrays, "one_by_one", lambda land, rows, bit: asked.append(len(rows)) or rows_numba.one_by_one(land, rows, bit))
    monkeypatch.setattr(period_arrays, "precise_period", lambda orbit, label: pytest.fail(f"{orbit.state} was asked of balls"))
    periods = period(one, states, fast=False)
    assert sum(asked) >= 2 and np.isfinite(periods).all()


@pytest.mark.parametrize("number", SAMPLE[:4])
def test_one_by_one_rows_have_the_extremes_and_periods_of_balls(number):
    one, states = bounded(number, 6)
    land = landscape(one)
    for bit, exact in ((1, lambda orbit: np.array(precise_extremes(orbit, Fate.BOUNDED))), (2, lambda orbit: precise_period(orbit, Fate.BOUNDED))):
        values, found = rows_numba.one_by_one(land, states, bit)
        assert found.sum() >= 5
        for state, value in zip(states[found], values[found]):
            true = exact(Orbit(land.reduction, state))
            assert np.abs(value - true).max() <= 1e-11 * np.abs(true).max()
