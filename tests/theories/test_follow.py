"""Analytic models as models of a case: which apply, what `compare` says of them, and sweeps."""
import json
import re
from pathlib import Path

import numpy as np
import pytest

from stabilab import Body, Gyrostat, Scene, load
from stabilab.case.read import load_all
from stabilab.errors import CaseError, InputError
from stabilab.physics.effects.resistance import Resistance
from stabilab.theories.follow import follow, models_of
from stabilab.theories.theory import compare
from tests.shared import SCALED_MINOR

CASES = Path(__file__).parents[2] / "cases"
CHARGED, SMALL = CASES / "charged-body.toml", CASES / "charged-body-small-torque.toml"


@pytest.mark.parametrize("name, models", [
    ("minor-axis-100", ("exact",)), ("charged-body", ("exact", "linear", "corrected", "printed")),
    ("charged-body-attitude", ("exact", "linear", "corrected", "printed")),
    ("top-fast", ("exact", "lindstedt", "printed"))])
def test_the_models_of_a_case_are_those_whose_assumptions_its_scene_meets(name, models):
    assert models_of(load(CASES / f"{name}.toml").scene) == models


def test_a_charge_that_follows_the_attitude_is_modelled_with_its_first_angle():
    """gamma3 = 1 at the start: k = e H l^2 = 0.003 * 100 * 1.02^2, by hand."""
    from stabilab.theories.charged import body_of
    assert float(np.max(body_of(load(CASES / "charged-body-attitude.toml")).charge_moment)) == pytest.approx(
        0.312120, rel=1e-12)


def test_a_model_that_does_not_apply_is_refused_with_those_that_do():
    with pytest.raises(InputError,
                       match="'lindstedt' does not apply to this scene; it has exact, linear, corrected, "
                             "printed"):
        follow(load(CHARGED), [1.0], "lindstedt")
    with pytest.raises(InputError, match='did you mean "linear"'):
        follow(load(CHARGED), [1.0], "liner")
    with pytest.raises(InputError, match="belong to the model"):
        follow(load(CHARGED), [1.0], "linear", method="RK45")


def test_models_have_the_parts_of_the_state_that_the_exact_motion_has():
    case = load(CHARGED)
    exact, linear = (follow(case, [0.5, 1.0], model) for model in ("exact", "linear"))
    assert list(exact.state) == list(linear.state) == ["omega", "angles", "momentum", "velocity", "position"]
    assert all(np.shape(linear.state[p]) == np.shape(exact.state[p]) for p in exact.state)


def test_the_model_printed_follows_the_print_and_the_model_corrected_the_integrals_it_means():
    """(44) of the paper: I_omega is the integral of I_Gamma, so the rate of omega is -i f3 e^(i r0 t)
    Gamma/m; (46) as typed misses that, and (61) does not vanish at t = 0."""
    from stabilab.theories.charged import body_of, printed
    case, t, h = load(CHARGED), 20.0, 1e-4
    runs = {model: follow(case, [0.0, t - h, t, t + h], model).state for model in ("corrected", "printed")}
    for model, right in (("corrected", True), ("printed", False)):
        v, angles = runs[model]["velocity"], runs[model]["angles"]
        push = -3j * np.exp(1j * angles[2, 2]) * (angles[2, 0] + 1j * angles[2, 1]) / 10
        assert (abs((v[3, 0] - v[1, 0]) / (2 * h) - push.real) < 1e-6) == right
        assert (np.abs(runs[model]["position"][0]).max() < 1e-9) == right
    np.testing.assert_array_equal(runs["printed"]["position"],
                                  printed(body_of(case), [0.0, t - h, t, t + h]).position)


def test_halving_the_torque_quarters_the_linear_models_error_or_better():
    """What the linear model drops is of second order in the tilt, so its error in omega falls at least as the
    torque squared."""
    text = SMALL.read_text()
    errors = []
    for torque in (0.008, 0.004, 0.002):
        case = _written(text.replace("torque = [0.002, 0, 0]", f"torque = [{torque}, 0, 0]"))
        errors.append(max(d.largest for d in compare(case, np.linspace(0, 20, 101)).departures
                          if d.model == "linear" and d.part == "omega"))
    assert errors[0] > 3.5 * errors[1] > 12 * errors[2] > 0


