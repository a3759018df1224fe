"""Taylor steps, compiled and as they are written, against runs by other formulas."""
import numpy as np
import pytest

from stabilab import Body, ConstantTorque, Gyrostat, Scene
from stabilab.unreduced.spin_up.drift import Runs

from .scenes import EXAMPLE, numba, rates_of, run


def states(seed, n):
    rng = np.random.default_rng(seed)
    return rng.normal(size=(n, 3)) * rng.choice([1, 3, 10, 50], size=(n, 1))


@pytest.mark.parametrize("fast", [False, pytest.param(True, marks=numba)])
def test_steps_side_by_side_end_where_a_run_by_another_formula_does(fast):
    """Forth to common times, and back again."""
    starts = states(4, 5)
    runs = Runs(EXAMPLE, starts, fast)
    out, times = runs.carried(starts, np.full(5, 0.7), 1000)
    assert (times == 0.7).all()
    for start, end in zip(starts, out):
        assert np.allclose(end, run(rates_of(EXAMPLE), start, np.array([0.0, 0.7]))[-1], rtol=0,
                           atol=1e-8 * (1 + np.abs(start).max()))
    back, times = runs.carried(out, np.full(5, -0.7), 1000)
    assert (times == -0.7).all() and np.allclose(back, starts, rtol=0,
                                                 atol=1e-11 * (1 + np.abs(starts).max()))


@pytest.mark.parametrize("small", [1e-30, 1e-45, 1e-60])
def test_steps_beside_a_saddle_stay_short_though_the_state_hardly_leaves_it(small):
    """Expected: the linear solution beside the free spin w2 = -20 about the middle axis of D = (3, 2, 1), w1'
    = -20 w3/3, w3' = -20 w1."""
    scene, r = Scene(Body((3, 2, 1)), Gyrostat((0, 0, 0)), ConstantTorque((0, 0, 0))), 3**0.5
    growing = lambda t: np.array([np.cosh(20 / r * t) - np.sinh(20 / r * t) / r,
                                  np.cosh(20 / r * t) - r * np.sinh(20 / r * t)])
    starts = np.array([[small, -20.0, small]])
    runs = Runs(scene, starts)
    out, _ = runs.carried(starts, np.array([2.0]), 1000)
    assert np.allclose(out[0, [0, 2]], small * growing(2.0), rtol=1e-3, atol=0)
    runs.advance(np.arange(1), 1000, 4.0)
    assert runs.times[0] == 4.0 and np.allclose(runs.states[0, [0, 2]], small * growing(4.0), rtol=1e-3,
                                                atol=0)
    assert runs.twins.growth[0] == pytest.approx(np.abs(growing(4.0)).max(), rel=0.05)


@numba
@pytest.mark.parametrize("steps", [12, 90])
def test_lanes_know_nothing_of_each_other(steps):
    """Bits of each of many motions, of different lengths, one of them beyond doubles, which take turns in the
    lanes where they have more than a few steps to go: those of the motion alone, by the text as it is written.
    """
    starts = states(7, 70)
    starts[5] = 1e200, -1e200, 1e200
    spans = np.random.default_rng(8).uniform(-1, 1, 70)
    many, one = Runs(EXAMPLE, starts, True), Runs(EXAMPLE, starts)
    out, times = many.carried(starts, spans, steps)
    assert (times == spans).any() and (times != spans).any() and not np.isfinite(out[5]).all()
    for n in (*range(4, 8), 37, 38, 69):
        alone, time = one.carried(starts[n:n + 1], spans[n:n + 1], steps)
        assert np.array_equal(alone[0], out[n], equal_nan=True) and time[0] == times[n]


def test_no_row_takes_more_steps_than_its_budget_whatever_the_others_take():
    runs = Runs(EXAMPLE, states(3, 2))
    runs.steps[:] = 0, 17
    runs.advance(np.arange(2), 6, 100.0, budget=20)
    assert runs.steps.tolist() == [6, 20] and (runs.times > 0).all()
