"""Directions of a torque as cells of equal area of a sphere, triangles of an octahedron whose corners are the
principal axes, refined where neighbours differ.

The projection is Snyder's (Cartographica 29, 1992), with the octahedron in place of the icosahedron. A face
is cut from its middle into six right triangles; in each a plane one of angles 60, 90 and 30 degrees stands
for the spherical one of 60, 90 and 45. A ray from the middle at the share t of the way from the middle of an
edge to its end cuts off the area t pi/12, and within a ray the area grows as the square of sin(z/2), z the
angle from the middle:

    tan(azimuth) = sin(t pi/12)/(cos(t pi/12) - cos g),   cos g = sqrt(2/3),   sin(z/2) = r sin(q/2),   tan q
    = tan g/cos(azimuth).

So areas are kept, and plane triangles of one size are cells of one area at any depth, each cut into four of
its own by the middles of its edges. Why not HEALPix or a latitude and longitude grid: a body has the
symmetries of its three axes, and so have these cells. Reflections in the principal planes and exchanges of
axes map cells onto cells, the planes are edges, and no middle of a cell lies on a principal axis or plane,
where a verdict need not be that of its neighbours.

A place on the octahedron |x| + |y| + |z| = 1 is given by its three coordinates; a cell by its level and its
number, the face and then a digit of base 4 for each cut: 0, 1, 2 for the part at that corner, 3 for the one
in the middle.
"""
from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from ..case.read import Case
from ..numbers.exact import unit_vector
from ..numbers.principal import without_trace
from ..numbers.vectors import Exact3
from ..physics.effects import effect_class
from ..physics.scene import Scene

FACES, DEEPEST = 8, 12
# of the three coordinates on each face
SIGNS = np.array([[1 - 2 * (n >> axis & 1) for axis in range(3)] for n in range(FACES)])
COS_G, TAN_G, PART = np.sqrt(2 / 3), np.sqrt(1 / 2), np.pi / 12
WHOLE = 4 * np.pi


def count(level: int) -> int:
    """Cells of a level on the whole sphere."""
    return FACES * 4**level


def area(level: float | np.ndarray) -> Any:
    """The solid angle of a cell of a level, sr; a share of the sphere."""
    return WHOLE / (FACES * 4.0 ** np.asarray(level))


def corners(level: int, numbers: np.ndarray) -> np.ndarray:
    """(n, 3, 3): the corners of cells of a level as whole coordinates, whose sizes add up to 2^level."""
    numbers = np.asarray(numbers, np.int64)
    at = np.broadcast_to(np.eye(3, dtype=np.int64), (len(numbers), 3, 3)).copy()
    for cut in range(level):
        digit = numbers >> 2 * (level - 1 - cut) & 3
        middle = at[:, [1, 2, 0]] + at[:, [2, 0, 1]]  # twice the middle of the edge opposite to each corner
        own = np.take_along_axis(at, np.minimum(digit, 2)[:, None, None].repeat(3, 2), 1)
        at = np.where((digit == 3)[:, None, None], middle, at + own)
    return at * SIGNS[numbers >> 2 * level][:, None, :]


def places(level: int, numbers: np.ndarray) -> np.ndarray:
    """(n, 3): the middles of cells on the octahedron."""
    return corners(level, numbers).sum(axis=1) / (3.0 * 2**level)


def cell_at(level: int, location: np.ndarray) -> np.ndarray:
    """(n,): the numbers of the cells of a level that hold places (n, 3) on the octahedron."""
    location = np.asarray(location, float)
    number = ((location < 0) * [1, 2, 4]).sum(axis=1).astype(np.int64)
    part = np.abs(location) / np.abs(location).sum(axis=1, keepdims=True)
    for _ in range(level):
        digit = np.where((part > 0.5).any(axis=1), part.argmax(axis=1), 3)
        part = np.where((digit == 3)[:, None], 1 - 2 * part, 2 * part - (np.arange(3) == digit[:, None]))
        number = 4 * number + digit
    return number


def neighbours(level: int, numbers: np.ndarray) -> np.ndarray:
    """(n, 3): the cells of the same level across each edge, over the seams of the faces too."""
    at = corners(level, numbers)
    full = at.sum(axis=1, keepdims=True)  # three times the middle
    ends = full - at  # of the edge opposite to each corner: the sum of its two
    # (n, edge, coordinate): the edge lies in a principal plane, and the cell beyond is the mirror image
    seam = (ends == 0) & (at != 0)
    location = np.where(seam.any(axis=2, keepdims=True), np.where(seam, -1, 1) * full, 2 * ends - at)
    return cell_at(level, location.reshape(-1, 3) / (3.0 * 2**level)).reshape(-1, 3)


