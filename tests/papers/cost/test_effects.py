"""A scene costs what its effects cost: counted; and an effect of zero strength is an absent one, to the last
bit."""
import inspect
import json
import re
from pathlib import Path

import pytest
from typer.testing import CliRunner

from stabilab import Scene, derive, load
from stabilab.cli import whole
from stabilab.errors import CaseError
from stabilab.papers import cost_effects as effect_cost
from stabilab.papers.cost_effects import (
    BODY,
    EXAMPLES,
    alone,
    answers,
    counted,
    example,
    imported,
    ladder,
    operations,
    without,
    zero_is_absent,
)
from stabilab.physics.effects import REGISTRY, effect_class
from stabilab.physics.to_numpy import Form, _function, form

# By hand. States: omega 3, gamma 3, attitude 4, velocity 3, position 3, damper 3, wheel 3. Symbols: the moments of inertia and
# the effect's
# own; a force brings the mass.
ALONE = {"constant_torque": (3, 3 + 3), "gyrostat": (3, 3 + 3), "charge": (3, 3 + 1),
         "resistance": (3, 3 + 1),
         "liquid_cavity": (3, 3 + 1), "newtonian_field": (6, 3 + 1), "gravity": (6, 3 + 3),
         "body_force": (13, 3 + 3 + 1), "viscous_damper": (6, 3 + 2), "damper_wheel": (4, 3 + 5), "damper_mass": (5, 3 + 9),
         "rate_damper": (3, 3 + 6),
         "eddy_currents": (6, 3 + 1), "wheel_motor": (6, 3 + 3)}
# Operations by hand, one added after the other. Body: c q r in each row, 2 * 3. Torque: one addition a row.
# Gyrostat: two
# terms c x a row, 4 each. Charge: its terms are the gyrostat's along axis 3. Resistance: one term c x a row.
# Field: one
# term c g2 g3 a row, and gamma' = gamma x omega, 3 a row. Gravity: two terms c g a row.
ADDED = {"body alone": 6, "constant_torque": 3, "gyrostat": 3 * 4, "charge": 0, "resistance": 3 * 2,
         "newtonian_field": 3 * 3 + 3 * 3,
         "gravity": 3 * 4}
ZERO = {  # the table of a case file, its strength zero
    "constant_torque": ["torque = [0, 0, 0]"], "gyrostat": ["momentum = [0, 0.0, 0]"],
    "resistance": ["coefficient = 0"],
    "charge": ['charge = 0\nfield = 100\narm = 1\nangle = 0.3',
               'charge = 0.1\nfield = 0.0\narm = 1\nangle = "attitude"'],
    "liquid_cavity": ["density = 1000\nviscosity = 1\nP0 = 0", "density = 0\nviscosity = 1\nradius = 0.1"],
    "newtonian_field": ["strength = 0", "lambda = 0\nR = 10"],
    "gravity": ["weight = 0\ncentre_of_mass = [0, 0, 0.1]"],
    "body_force": ["force = [0, 0, 0]"], "rate_damper": ["coefficient = 0", "coefficient = [0, 0, 0]"],
    "eddy_currents": ["coefficient = 0\nfield = 1", "coefficient = 1\nfield = 0"],
    "wheel_motor": ["torque = [0, 0, 0]", "torque = [0, 0, 0]\nduration = 5"],
    "damper_mass": [], "damper_wheel": [], "viscous_damper": []}  # a damper without strength is refused
FAULTY = {  # the same, wrong in a way that its strength does not excuse
    "constant_torque": "torque = [0, 0]", "gyrostat": "momentum = [0, 0, 0]\nspeed = 1",
    "resistance": "coefficient = -0.1",
    "charge": "charge = 0\nfield = 100\narm = 1", "liquid_cavity": "density = 0\nviscosity = 0\nP0 = 1",
    "newtonian_field": "lambda = 0\nR = 0", "gravity": 'weight = 0\ncentre_of_mass = "low"',
    "body_force": "force = 0", "viscous_damper": "inertia = 0\ncoefficient = 0.1",
    "damper_mass": "mass = 0\nplace = [0, 0, 0]\nline = [0, 0, 1]\nstiffness = 1\ncoefficient = 1",
    "damper_wheel": "inertia = 0.1\ncoefficient = 0.1\naxis = [0, 0, 0]",
    "rate_damper": "coefficient = [0, 0]", "eddy_currents": "coefficient = 0\nfield = -1",
    "wheel_motor": "torque = [0, 0, 0]\nduration = 0"}
DOCS = Path(__file__).parents[3] / "docs"
CASE = """[body]
inertia = [3, 2, 1.5]
mass = 10
{effects}
[motion]
angular_velocity = [0.3, 0.2, -0.4]
span = [0, 5]
"""
BASE = {"gyrostat": "[effects.gyrostat]\nmomentum = [0.4, 0, 0]\n",
        "constant_torque": "[effects.constant_torque]\ntorque = [0, 0, 0.2]\n"}


def counts_of_the_page():
    page = (DOCS / "cost.md").read_text(encoding="utf-8")
    return {name: (int(states), int(operations)) for name, states, operations
            in re.findall(r"^\| `(\w+)` \| (\d+) \| (\d+) \|$", page, re.M)}


def test_the_page_on_cost_has_every_effect_with_the_states_that_it_adds():
    rows = counts_of_the_page()
    assert {name: states for name, (states, _) in rows.items()} == {
        name: states - 3 for name, (states, _) in ALONE.items()}  # by hand
    assert all(rows[name][1] == ADDED[name] for name in ("constant_torque", "gyrostat", "resistance"))


