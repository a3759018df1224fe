"""A sweep of a million points, its parts on disk included, beside what one would write by hand: NumPy, a pool of processes, a loop over heyoka.

`python -m benchmarks.sweeps` measures what docs/sweep.md tells: a point and a chunk by processor time, 1, 2 and 4 processes.
"""
from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from multiprocessing import get_context
from pathlib import Path

import numpy as np

from stabilab import Fate, fate, load, motion
from stabilab.maps import parts
from stabilab.maps.plan import planned
from stabilab.maps.run import run

from .contestants import BatchFate
from .rows import Row, each
from .timing import side_by_side

CASES = Path(__file__).parents[1] / "cases"
MINOR = CASES / "minor-axis-100.toml"
STEP, LONGEST = 0.01, 60.0  # of the plain NumPy integration
ASKED = {  # what is swept -> case, what varies, answers
    "a state, torque on the minor axis": ("minor-axis-100", {"x[1]": "-4:4:1000", "x[3]": "-3:3:1000"}, "fate,level,margin"),
    "the same with extremes and period": ("minor-axis-100", {"x[1]": "-4:4:1000", "x[3]": "-3:3:1000"}, "fate,margin,extremes,period"),
    "a state, torque off the axes": ("off-axis-two", {"angular_velocity[1]": "-60:60:320 deg/s", "angular_velocity[2]": "-60:60:320 deg/s"}, "fate,level"),
    "a scene, torque on the minor axis": ("minor-axis-100", {"momentum[1]": "-300:300:31", "inertia[1]": "1000:2400:31"}, "fate,level,margin"),
    "a scene, torque off the axes": ("off-axis-two", {"torque[1]": "0.01:0.2:12", "torque[2]": "0.01:0.2:12"}, "fate,level"),
    "equilibria of a scene, torque off the axes": ("off-axis-two", {"torque[1]": "-0.2:0.2:30", "torque[2]": "-0.2:0.2:30"}, "equilibria,verdict"),
    "the distance from the separatrix": ("minor-axis-100", {"x[1]": "-4:4:12", "x[3]": "-3:3:12"}, "distance"),
    "the time to a limit, proved": ("minor-axis-100", {"x[1]": "-4:4:8", "x[3]": "-3:3:8"}, "when"),
}


def rows(small=False) -> list[Row]:
    side, rounds = (60, 2) if small else (1000, 5)
    plan = planned(MINOR, {"x[1]": f"-4:4:{side}", "x[3]": f"-3:3:{side}"})
    scene, points = plan.case.scene, plan.points
    states = _states(side)
    with run(plan, workers=1) as found:
        labels = found.records["fate"].ravel()
    pick = np.random.default_rng(1).permutation(points)[:40 if small else 2000]
    pool = pick[:8 if small else 200]
    heyoka, workers = BatchFate(scene), ProcessPoolExecutor(2, mp_context=get_context("spawn"))
    others = [("NumPy's RK4 in one array, by hand", pick, lambda: _by_numpy(states[pick]), lambda: _by_numpy(states[pick])),
              ("heyoka batch with compaction, by hand", pick, lambda: heyoka(states[pick]), lambda: heyoka(states[pick])),
              ("a pool of 2 processes that ask motion", pool, partial(_by_pool, workers, states[pool]), partial(_by_pool, workers, states[pool]))]
    made = []
    for words, sample, call, answer in others:
        timed = side_by_side(lambda: _swept(plan), call, points, len(sample), rounds)
        wrong = int(((labels[sample] == Fate.SPIN_UP) != (answer() == 1)).sum())
        made.append(Row(f"sweep of {points} points, minor axis, parts on disk", each(timed.ours), f"{each(timed.theirs)} {words}", timed.ratio,
                        (timed.low, timed.high), f"{wrong} of {len(sample)} labels differ", note="one process of ours"))
    workers.shutdown()
    timed = side_by_side(lambda: _swept(plan), lambda: fate(scene, states), points, points, rounds)
    made.append(Row(f"sweep of {points} points, minor axis, parts on disk", each(timed.ours), f"{each(timed.theirs)} fate of the same array, in memory",
                    timed.ratio, (timed.low, timed.high), "0 labels differ" if (fate(scene, states).labels == labels).all() else "labels differ",
                    note="what reading the case, chunks and parts cost"))
    return made


def _states(side) -> np.ndarray:
    first, third = np.meshgrid(np.linspace(-4, 4, side), np.linspace(-3, 3, side), indexing="ij")
    return np.stack([first.ravel(), np.full(first.size, 4.0), third.ravel()], axis=1)


def _swept(plan) -> None:
    with run(plan, workers=1):
        pass


def _by_numpy(states) -> np.ndarray:
    """Labels by fixed steps of all states at once: a full turn ahead is spin-up; the third reversal of the turn, or time, is bounded."""
    a, b = 0.2, 0.4
    rate = lambda y: np.stack([y[1] * y[2], -y[2] * (y[0] + a), y[1] * (y[0] + b) + 1.0, y[2]])
    y = np.vstack([states.T, np.zeros(len(states))])
    labels, sign, reversals, lowest = np.zeros(len(states), int), np.sign(y[2]), np.zeros(len(states), int), np.zeros(len(states))
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


def _by_pool(pool, states) -> np.ndarray:
    """What joblib does: a pool of processes that are up, a point a task, in groups."""
    return np.array(list(pool.map(_one, states.tolist(), chunksize=25)))


def _one(state) -> int:
    return int(motion(load(MINOR).scene, state, brief=True).fate)


def main() -> None:
    """Print the tables of docs/sweep.md."""
    print("| a point | processor time |\n|---|---|")
    for name, (case, vary, answer) in ASKED.items():
        plan = planned(CASES / f"{case}.toml", vary, answer=answer, rate="10" if answer == "when" else None)
        _swept(planned(CASES / f"{case}.toml", {next(iter(vary)): next(iter(vary.values()))}, answer=answer.replace("when", "fate")))  # loads what it needs
        begin = time.process_time()
        _swept(plan)
        print(f"| {name} | {each((time.process_time() - begin) / plan.points)} |", flush=True)
    print(f"\na part of 100 kB: {each(_part_cost())} (written, renamed, read and checked)\n\n| processes | wall | processor time of all | points a second |")
    print("|---|---|---|---|")
    for workers in (1, 2, 4):
        wall, cpu, points = _timed(workers)
        print(f"| {workers} | {wall:.1f} s | {cpu:.1f} s | {points / wall:,.0f} |", flush=True)
    print(f"\n{os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}")


def _part_cost(number=200) -> float:
    plan = planned(MINOR, {"x[1]": "0:1:10000"})
    with run(plan, workers=1) as found:
        rows = found.records.tobytes()
    with tempfile.TemporaryDirectory() as folder:
        begin = time.process_time()
        for _ in range(number):
            parts.write(plan, Path(folder), 0, rows)
            parts.read(plan, Path(folder), 0)
        return (time.process_time() - begin) / number


def _timed(workers) -> tuple[float, float, int]:
    """(wall, processor time of all processes, points) of a sweep of scenes by so many processes."""
    with tempfile.TemporaryDirectory() as folder:
        before, begin = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
        subprocess.run([sys.executable, "-m", "stabilab", "sweep", str(MINOR), "--vary", "momentum[1]=-300:300:80", "--vary", "inertia[1]=1000:2400:80",
                        "--workers", str(workers), "--out", f"{folder}/map.nc"], check=True, capture_output=True)
        wall, after = time.monotonic() - begin, resource.getrusage(resource.RUSAGE_CHILDREN)
    return wall, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, 6400


if __name__ == "__main__":
    main()
