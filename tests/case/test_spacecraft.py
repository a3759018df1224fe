"""A spacecraft as an engineer states it: tensor, thrusters, wheels, limits, units; what it adds up to and
what is refused."""
import json
import math
import random
import re
import tomllib
from fractions import Fraction

import numpy as np
import pytest

import stabilab
from stabilab.case.read import load, load_all
from stabilab.errors import CaseError

DIAGONAL = "[body]\ninertia = [3, 2, 1.5]\n"
FULL = "[body]\ninertia = [[3, 0.1, 0], [0.1, 2, 0.2], [0, 0.2, 1.5]]\n"
THRUSTER = '[[thrusters]]\nname = "A1"\nposition = [1, 2, 3]\ndirection = [0, 3, 4]\nforce = "10 N"\n'
WHEEL = '[[wheels]]\naxis = [0, 0, 2]\nmomentum = "0.5 N m s"\n'


def test_thrusters_wheels_and_torques_add_up_exactly(case):
    """(p - c) x F with p - c = (1, 1, 3), F = 10 (0, 3, 4)/5: (4 - 9, -4, 3) 2, by hand; the wheel's axis has
    length 2."""
    read = case(DIAGONAL + "centre_of_mass = [0, 1, 0]\n" + THRUSTER + "stuck = true\n" + WHEEL
                + '[effects.constant_torque]\ntorque = ["1 N m", 0, 0]\n'
                "[effects.gyrostat]\nmomentum = [0, 0, 1]\n")
    assert read.scene.vector("constant_torque") == (-9, -8, 6)
    assert read.scene.vector("gyrostat") == (0, 0, Fraction(3, 2))
    (thruster,), (wheel,) = read.thrusters, read.wheels
    assert thruster.torque == (-10, -8, 6) and thruster.direction == (0, Fraction(3, 5), Fraction(4, 5))
    assert thruster.stuck
    assert wheel.axis == (0, 0, 1) and wheel.momentum == Fraction(1, 2) and wheel.name == "wheel 1"
    assert read.frame.as_given and read.frame.moments == (3, 2, Fraction(3, 2)) and not read.notes
    assert not read.inexact


def test_a_thruster_that_is_not_stuck_does_not_act(case):
    read = case(DIAGONAL + THRUSTER)
    assert read.scene.effect("constant_torque") is None and read.thrusters[0].force == 10
    assert read.notes and "centre_of_mass" in read.notes[0]


def test_force_and_tolerance_may_be_one_number_or_two(case):
    one = case(DIAGONAL + THRUSTER.replace('"10 N"', '"10 N +- 5 %"'))
    two = case(DIAGONAL + THRUSTER + 'force_tolerance = "0.5 N"\n')
    three = case(DIAGONAL + THRUSTER + 'force_tolerance = "5 %"\nmisalignment = 0.01\n')
    assert one.thrusters[0].force_tolerance == two.thrusters[0].force_tolerance == three.thrusters[
        0].force_tolerance == Fraction(1, 2)
    assert three.thrusters[0].misalignment == Fraction(1, 100) and one.thrusters[0].force == 10


def test_a_wheel_may_be_given_by_its_inertia_and_speed(case):
    read = case(DIAGONAL
                + '[[wheels]]\nname = "W"\naxis = [1, 0, 0]\ninertia = 0.01\nspeed = 50\nmomentum = 0.5\n')
    assert read.scene.vector("gyrostat") == (Fraction(1, 2), 0, 0)
    turning = case(DIAGONAL + '[[wheels]]\naxis = [1, 0, 0]\ninertia = 0.01\nspeed = "-3000 rpm"\n')
    assert turning.wheels[0].momentum == pytest.approx(-math.pi) and turning.inexact == ("wheels.speed",)


def test_limits_are_a_rate_or_three(case):
    assert case(DIAGONAL + "[limits]\nrate = 2\n").limits.rate == 2
    assert case(DIAGONAL + "[limits]\nrate = [1, 2, 3]\n").limits.rates == (1, 2, 3)


