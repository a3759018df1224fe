"""Rows and columns of a sheet, graded so that its flat facets stray from the surface about equally everywhere.

A facet's edge with steps (du, ds) of the parameters strays from a surface r(u, s) with unit normal n by
|L du^2 + 2 M du ds + N ds^2|/8, where L = r_uu.n, M = r_us.n, N = r_ss.n. Differences on a small trial grid give them:
columns stand uniformly in the integral of sqrt|L|, rows in that of sqrt|N|, each for the worst of the others, and the
numbers that an asked-for distance needs follow. Where a shape is asked for, as for a picture, columns follow the outline too.
The finished grid is measured in the same way.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .homoclinic_arrays import Loops, loops
from .saddles import PLANE
from .seams import Part, parted

TRIAL = 17              # rows and columns of the trial grid
FLOOR = 0.3             # of the mean density: no gap where a sheet happens to be straight
MIXTURES = np.array([1.0, 1.5, 2.0])  # columns against rows, relative to where both alone stray equally
STRAIGHT = 1e-6         # of a sheet's size: a lesser sag between neighbours of the trial grid does not matter
TAIL = 10.0 ** -np.arange(3, 6.1, 0.5)  # 1 - s of the last trial rows towards a plane Q = 0
NEAR = 1e-6             # a first row this near to the fold where the loop there is no point
DENSE = 129             # steps along a branch that trial rows are chosen from
UNIFORM = 0.2           # of the fold's radius: up to there trial rows are uniform
USUAL = 2               # attempts that more rows and columns are enough for; then these are graded anew
GROWTH = 2.0            # in cells at least, where loops at half the steps show a bend that second differences miss
SAFETY, ROUNDS, MOST = 1.03, 12, 1025  # rows and columns grow by that much more than asked, so often, up to there


@dataclass(frozen=True)
class Grid:
    """Loops of k strips or parts of strips; cut: +1 where quads of the first half are cut from (row, column) to (row + 1, column + 1), -1
    the other way; error: (k,) largest distance of facets from the surface."""

    loops: Loops
    cut: int
    error: np.ndarray
    parts: list[Part]


def grid(land, strips, shape=None, accuracy=None) -> Grid:
    """The graded loops of strips, pairs (branch, side): shape (rows, columns of a half), or, without one, as few of both as keep
    facets within `accuracy` of the sheets, each of which is cut at its seam then."""
    parts, rows = [Part(*strip) for strip in strips], np.array([_trial_rows(land, *strip) for strip in strips])
    if accuracy and len(cut := parted(land, strips, rows[:, 0])) > len(parts):
        parts, rows = cut, np.array([_trial_rows_of(land, part) for part in cut])
    columns = np.broadcast_to(np.linspace(0, 1, TRIAL), rows.shape)
    made, edge = _measured_loops(land, parts, rows, columns)
    forms, bends = _second_forms(land, made), _bends(land, made, parts, accuracy)
    grading, needed = _grading(made, forms, bends, edge, rows, columns, accuracy)
    shape, anew = shape or needed, len(parts) > len(strips)
    for attempt in range(ROUNDS):
        rows, columns = (_even_steps(length, at, number) for (length, at), number in zip(grading, shape))
        made, edge = _measured_loops(land, parts, rows, columns)
        forms, bends = _second_forms(land, made), _bends(land, made, parts, accuracy)
        strays = np.maximum(_stray(*forms, np.array([1, -1])[:, None, None, None]), edge)  # type: ignore[call-arg]
        strays = np.maximum(strays, bends.max(axis=1) / 8) if accuracy else strays
        told = strays.max(axis=1).min()
        if anew and told <= accuracy:
            strays = np.maximum(strays, _halved(land, parts, rows, columns))
        best = int(np.argmin(strays.max(axis=1)))
        worst = strays[best].max()
        if accuracy is None or worst <= accuracy or min(shape) == MOST:
            break
        if told > accuracy and attempt >= USUAL:  # the rows and columns before missed a bend
            anew = True
            grading, shape = _grading(made, forms, bends, edge, rows, columns, accuracy)
        else:
            shape = finer(shape, max(worst, GROWTH * accuracy) if told <= accuracy else worst, accuracy)  # narrow bends
    return Grid(made, (1, -1)[best], strays[best], parts)


def _halved(land, parts, rows, columns):
    """(2, k) how far edges and diagonals of a grid at parameters rows and columns, cut either way, stray from the surface in their middles, by loops at
    half the steps: where bends are as narrow as a step, second differences do not tell."""
    made = loops(land, parts, np.array([part.rows(row) for part, row in zip(parts, _between(rows))]), _between(columns))
    p, corner = made.points, made.points[:, ::2, ::2]
    normal = np.cross(np.gradient(p, axis=1), np.gradient(p, axis=2))
    normal /= np.maximum(np.linalg.norm(normal, axis=-1, keepdims=True), np.finfo(float).tiny)

    def off(a, b, at):
        return np.abs(np.einsum("kijx,kijx->kij", 0.5 * (a + b) - p[at], normal[at])).max(axis=(1, 2))

    centre = np.s_[:, 1::2, 1::2]
    edges = np.maximum(off(corner[:, 1:], corner[:, :-1], np.s_[:, 1::2, ::2]), off(corner[:, :, 1:], corner[:, :, :-1], np.s_[:, ::2, 1::2]))
    diagonals = np.array([off(corner[:, 1:, 1:], corner[:, :-1, :-1], centre), off(corner[:, 1:, :-1], corner[:, :-1, 1:], centre)])
    return np.where(made.found.all(axis=1), np.maximum(diagonals, edges), 0.0)


def _between(at):
    """(k, 2 n - 1) numbers at (k, n), and the middles between neighbours."""
    out = np.empty((len(at), 2 * at.shape[1] - 1))
    out[:, ::2], out[:, 1::2] = at, 0.5 * (at[:, 1:] + at[:, :-1])
    return out


def _grading(made, forms, bends, edge, rows, columns, accuracy):
    """((lengths of rows and their parameters, those of columns), the shape that `accuracy` needs, None without one), from the
    second forms of a grid at parameters rows (k, n) and columns (k, m), and from the bends of edges."""
    across, twist, down = forms
    straight = STRAIGHT * np.abs(made.points).max() * (TRIAL / max(rows.shape[1], columns.shape[1])) ** 2
    dense_columns, long_columns = _density(np.concatenate([across, bends[:, None]], axis=1), 1, ((0, 0), (1, 0)), straight)
    dense_rows, long_rows = _density(down, 2, ((0, 0), (1, 1)), straight, 8 * edge)
    shape = None
    if accuracy:
        c, r = dense_columns[:, None, 1:], dense_rows[:, 1:-1, None]
        shape = _numbers(across / (c * c), twist / (c * r), down / (r * r), long_columns[:, -1], long_rows[:, -1], accuracy)
        edges = np.sqrt((bends / dense_columns[:, 1:] ** 2).max(axis=1) / 8 / accuracy) * long_columns[:, -1]
        shape = shape[0], min(max(shape[1], int(np.ceil(SAFETY * edges.max())) + 1), MOST)
    return ((long_rows, rows), (long_columns, columns)), shape


def _numbers(across, twist, down, columns, rows, accuracy):
    """(rows, columns of a half) for facets within `accuracy`, from the forms (k, i, j) per squared density and the total
    lengths (k,): the mixture and the cut with the fewest cells; all strips share them."""
    mix = MIXTURES[:, None, None, None, None]
    cut = np.array([1, -1])[:, None, None, None]
    size = np.sqrt(_stray(across / mix**2, twist / mix, down, cut) / accuracy)  # (mixtures, cuts, k)
    return fewest_cells((size * rows).max(axis=-1), (size * columns * MIXTURES[:, None, None]).max(axis=-1))


def fewest_cells(rows, columns):
    """(rows, columns of a half) of the grid with the fewest cells among steps (mixtures, cuts) of both."""
    best = np.unravel_index(np.argmin(columns * rows), rows.shape)
    return tuple(min(max(int(np.ceil(SAFETY * number[best])) + 1, 3), MOST) for number in (rows, columns))


def finer(shape, worst, accuracy):
    """Return the shape to try next, after one whose facets stray from the surface by `worst`."""
    grow = max(SAFETY * np.sqrt(worst / accuracy), 1.1)
    return tuple(min(int(np.ceil((number - 1) * grow)) + 1, MOST) for number in shape)


def _measured_loops(land, parts, s, u):
    """(loops at rows s, how far the chords between the last two rows stray from the sheet (k,)): towards a plane Q = 0 the
    bend grows beyond what inner rows tell, so a row in between is measured."""
    more = np.concatenate([s[:, :-1], 0.5 * (s[:, -2:-1] + s[:, -1:]), s[:, -1:]], axis=1)
    all_ = loops(land, parts, np.array([part.rows(row) for part, row in zip(parts, more)]), u)
    before, between, last = (all_.points[:, row] for row in (-3, -2, -1))
    chord, way = (last - before)[:, 1:-1], (between - before)[:, 1:-1]
    normal = np.cross(chord, between[:, 2:] - between[:, :-2])
    size = np.maximum(np.linalg.norm(normal, axis=-1), np.finfo(float).tiny)
    part = np.sum(way * chord, axis=-1) / np.maximum(np.sum(chord * chord, axis=-1), np.finfo(float).tiny)
    part = np.clip(part, 0.1, 0.9)  # of the chord, where the row in between passes; the sag is largest at a half
    sag = np.abs(np.sum(way * normal, axis=-1)) / size / (4 * part * (1 - part))
    kept = np.delete(np.arange(more.shape[1]), -2)
    there = all_.found[:, -3:].all(axis=1)
    return all_.at_rows(kept), np.where(there, sag.max(axis=1), 0.0)


def _second_forms(land, loops):
    """(L, M, N), each (k, n - 2, m - 1), per step of the grid, at inner rows and all columns but the first: beyond the
    far end the loop comes back as its mirror image. 0 beside rows without a loop."""
    r = _past_far_end(land, loops.points)
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


def _past_far_end(land, points):
    """(3, ..., m + 1) components of points (..., m, 3) with one column beyond the far end."""
    r = np.empty((3, *points.shape[:-2], points.shape[-2] + 1))
    r[..., :-1], axis = np.moveaxis(points, -1, 0), land.reduction.axis
    r[..., -1] = r[..., -3]
    r[axis, ..., -1] = 2 * r[axis, ..., -2] - r[axis, ..., -3]
    return r


def _bends(land, loops, parts, accuracy):
    """(k, m - 1) how edges bend per step of the columns, in the sheet too: without an accuracy the last rows, whose chords are the outline of a
    picture; with one the rows at a seam, where two parts meet. 0 beside other rows."""
    edge = np.array([0 if part.seam < 0 else -1 for part in parts])
    bends = _outline(land, loops, edge)
    if accuracy:
        bends[[not part.seam for part in parts]] = 0
        bends[[part.seam != 0 and not part.over for part in parts], -1] = 0  # the second saddle, a corner and no bend
    return bends


def _outline(land, loops, edge):
    """(k, m - 1) how the rows edge (k,) bend."""
    strips = np.arange(len(edge))
    r = np.moveaxis(_past_far_end(land, loops.points[strips, edge]), 0, -1)
    bend, way = r[:, 2:] - 2 * r[:, 1:-1] + r[:, :-2], r[:, 2:] - r[:, :-2]
    across = np.linalg.norm(np.cross(bend, way), axis=-1) / np.maximum(np.linalg.norm(way, axis=-1), np.finfo(float).tiny)
    return np.where(loops.found[strips, edge][:, None], across, 0.0)


def _stray(across, twist, down, cut):
    """Return the largest distance (..., k) from the surface of the mid-points of edges and of the centres of a quad's facets."""
    diagonal = across + down + 2 * cut * twist
    edges = np.maximum(np.abs(diagonal), np.maximum(np.abs(across), np.abs(down)))
    return np.maximum(edges / 8, np.abs(across + down + diagonal) / 18).max(axis=(-1, -2))


