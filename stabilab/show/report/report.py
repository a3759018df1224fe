"""The report: one folder with every table, figure, surface, case and formula, readable from disk without a network."""
from __future__ import annotations

import math
import os
import sys
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from stabilab import __version__

from ...answers.equilibria import equilibria
from ...answers.motion import motion
from ...case.read import load_all
from ...errors import StabilabError
from ...interrupt import undoing
from ...orbit.separatrix.sheets import separatrix
from ...packages import cure, demand, present
from ...physics.equations import derive
from ...physics.laws import invariants
from ...physics.notation import latex, lines
from ...theories.audit import audited
from ...theories.validation import validated
from .. import style
from ..figures import catalogue as figures
from ..figures import paper
from ..files import manifest
from ..outside import validation
from ..plot.to_file import write as plot
from ..surface import write as surface
from ..surface.render_probe import probe
from ..text import frame, table
from . import audit_page, chapters, cost_growth, effect_cost, html, precision_page

PACKAGES = ("numpy", "scipy", "sympy", "heyoka", "matplotlib", "vtk", "pyvista", "python-flint")
TOLERANCES = {"verdicts, fates, periods": "exact structure of the equations, to rounding", "extremes": "roots, to rounding",
              "trajectories": 1.1e-16}  # relative, of the Taylor series
SHOW_CURSOR = b"\x1b[?25h"  # the progress line hides it
GROWING = "minor-axis-100"  # the case about which the growth of cost is measured
VIEWER = "trame_vtk"  # the package that brings the pages of scenes
SURFACE_SHAPE = (48, 97)  # rows and columns of a sheet: smooth to the eye, 3 MB a scene


def write(cases=None, out="report", progress=None, arguments=None) -> Path:
    """Write the report on `cases` (paths or Case; those that the package brings where empty) into the folder `out`.

    Everything is made in a temporary folder inside `out` and renamed into place, index.html and manifest.json last. Where
    3-D pictures cannot be drawn the report is written without them and says so. progress(words) is called before every
    step; by default a line on stderr where that is a terminal. arguments: of the command line, for the manifest. Returns
    the path of index.html; raises CaseError for a case file with faults, before anything is written.
    """
    out = Path(out)
    demand("jinja2", *style.PACKAGES, "scipy", "sympy", "flint")  # what a report cannot do without, before its minutes of work
    loaded = of_all(cases)
    inputs = dict.fromkeys([*(case.path for case in loaded), *table.case_files()])  # the papers' figures read the papers' cases
    with (_progress(progress) as tell, manifest.written(out, arguments, inputs, TOLERANCES) as folder,
          chapters.beside(folder) as others):
        _make(loaded, folder, tell, bool(cases), others)
    return out / "index.html"


def of_all(cases):
    """The cases that a report is on: those given, or all of the papers."""
    paths = list(cases or sorted(table.case_files(), key=lambda p: _natural(Path(p).stem)))
    return [case for item in paths for case in ([item] if hasattr(item, "scene") else load_all(item))]


def _natural(name):
    stem, _, number = name.rpartition("-")
    return (stem, int(number)) if number.isdigit() else (name, 0)


@contextmanager
def _progress(given):
    if given or not sys.stderr.isatty():
        yield given or (lambda words: None)
        return
    from rich.console import Console
    console = Console(stderr=True)
    with undoing(lambda: os.write(2, SHOW_CURSOR)), console.status("report") as status:
        yield lambda words: status.update(f"report: {words}")


def _make(cases, folder, tell, named, others):
    """Fill the temporary folder. named: the cases stood in the command; others(tell): the chapters."""
    tell("tables")
    tables = _tables(folder)
    drawn = figures.write(None, folder / "figures", tell, figures.FIRST)
    tell("surfaces")
    surfaces, note = _surfaces(cases, folder, tell)
    sections = [_section(case, folder, tell) for case in cases]
    tell("printed formulas")
    told, pages = others(tell), _pages(cases, folder, tell)  # the chapters' process is done, so that times are disturbed least
    page = html.render(
        "index.html", title="Bounded motion and spin-up of a gyrostat under constant torque", paper=paper.PAPER, rendering_note=note,
        cases=sections, chapters=told, pages=pages, tables=tables, surfaces=surfaces, audit=_audit(folder), validation=_validation(folder),
        versions=_versions(),
        figures=[{**vars(row), "caption": row.caption, "tolerance": row.tolerance, "file": f"figures/{path.name}",
                  "command": row.command, "size": chapters.size(path)}
                 for row, path in zip(figures.FIGURES, drawn)],
        command=" ".join(["stabilab report", *dict.fromkeys(case.path for case in cases if named)]))
    (folder / "index.html").write_text(page, encoding="utf-8")


