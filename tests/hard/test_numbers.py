"""The hard cases 2 to 4 and 6 to 9: each named, with what goes wrong in straightforward code; answers in 60
to 200 digits.

That the straightforward code does go wrong is shown line by line in `hard_table`.
"""
from __future__ import annotations

import math

import mpmath as mp
import numpy as np
import pytest

import stabilab
from stabilab import Fate
from tests.oracles import energy
from tests.oracles.pairs import PAPER_BODY, agrees, brink, physical, scaled

BOUNDED, SEPARATRIX, EQUILIBRIUM = int(Fate.BOUNDED), int(Fate.SEPARATRIX), int(Fate.EQUILIBRIUM)


# 2. Large circles: A = 1e3 ... 1e8

@pytest.mark.one_in(3)
@pytest.mark.parametrize("decade", range(3, 9))
@pytest.mark.parametrize("sign", [1, -1])
def test_case_2_a_tilt_of_order_one_decides_on_a_circle_of_any_radius(decade, sign):
    """U is of order A^2 and the tilt of order 1: energies subtracted in double precision lose the tilt at A =
    1e8. The barrier over the start is of order A^2; speeds a tilt's worth away from it lie 1/A^2 apart, on
    either side."""
    radius = 10.0 ** decade
    pair = scaled(0.25, 0.75, (0, 0, sign))
    states = []
    for angle in (0.3, 1.9, 3.6, 5.1):
        start = (radius * math.sin(angle) - 0.25, radius * math.cos(angle))
        for off in (-1, 1):
            state = brink(pair[1], start, off * 0.1 * max(radius ** -2, 1e-14))
            states += [state] if state else []
    assert len(states) == 8
    words = agrees(pair, states, extremes=False)
    assert words.count("bounded") >= 3 and words.count("spin-up") >= 3


@pytest.mark.parametrize("decade", [3, 8, *(pytest.param(d, marks=pytest.mark.slow) for d in (4, 5, 6, 7))])
def test_case_2_extremes_on_large_circles_keep_their_digits(decade):
    radius = 10.0 ** decade
    pair = scaled(0.25, 0.75, (0, 0, 1))
    states = [(radius * math.sin(t), radius * math.cos(t), s * radius) for t in (0.3, 1.9, 3.6, 5.1)
              for s in (-0.3, 0.1)]
    agrees(pair, states)


# 3. Folds: saddle and centre merging

@pytest.mark.one_in(3)
@pytest.mark.parametrize("decade", [1, 3, 5, *(pytest.param(n, marks=pytest.mark.slow) for n in (2, 4))])
@pytest.mark.parametrize("a, b", [(0.0, 0.0), (0.25, 1.0), (1.5, 0.25)])
def test_case_3_the_well_that_is_about_to_vanish_still_holds_its_states(decade, a, b):
    """Just outside the fold's circle the well is as deep as distance^3: a quartic solved for well separated
    roots misses the pair or makes it complex."""
    c, sign = b - a, 1
    fold = max(float(mp.re(r)) for r in mp.polyroots([1, 0, 0, -c, -1]) if abs(mp.im(r)) < 1e-12)
    h = fold * (1 - 10.0 ** -decade)  # a centre just before the fold
    centre = (-b - 1 / h, h)
    pair = scaled(a, b, (0, 0, sign))
    inside = (*centre, 0.0)
    speed = brink(pair[1], centre, 0.0)[2]
    states = [(*centre, f * speed) for f in (-0.9, -0.3, 0.5, 0.99, 1.01, 1.5)]
    assert agrees(pair, states) == ["bounded"] * 4 + ["spin-up"] * 2
    assert stabilab.fate(pair[0], np.array(inside)).labels in (BOUNDED, EQUILIBRIUM)


def test_case_3_the_exact_fold_is_an_equilibrium_and_holds_nothing():
    """a = b = 0: fold h = 1, X = -1, A^2 = 2, where F has a double root; a state at rest elsewhere on that
    circle is uphill or downhill of an inflection, never in a well."""
    pair = scaled(0, 0, (0, 0, 1))
    assert stabilab.fate(pair[0], np.array([-1.0, 1.0, 0.0])).labels == EQUILIBRIUM
    states = [(1.0, 1.0, 0.0), (-1.0, -1.0, 0.3), (1.0, -1.0, -0.2), (-1.0, 1.0, 0.125)]
    at_rest = [pair[1].rate(s) == [0, 0, 0] for s in states]
    assert agrees(pair, states, extremes=False) == ["equilibrium" if rest else "spin-up" for rest in at_rest]


# 4. Limits of the parameters

@pytest.mark.parametrize("a, b", [(1.0, 1.0 + 2.0 ** -52), (1.0, 1.0 + 1e-9), (0.0, 1e-300), (-1e6, -2e6),
                                  (3e4, -1e4),
                                  (-0.2, -0.4)])
