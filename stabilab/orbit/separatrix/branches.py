"""The separatrix as surfaces, on grids that follow it within an accuracy.

For each value of the invariant it is the homoclinic loop of each saddle, an exact curve.

A branch of the separatrix sweeps one curve of saddles
outward from its fold, where the loop shrinks to a point. On a circle the loop runs from its saddle against
the torque and back; on a hyperbola (and without torque) each saddle has a loop on either side: a figure
eight. The lower of two saddles on a circle may have a second loop there too, towards the torque, where the
higher one turns it back: that parts a well from one twice as wide, no fate changes at it, and it is not
drawn.

Without torque the potential is periodic, so a saddle may see another one at its own height ahead (or itself,
one turn on). The loop then runs from saddle to saddle and back, and the saddle at its far end sees the same
closed curve on its other side. Such a loop is taken from one end only, its left one.

Rows and columns of a branch are graded so that its flat facets stray from the surface about equally
everywhere: in a given shape, or as few as keep them within an allowed distance.

A facet's edge with steps (du, ds) of the parameters strays from a surface r(u, s) with unit normal n by |L
du^2 + 2 M du ds + N ds^2|/8, where L = r_uu.n, M = r_us.n, N = r_ss.n: an edge of length l by c l^2/8 where
the normal curvature c along it hardly changes. Differences on a small trial grid give them, and where the
surface bends within one cell it strays by up to four times as much; how far the bend is gathered there is
shown by the curvatures next to it (`_gathered`). Columns stand uniformly in the sum of the steps that cells
ask for, rows too, each for the worst of the others. The finished grid is measured in the same way.

Within an accuracy, a grid that is too coarse is graded anew by what it shows, until one is fine enough: where
bends are narrow a coarse grid says little of their width, so none has more than `GROW` times the cells of
the one before."""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ...errors import InputError
from ...physics.coefficients import effective
from ...physics.scene import AnyScene
from ..landscape import CircleLandscape, ConicLandscape, landscape_in_doubles
from ..one_state import in_range
from .homoclinic import Branch, Separatrix
from .homoclinic_arrays import Loops, Part, loops, parted, residual, shrinks_far
from .saddles import (
    NO_REDUCTION,
    OPEN,
    PLANE,
    limit_of,
    saddle_branches,
    what_it_parts,
    why_none,
    why_parabolic,
)

# --- Grids of a given shape
TRIAL = 17              # rows and columns of the trial grid
FLOOR = 0.1             # of the mean density: no gap where a branch happens to be straight
STRAIGHT = 1e-6         # of a branch's size: less sag between neighbours of the trial grid does not matter
TAIL = 10.0 ** -np.arange(3, 6.1, 0.5)  # 1 - s of the last trial rows towards a plane Q = 0
FOLD_WIDTH = 1e-6             # a first row this near to the fold where the loop there is no point
DENSE = 129             # steps along a branch that trial rows are chosen from
UNIFORM = 0.2           # of the fold's radius: up to there trial rows are uniform
MAX_ROWS = 1025             # rows and columns, at most, of a grid within an accuracy


@dataclass(frozen=True)
class Grid:
    """The graded loops of k parts of strips; cut: +1 where quads of the first half are cut from (row, column)
    to (row + 1, column + 1), -1 the other way; error: (k,) largest distance of facets from the surface."""

    loops: Loops
    cut: int
    error: np.ndarray
    parts: list[Part]


def grid(land, strips, shape) -> Grid:
    """The graded loops of strips, pairs (branch, side), in the shape (rows, columns of a half)."""
    parts, rows = _whole_parts(land, strips)
    columns = np.broadcast_to(np.linspace(0, 1, TRIAL), rows.shape)
    built, edge = measured_loops(land, parts, rows, columns)
    forms = _Forms(land, built, parts, edge)
    placed = [forms.placed(k, rows[k], columns[k], shape) for k in range(len(parts))]
    built, edge = measured_loops(land, parts, *map(np.array, zip(*placed)))
    forms = _Forms(land, built, parts, edge)
    strays = np.array([forms.strays(1), forms.strays(-1)])
    best = int(np.argmin(strays.max(axis=1)))
    return Grid(built, (1, -1)[best], strays[best], parts)


