"""Findings of the audit as text and JSON."""

from __future__ import annotations

import math
import textwrap
from collections import Counter

from ...show.terminal.letters import lettered, some
from .findings import VERDICTS

SCHEMA = "stabilab.audit/1"


def as_dict(findings) -> dict:
    """{"schema", "rows"} of (paper, findings) pairs."""
    return {"schema": SCHEMA,
            "rows": [_row(paper, finding) for paper, group in findings for finding in group]}


def _row(paper, finding):
    row = finding.row
    return {
        "paper": paper.name,
        "equation": row.equation,
        "verdict": finding.verdict,
        "condition": finding.condition,
        "printed": "; ".join(row.printed),
        "correction": finding.correction,
        "method": finding.method,
        "says": row.says,
        "residual": _finite(finding.residual),
        "corrected_residual": _finite(finding.corrected_residual),
        "repairs": list(finding.repairs),
        "unit_fault": finding.unit_fault,
        "note": row.options.get("note", ""),
        "figures": list(row.options.get("figures", ())),
    }


def _finite(value):
    return value if math.isfinite(value) else None


def text(findings, width: int = 100) -> str:
    """A paper's count of verdicts in a line, then a paragraph for each row."""
    parts = []
    for paper, group in findings:
        count = Counter(f.verdict for f in group)
        parts.append(f"{paper.title}: " + ", ".join(f"{count[v]} {counted(v, count[v])}" for v in VERDICTS
                                                    if count[v]) + f"; {some(len(group), 'row')}\n")
        parts += [_paragraph(finding, width, paper.figures) for finding in group]
    return "\n".join(parts)


def counted(verdict: str, count: int) -> str:
    """A verdict as one says it of so many formulas."""
    one, many = {"holds": ("holds", "hold"),
                 "only-if": ("holds only on a condition", "hold only on a condition"),
                 "wrong": ("is wrong", "are wrong"),
                 "definition": ("is a definition", "are definitions"),
                 "not-checkable": ("cannot be checked", "cannot be checked")}[verdict]
    return one if count == 1 else many


def figures_changed(row, paper: str) -> str:
    """The command that draws the figures which a wrong formula changes, as printed and in truth; "" where it
    changes none."""
    numbers = " ".join(map(str, row.options.get("figures", ())))
    return f"stabilab figures --paper {paper} {numbers}" if numbers and paper else ""


def _paragraph(finding, width, paper=""):
    row = finding.row
    head = f"{row.equation:<12} {finding.verdict.upper() if finding.verdict == 'wrong' else finding.verdict}"
    head = (head.replace("only-if", f"holds only if {finding.condition}") if finding.verdict == "only-if"
            else head.replace("not-checkable", "cannot be checked"))
    lines = [head + (f": {row.says}" if row.says else "")]
    if finding.verdict in ("wrong", "only-if"):
        lines += ([f"printed: {'; '.join(row.printed)}"]
                  + ([f"instead: {finding.correction}"] if finding.correction else []))
        lines += ([f"holds only if {finding.condition}"] if finding.verdict == "wrong" and finding.condition
                  else [])
        lines += [f"one edit away: {fix}" for fix in finding.repairs if fix != finding.correction]
    lines.append(finding.method
                 + (f", residual {finding.residual:.2g}" if finding.verdict in ("wrong", "only-if") else ""))
    if finding.unit_fault and finding.verdict != "wrong":
        lines.append(f"units: {finding.unit_fault}")
    if command := figures_changed(row, paper):
        lines.append(f"changes figures, drawn both ways with the size of the difference by: {command}")
    wrapped = [textwrap.fill(lettered(line), width, subsequent_indent=" " * 15,
                             initial_indent=" " * (13 if n else 0)) for n, line in enumerate(lines)]
    return "\n".join(wrapped)
