"""The points of a sweep as cases, answered in chunks; and what is finished of it, a folder beside its file
with a part for every chunk, whole or absent.

A part is the records of a chunk as they lie in memory, with a digest of them and of the sweep before them.
The folder says of which sweep it is, and by which command; a run that was killed leaves it there, and the
same command goes on from it. Refinements, each a sweep, have folders of their own.
"""
from __future__ import annotations

import hashlib
import json
import re
import shlex
import shutil
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from glob import escape
from pathlib import Path
from typing import Any

import numpy as np

from ..answers.caveats import CONDITIONS, STEADY, condition
from ..answers.chaos import chaos, long_enough, row_of
from ..answers.equilibria import equilibria
from ..answers.kinds import KINDS, kind_of
from ..answers.motion import motion
from ..answers.motions.rows import extremes, fates, periods
from ..answers.time_to import time_to
from ..case.lines import KeyLines
from ..case.read import Case, blamed_on, with_data
from ..case.table import Faults, Table, Written
from ..equilibrium.gyrostat import number_of_equilibria
from ..equilibrium.stability import coefficients as invariants_of
from ..errors import CaseError, InputError, Kind, printable
from ..files import alone_in, whole_file
from ..interrupt import undoing
from ..numbers.numba_door import installed
from ..orbit.extremes_arrays import extremes_and_periods
from ..orbit.result import Fate, Needs
from ..physics.coefficients import effective
from ..physics.states import start_of
from ..validation import reach_of
from .axes import Key, with_values
from .columns import ENDLESS, LEVELS, LIMIT_LEVELS, NO_CASE, NONE, OPEN, record
from .plan import Chunk, Plan


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
    return with_data(plan.path, plan.text, with_values(plan.data, values))


def states_of(plan: Plan, case: Case, low: int, high: int) -> np.ndarray:
    """(high - low, 3): states of a scene in its own variables, along its principal axes."""
    if not plan.inner:
        return np.array([case.state], float)
    shape = [plan.shape[n] for n in plan.inner]
    return states_at(plan, case, np.unravel_index(plan.places(low, high), shape))


def states_at(plan: Plan, case: Case, places: Sequence[np.ndarray], moved: int = -1,
              share: np.ndarray | float = 0.0) -> np.ndarray:
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
            states[:, plan.axes[n].key.paths[0][2]] = values[at] + ahead * share if n == moved else values[at]
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
COMPILED = 200  # states for which loading numba's code pays: half a second, of librations in plain Python
# multiplications for the proof of a time in an atlas: it leaves long motions to compiled steps, which prove
# them sooner
POINTED_WORK = 100_000
NO_CASE_VALUES = {"fate": NO_CASE, "level": -1, "reason": -1, "when_level": -1, "chaos": -1,
                  "equilibria": NONE, "stable": NONE, "unstable": NONE, "open": NONE}

PERIODS = {Fate.EQUILIBRIUM: 0.0, Fate.SPIN_UP: np.inf, Fate.SEPARATRIX: np.inf}  # of motions that have none


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
    try:
        case = case_of(plan, scene)
    except CaseError:
        for name in out.dtype.names:
            if out.dtype[name].base.kind == "f":
                out[name] = np.nan
            elif name in NO_CASE_VALUES:
                out[name] = NO_CASE_VALUES[name]
        return
    out["valid"] = 1
    states = np.empty((0, 3))
    with blamed_on(case):
        if case.state is not None:
            states = states_of(plan, case, chunk.low, chunk.high)
            if set(plan.answers) - {"chaos"}:
                (_many if effective(case.scene).plain else _single)(plan, case, states, out)
            if "chaos" in plan.answers:
                _chaos(plan, case, states, out)
        if "equilibria" in plan.answers or "verdict" in plan.answers:
            _equilibria(case, out)
    if "caveats" in out.dtype.names:
        out["caveats"] = _caveats(case, states, out)


