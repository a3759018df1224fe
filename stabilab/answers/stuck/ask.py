"""The question: a thruster is stuck open, what becomes of the spacecraft, how soon, and what helps?"""
from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from ...errors import InputError
from ...numbers.exact import floats
from ...numbers.principal import NOTHING, without_trace
from ...numbers.vectors import Exact3
from ...physics.scene import Scene
from ..caveats import STEADY, caveats_of
from ..passage.of_case import limit_of, of_tilt
from ..tilt import Spread, Tilt
from .fate import Found, found
from .helpers import helpers
from .margins import margins
from .result import Principal, Row, Stuck, WheelAnswer
from .scenario import Scenario, scenario_of
from .wheel import delayed, intervals


def stuck(case: Any, all_thrusters: bool = False, progress: Callable[[str], Any] | None = None) -> Stuck:
    """What the stuck thrusters of a case do: fate, axis, time to the limit, margins, wheels and thrusters
    that help.

    case: as `stabilab.load` gives it, with a motion. The first row has all thrusters that the case marks as
    stuck firing together, with what else turns the body; where they are several, a row for each alone
    follows. all_thrusters: a row for each thruster alone instead, stuck or not, the one that reaches the
    limit first in front. progress: called with words before every row. Raises InputError for a case without a
    motion or without a thruster that could be stuck, and for other effects than wheel and torque.
    """
    scenario = scenario_of(case)
    rows = []
    for chosen in _chosen(case, scenario, all_thrusters):
        if progress:
            progress(f"{case.name}: {_named(chosen)}")
        rows.append(_row(scenario, chosen))
    if all_thrusters:
        rows.sort(key=_soonest)
    principal = Principal(floats(scenario.axes.moments),
                          tuple(tuple(float(v) + 0.0 for v in axis) for axis in scenario.axes.axes))
    return Stuck(case.name, tuple(rows), principal, all_thrusters)


def _named(thrusters: Sequence[Any]) -> str:
    return " and ".join(t.name for t in thrusters) or "the torque of the case"


def _chosen(case: Any, scenario: Scenario, all_thrusters: bool) -> list[tuple[Any, ...]]:
    """The combinations of thrusters that are asked about, a tuple each."""
    if all_thrusters:
        if not case.thrusters:
            raise InputError("the case has no thruster: describe each in a table [[thrusters]]")
        return [(t,) for t in case.thrusters]
    marked = tuple(t for t in case.thrusters if t.stuck)
    if not marked and not any(scenario.base):
        names = ", ".join(t.name for t in case.thrusters)
        cure = (f"mark one of {names} with stuck = true, or ask with --all-thrusters" if names else
                "describe one in a table [[thrusters]] with stuck = true, or give a torque")
        raise InputError(f"no thruster is stuck and no torque acts: {cure}")
    return [marked] + ([(t,) for t in marked] if len(marked) > 1 else [])


def _soonest(row: Row) -> tuple[Any, ...]:
    """In front: the limit is reached soon; then what spins up later or is not known, then what never reaches
    it."""
    return (row.time_to_limit[0] if row.time_to_limit else math.inf,
            {"spin-up": 0, "undecided": 1}.get(row.fate, 2))


def _row(scenario: Scenario, thrusters: Sequence[Any]) -> Row:
    torque = scenario.torque(thrusters)
    seen = found(scenario, torque)
    others = [t for t in scenario.case.thrusters if t not in thrusters]
    scene = scenario.scene(torque)
    off = _tilted(scenario, thrusters, scene, seen)
    caveats = caveats_of(scene, seen.fate in STEADY or seen.never, off, file=scenario.case.caveats)
    along = seen.direction and scenario.in_file(seen.direction)
    return Row(tuple(t.name for t in thrusters), scenario.torque_in_file(thrusters),
               tuple(float(v) + 0.0 for v in torque),
               seen.fate.word, seen.level, seen.axis or None, seen.sense or None, along, scenario.limit,
               seen.time, seen.time_level,
               seen.never, seen.largest, seen.followed, seen.because, margins(scenario, scene, seen),
               tuple(_wheel(scenario, torque, seen, wheel) for wheel in scenario.case.wheels),
               helpers(scenario, torque, others, seen) if seen.fate not in STEADY else (), off, caveats)


def _tilted(scenario: Scenario, thrusters: Sequence[Any], scene: Scene, seen: Found) -> Tilt | Spread | None:
    """What a tilt of the torque does: to a bounded motion under one on an axis by the misalignment of the
    thrusters that fire, else by one degree; else by that misalignment alone."""
    loose = any(t.misalignment for t in thrusters)
    firing = tuple(replace(t, stuck=t in thrusters) for t in scenario.case.thrusters)
    case = replace(scenario.case, thrusters=firing, scene=scene)
    return (of_tilt(case, None, limit_of(case), seen.fate in STEADY) if loose or scenario.limit is not None
            else None)


def _wheel(scenario: Scenario, torque: Exact3, seen: Found, wheel: Any) -> WheelAnswer:
    """What one wheel of the case can do, the others left as they are."""
    axis = without_trace(scenario.axes.turned(wheel.axis), torque)
    least = NOTHING * max(map(abs, scenario.wheel))
    others = tuple(v if abs(v) > least else v * 0 for w,
                   a in zip(scenario.wheel, axis) for v in [w - wheel.momentum * a])
    kept, because = intervals(scenario.scene(torque, others), scenario.state, axis)
    told = tuple(map(float, wheel.axis)), float(wheel.momentum), kept, because
    later = (None if kept or seen.fate in STEADY
             else delayed(scenario, torque, axis, wheel.momentum, seen.time))
    return WheelAnswer(wheel.name, *told, *(later or ()))
