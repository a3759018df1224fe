"""Bodies with equal moments, spheres, and torques that miss the extremal axes."""
import math
import random

import numpy as np
import pytest

from stabilab import Body, ConstantTorque, Fate, Gyrostat, Scene
from stabilab.unreduced.spin_up.certificate import axis_of_symmetry, equatorial
from stabilab.unreduced.spin_up.follow import spin_up

from .scenes import rates_of, run, sphere


def scene_of(D, l, M):
    return Scene(Body(D), Gyrostat(l), ConstantTorque(M))


@pytest.mark.one_in(2)
@pytest.mark.parametrize("D", [(2, 1.5, 1.5), (1.5, 2, 1.5), (1, 1, 0.7)])
def test_every_state_spins_up_about_an_axis_of_symmetry_without_a_transverse_wheel(D):
    rng, i = random.Random(1), axis_of_symmetry(D)
    wheel = [0, 0, 0]
    wheel[i] = 0.4
    for _ in range(4):
        torque, state = sphere(rng), sphere(rng, 2)
        answer = spin_up(scene_of(D, wheel, torque), state)
        assert (answer.level, answer.fate, answer.axis, answer.steps) == ("exact", Fate.SPIN_UP, i + 1, 0)
        assert answer.sense == math.copysign(1, torque[i])
        states = run(rates_of(scene_of(D, wheel, torque)), state, np.linspace(0, 30, 601))
        for n, (low, high) in enumerate(answer.trap.bounds()):
            assert states[:, n].min() >= low - 1e-7 and states[:, n].max() <= high + 1e-7  # DOP853


def test_without_a_torque_about_the_axis_the_spin_decides():
    scene = scene_of((2, 1.5, 1.5), (0.25, 0, 0), (0, 0.3, 0.4))
    assert spin_up(scene, (1, 0, 0)).fate is Fate.BOUNDED  # X = 1.5 turns the torque round
    still = spin_up(scene, (-0.5, 1, 2))  # X = -0.5 + 0.25/0.5 = 0
    assert still.fate is Fate.SPIN_UP and still.direction == pytest.approx((0, 0.6, 0.8)) and still.axis == 0
    # xi = xi(0) + mu t
    assert np.allclose(run(rates_of(scene), (-0.5, 1, 2), np.array([0, 15.0]))[-1], (-0.5, 1 + 3, 2 + 4))


def test_sphere_grows_along_its_wheel():
    scene = scene_of((2, 2, 2), (0, 0, -3), (1, 0, 0.5))
    answer = spin_up(scene, (1, 1, 1))
    assert (answer.level, answer.axis, answer.sense) == ("exact", 3, 1)  # (M.l) l points along +3
    end = run(rates_of(scene), (1, 1, 1), np.linspace(0, 100, 101))
    assert end[-1][2] == pytest.approx(1 + 0.25 * 100) and np.abs(end[:, :2]).max() < 5


def test_sphere_with_the_torque_across_its_wheel_is_bounded_and_without_wheel_grows_along_the_torque():
    assert spin_up(scene_of((2, 2, 2), (0, 0, 3), (1, 1, 0)), (1, 1, 1)).fate is Fate.BOUNDED
    grows = spin_up(scene_of((2, 2, 2), (0, 0, 0), (3, 4, 0)), (1, 1, 1))
    assert grows.direction == pytest.approx((0.6, 0.8, 0)) and grows.fate is Fate.SPIN_UP


@pytest.mark.parametrize("D, l, M, exists", [((2, 1, 1), (.3, 2, 0), (.2, -1, .1), True),
                                             ((2, 1, 1), (.3, 2, 0), (.2, 1, .1), False),
                                             ((1, 1.5, 1.5), (.3, 2, 0), (.2, 1, .1), True),
                                             ((1.5, 1, 1.5), (1, 0, 2), (0, 1, 0), False)])
def test_equatorial_form_exists_where_the_torque_pushes_the_right_way(D, l, M, exists):
    assert (equatorial(scene_of(D, l, M)) is not None) == exists  # (M_perp.l_perp)(D1 - D2) < 0


def test_symmetric_body_spins_up_in_its_equator_against_its_wheel():
    """D1 > D2: along -l_perp. The certified bounds hold along a run by DOP853."""
    l, M = (0.3, 1.2, 1.6), (0.05, -0.6, -0.7)
    scene = scene_of((2, 1.5, 1.5), l, M)
    e = np.array((0, -0.6, -0.8))
    start = tuple(14 * e + np.array((-l[0] / 0.5, 0.2, -0.1)))
    answer = spin_up(scene, start, 500)
    assert (answer.level, answer.axis, answer.sense) == ("certified", 0, 1)
    assert answer.direction == pytest.approx(tuple(e))
    times = answer.t + np.linspace(0, 40, 401)
    states = run(rates_of(scene), answer.state, times)
    low, high = np.array([answer.trap.line(t) for t in times]).T
    spin = states @ e
    assert (spin > low - 1e-6).all() and (spin < high + 1e-6).all()
    (a, b), *rest = answer.trap.bounds()
    assert (states[:, 0] > a).all() and (states[:, 0] < b).all() and rest == [(-math.inf, math.inf)] * 2
    early, late = answer.trap.clock(30)
    assert early < times[np.argmax(spin >= 30)] + 0.1 and late > times[np.argmax(spin >= 30)] - 0.1


def test_two_fates_share_the_states_of_a_symmetric_body_with_a_transverse_wheel():
    rng, fates = random.Random(5), set()
    scene = scene_of((2, 1.5, 1.5), (0, 1, 0), (0.3, -1, 0.1))
    for start in [sphere(rng, 4) for _ in range(6)] + [(8, *sphere(rng, 2)[1:])]:
        answer = spin_up(scene, start, 1000, 50_000)
        fates.add((answer.level, answer.axis))
    assert {("certified", 1), ("certified", 0)} <= fates


def test_torque_along_the_middle_axis_is_undecided_at_once_and_says_why():
    answer = spin_up(scene_of((3, 2, 1.5), (0, 0, 0), (0, 1, 0)), (1, 2, 3))
    assert answer.level == "undecided" and answer.steps == 0 and "intermediate axis" in answer.cause


def test_torque_near_the_middle_axis_is_decided_about_an_extremal_one():
    answer = spin_up(scene_of((3, 2, 1.5), (0, 0, 0), (0.05, 1, 0.05)), (0.1, 0.2, 0.1))
    assert answer.level == "certified" and answer.axis in (1, 3)


def test_torque_without_a_component_on_one_axis_is_decided_about_the_other():
    answer = spin_up(scene_of((3, 2, 1.5), (0, 0, 0), (0, 0.6, 0.8)), (0.1, 0.2, 0.1))
    # axis 1 has no torque, axis 3 the only form
    assert answer.level == "certified" and (answer.axis, answer.sense) == (3, 1)


def test_no_torque_is_bounded():
    assert spin_up(scene_of((3, 2, 1.5), (1, 0, 0), (0, 0, 0)), (1, 2, 3)).fate is Fate.BOUNDED
