"""Periods, modes and turns against an attitude that DOP853 follows: Euler's equations and the matrix C' = C [w]x as
they stand, no code in common with the program's."""
import json
import math
from fractions import Fraction

import mpmath as mp
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation
from scipy.special import ellipk

import stabilab
from stabilab import attitude
from stabilab.errors import ToleranceNotMet
from tests.oracles import energy
from tests.oracles.model import physical
from tests.oracles.rigid import euler, in_space, with_a_direction

LONG = [pytest.mark.slow, pytest.mark.long]


def run(D, wheel, torque, omega, times):
    """(rates (n, 3), matrices from body to space (n, 3, 3)) at the times."""
    y = solve_ivp(in_space(euler(D, wheel, torque)), (0, times[-1]), [*omega, *np.eye(3).ravel()], "DOP853", t_eval=times, rtol=3e-14,
                  atol=1e-14 * np.abs(omega).max()).y.T
    return y[:, :3], y[:, 3:].reshape(-1, 3, 3)


def scene_of(D, wheel=(0, 0, 0), torque=(0, 0, 0)):
    return stabilab.Scene(stabilab.Body(tuple(D)), stabilab.Gyrostat(tuple(wheel)),
                          stabilab.ConstantTorque(tuple(torque)))


def checked(D, wheel, torque, omega, tolerance):
    """The answer, after its turn, its return of the rates and its mean precession were compared with a run."""
    found = stabilab.attitude(scene_of(D, wheel, torque), omega)
    if found.rotation_period is None or found.mode == "steady":
        return found
    period = found.rotation_period
    count = 2000 if found.precession_period else 2
    rates, C = run(D, wheel, torque, omega, np.linspace(0, period, count))
    size = np.abs(rates).max()
    np.testing.assert_allclose(rates[-1], omega, rtol=0, atol=100 * tolerance * size)
    turn = Rotation.from_rotvec(found.turn_angle * np.array(found.turn_axis)).as_matrix()
    np.testing.assert_allclose(turn, C[-1], rtol=0, atol=100 * tolerance)
    assert 0 <= found.turn_angle <= math.pi
    H = D * omega + wheel
    np.testing.assert_allclose(found.momentum_direction, H / np.linalg.norm(H), rtol=1e-14, atol=1e-15)
    if found.precession_period:
        axis = np.argmin(D) if found.mode == "long-axis" else np.argmax(D)
        h = np.array(found.momentum_direction)
        one = np.cross(h, [0, 0, 1.0] if abs(h[2]) < 0.9 else [1.0, 0, 0])
        one /= np.linalg.norm(one)
        e = C[:, :, axis]  # the body's axis in space
        turned = np.unwrap(np.arctan2(e @ np.cross(h, one), e @ one))[-1] - math.atan2(
            e[0] @ np.cross(h, one), e[0] @ one)
        assert 2 * math.pi * period / abs(turned) == pytest.approx(found.precession_period, rel=10 * tolerance)
        cosines = np.clip(e @ h, -1, 1)
        angles = np.arccos(cosines * np.sign(cosines.min() + cosines.max()))
        assert found.cone[0] <= angles.min() + 1e-7
        assert found.cone[1] >= angles.max() - 1e-7
        assert found.cone == pytest.approx((angles.min(), angles.max()), abs=1e-2)  # of 2,000 samples
    return found


def body(rng):
    """Moments of a body, by mass points, in any order."""
    return rng.permutation(np.array([[0, 1, 1], [1, 0, 1], [1, 1, 0]]) @ rng.uniform(0.05, 1, 3))


@pytest.mark.parametrize("seeds", [range(6), pytest.param(range(6, 50), marks=pytest.mark.slow),
                                   pytest.param(range(50, 1000), marks=LONG)], ids=str)
def test_periods_of_random_free_bodies_are_those_of_followed_attitudes(seeds):
    modes = set()
    for seed in seeds:
        rng = np.random.default_rng(seed)
        found = checked(body(rng), np.zeros(3), np.zeros(3), rng.normal(size=3) * 10 ** rng.uniform(-2, 2), 1e-11)
        modes.add(found.mode)
    assert modes == {"long-axis", "short-axis"}