@pytest.mark.parametrize("mu, count",
                         [((0, 0, 1), 2), ((0, -1, 0), 2), *(pytest.param(mu, 4, marks=pytest.mark.slow)
                                                                         for mu in ((0, 0, 1), (0, 0, -1),
                                                                                    (0, 1, 0), (0, -1, 0)))])
def test_case_4_a_near_b_and_gyrostats_of_any_size_and_sign(a, b, mu, count):
    """Formulas that divide by c = b - a, or whose c comes from a difference of rounded numbers, break here.
    """
    rng = np.random.default_rng(8)
    centre = (-a, 0, 0) if mu[2] else (-b, 0, 0)
    agrees(scaled(a, b, mu), (rng.normal(size=(4, 3)) * 2 + centre)[:count])


@pytest.mark.one_in(4)
@pytest.mark.parametrize("decade",
                         [-12, -6, 6, 12, *(pytest.param(d, marks=pytest.mark.slow) for d in (-9, -3, 3, 9))])
@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize("sign", [1, -1])
def test_case_4_torques_tiny_and_huge_against_the_gyrostat(decade, axis, sign):
    """A fixed tolerance takes a tiny torque for none (and calls spin-up bounded), a huge one for no gyrostat.
    """
    momentum, torque = np.array([0.4, -0.7, 0.9]), np.zeros(3)
    momentum[axis], torque[axis] = 0, sign * 10.0 ** decade
    agrees(physical((3.0, 2.0, 1.5), momentum, torque), np.random.default_rng(axis).normal(size=(4, 3)),
           period=False)


# 6. Nearly and exactly symmetric bodies

BODIES = {
    "D1 = (1 + 1e-12) D2": (1000.0 * (1 + 1e-12), 1000.0, 700.0),
    "D1 = D2 up to one ulp, oblate": (1000.0, 1000.0 * (1 + 2.0 ** -52), 1900.0),
    "D1 = D2": (1000.0, 1000.0, 700.0),
    "sphere": (3.0, 3.0, 3.0),
    "nearly a sphere": (3.0, 3.0 * (1 + 1e-12), 3.0 * (1 - 1e-12)),
    "rod": (1.0, 1.0, 1e-9),
    "uneven rod": (1.0, 1.0 - 5e-10, 1e-9),
    "flat plate, D1 = D2 + D3": (3.0, 2.0, 1.0),
}


@pytest.mark.one_in(4)
@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("axis, count",
                         [(0, 2), (1, 2), (2, 2),
                          *(pytest.param(axis, 4, marks=pytest.mark.slow) for axis in (0, 1, 2))])
def test_case_6_symmetric_rod_like_and_flat_bodies(body, axis, count):
    """Divisions by D_j - D_k: circles of radius 1e12, elliptic and hyperbolic formulas that should meet in a
    parabola."""
    inertia = BODIES[body]
    scale = np.max(inertia)
    for moment in ((0.4, -0.7, 0.9), (0.0, 0.0, 0.0)):
        momentum, torque = np.array(moment) * scale, np.zeros(3)
        momentum[axis], torque[axis] = 0, 0.3 * scale
        agrees(physical(inertia, momentum, torque), np.random.default_rng(axis).normal(size=(4, 3))[:count],
               period=False)


# D = (4, 4, 2), lambda = (0, l2, 0), torque (M1, 0, 0): with angle a from the saddle (0, u, v), w3 = v - l2
# a/2 and
# w2 = u - v a/2 + l2 a^2/8, so w1' = (2 w2 w3 + l2 w3 + M1)/4 is a cubic in a and w1^2 = 2 integral a
# rational quartic.
TIES = [(1.0, -50.0, (-10.5, -2.5), (1.0, -7.5, -3.5)), (2.0, -70.0, (-11.0, -3.5), (1.0, -9.0, -4.5)),
        (4.0, -110.0, (-12.0, -5.5), (0.5, -10.5, -6.5)), (8.0, -64.0, (-12.0, -4.0), (8.0, -12.0, 4.0))]


@pytest.mark.parametrize("l2, torque, saddle, state", TIES)
def test_case_6_parabolic_states_exactly_on_a_separatrix_are_recognised(l2, torque, saddle, state):
    """The only case with torque where doubles can tie: all numbers are rational. Any rounding in U(saddle) -
    E tips it."""
    scene, problem = physical((4.0, 4.0, 2.0), (0.0, l2, 0.0), (torque, 0.0, 0.0))
    assert problem.rate((0, *saddle)) == [0, 0, 0]
    word = energy.label(problem, state)
    assert word == "separatrix"
    assert stabilab.fate(scene, np.array(state)).labels == SEPARATRIX
    for speed in (np.nextafter(state[0], 10), np.nextafter(state[0], 0)):
        near = (float(speed), *state[1:])
        assert energy.label(problem, near) == "bounded"  # a double well: bounded on either side of the tie
        assert stabilab.fate(scene, np.array(near)).labels == BOUNDED


