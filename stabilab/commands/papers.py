"""Commands about the papers (the audit of their formulas, other tools' numbers, their tables and figures),
and the report.

`stabilab report` and `rerun`: a folder of pages, and whether the same command makes the same bytes."""
from __future__ import annotations

import sys

from ..errors import ToleranceNotMet
from ..papers import index, table
from ..papers.audit import audited
from ..papers.audit import page as audit_page
from ..papers.figures import catalogue
from ..papers.report import write as write_report
from ..papers.validation import comparison, validated
from ..show import manifest
from ..show.manifest import rerun as repeated
from ..show.progress import counted
from ..show.terminal import say, tell, width
from .common import load_cases
from .writing import either, leave_undecided, unphysical, write


def audit(paper, equation, json, out):
    """Hold the formulas of a paper, or of all, against the equations of motion."""
    with counted() as tell:
        findings = audited(paper, equation, tell)
    if out is not None:
        say(f"written: {audit_page.page(findings, out)}")
    either(json, lambda: audit_page.as_dict(findings),
           lambda: audit_page.text(findings, min(width() or 100, 100)))


def validate(source, json, out):
    """Hold the numbers of another tool, or of all, against ours."""
    with counted() as tell:
        result = validated(source, tell)
    if out is not None:
        say(f"written: {comparison.page(result, out)}")
    either(json, lambda: comparison.as_dict(result), lambda: comparison.text(result))
    if apart := comparison.unexplained(result):
        raise ToleranceNotMet("\n".join(apart))


def papers(paper, json):
    """Where every equation, figure, table and claim of a paper, or of all, is, and what is said of it."""
    if paper is not None and paper.endswith(".toml"):
        with counted() as tell:
            findings = [audited(paper, None, tell)[0]]
    else:
        findings = index.recorded(paper)
    either(json, lambda: index.as_dict(findings), lambda: index.text(findings))


def tables(out):
    """Write the tables of the constant-torque paper."""
    with manifest.written(out, sys.argv[1:], table.case_files(table.STEMS), table.TOLERANCES) as folder:
        with counted() as tell:
            built = table.write_tables(folder, tell)
    write("\n".join(str(out / path.relative_to(folder)) for path in built))


def figures(numbers, paper, out):
    """Draw the figures of one paper, or of all."""
    rows = catalogue.chosen(numbers, paper)
    with manifest.written(out, sys.argv[1:], table.case_files(),
                          {row.file: row.tolerance for row in rows}) as folder:
        built = catalogue.write(numbers, folder, paper_name=paper)
    write("\n".join(str(out / path.relative_to(folder)) for path in built))


def report(cases, out, papers, precision, certify, workers, strict):
    """Write the pages; the laws that do not hold are told beside the path."""
    beyond: list[str] = []
    undecided: list[str] = []
    loaded = load_cases(cases or [], special=True)
    built = write_report(loaded, out, arguments=sys.argv[1:], papers=papers, precision=precision,
                        certify=certify,
                        workers=workers, beyond=beyond, undecided=undecided)
    write("\n".join([*beyond, str(built)]))
    leave_undecided(strict, bool(beyond or undecided) or unphysical(loaded))


def rerun(manifest, out):
    """Repeat what a manifest says."""
    tell("\n".join(repeated(manifest, out)))
