"""The answers about surfaces and distances are frozen results; these are their classes."""
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from ...representation import Compared, Shown

if TYPE_CHECKING:
    import numpy as np

AGREE = 1e-6  # relative: nearer than that, lower bound and witness are one number


@dataclass(frozen=True, eq=False)
class Branch(Compared):
    """One branch of the separatrix as a parametric grid.

    points: (n, m, 3) array; row r is the homoclinic curve at one value of the invariant, rows run from the
    fold outward, columns run once around the loop from the saddle (column 0) back to the saddle (column -1).
    residual: (n, m) distance from the surface in energy, relative to what the size of the point, rounded,
    moves in it. saddle: (n, 3) the saddle equilibria at the rows; centre: (n, 3) the enclosed centres. error:
    estimate, from the grid's curvatures, of the largest distance of flat facets from the surface, in
    the unit of the points; cut: +1 where facets of the first half of the columns are cut from (r, c) to (r +
    1, c + 1), -1 the other way; the second half mirrors it.
    """

    name: str
    points: np.ndarray
    residual: np.ndarray
    saddle: np.ndarray
    centre: np.ndarray
    invariant: np.ndarray
    error: float | None = None
    cut: int = 1


@dataclass(frozen=True, repr=False)
class Separatrix(Shown):
    """Every branch of the separatrix inside the range; reason says why there is none or what bounds
    it."""

    branches: tuple[Branch, ...]
    reason: str

    @property
    def sheets(self) -> tuple[Branch, ...]:
        """The branches, by the name that they had before."""
        return self.branches


class Apart(NamedTuple):
    """The distance of a state from the separatrix lies in [lower, upper]; witness: a point of it (three
    rates) at `upper`.

    inf, inf, None where the scene has no separatrix. because: why the two are apart by more than AGREE, else
    empty.
    """

    lower: float
    upper: float
    witness: tuple[float, float, float] | None
    because: str = ""
    boxes: int = 0

    @property
    def value(self) -> float:
        """The distance where it is known to AGREE, else what it certainly is not below; NaN where nothing is
        known of it."""
        return self.upper if self.settled else self.lower if self.upper < math.inf else math.nan

    @property
    def settled(self) -> bool:
        return self.upper == self.lower or self.upper - self.lower <= AGREE * self.upper < math.inf


NO_SEPARATRIX = Apart(math.inf, math.inf, None)
UNKNOWN = Apart(0.0, math.inf, None,
                "the numbers of this scene are beyond what the search for the nearest point of the "
                "separatrix holds")
ENDED = "the search ended before its proved lower bound met the nearest point found"
