"""When the motion of a case reaches a limit, and when functions of its state vanish.

A limit is stated as on a command line ("30 deg/s", "z = 30 deg/s"); a tilt of the torque may change the
answer. Zeros are those of a component, or of any function, given as `events` of SciPy's `solve_ivp`."""
from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import numpy as np

from ..case.given import Amount, Given, Span, Start, Starts
from ..case.limit_options import StatedLimit, stated_limit
from ..case.read import Case
from ..errors import InputError, ToleranceNotMet
from ..integrate.trajectory import Trajectory
from ..numbers.double_double import EPS
from ..numbers.units import NONE, TIME, in_si
from ..orbit.landscape import landscape
from ..orbit.one_orbit import Orbit
from ..orbit.passage_time import crossing_time
from ..orbit.result import Motion, Needs
from ..physics.coefficients import effective, loses
from ..physics.scene import BLOCKS, AnyScene, later, slices, torque_axis
from ..physics.states import equations_and_start, moved_row, start_of
from ..reasons import Reasoned, Sentence
from ..representation import Answer
from .caveats import STEADY, answered, caveats_of, limited, loose_forces, misaligned, seen, stated
from .digits_asked import MOST_DIGITS, checked_digits
from .dissipation.ending import ending
from .kinds import kind_of
from .limit import ANGLES, WORK, asked, starts_above
from .motion import motion
from .motions.starts import asked_of, whole_rows
from .passage import MOVED, WIDER, TimeTo, by_run, times_of
from .simulate import denser, trajectory
from .tilt import Spread, Tilt, cone_of, spread, tilt
from .time_to import time_of_case, time_to

# --- Zeros of functions along a motion
SAMPLES = 16     # of a step of the run: between them a function is looked at for a change of its sign
MAX_SAMPLES = 400_000   # samples of a run


CHANGES_OF_SIGN = Sentence(
    "changes-of-sign", "changes of sign between {samples} samples of every step of a run ({method}), each "
    "found to rounding; two zeros between neighbouring samples are not seen")


@dataclass(frozen=True, eq=False, repr=False)
class Crossings(Answer, Reasoned):
    """Zeros of events along a motion, for each event in its order.

    t: a row (k,) of times an event, in the scene's time; states: (k, N) there; error: (k,) of the times, from
    a second run whose start is moved in its last places, inf where that has not as many zeros; until: the
    time that was reached; status: "reached", "ended" by an event with `terminal`, or "stopped"; reason: how
    they are known.
    """

    t: tuple[np.ndarray, ...]
    states: tuple[np.ndarray, ...]
    error: tuple[np.ndarray, ...]
    until: float
    status: str


def crossings(scene: AnyScene, start: Any, until: float, events: Any) -> Crossings:
    """The zeros of events for 0 < t <= until, of the motion that is at `start` at t = 0 (numbers or blocks,
    as `trajectory` takes them).

    events: the name of a component ("omega3", "gamma1", "x2"), a function of the time and the state (N,), or
    several of these. As for `solve_ivp` a function may have `direction` (above 0: from below only, below 0:
    from above only) and `terminal` (True, or after how many the search ends). Raises InputError for what is
    no event, or gives no finite number.
    """
    equations, state = equations_and_start(scene, start)
    names = (scene.components if equations.blocks == ("omega",) else
             [name for block in equations.blocks for name in BLOCKS[block].components])
    single = isinstance(events, str) or not hasattr(events, "__iter__")
    request = [_event(event, list(names)) for event in ([events] if single else list(events))]
    if not request:
        raise InputError(
            "events: expected the name of a component, a function, or several of these; got none")
    times, states, run = _zeros(scene, _blocks(equations, state), until, request)
    second = _zeros(scene, _blocks(equations, moved_row(state, MOVED)), until, request)
    error = [WIDER * np.abs(time - two) + 4 * EPS * time if len(time) == len(two)
             else np.full(len(time), math.inf) for time, two in zip(times, second[0])]
    end = float(run.t[-1]) if len(run.t) else 0.0
    ends = [float(row[int(count) - 1]) for event, row in zip(request, times)
            if (count := getattr(event, "terminal", 0) or 0) and len(row) >= int(count)]
    end = min(ends, default=end)
    within = lambda rows: tuple(row[time <= end] for row, time in zip(rows, times))
    return Crossings(within(times), within(states), within(error), end,
                     "ended" if ends else "reached" if run.status == "reached" else "stopped",
                     reason=CHANGES_OF_SIGN(samples=SAMPLES, method=run.method).then(
                         None if run.status == "reached" else run.reason))


