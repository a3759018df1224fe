"""Taylor steps and the operations on lanes, compiled and as they are written, against runs by other
formulas."""
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from stabilab import Body, ConstantTorque, Gyrostat, Scene
from stabilab.unreduced.spin_up import centres as elimination
from stabilab.unreduced.spin_up import drift as runs
from stabilab.unreduced.spin_up import fixed_kernel, lanes, moving_kernel, steps
from stabilab.unreduced.spin_up.drift import Runs

from .scenes import EXAMPLE, numba, rates_of, run

ROOT = Path(__file__).parents[3]


def states(seed, n):
    rng = np.random.default_rng(seed)
    return rng.normal(size=(n, 3)) * rng.choice([1, 3, 10, 50], size=(n, 1))


def test_constants_stand_twice_and_agree():
    """numba's cache on disk watches each kernel's file alone."""
    for name in ("SLACK", "GROWTH", "PASSES", "COEFFICIENT", "BLUR"):
        assert getattr(fixed_kernel, name) == getattr(moving_kernel, name)
    assert fixed_kernel.ROUNDING == elimination.ROUNDING
    assert (steps.STILL, steps.LOST) == (runs.STILL, runs.LOST)


@pytest.mark.parametrize("fast", [False, pytest.param(True, marks=numba)])
def test_steps_side_by_side_end_where_a_run_by_another_formula_does(fast):
    """Forth to common times, and back again."""
    starts = states(4, 5)
    runs = Runs(EXAMPLE, starts, fast)
    out, times = runs.carried(starts, np.full(5, 0.7), 1000)
    assert (times == 0.7).all()
    for start, end in zip(starts, out):
        assert np.allclose(end, run(rates_of(EXAMPLE), start, np.array([0.0, 0.7]))[-1], rtol=0,
                           atol=1e-8 * (1 + np.abs(start).max()))
    back, times = runs.carried(out, np.full(5, -0.7), 1000)
    assert (times == -0.7).all() and np.allclose(back, starts, rtol=0,
                                                 atol=1e-11 * (1 + np.abs(starts).max()))


@pytest.mark.parametrize("small", [1e-30, 1e-45, 1e-60])
def test_steps_beside_a_saddle_stay_short_though_the_state_hardly_leaves_it(small):
    """Expected: the linear solution beside the free spin w2 = -20 about the middle axis of D = (3, 2, 1), w1'
    = -20 w3/3, w3' = -20 w1."""
    scene, r = Scene(Body((3, 2, 1)), Gyrostat((0, 0, 0)), ConstantTorque((0, 0, 0))), 3**0.5
    growing = lambda t: np.array([np.cosh(20 / r * t) - np.sinh(20 / r * t) / r,
                                  np.cosh(20 / r * t) - r * np.sinh(20 / r * t)])
    starts = np.array([[small, -20.0, small]])
    runs = Runs(scene, starts)
    out, _ = runs.carried(starts, np.array([2.0]), 1000)
    assert np.allclose(out[0, [0, 2]], small * growing(2.0), rtol=1e-3, atol=0)
    runs.advance(np.arange(1), 1000, 4.0)
    assert runs.times[0] == 4.0 and np.allclose(runs.states[0, [0, 2]], small * growing(4.0), rtol=1e-3,
                                                atol=0)
    assert runs.twins.growth[0] == pytest.approx(np.abs(growing(4.0)).max(), rel=0.05)


@numba
def test_vectors_are_as_numpy_has_them():
    """Compiled operations on eight doubles against their plain meaning, to the last bit: what a process has
    compiled is in no answer."""
    starts = states(6, 11)
    plain, compiled = Runs(EXAMPLE, starts), Runs(EXAMPLE, starts, fast=True)
    for one in (plain, compiled):
        one.advance(np.arange(11), 12, 1e300, 0.05)
    assert np.array_equal(plain.states, compiled.states) and np.array_equal(plain.times, compiled.times)
    assert np.array_equal(plain.twins.growth, compiled.twins.growth)
    columns = np.array([0.0, 1.0, 2.0**-30, 3.7, 1e150, 64.0, 1.5, 1e-300])
    for name in ("logarithm", "power_of_two", "size"):
        assert np.array_equal(applied(name, columns + 1.0), getattr(lanes, name)(columns + 1.0))
    powers = np.array([-900.0, -3.5, 0.0, 0.25, 1.0, 9.75, 77.0, 101.5])
    assert np.array_equal(applied("two_to", powers),
                          lanes.two_to(powers)) and np.allclose(lanes.two_to(powers), 2.0**powers, rtol=0.004)


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


HALVES = """
from stabilab.unreduced.spin_up.lanes import load, plus, store


def first(rows):
    return load(rows, 0)


def doubled(rows):
    store(rows, 0, plus(first(rows), first(rows)))
"""
ASKED = """
import numpy as np, halves
from stabilab.numbers.numba_door import compiled
from stabilab.unreduced.spin_up import lanes
rows = np.arange(8.0).reshape(1, 8)
compiled(halves, (), **lanes.vectors())["doubled"](rows)
print(rows.tolist())
"""


@pytest.mark.slow
@numba
def test_lanes_that_are_partly_kept_on_disk_are_those_that_are_compiled_anew(tmp_path):
    """A process that was killed, or asked for less, keeps some functions: the others, compiled beside them by
    the next one, take their values."""
    (tmp_path / "halves.py").write_text(HALVES)
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path / "kept"),
                   "PYTHONPATH": os.pathsep.join([str(tmp_path), str(ROOT)])}
    for _ in range(2):
        done = subprocess.run([sys.executable, "-c", ASKED], env=environment, capture_output=True, text=True)
        assert done.stdout == f"{[[2.0 * n for n in range(8)]]}\n", done.stderr
        outer = list(tmp_path.glob("kept/*/halves.doubled-*"))
        assert outer and list(tmp_path.glob("kept/*/halves.first-*"))
        for path in outer:
            path.unlink()
