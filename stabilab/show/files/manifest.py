"""What an output folder was made from: manifest.json with inputs, versions, command, processor, and the hash
of every file.

It is written last and describes every command whose files are in the folder; a command that is not in it did
not end.
"""
from __future__ import annotations

import hashlib
import json
import os
import shlex
from contextlib import contextmanager
from pathlib import Path

from ... import files
from ...errors import InputError
from ...version import __version__
from . import endings

SCHEMA, NAME = "stabilab.manifest/1", "manifest.json"
TIMED = ("precision.html", "precision/", "growth.html", "growth.csv", "growth/", "effects.html",
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
                          | ({"timed": True} if path.startswith(TIMED) else {})
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


def read(path) -> list[dict]:
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


def sha256(path) -> str:
    """The SHA-256 hash of a file, in hexadecimal."""
    with open(path, "rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()


def environment() -> dict:
    """The program, the libraries and the processor, as far as they can change a byte."""
    import platform
    from importlib.metadata import PackageNotFoundError, version

    found = {}
    for name in PACKAGES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            found[name] = None
    return {"program": {"name": "stabilab", "version": __version__, "sha256": _sources()},
            "versions": {"python": platform.python_version(), **found},
            "machine": {"system": platform.system(), "architecture": platform.machine(),
                        "cpu_features": cpu_features()}}


def cpu_features() -> list[str]:
    """The processor's features that NumPy uses here (NPY_DISABLE_CPU_FEATURES takes some away)."""
    from numpy._core._multiarray_umath import __cpu_features__
    return sorted(name for name, used in __cpu_features__.items() if used)


def _sources() -> str:
    """One hash of the program's own files: the version alone does not tell two states of it apart."""
    root, whole = Path(__file__).parents[2], hashlib.sha256()
    for path in sorted(p for p in root.rglob("*") if p.suffix in (".py", ".html")):
        whole.update(path.relative_to(root).as_posix().encode() + b"\0" + sha256(path).encode() + b"\n")
    return whole.hexdigest()


def _run(out, arguments, inputs) -> dict:
    # tells from where paths are meant, and is the same on every machine
    here = os.path.relpath(Path.cwd(), out.resolve())
    words = None if arguments is None else list(map(str, arguments))
    return {"schema": SCHEMA, "command": None if words is None else shlex.join(["stabilab", *words]),
            "arguments": words,
            "started_in": Path(here).as_posix(),
            "inputs": inputs, **environment(), "seeds": SEEDS}


def _kept(out, replaced) -> list[dict]:
    """The earlier commands with files of their own here, each with those; none of a bad manifest."""
    try:
        runs = read(out / NAME)
    except InputError:
        return []
    for run in runs:
        run["outputs"] = [row for row in run["outputs"] if row["path"] not in replaced]
    return [run for run in runs if run["outputs"]]


def _write(out, data):
    files.write_text(out / NAME, json.dumps(data, indent=1, allow_nan=False) + "\n")
