"""When a motion first reaches a limit: of a rate, of the energy, or of the turn of a body axis.

An effect may stop acting before.

Without a run it is known that a limit is never reached, where rest, extremes, a bound or one whole period
show it; when a certified spin-up reaches it, by its clock; and a time before which the torque cannot."""
from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any, cast

import numpy as np

from ..errors import InputError
from ..integrate.trajectory import integrated
from ..numbers.exact import exact_vector
from ..numbers.numba_door import installed
from ..numbers.vectors import Exact3, Float3
from ..orbit.result import Fate
from ..physics.coefficients import content, effective
from ..physics.equations import Equations
from ..physics.scene import AnyScene, slices, stopped, time_left
from ..physics.states import (
    REST,
    checked_states,
    equations_and_start,
    float_array,
    moved_row,
    start_of,
    to_space,
)
from ..reasons import Angle, Axis, Level, Quantity, Sentence, Time
from ..unreduced.slowest import below_by
from ..unreduced.spin_up.follow import spin_up
from ..validation import checked_scene
from .caveats import caveats_of
from .limit import ENCLOSED_STEPS as BAND_STEPS
from .limit import SHORT_WORK, WORK, Limit, along_axes, asked, banded, enclosed
from .motions.angles import for_all_time
from .never_reached import (
    NEVER_BY_TURN,
    QUICK,
    SLACK,
    Beyond,
    after_settling,
    after_spin_up,
    earliest,
    never,
    never_bounded,
)
from .passage import BY_ROOTS, MOVED, ROUNDING, Found, TimeTo, by_run, run_once, times_of

# --- When a certified spin-up reaches it
# the certificate is asked for again at these shares of the earliest time, where it is narrower
LATER = (0.5, 0.97)
LITTLE = 100_000  # steps that this may take: slow drifts pass many turns in few


BY_GROWTH = Sentence(
    "by-growth-of-spin", "by the bounds of the growing spin about {axis}, {level}: they hold after {time}")


def by_clock(scene: AnyScene, state: Float3, limit: Limit, followed: float, reached: float,
             result: Any = None) -> Found | None:
    """Bounds of the first crossing of a motion whose spin-up is certified; None where none is, or where the
    limit is not of a rate along it.

    followed: a time before which the limit is known not to be reached. The bounds of the trap hold from its
    own time on; where that is later than `followed` the lower end stays there. reached: how far a run came.
    result: what `spin_up` says of the motion, where it was asked already.
    """
    if limit.angular or limit.falls or None in [along_axes(terms) for terms, _ in limit.parts]:
        return None
    result = result or spin_up(scene, state)
    if result.fate != Fate.SPIN_UP or not result.axis or result.trap is None:
        return None
    times = _times(result, limit)
    if times is None:
        return None
    sure = result.t <= followed or result.level == "exact"
    if result.level == "certified" and times[0] > result.t:
        result, times = _narrower(scene, state, limit, result, times, reached)
    low = max(followed, times[0]) if sure else followed
    reason = BY_GROWTH(axis=Axis(result.axis), level=Level(result.level),
                       time=Quantity(result.t, scene.time_unit).upper)
    return Found(low, max(times[1], low), result.level, reason=reason)


def _narrower(scene: AnyScene, state: Float3, limit: Limit, result: Any, times: Any, reached: float) -> Any:
    """(what is found, times) by certificates later on the way: as late as little work reaches, else as far as
    a run came. Each is met before the earliest time that the one before it gives."""
    for fraction in LATER:
        again = spin_up(scene, state, after=fraction * times[0], budget=LITTLE)
        if again.fate != Fate.SPIN_UP and fraction == LATER[0]:
            again = spin_up(scene, state, after=min(fraction * times[0], max(reached, result.t)))
        if again.fate != Fate.SPIN_UP or again.t > times[0] or not (narrower := _times(again, limit)):
            # bounds that hold from a time on at which the limit may have been reached say nothing of the
            # first
            break
        result, times = again, (max(times[0], narrower[0]), min(times[1], narrower[1]))
    return result, times


