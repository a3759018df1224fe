"""How far body axes lean from the angular momentum and from their directions at the start, against runs of
SciPy with the rows of the attitude."""
from __future__ import annotations

import json
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stabilab as package
from stabilab.errors import InputError
from tests.oracles.rigid import euler, in_space, tensor
from tests.shared import CASES


def _sampled(D, wheel, torque, w, end, samples=4001, damping=0):
    """(angles of the three axes to the momentum, to their start) (samples, 3) along a run."""
    D, wheel = np.array(D, float), np.array(wheel, float)
    run = solve_ivp(in_space(euler(D, wheel, torque, damping)), (0, end), [*w, *np.eye(3).ravel()], method="DOP853", rtol=1e-9, atol=1e-11,
                    t_eval=np.linspace(0, end, samples))
    H = D * run.y[:3].T + wheel
    R = run.y[3:].reshape(3, 3, -1)
    return (np.arccos(np.clip(H / np.linalg.norm(H, axis=1)[:, None], -1, 1)),
            np.arccos(np.clip(np.stack([R[n, n] for n in range(3)], axis=1), -1, 1)))


def _random(n):
    rng = np.random.default_rng([5, n])
    D, w, kind = rng.uniform(4, 6, 3), rng.normal(size=3), n % 4
    wheel = rng.normal(size=3) * 3 * (kind in (1, 3))
    M = rng.normal(size=3) * 0.3 * (kind >= 2)
    C = 0.2 * (kind == 2)
    effects = {"gyrostat": {"momentum": wheel.tolist()}} if any(wheel) else {}
    effects |= {"constant_torque": {"torque": M.tolist()}} if any(M) else {}
    effects |= {"rate_damper": {"coefficient": C}} if C else {}
    case = package.load({"body": {"inertia": D.tolist()}, "effects": effects,
                         "motion": {"angular_velocity": w.tolist(), "span": [0, 20]}})
    return case, D, wheel, M, w, C


@pytest.mark.first(4, 20)
@pytest.mark.parametrize("n", range(300))
def test_the_angles_of_a_random_motion_are_the_largest_of_its_run(n):
    case, D, wheel, torque, w, damping = _random(n)
    found = case.angles()
    to_momentum, to_start = _sampled(D, wheel, torque, w, 20.0, damping=damping)
    low, high, apart = to_momentum.min(axis=0), to_momentum.max(axis=0), to_start.max(axis=0)
    slack = 1e-4  # of cosines: between samples an extreme is missed by the square of their distance
    assert (found.momentum[:, 0] <= low + 1e-7).all() and (found.momentum[:, 1] >= high - 1e-7).all()
    assert (found.start >= apart - 1e-7).all()
    if not found.for_all_time:
        assert found.level == "run"
        np.testing.assert_allclose(np.cos(found.momentum), np.cos(np.stack([low, high], axis=1)), rtol=0,
                                   atol=slack)
        np.testing.assert_allclose(np.cos(found.start), np.cos(apart), rtol=0, atol=slack)
    else:
        assert n % 4 < 2


def test_of_a_free_body_they_are_those_of_its_cone():
    """Oracle: cos = D omega/|H| at the extremes of each rate; a long run comes near the bound of the start."""
    D, w = np.array([3.0, 2.5, 1.0]), np.array([0.3, 0.1, 1.0])
    case = package.load({"body": {"inertia": [3, "2.5", 1]}, "motion": {"angular_velocity": ["0.3", "0.1", 1]}})
    found, (to_momentum, to_start) = case.angles(), _sampled(D, [0, 0, 0], [0, 0, 0], w, 150.0, 8001)
    assert found.level == "exact" and found.for_all_time
    np.testing.assert_allclose(found.momentum[:, 0], to_momentum.min(axis=0), atol=5e-5)  # of its samples
    np.testing.assert_allclose(found.momentum[:, 1], to_momentum.max(axis=0), atol=5e-5)
    assert (to_start.max(axis=0) <= found.start).all() and found.start[2] * 0.98 < to_start[:, 2].max()
    extremes = case.extremes().values
    size = np.linalg.norm(D * w)
    np.testing.assert_allclose(found.momentum[2], np.arccos(D[2] * extremes[2][::-1] / size), rtol=1e-12)


