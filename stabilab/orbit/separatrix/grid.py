"""Rows and columns of a sheet, graded so that its flat facets stray from the surface about equally everywhere.

A facet's edge with steps (du, ds) of the parameters strays from a surface r(u, s) with unit normal n by
|L du^2 + 2 M du ds + N ds^2|/8, where L = r_uu.n, M = r_us.n, N = r_ss.n. Differences on a small trial grid give them:
columns stand uniformly in the integral of sqrt|L|, rows in that of sqrt|N|, each for the worst of the others; as for a picture, columns
follow the outline too. The finished grid is measured in the same way. Grids within an asked-for distance are those of `within`, which begin
with the same trial rows.
"""
from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from .far_centre import shrinks_far
from .homoclinic_arrays import Loops, loops
from .saddles import PLANE
from .seams import Part, parted

TRIAL = 17              # rows and columns of the trial grid
FLOOR = 0.3             # of the mean density: no gap where a sheet happens to be straight
STRAIGHT = 1e-6         # of a sheet's size: a lesser sag between neighbours of the trial grid does not matter
TAIL = 10.0 ** -np.arange(3, 6.1, 0.5)  # 1 - s of the last trial rows towards a plane Q = 0
NEAR = 1e-6             # a first row this near to the fold where the loop there is no point
DENSE = 129             # steps along a branch that trial rows are chosen from
UNIFORM = 0.2           # of the fold's radius: up to there trial rows are uniform
MOST = 1025             # rows and columns, at most, of a grid within an accuracy


@dataclass(frozen=True)
class Grid:
    """The graded loops of k parts of strips; cut: +1 where quads of the first half are cut from (row, column) to (row + 1, column + 1), -1
    the other way; error: (k,) largest distance of facets from the surface."""

    loops: Loops
    cut: int
    error: np.ndarray
    parts: list[Part]


def grid(land, strips, shape) -> Grid:
    """The graded loops of strips, pairs (branch, side), in the shape (rows, columns of a half)."""
    parts, rows = [Part(*strip) for strip in strips], np.array([_trial_rows(land, *strip) for strip in strips])
    columns = np.broadcast_to(np.linspace(0, 1, TRIAL), rows.shape)
    made, edge = measured_loops(land, parts, rows, columns)
    grading = _grading(made, _second_forms(land, made), _outline(land, made, np.full(len(parts), -1)), edge[1], rows, columns)
    rows, columns = (even_steps(length, at, number) for (length, at), number in zip(grading, shape))
    made, edge = measured_loops(land, parts, rows, columns)
    strays = np.maximum(_stray(*_second_forms(land, made), np.array([1, -1])[:, None, None, None]), edge[1])  # type: ignore[call-arg]
    best = int(np.argmin(strays.max(axis=1)))
    return Grid(made, (1, -1)[best], strays[best], parts)


@lru_cache(maxsize=64)
def trial_parts(land, strips):
    """(parts of strips, cut at their seams, trial rows of each). They are kept, for the next surface of the same scene."""
    parts, rows = [Part(*strip) for strip in strips], np.array([_trial_rows(land, *strip) for strip in strips])
    if len(cut := parted(land, strips, rows[:, 0])) > len(parts):
        parts, rows = cut, np.array([_trial_rows_of(land, part) for part in cut])
    return parts, rows


def _grading(made, forms, bends, edge, rows, columns):
    """(lengths of rows and their parameters, those of columns), from the second forms of a grid at parameters rows (k, n) and columns (k, m), and
    from the bends of the outline."""
    across, _, down = forms
    straight = STRAIGHT * np.abs(made.points).max() * (TRIAL / max(rows.shape[1], columns.shape[1])) ** 2
    long_columns = _density(np.concatenate([across, bends[:, None]], axis=1), 1, ((0, 0), (1, 0)), straight)
    return (_density(down, 2, ((0, 0), (1, 1)), straight, 8 * edge), rows), (long_columns, columns)


