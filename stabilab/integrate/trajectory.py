"""One motion in time, by Taylor series or SciPy, past the end of an effect too.

A run has the state at given times, and says how far it departs from the laws of the motion.

The laws are checked against the integrals of their rates, which ride along in the same run without steering
its steps (feathered, see `to_heyoka`), so a law with a non-zero rate is as good a witness as a constant.

Past the time at which an effect stops acting the scene without it goes on from the state there. The roots
of the rates along a run are found too."""
from __future__ import annotations

from collections.abc import Callable
from contextlib import nullcontext
from dataclasses import dataclass, field, replace
from functools import cache, partial
from typing import TYPE_CHECKING, Any

import numpy as np

from ..physics.coefficients import limits_of
from ..physics.scene import AnyScene, slices, stopped, time_left
from ..physics.states import checked_rtol, checked_times, equations_and_start
from ..physics.to_numpy import System, to_numpy
from ..reasons import Moment, Quantity, Reason, Reasoned, Sentence
from ..representation import Answer, Compared
from .guard import PATIENCE, STEPS_NOT_ENOUGH, Guard, full
from .own_units import Units, in_units, scale_of, units_of
from .to_heyoka import FEATHER, TAYLOR_TOLERANCE, borrowed_taylor, heyoka_available

if TYPE_CHECKING:
    from ..physics.equations import Equations
    from ..physics.law_limits import Validity


ALL_REACHED = Sentence("all-times-reached", "all times reached")()
STAND_IN = Sentence(
    "stand-in-for-taylor", "all times reached; heyoka is not installed, SciPy's DOP853 took its place")()
NUMBERS_OVERFLOWED = Sentence("numbers-overflowed", "the numbers overflowed")()
MESSAGE = Sentence("message-of-integrator", "{message}")
CRAWLS = Sentence(
    "steps-too-short", "the last {steps} steps went from {first} to {last}, the rest would take some {left} "
    "steps")
BROKE_OFF_AT = Sentence("run-stopped-at", "the run stopped after {last}: {why}")
NEVER_BEGAN = Sentence("run-stopped-at-start", "the run stopped after the start: {why}")


# --- Past the end of an effect
def through_the_end(scene: AnyScene, state: np.ndarray, times: np.ndarray, follow: Callable[..., Any],
                    steps: list[float] | None) -> Any:
    """The run at times of which some are later than the end of an effect; None where there is no such effect
    or time. follow(scene, state, times, steps): a run in which all effects act."""
    equations, row = equations_and_start(scene, state)
    parts, times = slices(equations.blocks), checked_times(times)
    start = {name: row[part] for name, part in parts.items()}
    left = time_left(scene)
    if left is None or not times.max() > left:
        return None
    rising = np.sort(times)
    early, late = rising[rising <= left], rising[rising > left]
    before = follow(scene, start, np.unique([0.0, *early, left]), steps)
    if before.status != "reached":
        return _at(before, early, times)
    there = {name: before.block(name)[-1] for name in equations.blocks}
    passed: list[float] | None = None if steps is None else []
    without, retained = stopped(scene, there)
    after = follow(without, retained, [0.0, *(late - left)], passed)
    if steps is not None:
        steps += [left + t for t in passed or ()]
    limits = limits_of(scene)
    states, drifts = np.tile(before.states[-1], (len(after.t) - 1, 1)), (before, after)
    for name in retained:
        states[:, parts[name]] = after.block(name)[1:]
    names = before.invariant_drift | after.invariant_drift
    entire = replace(
        after, t=np.concatenate([before.t, late[:len(states)]]),
        states=np.concatenate([before.states, states]),
        invariant_drift={name: max(run.invariant_drift.get(name, 0.0) for run in drifts) for name in names},
        counters={name: before.counters.get(name, 0) + n for name, n in after.counters.items()},
        blocks=before.blocks, validity=limits and limits.larger(before.validity, after.validity))
    return _at(entire, rising, times)


