"""Surfaces within an accuracy on random scenes against Euler's equations: vertices on them, facets near them,
and no part missing."""
from __future__ import annotations

from functools import lru_cache

import numpy as np
import pytest

import stabilab
from benchmarks.random_scenes import drawn
from stabilab import separatrix
from stabilab.show.surface import triangulate
from tests.oracles import homoclinic
from tests.shared import later

SHARE = 1e-3  # of a sheet's size: the accuracy that is asked for
# a rim on a fold and few rows along the saddles; few columns at the outer rim; a figure eight
DEFAULT = (3, 25, 49)
numbers = pytest.mark.parametrize("number",
                                  [*DEFAULT, *later(n for n in range(60) if n not in DEFAULT)])
EPS = 2.0**-52


def surface(number):
    """(oracle's gyrostat, sheets, accuracy, generator); skips scenes without a separatrix."""
    made = _surface(number)
    if made is None:
        pytest.skip("no saddle")
    return *made, np.random.default_rng(number)


@lru_cache(4)
def _surface(number):
    one = drawn(number + 1)[number]
    rough = separatrix(one.scene, shape=(24, 33)).branches
    if not rough:
        return None
    accuracy = SHARE * max(np.abs(sheet.points - sheet.points.mean(axis=(0, 1))).max() for sheet in rough)
    body = homoclinic.Gyrostat(one.moments, one.wheel, one.torque)
    return body, separatrix(one.scene, accuracy=accuracy).branches, accuracy


def beside_a_plane(body, sheet):
    """(n,) rows whose invariant is lost in the rounding of their places: on an open curve that is a plane, no
    loop of its own."""
    _, p, cu, cv = body.coefficients()
    size = (np.abs(sheet.points).max(axis=(1, 2)) + abs(cu) + abs(cv)) ** 2 * (abs(p) + 1)
    return np.abs(body.invariant(sheet.saddle)) < 1e4 * EPS * size


@numbers
def test_vertices_lie_on_the_loop_of_a_saddle_that_no_higher_barrier_hides(number):
    body, sheets, _, rng = surface(number)
    for sheet in sheets:
        rows = np.flatnonzero(~beside_a_plane(body, sheet))[1:]
        for row, column in zip(rng.choice(rows, 4 if len(rows) else 0),
                               rng.integers(0, sheet.points.shape[1], 4)):
            vertex = sheet.points[row, column]
            size = np.abs(sheet.points[row]).max() + sum(map(abs, body.coefficients()[2:]))
            assert homoclinic.in_digits(body, vertex.tolist()) <= 1e-13 * size, (sheet.name, row, column)


@numbers
def test_facets_stray_by_no_more_than_asked(number):
    """To first order, at mid-points of edges between inner rows and columns: at folds and saddles, where no
    slope leads, edges are held as parts of the rim."""
    body, sheets, accuracy, rng = surface(number)
    asked = beyond = 0
    for sheet in sheets:
        rows, half = np.flatnonzero(~beside_a_plane(body, sheet))[2:-1], sheet.points.shape[1] // 2
        for row, column in zip(rng.choice(rows, 6 if len(rows) else 0),
                               rng.integers(min(3, half - 1), half, 6)):
            here, below, beside = sheet.points[row,
                                               column], sheet.points[row - 1,
                                                                     column], sheet.points[row, column + 1]
            for middle in (0.5 * (here + below), 0.5 * (here + beside)):
                far = homoclinic.in_digits(body, middle.tolist())
                asked += 1
                beyond += far == homoclinic.mp.inf
                assert far <= 1.05 * accuracy or far == homoclinic.mp.inf, (sheet.name, row, column)
    assert beyond <= 0.2 * asked  # next to a fold an edge's middle may lie on a curve without a saddle


