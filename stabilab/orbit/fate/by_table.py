"""Fates of many states on circles and hyperbolas, read from the table of barriers.

Terms and bounds of rounding are those of a margin to 1e-12 of its terms; a state whose margin they leave
open, or that stands near a tie, a fold, an equilibrium or an invariant plane, is left to the general formula.
"""
from __future__ import annotations

import numpy as np

from ...numbers.constants import TURN
from .table import (
    ANGLE,
    BEND,
    BULK,
    GROWTH,
    HIGH,
    LEAD,
    LOW,
    ORIGIN,
    SIDE,
    SIGN,
    STEEP,
    WIDTH,
    BarrierTable,
)

SIGN_BOUND = 320 * 2.0**-52  # five times the units of rounding that the general formula allows for
# Terms smaller than these shares of the rounding's scale are left to the general formula, to keep a margin to
# 1e-12 of its terms: that allows 9 units of rounding of the scale on circles, 1.8 on hyperbolas, whose scale
# is a cruder bound; of the curves' own terms the check of a cell allows 4.
CIRCLE_MARGIN_BOUND, HYPERBOLA_MARGIN_BOUND = 2e-3, 4e-4
FOLD_BOUND = 1e-10  # nearer to a fold, relative, the general formula answers
# so near to a barrier, in turns, it is not clear here whether it stands ahead or a turn away
TURN_BOUND = 1e-4
FORCE_BOUND = 1e-11  # a force so small may be an equilibrium's
PLANE_BOUND = 1e-9  # so near to an invariant plane the general formula answers
FAR = 1e6  # rounding of the place may be this many times the radius
CHUNK = 8192  # a dozen temporary arrays of this length fit a core's own cache
KEPT = 1 << 22  # bytes, more than all temporary arrays of a chunk; fresh pages for them would double the time
WALLS = 3  # code of `fate.Reason`


def label_by_table(table: BarrierTable, states, out) -> np.ndarray:
    """Fill the columns of `out` for states (n, 3) and return the indices of those that the general formula
    has to answer."""
    # freed at once: glibc then keeps that much free memory instead of returning it after every chunk
    np.empty(KEPT, np.int8)
    unsure = [np.zeros(0, np.intp)]
    for start in range(0, len(states), CHUNK):
        part = slice(start, min(start + CHUNK, len(states)))
        columns = {name: column[part] for name, column in out.items()}
        found = _labelled(table, states[part], columns)
        unsure.append(np.nonzero(found)[0] + start)
    return np.concatenate(unsure)


def _labelled(table, states, out):
    """Fill the columns of a chunk; (n,) which of them the general formula has to answer."""
    heights, bound = ((circle_heights, CIRCLE_MARGIN_BOUND) if table.e < 0
                      else (hyperbola_heights, HYPERBOLA_MARGIN_BOUND))
    x, z, w = canonical(table, states)
    energy = 0.5 * w * w
    with np.errstate(all="ignore"):
        height, scale, clear = heights(table, x, z)
        margin = height - energy
        np.multiply(margin, table.unit, out=out["margins"])
        sure = np.isposinf(height) | _trusted(margin, height, energy, scale, bound)
    out["labels"][:], out["reasons"][:] = 0, WALLS
    if table.e < 0:  # on hyperbolas walls stand on both sides
        np.less(margin, 0, out=out["labels"].view(bool))
        np.add(out["labels"], np.isneginf(height), out=out["reasons"])
    out["axis"][:] = out["labels"] * np.int8(table.axis)
    out["sense"][:] = out["labels"] * np.int8(table.sense)
    return ~(clear & sure)


def canonical(table: BarrierTable, states):
    """The canonical variables (X, Z, W), three arrays (n,), of states (n, 3)."""
    i, j, k = table.axes
    sj, fj, sk, fk, s, fi, _ = table.frame
    return (states[:, j] + sj) * fj, (states[:, k] + sk) * fk, (states[:, i] + s) * fi


