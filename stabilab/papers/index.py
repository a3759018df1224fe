"""Where is equation (30), figure 7, table 3 of a paper? Every item with its verdict and its place, as text,
JSON and a page of the report; claims and data of the papers' own pages, and the table of hard cases."""
from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..physics.coefficients import shape_factors
from ..show.report import html
from ..show.terminal import capital, written
from ..theories.printed.claims import Paper, Row, key
from ..theories.printed.claims import paper as paper_named
from ..theories.printed.claims import papers as all_papers
from . import table
from .audit.page import anchor, counted, typeset
from .families import WAVES
from .figures.catalogue import FIRST, of_paper
from .figures.figure import Figure
from .table import EXTREMES

if TYPE_CHECKING:
    from types import SimpleNamespace

SCHEMA = "stabilab.papers/1"
TABLES = "stabilab tables --out tables"
VERDICTS = Path(__file__).with_name("verdicts.toml")
MODEL = "a sketch, drawn from a case of the paper"


@dataclass(frozen=True)
class Item:
    """paper: its name in the audit; item: "(30)", "figure 7", "table 3", or "text-..." of a claim of the
    text; says: what it is; verdict; place: the command that shows it; page: where it is in the folder of
    `stabilab report --papers`."""

    paper: str
    item: str
    says: str
    verdict: str
    place: str
    page: str


NAMED = ("data", "figure", "table", "integrals")  # items whose verdict is in words
# paper -> the case file that its data begin with
DATA = {"constant-torque": "minor-axis-100", "charged": "charged-sweep", "cavity": "liquid-base",
        "top": "top-lx30-lz30"}


@dataclass(frozen=True)
class Recorded:
    """A row with the verdict that the audit gives it, from the record that comes with the program."""

    row: Row
    verdict: str


def recorded(name: str | None = None) -> list[tuple[Paper, list[Recorded]]]:
    """(paper, its rows in order) of one paper, by any of its names, or of all, without an audit. InputError
    for an unknown name."""
    verdicts = tomllib.loads(VERDICTS.read_text(encoding="utf-8"))
    out = []
    for item in map(paper_named, all_papers() if name is None else (name,)):
        rows = sorted(item.rows, key=lambda row: key(row.equation))
        out.append((item, [Recorded(row, verdicts[item.name][row.equation]) for row in rows]))
    return out


def items(findings: Sequence[tuple[Any, Sequence[Any]]]) -> list[Item]:
    """Of (paper, findings of the audit) pairs: equations and claims in order, then data, figures, tables."""
    return [item for paper, group in findings for item in _of_paper(paper, group)]


def _of_paper(paper: Paper, group: Sequence[Any]) -> list[Item]:
    def item(name: str, says: str, verdict: str, command: str) -> Item:
        return Item(paper.name, name, says, verdict, command, link(paper, name))

    rows = []
    for finding in group:
        name = finding.row.equation
        if not name.startswith("table-"):
            rows.append(item(name if name.startswith("text") else f"({name})", finding.row.says,
                             finding.verdict, audit_command(paper, name)))
    if paper.figures:
        rows.append(item("data", "of its figures and tables", "in case files as it prints them; "
                         "what it leaves out is completed there, and said",
                         f"stabilab show cases/{DATA[paper.figures]}.toml"))
    if paper.figures == FIRST:
        rows.append(item("integrals", "F, N, G1, G2, G3 of every motion, the equilibria beside it and their "
                         "eigenvalues", "worked out by the true equations", TABLES))
    figures = [row for row in of_paper(paper.figures) if not row.added] if paper.figures else []
    for figure in figures:
        claims = [f for f in group if figure.number in f.row.options.get("figures", ())]
        wrong = sum(f.verdict == "wrong" for f in claims)
        verdict = MODEL if figure.number == 1 else "drawn from the exact equations" + (
            f"; {wrong} of {len(claims)} audited claims about it wrong" if claims else "")
        rows.append(item(f"figure {figure.number}", figure.title, verdict, figure.command))
    return rows + [item(*_table(paper, finding)) for finding in group
                   if finding.row.equation.startswith("table-")]


