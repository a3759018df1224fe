"""The first time at a nutation angle, from either side, and at an angle to the direction at the start, against
event runs of SciPy and the cone of a free body."""
from __future__ import annotations

import json
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stabilab as package
from stabilab.errors import InputError
from tests.oracles.rigid import damped, euler, in_space
from tests.shared import CASES

END = 20.0


def _angle(D, wheel, inside=0.0):
    """(cosine of the angle between axis 3 and the angular momentum) of states."""
    def cosine(t, y):
        y = np.asarray(y)
        H = D * y[:3] + wheel + (inside * y[3:6] if inside else 0)
        return H[2] / np.linalg.norm(H)
    return cosine


def _first(rates, start, cosine, angle, falls, end=END):
    """The first time by SciPy at which the angle reaches a limit; None where it does not."""
    event = lambda t, y: cosine(t, y) - math.cos(angle)
    event.terminal, event.direction = True, 1 if falls else -1
    run = solve_ivp(rates, (0, end), start, method="DOP853", rtol=1e-12, atol=1e-14, events=event,
                    max_step=end / 400)
    return run.t_events[0][0] if len(run.t_events[0]) else None


def _random(n):
    """(case, rates, start, cosine) of a random motion: free, with a wheel, with a damper inside, under a torque
    on and off an axis."""
    rng = np.random.default_rng([77, n])
    D, w, kind = rng.uniform(4, 6, 3), rng.normal(size=3), n % 5
    wheel = rng.normal(size=3) * 3 * (kind in (1, 4))
    torque = rng.normal(size=3) * 0.5 * (kind >= 3)
    if kind == 3:
        torque[1:] = 0
    k, C = (1.0, 0.6) if kind == 2 else (0.0, 0.0)
    effects = {"gyrostat": {"momentum": wheel.tolist()}} if any(wheel) else {}
    effects |= {"constant_torque": {"torque": torque.tolist()}} if any(torque) else {}
    effects |= {"viscous_damper": {"inertia": k, "coefficient": C}} if k else {}
    case = package.load({"body": {"inertia": D.tolist()}, "motion": {"angular_velocity": w.tolist()},
                         "effects": effects})

    rates = damped(D, k, C) if k else euler(D, wheel, torque)
    return case, rates, [*w, *[0.0] * (3 if k else 0)], _angle(D, wheel, k)


@pytest.mark.first(4, 32)
@pytest.mark.parametrize("n", range(300))
def test_a_random_motion_is_at_an_angle_when_its_event_run_is_or_never(n):
    case, rates, start, cosine = _random(n)
    begun = math.acos(cosine(0, np.array(start)))
    rng = np.random.default_rng([78, n])
    for falls in (False, True):
        angle = begun * rng.uniform(0.6, 0.98) if falls else begun + (math.pi - begun) * rng.uniform(0.02, 0.4)
        time = _first(rates, start, cosine, angle, falls)
        option = {"nutation_below" if falls else "nutation": ("3", angle)}
        found = case.when(**option)
        if time is None:
            assert found.low >= END or math.isinf(found.low)
        else:
            assert found.low - 1e-8 <= time <= found.high + 1e-8 and found.high - found.low < 1e-6


def test_a_free_bodys_nutation_is_proved_within_its_cone():
    """Oracle: cos = D3 omega3/|H| at the extremes of omega3, by energy and momentum."""
    D, w = np.array([3.0, 2.0, 1.0]), np.array([0.3, 0.4, 1.0])
    case = package.load({"body": {"inertia": [3, 2, 1]}, "motion": {"angular_velocity": ["0.3", "0.4", 1]}})
    energy, momentum = D @ w**2, (D * D) @ w**2
    squares = [np.linalg.solve([D, D * D, np.eye(3)[n]], [energy, momentum, 0])[2] for n in (0, 1)]
    ends = [math.acos(math.sqrt(square / momentum)) for square in squares]
    least, greatest = sorted(ends)
    never, reached = (case.when(nutation=("3", greatest + gap)) for gap in (1e-6, -1e-6))
    assert math.isinf(never.low) and never.level == "exact" and reached.level == "proved"
    never, reached = (case.when(nutation_below=("3", least + gap)) for gap in (-1e-6, 1e-6))
    assert math.isinf(never.low) and never.level == "exact" and reached.level == "proved"


def test_a_free_bodys_axis_stays_within_the_sum_of_its_cone():
    """Oracle: the largest angle of a long run by SciPy comes near the bound and does not pass it."""
    D, w = np.array([3.0, 2.5, 1.0]), np.array([0.3, 0.1, 1.0])
    run = solve_ivp(in_space(euler(D)), (0, 300), [*w, *np.eye(3).ravel()], method="DOP853", rtol=1e-10, atol=1e-12,
                    t_eval=np.linspace(0, 300, 6001))
    largest = math.acos(run.y[3:].reshape(3, 3, -1)[2, 2].min())
    case = package.load({"body": {"inertia": [3, "2.5", 1]}, "motion": {"angular_velocity": ["0.3", "0.1", 1]}})
    cone, H = case.attitude().cone, D * w
    bound = math.acos(H[2] / np.linalg.norm(H)) + cone[1]
    assert bound * 0.98 < largest <= bound
    assert math.isinf(case.when(tilt=("3", bound * (1 + 1e-6))).low)
    assert math.isfinite(case.when(tilt=("3", largest * (1 - 1e-6))).high)


@pytest.mark.slow
def test_the_passage_of_a_spinner_to_flat_spin_begins_where_flat_spin_says():
    case = package.load(CASES / "explorer-1-damped.toml")
    found, times = case.when(nutation="z = 5 deg"), dict(case.motion().ending.times)
    assert abs(found.low - times["leaves"].at) < 1.0  # s of 2924: one by the energy, one by the angle


@pytest.mark.parametrize("option, text, words", [
    ("nutation-below", "z = 200 deg", "expected an angle below half a turn (pi rad, 180 deg)"),
    ("nutation", "z = 180 deg", "expected an angle below half a turn"),
    ("nutation", "5 deg", '--nutation: expected an axis and its limit, as in "z = 20 deg"'),
    ("nutation-below", "z = -5 deg", "--nutation-below: expected a positive number"),
    ("nutation-below", "z = 60 deg", "motion.angular_velocity: the nutation is 50.5399 deg at the start"),
])
def test_what_is_no_angle_is_refused_with_key_and_cure(stabilab, option, text, words):
    code, out, err = stabilab("when", CASES / "toutatis.toml", f"--{option}", text)
    assert code == 2 and not out and words in err


def test_a_body_without_angular_momentum_has_no_nutation():
    case = package.load({"body": {"inertia": [3, 2, 1]}, "motion": {"angular_velocity": [0, 0, 0]}})
    with pytest.raises(InputError, match="the angular momentum is zero"):
        case.when(nutation="z = 5 deg")


def test_text_and_json_name_the_angle(stabilab):
    path = CASES / "toutatis.toml"
    assert "NEVER has the nutation of axis x < 38 deg (exact)" in stabilab(
        "when", path, "--nutation-below", "x = 38 deg")[1]
    assert "NEVER reaches the nutation of axis z = 60 deg (exact)" in stabilab(
        "when", path, "--nutation", "z = 60 deg")[1]
    row, = json.loads(stabilab("when", path, "--nutation", "z = 51 deg", "--json")[1])
    assert row["kind"] == "nutation" and row["limits"] == [math.radians(51)] and row["reached"] == "yes"
