"""Functions of exact numbers: what python-flint gives is what mpmath, which shares no code with it, rounds to."""
import random
from fractions import Fraction

import mpmath
import numpy as np
import pytest

from stabilab.numbers.exact import half_unit, precise

RNG = random.Random(7)
PI = precise("pi", bits=380)  # as any long angle near those of the tables
ANGLES = [Fraction(0), Fraction(355, 226), PI / 2, PI, 2 * PI, PI / 3, Fraction(10) ** 30,
          Fraction(1, 10**40),
          *(Fraction(str(round(RNG.uniform(-10, 10), RNG.randrange(1, 12)))) for _ in range(150)),
          *(Fraction(RNG.uniform(-10, 10)) * Fraction(10) ** RNG.randrange(-30, 12) for _ in range(150)),
          *(RNG.randrange(-400, 400) * PI / 180 for _ in range(100))]


def by_mpmath(name, *arguments, bits):
    with mpmath.workprec(bits + 20):
        values = [mpmath.mpf(a.numerator) / a.denominator for a in arguments]
        number = getattr(mpmath.mp, name)
        value = number(*values) if values else +number
        man, exp = value.man_exp  # of the size alone
    return Fraction(-man if value < 0 else man) * Fraction(2) ** exp


@pytest.mark.parametrize("bits", [60, 240, 500])
def test_cosines_and_pi_are_those_of_mpmath_to_the_last_bit(bits):
    assert precise("pi", bits=bits) == by_mpmath("pi", bits=bits)
    wrong = [angle for angle in ANGLES
             if precise("cos", angle, bits=bits) != by_mpmath("cos", angle, bits=bits)]
    assert not wrong


@pytest.mark.parametrize("value, half", [(2.5, "1/20"), (4.5e-05, "1/2000000"), (1.9e22, "500000000000000000000")])
def test_half_a_unit_of_a_numpy_double_is_that_of_its_digits(value, half):
    assert half_unit(np.float64(value)) == half_unit(value) == Fraction(half)