def _written(text):
    import tempfile
    path = Path(tempfile.mkdtemp()) / "case.toml"
    path.write_text(text)
    return load(path)


@pytest.mark.slow
def test_the_first_time_of_an_error_is_where_the_error_passes_it():
    case = load(CHARGED)
    for departure in compare(case, np.linspace(0, 12, 241)).departures:
        for level, time in departure.first.items():
            if time is None:
                continue
            if time == 0:  # the printed displacement does not start where the body does
                assert (departure.model,
                        departure.part) == ("printed",
                                            "position") and departure.error[0] > level * departure.scale
                continue
            around = np.array([time * 0.995, time * 1.005])
            gap = np.abs(np.asarray(follow(case, around, departure.model).state[departure.part])
                         - np.asarray(follow(case, around, "exact").state[departure.part])).max(axis=1)
            assert gap[0] <= level * departure.scale * 1.001 and gap[1] >= level * departure.scale * 0.999


PLAIN = """[body]
inertia = [8.7, {}, 11.1]
[motion]
angular_velocity = [0.02, -0.01, 0.3]
attitude = [0.01, 0.0, 0.0]
span = [0, 20]
"""


def test_a_body_without_charge_torque_and_force_is_the_first_case_of_the_linear_theory():
    """D1 = D2: Euler's equations have r constant, so the rates are exact; D1 near D2: off by the neglected p
    q."""
    case = _written(PLAIN.format("8.7"))
    assert models_of(case.scene) == ("exact", "linear", "corrected", "printed")
    t = np.linspace(0, 20, 41)
    exact, linear = (follow(case, t, model) for model in ("exact", "linear"))
    np.testing.assert_allclose(linear.state["omega"], exact.state["omega"], atol=1e-15)
    assert "r is constant" in linear.because and "small angles" in linear.because
    near = _written(PLAIN.format("8.6"))
    exact, linear = (follow(near, t, model) for model in ("exact", "linear"))
    told = float(re.search(r"changes by ([\d.e-]+) rad/s at most", linear.because)[1])
    assert 0 < np.abs(exact.state["omega"][:, 2] - 0.3).max() < told < 1e-4
    assert models_of(_written(PLAIN.format("7.0")).scene) == ("exact",)


@pytest.mark.parametrize("moment, words", [(-0.4, "unstable band"), (1.3, "none")])
def test_compare_and_simulate_name_resonances_and_the_unstable_band(stabilab, tmp_path, moment, words):
    """By hand: a = (2.5 r0 + lambda3 - k)/8.7 and b = (2.4 r0 + lambda3 - k)/8.6 have different signs for
    lambda3 = -0.4."""
    path = tmp_path / "case.toml"
    path.write_text(SMALL.read_text().replace("momentum = [0, 0, 1.3]", f"momentum = [0, 0, {moment}]"))
    a, b = ((s * 0.28274333882308139 + moment - 0.003 * 100 * 1.02**2 * np.cos(0.37)) for s in (2.5, 2.4))
    assert (a * b < 0) == (words == "unstable band")
    for command in (("compare", path), ("simulate", path, "--model", "linear", "--at", "0,1")):
        code, out, _ = stabilab(*command)
        assert code == 0 and re.search(f"resonance: {words}", out)
        found = json.loads(stabilab(*command, "--json")[1])["theory"]
        assert any(row["about"] == "resonance" and row["words"].startswith(words) for row in found)
    if a * b < 0:
        (row,) = (row for row in found if row["about"] == "instability")
        assert row["values"]["growth_rate"] == pytest.approx(np.sqrt(-a * b / 8.7 / 8.6), rel=1e-10)