def test_rows_of_a_long_hyperbola_whose_steps_grow_tenfold_stray_by_no_more_than_asked():
    """A wheel of some fold's size and rows out to a thousand times as far: as above, at mid-points of edges
    between rows of very unequal distances."""
    body = homoclinic.Gyrostat((0.1619448155909737, 0.045896896851083835, 0.16184929154606645),
                               (-3.542460467595858, -0.27482217382798146, 0.0),
                               (0, 0, -0.6218782672186429))
    scene = stabilab.Scene(stabilab.Body(body.inertia), stabilab.Gyrostat(body.wheel),
                           stabilab.ConstantTorque(body.torque))
    accuracy = 13.185715550973878
    sheet = separatrix(scene, 2.2623282727111005, accuracy=accuracy).branches[-1]
    far = sheet.points[1:9, sheet.points.shape[1] // 2]
    assert max(float(homoclinic.in_digits(body, place.tolist()))
               for place in 0.5 * (far[1:] + far[:-1])) <= 1.05 * accuracy


@numbers
def test_no_part_of_a_separatrix_is_missing(number):
    """Places on the loops of saddles that the oracle finds, as far out as half the invariant of the last row,
    whose rim is a coarser one, have a facet nearby; on open curves not so near to the planes that the
    oracle's doubles lose the invariant."""
    body, sheets, accuracy, rng = surface(number)
    limit = max(np.abs(body.invariant(sheet.saddle)).max() for sheet in sheets)
    least = 0.0 if body.closed else 1e-3 * limit
    corner = np.concatenate([mesh.points[mesh.triangles] for mesh in map(triangulate, sheets)])
    for lobe in homoclinic.lobes(body, 0.5 * limit):
        t = rng.uniform(lobe.stretch.low, lobe.stretch.high, 12)
        t = t[np.abs(body.invariant(lobe.stretch.saddle(t))) >= least]
        places = lobe.places(t, rng.uniform(0, 1, len(t)))
        for place in places[np.isfinite(places).all(axis=1)]:
            assert distance_to_facets(place, corner) <= 1.1 * accuracy, (lobe, place)


@pytest.mark.parametrize("number",
                         [31, 82, *later((13, 15, 27, 28, 40, 56, 65, 89, 95, 96, 112, 114, 149, 176, 198))])
def test_no_row_of_a_long_hyperbola_is_missing_where_its_saddle_has_a_loop(number):
    """The oracle looks for the ends on either side of the saddles of the sheet that has the most rows, but
    for the last one's, which may lie on an invariant plane; equilibria stand up to e^20 apart there."""
    one = drawn(number + 1)[number]
    body, sheets = homoclinic.Gyrostat(one.moments, one.wheel,
                                       one.torque), separatrix(one.scene, shape=(9, 17)).branches
    for branch in sorted({sheet.name.split(",")[0] for sheet in sheets}):
        drawn_here = [sheet for sheet in sheets if sheet.name.split(",")[0] == branch]
        saddles = max((sheet.saddle for sheet in drawn_here), key=len)[1:-1]
        for side in (-1, 1):
            assert np.isfinite(homoclinic.far_ends(body, saddles, side)).all()
        assert [len(sheet.points) for sheet in drawn_here] == [9, 9]
        assert max(sheet.residual.max() for sheet in drawn_here) < 1e-14


def test_the_largest_fold_tells_how_far_sheets_on_circles_go():
    body, sheets, _, _ = surface(25)
    assert max(np.abs(body.invariant(sheet.saddle)).max()
               for sheet in sheets) == pytest.approx(16 * homoclinic.largest_fold(body), rel=1e-6)


def distance_to_facets(place, corner):
    """Distance of a place (3,) from the nearest of triangles (t, 3, 3)."""
    a, b, c = corner.transpose(1, 0, 2)
    normal, way = np.cross(b - a, c - a), place - a
    with np.errstate(all="ignore"):
        square = np.sum(normal * normal, axis=1)
        v = np.sum(np.cross(way, c - a) * normal, axis=1) / square
        w = np.sum(np.cross(b - a, way) * normal, axis=1) / square
        inside = (v >= 0) & (w >= 0) & (v + w <= 1)
        found = [np.min(np.abs(np.sum(way * normal, axis=1)) / np.sqrt(square), where=inside, initial=np.inf)]
    for start, end in ((a, b), (b, c), (c, a)):
        edge = end - start
        share = np.clip(np.sum((place - start) * edge,
                               axis=1) / np.maximum(np.sum(edge * edge, axis=1), 1e-300), 0, 1)
        found.append(np.linalg.norm(start + share[:, None] * edge - place, axis=1).min())
    return float(min(found))
