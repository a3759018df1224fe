"""Where is equation (30), figure 7, table 3 of a paper? Every item with its verdict and its place."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

from ..show.terminal.letters import written
from .audit.page import counted
from .figures.catalogue import of_paper
from .table import EXTREMES

SCHEMA = "stabilab.papers/1"
MODEL = "a sketch, drawn from a case of the paper"


@dataclass(frozen=True)
class Item:
    """paper: its name in the audit; item: "(30)", "figure 7", "table 3", or "text-..." of a claim of the
    text; says: what it is; verdict; place: the command that shows it."""

    paper: str
    item: str
    says: str
    verdict: str
    place: str


NAMED = ("data", "figure", "table")  # items whose verdict is in words
# paper -> the case file that its data begin with
DATA = {"constant-torque": "minor-axis-100", "charged": "charged-sweep", "cavity": "liquid-base",
        "top": "top-lx30-lz30"}


def items(findings: Sequence[tuple[Any, Sequence[Any]]]) -> list[Item]:
    """Of (paper, findings of the audit) pairs: equations and claims in order, then data, figures, tables."""
    return [item for paper, group in findings for item in _of_paper(paper, group)]


def _of_paper(paper: Any, group: Sequence[Any]) -> list[Item]:
    found = []
    for finding in group:
        name = finding.row.equation
        if not name.startswith("table-"):
            item = name if name.startswith("text") else f"({name})"
            found.append(Item(paper.name, item, finding.row.says, finding.verdict,
                              f"stabilab audit {paper.name} --equation {name}"))
    if paper.figures:
        found.append(Item(paper.name, "data", "of its figures and tables", "in case files as it prints them; "
                          "what it leaves out is completed there, and said",
                          f"stabilab show cases/{DATA[paper.figures]}.toml"))
    figures = [row for row in of_paper(paper.figures) if not row.added] if paper.figures else []
    for figure in figures:
        claims = [f for f in group if figure.number in f.row.options.get("figures", ())]
        wrong = sum(f.verdict == "wrong" for f in claims)
        verdict = MODEL if figure.number == 1 else "drawn from the exact equations" + (
            f"; {wrong} of {len(claims)} audited claims about it wrong" if claims else "")
        found.append(Item(paper.name, f"figure {figure.number}", figure.title, verdict, figure.command))
    return found + [_table(paper, finding) for finding in group if finding.row.equation.startswith("table-")]


def _table(paper: Any, finding: Any) -> Item:
    number = finding.row.equation.removeprefix("table-")
    says = finding.row.says
    if paper.figures == "constant-torque":
        says = EXTREMES[int(number)][1] if int(number) in EXTREMES else "Equilibria and their stability"
        beside = ", beside what the printed formulas give" if int(number) in EXTREMES else ""
        return Item(paper.name, f"table {number}", says, f"worked out anew{beside}",
                    "stabilab tables --out tables")
    return Item(paper.name, f"table {number}", says, finding.verdict,
                f"stabilab audit {paper.name} --equation {finding.row.equation}")


def as_dict(findings: Sequence[tuple[Any, Sequence[Any]]]) -> dict[str, Any]:
    """The object of `stabilab papers --json`."""
    return {"schema": SCHEMA, "rows": [asdict(item) for item in items(findings)]}


def text(findings: Sequence[tuple[Any, Sequence[Any]]]) -> str:
    """A block a paper: a line an item, its verdict and what it says, then how to see it."""
    parts = []
    for paper, group in findings:
        rows = _of_paper(paper, group)
        wide = max(len(row.item) for row in rows)
        lines = [f"{paper.title}: {len(rows)} items; `stabilab audit {paper.name} --equation 30` shows one",
                 *(f"  {row.item:<{wide}}  {verdict_words(row)}{': ' * bool(row.says)}{written(row.says)}"
                   f"{_shown(row)}" for row in rows)]
        parts.append("\n".join(lines))
    return "\n\n".join(parts)


def verdict_words(row: Item) -> str:
    """The verdict as one says it."""
    return row.verdict if row.item.startswith(NAMED) else counted(row.verdict, 1)


def _shown(row: Item) -> str:
    return f" -> {row.place}" if row.item.startswith(NAMED) and row.place else ""
