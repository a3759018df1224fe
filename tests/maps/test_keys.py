"""Numbers of a case by name, and the values that they take."""
from __future__ import annotations

import math
import tomllib
from fractions import Fraction

import pytest

from stabilab.case.table import Written
from stabilab.errors import InputError
from stabilab.maps.axes import axis_of, key_of, keys_of
from stabilab.maps.plan import split_keys

TEXT = """
[body]
inertia = [[3.0, 0.1, 0], [0.1, 2.5, 0], [0, 0, "2.0 +- 0.1"]]
[[wheels]]
name = "W1"
axis = [0, 0, 1]
momentum = "0.3 N m s"
[[wheels]]
name = "W2"
axis = [0, 1, 0]
momentum = 0.5
[effects.constant_torque]
torque = [0, 0, 0.1]
[motion]
angular_velocity = [0.1, 0, 1e-3]
"""
DATA = tomllib.loads(TEXT, parse_float=Written)


def test_a_number_is_found_by_the_name_of_its_wheel_by_the_end_of_its_name_and_on_both_sides_of_a_tensor():
    for asked in ("wheels.W1.momentum", " W1 . momentum"):
        assert key_of(DATA, asked).paths == (("wheels", 0, "momentum"),)
    assert key_of(DATA, "torque[3]").name == "effects.constant_torque.torque[3]"
    for asked in ("inertia[1][2]", "inertia[2][1]"):
        assert key_of(DATA, asked).paths == (("body", "inertia", 0, 1), ("body", "inertia", 1, 0))
    data = tomllib.loads(TEXT.replace('"W2"', '"W 2.x"'), parse_float=Written)
    for asked in ("wheels.W 2.x.momentum", "W 2.x.momentum", " wheels.W2.x . momentum"):
        assert key_of(data, asked).paths == (("wheels", 1, "momentum"),)


def test_names_and_truths_are_no_numbers():
    assert not [name for name in keys_of(DATA) if name.endswith("name")]


@pytest.mark.parametrize("asked, words", [("momentum", "may be wheels.W1.momentum, wheels.W2.momentum"),
                                          ("torque", "vary one of them, effects"),
                                          ("wheels.W3.momentum", "did you mean wheels.W"),
                                          ("torqe[3]", "did you mean effects.constant_torque.torque[3]?"),
                                          ("momentun", "did you mean wheels.W"),
                                          ("torqeu[3]", "did you mean effects.constant_torque.torque[3]?"),
                                          ("inertai[3][3]", "did you mean body.inertia[3][3]?"),
                                          ("TORQUE[3]", "did you mean effects.constant_torque.torque[3]?"),
                                          ("torque.3", "did you mean effects.constant_torque.torque[")])
def test_what_is_no_one_number_is_told_with_what_is_near(asked, words):
    with pytest.raises(InputError) as error:
        key_of(DATA, asked)
    assert words in str(error.value)


def values(text, key="torque[3]"):
    return axis_of(key_of(DATA, key), text).values


def test_a_range_has_the_doubles_nearest_to_its_decimals():
    # np.linspace has 0.30000000000000004
    assert values("0:1:11") == tuple(float(Fraction(n, 10)) for n in range(11))


def test_a_logarithmic_range_has_equal_ratios():
    found = values("-0.001:-1000:7:log")
    assert found == tuple(-(10.0 ** n) for n in range(-3, 4))  # the decimals themselves, correctly rounded


def test_a_unit_at_the_end_is_that_of_all():
    axis = axis_of(key_of(DATA, "angular_velocity[1]"), "0:30:31 deg/s")
    assert (axis.values[30], axis.written(30), axis.shown_unit) == (30.0, "30.0 deg/s", "deg/s")
    assert axis_of(key_of(DATA, "angular_velocity[1]"), "1 rpm, 2, 5").written(2) == "5.0 rpm"
    assert axis_of(key_of(DATA, "torque[1]"), [0, 0.5]).shown_unit == "N m"


@pytest.mark.parametrize("text, words", [
    ("0:1:0", "at least one point"), ("", "at least one point"), ("0:1:1", "one point cannot reach"),
    ("1,2,1", "comes twice"), ("0:1:1.5", "start:stop:count"),
    ("0:1", "start:stop:count"), ("-1:1:5:log", "one sign"), ("0:1:3 deg/s", "expected torque (N m)"),
    ("1 N m, 2 mN m", "one unit"), ("a:b:3", "start:stop"),
    ("1:1.0000000000000002:4", "comes twice"), (3.0, "start:stop:count"), ([math.inf], "finite")])
def test_values_that_are_none_are_told(text, words):
    with pytest.raises(InputError) as error:
        values(text)
    assert words in str(error.value) and "effects.constant_torque.torque[3]" in str(error.value)


def test_a_key_ends_at_the_last_equals_sign_as_a_wheels_name_may_have_one():
    assert split_keys(["wheels.a=b.momentum = 0:1:3"]) == [("wheels.a=b.momentum", "0:1:3")]


def test_the_unit_of_every_number_of_a_file_is_one_unit():
    """A table heads its columns with it: of a torque that is N m, whatever else has this dimension."""
    from stabilab.numbers.units import DIMENSIONS, named
    names = [named(dimension) for dimension in DIMENSIONS.values()]
    assert all(name.count("(") <= 1 and " or " not in name for name in names)
