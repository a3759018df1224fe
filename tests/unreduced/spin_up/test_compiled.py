"""The compiled tests of spin-up against those of NumPy: other loops over other tables, the same inequality."""
import os
import random
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

from stabilab import Body, ConstantTorque, Gyrostat, Scene
from stabilab.unreduced.spin_up import certificate, elimination, fixed_centre, moving_centre
from stabilab.unreduced.spin_up.certificate import Certifier
from stabilab.unreduced.spin_up.compiled import eliminated, elimination_kernel, kernel, lanes, moving_kernel, steps
from stabilab.unreduced.spin_up.compiled.door import FixedCertifier, MovingCertifier
from stabilab.unreduced.spin_up.compiled.eliminated import Eliminated
from stabilab.unreduced.spin_up.compiled.runs import CompiledRuns
from stabilab.unreduced.spin_up.fields import tests_of as certificates
from stabilab.unreduced.spin_up.follow import spin_up
from stabilab.unreduced.spin_up.many import spin_up_many
from stabilab.unreduced.spin_up.way import twins
from stabilab.unreduced.spin_up.way.runs import Runs

from .scenes import EXAMPLE, random_scene, rates_of, run, sphere

numba = pytest.mark.skipif(find_spec("numba") is None, reason="needs numba")
ROOT = Path(__file__).parents[3]
NAMES = ("A", "z", "eta", "z_up", "eta_up", "k")


def states(seed, n):
    rng = np.random.default_rng(seed)
    return rng.normal(size=(n, 3)) * rng.choice([1, 3, 10, 50], size=(n, 1))


def assert_alike(one, other):
    assert np.array_equal(one.good, other.good)
    for name in NAMES:
        assert np.allclose(getattr(one, name)[one.good], getattr(other, name)[one.good], rtol=1e-11, atol=1e-13)


def test_constants_stand_twice_and_agree():
    assert (kernel.SLACK, kernel.GROWTH, kernel.PASSES) == (certificate.SLACK, certificate.GROWTH, certificate.PASSES)
    assert (moving_kernel.SLACK, moving_kernel.GROWTH, moving_kernel.PASSES) == (certificate.SLACK, certificate.GROWTH, certificate.PASSES)
    assert kernel.COEFFICIENT == moving_kernel.COEFFICIENT == certificate.COEFFICIENT
    assert kernel.ROUNDING == elimination.ROUNDING and kernel.BLUR == fixed_centre.BLUR
    assert moving_kernel.CONDITION == moving_centre.CONDITION * fixed_centre.BLUR
    assert (steps.STILL, steps.LOST) == (twins.STILL, twins.LOST)


@pytest.mark.parametrize("wheel, orders", [(0, (2, 4)), (0.1, (4, 6)), (1, (0, 2)), (3, (2, 4))])
def test_loops_about_the_fixed_centre_find_what_the_arrays_find(wheel, orders):
    good = 0
    for field in certificates(random_scene(random.Random(31), wheel)).fixed:
        places = states(1, 60)
        found = Certifier(field, orders)(places, 1e-9)
        assert_alike(found, FixedCertifier(field, orders, vars(kernel))(places, 1e-9))
        good += found.good.sum()
    assert good


@pytest.mark.parametrize("wheel", [0.1, 0.3])
def test_loops_about_the_moving_centre_find_what_the_arrays_find(wheel):
    good = 0
    for field in certificates(random_scene(random.Random(31), wheel)).moving:
        places = states(2, 40)
        found = Certifier(field, (2, 4))(places, 1e-9)
        assert_alike(found, MovingCertifier(field, (2, 4), vars(moving_kernel))(places, 1e-9))
        good += found.good.sum()
    assert good


def fields_with_a_moving_centre():
    """With a wheel and without one, and about the equator of a body of revolution, where q is constant."""
    found = [field for wheel in (0, 0.3) for field in certificates(random_scene(random.Random(31), wheel)).moving]
    round_ = Scene(Body((2, 2, 1)), Gyrostat((0.3, 0, 0.2)), ConstantTorque((0.5, 0.3, 0.2)))
    return found + certificates(round_).equatorial


def assert_like_terms(found, expected):
    """The same terms, each within the rounding of its own majorant."""
    order, other = np.argsort(found.keys), np.argsort(expected.keys)
    assert np.array_equal(found.keys[order], expected.keys[other])
    assert (np.abs(found.c[order] - expected.c[other]) <= 1e-13 * expected.m[other]).all()
    assert np.allclose(found.m[order], expected.m[other], rtol=1e-12, atol=0)


