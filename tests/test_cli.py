"""The commands: what goes to stdout, what to stderr, and which exit code."""
import csv
import functools
import itertools
import json
import math
import os
import signal
import subprocess
import sys
import time
import tomllib
from pathlib import Path

import numpy as np
import pytest

from stabilab import cli
from stabilab.commands import one_case
from stabilab.errors import CaseError
from stabilab.show.command_groups import GROUPS
from tests.recorded.answers import run

ROOT = Path(__file__).parents[1]
CASES = sorted((ROOT / "cases").glob("*.toml"))
MINOR, OFF_AXIS = ROOT / "cases/minor-axis-100.toml", ROOT / "cases/off-axis-two.toml"
STILL = "[body]\ninertia = [3, 2, 1]\n"


def strict_json(text):
    """JSON as the standard has it: NaN and Infinity are refused."""
    return json.loads(text, parse_constant=lambda word: pytest.fail(f"{word} in the JSON"))


@functools.cache
def classified(path):
    """The JSON objects of a case file."""
    said = run("classify", str(path), "--json")
    assert said["exit"] == 0 and not said["message"], said["message"]
    return {answer["case"]: answer for answer in said["answer"]}


MINOR_SWEPT = """[body]
inertia = [3, 2, 1]
[effects.gyrostat]
momentum = [0.5, 0, 0]
[effects.constant_torque]
torque = [0, 0, 0.1]
[sweep]
"effects.gyrostat.momentum" = [[0.5, 0, 0], [0.8, 0, 0], [0, 0, 0]]
"""
each_case = pytest.mark.parametrize("path", [pytest.param(path, id=path.stem, marks=[pytest.mark.slow] * (n % 10 > 0))
                                             for n, path in enumerate(CASES)])


@each_case
def test_case_meets_what_it_expects(path):
    # The expected facts are written in the case files with their proofs; they come from no run of this
    # program.
    from stabilab.case.read import load, load_all
    expect, answer = load(path).expect, classified(path)[load_all(path)[0].name]
    equilibria, motion = answer["equilibria"], answer["motion"]
    assert equilibria["kind"] == expect.get("kind", equilibria["kind"])
    if "points" in expect:
        assert len(equilibria["points"]) == expect["points"]
    if "verdicts" in expect:
        assert [p["verdict"] for p in equilibria["points"]] == expect["verdicts"]
    assert motion["fate"] == expect.get("fate", motion["fate"])
    if "axis" in expect:
        assert motion["axis"] == expect["axis"]
    if "period" in expect:
        assert motion["period"] == pytest.approx(expect["period"], rel=1e-14)
    if "extremes" in expect:
        assert np.allclose(motion["extremes"], expect["extremes"], rtol=1e-14, atol=1e-15)


@each_case
def test_listed_equilibria_are_at_rest(path):
    # Euler's equations written out here, from the numbers of the case alone.
    from stabilab.case.read import load_all
    for case in load_all(path):
        found = classified(path)[case.name]["equilibria"]
        points = [p["at"] for p in found["points"]] + [s["at"] for c in found["curves"] for s in c["samples"]]
        for at in points:
            rate, size = _rate_and_size(case.scene, np.array(at))
            assert np.all(np.abs(rate) <= 2e-14 * size), at


def _rate_and_size(scene, x):
    """(rates, size of their terms): rates times the moments of inertia, then the rates of gamma where the
    state has it."""
    if scene.variables == "scaled":
        terms = np.array([[x[1] * x[2], 0, scene.mu[0]], [-x[2] * x[0], -x[2] * scene.a, scene.mu[1]],
                          [x[1] * x[0], x[1] * scene.b, scene.mu[2]]])
        return terms.sum(axis=1), np.abs(terms).sum(axis=1)
    D, wheel, torque = (np.array(v, float) for v in (scene.body.inertia, scene.vector("gyrostat"),
                                                     scene.vector("constant_torque")))
    if motor := scene.effect("wheel_motor"):  # once it has stopped
        wheel = wheel + np.array(motor.motor) * float(motor.duration)
    w, gamma = x[:3], x[3:] if len(x) > 3 else np.zeros(3)
    charge, drag, field, weight = (scene.effect(n)
                                   for n in ("charge", "resistance", "newtonian_field", "gravity"))
    k = 0.0 if charge is None else charge.strength * (gamma[2] if charge.follows_attitude else 1.0)
    pairs = [(D * w, w), (wheel, w), (w, [0, 0, k])]
    pairs += [(field.strength * gamma, D * gamma)] if field else []
    pairs += [(weight.weight * np.array(weight.centre_of_mass), gamma)] if weight else []
    rate, size = np.array(torque), np.abs(torque)
    for u, v in pairs:
        rate, size = rate + np.cross(u, v), size + np.linalg.norm(u) * np.linalg.norm(v)
    if drag:
        rate, size = rate - drag.coefficient * D * w, size + drag.coefficient * D * np.abs(w)
    if scene.effect("rate_damper"):
        coils = np.array(scene.effect("rate_damper").exact, float)
        rate, size = rate - coils @ w, size + np.abs(coils) @ np.abs(w)
    if scene.effect("liquid_cavity"):
        liquid, scale = _liquid(scene.effect("liquid_cavity"), D, wheel - [0, 0, k], w)
        rate, size = rate + liquid, size + scale
    if len(x) == 3:
        return rate, size
    return np.concatenate([rate, np.cross(gamma, w)]), np.concatenate([size, np.linalg.norm(w) * np.ones(3)])