def _at(run: Any, rising: Any, times: Any) -> Any:
    """The run at these of its times alone, in the order of the times that were asked for."""
    keep = np.isin(run.t, rising)
    route = 1 if times.size < 2 or times[1] > times[0] else -1
    return replace(run, t=run.t[keep][::route], states=np.ascontiguousarray(run.states[keep][::route]))


def roots_through_the_end(scene: Any, equations: Any, row: Any, t_end: float,
                          search: Callable[..., Any]) -> Any:
    """The roots of the rates up to `t_end`, later than the end of an effect, where all rates count as roots:
    they jump there. None where there is no such effect or time. search(scene, state, t_end): while all act.
    """
    parts = slices(equations.blocks)
    left = time_left(scene)
    if left is None or not t_end > left:
        return None
    first = search(scene, row, left)
    if first.reason:
        return first
    without, retained = stopped(scene, {name: first.end[part] for name, part in parts.items()})
    later = search(without, retained, t_end - left)
    places = np.concatenate([np.arange(row.size)[parts[name]] for name in retained])

    def whole(states: Any) -> Any:
        out = np.tile(first.end, (len(states), 1))
        out[:, places] = states
        return out
    return replace(
        later, t=np.concatenate([first.t, np.full(row.size, left), left + later.t]),
        component=np.concatenate([first.component, np.arange(row.size), places[later.component]]),
        states=np.concatenate([first.states, whole(first.end[None, places].repeat(row.size, 0)),
                               whole(later.states)]),
        start=first.start, end=whole(later.end[None])[0], t_reached=left + later.t_reached,
        steps=first.steps + later.steps)


# --- The run
SCIPY_METHODS = ("RK45", "RK23", "DOP853", "Radau", "BDF", "LSODA")
# SciPy's own default is 1e-3, too coarse to judge a motion by; 1e-10 is within reach of every method in the
# list.
SCIPY_RTOL = 1e-10
# What DOP853 can still hold in double precision; it stands in for the Taylor series.
FALLBACK_RTOL = 1e-13
# Absolute tolerance of the SciPy runs relative to the size of the state: keeps rtol meaningful at zero
# crossings.
ATOL_SHARE = 1e-3
STEP_LIMIT = 20_000_000
# steps after which the rest is forecast; forecast over STEP_LIMIT that ends the run
REPORT = 1_000_000
# parts of a step at which an approximate law is looked at: of a series, which turns the body by up to three
# radians, and of a method with an interpolant of few terms
INSIDE_SERIES, INSIDE_STEP = np.arange(1, 13) / 12, np.arange(1, 5) / 4
NOTED = 4  # numbers that the end of a step, in a list, takes the memory of
# of SciPy's methods, whose steps take a hundred times as long; an implicit one has a system to solve in each
SCIPY_REPORT, IMPLICIT_LIMIT = 10_000, 200_000
OUTCOMES = {"err_nf_state": NUMBERS_OVERFLOWED}


