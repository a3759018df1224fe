"""A wheel that a motor spins up: the conserved momentum, the body and the wheel as two rigid bodies in space,
steady rotations followed slowly, and what is said of all time."""
from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp

from stabilab import (
    Body,
    ConstantTorque,
    Gyrostat,
    InputError,
    RateDamper,
    Resistance,
    Scene,
    ViscousDamper,
    WheelMotor,
    derive,
    ensemble,
    equilibria,
    load,
    motion,
    simulate,
    time_to,
    trajectory,
)

D = (12, 9, 5)
START = (0.10, 0.05, 0.02)


def test_the_motor_keeps_the_momentum_and_takes_the_work_of_its_torque_from_the_body():
    """T' = -omega . u and (|D omega + lambda + h|^2)' = 0, identically."""
    equations = derive(Scene(Body(D), Gyrostat((1, 2, 3)), WheelMotor(("0.1", "0.2", "0.3"))))
    laws = {law.name: law for law in equations.balances}
    omega, h = equations.state[:3], equations.state[3:]
    d, lam, u = (sp.symbols(f"{name}1:4", real=True) for name in ("D", "lambda", "u"))
    d = [equations.symbols[f"D{i}"] for i in (1, 2, 3)]
    assert sp.expand(laws["energy"].rate + sum(a * b for a, b in zip(omega, u))) == 0
    assert sp.expand(laws["energy"].quantity - sum(a * w**2 for a, w in zip(d, omega)) / 2) == 0
    H = [a * w + l + m for a, w, l, m in zip(d, omega, lam, h)]
    assert laws["momentum"].rate == 0
    assert sp.expand(laws["momentum"].quantity - sum(v**2 for v in H) / 2) == 0
    assert equations.rhs[3:] == tuple(u)


def crossing(v):
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def two_bodies(platform, rotor, across, axis, motor, omega, speed, times):
    """Rates of the platform in its own frame, the turn to space and H of two rigid bodies on one axle. Newton
    and Euler for each in space, with the torque of the bearing across the axle unknown: six equations for
    omega', the rotor's relative acceleration and the bearing's two components. platform: its tensor; rotor:
    moments about its axis and `across` it; speed: of the rotor relative to the platform, rad/s."""
    e = np.linalg.svd(np.array([axis]))[2][1:]

    def rates(_, y):
        R, w, s = y[:9].reshape(3, 3), y[9:12], y[12]
        a, sides = R @ axis, (R @ e.T)
        P = R @ platform @ R.T
        N = across * np.eye(3) + (rotor - across) * np.outer(a, a)
        wr = w + s * a
        A = np.zeros((6, 6))
        A[:3, :3], A[:3, 4:] = P, sides
        A[3:, :3], A[3:, 3], A[3:, 4:] = N, N @ a, -sides
        b = np.concatenate([-motor * a - np.cross(w, P @ w),
                            motor * a - np.cross(wr, N @ wr) - N @ (s * np.cross(w, a))])
        x = np.linalg.solve(A, b)
        return np.concatenate([(crossing(w) @ R).ravel(), x[:3], x[3:4]])
    run = solve_ivp(rates, (0, times[-1]), np.concatenate([np.eye(3).ravel(), omega, [speed]]), "DOP853", times,
                    rtol=1e-12, atol=1e-14)
    out = []
    for y in run.y.T:
        R, w, s = y[:9].reshape(3, 3), y[9:12], y[12]
        a = R @ axis
        H = R @ platform @ R.T @ w + (across * np.eye(3) + (rotor - across) * np.outer(a, a)) @ (w + s * a)
        out.append((R.T @ w, R, H))
    return [np.array(column) for column in zip(*out)]


