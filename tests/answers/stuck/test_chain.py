"""The motion over the switches of a burn, and when it reaches a limit, against Euler's equations by DOP853,
written out piece by piece."""
import json
import math
from functools import lru_cache

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

import stabilab
from stabilab.errors import InputError
from tests.answers.stuck.test_burn import case_of
from tests.oracles.rigid import euler, in_space

D, START, LAM = np.array([3.0, 2.0, 1.5]), [0.1, -0.2, 0.3], np.array([0.3, -0.1, 0.2])
ONE, TWO = np.array([0.05, -0.06, 0.04]), np.array([0.03, -0.08, 0.15])
TIMES = [0.0, 0.5, 1.0, 2.25, 3.0, 3.3, 4.0, 7.5]
# pulses of 0.5 s from 1 s and 3 s on; the other from 2.25 s to 4 s
PIECES = [(1, 0 * ONE), (0.5, ONE), (0.75, 0 * ONE), (0.75, TWO), (0.5, ONE + TWO), (0.5, TWO), (3.5, 0 * ONE)]


@pytest.fixture
def burning(tmp_path):
    wheels = "".join(f"[[wheels]]\naxis = {np.eye(3)[n].tolist()}\nmomentum = {LAM[n]}\n" for n in range(3))
    return case_of(tmp_path, D.tolist(), START, [(ONE, "start = 1\nstop = 4\nperiod = 2\non_time = 0.5"),
                                                 (TWO, "start = 2.25\nstop = 4")], more=wheels)


@lru_cache(maxsize=1)
def run_of_pieces():
    """(begin, length, solution of rates and matrix) of each piece."""
    y, begin, found = np.concatenate([START, np.eye(3).ravel()]), 0.0, []
    for length, torque in PIECES:
        run = solve_ivp(in_space(euler(D, LAM, torque)), (0, length), y, method="DOP853", rtol=1e-13, atol=1e-15, dense_output=True)
        found.append((begin, length, run.sol))
        y, begin = run.y[:, -1], begin + length
    return found


def written_out():
    """(rates, matrices from body to space) at TIMES."""
    found = {t: sol(t - begin) for begin, length, sol in run_of_pieces()
             for t in TIMES if begin <= t <= begin + length}
    rows = np.array([found[t] for t in TIMES])
    return rows[:, :3], rows[:, 3:].reshape(-1, 3, 3)


@pytest.mark.parametrize("form", [None, "quaternion", "matrix"])
def test_the_motion_over_switches_is_that_of_its_pieces(burning, form):
    run = stabilab.load_burning(burning).simulate(TIMES, attitude=form)
    rates, matrices = written_out()
    assert run.t.tolist() == TIMES and run.status == "reached"
    assert run.state["omega"] == pytest.approx(rates, abs=1e-12)
    if form:
        turned = (Rotation.from_quat(run.state["quaternion"]).as_matrix() if form == "quaternion"
                  else run.state["matrix"])
        assert turned == pytest.approx(matrices, abs=1e-11)


def test_the_end_of_the_run_is_what_the_burn_leaves(burning):
    given = stabilab.load_burning(burning)
    closed = given.burn().closed
    assert given.simulate(["0 s", "4 s"]).state["omega"][-1] == pytest.approx(closed.rates, abs=1e-15)


def test_the_command_follows_a_schedule_from_switch_to_switch(stabilab, burning):
    at = ",".join(map(str, TIMES))
    code, out, _ = stabilab("simulate", burning, "--at", at, "--json", "--matrix")
    state = json.loads(out)["state"]
    rates, matrices = written_out()
    assert code == 0 and np.array(state["omega"]) == pytest.approx(rates, abs=1e-12)
    assert np.array(state["matrix"]) == pytest.approx(matrices, abs=1e-11)
    code, out, _ = stabilab("simulate", burning)
    assert code == 0 and "thrusters switch at exact times" in out and "no thruster fires" not in out
    for more in (["--digits", "5"], ["--method", "RK45"], ["--model", "linear"]):
        code, out, err = stabilab("simulate", burning, *more)
        assert (code, out, err.count("\n")) == (2, "", 1) and "from switch to switch" in err