def _times(result: Any, limit: Limit) -> Any:
    """(earliest, latest) of all parts, or None where none of them grows with the spin."""
    bounds, spin, times = result.trap.bounds(), result.axis - 1, []
    for terms, largest in limit.parts:
        weights = cast(list[float], along_axes(terms))  # asked above
        across = sum(c * max(abs(low), abs(high)) ** 2
                     for n, (c, (low, high)) in enumerate(zip(weights, bounds)) if n != spin and c)
        if not weights[spin]:
            if across >= float(largest):
                return None  # a rate across the spin may reach it at any time
            continue
        late = result.trap.clock(math.sqrt(float(largest) / weights[spin]))[1]
        rest = float(largest) - across
        early = result.trap.clock(math.sqrt(rest / weights[spin]))[0] if rest > 0 else 0.0
        times.append((early, late))
    return (min(t for t, _ in times), min(t for _, t in times)) if times else None


# --- Past the end of an effect
AFTER_ITS_END = Sentence(
    "roots-over-end", "roots along a run in machine precision over the end of an effect")()
FROM_ITS_END = Sentence("from-end-of-effect", "from the end of an effect on")()
NOT_WITHIN = Sentence("not-within", "not reached within {time}")


def past_the_end(scene: AnyScene, state: Any, limit: Limit, last: float) -> Found:
    """The first crossing by `last` along runs, the second of them from the end of the effect on."""
    start, direction = _blocks(*equations_and_start(scene, state)), limit.direction
    left = time_left(scene)
    if left is None or last <= left:
        return by_run(scene, start, limit, last)
    attitude = start.get("attitude", np.array(REST["attitude"]))
    start = {name: start[name] for name in scene.blocks}
    if direction is not None:
        start["attitude"] = attitude
        origin = to_space(attitude, [float(v) for v in direction])
        limit = replace(limit, origin=tuple(origin.tolist()))
    result = by_run(scene, start, limit, left) if left else Found(0.0, math.nan, "run", reason=BY_ROOTS)
    if math.isfinite(result.high) or result.level == "undecided" or result.low < left * (1 - 2 * ROUNDING):
        return result
    equations, row = equations_and_start(scene, start)
    ends = [_blocks(equations, integrated(scene, _blocks(equations, item), [left], laws=False).states[-1])
            for item in (row, moved_row(row, MOVED))]
    after, there = stopped(scene, ends[0])
    rates = tuple(there["omega"])
    if after.plain and (surely := never(after, rates, tuple(map(Fraction, rates)), limit)[0]) is not None:
        return replace(surely, level="run", reason=surely.reason.then(FROM_ITS_END, ", "),
                       steps=result.steps)
    later = by_run(after, rates if after.plain and direction is None else there, limit, last - left,
                   beside=np.concatenate([ends[1][name] for name in there]))
    until = Time(left + later.low).lower
    reason = AFTER_ITS_END.then(None if math.isfinite(later.high) else NOT_WITHIN(time=until), ": ")
    return replace(later, low=left + later.low, high=left + later.high, reason=reason,
                   steps=result.steps + later.steps)


def _blocks(equations: Equations, row: np.ndarray) -> dict[str, np.ndarray]:
    return {name: row[part] for name, part in slices(equations.blocks).items()}


# --- The first time
BEYOND = 1e-6  # of the time that a run finds: the enclosure goes on for so long after it


