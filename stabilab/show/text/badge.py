"""A motion on a card: what becomes of it in two or three words, and its answer in one short line."""
from __future__ import annotations

from typing import TYPE_CHECKING

from ...errors import Kind
from ...orbit.result import OUTCOMES, Fate
from . import headline

if TYPE_CHECKING:
    from ...orbit.result import Motion

LINE = 90  # letters of the line


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


def line(answer: str) -> str:
    """Of an answer as many clauses as a card has room for, at least the first."""
    first, *others = (answer.partition(headline.BY_LAW)[2] or answer).split("; ")
    for clause in others:
        if len(first) + len(clause) + 2 > LINE:
            break
        first += f"; {clause}"
    return first
