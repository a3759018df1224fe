"""Roots of rates, evidence off the axes, and the period of free motion."""
import sys

import mpmath as mp
import numpy as np
import pytest

from stabilab import Body, ConstantTorque, Fate, Gyrostat, ScaledGyrostat, Scene, fate, trajectory
from stabilab.errors import InputError
from stabilab.integrate.extrema import roots_of_rates
from stabilab.unreduced.free_gyrostat import extremes_over_period
from stabilab.unreduced.off_axis import evidence

BODY = Body((2000, 1500, 1000))
OFF = Scene(BODY, Gyrostat((100, 20, 0)), ConstantTorque((10, 0, 20)))


@pytest.fixture(params=["heyoka", "scipy"])
def either(request, monkeypatch):
    if request.param == "scipy":
        monkeypatch.setitem(sys.modules, "heyoka", None)
    else:
        pytest.importorskip("heyoka")
    return request.param


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
    assert np.abs([OFF.quadratic().rate(x)[i] for x, i in zip(roots.states.tolist(), roots.component)]).max() < 1e-10
    assert (np.diff(np.abs(roots.t)) >= 0).all()


def test_extremes_contain_the_motion_and_are_attained(either):
    roots = roots_of_rates(OFF, (0.5, 2.6, 0.06), 30.0)
    states = trajectory(OFF, (0.5, 2.6, 0.06), np.linspace(0.001, 30, 30_000), "taylor" if either == "heyoka" else "DOP853").states
    extremes = roots.extremes()
    assert (extremes[:, 0] <= states.min(axis=0) + 1e-9).all() and (extremes[:, 1] >= states.max(axis=0) - 1e-9).all()
    assert np.abs(extremes[:, 1] - states.max(axis=0)).max() < 1e-4  # samples 1e-3 apart: quadratic in that
    assert np.abs(extremes[:, 0] - states.min(axis=0)).max() < 1e-4


def test_ends_of_the_span_count_as_extremes(either):
    extremes = roots_of_rates(ScaledGyrostat(0, 0, (1, 0, 0)), (2, 0, 0), 3.0).extremes()
    assert extremes == pytest.approx(np.array([[2, 5], [0, 0], [0, 0]]), abs=1e-13)


def test_overflowing_start_is_reported():
    roots = roots_of_rates(OFF, (1e200, 1e200, 1), 1.0)
    assert roots.reason and roots.t_reached == 0 and np.isfinite(roots.extremes()).all()


def test_evidence_off_the_axes_stays_undecided_and_names_its_span():
    seen = evidence(OFF, (0.5, 2.6, 0.06), (0, 50))
    assert seen.fate is Fate.UNDECIDED and "axis 1 and axis 3" in seen.reason
    assert seen.span == 50 and seen.extremes_over == "s in [0, 50]" and seen.extremes.shape == (3, 2)
    assert seen.trend == "rises" and seen.energy[1] > seen.energy[0] and max(seen.drift.values()) < 1e-13
    with pytest.raises(InputError, match="span"):
        evidence(OFF, (1, 2, 3), 0)


def jacobi_case():
    """Euler's free top about axis 1 (2 T D2 < |H|^2): period 4 K/rate and amplitudes, Landau and Lifshitz sec. 37."""
    D3, D2, D1 = 2.0, 1.5, 1.0  # Landau's I3 > I2 > I1; axes 1 and 3 exchanged here
    x = (0.9, 0.2, 0.3)  # omega on axes of inertia (2, 1.5, 1)
    with mp.workdps(30):
        w3, w2, w1 = map(mp.mpf, x)
        E2 = D3 * w3**2 + D2 * w2**2 + D1 * w1**2
        M2 = D3**2 * w3**2 + D2**2 * w2**2 + D1**2 * w1**2
        assert M2 > E2 * D2
        k2 = (D2 - D1) * (E2 * D3 - M2) / ((D3 - D2) * (M2 - E2 * D1))
        period = 4 * mp.ellipk(k2) * mp.sqrt(D1 * D2 * D3 / ((D3 - D2) * (M2 - E2 * D1)))
        least = [mp.sqrt((M2 - E2 * D2) / (D3 * (D3 - D2))), mp.sqrt((E2 * D3 - M2) / (D2 * (D3 - D2))),
                 mp.sqrt((E2 * D3 - M2) / (D1 * (D3 - D1)))]
        top = mp.sqrt((M2 - E2 * D1) / (D3 * (D3 - D1)))
        return x, float(period), [[float(least[0]), float(top)], *([-float(v), float(v)] for v in least[1:])]


