"""Planes of states: smaller cells along the boundary between fates, and the box dimension of that boundary.

A line that has a length is met by a number of cells that doubles from depth to depth: dimension 1. Where the
count grows as 2^(D depth), with D above 1, the boundary is rough at all these sizes: a fate near it is less
predictable than the state is known.

Places are whole numbers on the finest grid: cells of depth k are 2^(depth - k) of its steps wide. A cell is
split where two of its corners have different labels, and where the boundary leaves it unseen: a smaller
neighbour has two such corners on the side that they share. So a piece of the boundary that is found anywhere
is followed to its end; a piece that no side of a coarse cell shows remains unseen, as with any grid.
"""
from __future__ import annotations

import math
import os
import shlex
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from ..case.read import Case
from ..errors import InputError, printable
from ..numbers.units import split
from ..orbit.result import Fate
from ..reasons import Reasoned, Sentence
from .plan import Plan, packed, planned
from .run import Swept, changes, known_exactly, run

FEWEST = 3     # depths of a fit
COARSEST = 8   # cells that a boundary shall fill at the coarsest depth that counts
STANDARD_ERRORS = 2      # standard errors
NO_BOUNDARY = Sentence("no-boundary", "there is no boundary")()
TOO_FEW_DEPTHS = Sentence(
    "too-few-depths",
    "only {depths} depths have {cells} cells on the boundary or more; {needed} are needed: go deeper")
SLOPE = Sentence("slope-over-depths", "slope of log2(cells) over depths {first} to {last}")
UNCERTAINTY = Sentence(
    "uncertainty-of-slope",
    "twice its standard error, how far it moves without the coarsest or finest depth, and what one cell at "
    "every depth makes of it")()


@dataclass(frozen=True)
class Dimension(Reasoned):
    """value, uncertainty: nan where there is too little to fit; depths, counts: cells that hold a piece of
    the boundary, per depth; used: the depths of the fit; reason: how it is known, or why it is not."""

    value: float
    uncertainty: float
    depths: tuple[int, ...]
    counts: tuple[int, ...]
    used: tuple[int, ...]


def counted(row: np.ndarray, column: np.ndarray, depth: int) -> tuple[int, ...]:
    """How many cells of each depth 0 ... depth hold one of the finest cells at rows and columns."""
    cells = np.stack([row, column], axis=1).astype(np.int64)
    return tuple(len(np.unique(cells >> depth - n, axis=0)) if len(cells) else 0 for n in range(depth + 1))


def dimension(counts: tuple[int, ...]) -> Dimension:
    """The slope of the binary logarithm of the counts over the depths, by least squares over the depths at
    which COARSEST cells at least hold a piece.

    The uncertainty is twice the standard error of the slope; besides, as what bends the line is no chance,
    the farthest that the slope moves where the fit leaves out the coarsest or the finest of its depths; and
    what a cell more or less at every depth would do (a line may or may not touch one more where it turns).
    """
    depths = tuple(range(len(counts)))
    used = tuple(n for n in depths if counts[n] >= COARSEST)
    if len(used) < FEWEST:
        few = TOO_FEW_DEPTHS(depths=len(used), cells=COARSEST, needed=FEWEST)
        return Dimension(math.nan, math.nan, depths, counts, used, reason=few if counts[-1] else NO_BOUNDARY)
    heights = np.log2([counts[n] for n in used])
    (slope, _), variance = np.polyfit(used, heights, 1, cov=True)
    parts = ([np.polyfit(used[part], heights[part], 1)[0] for part in (slice(1, None), slice(-1))]
             if len(used) > FEWEST else np.diff(heights))
    moved = np.abs(np.subtract(parts, slope)).max()
    far = np.array(used) - np.mean(used)
    one_cell = np.abs(far) @ [1 / (counts[n] * math.log(2)) for n in used] / (far @ far)
    reason = SLOPE(first=used[0], last=used[-1]).then(UNCERTAINTY)
    error = float(STANDARD_ERRORS * math.sqrt(variance[0, 0]) + moved + one_cell)
    return Dimension(float(slope), error, depths,
                     counts, used, reason=reason)


Ask = Callable[[np.ndarray], np.ndarray]  # keys of places (n,), rising -> their labels (n,)
MAX_PLACES = 4_000_000  # places asked for


