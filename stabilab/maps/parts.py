"""The points of a sweep as cases, answered in chunks; and what is finished of it, a folder beside its file
with a part for every chunk, whole or absent.

A part is the records of a chunk as they lie in memory, with a digest of them and of the sweep before them.
The folder says of which sweep it is, and by which command; a run that was killed leaves it there, and the
same command goes on from it. Refinements, each a sweep, have folders of their own.
"""
from __future__ import annotations

import hashlib
import json
import shlex
import shutil
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from glob import escape
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..answers.caveats import CONDITIONS, STEADY, condition
from ..case.lines import KeyLines
from ..case.read import Case, blamed_on, with_data
from ..case.table import Faults, Table, Written
from ..errors import CaseError, InputError, Kind, printable
from ..files import alone_in, whole_file
from ..interrupt import undoing
from ..orbit.result import Fate
from ..physics.coefficients import effective
from . import blocks
from .axes import Key, with_values
from .columns import ALL, CAVEATS, Column, columns_of, record
from .plan import Chunk, Plan

if TYPE_CHECKING:
    from types import ModuleType


# --- The cases and states of a sweep's points: a case for every scene, rows of rates for the states of one
def case_of(plan: Plan, scene: int) -> Case:
    """The case of a scene, with the first of its states. Raises CaseError where its numbers make none."""
    if plan.pointed is not None:
        return plan.pointed.case(plan.case, scene)
    places = np.unravel_index(scene, [plan.shape[n] for n in plan.outer]) if plan.outer else ()
    values: list[tuple[Key, str]] = []
    for n, at in zip(plan.outer, map(int, places)):
        if n < len(plan.axes):
            values.append((plan.axes[n].key, plan.axes[n].written(at)))
        else:
            row = plan.sampled.values(at, at + 1)[0].tolist()
            values += zip(plan.sampled.keys, (Written(repr(value)) for value in row))
    return with_data(plan.path, plan.text, with_values(plan.data, values), plan.burn is not None)


def states_of(plan: Plan, case: Case, low: int, high: int) -> np.ndarray:
    """(high - low, 3): states of a scene in its own variables, along its principal axes."""
    if not plan.inner:
        return np.array([case.state], float)
    shape = [plan.shape[n] for n in plan.inner]
    return states_at(plan, case, np.unravel_index(plan.places(low, high), shape))


def states_at(plan: Plan, case: Case, places: Sequence[np.ndarray], moved: int = -1,
              part: np.ndarray | float = 0.0) -> np.ndarray:
    """(n, 3): the same of the points at `places`, (n,) along each inner dimension, each moved by a share of
    the way to the next along the dimension `moved`."""
    first = plan.inner[0]
    varied = plan.axes[first].key if first < len(plan.axes) else plan.sampled.keys[0]
    motion_table = Table(("motion",), plan.data["motion"], Faults(KeyLines()))
    states = np.tile([float(value) for value in motion_table.vector(varied.paths[0][1])], (len(places[0]), 1))
    for n, at in zip(plan.inner, places):
        if n < len(plan.axes):
            values = np.array(plan.axes[n].si)
            ahead = values[np.minimum(at + 1, len(values) - 1)] - values[at]
            states[:, plan.axes[n].key.paths[0][2]] = values[at] + ahead * part if n == moved else values[at]
        else:
            begin = int(at.min())
            rows = plan.sampled.values(begin, int(at.max()) + 1)[at - begin]
            for column, sampled in zip(rows.T, plan.sampled.keys):
                states[:, sampled.paths[0][2]] = column
    frame = case.frame
    if frame is None or frame.as_given:
        return states
    # sums in one order, whatever library would multiply matrices
    x, y, z = states.T
    return np.stack([(float(a) * x + float(b) * y) + float(c) * z for a, b, c in frame.axes], axis=1)