def _liquid(cavity, D, wheel, w):
    """kappa (w'' + w x w') with w' = [(D w + wheel) x w]/D, by the product rule, and its size."""
    kappa = cavity.density * cavity.P0 / cavity.viscosity
    first = np.cross(D * w + wheel, w) / D
    second = (np.cross(D * first, w) + np.cross(D * w + wheel, first)) / D
    torque = kappa * (second + np.cross(w, first))
    spin = np.linalg.norm(D * w) + np.linalg.norm(wheel)
    return torque, kappa * (spin / D.min()) ** 2 * np.linalg.norm(w) * np.ones(3)


def test_infinite_and_missing_values_become_null():
    from stabilab.show.data import as_json
    value = {"a": [math.inf, -math.inf, math.nan, None, np.float64(0.1), np.int64(3), 1 + 2j],
             "b": np.array([[1.0, np.inf]])}
    assert strict_json(as_json(value)) == {"a": [None, None, None, None, 0.1, 3, [1.0, 2.0]],
                                           "b": [[1.0, None]]}


def test_case_without_a_motion_has_null_for_it(stabilab, case_file):
    path = case_file(STILL, "still")
    code, out, _ = stabilab("classify", path, "--json")
    assert code == 0 and strict_json(out)[0]["motion"] is None


def test_strict_turns_an_undecided_fate_into_exit_code_3(stabilab):
    assert stabilab("classify", OFF_AXIS, "--follow", "1")[0] == 0
    code, out, _ = stabilab("classify", OFF_AXIS, "--strict", "--json", "--follow", "1 s")
    told = strict_json(out)[0]["motion"]
    assert code == 3 and told["fate"] == told["level"] == "undecided" and told[
        "t"] is None and "followed for 1 s" in told["cause"]
    assert stabilab("classify", MINOR, "--strict")[0] == 0


@pytest.mark.parametrize("time", ["-1", "x", "3 kg"])
def test_a_time_to_follow_that_is_none_is_bad_input(stabilab, time):
    code, out, err = stabilab("fate", OFF_AXIS, "--follow", time)
    assert code == 2 and not out and "follow" in err


def test_all_bad_files_are_named_and_nothing_is_printed(stabilab, tmp_path):
    first, second = tmp_path / "first.toml", tmp_path / "second.toml"
    first.write_text("[boby]\n")
    second.write_text("[body]\ninertia = [1, 2, -30]\n")
    code, out, err = stabilab("classify", first, MINOR, second, tmp_path / "third.toml")
    assert code == 2 and not out and "Traceback" not in err
    assert all(f"{path}:" in err for path in (first, second, tmp_path / "third.toml"))


def test_extremes_of_the_ball_with_a_wheel(stabilab):
    # omega turns about the wheel's axis: components across it swing by sqrt(0.3^2 + 0.4^2), by hand.
    code, out, _ = stabilab("extremes", ROOT / "cases/sphere-wheel.toml", "--csv")
    rows = list(csv.DictReader(out.splitlines()))
    assert code == 0 and [row["component"] for row in rows] == ["omega1", "omega2", "omega3"]
    assert np.allclose([[float(row["min"]), float(row["max"])] for row in rows],
                       [[-0.5, 0.5], [-0.5, 0.5], [0.7, 0.7]], rtol=1e-14)


