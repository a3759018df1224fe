"""The compiled kernel for lanes on hyperbolas, as plain Python, against ball arithmetic. Nothing looks at the clock."""
import itertools

import mpmath as mp
import numpy as np
import pytest

from benchmarks.random_scenes import drawn
from stabilab import Fate, extremes, fate, period
from stabilab.orbit.ball_orbit import Orbit
from stabilab.orbit.extremes import circle_kernel, hyperbola_kernel, hyperbola_numba
from stabilab.orbit.extremes.balls import precise_extremes
from stabilab.orbit.extremes.hyperbola_numba import kernel_input, run_kernel
from stabilab.orbit.fine import rows_kernel
from stabilab.orbit.landscape import landscape
from stabilab.orbit.period.balls import precise_period
from tests.orbit.fine.test_fine import HYPERBOLAS, scene, states_of
from tests.orbit.fine.test_fine import SCENES as NEAR
from tests.orbit.test_batches_of_random_scenes import beside_and_anywhere

# of the sample of random scenes: one well and two, nearly equal moments, a rod, equilibria next to folds
SAMPLE = (1, 10, 28, 39, 40, 65, 82, 114)


def plain(one, states, wanted=3):
    """(boxes, periods, bits left open) of the kernel as plain Python; NaN where it was not asked to write."""
    boxes, periods = np.full((len(states), 3, 2), np.nan), np.full(len(states), np.nan)
    with np.errstate(all="ignore"):
        left = run_kernel(hyperbola_kernel.orbits, landscape(one), states, wanted, boxes, periods)
    return boxes, periods, left


def bounded(one, states):
    return states[fate(one, states).labels == Fate.BOUNDED]


def assert_exact(one, states, boxes, periods, left):
    """Against balls, what the kernel settled."""
    for state, box, time, bits in zip(states, boxes, periods, left):
        orbit = Orbit(landscape(one).reduction, state)
        if not bits & 1:
            exact = np.array(precise_extremes(orbit, Fate.BOUNDED), float)
            assert (np.abs(box - exact).max(axis=1) <= 1e-12 * np.abs(exact).max(axis=1)).all(), state.tolist()
        if not bits & 2:
            assert time == pytest.approx(precise_period(orbit, Fate.BOUNDED), rel=1e-11), state.tolist()


@pytest.mark.parametrize("number", SAMPLE)
def test_rows_of_random_scenes_are_settled_and_have_the_extremes_and_periods_of_balls(number):
    one = drawn(number + 1)[number]
    states = bounded(one.scene, one.states(200))[:60]
    boxes, periods, left = plain(one.scene, states)
    assert (left == 0).mean() > 0.85
    assert_exact(one.scene, states[:12], boxes, periods, left)


@pytest.mark.parametrize("name", HYPERBOLAS)
def test_rows_of_nearly_equal_moments_are_settled_and_have_the_extremes_and_periods_of_balls(name):
    """The centre of the orbits stands ten to a thousand times as far off as the states, and equilibria are differences of terms as large."""
    one, states = NEAR[name], states_of(name, 200, label=Fate.BOUNDED)[:60]
    boxes, periods, left = plain(one, states)
    assert (left == 0).mean() > 0.85
    assert_exact(one, states[:12], boxes, periods, left)


@pytest.mark.parametrize("number", [13, 28, 39, 82])
def test_rows_next_to_a_separatrix_have_the_extremes_and_periods_of_balls_or_stay_open(number):
    """Rates that just reach their barrier, off by 1e-3 to 1e-12 of themselves: nearer ones are left to the rows in twofold numbers."""
    one = drawn(number + 1)[number]
    states = bounded(one.scene, beside_and_anywhere(one, 96)[::2])[:24]
    boxes, periods, left = plain(one.scene, states)
    assert ((left & 2) > 0).any() and (left == 0).any()
    assert_exact(one.scene, states, boxes, periods, left)


