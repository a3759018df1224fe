"""`stabilab report` and `rerun`: a folder of pages, and whether the same command makes the same bytes."""
from __future__ import annotations

import sys

from ..papers.report.report import write as write_report
from ..show.files import rerun as repetition
from .common.cases import load_cases
from .common.output import leave_undecided, tell, unphysical, write


def report(cases, out, papers, precision, certify, workers, strict):
    """Write the pages; the laws that do not hold are told beside the path."""
    beyond: list[str] = []
    undecided: list[str] = []
    loaded = load_cases(cases or [])
    made = write_report(loaded, out, arguments=sys.argv[1:], papers=papers, precision=precision,
                        certify=certify,
                        workers=workers, beyond=beyond, undecided=undecided)
    write("\n".join([*beyond, str(made)]))
    leave_undecided(strict, bool(beyond or undecided) or unphysical(loaded))


def rerun(manifest, out):
    """Repeat what a manifest says."""
    tell("\n".join(repetition.rerun(manifest, out)))
