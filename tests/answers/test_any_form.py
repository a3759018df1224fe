"""Every public function takes a case, the path of its file, its text, a dict, or its scene with the motion;
text with a unit means the same as the number in SI units; a case says itself again."""
import dataclasses
import pickle
import tomllib
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest

import stabilab
from stabilab.answers.chaos import row_of
from stabilab.case.read import load_all
from stabilab.representation import same
from tests.shared import CASES

FILE = CASES / "minor-axis-100.toml"
CASE = stabilab.load(FILE)
TORQUE = CASES / "thruster-stuck-major-axis.toml"
OF_A_SCENE = {"equilibria": {}, "fate": {}, "motion": {}, "extremes": {}, "period": {},
              "spin_up": {"budget": 200}, "separatrix": {}, "derive": {}, "validity": {},
              "chaos": {"until": 20.0}, "fate_grid": {"axes": [[0.1], [0.2], [0.3]]},
              "simulate": {"times": [0.0, 1.0]}, "trajectory": {"times": [0.0, 1.0]}, "attitude": {},
              "angles": {}, "ensemble": {"times": [0.0, 1.0]}, "time_to": {"rate": "3"}}
START = {"fate": "state", "motion": "state", "extremes": "state", "period": "state", "spin_up": "state",
         "validity": "states", "chaos": "states", "simulate": "state", "trajectory": "state", "attitude": "state",
         "angles": "state", "ensemble": "states", "time_to": "states"}
OF_A_CASE = {"stuck": {}, "flat_spin": {}, "compare": {}, "theory": {}, "when": {"rate": "0.6"},
             "sweep": {"vary": {"effects.constant_torque.torque[3]": "0:1:2 mN m"}, "answer": "fate"},
             "bifurcation": {"vary": {"effects.constant_torque.torque[3]": "0:1 mN m"}},
             "basin": {"vary": {"angular_velocity[1]": "0:1:3", "angular_velocity[3]": "0:1:3"}, "depth": 0},
             "atlas": {"level": 0, "refine": 0, "timed": False}, "report": {},
             "percentiles": {"samples": 5, "rate": "0.6"}}


def alike(one, other):
    """Whether two answers hold the same, as far as both can say so."""
    if hasattr(one, "identical"):
        return one.drop_attrs().identical(other.drop_attrs())
    if dataclasses.is_dataclass(one):
        return all(alike(getattr(one, f.name), getattr(other, f.name)) for f in dataclasses.fields(one)
                   if f.name not in ("case", "name", "plan", "scene", "given"))
    return same(one, other) or str(one) == str(other)


def test_every_public_function_of_a_scene_or_a_case_is_asked_here():
    from tests.answers import test_asked
    assert set(OF_A_SCENE) == set(test_asked.OF_A_SCENE) and set(OF_A_CASE) == set(test_asked.OF_A_CASE)


def own_case(name):
    """(its path, the options) of a case that the question answers."""
    if name == "flat_spin":
        return CASES / "rahn-barba.toml"
    if name == "percentiles":
        return CASES / "uncertain-minor-axis.toml"
    if name in ("attitude", "angles", "time_to", "when", "stuck", "sweep", "bifurcation", "basin", "atlas"):
        return TORQUE
    return CASES / "charged-body.toml" if name in ("compare", "theory", "validity") else FILE


@pytest.mark.parametrize("name", OF_A_SCENE)
def test_a_question_of_a_scene_takes_its_case_in_any_form(name):
    path, options, ask = own_case(name), OF_A_SCENE[name], getattr(stabilab, name)
    case = stabilab.load(path)
    start = {START[name]: [case.start] if name == "ensemble" else case.start} if name in START else {}
    if name == "extremes":
        start["span"] = case.span
    if name == "motion":
        start |= {"span": case.span, "state": case.exact_state}
    if name == "spin_up":
        start["state"] = case.exact_state
    if name == "validity":
        start["states"] = row_of(case.scene, case.state, case.blocks)
    by_hand = ask(case.scene, **start, **options)
    for given in (case, path, str(path), path.read_text(encoding="utf-8"), tomllib.loads(case.text)):
        assert alike(ask(given, **options), by_hand), type(given)


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in OF_A_CASE if name != "report"])
def test_a_question_of_a_case_takes_it_in_any_form_and_a_scene_with_its_motion(name):
    path, options, ask = own_case(name), OF_A_CASE[name], getattr(stabilab, name)
    case = stabilab.load(path)
    of_the_case = ask(case, **options)
    for given in (path, str(path), path.read_text(encoding="utf-8"), tomllib.loads(case.text)):
        assert alike(ask(given, **options), of_the_case), type(given)
    if name == "percentiles":  # a scene has no uncertain numbers
        return
    state = {"omega": case.exact_state, **case.blocks}
    assert type(ask(case.scene, state=state, span=case.span, **options)) is type(of_the_case)


