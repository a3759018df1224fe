"""Cells split along a boundary, and its box dimension, on planes whose boundaries are known."""
from __future__ import annotations

import math

import numpy as np
import pytest

from stabilab.maps import basins as meshes
from stabilab.maps.basins import counted, dimension, refined


def followed(label, cells, depth):
    """(mesh, places asked for) of labels label(x, y) on the unit square."""
    asked = []

    def ask(keys):
        asked.append(keys)
        row, column = np.divmod(keys, (cells[1] << depth) + 1)
        return label(row / (cells[0] << depth), column / (cells[1] << depth))
    return refined(cells, depth, ask), np.concatenate(asked)


def everywhere(label, cells, depth):
    """(rows, columns) of all finest cells whose corners differ, by asking the whole grid."""
    x, y = np.meshgrid(*(np.arange((n << depth) + 1) / (n << depth) for n in cells), indexing="ij")
    found = label(x, y)
    corners = np.stack([found[:-1, :-1], found[:-1, 1:], found[1:, :-1], found[1:, 1:]])
    return np.nonzero((corners != corners[0]).any(axis=0))


def ellipse(rng):
    (cx, cy), (a, b), turn = rng.uniform(0.2, 0.8, 2), rng.uniform(0.1, 0.45, 2), rng.uniform(0, 3)

    def label(x, y):
        u, v = (x - cx) * math.cos(turn) + (y
                                            - cy) * math.sin(turn), (y
                                                                     - cy) * math.cos(turn) - (x
                                                                                               - cx) * math.sin(turn)
        return ((u / a) ** 2 + (v / b) ** 2 < 1).astype(int)
    return label


@pytest.mark.parametrize("seed", range(6))
def test_the_finest_cells_on_a_boundary_are_those_of_the_whole_grid(seed):
    """Oracle: every place of the finest grid is asked."""
    label, cells, depth = ellipse(np.random.default_rng(seed)), (9, 7), 5
    mesh, asked = followed(label, cells, depth)
    row, column = mesh.at(depth, mesh.boundary)
    expected = everywhere(label, cells, depth)
    assert set(zip(row.tolist(),
                   column.tolist())) == set(zip(*(part.tolist() for part in expected))) and len(row)
    assert len(asked) == len(np.unique(asked)) == len(mesh.keys) < 8 * len(row)


def test_a_tongue_between_corners_is_followed_into_cells_whose_own_corners_agree():
    """A tongue narrower than a coarse cell enters cells through the middle of their sides: corners alone
    would stop at the first such cell."""
    tongue = lambda x, y: ((abs(x - 0.43) < 0.03) & (y < 0.9) | (y < 0.05)).astype(int)
    cells, depth = (5, 5), 4
    mesh, _ = followed(tongue, cells, depth)
    row, column = mesh.at(depth, mesh.boundary)
    expected = everywhere(tongue, cells, depth)
    assert set(zip(row.tolist(), column.tolist())) == set(zip(*(part.tolist() for part in expected)))


def test_cells_cover_the_plane_once():
    mesh, _ = followed(ellipse(np.random.default_rng(3)), (4, 6), 4)
    covered = np.zeros((4 << 4, 6 << 4), int)
    for depth, cells in meshes.leaves(mesh):
        for row, column in zip(*mesh.at(depth, cells)):
            step = 1 << 4 - depth
            covered[row * step:(row + 1) * step, column * step:(column + 1) * step] += 1
    assert (covered == 1).all()


def test_refinement_ends_whole_where_it_would_take_too_many_places(monkeypatch):
    monkeypatch.setattr(meshes, "MAX_PLACES", 400)
    mesh, asked = followed(ellipse(np.random.default_rng(0)), (9, 7), 6)
    assert mesh.full and len(asked) <= 400 and mesh.depth < 6 and len(mesh.leaves) == mesh.depth + 1
    row, _ = mesh.at(mesh.depth, mesh.boundary)
    assert len(row) and row.max() < 9 << mesh.depth


@pytest.mark.parametrize("seed", range(30))
def test_a_smooth_boundary_has_dimension_one_within_its_uncertainty(seed):
    rng = np.random.default_rng(seed)
    cells, depth = int(rng.choice([5, 8, 16])), int(rng.integers(4, 8))
    mesh, _ = followed(ellipse(rng), (cells, cells), depth)
    found = dimension(counted(*mesh.at(depth, mesh.boundary), depth))
    assert abs(found.value - 1) <= found.uncertainty < 0.15


def test_a_boundary_like_kochs_has_kochs_dimension():
    """log 4 / log 3, by Koch's construction; the inside of the island between two of its sides is found by
    the rule of its corners."""
    corners = np.array([0.1 + 0.3j, 0.9 + 0.3j])
    for _ in range(8):
        a, b = corners[:-1], corners[1:]
        third = (b - a) / 3
        corners = np.append(np.stack([a, a + third, a + third + third * np.exp(1j * math.pi / 3),
                                      a + 2 * third], axis=1).ravel(), corners[-1])
    from matplotlib.path import Path
    island = Path(np.stack([corners.real, corners.imag], axis=1))
    label = lambda x, y: island.contains_points(np.stack([np.ravel(x), np.ravel(y)], axis=1)).astype(int)
    mesh, _ = followed(label, (8, 8), 5)
    upper = mesh.at(5, mesh.boundary)
    keep = upper[1] > 0.31 * (8 << 5)  # the closing line below is straight
    found = dimension(counted(upper[0][keep], upper[1][keep], 5))
    assert abs(found.value - math.log(4) / math.log(3)) <= found.uncertainty < 0.2


def test_too_little_of_a_boundary_has_no_dimension():
    assert "no boundary" in dimension((0, 0, 0, 0)).because and math.isnan(dimension((0, 0, 0)).value)
    few = dimension((1, 2, 4, 8, 16))
    assert math.isnan(few.value) and few.used == (3, 4) and "go deeper" in few.because
