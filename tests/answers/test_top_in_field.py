"""Nutation and precession of symmetric tops in a field, against runs of SciPy, quadrature in mpmath and work by
hand."""
from __future__ import annotations

import json
import math
from fractions import Fraction

import mpmath as mp
import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stabilab as package
from stabilab import Body, Gravity, InputError, NewtonianField, Scene
from stabilab.answers.turning.of_top import _FieldTop
from stabilab.physics.symmetric_top import SymmetricTop
from tests.case.test_top_start import _random

FIELD = """[body]
inertia = [1, 1, 0.5]
[effects.gravity]
weight = 5
centre_of_mass = [0, 0, 0.5]
[effects.newtonian_field]
strength = 10
[motion]
angular_velocity = [-1, -1, {}]
vertical = [1, 0, 0]
"""


@pytest.mark.first(2, 20)
@pytest.mark.parametrize("n", range(240))
def test_a_top_in_a_field_nutates_and_precesses_as_its_run_does(n):
    """Oracle: a run by SciPy of equations written in the test of steady precessions, with the azimuth."""
    case, rates, axis, side, *_ = _random(n)
    if case is None:
        return
    rng = np.random.default_rng([62, n])
    gamma, e = rng.normal(size=3), side * np.eye(3)[axis]
    gamma /= np.linalg.norm(gamma)
    omega = rng.normal(size=3) * 2
    found = package.attitude(case.scene, {"omega": omega.tolist(), "gamma": gamma.tolist()})

    def moves(t, y):
        u = -(y[3:6] @ e)
        return [*rates(t, y[:6]), -(y[:3] @ y[3:6] + (y[:3] @ e) * u) / (1 - u * u)]
    run = solve_ivp(moves, (0, found.nutation_period), [*omega, *gamma, 0], method="DOP853", rtol=1e-11, atol=1e-12,
                    max_step=found.nutation_period / 200)
    cosines = -e @ run.y[3:6]
    leans, ways = np.arccos(cosines), np.sign(np.diff(cosines))
    assert leans[-1] == pytest.approx(leans[0], abs=1e-7) and (ways[1:] * ways[:-1] < 0).sum() <= 2
    assert found.lean[0] <= leans.min() + 1e-8 and found.lean[1] >= leans.max() - 1e-8
    assert found.lean == pytest.approx((leans.min(), leans.max()), abs=1e-3)  # of some hundreds of samples
    assert found.precession_period == pytest.approx(2 * math.pi * found.nutation_period / abs(run.y[6, -1]), rel=1e-7)


def test_without_a_field_the_quartic_has_the_periods_of_lagranges_cubic():
    """Elliptic integrals of the cubic against enclosed integrals of the same top."""
    from stabilab.numbers.balls import working
    scene = Scene(Body((2, 2, 1)), Gravity(1, (0, 0, 3)))
    start = [Fraction(v) for v in ("0.3", "-0.5", "4", "0.6", "0", "-0.8")]
    found = package.attitude(scene, {"omega": ["0.3", "-0.5", 4], "gamma": ["0.6", 0, "-0.8"]})
    with working(128) as numbers:
        *leans, nutation, precession = _FieldTop(SymmetricTop.of(scene), scene, start).answer(numbers)
    assert found.mode == "heavy top" and list(map(float, leans)) == pytest.approx(found.lean, rel=1e-14)
    assert float(nutation) == pytest.approx(found.nutation_period, rel=1e-14)
    assert float(precession) == pytest.approx(found.precession_period, rel=1e-14)


def test_its_periods_to_thirty_digits_are_those_of_quadrature(stabilab, case_file):
    """Oracle: 2 int du/F^(1/2) of F = (1 - u^2) 2 (h - 5u/2 + 5u^2/2) - (1 - 3u/2)^2 between its roots, by the midpoint rule
    in mpmath; by hand: A = 1, f = 10 (1/2 - 1) = -5, s = 5/2, L = 3/2, h = (1 + 1)/2, K = H . gamma = -1."""
    code, out, _ = stabilab("attitude", case_file(FIELD.format(3)), "--digits", "30", "--json")
    row, = json.loads(out)["rows"]
    with mp.workdps(40):
        roots = sorted(z.real for z in mp.polyroots([-5, 5, mp.mpf(3) / 4, -2, 1], maxsteps=200, extraprec=200)
                       if abs(z.imag) < mp.mpf(10) ** -30)
        low, high = max(r for r in roots if r < 0), min(r for r in roots if r > 0)
        middle, part, count = (low + high) / 2, (high - low) / 2, 200
        time = turned = mp.mpf(0)
        for n in range(count):
            z = mp.pi * (2 * n + 1) / (2 * count)
            u = middle - part * mp.cos(z)
            G = 1 - 3 * u / 2
            step = 2 * mp.pi / count * part * mp.sin(z) / mp.sqrt((1 - u * u) * (2 - 5 * u + 5 * u * u) - G * G)
            time, turned = time + step, turned + step * G / (1 - u * u)
        assert code == 0 and row["mode"] == "top in a field"
        for name, value in (("nutation_period", time), ("precession_period", 2 * mp.pi * time / abs(turned))):
            assert abs(mp.mpf(row["decimals"][name]) - value) < mp.mpf(10) ** -28 * value, name


