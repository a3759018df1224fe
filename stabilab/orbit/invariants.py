"""The two invariants of one orbit: its squared radius and its energy."""
from __future__ import annotations

from ..numbers.balls import DOUBLE_BITS
from .ball_orbit import Orbit


def invariants_of(orbit: Orbit) -> dict[str, float]:
    """Q (the squared radius of the circle, or Z^2 - X^2 on a hyperbola) in canonical units, and the energy W^2/2 + V in
    the scene's, with the turn angle counted from the direction X = 0; nothing on a parabola."""
    r = orbit.reduction
    if r.e == 0:
        return {}

    def question(o):
        found = {"Q": float(o.Q)}
        angle = _angle(o)
        if angle is not None:
            energy = o.energy - o.mu * angle - o.x * (o.G * o.x / 2 + o.c) - r.e * o.d * o.z
            found["energy"] = float(energy.mid()) * r.energy_unit
        return found
    return orbit.settled(question, DOUBLE_BITS)


def _angle(orbit):
    """The turn angle from the direction X = 0; None where there is none, on an invariant plane."""
    if orbit.r.e < 0:
        return orbit.energy * 0 if orbit.Q == 0 else orbit.numbers.angle(orbit.x, orbit.z)
    return None if orbit.on_plane else (abs(orbit.xi) / abs(orbit.eta)).log() / 2
