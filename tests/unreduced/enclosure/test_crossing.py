"""Times at which a limit is first reached, against SciPy's events and against what is known without a run."""
import math
import random

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from stabilab import Body, ConstantTorque, Scene
from stabilab.errors import InputError
from stabilab.numbers.numba_door import installed
from stabilab.unreduced.off_axis import first_crossing

from ..spin_up.scenes import EXAMPLE, random_scene, rates_of, sphere


def by_events(scene, state, end, value):
    """The first time at which value(state) rises through 0, by DOP853."""
    event, rate = (lambda _, w: value(np.asarray(w))), rates_of(scene)
    event.terminal, event.direction = True, 1
    run = solve_ivp(lambda _, y: rate(y.tolist()), (0, end), state, "DOP853", events=event, rtol=1e-12,
                    atol=1e-12, max_step=0.1)
    return run.t_events[0][0] if run.t_events[0].size else math.inf


@pytest.mark.one_in(2)
@pytest.mark.parametrize("n", range(6))
def test_the_first_time_is_between_its_bounds(n):
    rng = random.Random(n)
    scene, state, limit = random_scene(rng, .1), sphere(rng, .5), rng.uniform(1, 2)
    found = first_crossing(scene, state, limit)
    true = by_events(scene, state, 50, lambda w: float(w @ w) - limit**2)
    assert found.low - 1e-9 <= true <= found.high + 1e-9 and found.high - found.low <= 1e-10 * found.high
    i, D = n % 3, np.array([float(d) for d in scene.body.exact])
    found = first_crossing(scene, state, limit, np.eye(3)[i], t_max=20.0)
    true = by_events(scene, state, 20, lambda w: w[i] ** 2 - limit**2)
    assert (found.low == 20 and true == math.inf) or (found.low - 1e-8 <= true <= found.high + 1e-8
                                                      and found.high - found.low < 1e-9)
    found = first_crossing(scene, state, 2.0, weights=D / 2)  # the energy reaches 4
    true = by_events(scene, state, 50, lambda w: float(D @ (w * w)) / 2 - 4)
    assert found.low - 1e-8 <= true <= found.high + 1e-8


def test_a_spin_about_an_axis_is_linear_in_time():
    scene = Scene(Body((2, 2, 1)), ConstantTorque((0, 0, .25)))
    found = first_crossing(scene, (0, 0, 0.5), 3.0)
    assert found.low <= 10 <= found.high and found.high - found.low < 1e-10  # omega3 = 1/2 + t/4


def test_a_limit_that_is_touched_is_not_taken_for_one_that_is_passed():
    """omega of a body with two equal moments and no torque along its axis goes round at a constant size: the
    limit is exactly it, or just not."""
    scene = Scene(Body((2, 2, 1)), ConstantTorque((0, 0, 0.0)))
    assert first_crossing(scene, (.6, .8, 1), math.sqrt(2) * (1 - 1e-10), t_max=5.0).low == 0
    assert first_crossing(scene, (.6, .8, 1), math.sqrt(2) * (1 + 1e-10), t_max=5.0).low == 5
    touched = first_crossing(scene, (.6, .8, 1), math.sqrt(2), t_max=5.0)
    assert touched.high == math.inf and "nearer than is known" in touched.because


@pytest.mark.skipif(not installed(), reason="thousands of steps take the compiled kernel")
def test_a_far_limit_is_reached_as_surely():
    found = first_crossing(EXAMPLE, (.1, 1, 2), 150.0)
    assert found.steps > 3000 and found.high - found.low < 1e-9 * found.high
    assert 140 < found.low < 150  # nearly omega3 = M3 t/D3


def test_where_the_search_ends_early_the_limit_is_surely_not_reached_before():
    found = first_crossing(EXAMPLE, (.1, 1, 2), 1e3, steps=20)
    assert found.high == math.inf and 1 < found.low < 10 and "used up" in found.because
    below = first_crossing(EXAMPLE, (.1, 1, 2), 1e3, t_max=2.0)
    assert below.low == 2 and below.because == "it stays below up to 2 s"


def test_a_limit_must_be_above_zero():
    for limit in (0, -1, math.nan, math.inf, "3"):
        with pytest.raises(InputError, match="limit"):
            first_crossing(EXAMPLE, (.1, 1, 2), limit)