def _blocks(equations: Any, state: np.ndarray) -> dict[str, np.ndarray]:
    return {name: state[part] for name, part in slices(equations.blocks).items()}


def _event(source: Any, names: list[str]) -> Callable[[float, np.ndarray], Any]:
    if isinstance(source, str):
        if source not in names:
            raise InputError(f"events: there is no component {source!r:.60}; there are {', '.join(names)}")
        at = names.index(source)
        return lambda t, y: y[at]
    if not callable(source):
        raise InputError(
            f"events: expected the name of a component or a function of t and the state, got {source!r:.60}")
    return source


def _value(event: Callable[[float, np.ndarray], Any], t: float, y: np.ndarray) -> float:
    name = getattr(event, "__name__", type(event).__name__)
    try:
        value = float(event(t, y))
    except (TypeError, ValueError) as error:
        raise InputError(f"events: {name} gives no number at t = {t:.6g}: {error}") from None
    if not math.isfinite(value):
        raise InputError(f"events: {name} gives {value} at t = {t:.6g}; expected a finite number")
    return value


def _zeros(scene: AnyScene, start: Any, until: float, events: Sequence[Any]
           ) -> tuple[list[np.ndarray], list[np.ndarray], Trajectory]:
    """(times, states of each event, the run on whose samples they were looked for)."""
    ends: list[float] = []
    trajectory(scene, start, [0.0, until], steps=ends, laws=False)
    knots = np.unique([0.0, until, *(t for t in ends if 0 < t < until)])
    grid = np.unique([*denser(knots, SAMPLES, MAX_SAMPLES), until])
    run = trajectory(scene, start, grid, laws=False)
    times, states = [], []
    for event in events:
        values = np.array([_value(event, t, y) for t, y in zip(run.t.tolist(), run.states)])
        rows = [_root(scene, run, n, values, event) for n in _places(values, getattr(event, "direction", 0))]
        times.append(np.array([t for t, _ in rows]))
        states.append(np.array([y for _, y in rows]).reshape(len(rows), run.states.shape[1]))
    return times, states, run


def _places(values: np.ndarray, direction: float) -> np.ndarray:
    """The samples before a zero, or before a change of sign; a zero of the start is none."""
    before, after = values[:-1], values[1:]
    hit = (before != 0) & (np.sign(before) != np.sign(after))
    return np.nonzero(hit & ((direction == 0) | (np.sign(before) == -np.sign(direction))))[0]


def _root(scene: AnyScene, run: Trajectory, n: int, values: np.ndarray,
          event: Any) -> tuple[float, np.ndarray]:
    """(time, state) of the zero between samples n and n + 1, by short runs from the first of them."""
    from scipy.optimize import brentq
    if values[n + 1] == 0:
        return float(run.t[n + 1]), run.states[n + 1]
    start = {name: run.states[n, part] for name, part in run.blocks.items()}
    left = later(scene, float(run.t[n]))

    def state(after: float) -> np.ndarray:
        return run.states[n] if after == 0 else trajectory(left, start, [after], laws=False).states[0]
    step = float(run.t[n + 1] - run.t[n])
    value = lambda s: values[n + 1] if s == step else _value(event, float(run.t[n]) + s, state(s))
    after = float(brentq(value, 0.0, step, xtol=4 * EPS * step, rtol=4 * EPS))
    return float(run.t[n]) + after, state(after)


# --- When a motion reaches a limit
PAST = 1.25  # times the end of a motion that loses energy, up to which it is followed
LONGER = 3_000_000  # steps of that run
FASTEST = 1e150  # rad/s: beyond it squares come near the end of doubles, and no run holds the motion


