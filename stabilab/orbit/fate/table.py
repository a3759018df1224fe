"""Fates of many states by a table of the barriers over the scene.

Tables of the barriers' heights over the orbit's invariant, on which alone they depend (built once per scene).

A barrier's place and height are analytic in u = sqrt|size - fold|, size the radius A of a circle or the
invariant Q of a hyperbola, and, where its branch of equilibria runs to infinity, in v = u/(u + width) up to v
= 1. Cells of equal length in v hold polynomials through Chebyshev points; each cell is checked between its
points against the general formula, and one that misses by more than `LOSS` units of rounding of the
potential's terms is left out: states in it, like all that are near a tie, a fold or an equilibrium, are
answered by the general formula. On hyperbolas a cell knows the barrier's place too, from which twofold
numbers answer what its height leaves open.
"""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache, partial
from typing import NamedTuple

import numpy as np

from ...numbers.constants import EPS, TURN
from ..fine.places import twofold_constant
from ..landscape import Landscape, landscape
from . import table_kernel as arithmetic
from .table_kernel import ANGLE, BEND, BULK, DEGREE, GROWTH, HIGH, LEAD, LOW, ORIGIN, SIDE, SIGN, STEEP, WIDTH

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
PLACE_LOSS = 1e-4  # relative, of a place on a hyperbola that two steps of Newton's method follow
CHECKS = np.array([-0.985, -0.85, -0.55, -0.2, 0.3, 0.7, 0.93])  # none of them a Chebyshev point


@dataclass(frozen=True, eq=False)
class BarrierTable:
    """The barriers of a scene as arrays (see `barrier_heights`).

    e: -1 circles, +1 hyperbolas, 0 parabolas, which have neither ranges nor cells: there `ranges` holds (p,
    p0, b) of a place's way, u' = p v + p0, v' = b, and form kappa, rho, sigma, m of the force. axes: indices
    (i, j, k) of the state's columns. frame: shifts, factors and the rounding of the place; form: G, c, d, mu.
    ranges (B, 11); cells (B, N, 8), NaN where left out. unit: energy of the scene per canonical unit. axis,
    sense: of a spin-up. gaps: share of the cells that were left out. fine (21,): of hyperbolas, the constants
    in 32 digits; else empty.
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
    fine: np.ndarray

    @cached_property
    def columns(self) -> np.ndarray:
        """(B, 8, N): the cells, coefficient by coefficient."""
        return np.ascontiguousarray(self.cells.transpose(0, 2, 1))


@lru_cache(maxsize=16)
def barrier_table(scene) -> BarrierTable | None:
    """The table of a scene (cached); None without a torque that has a reduction, and where the equilibria lie
    on straight lines."""
    land = landscape(scene)
    if land is not None and land.sense and land.conic is None:
        return _without_cells(land)
    if land is None or land.sense == 0 or land.conic.lines or not land.conic.pieces:
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
                        cells,
                        r.energy_unit, r.axis + 1, land.sense, gaps, _curve_of(land).fine(land))


def _without_cells(land: Landscape) -> BarrierTable | None:
    """What parabolas have instead of a table, whose barriers a formula gives; None where the force along them
    is no cubic."""
    r = land.reduction
    if not r.kappa or not (r.p and r.q0 or r.q and r.p0):
        return None
    j, k, form, numbers = r.j, r.k, (r.kappa, r.rho, r.sigma, r.m), (r.p, r.p0, r.q0)
    if r.q:  # the component with a steady rate comes second
        j, k, form, numbers = r.k, r.j, (r.kappa, r.sigma, r.rho, r.m), (r.q, r.q0, r.p0)
    if numbers[0] * r.kappa > 0:
        return None
    return BarrierTable(land.e, (r.axis, j, k), (0.0, 1.0, 0.0, 1.0, float(r.s), 1.0, 0.0),
                        tuple(map(float, form)),  # type: ignore[arg-type]  # four
                        np.array([numbers], float), np.empty((1, 0, DEGREE + 3)), r.energy_unit, r.axis + 1,
                        land.sense, 0.0, np.empty(0))


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
    height, second, scale = curve.values(size)
    at, between = slice(None, DEGREE + 1), slice(DEGREE + 1, None)
    heights, seconds = _fit(nodes, height[:, at], DEGREE), _fit(nodes, second[:, at], 1)
    good = (np.abs(_value(heights, t[between]) - height[:, between]).max(axis=1) <= LOSS * EPS
            * scale.min(axis=1))
    near = (np.abs(_value(seconds, t[between])
                   - second[:, between]) <= curve.second_loss(second[:, between])).all(axis=1)
    good &= near | ~curve.both  # on hyperbolas either serves without the other
    near &= good | ~curve.both
    cells = np.concatenate([np.where(good[:, None], heights, np.nan),
                            np.where(near[:, None], seconds, np.nan)], axis=1)
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
    both = np.bool_(True)  # whether a cell is of no use without the angle

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

    @staticmethod
    def second_loss(turns):
        """What a barrier's angle may be off by."""
        return ANGLE_LOSS

    @staticmethod
    def fine(land):
        """No numbers for a second look."""
        return np.empty(0)

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
    keeps its sign; and that coordinate."""

    growth = 0.0
    reaches_out = False
    sizes = np.asarray
    both = np.bool_(False)

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
        return tuple(v.reshape(size.shape) for v in (height, place, scale))

    @staticmethod
    def second_loss(place):
        """What a barrier's place may be off by."""
        return PLACE_LOSS * np.abs(place)

    @staticmethod
    def fine(land):
        """The numbers of `table_kernel.fine_margin`."""
        r = land.reduction
        numbers = *land.twofold, twofold_constant(r.exact_constants["n"] ** 2 / 2), twofold_constant(r.s)
        return np.array([*(part for number in numbers for part in (float(number.high), float(number.low))),
                         land.least_invariant])