@pytest.mark.parametrize("distance", [1e-2, 1e-4, 1e-6])
@pytest.mark.parametrize("side", [1, -1])
def test_periods_beside_the_separatrix(distance, side):
    """H^2 = 2T D_b on it; the second component is moved off it by a share."""
    D, w1 = np.array([1.0, 2.0, 3.0]), 0.5
    w3 = w1 * math.sqrt(D[0] * (D[1] - D[0]) / (D[2] * (D[2] - D[1]))) * (1 + side * distance)
    found = checked(D, np.zeros(3), np.zeros(3), np.array([w1, 0.0, w3]), 3e-11 / math.sqrt(distance))
    assert found.mode == ("short-axis" if side > 0 else "long-axis")


def test_the_period_grows_by_the_logarithm_down_to_32_decimals_from_the_separatrix(tmp_path):
    """4 K(m) = 2 ln(16/(1 - m)) + ..., and 1 - m falls with the distance: 4 ln(10) a decade and lambda."""
    periods = []
    for n in (30, 32):  # on it w1 = sqrt(3) w3; the case has its decimals exactly
        w1 = f"0.{str(math.isqrt(3 * 10**80) // 2).zfill(40)}"
        w3 = f"0.5{'0' * (n - 2)}1"
        (tmp_path / "case.toml").write_text(f'[body]\ninertia = [1, 2, 3]\n[motion]\n'
                                            f'angular_velocity = ["{w1}", 0, "{w3}"]\n')
        periods.append(stabilab.attitude(stabilab.load(tmp_path / "case.toml")).rotation_period)
    T2, H2 = 3 / 4 + 3 / 4, 3 / 4 + 9 / 4
    speed = math.sqrt((H2 - T2) * (3 - 2) / (1 * 2 * 3))  # short axis: lambda^2 of the module with A^2 put in
    assert periods[1] - periods[0] == pytest.approx(2 * math.log(100) / speed, rel=1e-9)


@pytest.mark.parametrize("seeds", [range(4), pytest.param(range(4, 24), marks=pytest.mark.slow),
                                   pytest.param(range(24, 400), marks=LONG)], ids=str)
def test_free_gyrostats_turn_as_their_followed_attitudes(seeds):
    for seed in seeds:
        rng = np.random.default_rng(500 + seed)
        wheel = rng.normal(size=3) * (rng.random(3) < 0.6)
        checked(body(rng), wheel, np.zeros(3), rng.normal(size=3), 1e-10)


@pytest.mark.parametrize("seeds", [range(3), pytest.param(range(3, 20), marks=pytest.mark.slow),
                                   pytest.param(range(20, 400), marks=LONG)], ids=str)
def test_bounded_motions_with_a_torque_turn_as_their_followed_attitudes(seeds):
    bounded = 0
    for seed in seeds:
        rng = np.random.default_rng(900 + seed)
        D, axis = body(rng), rng.integers(3)
        torque, wheel = np.zeros(3), rng.normal(size=3)
        torque[axis], wheel[axis] = 0.05 * rng.normal(), 0
        found = checked(D, wheel, torque, rng.normal(size=3), 1e-10)
        bounded += found.turn_angle is not None
        assert found.mode is None or found.mode == "steady"
    assert bounded > len(seeds) / 3


def test_a_symmetric_body_precesses_at_its_momentum_over_its_transverse_moment():
    """Landau & Lifshitz, section 33: H/D1 about H, (D3 - D1)/D1 w3 of the rates in the body."""
    for D, mode in (((2.0, 2.0, 3.0), "short-axis"), ((2.0, 2.0, 0.5), "long-axis")):
        omega = np.array([0.3, 0.4, 1.0])
        found = stabilab.attitude(scene_of(D), omega)
        assert found.mode == mode
        assert found.precession_period == pytest.approx(2 * math.pi * 2 / np.linalg.norm(D * omega), rel=1e-14)
        assert found.rotation_period == pytest.approx(2 * math.pi * 2 / abs(D[2] - 2), rel=1e-14)