@pytest.mark.parametrize("ask, path", [(stabilab.burn, "burns/stage"), (stabilab.load_burning, "burns/stage"),
                                       (stabilab.circular_orbit, "orbits/boom"),
                                       (stabilab.load_orbiting, "orbits/boom")])
def test_burns_and_circular_orbits_take_a_case_in_any_form(ask, path):
    path = CASES / f"{path}.toml"
    text = path.read_text(encoding="utf-8")
    for given in (str(path), text, tomllib.loads(text)):
        found, expected = ask(given), ask(path)
        if hasattr(found, "craft"):
            found, expected = ((one.craft.scene, one.craft.state) for one in (found, expected))
        assert alike(found, expected), type(given)
    with pytest.raises(stabilab.InputError, match="expected a case"):
        ask(3)


def test_a_satellite_in_a_dict_without_an_orbit_is_told_which_table_is_missing():
    with pytest.raises(stabilab.InputError, match=r"^dict: expected a table \[circular_orbit\] with rate"):
        stabilab.circular_orbit({"body": {"inertia": [3, 2, 1]}})
    with pytest.raises(stabilab.InputError, match=r"phone.toml: expected a table \[circular_orbit\] with rate"):
        stabilab.circular_orbit(stabilab.load(CASES / "phone.toml"))


@pytest.mark.parametrize("name", ["fate", "motion", "equilibria", "period", "extremes", "simulate", "stuck",
                                  "attitude", "when"])
def test_a_case_answers_as_the_function_does(name):
    case = stabilab.load(TORQUE)
    options = {"rate": "0.6 rad/s"} if name == "when" else {}
    assert alike(getattr(case, name)(**options), getattr(stabilab, name)(case, **options))


def test_a_case_draws_itself():
    pytest.importorskip("matplotlib")
    assert CASE.plot.time().get_xlabel() == stabilab.plot.time(FILE).get_xlabel()
    with pytest.raises(AttributeError, match="there is no plot 'basin'; there are attitude, body, budget"):
        CASE.plot.basin()


@pytest.mark.slow
def test_a_case_writes_its_report(tmp_path):
    page = CASE.report(tmp_path / "pages")
    assert page.name == "index.html" and "minor-axis-100" in page.read_text(encoding="utf-8")


def test_public_functions_are_pickled_by_their_names():
    assert pickle.loads(pickle.dumps(stabilab.fate)) is stabilab.fate


# --- Units
def test_text_with_a_unit_is_the_number_in_si_units():
    """A quarter of 360 degrees is pi/2 by definition."""
    scene = stabilab.load(TORQUE).scene
    turn = stabilab.fate(scene, ["90 deg/s", 0, "60 rpm"])
    assert turn.states.tolist() == [np.pi / 2, 0.0, 2 * np.pi]
    assert same(stabilab.simulate(scene, ["0.1 rad/s", 0.2, 0], ["0 s", "1 min"]).t, np.array([0.0, 60.0]))
    run = stabilab.trajectory(scene, {"omega": ["180 deg/s", 0, 0]}, ["0 s", "500 ms"])
    assert run.t[1] == 0.5 and run.states[0, 0] == np.pi
    assert stabilab.time_to(scene, [0, 0, 0], rate="1", t_max="1 h").low == stabilab.time_to(
        scene, [0, 0, 0], rate="1", t_max=3600).low
    with pytest.raises(stabilab.InputError, match="state: expected angular velocity .rad/s., got torque"):
        stabilab.fate(scene, ["1 N m", 0, 0])
    with pytest.raises(stabilab.InputError, match="state: expected a number without a unit"):
        stabilab.fate(stabilab.ScaledGyrostat(0, 0, (1, 0, 0)), ["1 deg/s", 0, 0])


