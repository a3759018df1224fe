"""A spinning symmetric satellite on a circular orbit: a wheel along its axis stands for the spin."""
import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stabilab
from tests.shared import CASES

N, A, C, SPIN = 1e-3, 100.0, 150.0, 2e-3  # rad/s, kg m^2, rad/s in space


def axis_over(wheel, rate, times):
    """The axis of the body in the orbital frame by DOP853, from Euler's equations with the torque
    3 n^2 up x D up and the wheel's momentum along axis 3; rate: of the body about axis 3, in space."""
    D = np.diag([A, A, C])

    def rates(t, y):
        w, R = y[:3], y[3:].reshape(3, 3)  # columns of R: the body's axes in space
        up = R.T @ [np.cos(N * t), np.sin(N * t), 0]
        H = D @ w + [0, 0, wheel]
        cross = np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])
        turn = np.linalg.solve(D, 3 * N * N * np.cross(up, D @ up) - np.cross(w, H))
        return np.concatenate([turn, (R @ cross).ravel()])

    lean = 0.1
    R = np.array([[np.cos(lean), 0, np.sin(lean)], [0, 1, 0], [-np.sin(lean), 0, np.cos(lean)]])
    run = solve_ivp(rates, (0, times[-1]), [*(N * R.T @ [0, 0, 1])[:2], rate, *R.ravel()], "DOP853", times,
                    rtol=1e-11, atol=1e-12)
    c, s, axis = np.cos(N * run.t), np.sin(N * run.t), run.y[[5, 8, 11]]
    return np.array([c * axis[0] + s * axis[1], c * axis[1] - s * axis[0], axis[2]])


def test_the_axis_moves_as_that_of_a_body_with_a_wheel_which_does_not_spin():
    times = np.linspace(0, 20_000, 41)
    still = N * np.cos(0.1)  # of the orbital frame along the axis at the start; constant, as SPIN is
    spinning, wheel = axis_over(0.0, SPIN, times), axis_over(C * (SPIN - still), still, times)
    assert np.allclose(spinning, wheel, atol=1e-8) and np.ptp(spinning[0]) > 0.05
    assert not np.allclose(spinning, axis_over(0.0, still, times), atol=1e-2)  # the spin matters


def test_the_case_librates_as_the_linear_motion_of_its_axis():
    """By hand: d/dt + n e3 x of H = A a x a' + C sigma a is 3 n^2 (C - A)(up.a)(up x a), a = (x, y, 1) in the orbital
    frame, in units of n: x'' + (b - 1) y' + (b + 3 (k - 1)) x = 0, y'' - (b - 1) x' + b y = 0 with k = C/A and
    b = k sigma/n - 1, so that the square of a frequency is a root of s^2 - (2 b + g + (b - 1)^2) s + b (b + g),
    g = 3 (k - 1). The energy is positive definite where b > 0 and b + g > 0, as Thomson and Likins have it."""
    found = stabilab.circular_orbit(CASES / "orbits" / "spinning.toml")
    b, g = C / A * SPIN / N - 1, 3 * (C / A - 1)
    expected = N * np.sqrt(np.roots([1, -(2 * b + g + (b - 1) ** 2), b * (b + g)]))
    along = found.equilibria.families[0]
    assert b > 0 and b + g > 0 and along.verdict == "stable"
    assert sorted(along.frequencies) == pytest.approx(sorted(expected), rel=1e-9)


def test_a_spin_in_motion_is_not_looked_at_and_the_answer_says_what_stands_for_it():
    case = {"body": {"inertia": [100, 100, 150]}, "circular_orbit": {"rate": 1e-3}}
    found = stabilab.circular_orbit(case | {"motion": {"angular_velocity": [0, 0, 2e-3]}})
    assert not stabilab.circular_orbit(case).caveats
    (caveat,) = found.caveats
    assert "[motion] is not looked at" in caveat.words
    assert "a wheel along the axis stands for the spin" in caveat.words
