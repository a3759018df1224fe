"""When the motion of a case reaches a limit, with what limits the answer: a limit of its own that comes first, and a tilt of the torque."""
from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction
from typing import Any

from ...orbit.result import Motion
from ...physics.alignment import torque_axis
from ..caveats import STEADY, caveats_of, limited, stated
from ..kinds import kind_of
from ..tilt import tilt
from ..time_to import time_of_case
from .enclosed import WORK
from .result import TimeTo


def limited_time(case: Any, ask: dict[str, Any], t_max: float | Fraction | None = None) -> TimeTo:
    """As `time_of_case`; where it is never, with what a tilt of the torque does, by what the case states as misalignment, else by one degree."""
    found = time_of_case(case, ask, t_max)
    never = math.isinf(found.low)
    off = tilt(case.scene, case.state, None, case=case, exact=case.exact_state, ask=ask) if never and _on_axis(case.scene) else None
    return replace(found, caveats=caveats_of(case.scene, never, off, file=case.caveats))


def with_first(case: Any, motion: Motion, work: int = WORK) -> Motion:
    """The motion with the time at which it reaches the limit of its case, where that states one. work: as of `time_to`."""
    if case.limits is None or motion.first is not None:
        return motion
    ask = {"rate": case.limits.rate} if case.limits.rate is not None else {"component": case.limits.components(case.frame)}
    return limited(replace(motion, first=(stated(case.limits), time_of_case(case, ask, work=work))), case.scene, case)


def with_tilt(case: Any, motion: Motion, angle: float | None = None) -> Motion:
    """The motion of a case with what a tilt of its torque does to it. angle: rad; None: what its stuck thrusters state, else one degree."""
    if motion.fate not in STEADY or not _on_axis(case.scene):
        return motion
    return limited(replace(motion, tilt=tilt(case.scene, case.state, angle, None, case, case.exact_state)), case.scene, case)


def _on_axis(scene: Any) -> bool:
    return bool(scene.variables != "scaled" and torque_axis(scene) and kind_of(scene) == "orbit")