def test_parts_of_a_scene_take_text_with_units_exactly():
    same_as = [
        (stabilab.Body(["12 kg m^2", "9000 g m^2", 7]), stabilab.Body([12, 9, 7])),
        (stabilab.Body((3, 2, 1), "500 g"), stabilab.Body((3, 2, 1), 0.5)),
        (stabilab.Gyrostat([0, "0.3 N m s", 0]), stabilab.Gyrostat([0, "0.3", 0])),
        (stabilab.ConstantTorque(["10 mN m", 0, 0]), stabilab.ConstantTorque(["0.01", 0, 0])),
        (stabilab.BodyForce([0, 0, "1 kN"]), stabilab.BodyForce([0, 0, 1000])),
        (stabilab.Gravity("10 N", [0, 0, "5 cm"]), stabilab.Gravity(10, [0, 0, "0.05"])),
        (stabilab.Charge("2 mC", "3 T", "10 cm", "0 deg"), stabilab.Charge("0.002", 3, "0.1", 0)),
        (stabilab.LiquidCavity("1000 kg/m^3", "1 m^2/s", "1 m^7"), stabilab.LiquidCavity(1000, 1, 1)),
        (stabilab.NewtonianField("3 s^-2", "7000 km"), stabilab.NewtonianField(3, 7000000)),
        (stabilab.Resistance("3 1/s"), stabilab.Resistance(3))]
    for one, other in same_as:
        assert one == other and one.exact == other.exact
    with pytest.raises(stabilab.InputError, match="torque: expected torque .N m. or energy"):
        stabilab.ConstantTorque(["1 N", 0, 0])


# --- What is exact
FORMS = (str, Decimal, Fraction)
LIMIT = {"time_to": {"rate": "0.5"}, "when": {"rate": "0.5"}, "flat_spin": {"within": "5 deg"}}
# 9 (9 - 5) 0.1^2 = 4 (5 - 4) 0.3^2: by H^2 = 2 D2 T on the separatrix of the free body (the doubles are not)
ON_SEPARATRIX, FREE = ("0.1", "0.3", "0.3"), stabilab.Scene(stabilab.Body((9, 5, 4)))
DAMPED = stabilab.Scene(stabilab.Body((9, 5, 4)), stabilab.ViscousDamper("0.5", 1))


@pytest.mark.parametrize("name", [*(name for name in START if name != "validity"), "when", "flat_spin"])
def test_a_start_in_text_in_decimals_and_in_fractions_is_the_same(name):
    scene, start = (DAMPED, ("0.1", "0.01", "0.02")) if name == "flat_spin" else (FREE, ON_SEPARATRIX)
    key, options = START.get(name, "state"), LIMIT.get(name) or OF_A_SCENE.get(name, {})
    answers = [getattr(stabilab, name)(scene, **{key: [row] if key == "states" else row}, **options)
               for row in ([form(v) for v in start] for form in FORMS)]
    assert alike(answers[0], answers[1]) and alike(answers[1], answers[2])


@pytest.mark.parametrize("name", ["fate", "extremes", "period", "chaos", "ensemble", "time_to"])
def test_many_starts_are_taken_in_any_form_as_their_doubles(name):
    options = {"rate": ["0.5", 1, 1]} if name == "time_to" else OF_A_SCENE[name]
    rows = [("0.1", "0.3", "0.3"), ("1/3", "0.2", "0.1")]
    doubles = [[float(Fraction(v)) for v in row] for row in rows]
    for given in (rows, [[Fraction(v) for v in row] for row in rows]):
        assert alike(getattr(stabilab, name)(FREE, states=given, **options),
                     getattr(stabilab, name)(FREE, states=doubles, **options))