def test_it_tends_to_an_unstable_steady_precession_on_its_separatrix():
    """By hand: A = 1, s = 5/2, f = -5, L = 1/2 has the steady precession W = 1 at u = 1/2: W^2 u - L W + s + f u = 0,
    U'' = (2 u W - L)^2/(1 - u^2) + W^2 + f < 0; h = 3/8 + s u + f u^2/2 = 1 = (1 + 1)/2 + V(0), G(0) = 3/4 + L u = 1."""
    case = package.load(FIELD.format(1))
    found = case.attitude()
    assert found.mode == "separatrix" and "unstable steady precession" in found.because and found.nutation_period is None
    at = math.sqrt(0.75)
    steady = case.attitude(state={"omega": [-at, 0, 1], "gamma": [at, 0, -0.5]}).top
    n = min(range(2), key=lambda n: abs(steady.steady[n] - 1))
    assert steady.steady[n] == pytest.approx(1) and steady.stable[n] is False


def test_a_plane_pendulum_in_a_field_does_not_precess():
    """Oracle: A theta'' = s sin(theta) + f sin(theta) cos(theta), SciPy, of a body that does not spin."""
    scene = Scene(Body((2, 2, 1)), Gravity(1, (0, 0, 3)), NewtonianField(4))
    found = package.attitude(scene, {"omega": [0, "0.7", 0], "gamma": ["0.6", 0, "0.8"]})
    turn = lambda t, y: [y[1], (3 * math.sin(y[0]) - 4 * math.sin(y[0]) * math.cos(y[0])) / 2]
    bottom = lambda t, y: math.sin(y[0])
    run = solve_ivp(turn, (0, 30), [math.acos(-0.8), 0.7], method="DOP853", rtol=1e-12, atol=1e-12, events=bottom)
    assert found.precession_period is None
    assert found.nutation_period == pytest.approx(run.t_events[0][2] - run.t_events[0][1], rel=1e-9)


def test_other_bodies_in_a_field_are_refused_with_what_gives_their_angles(stabilab):
    code, _, err = stabilab("attitude", "cases/top-fast.toml")
    assert code == 2 and "simulate --angles gives Euler angles of the vertical over time" in err
    with pytest.raises(InputError, match="a symmetric top under its weight or in a field"):
        package.attitude(Scene(Body((3, 2, 1)), NewtonianField(4)), {"omega": [1, 0, 0], "gamma": [1, 0, 0]})


def test_a_top_that_cannot_precess_steadily_says_so_with_the_sign_of_its_spin(stabilab, case_file):
    """By hand: the axis to the centre of mass is -z, so 2 rad/s about z is a spin of -114.592 deg/s, and the wheel has 2
    N m s along it; A W^2 cos(lean) - L W + M g l = 0 has real roots where (4 s + 2)^2 >= 4 A M g l cos(lean)."""
    least = np.sqrt(4 * 3 * 10 * 0.8 / np.hypot(0.5, 0.8))
    path = case_file("[body]\ninertia = [3, 3, 4]\n[effects.gravity]\nweight = 20\ncentre_of_mass = [0, 0, -0.5]\n"
                     "[effects.gyrostat]\nmomentum = [0, 0, -2]\n[motion]\nangular_velocity = [0.1, 0.2, 2]\n"
                     "vertical = [0.5, 0, 0.8]\n")
    low, high = (f"{np.degrees(end):.6g}" for end in ((-least - 2) / 4, (least - 2) / 4))
    text = stabilab("attitude", path)[1]
    assert f"none at a lean of 32.0054 deg and a spin of -114.592 deg/s, only at spins below {low} deg/s and above {high} " in text
    assert "(now -114.592 deg/s)" in text
