"""Periods of arrays where doubles hardly know the well: in minute wells beside folds, and where rounding
leaves no depth at all."""
from __future__ import annotations

import numpy as np
import pytest

import stabilab
from stabilab import Fate
from stabilab.orbit import arc_kernel, rows_kernel
from stabilab.orbit.extremes_arrays import extremes_and_periods, rules
from stabilab.orbit.landscape import landscape
from stabilab.orbit.one_orbit import Orbit
from stabilab.orbit.period import power_of_error, precise_period
from stabilab.orbit.rows_kernel import PERIOD
from tests.oracles import energy
from tests.oracles.pairs import physical
from tests.shared import PARABOLIC

# two equilibria of its parabola are 5e-8 apart: exactly, not in doubles
FOLD = (0.0, -1.1710078746600967, 1.1786044041487267)
PERIOD_SHOWN = 2e-11  # ten to the minus eleven is promised


@pytest.mark.one_in(3)
@pytest.mark.parametrize("off", [(0, 0, 0), (0, -3e-15, 2e-16), (-1.4e-7, -1e-8, 0), (1e-4, -1e-3, 0),
                                 *(pytest.param(off, marks=pytest.mark.slow)
                                   for off in ((3e-9, 0, 1.5e-8), (0, 0, 1.7e-7), (0, -4.9e-7, 0)))])
def test_margins_and_periods_beside_the_fold_of_a_parabola(off):
    """Arrays lost the barrier (margin +inf), or said it and the period to a few digits; the potential in 100
    digits shares no code."""
    scene, _ = PARABOLIC["first axis"]
    model = physical((2, 2, 1), (0, "0.25", "0.5"), ("0.5", 0, 0))[1]
    state = tuple(np.add(FOLD, off).tolist())
    margin, period = energy.margin(model, state), energy.period(model, state)
    assert float(stabilab.fate(scene, state).margins) == pytest.approx(float(margin), rel=1e-9,
                                                                       abs=1e-12 * state[0] ** 2)
    for found in (stabilab.period(scene, [state])[0], stabilab.motion(scene, state).period):
        assert found == pytest.approx(float(period), rel=PERIOD_SHOWN)
    assert stabilab.extremes(scene,
                             [state])[0] == pytest.approx(np.array(energy.extremes(model, state), float),
                                                          rel=1e-11)


def test_a_well_that_rounding_leaves_no_depth_is_settled_in_balls():
    """Moments equal to 1e-15: the shift of the circle is 1e17 times the state. Any warning is an error here.
    """
    inertia, momentum = (1.6984403698883008, 1.4612860086384374,
                         1.6984403698882993), (268.9361171372486, 0.0, -550.4652889135042)
    scene, _ = physical(inertia, momentum, (0.0, 880.9962960879154, 0.0))
    states = np.array([[-4.491959245734427e17, 0.0, -5.7603753584755046e17],
                       [-0.0, -0.0, 0.18497229041996346], [0.0, 0.0, 0.0]])
    periods = extremes_and_periods(scene, states)[1]
    ones = [stabilab.motion(scene, state).period or np.inf for state in states.tolist()]
    assert periods == pytest.approx(ones, rel=PERIOD_SHOWN)


def test_the_error_by_rate_is_the_power_that_squares_with_every_doubling():
    """A geometric rule: changes of 1e-1, 1e-2, 1e-4 leave 1e-8; by chance the last is nothing, and the change
    before tells."""
    assert power_of_error(-1.0, -2.0, -4.0) == pytest.approx(-8.0)
    assert power_of_error(-1.0, -2.0, -30.0) == pytest.approx(-8.0)
    assert power_of_error(-1.0, -15.0, -4.0) > 0


def test_beside_the_separatrix_a_sum_that_cannot_settle_is_left_early(monkeypatch):
    """All 128 nodes, twice, take 130 pairs of values. The period in balls is the check."""
    scene = physical((3, 2, 1), (0.4, 0.1, 0), (0, 0, 0.05))[0]
    states, counts = np.random.default_rng(1).normal(size=(400, 3)), {"period_about": 0, "parts_of": 0}
    height = stabilab.fate(scene, states * [1, 1, 0]).margins
    reached = np.isfinite(height) & (height > 0)
    states[reached, 2] = np.sqrt(2 * height[reached]) * (1 - 10 ** np.linspace(-9, -5, reached.sum()))

    def counted(module, name):
        function = getattr(module, name)
        return lambda *args: (counts.update({name: counts[name] + 1}), function(*args))[1]
    for module, name in ((rows_kernel, "period_about"), (arc_kernel, "parts_of")):
        monkeypatch.setattr(module, name, counted(module, name))
    land, rows = landscape(scene), states[reached][:12]
    periods, left_open = np.empty(12), np.full(12, PERIOD, np.uint8)
    with np.errstate(all="ignore"):
        rows_kernel.rows(rows, np.arange(12), *land.kernel_input, rules(), np.empty((0, 3, 2)), periods, left_open)
    assert not left_open.any() and counts["period_about"] == 12 and counts["parts_of"] <= 12 * 33
    exact = [precise_period(Orbit(land.reduction, row), Fate.BOUNDED) for row in rows.tolist()]
    assert periods == pytest.approx(exact, rel=1e-11)
