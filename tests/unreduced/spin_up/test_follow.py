"""Motions followed to their certificate: one and many, and none against a run of another kind."""
import math
import random
from functools import partial

import numpy as np
import pytest

import stabilab
from benchmarks.spin_up import random_scene as benchmark_scene
from stabilab import Body, ConstantTorque, Fate, Gyrostat, ScaledGyrostat, Scene
from stabilab.errors import InputError
from stabilab.numbers.numba_door import LOAD, Kernel
from stabilab.physics.coefficients import to_scaled
from stabilab.unreduced.spin_up import certificate, drift, follow
from stabilab.unreduced.spin_up.certificate import ADVANCE
from stabilab.unreduced.spin_up.follow import STEP, spin_up, spin_up_many
from stabilab.unreduced.spin_up.form import seen

from .scenes import EXAMPLE, numba, random_scene, rates_of, run, sphere


def test_every_motion_without_a_wheel_spins_up():
    rng = random.Random(22)
    for _ in range(15):
        answer = spin_up(random_scene(rng, 0), sphere(rng, rng.choice((.1, 1, 10))))
        assert answer.level == "certified" and answer.t < 10_000


COLUMNS = ("fate", "axis", "sense", "level", "t", "steps", "condition", "states")


@pytest.mark.parametrize("fast",
                         [pytest.param(False, marks=pytest.mark.slow), pytest.param(True, marks=numba)])
def test_company_does_not_matter(fast):
    """The same bytes in broad batches and narrow ones, and for a state alone."""
    scene = random_scene(random.Random(9), 0.1)
    starts = np.array([sphere(random.Random(n), 3) for n in range(45)])
    all_, some = (spin_up_many(scene, states, 200, 400, fast=fast) for states in (starts, starts[::7]))
    assert all(np.array_equal(getattr(all_, name)[::7], getattr(some, name)) for name in COLUMNS)
    one = spin_up(scene, starts[7].tolist(), 200, 400, fast=fast)
    assert (one.t, one.state) == (all_.t[7], tuple(all_.states[7].tolist()))


@numba
@pytest.mark.one_in(2)
@pytest.mark.parametrize("wheel", [0, 1])
def test_motions_are_decided_alike_with_and_without_numba(wheel):
    """The same loops, compiled and as they are written; the states lie on the motions, by SciPy's DOP853."""
    scene, starts = random_scene(random.Random(31), wheel), np.random.default_rng(6).normal(size=(40, 3)) * 3
    slow, fast = (spin_up_many(scene, starts, 100, 400, fast=way) for way in (False, True))
    for name in ("fate", "axis", "sense", "level", "steps", "t", "states", "condition"):
        assert np.array_equal(getattr(slow, name), getattr(fast, name))
    for n in np.flatnonzero((fast.t > 0) & (fast.level > 0))[::4]:
        end = run(rates_of(scene), starts[n], np.array([0.0, fast.t[n]]))[-1]
        size = fast.condition[n] * (1 + np.abs(end).max()) * (1 + fast.t[n])
        assert np.allclose(fast.states[n], end, rtol=0, atol=1e-9 * size)


@numba
def test_a_long_motion_is_compiled_on_its_way(monkeypatch):
    scene, start = random_scene(random.Random(31), 1), (3.0, -1.0, 2.0)
    whole = spin_up(scene, start, budget=400, fast=True)
    kernel = Kernel(ADVANCE.module, ADVANCE.entry, ADVANCE.seconds, ADVANCE.inlined, ADVANCE.variant,
                    options=ADVANCE.options, spent=LOAD - 20 * STEP)
    for module in (follow, drift):
        monkeypatch.setattr(module, "ADVANCE", kernel)
    assert spin_up(scene, start, budget=400).t == whole.t and kernel.ready
    assert -20 * STEP <= kernel.spent - LOAD < 0  # plain steps came first, and ended there


