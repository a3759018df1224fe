"""A wheel, or a ring, on a viscous bearing: against its own run with all degrees of freedom, from the balance
of momentum in space and of the wheel about its axis, which shares no equation with the package."""
from fractions import Fraction
from math import sqrt

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stabilab
from stabilab import Body, DamperWheel, Gyrostat, InputError, Scene, flat_spin, load, trajectory
from stabilab.unreduced.bounds import SOME_GO_ON

D = np.array([2.0, 1.5, 1.2])
J, C = 0.15, 0.08


def turning(v):
    x, y, z = v
    return np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])


def in_space(D, J, c, axis, wheel, omega, s, times, k=0.0, phi=0.0):
    """(rates, relative rate of the wheel, energy of body, wheel and spring) by DOP853: H stays in space, R' = R
    [omega x], and the wheel's own spin p = J (s + a . omega) about its axis changes by the torque of bearing and
    spring, p' = -c s - k phi, phi' = s. In the body R^T H = (D - J a a^T) omega + p a + wheel gives omega."""
    a = np.array(axis, float) / np.linalg.norm(axis)
    rest = np.diag(D) - J * np.outer(a, a)
    p0 = J * (s + a @ omega)
    H = rest @ omega + p0 * a + wheel

    def rates(y):
        R, p = y[:9].reshape(3, 3), y[9]
        omega = np.linalg.solve(rest, R.T @ H - p * a - wheel)
        return R, p, omega, p / J - a @ omega

    def rate(t, y):
        R, p, omega, s = rates(y)
        return [*(R @ turning(omega)).ravel(), -c * s - k * y[10], s]
    run = solve_ivp(rate, (0, times[-1]), [*np.eye(3).ravel(), p0, phi], "DOP853", times, rtol=1e-12, atol=1e-13)
    seen = [rates(y) for y in run.y.T]
    omega, s = np.array([item[2] for item in seen]), np.array([item[3] for item in seen])
    energy = ((omega @ rest) * omega).sum(axis=1) / 2 + J * (s + omega @ a) ** 2 / 2 + k * run.y[10] ** 2 / 2
    return omega, s, energy


@pytest.mark.one_in(2)
@pytest.mark.parametrize("axis", [(0, 0, 1), (1, 2, -2), (3, 0, 1)])
@pytest.mark.parametrize("wheel", [(0, 0, 0), (0.4, -0.1, 0.3)])
def test_runs_as_wheel_and_body_in_space_do(axis, wheel):
    scene = Scene(Body(D.tolist()), DamperWheel(J, C, axis), *([Gyrostat(wheel)] if any(wheel) else []))
    omega, times = np.array([0.3, -0.8, 1.1]), np.array([0.0, 3, 11, 40])
    expected = in_space(D, J, C, axis, np.array(wheel), omega, 0.25, times)
    run = trajectory(scene, {"omega": omega, "damper_wheel": [0.25]}, times)
    assert run.states[:, :3] == pytest.approx(expected[0], abs=1e-9)
    assert run.states[:, 3] == pytest.approx(expected[1], abs=1e-9)
    laws = stabilab.physics.to_numpy.to_numpy(scene).invariants(run.states)
    assert laws["energy"] == pytest.approx(expected[2], rel=1e-10) and (np.diff(laws["energy"]) < 0).all()
    assert laws["momentum"] == pytest.approx(np.full(4, laws["momentum"][0]), rel=1e-11)


@pytest.mark.parametrize(("axis", "wheel", "k"), [
    ((1, 2, -2), (0.4, -0.1, 0.3), 0.05),
    pytest.param((0, 0, 1), (0, 0, 0), 2.0, marks=pytest.mark.slow),
    pytest.param((3, 0, 1), (0, 0, 0), 0.1, marks=pytest.mark.slow)])
