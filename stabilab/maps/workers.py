"""Processes on this machine that compute chunks: each is told a number, writes the part, and says that it did."""
from __future__ import annotations

import os
import queue
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NoReturn

from ..errors import InputError, StabilabError
from ..files import whole_file
from ..interrupt import end_with_parent
from ..processes import helpers
from . import parts
from .chunk import answered
from .plan import Plan, from_json

DONE, FAILED, WORK = "done", "failed", "work.json"


class WorkerLost(StabilabError):
    """A worker ended before its work did."""

    exit_code = InputError.exit_code


def by_workers(plan: Plan, folder: Path, left: list[int], number: int) -> Iterator[int]:
    """The chunks `left`, computed by `number` processes, each as soon as its part is there. Raises what a worker found wrong, and WorkerLost where one
    ended."""
    waiting: queue.SimpleQueue[int] = queue.SimpleQueue()
    told: queue.SimpleQueue[tuple[str, Any]] = queue.SimpleQueue()
    for chunk in left:
        waiting.put(chunk)
    with whole_file(folder / WORK) as work:
        work.write_text(plan.as_json(), encoding="utf-8")
    with helpers(__name__, folder, number, stdout=subprocess.PIPE, text=True, encoding="utf-8") as workers:
        for worker in workers:
            threading.Thread(target=_feed, args=(worker, waiting, told), daemon=True).start()
        for _ in left:
            word, what = told.get()
            if word == FAILED:
                raise what if isinstance(what, StabilabError) else WorkerLost(_lost(plan, folder, *what))
            yield what


def _lost(plan: Plan, folder: Path, chunk: int, code: int) -> str:
    why = f"signal {-code} ({signal.Signals(-code).name})" if code < 0 else f"exit code {code}"
    cure = "; it may have run out of memory: try fewer --workers" if code == -signal.SIGKILL else ""
    return (f"{folder}: a worker ended by {why} while it computed chunk {chunk + 1} of {len(plan.chunks)}{cure}; finished chunks are kept where --out names "
            "a file, and the same command goes on from them")


def _feed(worker, waiting, told) -> None:
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
            told.put((DONE, int(rest)))
            continue
        told.put((FAILED, InputError(rest.replace("\x1f", "\n")) if word == FAILED else (chunk, worker.wait())))
        return


def main(folder: Path) -> NoReturn:
    """What a worker does: numbers in, parts into the folder, until whoever started it ends it or is gone."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the one that started it hears of it, and ends it
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)  # what a library prints is no answer
    asked: queue.SimpleQueue[bytes] = queue.SimpleQueue()
    end_with_parent(asked.put)
    plan = from_json((folder / WORK).read_text(encoding="utf-8"))
    while True:
        number = int(asked.get())
        try:
            parts.write(plan, folder, number, answered(plan, number).tobytes())
            answers.write(f"{DONE} {number}\n")
        except StabilabError as error:
            answers.write(f"{FAILED} {str(error)}\n".replace("\n", "\x1f", str(error).count("\n")))
        answers.flush()


if __name__ == "__main__":
    main(Path(sys.argv[1]))
