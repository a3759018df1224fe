"""Numbers with units in case files: exact sizes, dimensions, and what is told of a wrong one."""
import math
from fractions import Fraction

import pytest

from stabilab.case.uncertain import plus_minus
from stabilab.errors import InputError
from stabilab.numbers import units


@pytest.mark.parametrize("text, dimension, value",
                         [  # definitions of the units: SI brochure, and NIST SP 811 for foot and pound
    ("22 N", units.FORCE, 22), ("1 mN", units.FORCE, Fraction(1, 1000)), ("5 min", units.TIME, 300),
    ("0.3 N m s", units.MOMENTUM, Fraction(3, 10)),
    ("0.3 Nms", units.MOMENTUM, Fraction(3, 10)), ("2 kg m^2", units.INERTIA, 2),
    ("2 kg*m²", units.INERTIA, 2), ("2 kg m2/s", units.MOMENTUM, 2),
    ("10 cm", units.LENGTH, Fraction(1, 10)), ("1 lbf", units.FORCE, Fraction("4.4482216152605")),
    ("2 in", units.LENGTH, Fraction("0.0508")),
    ("1 slug", units.MASS, Fraction("4.4482216152605") / Fraction("0.3048")),
    ("3 g", units.MASS, Fraction(3, 1000)), ("7", units.FORCE, 7),
    ("1/3 N", units.FORCE, Fraction(1, 3)), ("4 N-m-s", units.MOMENTUM, 4), ("2 1/s", units.PER_SECOND, 2),
    ("1.5e-3 km", units.LENGTH, Fraction(3, 2)),
    ("0.5 rad/s", units.RATE, Fraction(1, 2)), ("0 deg/s", units.RATE, 0)])
def test_decimals_with_a_unit_are_exact(text, dimension, value):
    assert units.quantity(text, dimension) == (value, True)


@pytest.mark.parametrize("text, dimension, turns",
                         [("30 deg/s", units.RATE, Fraction(1, 12)), ("12 rpm", units.RATE, Fraction(1, 5)),
                                                    ("1 rev", units.ANGLE, 1),
                          ("60 arcmin", units.ANGLE, Fraction(1, 360)),
                                                    ("90°", units.ANGLE, Fraction(1, 4)),
                          ("-2 deg s^-1", units.RATE, Fraction(-1, 180))])
def test_turns_are_good_to_240_bits_and_not_called_exact(text, dimension, turns):
    mpmath = pytest.importorskip("mpmath")
    value, exact = units.quantity(text, dimension)
    with mpmath.workprec(400):  # mpmath's pi shares no code with ours
        wanted = 2 * mpmath.pi * turns.numerator / turns.denominator
        assert abs(mpmath.mpf(value.numerator) / value.denominator
                   - wanted) < abs(wanted) * mpmath.mpf(2) ** -240
    assert not exact and float(value) == pytest.approx(2 * math.pi * float(turns), rel=1e-15)


@pytest.mark.parametrize("text, dimension, words", [
    ("3 nweton", units.FORCE, ('unknown unit "nweton"', "accepted are", "deg/s")),
    ("3 NM", units.TORQUE, ('unknown unit "NM"',)),
    ("2 kg", units.FORCE, ("expected force (N)", "got mass (kg)")),
    ("2 deg", units.RATE, ("expected angular velocity (rad/s)", "got angle (rad)")),
    ("2 N", units.NONE, ("expected a number without a unit", "got force (N)")),
    ("5 Hz", units.RATE, ("rad/s, rev/s or 1/s",)),
    ("2 m/s/s", units.VELOCITY, ("divides twice",)), ("2 m kg", units.FORCE, ("got m kg",)),
    ("N", units.FORCE, ("expected a decimal",)),
    ("1e300 Gm", units.LENGTH, ("largest double",))])
def test_a_wrong_unit_is_told_with_what_is_accepted(text, dimension, words):
    with pytest.raises(InputError) as caught:
        units.quantity(text, dimension)
    assert all(word in str(caught.value) for word in words), str(caught.value)