def test_an_exact_start_on_a_separatrix_is_on_it_whatever_is_asked():
    """By H^2 = 2 D2 T, in rationals; the nearest doubles are off it, and their motion repeats."""
    start, doubles = [Decimal(v) for v in ON_SEPARATRIX], [float(v) for v in ON_SEPARATRIX]
    w = [Fraction(v) for v in ON_SEPARATRIX]
    assert sum((d * v) ** 2 for d, v in zip((9, 5, 4), w)) == 5 * sum(d * v * v for d, v in zip((9, 5, 4), w))
    assert stabilab.fate(FREE, start).fate.word == stabilab.motion(FREE, start).fate.word == "separatrix"
    assert [item.fate.word for item in stabilab.motion(FREE, states=[start, doubles])] == ["separatrix", "bounded"]
    assert float(stabilab.period(FREE, start)) == np.inf and stabilab.attitude(FREE, start).mode == "separatrix"
    assert stabilab.extremes(FREE, start)[0, 0] == 0  # it tends to the intermediate axis
    assert stabilab.period(FREE, doubles) < np.inf and stabilab.attitude(FREE, doubles).mode != "separatrix"


@pytest.mark.parametrize("form", FORMS)
def test_an_exact_start_on_a_plane_has_the_integral_of_the_plane(form):
    """x1 + b = x3 where 1 + b = 2.5 - 0.3: the paper's G3; beside it G2 has a pole of order one."""
    scene = stabilab.ScaledGyrostat(form("0.6"), form("1.2"), (0, 1, 0))
    assert stabilab.motion(scene, [form(v) for v in ("1.3", "1.3", "2.5")]).energy_integral.name == "G3"
    assert stabilab.motion(scene, [1.3, 1.3, 2.5]).energy_integral.name != "G3"  # no double is 1.3


@pytest.mark.parametrize("wrong", ["nan", "inf", "1e999999999", "1e-999999999"])
def test_a_decimal_that_is_no_double_is_bad_input(wrong):
    with pytest.raises(stabilab.InputError, match="^state: "):
        stabilab.fate(FREE, [Decimal(wrong), 0, 0])


# --- A tensor
TENSOR = [["12 kg m^2", 0.5, 0], [0.5, 9, 0], [0, 0, 7]]


def test_a_tensor_gives_the_scene_that_the_case_file_gives():
    """The file's reader turns effects and motion by code of its own, `case.body`."""
    body = stabilab.Body(TENSOR)
    scene = stabilab.Scene(body, stabilab.Gyrostat([0, "0.3 N m s", 0]), stabilab.ConstantTorque(["10 mN m", 0, 0]))
    case = stabilab.load({"body": {"inertia": TENSOR},
                          "effects": {"gyrostat": {"momentum": [0, "0.3 N m s", 0]},
                                      "constant_torque": {"torque": ["10 mN m", 0, 0]}},
                          "motion": {"angular_velocity": ["3 deg/s", 0, 0], "span": [0, 10]}})
    assert scene == case.scene and body.turned(["3 deg/s", 0, 0]) == case.state
    # the trace and the determinant of a tensor are the sum and the product of its principal moments
    assert sum(body.exact) == pytest.approx(28, rel=1e-15)
    assert float(body.exact[0] * body.exact[1] * body.exact[2]) == pytest.approx(7 * (12 * 9 - 0.25), rel=1e-15)


def test_a_diagonal_tensor_is_its_moments():
    assert stabilab.Body([[3, 0, 0], [0, 2, 0], [0, 0, 1]]) == stabilab.Body((3, 2, 1))


@pytest.mark.parametrize("wrong, words", [
    ([[1, 2, 0], [0, 1, 0], [0, 0, 1]], "not symmetric"), ([[1, 5, 0], [5, 1, 0], [0, 0, 1]], "not positive definite"),
    ([[1, 0], [0, 1], [0, 0]], "row 1: expected three numbers"), ([["1 N", 0, 0], [0, 1, 0], [0, 0, 1]], "row 1: expected moment of inertia")])
def test_a_tensor_that_is_none_is_bad_input(wrong, words):
    with pytest.raises(stabilab.InputError, match=f"inertia: .*{words}"):
        stabilab.Body(wrong)


