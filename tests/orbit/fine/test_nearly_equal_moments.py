"""Extremes and periods of rows by one formula on all orbits: moments that differ by any amount, from one
rounding to a half, equal ones, spheres; at rest, anywhere, and next to a barrier.

Nothing looks at the clock.
"""
from __future__ import annotations

import math
import random

import mpmath as mp
import numpy as np
import pytest
import sympy

import stabilab
from stabilab import Body, ConstantTorque, Fate, Gyrostat, ScaledGyrostat, Scene, fate
from stabilab.numbers.numba_door import installed
from stabilab.orbit import arc_kernel, barriers_arrays, equilibria_kernel
from stabilab.orbit.extremes import precise_extremes
from stabilab.orbit.extremes_arrays import settle_rows, trapped_rows
from stabilab.orbit.fate import decide
from stabilab.orbit.fate_arrays import fate_on_orbit
from stabilab.orbit.landscape import landscape
from stabilab.orbit.one_orbit import Orbit
from stabilab.orbit.period import precise_period
from stabilab.orbit.reduction import reduce
from tests.shared import later

KINDS = "pair", "next double", "parabola", "sphere", "nearly a sphere", "ordinary"


def random_scene(rng):
    """A body of which two moments are equal up to 1e-16 ... 0.5 of them (or to rounding, or exactly, or all
    three), the torque along any axis."""
    axis, kind = rng.randrange(3), rng.choice(KINDS)
    j, k = (axis + 1) % 3, (axis + 2) % 3
    second = [rng.uniform(0.05, 1) for _ in range(3)]
    size = 10 ** rng.uniform(-1, 3)
    D = [size * (sum(second) - second[n]) for n in range(3)]
    off = rng.choice((-1, 1)) * 10 ** rng.uniform(-16, -0.3)
    pair = rng.sample((axis, rng.choice((j, k))), 2)
    if kind == "pair":
        D[pair[0]] = D[pair[1]] * (1 + off)
    if kind == "next double":
        D[pair[0]] = math.nextafter(D[pair[1]], rng.choice((-1, 1)) * math.inf)
    if kind == "parabola":
        D[pair[0]] = D[pair[1]]
    if kind == "sphere":
        D = [D[0]] * 3
    if kind == "nearly a sphere":
        D = [D[0] * (1 + off * rng.uniform(-1, 1) / 3) for _ in range(3)]
    mean, rate = sum(D) / 3, 10 ** rng.uniform(-2, 0.5)
    wheel, torque = [0.0] * 3, [0.0] * 3
    for across in (j, k):
        wheel[across] = rng.choice((-1, 1)) * 10 ** rng.uniform(-2, 0.7) * mean * rate
    if rng.random() < 0.4:
        wheel[rng.choice((j, k))] = 0.0
    torque[axis] = rng.choice((-1, 1)) * 10 ** rng.uniform(-2.5, 0.3) * mean * rate**2
    return D, wheel, torque, axis


def scenes(seed):
    """(scene, axis, a generator of numbers for its states) without end; bodies that exist alone."""
    rng = random.Random(seed)
    while True:
        D, wheel, torque, axis = random_scene(rng)
        if 2 * max(D) < sum(D):
            yield Scene(Body(D), Gyrostat(wheel), ConstantTorque(torque)), axis, np.random.default_rng(
                rng.randrange(1 << 30))


def random_states(scene, axis, rng, count):
    """A fifth at rest about the torque's axis, a fifth with the rate that just passes a barrier, off by 1e-13
    ... 0.1 of its square, where there is one."""
    D = np.array([float(v) for v in scene.body.exact])
    wheel, torque = (np.array([float(v) for v in scene.vector(name)]) for name in ("gyrostat", "torque"))
    size = np.linalg.norm(wheel) / D.mean() + math.sqrt(np.linalg.norm(torque) / D.mean())
    states = rng.normal(size=(count, 3))
    states *= (size * 10 ** rng.uniform(-1, 1.3, count) / np.linalg.norm(states, axis=1))[:, None]
    states[::5, axis] = 0.0
    still = np.array(states[1::5])
    still[:, axis] = 0.0
    height = fate(scene, still).margins
    beside = np.isfinite(height) & (height > 0)
    off = 1 + rng.choice((-1, 1), len(still)) * 10 ** rng.uniform(-13, -1, len(still))
    still[:, axis] = np.sqrt(2 * np.where(beside, height, 0) / D[axis] * off)
    states[1::5][beside] = still[beside]
    return states


