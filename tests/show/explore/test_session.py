"""What a page is answered: the same as the questions answer, drawn in places that lie where they should."""
import math
import re

import numpy as np
import pytest

from stabilab import load, motion, separatrix
from stabilab.case.read import read_text
from stabilab.errors import InputError
from stabilab.orbit.phase_plane import phase_plane
from stabilab.show.explore.pictures import plane_of, unframed
from stabilab.show.explore.session import FOLLOWED, Session, Stopped
from stabilab.show.space import reach
from stabilab.show.text.headline import headline
from tests.shared import MOVING
from tests.shared import case as case_of


def ask(session, **asked):
    header, numbers = unframed(session.answer(asked))
    return header, numbers


def row(numbers, told):
    return np.frombuffer(numbers, {"int16": "<i2", "float32": "<f4"}[told["type"]], told["count"],
                         told["from"])


def test_axes_are_those_of_the_file_that_was_opened_also_of_a_changed_case():
    """Expected by NumPy's eigenvectors: the least moment of the file's tensor is about its y axis but for
    half a degree."""
    case = case_of("geostationary-22n")
    _, axes = np.linalg.eigh([[5830, -38, 112], [-38, 1240, -24], [112, -24, 5410]])
    where = f"({', '.join(f'{v:.3f}' for v in axes[:, 0] * np.sign(axes[1, 0]))}) in the file's frame"
    for changes in ({}, {"wheel": ["0.6", None, None]}):
        told, _ = ask(Session(case), **changes)
        assert "SPINS UP about the minor axis, negative direction" in told["headline"]
        assert f"; the minor axis is {where}" in told["headline"]
        assert told["rows"][0][0] == "axes" and told["rows"][0][1].endswith(f"; ω3 about the minor axis, {where}")


def test_the_verdict_is_that_of_the_case_that_is_saved(case_file):
    told, _ = ask(Session(case_of("minor-axis-100")), start=[None, None, "30"])
    saved = case_file(told["toml"], "saved")
    case = load(saved)
    assert case.state[2] == 30 and told["fate"] == "spin-up"
    assert told["headline"] == headline(case, motion(case.scene, case.exact_state))


def test_a_moving_hand_gets_the_same_fate_without_the_search_for_the_separatrix():
    session = Session(case_of("thruster-stuck-major-axis"))
    whole, brief = ask(session)[0], ask(session, moving=True)[0]
    assert whole["fate"] == brief["fate"] == "bounded" and "margin, rate" in str(
        whole["rows"]) and "margin, rate" not in str(brief["rows"])
    assert sum(s["rows"] for s in brief["space"]["branches"]) < sum(s["rows"] for s in whole["space"]["branches"])


def test_a_tilted_torque_is_undecided_while_the_hand_moves_and_followed_when_it_rests():
    session, tilted = Session(case_of("thruster-stuck-major-axis")), {
        "torque": {"axis": 1, "size": "0.02", "tilt": "2", "azimuth": "0"}}
    box = ask(session)[0]["space"]["box"]
    told = ask(session, moving=True, box=box, **tilted)[0]
    assert told["space"]["box"] == box and told["space"]["branches"] and told[
        "headline"] == f"UNDECIDED so far: {FOLLOWED}"
    assert told["fate"] == "undecided" and told["plane"] is None
    assert "without its tilt" in told["space"]["words"]
    assert all(s["name"].endswith("without the tilt") for s in told["space"]["branches"])
    assert ask(session, **tilted)[0]["fate"] == "spin-up"


def test_a_kind_of_motion_that_took_long_waits_until_the_hand_rests(monkeypatch):
    # a wheel along the torque leaves no integral
    session, along = Session(case_of("thruster-stuck-major-axis")), {"wheel": ["1", None, None]}
    assert ask(session, moving=True, **along)[0]["fate"] == "spin-up"
    monkeypatch.setattr("stabilab.show.explore.session.SLOW_SECONDS", 0.0)  # any work takes longer
    assert ask(session, moving=True, **along)[0]["headline"].startswith("UNDECIDED so far: keep still")
    assert ask(session, **along)[0]["fate"] == "spin-up"


def test_a_motion_is_followed_no_longer_once_a_newer_question_has_come():
    tilted = {"torque": {"axis": 1, "size": "0.02", "tilt": "2", "azimuth": "0"}}
    with pytest.raises(Stopped):
        Session(case_of("thruster-stuck-major-axis")).answer(tilted, lambda: True)


def test_the_drawn_surface_is_the_separatrix():
    case = case_of("thruster-stuck-major-axis")
    told, numbers = ask(Session(case))
    space, per_degree = told["space"], np.pi / 180
    middle, half = np.array(space["middle"]) * per_degree, np.array(space["half"]) * per_degree
    # the same scene, farther out and finer; every drawn place inside the box lies on one of its facets' size
    exact = np.concatenate([s.points.reshape(-1, 3)
                            for s in separatrix(case.scene, reach=60.0, shape=(400, 401)).branches])
    for branch in space["branches"]:
        places = row(numbers, branch["at"]).reshape(-1, 3) / 4095
        inside = middle + half * places[(np.abs(places) < 1).all(axis=1)][::17]
        assert len(inside) and max(np.linalg.norm(exact - p, axis=1).min() for p in inside) < 0.04 * half.max()


