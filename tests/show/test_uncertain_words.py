"""How uncertain numbers are told to a reader."""
import json
import math
import re
from fractions import Fraction
from pathlib import Path

from stabilab.show.text import uncertain

CASES = Path(__file__).parents[2] / "cases"


def test_an_uncertain_rate_in_degrees_is_told_in_digits_and_not_as_a_long_ratio():
    # 5.7 +- 0.5 deg in rad, with the digits of a double of pi
    half, middle = Fraction(math.pi) / 360, Fraction(math.pi) * 57 / 1800
    assert uncertain.rounded(middle) == "0.0994838" and uncertain.rounded(half) == "0.00872665"
    assert uncertain.rounded(Fraction(1, 3)) == "1/3" and uncertain.rounded(Fraction(1, 8)) == "0.125"


def test_a_place_of_the_box_is_told_in_six_digits_and_json_has_them_all(stabilab):
    case = CASES / "uncertain-minor-axis.toml"
    text, told = stabilab("fate",
                          case)[1], json.loads(stabilab("fate", case,
                                                        "--json")[1])[0]["uncertain"]["fate"]["witnesses"][-1]
    assert not re.search(r"\d\.\d{6,}",
                         text.split("uncertain:")[1]) and re.search(r"inertia = \d+\.\d\d, ", text)
    assert max(map(len, told["inertia"])) > 12 and f"inertia = {float(told['inertia'][0]):.6g}, " in text


def test_every_uncertain_number_and_every_place_has_its_unit(stabilab):
    text = stabilab("fate", CASES / "uncertain-separatrix.toml")[1]
    for words in ("inertia[1] = 20 ± 0.2 kg m²,", "momentum[1] = 3 ± 0.05 N m s,",
                  "torque[3] = 0.1 ± 0.005 N m,", "velocity[3] = 1.7 ± 0.02 rad/s\n",
                  "inertia = 20, 15, 10 kg m²; momentum = 3, 2, 0 N m s; torque = 0, 0, 0.1 N m; state = "
                  "0.2, 0.15, 1.7 rad/s\n"):
        assert words in text
    scaled = stabilab("fate", CASES / "uncertain-minor-axis.toml")[1]
    assert "mu[3] = 1 ± 0.01, motion.x[1] = 2.5 ± 0.025," in scaled and "state = 2.5, 4, 0.1\n" in scaled


def test_the_first_line_says_whether_the_answer_holds_for_all_that_the_numbers_may_be(stabilab):
    first = lambda command, name: stabilab(command, CASES / f"{name}.toml")[1].split("\n")[0]
    for command in ("fate", "classify"):
        assert first(command,
                     "uncertain-separatrix").endswith(
                         "; BUT within the uncertainties also spin-up about the z axis, positive direction")
        assert first(command,
                     "uncertain-minor-axis").endswith(
                         "; the fate is the same for all that the uncertain numbers may be")
    for command in (("extremes",), ("period",), ("when", "--rate", "1.5")):
        assert "middles of the uncertain numbers" in stabilab(command[0], CASES / "uncertain-separatrix.toml",
                                                              *command[1:])[1]
    assert "uncertain" not in stabilab("period", CASES / "minor-axis-100.toml")[1]
