"""Reasons of dissipation, uncertain numbers, stuck thrusters, burns, attitude and bifurcation diagrams carry
their quantities, which JSON has beside the words."""
from __future__ import annotations

import json
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from stabilab import attitude, burn, flat_spin, load, motion, stuck
from stabilab.answers.dissipation import flat_spin as flat_spins
from stabilab.answers.dissipation.flat_spin import UNDECIDED
from stabilab.answers.uncertain import search
from stabilab.reasons import Axis
from tests.oracles.rigid import damped

SPINNER = """[body]
inertia = [{inertia}]
[effects.viscous_damper]
inertia = 0.5
coefficient = {coefficient}
[motion]
angular_velocity = [{rates}]
"""
CRAFT = """[body]
inertia = [12, 9, 5]
centre_of_mass = [0, 0, 0]
[[thrusters]]
name = "axis 3 after 200 s"
direction = [0, 1, 0]
position = [1, 0, 0]
force = 0.02
{thruster}
[motion]
angular_velocity = [0.1, 0.02, 0.1]
span = [0, 100]
"""


def clauses(reason):
    return {} if reason is None else {one.code: one.quantities for _, one in reason.clauses()}


def test_the_end_under_eddy_currents_names_the_momentum_along_the_field():
    case = load("[body]\ninertia = [3, 2, 1]\n[effects.eddy_currents]\ncoefficient = 0.1\nfield = 1\n"
                "[motion]\nangular_velocity = [0.3, 0.2, 1]\nvertical = [0, 0, 1]\n")
    known = clauses(motion(case).ending.reason)["ends-about-the-field"]
    assert known["momentum"].value == 1.0 and known["momentum"].unit == "N m s"  # D3 omega3 gamma3, by hand
    assert known["axis"] == Axis(1)


def test_a_spin_names_the_side_of_its_axis_and_how_it_was_confirmed():
    found = flat_spin(SPINNER.format(inertia="12, 9, 5", coefficient=0.1, rates="0.01, 0.02, 1"))
    assert found.reason.code == "crosses-the-separatrix" and found.reason.quantities["axis"] == Axis(1)
    assert found.because == str(found.reason) and found.outcome.startswith(found.reason.quantities["side"])


@pytest.mark.parametrize("inertia, code", [("12, 9, 5", "separatrix-not-crossed"), ("12, 12, 5", "plane-not-reached")])
def test_a_spin_that_is_not_followed_to_its_end_says_so_also_of_two_equal_greatest_moments(inertia, code, monkeypatch):
    monkeypatch.setattr(flat_spins, "RUN_STEPS", 500)
    found = flat_spin(SPINNER.format(inertia=inertia, coefficient=1e-3, rates="0.01, 0.02, 1"))
    assert (found.outcome, found.reason.code) == (UNDECIDED, code)
    assert found.reason.quantities["why"].code in ("run-too-long", "run-not-enough")


def test_a_disc_that_is_near_its_plane_at_the_start_ends_about_an_axis_in_it():
    D, k, c, w = np.array([12, 12, 5.0]), 0.5, 0.1, [1, 0.1, 0.1]
    found = flat_spin(SPINNER.format(inertia="12, 12, 5", coefficient=c, rates="1, 0.1, 0.1"))
    assert (found.outcome, found.level, found.settles) == ("across the minor axis", "exact", None)
    end = solve_ivp(damped(D, k, c), [0, 3000], [*w, 0, 0, 0], method="DOP853", rtol=1e-9, atol=1e-12).y[:3, -1]
    assert abs(end[2]) < 0.02 * abs(w[2]) and math.hypot(*end[:2]) > 1  # SciPy: in the plane of the greatest moments


