"""Laws of rows, one libration at a time, as plain Python: against ball arithmetic and a potential in many
digits, on every geometry.

Nothing looks at the clock.
"""
from __future__ import annotations

import math

import mpmath as mp
import numpy as np
import pytest

import stabilab
from benchmarks.random_scenes import drawn
from stabilab import Fate, ScaledGyrostat, fate
from stabilab.numbers import numba_door
from stabilab.numbers.numba_door import twins
from stabilab.orbit.extremes import parabola_kernel
from stabilab.orbit.extremes.arrays import trapped_rows
from stabilab.orbit.extremes.one_state import precise_extremes
from stabilab.orbit.extremes_and_periods import extremes_and_periods
from stabilab.orbit.fate.arrays import fate_on_orbit
from stabilab.orbit.fine import rows_kernel, rows_numba
from stabilab.orbit.fine.rows_numba import kernel_input, settle_rows
from stabilab.orbit.landscape import landscape
from stabilab.orbit.one_orbit import Orbit
from stabilab.orbit.period import precise_period
from tests.oracles import energy
from tests.oracles.pairs import brink, exactly, physical, scaled
from tests.orbit.extremes.test_extremes import assert_extremes
from tests.orbit.fate.test_fate import FAMILIES, sample
from tests.orbit.test_batches_of_random_scenes import beside_and_anywhere

BODY = (2000, 1500, 1000)
PAIRS = {
    "circles, minor axis": physical(BODY, (60, 90, 0), (0, 0, 2)),
    "circles, major axis": physical(BODY, (0, 50, -90), (-2, 0, 0)),
    "circles, one wheel": physical(BODY, (0, 70, 0), (0.5, 0, 0)),
    "circles, a rod": physical((3.895, 3.766, 0.196), (0, -2.753, -0.167), (-0.3551, 0, 0)),
    "circles, 4.642 and 4.635": physical((3.315, 4.642, 4.635), (0, 0, -1.393), (0, -0.0106, 0)),
    "circles, moments equal to 1e-8": physical((1.0, 1.0 + 1e-8, 0.9), (0.5, 0.3, 0), (0, 0, 0.2)),
    "circles, equal moments across": physical((1.3, 1.3, 0.9), (0.7, -0.4, 0), (0, 0, 0.3)),
    "circles, no wheel": physical((1.2, 0.7, 0.9), (0, 0, 0), (0, 0.05, 0)),
    "circles, a pair of lines": physical((1.0, 2.0, 2.5), (0, 0.5, 0.25), (0.25, 0, 0)),
    "circles, no torque": physical((3, 2, 1), (0.5, 0, 0)),
    "circles, neither wheel nor torque": physical((3, 2, 1)),
    "hyperbolas": physical(BODY, (60, 0, 90), (0, 200, 0)),
    "hyperbolas, one wheel": physical(BODY, (100, 0, 0), (0, -200, 0)),
    "hyperbolas, no wheel": physical((1.168, 0.527, 0.895), (0, 0, 0), (0, 0, 0.357)),
    "hyperbolas, 7.121 and 7.104": physical((7.121, 7.104, 9.259), (0, -2.586, -0.953), (-0.6156, 0, 0)),
    "hyperbolas, 0.938 and 0.942": physical((0.473, 0.938, 0.942), (0, 0, 4.556), (0, 0.6802, 0)),
    "hyperbolas, a pair of lines": physical((1.0, 2.0, 2.5), (0.75, 0, 1.5), (0, -0.75, 0)),
    "parabolas, a disc": physical((6.098, 6.098, 11.2), (0, 1.104, -8.298), (-0.01, 0, 0)),
    "parabolas, a needle": physical((6.098, 6.098, 0.972), (0, 1.104, -8.298), (-0.01, 0, 0)),
    "parabolas, a wheel across": physical((4.8, 9.8, 9.8), (1.2, 0, 0.66), (0, 0.295, 0)),
    "parabolas, a strong torque": physical((0.77, 1.22, 0.77), (0.3, 0.1, 0), (0, 0, 2.5)),
    "parabolas, a sphere": physical((1, 1, 1), (0.5, 0.3, 0), (0, 0, 0.2)),
}
SCENES = {name: pair[0] for name, pair in PAIRS.items()}
PARABOLAS = [name for name in SCENES if name.startswith("parabolas") and "sphere" not in name]
each = pytest.mark.parametrize("name", SCENES)
# of the sample of random scenes: hyperbolas and circles, a rod, nearly equal moments, equilibria between two
# folds
SAMPLE = (0, 1, 2, 13, 39, 46, 82)