def integrated(scene, state, times, method: str = "taylor", rtol: float | None = None,
               steps: list | None = None,
               laws: bool = True) -> Trajectory:
    """States of a scene at the given times, followed in steps; see `answers.simulate` for the arguments.

    method: "taylor" or one of SCIPY_METHODS, as spelt there.
    """
    times, rtol = checked_times(times), checked_rtol(rtol)
    if getattr(scene, "ending", ()):  # equations may stand for a scene
        follow = lambda scene, start, to, ends: integrated(scene, start, to, method, rtol, ends, laws)
        if (entire := through_the_end(scene, state, times, follow, steps)) is not None:
            return entire
    equations, state = equations_and_start(scene, state)
    reason, landing = ALL_REACHED, False
    if method == "taylor" and not heyoka_available():
        method, rtol, landing = "DOP853", max(rtol or 0.0, FALLBACK_RTOL), True
        reason = STAND_IN
    units = units_of(equations, state) if method == "taylor" else Units()
    scale = 1.0 if units.rate == 1 else scale_of(equations, units)
    system = to_numpy(in_units(equations, units))
    if method == "taylor":
        rtol = TAYLOR_TOLERANCE if rtol is None else max(rtol, TAYLOR_TOLERANCE)
        run: _Taylor | _SciPy = _Taylor(system, rtol, laws, units.pace)
    else:
        rtol = SCIPY_RTOL if rtol is None else rtol
        run = _SciPy(system, method, rtol, landing)
    watch = watcher(scene, equations, state)
    note = watch and (lambda rows: watch.note(rows * scale))
    start, passed = state if units.rate == 1 else state / scale, None if steps is None else list[float]()
    before, after, still = parted(units.times(times))
    drift: dict[str, float] = {}
    failure, rows = None, [start[None]] * 2
    for n, grid in enumerate((before, after)):
        if grid.size > 1:
            points, stop = run.run(start, grid, passed, note)
            failure = stop if failure is None else failure.then(stop)
            if watch:
                watch.at(points[1:, :state.size] * scale)
            for name, departure in departures(system, points).items() if laws else ():
                drift[name] = max(drift.get(name, 0.0), departure)
            rows[n] = np.ascontiguousarray(points[:, :state.size])
    if steps is not None:
        steps += [t / units.pace for t in passed or ()]
    reached, states = after[:len(rows[1])], rows[1]
    if not still:
        reached, states = reached[1:], states[1:]
    if before.size > 1:  # those before 0 were met from there on
        reached = np.concatenate([before[:len(rows[0])][:0:-1], reached])
        states = np.concatenate([rows[0][:0:-1], states])
    if times.size > 1 and times[1] < times[0]:
        reached, states = reached[::-1], states[::-1]
    if not units.plain:
        reached, states = reached / units.pace, states * scale
    return Trajectory(reached, states, method, rtol, drift,
                      run.counters, "stopped" if failure else "reached", slices(equations.blocks),
                      watch and watch.result(), reason=failure or reason)


def parted(times: np.ndarray) -> tuple[np.ndarray, np.ndarray, bool]:
    """(0 and the times before it, 0 and those after it, each away from 0, and whether 0 is one of them) of
    times in a row either way."""
    rising = times if times.size < 2 or times[1] > times[0] else times[::-1]
    if rising[0] == 0:  # as nearly always: searched for, it costs a short run a hundredth of its time
        after = rising + 0.0  # a copy, for it becomes the run's own, without a zero's sign
        return after[:1], after, True
    first, last = rising.searchsorted(0.0), rising.searchsorted(0.0, "right")
    return (np.concatenate([[0.0], rising[:first][::-1]]), np.concatenate([[0.0], rising[last:]]),
            bool(last > first))


def watcher(scene: AnyScene, equations: Equations, state: np.ndarray):
    """What looks at each step of a run under an approximate law; None where all laws are exact."""
    limits = limits_of(scene) if hasattr(scene, "approximate") else None  # equations may stand for a scene
    if limits is None:
        return None
    watch = limits.Watch(scene, equations.blocks)
    watch.at(state[None])
    return watch


def departures(system: System, points: np.ndarray) -> dict[str, float]:
    """Law name -> largest |Q(t) - Q(0) - integral of its rate| over the largest size of its terms in the run.
    points: (n, N + laws) the states and the integrals, those of the start first; of the start alone nothing.
    """
    if len(points) < 2:
        return {}
    n = len(system.equations.state)
    quantities, sizes = system.laws(points[:, :n])
    integrals = points[:, n:].T
    largest = np.maximum(sizes.max(axis=1), np.abs(integrals).max(axis=1))
    departed = np.abs(quantities - quantities[:, :1] - integrals).max(axis=1)
    return {law.name: float(departure / size) if size > 0 else 0.0
            for law, departure, size in zip(system.equations.balances, departed.tolist(), largest.tolist())}


def steps_left(passed, ahead, steps=None) -> float:
    """How many more steps the time ahead would take at the pace of the last REPORT of them, or of `steps`."""
    return float(abs(ahead) / (abs(passed) or 1e-300) * (steps or REPORT))


def _crawling(first: float, last: float, left: float, steps: int) -> Reason:
    return CRAWLS(steps=steps, first=Moment(first), last=Moment(last), left=Quantity(left, digits=1))


