"""The equilibria along the orbits of rows, placed by Newton's method in twofold numbers: ways to them, slopes and heights keep their digits
though the orbit is thousands of times as large as the motion."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...numbers.constants import EPS, TURN
from ...numbers.double_double import Twofold
from ..extremes.turning_points import Spots, spots_along
from ..landscape import ROUNDINGS, Landscape
from .anchored import ROUNDED, Anchored
from .places import twofold_places

STEPS = 4
SETTLED = 1e-13  # of a radian: the next step would be some 1e-26, of which the energy's error takes account
ENOUGH = 1e-12  # of the way to the nearest other equilibrium, or of a radian: the last step leaves its square
TWOFOLD = 2.0**-100  # units of rounding of a twofold sum of some terms, by their size
DRIFT = 1e-3  # of a radian: farther from the doubles' place another equilibrium may have been found


@dataclass(frozen=True)
class FineSpots:
    """spots: as `spots_along` gives them, with the rows of an `Anchored` place; error: (n, m) of the energy; astray: (n, m) of the offset,
    besides its rounding; sure: (n,) where all were placed; x, z, w and xi = x + z, eta = x - z: (n,) of the states."""

    spots: Spots
    error: np.ndarray
    astray: np.ndarray
    sure: np.ndarray
    x: np.ndarray
    z: np.ndarray
    w: np.ndarray
    xi: np.ndarray
    eta: np.ndarray
    place: tuple[np.ndarray, ...]  # as the landscape takes it: next to a plane doubles of x and z would have lost the smaller of xi and eta


def fine_spots(land: Landscape, states, rough: Spots | None = None) -> FineSpots:
    """Those of states (n, 3) on circles or hyperbolas; rough: those to be placed, as doubles have them (None: all)."""
    place, w, size = land.start(states)
    rough = spots_along(land, place, w) if rough is None else rough
    constants = land.twofold  # type: ignore[attr-defined]  # of circles and hyperbolas
    x, z = twofold_places(constants, land.reduction.j, land.reduction.k, states)
    with np.errstate(all="ignore"):
        rows = np.nonzero(rough.there)[0]  # twofold numbers of the equilibria alone, not of what is missing of others
        X, Z = (Twofold(v.high[rows], v.low[rows]) for v in (x, z))
        u, v = (Twofold(p[rough.there], np.zeros(len(rows))) for p in land.xz(rough.place))
        u, v, slope, last = _settled(land, u, v, X, Z)
        left_over = _left_over(land, u.high, v.high, X.high, Z.high, tuple(s[rows] for s in size), last)
        at_x, at_z, slope, last, way, pull, bend, astray = (_spread(rough.there, found) for found in
                                                            (u.value(), v.value(), slope, last, _way(land, u, v, X, Z), *left_over))
        turns = np.round((rough.offset - way) / TURN) if land.turn < np.inf else np.zeros(way.shape)
        turns = np.where(rough.there, turns, 0.0)
        anchors = np.array([at_x, at_z, slope, pull, bend])
        pot, kinetic = Anchored(land.reduction), 0.5 * w[:, None] ** 2
        fall = TURN * pot.mu * turns
        energy = kinetic + pot.rise(-way, anchors) + fall
        error = pot.rounding(-way, anchors) + ROUNDED * EPS * (kinetic + np.abs(fall)) + np.abs(land.potential.force(place))[:, None] * astray
        offset = np.where(rough.there, way + TURN * turns, np.inf)
        good = (np.abs(last) <= ENOUGH) & (np.abs(offset - rough.offset) <= DRIFT) & ((slope > 0) == rough.barrier) & np.isfinite(energy)
        apart = (np.diff(offset, axis=1) > 0) | ~rough.there[:, 1:]
    sure = (good | ~rough.there).all(axis=1) & apart.all(axis=1) & ~_beside_fold(land, place, size) & ~land.beside_centre(place)
    filled = np.where(rough.there, anchors, 1.0)
    return FineSpots(Spots(offset, filled, np.where(rough.there, energy, np.nan), rough.barrier, rough.there), error, astray, sure, x.value(), z.value(), w,
                     (x + z).value(), (x - z).value(), tuple(v.value() for v in land.place(x, z)))


def _beside_fold(land, place, size):
    """(n,) True where the rounding of a place, of that size of terms, may make or unmake a pair of equilibria of its orbit."""
    Q, rounding, beside = land.invariant(place), (size[0] + size[1]) ** 2, np.zeros(np.shape(place[0]), bool)
    for edge in land.conic.fold_invariants + land.conic.tangents:
        beside |= ~(np.abs(Q - edge) > ROUNDINGS * EPS * (rounding + abs(edge)))
    return beside


def _spread(there, values):
    """(n, m) values at their places, NaN elsewhere."""
    out = np.full(there.shape, np.nan)
    out[there] = values
    return out


def _settled(land, u, v, X, Z):
    """(places, slopes and last steps) of the equilibria next to (u, v) on the orbits of (X, Z), all (k,)."""
    k, e = land.twofold, land.e
    Q, last, live = Z * Z - X * X * e, np.full(len(u.high), np.nan), np.arange(len(u.high))
    for _ in range(STEPS):
        some, other, step = _stepped(k, e, *(Twofold(a.high[live], a.low[live]) for a in (u, v, Q)))
        for whole, part in ((u, some), (v, other)):
            whole.high[live], whole.low[live] = part.high, part.low
        last[live] = step
        live = live[np.abs(step) > SETTLED]  # false for no number too
        if not live.size:
            break
    return u, v, (k.G * (v * v + u * u * e) + k.c * u * e + k.d * v).value(), last


def _stepped(k, e, u, v, Q):
    """(places, step) after one step of Newton's method from (u, v), brought onto the orbit Q before."""
    off = (v * v - u * u * e - Q).value() / (2 * (u.high * u.high + v.high * v.high))
    u, v = u + e * off * u.high, v + -off * v.high
    force = k.mu + k.G * u * v + k.c * v + k.d * u
    slope = (k.G * (v * v + u * u * e) + k.c * u * e + k.d * v).value()
    step = -force.value() / slope
    step = np.where(np.abs(step) < 0.1, step, np.nan)
    half = 0.5 * e * step * step
    return u + v * step + u * half, v + u * (e * step) + v * half, step


