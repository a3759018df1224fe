"""The compiled kernel for extremes and periods against the arrays' path and ball arithmetic. Nothing looks at the clock."""
import subprocess
import sys

import numpy as np
import pytest

import stabilab
from benchmarks.random_scenes import drawn
from stabilab import Fate
from stabilab.errors import InputError
from stabilab.numbers import numba_door
from stabilab.orbit.ball_orbit import Orbit
from stabilab.orbit.extremes import circle_kernel, hyperbola_kernel, hyperbola_numba
from stabilab.orbit.extremes import circle_numba as fast_extremes
from stabilab.orbit.extremes.balls import precise_extremes
from stabilab.orbit.extremes_and_periods import extremes_and_periods
from stabilab.orbit.landscape import landscape
from stabilab.orbit.period.balls import precise_period
from tests.oracles import energy
from tests.oracles.pairs import brink, exactly, physical, scaled
from tests.orbit.extremes.test_extremes import assert_extremes
from tests.orbit.fate.test_fate import FAMILIES, sample

BODY = (2000, 1500, 1000)
pytestmark = pytest.mark.filterwarnings("ignore:invalid value")  # inf - inf of spin-ups, masked where it occurs


def scenes():
    """Circles about the minor and the major axis, both signs of the torque, every perpendicular gyrostat, without torque."""
    found = {name: pair[0] for name, pair in FAMILIES.items() if landscape(pair[0]) is not None}
    for sign in (-1, 1):
        for axis, gyrostats in ((2, [(100, 0, 0), (0, -80, 0), (60, 90, 0), (0, 0, 0)]), (0, [(0, 70, 0), (0, 50, -90)])):
            for gyrostat in gyrostats:
                torque = np.zeros(3)
                torque[axis] = 200.0 * sign
                found[f"axis {axis + 1}, torque {sign:+d}, gyrostat {gyrostat}"] = physical(BODY, gyrostat, tuple(torque))[0]
    found["no torque"] = physical(BODY, (100, 0, 0), (0, 0, 0))[0]
    return found


SCENES = scenes()
WITH_KERNEL = [name for name, scene in SCENES.items() if fast_extremes.kernel_input(landscape(scene)) is not None]
every_kernel_scene = pytest.mark.parametrize("name", WITH_KERNEL)


def states_of(scene, count, seed=5):
    size = 3.0 if scene.variables == "scaled" else 1.0
    return np.random.default_rng(seed).uniform(-size, size, (count, 3))


def plain(scene, states, wanted=3):
    """The kernel as plain Python: (boxes, periods, bits left open)."""
    boxes, periods = np.full((len(states), 3, 2), np.nan), np.full(len(states), np.nan)
    with np.errstate(all="ignore"):
        left = fast_extremes.run_kernel(circle_kernel.orbits, landscape(scene), states, wanted, boxes, periods)
    return boxes, periods, left


def assert_same(scene, states, boxes, periods, left, off=2e-12):
    """Against the arrays' path, to 2e-12 of each component and of the period: both leave what is worse than 1e-12 and
    1e-11 to ball arithmetic."""
    exact, times = extremes_and_periods(scene, states, fast=False)
    known, timed = (left & 1) == 0, (left & 2) == 0
    finite = np.isfinite(exact[known])
    np.testing.assert_array_equal(np.where(finite, 0, boxes[known]), np.where(finite, 0, exact[known]))
    size = np.abs(np.where(finite, exact[known], 0)).max(axis=2, keepdims=True)
    assert np.all(np.abs(np.where(finite, boxes[known] - exact[known], 0)) <= off * size)
    np.testing.assert_allclose(periods[timed], times[timed], rtol=1e-11)


def test_scenes_on_circles_have_a_kernel_and_others_keep_their_path():
    assert len(WITH_KERNEL) >= 10
    middle = FAMILIES["middle scaled +"][0]
    assert fast_extremes.kernel_input(landscape(middle)) is None
    states = sample("middle scaled +", 5)
    np.testing.assert_array_equal(stabilab.extremes(middle, states, fast=None), stabilab.extremes(middle, states, fast=False))


@every_kernel_scene
def test_the_kernel_agrees_with_the_arrays(name):
    scene = SCENES[name]
    states = states_of(scene, 24)
    boxes, periods, left = plain(scene, states)
    assert_same(scene, states, boxes, periods, left)