def when(case: Given, state: Start | None = None, rate: Amount | None = None,
         component: str | tuple[str, Amount] | None = None, energy: Amount | None = None,
         tilt: str | tuple[str, Amount] | None = None, until: Amount | None = None,
         events: Any = None, *, below: Amount | None = None,
         nutation: str | tuple[str, Amount] | None = None,
         nutation_below: str | tuple[str, Amount] | None = None, states: Starts | None = None,
         span: Span | None = None, digits: int | None = None,
         frame: str = "principal") -> TimeTo | Crossings:
    """The first time at which the motion of a case reaches a limit, or that it never does.

    case: a case in any form, or a scene; state, states, span, frame: as of `fate`.

    One limit: rate="30 deg/s", of |omega|; component="z = 30 deg/s", or ("z", "30 deg/s"), of the size of the
    rate about x, y, z of the file or 1, 2, 3, the principal axes; energy="5 J", kinetic; tilt="z = 20 deg",
    of the angle between a body axis and its direction at the start; nutation="z = 20 deg", of that between a
    body axis and the angular momentum; below="5 deg/s", to which |omega| falls, and nutation_below="z = 5
    deg", less than that of the start (of many `states` the time is 0 where it is not); where none is given,
    that of [limits].
    Numbers are in SI units. until: the time at which the search ends. events: in place of a limit, the name
    of a component ("omega3"), a function of the time and the state, or several of these, whose zeros up to
    `until` (or the end of the case's span) are found: see `stabilab.answers.when`. digits: 1 to 10,000, of
    the time of one motion to a limit, written out as `decimals`; InputError where no formula gives so many.
    Raises InputError for a limit that is none, and as `time_to` does.
    """
    case, array = asked_of(case, state, states, span, "when", frame)
    if digits is not None and (events is not None or array.ndim > 1):
        raise InputError("digits: those of the time of one motion to a limit: give one state, and no events")
    if events is not None:
        if array.ndim > 1:
            raise InputError("when: events are those of one motion: give one state")
        supplied = any(item is not None for item in (rate, component, energy, tilt, below, nutation,
                                                              nutation_below))
        return _crossings(case, events, until, supplied)
    limit = limit_stated(case, rate, component, energy, tilt, until, below, nutation, nutation_below)
    if array.ndim == 1:
        return limited_time(case, limit.ask, limit.until, digits)
    result = time_to(case.scene, whole_rows(case, array), **limit.ask, t_max=limit.until)
    return replace(result, caveats=(*case.caveats, *result.caveats))


def limit_stated(case: Any, rate: Any = None, component: Any = None, energy: Any = None, tilt: Any = None,
                 until: Any = None, below: Any = None, nutation: Any = None,
                 nutation_below: Any = None) -> StatedLimit:
    """The limit that these arguments of `when` state."""
    return stated_limit(case, *map(_text, (rate, component, energy, tilt, until, below, nutation,
                                           nutation_below)))


def _crossings(case: Case, events: Any, until: Any, limited: bool) -> Crossings:
    if limited:
        raise InputError("when: expected a limit or events, got both: ask for each by itself")
    if until is None and case.span is None or case.state is None:
        raise InputError("when: events need until, the time at which the search ends: the case has no span")
    unit = NONE if case.variables == "scaled" else TIME
    end = float((case.span or (0, 0))[1] if until is None else in_si(until, unit, "until"))
    if not end > 0:
        raise InputError(f"until: expected a time above 0, got {end:.6g}")
    start = case.state if case.variables == "scaled" else start_of(case.scene, case.state, case.blocks)
    return answered(crossings(case.scene, start, end, events), case)


def _text(supplied: Any) -> str | None:
    """As a command line has it."""
    if supplied is None or isinstance(supplied, str):
        return supplied
    return " = ".join(map(str, supplied)) if isinstance(supplied, (tuple, list)) else str(supplied)


def limited_time(case: Any, ask: dict[str, Any], t_max: float | Fraction | None = None,
                 digits: int | None = None, tell: Callable[[float], None] | None = None) -> TimeTo:
    """As `time_of_case`; where it is never, with what a tilt of the torque does, by what the case states as
    misalignment, else by one degree; and with what the tolerances of its forces do. digits, tell: as of
    `_with_digits`."""
    starts_above(asked(case.scene, **ask), case)
    result = time_of_case(case, ask, t_max)
    moved = motion(case, needs=Needs.FATE) if math.isinf(result.low) or loses(case.scene) else None
    end = None if moved is None or not loses(case.scene) else ending(case, moved)
    if end is not None and end.until is not None:
        result = _to_the_end(case, ask, result, PAST * end.until, t_max)
    never = math.isinf(result.low)
    stability = None if moved is None or not never else moved.stability
    off = of_tilt(case, None, ask, never)
    if digits is not None:
        result = _with_digits(case, result, ask, digits, tell)
    return replace(result, ending=end, tilt=off,
                   caveats=caveats_of(case.scene, never, off, file=seen(case.caveats, off),
                                      stability=stability))