def test_words_with_commas_stay_one_cell_of_csv(stabilab, tmp_path):
    """Of the name of a case and of what the extremes are known over; with every digit asked for, too."""
    for name, text, options in (('two, "wheels"', (ROOT / "cases/off-axis-two.toml").read_text(), ()),
                                ("a, b", (ROOT / "cases/minor-axis-100.toml").read_text(),
                                 ("--digits", "20"))):
        path = tmp_path / f"{name}.toml"
        path.write_text(text)
        code, out, _ = stabilab("extremes", path, "--csv", *options)
        rows = list(csv.reader(out.splitlines()))
        told = strict_json(stabilab("extremes", path, "--json")[1])[0]
        assert code == 0 and [len(row) for row in rows] == [6] * 4
        assert [[row[0], row[4]]
                for row in rows[1:]] == [[told["case"], told["over"]]] * 3 and told["case"] == name


def test_simulate_follows_the_closed_form_of_the_ball(stabilab):
    # D omega' = lambda x omega: a turn about axis 3 at 2 rad/s, by hand.
    code, out, _ = stabilab("simulate", ROOT / "cases/sphere-wheel.toml", "--at", "2,0,0.5", "--json")
    answer = strict_json(out)
    assert code == 0 and answer["t"] == [0.0, 0.5, 2.0]
    assert {"schema": "stabilab.simulate/1", "case": "sphere-wheel", "model": "exact",
            "time": "s"}.items() <= answer.items()
    turned = [(0.3 + 0.4j) * np.exp(2j * t) for t in answer["t"]]
    assert np.allclose(answer["state"]["omega"], [[z.real, z.imag, 0.7] for z in turned], rtol=1e-13)
    assert max(answer["invariant_drift"].values()) < 1e-13 and answer["counters"]["steps"] > 0


def test_every_at_is_taken_and_a_time_named_twice_is_said_to_be_shown_once(stabilab):
    code, out, err = stabilab("simulate", MINOR, "--at", "1,0.5", "--at", "1.0", "--at", "2", "--json")
    assert code == 0 and strict_json(out)["t"] == [0.5, 1, 2]
    assert "--at: named more than once and shown once: 1\n" in err
    assert "--at" not in stabilab("simulate", MINOR, "--at", "1,0.5", "--at", "2", "--json")[2]
    assert "--at: named more than once and shown once: 1\n" in stabilab("reference", MINOR, "--at", "1,1",
                                                                        "--digits", "8", "--json")[2]


def test_simulate_takes_201_times_over_the_span_by_default(stabilab, tmp_path):
    code, out, err = stabilab("simulate", MINOR, "--out", tmp_path / "run.csv")
    rows = list(csv.reader((tmp_path / "run.csv").read_text().splitlines()))
    assert code == 0 and not out and "run.csv" in err
    assert rows[0] == ["tau", "x1", "x2", "x3"] and len(rows) == 202
    assert [float(v) for v in rows[1]] == [0.0, 2.5, 4.0, 0.1] and float(rows[-1][0]) == 15.0


def test_simulate_writes_netcdf_that_reads_back_to_the_last_bit(stabilab, tmp_path):
    xarray = pytest.importorskip("xarray")
    stabilab("simulate", MINOR, "--at", "0,1,2", "--out", tmp_path / "run.nc")
    _, out, _ = stabilab("simulate", MINOR, "--at", "0,1,2", "--json")
    with xarray.open_dataset(tmp_path / "run.nc", engine="scipy") as data:
        assert data["x"].values.tolist() == strict_json(out)["state"]["x"] and data[
            "tau"].values.tolist() == [0, 1, 2]
        assert data.attrs["case"] == MINOR.read_text()
    assert [p.name for p in tmp_path.iterdir()] == ["run.nc"]


@pytest.mark.parametrize("arguments, words", [
    (("--out", "run.txt"), "expected a name that ends in .nc, .csv or .aem"),
    (("--at", "0,soon"), "--at: expected a decimal"),
    (("--at", ""), "--at: expected a decimal"),
    (("--method", "RK54"), "did you mean"),
    (("--rtol", "-1"), "rtol"), (("--rtol", "0"), "rtol: expected a number between 0 and 1, got 0"),
    (("--rtol", "much"), "--rtol"),
    (("--wrong",), "No such option"),
])
def test_wrong_options_of_simulate_end_with_2_and_a_reason(stabilab, arguments, words):
    code, out, err = stabilab("simulate", MINOR, *arguments)
    assert code == 2 and not out and words in err and "Traceback" not in err


