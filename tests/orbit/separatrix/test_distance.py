"""The distance from the separatrix: lower bound and witness meet where that is hard."""
from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

import stabilab
from stabilab.answers.motion import motion
from stabilab.orbit.reduction import reduce
from stabilab.orbit.separatrix.distance import distance_of
from stabilab.orbit.separatrix.homoclinic import NO_SEPARATRIX, UNKNOWN
from tests.oracles import energy
from tests.oracles.pairs import physical, scaled


@pytest.mark.one_in(3)
@pytest.mark.parametrize("lift", [1e-5, -1e-7, 1e-9, -1e-11, 1e-12])
@pytest.mark.parametrize("pair, state", [((0, 1), (0.4, 0.3, 0.5)), ((1, 0), (-1.0, 0.3, 2.0))])
def test_bound_and_witness_meet_however_alike_two_moments_are(lift, pair, state):
    """The doubles of loops told from the centre of the orbits used to leave brackets of up to 9 %. The
    witness is on the separatrix: the margin, which has no code in common with the search, changes its sign
    there."""
    moments = [1.2, 1.2, 1.0]
    moments[pair[1]] *= 1 + lift
    scene, state = physical(moments, (0.3, 0.2, 0), (0, 0, 0.1))[0], np.array(state)
    found = distance_of(reduce(scene), state.tolist())
    way = np.array(found.witness) - state
    assert found.settled and np.linalg.norm(way) == pytest.approx(found.upper, rel=2e-9)
    signs = [np.sign(stabilab.fate(scene, state + way * (1 + side)).margins) for side in (-1e-6, 1e-6)]
    assert signs[0] * signs[1] < 0


# At the tips of cones and beside the folds of far circles, where W grows like a root
CONES = [
    ((1.49736644, 0.44230883, 1.49736648), (-1.367, 0, 0), (0, 0, 0), (0.0977, -0.00325, 0.2235)),
    ((1.6706906974740514, 1.6706906974740514, 1.236882267730723), (0.2887157196510496, 0.6707558503088299, 0),
     (0, 0, 0),
     (-0.005014297134250996, 0.006338772360293345, 0.0015443377386760225)),
    ((1.2118380149530614, 1.13074942401926, 1.276202384807355), (-1.3650447610137093, 0, -1.953706814412097),
     (0, 0, 0),
     (0.5646276455972182, 0.005992371043408872, 0.39077055411060624)),
    ((1.3514392022064112, 1.837516534734172, 1.3514017666271823), (0.7865822722196931, 0, 0),
     (0, 0, 0.3020370702905364),
     (-2.4811783407460117, 1.2515862632451265, -5.671545379657007))]
# Where loops run far along an invariant plane: told by their saddles they move by e^y
ALONG = [
    ((1.5637603579889892, 1.9618001934913478, 1.0286388451871102),
     (0, 0.1298210205682596, -0.2809807005880112), (0, 0, 0),
     (3.574180856662026, 8.536803480006071, 5.307671798974504)),
    ((1.1617853181353837, 1.5412202312016956, 1.0769660944416684),
     (0, -0.2532265090143425, -1.9717684404796492), (0.8474919665936105, 0, 0),
     (11.26726403504404, 18.488724448197452, 12.682158756064094)),
    ((1.2429607089343842, 1.2429618285607196, 1.0774172052746194), (0, 0, -300680.3833442784),
     (0.05248724485989692, 0, 0),
     (5.00238728361977, -0.21685189881815653, -0.11852856533633595)),
    ((1.3577243346918109, 1.2641610423199228, 1.3577243023289156),
     (0.0013684417647415105, -988.3521929006432, 0), (0, 0, -0.9165233236148685),
     (1.157434860394527, 4.03197807466792, -2.4550689216984347)),
    ((1.9947841924869367, 1.663839618515029, 1.8797443467606212),
     (0.7974582055588898, -2.1079932791879634, 0), (0, 0, 0),
     (0.002589834840908386, -0.0100443715920583, 0.009826799926438293))]
