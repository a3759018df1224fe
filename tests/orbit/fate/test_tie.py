"""States exactly on a separatrix are recognised by algebra; states a hair beside it are not."""
from fractions import Fraction
from fractions import Fraction as F
from itertools import product
from math import isqrt

import numpy as np
import pytest

import stabilab
from stabilab import Body, ConstantTorque, Fate, Gyrostat, Scene
from stabilab.numbers.balls import working
from stabilab.orbit.fate.one_state import Reason, exact_tie
from stabilab.orbit.one_orbit import ball_orbit
from stabilab.orbit.reduction import reduce
from tests.oracles.pairs import physical

# |H|^2 = 2 D2 T (the middle axis' polhode, Euler): D1 (D1 - D2) w1^2 = D3 (D2 - D3) w3^2, here 4 w1^2 = 2.25
# w3^2
BODY = Body((4, 3, "1.5"))


def tied(scene, state, bits=256):
    with working(bits) as numbers:
        return exact_tie(ball_orbit(reduce(scene), state, numbers))


@pytest.mark.parametrize("state", [(3.0, 0.0, 4.0), (3.0, 1.0, 4.0), (3.0, -2.0, 4.0), (-3.0, 0.5, 4.0)])
def test_a_polhode_through_the_middle_axis_is_a_tie(state):
    assert tied(Scene(BODY), state)


@pytest.mark.parametrize("state",
                         [(3.0 + 2**-50, 1.0, 4.0), (3.0, 0.0, 4.0 + 2**-50), (3.0, 0.0, 4.0 - 2**-50)])
def test_a_state_one_unit_beside_it_is_none(state):
    assert not tied(Scene(BODY), state)


def test_with_a_torque_no_state_is_a_tie_even_where_doubles_see_none():
    # Lindemann: the difference is algebraic minus a rational multiple of a transcendental angle
    scene = Scene(BODY, ConstantTorque((0, 0, 1)))
    assert not any(tied(scene, state) for state in ((3.0, 0.0, 4.0), (0.0, 0.0, 0.0), (1.0, 1.0, 1.0)))


def series(reduction, u, v):
    """F along a parabola by hand: the pair's linear equations integrated (p or q is zero), coefficients
    lowest first."""
    r = reduction
    us = [u, r.p * v + r.p0, r.p * r.q0 / 2]
    vs = [v, r.q * u + r.q0, r.q * r.p0 / 2]
    force = [r.m + r.rho * vs[0] + r.sigma * us[0], r.rho * vs[1] + r.sigma * us[1],
             r.rho * vs[2] + r.sigma * us[2], Fraction(0), Fraction(0)]
    for n, m in product(range(3), repeat=2):
        force[n + m] += r.kappa * us[n] * vs[m]
    return force


def at(coefficients, y):
    return sum(c * y**n for n, c in enumerate(coefficients))


def root(value):
    """The rational square root, or None."""
    if value <= 0:
        return None
    top, bottom = isqrt(value.numerator), isqrt(value.denominator)
    return (Fraction(top, bottom) if (top * top, bottom * bottom) == (value.numerator, value.denominator)
            else None)


@pytest.mark.slow
def test_rational_states_on_a_parabolic_separatrix_are_ties():
    # built by hand: a barrier at a rational offset whose height above the start is half a rational square
    found = 0
    for wheel, torque in product((1, 2, 3, 4), (0, 1)):
        scene = Scene(Body((2, 2, 3)), Gyrostat((0, wheel, 0)), ConstantTorque((torque, 0, 0)))
        reduction = reduce(scene)
        if reduction is None or reduction.e:
            continue
        for u, v, y in product([Fraction(n, 2) for n in range(-8, 9)], [Fraction(n, 2) for n in range(-8, 9)],
                               [Fraction(n, 2) for n in range(-8, 9)]):
            force = series(reduction, u, v)
            if at(force, y) or at([n * c for n, c in enumerate(force)][1:], y) <= 0:
                continue
            speed = root(-2 * at([0, *(c / (n + 1) for n, c in enumerate(force))], y))
            if speed is None or Fraction(float(speed)) != speed:
                continue
            state = [0.0] * 3
            state[reduction.j], state[reduction.k], state[reduction.axis] = float(u), float(v), float(
                speed - reduction.s)
            assert tied(scene, tuple(state))
            state[reduction.axis] += 2.0**-40
            assert not tied(scene, tuple(state))
            found += 1
    assert found  # the search found some


def test_free_motions_on_an_invariant_plane_tend_to_the_pure_spin_exactly_where_their_energy_reaches_its():
    """D = (6, 5, 3), lambda = (1/2, 0, 1): p = q = 1/3, planes w3 - 1/2 = +-(w1 + 1/2). On them |H|^2 - 2 D2
    T is that of the pure spin about axis 2 at w1 = -1/2, w3 = 1/2, whose least energy is (6/4 + 3/4)/2 = 9/8;
    less energy cannot go there."""
    scene, _ = physical((6, 5, 3), (0.5, 0, 1))
    states = [(y - 0.5, w, 0.5 + s * y) for y in (-2, -0.5, 0.25, 0.5, 1, 3) for s in (1, -1)
              for w in (0, 0.5, -2)]
    states.remove((0.0, 0, 0.0))  # at rest
    found = stabilab.fate(scene, np.array(states))
    over = [F(6 * x * x + 5 * y * y + 3 * z * z) / 2 - F(9, 8) for x, y, z in states]
    assert 0 in over and min(over) < 0
    np.testing.assert_array_equal(found.labels, [Fate.SEPARATRIX if o >= 0 else Fate.BOUNDED for o in over])
    # what tends to the pure spin has its energy at its momentum: margin 0; the others keep off every saddle
    np.testing.assert_array_equal(found.margins == 0, [o >= 0 for o in over])
    np.testing.assert_array_equal(found.reasons, [Reason.TIE if o >= 0 else Reason.TORQUE_FREE for o in over])