# --- The answers for a chunk of points, in rows of one record each
def answered(plan: Plan, number: int) -> np.ndarray:
    """(points,) of `columns.record`: the answers for a chunk, in the inner order."""
    chunk = plan.chunks[number]
    rows = np.zeros(chunk.points, record(plan.answers))
    size = chunk.high - chunk.low
    for n, scene in enumerate(range(chunk.first, chunk.last)):
        _scene(plan, scene, chunk, rows[n * size:(n + 1) * size])
    return rows


def _scene(plan: Plan, scene: int, chunk: Chunk, out: np.ndarray) -> None:
    """Put the answers for the states of a scene that the chunk has into their records."""
    columns = columns_of(plan.answers)
    for column in columns:
        out[column.name] = column.default
    try:
        case = case_of(plan, scene)
    except CaseError:
        return
    out["valid"], filled = 1, {"valid"}
    with blamed_on(case):
        states = np.empty((0, 3)) if case.state is None else states_of(plan, case, chunk.low, chunk.high)
        for module in dict.fromkeys(map(_filling, plan.answers)):
            own = [column for name in plan.answers if _filling(name) is module
                   for column in ALL[name].columns]
            _fill(module, plan, case, states, own, out)
            filled.update(column.name for column in own)
    if CAVEATS in columns:
        out["caveats"] = _caveats(case, states, out)
        filled.add("caveats")
    if empty := [column.name for column in columns if column.name not in filled]:
        raise NotImplementedError(f"nobody fills the columns {', '.join(empty)}")


def _filling(answer: str) -> Any:
    """The module that fills the columns of an answer."""
    return import_module(f".filling.{ALL[answer].module}", __package__)


def _fill(module: ModuleType, plan: Plan, case: Case, states: np.ndarray, columns: Sequence[Column],
          out: np.ndarray) -> None:
    """Put what a module finds into its columns: of all states at once, or of one after another where their
    scene has no arrays."""
    if effective(case.scene).plain or module.of_one is None:
        result = module.of_many(plan, case, states)
        for column in columns:
            out[column.name] = column.many(result)
        return
    for n, state in enumerate(states.tolist()):
        here = replace(case, state=tuple(state)) if tuple(state) != case.state else case
        result = module.of_one(plan, here)
        for column in columns:
            out[column.name][n] = column.one(result)


def _caveats(case: Case, states: np.ndarray, out: np.ndarray) -> np.ndarray:
    """Of each point, by its place in `columns.CAVEATS`."""
    count = len(CONDITIONS)
    departs, steady = np.zeros((2, len(out)), bool)
    if "fate" in out.dtype.names:
        steady, rests = np.isin(out["fate"], STEADY), np.nonzero(out["fate"] == Fate.EQUILIBRIUM)[0]
        if len(rests):
            departs[rests] = _filling("fate").depart(case, states[rests])
    if "when_low" in out.dtype.names:
        steady |= np.isposinf(out["when_low"])
    unphysical = any(caveat.kind is Kind.UNPHYSICAL for caveat in case.caveats)
    return np.where(steady, condition(case.scene), 0) + count * unphysical + 2 * count * departs


# --- The parts of a sweep, a folder beside its file
PLAN = "sweep.json"
RECORDS = ".records"  # all of a large sweep, put together
PARTS = ".parts"  # what the name of a folder has behind that of its file
DIGEST = 32  # bytes in front of a part


def place_of(out: Path) -> Path:
    """The folder of the parts of a file."""
    return out.with_name(f"{out.name}{PARTS}")


def file_of(folder: Path) -> str:
    """The name of the file whose parts a folder holds, without the number of one of several."""
    file = folder.name.removesuffix(PARTS)
    stem, _, number = file.rpartition(".")
    return stem if stem and number.isdecimal() else file


