"""Facts about periods that small faults break: divided differences to rounding, both rules of integration alike."""
from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest

import stabilab
from stabilab.orbit.extremes.turning_points import interval
from stabilab.orbit.landscape import landscape
from stabilab.orbit.period import arrays as quadrature
from stabilab.orbit.period import modes as period_modes
from tests.orbit.fate.test_fate import FAMILIES
from tests.shared import PARABOLIC

ALL = FAMILIES | PARABOLIC
SHARES = [1e-12, 1e-3, 0.25, 0.4999, 0.5, 0.50001, 0.75, 0.999, 1 - 1e-9]


def second_difference(f, rho, left):
    """f[-rho, rho, y] at y = rho (2 left - 1), in 50 digits."""
    with mp.workdps(50):
        rho, left = mp.mpf(rho), mp.mpf(left)
        y = rho * (2 * left - 1)
        return float((f(y) - f(-rho) * (1 - left) - f(rho) * left) / ((y - rho) * (y + rho)))


@pytest.mark.parametrize("rho", [1e-5, 0.02, 0.45, 0.99, 1.01, 1.6, 2.5, 3.1])
def test_second_differences_of_the_modes_are_right_to_rounding(rho):
    for left in SHARES:
        sides = np.array([rho]), np.array([left]), np.array([1 - left])
        y = sides[0] * (sides[1] - sides[2])
        for k in (1, 2):
            got = period_modes._cos_difference(k, *sides)[0], period_modes._sin_difference(k, rho, y, *sides[1:])[0]
            for value, f in zip(got, (lambda t: mp.cos(k * t), lambda t: mp.sin(k * t))):
                assert value == pytest.approx(second_difference(f, rho, left), abs=3e-15 * k * k)
        assert period_modes._exp_difference(*sides)[0] == pytest.approx(second_difference(mp.exp, rho, left), rel=1.5e-14)


@pytest.mark.parametrize("name", ["minor scaled -", "major physical", "middle scaled +", "middle physical, other sign",
                                  "first axis", "second axis", "third axis"])
@pytest.mark.parametrize("rho", [0.3, 1.2])
def test_the_curvature_of_an_interval_is_that_of_the_potential_between_its_ends(name, rho):
    """(E - V)/((theta - l)(r - theta)) from rises alone, at places where nothing cancels much."""
    land = landscape(ALL[name][0])
    middle, _, _ = land.start(np.random.default_rng(3).normal(size=(5, 3)))
    modes, force = period_modes.modes_of(land, np.array(middle)), land.potential.force(middle)
    rise = lambda y: land.potential.rise(np.full(5, y), middle, force)
    for left in (0.2, 0.5, 0.9):
        y = rho * (2 * left - 1)
        exact = (rise(y) - rise(-rho) * (1 - left) - rise(rho) * left) / ((y - rho) * (y + rho))
        got = modes.second_difference(np.full(5, rho), np.full(5, left), np.full(5, 1 - left))
        size = modes.terms(np.full(5, rho), np.full(5, left), np.full(5, 1 - left))
        np.testing.assert_allclose(got, exact, rtol=0, atol=1e-12 * size.max())
        assert (np.abs(got) <= size * (1 + 1e-9)).all()


@pytest.mark.parametrize("name", ["minor scaled +", "minor physical, other sign", "major physical", "middle scaled +",
                                  "middle physical, other sign", "first axis", "second axis"])
def test_the_trapezoidal_and_the_double_exponential_rule_give_the_same_periods(name):
    """Geometric convergence in the middle of the well against a rule for peaks at the ends."""
    scene = ALL[name][0]
    land = landscape(scene)
    states = np.random.default_rng(8).normal(size=(60, 3)) * 2
    states = states[stabilab.fate(scene, states).labels == 0][:8]
    place, w, _ = land.start(states)
    span = interval(land, place, w)
    modes = period_modes.modes_of(land, span.middle)
    plain, peaked = quadrature._midpoint(modes, span.half), quadrature._double_exponential(modes, span.half)
    values, found = quadrature.libration_period(land, place, w)
    assert found.all()
    np.testing.assert_allclose(peaked, plain, rtol=2e-13)
    np.testing.assert_allclose(values, plain, rtol=2e-13)