def librations(one, states):
    """Those between two turning points."""
    land = landscape(one)
    return states[trapped_rows(land, fate_on_orbit(one, land, states))]


def states_of(name, count):
    """Librations of a tenth to ten times the rates that wheel and torque bring about."""
    one, rng = SCENES[name], np.random.default_rng(len(name))
    least = min(map(float, one.body.exact))
    wheel, torque = (float(np.linalg.norm([float(v) for v in one.vector(which)]))
                     for which in ("gyrostat", "torque"))
    way = rng.normal(size=(8 * count, 3))
    rate = (wheel / least + math.sqrt(torque / least) or 1.0) * 10 ** rng.uniform(-1, 1, (8 * count, 1))
    return librations(one, way / np.linalg.norm(way, axis=1)[:, None] * rate)[:count]


def settled(one, states, by_numba=False, asked=3):
    """(boxes, periods, bits left open); NaN where nothing was written."""
    boxes, periods = np.full((len(states), 3, 2), np.nan), np.full(len(states), np.nan)
    left = np.full(len(states), asked, np.uint8)
    settle_rows(landscape(one), states, boxes, periods, left, by_numba)
    return boxes, periods, left


def assert_exact(one, states, boxes, periods, left):
    """Of what is settled, the promise: extremes to 1e-12, periods to 1e-11, against balls."""
    for state, box, time, bits in zip(states, boxes, periods, left):
        orbit = Orbit(landscape(one).reduction, state)
        if not bits & 1:
            exact = np.array(precise_extremes(orbit, Fate.BOUNDED), float)
            assert (np.abs(box - exact).max(axis=1) <= 1e-12
                    * np.abs(exact).max(axis=1)).all(), state.tolist()
        if not bits & 2:
            assert time == pytest.approx(precise_period(orbit, Fate.BOUNDED), rel=1e-11), state.tolist()


@each
@pytest.mark.parametrize("by_numba", [False, pytest.param(True, marks=pytest.mark.slow)])
def test_all_rows_are_settled_with_the_digits_of_balls_and_of_a_potential_in_many_digits(name, by_numba):
    if by_numba:
        pytest.importorskip("numba")
    one, problem = PAIRS[name]
    states = states_of(name, 2000 if by_numba else 60)
    boxes, periods, left = settled(one, states, by_numba)
    assert len(states) >= 20 and np.count_nonzero(left) <= len(states) / 1000
    assert_exact(one, states[:6], boxes, periods, left)
    for state, box, time in zip(states[:2].tolist(), boxes, periods):
        assert_extremes(box, energy.extremes(problem, state), 1e-11)
        assert time == pytest.approx(float(energy.period(problem, state)), rel=1e-11)
    assert ((boxes[..., 0] <= states) & (states <= boxes[..., 1])).all()


@pytest.mark.parametrize("name", ["minor scaled +", "minor physical", "major physical"])
@pytest.mark.parametrize("decades", [3, 6, 9, 11, 13, 15])
def test_so_many_decades_from_the_separatrix_answers_keep_their_digits_or_stay_open(name, decades):
    one, problem = FAMILIES[name]
    rng, found = np.random.default_rng(11), []
    while len(found) < 2:
        state = brink(problem, rng.normal(size=2) * 2, -(10.0**-decades))
        if state is not None and int(fate(one, np.array(state, float)).labels) == Fate.BOUNDED:
            found.append(state)
    states = np.array(found, float)
    boxes, periods, left = settled(one, states)
    assert decades > 13 or not (left & 2).any()
    assert_exact(one, states, boxes, periods, left)


