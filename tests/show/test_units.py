"""The units of people: one home, the definitions of degree, minute and hour, and the decimals that tell two
bounds apart."""
import math
from fractions import Fraction

import pytest

from stabilab import load
from stabilab.errors import InputError
from stabilab.reasons import Angle, Moment, Quantity, Rate, Sentence, Span
from stabilab.show.units import DEG, SCALED, SI, SYSTEMS, bracket, number, units_of

CASE = """[body]
inertia = [12, 9, 5]
[effects.constant_torque]
torque = [0, 0, 0.02]
[motion]
angular_velocity = [0.1, 0.05, 0.02]
"""


def test_rates_angles_and_their_squares_are_those_of_the_degree():
    # pi rad are 180 deg
    assert DEG.rate(math.pi) == "180 deg/s" and SI.rate(math.pi) == "3.14159 rad/s" and SCALED.rate(
        math.pi) == "3.14159"
    assert DEG.angle(math.pi / 6) == "30 deg"
    assert DEG.told(math.pi**2, DEG.of("(rad/s)^2")) == "32400 (deg/s)²"
    assert SI.told(0.7, SI.of("(rad/s)^2")) == "0.7 (rad/s)²"
    assert DEG.vector((0, math.pi, -math.pi), DEG.rates) == "(0, 180, -180) deg/s"


def test_quantities_without_a_turn_are_the_same_in_both_systems():
    for units in (DEG, SI):
        assert (units.energy(0.5), units.torque(2.0)) == ("0.5 J", "2 N m")
    assert (SCALED.energy(0.5), SCALED.told(4.0, SCALED.of("(rad/s)^2")), SCALED.time(7.0)) == (
        "0.5", "4", "7 τ")


def test_a_sentence_has_its_angles_rates_and_times_in_these_units():
    """90 deg are pi/2 rad; the time of a scaled scene is called tau."""
    turns = Sentence("turns", "turns at {rate} from {angle}, by {change} and {acceleration}, at {time}, over {span}")
    right, reason = math.pi / 2, turns(
        rate=Rate(-math.pi / 2), angle=Angle(math.pi), change=Rate((0.0, math.pi / 2)),
        acceleration=Quantity(math.pi / 2, "rad/s^2"), time=Moment(600.0), span=Span(0.0, 1200.0))
    assert DEG.said(reason) == ("turns at -90 deg/s from 180 deg, by (0, 90) deg/s and 90 deg/s², "
                                "at t = 10 min, over 0 to 20 min")
    assert str(reason) == ("turns at -1.5708 rad/s from 3.14159 rad, by (0, 1.5708) rad/s and 1.5708 rad/s^2, "
                           "at t = 600, over s in [0, 1200]")
    assert SYSTEMS["si"].said(turns(time=Moment(2.5), span=Span(0.0, 2.5), rate=right, angle=0, change=0,
                                    acceleration=0)).endswith("at t = 2.5 s, over 0 to 2.5 s")
    assert SCALED.said(Sentence("at", "at {time}")(time=Moment(2.5))) == "at τ = 2.5"
    assert (DEG.of("rad"), SI.of("rad/s"),
            DEG.of("m")) == (("deg", 180 / math.pi), ("rad/s", 1.0), ("m", 1.0))


@pytest.mark.parametrize("seconds, words", [(0.25, "0.25 s"), (32.84379, "32.8438 s"), (119.5, "119.5 s"),
                                            (120, "2 min"), (5400, "90 min"), (7200, "2 h"),
                                            (86400, "24 h"), (864000, "10 day"), (0, "0 s"),
                                            (-600, "-10 min")])
def test_a_time_is_told_in_the_unit_that_suits_it(seconds, words):
    assert DEG.time(seconds) == words and SI.time(seconds).endswith(" s")


def test_a_number_that_is_unbounded_is_told_by_a_word_and_zero_has_no_sign():
    assert number(math.inf) == "unbounded" and number(-math.inf) == "-unbounded" and number(
        -0.0) == "0" and DEG.rate(math.inf) == "unbounded deg/s"
    assert number(15904.7) == "15905" and number(-15904.7,
                                                 3) == "-15905" and number(1.5e6) == "1.5e+06" and number(
                                                     0.00012) == "0.00012"


@pytest.mark.parametrize("low, high", [(16.947771205157505, 16.94777120515751), (1.0, 1.0), (0.1, 0.2),
                                       (99.99999, 100.00001), (1e-7, 1.5e-7), (1 / 3, 1 / 3)])
def test_a_bracket_holds_what_it_encloses(low, high):
    a, b = map(Fraction, bracket(low, high))
    assert a <= Fraction(low) and Fraction(high) <= b and b - a <= Fraction(high) / 1000 + 2 * (
        Fraction(high) - Fraction(low))


def test_a_case_remembers_its_units_and_an_option_overrides_them(stabilab, case_file):
    path = case_file(CASE, "own")
    assert units_of(load(path)).name == DEG.name and "5.72958, 2.86479, 1.14592) deg/s" in stabilab(
        "classify", path)[1]
    path.write_text(CASE + '[output]\nunits = "si"\n')
    assert units_of(load(path)).name == SI.name and "(0.1, 0.05, 0.02) rad/s" in stabilab("classify", path)[1]
    assert "(5.72958, 2.86479, 1.14592) deg/s" in stabilab("classify", path, "--units", "deg")[1]
    code, out, err = stabilab("classify", path, "--units", "grad")
    assert code == 2 and not out and "--units: expected deg, deg/day, rpm, rev/s, si, got 'grad'" in err


@pytest.mark.parametrize("line, words",
                         [('units = "grad"', "expected deg, deg/day, rpm, rev/s, si"), ("units = 3", "expected a text in quotes"),
                                         ('unit = "si"', 'write units = "si"')])
def test_units_of_a_case_that_are_none_are_a_fault_with_its_line(stabilab, case_file, line, words):
    path = case_file(CASE + f"[output]\n{line}\n", "own")
    code, out, err = stabilab("classify", path)
    assert code == 2 and not out and f"{path}:8: output.unit" in err and words in err


@pytest.mark.parametrize("units, one", [("deg/day", 86400 * 180 / math.pi), ("rpm", 60 / math.tau),
                                        ("rev/s", 1 / math.tau)])  # by the definition of each
def test_rates_are_printed_in_any_unit_that_is_asked_for(stabilab, case_file, units, one):
    path = case_file(CASE, "own")
    start = ", ".join(f"{rate * one:.6g}" for rate in (0.1, 0.05, 0.02))
    code, out, _ = stabilab("classify", path, "--units", units)
    assert code == 0 and f"({start}) {units}" in out and " deg/s" not in out and " rad/s" not in out
    path.write_text(CASE + f'[output]\nunits = "{units}"\n')
    assert stabilab("classify", path)[1] == out and units_of(load(path)).name == units


def test_a_free_body_that_turns_slowly_is_in_degrees_per_day_and_with_a_torque_in_degrees_per_second():
    """Toutatis: 0.0012 deg/s."""
    assert units_of(load("cases/toutatis.toml")).name == "deg/day"
    assert units_of(load("cases/geostationary-22n.toml")).name == units_of(load("cases/phone.toml")).name == "deg"


def test_a_scaled_case_has_no_units():
    with pytest.raises(InputError, match="--units"):
        units_of(load("cases/minor-axis-100.toml"), "grad")
    assert units_of(load("cases/minor-axis-100.toml"), "si").name == SCALED.name
