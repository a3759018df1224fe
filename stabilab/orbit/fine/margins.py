"""Margins of rows on hyperbolas and parabolas against the barrier that is nearest in height, in twofold numbers."""
from __future__ import annotations

import numpy as np

from ..landscape import ROUNDINGS, Landscape
from .parabolas import parabola_margins
from .spots import fine_spots

MARGIN_SHARE = 5e-13  # of the kinetic energy and the barrier's height: half of the rounding that `fate` admits


def valley_margins(land: Landscape, states):
    """(margins (n,), +inf without a barrier; which of them are certain (n,)) of states (n, 3) on hyperbolas or parabolas, in canonical units."""
    margins, energy, error, sure = (parabola_margins if land.conic is None else _on_hyperbolas)(land, states)
    with np.errstate(invalid="ignore"):
        clear = (np.abs(margins) > ROUNDINGS * error) & (error <= MARGIN_SHARE * (np.abs(margins + energy) + energy))
    return margins, sure & (clear | np.isposinf(margins))


def _on_hyperbolas(land, states):
    """(margins, kinetic energies, errors, where the equilibria are certain), (n,) each, from equilibria in twofold numbers."""
    found = fine_spots(land, states)
    spots, energy, rows = found.spots, 0.5 * found.w**2, np.arange(len(states))
    height = np.where(spots.there & spots.barrier, -spots.energy, np.inf)
    if not height.shape[1]:
        return np.full(len(states), np.inf), energy, np.zeros(len(states)), found.sure
    nearest = np.argmin(np.abs(height), axis=1)
    return height[rows, nearest], energy, found.error[rows, nearest], found.sure