def measured_loops(land, parts, s, u):
    """(loops at rows s, how far the chords between the first two rows, and between the last two, stray from the sheet (2, k)): inner rows do not tell how
    much it bends beyond them, towards a plane Q = 0 without bound, so rows in between are measured."""
    more = np.concatenate([s[:, :1], 0.5 * (s[:, :1] + s[:, 1:2]), s[:, 1:-1], 0.5 * (s[:, -2:-1] + s[:, -1:]), s[:, -1:]], axis=1)
    all_ = loops(land, parts, np.array([part.rows(row) for part, row in zip(parts, more)]), u)
    kept = np.delete(np.arange(more.shape[1]), (1, -2))
    return all_.at_rows(kept), np.array([_sag(all_, 0, 1, 2), _sag(all_, -1, -2, -3)])


def _sag(loops, first, between, last):
    """(k,) how far the chords from the row `first` to `last` stray from the sheet, by the row in between."""
    before, middle, after = (loops.points[:, row] for row in (first, between, last))
    chord, way = (after - before)[:, 1:-1], (middle - before)[:, 1:-1]
    normal = np.cross(chord, middle[:, 2:] - middle[:, :-2])
    size = np.maximum(np.linalg.norm(normal, axis=-1), np.finfo(float).tiny)
    part = np.sum(way * chord, axis=-1) / np.maximum(np.sum(chord * chord, axis=-1), np.finfo(float).tiny)
    part = np.clip(part, 0.1, 0.9)  # of the chord, where the row in between passes; the sag is largest at a half
    sag = np.abs(np.sum(way * normal, axis=-1)) / size / (4 * part * (1 - part))
    return np.where(loops.found[:, (first, between, last)].all(axis=1), sag.max(axis=1), 0.0)


def _second_forms(land, loops):
    """(L, M, N), each (k, n - 2, m - 1), per step of the grid, at inner rows and all columns but the first: beyond the
    far end the loop comes back as its mirror image. 0 beside rows without a loop."""
    r = past_far_end(land, loops.points)
    dot = lambda a, b: np.einsum("cknm,cknm->knm", a, b)
    here, round_ = r[:, :, 1:-1, 1:-1], r[..., 2:] - r[..., :-2]
    a, b = r[:, :, 2:, 1:-1] - r[:, :, :-2, 1:-1], round_[:, :, 1:-1]
    normal = np.stack([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])
    size = np.sqrt(dot(normal, normal))
    whole = loops.found[:, 2:] & loops.found[:, 1:-1] & loops.found[:, :-2]
    normal *= whole[:, :, None] / np.maximum(size, np.finfo(float).tiny)
    if loops.shared.any():  # the far end is a saddle, a corner of the loop and no bend
        normal[:, loops.shared[:, 1:-1], -1] = 0
    return (dot(r[:, :, 1:-1, 2:] - 2 * here + r[:, :, 1:-1, :-2], normal),
            0.25 * dot(round_[:, :, 2:] - round_[:, :, :-2], normal),
            dot(r[:, :, 2:, 1:-1] - 2 * here + r[:, :, :-2, 1:-1], normal))


def past_far_end(land, points):
    """(3, ..., m + 1) components of points (..., m, 3) with one column beyond the far end."""
    r = np.empty((3, *points.shape[:-2], points.shape[-2] + 1))
    r[..., :-1], axis = np.moveaxis(points, -1, 0), land.reduction.axis
    r[..., -1] = r[..., -3]
    r[axis, ..., -1] = 2 * r[axis, ..., -2] - r[axis, ..., -3]
    return r


def _outline(land, loops, edge):
    """(k, m - 1) how the rows edge (k,) bend."""
    strips = np.arange(len(edge))
    r = np.moveaxis(past_far_end(land, loops.points[strips, edge]), 0, -1)
    bend, way = r[:, 2:] - 2 * r[:, 1:-1] + r[:, :-2], r[:, 2:] - r[:, :-2]
    across = np.linalg.norm(np.cross(bend, way), axis=-1) / np.maximum(np.linalg.norm(way, axis=-1), np.finfo(float).tiny)
    return np.where(loops.found[strips, edge][:, None], across, 0.0)


