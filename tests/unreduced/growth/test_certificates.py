"""Facts about capture that small faults break: margins as the proof states them, times of release, words,
both steppers."""
from __future__ import annotations

import math
from fractions import Fraction

import mpmath as mp
import numpy as np
import pytest

from stabilab import Body, ConstantTorque, Fate, Gyrostat, ScaledGyrostat, Scene
from stabilab.answers.simulate import trajectory
from stabilab.unreduced.growth import captured_fate
from stabilab.unreduced.growth_certificate import (
    captured_extremes,
    search_certificate,
    spin_up_margin,
    turning_run,
    well_margin,
)

STATES = [(c, y) for c in (-0.05, -0.7, -3.0, -20.0) for y in (
    (0.3, -1.0, 5.0), (-6.5, 2.0, -1.0), (2.0, 0.5, 0.25), (0.1, 30.0, -40.0), (8.0, -3.0, 0.5),
    (-0.5, 0.0, 2.0))]


def energy_terms(c, y):
    """(phi mod pi, P, J, V as a function of the angle) at 40 digits, from the module's statement of the
    equations."""
    u, y2, y3 = map(mp.mpf, y)
    c, phi = mp.mpf(c), mp.atan2(y3, y2)
    P, J = u + c / 2 * mp.cos(2 * phi), y2 ** 2 + y3 ** 2 - 2 * c * u
    V = lambda b: -b - J / 2 * mp.sin(b) ** 2 + c * c / 8 * mp.sin(2 * b) ** 2
    return phi - mp.pi * mp.floor(phi / mp.pi), P, J, V


@pytest.mark.one_in(4)
@pytest.mark.parametrize("c, y", STATES)
def test_a_well_is_as_deep_as_the_highest_barrier_that_the_proof_admits(c, y):
    """max V(b) - V(p) - P^2/2 over b in [max(p, pi - p), pi], by a fine grid and thirds of its best cell."""
    with mp.workdps(40):
        p, P, J, V = energy_terms(c, y)
        low = max(p, mp.pi - p)
        grid = [low + (mp.pi - low) * n / 400 for n in range(401)]
        best = max(range(401), key=lambda n: V(grid[n]))
        left, right = grid[max(best - 1, 0)], grid[min(best + 1, 400)]
        for _ in range(70):
            a, b = left + (right - left) / 3, right - (right - left) / 3
            left, right = (a, right) if V(a) < V(b) else (left, b)
        exact = max(V(left), V(grid[best])) - V(p) - P * P / 2
        size = P * P / 2 + abs(J) / 2 + mp.mpf(c) ** 2 / 8 + mp.pi
    margin, terms = well_margin(c, y)
    assert abs(margin
               - float(exact)) <= 1e-13 * float(size) and terms == pytest.approx(float(size), rel=1e-14)


@pytest.mark.parametrize("c, y", STATES + [(-c, y) for c, y in STATES])
def test_the_margin_of_a_spin_up_is_that_of_the_proof(c, y):
    """L - c^2/2 with L = P^2/2 - (J/2) sin^2 phi + (c^2/8) sin^2 2phi + min(J, 0)/2 - c^2/8, for P > 0 alone.
    """
    with mp.workdps(40):
        p, P, J, V = energy_terms(c, y)
        exact = P * P / 2 + V(p) + p + min(J, mp.mpf(0)) / 2 - mp.mpf(c) ** 2 * 5 / 8
        size = P * P / 2 + abs(J / 2 * mp.sin(p) ** 2) + abs(J) + mp.mpf(c) ** 2
    margin, terms = spin_up_margin(c, y)
    assert terms == pytest.approx(float(size), rel=1e-14)
    assert margin == pytest.approx(float(exact),
                                   abs=1e-14 * float(size)) if P > 0 else margin <= -0.999 * float(size)


@pytest.mark.parametrize("sign", [-1, 1])
@pytest.mark.parametrize("turned", [-1, 1])
def test_a_captured_motion_names_its_axis_and_goes_where_it_says(sign, turned):
    scene, state = ScaledGyrostat(0, -0.1 * sign, (sign, 0, 0)), (0.0, -1.0, 5.0 * turned)
    answer = captured_fate(scene, state)
    assert (answer.fate, answer.certificate, answer.release_time,
            answer.release_estimate) == (Fate.SPIN_UP, "well", None, None)
    assert answer.because.count(f"axis {answer.axis}") == 1 and answer.axis == 3
    far = trajectory(scene, state, [400.0]).states[0]
    assert answer.sense * far[2] > 5  # grows like sqrt(2 |c| t), sqrt 80 at the end
    found = captured_extremes(scene, state, answer)
    assert found.box[2, 1 if answer.sense > 0
                     else 0] == answer.sense * np.inf and np.isfinite(found.box[2]).sum() == 1
    # that the two others swing ever wider is an adiabatic invariant's word, not a proof for each motion: they
    # are told over the span
    assert str(found.over).startswith("finite entries over") and np.isfinite(found.box[:2]).all()


