"""The report on cases of one's own, by several processes: a page a case, a page a sweep, and, where there
are several, a first page that lists them."""
from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ...case.read import special_of
from ...errors import StabilabError
from ...orbit.separatrix.branches import separatrix
from ...tasks import Task, done
from .. import surface
from ..text import headline
from ..text.scene import groups
from . import html, one_case

if TYPE_CHECKING:
    from ...case.read import Case

# rows and columns of a branch of a mesh, and its files: smooth to the eye, 170 kB a scene; `surface` has
# finer ones, and .stl, which alone takes three times as much
SHAPE, MESHES = (26, 53), ("vtp", "glb")
FOLDER = "cases"  # inside that of the report: pages of many cases, pictures and meshes of all


@dataclass(frozen=True)
class Wanted:
    """What a report holds besides the cases. deep: also what takes seconds a case."""

    papers: bool = False
    precision: bool = False
    certify: bool = False
    deep: bool = True


def entries(cases: Sequence[Case]) -> list[tuple[str, list]]:
    """(stem of its files, its cases) of every case and every file with [sweep]; stems differ even where names
    do not."""
    taken: Counter = Counter()
    rows = []
    for places in groups(cases):
        first = cases[places[0]]
        name = first.name.removesuffix(first.variant)
        taken[name] += 1
        rows.append((name if taken[name] == 1 else f"{name}_{taken[name]}", [cases[n] for n in places]))
    return rows


def section(stem: str, cases: Sequence[Case], folder: Path, wanted: Wanted) -> dict:
    """Everything that a page says of one entry, its pictures and meshes written: a task of `workers`."""
    if cases[0].variant:
        result = one_case.sections_of_sweep(cases, folder, stem)
        return {"sweep": result, "surface": None, "beyond": headline.of_cases(cases),
                "open": any(row["fate"] == "undecided" for row in result["rows"])}
    (case,) = cases
    if (full := special_of(case)) is not None:
        built = one_case.sections_of_special(full, folder, stem, wanted.deep)
        return {"case": built, "surface": None, "beyond": "", "open": built["fate"] == "undecided"}
    built = one_case.sections(case, folder, stem, wanted.deep, wanted.certify)
    return {"case": built, "surface": surface_of(case, stem, folder), "beyond": headline.of_cases([case]),
            "open": built["fate"] == "undecided"}


def surface_of(case, stem: str, folder: Path) -> dict | None:
    """The separatrix as meshes, which need no renderer: names of the files, counts and what the branches
    part; None where the case has no separatrix, whose reason its own section gives."""
    try:
        result = separatrix(case.scene, shape=SHAPE)
    except StabilabError:
        return None
    if not result.branches:
        return None
    meshes = [surface.triangulate(branch) for branch in result.branches]
    summary = surface.summarise(case, result, meshes)
    files = surface.write_meshes(meshes, folder, stem, MESHES)
    return {"title": case.heading, "reason": result.because, "triangles": summary["triangles"],
            "residual": summary["largest_residual"], "files": [file.name for file in files]}


def tasks(cases: Sequence[Case], folder: Path, wanted: Wanted) -> list[Task]:
    """A task an entry."""
    location = folder / FOLDER
    location.mkdir()
    return [Task(f"case {stem}", "show.report.own:section", (stem, group, location, wanted),
                 3.0 + 0.3 * len(group)) for stem, group in entries(cases)]


def write(built, location: Path, prefix: str, **around) -> Path:
    """The page of one entry. prefix: how the page reaches its pictures; around: what every page says of the
    folder it is in."""
    if "sweep" in built:
        return html.write(location, "sweep.html", sweep=built["sweep"], pictures=prefix, **around)
    meshes = (built["surface"]
              and built["surface"] | {"files": [prefix + name for name in built["surface"]["files"]]})
    return html.write(location, "case.html", case=built["case"], surface=meshes, pictures=prefix, **around)


def of_one(made, around) -> dict:
    """What a page among others says of how it was made: the command that makes it alone."""
    return around | {"extra": (), "command": f"stabilab report {(made.get('sweep') or made['case'])['path']}"}


def listed(stem, built) -> dict:
    """The card of an entry in a list of pages."""
    result = built.get("sweep") or built["case"]
    return {"file": f"{FOLDER}/{stem}.html", "folder": f"{FOLDER}/", "name": stem, "title": result["title"],
            "headline": result["headline"], "line": result.get("first") or result["headline"],
            "look": result["look"], "badge": result.get("badge", ""),
            "thumbnail": result.get("thumbnail"),
            # by how much; why that matters stands on the page
            "beyond": " ".join(filter(None, [result["exceeded"], *result["caveats"]]))}


def pages(cases, folder: Path, tell, wanted: Wanted, workers=None, **around) -> list[tuple[str, bool]]:
    """All pages of a report on these cases alone; index.html is the page of the one case, or the list of
    several. Of each entry a line for each law left, and whether a fate is undecided."""
    rows = entries(cases)
    result = done(tasks(cases, folder, wanted), folder, tell, workers)
    if len(rows) == 1:
        write(result[0], folder / "index.html", f"{FOLDER}/", **around)
        return [(result[0]["beyond"], result[0]["open"])]
    nav = [{"file": "index.html", "title": "All cases"}]
    for (stem, _), built in zip(rows, result):
        write(built, folder / FOLDER / f"{stem}.html", "", nav=nav, up="../", below="index.html",
              **of_one(built, around))
    listing = [listed(stem, product) for (stem, _), product in zip(rows, result)]
    html.write(folder / "index.html", "list.html", title=f"{len(rows)} cases",
               groups=[{"title": "", "rows": listing}], **around)
    return [(product["beyond"], product["open"]) for product in result]
