"""Results show themselves: in a line, in a notebook, as data sets and tables."""
import math
import re

import numpy as np
import pytest

import stabilab
from stabilab import errors, packages
from stabilab.answers.motions.rows import fates
from tests.shared import CASES

SCENE = stabilab.Scene(stabilab.Body((12, 9, 5)), stabilab.Gyrostat(("0.8", 0, 0)),
                       stabilab.ConstantTorque((0, 0, "0.02")))
STATES = [[0.1, 0.05, 0.02], [0.1, 0.05, 0.9]]
TIMES = [0.0, 10.0, 20.0]
OFF = stabilab.Scene(stabilab.Body((12, 9, 5)), stabilab.Gyrostat(("0.8", 0, 0)),
                     stabilab.ConstantTorque(("0.01", "0.3", "0.02")))
DAMPED = stabilab.load(
    stabilab.Scene(stabilab.Body((12, 9, 5)), stabilab.ViscousDamper("0.5", 2)), (0.3, 0.1, 2))
GYROSTAT = stabilab.load(stabilab.Scene(stabilab.Body((3, 2, 1)), stabilab.ViscousDamper("0.1", "0.3"),
                                        stabilab.Gyrostat((0, 0, 2))), (0.1, 0, 0.5))
RESULTS = {
    "Percentiles": lambda: stabilab.percentiles(
        '[body]\ninertia = [3, 2, 1]\n[motion]\nangular_velocity = ["0.09 to 0.11, uniform", 0, 0]\n', 5),
    "Motion": lambda: stabilab.motion(SCENE, STATES[0]), "Equilibria": lambda: stabilab.equilibria(SCENE),
    "FateResult": lambda: fates(SCENE, STATES), "Motions": lambda: stabilab.fate(SCENE, STATES),
    "Values": lambda: stabilab.period(SCENE, STATES[0]),
    "Trajectory": lambda: stabilab.trajectory(SCENE, STATES[0], TIMES),
    "Simulation": lambda: stabilab.simulate(SCENE, STATES[0], TIMES),
    "Separatrix": lambda: stabilab.separatrix(SCENE, shape=(5, 7)),
    "TimeTo": lambda: stabilab.time_to(SCENE, STATES, rate=2),
    "Comparison": lambda: stabilab.compare(stabilab.load(CASES / "charged-body-small-torque.toml"), TIMES),
    "Stuck": lambda: stabilab.stuck(stabilab.load(CASES / "upper-stage.toml")),
    "SpinUp": lambda: stabilab.spin_up(OFF, STATES[1]),
    "Diagram": lambda: stabilab.bifurcation(stabilab.load(CASES / "thruster-stuck-major-axis.toml"),
                                            {"torque[1]": "0:0.5"}),
    "Plane": lambda: stabilab.bifurcation(stabilab.load(CASES / "thruster-stuck-major-axis.toml"),
                                          {"torque[1]": "0.1:0.5", "momentum[2]": "0.1:0.5"}),
    "Chaos": lambda: stabilab.chaos(SCENE, STATES, until=40.0),
    "Attitude": lambda: stabilab.attitude(SCENE, STATES[0]),
    "Angles": lambda: stabilab.angles(SCENE, STATES[0], span=10),
    "Crossings": lambda: stabilab.when(SCENE, state=STATES[0], until=40, events=["omega1", lambda t, y: t - 1]),
    "FlatSpin": lambda: stabilab.flat_spin(DAMPED), "Ending": lambda: stabilab.motion(DAMPED).ending,
    "GyrostatSpin": lambda: stabilab.flat_spin(GYROSTAT),
    "Rotations": lambda: stabilab.flat_spin(GYROSTAT, momentum="2.8 N m s"),
    "RotationDiagram": lambda: stabilab.bifurcation(
        stabilab.load(CASES / "dual-spin-damper.toml"), {"wheels.flywheel.speed": "0:500 rpm"}, spin="60 rpm"),
    "TopDiagram": lambda: stabilab.bifurcation(stabilab.load(CASES / "toy-top.toml"),
                                               {"angular_velocity[3]": "0:30 rev/s"}),
    "Ensemble": lambda: stabilab.ensemble(SCENE, STATES, TIMES)}


