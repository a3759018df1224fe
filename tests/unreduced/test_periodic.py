"""Periodic motions and their multipliers, by SciPy and by what must hold of a flow that keeps volume."""
import math

import numpy as np
import pytest

from stabilab import Body, ConstantTorque, Gyrostat, Scene
from stabilab.unreduced.off_axis import motion
from stabilab.unreduced.periodic import Section, in_the_middle, passage, periodic
from stabilab.unreduced.spin_up.form import centres
from tests.unreduced.spin_up.scenes import rates_of, run

MIDDLE = Scene(Body((1.4, 1, .6)), Gyrostat((0, 0, .193)), ConstantTorque((.01, -.6, .6)))
ISLANDS = {"A": (((1.2412, .3937, 1.3650), (.0987, .8450, .5255), (-.5224, .8309, .1914)),
                 (-1.572, .657, .738)),
           "B": (((.4040, 1.4222, 1.1739), (.9783, .0744, -.1934), (.7499, .6540, .0999)),
                 (1.086, -5.000, 2.545))}


def scene_of(D, M, l):
    return Scene(Body(D), Gyrostat(l), ConstantTorque(M))


def after(scene, start, t):
    return run(rates_of(scene), start, np.array([0, t]), rtol=1e-12)[-1]


def is_periodic(scene, orbit):
    return np.abs(after(scene, orbit.state, orbit.period) - orbit.state).max() < 1e-8


def test_a_passage_and_its_derivative_are_those_of_another_integrator():
    start, section = np.array([-6.4, 6.5, 0.35]), Section(2, 0.3, -1)
    t, y, V = passage(MIDDLE, start, section)
    assert np.allclose(after(MIDDLE, start, t), y,
                       atol=1e-9) and abs(y[2] - 0.3) < 1e-13 and rates_of(MIDDLE)(y.tolist())[2] < 0
    for n in range(3):  # differences of the other integrator's states at the same time
        step = 1e-5 * np.eye(3)[n]
        assert np.allclose((after(MIDDLE, start + step, t) - after(MIDDLE, start - step, t)) / 2e-5, V[:, n],
                           atol=1e-4)


def test_the_periodic_motion_at_the_centre_of_averaging_is_elliptic():
    (centre,) = centres(MIDDLE)
    assert centre.axis == 1
    # about axis 1 of D = (1.4, 1, 0.6), M = (0.01, -0.6, 0.6), l = (0, 0, 0.193), by the linear equations
    P, Q = (1.4 - .6) * centre.spin, (1.4 - 1) * centre.spin
    start = centre.spin, -.6 / Q + math.sqrt(centre.action) * (P / Q) ** .25, (.193 * centre.spin - .6) / P
    orbit = periodic(MIDDLE, start, Section(2, start[2], 1 if rates_of(MIDDLE)(start)[2] > 0 else -1))
    assert orbit.elliptic and is_periodic(MIDDLE, orbit)
    assert abs(np.prod(orbit.multipliers) - 1) < 1e-8  # the flow keeps volume
    assert abs(orbit.state[0] - centre.spin) < 0.15 * abs(centre.spin)  # leading order


@pytest.mark.slow
def test_a_small_change_turns_about_an_elliptic_motion_by_its_angle():
    """The angle that a neighbour's passages gain about the fixed point is that of the multipliers, and it
    stays near."""
    scene = scene_of(*ISLANDS["A"][0])
    orbit = in_the_middle(scene, ISLANDS["A"][1])
    assert is_periodic(scene, orbit) and orbit.elliptic
    x, across, places = np.array(orbit.state), orbit.section.across, []
    x[across[0]] += 1e-4
    for _ in range(200):
        x = passage(scene, x, orbit.section, linear=False)[1]
        places.append((x - orbit.state)[across])
    places = np.array(places)
    assert np.linalg.norm(places, axis=1).max() < 1e-2
    turns = np.count_nonzero(np.diff(np.signbit(places[:, 0]))) / 2
    assert abs(turns - 200 * orbit.angle / (2 * math.pi)) <= 1


@pytest.mark.slow
def test_the_middle_of_a_small_island_is_found_from_a_motion_in_it():
    scene = scene_of(*ISLANDS["B"][0])
    orbit = in_the_middle(scene, ISLANDS["B"][1])
    assert orbit.elliptic and is_periodic(scene, orbit)


def test_no_periodic_motion_is_made_up():
    grows = Scene(Body((1.4, 1, .6)), Gyrostat((0, 0, 0)), ConstantTorque((.5, .6, .62)))
    assert periodic(grows, (9.0, 0.1, 0.1), Section(2, 0.1, 1)) is None


def test_an_undecided_motion_in_an_island_is_told_what_is_in_its_middle():
    found = motion(scene_of(*ISLANDS["A"][0]), ISLANDS["A"][1], follow=5000)
    assert "an island is seen" in found.because and "period 5.5201" in found.because
    assert "elliptic: neighbours turn about it" in found.because
