"""The report: one folder of pages, read from disk without a network: on cases of one's own, or on everything.
"""
from __future__ import annotations

import os
import sys
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from ...case.read import load_all
from ...interrupt import undoing
from ...packages import demand
from ...show import style
from ...show.files import manifest
from ...show.report import own, precision_page
from ...show.text import law
from ...version import __version__
from .. import table
from . import whole

PACKAGES = ("numpy", "scipy", "sympy", "heyoka", "matplotlib", "vtk", "pyvista", "python-flint")
TOLERANCES = {"verdicts, fates, periods": "exact structure of the equations, to rounding",
              "extremes": "roots, to rounding",
              "trajectories": 1.1e-16}  # relative, of the Taylor series
SHOW_CURSOR = b"\x1b[?25h"  # the progress line hides it
DEEP = 4  # pages up to which each also tells what takes seconds


def write(cases=None, out="report", progress=None, arguments=None, papers=False, precision=False,
          certify=False, workers=None,
          beyond: list | None = None, undecided: list | None = None) -> Path:
    """Write a report into the folder `out`: on `cases` (paths or Case), or, where there are none, on
    everything the package brings.

    papers: the papers' tables and figures, the audit and other tools' numbers as well; precision: what
    accuracy costs; certify: a certificate of each case, checked. workers: processes that share the work
    (None: one a core); the pages are the same for any number. Everything is made in a temporary folder inside
    `out` and renamed into place, index.html and manifest.json last; no renderer is needed. progress(words) is
    called before every step; by default a line on stderr where that is a terminal. arguments: of the command
    line, for the manifest. beyond: a list, which gets a line for every approximate law that a motion leaves;
    undecided: one that gets the stem of every file with an undecided fate. Returns the path of index.html;
    raises CaseError for a case file with faults, before anything is written.
    """
    out = Path(out)
    # what a report cannot do without, before its minutes of work
    demand("jinja2", *style.PACKAGES, "scipy", "sympy", "flint")
    loaded, everything = of_all(cases), not cases
    wanted = own.Wanted(papers or everything, precision or everything, certify,
                        len(own.entries(loaded)) <= DEEP)
    # the papers' figures read their cases
    inputs = dict.fromkeys([*(case.path for case in loaded), *(table.case_files() if wanted.papers else ())])
    around = {"command": command(loaded if cases else (), papers, precision, certify), "versions": versions(),
              "extra": ()}
    with _progress(progress) as tell, manifest.written(out, arguments, inputs, TOLERANCES) as folder:
        if wanted.papers:
            left = whole.pages(loaded, folder, tell, wanted, workers, **around)
        else:
            around["extra"] = _precision(loaded, folder, tell) if wanted.precision else ()
            left = own.pages(loaded, folder, tell, wanted, workers, **around)
    if beyond is not None:
        beyond += law.together(line for lines, _ in left for line in lines.splitlines())
    if undecided is not None:
        undecided += [stem for (stem, _), (_, open_) in zip(own.entries(loaded), left) if open_]
    return out / "index.html"


def report(case: Any, out: str | os.PathLike[str] = "report", precision: bool = False, certify: bool = False,
           workers: int | None = None) -> Path:
    """Write the pages on a case into the folder `out`, as `stabilab report` does; precision: what accuracy
    costs as well; certify: a certificate, checked. Returns the path of index.html. Raises
    InputError where a package that draws is not installed."""
    return write([case], out, precision=precision, certify=certify, workers=workers)


def of_all(cases):
    """The cases that a report is on: those given, or all of the papers."""
    paths = list(cases or sorted(table.case_files(), key=lambda p: _natural(Path(p).stem)))
    return [case for item in paths for case in ([item] if hasattr(item, "scene") else load_all(item))]


def _natural(name):
    stem, _, number = name.rpartition("-")
    return (stem, int(number)) if number.isdigit() else (name, 0)


def command(cases, papers, precision, certify) -> str:
    """What was typed, but for the folder."""
    options = [name for name,
               given in (("--papers", papers), ("--precision", precision), ("--certify", certify)) if given]
    return " ".join(["stabilab report", *dict.fromkeys(case.path for case in cases), *options])


def _precision(cases, folder, tell):
    path = precision_page.page([members[0] for _, members in own.entries(cases)], folder, tell)
    return [{"title": "What accuracy costs", "words": "every way to follow the motion, error against time",
             "file": path.name}]


@contextmanager
def _progress(given):
    if given or not sys.stderr.isatty():
        yield given or (lambda words: None)
        return
    from rich.console import Console
    console = Console(stderr=True)
    with undoing(lambda: os.write(2, SHOW_CURSOR)), console.status("report") as status:
        yield lambda words: status.update(f"report: {words}")


def versions():
    """(name, version) of the program, Python, the machine and the libraries that had a part."""
    import platform
    from importlib.metadata import PackageNotFoundError, version

    rows = [("stabilab", __version__), ("Python", platform.python_version()),
            ("system", f"{platform.system()} {platform.machine()}")]
    for name in PACKAGES:
        try:
            rows.append((name, version(name)))
        except PackageNotFoundError:
            rows.append((name, "not installed"))
    return rows
