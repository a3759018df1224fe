"""Sweeps of a million points on the minor axis and of 100,000 off the axes, their parts on disk included,
beside what one would write by hand: NumPy, a pool of processes (joblib's, where it is installed), a loop over
heyoka. A point and a part by processor time; 1, 2 and 4 processes; states streamed into a file.
"""
from __future__ import annotations

import resource
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from functools import partial
from multiprocessing import get_context
from pathlib import Path

import numpy as np

from stabilab import Fate, fate, load
from stabilab.maps import parts
from stabilab.maps.plan import planned
from stabilab.maps.run import run

from .contestants import BatchFate, BatchSpinUp
from .rows import PEAK, Row, against
from .timing import side_by_side

CASES = Path(__file__).parents[1] / "cases"
MINOR = CASES / "minor-axis-100.toml"
STEP, LONGEST = 0.01, 60.0  # of the plain NumPy integration
OWN = ("one process of ours; states made from the axes, records, their checksums and files take about as "
       "much as the kernel")
ASKED = {  # key -> case, what varies, answers, words
    "state": ("minor-axis-100", {"x[1]": "-4:4:1000", "x[3]": "-3:3:1000"}, "fate,level,margin",
              "a state, torque on the minor axis: outcome, level, margin"),
    "state-extremes": ("minor-axis-100", {"x[1]": "-4:4:1000", "x[3]": "-3:3:1000"},
                       "fate,margin,extremes,period", "the same with extremes and period"),
    "state-off": ("off-axis-two", {"angular_velocity[1]": "-60:60:320 deg/s",
                                   "angular_velocity[2]": "-60:60:320 deg/s"}, "fate,level",
                  "a state, torque off the axes, certified"),
    "scene": ("minor-axis-100", {"momentum[1]": "-300:300:31", "inertia[1]": "1000:2400:31"},
              "fate,level,margin", "a scene, torque on the minor axis"),
    "scene-off": ("off-axis-two", {"torque[1]": "0.01:0.2:12", "torque[2]": "0.01:0.2:12"}, "fate,level",
                  "a scene, torque off the axes"),
    "equilibria": ("off-axis-two", {"torque[1]": "-0.2:0.2:30", "torque[2]": "-0.2:0.2:30"},
                   "equilibria,verdict", "equilibria of a scene, torque off the axes"),
    "distance": ("minor-axis-100", {"x[1]": "-4:4:12", "x[3]": "-3:3:12"}, "distance",
                 "the distance from the separatrix"),
    "when": ("minor-axis-100", {"x[1]": "-4:4:8", "x[3]": "-3:3:8"}, "when",
             "the time to a limit, proved"),
}


def measurements(small=False):
    found = [partial(_minor, small), partial(_off, small), partial(_part, 3 if small else 200)]
    if small:
        return found
    return [*found, *(partial(_asked, key) for key in ASKED), *(partial(_processes, n) for n in (1, 2, 4)),
            *(partial(_into_a_file, side) for side in (1000, 2000, 10_000))]


def _minor(small) -> list[Row]:
    side, rounds = (60, 2) if small else (1000, 5)
    plan = planned(MINOR, {"x[1]": f"-4:4:{side}", "x[3]": f"-3:3:{side}"})
    scene, points = plan.case.scene, plan.points
    name = f"sweep of {points} points, minor axis, parts on disk"
    states = _states(side)
    with run(plan, workers=1) as found:
        labels = found.records["fate"].ravel()
    pick = np.random.default_rng(1).permutation(points)[:40 if small else 2000]
    some = pick[:8 if small else 200]
    heyoka = BatchFate(scene)
    with _pool() as (pool, asked):
        others = [("numpy", "NumPy's RK4 in one array, by hand", pick, lambda: _by_numpy(states[pick])),
                  ("heyoka", "heyoka batch with compaction, by hand", pick, lambda: heyoka(states[pick])),
                  ("pool", pool, some, lambda: asked(states[some].tolist()))]
        made = []
        for key, words, sample, call in others:
            timed = side_by_side(lambda: _swept(plan), call, points, len(sample), rounds)
            wrong = int(((labels[sample] == Fate.SPIN_UP) != (np.asarray(call()) == 1)).sum())
            made.append(against(f"sweep-minor-{key}", name, timed, words,
                                f"{wrong} of {len(sample)} labels differ", note=OWN))
    timed = side_by_side(lambda: _swept(plan), lambda: fate(scene, states), points, points, rounds)
    return [*made, against("sweep-minor-memory", name, timed, "fate of the same array, in memory",
                           "0 labels differ" if (fate(scene, states).labels == labels).all()
                           else "labels differ", note=OWN)]


