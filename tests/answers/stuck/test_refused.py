"""What `stuck` cannot be asked, told with the file and the cure; and every fault of a case comes with its
line and key."""
import pytest

from stabilab import load, stuck
from stabilab.errors import InputError

BODY = "[body]\ninertia = [12, 9, 5]\ncentre_of_mass = [0, 0, 0]\n"
THRUSTER = '[[thrusters]]\nname = "A"\nposition = [1, 0, 0]\ndirection = [0, 1, 0]\nforce = "20 mN"\n'
MOTION = "[motion]\nangular_velocity = [0.1, 0.2, 0.2]\n"
STUCK = THRUSTER + "stuck = true\n"


@pytest.mark.parametrize("text, words", [
    (BODY + THRUSTER + MOTION,
     "own.toml: no thruster is stuck and no torque acts: mark one of A with stuck = true, or ask with "
     "--all-thrusters"),
    (BODY + MOTION, "describe one in a table [[thrusters]] with stuck = true"),
    (BODY + STUCK,
     "own.toml: motion: expected x or angular_velocity in [motion]; this command needs a state"),
    ("[scaled]\na = 1\nb = 2\nmu = [0, 0, 1]\n[motion]\nx = [0, 0, 1]\n",
     "own.toml: the motion is in scaled variables"),
    (BODY + STUCK + MOTION + "[effects.resistance]\ncoefficient = 0.1\n",
     "own.toml: this analysis covers a gyrostat and a constant torque"),
    (BODY + STUCK + MOTION + '[limits]\nrate = "10 deg/s"\n',
     "own.toml:13: limits.rate: the limit, 0.174533 rad/s (10 deg/s), is below the rate"),
    (BODY + STUCK + MOTION + "[[wheels]]\nmomentum = 1\n", "own.toml:12: wheels: axis is missing"),
    (BODY + STUCK + STUCK + MOTION,
     'own.toml:11: thrusters.name: two thrusters have the name "A": give each its own'),
    (BODY + STUCK.replace("20 mN", "20 mNewton") + MOTION, "own.toml:8: thrusters.force: "),
    (BODY + STUCK.replace("20 mN", "20 mm") + MOTION, "expected force (N), got length (m)"),
    (BODY.replace("12", "-12") + STUCK + MOTION,
     "own.toml:2: body.inertia: number 1 is -12.0; principal moments are positive")])
def test_it_is_refused_with_the_file_and_the_cure(stabilab, tmp_path, monkeypatch, text, words):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "own.toml").write_text(text)
    code, out, err = stabilab("stuck", "own.toml")
    assert code == 2 and not out and words in err


def test_all_thrusters_needs_one(stabilab, tmp_path):
    (tmp_path / "own.toml").write_text(BODY + "[effects.constant_torque]\ntorque = [0, 0, 1]\n" + MOTION)
    code, out, err = stabilab("stuck", tmp_path / "own.toml", "--all-thrusters")
    assert code == 2 and not out and "the case has no thruster: describe each in a table [[thrusters]]" in err


def test_python_is_told_what_a_case_is(tmp_path):
    with pytest.raises(InputError, match="case.toml: no such file"):
        stuck("case.toml")
    (tmp_path / "own.toml").write_text(BODY + STUCK)
    with pytest.raises(InputError, match="expected angular_velocity"):
        stuck(load(tmp_path / "own.toml"))


def test_json_and_csv_are_not_both(stabilab):
    code, out, err = stabilab("stuck", "cases/upper-stage.toml", "--json", "--csv")
    assert code == 2 and not out and "choose one of --json and --csv" in err


def test_a_sweep_is_answered_combination_by_combination(stabilab, case_file):
    import json
    path = case_file(BODY + STUCK + MOTION + '[sweep]\n"thrusters.A.force" = ["20 mN", "40 mN"]\n', "own")
    code, out, _ = stabilab("stuck", path, "--json")
    assert code == 0 and [(one["case"], one["rows"][0]["torque"][2])
                          for one in json.loads(out)] == [("own-1", 0.02), ("own-2", 0.04)]


def test_a_case_without_a_thruster_is_answered_for_its_torque(case_file):
    path = case_file(BODY + "[effects.constant_torque]\ntorque = [0, 0, 0.02]\n" + MOTION, "own")
    (row,) = stuck(load(path)).rows
    assert row.thrusters == () and row.torque == (0, 0,
                                                  0.02) and row.limit is None and row.time_to_limit is None
