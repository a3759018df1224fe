"""Tests of `unreduced/growth_certificate.py`: what is known of the extremes of a motion that grows for ever,
and how it is told."""
from __future__ import annotations

import csv
import json
import math

import numpy as np
import pytest

import stabilab
from stabilab import Body, ConstantTorque, Gyrostat, ScaledGyrostat, Scene, errors
from stabilab.answers.digits import ask
from stabilab.unreduced.growth import captured_fate
from stabilab.unreduced.growth_certificate import captured_extremes

BALL = 2.5


def drift(lam, M, x, times):
    """omega of a body with three equal moments, D omega' = lambda x omega + M, by the exponential of its
    matrix (SciPy): no formula shared."""
    from scipy.linalg import expm
    a, b, c = np.array(lam) / BALL
    matrix = np.zeros((4, 4))
    matrix[:3, :3] = [[0, -c, b], [c, 0, -a], [-b, a, 0]]
    matrix[:3, 3] = np.array(M) / BALL
    step, y, out = expm(matrix * (times[1] - times[0])), np.array([*x, 1.0]), []
    for _ in times:
        out.append(y[:3])
        y = step @ y
    return np.array(out)


@pytest.mark.one_in(4)
@pytest.mark.parametrize("seed", range(12))
def test_a_body_of_three_equal_moments_has_its_extremes_for_all_time(seed):
    rng = np.random.default_rng(seed)
    i = int(rng.integers(3))
    lam, M = rng.normal(size=3), np.eye(3)[i] * rng.normal()
    lam[(i + 1) % 3] *= seed % 3 > 0  # a component that does not drift
    x = rng.normal(size=3) * 10.0 ** rng.uniform(-2, 1)
    scene = Scene(Body((BALL,) * 3), Gyrostat(lam.tolist()), ConstantTorque(M.tolist()))
    found = stabilab.motion(scene, x.tolist())
    assert found.extremes_over == "all time" and found.evidence["certificate"] == "law"
    run = drift(lam, M, x, np.linspace(0, 60 * math.tau * BALL / np.linalg.norm(lam), 120_001))
    for (low, high), rate in zip(found.extremes, run.T):
        near = 1e-5 * np.ptp(run, axis=0).max() + 1e-12  # the grid's turns of 3e-3, squared
        for bound, seen, way in ((low, rate.min(), -1), (high, rate.max(), 1)):
            if math.isinf(bound):
                assert bound * way > 0 and way * (run[-1] - run[0])[list(run.T[:, 0]).index(rate[0])] > 0
            else:
                assert way * (bound - seen) >= -1e-9 * abs(bound) and abs(bound - seen) <= near


def test_a_component_that_starts_on_its_way_up_is_least_at_the_start():
    """omega3' = 1/D at first and the turn never outruns the drift: by hand, with lambda along axis 3 but for
    a trace."""
    scene = Scene(Body((1, 1, 1)), Gyrostat((0.25, 0, 1)), ConstantTorque((0, 0, 1)))
    assert stabilab.motion(scene, (0.0, 0.0, 2.0)).extremes[2] == (2.0, math.inf)


@pytest.mark.parametrize("size", [1e-100, 1e100])
def test_the_extremes_of_a_law_scale_with_the_motion(size):
    """omega, lambda and the root of M in one unit: the same motion, of other size."""
    def found(u):
        scene = Scene(Body((2, 2, 2)), Gyrostat((u, 2 * u, 0)), ConstantTorque((u * 3 * u, 0, 0)))
        return np.array(stabilab.motion(scene, (u, 2 * u, 3 * u)).extremes)
    np.testing.assert_allclose(found(size) / size, found(1.0), rtol=1e-12)


SPIN = Scene(Body((3, 2, 1)), Gyrostat((1, 0, 0)), ConstantTorque((0.3, 0, 0)))
GROWING = {"axis": (Scene(Body((3, 2, 1)), Gyrostat((0, 1, 0)), ConstantTorque((0, -1, 0))), (0.0, 2.0, 0.0)),
           "law": (Scene(Body((2, 2, 2)), Gyrostat((1, 2, 0)), ConstantTorque((3, 0, 0))), (1.0, 2.0, 3.0)),
           "spin-up": (SPIN, (0.1, 0.2, 0.1)),
           "well": (ScaledGyrostat(1, 0, (1, 0, 0)), (-1.0, 0.0, 3.0))}


