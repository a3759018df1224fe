"""A start as steady precession of a top: against runs of SciPy, and what no top does."""
from __future__ import annotations

import json
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stabilab as package
from stabilab.errors import InputError
from stabilab.physics.symmetric_top import SymmetricTop, top_rates
from tests.shared import CASES

TOP = {"body": {"inertia": ["1.74e-4", "1.74e-4", "4.8e-5"]},
       "effects": {"gravity": {"weight": "0.981", "centre_of_mass": [0, 0, "0.0375"]}},
       "motion": {"spin": "25 rev/s", "lean": "20 deg", "precession": "slow"}}
FILE = """[body]
inertia = [1.74e-4, 1.74e-4, 4.8e-5]
[effects.gravity]
weight = 0.981
centre_of_mass = [0, 0, 0.0375]
[motion]
"""


def _random(n):
    """(case or None where it is refused, rates, index and direction of the axis, lean, spin) of a symmetric body
    under its weight, a wheel, a Newtonian centre and a charge that follows the attitude, some of them."""
    rng = np.random.default_rng([61, n])
    axis, (A, C) = int(rng.integers(3)), rng.uniform(0.7, 1.3, 2)
    D, e = np.full(3, A), np.eye(3)[axis]
    D[axis] = C
    has = dict(zip("wlnc", rng.random(4) < 0.6)) | {"w": n % 4 > 0}
    arm, wheel, E = rng.normal(size=3) * [has["w"], has["l"], has["c"] and axis == 2]
    N = rng.uniform(0, 2) * (has["n"] or not has["w"])
    effects = {"gravity": {"weight": 2, "centre_of_mass": (arm * e).tolist()}} if has["w"] else {}
    effects |= {"gyrostat": {"momentum": (wheel * e).tolist()}} if wheel else {}
    effects |= {"newtonian_field": {"lambda": N * 8 / 3, "R": 2}} if N else {}  # 3 lambda/R^3 = N
    effects |= {"charge": {"charge": E, "field": 1, "arm": 1, "angle": "attitude"}} if E else {}
    lean, spin = rng.uniform(5, 175), rng.normal() * 3
    data = {"body": {"inertia": D.tolist()}, "effects": effects, "motion": {
        "spin": spin, "lean": f"{lean} deg", "precession": ("slow", "fast")[n % 2],
        "towards": rng.normal(size=3).tolist()}}

    def rates(t, y):
        w, g = y[:3], y[3:]
        torque = np.cross(2 * arm * e, g) + N * np.cross(g, D * g) + E * g[2] * np.cross(w, [0, 0, 1])
        return [*((np.cross(D * w + wheel * e, w) + torque) / D), *np.cross(g, w)]
    side = -1 if arm < 0 else 1
    try:
        return package.load(data), rates, axis, side, math.radians(lean), spin
    except InputError as error:
        # the lateral balance at this lean and spin, written out once more, has no real root
        u = math.cos(math.radians(lean))
        L, pull = C * spin + side * wheel + E * u, abs(2 * arm) + N * (C - A) * u
        assert L * L < 4 * A * u * pull and "precesses steadily with a spin of at least" in str(error)
        return None, rates, axis, side, math.radians(lean), spin


@pytest.mark.first(10, 60)
@pytest.mark.parametrize("n", range(200))
def test_a_top_that_starts_in_steady_precession_stays_at_its_lean(n):
    """Oracle: a run by SciPy of equations written here; the axis turns about the vertical at the rate found."""
    case, rates, axis, side, lean, spin = _random(n)
    if case is None:
        return
    start = np.array(case.start)
    assert side * start[axis] == pytest.approx(spin, rel=1e-12, abs=1e-12)
    end = 6.0 / max(1.0, float(np.abs(start[:3]).max()))
    run = solve_ivp(rates, (0, end), start, method="DOP853", rtol=1e-12, atol=1e-14, t_eval=np.linspace(0, end, 60))
    np.testing.assert_allclose(-side * run.y[3 + axis], math.cos(lean), rtol=0, atol=1e-9)
    np.testing.assert_allclose(side * run.y[axis], spin, rtol=0, atol=1e-9 * (1 + abs(spin)))
    found = top_rates(case.scene, case.start)
    # omega = W up + (...) e: its part across e over that of up is W
    up, e = -start[3:], side * np.eye(3)[axis]
    W = (start[:3] @ up - spin * (up @ e)) / (1 - (up @ e) ** 2)
    assert any(W == pytest.approx(rate, rel=1e-9) for rate in found.steady)
    assert abs(W) == pytest.approx((min if n % 2 == 0 else max)(map(abs, found.steady)), rel=1e-9)