@pytest.mark.parametrize("number", [13, 28, 82])
def test_rows_that_reach_their_barrier_to_rounding_stay_open(number):
    """The rate with which a barrier is just reached, and its neighbours among doubles."""
    one = drawn(number + 1)[number]
    states, axis = one.states(60), next(i for i in range(3) if one.torque[i])
    states[:, axis] = 0.0
    height = fate(one.scene, states).margins
    known = np.isfinite(height) & (height > 0)
    rates = np.sqrt(2 * height[known] / one.moments[axis])[:, None] * (1 + np.arange(-2, 3) * 2.0**-52)
    states = np.repeat(states[known], 5, axis=0)
    states[:, axis] = rates.ravel()
    assert len(states) >= 20 and (plain(one.scene, states)[2] == 3).all()


@pytest.mark.parametrize("decades", [2, 4, 6, 8, 10, 12])
@pytest.mark.parametrize("number", [1, 31, 82])
def test_small_motions_about_a_well_have_the_extremes_and_periods_of_balls_or_stay_open(number, decades):
    """So many decades smaller than the rates: of these the ends are known, but not their distance."""
    one = drawn(number + 1)[number]
    lane, spots, _ = looked_up(one.scene, one.states(8))
    xi, q = spots[hyperbola_kernel.LEFT, hyperbola_kernel.AT_XI, :8] * np.sign(lane[0, :8]), lane[hyperbola_kernel.XI, :8] * lane[hyperbola_kernel.ETA, :8]
    land = landscape(one.scene)
    for _ in range(60):  # the well on each orbit
        c, d, G, mu = kernel_input(land)[3][:4]
        parts = np.array([mu + 0 * xi, 0.5 * (c + d) * xi, 0.5 * (d - c) * q / xi, 0.25 * G * xi**2, 0.25 * G * (q / xi) ** 2])
        xi = xi * np.exp(np.clip(-(parts[:4].sum(axis=0) - parts[4]) / (parts[1] - parts[2] + 2 * (parts[3] + parts[4])), -0.1, 0.1))
    states = bounded(one.scene, land.components((xi * (1 + 10.0**-decades), q / xi / (1 + 10.0**-decades)), np.full(8, 10.0**-decades)))
    assert len(states)
    boxes, periods, left = plain(one.scene, states)
    if decades <= 2:
        assert not left.any()
    assert_exact(one.scene, states, boxes, periods, left)


def looked_up(one, states):
    """(lanes, equilibria as looked up, whether there is a barrier) of the kernel's first steps."""
    fine, form, axes, numbers, _, *own = kernel_input(landscape(one))
    lane, spots, three = np.zeros((13, 256)), np.zeros((3, 12, 256)), np.zeros(256)
    with np.errstate(all="ignore"):
        hyperbola_kernel.orbit_rows(len(states), states, fine, form, axes, numbers, lane)
        hyperbola_kernel.looked_up(len(states), lane, *own, spots, three)
    return lane, spots, three


def test_states_at_rest_stay_open():
    """D2 w2' = lambda3 w1 + M2 = 0 at w = (-M2/lambda3, 0, 0), where the other rates vanish."""
    for wheel in (1.0, 3.0, 0.7, -5.0):
        for rate in (2.0, 0.5, 0.3, -7.0):
            if (wheel * rate) / wheel == rate:
                assert (plain(scene((3, 2, 1), (0, 0, wheel), 1, -wheel * rate), np.array([[rate, 0.0, 0.0]]))[2] == 3).all()


