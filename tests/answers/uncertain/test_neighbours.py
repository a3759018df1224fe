"""A box around an equilibrium is judged by what its neighbours do: against DOP853 and NumPy's eigenvalues, both
from Euler's equations written here."""
import json
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from stabilab.answers.uncertain.boxes import box_of
from stabilab.answers.uncertain.fate import uncertain
from stabilab.case.read import load
from tests.answers.uncertain.test_nested_boxes import written
from tests.oracles.rigid import euler
from tests.shared import in_one_line

NONE = [0.0, 0.0, 0.0]
THIN = [0.001, 0.0, 0.001]


def answer_of(case_file, rows, half):
    path = case_file(written(rows, half))
    case = load(path)
    return path, box_of(case), uncertain(case, ("fate",)).fate


def of(values):
    return tuple(np.array([float(v) for v in values[name]]) for name in ("inertia", "momentum", "torque", "state"))


def departs(values, until):
    """The largest angle, rad, between a motion and its start."""
    D, h, M, w = of(values)
    run = solve_ivp(euler(D, h, M), (0, until), w, method="DOP853", rtol=1e-9,
                    atol=1e-12, t_eval=np.linspace(0, until, 3000))
    cosine = run.y.T @ w / np.linalg.norm(run.y, axis=0) / np.linalg.norm(w)
    return float(np.arccos(np.clip(cosine, -1, 1)).max())


def growth(values):
    """The largest real part of the eigenvalues of the Jacobian, by NumPy; 0 where it is rounding."""
    D, h, M, w = of(values)
    rate = lambda x: (np.cross(D * x + h, x) + M) / D
    # of a quadratic function, central differences are exact but for rounding
    J = np.array([(rate(w + e) - rate(w - e)) / 2 for e in np.eye(3)]).T
    found = np.linalg.eigvals(J).real.max()
    return found if found > 1e-6 else 0.0


def test_beside_a_rotation_about_the_intermediate_axis_all_motions_turn_over(case_file, stabilab):
    """Euler: a disturbance grows at sqrt((D1 - D2)(D2 - D3)/(D1 D3)) = sqrt(1/3) 1/s, e-fold in sqrt(3) s."""
    path, box, over = answer_of(case_file, [[3.0, 2.0, 1.0], NONE, NONE, [0.0, 1.0, 0.0]], [NONE, NONE, NONE, THIN])
    assert over.answer == "depends" and [w.verdict for w in over.witnesses] == ["equilibrium", "bounded"]
    near = over.neighbours
    assert near.growth == pytest.approx(math.sqrt(1 / 3)) and near.turned and near.verdict == "unstable"
    for point in np.random.default_rng(4).uniform(-1, 1, (5, 2)):
        assert departs(box.values(point), 60) > math.radians(179)
    assert departs(over.witnesses[1].values, 120) == pytest.approx(near.angle, abs=2e-3)
    code, out, _ = stabilab("fate", path, "--strict")
    first = in_one_line(out).split("; margin, rate")[0]
    assert out.splitlines()[0].endswith(", BUT not always")
    assert code == 3 and " deg and turns over (unstable" in first and "departs from this rotation by up to 179.9" in first
    assert "a disturbance grows by the factor e in 1.7321 s" in first and "the same" not in first
    told = json.loads(stabilab("fate", path, "--json")[1])[0]
    assert told["uncertain"]["fate"]["neighbours"]["growth"] == pytest.approx(math.sqrt(1 / 3))
    assert any("turns over" in one["words"] for one in told["caveats"])
    assert stabilab("classify", path, "--strict")[0] == 3


def test_beside_a_stable_rotation_motions_stay_near(case_file, stabilab):
    path, box, over = answer_of(case_file, [[2.0, 3.0, 1.0], NONE, NONE, [0.0, 1.0, 0.0]], [NONE, NONE, NONE, THIN])
    near = over.neighbours
    assert (over.answer, near.verdict, near.growth, near.turned) == ("holds", "stable", 0, False)
    for point in np.random.default_rng(4).uniform(-1, 1, (6, 2)):
        assert departs(box.values(point), 30) <= near.angle
    code, out, _ = stabilab("fate", path, "--strict")
    assert code == 0 and "the equilibrium is stable, and at 36 sampled points beside it" in out


@pytest.mark.parametrize("seed", range(6))
def test_beside_an_equilibrium_of_a_gyrostat(case_file, seed):
    """A wheel along the rotation about a principal axis, and every third of them across it: H parallel to
    omega leaves the rate as it is."""
    rng = np.random.default_rng(seed)
    masses = np.round(rng.uniform(1, 4, 3), 2)
    D, k, speed = np.roll(masses, 1) + np.roll(masses, 2), seed % 3, round(rng.uniform(0.3, 2), 2)
    state, wheel = np.zeros(3), np.zeros(3)
    state[k], wheel[k] = speed, round(rng.normal(0, 1), 2)
    half = np.full(3, 0.002) * (np.arange(3) != k)
    _, box, over = answer_of(case_file, [D, wheel, NONE, state], [NONE, NONE, NONE, half])
    middle = box.values(np.zeros(2))
    near = over.neighbours
    assert near.growth == pytest.approx(growth(middle), abs=1e-9)
    assert (over.answer == "depends") == (near.verdict == "unstable") == (growth(middle) > 0)
    far = [departs(box.values(point), 60 / speed) for point in np.random.default_rng(1).uniform(-1, 1, (3, 2))]
    if growth(middle):
        assert near.angle >= max(far) - 0.02 and min(far) > 0.3
    else:
        assert near.angle >= max(far)


