"""Answers at the ends of their range: infinite extremes in digits, overflowing runs, free separatrices on hyperbolas, linear models alone."""
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

import stabilab
from stabilab import Body, ConstantTorque, Gyrostat, ScaledGyrostat, Scene
from stabilab.integrate import extrema as rate_roots
from stabilab.theories.comparison import side_by_side
from stabilab.theories.follow import models_of
from stabilab.answers.motion import motion
from stabilab.cost.event_methods import fate_methods, known_period
from stabilab.cost.methods import problem
from stabilab.answers.digits.ask import ask, ask_all
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


RATES = (0.1, 0.05, 0.2)
BODIES = {"circle": (Body((12, 9, 5)), (1, 0, 0), (0, 0, 1)), "parabola": (Body((2, 2, 1)), (0, 1, 2), (1, 0, 0)),
          "hyperbola": (Body((12, 9, 5)), (1, 0, 0), (0, 1, 0)), "free": (Body((12, 9, 5)), (1, 0, 0), (0, 0, 0))}


@pytest.mark.parametrize("k", [-900, -300, 300, 900])
@pytest.mark.parametrize("name", BODIES)
def test_a_motion_in_another_unit_of_rate_is_the_same_motion(name, k):
    """Euler's equations are homogeneous (rates and wheel by u, torque by u^2, time by 1/u), and for u = 2^k the change is exact."""
    body, wheel, torque = BODIES[name]
    u, power = Fraction(2) ** k, k if abs(k) < 500 else k // 2  # the torque, which goes with the square, must stay a double
    u = Fraction(2) ** power
    made = [Scene(body, Gyrostat(tuple(Fraction(w, 5) * v for w in wheel)), ConstantTorque(tuple(Fraction(m, 50) * v * v for m in torque)))
            for v in (1, u)]
    one, far = (motion(scene, tuple(w * v for w in RATES)) for scene, v in zip(made, (1.0, float(u))))
    assert (far.fate, far.axis, far.sense) == (one.fate, one.axis, one.sense)
    np.testing.assert_allclose(np.array(far.extremes) / float(u), one.extremes, rtol=1e-11)
    assert (one.period is None) == (far.period is None) and (one.period is None or far.period * float(u) == pytest.approx(one.period, rel=1e-11))
    many = stabilab.fate(made[1], np.array(RATES) * float(u))
    assert int(many.labels) == far.fate
    np.testing.assert_allclose(stabilab.extremes(made[1], np.array(RATES) * float(u)), far.extremes, rtol=1e-11)


@pytest.mark.parametrize("rate", [1e155, 1e160, 1e200, 1e308])
def test_rates_up_to_the_largest_doubles_have_a_fate_and_no_margin_that_is_no_double(rate):
    """Torque-free in effect: the wheelless body turns about axis 1 under a torque on axis 3, bounded by its centrifugal barrier
    (D1 - D3)(D1 - D2) w1^2/... far above the torque; the period is 2 pi over w1 sqrt((D1 - D2)(D1 - D3)/(D2 D3)) (Euler)."""
    scene = Scene(Body((12, 9, 5)), ConstantTorque((0, 0, "0.02")))
    found, rows = motion(scene, (rate, 0.0, 0.0)), stabilab.fate(scene, np.array([(rate, 0, 0), (0.1, 0.05, 0.02)]))
    assert found.fate == rows.labels[0] == stabilab.Fate.BOUNDED and found.margin_energy is None
    assert np.isnan(rows.margins[0]) and "beyond the range of doubles" in found.because and "beyond the range" in rows.because[0]
    assert rows.margins[1] == stabilab.fate(scene, (0.1, 0.05, 0.02)).margins
    assert found.period == pytest.approx(2 * np.pi / rate / np.sqrt(3 * 7 / (9 * 5)), rel=1e-11)
    assert stabilab.period(scene, (rate, 0, 0)) == pytest.approx(found.period, rel=1e-12)
    least = stabilab.extremes(scene, (rate, 0, 0))[1, 0]  # D2 w2' = (D3 - D1) w3 w1, D3 w3' = M + (D1 - D2) w1 w2: 2 M/((D2 - D1) w1)
    assert least == pytest.approx(2 * 0.02 / -3 / rate, rel=1e-11) or rate > 1e300


@pytest.mark.parametrize("effects", [(Gyrostat((1, 2, 3)),), (ConstantTorque((1, 1, 0)),), (Gyrostat((1, 0, 0)), ConstantTorque((1, 0, 0)))])
@pytest.mark.parametrize("power", [-300, -160, 160, 200])
def test_scenes_without_a_reduction_answer_or_refuse_any_rate(effects, power):
    """No warning (pytest makes them errors), no overflow: a fate, or InputError in words."""
    scene, state = Scene(Body((12, 9, 5)), *effects), np.array([1.0, 0.5, -0.7]) * 10.0**power
    for ask in (stabilab.fate, lambda scene, state: motion(scene, tuple(state))):
        try:
            ask(scene, state)
        except InputError as error:
            assert "range of doubles" in str(error) or "largest double" in str(error)