@pytest.mark.parametrize("name", PARABOLAS)
def test_next_to_a_separatrix_of_parabolas_rows_have_their_digits_or_stay_open(name):
    """From a tenth of the rate at the barrier to a trillionth, and on to rounding, where all are left."""
    one, land = SCENES[name], landscape(SCENES[name])
    states, axis = states_of(name, 400), land.reduction.axis
    found = fate(one, states)
    height = found.margins / land.reduction.energy_unit + 0.5 * land.start(states)[1] ** 2
    high = np.nonzero(np.isfinite(height) & (height > 0))[0][:4]
    assert len(high)
    for distance in 10.0 ** -np.arange(1, 17, 2):
        near = states[high]
        near[:, axis] = np.sqrt(2 * height[high]) * (1 + distance) - float(land.reduction.s)
        boxes, periods, left = settled(one, near)
        assert_exact(one, near, boxes, periods, left)
        assert distance < 1e-9 or not (left & 1).any()


@pytest.mark.one_in(2)
@pytest.mark.parametrize("number", [13, 28, 39, 82])
def test_rows_that_just_reach_their_barrier_keep_their_digits_or_stay_open(number):
    """Rates off by 1e-3 to 1e-12 of themselves from those with which the barrier is just reached."""
    one = drawn(number + 1)[number]
    states = librations(one.scene, beside_and_anywhere(one, 96)[::2])[:12]
    boxes, periods, left = settled(one.scene, states)
    assert (left == 0).any()
    assert_exact(one.scene, states, boxes, periods, left)


@pytest.mark.one_in(3)
@pytest.mark.parametrize("number", [23, 86, 0, 39, 89, 24])
def test_the_rows_of_random_scenes_nearest_to_a_separatrix_have_the_period_of_balls(number):
    """Of 4,000 states: energies over the equilibria in twofold numbers, and the integral in pieces from one
    of them to the next."""
    one = drawn(number + 1)[number]
    states = librations(one.scene, one.states(4000))
    near = states[np.argsort(np.abs(fate(one.scene, states).margins) / (states**2).sum(axis=1))[:8]]
    _, periods, left = settled(one.scene, near, asked=2)
    assert not left.any()
    exact = [precise_period(Orbit(landscape(one.scene).reduction, state), Fate.BOUNDED) for state in near]
    np.testing.assert_allclose(periods, exact, rtol=2e-12)


@pytest.mark.one_in(2)
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
    small = np.full(8, 10.0**-decades)
    states = librations(one.scene, land.components(land.potential.move(tuple(well), small), small))[:5]
    assert len(states)
    assert_exact(one.scene, states, *settled(one.scene, states))



@pytest.mark.parametrize("one, state", [
    # ends 1e-10 to 2e-8 away from where steps of the third order stopped; a well where the force bends
    # sharply
    (physical((3, 2, 1), (3, 0, 0), (0, 0, -1))[0], (0, -3, 4)),
    (physical((2, 3, 1), (1, 0, 0), (0, -0.25, 0))[0], (0, 0, 2)),
    (physical((1, 2, 3), (-1, -1, 0), (0, 0, 0.25))[0], (-1.5, 1.5, -0.5)),
    (physical((4.845, 4.842, 3.945), (0, -0.849, 0.291), (1.0328, 0, 0))[0],
     (0.08901751458670247, -1.249736256580412, -0.1355491972910896)),
    (drawn(24)[23].scene, (0.062022077246017424, -2.40730533121281, 1.7694966114961876)),
    (drawn(2)[1].scene, (18.42036219, -4.97608147, 5.74449751)),  # an end eleven e-foldings away
    # a small force at an end
    (drawn(186)[185].scene, (0.7065480824112208, -0.4458277770271243, 0.007785850961628301)),
    # so flat a well that a first guess lay beyond the barrier
    (physical((2, 3, 4), (0, 2, 0), (0, 0, 0))[0], (4.0, 0.0, 2.0))])