def test_products_have_the_sign_of_their_convention(case):
    """A positive integral of x y dm pulls the major axis away from the diagonal of the first quadrant: the
    entry is minus it."""
    tensor = case(FULL)
    entries = case(
        "[body]\ninertia = [3, 2, 1.5]\nproducts = {xy = 0.1, yz = 0.2, convention = \"negative\"}\n")
    integrals = case(
        "[body]\ninertia = [3, 2, 1.5]\nproducts = {xy = -0.1, yz = -0.2, convention = \"positive\"}\n")
    assert tensor.frame == entries.frame == integrals.frame and tensor.frame.axes[0][0] * tensor.frame.axes[
        0][1] > 0


def test_the_motion_is_turned_with_the_tensor_and_told_in_both_frames(case, case_file, stabilab):
    read = case(FULL + '[effects.gravity]\nweight = 2\ncentre_of_mass = [0, 0, 0.5]\n[motion]\n'
                'angular_velocity = ["1 deg/s", 0.5, 0]\nvertical = [0, 0.6, 0.8]\nspan = [0, 1]\n')
    for given, vector in ((read.decimals, [math.pi / 180, 0.5, 0]), (read.blocks["gamma"], [0, 0.6, 0.8]),
                          (read.scene.effect("gravity").exact, [0, 0, 1])):
        assert [float(v) for v in read.frame.back(given)] == pytest.approx(vector, abs=1e-15)
    assert read.inexact == ("motion.angular_velocity",)
    path, rates = case_file(FULL + "[motion]\nangular_velocity = [0.3, 0.1, -0.2]\nspan = [0, 1]\n"), [0.3, 0.1, -0.2]
    told = json.loads(stabilab("classify", path, "--json")[1])[0]
    assert told["motion"]["at_input"] == pytest.approx(rates, abs=1e-15)
    assert told["frame"]["moments"] == sorted(told["frame"]["moments"], reverse=True)
    assert np.array(told["frame"]["axes"]) @ rates == pytest.approx(told["motion"]["at"], abs=1e-15)
    assert "in the file's frame" in stabilab("classify", path)[1]
    assert "principal axes 1, 2, 3" in stabilab("show", path)[1]
    run = json.loads(stabilab("simulate", path, "--at", "0", "--json")[1])
    assert run["state_input"]["omega"][0] == pytest.approx(rates, abs=1e-15) and run["frame"] == told["frame"]


def rotation(rng):
    """A rotation of rational numbers, from a quaternion of whole numbers (Cayley)."""
    a, b, c, d = (Fraction(rng.randint(-9, 9)) for _ in range(4))
    n = a * a + b * b + c * c + d * d or 1
    a = a if a or b or c or d else Fraction(1)
    rows = ((a*a + b*b - c*c - d*d, 2*(b*c - a*d), 2*(b*d + a*c)),
            (2*(b*c + a*d), a*a - b*b + c*c - d*d, 2*(c*d - a*b)),
            (2*(b*d - a*c), 2*(c*d + a*b), a*a - b*b - c*c + d*d))
    return [[v / n for v in row] for row in rows]


def written(numbers):
    return "[" + ", ".join(written(v) if isinstance(v, list) else f'"{Fraction(v)}"' for v in numbers) + "]"


def in_frame(turn, moments, torque, wheel, state):
    """The same spacecraft with every vector turned."""
    def vector(v):
        return [sum(turn[i][j] * v[j] for j in range(3)) for i in range(3)]
    tensor = [[sum(turn[i][k] * moments[k] * turn[j][k] for k in range(3)) for j in range(3)]
              for i in range(3)]
    return (f"[body]\ninertia = {written(tensor)}\n[effects.constant_torque]\ntorque = "
            f"{written(vector(torque))}\n[effects.gyrostat]\n"
            f"momentum = {written(vector(wheel))}\n[motion]\nangular_velocity = "
            f"{written(vector(state))}\nspan = [0, 20]\n")


def invariant(extremes, one):
    """An axis may point either way: least and greatest of a component may change places with their signs."""
    for (low, high), (a, b) in zip(extremes, one):
        assert any((low, high) == pytest.approx(pair, rel=1e-12, abs=1e-12) for pair in ((a, b), (-b, -a)))


@pytest.mark.one_in(3)
@pytest.mark.parametrize("torque, wheel",
                         [((0, 0, Fraction(1, 5)), (0, 2, 0)), ((Fraction(1, 10), 0, 0), (0, 0, 0)),
                                           ((Fraction(1, 10), Fraction(1, 5), Fraction(1, 10)),
                                            (Fraction(1, 3), 0, 0))])