@pytest.mark.parametrize("command", [["precision", "--quick"], ["plot"], ["fate"], ["chaos"]],
                         ids=lambda command: command[0])
@pytest.mark.parametrize("time", ["0", "-5", "0 min", "nan", "1e400"])
def test_a_time_to_follow_is_above_zero(stabilab, tmp_path, monkeypatch, command, time):
    monkeypatch.chdir(tmp_path)
    option = "--follow" if command == ["fate"] else "--until"
    code, out, err = stabilab(*command, ROOT / "cases/torque-free-body.toml", f"{option}={time}")
    assert code == 2 and not out and f"{option}: " in err and not list(tmp_path.iterdir())


def test_times_may_have_units(stabilab):
    sphere = ROOT / "cases/sphere-wheel.toml"
    timed, alone = (strict_json(stabilab("simulate", sphere, "--at", at, "--json")[1])
                    for at in ("0.01 min, 500 ms,2", "0.6,0.5,2"))
    assert timed["t"] == [0.5, 0.6, 2.0] and timed["state"] == alone["state"]
    timed, alone = (stabilab("reference", sphere, "--digits", "12", "--at", at)[1].splitlines()
                    for at in ("0.01 min,2", "0.6,2"))
    assert [line for line in timed
            if line.startswith("state,")] == (states := [line for line in alone
                                                         if line.startswith("state,")]) and len(states) == 6
    code, out, err = stabilab("simulate", MINOR, "--at", "1 s")  # scaled time
    assert code == 2 and not out and err.startswith("--at: expected a number without a unit")
    assert stabilab("simulate", sphere, "--at",
                    "1 m")[2].startswith("--at: expected time (s), got length (m)")


def test_a_power_is_no_energy(stabilab):
    code, out, err = stabilab("when", ROOT / "cases/torque-free-body.toml", "--energy", "5 W")
    assert code == 2 and not out and "energy (J), got power (W)" in err


def test_motion_is_asked_for_where_it_is_needed(stabilab, case_file):
    path = case_file(STILL, "still")
    for command in ("extremes", "simulate", "plot"):
        code, out, err = stabilab(command, path)
        assert code == 2 and not out and "this command needs a state" in err


def test_show_tells_equations_of_a_sweep_once_and_again_where_a_term_is_gone(stabilab, case_file):
    path = case_file(MINOR_SWEPT, "two")
    code, out, _ = stabilab("show", path)
    # without the wheel there is a term less, and a law more
    assert code == 0 and out.count("Equations of motion") == 2 == out.count("In LaTeX")
    same, other = out.split("\n\ntwo-3: ")
    assert "hold for 1 other combination" in same and "other combination" not in other
    assert [line.split() for line in same.splitlines()[-2:]] == [["two-1", "0.5"], ["two-2", "0.8"]]


def test_surface_without_a_renderer_writes_the_meshes_and_ends_with_4(stabilab, tmp_path, monkeypatch):
    from stabilab.show import render_probe
    monkeypatch.setattr("stabilab.show.surface.probe",
                        lambda: render_probe.Renderer(False, "no GL here"))
    code, _, err = stabilab("surface", MINOR, "--out", tmp_path)
    assert code == 4 and "no GL here" in err and render_probe.CURE in err
    assert {p.name for p in tmp_path.iterdir()} == {f"{MINOR.stem}.{end}"
                                                    for end in ("vtp", "glb", "stl",
                                                                "json")} | {"manifest.json"}
    assert strict_json((tmp_path / f"{MINOR.stem}.json").read_text())["sheets"]


# -- [sweep]


SWEPT = """title = "swept"
[body]
inertia = [8.7, 8.6, 11.1]
[effects.charge]
charge = 0.001
field = 100
arm = 1
angle = 0.37
[effects.gyrostat]
momentum = [0, 0, 1]
[motion]
angular_velocity = [0.1, 0.2, 0.3]
span = [0, 2]
[sweep]
"motion.angular_velocity" = [[0.1, 0.2, 0.3], [0.3, 0.2, 0.1]]
"effects.gyrostat.momentum" = [[0, 0, 1], [0, 0, 2], [0, 0, 3]]
"""
# two starts times three wheels, the last key running fastest
LABELS = [f"-{i}-{j}" for i in (1, 2) for j in (1, 2, 3)]


