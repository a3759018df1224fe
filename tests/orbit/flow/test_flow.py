"""The state at any time by quadrature: against Taylor series in many digits, zeta functions and the stepping
methods."""
import math

import numpy as np
import pytest

import stabilab
from stabilab import Body, ConstantTorque, Gyrostat, ScaledGyrostat, Scene, fate, trajectory
from stabilab.errors import InputError
from stabilab.integrate.reference import reference, relative_errors
from stabilab.orbit.flow import reduced_motion
from stabilab.orbit.profile import ByPanels
from stabilab.orbit.spin_up import SpinUp
from tests.hunt.disagreements import DISAGREEMENTS, many_digits
from tests.oracles import energy
from tests.oracles.pairs import exactly, physical, scaled

MINOR = ScaledGyrostat("0.2", "0.4", (0, 0, 1))
MIDDLE = ScaledGyrostat("0.2", "4.4", (0, 1, 0))  # |c| = 4.2: a double well
HELD, SPINNING = (2.75, 1.125, 1.0), (1.0, 4.0, 3.0)
EPS = float(np.finfo(float).eps)


def error_of(scene, state, times, **options):
    """(n,) relative error against Taylor series in 30 and 42 digits, which share nothing with the quadrature.
    """
    exact = reference(scene, state, np.asarray(times, float), **options)
    assert exact.status == "agrees"
    return relative_errors(reduced_motion(scene, state).states(exact.t), exact.states, exact.rest,
                           exact.slices)


def turning_speed(x1, x2):
    """x3 > 0 on the separatrix above (x1, x2), from the margin at rest there."""
    return math.sqrt(2 * float(fate(MINOR, (x1, x2, 0.0)).margins))


# -- motions that repeat


@pytest.mark.one_in(2)
@pytest.mark.parametrize("scene, state",
                         [(MINOR, HELD), (MINOR, (4.5, -4.9, -1.4)), (MIDDLE, (1.0, 2.0, 0.5)),
                                          (MIDDLE, (-1.0, -2.0, 5.0)),
                                          (Scene(Body((2000, 1500, 1000)), Gyrostat((100, 0, 0))),
                                           (1.0, 2.0, -1.0)),
                                          (Scene(Body((3, 2, "1.5"))), (1.0, 0.2, 2.5))])
def test_late_state_of_a_repeating_motion_errs_by_its_period_alone(scene, state):
    # one rounding of the period shifts t = 1000 by some 1e-13: a few of them, times rates of order 10
    assert error_of(scene, state, [0.5, 30.0, 1000.0], orbit=True).max() < 4e-12


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("sign", [1, -1])
def test_scales_and_signs_of_the_torque_keep_the_digits(scale, sign):
    # moments and rates in other units: times shrink by the scale
    scene = Scene(Body((2.0, 1.5, 1.0)), Gyrostat((0.1 * scale, 0.2 * scale, 0)),
                  ConstantTorque((0, 0, sign * 0.2 * scale**2)))
    for state in ((1.0 * scale, 0.3 * scale, 0.2 * scale), (0.2 * scale, -0.1 * scale, -0.3 * scale)):
        assert error_of(scene, state, np.array([0.3, 3.0]) / scale).max() < 2e-15


@pytest.mark.one_in(2)
@pytest.mark.parametrize("distance", [1e-3, 1e-12, pytest.param(1e-6, marks=pytest.mark.slow),
                                      pytest.param(1e-9, marks=pytest.mark.slow)])
@pytest.mark.parametrize("side", [1, -1])
def test_state_next_to_the_separatrix_keeps_its_digits(distance, side):
    state = (2.75, 1.125, turning_speed(2.75, 1.125) * (1 - side * distance))
    motion = reduced_motion(MINOR, state)
    assert isinstance(motion, ByPanels if side > 0 else SpinUp)
    assert error_of(MINOR, state, [1.0, 5.0, 10.0]).max() < 2e-14


def test_small_libration_about_a_centre_keeps_its_relative_digits():
    # x2 (x1 + 0.4) = -1 at the centre (4, -1/4.4, 0)
    scene, state = MINOR, (4.0, -1 / 4.4, 1e-7)
    run, exact = trajectory(scene, state, [5.0], "reduced"), reference(scene, state, np.array([5.0]))
    assert np.abs(run.states - exact.states).max() < 1e-14


