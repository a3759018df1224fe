"""Extremes and periods on parabolas (two equal moments): the kernel against balls, against quadrature, and what it leaves open."""
from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import ellipk

import stabilab
from stabilab import Body, ConstantTorque, Fate, Gyrostat, Scene
from stabilab.orbit.ball_orbit import Orbit
from stabilab.orbit.extremes import parabola_kernel
from stabilab.orbit.extremes.balls import precise_extremes
from stabilab.orbit.extremes.parabola_kernel import BOX, PERIOD
from stabilab.orbit.extremes.parabola_numba import by_kernel, run_kernel
from stabilab.orbit.landscape import landscape
from stabilab.orbit.period.balls import period_ball

SCENES = {"disc": Scene(Body((6.098, 6.098, 11.2)), Gyrostat((0, 1.104, -8.298)), ConstantTorque((-0.01, 0, 0))),
          "needle": Scene(Body((6.098, 6.098, 0.972)), Gyrostat((0, 1.104, -8.298)), ConstantTorque((-0.01, 0, 0))),
          "wheel across": Scene(Body((4.8, 9.8, 9.8)), Gyrostat((1.2, 0, 0.66)), ConstantTorque((0, 0.295, 0))),
          "strong torque": Scene(Body((0.77, 1.22, 0.77)), Gyrostat((0.3, 0.1, 0)), ConstantTorque((0, 0, 2.5)))}
each_scene = pytest.mark.parametrize("name", SCENES)


def states_of(name, count):
    """From a tenth of the rates that the wheel brings about to ten times these."""
    rng, scene = np.random.default_rng(len(name)), SCENES[name]
    way = rng.normal(size=(count, 3))
    rate = float(np.linalg.norm(np.array(scene.vector("gyrostat"), float)) / min(map(float, scene.body.exact)))
    return way / np.linalg.norm(way, axis=1)[:, None] * rate * 10 ** rng.uniform(-1, 1, (count, 1))


def settled(name, states, compiled=False):
    """(boxes, periods, bits that stay open)."""
    land, boxes, periods = landscape(SCENES[name]), np.empty((len(states), 3, 2)), np.empty(len(states))
    if compiled:
        return boxes, periods, by_kernel(land, states, boxes, periods, fast=True)
    return boxes, periods, run_kernel(parabola_kernel.orbits, land, states, BOX | PERIOD, boxes, periods)


def against_balls(name, state, box, period, left_open=0):
    orbit = Orbit(landscape(SCENES[name]).reduction, state)
    if not left_open & BOX:
        exact = np.array(precise_extremes(orbit, Fate.BOUNDED))
        assert (np.abs(box - exact).max(axis=1) <= 1e-12 * np.abs(exact).max(axis=1)).all(), state
    if not left_open & PERIOD:
        assert period == pytest.approx(float(period_ball(orbit, 16).mid()), rel=1e-11)


@each_scene
@pytest.mark.parametrize("compiled", [False, True], ids=["plain", "numba"])
def test_hardly_a_row_is_left_open_and_the_others_have_the_digits_of_balls(name, compiled):
    if compiled:
        pytest.importorskip("numba")
    states = states_of(name, 1500)
    boxes, periods, left_open = settled(name, states, compiled)
    assert np.count_nonzero(left_open & BOX) <= 3 and np.count_nonzero(left_open & PERIOD) <= 30
    for n in np.random.default_rng(1).permutation(np.nonzero(left_open == 0)[0])[:25]:
        against_balls(name, states[n], boxes[n], periods[n])
    assert ((boxes[..., 0] <= states) & (states <= boxes[..., 1]))[left_open & BOX == 0].all()


@each_scene
def test_next_to_a_separatrix_rows_have_their_digits_or_stay_open(name):
    """From a tenth of the rate at the barrier to a trillionth, and on to rounding, where all are left."""
    scene, land = SCENES[name], landscape(SCENES[name])
    states, axis = states_of(name, 400), land.reduction.axis
    found = stabilab.fate(scene, states)
    height = found.margins / land.reduction.energy_unit + 0.5 * land.start(states)[1] ** 2
    high = np.nonzero(np.isfinite(height) & (height > 0))[0][:6]
    assert len(high)
    answered = np.zeros(2, int)
    for distance in 10.0 ** -np.arange(1, 17):
        near = states[high]
        near[:, axis] = np.sqrt(2 * height[high]) * (1 + distance) - float(land.reduction.s)
        boxes, periods, left_open = settled(name, near)
        for n in np.nonzero(left_open != BOX | PERIOD)[0]:
            against_balls(name, near[n], boxes[n], periods[n], left_open[n])
        answered += np.count_nonzero(left_open & BOX == 0), np.count_nonzero(left_open & PERIOD == 0)
        assert distance > 1e-13 or (left_open == BOX | PERIOD).all()
    assert answered[0] >= 4 * len(high) and answered[1] >= len(high)


