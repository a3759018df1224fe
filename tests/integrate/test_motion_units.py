"""Tests of `physics/own_unit.py`: what once went wrong there, and its edges."""
from __future__ import annotations

import numpy as np
import pytest

import stabilab
from stabilab import Body, ConstantTorque, Gyrostat, ScaledGyrostat, Scene
from stabilab.integrate import own_units
from stabilab.physics.effects.rate_damper import RateDamper
from stabilab.physics.effects.resistance import Resistance
from stabilab.physics.own_unit import in_unit
from stabilab.physics.to_numpy import equations_of


def test_steps_of_slow_rates_are_told_in_the_scenes_time():
    scene, steps = Scene(Body((3, 2, "1.5")), ConstantTorque((0, 0, "1e-20"))), []
    run = stabilab.trajectory(scene, (1e-10, 2e-10, 1e-10), [1e10, 3e10], steps=steps)
    assert run.status == "reached" and len(steps) == run.counters["steps"]
    assert 0 < steps[0] < steps[-1] and steps[-1] >= 3e10 and (np.diff(steps) > 0).all()


@pytest.mark.parametrize("unit", [2.0**-40, 2.0**-130, 2.0**40])
def test_a_resisted_body_of_any_pace_keeps_its_digits(unit):
    """Law: with moment, rates and resistance times u the motion is the same in a time 1/u as long; u a power
    of two rounds nothing."""
    def asked(u):
        scene = Scene(Body((3, 2, 1.5)), Gyrostat((0, 0.1 * u, 0)), Resistance(0.3 * u))
        return np.array(stabilab.motion(scene, (0.3 * u, 2 * u, -u), (0, 5 / u)).extremes) / u
    assert np.abs(asked(unit) - asked(1.0)).max() < 1e-14


def test_slow_rates_keep_their_digits_over_many_turns():
    # found by make hunt: heyoka's step control is absolute below 1, and this motion came out 2e-6 wrong; the
    # quadrature shares
    # nothing with the series
    scene = Scene(Body((17.79453855572802, 45.11811854827859, 27.436331240110583)),
                  Gyrostat((7.860298788078874e-07, -9.999999999999999e-05, 0)),
                  ConstantTorque((0, 0, 5.536147107075782e-13)))
    state = [float.fromhex(v) for v in ("0x1.0593b1d2568c3p-23", "0x1.72ff16a634dccp-18",
                                        "-0x1.f3cb225036df2p-37")]
    ways = [stabilab.trajectory(scene, state, [2299008064.8281775], method=method).states[0]
            for method in ("taylor", "reduced")]
    # an energy that is right to 1e-14 fixes the small swing about axis 2, 5e-4 of it, to 3e-11, and 127 turns
    # of it to 2e-8
    np.testing.assert_allclose(ways[0], ways[1], rtol=0, atol=2e-8 * max(map(abs, state)))


def test_a_scene_in_another_unit_of_time_has_the_rates_of_the_first():
    scene, u, x = ScaledGyrostat("0.25", "-1.5", (0.5, 0, 2)), 8.0, [0.75, -2.0, 1.25]
    plain, fast = scene.quadratic().rate(x), in_unit(scene, u).quadratic().rate([v / u for v in x])
    assert [r / u**2 for r in plain] == fast  # x = u y, t = s/u: y' = x'/u^2; powers of two, so exactly


@pytest.mark.parametrize("rate", [1e-25, 1e-20, 1e-9, 1.0, 1e15, 1e20])
@pytest.mark.parametrize("coefficient", [1e-6, 0.25, 1000.0, 1e6])
@pytest.mark.parametrize("effect", [Resistance, RateDamper])
def test_a_sphere_that_a_medium_slows_keeps_its_digits_at_any_rate(effect, coefficient, rate):
    # closed form: nothing turns a sphere's rates into one another, so that each decays as exp(-c t), or as
    # exp(-c t/D)
    start = rate * np.array([1.0, 2.0, -1.0])
    pace = coefficient / (1 if effect is Resistance else 2)
    run = stabilab.trajectory(Scene(Body((2, 2, 2)), effect(coefficient)), start, np.array([0.1, 1, 5]) / pace)
    assert run.status == "reached" and max(run.invariant_drift.values()) < 1e-8
    expected = np.exp([-0.1, -1, -5])[:, None] * start
    assert np.abs(run.states - expected).max() < 2e-15 * 2 * rate


def test_rates_that_vanish_beside_their_decay_have_a_time_of_their_own():
    # closed form: about axis 3 a body speeds up to M/c as 1 - exp(-c t/D)
    scene = Scene(Body((3, 2, 1.5)), RateDamper("1e6"), ConstantTorque((0, 0, "1e-20")))
    t = 1.5e-6 * np.array([0.5, 1, 20])
    run = stabilab.trajectory(scene, (0, 0, 0), t)
    np.testing.assert_allclose(run.states[:, 2], 1e-26 * -np.expm1(-t / 1.5e-6), rtol=1e-14)


def test_a_run_that_stops_says_so_in_the_time_of_the_scene():
    # where the rates grow past every number: about equal rates 1e6 and a torque across, no run of doubles
    scene = Scene(Body((3, 2, 1.5)))
    run = stabilab.trajectory(scene, (1e30, 2e30, 1e30), [1e-30, 1e30])
    assert run.status == "stopped" and "t = 1e-30" in run.because.replace("1.0000000000000001e-30", "1e-30")


@pytest.mark.parametrize("size", [1e-300, 1e-160, 1e-12, 1.0, 1e12, 1e160, 1e300])
def test_the_glance_at_one_motion_sees_what_that_at_many_sees(size):
    """By arrays, which the other one leaves to where floats overflow."""
    rng = np.random.default_rng(4)
    for effects in ((), (Gyrostat((0.3, -0.2, 0.5)), ConstantTorque((0.1, 0.2, 0.1))), (Resistance("0.01"),)):
        equations = equations_of(Scene(Body((3, 2, "1.5")), *effects))
        for state in rng.normal(size=(20, 3)) * size:
            many = [float(column[0]) for column in own_units.sizes_of(equations, state[None])]
            assert np.allclose(own_units._sizes_of_one(equations, state), many, rtol=1e-15, atol=0)
            ordinary = own_units.are_ordinary(equations, *own_units.sizes_of(equations, state[None]))[0]
            if 0 < many[2] < np.inf:
                assert own_units._ordinary(equations, *many) == ordinary
