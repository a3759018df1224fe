"""The reduced potential: differences of height and force along an orbit, free of cancellation.

Each class is one geometry of the reduction (circle, hyperbola, parabola) with the same small interface, and
what the geometry says of every motion. A *place* is a pair of arrays that moves along the orbit with the
coordinate theta; `rise(y, place, force)` is V(theta + y) - V(theta). At an equilibrium (force 0) the
first-order terms drop out analytically, so barriers and turning points keep their digits next to a
separatrix. The formulas serve arrays and Python floats alike; floats load no NumPy."""
from __future__ import annotations

import math
from collections.abc import Sequence
from types import SimpleNamespace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np

    from ..numbers.vectors import Number

SHORT = 0.7  # of an arc: there it is too near to its sine for a difference


def sin(y: float | np.ndarray):
    """sin of a float or an array."""
    if type(y) is float:
        return math.sin(y)
    import numpy as np
    return np.sin(y)


def exp(y: float | np.ndarray):
    """exp of a float or an array; inf beyond the largest double."""
    if type(y) is float:
        return math.exp(y) if y < 709.7 else math.inf
    import numpy as np
    return np.exp(y)


def y_minus_sin(y):
    """y - sin y without cancellation."""
    if type(y) is float:
        return _odd_series(y) if abs(y) < SHORT else y - math.sin(y)
    import numpy as np
    result, small = y - np.sin(y), np.abs(y) < SHORT
    if np.any(small):
        if not np.ndim(y):
            return _odd_series(y)
        result[small] = _odd_series(y[small])
    return result


def _odd_series(t: float | np.ndarray):
    """t - sin t for |t| < SHORT."""
    t2 = t * t
    return t * t2 / 6 * (1 - t2 / 20 * (1 - t2 / 42 * (1 - t2 / 72 * (1 - t2 / 110 * (1 - t2 / 156)))))


def exp_minus_two_terms(t):
    """exp(t) - 1 - t without cancellation."""
    if type(t) is float:
        return _growth_series(t) if abs(t) < 0.7 else math.expm1(t) - t if t < 709.7 else math.inf
    import numpy as np
    result, small = np.expm1(t) - t, np.abs(t) < 0.7
    if np.any(small):
        if not np.ndim(t):
            return _growth_series(t)
        result[small] = _growth_series(t[small])
    return result


def _growth_series(t):
    """exp(t) - 1 - t for |t| < 0.7."""
    series = 0.0
    for n in range(17, 2, -1):
        series = (1 + series) * t / n
    return 0.5 * t * t * (1 + series)


def force_at(G: Number, c: Number, d: Number, mu: Number, x: Number, z: Number):
    """F at (X, Z) of a circle or hyperbola; numbers of any kind."""
    return mu + G * x * z + c * z + d * x


def slope_at(G: Number, c: Number, d: Number, e: float, x: Number, z: Number):
    """dF/dtheta there, e the sign of p q; numbers of one state (arrays form the squares' difference as a
    product)."""
    return G * (z * z + e * x * x) + e * c * x + d * z


def rise_at(G: Number, c: Number, d: Number, mu: Number, e: float, location: np.ndarray | Sequence[Number],
            swing: Sequence[Number], lag: Number, force: Number):
    """V(theta + y) - V(theta) from (X, Z), free of cancellation; numbers of any kind.

    swing: (sin y, cos y - 1), or of sinh and cosh; lag: y less the first of them; force: that at the place,
    exactly.
    """
    (x, z), (s, b) = location, swing
    dx = z * s + x * b
    return -mu * lag - force * s - b * (G * x * x + c * x + e * d * z) - G / 2 * dx * dx


class Circle:
    """place = (X, Z)."""

    e = -1  # sign of p q
    kind = "elliptic"
    where = "the major or the minor axis"
    rank = 0  # of a scene's reductions the least is taken: a circle is compact
    centred = True  # whether orbits have a common centre, and canonical variables measured from it
    # whether the potential has walls on both sides of every orbit but for a set of measure zero
    walled = False

    def __init__(self, reduction):
        constants = reduction.constants
        self.G, self.c, self.d, self.mu = (constants[name] for name in ("G", "c", "d", "mu"))
        self.slopes = abs(self.c) + abs(self.d)

    @staticmethod
    def place(x: Number, z: Number):
        """The place of (X, Z)."""
        return x, z

    @staticmethod
    def xz(place: np.ndarray | Sequence[float | np.ndarray]):
        """(X, Z) of a place."""
        return place

    def force(self, place: Sequence[float | np.ndarray]):
        return force_at(self.G, self.c, self.d, self.mu, *place)

    def terms(self, place: Sequence[float | np.ndarray]):
        """Size of the terms of the force: times the unit of rounding, its error."""
        x, z = abs(place[0]), abs(place[1])
        return self.mu + abs(self.G) * x * z + abs(self.c) * z + abs(self.d) * x

    def slope(self, place: Sequence[float | np.ndarray]):
        """dF/dtheta; positive at a barrier, negative in a well."""
        x, z = place
        return self.G * (z - x) * (z + x) - self.c * x + self.d * z

    def move(self, place: Sequence[float | np.ndarray], y: float | np.ndarray):
        x, z = place
        half = sin(0.5 * y)
        s, b = sin(y), -2 * half * half
        return x + (z * s + x * b), z + (z * b - x * s)

    def rise(self, y: float | np.ndarray, place: np.ndarray | Sequence[float | np.ndarray],
             force: float | np.ndarray = 0.0):
        half = sin(0.5 * y)
        return rise_at(self.G, self.c, self.d, self.mu, -1, place, (sin(y), -2 * half * half), y_minus_sin(y),
                       force)


