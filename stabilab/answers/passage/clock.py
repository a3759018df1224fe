"""Times far beyond any run, from the certificate of spin-up: its clock for the spin, its bounds for the rates
across it."""
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

# the certificate is asked for again at these shares of the earliest time, where it is narrower
LATER = (0.5, 0.97)
LITTLE = 100_000  # steps that this may take: slow drifts pass many turns in few


def by_clock(scene: AnyScene, state: Float3, limit: Limit, followed: float, reached: float,
             found: Any = None) -> Found | None:
    """Bounds of the first crossing of a motion whose spin-up is certified; None where none is, or where the
    limit is not of a rate along it.

    followed: a time before which the limit is known not to be reached. The bounds of the trap hold from its
    own time on; where that is later than `followed` the lower end stays there. reached: how far a run came.
    found: what `spin_up` says of the motion, where it was asked already.
    """
    if not _along_axes(limit):
        return None
    found = found or spin_up(scene, state)
    if found.fate != Fate.SPIN_UP or not found.axis or found.trap is None:
        return None
    times = _times(found, limit)
    if times is None:
        return None
    sure = found.t <= followed or found.level == "exact"
    if found.level == "certified" and times[0] > found.t:
        found, times = _narrower(scene, state, limit, found, times, reached)
    low = max(followed, times[0]) if sure else followed
    words = (
        f"{limit.words}: by the clock of the spin-up about axis {found.axis}, {found.level} from t = "
        f"{found.t:.6g} {scene.time_unit} on")
    return Found(low, max(times[1], low), found.level, words)


def _along_axes(limit: Limit) -> bool:
    return (limit.kind != "tilt" and all(_axis(vector) is not None for terms, _ in limit.parts for _,
                                         vector in terms))


def _narrower(scene: AnyScene, state: Float3, limit: Limit, found: Any, times: Any, reached: float) -> Any:
    """(what is found, times) by certificates later on the way: as late as little work reaches, else as far as
    a run came. Each is met before the earliest time that the one before it gives."""
    for share in LATER:
        again = spin_up(scene, state, after=share * times[0], budget=LITTLE)
        if again.fate != Fate.SPIN_UP and share == LATER[0]:
            again = spin_up(scene, state, after=min(share * times[0], max(reached, found.t)))
        if again.fate != Fate.SPIN_UP or again.t > times[0] or not (narrower := _times(again, limit)):
            # bounds that hold from a time on at which the limit may have been reached say nothing of the
            # first
            break
        found, times = again, (max(times[0], narrower[0]), min(times[1], narrower[1]))
    return found, times


def _times(found: Any, limit: Limit) -> Any:
    """(earliest, latest) of all parts, or None where none of them grows with the spin."""
    bounds, spin, times = found.trap.bounds(), found.axis - 1, []
    for terms, most in limit.parts:
        weights = [0.0, 0.0, 0.0]
        for c, vector in terms:
            weights[cast(int, _axis(vector))] += float(c)  # each is along an axis: asked above
        across = sum(c * max(abs(low), abs(high)) ** 2 for n,
                     (c, (low, high)) in enumerate(zip(weights, bounds)) if n != spin and c)
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
