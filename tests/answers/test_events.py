"""Zeros of components and of functions along a motion."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stabilab
from tests.shared import CASES

PHONE = stabilab.load(CASES / "phone.toml")


def test_zeros_of_a_component_are_half_a_period_apart():
    """omega1 of a free body about its other axis is an elliptic function; the period is by elliptic integrals."""
    found = PHONE.when(events="omega1", until="10 s")
    assert len(found.t) == 1 and len(found.t[0]) == 7 and found.status == "reached" and found.until == 10.0
    assert np.diff(found.t[0]) == pytest.approx(float(PHONE.period()) / 2, rel=1e-11)
    assert np.abs(found.states[0][:, 0]).max() < 1e-12 and (found.error[0] < 1e-9).all()


def test_functions_are_found_as_solve_ivp_finds_them():
    """With SciPy's own integrator and event search; direction and terminal as there."""
    form = PHONE.scene.quadratic()

    def up(t, y):
        return y[1] - 0.5 * y[0]

    def third(t, y):
        return y[2] - 5.0
    up.direction, third.terminal = 1, 5
    run = solve_ivp(lambda t, y: form.rate(y.tolist()), (0, 10), PHONE.state, "DOP853", events=[up, third],
                    rtol=1e-12, atol=1e-13)
    found = PHONE.when(events=[up, third], until=10)
    assert found.status == "ended" and found.until == pytest.approx(run.t[-1], abs=1e-8)
    for ours, theirs, states in zip(found.t, run.t_events, found.states):
        assert len(ours) and ours == pytest.approx(theirs, abs=1e-8)
        assert len(states) == len(ours)


def test_a_function_of_time_alone_has_its_zeros_where_it_says():
    found = stabilab.when(PHONE.scene, state=PHONE.state, until="2 s", events=lambda t, y: np.sin(4 * t))
    assert found.t[0] == pytest.approx(np.pi / 4 * np.array([1, 2]), abs=1e-14)


def test_components_beyond_the_rates_are_events_too():
    found = stabilab.when(CASES / "top-fast.toml", events="gamma1", until="0.1 s")
    assert len(found.t[0]) == 5 and np.abs(found.states[0][:, 3]).max() < 1e-14


@pytest.mark.parametrize("events, options, words", [
    ("omega4", {}, "there is no component 'omega4'; there are omega1, omega2, omega3"), (3, {}, "got 3|not iterable"),
    ([], {}, "got none"), (lambda t, y: y, {}, "gives no number at t = 0"),
    (lambda t, y: np.nan, {}, "gives nan at t = 0; expected a finite number"),
    ("omega1", {"rate": "1 rad/s"}, "expected a limit or events, got both"), ("omega1", {"until": "-1 s"}, "above 0")])
def test_what_is_no_event_is_bad_input(events, options, words):
    with pytest.raises(stabilab.InputError, match=words):
        PHONE.when(events=events, **options)


def test_without_a_span_the_end_is_asked_for():
    with pytest.raises(stabilab.InputError, match="events need until"):
        stabilab.when(PHONE.scene, state=PHONE.state, events="omega1")