@pytest.mark.parametrize("axis", [(1, 0, 0), (0, 0, -1), (2 / 3, -1 / 3, 2 / 3)])
def test_rates_and_attitude_are_those_of_two_rigid_bodies_on_one_axle(axis):
    axis, rotor, across, torque, speed = np.array(axis, float), 0.3, 0.2, 0.05, 2.0
    omega, times = np.array(START), np.array([0.0, 7.0, 20.0, 45.0])
    platform = np.diag(D) - across * (np.eye(3) - np.outer(axis, axis))
    w, R, H = two_bodies(platform, rotor, across, axis, torque, omega, speed, times)
    first = rotor * (speed + omega @ axis) * axis
    scene = Scene(Body(D), Gyrostat(first.tolist()), WheelMotor((torque * axis).tolist()))
    run = simulate(scene, START, times, {"attitude": (0, 0, 0, 1)}, attitude="matrix")
    assert run.state["omega"] == pytest.approx(w, abs=2e-11)
    assert run.state["matrix"] == pytest.approx(R, abs=2e-10)
    assert run.state["momentum"] == pytest.approx(H, abs=2e-10)
    assert run.state["wheel"] == pytest.approx(np.outer(times, torque * axis), abs=1e-14)


def test_a_spin_about_the_wheel_s_axis_is_braked_in_proportion_to_time():
    """By hand: omega_2 = omega_2(0) - u t/D2, and h = u t."""
    run = trajectory(Scene(Body(D), WheelMotor((0, "0.2", 0))), {"omega": (0, 0.5, 0)}, [0, 10, 22.5])
    assert run.states[:, 1] == pytest.approx([0.5, 0.5 - 2 / 9, 0.0], abs=1e-15)
    assert run.block("wheel")[:, 1] == pytest.approx([0, 2, 4.5], rel=1e-15)


@pytest.mark.parametrize("i", [0, 1])
def test_a_slow_motor_carries_a_spin_along_its_steady_rotations_into_the_wheel(i):
    """From the spin about the major axis 3 with H = D3 omega, D omega + h a = s omega holds with
    s = D3, omega_i = h/(D3 - Di), until h = H (D3 - Di)/D3; beyond it the wheel's axis carries all of H, and the
    body is at rest when h = H but for what is left of the passage, less the slower the motor is."""
    moments, spin, left = (520, 310, 610), 0.1, []
    H = moments[2] * spin
    for torque in (0.0005, 0.008):
        u = [torque * (n == i) for n in range(3)]
        half = H * (moments[2] - moments[i]) / moments[2] / 2
        run = trajectory(Scene(Body(moments), WheelMotor(u)), {"omega": (0, 0, spin)}, [half / torque, H / torque])
        steady = half / (moments[2] - moments[i])
        assert run.states[0, i] == pytest.approx(steady, rel=0.03)
        assert run.states[0, 2] == pytest.approx(np.sqrt(H**2 - (moments[2] * steady) ** 2) / moments[2], rel=0.01)
        left.append(np.linalg.norm(run.states[1, :3]) / spin)
    assert left[0] < 0.04 and left[0] < left[1] / 3


def test_a_motor_that_stops_leaves_a_gyrostat():
    """The second part of the run is that of a scene of its own, started from the first one's end."""
    stopping = Scene(Body(D), Gyrostat((0, 0, "0.5")), WheelMotor(("0.02", "0.01", 0), "40 s"))
    endless = Scene(Body(D), Gyrostat((0, 0, "0.5")), WheelMotor(("0.02", "0.01", 0)))
    times = [-5.0, 0.0, 30.0, 40.0, 50.0, 200.0]
    run = simulate(stopping, START, times)
    first = simulate(endless, START, times[:4])
    after = Scene(Body(D), Gyrostat(("0.8", "0.4", "0.5")))
    later = simulate(after, first.state["omega"][-1], [0, 10, 160])
    assert run.state["omega"][:4] == pytest.approx(first.state["omega"], rel=1e-12, abs=1e-15)
    assert run.state["omega"][3:] == pytest.approx(later.state["omega"], rel=1e-12, abs=1e-14)
    assert run.state["wheel"][-1] == pytest.approx([0.8, 0.4, 0], abs=1e-15)
    assert simulate(stopping, START, times[::-1]).state["omega"] == pytest.approx(
        run.state["omega"][::-1], rel=1e-14, abs=1e-15)
    quaternion = simulate(stopping, START, times[1:], attitude="quaternion")
    assert quaternion.state["momentum"] == pytest.approx(np.tile([1.2, 0.45, 0.6], (5, 1)), abs=1e-13)


