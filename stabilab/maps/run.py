"""Running a sweep: which chunks are left, who computes them, and how far it is."""
from __future__ import annotations

import shutil
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from ..errors import InputError
from ..interrupt import undoing
from ..processes import cores
from ..streams import Progress
from . import parts
from .chunk import answered
from .cluster import by_cluster
from .plan import Plan
from .points import case_of
from .workers import by_workers

WORTH = 3.0  # seconds of work for which another process is worth its start


@dataclass(frozen=True)
class Swept:
    """records: of the shape of the plan's sweep; resumed: points that an earlier run had finished; broken: numbers that make no case, with why (of the
    first)."""

    plan: Plan
    records: np.ndarray
    resumed: int = 0
    broken: int = 0
    why: str = ""


@contextmanager
def run(plan: Plan, out: Path | None = None, workers: int | None = None, scheduler: str | None = None, command: str = "") -> Iterator[Swept]:
    """The finished sweep as a context; the parts of `out` are removed when its block ends well, and stay otherwise. out: the file that the parts are
    for, None to keep none. workers: processes on this machine; None: one a core where that pays.
    scheduler: address of a Dask scheduler whose workers do it instead. command: of what the sweep is part of."""
    _judge(workers)
    with _folder(plan, out, command) as folder:
        left = parts.missing(plan, folder)
        points = sum(plan.chunks[number].points for number in left)
        with _counted(plan, points) as tell:
            for number in _makers(plan, folder, left, workers, scheduler):
                tell(plan.chunks[number].points)
        yield _finished(plan, parts.whole(plan, folder), plan.points - points)
        if out is not None:
            parts.remove(folder)


def _judge(workers: int | None) -> None:
    if workers is not None and (isinstance(workers, bool) or not isinstance(workers, int) or workers < 1):
        raise InputError(f"workers: expected a number of processes of at least 1, got {workers!r:.40}")


@contextmanager
def _folder(plan, out, command):
    if out is not None:
        with parts.kept(plan, parts.place_of(Path(out)), command) as folder:
            yield folder
    else:
        with tempfile.TemporaryDirectory(prefix="stabilab-") as folder, undoing(partial(shutil.rmtree, folder, True)):
            yield Path(folder)


def _makers(plan: Plan, folder: Path, left: list[int], workers: int | None, scheduler: str | None) -> Iterable[int]:
    """The chunks left, each as soon as its part is there."""
    if scheduler is not None:
        return by_cluster(plan, folder, left, scheduler)
    enough = int(sum(plan.chunks[n].points for n in left) * plan.cost / WORTH)  # processes that have something to do besides starting
    number = min(max(1, min(cores(), enough)) if workers is None else workers, len(left))
    return by_workers(plan, folder, left, number) if number > 1 else _here(plan, folder, left)


def _here(plan, folder, left):
    for number in left:
        parts.write(plan, folder, number, answered(plan, number).tobytes())
        yield number


def _finished(plan: Plan, records: np.ndarray, resumed: int) -> Swept:
    bad = records["valid"] == 0
    if not bad.any():
        return Swept(plan, records, resumed)
    first = int(np.flatnonzero(bad.transpose((*plan.outer, *plan.inner)).reshape(plan.scenes, -1)[:, 0])[0])
    try:
        case_of(plan, first)
        why = ""
    except InputError as error:
        why = str(error).splitlines()[0]
    if bad.all():
        raise InputError(f"none of the {plan.points:,} points makes a case: {why}")
    return Swept(plan, records, resumed, int(bad.sum()), why)


@contextmanager
def _counted(plan: Plan, points: int) -> Iterator[Callable[[int], None]]:
    """tell(points of a chunk that is finished): a terminal hears of the rate and of the time that remains."""
    begin, done = time.monotonic(), 0
    with Progress() as progress:
        def tell(more: int) -> None:
            nonlocal done
            done += more
            gone = time.monotonic() - begin
            rate = done / gone if gone else 0.0
            remains = f", about {_time((points - done) / rate)} left" if rate and done < points else ""
            progress(f"{plan.points - points + done:,} of {plan.points:,} points, {rate:,.0f} a second{remains}")
        yield tell


def _time(seconds: float) -> str:
    return f"{seconds:.0f} s" if seconds < 120 else f"{seconds / 60:.0f} min" if seconds < 7200 else f"{seconds / 3600:.1f} h"
