"""When the motion of a case reaches a limit, with what limits the answer: a limit of its own that comes
first, and a tilt of the torque."""
from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction
from typing import Any

from ...orbit.result import Motion
from ...physics.scene import torque_axis
from ..caveats import STEADY, caveats_of, limited, misaligned, stated
from ..kinds import kind_of
from ..tilt import Spread, Tilt, cone_of, spread, tilt
from ..time_to import time_of_case
from .enclosed import WORK
from .limit import asked
from .run import TimeTo

FASTEST = 1e150  # rad/s: beyond it squares come near the end of doubles, and no run holds the motion


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
    loose, on_axis = angle is not None or bool(misaligned(case)), steady and _on_axis(case.scene)
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


def _on_axis(scene: Any) -> bool:
    return bool(scene.variables != "scaled" and torque_axis(scene) and kind_of(scene) == "orbit")