def audit_command(paper: Paper, equation: str) -> str:
    """The command that shows a row of the audit."""
    return f"stabilab audit {paper.name} --equation {equation}"


def _table(paper: Paper, finding: SimpleNamespace) -> tuple[str, str, str, str]:
    """(item, what it says, verdict, command) of a table."""
    number = finding.row.equation.removeprefix("table-")
    if paper.figures != FIRST:
        return (f"table {number}", finding.row.says, finding.verdict,
                audit_command(paper, finding.row.equation))
    says = EXTREMES[int(number)][1] if int(number) in EXTREMES else "Equilibria and their stability"
    beside = ", beside what the printed formulas give" if int(number) in EXTREMES else ""
    return f"table {number}", says, f"worked out anew{beside}", TABLES


def as_dict(findings: Sequence[tuple[Any, Sequence[Any]]]) -> dict[str, Any]:
    """The object of `stabilab papers --json`."""
    return {"schema": SCHEMA, "rows": [asdict(item) for item in items(findings)]}


def text(findings: Sequence[tuple[Any, Sequence[Any]]]) -> str:
    """A block a paper: a line an item, its verdict and what it says, then how to see it."""
    parts = []
    for paper, group in findings:
        rows = _of_paper(paper, group)
        wide = max(len(row.item) for row in rows)
        first = next(row for row in rows if not row.item.startswith(NAMED))
        lines = [f"{paper.title}: {len(rows)} items; `{first.place}` shows {first.item}, and so on; "
                 f"in the folder of `stabilab report --papers`: {first.page}",
                 *(f"  {row.item:<{wide}}  {verdict_words(row)}{': ' * bool(row.says)}{written(row.says)}"
                   f"{_shown(row)}" for row in rows)]
        parts.append("\n".join(lines))
    return "\n\n".join(parts)


def verdict_words(row: Item) -> str:
    """The verdict as one says it."""
    return row.verdict if row.item.startswith(NAMED) else counted(row.verdict, 1)


def _shown(row: Item) -> str:
    return f" -> {row.place}, {row.page}" if row.item.startswith(NAMED) and row.place else ""


HEAD = """# Every item of the papers

Every numbered equation, figure and table of the five papers, and every claim of their texts that is tried:
its verdict, the command that shows it, and its place in the folder that `stabilab report --papers` writes. In
the terminal `stabilab papers` prints the same, `--json` as objects. How a verdict is found:
[audit.md](audit.md). `python docs/making/papers.py` writes this page.
"""
MARKS = re.compile(r"([\\\\*_<>\\[\\]|~#])")  # of Markdown


def markdown(findings: Sequence[tuple[Any, Sequence[Any]]]) -> str:
    """The page of the docs: a table a paper and kind of item; figures lead to their pictures."""
    lines = [HEAD]
    for paper, group in findings:
        lines += [f"## {paper.title}", ""]
        for title, rows in _parts(_of_paper(paper, group)):
            if rows:
                lines += [f"### {capital(title)}: {paper.name}", "",
                          "| item | verdict | what it says | command | page |",
                          "| --- | --- | --- | --- | --- |", *(_line(paper, row) for row in rows), ""]
    return "\n".join(lines).rstrip() + "\n"


def _line(paper: Paper, row: Item) -> str:
    kind, _, number = row.item.partition(" ")
    item = row.item
    if kind == "figure":
        file = next(figure.file for figure in of_paper(paper.figures) if figure.number == int(number))
        item = f"[{item}](../figures/{file})"
    phrases = (MARKS.sub(r"\\\1", written(text)) for text in (verdict_words(row), row.says))
    return f"| {' | '.join([item, *phrases, f'`{row.place}`', f'`{row.page}`'])} |"


HARD = Path(__file__).with_name("hard-cases.md")  # a link to the page of the docs


