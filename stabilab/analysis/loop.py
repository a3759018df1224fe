"""One homoclinic loop in floats: the equilibria on a saddle's orbit and where the motion that leaves the saddle turns back.

The saddle is one equilibrium of its orbit; divided out, a cubic is left for the others: in tan(y/2) on a circle, in exp(y) on
a hyperbola. `loops` does the same for arrays.
"""
from __future__ import annotations

import math

from .rootfind import EPS

TURN = 2 * math.pi
OWN = 1e-9        # offsets below this are the saddle itself
LEVEL = 64 * EPS  # barriers that differ less from the saddle's height, relative to the terms of the energy, are as high
FAR = 700.0       # beside an open plane there is no wall as near as this


def settled_on(pot, place):
    """The place moved along its orbit to where the force vanishes, if that is near."""
    for _ in range(3):
        slope = pot.slope(place)
        step = -pot.force(place) / slope if slope else 0.0
        if not abs(step) < 0.5:
            return place
        place = pot.move(place, step)
        if abs(step) < 1e-12:
            break
    return place


def loop_end(pot, e, sense, saddle, side):
    """Distance along the orbit from the saddle to the far end of its loop on one side (-1, +1); None where no loop closes.

    sense: 0 without torque, where on a circle a loop may end at a barrier as high, or at the saddle itself, one turn on.
    """
    low = high = None
    for t in _others(pot, e, saddle, side):
        spot = pot.move(saddle, side * t)
        if pot.slope(spot) > 0:
            over = pot.rise(side * t, saddle)
            level = e < 0 and not sense and abs(over) <= LEVEL * _terms(pot, saddle)
            if over >= 0 or level:
                if low is not None and level:
                    return t
                high = t
                break
        else:
            low = t
    if low is None:
        return None
    if high is None:
        if e < 0 and not sense:
            return TURN
        high = TURN if e < 0 else _wall(pot, saddle, low, side)
    return None if high is None else _crossing(pot, saddle, side, low, high)


def _others(pot, e, saddle, side):
    """Distances to the other equilibria on one side of the saddle, ascending; on a circle within one turn."""
    if e < 0:
        x, z = saddle
        along, across = pot.G * (z - x) * (z + x), pot.d * z - pot.c * x
        a0, a3 = along + across, -(pot.c * z + pot.d * x)
        a1, a2 = a3 - 4 * pot.G * x * z, across - along
        if abs(a0) > abs(a3):
            angles = [2 * math.atan2(1.0, t) for t in _cubic(a0, a1, a2, a3)]
        else:
            angles = [2 * math.atan(t) for t in _cubic(a3, a2, a1, a0)]
        found = [side * y % TURN for y in angles]
    else:
        xi, eta = saddle
        quarter = 0.25 * pot.G
        b3, b0 = quarter * xi * xi, quarter * eta * eta
        found = [side * math.log(t) for t in _cubic(b3, b3 + pot.e1 * xi, b0 - pot.e2 * eta, b0) if t > 0]
    return sorted(t for t in found if t > OWN)


def _cubic(a, b, c, d) -> list[float]:
    """Real roots of a t^3 + b t^2 + c t + d, each with a step of Newton's method for what the closed form lost."""
    if not a:
        if not b:
            return [-d / c] if c else []
        disc = c * c - 4 * b * d
        if disc < 0:
            return []
        far = -0.5 * (c + math.copysign(math.sqrt(disc), c))
        return [far / b, d / far] if far else [0.0]
    p, q, r = b / a, c / a, d / a
    third = p / 3
    square, half = third * third - q / 3, third * (third * third - 0.5 * q) + 0.5 * r
    rest = half * half - square ** 3
    if rest < 0:
        angle = math.acos(max(-1.0, min(1.0, half / square ** 1.5))) / 3
        roots = [-2 * math.sqrt(square) * math.cos(angle + k * TURN / 3) - third for k in (0, 1, -1)]
    else:
        size = (abs(half) + math.sqrt(rest)) ** (1 / 3)
        single = -math.copysign(size, half)
        roots = [single + (square / single if single else 0.0) - third]
    for n, t in enumerate(roots):
        slope = (3 * t + 2 * p) * t + q
        step = (((t + p) * t + q) * t + r) / slope if slope else 0.0
        roots[n] = t - step if abs(step) < 1e-4 * abs(t) else t
    return roots


def _terms(pot, place):
    size = math.hypot(*place)
    return abs(pot.G) * size * size + (abs(pot.c) + abs(pot.d)) * size


def _wall(pot, saddle, low, side):
    """A distance at which the wall beyond the last well is higher than the saddle; None beside an open plane."""
    step = 1.0
    while step < FAR:
        if pot.rise(side * (low + step), saddle) > 0:
            return low + step
        step *= 2
    return None


def _crossing(pot, saddle, side, low, high):
    """Where the potential rises through the saddle's height between a well at `low` and `high`: Newton's method in a bracket.

    The first guess is exact for the cubic potential next to a fold, whose loop is half as long again as the way to the well.
    """
    t = min(1.5 * low, 0.5 * (low + high))
    for _ in range(200):
        value = pot.rise(side * t, saddle)
        if value > 0:
            high = t
        elif value < 0:
            low = t
        else:
            return t
        slope = -side * pot.force(pot.move(saddle, side * t))
        new = t - value / slope if slope > 0 else low
        if abs(new - t) <= 1e-9 * t:
            return new  # convergence is quadratic: the next step would be 1e-18
        if not low < new < high:
            new = 0.5 * (low + high)
            if not low < new < high:
                return new
        t = new
    return t
