"""By which powers of two a motion's rates, time and mass are scaled."""
import math
from fractions import Fraction

import numpy as np
import pytest

from stabilab import Body, ConstantTorque, Gyrostat, Scene
from stabilab.physics.own_unit import (
    exact_unit,
    exponent,
    far_exponent,
    in_unit,
    natural,
    own_exponent,
    own_unit,
    rows_in_unit,
)
from stabilab.physics.scene import euler_coefficients

NUMBERS = [1.0, 0.5, 3.0, 1 - 2.0**-53, 5e-324, 2.0**1023, 1, 7, -8, Fraction(1, 3), Fraction(3, 4),
           Fraction(4, 3), Fraction(-7, 8), Fraction(10)**400, Fraction(1, 10**400), Fraction(2**200 - 1, 2**200)]


@pytest.mark.parametrize("value", NUMBERS)
def test_the_exponent_is_the_least_power_of_two_above_a_number_of_any_kind(value):
    k, size = exponent(value), abs(Fraction(value))
    assert Fraction(2) ** (k - 1) <= size < Fraction(2) ** k  # the definition, in rationals


@pytest.mark.parametrize("seed", range(20))
def test_the_own_exponent_is_above_the_rates_and_the_root_of_their_changes(seed):
    rng = np.random.default_rng(seed)
    rates, changes = (10.0 ** rng.uniform(-100, 100, 3) * rng.integers(-1, 2, 3) for _ in range(2))
    k = own_exponent(rates.tolist(), changes.tolist())
    holds = lambda k: (all(abs(Fraction(v)) < Fraction(2)**k for v in rates)
                       and all(abs(Fraction(v)) < Fraction(4)**k for v in changes))
    assert (k is None) == (not rates.any() and not changes.any())
    assert k is None or (holds(k) and not holds(k - 1))  # the definition, in rationals


def test_what_is_not_finite_has_no_unit():
    assert own_exponent([1.0, math.inf]) is own_exponent([1.0], [math.nan]) is own_exponent([0.0]) is None


@pytest.mark.parametrize("power", [-300, -7, 40, 250])
def test_a_scene_of_another_pace_has_its_unit_as_many_times_as_great(power):
    # law: with moment and rates times u, torque times u^2, the motion is the same in a time 1/u as long
    u, x = Fraction(2) ** power, [Fraction(3), Fraction(-1, 7), Fraction(2, 5)]
    scene = lambda u: Scene(Body((3, 2, "1.5")), Gyrostat((0, 2 * u, 0)), ConstantTorque((0, 0, 5 * u * u)))
    assert exact_unit(scene(u), [u * v for v in x]) == u * exact_unit(scene(1), x)
    assert natural(scene(u))[1] == float(u) * natural(scene(1))[1]
    # by hand: 3 < 2^2 is the largest rate, |2/3 (3 2/5) + ...| < 4^2; sizes of 2^100 and less are ordinary
    assert far_exponent(scene(u), [u * v for v in x]) == (power + 2 if abs(power + 2) > 100 else None)


def test_ordinary_rates_are_followed_in_the_scenes_own_unit():
    scene = Scene(Body((3, 2, "1.5")))
    assert [own_unit(scene, [v, 0.0, 0.0], [0.0] * 3) for v in (2.0**-4, 1.0, 2.0**20 - 1)] == [1.0] * 3
    assert own_unit(scene, [0.75 * 2.0**-4, 0.0, 0.0], [0.0] * 3) == 2.0**-4
    assert own_unit(scene, [1.0, 0.0, 0.0], [0.0, 2.0**43, 0.0]) == 2.0**22  # by hand: (2^43)^(1/2) < 2^22


@pytest.mark.parametrize("seed", range(10))
def test_in_natural_units_moment_and_torque_are_within_a_root_of_two_of_one(seed):
    rng = np.random.default_rng(seed)
    D, M = rng.uniform(1, 2, 3) * 10.0 ** rng.integers(-9, 9), rng.normal(size=3) * 10.0 ** rng.integers(-9, 9)
    own, unit = natural(Scene(Body(D.tolist()), ConstantTorque(M.tolist())))
    mean, torque = sum(own.body.exact) / 3, max(map(abs, own.vector("constant_torque")))
    assert Fraction(1, 2) <= mean * mean <= 2  # the nearest power of two
    assert Fraction(1, 2) <= torque / mean <= 2
    assert max(map(abs, M)) / (D.sum() / 3) == pytest.approx(float(torque / mean) * unit**2, rel=1e-14)


@pytest.mark.parametrize("unit", [2.0**-70, 0.5, 1.0, 2.0**33])
def test_coefficients_in_a_unit_are_those_of_the_scene_in_it(unit):
    """To the last bit: a power of two rounds nothing. Where it may, at the ends of the range, there are none.
    """
    scene = Scene(Body(("1/3", "0.7", 0.9)), Gyrostat((0.3, 0, -0.1)), ConstantTorque((0.2, "1/7", 0)))
    rows = scene.quadratic().coefficients
    assert rows_in_unit(rows, unit) == in_unit(scene, unit, 4.0).quadratic().coefficients
    assert rows_in_unit(rows, 2.0**-600) is None and rows_in_unit(rows, 2.0**600) is None
    halves = Scene(scene.body, Gyrostat((0.5, 0, -0.25)), ConstantTorque((0.75, 0, 0)))
    assert (euler_coefficients(scene.body.exact, rows[0], (0.5, 0.0, -0.25), (0.75, 0.0, 0.0))
            == halves.quadratic().coefficients)
