"""Sheets within an accuracy by the kernel: the grids of the arrays, row by row and column by column, on circles and hyperbolas."""
from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import mpmath as mp
import numpy as np
import pytest

import stabilab
from stabilab import Body, ConstantTorque, Gyrostat, Scene
from stabilab.numbers.numba_door import plain_together
from stabilab.orbit.landscape import landscape
from stabilab.orbit.separatrix import within
from stabilab.orbit.separatrix.compiled import sheets_numba
from stabilab.orbit.separatrix.compiled.sheets_numba import WITHIN, kernel_input, serves_within, sheet_by_kernel
from stabilab.orbit.separatrix.grid import trial_parts
from stabilab.orbit.separatrix.homoclinic import loop_end
from stabilab.orbit.separatrix.saddles import limit_of, saddle_branches
from tests.oracles.pairs import physical, scaled

SCENES = {
    "minor a<b": (scaled(0.2, 0.4, (0, 0, 1))[0], 0.3),
    "major": (physical((3.0, 2.0, 1.5), (0, 0.8, 0.0), (0.2, 0, 0))[0], 0.2),
    "equilibria on lines": (physical((3.0, 2.0, 1.5), (0, 0.8, 0.0), (0, 0, 0.2))[0], 0.3),
    "figure eight": (scaled(0.5, 3.5, (0, 1, 0))[0], 0.3),
    "seam": (Scene(Body(("2.867", "1.661", "3.9")), Gyrostat(("0.15", 0, 0)), ConstantTorque((0, 0, "0.3348"))), 0.06),
}
DIGITS = 1e-9  # of the size: rows and columns stand where sums of square roots of curvatures say, which are differences of differences
names = pytest.mark.parametrize("name", SCENES)


def strips_of(land):
    branches = saddle_branches(land.conic, land.potential, limit_of(land.conic, 4.0))
    return [(branch, side) for branch in branches for side, _ in land.conic.sides(land.sense)]


def plain(land):
    return plain_together(WITHIN[land.base])


@names
def test_the_kernel_in_plain_python_gives_each_sheet_the_grid_of_the_arrays(name, monkeypatch):
    """They share the conic, the cubic of the other equilibria and, where rows are few, the search for a loop's end on circles; nothing of the grading."""
    monkeypatch.setattr(within, "SHARE", -1)  # no sheet takes the shape of another
    scene, accuracy = SCENES[name]
    land = landscape(scene)
    assert serves_within(land)
    for strip in strips_of(land):
        parts, rows = trial_parts(land, (strip,))
        for made, part, row in zip(within.grids_within(land, [strip], accuracy), parts, rows, strict=True):
            points, residual, (saddle, centre), invariant, found, cut, error = sheet_by_kernel(land, part, row, accuracy, plain(land))
            expected = made.loops
            half = expected.points.shape[2]
            size = np.abs(expected.points).max()
            np.testing.assert_allclose(points[:, :half], expected.points[0], atol=DIGITS * size, rtol=0)
            np.testing.assert_array_equal(found, expected.found[0])
            for places, there in ((saddle, expected.saddle), (centre, expected.centre)):
                np.testing.assert_allclose(places, land.components(there[:, 0], np.zeros(len(found))), atol=DIGITS * size, rtol=0)
            np.testing.assert_allclose(invariant, land.invariant(expected.saddle[:, 0]), rtol=1e-6, atol=DIGITS * size**2)
            assert cut == made.cut and error == pytest.approx(made.error[0], rel=1e-6) and error <= accuracy
            assert residual[found].max() < 1e-14


@names
def test_the_second_half_of_a_loop_mirrors_the_first(name):
    scene, accuracy = SCENES[name]
    land = landscape(scene)
    parts, rows = trial_parts(land, tuple(strips_of(land)))
    points, residual, *_ = sheet_by_kernel(land, parts[0], rows[0], 4 * accuracy, plain(land))
    axis, middle = land.reduction.axis, points.shape[1] // 2
    there = np.delete(points[:, ::-1], axis, axis=-1)
    np.testing.assert_array_equal(np.delete(points, axis, axis=-1), there)
    np.testing.assert_allclose(points[:, :middle, axis] + points[:, :middle:-1, axis], 2 * land.reduction.component_i(0.0), atol=1e-15 * np.abs(points).max())
    np.testing.assert_array_equal(residual, residual[:, ::-1])


@names
def test_a_grid_larger_than_the_room_that_is_kept_is_the_same(name, monkeypatch):
    scene, accuracy = SCENES[name]
    land = landscape(scene)
    parts, rows = trial_parts(land, tuple(strips_of(land)))
    kept = sheet_by_kernel(land, parts[0], rows[0], 4 * accuracy, plain(land))
    for room in (0, 6000):  # none for any grid; for the trial rows alone
        monkeypatch.setattr(sheets_numba, "_kept_room", lambda room=room: np.full(room, np.nan))
        for one, other in zip(kept, sheet_by_kernel(land, parts[0], rows[0], 4 * accuracy, plain(land)), strict=True):
            np.testing.assert_array_equal(one, other)