def _whole_parts(land, strips):
    """(a part for each strip, trial rows of each)."""
    return [Part(*strip) for strip in strips], np.array([_trial_rows(land, *strip) for strip in strips])


@lru_cache(maxsize=64)
def trial_parts(land, strips):
    """(parts of strips, cut at their seams, trial rows of each). They are kept, for the next surface of the
    same scene."""
    parts, rows = _whole_parts(land, strips)
    if len(cut := parted(land, strips, rows[:, 0])) > len(parts):
        parts, rows = cut, np.array([_trial_rows_of(land, part) for part in cut])
    return parts, rows


def measured_loops(land: ConicLandscape, parts: Sequence[Part], s: np.ndarray, u: np.ndarray):
    """(loops at rows s, how far the chords between the first two rows, and between the last two, stray from
    the branch (2, k)): inner rows do not tell how much it bends beyond them, towards a plane Q = 0 without
    bound, so rows in between are measured."""
    more = np.concatenate([s[:, :1], 0.5 * (s[:, :1] + s[:, 1:2]), s[:, 1:-1],
                           0.5 * (s[:, -2:-1] + s[:, -1:]), s[:, -1:]], axis=1)
    all_ = loops(land, parts, np.array([part.rows(row) for part, row in zip(parts, more)]), u)
    retained = np.delete(np.arange(more.shape[1]), (1, -2))
    return all_.at_rows(retained), np.array([_sag(all_, 0, 1, 2), _sag(all_, -1, -2, -3)])


def _sag(loops: Loops, first: int, between: int, last: int):
    """(k,) how far the chords from the row `first` to `last` stray from the branch, by the row in between."""
    before, middle, after = (loops.points[:, row] for row in (first, between, last))
    chord, route = (after - before)[:, 1:-1], (middle - before)[:, 1:-1]
    normal = np.cross(chord, middle[:, 2:] - middle[:, :-2])
    size = np.maximum(np.linalg.norm(normal, axis=-1), np.finfo(float).tiny)
    part = np.sum(route * chord, axis=-1) / np.maximum(np.sum(chord * chord, axis=-1), np.finfo(float).tiny)
    # of the chord, where the row in between passes; the sag is largest at a half
    part = np.clip(part, 0.1, 0.9)
    sag = np.abs(np.sum(route * normal, axis=-1)) / size / (4 * part * (1 - part))
    return np.where(loops.found[:, (first, between, last)].all(axis=1), sag.max(axis=1), 0.0)


def past_far_end(land: ConicLandscape, points: np.ndarray):
    """(3, ..., m + 1) components of points (..., m, 3) with one column beyond the far end."""
    r = np.empty((3, *points.shape[:-2], points.shape[-2] + 1))
    r[..., :-1], axis = np.moveaxis(points, -1, 0), land.reduction.axis
    r[..., -1] = r[..., -3]
    r[axis, ..., -1] = 2 * r[axis, ..., -2] - r[axis, ..., -3]
    return r


def shrinks(land, branch, side) -> bool:
    """Whether the loop on one side of a saddle shrinks to a point at the fold: it does around the well that
    the saddle meets there, on the side where the force's slope falls. The loop on the other side, of a figure
    eight, keeps its size."""
    if (printed := shrinks_far(land, branch, side)) is not None:
        return printed
    pot, fold = land.potential, branch.place(0.0)
    ahead, behind = (pot.slope(pot.move(fold, side * y)) for y in (FOLD_WIDTH, -FOLD_WIDTH))
    return not ahead - behind > FOLD_WIDTH * FOLD_WIDTH * pot.terms(fold)


def _trial_rows(land, branch, side):
    """(TRIAL,) parameters s of rows: the saddle moves on by equal steps near the fold and by equal factors
    far out, where the branch only grows and hardly bends."""
    stretched, s = _stretched(land, branch)
    s = np.interp(np.linspace(0, stretched[-1], TRIAL), stretched, s)
    s[0], s[-1] = 0.0 if shrinks(land, branch, side) else FOLD_WIDTH, 1.0
    # there a loop need not close; on the way it grows like the root of log 1/(1 - s), without bound
    if branch.far == PLANE:
        inner = np.interp(np.linspace(0, 1, TRIAL - len(TAIL)), np.linspace(0, 1, TRIAL),
                          s * (1 - 10 * TAIL[0]))
        s = np.concatenate([inner, 1 - TAIL])
    return s