@pytest.mark.parametrize("by_numba", [False, pytest.param(True, marks=pytest.mark.slow)])
@pytest.mark.parametrize("seed", [3, *later(range(4, 36))])
def test_rows_have_the_digits_of_balls_whatever_the_difference_of_two_moments(seed, by_numba):
    if by_numba and not installed():
        pytest.skip("needs numba")
    full, open_rows, draw = 0, 0, scenes(seed)
    for _ in range(15):
        scene, axis, rng = next(draw)
        states, land = random_states(scene, axis, rng, 10), landscape(scene)
        states = states[trapped_rows(land, fate_on_orbit(scene, land, states))]
        boxes, periods = np.full((len(states), 3, 2), np.nan), np.full(len(states), np.nan)
        left = np.full(len(states), 3, np.uint8)
        settle_rows(land, states, boxes, periods, left, by_numba)
        full, open_rows = full + len(states), open_rows + np.count_nonzero(left)
        for state, box, time, bits in zip(states.tolist(), boxes, periods, left):
            orbit = Orbit(land.reduction, state)
            if not bits & 1:
                exact = np.array(precise_extremes(orbit, Fate.BOUNDED), float)
                error = np.abs(box - exact).max(axis=1) / np.abs(exact).max(axis=1)
                assert (error <= 1e-12).all(), (scene, state)
            if not bits & 2:
                assert time == pytest.approx(precise_period(orbit, Fate.BOUNDED), rel=1e-11), (scene, state)
    assert full > 80 and open_rows <= full / 50


@pytest.mark.parametrize("by_numba", [False, pytest.param(True, marks=pytest.mark.slow)])
@pytest.mark.parametrize("seed", [2, *later(range(40, 60))])
def test_spin_ups_and_rotations_have_the_digits_of_balls_whatever_the_difference_of_two_moments(seed, by_numba):
    if by_numba and not installed():
        pytest.skip("needs numba")
    draw, rows, open_rows = scenes(seed), {Fate.SPIN_UP: 0, Fate.BOUNDED: 0}, 0
    for number in range(90):
        scene, axis, rng = next(draw)
        if number % 3 == 0:  # without a torque, about the axis across which the wheel stands
            scene = Scene(scene.body, Gyrostat([float(v) for v in scene.vector("gyrostat")]))
        land = landscape(scene)
        if land is None or land.e >= 0:
            continue
        states = random_states(scene, land.reduction.axis, rng, 10) if land.sense else rng.normal(
            size=(10, 3)) * 10 ** rng.uniform(-1, 1, (10, 1))
        labels = fate_on_orbit(scene, land, states)
        turning = (labels.labels == Fate.SPIN_UP) | (~trapped_rows(land, labels) & (labels.labels == Fate.BOUNDED))
        states, labels = states[turning], labels.labels[turning]
        boxes, periods = np.full((len(states), 3, 2), np.nan), np.full(len(states), np.nan)
        left = np.where(labels == Fate.BOUNDED, 3, 1).astype(np.uint8)
        settle_rows(land, states, boxes, periods, left, by_numba, "turns")
        open_rows += np.count_nonzero(left)
        for state, label, box, time, bits in zip(states.tolist(), labels, boxes, periods, left):
            orbit, rows[Fate(label)] = Orbit(land.reduction, state), rows[Fate(label)] + 1
            if not bits & 1:
                exact = np.array(precise_extremes(orbit, label), float)
                np.testing.assert_array_equal(np.isinf(box), np.isinf(exact))
                box, exact = np.nan_to_num(box, posinf=0.0, neginf=0.0), np.nan_to_num(exact, posinf=0.0, neginf=0.0)
                error = np.abs(box - exact).max(axis=1)
                assert (error <= 1e-12 * np.abs(exact).max(axis=1)).all(), (scene, state)
            if label == Fate.BOUNDED and not bits & 2:
                assert time == pytest.approx(precise_period(orbit, label), rel=1e-11), (scene, state)
    assert min(rows.values()) > 20 and open_rows <= sum(rows.values()) / 50


