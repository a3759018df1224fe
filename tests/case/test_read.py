"""Case files: what is read exactly, which variables a case is in, and every fault with file, line and key."""
import math
import os
import threading
from fractions import Fraction
from pathlib import Path

import pytest

from stabilab.answers.digits_run import best_reached
from stabilab.answers.simulate import simulate
from stabilab.case.lines import key_lines
from stabilab.case.read import load
from stabilab.errors import CaseError
from tests.shared import TIE

CASES = sorted((Path(__file__).parents[2] / "cases").glob("*.toml"))
BODY = "[body]\ninertia = [2000.0, 1500.0, 1000.0]\n"
WHEEL = "[effects.gyrostat]\nmomentum = [100.0, 0.0, 0.0]\n"
MU = "[effects.constant_torque]\nmu = [0, 0, 1]\n"


@pytest.mark.parametrize("path", CASES, ids=lambda p: p.stem)
def test_every_case_of_the_repository_loads_and_says_what_it_is(path):
    loaded = load(path)
    assert loaded.title and loaded.source and loaded.expect and loaded.state and loaded.span
    assert 15 <= len(loaded.text.splitlines()) <= 40


def test_scaled_case_has_the_papers_a_and_b(case):
    # Amer et al. 2024, eq. (2) with D = (2000, 1500, 1000), u = 1: k1 = 1/4, a = lambda1/500, b =
    # lambda1/250, by hand.
    read = case(BODY + WHEEL + MU + "[motion]\nx = [2.5, 4.0, 0.1]\ntau = [0.0, 15.0]\n")
    assert read.variables == "scaled" and read.scene.exact_ab == (Fraction(1, 5), Fraction(2, 5))
    assert read.scene.exact_mu == (0, 0, 1) and read.state == (2.5, 4.0, 0.1) and read.span == (0.0, 15.0)
    # M3 = D3 sqrt(k k3) with k = 1/12, k3 = 1/2: 1000/sqrt(24), by hand
    assert read.physical.vector("constant_torque")[2] == pytest.approx(1000 / math.sqrt(24), rel=1e-15)


def test_numbers_may_be_exact_strings(case):
    read = case('[scaled]\na = "1/3"\nb = "0.1"\nmu = [0, "2/3", 1e-3]\n[motion]\nx = [0.1, "1/3", 1]\n')
    assert read.scene.exact_ab == (Fraction(1, 3), Fraction(1, 10))
    assert read.scene.exact_mu == (0, Fraction(2, 3), Fraction(1, 1000))
    assert read.state == (0.1, 1 / 3, 1.0) and read.physical is None and read.scaling is None


@pytest.mark.parametrize("motion, torque, variables", [
    ("", "mu = [0, 0, 1]", "scaled"),
    ("", "torque = [0, 0, 1]", "physical"),
    ("[motion]\nangular_velocity = [1, 1, 1]\n", "mu = [0, 0, 1]", "physical"),
    ("[motion]\nx = [1, 1, 1]\n", "torque = [0, 0, 1]", "scaled"),
])
def test_variables_follow_the_motion_and_else_the_torque(case, motion, torque, variables):
    read = case(BODY + f"[effects.constant_torque]\n{torque}\n" + motion)
    assert read.variables == variables == read.scene.variables
    assert read.physical is not None and read.scaling is not None


def test_wheel_off_axis_1_without_a_motion_stays_physical(case):
    assert case(BODY + "[effects.gyrostat]\nmomentum = [0, 1, 0]\n" + MU).variables == "physical"


def test_span_is_converted_between_seconds_and_tau(case):
    # k = 1/12 for this body and u = 1: t = sqrt(12) tau, by hand
    physical = case(BODY + MU + "[motion]\nangular_velocity = [1, 1, 1]\ntau = [1, 2]\n")
    assert physical.span == pytest.approx((math.sqrt(12), 2 * math.sqrt(12)), rel=1e-15)
    scaled = case(BODY + MU + "[motion]\nx = [1, 1, 1]\nspan = [0, 12]\n")
    assert scaled.span == pytest.approx((0, math.sqrt(12)), rel=1e-15)


