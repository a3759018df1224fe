"""States exactly on a separatrix are recognised by algebra; states a hair beside it are not."""
from fractions import Fraction as F

import numpy as np

import stabilab
from stabilab import Body, ConstantTorque, Fate, Scene
from stabilab.numbers.balls import working
from stabilab.orbit.fate import Basis, exact_tie
from stabilab.orbit.one_orbit import ball_orbit
from stabilab.orbit.reduction import reduce
from tests.oracles.pairs import physical


def test_with_a_torque_no_state_is_a_tie_even_where_doubles_see_none():
    # Lindemann: the difference is algebraic minus a rational multiple of a transcendental angle
    scene = Scene(Body((4, 3, "1.5")), ConstantTorque((0, 0, 1)))
    with working(256) as numbers:
        assert not any(exact_tie(ball_orbit(reduce(scene), state, numbers))
                       for state in ((3.0, 0.0, 4.0), (0.0, 0.0, 0.0), (1.0, 1.0, 1.0)))


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
    np.testing.assert_array_equal(found.reasons, [Basis.TIE if o >= 0 else Basis.TORQUE_FREE for o in over])
