"""python -m tests.compiled: compile the loops that the default tests run compiled, on two cores, where numba's cache beside the sources lacks them.

Two workers of the tests that meet them at the same time would each compile all.
"""
from __future__ import annotations

import random
from concurrent.futures import ProcessPoolExecutor

import numpy as np

from stabilab import load
from stabilab.answers.motion import motion
from stabilab.numbers.numba_door import installed
from stabilab.unreduced.spin_up.fields import tests_of
from stabilab.unreduced.spin_up.follow import spin_up
from stabilab.unreduced.spin_up.many import spin_up_many
from tests.shared import CASES
from tests.unreduced.spin_up.scenes import random_scene


def searches():
    """Of spin-up: steps of many motions and of one alone, and the tests of their states about fixed and moving centres."""
    starts = np.random.default_rng(6).normal(size=(40, 3)) * 3
    for wheel in (0, 0.3):
        scene = random_scene(random.Random(31), wheel)
        spin_up_many(scene, starts, 100, 3000, fast=True)
        spin_up(scene, starts[0].tolist(), fast=True)
        tests = tests_of(scene)
        for field in tests.fixed + tests.moving:
            tests.certifier(field, (2, 4), fast=True).decide(np.arange(40), starts, np.full(40, 1e-9), np.full(40, -1), 7, np.full((6, 40), np.nan))


def proofs():
    """Of validated runs."""
    case = load(CASES / "off-axis-two.toml")
    motion(case.scene, case.state, proof=True)


if __name__ == "__main__" and installed():
    with ProcessPoolExecutor(2) as pool:
        for done in [pool.submit(task) for task in (searches, proofs)]:
            done.result()
