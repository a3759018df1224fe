"""Curves of equilibria and verdicts carry their numbers: each view prints them in its own units, JSON has them
beside the words. Expected values are computed by hand."""
from __future__ import annotations

import json
import math
from fractions import Fraction as F

import pytest

from stabilab import (
    Body,
    ConstantTorque,
    EddyCurrents,
    Gyrostat,
    NewtonianField,
    Resistance,
    Scene,
    equilibria,
)
from stabilab.equilibrium.description import OVER_RATE, holds_rates, over_parameter, shifted
from stabilab.equilibrium.dissipative import GLOBAL
from stabilab.reasons import Coefficient, Formula, Power, Sentence, Unit
from stabilab.show.text.classification import as_dict, called
from stabilab.show.units import DEG, SI
from tests.oracles.pairs import physical

TURN = 180 / math.pi


@pytest.mark.parametrize("filling, words, letters, degrees, value", [
    (Coefficient(F(1, 4), "rad/s"), "0.25", "0.25", "14.3239", 0.25),
    (Coefficient(F(2), "(rad/s)^2"), "2", "2", "6565.61", 2.0),  # 2 (180/pi)^2
    (Coefficient(F(1, 3)), "0.3333333333333333", "0.333333", "0.333333", 1 / 3),  # a number stays
    (Coefficient(-math.inf, "rad/s"), "-inf", "-∞", "-∞", -math.inf),
    (Coefficient(F(1, 10**400)), "1e-400", "1e-400", "1e-400", "1e-400"),  # beyond the doubles
    (Coefficient(F(10**400), "rad/s"), "1.00000e+400", "", "5.72958e+401", "1.00000e+400"),
    (Unit("rad/s"), "rad/s", "rad/s", "deg/s", "rad/s"),
    (Power(3), "^3", "³", "³", 3),
    (shifted("ω1", F(-2)), "(omega1 + 2)", "(ω1 + 2)", "(ω1 + 114.592)", ["(omega1 + ", 2.0, ")"]),
    (over_parameter(F(1), F(-3)), "1 - 3 t", "1 - 3 t", "57.2958 - 3 t", [1.0, " - ", 3.0, " t"]),
    (over_parameter(F(0), F(-1)), "-t", "-t", "-t", "-t"),
    (over_parameter(F(0), F(1), "/t", "(rad/s)^2"), "1/t", "1/t", "3282.81/t", [1.0, "/t"]),
    (Formula(("λ.M", " = ", Coefficient(F(5)))), "lambda.M = 5", "λ.M = 5", "λ.M = 5", ["lambda.M", " = ", 5.0])])
def test_numbers_of_formulas_are_in_the_unit_of_the_view(filling, words, letters, degrees, value):
    said = Sentence("t", "{one}")(one=filling)
    assert said.text() == words and DEG.said(said) == degrees and said.as_dict()["one"] == value
    if not isinstance(filling, Coefficient) or len(words) < 9:
        assert SI.said(said) == letters


def test_without_the_first_clause_the_next_one_leads():
    first, second, third = (Sentence(code, code)() for code in "abc")
    both = first.then(second).then(third, ", ")
    assert str(both.without(first.sentence)) == "b, c"
    assert str(both.without(second.sentence)) == "a, c"
    assert first.without(first.sentence) == first  # of nothing else


def test_the_height_of_a_plane_is_a_quantity_and_has_its_unit_where_it_stands_alone():
    """Two equal moments 3, 3 and 2, a wheel of 1 N m s along the third: equilibria where (3 - 2) w3 = 1."""
    found = equilibria(Scene(Body((3, 3, 2)), Gyrostat((0, 0, 1))))
    plane = next(curve for curve in found.curves if curve.plane)
    name = plane.description.name
    assert name.quantities["value"].value == 1 and str(name) == plane.name == "plane omega3 = 1"
    assert called(name, DEG) == f"plane ω3 = {TURN:.6g} deg/s" and holds_rates(name)
    assert called(next(c.description.name for c in found.curves if not c.plane), DEG) == (
        "line along the gyrostatic moment")


def test_why_there_is_no_equilibrium_holds_the_product():
    """M along axis 3 and lambda . M = 2 * 7."""
    found = equilibria(Scene(Body((4, 3, 2)), Gyrostat((1, 5, 2)), ConstantTorque((0, 0, 7))))
    assert found.kind == "none" and found.reason.as_dict()["product"] == 14
    assert found.because.endswith("and here lambda.M = 14")


def test_the_range_of_a_branch_is_left_out_where_its_pieces_tell_it():
    """A sphere in a field turns at any rate: its branch is over all of them."""
    found = equilibria(Scene(Body((3, 2, 1)), NewtonianField("0.5")))
    run = next(c.description for c in found.curves if c.description.symbol == "Ω").parametrisation
    assert str(run).startswith("t = Omega from -inf to inf rad/s; gamma_i = ")
    assert DEG.said(run).startswith("t = Ω from -∞ to ∞ deg/s; γᵢ = ")
    assert str(run.without(OVER_RATE)).startswith("gamma_i = ")


def test_that_every_motion_tends_to_an_equilibrium_is_decided_by_its_sentence():
    rest = equilibria(Scene(Body((3, 2, 1)), Resistance("0.1"))).points[0]
    assert rest.reason.says(GLOBAL.sentence) and rest.because.startswith("every motion tends to it: T' = -2 c T")
    turning = equilibria(Scene(Body((3, 2, 1)), EddyCurrents("0.1", 1))).curves[0]
    assert not turning.segments[0].reason.says(GLOBAL.sentence)
    assert turning.description.name.quantities["axis"].number == 1


@pytest.mark.parametrize("D, lam, M", [((4, 3, 2), (1, 5, 0), (0, 0, 7)), ((2, 2, 1), (2, 1, 3), (1, -2, 0)),
                                       ((3, 3, 2), (0, 0, 1), (0, 0, 0))])
def test_json_has_every_number_of_a_curve_beside_its_words(D, lam, M, tmp_path):
    import stabilab
    path = tmp_path / "one.toml"
    path.write_text(f"[body]\ninertia = {list(D)}\n[effects.gyrostat]\nmomentum = {list(lam)}\n"
                    f"[effects.constant_torque]\ntorque = {list(M)}\n")
    case = stabilab.load(path)
    found = equilibria(case)
    written = json.loads(json.dumps(as_dict(case, found, None)["equilibria"], default=str))
    assert written["why"] == {"code": found.reason.code, "text": found.because}
    for told, curve in zip(written["curves"], found.curves):
        assert told["parameter"] == {"symbol": "t", "unit": curve.description.unit}
        for part in ("name", "equation", "parametrisation"):
            first = told["description"][part]
            texts = [first["text"], *(one["text"] for one in first.get("then", ()))]
            assert all(text in told[part] for text in texts) and first["code"]
        assert all(one["reason"]["code"] and one["because"].startswith(one["reason"]["text"])
                   for one in (*told["segments"], *told["samples"]))


def test_two_curves_with_the_same_numbers_are_equal():
    """Descriptions are compared by what they say."""
    scene, _ = physical((4, 3, 2), (1, 5, 0), (0, 0, 7))
    one, other = (equilibria(scene).curves[0] for _ in range(2))
    assert one == other and one.description == other.description
