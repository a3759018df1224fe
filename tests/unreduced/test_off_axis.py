"""Roots of rates, evidence and certified spin-up off the axes, and the period of free motion."""
import sys

import numpy as np
import pytest

import stabilab
from stabilab import (
    Body,
    ConstantTorque,
    Fate,
    Gyrostat,
    ScaledGyrostat,
    Scene,
    fate,
    motion,
    period,
    trajectory,
)
from stabilab.errors import InputError
from stabilab.integrate.events import roots_of_rates
from stabilab.unreduced import off_axis
from stabilab.unreduced.evidence import seen_over
from stabilab.unreduced.free_gyrostat import extremes_over_period
from stabilab.unreduced.spin_up.follow import spin_up

from .spin_up.scenes import rates_of, run

BODY = Body((2000, 1500, 1000))
OFF = Scene(BODY, Gyrostat((100, 20, 0)), ConstantTorque((10, 0, 20)))


@pytest.fixture(params=["heyoka", "scipy"])
def either(request, monkeypatch):
    if request.param == "scipy":
        monkeypatch.setitem(sys.modules, "heyoka", None)
    else:
        pytest.importorskip("heyoka")
    return request.param


@pytest.mark.one_in(4)
@pytest.mark.parametrize("t_end", [20.0, -20.0])
def test_every_sign_change_of_a_rate_is_a_root(either, t_end):
    """Counted on 20,000 samples of the motion, rates from the hand-written form."""
    roots = roots_of_rates(OFF, (0.5, 2.6, 0.06), t_end)
    times = np.linspace(0, t_end, 20_001)
    states = trajectory(OFF, (0.5, 2.6, 0.06), times, "taylor" if either == "heyoka" else "DOP853").states
    rates = np.array([OFF.quadratic().rate(x) for x in states.tolist()])
    for i in range(3):
        changes = np.nonzero(rates[:-1, i] * rates[1:, i] < 0)[0]
        found = np.abs(roots.t[roots.component == i])
        assert len(found) == len(changes) > 3
        assert (found >= np.abs(times[changes])).all() and (found <= np.abs(times[changes + 1])).all()
    assert np.abs([OFF.quadratic().rate(x)[i] for x,
                   i in zip(roots.states.tolist(), roots.component)]).max() < 1e-10
    assert (np.diff(np.abs(roots.t)) >= 0).all()


def test_extremes_contain_the_motion_and_are_attained(either):
    roots = roots_of_rates(OFF, (0.5, 2.6, 0.06), 30.0)
    states = trajectory(OFF, (0.5, 2.6, 0.06), np.linspace(0.001, 30, 30_000),
                        "taylor" if either == "heyoka" else "DOP853").states
    extremes = roots.extremes()
    assert (extremes[:, 0] <= states.min(axis=0)
            + 1e-9).all() and (extremes[:, 1] >= states.max(axis=0) - 1e-9).all()
    assert np.abs(extremes[:, 1] - states.max(axis=0)).max() < 1e-4  # samples 1e-3 apart: quadratic in that
    assert np.abs(extremes[:, 0] - states.min(axis=0)).max() < 1e-4


def test_ends_of_the_span_count_as_extremes(either):
    extremes = roots_of_rates(ScaledGyrostat(0, 0, (1, 0, 0)), (2, 0, 0), 3.0).extremes()
    assert extremes == pytest.approx(np.array([[2, 5], [0, 0], [0, 0]]), abs=1e-13)


def test_overflowing_start_is_reported(either):
    with np.errstate(all="ignore"):
        roots = roots_of_rates(OFF, (1e200, 1e200, 1), 1.0)
    assert "stopped" in str(roots.reason) and roots.t_reached < 1 and np.isfinite(roots.extremes()).all()


def test_a_run_of_no_time_ends_where_it_starts():
    roots = roots_of_rates(OFF, np.array([0.5, 2.6, 0.06]), 0.0)
    assert not len(roots.t) and roots.end.tolist() == [0.5, 2.6, 0.06]


def test_evidence_off_the_axes_names_its_span():
    fields = seen_over(OFF, (0.5, 2.6, 0.06), (0, 50))
    seen = fields["evidence"]
    assert seen["span"] == 50 and str(fields["over"]) == "s in [0, 50]"
    assert np.shape(fields["extremes"]) == (3, 2) and seen["energy_trend"] == "rises"
    assert seen["energy_end"] > seen["energy_start"] and seen["invariant_drift"] < 1e-13
    with pytest.raises(InputError, match="span"):
        seen_over(OFF, (1, 2, 3), (0, 0))


@pytest.mark.one_in(2)
@pytest.mark.parametrize("scene",
                         [Scene(BODY, Gyrostat((50, 20, 30))), Scene(BODY, Gyrostat((-3000, 0, 700))),
                                   Scene(Body((2, 2, 1)), Gyrostat((1, 0, 2))),
                          ScaledGyrostat("0.2", "0.4", (0, 0, 0))])
