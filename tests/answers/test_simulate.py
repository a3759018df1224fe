"""Exact motions with more blocks of state than the angular velocity, against equations typed in by hand in
mpmath."""
import math
import re
from pathlib import Path

import mpmath as mp
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from stabilab import Body, ConstantTorque, Gyrostat, ScaledGyrostat, Scene, load, load_burning
from stabilab.answers.simulate import simulate
from stabilab.errors import InputError
from stabilab.integrate import trajectory as trajectories
from stabilab.physics.effects import effect_class
from stabilab.physics.states import angles, quaternion, to_space
from stabilab.theories import cavity
from tests.oracles import euler
from tests.oracles.rigid import with_a_direction
from tests.shared import CASES


def make(name, *arguments):
    return effect_class(name)(*arguments)


BODY = Body((8.7, 8.6, 11.1), 10)
D = [mp.mpf("8.7"), mp.mpf("8.6"), mp.mpf("11.1")]
CHARGED = Scene(Body(("8.7", "8.6", "11.1"), 10), make("charge", "0.003", 100, "1.02", "0.37"),
                Gyrostat((0, 0, "1.3")),
                ConstantTorque((4, 0, 0)), make("body_force", (0, 0, 3)))


def test_how_far_a_law_holds_is_the_largest_departure_between_the_steps_as_well():
    """By SciPy's DOP853 of Euler's and Poisson's equations written out here, at 100,001 times: the change of cos
    sigma of the case of the paper. A step turns the body by up to three radians."""
    case = load(CASES / "charged-body.toml")
    D, angle = np.array([8.7, 8.6, 11.1]), 0.37
    wheel = np.array([0, 0, 1.3 - 0.003 * 100 * 1.02**2 * math.cos(angle)])
    run = solve_ivp(with_a_direction(D, wheel, [4, 0, 0]), (0, 50), [0, 0, 0.28274333882308139, 0, 0, 1], "DOP853", np.linspace(0, 50, 100_001),
                    rtol=1e-11, atol=1e-13)
    largest = np.abs(run.y[5] / math.cos(angle) - 1).max()  # between these times up to 1e-7 more
    for method, off in (("taylor", 1e-6), ("DOP853", 1e-3)):
        for times in ([50.0], np.linspace(0, 50, 7)):
            assert case.simulate(times=times, method=method).validity.value == pytest.approx(largest, rel=off)


def test_charged_body_and_its_angles_agree_with_the_kinematic_equations_of_the_paper():
    """Equations (1), (14) of Galal et al. at 40 digits, to t = 1.5 s, where the angles are large already."""
    with mp.workdps(40):
        k = mp.mpf("0.003") * 100 * mp.mpf("1.02") ** 2 * mp.cos(mp.mpf("0.37"))
        rates = euler.charged(D, k, [0, 0, mp.mpf("1.3")], [4, 0, 0])
    run = simulate(CHARGED, (0, 0, 0.25), [0.5, 1.5])
    for row, time in enumerate((0.5, 1.5)):
        exact = np.array([float(v)
                          for v in euler.integrate(rates, [0, 0, 0.25, 0, 0, 0], time, int(24 * time))])
        np.testing.assert_allclose(run.state["omega"][row], exact[:3], rtol=0,
                                   atol=1e-13 * np.abs(exact[:3]).max())
        np.testing.assert_allclose(run.state["angles"][row], exact[3:], rtol=0,
                                   atol=1e-12 * np.abs(exact[3:]).max())


def test_top_agrees_with_euler_poisson_at_forty_digits():
    scene = Scene(Body((3, 2, "1.5")), Gyrostat((1, 0, "0.5")), make("gravity", 20, ("0.1", "0.05", "0.2")),
                  make("newtonian_field", "0.75"))
    rates = euler.top([3, 2, mp.mpf("1.5")], [1, 0, mp.mpf("0.5")], [2, 1, 4], mp.mpf("0.75"))
    start = ([0.5, -1.0, 4.0], [0.6, 0.0, 0.8])
    run = simulate(scene, start[0], [2.0], {"gamma": start[1]})
    exact = [float(v) for v in euler.integrate(rates, [*start[0], *start[1]], 2, 50)]
    np.testing.assert_allclose(np.concatenate([run.state["omega"][0], run.state["gamma"][0]]), exact, rtol=0,
                               atol=2e-13 * 5)
    assert max(run.invariant_drift.values()) < 1e-14


