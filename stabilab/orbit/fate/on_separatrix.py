"""Whether a state is on the separatrix exactly, where no search of the nearest point could end: algebra says so."""
from __future__ import annotations

from fractions import Fraction

from ...numbers.balls import FIRST_BITS
from .balls import decide


def on_separatrix(orbit) -> bool:
    """Whether the motion rests at a saddle or a fold, or tends to one; False where that is not decided.

    Under a torque along circles and hyperbolas no state in rational numbers tends to a saddle (Lindemann's theorem, docs/mathematics/separatrix.md).
    """
    r = orbit.reduction
    u, v, speed = (Fraction(orbit.state[axis]) for axis in (r.j, r.k, r.axis))
    force, *slopes = _force(r, u, v)
    if speed + r.s == 0 and force == 0:
        return _saddle(*slopes)
    if r.geometry.centred and (r.sense or (u + r.centre[0], v + r.centre[1]) == (0, 0)):
        return False
    if not r.geometry.centred and not any(orbit.settled(lambda found: found.taylor[1:], FIRST_BITS)):
        return False
    return decide(orbit, FIRST_BITS).sign == 0


def _force(r, u, v):
    """The rate of omega_i over its factor at components u, v, and its first three derivatives along the orbit, exactly."""
    along = [(u, v)]
    for n in range(3):
        a, b = along[-1]
        along.append((r.p * b + (0 if n else r.p0), r.q * a + (0 if n else r.q0)))
    (u, v), (u1, v1), (u2, v2), (u3, v3) = along
    return (r.kappa * u * v + r.rho * v + r.sigma * u + r.m, r.kappa * (u1 * v + u * v1) + r.rho * v1 + r.sigma * u1,
            r.kappa * (u2 * v + 2 * u1 * v1 + u * v2) + r.rho * v2 + r.sigma * u2,
            r.kappa * (u3 * v + 3 * u2 * v1 + 3 * u1 * v2 + u * v3) + r.rho * v3 + r.sigma * u3)


def _saddle(first, second, third) -> bool:
    """Whether a place without force is a maximum of the potential or a fold, where a branch of maxima ends."""
    return first > 0 or first == 0 and (second != 0 or third > 0)
