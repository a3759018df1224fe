"""Tasks that share nothing, done by this process and by others like it, the dearest first: each writes its
own files, so that it is all one who does it.

A task is a function of a module and its arguments. All of them stand in one file; whoever is free takes the
next one by making a file of its number, which only one can. What a helper could not do is done again here, so
that its error comes to light as any other.
"""
from __future__ import annotations

import os
import pickle
import subprocess
import sys
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path

from ...errors import StabilabError
from ...interrupt import end_with_parent
from ...processes import cores, helpers

PLACE = ".tasks"  # folder inside that of the report, removed at the end
MOST = 4          # helpers need memory too: some 400 MB each


@dataclass(frozen=True)
class Task:
    """words: what it does, for the one who waits; home: "module:function" below `stabilab`, called with
    `arguments`; weight: s it takes, roughly."""

    words: str
    home: str
    arguments: tuple
    weight: float = 1.0


def done(tasks, folder: Path, tell, workers: int | None = None) -> list:
    """What the tasks give, in their order. workers: processes in all, this one counted; None: one a core."""
    number = min(cores() if workers is None else workers, MOST, len(tasks))
    if number < 2:
        return [_told(task, tell) for task in tasks]
    place = folder / PLACE
    place.mkdir()
    order = sorted(range(len(tasks)), key=lambda n: -tasks[n].weight)
    (place / "tasks").write_bytes(pickle.dumps(tasks))
    found: dict = {}
    # they do tasks until none is left
    with helpers(__name__, place, number - 1, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as others:
        for n in order:
            if _taken(place, n):
                found[n] = _told(tasks[n], tell)
        for helper in others:
            tell("what is under way")
            helper.wait()
            helper.stdin.close()
    for n in order:
        if n not in found:
            found[n] = _left(place, n, tasks[n], tell)
    for file in place.iterdir():
        file.unlink()
    place.rmdir()
    return [found[n] for n in range(len(tasks))]


def _told(task, tell):
    tell(task.words)
    return run(task)


def run(task):
    """What a task gives."""
    module, _, function = task.home.partition(":")
    return getattr(import_module(f"stabilab.{module}"), function)(*task.arguments)


def _taken(place, n) -> bool:
    """Take a task, if nobody has."""
    try:
        os.close(os.open(place / f"taken-{n}", os.O_CREAT | os.O_EXCL | os.O_WRONLY))
        return True
    except FileExistsError:
        return False


def _left(place, n, task, tell):
    """What a helper left of a task, or, where it failed, the task once more."""
    try:
        return pickle.loads((place / f"made-{n}").read_bytes())
    except (OSError, EOFError, pickle.UnpicklingError):
        return _told(task, tell)


def main(place: Path) -> None:
    """What a helper does: the same list in the same order, whatever is not taken yet."""
    end_with_parent()
    tasks = pickle.loads((place / "tasks").read_bytes())
    for n in sorted(range(len(tasks)), key=lambda n: -tasks[n].weight):
        if not _taken(place, n):
            continue
        try:
            made = pickle.dumps(run(tasks[n]))
        except StabilabError:
            continue  # done again where it can be told
        waiting = place / f"making-{n}"
        waiting.write_bytes(made)
        waiting.rename(place / f"made-{n}")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