# 7. The ends of the equilibrium hyperbola, and its degeneration to lines

@pytest.mark.parametrize("h", [2.0 ** -20, 2.0 ** -40, 2.0 ** 20, 2.0 ** 40, -(2.0 ** -30)])
def test_case_7_equilibria_far_out_on_the_hyperbola_are_found_and_judged(h):
    """X = -1/h, x2 = h with a = b = 0: exact doubles at distances up to 1e12, where X x2 + 1 must not be
    lost."""
    pair = scaled(0, 0, (0, 0, 1))
    assert stabilab.fate(pair[0], np.array([-1 / h, h, 0.0])).labels == EQUILIBRIUM
    nudge = 2.0 ** -10 * min(1.0, abs(h), 1 / abs(h))
    agrees(pair, [(-1 / h, h, nudge), (-1 / h, h, -nudge)])


@pytest.mark.parametrize("axis, momentum, torque",
                         [(2, (100.0, 50.0, 0.0), -10.0), (1, (100.0, 0.0, 50.0), 5.0),
                                                    (0, (0.0, 100.0, 50.0), -10.0)])
def test_case_7_fates_where_the_equilibrium_conic_is_two_lines(axis, momentum, torque):
    """M_i = -lambda_j lambda_k/(D_j - D_k): the centre of the hyperbola lies on it; closed forms divide by
    zero there."""
    moment = [0.0] * 3
    moment[axis] = torque
    pair = physical(PAPER_BODY, momentum, moment)
    j, k = (axis + 1) % 3, (axis + 2) % 3
    gap = PAPER_BODY[j] - PAPER_BODY[k]
    assert momentum[j] * momentum[k] / gap + torque == 0  # exactly degenerate
    agrees(pair, np.random.default_rng(6).normal(size=(6, 3)) * 0.5)


# 8. Exact equilibria and invariant planes as initial states

@pytest.mark.parametrize("a, b, mu, state", [
    (0.0, 0.0, (0, 0, 1), (-2.0, 0.5, 0.0)), (0.0, 0.0, (0, 0, 1), (-0.5, 2.0, 0.0)),
    (0.25, 0.5, (0, 0, 1), (-2.5, 0.5, 0.0)),
    (0.25, 0.5, (0, 0, -1), (1.5, 0.5, 0.0)), (0.25, 0.5, (0, 1, 0), (1.75, 0.0, 0.5)),
    (0.5, 0.5, (1, 0, 0), (-0.5, 2.0, -0.5))])
def test_case_8_an_exact_equilibrium_is_neither_bounded_nor_spinning_up(a, b, mu, state):
    """Saddle or centre: margin, period and turning points are 0/0 in naive code."""
    scene, problem = scaled(a, b, mu)
    assert problem.rate([energy.Fraction(v) for v in state]) == [0, 0, 0]
    assert stabilab.fate(scene, np.array(state)).labels == EQUILIBRIUM
    np.testing.assert_array_equal(stabilab.extremes(scene, np.array(state)), np.array([state, state]).T)
    assert stabilab.period(scene, np.array(state)) == 0


# 9. Long motions

@pytest.mark.parametrize("speed", [-1e3, -1e6])
def test_case_9_a_spin_that_must_first_be_braked_through_many_turns_has_exact_extremes(speed):
    """Speed -1e6 is undone only after 8e10 turns: nobody can integrate that, the reduced potential needs two
    turns."""
    pair = scaled(0.2, 0.4, (0, 0, 1))
    assert set(agrees(pair, [(1.0, 2.0, speed), (-3.0, 0.5, speed)],
                      tolerance=1e-13)) <= {"spin-up", "bounded"}


def test_a_body_at_the_crossing_of_two_lines_of_equilibria_is_answered():
    """D = (3, 2, 1), wheel (1/2, 0, 0): rotations about axis 1 and those with w1 = -1/2, where (D1 - D2) w1 +
    1/2 = 0, cross there; a push along axis 3 leaves the energy constant, so the motion bounded."""
    scene = stabilab.Scene(stabilab.Body((3, 2, 1)), stabilab.Gyrostat(("0.5", 0, 0)))
    found = stabilab.fate(scene, np.array([(-0.5, 0, 0), (-0.5, 0, 1e-9)]))
    assert found.labels.tolist() == [EQUILIBRIUM, BOUNDED] and found.margins[0] == 0