def assert_margins(land, axis, states, margins):
    """Promised: 1e-12 of the kinetic energy about the torque's axis and of the barrier's height. Returns how
    many barriers there are."""
    barriers = 0
    for state, margin in zip(states.tolist(), margins):
        exact = decide(Orbit(land.reduction, state)).margin
        exact *= float(land.reduction.exact_energy_unit / land.reduction.weight)
        if math.isinf(exact):  # no barrier
            assert margin == (math.inf if land.potential.walled else -math.inf), (land.reduction, state)
            continue
        energy = 0.5 * (state[axis] + float(land.reduction.s)) ** 2
        assert abs(margin - exact) <= 1e-12 * (energy + abs(energy + exact)), (land.reduction, state)
        assert (margin > 0) == (exact > 0), (land.reduction, state)
        barriers += 1
    return barriers


@pytest.mark.parametrize("seed", [4, *later(range(80, 100))])
def test_margins_have_the_digits_and_the_sign_of_balls_whatever_the_difference_of_two_moments(seed):
    draw, full, barriers, open_rows = scenes(seed), 0, 0, 0
    for _ in range(40):
        scene, axis, rng = next(draw)
        land, states = landscape(scene), random_states(scene, axis, rng, 10)
        results, settled = np.full(10, np.nan), np.zeros(10, bool)
        with np.errstate(all="ignore"):
            equilibria_kernel.margins(states, np.arange(10), *land.kernel_input, results, settled)
        full, open_rows = full + 10, open_rows + np.count_nonzero(~settled)
        barriers += assert_margins(land, axis, states[settled], results[settled])
    assert full == 400 and barriers > 100 and open_rows <= 4


@pytest.mark.parametrize("seed", [7, *later(range(120, 140))])
def test_margins_in_doubles_have_the_digits_and_the_sign_of_balls(seed):
    """On all orbits, circles about an axis across which moments are nearly equal too, on which the force is nearly
    one sine."""
    draw, full, doubts = scenes(seed), 0, 0
    barriers = {1: 0, 0: 0, -1: 0, "across": 0}
    while min(barriers.values()) < 15:
        scene, axis, rng = next(draw)
        if across := rng.random() < 0.2:
            D = list(map(float, scene.body.exact))
            D[axis - 1] = D[axis - 2] * (1 + 10 ** rng.uniform(-16, -3))
            if 2 * max(D) >= sum(D):
                continue
            scene = Scene(Body(D), *scene.effects)
        land = landscape(scene)
        states = random_states(scene, axis, rng, 8)
        results, doubtful = barriers_arrays.margins_of(land.reduction, land.orbits, states)
        full, doubts = full + 8, doubts + np.count_nonzero(doubtful)
        barriers["across" if across and land.e < 0 else land.e] += assert_margins(
            land, axis, states[~doubtful], results[~doubtful])
    assert doubts <= 0.05 * full


@pytest.mark.slow
def test_compiled_margins_are_the_bytes_of_numpy(monkeypatch):
    """Nothing but sums, products, quotients and square roots, whose digits the standard of floats fixes."""
    if not installed():
        pytest.skip("needs numba")
    draw = scenes(11)
    for _ in range(30):
        scene, axis, rng = next(draw)
        land, states = landscape(scene), random_states(scene, axis, rng, 50)
        both = []
        for fast in (False, True):
            monkeypatch.setattr(barriers_arrays.BARRIERS, "pays", lambda work, fast=fast: fast)
            both.append(barriers_arrays.margins_of(land.reduction, land.orbits, states))
        clear = ~both[0][1]
        assert clear.tobytes() == (~both[1][1]).tobytes() and clear.any()
        assert both[0][0][clear].tobytes() == both[1][0][clear].tobytes(), scene


