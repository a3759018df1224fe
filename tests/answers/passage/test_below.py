"""The first time at which |omega| falls below a rate, against event runs of SciPy, and what keeps it above."""
from __future__ import annotations

import json
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stabilab as package
from stabilab import Body, Scene
from stabilab.errors import InputError
from stabilab.physics.effects.eddy_currents import EddyCurrents
from stabilab.physics.effects.gravity import Gravity
from stabilab.physics.effects.liquid_cavity import LiquidCavity
from stabilab.physics.effects.viscous_damper import ViscousDamper
from stabilab.unreduced.slowest import below_by, least_rate
from tests.oracles.rigid import damped, euler, with_a_direction

END = 60.0
DAMPED = {"body": {"inertia": ["0.0022", "0.0020", "0.0018"]}, "effects": {"rate_damper": {"coefficient": 5e-7}},
          "motion": {"angular_velocity": ["20 deg/s", "10 deg/s", "-5 deg/s"]}}


def _run(rates, start, limit=None, end=END):
    """SciPy's own event run of the equations given: (time of the first fall of |omega| to the limit or None,
    the run)."""
    falls = lambda t, y: np.linalg.norm(y[:3]) - (limit or 0)
    falls.terminal, falls.direction = limit is not None, -1
    run = solve_ivp(rates, (0, end), start, method="DOP853", rtol=1e-12, atol=1e-14, events=falls,
                    max_step=end / 1000)
    return (run.t_events[0][0] if limit and len(run.t_events[0]) else None), run


@pytest.mark.parametrize("limit, hours", [("5 deg/s", 1.8144), ("1 deg/s", 3.7501)])
def test_a_detumbling_satellite_is_slow_when_its_event_run_is(limit, hours):
    found = package.load(DAMPED).when(below=limit)
    rate = math.radians(float(limit.split()[0]))
    time, _ = _run(euler((0.0022, 0.0020, 0.0018), damping=5e-7), np.radians([20, 10, -5]), rate, 20000)
    assert found.level == "run" and found.low <= time * (1 + 1e-9) and found.high >= time * (1 - 1e-9)
    assert abs(found.high / 3600 - hours) < 1e-4  # SciPy, four decimals


def _random(n):
    """(case, rates, start, limit) of a random motion: free, with a wheel, under a torque on and off an axis,
    damped."""
    rng = np.random.default_rng([42, n])
    D, w, kind = rng.uniform(1, 2, 3), rng.normal(size=3), n % 6
    wheel, torque = rng.normal(size=3) * (kind in (1, 3, 4)), rng.normal(size=3) * 0.2 * (kind >= 2)
    damper = (0, 0, 0, 0, 0.05, 0.3)[kind]
    if kind == 2:
        torque[1:] = 0
    effects = {"gyrostat": {"momentum": wheel.tolist()}} if any(wheel) else {}
    effects |= {"constant_torque": {"torque": torque.tolist()}} if any(torque) else {}
    effects |= {"rate_damper": {"coefficient": damper}} if damper else {}
    case = package.load({"body": {"inertia": D.tolist()}, "motion": {"angular_velocity": w.tolist()},
                          "effects": effects})
    return case, euler(D, wheel, torque, damper), w, float(np.linalg.norm(w) * rng.uniform(0.4, 0.99))


# of kind 3, off the axes, a spin-up is followed for seconds
@pytest.mark.parametrize("n", [*(n for n in range(12) if n % 6 != 3),
                               *(pytest.param(n, marks=[pytest.mark.slow, *[pytest.mark.long] * (n >= 72)])
                                 for n in range(300) if n >= 12 or n % 6 == 3)])
def test_a_random_motion_is_below_a_rate_when_its_event_run_is_or_never(n):
    case, rates, start, limit = _random(n)
    time, _ = _run(rates, start, limit)
    found = case.when(below=limit)
    if time is None:
        assert found.low >= END or math.isinf(found.low)  # what is proved before holds up to there
    else:
        assert found.low - 1e-8 <= time <= found.high + 1e-8 and found.high - found.low < 1e-6


