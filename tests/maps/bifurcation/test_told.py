"""Ranges over which equilibria form curves for every value: which, and where these become others, by hand;
and spheres."""
from __future__ import annotations

from fractions import Fraction

import pytest

import stabilab
from stabilab.errors import InputError
from stabilab.maps.bifurcation.equations import ENDLESS
from stabilab.show.maps import bifurcation as words
from stabilab.show.maps import bifurcation_picture as picture
from tests.maps.bifurcation.test_line import written

FREE, START = (0, 0, 0), ("0.1", "0.05", "0.02")


def told(tmp_path, D, lam, M, vary, **options):
    return stabilab.bifurcation(written(tmp_path, D, lam, M, START), vary, **options)


def test_without_a_torque_lines_merge_where_two_moments_become_equal(tmp_path):
    # momentum along rotation, D w + (l, 0, 0) = s w: an axis across the wheel for each moment of its own; two
    # equal ones across it would make a plane
    found = told(tmp_path, (9, 8, 5), (1, 0, 0), FREE, {"inertia[2]": "4:10"})
    assert [event.exact
            for event in found.events] == [5, 9] and {piece.count for piece in found.pieces} == {ENDLESS}
    plane, line = found.events
    assert "plane" in plane.words and "line along omega2" not in line.words
    assert "line along omega3" in line.words
    assert all("line along omega2" in piece.words and "line along omega3" in piece.words
               for piece in found.pieces)


def test_without_a_torque_a_start_changes_nothing(tmp_path):
    found = told(tmp_path, (9, 8, 5), (1, 0, 0), FREE, {"angular_velocity[1]": "-1:1"})
    assert len(found.pieces) == 1 and not found.events and words.text(found).startswith(
        "case: curves of equilibria for -1 ≤ angular_velocity[1] ≤ 1 rad/s")


def test_a_conic_of_a_torque_along_equal_moments_falls_apart_where_its_determinant_vanishes(tmp_path):
    # by hand: w = p n + z e3 with n = e3 x M leaves (D1 - D3)|M|^2 p z - |M|^2 l3 p + (l.n) z + |M|^2 = 0:
    # lines where (D1 - D3)|M|^2 = -l3 l.n, 8 = 2 l3
    found = told(tmp_path, (9, 9, 5), (1, -1, 1), (1, 1, 0), {"momentum[3]": "-9:9"})
    (event,) = found.events
    assert event.exact == Fraction(4) and event.words.count("line") == 2 and [
        piece.words for piece in found.pieces] == ["equilibrium hyperbola"] * 2


@pytest.mark.parametrize("torque, count, at",
                         [((0, "0.3", "0.01"), ENDLESS, []), (("0.1", "0.3", "0.01"), 0, [0])])
def test_a_sphere_has_a_line_of_equilibria_where_the_wheel_is_across_the_torque(tmp_path, torque, count, at):
    # l x w + M = 0 has solutions exactly where l . M = 0
    found = told(tmp_path, (9, 9, 9), ("0.8", 0, 0), torque,
                 {"torque[1]": "-1:1"} if at else {"torque[3]": "-1:1"})
    assert {piece.count
            for piece in found.pieces} == {count} and [event.value for event in found.events] == at
    assert all(event.count == ENDLESS for event in found.events)


def test_a_sphere_without_a_wheel_rests_under_no_torque(tmp_path):
    found = told(tmp_path, (9, 9, 9), FREE, (0, 0, "0.01"), {"torque[3]": "-1:1"})
    (event,) = found.events
    assert [piece.count for piece in found.pieces] == [0, 0]
    assert (event.value, event.words) == (0.0, "every state is an " "equilibrium")


def test_a_sphere_with_a_wheel_keeps_one_stable_equilibrium_on_the_curve_of_the_motion(tmp_path):
    # by hand: the motion keeps w1 = 0.1, and (0, 0, M3) = -(l, 0, 0) x w at w2 = -M3/l; motions near it go
    # round it at the rate l/D
    found = told(tmp_path, (9, 9, 9), ("0.8", 0, 0), (0, 0, "0.01"), {"torque[3]": "-1:1"})
    (piece,) = found.pieces
    (state,) = piece.states
    assert piece.count == 1 and state.at == pytest.approx((0.1, -float(piece.sample) / 0.8, 0),
                                                          abs=1e-15) and state.verdict == "stable"


def test_curves_are_not_drawn_and_two_ranges_of_them_are_refused(tmp_path):
    found = told(tmp_path, (9, 8, 5), (1, 0, 0), FREE, {"momentum[1]": "-1:1"})
    assert "other curves at 0" in words.text(found) and '"words": "line along omega1' in words.json(found)
    with pytest.raises(InputError, match="described in words"):
        picture.write(found, tmp_path / "diagram.png")
    with pytest.raises(InputError, match="vary one number"):
        told(tmp_path, (9, 8, 5), (1, 0, 0), FREE, {"momentum[1]": "-1:1", "momentum[2]": "-1:1"})