@each_scene
def test_states_at_rest_and_beside_it_and_turning_points(name):
    """What may be at rest stays open, for exact arithmetic decides it; with no rate about the axis a state is its own turning point."""
    land = landscape(SCENES[name])
    states = states_of(name, 40)
    offsets, spots, _ = land.critical(land.start(states)[0])
    rest = states[~np.isnan(offsets[:, 0])]
    rest[:, land.reduction.j], rest[:, land.reduction.k] = spots[:, ~np.isnan(offsets[:, 0]), 0]
    rest[:, land.reduction.axis] = -float(land.reduction.s)
    assert len(rest) and np.count_nonzero(settled(name, rest)[2] == BOX | PERIOD) >= 0.9 * len(rest)
    turning = states_of(name, 40)
    turning[:, land.reduction.axis] = -float(land.reduction.s)
    boxes, periods, left_open = settled(name, turning)
    assert np.count_nonzero(left_open) <= 4
    for n in np.nonzero(left_open == 0)[0][:8]:
        against_balls(name, turning[n], boxes[n], periods[n])


def test_the_mean_gives_the_complete_integral():
    for m in (0.0, 0.3, 0.9, 1 - 1e-9):
        assert 0.5 * math.pi / parabola_kernel.mean(1.0, math.sqrt(1 - m)) == pytest.approx(float(ellipk(m)), rel=1e-14)


@pytest.mark.parametrize("ends, inner", [((-1.0, 2.0), (1.3, 0.7)), ((-0.2, 0.1), (-4.0, 5.0)), ((-3.0, -1.0), (0.5, 1e-3))])
def test_the_period_between_two_roots_is_the_integral(ends, inner):
    """K = c (y - l)(r - y)((y - a)^2 + b), its coefficients by hand; the integral by SciPy's quadrature of the angle."""
    (left, right), (a, b), c = ends, inner, 0.8
    poly = c * np.polynomial.Polynomial.fromroots([left, right]) * -np.polynomial.Polynomial([a * a + b, -2 * a, 1])
    f = [float(poly.deriv(n)(0.0)) for n in (1, 2, 3, 4)]
    period, off = parabola_kernel.period_of(left, right, *f, (0.0, 0.0), (0.0, 0.0))
    middle, rho = 0.5 * (left + right), 0.5 * (right - left)
    exact = quad(lambda phi: math.sqrt(2) / math.sqrt(c * ((middle + rho * math.cos(phi) - a) ** 2 + b)), 0, math.pi, epsabs=0, epsrel=1e-13, limit=500)[0]
    assert period == pytest.approx(exact, rel=1e-12) and off < 1e-11


def test_arrays_and_the_kernel_agree_on_every_row():
    pytest.importorskip("numba")
    states = states_of("needle", 3000)
    for ask, promise in ((stabilab.extremes, 1e-12), (stabilab.period, 1e-11)):
        one, other = (ask(SCENES["needle"], states, fast=fast) for fast in (False, True))
        size = np.abs(one).max(axis=-1, keepdims=True) if one.ndim == 3 else one
        assert (np.abs(one - other) <= 2 * promise * size).all()


def test_the_bytes_do_not_depend_on_how_rows_are_split():
    pytest.importorskip("numba")
    states = states_of("disc", 3000)
    whole = stabilab.extremes(SCENES["disc"], states, fast=True).tobytes()
    assert whole == b"".join(stabilab.extremes(SCENES["disc"], part, fast=True).tobytes() for part in (states[:7], states[7:1100], states[1100:]))


def test_states_at_the_place_of_an_equilibrium_to_rounding_are_left_to_exact_arithmetic():
    """Found by the search of `hunt/parabolas`: at a barrier, with a rate of 1e-17, doubles put the energy above it, and exact arithmetic below."""
    scene = Scene(Body((0.9772121786953248, 1, 1)), Gyrostat((-1.127222631044502, 0, 1.5683903018982321)), ConstantTorque((0, 615.1464762599369, 0)))
    state = tuple(map(float.fromhex, ("-0x1.036b6becc30acp-3", "-0x1.3e7b05dd99639p-57", "-0x1.1178b59885828p+9")))
    land, box, period = landscape(scene), np.empty((1, 3, 2)), np.empty(1)
    assert run_kernel(parabola_kernel.orbits, land, np.array([state]), BOX | PERIOD, box, period)[0] == BOX | PERIOD
    exact = np.array(precise_extremes(Orbit(land.reduction, state), Fate.BOUNDED))
    assert exact[0, 0] == pytest.approx(state[0], rel=1e-12)  # it turns there; over the barrier it would reach -466
    for name in SCENES:  # and every equilibrium of these, with the least rates about the axis
        some = landscape(SCENES[name])
        states = states_of(name, 30)
        offsets, spots, _ = some.critical(some.start(states)[0])
        for column in range(offsets.shape[1]):
            at = states[~np.isnan(offsets[:, column])]
            at[:, some.reduction.j], at[:, some.reduction.k] = spots[:, ~np.isnan(offsets[:, column]), column]
            at[:, some.reduction.axis] = -float(some.reduction.s) + 1e-17
            boxes, periods, left_open = settled(name, at)
            for n in np.nonzero(left_open != BOX | PERIOD)[0]:
                against_balls(name, at[n], boxes[n], periods[n], left_open[n])
