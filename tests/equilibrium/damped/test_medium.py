"""Equilibria in a resisting medium at the edges: folds, pairs on the imaginary axis, and where no rate
determines the others.

The rates, their Jacobian and the torque that holds a given equilibrium are written here from
(D omega + lambda) x omega - c D omega + M = 0 in exact numbers (SymPy), sharing no code with the elimination.
"""
from fractions import Fraction

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp

from stabilab import Body, ConstantTorque, Gyrostat, Scene
from stabilab.answers.equilibria import equilibria
from stabilab.physics.effects.resistance import Resistance
from stabilab.physics.equations import derive
from tests.equilibrium.damped.test_liquid_and_medium import real_solutions

OMEGA = sp.symbols("x1:4")


def rates(D, wheel, c, torque=(0, 0, 0), x=OMEGA):
    """omega' of the body, one expression an axis."""
    x, H = sp.Matrix(x), sp.Matrix([d * v + l for d, v, l in zip(D, x, wheel)])
    push = H.cross(x) - c * sp.Matrix([d * v for d, v in zip(D, x)]) + sp.Matrix(torque)
    return [p / d for p, d in zip(push, D)]


def held(D, wheel, c, at, nudge=(0, 0, 0)):
    """(scene, exact Jacobian at the equilibrium `at`) with the torque that holds it, changed by `nudge`."""
    torque = [-d * r + n for d, r, n in zip(D, rates(D, wheel, c, x=at), nudge)]
    jacobian = sp.Matrix(rates(D, wheel, c, torque)).jacobian(OMEGA).subs(dict(zip(OMEGA, at)))
    return scene(D, wheel, torque, c), jacobian


def scene(D, wheel, torque, c):
    wheel, torque = (tuple(Fraction(int(v.p), int(v.q)) for v in map(sp.Rational, row))
                     for row in (wheel, torque))
    return Scene(Body(D), Gyrostat(wheel), ConstantTorque(torque), Resistance(str(c)))


def point(where, at):
    """The one equilibrium at `at`."""
    (found,) = [p for p in equilibria(where).points
                if np.allclose(p.at, np.array(at, float), rtol=1e-12, atol=1e-12)]
    return found


HALF = sp.Rational(1, 2)
HOPF = [((2, 2, 1), (-3, -4, -6), HALF, (2, -3, 0)), ((4, 3, 2), (-2, 0, 1), HALF, (3, -3, -3)),
        ((9, 5, 4), (0, 0, -5), sp.Rational(1, 3), (2, 2, 1))]


@pytest.mark.parametrize("D, wheel, c, at", HOPF)
def test_a_pair_of_eigenvalues_on_the_imaginary_axis_is_left_to_the_next_order(D, wheel, c, at):
    where, jacobian = held(D, wheel, c, at)
    z = sp.symbols("z")
    square = sp.Poly(jacobian.charpoly(z).as_expr(), z)
    real = -3 * c  # the sum of the three, so the pair is imaginary iff this is the third
    quotient, rest = sp.div(square, sp.Poly(z - real, z))
    assert rest.is_zero and quotient.coeff_monomial(z) == 0 and quotient.coeff_monomial(1) > 0
    found = point(where, at)
    assert (found.linear, found.verdict) == ("degenerate", "undecided") and "imaginary axis" in found.because
    assert [e.real for e in found.eigenvalues] == [float(real), 0.0, 0.0]


FOLDS = [((3, 2, 1), (5, -1, 5), 1, (-3, 2, 3)), ((2, 2, 1), (2, -5, -3), 1, (-3, 1, 2)),
         ((3, 2, 2), (6, -4, 5), HALF, (3, 1, 3))]


@pytest.mark.parametrize("D, wheel, c, at", FOLDS)
def test_motions_leave_a_fold_on_the_side_of_the_square(D, wheel, c, at):
    """On the centre line z' = a z^2, a = l . f''(v, v)/(2 l . v) with J v = 0 = l J: one side leaves, the
    other returns."""
    where, jacobian = held(D, wheel, c, at)
    (v,), (left,) = jacobian.nullspace(), jacobian.T.nullspace()
    bend = sp.Matrix(rates(D, (0, 0, 0), 0, x=v))  # the quadratic part of the rates
    a = float(left.dot(bend) / left.dot(v))
    found = point(where, at)
    assert a != 0 and (found.linear, found.verdict) == ("degenerate",
                                                        "unstable") and "even power" in found.because
    torque = [-d * r for d, r in zip(D, rates(D, wheel, c, x=at))]
    run = sp.lambdify([OMEGA], rates(D, wheel, c, torque))
    v, start = np.array(v, float).ravel(), np.array(at, float)
    step = 1e-3 * np.sign(a) / np.abs(v).max()
    ends = [solve_ivp(lambda t, x: run(x), (0, 1.5 / abs(a * step)), start + side * step * v, method="LSODA",
                      rtol=1e-10,
                      atol=1e-12).y[:, -1] for side in (1, -1)]
    away, back = (np.abs(end - start).max() for end in ends)
    assert away > 0.1 and back < 0.7e-3


