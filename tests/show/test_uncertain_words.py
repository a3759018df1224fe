"""How uncertain numbers are told to a reader."""
import math
from fractions import Fraction

from stabilab.show.text import classification


def test_an_uncertain_rate_in_degrees_is_told_in_digits_and_not_as_a_long_ratio():
    # 5.7 +- 0.5 deg in rad, with the digits of a double of pi
    half, middle = Fraction(math.pi) / 360, Fraction(math.pi) * 57 / 1800
    assert classification.rounded(middle) == "0.0994838" and classification.rounded(half) == "0.00872665"
    assert classification.rounded(Fraction(1, 3)) == "1/3" and classification.rounded(Fraction(1, 8)) == "0.125"
