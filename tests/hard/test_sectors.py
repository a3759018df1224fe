"""The hard cases 5, 10 and 11: invariant planes of the middle axis, torques off the axes, cancellation, cusp,
minute orbits.

Answers from 60 to 300-digit oracles; that straightforward code goes wrong there is shown line by line in
`hard_table`.
"""
from __future__ import annotations

import math

import numpy as np
import pytest

import stabilab
from stabilab import Fate
from tests.oracles.pairs import agrees, scaled

SPIN_UP, UNDECIDED = int(Fate.SPIN_UP), int(Fate.UNDECIDED)


# 5. Middle axis next to the invariant planes


@pytest.mark.one_in(2)
@pytest.mark.parametrize("tiny", [1e-3, 1e-8, 1e-15, 1e-30, pytest.param(1e-100, marks=pytest.mark.slow),
                                  pytest.param(1e-300, marks=pytest.mark.slow)])
@pytest.mark.parametrize("y", [1.0, *(pytest.param(y, marks=pytest.mark.slow) for y in (-2.0, 0.125))])
def test_case_5_a_state_a_hair_off_the_spin_up_plane_turns_back(tiny, y):
    """x1 + b = y + tiny exactly, x3 = -y: C = 2 y tiny. In doubles x1 + b rounds to y, and the state looks as
    if on the plane; cosh and sinh of an angle near ln(1/tiny)/2 overflow or cancel. Proof of "bounded": U
    grows on both sides."""
    pair = scaled(0.25, tiny, (0, 1, 0))
    digits = 120 + int(-1.2 * math.log10(tiny))
    words = agrees(pair, [(y, s, -y) for s in (0.5, -1.0, 0.0)], digits=digits, period=tiny >= 1e-30)
    assert words == ["bounded"] * 3
    assert np.all(np.isfinite(stabilab.extremes(pair[0], np.array([y, 0.5, -y]))))


@pytest.mark.one_in(2)
@pytest.mark.parametrize("x3", [1e-15, 1e-12, 1e-8, -1e-15])
def test_case_5_states_with_an_invariant_of_1e_minus_30_are_bounded(x3):
    """Both Y = x1 + b and x3 nearly vanish: almost pure spin, which would go on for ever."""
    pair = scaled(0.5, 1.0, (0, 1, 0))
    agrees(pair, [(-1.0, 0.5, x3), (-1.0, -3.0, x3), (-1.0 + abs(x3) * 2, 0.5, x3)], digits=200)


@pytest.mark.parametrize("y, c, spins",
                         [(1.0, 0.5, True), (-2.0, 1.5, True), (3.0, -1.0, True), (-1.5, 3.0, True)])
def test_case_5_on_the_plane_itself_the_motion_spins_up(y, c, spins):
    """Y = -x3 exactly (mu2 = 1): all of the plane for |c| < 2 or c Y < 0 (theory)."""
    pair = scaled(0.0, c, (0, 1, 0))
    words = agrees(pair, [(y - c, v, -y) for v in (0.5, -0.75, 3.0)], extremes=False)
    assert words == ["spin-up"] * 3


def test_case_5_part_of_the_plane_is_captured_when_c_exceeds_two():
    """|c| > 2 and c Y > 0: a well opens on the plane Y = -x3; its states are bounded, faster ones spin up."""
    c = 3.0
    pair = scaled(0.0, c, (0, 1, 0))
    words = agrees(pair, [(y - c, v, -y) for y in (0.5, 1.0, 2.0, 2.5) for v in (0.0625, -0.25, 1.0, 6.0)],
                   extremes=False)
    assert {"bounded", "spin-up"} <= set(words)


