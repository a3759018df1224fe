"""Regular, chaotic, spinning up or undecided: what is said of motions, one by one, in arrays, in sweeps and
on the command line."""
from __future__ import annotations

import json
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import stabilab
from stabilab.answers.chaos import Chaos, Order
from stabilab.case.given import as_case
from stabilab.errors import InputError
from stabilab.maps.plan import planned
from stabilab.maps.run import run
from stabilab.show.maps import chaos as words
from tests.shared import CASES, case
from tests.unreduced.test_chaos import TAME, TOP, WILD


@pytest.mark.slow
def test_arrays_have_a_label_for_each_state():
    found = stabilab.chaos(TOP, [[WILD, TAME]])
    assert found.labels.tolist() == [[Order.CHAOTIC, Order.REGULAR]] and found.history.shape == (1, 2, 6)
    assert found.megno.shape == (1, 2)
    assert found.lyapunov[0, 0] > 5 * found.lyapunov_error[0, 0] > 0 and found.lyapunov[0, 1] == 0


def test_a_motion_that_spins_up_is_not_followed():
    one = case("major-axis-100")
    found = stabilab.chaos(one.scene, one.state)
    assert found.labels == Order.SPIN_UP and np.isnan(found.megno) and "does not come back" in found.because


def test_a_state_at_rest_is_not_chaotic_however_fast_its_neighbours_part():
    """The case states, by hand, that every rate vanishes where two equilibria have merged: a constant motion,
    beside which others part."""
    fold = case("off-axis-fold")
    found = stabilab.chaos(fold.scene, [list(fold.state), [0.1, 0.2, 0.3]])
    assert found.labels[0] == Order.REGULAR and found.megno[0] > 100 and found.lyapunov[0] == 0
    assert words.text(fold, stabilab.chaos(fold.scene, fold.state)).startswith(
        "off-axis-fold: REGULAR; it is an equilibrium")


def test_a_chaotic_motion_followed_briefly_is_undecided_or_regular_so_far_and_the_time_is_told():
    found = stabilab.chaos(TOP, WILD, until=20)
    assert found.labels != Order.CHAOTIC and found.times[-1] == 20 and "turns" in found.because


def test_attitude_and_path_say_nothing_of_the_rates():
    one = case("charged-body")
    assert stabilab.chaos(one.scene, [*one.state, *np.zeros(10)], until=100).labels == Order.REGULAR


@pytest.mark.parametrize("states, until, words",
                         [((1, 2), None, "rows of 6 numbers"), ("abc", None, "rows of 6"), (WILD, 0, "until"),
                          (WILD, "x", "until"),
                                                  ((*WILD[:5], np.nan), None, "not finite")])
def test_bad_input_is_refused(states, until, words):
    with pytest.raises(InputError, match=words):
        stabilab.chaos(TOP, states, until)


def test_because_is_of_one_motion():
    with pytest.raises(InputError, match="one motion"):
        print(stabilab.chaos(TOP, [TAME, TAME], until=20).because)


def test_a_sweep_asks_the_same_of_each_state():
    with run(planned(CASES / "minor-axis-100.toml", {"x[3]": "0.1, 3"}, answer="chaos", follow="200"),
             workers=1) as found:
        pass
    scene = case("minor-axis-100").scene
    expected = stabilab.chaos(scene, [[2.5, 4, 0.1], [2.5, 4, 3]], until=200)
    assert found.records["chaos"].tolist() == expected.labels.tolist() == [Order.REGULAR, Order.SPIN_UP]
    assert found.records["megno"] == pytest.approx(expected.megno, nan_ok=True)


SWEPT = """
[body]
inertia = [12, 10, 7]
[effects.gyrostat]
momentum = [1, 0, 0]
[effects.charge]
charge = 0.01
field = 1
arm = 1
angle = 0
[motion]
angular_velocity = [0.1, 1, 0.2]
attitude = [0, 0, 0]
span = [0, 9]
[sweep]
"motion.angular_velocity" = [[0.1, 1, 0.2], [0.1, 2, 0.2], [1, 0, 0]]
"""


def test_a_sweep_is_one_table_and_the_law_is_told_first(stabilab, case_file):
    path = case_file(SWEPT, "three")
    code, out, _ = stabilab("chaos", path, "--until", "60")
    lines = out.splitlines()
    assert code == 0 and len(lines) == 7 and lines[1].startswith("law: charge: ")
    assert lines[
        0] == "BEYOND THE LAW; by that law: three: 3 combinations: 3 REGULAR as far as it was followed"
    assert lines[2].split() == ["ω[1]", "ω[2]", "ω[3]", "motion", "turns",
                                "MEGNO"] and {line.split()[3] for line in lines[4:]} == {"REGULAR"}
    told = json.loads(stabilab("chaos", path, "--until", "60", "--json")[1])
    assert [one["validity"]["effect"] for one in told] == ["charge"] * 3
    assert [f"{one['megno']:.4f}" for one in told] == [line.split()[-1] for line in lines[4:]]
    assert stabilab("chaos", path, "--until", "60", "--strict")[0] == 3
    rows = [(SimpleNamespace(scene=SimpleNamespace(time_unit="s")),
             Chaos(np.array(label), np.array(6.0), np.array([1.0, 2.0]), np.array([3.0, 6.0]), np.array(0.5),
                   np.array(0.1), 1.0, None)) for label in (Order.CHAOTIC, Order.REGULAR)]
    # ln 2/0.5
    assert words.swept(rows)[1][-1] == ("doubles in",
                                        "s") and [row[-1] for row in words.swept(rows)[2]] == ["1.39", ""]


