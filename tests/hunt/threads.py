"""Threads that ask about one scene at once, each with caches as empty as at the start, against one thread
alone: the same bytes."""
from __future__ import annotations

import sys
import threading

import numpy as np

import stabilab
from stabilab.errors import InputError
from tests.hunt.disagreements import NO_QUESTION, WRONG

COUNTS = (3,)
MANY = 6000  # rows
SWITCH = 1e-3  # s, after which another thread has its turn


def threads(scene, problem, state):
    """Fates, extremes, periods and branches, by NumPy and compiled, of a large array in the state's
    neighbourhood."""
    rng = np.random.default_rng(2)
    # few beside a separatrix, which would go one by one
    states = np.array(state) * 10.0 ** rng.uniform(-1, 1, (MANY, 3))
    questions = [(name, fast) for fast in (False, True) for name in QUESTIONS]
    alone = {}
    for question in questions:
        _forget()
        alone[question] = _asked(scene, states, *question)
    for count in COUNTS:
        _forget()
        for question, answer in _together(scene, states, questions, count):
            if answer != alone[question]:
                return WRONG, f"{question[0]}, fast={question[1]}: {count} threads have other bytes than one"
    return NO_QUESTION


QUESTIONS = {
    "fate": lambda scene, states,
    fast: [getattr(stabilab.fate(scene, states, fast=fast), n)
           for n in ("labels", "margins", "axis", "sense", "reasons")],
    "extremes": lambda scene, states, fast: [stabilab.extremes(scene, states[::500], fast=fast)],
    "period": lambda scene, states, fast: [stabilab.period(scene, states[::500], fast=fast)],
    "separatrix": lambda scene, states,
    fast: [branch.points for branch in stabilab.separatrix(scene, shape=(9, 17)).branches],
}


def _asked(scene, states, name, fast):
    try:
        return [a.tobytes() for a in QUESTIONS[name](scene, states, fast)]
    except InputError as error:
        return str(error)


def _together(scene, states, questions, count):
    """[(question, answer)] of so many threads, each asking all of them in an order of its own."""
    told, before = [], sys.getswitchinterval()

    def run(seed):
        for n in np.random.default_rng(seed).permutation(len(questions)):
            told.append((questions[n], _asked(scene, states, *questions[n])))
    workers = [threading.Thread(target=run, args=(seed,)) for seed in range(count)]
    sys.setswitchinterval(SWITCH)
    try:
        for worker in workers:
            worker.start()
        for worker in workers:
            worker.join()
    finally:
        sys.setswitchinterval(before)
    assert len(told) == count * len(questions)
    return told


def _forget():
    """What the package keeps of scenes; compiled code stays."""
    for name, module in list(sys.modules.items()):
        if name.startswith("stabilab.") and "numba" not in name:
            for value in list(vars(module).values()):
                if hasattr(value,
                           "cache_clear") and getattr(value, "__module__",
                                                      "").startswith(
                                                          "stabilab.orbit") and "numba" not in value.__module__:
                    value.cache_clear()
