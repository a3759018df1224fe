"""Basins of a plane of initial states: each round of refinement is a sweep over the places that it needs, with a sweep's chunks, workers and parts."""
from __future__ import annotations

import os
import shlex
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from ...case.read import Case
from ...case.units import split
from ...errors import InputError, printable
from ...orbit.result import Fate
from ..boundary import changes, known_exactly
from ..columns import record
from ..listed import packed
from ..plan import Plan, planned
from ..run import run
from .dimension import Dimension, counted, dimension
from .mesh import MOST, SIDES, Mesh, leaves, refined

DEPTH, DEEPEST = 5, 14
CELLS = 16  # along an axis that is given without a number of points
ANSWERS = ("fate", "level")
HALVINGS, FEWEST_HALVINGS = 18, 6  # of a coarse cell's side to a place on the separatrix: a millionth of it; nearer, a fate would take balls
BOUNDED, UNDECIDED, NO_AXIS = 0, 10, 7  # labels besides -3 ... 3 of a spin-up about an axis


@dataclass(frozen=True, eq=False)
class Basins:
    """plan: the plane, each axis with the places of the finest grid; mesh: cells and labels (`label_of`); records: fate, axis and level of every place
    asked, in the order of mesh.keys; asked: depth that was asked for; resumed: places that an earlier run had found."""

    plan: Plan
    mesh: Mesh
    records: np.ndarray
    asked: int
    resumed: int = 0

    @property
    def exact(self) -> bool:
        """Whether the boundary is known exactly: the scene reduces to one degree of freedom, so that its fates are those of a potential."""
        return known_exactly(self.plan, 0, 1) and bool((self.records["level"] == 2).all())

    @cached_property
    def boundary(self) -> np.ndarray:
        """Numbers of the finest cells on the boundary: two of their corners are decided, and differently."""
        cells = self.mesh.boundary
        found = self.mesh.labels_of(self.mesh.corners(self.mesh.depth, cells))
        low = np.where(found == UNDECIDED, 99, found).min(axis=1)
        high = np.where(found == UNDECIDED, -99, found).max(axis=1)
        return cells[low < high]

    @cached_property
    def unclear(self) -> int:
        """How many of the finest cells have corners that differ, of which at most one kind is decided."""
        return len(self.mesh.boundary) - len(self.boundary)

    @cached_property
    def dimension(self) -> Dimension:
        """The box dimension of the boundary."""
        return dimension(counted(*self.mesh.at(self.mesh.depth, self.boundary), self.mesh.depth))

    @cached_property
    def shares(self) -> dict[int, float]:
        """label -> its share of the plane; a cell on the boundary counts for the labels of its corners alike."""
        found: dict[int, float] = {}
        total = self.mesh.cells[0] * self.mesh.cells[1]
        for depth, cells in leaves(self.mesh):
            values, counts = np.unique(self.mesh.labels_of(self.mesh.corners(depth, cells)), return_counts=True)
            for value, count in zip(values.tolist(), counts.tolist()):
                found[value] = found.get(value, 0.0) + count / 4 / 4**depth / total
        return dict(sorted(found.items(), key=lambda pair: -pair[1]))

    @property
    def blur(self) -> float:
        """The share of the plane that cells with differing corners cover: by so much the shares may be wrong."""
        return len(self.mesh.boundary) / 4**self.mesh.depth / (self.mesh.cells[0] * self.mesh.cells[1])

    @property
    def steps(self) -> tuple[float, float]:
        """The sides of a finest cell, in the units of the axes (of equal ratios: of the first cell)."""
        first, second = ((axis.values[1] - axis.values[0]) for axis in self.plan.axes)
        return first, second

    def separatrix(self) -> np.ndarray:
        """(n, 2, 2): pieces of the exact boundary in the units of the axes, one or two in each finest cell on it, between places on the cell's sides
        found by halving; none where the boundary is not known exactly."""
        if not self.exact or not len(self.boundary):
            return np.empty((0, 2, 2))
        corners = self.mesh.corners(self.mesh.depth, self.boundary)
        ends, which = np.unique(np.stack([corners[:, [one, other]] for one, other in SIDES], axis=1).reshape(-1, 2), axis=0, return_inverse=True)
        per_cell = self._crossed(ends)[which.ravel()].reshape(len(corners), len(SIDES), 2)
        order = np.argsort(np.isnan(per_cell[..., 0]), axis=1, kind="stable")
        pairs = np.take_along_axis(per_cell, order[..., None], axis=1).reshape(-1, 2, 2)
        return pairs[~np.isnan(pairs).any(axis=(1, 2))]

    def _crossed(self, ends: np.ndarray) -> np.ndarray:
        """(n, 2): where the boundary crosses sides of finest cells, given by the keys of their ends (n, 2); nan where it does not."""
        place, values = np.full((len(ends), 2), np.nan), [np.array(axis.values) for axis in self.plan.axes]
        spun = self._spun(ends[:, 0])
        for along in (0, 1):
            chosen = np.flatnonzero(((ends[:, 1] - ends[:, 0] == 1) == bool(along)) & (spun != self._spun(ends[:, 1])))
            rows = np.stack(self.mesh.places(ends[chosen, 0]), axis=1)
            share = changes(self.plan, (0, 0), along, rows, spun[chosen], max(FEWEST_HALVINGS, HALVINGS - self.mesh.depth))
            for n in (0, 1):
                here = values[n][rows[:, n]]
                place[chosen, n] = here + (values[n][rows[:, n] + 1] - here) * share if n == along else here
        return place

    def _spun(self, keys: np.ndarray) -> np.ndarray:
        return self.mesh.labels_of(keys) % UNDECIDED != BOUNDED


