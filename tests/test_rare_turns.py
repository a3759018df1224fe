"""Ways on that few inputs take: methods that refuse or stop half-way, motions from rest, ends of curves, searches that find nothing."""
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import stabilab
from stabilab import Body, ConstantTorque, Gyrostat, ScaledGyrostat, Scene
from stabilab.answers.digits import run as precision_digits
from stabilab.unreduced.growth_run import search_certificate
from stabilab.answers.equilibria import equilibria
from stabilab.orbit.ball_orbit import PreciseOrbit
from stabilab.numbers.balls import settled
from stabilab.numbers.double_ball import Unclear
from stabilab.orbit.period.balls import _rate
from stabilab.answers.digits.run import best_reached, OWN
from stabilab.answers.digits.front import FrontPoint
from stabilab.integrate.reference import reference
from stabilab.orbit.flow.flow import reduced_motion
from stabilab.physics.effects.gravity import Gravity
from stabilab.physics.effects.resistance import Resistance
from stabilab.errors import InputError

from tests.hunt.disagreements import many_digits
from tests.oracles import energy
from tests.oracles.pairs import physical
from tests.test_extremes import assert_extremes

CASES = Path(__file__).parent.parent / "cases"


def case(name):
    return stabilab.load(CASES / f"{name}.toml")


# -- digits asked for


def test_a_measured_method_that_refuses_the_motion_is_passed_over(monkeypatch):
    one = case("charged-body-attitude")  # the reduced form has no attitude
    monkeypatch.setattr(precision_digits, "front", lambda case: (FrontPoint("reduced", 40, 14.0, 1e-6),))
    found = best_reached(one, [0.0, 0.5], 8)
    assert found.enough and "reduced" not in found.because and "attitude" not in found.run.state and "angles" in found.run.state


def test_a_check_that_stops_early_shows_no_digit(monkeypatch):
    one, plain = case("minor-axis-100"), precision_digits.RUNS["taylor"]

    def stops(case, times, method, rtol):
        run = plain(case, times, method, rtol)
        return run if case is one else replace(run, status="stopped")
    monkeypatch.setattr(precision_digits, "RUNS", {**precision_digits.RUNS, "taylor": stops, OWN[0]: stops})
    found = precision_digits._checked(one, np.array([0.0, 1.0]), *OWN, 9)
    assert found.digits == 0 and not found.enough and "stopped early" in found.because


@pytest.mark.parametrize("status, turned", [("stopped", 0.0), ("reached", 2.0)])  # 2 rad are more than COUNTED
def test_attitudes_in_many_digits_need_a_run_that_counts_their_turns(monkeypatch, status, turned):
    one, times = case("charged-body-attitude"), np.array([0.0, 0.1])
    assert precision_digits._many_digits(one, times, 12).enough
    near = precision_digits._integrated(one, times, *OWN)
    state = {**near.state, "angles": near.state["angles"] + turned}
    monkeypatch.setattr(precision_digits, "_integrated", lambda *asked: replace(near, status=status, state=state))
    assert precision_digits._many_digits(one, times, 12) is None


def test_times_of_both_signs_are_left_to_doubles():
    assert precision_digits._many_digits(case("minor-axis-100"), np.array([-1.0, 1.0]), 12) is None


def test_a_motion_from_rest_in_many_digits_starts_by_the_torque():
    found = reference(Scene(Body((3, 2, "1.5")), ConstantTorque((0, 0, 3))), (0, 0, 0), [0.25, 1.5])
    np.testing.assert_array_equal(found.states, [[0, 0, 0.5], [0, 0, 3]])  # omega3 = M3 t/D3, by hand


def test_a_rate_below_a_barrier_is_asked_for_again_with_more_bits():
    scene, state = ScaledGyrostat(1, 2, (0, 0, 1)), (0.3, 0.2, 0.1)
    orbit = settled(lambda numbers: PreciseOrbit(stabilab.orbit.reduction.reduce(scene), state, numbers), 128)
    side = 1 if float(orbit.force_here) < 0 else -1  # uphill
    with pytest.raises(Unclear):
        _rate(orbit, orbit.energy * 0 + side)