FAULTS = [
    # text, line, key, words of the message
    (BODY + "[effects.gyrostatt]\nmomentum = [1, 0, 0]\n", 3, "effects.gyrostatt",
     "did you mean gyrostat? Known effects: gyrostat, constant_torque"),
    (BODY + "angular_velocity = [0, 1, 0]\n", 3, "body.angular_velocity", "it is written in [motion]"),
    (BODY + "[start]\nangular_velocity = [0, 1, 0]\n", 3, "start", "it is written in [motion]"),
    (BODY + "[effects.magnet]\nfield = 1\n", 3, "effects.magnet", "here may stand gyrostat, constant_torque"),
    (BODY + "[effects.gyrostat]\nmomentun = [1, 0, 0]\n", 4, "effects.gyrostat.momentun",
     "did you mean momentum?"),
    (BODY + "[effects.gyrostat]\n", 3, "effects.gyrostat", "momentum is missing"),
    (BODY + "[effects.constant_torque]\n", 3, "effects.constant_torque", "expected torque"),
    (BODY + "[effects]\nconstant_torque = 1\n", 4, "effects.constant_torque",
     "expected a table [effects.constant_torque], got the number 1"),
    (BODY + "[effects]\nconstant_torque = [0, 0, 1]\n", 4, "effects.constant_torque", "got a list of 3"),
    ("[effects]\ngyrostat.momentum = [1, 0, 0]\n", None, "", "expected a table [body]"),
    ("[boby]\ninertia = [1, 1, 1]\n" + BODY, 1, "boby", "did you mean body?"),
    ("body = 3\n", 1, "body", "expected a table [body], got the number 3"),
    ("title = 3\n" + BODY, 1, "title", "expected a text in quotes, got the number 3"),
    ("title = 3.5\n" + BODY, 1, "title", "expected a text in quotes, got the number 3.5"),
    ("[body]\n", 1, "body", "inertia is missing"),
    ("[body]\ninertia = 5.0\n", 2, "body.inertia",
     "expected three numbers in square brackets, got the number 5.0"),
    (BODY + '[motion]\nangular_velocity = "0.1, -6e-2 , .3 deg/s"\n', 4, "motion.angular_velocity",
     'got the text "0.1, -6e-2 , .3 deg/s"; write ["0.1 deg/s", "-6e-2 deg/s", ".3 deg/s"]'),
    (BODY + '[motion]\nangular_velocity = "(1 deg/s, 2 rpm, 3 rad/s)"\n', 4, "motion.angular_velocity",
     '3 rad/s)"; write ["1 deg/s", "2 rpm", "3 rad/s"]'),
    (BODY + '[motion]\nangular_velocity = [1, 2, 3]\nspan = "20 min"\n', 5, "motion.span",
     'got the text "20 min"; write [0, "20 min"]'),
    ("[body]\ninertia = [1, 2]\n", 2, "body.inertia", "expected three numbers, got 2"),
    ("[body]\ninertia = [1,\n # half\n -2, 2]\n", 4, "body.inertia",
     "number 2 is -2.0; principal moments are positive"),
    ("[body]\ninertia = [1, nan, 1]\n", 2, "body.inertia", "number 2: expected a finite number, got nan"),
    ("[body]\ninertia = [1, 1e400, 1]\n", 2, "body.inertia", "larger than the largest double"),
    ("[body]\ninertia = [1, 1e-400, 1]\n", 2, "body.inertia", "smaller than the smallest double"),
    ("[body]\ninertia = [1, true, 1]\n", 2, "body.inertia",
     "number 2: expected a number, got the truth value true"),
    ("[body]\ninertia = [1, 1979-05-27, 1]\n", 2, "body.inertia", "got a date or time"),
    ("[body]\ninertia = [1, [1], 1]\n", 2, "body.inertia", "got a list of 1"),
    ('[body]\ninertia = [1, "1/0", 1]\n', 2, "body.inertia", "divides by zero"),
    ('[body]\ninertia = [1, "one", 1]\n', 2, "body.inertia", "expected a decimal or a ratio"),
    ("[body]\ninertia = [1, 0x" + "f" * 6000 + ", 1]\n", 2, "body.inertia", "larger than the largest double"),
    ("[body]\ninertia = [1, 1" + "0" * 6000 + ", 1]\n", 2, "", "more than 4000 digits"),
    ("[body]\ninertia = [1e-300, 1e-300, 1e-300]\n[effects.constant_torque]\ntorque = [1e300, 0, 0]\n", 1,
     "body", "exceed the largest double"),
    (BODY + "[effects.constant_torque]\nmu = [0, 0, 1]\ntorque = [0, 0, 1]\n", 5,
     "effects.constant_torque.torque", "keep one"),
    (BODY + "[motion]\nx = [1, 1, 1]\nangular_velocity = [1, 1, 1]\n", 5, "motion.angular_velocity",
     "keep one"),
    (BODY + "[motion]\nspan = [0, 1]\ntau = [0, 1]\n", 5, "motion.tau", "keep one"),
    (BODY + "[motion]\nangular_velocity = [1, 1, 1]\nspan = [1, 1]\n", 5, "motion.span",
     "expected two increasing numbers"),
    (BODY + "[motion]\nangular_velocity = [1, 1, 1]\nspan = [0, inf]\n", 5, "motion.span",
     "finite number, got inf"),
    (BODY + "[motion]\nx = [1, 1, 1]\n", 4, "motion.x", "undefined without a torque"),
    (BODY + "[motion]\ntau = [1, 2]\n", 4, "motion.tau", "undefined without a torque"),
    ("[body]\ninertia = [1, 1, 1]\n" + MU, 4, "effects.constant_torque.mu", "need D1 > D2 > D3"),
    (BODY + "[effects.gyrostat]\nmomentum = [0, 1, 0]\n" + MU + "[motion]\nx = [1, 1, 1]\n", 8, "motion.x",
     "along axis 1"),
    ("[scaled]\na = 1\nb = 2\nmu = [0, 0, 1]\n" + BODY, 5, "body", "keep one or the other"),
    ("[scaled]\na = 1\nmu = [0, 0, 1]\n", 1, "scaled", "b is missing"),
    ("[scaled]\na = 1\nb = 2\nmu = [0, 0, 1]\n[motion]\nangular_velocity = [1, 1, 1]\n", 6,
     "motion.angular_velocity", "give x"),
    ("[scaled]\na = 1\nb = 2\nmu = [0, 0, 1]\n[motion]\nx = [1, 1, 1]\nspan = [0, 1]\n", 7, "motion.span",
     "give tau"),
    (BODY + "[expect]\nkind = 'point'\n", 4, "expect.kind", "expected one of none, points, curves, all"),
    (BODY + "[expect]\nfaet = 'bounded'\n", 4, "expect.faet", "did you mean fate?"),
    (BODY + "[expect]\naxis = 4\n", 4, "expect.axis", "whole number from 1 to 3"),
    (BODY + "[expect]\nextremes = [[0, 1]]\n", 4, "expect.extremes", "three pairs"),
    (BODY + "[body]\n", 3, "body", "written a second time; the first is in line 1"),
    ("[body]\ninertia = [1, 1, 1]\ninertia = [1, 1, 1]\n", 3, "body.inertia",
     "written a second time; the first is in line 2"),
    ("[body]\ninertia = [1, 1, 1] 3\n", 2, "body.inertia", "3 stands behind the list: take it away"),
    ("[body]\ninertia = [1, 1,\n", 2, "body.inertia",
     "write: inertia = [1, 1] (the bracket at its end is missing)"),
    (b"[body]\n# caf\xe9\ninertia = [1, 1, 1]\n", 2, "", "byte 0xe9 is not UTF-8"),
    ("a = " + "[" * 50000, 1, "", "nested too deeply"),
    ("\n" + ".".join("a" * 30000) + " = 1\n", 2, "", "nested too deeply"),
    ("#" * 200_000, None, "", "longer than 128 KiB"),
    ("", None, "", "expected a table [body]"),
    ("\0", 1, "", "not TOML"),
]