@pytest.mark.parametrize("y", [0.5, 1.0, -2.0])
def test_case_5_on_the_other_plane_the_motion_is_periodic(y):
    """Y = +x3: (x2^2 + x3^2)/2 - c x3 - ln|x3| is constant (theory); closed level lines."""
    c = 0.75
    pair = scaled(0.0, c, (0, 1, 0))
    state = (y - c, 0.5, y)
    assert agrees(pair, [state]) == ["bounded"]
    (low, high) = stabilab.extremes(pair[0], np.array(state))[2]
    def level(v):
        return v * v / 2 - c * v - math.log(abs(v))
    assert level(low) == pytest.approx(level(high), rel=1e-11)
    assert level(high) == pytest.approx(0.125 + level(y), rel=1e-11)


# 10. Torque a hair off a principal axis


@pytest.mark.one_in(3)
@pytest.mark.parametrize("off", [1e-9, -1e-12, 1e-300])
def test_case_10_a_torque_off_the_axis_by_any_amount_is_not_rounded_to_the_axis(off):
    """Isolated equilibria, at distance 1/off, and no integral: a label from the reduced motion would be a
    guess."""
    scene, _ = scaled(0.2, 0.4, (0, off, 1))
    result = stabilab.fate(scene, np.array([2.5, 4.0, 0.1]))
    assert result.labels == UNDECIDED and result.because


# 11. Cancellation between a and b, circles without a radius, the cusp, minute orbits


@pytest.mark.one_in(3)
@pytest.mark.parametrize("mu", [(0, 0, 1), (0, 0, -1), (0, 1, 0)])
@pytest.mark.parametrize("base", [1e8, -1e8, 2.0 ** 40])
def test_case_11_a_and_b_of_order_1e8_with_a_difference_of_order_one(base, mu):
    """Everything depends on c = b - a; x1 + a loses eight digits when formed from rounded parts."""
    pair = scaled(base, base + 0.75, mu)
    states = np.random.default_rng(12).normal(size=(6, 3)) * 2 - (base, 0, 0)
    agrees(pair, states, tolerance=1e-11)


@pytest.mark.parametrize("radius", [0.0, 1e-8, 1e-160, 5e-324])
@pytest.mark.parametrize("speed", [0.0, 0.5, -2.0])
def test_case_11_circles_of_no_or_hardly_any_radius_spin_up_without_nan(radius, speed):
    """The angle atan2(0, 0) has no meaning; the motion has: x3' = 1 + O(radius)."""
    scene, _ = scaled(0.0, 0.5, (0, 0, 1))
    state = np.array([0.0, radius, speed])  # X = x1 + a = 0
    result = stabilab.fate(scene, state)
    assert result.labels == SPIN_UP and result.margins == -np.inf
    box = stabilab.extremes(scene, state)
    assert box[2, 1] == np.inf
    assert box[2, 0] == pytest.approx(min(speed, 0.0) if speed < 0 else speed, rel=1e-7)
    np.testing.assert_allclose(box[:2], [[-radius, radius]] * 2, rtol=1e-11)


@pytest.mark.one_in(3)
@pytest.mark.parametrize("amplitude", [1e-6, 1e-12, 1e-17, 1e-100])
@pytest.mark.parametrize("mu, state", [((0, 0, 1), (-2.0, 0.5)), ((0, 0, 1), (-8.0, 0.125))])
def test_case_11_an_orbit_of_any_smallness_about_a_centre_has_its_period_and_extremes(amplitude, mu, state):
    """E - U(centre) is 1e-34 against terms of order one; x3max must come out as the amplitude, T as 2
    pi/sqrt(m) with m = X^2 - x2^2 = 1/h^2 - h^2 for a = b = 0."""
    pair = scaled(0, 0, mu)
    h = state[1]
    probe = np.array([*state, amplitude])
    assert agrees(pair, [probe], digits=300) == ["bounded"]
    np.testing.assert_allclose(stabilab.extremes(pair[0], probe)[2], [-amplitude, amplitude], rtol=1e-11)
    harmonic = 2 * math.pi / math.sqrt(h ** -2 - h ** 2)
    # the correction to the harmonic period is of the order of (amplitude/h)^2
    assert stabilab.period(pair[0],
                           probe) == pytest.approx(harmonic, rel=max(100 * (amplitude / h) ** 2, 1e-11))