def _curve_of(land):
    """How a branch of barriers is tabulated on the geometry of a landscape."""
    return {-1: _Circle, 1: _Hyperbola}[land.e]


# --- The fates of many states are read from the table of barriers: by NumPy in chunks, or by numba's
# compiled loops
CHUNK = 8192  # a dozen temporary arrays of this length fit a core's own cache
KEPT = 1 << 22  # bytes, more than all temporary arrays of a chunk; fresh pages for them would double the time
WALLS = 3  # code of `fate.Reason`


def label_by_table(table: BarrierTable, states, out, compiled=None) -> np.ndarray:
    """Fill the columns of `out` for states (n, 3) and return the indices of those that the general formula
    has to answer.

    compiled: the loops of `fast_fate`, or None for NumPy; both give the same bytes.
    """
    # freed at once: glibc then keeps that much free memory instead of returning it after every chunk
    np.empty(KEPT, np.int8)
    unsure = [np.zeros(0, np.intp)]
    for start in range(0, len(states), CHUNK):
        part = slice(start, min(start + CHUNK, len(states)))
        columns = {name: column[part] for name, column in out.items()}
        columns["reasons"][:] = WALLS
        columns["labels"][:] = 0
        found = (_compiled(table, states[part], columns, compiled) if compiled
                 else way_of(table).labelled(table, states[part], columns))
        columns["axis"][:] = columns["labels"] * np.int8(table.axis)
        columns["sense"][:] = columns["labels"] * np.int8(table.sense)
        unsure.append(np.nonzero(found)[0] + start)
    rows = np.concatenate(unsure)
    return _looked_at_again(table, states, rows, out["margins"]) if table.fine.size and not compiled else rows


def _compiled(table, states, out, compiled):
    unsure = np.empty(len(states), bool)
    numbers = (table.fine,) if table.fine.size else ()
    compiled[table.e](states, table.axes, table.frame, table.form, table.ranges, table.cells, table.unit,
                      out["margins"],
                      out["labels"], out["reasons"], unsure, *numbers)
    return unsure


def _looked_at_again(table, states, rows, margins):
    """Of rows (m,) on hyperbolas that the table's doubles leave open, fill the margins that twofold numbers
    settle, and return the others."""
    left = [np.zeros(0, np.intp)]
    for start in range(0, len(rows), CHUNK):
        part = rows[start:start + CHUNK]
        found, sure = _fine_margins(table, states[part])
        margins[part[sure]] = found[sure] * table.unit
        left.append(part[~sure])
    return np.concatenate(left)