def test_margins_of_a_few_states_are_the_bytes_of_those_among_many_and_their_work_is_counted(monkeypatch):
    """The same operations, written once, on numbers and on arrays; a call of arrays costs what many of its
    rows do, so that it repays loading compiled code sooner than its rows alone would."""
    draw, work = scenes(12), []
    monkeypatch.setattr(barriers_arrays.BARRIERS, "pays", lambda seconds: work.append(seconds))
    for _ in range(6):
        scene, axis, rng = next(draw)
        land, states = landscape(scene), random_states(scene, axis, rng, 12)
        full, doubtful = barriers_arrays.margins_of(land.reduction, land.orbits, states)
        for n in np.flatnonzero(~doubtful).tolist():
            alone, doubt = barriers_arrays.margins_of(land.reduction, land.orbits, states[n:n + 1])
            assert alone.tobytes() == full[n:n + 1].tobytes() and not doubt
    assert max(work) > 5 * min(work) > 0 and len(work) > 30


def test_an_arc_of_any_length_has_its_third_function_to_some_roundings():
    """y and S3 = (S1 - y)/e of x = tan(y/2), y/2 or tanh(y/2), by mpmath at 40 digits."""
    rng = random.Random(2)
    with mp.workdps(40):
        for number in range(60):
            e = number % 3 - 1
            x = 10 ** rng.uniform(-9, 9 if e < 0 else 2) if e <= 0 else math.tanh(10 ** rng.uniform(-8, 0.78))
            arc, exact = (mp.atan, mp.mpf, mp.atanh)[e + 1], mp.mpf(x)
            y, third = barriers_arrays.third(x, 1.0, (1 - x) * (1 + x) if e > 0 else 1 - e * x * x, float(e))
            angle = 2 * arc(exact)
            expected = (2 * exact / (1 - e * exact**2) - angle) / e if e else angle**3 / 6
            assert y == pytest.approx(float(angle), rel=1e-15, abs=0)
            assert third == pytest.approx(float(expected), rel=2e-15, abs=0)


def test_the_discriminant_tells_how_many_roots_of_a_quartic_are_real():
    """Quartics and cubics of random roots; 27 times the discriminant as SymPy forms it."""
    rng, x = np.random.default_rng(1), sympy.symbols("x")
    for number in range(40):
        pairs, high = number % 3, float(number % 4 > 0)
        roots = rng.integers(-9, 9, 4) + (np.arange(4) + 0.5) / 7  # distinct
        quartic = np.polynomial.polynomial.polyfromroots(roots[: 4 - 2 * pairs])
        for _ in range(pairs):
            quartic = np.polynomial.polynomial.polymul(quartic, (rng.uniform(1, 9), rng.uniform(-1, 1), 1.0))
        if not high:  # a cubic, whose fourth root is infinite
            quartic = np.polynomial.polynomial.polyfromroots(roots[:3])
        quartic = np.append(quartic, 0.0)[:5]
        exact = sympy.Poly(list(map(sympy.Rational, quartic[::-1])), x)
        expected = float(27 * (exact.discriminant() if high else exact.LC() ** 2 * exact.discriminant()))
        found, _ = barriers_arrays.discriminant(quartic.tolist(), [0.0] * 5)
        assert found == pytest.approx(expected, rel=1e-6)
        assert (found < 0) == (high and pairs == 1)


def test_a_margin_beside_a_fold_or_at_a_barrier_is_left_to_exact_numbers():
    """X1 = 0, X2 = -1/b is a saddle of the scaled minor-axis system (rates by hand). On a parabola a pair of
    equilibria merges where the cubic has a double root: K' = 1 - 3 T + 4 T^3 = (1 - 2 T)^2 (1 + T)."""
    saddle = landscape(ScaledGyrostat("0.25", "0.5", (0, 0, 1)))
    results, settled = np.full(2, np.nan), np.zeros(2, bool)
    equilibria_kernel.margins(np.array([[0.0, -2.0, 0.3], [1.0, 2.0, 3.0]]), np.arange(2), *saddle.kernel_input,
                           results, settled)
    assert settled.tolist() == [False, True]
    series = 0.0, 1.0, -1.5, 0.0, 0.0, 1.0, 0.0  # K' = f0 + 2 f1 T + 4 g T^3 on a parabola
    room = np.empty((2, 8)), np.empty(8), np.empty(16)
    assert equilibria_kernel.equilibria(series, equilibria_kernel.DOUBT, *room) == -1
    near = 0.0, 1.0, -1.49, 0.0, 0.0, 1.0, 0.0  # a little less steep: the pair is gone, and clearly so
    assert equilibria_kernel.equilibria(near, equilibria_kernel.DOUBT, *room) == 1
    steep = 0.0, 1.0, -1.51, 0.0, 0.0, 1.0, 0.0
    assert equilibria_kernel.equilibria(steep, equilibria_kernel.DOUBT, *room) == 3


