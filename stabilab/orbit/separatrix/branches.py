"""The separatrix as surfaces: for each value of the invariant the homoclinic loop of each saddle, an exact
curve.

A branch of the separatrix sweeps one curve of saddles
outward from its fold, where the loop shrinks to a point. On a circle the loop runs from its saddle against
the torque and back; on a hyperbola (and without torque) each saddle has a loop on either side: a figure
eight. The lower of two saddles on a circle may have a second loop there too, towards the torque, where the
higher one turns it back: that parts a well from one twice as wide, no fate changes at it, and it is not
drawn.

Without torque the potential is periodic, so a saddle may see another one at its own height ahead (or itself,
one turn on). The loop then runs from saddle to saddle and back, and the saddle at its far end sees the same
closed curve on its other side. Such a loop is taken from one end only, its left one.
"""
from __future__ import annotations

import numpy as np

from ...errors import InputError
from ...physics.coefficients import effective
from ...physics.scene import AnyScene
from ..far_states import in_range
from ..landscape import landscape_in_doubles
from .grid import grid, grids_within
from .homoclinic_arrays import residual
from .result import Branch, Separatrix
from .saddles import NO_REDUCTION, limit_of, saddle_branches, what_it_parts, why_none, why_parabolic

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


def _separatrix(scene, reach, shape, accuracy) -> Separatrix:
    land = landscape_in_doubles(scene)
    if land is None:
        return Separatrix((), NO_REDUCTION)
    if land.conic is None:
        return Separatrix((), why_parabolic(land.reduction))
    branches = saddle_branches(land.conic, land.potential, limit_of(land.conic, reach or 4.0))
    if not branches:
        return Separatrix((), why_none(land.conic, land.sense))
    strips = [(branch, side) for branch in branches for side, _ in land.conic.sides(land.sense)]
    rows, columns = shape or SHAPE
    half = None if accuracy else (rows, columns // 2 + 1)
    made = _by_arrays(land, strips, half, accuracy)
    return Separatrix(tuple(_branches(land, made)), what_it_parts(land.potential, land.sense))


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
    for made in grids_within(land, strips, accuracy) if accuracy else [grid(land, strips, shape)]:
        loops, mirror, axis = made.loops, slice(-2, None, -1), land.reduction.axis
        points = np.concatenate([loops.points, loops.points[:, :, mirror]], axis=2)
        back = points[:, :, loops.w.shape[2]:, axis]
        back *= -1
        back += 2 * land.reduction.component_i(0.0)
        off = residual(land, loops)
        off = np.concatenate([off, off[:, :, mirror]], axis=2)
        out += [(part, points[k], off[k], loops.saddle_state[k], loops.centre_state[k],
                 land.invariant(loops.saddle[:, k]), loops.found[k], made.cut,
                 made.error[k]) for k, part in enumerate(made.parts)]
    return out


def _branches(land, made):
    """A Branch of every strip, or part of one, in which loops close."""
    words = dict(land.conic.sides(land.sense))
    for number, branch in enumerate(dict.fromkeys(one[0].branch for one in made), 1):
        kept = [one for one in made if one[0].branch is branch and np.count_nonzero(one[6]) > 1]
        several = len({one[0].side for one in kept}) > 1
        for part, points, off, saddle, centre, invariant, found, cut, error in kept:
            rows = found if not found.all() else slice(None)
            side, piece = words[part.side] if several else "", f", part {part.number}" if part.number else ""
            name = f"branch {number}{side}{piece}"
            yield Branch(name, points[rows], off[rows], saddle[rows], centre[rows], invariant[rows],
                         float(error), cut)
