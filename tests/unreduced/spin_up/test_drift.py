"""Slow drifts run over many revolutions at once: against sums by hand, runs by DOP853 and the tangent flow.
"""
import random

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from benchmarks.spin_up import random_scene as benchmark_scene
from stabilab import Body, ConstantTorque, Gyrostat, Scene
from stabilab.unreduced.spin_up import drift
from stabilab.unreduced.spin_up.certificate import natural
from stabilab.unreduced.spin_up.drift import BETWEEN, NODES, Returns, Runs, Twins, matrices, window
from stabilab.unreduced.spin_up.follow import spin_up

from .scenes import EXAMPLE, euler, numba, rates_of

FAST = Scene(Body((1.4, 1, 0.6)), Gyrostat((0.2, 0.1, -0.3)), ConstantTorque((0.5, 0.6, 0.62)))
START = (12.0, 20.0, 90.0)


def dop(scene, start, end):
    """The state of a motion at a time, by SciPy's DOP853."""
    rate = rates_of(scene)
    return solve_ivp(lambda _, y: np.array(rate(y.tolist())), (0, end), start, "DOP853", rtol=1e-13,
                     atol=1e-12).y[:, -1]


@pytest.mark.parametrize("count", [16.0, 100.0, 4097.0])
def test_sums_of_polynomials_are_those_by_hand(count):
    """x(n) = sum of d(i), i < n, for d = 1, i, i^2, i^3: n, n(n-1)/2, n(n-1)(2n-1)/6, (n(n-1)/2)^2."""
    sums, powers, coefficients, between = matrices()
    n = count * (1 - np.cos(np.pi * np.arange(NODES + 1) / NODES)) / 2
    matrix = (count ** powers.astype(float)[:, None, None] * sums).sum(axis=0)
    pair = n * (n - 1) / 2
    for d, expected in ((np.ones_like(n), n), (n, pair), (n**2, pair * (2 * n - 1) / 3), (n**3, pair**2)):
        assert np.allclose(matrix @ d, expected, rtol=0, atol=1e-13 * count * np.abs(d).max())
    assert between @ n**3 == pytest.approx((BETWEEN * count)**3,
                                           rel=1e-13) and np.abs(coefficients @ n**3)[
                                               4:].max() < 1e-13 * count**3


def test_slopes_are_those_of_the_rates_forth_and_back():
    """Against differences of Euler's equations: those are quadratic, so central differences are exact."""
    runs, rng = Runs(EXAMPLE, np.zeros((5, 3))), np.random.default_rng(1)
    states, directions, weights = rng.normal(size=(3, 5, 3))
    rate = rates_of(EXAMPLE)
    expected = np.array([(np.array(rate(w + v)) - np.array(rate(w - v))) / 2 for w,
                         v in zip(states, directions)])
    assert np.allclose(runs.rates(states),
                       [rate(w) for w in states]) and np.allclose(runs.slopes(states, directions), expected)
    assert np.allclose((runs.slopes_back(states, weights) * directions).sum(axis=1),
                       (expected * weights).sum(axis=1))


def test_a_window_ends_where_a_run_by_another_formula_does():
    """Forty revolutions against DOP853, in place and time."""
    own, unit = natural(FAST)
    start = np.array([START]) / unit
    returns = Returns(Runs(own, start))
    periods, steps = returns.first(start)
    found = window(returns, start, np.array([40.0]), periods, steps.astype(float))
    assert found.good[0]
    end = dop(FAST, START, found.times[0] / unit)
    assert np.allclose(end, found.states[0] * unit, rtol=0, atol=1e-7)
    D = np.array([1.4, 1, 0.6])
    energy = lambda w: float((D * w**2).sum())  # knows nothing of the phase, whose error is that of both runs
    assert energy(found.states[0] * unit) == pytest.approx(energy(end), rel=1e-10)


def test_a_window_that_meets_no_smooth_drift_is_refused():
    """Five natural units of speed: a revolution changes the motion too much for six hundred of them to be a
    polynomial."""
    own, unit = natural(FAST)
    start = np.array([[0.3, 0.5, 1.0]]) / unit
    returns = Returns(Runs(own, start))
    found = window(returns, start, np.array([600.0]), np.array([3.0]), np.array([10.0]))
    assert not found.good[0]