def test_the_kernel_settles_nearly_every_random_orbit_with_torque():
    for name in WITH_KERNEL:
        scene = SCENES[name]
        if landscape(scene).sense:
            assert np.mean(plain(scene, states_of(scene, 40))[2] == 0) > 0.9, name


@pytest.mark.parametrize("scale", [1e-6, 1e-3, 1e3, 1e6])
def test_scaling_the_scene_scales_the_kernels_answers(scale):
    """omega, lambda ~ s and M ~ s^2 leave D omega' = (D omega + lambda) x omega + M as it is in the time t/s."""
    scene = physical(BODY, (100, 0, 0), (0, 0, 200.0))[0]
    twin = physical(BODY, (100 * scale, 0, 0), (0, 0, 200.0 * scale * scale))[0]
    states = states_of(scene, 24)
    boxes, periods, left = plain(scene, states)
    other, times, open_ = plain(twin, states * scale)
    same = (left == 0) & (open_ == 0)
    assert same.sum() > 15
    size = np.abs(np.where(np.isfinite(boxes[same]), boxes[same], 0)).max(axis=2, keepdims=True)
    finite = np.isfinite(boxes[same])
    assert np.all(np.abs(np.where(finite, other[same] / scale - boxes[same], 0)) <= 2e-12 * size)
    np.testing.assert_allclose(times[same] * scale, periods[same], rtol=1e-11)


@pytest.mark.parametrize("name", ["minor scaled +", "minor physical", "major physical"])
@pytest.mark.parametrize("decades", [3, 5, 6, 7, 9, 12, 15])
@pytest.mark.parametrize("side", [-1, 1])
def test_next_to_the_separatrix_the_kernel_keeps_its_digits_or_lets_go(name, decades, side):
    """Ball arithmetic shares neither the root finding nor the sum over nodes."""
    scene, problem = FAMILIES[name]
    land, rng, found = landscape(scene), np.random.default_rng(11), 0
    while found < 2:
        state = brink(problem, rng.normal(size=2) * 2, side * 10.0**-decades)
        if state is None:
            continue
        found += 1
        state = np.array(state, float)
        label = int(stabilab.fate(scene, state).labels)
        boxes, periods, left = plain(scene, state[None])
        if decades >= 9:
            assert left[0] & 1
        if not left[0] & 1:
            exact = precise_extremes(Orbit(land.reduction, state), label)
            np.testing.assert_array_equal(np.isinf(boxes[0]), np.isinf(exact))
            finite = np.isfinite(exact)
            size = np.abs(np.where(finite, exact, 0)).max(axis=1, keepdims=True)
            assert np.all(np.abs(np.where(finite, boxes[0] - exact, 0)) <= 2e-12 * size)
        if not left[0] & 2:
            assert periods[0] == pytest.approx(precise_period(Orbit(land.reduction, state), label), rel=1e-11)


@pytest.mark.parametrize("number", [7, 24, 91])
def test_a_piece_of_the_conic_that_turns_a_corner_on_the_way_to_its_fold_is_met_beyond_the_corner_and_before(number):
    """Of the random scenes of the benchmarks: a conic that is nearly its asymptotes, whose crossing lies off the circles' centre. The arrays' search is held in
    a bracket along the whole piece."""
    one = drawn(number + 1)[number]
    states = one.states(400)
    states = states[stabilab.fate(one.scene, states).labels == Fate.BOUNDED][:200]
    boxes, _, left = plain(one.scene, states)
    known = (left & 1) == 0
    assert known.mean() > 0.6
    exact = stabilab.extremes(one.scene, states[known], fast=False)
    assert np.all(np.abs(boxes[known] - exact).max(axis=2) <= 2e-12 * np.abs(exact).max(axis=2))


def test_a_turning_point_found_by_a_last_step_of_1e_5_keeps_the_period():
    """Halley's steps end 1e-10 away from the end on the left; ball arithmetic."""
    one, state = drawn(24)[23].scene, np.array([0.062022077246017424, -2.40730533121281, 1.7694966114961876])
    _, periods, left = plain(one, state[None])
    exact = precise_period(Orbit(landscape(one).reduction, state), Fate.BOUNDED)
    assert left[0] & 2 or periods[0] == pytest.approx(exact, rel=1e-11)