# Small numbers, (a, b), mu2 and the state: a fold on a plane, or nearly
SMALL = [(0, -1, Fraction(-1, 4), (2, -1, 1)), (-1, 1, -1, (0, -1, -4)),
         (3, 1, 1, (-1, Fraction(3, 2), Fraction(-1, 2))), (0, -2, -1, (2, Fraction(5, 4), 1)),
         (1, 0, Fraction(1, 4), (Fraction(-5, 3), -1, 0)), (Fraction(-5, 4), Fraction(5, 3), -2, (0, 1, -1))]
# Newton's steps leave the saddles of the branch; the distance is that of its image under (1, 3, -2)
LEFT = physical((1.2958441810930759, 1.7178832789325895, 1.3916007488529667),
                (0.5618419444540199, -0.47551310516025364, 0), (0, 0, 0.3575622571421843))[0]
MEET = [*((physical(*row[:3])[0], row[3], None) for row in CONES + ALONG),
        *((stabilab.ScaledGyrostat(a, b, (0, mu, 0)), state, None) for a, b, mu, state in SMALL),
        (LEFT, (-1.631349547138242, -0.6426082392398669, -7.664385358239262), 1.29215665158),
        # (x1 + x3)' = x2 (x1 + x3 + b): the plane x1 + x3 = -b is a part of the separatrix, 1/sqrt 2 away;
        # two nearest points merge, and the squared distance bends by nothing one way
        (stabilab.ScaledGyrostat(Fraction(-5, 2), Fraction(5, 4), (0, 0, 0)), (Fraction(-1, 4), -3, -2),
         0.5**0.5)]


@pytest.mark.one_in(2)
@pytest.mark.parametrize("scene, state, distance", MEET)
def test_bound_and_witness_meet(scene, state, distance):
    """Where brackets used to be 8e-9 to 60 % wide, or no point was found at all."""
    found = distance_of(reduce(scene), state)
    assert found.settled and found.upper == pytest.approx(distance or found.upper, rel=1.1e-9)
    way = np.array(found.witness) - np.array(state, float)
    assert np.linalg.norm(way) == pytest.approx(found.upper, rel=1e-9)


# Moments almost equal, where the search cannot close
OPEN = [((1.0, 1.0000649330345721, 0.009103227291082629), (0, -42951531.77014759, 0),
         (0, 0, -1.0000649330345721), (0.0, 0.0, 0.0)),
        ((1.0, 0.4988300420368622, 1.000000010254544), (0, -0.500000005127272, -0.18134422971955058),
         (-1.5000000153818163, 0, 0), (0.0, -0.10657666490228779, -3.0))]


@pytest.mark.parametrize("inertia, wheel, torque, state", OPEN)
def test_a_bracket_is_given_where_the_search_cannot_close(inertia, wheel, torque, state):
    found = motion(physical(inertia, wheel, torque)[0], state)
    low, high = found.velocity_bounds
    assert 0 <= low <= high and (high - low <= 1e-6 * high or found.velocity_because
                                 and found.margin_velocity == low)


def test_a_branch_that_ends_beside_a_plane_is_not_taken_to_reach_it():
    """Its fold lies 1e-7 from the plane of loops of 1e6: the sheet ends there, and the plane, 880 away, is
    none of it. Without code in common: on the way the margin in energy stays above zero; at the witness, on
    the edge of the sheet, it vanishes with the barrier."""
    inertia, wheel = (1.8290967274280594, 1.8290962446652763,
                      1.5191332376501885), (0.1741448013106836, 0.0, -426.0248717963907)
    scene = physical(inertia, wheel, (0.0, -1.0941156527864675e-07, 0.0))[0]
    state = np.array([-0.1880791489812675, 0.018586251832376544, 0.034107800405773304])
    found = distance_of(reduce(scene), state.tolist())
    way = (np.array(found.witness) - state) / found.upper
    margins = stabilab.fate(scene,
                            state + way * found.upper
                            * np.array([[0.7], [1 - 1e-6], [1 - 1e-9], [1 + 1e-6]])).margins
    assert found.settled and margins[0] > 0 and 0 < margins[2] < 2e-3 * margins[1] and margins[3] == np.inf