def label_of(records: np.ndarray) -> np.ndarray:
    """Which basin each record belongs to: 1, 2, 3 with the sense as a sign of the axis of a spin-up, NO_AXIS, BOUNDED (the separatrix and rest are
    bounded as well), UNDECIDED."""
    fate, axis = records["fate"], records["spin_axis"].astype(np.int64)
    about = np.where(axis == 0, NO_AXIS, axis)
    return np.where(fate == Fate.SPIN_UP, about, np.where(fate == Fate.UNDECIDED, UNDECIDED, BOUNDED))


@contextmanager
def basins(case: Case | str | os.PathLike[str], vary: Any, depth: int = DEPTH, out: Path | None = None, workers: int | None = None,
           scheduler: str | None = None, follow: str | None = None) -> Iterator[Basins]:
    """The basins of a plane as a context; what is finished for `out` is removed when its block ends well, and stays otherwise.

    vary: two rates of the initial state with their ranges, "-60:60:17 deg/s" for 17 places along the coarse grid, or "-60:60 deg/s"; depth: how often a
    cell on the boundary is halved. workers, scheduler, follow: as of a sweep. Raises InputError for what is no plane of states.
    """
    coarse = _planned(case, vary, depth, follow)
    fine = _fine(coarse, depth)
    found: dict[str, Any] = {"rows": np.empty(0, record(fine.answers)), "keys": np.empty(0, np.int64), "resumed": 0}
    with ExitStack() as rounds:
        def ask(keys: np.ndarray) -> np.ndarray:
            number = found["rounds"] = found.get("rounds", -1) + 1
            beside = None if out is None else out.with_name(f"{out.name}.{number}") if number else out
            swept = rounds.enter_context(run(replace(fine, listed=packed(keys)), beside, workers, scheduler, _command(coarse, depth)))
            order = np.argsort(every := np.concatenate([found["keys"], keys]), kind="stable")
            found["keys"], found["rows"] = every[order], np.concatenate([found["rows"], swept.records])[order]
            found["resumed"] += swept.resumed
            return label_of(swept.records)
        mesh = refined((coarse.shape[0] - 1, coarse.shape[1] - 1), depth, ask)
        yield Basins(_fine(coarse, mesh.depth), mesh, found["rows"], depth, found["resumed"])


def _planned(case, vary, depth, follow) -> Plan:
    if isinstance(depth, bool) or not isinstance(depth, (int, np.integer)) or not 0 <= depth <= DEEPEST:
        raise InputError(f"depth: expected a whole number from 0 to {DEEPEST}, got {depth!r:.40}")
    rows = list(vary.items() if hasattr(vary, "items") else vary)
    if len(rows) != 2:
        raise InputError(f'a plane takes two rates of the initial state, such as "angular_velocity[1]=-60:60 deg/s" and "angular_velocity[3]=-60:60 deg/s"; '
                         f"got {len(rows)}")
    plan = planned(case, [(name, _range(name, text)) for name, text in rows], answer=ANSWERS, follow=follow)
    if plan.inner != (0, 1):
        other = next(axis.key.name for n, axis in enumerate(plan.axes) if n not in plan.inner)
        raise InputError(f"vary {printable(other)}: is no rate of the initial state: a plane of states has two of [motion] x or angular_velocity; "
                         "stabilab sweep maps other numbers")
    if min(plan.shape) < 2:
        raise InputError("a plane needs two points at least along each axis")
    if plan.points > MOST:
        raise InputError(f"{' x '.join(map(str, plan.shape))} are {plan.points:,} points before any is refined; at most {MOST:,} are asked: take fewer, "
                         "and a depth")
    return plan


def _command(coarse: Plan, depth: int) -> str:
    words = [*(f"--vary={name}={text}" for name, text in coarse.vary), f"--depth={depth}", *([f"--follow={coarse.follow}"] if coarse.follow else [])]
    return shlex.join(["stabilab", "basin", os.path.basename(coarse.path), *words])


def _range(name: str, text: Any) -> str:
    """START:STOP:COUNT of what is given, with CELLS + 1 points where no count is."""
    if not isinstance(text, str) or ":" not in text:
        raise InputError(f'vary {printable(str(name))[:80]}: expected a range such as "-60:60 deg/s" or "-60:60:17 deg/s", got {text!r:.60}: cells '
                         "between its points are halved")
    start, _, rest = text.partition(":")
    if ":" in rest:
        return text
    parts = split(rest.strip())
    return text if parts is None else f"{start}:{parts[0]}:{CELLS + 1} {parts[1]}".strip()


def _fine(coarse: Plan, depth: int) -> Plan:
    return replace(coarse, vary=tuple((name, _finer(text, depth)) for name, text in coarse.vary))


def _finer(text: str, depth: int) -> str:
    """The same range with every step halved `depth` times."""
    start, stop, rest = text.split(":", 2)
    count = rest.lstrip().partition(" ")[0].partition(":")[0]
    digits = count[:len(count) - len(count.lstrip("+0123456789"))]
    return f"{start}:{stop}:{((int(digits) - 1) << depth) + 1}{rest.lstrip()[len(digits):]}"
