"""Random scenes decided, each against a run by brute force from its start: Euler's equations written anew,
the classical Runge-Kutta formula."""
import random
from dataclasses import replace
from importlib.util import find_spec

import numpy as np
import pytest

from benchmarks.spin_up import random_scene
from benchmarks.spin_up_sample import scenes
from stabilab.unreduced.spin_up.follow import spin_up

from .scenes import EXAMPLE, euler

numba = pytest.mark.skipif(find_spec("numba") is None,
                           reason="needs numba for a hundred turns in a hundredth of a radian each")
# of a step, radians: its loss of amplitude is h^5/144 a radian, its phase lags by h^4/120
ANGLE, TURNS = 0.01, 100
LONGEST = 3000.0  # radians on the way to the certificate: 0.01^4/120 of them is 2.5e-7


@pytest.fixture(scope="module")
def brute():
    """Compiled: run(D, l, M, start, times) -> states (n, 3)."""
    from numba import njit
    rate = njit(euler_rate)

    @njit
    def run(D, l, M, start, times):
        out = np.empty((times.size, 3))
        wheel = 1.0 + 2 * np.abs(l / D).max()
        x, y, z = start
        out[0] = start
        for n in range(1, times.size):
            t = times[n - 1]
            while t < times[n]:
                h = min(ANGLE / (wheel + 2 * max(abs(x), abs(y), abs(z))), times[n] - t)
                a, b, c = rate(D, l, M, x, y, z)
                d, e, f = rate(D, l, M, x + 0.5 * h * a, y + 0.5 * h * b, z + 0.5 * h * c)
                p, q, r = rate(D, l, M, x + 0.5 * h * d, y + 0.5 * h * e, z + 0.5 * h * f)
                u, v, w = rate(D, l, M, x + h * p, y + h * q, z + h * r)
                x, y, z = x + h / 6 * (a + 2 * (d + p)
                                       + u), y + h / 6 * (b + 2 * (e + q)
                                                          + v), z + h / 6 * (c + 2 * (f + r) + w)
                t = times[n] if t + h >= times[n] else t + h
            out[n, 0], out[n, 1], out[n, 2] = x, y, z
        return out
    return run


def euler_rate(D, l, M, x, y, z):
    """D omega' = M - omega x (D omega + l)."""
    a, b, c = D[0] * x + l[0], D[1] * y + l[1], D[2] * z + l[2]
    return (M[0] - y * c + z * b) / D[0], (M[1] - z * a + x * c) / D[1], (M[2] - x * b + y * a) / D[2]


def parts(scene):
    return tuple(np.array([float(v) for v in vector])
                 for vector in (scene.body.exact, scene.vector("gyrostat"), scene.vector("constant_torque")))


def contradictions(scene, state, answer, brute) -> list[str]:
    """Where the run from the start leaves what is said of the motion: its place at the time of the
    certificate, the bounds and lines after it."""
    D, l, M = parts(scene)
    pace = 1 + 2 * np.abs(answer.state).max() + 2 * np.abs(l / D).max()
    times = answer.t + np.linspace(0, 6.3 * TURNS / pace, 201)
    run = brute(D, l, M, np.array(state), np.append(0.0, times) if answer.t else times)[-201:]
    turned = pace * (answer.t + 1)
    # of the formula
    blur = 1e-7 * (1 + np.abs(answer.state).max()) * (1 + answer.condition) * (1 + turned / LONGEST)
    spin, direction = run @ np.array(answer.direction), np.array(answer.direction)
    low, high = np.array([answer.trap.line(t) for t in times]).T
    wrong = [f"line {side}" for side,
             bad in (("below", spin < low - blur), ("above", spin > high + blur)) if bad.any()]
    wrong += [f"axis {n + 1}" for n, (a, b) in enumerate(answer.trap.bounds())
              if ((run[:, n] < a - blur) | (run[:, n] > b + blur)).any()]
    kinetic = lambda w: float((D * np.square(w)).sum())
    if abs(kinetic(run[0])
           - kinetic(answer.state)) > 10 * blur * (1 + np.abs(D * np.array(answer.state)).sum()):
        wrong.append("energy where it is certified")
    if answer.axis and int(np.sign(direction[answer.axis - 1])) != answer.sense:
        wrong.append("sense")
    return wrong


