"""Margins of rows on hyperbolas and parabolas against the barrier that is nearest in height, in twofold
numbers: a small motion keeps its digits though the orbit is thousands of times as large.
"""
from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from functools import lru_cache
from types import SimpleNamespace
from typing import TYPE_CHECKING

import numpy as np

from ..numbers.double_double import EPS, Twofold
from .landscape import ROUNDINGS, Landscape, TwofoldConstants, twofold_constant, twofold_places
from .potential import derivatives_on_parabola

if TYPE_CHECKING:
    from .reduction import Reduction

# of the kinetic energy and the barrier's height: half of the rounding that `fate` admits
MARGIN_SHARE = 5e-13
NEWTON_STEPS = 4  # of Newton's method at a barrier
# of the way along the orbit: the next step would be some 1e-26, of which the energy's error takes account
SETTLED = 1e-13
ENOUGH = 1e-12  # of the way to the nearest other equilibrium, or of one: the last step leaves its square
TWOFOLD = 2.0**-100  # units of rounding of a twofold sum of some terms, by their size
DRIFT = 1e-3  # of the way: farther from the doubles' place another equilibrium may have been found
ROUNDED = 8  # units of rounding of a height, by the size of its terms
LAG = 0.3  # below it y - sinh y is a series
QUARTIC = 64  # roundings of a height on a parabola, by the size of its terms: some thirty sums and products
FORCE = 16  # roundings of a force in doubles, by the size of its terms
THIRD = twofold_constant(Fraction(1, 3))
NAMES = "p", "p0", "q", "q0", "kappa", "rho", "sigma", "m", "s"


def valley_margins(land: Landscape, states: np.ndarray, critical: Sequence[np.ndarray] | None = None):
    """(margins (n,), +inf without a barrier; which of them are certain (n,)) of states (n, 3) on hyperbolas
    or parabolas, in canonical units.

    critical: what `land.critical` says of the barriers along their orbits, where it is known already.
    """
    critical = land.critical(land.start(states)[0], barriers_only=True) if critical is None else critical
    margins, energy, error, sure = (_on_parabolas if land.conic is None
                                    else _on_hyperbolas)(land, states, critical)
    with np.errstate(invalid="ignore"):
        clear = (np.abs(margins) > ROUNDINGS
                 * error) & (error <= MARGIN_SHARE * (np.abs(margins + energy) + energy))
    return margins, sure & (clear | np.isposinf(margins))


# -- on hyperbolas: barriers by Newton's method, heights measured from these


def _on_hyperbolas(land, states, critical):
    """(margins, kinetic energies, errors, where the barriers are certain), (n,) each; wells, of which an
    orbit has twice as many, play no part."""
    rough, there, places = _barriers(*critical)
    location, w, size = land.start(states)
    x, z = twofold_places(land.twofold, land.reduction.j, land.reduction.k, states)
    height, error, sure = np.full(there.shape, np.inf), np.zeros(there.shape), np.array(there)
    offset, kinetic, rows = np.full(there.shape, np.inf), 0.5 * w * w, np.nonzero(there)[0]
    with np.errstate(all="ignore"):
        X, Z = (Twofold(v.high[rows], v.low[rows]) for v in (x, z))
        u, v = (Twofold(p[there], np.zeros(len(rows))) for p in places)
        u, v, slope, last = _settled(land, u, v, X, Z)
        pull, tilt, astray = _left_over(land, u.high, v.high, X.high, Z.high, tuple(s[rows] for s in size),
                                        last)
        route = _way(u, v, X, Z)
        rise, rounding = _rise(land, -route, u.value(), v.value(), slope, pull, tilt)
        height[there] = -kinetic[rows] - rise
        error[there] = (rounding + ROUNDED * EPS * kinetic[rows]
                        + np.abs(land.potential.force(location))[rows] * astray)
        offset[there] = route
        nearby = np.abs(route - rough[there]) <= DRIFT
        sure[there] = (np.abs(last) <= ENOUGH) & nearby & (slope > 0) & np.isfinite(height[there])
        apart = (np.diff(offset, axis=1) > 0) | ~there[:, 1:]
    certain = ((sure | ~there).all(axis=1) & apart.all(axis=1)
               & ~_beside_fold(land, location, size) & ~land.beside_centre(location))
    if not there.shape[1]:
        return np.full(len(states), np.inf), kinetic, np.zeros(len(states)), certain
    item, nearest = np.arange(len(states)), np.argmin(np.abs(height), axis=1)
    return height[item, nearest], kinetic, error[item, nearest], certain