def test_the_frame_of_the_input_changes_no_physical_answer(case, torque, wheel):
    """Ten random frames: physics does not know them (moments, fate, margin, period, extremes)."""
    rng, moments, state = random.Random(13), (3, 2,
                                              Fraction(3, 2)), (Fraction(1, 10), Fraction(1, 5),
                                                                Fraction(3, 10))
    read = case(in_frame([[1, 0, 0], [0, 1, 0], [0, 0, 1]], moments, torque, wheel, state))
    base, verdicts = stabilab.motion(read.scene, read.start,
                                     read.span), sorted(p.verdict
                                                        for p in stabilab.equilibria(read.scene).points)
    for _ in range(10):
        turned = case(in_frame(rotation(rng), moments, torque, wheel, state))
        assert turned.frame.moments == moments and turned.frame.exact
        found = stabilab.motion(turned.scene, turned.exact_state, turned.span)
        assert (found.fate.word, found.axis) == (base.fate.word, base.axis)
        for name in ("margin_energy", "period", "margin_velocity"):
            a, b = getattr(found, name), getattr(base, name)
            assert a is b is None or a == pytest.approx(b, rel=1e-9)
        invariant(found.extremes, base.extremes)
        assert sorted(p.verdict for p in stabilab.equilibria(turned.scene).points) == verdicts


def test_an_irrational_frame_changes_no_answer_beyond_rounding(case):
    """Tensor, torque and start along the eigenvector (1, 1, 1) of moment 10, by hand: the torque stays on its
    axis exactly."""
    read = case('[body]\ninertia = [[8, 0, 2], [0, 9, 1], [2, 1, 7]]\n[[thrusters]]\nposition = [1, -1, '
                '0]\ndirection = [1, 1, -2]\nforce = 1\nstuck = true\n'
                "[motion]\nangular_velocity = [0.1, 0.1, 0.1]\nspan = [0, 10]\n")
    assert [v != 0 for v in read.scene.vector("constant_torque")] == [v != 0 for v in read.decimals]
    assert sum(map(bool, read.decimals)) == 1
    assert stabilab.motion(read.scene, read.exact_state, read.span).fate.word == "spin-up"


