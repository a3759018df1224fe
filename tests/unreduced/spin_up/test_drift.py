"""Slow drifts run over many revolutions at once: against sums by hand, runs by DOP853 and the tangent flow.
"""
import random

import numpy as np
import pytest

from benchmarks.spin_up import random_scene as benchmark_scene
from stabilab import Body, ConstantTorque, Gyrostat, Scene
from stabilab.physics.own_unit import natural
from stabilab.unreduced.spin_up import drift
from stabilab.unreduced.spin_up.drift import Returns, Runs, window
from stabilab.unreduced.spin_up.follow import spin_up

from .scenes import EXAMPLE, numba, rates_of, run

FAST = Scene(Body((1.4, 1, 0.6)), Gyrostat((0.2, 0.1, -0.3)), ConstantTorque((0.5, 0.6, 0.62)))
START = (12.0, 20.0, 90.0)


def test_a_window_ends_where_a_run_by_another_formula_does():
    """Forty revolutions against DOP853, in place and time."""
    own, unit = natural(FAST)
    start = np.array([START]) / unit
    returns = Returns(Runs(own, start))
    periods, steps = returns.first(start)
    found = window(returns, start, np.array([40.0]), periods, steps.astype(float))
    assert found.good[0]
    end = run(rates_of(FAST), START, np.array([0, found.times[0] / unit]), rtol=1e-13)[-1]
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
