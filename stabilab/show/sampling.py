"""Where on a curve of equilibria to look."""
from __future__ import annotations

import math


def spread(low: float, high: float, number: int) -> list[float]:
    """Parameters inside (low, high), dense at both ends, geometric towards an infinite end; towards two of
    them so many on each side of zero."""
    if math.isfinite(low) and math.isfinite(high):
        return [low + (high - low) * (1 - math.cos(1e-3 + (math.pi - 2e-3) * n / (number - 1))) / 2
                for n in range(number)]
    away = [10 ** (-4 + 8 * n / (number - 1)) for n in range(number)]
    if math.isfinite(low):
        return [low + v * max(1.0, abs(low)) for v in away]
    if math.isfinite(high):
        return [high - v * max(1.0, abs(high)) for v in reversed(away)]
    return [*(-v for v in reversed(away)), *away]