class _Taylor:
    """Runs of the Taylor series; counters add up over the runs. pace: of the times over those returned."""

    def __init__(self, system: System, rtol: float, laws: bool = True, pace: float = 1.0):
        self.forms, self.rtol = system.motion_and_laws if laws else system.rhs, rtol
        self.pace = pace
        self.counters = {"steps": 0}

    def run(self, state, grid, passed=None, watch=None):
        """(states and law integrals at the times of `grid`, failure or None); grid moves away from 0, its
        first time. passed: a list that takes the ends of the steps; watch: is called with states (n, N) in
        each."""
        note = {}
        if passed is not None or watch is not None:
            def seen(ta):
                if passed is not None:
                    passed.append(ta.time)
                if watch is not None:
                    watch(_inside(ta, state.size))
                return True
            note = {"callback": seen}
        with borrowed_taylor(self.forms, self.rtol) as ta:
            self.counters["order"] = ta.order
            begin = partial(_put, ta, state)
            far, within = self._given_up(ta, begin, grid)
            begin()
            out, failure = (self._passed(ta, grid[:within], note) if within > 1
                            else (ta.state[None].copy(), None))
            failure = far if far and len(out) == within else failure
        if out.shape[1] > state.size:
            out[:, state.size:] /= FEATHER
        if not np.isfinite(out).all():
            out = out[:np.argmin(np.isfinite(out).all(axis=1))]
        if not len(out):  # where the first step failed, heyoka gives back not even the start
            out = np.concatenate([state, np.zeros(out.shape[1] - state.size)])[None]
        return out, None if len(out) == len(grid) else _stopped(out, grid / self.pace, failure)

    def _given_up(self, ta, begin, grid):
        """(why a run over the grid is given up or None, how many of its times are worth REPORT steps all the
        same): where the first step is too short by far, a trial run shows the motion's pace."""
        begin()
        if grid[-1] < 0:
            ta.step_backward()
        else:
            ta.step()
        end, limit = abs(grid[-1]), PATIENCE * STEP_LIMIT
        if end <= limit * abs(ta.time) or not np.isfinite(ta.state).all():
            return None, len(grid)
        begin()
        guard, done = Guard(grid[-1], STEP_LIMIT, REPORT), 0
        while done < REPORT:
            last, taken = ta.time, ta.propagate_until(grid[-1], max_steps=guard.next(done))[3]
            done += taken
            left = guard.ahead(done, ta.time)
            if not taken or left <= limit or not np.isfinite(ta.state).all():
                break
            if guard.look(done, ta.time):
                why = _crawling(last / self.pace, ta.time / self.pace, left, taken)
                return why, int(np.count_nonzero(np.abs(grid) <= abs(ta.time) * (REPORT / done)))
        return None, len(grid)

    def _passed(self, ta, grid, note):
        """(states at the times of `grid` that were reached, why not all or None)."""
        rows, done, begun, size = [], 0, self.counters["steps"], len(ta.state)
        while True:
            last = ta.time
            route = np.concatenate([[last], grid[done:]]) if done else grid
            with np.errstate(all="ignore") if note else nullcontext():
                outcome, _, _, steps, *_, out = ta.propagate_grid(route, max_steps=REPORT, **note)
            self.counters["steps"] += steps
            rows.append(out.reshape(-1, size)[1 if done else 0:])
            # the clock has two doubles: where the first is the next time and the second not zero, a grid from
            # here to that time would be refused
            done += len(rows[-1])
            # its name costs a short run a hundredth of its time
            name = outcome.name if done < grid.size else ""
            if name == "step_limit":
                rows.append(_of_the_last_step(ta, grid[done:]))
                done += len(rows[-1])
            if name != "step_limit" or done == grid.size:
                result = rows[0] if len(rows) == 1 else np.concatenate(rows)
                return result, None if done == grid.size else OUTCOMES.get(name) or MESSAGE(message=name)
            if note and (why := full(self.counters["steps"] - begun, NOTED)):
                return np.concatenate(rows), why
            left = steps_left(ta.time - last, grid[-1] - ta.time)
            if self.counters["steps"] - begun >= STEP_LIMIT or left > PATIENCE * STEP_LIMIT:
                return np.concatenate(rows), _crawling(last / self.pace, ta.time / self.pace, left, REPORT)