def test_an_unknown_distance_is_no_number_and_none_is_infinite():
    """Infinite would say that no separatrix is near: the unsafe side."""
    assert np.isnan(
        UNKNOWN.value) and not UNKNOWN.settled and NO_SEPARATRIX.value == np.inf and NO_SEPARATRIX.settled


@pytest.mark.parametrize("part", [1e-9, 1e-12, 1e-15])
def test_states_far_nearer_than_doubles_of_the_search_tell_have_a_settled_distance(part):
    """On the perpendicular of a nearest point, at a distance that is known but for the rounding of that point
    to doubles."""
    scene, state = physical((3.0, 2.0, 1.5), (0, 0.8, 0), (0.2, 0, 0))[0], (0.3, 0.5, 0.4)
    still = distance_of(reduce(scene), state)
    beside = [Fraction(w) + Fraction(part / still.upper) * (Fraction(v) - Fraction(w)) for v,
              w in zip(state, still.witness)]
    found = distance_of(reduce(scene), beside)
    assert found.settled and found.boxes < 3000 and abs(found.upper - part) < 1e-9 * part + 1e-15


def test_a_side_of_a_box_that_no_double_divides_is_left_for_the_other():
    """Halving it went on until the boxes were spent, and the nearest point told was 1.24 away. The point told
    is on the separatrix: by the oracle the margin in energy changes its sign across it."""
    scene, problem = scaled(3.0, 1.0, (0, 1, 0))
    found = distance_of(reduce(scene), (-1, 1.5, -0.5))
    assert found.upper < 0.5843 and found.lower > 0.49
    # on the plane x + z = -1 to rounding, on one side of which alone there is a barrier
    x, y, z = found.witness
    z += 1e-12
    assert energy.margin(problem, (x, y * (1 - 1e-9), z)) > 0 > energy.margin(problem, (x, y * (1 + 1e-9), z))


def touching(part):
    """(scene, its image with x2, x3 and the torque reversed) whose hyperbola of equilibria touches an
    invariant plane but for a share of the torque."""
    mu = Fraction(1, 4) * (1 + part)
    return tuple(stabilab.ScaledGyrostat(-2, -1, (0, side * mu, 0)) for side in (1, -1))


PARTS = [0, *(sign * Fraction(1, 10**n) for n in (3, 9, 15, 24) for sign in (1, -1))]


@pytest.mark.one_in(3)
@pytest.mark.parametrize("part", PARTS)
def test_bound_and_witness_meet_where_a_fold_stands_on_an_invariant_plane_or_beside_it(part):
    """There xi of the saddles goes with a square, and no search ended from a share of 1e-8 on. An image has
    the same distance, as a reflection keeps distances."""
    for state in ((0.0, 0.75, -4.0), (-4.464045877402299, 5.91141621500135, -0.860840120095671),
                  (0.3, -0.2, 0.1)):
        found, image = (distance_of(reduce(scene), (state[0], *(side * v for v in state[1:]))) for scene,
                        side in zip(touching(part), (1, -1)))
        assert found.settled and image.settled and found.boxes < 2500 and abs(
            found.upper - image.upper) <= 1.1e-9 * found.upper


def test_a_state_in_the_middle_of_its_circles_has_a_settled_distance():
    """All that tells points of a loop apart is the rate about the axis there, and boxes were halved the other
    way: 1.4e-6 was left. By the oracle a motion just beyond the witness is held, and none is at 2,000 places
    just nearer than the lower bound."""
    scene, problem = physical((4.0, 2.0, 4.0), (0, 0, -0.5), (0, -3.0, 0))
    state, rng = np.array([0, 1, 0.25]), np.random.default_rng(6)
    found = distance_of(reduce(scene), tuple(state))
    ways = rng.normal(size=(2000, 3)) * (1, 1e-3, 1e-2)
    about = state + 0.999999 * found.lower * ways / np.linalg.norm(ways, axis=1)[:, None]
    x, y, z = found.witness
    assert found.settled and energy.margin(problem,
                                           (x, y * (1 - 1e-6),
                                            z)) > 0 > energy.margin(problem, (x, y * (1 + 1e-6), z))
    assert (stabilab.fate(scene, about).margins < 0).all()


