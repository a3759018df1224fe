"""Laws of rows, one libration at a time, as plain Python: against ball arithmetic and a potential in many
digits, on every geometry.

Nothing looks at the clock.
"""
from __future__ import annotations

import math
import subprocess
import sys

import numpy as np
import pytest

import stabilab
from stabilab import Fate, fate
from stabilab.answers.motion import Needs
from stabilab.answers.motion import motion as motion_of
from stabilab.numbers import numba_door
from stabilab.orbit.extremes import precise_extremes
from stabilab.orbit.extremes_arrays import settle_rows, trapped_rows
from stabilab.orbit.fate_arrays import fate_on_orbit
from stabilab.orbit.landscape import landscape
from stabilab.orbit.one_orbit import Orbit
from stabilab.orbit.period import precise_period
from tests.oracles import energy
from tests.oracles.pairs import assert_extremes, physical
from tests.shared import FAMILIES, sample

BODY = (2000, 1500, 1000)
PAIRS = {
    "circles, minor axis": physical(BODY, (60, 90, 0), (0, 0, 2)),
    "circles, major axis": physical(BODY, (0, 50, -90), (-2, 0, 0)),
    "circles, one wheel": physical(BODY, (0, 70, 0), (0.5, 0, 0)),
    "circles, a rod": physical((3.895, 3.766, 0.196), (0, -2.753, -0.167), (-0.3551, 0, 0)),
    "circles, 4.642 and 4.635": physical((3.315, 4.642, 4.635), (0, 0, -1.393), (0, -0.0106, 0)),
    "circles, moments equal to 1e-8": physical((1.0, 1.0 + 1e-8, 0.9), (0.5, 0.3, 0), (0, 0, 0.2)),
    "circles, equal moments across": physical((1.3, 1.3, 0.9), (0.7, -0.4, 0), (0, 0, 0.3)),
    "circles, no wheel": physical((1.2, 0.7, 0.9), (0, 0, 0), (0, 0.05, 0)),
    "circles, a pair of lines": physical((1.0, 2.0, 2.5), (0, 0.5, 0.25), (0.25, 0, 0)),
    "circles, no torque": physical((3, 2, 1), (0.5, 0, 0)),
    "circles, neither wheel nor torque": physical((3, 2, 1)),
    "hyperbolas": physical(BODY, (60, 0, 90), (0, 200, 0)),
    "hyperbolas, one wheel": physical(BODY, (100, 0, 0), (0, -200, 0)),
    "hyperbolas, no wheel": physical((1.168, 0.527, 0.895), (0, 0, 0), (0, 0, 0.357)),
    "hyperbolas, 7.121 and 7.104": physical((7.121, 7.104, 9.259), (0, -2.586, -0.953), (-0.6156, 0, 0)),
    "hyperbolas, 0.938 and 0.942": physical((0.473, 0.938, 0.942), (0, 0, 4.556), (0, 0.6802, 0)),
    "hyperbolas, a pair of lines": physical((1.0, 2.0, 2.5), (0.75, 0, 1.5), (0, -0.75, 0)),
    "parabolas, a disc": physical((6.098, 6.098, 11.2), (0, 1.104, -8.298), (-0.01, 0, 0)),
    "parabolas, a needle": physical((6.098, 6.098, 0.972), (0, 1.104, -8.298), (-0.01, 0, 0)),
    "parabolas, a wheel across": physical((4.8, 9.8, 9.8), (1.2, 0, 0.66), (0, 0.295, 0)),
    "parabolas, a strong torque": physical((0.77, 1.22, 0.77), (0.3, 0.1, 0), (0, 0, 2.5)),
    "parabolas, a sphere": physical((1, 1, 1), (0.5, 0.3, 0), (0, 0, 0.2)),
}
SCENES = {name: pair[0] for name, pair in PAIRS.items()}
PARABOLAS = [name for name in SCENES if name.startswith("parabolas") and "sphere" not in name]
each = pytest.mark.parametrize("name", SCENES)


def librations(one, states):
    """Those between two turning points."""
    land = landscape(one)
    return states[trapped_rows(land, fate_on_orbit(one, land, states))]


