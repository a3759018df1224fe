"""Equilibria and bounds of a free body with a damper: the major-axis rule, and eigenvalues of the equations
derived in symbols."""
from fractions import Fraction

import numpy as np
import pytest

from stabilab import Body, ConstantTorque, Gyrostat, Scene, ViscousDamper, derive, equilibria, motion
from stabilab.equilibrium.damper import damper_jacobian as jacobian
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


def test_beside_a_torque_equilibria_are_undecided():
    assert equilibria(Scene(Body((3, 2, 1)), DAMPER, ConstantTorque((0, 0, 1)))).kind == "undecided"


@pytest.mark.parametrize("wheel", [(0, 0, 1), (0.2, 0.3, 0.7), (1, 0, 0), (0, 0.5, 0.5)], ids=str)
@pytest.mark.parametrize("D", [(3, 2, 1), (1, 2, 2.5), (2, 2, 1), (1.5, 2, 2)], ids=str)
def test_beside_a_wheel_verdicts_are_those_of_the_eigenvalues(D, wheel):
    """By the equations in symbols: a rotation that is stable has all but the eigenvalue of |H| (and that along
    its circle) on the left, any other one on the right."""
    scene = Scene(Body(D), DAMPER, Gyrostat(wheel))
    found, system, seen = equilibria(scene), to_numpy(derive(scene)), set()
    assert found.kind == "curves"
    for curve in found.curves:
        for point in curve.samples:
            J = system.jacobian(np.array([*point.at, 0, 0, 0]))
            assert jacobian(content(scene), point.at) == pytest.approx(J, rel=1e-14, abs=1e-14)
            if point.linear == "degenerate":
                continue
            values = sorted(np.linalg.eigvals(J), key=abs)[2 if curve.plane else 1:]
            largest = max(value.real for value in values)
            if abs(largest) > 1e-9 * max(map(abs, values)):
                assert (largest < 0) == (point.verdict == "stable"), (curve.name, point.at, largest)
                seen.add(point.verdict)
    assert seen == {"stable", "unstable"}


def test_a_gyrostat_whose_wheels_cancel_its_momentum_is_stable():
    """H = 0 at (0, 0, -1): on one side the rotation has the least energy of its |H|, on the other the most."""
    found = equilibria(Scene(Body((3, 2, 1)), DAMPER, Gyrostat((0, 0, 1))))
    line = next(curve for curve in found.curves if "gyrostatic moment" in curve.name)
    assert {point.at: point.verdict for point in line.samples}[(0.0, 0.0, -1.0)] == "stable"
    verdicts = [(item.t, item.verdict) for item in line.segments]
    assert [word for _, word in verdicts] == ["unstable", "stable", "unstable", "unstable"], verdicts


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


def test_a_state_without_the_damper_s_rates_has_the_sphere_at_rest_in_the_body():
    from stabilab.answers.chaos import row_of
    assert row_of(SCENE, (1, 2, 3), {}) == [1, 2, 3, 0, 0, 0]
    assert motion(SCENE, (1.0, 0.1, 0.1)).at == motion(SCENE, (1.0, 0.1, 0.1, 0.0, 0.0, 0.0)).at


def test_the_momentum_in_space_of_body_and_sphere_stays():
    from stabilab import simulate
    run = simulate(SCENE, (0.3, 0.2, 1.0), [0, 7, 40], {"damper": (0.5, 0, -0.2)}, attitude="quaternion")
    H = run.state["momentum"]
    assert H[0] == pytest.approx([0.9 + 0.05, 0.4, 1 - 0.02], rel=1e-15)
    assert H == pytest.approx(np.array([H[0]] * 3), abs=1e-13)  # some hundred steps of rounding


def test_vectors_of_a_tensor_in_another_frame_end_in_the_frame_of_the_file():
    """Axes 1 and 2 swapped by a tensor whose diagonal stands in another order and one product."""
    from stabilab import flat_spin, load
    text = ("[body]\ninertia = [[2, 0.5, 0], [0.5, 2, 0], [0, 0, 1]]\n[effects.viscous_damper]\ninertia = 0.1\n"
            "coefficient = 0.3\n[motion]\nangular_velocity = [1, 1, 0.1]\ndamper = [0.2, 0.2, 0]\n")
    case = load(text)  # moments 2.5 along (1, 1, 0), 1.5 along (1, -1, 0), 1: by hand
    assert sorted(case.scene.body.inertia) == pytest.approx([1, 1.5, 2.5])
    found = flat_spin(case)
    along = case.frame.back(tuple(map(Fraction, found.rates)))
    expected = np.hypot(2.5 * np.sqrt(2) + 0.1 * 0.2 * np.sqrt(2), 0.1) / 2.5 / np.sqrt(2)
    assert [float(v) for v in along] == pytest.approx([expected, expected, 0], abs=1e-12)
