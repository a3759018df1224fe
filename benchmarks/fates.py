"""The fate of many states against integration until it is decided."""
from __future__ import annotations

from functools import partial

import numpy as np

from stabilab import Body, ConstantTorque, Fate, Gyrostat, ScaledGyrostat, Scene, fate

from .contestants import BatchFate, SciPyFate
from .rows import SCENE, Row, against, random_states
from .timing import side_by_side

KEYS = {"minor axis": "minor", "middle axis with two wells": "wells",
        "major axis, perpendicular gyrostat": "major"}
SCENES = {
    "minor axis": SCENE,
    "middle axis with two wells": ScaledGyrostat(0.5, 3.1, (0, -0.8, 0)),
    "major axis, perpendicular gyrostat":
        Scene(Body((3.0, 2.0, 1.5)), Gyrostat((0.0, 0.8, 0.6)), ConstantTorque((0.2, 0.0, 0.0))),
}
BATCH = 100  # wanted ratio to heyoka's batch mode


def measurements(small=False):
    size, sample, rounds = (6000, 50, 2) if small else (1_000_000, 4000, 7)
    found = [partial(against_batch, size, sample, rounds, name) for name in SCENES]
    return found + [partial(against_scipy, size, 4 if small else 24, rounds, name)
                    for name in list(SCENES)[:1 if small else 3]]


def against_batch(size=1_000_000, sample=10_000, rounds=7, name="minor axis") -> Row:
    """Labels of `size` states against heyoka's batch mode with compaction on `sample` of them."""
    return _against(BatchFate, "heyoka batch with compaction", BATCH, size, sample, rounds, name)


def against_scipy(size=1_000_000, sample=24, rounds=7, name="minor axis") -> Row:
    """Labels of `size` states against SciPy's DOP853 with events at 1e-13 on `sample` of them."""
    return _against(SciPyFate, "SciPy DOP853 with events at 1e-13", 20_000, size, sample, rounds, name)


def _against(contestant, words, wanted, size, sample, rounds, name) -> Row:
    scene, states = SCENES[name], random_states(size)
    run, part = contestant(scene), states[:sample]
    timed = side_by_side(lambda: fate(scene, states), lambda: run(part), size, sample, rounds)
    answer, brute = fate(scene, states), run(part)
    clear = np.abs(answer.margins[:sample]) > 1e-9
    wrong = int(((answer.labels[:sample] == Fate.SPIN_UP) != (brute == 1))[clear].sum())
    key = f"fate-{KEYS[name]}{'-scipy' * (contestant is SciPyFate)}"
    return against(key, f"fate of {size} states, {name}", timed, words,
                   f"{wrong} of {int(clear.sum())} labels differ", wanted,
                   f"one thread; {answer.precise} states in ball arithmetic; what limits it: some hundred "
                   "passes over arrays")