def test_compare_names_the_attracting_spin_of_a_body_with_a_liquid():
    """By hand: M3 = zeta D3 r holds the spin: r = -0.06/(0.02*9) = -1/3 rad/s, reached at the rate zeta."""
    from stabilab.theories.theory import theory
    rows = theory(load(CASES / "liquid-base.toml"))
    (found,) = (row["values"] for row in rows if "attracting" in row["about"])
    assert found["spin"] == pytest.approx(-1 / 3, rel=1e-9) and found["amplitude"] == 0
    assert any(rate == pytest.approx([-0.02, 0]) for rate in found["rates"])
    assert all(row["reason"].code and str(row["reason"]) == row["words"] for row in rows)
    (steady,) = (row["reason"] for row in rows if "attracting" in row["about"])
    assert steady.quantities["spin"].value == pytest.approx(-1 / 3, rel=1e-9)  # by hand, as above


def test_the_periodic_motion_precesses_as_the_exact_one_through_it():
    from stabilab.theories.euler_angles import with_euler_angles
    from stabilab.theories.theory import theory
    case = load(CASES / "top-fast.toml")
    rows = {row["about"]: row["values"] for row in theory(case, 8)}
    turns = rows["periodic motion"]["period"] * np.array([0.0, 24.0])
    psi = with_euler_angles(case, follow(case, turns)).state["euler"][:, 0]
    assert (psi[1] - psi[0]) / turns[1] == pytest.approx(rows["periodic motion"]["precession"], rel=1e-4)


def test_simulate_gives_classical_euler_angles_when_asked_for(stabilab):
    """gamma = (sin theta sin phi, sin theta cos phi, cos theta), and phi counts whole turns between far
    times."""
    code, out, _ = stabilab("simulate", CASES / "top-fast.toml", "--at", "0,0.5,1", "--angles", "--json")
    state = json.loads(out)["state"]
    _, theta, phi = np.transpose(state["euler"])
    np.testing.assert_allclose(np.transpose(state["gamma"]),
                               [np.sin(theta) * np.sin(phi), np.sin(theta) * np.cos(phi), np.cos(theta)],
                               atol=1e-9)
    assert code == 0 and 149 < phi[2] - phi[0] < 151 and "Euler angles: theta stays away" in json.loads(out)[
        "reason"]
    code, _, err = stabilab("simulate", CASES / "minor-axis-100.toml", "--at", "1", "--angles")
    assert code == 2 and "need gamma in the state" in err


def test_every_effect_and_the_runs_of_models_have_public_names():
    import stabilab as package
    from stabilab.physics.effects import REGISTRY, effect_class
    assert {effect_class(name).__name__ for name in REGISTRY} <= set(package.__all__)
    assert all(getattr(package, name) is not None
               for name in package.__all__) and {"simulate", "compare", "theory"} <= set(package.__all__)


# --- sweeps


def test_a_sweep_file_is_every_combination_of_its_values():
    cases = load_all(CASES / "charged-sweep.toml")
    assert len(cases) == 27 and len({case.name for case in cases}) == 27
    seen = {(c.scene.effect("charge").charge, c.scene.effect("gyrostat").moment[2],
             c.scene.effect("constant_torque").vector[0])
            for c in cases}
    assert seen == {(e, l, m) for e in (0.001, 0.003, 0.005) for l in (1.3, 1.6, 1.9) for m in (4, 4.5, 5)}
    assert cases[1].name == "charged-sweep-1-1-2" and cases[1].scene.effect("constant_torque").vector[
        0] == 4.5


def test_a_file_without_a_sweep_is_one_case():
    assert [case.name for case in load_all(CHARGED)] == ["charged-body"]


@pytest.mark.parametrize("row, words", [
    ('"effects.gyrostat.moment" = [1]', "no key effects.gyrostat.moment"),
    ('"effects.gyrostat.momentum" = 3', "expected a list of the values"),
    ('"effects.gyrostat.momentum" = []', "expected a list of the values"),
    ('"title" = ["a", "b"]', "no key title")])
def test_faults_of_a_sweep_are_named_with_their_line(tmp_path, row, words):
    path = tmp_path / "sweep.toml"
    path.write_text(CHARGED.read_text() + f"\n[sweep]\n{row}\n")
    with pytest.raises(CaseError, match=words) as error:
        load_all(path)
    assert f"sweep.toml:{len(path.read_text().splitlines())}" in str(error.value)


