"""How uncertain numbers are told to a reader."""
import json
import math
import re
from fractions import Fraction

from stabilab.show.text import classification
from tests.shared import CASES


def test_an_uncertain_rate_in_degrees_is_told_in_digits_and_not_as_a_long_ratio():
    # 5.7 +- 0.5 deg in rad, with the digits of a double of pi
    half, middle = Fraction(math.pi) / 360, Fraction(math.pi) * 57 / 1800
    assert classification.rounded(middle) == "0.0994838" and classification.rounded(half) == "0.00872665"
    assert classification.rounded(Fraction(1, 3)) == "1/3" and classification.rounded(Fraction(1, 8)) == "0.125"


def test_a_place_of_the_box_is_told_in_six_digits_and_json_has_them_all(stabilab):
    case = CASES / "uncertain-minor-axis.toml"
    text, told = stabilab("fate",
                          case)[1], json.loads(stabilab("fate", case,
                                                        "--json")[1])[0]["uncertain"]["fate"]["witnesses"][-1]
    assert not re.search(r"\d\.\d{6,}",
                         text.split("uncertain:")[1]) and re.search(r"inertia = \d+\.\d\d, ", text)
    assert max(map(len, told["inertia"])) > 12 and f"inertia = {float(told['inertia'][0]):.6g}, " in text


def test_the_first_line_says_whether_the_answer_holds_for_all_that_the_numbers_may_be(stabilab):
    """Those of `fate` and `classify` are recorded."""
    for command in (("extremes",), ("period",), ("when", "--rate", "1.5")):
        assert "middles of the uncertain numbers" in stabilab(command[0], CASES / "uncertain-separatrix.toml",
                                                              *command[1:])[1]
    assert "uncertain" not in stabilab("period", CASES / "minor-axis-100.toml")[1]
