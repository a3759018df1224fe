"""A sweep run by processes of this machine or a Dask cluster, and where its fates change.

On Dask the chunks go to the workers of a scheduler that is there already: numbers go out, records come
back, this process writes the parts.

The workers need no common disk. One that dies costs the chunks it was at, which others do again; who computes
a chunk does not change its bytes."""
from __future__ import annotations

import os
import queue
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, NoReturn

import numpy as np

from ..answers.motions.rows import fates
from ..errors import InputError, StabilabError, printable
from ..files import whole_file
from ..interrupt import end_with_parent, undoing
from ..numbers.bracket import halved_each
from ..orbit.result import Fate
from ..packages import demand
from ..physics.coefficients import effective
from ..processes import cores, helpers
from ..streams import Progress
from ..version import __version__
from . import parts
from .blocks import blocks
from .parts import answered, case_of, states_at
from .plan import Plan, from_json

ADDRESS = re.compile(r"\w+://[^\s/]+:\d+")
ANSWER_SECONDS = 10  # seconds in which a scheduler answers, and its first worker shows up
# chunks that wait at each thread of a worker: none is idle, and no more records lie about than that
AHEAD = 3


def by_cluster(plan: Plan, folder: Path, left: list[int], address: str) -> Iterator[int]:
    """The chunks `left`, computed by the workers of the scheduler at `address`, each as soon as its part is
    there. Raises InputError where no scheduler answers, where it has no worker, and where one lacks this
    version of stabilab."""
    demand("distributed")
    from distributed import as_completed
    client = _client(address)
    try:
        threads = _checked(client, address)
        text, waiting = plan.as_json(), iter(left)
        request = {}

        def ask() -> Any:
            number = next(waiting, None)
            if number is None:
                return None
            future = client.submit(computed, text, number, pure=False)
            request[future.key] = number
            return future
        first = [ask() for _ in range(max(2, AHEAD * threads))]
        running = as_completed([future for future in first if future is not None], loop=client.loop)
        for future in running:
            number = request.pop(future.key)
            parts.write(plan, folder, number, _records(future, address))
            if (more := ask()) is not None:
                running.add(more)
            yield number
    finally:
        client.close(timeout=ANSWER_SECONDS)


def computed(text: str, number: int) -> tuple[str, bytes | str]:
    """What a worker does: ("records", bytes) of a chunk of the plan, or ("fault", words) of what the case has
    wrong."""
    try:
        return "records", answered(from_json(text), number).tobytes()
    except StabilabError as error:
        return "fault", str(error)


def _client(address: str) -> Any:
    import logging

    from distributed import Client
    if not ADDRESS.fullmatch(address):
        raise InputError(
            f"scheduler: expected an address such as tcp://127.0.0.1:8786, got {printable(address)[:80]}")
    # of a scheduler that is gone it would print a page
    logging.getLogger("distributed").setLevel(logging.CRITICAL)
    try:
        return Client(address, timeout=ANSWER_SECONDS, set_as_default=False)
    except (OSError, TimeoutError, ValueError, ImportError) as error:
        raise InputError(f"scheduler {printable(address)[:80]}: does not answer ({_first_line(error)}): "
                         f"start one with `dask scheduler` and give the "
                         "address that it prints, such as tcp://127.0.0.1:8786") from None


def _checked(client: Any, address: str) -> int:
    """How many threads the workers have, once every worker is known to have this version."""
    from importlib.metadata import version
    try:
        client.wait_for_workers(1, timeout=ANSWER_SECONDS)
    except TimeoutError:
        raise InputError(f"scheduler {printable(address)[:80]}: has no workers: start some with `dask worker "
                         f"{printable(address)[:60]}`") from None
    result = client.run(version, "stabilab", on_error="return")
    for worker, answer in result.items():
        if answer != __version__:
            raise InputError(
                (f"worker {worker}: has stabilab {answer}" if isinstance(answer, str)
                 else f"worker {worker}: lacks the package stabilab ({_first_line(answer)})")
                + f": install stabilab {__version__} there, as here, with the same libraries")
    return sum(client.nthreads().values())


def _records(future: Any, address: str) -> bytes:
    """The bytes of a chunk that is done."""
    try:
        kind, what = future.result()
    except Exception as error:  # of any kind that a worker's environment may raise
        name = type(error).__name__
        if name == "KilledWorker":
            why = "one chunk after another lost its worker: they may have run out of memory"
        elif isinstance(error, ImportError):
            why = f"a worker lacks a package: {_first_line(error)}"
        else:
            why = f"{name}: {_first_line(error)}"
        raise InputError(f"scheduler {printable(address)[:80]}: {why}; finished chunks are kept where --out "
                         "names a file, and the same command goes on from them") from None
    if kind == "fault":
        raise InputError(what)
    return what