def time_to(scene: AnyScene, states: Any, rate: Any = None, component: Any = None, energy: Any = None,
            tilt: Any = None, t_max: float | Fraction | None = None, exact: Sequence[Fraction] | None = None,
            work: int = WORK, below: Any = None, nutation: Any = None, nutation_below: Any = None) -> TimeTo:
    """The first time t >= 0 at which each motion reaches a limit, between a lower and an upper bound.

    scene: Scene or ScaledGyrostat. states: (..., 3) at t = 0 in the scene's variables, taken at their word;
    for scenes whose effects need more of the state (..., N), or one motion as a dict of blocks. One limit is
    given, each a positive number, exact where it is text ("0.1"): rate, of |omega|, or three numbers, of the
    size of each component, whichever comes first; component=(axis, limit), of the size of the rate about an
    axis: 1, 2, 3 or three numbers along it, or a list of such pairs, whichever comes first; energy, J,
    kinetic, of the body; tilt=(axis, angle), rad below pi, of the angle between a body axis and its own
    direction in space at t = 0; nutation=(axis, angle), likewise, of that between a body axis and the angular
    momentum; below, of |omega|, and nutation_below, the first time at which it is no larger. t_max: the time
    at which the search ends; None: when its work is done. exact: three exact numbers of which a single state
    is the rounding. work: multiplications that the proof for a motion may take; 0: no proof.

    Torque and wheel: the motion is enclosed and its crossing proved where the work reaches (with numba, at
    most a second of it, as compiled steps go on); beyond that by roots along a run, the clock of the spin-up.
    Other effects: roots along a run. Raises InputError for scenes, states and limits that are none.
    """
    supplied, scene = scene, effective(checked_scene(scene))
    limit, end = asked(scene, rate, component, energy, tilt, below, nutation, nutation_below), _end(t_max)
    if isinstance(work, bool) or not isinstance(work, (int, np.integer)) or work < 0:
        raise InputError(
            f"work: expected a whole number of multiplications, 0 for no proof, got {work!r:.80}")
    # neither place nor attitude turns the body here, and a tilt counts from the start
    if scene.plain and isinstance(states, dict):
        states = states.get("omega", ())
    if not scene.plain:
        rows, shape = _rows(states)
        array = np.array([equations_and_start(scene, row)[1] for row in rows]).reshape(*shape, -1)
        result = [_of_any(scene, row, limit, end) for row in rows]
    else:
        array = checked_states(states)
        rows, shape = array.reshape(-1, 3).tolist(), array.shape[:-1]
        starts = ([exact_vector(exact, "exact")] if exact is not None and len(rows) == 1
                  else [tuple(map(Fraction, row)) for row in rows])
        result = [of_one(scene, row, start, limit, end, work) for row, start in zip(rows, starts)]
    parts = content(supplied) if scene is not supplied else None
    if parts is not None and parts.note:  # what the twin takes for granted of the scene
        result = [replace(item, reason=item.reason.then(parts.note)) for item in result]
    caveats = caveats_of(supplied, any(item.never for item in result))
    return times_of(result, shape, limit.label, supplied, array, caveats)


def time_of_case(case: Any, ask: dict[str, Any], t_max: float | Fraction | None = None,
                 work: int = WORK) -> TimeTo:
    """The answer for the motion of a case; ask: the one limit, by its name as of `time_to`; work: likewise.
    """
    if case.scene.plain:
        return time_to(case.scene, case.state, **ask, t_max=t_max, exact=case.exact_state, work=work)
    return time_to(case.scene, start_of(case.scene, case.state, case.blocks), **ask, t_max=t_max, work=work)


def _rows(states: Any) -> Any:
    """(one start for each motion, shape of the answer) of a scene whose state may be more than three rates.
    """
    if isinstance(states, dict):
        return [states], ()
    array = float_array(states, "states", "numbers in rows, or a dict of blocks")
    return list(array.reshape(-1, array.shape[-1])) if array.ndim else [array], array.shape[:-1]


def _end(t_max: float | Fraction | None) -> Fraction | None:
    if t_max is None:
        return None
    try:
        if (value := float(t_max)) > 0:
            return None if value == math.inf else Fraction(t_max)
    except (TypeError, ValueError, OverflowError):
        pass
    raise InputError(f"t_max: expected a positive time, got {t_max!r:.80}")


AT_THE_START = Sentence("reached-at-start", "reached already at the start")()
BELOW_BY_LAW = Sentence("below-by-law", "by {time} at the latest: {law}")
TORQUE_TOO_SLOW = Sentence(
    "torque-too-slow", "not reached by the end of the search: the torque could not bring the energy for it "
    "sooner")()
MOTION_ENCLOSED = Sentence("motion-enclosed", "the motion enclosed, its first crossing by roots")()
TOUCHED = Sentence(
    "limit-touched", "touched after {time} as closely as {share}: whether it is reached is not known")