def _trial_rows_of(land: CircleLandscape, part: Part):
    """(TRIAL,) parameters of a part's rows (`Part.rows`): those of the strip between its ends, closer by
    squares towards a seam."""
    if not part.seam:
        return _trial_rows(land, part.branch, part.side)
    stretched, s = _stretched(land, part.branch)
    low, high = np.interp((part.low, part.high), s, stretched)
    even = np.linspace(0, 1, TRIAL)
    t = part.parameters(np.interp(low + (high - low) * (even**2 if part.seam < 0 else 1 - (1 - even) ** 2),
                                  stretched, s))
    t[0], t[-1] = 0.0, 1.0
    return t


def _stretched(land, branch, dense=DENSE):
    """(lengths, parameters s) along a branch: a length grows with the way near the fold, and with its
    logarithm far out."""
    s = 0.5 - 0.5 * np.cos(np.linspace(0, np.pi, dense))
    location = np.broadcast_arrays(*branch.place(s))
    route = np.zeros(dense)
    np.cumsum(np.hypot(np.diff(location[0]), np.diff(location[1])), out=route[1:])
    q = land.invariant((location[0][[0, -1]], location[1][[0, -1]]))
    start = max(UNIFORM * np.sqrt(abs(q[0])), 0.03 * route[-1])
    return np.log1p(route / start), s


# --- Grids within an accuracy
MIXTURES = np.array([0.7, 1.0, 1.5, 2.0])  # columns against rows, relative to where both alone stray equally
# rows and columns grow by that much more than asked, by its square at the next attempt, and so on
SAFETY = 1.05
GROW = 6.0         # cells, at most, against those of the grid before
ROUNDS = 14
# points: strips of unequal shapes are computed as one array where no more are wasted
BATCH_POINTS = 4000
RIM = 0.1          # of how far its outline strays counts where `reach` cuts a branch off
# where a branch bends within a cell, edges stray like their length and not its square: by that power denser
# than the root of how far tells
BENT = 0.25
TINY, SMALL = np.finfo(float).tiny, 1e-200


def grids_within(land, strips, accuracy) -> list[Grid]:
    """A grid for each strip, a pair (branch, side), or for each part of one that is cut at a seam, with as
    few rows and columns as keep facets within `accuracy` of the branches."""
    parts, rows = trial_parts(land, tuple(strips))
    todo, result = {n: (row, np.linspace(0, 1, TRIAL)) for n, row in enumerate(rows)}, {}
    for attempt in range(ROUNDS):
        following = {}
        for group in _groups(todo):
            s, u = (np.array([todo[n][axis] for n in group]) for axis in (0, 1))
            built, edge = measured_loops(land, [parts[n] for n in group], s, u)
            forms = _Forms(land, built, [parts[n] for n in group], edge)
            strays = np.array([forms.strays(1), forms.strays(-1)])
            for k, n in enumerate(group):
                best = int(strays[:, k].argmin())
                if attempt and (strays[best, k] <= accuracy or min(s.shape[1], u.shape[1]) == MAX_ROWS
                                or attempt == ROUNDS - 1):
                    result[n] = Grid(built.of(k), (1, -1)[best], strays[best, k:k + 1], [parts[n]])
                else:
                    following[n] = forms.graded(k, s[k], u[k], accuracy, attempt)
        todo = following
    return [result[n] for n in range(len(parts))]


def _groups(todo: dict[int, tuple[np.ndarray, np.ndarray]]):
    """Numbers of strips that are computed together, on rows and columns of one shape; these are raised where
    that wastes little."""
    groups: list[list[int]] = []
    for n in sorted(todo, key=lambda n: -len(todo[n][0]) * len(todo[n][1])):
        if groups and _waste(todo, groups[-1], n) <= BATCH_POINTS:
            groups[-1].append(n)
        else:
            groups.append([n])
    for group in groups:
        shape = [max(len(todo[n][axis]) for n in group) for axis in (0, 1)]
        for n in group:
            todo[n] = tuple(_refined(at, number) for at, number in zip(todo[n], shape))
    return groups


