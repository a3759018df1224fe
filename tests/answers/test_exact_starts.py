"""A start is exact as it was written, whatever asks: Python's questions next to a separatrix, where the double
nearest to the start moves otherwise, beside the reduced potential in mpmath (`tests.oracles.energy`)."""
import re
from fractions import Fraction

import mpmath as mp
import numpy as np
import pytest

import stabilab
from stabilab import Body, ConstantTorque, Fate, Gyrostat, ScaledGyrostat, Scene
from tests.oracles import energy
from tests.oracles.pairs import WORDS, assert_extremes, barrier_ahead, model_of
from tests.shared import later

# 2e-18 rad/s inside a separatrix, below the spacing of doubles there
BESIDE = {"body": {"inertia": ["73669999999999992633/10000000000000000000", "1261/500", "7367/1000"]},
          "effects": {"gyrostat": {"momentum": ["221/125", 0, "118/125"]}, "constant_torque": {"torque": [0, -1, 0]}},
          "motion": {"angular_velocity": [
              "1599/1000", "13450925980258422954373342505714013640169/5000000000000000000000000000000000000000",
              "37/40"], "span": [0, 1]}}


def agrees(scene, state, digits=90):
    """The answers of Python to an exact start are those of the potential; the word."""
    problem = model_of(scene)
    word = energy.label(problem, state, digits=digits)
    case = stabilab.load(scene, state)
    for found in (stabilab.fate(scene, state), stabilab.fate(scene, state=[str(v) for v in state]), case.fate()):
        assert found.labels == WORDS[word] and found.fate.word == word
    if word in ("bounded", "spin-up"):
        exact = energy.extremes(problem, state, digits=digits)
        for found in (stabilab.extremes(scene, state), case.extremes(), np.array(case.motion().extremes)):
            assert_extremes(np.asarray(found), exact, 1e-10)
    if word == "bounded":
        exact = float(energy.period(problem, state, digits=digits))
        for found in (stabilab.period(scene, state), case.period(), case.motion().period):
            assert float(found) == pytest.approx(exact, rel=1e-10)
    return word


def beside_a_separatrix(rng):
    """(scene, exact start) at 1e-13 to 1e-30 of its rate from the barrier; None where no barrier is ahead."""
    D, axis = rng.uniform(1, 2, 3).round(3), int(rng.integers(3))
    momentum, torque = rng.uniform(-1, 1, 3).round(3), np.zeros(3)
    momentum[axis], torque[axis] = 0, rng.choice([-1, 1])
    scene = Scene(Body([str(v) for v in D]), Gyrostat([str(v) for v in momentum]), ConstantTorque(torque.tolist()))
    problem, state = model_of(scene), [Fraction(0)] * 3
    for n in (1, 2):
        state[(axis + n) % 3] = Fraction(str(round(rng.uniform(-2, 2), 3)))
    with mp.workdps(90):
        height = barrier_ahead(problem, tuple(state), 90)
        if height is None or height <= 0:
            return None
        speed = mp.sqrt(2 * height) * (1 + rng.choice([-1, 1]) * mp.mpf(10) ** -rng.uniform(13, 30))
        state[axis] = int(rng.choice([-1, 1])) * Fraction(int(speed * mp.mpf(10) ** 45), 10**45)
    return scene, tuple(state)


def some(count, seed):
    rng, found = np.random.default_rng(seed), []
    while len(found) < count:
        if (made := beside_a_separatrix(rng)) is not None:
            found.append(made)
    return found


def test_a_start_in_a_file_beside_a_separatrix_is_answered_as_it_was_written():
    case = stabilab.load(BESIDE)
    assert agrees(case.scene, case.exact_state) == "bounded"
    assert case.fate().fate == Fate.BOUNDED and case.motion().fate == Fate.BOUNDED
    # of its rounding the other: so the test can fail
    assert energy.label(model_of(case.scene), case.state) == "spin-up"
    assert stabilab.fate(case, states=[case.state]).labels == Fate.SPIN_UP


def test_a_spin_up_that_no_inequality_shows_is_judged_by_the_start_as_written():
    """Bounded by the potential, whose word of the nearest doubles is spin-up (the test above)."""
    case = stabilab.load(BESIDE)
    assert stabilab.spin_up(case, budget=200).fate == Fate.BOUNDED
    assert stabilab.spin_up(case.scene, case.state, budget=200).fate == Fate.UNDECIDED


def test_what_extremes_prove_is_never_reached():
    """By the potential |omega| stays below the root of the sum of the squares of its extremes."""
    case = stabilab.load(BESIDE)
    exact = energy.extremes(model_of(case.scene), case.exact_state, digits=90)
    most = float(mp.sqrt(sum(max(abs(v) for v in pair) ** 2 for pair in exact)))
    for rate in (1.001 * most, 0.96 * most):  # by the extremes; by one whole period
        found = case.when(rate=rate)
        assert found.low == np.inf and found.level in ("exact", "proved")


def test_rationals_in_a_scene_are_not_rounded():
    """1.3 is no double: fate, extremes and period are those of the rationals, by the potential."""
    scene = ScaledGyrostat("0.6", "1.2", (0, 1, 0))
    state = (Fraction(13, 10), Fraction(13, 10), Fraction(5, 2))
    found = stabilab.motion(scene, state)
    assert found.fate.word == energy.label(model_of(scene), state)
    assert stabilab.fate(scene, state).case.exact_state == state
    assert agrees(scene, state) == found.fate.word


@pytest.mark.parametrize("count, seed, place", [*((4, 13, n) for n in range(4)),
                                                *later((122, 31, n) for n in range(122))])
def test_random_starts_beside_separatrices_are_answered_as_written(count, seed, place):
    agrees(*some(count, seed)[place])


def test_all_digits_of_a_period_are_there():
    """mpmath's period of the exact start, to 28 digits."""
    case = stabilab.load(BESIDE)
    with mp.workdps(60):
        exact = energy.period(model_of(case.scene), case.exact_state, digits=60, nodes=200)
        found = case.period(digits=30)
        assert len(re.sub(r"\D", "", str(found))) >= 30 and str(found) in repr(found)
        assert abs(mp.mpf(str(found)) - exact) < exact * mp.mpf(10) ** -28
        pairs = case.extremes(digits=30).decimals
        for row, pair in zip(pairs, energy.extremes(model_of(case.scene), case.exact_state, digits=60)):
            for text, value in zip(row, pair):
                assert abs(mp.mpf(text) - value) < abs(value) * mp.mpf(10) ** -28
