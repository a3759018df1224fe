"""Vectors of three components of any kind of number."""
from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from typing import Any

Number = Any  # a number of any kind: double, array of doubles, ball, affine, exact, symbol
Given = Any  # a number as a user gives it, "2/3" among them; the field that takes it keeps a double
# Three of a kind; what a loop makes has no length that a type could tell.
Triple = tuple[Number, ...]
Exact3 = tuple[Fraction, ...]
Float3 = tuple[float, ...]
CYCLE = ((1, 2), (2, 0), (0, 1))  # axis i -> (j, k)


def cross(u: Sequence[Number], v: Sequence[Number]) -> Triple:
    """Vector product of two triples of any scalar type."""
    return (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])


def dot(u: Sequence[Number], v: Sequence[Number]) -> Number:
    """Scalar product of two triples of any scalar type."""
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]


def cross_matrix(v: Sequence[Number]) -> tuple[Triple, Triple, Triple]:
    """Rows of the matrix that takes a vector w to v x w, any scalar type."""
    x, y, z = v
    zero = x * 0
    return (zero, -z, y), (z, zero, -x), (-y, x, zero)


def nearest_first(pairs: Iterable[tuple[float, int, int]]) -> dict[int, int]:
    """i -> j of pairs (distance, i, j), the nearest of all first, each i and each j once."""
    result: dict[int, int] = {}
    for _, i, j in sorted(pairs):
        if i not in result and j not in result.values():
            result[i] = j
    return result