@dataclass
class Mesh:
    """cells: of the coarse grid along both axes; depth: how often a cell may be split. keys, labels: of all
    places asked for, rising; leaves: per depth the numbers of the cells that are not split, rising; split: of
    those that are. full: whether refinement stopped for MAX_PLACES."""

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
        return np.stack([(row + i) * step * self.width + (column + j) * step for i in (0, 1) for j in (0, 1)],
                        axis=1)

    def labels_of(self, keys: np.ndarray) -> np.ndarray:
        """The labels of places asked for."""
        return self.labels[np.searchsorted(self.keys, keys)]

    def mixed(self, depth: int, cells: np.ndarray) -> np.ndarray:
        """(n,): whether the labels of a cell's corners differ."""
        result = self.labels_of(self.corners(depth, cells))
        return (result != result[:, :1]).any(axis=1)

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
    while any(map(len, result := _to_split(mesh))):
        wanted = np.unique(np.concatenate([mesh.corners(n + 1, _children(mesh, n, chosen)).ravel()
                                           for n, chosen in enumerate(result)]))
        if len(mesh.keys) + len(wanted) > MAX_PLACES:
            return _ended(mesh)
        for n, chosen in enumerate(result):
            _split(mesh, n, chosen)
        _ask(mesh, wanted, ask)
    return mesh


def _ended(mesh: Mesh) -> Mesh:
    """The mesh on the grid of the finest cells that there are, where more places would be needed than are
    asked for."""
    depth = max(n for n, cells in enumerate(mesh.leaves) if len(cells))
    row, column = (location >> mesh.depth - depth for location in mesh.places(mesh.keys))
    return Mesh(mesh.cells, depth, row * ((mesh.cells[1] << depth) + 1) + column, mesh.labels,
                mesh.leaves[:depth + 1], mesh.split[:depth + 1], True)


def _ask(mesh: Mesh, wanted: np.ndarray, ask: Ask) -> None:
    new = np.setdiff1d(wanted, mesh.keys)
    if len(new):
        order = np.argsort(keys := np.concatenate([mesh.keys, new]), kind="stable")
        mesh.labels = np.concatenate([mesh.labels, np.asarray(ask(new), np.int64)])[order]
        mesh.keys = keys[order]


def _children(mesh: Mesh, depth: int, cells: np.ndarray) -> np.ndarray:
    row, column = mesh.at(depth, cells)
    return np.sort(np.concatenate([mesh.number(depth + 1, 2 * row + i, 2 * column + j) for i in (0, 1)
                                   for j in (0, 1)]))


def _split(mesh: Mesh, depth: int, chosen: np.ndarray) -> None:
    mesh.leaves[depth] = np.setdiff1d(mesh.leaves[depth], chosen, assume_unique=True)
    mesh.split[depth] = np.union1d(mesh.split[depth], chosen)
    mesh.leaves[depth + 1] = np.union1d(mesh.leaves[depth + 1], _children(mesh, depth, chosen))


