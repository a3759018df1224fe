"""Ensembles: many motions of one scene to the same times, a few of them in step with one another.

Each step of the Taylor series serves a row of motions, one to a lane of the processor's vectors. A lane's
numbers do not depend on its neighbours, nor on how many workers share the rows out: the same bytes come
whatever the company.
"""
from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from contextlib import nullcontext
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from ..errors import InputError
from ..physics.coefficients import limits_of
from ..physics.scene import AnyScene, judge_starts, slices, time_left
from ..physics.states import checked_rtol, checked_starts, checked_times
from ..physics.to_numpy import equations_of, to_numpy
from ..representation import Answer, Compared
from .guard import FARTHEST
from .own_units import Units, are_ordinary, in_units, scale_of, sizes_of, units_of
from .to_heyoka import TAYLOR_TOLERANCE, borrowed_taylor, heyoka, heyoka_available
from .trajectory import REPORT, integrated

if TYPE_CHECKING:
    from ..physics.equations import Equations

# Motions in step: eight doubles fill the widest vectors there are, and narrower ones two or four at a time.
# Not asked of the machine, so that every machine groups alike.
LANES = 8


@dataclass(frozen=True, eq=False, repr=False)
class Ensemble(Answer, Compared):
    """Motions of one scene at common times.

    t: (m,), s (tau when scaled); states: (n, m, N), one motion per row of the starts; reached: (n, m), False
    where a motion could not go on so far (its states hold inf there); stopped: number of the motion -> why.
    method: "taylor" or, without heyoka, "DOP853"; rtol: its tolerance; counters: steps of all motions
    together. status: "reached" when all are, else "stopped".
    """

    t: np.ndarray
    states: np.ndarray
    reached: np.ndarray
    stopped: dict[int, str]
    method: str
    rtol: float
    counters: dict[str, int] = field(default_factory=dict)
    scene: AnyScene | None = field(default=None, repr=False, compare=False)

    @property
    def validity(self):
        """Of an approximate law (`stabilab.physics.law_limits`): value and holds (n,) at the times; None
        where all laws are exact."""
        limits = limits_of(self.scene)
        if limits is None:
            return None
        return limits.along(self.scene, {name: self.states[..., part] for name,
                                         part in slices(self.scene.blocks).items()}, "at the times given")

    @property
    def status(self) -> str:
        return "stopped" if self.stopped else "reached"


def ensemble(scene: AnyScene, states: ArrayLike, times: ArrayLike, rtol: float | None = None,
             workers: int = 1) -> Ensemble:
    """The motions of a scene from many starts at t = 0, at the given times; the laws are not checked
    (`trajectory` does).

    states: (n, N), a row for each motion as `trajectory` takes it. times: (m,) as for `trajectory`. rtol:
    relative tolerance, None for half an ulp. workers: threads that share the rows out, 0 for all cores; the
    answer has the same bytes for any number. Where heyoka is not installed every motion is run by itself with
    SciPy's DOP853, and workers gain nothing. Raises InputError for states, times, rtol and workers that are
    none.
    """
    equations, times, rtol = equations_of(scene), checked_times(times), checked_rtol(rtol)
    starts = checked_starts(equations, states)
    judge_starts(scene, equations.blocks, starts)
    workers, left = _workers(workers), time_left(scene)
    if not heyoka_available() or (left is not None and left < times.max()):
        return _one_by_one(scene, starts, times, rtol)
    rtol = TAYLOR_TOLERANCE if rtol is None else max(rtol, TAYLOR_TOLERANCE)
    with np.errstate(all="ignore"):
        changes = to_numpy(equations)(starts)
        sizes = sizes_of(equations, starts, changes)
        pace = np.sqrt(_squared(starts[:, :3])) + np.sqrt(_squared(changes))
        far = sizes[2] * np.abs(times).max() > FARTHEST
    out, steps, stopped = np.empty((len(starts), times.size, starts.shape[1])), 0, {}
    out[:, times == 0] = starts[:, None]
    for units, numbers in _by_units(equations, starts, sizes):
        run = _Rows(scene, equations, units, rtol, starts, times, out)
        run.far.update(numbers[far[numbers]].tolist())
        groups = _groups(pace[numbers], numbers)
        threads = min(workers, len(groups))  # more would have nothing to do
        with ThreadPoolExecutor(threads) if threads > 1 else nullcontext() as pool:
            steps += sum((pool.map if pool else map)(run, (groups[i::threads] for i in range(threads))))
        run.check(numbers)
        steps += sum(taken for _, taken in run.alone.values())
        stopped |= {number: why for number, (why, _) in run.alone.items() if why}
    return Ensemble(times, out, _reached(out), dict(sorted(stopped.items())), "taylor", rtol,
                    {"steps": steps}, scene)


def _reached(out: np.ndarray) -> np.ndarray:
    """(n, m) which states are finite; nearly always all are, which is seen at once far sooner."""
    return (np.ones(out.shape[:2], bool) if np.isfinite(out).all()
            else np.asarray(np.isfinite(out).all(axis=2)))


def _squared(rows: np.ndarray) -> np.ndarray:
    """(n,) the squared length of each row."""
    return np.einsum("ij,ij->i", rows, rows)


def _by_units(equations: Equations, starts: np.ndarray, sizes: tuple[np.ndarray, ...]):
    """(units, numbers of the motions that have them), see `own_units`; those with ordinary rates first.
    sizes: of the starts."""
    odd = ~are_ordinary(equations, *sizes)
    if not odd.any():
        return [(Units(), np.arange(len(starts)))]
    entries = {Units(): np.flatnonzero(~odd).tolist()}
    for number in np.flatnonzero(odd).tolist():
        units = replace(units_of(equations, starts[number]), laws=False)  # none is checked here
        entries.setdefault(units, []).append(number)
    return [(units, np.array(numbers)) for units, numbers in entries.items() if numbers]


