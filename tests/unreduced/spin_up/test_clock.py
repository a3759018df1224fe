"""Times to a rate and bounds for ever, after the trap."""
import math
import random

import numpy as np
import pytest

from stabilab import Body, ConstantTorque, Gyrostat, Scene
from stabilab.unreduced.spin_up.follow import spin_up

from .scenes import EXAMPLE, random_scene, rates_of, run, sphere


def test_clock_of_the_worked_example_brackets_the_true_time():
    answer = spin_up(EXAMPLE, (6, 1, -1))
    early, late = answer.trap.clock(100)
    assert 260.96 < early < 264.80 < late < 266.65  # true time 264.80; the printed interval is wider


def test_clock_and_lines_bracket_runs():
    rng, seen = random.Random(11), 0
    while seen < 8:
        scene = random_scene(rng)
        answer = spin_up(scene, sphere(rng, 3), 300, 20_000)
        if answer.level != "certified":
            continue
        seen += 1
        times = answer.t + np.linspace(0, 6, 301)
        states = run(rates_of(scene), answer.state, times)
        spin = states @ np.array(answer.direction)
        low, high = np.array([answer.trap.line(t) for t in times]).T
        assert (spin > low - 1e-6).all() and (spin < high + 1e-6).all()  # DOP853
        for n, (a, b) in enumerate(answer.trap.bounds()):
            assert (states[:, n] > a - 1e-6).all() and (states[:, n] < b + 1e-6).all()
        for limit in np.linspace(spin[0], spin[-1], 5)[1:]:
            early, late = answer.trap.clock(limit)
            reached = times[np.argmax(spin >= limit)]
            assert early <= reached + 1e-9 and late >= reached - 0.03


def test_clock_shrinks_when_the_trap_is_a_later_one():
    widths = []
    for after in (0, 50, 200):
        answer = spin_up(EXAMPLE, (6, 1, -1), after=after)
        early, late = answer.trap.clock(100)
        assert answer.t >= after and early < 264.80 < late + 0.01  # true time 264.80
        widths.append(late - early)
    assert widths[1] < 0.5 * widths[0] and widths[2] < 0.5 * widths[1]


@pytest.mark.parametrize("sign", [1, -1])
def test_a_wheel_that_helps_or_hinders_widens_no_time(sign):
    """The drive is M1 + m*/x: over a hundredfold of rates m* moves the time by m* D1/M1^2 ln 100, known to
    both ends whatever its sign, but for the trap's z k, here a twelfth of it."""
    D, l, M = (1.4, 1, .6), tuple(sign * v for v in (.2, .1, -.3)), (.5, .6, .62)
    trap = spin_up(Scene(Body(D), Gyrostat(l), ConstantTorque(M)), (6, 1, -1), after=200).trap
    mean = l[1] * M[1] / (D[0] - D[1]) + l[2] * M[2] / (D[0] - D[2])  # m* of the averaged motion, by hand
    moved = mean * D[0] / M[0] ** 2 * math.log(100)
    (early, late), (earlier, later) = trap.clock(1e6), trap.clock(1e4)
    for gone in (early - earlier, late - later):
        assert gone - (1e6 - 1e4) * D[0] / M[0] == pytest.approx(-moved, rel=0.15)


@pytest.mark.parametrize("D, l, M, w",
                         [((1.1, .58, 1.32), (2.17, -.87, 9.72), (.06, .86, .51), (2.56, 5.02, 8.26)),
                                        ((1.48, .67, .84), (3.2, -4.8, 8.17), (-.6, .69, -.4),
                                         (-.75, -2.06, -2.05))])
def test_about_the_moving_centre_far_times_are_known_as_well(D, l, M, w):
    """What is beside M1 in the drive falls like 1/x, so far limits take M1/D1 alone but for a logarithm; near
    ones by DOP853."""
    scene = Scene(Body(D), Gyrostat(l), ConstantTorque(M))
    answer = spin_up(scene, w, 2000, 30_000)
    trap, spin = answer.trap, np.dot(answer.state, answer.direction)
    assert trap.form == "moving centre"
    early, late = trap.clock(1e6)
    assert early < 1e6 * D[answer.axis - 1] / abs(M[answer.axis - 1]) < late and late - early < 0.005 * late
    limit = spin + 6.0
    early, late = trap.clock(limit)
    times = np.linspace(answer.t, late, 4001)
    reached = times[np.argmax(run(rates_of(scene), answer.state,
                                  times) @ np.array(answer.direction) >= limit)]
    assert early <= reached <= late + 1e-9


def test_a_rate_already_reached_has_no_earliest_time():
    trap = spin_up(EXAMPLE, (6, 1, -1)).trap
    assert trap.clock(1.0) == (0.0, trap.t)


def test_clock_of_a_body_of_revolution_is_the_linear_law():
    scene = Scene(Body((2, 1.5, 1.5)), ConstantTorque((0.5, 0.3, 0.1)))
    answer = spin_up(scene, (-3, 1, 2))
    early, late = answer.trap.clock(10)
    assert early <= 52 <= late and late - early < 1e-9  # omega1 = -3 + t/4
    assert answer.trap.bounds()[0] == (-3, math.inf)


@pytest.mark.parametrize("scale", [2.0**-20, 2.0**15])
def test_clock_keeps_units(scale):
    """The same motion in another unit of time: powers of two, exact."""
    other = Scene(Body((1.4, 1, .6)), Gyrostat([scale * v for v in (.2, .1, -.3)]),
                  ConstantTorque([scale**2 * v for v in (.5, .6, .62)]))
    one, two = spin_up(EXAMPLE, (6, 1, -1)), spin_up(other, [scale * v for v in (6, 1, -1)])
    assert np.allclose(two.trap.clock(100 * scale), np.array(one.trap.clock(100)) / scale, rtol=1e-9)
