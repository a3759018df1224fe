"""Homoclinic loops of many saddles, NumPy: where the motion that leaves a saddle turns back, and the points
of the loop in between.

Along a loop W = +-sqrt(2 (V_saddle - V(theta))), the difference formed without cancellation, so points lie on
the separatrix to rounding.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .far_centre import replaced, residual_far
from .homoclinic import loop_end
from .seams import PINCH, pinched_shares

SHARPEST = 1e3  # bends tighter than the loop's length over this are not resolved


def polished(land, saddle, s):
    """Return the points of the conic after each was moved along its orbit to where the force vanishes. The
    fold itself stays where it is."""
    moved = land.polished(saddle)
    return tuple(np.where(s > 0, m, v) for m, v in zip(moved, saddle))


def loop_ends(land, saddle, side):
    """(offset of the far end of the loop (n,), centre place (2, n), found (n,), shared (n,)) for saddles (2,
    n), each on its side (n,); shared: it ends at a saddle there, for which this is the loop on the other
    side."""
    pot = land.potential
    ends, centres = np.zeros((2, len(side)))
    there, shared = np.zeros((2, len(side)), bool)
    for row, (x, z, toward) in enumerate(zip(*(v.tolist() for v in (*saddle, side)))):
        found = loop_end(pot, land.sense, (x, z), toward)
        if found:
            there[row] = True
            ends[row], centres[row], shared[row] = found
    return side * ends, np.array(land.polished(pot.move(saddle, side * centres))), there, shared


@dataclass(frozen=True)
class Loops:
    """First halves of loops, from the saddle to the far end, in k strips of n rows and m columns.

    saddle, centre: places (2, k, n); end: (k, n) offsets of the far ends; found: (k, n) whether there is a
    loop; shared: (k, n) whether the far end is a saddle too; offset, w: (k, n, m) offsets and W; points: (k,
    n, m, 3). saddle_state, centre_state: (k, n, 3) the same as states; ways: (k, n, 2) those of
    `far_centre.Orbits` where states and points are told from them, and not from places; else nan.
    """

    saddle: np.ndarray
    centre: np.ndarray
    end: np.ndarray
    found: np.ndarray
    shared: np.ndarray
    offset: np.ndarray
    w: np.ndarray
    points: np.ndarray
    saddle_state: np.ndarray
    centre_state: np.ndarray
    ways: np.ndarray

    @property
    def far(self) -> np.ndarray:
        """(k, n) True where `far_centre` told the loop."""
        return np.isfinite(self.ways[..., 0])

    def at_rows(self, rows) -> Loops:
        """The loops of some rows only."""
        return Loops(*(v[:, :, rows] if name in ("saddle", "centre") else v[:, rows] for name,
                       v in vars(self).items()))

    def of(self, strip) -> Loops:
        """The loops of one strip only."""
        return Loops(*(v[:, strip:strip + 1] if name in ("saddle", "centre") else v[strip:strip + 1] for name,
                       v in vars(self).items()))


def loops(land, strips, s, u) -> Loops:
    """The loops of strips (`seams.Part`, or pairs of branch and side) at parameters s (k, n) along them and u
    (k, m) round them.

    A loop shared with the saddle at its far end is found from the left one only; at s = 0, the fold, it is a
    point.
    """
    k, n = s.shape
    place = np.array([np.broadcast_arrays(*strip[0].place(row)) for strip, row in zip(strips, s)], float)
    saddle = np.array(polished(land, (place[:, 0].ravel(), place[:, 1].ravel()), s.ravel())).reshape(2, k, n)
    sides = np.array([strip[1] for strip in strips])
    end, centre, found, shared = loop_ends(land, tuple(saddle.reshape(2, -1)), np.repeat(sides, n))
    end, found, shared = end.reshape(k, n), found.reshape(k, n), shared.reshape(k, n)
    centre = centre.reshape(2, k, n)
    found &= ~(shared & (sides[:, None] > 0))
    fold = s == 0
    found |= fold
    end = np.where(fold | ~found, 0.0, end)
    centre = np.where(fold, saddle, centre)
    cut = [len(strip) > 2 and strip.seam != 0 for strip in strips]
    sharpest = np.where(cut, 1 / PINCH, SHARPEST)
    shares = _shares(land, saddle, end, shared, u[:, None, :], sharpest)
    for strip in (n for n, part in enumerate(strips) if cut[n] and part.over):
        shares[strip] = pinched_shares(land.potential, saddle[:, strip], end[strip], sides[strip], u[strip])
    offset = end[:, :, None] * shares
    spot = saddle[0][:, :, None], saddle[1][:, :, None]
    with np.errstate(all="ignore"):
        w = np.sqrt(2 * np.maximum(-land.potential.rise(offset, spot), 0))
    w[:, :, 0] = w[:, :, -1] = 0.0
    points = land.components(land.potential.move(spot, offset), sides[:, None, None] * w)
    states = (land.components(one, np.zeros((k, n))) for one in (saddle, centre))
    made = Loops(saddle, centre, end, found, shared, offset, w, points, *states, np.full((k, n, 2), np.nan))
    return replaced(land, strips, s, u, made, lambda sharp, at, rows: _by_turning(sharp, at, sharpest[rows]))


def _shares(land, saddle, end, shared, u, sharpest):
    """(k, n, m) shares of the way to the far end at which columns u (k, 1, m), 0 to 1, stand.

    At the far end, distance t away, W^2 = 2 F t + K t^2 + ...: F the force there, K its slope. That is a
    hyperbola with t = (F/K)(cosh q - 1), and equal steps of q turn the loop's direction evenly, however sharp
    the bend; columns then run along the bend from row to row. No bend tighter than the way over
    sharpest (k,) is followed. Where the far end is a saddle itself, columns crowd at both ends alike.
    """
    if shared.any():
        return np.broadcast_to(np.sin(0.5 * np.pi * u) ** 2, end.shape + u.shape[-1:])
    far = land.potential.move(saddle, end)
    with np.errstate(all="ignore"):
        sharp = np.abs(end) * land.potential.slope(far) / np.abs(land.potential.force(far))
    return _by_turning(sharp, u, sharpest[:, None])


def _by_turning(sharp, u, sharpest):
    """(..., m) shares at columns u, from K/F times the way to the far end, (...,)."""
    sharp = np.clip(np.nan_to_num(sharp), 1e-8, sharpest)
    half = 0.5 * np.log1p(sharp + np.sqrt(sharp * (sharp + 2)))[..., None]  # arccosh(1 + sharp)
    return 1 - (np.sinh(half * (1 - u)) / np.sinh(half)) ** 2


def residual(land, loops):
    """(k, n, m) energy of the rounded points above their saddle's, relative to the size of the energy's
    terms; their offsets from the saddle tell the turn that the angle of a rounded point belongs to. On a
    hyperbola the larger of xi, eta tells the place: next to an open plane the smaller one is all rounding.
    How far the other lies from the saddle's hyperbola, relative to the size of the point, is the residual
    where that is more.
    """
    place, w, size = land.start(loops.points)
    spot = tuple(v[:, :, None] for v in loops.saddle)
    pot = land.potential
    with np.errstate(all="ignore"):
        departure = np.abs(0.5 * w * w + pot.rise(land.way(spot, place, loops.offset), spot))
        shaken, beside = land.blurred(spot, place, size)
        scale = (0.5 * w * w + np.abs(pot.G) * (size[0] ** 2 + size[1] ** 2)
                 + pot.slopes * (size[0] + size[1]) + pot.mu + shaken)
        found = np.fmax(np.where(departure > 0, departure / scale, 0.0), beside)
    if loops.far.any():
        found[loops.far] = residual_far(land, loops)
    return found
