"""Periods of arrays where doubles hardly know the well: in minute wells beside folds, and where rounding
leaves no depth at all."""
from __future__ import annotations

import numpy as np
import pytest

import stabilab
from benchmarks.random_scenes import drawn
from stabilab import Fate
from stabilab.orbit.extremes_and_periods import extremes_and_periods
from stabilab.orbit.one_orbit import Orbit
from stabilab.orbit.period import precise_period
from stabilab.orbit.reduction import reduce
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


@pytest.mark.parametrize("inertia, momentum, torque, state", [
    ((1.8630519156591676, 1.696851499662686, 1.3168816818404938),
     (-18.420251076478365, 3.3235404450054e-08, 0.0), (0.0, 0.0, 3.828110809581424e-07),
     (1.1978771698013784, 1.4316424324405161, 78.79880355241279)),
    ((1.9448459693920048, 3.362679349489744e-05, 1.9448459693920048),
     (0.10440655412040076, -1481.25684162023, 0.0), (0.0, 0.0, -0.001375579918299128),
     (-0.12218204125060778, 0.7680234656860417, 93.78097982492297))])
def test_one_state_has_its_period_to_eleven_digits_where_rounding_comes_in_by_several_ways(inertia, momentum,
                                                                                           torque, state):
    scene, model = physical(inertia, momentum, torque)
    true = float(energy.period(model, state))
    assert stabilab.motion(scene, state).period == pytest.approx(true, rel=1e-11)
    assert stabilab.period(scene, [state])[0] == pytest.approx(true, rel=1e-11)


# Random scenes of the benchmarks and states at which one trapezoidal sum is off by next to nothing although
# the next, of twice as many nodes, is off by 1e-10
# and more: the sign of the error goes round with the number of nodes
CHANCES = [(71, (-4.369887196205277, -3.7053518586755274, -6.066612005004346)),
           (54, (15.840901695272883, -20.884161715455843, -3.563450267521607)),
           (36, (-8.231244802341465, 6.754198759544569, 14.297228083012742)),
           (89, (7.369438363696288, -1.4192633006748567, 6.510306947190627)),
           (26, (-1.8110733364538487, 1.8204595003467698, 1.4749630109219507)),
           (31, (-0.10294682392994503, 1.8798661423752032, 6.084326362940442)),
           (19, (0.5718216380893093, -1.8594223696396366, 1.171774701482545))]


@pytest.mark.parametrize("number, state", CHANCES)
def test_a_sum_that_is_right_by_chance_does_not_end_the_doubling_of_its_nodes(number, state):
    """Ball arithmetic cuts the integral at every equilibrium and takes the double-exponential rule."""
    scene = drawn(number + 1)[number].scene
    exact = precise_period(Orbit(reduce(scene), state), Fate.BOUNDED)
    assert stabilab.period(scene, [state])[0] == pytest.approx(exact, rel=1e-12)