def test_the_box_stays_while_the_motion_stays_in_it():
    session = Session(case_of("minor-axis-100"))
    first = ask(session)[0]["space"]["box"]
    assert ask(session, box=first, moving=True, start=["2.6", None, None])[0]["space"]["box"] == first
    assert ask(session, box=first, moving=True, start=["60", None, None])[0]["space"]["box"] != first


@pytest.mark.parametrize("name", ["minor-axis-100", "thruster-stuck-major-axis", "middle-axis-double-well",
                                  "torque-free-body", "symmetric-spin-up"])
def test_the_plane_in_plain_floats_is_that_in_arrays(name):
    case = case_of(name)
    plain, arrays = plane_of(case.scene, case.state), phase_plane(case.scene, case.state)
    if arrays is None:
        assert plain is None
        return
    heights = arrays.height(np.array(plain.y))
    assert np.allclose(plain.heights, heights, rtol=1e-9,
                       atol=1e-9 * np.abs(heights).max()) and plain.unit == pytest.approx(arrays.unit)
    for y, _, saddle in plain.rests:
        near = arrays.repeated(arrays.saddles if saddle else arrays.centres, y - 1e-6, y + 1e-6)
        assert len(near) >= 1
    for y, W in ((0.3, 0.7), (-0.4, -1.1)):
        state = arrays.states(np.array(y), np.array(W))
        assert plain.state(y * plain.unit,
                           float(state[plain.reduction.axis])) == pytest.approx(state, rel=1e-9, abs=1e-9)
        assert plain.rate(W) == pytest.approx(float(state[plain.reduction.axis]))


def test_a_click_in_the_phase_plane_starts_there():
    session = Session(case_of("thruster-stuck-major-axis"))
    told = ask(session, click={"turn": 0.0, "rate": 25.0})[0]
    assert [float(v) for v in told["start"]] == pytest.approx([25.0, 0.03 * 180 / np.pi, -0.02 * 180 / np.pi],
                                                              rel=1e-6)


@pytest.mark.one_in(2)
@pytest.mark.parametrize("size, refused", [("1e8", False), ("-1e8", False), ("1e-300", False),
                                           ("1.1e8", True), ("1e200", True)])
def test_numbers_of_any_size_are_drawn_or_refused_in_words(size, refused):
    session = Session(case_of("thruster-stuck-major-axis"))
    for asked in ({"start": [size, None, None]}, {"wheel": [None, size, None]},
                  {"torque": {"axis": 3, "size": size, "tilt": "0", "azimuth": "0"}}):
        header, _ = ask(session, moving=True, **asked)
        assert ("which can still be drawn" in header.get("error",
                                                         "")) == refused and ("headline" in header) != refused


def test_the_rates_of_a_body_in_a_medium_lose_their_momentum_as_they_should():
    text = """[body]
inertia = [12, 9, 5]
[effects.resistance]
coefficient = 0.03
[motion]
angular_velocity = [0.1, 0.5, 0.2]
span = [0, 30]
[output]
units = "si"
"""
    told, numbers = ask(Session(read_text("medium.toml", text)), moving=True)
    t, rates = row(numbers,
                   told["time"]["times"]), np.array([row(numbers, one) for one in told["time"]["rates"]])
    size = np.linalg.norm(np.array([[12], [9], [5]]) * rates, axis=0)
    # by hand: H' = -c H + H x omega
    assert t[-1] == 30 and size == pytest.approx(size[0] * np.exp(-0.03 * t), rel=1e-5)


@pytest.mark.parametrize("torque, rate", [("1e150", "0.1"), ("0.02", "1e200"), ("1e150", "1e90")])
def test_a_case_file_with_numbers_that_no_double_can_follow_is_refused_in_words(torque, rate):
    text = (
        f"[body]\ninertia = [12, 9, 5]\n[effects.constant_torque]\ntorque = [0, 0, "
        f"{torque}]\n[motion]\nangular_velocity = [{rate}, 0, 0.1]\n")
    told, _ = ask(Session(read_text("huge.toml", text)), moving=True)
    assert "too fast to be drawn" in told["error"] and "expected" in told["error"]


def test_no_two_things_in_space_have_one_colour():
    legend = ask(Session(case_of("middle-axis-double-well")),
                 start=["-1.57", "1.027", "0.43"])[0]["space"]["legend"]
    assert len(legend) >= 8 and len({colour for _, colour in legend}) == len(legend)


def test_a_branch_keeps_its_colour_while_others_come_into_the_box_and_go():
    session = Session(case_of("thruster-stuck-major-axis"))
    near, far = (dict(ask(session, **asked)[0]["space"]["legend"])
                 for asked in ({}, {"start": ["49.8", "118.5", "-53.6"]}))
    branches = [{name: colour for name, colour in legend.items() if name.startswith("Branch")}
              for legend in (near, far)]
    assert 0 < len(branches[0]) < len(branches[1]) and branches[0].items() <= branches[1].items()


