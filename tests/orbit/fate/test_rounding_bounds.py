"""Bounds of rounding: a margin within them is decided in exact arithmetic, one outside by its doubles; both
to a factor of few."""
from __future__ import annotations

import importlib
from importlib.util import find_spec
from itertools import islice

import numpy as np
import pytest

import stabilab
from stabilab.numbers.constants import EPS
from stabilab.orbit.fate.one_state import decide
from stabilab.orbit.fine.margins import valley_margins
from stabilab.orbit.landscape import landscape
from stabilab.orbit.one_orbit import Orbit
from tests.oracles import energy
from tests.oracles.pairs import assert_margin, axis_of, brink, physical, scaled
from tests.orbit.fate.test_fate import ELLIPTIC, FAMILIES
from tests.shared import PARABOLIC

fate = importlib.import_module("stabilab.orbit.fate.arrays")
AWAY = 10.0 ** np.arange(-7, -17, -0.125)  # relative distances from the separatrix in the axis's rate


def brinks(name, problem, count=3):
    """States on the separatrix, on circles of a tenth to a thousand times the unit; on orbits known to have a
    barrier."""
    rng = np.random.default_rng(0)
    pairs = (PAIRS[name] if name in PAIRS
             else [rng.normal(size=2) * 10.0 ** rng.uniform(-1, 3) for _ in range(40)])
    return list(islice((state for pair in pairs if (state := brink(problem, pair, 0.0)) is not None), count))


PAIRS = {"middle scaled -, |c| above the cusp": [(-1.25, -1.25), (-0.75, -1.875)],
         "middle scaled, |c| far above": [(2.5, 1.5), (-3.25, 1.0)],
         "far centre": [(3 - 1e5, -2.0), (5 - 1e5, -3.0)],
         **{name: [(2.25, -11.25), (-21.25, -2.0), (8.5, -4.125), (-2.75, -2.125), (0.0625, -0.0625)]
            for name in PARABOLIC}}
BARRIERS = {"far centre": scaled(1e5, 1e5 + 0.25, (0, 0, 1)),
            **{name: (FAMILIES | PARABOLIC)[name] for name in (
                *ELLIPTIC, "middle scaled -, |c| above the cusp", "middle scaled, |c| far above",
                "first axis",
                "first axis, other sign", "second axis", "third axis", "oblate")}}


def test_twofold_numbers_decide_no_state_otherwise_than_balls_however_near_the_separatrix():
    scene, problem = BARRIERS["middle scaled, |c| far above"]
    land, nearest = landscape(scene), []
    for state in brinks("middle scaled, |c| far above", problem):
        states = np.array([state] * len(AWAY))
        states[:, axis_of(problem)] *= 1 + AWAY
        margins, sure = valley_margins(land, states)
        assert np.array_equal(np.sign(margins[sure]),
                              [decide(Orbit(land.reduction, one)).sign for one in states[sure]])
        nearest.append(AWAY[sure].min())
    assert max(nearest) < 1e-12  # the zone that is left to balls is no wider than that of doubles


# (moments, wheel, torque, state): places near the poles of circles whose G A^2 is 1e6 to 1e16 times the
# barrier's height
FAR_OUT = [
    ((576, 336, 240), (0, 0, 0), (-864, 0, 0), (-0.5693643838474999, 10782.986363786067, -7.468869861932772)),
    ((576, 336, 240), (0, 0, 0), (-864, 0, 0), (0, 786932.7492182573, -7.534465385839052)),
    ((576, 240, 336), (0, 0, 0), (0, -0.2661765439473299, 0), (0.0738245254673233, 0, 61121.23439463297)),
    ((1.7609145380865416, 1.5865762328564204, 1.1709032742739005), (0, 0, 0.017696549891233867),
     (0.40745335466701516, 0, 0),
     (-239.40168693445182, 61568996.298604585, 10.432313174243788)),
    ((1.3649594581805409, 1.6294562586289711, 1.9609530797171684),
     (0, -8.400630973150462e-06, -0.0004267201739766325),
     (0.008083379915661895, 0, 0), (119.20413016066038, -15584542.061516885, 0.5152704292854497)),
    ((336, 240, 576), (-7.899966026035833e-05, 0, 0), (0, 0, -6.501930082487902e-07),
     (269012.9069050331, 0.021142863970777276, 0.6095533845460953))]


@pytest.mark.parametrize("case", range(len(FAR_OUT)))
def test_margins_of_circles_far_larger_than_their_barriers_are_high_keep_twelve_digits(case):
    """Against the potential at 80 digits, by the general formula, by the table and by the table compiled."""
    D, momentum, torque, state = FAR_OUT[case]
    scene, problem = physical(D, momentum, torque)
    many = np.random.default_rng(1).normal(size=(6000, 3)) * np.abs(state).max()
    many[0] = state
    for states, fast in zip((many[:1], many, many),
                            (False, False, None if find_spec("numba") is None else True)):
        found = stabilab.fate(scene, states, fast=fast)
        assert_margin(problem, state, found.margins[0], digits=80)
        assert found.precise <= 10


