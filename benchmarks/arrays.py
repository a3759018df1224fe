"""Rows of a fresh process: a few states a call or many, plain and compiled, its time over the number of
calls, and ten million states at once with the memory they take. Librations about the intermediate axis, loops
compiled beforehand except where a row says that none is."""
from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from functools import partial
from pathlib import Path

import numpy as np

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
        return [partial(in_calls, 10, 100), plain_and_compiled, partial(at_once, "fate", 1000),
                partial(over_calls, "fate", 10), partial(over_calls, "spin-up", 1)]
    return [*(partial(over_calls, question, each) for question in CURVES for each in EACH
              if question != "spin-up" or each == 1),
            *(partial(over_calls, *curve, compiled=False) for curve in COMPILED),
            *(partial(in_calls, each, total) for each in CALLS for total in ROWS if each <= total),
            plain_and_compiled, *(partial(at_once, question, 10_000_000) for question in QUESTIONS)]


def _run(code: str, begin: str = BEGIN, **environment: str) -> list[float]:
    """What a fresh process prints last, a list in JSON."""
    variables = os.environ | {"OPENBLAS_NUM_THREADS": "1"} | environment
    printed = subprocess.run([sys.executable, "-c", begin + code], check=True, capture_output=True, text=True,
                             cwd=ROOT, env=variables).stdout
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


# --- The time of a process over the number of its calls
EACH = 1, 10, 100, 900, 1000
ON_AXIS = """from stabilab import ScaledGyrostat, extremes, fate, period
scene = ScaledGyrostat("0.5", "3.1", (0, "-0.8", 0))
states = np.random.default_rng(1).uniform([-5, -5, -6], [5, 5, 6], (50_000, 3))
"""
OFF_AXIS = """from stabilab import Body, ConstantTorque, Gyrostat, Scene, fate, spin_up
scene = Scene(Body((3, 2, 1)), Gyrostat((0.3, -0.1, 0.2)), ConstantTorque((0.3, 0.5, 0.4)))
states = np.random.default_rng(1).normal(size=(50_000, 3)) * 2
"""
# name -> scene, the question in Python, in words
CURVES = {"fate": (ON_AXIS, "fate", "fates"), "extremes": (ON_AXIS, "extremes", "extremes"),
          "period": (ON_AXIS, "period", "periods"), "off-axis": (OFF_AXIS, "fate", "fates off the axes"),
          "spin-up": (OFF_AXIS, "lambda scene, states: spin_up(scene, states[0])", "spin-up")}
# those of nothing compiled: question, states a call, s that reach beyond compiling
COMPILED = ("fate", 100, 9.0), ("extremes", 100, 26.0), ("off-axis", 10, 26.0)
# how a process chooses between plain and compiled loops, or does not
CHOICES = {"own": "", "plain": "Kernel.pays = lambda kernel, work, fast=None: bool(fast)",
           "compiled": "Kernel.pays = lambda kernel, work, fast=None: fast is not False"}
OVER_CALLS = """
from stabilab.numbers.numba_door import Kernel
{choice}
question, times, first = {question}, [], 0
while time.process_time() < {limit}:
    question(scene, states[first:first + {each}])
    first = (first + {each}) % (len(states) - {each})
    times.append(time.process_time())
print(json.dumps(times))"""


def over_calls(question: str, each: int, limit: float = 2.0, compiled: bool = True) -> list[Row]:
    """Processor time of a process, its start counted, over the number of its calls: by how much it grows
    where these double and in one call, at most, and beside loops plain, or compiled, from the beginning."""
    curves = {choice: _curve(question, each, limit, choice, compiled)
              for choice in (CHOICES if compiled and each in (1, 100, 1000) else ("own",))}
    times, name = curves["own"], f"{question}-{each}" + "-empty" * (not compiled)
    what = (f"{CURVES[question][2]} in a new process, {each} a call"
            + ", nothing compiled before" * (not compiled))
    half, one = np.arange(len(times) // 2), np.arange(len(times) - 1)
    rows = [_grown(f"arrays-double-{name}", f"{what}: twice as many calls", times, half, 2 * half + 1, each),
            _grown(f"arrays-call-{name}", f"{what}: one more call", times, one, one + 1, each)]
    if len(curves) > 1:
        count = min(map(len, curves.values()))
        better = np.minimum(curves["plain"][:count], curves["compiled"][:count])
        worst = int(np.argmax(times[:count] / better))
        rows.append(_row(f"arrays-choice-{name}", f"{what}: beside the better choice", times[worst],
                         better[worst], "the better of plain and compiled loops", (worst + 1) * each))
    return rows


def _curve(question: str, each: int, limit: float, choice: str, compiled: bool):
    """(calls,) s of processor time since the start of the process after each of its calls."""
    scene, function, _ = CURVES[question]
    code = OVER_CALLS.format(choice=CHOICES[choice], question=function, each=each, limit=limit)
    begin = "import json, time\nimport numpy as np\n" + scene
    with tempfile.TemporaryDirectory() as empty:
        places = {} if compiled else {"NUMBA_CACHE_DIR": empty}
        return np.array(_run(code, begin, STABILAB_QUIET="1", **places))


def _grown(key: str, what: str, times: np.ndarray, before: np.ndarray, after: np.ndarray, each: int) -> Row:
    """The row of the largest growth of times between calls, given by their indices."""
    worst = int(np.argmax(times[after] / times[before]))
    states = (int(after[worst]) + 1) * each
    return _row(key, what, times[after[worst]], times[before[worst]], "before", states)


def _row(key: str, what: str, ours: float, theirs: float, other: str, states: int) -> Row:
    ratio = float(theirs / ours)
    return Row(key, what, float(ours), "s", float(theirs), other, ratio, ratio, ratio, f"at {states} states",
               0.5, "processor time since the start of the process, at the number of calls where the ratio "
               "is least")