def _audit(folder):
    """Counts of verdicts a paper; the rows stand on a page of their own."""
    findings = audited()
    audit_page.page(findings, folder / "audit.html")
    return [{"title": paper.title, "name": paper.name, "count": audit_page.count(group)} for paper, group in findings]


def _validation(folder):
    """Counts of verdicts a source; the values stand on a page of their own."""
    found = validated()
    validation.page(found, folder / "validation.html")
    return [{"source": source, "count": validation.counts(rows)} for source, rows in found]


def _precision(cases, folder, tell):
    return precision_page.page(cases, folder, tell)


def _growth(cases, folder, tell):
    case = next((case for case in cases if case.name == GROWING), None)
    return case and cost_growth.page(case, folder, tell)


def _effects(cases, folder, tell):
    return effect_cost.page(folder, tell)


# what stands on pages of its own: (title, what it says, page(cases, folder, tell) -> its path, or None where the cases do not call for it)
PAGES = (("What accuracy costs", "every way to follow each motion: error against time, and the cheapest way to each digit", _precision),
         ("How cost grows", "with the number of states, the digits, and closeness to the separatrix", _growth),
         ("What each effect costs", "state, equations and time as effects are added one at a time", _effects))


def _pages(cases, folder, tell):
    made = [(title, words, page(cases, folder, tell)) for title, words, page in PAGES]
    return [{"title": title, "words": words, "file": path.name} for title, words, path in made if path]


def _tables(folder):
    from markupsafe import Markup
    rows = []
    for one in table.tables():
        names = []
        for kind, make in table.FORMATS.items():
            path = folder / "tables" / f"{one.stem}.{kind}"
            path.parent.mkdir(exist_ok=True)
            path.write_text(make(one), encoding="utf-8")
            names.append(f"tables/{path.name}")
        rows.append({"number": one.number, "title": one.title, "wide": one.wide, "rows": one.rows, "files": names,
                     "html": Markup(table.html_fragment(one))})  # escaped cell by cell in table.py
    return rows


def _surfaces(cases, folder, tell):
    """One entry for every different scene that has a separatrix; and what to say where nothing can be drawn."""
    renderer, entries, seen = probe(), [], []
    for case in cases:
        if case.scene in seen:
            continue
        seen.append(case.scene)
        entry = _surface(case, folder / "surfaces", renderer, tell)
        if entry:
            entries.append(entry)
    note = "" if renderer.available else (f"3-D pictures could not be drawn on this machine ({renderer.words}); the meshes "
                                          f"are here all the same. Cure: {renderer.cure}")
    if renderer.available and not present(VIEWER):
        note = f"There are no scenes to turn round: these need trame-pyvista, which is not installed. Cure: {cure(VIEWER)}"
    return entries, note


def _surface(case, folder, renderer, tell):
    try:
        found = separatrix(case.scene, shape=SURFACE_SHAPE)
    except StabilabError:
        return None  # the case's own section gives the reason
    if not found.sheets:
        return None
    tell(f"surface of {case.name}")
    meshes = [surface.triangulate(sheet) for sheet in found.sheets]
    summary = surface.summarise(case, found, meshes)
    files = surface.write_meshes(meshes, folder, case.name)
    still = scene = None
    if renderer.available:
        still = surface.draw(case.scene, found, meshes, folder / f"{case.name}.png")
        scene = surface.turntable(case.scene, found, meshes, folder / f"{case.name}.html") if present(VIEWER) else None
    return {"title": case.heading, "reason": found.reason, "triangles": summary["triangles"],
            "residual": summary["largest_residual"], "files": [f"surfaces/{f.name}" for f in files],
            "still": still and f"surfaces/{still.name}", "scene": scene and f"surfaces/{scene.name}",
            "command": f"stabilab surface {case.path} --out surfaces"}


# -- one case ----------------------------------------------------------------------------------------------------------


