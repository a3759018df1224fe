"""Percentiles of burns: each draw against SciPy's DOP853 from Euler's equations written here."""
from __future__ import annotations

import json
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stabilab
from stabilab.errors import InputError
from stabilab.maps.percentiles import of_burn_drawn
from stabilab.maps.plan import Plan
from tests.oracles.rigid import euler

D, ARM, START = np.array([9.0, 12.0, 5.0]), np.array([0.3, -0.1, 0.2]), [0.05, 0.4, -0.1]
CASE = f"""[body]
inertia = [9, 12, 5]
centre_of_mass = [0, 0, 0]
[[thrusters]]
name = "A"
position = {ARM.tolist()}
direction = [0, 1, 1]
force = "4 N, sigma 5 %"
profile = [["0 s", 1], ["2 s", 0.4]]
stop = "6 s"
[limits]
rate = 0.58
[motion]
angular_velocity = ["0.05 +- 0.01", 0.4, -0.1]
"""
DIRECTION = np.array([0, 1, 1]) / math.sqrt(2)


def followed(force, first, until, events=None):
    """Rates of the burn and the free motion after it, piece by piece."""
    torque = np.cross(ARM, force * DIRECTION)
    state, parts = np.array([first, *START[1:]]), []
    for a, b, level in ((0, 2, 1), (2, 6, 0.4), (6, until, 0)):
        run = solve_ivp(euler(D, torque=level * torque), (a, b), state, "DOP853", rtol=1e-11, atol=1e-13,
                        dense_output=True, events=events)
        parts.append(run)
        state = run.y[:, -1]
    return parts


@pytest.fixture(scope="module")
def drawn():
    """(percentiles of six draws, the draws)."""
    burning = stabilab.load_burning(CASE)
    plan = Plan("text", CASE, (), 6, 3, (), burn=())
    return burning.percentiles(6, 3, closing_below=0.5), plan.sampled.values(0, 6)


def test_each_draw_reaches_its_limit_when_scipy_does(drawn):
    result, values = drawn
    for low, high, (force, first) in zip(result.time.low, result.time.high, values):
        def over(t, w):
            return math.hypot(*w) - 0.58
        over.direction = 1
        times = [t for run in followed(force, first, 60, over) for t in run.t_events[0]]
        if times:
            assert low - 1e-8 <= times[0] <= high + 1e-8
        else:
            assert high == math.inf
    assert result.reached["reached"].count + result.reached["never"].count == 6


def test_the_largest_rate_is_that_of_the_burn_and_all_time_after(drawn):
    result, values = drawn
    for largest, (force, first) in zip(result.largest.high, values):
        size = max(np.linalg.norm(run.sol(np.linspace(run.t[0], run.t[-1], 4000)), axis=0).max()
                   for run in followed(force, first, 200))
        assert size == pytest.approx(largest, rel=2e-6)  # of 4,000 looks, and of a motion that returns
    assert list(result.outcomes) == ["bounded"]


@pytest.mark.slow
def test_closed_at_the_time_of_a_draw_the_rate_stays_below_and_later_it_does_not(drawn):
    """2T/D of the free motion has a closed form for its largest |omega|; here by looks along it."""
    result, values = drawn
    seen = 0
    for low, (force, first) in zip(result.closing.low, values):
        if not 0 < low < 5.9:
            continue
        for share, above in ((0.999, False), (1.001, True)):
            *_, last = closed(force, first, low * share)
            size = np.linalg.norm(last.sol(np.linspace(last.t[0], last.t[-1], 20_000)), axis=0).max()
            seen += (size > 0.5) == above
    assert result.below == 0.5 and seen >= 2


def closed(force, first, when):
    torque, state, parts = np.cross(ARM, force * DIRECTION), np.array([first, *START[1:]]), []
    for a, b, level in ((0, min(2, when), 1), (min(2, when), when, 0.4), (when, when + 200, 0)):
        if b > a:
            run = solve_ivp(euler(D, torque=level * torque), (a, b), state, "DOP853", rtol=1e-11,
                            atol=1e-13, dense_output=True)
            parts.append(run)
            state = run.y[:, -1]
    return parts


def test_every_view_has_them(stabilab, case_file):
    path = case_file(CASE)
    options = ("--samples", "8", "--seed", "2", "--workers", "1")
    code, text, err = stabilab("burn", path, "--below", "0.5 rad/s", *options)
    assert code == 0, err
    assert "8 draws" in text and "latest closing for |ω| < 28.65 deg/s: 5 %" in text and "samples, no proof" in text
    told = json.loads(stabilab("burn", path, "--below", "0.5 rad/s", *options, "--json")[1])["percentiles"]
    assert told["below"] == 0.5 and [q["percent"] for q in told["closing"]["quantiles"]] == [5, 50, 95]
    assert sum(told["closing"]["histogram"]["counts"]) + told["closing"]["histogram"]["beyond"] == 8
    assert set(told["time"]) == set(told["largest"]) == set(told["closing"])
    rows = stabilab("when", path, *options, "--csv")[1]
    assert rows.startswith("case,quantity,of,low,high,least,greatest,caveats\n") and "\ncase,time,50 %," in rows


@pytest.mark.slow
def test_python_has_them_of_a_path_of_a_text_and_of_a_burn(case_file):
    path = case_file(CASE)
    first = stabilab.percentiles(path, 4, 1, stop="3 s")
    assert first.time.low.tolist() == stabilab.percentiles(CASE, 4, 1, stop=3).time.low.tolist()
    again = of_burn_drawn(stabilab.load_burning(path), 4, 1, 2, True, True, stop="3 s")
    assert again.largest.low.tobytes() == first.largest.low.tobytes()  # whatever the number of workers
    data = stabilab.percentiles(CASE, 4, 1, closing_below="0.5 rad/s").to_xarray()
    assert data["closing_low"].attrs["units"] == "s" and "closing" in repr(stabilab.percentiles(CASE, 4, closing_below=0.5))


@pytest.mark.parametrize("change, asked, words", [
    ({}, {"closing_below": "5 m"}, "angular velocity"), ({"force = \"4 N, sigma 5 %\"": "force = 4", '"0.05 +- 0.01"': "0.05"}, {},
                                                        "gives no number with an uncertainty"),
    ({"[limits]": "[effects.constant_torque]\ntorque = [0, 0, 0.1]\n[limits]"}, {"closing_below": 0.5}, "a torque stays after"),
    ({'profile = [["0 s", 1], ["2 s", 0.4]]\nstop = "6 s"': "stuck = true"}, {"stop": 3}, None)])
def test_what_cannot_be_asked_is_said(change, asked, words):
    text = CASE
    for old, new in change.items():
        assert old in text
        text = text.replace(old, new)
    if words is None:  # a stuck thruster has no schedule: its case is another question
        with pytest.raises(InputError, match="stop and closing_below are of thrusters that fire on a schedule"):
            stabilab.percentiles(text, 4, **asked)
        assert stabilab.percentiles(stabilab.load_burning(text), 4, **asked).number == 4
        return
    with pytest.raises(InputError, match=words):
        stabilab.percentiles(text, 4, **asked)
