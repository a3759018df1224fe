"""A reduction seen from a state, and what a chart of a sheet tells of one of its points."""
from __future__ import annotations

from fractions import Fraction
from typing import Any, NamedTuple

from ...conic import planes_touched

EPS = 2.0**-52
ROUNDINGS = 48  # units in the last place of the largest terms that a value at a point is off by at most
UNIT = ROUNDINGS * EPS


class Point(NamedTuple):
    """phi = W^2 and the squared distance `apart` in the plane of the orbit with their slopes in (t, y), in the scene's unit;
    gap: sqrt(max(phi, 0)) less the state's. off: the errors of apart, phi and gap; rough: those of the four slopes in their order.
    """

    apart: float
    apart_t: float
    apart_y: float
    phi: float
    phi_t: float
    phi_y: float
    gap: float
    off: tuple[float, float, float]
    rough: tuple[float, float, float, float]

    def off_square(self, w0):
        """Error of the square of the gap: next to W = 0 it is that of phi - 2 w0 sqrt(phi), where the root's own is large."""
        off = self.off[2]
        return min(2 * abs(self.gap) * off + off * off, self.off[1] + 2 * w0 * off)


class Constants:
    """The exact constants of a scene and a state as balls of some bits, made once for each number of bits."""

    def __init__(self, exact):
        self.exact, self.known = exact, {}

    def at(self, numbers):
        if numbers.bits not in self.known:
            self.known[numbers.bits] = {name: numbers.ball(value) for name, value in self.exact.items()}
        return self.known[numbers.bits]


class Seen(NamedTuple):
    """A reduction seen from a state: constants of the force and the metric, the state's place; exact, as balls and as doubles."""

    geometry: Any  # a class of `potential`
    exact: dict
    balls: Constants
    plain: dict
    touched: tuple = ()  # +1, -1: the hyperbola of equilibria touches a plane Z = -X, Z = X

    @property
    def e(self) -> int:
        """The sign of p q."""
        return self.geometry.e

    @staticmethod
    def of(reduction, state):
        g, r = reduction.exact_constants, reduction
        u, v, speed = (Fraction(state[axis]) for axis in (r.j, r.k, r.axis))
        x, z, w = g["flip"] * (u + g["sj"]) / g["rx"], (v + g["sk"]) / g["rz"], g["n"] * (speed + r.s)
        return seen_as(reduction.geometry, {"G": g["G"], "c": g["c"], "d": g["d"], "mu": g["mu"], "n2": g["n"] ** 2, "a": g["rx"] ** 2,
                                            "b": g["rz"] ** 2, "X": x, "Z": z, "w": abs(w) / g["n"]}, planes_touched(r))


def seen_as(geometry, exact, touched=()) -> Seen:
    return Seen(geometry, exact, Constants(exact), {name: float(value) for name, value in exact.items()}, touched)


def gap_of(phi, off_phi, w0):
    """sqrt(max(phi, 0)) - w0 and its error, for a phi with an error."""
    w = phi**0.5 if phi > 0 else 0.0
    off = off_phi / (w + max(phi - off_phi, 0.0)**0.5 + 1e-300) if phi > 0 else off_phi**0.5
    return w - w0, min(off, off_phi**0.5) + 4 * EPS * (w + w0)


def square_of(u, v, off_u, off_v, a, b):
    """a u^2 + b v^2 and its error."""
    apart = a * u * u + b * v * v
    return apart, a * off_u * (2 * abs(u) + off_u) + b * off_v * (2 * abs(v) + off_v) + 8 * EPS * apart
