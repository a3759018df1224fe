"""Free motions on invariant planes in closed form, steady states of averaged equations by hand, and effects that are not known."""
import numpy as np
import pytest

import stabilab
from stabilab import Body, ConstantTorque, Fate, Gyrostat, ScaledGyrostat, Scene
from stabilab.integrate import extrema as rate_roots
from stabilab.theories.cavity.attractors import attractors
from stabilab.theories.charged.modes import ChargedBody
from stabilab.theories.charged.printed import printed
from stabilab.integrate.ensemble import ensemble
from stabilab.answers.equilibria import equilibria
from stabilab.answers.motion import motion
from stabilab.unreduced.free_gyrostat import extremes_over_period
from stabilab.answers.trajectory import trajectory
from stabilab.physics.effects.charge import Charge
from stabilab.physics.effects.liquid_cavity import LiquidCavity
from stabilab.physics.effects.resistance import Resistance
from stabilab.errors import InputError

# D = (9, 5, 4), lambda = (4, 0, 1), no torque: the planes omega1 + 1 = k s/3, omega3 - 1 = s, k = +-1, keep k: s' = k omega2 s/3.
# 5 omega2^2 = 2 T - 9 omega1^2 - 4 omega3^2 = 2 T - 13 - (8 - 6 k) s - 5 s^2, and s = 0 is the permanent rotation that they end in.
PLANES = Scene(Body((9, 5, 4)), Gyrostat((4, 0, 1)))


def on_plane(k, s, w):
    """[(least, greatest)] over t >= 0 by the two conservation laws: out to a turning point where k omega2 s > 0, then in to s = 0."""
    b, sense = 8 - 6 * k, k
    level = 5 * w * w + b * s + 5 * s * s
    outward = sense * w > 0
    far = (-b + np.sign(s) * (b * b + 20 * level) ** 0.5) / 10 if outward else s

    def rates(one, other):
        """Least and greatest |omega2| with s between; 5 omega2^2 = level - b s - 5 s^2 is greatest at s = -b/10."""
        inside = [-b / 10] * (min(one, other) < -b / 10 < max(one, other))
        sizes = [max(0.0, (level - b * t - 5 * t * t) / 5) ** 0.5 for t in (one, other, *inside)]
        return min(sizes), max(sizes)
    least, most = rates(far, 0.0)
    found = [-sense * most, -sense * least]
    if outward:
        found += [0.0, sense * rates(s, far)[1]]
    return [sorted((-1 + k * far / 3, -1.0)), [min(found), max(found)], sorted((1 + far, 1.0))]


@pytest.mark.parametrize("k", [1, -1])
@pytest.mark.parametrize("s", [3.0, -3.0])
@pytest.mark.parametrize("w", [-3.0, -1.0, -0.25, 0.25, 1.0, 3.0])
def test_on_a_plane_without_torque_the_motion_tends_to_a_permanent_rotation(k, s, w):
    state = (-1 + k * s / 3, w, 1 + s)
    found = motion(PLANES, state)
    assert found.fate in (Fate.SEPARATRIX, Fate.BOUNDED) and found.fate == stabilab.fate(PLANES, np.array(state)).labels
    if found.fate == Fate.SEPARATRIX:
        np.testing.assert_allclose(found.extremes, on_plane(k, s, w), rtol=1e-11, atol=1e-11)
        np.testing.assert_allclose(stabilab.extremes(PLANES, np.array(state)), found.extremes, rtol=1e-12, atol=1e-12)


def test_on_a_plane_below_its_end_the_motion_is_bounded():
    # k = -1: 5 omega2^2 = level - 14 s - 5 s^2 with level = 5/4 - 21 + 45/4 < 0 at (s, omega2) = (-3/2, 1/2): s = 0 is out of reach
    found = motion(PLANES, (-0.5, 0.5, -0.5))
    roots = sorted(np.roots([5, 14, 8.5]))
    assert found.fate == Fate.BOUNDED and found.period is not None
    np.testing.assert_allclose(found.extremes[2], [1 + r for r in roots], rtol=1e-12)
    np.testing.assert_allclose(found.extremes[0], sorted(-1 - r / 3 for r in roots), rtol=1e-12)


# -- averaged equations

ROUND, LIQUID = Body(("9.5", "9.5", "9")), LiquidCavity(1250, 1000, "1.9")


@pytest.mark.parametrize("effects, words", [
    ((Gyrostat((0, 0, "0.1")),), "every amplitude and spin"), ((Charge("0.1", 2, 1, 0),), "every amplitude and spin"),
    ((LIQUID, Gyrostat((0, 0, "0.1"))), "r = 0.2"), ((LIQUID,), "r = 0 ")])  # nu = (d r - Gamma)/J0 = 0 at r = 0.1/0.5
def test_families_of_averaged_steady_states_stand_where_the_turn_does(effects, words):
    found = attractors(Scene(ROUND, *effects))
    assert not found.points and any(words in family for family in found.families)


@pytest.mark.parametrize("effects", [(LIQUID,), (Charge("0.1", 2, 1, 0),)])
def test_a_torque_about_axis_3_without_resistance_leaves_no_averaged_steady_state(effects):
    found = attractors(Scene(ROUND, *effects, ConstantTorque((0, 0, "0.1"))))  # r' = M3/J0 + ... never ends
    assert not found.points and not found.families and "no resistance" in found.reason
    (point,) = attractors(Scene(ROUND, Resistance("0.1"), ConstantTorque((0, 0, 1)))).points
    assert point.spin == pytest.approx(1 / (9 * 0.1)) and point.kind == "attracting"  # M3 = c D3 r


