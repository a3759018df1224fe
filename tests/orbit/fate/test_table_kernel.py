"""Tests of `orbit/fate/table_kernel.py`: what once went wrong there, and its edges."""
from __future__ import annotations

import numpy as np
import pytest

import stabilab
from stabilab.orbit.extremes import parabola_kernel
from stabilab.orbit.fate import table_kernel as barrier_heights
from stabilab.orbit.fate.table import barrier_table, label_by_table
from stabilab.orbit.fine import rows_kernel
from tests.orbit.fate.test_fate import FAMILIES, sample

NEARLY_EQUAL = stabilab.Scene(stabilab.Body((0.544, 2.2, 2.199)), stabilab.Gyrostat((-1.021, 2.296, 0)),
                              stabilab.ConstantTorque((0, 0, -0.0843)))


@pytest.mark.parametrize("name", ["minor scaled +", "major physical, other sign",
                                  "middle scaled -, |c| above the cusp", "nearly equal"])
def test_the_loops_for_the_compiler_run_as_plain_python_give_the_bytes_of_the_arrays(name):
    """Two ways to write the same arithmetic; 600 states are more than one block of the loops. Of nearly equal
    moments most take twofold numbers."""
    if name == "nearly equal":
        scene, states = NEARLY_EQUAL, np.random.default_rng(2).normal(size=(600, 3))
    else:
        scene, states = FAMILIES[name][0], sample(name, 600)
    table, answers = barrier_table(scene), []
    for loops in (None, {-1: barrier_heights.circle_loop, 1: barrier_heights.hyperbola_loop}):
        out = {"margins": np.zeros(600),
               **{key: np.zeros(600, np.int8) for key in ("labels", "axis", "sense", "reasons")}}
        with np.errstate(all="ignore"):
            unsure = label_by_table(table, states, out, loops)
        certain = np.delete(np.arange(600), unsure)
        # reasons apart: two truth values add to 2 in machine code, to True in Python (test_fate_speed
        # compares them compiled)
        answers.append((unsure.tobytes(),
                        *(out[key][certain].tobytes() for key in ("margins", "labels", "axis", "sense"))))
    assert answers[0] == answers[1] and len(certain) > 500
    # and the general formula, which has no table, agrees
    np.testing.assert_array_equal(out["labels"][certain], stabilab.fate(scene, states).labels[certain])


def test_the_copies_are_those_of_the_rows_in_twofold_numbers():
    """Numba's cache on disk watches one file, so each kernel holds its own; here to the bit."""
    rng = np.random.default_rng(4)
    for _ in range(50):
        a, b = ((float(v), float(v * 1e-17 * rng.normal()))
                for v in rng.normal(size=2) * 10.0 ** rng.integers(-5, 5, 2))
        for name, asked in (("exact_sum", (a[0], b[0])), ("exact_product", (a[0], b[0])), ("add", (a, b)),
                            ("less", (a, b)), ("times", (a, b)),
                            ("scaled", (a, b[0]))):
            for copy in (barrier_heights, *([parabola_kernel] if name != "less" else [])):
                assert getattr(copy, name)(*asked) == getattr(rows_kernel, name)(*asked)
    assert (barrier_heights.TWOFOLD, barrier_heights.SPLITTER) == (rows_kernel.TWOFOLD, rows_kernel.SPLITTER)
    assert (parabola_kernel.DIGITS,
            parabola_kernel.PERIOD_DIGITS) == (rows_kernel.DIGITS, rows_kernel.PERIOD_DIGITS)
