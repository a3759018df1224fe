"""What sliders change: the new case is the text that is saved, and nothing else moves."""
import math
from fractions import Fraction
from pathlib import Path

import pytest

from stabilab.case.read import load, read_text
from stabilab.case.write import data_of, text_of
from stabilab.errors import InputError
from stabilab.show.axes import axes_of, with_moments
from stabilab.show.explore import parameters as controls
from stabilab.show.explore import pictures
from stabilab.show.explore.parameters import changed
from stabilab.show.units import units_of

CASES = sorted((Path(__file__).parents[3] / "cases").glob("*.toml"))
NAMED = {path.stem: path for path in CASES}


def asked(**parts):
    return {"torque": None, "inertia": None, "wheel": None, "start": None, **parts}


def moved(name, **parts):
    case = load(NAMED[name])
    return case, changed(case, asked(**parts), units_of(case))[0]


@pytest.mark.parametrize("path", CASES, ids=lambda p: p.stem)
def test_the_text_of_every_case_says_the_same_when_written_anew(path):
    text = path.read_text(encoding="utf-8")
    assert data_of(text_of(data_of(text), "a head\nof two lines")) == data_of(text)


def test_numbers_that_no_hand_touched_stay_as_they_were_written():
    case, new = moved("thruster-stuck-major-axis", wheel=[None, None, "0.25"], start=["7.5", None, None])
    assert new.scene.vector("gyrostat") == (0, 4, Fraction(1, 4))
    assert new.exact_state[1:] == case.exact_state[
        1:] and 'angular_velocity = ["7.5 deg/s", 0.03, -0.02]' in new.text
    assert new.scene.body.exact == case.scene.body.exact and new.scene.vector(
        "constant_torque") == case.scene.vector("constant_torque")


def test_a_case_that_is_saved_states_what_was_seen():
    for name in ("upper-stage", "cubesat-3u", "geostationary-22n", "minor-axis-100", "charged-body",
                 "two-wheels-minor-axis"):
        case = load(NAMED[name])
        n = len(controls.vector(case, "wheel"))
        _, new = moved(name, torque={"axis": 2, "size": "0.5", "tilt": "3", "azimuth": "90"},
                       wheel=["0.125", *[None] * (n - 1)], start=[None, "1.5", None])
        again = read_text("saved.toml", new.text)
        assert (again.scene, again.exact_state, again.span) == (new.scene, new.exact_state, new.span)


def test_the_wheel_of_a_tensor_that_is_not_diagonal_counts_along_its_principal_axes():
    case, new = moved("cubesat-3u", wheel=["0.001", None, None])
    assert new.scene.vector("gyrostat")[0] == Fraction(1, 1000)
    for one, other in zip(case.scene.vector("gyrostat")[1:] + case.scene.body.exact,
                          new.scene.vector("gyrostat")[1:] + new.scene.body.exact):
        assert abs(one - other) <= abs(one) / 10**34  # 36 digits are written
    assert new.frame.as_given and not new.wheels and not new.thrusters


def test_moments_change_one_by_one_and_the_axes_are_called_by_the_new_ones():
    case, new = moved("thruster-stuck-major-axis", inertia=[None, "12.5", None])
    assert new.scene.body.exact == (12, Fraction(25, 2), Fraction(13, 2)) and new.exact_state == case.exact_state
    assert axes_of(new) == with_moments(axes_of(case), new.scene.body.exact)
    assert axes_of(new).ranks == ("intermediate", "major", "minor")
    case, new = moved("cubesat-3u", inertia=["0.05", "0.05", "0.05"])  # of a full tensor: no letters, no ranks
    assert with_moments(axes_of(case), new.scene.body.exact).letters == ("axis 1", "axis 2", "axis 3")


def test_moments_of_no_rigid_body_are_said_to_be_such():
    _, new = moved("thruster-stuck-major-axis", inertia=["20", None, None])  # 9 + 6.5 < 20
    assert [one.kind for one in new.caveats] == ["unphysical"]


def test_a_stuck_thruster_closes_where_a_slider_gives_the_torque():
    case, new = moved("upper-stage", torque={"axis": 3, "size": "2", "tilt": "0", "azimuth": "0"})
    assert tuple(map(float, new.scene.vector("constant_torque"))) == (0, 0, 2)
    assert not any(t.stuck for t in new.thrusters)


def test_a_start_beyond_the_limit_is_explored_without_the_limit():
    case = load(NAMED["cubesat-3u"])
    new, words = changed(case, asked(start=["90", None, None]), units_of(case))
    assert case.limits and new.limits is None and "beyond the limit" in words


def test_what_cannot_be_stated_along_the_principal_axes_is_said_to_be_left_out():
    # limits about x, y, z of a full tensor, and a thruster with a misalignment
    case = load(NAMED["geostationary-22n"])
    _, words = changed(case, asked(wheel=["0.6", None, None]), units_of(case))
    assert "limits about the axes of the file and the misalignment of thrusters" in words
    _, words = changed(case, asked(torque={"axis": 3, "size": "2", "tilt": "0", "azimuth": "0"}),
                       units_of(case))
    assert "limits about the axes of the file." in words and "misalignment" not in words
    assert changed(case, asked(), units_of(case))[1] == ""