def test_on_a_spring_it_runs_as_wheel_and_body_in_space_do(axis, wheel, k):
    scene = Scene(Body(D.tolist()), DamperWheel(J, C, axis, k), *([Gyrostat(wheel)] if any(wheel) else []))
    omega, times = np.array([0.3, -0.8, 1.1]), np.array([0.0, 3, 11, 40])
    expected = in_space(D, J, C, axis, np.array(wheel), omega, 0.25, times, k, 0.4)
    run = trajectory(scene, {"omega": omega, "sprung_wheel": [0.4, 0.25]}, times)
    assert run.states[:, :3] == pytest.approx(expected[0], abs=1e-9)
    assert run.states[:, 4] == pytest.approx(expected[1], abs=1e-9)
    laws = stabilab.physics.to_numpy.to_numpy(scene).invariants(run.states)
    assert laws["energy"] == pytest.approx(expected[2], rel=1e-10) and (np.diff(laws["energy"]) < 0).all()
    assert laws["momentum"] == pytest.approx(np.full(4, laws["momentum"][0]), rel=1e-11)


def test_a_spring_tuned_to_the_nutation_damps_it_faster_as_the_run_in_space_does():
    """At spin 1 about axis 1 of (2, 1.5, 1.2) the nutation has ((2 - 1.5)(2 - 1.2)/(1.5 1.2))^(1/2) = 0.471 rad/s; a
    wheel across it of so many rad/s on its spring, (k/J)^(1/2). The fit is that of the run in space."""
    times, tuned = np.linspace(0, 70, 351), 0.15 * 0.4714**2
    decays = {}
    for k in (0.0, tuned):
        scene = Scene(Body(D.tolist()), DamperWheel(J, C, (0, 0, 1), k))
        decays[k] = flat_spin(load(scene, (1, 0.01, 0.01))).decay
        omega, s, energy = in_space(D, J, C, (0, 0, 1), np.zeros(3), np.array([1, 1e-2, 1e-2]), 0.0, times, k)
        H = D * [1, 1e-2, 1e-2]
        above, late = energy - H @ H / (2 * D[0]), times > 20
        fitted = -2 / np.polyfit(times[late], np.log(above[late]), 1)[0]
        assert decays[k] == pytest.approx(fitted, rel=2e-2)
    assert decays[tuned] < decays[0.0]


def test_with_a_spring_the_permanent_rotations_and_their_stability_are_those_without():
    found = stabilab.equilibria(Scene(Body((3, 2, 1)), DamperWheel("0.1", "0.3", (1, 1, 1), "0.2")))
    words = {tuple(map(bool, point.at[:3])): point.verdict for curve in found.curves for point in curve.samples}
    assert words[True, False, False] == "stable"  # the greatest moment: least energy at its |H|
    assert words[False, True, False] == words[False, False, True] == "unstable"
    plain = Scene(Body((3, 2, 1)), DamperWheel("0.1", "0.3", (1, 1, 1), 0))
    assert plain.blocks == ("omega", "damper_wheel") and DamperWheel(1, 1, (0, 0, 1)) == DamperWheel(1, 1, (0, 0, 1), 0)


def test_a_file_states_spring_angle_and_rate_and_faults_say_what_to_do():
    text = ("[body]\ninertia = [3, 2, 1.5]\n[effects.damper_wheel]\ninertia = 0.1\ncoefficient = 0.2\naxis = [0, 0, 1]\n"
            "stiffness = \"50 N mm\"\n[motion]\nangular_velocity = [0.1, 0.2, 1]\nsprung_wheel = [0.3, 0.5]\nspan = [0, 10]\n")
    case = load(text)
    assert case.start == (0.1, 0.2, 1.0, 0.3, 0.5) and case.scene.effect("damper_wheel").spring == Fraction(1, 20)
    again = load(stabilab.case.write.data_of_scene(case.scene, {"omega": case.state, **case.blocks}))
    assert again.start == case.start and again.scene == case.scene
    for old, new, words in (("sprung_wheel = [0.3, 0.5]", "damper_wheel = [0.5]", "the damper wheel is on a spring"),
                            ('stiffness = "50 N mm"\n', "", "give .effects.damper_wheel. a stiffness"),
                            ('"50 N mm"', '"-50 N mm"', "not negative"), ('"50 N mm"', '"50 N"', "torque")):
        with pytest.raises(InputError, match=words):
            load(text.replace(old, new))