class Hyperbola:
    """place = (xi, eta) = (X + Z, X - Z), growing and decaying like exp(+-theta)."""

    e = 1
    kind = "hyperbolic"
    where = "the intermediate axis"
    rank = 1
    centred = walled = True

    def __init__(self, reduction):
        constants = reduction.constants
        self.G, self.mu = constants["G"], constants["mu"]
        self.e1 = 0.5 * (constants["c"] + constants["d"])
        self.e2 = 0.5 * (constants["d"] - constants["c"])
        self.slopes = abs(self.e1) + abs(self.e2)

    @staticmethod
    def place(x: Number, z: Number):
        """The place (X + Z, X - Z) of (X, Z)."""
        return x + z, x - z

    @staticmethod
    def xz(place: np.ndarray | Sequence[np.ndarray]):
        """As of `Circle`."""
        return 0.5 * (place[0] + place[1]), 0.5 * (place[0] - place[1])

    def force(self, place: Sequence[float | np.ndarray]):
        xi, eta = place
        return self.mu + 0.25 * self.G * (xi - eta) * (xi + eta) + self.e1 * xi + self.e2 * eta

    def terms(self, place):
        xi, eta = abs(place[0]), abs(place[1])
        return self.mu + 0.25 * abs(self.G) * (xi * xi + eta * eta) + abs(self.e1) * xi + abs(self.e2) * eta

    def slope(self, place: Sequence[float | np.ndarray]):
        xi, eta = place
        return 0.5 * self.G * (xi * xi + eta * eta) + self.e1 * xi - self.e2 * eta

    def move(self, place: Sequence[float | np.ndarray], y: float | np.ndarray):
        return place[0] * exp(y), place[1] * exp(-y)

    def rise(self, y: float | np.ndarray, place: np.ndarray | Sequence[float | np.ndarray],
             force: float = 0.0):
        # exp(2 y) - 1 - 2 y is the square of exp(y) - 1 and twice exp(y) - 1 - y
        (xi, eta), up, down = place, exp_minus_two_terms(y), exp_minus_two_terms(-y)
        grown, decayed = up + y, down - y
        eighth = -0.125 * self.G
        return (eighth * xi * xi * (grown * grown + 2 * up)
                + eighth * eta * eta * (decayed * decayed + 2 * down)
                - self.e1 * xi * up + self.e2 * eta * down - force * y)


class Parabola:
    """Two equal moments: place = (omega_j, omega_k); the potential is a polynomial of degree 4 or less."""

    e = 0
    kind = "parabolic"
    where = "an axis between two equal moments"
    rank = 2
    centred, walled = False, True

    def __init__(self, reduction):
        names = ("p", "p0", "q", "q0", "kappa", "rho", "sigma", "m")
        self.p, self.p0, self.q, self.q0, self.kappa, self.rho, self.sigma, self.m = (
            float(getattr(reduction, name)) for name in names)

    def force(self, place: Sequence[np.ndarray]):
        u, v = place
        return self.kappa * u * v + self.rho * v + self.sigma * u + self.m

    def terms(self, place: Sequence[np.ndarray]):
        u, v = abs(place[0]), abs(place[1])
        return abs(self.kappa) * u * v + abs(self.rho) * v + abs(self.sigma) * u + abs(self.m)

    def derivatives(self, place: Sequence[np.ndarray]):
        """F', F'', F''' along the orbit."""
        return derivatives_on_parabola(self, *place)

    def derivative_terms(self, place: Sequence[np.ndarray]):
        """Sizes of the terms of F', F'', F''': times the unit of rounding, their errors."""
        sizes = SimpleNamespace(**{name: abs(value) for name, value in vars(self).items()})
        return derivatives_on_parabola(sizes, abs(place[0]), abs(place[1]))

    def slope(self, place: Sequence[np.ndarray]):
        return self.derivatives(place)[0]

    @staticmethod
    def place(first, second):
        """The two components."""
        return first, second

    @staticmethod
    def xz(place):
        """The two components of a place."""
        return place

    def move(self, place: Sequence[np.ndarray], y: np.ndarray):
        u, v = place
        a, b = self.p * v + self.p0, self.q * u + self.q0
        return u + y * (a + 0.5 * self.p * b * y), v + y * (b + 0.5 * self.q * a * y)

    def rise(self, y: np.ndarray, place: Sequence[np.ndarray], force: float = 0.0):
        first, second, third = self.derivatives(place)
        return -y * (force + y * (first / 2 + y * (second / 6 + y * third / 24)))


def derivatives_on_parabola(r, u, v):
    """F', F'', F''' along a parabola at (omega_j, omega_k) = (u, v), where p q = 0 and F is a cubic. r: its
    reduction or its `Parabola`; floats, arrays, fractions or intervals."""
    a, b = r.p * v + r.p0, r.q * u + r.q0
    first = r.kappa * (a * v + u * b) + r.rho * b + r.sigma * a
    second = r.kappa * (2 * a * b + r.p * b * v + u * r.q * a) + r.rho * r.q * a + r.sigma * r.p * b
    return first, second, 3 * r.kappa * (r.q * a * a + r.p * b * b)


def potential(reduction):
    """The potential of a reduction."""
    return reduction.geometry(reduction)


Geometry = type[Circle] | type[Hyperbola] | type[Parabola]
GEOMETRIES: dict[int, Geometry] = {-1: Circle, 1: Hyperbola, 0: Parabola}
