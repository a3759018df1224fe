"""Facts about periods that small faults break: divided differences to rounding, both rules of integration alike."""
from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest

import stabilab
from stabilab.orbit.ball_orbit import Orbit
from stabilab.orbit.extremes.turning_points import interval
from stabilab.orbit.landscape import landscape
from stabilab.orbit.period import arrays as quadrature
from stabilab.orbit.period import modes as period_modes
from stabilab.orbit.period import rules
from stabilab.orbit.period.balls import precise_period
from tests.oracles import energy
from tests.oracles.pairs import scaled
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
    (plain, _), peaked = rules.trapezoidal(modes, span.half), rules.double_exponential(modes, span.half)[0]
    values, found = quadrature.libration_period(land, place, w)
    assert found.all()
    easy = np.isfinite(plain)  # a row with a peak is left to the other rule
    assert easy.sum() > 6
    np.testing.assert_allclose(peaked[easy], plain[easy], rtol=2e-13)
    np.testing.assert_allclose(values, peaked, rtol=2e-13)


@pytest.mark.parametrize("name", ["minor scaled -", "middle scaled +", "middle physical, other sign", "first axis", "second axis"])
@pytest.mark.parametrize("rho", [1e-3, 0.3, 0.49, 0.51, 1.2, 3.0])
def test_a_mirrored_pair_of_nodes_gives_the_second_differences_at_both(name, rho):
    """Sum and difference of the even and the odd part, against the differences themselves, whose formulas are others."""
    land = landscape(ALL[name][0])
    modes, half = period_modes.modes_of(land, np.random.default_rng(3).normal(size=(2, 5))), np.full(5, rho)
    for share in (0.0, 1e-4, 0.2, 0.5):
        even, odd = modes.pair(half, modes.whole(half), share, rho < 0.5)
        left, right = (modes.second_difference(half, np.full(5, s), np.full(5, 1 - s)) for s in (share, 1 - share))
        size = modes.terms(half, np.full(5, 1 - share), np.full(5, share)) + modes.terms(half, np.full(5, share), np.full(5, 1 - share))
        np.testing.assert_allclose(even + odd, left, rtol=0, atol=2e-14 * size.max())
        np.testing.assert_allclose(even - odd, right, rtol=0, atol=2e-14 * size.max())


# A long thin body whose motions pass close over a barrier between two wells: H is small in the middle of the interval.
THIN = stabilab.Scene(stabilab.Body((3.895, 3.766, 0.196)), stabilab.Gyrostat((0, -2.753, -0.167)), stabilab.ConstantTorque((-0.3551, 0, 0)))


def test_motions_that_pass_close_over_a_barrier_have_their_periods_from_balls():
    """Ball arithmetic, which cuts at the barrier and proves its digits, against the rules; the promise of arrays is 1e-11."""
    land, states = landscape(THIN), np.random.default_rng(5).normal(size=(4000, 3)) * [3, 1, 30]
    states = states[stabilab.fate(THIN, states).labels == 0]
    place, w, _ = land.start(states)
    span = interval(land, place, w)
    modes = period_modes.modes_of(land, span.middle)
    (plain, _), values = rules.trapezoidal(modes, span.half), quadrature.libration_period(land, place, w, span)[0]
    hard = np.nonzero(np.isnan(plain) & np.isfinite(values))[0][:12]
    assert len(hard) > 6
    exact = [precise_period(Orbit(land.reduction, states[n]), stabilab.Fate.BOUNDED) for n in hard]
    np.testing.assert_allclose(stabilab.period(THIN, states[hard], fast=False), exact, rtol=1e-11)


def test_rows_that_settle_early_are_not_carried_on_with_the_slow_ones():
    """Nodes times rows that are evaluated: a row as easy as most costs its own nodes, whatever stands beside it."""
    land, states = landscape(THIN), np.random.default_rng(5).normal(size=(4000, 3)) * [3, 1, 30]
    states = states[stabilab.fate(THIN, states).labels == 0]
    place, w, _ = land.start(states)
    span = interval(land, place, w)
    modes = period_modes.modes_of(land, span.middle)
    slow = np.nonzero(np.isnan(rules.trapezoidal(modes, span.half)[0]))[0]

    def places(rows):
        seen, real = [], type(modes).second_difference
        counted = type("Counted", (type(modes),), {
            "second_difference": lambda self, rho, left, right: (seen.append(np.size(left)), real(self, rho, left, right))[1]})
        rules.double_exponential(counted(modes.data[:, rows], modes.sizes[:, rows]), span.half[rows])
        return sum(seen)
    assert len(slow) > 10 and places(slow) == sum(places(slow[n:n + 1]) for n in range(len(slow)))


@pytest.mark.parametrize("a, b, state", [
    (3.846545761245209, 25.295513736469676, ("-0x1.94ba667b95571p+4", "0x1.f595dad344cb2p+1", "0x1.520cbec7a148ap-17")),
    (0.31323180931136274, -29.568055273764834, ("0x1.d916c1102ce7dp+4", "-0x1.59eddc4d730c7p+2", "0x1.a85885ae4c3a0p-25"))])
def test_a_barrier_on_the_way_of_a_long_hyperbola_costs_the_period_no_digits(a, b, state):
    """From beside the centre, where the terms of the energy are small, over a barrier to places where they are large; the oracle in 60 digits."""
    scene, problem = scaled(a, b, (0, -1, 0))
    state = tuple(map(float.fromhex, state))
    exact = float(energy.period(problem, state))
    assert stabilab.period(scene, np.array([state]))[0] == pytest.approx(exact, rel=1e-11)


def test_the_weight_of_a_peak_is_what_a_change_of_h_does_to_the_period():
    land, states = landscape(THIN), np.random.default_rng(5).normal(size=(1000, 3)) * [3, 1, 30]
    place, w, _ = land.start(states[stabilab.fate(THIN, states).labels == 0])
    span = interval(land, place, w)
    modes = period_modes.modes_of(land, span.middle)

    class Lifted(type(modes)):
        def second_difference(self, rho, left, right):
            return super().second_difference(rho, left, right) + 1e-5
    some = np.flatnonzero(span.ok)[:40]
    plain, _, weight = rules.double_exponential(modes.take(some), span.half[some])
    lifted, *_ = rules.double_exponential(Lifted(modes.data[:, some], modes.sizes[:, some]), span.half[some])
    small = weight * 1e-5 < 1e-2
    assert small.sum() > 10
    np.testing.assert_allclose((plain - lifted)[small] / plain[small], 1e-5 * weight[small], rtol=0.03)
