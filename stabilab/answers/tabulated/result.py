"""A motion in many digits and how well each of them is known."""
from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any

PROVED, TWICE = "proved", "two precisions agree"


@dataclass(frozen=True)
class Event:
    """A zero, a least or a greatest value of a rate: kind "zero", "least" or "greatest", of which component
    (0 to 2), time and value as balls."""

    kind: str
    component: int
    t: Any
    value: Any


@dataclass(frozen=True)
class Tabulated:
    """States (balls) at times, each within 10^-digits of the largest rate (or of the largest number of its
    kind), as `level` says: PROVED or TWICE.

    t: the times that were reached, of all that were asked for where `reached`; because: how, or why the run
    ended. events: in order of time, those after the start; events_because: how they were found, or what is
    left out.
    """

    t: tuple[Fraction, ...]
    states: tuple[tuple[Any, ...], ...]
    components: tuple[str, ...]
    digits: int
    level: str
    because: str
    reached: bool
    events: tuple[Event, ...]
    events_because: str
