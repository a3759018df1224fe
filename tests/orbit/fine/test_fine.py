"""Rows whose orbit is far larger than their motion: answers from twofold numbers against ball arithmetic, which proves its digits."""
from __future__ import annotations

import numpy as np
import pytest

from stabilab import Body, ConstantTorque, Fate, Gyrostat, Scene, extremes, fate, period
from stabilab.orbit.ball_orbit import Orbit
from stabilab.orbit.extremes import arrays as extremes_arrays
from stabilab.orbit.extremes.balls import precise_extremes
from stabilab.orbit.fate import arrays as fate_arrays
from stabilab.orbit.fate.balls import decide
from stabilab.orbit.fine import margins
from stabilab.orbit.fine.anchored import Anchored
from stabilab.orbit.fine.margins import MARGIN_SHARE, valley_margins
from stabilab.orbit.fine.motion import fine_boxes, fine_interval, fine_periods
from stabilab.orbit.fine.spots import fine_spots
from stabilab.orbit.landscape import landscape
from stabilab.orbit.period.balls import precise_period


def scene(moments, wheel, axis, torque):
    return Scene(Body(moments), Gyrostat(wheel), ConstantTorque(tuple(torque if k == axis else 0 for k in range(3))))


# moments that differ by a few per cent or thousandths: the centre of the orbits stands ten to a thousand times as far off as the states
SCENES = {"hyperbolas, 7.121 and 7.104": scene((7.121, 7.104, 9.259), (0, -2.586, -0.953), 0, -0.6156),
          "hyperbolas, 0.938 and 0.942": scene((0.473, 0.938, 0.942), (0, 0, 4.556), 1, 0.6802),
          "hyperbolas, 8.045 and 7.854": scene((8.045, 7.854, 4.382), (-3.961, 0, -3.388), 1, -0.0789),
          "circles, 4.642 and 4.635": scene((3.315, 4.642, 4.635), (0, 0, -1.393), 1, -0.0106),
          "circles, a rod": scene((3.895, 3.766, 0.196), (0, -2.753, -0.167), 0, -0.3551)}
HYPERBOLAS = [name for name in SCENES if name.startswith("hyper")]


def states_of(name, count, seed=4, label=None):
    """States of a tenth to ten times the rates that the wheel brings about."""
    one, rng = SCENES[name], np.random.default_rng(seed)
    rate = float(np.linalg.norm([float(v) for v in one.vector("gyrostat")])) / float(min(one.body.exact))
    states = rng.normal(size=(count, 3)) * rate * 10 ** rng.uniform(-1.3, 0.7, (count, 1))
    return states if label is None else states[fate(one, states).labels == label]


@pytest.mark.one_in(2)
@pytest.mark.parametrize("name", SCENES)
def test_extremes_from_twofold_numbers_are_those_of_balls(name):
    land, states = landscape(SCENES[name]), states_of(name, 400, label=Fate.BOUNDED)
    boxes, found = fine_boxes(land, states)
    assert found.mean() > 0.9
    rows = np.nonzero(found)[0][:40]
    exact = np.array([precise_extremes(Orbit(land.reduction, states[n]), Fate.BOUNDED) for n in rows])
    assert (np.abs(boxes[rows] - exact).max(axis=2) <= 1e-12 * np.abs(exact).max(axis=2)).all()


@pytest.mark.one_in(2)
@pytest.mark.parametrize("name", SCENES)
def test_periods_from_twofold_numbers_are_those_of_balls(name):
    land, states = landscape(SCENES[name]), states_of(name, 400, label=Fate.BOUNDED)
    values, found = fine_periods(land, states)
    assert found.mean() > 0.9
    rows = np.nonzero(found)[0][:8]
    np.testing.assert_allclose(values[rows], [precise_period(Orbit(land.reduction, states[n]), Fate.BOUNDED) for n in rows], rtol=1e-11)


@pytest.mark.parametrize("name", ["hyperbolas, 0.938 and 0.942", "circles, a rod"])
def test_periods_of_motions_that_just_pass_a_barrier_are_those_of_balls(name):
    """The dip of H over the barrier is known from the energy there: sums of modes would lose half of its digits."""
    land, states = landscape(SCENES[name]), states_of(name, 4000, label=Fate.BOUNDED)
    span = fine_interval(land, states)
    spots = span.found.spots
    passed = spots.barrier & (spots.offset > span.left[:, None]) & (spots.offset < span.right[:, None])
    nearest = np.argsort(np.where(passed, spots.energy, np.inf).min(axis=1) / span.fastest)[:12]
    values, found = fine_periods(land, states[nearest])
    assert found.sum() > 8
    exact = [precise_period(Orbit(land.reduction, state), Fate.BOUNDED) for state in states[nearest[found]]]
    np.testing.assert_allclose(values[found], exact, rtol=1e-11)


