"""One state without arrays: its answers are those of the arrays."""
import math

import numpy as np
import pytest

import stabilab
from stabilab import Body, ConstantTorque, Gyrostat, ScaledGyrostat, Scene
from stabilab.answers.motion import motion
from stabilab.numbers.balls import FIRST_BITS
from stabilab.orbit.fate.one_state import decide
from stabilab.orbit.one_orbit import Orbit
from stabilab.orbit.reduction import reduce
from stabilab.orbit.result import Fate
from stabilab.orbit.separatrix.distance.ask import distance_of

SCENES = {
    "circle": ScaledGyrostat("0.2", "0.4", (0, 0, 1)),
    "circle, major axis": Scene(Body((3, 2, 1)), Gyrostat(("0", "0.3", "0.1")), ConstantTorque((1, 0, 0))),
    "circle, no torque": Scene(Body((3, 2, 1)), Gyrostat(("0.5", 0, 0))),
    "hyperbola": ScaledGyrostat("0.2", "0.4", (0, 1, 0)),
    "hyperbola with saddles": ScaledGyrostat(0, 3, (0, 1, 0)),
    "parabola": Scene(Body((2, 2, 1)), Gyrostat((0, "0.25", "0.5")), ConstantTorque(("0.5", 0, 0))),
}


@pytest.mark.one_in(3)
@pytest.mark.parametrize("name", SCENES)
def test_one_state_has_the_fate_extremes_and_period_of_the_arrays(name):
    scene, rng = SCENES[name], np.random.default_rng(7)
    states = rng.uniform(-3, 3, (12, 3))
    decided, ranges, times = stabilab.fate(scene,
                                           states), stabilab.extremes(scene,
                                                                      states), stabilab.period(scene, states)
    for state, label, because, margin, axis, sense, pairs, time in zip(
            states, decided.labels, decided.because, decided.margins, decided.axis, decided.sense, ranges,
            times):
        one = motion(scene, state)
        assert (one.fate, one.axis, one.sense) == (label, axis, sense) and one.because.startswith(because)
        assert (one.margin_energy is None) == (not math.isfinite(margin))
        # both bound their own error by about 1e-12 of the terms; the arrays' formulas share no arithmetic
        # with the balls
        assert one.margin_energy is None or abs(one.margin_energy - margin) < 1e-10 * (1 + abs(margin))
        assert np.allclose(np.array(one.extremes), pairs, rtol=2e-12, atol=2e-12 * np.abs(state).max())
        assert (one.period or math.inf) == pytest.approx(time if time > 0 else math.inf, rel=3e-11)


def test_next_to_the_separatrix_doubles_hand_over_and_the_label_is_right():
    scene = SCENES["circle"]
    reduction, state = reduce(scene), [2.0, 1.0, 0.0]
    margin = motion(scene, state).margin_energy
    # the scaled energy is x3^2/2 + U: from here the motion just reaches the barrier
    edge = math.sqrt(2 * margin)
    for side, label in ((-1, Fate.BOUNDED), (1, Fate.SPIN_UP)):
        near = [2.0, 1.0, edge * (1 + side * 1e-13)]
        assert decide(Orbit(reduction, near), FIRST_BITS).bits > FIRST_BITS
        assert motion(scene, near).fate == label


def test_a_state_at_an_equilibrium_stays():
    found = motion(ScaledGyrostat(0, 0, (0, 0, 1)), (-1.0, 1.0, 0.0))  # x2 x1 = -1, x3 = 0
    assert found.fate == Fate.EQUILIBRIUM and found.extremes == ((-1.0, -1.0), (1.0, 1.0), (0.0, 0.0))
    assert found.period is None


@pytest.mark.parametrize("state", [(-15.1, 13.8, 7.3), (1.0, -8.0, -2.0), (-5.0, 3.0, -7.0)])
def test_no_vertex_of_a_fine_mesh_is_nearer_than_the_distance_from_the_separatrix(state):
    scene = SCENES["hyperbola with saddles"]
    distance = distance_of(reduce(scene), state).upper
    vertices = np.concatenate([s.points.reshape(-1, 3)
                               for s in stabilab.separatrix(scene, reach=12, shape=(160, 201)).branches])
    nearest = np.linalg.norm(vertices[np.isfinite(vertices).all(axis=1)] - np.array(state), axis=1).min()
    assert distance <= nearest * (1 + 1e-9)