def test_loops_take_away_what_the_arrays_take_away(monkeypatch):
    """Expected: `elimination.corrected`, from the start and from an order that is kept; the loops answer themselves."""
    fields, by = fields_with_a_moving_centre(), Eliminated(vars(elimination_kernel))
    assert any(field.a2 == 0 for field in fields) and len(fields) > 3
    expected = [(field.energy(2), field.energy(5), field.amplitude(7)) for field in fields]
    monkeypatch.setattr(eliminated, "corrected", None)
    for field, wanted in zip(fields, expected):
        for one, other in zip((field.energy(2, by), field.energy(5, by), field.amplitude(7, by)), wanted):
            assert_like_terms(one.added, other.added)
            assert_like_terms(one.rate, other.rate)


@pytest.mark.parametrize("room", ["ROWS", "SPAN"])
def test_where_the_loops_have_no_room_the_arrays_answer(room, monkeypatch):
    field = fields_with_a_moving_centre()[0]
    monkeypatch.setattr(elimination_kernel, room, 16)
    found, expected = field.energy(2, Eliminated(vars(elimination_kernel))), field.energy(2)
    assert_like_terms(found.added, expected.added)
    assert_like_terms(found.rate, expected.rate)


@numba
@pytest.mark.parametrize("wheel", [0, 1])
def test_motions_are_decided_alike_with_and_without_numba(wheel):
    """The compiled steps are of slightly other lengths, so the tests are asked at slightly other times: verdicts are the same, and both states lie on one
    motion, by SciPy's DOP853."""
    scene, starts = random_scene(random.Random(31), wheel), np.random.default_rng(6).normal(size=(40, 3)) * 3
    slow, fast = (spin_up_many(scene, starts, 100, 3000, fast=way) for way in (False, True))
    for name in ("fate", "axis", "sense", "level"):
        assert np.array_equal(getattr(slow, name), getattr(fast, name))
    for n in np.flatnonzero((fast.t > 0) & (fast.level > 0))[::4]:
        for found in (slow, fast):
            end = run(rates_of(scene), starts[n], np.array([0.0, found.t[n]]))[-1]
            assert np.allclose(found.states[n], end, rtol=0, atol=1e-9 * found.condition[n] * (1 + np.abs(end).max()) * (1 + found.t[n]))
    assert np.median(fast.t[fast.t > 0]) == pytest.approx(np.median(slow.t[slow.t > 0]), rel=0.2)


@numba
@pytest.mark.parametrize("reach", [0.0, 1e-9])
def test_rows_are_decided_as_by_arrays(reach):
    """The compiled loops find places of rows by themselves: against the test by arrays about both centres."""
    scene, good = random_scene(random.Random(31), 0.3), 0
    tests, places = certificates(scene), states(3, 80)
    for field in tests.fixed + tests.moving:
        expected = Certifier(field, (2, 4))(places, reach)
        fired, found = np.full(80, -1), np.full((6, 80), np.nan)
        tests.certifier(field, (2, 4), fast=True).decide(np.arange(80), places, np.full(80, reach), fired, 7, found)
        assert np.array_equal(fired == 7, expected.good)
        assert np.allclose(found[:, expected.good], [getattr(expected, name)[expected.good] for name in NAMES], rtol=1e-9)
        good += expected.good.sum()
    assert good


def test_steps_side_by_side_end_where_a_run_by_another_formula_does():
    """The kernel as NumPy has it, without a compiler: forth to common times, and back again."""
    table, starts = vars(steps), states(4, 5)
    runs = CompiledRuns(EXAMPLE, starts, table)
    out, times = runs.carried(starts, np.full(5, 0.7), 1000)
    assert (times == 0.7).all()
    for start, end in zip(starts, out):
        assert np.allclose(end, run(rates_of(EXAMPLE), start, np.array([0.0, 0.7]))[-1], rtol=0, atol=1e-8 * (1 + np.abs(start).max()))
    back, times = runs.carried(out, np.full(5, -0.7), 1000)
    assert (times == -0.7).all() and np.allclose(back, starts, rtol=0, atol=1e-11 * (1 + np.abs(starts).max()))


def test_a_change_carried_beside_grows_as_the_twin_does():
    """Against twins by the run without a compiler, advance by advance to the same times."""
    starts = states(5, 6)
    compiled, plain = CompiledRuns(EXAMPLE, starts, vars(steps)), Runs(EXAMPLE, starts)
    rows = np.arange(6)
    for end in (0.3, 0.9):
        for one in (compiled, plain):
            one.advance(rows, 400, end)
        assert (compiled.times == end).all() and np.allclose(compiled.states, plain.states, rtol=1e-9, atol=1e-9)
        assert np.allclose(compiled.twins.growth, plain.twins.growth, rtol=0.01)
        assert np.allclose(compiled.twins.ahead, plain.twins.ahead, atol=0.02) and np.allclose(compiled.twins.blur, plain.twins.blur, rtol=0.02)


