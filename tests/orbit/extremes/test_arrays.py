"""Facts about extremes that small faults break: turning points, small librations, free motions, motions of
every size."""
from __future__ import annotations

import subprocess
import sys

import mpmath as mp
import numpy as np
import pytest

import stabilab
from stabilab import Body, Fate, Gyrostat, Scene
from stabilab.answers.motion import motion
from stabilab.orbit.landscape import landscape
from tests.oracles import energy
from tests.oracles.energy import Reduced, _levels
from tests.oracles.pairs import WORDS, assert_margin, axis_of, exactly, physical, scaled
from tests.orbit.extremes.test_extremes import assert_extremes
from tests.orbit.fate.test_fate import FAMILIES
from tests.shared import PARABOLIC

ALL = FAMILIES | PARABOLIC


def librations(name, count, low, high):
    """Bounded states at relative distances 10^low to 10^high from wells."""
    scene, rng = ALL[name][0], np.random.default_rng(3)
    points = [p for c in stabilab.equilibria(scene).curves for p in c.samples]
    wells = [p.at for p in points if p.linear == "stable" and max(map(abs, p.at)) < 100]
    at = np.array([wells[n] for n in rng.integers(len(wells), size=8 * count)])
    size = 10.0 ** rng.uniform(low, high, (8 * count, 1)) * np.abs(at).max(axis=1, keepdims=True)
    states = at + rng.normal(size=at.shape) * size
    return states[stabilab.fate(scene, states).labels == Fate.BOUNDED][:count]


@pytest.mark.one_in(2)
@pytest.mark.parametrize("name", ["minor scaled +", "minor scaled -", "minor physical", "minor on axis 1",
                                  "major physical"])
def test_a_small_libration_keeps_its_digits_on_either_side_of_its_well(name):
    """A well just behind the state is not a whole turn ahead: over a turn 2 pi mu swamps the small energy
    above it."""
    scene, problem = FAMILIES[name]
    states = librations(name, 8, -4, -2.5)
    for box, state in zip(stabilab.extremes(scene, states), states.tolist()):
        assert_extremes(box, energy.extremes(problem, state, digits=40), 3e-12)


def test_the_energy_above_a_well_behind_drowns_in_that_of_a_turn():
    """The case is hard: taken from the copy a turn ahead, the energy of a libration of 1e-3 keeps seven
    digits."""
    scene, problem = FAMILIES["minor scaled +"]
    state = np.array([[-2.794653878935768, 0.417874152676454, 0.0009299997902537878]])
    land = landscape(scene)
    place, w, _ = land.start(state)
    offsets, spots, _ = land.critical(place)
    column = np.nanargmax(offsets[0])
    naive = (0.5 * w[0] ** 2 + land.potential.rise(-offsets[:, column], spots[:, :, column])[0]
             - 2 * np.pi * land.potential.mu)
    with mp.workdps(40):
        motion = Reduced(problem, state[0].tolist(), 40)
        exact = (float(max(motion.g(a) for a, kind in motion.stationary() if abs(a) < 0.1) / 2)
                 * motion.k0 ** 2)
        assert abs(naive / exact - 1) > 1e-10
    top = land.rate(np.sqrt(2 * float(exact)) * np.array([-1.0, 1.0]))
    np.testing.assert_allclose(stabilab.extremes(scene, state)[0, 2], np.sort(top), rtol=1e-12)


FREE = {"free": physical((3, 2, 1)), "wheel on the major axis": physical((3, 2, 1), (0.5, 0, 0)),
        "wheel on the minor axis": physical((3, 2, 1), (0, 0, -0.25)),
        "free, scaled": scaled(0.25, 0.75, (0, 0, 0))}