def page(findings: Sequence[tuple[Any, Sequence[Any]]], folder: Path, **around: Any) -> Path:
    """The page "where is it": of each (paper, findings) its items, each a link to where it is shown."""
    papers = []
    for paper, group in findings:
        rows = items([(paper, group)])
        papers.append({"name": paper.name, "title": paper.title, "parts": [
            (title, [_row(row) for row in part]) for title, part in _parts(rows)]})
    return html.write(folder / "where.html", "where.html", title="Where is it?", papers=papers, **around)


PARTS = {"equations": "(", "data": "data", "integrals": "integrals", "figures": "figure", "tables": "table",
         "claims of the text": "text"}  # title -> how its items begin


def _parts(rows: Sequence[Item]) -> list[tuple[str, list[Item]]]:
    """The items of a paper by kind, with a title each."""
    return [(title, [row for row in rows if row.item.startswith(begins)]) for title, begins in PARTS.items()]


def _row(row: Item) -> dict[str, str]:
    return {"item": row.item, "verdict": verdict_words(row), "says": written(row.says),
            "link": row.page}


def link(paper: Paper, item: str) -> str:
    """Where an item is in the report: its figure or table on the page of its paper, else its row of the
    audit."""
    kind, _, number = item.partition(" ")
    main = paper.figures == FIRST
    page = "constant-torque" if main else paper.figures
    if kind == "data":
        return f"{page}.html#data"
    if kind == "integrals":
        return f"{page}.html#table-{table.MOTIONS}"
    if kind == "figure":
        return f"{page}.html#{'figure' if main else page}-{number}"
    if kind == "table" and main:
        return f"{page}.html#table-{number}"
    return f"audit.html#{anchor(paper.name, item.strip('()').replace('table ', 'table-'))}"


def claims(paper: Paper, group: Sequence[Any]) -> list[dict[str, Any]]:
    """Of every claim of the text that can be checked: what it says, whether it is so, what is so, and the
    anchor of its row on the page of the audit."""
    return [_claim(paper, item) for item in group
            if item.row.equation.startswith("text") and item.verdict in ("holds", "only-if", "wrong")]


def _claim(paper: Paper, item: Any) -> dict[str, Any]:
    """What a claim says, whether it is so, what is so in words and in formulas, what it was held against, and
    the anchor of its row."""
    row, note = item.row, item.row.options.get("note", "")
    so, formulas = [item.correction], []
    if item.verdict in ("only-if", "wrong") and row.kind in ("holds", "solves", "equilibrium", "order"):
        meant = ", ".join(f"with {name} = {text}" for name, text in row.corrected_where.items())
        so = [meant.replace("**", "^")]
        formulas = typeset(paper, row.corrected)
    elif row.kind == "number" and item.correction:  # the truth stands in the note, where the formula is wrong
        so = [item.correction if "judged_by" in row.options else f"by that formula {item.correction}", note]
    elif item.verdict == "not-checkable":
        so = [row.options.get("because") or row.options.get("completed", ""), item.correction]
    if item.verdict == "only-if":
        so = [f"only if {item.condition}", *so]
    return {"says": written(row.says), "right": item.verdict == "holds", "word": WORDS[item.verdict],
            "is": written("; ".join(filter(None, so))), "formulas": formulas,
            "against": "; the exact motion: ".join(filter(None, (item.judged_by, item.exact_motion))),
            "link": f"audit.html#{anchor(paper.name, row.equation)}"}


# verdict of a claim -> its word on the page of its paper
WORDS = {"holds": "right", "only-if": "only if", "wrong": "not so", "not-checkable": "not checked"}


def of_figure(paper: Paper, group: Sequence[Any], number: int) -> dict[str, list[dict[str, Any]]]:
    """What a page says beside a figure: "rows", the equations audited with their links, and "claims", the
    sentences of the text about it."""
    about = [item for item in group if number in item.row.options.get("figures", ())]
    return {"rows": [{"equation": item.row.equation,
                      "link": f"audit.html#{anchor(paper.name, item.row.equation)}"}
                     for item in about if not item.row.equation.startswith("text")],
            "claims": [_claim(paper, item) for item in about if item.row.equation.startswith("text")]}


