"""The separatrix as surfaces: for each value of the invariant the homoclinic loop of each saddle, an exact curve.

A sheet sweeps one branch of saddles outward from its fold, where the loop shrinks to a point. Along a loop
W = +-sqrt(2 (V_saddle - V(theta))), the difference formed without cancellation, so vertices lie on the surface to
rounding. On a circle the loop runs from its saddle against the torque and back; on a hyperbola (and without torque)
each saddle has a loop on either side: a figure eight.

Without torque the potential is periodic, so a saddle may see another one at its own height ahead (or itself, one turn
on). The loop then runs from saddle to saddle and back, and the saddle at its far end sees the same closed curve on its
other side. Such a loop is taken from one end only, its left one.
"""
from __future__ import annotations

from dataclasses import replace

import numpy as np

from .effective import effective
from .landscape import EPS, TURN, Landscape, landscape
from .results import Separatrix, Sheet
from .rootfind import bracketed_newton
from .turning import spots_along

OWN = 1e-9        # offsets below this are the saddle itself
UNIFORM = 0.2     # of the fold's radius: up to there rows are uniform
FLOOR = 0.3       # of the density of columns: no gap where a loop happens to be straight
LEVEL = 64 * EPS  # saddles whose heights differ by less, relative to the terms of the energy, are at one height


def separatrix(scene, reach: float | None = None, shape: tuple[int, int] = (96, 129)) -> Separatrix:
    """Every sheet of the separatrix of a scene with an elliptic or hyperbolic reduction.

    reach: how far out the sheets go, as a multiple of the radius sqrt|Q| of the outermost fold (default 4; where there
    is no fold, of the smallest saddle's); must exceed 1. shape: (rows, columns) of each grid, at least (3, 5), an even
    number of columns becomes the next odd one. Points
    are in the scene's variables. A scene without saddles gives no sheets and the reason.
    """
    from ..errors import InputError
    rows, columns = shape
    if rows < 3 or columns < 5:
        raise InputError(f"shape: expected at least (3, 5), got {tuple(shape)}")
    if reach is not None and not reach > 1:
        raise InputError(f"reach: expected a multiple of the fold's radius above 1, got {reach}")
    land = landscape(effective(scene))
    if land is None:
        return Separatrix((), "no reduction to one degree of freedom: the separatrix of this scene is not known in closed form")
    if land.e == 0:
        return Separatrix((), "parabolic reduction (two equal moments): all motions are bounded by walls on both sides, "
                              "except pure spin about the torque; no sheet bounds a spin-up")
    branches = list(_branches(land, reach or 4.0))
    if not branches:
        return Separatrix((), _why_none(land))
    sheets = []
    for number, place in enumerate(branches, 1):
        loops = [(word, sheet) for side, word in _sides(land) if (sheet := _sheet(land, place, rows, columns, side))]
        sheets += [replace(sheet, name=f"sheet {number}{word if len(loops) > 1 else ''}") for word, sheet in loops]
    return Separatrix(tuple(sheets), _what_it_parts(land))


def _what_it_parts(land) -> str:
    if land.e > 0:
        return "both sides of each sheet are bounded: it parts oscillations about one centre from those around two"
    if land.sense == 0:
        return ("both sides of each sheet are bounded: inside motions oscillate about a centre, outside about more of "
                "them or right round the axis")
    return "each sheet bounds the motions that oscillate about the centres inside it"


def _why_none(land) -> str:
    if land.conic.pieces or land.conic.lines:
        return ("no equilibrium is a saddle of the reduced potential: each orbit has a single well, and there is no "
                "separatrix surface")
    return "there is no equilibrium, so there is no saddle and no separatrix surface"


def _sides(land):
    """Which way loops leave a saddle: against the torque on a tilted circle, both ways otherwise."""
    if land.e < 0 and land.sense:
        return ((-1, ""),)
    return ((-1, ", left loop"), (1, ", right loop"))


def _branches(land: Landscape, reach):
    """For every branch of saddles its place as a function of s in [0, 1], s = 0 at the fold."""
    conic = land.conic
    base = [abs(q) for q in conic.fold_invariants]
    for line in conic.lines:
        base.append(abs(_line_foot(conic, line)[1]) or abs(conic.K / conic.G if conic.G and conic.K else 1.0))
    limit = max(base, default=1.0) * reach * reach
    for piece in conic.pieces:
        if piece.barrier:
            for low, high in _split(conic, piece, limit):
                yield _along_piece(land, piece, low, high)
    for line in conic.lines:
        for low, high in _line_intervals(land, line, limit):
            yield _along_line(land, line, low, high)