STUCK = THRUSTER + "stuck = true\n"
MOTION = "[motion]\nangular_velocity = [0.1, 0.2, 0.2]\n"
FAULTS = [
    ("[body]\ninertia = [[3, 0.1, 0], [0.2, 2, 0.2], [0, 0.2, 1.5]]\n", 2, "body.inertia", "not symmetric"),
    ("[body]\ninertia = [[1, 2, 0], [2, 1, 0], [0, 0, 1]]\n", 2, "body.inertia", "not positive definite"),
    ("[body]\ninertia = [[3, 0], [0, 2]]\n", 2, "body.inertia", "three rows of three numbers"),
    ("[body]\ninertia = [[3, 0, 0], [0, 2, 0],\n [0, 0, true]]\n", 3, "body.inertia",
     "row 3, number 3: expected a number"),
    ('[body]\ninertia = [["3 +- 1 %", 0, 0], [0, 2, 0], [0, 0, 2]]\n', 2, "body.inertia",
     "takes no uncertainty"),
    ("[body]\ninertia = [3, 2, 1.5]\nproducts = {xy = 0.1}\n", 3, "body.products",
     '"positive" (the products are the integrals'),
    ("[body]\ninertia = [3, 2, 1.5]\nproducts = {xy = 0.1, convention = 'plus'}\n", 3,
     "body.products.convention", '"negative" (the products are the entries'),
    ("[body]\ninertia = [3, 2, 1.5]\nproducts = {zx = 0.1, convention = 'positive'}\n", 3, "body.products.zx",
     "here may stand xy, xz, yz, convention"),
    (FULL + "products = {xy = 0.1, convention = 'positive'}\n", 3, "body.products", "keep one of them"),
    (DIAGONAL + THRUSTER.replace("[0, 3, 4]", "[0, 0, 0]"), 6, "thrusters.direction", "got zero"),
    (DIAGONAL + THRUSTER.replace("10 N", "10 nweton"), 7, "thrusters.force", "accepted are"),
    (DIAGONAL + THRUSTER.replace("10 N", "10 kg"), 7, "thrusters.force", "expected force (N), got mass (kg)"),
    (DIAGONAL + THRUSTER.replace("10 N", "-10 N"), 7, "thrusters.force", "turn the direction round"),
    (DIAGONAL + THRUSTER + 'misalignment = "90 deg"\n', 8, "thrusters.misalignment", "below 90 deg"),
    (DIAGONAL + THRUSTER + "misalignment = 2\n", 8, "thrusters.misalignment",
     'a number alone is in rad, write "1 deg"'),
    (DIAGONAL + THRUSTER + THRUSTER, 9, "thrusters.name", 'two thrusters have the name "A1"'),
    (DIAGONAL + THRUSTER.replace("position = [1, 2, 3]\n", ""), 3, "thrusters", "position is missing"),
    (DIAGONAL + THRUSTER.replace("position", "postion"), 5, "thrusters.postion", "did you mean position?"),
    (DIAGONAL + THRUSTER + 'stuck = "yes"\n', 8, "thrusters.stuck", "expected true or false"),
    (DIAGONAL + THRUSTER.replace('"10 N"', '"10 N +- 5 %"') + "force_tolerance = 1\n", 8,
     "thrusters.force_tolerance", "keep one"),
    (DIAGONAL + THRUSTER + 'force_tolerance = "-5 %"\n', 8, "thrusters.force_tolerance", "not negative"),
    (DIAGONAL + THRUSTER + 'force_tolerance = "120 %"\n', 8, "thrusters.force_tolerance", "below the force"),
    (DIAGONAL + THRUSTER.replace('"10 N"', '"10 N +- 11 N"'), 7, "thrusters.force", "below the force"),
    ("thrusters = 3\n" + DIAGONAL, 1, "thrusters", "expected tables [[thrusters]]"),
    (DIAGONAL + "[[wheels]]\nmomentum = 1\n", 3, "wheels",
     "axis is missing: add the direction of its momentum"),
    (DIAGONAL + "[[wheels]]\naxis = [0, 0, 0]\nmomentum = 1\n", 4, "wheels.axis", "got zero"),
    (DIAGONAL + "[[wheels]]\naxis = [0, 0, 1]\n", 3, "wheels", "expected momentum (N m s), or inertia"),
    (DIAGONAL + "[[wheels]]\naxis = [0, 0, 1]\nspeed = 3\n", 5, "wheels.speed", "speed alone is not enough"),
    (DIAGONAL + "[[wheels]]\naxis = [0, 0, 1]\nspeed = 3\ninertia = 2\nmomentum = 5\n", 7, "wheels.momentum",
     "contradicts inertia x speed, 6 N m s"),
    (DIAGONAL + "[limits]\nrate = 0.2999999999\n" + MOTION, 4, "limits.rate",
     "the limit, 0.29999999989999998 rad/s"),
    (DIAGONAL + '[limits]\nrate = "10 deg/s"\n' + MOTION, 4, "limits.rate",
     "below the rate that the motion starts with, 0.3 rad/s"),
    (FULL + "[limits]\nrate = [0.15,\n 0.15, 0.3]\n" + MOTION, 5, "limits.rate",
     "number 2: the limit, 0.15 rad/s"),
    (DIAGONAL + "[limits]\nrate = [1, -2, 3]\n", 4, "limits.rate", "positive"),
    (DIAGONAL + "[limits]\nspeed = 3\n", 4, "limits.speed", "unknown key"),
    (DIAGONAL + '[limits]\nrate = "3 N"\n', 4, "limits.rate",
     "expected angular velocity (rad/s), got force (N)"),
    (DIAGONAL + STUCK + "[effects.constant_torque]\nmu = [0, 0, 1]\n", 10, "effects.constant_torque.mu",
     "give torque in N m"),
    (FULL + "[effects.constant_torque]\nmu = [0, 0, 1]\n", 4, "effects.constant_torque.mu",
     "mu counts along principal axes"),
    (FULL + "[effects.charge]\ncharge = 1\nfield = 1\narm = 1\nangle = 0.3\n", 3, "effects.charge",
     "known along principal axes alone"),
    (FULL + "[motion]\nangular_velocity = [1, 1, 1]\nattitude = [0, 0, 0]\n", 5, "motion.attitude",
     "not turned"),
    (DIAGONAL + STUCK.replace("10 N", "1e200 N").replace("[1, 2, 3]", "[1e200, 0, 0]"), 3, "thrusters",
     "largest double"),
    (FULL + "[motion]\nangular_velocity = [1.7e308, 1.7e308, 1.7e308]\n", 4, "motion.angular_velocity",
     "along the principal axes"),
    ("[scaled]\na = 1\nb = 2\nmu = [0, 0, 1]\n" + WHEEL, 5, "wheels", "keep one or the other"),
]