def free_extremes(problem, state):
    """Those of the oracle, or, over all barriers, of the whole circle with the speeds at its equilibria."""
    with mp.workdps(40):
        motion = Reduced(problem, state, 40)
        if motion.end(1)[0] != "open":
            return energy.extremes(problem, state, digits=40)
        out, shift = [None] * 3, mp.mpf(motion.h.numerator) / motion.h.denominator
        speeds = [mp.sign(motion.w0) * mp.sqrt(motion.g(a)) - shift for a, _ in motion.stationary()]
        out[motion.i] = [min(speeds), max(speeds)]
        for which, axis in enumerate((motion.j, motion.k)):
            values = [motion.pair(a)[which] for a in _levels(motion, which, 0, motion.turn)]
            out[axis] = [min(values), max(values)]
    return out


@pytest.mark.parametrize("name", FREE)
def test_free_motions_over_and_between_their_barriers_have_the_extremes_of_the_potential(name, monkeypatch):
    """Both kinds, in both senses, without ball arithmetic."""
    from stabilab.orbit import extremes_and_periods as both
    monkeypatch.setattr(both, "precise_extremes",
                        lambda *a: pytest.fail("a generic state went to ball arithmetic"))
    scene, problem = FREE[name]
    states = np.random.default_rng(2).normal(size=(8, 3))
    margins = stabilab.fate(scene, states).margins
    assert (margins > 0).any() and (margins < 0).any()
    for state, box in zip(states.tolist(), stabilab.extremes(scene, states)):
        assert_extremes(box, free_extremes(problem, state), 1e-11)


@pytest.mark.parametrize("name",
                         ["minor scaled +", "minor physical, other sign", "major physical", "middle scaled +",
                                  "middle scaled -, |c| above the cusp", "first axis", "second axis",
                                  "wheel on the symmetry axis"])
def test_motions_of_every_size_and_sense_have_the_extremes_of_the_potential(name):
    """A hundredth to thirty times the unit; against the torque through many wells, too."""
    scene, problem = ALL[name]
    states = np.random.default_rng(13).normal(size=(7, 3)) * 10.0 ** np.linspace(-2, 1.5, 7)[:, None]
    axis = axis_of(problem)
    states[3:, axis] = -np.abs(states[3:, axis]) * (1 if problem.m[axis] > 0 else -1)
    for state, box in zip(states.tolist(), stabilab.extremes(scene, states)):
        assert_extremes(box, energy.extremes(problem, state, digits=40), 1e-11)


@pytest.mark.one_in(3)
@pytest.mark.parametrize("off", [-1e-6, 1e-8, 1e-13])
def test_next_to_a_barrier_that_is_not_the_highest_extremes_and_period_keep_their_digits(off):
    """D = (6, 5, 3), lambda = (0, 3, 3), no torque: (-2, -3, -1) has the energy of the lower of two saddles,
    (0, -3, 3)."""
    scene, problem = physical((6, 5, 3), (0, 3, 3))
    state = (-2.0, -3.0, -1.0 + off)
    assert_extremes(stabilab.extremes(scene, np.array(state)), energy.extremes(problem, state, digits=90),
                    1e-11)
    exact = float(energy.period(problem, state, digits=90))
    assert stabilab.period(scene, np.array(state)) == pytest.approx(exact, rel=1e-11)


def test_a_free_motion_may_tend_to_a_saddle_that_is_not_the_highest():
    """The same state exactly: label, no period, and extremes whose ends are the saddle and the state's own
    rates."""
    scene, _ = physical((6, 5, 3), (0, 3, 3))
    state = np.array([-2.0, -3.0, -1.0])
    assert stabilab.fate(scene, state).labels == motion(scene, state).fate == Fate.SEPARATRIX
    box = stabilab.extremes(scene, state)
    assert box[0].tolist() == [-2.0, 0.0] and box[1, 1] == -3.0 and box[2].tolist() == [-1.0, 3.0]
    assert stabilab.period(scene, state) == np.inf
    for beside in (np.nextafter(-1.0, 0), np.nextafter(-1.0, -2)):
        assert stabilab.fate(scene, np.array([-2.0, -3.0, beside])).labels == Fate.BOUNDED


