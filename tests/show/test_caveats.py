"""What limits an answer of a case with a thruster stands in its fate and explorer; the times at a limit by
SciPy, which shares no code."""
from __future__ import annotations

import json
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stabilab as package
from stabilab.answers.caveats import caveats_of
from stabilab.case.read import load
from stabilab.show.explore.session import Session
from tests.oracles.rigid import euler
from tests.shared import craft_file, in_one_line
from tests.show.explore.test_session import ask


def form(inertia=(100, 90, 40), position=(0.1, 0, 0), limits="", **more):
    """A case file: a force of 0.5 N along y at the place, a wheel along x."""
    text = craft_file(inertia, (position, [0, 1, 0], "0.5 N"), [([1, 0, 0], 3)], ["6 deg/s", 0, 0.01], **more)
    return f"{text}span = [0, 50]\n{limits}"


LIMIT = '[limits]\nrate = "7 deg/s"\n'
CASES = {  # name: (the case file, words of the caveat)
    "axis": (form(misalignment="2 deg"), "only while the torque is exactly along "),
    "limit": (form(position=(0.1, 0, 0.05), limits=LIMIT), "reaches 7 deg/s after "),
    "off axis": (form(position=(0.1, 0, 0.05), misalignment="1 deg"), "tilt"),
    "unphysical": (form((8, 4, 0.4)), "no rigid body has "),
    "uncertain": (form(("100 +- 1", 90, 40)), "uncertain"),
    "silent": (form().replace("stuck = true", ""), "no thruster fires: stuck = true "),
}
MOTION = ("axis", "limit", "off axis", "unphysical", "uncertain", "silent")
ATTITUDE = ("--rate", "50 deg/s")


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    folder = tmp_path_factory.mktemp("caveats")
    for name, (text, _) in CASES.items():
        (folder / f"{name.replace(' ', '-')}.toml").write_text(text)
    return {name: folder / f"{name.replace(' ', '-')}.toml" for name in CASES}


def told(name, text) -> bool:
    """In capitals where a headline begins with it, as a sentence where it is one."""
    words, text = CASES[name][1].lower(), text.lower()
    if name == "off axis":  # looked at, or said to be left out
        return "tilt" in text or "the misalignment of a is not looked at here" in text
    if name == "axis":  # a number where the JSON or the CSV has one, else the name
        return any(f"{words}{axis}" in text for axis in ("axis 3", "the z axis", "z (minor axis)"))
    return words in text or (name == "limit" and ("reaches 0.122173 rad/s after " in text
                                                  or "reaches 7 deg/s in " in text))


@pytest.mark.parametrize("name", MOTION)
def test_a_fate_shows_what_limits_its_answer(stabilab, files, name):
    """Of all commands and views: tests/house/test_no_view_loses_a_caveat.py, test_views_of_random_scenes.py."""
    code, out, err = stabilab("fate", files[name])
    assert code == 0, err
    assert told(name, out), out
    assert name != "silent" or "no thruster fires" in out.split("\n")[0], out  # the answer of a forgotten `stuck`


@pytest.mark.parametrize("name", MOTION)
def test_the_explorer_shows_what_limits_its_answer(files, name):
    answer = ask(Session(load(files[name])), moving=False)[0]
    assert told(name, f"{answer['headline']} {answer['note']}")
    assert ("no thruster fires; " in answer["headline"]) == (name == "silent")


def test_a_caveat_is_a_key_of_every_object_and_empty_where_nothing_limits_the_answer(stabilab, files,
                                                                                     case_file):
    free = case_file(form().replace("[[thrusters]]", "[output]").split("[output]")[0]
                     + "[[wheels]]" + form().split("[[wheels]]")[1], "free")
    for command in (("classify",), ("fate",), ("extremes",), ("period",), ("when", *ATTITUDE)):
        found = json.loads(stabilab(command[0], free, *command[1:], "--json")[1])
        assert found[0]["caveats"] == [], command
    motion = package.motion(load(files["axis"]).scene, [0.1, 0, 0.01])
    assert [one.kind for one in motion.caveats] == ["tilt"]
    assert package.time_to(load(files["axis"]).scene, [0.1, 0, 0.01], rate=2).caveats == motion.caveats
    assert caveats_of(load(free).scene, True) == ()


def test_a_limit_that_is_reached_follows_the_fate(stabilab, files):
    """Oracle: SciPy's DOP853 with an event, of Euler's equations written out here."""
    case = load(files["limit"])
    true = first_time(case, np.array([-0.025, 0, 0.05]), math.radians(7))
    parts = stabilab("fate", files["limit"], "--units", "si")[1].split("\n")
    parts = in_one_line("\n".join(parts)).split("; ")
    assert parts[0].startswith("limit: SPINS UP ") and parts[1].startswith("reaches 0.122173 rad/s after ")
    assert float(parts[1].split(" after ")[1].split(" s ")[0]) == pytest.approx(true, rel=2e-4)


@pytest.mark.slow  # 73 runs of DOP853
def test_the_range_over_a_cone_off_the_axes_is_that_of_brute_force(stabilab, files):
    """Oracle: as above, at 72 azimuths of the force and with it as stated."""
    text = CASES["off axis"][0] + LIMIT
    files["off axis"].with_name("range.toml").write_text(text)
    found = json.loads(stabilab("fate", files["off axis"].with_name("range.toml"), "--json")[1])[0]["tilt"]
    arm, force, angle = np.array([0.1, 0, 0.05]), 0.5, math.radians(1)
    times = []
    for azimuth in [None, *np.linspace(0, 2 * math.pi, 72, endpoint=False)]:
        aside = (np.zeros(3) if azimuth is None
                 else math.sin(angle) * np.array([math.cos(azimuth), 0, math.sin(azimuth)]))
        direction = np.array([0, 1.0 if azimuth is None else math.cos(angle), 0]) + aside
        times.append(first_time(load(files["off axis"]), np.cross(arm, force * direction), math.radians(7)))
    assert found["earliest"][0] == pytest.approx(min(times), rel=1e-4)
    assert found["latest"][1] == pytest.approx(max(times), rel=1e-4)
    assert found["earliest"][0] <= min(times) * (1
                                                 + 1e-9) and found["latest"][1] >= max(times) * (
                                                     1 - 1e-9) and found["level"] == "proved"


def first_time(case, torque, rate):
    D, wheel = np.array(case.scene.body.inertia), np.array([3.0, 0, 0])
    at_limit = lambda t, w: np.dot(w, w) - rate**2
    at_limit.terminal = True
    start = [math.radians(6), 0, 0.01]
    run = solve_ivp(euler(D, wheel, torque), (0, 1e4), start, "DOP853",
                    events=at_limit, rtol=1e-11, atol=1e-13)
    return run.t_events[0][0]