def test_scaled_twin_has_the_fate_of_its_body():
    """Scaled axis for axis: D1 > D2 > D3, omega_j = rate_j x_j with positive rates."""
    scene = Scene(Body((2000, 1500, 1000)), Gyrostat((30, 0, 0)), ConstantTorque((4, 3, -2)))
    twin, change = to_scaled(scene)
    for state in np.random.default_rng(5).normal(size=(6, 3)) * 0.1:
        one, two = spin_up(scene, state), spin_up(twin, change.to_scaled(state))
        assert (one.level, one.axis, one.sense) == (two.level, two.axis,
                                                    two.sense) and one.level == "certified"


def test_scaled_scenes_of_no_body_are_certified_too():
    scene = ScaledGyrostat(1.5, -0.7, (0.4, 0.3, 0.5))
    answer = spin_up(scene, (0.3, -0.2, 0.4))
    assert answer.level == "certified"
    a, b, mu = 1.5, -0.7, scene.mu
    rate = lambda x: [x[1] * x[2] + mu[0], -x[2] * (x[0] + a) + mu[1], x[1] * (x[0] + b) + mu[2]]
    times = answer.t + np.linspace(0, 5, 101)
    spin = run(rate, answer.state, times) @ np.array(answer.direction)
    low, high = np.array([answer.trap.line(t) for t in times]).T
    assert (spin > low - 1e-7).all() and (spin < high + 1e-7).all()


@pytest.mark.parametrize("unit, mass", [(2.0**-30, 1.0), (2.0**20, 2.0**40)])
def test_fate_does_not_depend_on_units(unit, mass):
    scene = Scene(Body([mass * v for v in (1.4, 1, .6)]), Gyrostat([mass * unit * v for v in (.2, .1, -.3)]),
                  ConstantTorque([mass * unit**2 * v for v in (.5, .6, .62)]))
    one, two = spin_up(EXAMPLE, (.1, .2, .3)), spin_up(scene, [unit * v for v in (.1, .2, .3)])
    assert (one.axis, one.sense, one.steps) == (two.axis, two.sense,
                                                two.steps) and two.t == pytest.approx(one.t / unit, rel=1e-9)


def test_parked_motion_is_called_parked():
    """l2 M2/d2 + l3 M3/d3 > 0 and small M1: the saddle-focus at -m*/M1."""
    scene = Scene(Body((1.4, 1, .6)), Gyrostat((0, 0, .8)), ConstantTorque((.02, 0.1, .6)))
    drag = .8 * .6 / .8
    assert "parked" in str(seen(scene, (-drag / .02, 0, .8 / .8)))


def test_condition_is_the_growth_of_a_small_change():
    """Against two runs by DOP853 started 1e-6 apart in the same direction."""
    state = np.array((.3, -.2, .4))
    answer = spin_up(EXAMPLE, state)
    times = np.linspace(0, answer.t, 400)
    step = 1e-6 * np.array((1, -1, 1))
    apart = (np.abs(run(rates_of(EXAMPLE), state + step, times)
                    - run(rates_of(EXAMPLE), state, times)).max(axis=1).max() / 1e-6)
    assert 0.3 * apart < max(answer.condition, 1) < 1.1 * max(apart, 1)


def test_bad_states_are_refused():
    with pytest.raises(InputError):
        spin_up(EXAMPLE, (1, math.nan, 2))
    with pytest.raises(InputError):
        spin_up_many(EXAMPLE, [[1, 2]])


@pytest.mark.parametrize("rate", [1e151, 1e308])
def test_rates_beyond_what_a_run_in_doubles_holds_are_undecided_with_the_reason(rate):
    """A warning of overflow would be an error here; the other state of the batch keeps its answer."""
    one, many = spin_up(EXAMPLE, (rate, 0.0, 0.0)), spin_up_many(EXAMPLE, [(rate, 0.0, 0.0), (0.1, 0.2, 0.3)])
    assert one.level == "undecided" and "no run in doubles holds it" in one.cause and many.row(
        0).cause == one.cause
    assert many.row(1).level == spin_up(EXAMPLE, (0.1, 0.2, 0.3)).level == "certified"


