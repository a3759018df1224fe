"""The page as a folder for any static web server: Python runs in the browser (Pyodide), and answers there.

The folder holds the page, a worker, and the package without papers, cases and commands. Python
itself and python-flint come from the address of the Pyodide project and from the index of Python packages,
or, with a folder of theirs given, from this folder alone.
"""
from __future__ import annotations

import io
import json
import shutil
import zipfile
from pathlib import Path

from ...case.read import Case
from ...errors import InputError
from ...files import whole_file
from ...version import __version__
from ..files import endings
from ..report.html import TEMPLATES
from . import orbits as other
from .serve import page
from .session import Session

PYODIDE, FLINT = "314.0.7", "0.9.0"  # what the tests load
ADDRESS = f"https://cdn.jsdelivr.net/pyodide/v{PYODIDE}/full/"
NEEDED = ("pyodide.mjs", "pyodide.asm.mjs", "pyodide.asm.wasm", "python_stdlib.zip", "pyodide-lock.json")
LEFT_OUT = ("cases/", "cli/", "commands/", "papers/", "show/templates/")
POLICY = ("default-src 'none'; script-src 'unsafe-inline' 'self'; style-src 'unsafe-inline'; img-src data:; "
          "worker-src 'self'; base-uri 'none'; "
          "form-action 'none'")
CURE = (f'get them by "npm pack pyodide@{PYODIDE}" (unpack it) and "pip download --no-deps '
        f'--only-binary=:all: --python-version 3.14 '
        f'--platform pyemscripten_2026_0_wasm32 python-flint=={FLINT}", all into one folder')
DAY = (1980, 1, 1, 0, 0, 0)  # of files in the archive: the same package gives the same bytes


def write(case: Case, out: Path, pyodide: Path | None = None) -> Path:
    """Write the folder, and return its index.html. pyodide: a folder with Pyodide and a wheel of
    python-flint, which are copied in; None: the page loads both from where they are published. Raises
    InputError where the case has no such page or files of that folder are missing."""
    if other.needed(case.scene):
        raise InputError(f"{case.place}: a page without a server has no SciPy, by which the motion of such a "
                         f"body is followed; stabilab explore without "
                         "--static shows it")
    about = Session(case).about()
    out = endings.folder(out)
    wheels = None
    if pyodide is not None:
        wheels = _wheels(pyodide)
        for name in (*NEEDED, *wheels):
            with whole_file(out / "pyodide" / name) as waiting:
                shutil.copyfile(pyodide / name, waiting)
    words = f"Pyodide {PYODIDE} from {ADDRESS}" if wheels is None else "Pyodide from the folder of this page"
    flint = ("python-flint and NumPy from where Pyodide finds them" if wheels is None
             else f"{' and '.join(wheels)} too")
    how = (f"Python runs in this browser and answers here: {words}, {flint}, and stabilab {__version__} from "
           f"stabilab.zip beside this page. "
           + ("" if wheels is None or len(wheels) > 1
              else "Without NumPy a motion that no law decides is not followed."))
    python = {"pyodide": ADDRESS if wheels is None else "pyodide/", "wheels": wheels,
              "arrays": wheels is None, "words": words, "name": Path(case.path).name,
              "text": case.text}
    _written(out / "stabilab.zip", archive())
    _written(out / "worker.js", (TEMPLATES / "explore-worker.js").read_bytes())
    index = out / "index.html"
    _written(index, page(about, "explore-browser.js", how, POLICY, python=python).encode())
    return index


def archive() -> bytes:
    """The package as a zip, without what the page does not ask."""
    package, buffer = Path(__file__).parents[2], io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as packed:
        for path in sorted(package.rglob("*.py")):
            place = path.relative_to(package).as_posix()
            if not place.startswith(LEFT_OUT):
                packed.writestr(zipfile.ZipInfo(f"stabilab/{place}", DAY), path.read_bytes(),
                                zipfile.ZIP_DEFLATED)
    return buffer.getvalue()


def _wheels(folder: Path) -> list[str]:
    """The wheels in a folder of Pyodide's, python-flint first; InputError with what is missing."""
    missing = [name for name in NEEDED if not (folder / name).is_file()]
    if missing:
        raise InputError(f"--pyodide: {folder} has no {', '.join(missing)}: {CURE}")
    try:
        info = json.loads((folder / "pyodide-lock.json").read_text(encoding="utf-8"))["info"]
        tag = f"cp{''.join(info['python'].split('.')[:2])}-*_{info['abi_version']}_wasm32.whl"
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise InputError(f"--pyodide: {folder / 'pyodide-lock.json'} is not Pyodide's: {error}") from None
    found = {name: sorted(path.name for path in folder.glob(f"{name}-*-cp*-{tag}"))
             for name in ("python_flint", "numpy")}
    if not found["python_flint"]:
        raise InputError(f"--pyodide: {folder} has no wheel python_flint-*-{tag}: {CURE}")
    return [names[-1] for names in found.values() if names]


def _written(path: Path, content: bytes) -> None:
    with whole_file(path) as waiting:
        waiting.write_bytes(content)
