"""Motions with guaranteed digits against Taylor series of another code, closed forms, and laws of the motion;
the files that others read."""
from __future__ import annotations

import csv
import importlib.util
import json
import re
from fractions import Fraction

import mpmath as mp
import pytest

from benchmarks import against_reference
from stabilab import Body, ConstantTorque, Gyrostat, Scene
from stabilab.answers.tabulated import PROVED, TWICE, tabulated
from stabilab.case.read import load
from stabilab.errors import InputError
from stabilab.numbers.balls import working
from stabilab.show.text.reference import decimal, within, written
from tests.oracles import taylor
from tests.oracles.pairs import physical
from tests.shared import CASES

HEYOKA = importlib.util.find_spec("heyoka") is not None
START = (Fraction(1, 2), Fraction(-1, 4), Fraction(1))
TIMES = [Fraction(k, 3) for k in range(19)]


@pytest.fixture(scope="module")
def gyrostat():
    scene, model = physical((12, 9, 5), (0.75, -0.5, 0.25), (0.25, 0.125, 0.5))
    return scene, model, tabulated(scene, START, START, TIMES, 40)


def test_states_hold_those_of_a_taylor_series_of_another_code(gyrostat):
    _, model, found = gyrostat
    assert found.reached and found.level == PROVED
    with mp.workdps(70):
        for balls, row in zip(found.states, taylor.integrate(model, START, TIMES, digits=55)):
            assert all(abs(mp.mpf(ball.str(60, radius=False, more=True)) - v) < mp.mpf(10) ** -40 for ball,
                       v in zip(balls, row))
            assert all(ball.rad() < 1e-40 * 2 for ball in balls)


def test_events_are_all_the_sign_changes_and_turns_of_a_dense_run(gyrostat):
    # Taylor series of another code at 600 times: signs of the rates, and of their differences, change where
    # an event is told
    _, model, found = gyrostat
    grid = [k / 100 for k in range(601)]
    rows = [list(map(float, row)) for row in taylor.integrate(model, START, grid, digits=14)]
    for i in range(3):
        column = [row[i] for row in rows]
        zeros = [k for k in range(600) if column[k] * column[k + 1] < 0]
        turns = [k for k in range(1, 600) if (column[k] - column[k - 1]) * (column[k + 1] - column[k]) < 0]
        mine = {kind: [float(e.t) for e in found.events if e.component == i
                       and (e.kind == "zero") == (kind == "zero")] for kind in ("zero", "turn")}
        assert len(mine["zero"]) == len(zeros) and all(grid[k] <= t <= grid[k + 1] for k,
                                                       t in zip(zeros, mine["zero"]))
        assert len(mine["turn"]) == len(turns) and all(abs(grid[k] - t) < 0.015 for k,
                                                       t in zip(turns, mine["turn"]))


def test_a_free_symmetric_body_precesses_as_its_closed_form():
    # omega1 = cos(n t), omega2 = sin(n t), n = (D3 - D1)/D1 omega3 = -1/2: zeros and turns where these are
    scene = Scene(Body((2, 2, 1)))
    start = (Fraction(1), Fraction(0), Fraction(1))
    found = tabulated(scene, start, start, [Fraction(7)], 30)
    with mp.workdps(40):
        assert abs(mp.mpf(found.states[0][0].str(40, radius=False))
                   - mp.cos(mp.mpf(7) / 2)) < mp.mpf(10) ** -30
        told = [(e.kind, e.component, mp.mpf(e.t.str(38, radius=False))) for e in found.events]
        assert {(kind, i) for kind, i, _ in told[:2]} == {("zero", 0), ("least", 1)}
        assert {(kind, i) for kind, i, _ in told[2:]} == {("least", 0), ("zero", 1)}
        assert all(abs(t - k * mp.pi) < mp.mpf(10) ** -30 for (_, _, t), k in zip(told, (1, 1, 2, 2)))
    assert not any(e.component == 2 for e in found.events)  # omega3 is constant


def test_other_effects_are_told_by_two_precisions():
    case = load(CASES / "top-fast.toml")
    found = tabulated(case.scene, case.start, case.exact_state, [Fraction(0), Fraction(1, 10)], 20)
    assert found.level == TWICE and found.reached and found.components[3:] == ("gamma1", "gamma2",
                                                                               "gamma3") and not found.events
    gamma = [float(v) for v in found.states[1][3:]]
    assert abs(sum(v * v for v in gamma) - 1) < 1e-14  # its length is a law of the motion