# -- homoclinic: D = (4, 4, 2), lambda = (0, 1, 0), M1 = -50; the saddle (0, -10.5, -2.5) and a state on its loop, both rational


@pytest.mark.parametrize("w", [1.0, -1.0])
def test_on_a_loop_of_a_parabola_the_rate_about_the_torque_keeps_the_sense_of_each_leg(w):
    """With a the angle from the saddle omega3 = v - a/2, omega2 = u - v a/2 + a^2/8 (l2 = 1) and omega1^2 = 2 (cubic's integral)."""
    scene, (u, v) = Scene(Body((4, 4, 2)), Gyrostat((0, 1, 0)), ConstantTorque((-50, 0, 0))), (-10.5, -2.5)
    rate = np.polynomial.Polynomial([-50 / 4]) + np.polynomial.Polynomial([v, -0.5]) * (2 * np.polynomial.Polynomial([u, -v / 2, 1 / 8]) + 1) / 4
    square = 2 * rate.integ()
    start = 2 * (v + 3.5)
    assert square(start) == pytest.approx(1.0) and square.deriv()(0) == 0
    far = min((r.real for r in square.roots() if abs(r.imag) < 1e-9 and r.real * start > 1e-6), key=abs)
    tops = [t.real for t in rate.roots() if min(0, far) < t.real < max(0, far) and abs(t.imag) < 1e-9]
    outward = w * far > 0
    def span(one, other):
        return max(square(t) for t in (one, other, *(t for t in tops if min(one, other) < t < max(one, other)))) ** 0.5
    back = span(0.0, far) if outward else span(0.0, start)
    wanted = sorted((-np.sign(far) * back, np.sign(far) * span(start, far) if outward else 0.0))
    found = motion(scene, (w, -7.5, -3.5))
    assert found.fate == Fate.SEPARATRIX
    np.testing.assert_allclose(found.extremes[0], wanted, rtol=1e-10, atol=1e-12)
    ends = sorted((v, v - far / 2 if outward else -3.5))
    np.testing.assert_allclose(found.extremes[2], ends, rtol=1e-10)


# -- the rest


@pytest.mark.parametrize("change, words", [({"mass": None}, "mass"), ({"inertia": (11.1, 8.7, 9.0)}, "exceed")])
def test_typed_formulas_are_refused_where_they_have_no_meaning(change, words):
    data = {"inertia": (8.7, 8.9, 11.1), "spin": 1.5, "gyrostat": 1.3, "charge_moment": 0.29, "torque": (0.4, -0.2), "rates": (0.1, 0.2),
            "attitude": (0.02, 0.01, 0.3), "force": (1.0, 2.0, 3.0), "mass": 10.0} | change
    with pytest.raises(InputError, match=words):
        printed(ChargedBody(**data), np.linspace(0, 1, 5))


def test_roots_of_rates_without_a_run_or_a_compiler_are_those_of_the_start(monkeypatch):
    scene, state = ScaledGyrostat("0.2", "0.4", (0, 0, 1)), np.array([2.5, 4.0, 0.1])
    fast = rate_roots.roots_of_rates(scene, state, 3.0)
    monkeypatch.setattr(rate_roots, "heyoka_available", lambda: False)
    slow, none = rate_roots.roots_of_rates(scene, state, 3.0), rate_roots.roots_of_rates(scene, state, 0.0)
    assert fast.method == "taylor" and slow.method == "DOP853" and not len(none.t) and none.end.tolist() == state.tolist()
    np.testing.assert_allclose(slow.t, fast.t, rtol=1e-8)
    np.testing.assert_allclose(slow.end, fast.end, rtol=1e-8)


def test_motions_of_very_different_pace_are_followed_each_in_its_own_unit():
    scene, times = Scene(Body((3, 2, 1))), np.array([0.0, 1e-150, 2e-150])
    states = np.array([[1.0, 0.5, 0.25], [1e150, 5e149, 2.5e149]])
    found = ensemble(scene, states, times)
    # Euler's equations are homogeneous: omega(t) -> s omega(s t)
    exact = trajectory(scene, states[0], [0.0, 1.0, 2.0]).states
    np.testing.assert_allclose(found.states[1] / 1e150, exact, rtol=1e-12)
    np.testing.assert_allclose(found.states[0], np.tile(states[0], (3, 1)), rtol=1e-15)
    alone = trajectory(scene, states[1], times)
    np.testing.assert_allclose(alone.states, found.states[1], rtol=1e-12)


@pytest.mark.parametrize("state", [(1.0, 2.0), (1.0, 2.0, 3.0, 4.0)])
def test_a_free_motion_needs_three_numbers(state):
    with pytest.raises(InputError, match="three numbers"):
        extremes_over_period(Scene(Body((3, 2, 1)), Gyrostat((1, 2, 3))), state)


def test_a_point_beyond_the_end_of_a_branch_is_refused():
    from stabilab.physics.effects.gravity import Gravity
    curves = equilibria(Scene(Body((4, 3, 2), 1), Gravity(9.81, (0, 0, "0.5")))).curves
    ended = [c for c in curves if np.isfinite([c.segments[0].t[0], c.segments[-1].t[1]]).any()]
    assert ended
    for curve in ended:
        for end, side in ((curve.segments[0].t[0], -1), (curve.segments[-1].t[1], 1)):
            if np.isfinite(end):
                with pytest.raises(InputError, match="outside"):
                    curve.point(end + side * (1 + abs(end)))