@pytest.mark.first(2, 12)
@pytest.mark.parametrize("seed", range(60))
def test_a_heavy_wheel_brings_a_tumbler_to_the_end_that_its_run_in_space_shows(seed):
    """The rates at the end by the run in space."""
    rng = np.random.default_rng(seed)
    omega, axis = rng.normal(size=3) * [0.4, 0.4, 1.5], rng.normal(size=3)
    wheel = rng.normal(size=3) * 0.3 if seed % 2 else np.zeros(3)
    scene = Scene(Body(D.tolist()), DamperWheel("0.6", "0.3", axis.tolist()), Gyrostat(wheel.tolist()))
    found = stabilab.motion(load(scene, omega.tolist())).ending
    assert found.level in ("exact", "run")
    late = (found.until or 0) + 6 * found.decay  # once settled a departure falls to exp(-6) of a few degrees
    end = in_space(D, 0.6, 0.3, axis, wheel, omega, 0.0, np.array([0, late]))[0][-1]
    assert end == pytest.approx(found.rates, abs=5e-3 * np.linalg.norm(end))


def test_time_constants_are_those_of_a_departure_of_the_run_in_space():
    """Near rotation about axis 1 the energy above the least falls as exp(-2 t/tau): a fit of the run in space."""
    scene = Scene(Body(D.tolist()), DamperWheel(J, C, (0, 0, 1)))
    end = flat_spin(load(scene, (1, 0.01, 0.01)))
    times = np.linspace(0, 120, 61)
    omega, s, energy = in_space(D, J, C, (0, 0, 1), np.zeros(3), np.array([1, 1e-3, 1e-3]), 0.0, times)
    H = D * [1, 1e-3, 1e-3]
    above = energy - H @ H / (2 * D[0])
    late = times > 40
    fitted = -2 / np.polyfit(times[late], np.log(above[late]), 1)[0]
    assert end.decay == pytest.approx(fitted, rel=2e-2)


def test_classify_tells_rotations_and_time_constants():
    found = stabilab.equilibria(Scene(Body((3, 2, 1)), DamperWheel("0.1", "0.3", (1, 1, 1))))
    words = {tuple(map(bool, point.at[:3])): point.verdict for curve in found.curves for point in curve.samples}
    assert words[True, False, False] == "stable"  # the greatest moment: least energy at its |H|
    assert words[False, True, False] == words[False, False, True] == "unstable"


def test_a_wheel_about_the_axis_of_a_symmetric_body_takes_nothing():
    """omega3 stays, so the wheel never turns (by hand): the nutation goes on, and no end is named."""
    scene = Scene(Body((2, 2, 1)), DamperWheel("0.1", "0.3", (0, 0, 5)))
    case = load(scene, (0.3, 0, 1))
    assert stabilab.motion(case).reason.says(SOME_GO_ON.sentence)
    assert stabilab.equilibria(scene).kind == "undecided"
    with pytest.raises(InputError, match="give the wheel another axis"):
        flat_spin(case)
    energy = in_space(np.array([2, 2, 1.0]), 0.1, 0.3, (0, 0, 1), np.zeros(3), np.array([0.3, 0, 1]), 0.0, np.array([0, 50.0]))[2]
    assert energy[1] == pytest.approx(energy[0], rel=1e-11)
    across = flat_spin(load(Scene(Body((2, 2, 1)), DamperWheel("0.1", "0.3", (1, 0, 0))), (0.01, 0, 1)))
    assert across.outcome == "across the minor axis"


def test_motions_that_leave_the_wheel_at_rest_are_circles_on_the_sphere_of_momentum():
    """D^-1 = diag(1, 2, 6), so n = (1, 0, 2): n1^2 (6 - 2) = n3^2 (2 - 1). With D^-1 lambda = p m/2 + q n, m = (-1, 0, 2)
    (D^-1 - 2 = sym(n m^T)), the rate of a . omega along the gyrostat vanishes on the circle n . H = p: by numbers."""
    inverse, n, m = np.array([1.0, 2, 6]), np.array([1.0, 0, 2]), np.array([-1.0, 0, 2])
    body, p, q = [1, Fraction(1, 2), Fraction(1, 6)], 0.7, 0.4
    wheel = (p * m / 2 + q * n) / inverse
    damper = DamperWheel("0.01", 1, [Fraction(1), 0, Fraction(1, 3)])  # a = D n
    exact = [Fraction(v).limit_denominator(10**6) for v in wheel]
    assert damper.never_turns(tuple(map(Fraction, body)), tuple(exact))
    assert damper.never_turns(tuple(map(Fraction, body)), (Fraction(0),) * 3)
    assert not damper.never_turns(tuple(map(Fraction, body)), (Fraction(0), Fraction(1), Fraction(0)))
    assert not DamperWheel("0.01", 1, [1, 0, 1]).never_turns(tuple(map(Fraction, body)), tuple(exact))
    e = np.array([2, 0, -1.0]) / sqrt(5)
    for angle in np.linspace(0, 6, 7):
        H = p * n / 5 + 2 * (np.cos(angle) * e + np.sin(angle) * np.array([0, 1.0, 0]))
        omega = inverse * (H - wheel)
        assert (n / inverse) @ (inverse * np.cross(H, omega)) == pytest.approx(0, abs=1e-12)