def _waste(todo: Mapping[int, tuple[np.ndarray, np.ndarray]], group: Sequence[int], n: int):
    """Points that are computed in vain where the strip n joins a group."""
    rows, columns = (max(len(todo[item][axis]) for item in (*group, n)) for axis in (0, 1))
    return (len(group) + 1) * rows * columns - sum(len(todo[item][0]) * len(todo[item][1])
                                                   for item in (*group, n))


def _refined(at: np.ndarray, number: int):
    """Parameters as many as asked, between those that are there."""
    if len(at) == number:
        return at
    return np.interp(np.linspace(0, 1, number), np.linspace(0, 1, len(at)), at)


def _gathered(c: np.ndarray, axis: int):
    """How many times more than an even bend an edge strays, from curvatures c at its ends and beyond, of
    which there is one more at either end along the axis: bends of a bell's shape stray by 1.2, 1.6, 2.6 and
    at most 4 times as much where those beyond are 0.4, 0.09, 0.013 and 0 of these."""
    c = np.moveaxis(c, axis, -1)
    fraction = np.minimum((c[..., :-3] + c[..., 3:]) / np.maximum(c[..., 1:-2] + c[..., 2:-1], SMALL), 1.0)
    return np.moveaxis(1 + 3 * (1 - fraction * fraction) / (1 + 35 * fraction), -1, axis)


def _rims(built: Loops, r: np.ndarray, parts: Sequence[Part]):
    """(k, m - 1) how far edges stray from the outline of a branch, in the branch too, where it ends, from
    grids r (k, n, m + 1, 3): in the first row, a point or a rim, and in the last one; only a share `RIM` of
    that where `reach` cuts off a branch that goes on."""
    first, last = (_along(r[:, row], np.ones((len(r), r.shape[2]), bool) & built.found[:, row, None])[:, :-1]
                   for row in (0, -1))
    last[[part.seam <= 0 and part.branch.far == OPEN for part in parts]] *= RIM
    for strays, seam in ((first, -1), (last, 1)):
        # the second saddle, a corner and no bend
        strays[[part.seam == seam and not part.over for part in parts], -1] = 0
    strays = np.maximum(first, last)
    # without torque: the edges of loops from saddle to saddle follow no outline
    strays[built.shared.any(axis=1)] = 0
    return strays


def _along(r: np.ndarray, result: np.ndarray):
    """(k, n - 1) how far the edges between points r (k, n, 3) of curves stray from them, by curvatures and
    lengths of edges."""
    step = np.diff(r, axis=1)
    size = np.maximum(np.linalg.norm(step, axis=-1), TINY)
    full = result[:, 2:] & result[:, 1:-1] & result[:, :-2]
    route = step / size[..., None]
    bend = np.where(full, 2 * np.linalg.norm(np.cross(route[:, 1:], route[:, :-1]),
                                              axis=-1) / (size[:, 1:] + size[:, :-1]), 0.0)
    bend = np.concatenate([np.abs(_before(bend[:, 0], bend[:, 1 if bend.shape[1] > 1 else 0]))[:, None], bend,
                           bend[:, -1:]], axis=1)
    beyond = np.concatenate([bend[:, :1], bend, bend[:, -1:]], axis=1)
    return (bend[:, 1:] + bend[:, :-1]) * size * size / 16 * _gathered(beyond, 1)