def test_free_top_has_the_elliptic_period_and_amplitudes(either):
    x, period, extremes = jacobi_case()
    got = extremes_over_period(Scene(Body((2, 1.5, 1))), x)
    assert got.over == "all time"
    assert got.period == pytest.approx(period, rel=1e-13 if either == "heyoka" else 1e-10)
    assert got.extremes == pytest.approx(np.array(extremes), rel=2e-14)


@pytest.mark.parametrize("scene", [Scene(BODY, Gyrostat((50, 20, 30))), Scene(BODY, Gyrostat((-3000, 0, 700))),
                                   Scene(Body((2, 2, 1)), Gyrostat((1, 0, 2))), ScaledGyrostat("0.2", "0.4", (0, 0, 0))])
def test_free_gyrostats_return_after_their_period(scene):
    x = (0.5, 2.6, 0.06)
    got = extremes_over_period(scene, x)
    assert got.over == "all time" and 0 < got.period < np.inf
    assert trajectory(scene, x, [got.period]).states[0] == pytest.approx(x, abs=1e-11)
    states = trajectory(scene, x, np.linspace(0, 3 * got.period, 9001)).states
    assert (got.extremes[:, 0] <= states.min(axis=0) + 1e-13).all() and (got.extremes[:, 1] >= states.max(axis=0) - 1e-13).all()
    assert np.abs(got.extremes - np.stack([states.min(axis=0), states.max(axis=0)], axis=1)).max() < 1e-4
    half = trajectory(scene, x, np.linspace(0.02, 0.98, 49) * got.period).states
    assert np.abs(half - x).max(axis=1).min() > 1e-3  # no earlier return


def test_equilibrium_has_period_zero_and_separatrix_none():
    assert extremes_over_period(Scene(BODY), (0, 3, 0)).period == 0
    # On the free top's separatrix M^2 = 2 E D2: D1 (D1 - D2) w1^2 = D3 (D2 - D3) w3^2, chosen rational (D = 4, 3, 3/2: 4 w1^2 = (9/4) w3^2)
    on = extremes_over_period(Scene(Body((4, 3, 1.5))), (0.75, 0.5, 1.0))
    assert on.period == np.inf or on.period > 50


def test_torque_is_turned_away_from_the_free_period():
    with pytest.raises(InputError, match="without torque"):
        extremes_over_period(OFF, (1, 2, 3))


def test_a_rate_that_never_changes_has_no_roots_and_disturbs_no_other(either):
    """A ball with a wheel along the torque: omega1, omega2 turn at lambda3/D (closed form), omega3' is constant."""
    scene = Scene(Body((2, 2, 2)), Gyrostat((0, 0, 3)), ConstantTorque((0, 0, 0.5)))
    roots = roots_of_rates(scene, (1.0, 0.0, 0.0), 5.0)
    np.testing.assert_allclose(roots.t, np.pi / 3 * np.arange(1, 5), rtol=1e-9)
    assert roots.component.tolist() == [1, 0, 1, 0]


def test_a_fate_that_is_undecided_has_no_margin():
    """A filter `margins > 0` must not count it as safe; an equilibrium off the axes has none either, as no barrier is known."""
    result = fate(ScaledGyrostat("0.2", "0.4", (1, 1, 1)), np.ones((2, 3)))
    assert (result.labels == Fate.UNDECIDED).all() and np.isnan(result.margins).all() and np.isnan(result.velocity_margins).all()
    at_rest = fate(ScaledGyrostat(1, 3, (-1, 1, 1)), (-2, -1, -1))  # x2 x3 = 1, (x1 + 1) = -1, (x1 + 3) = 1: by hand
    assert at_rest.labels == Fate.EQUILIBRIUM and np.isnan(at_rest.margins)