def _of_the_last_step(ta, ahead) -> np.ndarray:
    """The states at those of the times ahead, in a row away from 0, that the last step of a Taylor series has
    reached."""
    states = []
    for t in ahead[:np.count_nonzero(np.abs(ahead) <= abs(ta.time))]:
        ta.update_d_output(t)
        states.append(ta.d_output.copy())
    return np.array(states).reshape(-1, len(ta.state))


def _put(ta, state):
    """Set an integrator to the start of a motion."""
    ta.time, row = 0.0, ta.state
    row[state.size:] = 0.0
    row[:state.size] = state


def _inside(ta: Any, size: int) -> np.ndarray:
    """States within the last step of a Taylor integrator and at its end, by its series."""
    powers, inside = _powers(ta.order)
    return (ta.tc[:size] * ta.last_h**powers @ inside).T


@cache
def _powers(order: int) -> tuple[np.ndarray, np.ndarray]:
    """(the powers of a series of this order, those of the parts of a step)."""
    powers = np.arange(order + 1)
    return powers, INSIDE_SERIES ** powers[:, None]


class _SciPy:
    """Runs of a SciPy method; counters add up over the runs. landing: end a step on each asked-for time
    (costs a step, saves the interpolant's error)."""

    def __init__(self, system: System, method: str, rtol: float, landing: bool = False):
        self.system, self.method, self.rtol, self.landing = system, method, rtol, landing
        self.counters = {"steps": 0, "rate evaluations": 0, "jacobian evaluations": 0}
        self.most = IMPLICIT_LIMIT if method in ("Radau", "BDF") else STEP_LIMIT
        self.reported = 0.0  # the time at the last report

    def run(self, state, grid, passed=None, watch=None):
        """As of _Taylor."""
        y = np.concatenate([state, np.zeros(len(self.system.equations.balances))])
        t, points, h, failure, self.reported = 0.0, [y], None, None, 0.0
        with np.errstate(all="ignore"):
            for piece in (grid[i:i + 1] for i in range(1, len(grid))) if self.landing else (grid[1:],):
                y, h, failure = self._piece(t, y, piece, h, points, passed, watch, grid[-1])
                if failure:
                    break
                t = piece[-1]
        out = np.array(points).reshape(-1, y.size)
        out[:, state.size:] /= FEATHER
        return out, failure and _stopped(out, grid, failure)

    def _piece(self, t, y, grid, h, points, passed, watch, end):
        """Steps from t to grid[-1], appending to `points`; (last state, last step, failure or None). end: of
        the run."""
        n = len(self.system.equations.state)
        try:
            solver = self._solver(t, y, grid[-1], h)
        except (ValueError, OverflowError) as error:
            return y, h, MESSAGE(message=str(error))
        done = 0
        while solver.status == "running":
            try:
                message = solver.step()
            except (ValueError, OverflowError) as error:  # SciPy's linear algebra refuses infinite entries
                return y, h, MESSAGE(message=str(error))
            self.counters["steps"] += 1
            if passed is not None:
                passed.append(solver.t)
            if watch is not None and solver.status != "failed" and np.isfinite(solver.y[:n]).all():
                watch(solver.dense_output()(solver.t_old + INSIDE_STEP * (solver.t - solver.t_old))[:n].T)
            if solver.status == "failed" or not np.isfinite(solver.y[:n]).all():
                return y, h, MESSAGE(message=message) if message else NUMBERS_OVERFLOWED
            if self.counters["steps"] >= self.most:
                return y, h, STEPS_NOT_ENOUGH(steps=self.most)
            if self.counters["steps"] % SCIPY_REPORT == 0:
                left = steps_left(solver.t - self.reported, end - solver.t, SCIPY_REPORT)
                if left > PATIENCE * self.most:
                    return y, h, _crawling(self.reported, solver.t, left, SCIPY_REPORT)
                self.reported = solver.t
            h = abs(solver.t - solver.t_old) if solver.status == "running" or h is None else h
            if abs(grid[done]) <= abs(solver.t):
                inside = grid[done:][np.abs(grid[done:]) <= abs(solver.t)]
                dense = solver.dense_output()
                points += [solver.y.copy() if time == solver.t else dense(time) for time in inside]
                done += len(inside)
        self.counters["rate evaluations"] += int(solver.nfev)
        self.counters["jacobian evaluations"] += int(solver.njev)
        return solver.y, h, None

    def _solver(self, t: float, y: np.ndarray, end: float, h: float | None):
        from scipy import integrate
        n = len(self.system.equations.state)
        weight = np.where(np.arange(y.size) < n, 1.0, FEATHER)

        def rates(_: float, y: np.ndarray):
            return weight * self.system.rate_and_laws(y[:n].tolist())

        floor = self.rtol * ATOL_SHARE * (np.abs(y[:n]).max() or 1.0)
        options = ({"jac": self._padded_jacobian(n, y.size)} if self.method in ("Radau", "BDF", "LSODA")
                   else {})
        options |= {} if h is None else {"first_step": min(h, abs(end - t))}
        return getattr(integrate, self.method)(rates, t, y, end, rtol=self.rtol, atol=floor, **options)

    def _padded_jacobian(self, n, size):
        def jacobian(_, y):
            full = np.zeros((size, size))
            full[:n, :n] = self.system.jacobian(y[:n])
            return full
        return jacobian


