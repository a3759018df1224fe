"""Bounded islands: their centre by averaging, and what is said of motions that recur."""
import math

import numpy as np
import pytest

from stabilab import Body, ConstantTorque, Fate, Gyrostat, Scene
from stabilab.unreduced.spin_up.follow import spin_up
from stabilab.unreduced.spin_up.form import _equilibria, centres, recurs

from .scenes import rates_of, run

MIDDLE = Scene(Body((1.4, 1, .6)), Gyrostat((0, 0, .193)), ConstantTorque((.01, -.6, .6)))
ISLANDS = [((1.2412, .3937, 1.3650), (.0987, .8450, .5255), (-.5224, .8309, .1914), (-1.572, .657, .738)),
           ((.6665, .9085, 1.4250), (.8214, .5658, .0724), (.2713, .0348, .9619), (.741, -.499, -3.724))]


def test_centre_is_where_the_stream_function_of_the_averaged_flow_is_stationary():
    """psi = I f0 + I^2 f1/2 of the derivation, written anew for this body: both derivatives vanish by finite
    differences."""
    (found,) = centres(MIDDLE)
    D1, D2, D3, M1, M3, l3 = 1.4, 1, .6, .01, .6, .193
    d2, d3 = D1 - D2, D1 - D3
    b, c = l3 * M3 / d3, (d3 - d2) * -.6 * .6 / (d2 * d3)
    K = (d3 - d2) * -b / (4 * D1 * math.sqrt(d2 * d3 / (D2 * D3)) * math.sqrt(D2 * D3))
    psi = lambda X, I: (I * (M1 + b / X - c / X**2) + I * I / 2 * K / X**3) / D1
    size = abs(psi(found.spin, 2 * found.action))
    for step in ((1e-4, 0), (0, 1e-3)):
        ahead, behind = (psi(found.spin + s * step[0], found.action + s * step[1]) for s in (1, -1))
        assert abs(ahead - behind) / (2 * max(step)) < 1e-6 * max(size, 1)
    spins = sorted(end[0] for end in _equilibria(MIDDLE))
    assert found.axis == 1 and spins[0] < found.spin < spins[1]  # between the two saddle-foci


def test_motion_about_the_centre_stays_and_that_of_the_other_wheel_leaves():
    """By DOP853: |eta|^2 = I across, D2 a2 U^2 = I/om-like scales from the normal form; the wheel on the
    other axis has no centre."""
    start = (-6.975, 5.28, .24)
    states = run(rates_of(MIDDLE), start, np.linspace(0, 100, 401))
    assert np.linalg.norm(states, axis=1).max() < 15
    other = Scene(Body((1.4, 1, .6)), Gyrostat((0, .0965, 0)), ConstantTorque((.01, -.6, .6)))
    assert not centres(other) and spin_up(other, start, 1000).fate == Fate.SPIN_UP


@pytest.mark.parametrize("D, M, l, state", ISLANDS)
def test_a_motion_in_an_island_is_told_to_be_in_one_and_is_never_certified(D, M, l, state):
    """Bounded over 1e6 natural units by runs in other integrators."""
    answer = spin_up(Scene(Body(D), Gyrostat(l), ConstantTorque(M)), state, 5000)
    assert answer.fate == Fate.UNDECIDED and "an island is seen" in answer.cause
    assert "bounded over 5000 s" in answer.cause
    early = spin_up(Scene(Body(D), Gyrostat(l), ConstantTorque(M)), state, 300)
    assert "is seen" not in early.cause and "may exist" in early.cause


def test_what_grows_or_rests_does_not_recur():
    growing = [2.0**n for n in range(48)]
    assert not recurs(growing, [v / 2 for v in growing], 2**16)
    assert not recurs([3.0] * 48, [2.99] * 48, 2**16)  # parked
    assert recurs([3.0] * 48, [1.0] * 48, 2**16) and not recurs([3.0] * 48, [1.0] * 48, 2**11)


def test_nothing_is_said_of_islands_without_a_wheel():
    scene = Scene(Body((1.4, 1, .6)), Gyrostat((0, 0, 0)), ConstantTorque((.01, -.6, .6)))
    assert not centres(scene) and "island" not in spin_up(scene, (-3, 1, 1), 5).cause