class _Forms:
    """How edges of grids bend, (k, n, m - 1) along rows and (k, n - 1, m) along columns, what follows for
    their facets, and better rows and columns."""

    def __init__(self, land, made, parts, edge):
        self.first = edge[0]
        r = past_far_end(land, made.points)
        down, across = np.diff(r[..., :-1], axis=2), np.diff(r, axis=3)
        normal = _normals(made, down, across)
        wide, long = _dot(across, across), _dot(down, down)
        # curvatures at vertices, by the lengths h, k of the edges, whose steps need not be even: normals
        # stand on the chord from neighbour to neighbour,
        # and along these a bend c shows as c h k; at the saddles and at the first and last row as beside them
        u = (_dot(np.diff(across, axis=3),
                  normal[..., 1:]) / np.maximum(np.sqrt(wide[..., 1:] * wide[..., :-1]), TINY))
        s = (_dot(np.diff(down, axis=2),
                  normal[:, :, 1:-1]) / np.maximum(np.sqrt(long[:, 1:] * long[:, :-1]), TINY))
        u = np.concatenate([_before(u[..., 0], u[..., 1])[..., None], u], axis=-1)
        s = np.concatenate([s[:, :1], s, s[:, -1:]], axis=1)
        wide, self.size = wide[..., :-1], np.abs(made.points).max()
        even_u, even_s = (np.abs(u[..., 1:])
                          + np.abs(u[..., :-1])) * wide / 16, (np.abs(s[:, 1:])
                                                               + np.abs(s[:, :-1])) * long / 16
        # beyond the far end the loop comes back
        beyond_u = np.abs(np.concatenate([u[..., :1], u, u[..., -2:-1]], axis=-1))
        beyond_s = np.abs(np.concatenate([s[:, :1], s, s[:, -1:]], axis=1))
        self.edge_u, self.edge_s = even_u * _gathered(beyond_u, 2), even_s * _gathered(beyond_s, 1)
        self.edge_s[:, [0, -1]] = edge.T[:, :, None]  # measured: the rows beside do not tell it
        crease = made.shared.any(axis=1)
        for column in (0, -1):
            along = _along(made.points[:, :, column], made.found)
            self.edge_s[:, :, column] = np.maximum(self.edge_s[:, :, column], along if column == 0
                                                   else np.where(crease[:, None], along, 0.0))
        self.outline = _rims(made, np.moveaxis(r, 0, -1), parts)
        # of quads: eight times how their edges stray, signed, the twist, and what narrow bends add
        even_u, even_s = 0.5 * (u[..., 1:] + u[..., :-1]) * wide, 0.5 * (s[:, 1:] + s[:, :-1]) * long
        even_s[:, [0, -1]] = np.clip(even_s[:, [0, -1]], -8 * edge.T[:, :, None], 8 * edge.T[:, :, None])
        self.quad_u, self.quad_s = 0.5 * (even_u[:, 1:]
                                          + even_u[:, :-1]), 0.5 * (even_s[..., 1:] + even_s[..., :-1])
        both = normal[:, :, 1:] + normal[:, :, :-1]
        self.twist = 0.25 * _dot(np.diff(across[..., :-1], axis=2), both[..., 1:] + both[..., :-1])
        more_u, more_s = self.edge_u - np.abs(even_u) / 8, self.edge_s - np.abs(even_s) / 8
        more_s[:, [0, -1]] = 0.0
        self.more_u, self.more_s = np.maximum(more_u[:, 1:],
                                              more_u[:, :-1]), np.maximum(more_s[..., 1:], more_s[..., :-1])

    def strays(self, cut: int):
        """(k,) how far edges and facets stray at most."""
        edges = np.maximum(np.maximum(self.edge_u.max(axis=(1, 2)), self.edge_s.max(axis=(1, 2))),
                           self.outline.max(axis=1))
        return np.maximum(edges, _facets(self.quad_u, self.quad_s, self.twist, self.more_u + self.more_s,
                                         cut).max(axis=(1, 2)))

    def placed(self, k: int, s: np.ndarray, u: np.ndarray, shape: Sequence[int]):
        """(rows, columns) of a shape for the part k, from its grid at rows s and columns u."""
        _, _, r, c = self._wanted(k, s, u)
        return _placed(r, s, shape[0]), _placed(c, u, shape[1])

    def _wanted(self, k: int, s: np.ndarray, u: np.ndarray):
        """(how far edges from row to row stray, from column to column, steps that rows ask for, columns)."""
        straight = np.sqrt(8 * STRAIGHT * self.size) * TRIAL / max(len(s), len(u))
        along, across = self.edge_s[k].max(axis=1), np.maximum(self.edge_u[k].max(axis=0), self.outline[k])
        return along, across, _steps_wanted(along, straight), _steps_wanted(across, straight)

    def graded(self, k: int, s: np.ndarray, u: np.ndarray, accuracy: float, attempt: int):
        """(rows, columns) that `accuracy` needs of the part k, as far as its grid at rows s and columns u
        tells: of the mixtures and cuts the one with the fewest cells."""
        along, across, r, c = self._wanted(k, s, u)
        r[0] *= max(self.first[k] / accuracy, 1.0) ** BENT  # measured, and mostly beside a fold
        if attempt:  # an earlier grading was to keep rows to the accuracy, but knew less of their bends
            r *= np.maximum(along / accuracy, 1.0) ** BENT
        shapes, safety = [], SAFETY ** (attempt + 1)
        for mix in MIXTURES:
            p, t = mix * c, r[:, None]
            smallest = max((across / p**2).max(), (along / r**2).max())
            quads = self.quad_u[k] / p**2, self.quad_s[k] / t**2, self.twist[k] / (p * t), self.more_u[
                k] / p**2 + self.more_s[k] / t**2
            for cut in (1, -1):
                size = safety * np.sqrt(max(smallest, _facets(*quads, cut).max()) / accuracy)
                shapes.append((size * r.sum() + 1, size * p.sum() + 1))
        rows, columns = min(shapes, key=lambda shape: shape[0] * shape[1])
        less = min(np.sqrt(GROW * len(s) * len(u) / (rows * columns)), 1.0)
        rows, columns = (int(min(max(np.ceil(number * less), 3), MAX_ROWS)) for number in (rows, columns))
        return _placed(r, s, rows), _placed(c, u, columns)


