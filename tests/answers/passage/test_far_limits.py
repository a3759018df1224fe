"""Limits that a feeble torque reaches late: a time before which it cannot, little work that is lost on the
way, and how narrow the clock is."""
from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

import stabilab
from stabilab.answers import limit as enclosing
from stabilab.answers.limit import WORK, asked, enclosed
from stabilab.answers.never_reached import earliest
from tests.oracles.first_crossing import first_crossing

from .test_time_to import FAR, random_question

# A 6U CubeSat of 11 kg with three wheels, along principal axes: a cold-gas thruster of 350 uN is stuck.
CUBESAT = stabilab.Scene(stabilab.Body(("0.14", "0.12", "0.052")),
                         stabilab.Gyrostat(("-0.0093", "-0.006", "0.0149")),
                         stabilab.ConstantTorque(("4.4e-7", "3.4e-5", "2.2e-5")))
SLOW = [-5e-4, -4e-4, 9e-4]  # rad/s
# s, 50 rad/s: SciPy's tableau of DOP853 on Euler's equations, 7.5 million steps with 1e-13 (with 1e-12 the
# same)
REACHED = 146811.04


def test_a_spin_about_the_minor_axis_reaches_its_limit_exactly_when_energy_allows():
    scene = stabilab.Scene(stabilab.Body((12, 9, 5)), stabilab.ConstantTorque((0, 0, "0.5")))
    start = (Fraction(0), Fraction(0), Fraction(1))
    for question in ({"rate": 3}, {"component": (3, 3)}, {"energy": "22.5"}):
        found = earliest(scene, start, asked(scene, **question))
        assert 20 * (1 - 1e-15) < found <= 20  # D3 omega3' = M3: (3 - 1) 5/0.5, by hand


def test_no_random_motion_reaches_a_limit_before_its_energy_allows():
    rng, known, held = np.random.default_rng(5), 0, 0
    for _ in range(12):
        scene, state, question, limit = random_question(rng)
        found = float(earliest(scene, tuple(map(Fraction, state.tolist())), asked(scene, **question)))
        known += found > 0
        if found:
            true = first_crossing(scene.body.inertia, np.array(scene.vector("gyrostat"), float),
                                  np.array(scene.vector("constant_torque"), float), state,
                                  limit, FAR)  # in long doubles, no code shared
            assert true is None or found <= true, (question, found, true)
            held += true is not None
    assert known >= 6 and held >= 3


def test_no_work_is_spent_on_a_way_that_it_cannot_enclose(monkeypatch):
    flows, limit, start = [], asked(CUBESAT, rate=50), tuple(map(Fraction, SLOW))
    real = enclosing.flow_of

    def flow_of(*given):
        flows.append(real(*given))
        return flows[-1]
    monkeypatch.setattr(enclosing, "flow_of", flow_of)
    found = enclosed(CUBESAT, start, limit, earliest=earliest(CUBESAT, start, limit))
    assert not found.done and 0 < sum(flow.work for flow in flows) < WORK / 8


def test_a_limit_that_comes_after_thousands_of_turns_is_known_not_to_come_sooner():
    found = stabilab.time_to(CUBESAT, SLOW, rate=50, work=1, t_max=8e4)
    assert found.low == 8e4 and found.level == "proved" and np.isnan(found.high)


@pytest.mark.slow
def test_the_clock_of_a_far_limit_is_narrow_and_holds_brute_force():
    pytest.importorskip("heyoka")
    found = stabilab.time_to(CUBESAT, SLOW, rate=50)
    assert found.level == "certified" and found.high < found.low * 1.002
    assert found.low <= REACHED <= found.high
