"""Facts about ball arithmetic on one state that small faults break: every geometry asked for directly, to the
last digit."""
from __future__ import annotations

import math
from fractions import Fraction as F

import numpy as np
import pytest

import stabilab
from stabilab import Body, Fate, Gyrostat, Scene
from stabilab.answers.motion import motion
from stabilab.numbers.balls import DOUBLE_BITS, START_BITS
from stabilab.orbit.extremes import precise_extremes
from stabilab.orbit.fate import decide
from stabilab.orbit.landscape import landscape
from stabilab.orbit.one_orbit import Orbit
from stabilab.orbit.period import precise_period
from stabilab.orbit.reduction import reduce
from tests.oracles import energy
from tests.oracles.pairs import PAPER_BODY, WORDS, assert_extremes, physical
from tests.shared import FAMILIES, PARABOLIC

# M_i = -lambda_j lambda_k/(D_j - D_k): the conic of equilibria is two lines
LINES = {f"two lines, axis {axis + 1}": physical(PAPER_BODY, momentum, torque) for axis, momentum, torque in (
    (2, (100.0, 50.0, 0.0), (0, 0, -10.0)), (1, (100.0, 0.0, 50.0), (0, 5.0, 0)),
    (0, (0.0, 100.0, 50.0), (-10.0, 0, 0)))}
ALL = FAMILIES | PARABOLIC | LINES
SOME = ["minor scaled -", "minor physical", "minor on axis 1", "middle scaled -, |c| above the cusp",
        "middle physical, other sign", "major physical, other sign", "first axis, other sign", "second axis",
        "third axis", *LINES]


def states_of(name, count):
    return (np.random.default_rng(21).normal(size=(count, 3)) * (0.7 if name in LINES else 2.0)).tolist()


@pytest.mark.one_in(4)
@pytest.mark.parametrize("bits", [DOUBLE_BITS, START_BITS])
@pytest.mark.parametrize("name", ALL)
def test_the_margin_of_balls_is_that_of_the_potential(name, bits):
    scene, problem = ALL[name]
    r = reduce(scene)
    for state in states_of(name, 5):
        tie, exact = decide(Orbit(r, state), bits), energy.margin(problem, state, digits=40)
        if exact is None:
            assert (tie.sign, tie.margin) == (-1, -math.inf)
        else:
            assert tie.sign == (1 if exact > 0 else -1)
            assert tie.margin * r.energy_unit == pytest.approx(float(exact),
                                                               rel=2e-15 if bits == START_BITS else 1e-12)


@pytest.mark.parametrize("name", SOME)
def test_the_extremes_and_period_of_balls_are_those_of_the_potential_to_the_last_digit(name):
    scene, problem = ALL[name]
    r = reduce(scene)
    for n, state in enumerate(states_of(name, 3)):
        label = WORDS[energy.label(problem, state, digits=40)]
        assert_extremes(precise_extremes(Orbit(r, state), label), energy.extremes(problem, state, digits=40),
                        1e-15)
        if n == 0:
            assert precise_period(Orbit(r, state),
                                  label) == pytest.approx(float(energy.period(problem, state, digits=40)),
                                                          rel=1e-14)


@pytest.mark.parametrize("name", ["minor scaled -", "major physical", "middle scaled +",
                                  "middle physical, other sign"])