@pytest.mark.parametrize("name", HYPERBOLAS)
def test_margins_from_twofold_numbers_are_those_of_balls(name):
    land, states = landscape(SCENES[name]), states_of(name, 60)
    found, sure = valley_margins(land, states)
    assert sure.mean() > 0.9
    for state, margin in zip(states[sure], found[sure]):
        tie, energy = decide(Orbit(land.reduction, state)), 0.5 * land.reduction.canonical(state)[2] ** 2
        if not np.isfinite(tie.margin):  # no barrier: balls say -inf on either geometry
            assert margin == np.inf
            continue
        assert tie.sign == np.sign(margin) and abs(margin - tie.margin) <= 2 * MARGIN_SHARE * (energy + abs(tie.margin + energy))


@pytest.mark.parametrize("name", HYPERBOLAS[:2])
def test_for_margins_barriers_alone_are_placed_in_twofold_numbers(name, monkeypatch):
    """Two wells stand beside each: they took two thirds of the time. So few states have no table."""
    placed, states = [], states_of(name, 4000)
    monkeypatch.setattr(margins, "fine_spots", lambda land, rows, rough: placed.append((int(rough.there.sum()), len(rows))) or fine_spots(land, rows, rough))
    fate(SCENES[name], states, fast=False)
    assert placed and all(0 < spots <= rows for spots, rows in placed)


@pytest.mark.parametrize("name", SCENES)
def test_heights_about_an_equilibrium_integrate_their_force_and_follow_their_series(name):
    """V' = -F by differences, and V by its Taylor series, at an anchor with any slope: the formulas are told in F alone."""
    pot, anchor = Anchored(landscape(SCENES[name]).reduction), (np.array([0.7]), np.array([-1.3]), np.array([0.01]), np.zeros(1), np.zeros(1))
    for y in (-1.2, -0.2, 0.05, 0.9):
        at, h = np.array([y]), 1e-4
        inner = [pot.rise(at + k * h, anchor)[0] for k in (-2, -1, 1, 2)]
        slope = (inner[0] - 8 * inner[1] + 8 * inner[2] - inner[3]) / (12 * h)
        size = sum(abs(t[0]) for t in pot._terms(at, anchor)) + abs(anchor[2][0])
        assert slope == pytest.approx(-pot.force(pot.move(anchor, at))[0], abs=1e-9 * (size + abs(slope)))
        series = sum(c[0] * y ** (n + 2) for n, c in enumerate(pot.taylor(anchor, 40)))
        assert series == pytest.approx(pot.rise(at, anchor)[0], abs=1e-13 * size)


@pytest.mark.parametrize("name", SCENES)
def test_hardly_a_row_of_nearly_equal_moments_goes_to_balls(name, monkeypatch):
    asked, one, states = [], SCENES[name], states_of(name, 1500, 5)
    monkeypatch.setattr(extremes_arrays, "precise_extremes", lambda orbit, label: asked.append(label) or precise_extremes(orbit, label))
    assert fate(one, states).precise <= 3
    if one.quadratic() and landscape(one).e > 0:
        extremes(one, states, fast=False)
        assert len(asked) <= 6


def test_rows_that_twofold_numbers_leave_open_go_to_balls_as_before(monkeypatch):
    name = HYPERBOLAS[0]
    one, states = SCENES[name], states_of(name, 60, label=Fate.BOUNDED)
    fine = extremes(one, states, fast=False), period(one, states, fast=False), fate(one, states).margins
    nothing = lambda land, rows: (np.full((len(rows), 3, 2), np.nan), np.zeros(len(rows), bool))
    monkeypatch.setattr(extremes_arrays, "fine_boxes", nothing)
    monkeypatch.setattr(fate_arrays, "valley_margins", lambda land, rows, known: (np.full(len(rows), np.nan), np.zeros(len(rows), bool)))
    np.testing.assert_allclose(extremes(one, states, fast=False), fine[0], rtol=0, atol=1e-12 * np.abs(fine[0]).max())
    np.testing.assert_allclose(fate(one, states).margins, fine[2], rtol=1e-11)


