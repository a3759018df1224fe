"""An atlas: what is asked, and all directions answered."""
from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from ..case.limit_options import FILE_AXES, StatedLimit, stated_limit
from ..case.read import Case, blamed_on, read_text
from ..errors import InputError, printable
from ..numbers.exact import sqrt_fraction, unit_vector
from ..numbers.principal import NOTHING
from ..numbers.units import TORQUE, in_si
from ..numbers.vectors import Exact3, dot
from ..orbit.result import Fate
from .axes import Key, axis_of
from .plan import Plan, place_and_text
from .pointed import (
    AXES,
    AXIS_POINTS,
    DEEPEST,
    OWN,
    THRUSTERS,
    Leaves,
    Point,
    Pointed,
    along_axes,
    area,
    count,
    middles,
    named_direction,
)
from .run import run

# --- What an atlas is asked: body, start, size of the torque, wheel momenta, how fine the cells are; each
# part checked
LEVEL, REFINE = 3, 2  # 512 cells, and twice as fine along the boundaries, twice
MAX_CELLS = 2_000_000  # cells of the first round
WHEEL = Key("wheel", (("wheels", "momentum"),))  # its dimension is that of a wheel in a case
PRINCIPAL = "123"


@dataclass(frozen=True)
class Asked:
    """path, text: of the case. torque: size, N m, exact. wheels: momenta along the principal axes, exact, N m
    s; momenta: their sizes in `unit`, as asked, or () where the case's own alone counts. level: of the first
    cells; refine: how often they are cut in four along boundaries. limit: options of the time to a limit, by
    name; certify: whether to prove what can be; follow: how long motions are followed that only a run
    decides, as written; timed: whether the time to a limit is asked."""

    path: str
    text: str = field(repr=False)
    torque: Fraction
    wheels: tuple[Exact3, ...]
    momenta: tuple[float, ...]
    unit: str
    level: int
    refine: int
    certify: bool
    limit: tuple[tuple[str, str], ...]
    options: tuple[tuple[str, str], ...] = ()
    follow: str | None = None
    timed: bool = True

    @cached_property
    def case(self) -> Case:
        """The case with the numbers of the file."""
        return read_text(self.path, self.text)

    @cached_property
    def stated_limit(self) -> StatedLimit | None:
        """The limit whose time is asked: of an option, or of the case; None where there is neither, or no
        time is asked."""
        if not self.timed:
            return None
        return stated_limit(self.case, **dict(self.limit)) if self.limit or self.case.limits else None

    @property
    def answers(self) -> tuple[str, ...]:
        """Names of `columns.ANSWERS`."""
        return ("fate", "level", "reason", "island", *(["when"] if self.stated_limit else []), "equilibria")

    @property
    def named(self) -> tuple[Point, ...]:
        """The directions with names, beside every wheel: both senses of the principal axes, the thrusters,
        the torque of the case itself."""
        case = self.case
        firing = [(THRUSTERS, n) for n, thruster in enumerate(case.thrusters) if any(thruster.torque)]
        own = _own_torque(case)
        kinds = [*((AXES, n) for n in range(AXIS_POINTS)), *firing, *([(OWN, 0)] if own else [])]
        return tuple(Point(wheel, *kind) for wheel in range(len(self.wheels)) for kind in kinds)

    @property
    def first(self) -> tuple[Point, ...]:
        """The cells of the first round."""
        return tuple(Point(wheel, self.level, number) for wheel in range(len(self.wheels))
                     for number in range(count(self.level)))

    def plan(self, points: tuple[Point, ...]) -> Plan:
        """A round of the sweep's machinery over points."""
        pointed = Pointed(self.torque, self.wheels, points, self.certify)
        return Plan(self.path, self.text, (), None, 1, self.answers, self.limit, follow=self.follow,
                    pointed=pointed)

    @property
    def command(self) -> str:
        """A command that asks the same."""
        import shlex
        phrases = ["stabilab", "atlas", os.path.basename(self.path),
                 *(f"--{name}={value}" for name, value in self.options)]
        phrases += [f"--level={self.level}", f"--refine={self.refine}",
                  *(["--certify"] if self.certify else []), *([] if self.timed else ["--no-time"])]
        return shlex.join([*phrases, *(f"--{name}={text}" for name, text in self.limit)])


