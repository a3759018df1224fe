"""The first crossing of a limit on a piece of a motion that is a known polynomial: roots by hand."""
from fractions import Fraction

from stabilab.integrate.crossing import Search, Threshold


class _Given:
    """A piece that is a known polynomial, 100 bits."""

    start, length, bits = Fraction(0), Fraction(1), 100

    def __init__(self, coefficients, radius=0):
        self.rows = [[round(Fraction(c) * 2**100) for c in coefficients]]
        self.radii, self.sizes = [radius], [sum(map(abs, self.rows[0]))]


def _first(coefficients, limit, radius=0):
    search = Search(Threshold(((Fraction(1), (Fraction(1),)),), Fraction(limit)))
    return search.take(_Given(coefficients, radius)), search


def test_a_simple_root_is_enclosed():
    done, found = _first((0, 1), Fraction(1, 9))  # s^2 = 1/9
    assert done and found.low <= Fraction(1, 3) <= found.high and found.high - found.low < 2**-50


def test_a_hill_that_stays_below_is_passed_and_the_next_one_found():
    # (p - limit) with p = 1 - (s - 1/4)^2 (3/4 - s)... : p(1/4) is short of 1 by 2^-40, the later rise
    # crosses
    top = 1 - Fraction(1, 2**40)
    done, found = _first((top - Fraction(1, 16), Fraction(1, 2), -1 + Fraction(0), 0), 1)  # top - (s - 1/4)^2
    assert not done and found.low is None
    done, found = _first((top - Fraction(1, 16), Fraction(1, 2), -1, 2), 1)
    root = float(found.low)
    assert done and abs(float(top) - (root - 0.25) ** 2 + 2 * root**3 - 1) < 1e-9


def test_a_hill_that_touches_within_the_error_is_a_lower_end_and_no_crossing():
    done, found = _first((1 - Fraction(1, 16), Fraction(1, 2), -1), 1, radius=1 << 20)  # touches 1 at s = 1/4
    assert not done and abs(found.low - Fraction(1, 4)) < Fraction(1, 2**30) and found.high is None


def test_what_falls_is_found_too():
    search = Search(Threshold(((Fraction(1), (Fraction(1),)),), Fraction(1, 2), falls=True, linear=True))
    assert search.take(_Given((1, 0, -1)))
    assert search.low <= Fraction(7071067811865475, 10**16) + Fraction(1, 10**15)
    assert search.high**2 >= Fraction(1, 2)