def _normals(built: Loops, down: np.ndarray, across: np.ndarray):
    """(3, k, n, m) unit normals of grids at their vertices; 0 where neighbouring rows have no loop, and at a
    far end that is a saddle, a corner and no bend."""
    a = np.concatenate([2 * down[:, :, :1], down[:, :, 1:] + down[:, :, :-1], 2 * down[:, :, -1:]], axis=2)
    b = np.concatenate([2 * across[..., :1], across[..., 1:] + across[..., :-1]], axis=3)
    normal = np.stack([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])
    full = built.found.copy()
    full[:, 1:] &= built.found[:, :-1]
    full[:, :-1] &= built.found[:, 1:]
    normal *= full[:, :, None] / np.maximum(np.sqrt(_dot(normal, normal)), TINY)
    if built.shared.any():
        normal[:, built.shared, -1] = 0
    return normal


def _dot(a: np.ndarray, b: np.ndarray):
    return np.einsum("cknm,cknm->knm", a, b)


def _placed(density: np.ndarray, at: np.ndarray, number: int):
    """So many parameters between those of `at`, spaced evenly by the density of its cells."""
    length = np.append(0.0, np.cumsum(density))
    return np.interp(np.linspace(0, length[-1], number), length, at)


def _before(first: np.ndarray, second: np.ndarray):
    """The curvature before the first one, as the change from the second goes on, but no less than the first.
    """
    on = 2 * first - second
    return np.where(np.abs(on) > np.abs(first), on, first)


def _facets(u: np.ndarray, s: np.ndarray, t: np.ndarray, more: np.ndarray, cut: int):
    """(..., n, m) how far diagonals and facets' centres of quads stray, from their signed forms and what
    narrow bends add."""
    diagonal = u + s + 2 * cut * t
    return np.maximum(np.abs(diagonal) / 8, np.abs(u + s + diagonal) / 18) + more


def _steps_wanted(strays: np.ndarray, straight: float):
    """Steps that every cell asks for, smoothed to its neighbours', with a floor."""
    out = np.sqrt(8 * strays)
    wide = np.concatenate([out[:1], out, out[-1:]])
    out = np.maximum(out, 0.5 * (wide[2:] + wide[:-2]))
    return out + (FLOOR * out.mean() + straight)


# --- The separatrix
SHAPE = (96, 129)  # fine enough for pictures


def separatrix(scene: AnyScene, reach: float | None = None, shape: tuple[int, int] | None = None,
               accuracy: float | None = None, fast: bool = False) -> Separatrix:
    """Every branch of the separatrix of a scene with an elliptic or hyperbolic reduction.

    reach: how far out the branches go, as a multiple of the radius sqrt|Q| of the outermost fold (default 4;
    where there is no fold, of the smallest saddle's); must exceed 1. shape: (rows, columns) of each grid, at
    least (3, 5), an even number of columns becomes the next odd one (default (96, 129)). accuracy: in place
    of a shape, the largest distance allowed between the branches and the flat facets of their meshes, in the
    unit of the points: each grid gets as few rows and columns as that needs (of a branch, its rim where
    `reach` cuts it off may stray by ten times as much), a branch whose loops reach a second saddle as high
    comes in two parts that meet there, and every branch has as `error` what its facets were found to reach
    (more than that only where the largest grids, of 1025 rows, still bend as much). fast: accepted for
    one version more, without effect. Points are in the scene's variables. A scene without saddles gives no
    branches and the reason. Raises InputError for a shape, reach or accuracy out of range.
    """
    _check(reach, shape, accuracy)
    scene = effective(scene)
    with in_range("separatrix"):
        return _separatrix(scene, reach, shape, accuracy)