def test_what_a_motion_does_not_have_is_none():
    steady = stabilab.attitude(scene_of((3, 2, 1)), (0, 0, 2.0))
    assert (steady.mode, steady.precession_period, steady.turn_angle) == ("steady", None, None)
    assert steady.rotation_period == pytest.approx(math.pi)
    rest = stabilab.attitude(scene_of((3, 2, 1)), (0, 0, 0))
    assert (rest.mode, rest.rotation_period, rest.momentum_direction) == ("steady", None, None)
    spin_up = stabilab.attitude(scene_of((3, 2, 1), torque=(0, 0, 1)), (0.1, 0.1, 5.0))
    assert (spin_up.mode, spin_up.rotation_period) == (None, None)
    assert "does not repeat" in spin_up.because or "not known to repeat" in spin_up.because
    between = stabilab.attitude(scene_of((9, 8, 4)), (1.0, 0.0, 0.75))  # 9 (9 - 8) w1^2 = 4 (8 - 4) w3^2
    assert (between.mode, between.rotation_period) == ("separatrix", None)


def test_the_answer_in_json_is_in_the_frame_of_the_file(stabilab, tmp_path):
    text = ("[body]\ninertia = {}\n[motion]\nangular_velocity = {}\n")
    turn = Rotation.from_rotvec([0.3, -0.2, 0.5]).as_matrix()
    D, omega = np.diag([3.0, 2.0, 1.0]), np.array([0.2, 0.4, 0.3])
    answers = []
    for name, tensor, rates in (("a", [3.0, 2.0, 1.0], omega), ("b", (turn @ D @ turn.T).tolist(), turn @ omega)):
        (tmp_path / f"{name}.toml").write_text(text.format(tensor, rates.tolist()))
        code, out, _ = stabilab("attitude", tmp_path / f"{name}.toml", "--json")
        answers.append(json.loads(out))
    assert [one["schema"] for one in answers] == ["stabilab.attitude/1"] * 2
    one, other = (answer["rows"][0] for answer in answers)
    assert one["mode"] == other["mode"] == "short-axis"
    for key in ("rotation_period", "precession_period", "turn_angle"):
        assert other[key] == pytest.approx(one[key], rel=1e-12)
    for key in ("momentum_direction", "turn_axis"):
        np.testing.assert_allclose(other[key], turn @ np.array(one[key]), atol=1e-12)


def top_of(A, C, wheel, arm):
    return stabilab.Scene(stabilab.Body((A, A, C)), stabilab.Gyrostat((0, 0, wheel)),
                          stabilab.Gravity(abs(arm), (0, 0, math.copysign(1, arm))))


def top_run(A, C, wheel, arm, start, end):
    """(leans, azimuth of the axis that was passed at the end) by Euler's and Poisson's equations as they
    stand."""
    turning, sign = with_a_direction([A, A, C], (0, 0, wheel), arm=(0, 0, arm)), -math.copysign(1, arm)

    def rates(t, y):
        u, v, _, a, b, c, _ = y.tolist()
        return [*turning(t, y[:6]), (u * a + v * b) / (1 - c * c)]
    y = solve_ivp(rates, (0, end), [*start, 0.0], "DOP853", rtol=1e-12, atol=1e-14,
                  t_eval=np.linspace(0, end, 20_001)).y
    return np.arccos(np.clip(sign * y[5], -1, 1)), y[6, -1]


@pytest.mark.parametrize("seeds", [range(6), pytest.param(range(6, 26), marks=pytest.mark.slow),
                                   pytest.param(range(26, 60), marks=LONG)], ids=str)
def test_tops_nutate_and_precess_as_followed_ones(seeds):
    for seed in seeds:
        rng = np.random.default_rng(seed)
        A, C, arm, wheel = rng.uniform(1, 3), rng.uniform(0.5, 2), 2 * rng.normal(), seed % 2 * rng.normal()
        gamma = rng.normal(size=3)
        start = [*rng.normal(size=3), *gamma / np.linalg.norm(gamma)]
        found = stabilab.attitude(top_of(A, C, wheel, arm), start)
        leans, azimuth = top_run(A, C, wheel, arm, start, found.nutation_period)
        assert found.mode == "heavy top"
        assert leans[-1] == pytest.approx(leans[0], abs=1e-9)
        assert found.lean[0] <= leans.min() + 1e-9 and found.lean[1] >= leans.max() - 1e-9
        assert found.lean == pytest.approx((leans.min(), leans.max()), abs=1e-6)  # of 20,000 samples
        assert found.precession_period == pytest.approx(2 * math.pi * found.nutation_period / abs(azimuth), rel=1e-9)