def test_extremes_and_times_count_both_parts_of_a_motion():
    scene = Scene(Body(D), WheelMotor(("0.05", 0, 0), "8 s"))
    run = simulate(scene, START, np.linspace(0, 60, 6001))
    found = motion(scene, START, span=60)
    dense = run.state["omega"]
    assert found.fate.word == "bounded"
    assert np.array(found.extremes) == pytest.approx(
        np.stack([dense.min(axis=0), dense.max(axis=0)], axis=1), abs=2e-6)  # the samples' distance squared
    limit = 0.9 * np.abs(dense[:, 2]).max()
    first = run.t[np.argmax(np.abs(dense[:, 2]) > limit)]
    assert first > 8
    low, high = time_to(scene, {"omega": START}, component=(3, float(limit)))
    assert first - 0.01 <= low <= high <= first and high - low < 1e-9


def test_without_an_end_the_rates_grow_as_the_bound_says():
    """|D omega| >= |u| t - |H| - |lambda| for any motion, as |D omega + lambda + h| is constant."""
    scene = Scene(Body(D), Gyrostat((0, 0, 1)), WheelMotor(("0.3", "-0.1", "0.2")))
    found = motion(scene, START)
    assert found.fate.word == "spin-up" and found.axis == 0
    H = np.linalg.norm(np.array(D) * START + [0, 0, 1])
    assert found.invariants["momentum"] == pytest.approx(H, rel=1e-15)
    t = np.linspace(0, 1000, 21)
    carried = np.linalg.norm(np.array(D) * simulate(scene, START, t).state["omega"], axis=1)
    assert (carried >= np.sqrt(0.14) * t - H - 1 - 1e-9).all() and carried[-1] > 300
    axial = motion(Scene(Body(D), WheelMotor((0, 0, "-0.1"))), START)
    assert (axial.axis, axial.sense) == (3, 1)


def test_with_an_end_the_rates_stay_below_a_bound():
    scene = Scene(Body(D), WheelMotor(("0.3", "-0.1", "0.2"), 10))
    found = motion(scene, START)
    run = simulate(scene, START, np.linspace(0, 2000, 4001))
    assert found.fate.word == "bounded"
    assert np.linalg.norm(run.state["omega"], axis=1).max() <= found.invariants["rate_bound"]


def test_of_two_bounds_the_closer_one_is_given():
    """By hand, about one axis: a motor that brakes the wheel gives the body all of its work, D omega = D omega(0)
    + |u| t, which the energy bounds closely beside a great momentum, and at rest the momentum does."""
    short = motion(Scene(Body(D), Gyrostat((0, 0, 50)), WheelMotor((0, 0, "-0.1"), 5)), (0, 0, 0.2))
    assert short.invariants["rate_bound"] == pytest.approx(0.2 + 0.1 * 5 / 5, rel=1e-14)
    spun = motion(Scene(Body(D), WheelMotor((0, 0, "0.1"), 5)), (0, 0, 0.1))
    assert spun.invariants["rate_bound"] == pytest.approx((5 * 0.1 + 0.1 * 5) / 5, rel=1e-14)


@pytest.mark.parametrize("damping", [Resistance("0.1"), RateDamper("0.5")])
@pytest.mark.parametrize("end", [None, 20])
def test_beside_resistance_the_rates_stay_below_the_bound_of_their_energy(damping, end):
    scene = Scene(Body(D), damping, ConstantTorque(("0.05", 0, 0)), WheelMotor((0, "0.2", "0.1"), end))
    found = motion(scene, START)
    sizes = np.linalg.norm(simulate(scene, START, np.linspace(0, 400, 801)).state["omega"], axis=1)
    assert found.fate.word == "bounded" and sizes.max() <= found.invariants["rate_bound"]
    assert sizes[-1] <= found.invariants["late_rate_bound"] * (1 + 1e-9)