def test_cost_does_not_grow_with_time():
    for state in (HELD, SPINNING):
        near, far = (trajectory(MINOR, state, [t], "reduced") for t in (1.0, 1e6))
        assert near.counters == far.counters and 0 < far.counters["evaluations"] < 4000


# -- spin-up


def summed_time(state, theta, bits=120):
    """Time from a state of MINOR (x3 > 0) to coordinate theta, by Hurwitz's zeta function in balls:
    sum over turns of (K + 2 pi n)^(-1/2) = (zeta(1/2, k) - zeta(1/2, k + n))/sqrt(2 pi), Gauss's rule over
    one turn."""
    from flint import acb, arb, ctx
    with ctx.workprec(bits):
        a, b = arb(1) / 5, arb(2) / 5
        x1, x2, x3 = map(arb, state)
        X, c, half = x1 + a, b - a, acb(1) / 2
        A, start = (X * X + x2 * x2).sqrt(), arb.atan2(X, x2)
        height = lambda q: -q - (A * q.sin()) ** 2 / 2 - c * A * q.sin()
        energy, turn = x3 * x3 / 2 + height(start), 2 * arb.pi()
        turns = ((theta - start) / turn).floor()
        rule = [arb.legendre_p_root(20, k, weight=True) for k in range(20)]

        def over(first, last, function, pieces):
            width = (last - first) / pieces / 2
            return sum((w * width * function(first + width * (2 * p + 1 + x)) for p in range(pieces) for x,
                        w in rule), arb(0))

        def whole(q):
            k = (energy - height(q)) / turn
            return (half.zeta(acb(k)) - half.zeta(acb(k + turns))).real / (2 * turn).sqrt()
        end = theta - turns * turn
        part = over(start, end, lambda q: 1 / (2 * (energy - height(q) + turn * turns)).sqrt(), 12)
        return over(start, start + turn, whole, 12) + part


def place_after(state, time):
    """(theta in many digits, the state given at that time) from the energy's whole turns and the angle of the
    answer."""
    from flint import arb, ctx
    motion = reduced_motion(MINOR, state)
    found, way = motion.follow(np.array([time]))
    x1, x2, _ = found[0]
    with ctx.workprec(120):
        start = arb.atan2(arb(state[0]) + arb(1) / 5, arb(state[1]))
        angle = arb.atan2(arb(float(x1)) + arb(1) / 5, arb(float(x2)))
        turns = round((way[0] + float(start) - float(angle)) / (2 * math.pi))
        return angle + 2 * arb.pi() * turns, found[0]


@pytest.mark.parametrize("time", [30.0, 1e3, 1e4, 1e6])
def test_spin_up_is_as_right_as_one_ulp_of_the_time_allows(time):
    """An ulp of the time t turns the body by t times eps times x3 ~ t^2 eps: no answer in doubles knows its
    place better."""
    theta, found = place_after(SPINNING, time)
    assert abs(float(summed_time(SPINNING, theta) - time)) < 4 * EPS * time
    # the rate from work and energy, the coordinate being known
    X, z = found[0] + 0.2, found[1]
    start = math.hypot(SPINNING[0] + 0.2, SPINNING[1])
    assert math.hypot(X, z) == pytest.approx(start, rel=1e-14)
    assert found[2] == pytest.approx(time, rel=0.2)


@pytest.mark.parametrize("state",
                         [SPINNING, (1.0, 4.0, -3.0), (0.1, 0.2, 30.0), (0.1, 0.2, -30.0), (-0.2, 0.0, -1.0)])
def test_spin_up_agrees_with_the_series_back_and_forth(state):
    times = np.array([-6.0, -1.0, 0.0, 0.3, 3.0, 25.0])
    run, steps = trajectory(MINOR, state, times, "reduced"), trajectory(MINOR, state, times, rtol=1e-13)
    # Taylor's phase errs by some roundings of rates near 50 over as long a time; circle A = 0 has no angle at
    # all
    assert np.abs(run.states - steps.states).max() < 2e-10
    assert max(run.invariant_drift.values()) < 2e-15