def states_of(name, count):
    """Librations of a tenth to ten times the rates that wheel and torque bring about."""
    one, rng = SCENES[name], np.random.default_rng(len(name))
    least = min(map(float, one.body.exact))
    wheel, torque = (float(np.linalg.norm([float(v) for v in one.vector(which)]))
                     for which in ("gyrostat", "torque"))
    way = rng.normal(size=(8 * count, 3))
    rate = (wheel / least + math.sqrt(torque / least) or 1.0) * 10 ** rng.uniform(-1, 1, (8 * count, 1))
    return librations(one, way / np.linalg.norm(way, axis=1)[:, None] * rate)[:count]


def settled(one, states, by_numba=False, asked=3):
    """(boxes, periods, bits left open); NaN where nothing was written."""
    boxes, periods = np.full((len(states), 3, 2), np.nan), np.full(len(states), np.nan)
    left = np.full(len(states), asked, np.uint8)
    settle_rows(landscape(one), states, boxes, periods, left, by_numba)
    return boxes, periods, left


def assert_exact(one, states, boxes, periods, left):
    """Of what is settled, the promise: extremes to 1e-12, periods to 1e-11, against balls."""
    for state, box, time, bits in zip(states, boxes, periods, left):
        orbit = Orbit(landscape(one).reduction, state)
        if not bits & 1:
            exact = np.array(precise_extremes(orbit, Fate.BOUNDED), float)
            assert (np.abs(box - exact).max(axis=1) <= 1e-12
                    * np.abs(exact).max(axis=1)).all(), state.tolist()
        if not bits & 2:
            assert time == pytest.approx(precise_period(orbit, Fate.BOUNDED), rel=1e-11), state.tolist()


@pytest.mark.one_in(2)
@each
@pytest.mark.parametrize("by_numba", [False, pytest.param(True, marks=pytest.mark.slow)])
def test_all_rows_are_settled_with_the_digits_of_balls_and_of_a_potential_in_many_digits(name, by_numba):
    if by_numba:
        pytest.importorskip("numba")
    one, problem = PAIRS[name]
    states = states_of(name, 2000 if by_numba else 60)
    boxes, periods, left = settled(one, states, by_numba)
    assert len(states) >= 20 and np.count_nonzero(left) <= len(states) / 1000
    assert_exact(one, states[:6], boxes, periods, left)
    for state, box, time in zip(states[:2].tolist(), boxes, periods):
        assert_extremes(box, energy.extremes(problem, state), 1e-11)
        assert time == pytest.approx(float(energy.period(problem, state)), rel=1e-11)
    assert ((boxes[..., 0] <= states) & (states <= boxes[..., 1])).all()


@pytest.mark.parametrize("name", PARABOLAS)
def test_next_to_a_separatrix_of_parabolas_rows_have_their_digits_or_stay_open(name):
    """From a tenth of the rate at the barrier to a trillionth, and on to rounding, where all are left."""
    one, land = SCENES[name], landscape(SCENES[name])
    states, axis = states_of(name, 400), land.reduction.axis
    found = fate(one, states)
    height = found.margins / land.reduction.energy_unit + 0.5 * land.start(states)[1] ** 2
    high = np.nonzero(np.isfinite(height) & (height > 0))[0][:4]
    assert len(high)
    for distance in 10.0 ** -np.arange(1, 17, 2):
        near = states[high]
        near[:, axis] = np.sqrt(2 * height[high]) * (1 + distance) - float(land.reduction.s)
        boxes, periods, left = settled(one, near)
        assert_exact(one, near, boxes, periods, left)
        assert distance < 1e-9 or not (left & 1).any()


@pytest.mark.parametrize("name", ["hyperbolas", "circles, minor axis", "parabolas, a disc"])
def test_any_split_of_the_rows_gives_the_same_bytes_and_either_question_those_of_both(name):
    one, states = SCENES[name], states_of(name, 40)
    whole = settled(one, states)
    parts = [settled(one, part) for part in np.split(states, (1, 13))]
    for column, pieces in zip(whole, zip(*parts)):
        np.testing.assert_array_equal(np.concatenate(pieces), column)
    np.testing.assert_array_equal(settled(one, states, asked=1)[0], whole[0])
    np.testing.assert_array_equal(settled(one, states, asked=2)[1], whole[1])


@pytest.mark.skipif(not numba_door.installed(), reason="nothing is compiled without numba")
@each
def test_compiled_rows_and_rows_in_plain_python_have_the_same_bytes(name):
    """The library's sines and exponentials for both, and IEEE arithmetic in the order that the source has."""
    states = states_of(name, 60)
    for plain, fast in zip(*(settled(SCENES[name], states, by_numba) for by_numba in (False, True))):
        assert plain.tobytes() == fast.tobytes()