def test_steady_rotation_needs_an_outer_torque_of_the_motor_s_size():
    """u . M = |u|^2 is needed; with M = u the body can rest while the wheel takes what comes from outside."""
    body, motor = Body(D), WheelMotor(("0.1", "0.2", 0))
    assert equilibria(Scene(body, motor)).kind == "none"
    assert equilibria(Scene(body, motor, ConstantTorque((0, "0.2", 0)))).kind == "none"
    fed = Scene(body, motor, ConstantTorque(("0.1", "0.2", 0)))
    assert equilibria(fed).kind == "undecided"
    assert simulate(fed, (0, 0, 0), [100]).state["omega"] == pytest.approx(np.zeros((1, 3)), abs=1e-15)
    for other in (ViscousDamper("0.1", "0.3"), RateDamper("0.5")):
        assert equilibria(Scene(body, motor, other)).kind == "undecided"


def test_equilibria_with_an_end_are_those_of_the_gyrostat_that_is_left():
    found = equilibria(Scene(Body(D), Gyrostat((0, 0, 1)), WheelMotor(("0.1", 0, 0), 5)))
    plain = equilibria(Scene(Body(D), Gyrostat(("0.5", 0, 1))))
    assert [p.at for c in found.curves for p in c.samples] == [p.at for c in plain.curves for p in c.samples]
    assert "once the motor has stopped" in found.because


@pytest.mark.parametrize("beside", [ViscousDamper("0.1", "0.3"), ConstantTorque((0, 0, 3)), RateDamper((0, "0.5", 1))])
@pytest.mark.parametrize("end", [None, 20])
def test_beside_what_no_proof_covers_nothing_is_claimed(beside, end):
    found = motion(Scene(Body(D), beside, WheelMotor(("0.3", 0, 0), end)), START)
    assert found.fate.word == "undecided" and found.level == "undecided"


FILE = """[body]
inertia = [[12, 0.3, 0], [0.3, 9, -0.2], [0, -0.2, 5]]
[effects.wheel_motor]
torque = ["20 mN m", 0, "0.01 N m"]
duration = "1 min"
[motion]
angular_velocity = [0.1, 0.05, 0.02]
wheel = ["1 N m s", 0, "0.5 N m s"]
span = [0, 100]
"""


def test_vectors_of_a_tensor_in_another_frame_are_turned_together():
    case = load(FILE)
    turned = np.array([case.frame.turned(tuple(map(Fraction, row))) for row in np.eye(3).astype(int).tolist()]).astype(float)
    motor = case.scene.effect("wheel_motor")
    assert np.array(motor.motor) @ turned.T == pytest.approx([0.02, 0, 0.01], abs=1e-15)
    assert np.array(case.blocks["wheel"]) @ turned.T == pytest.approx([1, 0, 0.5], abs=1e-15)
    run = case.simulate([0, 5, 100], attitude="quaternion")
    assert run.state["momentum"] == pytest.approx(run.state["momentum"][[0] * 3], abs=1e-13)
    # it runs for a minute from the start, in the frame of the file
    assert run.state["wheel"][-1] @ turned.T == pytest.approx([1 + 60 * 0.02, 0, 0.5 + 60 * 0.01], abs=1e-13)


@pytest.mark.parametrize("line, words", [
    ("torque = [0.1, 0]", "expected three numbers, got 2"),
    ("duration = 3", "torque is missing: give torque = [u1, u2, u3] on the wheel, in N m"),
    ("torque = [0.1, 0, 0]\nduration = 0", "effects.wheel_motor.duration: expected a positive number, got 0"),
    ("torque = [0.1, 0, 0]\nduration = \"3 m\"", "effects.wheel_motor.duration"),
    ("torque = [\"0.1 N\", 0, 0]", "effects.wheel_motor.torque"),
    ("torque = [0.1, 0, 0]\nspeed = 3", "speed")])
