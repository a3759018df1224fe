"""The cells of an atlas at their depths: which lies beside which, and which are to be cut because the answer changes across an edge."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .cells import DEEPEST, cell_at, neighbours


@dataclass(frozen=True)
class Leaves:
    """wheel, level, number: (n,) of each cell, together the whole sphere once for every wheel; in order along it."""

    wheel: np.ndarray
    level: np.ndarray
    number: np.ndarray

    @property
    def begin(self) -> np.ndarray:
        """(n,): where each cell begins on the line of the deepest cells."""
        return self.number << 2 * (DEEPEST - self.level)

    def order(self) -> np.ndarray:
        """The order by wheel and along the sphere."""
        return np.lexsort((self.begin, self.wheel))

    def taken(self, rows: np.ndarray) -> Leaves:
        """Some of them."""
        return Leaves(self.wheel[rows], self.level[rows], self.number[rows])

    def holding(self, wheel: int, places: np.ndarray) -> np.ndarray:
        """(n,): rows of the cells that hold places (n, 3) on the octahedron, beside one wheel; cells in order."""
        own = np.flatnonzero(self.wheel == wheel)
        deepest = int(self.level[own].max())
        at = cell_at(deepest, places) << 2 * (DEEPEST - deepest)
        return own[np.searchsorted(self.begin[own], at, side="right") - 1]

    def beside(self) -> np.ndarray:
        """(pairs, 2): rows of cells that share an edge, or a part of one: each cell with those of its neighbours that are as large as it is, or larger."""
        begin, pairs = self.begin, []
        for wheel in np.unique(self.wheel):
            own = np.flatnonzero(self.wheel == wheel)
            starts = begin[own]
            for level in np.unique(self.level[own]):
                rows = own[self.level[own] == level]
                near = neighbours(int(level), self.number[rows]) << 2 * (DEEPEST - level)
                holder = own[np.searchsorted(starts, near, side="right") - 1]  # the cell that holds the first part of the neighbour
                kept = self.level[holder] <= level  # a neighbour that is cut finds this one from its own side
                pairs.append(np.stack([np.repeat(rows, 3)[kept.ravel()], holder[kept]], axis=1))
        return np.concatenate(pairs)

    def to_cut(self, kinds: np.ndarray, deepest: int) -> np.ndarray:
        """Rows of cells, less deep than `deepest`, beside one of another kind."""
        pairs = self.beside()
        differ = pairs[kinds[pairs[:, 0]] != kinds[pairs[:, 1]]].ravel()
        return np.unique(differ[self.level[differ] < deepest])

    def children(self, rows: np.ndarray) -> Leaves:
        """The four parts of each of these cells."""
        four = np.repeat(rows, 4)
        return Leaves(self.wheel[four], self.level[four] + 1, 4 * self.number[four] + np.tile(np.arange(4), len(rows)))
