"""python -m tests.compiled: what two workers of the default tests would each do at the same time is done
once, on two cores.

The loops that the tests run compiled come into numba's cache beside the sources, and the tests into Python's,
their asserts rewritten by pytest.
"""
from __future__ import annotations

import contextlib
import io
import random
from concurrent.futures import ProcessPoolExecutor

import numpy as np
import pytest

from stabilab import load
from stabilab.answers.motion import motion
from stabilab.numbers.numba_door import installed
from stabilab.orbit.extremes_arrays import extremes_and_periods
from stabilab.orbit.fate_arrays import compiled_margins
from stabilab.orbit.landscape import landscape
from stabilab.unreduced.spin_up.certificate import tests_of
from stabilab.unreduced.spin_up.follow import spin_up_many
from tests.shared import CASES
from tests.unreduced.spin_up.scenes import random_scene


def searches():
    """Of spin-up: steps of many motions and of one alone, and the tests of their states about fixed and
    moving centres."""
    starts = np.random.default_rng(6).normal(size=(40, 3)) * 3
    for wheel in (0, 0.3):
        scene = random_scene(random.Random(31), wheel)
        spin_up_many(scene, starts, 100, 3000, fast=True)
        spin_up_many(scene, starts[:1], 100, 300, fast=True)  # in one lane
        tests = tests_of(scene)
        for field in tests.fixed + tests.moving:
            tests.certifier(field, (2, 4)).constants(starts[0], 1e-9, fast=True)


def proofs():
    """Of validated runs."""
    case = load(CASES / "off-axis-two.toml")
    motion(case.scene, case.state, proof=True)


def rows():
    """Of extremes and periods of many states, and of margins that doubles leave open."""
    scene = load(CASES / "minor-axis-100.toml").scene
    states = np.random.default_rng(6).normal(size=(40, 3))
    extremes_and_periods(scene, states, by_numba=True)
    extremes_and_periods(scene, 10 * states, by_numba=True)  # spin-ups
    compiled_margins()(states, np.arange(40), *landscape(scene).kernel_input, np.empty(40), np.zeros(40, bool))


def rewritten():
    """Every test is read; none is run."""
    with contextlib.redirect_stdout(io.StringIO()):
        pytest.main(["--collect-only", "-qq"])


COMPILED = rows, searches, proofs

if __name__ == "__main__":
    with ProcessPoolExecutor(2) as pool:
        for done in [pool.submit(task) for task in (*(COMPILED if installed() else ()), rewritten)]:
            done.result()
