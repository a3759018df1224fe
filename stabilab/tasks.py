"""Tasks that share nothing, done by this process and by others like it, the dearest first: each writes its
own files, so that it is all one who does it.

A task is a function of a module and its arguments. All of them stand in one file; whoever is free takes the
next one by making a file of its number, which only one can. What a helper could not do is done again here, so
that its error comes to light as any other.
"""
from __future__ import annotations

import pickle
import shutil
import subprocess
import sys
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path

from . import rubbish
from .errors import StabilabError
from .interrupt import end_with_parent
from .processes import cores, helpers

PLACE = ".tasks"  # folder inside that of the results, removed at the end
MAX_WORKERS = 4          # helpers need memory too: some 400 MB each


@dataclass(frozen=True)
class Task:
    """label: what it does, for the one who waits; home: "module:function" below `stabilab`, called with
    `arguments`; weight: s it takes, roughly."""

    label: str
    home: str
    arguments: tuple
    weight: float = 1.0


def done(tasks, folder: Path, tell, workers: int | None = None) -> list:
    """What the tasks give, in their order. workers: processes in all, this one counted; None: one a core."""
    number = min(cores() if workers is None else workers, MAX_WORKERS, len(tasks))
    if number < 2:
        return [_told(task, tell) for task in tasks]
    index = folder / PLACE
    index.mkdir()
    (index / "tasks").write_bytes(pickle.dumps(tasks))
    # they do tasks until none is left
    with helpers(__name__, index, number - 1, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as others:
        entries = {n: _told(tasks[n], tell) for n in _taken(tasks, index)}
        for helper in others:
            tell("what is under way")
            helper.wait()
            helper.stdin.close()
    for n, task in enumerate(tasks):
        if n not in entries:  # a helper did it, or failed
            built = index / f"made-{n}"
            entries[n] = pickle.loads(built.read_bytes()) if built.exists() else _told(task, tell)
    shutil.rmtree(index)
    return [entries[n] for n in range(len(tasks))]


def _told(task, tell):
    tell(task.label)
    return run(task)


def run(task):
    """What a task gives."""
    module, _, function = task.home.partition(":")
    return getattr(import_module(f"stabilab.{module}"), function)(*task.arguments)


def _taken(tasks, location):
    """The numbers of tasks that nobody has taken when their turn comes, the dearest first."""
    for n in sorted(range(len(tasks)), key=lambda n: -tasks[n].weight):
        try:
            (location / f"taken-{n}").touch(exist_ok=False)
        except FileExistsError:
            continue
        yield n


def main(location: Path) -> None:
    """What a helper does: the same list in the same order, whatever is not taken yet."""
    end_with_parent()
    rubbish.seldom()
    tasks = pickle.loads((location / "tasks").read_bytes())
    for n in _taken(tasks, location):
        try:
            built = pickle.dumps(run(tasks[n]))
        except StabilabError:
            continue  # done again where it can be told
        waiting = location / f"making-{n}"
        waiting.write_bytes(built)
        waiting.rename(location / f"made-{n}")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