@pytest.mark.parametrize("name", ["minor a<b", "figure eight"])
def test_heights_and_places_of_a_row_are_those_of_the_potential(name):
    """V along the orbit of an equilibrium by its definition, from sines or hyperbolic sines in 40 digits."""
    land = landscape(SCENES[name][0])
    g, use = kernel_input(land)[0], plain(land)
    branch, side = strips_of(land)[0]
    place = use["settled"](g, *map(float, branch.place(0.6)))
    y = side * np.linspace(1e-9, 6.2 if land.base == "circle" else 12.0, 41)
    height, first, second = np.empty((3, len(y)))
    use["risen_row"](g, *place, y, height, first, second)
    with mp.workdps(40):
        x, z = map(mp.mpf, land.xz(place))
        G, c, d, mu = (mp.mpf(float(land.reduction.constants[key])) for key in ("G", "c", "d", "mu"))
        sine, cosine = (mp.sin, mp.cos) if land.base == "circle" else (mp.sinh, mp.cosh)
        e = -1 if land.base == "circle" else 1
        pull = mu + G * x * z + c * z + d * x  # of the rounded place: what an exact equilibrium has not
        for got, p, q, t in zip(height, first, second, map(mp.mpf, y)):
            X, Z = x * cosine(t) + z * sine(t), z * cosine(t) + e * x * sine(t)
            # the force is mu + G X Z + c Z + d X with dX/dy = Z, dZ/dy = e X
            exact = -(mu * t + G * (X * X - x * x) / 2 + c * (X - x) + d * (Z - z) / e) + pull * sine(t)
            scale = abs(mu * t) + abs(G) * (X * X + Z * Z) + (abs(c) + abs(d)) * (abs(X) + abs(Z))
            assert abs(got - exact) <= 1e-14 * scale
            assert abs(land.xz((p, q))[0] - X) + abs(land.xz((p, q))[1] - Z) <= 1e-14 * (abs(X) + abs(Z))


def test_loops_on_hyperbolas_end_where_they_end_for_one_state():
    land = landscape(SCENES["figure eight"][0])
    g, use = kernel_input(land)[0], plain(land)
    for branch, side in strips_of(land):
        for s in (1e-3, 0.2, 0.7, 1.0):
            saddle = use["settled"](g, *map(float, branch.place(s)))
            one, found = loop_end(land.potential, land.sense, saddle, side), use["loop_end"](g, land.sense, *saddle, side)
            assert (one is None) == (found[2] == 0)
            assert one is None or found[:2] == pytest.approx(one[:2], rel=1e-11)


@pytest.mark.parametrize("name", ["minor a<b", "figure eight"])
def test_a_departure_is_the_energy_above_the_saddle_over_the_size_of_its_terms(name):
    """W faster by a millionth has W^2 times that more of it; the terms are those of W^2/2 - V on places as large as these and their shifts."""
    land = landscape(SCENES[name][0])
    (g, *_), use = kernel_input(land), plain(land)
    branch, side = strips_of(land)[0]
    place = use["settled"](g, *map(float, branch.place(0.6)))
    y, shifts = side * np.linspace(0.01, 0.4, 9), (0.3, 2.0)
    height, first, second, out = np.empty((4, len(y)))
    use["risen_row"](g, *place, y, height, first, second)
    w = np.sqrt(2 * np.maximum(-height, 0))
    use["departure_row"](g, *place, y, first, second, first, second, w, *shifts, out)
    assert out.max() < 1e-15
    use["departure_row"](g, *place, y, first, second, first, second, w * (1 + 1e-6), *shifts, out)
    wide, high = (np.abs(v) + shift for v, shift in zip(land.xz((first, second)), shifts))
    terms = 0.5 * w * w + abs(g[0]) * (wide**2 + high**2) + (abs(g[1]) + abs(g[2])) * (wide + high) + g[3]
    if land.base == "hyperbola":
        terms += g[3] * (wide + high) / np.maximum(np.abs(first), np.abs(second))
    np.testing.assert_allclose(out, w * w * 1e-6 / terms, rtol=1e-4)


@pytest.mark.slow  # compiling takes half a minute for each geometry where numba's cache is empty
@names
def test_compiled_sheets_are_those_of_plain_python_for_any_number_of_threads(name):
    pytest.importorskip("numba")
    scene, accuracy = SCENES[name]
    land = landscape(scene)
    sheets = stabilab.separatrix(scene, accuracy=accuracy, fast=True).sheets
    expected = [sheet_by_kernel(land, part, row, accuracy, plain(land)) for part, row in zip(*trial_parts(land, tuple(strips_of(land))))]
    for sheet, (points, _, _, _, found, cut, error) in zip(sheets, (one for one in expected if one[4].sum() > 1), strict=True):
        np.testing.assert_allclose(sheet.points, points[found], atol=DIGITS * np.abs(points).max(), rtol=0)
        assert sheet.cut == cut and sheet.error == pytest.approx(error, rel=1e-6)
    with ThreadPoolExecutor(4) as pool:
        for again in pool.map(lambda _: stabilab.separatrix(scene, accuracy=accuracy, fast=True).sheets, range(8)):
            assert all(one.points.tobytes() == other.points.tobytes() for one, other in zip(again, sheets, strict=True))


def test_without_a_torque_arrays_answer_circles_however_asked():
    pytest.importorskip("numba")
    scene = physical((3.0, 2.0, 1.5), (0, 0, 0.7), (0, 0, 0))[0]
    land = landscape(scene)
    assert not serves_within(land)
    plain_, fast = (stabilab.separatrix(scene, accuracy=0.05, fast=f).sheets for f in (False, True))
    for one, other in zip(plain_, fast, strict=True):
        np.testing.assert_array_equal(one.points, other.points)