def test_bad_tables_are_told_with_their_line(line, words):
    text = f"[body]\ninertia = [3, 2, 1.5]\n[effects.wheel_motor]\n{line}\n[motion]\nangular_velocity = [1, 0, 0]\n"
    with pytest.raises(InputError) as told:
        load(text)
    assert words in str(told.value) and str(told.value).startswith("text:")


def test_a_wheel_s_momentum_without_a_motor_is_told_where_it_belongs():
    text = "[body]\ninertia = [3, 2, 1.5]\n[motion]\nangular_velocity = [1, 0, 0]\nwheel = [1, 0, 0]\n"
    with pytest.raises(InputError, match=r"text:5: motion.wheel: .*\[effects.gyrostat\]"):
        load(text)


def test_constructor_faults_and_what_is_written():
    with pytest.raises(InputError, match="duration: expected a positive number, got -1"):
        WheelMotor((0, 0, 1), -1)
    case = load(Scene(Body(D), WheelMotor(("1/3", 0, 0), "2 min")), {"omega": START, "wheel": (3, 0, 0)}, 10)
    assert load(case.text).scene == case.scene and load(case.text).blocks["wheel"] == (3, 0, 0)
    assert case.scene.effect("wheel_motor").duration == 120


def attitude_in_space(moments, torque, duration, omega, times):
    """Rates and the matrix to space by SciPy, from the momentum in space alone: D omega + h = R^T H."""
    H, D, u = moments * omega, moments, torque

    def rates(t, y):
        R = y.reshape(3, 3)
        w = (R.T @ H - u * min(t, duration)) / D
        return (R @ crossing(w)).ravel()
    first, last = times[times < duration], times[times >= duration]
    run = solve_ivp(rates, (0, duration), np.eye(3).ravel(), "DOP853", [*first, duration], rtol=1e-12, atol=1e-13)
    after = solve_ivp(rates, (duration, times[-1]), run.y[:, -1], "DOP853", last, rtol=1e-12, atol=1e-13)
    return np.concatenate([run.y.T[:-1], after.y.T]).reshape(-1, 3, 3)


@pytest.mark.parametrize("axis, angle, past", [(1, 0.1, False), (1, 0.4, True), (3, 1.5, True)])
def test_a_tilt_counts_from_the_start_over_the_end_of_a_motor(axis, angle, past):
    moments, torque, omega = np.array(D, float), np.array([0.05, 0.02, 0]), np.array(START)
    times = np.linspace(0, 100, 20001)
    R = attitude_in_space(moments, torque, 8.0, omega, times)
    first = times[np.argmax(np.arccos(R[:, axis - 1, axis - 1]) >= angle)]
    scene = Scene(Body(D), WheelMotor(("0.05", "0.02", 0), 8))
    low, high = time_to(scene, {"omega": START}, tilt=(axis, angle), t_max=100)
    assert first - 0.005 <= low <= high <= first + 1e-9 and high - low < 1e-9
    assert (first > 8) == past


def test_an_end_is_no_limit_of_a_law():
    """The run goes on past it, so nothing in an answer hangs on it."""
    assert Scene(Body(D), WheelMotor((0, "0.2", 0), 5)).approximate == ()
    assert motion(Scene(Body(D), WheelMotor((0, "0.2", 0), 5)), START, span=20).validity is None


TURNING = """[body]
inertia = [118, 96, 152]
[effects.wheel_motor]
torque = [0, 1, 0]
duration = "10 s"
[motion]
angular_velocity = [0, 0, 0.3]
wheel = [0, {}, 0]
span = [0, 60]
"""


def turned_by(h, times):
    """Rates by SciPy over the end of a motor of 1 N m about y, which runs for 10 s from h on; with h = None the
    wheel starts with nothing."""
    D, u = np.array([118.0, 96.0, 152.0]), np.array([0, 1.0, 0])

    def rates(on):
        return lambda t, w: (np.cross(D * w + [0, h + min(t, 10.0), 0], w) - on * u) / D
    first, last = times[times <= 10], times[times > 10]
    run = solve_ivp(rates(1), (0, 10), (0, 0, 0.3), "DOP853", np.unique([*first, 10.0]), rtol=1e-12, atol=1e-14)
    after = solve_ivp(rates(0), (10, times[-1]), run.y[:, -1], "DOP853", last, rtol=1e-12, atol=1e-14)
    return np.concatenate([run.y.T[:first.size], after.y.T])


