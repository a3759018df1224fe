"""The box dimension of a boundary, by counting the cells of every depth that hold a piece of it, and how well such a count knows it.

A line that has a length is met by a number of cells that doubles from depth to depth: dimension 1. Where the count grows as 2^(D depth), with D above 1,
the boundary is rough at all these sizes: a fate near it is less predictable than the state is known.
"""
from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

FEWEST = 3     # depths of a fit
COARSEST = 8   # cells that a boundary shall fill at the coarsest depth that counts
SHARE = 2      # standard errors


@dataclass(frozen=True)
class Dimension:
    """value, uncertainty: nan where there is too little to fit; depths, counts: cells that hold a piece of the boundary, per depth; used: the depths of the
    fit; reason: how it is known, or why it is not."""

    value: float
    uncertainty: float
    depths: tuple[int, ...]
    counts: tuple[int, ...]
    used: tuple[int, ...]
    reason: str


def counted(row: np.ndarray, column: np.ndarray, depth: int) -> tuple[int, ...]:
    """How many cells of each depth 0 ... depth hold one of the finest cells at rows and columns."""
    cells = np.stack([row, column], axis=1).astype(np.int64)
    return tuple(len(np.unique(cells >> depth - n, axis=0)) if len(cells) else 0 for n in range(depth + 1))


def dimension(counts: tuple[int, ...]) -> Dimension:
    """The slope of the binary logarithm of the counts over the depths, by least squares over the depths at which COARSEST cells at least hold a piece.

    The uncertainty is twice the standard error of the slope; besides, as what bends the line is no chance, the farthest that the slope moves where
    the fit leaves out the coarsest or the finest of its depths; and what a cell more or less at every depth would do (a line may or may not touch one
    more where it turns).
    """
    depths = tuple(range(len(counts)))
    used = tuple(n for n in depths if counts[n] >= COARSEST)
    if len(used) < FEWEST:
        few = f"only {len(used)} depths have {COARSEST} cells on the boundary or more; {FEWEST} are needed: go deeper"
        why = few if counts[-1] else "there is no boundary"
        return Dimension(math.nan, math.nan, depths, counts, used, why)
    heights = [math.log2(counts[n]) for n in used]
    slope, error = _line(used, heights)
    parts = [_line(used[low:high], heights[low:high])[0] for low, high in ((1, len(used)), (0, len(used) - 1))] if len(used) > FEWEST else \
            [b - a for a, b in zip(heights, heights[1:])]
    moved = max(abs(part - slope) for part in parts)
    words = (f"slope of log2(cells) over depths {used[0]} to {used[-1]}; twice its standard error, how far it moves without the coarsest or finest depth, and "
             "what one cell at every depth makes of it")
    return Dimension(slope, SHARE * error + moved + _of_one_cell(used, counts), depths, counts, used, words)


def _of_one_cell(used: tuple[int, ...], counts: tuple[int, ...]) -> float:
    """By how much the slope may change where each count changes by one."""
    far = np.array(used) - np.mean(used)
    return float(np.abs(far) @ [1 / (counts[n] * math.log(2)) for n in used] / (far @ far))


def _line(x, y) -> tuple[float, float]:
    """(slope, its standard error) of the line of least squares."""
    x, y = np.array(x, float), np.array(y, float)
    dx = x - x.mean()
    square = float(dx @ dx)
    slope = float(dx @ y) / square
    rest = y - y.mean() - slope * dx
    return slope, math.sqrt(float(rest @ rest) / (len(x) - 2) / square) if len(x) > 2 else 0.0
