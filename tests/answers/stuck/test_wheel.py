"""Wheel momenta that keep a motion bounded: every end stands between a bounded motion and a spin-up of
another kind of run."""
import math
import random
from fractions import Fraction

import numpy as np
import pytest

from stabilab import Body, ConstantTorque, Gyrostat, Scene, load, stuck
from stabilab.answers.stuck.fate import intervals
from tests.answers.stuck import energy
from tests.answers.stuck.brute import Craft
from tests.oracles import brute
from tests.oracles.model import physical
from tests.shared import craft_file, later

INF = math.inf
D, TORQUE, START = (12, 9, 5), (0, 0, "0.02"), (Fraction("0.1"), Fraction("0.05"), Fraction("0.9"))


def scene(D, wheel, torque):
    return Scene(Body(D), Gyrostat(wheel), ConstantTorque(torque))


def run_is_bounded(D, wheel, torque, start):
    """By an event of a run (`oracles.brute`): turned back against the torque, or round the whole circle."""
    return brute.label(physical(D, wheel, torque), [float(v) for v in start]) == "bounded"


def a_scene(numbers, at_rest=False):
    """(moments, wheel, torque, start, axis of a wheel) with the torque on the major or the minor axis i and
    the wheels across it."""
    while True:
        moments = [Fraction(numbers.randint(20, 100), 10) for _ in range(3)]
        if 2 * max(moments) < sum(moments) and len(set(moments)) == 3:
            break
    i = moments.index(numbers.choice([max, min])(moments))
    torque, wheel, axis = [Fraction(0)] * 3, [Fraction(numbers.randint(-300, 300), 100)
                                              for _ in range(3)], [Fraction(numbers.randint(-3, 3))
                                                                   for _ in range(3)]
    torque[i], wheel[i], axis[i], axis[i - 1] = Fraction(numbers.randint(1, 100),
                                                         numbers.choice([-100, 100])), Fraction(0), Fraction(
                                                             0), Fraction(2)
    start = [Fraction(numbers.randint(-300, 300), 100) for _ in range(3)]
    start[i] = Fraction(0) if at_rest else start[i]
    return moments, wheel, torque, start, axis


@pytest.mark.parametrize("seed", [0, 1, 2, *later(range(3, 40))])
def test_a_run_changes_its_fate_at_every_end(seed):
    moments, wheel, torque, start, axis = a_scene(random.Random(seed))
    found, _ = intervals(scene(moments, wheel, torque), start, axis)
    ends = [end for pair in found for end in pair if math.isfinite(end)]
    for end in ends:
        step = 1e-6 * max(1.0, abs(end))
        inside = [any(low <= s <= high for low, high in found) for s in (end - step, end + step)]
        assert inside in ([True, False], [False, True])
        for s, bounded in zip((end - step, end + step), inside):
            momentum = [float(w + Fraction(s) * a) for w, a in zip(wheel, axis)]
            assert run_is_bounded(moments, momentum, torque, start) == bounded, (s, found)


def test_a_wheel_along_the_torque_keeps_nothing_bounded_but_at_one_momentum():
    """|H|^2/2 - D_i T grows at the rate l_i M_i: README's law of endless growth."""
    given = scene(D, ("0.8", 0, "0.3"), TORQUE)
    found, because = intervals(given, (Fraction("0.1"), Fraction("0.05"), Fraction("0.02")),
                               (Fraction(0), Fraction(0), Fraction(1)))
    assert found == ((-0.3, -0.3),) and "grows for ever" in str(because)
    assert intervals(given, START, (Fraction(1), Fraction(0), Fraction(0)))[0] == ()


def test_a_torque_on_the_middle_axis_is_borne_with_any_momentum():
    found, because = intervals(scene(D, (0, 0, 0), (0, "0.02", 0)), START,
                               (Fraction(1), Fraction(0), Fraction(0)))
    assert found == ((-INF, INF),) and "intermediate axis" in str(because)


