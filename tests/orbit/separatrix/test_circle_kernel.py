"""Sheets by the kernel for circles: the same points as the arrays give."""
from __future__ import annotations

import numpy as np
import pytest

import stabilab
from stabilab.orbit.landscape import landscape
from stabilab.orbit.separatrix import circle_kernel as circle_loops
from stabilab.orbit.separatrix.compiled.sheets_numba import serves, sheets_by_kernel
from stabilab.orbit.separatrix.saddles import limit_of, saddle_branches
from stabilab.orbit.separatrix.sheets import _by_arrays
from tests.oracles.pairs import physical, scaled

SCENES = {
    "minor a<b": scaled(0.2, 0.4, (0, 0, 1))[0],
    "minor, other sign": scaled(0.2, 1.4, (0, 0, -1))[0],
    "two saddles on a circle": physical((3.0, 2.0, 1.5), (0.4, -0.7, 0), (0, 0, 0.3))[0],
    "major": physical((3.0, 2.0, 1.5), (0, 0.8, 0.0), (0.2, 0, 0))[0],
    "equilibria on lines": physical((3.0, 2.0, 1.5), (0, 0.8, 0.0), (0, 0, 0.2))[0],
}
DIGITS = 1e-12  # of the sheet's size: a unit in the last place of a saddle, times the columns' stretch next to a fold


@pytest.mark.parametrize("name, shape", [("minor a<b", (9, 7)), ("minor, other sign", (7, 8)), ("two saddles on a circle", (7, 9)), ("major", (8, 6)),
                                         ("equilibria on lines", (6, 6))])
def test_the_kernel_in_plain_python_gives_the_sheets_of_the_arrays(name, shape):
    """They share the search for a loop's end where rows are few, not the grading nor the way along the loop."""
    land = landscape(SCENES[name])
    strips = [(branch, -1) for branch in saddle_branches(land.conic, land.potential, limit_of(land.conic, 3.0))]
    assert strips and serves(land, strips)
    points, residual, saddle, centre, found, cut, error = sheets_by_kernel(land, strips, shape, vars(circle_loops))
    made = _by_arrays(land, strips, shape, None)
    there, _, *states, invariant, looped, cuts, strays = (np.array([one[column] for one in made]) for column in range(1, 9))
    size = np.abs(there).max()
    np.testing.assert_array_equal(found, looped)
    np.testing.assert_allclose(points, there, atol=DIGITS * size, rtol=0)
    for places, expected in zip((saddle, centre), states):
        np.testing.assert_allclose(land.components(np.moveaxis(places, -1, 0), np.zeros(found.shape)), expected, atol=DIGITS * size, rtol=0)
    np.testing.assert_allclose(land.invariant(np.moveaxis(saddle, -1, 0)), invariant, rtol=DIGITS)
    assert (cut == cuts).all() and residual.max() < 1e-14
    np.testing.assert_allclose(error, strays, rtol=1e-9)


@pytest.mark.slow  # compiling takes some ten seconds where numba's cache is empty
@pytest.mark.parametrize("name", SCENES)
def test_compiled_sheets_are_those_of_the_arrays(name):
    pytest.importorskip("numba")
    for choice in (dict(shape=(24, 33)), {}):
        plain, fast = (stabilab.separatrix(SCENES[name], fast=f, **choice).sheets for f in (False, True))
        for one, other in zip(plain, fast, strict=True):
            assert one.name == other.name and one.cut == other.cut
            np.testing.assert_allclose(other.points, one.points, atol=DIGITS * np.abs(one.points).max(), rtol=0)
            np.testing.assert_allclose(other.invariant, one.invariant, rtol=1e-12)
            assert other.error == pytest.approx(one.error, rel=1e-9)


def test_scenes_without_a_kernel_are_answered_by_arrays_however_asked():
    pytest.importorskip("numba")
    scene = scaled(0.5, 3.5, (0, 1, 0))[0]
    assert not serves(landscape(scene), ())
    for one, other in zip(*(stabilab.separatrix(scene, shape=(8, 9), fast=f).sheets for f in (False, True)), strict=True):
        np.testing.assert_array_equal(one.points, other.points)


@pytest.mark.parametrize("name", SCENES)
def test_sheets_are_numbered_from_one_and_lie_on_their_surface_to_rounding(name):
    found = stabilab.separatrix(SCENES[name], shape=(6, 9))
    names = [sheet.name for sheet in found.sheets]
    numbers = [int("".join(c for c in word if c.isdigit())) for word in names]
    assert numbers[0] == 1 and len(set(names)) == len(names) and sorted(set(numbers)) == list(range(1, max(numbers) + 1))
    assert max(sheet.residual.max() for sheet in found.sheets) < 1e-14
