"""When the motion of a case reaches a limit, stated as on a command line: "30 deg/s", "z = 30 deg/s"."""
from __future__ import annotations

from typing import Any

from ..case.limit_options import stated_limit
from .passage.of_case import limited_time
from .passage.run import TimeTo
from .time_to import time_to


def when(case: Any, states: Any = None, rate: Any = None, component: Any = None, energy: Any = None,
         tilt: Any = None, until: Any = None) -> TimeTo:
    """The first time at which the motion of a case reaches a limit, or that it never does.

    One limit: rate="30 deg/s", of |omega|; component="z = 30 deg/s", or ("z", "30 deg/s"), of the size of the
    rate about x, y, z of the file or 1, 2, 3, the principal axes; energy="5 J", kinetic; tilt="z = 20 deg",
    of the angle between a body axis and its direction at the start; where none is given, that of [limits].
    Numbers are in SI units. until: the time at which the search ends. states: other starts (..., 3) than the
    case's own, in its variables. Raises InputError for a limit that is none, and as `time_to` does.
    """
    limit = stated_limit(case, *map(_text, (rate, component, energy, tilt, until)))
    if states is None:
        return limited_time(case, limit.ask, limit.until)
    return time_to(case.scene, states, **limit.ask, t_max=limit.until)


def _text(given: Any) -> str | None:
    """As a command line has it."""
    if given is None or isinstance(given, str):
        return given
    return " = ".join(map(str, given)) if isinstance(given, (tuple, list)) else str(given)