@pytest.mark.parametrize("number", [33, 39])
def test_rows_that_take_more_than_128_nodes_have_the_period_of_balls(number, monkeypatch):
    """Next to a separatrix; on a circle and on a hyperbola."""
    one = drawn(number + 1)[number]
    door, loops = ((fast_extremes, circle_kernel), (hyperbola_numba, hyperbola_kernel))[landscape(one.scene).e > 0]
    states = one.states(1200)
    states = states[stabilab.fate(one.scene, states).labels == Fate.BOUNDED][:300]
    periods, coarse, none = np.empty(len(states)), np.empty(len(states)), np.empty((0, 3, 2))
    with np.errstate(all="ignore"):
        left = door.run_kernel(loops.orbits, landscape(one.scene), states, 2, none, periods)
        monkeypatch.setattr(door, "LANE_NODES", circle_kernel.NODES)
        before = door.run_kernel(loops.orbits, landscape(one.scene), states, 2, none, coarse)
    more = np.nonzero((before > 0) & (left == 0))[0]
    np.testing.assert_array_equal(periods[before == 0], coarse[before == 0])
    assert len(more) >= 3 and not ((before == 0) & (left > 0)).any()
    exact = [precise_period(Orbit(landscape(one.scene).reduction, states[n]), Fate.BOUNDED) for n in more]
    np.testing.assert_allclose(periods[more], exact, rtol=1e-11)


def test_a_root_of_the_energy_difference_in_theta_loses_half_of_the_digits_next_to_the_separatrix():
    """The turning point merges with the saddle, where V is flat: bisection on E - V(theta), subtracted, against balls.
    The arrays' path solves from the saddle instead, in the distance from it."""
    from stabilab.orbit.fate.arrays import circle_margins
    scene, problem = FAMILIES["minor scaled +"]
    land, rng, worst = landscape(scene), np.random.default_rng(3), 0.0
    for _ in range(6):
        state = brink(problem, rng.normal(size=2) * 2, -1e-13)
        if state is None or stabilab.fate(scene, np.array(state)).labels != Fate.BOUNDED:
            continue
        state = np.array(state, float)
        place, w, size = land.start(state[None])
        pot, (x, z) = land.potential, (float(place[0][0]), float(place[1][0]))
        offset, _, barrier = land.critical(place, True)
        margins, _ = circle_margins(land, place, w, size)
        ahead = float(np.nanmin(np.where(barrier, offset, np.nan)))

        def height(y):
            X, Z = x * np.cos(y) + z * np.sin(y), z * np.cos(y) - x * np.sin(y)
            return -pot.mu * y - pot.G * X * X / 2 - pot.c * X + pot.d * Z
        energy, low, high = float(w[0]) ** 2 / 2 + height(0.0), 0.0, ahead
        for _ in range(100):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if height(middle) < energy else (low, middle)
        X, Z = x * np.cos(low) + z * np.sin(low), z * np.cos(low) - x * np.sin(low)
        naive = land.components((np.array([X]), np.array([Z])), np.zeros(1))[0]
        exact, got = precise_extremes(Orbit(land.reduction, state), 0), stabilab.extremes(scene, state)
        j, k = land.reduction.j, land.reduction.k
        off = min(np.abs(exact[a] - naive[a]).min() for a in (j, k))
        assert np.abs(got - exact).max() < 1e-12 * np.abs(exact).max()
        worst = max(worst, off)
    assert 1e-11 < worst < 1e-4


def test_fates_show_in_the_extremes_exactly():
    """Bounded motions have finite extremes, spin-ups an infinite one; the kernel decides none that rounding could turn."""
    scene, problem = FAMILIES["minor scaled +"]
    states = sample("minor scaled +", 60)
    boxes, periods, left = plain(scene, states)
    labels = stabilab.fate(scene, states).labels
    known = left == 0
    np.testing.assert_array_equal(np.isinf(boxes[known]).any(axis=(1, 2)), labels[known] == Fate.SPIN_UP)
    np.testing.assert_array_equal(np.isinf(periods[known]), labels[known] == Fate.SPIN_UP)