SUBCRITICAL = [((4, 3, 5), 2, -5, 4), ((4, 3, 2), 2, -5, -4)]


@pytest.mark.parametrize("D, axis, wheel, rate", SUBCRITICAL)
def test_a_triple_equilibrium_of_a_subcritical_pitchfork_drives_away(D, axis, wheel, rate):
    """Rotation about the wheel's axis k with c^2 = -a f: the pair (v_i, v_j) of the zero eigenvalue pulls
    omega_k by h = kappa_k v_i v_j z^2/c, and z' = z l . A'(omega_k) v h/(l . v), A the matrix of the other
    two rates."""
    momentum, at = [0, 0, 0], [0, 0, 0]
    momentum[axis], at[axis] = wheel, rate
    where, jacobian = held(D, momentum, HALF, at)
    (v,), (left,) = jacobian.nullspace(), jacobian.T.nullspace()
    pulled = sp.Matrix(rates(D, (0, 0, 0), 0, x=v))[axis] / HALF
    turned = sp.Matrix(rates(D, momentum, HALF)).jacobian(OMEGA).diff(OMEGA[axis])
    cubic = left.dot(turned * v) * pulled / left.dot(v)
    found = point(where, at)
    assert cubic > 0 and found.verdict == "unstable" and "odd power that drives away" in found.because


@pytest.mark.parametrize("nudge", ["1/1000000", "1e-200"])
def test_equilibria_beside_a_fold_are_told_apart_however_close(nudge):
    """Beyond the fold two are gone, before it there is a saddle and a node: as the eigenvalues at a millionth
    say."""
    D, wheel, c, at = FOLDS[0]
    before, beyond = (held(D, wheel, c, at, (side * sp.Rational(nudge), 0, 0))[0] for side in (-1, 1))
    words = [p.verdict for p in equilibria(before).points]
    assert len(equilibria(beyond).points) == len(words) - 2 == 1
    assert sorted(words) == ["asymptotically stable", "asymptotically stable", "unstable"]
    if nudge == "1/1000000":
        for p in equilibria(before).points:
            jacobian = sp.lambdify([OMEGA], sp.Matrix(rates(D, wheel, c)).jacobian(OMEGA))(p.at)
            assert (np.linalg.eigvals(np.array(jacobian, float)).real.max() < 0) == (p.verdict != "unstable")


def test_no_rate_determines_the_others_where_on_each_axis_two_equations_are_one():
    D, wheel, torque, c = (3, 2, 1), (4, 1, 7), (-sp.Rational(35, 2), 6, sp.Rational(9, 2)), 1
    for axis, value in enumerate((-3, -2, sp.Rational(11, 2))):
        others = [i for i in range(3) if i != axis]
        two = [rates(D, wheel, c, torque)[i].subs(OMEGA[axis], value) for i in others]
        matrix, right = sp.linear_eq_to_matrix(two, [OMEGA[i] for i in others])
        # a line of solutions: the axis determines nothing
        assert matrix.rank() == matrix.row_join(right).rank() == 1
    found = equilibria(scene(D, wheel, torque, c))
    assert found.kind == "undecided" and not found.points and "not determined" in found.because
    beside = equilibria(scene(D, wheel, (torque[0] + sp.Rational(1, 10**9), *torque[1:]), c))
    # the degree of the map at infinity is that of -c D omega
    assert beside.kind == "points" and len(beside.points) % 2 == 1


@pytest.mark.parametrize("wheel", [0, 1])
def test_a_torque_about_the_largest_moment_leaves_one_equilibrium_where_the_others_only_turn(wheel):
    where = scene((9, 5, 4), (wheel, 0, 0), (2, 0, 0), HALF)
    (only,) = equilibria(where).points
    assert only.at == (4 / 9, 0.0, 0.0) and only.verdict == "asymptotically stable"
    assert np.allclose(real_solutions(derive(where)), [only.at], rtol=1e-14)
