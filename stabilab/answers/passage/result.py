"""What is known of the first time at which a limit is reached."""
from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from ...caveat import Caveat
from ...physics.coefficients import limits_of
from ...shown import Compared, Shown

if TYPE_CHECKING:  # a scene of exact laws does not load it
    from ...physics.law_limits import Validity


@dataclass(frozen=True, repr=False, eq=False)
class TimeTo(Shown, Compared):
    """The first times (...,) at which states (..., 3) reach a limit, in the scene's time: each is between low
    and high.

    Both inf: never. high NaN: not known; then the limit is not reached before low. level (...,), texts:
    "exact" (a law, or all extremes), "proved" (the motion enclosed by a proof), "certified" (the theorem of
    spin-up, applied to a run of machine precision), "run" (roots along a run of machine precision, wider by
    what a second run shows), "undecided". words (...,): how it is known. quantity: what was asked, in words.
    caveats: what limits the answers (`answers.caveats`).
    """

    low: np.ndarray
    high: np.ndarray
    level: np.ndarray
    words: np.ndarray
    quantity: str = ""
    scene: Any = field(default=None, repr=False, compare=False)
    states: np.ndarray | None = field(default=None, repr=False, compare=False)
    caveats: tuple[Caveat, ...] = ()

    @cached_property
    def validity(self) -> Validity | None:
        """Of an approximate law (`stabilab.physics.law_limits`) at the start; None where all laws are exact.
        """
        limits = limits_of(self.scene)
        return limits.validity(self.scene, self.states) if limits else None

    def __iter__(self) -> Iterator[np.ndarray]:
        return iter((self.low, self.high))


@dataclass(frozen=True)
class Found:
    """The answer of one motion; fields as of `TimeTo`, plain numbers."""

    low: float
    high: float
    level: str
    words: str
