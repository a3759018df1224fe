"""A thruster whose force follows a profile: against SciPy's DOP853, restarted at every switch."""
from __future__ import annotations

import json
from fractions import Fraction

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stabilab
from stabilab.errors import InputError
from tests.oracles.rigid import euler

CASE = """[body]
inertia = [120, 90, 50]
[[thrusters]]
name = "A"
position = [0.5, 0, 0]
direction = [0, 1, 0.1]
force = 10
profile = {}
{}
[motion]
angular_velocity = [0.1, 0.02, 0.05]
span = [0, 20]
"""


def drawn(rng):
    """(text of a case, moments, start, [(from, to, torque)]) of a random profile, worked out by hand."""
    inertia = rng.uniform(50, 60, 3)
    start, at, force, opens = rng.uniform(-0.2, 0.2, 3), rng.uniform(-1, 1, 3), rng.uniform(1, 20), rng.uniform(0, 2)
    times = np.concatenate([[0], np.cumsum(rng.uniform(0.3, 2, 4))])
    levels = [1, *rng.choice([0, 0.25, 0.4, 0.9], 3), 0]
    rows = ", ".join(f"[{float(time)!r}, {float(level)!r}]" for time, level in zip(times, levels))
    numbers = lambda values: [float(value) for value in values]
    text = (f'[body]\ninertia = {numbers(inertia)}\n[[thrusters]]\nname = "A"\nposition = {numbers(at)}\n'
            f'direction = [0, 0, 1]\nforce = {force!r}\nprofile = [{rows}]\nstart = {opens!r}\n'
            f'[motion]\nangular_velocity = {numbers(start)}\nspan = [0, 12]\n')
    torque = force * np.cross(at, [0, 0, 1])
    ends = [*(opens + times), 12.0]
    return text, inertia, start, [(0.0, opens, 0 * torque), *((a, b, level * torque)
                                                              for a, b, level in zip(ends, ends[1:], levels))]


def followed(inertia, start, pieces):
    """The rates at the end, Euler's equations by DOP853 from switch to switch."""
    state = start
    for begin, end, torque in pieces:
        rates = euler(inertia, torque=torque)
        state = solve_ivp(rates, (begin, end), state, "DOP853", rtol=1e-12, atol=1e-14).y[:, -1]
    return state


@pytest.mark.parametrize("seed", [*range(3), *(pytest.param(n, marks=pytest.mark.slow) for n in range(3, 30))])
def test_rates_along_random_profiles_are_those_of_dop853_restarted_at_the_switches(seed):
    text, inertia, start, pieces = drawn(np.random.default_rng(seed))
    run = stabilab.load_burning(text).simulate([12.0])
    assert run.state["omega"][-1] == pytest.approx(followed(inertia, start, pieces), abs=3e-11)
    left = stabilab.burn(text)
    while not pieces[-1][2].any():  # the last closing is where it fires for the last time
        pieces.pop()
    done = followed(inertia, start, pieces)
    assert left.closed.time == pytest.approx(pieces[-1][1], rel=1e-15)
    assert left.closed.rates == pytest.approx(done, abs=3e-11)


def test_switches_are_exact_and_levels_scale_the_torque():
    burning = stabilab.load_burning(CASE.format('[[0, 1], ["2 s", "40 %"], ["10/3 s", 0], [4, 0.5]]',
                                                'start = "0.1 s"\nstop = "5 s"'))
    tenth = Fraction(1, 10)
    assert [(item.begin, item.end, item.levels) for item in burning.segments()] == [  # by hand
        (0, tenth, ()), (tenth, tenth + 2, (1,)), (tenth + 2, tenth + Fraction(10, 3), (Fraction(2, 5),)),
        (tenth + Fraction(10, 3), tenth + 4, ()), (tenth + 4, 5, (Fraction(1, 2),))]
    full, *_ = (switch for switch in burning.burn().switches if switch.levels == (1.0,))
    part, *_ = (switch for switch in burning.burn().switches if switch.levels == (0.4,))
    assert part.torque == pytest.approx(0.4 * np.array(full.torque), rel=1e-15)


def test_propellant_is_used_in_proportion_to_the_level():
    """10 g at 2 g/s: 4 g in 2 s, then 0.8 g/s: used up 7.5 s later, at 9.5 s."""
    burning = stabilab.load_burning(CASE.format("[[0, 1], [2, 0.4]]", 'propellant = "10 g"\nmass_flow = "2 g/s"'))
    assert burning.segments()[-1].end == Fraction(19, 2)
    left = burning.burn().closed
    assert left.fired == (9.5,) and left.used == pytest.approx((0.01,))


def test_a_constant_profile_is_a_burn_without_one_and_one_that_ends_needs_no_stop():
    once = stabilab.burn(CASE.format("[[0, 1], [3, 1], [6, 0]]", ""))
    again = stabilab.burn(CASE.format("[[0, 1]]", "stop = 6"))
    assert once.closed.rates == again.closed.rates and len(once.switches) == len(again.switches) == 1


def test_times_to_a_limit_and_the_text_know_the_levels(stabilab, case_file):
    path = case_file(CASE.format("[[0, 0.5], [4, 1], [8, 0]]", ""))
    text, told = stabilab("burn", path)[1], json.loads(stabilab("burn", path, "--json")[1])
    assert "firing: A at 50 %" in text and [row["levels"] for row in told["switches"]] == [[0.5], [1.0]]
    assert "proved" in stabilab("when", path, "--rate", "0.3")[1]


@pytest.mark.parametrize("profile, more, cure", [
    ("3", "", "pairs of a time and the share"), ("[[0, 1, 2]]", "", "pairs of a time"),
    ("[]", "", "pairs of a time"), ("[[1, 1]]", "", "times count from the opening"),
    ("[[0, 1], [2, 0.5], [2, 0]]", "", "row 3: expected a time after 2 s"), ("[[0, 1], [2, 40]]", "", "from 0 to 1"),
    ("[[0, -1]]", "", "from 0 to 1"), ("[[0, 0], [3, 0]]", "", "every level is 0"),
    ('[["0 N", 1]]', "", "expected time"), ("[[0, true]]", "", "row 1, number 2"),
    ("[[0, 1], [3, 0]]", "period = 2\nduty = 0.5", "take away period, duty"), ("[[0, 1], [3, 0]]", "stuck = true", "stuck")])
def test_a_profile_that_is_none_is_refused_at_its_line(profile, more, cure):
    with pytest.raises(InputError, match=f"(?s)text:.*{cure}"):
        stabilab.load_burning(CASE.format(profile, more))


def test_other_questions_name_the_profile_as_a_schedule():
    with pytest.raises(InputError, match="take away its keys profile"):
        stabilab.load(CASE.format("[[0, 1], [3, 0]]", ""))