def test_a_tensor_that_is_not_diagonal_is_refused_beside_a_damper_of_three_with_what_to_do():
    turned = ("[body]\ninertia = [[9.41, 0.1, 0], [0.1, 9.39, 0], [0, 0, 9]]\n[effects.rate_damper]\n"
              "coefficient = [1, 2, 3]\n[motion]\nangular_velocity = [0.1, 0.2, 0.3]\n")
    with pytest.raises(InputError, match="principal axes .*or ask stabilab classify or report"):
        Session(read_text("turned.toml", turned))


def test_a_curve_of_equilibria_is_told_by_a_state_on_each_piece():
    """Torque on axis 3, wheel along axis 1: by Euler's third equation w2 (l1 + (D1 - D2) w1) = -M3 there."""
    told = unframed(Session(load(MOVING)).answer({}))[0]["equilibria"]["rows"]
    assert [verdict for _, verdict in told] == ["unstable", "stable", "unstable"]
    for where, _ in told:
        w1, w2, w3 = (math.radians(float(v))
                      for v in re.search(r"such as \((.*)\) deg/s", where)[1].split(", "))
        assert w3 == 0 and (0.8 + (12 - 9) * w1) * w2 == pytest.approx(-0.02, rel=1e-3)


def test_the_places_of_a_curve_are_formed_once_while_the_box_grows_with_the_start(monkeypatch):
    """Counted; the places drawn are those of a session that begins with the box as it is in the end."""
    session, formed, form = Session(load(MOVING)), [], reach._place
    own = float(session.about()["groups"][2]["controls"][0]["value"])
    box = ask(session)[0]["space"]["box"]
    monkeypatch.setattr(reach, "_place", lambda curve, t: formed.append((curve.name, t)) or form(curve, t))
    for n in range(3, 9):
        last = {"start": [repr(own * n), None, None], "moving": True}
        told, numbers = ask(session, box=box, **last)
    assert told["space"]["box"] != box and len(formed) == len(set(formed)) > 40
    assert ask(Session(load(MOVING)), box=told["space"]["box"], **last)[0]["space"] == told["space"]


@pytest.mark.parametrize("moving", [False, True])
def test_a_motion_on_an_unstable_plane_is_drawn_on_it_to_its_end_once_the_hand_rests(moving):
    """By hand: x1 + 1 + x3 = 0 for ever, (x1 + 1 + x3)' = x2 (x1 + 1 + x3): floats lose the plane at tau = 5.
    """
    told, numbers = ask(Session(read_text("plane.toml",
                                          "[scaled]\na = 0.5\nb = 1\nmu = [0, 1, 0]\n[motion]\nx = [5, 0, "
                                          "-6]\ntau = [0, 8]\n")), moving=moving)
    tau, (x1, x2, x3) = row(numbers,
                            told["time"]["times"]), (row(numbers, one) for one in told["time"]["rates"])
    assert np.abs(x1 + 1 + x3).max() < 0.02 and (1 < tau[-1] < 5 if moving else tau[-1] == 8 and x2[-1] > 12)


def test_the_body_turns_as_its_film_does():
    """Without a torque R (D omega + wheel) rests in space: D = (3, 2, 1), a proof of its own."""
    case = case_of("torque-free-gyrostat")
    for moving in (True, False):
        told, numbers = ask(Session(case), moving=moving)
        film, wheel = told["film"], np.array([float(v) for v in case.scene.vector("gyrostat")])
        rotations = row(numbers, film["rotations"]).reshape(-1, 3, 3)
        assert len(rotations) == film["t"]["count"] == 400 and "λ: momentum of the wheels" in film["words"]
        letter, _, rows = film["arrows"][0]
        assert letter == "H" and np.ptp(row(numbers, rows).reshape(-1, 3), axis=0).max() < 1e-5  # singles
        arrow = row(numbers, film["arrows"][1][2]).reshape(-1, 3)
        assert np.allclose(arrow, rotations @ (1.25 * wheel / np.linalg.norm(wheel)), atol=1e-5)
    assert ask(Session(case_of("minor-axis-100")))[0]["film"] is None  # scaled: no body


@pytest.mark.parametrize("name", ["cubesat-3u", "thruster-stuck-major-axis", "phone"])
def test_a_move_costs_less_than_a_tenth_of_a_second(name):
    """Of the processor's time, moments, wheel and start moved at once; the first answer loads what it needs."""
    session, case = Session(case_of(name)), case_of(name)
    inertia = [str(1.01 * v) for v in case.scene.body.inertia]
    ask(session, moving=True)
    cost = min(ask(session, moving=True, inertia=inertia, start=[None, None, str(0.5 + n / 10)])[0]["work"]
               for n in range(3))
    assert cost < 100
