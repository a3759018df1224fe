"""What becomes of a motion in two or three words, for the card of its case."""
from __future__ import annotations

from typing import TYPE_CHECKING

from ...errors import Kind
from ...orbit.result import OUTCOMES, Fate
from . import headline

if TYPE_CHECKING:
    from ...orbit.result import Motion


def badge(motion: Motion | None, undecided: bool = False) -> str:
    """What becomes of a motion, with what its look (`headline.look`) adds to the fate; empty where there is
    none. undecided: whether uncertain numbers leave the fate open."""
    if motion is None:
        return ""
    fate, kinds = OUTCOMES[motion.fate].legend, {caveat.kind for caveat in motion.caveats}
    if motion.fate is Fate.UNDECIDED:
        return fate
    if undecided:
        return f"{fate}, uncertain"
    if headline.beyond(motion.validity):
        return f"{fate}, beyond its law"
    if motion.fate in (Fate.SPIN_UP, Fate.SEPARATRIX):
        return fate
    if motion.ending is not None and motion.ending.kind == "flat spin":
        return "to a flat spin"
    if Kind.LIMIT in kinds:
        return f"{fate}, reaches its limit"
    if Kind.UNSTABLE in kinds:
        return f"{fate}, unstable"
    return f"{fate} on a condition" if Kind.TILT in kinds else fate
