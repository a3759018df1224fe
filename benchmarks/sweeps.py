"""Sweeps of a million points on the minor axis and of 100,000 off the axes, their parts on disk included,
beside what one would write by hand: NumPy, a pool of processes (joblib's, where it is installed), a loop over
heyoka.

`python -m benchmarks.sweeps` measures what docs/sweep.md tells: a point and a chunk by processor time, 1, 2
and 4 processes.
"""
from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from multiprocessing import get_context
from pathlib import Path

import numpy as np

from stabilab import Fate, fate, load, motion
from stabilab.maps import parts
from stabilab.maps.plan import planned
from stabilab.maps.run import run

from .contestants import BatchFate, BatchSpinUp
from .rows import Row, each
from .timing import side_by_side

CASES = Path(__file__).parents[1] / "cases"
MINOR = CASES / "minor-axis-100.toml"
STEP, LONGEST = 0.01, 60.0  # of the plain NumPy integration
ASKED = {  # what is swept -> case, what varies, answers
    "a state, torque on the minor axis": ("minor-axis-100", {"x[1]": "-4:4:1000", "x[3]": "-3:3:1000"},
                                          "fate,level,margin"),
    "the same with extremes and period": ("minor-axis-100", {"x[1]": "-4:4:1000", "x[3]": "-3:3:1000"},
                                          "fate,margin,extremes,period"),
    "a state, torque off the axes": ("off-axis-two",
                                     {"angular_velocity[1]": "-60:60:320 deg/s",
                                      "angular_velocity[2]": "-60:60:320 deg/s"}, "fate,level"),
    "a scene, torque on the minor axis": ("minor-axis-100",
                                          {"momentum[1]": "-300:300:31", "inertia[1]": "1000:2400:31"},
                                          "fate,level,margin"),
    "a scene, torque off the axes": ("off-axis-two", {"torque[1]": "0.01:0.2:12", "torque[2]": "0.01:0.2:12"},
                                     "fate,level"),
    "equilibria of a scene, torque off the axes": ("off-axis-two",
                                                   {"torque[1]": "-0.2:0.2:30", "torque[2]": "-0.2:0.2:30"},
                                                   "equilibria,verdict"),
    "the distance from the separatrix": ("minor-axis-100", {"x[1]": "-4:4:12", "x[3]": "-3:3:12"},
                                         "distance"),
    "the time to a limit, proved": ("minor-axis-100", {"x[1]": "-4:4:8", "x[3]": "-3:3:8"}, "when"),
}


def rows(small=False) -> list[Row]:
    return [*_minor(small), *_off(small)]


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
        others = [("NumPy's RK4 in one array, by hand", pick, lambda: _by_numpy(states[pick])),
                  ("heyoka batch with compaction, by hand", pick, lambda: heyoka(states[pick])),
                  (pool, some, lambda: asked(states[some].tolist()))]
        made = []
        for words, sample, call in others:
            timed = side_by_side(lambda: _swept(plan), call, points, len(sample), rounds)
            wrong = int(((labels[sample] == Fate.SPIN_UP) != (np.asarray(call()) == 1)).sum())
            made.append(Row(name, each(timed.ours), f"{each(timed.theirs)} {words}", timed.ratio,
                            (timed.low, timed.high),
                            f"{wrong} of {len(sample)} labels differ", note="one process of ours"))
    timed = side_by_side(lambda: _swept(plan), lambda: fate(scene, states), points, points, rounds)
    return [*made, Row(name, each(timed.ours), f"{each(timed.theirs)} fate of the same array, in memory",
                       timed.ratio, (timed.low, timed.high),
                       "0 labels differ" if (fate(scene, states).labels == labels).all() else "labels differ",
                       note="what dominates: the kernel takes about half of ours; states made from the axes, "
                            "records, their checksums and files the rest")]


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
    made = [Row(name, each(timed.ours),
                f"{each(timed.theirs)} heyoka batch with compaction, until a rate of {BatchSpinUp.HIGH:g} is "
                f"reached, by hand",
                timed.ratio, (timed.low, timed.high), f"{wrong} of {len(sample)} axes differ",
                note="one process of ours; ours ends each motion at a certificate, which holds for all time; "
                     "the one by hand proves nothing. The steps of "
                     "the motions are what is left in both")]
    timed = side_by_side(lambda: _swept(plan), lambda: _swept(plan, 2), plan.points, plan.points, rounds)
    return [*made, Row(name, f"{each(timed.ours)} one process", f"{each(timed.theirs)} two processes",
                       timed.ratio, (timed.low, timed.high),
                       "the same bytes",
                       note="below one where two processes are the faster: each worker takes some two "
                            "seconds to start and to load what it "
                                              "needs, and compiles its own integrator")]


@contextmanager
def _pool():
    """(words, a call that answers a list of states) of a pool of two processes that are up: joblib's, else
    the standard library's."""
    try:
        from joblib import Parallel, delayed
    except ImportError:
        with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as workers:
            yield "a pool of 2 processes that ask motion", lambda states: list(
                workers.map(_one, states, chunksize=25))
        return
    with Parallel(n_jobs=2) as workers:
        yield ("joblib with 2 processes that ask motion",
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
    return int(motion(load(MINOR).scene, state, brief=True).fate)


def main() -> None:
    """Print the tables of docs/sweep.md."""
    print("| a point | processor time |\n|---|---|")
    for name, (case, vary, answer) in ASKED.items():
        plan = planned(CASES / f"{case}.toml", vary, answer=answer, rate="10" if answer == "when" else None)
        # loads what it needs
        _swept(planned(CASES / f"{case}.toml", {next(iter(vary)): next(iter(vary.values()))},
                       answer=answer.replace("when", "fate")))
        begin = time.process_time()
        _swept(plan)
        print(f"| {name} | {each((time.process_time() - begin) / plan.points)} |", flush=True)
    print(
        f"\na part of 100 kB: {each(_part_cost())} (written, renamed, read and checked)\n\n| processes | "
        f"wall | processor time of all | points a second |")
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
        subprocess.run([sys.executable, "-m", "stabilab", "sweep", str(MINOR), "--vary",
                        "momentum[1]=-300:300:80", "--vary", "inertia[1]=1000:2400:80",
                        "--workers", str(workers), "--out", f"{folder}/map.nc"], check=True,
                       capture_output=True)
        wall, after = time.monotonic() - begin, resource.getrusage(resource.RUSAGE_CHILDREN)
    return wall, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, 6400


if __name__ == "__main__":
    main()
