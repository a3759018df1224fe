"""What the papers print, held against the equations of motion: every numbered equation and numeric claim with
its verdict.

Published claims are data (`theories/printed/papers/*.toml`, format in docs/audit.md); `findings` is the
machine that tries them.
"""

from __future__ import annotations

import multiprocessing
import os
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor

from ...errors import InputError
from ...theories.printed.claims import Paper, key, paper, papers
from ...threads import limit_worker
from .findings import Finding, audit, rows_of

Tell = Callable[[int, int, str], None]  # done, count, words: told before each step


def audited(name: str | None = None, equation: str | None = None,
            tell: Tell | None = None) -> tuple[tuple[Paper, tuple[Finding, ...]], ...]:
    """(paper, findings, rows in order) of one paper, or of all on record by a process a paper; of an equation
    without its paper, of those that have it. tell: of each row of one paper, of each paper of all. InputError
    for an unknown paper or equation."""
    if name is None and equation is not None:
        known = [name for name in papers() if rows_of(paper(name), equation)]
        if not known:
            raise InputError(f"equation {equation}: no paper has a row for it; stabilab papers lists all")
        return tuple(findings_of(name, equation, tell) for name in known)
    if name is not None:
        return (findings_of(name, equation, tell),)
    with ProcessPoolExecutor(min(len(papers()), os.cpu_count() or 1),
                             multiprocessing.get_context("spawn"), limit_worker) as pool:
        rows = []
        for done, built in enumerate(pool.map(findings_of, papers())):
            rows.append(built)
            if tell and len(rows) < len(papers()):
                tell(done + 1, len(papers()), papers()[done + 1])
        return tuple(rows)


def findings_of(name: str, equation: str | None = None,
                tell: Tell | None = None) -> tuple[Paper, tuple[Finding, ...]]:
    """(paper, its findings, rows in order), in this process."""
    item = paper(name)
    return item, tuple(sorted(audit(item, equation, tell=tell), key=lambda f: key(f.row.equation)))