def test_hard_rows_have_the_digits_of_balls(one, state):
    states = np.array([state], float)
    boxes, periods, left = settled(one, states)
    assert not left[0]
    assert_exact(one, states, boxes, periods, left)


@pytest.mark.parametrize("pair, state", [
    # equilibria between two folds
    (physical((1.28, 2.85, 1.98), (5.59, 0, -1.92), (0, 14.32, 0)), (1.0, 2.0, -3.0)),
    # D1 = D3 and momentum along both: no fold
    (physical((31.654399378285476, 0.063245553203366, 31.654399378285476), (-100, 0, -100), (0, -1000, 0)),
     exactly("0x1.96c946803cb76p+1", "-0x1.9c092949740b8p-7", "0x1.952d3d56f3435p+1"))])
def test_orbits_with_four_folds_and_with_none_have_the_extremes_of_the_potential(pair, state):
    assert_extremes(stabilab.extremes(pair[0], np.array([state]))[0], energy.extremes(pair[1], state), 1e-11)


@pytest.mark.parametrize("one, state", [
    # 26 e-foldings from the well of its orbit, beside a plane: half of a motion was called all of it
    (ScaledGyrostat(a=-0.23863090224735242, b=-0.6107161051478869, mu=(0.0, -1.0, 0.0)),
     exactly("-0x1.c39a15804066ap+7", "0x1.1f10bffa14b2dp+1", "-0x1.c4d2c54845fc5p+7")),
    (physical((4.112906792284341, 4.116438148785544, 6.651829713409366),
              (-1.0968587547960387, 0, -1.253790681840892), (0, 0.022295378844975795, 0))[0],
     (-310.60505266244706, 0.2419430815388782, 0.4944901326076557)),
    (physical((1.696601852841146, 1.6966018528540456, 1.6966018528531723),
              (-1.3494698280666895, 0.3393281923930477, 0), (0, 0, 0.009203201574543322))[0],
     (-112209146907.95891, -388557925455.79285, -0.3297841721936806)),
    # on a circle of 2e14 the component is largest 1e-11 of a radian from the state
    (physical((2.3655510073770074, 2.365549804636911, 2.365551007409251), (-5.159491704033158, 0, 0),
              (0, 0, -0.325038361299964))[0],
     (0.0, -0.009737502569610706, 0.05214105440254145)),
    # moments that differ in the ninth digit or in the last, beside a plane
    (physical((3.1876285123265875, 3.187628515759982, 1.824928201205744),
              (0.0, 0.05445062017840716, -0.09398239699358375), (-0.006183334127165318, 0, 0))[0],
     (0.0024122515732403014, -0.03254345636626074, 1052.018292334662)),
    (physical((4.692222633355173, 4.692222633355175, 1.3368392299688445),
              (0.0, 2.742149968031607, -12.151034472655752), (-8.273460328896768, 0, 0))[0],
     (0.05123606193972703, -2.8557630770849878, 66543357.684882864)),
    # intervals of some dozens
    (physical((2.031718528933873, 4.10832328101258, 3.3109147205774123), (0, 1.917540936122219, 0),
              (0, 0, 0.0023455994280943146))[0],
     (114.31465919137567, -104.22387896633768, 121.00166087530833)),
    (physical((0.3741516734409537, 1.210595902320289, 1.2105959023202715), (-0.20062944808043162, 0, 0),
              (0, 0, -4.158795551286843))[0],
     (4.4020441308656935, 17819913.764604468, -22.438121828253696)),
    (scaled(3.846545761245209, 25.295513736469676, (0, -1, 0))[0],
     exactly("-0x1.94ba667b95571p+4", "0x1.f595dad344cb2p+1", "0x1.520cbec7a148ap-17")),
    (scaled(0.31323180931136274, -29.568055273764834, (0, -1, 0))[0],
     exactly("0x1.d916c1102ce7dp+4", "-0x1.59eddc4d730c7p+2", "0x1.a85885ae4c3a0p-25"))])