def _stopped(points, grid, why: Reason | None) -> Reason:
    why = why or NUMBERS_OVERFLOWED  # which is why its last states were left out
    return (BROKE_OFF_AT(last=Moment(float(grid[len(points) - 1])), why=why) if len(points) > 1
            else NEVER_BEGAN(why=why))


@dataclass(frozen=True, repr=False, eq=False)
class Trajectory(Answer, Compared, Reasoned):
    """States at the asked-for times.

    t: (n,) times; states: (n, N), blocks: where each block of the state stands in the N columns;
    invariant_drift: law name -> largest relative departure from it over the run; counters: integrator's own
    counts (steps, rate evaluations); status: "reached", "stopped" (reason says why). validity: of an
    approximate law (`stabilab.physics.law_limits`), its largest value along the run; None where all
    laws are exact.
    """

    t: np.ndarray
    states: np.ndarray
    method: str
    rtol: float | None
    invariant_drift: dict[str, float]
    counters: dict[str, int]
    status: str
    blocks: dict = field(default_factory=lambda: {"omega": slice(0, 3)})
    validity: Validity | None = None

    def block(self, name: str):
        """(n, m) states of one block."""
        return self.states[:, self.blocks[name]]


# --- SciPy's DOP853 in the place of the Taylor series, where heyoka is not installed: its steps, and roots
# on their interpolants
def stand_in(rate: Callable[[list[float]], np.ndarray | list[float]], state: np.ndarray, end: float,
             t: float = 0.0, rtol: float = FALLBACK_RTOL, atol: float | None = None):
    """The solver from a state (n,) at time t until `end`; rate: of a list of floats. atol: by default `floor`
    of the state."""
    from scipy.integrate import DOP853
    return DOP853(lambda _, x: np.array(rate(x.tolist())), t, state, end, rtol=rtol,
                  atol=floor(state, rtol) if atol is None else atol)


def floor(state: np.ndarray, rtol: float) -> float:
    """The absolute tolerance that keeps a relative one meaningful at zero crossings."""
    return rtol * ATOL_SHARE * (np.abs(state).max() or 1.0)


def sign_changes(values: np.ndarray) -> np.ndarray:
    """The places n of a row at which entries n and n + 1 have opposite signs."""
    return np.nonzero(np.sign(values[:-1]) * np.sign(values[1:]) < 0)[0]


def root_between(function, dense, low: float, high: float) -> float:
    """The time between two at which a function of the interpolant's state is zero."""
    from scipy.optimize import brentq
    return brentq(lambda t: function(dense(t)), low, high, xtol=1e-300, rtol=1e-15)