def _off(small) -> list[Row]:
    """Torque off the axes: beside heyoka's batches up to a rate from which nobody expects a return, and
    beside two processes of ours."""
    sides, rounds = ((20, 15), 2) if small else ((400, 250), 3)
    plan = planned(CASES / "off-axis-two.toml",
                   {f"angular_velocity[{n + 1}]": f"-2:2:{side}" for n, side in enumerate(sides)})
    name = f"sweep of {plan.points} points, torque off the axes, parts on disk"
    with run(plan, workers=1) as found:
        axes = found.records["spin_axis"].ravel()
    sample = np.random.default_rng(1).permutation(plan.points)[:16 if small else 400]
    states = np.stack([*(grid.ravel()
                         for grid in np.meshgrid(*(np.linspace(-2, 2, side) for side in sides),
                                                 indexing="ij")),
                       np.full(plan.points, plan.case.state[2])], axis=1)[sample]
    by_hand = BatchSpinUp(plan.case.scene)
    timed = side_by_side(lambda: _swept(plan), lambda: by_hand(states), plan.points, len(sample), rounds)
    wrong = int((axes[sample] != by_hand(states)).sum())
    made = [against("sweep-off", name, timed, "heyoka batch with compaction, until a rate of "
                    f"{BatchSpinUp.HIGH:g} is reached, by hand", f"{wrong} of {len(sample)} axes differ",
                    note="one process of ours; ours ends each motion at a certificate, which holds for all "
                         "time; the one by hand proves nothing. The steps of the motions are what is left in "
                         "both")]
    timed = side_by_side(lambda: _swept(plan), lambda: _swept(plan, 2), plan.points, plan.points, rounds)
    return [*made, against("sweep-off-processes", f"{name}, one process", timed, "two processes of ours",
                           "the same bytes",
                           note="elapsed time; a ratio below one is the gain of the second process, which "
                                "takes some time to start and to load what it needs")]


@contextmanager
def _pool():
    """(words, a call that answers a list of states) of a pool of two processes that are up: joblib's, else
    the standard library's."""
    try:
        from joblib import Parallel, delayed
    except ImportError:
        with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as workers:
            yield "a pool of 2 processes that ask fate", lambda states: list(
                workers.map(_one, states, chunksize=25))
        return
    with Parallel(n_jobs=2) as workers:
        yield ("joblib with 2 processes that ask fate",
               lambda states: workers(delayed(_one)(state) for state in states))


def _states(side) -> np.ndarray:
    first, third = np.meshgrid(np.linspace(-4, 4, side), np.linspace(-3, 3, side), indexing="ij")
    return np.stack([first.ravel(), np.full(first.size, 4.0), third.ravel()], axis=1)


def _swept(plan, workers=1) -> None:
    with run(plan, workers=workers):
        pass


def _by_numpy(states) -> np.ndarray:
    """Labels by fixed steps of all states at once: a full turn ahead is spin-up; the third reversal of the
    turn, or time, is bounded."""
    a, b = 0.2, 0.4
    rate = lambda y: np.stack([y[1] * y[2], -y[2] * (y[0] + a), y[1] * (y[0] + b) + 1.0, y[2]])
    y = np.vstack([states.T, np.zeros(len(states))])
    labels, sign, reversals, lowest = np.zeros(len(states),
                                               int), np.sign(y[2]), np.zeros(len(states),
                                                                             int), np.zeros(len(states))
    for _ in range(int(LONGEST / STEP)):
        k1 = rate(y)
        k2 = rate(y + STEP / 2 * k1)
        k3 = rate(y + STEP / 2 * k2)
        y = y + STEP / 6 * (k1 + 2 * k2 + 2 * k3 + rate(y + STEP * k3))
        lowest = np.minimum(lowest, y[3])
        turned = np.sign(y[2]) != sign
        reversals, sign = reversals + turned, np.sign(y[2])
        going = (labels == 0) & (reversals < 3)
        labels[going & (y[2] > 0) & (y[3] > lowest + 2 * np.pi)] = 1
        y[:, labels == 1] = 0.0  # they would leave the doubles
        if not ((labels == 0) & (reversals < 3)).any():
            break
    return labels


