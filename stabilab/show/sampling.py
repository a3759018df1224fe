"""Where on a curve of equilibria to look."""
from __future__ import annotations

import numpy as np


def spread(low: float, high: float, number: int) -> np.ndarray:
    """Parameters inside (low, high), dense at both ends, geometric towards an infinite end and towards zero.
    """
    if np.isfinite(low) and np.isfinite(high):
        return low + (high - low) * (1 - np.cos(np.linspace(1e-3, np.pi - 1e-3, number))) / 2
    if np.isfinite(low):
        return low + np.geomspace(1e-4, 1e4, number) * max(1.0, abs(low))
    if np.isfinite(high):
        return high - np.geomspace(1e-4, 1e4, number)[::-1] * max(1.0, abs(high))
    half = np.geomspace(1e-4, 1e4, number // 2)
    return np.concatenate([-half[::-1], half])