def test_a_wheel_on_the_axis_of_symmetry_leaves_a_slow_spin_about_it_its_digits():
    """D1 = D3 and lambda along axis 2: D2 omega2' = 0, so its least and greatest value are the state's; the
    reduced rate is 6e10 times it."""
    scene = Scene(Body((1.1117401918899112, 0.0026960631481820845, 1.1117401918899112)),
                  Gyrostat((0.0, -94100.55177549199, 0.0)))
    for spin in (1.4193800928353106e-06, -3e-12, 0.0):
        state = np.array([5.65e-07, spin, 4.49e-06])
        box = stabilab.extremes(scene, state)
        assert box[1].tolist() == [spin,
                                   spin] and np.abs(box[[0, 2]]).max() == pytest.approx(
                                       np.hypot(state[0], state[2]), rel=1e-12)


def test_a_well_that_the_search_along_a_nearly_straight_conic_misses_is_left_to_many_digits():
    """Two moments equal to 1e-15: the place found was no equilibrium, and the motion seemed to turn nine
    times further out."""
    scene, problem = physical((1.1047813401006856, 1.1822330003010755, 1.1822330003010744),
                              (0.020933431533374423, -0.5486642092301773, 0.0),
                              (0.0, 0.0, 82.56845985200516))
    state = [float.fromhex(v) for v in ("0x1.14c3976eedb21p-2", "0x1.c177397069eefp+48",
                                        "0x1.57e119d91b60ap-4")]
    assert_extremes(stabilab.extremes(scene, np.array(state)), energy.extremes(problem, state, digits=120),
                    1e-11)


def test_a_circle_that_may_or_may_not_touch_a_line_of_equilibria_is_judged_exactly():
    """D1 = D3: the equilibria lie on a line, which the circle of the state touches to rounding: is there a
    barrier? The potential at
    120 digits tells; doubles of the two ways said spin-up with an infinite rate, and no motion at all."""
    scene, problem = physical((1.4276494619780422, 8.965831416126159e-07, 1.4276494619780422),
                              (0.0, 0.0, 0.0006058653767121162),
                              (0.0, -4.924418876831019e-07, 0.0))
    state = [float.fromhex(v) for v in ("0x1.aa22f3f7fbf09p-11", "0x0.0p+0", "-0x1.bcfe9db0b6d69p-12")]
    for steps in range(-3, 4):
        here = [state[0] * (1 + steps * 2.0**-52), *state[1:]]
        found, exact = stabilab.fate(scene, np.array(here)), energy.margin(problem, here, digits=120)
        assert WORDS[energy.label(problem, here, digits=120)] == found.labels
        assert np.isneginf(found.margins) if exact is None else found.margins == pytest.approx(
            max(float(exact), 0.0), rel=1e-11)
        assert_extremes(stabilab.extremes(scene, np.array([here]))[0],
                        energy.extremes(problem, here, digits=120), 1e-11)


@pytest.mark.parametrize("off", [1e-8, 1e-12, 3e-15])
def test_next_to_the_centre_of_the_hyperbola_the_shift_costs_no_digits(off):
    """omega_j + lambda_j/(D_i - D_j) is some 1e-8 here and was formed from rounded parts: its logarithm is
    the way to the well, and eight digits of the largest omega_3 were lost."""
    scene, problem = physical((5.971849213055555, 0.2111990289374921, 5.838186057843126),
                              (-0.025648173771172383, 38.88062929746394, 0.0),
                              (0.0, 0.0, -23.228124232441903))
    centre = problem.sigma[1] / problem.kappa[1], problem.rho[0] / problem.kappa[0]
    state = (float(-centre[0]) - off, float(-centre[1]) + off, 0.00125)
    assert_extremes(stabilab.extremes(scene, np.array(state)), energy.extremes(problem, state), 1e-11)
    assert float(stabilab.period(scene,
                                 np.array(state))) == pytest.approx(float(energy.period(problem, state)),
                                                                    rel=1e-11)

