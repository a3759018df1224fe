"""The motion of a case with all that limits it: how far an approximate law holds along its own run, when it
reaches the limit of its case, what a tilt of its torque does."""
from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from ...case.read import Case
from ...case.sections import vertical_of
from ...orbit.result import Motion, Needs
from ...physics.coefficients import limits_of
from ...reasons import Sentence, Time
from ..caveats import limited, misaligned
from ..motion import motion, with_ending

if TYPE_CHECKING:
    from ...physics.law_limits import Validity

FASTEST = 1e100  # of a rate: beyond it, and below its inverse, squares of squares are no doubles
ALONG_FIRST = Sentence("law-along-first", "along the first {time} of the run")
MAX_TURN = 1e5  # rad of turn along which a law beside other answers is judged: seconds


def motion_of_case(case: Case, needs: Needs = Needs.ALL, follow: float | None = None,
                   tell: Callable[..., Any] | None = None, proof: bool = False) -> Motion:
    """All that is known of the motion of a case from its own start, exactly as it was written; needs,
    follow, tell, proof: as of `answers.motion`."""
    return motion(case.scene, case.start, case.span, needs, case.exact_state, follow, tell, proof)


def law_of(case: Case, span: Any = None, brief: bool = False) -> Any:
    """How far the law of a case's own motion holds over a span, its own where None is given (15 units of time
    without one), at rest where it has none; None where all laws are exact, or, if brief, where more than a
    few power series were needed. Of a motion of very many turns it is that of the first ones, as `over` says.
    """
    limits = limits_of(case.scene)
    if limits is None:
        return None
    if case.state is None:
        return limits.validity(case.scene, (0.0,) * 3, "at rest")
    span = span or case.span or (0.0, 15.0)
    if "attitude" in case.blocks:
        from ...integrate.limits_along import law_along
        result = law_along(case.scene, case.state, vertical_of(*case.blocks["attitude"]), span)
        if result is not None:
            return result
    if brief:
        return None
    from ..simulate import simulated
    spin, longest = math.hypot(*case.state), max(map(abs, span))
    if spin * longest <= MAX_TURN:
        return simulated(case.scene, case.state, span, case.blocks).validity
    first = tuple(t * MAX_TURN / (spin * longest) for t in span)
    result = simulated(case.scene, case.state, first, case.blocks).validity
    over = ALONG_FIRST(time=Time(MAX_TURN / spin, digits=2))
    return result and replace(result, over=over, also=tuple(replace(item, over=over) for item in result.also))


def law_is_open(case: Case, validity: Validity | None) -> bool:
    """Whether a law is judged by the attitude along the run, which the case gives."""
    return validity is not None and validity.holds is None and "attitude" in case.blocks


def judged(case: Case, motion: Motion | None, brief: bool = False) -> Motion | None:
    """The motion with its law judged along the case's own run, where that needs the attitude and the case
    gives one, and with the caveats of the case. brief: of `law_of`, and without the time to the limit of the
    case."""
    if motion is None:
        return motion
    result = law_of(case, brief=brief) if law_is_open(case, motion.validity) else None
    motion = limited(motion if result is None else replace(motion, validity=result), case.scene, case)
    motion = motion if brief else with_ending(case, motion)
    if case.limits is None or brief:
        return motion
    from ..when import with_first
    return with_first(case, motion)


def with_its_tilt(case: Case, motion: Motion, angle: float | None = None) -> Motion:
    """The motion with what a tilt of its torque does, where an angle (rad) is given or the case states a
    misalignment or a limit: a second of work; else as it is."""
    if angle is None and case.limits is None and not misaligned(case):
        return motion
    from ..when import with_tilt
    return with_tilt(case, motion, angle)