@pytest.mark.parametrize("seed", [1, *later(range(60, 80))])
def test_rows_beside_the_planes_and_the_centre_of_a_hyperbola_have_the_digits_of_balls(seed):
    """From a tenth down to 1e-12 of a rate beside an invariant plane, or the centre: such motions go out and
    come back by some thirty times the size of the throat's arc."""
    rng, full, open_rows = np.random.default_rng(seed), 0, 0
    for _ in range(6):
        second = rng.uniform(0.05, 1, 3)
        low, middle, high = np.sort(second.sum() - second)
        scene = Scene(Body((low, high, middle)), Gyrostat((*rng.normal(size=2) * 10 ** rng.uniform(-1, 1), 0)),
                      ConstantTorque((0, 0, rng.choice((-1, 1)) * 10 ** rng.uniform(-2, 1))))
        land = landscape(scene)
        (sj, sk), slope = map(float, land.reduction.centre), math.sqrt(abs(land.reduction.p / land.reduction.q))
        off = 10 ** rng.uniform(-12, -1, (12, 1)) * rng.normal(size=(12, 2))
        along = np.where(np.arange(12) % 2, 0, rng.normal(size=12)) * 10 ** rng.uniform(-1, 1, 12)
        sign = rng.choice((-1, 1), 12)
        states = np.stack([-sj + slope * along + off[:, 0], -sk + sign * along + off[:, 1],
                           rng.normal(size=12)], axis=1)
        states = states[trapped_rows(land, fate_on_orbit(scene, land, states))]
        boxes, periods = np.full((len(states), 3, 2), np.nan), np.full(len(states), np.nan)
        left = np.full(len(states), 3, np.uint8)
        settle_rows(land, states, boxes, periods, left, False)
        full, open_rows = full + len(states), open_rows + np.count_nonzero(left)
        for state, box, time, bits in zip(states.tolist(), boxes, periods, left):
            orbit = Orbit(land.reduction, state)
            exact = np.array(precise_extremes(orbit, Fate.BOUNDED), float)
            error = np.abs(box - exact).max(axis=1) / np.abs(exact).max(axis=1)
            assert bits & 1 or (error <= 1e-12).all(), (scene, state)
            assert bits & 2 or time == pytest.approx(precise_period(orbit, Fate.BOUNDED), rel=1e-11), (scene, state)
    assert full > 50 and open_rows <= full / 10


@pytest.mark.parametrize("seed", [5, *later(range(100, 120))])
def test_rows_that_rest_beside_a_saddle_have_the_digits_of_balls_or_stay_open(seed):
    """At the double nearest to an equilibrium, or 1e-15 ... 1e-5 beside it: one end of the motion is the state, and
    only 32 digits know it from an end beyond the barrier."""
    draw, full, open_rows = scenes(seed), 0, 0
    for _ in range(12):
        scene, axis, rng = next(draw)
        land = landscape(scene)
        places = [sample.at for curve in stabilab.equilibria(scene).curves for sample in curve.samples]
        if not places:
            continue
        states = np.array([places[n] for n in rng.integers(len(places), size=10)], float)
        states[::2] *= 1 + 10.0 ** rng.uniform(-15, -5, (5, 1)) * rng.normal(size=(5, 3))
        states[:, axis] = 0.0
        states = states[trapped_rows(land, fate_on_orbit(scene, land, states))]
        boxes, periods = np.full((len(states), 3, 2), np.nan), np.full(len(states), np.nan)
        left = np.full(len(states), 3, np.uint8)
        settle_rows(land, states, boxes, periods, left, False)
        full, open_rows = full + len(states), open_rows + np.count_nonzero(left)
        for state, box, time, bits in zip(states.tolist(), boxes, periods, left):
            orbit = Orbit(land.reduction, state)
            if not bits & 1:
                exact = np.array(precise_extremes(orbit, Fate.BOUNDED), float)
                assert (np.abs(box - exact).max(axis=1) <= 1e-12 * np.abs(exact).max(axis=1)).all(), (scene, state)
            assert bits & 2 or time == pytest.approx(precise_period(orbit, Fate.BOUNDED), rel=1e-11), (scene, state)
    assert full > 40 and open_rows <= full / 2