# Places within rounding of an equilibrium: whether a barrier stands just ahead or just behind, and how far
# away the bottom of
# the well is, was taken from an offset of which no digit is known.
ON_TOP = {
    "spins past a barrier at its feet: the margin was the next barrier's": (
        scaled(0.6390328096348764, 19.411381920361986, (0, 0, -1)),
        exactly("-0x1.35ef36ff33723p+4", "0x1.8b421db307979p+4", "-0x1.00dc3a311452fp-9")),
    "comes back over 4989^2/2 of tilt to that barrier": (
        scaled(0.027808992339770862, 18.80015810306688, (0, 0, -1)),
        exactly("-0x1.2c27a45f16589p+4", "0x1.8b421db307979p+4", "-0x1.37d214eab5f1ep+12")),
    "leaves a barrier at 4e-20 rad/s: the least speed came out as 0": (
        physical((2.403762276104377, 33.491379775614966, 33.49137977327441),
                 (0, 1.1453380320515387, 0.16505048492733648),
                 (-1.4072510914200966, 0, 0)),
        exactly("-0x1.6a2f33e19a86bp-65", "-0x1.112845fc94fabp+3", "-0x1.7906fec6dc254p-10")),
    "falls from beside a barrier to one side, not to both": (
        physical((2.979665712340891, 7.538506160772763, 5.329794373938648),
                 (-0.0026659516336779003, 0, 0.01456763792456295),
                 (0, 0.022652367379224502, 0)),
        exactly("-0x1.2fb912987a882p-11", "-0x1.253adf6eea3d9p-67", "-0x1.15bb2ebb6355dp+4")),
    "swings by 2e-17, not by the 4e-20 of its start": (
        physical((2.4037622761043735, 1.900225948325099, 1.9002259481923007),
                 (0, 1.1453380320515387, 0.16505048492733648),
                 (-1.4072510914200966, 0, 0)),
        exactly("-0x1.6a2f33e19a86fp-65", "-0x1.8e620ff224da5p+2", "0x1.539d02a06c163p-2")),
    "swings by 2e-14 on a circle of 3e5": (
        scaled(-0.7960307727593067, -0.5654503420136732, (0, 0, 767138576.5141534)),
        exactly("0x1.4bf2b3a398269p+18", "-0x1.1a1b7e696010ap+11", "0x1.90090886ad427p-50")),
}


@pytest.mark.one_in(3)
@pytest.mark.parametrize("name", ON_TOP)
def test_at_the_place_of_an_equilibrium_extremes_margin_and_period_are_right(name):
    (scene, problem), state = ON_TOP[name]
    result = stabilab.fate(scene, np.array(state))
    assert WORDS[energy.label(problem, state, digits=200)] == result.labels
    assert_margin(problem, state, float(result.margins), digits=200)
    assert_extremes(stabilab.extremes(scene, np.array(state)), energy.extremes(problem, state, digits=200),
                    1e-11)
    assert float(stabilab.period(scene,
                                 np.array(state))) == pytest.approx(
                                     float(energy.period(problem, state, digits=120)), rel=1e-11)


def test_the_bottom_of_a_well_found_from_afar_keeps_its_digits():
    """The conic led to a place 0.08 from the well, and three Newton steps left 2e-11 of the way, and of the
    largest x2."""
    scene, problem = scaled(0.8307042242682406, -30.792072333727067, (0, 1e-12, 0))
    state = exactly("0x1.ecac540a16c96p+4", "0x1.c35891383cc51p-23", "0x1.5a98a2197fe7fp-47")
    found, exact = stabilab.extremes(scene,
                                     np.array(state))[1:], energy.extremes(problem, state, digits=150)[1:]
    np.testing.assert_allclose(found, [[float(v) for v in pair] for pair in exact], rtol=1e-12)


def test_a_barrier_just_behind_whose_side_doubles_do_not_know_is_not_passed_over():
    """It stands 2.7e-17 of the way behind; its ball held zero, so it lay neither ahead nor behind, and the
    motion of a single state seemed to reach the other well."""
    scene, problem = physical((3.1587850648825193, 2.0027089905544266, 4.4476881491823415),
                              (0.0, -0.06552824882726202, -0.002365970470787019),
                              (3.0775336506516674e-06, 0.0, 0.0))
    state = exactly("-0x1.2509dc30552e1p-65", "-0x1.c1fd405e70610p-5", "0x1.e3a39aa446327p-10")
    exact = energy.extremes(problem, state, digits=200)
    assert_extremes(np.array(stabilab.motion(scene, state, brief=True).extremes), exact, 1e-11)
    assert_extremes(stabilab.extremes(scene, np.array(state)), exact, 1e-11)


