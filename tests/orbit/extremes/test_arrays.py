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
from tests.oracles import energy
from tests.oracles.energy import Reduced, _levels
from tests.oracles.pairs import (
    agrees,
    assert_extremes,
    exactly,
    physical,
    scaled,
)
from tests.shared import FAMILIES, PARABOLIC

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
    from stabilab.orbit import extremes_arrays as both
    monkeypatch.setattr(both, "precise_extremes",
                        lambda *a: pytest.fail("a generic state went to ball arithmetic"))
    scene, problem = FREE[name]
    states = np.random.default_rng(2).normal(size=(8, 3))
    margins = stabilab.fate(scene, states).margins
    assert (margins > 0).any() and (margins < 0).any()
    for state, box in zip(states.tolist(), stabilab.extremes(scene, states)):
        assert_extremes(box, free_extremes(problem, state), 1e-11)


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


def test_slow_spins_about_the_axis_of_a_wheel_need_no_many_digits(monkeypatch):
    """D = (2, 2, 3): D3 w3' = M3 whatever the rest, so w3 begins at its least; (w1, w2) turns on its circle."""
    monkeypatch.setattr("stabilab.orbit.extremes_arrays.precise_extremes",
                        lambda *a: pytest.fail("a slow spin went to ball arithmetic"))
    scene = Scene(Body((2, 2, 3)), Gyrostat((0, 0, 500)), stabilab.ConstantTorque((0, 0, 0.25)))
    states = np.random.default_rng(4).normal(size=(200, 3)) * [1, 1, 1e-2]
    boxes, radii = stabilab.extremes(scene, states), np.hypot(states[:, 0], states[:, 1])
    assert np.array_equal(boxes[:, 2, 0], states[:, 2]) and (boxes[:, 2, 1] == np.inf).all()
    for k in range(2):
        assert boxes[:, k] == pytest.approx(np.stack([-radii, radii], axis=-1), rel=1e-14)


@pytest.mark.parametrize("steps", range(-3, 4))
def test_a_circle_that_may_or_may_not_touch_a_line_of_equilibria_is_judged_exactly(steps):
    """D1 = D3: the equilibria lie on a line, which the circle of the state touches to rounding: is there a
    barrier? Doubles of the two ways said spin-up with an infinite rate, and no motion at all."""
    pair = physical((1.4276494619780422, 8.965831416126159e-07, 1.4276494619780422),
                    (0.0, 0.0, 0.0006058653767121162), (0.0, -4.924418876831019e-07, 0.0))
    first, *others = exactly("0x1.aa22f3f7fbf09p-11", "0x0.0p+0", "-0x1.bcfe9db0b6d69p-12")
    agrees(pair, [(first * (1 + steps * 2.0**-52), *others)], margins=False)


@pytest.mark.parametrize("off", [1e-8, 1e-12, 3e-15])
def test_next_to_the_centre_of_the_hyperbola_the_shift_costs_no_digits(off):
    """omega_j + lambda_j/(D_i - D_j) is some 1e-8 here and was formed from rounded parts: its logarithm is
    the way to the well, and eight digits of the largest omega_3 were lost."""
    pair = physical((5.971849213055555, 0.2111990289374921, 5.838186057843126),
                    (-0.025648173771172383, 38.88062929746394, 0.0), (0.0, 0.0, -23.228124232441903))
    centre = pair[1].sigma[1] / pair[1].kappa[1], pair[1].rho[0] / pair[1].kappa[0]
    agrees(pair, [(float(-centre[0]) - off, float(-centre[1]) + off, 0.00125)])


def test_small_arrays_never_load_numba():
    code = ("import sys, numpy as np\nfrom benchmarks.rows import SCENE, random_states\n"
            "from stabilab import extremes, period\nextremes(SCENE, random_states(300)); period(SCENE, "
            "random_states(50))\n"
            "sys.exit('numba' in sys.modules)")
    assert subprocess.run([sys.executable, "-c", code]).returncode == 0
