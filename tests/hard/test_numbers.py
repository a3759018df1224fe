"""Hard cases, each with what goes wrong in straightforward code: labels, margins, extremes and periods
against the potential in 60 to 300 digits (`agrees`). That the straightforward code does go wrong is shown
line by line in `hard_table`; invariant planes and conics of two lines stand in tests/orbit."""
from __future__ import annotations

import math

import mpmath as mp
import numpy as np
import pytest

import stabilab
from stabilab import Fate
from tests.oracles import energy
from tests.oracles.pairs import agrees, brink, physical, scaled

BOUNDED, EQUILIBRIUM = int(Fate.BOUNDED), int(Fate.EQUILIBRIUM)


@pytest.mark.one_in(6)
@pytest.mark.parametrize("decade", range(3, 9))
@pytest.mark.parametrize("sign", [1, -1])
def test_a_tilt_of_order_one_decides_on_a_circle_of_any_radius(decade, sign):
    """U is of order A^2: energies subtracted in doubles lose the tilt at A = 1e8. Speeds a tilt's worth away
    from the barrier lie 1/A^2 apart, on either side of it."""
    radius, pair = 10.0 ** decade, scaled(0.25, 0.75, (0, 0, sign))
    places = [(radius * math.sin(t) - 0.25, radius * math.cos(t)) for t in (0.3, 1.9, 3.6, 5.1)]
    near = [brink(pair[1], place, off * 0.1 * max(radius ** -2, 1e-14)) for place in places
            for off in (-1, 1)]
    words = agrees(pair, near, extremes=False)
    assert words.count("bounded") >= 3 and words.count("spin-up") >= 3
    agrees(pair, [(x + 0.25, z, s * radius) for x, z in places for s in (-0.3, 0.1)])


@pytest.mark.one_in(6)
@pytest.mark.parametrize("decade", range(1, 6))
@pytest.mark.parametrize("a, b", [(0.0, 0.0), (0.25, 1.0), (1.5, 0.25)])
def test_the_well_that_is_about_to_vanish_still_holds_its_states(decade, a, b):
    """Just outside the fold's circle the well is as deep as distance^3: a quartic solved for well separated
    roots misses the pair or makes it complex."""
    fold = max(float(mp.re(r)) for r in mp.polyroots([1, 0, 0, a - b, -1]) if abs(mp.im(r)) < 1e-12)
    h = fold * (1 - 10.0 ** -decade)  # a centre just before the fold
    centre, pair = (-b - 1 / h, h), scaled(a, b, (0, 0, 1))
    speed = brink(pair[1], centre, 0.0)[2]
    states = [(*centre, f * speed) for f in (-0.9, -0.3, 0.5, 0.99, 1.01, 1.5)]
    assert agrees(pair, states) == ["bounded"] * 4 + ["spin-up"] * 2
    assert stabilab.fate(pair[0], np.array((*centre, 0.0))).labels in (BOUNDED, EQUILIBRIUM)


def test_the_exact_fold_is_an_equilibrium_and_holds_nothing():
    """a = b = 0: fold h = 1, X = -1, A^2 = 2, where F has a double root; a state at rest elsewhere on that
    circle is uphill or downhill of an inflection, never in a well."""
    states = [(-1.0, 1.0, 0.0), (1.0, 1.0, 0.0), (-1.0, -1.0, 0.3), (1.0, -1.0, -0.2), (-1.0, 1.0, 0.125)]
    words = agrees(scaled(0, 0, (0, 0, 1)), states, extremes=False)
    assert words == ["equilibrium"] + ["spin-up"] * 4


# a near b, where formulas divide by c = b - a or take it from rounded numbers; gyrostats of any size and sign
@pytest.mark.one_in(4)
@pytest.mark.parametrize("a, b", [(1.0, 1.0 + 2.0 ** -52), (1.0, 1.0 + 1e-9), (0.0, 1e-300), (-1e6, -2e6),
                                  (3e4, -1e4), (-0.2, -0.4), (1e8, 1e8 + 0.75), (-1e8, 0.75 - 1e8),
                                  (2.0 ** 40, 2.0 ** 40 + 0.75)])
@pytest.mark.parametrize("mu", [(0, 0, 1), (0, 0, -1), (0, 1, 0), (0, -1, 0)])
def test_a_near_b_and_gyrostats_of_any_size_and_sign(a, b, mu):
    centre = (-a, 0, 0) if mu[2] else (-b, 0, 0)
    agrees(scaled(a, b, mu), np.random.default_rng(8).normal(size=(3, 3)) * 2 + centre)