def asked(case: Case | str | os.PathLike[str], torque: Any = None, wheel: str | None = None,
          level: int = LEVEL, refine: int = REFINE,
          certify: bool = False, follow: str | None = None, timed: bool = True, **limit: str | None) -> Asked:
    """An atlas whose every part is checked. Raises InputError with what is wrong and what to do."""
    path, text = place_and_text("atlas", case)
    item = read_text(path, text)
    _judge(item)
    size, (wheels, momenta, unit) = _size(item, torque), _wheels(item, wheel)
    _judge_cells(level, refine, len(wheels))
    options = tuple((name, str(value))
                    for name, value in (("torque", torque), ("wheel", wheel)) if value is not None)
    declared = tuple((name, value) for name, value in limit.items() if value is not None)
    if declared and not timed:
        raise InputError(f"--no-time and --{declared[0][0]} contradict each other: give one of them")
    if declared:
        stated_limit(item, **dict(declared))
    result = Asked(path, text, size, wheels, momenta, unit, level, refine, certify, declared, options, follow,
                  timed)
    if result.plan(()).longest is None:  # raises where `follow` is no time
        return result
    return replace(result, options=(*options, ("follow", str(follow))))


def _own_torque(case: Case) -> bool:
    """Whether the case has a torque that is not that of one thruster alone."""
    full = case.scene.vector("constant_torque")  # type: ignore[union-attr]
    stuck = [along_axes(case, thruster.torque) for thruster in case.thrusters if thruster.stuck]
    rest = [v - sum(torque[n] for torque in stuck) for n, v in enumerate(full)]
    return any(full) and (len(stuck) != 1 or dot(rest, rest) > NOTHING**2 * dot(full, full))


def _judge(case: Case) -> None:
    if case.variables == "scaled" or case.physical is None:
        raise InputError(f"{case.place}: is in scaled variables, whose torque has no direction in space: an "
                         "atlas needs a body in kg m^2 with angular_velocity in rad/s")
    if case.state is None:
        raise InputError(f"{case.place}: motion: expected angular_velocity in [motion]; an atlas shows what "
                         "becomes of a motion")
    with blamed_on(case):
        case.scene.quadratic()  # says which effect is not covered


def _size(case: Case, torque: Any) -> Fraction:
    """The size of the torque: as asked, or that of the case."""
    if torque is None:
        own = case.scene.vector("constant_torque")  # type: ignore[union-attr]
        if not any(own):
            raise InputError(f'{case.place}: no torque acts, so its size is not known: give --torque "1 N '
                             'm", or mark a thruster of the case as stuck')
        return sqrt_fraction(dot(own, own))
    size = in_si(torque, TORQUE, "torque")
    if size <= 0:
        raise InputError(f"torque: expected a positive size, got {printable(str(torque))[:60]}")
    return size


def _wheels(case: Case, text: str | None) -> tuple[tuple[Exact3, ...], tuple[float, ...], str]:
    """(momenta along the principal axes, their sizes as asked, the unit of these)."""
    own = case.scene.vector("gyrostat")  # type: ignore[union-attr]
    if text is None:
        return (own,), (), ""
    axis, equals, values = str(text).partition("=")
    try:
        along = axis_of(WHEEL, values if equals else str(text))
        direction = _along(case, axis.strip().lower()) if equals else _own_direction(own)
    except InputError as error:
        raise InputError(f'wheel: {str(error).removeprefix("vary wheel: ")}') from None
    wheels = tuple(tuple(Fraction(size) * part for part in direction) for size in along.si)
    return wheels, along.values, along.shown_unit


def _own_direction(own: Exact3) -> Exact3:
    if not any(own):
        raise InputError('the case has no wheel that turns: say along which axis, as in --wheel "z=-2:2:5" '
                         "(x, y, z of the file, or 1, 2, 3, the principal axes)")
    return unit_vector(own)