@pytest.mark.parametrize("scene, state", [
    (stabilab.Scene(stabilab.Body((5, 3, 4))), (0, 0, 0)),
    (stabilab.Scene(stabilab.Body(("2", "4/3", "7/4"))), (0, 0, Fraction(3, 4))),
    (stabilab.ScaledGyrostat("-4/3", "5/2", (0, 0, 0)), (1, 0, 0)),
    (stabilab.ScaledGyrostat("3/2", 1, (0, 0, 0)), (-1, Fraction(-2, 3), 0)),
    (stabilab.ScaledGyrostat(1, -2, (0, 0, 0)), (3, Fraction(-3, 4), -1)),
    (stabilab.ScaledGyrostat("1/3", "-5/3", (0, 0, 0)), (Fraction(5, 3), -1, 0))])
def test_a_state_exactly_on_the_separatrix_is_at_no_distance_from_it(scene, state):
    """Saddles, and states whose energy equals a barrier's in rational numbers: the search crept towards
    1e-80, or hung."""
    assert distance_of(reduce(scene), state) == (0.0, 0.0, tuple(map(float, state)), None, 0)


FAR = [((12, 9, 5), (0.8, 0, 0), (0, 0, 0.02), (0.1, None, 0.02)),
       ((12, 9, 5), (0, 0.3, 0.2), (0.02, 0, 0), (0.1, None, 0.02)),
       ((12, 9, 5), (0.8, 0.3, 0), (0, 0, 0.02), (0.1, None, 0.02)),
       ((3, 2, 1), (0, 0, 0.5), (1, 0, 0), (0.1, None, 0.02))]


@pytest.mark.one_in(4)
@pytest.mark.parametrize("size", [1e3, 5e8, 1e13])
@pytest.mark.parametrize("moments, wheel, torque, state", FAR)
def test_a_state_far_from_the_centre_of_its_circles_has_a_settled_distance(moments, wheel, torque, state,
                                                                           size):
    """A branch of saddles was halved down to the state's own circle once for every part of the loops: a
    bracket from zero up after 3 s. The witness parts the fates by the oracle's energy in 60 digits, and no
    place just nearer than the lower bound does."""
    state = [size if v is None else v for v in state]
    scene, problem = physical(moments, wheel, torque)
    found, rng = distance_of(reduce(scene), state), np.random.default_rng(2)
    assert found.settled and found.boxes < 4000
    side = energy.margin(problem, tuple(map(Fraction, state)), 60) > 0
    axis, step = next(i for i in range(3) if torque[i]), np.array(found.witness) - state
    for share in (0.999999, 1.000001):
        at = [Fraction(v) + Fraction(share) * Fraction(s) for v, s in zip(state, step)]
        beyond = energy.margin(problem, tuple(at), 60) > 0
        # at a saddle itself the way ends at the rim of a sheet
        assert (beyond == side) == (share < 1) or step[axis] == -state[axis]
    for way in rng.normal(size=(12, 3)):
        at = [Fraction(v) + Fraction(float(0.999999 * found.lower * w / np.linalg.norm(way))) for v,
              w in zip(state, way)]
        assert (energy.margin(problem, tuple(at), 60) > 0) == side


def test_a_state_out_of_reach_of_doubles_is_told_at_once():
    """Rates of 1e200: their squares are no doubles."""
    assert distance_of(reduce(physical(*FAR[0][:3])[0]), (0.1, 1e200, 0.02)) == UNKNOWN
