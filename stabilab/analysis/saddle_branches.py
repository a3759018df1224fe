"""The branches of saddles, each from its fold outward: the edges along which the sheets of a separatrix hang."""
from __future__ import annotations

import numpy as np

from .landscape import Landscape


def sides(land):
    """Which way loops leave a saddle, and the word for it: against the torque on a tilted circle, both ways otherwise."""
    if land.e < 0 and land.sense:
        return ((-1, ""),)
    return ((-1, ", left loop"), (1, ", right loop"))


def saddle_branches(land: Landscape, reach):
    """For every branch of saddles its place (a pair of arrays) as a function of s in [0, 1], s = 0 at the fold.

    reach: how far out, as a multiple of the radius sqrt|Q| of the outermost fold.
    """
    conic = land.conic
    base = [abs(q) for q in conic.fold_invariants]
    for line in conic.lines:
        base.append(abs(_line_foot(conic, line)[1]) or abs(conic.K / conic.G if conic.G and conic.K else 1.0))
    limit = max(base, default=1.0) * reach * reach
    for piece in conic.pieces:
        if piece.barrier:
            for low, high in _split(conic, piece, limit):
                yield _along_piece(land, piece, low, high)
    for line in conic.lines:
        for low, high in _line_intervals(land, line, limit):
            yield _along_line(land, line, low, high)


def _split(conic, piece, limit):
    """|h| intervals of a piece inside the limit on |Q|, starting at a fold, cut where Q = 0 (a plane)."""
    ends = []
    for q in (limit, -limit):
        _, z, exists = conic._meet_piece(piece, np.array([q]))
        if exists[0]:
            ends.append(abs(z[0] + conic.shift))
    inner, outer = piece.inner, piece.outer
    if np.isinf(outer):
        outer = max(ends) if ends else None
    if inner == 0:
        inner = min(ends) if ends else None
    if inner is None or outer is None or not inner < outer:
        return
    cuts = [inner, outer]
    if conic.e > 0:
        _, z, exists = conic._meet_piece(piece, np.array([0.0]))
        if exists[0]:
            plane = abs(z[0] + conic.shift)
            if inner < plane < outer:
                cuts = [inner, plane, outer]
    for low, high in zip(cuts, cuts[1:]):
        yield (high, low) if abs(high - piece.inner) > 0 and high == piece.outer else (low, high)


def _along_piece(land, piece, start, end):
    def place(s):
        h = piece.sign * (start + (end - start) * s)
        x, z = land.conic.at(h)
        return _as_place(land, x, z)
    place.piece = piece
    return place


def _line_foot(conic, line):
    """(t, Q) where the invariant is stationary along a line."""
    e = conic.e
    a = line.dz**2 - e * line.dx**2
    t = -(line.z0 * line.dz - e * line.x0 * line.dx) / a if a else 0.0
    x, z = line.x0 + t * line.dx, line.z0 + t * line.dz
    return t, z * z - e * x * x


def _line_intervals(land, line, limit):
    """Intervals of t on a line where it holds saddles, each from its inner end outward."""
    conic = land.conic
    knots = [_line_foot(conic, line)[0]]
    if conic.G:  # where the two lines cross
        knots.append(-conic.d / conic.G - line.z0 if line.dz else -conic.c / conic.G - line.x0)
    far = (2 * np.sqrt(limit) + abs(line.x0) + abs(line.z0)) / np.hypot(line.dx, line.dz) + max(abs(k) for k in knots)
    knots = sorted({-far, *knots, far})
    for low, high in zip(knots, knots[1:]):
        t = 0.5 * (low + high)
        spot = _as_place(land, np.array([line.x0 + t * line.dx]), np.array([line.z0 + t * line.dz]))
        if land.potential.slope(spot)[0] > 0:
            yield (low, high) if abs(low) < abs(high) else (high, low)


def _along_line(land, line, start, end):
    def place(s):
        t = start + (end - start) * s
        return _as_place(land, line.x0 + t * line.dx, line.z0 + t * line.dz)
    return place


def _as_place(land, x, z):
    return (x, z) if land.e < 0 else (x + z, x - z)