def _first_line(error: BaseException) -> str:
    lines = str(error).strip().splitlines()
    return printable(lines[0])[:160] if lines else type(error).__name__


# --- Processes on this machine that compute chunks: each is given a number, writes the part, and says that
# it did
DONE, FAILED, WORK = "done", "failed", "work.json"


class WorkerLost(StabilabError):
    """A worker ended before its work did."""

    exit_code = InputError.exit_code


def by_workers(plan: Plan, folder: Path, left: list[int], number: int) -> Iterator[int]:
    """The chunks `left`, computed by `number` processes, each as soon as its part is there. Raises what a
    worker found wrong, and WorkerLost where one ended."""
    waiting: queue.SimpleQueue[int] = queue.SimpleQueue()
    printed: queue.SimpleQueue[tuple[str, Any]] = queue.SimpleQueue()
    for chunk in left:
        waiting.put(chunk)
    with whole_file(folder / WORK) as work:
        work.write_text(plan.as_json(), encoding="utf-8")
    with helpers(__name__, folder, number, stdout=subprocess.PIPE, text=True, encoding="utf-8") as workers:
        for worker in workers:
            threading.Thread(target=_feed, args=(worker, waiting, printed), daemon=True).start()
        for _ in left:
            word, what = printed.get()
            if word == FAILED:
                if isinstance(what, StabilabError):
                    raise what
                _raise_lost(plan, folder, *what)
            yield what


def _raise_lost(plan: Plan, folder: Path, chunk: int, code: int) -> NoReturn:
    why = f"signal {-code} ({signal.Signals(-code).name})" if code < 0 else f"exit code {code}"
    cure = "; it may have run out of memory: try fewer --workers" if code == -signal.SIGKILL else ""
    raise WorkerLost(f"{folder}: a worker ended by {why} while it computed chunk {chunk + 1} of "
                     f"{len(plan.chunks)}{cure}; finished chunks are kept where --out names "
                     "a file, and the same command goes on from them")


def _feed(worker, waiting, printed) -> None:
    """Hand chunks to one process as long as there are any."""
    while True:
        try:
            chunk = waiting.get_nowait()
        except queue.Empty:
            return
        try:
            worker.stdin.write(f"{chunk}\n")
            worker.stdin.flush()
            answer = worker.stdout.readline()
        except OSError:
            answer = ""
        word, _, rest = answer.rstrip("\n").partition(" ")
        if word == DONE:
            printed.put((DONE, int(rest)))
            continue
        printed.put((FAILED, InputError(rest.replace("\x1f", "\n")) if word == FAILED
                  else (chunk, worker.wait())))
        return


