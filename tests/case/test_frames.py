"""A case answers alike in whatever frame its file is written: what the rounding of direction cosines leaves decides
nothing, and numbers of a few digits and ratios mean what they say.

Independent means: the same body in its principal axes, turned by SciPy's rotations in doubles; rounded roots, sums
and products by hand.
"""
import math
from fractions import Fraction

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from stabilab import Body, ConstantTorque, Gyrostat, Scene
from stabilab.answers.attitude import attitude
from stabilab.answers.circular_orbit import circular_orbit
from stabilab.answers.equilibria import equilibria
from stabilab.answers.motions.one import motion as motion_of
from stabilab.case.read import read_text
from stabilab.numbers.principal import crossed, principal_axes, rounding, settled, summed

# (moments, wheel, torque, angular velocity), each with zeros or equal numbers that a turned frame hides
EVEN = [
    ((1, 1, 1.5), (0, 0, 0.3), None, (0.1, 0.2, 0.3)),      # oblate, a wheel on its axis
    ((1, 1, 1.5), (0.2, 0, 0.3), None, (0.1, 0.2, 0.3)),
    ((2, 1.2, 1.2), None, (0.02, 0, 0), (0, 0.2, 0)),       # torque on the axis of symmetry
    ((0.7, 0.7, 1.4), (0, 0.1, 0), (0.02, 0, 0), (0.1, 0, 0.3)),  # wheel across a torque, both in the plane
    ((0.7, 0.7, 1.4), (0, 0.1, 0), None, (0, 0.2, 0)),      # at rest along its wheel
    ((3, 2, 1.5), (0, 0.1, 0), None, (0.1, 0.2, 0.3)),
    ((3, 2, 1.5), (0.2, 0, 0.3), (0, 0.02, 0), (0.1, 0, 0.3)),
    ((3, 2, 1.5), None, None, (0, 0.2, 0)),                 # about the intermediate axis, exactly
    ((1.3, 1.3, 1.3), (0, 0, 0.3), (0.02, 0, 0), (0, 0.2, 0)),
]
DIGITS = {"shortest": repr, "13 digits": "{:.13g}".format}


def written(moments, wheel, torque, omega, turn, text=repr):
    row = lambda v: "[" + ", ".join(text(float(x)) for x in v) + "]"
    lines = ["[body]", f"inertia = [{', '.join(map(row, turn @ np.diag(moments) @ turn.T))}]"]
    lines += ["[effects.gyrostat]", f"momentum = {row(turn @ wheel)}"] if wheel else []
    lines += ["[effects.constant_torque]", f"torque = {row(turn @ torque)}"] if torque else []
    return "\n".join([*lines, "[motion]", f"angular_velocity = {row(turn @ omega)}", "span = [0, 10]\n"])


def answers(text):
    case = read_text("turned.toml", text)
    motion, turning, found = motion_of(case), attitude(case), equilibria(case)
    kinds = sorted((curve.name.split()[0], *sorted({one.verdict for one in curve.segments}))
                   for curve in found.curves)
    numbers = [motion.largest, motion.period, turning.rotation_period, turning.precession_period]
    return ((motion.fate.word, turning.mode, found.kind, kinds, sorted(one.verdict for one in found.points),
             [value is None for value in numbers]), [value or 0 for value in numbers])


def alike(scene, seeds, digits):
    words, numbers = answers(written(*scene, np.eye(3)))
    for seed in seeds:
        turn = Rotation.random(random_state=seed).as_matrix()
        found, values = answers(written(*scene, turn, DIGITS[digits]))
        assert found == words, seed
        assert np.allclose(values, numbers, rtol=1e-8), seed


@pytest.mark.one_in(2)
@pytest.mark.parametrize("scene", EVEN)
def test_the_answers_are_those_in_the_principal_axes(scene):
    alike(scene, (1,), "shortest")
    alike(scene, (2,), "13 digits")


@pytest.mark.slow
@pytest.mark.parametrize("digits", DIGITS)
@pytest.mark.parametrize("scene", EVEN)
def test_they_are_so_in_many_frames(scene, digits):
    alike(scene, range(3, 23), digits)