# moments that differ in the ninth digit or in the last: beside a plane the equilibrium of such an orbit is known to fewer digits than the sums of 32
BESIDE_PLANES = [((3.1876285123265875, 3.187628515759982, 1.824928201205744), (0.0, 0.05445062017840716, -0.09398239699358375), (-0.006183334127165318, 0, 0),
                  (0.0024122515732403014, -0.03254345636626074, 1052.018292334662)),
                 ((4.692222633355173, 4.692222633355175, 1.3368392299688445), (0.0, 2.742149968031607, -12.151034472655752), (-8.273460328896768, 0, 0),
                  (0.05123606193972703, -2.8557630770849878, 66543357.684882864))]


@pytest.mark.parametrize("moments, wheel, torque, state", BESIDE_PLANES)
def test_extremes_beside_a_plane_of_nearly_equal_moments_keep_their_digits(moments, wheel, torque, state):
    one = Scene(Body(moments), Gyrostat(wheel), ConstantTorque(torque))
    exact = np.array(precise_extremes(Orbit(landscape(one).reduction, state), Fate.BOUNDED))  # in balls
    assert (np.abs(extremes(one, [state], fast=False)[0] - exact).max(axis=1) <= 1e-12 * np.abs(exact).max(axis=1)).all()


def test_an_interval_hundreds_wide_has_no_period_in_doubles_and_says_nothing():
    """Where the way to a wall is lost beside a plane, sums of exponentials overflow: nothing vouches for the row, and balls answer it."""
    one = scene((4.112906792284341, 4.116438148785544, 6.651829713409366), (-1.0968587547960387, 0, -1.253790681840892), 1, 0.022295378844975795)
    state = (-310.60505266244706, 0.2419430815388782, 0.4944901326076557)
    exact = precise_period(Orbit(landscape(one).reduction, state), Fate.BOUNDED)
    assert period(one, [state], fast=False)[0] == pytest.approx(exact, rel=1e-11)


def test_a_margin_over_a_way_of_many_foldings_keeps_its_digits():
    """The way to the barrier is the logarithm of 6e-5: taken from the change, which is nearly -1, it would lose four digits."""
    one = scene((1.3047591344225173, 0.9790930727768938, 1.635402623597301), (0, 0.3187059744908893, 8.182100222806493), 0, -0.7205405624075971)
    land, state = landscape(one), (-218.13766952905002, 1430.8522001870313, 1073.2570610894782)
    assert valley_margins(land, np.array([state]))[0][0] == pytest.approx(decide(Orbit(land.reduction, state)).margin, rel=1e-13)


def test_a_row_whose_way_is_lost_is_answered_without_a_warning():
    one = scene((1.696601852841146, 1.6966018528540456, 1.6966018528531723), (-1.3494698280666895, 0.3393281923930477, 0), 2, 0.009203201574543322)
    state = (-112209146907.95891, -388557925455.79285, -0.3297841721936806)
    exact = np.array(precise_extremes(Orbit(landscape(one).reduction, state), Fate.BOUNDED))
    assert (np.abs(extremes(one, [state], fast=False)[0] - exact).max(axis=1) <= 1e-12 * np.abs(exact).max(axis=1)).all()


def test_an_extreme_next_to_the_state_keeps_its_digits():
    """On a circle of 2e14 the component is largest 1e-11 of a radian from the state: pi and back would lose half of the way."""
    one = scene((2.3655510073770074, 2.365549804636911, 2.365551007409251), (-5.159491704033158, 0, 0), 2, -0.325038361299964)
    state = (0.0, -0.009737502569610706, 0.05214105440254145)
    exact = np.array(precise_extremes(Orbit(landscape(one).reduction, state), Fate.BOUNDED))
    assert (np.abs(extremes(one, [state], fast=False)[0] - exact).max(axis=1) <= 1e-13 * np.abs(exact).max(axis=1)).all()


@pytest.mark.parametrize("one, state", [
    (scene((2.031718528933873, 4.10832328101258, 3.3109147205774123), (0, 1.917540936122219, 0), 2, 0.0023455994280943146),
     (114.31465919137567, -104.22387896633768, 121.00166087530833)),
    (scene((0.3741516734409537, 1.210595902320289, 1.2105959023202715), (-0.20062944808043162, 0, 0), 2, -4.158795551286843),
     (4.4020441308656935, 17819913.764604468, -22.438121828253696))])
def test_periods_of_long_intervals_beside_a_plane_keep_their_digits(one, state):
    """The modes stand about the middle, which is reached from the state's smaller asymptotic coordinate; a sum of doubles had lost seven digits of it."""
    land = landscape(one)
    values, found = fine_periods(land, np.array([state]))
    assert not found[0] or values[0] == pytest.approx(precise_period(Orbit(land.reduction, state), Fate.BOUNDED), rel=1e-11)