@pytest.mark.one_in(2)
@pytest.mark.parametrize("name", GROWING)
def test_one_state_and_arrays_have_the_same_extremes(name):
    scene, state = GROWING[name]
    one = stabilab.motion(scene, state, span=(0, 30))
    assert one.evidence["certificate"] == name
    assert stabilab.extremes(scene, [state, state],
                             span=30)[1].tolist() == [list(pair) for pair in one.extremes]
    if name in ("axis", "law"):
        assert stabilab.extremes(scene, [state])[0].tolist() == [list(pair) for pair in one.extremes]
        assert stabilab.motion(scene, state).extremes == one.extremes and one.extremes_over == "all time"
    else:
        assert stabilab.motion(scene, state).extremes is None
        with pytest.raises(errors.InputError, match="give span=T"):
            stabilab.extremes(scene, [state])


@pytest.mark.one_in(2)
@pytest.mark.parametrize("name", GROWING)
def test_digits_of_a_growing_motion_are_those_of_its_finite_entries(name):
    scene, state = GROWING[name]
    known = stabilab.motion(scene, state, span=(0, 30)).extremes
    for digits in (10, 25):
        told = ask("extremes", scene, state, digits, (0.0, 30.0))
        assert told.digits >= digits, told.because
        np.testing.assert_allclose(np.array(told.values, float), np.array(known), rtol=1e-10)
        if digits == 25:
            assert [[text in ("inf", "-inf") for text in pair]
                    for pair in told.decimals] == np.isinf(known).tolist()


def test_a_spin_up_is_run_on_to_where_its_least_rate_is_certain():
    """Over so short a span it still falls; the run to t = 60 falls no lower than what is told."""
    scene, state = ScaledGyrostat(0, "0.1", (1, 0, 0)), (4.5, 1.8, 3.4)
    answer = captured_fate(scene, state)
    short, long = (captured_extremes(scene, state, answer, span) for span in (0.02, 60.0))
    assert str(short.over).startswith("axis 1 for all time") and short.span > 0.02
    assert short.box[0].tolist() == pytest.approx(long.box[0].tolist(), rel=1e-12)
    run = stabilab.trajectory(scene, state, np.linspace(0.001, 60, 60_000)).states[:, 0]
    assert long.box[0, 1] == np.inf and long.box[0, 0] <= run.min()
    assert long.box[0, 0] == pytest.approx(run.min(), abs=1e-5)  # samples 1e-3 apart: x1'' h^2/8 off
    told = stabilab.motion(scene, state, span=(0, 0.02))
    assert told.evidence["span"] == short.span and f"[0, {short.span:g}]" in told.extremes_over


def test_before_the_start_a_growing_motion_is_told_over_its_span_alone():
    found = stabilab.motion(SPIN, (0.1, 0.2, 0.1), span=(0, -5))
    assert np.isfinite(found.extremes).all() and found.extremes_over == "s in [0, -5]"


def test_commands_tell_what_a_growing_motion_is_known_over(stabilab, tmp_path):
    path = tmp_path / "growing.toml"
    path.write_text('[body]\ninertia = [3, 2, 1]\n[effects.gyrostat]\nmomentum = [1, 0, '
                    '0]\n[effects.constant_torque]\ntorque = ["0.3", 0, 0]\n'
                    '[motion]\nangular_velocity = ["0.1", "0.2", "0.1"]\nspan = [0, 30]\n')
    told = json.loads(stabilab("extremes", path, "--json")[1])[0]
    assert told["extremes"][0] == [pytest.approx(0.1),
                                   None] and told[
                                       "over"] == "axis 1 for all time, the others over s in [0, 30]"
    rows = list(csv.reader(stabilab("extremes", path, "--csv")[1].splitlines()))
    assert rows[1][3] == "inf" and {row[4] for row in rows[1:]} == {told["over"]}
    for command in ("classify", "extremes"):
        assert "\n  the x axis for all time, the others over 0 to 30 s" in stabilab(command, path)[1]
    assert json.loads(stabilab("extremes", path, "--digits", "12", "--json")[1])[0]["digits"]["reached"] >= 12
