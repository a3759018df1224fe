"""Tables of the barriers' heights over the orbit's invariant, on which alone they depend (built once per
scene); `by_table` reads them.

A barrier's place and height are analytic in u = sqrt|size - fold|, size the radius A of a circle or the
invariant Q of a hyperbola, and, where its branch of equilibria runs to infinity, in v = u/(u + width) up to v
= 1. Cells of equal length in v hold polynomials through Chebyshev points; each cell is checked between its
points against the general formula, and one that misses by more than `LOSS` units of rounding of the
potential's terms is left out: states in it, like all that are near a tie, a fold or an equilibrium, are
answered by the general formula.
"""
from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from ...numbers.constants import EPS, TURN
from ..landscape import Landscape, landscape

# Of an orbit's range of sizes (radius A of a circle, invariant Q of a hyperbola) on which one barrier stands:
# low < size <= high; v = u/(bend u + width), u = sqrt|size - origin|, measured from the fold at `origin`,
# side the sign; growth: the part of the height that is linear in A. Hyperbola: lead = +1 where xi keeps
# the sign `sign`, -1 where eta does; steep: bound of d height/dQ; bulk: size of the terms of the height.
LOW, HIGH, ORIGIN, SIDE, BEND, WIDTH, GROWTH, LEAD, SIGN, STEEP, BULK = range(11)
# coefficients 0..5 of a height, then, on circles, 6..7 of the barrier's angle in turns
DEGREE, ANGLE = 5, 6
CELLS = (512, 2048, 8192)  # tried in turn
FAR_ASYMPTOTES = 100  # times the fold's radius
# share of cells that may be left out before more are tried: 8192 cost a tenth of a second, a row left out a
# microsecond
GAPS = 0.01, 0.02, 1.0
LOSS = 4.0  # units of rounding: polynomial and general formula take two each
# of the gaps: where four times as many cells leave more of these, they are rounding, and no more cells are
# tried
WORTH = 0.5
ANGLE_LOSS = 1e-5  # turns; a tenth of the distance at which an angle is trusted
CHECKS = np.array([-0.985, -0.85, -0.55, -0.2, 0.3, 0.7, 0.93])  # none of them a Chebyshev point


@dataclass(frozen=True, eq=False)
class BarrierTable:
    """The barriers of a scene as arrays.

    e: -1 circles, +1 hyperbolas. axes: indices (i, j, k) of the state's columns. frame: shifts, factors and
    the rounding of the place; form: G, c, d, mu. ranges (B, 11); cells (B, N, 8), NaN where left out. unit:
    energy of the scene per canonical unit. axis, sense: of a spin-up. gaps: share of the cells that were left
    out.
    """

    e: int
    axes: tuple[int, int, int]
    frame: tuple[float, ...]
    form: tuple[float, float, float, float]
    ranges: np.ndarray
    cells: np.ndarray
    unit: float
    axis: int
    sense: int
    gaps: float

    @cached_property
    def columns(self) -> np.ndarray:
        """(B, 8, N): the cells, coefficient by coefficient."""
        return np.ascontiguousarray(self.cells.transpose(0, 2, 1))


@lru_cache(maxsize=16)
def barrier_table(scene) -> BarrierTable | None:
    """The table of a scene (cached); None without a torque that has a reduction to circles or hyperbolas, and
    where the equilibria lie on straight lines."""
    land = landscape(scene)
    if land is None or land.sense == 0 or land.conic is None or land.conic.lines or not land.conic.pieces:
        return None
    spans = list(_spans(land))
    if any(span is None for span in spans):
        return None
    with np.errstate(all="ignore"):
        ranges, cells, gaps = _tabulated(land, spans)
    r, g = land.reduction, land.reduction.constants
    frame = (g["sj"], g["flip"] / g["rx"], g["sk"], 1 / g["rz"], float(r.s), g["flip"] * g["n"],
             abs(g["sj"] / g["rx"]) + abs(g["sk"] / g["rz"]))
    return BarrierTable(land.e, (r.axis, r.j, r.k), frame, tuple(g[n] for n in ("G", "c", "d", "mu")), ranges,
                        cells, r.energy_unit, r.axis + 1, land.sense, gaps)