@pytest.mark.parametrize("axis, size, tilt, azimuth",
                         [(1, 2.0, 0.0, 0.0), (2, -3.0, 5.0, 90.0), (3, 0.5, 30.0, -120.0),
                          (3, -1.0, 12.0, 45.0)])
def test_size_tilt_and_azimuth_tell_a_torque_back(axis, size, tilt, azimuth):
    assert controls.direction(controls.torque_of(axis, size, tilt,
                                                 azimuth)) == pytest.approx((axis, size, tilt, azimuth),
                                                                            abs=1e-12)


def test_a_torque_on_an_axis_or_in_a_plane_is_there_exactly():
    assert controls.torque_of(2, 3.0, 0.0, 77.0) == (0.0, 3.0, 0.0)
    assert controls.torque_of(1, 2.0, 10.0, 90.0)[1] == 0 == controls.torque_of(1, 2.0, 10.0, -180.0)[2]


@pytest.mark.parametrize("parts", [{"wheel": ["x"]}, {"start": ["nan", None, None]},
                                   {"start": [1.5, None, None]}, {"start": ["1e999", None, None]},
                                   {"torque": {"axis": 4, "size": "1", "tilt": "0", "azimuth": "0"}},
                                   {"torque": {"axis": 1}}, {"inertia": ["0", None, None]},
                                   {"inertia": ["1", "-2", None]}, {"inertia": ["1"]}])
def test_what_is_no_number_is_refused_in_words(parts):
    with pytest.raises(InputError, match="expected"):
        moved("thruster-stuck-major-axis", **parts)


@pytest.mark.parametrize("path", CASES, ids=lambda p: p.stem)
def test_every_slider_holds_the_number_of_its_case(path):
    case = load(path)
    for group in controls.groups(case, units_of(case)):
        for one in group["controls"]:
            assert one["low"] <= one["value"] <= one["high"] and one["low"] < one["high"], one


def test_the_torque_of_a_fast_top_goes_as_far_as_that_of_its_weight():
    """By hand: 2943 N at an arm of (0.7, 0.3, 0.1) m are 2261 N m; what turns 150 rad/s within some radians
    is 300,000 N m."""
    case = load(NAMED["top-fast"])
    size = controls.groups(case, units_of(case))[0]["controls"][0]
    weight = 2943 * math.hypot(0.7, 0.3, 0.1)
    assert weight == pytest.approx(2261, abs=1)
    assert controls.ROOM * weight <= size["high"] == -size["low"] < 4 * weight


def test_a_damper_alike_along_all_axes_is_shown_along_the_principal_ones():
    # proof: a multiple of the unit matrix is the same matrix along all axes
    case, new = moved("cubesat-3u-detumbling", start=[None, "0.1", None])
    pictures.check(case)
    assert new.frame.as_given and new.scene.effect("rate_damper").exact == case.scene.effect(
        "rate_damper").exact
    assert new.scene.body.inertia == pytest.approx(case.scene.body.inertia, rel=1e-15)
    assert new.state[1] == math.radians(0.1) and new.state[::2] == pytest.approx(case.state[::2], rel=1e-15)


def test_a_damper_that_differs_by_the_axis_is_refused_in_oblique_axes():
    text = NAMED["cubesat-3u-detumbling"].read_text(encoding="utf-8")
    unlike = text.replace('coefficient = "2e-5 N m s"', "coefficient = [1e-5, 2e-5, 3e-5]")
    case = read_text("oblique.toml", unlike)
    with pytest.raises(InputError, match="but not rate damper: state the case along its principal axes"):
        pictures.check(case)


@pytest.mark.parametrize("name", ["off-axis-one", "cubesat-3u"])
def test_a_torque_off_the_axes_has_sliders_along_the_axes_of_the_file(name):
    """By the frame: a torque along x of the file alone has no other component there, and its size; what no hand
    touched stays the case's own."""
    case = load(NAMED[name])
    group = controls.groups(case, units_of(case))[0]
    assert [(one["name"], one["words"]) for one in group["controls"]] == [
        ("torque1", "x"), ("torque2", "y"), ("torque3", "z")] and group["axis"] is None
    own = case.scene.vector("constant_torque")
    along = own if case.frame is None else case.frame.back(own)
    assert [one["value"] for one in group["controls"]] == pytest.approx([float(v) for v in along], rel=1e-5)
    _, new = moved(name, torque={"file": ["0.5", "0", "0"]})
    turned = [float(v) for v in new.scene.vector("constant_torque")]
    back = turned if case.frame is None else [float(v) for v in case.frame.back(turned)]
    assert back == pytest.approx([0.5, 0, 0], abs=1e-11)
    _, new = moved(name, torque={"file": [None, None, "0"]})
    turned = [float(v) for v in new.scene.vector("constant_torque")]
    back = turned if case.frame is None else [float(v) for v in case.frame.back(turned)]
    assert back == pytest.approx([float(along[0]), float(along[1]), 0], rel=1e-9, abs=1e-11)