@pytest.mark.parametrize("text, line, key, words", FAULTS, ids=[f"{i}-{f[2]}" for i, f in enumerate(FAULTS)])
def test_a_fault_is_told_with_line_key_and_cure(faults, text, line, key, words):
    assert [(l, k) for l, k, message in faults(text) if words in message] == [(line, key)], faults(text)


def test_a_sweep_may_name_a_thruster(case_file):
    path = case_file(DIAGONAL + STUCK
                     + '[sweep]\n"thrusters.A1.force" = ["10 N", "20 N"]\n"limits.rate" = [1, '
                       '2]\n[limits]\nrate = 3\n', "sweep")
    found = load_all(path)
    assert [(float(c.thrusters[0].force), float(c.limits.rate))
            for c in found] == [(10, 1), (10, 2), (20, 1), (20, 2)]
    path.write_text(path.read_text().replace("20 N", "20 kg"))
    with pytest.raises(CaseError) as caught:
        load_all(path)
    assert caught.value.problems[0].line == 10 and "[sweep]" in caught.value.problems[0].message


def test_uncertain_numbers_beside_hardware_keep_their_box(case):
    """Thrusters and wheels shift the middle of a box and leave its widths."""
    from stabilab.answers.uncertain.boxes import box_of
    read = case('[body]\ninertia = ["3 +- 1 %", 2, "1.5 +- 0.01 kg m^2"]\n' + STUCK
                + '[effects.constant_torque]\ntorque = ["1 +- 0.1 N m", 0, 0]\n')
    box = box_of(read)
    assert box.middle["torque"] == read.scene.vector("constant_torque") and box.half["torque"] == (
        Fraction(1, 10), 0, 0)
    assert box.half["inertia"] == (Fraction(3, 100), 0, Fraction(1, 100))


# -- import

FORTY_TWO = """<<<<<<<<  42: Spacecraft Description File   >>>>>>>>
Own test craft              !  Description
*************** Initial Attitude ***************
NAN                         ! Ang Vel wrt [NL], Att [QA] wrt [NLF]
0.3    0.4    .5            ! Ang Vel (deg/sec)
*************** Body Parameters ***************
1                           ! Number of Bodies
=============== Body 0 ===============
100.0                       ! Mass
100.  200.0  250.0          ! Moments of Inertia (kg-m^2)
1.0  -.5  +2.0              ! Products of Inertia (xy,xz,yz)
0.0  0.0  0.1               ! Location of mass center, m
0.0  2.0  0.0               ! Constant Embedded Momentum (Nms)
*************** Wheel Parameters ***************
1                           ! Number of wheels
=============== Wheel 0 ===============
4.0                         ! Initial Momentum, N-m-sec
1.0   0.0   0.0             ! Wheel Axis Components, [X, Y, Z]
*************** MTB Parameters ***************
0                           ! Number of MTBs
=============== MTB 0 ===============
180.0                       ! Saturation (A-m^2)
*************** Thruster Parameters ***************
1                           ! Number of Thrusters
=============== Thr 0 ===============
 1.5                        ! Thrust Force (N)
-1.0  0.0  0.0              ! Thrust Axis
3                           ! Node
"""
BASILISK = {"ModelTag": "own", "hub": {"mHub": 750.0, "r_BcB_B": [[0.0], [0.0], [0.1]],
                                       "IHubPntBc_B": [900.0, 2.0, 0.0, 2.0, 800.0, 0.0, 0.0, 0.0, 600.0],
                                       "omega_BN_BInit": [0.001, -0.01, 0.03], "sigma_BNInit": [0.1, 0, 0]},
            "thrusters": [{"label": "a", "thrLoc_B": [0.5, 1, 0], "thrDir_B": [0, 0, 1], "MaxThrust": 0.9,
                           "steadyIsp": 226.7}],
            "reactionWheels": {"RW1": {"gsHat_B": [1, 0, 0], "Js": 0.25, "Omega": 52.0}}}