def _stray(across, twist, down, cut):
    """Return the largest distance (..., k) from the surface of the mid-points of edges and of the centres of a quad's facets."""
    diagonal = across + down + 2 * cut * twist
    edges = np.maximum(np.abs(diagonal), np.maximum(np.abs(across), np.abs(down)))
    return np.maximum(edges / 8, np.abs(across + down + diagonal) / 18).max(axis=(-1, -2))


def _density(form, other, edges, straight, last=0.0):
    """(k, j) the integral from the first on of densities of rows or columns, from the form at inner ones and
    the worst over the other axis; at the edges as beside them, at the last one at least as the form `last` (k,) asks."""
    inner = np.sqrt(np.abs(form).max(axis=other))
    density = np.pad(inner, edges, mode="edge")
    density[:, -1] = np.maximum(density[:, -1], np.sqrt(last))
    density = density + (FLOOR * density.mean(axis=1, keepdims=True) + np.sqrt(straight))
    length = np.zeros(density.shape)
    np.cumsum(0.5 * (density[:, 1:] + density[:, :-1]), axis=1, out=length[:, 1:])
    return length


def even_steps(length, at, number):
    """Return parameters (k, number) between those of `at` (k, j), spaced so that `length` (k, j) grows by equal steps from each to the next."""
    out = np.array([np.interp(np.linspace(0, way[-1], number), way, x) for way, x in zip(length, at)])
    out[:, -1] = at[:, -1]
    return out


def shrinks(land, branch, side) -> bool:
    """Whether the loop on one side of a saddle shrinks to a point at the fold: it does around the well that the saddle meets
    there, on the side where the force's slope falls. The loop on the other side, of a figure eight, keeps its size."""
    if (told := shrinks_far(land, branch, side)) is not None:
        return told
    pot, fold = land.potential, branch.place(0.0)
    ahead, behind = (pot.slope(pot.move(fold, side * y)) for y in (NEAR, -NEAR))
    return not ahead - behind > NEAR * NEAR * pot.terms(fold)


def _trial_rows(land, branch, side):
    """(TRIAL,) parameters s of rows: the saddle moves on by equal steps near the fold and by equal factors far out, where
    the sheet only grows and hardly bends."""
    stretched, s = _stretched(land, branch)
    s = np.interp(np.linspace(0, stretched[-1], TRIAL), stretched, s)
    s[0], s[-1] = 0.0 if shrinks(land, branch, side) else NEAR, 1.0
    if branch.far == PLANE:  # there a loop need not close; on the way it grows like the root of log 1/(1 - s), without bound
        inner = np.interp(np.linspace(0, 1, TRIAL - len(TAIL)), np.linspace(0, 1, TRIAL), s * (1 - 10 * TAIL[0]))
        s = np.concatenate([inner, 1 - TAIL])
    return s


def _trial_rows_of(land, part):
    """(TRIAL,) parameters of a part's rows (`Part.rows`): those of the strip between its ends, closer by squares towards a seam."""
    if not part.seam:
        return _trial_rows(land, part.branch, part.side)
    stretched, s = _stretched(land, part.branch)
    low, high = np.interp((part.low, part.high), s, stretched)
    even = np.linspace(0, 1, TRIAL)
    t = part.parameters(np.interp(low + (high - low) * (even**2 if part.seam < 0 else 1 - (1 - even) ** 2), stretched, s))
    t[0], t[-1] = 0.0, 1.0
    return t


def _stretched(land, branch, dense=DENSE):
    """(lengths, parameters s) along a branch: a length grows with the way near the fold, and with its logarithm far out."""
    s = 0.5 - 0.5 * np.cos(np.linspace(0, np.pi, dense))
    place = np.broadcast_arrays(*branch.place(s))
    way = np.zeros(dense)
    np.cumsum(np.hypot(np.diff(place[0]), np.diff(place[1])), out=way[1:])
    q = land.invariant((place[0][[0, -1]], place[1][[0, -1]]))
    start = max(UNIFORM * np.sqrt(abs(q[0])), 0.03 * way[-1])
    return np.log1p(way / start), s
