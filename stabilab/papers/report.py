"""The report: one folder of pages, read from disk without a network, on one's own cases or on everything.

Everything is a start page, the papers, all cases in groups, the audit, other tools' numbers and what
answers cost."""
from __future__ import annotations

import os
import sys
from contextlib import contextmanager
from pathlib import Path

from ..case.given import Given, Span, Start, as_text
from ..case.read import load_each, special_of
from ..interrupt import undoing
from ..orbit.result import OUTCOMES, Fate
from ..packages import demand
from ..physics.scene import Scene, torque_axis
from ..show import manifest, narrow, style
from ..show import precision as precision_page
from ..show.report import html, own
from ..show.terminal import some, written
from ..show.text import headline
from ..tasks import Task, done
from ..theories.printed.claims import MAIN
from ..version import __version__
from . import cost_effects, cost_growth, index, table
from .audit import page as audit_page
from .audit import papers as audited_papers
from .chapter import CHAPTERS, drawn
from .figures import catalogue
from .validation import comparison as validation

TITLE = "Bounded motion and spin-up of a gyrostat under constant torque"
FINEST = 5                   # number of the figure on the start page
GROWING = "minor-axis-100"   # the case about which the growth of cost is measured
# s
AUDIT_TAKES = {"constant-torque-gyrostat": 15.0, "charged-axisymmetric-short": 13.0,
               "charged-axisymmetric": 12.0, "liquid-cavity": 10.0}


# -- what is drawn and computed, by whichever process is free


def tables(folder: Path) -> list[dict]:
    """All tables in all formats, and what the page says of them."""
    rows = []
    (folder / "tables").mkdir()
    for item in table.tables():
        names = []
        for kind, make in table.FORMATS.items():
            path = folder / "tables" / f"{item.stem}.{kind}"
            path.write_text(make(item), encoding="utf-8")
            names.append(f"tables/{path.name}")
        rows.append({"number": item.number, "title": item.title, "wide": item.wide, "rows": item.rows,
                     "files": names, "table": item})
    return rows


def figure(number: int, folder: Path) -> dict:
    """A figure of the constant-torque paper, and what the page says of it."""
    return drawn(catalogue.figure(number), folder)


# -- the pages


def everything_of(cases, folder: Path, tell, wanted: own.Wanted, workers=None,
                  **around) -> list[tuple[str, bool]]:
    """Everything: tasks first, by all processes, then the pages. Of each entry a line for each law that a
    motion leaves, and whether a fate is undecided."""
    work = [Task("tables", "papers.report:tables", (folder,), 0.5), *own.tasks(cases, folder, wanted)]
    work += [Task(f"figure {row.number}", "papers.report:figure", (row.number, folder), 1.2)
             for row in catalogue.FIGURES]
    work += [Task(f"chapter {item.paper}", "papers.chapter:section", (item.paper, folder), item.weight)
             for item in CHAPTERS]
    work += [Task(f"audit of {name}", "papers.audit:findings_of", (name,), AUDIT_TAKES.get(name, 6.0))
             for name in audited_papers()]
    work += [Task("numbers of other tools", "papers.validation:validated", (), 5.0)]
    work += ([Task("what answers cost", "papers.report:costs", (cases, folder), 90.0)]
             if wanted.precision else [])
    result = dict(zip([task.label for task in work], done(work, folder, tell, workers)))
    cost = result.get("what answers cost", [])
    nav = _nav(cost)
    _papers(cases, folder, result, nav)
    groups = _cases(cases, folder, result, nav, around)
    audit, tools = _audit(folder, result, nav), _validation(folder, result, nav)
    index.page([result[f"audit of {name}"] for name in audited_papers()], folder, nav=nav, here="where.html")
    index.hard_cases(folder, nav=nav, here="hard-cases.html")
    if cost:
        html.write(folder / "cost.html", "cost.html", title="What answers cost", pages=cost, nav=nav,
                   pictures=[html.picture(path, narrow.beside(path), f"{Path(file).parent}/", words=text)
                             for file, text in COST_PICTURES for path in [folder / file] if path.exists()],
                   here="cost.html")
    _start(cases, folder, result, nav, groups, audit, tools, cost, around)
    return [(value["beyond"], value["open"]) for name, value in result.items() if name.startswith("case ")]