def test_digits_out_of_reach_end_the_run_where_they_hold():
    scene = Scene(Body((12, 9, 5)), Gyrostat((1, 0, 0)), ConstantTorque((0, 0, 1)))
    found = tabulated(scene, START, START, [Fraction(1), Fraction(10**5)], 50, work=300_000)
    assert not found.reached and len(found.t) == 1 and "proved up to" in found.because


def test_times_before_the_start_and_too_many_digits_are_refused():
    scene = Scene(Body((2, 2, 1)))
    with pytest.raises(InputError, match="from 0 on"):
        tabulated(scene, START, START, [Fraction(-1)])
    with pytest.raises(InputError, match="1 to 50"):
        tabulated(scene, START, START, [Fraction(1)], 51)


@pytest.mark.parametrize("t, text", [(Fraction(1, 10), "0.1"), (Fraction(-5, 4), "-1.25"),
                                     (Fraction(40), "40"), (Fraction(1, 3), "1/3"), (Fraction(0), "0")])
def test_times_are_written_exactly(t, text):
    assert decimal(t) == text and Fraction(text) == t


def test_reference_writes_csv_and_json_of_the_same_numbers(stabilab, tmp_path):
    args = ("reference", CASES / "minor-axis-100.toml", "--at", "0,0.5,1", "--digits", "30")
    assert stabilab(*args, "--out",
                    tmp_path / "a.csv")[0] == 0 and stabilab(*args, "--out", tmp_path / "a.json")[0] == 0
    rows = list(csv.DictReader((tmp_path / "a.csv").open(encoding="utf-8")))
    made = json.loads((tmp_path / "a.json").read_text(encoding="utf-8"))
    assert [row["value"] for row in rows
            if row["kind"] == "state"] == [v for row in made["trajectory"]["rows"] for v in row["values"]]
    assert made["provenance"]["command"].startswith("stabilab reference") and len(
        made["provenance"]["case_sha256"]) == 64
    period = next(row for row in rows if row["kind"] == "period")["value"]
    assert period == made["period"]["value"] and made["period"]["digits"] >= 30
    # two ways to the least x2 of all time: an event of the enclosed motion, and ball arithmetic on the orbit
    least = next(row["value"] for row in rows if row["kind"] == "least" and row["quantity"] == "x2")
    assert least.startswith(made["extremes"]["value"][1][0][:29])


def test_what_is_written_is_within_its_bound():
    # the ball holds a sixth; six digits of it are off by 3.3e-7
    with working(300) as numbers:
        sixth = numbers.ball(Fraction(1, 6))
        text = written(sixth, 2)
        bound = within([sixth], [text])
    assert text == "0.166667" and 0 <= bound - float(Fraction(text) - Fraction(1, 6)) < 1e-20


def test_reference_says_what_is_missing_and_ends_with_5(stabilab, monkeypatch):
    monkeypatch.setattr("stabilab.answers.tabulated.WORK", 30_000)
    code, out, err = stabilab("reference", CASES / "minor-axis-100.toml", "--at", "0.01,15", "--digits", "30")
    assert code == 5 and "state,0.01" in out and "state,15" not in out and "proved up to 0.01" in err


@pytest.mark.one_in(3)
@pytest.mark.skipif(not HEYOKA, reason="one column is heyoka's")
@pytest.mark.parametrize("name", against_reference.CASES)
def test_the_table_of_integrators_is_what_they_are_off(name):
    rows = [line.split(" | ") for line in against_reference.PAGE.read_text(encoding="utf-8").splitlines()
            if re.match(r"\| (RK4|DOP853|heyoka)", line)]
    column = 1 + list(against_reference.CASES).index(name)
    assert [row[0].strip("| ") for row in rows] == [words for words, *_ in against_reference.RUNS]
    for row, error in zip(rows, against_reference.errors(name)):
        told = float(row[column].strip(" |"))
        # roundings differ between processors
        assert told / 4 < error < 4 * told if told < 1e-11 else abs(error - told) < 0.1 * told


def test_reference_refuses_other_files_and_times(stabilab, tmp_path):
    assert stabilab("reference", CASES / "minor-axis-100.toml", "--out", tmp_path / "a.txt")[0] == 2
    assert stabilab("reference", CASES / "minor-axis-100.toml", "--at", "-1")[0] == 2
    assert stabilab("reference", CASES / "minor-axis-100.toml", "--at", "x")[0] == 2