@pytest.mark.one_in(5)
@pytest.mark.parametrize("decade", [-12, -9, -6, -3, 3, 6, 9, 12])
@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize("sign", [1, -1])
def test_torques_tiny_and_huge_against_the_gyrostat(decade, axis, sign):
    """A fixed tolerance takes a tiny torque for none (and calls spin-up bounded), a huge one for no gyrostat.
    """
    momentum, torque = np.array([0.4, -0.7, 0.9]), np.zeros(3)
    momentum[axis], torque[axis] = 0, sign * 10.0 ** decade
    agrees(physical((3.0, 2.0, 1.5), momentum, torque), np.random.default_rng(axis).normal(size=(4, 3)),
           period=False)


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
@pytest.mark.parametrize("axis", [0, 1, 2])
def test_symmetric_rod_like_and_flat_bodies(body, axis):
    """Divisions by D_j - D_k: circles of radius 1e12, elliptic and hyperbolic formulas that should meet in a
    parabola."""
    scale = np.max(BODIES[body])
    for moment in ((0.4, -0.7, 0.9), (0.0, 0.0, 0.0)):
        momentum, torque = np.array(moment) * scale, np.zeros(3)
        momentum[axis], torque[axis] = 0, 0.3 * scale
        agrees(physical(BODIES[body], momentum, torque), np.random.default_rng(axis).normal(size=(3, 3)),
               period=False)


# D = (4, 4, 2), lambda = (0, l2, 0), torque (M1, 0, 0): with angle a from the saddle (0, u, v), w3 = v -
# l2 a/2 and w2 = u - v a/2 + l2 a^2/8, so w1' = (2 w2 w3 + l2 w3 + M1)/4 is a cubic in a, w1^2 = 2 integral a
# rational quartic: the only case with torque where doubles can tie, and any rounding in U(saddle) - E tips it
TIES = [(1.0, -50.0, (-10.5, -2.5), (1.0, -7.5, -3.5)), (2.0, -70.0, (-11.0, -3.5), (1.0, -9.0, -4.5)),
        (4.0, -110.0, (-12.0, -5.5), (0.5, -10.5, -6.5)), (8.0, -64.0, (-12.0, -4.0), (8.0, -12.0, 4.0))]


@pytest.mark.parametrize("l2, torque, saddle, state", TIES)
def test_parabolic_states_exactly_on_a_separatrix_are_recognised(l2, torque, saddle, state):
    pair = physical((4.0, 4.0, 2.0), (0.0, l2, 0.0), (torque, 0.0, 0.0))
    assert pair[1].rate((0, *saddle)) == [0, 0, 0]
    near = [(float(np.nextafter(state[0], end)), *state[1:]) for end in (10, 0)]
    # a double well: bounded on either side of the tie
    assert agrees(pair, [state, *near], extremes=False) == ["separatrix", "bounded", "bounded"]


@pytest.mark.parametrize("h", [2.0 ** -20, 2.0 ** -40, 2.0 ** 20, 2.0 ** 40, -(2.0 ** -30)])
def test_equilibria_far_out_on_the_hyperbola_are_found_and_judged(h):
    """X = -1/h, x2 = h with a = b = 0: exact doubles at distances up to 1e12, where X x2 + 1 must not
    be lost."""
    nudge = 2.0 ** -10 * min(1.0, abs(h), 1 / abs(h))
    words = agrees(scaled(0, 0, (0, 0, 1)), [(-1 / h, h, w) for w in (0.0, nudge, -nudge)])
    assert words[0] == "equilibrium"


@pytest.mark.parametrize("a, b, mu, state", [
    (0.0, 0.0, (0, 0, 1), (-2.0, 0.5, 0.0)), (0.0, 0.0, (0, 0, 1), (-0.5, 2.0, 0.0)),
    (0.25, 0.5, (0, 0, 1), (-2.5, 0.5, 0.0)), (0.25, 0.5, (0, 0, -1), (1.5, 0.5, 0.0)),
    (0.25, 0.5, (0, 1, 0), (1.75, 0.0, 0.5)), (0.5, 0.5, (1, 0, 0), (-0.5, 2.0, -0.5))])
def test_an_exact_equilibrium_is_neither_bounded_nor_spinning_up(a, b, mu, state):
    """Saddle or centre: margin, period and turning points are 0/0 in naive code."""
    scene, problem = scaled(a, b, mu)
    assert problem.rate([energy.Fraction(v) for v in state]) == [0, 0, 0]
    assert stabilab.fate(scene, np.array(state)).labels == EQUILIBRIUM
    np.testing.assert_array_equal(stabilab.extremes(scene, np.array(state)), np.array([state, state]).T)
    assert stabilab.period(scene, np.array(state)) == 0