def directions(location: np.ndarray) -> np.ndarray:
    """(n, 3): unit vectors of places on the octahedron."""
    location = np.asarray(location, float)
    size = np.abs(location)
    rows = np.arange(len(size))
    k = size.argmin(axis=1)  # the corner opposite to the nearest edge
    i, j = (k + 1) % 3, (k + 2) % 3
    smallest, a, b = size[rows, k], size[rows, i], size[rows, j]
    r = 1 - 3 * smallest
    # of [-1, 1] from one end of the edge to the other
    along = np.divide(a - b, r, out=np.zeros_like(r), where=r > 0) * PART
    across, ahead = np.sin(along), np.cos(along) - COS_G
    far = np.hypot(across, ahead)
    azimuth_sin, azimuth_cos = across / far, ahead / far
    q = np.arctan2(TAN_G, azimuth_cos)
    half = np.arcsin(np.minimum(r * np.sin(q / 2), 1.0))
    up, out = np.cos(2 * half), np.sin(2 * half)
    # components: along (1,1,1)/sqrt 3; towards the middle of the edge, (1,1,-2)/sqrt 6; along the edge,
    # (1,-1,0)/sqrt 2
    middle, side = up / np.sqrt(3.0), out * azimuth_cos / np.sqrt(6.0)
    edge = out * azimuth_sin / np.sqrt(2.0)
    result = np.empty_like(size)
    result[rows, i], result[rows, j] = middle + side + edge, middle + side - edge
    result[rows, k] = middle - 2 * side
    # principal planes and axes without a trace across them
    result = np.where(size == 0, 0.0, np.maximum(result, 0.0))
    return np.where(location < 0, -result, result)


def places_of(direction: np.ndarray) -> np.ndarray:
    """(n, 3): the places on the octahedron of directions (n, 3) of any length."""
    direction = np.asarray(direction, float)
    unit = np.abs(direction) / np.linalg.norm(direction, axis=1, keepdims=True)
    rows = np.arange(len(unit))
    k = unit.argmin(axis=1)
    i, j = (k + 1) % 3, (k + 2) % 3
    a, b, c = unit[rows, i], unit[rows, j], unit[rows, k]
    side, edge = (a + b - 2 * c) / np.sqrt(6.0), (a - b) / np.sqrt(2.0)
    out = np.hypot(side, edge)
    azimuth = np.arctan2(edge, side)
    z = np.arctan2(out, unit.sum(axis=1) / np.sqrt(3.0))
    q = np.arctan2(TAN_G, np.cos(azimuth))
    r = np.minimum(np.sin(z / 2) / np.sin(q / 2), 1.0)
    t = (azimuth + np.arccos(np.clip(np.sin(azimuth) * COS_G, -1, 1)) - np.pi / 2) / PART
    result = np.empty_like(unit)
    result[rows, k] = (1 - r) / 3
    result[rows, i], result[rows, j] = (1 - r) / 3 + r * (1 + t) / 2, (1 - r) / 3 + r * (1 - t) / 2
    return np.where(direction < 0, -result, result)


def middles(level: int, numbers: np.ndarray) -> np.ndarray:
    """(n, 3): the directions of the middles of cells."""
    return directions(places(level, numbers))


# --- The points of one round of an atlas: a case with its torque turned to a direction and, on request,
# with another wheel momentum
AXES, THRUSTERS, OWN = -1, -2, -3  # in the place of a level: directions with a name, exactly as they are
AXIS_POINTS = 6


class Point(NamedTuple):
    """A direction beside a wheel. wheel: which momentum; level, number: of the cell whose middle it is; or
    AXES and twice the axis, one more where it is against it; or THRUSTERS and which; or OWN, 0."""

    wheel: int
    level: int
    number: int


