"""Roots inside a bracket: known roots, and how many evaluations they cost."""
from __future__ import annotations

import math

import numpy as np
import pytest

from stabilab.numbers.polynomial import EPS, between, bracketed_newton, compass_search, halved

# name -> (f, f', bracket, root by hand, rising, most evaluations from the middle)
FUNCTIONS = {
    "a line": (lambda x: 3 * (x - 0.7), lambda x: 0 * x + 3, (0.0, 1.0), 0.7, True, 3),
    "a square": (lambda x: x * x - 2, lambda x: 2 * x, (0.0, 2.0), math.sqrt(2), True, 8),
    "a falling logarithm": (lambda x: -np.log(x / 3), lambda x: -1 / x, (1e-3, 1e3), 3.0, False, 24),
    "a step": (lambda x: np.arctan(1e6 * (x - 0.3)), lambda x: 1e6 / (1 + (1e6 * (x - 0.3)) ** 2), (0.0, 1.0),
               0.3, True, 64),
    "a pole": (lambda x: 1 / x - 100, lambda x: -1 / x**2, (1e-9, 1.0), 0.01, False, 40),
    "a ninth power": (lambda x: (x - 0.6) ** 9, lambda x: 9 * (x - 0.6) ** 8, (0.0, 1.0), 0.6, True, 130),
    "a flat start": (lambda x: x**3 - 1, lambda x: 3 * x**2, (-2.0, 2.0), 1.0, True, 24),
    "negative numbers": (lambda x: x**3 + 8, lambda x: 3 * x**2, (-9.0, -1.0), -2.0, True, 12),
    "an exponential": (lambda x: np.exp(x) - 1e12, np.exp, (0.0, 700.0), math.log(1e12), True, 24),
    "tiny numbers": (lambda x: x * x - 1e-40, lambda x: 2 * x, (0.0, 1.0), 1e-20, True, 80),
}


@pytest.mark.parametrize("name", [name for name in FUNCTIONS if name != "tiny numbers"])  # below its rounding
def test_halving_ends_at_the_root_to_the_last_places_of_the_larger_end(name):
    f, _, (low, high), root, _, _ = FUNCTIONS[name]
    assert halved(f, low, high) == pytest.approx(root, abs=4 * EPS * max(abs(low), abs(high)))


@pytest.mark.parametrize("falls", [1, -1])
@pytest.mark.parametrize("root", [0.0, 1.0])
def test_halving_finds_a_root_at_an_end(root, falls):
    """x - root is 0 at root alone."""
    assert halved(lambda x: falls * (x - root), 0.0, 1.0) == pytest.approx(root, abs=4 * EPS)


def solved(name, start, enough=2 * EPS):
    f, slope, (lo, hi), root, rising, _ = FUNCTIONS[name]
    asked = []

    def fun(x):
        asked.append(len(x))
        return f(x), slope(x)
    return bracketed_newton(fun, np.array([lo]), np.array([hi]), np.array([start]), rising=rising,
                            enough=enough)[0], len(asked)


@pytest.mark.parametrize("part", [0.0, 0.1, 0.5, 0.9, 1.0])
@pytest.mark.parametrize("name", FUNCTIONS)
def test_monotone_functions_give_their_root_from_wherever_the_search_starts(name, part):
    f, slope, (lo, hi), root, _, most = FUNCTIONS[name]
    found, asked = solved(name, lo + part * (hi - lo) if lo + part * (hi - lo) else 1e-30)
    # the function's own rounding moves its root; a ninth power is flat to rounding over some hundredths of it
    blur = 0.02 if name == "a ninth power" else 8 * EPS * max(1.0, abs(root))
    assert abs(found - root) <= blur * min(1.0, abs(root) if name == "tiny numbers" else 1.0)
    assert asked <= (most if part == 0.5 else 2 * most + 60)