def checked(seed, count, brute, fast):
    """(how many were decided and compared, [(number, what is wrong)]) of random scenes, until so many are
    compared; ways that are too long for the formula are left out."""
    rng, compared, wrong, number = random.Random(seed), 0, [], 0
    while compared < count:
        scene, state, _, _ = random_scene(rng)
        number += 1
        answer = spin_up(scene, state, 300, 3000, fast=fast)
        l, D = parts(scene)[1], parts(scene)[0]
        radians = (answer.t * (1 + 2 * max(np.abs(answer.state).max(), np.abs(state).max())
                               + 2 * np.abs(l / D).max()))
        if answer.level != "certified" or radians > LONGEST or answer.condition > 1e4:
            continue
        compared += 1
        if found := contradictions(scene, state, answer, brute):
            wrong.append((number, found))
    return compared, wrong


def test_euler_is_written_alike_twice():
    rng = np.random.default_rng(1)
    D, l, M, w = rng.uniform(0.5, 2, (4, 3))
    assert np.allclose(euler_rate(D, l, M, *w), euler(D, l, M, w), rtol=1e-14)


@numba
@pytest.mark.slow  # the formula is compiled for three seconds; by default runs of DOP853 judge random scenes
@pytest.mark.parametrize("count", [30, pytest.param(2000, marks=pytest.mark.long)])
def test_no_random_scene_that_is_decided_is_contradicted_by_brute_force(brute, count):
    assert checked(51, count, brute, True) == (count, [])


@numba
@pytest.mark.slow
def test_a_wrong_answer_is_contradicted(brute):
    """Another axis, a spin that grows too fast, and a trap that is too narrow."""
    state = (0.3, -0.2, 0.4)
    answer = spin_up(EXAMPLE, state, fast=True)
    assert not contradictions(EXAMPLE, state, answer, brute)
    for change in ({"eta": 1.2 * answer.trap.eta}, {"eta_up": 0.8 * answer.trap.eta_up},
                   {"A": 0.2 * answer.trap.A}):
        assert contradictions(EXAMPLE, state, replace(answer, trap=replace(answer.trap, **change)), brute)
    assert contradictions(EXAMPLE, state, replace(answer, sense=-answer.sense), brute)
    assert contradictions(EXAMPLE, state, replace(answer, state=tuple(1.01 * v for v in answer.state)), brute)


# scenes of the sample: their spin's last zero (heyoka, tolerance 1e-18)
LATE = {8080: 6709.69, 3639: 6647.67, 10808: 9225.56, 16266: 13529.61}


@pytest.mark.slow
@numba
@pytest.mark.parametrize("number",
                         [number if number == 8080 else pytest.param(number, marks=pytest.mark.long)
                          for number in LATE])
def test_the_latest_without_a_wheel_still_change_the_sign_of_their_spin_after_5000_natural_times(
    brute, number):
    """The inequality keeps the spin above z > 0 for ever (l = 0: X is the spin), so at no time before its
    last zero can it hold."""
    (_, scene, state, _, wheel), = scenes(number, 1)
    answer, last = spin_up(scene, state, fast=True), LATE[number]
    D, l, M = parts(scene)
    # 0.005 apart, then 0.012 at most
    times = np.append(last + np.linspace(-2, 2, 801), np.linspace(last + 2, answer.t, 20_001))
    spin = brute(D, l, M, np.array(state), np.append(0.0, times))[1:] @ np.array(answer.direction)
    zero = times[np.flatnonzero(spin < 0)[-1]]
    assert wheel == 0 and answer.level == "certified" and 5000 < last
    assert abs(zero - last) < 0.02 and zero < answer.t < zero + 240