@pytest.mark.parametrize("times", [[-1.0, 2.0], [2.0, 1.0]])
def test_a_burn_is_followed_forward_from_its_start(burning, times):
    with pytest.raises(InputError, match="times: a burn is followed from 0 on"):
        stabilab.load_burning(burning).simulate(times)


def first_root(g):
    """Of a function of rates and matrix along the pieces, by its signs at 500 times of each."""
    for begin, length, sol in run_of_pieces():
        times = np.linspace(0, length, 500)
        signs = np.array([g(sol(t)) for t in times]) > 0
        if signs.any():
            n = int(signs.argmax())
            return begin + brentq(lambda t: g(sol(t)), times[n - 1], times[n], xtol=1e-15)


@pytest.mark.parametrize("ask, g", [
    ({"rate": 0.45}, lambda y: math.hypot(*y[:3]) - 0.45),
    ({"component": "y = 0.4"}, lambda y: abs(y[1]) - 0.4),
    ({"energy": 0.2}, lambda y: D @ y[:3] ** 2 / 2 - 0.2),
    ({"tilt": "x = 60 deg"}, lambda y: 0.5 - y[3])], ids=["rate", "component", "energy", "tilt"])
def test_a_limit_is_first_reached_where_the_pieces_reach_it(burning, ask, g):
    found, root = stabilab.load_burning(burning).when(**ask), first_root(g)
    assert root is not None and root > 1  # after the first switch
    assert found.level == "proved" and found.high == math.nextafter(found.low, math.inf)
    assert found.low == pytest.approx(root, abs=1e-11)


def test_a_limit_is_never_reached_or_not_by_the_end(stabilab, tmp_path, burning):
    (tmp_path / "spun").mkdir()
    path = case_of(tmp_path / "spun", [3.0, 2.0, 1.5], [0, 0, 0.05], [([0, 0, 0.15], "start = 1\nstop = 2.5")], 9)
    code, out, _ = stabilab("when", path, burning, "--rate", "0.21 rad/s", "--json")
    rows = json.loads(out)
    assert code == 0 and [one["reached"] for one in rows] == ["never", "yes"] and rows[1]["time"] == [0, 0]
    found = stabilab_of(path).when(rate="0.17 rad/s")  # 0.05 + 0.1 (t - 1)
    assert found.low <= 2.2 <= found.high and found.level == "proved"
    found = stabilab_of(path).when(component="x = 0.1 rad/s")
    assert (found.low, math.isnan(found.high)) == (9, True)
    found = stabilab_of(path).when(component="x = 0.1 rad/s", until="20 s")
    assert found.low == 20


def stabilab_of(path):
    return stabilab.load_burning(path)


@pytest.mark.parametrize("keys, levels", [
    pytest.param("stop = 180", {"proved"}, marks=pytest.mark.slow),
    pytest.param("stop = 180\nperiod = 10\nduty = 0.9", {"run"}, marks=pytest.mark.slow)])
def test_a_limit_that_is_reached_after_too_many_turns_to_enclose_is_found_along_runs(tmp_path, keys, levels):
    D, torque = np.array([4000.0, 9000.0, 9000.0]), np.array([-166.5, 0, -166.5])
    path = case_of(tmp_path, D.tolist(), [0, 0, 0], [(torque, keys)], 180)
    found = stabilab_of(path).when(rate="296 deg/s")
    w, t = np.zeros(3), 0.0
    reached = lambda _, w: np.linalg.norm(w) - math.radians(296)
    for n in range(36):  # from switch to switch
        fires = "duty" not in keys or n % 2 == 0
        length = (9 if fires else 1) if "duty" in keys else 5
        run = solve_ivp(euler(D, torque=torque * fires), (0, length), w,
                        method="DOP853", rtol=1e-13, atol=1e-15, events=reached)
        if run.t_events[0].size:
            break
        w, t = run.y[:, -1], t + length
    assert found.level in levels
    assert found.low - 1e-8 <= t + run.t_events[0][0] <= found.high + 1e-8 and found.high - found.low < 1e-6
