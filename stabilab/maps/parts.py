"""What is finished of a sweep: a folder beside its file with a part for every chunk, whole or absent.

A part is the records of a chunk as they lie in memory, with a digest of them and of the sweep before them. The folder says of which sweep it is, and by
which command; a run that was killed leaves it there, and the same command goes on from it. Refinements, each a sweep, have folders of their own.
"""
from __future__ import annotations

import hashlib
import json
import re
import shlex
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from glob import escape
from pathlib import Path

import numpy as np

from ..errors import InputError, printable
from ..files import alone_in, whole_file
from ..interrupt import undoing
from .columns import record
from .plan import Plan

PLAN = "sweep.json"
DIGEST = 32  # bytes in front of a part


def place_of(out: Path) -> Path:
    """The folder of the parts of a file."""
    return out.with_name(f"{out.name}.parts")


@contextmanager
def kept(plan: Plan, folder: Path, command: str = "") -> Iterator[Path]:
    """The folder for the parts of this sweep alone, made where it is not there. command: that asks for it, if it is part of something else. Raises
    InputError where the folder holds another sweep, or another run is at it."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with alone_in(folder, wait=False):
            with undoing(partial(_remove_if_empty, folder)):
                try:
                    _claim(plan, folder, command or plan.command)
                    yield folder
                finally:
                    _remove_if_empty(folder)
    except BlockingIOError:
        raise InputError(f"{folder}: another run is at work on this sweep: wait for it, or give another --out") from None
    except OSError as error:
        if error.filename is None or Path(error.filename) not in (folder, *folder.parents):
            raise
        raise InputError(f"{folder}: cannot be written: {error.strerror or error}") from None


def _remove_if_empty(folder: Path) -> None:
    """Where nothing is finished, there is nothing to keep."""
    if (folder / PLAN).exists() and not any(folder.glob("part-*")):
        remove(folder)
    elif folder.is_dir() and not any(folder.iterdir()):
        folder.rmdir()


def _claim(plan: Plan, folder: Path, command: str) -> None:
    claim = folder / PLAN
    if not claim.exists() and any(not entry.name.startswith(".") for entry in folder.iterdir()):
        raise InputError(f"{folder}: holds files that are no sweep's, and would be removed with its parts: move them, or give another --out")
    if claim.exists() and any(folder.glob("part-*")):  # of one killed before its first part nothing is lost
        if plan.digest not in claim.read_text(encoding="utf-8"):
            raise InputError(_of_another(folder, claim, command))
        return
    with whole_file(claim) as waiting:
        waiting.write_text(json.dumps({"digest": plan.digest, "command": command}) + "\n", encoding="utf-8")


def _of_another(folder: Path, claim: Path, command: str) -> str:
    """What stands there, how it goes on, and how it is replaced."""
    try:
        told = json.loads(claim.read_text(encoding="utf-8"))["command"]
    except (ValueError, TypeError, KeyError):  # an older version did not say
        told = None
    file = re.sub(r"(\.\d+)?\.parts$", "", folder.name)
    folders = sorted(path for path in folder.parent.glob(f"{escape(file)}*.parts") if re.fullmatch(r"(\.\d+)?\.parts", path.name.removeprefix(file)))
    number = sum(1 for path in folders for _ in path.glob("part-*"))
    if told == command:
        what = "this command, before the case file or the program changed"
    else:
        what = f"another command, which goes on from them: {printable(told)} --out {file}" if told else "another command or version"
    return f"{folder}: holds finished parts ({number}) of {what}; to replace them: rm -r {shlex.join(map(str, folders))}; or give another --out"


def write(plan: Plan, folder: Path, number: int, rows: bytes) -> None:
    """Put a part into the folder, whole."""
    with whole_file(_path(folder, number)) as waiting:
        waiting.write_bytes(_digest(plan, number, rows) + rows)


def read(plan: Plan, folder: Path, number: int) -> np.ndarray | None:
    """The records of a chunk; None where its part is not there, or is not whole (a power cut)."""
    try:
        found = _path(folder, number).read_bytes()
    except FileNotFoundError:
        return None
    rows = found[DIGEST:]
    return np.frombuffer(rows, record(plan.answers)) if _digest(plan, number, rows) == found[:DIGEST] else None


def _digest(plan: Plan, number: int, rows: bytes) -> bytes:
    """Of the rows as those of this chunk of this sweep: a worker that outlived another run may have left a part."""
    return hashlib.sha256(f"{plan.digest} {number} ".encode() + rows).digest()


def missing(plan: Plan, folder: Path) -> list[int]:
    """The chunks that are not finished, in order."""
    return [number for number in range(len(plan.chunks)) if read(plan, folder, number) is None]


def whole(plan: Plan, folder: Path) -> np.ndarray:
    """All records in the user's order, of the shape of the sweep; in one row where places are listed."""
    rows = np.concatenate([read(plan, folder, number) for number in range(len(plan.chunks))])
    if plan.listed:
        return rows
    order = (*plan.outer, *plan.inner)
    return rows.reshape([plan.shape[n] for n in order]).transpose(np.argsort(order))


def remove(folder: Path) -> None:
    """Remove the parts: the file that they make is there."""
    shutil.rmtree(folder, ignore_errors=True)


def _path(folder: Path, number: int) -> Path:
    return folder / f"part-{number:07d}"
