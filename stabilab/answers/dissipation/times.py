"""A time that two runs agree on."""
from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Time:
    """A time, s, known to `error`, s: what a second run from a start moved in its last places, with a coarser
    tolerance, differs by."""

    at: float
    error: float
