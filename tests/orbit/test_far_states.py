"""Tests of `orbit/one_state.py`: what once went wrong there, and its edges."""
from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

import stabilab
from stabilab import Body, ConstantTorque, Gyrostat, Scene
from stabilab.answers.motion import motion
from stabilab.errors import InputError
from stabilab.orbit.flow import reduced_motion
from stabilab.orbit.one_state import far_rows
from stabilab.orbit.phase_plane import phase_plane
from stabilab.physics.own_unit import far_exponent

RATES = (0.1, 0.05, 0.2)
BODIES = {"circle": (Body((12, 9, 5)), (1, 0, 0), (0, 0, 1)),
          "parabola": (Body((2, 2, 1)), (0, 1, 2), (1, 0, 0)),
          "hyperbola": (Body((12, 9, 5)), (1, 0, 0), (0, 1, 0)),
          "free": (Body((12, 9, 5)), (1, 0, 0), (0, 0, 0))}


def in_units(name, power):
    """(scene, state) in the ordinary unit of rate and in 2^power of it (wheel by u, torque by u^2)."""
    body, wheel, torque = BODIES[name]
    for u in (Fraction(1), Fraction(2) ** power):
        yield (Scene(body, Gyrostat(tuple(Fraction(w, 5) * u for w in wheel)),
                     ConstantTorque(tuple(Fraction(m, 50) * u * u for m in torque))),
               tuple(w * float(u) for w in RATES))


@pytest.mark.one_in(4)
@pytest.mark.parametrize("k", [-900, -300, 200, 300, 900])
@pytest.mark.parametrize("name", BODIES)
def test_a_motion_in_another_unit_of_rate_is_the_same_motion(name, k):
    """Euler's equations are homogeneous (rates and wheel by u, torque by u^2, time by 1/u), and for u = 2^k
    the change is exact."""
    # the torque, which goes with the square, must stay a double
    power = k if abs(k) < 500 else k // 2
    made, u = list(in_units(name, power)), 2.0**power
    one, far = (motion(scene, state) for scene, state in made)
    (scene, state), many = made[1], stabilab.fate(*made[1])
    assert (far.fate, far.axis, far.sense) == (one.fate, one.axis, one.sense)
    np.testing.assert_allclose(np.array(far.extremes) / u, one.extremes, rtol=1e-11)
    assert (one.period is None) == (far.period is None)
    assert (one.period is None or far.period * u == pytest.approx(one.period, rel=1e-11))
    assert int(many.labels) == far.fate
    np.testing.assert_allclose(stabilab.extremes(scene, state), far.extremes, rtol=1e-11)
    if one.margin_energy is None:
        assert far.margin_energy is None
    elif abs(power) < 400:  # energies go with u^2
        assert far.margin_energy / u**2 == pytest.approx(one.margin_energy, rel=1e-11) == many.margins / u**2


@pytest.mark.parametrize("rate", [1e155, 1e308,
                                  *(pytest.param(rate, marks=pytest.mark.slow) for rate in (1e160, 1e200))])
def test_rates_up_to_the_largest_doubles_have_a_fate_and_no_margin_that_is_no_double(rate):
    """Torque-free in effect: the wheelless body turns about axis 1 under a torque on axis 3, bounded by its
    centrifugal barrier (D1 - D3)(D1 - D2) w1^2/... far above the torque; the period is 2 pi over w1 sqrt((D1
    - D2)(D1 - D3)/(D2 D3)) (Euler)."""
    scene = Scene(Body((12, 9, 5)), ConstantTorque((0, 0, "0.02")))
    found, rows = motion(scene,
                         (rate, 0.0, 0.0)), stabilab.fate(scene, np.array([(rate, 0, 0), (0.1, 0.05, 0.02)]))
    assert found.fate == rows.labels[0] == stabilab.Fate.BOUNDED and found.margin_energy is None
    assert np.isnan(rows.margins[
        0]) and "beyond the range of doubles" in found.because and "beyond the range" in rows.because[0]
    # of one start in balls, of rows in doubles
    assert rows.margins[1] == pytest.approx(float(stabilab.fate(scene, (0.1, 0.05, 0.02)).margins), rel=1e-12)
    assert found.period == pytest.approx(2 * np.pi / rate / np.sqrt(3 * 7 / (9 * 5)), rel=1e-11)
    assert stabilab.period(scene, (rate, 0, 0)) == pytest.approx(found.period, rel=1e-12)
    # D2 w2' = (D3 - D1) w3 w1, D3 w3' = M + (D1 - D2) w1 w2: 2 M/((D2 - D1) w1)
    least = stabilab.extremes(scene, (rate, 0, 0))[1, 0]
    assert least == pytest.approx(2 * 0.02 / -3 / rate, rel=1e-11) or rate > 1e300


