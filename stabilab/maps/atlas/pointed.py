"""The points of one round of an atlas: a case with its torque turned to a direction and, on request, with another wheel momentum."""
from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from ...case.read import Case
from ...numbers.exact import sqrt_fraction
from ...numbers.principal import without_trace
from ...numbers.vectors import Exact3, dot
from ...physics.effects import effect_class
from ...physics.scene import Scene
from .cells import middles

AXES, THRUSTERS, OWN = -1, -2, -3  # in the place of a level: directions with a name, exactly as they are
AXIS_POINTS = 6


class Point(NamedTuple):
    """A direction beside a wheel. wheel: which momentum; level, number: of the cell whose middle it is; or AXES and twice the axis, one more where it is
    against it; or THRUSTERS and which; or OWN, 0."""

    wheel: int
    level: int
    number: int


@dataclass(frozen=True)
class Pointed:
    """torque: its size, N m; wheels: momenta along the principal axes, N m s; all exact. certify: whether fates and times are to be proved, whatever that
    takes."""

    torque: Fraction
    wheels: tuple[Exact3, ...]
    points: tuple[Point, ...]
    certify: bool = False

    def told(self) -> dict[str, Any]:
        """For JSON."""
        return {"torque": str(self.torque), "wheels": [list(map(str, wheel)) for wheel in self.wheels], "points": self.points, "certify": self.certify}

    def case(self, case: Case, number: int) -> Case:
        """The case with the torque and the wheel of a point."""
        point = self.points[number]
        torque = tuple(self.torque * part for part in self._direction(case, number))
        wheel = without_trace(self.wheels[point.wheel], torque)
        return replace(case, scene=Scene(case.scene.body, effect_class("gyrostat")(wheel), effect_class("constant_torque")(torque)))  # type: ignore[union-attr]  # of a body

    def _direction(self, case: Case, number: int) -> Exact3:
        point = self.points[number]
        return tuple(map(Fraction, self._middles[number])) if point.level >= 0 else named_direction(case, point.level, point.number)

    @cached_property
    def _middles(self) -> dict[int, list[float]]:
        """Of every point that is a cell."""
        found: dict[int, list[float]] = {}
        for level in {point.level for point in self.points if point.level >= 0}:
            at = [n for n, point in enumerate(self.points) if point.level == level]
            found |= dict(zip(at, middles(level, np.array([self.points[n].number for n in at])).tolist()))
        return found


def pointed_from(told: dict[str, Any]) -> Pointed:
    """The points that `told` wrote down."""
    wheels = tuple(tuple(map(Fraction, wheel)) for wheel in told["wheels"])
    return Pointed(Fraction(told["torque"]), wheels, tuple(Point(*one) for one in told["points"]), told["certify"])


def named_direction(case: Case, kind: int, number: int) -> Exact3:
    """A unit vector along the principal axes: exact for an axis, to 240 bits else."""
    if kind == AXES:
        return tuple(Fraction((1 - 2 * (number % 2)) * (axis == number // 2)) for axis in range(3))
    turned = case.scene.vector("constant_torque") if kind == OWN else along_axes(case, case.thrusters[number].torque)  # type: ignore[union-attr]
    return unit(turned)


def along_axes(case: Case, vector: Exact3) -> Exact3:
    """The components along the principal axes of a vector in the frame of the file."""
    return vector if case.frame is None else case.frame.turned(vector)


def unit(vector: Exact3) -> Exact3:
    """The vector in length 1: exactly along an axis where it is along one."""
    size = sqrt_fraction(dot(vector, vector))
    return tuple(v / size for v in vector) if sum(v != 0 for v in vector) > 1 else tuple(Fraction((v > 0) - (v < 0)) for v in vector)
