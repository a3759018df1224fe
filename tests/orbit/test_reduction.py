"""Tests of `orbit/reduction.py`: what once went wrong there, and its edges."""
from __future__ import annotations

from fractions import Fraction as F

import numpy as np
import pytest

from stabilab import Body, ConstantTorque, Gyrostat, ScaledGyrostat, Scene
from stabilab.orbit.reduction import reduce
from tests.oracles.pairs import physical, scaled
from tests.orbit.fate.test_fate import FAMILIES


@pytest.mark.parametrize("mu, word, e", [((0, 0, 1), "elliptic", -1), ((0, 1, 0), "hyperbolic", 1)])
def test_the_minor_axis_is_elliptic_and_the_middle_axis_hyperbolic(mu, word, e):
    r = reduce(ScaledGyrostat("0.2", "0.4", mu))
    assert (r.kind, r.e) == (word, e)


def test_a_body_with_two_equal_moments_is_parabolic_about_a_transverse_axis():
    r = reduce(Scene(Body((2, 2, 1)), Gyrostat((0, "0.25", "0.5")), ConstantTorque(("0.5", 0, 0))))
    assert (r.kind, r.e, r.parabolic_shift_size) == ("parabolic", 0, 0.0)

REDUCED = {**FAMILIES, "free, gyrostat on the major axis": physical((3, 2, 1), (0.5, 0, 0)),
           "free": physical((3, 2, 1)),
           "free, gyrostat on the minor axis": physical((3, 2, 1), (0, 0, -0.25)),
           "free, scaled": scaled(0.25, 0.75, (0, 0, 0)),
           "wheel and torque on the symmetry axis": physical((3, 2, 2), (0.5, 0, 0), (0.25, 0, 0)),
           "wheel and torque on the symmetry axis, other signs": physical((2, 2, 1), (0, 0, -0.5),
                                                                          (0, 0, -0.25)),
           "wheel on the symmetry axis": physical((2, 3, 2), (0, 0.5, 0))}


@pytest.mark.parametrize("name", REDUCED)
def test_the_canonical_variables_move_as_the_module_says(name):
    """The exact rates, by the oracle's own coefficients: X' = Z W, Z' = e X W, W' = mu + G X Z + c Z + d X,
    mu >= 0."""
    scene, problem = REDUCED[name]
    r = reduce(scene)
    g, near = r.exact_constants, lambda a, b, size: abs(a - b) <= F(1, 10**50) * size
    for state in np.random.default_rng(8).normal(size=(8, 3)).tolist():
        rate = problem.rate([F(v) for v in state])
        x, z, w = r.canonical_exact(state)
        shifts = 1 + g["sj"] / g["rx"], 1 + g["sk"] / g["rz"], 1
        assert near(g["flip"] * rate[r.j] / g["rx"], z * w, abs(z * w))
        assert near(rate[r.k] / g["rz"], r.e * x * w, abs(x * w))
        terms = g["mu"], g["G"] * x * z, g["c"] * z, g["d"] * x
        assert near(g["flip"] * g["n"] * rate[r.axis], sum(terms), sum(map(abs, terms))) and g["mu"] >= 0
        assert r.exact_invariant_sign(state) == (1 if z * z > r.e * x * x else -1)
        for exact, rounded, size in zip((x, z, w), r.canonical(np.array(state)), shifts):
            assert float(exact) == pytest.approx(float(rounded), rel=1e-14, abs=1e-14 * abs(float(size)))
        back = r.component_i(float(w)), r.component_j(float(x)), r.component_k(float(z))
        assert back == pytest.approx([state[i] for i in (r.axis, r.j, r.k)], rel=1e-13, abs=1e-13)
    torque = (F(scene.mu[r.axis]) if scene.variables == "scaled"
              else F(scene.vector("constant_torque")[r.axis]))
    assert r.sense == (torque > 0) - (torque < 0)
    # weight W^2/(2 n^2) is the energy of omega_i: the unit is weight/|p q|
    assert r.energy_unit == pytest.approx(float(problem.weight[r.axis] / abs(r.p * r.q)), rel=1e-15)


@pytest.mark.parametrize("inertia, momentum, torque", [
    ((3, 2, 1), (0.5, 0, 0), (0.2, 0, 0)), ((3, 2, 1), (0, 0.5, 0), (0, 0.2, 0)),
    ((3, 2, 1), (0, 0, 0), (1, 1, 0)),
    ((3, 2, 2), (0.5, 0.1, 0), (0.2, 0, 0)), ((2, 2, 1), (0.5, 0, 0), (0.2, 0, 0)),
    ((3, 2, 1), (1, 1, 1), (0, 0, 0))])
def test_no_reduction_where_the_other_two_rates_share_no_factor(inertia, momentum, torque):
    """D_j w_j' = (D_k - D_i) w_k (w_i - s) ...: a wheel along the torque's axis asks for D_j = D_k and
    nothing across it."""
    assert reduce(physical(inertia, momentum, torque)[0]) is None


def test_a_wheel_on_the_symmetry_axis_shifts_the_rate_about_it():
    """D2 w2' = (D3 - D1) w3 w1 - lambda1 w3 vanishes at w1 = -lambda1/(D1 - D3), D2 = D3: s = lambda1/(D1 -
    D3)."""
    r = reduce(REDUCED["wheel and torque on the symmetry axis"][0])
    assert (r.axis, r.s, r.weight) == (0, F(1, 2), 3)
