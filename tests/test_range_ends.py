"""Answers at the ends of their range: infinite extremes in digits, overflowing runs, free separatrices on hyperbolas, linear models alone."""
from pathlib import Path

import numpy as np
import pytest

import stabilab
from stabilab import Body, Gyrostat, ScaledGyrostat, Scene
from stabilab.analysis import rate_roots
from stabilab.analysis.comparison import side_by_side
from stabilab.analysis.models import models_of
from stabilab.analysis.precision_answers import fate_methods, known_period
from stabilab.analysis.precision_methods import problem
from stabilab.analysis.precision_questions import ask, ask_all
from stabilab.errors import InputError

CASES = Path(__file__).parent.parent / "cases"
MINOR = ScaledGyrostat("0.2", "0.4", (0, 0, 1))


@pytest.mark.parametrize("digits", [9, 20])
def test_an_infinite_extreme_has_every_digit(digits):
    told = ask("extremes", MINOR, (0.5, 0.5, 1.0), digits)  # A^2 < 2: it spins up, x3' = 1 - ... > 0 at once
    x3 = told.values[2]
    assert float(x3[1]) == np.inf and float(x3[0]) == 1.0 and told.digits >= digits
    assert (told.decimals is None) == (digits < 16) and (told.decimals is None or told.decimals[2][1] == "inf")


def test_many_states_are_redone_one_by_one_where_the_formulas_cannot_hold_the_digits():
    rows = np.linspace((2.5, 4.0, 0.1), (2.6, 4.1, 0.2), 17)
    told = ask_all("period", MINOR, rows, 20)
    assert told.decimals.shape == (17,) and all(len(text) > 20 for text in told.decimals)
    np.testing.assert_allclose([float(text) for text in told.decimals], stabilab.period(MINOR, rows), rtol=1e-11)


@pytest.mark.parametrize("compiled", [True, False])
def test_a_run_whose_numbers_overflow_is_stopped(compiled, monkeypatch):
    if not compiled:
        monkeypatch.setattr(rate_roots, "heyoka_available", lambda: False)
    with np.errstate(all="ignore"):
        found = rate_roots.roots_of_rates(Scene(Body((3, 2, 1))), np.array([1e200, 1e200, 1e200]), 1.0)  # rates of 1e400
    assert "stopped" in found.reason and found.t_reached < 1 and np.isfinite(found.end).all()


def test_the_loops_of_a_free_hyperbola_keep_the_energy_and_the_momentum_of_their_saddle():
    D, wheel = np.array([9.0, 5.0, 4.0]), np.array([4.0, 0.0, 1.0])
    scene = Scene(Body((9, 5, 4)), Gyrostat((4, 0, 1)))
    sheets = stabilab.separatrix(scene, shape=(7, 17)).sheets
    assert sheets
    for sheet in sheets:
        for row in sheet.points.reshape(-1, *sheet.points.shape[-2:]):
            row = row[np.isfinite(row).all(axis=1)]
            for law in ((D * row**2).sum(axis=1), ((D * row + wheel) ** 2).sum(axis=1)):
                assert not len(law) or np.ptp(law) < 1e-11 * np.abs(law).max()


def followed(tmp_path, effect, rates):
    """(case, times, its models' runs) of one body with this effect from these rates."""
    path = tmp_path / "case.toml"
    path.write_text(f"[body]\ninertia = [8, 8, 10]\nmass = 5\n{effect}[motion]\nangular_velocity = {rates}\nspan = [0, 3]\n")
    case, times = stabilab.load(path), np.linspace(0, 3, 7)
    return case, times, side_by_side(case, times)[0]


def test_a_charged_body_without_an_attitude_has_the_linear_models_rates(tmp_path):
    """p + iq of D1 = D2 = 8, D3 = 10, r = 2, k = 0.3 turns at n = ((10 - 8) 2 - 0.3)/8: Euler's equations with Lambda = -k."""
    case, times, runs = followed(tmp_path, "[effects.charge]\ncharge = 0.3\nfield = 1\narm = 1\nangle = 0\n", [0.02, 0.01, 2])
    assert "linear" in models_of(case.scene) and set(runs) >= {"exact", "linear"}
    turned = (0.02 + 0.01j) * np.exp(1j * (4 - 0.3) / 8 * times)
    for name in ("exact", "linear"):
        omega = runs[name].state["omega"]
        np.testing.assert_allclose(omega[:, 0] + 1j * omega[:, 1], turned, rtol=1e-12, atol=1e-14)


def test_a_pushed_body_without_a_charge_has_the_linear_models_path(tmp_path):
    _, times, runs = followed(tmp_path, "[effects.body_force]\nforce = [0, 0, 3]\n", [0, 0, 2])
    for name in {"exact", "linear"} & set(runs):  # a spin about axis 3 pushed along it: z = F t^2/(2 m)
        np.testing.assert_allclose(runs[name].state["position"][:, 2], 0.3 * times**2, rtol=1e-10, atol=1e-12)
    assert "linear" in runs


def liquid_case(folder, torque):
    path = folder / "case.toml"
    path.write_text("[body]\ninertia = [9.2, 9.1, 9]\n[effects.gyrostat]\nmomentum = [0, 0, 0.1]\n[effects.resistance]\ncoefficient = 0.001\n"
                    f"[effects.constant_torque]\ntorque = {torque}\n[motion]\nangular_velocity = [1, 0.2, 1]\nspan = [0, 20]\n")
    return stabilab.load(path)


def test_a_model_that_does_not_fit_is_named_with_its_reason_beside_those_that_do(tmp_path):
    times = np.linspace(0, 20, 9)
    runs, refused = side_by_side(liquid_case(tmp_path, [500, 300, 0]), times)
    assert "exact" in runs and "small disturbances" in refused["averaged1"] and "small disturbances" in refused["averaged2"]
    runs, _ = side_by_side(liquid_case(tmp_path, [0, 0, -0.006]), times)
    exact, gaps = runs["exact"].state["omega"], {}
    for name in ("averaged1", "averaged2"):
        gaps[name] = np.abs(np.hypot(*(runs[name].state["omega"] - exact)[:, :2].T)).max()
    assert gaps["averaged2"] < 0.2 * gaps["averaged1"] < 0.1  # eps = 0.03: each order is worth a factor of it


def test_what_has_no_reduction_has_no_period_and_no_energies_to_measure():
    task = problem(stabilab.load(CASES / "off-axis-two.toml"), 3)
    assert known_period(task) is None and fate_methods(task) == []
    with pytest.raises(InputError):
        side_by_side(task.case, np.array([np.nan]))