@pytest.mark.parametrize("h", [-20, 5, 40])
def test_a_motor_runs_for_its_duration_from_the_start_whatever_its_wheel_has(h):
    case, times = load(TURNING.format(h)), np.linspace(0, 60, 6001)
    rates = turned_by(h, times)
    start = {"omega": (0, 0, 0.3), "wheel": (0, h, 0)}
    for run in (case.simulate(times[::100]), simulate(case.scene, (0, 0, 0.3), times[::100], {"wheel": (0, h, 0)})):
        assert run.state["omega"] == pytest.approx(rates[::100], abs=1e-9)
        assert run.state["wheel"][-1] == pytest.approx([0, h + 10, 0], abs=1e-12)
    for found in (case.motion(), motion(case.scene, start, (0, 60))):
        assert np.array(found.extremes) == pytest.approx(np.stack([rates.min(axis=0), rates.max(axis=0)], axis=1), abs=2e-6)
        assert np.linalg.norm(rates, axis=1).max() <= found.invariants["rate_bound"] and "after 10 s" in found.because
    many = ensemble(case.scene, [[0, 0, 0.3, 0, h, 0]] * 2, times[::100])
    assert many.states[1, :, :3] == pytest.approx(rates[::100], abs=1e-9)
    most = 0.9 * np.abs(rates[:, 0]).max()
    at = times[np.argmax(np.abs(rates[:, 0]) > most)]
    low, high = case.when(component=f"x = {most} rad/s")
    assert at - 0.01 <= low <= high <= at + 1e-9
    zeros = case.when(events="omega1").t[0]
    signs = times[1:-1][np.diff(np.sign(rates[1:, 0])) != 0]
    assert len(zeros) == len(signs) and zeros == pytest.approx(signs, abs=0.011)


def test_equilibria_of_a_case_are_those_of_the_wheel_as_the_motor_leaves_it():
    found = load(TURNING.format(-20)).equilibria()
    plain = equilibria(Scene(Body((118, 96, 152)), Gyrostat((0, -10, 0))))
    assert [p.at for c in found.curves for p in c.samples] == [p.at for c in plain.curves for p in c.samples]
    assert "from the momentum of its wheel in [motion] on" in found.because


def test_a_wheel_across_the_line_of_its_motor_is_refused_with_what_to_do():
    text = TURNING.replace("[0, {}, 0]", "[1, -20, 0]")
    with pytest.raises(InputError, match=r"text:8: motion.wheel: .* does not: give here the part along "
                                         r"effects.wheel_motor.torque, and to effects.gyrostat.momentum"):
        load(text)
    scene = load(TURNING.format(0)).scene
    for state in ({"omega": (0, 0, 0.3), "wheel": (1, -20, 0)}, [0, 0, 0.3, 1, -20, 0]):
        for ask in (lambda: motion(scene, state), lambda: trajectory(scene, state, [1.0]),
                    lambda: time_to(scene, state, rate=1)):
            with pytest.raises(InputError, match="lies along the motor's line"):
                ask()
    with pytest.raises(InputError, match="lies along the motor's line"):
        load(scene, {"omega": (0, 0, 0.3), "wheel": (1, -20, 0)})
    with pytest.raises(InputError, match="lies along the motor's line"):
        ensemble(scene, [[0, 0, 0.3, 0, 1, 0], [0, 0, 0.3, 1, -20, 0]], [1.0])


def test_beside_resistance_alone_the_motion_tends_to_rest():
    found = motion(Scene(Body(D), Resistance("0.1"), WheelMotor((0, "0.2", 0), 20)), START)
    assert found.because.endswith("it tends to rest") and found.invariants["late_rate_bound"] == 0
