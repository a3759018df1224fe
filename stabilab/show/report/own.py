"""The report on cases of one's own, by several processes: a page a case, a page a sweep, and, where there
are several, a first page that lists them."""
from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from pathlib import Path

from ...errors import StabilabError
from ...orbit.separatrix.branches import separatrix
from .. import surface
from ..text import headline
from ..text.scene import groups
from . import html, one_case
from .workers import Task, done

SHAPE = (48, 97)  # rows and columns of a branch of a mesh: smooth to the eye, 1.5 MB of meshes a scene
FOLDER = "cases"  # inside that of the report: pages of many cases, pictures and meshes of all


@dataclass(frozen=True)
class Wanted:
    """What a report holds besides the cases. deep: also what takes seconds a case."""

    papers: bool = False
    precision: bool = False
    certify: bool = False
    deep: bool = True


def entries(cases) -> list[tuple[str, list]]:
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


def section(stem, cases, folder, wanted) -> dict:
    """Everything that a page says of one entry, its pictures and meshes written: a task of `workers`."""
    if cases[0].variant:
        found = one_case.sections_of_sweep(cases, folder, stem)
        return {"sweep": found, "surface": None, "beyond": headline.of_cases(cases),
                "open": any(row["fate"] == "undecided" for row in found["rows"])}
    (case,) = cases
    made = one_case.sections(case, folder, stem, wanted.deep, wanted.certify)
    return {"case": made, "surface": surface_of(case, stem, folder), "beyond": headline.of_cases([case]),
            "open": made["fate"] == "undecided"}


def surface_of(case, stem: str, folder: Path) -> dict | None:
    """The separatrix as meshes, which need no renderer: names of the files, counts and what the branches
    part; None where the case has no separatrix, whose reason its own section gives."""
    try:
        found = separatrix(case.scene, shape=SHAPE)
    except StabilabError:
        return None
    if not found.branches:
        return None
    meshes = [surface.triangulate(branch) for branch in found.branches]
    summary = surface.summarise(case, found, meshes)
    files = surface.write_meshes(meshes, folder, stem)
    return {"title": case.heading, "reason": found.because, "triangles": summary["triangles"],
            "residual": summary["largest_residual"], "files": [file.name for file in files]}


def tasks(cases, folder: Path, wanted: Wanted) -> list[Task]:
    """A task an entry."""
    place = folder / FOLDER
    place.mkdir()
    return [Task(f"case {stem}", "show.report.own:section", (stem, group, place, wanted),
                 3.0 + 0.3 * len(group)) for stem, group in entries(cases)]


def write(made, place: Path, prefix: str, **around) -> Path:
    """The page of one entry. prefix: how the page reaches its pictures; around: what every page says of the
    folder it is in."""
    if "sweep" in made:
        return html.write(place, "sweep.html", sweep=made["sweep"], pictures=prefix, **around)
    meshes = (made["surface"]
              and made["surface"] | {"files": [prefix + name for name in made["surface"]["files"]]})
    return html.write(place, "case.html", case=made["case"], surface=meshes, pictures=prefix, **around)


def of_one(made, around) -> dict:
    """What a page among others says of how it was made: the command that makes it alone."""
    return around | {"extra": (), "command": f"stabilab report {(made.get('sweep') or made['case'])['path']}"}


def listed(stem, made) -> dict:
    """The row of an entry in a list of pages."""
    found = made.get("sweep") or made["case"]
    return {"file": f"{stem}.html", "name": stem, "title": found["title"], "headline": found["headline"],
            "look": found["look"],
            # by how much; why that matters stands on the page
            "beyond": " ".join(filter(None, [found["exceeded"], *found["caveats"]]))}


def pages(cases, folder: Path, tell, wanted: Wanted, workers=None, **around) -> list[tuple[str, bool]]:
    """All pages of a report on these cases alone; index.html is the page of the one case, or the list of
    several. Of each entry a line for each law left, and whether a fate is undecided."""
    rows = entries(cases)
    found = done(tasks(cases, folder, wanted), folder, tell, workers)
    if len(rows) == 1:
        write(found[0], folder / "index.html", f"{FOLDER}/", **around)
        return [(found[0]["beyond"], found[0]["open"])]
    nav = [{"file": "index.html", "title": "All cases"}]
    for (stem, _), made in zip(rows, found):
        write(made, folder / FOLDER / f"{stem}.html", "", nav=nav, up="../", below="index.html",
              **of_one(made, around))
    listing = [row | {"file": f"{FOLDER}/{row['file']}"} for (stem, _),
               made in zip(rows, found) for row in [listed(stem, made)]]
    html.write(folder / "index.html", "list.html", title=f"{len(rows)} cases",
               groups=[{"title": "", "rows": listing}], **around)
    return [(made["beyond"], made["open"]) for made in found]
