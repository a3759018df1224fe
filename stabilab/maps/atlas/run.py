"""Running an atlas: a round of the sweep's machinery over all cells, then one for the parts of those that lie along a boundary, and so on."""
from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from ...numbers.vectors import Exact3
from ...orbit.result import Fate
from ..run import run
from .asked import Asked
from .cells import area, middles
from .leaves import Leaves
from .pointed import Point, named_direction


@dataclass(frozen=True)
class Atlas:
    """leaves: the cells; records: (n,) of `columns.record`, what becomes of the motion under a torque to the middle of each. named: directions with a name,
    as they are; named_records: theirs. resumed: points that an earlier run had finished; asked_points: all that were computed."""

    asked: Asked
    leaves: Leaves
    records: np.ndarray
    named: tuple[Point, ...]
    named_records: np.ndarray
    asked_points: int
    resumed: int

    @cached_property
    def directions(self) -> np.ndarray:
        """(n, 3): unit vectors along the principal axes to the middles of the cells."""
        out = np.empty((len(self.records), 3))
        for level in np.unique(self.leaves.level):
            rows = self.leaves.level == level
            out[rows] = middles(int(level), self.leaves.number[rows])
        return out

    @cached_property
    def named_directions(self) -> np.ndarray:
        """(m, 3): unit vectors along the principal axes."""
        return np.array([[float(v) for v in named_direction(self.asked.case, point.level, point.number)] for point in self.named]).reshape(-1, 3)

    @cached_property
    def share(self) -> np.ndarray:
        """(n,): of the sphere."""
        return area(self.leaves.level) / area(0) / 8

    def in_file(self, directions: np.ndarray) -> np.ndarray:
        """(n, 3): the same directions in the frame of the file."""
        frame = self.asked.case.frame
        if frame is None or frame.as_given:
            return directions
        rows = [[float(part) for part in axis] for axis in frame.axes]
        return np.stack([sum(directions[:, i] * rows[i][n] for i in range(3)) for n in range(3)], axis=1)

    def wheel(self, number: int) -> Exact3:
        """A wheel's momentum along the principal axes, N m s."""
        return self.asked.wheels[number]


def kinds_of(records: np.ndarray) -> np.ndarray:
    """(n,): a number for each fate with its axis and sense, for an island that is seen, and for each number of equilibria: boundaries run where it changes."""
    island = (records["island"] == 2) & (records["fate"] == Fate.UNDECIDED)
    return ((records["fate"].astype(int) * 8 + records["spin_axis"] + 3) * 2 + island) * 16 + np.clip(records["equilibria"], -8, 7) + 8


@contextmanager
def drawn(asked: Asked, out: Path | None = None, workers: int | None = None, scheduler: str | None = None) -> Iterator[Atlas]:
    """The finished atlas as a context; what it left beside `out` for a run that is killed is removed when its block ends well. workers, scheduler: as of
    `maps.run.run`."""
    with ExitStack() as rounds:
        named, done, resumed = asked.named, 0, 0

        def told(points: tuple[Point, ...]) -> np.ndarray:
            nonlocal done, resumed
            place = None if out is None else out.with_name(f"{out.name}.{number}") if number else out
            found = rounds.enter_context(run(asked.plan(points), place, workers, scheduler, asked.command))
            done, resumed = done + len(points), resumed + found.resumed
            return found.records

        number = 0
        records = told(named + asked.first)
        named_records, records = records[:len(named)], records[len(named):]
        leaves = Leaves(*(np.array(column, np.int64) for column in zip(*asked.first)))
        while len(rows := leaves.to_cut(kinds_of(records), asked.level + asked.refine)):
            number += 1
            parts = leaves.children(rows)
            found = told(tuple(Point(*one) for one in zip(parts.wheel.tolist(), parts.level.tolist(), parts.number.tolist())))
            leaves, records = _replaced(leaves, records, rows, parts, found)
        yield Atlas(asked, leaves, records, named, named_records, done, resumed)


def _replaced(leaves: Leaves, records: np.ndarray, rows: np.ndarray, parts: Leaves, found: np.ndarray) -> tuple[Leaves, np.ndarray]:
    """The cells with these rows given up for their parts, in order."""
    kept = np.setdiff1d(np.arange(len(records)), rows)
    stay = leaves.taken(kept)
    joined = Leaves(*(np.concatenate([getattr(stay, name), getattr(parts, name)]) for name in ("wheel", "level", "number")))
    order = joined.order()
    return joined.taken(order), np.concatenate([records[kept], found])[order]
