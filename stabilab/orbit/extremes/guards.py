"""Which rows of an array doubles cannot answer, and must go to many digits."""
from __future__ import annotations

import numpy as np

from ..landscape import Landscape
from ..result import Fate

EXTREMES_SHARE = 1e-7  # closer to the separatrix than this share of the energy terms, rounding costs extremes 1e-12
SPIN_UP_SHARE = 1e-4  # the same for the least rate of a motion that just passes a barrier: the root of a difference
DIGITS = 1e-12  # rounding that leaves less than this goes to ball arithmetic
ON_TOP = 1e-13  # of the terms of the force, some hundreds of roundings
SHIFT_LIMIT = 1e4  # canonical variables lose this factor of accuracy to the shift before the precise path takes over


def trapped_rows(land, decided):
    """(n,) True for motions between two turning points."""
    trapped = decided.labels == Fate.BOUNDED
    return trapped & (decided.margins >= 0) if land.may_rotate else trapped


def needs_digits(land: Landscape, states):
    """(n,) True where the canonical shift is so large that doubles would lose digits (nearly equal moments, or a wheel on the
    axis of symmetry of a body that hardly turns about it)."""
    r = land.reduction
    shift, along = r.parabolic_shift_size, abs(float(r.s))
    lost = np.zeros(len(states), bool)
    if shift:
        lost |= shift > SHIFT_LIMIT * np.maximum(np.abs(states).max(axis=1), 1e-300)
    return lost | (along > SHIFT_LIMIT * np.abs(states[:, r.axis])) if along else lost


def on_top(land: Landscape, place):
    """(n,) True where the state is at the place of a barrier to rounding: before it or behind, doubles do not tell."""
    pot = land.potential
    return (np.abs(pot.force(place)) <= ON_TOP * pot.terms(place)) & (pot.slope(place) > 0)


def near_separatrix(land, place, w, decided, share):
    """(n,) True where the margin is below `share` of the energy's terms: turning points and periods magnify the
    margin's rounding there, so ball arithmetic takes over."""
    return np.abs(decided.margins) <= share * land.reduction.energy_unit * land.energy_terms(place, w)


def clear_of_barriers(land, place, w, span, share):
    """(n,) False where the energy of a motion between turning points is so near a barrier's, the highest or not."""
    return span.closest > share * land.energy_terms(place, w)


def picked(place, w, mask):
    return tuple(v[mask] for v in place), w[mask]


def into(out, mask, values):
    if mask.any():
        out[mask] = values
