"""Tensors that no rigid body has: silent within the digits given, a caveat beyond them, and the answer
follows."""
import math
from fractions import Fraction

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

import stabilab
from stabilab import Body, ConstantTorque, Gyrostat, Scene
from stabilab.case.read import read_text
from stabilab.errors import CaseError
from stabilab.numbers.exact import half_unit
from tests.oracles.rigid import euler


def caveats(inertia, more=""):
    return read_text("own.toml", f"[body]\ninertia = {inertia}\n{more}").caveats


@pytest.mark.parametrize("written, half", [
    ("0.333", "0.0005"), ("2.50", "0.005"), ("1e3", 0), ("1.20e-2", "0.00005"), ("5174", "0.5"), ("100", 0),
    ("2/3", 0), (7, 0),
    (12345, "0.5"), (0.25, "0.005"), (Fraction(1, 3), 0)])  # by hand
def test_half_a_unit_of_the_last_digit(written, half):
    assert half_unit(written) == Fraction(half)


@pytest.mark.parametrize("digits", ["%.6f", "%#.6g", "%.3f"])
def test_a_flat_plate_printed_in_any_frame_is_a_body(digits):
    """diag(1, 2, 3) is a flat plate: the triangle inequality is an equality, and rounding breaks it by 1e-7
    in about half of all frames."""
    rng, broken = np.random.default_rng(29), 0
    for frame in Rotation.random(16, rng).as_matrix():
        printed = [[digits % v for v in row] for row in frame @ np.diag([1.0, 2, 3]) @ frame.T]
        moments = np.linalg.eigvalsh(np.array(printed, float))
        broken += 2 * moments[-1] > moments.sum()
        assert not caveats(f"[{', '.join(f'[{chr(44).join(row)}]' for row in printed)}]")
    assert 4 < broken < 13


@pytest.mark.parametrize("inertia, largest, others, excess", [  # sums by hand
    ("[100.0, 100.0, 300.0]", "300", "200", "100"),      # Demo/SC_Spinner of NASA's 42
    ("[5174.0, 3593.0, 245.4]", "5174", "3838.4", "1335.6"),  # its SC_TumbleSat, body 0
    ("[4.0, 2.0, 1.0]", "4", "3", "1"),                  # its SC_BBM
    ("[8, 4, 0.4]", "8", "4.4", "3.6"), ("[1, 2, 3.5]", "3.5", "3", "0.5"),
    ('["4 g cm^2", "2 g cm^2", "1 g cm^2"]', "4e-07", "3e-07", "1e-07"),
    # the trace less the moment that stands alone
    ("[[3, 0, 0], [0, 2, 0.1], [0, 0.1, 0.5]]", "3", "2.5", "0.5")])
def test_a_larger_excess_is_a_caveat_with_its_size_in_decimals(inertia, largest, others, excess):
    (found,) = caveats(inertia)
    assert found.kind == "unphysical"
    assert f"{largest} kg m^2, exceeds the sum of the other two, {others}, by {excess} (" in found.words


def test_the_digits_given_are_the_bound():
    """Half a unit of each of three last digits: 0.0015 in all."""
    assert not caveats("[1.000, 2.000, 3.001]") and caveats("[1.000, 2.000, 3.002]")
    kinds = lambda inertia: [found.kind for found in caveats(inertia)]
    assert kinds("[1, 2, 3.001]") == ["unphysical"] and "unphysical" not in kinds('["1 +- 0.01", 2, 3.001]')
    assert "unphysical" in kinds('["1 +- 0", 2, 3.001]')
    assert not caveats('["1.000 kg m^2", 2.000, "3001000 kg mm^2"]')


def test_products_have_digits_too():
    """[[2, p], [p, 2]] has the moments 2 + p and 2 - p, by hand: with 1 the excess is 2 p - 1."""
    form = "[2, 2, 1.0]", '[body.products]\nxy = {}\nconvention = "negative"\n'
    assert not caveats(form[0], form[1].format("0.50")) and not caveats(form[0], form[1].format("0.52"))
    assert caveats(form[0], form[1].format("0.60"))[0].words.count("by 0.2 ")


def test_python_has_it_of_the_body_and_rounding_of_doubles_is_silent():
    assert Body((4, 2, 1)).caveats and not Body(("0.333", "0.333",
                                                 "0.667")).caveats and not Body((1, 2, 3)).caveats
    moments = np.linalg.eigvalsh(np.array([[1.7, 0.3, 0.1], [0.3, 1.4, 0.2], [0.1, 0.2, 1.1]]))
    assert not Body((*moments[:2], moments[0] + moments[1] + 4e-16)).caveats


def test_moments_that_are_not_positive_stay_errors():
    for inertia in ("[1, -2, 3]", "[0, 1, 1]", "[[1, 2, 0], [2, 1, 0], [0, 0, 1]]"):
        with pytest.raises(CaseError, match="positive"):
            caveats(inertia)


def _torques(rng):
    moments = (1, *(10 ** rng.uniform(-1.5, -0.35, 2)))  # the largest exceeds the sum of the others
    torque = np.zeros(3)
    torque[rng.integers(3)] = rng.normal() / 10
    return rng.permutation(moments), rng.normal(size=3) / 5 * (rng.random(3) < 0.6), torque