# of 400 scenes only that of 316 is unstable
@pytest.mark.parametrize("n", [*range(4), 316, *(pytest.param(n, marks=pytest.mark.slow) for n in range(4, 40))])
def test_a_steady_precession_is_stable_with_the_nutation_of_its_linear_motion(n):
    """Oracle: eigenvalues of central differences of equations written here, in the frame that turns about the
    axis so that the steady precession rests in it."""
    case, rates, axis, *_ = _random(n)
    if case is None:
        return
    start, e = np.array(case.start), np.eye(3)[axis]
    turn = lambda y: np.concatenate([np.cross(e, y[:3]), np.cross(e, y[3:])])
    at, circle = np.array(rates(0, start)), turn(start)
    resting = lambda y: np.array(rates(0, y)) - (at @ circle) / (circle @ circle) * turn(y)
    np.testing.assert_allclose(resting(start), 0, atol=1e-9 * (1 + np.abs(start).max() ** 2))
    J = np.array([(resting(start + h) - resting(start - h)) / 2e-6 for h in 1e-6 * np.eye(6)]).T
    roots, found = np.linalg.eigvals(J), top_rates(case.scene, case.start)
    which = 0 if n % 2 == 0 else -1
    assert found.stable[which] == (roots.real.max() < 1e-3 * np.abs(roots).max()) == (n != 316)
    if n != 316:
        assert found.nutation[which] == pytest.approx(np.abs(roots.imag).max(), rel=1e-6)
    else:
        assert found.nutation[which] is None


def test_a_small_nutation_has_the_period_of_lagranges_cubic():
    """The same motion by elliptic integrals, a thousandth of a degree beside the steady precession."""
    top = package.load(TOP).attitude().top
    beside = package.load(TOP | {"motion": TOP["motion"] | {"lean": "20.001 deg"}})
    rates = list(map(float, beside.start[:3]))
    rates[1] += 1e-3
    moved = package.attitude(beside.scene, {"omega": rates, "gamma": beside.start[3:]})
    assert moved.nutation_period == pytest.approx(2 * math.pi / top.nutation[0], rel=1e-4)


@pytest.mark.parametrize("n", range(12))
def test_upright_and_hanging_are_unstable_between_the_spins_that_are_said(n):
    """Oracle: eigenvalues of central differences of equations written here, a thousandth inside and outside."""
    case, rates, axis, side, _, _ = next(row for row in (_random(1000 + 7 * n + k) for k in range(40)) if row[0])
    found = top_rates(case.scene, case.start)
    for up, ends in ((1, found.upright), (-1, found.hanging)):
        tries = [(end * (1 + k * 1e-3) + k * 1e-6 * (1 if end > 0 else -1), k > 0) for end in ends
                 for k in (-1, 1) if end and ends[0] < 0 < ends[1]] if ends else [(0.7, True)]
        for spin, stable in tries:
            at = np.concatenate([side * spin * np.eye(3)[axis], -side * up * np.eye(3)[axis]])
            J = np.array([(np.array(rates(0, at + h)) - rates(0, at - h)) / 2e-6 for h in 1e-6 * np.eye(6)]).T
            growth = np.linalg.eigvals(J).real.max()
            assert (growth < 1e-5) == stable, (up, spin, ends, growth)