@pytest.fixture
def swept(tmp_path, monkeypatch):
    """Two combinations of a gyrostat under a torque on its minor axis, which every command serves, and six of
    a charged body."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "six.toml").write_text(SWEPT)
    plain = MINOR.read_text().split("[expect]")[0]
    (tmp_path / "two.toml").write_text(plain + '\n[sweep]\n"motion.x" = [[2.5, 4, 0.1], [2.5, 4, 0.2]]\n')
    return tmp_path


@pytest.mark.one_in(3)
@pytest.mark.parametrize("command", [["classify"], ["extremes"], ["fate"], ["period"],
                                     ["simulate", "--at", "0,1"], ["compare"]])
def test_every_combination_of_a_sweep_has_its_row_in_json(stabilab, swept, command):
    code, out, err = stabilab(command[0], "six.toml", *command[1:], "--json")
    assert code == 0, err
    assert [row["case"] for row in strict_json(out)] == [f"six{label}" for label in LABELS]


@pytest.mark.one_in(2)
@pytest.mark.parametrize("command", ["classify", "extremes", "fate", "period"])
def test_a_sweep_is_one_table_with_a_column_for_each_swept_key(stabilab, swept, command):
    """The answer, two lines of heads, and a row a combination that begins with what varies, as the file has
    it; no line is wider than a terminal."""
    code, out, err = stabilab(command, "six.toml")
    answer, _, table = out.partition("\n   ")  # of a long answer each clause has a line of its own
    lines = [answer.replace("\n  ", "; "), *("   " + table).splitlines()]
    keys = tomllib.loads(SWEPT)["sweep"]
    moving = {key: [i for i in range(3) if len({row[i] for row in rows}) > 1] for key, rows in keys.items()}
    expected = [[str(value[i]) for key, value in zip(keys, one) for i in moving[key]]
                for one in itertools.product(*keys.values())]
    assert code == 0 and not err and len(lines) == 9 and lines[0].startswith(
        "six: each of 6 BOUNDED for ever")
    assert [line.split()[:len(expected[0])] for line in lines[3:]] == expected
    assert lines[1].split()[:3] == ["ω[1]", "ω[3]", "momentum[3]"]
    assert command == "extremes" or max(map(len, lines[1:])) <= 80


def test_a_combination_of_a_sweep_is_followed_from_its_own_start(stabilab, swept):
    rows = strict_json(stabilab("simulate", "six.toml", "--at", "0", "--json")[1])
    assert [row["state"]["omega"][0] for row in rows] == [[0.1, 0.2, 0.3]] * 3 + [[0.3, 0.2, 0.1]] * 3


@pytest.mark.one_in(2)
@pytest.mark.parametrize("command, ending", [
    (["simulate", "six.toml", "--at", "0,1"], "csv"), (["compare", "six.toml"], "csv"),
    (["plot", "two.toml"], "svg"),
    (["classify", "two.toml", "--certify"], "json"),
    pytest.param(["precision", "two.toml", "--quick", "--until", "1"], "csv", marks=pytest.mark.slow)],
                         ids=lambda value: value[0])
def test_files_of_a_sweep_bear_the_labels_of_its_combinations(stabilab, swept, command, ending):
    code, _, err = stabilab(*command, "--out", f"made.{ending}")
    labels = LABELS if "six.toml" in command else ["-1", "-2"]
    made = sorted(swept.glob("made*"))
    assert code == 0 and [p.name for p in made] == [f"made{label}.{ending}" for label in labels], err
    assert len({p.read_bytes() for p in made}) == len(made)  # each is another


def test_surfaces_of_a_sweep_share_a_folder_and_a_manifest(stabilab, swept, monkeypatch):
    from stabilab.show import render_probe
    monkeypatch.setattr("stabilab.show.surface.probe",
                        lambda: render_probe.Renderer(False, "no GL here"))
    code, out, err = stabilab("surface", "two.toml", "--out", "made", "--json")
    assert code == 4 and [row["case"]
                          for row in strict_json(out)] == ["two-1", "two-2"] and "two-2.vtp" in err
    assert {p.name
            for p in (swept / "made").iterdir()} == {f"two-{i}.{end}" for i in (1, 2)
                                                     for end in ("vtp", "glb", "stl",
                                                                 "json")} | {"manifest.json"}


def test_a_report_has_every_combination_of_a_sweep(swept):
    from stabilab.papers.report import of_all
    assert [case.name for case in of_all(["six.toml", "two.toml"])] == [*(f"six{label}" for label in LABELS),
                                                                        "two-1", "two-2"]


def test_a_combination_that_stops_is_named(stabilab, swept):
    code, _, err = stabilab("simulate", "two.toml", "--at", "1e300")
    assert code == 5 and "two.toml (two-1): " in err and "two.toml (two-2): " in err


def test_a_scene_without_a_separatrix_is_an_answer_and_no_file(stabilab, tmp_path):
    code, out, err = stabilab("surface", ROOT / "cases/middle-axis-100.toml", "--out", tmp_path / "none",
                              "--json")
    assert code == 0 and strict_json(out)["files"] == [] and strict_json(out)["sheets"] == []
    assert "middle-axis-100: no surface to write: " in err and not list(tmp_path.iterdir())


@pytest.mark.parametrize("arguments, known", [
    (("plot", MINOR, "--out", "a.jpg"), ".png, .svg or .pdf"),
    (("plot", MINOR, "--out", "a"), ".png, .svg or .pdf"),
    (("plot", MINOR, "--out", "a.png.gz"), ".png, .svg or .pdf"),
    (("plot", MINOR, "--out", ".png"), ".png, .svg or .pdf"),
    (("simulate", MINOR, "--out", "a.png"), ".nc, .csv or .aem"),
    (("compare", ROOT / "cases/charged-body.toml", "--out", "a.json"), ".csv"),
    (("precision", MINOR, "--out", "a.txt"), ".png, .svg, .pdf or .csv"),
    (("classify", MINOR, "--certify", "--out", "a.toml"), ".json"),
    (("surface", MINOR, "--out", "a.stl"), "a folder"), (("tables", "--out", "a.csv"), "a folder"),
    (("figures", "9", "--out", "a.svg"), "a folder"), (("report", MINOR, "--out", "a.html"), "a folder"),
    (("rerun", ".", "--out", "a.zip"), "")], ids=lambda value: value[0] if isinstance(value, tuple) else None)
def test_an_ending_that_says_something_else_than_what_is_written_is_refused(stabilab, tmp_path, monkeypatch,
                                                                            arguments, known):
    monkeypatch.chdir(tmp_path)
    code, out, err = stabilab(*arguments)
    assert code == 2 and not out and known in err and "Traceback" not in err
    assert not list(tmp_path.iterdir())


def test_tables_writes_every_table_in_every_format_and_names_them(stabilab, tmp_path):
    code, out, _ = stabilab("tables", "--out", tmp_path)
    written = [p for p in tmp_path.iterdir() if p.name != "manifest.json"]
    assert code == 0 and sorted(out.split()) == sorted(map(str,
                                                           written)) and (tmp_path / "manifest.json").exists()
    assert {p.suffix for p in written} == {".txt", ".csv", ".md", ".tex", ".html"} and len(written) == 25


def test_an_intact_certificate_of_another_case_does_not_pass_for_this_one(stabilab, tmp_path, case_file):
    def write(name, momentum="0.8", rate="0.1"):
        path = tmp_path / f"{name}.toml"
        path.write_text(f"[body]\ninertia = [12, 9, 5]\n[effects.gyrostat]\nmomentum = [{momentum}, 0, 0]\n"
                        f"[effects.constant_torque]\ntorque = [0, 0, 0.02]\n[motion]\nangular_velocity = "
                        f"[{rate}, 0.05, 0.02]\n", encoding="utf-8")
        return path
    own, proof = write("own"), tmp_path / "certificate.json"
    assert stabilab("classify", own, "--certify", "--out", proof)[0] == 0
    # other decimals of the same numbers
    code, out, _ = stabilab("verify", proof, "--case", write("same", "8e-1", "0.10"))
    assert code == 0 and out.startswith("PROVED: 16 proved\n"
                                        "about: moments 12 9 5 kg m², wheel 4/5 0 0 N m s, torque 0 0 1/50 N "
                                        "m, state 1/10 1/20 1/50 rad/s\n")
    for other, words, silent in ((write("wheel", momentum="0.8000000000000000001"),
                                  "wheel: the certificate's 4/5 0 0, the case's", "state:"),
                                 (write("start", rate="0.11"),
                                  "state: the certificate's 1/10 1/20 1/50, the case's 11/100 1/20 1/50",
                                  "wheel:")):
        code, out, err = stabilab("verify", proof, "--case", other)
        assert code == 5 and out.replace("\n  ", "; ").startswith(f"OF ANOTHER CASE than {other}; its own claims: PROVED: ")
        assert words in err and silent not in err and other.name in err
    scaled = case_file("[scaled]\na = 0.2\nb = 0.4\nmu = [0, 0, 1]\n", "scaled")
    code, _, err = stabilab("verify", proof, "--case", scaled)
    assert code == 5 and "variables: the certificate's physical, the case's scaled" in err
    assert "state: " in err
    sweep = case_file(own.read_text(encoding="utf-8")
                      + '[sweep]\n"motion.angular_velocity" = [[9, 9, 9], [0.1, 0.05, 0.02]]\n', "sweep")
    assert stabilab("verify", proof, "--case", sweep)[0] == 0
    code, out, _ = stabilab("verify", proof, "--json")
    assert code == 0 and '"about"' in out


def test_every_command_has_help_with_an_example(stabilab):
    code, out, _ = stabilab("--help")
    groups = out.split("-h, --help")[1].partition("\n")[2]
    commands = [line.split()[0] for line in groups.splitlines() if line.startswith("  ")]
    assert code == 0
    assert set(commands) == {"atlas", "attitude", "audit", "basin", "bifurcation", "burn", "chaos",
                             "classify", "compare", "doctor", "example", "explore", "export", "extremes", "fate",
                             "figures", "flat-spin", "import", "orbit", "period", "plot", "papers",
                             "precision", "reference", "report", "rerun", "show", "simulate", "stuck",
                             "surface", "sweep", "tables", "validate", "verify", "when"}
    assert "--install-completion" in out and "..." not in groups
    for command in commands:
        code, out, _ = stabilab(command, "--help")
        assert code == 0 and f"Example: stabilab {command}" in out


@pytest.mark.slow
def test_a_line_reads_the_options_of_its_own_command_alone_and_prints_what_all_commands_together_print(
    stabilab, monkeypatch):
    """Typer's building of all commands is the other way; reading the options of every one of them costs more
    than to import typer."""
    from typer.main import get_command
    names = list(get_command(cli.whole()).commands)
    lines = [[], ["--help"], ["clasify"], ["classify"], ["--version"], ["--versio"], ["classify", "--nosuch"],
             ["stuck", "classify", "--help"],
             ["--help", "classify"], ["--version", "sweep"], ["clasify", "sweep", "classify"],
             *([name, "--help"] for name in names)]
    for words in lines:
        built = get_command(cli.asked_for(words)).commands
        file = next((file for file, group in GROUPS.values() if words and words[0] in group), None)
        group = [name for other, group in GROUPS.values() if file in (other, None) for name in group]
        assert set(built) == set(group) and {name for name, command in built.items()
                                             if command.params} == set(words) & set(names)
        printed = stabilab(*words)
        with monkeypatch.context() as context:
            context.setattr(cli, "asked_for", lambda words: cli.whole())
            assert stabilab(*words) == printed, words


def test_wrong_command_is_a_usage_error(stabilab):
    code, out, err = stabilab("clasify")
    assert code == 2 and not out and "classify" in err


def test_version_is_the_packages(stabilab):
    import stabilab as package
    assert stabilab("--version")[:2] == (0, f"stabilab {package.__version__}\n")


def test_exit_code_of_an_error_is_its_own(stabilab, monkeypatch):
    def raising(error):
        def fail(*_, **__):
            raise error
        return fail
    from stabilab.errors import Problem, RenderingUnavailable, ToleranceNotMet
    for error, code, words in [(RenderingUnavailable("no GL"), 4, "no GL"),
                               (ToleranceNotMet("not met"), 5, "not met"),
                               (CaseError("c.toml", [Problem("k", "bad", 3)]), 2, "c.toml:3: k: bad"),
                               (ZeroDivisionError("oops"), 1, "ZeroDivisionError: oops"),
                               (KeyboardInterrupt(), 130, ""),
                               (PermissionError(13, "Permission denied", "/x"), 2, "/x: Permission denied")]:
        monkeypatch.setattr(one_case, "load_cases", raising(error))
        came, out, err = stabilab("show", MINOR)
        assert (came, out) == (code, "") and words in err and "Traceback" not in err
    monkeypatch.setenv("STABILAB_DEBUG", "1")
    monkeypatch.setattr(one_case, "load_cases", raising(ZeroDivisionError("oops")))
    assert "Traceback" in stabilab("show", MINOR)[2]


def interrupted(arguments, delay, cwd=ROOT):
    """(exit code, stdout, stderr) of a Python program that is interrupted `delay` s after it armed itself.

    Its second thread shows that it is armed: the first thing it does, before anything slow is imported.
    """
    run = subprocess.Popen([sys.executable, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                           cwd=cwd,
                           # a test run in the background may hand down an ignored SIGINT
                           preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
    try:
        deadline = time.time() + 60
        while len(os.listdir(f"/proc/{run.pid}/task")) < 2 and time.time() < deadline:
            time.sleep(0.001)
        time.sleep(delay)
        run.send_signal(signal.SIGINT)
        out, err = run.communicate(timeout=60)
    finally:
        run.kill()
    return run.returncode, out, err


def console_script():
    """The command `stabilab` as pip would write it."""
    import tomllib
    target = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["scripts"]["stabilab"]
    return ["-c", "import sys; from {} import {} as main; sys.exit(main())".format(*target.split(":"))]


has_proc = pytest.mark.skipif(not Path("/proc/self/task").is_dir(),
                              reason="watches the threads of a process in /proc")


# In turn while typer, numpy, sympy and heyoka are imported (which swallows exceptions), and inside compiled
# code.
@pytest.mark.one_in(14)
@has_proc
@pytest.mark.parametrize("delay", [0, 0.03, 0.1, 0.2, 0.3, 0.4, 0.5, 0.7, 2.0])
@pytest.mark.parametrize("program", [["-m", "stabilab"], console_script()], ids=["module", "script"])
def test_interrupt_ends_with_130_and_no_traceback(program, delay):
    # 2e6 units of time keep heyoka for some twenty seconds, in calls of a second into compiled code (1e8 is
    # given up at once)
    assert interrupted([*program, "simulate", str(MINOR), "--at", "2e6", "--method", "taylor"],
                       delay) == (130, b"", b"")


@has_proc
@pytest.mark.parametrize("delay", [0.1, pytest.param(1.0, marks=pytest.mark.slow)])
def test_interrupt_of_a_run_in_python_ends_with_130_too(delay):
    arguments = ["-m", "stabilab", "simulate", str(ROOT / "cases/major-axis-100.toml"), "--at", "300",
                 "--method", "RK45"]  # some forty seconds; 1e6 is given up within one
    assert interrupted(arguments, delay) == (130, b"", b"")


@pytest.mark.one_in(2)
@has_proc
@pytest.mark.parametrize("busy", ["while True: pass", "time.sleep(1000)", "deaf()"])
def test_interrupt_leaves_no_half_written_file(tmp_path, busy):
    code = ("import time\nfrom stabilab import interrupt\nfrom stabilab.show.style import whole_file\n"
            "def deaf():\n    while True:\n        try: time.sleep(0.01)\n        except BaseException: "
            "pass\n"
            "with whole_file('wanted.txt') as waiting:\n    waiting.write_text('half')\n    "
            "interrupt.arm()\n    " + busy)
    assert interrupted(["-c", code], 0.1, tmp_path) == (130, b"", b"")
    assert not list(tmp_path.iterdir())


@has_proc
def test_program_started_with_interrupts_ignored_goes_on_ignoring_them():
    code = ("import os, signal\nsignal.signal(signal.SIGINT, signal.SIG_IGN)\nfrom stabilab import "
            "interrupt\n"
            "interrupt.arm()\nos.kill(os.getpid(), signal.SIGINT)\nprint('alive')")
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, cwd=ROOT).stdout == b"alive\n"


def test_doctor_names_versions_renderer_and_processor(stabilab):
    code, out, _ = stabilab("doctor")
    assert code == 0 and all(word in out
                             for word in ("stabilab", "numpy", np.__version__, "rendering", "processor"))
    assert out.startswith(("all that stabilab needs is installed",
                           "NOT INSTALLED")) and "be drawn\nstabilab " in out


def test_doctor_compiles_all_loops_and_says_where_they_are(stabilab, monkeypatch):
    monkeypatch.setattr("stabilab.answers.motions.compiling.compile_all", lambda: "/a/folder")
    assert stabilab("doctor", "--compile") == (0, "all loops are compiled, in /a/folder\n", "")


def test_doctor_misses_no_package_that_is_for_other_machines(stabilab, monkeypatch):
    asked = ["numpy>=2.0", 'for-others; sys_platform == "nowhere"', 'for-all; python_version >= "3"',
             'of-an-extra; extra == "docs"']
    monkeypatch.setattr("stabilab.commands.doctor.metadata.requires", lambda name: asked)
    out = stabilab("doctor")[1]
    assert out.startswith("NOT INSTALLED: for-all;") and "for-others" not in out and "of-an-extra" not in out
