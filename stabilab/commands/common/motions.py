"""The motion of a case, with what a tilt of its torque and uncertain numbers do to it."""
from __future__ import annotations

from dataclasses import replace

from ...answers.motion import motion
from ...case.read import blamed_on
from ...errors import printable
from ...show.text import law
from ...streams import Progress
from .cases import time_asked


def motion_of(case, brief=False, follow=None, proof=False):
    """The motion of a case. follow: how long one that only a run decides is followed, as typed; proof: its
    way is enclosed."""
    long = time_asked(follow, case)
    with blamed_on(case), Progress() as progress:
        words = lambda t, steps, left: progress(
            f"{printable(case.name)}: followed to {t:.4g} {case.scene.time_unit}, {steps} steps")
        found = motion(case.scene, case.start, case.span, brief, case.exact_state, long,
                       words if progress.wanted else None, proof)
        return law.judged(case, found)


def tilted(case, motion, angle: str | None):
    """The motion with what a tilt of its torque does, where that is asked for or the case states what it
    takes: a second of work otherwise saved."""
    stated = (case.limits is not None
              or any(thruster.stuck and thruster.misalignment for thruster in case.thrusters))
    if angle is None and not stated:
        return motion
    from .tilt import with_angle
    return with_angle(case, motion, angle)


def sampled(motion, box):
    """The motion with what uncertain numbers do to it by samples, not by proof, as a caveat."""
    return (motion if motion is None or box is None
            else replace(motion, caveats=(*motion.caveats, *box.caveats)))


def over_boxes(cases, *questions):
    """What uncertain numbers do to the verdicts of each case; None where it has none."""
    if not questions or not any(case.uncertain for case in cases):
        return [None] * len(cases)
    from ...answers.uncertain.verdicts import uncertain
    return [uncertain(case, questions) for case in cases]
