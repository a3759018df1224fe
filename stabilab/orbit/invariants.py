"""The two invariants of one orbit: its squared radius and its energy."""
from __future__ import annotations

from ..numbers.balls import DOUBLE_BITS
from .ball_orbit import Orbit


def invariants_of(orbit: Orbit) -> dict[str, float]:
    """Q (the squared radius of the circle, or Z^2 - X^2 on a hyperbola) in canonical units, and the energy W^2/2 + V in
    the scene's, with the turn angle counted from the direction X = 0; nothing on a parabola."""
    return orbit.settled(lambda found: found.invariants(), DOUBLE_BITS)