def test_states_that_doubles_cannot_settle_are_left_open():
    """a = b = 0: an equilibrium (h = 1/2, X = -2), pure spin (no angle), a minute orbit about the equilibrium."""
    scene, _ = scaled(0, 0, (0, 0, 1))
    states = np.array([[-2.0, 0.5, 0.0], [0.0, 0.0, 1.0], [-2.0, 0.5, 1e-15]])
    assert np.all(plain(scene, states)[2] & 1)


@pytest.mark.parametrize("pair, state", [
    (physical((3, 2, 1), (3, 0, 0), (0, 0, -1)), (0, -3, 4)), (physical((2, 3, 1), (1, 0, 0), (0, -0.25, 0)), (0, 0, 2)),
    (physical((1, 2, 3), (-1, -1, 0), (0, 0, 0.25)), (-1.5, 1.5, -0.5)), (scaled(-1.0, -3.0, (0, 0, 0)), (0.5, 2, 0))])
def test_a_turning_point_that_is_not_yet_found_leaves_the_period_open(pair, state):
    """Halley's steps end 5e-10 to 2e-8 from it, and the period was off by as much as 4e-9."""
    scene, problem = pair
    true = float(energy.period(problem, tuple(map(float, state))))
    _, periods, left = plain(scene, np.array([state], float))
    assert left[0] & 2 or abs(periods[0] / true - 1) < 1e-11
    assert abs(extremes_and_periods(scene, np.array([state], float), fast=False)[1][0] / true - 1) < 1e-13


def test_the_search_for_a_turning_point_does_not_end_on_a_barrier():
    """The well is so flat that the first guess lay beyond the barrier, where Halley's step is 0: the least rate about axis 2 was -5.83 for -3.03."""
    scene, problem = physical((2, 3, 4), (0, 2, 0), (0, 0, 0))
    boxes, _, left = plain(scene, np.array([(4.0, 0, 2)]))
    assert not left[0] & 1
    assert_extremes(boxes[0], energy.extremes(problem, (4.0, 0.0, 2.0)), 1e-12)


@pytest.mark.parametrize("scene, state", [
    (physical((3, 2, 4), (0, 0, 0), (0, 0, -1))[0], (1, 1, 0)),  # (2 - 3) 1 1 = -1: the torque is met, by hand
    (physical((2, 1.5, 1), (0, -2, 0), (0, 0, 0))[0], (0, 4, 3))])  # D omega + lambda = (0, 4, 3) = omega
def test_a_state_at_rest_is_left_open(scene, state):
    """Its period is 0; the compiled kernel gave that of small oscillations about it."""
    assert plain(scene, np.array([state], float))[2][0] == 3 and stabilab.period(scene, np.array([state, state]))[0] == 0


def test_extremes_and_periods_in_one_go_equal_each_alone():
    scene = FAMILIES["minor scaled +"][0]
    states = sample("minor scaled +", 30)
    boxes, periods = extremes_and_periods(scene, states, fast=False)
    np.testing.assert_array_equal(boxes, stabilab.extremes(scene, states, fast=False))
    np.testing.assert_array_equal(periods, stabilab.period(scene, states, fast=False))


def test_turning_points_take_few_rounds(monkeypatch):
    """Counted: a first guess from a cosine between well and barrier, and roots that stay found."""
    from stabilab.orbit.extremes import turning_points as turning
    rounds, solve = [], turning.bracketed_newton

    def counting(fun, *args, **kwargs):
        rounds.append(0)

        def counted(*inner):
            rounds[-1] += 1
            return fun(*inner)
        return solve(counted, *args, **kwargs)
    monkeypatch.setattr(turning, "bracketed_newton", counting)
    stabilab.extremes(FAMILIES["minor scaled +"][0], sample("minor scaled +", 500), fast=False)
    assert rounds and max(rounds) <= 12


def test_small_arrays_never_load_numba():
    code = ("import sys, numpy as np\nfrom benchmarks.rows import SCENE, random_states\n"
            "from stabilab import extremes, period\nextremes(SCENE, random_states(1000)); period(SCENE, random_states(100))\n"
            "sys.exit('numba' in sys.modules)")
    assert subprocess.run([sys.executable, "-c", code]).returncode == 0