def _section(case, folder, tell) -> dict:
    """Everything the template says of a case, as plain words."""
    tell(f"case {case.name}")
    section = {"name": case.name, "title": case.heading, "source": case.source, "path": case.path,
               "text": case.text, "fate": "", "motion": [], "equilibria": [], "equilibria_kind": "", "equilibria_reason": "",
               "picture": None, "problem": "", **_equations(case.scene)}
    try:
        section |= _equilibria(case.scene)
        if case.state is not None:
            section |= _motion(case)
            section["picture"] = _picture(case, folder)
    except StabilabError as error:
        section["problem"] = str(error)
    return section


def _equations(scene):
    equations = derive(scene)
    values = ", ".join(f"{name} = {float(value):.12g}" for name, value in equations.parameters.items())
    return {"equations": lines(equations), "latex": latex(equations), "parameters": values,
            "laws": [law.words for law in invariants(scene)]}


def _equilibria(scene):
    found = equilibria(scene)
    rows = [{"where": _triple(p.at), "linear": p.linear, "verdict": p.verdict, "because": p.because, "css": _css(p.verdict)}
            for p in found.points]
    for curve in found.curves:
        rows += [{"where": f"{curve.name}: {curve.parametrisation}, t from {s.t[0]:.6g} to {s.t[1]:.6g}", "linear": s.linear,
                  "verdict": s.verdict, "because": s.because, "css": _css(s.verdict)} for s in curve.segments]
        rows += [{"where": f"fold at {_triple(fold)}", "linear": "degenerate", "verdict": "", "because": "", "css": ""}
                 for fold in curve.folds]
    return {"equilibria_kind": found.kind, "equilibria_reason": found.reason, "equilibria": rows}


def _css(verdict):
    return {"stable": "bounded", "asymptotically stable": "bounded", "unstable": "spin-up"}.get(verdict, "")


def _triple(values):
    return "(" + ", ".join(f"{v:.12g}" for v in values) + ")"


def _motion(case):
    found = motion(case.scene, case.start, case.span, exact=case.exact_state)
    names = case.scene.components
    rows = [] if found.validity is None else [("law", found.validity.words)]
    rows += [("frame", line.strip().removeprefix("frame: ")) for line in frame.lines(case)]
    rows += [("start", _triple(found.at)), ("fate", found.fate.word + (f" about axis {found.axis}, "
             f"{'positive' if found.sense > 0 else 'negative'} sense" if found.axis else "")), ("because", found.because)]
    if found.margin_energy is not None:
        rows.append(("energy below the separatrix", f"{found.margin_energy:.15g}"))
    if found.margin_velocity is not None:
        low, high = found.velocity_bounds
        rows.append(("smallest change of state to it", f"{low:.10g} to {high:.10g}: {found.velocity_because}"
                     if found.velocity_because else f"{found.margin_velocity:.12g}"))
    if found.period is not None:
        rows.append(("period", f"{found.period:.15g} {case.scene.time_unit}"))
    if found.extremes is not None:
        rows += [(f"{name} ({found.extremes_over})", _range(pair)) for name, pair in zip(names, found.extremes)]
    rows += [(f"invariant {name}", f"{value:.15g}") for name, value in found.invariants.items()]
    rows += [(name, _evidence(value)) for name, value in found.evidence.items()]
    if found.tolerance is not None:
        rows.append(("tolerance reached", f"{found.tolerance:.2g}"))
    return {"fate": found.fate.word, "motion": rows}


def _range(pair):
    low, high = ("unknown" if v is None else "unbounded" if math.isinf(v) else f"{v:.15g}" for v in pair)
    return f"{low} to {high}"


def _evidence(value):
    if isinstance(value, float):
        return f"{value:.12g}"
    if isinstance(value, (list, tuple, np.ndarray)):
        return "(" + ", ".join(_evidence(v) for v in value) + ")"
    return str(value)


def _picture(case, folder):
    path = plot(case, folder / "cases" / f"{case.name}.png")
    return {"file": f"cases/{path.name}", "size": chapters.size(path)}


def _versions():
    """(name, version) of the program, Python, the machine and the libraries that had a part."""
    import platform
    from importlib.metadata import PackageNotFoundError, version

    rows = [("stabilab", __version__), ("Python", platform.python_version()), ("system", f"{platform.system()} {platform.machine()}")]
    for name in PACKAGES:
        try:
            rows.append((name, version(name)))
        except PackageNotFoundError:
            rows.append((name, "not installed"))
    return rows
