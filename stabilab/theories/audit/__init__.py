"""What the papers print, tried on the true equations: every formula with its verdict and the corrected statement."""
from __future__ import annotations

from functools import lru_cache
from importlib import import_module

from .published import Finding, Published, examine

PAPERS = {  # paper -> modules that hold its rows, in the order of the paper
    "Amer et al. 2024, Sci. Rep. (constant torque, gyrostat)":
        ("general", "minor_axis", "major_and_middle_axis"),
}


def rows(paper: str) -> tuple[Published, ...]:
    """Every published formula of the paper that is on record. KeyError for a paper that is not."""
    return tuple(row for module in PAPERS[paper] for row in import_module(f"{__name__}.{module}").ROWS)


@lru_cache
def check() -> tuple[tuple[str, tuple[Finding, ...]], ...]:
    """(paper, findings) for every paper: each formula tried on the true equations, and its verdict held to the result."""
    return tuple((paper, tuple(examine(row) for row in rows(paper))) for paper in PAPERS)
