"""The audit in words, as JSON and as a page: a table a paper, each row with its formulas typeset, residual,
correction and how it was checked."""
from __future__ import annotations

import math
import re
import textwrap
from collections import Counter
from collections.abc import Mapping, Sequence
from functools import reduce
from pathlib import Path
from typing import TYPE_CHECKING

from ...representation import values_of
from ...show.report import html
from ...show.report.formulas import inner
from ...show.terminal import ALPHABET, lettered, some
from ...theories.printed.claims import FormulaError, Paper, Row
from .checks import raw
from .findings import VERDICTS

if TYPE_CHECKING:
    from types import SimpleNamespace

    from sympy import Expr

# --- Findings of the audit as text and JSON
SCHEMA = "stabilab.audit/1"


def as_dict(findings: Sequence[tuple[Paper, list[SimpleNamespace]]]) -> dict:
    """{"schema", "rows"} of (paper, findings) pairs."""
    return {"schema": SCHEMA,
            "rows": [_text_row(paper, finding) for paper, group in findings for finding in group]}


def _text_row(paper, finding):
    row = finding.row
    return {
        "paper": paper.name,
        "equation": row.equation,
        **values_of(finding, "verdict condition"),
        "printed": "; ".join(row.printed),
        **values_of(finding, "correction method judged_by exact_motion"),
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


def text(findings: Sequence[tuple[Paper, list[SimpleNamespace]]], width: int = 100) -> str:
    """A paper's count of verdicts in a line, then a paragraph for each row."""
    parts = []
    for paper, group in findings:
        parts.append(f"{paper.title}: {counts(group)}; {some(len(group), 'row')}\n")
        parts += [_paragraph(finding, width, paper.figures) for finding in group]
    return "\n".join(parts)


def counted(verdict: str, count: int) -> str:
    """A verdict as one says it of so many formulas."""
    item, many = {"holds": ("holds", "hold"),
                 "only-if": ("holds only on a condition", "hold only on a condition"),
                 "wrong": ("is wrong", "are wrong"),
                 "definition": ("is a definition", "are definitions"),
                 "not-checkable": ("cannot be checked", "cannot be checked")}[verdict]
    return item if count == 1 else many


def figures_of(finding: SimpleNamespace, paper: str) -> tuple[str, str]:
    """(words, command that draws) of the figures which a row is about; ("", "") where it is about none. A
    wrong formula changes them: they are drawn as printed and in truth."""
    numbers = " ".join(map(str, finding.row.options.get("figures", ())))
    if not (numbers and paper):
        return "", ""
    changes = finding.verdict in ("wrong", "only-if") and not finding.row.equation.startswith("text")
    label = "changes figures, drawn both ways with the size of the difference" if changes else "about figures"
    return label, f"stabilab figures --paper {paper} {numbers}"


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
    if finding.judged_by:
        also = f"; the exact motion: {finding.exact_motion}" if finding.exact_motion else ""
        lines.append(f"compared with {finding.judged_by}{also}")
    if row.options.get("note"):
        lines.append(f"note: {row.options['note']}")
    if finding.unit_fault and finding.verdict != "wrong":
        lines.append(f"units: {finding.unit_fault}")
    about, command = figures_of(finding, paper)
    lines += [f"{about}, by: {command}"] if about else []
    wrapped = [textwrap.fill(lettered(line), width, subsequent_indent=" " * 15,
                             initial_indent=" " * (13 if n else 0)) for n, line in enumerate(lines)]
    return "\n".join(wrapped)


SHORT = {"al": "alpha", "th": "theta", "ps": "psi", "ph": "phi", "gam": "gamma", "Gam": "Gamma",
         "om": "omega", "Om": "Omega", "lam": "lambda",
         "Lam": "Lambda", "ep": "eps"}


def page(findings: Sequence[tuple[Paper, list[SimpleNamespace]]], path: Path, **around) -> Path:
    """The page of (paper, findings) pairs as a file; around: of the pages beside it (`html.render`)."""
    papers = [
        {"name": paper.name, "title": paper.title, "count": count(group),
         "rows": [_row(paper, finding) for finding in group]} for paper, group in findings
    ]
    return html.write(Path(path), "audit.html",
                      title="Published formulas, held against the equations of motion", papers=papers,
                      counted=counted, **around)


def anchor(paper: str, equation: str) -> str:
    """The anchor of a row on the page of the audit: "constant-torque-gyrostat-30"."""
    return f"{paper}-{re.sub(r'[^A-Za-z0-9-]+', '-', equation)}"


def count(group: Sequence[SimpleNamespace]) -> list[tuple[str, int]]:
    """(verdict, how many) in order."""
    result = Counter(f.verdict for f in group)
    return [(verdict, result[verdict]) for verdict in VERDICTS if result[verdict]]


def counts(group: Sequence[SimpleNamespace]) -> str:
    """How many findings have which verdict, in words."""
    return ", ".join(f"{number} {counted(verdict, number)}" for verdict, number in count(group))


def _row(paper: Paper, finding: SimpleNamespace):
    row = finding.row
    return {
        "equation": row.equation,
        "anchor": anchor(paper.name, row.equation),
        "verdict": finding.verdict,
        "condition": _in_full(finding.condition),
        "says": row.says,
        "printed": typeset(paper, row.printed, squares(row)),
        "correction": typeset(paper, row.corrected, squares(row)) if row.corrected
        else [finding.correction] if finding.correction else [],
        "where": _texts(row.where),
        "corrected_where": _texts(row.corrected_where),
        **values_of(finding, "repairs method unit_fault judged_by exact_motion"),
        "residual": f"{finding.residual:.2g}" if finding.verdict in ("wrong", "only-if") else "",
        "figures": figures_of(finding, paper.figures),
        "note": row.options.get("note", ""),
    }


def _in_full(condition: str) -> str:
    """A condition with the whole names of the letters that its formulas abbreviate."""
    return re.sub(r"\b([A-Za-z]+?)(?=\d*\b)", lambda name: SHORT.get(name[1], name[1]), condition or "")


def _texts(table: Mapping[str, str]):
    return [f"{name} = {text}" for name, text in table.items()]


def squares(row: Row) -> tuple[str, ...]:
    """The names of a row that stand for the square of their letter: those of the top's (10), which tells the
    squares of two frequencies."""
    return ("Om", "om") if {"Om", "om"} <= row.where.keys() else ()


def typeset(paper, formulas, squares=()) -> list:
    """Each formula as MathML where it can be read as one, else as its text. squares: names that stand for the
    square of their letter."""
    out = []
    for text in formulas:
        try:
            ((left, right),) = raw(paper, (text,))
            out.append(mathml(left, right, squares))
        except (FormulaError, ValueError):
            out.append(text)
    return out


def mathml(left, right, squares=()):
    """left = right as MathML for a page."""
    import sympy as sp
    from markupsafe import Markup

    names = {s: sp.Symbol(_name(s.name)) ** (2 if s.name in squares else 1)
             for s in left.free_symbols | right.free_symbols}
    equation = sp.Eq(_readable(left.xreplace(names)), _readable(right.xreplace(names)), evaluate=False)
    body = inner(equation, products=False)
    return Markup(f'<math xmlns="http://www.w3.org/1998/Math/MathML">{body}</math>')


def _readable(expression: Expr):
    """rate(f) as the operator d_t on f, a function, for a factor would cancel where two rates are divided;
    the other operators stand by their names."""
    import sympy as sp

    rate = sp.Function("d\u209c")  # with t as its index
    return expression.replace(sp.Function("rate"), lambda f,
                              n=1: reduce(lambda of, _: rate(of), range(int(n)), f))


def _name(name: str):
    """The name that SymPy typesets: a Greek letter, whole or abbreviated, with its number; else a stem with
    the letter or number that is its index."""
    letter = re.fullmatch(r"([A-Za-z]+?)_?(\d*)", name)
    stem, index = letter.groups() if letter else (name, "")
    stem = SHORT.get(stem, stem)
    if stem not in ALPHABET:
        result = re.fullmatch(r"([A-Za-z]+?)_?(\d*|[a-z]?)", name)
        stem, index = result.groups() if result else (name, "")
    stem = "\u03b5" if stem == "eps" else stem  # SymPy would write out the name of this form of the letter
    return f"{stem}_{index}" if index else stem