def test_free_gyrostats_return_after_their_period(scene):
    x = (0.5, 2.6, 0.06)
    got = extremes_over_period(scene, x)
    assert str(got.over) == "all time" and 0 < got.period < np.inf
    assert trajectory(scene, x, [got.period]).states[0] == pytest.approx(x, abs=1e-11)
    states = trajectory(scene, x, np.linspace(0, 3 * got.period, 9001)).states
    assert (got.extremes[:, 0] <= states.min(axis=0)
            + 1e-13).all() and (got.extremes[:, 1] >= states.max(axis=0) - 1e-13).all()
    assert np.abs(got.extremes - np.stack([states.min(axis=0), states.max(axis=0)], axis=1)).max() < 1e-4
    half = trajectory(scene, x, np.linspace(0.02, 0.98, 49) * got.period).states
    assert np.abs(half - x).max(axis=1).min() > 1e-3  # no earlier return


def test_equilibrium_has_period_zero_and_separatrix_none():
    assert extremes_over_period(Scene(BODY), (0, 3, 0)).period == 0
    # On the free top's separatrix M^2 = 2 E D2: D1 (D1 - D2) w1^2 = D3 (D2 - D3) w3^2, chosen rational (D =
    # 4, 3, 3/2: 4 w1^2 = (9/4) w3^2)
    assert extremes_over_period(Scene(Body((4, 3, 1.5))), (0.75, 0.5, 1.0)).period == np.inf
    with pytest.raises(InputError, match="without torque"):
        extremes_over_period(OFF, (0.75, 0.5, 1.0))
    rest = extremes_over_period(Scene(Body((3, 2, 1)), Gyrostat((0.5, 0.25, -0.75))), np.zeros(3))
    assert rest.period == 0.0 and not rest.extremes.any()


def test_a_rate_that_never_changes_has_no_roots_and_disturbs_no_other(either):
    """A ball with a wheel along the torque: omega1, omega2 turn at lambda3/D (closed form), omega3' is
    constant."""
    scene = Scene(Body((2, 2, 2)), Gyrostat((0, 0, 3)), ConstantTorque((0, 0, 0.5)))
    roots = roots_of_rates(scene, (1.0, 0.0, 0.0), 5.0)
    np.testing.assert_allclose(roots.t, np.pi / 3 * np.arange(1, 5), rtol=1e-9)
    assert roots.component.tolist() == [1, 0, 1, 0]


# the satellite of the README, its thruster tilted
TILTED = Scene(Body((12, 9, 5)), Gyrostat(("0.8", 0, 0)), ConstantTorque(("0.001", 0, "0.02")))
ISLAND = Scene(Body((1.2412, .3937, 1.3650)), Gyrostat((-.5224, .8309, .1914)),
               ConstantTorque((.0987, .8450, .5255)))
IN_ISLAND = (-1.572, .657, .738)  # bounded over 1e6 natural units: an elliptic orbit between two saddle-foci


@pytest.mark.parametrize("scene, state, axis, later",
                         [(TILTED, (0.1, 0.05, 0.9), 3, False), (OFF, (0.5, 2.6, 0.06), 1, True)],
                         ids=["trapped at the start", "trapped later"])
def test_a_torque_off_the_axes_spins_a_body_up_within_the_bounds_told(scene, state, axis, later):
    found = motion(scene, state)
    assert (found.fate, found.level, found.axis, found.sense) == (Fate.SPIN_UP, "certified", axis, 1)
    assert "certified" in found.because and found.margin_energy is None and found.margin_velocity is None
    assert (found.evidence["t_certificate"] > 0) == later
    times = np.linspace(0, 2 * found.evidence["t_certificate"] + (50 if later else 600), 4001)
    states = run(rates_of(scene), state, times)
    low, high = np.array(found.bounds).T
    assert (states >= low - 1e-8).all() and (states <= high + 1e-8).all() and high[axis - 1] == np.inf
    assert states[-1, axis - 1] > 2 * abs(state[axis - 1])  # rad/s


def test_arrays_are_told_what_one_state_is_told():
    states = np.random.default_rng(7).normal(size=(12, 3))
    states[3] = 0.1, 0.05, 0.9
    many, bounds = fate(TILTED, states), stabilab.extremes(TILTED, states)
    for n in (0, 3, 8):
        one = motion(TILTED, states[n])
        assert (one.fate, one.axis, one.sense,
                one.level) == (many.labels[n], many.axis[n], many.sense[n], many.levels[n])
        assert one.because == many.because[n]
        assert np.allclose(bounds[n], one.bounds, rtol=1e-9)
    assert np.isnan(many.margins).all() and np.isnan(many.velocity_margins).all()


