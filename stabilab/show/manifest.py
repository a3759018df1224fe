"""The manifest of an output folder, manifest.json: what it was made from; and its repetition.

It has inputs, versions, command, processor, and the hash of every file.

It is written last and describes every command whose files are in the folder; a command that is not in it did
not end.

To repeat it the commands of the manifest are run again, and the files compared, byte for byte."""
from __future__ import annotations

import hashlib
import json
import os
import shlex
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from contextlib import contextmanager
from functools import partial
from pathlib import Path

from .. import files
from ..errors import NO_RENDERING, OK, InputError, StabilabError, ToleranceNotMet
from ..interrupt import undoing
from ..version import __version__
from . import endings

SCHEMA, NAME = "stabilab.manifest/1", "manifest.json"
TIMED_PATHS = ("precision.html", "precision/", "growth.html", "growth.csv", "growth/", "effects.html",
         "effects.png")  # pages and pictures that show measured times: no two runs give the same bytes
PACKAGES = ("numpy", "scipy", "sympy", "mpmath", "python-flint", "heyoka", "numba", "matplotlib", "pillow",
            "vtk", "pyvista",
            "jinja2", "xarray", "typer")  # whatever can change a byte of an output
# the only random numbers: signs of a change in the last place of a start; states whose answers are timed
SEEDS = {"analysis.precision": 1, "analysis.precision_digits": 1, "analysis.cost_growth": 4}


@contextmanager
def written(out, arguments=None, inputs=(), tolerances=None):
    """A folder for the files of one command. When the block ends well they are put into `out` and
    manifest.json is written.

    arguments: of the command line, None for a call from Python, which cannot be repeated; inputs: paths of
    what the command reads, hashed now; tolerances: what -> how exact. Raises InputError where an input or
    `out` is of no use.
    """
    out = endings.folder(out)
    try:
        read_now = [{"path": os.fspath(path), "sha256": sha256(path), "bytes": os.stat(path).st_size}
                    for path in inputs]
    except OSError as error:
        raise InputError(f"{error.filename}: cannot be read: {error.strerror or error}") from None
    run = _run(out, arguments, read_now)
    with files.new_folder(out) as folder:
        yield folder
        run["tolerances"] = dict(tolerances or {})
        run["outputs"] = [{"path": path, "sha256": sha256(file), "bytes": file.stat().st_size}
                          | ({"timed": True} if path.startswith(TIMED_PATHS) else {})
                          for file in files.inside(folder)
                          for path in [file.relative_to(folder).as_posix()]]
        with files.alone_in(out):
            earlier = _kept(out, {row["path"] for row in run["outputs"]})
            if earlier:  # while files move, no command whose files are replaced counts as complete
                _write(out, {**earlier[-1], "earlier": earlier[:-1]})
            else:
                (out / NAME).unlink(missing_ok=True)
            files.put_in_place(folder, out)
            _write(out, {**run, "earlier": earlier})


def read(path: Path) -> list[dict]:
    """The commands of a manifest, the latest last. Raises InputError where the file is none."""
    path = Path(path)
    try:
        text = (path / NAME if path.is_dir() else path).read_text(encoding="utf-8")
        data = json.loads(text)
        runs = [*data["earlier"], {key: value for key, value in data.items() if key != "earlier"}]
        if data["schema"] != SCHEMA or not all(_well_formed(run) for run in runs):
            raise ValueError(f"schema {data['schema']!r}")
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror or error}") from None
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError):
        raise InputError(f"{path}: expected a manifest.json with schema {SCHEMA}, as stabilab writes into "
                         f"its output "
                         "folders") from None
    return runs


def _well_formed(run) -> bool:
    arguments = run["arguments"]
    if not (isinstance(arguments, list | None)
            and all(isinstance(run[key], dict) for key in ("program", "versions", "machine"))):
        return False
    texts = [run["started_in"], str(run["command"]), *(arguments or ())]
    texts += [row[key] for row in (*run["inputs"], *run["outputs"]) for key in ("path", "sha256")]
    return all(isinstance(text, str) for text in texts)