def _split(conic, piece, limit):
    """|h| intervals of a piece inside the limit on |Q|, starting at a fold, cut where Q = 0 (a plane)."""
    ends = []
    for q in (limit, -limit):
        _, z, exists = conic._meet_piece(piece, np.array([q]))
        if exists[0]:
            ends.append(abs(z[0] + conic.shift))
    inner, outer = piece.inner, piece.outer
    if np.isinf(outer):
        outer = max(ends) if ends else None
    if inner == 0:
        inner = min(ends) if ends else None
    if inner is None or outer is None or not inner < outer:
        return
    cuts = [inner, outer]
    if conic.e > 0:
        _, z, exists = conic._meet_piece(piece, np.array([0.0]))
        if exists[0]:
            plane = abs(z[0] + conic.shift)
            if inner < plane < outer:
                cuts = [inner, plane, outer]
    for low, high in zip(cuts, cuts[1:]):
        yield (high, low) if abs(high - piece.inner) > 0 and high == piece.outer else (low, high)


def _along_piece(land, piece, start, end):
    def place(s):
        h = piece.sign * (start + (end - start) * s)
        x, z = land.conic.at(h)
        return _as_place(land, x, z)
    place.piece = piece
    return place


def _line_foot(conic, line):
    """(t, Q) where the invariant is stationary along a line."""
    e = conic.e
    a = line.dz**2 - e * line.dx**2
    t = -(line.z0 * line.dz - e * line.x0 * line.dx) / a if a else 0.0
    x, z = line.x0 + t * line.dx, line.z0 + t * line.dz
    return t, z * z - e * x * x


def _line_intervals(land, line, limit):
    """Intervals of t on a line where it holds saddles, each from its inner end outward."""
    conic = land.conic
    knots = [_line_foot(conic, line)[0]]
    if conic.G:  # where the two lines cross
        knots.append(-conic.d / conic.G - line.z0 if line.dz else -conic.c / conic.G - line.x0)
    far = (2 * np.sqrt(limit) + abs(line.x0) + abs(line.z0)) / np.hypot(line.dx, line.dz) + max(abs(k) for k in knots)
    knots = sorted({-far, *knots, far})
    for low, high in zip(knots, knots[1:]):
        t = 0.5 * (low + high)
        spot = _as_place(land, np.array([line.x0 + t * line.dx]), np.array([line.z0 + t * line.dz]))
        if land.potential.slope(spot)[0] > 0:
            yield (low, high) if abs(low) < abs(high) else (high, low)


def _along_line(land, line, start, end):
    def place(s):
        t = start + (end - start) * s
        return _as_place(land, line.x0 + t * line.dx, line.z0 + t * line.dz)
    return place


def _as_place(land, x, z):
    return (x, z) if land.e < 0 else (x + z, x - z)


def _sheet(land, place_at, rows, columns, side):
    """One sheet of a branch of saddles, on one side of them; None where no loop closes."""
    s = _rows(land, place_at, rows)
    # the first row is the fold point itself; on a plane Q = 0 a loop need not close, so the last row stays short of it
    q = land.invariant(place_at(s[-2:]))
    if land.e > 0 and abs(q[1]) < 1e-9 * abs(q[0]):
        s[-1] = 1 - 0.05 / rows
    saddle = tuple(np.asarray(v, float) for v in place_at(s))
    saddle = _polished(land, saddle, s)
    end, centre, found, shared = loop_end(land, saddle, side)
    found &= ~(shared & (side > 0))
    found[0] = True
    end[0] = 0.0
    centre[:, 0] = np.array(saddle)[:, 0]
    if found.sum() < 2:
        return None
    saddle, end, centre = tuple(v[found] for v in saddle), end[found], centre[:, found]
    # out from the saddle with W against the torque, back with the other sign: the second half mirrors the first
    y = end[:, None] * _shares(land, saddle, end, columns // 2 + 1)
    w, half = _half_loops(land, saddle, y, side)
    residual = _residual(land, saddle, half, y)
    mirror = slice(-2, None, -1)
    points = np.concatenate([half, half[:, mirror]], axis=1)
    axis = land.reduction.axis
    points[:, w.shape[1]:, axis] = land.reduction.component_i(-side * w[:, mirror])
    zero = np.zeros(len(end))
    return Sheet(name="", points=points, residual=np.concatenate([residual, residual[:, mirror]], axis=1),
                 saddle=land.components(saddle, zero), centre=land.components(tuple(centre), zero),
                 invariant=land.invariant(saddle))


def _half_loops(land, saddle, y, side):
    """(W >= 0 (n, m), points (n, m, 3)) of the first halves of the loops at offsets y (n, m), 0 to the far end."""
    spot = tuple(v[:, None] for v in saddle)
    with np.errstate(all="ignore"):
        w = np.sqrt(2 * np.maximum(-land.potential.rise(y, spot), 0))
    w[:, 0] = w[:, -1] = 0.0
    return w, land.components(land.potential.move(spot, y), side * w)


def _rows(land, place_at, number, dense=257):
    """(number,) parameters s of the rows: the saddle moves on by equal steps near the fold and by equal factors far out,
    where the sheet only grows and hardly bends."""
    s = 0.5 - 0.5 * np.cos(np.linspace(0, np.pi, dense))
    x, z = place_at(s)
    way = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(z)))])
    start = max(UNIFORM * np.sqrt(np.abs(land.invariant((x[0], z[0])))), 0.03 * way[-1])
    stretched = np.log1p(way / start)
    s = np.interp(np.linspace(0, stretched[-1], number), stretched, s)
    s[-1] = 1.0
    return s


