"""The fates of many states are read from the table of barriers: by NumPy in chunks, or by numba's compiled loops."""
from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import numpy as np

from ...numbers.constants import TURN
from . import table_kernel as arithmetic
from .table import BarrierTable
from .table_kernel import ANGLE, BEND, BULK, GROWTH, HIGH, LEAD, LOW, ORIGIN, SIDE, SIGN, STEEP, WIDTH

CHUNK = 8192  # a dozen temporary arrays of this length fit a core's own cache
KEPT = 1 << 22  # bytes, more than all temporary arrays of a chunk; fresh pages for them would double the time
WALLS = 3  # code of `fate.Reason`


def label_by_table(table: BarrierTable, states, out, compiled=None) -> np.ndarray:
    """Fill the columns of `out` for states (n, 3) and return the indices of those that the general formula has to answer.

    compiled: the loops of `fast_fate`, or None for NumPy; both give the same bytes.
    """
    np.empty(KEPT, np.int8)  # freed at once: glibc then keeps that much free memory instead of returning it after every chunk
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
    compiled[table.e](states, table.axes, table.frame, table.form, table.ranges, table.cells, table.unit, out["margins"],
                      out["labels"], out["reasons"], unsure, *numbers)
    return unsure


def _looked_at_again(table, states, rows, margins):
    """Of rows (m,) on hyperbolas that the table's doubles leave open, fill the margins that twofold numbers settle, and return the others."""
    left = [np.zeros(0, np.intp)]
    for start in range(0, len(rows), CHUNK):
        part = rows[start:start + CHUNK]
        found, sure = _fine_margins(table, states[part])
        margins[part[sure]] = found[sure] * table.unit
        left.append(part[~sure])
    return np.concatenate(left)


def _fine_margins(table, states):
    """(margins (m,) in canonical units, which of them are certain) of states on hyperbolas, against the barrier whose place the table knows."""
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
            found[rows], good = arithmetic.fine_margin(X, Z, kinetic, u, v, step, slope, side, end, grown, *np.frexp(1 + grown[0]), near, fine)
            sure[rows] = good & (np.abs(Q[0]) > fine[20])
    return found, sure


def _off_edges(table, x, z, rounding):
    """(invariants, whether a place is far from planes, folds and equilibria) of places on hyperbolas."""
    xi, eta = x + z, x - z
    size, mu = -xi * eta, table.form[3]
    clear = np.minimum(np.abs(xi), np.abs(eta)) > arithmetic.PLANE_BOUND * rounding
    clear &= np.abs(arithmetic.force(x, z, table.form)) > arithmetic.FORCE_BOUND * (arithmetic.terms(rounding, table.form) + mu)
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

    The height is that of the barrier ahead over the place; it is -inf where no barrier stands ahead. The scale is the size of the terms that the
    height is made of. A place is clear where it is certain which barrier stands ahead.
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
    """As `circle_heights` for places on hyperbolas, +inf without a barrier: an orbit has one at most, for two would take
    three wells between and beside them, and five equilibria."""
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
        scale[inside] = arithmetic.hyperbola_scale(scale[inside], tilt, rounding[inside], place, mu, r[STEEP], r[BULK])
    return height, scale, clear


def parabola_heights(table, u, v):
    """As `hyperbola_heights`, for places on parabolas: by a formula, no table."""
    return arithmetic.parabola_height(u, v, table.form, tuple(table.ranges[0]))


class _Way(NamedTuple):
    """Of a geometry: heights over places, how a chunk is labelled, and whether a state above its height spins up."""

    heights: Callable
    labelled: Callable
    spins_up: bool


GEOMETRIES = {-1: _Way(circle_heights, _circles, True),
              1: _Way(hyperbola_heights, partial(_valleys, heights=hyperbola_heights, bound=arithmetic.CONE_MARGIN_BOUND), False),
              0: _Way(parabola_heights, partial(_valleys, heights=parabola_heights, bound=arithmetic.PARABOLA_MARGIN_BOUND), False)}


def way_of(table: BarrierTable) -> _Way:
    """How the states of a table are answered."""
    return GEOMETRIES[table.e]
