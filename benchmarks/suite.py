"""The comparisons: each a function of a size that returns one row."""
from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np

from stabilab import Fate, ScaledGyrostat, extremes, fate, separatrix
from stabilab.show.mesh import triangulate

from .contestants import BatchFate, EventExtremes
from .timing import side_by_side

A, B = 0.2, 0.4  # the paper's minor-axis body at lambda1 = 100
SCENE = ScaledGyrostat(A, B, (0, 0, 1))


@dataclass(frozen=True)
class Row:
    """One comparison: ours, theirs (with units), the ratio with its range, the errors of both, remarks."""

    name: str
    ours: str
    theirs: str
    ratio: float
    spread: tuple[float, float]
    error: str


def random_states(n, seed=20261121):
    """States in the box |x1|, |x2| <= 5, |x3| <= 6: about half of them bounded."""
    return np.random.default_rng(seed).uniform([-5, -5, -6], [5, 5, 6], (n, 3))


def fates(size=1_000_000, sample=10_000, rounds=7) -> Row:
    """Labels of `size` states against heyoka's batch mode with compaction on `sample` of them."""
    states = random_states(size)
    batch = BatchFate(A, B)
    part = states[:sample]
    timed = side_by_side(lambda: fate(SCENE, states), lambda: batch(part), size, sample, rounds)
    answer, brute = fate(SCENE, part), batch(part)
    clear = np.abs(answer.margins) > 1e-9
    wrong = int(((answer.labels == Fate.SPIN_UP) != (brute == 1))[clear].sum())
    return Row(f"fate of {size} states, NumPy", _each(timed.ours), f"{_each(timed.theirs)} heyoka batch with compaction",
               timed.ratio, (timed.low, timed.high), f"{wrong} of {int(clear.sum())} labels differ")


def orbit_extremes(size=20_000, sample=400, rounds=7) -> Row:
    """Extremes of bounded orbits against heyoka with events at the roots of the rates."""
    states = random_states(4 * size)
    states = states[fate(SCENE, states).margins > 1e-3][:size]
    part = states[:sample]
    events = EventExtremes(A, B)
    timed = side_by_side(lambda: extremes(SCENE, states), lambda: events(part), len(states), len(part), rounds)
    difference = np.abs(extremes(SCENE, part) - events(part)).max() / np.abs(part).max()
    return Row(f"extremes of {len(states)} orbits, NumPy", _each(timed.ours), f"{_each(timed.theirs)} heyoka with events",
               timed.ratio, (timed.low, timed.high), f"largest relative difference {difference:.1e}")


def surfaces(cells=512, rounds=7) -> list[Row]:
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


def _each(seconds) -> str:
    return f"{seconds * 1e6:.3g} us each"


def machine() -> str:
    """Machine and versions in one line."""
    import os
    import platform
    from importlib.metadata import version
    packages = ", ".join(f"{p} {version(p)}" for p in ("numpy", "heyoka", "vtk"))
    return f"{os.cpu_count()} cores, {platform.machine()}, Python {platform.python_version()}, {packages}"


def run_all(small=False) -> tuple[list[Row], float]:
    """All rows, and how long they took."""
    start = time.perf_counter()
    rows = ([fates(2000, 50, 2), orbit_extremes(100, 5, 2), *surfaces(32, 2)] if small else
            [fates(), orbit_extremes(), *surfaces()])
    return rows, time.perf_counter() - start
