"""Three spacecraft as an engineer writes them: the first line answers, and a run of another kind agrees."""
import json
import math
import re
from pathlib import Path

import numpy as np
import pytest

import stabilab
from tests.answers.stuck.brute import Craft

ROOT = Path(__file__).parents[3]
BODIES = {name: ROOT / "cases" / f"{name}.toml"
          for name in ("cubesat-3u", "geostationary-22n", "upper-stage")}


@pytest.fixture(scope="module", params=BODIES)
def answered(request):
    path = BODIES[request.param]
    return stabilab.stuck(stabilab.load(path)), Craft(path.read_text())


def test_the_bracket_of_the_time_holds_that_of_a_run_in_the_frame_of_the_file(answered):
    """DOP853 at 1e-13 with the full tensor: good to some 1e-10 of the time."""
    found, craft = answered
    (low, high), (t, _, _) = found.rows[0].time_to_limit, craft.run(2000.0)
    assert low < high <= low * (1 + 1e-9) and low * (1 - 1e-9) < t < high * (1 + 1e-9)


def test_axis_and_sense_are_those_of_a_run_continued_far(answered):
    found, craft = answered
    row = found.rows[0]
    assert row.fate == "spin-up" and row.level in ("certified", "proved")
    axis = row.sense * np.array(found.principal.axes[row.axis - 1])
    _, end, _ = craft.run(6 * min(row.time_to_limit[1], 100), limit=False, rtol=1e-7)
    assert end @ axis > 0.95 * np.linalg.norm(end) > 2 * np.linalg.norm(craft.start)
    assert row.direction == pytest.approx(axis)


def test_torque_and_principal_axes_are_those_of_the_file(answered):
    found, craft = answered
    axes, row = np.array(found.principal.axes), found.rows[0]
    assert row.torque == pytest.approx(craft.torque(),
                                       rel=1e-12) and row.torque_principal == pytest.approx(
                                           axes @ craft.torque(), abs=1e-12)
    moments = found.principal.moments
    assert list(moments) == sorted(moments,
                                   reverse=True) and axes.T @ np.diag(moments) @ axes == pytest.approx(
                                       craft.J, rel=1e-12, abs=1e-10)
    assert np.linalg.det(axes) == pytest.approx(1)


def test_the_largest_rate_before_the_limit_is_the_limit_where_it_is_of_omega(answered):
    found, craft = answered
    row = found.rows[0]
    if np.ndim(craft.limit):
        assert max(craft.limit) < row.largest_rate < math.hypot(*craft.limit)
    else:
        assert row.largest_rate == pytest.approx(craft.limit, rel=1e-12)


@pytest.mark.one_in(3)
@pytest.mark.parametrize("name", BODIES)
def test_the_first_line_answers_in_degrees_and_the_time_that_suits(stabilab, name):
    code, out, err = stabilab("stuck", BODIES[name])
    first = out.splitlines()[0]
    assert code == 0 and not err and first.startswith(f"{name}: SPINS UP about the minor axis, (")
    assert "deg/s in " in first and re.search(r" (s|min) \(", first)
    assert len(out.split("\n\n")[0].splitlines()) <= 5
    code, out, _ = stabilab("stuck", BODIES[name], "--si")
    assert code == 0 and " rad/s in " in out.splitlines()[0] and " s (" in out.splitlines()[0]


def test_all_thrusters_are_ranked_by_time_each_alone(stabilab):
    path, craft = BODIES["geostationary-22n"], Craft(BODIES["geostationary-22n"].read_text())
    code, out, _ = stabilab("stuck", path, "--all-thrusters", "--json")
    rows = json.loads(out)["rows"]
    assert code == 0 and [row["thrusters"] for row in rows] == [["R4"], ["R3"]]
    for row in rows:
        t, _, _ = craft.run(100.0, craft.torque(row["thrusters"]))
        assert row["time_to_limit"][0] == pytest.approx(t, rel=1e-8)
    code, out, _ = stabilab("stuck", path, "--all-thrusters")
    first, second = out.splitlines()[:2]
    assert first.startswith("geostationary-22n: R4 SPINS UP") and second.startswith("R3 SPINS UP")


def test_csv_has_a_line_a_row_in_si(stabilab):
    code, out, _ = stabilab("stuck", BODIES["geostationary-22n"], "--all-thrusters", "--csv")
    head, *lines = out.splitlines()
    assert code == 0 and len(lines) == 2 and all(len(line.split(",")) == len(head.split(","))
                                                 for line in lines)
    assert lines[0].startswith("geostationary-22n,R4,18.87")


@pytest.mark.one_in(2)
@pytest.mark.parametrize("ending", ["png", "svg"])
def test_the_picture_is_written_whole_and_the_same_twice(stabilab, tmp_path, ending):
    files = [tmp_path / f"{n}.{ending}" for n in "ab"]
    for file in files:
        code, out, err = stabilab("stuck", BODIES["geostationary-22n"], "--out", file)
        assert code == 0 and out.startswith("geostationary-22n: SPINS UP") and err == f"written: {file}\n"
    assert files[0].read_bytes() == files[1].read_bytes() and files[0].stat().st_size > 5000


def test_a_picture_of_another_ending_is_refused_before_the_work(stabilab, tmp_path):
    code, out, err = stabilab("stuck", BODIES["geostationary-22n"], "--out", tmp_path / "a.csv")
    assert code == 2 and not out and "expected a name that ends in .png, .svg or .pdf" in err
