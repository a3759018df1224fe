"""Principal axes as the answer counts them: 1 the major, 3 the minor, right-handed, whatever the order in the file."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from ...numbers.principal import NOTHING
from ...numbers.vectors import Exact3, Float3, Number
from ...physics.scene import Scene
from .result import Principal

IDENTITY = tuple(tuple(Fraction(i == j) for j in range(3)) for i in range(3))


@dataclass(frozen=True)
class Axes:
    """order[n]: which axis of the scene is number n + 1 of the answer; sign[n]: +-1, along it or against it. rows: the scene's axes,
    unit vectors (exact) in the frame of the file."""

    order: tuple[int, ...]
    sign: tuple[int, ...]
    rows: tuple[Exact3, ...]
    moments: Exact3

    @property
    def principal(self) -> Principal:
        """Moments that descend, and their axes."""
        return Principal(tuple(float(self.moments[i]) for i in self.order),
                         tuple(tuple(float(s * v) + 0.0 for v in self.rows[i]) for i, s in zip(self.order, self.sign)))

    def counted(self, vector: Sequence[Number]) -> Float3:
        """Components along the answer's axes of a vector along the scene's."""
        return tuple(float(s * vector[i]) + 0.0 for i, s in zip(self.order, self.sign))

    def number(self, axis: int, sense: int) -> tuple[int | None, int | None]:
        """(axis, sense) of the answer for an axis 1, 2, 3 of the scene; (None, None) for 0."""
        if not axis:
            return None, None
        place = self.order.index(axis - 1)
        return place + 1, sense * self.sign[place] if sense else None

    def back(self, vector: Sequence[Number]) -> Float3:
        """A vector along the scene's axes in the frame of the file."""
        exact = [Fraction(v) for v in vector]
        found = [sum((self.rows[i][j] * exact[i] for i in range(3)), Fraction(0)) for j in range(3)]
        least = max(map(abs, found)) * NOTHING
        return tuple(float(v) + 0.0 if abs(v) > least else 0.0 for v in found)

    def turned(self, vector: Sequence[Fraction]) -> Exact3:
        """An exact vector of the frame of the file along the scene's axes."""
        if self.rows == IDENTITY:
            return tuple(vector)
        return tuple(sum((a * v for a, v in zip(axis, vector)), Fraction(0)) for axis in self.rows)


def axes_of(scene: Scene, frame: Any = None) -> Axes:
    """The axes of a scene; frame: `PrincipalAxes` of its case, None where the scene's axes are the file's."""
    moments, rows = scene.body.exact, IDENTITY if frame is None else frame.axes
    order = tuple(sorted(range(3), key=lambda i: -moments[i]))
    even = order in ((0, 1, 2), (1, 2, 0), (2, 0, 1))
    return Axes(order, (1, 1 if even else -1, 1), rows, moments)
