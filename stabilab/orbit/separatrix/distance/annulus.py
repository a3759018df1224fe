"""Which saddles of circles have loops that come near a state: those about as far from the centre as the state is.

On a circle X^2 + Z^2 is the saddle's all along the loop, and the distance of two places is at least sqrt(min(a, b)) times that of
their circles. Far from the centre that leaves a branch of saddles in a few pieces, a share `upper`/radius of its length each; a search
over all of it would halve its way there once for every part of the loop. The difference of the squares is told from the state's
place, so it keeps its digits where both are huge.
"""
from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from .curves import ROUNDING

WIDEST = 1e14  # radii, in distances: doubles do not tell the angles of the other barriers of a wider circle well enough


def within(seen: Any, curve: Any, low: float, high: float, upper: float) -> list[tuple[float, float]]:
    """The pieces (from, to) of a branch over [low, high] that hold all its saddles with loops within `upper` of the state, in rising order."""
    g = seen.plain
    wide, radius = upper * (1 + 1e-9) / math.sqrt(min(g["a"], g["b"])), math.hypot(g["X"], g["Z"])
    if wide >= radius:
        return [(low, high)]
    if radius > WIDEST * wide:
        raise OverflowError
    pieces: list[tuple[float, float]] = []
    for start, end in _pieces(curve, (g["X"], g["Z"]), 0.5 * (low + high), 0.5 * (high - low), (radius, wide)):
        if pieces and start <= pieces[-1][1]:
            pieces[-1] = pieces[-1][0], end
        else:
            pieces.append((start, end))
    return [(max(start, low), min(end, high)) for start, end in pieces]


def _pieces(curve: Any, place: tuple[float, float], t: float, dt: float, band: tuple[float, float]) -> Iterator[tuple[float, float]]:
    """Those of [t - dt, t + dt], halved until they are no longer than the band is wide, or doubles tell no more."""
    radius, wide = band
    middle, reach, rounding = _beyond(curve, place, t, dt)
    if middle - reach > wide * (2 * radius + wide) or middle + reach < -wide * (2 * radius - wide):
        return
    if not math.isfinite(reach):
        raise OverflowError
    if reach <= radius * wide + 2 * rounding or t - 0.5 * dt == t:
        yield t - dt * (1 + 1e-15) - 1e-16 * abs(t), t + dt * (1 + 1e-15) + 1e-16 * abs(t)
        return
    for side in (-0.5, 0.5):
        yield from _pieces(curve, place, t + side * dt, 0.5 * dt, band)


def _beyond(curve: Any, place: tuple[float, float], t: float, dt: float) -> tuple[float, float, float]:
    """(middle, radius) of |saddle|^2 less the state's |place|^2 over [t - dt, t + dt], and the part of the radius that is rounding."""
    x1, rx1, z1, rz1, _, _, _, _, u, v, su, sv = curve.over(t, dt)[4:]  # the slopes, as the places' own radii hold the rounding of all of a place
    middle, reach, rounding = 0.0, 0.0, 0.0
    for apart, r, size, at in ((u, (abs(x1) + rx1) * dt, su, place[0]), (v, (abs(z1) + rz1) * dt, sv, place[1])):
        lost = ROUNDING * size
        middle += apart * (apart + 2 * at)
        reach += (r + lost) * (2 * abs(apart + at) + r + lost)
        rounding += lost * (2 * abs(apart + at) + lost) + ROUNDING * abs(apart) * (abs(apart) + 2 * abs(at))
    return middle, reach + rounding, rounding