@pytest.mark.slow
def test_the_picture_of_a_motion_that_passes_no_plane_is_its_number_over_time(tmp_path):
    from stabilab.show.maps import chaos as picture
    one = case("top-fast")
    from stabilab.answers.chaos import row_of
    found = stabilab.chaos(one.scene, row_of(one.scene, one.state, one.blocks), until=5)
    assert picture.write(one, found, tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.slow
def test_the_picture_of_an_island_says_below_its_two_lines_what_motions_go_round(tmp_path, monkeypatch):
    """The plane over its panel, passages and the periodic motion in the middle in the legend."""
    from stabilab.show import style
    from stabilab.show.maps import chaos as picture
    from tests.show.test_section import ISLAND, START
    saved = []
    monkeypatch.setattr(picture, "GRID", 3)
    monkeypatch.setattr(style, "save", lambda figure, path, *rest: saved.append(
        (figure.get_suptitle(), figure.axes[0].get_title(), figure.legends[0].get_title().get_text())))
    picture.write(as_case(ISLAND, START), stabilab.chaos(ISLAND, START, until=50), tmp_path / "a.png")
    ((title, plane, notes),) = saved
    assert title.split("\n")[1:] == ["this motion is regular"] and plane.startswith("passages where")
    assert all(part in notes for part in ("300 passages in", "in the middle: period", "deg a passage"))


def test_of_a_motion_that_spins_up_there_is_nothing_to_see_and_no_file(stabilab, tmp_path):
    """Its MEGNO is no number at all, of which no axis can be made."""
    code, out, said = stabilab("chaos", CASES / "off-axis-one.toml", "--out", tmp_path / "a.png")
    assert code == 0 and "SPIN-UP" in out and not (tmp_path / "a.png").exists()
    assert "no picture is written: it does not come back" in said and "written: " not in said.replace("is written: ", "")


@pytest.mark.parametrize("coefficient", [pytest.param("1e12", marks=pytest.mark.slow), "1"])
def test_a_motion_too_stiff_to_be_followed_is_stopped_and_undecided(monkeypatch, coefficient):
    """A sphere of 1e-12 kg m^2 in a fluid is at rest in it after 1e-12 s/coefficient; a turn takes 10 s."""
    from stabilab.unreduced import chaos as followed
    case = stabilab.load({"body": {"inertia": [3, 2, 1]},
                          "effects": {"viscous_damper": {"inertia": "1e-12", "coefficient": coefficient}},
                          "motion": {"angular_velocity": ["0.1", "0.2", "0.3"]}})
    for crawl in (100, 0):  # 0: by SciPy
        monkeypatch.setattr(followed, "CRAWL", crawl)
        monkeypatch.setattr(followed, "heyoka_available", lambda crawl=crawl: crawl > 0)
        found = stabilab.chaos(case)
        assert found.labels == Order.UNDECIDED and np.isnan(found.history).all() and found.stiff
        assert found.because.startswith("stopped, because the motion is too stiff")
        assert words.text(case, found).count("\n") == 0


def test_of_a_state_at_rest_whose_neighbours_are_too_stiff_no_number_is_printed():
    """By hand: -C w about a moment of 1e-6 kg m^2 is 5e4/s, some 3e5 times a second's turn."""
    case = stabilab.load({"body": {"inertia": ["1e-6", 2, 2]}, "effects": {"rate_damper": {"coefficient": "0.05"}},
                          "motion": {"angular_velocity": [0, 0, 0]}})
    found = stabilab.chaos(case)
    assert found.labels == Order.REGULAR and np.isnan(found.megno)
    assert "nan" not in words.text(case, found) and found.reason.code == "equilibrium-too-stiff"
    begun = replace(found, history=np.array([1.5, *found.history[1:]]))  # given up after its first stage
    assert "nan" not in words.text(case, begun) and "    1.5000\n" in words.text(case, begun)


def test_rates_whose_squares_are_no_doubles_are_followed_in_their_own_time():
    """Of a free body every motion is regular, at any rate."""
    found = stabilab.chaos(stabilab.Scene(stabilab.Body((3, 2, 1))), (1e200, 2e200, 3e200))
    assert found.labels == Order.REGULAR and 1.9 < found.megno < 2.1