def _nav(cost):
    rows = [("index.html", "Start"), ("constant-torque.html", "Constant torque"),
            *((f"{chapter.paper}.html", chapter.short) for chapter in CHAPTERS), ("cases.html", "Cases"),
            ("audit.html", "Printed formulas"), ("where.html", "Where is it?"),
            ("hard-cases.html", "Hard cases"), ("validation.html", "Other tools")]
    rows += [("cost.html", "Cost")] if cost else []
    return [{"file": file, "title": title} for file, title in rows]


def _papers(cases, folder, result, nav):
    """The pages of the papers. cases: those that have pages, to which tables and figures lead."""
    from markupsafe import Markup
    pages = {stem: f"{own.FOLDER}/{stem}.html" for stem, _ in own.entries(cases)}
    # escaped cell by cell in table.py
    rows = [entry | {"html": Markup(table.html_fragment(entry["table"], pages))}
            for entry in result["tables"]]
    main = result[f"audit of {MAIN}"]
    drawn = [_with_links(result[f"figure {row.number}"], row, main, pages) for row in catalogue.FIGURES]
    html.write(folder / "constant-torque.html", "constant_torque.html", title="Constant torque",
               paper=table.PAPER, tables=rows, nav=nav, here="constant-torque.html", data=index.data(),
               claims=index.claims(*main), figures=drawn)
    audits = {audit[0].figures: audit for audit in (result[f"audit of {name}"] for name in audited_papers())}
    for item in CHAPTERS:
        built, rows = result[f"chapter {item.paper}"], catalogue.of_paper(item.paper)
        built = built | {"figures": [_with_links(one, row, audits[item.paper], pages)
                                     for one, row in zip(built["figures"], rows)]}
        html.write(folder / f"{item.paper}.html", "chapter.html", chapter=built,
                   claims=index.claims(*audits[item.paper]), nav=nav, here=f"{item.paper}.html",
                   title=item.title)


def _with_links(made: dict, row, audited, pages) -> dict:
    """What a page says of a figure, with its rows of the audit and the pages of its cases."""
    return made | index.of_figure(*audited, row.number) | {"cases": index.cases_of(row, pages)}


GROUPS = (("Constant torque along a principal axis",
           lambda case: case.scene.plain and not case.thrusters and torque_axis(case.scene)),
          ("Constant torque in another direction",
           lambda case: case.scene.plain and not case.thrusters and _acts(case.scene)),
          ("No torque", lambda case: case.scene.plain and not case.thrusters),
          ("Spacecraft with thrusters", lambda case: case.thrusters),
          ("A charge in a magnetic field",
           lambda case: _has(case, "charge") and not _has(case, "liquid_cavity")),
          ("A cavity of viscous liquid", lambda case: _has(case, "liquid_cavity")),
          ("Weight and field: tops", lambda case: _has(case, "gravity") or _has(case, "newtonian_field")),
          ("Other effects", lambda case: True))


# look of the answer -> title
LOOKS = {"changes": f"{OUTCOMES[Fate.SPIN_UP].does.capitalize()}, or reaches its limit",
         "conditional": "Bounded on a condition, or undecided",
         "bounded": OUTCOMES[Fate.BOUNDED].head.capitalize(), "": "Sweeps, and cases without a motion"}


def _acts(scene: Scene):
    return any(scene.quadratic().m)


def _has(case, effect):
    return case.variables == "physical" and any(item.name == effect for item in case.scene.effects)


def group(case) -> str:
    """The title of the group of a case: by its effects."""
    return next(title for title, belongs in GROUPS if belongs(case))


def _cases(cases, folder, result, nav, around):
    """A page a case, and the page that lists them by outcome, those of one kind of scene side by side;
    (title, number) of the groups."""
    order = [title for title, _ in GROUPS]
    rows: dict[str, list] = {look: [] for look in LOOKS}
    for stem, _ in sorted(own.entries(cases), key=lambda entry: order.index(group(entry[1][0]))):
        built = result[f"case {stem}"]
        own.write(built, folder / own.FOLDER / f"{stem}.html", "", nav=nav, up="../", below="cases.html",
                  **own.of_one(built, around))
        row = own.listed(stem, built)
        rows["" if "sweep" in built else row["look"]].append(row)
    groups = [{"title": title, "rows": rows[look]} for look, title in LOOKS.items() if rows[look]]
    html.write(folder / "cases.html", "list.html", title="Cases by outcome", groups=groups, nav=nav,
               here="cases.html", **around)
    return [(item["title"], len(item["rows"])) for item in groups]


def _audit(folder, result, nav):
    """The page of the audit; in words how many rows have which verdict."""
    findings = [result[f"audit of {name}"] for name in audited_papers()]
    audit_page.page(findings, folder / "audit.html", nav=nav, here="audit.html")
    return audit_page.counts([finding for _, rows in findings for finding in rows])