def _left_over(land, u, v, X, Z, size, last):
    """What 32 digits and Newton's last step leave open, (k,) each: of the force at the equilibria (u, v) and of its slope, and of the ways from the
    states (X, Z), whose coordinates are sums of terms of that `size`."""
    k, far = land.conic, np.abs(u) + np.abs(v)
    wide = size[0] + size[1]
    off = TWOFOLD * (far + wide * wide / far)  # of a place beside its orbit, whose own size is off by TWOFOLD * wide^2
    steep = abs(k.G) * far + abs(k.c) + abs(k.d)
    bent = (2 * abs(k.G) * far + steep) * far * last * last
    side = np.where(X * Z < 0, -1.0, 1.0)
    start, end = (np.abs(X + side * Z), np.abs(u + side * v)) if land.e > 0 else (np.hypot(X, Z), np.hypot(u, v))
    return steep * off + TWOFOLD * k.mu + bent, (abs(k.G) * far + steep) * off, TWOFOLD * wide / start + off / end


def _way(land, u, v, X, Z):
    """theta from the states (X, Z) to places on their orbits, the short way round a circle."""
    if land.e > 0:  # X + Z grows and X - Z decays like an exponential: the larger of these keeps its digits next to a plane too
        side = np.where(X.high * Z.high < 0, -1.0, 1.0)
        start, end = X + Z * side, u + v * side
        grown, ratio = ((end - start) / start).value(), (end / start).value()
        return side * np.where(np.abs(grown) < 0.5, np.log1p(grown), np.log(ratio))
    Q = (Z * Z + X * X).value()
    return np.arctan2((u * Z - v * X).value() / Q, (u * X + v * Z).value() / Q)