def test_an_axis_of_the_file_across_principal_axes_has_its_range_from_a_period():
    J = np.array([[3, 0.4, 0], [0.4, 2, 0.2], [0, 0.2, 1.5]])
    case = package.load({"body": {"inertia": J.tolist()}, "motion": {"angular_velocity": [0.2, 1, 0.3]}})
    found = case.angles(axes="z")
    run = solve_ivp(tensor(J), (0, 40), [0.2, 1, 0.3], method="DOP853",
                    rtol=1e-9, atol=1e-11, t_eval=np.linspace(0, 40, 8001))
    H = J @ run.y
    angle = np.arccos(H[2] / np.linalg.norm(H, axis=0))  # SciPy, in the frame of the file
    assert found.level == "run" and found.for_all_time
    np.testing.assert_allclose(found.momentum[0], [angle.min(), angle.max()], atol=1e-5)


def test_a_motor_a_little_off_the_axis_of_a_fast_spinner():
    """Oracle: SciPy over 8 s, a spinner at 7.33 rad/s under a torque 0.3 deg off its axis."""
    D, w, size, off = [70.0, 70.0, 100.0], [0, 0, 7.33], 300.0, math.radians(0.3)
    M = np.array([size * math.sin(off), 0, size * math.cos(off)])
    case = package.load({"body": {"inertia": D}, "effects": {"constant_torque": {"torque": M.tolist()}},
                         "motion": {"angular_velocity": w, "span": [0, 8]}})
    found = case.angles(axes="z")
    to_momentum, to_start = _sampled(D, [0, 0, 0], M, w, 8.0, 8001)
    assert found.level == "run" and found.start[0] == pytest.approx(to_start[:, 2].max(), rel=1e-5)
    assert found.momentum[0, 1] == pytest.approx(to_momentum[:, 2].max(), rel=1e-5)
    assert not math.isfinite(case.when(tilt=("z", found.start[0] * 1.01), until=8).high)
    assert case.when(tilt=("z", found.start[0] * 0.99), until=8).high < 8


def test_past_the_end_of_a_motor_they_go_on():
    """Oracle: SciPy, the motor's momentum as a fourth number that stays from its end on."""
    D, u, stop = np.array([5.0, 4, 3]), np.array([0, 0, 0.2]), 6.0
    case = package.load({"body": {"inertia": [5, 4, 3]}, "effects": {
        "wheel_motor": {"torque": [0, 0, "0.2"], "duration": 6}},
        "motion": {"angular_velocity": ["0.5", "0.2", "0.1"], "span": [0, 20]}})

    def rates(t, y):
        omega, R, h = y[:3], y[3:12].reshape(3, 3), u * min(t, stop)
        turn = np.array([[0, -omega[2], omega[1]], [omega[2], 0, -omega[0]], [-omega[1], omega[0], 0]])
        return [*((np.cross(D * omega + h, omega) - u * (t < stop)) / D), *(R @ turn).ravel()]
    angles, y = [], np.array([0.5, 0.2, 0.1, *np.eye(3).ravel()])
    for begin, end in ((0, stop - 1e-12), (stop, 20)):
        run = solve_ivp(rates, (begin, end), y, method="DOP853", rtol=1e-9, atol=1e-11,
                        t_eval=np.linspace(begin, end, 3001))
        y = run.y[:, -1]
        angles.append(np.arccos(run.y[11]))
    assert case.angles(axes="z").start[0] == pytest.approx(np.concatenate(angles).max(), abs=1e-6)


