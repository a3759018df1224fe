"""Drift of the stepping method over many turns: roundings by chance, no bias."""
import numpy as np
import pytest

from benchmarks.long_runs import Drift, drifts, growth, integrals, starts
from stabilab.integrate.to_heyoka import heyoka_available
from tests.oracles import taylor
from tests.oracles.model import scaled

pytestmark = pytest.mark.skipif(not heyoka_available(), reason="heyoka is not installed")


def test_the_integrals_are_constant_along_the_motion():
    """Against Taylor series in 30 digits, rounded to doubles."""
    state = starts(2)[1]
    run = taylor.integrate(scaled("0.2", "0.4", (0, 0, 1)), state, [0.0, 0.4, 1.1, 1.9], digits=30)
    for values in integrals(np.array(run, float)).values():
        assert np.ptp(values.astype(float)) < 4e-15 * np.abs(values).max()


@pytest.mark.parametrize("power", [0.5, 1.0])
def test_the_growth_of_known_drifts_is_told(power):
    rows = [Drift("energy", m, t, int(t), (-1) ** m * 1e-16 * t**power) for m in range(3)
            for t in (10.0, 100.0, 1000.0)]
    assert growth(rows, "energy") == pytest.approx(power)


@pytest.mark.parametrize("turns, motions", [(300, 3), pytest.param(1e5, 4, marks=pytest.mark.slow)])
def test_the_drift_grows_no_faster_than_the_root_of_the_number_of_steps(turns, motions):
    """Brouwer 1937: independent roundings, each up to half a unit, make a random walk; three times its spread
    is allowed. A bias of a tenth of a unit a step alone would exceed it after 1e4 steps."""
    rows = [row for n, state in enumerate(starts(motions)) for row in drifts(state, turns, n)]
    assert {r.integral for r in rows} == {"circle", "energy"} and max(r.turns for r in rows) > 0.7 * turns
    assert all(abs(r.drift) <= 3 * 2.0**-52 * np.sqrt(10 + r.steps) for r in rows)
