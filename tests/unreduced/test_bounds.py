"""Bounds of motions with a medium, a liquid or a field, in the corners of what is proved; and numbers that
are refused."""
import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stabilab
from stabilab import Body, ConstantTorque, Fate, Gyrostat, Scene
from stabilab.answers.equilibria import equilibria
from stabilab.answers.motion import motion
from stabilab.errors import InputError
from stabilab.physics.effects.charge import Charge
from stabilab.physics.effects.liquid_cavity import LiquidCavity
from stabilab.physics.effects.resistance import Resistance
from tests.oracles.rigid import euler

LIQUID = LiquidCavity(1250, 1000, "0.1")  # kappa = 1/8
SWINGING = Charge("0.3", 2, 1, "attitude")  # its angle follows the attitude: gamma is part of the state
BODY = Body((9, 8, 5))
ROW = (0.5, 0.25, 1.0)


@pytest.mark.parametrize("state", [(1.0, 2.0), (1.0, 2.0, 3.0, 4.0), (1.0, 2.0, 3.0, 0.0, 0.0, 1.0, 2.0)])
def test_a_state_of_another_length_is_refused(state):
    for effects in ((Resistance("0.1"),), (SWINGING,)):
        with pytest.raises(InputError, match="state"):
            motion(Scene(BODY, *effects), state)


def test_a_liquid_under_a_torque_in_a_medium_is_bounded_as_its_run_is():
    scene = Scene(BODY, Resistance("0.5"), LIQUID, ConstantTorque((1, "0.5", -1)))
    found = motion(scene, ROW)
    assert found.fate == Fate.BOUNDED and "where it tends is undecided" in found.because
    # the bound without the liquid, which only takes energy: |omega| <= max(sqrt(2 T0), sqrt(M . D^-1
    # M)/c)/sqrt(D3)
    assert found.invariants["rate_bound"] >= max(np.linalg.norm(ROW),
                                                 (1 / 9 + 0.25 / 8 + 1 / 5) ** 0.5 / 0.5 / 5**0.5)


def test_liquid_in_a_body_with_two_equal_largest_moments_carries_it_to_some_axis_of_their_plane():
    found = motion(Scene(Body((9, 9, 5)), LIQUID), ROW)
    size = np.linalg.norm(np.array((9, 9, 5)) * ROW)
    assert found.fate == Fate.BOUNDED and "permanent rotations" in found.because
    assert found.invariants["momentum"] == pytest.approx(size) and found.invariants[
        "rate_bound"] == pytest.approx(size / 5)


def test_liquid_in_a_field_is_left_undecided():
    found = motion(Scene(BODY, LIQUID, SWINGING), (*ROW, 0.0, 0.0, 1.0))
    assert found.fate == Fate.UNDECIDED and "liquid" in found.because


def test_a_decay_too_fast_for_the_span_is_said_so():
    found = motion(Scene(BODY, Resistance(1000)), ROW, (0, 1e6))  # exp(-1e9)
    assert found.fate == Fate.BOUNDED and "too fast" in found.extremes_over
    near = motion(Scene(BODY, Resistance("0.5")), ROW, (0, 2))
    run = solve_ivp(euler((9, 8, 5), damping=(4.5, 4, 2.5)), (0, 2), ROW,
                    rtol=1e-11, atol=1e-12, max_step=1e-3)
    np.testing.assert_allclose(near.extremes, np.stack([run.y.min(axis=1), run.y.max(axis=1)], axis=1),
                               atol=1e-6)


@pytest.mark.parametrize("wheel", [(0, 0, 0), (1, 2, 3)])
def test_without_a_torque_rest_is_the_one_equilibrium_that_is_proved_with_a_liquid_in_a_medium(wheel):
    effects = (LIQUID, Resistance("0.5")) + ((Gyrostat(wheel),) if any(wheel) else ())
    found = equilibria(Scene(BODY, *effects))
    (rest,) = found.points
    assert rest.at == (0.0, 0.0, 0.0) and rest.verdict == "asymptotically stable"


@pytest.mark.parametrize("size", [1e200, 1e-200, 1e307, 0.25])
@pytest.mark.parametrize("effect, blocks", [
    (stabilab.RateDamper("1e-3"), {}), (stabilab.RateDamper((0, 0, "1e-3")), {}), (stabilab.Resistance("1e-3"), {}),
    (stabilab.ViscousDamper("1e-3", 1), {}), (stabilab.EddyCurrents(1, 1), {"gamma": (0, 0, 1)})],
    ids=lambda one: getattr(one, "name", ""))
