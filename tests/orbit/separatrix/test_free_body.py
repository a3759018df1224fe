"""Free bodies on the separatrix of Euler's polhodes, however their axes are numbered: exact ties and
hyperbolic functions.

With D1 > D2 > D3 and D1 (D1 - D2) w1^2 = D3 (D2 - D3) w3^2 the motion is w2 = W tanh(n t + c), w1 and w3 in
sech(n t + c) (Euler; Landau and Lifshitz, Mechanics, section 37): it tends to a rotation about the middle
axis.
"""
from fractions import Fraction
from itertools import permutations

import mpmath
import numpy as np
import pytest

import stabilab
from stabilab import Body, ConstantTorque, Fate, ScaledGyrostat, Scene
from stabilab.answers.motion import motion
from tests.oracles import energy
from tests.oracles.model import scaled
from tests.oracles.pairs import assert_extremes

MOMENTS = (4.0, 3.0, 1.5)  # 4 w1^2 = 2.25 w3^2
ORDERS = list(permutations(range(3)))
PLACES = [(3.0, 0.0, 4.0), (3.0, 1.0, 4.0), (3.0, -2.0, 4.0), (-3.0, 0.5, 4.0), (-3.0, -7.0, -4.0)]


def sech_extremes(state):
    """[(least, greatest)] over t >= 0 of the three components, D1 > D2 > D3."""
    D, (w1, w2, w3) = MOMENTS, state
    W = (w2**2 + (D[0] * w1**2 + D[2] * w3**2) / D[1]) ** 0.5  # 2 T = D2 W^2
    towards = np.sign((D[2] - D[0]) * w1 * w3)
    middle = sorted((w2, towards * W))
    shrink = (1 - (w2 / W) ** 2) ** 0.5  # sech; 1 at the top
    rows = []
    for w in (w1, w3):
        top = w / shrink if w2 * towards < 0 else w  # through w2 = 0, where sech is 1
        rows.append(sorted((0.0, top)))
    return [rows[0], middle, rows[1]]


@pytest.mark.one_in(4)
@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("order", ORDERS)
def test_a_free_body_on_the_separatrix_tends_to_its_middle_axis(order, place):
    """Two axes exchanged turn the motion round in time, so its mirror image is asked for: one sign of the
    state turns."""
    even = order in ((0, 1, 2), (1, 2, 0), (2, 0, 1))
    mirrored = [v if even else -v for v in place]
    scene = Scene(Body([MOMENTS[n] for n in order]))
    state = tuple(mirrored[n] for n in order)
    found = motion(scene, state)
    assert found.fate == Fate.SEPARATRIX and found.margin_energy in (0.0, None) and found.period is None
    exact = sech_extremes(place)
    wanted = [exact[n] if even else sorted(-v for v in exact[n]) for n in order]
    np.testing.assert_allclose(np.array(found.extremes), wanted, rtol=1e-12, atol=1e-300)
    np.testing.assert_allclose(stabilab.extremes(scene, np.array(state)), wanted, rtol=1e-12, atol=1e-300)
    assert stabilab.period(scene, np.array(state)) == np.inf


def polhode(state):
    """(extremes, period) of a free body off the separatrix, D1 > D2 > D3, in exact squares and Jacobi's K
    (Landau and Lifshitz, section 37)."""
    D, w = [Fraction(d) for d in MOMENTS], [Fraction(v) for v in state]
    twice, square = sum(d * v * v for d, v in zip(D, w)), sum((d * v) ** 2 for d, v in zip(D, w))
    round_1 = square > twice * D[1]
    a, c = (0, 2) if round_1 else (2, 0)  # it turns about axis a
    tops = [(twice * D[c if n != c else a] - square) / (D[n] * (D[c if n != c else a] - D[n]))
            for n in (0, 1, 2)]
    tops[1] = (twice * D[a] - square) / (D[1] * (D[a] - D[1]))
    least = (square - twice * D[1]) / (D[a] * (D[a] - D[1]))
    rows = [[-float(t) ** 0.5, float(t) ** 0.5] for t in tops]
    rows[a] = sorted(np.sign(float(w[a])) * float(t) ** 0.5 for t in (least, tops[a]))
    speed = (D[a] - D[1]) * (square - twice * D[c]) / (D[0] * D[1] * D[2])
    k2 = (D[1] - D[c]) * (twice * D[a] - square) / ((D[a] - D[1]) * (square - twice * D[c]))
    with mpmath.workdps(40):
        number = lambda f: mpmath.mpf(f.numerator) / f.denominator
        return rows, float(4 * mpmath.ellipk(number(k2)) / mpmath.sqrt(number(speed)))


@pytest.mark.one_in(4)
@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("factor", [1 - 2**-51, 1 + 2**-51, 1 - 2**-30, 1 + 2**-30, 0.5, 2.0])
def test_beside_the_separatrix_a_free_body_turns_as_jacobis_functions_say(order, factor):
    rows, period = polhode((3.0 * factor, 1.0, 4.0))
    scene, state = Scene(Body([MOMENTS[n] for n in order])), tuple((3.0 * factor, 1.0, 4.0)[n] for n in order)
    found = motion(scene, state)
    assert found.fate == Fate.BOUNDED and found.period == pytest.approx(period, rel=1e-11)
    np.testing.assert_allclose(np.array(found.extremes), [rows[n] for n in order], rtol=2e-12)


@pytest.mark.parametrize("speed", [0.5, -0.5, -3.0])
def test_through_the_inflection_of_a_fold_a_motion_spins_up(speed):
    # a = b = 0: the equilibria (-1/h, h) merge at h = 1 on A^2 = 2; an inflection is no barrier, the
    # potential falls all the way
    found = motion(ScaledGyrostat(0, 0, (0, 0, 1)), (-1.0, 1.0, speed))
    assert found.fate == Fate.SPIN_UP
    assert_extremes(np.array(found.extremes),
                    energy.extremes(scaled(0, 0, (0, 0, 1)), (-1.0, 1.0, speed), digits=60), 1e-12)


def test_a_pure_spin_of_a_circle_of_no_radius_spins_up():
    for speed in (0.75, -0.75):
        # x1 + a = x2 = 0: x3' = 1
        found = motion(ScaledGyrostat("0.5", "0.5", (0, 0, 1)), (-0.5, 0.0, speed))
        assert found.fate == Fate.SPIN_UP and found.extremes == ((-0.5, -0.5), (0.0, 0.0), (speed, np.inf))
        assert found.invariants["Q"] == 0.0 and found.invariants["energy"] == pytest.approx(speed**2 / 2)


@pytest.mark.parametrize("state", [(1.0, 0.0, 0.0), (-2.5, 0.0, 0.0)])
def test_a_pure_spin_about_one_of_two_equal_axes_spins_up(state):
    # D = (2, 2, 1), torque on axis 1: omega_2 = omega_3 = 0 stays, and omega_1' = M/D
    found = motion(Scene(Body((2, 2, 1)), ConstantTorque((0.5, 0, 0))), state)
    assert found.fate == Fate.SPIN_UP and found.axis == 1
    assert found.extremes == ((state[0], np.inf), (0.0, 0.0), (0.0, 0.0))