@pytest.mark.parametrize("speed", [-1e3, -1e6])
def test_a_spin_that_must_first_be_braked_through_many_turns_has_exact_extremes(speed):
    """Speed -1e6 is undone only after 8e10 turns: nobody integrates that, the potential needs two turns."""
    agrees(scaled(0.2, 0.4, (0, 0, 1)), [(1.0, 2.0, speed), (-3.0, 0.5, speed)], tolerance=1e-13)


def test_a_body_at_the_crossing_of_two_lines_of_equilibria_is_answered():
    """D = (3, 2, 1), wheel (1/2, 0, 0): rotations about axis 1 and those with w1 = -1/2, where (D1 - D2) w1 +
    1/2 = 0, cross there; a push along axis 3 leaves the energy constant, so the motion bounded."""
    scene = stabilab.Scene(stabilab.Body((3, 2, 1)), stabilab.Gyrostat(("0.5", 0, 0)))
    found = stabilab.fate(scene, np.array([(-0.5, 0, 0), (-0.5, 0, 1e-9)]))
    assert found.labels.tolist() == [EQUILIBRIUM, BOUNDED] and found.margins[0] == 0


@pytest.mark.one_in(8)
@pytest.mark.parametrize("tiny", [1e-3, 1e-8, 1e-15, 1e-30, 1e-100, 1e-300])
@pytest.mark.parametrize("y", [1.0, -2.0, 0.125])
def test_a_state_a_hair_off_the_spin_up_plane_turns_back(tiny, y):
    """x1 + b = y + tiny exactly, x3 = -y: C = 2 y tiny. In doubles x1 + b rounds to y, and the state looks as
    if on the plane; cosh and sinh of an angle near ln(1/tiny)/2 overflow or cancel. Proof of "bounded": U
    grows on both sides."""
    speeds = (0.5, -1.0, 0.0) if tiny > 1e-50 else (-1.0,)  # one in hundreds of digits takes a second
    words = agrees(scaled(0.25, tiny, (0, 1, 0)), [(y, s, -y) for s in speeds],
                   digits=120 + int(-1.2 * math.log10(tiny)), period=tiny >= 1e-30)
    assert words == ["bounded"] * len(speeds)


@pytest.mark.one_in(2)
@pytest.mark.parametrize("x3", [1e-15, 1e-12, 1e-8, -1e-15])
def test_states_with_an_invariant_of_1e_minus_30_are_bounded(x3):
    """Both Y = x1 + b and x3 nearly vanish: almost pure spin, which would go on for ever."""
    agrees(scaled(0.5, 1.0, (0, 1, 0)), [(-1.0, 0.5, x3), (-1.0, -3.0, x3), (-1.0 + abs(x3) * 2, 0.5, x3)],
           digits=200)


@pytest.mark.parametrize("radius", [0.0, 1e-8, 1e-160, 5e-324])
@pytest.mark.parametrize("speed", [0.0, 0.5, -2.0])
def test_circles_of_no_or_hardly_any_radius_spin_up_without_nan(radius, speed):
    """The angle atan2(0, 0) has no meaning; the motion has: x3' = 1 + O(radius)."""
    scene, state = stabilab.ScaledGyrostat(0.0, 0.5, (0, 0, 1)), np.array([0.0, radius, speed])
    found, box = stabilab.fate(scene, state), stabilab.extremes(scene, state)
    assert found.labels == Fate.SPIN_UP and found.margins == -np.inf
    assert box[2] == pytest.approx([speed, np.inf], rel=1e-7)
    np.testing.assert_allclose(box[:2], [[-radius, radius]] * 2, rtol=1e-11)


@pytest.mark.one_in(3)
@pytest.mark.parametrize("amplitude", [1e-6, 1e-12, 1e-17, 1e-100])
@pytest.mark.parametrize("mu, state", [((0, 0, 1), (-2.0, 0.5)), ((0, 0, 1), (-8.0, 0.125))])
def test_an_orbit_of_any_smallness_about_a_centre_has_its_period_and_extremes(amplitude, mu, state):
    """E - U(centre) is 1e-34 against terms of order one; x3max must come out as the amplitude, T as 2
    pi/sqrt(m) with m = X^2 - x2^2 = 1/h^2 - h^2 for a = b = 0."""
    pair, h, probe = scaled(0, 0, mu), state[1], np.array([*state, amplitude])
    assert agrees(pair, [probe], digits=300) == ["bounded"]
    np.testing.assert_allclose(stabilab.extremes(pair[0], probe)[2], [-amplitude, amplitude], rtol=1e-11)
    # the correction to the harmonic period is of the order of (amplitude/h)^2
    harmonic, near = 2 * math.pi / math.sqrt(h ** -2 - h ** 2), max(100 * (amplitude / h) ** 2, 1e-11)
    assert stabilab.period(pair[0], probe) == pytest.approx(harmonic, rel=near)
