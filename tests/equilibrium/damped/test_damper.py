"""Equilibria and bounds of a free body with a damper: the major-axis rule, and eigenvalues of the equations
derived in symbols."""
import numpy as np
import pytest

from stabilab import Body, ConstantTorque, Gyrostat, Scene, ViscousDamper, derive, equilibria, motion
from stabilab.equilibrium.damper import jacobian
from stabilab.equilibrium.stability import ordered
from stabilab.physics.coefficients import content
from stabilab.physics.to_numpy import to_numpy

DAMPER = ViscousDamper("0.1", "0.3")
SCENE = Scene(Body((3, 2, 1)), DAMPER)


def test_the_major_axis_attracts_and_the_others_do_not():
    verdicts = {curve.name[-1]: {one.verdict for one in curve.segments} for curve in equilibria(SCENE).curves}
    assert verdicts == {"1": {"stable"}, "2": {"unstable"}, "3": {"unstable"}}


def test_eigenvalues_are_those_of_the_equations_in_symbols():
    system = to_numpy(derive(SCENE))
    for curve in equilibria(SCENE).curves:
        for point in curve.samples:
            J = system.jacobian(np.array([*point.at, 0, 0, 0]))
            assert jacobian(content(SCENE), point.at) == pytest.approx(J, rel=1e-14, abs=1e-14)
            assert point.eigenvalues == ordered(np.linalg.eigvals(jacobian(content(SCENE), point.at)))
            assert "liquid" not in point.because
            if any(point.at):  # but for the eigenvalue 0 along the line, signs say what the verdict says
                largest = sorted(np.linalg.eigvals(J), key=abs)[1:]
                assert (max(v.real for v in largest) < 0) == (point.verdict == "stable")


@pytest.mark.parametrize("more", [ConstantTorque((0, 0, 1)), Gyrostat((0, 0, 1))], ids=lambda one: one.name)
def test_beside_a_torque_or_a_wheel_equilibria_are_undecided(more):
    assert equilibria(Scene(Body((3, 2, 1)), DAMPER, more)).kind == "undecided"


def test_a_motion_with_a_damper_stays_below_the_bound_of_its_energy():
    state = {"omega": (0.1, 0.2, 1.0), "damper": (0.5, 0, 0)}
    found = motion(SCENE, state, span=(0, 200))
    # T = (w . D w)/2 + k w . s + k s . s/2 by hand
    assert found.invariants["energy"] == pytest.approx((0.03 + 0.08 + 1) / 2 + 0.1 * (0.05 + 0.125), rel=1e-15)
    assert found.fate.word == "bounded" and found.invariants["momentum"] == pytest.approx(
        np.linalg.norm([0.35, 0.4, 1]), rel=1e-15)
    assert max(abs(v) for pair in found.extremes for v in pair) <= found.invariants["rate_bound"]


def test_past_the_separatrix_the_bounds_say_about_which_side_it_ends():
    found = motion(SCENE, {"omega": (-1.0, 0.1, 0.1), "damper": (0, 0, 0)})
    assert "stays on its side and tends to rotation about axis 1" in found.because and "(-1.0" in found.because


def test_beside_a_torque_no_bound_is_claimed():
    scene = Scene(Body((3, 2, 1)), DAMPER, ConstantTorque((0, 0, 1)))
    assert motion(scene, {"omega": (0, 0, 1.0)}).fate.word == "undecided"


def test_a_damper_that_turns_is_no_equilibrium():
    assert motion(SCENE, {"omega": (1.0, 0, 0)}).fate.word == "equilibrium"
    assert motion(SCENE, {"omega": (1.0, 0, 0), "damper": (0.1, 0, 0)}).fate.word == "bounded"