@pytest.mark.slow
def test_the_page_on_cost_has_the_operations_of_every_effect():
    body = counted("", Scene(BODY))
    assert body.operations == ADDED["body alone"]
    assert {name: operations for name, (_, operations) in counts_of_the_page().items()} == {
        name: counted(name, scene).operations - body.operations for name, scene in alone()}


def test_every_effect_has_an_example():
    assert set(EXAMPLES) == set(REGISTRY) == set(ALONE) == set(ZERO) == set(FAULTY)


def test_an_effect_brings_its_own_states_and_symbols_and_no_branch():
    for added, scene in alone():
        cost = counted(added, scene)
        assert (cost.states, len(cost.parameters), cost.branches) == (*ALONE[added], 0), added
        own = set(example(added).parameters()) | ({"mass"} if added == "body_force" else set())
        assert set(cost.parameters) == {"D1", "D2", "D3"} | own


def test_effects_added_one_at_a_time_add_the_operations_of_their_terms():
    costs = [counted(*step) for step in ladder(tuple(ADDED)[1:])]
    assert [cost.added for cost in costs] == list(ADDED)
    total = 0
    for cost in costs:
        total += ADDED[cost.added]
        assert cost.operations == total, cost.added
    for before, after in zip(costs, costs[1:]):
        assert after.parameters == (*before.parameters, *example(after.added).parameters())


def test_the_count_of_operations_forms_common_parts_once():
    from sympy import symbols
    x, y = symbols("x y", real=True)
    assert operations(Form((x, y), (x * y + 1, x * y + x), (), ())) == 3  # one product, two sums


def test_compiled_rates_hold_no_condition():
    equations = derive(ladder(tuple(ADDED)[1:])[-1][1])
    rates = form(equations, equations.rhs)
    source = inspect.getsource(_function(rates.state + rates.symbols, rates.expressions))
    assert "omega1" in source and not any(word in source for word in ("if ", "where", "select", "piecewise"))


def test_only_the_named_effects_are_imported():
    scenes = ((), ("gravity",), ("charge", "gyrostat"), ("gravity",))
    assert imported(*scenes) == [*scenes]


@pytest.mark.one_in(3)
@pytest.mark.parametrize("name", [name for name in EXAMPLES if ZERO[name]])
def test_zero_strength_is_absence_to_the_last_bit(name):
    assert all(zero_is_absent(name).values())
    assert Scene(BODY, example(name, zero=True)) == Scene(BODY)


@pytest.mark.one_in(2)
@pytest.mark.parametrize("name", ["constant_torque", "gyrostat", "charge", "resistance"])
def test_the_comparison_sees_an_effect_that_acts(name):
    base = without(name)
    plain, named = answers(base), answers(Scene(BODY, *base.effects, example(name)))
    assert all(plain[question] != named[question] for question in plain if question.startswith("states"))


def printed(folder, command, effects):
    folder.mkdir()
    path = folder / "case.toml"
    path.write_text(CASE.format(effects=effects), encoding="utf-8")
    result = CliRunner().invoke(whole(), [*command, str(path), "--json"], catch_exceptions=False)
    assert result.exit_code == 0, result.output
    return json.loads(result.stdout)


@pytest.mark.one_in(8)
@pytest.mark.parametrize("command", [("classify",), ("simulate",), ("extremes",)], ids=lambda c: c[0])
@pytest.mark.parametrize("name", EXAMPLES)
def test_a_case_file_with_a_zero_effect_prints_the_same_json_as_without_it(name, command, tmp_path):
    base = "".join(text for other, text in BASE.items() if other != name)
    plain = printed(tmp_path / "plain", command, base)
    for number, table in enumerate(ZERO[name]):
        assert printed(tmp_path / f"zero{number}", command, f"{base}[effects.{name}]\n{table}\n") == plain


@pytest.mark.parametrize("name", EXAMPLES)
def test_a_zero_effect_of_a_case_file_is_still_checked(name, case_file):
    path = case_file(CASE.format(effects=f"[effects.{name}]\n{FAULTY[name]}\n"))
    with pytest.raises(CaseError, match=f"effects.{name}"):
        load(path)


def test_a_force_of_zero_asks_for_no_mass_once_it_is_built():
    from stabilab import Body
    assert Scene(Body((3, 2, 1)), effect_class("body_force")((0, 0, 0))).blocks == ("omega",)


def test_the_page_shows_every_effect(tmp_path, monkeypatch):
    from stabilab.papers import cost_effects as analysis
    from stabilab.papers import cost_effects as show
    monkeypatch.setattr(analysis, "REPEATS", 1)
    few = ("constant_torque", "gravity")
    monkeypatch.setattr(show, "EXAMPLES", {name: EXAMPLES[name] for name in few})
    monkeypatch.setattr(show, "ladder", lambda: ladder(few))
    monkeypatch.setattr(show, "alone", lambda: alone()[:1])
    monkeypatch.setattr(show, "imported", lambda *scenes: [tuple(names) for names in scenes])
    told = []
    html = show.page(tmp_path, told.append).read_text(encoding="utf-8")
    assert len(told) == 3 and (tmp_path / "effects.png").stat().st_size > 10_000
    assert "constant torque" in html and "gravity" in html and "different" not in html
    assert "changes no bit" in html


def test_an_effect_that_is_not_there_has_no_cost():
    with pytest.raises(KeyError):
        effect_cost.imported(["phlogiston"])