def test_energy_and_invariant_of_a_state_are_those_of_every_other_on_its_orbit(name):
    """The state moved along its circle or hyperbola, its rate by the potential's fall on the way."""
    scene = FAMILIES[name][0]
    land = landscape(scene)
    for state in states_of(name, 4):
        place, w, _ = land.start(np.array([state]))
        for y in (-0.2, 0.3):
            fall = land.potential.rise(np.array([y]), place, land.potential.force(place))
            if w[0] ** 2 - 2 * fall[0] <= 0:
                continue
            other = land.components(land.potential.move(place, y), np.sqrt(w * w - 2 * fall))[0]
            one, two = Orbit(land.reduction,
                             state).invariants(), Orbit(land.reduction, other.tolist()).invariants()
            assert set(one) == {"Q", "energy"}
            # the turn angle of a circle is known up to turns, each 2 pi mu of the energy
            turn = 2 * math.pi * land.potential.mu * land.reduction.energy_unit * (land.e < 0)
            apart = abs(two["energy"] - one["energy"])
            assert min(apart, abs(apart - turn)) <= 1e-12 * (abs(one["energy"]) + abs(two["energy"]) + turn)
            q = float(land.invariant(place)[0])
            assert one["Q"] == pytest.approx(q, rel=1e-12) and two["Q"] == pytest.approx(q, rel=1e-12)
    assert Orbit(reduce(PARABOLIC["first axis"][0]), [1.0, 2.0, 3.0]).invariants() == {}


@pytest.mark.parametrize("torque", [0.75, -0.75])
@pytest.mark.parametrize("plane", [-1, 1])
def test_on_planes_with_irrational_axes_one_state_and_arrays_know_the_fate_and_extremes(plane, torque):
    """D = (6, 5, 3), lambda = (1/2, 0, 1): planes w3 - 1/2 = +-(w1 + 1/2) and canonical units of sqrt(1/3).
    """
    scene, problem = physical((6, 5, 3), (0.5, 0, 1), (0, torque, 0))
    states = [(y - 0.5, w, 0.5 + plane * y) for y in (-2.0, 0.5, 3.0) for w in (-1.0, 0.25)]
    found, boxes = stabilab.fate(scene, np.array(states)), stabilab.extremes(scene, np.array(states))
    for n, state in enumerate(states):
        one, word = motion(scene, state), energy.label(problem, state, digits=40)
        assert found.labels[n] == one.fate == WORDS[word]
        assert (found.axis[n], found.sense[n]) == (one.axis, one.sense)
        assert one.because.startswith(found.because[n])
        exact = energy.extremes(problem, state, digits=40)
        for box in (boxes[n], np.array(one.extremes),
                    precise_extremes(Orbit(reduce(scene), state), WORDS[word])):
            assert_extremes(box, exact, 1e-11)
    assert {WORDS["spin-up"]} <= set(found.labels.tolist()) or set(found.labels.tolist()) == {Fate.BOUNDED}


@pytest.mark.parametrize("l2, l3", [(1, 1), (2, -1), (3, 2), (-1, F(1, 2))])
def test_rational_states_on_the_separatrix_of_a_free_gyrostat_are_ties_and_their_neighbours_none(l2, l3):
    """D = (6, 5, 3), D w + lambda = 4 w at p = (0, -l2, l3). Through it, w = p + t v has the energy and |H|
    of p where sum D (D - 4) v^2 = 12 v1^2 + 5 v2^2 - 3 v3^2 = 0 and t = -2 sum D p v/sum D v^2: rational, as
    v is."""
    scene = Scene(Body((6, 5, 3)), Gyrostat((0, str(l2), str(l3))))
    r, D, p = reduce(scene), (6, 5, 3), (0, -F(l2), F(l3))
    # chords of the cone from its point (1, 0, 2)
    for a, b, c in ((0, 1, 0), (1, 1, 0), (2, -1, 1), (1, 3, -2)):
        s = F(-2 * (12 * a - 6 * c)) / (12 * a * a + 5 * b * b - 3 * c * c)
        v = (1 + s * a, s * b, 2 + s * c)
        assert 12 * v[0] ** 2 + 5 * v[1] ** 2 == 3 * v[2] ** 2
        t = -2 * sum(d * x * y for d, x, y in zip(D, p, v)) / sum(d * y * y for d, y in zip(D, v))
        state = [x + t * y for x, y in zip(p, v)]
        assert sum(d * x * x for d, x in zip(D, state)) == sum(d * x * x for d, x in zip(D, p))
        if state != list(p):
            assert decide(Orbit(r, state)).sign == 0
            beside = [state[0] + F(1, 10**60), *state[1:]]
            assert decide(Orbit(r, beside)).sign != 0