def _shares(land, saddle, end, number, dense=49, rows=5):
    """(number,) shares of the way to the far end, 0 to 1, at which facets stray from the sheet about equally.

    In u, share = sin^2(pi u/2), a loop is smooth at both ends; a chord over du strays from the sheet by |r_uu . n| du^2/8
    with the sheet's normal n. So columns are uniform in the integral of |r_uu . n|^(1/2), for the worst of some rows.
    """
    u = np.linspace(0, 1, dense)
    some = np.linspace(1, len(end) - 2, min(rows, len(end) - 2)).astype(int)
    pick = np.concatenate([some, some + 1])
    _, r = _half_loops(land, tuple(v[pick] for v in saddle), end[pick, None] * np.sin(0.5 * np.pi * u) ** 2, 1)
    r, beside = r[:len(some)], r[len(some):]
    along, second = r[:, 2:] - r[:, :-2], r[:, 2:] - 2 * r[:, 1:-1] + r[:, :-2]
    with np.errstate(all="ignore"):
        normal = np.cross(along, (beside - r)[:, 1:-1])
        bend = np.abs(np.sum(second * normal, axis=-1)) / np.linalg.norm(normal, axis=-1)
        density = np.sqrt(np.max(np.nan_to_num(bend / np.nanmax(bend)), axis=0))
    density = np.nan_to_num(density, nan=1.0) + FLOOR
    length = np.concatenate([[0.0], np.cumsum(0.5 * (np.r_[density[0], density] + np.r_[density, density[-1]]))])
    place = np.interp(np.linspace(0, length[-1], number), length, u)
    share = np.sin(0.5 * np.pi * place) ** 2
    share[-1] = 1.0
    return share


def _polished(land, saddle, s):
    """The conic's points moved along their orbits to where the force vanishes (all but the fold itself)."""
    moved = land._polish(saddle)
    return tuple(np.where(s > 0, m, v) for m, v in zip(moved, saddle))