def test_rows_beside_planes_and_of_nearly_equal_moments_have_their_digits_or_stay_open_and_balls_answer(
    one, state):
    states = np.array([state], float)
    assert_exact(one, states, *settled(one, states))
    assert_exact(one, states, *extremes_and_periods(one, states), np.zeros(1, np.uint8))


@pytest.mark.parametrize("name", ["hyperbolas", "circles, minor axis", "parabolas, a disc"])
def test_any_split_of_the_rows_gives_the_same_bytes_and_either_question_those_of_both(name):
    one, states = SCENES[name], states_of(name, 40)
    whole = settled(one, states)
    parts = [settled(one, part) for part in np.split(states, (1, 13))]
    for column, pieces in zip(whole, zip(*parts)):
        np.testing.assert_array_equal(np.concatenate(pieces), column)
    np.testing.assert_array_equal(settled(one, states, asked=1)[0], whole[0])
    np.testing.assert_array_equal(settled(one, states, asked=2)[1], whole[1])


@pytest.mark.parametrize("one, states", [
    (SCENES["circles, a rod"], [[52.0, 2.8, -2.1], [-93.0, -0.7, -3.7]]),
    # D2 w2' = lambda3 w1 + M2 = 0 at w = (2, 0, 0), the other rates vanish
    (physical((3, 2, 1), (0, 0, 1), (0, -2, 0))[0], [[2.0, 0.0, 0.0]]),
    # planes w3 = +-w1: dw3/dw1 = ((D1 - D2)/D3) w1/(((D2 - D3)/D1) w3) = w1/w3
    (physical((3, 2.5, 1), (0, 0, 0), (0, 0.5, 0))[0], [[1.0, 0.3, 1.0], [-1.5, 0.2, 1.5], [0.0, 0.4, 0.0]]),
    # a = b = 0: an equilibrium (h = 1/2, X = -2) and a pure spin; (2 - 3) 1 1 = -1: the torque is met, by
    # hand
    (scaled(0, 0, (0, 0, 1))[0], [[-2.0, 0.5, 0.0], [0.0, 0.0, 1.0]]),
    (physical((3, 2, 4), (0, 0, 0), (0, 0, -1))[0], [[1.0, 1.0, 0.0]])])
def test_spin_ups_states_at_rest_and_states_on_a_plane_stay_open_and_unwritten(one, states):
    states = np.array(states)
    assert (fate(one, states).labels != Fate.BOUNDED).any() or landscape(one).base == "hyperbola"
    boxes, periods, left = settled(one, states)
    assert (left == 3).all() and np.isnan(boxes).all() and np.isnan(periods).all()


@pytest.mark.parametrize("name", PARABOLAS)
def test_states_at_the_place_of_an_equilibrium_of_a_parabola_are_left_open_or_right(name):
    """With no rate about the axis, and with the least; elsewhere such a state is its own turning point."""
    one, land = SCENES[name], landscape(SCENES[name])
    states = states_of(name, 30)
    offsets, spots, _ = land.critical(land.start(states)[0])
    for column in range(offsets.shape[1]):
        at = states[~np.isnan(offsets[:, column])]
        at[:, land.reduction.j], at[:, land.reduction.k] = spots[:, ~np.isnan(offsets[:, column]), column]
        for least in (0.0, 1e-17):
            at[:, land.reduction.axis] = -float(land.reduction.s) + least
            assert_exact(one, at, *settled(one, at))
    states[:, land.reduction.axis] = -float(land.reduction.s)
    boxes, periods, left = settled(one, states)
    assert np.count_nonzero(left) <= 4
    assert_exact(one, states[:8], boxes, periods, left)