ENCLOSED_TO_END = Sentence("enclosed-to-end", "not reached by the end of the search, the motion enclosed")()
ENCLOSED_IN_STEPS = Sentence("enclosed-in-steps", "the motion enclosed in {steps} compiled steps")
PROVED_BEFORE = Sentence("proved-before", "proved not to be reached before {time}")


def of_one(scene: AnyScene, state: Any, start: Any, limit: Limit, end: Fraction | None, work: int = WORK,
           bands: int = BAND_STEPS, spun: Any = None, steps_first: bool = False) -> Found:
    """The answer for one motion of a plain scene: three floats, and the three rationals that they round.
    work: multiplications that an enclosure in integers may take; bands: compiled steps that enclose what goes
    on longer; spun: what `spin_up` says of the motion, where it was asked already. steps_first: compiled
    steps are tried before integers, for callers that have loaded them: a step takes a fiftieth of the time,
    and the bracket, of some 1e-13 of the time, is wider."""
    if limit.reached_by(start):
        return Found(0.0, 0.0, "exact", reason=AT_THE_START)
    result, beyond = never(scene, state, start, limit)
    if result:
        return result
    if limit.kind == "below" and beyond is None and not math.isfinite(
            run_once(scene, state, limit, float(end or math.inf), QUICK)[0]):
        beyond = after_spin_up(scene, state, limit, spun)
    last = end if beyond is None or (end is not None and end < beyond.time) else Fraction(beyond.time)
    if limit.momentum is not None and not limit.momentum.stays:  # its size changes: no linear limit
        return _by_run_to(scene, state, limit, beyond, end)
    before = earliest(scene, start, limit)
    if last is not None and before > last:
        return beyond.never if beyond and last is not end else Found(
            down(last), math.nan, "proved",
            reason=TORQUE_TOO_SLOW)
    if steps_first and work and bands and installed():
        result = _beyond_integers(scene, state, start, limit, last, down(before), bands, spun)
        if result.steps > bands or (result.level == "proved" and math.isfinite(result.high)):
            return result  # what takes more steps than these in doubles is too long for integers
    proof = enclosed(scene, start, limit, last, min(work, SHORT_WORK) if bands and installed() else work,
                     before)
    if proof.high is not None:
        return Found(down(proof.low), up(proof.high), "proved",
                     reason=MOTION_ENCLOSED)
    if proof.done and proof.low is not None:  # the search reached its end, and no crossing is sure
        return Found(down(proof.low), math.nan, "proved",
                     reason=TOUCHED(time=Quantity(float(proof.low), scene.time_unit),
                                    share=Quantity(2.0**-50, digits=1)))
    if proof.done:
        return beyond.never if beyond and last is not end else Found(
            down(proof.until), math.nan, "proved",
            reason=ENCLOSED_TO_END)
    if limit.kind == "tilt" and end is None and (law := _never_turns(scene, state, start, limit)):
        return law
    resolved = max(down(proof.until), down(before))
    if beyond and (limit.falls or limit.momentum is not None) and last is not end:
        return _until(scene, state, start, limit, beyond, resolved, bands if work else 0)
    return _beyond_integers(scene, state, start, limit, end, resolved, bands if work else 0, spun)


def _by_run_to(scene: AnyScene, state: Any, limit: Limit, beyond: Beyond | None,
               end: Fraction | None) -> Found:
    """The answer by a run alone, of a limit that is reached by `beyond.time` or never."""
    last = math.inf if end is None else float(end)
    full = beyond is not None and beyond.time < last
    result = by_run(scene, state, limit, beyond.time if beyond is not None and full else last)
    if beyond is None or not full or not math.isnan(result.high) or result.low < beyond.time * (1 - BEYOND):
        return result
    return replace(beyond.never, level="run", steps=result.steps)