@contextmanager
def kept(plan: Plan, folder: Path, command: str = "") -> Iterator[Path]:
    """The folder for the parts of this sweep alone, made where it is not there. command: that asks for it, if
    it is part of something else. Raises InputError where the folder holds another sweep, or another run is at
    it."""
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
        raise InputError(
            f"{folder}: another run is at work on this sweep: wait for it, or give another --out") from None
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
    """Write down whose folder this is; InputError where it is somebody else's."""
    claim = folder / PLAN
    if not claim.exists() and any(not entry.name.startswith(".") for entry in folder.iterdir()):
        raise InputError(f"{folder}: holds files that are no sweep's, and would be removed with its parts: "
                         "move them, or give another --out")
    if claim.exists() and any(folder.glob("part-*")):  # of one killed before its first part nothing is lost
        if plan.digest not in claim.read_text(encoding="utf-8"):
            raise _of_another(folder, claim, command)
        return
    with whole_file(claim) as waiting:
        waiting.write_text(json.dumps({"digest": plan.digest, "command": command}) + "\n", encoding="utf-8")


def _of_another(folder: Path, claim: Path, command: str) -> InputError:
    """What stands there, how it goes on, and how it is replaced."""
    try:
        printed = json.loads(claim.read_text(encoding="utf-8"))["command"]
    except (ValueError, TypeError, KeyError):  # an older version did not say
        printed = None
    file = file_of(folder)
    folders = sorted(path for path in folder.parent.glob(f"{escape(file)}*{PARTS}") if file_of(path) == file)
    number = sum(1 for path in folders for _ in path.glob("part-*"))
    if printed == command:
        what = "this command, before the case file or the program changed"
    else:
        what = ("another command, which goes on from them: " + f"{printable(printed)} --out {file}" if printed
                else "another command or version")
    return InputError(f"{folder}: holds finished parts ({number}) of {what}; to replace them: rm -r "
                      f"{shlex.join(map(str, folders))}; or give another --out")


def write(plan: Plan, folder: Path, number: int, rows: bytes) -> None:
    """Put a part into the folder, whole."""
    with whole_file(_path(folder, number)) as waiting:
        waiting.write_bytes(_digest(plan, number, rows) + rows)


def read(plan: Plan, folder: Path, number: int) -> np.ndarray | None:
    """The records of a chunk; None where its part is not there, or is not whole (a power cut)."""
    try:
        result = _path(folder, number).read_bytes()
    except FileNotFoundError:
        return None
    rows = result[DIGEST:]
    return (np.frombuffer(rows, record(plan.answers)) if _digest(plan, number, rows) == result[:DIGEST]
            else None)


def _digest(plan: Plan, number: int, rows: bytes) -> bytes:
    """Of the rows as those of this chunk of this sweep: a worker that outlived another run may have left a
    part."""
    return hashlib.sha256(f"{plan.digest} {number} ".encode() + rows).digest()


def missing(plan: Plan, folder: Path) -> list[int]:
    """The chunks that are not finished, in order."""
    return [number for number in range(len(plan.chunks)) if read(plan, folder, number) is None]


def whole(plan: Plan, folder: Path, in_file: bool = False) -> np.ndarray:
    """All records in the user's order, of the shape of the sweep; in one row where places are listed.
    in_file: whether those of a large sweep lie in a file of the folder instead of in memory."""
    dtype, end = record(plan.answers), 0
    large = in_file and plan.points >= blocks.LARGE and blocks.can_map()
    rows = (blocks.mapped(folder / RECORDS, plan.points, dtype) if large else np.empty(plan.points, dtype))
    for number, chunk in enumerate(plan.chunks):  # one at a time: two copies of a large sweep are too many
        rows[end:end + chunk.points] = read(plan, folder, number)
        end += chunk.points
        blocks.given_back(rows)
    if plan.listed:
        return rows
    order = (*plan.outer, *plan.inner)
    return rows.reshape([plan.shape[n] for n in order]).transpose(np.argsort(order))


def remove(folder: Path) -> None:
    """Remove the parts: the file that they make is there."""
    shutil.rmtree(folder, ignore_errors=True)


def _path(folder: Path, number: int) -> Path:
    return folder / f"part-{number:07d}"