@pytest.fixture(scope="module")
def results():
    return {name: make() for name, make in RESULTS.items()}


@pytest.mark.parametrize("name", RESULTS)
def test_a_result_says_in_one_short_line_what_it_answers(results, name):
    line = repr(results[name])
    assert line.startswith(f"{name}(") and len(line) < 250 and "\n" not in line and "array(" not in line


def test_tables_of_a_stuck_thruster_of_models_and_of_a_spin_up_hold_their_numbers(results):
    table, rows = results["Stuck"].to_pandas(), results["Stuck"].rows
    assert list(table["fate"]) == [row.fate for row in rows]
    assert list(table["limit_low"]) == [row.time_to_limit[0] for row in rows]
    table, rows = results["Comparison"].to_pandas(), results["Comparison"].departures
    assert list(table["largest"]) == [d.largest
                                      for d in rows] and list(table["part"]) == [d.part for d in rows]
    assert list(results["SpinUp"].to_pandas()["state"]) == list(results["SpinUp"].state) and results[
        "SpinUp"].to_xarray().attrs["t"] == results["SpinUp"].t


@pytest.mark.parametrize("name", RESULTS)
def test_a_notebook_gets_a_table_in_which_nothing_is_a_tag(results, name):
    page = results[name]._repr_html_()
    assert page.count("<table>") == page.count("</table>") == 1 and page.count(
        "<tr>") <= 12 and "<script" not in page


@pytest.mark.parametrize("name", RESULTS)
def test_the_minus_of_a_number_in_a_notebook_is_that_of_print(results, name):
    cells = re.findall(r"<(?:t[hd]|b)>(.*?)</", results[name]._repr_html_())
    assert cells and not [cell for cell in cells if re.search(r"(?:^|[\s(\[,=e])-\d|^-", cell)]


def test_a_negative_rate_and_a_small_one_keep_their_values_in_a_notebook():
    page = stabilab.simulate(SCENE, (-0.25, 1e-7, 0.5), [0.0])._repr_html_()
    assert "<td>−0.25</td><td>1e−07</td><td>0.5</td>" in page


def test_what_is_in_a_result_is_escaped_in_a_notebook():
    from dataclasses import replace
    page = replace(stabilab.equilibria(SCENE), kind="<script>alert(1)</script>")._repr_html_()
    assert "<script" not in page and "&lt;script&gt;" in page


def test_tables_hold_the_numbers_of_the_results(results):
    table = results["Trajectory"].to_pandas()
    assert list(table.columns) == ["omega1", "omega2",
                                   "omega3"] and list(table.index) == TIMES and table.index.name == "time"
    assert np.array_equal(table.to_numpy(), results["Trajectory"].states)
    table = results["FateResult"].to_pandas()
    assert list(table["fate"]) == ["bounded", "spin-up"]
    assert np.array_equal(table["margin"], results["FateResult"].margins)
    table = results["Motion"].to_pandas()
    assert [tuple(row)
            for row in table[["least", "greatest"]].to_numpy()] == [tuple(pair)
                                                                    for pair in results["Motion"].extremes]
    assert table.attrs["period"] == results["Motion"].period


def test_data_sets_have_dimensions_units_and_words(results):
    data = results["Simulation"].to_xarray()
    assert dict(data.sizes) == {"time": 3,
                                "axis": 3} and data.omega.units == "rad/s" and data.time.units == "s"
    assert float(data.omega.sel(time=20.0, axis=2)) == results["Simulation"].state["omega"][2, 1]
    data = results["Motions"].to_xarray()
    assert data.margin.dims == ("state",
                                ) and data.margin.units == "J" and data.start.dims == ("state", "axis")
    data = results["TimeTo"].to_xarray()
    assert data.low.units == "s" and float(data.low[1]) == results["TimeTo"].low[1]


def test_a_scene_without_equilibria_has_an_empty_table():
    """A torque along the wheel's axis: no rotation keeps its momentum (|H|^2/2 - D3 T grows steadily)."""
    scene = stabilab.Scene(stabilab.Body((12, 9, 5)), stabilab.Gyrostat((0, 0, 1)), stabilab.ConstantTorque((0, 0, 1)))
    found = stabilab.equilibria(scene)
    assert found.kind == "none" and len(found.to_pandas()) == 0 and found.to_xarray().at.shape == (0, 3)
    assert "none" in found._repr_html_()