def _one(state) -> int:
    return int(fate(load(MINOR).scene, state).labels)


def _asked(key) -> Row:
    """Processor time of a point; the process has loaded what the sweep needs before."""
    case, vary, answer, words = ASKED[key]
    plan = planned(CASES / f"{case}.toml", vary, answer=answer, rate="10" if answer == "when" else None)
    _swept(planned(CASES / f"{case}.toml", {next(iter(vary)): next(iter(vary.values()))},
                   answer=answer.replace("when", "fate")))
    begin = time.process_time()
    _swept(plan)
    return Row(f"sweep-{key}", f"sweep of {plan.points} points: {words}",
               (time.process_time() - begin) / plan.points)


def _part(number=200) -> Row:
    plan = planned(MINOR, {"x[1]": "0:1:10000"})
    with run(plan, workers=1) as found:
        rows = found.records.tobytes()
    with tempfile.TemporaryDirectory() as folder:
        begin = time.process_time()
        for _ in range(number):
            parts.write(plan, Path(folder), 0, rows)
            parts.read(plan, Path(folder), 0)
        each = (time.process_time() - begin) / number
    return Row("sweep-part", f"a part of {len(rows)} bytes written, renamed, read and checked", each)


def _processes(workers) -> Row:
    """Processor time of all processes of a sweep of scenes from the shell."""
    with tempfile.TemporaryDirectory() as folder:
        before, begin = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
        subprocess.run([sys.executable, "-m", "stabilab", "sweep", str(MINOR), "--vary",
                        "momentum[1]=-300:300:80", "--vary", "inertia[1]=1000:2400:80",
                        "--workers", str(workers), "--out", f"{folder}/map.nc"], check=True,
                       capture_output=True)
        wall, after = time.monotonic() - begin, resource.getrusage(resource.RUSAGE_CHILDREN)
    spent = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return Row(f"sweep-processes-{workers}", f"stabilab sweep of 6400 scenes, {workers} "
               f"process{'es' * (workers > 1)}, processor time of all", spent, "s",
               note=f"elapsed time with {workers}: {wall:.1f} s")


def _into_a_file(side) -> list[Row]:
    """Elapsed time and memory of a sweep of states by two processes into a .nc file, from the shell."""
    with tempfile.TemporaryDirectory() as folder:
        code = PEAK + ("import sys\nfrom stabilab.__main__ import main\n"
                       "try:\n    main()\nfinally:\n"
                       "    workers = resource.getrusage(resource.RUSAGE_CHILDREN)\n"
                       "    print(peak(), 1024 * workers.ru_maxrss, file=sys.stderr)\n")
        begin = time.monotonic()
        printed = subprocess.run([sys.executable, "-c", code, "sweep", str(MINOR),
                                  "--vary", f"x[1]=-4:4:{side}", "--vary", f"x[3]=-3:3:{side}",
                                  "--workers", "2", "--out", f"{folder}/map.nc"],
                                 check=True, capture_output=True, text=True).stderr.split()
        wall = time.monotonic() - begin
    name = f"stabilab sweep of {side * side} states by two processes into a .nc file"
    key = f"sweep-file-{side * side // 1_000_000}"
    return [Row(key, f"{name}, elapsed time", wall, "s", note="the command's start is in it"),
            Row(f"{key}-peak", f"{name}, peak of the first process", float(printed[-2]), "bytes"),
            Row(f"{key}-worker", f"{name}, peak of a worker", float(printed[-1]), "bytes")]
