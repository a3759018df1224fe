"""Ratios in no lowest terms against the standard library's fractions."""
import operator
import random
from fractions import Fraction

import pytest

from stabilab.numbers.ratio import Ratio, ratios

OPERATIONS = operator.add, operator.sub, operator.mul, operator.truediv


def test_formulas_have_the_values_and_the_doubles_of_fractions():
    rng = random.Random(1)
    for _ in range(300):
        numbers = [Fraction(rng.randrange(-99, 99) or 1, rng.randrange(1, 99)), rng.gauss(0, 1e3),
                   Fraction(rng.randrange(1, 9))]
        pool, exact = list(ratios(numbers)), [Fraction(v) for v in numbers]
        for _ in range(12):
            i, j, operation = rng.randrange(len(pool)), rng.randrange(len(pool)), rng.choice(OPERATIONS)
            if operation is operator.truediv and not exact[j]:
                continue
            pool.append(operation(pool[i], pool[j]))
            exact.append(operation(exact[i], exact[j]))
        for item, value in zip(pool, exact):
            assert Fraction(*item.as_integer_ratio()) == value and item.d > 0
            assert float(item) == float(value)  # both correctly rounded
            assert (item < 2, item > -1, bool(item)) == (value < 2, value > -1, bool(value))
            assert Fraction(*(-abs(3 * item) / 7).as_integer_ratio()) == -abs(3 * value) / 7
            assert not value or Fraction(*(5 / item).as_integer_ratio()) == 5 / value


def test_a_vector_has_one_denominator():
    assert {item.d for item in ratios((Fraction(1, 6), 0.75, Fraction(2, 9)))} == {36}


def test_nothing_is_divided_by_0():
    with pytest.raises(ZeroDivisionError):
        Ratio(1) / Ratio(0, 3)