def _with_digits(case: Any, result: TimeTo, ask: dict[str, Any], digits: int,
                 tell: Callable[[float], None] | None) -> TimeTo:
    """The answer for one motion of a case with its time to 1 to 10,000 digits, every one proved, as
    `decimals`; as it is where the limit is not known to be reached, or is at the start. tell: is given the
    seconds that a long answer will take. InputError where no formula gives the time, ToleranceNotMet where
    the first crossing is known by a run alone, or its place is not told from others."""
    checked_digits(digits, MOST_DIGITS)
    low, high = float(result.low), float(result.high)
    if not 0 < high < math.inf:
        return result
    scene, limit = effective(case.scene), asked(case.scene, **ask)
    land = landscape(scene) if scene.plain else None
    if land is None or limit.angular:
        raise InputError("digits: the time to this limit has no formula, the motion is followed (a formula "
                         "gives that to a rate or an energy, without a torque or with one on a principal "
                         "axis); leave the digits out: the two times of the answer have up to 15")
    if limit.falls:
        raise InputError("digits: the formula gives the time to a limit that is reached from below: ask with "
                         "--rate, --component or --energy, or leave the digits out: the two times of the "
                         "answer to --below have up to 15")
    why, ball = f"which crossing is the first is not proved ({result.reason})", None
    if result.level == "proved":
        why = "the crossing lies where the motion turns, or touches the limit, or beyond a period"
        orbit = Orbit(land.reduction, case.exact_state or case.state)
        ball = crossing_time(orbit, scene.quadratic(), limit.parts, low, high, digits, tell)
    if ball is None:
        raise ToleranceNotMet(f"when: {digits} digits asked for: {why}; leave the digits out")
    return replace(result, decimals=ball.mid().str(digits + 1, radius=False))


def _to_the_end(case: Any, ask: dict[str, Any], result: TimeTo, until: float,
                t_max: float | Fraction | None) -> TimeTo:
    """What is found, by a longer run where the first one broke off before the motion of a case had ended.
    until: s, when that is."""
    last = until if t_max is None else min(until, float(t_max))
    if not math.isnan(result.high) or float(result.low) >= last or case.scene.ending:
        return result
    again = by_run(case.scene, start_of(case.scene, case.state, case.blocks), asked(case.scene, **ask), last,
                   LONGER)
    if float(again.low) <= float(result.low):
        return result
    return times_of([again], (), result.quantity, case.scene, np.asarray(result.states), result.caveats)


def with_first(case: Any, motion: Motion, work: int = WORK) -> Motion:
    """The motion with the time at which it reaches the limit of its case, where that states one. work: as of
    `time_to`."""
    ask = limit_of(case)
    if ask is None or motion.first is not None:
        return motion
    return limited(replace(motion, first=(stated(case.limits), time_of_case(case, ask, work=work))),
                   case.scene, case)


def with_tilt(case: Any, motion: Motion, angle: float | None = None) -> Motion:
    """The motion of a case with what a tilt of its torque does to it. angle: rad; None: what its stuck
    thrusters state, else one degree."""
    result = of_tilt(case, angle, limit_of(case), motion.fate in STEADY)
    return limited(replace(motion, tilt=result), case.scene, case)


def limit_of(case: Any) -> dict[str, Any] | None:
    """The limit of a case as `time_to` takes it."""
    limits = case.limits
    if limits is None:
        return None
    return {"rate": limits.rate} if limits.rate is not None else {"component": limits.components(case.frame)}


def of_tilt(case: Any, angle: float | None, ask: dict[str, Any] | None, steady: bool,
            steps_first: bool = False) -> Tilt | Spread | None:
    """What the torques of the cone do: to a steady motion under one on an axis always, else where a tilt is
    asked for or stated, or a tolerance of a force; why not, where it is not looked at (a tolerance is then
    left to the caveats of the case). steps_first: as of `time_to.of_one`."""
    tilts, sized = angle is not None or bool(misaligned(case)), bool(loose_forces(case))
    loose = tilts or sized
    on_axis = (steady and case.variables != "scaled" and bool(torque_axis(case.scene))
               and kind_of(case.scene) == "orbit")
    if not loose and not on_axis:
        return None
    plain = case.variables != "scaled" and case.scene.plain
    why = ("in scaled variables" if case.variables == "scaled"
           else "with other effects than wheel and torque" if not plain else
           "with rates whose squares are no doubles" if _too_fast(case, ask) else
           "for a rate that is to fall" if ask and "below" in ask else
           "for the angle of an axis" if ask and not ANGLES.isdisjoint(ask) else
           "" if on_axis or any(case.scene.vector("constant_torque")) else "without a torque")
    if why:
        return Spread(angle or 0.0, "the torque", 0, omitted=why) if tilts else None
    if on_axis and (tilts or ask is not None or not sized):
        return tilt(case.scene, case.state, angle, None, case, case.exact_state, ask)
    return spread(case.scene, case.state, cone_of(case.scene, case, angle), ask, case.exact_state,
                  steps_first)


def _too_fast(case: Any, ask: dict[str, Any] | None) -> bool:
    limit = None if ask is None or not ANGLES.isdisjoint(ask) else asked(case.scene, **ask).least_rate()
    return max(*map(abs, case.state), limit or 0.0) > FASTEST