def test_the_walls_of_a_parabola_may_stand_half_a_million_away():
    """The search for a wall took steps of 64, as fit for e-foldings, and gave up after 70,000."""
    scene, problem = physical((31.654399378285444, 31.654399378285444, 0.063245553203366),
                              (0.0, 0.0, -0.03137990182886759),
                              (0.0, -16.89042945601369, 0.0))
    state = exactly("-0x1.03fc06f53988ep-15", "0x1.966c96486af75p+6", "0x1.1580201083a5fp-14")
    assert_extremes(stabilab.extremes(scene, np.array(state)), energy.extremes(problem, state, digits=200),
                    1e-11)
    assert float(stabilab.period(scene,
                                 np.array(state))) == pytest.approx(
                                     float(energy.period(problem, state, digits=120)), rel=1e-11)


def test_a_spin_up_that_just_passes_a_barrier_far_from_its_frame_keeps_its_slowest_rate():
    """The shift to canonical variables cost the place three digits, and the least rate, the root of a
    difference, four more."""
    scene, problem = physical((25.062883526084562, 25.092819511166038, 0.10986270773540596),
                              (1.2106455579057087, 0, 0.017087026406052554),
                              (0, -0.1219558847478546, 0))
    state = exactly("0x1.433801c3b82afp+5", "-0x1.61275ce4683f0p+1", "0x1.68877e4141140p-6")
    found, exact = stabilab.extremes(scene, np.array([state]))[0], energy.extremes(problem, state, digits=200)
    assert abs(found[1, 1] / float(exact[1][1]) - 1) < 1e-12
    assert_extremes(found, exact, 1e-11)


@pytest.mark.one_in(3)
@pytest.mark.parametrize("name", PARABOLIC)
def test_motions_along_parabolas_have_the_fate_and_extremes_of_the_potential(name):
    scene, problem = PARABOLIC[name]
    states = np.random.default_rng(4).normal(size=(12, 3)) * 2
    found, boxes, times = stabilab.fate(scene,
                                        states), stabilab.extremes(scene,
                                                                   states), stabilab.period(scene, states)
    for n, state in enumerate(states.tolist()):
        assert found.labels[n] == WORDS[energy.label(problem, state, digits=60)]
        assert_margin(problem, state, found.margins[n])
        assert_extremes(boxes[n], energy.extremes(problem, state, digits=60), 1e-11)
        if n < 3:
            assert times[n] == pytest.approx(float(energy.period(problem, state)), rel=1e-11)


def test_equilibria_beside_the_centre_of_a_hyperbola_stand_where_they_stand():
    """They are 1e-10 from it: a search for them on their curve that ends by steps of 1e-9 of the curve's size
    ends anywhere. The motion passes over the barrier there into a well of its own size; the oracle has 120
    digits."""
    scene, problem = scaled(-5.237000681110598, -5.346498528384807, (0.0, 9.052067096902745e-12, 0.0))
    state = tuple(map(float.fromhex,
                      ("0x1.562d0829e194cp+2", "-0x1.c48ca697a8c75p-17", "0x1.951d823f7c0c2p-43")))
    assert_extremes(stabilab.extremes(scene, np.array([state]))[0],
                    energy.extremes(problem, state, digits=120), 1e-11)


def test_small_arrays_never_load_numba():
    code = ("import sys, numpy as np\nfrom benchmarks.rows import SCENE, random_states\n"
            "from stabilab import extremes, period\nextremes(SCENE, random_states(900)); period(SCENE, "
            "random_states(100))\n"
            "sys.exit('numba' in sys.modules)")
    assert subprocess.run([sys.executable, "-c", code]).returncode == 0
