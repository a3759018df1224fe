"""One homoclinic loop in floats, and the results about surfaces and distances as frozen classes.

The loop has the equilibria on a saddle's orbit and where the motion that leaves the saddle turns back.

The saddle is one equilibrium of its orbit; divided out, a cubic is left for the others: in tan(y/2) on a
circle, in exp(y) on a hyperbola. `homoclinic_arrays.loops` uses this too, row by row."""
from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import acos, atan, atan2, copysign, cos, inf, log, nan, pi, sqrt
from typing import TYPE_CHECKING, NamedTuple

from ...reasons import Reason, Reasoned, Sentence
from ...representation import Answer, Compared

if TYPE_CHECKING:
    import numpy as np

    from ..potential import Circle, Hyperbola

AGREE = 1e-6  # relative: nearer than that, lower bound and witness are one number


@dataclass(frozen=True, eq=False)
class Branch(Compared):
    """One branch of the separatrix as a parametric grid.

    points: (n, m, 3) array; row r is the homoclinic curve at one value of the invariant, rows run from the
    fold outward, columns run once around the loop from the saddle (column 0) back to the saddle (column -1).
    residual: (n, m) distance from the surface in energy, relative to what the size of the point, rounded,
    moves in it. saddle: (n, 3) the saddle equilibria at the rows; centre: (n, 3) the enclosed centres. error:
    estimate, from the grid's curvatures, of the largest distance of flat facets from the surface, in
    the unit of the points; cut: +1 where facets of the first half of the columns are cut from (r, c) to (r +
    1, c + 1), -1 the other way; the second half mirrors it.
    """

    name: str
    points: np.ndarray
    residual: np.ndarray
    saddle: np.ndarray
    centre: np.ndarray
    invariant: np.ndarray
    error: float | None = None
    cut: int = 1


@dataclass(frozen=True, repr=False)
class Separatrix(Answer, Reasoned):
    """Every branch of the separatrix inside the range; reason says why there is none or what bounds
    it."""

    branches: tuple[Branch, ...]

    @property
    def sheets(self) -> tuple[Branch, ...]:
        """The branches, by the name that they had before."""
        return self.branches


class Apart(NamedTuple):
    """The distance of a state from the separatrix lies in [lower, upper]; witness: a point of it (three
    rates) at `upper`.

    inf, inf, None where the scene has no separatrix. reason: why the two are apart by more than AGREE, else
    None.
    """

    lower: float
    upper: float
    witness: tuple[float, float, float] | None
    reason: Reason | None = None
    boxes: int = 0

    @property
    def value(self) -> float:
        """The distance where it is known to AGREE, else what it certainly is not below; NaN where nothing is
        known of it."""
        return self.upper if self.settled else self.lower if self.upper < math.inf else math.nan

    @property
    def settled(self) -> bool:
        return self.upper == self.lower or self.upper - self.lower <= AGREE * self.upper < math.inf


NO_SEPARATRIX = Apart(math.inf, math.inf, None)
BEYOND_SEARCH = Sentence(
    "beyond-search-of-separatrix", "the numbers of this scene are beyond what the search for the nearest "
    "point of the separatrix holds")()
ENDED = Sentence(
    "search-of-separatrix-ended", "the search ended before its proved lower bound met the nearest point "
    "found")()
UNKNOWN = Apart(0.0, math.inf, None, BEYOND_SEARCH)


EPS = 2.0**-52
TURN = 2 * pi
# powers of two: a wall beyond the last well of a hyperbola is nearer, or there is none
WALL_POWERS = 10
OWN = 1e-9        # offsets below this are the saddle itself
# barriers that differ less from the saddle's height, relative to the energy's terms, are as high
LEVEL = 64 * EPS
# of the largest root of a cubic: smaller ones the closed form, a difference of numbers of its size, loses
# digits of
SPREAD = 1e-3
LOST = 1e-4       # of a cubic's terms: a discriminant that is less may have the other sign
POLISH = 3        # steps of Newton's method


def settled(pot: Circle, location: Sequence[float]):
    """The place moved along its orbit to where the force vanishes, if that is near."""
    for _ in range(POLISH):
        slope = pot.slope(location)
        step = -pot.force(location) / slope if slope else 0.0
        if not abs(step) < 0.5:
            break
        location = pot.move(location, step)
        if abs(step) < 1e-12:
            break
    return location


def loop_end(pot: Circle | Hyperbola, sense: int, saddle: Sequence[float], side: int):
    """(distance along the orbit from the saddle to the far end of its loop on one side (-1, +1), distance to
    the deepest well inside, whether the far end is a saddle as high); None where no loop closes.

    The loop ends where the potential beyond its wells is back at the saddle's height. sense: 0 without
    torque, where on a circle it may end at a barrier as high, or at the saddle itself, one turn on; with
    torque the saddle then stands higher, or lower, by 2 pi mu.
    """
    low, high, deepest, centre = 0.0, inf, inf, 0.0
    turns = pot.e < 0 and sense == 0
    for t in others(pot, saddle, side):
        over = pot.rise(side * t, saddle)
        if not pot.slope(pot.move(saddle, side * t)) > 0:
            low = t
            if over < deepest:
                deepest, centre = over, t
            continue
        level = turns and abs(over) <= LEVEL * _terms(pot, saddle)
        if level and low > 0:
            return t, centre, True
        if over >= 0 or level:
            high = t
            break
    if low == 0:
        return None
    if high == inf:
        if turns:
            return TURN, centre, True
        walls = [TURN] if pot.e < 0 else [low + 2.0**n for n in range(WALL_POWERS)]
        high = next((t for t in walls if pot.rise(side * t, saddle) > 0), None)
        if high is None:  # towards the torque the next turn lies lower; beside an open plane is no wall
            return None
    end = _crossing(lambda t: pot.rise(side * t, saddle),
                    lambda t: -side * pot.force(pot.move(saddle, side * t)), low, high)
    return end, centre, False