@pytest.mark.parametrize("weak", [1e-2, 1e-3, 1e-4])
def test_weak_torques_turn_the_motion_back_at_the_same_times_one_by_one_and_together(weak):
    """Hills hundreds and thousands of times as high as a turn's work, so that the closed form guesses the
    turn badly."""
    scene, state = Scene(Body((3, 2, 1.5)), Gyrostat((1, 0.5, 0)),
                         ConstantTorque((0, 0, weak))), (0.2, 0.1, -20.0)
    # rest comes at some 30/weak
    motion, late = reduced_motion(scene, state), np.linspace(0.01, 100, 30) / weak
    assert isinstance(motion, SpinUp) and motion.sense < 0
    together = motion.follow(late)[0]
    for time, found in zip(late, together):
        # a time of 100/weak is known to 1e-14/weak, and the state turns at 60 rad/s
        np.testing.assert_allclose(motion.at(time), found, rtol=0, atol=1e-12 / weak)


def test_late_energy_and_circle_of_a_spin_up_hold_to_rounding():
    for time in (1e3, 1e6, 1e9):
        assert max(trajectory(MINOR, SPINNING, [time], "reduced").invariant_drift.values()) < 1e-15


def test_spin_up_told_from_its_state_declines_times_before_it():
    motion = reduced_motion(MINOR, (1.0, 4.0, 40.0))  # at rest more than a hundred turns before
    for ask in (motion.at, lambda t: motion.states([0.0, t])):
        with pytest.raises(InputError, match="backwards=True"):
            ask(-0.5)


# -- every geometry, against the stepping method


@pytest.mark.one_in(2)
@pytest.mark.parametrize("moments, momentum, torque", [
    ((2, 2, 1), (0.1, 0.2, 0), (0, 0, 0.3)), ((2, 1, 1), (0, 0.2, 0), (0, 0, 0.3)),
    ((2, 1, 1), (0, 0.2, 0.3), (0, 0, 0)),
    ((1, 1, 1), (0, 0.2, 0), (0.3, 0, 0.0)), ((2, 1.9999, 1), (0.1, 0.2, 0), (0, 0, 0.3)),
    ((2, 1 + 1e-7, 1), (0, 0.2, 0), (0, 0, 0.3))])
def test_bodies_with_equal_and_nearly_equal_moments_agree_with_the_stepping_method(moments, momentum, torque):
    scene = Scene(Body(moments), Gyrostat(momentum), *([ConstantTorque(torque)] if any(torque) else []))
    times = np.array([-2.0, 0.5, 8.0])
    run, steps = trajectory(scene, (0.5, 1.0, -0.4), times,
                            "reduced"), trajectory(scene, (0.5, 1.0, -0.4), times, rtol=1e-14)
    assert np.abs(run.states - steps.states).max() < 1e-11


# -- what has no reduced form


def test_motions_without_a_reduced_form_are_declined_in_words():
    with pytest.raises(InputError, match="no reduction to one degree of freedom"):
        trajectory(ScaledGyrostat("0.2", "0.4", (1, 0, 0)), (1, 2, 3), [1.0], "reduced")
    # 3 omega1^2 = 12 omega3^2: on the middle axis' separatrix, exactly
    with pytest.raises(InputError, match="separatrix"):
        trajectory(Scene(Body((3, 4, 6))), (2, 1, 1), [1.0], "reduced")
    with pytest.raises(InputError, match="blocks"):
        trajectory(MINOR_BODY, {"omega": (1, 2, 3), "gamma": (0, 0, 1)}, [1.0], "reduced")
    with pytest.raises(InputError, match="no tolerance"):
        trajectory(MINOR, HELD, [1.0], "reduced", 1e-9)
    with pytest.raises(InputError, match="spin-up on an invariant plane"):
        trajectory(ScaledGyrostat("0.25", "0.5", (0, 1, 0)), (0.5, 1, -1), [1.0], "reduced")
    # 1e-17 off a plane, where the hyperbola is long and thin
    with pytest.raises(InputError, match="more panels"):
        trajectory(ScaledGyrostat("0.2", "0.4", (0, 1, 0)), (-0.4, 1, 0), [1.0], "reduced")


MINOR_BODY = Scene(Body((2000, 1500, 1000)), Gyrostat((100, 0, 0)), ConstantTorque((0, 0, 200)))


def test_equilibrium_stays_to_the_last_digit():
    run = trajectory(Scene(Body((2000, 1500, 1000))), (0, 3, 0), [5.0, 1e6], "reduced")
    assert (run.states == [0, 3, 0]).all() and max(run.invariant_drift.values()) == 0


