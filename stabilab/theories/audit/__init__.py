"""What the papers print, held against the equations of motion: every numbered equation and numeric claim with its verdict.

Published claims are data (`papers/*.toml`, format in docs/audit.md); `findings` is the machine that tries them.
"""

from __future__ import annotations

import multiprocessing
import os
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

from ...errors import InputError
from .claims import Paper, read
from .findings import Finding, audit, key

FOLDER = Path(__file__).parent / "papers"


def papers() -> tuple[str, ...]:
    """Names of the papers on record, in order."""
    return tuple(sorted(path.stem for path in FOLDER.glob("*.toml")))


def paper(name: str) -> Paper:
    """A paper on record by its name, or one in a file of that path. InputError names the known ones."""
    if name.endswith(".toml"):
        return read(Path(name))
    if name not in papers():
        raise InputError(f"unknown paper {name!r}: known are {', '.join(papers())}; a file of claims of your own ends in .toml (docs/audit.md)")
    return read(FOLDER / f"{name}.toml")


Tell = Callable[[int, int, str], None]  # done, count, words: told before each step


def audited(name: str | None = None, equation: str | None = None, tell: Tell | None = None) -> tuple[tuple[Paper, tuple[Finding, ...]], ...]:
    """(paper, findings, rows in order) of one paper, or of all on record by a process a paper. tell: of each row of one paper, of each paper of all.
    InputError for an unknown paper or equation."""
    if name is None and equation is not None:
        raise InputError(f"equation {equation}: name its paper as well: {', '.join(papers())}")
    if name is not None:
        return (findings_of(name, equation, tell),)
    with ProcessPoolExecutor(min(len(papers()), os.cpu_count() or 1), multiprocessing.get_context("spawn")) as pool:
        found = []
        for done, made in enumerate(pool.map(findings_of, papers())):
            found.append(made)
            if tell and len(found) < len(papers()):
                tell(done + 1, len(papers()), papers()[done + 1])
        return tuple(found)


def findings_of(name: str, equation: str | None = None, tell: Tell | None = None) -> tuple[Paper, tuple[Finding, ...]]:
    """(paper, its findings, rows in order), in this process."""
    one = paper(name)
    return one, tuple(sorted(audit(one, equation, tell=tell), key=lambda f: key(f.row.equation)))