def _fine_margins(table, states):
    """(margins (m,) in canonical units, which of them are certain) of states on hyperbolas, against the
    barrier whose place the table knows."""
    i, j, k = table.axes
    x, z, w = canonical(table, states)
    rounding = np.abs(x) + np.abs(z) + table.frame[6]
    found, sure = np.full(len(states), np.inf), np.zeros(len(states), bool)
    with np.errstate(all="ignore"):
        size, clear = _off_edges(table, x, z, rounding)
        for r, columns in zip(table.ranges, table.columns):
            rows = _on_range(r, x, z, size, clear)
            if not rows.size:
                continue
            (slope, t), fine, near = _looked_up(columns[ANGLE:], r, size[rows]), table.fine, rounding[rows]
            X, Z, kinetic = arithmetic.fine_place(*(states[rows, axis] for axis in (i, j, k)), fine)
            Q = arithmetic.fine_invariant(X, Z)
            u, v = arithmetic.guessed(arithmetic.angle_polynomial(*slope, t), r[LEAD], Q[0])
            for _ in range(2):
                u, v = arithmetic.double_step(u, v, Q[0], table.form)
            u, v, step, slope = arithmetic.fine_step(u, v, Q, fine)
            side, end, grown = arithmetic.ratio_of(X, Z, u, v)
            found[rows], good = arithmetic.fine_margin(X, Z, kinetic, u, v, step, slope, side, end, grown,
                                                       *np.frexp(1 + grown[0]), near, fine)
            sure[rows] = good & (np.abs(Q[0]) > fine[20])
    return found, sure


def _off_edges(table, x, z, rounding):
    """(invariants, whether a place is far from planes, folds and equilibria) of places on hyperbolas."""
    xi, eta = x + z, x - z
    size, mu = -xi * eta, table.form[3]
    clear = np.minimum(np.abs(xi), np.abs(eta)) > arithmetic.PLANE_BOUND * rounding
    clear &= (np.abs(arithmetic.force(x, z, table.form)) > arithmetic.FORCE_BOUND
              * (arithmetic.terms(rounding, table.form) + mu))
    for r in table.ranges:
        clear &= arithmetic.fold_is_clear(size, r[ORIGIN], rounding * rounding)
    return size, clear


def _on_range(r, x, z, size, clear=True):
    """The rows on whose orbits the barrier of a range stands."""
    place = x + z if r[LEAD] > 0 else x - z
    return np.nonzero(clear & (r[LOW] < size) & (size <= r[HIGH]) & (place * r[SIGN] > 0))[0]


def canonical(table, states):
    """Return the canonical variables (X, Z, W), three arrays (n,), of states (n, 3)."""
    i, j, k = table.axes
    sj, fj, sk, fk, s, fi, _ = table.frame
    return (states[:, j] + sj) * fj, (states[:, k] + sk) * fk, (states[:, i] + s) * fi


def _circles(table, states, out):
    x, z, w = canonical(table, states)
    energy = 0.5 * w * w
    with np.errstate(all="ignore"):
        height, scale, clear = circle_heights(table, x, z)
        margin = height - energy
        np.multiply(margin, table.unit, out=out["margins"])
        np.less(margin, 0, out=out["labels"].view(bool))
        np.add(out["labels"], np.isneginf(height), out=out["reasons"])
        return ~(clear & arithmetic.trusted(margin, height, energy, scale, arithmetic.MARGIN_BOUND))