def test_what_limits_an_answer_stands_in_every_view_of_it():
    """A torque exactly along an axis keeps the motion bounded: any tilt may end that."""
    words = "only while the torque is exactly along axis 3"
    for found in (stabilab.fate(SCENE, STATES[0]), stabilab.period(SCENE, STATES[0]), stabilab.fate(SCENE, STATES),
                  stabilab.extremes(SCENE, STATES[0]), stabilab.motion(SCENE, STATES[0]),
                  stabilab.when(SCENE, STATES[0], rate=3), stabilab.stuck(SCENE, state=STATES[0])):
        assert any(words in one.words for one in found.caveats)
        assert words in repr(found) and words in found._repr_html_() and words in found.to_xarray().attrs["caveats"]


def test_values_are_numbers_and_say_how_well_they_are_known():
    one, many = stabilab.period(SCENE, STATES[0]), stabilab.period(SCENE, STATES)
    assert float(one) == one.values and 2 * one == 2 * float(one) and f"{one:.3f}" == f"{float(one):.3f}"
    assert one.level == "exact" and "energy is below the barrier" in one.reason
    assert many.shape == (2,) and many.tolist()[1] == math.inf and np.isinf(many)[1] and (many > 0).all()
    assert np.asarray(many) is many.values and len(many) == 2 and many[0] == pytest.approx(float(one), rel=1e-11)
    assert stabilab.fate(SCENE, STATES)[0].fate == stabilab.Fate.BOUNDED and not stabilab.fate(SCENE, STATES)[0].shape


def test_a_grid_of_states_keeps_its_shape():
    found = stabilab.fate(SCENE, [[STATES[0], STATES[1], STATES[0]]])
    assert found.to_xarray().fate.shape == (1, 3) and len(found.to_pandas()) == 3
    assert stabilab.fate(SCENE, STATES[0]).to_xarray().fate.shape == ()
    assert len(stabilab.fate(SCENE, STATES[0]).to_pandas()) == 1


def test_results_of_a_top_and_of_a_spin_up_show_themselves():
    """Their states have six numbers, their extremes none or infinite ends."""
    top = stabilab.load(__file__.rsplit("/tests/", 1)[0] + "/cases/top-lx30-lz30.toml")
    assert stabilab.equilibria(top.scene).to_pandas().shape[1] == 10 and "at6" in stabilab.equilibria(
        top.scene).to_pandas().columns
    spin = stabilab.motion(SCENE, STATES[1])
    assert spin.to_pandas()["greatest"].iloc[2] == math.inf and "spin-up about axis 3" in repr(spin)


@pytest.mark.parametrize("module, method", [("xarray", "to_xarray"), ("pandas", "to_pandas")])
def test_a_package_that_is_not_there_is_named_in_one_line(results, monkeypatch, module, method):
    monkeypatch.setattr(packages, "present", lambda name: name != module)
    with pytest.raises(errors.InputError,
                       match=f"^{module} is not installed, .*pip install {module} \\(part of stabilab's "
                             f"extra data: .*\\)$") as caught:
        getattr(results["Motion"], method)()
    assert "\n" not in str(caught.value)


def test_every_effect_can_be_had_from_the_package():
    from stabilab.physics.effects import REGISTRY
    assert {name for _,
            name in REGISTRY.values()} <= set(stabilab.__all__) and stabilab.InputError is errors.InputError


def test_every_class_of_results_is_tried_here():
    from stabilab.show.results.kinds import KINDS
    assert set(RESULTS) == set(KINDS)


def test_tables_of_an_attitude_and_of_zeros_hold_their_numbers(results):
    turn, found = results["Attitude"], results["Crossings"]
    assert turn.to_xarray().attrs["rotation_period"] == turn.rotation_period
    assert list(turn.to_pandas()["turn_axis"]) == list(turn.turn_axis)
    table = found.to_pandas()
    assert list(table["t"]) == [*found.t[0], *found.t[1]] and list(table["event"]) == [1] * len(found.t[0]) + [2]
    assert repr(found).startswith(f"Crossings({len(found.t[0])} zeros, 1 zero up to t = 40, reached")
