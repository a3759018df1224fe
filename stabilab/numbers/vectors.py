"""Vectors of three components of any kind of number."""
from __future__ import annotations

from fractions import Fraction

Exact3 = tuple[Fraction, Fraction, Fraction]
CYCLE = ((1, 2), (2, 0), (0, 1))  # axis i -> (j, k)


def cross(u, v):
    """Vector product of two triples of any scalar type."""
    return (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])


def dot(u, v):
    """Scalar product of two triples of any scalar type."""
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]