def test_special_tops():
    """Steady precession at W: A W^2 cos = C w3 W - P; a sleeping top; one on the separatrix of the sleeping
    top (kappa = a, eps = beta: Landau & Lifshitz, section 35); a plane pendulum's 4 K(sin^2(lean/2))."""
    A, C, arm, lean, rate = 2.0, 1.0, -3.0, 60, 0.5
    gamma = (math.sqrt(0.75), 0, 0.5)  # up - gamma, along the arm
    spin = (-arm + A * rate**2 * 0.5) / (C * rate)  # the rate about the upward vertical, cos 60 deg
    w = rate * np.array(gamma)
    steady = stabilab.attitude(top_of(A, C, 0, arm), [w[0], 0, spin, *gamma])
    assert steady.lean == pytest.approx([math.radians(lean)] * 2, abs=1e-7)
    assert steady.precession_period == pytest.approx(2 * math.pi / rate, rel=1e-7)
    asleep = stabilab.attitude(top_of(A, C, 0, arm), [0, 0, 9.0, 0, 0, 1.0])
    assert (asleep.mode, asleep.lean, asleep.precession_period) == ("steady", None, None)
    assert asleep.rotation_period == pytest.approx(2 * math.pi / 9)
    awake = stabilab.attitude(top_of(A, C, 0, arm), [0, 1.0, 1.0, 0, 0, 1.0])  # it passes through the vertical
    assert awake.lean[0] == 0 and awake.precession_period is None and "vertical" in awake.because
    # at gamma = (1, 0, 0): kappa = w1 = a = C w3/A, eps = w1^2 + w2^2 = beta = 2 |P|/A = 3
    between = stabilab.attitude(top_of(A, C, 0, arm), [1.0, 2**0.5, 2.0, 1.0, 0, 0])
    assert between.mode in ("separatrix", "heavy top")  # 2^(1/2) is rounded
    exact = stabilab.attitude(top_of(A, C, 0, -2.5), [1.5, 0.5, 3.0, 1.0, 0, 0])  # 2.25 + 0.25 = 2 2.5/2
    assert (exact.mode, exact.nutation_period) == ("separatrix", None)
    pendulum = stabilab.attitude(top_of(A, C, 0, -arm), [0, 0, 0, 0.6, 0, 0.8])
    assert pendulum.lean == pytest.approx((math.pi - math.asin(0.6), math.pi), rel=1e-12)
    m = math.sin(math.asin(0.6) / 2) ** 2  # of the swing to both sides; the lean takes one of them
    assert pendulum.nutation_period == pytest.approx(2 * ellipk(m) / math.sqrt(abs(arm) / A), rel=1e-14)


def test_periods_to_many_digits_are_those_of_jacobi_functions(stabilab):
    """Of Toutatis: 4 K(m)/lambda, and the mean over a period of the rate of precession, (omega.h - omega_3
    h_3)/(1 - h_3^2), of Jacobi's functions in mpmath, by the trapezoidal rule: no integral of the third kind."""
    with mp.workdps(50):
        D = [mp.mpf(v) for v in ("3.22", "3.09", "1")]
        w = [mp.mpf(v) * mp.pi / 180 for v in ("0.00042859", "0", "0.00113602")]
        T2, H2 = (mp.fsum(d**n * v**2 for d, v in zip(D, w)) for n in (1, 2))
        speed = mp.sqrt((D[1] - D[2]) * (H2 - T2 * D[0]) / (D[0] * D[1] * D[2]) * -1)
        m = (D[0] - D[1]) * (H2 - T2 * D[2]) / ((D[1] - D[2]) * (T2 * D[0] - H2))
        period, count = 4 * mp.ellipk(m) / speed, 60
        rates = []
        for n in range(count):
            u = 4 * mp.ellipk(m) * n / count
            squares = [w[0] ** 2 * mp.ellipfun("cn", u, m=m) ** 2, None, w[2] ** 2 * mp.ellipfun("dn", u, m=m) ** 2]
            squares[1] = (T2 - D[0] * squares[0] - D[2] * squares[2]) / D[1]
            across = D[0] ** 2 * squares[0] + D[1] ** 2 * squares[1]
            rates.append(mp.sqrt(H2) * (D[0] * squares[0] + D[1] * squares[1]) / across)
        precession = 2 * mp.pi * count / mp.fsum(rates)
        code, out, _ = stabilab("attitude", "cases/toutatis.toml", "--digits", "30", "--json")
        found = json.loads(out)["rows"][0]["decimals"]
        assert code == 0 and len(found["rotation_period"].replace(".", "")) == 31
        for name, value in (("rotation_period", period), ("precession_period", precession)):
            assert abs(mp.mpf(found[name]) / value - 1) < mp.mpf(10) ** -30