def test_a_root_at_an_end_or_at_the_start_is_returned_at_once():
    for lo, hi, start in ((0.5, 2.0, 1.0), (1.0, 2.0, 1.0), (0.0, 1.0, 1.0)):
        asked = []
        found = bracketed_newton(lambda x: (asked.append(1) or x - 1, 0 * x + 1),
                                 *(np.array([v]) for v in (lo, hi, start)))
        assert found[0] == 1.0 and len(asked) == 1


def test_a_coarse_last_step_is_enough_where_newton_converges_quadratically():
    """|f| = x^2 - 2: a step of s leaves s^2/(2 x), so 1e-9 ends one round before rounding."""
    fine, many = solved("a square", 1.5)
    coarse, few = solved("a square", 1.5, enough=1e-9)
    assert abs(coarse - math.sqrt(2)) <= 2 * EPS and abs(fine - math.sqrt(2)) <= 2 * EPS and few < many


def test_each_of_many_has_the_root_it_has_alone_and_leaves_when_it_is_found():
    rng = np.random.default_rng(1)
    target, rising = 10.0 ** rng.uniform(-6, 6, 200), rng.random(200) < 0.5
    target[:3] = 1.0, 4.0, 0.25
    sizes = []

    def fun(x, t, way):
        sizes.append(len(x))
        return way * (x**3 - t), way * 3 * x * x
    way = np.where(rising, 1.0, -1.0)
    ends = np.zeros(200), np.full(200, 1e3)
    start = 10.0 ** rng.uniform(-2, 2, 200)
    found = bracketed_newton(fun, *ends, start, (target, way), rising=rising)
    np.testing.assert_allclose(found, np.cbrt(target), rtol=4 * EPS)
    assert sizes[:5] == [200] * 5 and sizes == sorted(sizes,
                                                      reverse=True) and sizes[-1] < 100 and len(sizes) < 60
    for n in (0, 1, 2, 50, 199):
        alone = bracketed_newton(fun, ends[0][[n]], ends[1][[n]], start[[n]], (target[[n]], way[[n]]),
                                 rising=rising[[n]])
        assert alone[0] == pytest.approx(found[n], rel=4 * EPS)


@pytest.mark.parametrize("lo, hi",
                         [(0.0, 1.0), (-1.0, 0.0), (1.0, 1e12), (-1e12, -1.0), (-5.0, 3.0), (1e-300, 1e300),
                                    (2.0, 3.0), (-1e300, -1e-300), (-1e-8, 1e8), (1.0, 150.0)])
def test_a_point_between_lies_between_and_midway_in_decades_where_the_ends_are_decades_apart(lo, hi):
    x = between(lo, hi)
    assert lo < x < hi
    if lo * hi > 0:
        low, high = sorted((abs(lo), abs(hi)))
        middle = math.sqrt(low) * math.sqrt(high) if high > 100 * low else (low + high) / 2
        assert abs(x) == pytest.approx(middle, rel=1e-15)
    elif lo * hi < 0:
        assert x == pytest.approx((lo + hi) / 2, rel=1e-15)
    else:
        assert 0 < abs(x) < 1e-3  # towards zero: roots there are found in decades


@pytest.mark.parametrize("least", [0.01, 2.0, 6.28])
def test_the_least_value_on_a_circle_is_drawn_nearer_by_half_steps(least):
    looks = [2 * math.pi * n / 12 for n in range(12)]
    size = lambda u: 1 - math.cos(u - least) if math.cos(u - least) > 0 else math.inf
    tried = compass_search(size, [(size(u), u) for u in looks], math.pi / 12, 20, lambda u: u % (2 * math.pi))
    found, place = min(tried)
    assert len(tried) == 12 + 2 * 20 and 0 <= place < 2 * math.pi
    # by hand: 2^-20 pi/6 from it at the most, twice the last step; the size is the half of its square
    assert abs(math.remainder(place - least, 2 * math.pi)) <= 2.0**-20 * math.pi / 6 and found < 1e-12


def test_a_least_value_at_an_end_stays_in_the_range():
    tried = compass_search(lambda u: u, [(u, u) for u in (0.5, 1.5)], 1.0, 5, lambda u: min(max(u, 0.25), 2.0))
    assert min(tried) == (0.25, 0.25)
