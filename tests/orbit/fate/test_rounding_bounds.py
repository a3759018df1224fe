"""Bounds of rounding: a margin within them is decided in exact arithmetic, one outside by its doubles; both
to a factor of few.

The size of a margin's terms comes from the potential at 60 digits, which shares no code with the bounds.
"""
from __future__ import annotations

import importlib
from importlib.util import find_spec
from itertools import islice

import mpmath as mp
import numpy as np
import pytest

import stabilab
from stabilab.numbers.constants import EPS
from stabilab.orbit import landscape as landscape_base
from stabilab.orbit.fate.one_state import decide
from stabilab.orbit.fine.margins import valley_margins
from stabilab.orbit.landscape import landscape
from stabilab.orbit.one_orbit import Orbit
from stabilab.orbit.reduction import Reduction, reduce
from tests.oracles import energy
from tests.oracles.energy import Reduced
from tests.oracles.pairs import assert_margin, axis_of, brink, physical, scaled
from tests.orbit.fate.test_fate import ELLIPTIC, FAMILIES
from tests.shared import PARABOLIC

fate = importlib.import_module("stabilab.orbit.fate.arrays")
LOST = 1e-3  # of the shifted rates: a place that small has lost three digits
AWAY = 10.0 ** np.arange(-7, -17, -0.125)  # relative distances from the separatrix in the axis's rate


def terms(problem, state):
    """Sum of the sizes that rounding acts on: the energy's and the height's terms, and the force at the state
    times the size of the shifted rates (on a parabola: its terms times the way to the barrier)."""
    with mp.workdps(60):
        motion = Reduced(problem, state, 60)
        spots = (motion._ahead(1 if motion.tilt > 0 else -1)[0] if motion.kind == "elliptic"
                 else motion.stationary())
        far = max((a for a, kind in spots if kind == "saddle"), key=lambda a: -motion.W(a))
        u, v, whole = abs(motion.u0), abs(motion.v0), motion.terms(far)
        if motion.kind == "parabolic":
            ka, ro, si, m = (abs(float(getattr(problem, name)[motion.i]))
                             for name in ("kappa", "rho", "sigma", "m"))
            return float(whole + abs(far) * (ka * u * v + ro * v + si * u + m)), float(motion.w0 ** 2)
        pull = ((abs(motion.ka * motion.V0) + abs(motion.cu)) * (u + abs(motion.uc))
                + (abs(motion.ka * motion.U0) + abs(motion.cv)) * (v + abs(motion.vc)))
        return float(whole + pull), float(motion.w0 ** 2)


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


@pytest.mark.parametrize("name",
                         ["minor scaled +", "minor physical, other sign", "major physical", "middle scaled +",
                                  "middle physical, other sign"])
def test_next_to_the_centre_or_a_plane_places_come_from_longer_arithmetic_and_keep_their_digits(name,
                                                                                                monkeypatch):
    r, land, asked = reduce(FAMILIES[name][0]), landscape(FAMILIES[name][0]), []
    exact, g, rng = Reduction.canonical_exact, r.exact_constants, np.random.default_rng(2)
    states = np.zeros((160, 3))
    for n, state in enumerate(states):
        x, z = rng.normal(size=2)
        if r.e > 0 and n % 2:  # near a plane rather than the centre
            z = x * rng.choice([-1, 1]) * (1 + 10.0 ** rng.uniform(-12, 0))
        else:
            x, z = x * 10.0 ** (-n / 20), z * 10.0 ** (-n / 20)
        state[[r.j, r.k]] = float(g["flip"]
                                  * g["rx"]) * x - float(g["sj"]), float(g["rz"]) * z - float(g["sk"])
    twofold = landscape_base.twofold_places
    monkeypatch.setattr(landscape_base, "twofold_places", lambda c, j, k,
                        some: asked.extend(map(tuple, some)) or twofold(c, j, k, some))
    place, _, size = land.start(states)
    for n, state in enumerate(states):
        x, z, _ = exact(r, state)
        true = (x, z) if r.e < 0 else (x + z, x - z)
        small = float(max(map(abs, true))) if r.e < 0 else float(min(map(abs, true)))
        error = max(abs(float(t) - p[n]) for t, p in zip(true, place)) if r.e < 0 else max(
            abs(float(t) - p[n]) / max(1e-300, abs(float(t))) * small for t, p in zip(true, place))
        assert error <= 2 * EPS / LOST * small
        share = small / (size[0][n] + size[1][n])
        assert (tuple(state) in asked) if share < LOST / 2 else (share < 2 * LOST
                                                                 or tuple(state) not in asked)
    sj, sk = abs(float(g["sj"] / g["rx"])), abs(float(g["sk"] / g["rz"]))
    near = [abs(float(v)) for v in exact(r, states[0])]
    assert [s[0] for s in size] == pytest.approx([near[0] + sj, near[1] + sk], rel=1e-12)


@pytest.mark.one_in(4)
@pytest.mark.parametrize("name", [*FAMILIES, *PARABOLIC])
def test_the_equilibria_of_an_orbit_are_those_of_the_potential_at_sixty_digits(name):
    """Places and offsets to rounding, with which of them are barriers."""
    scene, problem = (FAMILIES | PARABOLIC)[name]
    r, land = reduce(scene), landscape(scene)
    states = np.random.default_rng(6).normal(size=(8, 3)) * 10.0 ** np.linspace(-1, 2, 8)[:, None]
    place, _, size = land.start(states)
    offsets, spots, barrier = land.critical(place)
    pot = land.potential
    for n, state in enumerate(states.tolist()):
        with mp.workdps(60):
            motion = Reduced(problem, state, 60)
            unit = r.exact_constants["flip"] * motion.k0 if r.e else 1
            expected = sorted((float((a * unit) % (2 * mp.pi) if r.e < 0 else a * unit), kind == "saddle")
                              for a, kind in motion.stationary())
        there = np.nonzero(~np.isnan(offsets[n]))[0]
        found = sorted((offsets[n, m], bool(barrier[n, m]), m) for m in there)
        assert [kind for _, kind, _ in found] == [kind for _, kind in expected]
        for (offset, _, m), (true, _) in zip(found, expected):
            spot = tuple(spots[:, n, m])
            whole, bend, speed = pot.terms(spot), abs(pot.slope(spot)), np.hypot(*spot)
            if r.e == 0:  # a place on a parabola is a polynomial of the offset
                here = tuple(v[n] for v in place)
                whole += (pot.terms(here) + sum(abs(f * true ** k) for k,
                                                f in enumerate(pot.derivatives(here), 1)))
            assert abs(pot.force(spot)) <= 8 * EPS * whole
            assert abs(offset - true) <= 64 * EPS * (1 + abs(true) + (size[0][n] + size[1][n]) / speed
                                                     + whole / bend)


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