@pytest.mark.one_in(2)
@pytest.mark.parametrize("kappa_over", [50, 1000])
def test_liquid_agrees_with_the_chain_rule_by_hand(kappa_over):
    scene = Scene(Body(("9.51", "9.3", 9)), make("liquid_cavity", 1250, kappa_over, "1.9"),
                  Gyrostat((0, 0, "0.1")),
                  make("resistance", "0.02"), ConstantTorque((0, 0, "-0.06")))
    with mp.workdps(40):
        rates = euler.liquid([mp.mpf("9.51"), mp.mpf("9.3"), mp.mpf(9)], mp.mpf("0.1"),
                             mp.mpf("1.9") * 1250 / kappa_over,
                             mp.mpf("0.02"), [0, 0, mp.mpf("-0.06")])
    run = simulate(scene, (1.0, 0.25, 1.0), [0.5])
    exact = np.array([float(v) for v in euler.integrate(rates, [1, 0.25, 1], 0.5,
                                                        24 if kappa_over > 50 else 48)])
    np.testing.assert_allclose(run.state["omega"][0], exact, rtol=0, atol=1e-12 * np.abs(exact).max())


def test_angles_and_quaternions_are_inverse_and_the_third_row_is_the_papers():
    """R31 = -cos psi sin phi, R32 = sin psi, R33 = cos psi cos phi (equation (30))."""
    rng = np.random.default_rng(3)
    for psi, phi, theta in rng.uniform(-1.5, 1.5, size=(20, 3)):
        q = quaternion(psi, phi, theta)
        np.testing.assert_allclose(angles(q), (psi, phi, theta), atol=1e-14)
        third = [to_space(q, e)[2] for e in np.eye(3)]
        np.testing.assert_allclose(third, (-np.cos(psi) * np.sin(phi), np.sin(psi),
                                           np.cos(psi) * np.cos(phi)), atol=1e-15)


def test_angles_count_whole_turns_between_far_apart_times():
    """Spin about axis 3 of a free body: theta = omega3 t, whatever lies between the asked-for times."""
    run = simulate(Scene(BODY), (0.0, 0.0, 3.0), [-100.0, 50.0, 1000.0], {"attitude": (0.0, 0.0, 0.25)})
    np.testing.assert_allclose(run.state["angles"][:, 2], [0.25 - 300, 150.25, 3000.25], rtol=1e-13)


@pytest.mark.one_in(2)
@pytest.mark.parametrize("times", [[10.0], [20.0], [-10.0, 20.0]])
def test_angles_count_the_turns_of_a_pendulum_that_rests_at_the_asked_for_times(times):
    """It leaves the upper rest by 1e-4 rad/s, whips round once in 11.3 s and is back near rest at 10 and 20
    s: the angle is the integral of the rate, by an independent fine run in small steps."""
    from scipy.integrate import solve_ivp
    scene = Scene(Body((12, 9, 5)), make("gravity", 100, (0, 0, "0.5")))
    run = simulate(scene, (0.0, 1e-4, 0.0), times, {"gamma": (0, 0, -1), "attitude": (0, 0, 0)})
    for time, phi in zip(times, run.state["angles"][:, 1]):
        own = solve_ivp(lambda t, y: (y[1], 50 / 9 * np.sin(y[0])), (0, time), (0, 1e-4), rtol=1e-12,
                        atol=1e-14, method="DOP853")
        np.testing.assert_allclose(phi, own.y[0, -1], rtol=0, atol=1e-6)
    assert abs(phi) > 6


def test_angles_start_where_the_case_says_whichever_branch_it_takes():
    """psi = 2 and (pi - 2, pi, pi) are one attitude; the run stays with the one that was given. Spin about
    axis 3: theta."""
    for first in ((2.0, 0.1, -0.2), (2.0, 7.0, 9.0), (-9.0, 0.1, 0.2), (1.0, -4.0, 12.0)):
        run = simulate(Scene(BODY), (0.0, 0.0, 0.5), [0.0, 0.125], {"attitude": first})
        np.testing.assert_allclose(run.state["angles"][0], first, atol=1e-14)
        assert np.abs(run.state["angles"][1] - first).max() < 0.3


def test_the_points_for_counting_turns_come_from_the_method_that_was_asked_for():
    """A rotation about axis 3 at 40 rad/s seen at its ends alone, by a method whose steps are not those of
    the series."""
    for method in ("RK45", "Radau"):
        run = simulate(Scene(BODY), (0.0, 0.0, 40.0), [0.0, 5.0], {"attitude": (0.0, 0.0, 0.0)}, method, 1e-6)
        assert run.method == method and run.state["angles"][1, 2] == pytest.approx(200.0, rel=1e-3)


def test_a_force_along_the_spin_axis_of_a_steady_spin_gives_uniform_acceleration():
    """x3 = f t^2/(2 m), v3 = f t/m: the axis stays where it is."""
    scene = Scene(BODY, make("body_force", (0, 0, 3)))
    run = simulate(scene, (0.0, 0.0, 2.0), [4.0])
    np.testing.assert_allclose(run.state["velocity"][0], [0, 0, 1.2], atol=1e-14)
    np.testing.assert_allclose(run.state["position"][0], [0, 0, 2.4], atol=1e-14)


