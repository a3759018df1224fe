"""Margins of rows on parabolas in twofold numbers: a height that is small beside the terms of its quartic keeps its digits."""
from __future__ import annotations

from fractions import Fraction
from functools import lru_cache
from types import SimpleNamespace

import numpy as np

from ...numbers.constants import EPS
from ...numbers.double_double import Twofold
from ..landscape import Landscape
from ..potential import derivatives_on_parabola
from .places import twofold_constant
from .spots import TWOFOLD

ROUNDED = 64  # roundings of a height, by the size of its terms: some thirty sums and products
FORCE = 16  # roundings of a force in doubles, by the size of its terms
THIRD = twofold_constant(Fraction(1, 3))
NAMES = "p", "p0", "q", "q0", "kappa", "rho", "sigma", "m", "s"


@lru_cache(maxsize=64)
def constants(reduction) -> SimpleNamespace:
    """Those of a reduction to parabolas as twofold numbers, of the same names."""
    return SimpleNamespace(**{name: twofold_constant(getattr(reduction, name)) for name in NAMES})


def parabola_margins(land: Landscape, states, critical):
    """(margins (n,), +inf without a barrier; kinetic energies; errors; where it is certain which equilibria there are) of states (n, 3) on parabolas;
    critical: as of `valley_margins`.

    The potential is stationary at the barrier, so the double of the way to it serves: what it leaves open is of second order. A force that is a
    cubic with walls on both sides has one barrier at most.
    """
    r, pot, none = constants(land.reduction), land.potential, np.zeros(len(states))
    place, w, _ = land.start(states)
    with np.errstate(all="ignore"):
        offsets, _, barrier = critical
        there = barrier.any(axis=1)
        y = offsets[np.arange(len(states)), np.argmax(barrier, axis=1)]
        u, v, speed = Twofold(place[0], none), Twofold(place[1], none), r.s + states[:, land.reduction.axis]
        force = r.kappa * u * v + r.rho * v + r.sigma * u + r.m
        first, second, third = derivatives_on_parabola(r, u, v)
        height = -(((third * THIRD * 0.125 * y + second * THIRD * 0.5) * y + first * 0.5) * y + force) * y
        margins = (height - speed * speed * 0.5).value()
        sizes = pot.terms(place), *pot.derivative_terms(place)
        size, blur, left_over, slope = (_sum(f, np.abs(y) if f is sizes else y, over) for f, over in (
            (sizes, (1, 2, 6, 24)), (sizes, (1, 1, 2, 6)), ((pot.force(place), *pot.derivatives(place)), (1, 1, 2, 6)),
            (pot.derivatives(place), (1, 1, 2))))
        error = ROUNDED * TWOFOLD * (np.abs(y) * size + w * w) + (np.abs(left_over) + FORCE * EPS * blur) ** 2 / slope
    sure = ~land.beside_fold(place) & ((slope > 0) | ~there)  # type: ignore[attr-defined]  # of hyperbolas and parabolas
    return np.where(there, margins, np.inf), 0.5 * w * w, np.where(there, error, 0.0), sure


def _sum(terms, y, over):
    """The polynomial in y whose coefficients are terms, lowest power first, over these numbers."""
    value = 0.0
    for term, number in zip(reversed(terms), reversed(over)):
        value = value * y + term / number
    return value