def test_undecided_says_how_long_it_was_followed_and_why():
    found = motion(ISLAND, IN_ISLAND, follow=40)
    assert found.fate == Fate.UNDECIDED and found.level == "undecided" and found.bounds is None
    assert found.extremes is None
    assert "followed for 40" in found.because and "island" in found.cause
    assert "give span" in found.extremes_over
    result = fate(ISLAND, np.array([IN_ISLAND]), follow=40)
    assert result.levels[0] == "undecided" and np.isnan(
        result.margins[0]) and "followed for 40" in result.because[0]
    with pytest.raises(InputError, match="span"):
        stabilab.extremes(ISLAND, [IN_ISLAND], follow=40)


def test_following_tells_how_far_it_is():
    heard = []
    motion(ISLAND, IN_ISLAND, follow=40, tell=lambda t, steps, left: heard.append((t, steps, left)))
    times = [t for t, *_ in heard]
    assert times == sorted(times) and 20 < times[-1] <= 40 and {left for *_, left in heard} == {1}


@pytest.mark.parametrize("follow", [-1, float("nan"), "soon", float("inf")])
def test_a_time_to_follow_that_is_none_is_refused(follow):
    with pytest.raises(InputError, match="follow"):
        motion(TILTED, (0.1, 0.05, 0.9), follow=follow)


def test_a_fate_that_is_undecided_has_no_margin():
    """A filter `margins > 0` must not count it as safe; an equilibrium off the axes has none either, as no
    barrier is known."""
    result = fate(ScaledGyrostat("0.2", "0.4", (1, 1, 1)), np.ones((2, 3)), follow=0.1)
    assert (result.labels
            == Fate.UNDECIDED).all() and np.isnan(result.margins).all() and np.isnan(
                result.velocity_margins).all()
    # x2 x3 = 1, (x1 + 1) = -1, (x1 + 3) = 1: by hand
    at_rest = fate(ScaledGyrostat(1, 3, (-1, 1, 1)), (-2, -1, -1))
    assert at_rest.labels == Fate.EQUILIBRIUM and np.isnan(at_rest.margins)


def test_fates_of_an_array_are_proved_on_request():
    """Against the proof of each state alone."""
    scene = Scene(Body((1.4, 1, 0.6)), Gyrostat((0.2, 0.1, -0.3)), ConstantTorque((0.5, 0.6, 0.62)))
    states = np.array([[6.0, 1, -1], [0.1, 0.2, 8.0]])
    asked, plain = fate(scene, states, proof=True), fate(scene, states)
    assert asked.levels.tolist() == ["proved",
                                     "proved"] and plain.levels.tolist() == ["certified", "certified"]
    assert np.array_equal(asked.axis, plain.axis) and [stabilab.spin_up(scene, state, proof=True).level
                                                       for state in states.tolist()] == ["proved", "proved"]


@pytest.mark.slow
def test_the_period_of_an_undecided_motion_is_no_number_and_the_command_says_why(stabilab, tmp_path):
    """Inside a bounded island (followed for 1e6 s by an integrator) no certificate is met: inf would say that
    the motion never repeats."""
    scene = Scene(Body((4.936, 3.555, 1.537)), Gyrostat((-1.151, 0, 0)),
                  ConstantTorque((-1.405, -1.744, -0.091)))
    state = (0.4836, -0.1631, -3.7926)
    # the second spins up
    assert np.isnan(period(scene, state)) and np.isposinf(period(scene, (0.0, 0.0, 5.0)))
    (tmp_path / "island.toml").write_text("[body]\ninertia = [4.936, 3.555, "
                                          "1.537]\n[effects.gyrostat]\nmomentum = [-1.151, 0, "
                                          "0]\n[effects.constant_torque]\n"
                                          f"torque = [-1.405, -1.744, -0.091]\n[motion]\nangular_velocity = "
                                          f"{list(state)}\nspan = [0, 1]\n")
    code, out, _ = stabilab("period", tmp_path / "island.toml")
    assert code == 0 and "the period is not known: the fate is undecided" in out


NEAR_ROD = Scene(Body((1, "0.9999999965", "2.3e-8")), Gyrostat(("-0.093", "-0.037", "-0.0044")),
                 ConstantTorque((1, "-1e-13", "6e-14")))


@pytest.mark.parametrize("numba, most", [(True, 600_000), (False, 5_000)])
def test_a_motion_is_followed_for_seconds_with_and_without_a_compiler(monkeypatch, numba, most):
    asked = []
    monkeypatch.setattr(off_axis, "installed", lambda: numba)
    monkeypatch.setattr(off_axis, "spin_up", lambda scene, state, budget,
                        **_: asked.append(budget) or spin_up(scene, state, budget=50))
    assert off_axis.motion(NEAR_ROD, (1.256, 0.131, 2.72)).fate == Fate.UNDECIDED
    assert asked == [most]