# -- curves and captures


def test_a_curve_of_steady_states_has_no_point_at_its_ends():
    attitude = case("charged-body-attitude")
    turning = Scene(attitude.scene.body, *(e for e in attitude.scene.effects if e.name != "body_force"))
    curve = equilibria(turning).curves[0]
    low, high = curve.segments[0].t
    assert len(curve.point(0.5 * (low + high))) == 6
    for end in (low, high, high + 1):
        with pytest.raises(InputError, match="lies at an end"):
            curve.point(end)


def test_rates_beyond_doubles_get_no_certificate_of_a_capture():
    assert search_certificate(-1.0, (1e200, 1e200, 1e200), 1.0)[:2] == ("none", None)


# -- verdicts of polynomials: the words against the roots themselves


@pytest.mark.parametrize("e2, e3, e4", [(5, 0, 4), (5, 0, 6.25), (2, 0, 3), (1, 0, -1), (-5, 0, 4), (-2, 0, 1), (3, 0, 0), (5, 1, 4),
                                        (5, -1, 4), (0, 0, 0)])
def test_steady_states_of_a_torque_are_told_by_their_quartic(e2, e3, e4):
    from flint import arb
    from stabilab.equilibrium.field.steady_states import _verdict
    roots = np.roots([1, 0, e2, -e3, e4])
    simple = min(abs(a - b) for n, a in enumerate(roots) for b in roots[:n]) > 1e-3
    word = "unstable" if roots.real.max() > 1e-3 else "stable" if simple else "degenerate"
    assert _verdict(arb(e2), arb(e3), arb(e4))[0] == word


@pytest.mark.parametrize("rates, kind", [((-1, -2), "attracting"), ((1, 2), "repelling"), ((-1, 2), "saddle"), ((0, -1), "neutral"),
                                         ((0, 1), "repelling"), ((1j, -1j), "neutral")])
def test_averaged_steady_states_are_named_by_their_rates(rates, kind):
    from stabilab.theories.cavity.attractors import _kind
    assert _kind(tuple(map(complex, rates))) == kind


def test_equal_stiffness_is_found_at_every_rate_or_none():
    """By substitution in (Omega^2 - N)(D_i - D_j) = Omega E, axis 3 carrying E."""
    from fractions import Fraction
    from types import SimpleNamespace
    from stabilab.equilibrium.field.circles import _same_stiffness
    parts = SimpleNamespace(D=(Fraction(2), Fraction(2), Fraction(3)), N=Fraction(1), E=Fraction(3))
    assert _same_stiffness(parts, 0, 1) == [0]  # equal moments: the same at every rate
    for Omega in _same_stiffness(parts, 0, 2):
        assert abs((Omega**2 - parts.N) * (parts.D[0] - parts.D[2]) + Omega * parts.E) < Fraction(1, 2**200)
    assert len(_same_stiffness(parts, 0, 2)) == 2
    pulled = SimpleNamespace(D=parts.D, N=Fraction(-4), E=Fraction(3))  # Omega^2 - 3 Omega + 4 has no real root
    assert _same_stiffness(pulled, 0, 2) == []


# -- averaged and expanded motions


def test_cross_torques_average_out_of_the_steady_states_and_the_reason_says_so():
    from stabilab.theories.cavity.attractors import attractors
    body, drag = Body(("9.5", "9.5", "9")), Resistance("0.1")
    alone, crossed = (attractors(Scene(body, drag, ConstantTorque((m, 0, 1)))) for m in (0, "0.01"))
    assert [p.spin for p in alone.points] == [p.spin for p in crossed.points]
    assert "M1, M2 average out" in crossed.reason and "M1, M2" not in alone.reason


def test_a_departure_at_the_first_time_is_that_time():
    from stabilab.theories.cavity.printed import _first
    t = np.array([1.0, 2.0, 4.0])
    assert _first(t, np.array([2.0, 3.0, 4.0]), np.ones(3), 1.0) == 1.0
    assert _first(t, np.array([0.0, 0.5, 1.5]), np.ones(3), 1.0) == 3.0  # half-way by the straight line
    assert _first(t, np.zeros(3), np.ones(3), 1.0) is None