def test_a_free_body_is_never_slower_than_the_least_on_its_closed_curve():
    """Oracle: energy and momentum give |omega|^2 at its least, where the rate about the middle axis is
    greatest: linear equations in the three squares."""
    D, w = np.array([3.0, 2.0, 1.0]), np.array([0.3, 0.4, 1.0])
    case = package.load({"body": {"inertia": [3, 2, 1]}, "motion": {"angular_velocity": ["0.3", "0.4", 1]}})
    energy, momentum = D @ w**2, (D * D) @ w**2
    squares = [np.linalg.solve([D, D * D, np.eye(3)[n]], [energy, momentum, 0]) for n in (0, 2)]
    least = min(math.sqrt(row.sum()) for row in squares if min(row) > -1e-12)
    above, under = case.when(below=least * (1 - 1e-9)), case.when(below=least * (1 + 1e-9))
    assert math.isinf(above.low) and above.level == "proved"
    assert math.isfinite(under.high) and under.level == "proved"


def test_a_start_below_is_refused_with_line_key_and_cure(stabilab, case_file):
    path = case_file('[body]\ninertia = [3, 2, 1]\n[motion]\nangular_velocity = ["3 deg/s", 0, 0]\n')
    code, out, err = stabilab("when", path, "--below", "5 deg/s")
    assert code == 2 and not out
    assert f"{path}:4: motion.angular_velocity: the motion starts at" in err and "less than that of the start" in err
    code, _, err = stabilab("when", path, "--below", "-5 deg/s")
    assert code == 2 and "--below: expected a positive number" in err
    code, _, err = stabilab("when", path, "--below", "1 deg/s", "--rate", "2 deg/s")
    assert code == 2 and "expected one limit, got --rate and --below" in err


def test_many_states_have_time_zero_where_they_start_below():
    found = package.load(DAMPED).when(states=[[0.01, 0, 0], [0.3, 0, 0]], below="2 deg/s")
    assert found.low[0] == found.high[0] == 0 and found.low[1] > 0


def test_the_answer_stands_in_text_json_csv_and_a_sweep(stabilab, case_file):
    path = case_file(package.load(DAMPED).to_toml())
    text = stabilab("when", path, "--below", "5 deg/s")[1]
    assert text.startswith("case: has |ω| < 5 deg/s after 108.9 min (run ")
    row, = json.loads(stabilab("when", path, "--below", "5 deg/s", "--json")[1])
    assert row["kind"] == "below" and row["reached"] == "yes" and row["limits"] == [math.radians(5)]
    csv = stabilab("when", path, "--below", "5 deg/s", "--csv")[1].splitlines()[1].split(",")
    assert list(map(float, csv[3:5])) == row["time"]
    out = stabilab("sweep", path, "--vary", "coefficient=4e-7:6e-7:3", "--answer", "when", "--below",
                   "5 deg/s", "--csv")[1]
    names, *rows = [line.split(",") for line in out.splitlines() if line.count(",") > 2]
    low = float(rows[1][names.index("when_low (s)")])
    assert low == pytest.approx(row["time"][0], rel=1e-12)


def _sampled(rates, start, end):
    run = solve_ivp(rates, (0, end), start, method="DOP853", rtol=1e-9, atol=1e-11,
                    t_eval=np.linspace(0, end, 2000))
    return np.linalg.norm(run.y[:3], axis=0)