def test_nothing_is_followed_beyond_the_limits():
    scene = random_scene(random.Random(26), 10)
    answer = spin_up(scene, (.1, .2, .1), 2.0)
    assert answer.level == "certified" or answer.t == pytest.approx(2.0)
    assert spin_up(scene, (.1, .2, .1), budget=20).steps <= 20


@pytest.mark.slow
def test_a_small_component_without_a_wheel_is_certified_about_the_moving_centre_in_time():
    """The torque's share along the major axis is 0.002: the fixed centre alone takes 6,700 natural units, so
    slowly does the spin grow."""
    rng = random.Random(12)
    scene, state, *_ = [benchmark_scene(rng) for _ in range(1423)][-1]
    answer = spin_up(scene, state)
    assert answer.level == "certified" and answer.t < 5000 and answer.trap.form == "moving centre"


def test_limits_hold_for_all_where_one_state_is_beyond_doubles():
    near = (0.1, 0.2, 0.3)
    found = spin_up_many(EXAMPLE, [near, (1e200, 0.0, 0.0)], 0.5, 8)
    assert found.t[0] <= 0.5 and found.steps[0] <= 8 and found.row(0) == spin_up(EXAMPLE, near, 0.5, 8)
    assert spin_up_many(EXAMPLE, [near, (1e200, 0.0, 0.0)], proof=True).row(0).level == "proved"


def test_a_test_has_its_number_before_another_thread_may_find_it(monkeypatch):
    tests, seen_ = certificate.Tests(EXAMPLE), []
    seen = lambda field, orders, fast: seen_.append((field, orders) in tests.asked)
    monkeypatch.setattr(certificate, "Certifier", seen)
    for asked in tests.high:
        tests.certifier(*asked)
    assert seen_ == [True] * len(tests.high)


def test_a_motion_that_a_law_keeps_bounded_is_no_open_question_of_spin_up():
    """Table 2 of the paper has the first of these motions periodic, with extremes; the second goes round axis
    3 and spins up."""
    scene = ScaledGyrostat("0.2", "0.4", (0, 0, 1))
    states = [(2.5, 4.0, 0.1), (2.5, 4.0, 30.0)]
    one = [spin_up(scene, state, 20) for state in states]
    assert [(answer.fate, answer.level)
            for answer in one] == [(Fate.BOUNDED, "exact"), (Fate.SPIN_UP, "certified")]
    assert one[0].cause.startswith("bounded by the law of a torque along a principal axis: ")
    many = spin_up_many(scene, np.array(states), 20)
    assert many.fate.tolist() == [Fate.BOUNDED,
                                  Fate.SPIN_UP] and [many.row(n).cause
                                                     for n in range(2)] == [answer.cause for answer in one]
    assert many.row(1).trap is not None


QUESTIONS = {"fate": stabilab.fate, "extremes": stabilab.extremes, "period": stabilab.period,
             "time to": partial(stabilab.time_to, rate=1.0),
             "spin-up": lambda scene, states: stabilab.spin_up(scene, states[0]), "motion": lambda scene,
             states: stabilab.motion(scene, states[0])}


@pytest.mark.one_in(2)
@pytest.mark.parametrize("question", QUESTIONS)
@pytest.mark.parametrize("moments", [(10, 10, 6), (10.1, 9.9, 6)])
@pytest.mark.parametrize("wheel", [1e160, 1e300])
def test_wheels_whose_squares_are_no_doubles_are_refused_by_every_question(question, moments, wheel):
    scene = Scene(Body(moments), Gyrostat((wheel, .1, .2)), ConstantTorque((.001, .01, .02)))
    with pytest.raises(InputError,
                       match="momenta this large are beyond the range of doubles: choose other units"):
        QUESTIONS[question](scene, np.array([[.05, .01, .01], [.1, 0, 0]]))