@pytest.mark.parametrize("text, line, key, words", FAULTS,
                         ids=[f"{i}-{f[3][:24]}" for i, f in enumerate(FAULTS)])
def test_fault_names_line_key_and_reason(faults, text, line, key, words):
    found = faults(text)
    assert [(l, k) for l, k, message in found if words in message] == [(line, key)], found


@pytest.mark.parametrize("text", ["1 deg/s, 2 rpm, 3", "1, 2", "1, x, 3", ""])
def test_a_text_that_is_no_list_of_three_is_not_written_as_one(faults, text):
    ((_, _, words),) = faults(BODY + f'[motion]\nangular_velocity = "{text}"\n')
    assert words.endswith(f'got the text "{text}"; write angular_velocity = [x, y, z] with numbers')


def test_all_faults_of_a_file_come_at_once_in_the_order_of_lines(faults):
    text = """titel = "x"
[body]
inertia = [2000.0,
  -1.0,   # lost sign
  -2]
[effects.gyrostatt]
momentum = 1
[effects.gyrostat]
momentum = [1e400, "1/0", true]
[motion]
x = [1, 2]
angular_velocity = [1, 2, 3]
[expect]
axis = 0
"""
    assert [line for line, _, _ in faults(text)] == [1, 4, 5, 6, 9, 9, 9, 11, 12, 14]