def test_digits_that_a_followed_motion_does_not_have_are_missed_by_exit_5(stabilab):
    code, out, err = stabilab("attitude", "cases/torque-free-gyrostat.toml", "--digits", "30")
    assert (code, out) == (5, "") and "11.0 reached" in err
    code, out, _ = stabilab("attitude", "cases/torque-free-gyrostat.toml", "--digits", "10")
    assert code == 0 and "relative error" in out
    code, out, err = stabilab("attitude", "cases/torque-free-body.toml", "--digits", "10001")
    assert code == 2 and "1 to 10000" in err
    with pytest.raises(ToleranceNotMet):
        attitude(scene_of((3, 2, 1), (0.1, 0, 0.2)), (0.3, 0.2, 0.1), digits=20)


@pytest.mark.parametrize("axis, sign", [(1, 1), (1, -1), (3, 1), (3, -1)])
@pytest.mark.parametrize("nutation", [1e-4, 1e-9, 1e-25, 1e-120])
def test_with_a_wheel_the_precession_of_a_small_nutation_is_that_of_the_linear_motion(nutation, axis, sign):
    """By hand, in the angles of Euler: about the axis phi' = w - psi', and from D_i w_i' = (H - D_j w) w_j and its
    like H goes round the axis in the body at phi', phi'^2 = (H - D_i w)(H - D_j w)/(D_i D_j); about the major
    axis psi' > w, about the minor one psi' < w (a free body's is H/D transverse)."""
    D, wheel, w, e = (3.0, 2.0, 1.0), sign * 0.5, sign * 1.0, axis - 1
    i, j = (n for n in range(3) if n != e)
    wheel = wheel if axis == 1 else 0.1 * wheel
    H = D[e] * w + wheel
    W = math.sqrt((H - D[i] * w) * (H - D[j] * w) / (D[i] * D[j]))
    omega, momentum = [0.0] * 3, [0.0] * 3
    omega[e], omega[i], momentum[e] = w, nutation, wheel
    found = attitude(stabilab.Scene(stabilab.Body(D), stabilab.Gyrostat(momentum)), omega)
    precession = abs(w) + (W if axis == 1 else -W)
    assert found.precession_period == pytest.approx(2 * math.pi / abs(precession), rel=10 * nutation**2 + 1e-10)
    assert found.rotation_period == pytest.approx(2 * math.pi / W, rel=10 * nutation**2 + 1e-10)


def test_under_a_torque_the_rotation_period_has_the_digits_of_the_reduced_potential():
    # 2 integral dtheta/W in mpmath (tests/oracles/energy.py), which shares nothing with the package
    D, wheel, torque, state = (3, 2, 1), (Fraction(1, 8), Fraction(-1, 4), 0), (0, 0, Fraction(1, 256)), (
        Fraction(1, 4), Fraction(1, 2), Fraction(1, 16))
    result = attitude(scene_of(D, wheel, torque), [str(v) for v in state], digits=30)
    exact = energy.period(physical(D, wheel, torque), state, digits=50, nodes=50)
    with mp.workdps(50):
        assert result.fate.word == "bounded"
        assert abs(mp.mpf(result.decimals["rotation_period"]) / exact - 1) < mp.mpf(10) ** -30