def _barriers(offsets: np.ndarray, places: np.ndarray, barrier: np.ndarray):
    """(offsets (n, m) in ascending order, which are there, (X, Z) there) of the barriers, in as few columns
    as hold them."""
    xi, eta = places
    offsets = np.where(barrier, offsets, np.inf)
    order = np.argsort(offsets, axis=1, kind="stable")[:, :int(barrier.sum(axis=1).max(initial=0))]
    offsets, there, xi, eta = (np.take_along_axis(v, order, axis=1) for v in (offsets, barrier, xi, eta))
    return offsets, there, (0.5 * (xi + eta), 0.5 * (xi - eta))


def _beside_fold(land: Landscape, index: Sequence[np.ndarray], size: Sequence[np.ndarray]):
    """(n,) True where the rounding of a place, of that size of terms, may make or unmake a pair of equilibria
    of its orbit."""
    Q, rounding, beside = land.invariant(index), (size[0] + size[1]) ** 2, np.zeros(np.shape(index[0]), bool)
    for edge in land.conic.fold_invariants + land.conic.tangents:
        beside |= ~(np.abs(Q - edge) > ROUNDINGS * EPS * (rounding + abs(edge)))
    return beside


def _settled(land, u, v, X, Z):
    """(places, slopes and last steps) of the equilibria next to (u, v) on the orbits of (X, Z), all (k,)."""
    k = land.twofold
    Q, last, live = Z * Z - X * X, np.full(len(u.high), np.nan), np.arange(len(u.high))
    for _ in range(NEWTON_STEPS):
        some, other, step = _stepped(k, *(Twofold(a.high[live], a.low[live]) for a in (u, v, Q)))
        for full, part in ((u, some), (v, other)):
            full.high[live], full.low[live] = part.high, part.low
        last[live] = step
        live = live[np.abs(step) > SETTLED]  # false for no number too
        if not live.size:
            break
    return u, v, _slope(k, u, v), last


def _slope(k: TwofoldConstants, u: Twofold, v: Twofold):
    return (k.G * (v * v + u * u) + k.c * u + k.d * v).value()


def _stepped(k: TwofoldConstants, u: Twofold, v: Twofold, Q: Twofold):
    """(places, step) after one step of Newton's method from (u, v), brought onto the orbit Q before."""
    off = (v * v - u * u - Q).value() / (2 * (u.high * u.high + v.high * v.high))
    u, v = u + off * u.high, v + -off * v.high
    step = -(k.mu + k.G * u * v + k.c * v + k.d * u).value() / _slope(k, u, v)
    step = np.where(np.abs(step) < 0.1, step, np.nan)
    half = 0.5 * step * step
    return u + v * step + u * half, v + u * step + v * half, step


def _left_over(land: Landscape, u: np.ndarray, v: np.ndarray, X: np.ndarray, Z: np.ndarray,
               size: Sequence[np.ndarray], last: np.ndarray):
    """What 32 digits and Newton's last step leave open, (k,) each: of the force at the equilibria (u, v) and
    of its slope, and of the ways from the states (X, Z), whose coordinates are sums of terms of that
    `size`."""
    k, far = land.conic, np.abs(u) + np.abs(v)
    wide = size[0] + size[1]
    # of a place beside its orbit, whose own size is off by TWOFOLD * wide^2
    off = TWOFOLD * (far + wide * wide / far)
    steep = abs(k.G) * far + abs(k.c) + abs(k.d)
    bent = (2 * abs(k.G) * far + steep) * far * last * last
    side = np.where(X * Z < 0, -1.0, 1.0)
    start, end = np.abs(X + side * Z), np.abs(u + side * v)
    return steep * off + TWOFOLD * k.mu + bent, (abs(k.G) * far
                                                 + steep) * off, TWOFOLD * wide / start + off / end


