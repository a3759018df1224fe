"""Times at which a limit is first reached, against SciPy's events and against what is known without a run."""
import math
import random
from fractions import Fraction
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from stabilab import Body, ConstantTorque, Scene
from stabilab.answers.limit import asked
from stabilab.numbers.numba_door import installed
from stabilab.unreduced.crossing import first_crossing as of_thresholds

from ..spin_up.scenes import EXAMPLE, random_scene, rates_of, sphere


def first_crossing(scene, state, t_max=None, steps=None, **limit):
    """The first crossing of a limit, by its name as of `time_to`."""
    limit = asked(scene, **limit)
    found = of_thresholds(scene, state, limit.thresholds(Fraction(1)), Fraction(1), limit.direction, t_max, steps)
    return SimpleNamespace(low=float(found.until if found.low is None else found.low), done=found.done,
                           high=math.inf if found.high is None else float(found.high), steps=found.steps,
                           touched=found.low is not None)


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
    found = first_crossing(scene, state, rate=limit)
    true = by_events(scene, state, 50, lambda w: float(w @ w) - limit**2)
    assert found.low - 1e-9 <= true <= found.high + 1e-9 and found.high - found.low <= 1e-10 * found.high
    i, D = n % 3, np.array([float(d) for d in scene.body.exact])
    found = first_crossing(scene, state, 20.0, component=(i + 1, limit))
    true = by_events(scene, state, 20, lambda w: w[i] ** 2 - limit**2)
    assert (found.low == 20 and true == math.inf) or (found.low - 1e-8 <= true <= found.high + 1e-8
                                                      and found.high - found.low < 1e-9)
    found = first_crossing(scene, state, energy=4)
    true = by_events(scene, state, 50, lambda w: float(D @ (w * w)) / 2 - 4)
    assert found.low - 1e-8 <= true <= found.high + 1e-8


def test_a_spin_about_an_axis_is_linear_in_time():
    scene = Scene(Body((2, 2, 1)), ConstantTorque((0, 0, .25)))
    found = first_crossing(scene, (0, 0, 0.5), rate=3)
    assert found.low <= 10 <= found.high and found.high - found.low < 1e-10  # omega3 = 1/2 + t/4


def test_a_limit_that_is_touched_is_not_taken_for_one_that_is_passed():
    """omega of a body with two equal moments and no torque along its axis goes round at a constant size: the
    limit is exactly it, or just not."""
    scene = Scene(Body((2, 2, 1)), ConstantTorque((0, 0, 0.0)))
    assert first_crossing(scene, (.6, .8, 1), 5.0, rate=math.sqrt(2) * (1 - 1e-10)).low == 0
    assert first_crossing(scene, (.6, .8, 1), 5.0, rate=math.sqrt(2) * (1 + 1e-10)).low == 5
    touched = first_crossing(scene, (.6, .8, 1), 5.0, rate=math.sqrt(2))
    assert touched.high == math.inf and touched.touched and touched.done


@pytest.mark.skipif(not installed(), reason="thousands of steps take the compiled kernel")
def test_a_far_limit_is_reached_as_surely():
    found = first_crossing(EXAMPLE, (.1, 1, 2), rate=150)
    assert found.steps > 3000 and found.high - found.low < 1e-9 * found.high
    assert 140 < found.low < 150  # nearly omega3 = M3 t/D3


def test_where_the_search_ends_early_the_limit_is_surely_not_reached_before():
    found = first_crossing(EXAMPLE, (.1, 1, 2), steps=20, rate=1000)
    assert found.high == math.inf and 1 < found.low < 10 and not found.done
    below = first_crossing(EXAMPLE, (.1, 1, 2), 2.0, rate=1000)
    assert below.low == 2 and below.done and not below.touched


@pytest.mark.one_in(2)
@pytest.mark.parametrize("seed", range(4))
def test_a_tilt_and_a_rate_about_any_direction_are_found_too(seed):
    rng = random.Random(seed)
    scene, state, angle = random_scene(rng, .1), sphere(rng, .5), rng.uniform(.3, 2)
    axis = np.array(sphere(rng, 1))
    rate, cosine = rates_of(scene), math.cos(angle)

    def event(_, y):  # n' = n x omega, n the axis in space as the body sees it
        return cosine - y[3:] @ axis
    event.terminal, event.direction = True, 1
    run = solve_ivp(lambda _, y: [*rate(y[:3].tolist()), *np.cross(y[3:], y[:3])], (0, 20), [*state, *axis],
                    "DOP853", events=event, rtol=1e-12, atol=1e-12, max_step=0.1)
    found = first_crossing(scene, state, 20.0, tilt=(tuple(axis.tolist()), angle))
    true = run.t_events[0][0] if run.t_events[0].size else math.inf
    assert (found.low == 20 and true == math.inf) or (found.low - 1e-8 <= true <= found.high + 1e-8
                                                      and found.high - found.low < 1e-9)
    most = abs(axis @ state) + 1
    found = first_crossing(scene, state, 20.0, component=(tuple(axis.tolist()), most))
    true = by_events(scene, state, 20, lambda w: float((axis @ w) ** 2) - most**2)
    assert (found.low == 20 and true == math.inf) or (found.low - 1e-8 <= true <= found.high + 1e-8
                                                      and found.high - found.low < 1e-9)


def test_the_first_of_several_limits_counts():
    each = [first_crossing(EXAMPLE, (.1, 1, 2), 50.0, component=(i, most)).low
            for i, most in ((1, 1.5), (2, 1.5), (3, 2.5))]
    assert first_crossing(EXAMPLE, (.1, 1, 2), 50.0, rate=(1.5, 1.5, 2.5)).low == min(each) < max(each)