def _validation(folder, result, nav):
    findings = result["numbers of other tools"]
    validation.page(findings, folder / "validation.html", nav=nav, here="validation.html")
    return "; ".join(f"{source.title}: {validation.counts(rows)}"
                     for source, rows in validation.told(findings))


# -- what measures times


def _precision_of_kinds(cases, folder, **around):
    """The first case of every kind: the others of a kind have the same effects with other numbers."""
    firsts: dict = {}
    for case in sorted(cases, key=lambda case: case.name != precision_page.FIRST):
        if case.state is not None and case.span is not None and special_of(case) is None:
            firsts.setdefault(precision_page.kind(case), case)
    left = len(own.entries(cases)) - len(firsts)
    return precision_page.page(firsts.values(), folder,
                               passed=(
                                   f"{left} other cases, with the effects of one of these and other "
                                   f"numbers",) if left else (), **around)


def _growth(cases, folder, **around):
    case = next((case for case in cases if case.name == GROWING), None)
    return case and cost_growth.page(case, folder, **around)


def _effects(cases, folder, **around):
    return cost_effects.page(folder, **around)


# (title, what it says, page(cases, folder) -> its path, or None where the cases do not call for it)
COSTS = (("What accuracy costs",
          "every way to follow each motion: error against time, and the cheapest way to each digit",
          _precision_of_kinds),
         ("How cost grows", "with the number of states, the digits, and closeness to the separatrix",
          _growth), ("What each effect costs", "state, equations and time as effects are added one at a time",
                     _effects))


# with which the page of costs begins, where they were drawn
COST_PICTURES = ((precision_page.OVERVIEW, "Time against digits; solid: a run that is repeated in the same "
                  "process; dashed: the first run, with import and compiling"),
                 (cost_effects.BAR, "Time of one evaluation as effects are added one after the other"))


def costs(cases, folder: Path) -> list[dict]:
    """The pages that hold measured times, one after the other by one process: never two measurements at once.
    """
    built = [(title, text, page(cases, folder, nav=_nav(True), below="cost.html"))
            for title, text, page in COSTS]
    return [{"title": title, "words": text, "file": path.name} for title, text, path in built if path]


def _hero(cases, result) -> dict | None:
    """The answer to a stuck thruster that the start page begins with: of a spacecraft with wheels, if one is
    among the cases."""
    craft = [(stem, members[0]) for stem, members in own.entries(cases)
             if len(members) == 1 and members[0].thrusters and special_of(members[0]) is None]
    for stem, _ in sorted(craft, key=lambda item: not item[1].wheels):
        made = result[f"case {stem}"]["case"]
        picture = next((item for item in made["pictures"] if item["kind"] == "time"), None)
        if picture:
            short = "; ".join(f"{name}: {value} {note}".strip() for name, value, note in made["tiles"][:3])
            return {"file": f"{own.FOLDER}/{stem}.html", "title": made["title"], "headline": made["headline"],
                    "first": made["first"], "small": made["small"], "look": made["look"],
                    "picture": picture, "body": made["body"],
                    "folder": f"{own.FOLDER}/", "short": short}
    return None


def _edge(cases, result) -> tuple[str, str] | None:
    """(what is said, page) of the first bounded motion under a torque whose distance from the separatrix is
    known."""
    for stem, members in own.entries(cases):
        built = result[f"case {stem}"]
        if "sweep" not in built and built["case"]["look"] == "conditional" and members[0].scene.plain:
            *_, (_, value, note) = built["case"]["tiles"] or [("", "", "")]
            if note.startswith("the smallest change"):
                return f"{written(built['case']['title'])}: {value}, {note}", f"{own.FOLDER}/{stem}.html"
    return None


def _examples(cases, result) -> list[dict]:
    """A card for the first case of every group that has a picture."""
    rows: dict[str, dict] = {}
    for stem, members in own.entries(cases):
        row = own.listed(stem, result[f"case {stem}"])
        if row["thumbnail"]:
            rows.setdefault(group(members[0]), row)
    return [rows[title] for title, _ in GROUPS if title in rows]