def main(folder: Path) -> NoReturn:
    """What a worker does: numbers in, parts into the folder, until whoever started it ends it or is gone."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the one that started it hears of it, and ends it
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)  # what a library prints is no answer
    request: queue.SimpleQueue[bytes] = queue.SimpleQueue()
    end_with_parent(request.put)
    plan = from_json((folder / WORK).read_text(encoding="utf-8"))
    while True:
        number = int(request.get())
        try:
            parts.write(plan, folder, number, answered(plan, number).tobytes())
            answers.write(f"{DONE} {number}\n")
        except StabilabError as error:
            answers.write(f"{FAILED} {str(error)}\n".replace("\n", "\x1f", str(error).count("\n")))
        answers.flush()


if __name__ == "__main__":
    main(Path(sys.argv[1]))


# --- Running a sweep: which chunks are left, who computes them, and how far it is
WORTH = 3.0  # seconds of work for which another process is worth its start


@dataclass(frozen=True)
class Swept:
    """records: of the shape of the plan's sweep; resumed: points that an earlier run had finished; broken:
    numbers that make no case; fault: of the first of them."""

    plan: Plan
    records: np.ndarray
    resumed: int = 0
    broken: int = 0
    fault: str = ""


@contextmanager
def run(plan: Plan, out: Path | None = None, workers: int | None = None, scheduler: str | None = None,
        command: str = "", in_file: bool = False) -> Iterator[Swept]:
    """The finished sweep as a context; the parts of `out` are removed when its block ends well, and stay
    otherwise. out: the file that the parts are for, None to keep none. workers: processes on this machine;
    None: one a core where that pays. scheduler: address of a Dask scheduler whose workers do it instead.
    command: of what the sweep is part of; in_file: whether the records of a large one may lie in a file."""
    if workers is not None and (isinstance(workers, bool) or not isinstance(workers, int) or workers < 1):
        raise InputError(f"workers: expected a number of processes of at least 1, got {workers!r:.40}")
    with _folder(plan, out, command) as folder:
        left = parts.missing(plan, folder)
        points = sum(plan.chunks[number].points for number in left)
        with _counted(plan, points) as tell:
            for number in _makers(plan, folder, left, workers, scheduler):
                tell(plan.chunks[number].points)
        yield _finished(plan, parts.whole(plan, folder, in_file), plan.points - points)
        if out is not None:
            parts.remove(folder)


@contextmanager
def _folder(plan, out, command):
    if out is not None:
        with parts.kept(plan, parts.place_of(Path(out)), command) as folder:
            yield folder
    else:
        with tempfile.TemporaryDirectory(prefix="stabilab-") as folder, undoing(
            partial(shutil.rmtree, folder, True)):
            yield Path(folder)


def _makers(plan: Plan, folder: Path, left: list[int], workers: int | None,
            scheduler: str | None) -> Iterable[int]:
    """The chunks left, each as soon as its part is there."""
    if scheduler is not None:
        return by_cluster(plan, folder, left, scheduler)
    # processes that have something to do besides starting
    enough = int(sum(plan.chunks[n].points for n in left) * plan.cost / WORTH)
    number = min(max(1, min(cores(), enough)) if workers is None else workers, len(left))
    return by_workers(plan, folder, left, number) if number > 1 else _here(plan, folder, left)


def _here(plan: Plan, folder: Path, left: Sequence[int]):
    for number in left:
        parts.write(plan, folder, number, answered(plan, number).tobytes())
        yield number


def _finished(plan: Plan, records: np.ndarray, resumed: int) -> Swept:
    bad, first, looked = 0, -1, 0
    for block in blocks(records["valid"]):  # scene by scene
        broken = block == 0
        if first < 0 and broken.any():
            first = (looked + int(np.argmax(broken))) // (plan.points // plan.scenes)
        bad, looked = bad + int(broken.sum()), looked + len(block)
    if not bad:
        return Swept(plan, records, resumed)
    try:
        case_of(plan, first)
        why = ""
    except InputError as error:
        why = str(error).splitlines()[0]
    if bad == plan.points:
        raise InputError(f"none of the {plan.points:,} points makes a case: {why}")
    return Swept(plan, records, resumed, bad, why)


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
            progress(
                f"{plan.points - points + done:,} of {plan.points:,} points, {rate:,.0f} a second{remains}")
        yield tell


def _time(seconds: float) -> str:
    return (f"{seconds:.0f} s" if seconds < 120 else f"{seconds / 60:.0f} min" if seconds < 7200
            else f"{seconds / 3600:.1f} h")


# --- Where the fate changes along the lines of a map: on the separatrix itself where states alone vary,
# else where the margin is zero
HALVINGS = 40  # of a line between two points of a map


def known_exactly(plan: Plan, first: int, second: int) -> bool:
    """Whether states alone vary along the two dimensions, in a scene whose fates come in arrays."""
    return ({first, second} <= set(plan.inner) and effective(plan.case.scene).plain
            and all(n < len(plan.axes) for n in plan.inner))


def changes(plan: Plan, index: tuple[int, ...], dimension: int, lower: np.ndarray, spun: np.ndarray,
            halvings: int = HALVINGS) -> np.ndarray:
    """(lines,): at what share of the way from a point to the next along `dimension` the fate changes.

    index: the place along every dimension of the points, in rows (lines, dimensions) by `lower`; spun:
    whether the lower point spins up. By halving the line, each half asked for its fate: to the last digits of
    a picture and beyond.
    """
    shape = [plan.shape[n] for n in plan.outer]
    case = case_of(plan, int(np.ravel_multi_index([index[n] for n in plan.outer], shape)) if shape else 0)
    places = [lower[:, n] for n in plan.inner]

    def same_at(shares: np.ndarray) -> np.ndarray:
        states = states_at(plan, case, places, dimension, shares)
        return (fates(case.scene, states).labels == Fate.SPIN_UP) == spun
    low, high = halved_each(same_at, np.zeros(len(lower)), np.ones(len(lower)), halvings)
    return 0.5 * (low + high)
