"""Time constants of what dies out at the end of a motion, against closed forms, eigenvalues of differences of
equations written here, and fits of runs."""
from __future__ import annotations

import json
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import eigh

import stabilab as package
from tests.oracles.rigid import damped, euler, with_a_direction
from tests.shared import CASES


def _ending(body, start, effects, **motion):
    case = package.load({"body": {"inertia": body}, "effects": effects,
                         "motion": {"angular_velocity": start, **motion}})
    return case.motion().ending


def test_a_spinner_across_a_field_slows_with_its_moment_over_k_b_squared():
    """Oracle: D3 omega3' = -k B^2 omega3 where the spin is across the field."""
    end = _ending([2, 3, 4], [0, 0, 1], {"eddy_currents": {"coefficient": "0.5", "field": "0.2"}},
                  vertical=[1, 0, 0])
    assert [(item.axis, item.time) for item in end.constants] == [
        (3, pytest.approx(4 / 0.02)), (2, pytest.approx(3 / 0.02)), (1, pytest.approx(2 / 0.02))]
    run = solve_ivp(with_a_direction([2, 3, 4], eddy=0.02), (0, 200), [0, 0, 1, 1, 0, 0], rtol=1e-10,
                    atol=1e-12)
    assert run.y[2, -1] == pytest.approx(math.exp(-1), rel=1e-8)


def test_vanguard_has_its_moment_over_k_b_squared_among_its_constants():
    case = package.load(CASES / "vanguard-1.toml")
    k, field = case.scene.effect("eddy_currents").exact[:2]
    times = [item.time for item in case.motion().ending.constants]
    assert float(case.scene.body.exact[2] / (k * field**2)) == pytest.approx(times[-1], rel=1e-12)


def test_a_rate_damper_gives_those_of_its_matrix_over_the_moments():
    """Oracle: the generalized eigenvalues of C and D, SciPy."""
    C = np.array([[3.0, 0.5, 0.2], [0.5, 2.0, -0.3], [0.2, -0.3, 4.0]])
    end = _ending([6, 5, 4], [1, 2, 3], {"rate_damper": {"coefficient": C.tolist()}})
    expected = sorted(1 / eigh(C, np.diag([6.0, 5.0, 4.0]), eigvals_only=True), reverse=True)
    np.testing.assert_allclose([item.time for item in end.constants], expected, rtol=1e-12)


def test_a_medium_gives_one_over_c():
    end = _ending([6, 5, 4], [1, 2, 3], {"resistance": {"coefficient": "0.25"}})
    assert [item.time for item in end.constants] == [4, 4, 4] and end.kind == "rest"  # D omega' = ... - c D omega


@pytest.mark.parametrize("seed", [0, 1, *(pytest.param(n, marks=pytest.mark.slow) for n in range(2, 20))])
def test_the_longest_is_the_slope_of_a_run_near_its_end(seed):
    """A sphere damper; the fit is that of the angular momentum across the spin, over a run of
    equations written here."""
    rng = np.random.default_rng([3, seed])
    D, k, C = np.sort(rng.uniform(4, 6, 3))[::-1], 0.5, 0.5
    w = np.array([1.5, *rng.normal(size=2) * 0.01])
    end = _ending(D.tolist(), w.tolist(), {"viscous_damper": {"inertia": k, "coefficient": C}})
    tau = end.constants[0].time
    assert end.constants[0].turns > 0  # it nutates
    run = solve_ivp(damped(D, k, C), (0, 6 * tau), [*w, 0, 0, 0], method="DOP853", rtol=1e-11, atol=1e-15,
                    t_eval=np.linspace(tau, 6 * tau, 4000))
    H = D[:, None] * run.y[:3] + k * run.y[3:]
    # what takes the part across the spin from each time to one that is a share of tau later, by least squares:
    # its eigenvalues know nothing of where a swing begins
    step = 400
    map_, *_ = np.linalg.lstsq(H[1:, :-step].T, H[1:, step:].T, rcond=None)
    decay = -(run.t[step] - run.t[0]) / np.log(np.abs(np.linalg.eigvals(map_)).max())
    assert decay == pytest.approx(tau, rel=1e-2)


def test_they_are_those_of_differences_of_the_equations():
    """Oracle: eigenvalues of central differences of equations written here, where a run by SciPy stays."""
    case = package.load(CASES / "cubesat-3u-detumbling.toml")
    D, R = np.array([float(d) for d in case.scene.body.exact]), case.frame.axes
    turn = np.array([[float(v) for v in axis] for axis in R])
    M = turn @ [1e-7, 0, 0]
    rates = lambda w: (np.cross(D * w, w) + M - 2e-5 * w) / D
    at = solve_ivp(euler(D, torque=M, damping=2e-5), (0, 1e5), case.state, method="DOP853", rtol=1e-10,
                   atol=1e-14).y[:, -1]
    steps = 1e-6 * np.eye(3)
    values = np.linalg.eigvals(np.array([(rates(at + h) - rates(at - h)) / 2e-6 for h in steps]).T)
    expected = sorted({round(float(-1 / z.real), 6) for z in values}, reverse=True)
    np.testing.assert_allclose([item.time for item in case.motion().ending.constants], expected, rtol=1e-6)


def test_classify_prints_them_and_json_has_them(stabilab, case_file):
    path = case_file('[body]\ninertia = [6, 5, 4]\n[effects.rate_damper]\ncoefficient = 0.01\n[motion]\n'
                     'angular_velocity = [1, 0, 0]\n')
    assert "time constants          10 min, 8.333 min, 6.667 min" in stabilab("classify", path)[1]
    row, = json.loads(stabilab("classify", path, "--json")[1])
    assert row["motion"]["ending"]["time_constants"][0] == {"time": 600.0, "turns": 0.0, "axis": None}
