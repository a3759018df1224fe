"""Cells of a plane that are split where the labels of their corners differ, again and again: the boundary between labels, followed to small cells.

Places are whole numbers on the finest grid: cells of depth k are 2^(depth - k) of its steps wide. A cell is split where two of its corners have
different labels, and where the boundary leaves it unseen: a smaller neighbour has two such corners on the side that they share. So a piece of the
boundary that is found anywhere is followed to its end; a piece that no side of a coarse cell shows remains unseen, as with any grid.
"""
from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import numpy as np

Ask = Callable[[np.ndarray], np.ndarray]  # keys of places (n,), rising -> their labels (n,)
MOST = 4_000_000  # places asked for


@dataclass
class Mesh:
    """cells: of the coarse grid along both axes; depth: how often a cell may be split. keys, labels: of all places asked for, rising; leaves: per
    depth the numbers of the cells that are not split, rising; split: of those that are. full: whether refinement stopped for MOST."""

    cells: tuple[int, int]
    depth: int
    keys: np.ndarray = field(default_factory=lambda: np.empty(0, np.int64))
    labels: np.ndarray = field(default_factory=lambda: np.empty(0, np.int64))
    leaves: list[np.ndarray] = field(default_factory=list)
    split: list[np.ndarray] = field(default_factory=list)
    full: bool = False

    @property
    def width(self) -> int:
        """Places along the second axis of the finest grid."""
        return (self.cells[1] << self.depth) + 1

    def places(self, keys: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(place along the first axis, along the second) of keys."""
        return keys // self.width, keys % self.width

    def at(self, depth: int, cells: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(row, column) of cells of a depth among all of that depth."""
        across = self.cells[1] << depth
        return cells // across, cells % across

    def number(self, depth: int, row: np.ndarray, column: np.ndarray) -> np.ndarray:
        """The numbers of the cells of a depth at rows and columns."""
        return row * (self.cells[1] << depth) + column

    def corners(self, depth: int, cells: np.ndarray) -> np.ndarray:
        """(n, 4): keys of the corners of cells, (0, 0), (0, 1), (1, 0), (1, 1)."""
        row, column = self.at(depth, cells)
        step = 1 << self.depth - depth
        return np.stack([(row + i) * step * self.width + (column + j) * step for i in (0, 1) for j in (0, 1)], axis=1)

    def labels_of(self, keys: np.ndarray) -> np.ndarray:
        """The labels of places asked for."""
        return self.labels[np.searchsorted(self.keys, keys)]

    def mixed(self, depth: int, cells: np.ndarray) -> np.ndarray:
        """(n,): whether the labels of a cell's corners differ."""
        found = self.labels_of(self.corners(depth, cells))
        return (found != found[:, :1]).any(axis=1)

    @property
    def boundary(self) -> np.ndarray:
        """The finest cells whose corners differ."""
        cells = self.leaves[self.depth]
        return cells[self.mixed(self.depth, cells)]


def refined(cells: tuple[int, int], depth: int, ask: Ask) -> Mesh:
    """The mesh of a plane, asked for its labels only at the corners of cells."""
    mesh = Mesh(cells, depth)
    nothing = np.empty(0, np.int64)
    mesh.leaves = [np.arange(cells[0] * cells[1]), *[nothing] * depth]
    mesh.split = [nothing] * (depth + 1)
    _ask(mesh, mesh.corners(0, mesh.leaves[0]), ask)
    while any(map(len, found := _to_split(mesh))):
        wanted = np.unique(np.concatenate([mesh.corners(n + 1, _children(mesh, n, chosen)).ravel() for n, chosen in enumerate(found)]))
        if len(mesh.keys) + len(wanted) > MOST:
            return _ended(mesh)
        for n, chosen in enumerate(found):
            _split(mesh, n, chosen)
        _ask(mesh, wanted, ask)
    return mesh


def _ended(mesh: Mesh) -> Mesh:
    """The mesh on the grid of the finest cells that there are, where more places would be needed than are asked for."""
    depth = max(n for n, cells in enumerate(mesh.leaves) if len(cells))
    row, column = (place >> mesh.depth - depth for place in mesh.places(mesh.keys))
    return Mesh(mesh.cells, depth, row * ((mesh.cells[1] << depth) + 1) + column, mesh.labels, mesh.leaves[:depth + 1], mesh.split[:depth + 1], True)


def _ask(mesh: Mesh, wanted: np.ndarray, ask: Ask) -> None:
    new = np.setdiff1d(wanted, mesh.keys)
    if len(new):
        order = np.argsort(keys := np.concatenate([mesh.keys, new]), kind="stable")
        mesh.labels = np.concatenate([mesh.labels, np.asarray(ask(new), np.int64)])[order]
        mesh.keys = keys[order]


def _children(mesh: Mesh, depth: int, cells: np.ndarray) -> np.ndarray:
    row, column = mesh.at(depth, cells)
    return np.sort(np.concatenate([mesh.number(depth + 1, 2 * row + i, 2 * column + j) for i in (0, 1) for j in (0, 1)]))


def _split(mesh: Mesh, depth: int, chosen: np.ndarray) -> None:
    mesh.leaves[depth] = np.setdiff1d(mesh.leaves[depth], chosen, assume_unique=True)
    mesh.split[depth] = np.union1d(mesh.split[depth], chosen)
    mesh.leaves[depth + 1] = np.union1d(mesh.leaves[depth + 1], _children(mesh, depth, chosen))


def _to_split(mesh: Mesh) -> list[np.ndarray]:
    """Per depth but the last the leaves that are to be split: mixed ones, and those on which a smaller neighbour's mixed side lies."""
    found = [cells[mesh.mixed(n, cells)] for n, cells in enumerate(mesh.leaves[:-1])]
    missing = np.empty(0, np.int64)  # cells of depth n + 1 across a mixed side that are not there
    for n in range(mesh.depth - 1, -1, -1):
        beyond = np.union1d(missing, _across(mesh, n + 1))
        there = np.union1d(mesh.leaves[n + 1], mesh.split[n + 1])
        row, column = mesh.at(n + 1, np.setdiff1d(beyond, there, assume_unique=True))
        above = np.unique(mesh.number(n, row // 2, column // 2))
        here = np.isin(above, mesh.leaves[n])
        found[n] = np.union1d(found[n], above[here])
        missing = above[~here]  # not even these are there: their own ancestors go first
    return found


def _across(mesh: Mesh, depth: int) -> np.ndarray:
    """The cells of a depth that share a side whose ends differ with a cell of that depth."""
    cells = np.union1d(mesh.leaves[depth], mesh.split[depth])
    if not len(cells):
        return cells
    row, column = mesh.at(depth, cells)
    labels = mesh.labels_of(mesh.corners(depth, cells))
    rows, columns = (n << depth for n in mesh.cells)
    out = []
    for (one, other), (down, right) in SIDES.items():
        beside_row, beside_column = row + down, column + right
        crossed = (labels[:, one] != labels[:, other]) & (0 <= beside_row) & (beside_row < rows) & (0 <= beside_column) & (beside_column < columns)
        out.append(mesh.number(depth, beside_row[crossed], beside_column[crossed]))
    return np.unique(np.concatenate(out))


SIDES = {(0, 1): (-1, 0), (2, 3): (1, 0), (0, 2): (0, -1), (1, 3): (0, 1)}  # corners of a side -> the way to the cell beyond it


def leaves(mesh: Mesh) -> Iterator[tuple[int, np.ndarray]]:
    """(depth, numbers of the cells) that are not split."""
    yield from ((n, cells) for n, cells in enumerate(mesh.leaves) if len(cells))