def test_a_spacecraft_of_42_becomes_a_case_with_its_products_turned_round(tmp_path, stabilab):
    (tmp_path / "SC_Own.txt").write_text(FORTY_TWO)
    code, _, err = stabilab("import", tmp_path / "SC_Own.txt", "--out", tmp_path / "own.toml")
    assert code == 0 and all(words in err
                             for words in ("thr 0: 1.5 N", "at node 3")) and "Saturation" not in err
    read = load(tmp_path / "own.toml")
    # minus the products: 42 reads them so
    tensor = [[100, -1, Fraction(1, 2)], [-1, 200, -2], [Fraction(1, 2), -2, 250]]
    from stabilab.numbers.principal import principal_axes
    assert read.frame == principal_axes(
        tensor) and read.title == "Own test craft" and read.scene.body.mass == 100
    assert [float(v) for v in read.frame.back(read.scene.vector("gyrostat"))] == pytest.approx([4, 2, 0])
    assert [float(v)
            for v in read.frame.back(read.decimals)] == pytest.approx([math.radians(v)
                                                                       for v in (0.3, 0.4, 0.5)])


@pytest.mark.parametrize("ending, write",
                         [(".json", json.dumps), (".py", lambda data: f"spacecraft = {data!r}\n"),
                          # a line a key, each of which looks like YAML
                          (".py", lambda data: "# own\nspacecraft = {\n" + ",\n".join(
                              f'    "{key}": {value!r}' for key, value in data.items()) + "}\n")])
def test_a_dictionary_of_basilisk_becomes_a_case(tmp_path, stabilab, ending, write):
    path = tmp_path / f"own{ending}"
    path.write_text(write(BASILISK))
    code, out, err = stabilab("import", path, "--stuck", "a")
    assert code == 0 and all(words in err for words in ("a: steadyIsp", "sigma_BNInit", "hub alone"))
    (tmp_path / "own.toml").write_text(out)
    read = load(tmp_path / "own.toml")
    # (0.5, 1, -0.1) x 0.9 e3
    assert [float(v)
            for v in read.thrusters[0].torque] == pytest.approx([0.9, -0.45, 0]) and read.thrusters[0].stuck
    assert read.wheels[0].name == "RW1" and read.wheels[0].momentum == 13 and sum(read.frame.moments) == 2300


@pytest.mark.parametrize("text, words", [("hello", "expected a NASA 42 spacecraft file"),
                                         ("{}", "IHubPntBc_B"), ("x = {'a': open('b')}", "plain numbers"),
                                         ('{"IHubPntBc_B": [1, 2]}', "nine numbers"),
                                         ('{"IHubPntBc_B": [1, 1, "x"]}', "expected a number"),
                                         ('{"IHubPntBc_B": [1, 1, -9]}', "positive"),
                                         (FORTY_TWO.replace("100.  200.0", "100. x"), "Moments of Inertia")])
def test_what_cannot_be_imported_is_refused(tmp_path, stabilab, text, words):
    path = tmp_path / "own.json"
    path.write_text(text)
    code, _, err = stabilab("import", path)
    assert code == 2 and words in err and "Traceback" not in err


