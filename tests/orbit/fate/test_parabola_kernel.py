"""Fates on parabolas: the barrier by a formula in `table_kernel`, and margins in twofold numbers."""
from __future__ import annotations

import importlib

import numpy as np
import pytest

import stabilab
from benchmarks.random_scenes import drawn
from stabilab.numbers.numba_door import installed
from stabilab.orbit.fate import table_kernel as arithmetic
from stabilab.orbit.fate.result import empty_columns
from stabilab.orbit.fate.table import barrier_table, label_by_table
from stabilab.orbit.landscape import landscape
from tests.oracles import energy
from tests.orbit.fate.test_fate import axis_of
from tests.shared import PARABOLIC

fate = importlib.import_module("stabilab.orbit.fate.arrays")
CUBIC = [name for name in PARABOLIC if barrier_table(PARABOLIC[name][0]) is not None]


def on_the_way_to_barriers(name, count):
    """States of all sizes; every second at a relative distance of 1e-15 to 0.1 from the separatrix in the
    torque's rate, where its orbit has one."""
    (scene, problem), rng = PARABOLIC[name], np.random.default_rng(5)
    i, land = axis_of(problem), landscape(PARABOLIC[name][0])
    states = rng.normal(size=(count, 3)) * 10.0 ** rng.uniform(-1, 2, (count, 1))
    margins = stabilab.fate(scene, states).margins / land.reduction.energy_unit
    near = np.isfinite(margins) & (margins + 0.5 * states[:, i] ** 2 > 0) & (np.arange(count) % 2 == 0)
    off = 1 + 10.0 ** rng.uniform(-15, -1, count) * rng.choice([-1, 1], count)
    states[near, i] = np.sqrt(states[near, i] ** 2 + 2 * margins[near]) * off[near]
    return states, near


def test_the_middle_root_stands_at_its_distance_from_the_fold():
    """x = 1 - e is a root of x^3 - 3 x + 2 s, to the rounding of a step of Newton's method from 3e-5; the
    equation itself is the check."""
    g = 2 * np.append(10.0 ** np.linspace(-12, 0, 2000), 0.5)
    e = arithmetic.middle_root(g)
    assert np.abs(e * e * (3 - e) / g - 1).max() < 1e-8 and e.max() <= 1 + 1e-9


@pytest.mark.one_in(2)
@pytest.mark.parametrize("name", CUBIC)
def test_margins_by_the_formula_keep_twelve_digits_next_to_the_separatrix_too(name):
    """Against the potential at 60 digits."""
    (scene, problem), (states, near) = PARABOLIC[name], on_the_way_to_barriers(name, 6000)
    i = axis_of(problem)
    found = stabilab.fate(scene, states, fast=False)
    asked = np.append(np.nonzero(near)[0][:20], range(1, 20, 2))
    for n in asked:
        exact, kinetic = energy.margin(problem, states[n].tolist(),
                                       digits=60), 0.5 * float(problem.weight[i]) * states[n, i] ** 2
        if exact is None:
            assert np.isposinf(found.margins[n])
        else:
            assert abs(found.margins[n]
                       - float(exact)) <= 1e-12 * (kinetic + abs(float(exact) + kinetic)), states[n].tolist()
            assert np.sign(found.margins[n]) == np.sign(float(exact))
    assert near.sum() > 100


@pytest.mark.parametrize("name", CUBIC)
def test_on_parabolas_the_loop_for_the_compiler_gives_the_bytes_of_the_arrays_as_plain_python(name):
    """Two ways to write the same arithmetic."""
    table, answers = barrier_table(PARABOLIC[name][0]), []
    states = on_the_way_to_barriers(name, 300)[0]
    for loops in (None, {0: arithmetic.parabola_loop}):
        out = empty_columns(len(states))
        with np.errstate(all="ignore"):
            open_ones = label_by_table(table, states, out, loops)
        certain = np.delete(np.arange(len(states)), open_ones)
        answers.append([open_ones.tobytes()] + [out[key][certain].tobytes()
                                                for key in ("margins", "labels", "reasons", "axis", "sense")])
    assert answers[0] == answers[1] and len(certain) > 200


@pytest.mark.one_in(2)
@pytest.mark.skipif(not installed(), reason="numba is not installed")
@pytest.mark.parametrize("name", CUBIC)
def test_on_parabolas_numba_gives_the_bytes_of_numpy(name):
    scene, states = PARABOLIC[name][0], on_the_way_to_barriers(name, 6000)[0]
    one, other = (stabilab.fate(scene, states, fast=fast) for fast in (False, True))
    assert all(getattr(one, key).tobytes() == getattr(other, key).tobytes()
               for key in ("margins", "labels", "reasons", "axis", "sense"))


def test_of_a_parabola_s_states_one_in_a_hundred_takes_twofold_numbers_and_none_takes_balls(monkeypatch):
    """Number 87 of the random scenes: a row in 230 went to balls, and of each a companion matrix had its
    eigenvalues found."""
    one, asked = drawn(88)[87], []
    fine = fate.valley_margins
    monkeypatch.setattr(fate, "valley_margins", lambda land, rows,
                        known: asked.append(len(rows)) or fine(land, rows, known))
    states = one.states(20_000)
    assert stabilab.fate(one.scene, states, fast=False).precise == 0 and sum(asked) <= 100
    asked.clear()
    assert stabilab.fate(one.scene, states[:4000], fast=False).precise == 0 and 0 < sum(asked) <= 60


def test_without_a_cubic_there_is_no_formula_and_the_other_way_answers():
    assert set(PARABOLIC) - set(CUBIC) == {"no gyrostat", "wheel on the symmetry axis", "a sphere"}
    for name in set(PARABOLIC) - set(CUBIC):
        states = np.random.default_rng(1).normal(size=(6000, 3))
        scene = PARABOLIC[name][0]
        many, few = stabilab.fate(scene, states), stabilab.fate(scene, states[:50])
        assert (many.labels[:50] == few.labels).all() and many.margins[:50].tobytes() == few.margins.tobytes()