@pytest.mark.one_in(3)
@pytest.mark.parametrize("over", [1e-4, -1e-4, 1e-9, -1e-9])
def test_a_free_motion_that_nearly_stops_at_its_saddle_is_told_on_either_side(over):
    """Against a Taylor series in 200 bits; 6 (6 - 4) omega1^2 = 3 (4 - 3) omega3^2 on the middle axis'
    separatrix."""
    pytest.importorskip("heyoka")
    scene, problem = physical((6, 4, 3), (0, 0, 0), (0, 0, 0))
    state = (0.5 * (1 + over), 0.75, 1.0)
    motion = reduced_motion(scene, state)
    for time in (0.4 * motion.period, 0.9 * motion.period):
        found = stabilab.trajectory(scene, state, [time], "reduced", laws=False).states[0]
        # a unit in the last place of the start counts as many times as the way along the saddle grows it
        np.testing.assert_allclose(found, many_digits(problem, state, time), atol=4e-15 / abs(over))

# Large circles: a state next to its turning point lies beyond it by rounding, and was then told from the
# other end of the libration.
AT_THE_TURN = {
    "scaled, A = 5e5": (scaled(2.67894360502477, -3.1359257959706746, (0.0, 0.0, 0.0005447722269963265)),
                        exactly("-0x1.138fab90267b8p+18", "-0x1.9dec3a4355bedp+18", "0x1.c9f18f2312009p-13")),
    "physical": (physical((2.1119923659985465, 0.7483138778422094, 1.4269240413647868),
                          (-61.189403922546475, -0.15012964884116087, 0.0),
                          (0.0, 0.0, -0.4039882799028167)),
                 exactly("-0x1.6dd06db6e893fp+23", "0x1.07530fe5effdep+22", "0x1.120f1b6153672p-14")),
    "scaled, A = 1e7": (scaled(8.945321721015654, 9.383261012998357, (0, 0, 1.0)),
                        exactly("0x1.18d3b2e8758a0p+21", "0x1.30d9d1ea2337ep+23", "-0x1.3859bade30e6dp-11")),
}


@pytest.mark.parametrize("name", AT_THE_TURN)
def test_a_libration_on_a_large_circle_may_start_at_its_turning_point(name):
    (scene, problem), state = AT_THE_TURN[name]
    # quadrature against Taylor series, in units of rounding
    size, words = DISAGREEMENTS["methods"](scene, problem, state)
    assert 0 < size <= 1, words


def test_panels_that_do_not_add_up_to_the_period_are_refused():
    """Flights of 2e6 between walls like exp(theta): each panel's series settled, their sum missed the period
    by 5e-7."""
    scene, problem = scaled(-0.11664492020020725, 0.06352349753161168, (0.0, 5809731895.024427, 0.0))
    state = exactly("-0x1.1d12a8d1d583ap+5", "0x1.a9d236fe690c0p+20", "0x1.d10dc4ead4843p+6")
    assert float(stabilab.period(scene,
                                 np.array(state))) == pytest.approx(float(energy.period(problem, state)),
                                                                    rel=1e-11)
    with pytest.raises(stabilab.errors.InputError, match="take method taylor"):
        stabilab.trajectory(scene, state, [1e-5], "reduced")


def test_a_libration_of_which_doubles_lose_the_turning_point_is_told_otherwise_or_refused():
    scene, problem = physical((3.0541906867772606, 2.781647235252075, 0.47338365602266785),
                              (0.0, -178.98735879325278, 0.35249398302471097),
                              (53232.467476916085, 0.0, 0.0))
    state = exactly("-0x1.29b952f4ec612p-19", "0x1.b12f3aa1229d7p+15", "-0x1.0de749c175e0ep-2")
    size, words = DISAGREEMENTS["methods"](scene, problem, state)
    assert size <= 1, words


def test_a_way_of_any_length_on_a_parabola_is_cut_into_few_panels():
    """Its coordinate is no angle: from rates of 1e-9 under a torque it ran over 1e9 of them, each in parts of an
    eighth of a turn, until memory was full. Oracle: Taylor series."""
    scene = Scene(Body((12, 5, 5)), ConstantTorque((0, 0, 0.02)))
    state, times = (1e-9, 2e-9, 3e-9), np.array([0.5, 1.0])
    assert reduced_motion(scene, state, 8).evaluations < 10_000
    run, steps = (trajectory(scene, state, times, method).states[:, 2] for method in ("reduced", "taylor"))
    np.testing.assert_allclose(run, steps, rtol=1e-12)  # of the rate that the torque drives
