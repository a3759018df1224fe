"""The cells of an atlas have one area, the symmetries of the axes, and neighbours over every seam."""
from __future__ import annotations

import itertools

import numpy as np
import pytest

from stabilab.maps import pointed as cells
from stabilab.maps.pointed import Leaves


def solid_angle(outline):
    """Of a closed line of unit vectors seen from the centre: triangles from its own middle, by the formula of
    Van Oosterom and Strackee (1983)."""
    a = outline.mean(axis=0) / np.linalg.norm(outline.mean(axis=0))
    b, c = outline, np.roll(outline, -1, axis=0)
    return abs((2 * np.arctan2(np.cross(b, c) @ a, 1 + b @ a + c @ a + (b * c).sum(axis=1))).sum())


def outlines(level, numbers, pieces):
    """(n, 3 * pieces, 3): directions along the edges of cells, each edge in so many pieces."""
    at = cells.corners(level, numbers) / 2.0**level
    share = (np.arange(pieces) / pieces)[:, None]
    edges = [at[:, n, None] * (1 - share) + at[:, (n + 1) % 3, None] * share for n in range(3)]
    flat = np.concatenate(edges, axis=1)
    return cells.directions(flat.reshape(-1, 3)).reshape(len(at), 3 * pieces, 3)


@pytest.mark.parametrize("level", [0, 1, 3])
def test_areas_are_equal(level):
    numbers = np.arange(cells.count(level))[::max(1, cells.count(level) // 60)]
    found = [solid_angle(outline) for outline in outlines(level, numbers, 800)]
    # a small circle's arc in 800 pieces is short of it by the square of their number
    assert found == pytest.approx(np.full(len(numbers), 4 * np.pi / cells.count(level)), rel=2e-6)
    assert cells.area(level) == pytest.approx(4 * np.pi / cells.count(level), rel=1e-15)


def test_directions_and_places_are_inverse():
    directions = np.random.default_rng(1).normal(size=(5000, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    places = cells.places_of(directions)
    assert np.abs(places).sum(axis=1) == pytest.approx(np.ones(5000), abs=1e-14)
    assert cells.directions(places) == pytest.approx(directions, abs=1e-13)


def test_reflections_and_exchanges_of_axes_map_middles_onto_middles():
    middles = cells.middles(2, np.arange(cells.count(2)))
    assert (middles != 0).all()  # none lies in a principal plane
    ordered = lambda rows: rows[np.lexsort(rows.round(9).T)]
    for order, signs in itertools.product(itertools.permutations(range(3)),
                                          ((1, 1, -1), (-1, 1, 1), (1, -1, -1))):
        assert ordered(middles[:, order] * signs) == pytest.approx(ordered(middles), abs=1e-14)


def test_a_cell_holds_its_middle_and_those_of_its_parts():
    for level in range(5):
        numbers = np.arange(cells.count(level))
        assert (cells.cell_at(level, cells.places(level, numbers)) == numbers).all()
        parts = np.arange(cells.count(level + 1))
        assert (cells.cell_at(level, cells.places(level + 1, parts)) == parts // 4).all()


@pytest.mark.parametrize("level", [0, 1, 2, 4])
def test_neighbours_share_an_edge_over_the_seams_too(level):
    numbers = np.arange(cells.count(level))
    near = cells.neighbours(level, numbers)
    corners = [set(map(tuple, at)) for at in cells.corners(level, numbers).tolist()]
    assert all(len(corners[n] & corners[other]) == 2 for n in numbers for other in near[n])
    assert all(len(set(row)) == 3
               for row in near.tolist()) and all(n in near[other] for n in numbers for other in near[n])


def test_cells_of_several_depths_lie_beside_those_with_which_they_share_an_edge():
    leaves = whole(1)
    for rows in ([0, 7, 20], [3, 4]):
        leaves = cut(leaves, np.array(rows))
    edges = [{frozenset(pair) for pair in itertools.combinations(map(tuple, _fine(level, number)), 2)}
             for level, number in zip(leaves.level.tolist(), leaves.number.tolist())]
    found = {frozenset(pair) for pair in leaves.beside().tolist()}
    assert found == {frozenset((n, m)) for n,
                     m in itertools.combinations(range(len(edges)), 2) if _touch(edges[n], edges[m])}


def _fine(level, number):
    """Corners in units of the depth 3."""
    return (cells.corners(level, np.array([number]))[0] * 2 ** (3 - level)).tolist()


def _touch(one, other):
    """Whether two triangles share more than a corner: an edge of one lies on an edge of the other (whole
    points, straight on the octahedron)."""
    points = lambda edge: {tuple(a + (b - a) * n // 8 for a, b in zip(*edge)) for n in range(9)
                           if all((b - a) * n % 8 == 0 for a, b in zip(*edge))}
    return any(len(points(tuple(a)) & points(tuple(b))) > 1 for a in one for b in other)


@pytest.mark.slow
def test_cutting_follows_a_circle_to_the_last_depth():
    leaves, deepest, axis, height = whole(2), 6, np.array([0.36, 0.48, 0.8]), 0.35
    side = lambda of: np.concatenate([_side(level, number, axis, height) for level,
                                      number in zip(of.level, of.number)])
    while len(rows := leaves.to_cut(side(leaves), deepest)):
        leaves = cut(leaves, rows)
    kinds = side(leaves)
    pairs = leaves.beside()
    across = pairs[kinds[pairs[:, 0]] != kinds[pairs[:, 1]]]
    assert len(across) > 100 and (leaves.level[across] == deepest).all()
    assert (cells.area(leaves.level).sum()) == pytest.approx(4 * np.pi, rel=1e-12)
    assert len(leaves.level) < cells.count(deepest) / 8
    high = cells.area(leaves.level)[kinds].sum()  # by Archimedes a cap of height h has the area 2 pi h
    assert high == pytest.approx(2 * np.pi * (1 - height), abs=cells.area(deepest) * len(across) / 2)


def _side(level, number, axis, height):
    return cells.middles(int(level), np.array([number])) @ axis > height


def whole(level):
    numbers = np.arange(cells.count(level))
    return Leaves(np.zeros_like(numbers), np.full_like(numbers, level), numbers)


def cut(leaves, rows):
    parts, stay = leaves.children(rows), leaves.taken(np.setdiff1d(np.arange(len(leaves.level)), rows))
    joined = Leaves(*(np.concatenate([getattr(stay, name), getattr(parts, name)])
                      for name in ("wheel", "level", "number")))
    return joined.taken(joined.order())
