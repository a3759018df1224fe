"""A start stated by periods, or by spin and nutation: there and back, and against runs of SciPy."""
from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stabilab as package
from stabilab.errors import InputError
from tests.oracles.rigid import euler, in_space

TC3 = {"body": {"inertia": [57.9, 53.3, 21.4]},  # of an assumed shape
       "motion": {"rotation_period": "99.20 s", "precession_period": "97.00 s", "mode": "long-axis"}}


def _case(inertia, **motion):
    return package.load({"body": {"inertia": list(inertia)}, "motion": motion})


def _moments(rng, n):
    """Three moments of a body; of every seventh two are equal."""
    D = rng.uniform(1, 2, 3)
    if n % 7 == 3:
        D[2] = D[1]
    return rng.permutation(D).tolist()


@pytest.mark.first(25, 100)
@pytest.mark.parametrize("n", range(500))
def test_a_tumbler_is_back_at_its_periods(n):
    """The periods of random rates, by `attitude`; the rates of these periods; and their periods again."""
    rng = np.random.default_rng([11, n])
    D, scale = _moments(rng, n), 10.0 ** rng.uniform(-5, 2)
    first = _case(D, angular_velocity=(rng.normal(size=3) * scale).tolist()).attitude()
    if 1 - first.cone[1] / (math.pi / 2) < 1e-3:
        pytest.skip("too near the separatrix for a double's periods")
    found = _case(D, rotation_period=first.rotation_period, precession_period=first.precession_period,
                  mode=first.mode)
    back = found.attitude()
    assert back.mode == first.mode
    assert back.rotation_period == pytest.approx(first.rotation_period, rel=1e-12)
    assert back.precession_period == pytest.approx(first.precession_period, rel=1e-12)
    assert back.cone == pytest.approx(first.cone, abs=1e-9)  # two motions with these periods would differ in it


def _run(D, w, until):
    """Rates and the body's axes in space along a run of Euler's equations with the rows of the attitude."""
    return solve_ivp(in_space(euler(D)), (0, until), [*w, *np.eye(3).ravel()], method="DOP853", rtol=1e-12, atol=1e-13,
                     t_eval=np.linspace(0, until, 4001))


@pytest.mark.parametrize("D, rotation, precession, mode", [
    ([57.9, 53.3, 21.4], 99.2, 97.0, "long-axis"), ([3.22, 3.09, 1.0], 5.41, 7.35, "long-axis"),
    ([5, 4, 3], 10.0, 2.0, "short-axis"), ([5, 5, 3], 10.0, 4.0, "long-axis")])
def test_a_run_from_the_rates_has_the_periods(D, rotation, precession, mode):
    """Oracle: after the rotation period the rates are back, and the axis has gone round the angular momentum by
    rotation/precession turns; both along a run by SciPy."""
    case = _case(D, rotation_period=rotation, precession_period=precession, mode=mode)
    run = _run(D, case.state, rotation)
    np.testing.assert_allclose(run.y[:3, -1], case.state, rtol=0, atol=1e-9)
    assert not np.allclose(run.y[:3, 2000], case.state, atol=1e-3)  # nor sooner
    h = np.array(D) * case.state
    h = h / np.linalg.norm(h)
    axis = run.y[3:].reshape(3, 3, -1)[:, int(np.argmin(D) if mode == "long-axis" else np.argmax(D))]
    side = np.cross(h, [0.3, -0.5, 0.8])
    side = side / np.linalg.norm(side)
    angle = np.unwrap(np.arctan2(np.cross(h, side) @ axis, side @ axis))
    assert abs(angle[-1] - angle[0]) / (2 * math.pi) == pytest.approx(rotation / precession, abs=1e-8)


@pytest.mark.parametrize("period", ["rotation_period", "precession_period"])
def test_the_amplitude_is_the_largest_angle_of_a_run(period):
    D = [5, 4, 3]
    case = _case(D, **{period: 7, "amplitude": "40 deg", "mode": "short-axis"})
    known = case.attitude()
    assert getattr(known, period) == pytest.approx(7, rel=1e-14)
    run = _run(D, case.state, known.rotation_period)
    cosine = D[0] * run.y[0] / np.linalg.norm(np.array(D)[:, None] * run.y[:3], axis=0)
    assert math.degrees(math.acos(cosine.min())) == pytest.approx(40, abs=1e-4)  # between 4001 samples


