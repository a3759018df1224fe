"""One homoclinic loop in floats: the equilibria on a saddle's orbit and where the motion that leaves the
saddle turns back.

The saddle is one equilibrium of its orbit; divided out, a cubic is left for the others: in tan(y/2) on a
circle (`circle_loops`), in exp(y) on a hyperbola. `loops` asks here too, row by row.
"""
from __future__ import annotations

import math

from .circle import ENDS, NONE, OWN, crossing, real_cubic
from .circle import loop_end as _end_on_circle

FAR = 700.0       # beside an open plane there is no wall as near as this


def loop_end(pot, sense, saddle, side):
    """(distance along the orbit from the saddle to the far end of its loop on one side (-1, +1), distance to
    the deepest well inside, ENDS or SHARED); None where no loop closes. SHARED: the far end is a saddle as
    high.

    sense: 0 without torque, where on a circle a loop may end at a barrier as high, or at the saddle itself,
    one turn on.
    """
    return GEOMETRIES[pot.e](pot, sense, saddle, side)


def _on_circle(pot, sense, saddle, side):
    found = _end_on_circle((pot.G, pot.c, pot.d, pot.mu), sense, *saddle, side)
    return None if found[2] == NONE else found


def _on_hyperbola(pot, sense, saddle, side):
    low = high = centre = None
    deepest = 0.0
    for t in _others(pot, saddle, side):
        over = pot.rise(side * t, saddle)
        if pot.slope(pot.move(saddle, side * t)) > 0:
            if over >= 0:
                high = t
                break
        else:
            low = t
            if centre is None or over < deepest:
                deepest, centre = over, t
    if low is None:
        return None
    if high is None:
        high = _wall(pot, saddle, low, side)
    if high is None:
        return None
    end = crossing(lambda t: pot.rise(side * t, saddle),
                   lambda t: -side * pot.force(pot.move(saddle, side * t)), low, high)
    return end, centre, ENDS


def _others(pot, saddle, side):
    """Distances to the other equilibria on one side of the saddle of a hyperbola, ascending."""
    xi, eta = saddle
    quarter = 0.25 * pot.G
    b3, b0 = quarter * xi * xi, quarter * eta * eta
    found = [side * math.log(t) for t in real_cubic(b3, b3 + pot.e1 * xi, b0 - pot.e2 * eta, b0) if t > 0]
    return sorted(t for t in found if t > OWN)


def _wall(pot, saddle, low, side):
    """A distance at which the wall beyond the last well is higher than the saddle; None beside an open plane.
    """
    step = 1.0
    while step < FAR:
        if pot.rise(side * (low + step), saddle) > 0:
            return low + step
        step *= 2
    return None


GEOMETRIES = {-1: _on_circle, 1: _on_hyperbola}