# number of a figure of the main paper -> families of its cases
OF_FIGURES = {**dict.fromkeys(range(1, 8), ("minor-axis",)), **dict.fromkeys(range(8, 12), ("major-axis",)),
              **dict.fromkeys(range(12, 16), ("major-axis-spin3",)),
              **dict.fromkeys((16, 17), ("middle-axis",))}


def cases_of(figure: Figure, pages: Mapping[str, str]) -> list[dict[str, str]]:
    """The cases that a figure draws: name and page, of a combination of a sweep its row there. pages: case
    file -> its page."""
    main = {(f"{family}-{lam}", ""): f"{family}-{lam}" for lam in table.LAMBDAS
            for family in (OF_FIGURES.get(figure.number, ()) if not figure.paper else ())}
    return [{"name": name, "link": pages[file] + (f"#{file}{variant}" if variant not in ("", WAVES) else "")}
            for (file, variant), name in (main or figure.cases).items() if file in pages]


def data() -> list[tuple[str, str]]:
    """(name, its value and meaning) of the main paper's data and scaled numbers."""
    body = table.physical("minor", 0).body
    factors = shape_factors(body)
    k = factors[0] * factors[1] * factors[2]
    scaled = {lam: table.printed_scene("minor", lam) for lam in table.LAMBDAS}
    names = ", ".join(map(str, table.LAMBDAS))
    starts = (("figures 2 to 7, table 2", table.START_MINOR),
              ("figures 8 to 11", table.START_MAJOR),
              ("figures 12 to 15", table.START_CAPTURED),
              ("figures 16 and 17, table 3", table.START_MIDDLE),
              ("table 4", table.START_PLANE))
    return [
        ("D", f"{table.INERTIA} kg m^2: the principal moments, D1 > D2 > D3"),
        ("lambda1", f"{names} kg m^2/s: the gyrostatic moment, along axis 1"),
        ("k1, k2, k3", f"{', '.join(map(str, factors))}: (D2 - D3)/D1, (D1 - D3)/D2, (D1 - D2)/D3; "
                       f"k = k1 k2 k3 = {k}"),
        ("u", "1: the size of the torque (4), sqrt(k2 k3 u1^2 + k3 k1 u2^2 + k1 k2 u3^2)/k "
              "with u_j = M_j/D_j"),
        ("mu", "the direction of the scaled torque: (1, 0, 0), (0, 1, 0) or (0, 0, 1)"),
        ("a", f"{_listed(s.a for s in scaled.values())}: lambda1/((D1 - D3) sqrt(u k1))"),
        ("b", f"{_listed(s.b for s in scaled.values())}: lambda1/((D1 - D2) sqrt(u k1))"),
        ("x(0)", "; ".join(f"{start} in {where}" for where, start in starts))]


def _listed(values: Any) -> str:
    return ", ".join(f"{float(value):.6g}" for value in values)


def hard_cases(folder: Path, **around: Any) -> Path:
    """The page of hard cases: what plain code answers, what stabilab answers, and how well one can know."""
    phrase: list[str] = []
    tables: list[dict[str, Any]] = []
    for line in HARD.read_text(encoding="utf-8").splitlines():
        if line.startswith("## "):
            tables.append({"title": line.removeprefix("## "), "rows": []})
        elif line.startswith("| "):
            tables[-1]["rows"].append([cell.strip() for cell in line.strip("| ").split(" | ")])
        elif not tables and not line.startswith("# "):
            phrase.append(line)
    parts = "\n".join(phrase).replace("*", "").split("\n\n")
    about = [" ".join(part.split()) for part in parts if part.strip()]
    return html.write(folder / "hard-cases.html", "hard_cases.html", title="Hard cases", about=about,
                      tables=tables, **around)
