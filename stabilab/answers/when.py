"""When the motion of a case reaches a limit, stated as on a command line ("30 deg/s", "z = 30 deg/s"), and
what a tilt of its torque makes of that."""
from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction
from typing import Any

from ..case.limit_options import StatedLimit, stated_limit
from ..errors import InputError
from ..numbers.units import NONE, TIME, in_si
from ..orbit.result import Motion
from ..physics.scene import torque_axis
from ..physics.states import start_of
from .caveats import STEADY, caveats_of, limited, misaligned, stated
from .events import Crossings, crossings
from .kinds import kind_of
from .passage.enclosed import WORK
from .passage.limit import asked
from .passage.run import TimeTo
from .tilt import Spread, Tilt, cone_of, spread, tilt
from .time_to import time_of_case, time_to

FASTEST = 1e150  # rad/s: beyond it squares come near the end of doubles, and no run holds the motion


def when(case: Any, states: Any = None, rate: Any = None, component: Any = None, energy: Any = None,
         tilt: Any = None, until: Any = None, events: Any = None) -> TimeTo | Crossings:
    """The first time at which the motion of a case reaches a limit, or that it never does.

    One limit: rate="30 deg/s", of |omega|; component="z = 30 deg/s", or ("z", "30 deg/s"), of the size of the
    rate about x, y, z of the file or 1, 2, 3, the principal axes; energy="5 J", kinetic; tilt="z = 20 deg",
    of the angle between a body axis and its direction at the start; where none is given, that of [limits].
    Numbers are in SI units. until: the time at which the search ends. states: other starts (..., 3) than the
    case's own, in its variables. events: in place of a limit, the name of a component ("omega3"), a function
    of the time and the state, or several of these, whose zeros up to `until` (or the end of the case's span)
    are found: see `stabilab.answers.events`. Raises InputError for a limit that is none, and as `time_to`
    does.
    """
    if events is not None:
        given = any(one is not None for one in (rate, component, energy, tilt))
        return _crossings(case, states, events, until, given)
    limit = limit_stated(case, rate, component, energy, tilt, until)
    if states is None:
        return limited_time(case, limit.ask, limit.until)
    return time_to(case.scene, states, **limit.ask, t_max=limit.until)


def limit_stated(case: Any, rate: Any = None, component: Any = None, energy: Any = None, tilt: Any = None,
                 until: Any = None) -> StatedLimit:
    """The limit that these arguments of `when` state."""
    return stated_limit(case, *map(_text, (rate, component, energy, tilt, until)))


def _crossings(case: Any, state: Any, events: Any, until: Any, limited: bool) -> Crossings:
    if limited:
        raise InputError("when: expected a limit or events, got both: ask for each by itself")
    if until is None and case.span is None:
        raise InputError("when: events need until, the time at which the search ends: the case has no span")
    unit = NONE if case.variables == "scaled" else TIME
    end = float(case.span[1] if until is None else in_si(until, unit, "until"))
    if not end > 0:
        raise InputError(f"until: expected a time above 0, got {end:.6g}")
    if state is None and case.state is None:
        raise InputError(f"{case.place}: motion: no angular_velocity or x; when needs a start")
    start = state if state is not None else (
        case.state if case.variables == "scaled" else start_of(case.scene, case.state, case.blocks))
    return crossings(case.scene, start, end, events)


def _text(given: Any) -> str | None:
    """As a command line has it."""
    if given is None or isinstance(given, str):
        return given
    return " = ".join(map(str, given)) if isinstance(given, (tuple, list)) else str(given)


def limited_time(case: Any, ask: dict[str, Any], t_max: float | Fraction | None = None) -> TimeTo:
    """As `time_of_case`; where it is never, with what a tilt of the torque does, by what the case states as
    misalignment, else by one degree."""
    found = time_of_case(case, ask, t_max)
    never = math.isinf(found.low)
    return replace(found,
                   caveats=caveats_of(case.scene, never, of_tilt(case, None, ask, never), file=case.caveats))


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
    found = of_tilt(case, angle, limit_of(case), motion.fate in STEADY)
    return limited(replace(motion, tilt=found), case.scene, case)


def limit_of(case: Any) -> dict[str, Any] | None:
    """The limit of a case as `time_to` takes it."""
    limits = case.limits
    if limits is None:
        return None
    return {"rate": limits.rate} if limits.rate is not None else {"component": limits.components(case.frame)}


def of_tilt(case: Any, angle: float | None, ask: dict[str, Any] | None, steady: bool) -> Tilt | Spread | None:
    """What the torques of the cone do: to a steady motion under one on an axis always, else where a tilt is
    asked for or stated; why not, where it is not looked at."""
    loose = angle is not None or bool(misaligned(case))
    on_axis = (steady and case.variables != "scaled" and bool(torque_axis(case.scene))
               and kind_of(case.scene) == "orbit")
    if not loose and not on_axis:
        return None
    plain = case.variables != "scaled" and case.scene.plain
    why = ("in scaled variables" if case.variables == "scaled"
           else "with other effects than wheel and torque" if not plain else
           "with rates whose squares are no doubles" if _too_fast(case, ask) else "" if on_axis else
           "for the angle of an axis" if ask and "tilt" in ask
           else "" if any(case.scene.vector("constant_torque")) else "without a torque")
    if why:
        return Spread(angle or 0.0, "the torque", 0, because=why) if loose else None
    if on_axis:
        return tilt(case.scene, case.state, angle, None, case, case.exact_state, ask)
    return spread(case.scene, case.state, cone_of(case.scene, case, angle), ask, case.exact_state)


def _too_fast(case: Any, ask: dict[str, Any] | None) -> bool:
    limit = None if ask is None or "tilt" in ask else asked(case.scene, **ask).least_rate()
    return max(*map(abs, case.state), limit or 0.0) > FASTEST
