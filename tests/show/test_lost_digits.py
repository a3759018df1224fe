"""Numbers that have fallen below the error of a run: text says 0 within it, files and JSON tell the error."""
import json
import math

import numpy as np
import pytest

from stabilab import Body, Gyrostat, Scene, simulate
from stabilab.case.read import load
from stabilab.show.text.simulation import zero_within
from tests.shared import CASES

# at 20 s the amplitude is 3.6e-212 rad/s, by power series in 60 digits (test_polar)
LIQUID = CASES / "liquid-charge-1e4.toml"
SPIN = 0.520754483931025856  # rad/s, of the same series


def test_a_component_below_the_error_is_zero_within_it(stabilab):
    out, answer = stabilab("simulate", LIQUID, "--at",
                           "20")[1], json.loads(stabilab("simulate", LIQUID, "--at", "20", "--json")[1])
    (error,), ((p, q, r),) = [answer["error"]["omega"]], answer["state"]["omega"]
    row = next(line for line in out.splitlines() if line.split()[0] == "20")
    assert row.count("0 within") == 2 and row.split()[-1] == "29.837"
    assert len(error) == 3 and all(1e-16 < e < 1e-14 for e in error) and abs(r - SPIN) < error[2]
    assert max(abs(p), abs(q)) < error[0]


def test_what_a_start_gives_is_told_as_it_stands(stabilab, case_file):
    path = case_file("[body]\ninertia = [3, 2, 1]\n[motion]\nangular_velocity = [1e-20, 0, 1]\n")
    first, last = stabilab("simulate", path, "--at", "0,1", "--units", "si")[1].splitlines()[2:4]
    assert first.split()[1:] == ["1e-20", "0", "1"] and last.count("0 within") == 2


@pytest.mark.parametrize("ending", ["csv", "nc"])
def test_a_file_says_which_of_its_columns_hold_rounding(stabilab, tmp_path, ending):
    code, _, err = stabilab("simulate", LIQUID, "--at", "0,20", "--out", tmp_path / f"run.{ending}")
    assert code == 0 and "omega1: 0 within 2e-15 where it is smaller" in err and "omega2: 0 within" in err
    assert "omega3: 0" not in err
    if ending == "nc":
        import xarray
        with xarray.open_dataset(tmp_path / "run.nc", engine="scipy") as data:
            assert len(data["omega"].attrs["error"]) == 3 and 1e-16 < data["omega"].attrs["error"][0] < 1e-14


def test_the_error_told_holds_the_true_one(stabilab, tmp_path):
    """Closed form: a body of revolution with a wheel along its axis turns (p, q) at ((D3 - D1) r + l)/D1 and
    keeps r."""
    path, times = tmp_path / "case.toml", (0.3, 7.0, 41.0)
    for p, r, wheel in ((0.2, 1.1, 0.5), (1e-9, 2.0, -3.0), (0.7, 1e-7, 1.0)):
        path.write_text(
            f"[body]\ninertia = [3, 3, 2]\n[effects.gyrostat]\nmomentum = [0, 0, "
            f"{wheel}]\n[motion]\nangular_velocity = [{p}, 0, {r}]\n")
        answer = json.loads(stabilab("simulate", path, "--at", ",".join(map(str, times)), "--json")[1])
        turn = (-r + wheel) / 3
        for t, row in zip(times, answer["state"]["omega"]):
            true = (p * math.cos(turn * t), p * math.sin(turn * t), r)
            assert all(abs(a - b) <= e for a, b, e in zip(row, true, answer["error"]["omega"]))


def test_an_unchecked_run_is_not_told_apart_from_zero_below_its_tolerance(stabilab):
    row = stabilab("simulate", LIQUID, "--at", "20", "--method", "DOP853")[1]
    assert row.count("0 within 3e-09") == 2  # 1e-10 of 29.837 deg/s
    run = simulate(Scene(Body((3, 3, 2)), Gyrostat((0, 0, 1))), (1, 0, 2), [1.0, 2.0], method="RK45",
                   rtol=1e-6)
    assert run.error["omega"] == pytest.approx(np.full(3, 2e-6))


def test_an_averaged_spin_below_its_tolerance_is_zero_within_it(stabilab, case_file):
    """By hand: resistance alone, r = e^(-zeta t), is e^-2000 after 1e5 s at 0.02 1/s; the amplitude, followed
    by its logarithm, is known."""
    path = case_file('[body]\ninertia = [9.5, 9.5, 9]\n[effects.resistance]\ncoefficient = '
                     '"0.02"\n[motion]\nangular_velocity = [1, 0, 1]\nspan = [0, 20]\n')
    out = stabilab("simulate", path, "--at", "1000,20000", "--model", "averaged1", "--units", "si")[1]
    first, last = (line.split() for line in out.splitlines()[2:4])
    assert float(first[4]) == pytest.approx(math.exp(-20), rel=1e-5)
    assert float(last[-5]) == pytest.approx(math.exp(-400), rel=1e-4)
    assert "0 within" in " ".join(last) and load(path).state[0] == 1


@pytest.mark.parametrize("error, words", [(1.2e-15, "0 within 2e-15"), (9.1e-15, "0 within 1e-14"),
                                          (3e-18, "0 within 3e-18")])
def test_an_error_is_rounded_up(error, words):
    assert zero_within(error) == words