@pytest.mark.parametrize("rates, verdict, answer", [([0.5, -2.0, 0.0], "unstable", "depends"),
                                                    ([2.0, -0.5, 0.0], "stable", "holds")])
def test_beside_an_equilibrium_under_a_torque(case_file, rates, verdict, answer):
    """D = (20, 15, 10), M3 = 5: (D1 - D2) omega1 omega2 + 5 = 0 holds at both."""
    _, box, over = answer_of(case_file, [[20.0, 15.0, 10.0], NONE, [0.0, 0.0, 5.0], rates],
                         [NONE, NONE, NONE, [0.0, 0.0, 0.01]])
    assert (over.answer, over.neighbours.verdict) == (answer, verdict)
    values = box.values(np.zeros(1))
    assert over.neighbours.growth == pytest.approx(growth(values), abs=1e-9)
    assert (departs(box.values([1.0]), 100) > 0.5) == (verdict == "unstable")


def test_an_isolated_equilibrium_off_the_axes_has_neighbours_that_spin_up(case_file):
    """M = omega x D omega = (-2, 4, -1) at omega = (1, 1, 2); n != 0 there, so it is unstable."""
    _, box, over = answer_of(case_file, [[3.0, 2.0, 1.0], NONE, [-2.0, 4.0, -1.0], [1.0, 1.0, 2.0]],
                         [NONE, NONE, NONE, [0.0, 0.001, 0.001]])
    assert over.answer == "depends" and growth(box.values(np.zeros(2))) > 0.1
    assert over.witnesses[1].verdict.startswith("spin-up")


def test_moments_that_may_change_places_take_the_stability_with_them(case_file):
    """About axis 1 with D1 = 2.1 +- 0.3 beside 2 and 1: the major axis or the intermediate one."""
    rows, half = [[2.1, 2.0, 1.0], NONE, NONE, [1.0, 0.0, 0.0]], [0.3, 0.0, 0.0]
    _, box, over = answer_of(case_file, rows, [half, NONE, NONE, [0.0, 0.001, 0.001]])
    assert over.answer == "depends" and over.neighbours.verdict == "stable" and over.neighbours.turned
    assert departs(over.witnesses[1].values, 200) > math.radians(170)
    _, box, over = answer_of(case_file, rows, [half, NONE, NONE, NONE])
    assert [w.verdict for w in over.witnesses] == ["a stable equilibrium", "an unstable equilibrium"]
    assert [growth(w.values) > 0 for w in over.witnesses] == [False, True] and over.answer == "depends"


def test_equal_moments_let_a_rotation_across_the_axis_of_symmetry_drift(case_file):
    """omega turns about the axis of symmetry at (D3 - D1)/D1 omega3: all round, though no eigenvalue says so."""
    _, box, over = answer_of(case_file, [[2.0, 2.0, 1.0], NONE, NONE, [1.0, 0.0, 0.0]],
                         [NONE, NONE, NONE, [0.0, 0.001, 0.001]])
    assert (over.answer, over.neighbours.verdict, over.neighbours.growth) == ("depends", "unstable", 0)
    assert over.neighbours.angle > math.radians(175)


def test_a_body_at_rest_keeps_small_rates(case_file):
    _, box, over = answer_of(case_file, [[3.0, 2.0, 1.0], NONE, NONE, NONE], [NONE, NONE, NONE, THIN])
    assert over.answer == "holds" and over.neighbours.angle is None
    # |omega| <= sqrt(2 T/D3) with 2 T = (3 + 1) 1e-6, from a start of at most 0.0015
    assert over.neighbours.rate <= 0.002 + 0.0015


@pytest.mark.parametrize("effect, rates", [
    ('[effects.resistance]\ncoefficient = 0.5', '[0, "1 +- 0.001", 0]'),
    ("[effects.gravity]\nweight = 1\ncentre_of_mass = [0, 0, 1]", '["0 +- 0.001", 0, 1]\nvertical = [0, 0, 1]')])
def test_with_other_effects_nothing_is_called_the_same(case_file, stabilab, effect, rates):
    """A damped body, and a sleeping top below Lagrange's critical spin (D3^2 r^2 < 4 D1 W l)."""
    path = case_file(f"[body]\ninertia = [2, 2, 1]\n{effect}\n[motion]\nangular_velocity = {rates}\n")
    code, out, _ = stabilab("fate", path, "--strict")
    assert code == 3 and ", uncertainties undecided" in out.splitlines()[0]
    assert "undecided within the uncertainties" in out