def circle_heights(table, x, z):
    """Return (height, scale, clear), arrays (n,), of places on circles, in canonical units.

    The height is that of the barrier ahead over the place; it is -inf where no barrier stands ahead. The
    scale is the size of the terms that the height is made of. A place is clear where it is certain which
    barrier stands ahead.
    """
    form, mu = table.form, table.form[3]
    size, rounding = np.sqrt(x * x + z * z), np.abs(x) + np.abs(z) + table.frame[6]
    phase = arithmetic.angle(x, z)
    turns = phase * arithmetic.TURNS
    best, clear = np.full(x.shape, -np.inf), rounding < arithmetic.FAR * size
    for r, columns in zip(table.ranges, table.columns):
        clear &= arithmetic.fold_is_clear(size, r[ORIGIN], rounding)
        inside = (r[LOW] < size) & (size <= r[HIGH])
        c, t = _looked_up(columns, r, size)
        whole, known = arithmetic.ahead(arithmetic.angle_polynomial(*c[ANGLE:], t), turns)
        height = arithmetic.height_polynomial(*c[:ANGLE], t) + r[GROWTH] * size
        height = height + mu * TURN * whole
        clear &= (known & (height == height)) | ~inside
        best = np.where(inside & (height > best), height, best)
    scale = mu * (TURN + rounding / size) + arithmetic.terms(rounding, form)
    clear &= np.abs(arithmetic.force(x, z, form)) > arithmetic.FORCE_BOUND * scale
    return best + arithmetic.circle_height(x, z, phase, form), scale, clear


def _looked_up(columns, r, size):
    """(coefficients of each state's cell, its place in the cell from -1 to 1)."""
    count = columns.shape[1]
    position = arithmetic.cell_position(size, r[SIDE], r[ORIGIN], r[BEND], r[WIDTH], count)
    cell = np.minimum(position.astype(np.intp), count - 1)
    return [np.take(c, cell, mode="clip") for c in columns], 2 * (position - cell) - 1


def _valleys(table, states, out, heights, bound):
    """On hyperbolas and parabolas, whose heights are +inf without a barrier."""
    x, z, w = canonical(table, states)
    energy = 0.5 * w * w
    with np.errstate(all="ignore"):
        height, scale, clear = heights(table, x, z)
        margin = height - energy
        np.multiply(margin, table.unit, out=out["margins"])
        return ~(clear & (np.isposinf(height) | arithmetic.trusted(margin, height, energy, scale, bound)))


def hyperbola_heights(table, x, z):
    """As `circle_heights` for places on hyperbolas, +inf without a barrier: an orbit has one at most, for two
    would take three wells between and beside them, and five equilibria."""
    form, mu = table.form, table.form[3]
    G, c, d, _ = form
    rounding = np.abs(x) + np.abs(z) + table.frame[6]
    size, clear = _off_edges(table, x, z, rounding)
    scale, height = arithmetic.terms(rounding, form), np.full(x.shape, np.inf)
    for r, columns in zip(table.ranges, table.columns):
        inside = _on_range(r, x, z, size)
        coefficients, t = _looked_up(columns, r, size[inside])
        u, v = x[inside], z[inside]
        place = u + v if r[LEAD] > 0 else u - v
        tilt = mu * r[LEAD] * arithmetic.logarithm(*np.frexp(np.abs(place)))
        here = arithmetic.height_polynomial(*coefficients[:ANGLE], t) + tilt
        height[inside] = here + ((0.5 * G * u + c) * u + d * v)
        scale[inside] = arithmetic.hyperbola_scale(scale[inside], tilt, rounding[inside], place, mu, r[STEEP],
                                                   r[BULK])
    return height, scale, clear


def parabola_heights(table, u, v):
    """As `hyperbola_heights`, for places on parabolas: by a formula, no table."""
    return arithmetic.parabola_height(u, v, table.form, tuple(table.ranges[0]))


class _Way(NamedTuple):
    """Of a geometry: heights over places, how a chunk is labelled, and whether a state above its height spins
    up."""

    heights: Callable
    labelled: Callable
    spins_up: bool


GEOMETRIES = {-1: _Way(circle_heights, _circles, True),
              1: _Way(hyperbola_heights,
                      partial(_valleys, heights=hyperbola_heights, bound=arithmetic.CONE_MARGIN_BOUND),
                      False),
              0: _Way(parabola_heights,
                      partial(_valleys, heights=parabola_heights, bound=arithmetic.PARABOLA_MARGIN_BOUND),
                      False)}


def way_of(table: BarrierTable) -> _Way:
    """How the states of a table are answered."""
    return GEOMETRIES[table.e]