def test_a_toy_top_has_the_rates_of_the_quadratic_by_hand():
    """A W^2 cos - C s W + M g l = 0 by NumPy; sleeping from 2 (A M g l)^(1/2)/C on (Lagrange)."""
    s, u = 50 * math.pi, math.cos(math.radians(20))
    expected = sorted(np.roots([1.74e-4 * u, -4.8e-5 * s, 0.981 * 0.0375]))
    for which, rate in zip(("slow", "fast"), expected):
        case = package.load(TOP | {"motion": TOP["motion"] | {"precession": which}})
        top = case.attitude().top
        assert top.steady == pytest.approx(expected, rel=1e-12) and top.lean == pytest.approx(math.radians(20))
        assert case.attitude().precession_period == pytest.approx(2 * math.pi / rate, rel=1e-12)
        assert case.attitude().nutation_period is None and "keeps its lean" in case.attitude().because
    limit = 2 * math.sqrt(1.74e-4 * 0.981 * 0.0375) / 4.8e-5
    assert top.upright == pytest.approx((-limit, limit), rel=1e-14) and top.hanging is None


def test_a_level_axis_has_the_one_rate_of_a_gyroscope():
    """M g l/(C s), by hand; at rest with no weight and no centre it is no top."""
    case = package.load(TOP | {"motion": TOP["motion"] | {"lean": "90 deg"}})
    top = top_rates(case.scene, case.start)
    assert top.steady[0] == pytest.approx(0.981 * 0.0375 / (4.8e-5 * 50 * math.pi), rel=1e-12)
    assert SymmetricTop.of(package.load({"body": {"inertia": [2, 2, 1]}}).scene) is None


def test_below_the_vertical_both_directions_are_there_without_spin():
    """A conical pendulum, by hand: W^2 = M g l/(A |u|)."""
    case = package.load(TOP | {"motion": TOP["motion"] | {"lean": "120 deg", "spin": 0}})
    rate = math.sqrt(0.981 * 0.0375 / (1.74e-4 * 0.5))
    assert top_rates(case.scene, case.start).steady == pytest.approx((rate, -rate), rel=1e-12)


def test_a_full_tensor_has_the_same_top_in_its_own_frame():
    """J = R diag(2, 2, 1) R^T with the rational R of the columns below, by hand; oracle: NumPy, in the frame of the
    file: the axis is R e3, and J w precesses with the axis about the vertical."""
    R = np.array([[2, -1, 2], [2, 2, -1], [-1, 2, 2]]) / 3
    e = R[:, 2]
    case = package.load({"body": {"inertia": [["14/9", "2/9", "-4/9"], ["2/9", "17/9", "2/9"], ["-4/9", "2/9", "14/9"]]},
                         "effects": {"gravity": {"weight": 1, "centre_of_mass": ["2/3", "-1/3", "2/3"]}},
                         "motion": {"spin": 9, "lean": 0.5, "precession": "fast"}})
    axes = np.array([[float(v) for v in row] for row in case.frame.axes])
    omega, down = axes.T @ case.state, axes.T @ case.blocks["gamma"]
    assert omega @ e == pytest.approx(9, rel=1e-13) and -down @ e == pytest.approx(math.cos(0.5), rel=1e-13)
    # steady: H' = H x omega + e x down is that of a vector that turns with omega - W up, about e alone
    W = max(np.roots([2 * math.cos(0.5), -9, 1]))
    turn = omega + W * down
    assert np.cross(turn, e) == pytest.approx(np.zeros(3), abs=1e-12)


