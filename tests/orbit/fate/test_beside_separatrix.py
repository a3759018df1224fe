"""States at relative distances 1e-3 to 1e-15 from separatrices, each on a side that is known by construction:
no wrong label.

The barrier's height over a place is a number of 50 digits (`oracles.energy`); the speed that just reaches it
is its root, and a double lies above or below it for certain.
"""
from __future__ import annotations

import random
from fractions import Fraction

import mpmath as mp
import numpy as np
import pytest

import stabilab
from stabilab import Body, ConstantTorque, Fate, Gyrostat, ScaledGyrostat, Scene
from tests.oracles.pairs import PAPER_BODY, axis_of, barrier_ahead, physical, scaled

DIGITS = 50
SPEEDS = 104  # a place: 13 decades, two sides, both senses, twice
# of each scene: a million states in all, 20,000, or 1,200 (one state in six takes many digits)
MANY_PLACES, SOME_PLACES, FEW_PLACES = 802, 17, 1

# name -> ((scene, problem), typical size of a place, whether its far side spins up)
SCENES = {f"minor axis, a = {a}, b = {b}": (scaled(a, b, (0, 0, 1)), 3.0, True)
          for a, b in ((0.2, 0.4), (0.0, 0.0), (1.5, 0.25), (-2.0, 3.0))}
SCENES |= {f"middle axis, a = {a}, b = {b}": (scaled(a, b, (0, 1, 0)), 4.0, False)
           for a, b in ((0.25, 3.0), (0.0, -4.0), (1.0, 3.125), (-2.0, 6.0))}
SCENES |= {f"major axis, moment {m}, torque {t}": (physical(PAPER_BODY, m, (t, 0, 0)), 1.0, True)
           for m, t in (((0, 0, 0), 100.0), ((0, 70, 0), 100.0), ((0, 50, -90), 20.0),
                          ((0, -300, 200), 150.0))}