def loop_end(land, saddle, side):
    """(offset of the far end of the loop (n,), centre place (2, n), found (n,), shared (n,)) for saddles (2, n), one side.

    The loop ends where the potential, beyond the wells on that side, is back at the saddle's height; shared: it ends at
    a saddle there, for which this is the loop on the other side.
    """
    n = len(saddle[0])
    spots = spots_along(land, saddle, np.zeros(n))
    end, centre = np.zeros(n), np.array(saddle, float)
    outward = np.argsort(np.where(spots.there, spots.offset * side, np.inf), axis=1, kind="stable")
    take = lambda a: np.take_along_axis(a, outward, axis=1)
    offset, energy, barrier = take(spots.offset * side), take(spots.energy), take(spots.barrier)
    ahead = take(spots.there) & (offset > OWN)
    level = ahead & barrier & _at_one_height(land, saddle, offset, energy)
    stops = ahead & barrier & ((energy <= 0) | level | (np.abs(offset - TURN) < OWN))
    rows, width = np.arange(n), offset.shape[1]
    if width == 0:
        return end, centre, np.zeros(n, bool), np.zeros(n, bool)
    stopped = stops.any(axis=1)
    stop = np.where(stopped, np.argmax(stops, axis=1), width)
    wells = ahead & ~barrier & (np.arange(width) < stop[:, None])
    found = wells.any(axis=1)
    deepest = np.argmax(np.where(wells, energy, -np.inf), axis=1)
    low = offset[rows, width - 1 - np.argmax(wells[:, ::-1], axis=1)]
    high = offset[rows, np.minimum(stop, width - 1)]
    centre[:, found] = np.array([take(v) for v in spots.place])[:, rows, deepest][:, found]
    shared = found & stopped & level[rows, np.minimum(stop, width - 1)]
    if land.e < 0:
        right_round = found & (~stopped | (np.abs(high - TURN) < OWN))
        high = np.where(right_round, TURN, high)  # one turn back the saddle stands again, higher by 2 pi mu
        shared |= right_round & (land.sense == 0)
        end[shared] = side * high[shared]
    else:
        for row in np.nonzero(found & ~stopped)[0]:
            wall = _wall(land, tuple(np.array([v[row]]) for v in saddle), low[row], side)
            found[row], high[row] = wall is not None, wall or 0.0
    solve = found & (end == 0)

    def fun(t, *spot):
        return land.potential.rise(side * t, spot), -side * land.potential.force(land.potential.move(spot, side * t))
    end[solve] = side * _root(fun, low[solve], high[solve], tuple(v[solve] for v in saddle))
    return end, centre, found, shared


def _root(fun, low, high, args, steps=9):
    """Where fun rises through zero between a well at `low` and `high` (n,): plain Newton, the safe search for the rest.

    The first guess is exact for the cubic potential next to a fold, whose loop is half as long again as the way to
    the well.
    """
    t = np.minimum(1.5 * low, 0.5 * (low + high))
    with np.errstate(all="ignore"):
        for _ in range(steps):
            value, slope = fun(t, *args)
            step = value / slope
            t = t - step
            size = np.abs(step)
            if (size <= 1e-10 * t).all():
                break
    # a last step of 1e-10 leaves 1e-20 where convergence is quadratic
    rest = ~((size <= 1e-10 * t) & (t > low) & (t < high))
    if rest.any():
        t[rest] = bracketed_newton(fun, low[rest], high[rest], 0.5 * (low[rest] + high[rest]), tuple(v[rest] for v in args))
    return t


def _at_one_height(land, saddle, offset, energy):
    """(n, m) where a spot is as high as the saddle, as only the periodic potential of a circle without torque has it."""
    if land.e > 0 or land.sense:
        return np.zeros(offset.shape, bool)
    pot, Q = land.potential, land.invariant(saddle)[:, None]
    return np.abs(energy) <= LEVEL * (np.abs(pot.G) * Q + (np.abs(pot.c) + np.abs(pot.d)) * np.sqrt(Q))


def _wall(land, spot, low, side):
    """A distance at which the wall beyond the last well is higher than the saddle; None beside an open plane."""
    step = 1.0
    with np.errstate(all="ignore"):
        while step < 700:
            if land.potential.rise(np.array([side * (low + step)]), spot)[0] > 0:
                return low + step
            step *= 2
    return None


def _residual(land, saddle, points, y):
    """(n, m) energy of the rounded points above their saddle's, relative to the size of the energy's terms; y: their
    offsets from the saddle, which tell the turn that the angle of a rounded point belongs to."""
    place, w, size = land.start(points)
    spot = tuple(v[:, None] for v in saddle)
    pot = land.potential
    with np.errstate(all="ignore"):
        if land.e < 0:
            angle = np.arctan2(place[0] * spot[1] - place[1] * spot[0], place[0] * spot[0] + place[1] * spot[1])
            seen, slopes = angle + TURN * np.round((y - angle) / TURN), abs(pot.c) + abs(pot.d)
        else:
            big = np.abs(spot[0]) >= np.abs(spot[1])
            seen = np.where(big, np.log(np.abs(place[0] / spot[0])), -np.log(np.abs(place[1] / spot[1])))
            slopes = abs(pot.e1) + abs(pot.e2)
        departure = np.abs(0.5 * w * w + pot.rise(seen, spot))
        scale = 0.5 * w * w + np.abs(pot.G) * (size[0] ** 2 + size[1] ** 2) + slopes * (size[0] + size[1]) + pot.mu
        return np.where(departure > 0, departure / scale, 0.0)