@pytest.mark.parametrize("text", ["12 +- 0.5 N", "12 N +- 0.5 N", "(12 ± 0.5) N", "12 N +- 50 cN",
                                  "0.012 kN +- 0.5 N"])
def test_an_uncertain_number_may_have_its_unit_anywhere(text):
    assert plus_minus(text, units.FORCE) == (12, Fraction(1, 2), True)


@pytest.mark.parametrize("text", ["12.0 +- 3 %", "12.0 N ± 3 %", "12.0 +- 3 % N", "(12.0 +- 3 %) N"])
def test_per_cent_are_of_the_middle(text):
    assert plus_minus(text, units.FORCE) == (12, Fraction(36, 100), True)


@pytest.mark.parametrize("text, words",
                         [("12 N +- 0.5", 'write "12 +- 0.5 N"'), ("12 +- 0.5 kg", "expected force (N)"),
                                         ("12 +- 1 +- 2 N", "expected a number and"),
                          ("12 +- -1 N", "not negative"), ("12 +- 3 % kg", "expected force (N)"),
                                         ("12 N +- 1 kg", "expected force (N)")])
def test_a_wrong_uncertainty_with_a_unit_is_refused(text, words):
    with pytest.raises(InputError) as caught:
        plus_minus(text, units.FORCE)
    assert words in str(caught.value)


@pytest.mark.parametrize("text, dimension, value",
                         [  # counted by hand: 60 s, 3600 s, 86400 s, 604800 s; a tonne is 1000 kg
    ("2 hour", units.TIME, 7200), ("2 Hours", units.TIME, 7200), ("1 hrs", units.TIME, 3600),
    ("3 days", units.TIME, 259200), ("1 WEEK", units.TIME, 604800),
    ("2 weeks", units.TIME, 1209600), ("5 sec", units.TIME, 5), ("5 Seconds", units.TIME, 5),
    ("2 MIN", units.TIME, 120), ("2 minutes", units.TIME, 120),
    ("1.5 t", units.MASS, 1500), ("2 tonnes", units.MASS, 2000), ("3 KG", units.MASS, 3),
    ("3 kgs", units.MASS, 3), ("2 Newtons", units.FORCE, 2),
    ("2 NEWTON METRES", units.TORQUE, 2), ("2 N M S", units.MOMENTUM, 2), ("4 KG M^2", units.INERTIA, 4),
    ("2 newton-meters", units.TORQUE, 2),
    ("1 inch", units.LENGTH, Fraction("0.0254")), ("2 Feet", units.LENGTH, Fraction("0.6096")),
    ("1 lbs", units.MASS, Fraction("0.45359237")),
    ("2 m/sec", units.VELOCITY, 2), ("2 Mg", units.MASS, 2000), ("2 mN", units.FORCE, Fraction(1, 500)),
    ("2 MN", units.FORCE, 2000000)])
def test_words_plurals_and_capitals_are_units_too(text, dimension, value):
    assert units.quantity(text, dimension) == (value, True)


@pytest.mark.parametrize("word, same", [("RPM", "rpm"), ("Rpm", "rpm"), ("DEG/S", "deg/s"),
                                        ("degrees/second", "deg/s"), ("degs/sec", "deg/s"),
                                        ("Rad/s", "rad/s"), ("revolutions per minute", "rev/min"), ("NM", None),
                                        ("REV/MIN", "rev/min")])
def test_turns_in_other_words(word, same):
    if same:
        assert units.quantity(f"7 {word}", units.RATE) == units.quantity(f"7 {same}", units.RATE)
    else:
        with pytest.raises(InputError, match="accepted are|expected"):
            units.quantity(f"7 {word}", units.RATE)


def test_what_works_is_in_the_list_of_the_error():
    """Every unit that the list names is read."""
    with pytest.raises(InputError) as caught:
        units.quantity("3 nweton", units.FORCE)
    named = str(caught.value).split("accepted are ")[1].split(" with the prefixes")[0].split(", ")
    named += [word for part in units.ACCEPTED.split("; ")[1:5] for word in part.split(", ")]
    assert {"week", "t", "slug", "rpm",
            "kg"} <= set(named) and all(units.unit_of(word).size > 0 for word in named)