def test_a_sphere_is_bounded_where_the_wheels_are_across_the_torque():
    """D omega' = M - omega x l is linear: the part of omega along l grows at the rate M.l/(|l| D)."""
    ball = scene((2, 2, 2), (0, 0, 0), (0, 0, 1))
    ((_, below), (above, _)), _ = intervals(ball, START, (Fraction(1), Fraction(0), Fraction(0)))
    assert (below, above) == (-5e-324, 5e-324)  # without a momentum D omega' = M
    tilted = scene((2, 2, 2), (1, 0, 0), (0, 1, 1))
    assert intervals(tilted, START, (Fraction(0), Fraction(3, 5), Fraction(4, 5)))[0] == ((0.0, 0.0),)


def test_off_the_axes_only_an_equilibrium_is_kept():
    """M = omega x (D omega + l) with omega = (1, 2, 3), l = 7 (0, 0, 1), D = (3, 2, 1.5), by hand: omega x
    (3, 4, 11.5) = (11, -2.5, -2)."""
    given = scene((3, 2, "1.5"), (0, 0, 0), (11, "-2.5", -2))
    found, _ = intervals(given, (Fraction(1), Fraction(2), Fraction(3)),
                         (Fraction(0), Fraction(0), Fraction(1)))
    assert found == ((7.0, 7.0),)
    assert intervals(given, (Fraction(1), Fraction(2), Fraction(2)),
                     (Fraction(0), Fraction(0), Fraction(1)))[0] == ()


def test_a_wheel_across_a_torque_between_two_equal_moments_is_across_it_along_irrational_axes_too(case_file):
    """M . l = 0.4912 0.012666 - 0.3684 0.016888 = 0 in the frame of the file, by hand; DOP853 turns no faster
    in a second time as long as the first."""
    text = craft_file([[97.394176, -1.954368, 4.34304], [-1.954368, 98.534224, 3.25728],
                       [4.34304, 3.25728, 92.7616]],
                      ([-0.42, -0.37, 0.98], [-0.64, -0.48, -0.6], 0.02111), [([0.4912, 0.3684, 0.848], 1)],
                      [0.006743, 0.004293, 0.007586], [0.06, -0.01, 0.18])
    path = case_file(text, "own")
    case = load(path)
    assert not case.frame.exact and sum(m * v for m,
                                        v in zip(case.scene.vector("constant_torque"),
                                                 case.scene.vector("gyrostat"))) == 0
    (row,) = stuck(case).rows
    assert row.fate == "bounded" and row.wheels[0].keeps_bounded == ((-math.inf, math.inf),)
    craft = Craft(text)
    _, craft.start, first = craft.run(12000.0, limit=False, rtol=1e-9)
    assert craft.run(12000.0, limit=False, rtol=1e-9)[2] < 1.2 * first


NEAR = craft_file([1.655, 1.857, 1.658], ([0, 1, 0], [0, 0, 1], 0.11),
                  [([0, 0.659, 1], -0.99), ([0, 0.31652340799234546, 0.9485846995355297], 0)],
                  [-0.991, 0.737, -0.926])


def test_the_momenta_of_a_nearly_symmetric_body_are_found_however_close_together(tmp_path):
    """Two separatrices three millionths apart, by the balance of energy (`energy.fate`); the balls of whole
    cells saw nothing there but what cancels."""
    path, craft = tmp_path / "own.toml", Craft(NEAR)
    path.write_text(NEAR)
    wheel = stuck(load(path)).rows[0].wheels[1]
    (_, low), (high, _) = wheel.keeps_bounded
    assert 1 + 1e-6 < high / low < 1 + 1e-5
    for s in (-3.0, 0.0, low * (1 - 1e-8), low * (1 + 1e-8), math.sqrt(low * high), high * (1 - 1e-8),
              high * (1 + 1e-8), 2.0, 5.0):
        l = craft.l + s * np.array(wheel.axis)
        assert energy.fate(craft.J, craft.torque(), l,
                           craft.start)[0] == ("spin-up" if low < s < high else "bounded")
