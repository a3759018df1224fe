"""How many equilibria there are as the momentum of the wheels grows."""
from fractions import Fraction
from math import sqrt

import numpy as np
import pytest

from stabilab.equilibrium.circular_orbit import orbit_equilibria, spans
from tests.equilibrium.orbit import newton
from tests.equilibrium.orbit.test_circular_orbit import satellite


@pytest.mark.parametrize("axis, changes, counts, minima", [
    # the branches of a wheel along an axis A split off where h = n |A - B|, the normal in the plane of A and B,
    # and where h = 4 n |A - B|, the vertical there: by hand from x (B y) = y (A x + h) and 4 n a2 . I a3 + a3 . h = 0
    (2, (1, 2, 4, 8), (24, 20, 16, 12, 8), (4, 4, 4, 2, 2)),
    (1, (1, 4), (24, 16, 8), (4, 2, 2)),
    (0, (1, 2, 4, 8), (24, 20, 16, 12, 8), (4, 2, 2, 2, 2))])
def test_a_wheel_along_an_axis_changes_the_number_where_branches_split_off(axis, changes, counts, minima):
    found = spans(satellite((3, 2, 1), [int(n == axis) for n in range(3)]), Fraction(10))
    assert [span.low for span in found] == pytest.approx([0, *changes], rel=1e-15)
    assert [span.high for span in found] == pytest.approx([*changes, 10], rel=1e-15)
    assert (tuple(s.count for s in found), tuple(s.minima for s in found)) == (counts, minima)


def test_the_rate_of_the_orbit_and_the_unit_of_the_momentum_scale_out():
    slow = spans(satellite((3, 2, 1), (2, 4, 2), "1e-6"), Fraction(1, 100))
    unit = spans(satellite((3, 2, 1), (1, 2, 1), 1), Fraction(20))
    assert [s.count for s in slow] == [s.count for s in unit]
    assert [s.high for s in slow[:-1]] == pytest.approx([s.high / 2000 for s in unit[:-1]], rel=1e-14)


def test_a_wheel_in_a_principal_plane_folds_on_an_astroid():
    # (B - A) x y = p y - q x on x^2 + y^2 = n^2 has 4 real roots inside p^(2/3) + q^(2/3) = |n (A - B)|^(2/3)
    found = spans(satellite((3, 2, 1), (1, 1, 0)), Fraction(3))
    astroid = 2 ** -1.5
    assert any(span.high == pytest.approx(astroid, rel=1e-15) for span in found)


def test_a_symmetric_body_with_a_wheel_along_its_axis_loses_families():
    # Likins, Pringle: hyperbolic where h < n |C - A|, conical where h < 4 n |C - A|
    found = spans(satellite((3, 3, 1), (0, 0, 2)), Fraction(6))
    assert [(s.high, s.count, s.families) for s in found] == [(1, 6, True), (4, 4, True), (6, 2, True)]


@pytest.mark.parametrize("seed", (2, pytest.param(3, marks=pytest.mark.slow)))
def test_newtons_method_finds_as_many_between_the_changes(seed):
    rng = np.random.default_rng(seed)
    h = rng.integers(-9, 9, 3)
    one = satellite((3, "2.2", "1.1"), h.tolist())
    for span in spans(one, Fraction(2)):
        momentum = (span.low + 0.2 * (span.high - span.low)) * h  # the program looks near the middle
        assert len(newton.equilibria((3, 2.2, 1.1), momentum, 1.0)) == span.count


def test_a_merged_equilibrium_at_a_change_itself():
    at = orbit_equilibria(satellite((3, 2, 1), (0, 0, 4)))
    before, after = (orbit_equilibria(satellite((3, 2, 1), (0, 0, 4 + Fraction(e)))) for e in ("-1e-9", "1e-9"))
    assert (len(before.points), len(at.points), len(after.points)) == (16, 12, 12)
    assert [one.linear for one in at.points[:2]] == ["degenerate"] * 2
    # the angle of the two next to it grows as the square root of the distance from the change
    tilt = sorted(map(abs, before.points[0].vertical))[1]
    assert sqrt(1e-9) / 10 < tilt < 10 * sqrt(1e-9)