def test_the_mode_is_found_where_the_periods_have_one_alone():
    assert _case([5, 4, 3], rotation_period=10, precession_period=4).attitude().mode == "long-axis"


def test_spin_and_nutation_of_a_textbooks_shell():
    """125, 125, 100 kg m^2, 1 rpm relative to the plane of precession, which is 5 rpm about the axis, nutation
    20 deg: a precession in 14.0954 s (Curtis, Orbital Mechanics; C spin/(A cos) by hand)."""
    case = _case([125, 125, 100], spin="5 rpm", axis=[0, 0, 2], nutation="20 deg")
    found = case.attitude()
    assert found.precession_period == pytest.approx(14.0954, abs=5e-5)
    assert found.precession_period == pytest.approx(
        2 * math.pi * 125 * math.cos(math.radians(20)) / (100 * 10 * math.pi / 60), rel=1e-13)


def test_with_wheels_and_a_full_tensor_the_momentum_is_at_the_angle():
    """Oracle: spin, angle and the plane of the lean by NumPy, in the frame of the file."""
    J = np.array([[10, 1, -0.5], [1, 8, 0.3], [-0.5, 0.3, 5]])
    axis, lean = np.array([1.0, 2, 3]) / math.sqrt(14), np.array([0.0, 1, 0])
    case = package.load({"body": {"inertia": J.tolist()},
                         "effects": {"gyrostat": {"momentum": [1, -2, "0.5"]}},
                         "motion": {"spin": "0.7 rad/s", "axis": [1, 2, 3], "nutation": "25 deg",
                                    "towards": lean.tolist()}})
    axes = np.array([[float(v) for v in row] for row in case.frame.axes])
    omega = axes.T @ case.state
    H = J @ omega + [1, -2, 0.5]
    assert omega @ axis == pytest.approx(0.7, rel=1e-13)
    assert math.degrees(math.acos(H @ axis / np.linalg.norm(H))) == pytest.approx(25, rel=1e-12)
    assert H @ np.cross(axis, lean) == pytest.approx(0, abs=1e-12) and H @ lean > 0


def test_a_spin_without_nutation_is_about_the_axis():
    np.testing.assert_allclose(_case([5, 4, 3], spin="60 rpm", axis=[1, 0, 1]).state,
                               2 * math.pi * np.array([1, 0, 1]) / math.sqrt(2), rtol=1e-15)


