"""`stabilab when`: the first line, JSON, CSV, units, frames and exit codes."""
from __future__ import annotations

import json
import math
import re

import pytest

import stabilab as package
from stabilab.answers.caveats import known_between
from stabilab.answers.time_to import time_of_case
from stabilab.case.limit_options import stated_limit
from stabilab.errors import InputError
from stabilab.reasons import Quantity
from tests.shared import CASES

CUBESAT, OFF_AXIS, MAJOR = (CASES / f"{name}.toml"
                            for name in ("cubesat-3u", "off-axis-two", "thruster-stuck-major-axis"))


@pytest.mark.parametrize("arguments", [(CUBESAT,), (OFF_AXIS, "--rate", "1000 deg/s"),
                                       (CASES / "top-fast.toml", "--tilt", "z = 10 deg")])
def test_the_text_has_as_many_digits_as_are_read_and_its_bracket_holds_that_of_json(stabilab, arguments):
    """Oracle: the two ends in JSON, in seconds, all digits."""
    ((low, high),) = [row["time"] for row in json.loads(stabilab("when", *arguments, "--json")[1])]
    first, *_ = stabilab("when", *arguments)[1].splitlines()
    a, b, per = (re.search(r"in [\d.]+ (?:s|min) \(\w+ ([\d.]+) to ([\d.]+)\)", first).groups()
                 + (60 if " min (" in first else 1,))
    assert max(len(a),
               len(b)) <= 8 and float(a) * per <= low <= high <= float(b) * per and float(b) - float(
                   a) < 2e-5 * float(b)


def test_a_unit_is_read_as_in_a_case_file(stabilab):
    one, other = (stabilab("when", CUBESAT, "--rate", text, "--csv")[1] for text in ("60 deg/s", "10 rpm"))
    assert one == other and one.splitlines()[0] == "case,quantity,limit,time_low,time_high,level,caveats"


def test_json_tells_never_unknown_and_the_time(stabilab):
    rows = [json.loads(stabilab("when", *arguments, "--json")[1])[0] for arguments in (
        (CUBESAT,), (MAJOR, "--rate", "5"), (CUBESAT, "--until", "5 s"))]
    assert [row["reached"] for row in rows] == ["yes", "never", "unknown"]
    assert all(row["schema"] == "stabilab.when/1" for row in rows)
    assert rows[0]["time"][0] <= rows[0]["time"][1] and rows[1]["time"] is None and rows[1][
        "not_before"] is None
    assert rows[2]["time"] is None and rows[2]["not_before"] == 5 and rows[2]["level"] == "proved"


def test_a_component_counts_in_the_frame_of_the_file_or_along_principal_axes(stabilab):
    case = package.load(CUBESAT)
    file, principal = (time_of_case(case, stated_limit(case, component=f"{axis} = 30 deg/s").ask)
                       for axis in "z3")
    run = package.trajectory(case.scene, case.state, [float(file.low), float(principal.low)])
    z = [float(axis[2]) for axis in case.frame.axes]
    first, second = sorted([0, 1], key=lambda n: (file.low, principal.low)[n])
    at = {first: run.states[0], second: run.states[1]}
    assert abs(abs(sum(a * b for a, b in zip(z, at[0]))) - math.radians(30)) < 1e-10
    assert abs(abs(at[1][2]) - math.radians(30)) < 1e-10


@pytest.mark.slow
def test_limits_of_three_components_are_those_of_the_file(case_file):
    text = CUBESAT.read_text().replace('rate = "60 deg/s"', 'rate = ["90 deg/s", "40 deg/s", "2 deg/s"]')
    path = case_file(text, "three")
    case = package.load(path)
    whole = time_of_case(case, stated_limit(case).ask)
    each = [time_of_case(case, stated_limit(case, component=one).ask).low
            for one in ("x = 90 deg/s", "y = 40 deg/s", "z = 2 deg/s")]
    assert whole.low == min(each)


@pytest.mark.parametrize("option, text, words", [
    ("rate", "30 deg", "--rate: expected angular velocity (rad/s), got angle (rad)"),
    ("rate", "-3", "--rate: expected a positive number"),
    ("rate", "30 degrees/parsec", "--rate: "),
    ("component", "30 deg/s", '--component: expected an axis and its limit, as in "z = 30 deg/s"'),
    ("component", "w = 30 deg/s", "--component: expected an axis"),
    ("energy", "5 N", "--energy: expected"),
    ("tilt", "z = 200 deg", "tilt: expected an angle below half a turn"),
    ("until", "5 m", "--until: expected time (s), got length (m)"),
])
def test_wrong_limits_are_refused_with_the_option_and_the_cure(stabilab, option, text, words):
    code, out, err = stabilab("when", CUBESAT, f"--{option}", text)
    assert code == 2 and not out and words in err


def test_a_case_without_a_limit_says_how_to_give_one(stabilab):
    code, _, err = stabilab("when", OFF_AXIS)
    assert code == 2 and 'off-axis-two.toml: no limit: give --rate "30 deg/s"' in err


def test_two_limits_at_once_are_refused():
    with pytest.raises(InputError, match="expected one limit, got --rate and --energy"):
        stated_limit(package.load(CUBESAT), rate="1", energy="2")


WIDE = """[body]
inertia = [350, 300, 400]
[effects.gyrostat]
momentum = ["418.879 N m s", 0, 0]
[[thrusters]]
position = [1, 0, 0]
direction = [0, 1, 0.1]
force = "1 N"
stuck = true
[motion]
angular_velocity = ["1 deg/s", 0, "0.1 deg/s"]
[limits]
rate = "20 deg/s"
"""


@pytest.mark.slow
@pytest.mark.parametrize("command", ["fate", "when", "stuck"])
def test_a_time_known_between_ends_far_apart_is_said_by_both_ends(stabilab, case_file, command):
    """A middle of 2 and 403 days, with four digits, would say more than is known."""
    out = stabilab(command, case_file(WIDE))[1]
    line = next(line for line in out.splitlines() if "20 deg/s" in line)
    assert re.search(r"(after|in) [\d.]+ (day )?to 40\d(\.\d+)? day \(certified\)", line), out


def test_ends_within_a_tenth_have_a_middle_and_others_have_none():
    assert known_between(100, 110) == Quantity(105, "s")
    assert str(known_between(100, 112)) == "100 s to 112 s"
