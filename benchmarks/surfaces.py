"""The separatrix surface as a mesh."""
from __future__ import annotations

import numpy as np

from stabilab import fate, separatrix
from stabilab.show.mesh import triangulate

from .rows import SCENE, A, Row
from .timing import side_by_side


def rows(small=False) -> list[Row]:
    return against_flying_edges(32, 2) if small else against_flying_edges()


def against_flying_edges(cells=512, rounds=7) -> list[Row]:
    """A separatrix mesh against Flying Edges on a cells^3 grid of margins: the field's own cost is left out.

    The sheets reach beyond every corner of the box that the grid fills. Errors of both are taken at the centres and at
    the mid-points of the edges of the triangles.
    """
    import pyvista
    half = 6.0
    axis = np.linspace(-half, half, cells)
    field = np.empty((cells, cells, cells), np.float32)
    xy = np.stack(np.meshgrid(axis, axis, indexing="ij"), axis=-1)
    plane = np.concatenate([xy, np.zeros(xy.shape[:2] + (1,))], axis=-1)
    height = fate(SCENE, plane).margins  # gap(x1, x2); the margin at x3 is gap - x3^2/2
    height = np.where(np.isfinite(height), height, -20.0)
    for k, x3 in enumerate(axis):
        field[:, :, k] = height - 0.5 * x3 * x3
    grid = pyvista.ImageData(dimensions=(cells,) * 3, spacing=(axis[1] - axis[0],) * 3, origin=(-half,) * 3)
    grid["margin"] = field.reshape(-1, order="F")
    contour = lambda: grid.contour([0.0], scalars="margin", method="flying_edges")
    ours = lambda: separatrix(SCENE, reach=5.6, shape=(64, 97))
    timed = side_by_side(ours, contour, 1, 1, rounds)
    meshes, mesh = [triangulate(sheet) for sheet in ours().sheets], contour()
    assert all(np.linalg.norm(m.points[:, :2] + [A, 0], axis=1).max() > np.hypot(half + A, half) for m in meshes)
    our_error = _largest_distance(np.concatenate([_between(m.points, m.triangles) for m in meshes]))
    their_error = _largest_distance(_between(np.asarray(mesh.points, float), mesh.faces.reshape(-1, 4)[:, 1:]))
    return [Row(f"separatrix mesh, {sum(len(m.triangles) for m in meshes)} triangles", f"{timed.ours * 1e3:.1f} ms",
                f"{timed.theirs * 1e3:.0f} ms Flying Edges at {cells}^3, {mesh.n_cells} triangles", timed.ratio,
                (timed.low, timed.high),
                f"largest distance of the triangles from the surface: ours {our_error:.1e}, theirs {their_error:.1e}")]


def _between(points, triangles):
    """Centres and mid-points of the edges of triangles: where a facet strays most from a curved surface."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return np.concatenate([(a + b + c) / 3, (a + b) / 2, (b + c) / 2, (c + a) / 2])


def _largest_distance(points, sample=200_000, checked=24) -> float:
    """Largest distance from the separatrix: first order (|margin|/|grad|) on a sample, exact for the worst of it."""
    points = np.random.default_rng(1).permutation(points)[:sample]
    step = 1e-5
    with np.errstate(all="ignore"):
        margin = fate(SCENE, points).margins
        gradient = np.stack([(fate(SCENE, points + d).margins - fate(SCENE, points - d).margins) / (2 * step)
                             for d in step * np.eye(3)], axis=-1)
        first = np.abs(margin) / np.linalg.norm(gradient, axis=-1)
    # no first order on circles without a saddle, just inside a fold: exact there too, beside the worst of the others
    worst = np.argsort(np.where(np.isfinite(first), first, -1.0))[-checked:]
    exact = np.concatenate([points[worst], points[~np.isfinite(first)][:4 * checked]])
    return float(fate(SCENE, exact).velocity_margins.max())
