"""Rows of a fresh process: a few states a call or many, plain and compiled, and ten million at once with the
memory they take. Librations about the intermediate axis, loops compiled beforehand."""
from __future__ import annotations

import json
import os
import subprocess
import sys
from functools import partial
from pathlib import Path

from .rows import PEAK, Row

ROOT = Path(__file__).parents[1]
BEGIN = """import json, time
import numpy as np
from stabilab import ScaledGyrostat, extremes, fate, period
scene = ScaledGyrostat("0.5", "3.1", (0, "-0.8", 0))
""" + PEAK
CALLS = (1, 10, 100, 1000)
ROWS = (100, 1000, 2000, 10_000)
QUESTIONS = ("fate", "period", "extremes")


def measurements(small=False):
    if small:
        return [partial(in_calls, 10, 100), plain_and_compiled, partial(at_once, "fate", 1000)]
    return [*(partial(in_calls, each, total) for each in CALLS for total in ROWS if each <= total),
            plain_and_compiled, *(partial(at_once, question, 10_000_000) for question in QUESTIONS)]


def _run(code: str) -> list[float]:
    """What a fresh process prints last, a list in JSON."""
    printed = subprocess.run([sys.executable, "-c", BEGIN + code], check=True, capture_output=True, text=True,
                             cwd=ROOT, env=os.environ | {"OPENBLAS_NUM_THREADS": "1"}).stdout
    return json.loads(printed.splitlines()[-1])


LIBRATIONS = """
rng = np.random.default_rng(1)
states = rng.uniform([-5, -5, -6], [5, 5, 6], (8 * {total} + 100, 3))
states = states[fate(scene, states).labels == 0][:{total}]
assert len(states) == {total}
"""


def in_calls(each: int, total: int) -> Row:
    """Extremes of so many states in calls of a few, in a process that has computed none."""
    (spent,) = _run(LIBRATIONS.format(total=total) + f"""
at = time.process_time()
for n in range(0, {total}, {each}):
    extremes(scene, states[n:n + {each}])
print(json.dumps([time.process_time() - at]))""")
    return Row(f"arrays-{each}-{total}", f"extremes of {total} states in a new process, {each} a call", spent,
               "s", note="processor time after the start of the process; loops were compiled before")


def plain_and_compiled(total: int = 1000) -> list[Row]:
    """Extremes of a row by loops as they are written and compiled, which must have the same bytes."""
    plain, compiled, same = _run(LIBRATIONS.format(total=total) + """
from stabilab.orbit.extremes_arrays import extremes_and_periods
times, found = [], []
for by_numba in (False, True):
    extremes_and_periods(scene, states, by_numba=by_numba)
    at = time.process_time()
    found.append(extremes_and_periods(scene, states, by_numba=by_numba))
    times.append(time.process_time() - at)
same = all(a.tobytes() == b.tobytes() for a, b in zip(*found))
print(json.dumps([*(t / len(states) for t in times), float(same)]))""")
    return [Row("arrays-plain", "extremes and period of a state, loops in plain Python", plain, "each",
                compiled, "loops that numba compiles", compiled / plain, compiled / plain, compiled / plain,
                "the same bytes" if same else "bytes differ")]


def at_once(question: str, total: int) -> list[Row]:
    """One call for many states: processor time, and peak beyond the process and its input."""
    spent, peak = _run(LIBRATIONS.format(total=1000) + f"""
{question}(scene, states)
states = np.resize(states, ({total}, 3))
before = peak()
at = time.process_time()
found = {question}(scene, states)
spent = time.process_time() - at
print(json.dumps([spent, peak() - before]))""")
    what = f"stabilab.{question} of {total} states in one call"
    return [Row(f"arrays-{question}", what, spent, "s"),
            Row(f"arrays-{question}-peak", f"{what}, peak beyond the process and its input", peak, "bytes")]