def sha256(path: str | Path) -> str:
    """The SHA-256 hash of a file, in hexadecimal."""
    with open(path, "rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()


def environment() -> dict:
    """The program, the libraries and the processor, as far as they can change a byte."""
    import platform
    from importlib.metadata import PackageNotFoundError, version

    entries = {}
    for name in PACKAGES:
        try:
            entries[name] = version(name)
        except PackageNotFoundError:
            entries[name] = None
    return {"program": {"name": "stabilab", "version": __version__, "sha256": _sources()},
            "versions": {"python": platform.python_version(), **entries},
            "machine": {"system": platform.system(), "architecture": platform.machine(),
                        "cpu_features": cpu_features()}}


def cpu_features() -> list[str]:
    """The processor's features that NumPy uses here (NPY_DISABLE_CPU_FEATURES takes some away)."""
    from numpy._core._multiarray_umath import __cpu_features__
    return sorted(name for name, used in __cpu_features__.items() if used)


def _sources() -> str:
    """One hash of the program's own files: the version alone does not tell two states of it apart."""
    root, full = Path(__file__).parents[1], hashlib.sha256()
    for path in sorted(p for p in root.rglob("*") if p.suffix in (".py", ".html")):
        full.update(path.relative_to(root).as_posix().encode() + b"\0" + sha256(path).encode() + b"\n")
    return full.hexdigest()


def _run(out, arguments, inputs) -> dict:
    # tells from where paths are meant, and is the same on every machine
    here = os.path.relpath(Path.cwd(), out.resolve())
    text = None if arguments is None else list(map(str, arguments))
    return {"schema": SCHEMA, "command": None if text is None else shlex.join(["stabilab", *text]),
            "arguments": text,
            "started_in": Path(here).as_posix(),
            "inputs": inputs, **environment(), "seeds": SEEDS}


def _kept(out: Path, replaced: set[str]) -> list[dict]:
    """The earlier commands with files of their own here, each with those; none of a bad manifest."""
    try:
        runs = read(out / NAME)
    except InputError:
        return []
    for run in runs:
        run["outputs"] = [row for row in run["outputs"] if row["path"] not in replaced]
    return [run for run in runs if run["outputs"]]


def _write(out: Path, data: Mapping[str, str | None]):
    files.write_text(out / NAME, json.dumps(data, indent=1, allow_nan=False) + "\n")


# --- Its repetition
COMMANDS = (["report"], ["figures"], ["tables"], ["surface"])
ENDED = (OK, NO_RENDERING)  # without a renderer everything but the pictures is written


def rerun(path, out=None) -> list[str]:
    """Repeat every command of the manifest (or folder) `path`, into the folder `out` or one that vanishes;
    the answer in a line, then then what became of each file, those that differ first. Raises InputError where
    inputs are missing or changed, ToleranceNotMet (with the lines) where files differ."""
    path = Path(path)
    runs = read(path)
    folder = (path if path.is_dir() else path.parent).resolve()
    for run in runs:
        if run["arguments"] is None:
            raise InputError(f"{path}: made by a call from Python, not by a command: it cannot be repeated")
        if run["arguments"][:1] not in COMMANDS:
            resolved = ", ".join(name for name, in COMMANDS)
            raise InputError(
                f"{path}: expected a command that fills a folder ({resolved}), got {run['command']!r}")
    starts = [_start(run, folder) for run in runs]
    lines: list[str] = []
    with _target(out) as target:
        for run, start in zip(runs, starts):
            _repeat(run["arguments"], start, target)
            lines += [run["command"], *_changed_surroundings(run)]
        built = {row["path"]: row["sha256"] for run in read(target) for row in run["outputs"]}
    text = {row["path"]: _compared(row, built) for run in runs for row in run["outputs"]}
    lines += [f"  {file}: {word}" for file, word in sorted(text.items(), key=lambda item: item[1] in SAME)]
    lines += [f"  {file}: new" for file in built if file not in text]
    differ, count = sum(word not in SAME for word in text.values()), len(text)
    if differ:
        raise ToleranceNotMet(
            "\n".join([f"{differ} of {count} files {'differs' if differ == 1 else 'differ'}", *lines]))
    return [f"all {count} files are accounted for: none differs", *lines]


TIMED = "not compared: it shows measured times"
SAME = ("identical", TIMED)


def _compared(row, built) -> str:
    if row["path"] not in built:
        return "did not come again"
    if row.get("timed"):
        return TIMED
    return "identical" if built[row["path"]] == row["sha256"] else "differs"


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
        now = sha256(path)
    except OSError as error:
        return f"cannot be read: {error.strerror or error}"
    return "" if now == row["sha256"] else f"changed: SHA-256 was {row['sha256'][:12]}..., is {now[:12]}..."


def _changed_surroundings(run) -> list[str]:
    """Notes on versions and processor that are not those of the manifest."""
    now = environment()
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
        if (Path(out) / NAME).exists():
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
        text = child.communicate()[1].strip()
    if child.returncode not in ENDED:
        failed = StabilabError(f"stabilab {' '.join(arguments)} ended with {child.returncode}:\n{text}")
        failed.exit_code = child.returncode if child.returncode > 0 else failed.exit_code
        raise failed


def _redirected(arguments) -> list[str]:
    """The arguments without --out."""
    retained, skip = [], False
    for word in arguments:
        if not skip and word != "--out" and not word.startswith("--out="):
            retained.append(word)
        skip = word == "--out" and not skip
    return retained