def test_a_process_imports_numba_once_its_rows_cost_as_much():
    """Counted in a process of its own: librations of 0.52 ms each with their periods, and 0.15 s."""
    program = """
import sys
import numpy as np
from stabilab import Body, ConstantTorque, Gyrostat, Scene
from stabilab.orbit.extremes_arrays import KERNELS, extremes_and_periods
scene = Scene(Body((12, 9, 5)), Gyrostat((0.8, 0, 0)), ConstantTorque((0, 0.02, 0)))
states = np.random.default_rng(6).normal(size=(100, 3)) / 1000  # all of them librate
loaded = []
for _ in range(20):
    extremes_and_periods(scene, states)
    loaded.append("numba" in sys.modules)
print(loaded.index(True), round(KERNELS["rows"].spent, 3))
"""
    got = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout
    assert got.split()[0] == "2"  # so many calls cost 0.1 s, the next would pass 0.15


def test_fates_load_what_fates_need_when_calls_of_arrays_cost_as_much():
    """Counted in a process of its own: calls of 0.47 ms beyond compiled code each, and 0.15 s, by hand."""
    program = """
import sys
import numpy as np
from stabilab import Body, ConstantTorque, Gyrostat, Scene, fate
from stabilab.orbit.barriers_arrays import BARRIERS
from stabilab.orbit.extremes_arrays import KERNELS
from stabilab.orbit.fate_arrays import MARGINS
from stabilab.unreduced.spin_up.certificate import ADVANCE, DECIDE
scene = Scene(Body((12, 9, 5)), Gyrostat((0.8, 0, 0)), ConstantTorque((0, 0.02, 0)))
states = np.random.default_rng(6).normal(size=(12, 3)) / 1000
calls = 0
while "numba" not in sys.modules:
    fate(scene, states)
    calls += 1
print(calls, MARGINS.spent, *(bool(kernel._functions)
                              for kernel in (BARRIERS, MARGINS, *KERNELS.values(), ADVANCE, DECIDE)))
"""
    got = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout
    assert got.split() == ["320", "0.0", "True", *["False"] * 5]


def test_without_numba_plain_python_serves(monkeypatch):
    monkeypatch.setattr(numba_door, "find_spec", lambda name: None)
    numba_door.installed.cache_clear()
    monkeypatch.setattr(numba_door, "IMPORT", 0.0)
    monkeypatch.setattr(numba_door, "compiled", lambda *module, **names: pytest.fail("compiled without numba"))
    one, states = FAMILIES["minor scaled +"][0], sample("minor scaled +", 5)
    try:
        assert np.isfinite(stabilab.extremes(one, states, fast=True)).any()
    finally:
        numba_door.installed.cache_clear()


def test_periods_of_nearly_equal_moments_have_eleven_digits():
    """The torque's two other moments differ by 2e-8, and the centre of the orbits stands 1e4 times as far as a
    motion goes: E - V summed from the ends alone was 1e-10 off. Oracle: each period by itself, in balls."""
    scene = physical((1.4929634095287285, 1.6765531192322118, 1.492963376448026),
                     (0, 0.14798266990757872, -1.3040810429872085), (0.01015683660431478, 0, 0))[0]
    rng = np.random.default_rng(0)
    states = rng.normal(size=(40, 3)) * rng.uniform(0.01, 1, (40, 1))
    for state, period in zip(states.tolist(), stabilab.period(scene, states)):
        assert period == pytest.approx(motion_of(scene, state, needs=Needs.QUICK).period, rel=1e-11)


def test_a_motion_that_hardly_passes_a_barrier_has_its_time_there():
    """Two wells, and rates over the barrier from 1e-16 to 1e2, beside balls of one state: what the nodes leave out
    of the arc next to the barrier is much of a period where the motion creeps."""
    scene = stabilab.Scene(stabilab.Body((1.0, 0.07533266861279389, 1.0)),
                           stabilab.Gyrostat((0.2591282813657506, 0.027846392183237333, 0.0)),
                           stabilab.ConstantTorque((0.0, 0.0, -186.3663263554538)))
    states = np.array([(-7369.855148325185, 0.002767306901105778, 10.0**p) for p in range(-16, 3)])
    expected = [float(stabilab.period(scene, tuple(state))) for state in states]
    np.testing.assert_allclose(np.asarray(stabilab.period(scene, states), float), expected, rtol=1e-11)