def states_and_sides(name, places, seed):
    """(states (n, 3), +1 where the speed is beyond the separatrix's and -1 below it), of so many random
    places."""
    (_, problem), size, _ = SCENES[name]
    rng, states, sides, axis = np.random.default_rng(seed), [], [], axis_of(problem)
    decades = np.repeat(np.arange(3, 16), 8)
    while len(states) < places:
        place = np.roll([0.0, *rng.normal(size=2) * size * 2 ** rng.uniform(-1, 2)], axis).tolist()
        with mp.workdps(DIGITS):
            top = barrier_ahead(problem, tuple(place), DIGITS)
            if top is None or not top > 1e-6:  # no barrier, or the place is beyond it
                continue
            speed = mp.sqrt(2 * top)
            high = float(speed)
            low = float(speed - high)
        off = 10.0 ** -(decades + rng.uniform(-0.5, 0.5, len(decades))) * np.tile([1, -1], len(decades) // 2)
        v = high * (1 + off)
        block = np.tile(place, (len(v), 1))
        block[:, axis] = v * rng.choice([-1, 1], len(v))
        states.append(block)
        # exact: nearby doubles subtract without rounding, and low is half a unit at most
        sides.append(np.sign((v - high) - low))
    return np.concatenate(states), np.concatenate(sides)


def judged(name, places, seed):
    """How many states of a scene there were; asserts every label, and the margins' sides."""
    (scene, _), _, escapes = SCENES[name]
    states, sides = states_and_sides(name, places, seed)
    result = stabilab.fate(scene, states)
    # on the middle axis both sides of the double well are bounded
    beyond = Fate.SPIN_UP if escapes else Fate.BOUNDED
    np.testing.assert_array_equal(result.labels, np.where(sides > 0, beyond, Fate.BOUNDED))
    np.testing.assert_array_equal(np.sign(result.margins), -sides)
    return len(states)


@pytest.mark.one_in(3)
@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("places", [FEW_PLACES, pytest.param(SOME_PLACES, marks=pytest.mark.slow)])
def test_no_label_next_to_a_separatrix_is_wrong(name, places):
    assert judged(name, places, seed=1) == places * SPEEDS


@pytest.mark.slow
@pytest.mark.long  # one state in five needs many digits: five minutes alone on a processor
def test_no_label_of_a_million_states_is_wrong():
    assert sum(judged(name, MANY_PLACES, seed) for seed, name in enumerate(SCENES, 2)) > 1_000_000


@pytest.mark.slow
def test_a_state_at_rest_on_its_circle_next_to_a_saddle_next_to_a_fold_falls_to_the_side_that_its_torque_points_to():
    """A body of revolution with a wheel across its axis and a torque along it, released without spin: by
    hand, D2 w2' = M2 - lambda1 w3 turns the transverse rates about a fixed centre, and of the two places of
    equal height w3 = M2 / lambda1 the one beyond the centre is the saddle. Next to it the motion is held
    exactly where |w3| > |M2 / lambda1| (rational numbers decide)."""
    rng, seen = random.Random(1), []
    for n in range(100):
        across, wheel, size = rng.uniform(0.5, 3), 10 ** rng.uniform(-4, -1), 10 ** rng.uniform(1, 4)
        along = across * rng.choice([rng.uniform(1.05, 1.9), rng.uniform(0.6, 0.95)])
        torque, centre = -wheel * size, wheel / (along - across)
        scene = Scene(Body((across, along, across)), Gyrostat((wheel, 0, 0)), ConstantTorque((0, torque, 0)))
        states = np.array([(times * centre, 0.0, torque / wheel * (1 + ulps * 2.0**-52))
                           for times in (1.5, 2, 3) for ulps in (-40, -3, -1, 1, 3, 40)])
        held = [abs(Fraction(w3) * Fraction(wheel)) > abs(Fraction(torque)) for w3 in states[:, 2].tolist()]
        expected = [Fate.BOUNDED if one else Fate.SPIN_UP for one in held]
        assert stabilab.fate(scene, states).labels.tolist() == expected
        assert n > 2 or [stabilab.motion(scene, state).fate
                         for state in states[8:10].tolist()] == expected[8:10]
        seen += held
    assert 0.3 < np.mean(seen) < 0.7


def test_a_margin_of_1e_minus_35_keeps_twelve_digits():
    """Of a state next to a hyperbola's saddle: 128 bits tell its sign and eleven digits. The value: the same
    margin at thirty digits."""
    scene = ScaledGyrostat(0.06030145867915992, 32.78977103673764, (0, 17.486932694954078, 0))
    state = [float.fromhex(number) for number in ("-0x1.b2d5bbaffb9e1p+3", "0x0p0", "-0x1.4ae91facab29fp+0")]
    wanted = pytest.approx(7.474296579821735879e-35, rel=1e-12, abs=0)
    assert stabilab.motion(scene, state).margin_energy == wanted
    assert stabilab.fate(scene, np.array([state])).margins == [wanted]


@pytest.mark.parametrize("a", ["1e-15", "1e-17", "1e-30", "1e-46"])
def test_equilibria_on_an_orbit_that_nearly_meet_have_their_order(a):
    """x1' = x2 x3, x2' = -x3 (x1 + a), x3' = x2 x1 + 1 from (1, 1, -3): two equilibria are some a apart on
    the motion's circle, one and the same double. For a = 0, by hand, x1 x2 = cos 2s with s' = x3, so x3' = 1
    + cos 2s is never negative, and x3 grows for ever; so small an a cannot change that."""
    found = stabilab.motion(ScaledGyrostat(a, 0, (0, 0, 1)), (1, 1, -3))
    assert (found.fate, found.axis) == (Fate.SPIN_UP, 3)
    assert stabilab.fate(ScaledGyrostat(a, 0, (0, 0, 1)), np.array([[1.0, 1, -3]])).labels == Fate.SPIN_UP