def _density(form, other, edges, straight, last=0.0):
    """(densities (k, j), their integral from the first on (k, j)) of rows or columns, from the form at inner ones and
    the worst over the other axis; at the edges as beside them, at the last one at least as the form `last` (k,) asks."""
    inner = np.sqrt(np.abs(form).max(axis=other))
    density = np.pad(inner, edges, mode="edge")
    density[:, -1] = np.maximum(density[:, -1], np.sqrt(last))
    density = density + (FLOOR * density.mean(axis=1, keepdims=True) + np.sqrt(straight))
    length = np.zeros(density.shape)
    np.cumsum(0.5 * (density[:, 1:] + density[:, :-1]), axis=1, out=length[:, 1:])
    return density, length


def _even_steps(length, at, number):
    """Return parameters (k, number) between those of `at` (k, j), spaced so that `length` (k, j) grows by equal steps from each to the next."""
    out = np.array([np.interp(np.linspace(0, way[-1], number), way, x) for way, x in zip(length, at)])
    out[:, -1] = at[:, -1]
    return out


def shrinks(land, branch, side) -> bool:
    """Whether the loop on one side of a saddle shrinks to a point at the fold: it does around the well that the saddle meets
    there, on the side where the force's slope falls. The loop on the other side, of a figure eight, keeps its size."""
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
