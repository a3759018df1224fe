"""Margins of rows on hyperbolas against the barrier that is nearest in height, from equilibria in twofold numbers."""
from __future__ import annotations

import numpy as np

from ..landscape import ROUNDINGS, Landscape
from .spots import fine_spots

MARGIN_SHARE = 5e-13  # of the kinetic energy and the barrier's height: half of the rounding that `fate` admits


def valley_margins(land: Landscape, states):
    """(margins (n,), +inf without a barrier; which of them are certain (n,)) of states (n, 3) on hyperbolas, in canonical units."""
    found = fine_spots(land, states)
    spots, energy, rows = found.spots, 0.5 * found.w**2, np.arange(len(states))
    height = np.where(spots.there & spots.barrier, -spots.energy, np.inf)
    if not height.shape[1]:
        return np.full(len(states), np.inf), found.sure
    nearest = np.argmin(np.abs(height), axis=1)
    margins, error = height[rows, nearest], found.error[rows, nearest]
    with np.errstate(invalid="ignore"):
        clear = (np.abs(margins) > ROUNDINGS * error) & (error <= MARGIN_SHARE * (np.abs(margins + energy) + energy))
    return margins, found.sure & (clear | np.isposinf(margins))