def _workers(workers: int):
    if isinstance(workers, bool) or not isinstance(workers, (int, np.integer)) or workers < 0:
        raise InputError(f"workers: expected a whole number, 0 for all cores, got {workers!r:.80}")
    return int(workers) or os.cpu_count() or 1


def _groups(pace: np.ndarray, numbers: np.ndarray):
    """Rows of LANES numbers of motions of similar pace (n,): the slowest of a row keeps the others waiting.
    The last row is filled up."""
    order = numbers[np.argsort(pace, kind="stable")]
    order = np.append(order, np.repeat(order[-1:], -len(order) % LANES))
    return order.reshape(-1, LANES)


class _Rows:
    """Called with rows of LANES numbers of motions, it puts their states into `out` (n, m, N) and answers the
    steps they took; `check` when all have been."""

    def __init__(self, scene: AnyScene, equations: Equations, units: Units, rtol: float, starts: np.ndarray,
                 times: np.ndarray, out: np.ndarray):
        self.scene, self.rtol, self.starts, self.times, self.out = scene, rtol, starts, times, out
        own, self.scale = units.times(times), None if units.rate == 1 else scale_of(equations, units)
        self.forms = to_numpy(in_units(equations, units)).rhs
        self.far = set()  # numbers of motions that turn too often to be followed in step with others
        self.finished = (heyoka().taylor_outcome.time_limit,) * LANES
        self.alone = {}  # number of a motion that its lane did not finish -> (why it stopped or "", steps)
        self.grids = []  # (which of the times, the way there lane by lane)
        for chosen, sense in ((times < 0, -1), (times > 0, 1)):
            route = np.flatnonzero(chosen)[np.argsort(times[chosen] * sense)]
            if route.size:
                grid = np.repeat(np.concatenate([[0.0], own[route]])[:, None], LANES, axis=1)
                # times in a row, as nearly always, are written faster as such
                rising = (np.diff(route) == 1).all()
                self.grids.append((slice(route[0], route[-1] + 1) if rising else route, grid))

    def __call__(self, groups: np.ndarray) -> int:
        with borrowed_taylor(self.forms, self.rtol, LANES) as ta:
            return sum(self._row(ta, group, route, grid) for group in groups for route, grid in self.grids)

    def _row(self, ta, lanes, route, grid) -> int:
        """A row of motions one way. One that overflows, or takes more than REPORT steps, is followed alone,
        and the others start again; a lane that is left over repeats one of them."""
        for number in self.far.intersection(lanes.tolist()).difference(self.alone) if self.far else ():
            self._follow_alone(number)
        while (lanes := self._together(lanes)).size:
            points, outcomes, steps = self._propagated(ta, lanes, grid)
            if outcomes == self.finished:
                points = points[1:].transpose(2, 0, 1)
                where = lanes if isinstance(route, slice) else lanes[:, None]
                self.out[where, route] = points if self.scale is None else points * self.scale
                return sum(dict(zip(lanes.tolist(), steps)).values())
            for number, outcome in zip(lanes.tolist(), outcomes):
                if outcome != self.finished[0] and number not in self.alone:
                    self._follow_alone(number)
        return 0

    def check(self, numbers: np.ndarray):
        """Follow those of these motions alone that came to their end with numbers that are not finite."""
        if len(numbers) == len(self.out) and np.isfinite(self.out).all():
            return
        for number in numbers[~np.isfinite(self.out[numbers]).all(axis=(1, 2))].tolist():
            if number not in self.alone:
                self._follow_alone(number)

    def _together(self, lanes: np.ndarray):
        """A row of those that are not followed alone; none where there is none."""
        if not self.alone:
            return lanes
        good = [number for number in lanes.tolist() if number not in self.alone]
        return np.resize(good, LANES if good else 0)

    def _propagated(self, ta, lanes, grid):
        starts = self.starts[lanes]
        ta.set_time(0.0)
        ta.state[:] = (starts if self.scale is None else starts / self.scale).T
        points = ta.propagate_grid(grid, max_steps=REPORT)[1]
        outcomes, _, _, steps = zip(*ta.propagate_res)  # made anew for each look
        return points, outcomes, steps

    def _follow_alone(self, number: int):
        why, run = _single(self.scene, self.starts[number], self.times, self.rtol, self.out[number])
        self.alone[number] = why, run.counters["steps"]


def _single(scene: AnyScene, start: np.ndarray, times: np.ndarray, rtol: float, out: np.ndarray):
    """(why it stopped or "", run) of one motion, its states put into `out` (m, N), inf where it did not get.
    """
    run = integrated(scene, start, times, "taylor", rtol, laws=False)
    out[:] = np.inf
    out[np.isin(times, run.t)] = run.states
    return ("" if run.status == "reached" else run.because), run


def _one_by_one(scene, starts, times, rtol):
    out, stopped, steps = np.empty((len(starts), times.size, starts.shape[1])), {}, 0
    for number, start in enumerate(starts):
        why, run = _single(scene, start, times, rtol, out[number])
        stopped |= {number: why} if why else {}
        steps += run.counters["steps"]
    return Ensemble(times, out, np.isfinite(out).all(axis=2), stopped, run.method, run.rtol, {"steps": steps},
                    scene)