def test_a_fault_in_one_of_the_values_is_a_fault_of_the_file(tmp_path):
    path = tmp_path / "sweep.toml"
    path.write_text(CHARGED.read_text() + '\n[sweep]\n"body.mass" = [10, -1]\n')
    with pytest.raises(CaseError, match="expected a positive number"):
        load_all(path)


def test_a_charge_of_constant_angle_is_judged_as_the_gyrostat_that_turns_alike():
    """k omega x e3 is the rate of a gyrostatic moment -k e3: same fates, extremes, periods for lambda3 - k
    (by hand)."""
    import stabilab
    from stabilab.physics.effects import effect_class
    body, torque = stabilab.Body((12, 9, 5)), stabilab.ConstantTorque((0.02, 0, 0))
    charged = stabilab.Scene(body, torque, stabilab.Gyrostat((0, 0.25, 1)),
                             effect_class("charge")(0.5, 2, 1, 0))
    twin = stabilab.Scene(body, torque, stabilab.Gyrostat((0, 0.25, 0)))
    states = np.random.default_rng(5).normal(size=(20, 3)) / 4
    np.testing.assert_array_equal(stabilab.fate(charged, states).labels, stabilab.fate(twin, states).labels)
    np.testing.assert_array_equal(stabilab.extremes(charged, states), stabilab.extremes(twin, states))
    np.testing.assert_array_equal(stabilab.period(charged, states), stabilab.period(twin, states))
    assert len(stabilab.separatrix(charged).branches) == len(stabilab.separatrix(twin).branches)
    told, same = (stabilab.motion(scene, states[0]) for scene in (charged, twin))
    assert told.fate == same.fate and told.extremes == same.extremes and "-k e3" in told.because
    assert stabilab.equilibria(charged).kind == stabilab.equilibria(twin).kind


def test_kernels_of_many_starts_refuse_a_scene_that_none_covers_by_name():
    import stabilab
    from stabilab.answers.motions.rows import fates
    from stabilab.physics.effects import effect_class
    scene = stabilab.Scene(stabilab.Body((3, 2, 2)), effect_class("resistance")(0.1))
    with pytest.raises(InputError, match="resistance"):
        fates(scene, [[1.0, 0, 0]])


def test_a_run_that_reaches_none_of_the_times_ends_with_5_and_an_empty_table(stabilab, tmp_path):
    """The printed q of this case loses its real value at 7.7 s."""
    case, out = CASES / "liquid-lambda3-0_2.toml", tmp_path / "run.csv"
    code, text, err = stabilab("simulate", case, "--model", "printed", "--at", "15,16", "--out", out)
    assert code == 5 and out.read_text().splitlines() == [
        "t (s),omega1 (rad/s),omega2 (rad/s),omega3 (rad/s),amplitude (rad/s),spin (rad/s),phase (rad)"] and "no real value" in err
    code, text, err = stabilab("simulate", case, "--model", "printed", "--at", "15")
    assert code == 5 and "NOT FOLLOWED: the printed q has no real value at t = 15" in text
    assert "ω1 (deg/s)" in text and "Traceback" not in err


@pytest.mark.parametrize("arguments",
                         [("simulate", "top-fast.toml", "--at", "1"), ("compare", "charged-body.toml"),
                                       ("simulate", "charged-body.toml", "--at", "1", "--model", "linear")])
def test_an_order_without_an_expansion_to_take_it_is_refused(stabilab, arguments):
    command, name, *rest = arguments
    code, out, err = stabilab(command, CASES / name, *rest, "--order", "2")
    assert (code, out) == (2, "") and 'order: belongs to the model "lindstedt"' in err


def test_scenes_without_a_family_of_models_have_the_exact_one():
    # averaging needs the wheel on axis 3 and moments that are alike
    rod = Scene(Body((3, 2, 1)), Resistance("0.1"), Gyrostat((1, 2, 0)))
    assert [list(models_of(scene)) for scene in (SCALED_MINOR, rod)] == [["exact"]] * 2