def test_missing_file_suggests_its_neighbour(tmp_path):
    (tmp_path / "minor.toml").write_text(BODY)
    with pytest.raises(CaseError, match=r"no such file; did you mean .*minor\.toml\?"):
        load(tmp_path / "miner.toml")


def test_directory_is_refused(tmp_path):
    with pytest.raises(CaseError, match="this is a directory"):
        load(tmp_path)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes with names on this system")
def test_pipe_without_a_writer_does_not_hang(tmp_path):
    os.mkfifo(tmp_path / "pipe.toml")
    caught = []

    def read():
        try:
            load(tmp_path / "pipe.toml")
        except CaseError as error:
            caught.append(str(error))
    worker = threading.Thread(target=read, daemon=True)
    worker.start()
    worker.join(10)
    assert not worker.is_alive() and "a pipe or a device" in caught[0]


@pytest.mark.parametrize("name", ["a\0b.toml", "x" * 5000])
def test_impossible_file_names_are_refused(name):
    with pytest.raises(CaseError, match="cannot be read"):
        load(name)


def test_byte_order_mark_and_carriage_returns_are_no_fault(case):
    assert case(b"\xef\xbb\xbf" + BODY.replace("\n", "\r\n").encode()).variables == "physical"


def test_lines_of_keys_in_every_way_of_writing_them():
    text = '''# first
"quoted.key".sub = """
[not.a.table]
"""
[ a . 'b' ]   # spaced
c = {d = 1, "e" = [1, {f = 2}]}
list = [
  1, # comment ] with bracket
  [2,
   3]
]
[[rows]]
x = 1
[[rows]]
x = 'it''s'
[a]
z = 1979-05-27 07:32:00
'''
    line = key_lines(text).line
    wanted = {("quoted.key", "sub"): 2, ("a", "b"): 5, ("a", "b", "c", "d"): 6,
              ("a", "b", "c", "e", 1, "f"): 6,
              ("a", "b", "list", 0): 8, ("a", "b", "list", 1, 1): 10, ("rows", 0, "x"): 13,
              ("rows", 1, "x"): 15}
    assert {path: line.get(path) for path in wanted} == wanted
    assert not key_lines(text.split("x = 'it")[0]).again


CHARGE = BODY + "[effects.charge]\ncharge = 1\nfield = 1\narm = 1\nangle = {}\n"


@pytest.mark.parametrize("angle", ["0.3", "1.5", "1.6", "2.9", "-2.9", "4.7", "5", "100"])
def test_strength_of_a_charge_has_the_sign_of_the_cosine(case, angle):
    assert case(CHARGE.format(angle)).scene.effect("charge").strength == pytest.approx(math.cos(float(angle)),
                                                                                       rel=1e-15)


@pytest.mark.parametrize("text, line, key, words", [
    (CHARGE.format('"atitude"'), 7, "effects.charge.angle", '"attitude", got "atitude"'),
    (CHARGE.format("0.3").replace("= 1\n", "= 1e160\n"), 3, "effects.charge", "largest double"),
    (BODY + "[effects.newtonian_field]\nlambda = 1e300\nR = 1e-100\n", 3, "effects.newtonian_field",
     "largest double"),
    (BODY + "[effects.gravity]\nweight = 1e300\ncentre_of_mass = [0, 0, 1e300]\n", 3, "effects.gravity",
     "other units"),
    (BODY.replace("00.0", "e-200") + "[effects.gravity]\nweight = 1e200\ncentre_of_mass = [0, 0, 1]\n", 3,
     "effects.gravity", "other units"),
    (BODY + "[effects.liquid_cavity]\ndensity = 1e300\nviscosity = 1e-300\nP0 = 1e30\n", 3,
     "effects.liquid_cavity", "other units")])
def test_numbers_that_are_good_one_by_one_only_are_refused_at_their_effect(faults, text, line, key, words):
    (found,) = faults(text)
    assert found[:2] == (line, key) and words in found[2] and len(found[2]) < 200