def test_states_on_an_invariant_plane_and_next_to_one_stay_open():
    """Planes of D = (3, 2.5, 1) without a wheel: w3 = +-w1, for dw3/dw1 = ((D1 - D2)/D3) w1/(((D2 - D3)/D1) w3) = w1/w3. Of D = (3, 2, 1) they are
    w3 = +-sqrt(3) w1, which pairs of doubles of 1e8 miss by as little as 1e-13."""
    states = [[1.0, 0.3, 1.0], [-1.5, 0.2, 1.5], [0.0, 0.4, 0.0], [1.0, 0.3, 1 + 2.0**-52]]
    assert (plain(scene((3, 2.5, 1), (0, 0, 0), 1, 0.5), np.array(states))[2] == 3).all()
    first = 1e8 + np.arange(200000.0)
    with mp.workdps(50):
        near = np.rint(first * 3**0.5 * 2.0**20) / 2.0**20
        off = [abs(mp.mpf(b) - mp.sqrt(3) * mp.mpf(a)) for a, b in zip(first[::20], near[::20])]
    at = 20 * int(np.argmin([float(v) for v in off]))
    state = np.array([[first[at], 0.3, near[at]]])
    assert float(min(off)) / state[0, 0] < 1e-18
    assert (plain(scene((3, 2, 1), (0, 0, 0), 1, 0.5), state)[2] == 3).all()


@pytest.mark.parametrize("wrong", ["far away", "a barrier for the wells"])
def test_a_first_guess_that_leads_elsewhere_leaves_a_row_open(wrong, monkeypatch):
    one = drawn(29)[28]
    states = bounded(one.scene, beside_and_anywhere(one, 200))[:100]
    given = list(kernel_input(landscape(one.scene)))
    for table in (5, 8):
        given[table] = given[table].copy()
        if wrong == "far away":
            given[table][..., 1:7] *= 1e4
        else:
            some = given[table][..., 0] == 3
            for well, near in ((1, 1 - 1e-4), (3, 1 + 1e-4)):
                given[table][some, well], given[table][some, well + 3] = given[table][some, 2] * near, given[table][some, 5] * near
    monkeypatch.setattr(hyperbola_numba, "kernel_input", lambda land: given)
    boxes, periods, left = plain(one.scene, states)
    assert left.any()
    rows = np.nonzero(left < 3)[0][:20]
    assert_exact(one.scene, states[rows], boxes[rows], periods[rows], left[rows])


def test_an_end_e_to_the_eleventh_from_the_equilibrium_that_tells_it_keeps_its_digits():
    """t at the state is 1.7e-5: formed as 1 + (t - 1), it lost five digits of the extremes."""
    one, state = drawn(2)[1].scene, np.array([[18.42036219, -4.97608147, 5.74449751]])
    boxes, periods, left = plain(one, state)
    assert left[0] == 0
    assert_exact(one, state, boxes, periods, left)


def test_a_motion_over_a_slope_before_its_wall_has_its_end_found_in_a_bracket(monkeypatch):
    """A shallow well far from the wall: from the guess at either, Halley's steps do not arrive."""
    one = drawn(11)[10]
    states, calls, search = bounded(one.scene, one.states(100))[:40], [], hyperbola_kernel.searched
    monkeypatch.setattr(hyperbola_kernel, "searched", lambda *asked: calls.append(0) or search(*asked))
    boxes, periods, left = plain(one.scene, states)
    assert calls and not left.any()
    assert_exact(one.scene, states[:15], boxes, periods, left)


def test_an_end_that_is_not_found_leaves_a_row_open(monkeypatch):
    one = drawn(11)[10]
    states = bounded(one.scene, one.states(100))[:40]
    monkeypatch.setattr(hyperbola_kernel, "searched", lambda *asked: 1.0)
    boxes, periods, left = plain(one.scene, states)
    assert (left == 3).any()
    assert_exact(one.scene, states, boxes, periods, left)


def test_an_interval_of_the_table_with_folds_inside_has_no_equilibria(number=97):
    """Though there may be as many at either end: one between two folds has two more, or two fewer."""
    conic, told = landscape(drawn(number + 1)[number].scene).conic, 0
    for sign in (-1, 1):
        folds = sorted(abs(fold) for fold in conic.fold_invariants if fold * sign > 0)
        for low, high in itertools.combinations(folds, 2):
            cells = np.zeros((4, 1, hyperbola_kernel.COLUMNS))
            with np.errstate(all="ignore"):
                hyperbola_numba.fill(conic, sign, np.array([low * (1 - 1e-6), high * (1 + 1e-6)]), np.array(folds), cells)
                assert not cells.any()
                hyperbola_numba.fill(conic, sign, np.array([low * (1 - 1e-6), high * (1 + 1e-6)]), np.zeros(0), cells)
            told += cells[..., 0].any()
    assert told