def _way(u: Twofold, v: Twofold, X: Twofold, Z: Twofold):
    """theta from the states (X, Z) to places on their orbits: X + Z grows and X - Z decays like an
    exponential, and the larger of these keeps its digits next to a plane too."""
    side = np.where(X.high * Z.high < 0, -1.0, 1.0)
    start, end = X + Z * side, u + v * side
    grown, ratio = ((end - start) / start).value(), (end / start).value()
    return side * np.where(np.abs(grown) < 0.5, np.log1p(grown), np.log(ratio))


def _rise(land: Landscape, y: np.ndarray, u: np.ndarray, v: np.ndarray, slope: np.ndarray, pull: np.ndarray,
          tilt: np.ndarray):
    """(V(y) - V(0), its error) a way y from equilibria (u, v) with this slope of the force; pull, tilt: what
    the force and its slope may be off by. With S = sinh y, h = sinh(y/2), A = G u v, B = G (u^2 + v^2)/2:

    V(y) - V(0) = -2 slope h^2 - mu (y - S) - 2 A S h^2 - 4 B h^4; the terms of the slope, which nearly
    cancel, are summed before."""
    pot, t = land.potential, y * y
    s, h2 = np.sinh(y), np.sinh(0.5 * y) ** 2
    short = -y * t / 6 * (1 + t / 20 * (1 + t / 42 * (1 + t / 72 * (1 + t / 110))))
    lag = np.where(np.abs(y) < LAG, short, y - s)
    terms = -2 * slope * h2, -pot.mu * lag, -2 * pot.G * u * v * s * h2, -2 * pot.G * (
        u * u + v * v) * h2 * h2
    error = (ROUNDED + 2 * np.abs(y)) * EPS * sum(map(np.abs, terms)) + pull * np.abs(s) + 2 * tilt * h2
    return sum(terms), error


# -- on parabolas: heights are quartics of the way


@lru_cache(maxsize=64)
def constants(reduction: Reduction) -> SimpleNamespace:
    """Those of a reduction to parabolas as twofold numbers, of the same names."""
    return SimpleNamespace(**{name: twofold_constant(getattr(reduction, name)) for name in NAMES})


def _on_parabolas(land: Landscape, states: np.ndarray, critical: Sequence[np.ndarray]):
    """(margins (n,), +inf without a barrier; kinetic energies; errors; where it is certain which equilibria
    there are) of states (n, 3).

    The potential is stationary at the barrier, so the double of the way to it serves: what it leaves open is
    of second order. A force that is a cubic with walls on both sides has one barrier at most.
    """
    r, pot, none = constants(land.reduction), land.potential, np.zeros(len(states))
    index, w, _ = land.start(states)
    with np.errstate(all="ignore"):
        offsets, _, barrier = critical
        there = barrier.any(axis=1)
        y = offsets[np.arange(len(states)), np.argmax(barrier, axis=1)]
        u, v, speed = Twofold(index[0], none), Twofold(index[1], none), r.s + states[:, land.reduction.axis]
        force = r.kappa * u * v + r.rho * v + r.sigma * u + r.m
        first, second, third = derivatives_on_parabola(r, u, v)
        height = -(((third * THIRD * 0.125 * y + second * THIRD * 0.5) * y + first * 0.5) * y + force) * y
        margins = (height - speed * speed * 0.5).value()
        sizes = pot.terms(index), *pot.derivative_terms(index)
        size, blur, left_over, slope = (_sum(f, np.abs(y) if f is sizes else y, over) for f, over in (
            (sizes, (1, 2, 6, 24)), (sizes, (1, 1, 2, 6)),
            ((pot.force(index), *pot.derivatives(index)), (1, 1, 2, 6)),
            (pot.derivatives(index), (1, 1, 2))))
        error = (QUARTIC * TWOFOLD * (np.abs(y) * size + w * w)
                 + (np.abs(left_over) + FORCE * EPS * blur) ** 2 / slope)
    sure = ~land.beside_fold(index) & ((slope > 0) | ~there)
    return np.where(there, margins, np.inf), 0.5 * w * w, np.where(there, error, 0.0), sure


def _sum(terms: Sequence[np.ndarray], y: np.ndarray, over: Sequence[int]):
    """The polynomial in y whose coefficients are terms, lowest power first, over these numbers."""
    value = 0.0
    for term, number in zip(reversed(terms), reversed(over)):
        value = value * y + term / number
    return value