def _looked_up(columns, r, size):
    """(coefficients of each state's cell, its place in the cell from -1 to 1); inside the range the place is
    exact."""
    count = columns.shape[1]
    u = np.sqrt(np.maximum(r[SIDE] * (size - r[ORIGIN]), 0.0))
    position = np.minimum(u / (r[BEND] * u + r[WIDTH]), 1.0) * count
    cell = np.minimum(position.astype(np.intp), count - 1)
    return [np.take(c, cell, mode="clip") for c in columns], 2 * (position - cell) - 1


def _height(c, t):
    return c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * (c[4] + t * c[5]))))


def _force(table, x, z):
    G, c, d, mu = table.form
    return mu + (G * x + c) * z + d * x


def _terms(table, rounding):
    """Size of the terms of the potential but its tilt, at places whose magnitudes add up to `rounding`."""
    G, c, d, _ = table.form
    return rounding * (abs(G) * rounding + abs(c) + abs(d))


def _trusted(margin, height, energy, scale, bound):
    """True where the sign of a margin is certain and its digits are as good as the general formula's; false
    for NaN."""
    whole = scale + energy
    return (np.abs(margin) > SIGN_BOUND * whole) & (np.abs(height) + energy > bound * whole)


def _off_fold(size, origin, rounding):
    return np.abs(size - origin) > FOLD_BOUND * (rounding + abs(origin))


def circle_heights(table, x, z):
    """(height, scale, clear), arrays (n,), of places on circles, in canonical units.

    The height is that of the barrier ahead over the place; it is -inf where no barrier stands ahead. The
    scale is the size of the terms that the height is made of. A place is clear where it is certain which
    barrier stands ahead.
    """
    G, c, d, mu = table.form
    size, rounding = np.sqrt(x * x + z * z), np.abs(x) + np.abs(z) + table.frame[6]
    phase = np.arctan2(x, z)
    best, clear = np.full(x.shape, -np.inf), rounding < FAR * size
    for r, columns in zip(table.ranges, table.columns):
        clear &= _off_fold(size, r[ORIGIN], rounding)
        inside = (r[LOW] < size) & (size <= r[HIGH])
        cell, t = _looked_up(columns, r, size)
        offset = cell[ANGLE] + cell[ANGLE + 1] * t - phase / TURN
        whole = np.floor(offset)  # turns from the state to the barrier, rounded down
        known = np.abs((offset - whole) - 0.5) < 0.5 - TURN_BOUND
        height = _height(cell, t) + r[GROWTH] * size + mu * TURN * whole
        clear &= (known & (height == height)) | ~inside
        best = np.where(inside & (height > best), height, best)
    scale = mu * (TURN + rounding / size) + _terms(table, rounding)
    clear &= np.abs(_force(table, x, z)) > FORCE_BOUND * scale
    y = x if G > 0 else z
    return best + (mu * phase + 0.5 * abs(G) * y * y + c * x - d * z), scale, clear


def hyperbola_heights(table, x, z):
    """As `circle_heights` for places on hyperbolas, +inf without a barrier: an orbit has one at most, for two
    would take three wells between and beside them, and five equilibria."""
    G, c, d, mu = table.form
    rounding = np.abs(x) + np.abs(z) + table.frame[6]
    xi, eta = x + z, x - z
    size = -xi * eta
    scale, height = _terms(table, rounding), np.full(x.shape, np.inf)
    clear = np.minimum(np.abs(xi), np.abs(eta)) > PLANE_BOUND * rounding
    clear &= np.abs(_force(table, x, z)) > FORCE_BOUND * (scale + mu)
    for r, columns in zip(table.ranges, table.columns):
        clear &= _off_fold(size, r[ORIGIN], rounding * rounding)
        place = xi if r[LEAD] > 0 else eta
        inside = np.nonzero((r[LOW] < size) & (size <= r[HIGH]) & (place * r[SIGN] > 0))[0]
        cell, t = _looked_up(columns, r, size[inside])
        u, v, place = x[inside], z[inside], np.abs(place[inside])
        tilt = mu * r[LEAD] * np.log(place)
        height[inside] = _height(cell, t) + tilt + ((0.5 * G * u + c) * u + d * v)
        wide = rounding[inside]
        scale[inside] += np.abs(tilt) + mu * (1 + wide / place) + r[STEEP] * wide * wide + r[BULK]
    return height, scale, clear
