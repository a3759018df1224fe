"""Certificates of endless growth: once true, they stay true."""
from __future__ import annotations

import math

# A certificate counts when its inequality holds by this share of the terms in it: 100 times their rounding.
CLEARANCE = 2e-14


def spin_up_margin(c, y) -> tuple[float, float]:
    """(margin, size of its terms) of the certificate "spin-up" at y = (u, y2, y3): it holds where margin > 0."""
    phi, P, J = angle_of(c, y)
    bend, depth, tail = P * P / 2, J / 2 * math.sin(phi)**2, c * c / 8 * math.sin(2 * phi)**2
    size = bend + abs(depth) + abs(J) + c * c
    return (bend - depth + tail + min(J, 0.0) / 2 - 0.625 * c * c if P > 0 else -size), size


def well_margin(c, y) -> tuple[float, float]:
    """(margin, size of its terms) of the certificate "well" (c < 0) at y, for the best barrier angle found."""
    phi, P, J = angle_of(c, y)
    p = phi % math.pi

    def rise(b):  # V(b) - V(p), differences formed term by term
        return (p - b) - J / 2 * math.sin(b - p) * math.sin(b + p) + c * c / 8 * math.sin(2 * (b - p)) * math.sin(2 * (b + p))
    barrier = _highest(rise, max(p, math.pi - p), J, c)
    return rise(barrier) - P * P / 2, P * P / 2 + abs(J) / 2 + c * c / 8 + math.pi


def angle_of(c, y):
    u, y2, y3 = y
    phi = math.atan2(y3, y2)
    return phi, u + c / 2 * math.cos(2 * phi), y2 * y2 + y3 * y3 - 2 * c * u


def _highest(rise, low, J, c):
    """An angle in [low, pi] where V is about highest (any angle makes a valid certificate)."""
    places = [low + (math.pi - low) * n / 48 for n in range(49)] + [math.pi - (math.pi - low) * 4.0**-n for n in range(1, 24)]
    b = max(places, key=rise)
    for _ in range(6):  # Newton on V' = -1 - (J/2) sin 2b + (c^2/4) sin 4b, kept only where it climbs
        slope, bend = -1 - J / 2 * math.sin(2 * b) + c * c / 4 * math.sin(4 * b), -J * math.cos(2 * b) + c * c * math.cos(4 * b)
        if bend >= 0:
            break
        step = min(max(b - slope / bend, low), math.pi)
        if rise(step) <= rise(b):
            break
        b = step
    return b


def release_estimate(c, J):
    """When a temporary capture (c > 0) is over. Small c: P' > 0 everywhere once J < 2 (about). Any c: P = 0 needs
    J = R^2 + c^2 cos 2phi >= -c^2."""
    return max(0.0, (J - 2 if c * c < 2 else J + c * c) / (2 * c))


def certificate(c, y) -> str | None:
    """"spin-up" or "well" where the one or the other holds at y beyond rounding, None otherwise."""
    margin, size = spin_up_margin(c, y)
    if margin > CLEARANCE * size or (c > 0 and angle_of(c, y)[2] + c * c < -CLEARANCE * size):
        return "spin-up"
    if c < 0:
        margin, size = well_margin(c, y)
        if margin > CLEARANCE * size:
            return "well"
    return None