def test_absent_is_free_and_faults_say_what_to_do(tmp_path):
    with pytest.raises(InputError, match="smaller than 2"):
        Scene(Body((3, 2, 1)), DamperWheel(2, 1, (0, 1, 0)))
    with pytest.raises(InputError, match="expected a direction"):
        DamperWheel(1, 1, (0, 0, 0))
    text = ("[body]\ninertia = [3, 2, 1.5]\n[effects.damper_wheel]\ninertia = 0.1\ncoefficient = 0.2\naxis = [0, 0, 1]\n"
            "[motion]\nangular_velocity = [0.1, 0.2, 1]\ndamper_wheel = [0.5]\nspan = [0, 10]\n")
    case = load(text)
    assert case.start == (0.1, 0.2, 1.0, 0.5)
    assert load(stabilab.case.write.data_of_scene(case.scene, {"omega": case.state, **case.blocks})).start == case.start
    assert load(text.replace("[0.5]", "0.5")).start == load(text.replace("[0.5]", '"500 mrad/s"')).start == case.start
    with pytest.raises(InputError, match="expected one number, got 2"):
        load(text.replace("[0.5]", "[0.5, 1]"))
    with pytest.raises(InputError, match="no damper wheel is in this body"):
        load(text.replace("[effects.damper_wheel]\ninertia = 0.1\ncoefficient = 0.2\naxis = [0, 0, 1]\n", ""))


@pytest.mark.parametrize("moments, share", [("[3, 2, 1.5]", 1.5), ("[[2, 0, 1], [0, 2, 0], [1, 0, 2]]", 1.5)])
def test_a_wheel_that_the_body_cannot_hold_is_one_fault_of_its_line(moments, share):
    """By hand: about e3 the limit is 1/(e3 . D^-1 e3); of the second tensor D^-1 has 2/3 there."""
    text = (f"[body]\ninertia = {moments}\n[effects.damper_wheel]\ncoefficient = 1\naxis = [0, 0, 1]\n"
            "inertia = {}\n[motion]\nangular_velocity = [0.1, 0.02, 1]\n")
    load(text.format(share - 0.01))
    with pytest.raises(InputError, match=f"must be smaller than {share}, ") as error:
        load(text.format(share + 0.01))
    (problem,) = error.value.problems
    assert (problem.line, problem.key) == (6, "effects.damper_wheel.inertia")


def test_a_wheel_across_two_equal_moments_gives_the_phase_to_no_end():
    """DOP853: a start turned by a right angle about the minor axis does not end at an axis turned by one."""
    ends = []
    for start in ((0.01, 0, 1), (0, 0.01, 1)):
        omega, *_ = in_space(np.array([2.0, 2, 1]), 0.1, 0.1, (1, 0, 0), np.zeros(3), np.array(start, float), 0.0, [4000])
        ends.append(np.arctan2(omega[-1, 1], omega[-1, 0]))
    assert abs(np.sin(ends[1] - ends[0])) < 0.995  # 1 if the end turned with the start
    text = ("[body]\ninertia = [2, 2, 1]\n[effects.{}]\ninertia = 0.1\ncoefficient = 0.1\n{}"
            "[motion]\nangular_velocity = [0.01, 0, 1]\n")
    assert flat_spin(load(text.format("damper_wheel", "axis = [1, 0, 0]\n"))).reason.code == "ends-by-start"
    assert flat_spin(load(text.format("viscous_damper", ""))).reason.code == "ends-by-phase"