def _spans(land: Landscape):
    """(piece, low, high, origin, side, bend, width) of every stretch of a barrier branch with one fold at its
    end."""
    conic = land.conic
    kind = _curve_of(land)
    sizes = kind.sizes(conic.fold_invariants)
    for piece in conic.pieces:
        if not piece.barrier:
            continue
        ends = sorted(float(s) for f, s in zip(conic.folds, sizes)
                      if f * piece.sign > 0 and abs(f) in (piece.inner, piece.outer))
        if len(ends) == 2:
            middle = 0.5 * (ends[0] + ends[1])
            yield piece, ends[0], middle, ends[0], 1.0, 0.0, np.sqrt(middle - ends[0])
            yield piece, middle, ends[1], ends[1], -1.0, 0.0, np.sqrt(ends[1] - middle)
        elif len(ends) == 1 and kind.reaches_out:
            yield from _out_from(conic, piece, ends[0])
        else:
            yield None


def _out_from(conic, piece, fold):
    """The stretches of a branch from its fold out: one, or two where the conic's asymptotes are so far off
    that cells measured by the fold would all stand before them."""
    far = max(abs(conic.c / conic.G), abs(conic.shift))
    if far <= FAR_ASYMPTOTES * fold:
        yield piece, fold, np.inf, fold, 1.0, 1.0, np.sqrt(fold)
        return
    middle = np.sqrt(fold * far)
    yield piece, fold, middle, fold, 1.0, 0.0, np.sqrt(middle - fold)
    yield piece, middle, np.inf, middle, 1.0, 1.0, np.sqrt(far)


def _tabulated(land, spans):
    """(ranges (B, 11), cells (B, N, 8), share of cells left out) with as many cells as it takes."""
    before = np.inf
    for count, allowed in zip(CELLS, GAPS):
        made = [_stretch(land, span, count) for span in spans]
        cells = np.array([c for _, c in made]).reshape(len(spans), count, DEGREE + 3)
        gaps = float(np.isnan(cells[:, :, 0]).mean()) if spans else 0.0
        if gaps <= allowed or gaps > WORTH * before:
            break
        before = gaps
    return np.array([r for r, _ in made]).reshape(len(spans), 11), cells, gaps


def _stretch(land, span, count):
    """(range (11,), cells (count, 8)) of one stretch."""
    piece, low, high, origin, side, bend, width = span
    nodes = np.cos(np.pi * (np.arange(DEGREE + 1) + 0.5) / (DEGREE + 1))[::-1]
    t = np.concatenate([nodes, CHECKS])
    v = (np.arange(count)[:, None] + 0.5 * (1 + t)) / count
    size = origin + side * (width * v / (1 - bend * v)) ** 2
    curve = _curve_of(land)(land, piece, np.isinf(high))
    height, turns, scale = curve.values(size)
    at, between = slice(None, DEGREE + 1), slice(DEGREE + 1, None)
    heights, angles = _fit(nodes, height[:, at], DEGREE), _fit(nodes, turns[:, at], 1)
    good = (np.abs(_value(heights, t[between]) - height[:, between]).max(axis=1)
            <= LOSS * EPS * scale.min(axis=1))
    good &= np.abs(_value(angles, t[between]) - turns[:, between]).max(axis=1) <= ANGLE_LOSS
    cells = np.where(good[:, None], np.concatenate([heights, angles], axis=1), np.nan)
    return [low, high, origin, side, bend, width, curve.growth, *curve.lead_sign_steep_bulk], cells