def test_gamma_and_attitude_tell_the_same_vertical():
    """gamma started along the inertial third axis stays the third row of the rotation."""
    scene = Scene(BODY, make("charge", "0.5", 2, 1, "attitude"), ConstantTorque((0.4, 0.1, 0)))
    run = simulate(scene, (0.3, 0.1, 1.0), [3.0, 9.0],
                   {"gamma": (0.0, 0.0, 1.0), "attitude": (0.0, 0.0, 0.0)})
    for gamma, (psi, phi, theta) in zip(run.state["gamma"], run.state["angles"]):
        third = [to_space(quaternion(psi, phi, theta), e)[2] for e in np.eye(3)]
        np.testing.assert_allclose(gamma, third, atol=1e-13)


def test_a_stiff_liquid_is_followed_by_an_implicit_method_that_says_so():
    scene = Scene(Body(("9.51", "9.3", 9)), make("liquid_cavity", 1250, "0.01", "1.9"))
    run = simulate(scene, (1.0, 0.5, 1.0), [2e5])
    assert run.method == "Radau" and "stiff" in run.because
    momentum = np.linalg.norm(np.array([9.51, 9.3, 9]) * run.state["omega"][0])
    # |H| is constant without rotor (theory)
    assert momentum == pytest.approx(np.linalg.norm([9.51, 4.65, 9.0]), rel=1e-6)


def test_a_stiff_scene_with_an_attitude_is_left_to_the_series_where_the_turn_costs_the_implicit_method_more():
    """Measured: 40 Radau steps a radian at 0.25 ms against 0.8 Taylor steps a decay at 0.02 ms."""
    from stabilab.answers.simulate import _chosen
    from stabilab.physics.states import start_of
    scene = Scene(Body(("9.51", "9.3", 9)), make("liquid_cavity", 1250, "0.01", "1.9"),
                  Gyrostat((0, 0, "0.1")))
    for omega, blocks, method in (((1, 0.5, 1), {}, "Radau"),
                                  ((1, 0.5, 1), {"attitude": (0, 0, 0)}, "taylor"),
                                  # the decay grows as omega^2
                                  ((1000, 500, 1000), {"gamma": (0, 0, 1)}, "Radau")):
        assert _chosen(scene, start_of(scene, omega, blocks), np.array([2e4]), None, None)[0] == method


@pytest.mark.parametrize("scene, times, blocks, form, words", [
    (Scene(BODY), [1.0], {"gamma": (0.0, 1.0)}, None, "gamma has 3 components, got 2"),
    (Scene(Body((3, 2, 2))), [1.0], {"velocity": (0.0, 0.0, 1.0)}, None, "mass"),
    (Scene(BODY), [0, 2, 1], None, None, "times: expected strictly increasing or strictly decreasing"),
    (Scene(BODY), [0, 2, 1], {"attitude": (0.1, 0.2, 0.3)}, None, "times: expected strictly increasing"),
    (Scene(BODY), [0, 1], None, "euler", 'attitude: expected "quaternion" or "matrix", got \'euler\''),
    (ScaledGyrostat(0, 0, (1, 0, 0)), [0, 1], None, "matrix", "attitude: scaled variables have no attitude")])
def test_states_times_and_attitudes_that_are_none_are_refused_with_what_was_expected(scene, times, blocks, form, words):
    with pytest.raises(InputError, match=words):
        simulate(scene, (1, 0, 0), times, blocks, attitude=form)


def test_any_body_has_its_attitude_as_quaternion_or_matrix():
    """A steady spin w about axis 3 turns the body by w t about it: Rz(w t), and (0, 0, sin(w t/2), cos(w t/2))."""
    times, rate = np.array([0.0, 1.0, 4.0]), 0.5
    run = simulate(Scene(BODY), (0.0, 0.0, rate), times, attitude="matrix")
    c, s, o = np.cos(rate * times), np.sin(rate * times), np.zeros(3)
    expected = np.stack([[c, -s, o], [s, c, o], [o, o, o + 1]]).transpose(2, 0, 1)
    assert run.state["matrix"].shape == (3, 3, 3) and np.abs(run.state["matrix"] - expected).max() < 1e-15
    q = simulate(Scene(BODY), (0.0, 0.0, rate), times, attitude="quaternion").state["quaternion"]
    assert np.abs(q - np.stack([o, o, np.sin(rate * times / 2), np.cos(rate * times / 2)], axis=1)).max() < 1e-15
    assert run.to_xarray()["matrix"].dims == ("time", "inertial_axis", "axis")
    assert list(run.to_pandas().columns[3:12]) == [f"R{i}{j}" for i in (1, 2, 3) for j in (1, 2, 3)]