def _along(case: Case, axis: str) -> Exact3:
    if len(axis) != 1 or axis not in FILE_AXES + PRINCIPAL:
        raise InputError('expected a range such as "0:2:5 N m s", or an axis with one, as in "z=0:2:5" (x, '
                         'y, z of the file, or 1, 2, 3, the principal axes), got the axis '
                         f'"{printable(axis)[:40]}"')
    if axis in PRINCIPAL:
        return tuple(Fraction(n == int(axis) - 1) for n in range(3))
    return along_axes(case, tuple(Fraction(n == FILE_AXES.index(axis)) for n in range(3)))


def _judge_cells(level: int, refine: int, wheels: int) -> None:
    for name, value in (("level", level), ("refine", refine)):
        if isinstance(value, bool) or not isinstance(value, int) or value < 0:
            raise InputError(f"{name}: expected a whole number that is not negative, got {value!r:.40}")
    if level + refine > DEEPEST:
        raise InputError(f"level {level} with {refine} refinements: at most {DEEPEST} in all, whose cells "
                         "are a fiftieth of a degree wide")
    if count(level) * wheels > MAX_CELLS:
        raise InputError(f"level {level} has {count(level):,} cells, with {wheels} wheel momenta "
                         f"{count(level) * wheels:,}; at most {MAX_CELLS:,} are asked")


# --- Running an atlas: a round of the sweep's machinery over all cells, then one for the parts of those
# that lie along a boundary, and so on
@dataclass(frozen=True)
class Atlas:
    """leaves: the cells; records: (n,) of `columns.record`, what becomes of the motion under a torque to the
    middle of each. named: directions with a name, as they are; named_records: theirs. resumed: points that an
    earlier run had finished; asked_points: all that were computed."""

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
        return np.array([[float(v) for v in named_direction(self.asked.case, point.level, point.number)]
                         for point in self.named]).reshape(-1, 3)

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


def kinds_of(records: np.ndarray) -> np.ndarray:
    """(n,): a number for each fate with its axis and sense, for an island that is seen, and for each number
    of equilibria: boundaries run where it changes."""
    island = (records["island"] == 2) & (records["fate"] == Fate.UNDECIDED)
    return ((records["fate"].astype(int) * 8 + records["spin_axis"] + 3) * 2
            + island) * 16 + np.clip(records["equilibria"], -8, 7) + 8


@contextmanager
def drawn(request: Asked, out: Path | None = None, workers: int | None = None,
          scheduler: str | None = None) -> Iterator[Atlas]:
    """The finished atlas as a context; what it left beside `out` for a run that is killed is removed when its
    block ends well. workers, scheduler: as of `maps.run.run`."""
    named, sweeps = request.named, []
    with ExitStack() as rounds:
        def told(points: tuple[Point, ...]) -> np.ndarray:
            location = None if out is None else out.with_name(f"{out.name}.{len(sweeps)}") if sweeps else out
            sweeps.append(rounds.enter_context(run(request.plan(points), location, workers, scheduler,
                                                   request.command)))
            return sweeps[-1].records

        records = told(named + request.first)
        named_records, records = records[:len(named)], records[len(named):]
        ends = Leaves(*(np.array(column, np.int64) for column in zip(*request.first)))
        while len(rows := ends.to_cut(kinds_of(records), request.level + request.refine)):
            parts = ends.children(rows)
            result = told(tuple(Point(*item) for item in zip(*(column.tolist() for column in parts))))
            ends, records = _replaced(ends, records, rows, parts, result)
        yield Atlas(request, ends, records, named, named_records, sum(len(sweep.records) for sweep in sweeps),
                    sum(sweep.resumed for sweep in sweeps))


def _replaced(ends: Leaves, records: np.ndarray, rows: np.ndarray, parts: Leaves,
              result: np.ndarray) -> tuple[Leaves, np.ndarray]:
    """The cells with these rows given up for their parts, in order."""
    retained = np.setdiff1d(np.arange(len(records)), rows)
    stay = ends.taken(retained)
    joined = Leaves(*map(np.concatenate, zip(stay, parts)))
    order = joined.order()
    return joined.taken(order), np.concatenate([records[retained], result])[order]