def test_without_numba_fast_is_refused_and_none_takes_the_arrays(monkeypatch):
    monkeypatch.setattr(numba_door, "installed", lambda: False)
    scene, states = FAMILIES["minor scaled +"][0], sample("minor scaled +", 5)
    with pytest.raises(InputError, match="stabilab\\[fast\\]"):
        stabilab.extremes(scene, states, fast=True)
    monkeypatch.setattr(fast_extremes, "COLD", 1)
    assert np.isfinite(stabilab.extremes(scene, states)).any()


@pytest.mark.slow  # compiling takes half a minute where no cache is
def test_the_compiled_kernel_equals_its_plain_python():
    pytest.importorskip("numba")
    for name in WITH_KERNEL[:4]:
        scene = SCENES[name]
        states = states_of(scene, 300)
        boxes, periods, left = plain(scene, states[:30])
        compiled = np.empty((300, 3, 2)), np.empty(300)
        bits = fast_extremes.by_kernel(landscape(scene), states, *compiled, fast=True)
        np.testing.assert_array_equal(bits[:30], left)
        assert_same(scene, states, *compiled, bits)
        known = left == 0
        np.testing.assert_allclose(compiled[1][:30][known], periods[known], rtol=1e-12)


def test_equilibria_between_two_folds_have_no_kernel_and_the_same_extremes(kernels):
    """Asked for the fast way, rows that this kernel does not serve go to that of twofold numbers."""
    scene, problem = physical((1.28, 2.85, 1.98), (5.59, 0, -1.92), (0, 14.32, 0))
    assert len(landscape(scene).conic.folds) == 4 and fast_extremes.kernel_input(landscape(scene)) is None
    states = np.random.default_rng(1).normal(size=(12, 3)) * 3
    found = stabilab.extremes(scene, states, fast=True)
    for n, state in enumerate(states.tolist()):
        assert_extremes(found[n], energy.extremes(problem, state), 1e-11)


def test_the_kernel_serves_circles_without_a_fold(kernels):
    """Moment along both equal axes, D1 = D3, torque about the other: an empty tuple of folds, over which numba refused to loop."""
    scene, problem = physical((31.654399378285476, 0.063245553203366, 31.654399378285476), (-100, 0, -100), (0, -1000, 0))
    state = exactly("0x1.96c946803cb76p+1", "-0x1.9c092949740b8p-7", "0x1.952d3d56f3435p+1")
    assert_extremes(stabilab.extremes(scene, np.array(state), fast=True), energy.extremes(problem, state), 1e-11)


def test_a_torque_along_an_axis_of_symmetry_needs_no_kernel():
    """No equilibria, an empty tuple of pieces: numba refused it with a traceback."""
    pytest.importorskip("numba")
    scene, _ = physical((5.526899912556323, 10.679241384490718, 5.526899912556323), (0, 0, 0), (0, -358.8648632605358, 0))
    found = stabilab.extremes(scene, np.array([[3.0, 2.0, 4.0]] * 3), fast=True)
    np.testing.assert_allclose(found, [[[-5, 5], [-np.inf, 2], [-5, 5]]] * 3, rtol=1e-14)  # the circle of radius 5; omega2 falls steadily
    assert np.isinf(stabilab.period(scene, np.array([[3.0, 2.0, 4.0]]), fast=True)).all()


def test_a_well_beside_which_the_force_bends_sharply_is_found_to_rounding_or_left_open():
    """Two moments equal to 6e-4 and a circle of some hundreds of its well's width: two steps of Newton's method leave 1e-9 there; against balls."""
    scene, _ = physical((4.845, 4.842, 3.945), (0, -0.849, 0.291), (1.0328, 0, 0))
    land, state = landscape(scene), (0.08901751458670247, -1.249736256580412, -0.1355491972910896)
    box, period = np.empty((1, 3, 2)), np.empty(1)
    left_open = fast_extremes.run_kernel(circle_kernel.orbits, land, np.array([state]), circle_kernel.BOX | circle_kernel.PERIOD, box, period)
    exact = np.array(precise_extremes(Orbit(land.reduction, state), Fate.BOUNDED), float)
    assert left_open[0] & circle_kernel.BOX or (np.abs(box[0] - exact) <= 1e-11 * np.abs(exact).max(axis=1, keepdims=True)).all()