def _fit(nodes, values, degree):
    """(cells, degree + 1) coefficients of least squares at Chebyshev points; of interpolation at the full
    degree."""
    # fit what varies in the cell alone: its rounding is what the fit enlarges
    middle = values[:, len(nodes) // 2]
    coefficients = (values - middle[:,
                                    None]) @ np.linalg.pinv(np.vander(nodes, degree + 1, increasing=True)).T
    coefficients[:, 0] += middle
    return coefficients


def _value(coefficients, t):
    value = np.zeros((len(coefficients), len(t)))
    for c in coefficients.T[::-1]:
        value = c[:, None] + t * value
    return value


class _Circle:
    """Height and angle of a barrier branch over the radius, without what grows like A^2 or A."""

    lead_sign_steep_bulk = (0.0, 0.0, 0.0, 0.0)
    reaches_out = True  # an open end is tabulated too
    sizes = np.sqrt  # an orbit's size of its invariant

    def __init__(self, land, piece, is_open):
        self.land, self.piece, self.is_open, self.growth = land, piece, is_open, 0.0

    def values(self, size):
        pot, flat = self.land.potential, size.ravel()
        x, z, exists = self.land.conic._meet_piece(self.piece, flat * flat)
        thin = self.land.conic._nearly_straight(flat * flat)
        if thin.any():
            x[thin], z[thin], exists[thin] = self._on_line(flat[thin] ** 2)
        start = np.zeros(flat.shape), flat
        offset, (x, z), exists = self.land.located(start, flat * flat, x, z, exists)
        offset[~exists] = np.nan
        offset[exists] = np.unwrap(offset[exists])
        middle = 0.5 * (np.nanmin(offset) + np.nanmax(offset)) if exists.any() else 0.0
        offset -= TURN * np.round(middle / TURN)
        height = -pot.mu * offset + self._bounded(x, z, flat)
        scale = TURN * pot.mu + flat * (abs(pot.G) * flat + abs(pot.c) + abs(pot.d))
        return tuple(v.reshape(size.shape) for v in (height, offset / TURN, scale))

    def _on_line(self, Q):
        """(X, Z, exists) where the conic is nearly a line, as `Conic.critical_places` finds it: the barrier
        of its two points."""
        (x, z, exists), (other_x, other_z, _) = self.land.conic._meet_line(self.land.conic.limit, Q)
        first = self.land.potential.slope((x, z)) > 0
        return np.where(first, x, other_x), np.where(first, z, other_z), exists

    def _bounded(self, x, z, size):
        """-G X^2/2 - c X + d Z (G < 0: plus G A^2/2) less growth A, which leaves a bounded function."""
        pot = self.land.potential
        far, near, factor = (z, x, pot.d) if pot.G > 0 else (x, z, -pot.c)
        if not self.is_open:
            return -0.5 * abs(pot.G) * near * near - pot.c * x + pot.d * z
        side = np.sign(far[np.nanargmax(size)])
        self.growth = float(factor * side)
        with np.errstate(all="ignore"):  # far - side A without cancellation
            remainder = np.where(far * side > 0, -side * near * near / (size + side * far), far - side * size)
        other = -pot.c * x if pot.G > 0 else pot.d * z
        return -0.5 * abs(pot.G) * near * near + other + factor * remainder


class _Hyperbola:
    """Height of a barrier branch over the invariant, tilt measured by the logarithm of the coordinate that
    keeps its sign; no angle."""

    growth = 0.0
    reaches_out = False
    sizes = np.asarray

    def __init__(self, land, piece, is_open):
        self.land, self.piece = land, piece

    def values(self, size):
        pot, g, flat = self.land.potential, self.land.reduction.constants, size.ravel()
        x, z, exists = self.land.conic._meet_piece(self.piece, flat)
        start = x + z, x - z
        _, (xi, eta), exists = self.land.located(start, flat, x, z, exists)
        xi, eta = (np.where(exists, v, np.nan) for v in (xi, eta))
        lead = (1.0 if np.nanmin(np.abs(xi)) / np.nanmax(np.abs(xi)) > np.nanmin(np.abs(eta))
                / np.nanmax(np.abs(eta)) else -1.0)
        place = xi if lead > 0 else eta
        x, z = 0.5 * (xi + eta), 0.5 * (xi - eta)
        tilt = pot.mu * lead * np.log(np.abs(place))
        height = -tilt - (0.5 * pot.G * x + g["c"]) * x - g["d"] * z
        scale = np.abs(tilt) + pot.mu + np.abs(x) * (abs(pot.G * x) + abs(g["c"])) + abs(g["d"] * z)
        steep = (np.abs(pot.G * x) + abs(g["c"]) + abs(g["d"])) / np.abs(place)
        sign = float(np.sign(np.nanmedian(place)))
        self.lead_sign_steep_bulk = (lead, sign, float(np.nanmax(steep)), float(np.nanmax(scale)))
        return tuple(v.reshape(size.shape) for v in (height, np.zeros(height.shape), scale))


def _curve_of(land):
    """How a branch of barriers is tabulated on the geometry of a landscape."""
    return {-1: _Circle, 1: _Hyperbola}[land.e]