@pytest.mark.parametrize("times", [[np.nan], [[0.0, 1.0]], ["a"]])
def test_times_of_an_expansion_are_finite_numbers_in_a_row(times):
    from stabilab.theories.top.lindstedt import times_row
    with pytest.raises(InputError, match="times: expected"):
        times_row(times)


# -- circles of which an arc between two folds holds barriers; steps in the motion's own unit; rotations that nearly stop


def test_equilibria_between_two_folds_have_no_kernel_and_the_same_extremes():
    from stabilab.orbit.extremes.circle_numba import kernel_input
    from stabilab.orbit.landscape import landscape
    scene, problem = physical((1.28, 2.85, 1.98), (5.59, 0, -1.92), (0, 14.32, 0))
    assert len(landscape(scene).conic.folds) == 4 and kernel_input(landscape(scene)) is None
    states = np.random.default_rng(1).normal(size=(12, 3)) * 3
    found = stabilab.extremes(scene, states, fast=True)
    for n, state in enumerate(states.tolist()):
        assert_extremes(found[n], energy.extremes(problem, state), 1e-11)


def test_steps_of_slow_rates_are_told_in_the_scenes_time():
    scene, steps = Scene(Body((3, 2, "1.5")), ConstantTorque((0, 0, "1e-20"))), []
    run = stabilab.trajectory(scene, (1e-10, 2e-10, 1e-10), [1e10, 3e10], steps=steps)
    assert run.status == "reached" and len(steps) == run.counters["steps"]
    assert 0 < steps[0] < steps[-1] and steps[-1] >= 3e10 and (np.diff(steps) > 0).all()


@pytest.mark.parametrize("over", [1e-4, -1e-4, 1e-9, -1e-9])
def test_a_free_motion_that_nearly_stops_at_its_saddle_is_told_on_either_side(over):
    """Against a Taylor series in 200 bits; 6 (6 - 4) omega1^2 = 3 (4 - 3) omega3^2 on the middle axis' separatrix."""
    pytest.importorskip("heyoka")
    scene, problem = physical((6, 4, 3), (0, 0, 0), (0, 0, 0))
    state = (0.5 * (1 + over), 0.75, 1.0)
    motion = reduced_motion(scene, state)
    for time in (0.4 * motion.period, 0.9 * motion.period):
        found = stabilab.trajectory(scene, state, [time], "reduced", laws=False).states[0]
        # a unit in the last place of the start counts as many times as the way along the saddle grows it
        np.testing.assert_allclose(found, many_digits(problem, state, time), atol=4e-15 / abs(over))


def test_a_branch_of_permanent_rotations_has_no_point_outside_it():
    curves = equilibria(Scene(Body((5, "5.1", 7)), Gyrostat((1, 0, 2)), Gravity(20, ("0.7", "0.3", "0.1")))).curves
    refused = 0
    for curve in curves:
        low, high = curve.segments[0].t[0], curve.segments[-1].t[1]
        for end, outside in ((low, low - 1), (high, high + 1)):
            if np.isfinite(end):
                with pytest.raises(InputError, match="this branch of permanent rotations"):
                    curve.point(outside)
                refused += 1
    assert refused


@pytest.mark.parametrize("wheel", [1, 30])
def test_a_sphere_with_its_weight_along_the_wheel_sleeps_upside_down_but_for_slow_spins(wheel):
    """Lagrange's sleeping top: (Lambda - D Omega)^2 > 4 D M g z with gamma = -e3."""
    curves = equilibria(Scene(Body((3, 3, 3)), Gravity(20, (0, 0, "0.1")), Gyrostat((0, 0, wheel)))).curves
    (upright,) = [c for c in curves if c.point(0.0)[5] == -1]
    (unstable,) = [s.t for s in upright.segments if s.verdict == "unstable"]
    np.testing.assert_allclose(unstable, [(wheel - 24**0.5) / 3, (wheel + 24**0.5) / 3], rtol=1e-14)
    assert {s.verdict for s in upright.segments if s.t != unstable} == {"stable"}