class ClosedForm:
    """u, v and K of an arc by sines about the centre of the orbit, or powers on a parabola: what the entire
    functions stand for, in the digits of mpmath."""

    def __init__(self, D, wheel, torque, axis, state):
        exact = lambda values: [mp.mpf(float(v)) for v in values]
        D, wheel, torque, state = map(exact, (D, wheel, torque, state))
        j, k = (axis + 1) % 3, (axis + 2) % 3
        self.moments, self.torque = (D[axis], D[j], D[k]), torque[axis]
        self.u, self.v, self.w = state[j], state[k], state[axis]
        self.p, self.q = (D[k] - D[axis]) / D[j], (D[axis] - D[j]) / D[k]
        self.p0, self.q0 = wheel[k] / D[j], -wheel[j] / D[k]

    def at(self, y):
        """(u, v, K) by the linear pair's solution and the energy."""
        e = self.p * self.q
        if e:
            n = mp.sqrt(abs(e))
            cosine, sine = (mp.cosh(n * y), mp.sinh(n * y) / n) if e > 0 else (mp.cos(n * y), mp.sin(n * y) / n)
            sj, sk = self.q0 / self.q, self.p0 / self.p
            u = (self.u + sj) * cosine + self.p * (self.v + sk) * sine - sj
            v = (self.v + sk) * cosine + self.q * (self.u + sj) * sine - sk
        else:
            a, b = self.p * self.v + self.p0, self.q * self.u + self.q0
            u, v = self.u + a * y + self.p * b * y * y / 2, self.v + b * y + self.q * a * y * y / 2
        Di, Dj, Dk = self.moments
        fall = self.torque * y - Dj * (u * u - self.u**2) / 2 - Dk * (v * v - self.v**2) / 2
        return u, v, self.w**2 / 2 + fall / Di


def test_a_base_that_moves_obeys_the_closed_forms_to_thirty_digits():
    """Location and energy after an arc of up to three radians of the orbit, twofold and in doubles, with 90
    digits of mpmath from sines about the centre."""
    rng = random.Random(8)
    for _ in range(60):
        D, wheel, torque, axis = random_scene(rng)
        scene = Scene(Body(D), Gyrostat(wheel), ConstantTorque(torque))
        if reduce(scene) is None:
            continue
        axes, fine, *_ = landscape(scene).kernel_input
        state = np.array([rng.gauss(0, 1) for _ in range(3)])
        e = fine[arc_kernel.E, 0]
        y = rng.uniform(-1, 1) * min(3 / math.sqrt(abs(e)) if e else math.inf, 10 ** rng.uniform(-1, 3))
        base = arc_kernel.base_of(state, axes, fine)
        there = arc_kernel.moved(base, y, fine)
        over, force, _, terms = arc_kernel.kinetic(y, arc_kernel.rounded(base, e))
        with mp.workdps(90):
            closed = ClosedForm(D, wheel, torque, axis, state)
            exact, step = closed.at(mp.mpf(y)), mp.mpf(10) ** -30
            sizes = abs(state[axes[0]]) + abs(exact[0]), abs(state[axes[1]]) + abs(exact[1]), mp.mpf(terms)
            for pair, number, size in zip(there[:3], exact, sizes):
                assert abs(mp.mpf(float(pair[0])) + mp.mpf(float(pair[1])) - number) < 1e-26 * size
            slope = (closed.at(y + step)[2] - closed.at(y - step)[2]) / (2 * step)
            assert abs(over - exact[2]) < 1e-14 * terms
            assert force == pytest.approx(float(slope), rel=1e-12, abs=1e-13 * terms)