@pytest.mark.parametrize("inertia, motion, line, words", [
    ([5, 4, 3], 'rotation_period = 10\nprecession_period = 100\nmode = "long-axis"', 5,
     "motion.precession_period: no motion of this body has a precession period of 100 s beside a rotation "
     "period of 10 s: the moments allow less than "),
    ([5, 4, 3], "rotation_period = 10\nprecession_period = 100", 5, "in long-axis mode, and less than"),
    ([5, 4, 3], "rotation_period = 10\nprecession_period = 2", 4, 'add mode = "long-axis" or "short-axis"'),
    ([5, 4, 3], "rotation_period = 10", 4, "expected two of rotation_period, precession_period, amplitude"),
    ([5, 4, 3], "rotation_period = -10\namplitude = 1", 4, "expected a positive number"),
    ([5, 4, 3], 'rotation_period = 10\namplitude = "95 deg"\nmode = "long-axis"', 5, "below 90 deg"),
    ([5, 4, 3], 'rotation_period = 10\namplitude = 1\nmode = "sideways"', 6, "expected long-axis or short-axis"),
    ([5, 4, 3], 'mode = "long-axis"', 4, "expected two of"),
    ([5, 5, 5], "rotation_period = 10\nprecession_period = 2", 4, "all moments are equal"),
    ([5, 5, 3], 'rotation_period = 10\nprecession_period = 2\nmode = "short-axis"', 6, "two equal moments"),
    ([5, 4, 3], "rotation_period = 10\nangular_velocity = [1, 0, 0]", 4, "in two ways"),
    ([5, 4, 3], "spin = 1\nrotation_period = 10\namplitude = 1", 4, "in two ways"),
    ([5, 4, 3], "spin = 1", 4, "expected axis, a vector of any length"),
    ([5, 4, 3], "axis = [0, 0, 1]", 4, "expected spin"),
    ([5, 4, 3], 'spin = 1\naxis = [0, 0, 1]\nnutation = "200 deg"', 6, "from 0 to 180 deg"),
    ([5, 4, 3], 'spin = 1\naxis = [0, 0, 1]\nnutation = "100 deg"', 6, "from 0 to 90 deg"),
    ([5, 4, 3], "spin = 1\naxis = [0, 0, 0]", 5, "expected a direction, got zero"),
    ([5, 4, 3], "spin = 1\naxis = [0, 0, 1]\nnutation = 1\ntowards = [0, 0, 2]", 7, "lies along the axis"),
    ([5, 4, 3], "spin = 1\naxis = [0, 0, 1]\ntowards = [0, 1, 0]", 6, "give nutation as well"),
])
def test_what_is_no_start_is_one_error_with_line_and_cure(stabilab, case_file, inertia, motion, line, words):
    path = case_file(f"[body]\ninertia = {inertia}\n[motion]\n{motion}\n")
    code, out, err = stabilab("fate", path)
    assert code == 2 and not out and words in err and err.count(f"{path}:") == 1
    assert f"{path}:{line}: " in err


def test_a_wheel_has_no_such_periods():
    with pytest.raises(InputError, match="without wheels"):
        package.load(TC3 | {"effects": {"gyrostat": {"momentum": [1, 0, 0]}}})


def test_scaled_variables_have_no_such_start(case_file, stabilab):
    path = case_file("[scaled]\na = 1\nb = 1\nmu = [0, 0, 1]\n[motion]\nspin = 1\naxis = [0, 0, 1]\n")
    assert "no body to convert spin with: give x" in stabilab("fate", path)[2]


def test_a_limit_below_the_observed_start_is_refused():
    with pytest.raises(InputError, match="below the rate that the motion starts with"):
        package.load(TC3 | {"limits": {"rate": 1e-3}})


def test_the_case_is_written_as_it_was_stated_and_another_start_in_rates():
    case = package.load(TC3)
    assert package.load(case.to_toml()) == case and "rotation_period" in case.to_toml()
    from stabilab.case.given import as_case
    moved = as_case(case, [0.1, 0.2, 0.3])
    assert moved.state == (0.1, 0.2, 0.3) and package.load(moved.to_toml()).state == (0.1, 0.2, 0.3)


def test_a_sweep_varies_a_period_and_draws_from_its_uncertainty(stabilab, case_file):
    text = package.load(TC3).to_toml().replace('"99.20 s"', '"99.20 +- 0.04 s"')
    path = case_file(text)
    out = stabilab("sweep", path, "--samples", "4", "--answer", "period", "--csv")[1].splitlines()
    rows = [line.split(",") for line in out[1:]]
    assert len(rows) == 4 and all(abs(float(row[1]) - 99.2) <= 0.04 for row in rows)
    assert all(float(row[2]) == pytest.approx(float(row[1]), rel=1e-12) for row in rows)
    assert "within the uncertainties" not in stabilab("fate", path)[1]  # without a torque all is bounded
    torque = case_file(text + "[effects.constant_torque]\ntorque = [1e-3, 0, 0]\n", "torque")
    assert "sweep --samples draws from them" in stabilab("fate", torque)[1]


def test_every_view_of_the_explorer_starts_from_the_rates():
    from stabilab.show.explore.parameters import changed
    from stabilab.show.units import units_of
    case = package.load(TC3)
    moved, *_ = changed(case, {"inertia": ["58", None, None]}, units_of(case))
    assert moved.state == pytest.approx(case.state, rel=1e-15) and not moved.observed