@pytest.mark.parametrize("motion, line, words", [
    ('spin = "12 rev/s"\nlean = "20 deg"\nprecession = "slow"', 7, "a spin of at least 102.1895362 rad/s"),
    ('spin = "12 rev/s"\nlean = "20 deg"\nprecession = "slow"', 7, "at a lean from 59.2323 to 180 deg"),
    ('spin = 1\nlean = "20 deg"', 8, 'give precession = "slow" or "fast" as well'),
    ('lean = "20 deg"', 7, 'give spin = "25 rev/s" and precession ='),
    ('precession = "slow"\nspin = 1', 7, 'give lean = "20 deg" as well'),
    ('spin = 200\nlean = "20 deg"\nprecession = "quick"', 9, 'expected "slow" or "fast", got the text "quick"'),
    ('spin = 200\nlean = 0\nprecession = "slow"', 8, "expected an angle between 0 and 180 deg"),
    ('spin = 200\nlean = "200 deg"\nprecession = "slow"', 8, "got 200 deg"),
    ('spin = 200\nlean = "90 deg"\nprecession = "fast"', 9, "a level axis has one rate"),
    ('spin = 0\nlean = "90 deg"\nprecession = "slow"', 7, "a level axis falls"),
    ('spin = 200\nlean = "20 deg"\nprecession = "slow"\ntowards = [0, 0, 2]', 10, "lies along the axis of the top"),
    ('spin = 200\nlean = "20 deg"\nprecession = "slow"\nvertical = [0, 0, 1]', 10, "in two ways"),
    ('spin = 200\nlean = "20 deg"\nprecession = "slow"\nnutation = 1', 10, "in two ways"),
    ('spin = 200\nlean = "20 deg"\nprecession = "slow"\nangular_velocity = [0, 0, 1]', 10, "in two ways"),
    ('spin = 200\nlean = "20 deg"\nprecession = "slow"\naxis = [0, 0, 1]', 10, "take axis away"),
])
def test_what_is_no_start_of_a_top_is_one_error_with_line_and_cure(stabilab, case_file, motion, line, words):
    path = case_file(FILE + motion + "\n")
    code, out, err = stabilab("fate", path)
    assert code == 2 and not out and words in err and err.count(f"{path}:") == 1
    assert f"{path}:{line}: " in err


@pytest.mark.parametrize("change", [
    {"body": {"inertia": [3, 2, 1]}}, {"effects": {}},
    {"effects": {"gravity": {"weight": 1, "centre_of_mass": ["0.1", 0, 1]}}},
    {"effects": TOP["effects"] | {"gyrostat": {"momentum": [1, 0, 0]}}},
    {"effects": TOP["effects"] | {"constant_torque": {"torque": [0, 0, 1]}}}])
def test_what_is_no_symmetric_top_has_no_such_start(change):
    with pytest.raises(InputError, match="that of a symmetric top"):
        package.load(TOP | change)


def test_the_case_is_written_as_it_was_stated_and_the_explorer_starts_from_its_rates():
    from stabilab.show.explore.parameters import changed
    from stabilab.show.units import units_of
    case = package.load(TOP)
    assert package.load(case.to_toml()) == case and "lean" in case.to_toml()
    moved, *_ = changed(case, {"inertia": ["5e-5", None, None]}, units_of(case))
    assert not moved.observed and moved.state == pytest.approx(case.state, rel=1e-15)
    assert moved.blocks["gamma"] == pytest.approx(case.blocks["gamma"], rel=1e-15)


def test_fate_classify_and_attitude_print_both_rates_and_the_critical_spin(stabilab):
    path = CASES / "toy-top.toml"
    for command in ("fate", "classify", "attitude"):
        text = stabilab(command, path)[1]
        assert "steady precession       slow 320.9 deg/s or fast 2171 deg/s, both stable, at a lean" in text
        assert "small nutation          period 0.19526 s about the slow one, 0.194262 s about the fast" in text
        assert "upright                 stable from a spin of 6039.99 deg/s on" in text
    row = json.loads(stabilab("attitude", path, "--json")[1])["rows"][0]
    classified, = json.loads(stabilab("classify", path, "--json")[1])
    decided, = json.loads(stabilab("fate", path, "--json")[1])
    assert row["top"] == classified["top"] == decided["top"] and len(row["top"]["steady_precession"]) == 2
    assert row["top"]["steady_stable"] == [True, True] and package.load(path).motion().top.stable == (True, True)
