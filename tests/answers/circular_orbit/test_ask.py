"""`stabilab.circular_orbit` and `stabilab orbit`: what they say of a case."""
import json

import numpy as np
import pytest

import stabilab as package
from stabilab.errors import InputError

BOOM = """
[body]
inertia = {}
{}
[[wheels]]
axis = {}
momentum = "1.3 N m s"
[circular_orbit]
altitude = "800 km"
"""
PLAIN = BOOM.format([2530, 2560, 85], "", [0, -1, 0])


def test_vectors_of_the_json_are_in_the_frame_of_the_file(stabilab, tmp_path):
    """A tensor turned by 30 degrees about x gives the attitudes turned by as much, by another solution."""
    c, s = 0.8, 0.6  # exactly orthogonal
    turn = np.array([[1, 0, 0], [0, c, -s], [0, s, c]])
    tensor = (turn @ np.diag([2530.0, 2560, 85]) @ turn.T).round(6).tolist()
    for name, text in (("plain", PLAIN), ("turned", BOOM.format(tensor, "", (turn @ [0, -1, 0]).tolist()))):
        (tmp_path / f"{name}.toml").write_text(text)
    plain, turned = (json.loads(stabilab("orbit", tmp_path / f"{name}.toml", "--json")[1])
                     for name in ("plain", "turned"))
    assert turned["momentum"] == pytest.approx((turn @ plain["momentum"]).tolist(), abs=1e-12)
    assert len(plain["equilibria"]) == len(turned["equilibria"]) == 16
    rows = [np.array([one["velocity"], one["normal"], one["vertical"]]) for one in turned["equilibria"]]
    for one in plain["equilibria"]:
        expected = np.array([one["velocity"], one["normal"], one["vertical"]]) @ turn.T
        assert min(np.abs(row - expected).max() for row in rows) < 1e-9  # the tensor is given to so many digits
    assert {one["verdict"] for one in turned["equilibria"]} == {"stable", "unstable"}


@pytest.mark.parametrize("text, words", [
    (PLAIN, "16 EQUILIBRIA, 2 STABLE"),
    (BOOM.format([2530, 2560, 85], "", [0, -1, 0]).replace("1.3 N", "130 N"), "8 EQUILIBRIA, 2 STABLE, 2 undecided (gyro"),
    (BOOM.format([2530, 2530, 85], "", [0, 0, 1]), "FAMILIES OF EQUILIBRIA, 2 STABLE"),
    ("body.inertia = [2, 2, 2]\ncircular_orbit.rate = 1\n", "EVERY ATTITUDE IS AN EQUILIBRIUM"),
])
def test_the_first_line_has_the_answer(stabilab, case_file, text, words):
    path = case_file(text, "one")
    code, out, _ = stabilab("orbit", path)
    assert code == 0 and words in out.splitlines()[0] and "nan" not in out.lower()


def test_strict_leaves_with_3_where_something_is_undecided(stabilab, case_file):
    path = case_file(PLAIN.replace("1.3 N", "130 N"), "one")
    assert stabilab("orbit", path, "--strict")[0] == 3
    path.write_text(PLAIN)
    assert stabilab("orbit", path, "--strict")[0] == 0


@pytest.mark.parametrize("text, up_to, words", [
    (PLAIN, "-1 N m s", "positive momentum"), (PLAIN, "1 km", "up_to: .*length"),
    ("body.inertia = [3, 2, 1.5]\ncircular_orbit.rate = 1\n", 1, "add .*wheels")])
def test_a_momentum_that_cannot_be_varied_is_bad_input(text, up_to, words):
    with pytest.raises(InputError, match=words):
        package.circular_orbit(text, up_to)


@pytest.mark.parametrize("given", (None, {}, 3, "x"))
def test_what_is_no_case_on_an_orbit_is_bad_input(given):
    with pytest.raises(InputError, match="no such file" if given == "x" else "expected a"):
        package.circular_orbit(given)


@pytest.mark.parametrize("old, new", [('altitude = "800 km"', "rate = 1e-90"), ("1.3 N m s", "1e90 N m s"),
                                      ("85", "1e-70")])
def test_numbers_far_beyond_those_of_satellites_are_bad_input(old, new):
    with pytest.raises(InputError, match="are the units"):
        package.circular_orbit(PLAIN.replace(old, new))


@pytest.mark.parametrize("old, new", [('altitude = "800 km"', "rate = 1e-30"), ("1.3 N m s", "1e20 N m s"),
                                      ("1.3 N m s", "1e-20 N m s"), ("85", "1e-20")])
def test_numbers_of_very_different_sizes_have_an_answer(old, new):
    found = package.circular_orbit(PLAIN.replace(old, new)).equilibria
    assert len(found.points) in (8, 16, 24) and found.count("stable") in (2, 4)
    assert all(len(one.frequencies) == 3 and min(one.frequencies) > 0 for one in found.points[:2])


def test_uncertain_numbers_and_irrational_ones_are_said():
    found = package.circular_orbit(PLAIN.replace("2530,", '"2530 +- 10",').replace('altitude = "800 km"',
                                                                                   'period = "100 min"'))
    assert [one.words for one in found.caveats] == ["of the middles of the uncertain numbers"]
    assert len(found.equilibria.points) == 16
    assert "irrational (circular_orbit.period), all are taken to 64 bits" in found.equilibria.because
    turned = package.circular_orbit(PLAIN.replace('altitude = "800 km"', 'rate = "0.06 deg/s"'))
    assert "irrational (circular_orbit.rate)" in turned.equilibria.because