def _never_turns(scene: AnyScene, state: Float3, start: Exact3, limit: Limit) -> Found | None:
    """The answer where rates that repeat under a torque keep a body axis within the limit of its tilt."""
    if scene.variables == "scaled" or not any(scene.quadratic().m):
        return None
    ((_, vector),), angle = limit.parts[0]
    result = for_all_time(scene, state, start, [vector])
    if result is None or not float(result[1][0]) * (1 + SLACK) < float(angle):
        return None
    reason = NEVER_BY_TURN(angle=Angle(float(result[1][0])).upper, law=result[-1])
    return Found(math.inf, math.inf, result[-2], reason=reason)


def _until(scene: AnyScene, state: Any, start: Any, limit: Limit, beyond: Beyond, resolved: float,
           bands: int) -> Found:
    """The answer beyond the work in integers, of a limit that is reached by `beyond.time` or never."""
    result = _beyond_integers(scene, state, start, limit, Fraction(beyond.time), resolved, bands, None)
    if not math.isnan(result.high) or result.low < beyond.time * (1 - BEYOND):
        return result
    level = beyond.never.level if result.level == "proved" else "run"
    return replace(beyond.never, level=level, steps=result.steps)


def _beyond_integers(scene: AnyScene, state: Any, start: Any, limit: Limit, end: Fraction | None,
                     resolved: float, bands: int, spun: Any) -> Found:
    """The work allowed in integers is done, and the limit is not reached before `resolved`: a run follows
    longer ways, which compiled steps enclose, and the clock tells of the longest."""
    last = math.inf if end is None else float(end)
    run = by_run(scene, state, limit, last)
    open_end = math.isnan(run.high)  # the run did not come to the limit
    if run.steps <= bands and (not open_end or run.low >= last * (1 - BEYOND)):
        band = banded(scene, start, limit, last if open_end else run.high * (1 + BEYOND), bands)
        if band is not None and band.low is not None and band.high is not None:
            return Found(down(band.low), up(band.high), "proved",
                         reason=ENCLOSED_IN_STEPS(steps=band.steps))
        if band is not None:
            resolved = max(resolved, down(band.until if band.low is None else band.low))
    if run.high >= resolved:  # a run that the enclosure contradicts is worth nothing
        return run
    clock = by_clock(scene, state, limit, max(run.low, resolved), run.low, spun) if end is None else None
    if clock is not None:
        return clock
    if run.low > resolved and open_end:
        return run
    return Found(resolved, math.nan, "proved",
                 reason=PROVED_BEFORE(time=Quantity(resolved, scene.time_unit).lower).then(run.reason))


def _of_any(scene: AnyScene, state: Any, limit: Limit, end: Fraction | None) -> Found:
    """The answer for one motion of any scene."""
    start = equations_and_start(scene, state)[1]
    if limit.reached_by([Fraction(v) for v in start.tolist()]):
        return Found(0.0, 0.0, "exact", reason=AT_THE_START)
    last = math.inf if end is None else float(end)
    if result := never_bounded(scene, state, limit):
        return result
    beyond = after_settling(scene, state, limit) if limit.kind == "below" and end is None else None
    if beyond is not None:
        result = by_run(scene, state, limit, beyond.time)
        done = math.isnan(result.high) and result.low >= beyond.time * (1 - BEYOND)
        return replace(beyond.never, steps=result.steps) if done else result
    if not scene.ending:
        return _by_law_too(scene, state, limit, end, by_run(scene, state, limit, last))
    return past_the_end(scene, state, limit, last)


def _by_law_too(scene: Any, state: Any, limit: Limit, end: Fraction | None, result: Found) -> Found:
    """What a run finds, with the time by which a law brings |omega| below the limit where the run came to no
    crossing."""
    if limit.kind != "below" or not math.isnan(result.high) or result.level == "undecided":
        return result
    law = below_by(scene, state, limit.least_rate())
    if law is None or (end is not None and law.time > end):
        return result
    return replace(result, high=law.time,
                   reason=result.reason.then(BELOW_BY_LAW(time=Time(law.time).upper, law=law.reason)))


def down(value: Any) -> float:
    nearby = float(value)
    return nearby if nearby <= value else math.nextafter(nearby, -math.inf)


def up(value: Any) -> float:
    nearby = float(value)
    return nearby if nearby >= value else math.nextafter(nearby, math.inf)
