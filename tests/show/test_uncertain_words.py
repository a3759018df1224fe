"""How uncertain numbers are told to a reader."""
import math
from fractions import Fraction

from stabilab.show.text import uncertain


def test_an_uncertain_rate_in_degrees_is_told_in_digits_and_not_as_a_long_ratio():
    half, middle = Fraction(math.pi) / 360, Fraction(math.pi) * 57 / 1800  # 5.7 +- 0.5 deg in rad, with the digits of a double of pi
    assert uncertain.rounded(middle) == "0.0994837673637" and uncertain.rounded(half) == "0.00872664625997"
    assert uncertain.rounded(Fraction(1, 3)) == "1/3" and uncertain.rounded(Fraction(1, 8)) == "0.125"