def test_a_bound_of_the_rates_needs_no_square_that_is_a_double(size, effect, blocks):
    """The energy does not grow, and at it |omega| is largest about the axis of the least moment, 1 kg m^2: at
    most sqrt(3 + 2 + 1) times the rate about each axis at the start; of a damper, which is at rest, some
    1/1000 more."""
    scene = stabilab.Scene(stabilab.Body((3, 2, 1)), effect)
    if effect.name == "viscous_damper" and size > 1:
        size = 1e150  # of larger ones it says that its squares are no doubles
    bound = stabilab.motion(scene, {"omega": (size,) * 3, **blocks}).invariants["rate_bound"]
    assert bound / size == pytest.approx(6**0.5, rel=1e-3)


@pytest.mark.one_in(2)
@pytest.mark.parametrize("C, wheel, tends", [
    (((1, -1, 0), (-1, 1, 0), (0, 0, 1)), (0, 0, 0), ()), (((1, -1, 0), (-1, 1, 0), (0, 0, 1)), (0, 0, 2), ()),
    ((0, 1, 2), (0, 0, 0), None), ((0, 1, 2), (0.25, 0, 0), None), ((0, 1, 2), (0, 0.25, 0), ()),
    (((1, -1, 0), (-1, 1, 0), (0, 0, 1)), (0.5, 0, 0), (-0.5, -0.5, 0))])
def test_where_a_damper_that_leaves_one_axis_free_brings_a_body(C, wheel, tends):
    """Euler's equations by SciPy's Radau: at a late time the body rests, or turns about the free axis, at any rate
    (None) or at the one at which it goes on. D = (3, 2, 1): about (1, 1, 0) D omega x omega = (0, 0, s^2), and a
    wheel (1/2, 0, 0) turned with it (0, 0, s/2)."""
    D, L = np.array([3.0, 2, 1]), np.array(wheel)
    K = np.diag(C) if np.ndim(C) == 1 else np.array(C)
    scene = Scene(Body((3, 2, 1)), stabilab.RateDamper(C), *([Gyrostat(wheel)] if any(wheel) else []))
    found = motion(scene, (0.3, 0.5, -0.4))
    ends = solve_ivp(lambda t, w: (np.cross(D * w + L, w) - K @ w) / D, (0, 1e6), (0.3, 0.5, -0.4), method="Radau",
                     rtol=1e-9, atol=1e-14).y[:, -1]
    free = np.array([1, 1, 0]) / 2**0.5 if np.ndim(C) > 1 else np.eye(3)[0]
    assert found.fate == Fate.BOUNDED and np.linalg.norm(ends - free * (free @ ends)) < 0.01
    if tends == ():
        assert np.linalg.norm(ends) < 0.01 and found.invariants["late_rate_bound"] == 0
        (rest,) = equilibria(scene).points
        assert rest.verdict == "asymptotically stable" and max(z.real for z in rest.eigenvalues) <= 1e-15
    else:
        assert "late_rate_bound" not in found.invariants and "goes on" in found.because
        if tends:
            assert "(-0.5, -0.5, 0)" in found.because
            assert min(np.linalg.norm(ends), np.linalg.norm(ends - tends)) < 0.01


def test_a_free_axis_that_only_irrational_axes_part_from_a_principal_one_is_left_open():
    """(1, 1, 0) is a principal axis of this tensor, at sqrt(1/2) of both axes of the file: the rotation goes on."""
    body = Body([[2, 1, 0], [1, 2, 0], [0, 0, "2.5"]])
    scene = Scene(body, stabilab.RateDamper(((1, -1, 0), (-1, 1, 0), (0, 0, 1))))
    found = motion(scene, (0.3, 0.5, -0.4))
    assert "late_rate_bound" not in found.invariants


def test_a_search_for_extremes_ends_after_a_million_steps_and_says_over_which_time(monkeypatch):
    """A constant torque spins a heavy body up without end."""
    monkeypatch.setattr("stabilab.integrate.events.STEP_LIMIT", 100)
    scene = Scene(Body((3, 2, 2)), stabilab.Gravity(1, (0, 0, "0.1")), ConstantTorque((0, 0, 5)))
    found = motion(scene, {"omega": (0.1, 0.2, 0.3), "gamma": (0, 0, 1)}, (0.0, 1e3))
    assert 0 < found.evidence["span"] < 1e3 and found.extremes_over == f"s in [0, {found.evidence['span']:g}]"