def _terms(pot: Circle | Hyperbola, location: Sequence[float]):
    """Size of the terms of the energy at a place of a circle."""
    size = location[0] * location[0] + location[1] * location[1]
    return abs(pot.G) * size + pot.slopes * sqrt(size)


def others(pot, saddle, side):
    """Distances to the other equilibria on one side of a saddle, ascending; on a circle within one turn.

    Along a circle F(y) = 2 sin(y/2) (a0 C^3 + a1 C^2 S + a2 C S^2 + a3 S^3) with C = cos(y/2), S = sin(y/2):
    a cubic for the tangent, or for the cotangent where the tangent may be infinite.
    """
    if pot.e > 0:
        xi, eta = saddle
        quarter = 0.25 * pot.G
        b3, b0 = quarter * xi * xi, quarter * eta * eta
        rows = [side * log(t) for t in real_cubic(b3, b3 + pot.e1 * xi, b0 - pot.e2 * eta, b0) if t > 0]
    else:
        x, z = saddle
        along, across = pot.G * (z - x) * (z + x), pot.d * z - pot.c * x
        a0, a3 = along + across, -(pot.c * z + pot.d * x)
        a1, a2 = a3 - 4 * pot.G * x * z, across - along
        if abs(a0) > abs(a3):
            rows = [side * 2 * atan2(1.0, t) for t in real_cubic(a0, a1, a2, a3)]
        else:
            rows = [side * 2 * atan(t) for t in real_cubic(a3, a2, a1, a0)]
        rows = [t + TURN if t < 0 else t for t in rows]
    return sorted(t for t in rows if t > OWN)


def real_cubic(a: float, b: float, c: float, d: float):
    """Real roots of a t^3 + b t^2 + c t + d, nan in place of those that are not, each with a step of Newton's
    method for what the closed form lost."""
    if a == 0:
        if b == 0:
            return (-d / c if c != 0 else nan), nan, nan
        disc = c * c - 4 * b * d
        if disc < 0:
            return nan, nan, nan
        far = -0.5 * (c + copysign(sqrt(disc), c))
        return (far / b, d / far, nan) if far != 0 else (0.0, nan, nan)
    p, q, r = b / a, c / a, d / a
    third = p / 3
    square, half = third * third - q / 3, third * (third * third - 0.5 * q) + 0.5 * r
    rest = half * half - square * square * square
    if rest < 0:
        size = sqrt(square)
        angle = acos(max(-1.0, min(1.0, half / (size * size * size)))) / 3
        first, second, last = (_better(p, q, r, -2 * size * cos(angle) - third),
                               _better(p, q, r, -2 * size * cos(angle + TURN / 3) - third),
                               _better(p, q, r, -2 * size * cos(angle - TURN / 3) - third))
        largest = (first if abs(first) >= max(abs(second), abs(last)) else second if abs(second) >= abs(last)
                else last)
        if min(abs(first), abs(second), abs(last)) < SPREAD * abs(largest):
            return _beside_largest(p, q, r, largest)
        return first, second, last
    single = -copysign((abs(half) + sqrt(rest)) ** (1 / 3), half)
    only = _better(p, q, r, single + (square / single if single != 0 else 0.0) - third)
    return (_beside_largest(p, q, r, only) if rest <= LOST * half * half
            and only * only * abs(only) * SPREAD > abs(r) else (only, nan, nan))


def _beside_largest(p: float, q: float, r: float, t: float):
    """The largest root t of t^3 + p t^2 + q t + r with the two much smaller ones, of which the closed form
    keeps no digit: those of the quadratic that is left, from its low powers up. nan where they are not
    real."""
    product = -r / t
    total = (q - product) / t
    disc = total * total - 4 * product
    if disc < 0:
        return t, nan, nan
    far = 0.5 * (total + copysign(sqrt(disc), total))
    return t, _better(p, q, r, far), _better(p, q, r, product / far) if far != 0 else 0.0


def _better(p: float, q: float, r: float, t: float):
    """A root of t^3 + p t^2 + q t + r after one step of Newton's method."""
    steep = (3 * t + 2 * p) * t + q
    step = (((t + p) * t + q) * t + r) / steep if steep != 0 else 0.0
    return t - step if abs(step) < 1e-4 * abs(t) else t


def _crossing(height: Callable[[float], float], slope_at: Callable[[float], float], low: float, high: float):
    """Where the potential rises through the saddle's height between a well at `low` and `high`, distances
    from the saddle: Newton's method in a bracket. height, slope_at: of a distance.

    The first guess is exact for the cubic potential next to a fold, whose loop is half as long again as the
    way to the well.
    """
    t = min(1.5 * low, 0.5 * (low + high))
    for _ in range(200):
        value = height(t)
        if value > 0:
            high = t
        elif value < 0:
            low = t
        else:
            return t
        steep = slope_at(t)
        new = t - value / steep if steep > 0 else low
        if abs(new - t) <= 1e-9 * t:
            return new  # convergence is quadratic: the next step would be 1e-18
        if not low < new < high:
            new = 0.5 * (low + high)
            if not low < new < high:
                return new
        t = new
    return t