def _separatrix(scene: AnyScene, reach: float | None, shape: Sequence[int] | None,
                accuracy: float | None) -> Separatrix:
    land = landscape_in_doubles(scene)
    if land is None:
        return Separatrix((), reason=NO_REDUCTION)
    if land.conic is None:
        return Separatrix((), reason=why_parabolic(land.reduction))
    branches = saddle_branches(land.conic, land.potential, limit_of(land.conic, reach or 4.0))
    if not branches:
        return Separatrix((), reason=why_none(land.conic, land.sense))
    strips = [(branch, side) for branch in branches for side, _ in land.conic.sides(land.sense)]
    rows, columns = shape or SHAPE
    half = None if accuracy else (rows, columns // 2 + 1)
    built = _by_arrays(land, strips, half, accuracy)
    return Separatrix(tuple(_branches(land, built)), reason=what_it_parts(land.potential, land.sense))


def _check(reach, shape, accuracy):
    if shape is not None and accuracy is not None:
        raise InputError(
            "separatrix: got both a shape and an accuracy; expected one of them, as an accuracy chooses "
            "the shape")
    if shape is not None and not (isinstance(shape, (tuple, list)) and len(shape) == 2
                                  and all(isinstance(n, (int, np.integer)) for n in shape)
                                  and shape[0] >= 3 and shape[1] >= 5):
        raise InputError(f"shape: expected (rows, columns), at least (3, 5), got {shape!r:.80}")
    if reach is not None and not (isinstance(reach, (int, float, np.integer, np.floating))
                                  and 1 < reach < np.inf):
        raise InputError(f"reach: expected a multiple of the fold's radius above 1, got {reach!r:.80}")
    if accuracy is not None and not (isinstance(accuracy, (int, float, np.integer, np.floating))
                                     and 0 < accuracy < np.inf):
        raise InputError(
            f"accuracy: expected a distance above 0 in the unit of the points, got {accuracy!r:.80}")


def _by_arrays(land, strips, shape, accuracy):
    """[(part, points (n, m, 3), residual (n, m), saddles and centres (n, 3), invariants (n,), found (n,),
    cut, error)] of every strip or part of one: the second half of a loop mirrors the first, with W of the
    other sign."""
    out = []
    for built in grids_within(land, strips, accuracy) if accuracy else [grid(land, strips, shape)]:
        loops, mirror, axis = built.loops, slice(-2, None, -1), land.reduction.axis
        points = np.concatenate([loops.points, loops.points[:, :, mirror]], axis=2)
        back = points[:, :, loops.w.shape[2]:, axis]
        back *= -1
        back += 2 * land.reduction.component_i(0.0)
        off = residual(land, loops)
        off = np.concatenate([off, off[:, :, mirror]], axis=2)
        out += [(part, points[k], off[k], loops.saddle_state[k], loops.centre_state[k],
                 land.invariant(loops.saddle[:, k]), loops.found[k], built.cut,
                 built.error[k]) for k, part in enumerate(built.parts)]
    return out


def _branches(land, built):
    """A Branch of every strip, or part of one, in which loops close."""
    text = dict(land.conic.sides(land.sense))
    for number, branch in enumerate(dict.fromkeys(item[0].branch for item in built), 1):
        retained = [item for item in built if item[0].branch is branch and np.count_nonzero(item[6]) > 1]
        several = len({item[0].side for item in retained}) > 1
        for part, points, off, saddle, centre, invariant, result, cut, error in retained:
            rows = result if not result.all() else slice(None)
            side, piece = text[part.side] if several else "", f", part {part.number}" if part.number else ""
            name = f"branch {number}{side}{piece}"
            yield Branch(name, points[rows], off[rows], saddle[rows], centre[rows], invariant[rows],
                         float(error), cut)