@pytest.mark.parametrize("number", [1, 39, 82])
def test_the_table_has_as_many_equilibria_of_each_orbit_as_there_are(number):
    """Beside folds, on either side, as far from them as 1e-2 to 1e-9 of their invariant: the real roots, with the sign of xi, of the force times xi^2, in
    forty digits; where the table says nothing the row stays open."""
    land = landscape(drawn(number + 1)[number].scene)
    _, _, _, numbers, _, *tables = kernel_input(land)
    lane, spots, three = np.zeros((13, 256)), np.zeros((3, 12, 256)), np.zeros(256)
    rng, seen, told, folds = np.random.default_rng(number), [], 0, sorted(land.conic.fold_invariants)
    sides = [fold * (1 + sign * 10.0**-n) for fold in folds for sign in (-1, 1) for n in (2, 4, 7, 9)] + [0.5 * (a + b) for a, b in zip(folds, folds[1:])]
    anywhere = rng.choice((-1, 1), 20) * numbers[5] ** 2 * 10.0 ** rng.uniform(-3, 3, 20)
    for Q, side in [(Q, side) for Q in (*sides, *anywhere) for side in (-1, 1)]:
        xi = side * abs(Q) ** 0.5 * np.exp(rng.normal())
        lane[hyperbola_kernel.XI, len(seen)], lane[hyperbola_kernel.ETA, len(seen)] = xi, -Q / xi
        seen.append((xi, -Q))
    with np.errstate(all="ignore"):
        hyperbola_kernel.looked_up(len(seen), lane, *tables, spots, three)
    c, d, G, mu = (mp.mpf(v) for v in numbers[:4])
    with mp.workdps(40):
        for n, (xi, q) in enumerate(seen):
            if lane[hyperbola_kernel.UNCLEAR, n] == 0:
                roots = mp.polyroots([G / 4, (c + d) / 2, mu, (d - c) / 2 * mp.mpf(q), -G / 4 * mp.mpf(q) ** 2], maxsteps=400, extraprec=400)
                there = [r for r in roots if abs(mp.im(r)) < 1e-15 * abs(r) and mp.re(r) * xi > 0]
                assert len(there) == (3 if three[n] else 1), (seen[n], there)
                told += 1
    assert told > 0.8 * len(seen)


def test_any_split_of_the_rows_gives_the_same_bytes():
    one = drawn(40)[39]
    states = bounded(one.scene, one.states(500))[:270]  # more than a block
    whole = plain(one.scene, states)
    for cuts in ((1, 100), (255, 257)):
        parts = [plain(one.scene, part) for part in np.split(states, cuts)]
        for column, pieces in zip(whole, zip(*parts)):
            settled = (whole[2] if column.ndim < 3 else np.repeat(whole[2], 6).reshape(column.shape)) == 0
            np.testing.assert_array_equal(np.where(settled, np.concatenate(pieces), 0), np.where(settled, column, 0))
        np.testing.assert_array_equal(np.concatenate([part[2] for part in parts]), whole[2])


def test_either_question_alone_has_the_answers_of_both():
    one = drawn(29)[28]
    states = bounded(one.scene, one.states(100))[:30]
    boxes, periods, left = plain(one.scene, states)
    with np.errstate(all="ignore"):
        alone, times = np.full((30, 3, 2), np.nan), np.full(30, np.nan)
        first = run_kernel(hyperbola_kernel.orbits, landscape(one.scene), states, 1, alone, np.empty(0))
        second = run_kernel(hyperbola_kernel.orbits, landscape(one.scene), states, 2, np.empty((0, 3, 2)), times)
    np.testing.assert_array_equal(first | second, left)
    np.testing.assert_array_equal(alone[left == 0], boxes[left == 0])
    np.testing.assert_array_equal(times[left == 0], periods[left == 0])


