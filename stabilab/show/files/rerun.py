"""Repeats the commands of a manifest and compares: which files come out the same, byte for byte."""
from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
from contextlib import contextmanager
from functools import partial
from pathlib import Path

from ...errors import NO_RENDERING, OK, InputError, StabilabError, ToleranceNotMet
from ...interrupt import undoing
from . import endings, manifest

COMMANDS = (["report"], ["figures"], ["tables"], ["surface"])
ENDED = (OK, NO_RENDERING)  # without a renderer everything but the pictures is written


def rerun(path, out=None) -> list[str]:
    """Repeat every command of the manifest (or folder) `path`, into the folder `out` or one that vanishes;
    the answer in a line, then then what became of each file, those that differ first. Raises InputError where
    inputs are missing or changed, ToleranceNotMet (with the lines) where files differ."""
    path = Path(path)
    runs = manifest.read(path)
    folder = (path if path.is_dir() else path.parent).resolve()
    for run in runs:
        if run["arguments"] is None:
            raise InputError(f"{path}: made by a call from Python, not by a command: it cannot be repeated")
        if run["arguments"][:1] not in COMMANDS:
            known = ", ".join(name for name, in COMMANDS)
            raise InputError(
                f"{path}: expected a command that fills a folder ({known}), got {run['command']!r}")
    starts = [_start(run, folder) for run in runs]
    lines: list[str] = []
    with _target(out) as target:
        for run, start in zip(runs, starts):
            _repeat(run["arguments"], start, target)
            lines += [run["command"], *_changed_surroundings(run)]
        made = {row["path"]: row["sha256"] for run in manifest.read(target) for row in run["outputs"]}
    words = {row["path"]: _compared(row, made) for run in runs for row in run["outputs"]}
    lines += [f"  {file}: {word}" for file, word in sorted(words.items(), key=lambda one: one[1] in SAME)]
    lines += [f"  {file}: new" for file in made if file not in words]
    differ, count = sum(word not in SAME for word in words.values()), len(words)
    if differ:
        raise ToleranceNotMet(
            "\n".join([f"{differ} of {count} files {'differs' if differ == 1 else 'differ'}", *lines]))
    return [f"all {count} files are accounted for: none differs", *lines]


TIMED = "not compared: it shows measured times"
SAME = ("identical", TIMED)


def _compared(row, made) -> str:
    if row["path"] not in made:
        return "did not come again"
    if row.get("timed"):
        return TIMED
    return "identical" if made[row["path"]] == row["sha256"] else "differs"


def _start(run, folder) -> Path:
    """The folder from which the command's paths lead to its inputs: where it was started, or else here.
    InputError names what changed."""
    faults = {}
    for start in ((folder / run["started_in"]).resolve(), Path.cwd()):
        faults[start] = [f"{row['path']}: {word}" for row in run["inputs"]
                         if (word := _judged(start / row["path"], row))]
        if start.is_dir() and not faults[start]:
            return start
    fewest = min(faults.values(), key=len) or ["the folder in which it was started is not there"]
    raise InputError("\n".join([f"{run['command']}: its inputs are not what they were", *fewest]))


def _judged(path, row) -> str:
    try:
        now = manifest.sha256(path)
    except OSError as error:
        return f"cannot be read: {error.strerror or error}"
    return "" if now == row["sha256"] else f"changed: SHA-256 was {row['sha256'][:12]}..., is {now[:12]}..."


def _changed_surroundings(run) -> list[str]:
    """Notes on versions and processor that are not those of the manifest."""
    now = manifest.environment()
    old = {"stabilab": run["program"].get("version"), **run["versions"]}
    new = {"stabilab": now["program"]["version"], **now["versions"]}
    notes = [f"  note: {name} was {old.get(name)}, is {new.get(name)}" for name in sorted({*old, *new})
             if old.get(name) != new.get(name)]
    if run["program"].get("sha256") != now["program"]["sha256"] and old["stabilab"] == new["stabilab"]:
        notes.append("  note: the program's own files changed since")
    if run["machine"] != now["machine"]:
        notes.append("  note: another processor or system")
    return notes


@contextmanager
def _target(out):
    if out is not None:
        endings.folder(out)
        if (Path(out) / manifest.NAME).exists():
            raise InputError(f"{out}: there is output in it already; name an empty folder")
        Path(out).mkdir(parents=True, exist_ok=True)
        yield Path(out).resolve()
    else:
        with tempfile.TemporaryDirectory(prefix="stabilab-rerun-") as folder, undoing(
            partial(shutil.rmtree, folder, True)):
            yield Path(folder).resolve()


def _repeat(arguments, start, target):
    """Run the command once more, its files going into `target`."""
    child = subprocess.Popen([sys.executable, "-m", "stabilab", *_redirected(arguments), "--out",
                              str(target)], cwd=start,
                             stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                             text=True)
    with undoing(child.kill):
        words = child.communicate()[1].strip()
    if child.returncode not in ENDED:
        failed = StabilabError(f"stabilab {' '.join(arguments)} ended with {child.returncode}:\n{words}")
        failed.exit_code = child.returncode if child.returncode > 0 else failed.exit_code
        raise failed


def _redirected(arguments) -> list[str]:
    """The arguments without --out."""
    kept, skip = [], False
    for word in arguments:
        if not skip and word != "--out" and not word.startswith("--out="):
            kept.append(word)
        skip = word == "--out" and not skip
    return kept