def test_growth_is_that_of_the_tangent_flow_across_the_motion():
    """Against the variational equation by DOP853, from the first direction, what lies along the motion taken
    off."""
    rate, runs = rates_of(FAST), Runs(FAST, np.array([START]))

    def both(_, y):
        w, v = y[:3], y[3:]
        slope = [(a - b) / 2 for a, b in zip(rate(w + v), rate(w - v))]
        return np.array([*rate(w), *slope])
    first = (runs.twins.ahead[0] - (along := np.array(rate(START))) * (runs.twins.ahead[0] @ along)
             / (along @ along))
    runs.advance(np.array([0]), 100, 1e300)
    end = solve_ivp(both, (0, runs.times[0]), [*START, *first], "DOP853", rtol=1e-12, atol=1e-12).y[:, -1]
    along = np.array(rate(end[:3]))
    across = end[3:] - along * (end[3:] @ along) / (along @ along)
    assert runs.twins.growth[0] == pytest.approx(np.abs(across).max(), rel=0.02)
    assert runs.twins.blur[0] > 0 and np.isfinite(runs.twins.blur[0])


def test_a_mere_delay_is_no_growth():
    """A twin ahead on the same motion: nothing lies across it."""
    rates = lambda states: np.array([euler((1.4, 1, 0.6), (0.2, 0.1, -0.3), (0.5, 0.6, 0.62), w)
                                     for w in states])
    twins, state = Twins(1, rates), np.array([START])
    early = dop(FAST, START, 1e-6)[None]
    lost = twins.compare(np.array([0]), state, state, early, np.array([0.0]), np.array([1e-5]),
                         np.array([1e-15]))
    assert not lost[0] and twins.growth[0] < 1e-4


@pytest.mark.slow
@numba  # half a million steps one by one
def test_a_slow_despin_is_certified_by_far_fewer_steps_than_it_takes():
    """The torque's share about the axis of spin is 0.0013: half a million steps one by one. Its energy at
    that time is that of the plain run, step by step, to nine digits."""
    rng = random.Random(7)
    scene, state, *_ = [benchmark_scene(rng) for _ in range(292)][-1]
    answer = spin_up(scene, state)
    assert answer.level == "certified" and answer.passed > 5 * answer.steps and answer.trap.blur > 0
    runs = Runs(scene, np.array([state]), fast=True)
    while runs.times[0] < answer.t:
        runs.advance(np.array([0]), 20_000, answer.t)
    D = np.array([float(d) for d in scene.body.exact])
    assert float((D * runs.states[0]**2).sum()) == pytest.approx(float((D * np.array(answer.state)**2).sum()),
                                                                 rel=1e-9)


@pytest.mark.slow
@numba
def test_leaps_change_no_verdict(monkeypatch):
    """Motions that leap as soon as they may, and those that never do."""
    starts = [(12.0, 20.0, -90.0)]
    plain = [spin_up(FAST, start) for start in starts]
    monkeypatch.setattr(drift, "FROM", 0)
    leapt = [spin_up(FAST, start) for start in starts]
    assert [(a.level, a.axis, a.sense) for a in plain] == [(a.level, a.axis, a.sense) for a in leapt]


def test_the_clock_allows_for_the_blur_of_the_time():
    from dataclasses import replace
    answer = spin_up(EXAMPLE, (1.0, 0.5, 0.2))
    wide = replace(answer.trap, blur=0.5)
    limit = 5 * answer.trap.z_up * answer.trap.unit
    (early, late), (earlier, later) = answer.trap.clock(limit), wide.clock(limit)
    assert earlier == pytest.approx(early - 0.5 + answer.trap.blur, rel=1e-9)
    assert later == pytest.approx(late + 0.5 - answer.trap.blur, rel=1e-9)
    assert wide.line(answer.t + 10)[0] < answer.trap.line(answer.t + 10)[0]