def test_a_matrix_turns_body_to_inertial_components_from_the_start_that_is_given():
    """The angular momentum D omega is constant in space; the matrix brings it there, by numpy's product."""
    run = simulate(Scene(BODY), (0.3, 0.4, 0.5), [0.0, 2.0, 30.0], {"attitude": (0.1, -0.2, 0.3)}, attitude="matrix")
    H = np.einsum("nij,nj->ni", run.state["matrix"], run.state["omega"] * BODY.inertia)
    assert np.abs(H - H[0]).max() < 1e-13 and np.abs(H - run.state["momentum"]).max() < 1e-13
    (cz, sz), (cx, sx), (cy, sy) = ((np.cos(a), np.sin(a)) for a in (0.3, 0.1, -0.2))
    turn = np.array([[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]]) @ [[1, 0, 0], [0, cx, -sx], [0, sx, cx]] @ [
        [cy, 0, sy], [0, 1, 0], [-sy, 0, cy]]  # Rz(theta) Rx(psi) Ry(phi)
    assert np.abs(run.state["matrix"][0] - turn).max() < 1e-15


@pytest.mark.parametrize("option, names", [("--attitude", "qx,qy,qz,qw"), ("--matrix", "R11,R12,R13,R21,R22,R23,R31,R32,R33")])
def test_files_carry_the_attitude_with_units_in_their_header(stabilab, tmp_path, option, names):
    xarray = pytest.importorskip("xarray")
    case = Path(__file__).parents[2] / "cases" / "phone.toml"
    assert stabilab("simulate", case, "--at", "0,1", option, "--out", tmp_path / "a.csv")[0] == 0
    header, *rows = (tmp_path / "a.csv").read_text().splitlines()
    assert header == ("t (s),omega1 (rad/s),omega2 (rad/s),omega3 (rad/s)," + names
                      + ",H1 (kg m^2/s),H2 (kg m^2/s),H3 (kg m^2/s)")
    assert stabilab("simulate", case, "--at", "0,1", option, "--out", tmp_path / "a.nc")[0] == 0
    with xarray.open_dataset(tmp_path / "a.nc") as data:
        part = data["quaternion" if option == "--attitude" else "matrix"]
        assert np.ravel(part[1]).tolist() == [float(v) for v in rows[1].split(",")[4:4 + part[1].size]]
        assert data["omega"].attrs["units"] == "rad/s" and part.attrs["units"] == "1"
    assert stabilab("simulate", case, "--at", "0,1", "--attitude", "--matrix")[0] == 2


@pytest.mark.parametrize("method", ["taylor", "Radau"])
def test_a_run_over_1e14_turns_stops_and_says_so(monkeypatch, method):
    """The damper takes 1000 s; that the turns part rates for a moment is no decay, and no reason to take an
    implicit method."""
    from stabilab.integrate import trajectory as trajectories
    monkeypatch.setattr(trajectories, "REPORT", 1000)
    monkeypatch.setattr(trajectories, "SCIPY_REPORT", 50)
    scene = Scene(Body((3, 2, 1)), effect_class("rate_damper")("1e-3"))
    run = simulate(scene, (1e12, 2e12, 3e12), [0.0, 100.0], method=None if method == "taylor" else method)
    assert (run.method, run.status) == (method, "stopped") and run.t.tolist() == [0.0]
    assert re.search("the last [0-9]+ steps went from t = 0 to .*, the rest would take some", run.because)


@pytest.fixture
def runs(monkeypatch):
    """The runs of series, of SciPy and of averages that were begun."""
    begun = []
    for module, name in ((trajectories._Taylor, "run"), (trajectories._SciPy, "run"), (cavity, "follow")):
        own = getattr(module, name)
        monkeypatch.setattr(module, name, lambda *arguments, own=own: (begun.append(own), own(*arguments))[1])
    return begun


@pytest.mark.parametrize("name, options, words", [
    ("dual-spin-damper", ["--method", "taylor"], "axis: expected x, y, z"),
    ("major-axis-100", ["--method", "taylor"], "scaled variables have no body"),
    ("burns/stage", [], "axis: expected x, y, z"),
    ("liquid-base", ["--model", "averaged1"], "this run is of the model averaged1")])
def test_a_nutation_that_a_run_cannot_have_is_refused_before_a_step_is_taken(name, options, words, stabilab, runs):
    path = CASES / f"{name}.toml"
    axis = "z" if "axis" not in words else "q"
    code, out, err = stabilab("simulate", path, "--at", "0,1", *options, "--nutation", axis)
    assert (code, out, runs) == (2, "", []) and words in err
    if "--model" not in options:
        with pytest.raises(InputError, match=words):
            (load_burning if "burns" in name else load)(path).simulate([0, 1], nutation=axis)
        assert runs == []
    assert stabilab("simulate", path, "--at", "0,1", *options)[0] == 0 and len(runs) > 0