def _caveats(case: Case, states: np.ndarray, out: np.ndarray) -> np.ndarray:
    """Of each point, by its place in `columns.CAVEATS`."""
    count = len(CONDITIONS)
    departs, steady = np.zeros((2, len(out)), bool)
    if "fate" in out.dtype.names:
        steady, rests = np.isin(out["fate"], STEADY), np.nonzero(out["fate"] == Fate.EQUILIBRIUM)[0]
        if len(rests):
            departs[rests] = _depart(case, states[rests])
    if "when_low" in out.dtype.names:
        steady |= np.isposinf(out["when_low"])
    unphysical = any(one.kind is Kind.UNPHYSICAL for one in case.caveats)
    return np.where(steady, condition(case.scene), 0) + count * unphysical + 2 * count * departs


def _depart(case: Case, states: np.ndarray) -> np.ndarray:
    """Which states (n, 3) of equilibrium are not known to be stable. Of a gyrostat by the signs of m and n in
    z^3 + m z + n, exactly where these are zero in doubles."""
    twin = effective(case.scene)
    open_ = np.ones(len(states), bool)
    if twin.plain:
        form, x = twin.quadratic(), states.T
        J = form.jacobian([*x], np.ones(len(states)))
        m, n = (np.asarray(v, float) for v in invariants_of(J))
        open_, found = (m == 0) | (n == 0) & (m > 0) & (form.m != (0, 0, 0)), (n != 0) | (m < 0)
    else:
        found = open_.copy()
    for row in np.nonzero(open_ & ~found if twin.plain else open_)[0].tolist():
        here = replace(case, state=tuple(states[row].tolist()))
        stability = motion(here.scene, here.start, needs=Needs.FATE).stability
        found[row] = stability is not None and not stability.stable
    return found


def _many(plan: Plan, case: Case, states: np.ndarray, out: np.ndarray) -> None:
    """The states of a scene whose answers come in arrays."""
    asked, scene = plan.answers, case.scene
    if {"fate", "level", "reason", "island", "margin", "distance"} & set(asked):
        many: dict[str, Any] = {}
        if plan.pointed is not None and KINDS[kind_of(effective(scene))].follows:
            # each motion of an atlas is alone in its scene, and all of them together are worth the compiler
            many = {"fast": installed() or None, "proof": plan.pointed.certify}
        found = fates(scene, states, follow=plan.longest, **many)
        columns: dict[str, Callable[[], Any]] = {
            "fate": lambda: found.labels, "spin_axis": lambda: found.axis * found.sense,
            "reason": lambda: found.reasons, "margin": lambda: found.margins,
            "level": lambda: found.level_numbers(LEVELS), "distance": lambda: found.velocity_margins,
            "island": lambda: 0 if found.followed is None else found.followed.islands}
        for name, column in columns.items():
            if name in out.dtype.names:
                out[name] = column()
    if {"extremes", "period"} & set(asked):
        _extremes_and_periods(case, states, "extremes" in asked, "period" in asked, out)
    if "when" in asked:
        limit = plan.limit_of(case)
        brief: dict[str, Any] = {} if plan.pointed is None or plan.pointed.certify else {"work": POINTED_WORK}
        _times(time_to(scene, states, **limit.ask, t_max=limit.until, **brief), out)


def _chaos(plan: Plan, case: Case, states: np.ndarray, out: np.ndarray) -> None:
    """All followed as long as the case's own motion is, whatever their company."""
    end = long_enough(plan.case.scene, row_of(plan.case.scene, plan.case.state, plan.case.blocks))
    rows = np.array([row_of(case.scene, state, case.blocks) for state in states.tolist()])
    found = chaos(case.scene, rows, end if plan.longest is None else plan.longest)
    out["chaos"], out["megno"], out["lyapunov"] = found.labels, found.megno, found.lyapunov


