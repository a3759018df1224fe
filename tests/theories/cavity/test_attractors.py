"""Tests of `theories/cavity_normal_form.py`: what once went wrong there, and its edges."""
from __future__ import annotations

import pytest

from stabilab import Body, ConstantTorque, Gyrostat, Scene
from stabilab.physics.effects.charge import Charge
from stabilab.physics.effects.resistance import Resistance
from stabilab.theories.cavity_normal_form import attractors
from tests.shared import LIQUID, ROUND


@pytest.mark.parametrize("rates, kind", [((-1, -2), "attracting"), ((1, 2), "repelling"), ((-1, 2), "saddle"),
                                         ((0, -1), "neutral"),
                                         ((0, 1), "repelling"), ((1j, -1j), "neutral")])
def test_averaged_steady_states_are_named_by_their_rates(rates, kind):
    from stabilab.theories.cavity_normal_form import _kind
    assert _kind(tuple(map(complex, rates))) == kind


def test_cross_torques_average_out_of_the_steady_states_and_the_reason_says_so():
    from stabilab.theories.cavity_normal_form import attractors
    body, drag = Body(("9.5", "9.5", "9")), Resistance("0.1")
    alone, crossed = (attractors(Scene(body, drag, ConstantTorque((m, 0, 1)))) for m in (0, "0.01"))
    assert [p.spin for p in alone.points] == [p.spin for p in crossed.points]
    assert "M1, M2 average out" in crossed.because and "M1, M2" not in alone.because


@pytest.mark.one_in(2)
@pytest.mark.parametrize("effects, words", [
    ((Gyrostat((0, 0, "0.1")),), "every amplitude and spin"),
    ((Charge("0.1", 2, 1, 0),), "every amplitude and spin"),
    # nu = (d r - Gamma)/J0 = 0 at r = 0.1/0.5
    ((LIQUID, Gyrostat((0, 0, "0.1"))), "r = 0.2 rad/s"), ((LIQUID,), "r = 0 rad/s ")])
def test_families_of_averaged_steady_states_stand_where_the_turn_does(effects, words):
    found = attractors(Scene(ROUND, *effects))
    assert not found.points and any(words in str(family) for family in found.families)


@pytest.mark.parametrize("effects", [(LIQUID,), (Charge("0.1", 2, 1, 0),)])
def test_a_torque_about_axis_3_without_resistance_leaves_no_averaged_steady_state(effects):
    found = attractors(Scene(ROUND, *effects, ConstantTorque((0, 0, "0.1"))))  # r' = M3/J0 + ... never ends
    assert not found.points and not found.families and "no resistance" in found.because
    (point,) = attractors(Scene(ROUND, Resistance("0.1"), ConstantTorque((0, 0, 1)))).points
    assert point.spin == pytest.approx(1 / (9 * 0.1)) and point.kind == "attracting"  # M3 = c D3 r
