"""The verdicts over a box of uncertain numbers as sentences; without NumPy, so that a text may have them."""
from __future__ import annotations

from collections.abc import Iterable
from functools import reduce

from ...reasons import Axis, Reason, Sentence, as_reason

SPINS_UP = Sentence("spin-up-about", "spin-up about {axis}, {direction} direction")
SPIN_UPS = {(n, sense): SPINS_UP(axis=Axis(n), direction="positive" if sense > 0 else "negative")
            for n in (1, 2, 3) for sense in (1, -1)}
VERDICTS = {str(item): item for item in SPIN_UPS.values()}  # those that name an axis
ALSO_ANOTHER = Sentence("also-another", "also another answer")()


def reason_of(verdict: str | None) -> Reason:
    """A verdict as what fills a hole of a sentence: with its axis, where it names one."""
    return VERDICTS.get(verdict or "") or as_reason(str(verdict))


def joined(reasons: Iterable[Reason], joint: str) -> Reason:
    """Several as one, each behind the joint."""
    return reduce(lambda reason, other: reason.then(other, joint), reasons)