def test_a_barrier_of_a_parabola_that_rounding_hides_is_left_to_exact_arithmetic():
    """At a barrier, with a rate of 1e-17, doubles put the energy above it, and exact arithmetic below."""
    one = physical((0.9772121786953248, 1, 1), (-1.127222631044502, 0, 1.5683903018982321),
                   (0, 615.1464762599369, 0))[0]
    state = np.array([exactly("-0x1.036b6becc30acp-3", "-0x1.3e7b05dd99639p-57", "-0x1.1178b59885828p+9")])
    assert settled(one, state)[2][0] == 3
    box = stabilab.extremes(one, state)[0]
    # it turns there; over the barrier it would reach -466
    assert box[0, 0] == pytest.approx(state[0, 0], rel=1e-12)


@pytest.mark.one_in(2)
@pytest.mark.parametrize("number", SAMPLE)
def test_ends_in_twofold_numbers_are_those_of_balls(number):
    """Of rows that would not need them too: the first look at a box is made to fail."""
    one = drawn(number + 1)[number]
    states, land, looks = librations(one.scene, one.states(60))[:12], landscape(one.scene), []

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
        rows(states, np.array([n]), *kernel_input(land), boxes, none, left)
    assert np.count_nonzero(left == 0) >= 0.9 * len(states)
    assert_exact(one.scene, states, boxes, np.empty(len(states)), left | 2)


@pytest.mark.parametrize("y", [0.0, 1e-9, -0.3, 1.7, 25.0, -80.5, 600.0])
def test_the_exponential_of_a_double_is_known_to_twenty_seven_digits(y):
    with mp.workdps(60):
        found, exact = rows_kernel.exponential(y), mp.exp(mp.mpf(y))
        assert abs(mp.mpf(float(found[0])) + mp.mpf(float(found[1])) - exact) <= mp.mpf(10) ** -27 * exact


def test_without_numba_plain_python_serves(monkeypatch):
    monkeypatch.setattr(numba_door, "find_spec", lambda name: None)
    numba_door.installed.cache_clear()
    monkeypatch.setattr(rows_numba, "COLD", 1)
    monkeypatch.setattr(rows_numba, "_compiled", lambda base: pytest.fail("compiled without numba"))
    one, states = FAMILIES["minor scaled +"][0], sample("minor scaled +", 5)
    try:
        assert np.isfinite(stabilab.extremes(one, states, fast=True)).any()
    finally:
        numba_door.installed.cache_clear()


def test_a_torque_along_an_axis_of_symmetry_has_no_equilibria():
    one, _ = physical((5.526899912556323, 10.679241384490718, 5.526899912556323), (0, 0, 0),
                      (0, -358.8648632605358, 0))
    found = stabilab.extremes(one, np.array([[3.0, 2.0, 4.0]] * 3))
    # the circle of radius 5; omega2 falls steadily
    np.testing.assert_allclose(found, [[[-5, 5], [-np.inf, 2], [-5, 5]]] * 3, rtol=1e-14)
    assert np.isinf(stabilab.period(one, np.array([[3.0, 2.0, 4.0]]))).all()


@pytest.mark.slow  # compiling takes half a minute where no cache is
@pytest.mark.parametrize("name", ["circles, minor axis", "hyperbolas", "parabolas, a disc"])
def test_compiled_rows_are_those_of_plain_python(name):
    pytest.importorskip("numba")
    states = states_of(name, 40)
    (boxes, periods, left), (others, times,
                             open_) = (settled(SCENES[name], states, by_numba) for by_numba in (False, True))
    np.testing.assert_array_equal(left, open_)
    np.testing.assert_allclose(periods, times, rtol=1e-12)
    np.testing.assert_allclose(boxes, others, rtol=0, atol=1e-13 * np.abs(boxes).max())


def test_rows_on_parabolas_promise_the_same_digits():
    assert (parabola_kernel.DIGITS,
            parabola_kernel.PERIOD_DIGITS) == (rows_kernel.DIGITS, rows_kernel.PERIOD_DIGITS)