TILTED = BODY + """[effects.gravity]
weight = 1
centre_of_mass = [0, 0, 1]
[motion]
angular_velocity = [0, 0, 1]
"""


def test_a_vertical_that_contradicts_the_attitude_is_refused_with_both(faults, case):
    """psi, phi, theta = 0, atan2(-0.6, 0.8), anything has (0.6, 0, 0.8) as third row of Rz(theta) Rx(psi)
    Ry(phi), by hand."""
    (found,) = faults(TILTED + "attitude = [0, 0, 0]\nvertical = [0.6, 0, 0.8]\n")
    assert found[1] == "motion.vertical"
    assert all(w in found[2] for w in ("contradicts attitude", "[0, 0, 1]", "[0.6, 0, 0.8]"))
    assert TILTED.count("\n") + 2 == found[0]
    assert case(TILTED
                + "attitude = [0, -0.643501108793, 2.5]\nvertical = [0.6, 0, 0.8]\n").blocks["gamma"] == (
                    0.6, 0, 0.8)
    # agrees to the decimals given
    assert case(TILTED + "attitude = [0, -0.643501, 0]\nvertical = [0.6, 0, 0.8]\n").blocks
    assert len(faults(TILTED + "attitude = [0, -0.6434, 0]\nvertical = [0.6, 0, 0.8]\n")) == 1


def test_an_attitude_left_out_is_asked_for_where_zero_angles_contradict_the_vertical(faults):
    (found,) = faults(TILTED.replace("inertia", "mass = 1\ninertia")
                      + "vertical = [0.6, 0, 0.8]\nvelocity = [0, 0, 0]\n")
    assert found[1] == "motion.vertical" and "attitude = [0, -0.6435011088, 0]" in found[2]
    (found,) = faults(TILTED + "attitude = [0, -0.643501108793, 0]\n")
    assert "vertical is missing" in found[2] and "[0.6, 0, 0.8]" in found[2]


def test_vertical_is_the_direction_of_the_weight_and_the_message_says_so():
    """A body at rest falls: its centre of mass, beside the fixed point, goes along the weight."""
    text = ("[body]\ninertia = [3, 2, 2]\n[effects.gravity]\nweight = 1\ncentre_of_mass = [1, 0, 0]\n[motion]\n"
            "angular_velocity = [0, 0, 0]\n")
    with pytest.raises(CaseError,
                       match=r"inertial axis 3 \(of the weight, down; of the field; to the centre\)"):
        load(text)
    fallen = simulate(load(f"{text}vertical = [0, 0, 1]\n"), times=[0.5])
    assert fallen.state["gamma"][0, 0] > 0.01


def test_a_motion_in_many_digits_starts_from_the_decimals(case_file):
    path = case_file(TIE, "tie")
    case = load(path)
    found = best_reached(case, [150.0], 15)
    # On the separatrix omega3/omega1 stays 3/4: twice the energy times D2 equals |H|^2 along the motion.
    omega = found.run.state["omega"][0]
    assert found.enough and omega[2] / omega[0] == pytest.approx(0.75, rel=1e-13)


@pytest.mark.parametrize("given, unit", [("[0, 3, 4]", (0, 0.6, 0.8)), ("[0, 0, 2e-9]", (0, 0, 1)),
                                         ("[1, 1, 1]", (3**-0.5,) * 3),
                                         # six decimals stay as they are
                                         ("[0.666667, 0.666667, 0.333333]", (0.666667, 0.666667, 0.333333))])
def test_a_vertical_has_any_length(case_file, given, unit):
    path = case_file(BODY
                     + f"[effects.gravity]\nweight = 1\ncentre_of_mass = [0, 0, "
                       f"1]\n[motion]\nangular_velocity = [0, 0, 1]\nvertical = {given}\n", "own")
    assert load(path).blocks["gamma"] == pytest.approx(unit, abs=1e-16)


def test_systems_of_units_are_named_in_any_case(case_file, stabilab):
    path = case_file(BODY + "[motion]\nangular_velocity = [0.1, 0.2, 0.3]\n", "own")
    assert stabilab("fate", path, "--units",
                    "SI") == stabilab("fate", path, "--units", "si") != stabilab("fate", path)
    path.write_text(path.read_text() + '[output]\nunits = "SI"\n')
    assert load(path).units == "si"
