"""When the motion of a case reaches a limit, stated as on a command line: "30 deg/s", "z = 30 deg/s"."""
from __future__ import annotations

from typing import Any

from ..case.limit_options import StatedLimit, stated_limit
from ..errors import InputError
from ..numbers.units import NONE, TIME, in_si
from ..physics.states import start_of
from .events import Crossings, crossings
from .passage.of_case import limited_time
from .passage.run import TimeTo
from .time_to import time_to


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