JOINED = """<<<<<<<<  42: Spacecraft Description File   >>>>>>>>
Own chain                   !  Description
*************** Initial Attitude ***************
NAN                         ! Ang Vel wrt [NL], Att [QA] wrt [NLF]
1.0    2.0    3.0           ! Ang Vel (deg/sec)
***************  Dynamics Flags  ***************
REFERENCE                   ! Mass Props referenced to REFPT_CM or REFPT_JOINT
*************** Body Parameters ***************
3                           ! Number of Bodies
=============== Body 0 ===============
10.0                        ! Mass
4.0  5.0  6.0               ! Moments of Inertia (kg-m^2)
0.2  -.1  0.3               ! Products of Inertia (xy,xz,yz)
0.1  0.2  0.3               ! Location of mass center, m
0.0  0.0  1.0               ! Constant Embedded Momentum (Nms)
=============== Body 1 ===============
4.0                         ! Mass
2.0  2.5  3.0               ! Moments of Inertia (kg-m^2)
0.1  0.2  -.3               ! Products of Inertia (xy,xz,yz)
0.0  0.1  -0.2              ! Location of mass center, m
0.5  0.0  0.0               ! Constant Embedded Momentum (Nms)
=============== Body 2 ===============
2.0                         ! Mass
1.0  1.25  1.5              ! Moments of Inertia (kg-m^2)
0.0  0.0  0.0               ! Products of Inertia (xy,xz,yz)
0.3  0.0  0.0               ! Location of mass center, m
0.0  0.0  0.0               ! Constant Embedded Momentum (Nms)
*************** Joint Parameters ***************
=============== Joint 0 ===============
0 1                         ! Inner, outer body indices
2   231   GIMBAL            ! RotDOF, Seq, GIMBAL or SPHERICAL
1   312                     ! TrnDOF, Seq
20.0   30.0    77.0         ! Initial Angles [deg]
0.4    9.0    9.0           ! Initial Displacements [m]
10.0   20.0  30.0  312      ! Bi to Gi Static Angles [deg] & Seq
-15.0  25.0  35.0  123      ! Go to Bo Static Angles [deg] & Seq
0.5   0.6  0.7              ! Position wrt inner body origin, m
0.1  -0.2  0.3              ! Position wrt outer body origin, m
=============== Joint 1 ===============
1 2                         ! Inner, outer body indices
3   321   SPHERICAL         ! RotDOF, Seq, GIMBAL or SPHERICAL
0   123                     ! TrnDOF, Seq
5.0   -50.0    60.0         ! Initial Angles [deg]
9.0    9.0    9.0           ! Initial Displacements [m]
0.0   0.0  0.0  312         ! Bi to Gi Static Angles [deg] & Seq
0.0   90.0  0.0  312        ! Go to Bo Static Angles [deg] & Seq
0.0   1.0  0.0              ! Position wrt inner body origin, m
0.0   0.0  -1.0             ! Position wrt outer body origin, m
*************** Wheel Parameters ***************
1                           ! Number of wheels
=============== Wheel 0 ===============
4.0                         ! Initial Momentum, N-m-sec
0.0   1.0   1.0             ! Wheel Axis Components, [X, Y, Z]
2                           ! Body
*************** Thruster Parameters ***************
1                           ! Number of Thrusters
=============== Thr 0 ===============
 1.5                        ! Thrust Force (N)
0.0  0.0  -1.0              ! Thrust Axis
2                           ! Body
3                           ! Node
"""


def _masses(mass, tensor, centre):
    """Six equal point masses with this mass, centre and tensor: two on each principal axis, at the roots of
    the second moments."""
    moments, axes = np.linalg.eigh(tensor)
    arms = [np.sqrt(3 * (moments.sum() / 2 - m) / mass) * axis for m, axis in zip(moments, axes.T)]
    return mass / 6, [np.array(centre) + sign * arm for arm in arms for sign in (1, -1)]


def _chain(about_origin):
    """(tensor about the common centre, that centre, turns of bodies 1 and 2) of the bodies above, in the
    frame of body 0, by SciPy and point masses."""
    from scipy.spatial.transform import Rotation
    to = lambda sequence, *angles: Rotation.from_euler("".join("XYZ"[int(n) - 1] for n in sequence), angles,
                                                       degrees=True).as_matrix().T
    before = to("312", 10, 20, 30)
    one = to("123", -15, 25, 35) @ to("231", 20, 30, 0) @ before  # two of three angles are free
    # one displacement, along axis 3
    at = np.array([0.5, 0.6, 0.7]) + before.T @ [0, 0, 0.4] - one.T @ [0.1, -0.2, 0.3]
    two = to("312", 0, 90, 0) @ to("321", 5, -50, 60)
    far = np.array([0, 1, 0]) - two.T @ [0, 0, -1]
    turns, origins = [np.eye(3), one, two @ one], [np.zeros(3), at, at + one.T @ far]
    points, weights = [], []
    for turn, origin, (mass, moments, (xy, xz, yz), centre) in zip(turns, origins, (
            (10, (4, 5, 6), (0.2, -0.1, 0.3), (0.1, 0.2, 0.3)),
            (4, (2, 2.5, 3), (0.1, 0.2, -0.3), (0, 0.1, -0.2)),
            (2, (1, 1.25, 1.5), (0, 0, 0), (0.3, 0, 0)))):
        tensor, centre = np.diag(moments) - [[0, xy, xz], [xy, 0, yz], [xz, yz, 0]], np.array(centre)
        if about_origin:
            tensor = tensor - mass * (centre @ centre * np.eye(3) - np.outer(centre, centre))
        weight, places = _masses(mass, tensor, centre)
        points += [origin + turn.T @ place for place in places]
        weights += [weight] * 6
    weights, points = np.array(weights), np.array(points)
    centre = weights @ points / weights.sum()
    arms = points - centre
    return sum(w * (a @ a * np.eye(3) - np.outer(a, a)) for w, a in zip(weights, arms)), centre, turns


