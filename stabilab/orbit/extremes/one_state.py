"""The extremes of one state's motion, without arrays."""
from __future__ import annotations

from fractions import Fraction

from ..fate.one_state import as_double, scaled_double
from ..one_orbit import Orbit
from ..result import Fate
from .balls import extreme_balls


def extremes_of(orbit: Orbit, label: Fate, k: int = 0) -> tuple:
    """((least, greatest),) * 3 over t >= 0 in units 2^-k of the orbit's; +-inf where unbounded, NaN where
    larger than any double."""
    here = [as_double(Fraction(v) * Fraction(2) ** k) for v in orbit.state]
    if label == Fate.EQUILIBRIUM:
        return tuple((v, v) for v in here)
    balls = extreme_balls(orbit, label)
    # rounding must not exclude the state itself
    return tuple((min(scaled_double(low, k), v), max(scaled_double(high, k), v)) for (low, high),
                 v in zip(balls, here))