def test_margins_near_the_poles_of_circles_of_any_size_keep_twelve_digits_and_seldom_need_many():
    rng, asked, count = np.random.default_rng(11), 0, 0
    for name in ELLIPTIC:
        scene, problem = FAMILIES[name]
        i = axis_of(problem)
        angle = rng.integers(0, 4, 6) * np.pi / 2 + rng.choice([-1, 1], 6) * 10.0 ** rng.uniform(-8, -0.5, 6)
        states = np.zeros((6, 3))
        states[:, [i - 2, i - 1]] = 10.0 ** rng.uniform(0, 8,
                                                        (6, 1)) * np.stack([np.sin(angle), np.cos(angle)],
                                                                           axis=1)
        states[::2, i] = rng.normal(size=3) * 10.0 ** rng.uniform(-2, 2, 3)
        found = stabilab.fate(scene, states)
        asked, count = asked + found.precise, count + len(states)
        for state, margin in zip(states.tolist(), found.margins):
            assert_margin(problem, state, margin, digits=100)
    assert asked <= 0.1 * count


@pytest.mark.one_in(2)
@pytest.mark.parametrize("name",
                         ["middle scaled -, |c| above the cusp", "middle scaled, |c| far above", *PARABOLIC])
def test_margins_of_slow_motions_nearly_as_high_as_a_barrier_keep_twelve_digits_of_their_terms(name):
    """At rest in the torque's coordinate the terms of a margin are the height itself, however large those it
    is made of."""
    scene, problem = BARRIERS[name] if name in BARRIERS else (FAMILIES | PARABOLIC)[name]
    i = axis_of(problem)
    for state in brinks(name, problem):
        slow = np.array(state)
        slow[i] = 0.0
        for low, high in zip(*_ray(scene, slow, i)):
            for share in 10.0 ** -np.arange(2, 12, 2.0):
                here = low + (high - low) * share
                exact, margin = energy.margin(problem, here.tolist(),
                                              digits=80), stabilab.fate(scene, here).margins
                if exact is not None and np.isfinite(margin):
                    assert abs(margin
                               - float(exact)) <= 1e-12 * abs(float(exact)), [v.hex() for v in here.tolist()]


def _ray(scene, state, i):
    """States at rest on either side of the barrier's level, along a line through `state`: (level, away),
    lists."""
    ends = [state * (1 + np.eye(3)[(i + k) % 3] * s) for k in (1, 2) for s in (0.5, -0.5, 3.0)]
    found = [], []
    for end in ends:
        margins = stabilab.fate(scene, np.stack([state, end])).margins
        if np.isfinite(margins).all() and margins[0] * margins[1] < 0:
            low, high = state, end
            for _ in range(60):
                middle = 0.5 * (low + high)
                low, high = (middle,
                             high) if stabilab.fate(scene, middle).margins * margins[0] > 0 else (low, middle)
            found[0].append(low)
            found[1].append(end)
    return found


def on_circles(radius, count):
    """(landscape, potential, places of `count` states on a circle, its barriers' places) of a scene on
    circles."""
    land = landscape(FAMILIES["minor scaled +"][0])
    place = np.array([radius]), np.array([0.0])
    offsets, spots, barrier = land.critical(place, barriers_only=True)
    return land, [tuple(np.full(count, v) for v in spots[:, 0, column])
                  for column in np.nonzero(barrier[0])[0]]


@pytest.mark.parametrize("radius", [2.5, 30.0])
@pytest.mark.parametrize("sizes", [(0.0, 0.0), (5.0, 50.0), (1e6, 0.0)])
@pytest.mark.parametrize("side", [-1, 1])
def test_a_state_so_near_a_barrier_that_rounding_decides_which_side_it_is_on_is_decided_exactly(side, sizes,
                                                                                                radius):
    """A place known to EPS times the sizes has an angle known to that over the radius; the angle's own
    rounding is added."""
    off = 10.0 ** np.arange(-2, -17, -0.1)
    land, spots = on_circles(radius, len(off))
    assert spots
    for spot in spots:
        place = land.potential.move(spot, side * off)
        unsure = fate.circle_margins(land, place, np.full(len(off), radius),
                                     tuple(np.full(len(off), s) for s in sizes))[1]
        assert unsure[-1] and (np.diff(unsure.astype(int)) >= 0).all()
        assert 16 < off[np.argmax(unsure)] / (EPS * (1 + sum(sizes) / radius)) < 64