@pytest.mark.parametrize("state, turns", [((0.0, -1.0, 5.0), True), ((9.0, 0.5, 0.25), False)])
def test_the_last_reversal_of_the_turn_is_the_same_by_both_steppers(state, turns, monkeypatch):
    """A series with events, and a Runge-Kutta method with roots of its interpolant."""
    pytest.importorskip("heyoka")
    found = []
    for available in (True, False):
        monkeypatch.setattr("stabilab.integrate.events.heyoka_available", lambda: available)
        passed = turning_run(0.3)(state, 6.0, 10**6)
        assert passed.t == 6 and passed.steps > 0 and not passed.reason
        found.append((passed.times[-1] if len(passed.times) else None, passed.state))
    assert (found[0][0] is not None) == (found[1][0] is not None) == turns
    if turns:
        assert found[0][0] == pytest.approx(found[1][0], rel=1e-9)
    np.testing.assert_allclose(found[0][1], found[1][1], rtol=1e-8, atol=1e-8)


def test_a_motion_that_never_turns_back_is_released_at_once():
    answer = captured_fate(ScaledGyrostat(0, 0.3, (1, 0, 0)), (9.0, 0.5, 0.25))
    assert answer.certificate == "spin-up"
    assert (answer.release_time, answer.release_estimate, answer.t_certificate) == (0.0, None, 0.0)


def test_a_search_that_ends_too_early_says_so():
    """Undecided for c < 0; for c > 0 the fate is certain and the release is told by the law."""
    answer = captured_fate(ScaledGyrostat(0, -0.3, (1, 0, 0)), (-6.0, 2.0, -1.0), t_max=1e-3)
    assert (answer.fate, answer.axis, answer.sense) == (Fate.UNDECIDED, 0, 0)
    assert (answer.certificate, answer.release_time) == ("none", None)
    assert answer.steps > 0 and "spin-up about axis 1 nor capture about axis 3" in answer.because
    answer = captured_fate(ScaledGyrostat(0, 0.01, (1, 0, 0)), (0.0, -1.0, 5.0), t_max=1.0)
    assert (answer.fate, answer.axis, answer.sense) == (Fate.SPIN_UP, 1, 1)
    assert (answer.certificate, answer.release_time) == ("bound", None)
    u = 0.005
    assert answer.release_estimate == pytest.approx((26 - 2 * 0.01 * u - 2) / 0.02, rel=1e-12)


@pytest.mark.parametrize("inertia, momentum, torque, axis, words", [
    ((2, 2, 1), (0, 0, 1), (0, 0, -3), 3, "axis 3 are equal"),
    ((2, 2, 2), (1, 2, 0), (3, 0, 0), 0, "three equal moments"),
    ((1, 2, 2), (1, 0, 0), (0.5, 0, 0), 1, "axis 1 are equal")])
def test_a_law_of_growth_holds_from_the_start(inertia, momentum, torque, axis, words):
    answer = captured_fate(Scene(Body(inertia), Gyrostat(momentum), ConstantTorque(torque)), (1, 2, 3))
    assert (answer.axis, answer.release_time, answer.release_estimate) == (axis, 0.0, None)
    assert (answer.certificate, answer.t_certificate,
            answer.steps) == ("law", 0.0, 0) and words in answer.because
    assert answer.sense == (0 if axis == 0 else math.copysign(1, torque[axis - 1]))


def test_pure_spin_about_the_torque_s_axis_is_told_at_once():
    answer = captured_fate(ScaledGyrostat(0, -0.3, (-1, 0, 0)), (2.0, 0.0, 0.0))
    assert (answer.axis, answer.sense, answer.certificate, answer.release_time, answer.t_certificate,
            answer.steps) == (
        1, -1, "axis", 0.0, 0.0, 0)
    found = captured_extremes(ScaledGyrostat(0, -0.3, (-1, 0, 0)), (2.0, 0.0, 0.0), answer)
    assert found.box.tolist() == [[-np.inf, 2.0], [0.0, 0.0],
                                  [0.0, 0.0]] and (str(found.over), found.span) == ("all time", None)


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_pure_spin_is_told_on_every_axis_and_by_the_state_as_it_was_given(axis):
    """The middle one too, where no certificate but this is known; a trace of another rate, lost in the
    doubles, undoes it."""
    unit = [float(n == axis) for n in range(3)]
    scene = Scene(Body((3, 2, 1)), Gyrostat(unit), ConstantTorque(unit))
    assert captured_fate(scene, unit).certificate == "axis"
    trace = [Fraction(v) for v in unit]
    trace[axis - 1] = Fraction(1, 10**400)
    assert captured_fate(scene, unit, t_max=1.0, exact=trace).certificate != "axis"


def test_rates_beyond_doubles_get_no_certificate_of_a_capture():
    assert search_certificate(-1.0, (1e200, 1e200, 1e200), 1.0)[:2] == ("none", None)