def test_fates_extremes_and_equilibria_are_those_of_eulers_equations():
    """DOP853 and the eigenvalues of a Jacobian by NumPy, for moments that break the triangle inequality."""
    rng, words = np.random.default_rng(11), []
    for _ in range(8):
        D, wheel, torque = _torques(rng)
        start, scene = rng.normal(size=3), Scene(Body(tuple(D)), Gyrostat(tuple(wheel)),
                                                 ConstantTorque(tuple(torque)))
        assert scene.body.caveats
        rate = euler(D, wheel, torque)
        found = stabilab.motion(scene, tuple(start))
        words.append(found.fate.word)
        run = solve_ivp(rate, (0, 5), start, method="DOP853", rtol=1e-9, atol=1e-10, dense_output=True)
        seen = run.sol(np.linspace(0, 5, 2000)).T
        if found.fate.word == "bounded":
            low, high = np.array(found.extremes).T
            size = np.abs(found.extremes).max()
            assert (seen > low - 1e-7 * size).all() and (seen < high + 1e-7 * size).all()
            if found.period and found.period < 5:
                assert np.abs(seen.min(0) - low).max() < 1e-3 * size > np.abs(seen.max(0) - high).max()
        for point in stabilab.equilibria(scene).points:
            at = np.array(point.at)
            slopes = np.array([rate(0, at + h) - rate(0, at - h) for h in 1e-6 * np.eye(3)]).T / 2e-6
            assert np.abs(rate(0, at)).max() < 1e-9 * (1 + (at @ at))
            growth = np.linalg.eigvals(slopes).real.max()
            assert math.isclose(growth, 0, abs_tol=1e-3) or (point.verdict == "unstable") == (growth > 0)
    assert {"bounded", "spin-up"} <= set(words)


def test_certificates_of_such_a_body_are_proved(stabilab, tmp_path):
    path, proof = tmp_path / "own.toml", tmp_path / "own.json"
    path.write_text(
        "[body]\ninertia = [8, 4, 0.4]\n[effects.constant_torque]\ntorque = [0, 0, "
        "0.1]\n[motion]\nangular_velocity = [0.1, 0.2, 0.3]\n")
    assert stabilab("classify", path, "--certify", "--out", proof)[0] == 0
    code, out, err = stabilab("verify", proof)
    assert code == 0 and "proved" in out.lower()


def test_a_liquid_proves_nothing_of_a_body_that_does_not_exist():
    """T' = -kappa/(D1 D2 D3) sum (Di - Dj)^2 (Di + Dj - Dk) wi^2 wj^2 (SymPy, tests/physics/test_laws) is
    positive at (1, 1, 0) for D = (2, 1, 4)."""
    liquid = stabilab.LiquidCavity(1250, 1000, "1.9")
    scene = Scene(Body((2, 1, 4)), liquid)
    assert stabilab.motion(scene, (1, 1, 0)).fate.word == "undecided"
    assert stabilab.equilibria(scene).kind == "undecided"
    whole = Scene(Body((2, 3, 4)), liquid)
    assert stabilab.motion(whole,
                           (1, 1, 0)).fate.word == "bounded" and stabilab.equilibria(whole).kind == "curves"


@pytest.mark.parametrize("command", [["fate"], ["classify"], ["extremes"], ["period"],
                                     ["sweep", "--vary", "torque[3]=0:1:2"]], ids=lambda given: given[0])
def test_strict_leaves_with_3_and_without_it_the_answer_follows(stabilab, tmp_path, command):
    path, name = tmp_path / "own.toml", command[0]
    path.write_text(
        "[body]\ninertia = [8, 4, 0.4]\n[effects.constant_torque]\ntorque = [0, 0, "
        "0.1]\n[motion]\nangular_velocity = [0.1, 0.2, 0.3]\n")
    assert stabilab(name, path, *command[1:])[0] == 0
    assert stabilab(name, path, *command[1:], "--strict")[0] == 3
    path.write_text(path.read_text().replace("[8, 4, 0.4]", "[8, 4, 5]"))
    assert stabilab(name, path, *command[1:], "--strict")[0] == 0


def test_a_tensor_that_doubles_made_unsymmetric_is_read():
    """Q diag(1, 2, 3) Q^T by NumPy, all digits printed: entries across the diagonal differ by a unit in their
    last place."""
    frame = Rotation.random(None, np.random.default_rng(3)).as_matrix()
    tensor = frame @ np.diag([1.0, 2, 3]) @ frame.T
    tensor[0, 1] = np.nextafter(tensor[1, 0], 9)
    read = read_text("own.toml", f"[body]\ninertia = {tensor.tolist()}\n")
    assert sorted(read.scene.body.inertia) == pytest.approx([1, 2, 3], abs=1e-14) and not read.caveats


@pytest.mark.parametrize("command", [["sweep", "--vary", "torque[3]=0:1:2"], ["atlas"], ["explore"],
                                     ["basin", "--vary", "velocity[1]=0:1", "--vary", "velocity[2]=0:1"],
                                     ["bifurcation", "--vary", "torque[3]=0:1"]], ids=lambda given: given[0])
def test_a_fault_in_the_table_sweep_of_a_file_is_one_for_commands_that_leave_its_values_aside(
        stabilab, tmp_path, command):
    path = tmp_path / "own.toml"
    path.write_text(
        "[body]\ninertia = [8, 4, 5]\n[effects.constant_torque]\ntorque = [0, 0, 0.1]\n[motion]\n"
        'angular_velocity = [0.1, 0.2, 0.3]\n[sweep]\n"body.inertia" = [[8, 4, 5], [8, 4, "5 s"]]\n')
    code, out, err = stabilab(command[0], path, *command[1:])
    assert (code, out, err.strip().count("\n")) == (2, "", 0)
    assert f"{path}:8: body.inertia: " in err and "a value of [sweep]" in err
