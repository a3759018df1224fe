"""Three spacecraft as an engineer writes them: the first line answers, and a run of another kind agrees."""
import json
from pathlib import Path

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


def test_all_thrusters_are_ranked_by_time_each_alone(stabilab):
    path, craft = BODIES["geostationary-22n"], Craft(BODIES["geostationary-22n"].read_text())
    code, out, _ = stabilab("stuck", path, "--all-thrusters", "--json")
    rows = json.loads(out)["rows"]
    assert code == 0 and [row["thrusters"] for row in rows] == [["R4"], ["R3"]]
    for row in rows:
        t, _, _ = craft.run(100.0, craft.torque(row["thrusters"]))
        assert row["time_to_limit"][0] == pytest.approx(t, rel=1e-8)


@pytest.mark.slow
def test_rows_are_the_same_by_two_processes():
    case = stabilab.load(BODIES["geostationary-22n"])
    assert stabilab.stuck(case, True, workers=2) == stabilab.stuck(case, True, workers=1)


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