def test_an_effect_that_is_known_along_principal_axes_alone_is_refused():
    with pytest.raises(stabilab.InputError, match="charge is known along principal axes alone"):
        stabilab.Scene(stabilab.Body(TENSOR), stabilab.Charge(1, 1, 1, 0))


# --- A case says itself again
@pytest.mark.parametrize("path", sorted(CASES.glob("*.toml")), ids=lambda path: path.stem)
def test_a_case_is_what_its_text_and_its_dict_load_as(path):
    case = stabilab.load(path)
    assert stabilab.load(case.to_toml()) == case and stabilab.load(tomllib.loads(case.text)) == case


def test_a_combination_of_a_sweep_says_itself():
    for case in load_all(CASES / "charged-sweep.toml"):
        again = stabilab.load(case.to_toml())
        assert again.scene == case.scene and again.state == case.state and not again.variant


def test_a_case_with_another_motion_says_that():
    moved = dataclasses.replace(CASE, state=(0.25, 0.5, 0.75), span=(0.0, 7.0))
    again = stabilab.load(moved.to_toml())
    assert again.state == moved.state and again.span == moved.span and again.scene == CASE.scene


@pytest.mark.parametrize("effects", [
    (stabilab.Gyrostat([0.1, "1/3", 0]), stabilab.ConstantTorque([0, 0, 0.7])),
    (stabilab.Charge("0.002", 3, "0.1", "attitude"),), (stabilab.Charge("0.002", 3, "0.1", "0.5"),),
    (stabilab.Gravity(10, [0, 0, "0.05"]), stabilab.NewtonianField(3, 7000)),
    (stabilab.NewtonianField(3), stabilab.Resistance("0.1")), (stabilab.LiquidCavity(1000, 1, 1, "printed"),),
    (stabilab.BodyForce([0, 0, 1]),)], ids=lambda effects: "+".join(one.name for one in effects))
def test_a_scene_is_the_case_that_it_makes(effects):
    scene = stabilab.Scene(stabilab.Body((3, 2, "1.5"), 2), *effects)
    state = {"omega": (0.1, Fraction(1, 3), 0.2), **({"gamma": (0, 0, 1)} if "gamma" in scene.blocks else {})}
    case = stabilab.load(scene, state, (0, 5))
    assert case.scene == scene and case.exact_state == (Fraction("0.1"), Fraction(1, 3), Fraction("0.2"))
    assert case.span == (0.0, 5.0) and stabilab.load(case.to_toml()) == case


def test_a_scaled_scene_is_the_case_that_it_makes():
    scene = stabilab.ScaledGyrostat("1/3", 0.5, (0, 0, 1))
    case = stabilab.load(scene, (1, 2, 3), 4)
    assert case.scene == scene and case.state == (1.0, 2.0, 3.0) and case.span == (0.0, 4.0)


@pytest.mark.parametrize("given, words", [
    (FILE, "state and span are those of a scene"), (3, "expected a case"), ({"body": {"inertia": [1, 2, None]}}, "NoneType"),
    ({"body": {"inertia": [1, 2, -1]}}, "^dict: body.inertia: number 3 is -1.0"), ("[body\n", "text:1: .*not TOML"), ({"x": object()}, "load: x: expected a number, a text, a list or a dict, got object")],
    ids=["state beside a file", "number", "none", "moment", "text", "object"])
def test_what_is_no_case_is_bad_input(given, words):
    with pytest.raises(stabilab.InputError, match=words):
        stabilab.load(given, *([(1, 2, 3)] if given == FILE else []))


def test_the_methods_of_a_case_take_what_the_functions_take():
    import inspect
    for name in ("fate", "motion", "extremes", "period", "equilibria", "attitude", "when", "stuck", "burn", "report"):
        own, *of_method = inspect.signature(getattr(type(CASE), name)).parameters.values()
        first, *of_function = inspect.signature(getattr(stabilab, name)).parameters.values()
        left_out = {"brief", "exact"} | ({"state", "span"} if name == "report" else set())
        assert [str(one) for one in of_method] == [str(one) for one in of_function if one.name not in left_out], name
        assert not any("Any" in str(one.annotation) and one.name not in ("events", "tell", "progress") for one in of_method), name