def test_no_frame_gives_an_oblate_body_with_a_wheel_a_long_axis_mode():
    for seed in range(10):
        turn = Rotation.random(random_state=100 + seed).as_matrix()
        case = read_text("oblate.toml", written((1, 1, 1.5), (0, 0, 0.3), None, (0.1, 0.2, 0.3), turn))
        assert len(set(case.frame.moments)) == 2 and attitude(case).mode == "short-axis"


def test_a_scene_in_python_has_equal_moments_and_a_wheel_across_the_torque_as_well():
    turn = Rotation.random(random_state=5).as_matrix()
    scene = Scene(Body((turn @ np.diag([2, 1.2, 1.2]) @ turn.T).tolist()),
                  Gyrostat((turn @ [0, 0.1, 0.2]).tolist()), ConstantTorque((turn @ [0.02, 0, 0]).tolist()))
    assert len(set(scene.body.exact)) == 2
    assert [bool(v) for v in scene.vector("constant_torque")] == [True, False, False]
    assert not scene.vector("gyrostat")[0]


@pytest.mark.parametrize("tensor, gap", [
    ([[1, 0, 0], [0, "1.000000001", 0], [0, 0, 2]], Fraction(1, 10**9)),
    # of ratios and of few digits: moments 1 -+ 1/10^12 by hand
    ([[1, "1e-12", 0], ["1e-12", 1, 0], [0, 0, 2]], Fraction(2, 10**12)),
    ([[2, 0, "1/3000000000000000"], [0, 5, 0], ["1/3000000000000000", 0, 2]], Fraction(2, 3 * 10**15))])
def test_moments_that_the_file_says_are_different_stay_different(tensor, gap):
    found = sorted(principal_axes([[Fraction(v) for v in row] for row in tensor]).moments)
    assert min(b - a for a, b in zip(found, found[1:])) == pytest.approx(gap, rel=1e-12)


def test_rounding_is_shown_by_many_digits():
    assert rounding([Fraction("0.70710678118655")]) >= Fraction(1, 10**14)
    assert rounding([Fraction(0.1)]) >= Fraction(1, 10**17)            # the double nearest to one tenth
    assert not rounding(map(Fraction, ("0.1", "412.317", "2/3", "1e-20", 1000, 0)))


def test_what_cancels_but_for_rounding_is_zero_and_what_does_not_stays():
    tenth, third = Fraction(repr(0.1 * 3)), Fraction("0.3")  # 0.30000000000000004
    assert summed([(tenth, 0, 1), (-third, 0, 1)]) == (0, 0, 2)
    assert summed([(Fraction("0.300000001"), 0, 1), (-third, 0, 1)])[0] == Fraction(1, 10**9)
    right = tuple(map(Fraction, (repr(math.cos(math.pi / 2)), "1", "0")))  # 6.123233995736766e-17
    assert settled(right) == (0, 1, 0) and settled((Fraction(1, 10**17), 1, 0))[0] == Fraction(1, 10**17)
    assert crossed((0, 0, 1), right) == (-1, 0, 0)


def test_two_oblique_wheels_whose_sum_lies_in_a_principal_plane_are_answered_as_their_sum_is(tmp_path):
    lines = ["[body]", "inertia = [0.975, 0.59, 0.889]", "[circular_orbit]", "rate = 0.0072"]
    sign, wheels = 1, []
    for along in ((3, 0.1, 2), (1, -0.1, 4)):  # by hand: y cancels
        wheels.append(np.array(along) * 1e-3)
        size = float(np.linalg.norm(wheels[-1]))
        lines += ["[[wheels]]", f'name = "{sign}"', f"axis = {(wheels[-1] / size).tolist()}",
                  f"momentum = {size!r}"]
        sign += 1
    two, one = tmp_path / "two.toml", tmp_path / "one.toml"
    two.write_text("\n".join(lines))
    one.write_text("\n".join([*lines[:4], "[effects.gyrostat]", "momentum = [0.004, 0, 0.006]"]))
    orbit, once = circular_orbit(two), circular_orbit(one)
    assert orbit.momentum[1] == 0
    assert [one.verdict for one in orbit.equilibria.points] == [one.verdict for one in once.equilibria.points]
    assert np.allclose([one.angles for one in orbit.equilibria.points],
                       [one.angles for one in once.equilibria.points], atol=1e-9)