@dataclass(frozen=True)
class Pointed:
    """torque: its size, N m; wheels: momenta along the principal axes, N m s; all exact. certify: whether
    fates and times are to be proved, whatever that takes."""

    torque: Fraction
    wheels: tuple[Exact3, ...]
    points: tuple[Point, ...]
    certify: bool = False

    def told(self) -> dict[str, Any]:
        """For JSON."""
        return {"torque": str(self.torque), "wheels": [list(map(str, wheel)) for wheel in self.wheels],
                "points": self.points, "certify": self.certify}

    def case(self, case: Case, number: int) -> Case:
        """The case with the torque and the wheel of a point."""
        point = self.points[number]
        direction = self._middles.get(number) or named_direction(case, point.level, point.number)
        torque = tuple(self.torque * Fraction(part) for part in direction)
        wheel = without_trace(self.wheels[point.wheel], torque)
        body = case.scene.body  # type: ignore[union-attr]
        effects = effect_class("gyrostat")(wheel), effect_class("constant_torque")(torque)
        return replace(case, scene=Scene(body, *effects))

    @cached_property
    def _middles(self) -> dict[int, list[float]]:
        """Of every point that is a cell."""
        result: dict[int, list[float]] = {}
        for level in {point.level for point in self.points if point.level >= 0}:
            at = [n for n, point in enumerate(self.points) if point.level == level]
            result |= dict(zip(at, middles(level, np.array([self.points[n].number for n in at])).tolist()))
        return result


def pointed_from(printed: dict[str, Any]) -> Pointed:
    """The points that `printed` wrote down."""
    wheels = tuple(tuple(map(Fraction, wheel)) for wheel in printed["wheels"])
    return Pointed(Fraction(printed["torque"]), wheels, tuple(Point(*item) for item in printed["points"]),
                   printed["certify"])


def named_direction(case: Case, kind: int, number: int) -> Exact3:
    """A unit vector along the principal axes: exact for an axis, to 240 bits else."""
    if kind == AXES:
        return tuple(Fraction((1 - 2 * (number % 2)) * (axis == number // 2)) for axis in range(3))
    turned = (case.scene.vector("constant_torque") if kind == OWN  # type: ignore[union-attr]
              else along_axes(case, case.thrusters[number].torque))
    return unit_vector(turned)


def along_axes(case: Case, vector: Exact3) -> Exact3:
    """The components along the principal axes of a vector in the frame of the file."""
    return vector if case.frame is None else case.frame.turned(vector)


# --- The cells of an atlas at their depths: which lies beside which, and which are to be cut because the
# answer changes across an edge
class Leaves(NamedTuple):
    """wheel, level, number: (n,) of each cell, together the whole sphere once for every wheel; in order along
    it."""

    wheel: np.ndarray
    level: np.ndarray
    number: np.ndarray

    @property
    def begin(self) -> np.ndarray:
        """(n,): where each cell begins on the line of the deepest cells."""
        return self.number << 2 * (DEEPEST - self.level)

    def order(self) -> np.ndarray:
        """The order by wheel and along the sphere."""
        return np.lexsort((self.begin, self.wheel))

    def taken(self, rows: np.ndarray) -> Leaves:
        """Some of them."""
        return Leaves(*(column[rows] for column in self))

    def holding(self, wheel: int, places: np.ndarray) -> np.ndarray:
        """(n,): rows of the cells that hold places (n, 3) on the octahedron, beside one wheel; cells in
        order."""
        own = np.flatnonzero(self.wheel == wheel)
        deepest = int(self.level[own].max())
        at = cell_at(deepest, places) << 2 * (DEEPEST - deepest)
        return own[np.searchsorted(self.begin[own], at, side="right") - 1]

    def beside(self) -> np.ndarray:
        """(pairs, 2): rows of cells that share an edge, or a part of one: each cell with those of its
        neighbours that are as large as it is, or larger."""
        begin, pairs = self.begin, []
        for wheel in np.unique(self.wheel):
            own = np.flatnonzero(self.wheel == wheel)
            starts = begin[own]
            for level in np.unique(self.level[own]):
                rows = own[self.level[own] == level]
                nearby = neighbours(int(level), self.number[rows]) << 2 * (DEEPEST - level)
                # the cell that holds the first part of the neighbour
                holder = own[np.searchsorted(starts, nearby, side="right") - 1]
                rest = self.level[holder] <= level  # a neighbour that is cut finds this one from its own side
                pairs.append(np.stack([np.repeat(rows, 3)[rest.ravel()], holder[rest]], axis=1))
        return np.concatenate(pairs)

    def to_cut(self, kinds: np.ndarray, deepest: int) -> np.ndarray:
        """Rows of cells, less deep than `deepest`, beside one of another kind."""
        pairs = self.beside()
        differ = pairs[kinds[pairs[:, 0]] != kinds[pairs[:, 1]]].ravel()
        return np.unique(differ[self.level[differ] < deepest])

    def children(self, rows: np.ndarray) -> Leaves:
        """The four parts of each of these cells."""
        four = np.repeat(rows, 4)
        return Leaves(self.wheel[four], self.level[four] + 1,
                      4 * self.number[four] + np.tile(np.arange(4), len(rows)))