@pytest.mark.parametrize("small", [1e-30, 1e-45, 1e-60])
@pytest.mark.parametrize("make", [Runs, lambda scene, starts: CompiledRuns(scene, starts, vars(steps))])
def test_steps_beside_a_saddle_stay_short_though_the_state_hardly_leaves_it(make, small):
    """Expected: the linear solution beside the free spin w2 = -20 about the middle axis of D = (3, 2, 1), w1' = -20 w3/3, w3' = -20 w1."""
    scene, r = Scene(Body((3, 2, 1)), Gyrostat((0, 0, 0)), ConstantTorque((0, 0, 0))), 3**0.5
    growing = lambda t: np.array([np.cosh(20 / r * t) - np.sinh(20 / r * t) / r, np.cosh(20 / r * t) - r * np.sinh(20 / r * t)])
    starts = np.array([[small, -20.0, small]])
    runs = make(scene, starts)
    if not runs.taylor:
        pytest.skip("needs heyoka")
    out, _ = runs.carried(starts, np.array([2.0]), 1000)
    assert np.allclose(out[0, [0, 2]], small * growing(2.0), rtol=1e-3, atol=0)
    if isinstance(runs, CompiledRuns):
        runs.advance(np.arange(1), 1000, 4.0)
        assert runs.times[0] == 4.0 and np.allclose(runs.states[0, [0, 2]], small * growing(4.0), rtol=1e-3, atol=0)
        assert runs.twins.growth[0] == pytest.approx(np.abs(growing(4.0)).max(), rel=0.05)


@numba
def test_vectors_are_as_numpy_has_them():
    """Compiled operations on eight doubles against their plain meaning, to rounding: x y + z is rounded once."""
    starts = states(6, 11)
    plain, compiled = CompiledRuns(EXAMPLE, starts, vars(steps)), CompiledRuns(EXAMPLE, starts)
    for one in (plain, compiled):
        one.advance(np.arange(11), 12, 1e300, 0.05)
    assert np.allclose(plain.states, compiled.states, rtol=1e-12, atol=1e-12) and np.allclose(plain.times, compiled.times, rtol=1e-12)
    assert np.allclose(plain.twins.growth, compiled.twins.growth, rtol=1e-9)
    columns = np.array([0.0, 1.0, 2.0**-30, 3.7, 1e150, 64.0, 1.5, 1e-300])
    for name in ("logarithm", "power_of_two", "size"):
        assert np.array_equal(applied(name, columns + 1.0), getattr(lanes, name)(columns + 1.0))
    powers = np.array([-900.0, -3.5, 0.0, 0.25, 1.0, 9.75, 77.0, 101.5])
    assert np.array_equal(applied("two_to", powers), lanes.two_to(powers)) and np.allclose(lanes.two_to(powers), 2.0**powers, rtol=0.004)


def applied(name, row):
    """An operation of `lanes.vectors` on one row."""
    from numba import njit
    load, store, function = (lanes.vectors()[key] for key in ("load", "store", name))

    @njit
    def once(table):
        store(table, 1, function(load(table, 0)))
    table = np.array([row, row])
    once(table)
    return table[1]


@numba
def test_wide_batches_and_narrow_ones_give_the_same_bytes():
    """Thirty-two lanes, eight, and one at a time."""
    scene = random_scene(random.Random(9), 0.1)
    starts = np.array([sphere(random.Random(n), 3) for n in range(45)])
    all_ = spin_up_many(scene, starts, 200, fast=True)
    some = spin_up_many(scene, starts[::7], 200, fast=True)
    for name in ("t", "steps", "states", "condition"):
        assert np.array_equal(getattr(all_, name)[::7], getattr(some, name))
    assert spin_up(scene, starts[7].tolist(), 200, fast=True).state == tuple(all_.states[7].tolist())


HALVES = """
from stabilab.unreduced.spin_up.compiled.lanes import load, plus, store


def first(rows):
    return load(rows, 0)


def doubled(rows):
    store(rows, 0, plus(first(rows), first(rows)))
"""
ASKED = """
import numpy as np, halves
from stabilab.numbers.numba_door import compiled
from stabilab.unreduced.spin_up.compiled import lanes
rows = np.arange(8.0).reshape(1, 8)
compiled(halves, (), **lanes.vectors())["doubled"](rows)
print(rows.tolist())
"""


@pytest.mark.slow
@numba
def test_lanes_that_are_partly_kept_on_disk_are_those_that_are_compiled_anew(tmp_path):
    """A process that was killed, or asked for less, keeps some functions: the others, compiled beside them by the next one, take their values."""
    (tmp_path / "halves.py").write_text(HALVES)
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path / "kept"), "PYTHONPATH": os.pathsep.join([str(tmp_path), str(ROOT)])}
    for _ in range(2):
        done = subprocess.run([sys.executable, "-c", ASKED], env=environment, capture_output=True, text=True)
        assert done.stdout == f"{[[2.0 * n for n in range(8)]]}\n", done.stderr
        outer = list(tmp_path.glob("kept/*/halves.doubled-*"))
        assert outer and list(tmp_path.glob("kept/*/halves.first-*"))
        for path in outer:
            path.unlink()