def test_uncertain_numbers_name_axes_and_counts(case_file, stabilab, monkeypatch):
    monkeypatch.setattr(search, "SAMPLE", 6)
    path = case_file('[body]\ninertia = ["12 +- 1 %", 9, 5]\n[effects.constant_torque]\n'
                     'torque = ["0 +- 0.001", 0, 0.02]\n[motion]\nangular_velocity = [0.1, 0.2, 0.3]\n')
    over = json.loads(stabilab("fate", path, "--json")[1])[0]["uncertain"]["fate"]
    assert over["reason"]["code"] == "torque-off-axes-over-box" and over["reason"]["axes"] == [1, 3]
    sampled = over["reason"]["then"][0]
    assert (sampled["code"], sampled["number"]) == ("sampled-points", over["samples"]["number"])
    assert "about the x axis and the z axis together" in stabilab("fate", path)[1]


def test_a_flip_is_printed_no_nearer_than_it_was_found(case_file, stabilab):
    path = case_file('[body]\ninertia = [12, 9, 5]\n[effects.constant_torque]\ntorque = [0, 0, "0.02 +- 1 %"]\n'
                     '[motion]\nangular_velocity = [0.1, 0.02, 0.1]\n')
    over = json.loads(stabilab("fate", path, "--json")[1])[0]["uncertain"]["fate"]
    line, = [one for one in stabilab("fate", path)[1].split("\n") if "flips at" in one]
    assert float(line.split()[2]) >= over["changes_at"] > over["proved_up_to"]


def test_a_margin_names_the_change_from_which_the_fate_is_back(case_file, stabilab):
    row = stuck(CRAFT.format(thruster="stuck = true")).rows[0]
    for margin in row.margins.values():
        known = clauses(margin.reason)
        back = known.get("bounded-again") or known.get("spins-up-again")
        assert (back is not None) == (margin.until is not None and margin.until < math.inf)
        assert back is None or (back["change"].value, back["change"].side) == (margin.until, 1)
    told = json.loads(stabilab("stuck", case_file(CRAFT.format(thruster="stuck = true")), "--json")[1])
    assert told["rows"][0]["margin_reason"]["torque"]["code"] == row.margins["torque"].reason.code


def test_a_burn_names_its_limit_and_the_forces_looked_at(case_file, stabilab):
    text = CRAFT.format(thruster='stop = 50\nforce_tolerance = "5 %"')
    found = burn(text, below="10 deg/s").latest
    assert found.reason.quantities["limit"].value == pytest.approx(math.radians(10), rel=1e-15)
    assert clauses(found.reason)["closing-earliest-of-forces"]["forces"] == found.forces
    first = stabilab("burn", case_file(text), "--below", "10 deg/s")[1].split("\n")[0]
    assert "with the force of axis 3 after 200 s within 5 %: the least of" in first  # as its user named it


def test_what_a_burn_takes_for_granted_has_a_code(case_file, stabilab):
    text = CRAFT.format(thruster="stop = 50").replace("centre_of_mass = [0, 0, 0]\n", "")
    told = json.loads(stabilab("burn", case_file(text), "--json")[1])
    assert [one["code"] for one in told["caveats"]] == ["no-centre-of-mass"]


def test_the_attitude_says_which_axis_by_a_code():
    found = attitude("[body]\ninertia = [12, 9, 5]\n[motion]\nangular_velocity = [1, 0.1, 0.1]\n")
    # 2 T D2 = 109.3 is below |H|^2 = 145.06: H goes round the axis of the greatest moment
    assert found.reason.code == "momentum-round-axis" and found.reason.quantities == {"axis": "short"}


def test_a_diagram_names_the_axis_of_its_torque(case_file, stabilab):
    path = case_file('[body]\ninertia = [12, 9, 5]\n[effects.gyrostat]\nmomentum = [1, 0, 0]\n'
                     "[effects.constant_torque]\ntorque = [0, 0, 0.02]\n[motion]\n"
                     "angular_velocity = [0.1, 0.2, 0.3]\n")
    told = json.loads(stabilab("bifurcation", path, "--vary", "torque[3]=0.01:1", "--json")[1])
    assert told["reason"] == {"code": "equilibria-on-curve", "text": told["what"], "axis": 3}
    assert all(one["reason"]["text"] == one["words"].split("; ")[0] for one in told["events"])
    assert "(torque on the z axis)" in stabilab("bifurcation", path, "--vary", "torque[3]=0.01:1")[1]
