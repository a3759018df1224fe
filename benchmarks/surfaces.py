"""The separatrix surface as a mesh."""
from __future__ import annotations

from functools import partial

import numpy as np

from stabilab import fate, separatrix
from stabilab.show.surface import triangulate

from .rows import SCENE, A, Row, against
from .timing import side_by_side

HALF = 6.0        # of the side of the cube that the grid of margins fills
REACH = 5.6       # with it the branches go beyond every corner of the cube's section
ACCURACY = 3e-3   # largest distance of our facets from the surface
NOTE = ("ours holds meshing too. What limits it is the number of calls: some hundred of NumPy on arrays of a "
        "thousand numbers "
        "at most (a trial grid, the finished one, the check of the facets) and 80 ends of loops in floats")



def measurements(small=False):
    return [partial(against_flying_edges, 32, 2, sample=4000, checked=3) if small else against_flying_edges]


def against_flying_edges(cells=512, rounds=7, sample=200_000, checked=24) -> list[Row]:
    """A separatrix mesh against Flying Edges on a cells^3 grid of margins: contouring alone with the field
    given, and with the filling of the field. Errors of both are taken at the centres and at the mid-points of
    the edges of the triangles, to first order at `sample` of them and exactly at the `checked` worst.
    """
    axis = np.linspace(-HALF, HALF, cells)
    grid = _field(axis)
    theirs = _contour(grid)
    their_error = _largest_distance(_between(np.asarray(theirs.points, float),
                                             theirs.faces.reshape(-1, 4)[:, 1:]), sample, checked)
    meshes = _mesh()
    assert all(np.linalg.norm(m.points[:, :2] + [A, 0], axis=1).max() > np.hypot(HALF + A, HALF)
               for m in meshes)
    our_error = _largest_distance(np.concatenate([_between(m.points, m.triangles) for m in meshes]), sample,
                                  checked)
    error = (
        f"largest distance of the triangles from the surface: ours {our_error:.1e}, theirs {their_error:.1e}")
    count, found = sum(len(m.triangles) for m in meshes), []
    name = f"separatrix mesh, {count} triangles (1/{theirs.n_cells / count:.0f} of theirs)"
    contouring = partial(_contour, grid)
    for other, what in ((contouring, "contouring alone"),
                        (lambda: _contour(_field(axis)), "margins and contouring")):
        timed = side_by_side(_mesh, other, 1, 1, rounds)
        key = "surface" if other is contouring else "surface-with-field"
        found.append(against(key, name, timed,
                             f"Flying Edges at {cells}^3, {what}, {theirs.n_cells} triangles", error, 1000.0,
                             NOTE, "s"))
    return found


def _mesh():
    return [triangulate(branch) for branch in separatrix(SCENE, reach=REACH, accuracy=ACCURACY).branches]


def _contour(grid):
    return grid.contour([0.0], scalars="margin", method="flying_edges")


def _field(axis):
    """Margins on the cube's grid. The margin at x3 is gap(x1, x2) - x3^2/2: one plane of fates fills the
    whole."""
    import pyvista
    cells = len(axis)
    plane = np.zeros((cells, cells, 3))
    plane[..., 0], plane[..., 1] = axis[:, None], axis
    gap = fate(SCENE, plane).margins
    gap = np.where(np.isfinite(gap), gap, -20.0).astype(np.float32)
    field = np.empty((cells,) * 3, np.float32)  # x3, x2, x1: as the grid has them in memory
    np.subtract(gap.T[None], (0.5 * axis * axis).astype(np.float32)[:, None, None], out=field)
    grid = pyvista.ImageData(dimensions=(cells,) * 3, spacing=(axis[1] - axis[0],) * 3, origin=(-HALF,) * 3)
    grid["margin"] = field.ravel()
    return grid


def _between(points, triangles):
    """Centres and mid-points of the edges of triangles: where a facet strays most from a curved surface."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return np.concatenate([(a + b + c) / 3, (a + b) / 2, (b + c) / 2, (c + a) / 2])


def _largest_distance(points, sample, checked) -> float:
    """Largest distance from the separatrix: first order (|margin|/|grad|) on a sample, exact for the worst of
    it."""
    points = np.random.default_rng(1).permutation(points)[:sample]
    step = 1e-5
    with np.errstate(all="ignore"):
        margin = fate(SCENE, points).margins
        gradient = np.stack([(fate(SCENE, points + d).margins - fate(SCENE, points - d).margins) / (2 * step)
                             for d in step * np.eye(3)], axis=-1)
        first = np.abs(margin) / np.linalg.norm(gradient, axis=-1)
    # no first order on circles without a saddle, just inside a fold: exact there too, beside the worst of the
    # others
    worst = np.argsort(np.where(np.isfinite(first), first, -1.0))[-checked:]
    exact = np.concatenate([points[worst], points[~np.isfinite(first)][:4 * checked]])
    return float(fate(SCENE, exact).velocity_margins.max())