@pytest.mark.one_in(6)
@pytest.mark.parametrize("effects", [(Gyrostat((1, 2, 3)),), (ConstantTorque((1, 1, 0)),),
                                     (Gyrostat((1, 0, 0)), ConstantTorque((1, 0, 0)))])
@pytest.mark.parametrize("power", [-300, -160, 160, 200])
def test_scenes_without_a_reduction_answer_or_refuse_any_rate(effects, power):
    """No warning (pytest makes them errors), no overflow: a fate, or InputError in words."""
    scene, state = Scene(Body((12, 9, 5)), *effects), np.array([1.0, 0.5, -0.7]) * 10.0**power
    for ask in (stabilab.fate, lambda scene, state: motion(scene, tuple(state))):
        try:
            ask(scene, state)
        except InputError as error:
            assert "range of doubles" in str(error) or "largest double" in str(error)


ORDERS, TORQUES = ((0, 1, 2), (2, 0, 1), (1, 2, 0)), ((1.0, 1.0), (1e-5, 1e8), (0.0, 1e300))


@pytest.mark.one_in(6)
@pytest.mark.parametrize("order, beside, torque",
                         # each of both comes up
                         [pytest.param(order, *pair, marks=() if m == n else pytest.mark.slow)
                                                   for m, order in enumerate(ORDERS) for n,
                          pair in enumerate(TORQUES)])
def test_rows_of_a_wheel_as_large_as_doubles_go_round_it(beside, torque, order):
    """Theory: but for terms of 1e-290 it acts alone beside the torque, D1 w1' = L w3, D3 w3' = M - L w1, w2
    constant, L = 1e300."""
    scene = Scene(Body(tuple((3, 2, 1)[i] for i in order)),
                  Gyrostat(tuple((beside, 1e300, 0)[i] for i in order)),
                  ConstantTorque(tuple((0, 0, torque)[i] for i in order)))
    states = np.array([(1.0, 2, 3), (1, 1, 1), (0, 0.5, 0)])
    many = stabilab.fate(scene, states[:, order])
    centre = states[:, 0] - torque / 1e300
    first, third = np.sqrt(centre**2 + states[:, 2] ** 2 / 3), np.sqrt(3 * centre**2 + states[:, 2] ** 2)
    boxes = np.stack([torque / 1e300 + first * [[-1], [1]], states[:, 1] * [[1], [1]],
                      third * [[-1], [1]]]).transpose(2, 0, 1)
    assert (many.labels == stabilab.Fate.BOUNDED).all()
    np.testing.assert_allclose(stabilab.extremes(scene, states[:, order]), boxes[:, order], rtol=1e-11,
                               atol=1e-280)
    np.testing.assert_allclose(stabilab.period(scene, states[:, order]), 2 * np.pi * np.sqrt(3) / 1e300,
                               rtol=1e-11)


@pytest.mark.one_in(2)
@pytest.mark.parametrize("wheel", [1e-263, -1e-290])
@pytest.mark.parametrize("torque", [1e-13, 1.0, 1e20])
def test_a_wheel_hundreds_of_decades_below_the_torque_changes_no_row(wheel, torque):
    """Oracle: the scene without the wheel."""
    states = np.array([(1.0, 0.3, 2), (1e-3, 4, -1), (2, 0.1, 0.1)])
    one, other = (Scene(Body((1.7, 1.6, 1.4)), Gyrostat((0, w, 0)), ConstantTorque((torque, 0, 0)))
                  for w in (wheel, 0))
    for name in ("labels", "margins", "axis", "sense", "reasons"):
        np.testing.assert_allclose(getattr(stabilab.fate(one, states), name),
                                   getattr(stabilab.fate(other, states), name), rtol=1e-12)
    np.testing.assert_allclose(stabilab.extremes(one, states), stabilab.extremes(other, states), rtol=1e-11)
    with pytest.raises(InputError, match="separatrix: .* beyond the range of doubles"):
        stabilab.separatrix(one)
    with pytest.raises(InputError, match="phase plane: .* beyond the range of doubles"):
        phase_plane(one, states[0])