def test_what_has_no_such_angles_is_refused():
    with pytest.raises(InputError, match="the angular momentum is zero"):
        package.angles({"body": {"inertia": [3, 2, 1]}, "motion": {"angular_velocity": [0, 0, 0]}})
    with pytest.raises(InputError, match="give .motion. span"):
        package.angles({"body": {"inertia": [3, 2, 1]}, "motion": {"angular_velocity": [1, 0, 0]},
                        "effects": {"constant_torque": {"torque": [1, 1, 0]}}})
    with pytest.raises(InputError, match="scaled variables have no attitude"):
        package.angles(CASES / "minor-axis-100.toml")
    with pytest.raises(InputError, match="axes: expected x, y, z"):
        package.load(CASES / "toutatis.toml").angles(axes="xw")


def test_extremes_prints_them_and_json_and_csv_have_them(stabilab):
    path = CASES / "toutatis.toml"
    text = stabilab("extremes", path, "--angles")[1]
    line = next(line for line in text.splitlines() if line.startswith("  z ") and line.endswith("deg"))
    assert line.split() == ["z", "50.5399", "51.2138", "101.754", "deg"]
    assert "angles" not in stabilab("extremes", path)[1]
    row = json.loads(stabilab("extremes", path, "--angles", "--json")[1])
    row = row[0] if isinstance(row, list) else row
    lines = stabilab("extremes", path, "--angles", "--csv")[1].splitlines()
    line = next(line.split(",") for line in lines if ",z to angular momentum," in line)
    assert [float(v) for v in line[2:4]] == row["angles"]["momentum"][2]
    assert row["angles"]["over"] == "all time" and row["angles"]["level"] == "exact"


@pytest.mark.parametrize("n", [0, *(pytest.param(n, marks=pytest.mark.slow) for n in range(1, 20))])
def test_under_a_torque_on_an_axis_an_axis_keeps_to_a_cone_for_all_times(n):
    """Oracle: SciPy over many periods of a bounded motion, whose largest angles come near the bounds and do not
    pass them."""
    rng = np.random.default_rng([9, n])
    D = np.sort(rng.uniform(2, 4, 3))[::-1]
    w = np.array([rng.normal() * 0.02, rng.normal() * 0.02, 1.0])
    M = np.array([0, 0, 0.0])
    M[0] = 0.02 * rng.uniform(0.5, 1)
    case = package.load({"body": {"inertia": D.tolist()}, "motion": {"angular_velocity": w.tolist()},
                         "effects": {"constant_torque": {"torque": M.tolist()}}})
    if case.motion().fate != package.Fate.BOUNDED:
        pytest.skip("it spins up")
    found = case.angles(axes="3")
    end = 15 * case.motion().period
    to_momentum, to_start = _sampled(D, [0, 0, 0], M, w, end, 6001)
    assert found.for_all_time and found.level == "run"
    assert found.momentum[0, 1] == pytest.approx(to_momentum[:, 2].max(), abs=1e-4)
    assert 0.8 * found.start[0] <= to_start[:, 2].max() <= found.start[0] * (1 + 1e-6)
    assert math.isinf(case.when(tilt=("3", found.start[0] * 1.001)).low)


def test_a_spinner_with_a_motor_across_its_axis_is_never_far_from_its_start():
    """Oracle: SciPy has at most 0.1363 deg over 3000 s (811 kg, 445 N, 0.3 deg off, 7.33 rad/s)."""
    case = package.load({"body": {"inertia": ["282.704", "282.704", "251.473"]},
                         "effects": {"constant_torque": {"torque": ["1.77549", 0, 0]}},
                         "motion": {"angular_velocity": [0, 0, "7.33"], "span": [0, 1800]}})
    assert math.degrees(case.angles(axes="z").start[0]) == pytest.approx(0.1363, abs=5e-5)
    found = case.when(tilt="z = 0.2 deg")
    assert math.isinf(found.low) and found.level == "run" and found.tilt is None
