"""What the analyses of surfaces and runs answer: frozen results that hold arrays."""
from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np


@dataclass(frozen=True)
class Sheet:
    """One sheet of the separatrix as a parametric grid.

    points: (n, m, 3) array; row r is the homoclinic curve at one value of the invariant, rows run from the fold
    outward, columns run once around the loop from the saddle (column 0) back to the saddle (column -1).
    residual: (n, m) distance from the surface in energy, relative to what the size of the point, rounded, moves in it.
    saddle: (n, 3) the saddle equilibria at the rows; centre: (n, 3) the enclosed centres. error: estimate, from the
    grid's second differences, of the largest distance of flat facets from the surface, in the unit of the points; cut: +1
    where facets of the first half of the columns are cut from (r, c) to (r + 1, c + 1), -1 the other way; the second half
    mirrors it.
    """

    name: str
    points: np.ndarray
    residual: np.ndarray
    saddle: np.ndarray
    centre: np.ndarray
    invariant: np.ndarray
    error: float | None = None
    cut: int = 1


@dataclass(frozen=True)
class Separatrix:
    """Every sheet of the separatrix inside the asked-for range; reason says why there is none or what bounds it."""

    sheets: tuple[Sheet, ...]
    reason: str
