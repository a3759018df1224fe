"""Margins of rows on hyperbolas and parabolas against the barrier that is nearest in height, in twofold numbers."""
from __future__ import annotations

import numpy as np

from ..extremes.turning_points import Spots
from ..landscape import ROUNDINGS, Landscape
from .parabolas import parabola_margins
from .spots import fine_spots

MARGIN_SHARE = 5e-13  # of the kinetic energy and the barrier's height: half of the rounding that `fate` admits


def valley_margins(land: Landscape, states, critical=None):
    """(margins (n,), +inf without a barrier; which of them are certain (n,)) of states (n, 3) on hyperbolas or parabolas, in canonical units.

    critical: what `land.critical` says of the barriers along their orbits, where it is known already.
    """
    critical = land.critical(land.start(states)[0], barriers_only=True) if critical is None else critical
    margins, energy, error, sure = (parabola_margins if land.conic is None else _on_hyperbolas)(land, states, critical)
    with np.errstate(invalid="ignore"):
        clear = (np.abs(margins) > ROUNDINGS * error) & (error <= MARGIN_SHARE * (np.abs(margins + energy) + energy))
    return margins, sure & (clear | np.isposinf(margins))


def _on_hyperbolas(land, states, critical):
    """(margins, kinetic energies, errors, where the equilibria are certain), (n,) each, from the barriers in twofold numbers: wells, of which an orbit
    has twice as many, play no part."""
    found = fine_spots(land, states, _barriers(*critical))
    spots, energy, rows = found.spots, 0.5 * found.w**2, np.arange(len(states))
    height = np.where(spots.there, -spots.energy, np.inf)
    if not height.shape[1]:
        return np.full(len(states), np.inf), energy, np.zeros(len(states)), found.sure
    nearest = np.argmin(np.abs(height), axis=1)
    return height[rows, nearest], energy, found.error[rows, nearest], found.sure


def _barriers(offsets, places, barrier):
    """The barriers as `Spots`, in as few columns as hold them; their energies are not known yet."""
    order = np.argsort(~barrier, axis=1, kind="stable")[:, :int(barrier.sum(axis=1).max(initial=0))]
    there, offset, x, z = (np.take_along_axis(v, order, axis=1) for v in (barrier, np.where(barrier, offsets, np.inf), *places))
    order = np.argsort(offset, axis=1, kind="stable") if offset.shape[1] > 1 else np.zeros(offset.shape, int)
    there, offset, x, z = (np.take_along_axis(v, order, axis=1) for v in (there, offset, x, z))
    return Spots(offset, np.array([x, z]), np.full(offset.shape, np.nan), there, there)
