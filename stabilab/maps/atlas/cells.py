"""Cells of equal area on the sphere of directions: triangles of an octahedron, whose corners are the principal axes.

The projection is Snyder's (Cartographica 29, 1992), with the octahedron in place of the icosahedron. A face is cut from its middle into six right
triangles; in each a plane one of angles 60, 90 and 30 degrees stands for the spherical one of 60, 90 and 45. A ray from the middle at the share t of the
way from the middle of an edge to its end cuts off the area t pi/12, and within a ray the area grows as the square of sin(z/2), z the angle from the middle:

    tan(azimuth) = sin(t pi/12)/(cos(t pi/12) - cos g),   cos g = sqrt(2/3),   sin(z/2) = r sin(q/2),   tan q = tan g/cos(azimuth).

So areas are kept, and plane triangles of one size are cells of one area at any depth, each cut into four of its own by the middles of its edges. Why not
HEALPix or a latitude and longitude grid: a body has the symmetries of its three axes, and so have these cells. Reflections in the principal planes
and exchanges of axes map cells onto cells, the planes are edges, and no middle of a cell lies on a principal axis or plane, where a verdict need
not be that of its neighbours.

A place on the octahedron |x| + |y| + |z| = 1 is told by its three coordinates; a cell by its level and its number, the face and then a digit of base 4 for
each cut: 0, 1, 2 for the part at that corner, 3 for the one in the middle.
"""
from __future__ import annotations

from typing import Any

import numpy as np

FACES, DEEPEST = 8, 12
SIGNS = np.array([[1 - 2 * (n >> axis & 1) for axis in range(3)] for n in range(FACES)])  # of the three coordinates on each face
COS_G, TAN_G, PART = np.sqrt(2 / 3), np.sqrt(1 / 2), np.pi / 12
WHOLE = 4 * np.pi


def count(level: int) -> int:
    """Cells of a level on the whole sphere."""
    return FACES * 4**level


def area(level: Any) -> Any:
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


def cell_at(level: int, place: np.ndarray) -> np.ndarray:
    """(n,): the numbers of the cells of a level that hold places (n, 3) on the octahedron."""
    place = np.asarray(place, float)
    number = ((place < 0) * [1, 2, 4]).sum(axis=1).astype(np.int64)
    share = np.abs(place) / np.abs(place).sum(axis=1, keepdims=True)
    for _ in range(level):
        digit = np.where((share > 0.5).any(axis=1), share.argmax(axis=1), 3)
        share = np.where((digit == 3)[:, None], 1 - 2 * share, 2 * share - (np.arange(3) == digit[:, None]))
        number = 4 * number + digit
    return number


def neighbours(level: int, numbers: np.ndarray) -> np.ndarray:
    """(n, 3): the cells of the same level across each edge, over the seams of the faces too."""
    at = corners(level, numbers)
    whole = at.sum(axis=1, keepdims=True)  # three times the middle
    ends = whole - at  # of the edge opposite to each corner: the sum of its two
    seam = (ends == 0) & (at != 0)  # (n, edge, coordinate): the edge lies in a principal plane, and the cell beyond is the mirror image
    place = np.where(seam.any(axis=2, keepdims=True), np.where(seam, -1, 1) * whole, 2 * ends - at)
    return cell_at(level, place.reshape(-1, 3) / (3.0 * 2**level)).reshape(-1, 3)


def directions(place: np.ndarray) -> np.ndarray:
    """(n, 3): unit vectors of places on the octahedron."""
    place = np.asarray(place, float)
    size = np.abs(place)
    rows = np.arange(len(size))
    k = size.argmin(axis=1)  # the corner opposite to the nearest edge
    i, j = (k + 1) % 3, (k + 2) % 3
    least, a, b = size[rows, k], size[rows, i], size[rows, j]
    r = 1 - 3 * least
    along = np.divide(a - b, r, out=np.zeros_like(r), where=r > 0) * PART  # of [-1, 1] from one end of the edge to the other
    across, ahead = np.sin(along), np.cos(along) - COS_G
    far = np.hypot(across, ahead)
    azimuth_sin, azimuth_cos = across / far, ahead / far
    q = np.arctan2(TAN_G, azimuth_cos)
    half = np.arcsin(np.minimum(r * np.sin(q / 2), 1.0))
    up, out = np.cos(2 * half), np.sin(2 * half)
    # components: along (1,1,1)/sqrt 3; towards the middle of the edge, (1,1,-2)/sqrt 6; along the edge, (1,-1,0)/sqrt 2
    middle, side = up / np.sqrt(3.0), out * azimuth_cos / np.sqrt(6.0)
    edge = out * azimuth_sin / np.sqrt(2.0)
    found = np.empty_like(size)
    found[rows, i], found[rows, j], found[rows, k] = middle + side + edge, middle + side - edge, middle - 2 * side
    found = np.where(size == 0, 0.0, np.maximum(found, 0.0))  # principal planes and axes without a trace across them
    return np.where(place < 0, -found, found)


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
    found = np.empty_like(unit)
    found[rows, k] = (1 - r) / 3
    found[rows, i], found[rows, j] = (1 - r) / 3 + r * (1 + t) / 2, (1 - r) / 3 + r * (1 - t) / 2
    return np.where(direction < 0, -found, found)


def middles(level: int, numbers: np.ndarray) -> np.ndarray:
    """(n, 3): the directions of the middles of cells."""
    return directions(places(level, numbers))


def outlines(level: int, numbers: np.ndarray, pieces: int = 4) -> np.ndarray:
    """(n, 3 * pieces, 3): directions along the edges of cells, each edge in so many pieces."""
    at = corners(level, numbers) / 2.0**level
    share = (np.arange(pieces) / pieces)[:, None]
    ways = [at[:, n, None] * (1 - share) + at[:, (n + 1) % 3, None] * share for n in range(3)]
    flat = np.concatenate(ways, axis=1)
    return directions(flat.reshape(-1, 3)).reshape(len(at), 3 * pieces, 3)
