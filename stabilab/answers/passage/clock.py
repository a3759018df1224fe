"""Times far beyond any run, from the certificate of spin-up: its clock for the spin, its bounds for the rates across it."""
from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, cast

from ...numbers.vectors import Float3, Number
from ...orbit.result import Fate
from ...physics.scene import AnyScene
from ...unreduced.spin_up.follow import spin_up
from .limit import Limit
from .result import Found

LATER = 0.5  # the certificate is asked for once more at this share of the earliest time, where it is narrower


def by_clock(scene: AnyScene, state: Float3, limit: Limit, followed: float) -> Found | None:
    """Bounds of the first crossing of a motion whose spin-up is certified; None where none is, or where the limit is not of a rate along it.

    followed: a time before which the limit is known not to be reached. The bounds of the trap hold from its own time on; where that is later than
    `followed` the lower end stays there.
    """
    if limit.kind == "tilt" or any(_axis(vector) is None for terms, _ in limit.parts for _, vector in terms):
        return None
    found = spin_up(scene, state)
    if found.fate != Fate.SPIN_UP or not found.axis or found.trap is None:
        return None
    times = _times(found, limit)
    if times is None:
        return None
    if found.level == "certified" and times[0] > found.t:
        again = spin_up(scene, state, after=min(LATER * times[0], max(followed, found.t)))
        if again.fate == Fate.SPIN_UP and (narrower := _times(again, limit)):
            found, times = again, (max(times[0], narrower[0]), min(times[1], narrower[1]))
    low = max(followed, times[0]) if found.t <= followed or found.level == "exact" else followed
    words = f"{limit.words}: by the clock of the spin-up about axis {found.axis}, {found.level} from t = {found.t:.6g} {scene.time_unit} on"
    return Found(low, max(times[1], low), found.level, words)


def _times(found: Any, limit: Limit) -> Any:
    """(earliest, latest) of all parts, or None where none of them grows with the spin."""
    bounds, spin, times = found.trap.bounds(), found.axis - 1, []
    for terms, most in limit.parts:
        weights = [0.0, 0.0, 0.0]
        for c, vector in terms:
            weights[cast(int, _axis(vector))] += float(c)  # each is along an axis: asked above
        across = sum(c * max(abs(low), abs(high)) ** 2 for n, (c, (low, high)) in enumerate(zip(weights, bounds)) if n != spin and c)
        if not weights[spin]:
            if across >= float(most):
                return None  # a rate across the spin may reach it at any time
            continue
        late = found.trap.clock(math.sqrt(float(most) / weights[spin]))[1]
        rest = float(most) - across
        early = found.trap.clock(math.sqrt(rest / weights[spin]))[0] if rest > 0 else 0.0
        times.append((early, late))
    return (min(t for t, _ in times), min(t for _, t in times)) if times else None


def _axis(vector: Sequence[Number]) -> int | None:
    entries = [n for n, v in enumerate(vector) if v]
    return entries[0] if len(entries) == 1 else None