def _to_split(mesh: Mesh) -> list[np.ndarray]:
    """Per depth but the last the leaves that are to be split: mixed ones, and those on which a smaller
    neighbour's mixed side lies."""
    rows = [cells[mesh.mixed(n, cells)] for n, cells in enumerate(mesh.leaves[:-1])]
    missing = np.empty(0, np.int64)  # cells of depth n + 1 across a mixed side that are not there
    for n in range(mesh.depth - 1, -1, -1):
        beyond = np.union1d(missing, _across(mesh, n + 1))
        there = np.union1d(mesh.leaves[n + 1], mesh.split[n + 1])
        row, column = mesh.at(n + 1, np.setdiff1d(beyond, there, assume_unique=True))
        above = np.unique(mesh.number(n, row // 2, column // 2))
        here = np.isin(above, mesh.leaves[n])
        rows[n] = np.union1d(rows[n], above[here])
        missing = above[~here]  # not even these are there: their own ancestors go first
    return rows


def _across(mesh: Mesh, depth: int) -> np.ndarray:
    """The cells of a depth that share a side whose ends differ with a cell of that depth."""
    cells = np.union1d(mesh.leaves[depth], mesh.split[depth])
    if not len(cells):
        return cells
    row, column = mesh.at(depth, cells)
    labels = mesh.labels_of(mesh.corners(depth, cells))
    rows, columns = (n << depth for n in mesh.cells)
    out = []
    for (item, other), (down, right) in SIDES.items():
        beside_row, beside_column = row + down, column + right
        crossed = ((labels[:, item] != labels[:, other]) & (0 <= beside_row) & (beside_row < rows)
                   & (0 <= beside_column) & (beside_column < columns))
        out.append(mesh.number(depth, beside_row[crossed], beside_column[crossed]))
    return np.unique(np.concatenate(out))


# corners of a side -> the way to the cell beyond it
SIDES = {(0, 1): (-1, 0), (2, 3): (1, 0), (0, 2): (0, -1), (1, 3): (0, 1)}


def leaves(mesh: Mesh) -> Iterator[tuple[int, np.ndarray]]:
    """(depth, numbers of the cells) that are not split."""
    yield from ((n, cells) for n, cells in enumerate(mesh.leaves) if len(cells))


# --- Basins of a plane of initial states: each round of refinement is a sweep over the places that it
# needs, with a sweep's chunks, workers and parts
DEPTH, DEEPEST = 5, 14
CELLS = 16  # along an axis that is given without a number of points
ANSWERS = ("fate", "level")
# of a coarse cell's side to a place on the separatrix: a millionth of it; nearer, a fate would take balls
HALVINGS, FEWEST_HALVINGS = 18, 6
BOUNDED, UNDECIDED, NO_AXIS = 0, 10, 7  # labels besides -3 ... 3 of a spin-up about an axis


@dataclass(frozen=True, eq=False)
class Basins:
    """plan: the plane, each axis with the places of the finest grid; mesh: cells and labels (`label_of`);
    records: fate, axis and level of every place asked, in the order of mesh.keys; asked: depth that was asked
    for; resumed: places that an earlier run had found."""

    plan: Plan
    mesh: Mesh
    records: np.ndarray
    asked: int
    resumed: int = 0

    @property
    def exact(self) -> bool:
        """Whether the boundary is known exactly: the scene reduces to one degree of freedom, so that its
        fates are those of a potential."""
        return known_exactly(self.plan, 0, 1) and bool((self.records["level"] == 2).all())

    @cached_property
    def boundary(self) -> np.ndarray:
        """Numbers of the finest cells on the boundary: two of their corners are decided, and differently."""
        cells = self.mesh.boundary
        result = self.mesh.labels_of(self.mesh.corners(self.mesh.depth, cells))
        low = np.where(result == UNDECIDED, 99, result).min(axis=1)
        high = np.where(result == UNDECIDED, -99, result).max(axis=1)
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
        """label -> its share of the plane; a cell on the boundary counts for the labels of its corners alike.
        """
        result: dict[int, float] = {}
        total = self.mesh.cells[0] * self.mesh.cells[1]
        for depth, cells in leaves(self.mesh):
            values, counts = np.unique(self.mesh.labels_of(self.mesh.corners(depth, cells)),
                                       return_counts=True)
            for value, count in zip(values.tolist(), counts.tolist()):
                result[value] = result.get(value, 0.0) + count / 4 / 4**depth / total
        return dict(sorted(result.items(), key=lambda pair: -pair[1]))

    @property
    def blur(self) -> float:
        """The share of the plane that cells with differing corners cover: by so much the shares may be wrong.
        """
        return len(self.mesh.boundary) / 4**self.mesh.depth / (self.mesh.cells[0] * self.mesh.cells[1])

    @property
    def steps(self) -> tuple[float, float]:
        """The sides of a finest cell, in the units of the axes (of equal ratios: of the first cell)."""
        first, second = ((axis.values[1] - axis.values[0]) for axis in self.plan.axes)
        return first, second

    def separatrix(self) -> np.ndarray:
        """(n, 2, 2): pieces of the exact boundary in the units of the axes, one or two in each finest cell on
        it, between places on the cell's sides found by halving; none where the boundary is not known
        exactly."""
        if not self.exact or not len(self.boundary):
            return np.empty((0, 2, 2))
        corners = self.mesh.corners(self.mesh.depth, self.boundary)
        ends, which = np.unique(np.stack([corners[:, [item, other]] for item, other in SIDES],
                                         axis=1).reshape(-1, 2), axis=0, return_inverse=True)
        per_cell = self._crossed(ends)[which.ravel()].reshape(len(corners), len(SIDES), 2)
        order = np.argsort(np.isnan(per_cell[..., 0]), axis=1, kind="stable")
        pairs = np.take_along_axis(per_cell, order[..., None], axis=1).reshape(-1, 2, 2)
        return pairs[~np.isnan(pairs).any(axis=(1, 2))]

    def _crossed(self, ends: np.ndarray) -> np.ndarray:
        """(n, 2): where the boundary crosses sides of finest cells, given by the keys of their ends (n, 2);
        nan where it does not."""
        index, values = np.full((len(ends), 2), np.nan), [np.array(axis.values) for axis in self.plan.axes]
        spun = self._spun(ends[:, 0])
        for along in (0, 1):
            chosen = np.flatnonzero(((ends[:, 1] - ends[:, 0] == 1) == bool(along))
                                    & (spun != self._spun(ends[:, 1])))
            rows = np.stack(self.mesh.places(ends[chosen, 0]), axis=1)
            part = changes(self.plan, (0, 0), along, rows, spun[chosen],
                            max(FEWEST_HALVINGS, HALVINGS - self.mesh.depth))
            for n in (0, 1):
                here = values[n][rows[:, n]]
                index[chosen, n] = here + (values[n][rows[:, n] + 1] - here) * part if n == along else here
        return index

    def _spun(self, keys: np.ndarray) -> np.ndarray:
        return self.mesh.labels_of(keys) % UNDECIDED != BOUNDED


def label_of(records: np.ndarray) -> np.ndarray:
    """Which basin each record belongs to: 1, 2, 3 with the sense as a sign of the axis of a spin-up, NO_AXIS,
    BOUNDED (the separatrix and rest are bounded as well), UNDECIDED."""
    fate, axis = records["fate"], records["spin_axis"].astype(np.int64)
    about = np.where(axis == 0, NO_AXIS, axis)
    return np.where(fate == Fate.SPIN_UP, about, np.where(fate == Fate.UNDECIDED, UNDECIDED, BOUNDED))


@contextmanager
def basins(case: Case | str | os.PathLike[str], vary: Any, depth: int = DEPTH, out: Path | None = None,
           workers: int | None = None,
           scheduler: str | None = None, follow: str | None = None) -> Iterator[Basins]:
    """The basins of a plane as a context; what is finished for `out` is removed when its block ends well, and
    stays otherwise.

    vary: two rates of the initial state with their ranges, "-60:60:17 deg/s" for 17 places along the coarse
    grid, or "-60:60 deg/s"; depth: how often a cell on the boundary is halved. workers, scheduler, follow: as
    of a sweep. Raises InputError for what is no plane of states.
    """
    coarse = _planned(case, vary, depth, follow)
    fine = _fine(coarse, depth)
    request: list[np.ndarray] = []
    sweeps: list[Swept] = []
    with ExitStack() as rounds:
        def ask(keys: np.ndarray) -> np.ndarray:
            beside = None if out is None else out.with_name(f"{out.name}.{len(request)}") if request else out
            request.append(keys)
            sweeps.append(rounds.enter_context(run(replace(fine, listed=packed(keys)), beside, workers,
                                                   scheduler, _command(coarse, depth))))
            return label_of(sweeps[-1].records)
        mesh = refined((coarse.shape[0] - 1, coarse.shape[1] - 1), depth, ask)
        rows = np.concatenate([sweep.records for sweep in sweeps])[np.argsort(np.concatenate(request))]
        yield Basins(_fine(coarse, mesh.depth), mesh, rows, depth, sum(sweep.resumed for sweep in sweeps))


def _planned(case, vary, depth, follow) -> Plan:
    if isinstance(depth, bool) or not isinstance(depth, (int, np.integer)) or not 0 <= depth <= DEEPEST:
        raise InputError(f"depth: expected a whole number from 0 to {DEEPEST}, got {depth!r:.40}")
    rows = list(vary.items() if hasattr(vary, "items") else vary)
    if len(rows) != 2:
        raise InputError('a plane takes two rates of the initial state, such as "angular_velocity[1]=-60:60 '
                         f'deg/s" and "angular_velocity[3]=-60:60 deg/s"; got {len(rows)}')
    plan = planned(case, [(name, _range(name, text)) for name, text in rows], answer=ANSWERS, follow=follow)
    if plan.inner != (0, 1):
        other = next(axis.key.name for n, axis in enumerate(plan.axes) if n not in plan.inner)
        raise InputError(f"vary {printable(other)}: is no rate of the initial state: a plane of states has "
                         "two of [motion] x or angular_velocity; stabilab sweep maps other numbers")
    if min(plan.shape) < 2:
        raise InputError("a plane needs two points at least along each axis")
    if plan.points > MAX_PLACES:
        raise InputError(f"{' x '.join(map(str, plan.shape))} are {plan.points:,} points before any is "
                         f"refined; at most {MAX_PLACES:,} are asked: take fewer, and a depth")
    return plan


def _command(coarse: Plan, depth: int) -> str:
    phrases = [*(f"--vary={name}={text}" for name, text in coarse.vary), f"--depth={depth}",
             *([f"--follow={coarse.follow}"] if coarse.follow else [])]
    return shlex.join(["stabilab", "basin", os.path.basename(coarse.path), *phrases])


def _range(name: str, text: str) -> str:
    """START:STOP:COUNT of what is given, with CELLS + 1 points where no count is."""
    if not isinstance(text, str) or ":" not in text:
        raise InputError(f'vary {printable(str(name))[:80]}: expected a range such as "-60:60 deg/s" or '
                         f'"-60:60:17 deg/s", got {text!r:.60}: cells between its points are halved')
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