@pytest.mark.parametrize("reference", ["REFPT_CM", "REFPT_JOINT"])
def test_several_bodies_are_one_with_their_joints_locked(tmp_path, stabilab, reference):
    (tmp_path / "SC_Own.txt").write_text(JOINED.replace("REFERENCE", reference))
    code, out, err = stabilab("import", tmp_path / "SC_Own.txt")
    assert code == 0 and "3 bodies are combined into one rigid body" in err and "joints locked" in err
    found, (tensor, centre, turns) = tomllib.loads(out), _chain(reference == "REFPT_JOINT")
    assert found["body"]["mass"] == 16 and found["body"]["centre_of_mass"] == pytest.approx(centre, rel=1e-10)
    for row, wanted in zip(found["body"]["inertia"], tensor):
        assert row == pytest.approx(wanted, rel=1e-10)
    assert found["effects"]["gyrostat"]["momentum"] == pytest.approx(turns[0].T @ [0, 0, 1]
                                                                     + turns[1].T @ [0.5, 0, 0], rel=1e-10)
    assert found["wheels"][0]["axis"] == pytest.approx(turns[2].T @ [0, 1, 1], rel=1e-10)
    along = re.search(r"thr 0: 1.5 N along \[(.*?)\]", err)[1]
    assert list(map(float, along.split(","))) == pytest.approx(turns[2].T @ [0, 0, -1], rel=1e-10)


def test_one_of_several_bodies_alone(tmp_path, stabilab):
    path = tmp_path / "SC_Own.txt"
    path.write_text(JOINED.replace("REFERENCE", "REFPT_CM"))
    code, out, err = stabilab("import", path, "--body", 2)
    found, (_, _, turns) = tomllib.loads(out), _chain(False)
    assert code == 0 and found["body"] == {"inertia": [1, 1.25, 1.5], "mass": 2,
                                           "centre_of_mass": [0.3, 0, 0]} and "combined" not in err
    assert found["wheels"] == [{"name": "wheel 0", "axis": [0, 1, 1], "momentum": 4}]
    assert [float(v.split()[0])
            for v in found["motion"]["angular_velocity"]] == pytest.approx(turns[2] @ [1, 2, 3], rel=1e-10)
    assert "wheels" not in tomllib.loads(stabilab("import", path, "--body", 0)[1])
    assert stabilab("import", path, "--body",
                    3)[0] == 2 and "bodies 0 to 2" in stabilab("import", path, "--body", 3)[2]


def test_a_line_with_a_number_too_many_is_named(tmp_path, stabilab):
    path, four = tmp_path / "SC_Own.txt", FORTY_TWO.replace("1.0   0.0   0.0             ! Wheel",
                                                            "0  1.0   0.0   0.0          ! Wheel")
    line = 1 + four.splitlines().index(next(words for words in four.splitlines() if "Wheel Axis" in words))
    path.write_text(four)
    code, _, err = stabilab("import", path)
    assert code == 2
    assert f'SC_Own.txt:{line}: Wheel Axis Components, [X, Y, Z]: expected three numbers, got "0  1.0   0.0   0.0"' in err
    path.write_text(four.replace("4.0                         ! Initial",
                                 "0.0                         ! Initial"))
    code, out, err = stabilab("import", path)
    assert code == 0 and "wheels" not in out and f"line {line}: Wheel Axis" in err
    assert "no momentum and is left out" in err
