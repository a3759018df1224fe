"""The first crossing with the motion enclosed by compiled steps, for ways too long for integers: rates along principal axes alone."""
from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any

from ...numbers.numba_door import installed
from ...numbers.vectors import Number
from ...physics.scene import AnyScene
from ...unreduced.enclosure.bands import Crossing, first_crossing
from .limit import Limit

STEPS = 60_000  # validated ones; some two seconds


def banded(scene: AnyScene, start: Sequence[Number], limit: Limit, t_max: float, steps: int = STEPS) -> Crossing | None:
    """low and high of the first crossing (high inf where none is found before low) of the motion from three rationals; None where numba is not there
    to compile the steps, or the limit is of another kind."""
    if limit.kind == "tilt" or not installed() or any(not _weights(terms) for terms, _ in limit.parts):
        return None
    found = [first_crossing(scene, start, math.sqrt(most), _weights(terms), t_max=t_max, steps=steps) for terms, most in limit.parts]
    first = min(found, key=lambda one: one.low)
    return Crossing(first.low, min(one.high for one in found), first.because, sum(one.steps for one in found))


def _weights(terms: Iterable[Any]) -> list[float] | None:
    """Three weights of the squares of the rates; None where a direction is not a principal axis."""
    weights = [0.0, 0.0, 0.0]
    for c, vector in terms:
        entries = [n for n, v in enumerate(vector) if v]
        if len(entries) != 1 or abs(vector[entries[0]]) != 1:
            return None
        weights[entries[0]] += float(c)
    return weights