def _extremes_and_periods(case: Case, states: np.ndarray, box: bool, times: bool, out: np.ndarray) -> None:
    """Whether numba serves depends on the number of states alone, not on what this process did before: its
    last digits are not those of plain Python."""
    kind = kind_of(effective(case.scene))
    if kind == "orbit":
        found, repeats = extremes_and_periods(case.scene, states, box=box, period=times,
                                              by_numba=len(states) >= COMPILED)
    else:
        try:
            found = extremes(case.scene, states, reach_of(case.span)) if box else None
        except InputError:
            if not KINDS[kind].follows:
                raise
            found = np.full((*states.shape, 2), np.nan)  # no state of this scene has bounds
        repeats = periods(case.scene, states) if times else None
    if found is not None:
        out["least"], out["greatest"] = found[..., 0], found[..., 1]
    if repeats is not None:
        out["period"] = repeats


def _times(found, out: np.ndarray) -> None:
    out["when_low"], out["when_high"] = found.low, found.high
    out["when_level"] = [LIMIT_LEVELS.index(word) if word in LIMIT_LEVELS else 0
                         for word in np.ravel(found.level)]


def _single(plan: Plan, case: Case, states: np.ndarray, out: np.ndarray) -> None:
    """States that are answered one by one: liquid, medium, field."""
    for n, state in enumerate(states.tolist()):
        here = replace(case, state=tuple(state)) if tuple(state) != case.state else case
        needs = Needs.RETURN | (Needs.DISTANCE if "distance" in plan.answers else Needs.FATE)
        found = motion(here.scene, here.start, here.span, needs, here.exact_state, plan.longest)
        pairs = found.extremes or ((np.nan, np.nan),) * 3
        known = lambda value: np.nan if value is None else value
        columns = {"fate": found.fate, "spin_axis": found.axis * found.sense,
                   "level": LEVELS.index(found.level), "reason": -1,
                   "margin": known(found.margin_energy), "distance": known(found.margin_velocity),
                   "least": [low for low, _ in pairs],
                   "greatest": [high for _, high in pairs],
                   "period": PERIODS.get(found.fate, np.nan) if found.period is None else found.period}
        for name, value in columns.items():
            if name in out.dtype.names:
                out[name][n] = value
        if "when" in plan.answers:
            limit = plan.limit_of(here)
            _times(time_to(here.scene, start_of(here.scene, here.state, here.blocks), **limit.ask,
                           t_max=limit.until), out[n:n + 1])


def _equilibria(case: Case, out: np.ndarray) -> None:
    """Put the number of equilibria, and of each verdict, into the records that have a place for it."""
    if "stable" not in out.dtype.names and (number := number_of_equilibria(case.scene)) is not None:
        out["equilibria"] = number
        return
    found = equilibria(case)
    verdicts = ([point.verdict for point in found.points]
                + [piece.verdict for curve in found.curves for piece in curve.segments])
    number = {"none": 0, "points": len(found.points), "undecided": OPEN}.get(found.kind, ENDLESS)
    counts = {"equilibria": number, "stable": verdicts.count("stable"),
              "unstable": verdicts.count("unstable")}
    for name, value in (counts | {"open": len(verdicts) - counts["stable"] - counts["unstable"]}).items():
        if name in out.dtype.names:
            out[name] = value


PLAN = "sweep.json"
DIGEST = 32  # bytes in front of a part


def place_of(out: Path) -> Path:
    """The folder of the parts of a file."""
    return out.with_name(f"{out.name}.parts")


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
    folders = sorted(path for path in folder.parent.glob(f"{escape(file)}*.parts")
                     if re.fullmatch(r"(\.\d+)?\.parts", path.name.removeprefix(file)))
    number = sum(1 for path in folders for _ in path.glob("part-*"))
    if told == command:
        what = "this command, before the case file or the program changed"
    else:
        what = (f"another command, which goes on from them: {printable(told)} --out {file}" if told
                else "another command or version")
    return (
        f"{folder}: holds finished parts ({number}) of {what}; to replace them: rm -r "
        f"{shlex.join(map(str, folders))}; or give another --out")


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
    return (np.frombuffer(rows, record(plan.answers)) if _digest(plan, number, rows) == found[:DIGEST]
            else None)


def _digest(plan: Plan, number: int, rows: bytes) -> bytes:
    """Of the rows as those of this chunk of this sweep: a worker that outlived another run may have left a
    part."""
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