@pytest.mark.parametrize("seed", [0, 1, *(pytest.param(n, marks=pytest.mark.slow) for n in range(2, 30))])
def test_what_a_law_keeps_it_above_is_below_the_least_of_a_run(seed):
    """Oracle: equations written out here, sampled over a long run."""
    rng = np.random.default_rng([7, seed])
    D, w, g = np.sort(rng.uniform(4, 6, 3))[::-1], rng.normal(size=3) * 3, rng.normal(size=3)
    g /= np.linalg.norm(g)
    body = Body(D.tolist())
    centre, k, C = rng.normal(size=3) * 0.3, 1.0, 0.4
    rows = [(Scene(body, Gravity(1, centre.tolist())), {"omega": w, "gamma": g}, with_a_direction(D, arm=centre)),
            (Scene(body, EddyCurrents("0.7", 1)), {"omega": w, "gamma": g}, with_a_direction(D, eddy=0.7)),
            (Scene(body, ViscousDamper(k, C)), {"omega": w, "damper": 0.1 * w[::-1]}, damped(D, k, C))]
    for scene, blocks, rates in rows:
        start = np.concatenate([*blocks.values()])
        least = least_rate(scene, {name: tuple(map(float, v)) for name, v in blocks.items()})
        sampled = _sampled(rates, start, 20.0)
        assert least is None or 0 < least.rate <= sampled.min() * (1 + 1e-9)
    # eddy currents end in rotation about the field, at the rate that is the bound
    p = float((D * w) @ g)
    assert least_rate(rows[1][0], {"omega": tuple(w), "gamma": tuple(g)}).rate == pytest.approx(abs(p) / D[0])


def test_a_liquid_ends_at_the_rate_that_it_is_never_below():
    scene = Scene(Body((9, 8, 5)), LiquidCavity(1250, 1000, "0.1"))
    least = least_rate(scene, (0.5, 0.25, 1.0))
    assert least.rate == pytest.approx(math.hypot(4.5, 2, 5) / 9)  # |H|/D1, by hand


def test_a_law_says_by_when_a_resisted_motion_is_slow():
    """Oracle: a ball, whose rate falls as exp(-c t)."""
    case = package.load({"body": {"inertia": [2, 2, 2]}, "effects": {"resistance": {"coefficient": "0.1"}},
                          "motion": {"angular_velocity": [1, 0, 0]}})
    found = below_by(case.scene, (1.0, 0.0, 0.0), 0.5)
    assert found.time == pytest.approx(math.log(2) / 0.1, rel=1e-12)
    assert case.when(below="0.5").low == pytest.approx(math.log(2) / 0.1, rel=1e-12)


def test_under_a_torque_against_a_damper_the_equilibrium_keeps_it_above():
    """Oracle: about a principal axis the rate tends to M/C from above."""
    case = package.load({"body": {"inertia": [3, 2, 1]}, "effects": {
        "rate_damper": {"coefficient": 1}, "constant_torque": {"torque": ["0.1", 0, 0]}},
        "motion": {"angular_velocity": [1, 0, 0]}})
    assert math.isinf(case.when(below=0.0999).low)
    # w(t) = 0.1 + 0.9 exp(-t/3), by hand
    assert case.when(below=0.2).low == pytest.approx(3 * math.log(9), rel=1e-12)


def test_a_burn_slows_a_body_at_a_time_of_its_own(stabilab, case_file):
    """Oracle: one thruster against the spin of a ball: |omega| = 1 - (M/D) t."""
    path = case_file('[body]\ninertia = [2, 2, 2]\ncentre_of_mass = [0, 0, 0]\n[[thrusters]]\nname = "A"\n'
                     'position = [1, 0, 0]\ndirection = [0, -1, 0]\nforce = "0.5 N"\nstart = 1\nstop = 3\n'
                     '[motion]\nangular_velocity = [0, 0, 1]\nspan = [0, 10]\n')
    row, = json.loads(stabilab("when", path, "--below", "0.75 rad/s", "--json")[1])
    assert row["time"][0] <= 2 <= row["time"][1] and row["level"] == "proved"  # 1 s + 0.25/(0.5/2) s, by hand


def test_both_a_limit_and_another_are_refused():
    with pytest.raises(InputError, match="nutation_below, got rate, below"):
        package.time_to(package.load(DAMPED), rate=1, below=1)
