"""When a motion first reaches a limit: of the rate, of a component, of the energy, or of the angle by which a
body axis has turned."""
from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np

from ..errors import InputError
from ..numbers.exact import exact_vector
from ..physics.coefficients import content, effective
from ..physics.scene import AnyScene
from ..physics.states import checked_states, equations_and_start, float_array, start_of
from ..validation import checked_scene
from .caveats import caveats_of
from .passage.enclosed import STEPS as BAND_STEPS
from .passage.enclosed import WORK, banded, enclosed
from .passage.limit import Limit, asked
from .passage.never import after_a_period, by_clock, earliest, never, never_bounded
from .passage.run import Found, TimeTo, by_run, times_of

LATER = 1e-6  # of the time that a run finds: the enclosure goes on for so long after it


def time_to(scene: AnyScene, states: Any, rate: Any = None, component: Any = None, energy: Any = None,
            tilt: Any = None, t_max: float | Fraction | None = None, exact: Sequence[Fraction] | None = None,
            work: int = WORK) -> TimeTo:
    """The first time t >= 0 at which each motion reaches a limit, between a lower and an upper bound.

    scene: Scene or ScaledGyrostat. states: (..., 3) at t = 0 in the scene's variables, taken at their word;
    for scenes whose effects need more of the state (..., N), or one motion as a dict of blocks. One limit is
    given, each a positive number, exact where it is text ("0.1"): rate, of |omega|, or three numbers, of the
    size of each component, whichever comes first; component=(axis, limit), of the size of the rate about an
    axis: 1, 2, 3 or three numbers along it, or a list of such pairs, whichever comes first; energy, J,
    kinetic, of the body; tilt=(axis, angle), rad below pi, of the angle between a body axis and its own
    direction in space at t = 0. t_max: the time at which the search ends; None: when its work is done. exact:
    three exact numbers of which a single state is the rounding. work: multiplications that the proof for a
    motion may take; 0: no proof.

    Torque and wheel: the motion is enclosed and its crossing proved where the work reaches; beyond that by
    compiled steps (with numba), roots along a run, the clock of the spin-up. Other effects: roots along a
    run. Raises InputError for scenes, states and limits that are none.
    """
    given, scene = scene, effective(checked_scene(scene))
    limit, end = asked(scene, rate, component, energy, tilt), _end(t_max)
    if isinstance(work, bool) or not isinstance(work, (int, np.integer)) or work < 0:
        raise InputError(
            f"work: expected a whole number of multiplications, 0 for no proof, got {work!r:.80}")
    # neither place nor attitude turns the body here, and a tilt counts from the start
    if scene.plain and isinstance(states, dict):
        states = states.get("omega", ())
    if not scene.plain:
        rows, shape = _rows(states)
        array = np.array([equations_and_start(scene, row)[1] for row in rows]).reshape(*shape, -1)
        found = [_of_any(scene, row, limit, end) for row in rows]
    else:
        array = checked_states(states)
        rows, shape = array.reshape(-1, 3).tolist(), array.shape[:-1]
        starts = ([exact_vector(exact, "exact")] if exact is not None and len(rows) == 1
                  else [tuple(map(Fraction, row)) for row in rows])
        found = [of_one(scene, row, start, limit, end, work) for row, start in zip(rows, starts)]
    parts = content(given) if scene is not given else None
    if parts is not None and parts.note:  # what the twin takes for granted of the scene
        found = [replace(one, words=f"{one.words}; {parts.note}") for one in found]
    caveats = caveats_of(given, any(one.never for one in found))
    return times_of(found, shape, limit.words, given, array, caveats)


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


def of_one(scene: AnyScene, state: Any, start: Any, limit: Limit, end: Fraction | None, work: int = WORK,
           bands: int = BAND_STEPS, spun: Any = None) -> Found:
    """The answer for one motion of a plain scene: three floats, and the three rationals that they round.
    work: multiplications that an enclosure in integers may take; bands: compiled steps that enclose what goes
    on longer; spun: what `spin_up` says of the motion, where it was asked already."""
    if limit.reached_by(start):
        return Found(0.0, 0.0, "exact", f"{limit.words}: reached already at the start")
    found, repeats = never(scene, state, start, limit)
    if found:
        return found
    last = end if repeats is None or (end is not None and end < repeats) else Fraction(repeats)
    before = earliest(scene, start, limit)
    if last is not None and before > last:
        return after_a_period(limit) if last is not end else Found(
            down(last), math.nan, "proved",
            f"{limit.words}: not reached by the end of the search: the torque could not bring the energy for "
            "it sooner")
    proof = enclosed(scene, start, limit, last, work, before)
    if proof.high is not None:
        return Found(down(proof.low), up(proof.high), "proved",
                     f"{limit.words}: the motion enclosed, its first crossing by roots")
    if proof.done and proof.low is not None:  # the search reached its end, and no crossing is sure
        return Found(down(proof.low), math.nan, "proved",
                     f"{limit.words}: touched at t = {float(proof.low):.10g} {scene.time_unit} as closely as "
                     f"{2.0**-50:.0e}:  whether it is reached is not known")
    if proof.done:
        return after_a_period(limit) if last is not end else Found(
            down(proof.until), math.nan, "proved",
            f"{limit.words}: not reached by the end of the search, the motion enclosed")
    return _beyond_integers(scene, state, start, limit, end, max(down(proof.until), down(before)),
                            bands if work else 0, spun)


def _beyond_integers(scene: AnyScene, state: Any, start: Any, limit: Limit, end: Fraction | None,
                     known: float, bands: int, spun: Any) -> Found:
    """The work allowed in integers is done, and the limit is not reached before `known`: a run follows longer
    ways, which compiled steps enclose, and the clock tells of the longest."""
    last = math.inf if end is None else float(end)
    run = by_run(scene, state, limit, last)
    open_end = math.isnan(run.high)  # the run did not come to the limit
    if run.steps <= bands and (not open_end or run.low >= last * (1 - LATER)):
        band = banded(scene, start, limit, last if open_end else run.high * (1 + LATER), bands)
        if band is not None and band.high < math.inf:
            return Found(band.low, band.high, "proved",
                         f"{limit.words}: the motion enclosed in {band.steps} compiled steps")
        known = max(known, band.low) if band is not None else known
    if run.high >= known:  # a run that the enclosure contradicts is worth nothing
        return run
    clock = by_clock(scene, state, limit, max(run.low, known), run.low, spun) if end is None else None
    if clock is not None:
        return clock
    if run.low > known and open_end:
        return run
    return Found(known, math.nan, "proved",
                 f"{limit.words}: proved not to be reached before low; {run.words}")


def _of_any(scene: AnyScene, state: Any, limit: Limit, end: Fraction | None) -> Found:
    """The answer for one motion of any scene."""
    start = equations_and_start(scene, state)[1]
    if limit.reached_by([Fraction(v) for v in start[:3].tolist()]):
        return Found(0.0, 0.0, "exact", f"{limit.words}: reached already at the start")
    last = math.inf if end is None else float(end)
    if found := never_bounded(scene, state, limit):
        return found
    if not scene.ending:
        return by_run(scene, state, limit, last)
    from .passage.past_end import past_the_end
    return past_the_end(scene, state, limit, last)


def down(value: Any) -> float:
    near = float(value)
    return near if near <= value else math.nextafter(near, -math.inf)


def up(value: Any) -> float:
    near = float(value)
    return near if near >= value else math.nextafter(near, math.inf)