def test_the_copies_are_those_of_the_other_kernels():
    rng = np.random.default_rng(2)
    for _ in range(50):
        a, b = ((float(v), float(v * 1e-17 * rng.normal())) for v in rng.normal(size=2) * 10.0 ** rng.integers(-5, 5, 2))
        for name, asked in (("exact_sum", (a[0], b[0])), ("exact_product", (a[0], b[0])), ("add", (a, b)), ("times", (a, b))):
            assert getattr(hyperbola_kernel, name)(*asked) == getattr(rows_kernel, name)(*asked)
        changes = 1.0, *10.0 ** -rng.uniform(2, 16, 3)
        assert hyperbola_kernel.converged(*changes) == circle_kernel.converged(*changes)
    for name in ("EPS", "DIGITS", "PERIOD_DIGITS", "ENOUGH", "SETTLED", "FLOOR"):
        assert getattr(hyperbola_kernel, name) == getattr(circle_kernel, name)
    assert (hyperbola_kernel.CLEAR, hyperbola_kernel.FINE) == (rows_kernel.CLEAR, rows_kernel.FINE)


def test_logarithms_exponentials_and_the_lag_of_the_hyperbolic_sine_are_good_to_rounding():
    rng = np.random.default_rng(3)
    with mp.workdps(40), np.errstate(all="ignore"):
        for y in [*rng.uniform(-600, 600, 30), *rng.uniform(-1, 1, 30), *10.0 ** rng.uniform(-12, -1, 20)]:
            exact = mp.expm1(mp.mpf(y))
            assert abs(mp.mpf(float(hyperbola_kernel.grown(y))) - exact) <= 4e-16 * abs(exact)
            if abs(y) <= hyperbola_kernel.NARROW:
                exact = mp.sinh(mp.mpf(y)) - mp.mpf(y)
                assert abs(mp.mpf(float(hyperbola_kernel.sinh_lag(y))) - exact) <= 1e-15 * abs(exact)
                m = float(mp.expm1(mp.mpf(y)))
                exact = mp.log1p(mp.mpf(m))
                assert abs(mp.mpf(float(hyperbola_kernel.log_of(m, 1 + m))) - exact) <= 4e-16 * abs(exact)
        for t in 10.0 ** rng.uniform(-300, 300, 40):
            exact = mp.log(mp.mpf(t))
            assert abs(mp.mpf(float(hyperbola_kernel.logarithm(t))) - exact) <= 4e-16 * abs(exact)


@pytest.mark.slow  # compiling takes a quarter of a minute where no cache is
@pytest.mark.parametrize("number", SAMPLE)
def test_the_compiled_kernel_has_the_bytes_of_plain_python_and_any_split_has_its(number):
    pytest.importorskip("numba")
    one = drawn(number + 1)[number]
    states = bounded(one.scene, one.states(3000))
    boxes, periods = np.full((len(states), 3, 2), np.nan), np.full(len(states), np.nan)
    left = hyperbola_numba.by_kernel(landscape(one.scene), states, boxes, periods, fast=True)
    some, times, open_ = plain(one.scene, states[:40])
    settled = open_ == 0
    np.testing.assert_array_equal(left[:40], open_)
    np.testing.assert_array_equal(boxes[:40][settled], some[settled])
    np.testing.assert_array_equal(periods[:40][settled], times[settled])
    whole, spans = extremes(one.scene, states, fast=True), period(one.scene, states, fast=True)
    parts = np.array_split(states, 7)
    np.testing.assert_array_equal(np.concatenate([extremes(one.scene, part, fast=True) for part in parts]), whole)
    np.testing.assert_array_equal(np.concatenate([period(one.scene, part, fast=True) for part in parts]), spans)


def test_scenes_without_a_torque_or_on_circles_have_no_kernel():
    assert kernel_input(landscape(scene((3, 2, 1), (0, 0, 1), 1, 0.0))) is None
    assert kernel_input(landscape(NEAR["circles, a rod"])) is None
    assert all(kernel_input(landscape(NEAR[name])) is not None for name in HYPERBOLAS)
