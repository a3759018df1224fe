"""Ways on that few inputs take: methods that refuse or stop half-way, motions from rest, ends of curves, searches that find nothing."""
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import stabilab
from stabilab import Body, ConstantTorque, ScaledGyrostat, Scene
from stabilab.analysis import precision_digits
from stabilab.analysis.captured import _search
from stabilab.analysis.equilibria import equilibria
from stabilab.analysis.precise import PreciseOrbit, Unclear, settled
from stabilab.analysis.precise_period import _rate
from stabilab.analysis.precision_digits import OWN, best_reached
from stabilab.analysis.precision_front import FrontPoint
from stabilab.analysis.precision_reference import reference
from stabilab.errors import InputError

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
    orbit = settled(lambda bits: PreciseOrbit(stabilab.analysis.reduction.reduce(scene), state), 128)
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
    assert _search(-1.0, (1e200, 1e200, 1e200), 1.0)[:2] == ("none", None)