@pytest.mark.parametrize("k", [-480, -150, 150, 400])
@pytest.mark.parametrize("name", BODIES)
def test_the_state_at_any_time_of_a_far_motion_is_that_of_the_motion_in_its_own_unit(name, k):
    """Euler's equations are homogeneous, and u = 2^k rounds nothing; the motion in the ordinary unit is held
    against series elsewhere."""
    times, u = np.array([0.0, 0.3, 2.0, 17.0]), 2.0**k
    one, far = (reduced_motion(scene, state) for scene, state in in_units(name, k))
    np.testing.assert_allclose(far.states(times / u) / u, one.states(times), rtol=1e-9, atol=1e-11)
    np.testing.assert_allclose(np.array(far.at(2.0 / u)) / u, one.at(2.0), rtol=1e-9, atol=1e-11)
    assert far.period * u == pytest.approx(one.period, rel=1e-11)


def test_a_swing_below_the_doubles_about_a_rotation_of_1e200_has_its_period_and_no_warning():
    """The swing is 2 M/((D1 - D2) w1), some 1e-500 rad/s, and no double; the period is Euler's of small
    swings, as above."""
    found = reduced_motion(Scene(Body((12, 9, 5)), ConstantTorque((0, 0, 1e-300))), (1e200, 0.0, 0.0))
    assert found.period == pytest.approx(2 * np.pi / 1e200 / np.sqrt(3 * 7 / (9 * 5)), rel=1e-11)
    assert found.states(np.array([0.0, 0.3])).tolist() == [[1e200, 0.0, 0.0]] * 2


def test_a_swing_of_few_digits_and_a_time_beyond_counting_are_refused_in_words():
    scene = Scene(Body((12, 9, 5)), ConstantTorque((0, 0, 0.02)))
    with pytest.raises(InputError, match="more digits than doubles have"):
        reduced_motion(scene, (1e160, 0.0, 0.0))
    with pytest.raises(InputError, match="further than doubles can count"):
        reduced_motion(scene, (1e160, 1e160, 0.0)).at(1e200)


@pytest.mark.one_in(2)
@pytest.mark.parametrize("torque, rate",
                         [("0.02", 1e160), pytest.param("1e-300", 1e200, marks=pytest.mark.slow)])
@pytest.mark.parametrize("command", [["simulate", "--at", "0,1"], ["when", "--rate", "1e201"],
                                     ["when", "--energy", "1e300"]], ids=" ".join)
def test_a_command_answers_or_says_what_it_does_not_reach_beyond_the_squares_of_doubles(
    stabilab, tmp_path, command, torque, rate):
    """The greatest rate is the first: torque 1e-300 changes nothing that a double tells."""
    (tmp_path / "far.toml").write_text(f"[body]\ninertia = [12, 9, 5]\n[effects.constant_torque]\ntorque = "
                                       f"[0, 0, {torque}]\n"
                                       f"[motion]\nangular_velocity = [{rate}, 0, 0]\n")
    code, out, said = stabilab(command[0], tmp_path / "far.toml", *command[1:])
    assert "fault of the program" not in said and code == (5 if command[0] == "simulate" and rate == 1e160
                                                           else 0), said
    assert {"simulate": "followed to 1 s", "1e201": "NEVER",
            "1e300": "starts at or beyond"}[command[0] if command[0] == "simulate" else command[2]] in out
    assert not any("-" in row.split()[1][1:] for row in out.splitlines()[2:4]
                   if command[0] == "simulate"), "two columns are one"


@pytest.mark.parametrize("scene", [Scene(Body((3, 2, 1)), Gyrostat((0, 0.5, 0)), ConstantTorque((1, 0, 0))),
                                   Scene(Body((3, 2, 1))),
                                   Scene(Body((3, 2, 1)), ConstantTorque((2.0**-300, 0, 0)))])
def test_rows_have_a_unit_of_their_own_where_single_states_have(scene):
    """Also where no row is large, which is told without a row's own size. At the edge itself the two count
    exponents from 1/2 and from 1."""
    rows = [(0.0, 0.0, 0.0), (1.0, -2.0, 0.5), (2.0**98, 0, 0), (-(2.0**102), 1, 1), (0, 2.0**-103, 0),
            (0, 0, -(2.0**102)), (2.0**-300, 0, 0)]
    for some in (rows, rows[:3], rows[1:2], rows[:2], rows[3:4], rows[:0]):
        assert far_rows(scene,
                        np.array(some).reshape(-1, 3)).tolist() == [far_exponent(scene, state) is not None
                                                                    for state in some]