def _questions(cases, result, hero, audit, cost) -> list[dict]:
    """(question, its answer, where more of it stands) of what the report answers."""
    edge = _edge(cases, result)
    rows = [("My thruster is stuck: what happens, how soon, how large?", hero["short"], hero["file"])
            ] if hero else []
    rows += [("How far is it from the edge, the separatrix?", *edge)] if edge else []
    rows += [("What does accuracy cost in time?", "; ".join(page["words"] for page in cost), "cost.html")
             ] if cost else []
    rows += [("Where do formulas that are right on paper lose their digits?",
              "hard cases, each with what a plain evaluation gives and what is done instead",
             "hard-cases.html"),
             ("What do the five papers say, and what is so?", f"of their equations and claims {audit}",
              "where.html")]
    return [{"question": question, "words": text, "file": file} for question, text, file in rows]


def _start(cases, folder, out, nav, groups, audit, tools, cost, around):
    """The first page: a stuck thruster as it is answered, the questions, the finest picture, and what is
    inside."""
    hero = _hero(cases, out)
    drawn = [row.number for row in catalogue.FIGURES if not row.added]
    text = {"constant-torque.html": f"{table.PAPER}: tables 1 to {max(table.EXTREMES)}, figures {drawn[0]} "
                                     f"to {drawn[-1]}, recomputed and corrected",
             "cases.html": "; ".join(f"{title[0].lower()}{title[1:]} ({some(number, 'case')})"
                                     for title, number in groups),
             "audit.html": "every numbered equation of five papers, tried on the equations of motion: "
                           f"{audit}",
             "validation.html": tools,
             "where.html": "every equation, figure, table and claim of the five papers, with its place",
             "hard-cases.html": "where formulas that are right on paper lose their digits",
             "cost.html": "What accuracy, many states and each effect cost, measured"}
    text |= {f"{item.paper}.html": f"{item.title}: {catalogue.PAPERS[item.paper]}" for item in CHAPTERS}
    cards = [page | {"words": text[page["file"]]} for page in nav if page["file"] != "index.html"]
    picture = out.get(f"figure {FINEST}") or out[f"figure {catalogue.FIGURES[0].number}"]
    html.write(folder / "index.html", "start.html", title=TITLE, picture=picture, cards=cards, nav=nav,
               hero=hero, examples=_examples(cases, out),
               questions=_questions(cases, out, hero, audit, cost), here="index.html", **around)


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
            left = everything_of(loaded, folder, tell, wanted, workers, **around)
        else:
            around["extra"] = _precision(loaded, folder, tell) if wanted.precision else ()
            left = own.pages(loaded, folder, tell, wanted, workers, **around)
    if beyond is not None:
        beyond += headline.together(line for lines, _ in left for line in lines.splitlines())
    if undecided is not None:
        undecided += [stem for (stem, _), (_, open_) in zip(own.entries(loaded), left) if open_]
    return out / "index.html"


def report(case: Given, out: str | os.PathLike[str] = "report", precision: bool = False,
           certify: bool = False, workers: int | None = None, *, state: Start | None = None,
           span: Span | None = None) -> Path:
    """Write the pages on a case into the folder `out`, as `stabilab report` does; precision: what accuracy
    costs as well; certify: a certificate, checked. Returns the path of index.html. Raises
    InputError where a package that draws is not installed."""
    return write([as_text(case, state, span)], out, precision=precision, certify=certify, workers=workers)


def of_all(cases):
    """The cases that a report is on: those given, or all of the papers."""
    paths = list(cases or [*sorted(table.case_files(), key=lambda p: _natural(Path(p).stem)),
                           *table.case_files(("burns/*", "orbits/*"))])
    return [case for item in paths for case in ([item] if hasattr(item, "scene") else load_each(item))]


def _natural(name):
    stem, _, number = name.rpartition("-")
    return (stem, int(number)) if number.isdigit() else (name, 0)


def command(cases, papers, precision, certify) -> str:
    """What was typed, but for the folder."""
    options = [name for name,
               source in (("--papers", papers), ("--precision", precision), ("--certify", certify)) if source]
    return " ".join(["stabilab report", *dict.fromkeys(case.path for case in cases), *options])


def _precision(cases, folder, tell):
    path = precision_page.page([members[0] for _, members in own.entries(cases)
                                if special_of(members[0]) is None], folder, tell)
    return [{"title": "What accuracy costs", "words": "every way to follow the motion, error against time",
             "file": path.name}]


@contextmanager
def _progress(supplied):
    if supplied or not sys.stderr.isatty():
        yield supplied or (lambda text: None)
        return
    from rich.console import Console
    console = Console(stderr=True)
    with undoing(lambda: os.write(2, SHOW_CURSOR)), console.status("report") as status:
        yield lambda text: status.update(f"report: {text}")


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
