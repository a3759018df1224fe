"""Certificates of the program's answers are proved by the separate checker, on cases of every kind."""
import json
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from stabilab import Body, ConstantTorque, Gyrostat, ScaledGyrostat, Scene, load
from stabilab.answers.certificate import certificate
from stabilab.verify import verify

CASES = sorted((Path(__file__).parents[2] / "cases").glob("*.toml"))


def checked(scene, state=None):
    """The findings on a certificate that went through its file's form."""
    return verify(json.loads(json.dumps(certificate(scene, state))))


@pytest.mark.one_in(8)
@pytest.mark.parametrize("path", CASES, ids=lambda p: p.stem)
def test_the_certificate_of_a_case_is_proved(path):
    case = load(path)
    found = checked(case.scene, case.state) if case.scene.plain else None
    if found is None:
        assert certificate(case.scene)["uncertified"]  # says why there is none
        return
    assert found.status == "proved", [f for f in found.findings if f.status != "proved"]


def small(rng):
    """A small rational: degenerate scenes (equal moments, aligned vectors, folds) come up often."""
    return Fraction(int(rng.integers(-3, 4)), int(rng.choice([1, 2, 4])))


def random_scene(rng, degenerate):
    if rng.random() < 0.3:
        pick = small if degenerate else (lambda r: Fraction(float(r.normal())))
        return ScaledGyrostat(pick(rng), pick(rng), tuple(pick(rng) for _ in range(3)))
    D = ([Fraction(int(v)) for v in rng.integers(2, 5, 3)] if degenerate
         else [Fraction(float(v)) for v in rng.uniform(1, 2, 3)])
    pick = small if degenerate else (lambda r: Fraction(float(r.normal())))
    lam, M = ([pick(rng) if rng.random() < 0.6 else Fraction(0) for _ in range(3)] for _ in range(2))
    return Scene(Body(D), Gyrostat(lam), ConstantTorque(M))


@pytest.mark.parametrize("degenerate", [False, True], ids=["generic", "degenerate"])
@pytest.mark.parametrize("count, seed", [(60, 1), pytest.param(1000, 2, marks=pytest.mark.slow)])
def test_no_equilibrium_is_missed_or_invented(degenerate, count, seed):
    # exact elimination by the checker: common real roots of the rates on the line, the conic, or the curve
    # where the conditions meet
    rng = np.random.default_rng(seed + degenerate)
    for _ in range(count):
        scene = random_scene(rng, degenerate)
        left = [f for f in checked(scene).findings if f.status != "proved"]
        assert not left, (scene, left)


@pytest.mark.one_in(2)
@pytest.mark.parametrize("seed", range(3))
def test_a_motion_is_proved_for_states_of_any_size(seed):
    rng = np.random.default_rng(seed)
    for _ in range(6):
        scene = ScaledGyrostat(float(rng.normal()), float(rng.normal()), (0, 0, float(rng.choice([-1, 1]))))
        state = rng.normal(size=3) * 10 ** rng.uniform(-6, 6)
        found = checked(scene, tuple(map(float, state)))
        assert found.status == "proved", [f for f in found.findings if f.status != "proved"]


def test_a_state_at_an_exact_equilibrium_is_one_and_its_neighbour_is_not():
    scene = ScaledGyrostat(0, 0, (0, 0, 1))  # x2 x1 = -1 (theory.md, section 1)
    assert certificate(scene, (Fraction(-3), Fraction(1, 3), 0))["motion"]["fate"] == "equilibrium"
    near = certificate(scene, (-3.0, 1 / 3, 0.0))["motion"]  # the double nearest 1/3 is no equilibrium
    assert near is None or near["fate"] != "equilibrium"


def test_the_decimals_of_a_case_are_certified_as_they_were_written(case_file):
    # x2 (x1 + b) = -1 at (-10.1, 0.1, 0) exactly (theory.md, section 1): no double is 0.1
    path = case_file('[scaled]\na = 0.1\nb = 0.1\nmu = [0, 0, 1]\n[motion]\nx = [-10.1, 0.1, 0]\n', "tenth")
    case = load(path)
    assert case.exact_state[1] == Fraction(1, 10) != case.state[1]
    assert certificate(case.scene, case.exact_state)["motion"]["fate"] == "equilibrium"


@pytest.mark.parametrize("name, code, words",
                         [("minor-axis-100", 0, "PROVED: "), ("symmetric-body", 0, "PROVED: "),
                          ("charged-body", 3, "no claims")])
def test_certify_writes_what_verify_proves(name, code, words, tmp_path, capsys, monkeypatch):
    import sys

    from stabilab.cli import main
    path = tmp_path / "certificate.json"

    def run(*arguments):
        monkeypatch.setattr(sys, "argv", ["stabilab", *map(str, arguments)])
        with pytest.raises(SystemExit) as end:
            main()
        return end.value.code, capsys.readouterr()
    case = Path(__file__).parents[2] / "cases" / f"{name}.toml"
    assert run("classify", case, "--certify", "--out", path, "--strict")[0] == code
    found, printed = run("verify", path, "--strict")
    assert found == code and words in printed.out
    path.write_text(path.read_text(encoding="utf-8").replace('"fate": "bounded"', '"fate": "spin-up"'),
                    encoding="utf-8")
    if "bounded" in printed.out:
        assert run("verify", path)[0] == 5
    path.write_text("[]", encoding="utf-8")
    assert run("verify", path)[0] == 2


def test_the_end_of_a_decaying_plane_is_only_approached_and_its_bracket_holds_it():
    # on x1 + b = -x3 both decay to 0 exactly (cases/middle-axis-spin-up.toml): exp(-8192) instead of 0 stood
    # there
    found = certificate(ScaledGyrostat("0.5", 1, (0, 1, 0)),
                        (Fraction(1, 2), -1, Fraction(-3, 2)))["motion"]["extremes"]
    low, high = map(Fraction, found[2][1])
    assert low <= 0 <= high < Fraction(1, 10**300)


@pytest.mark.parametrize("scene, state", [
    # x1^2 + x2^2 = 2: the force is 1 + sin 2 theta (theory.md, section 1: fold at A^2 = 2)
    (ScaledGyrostat(0, 0, (0, 0, 1)), (1, 1, -3)),
    # |c| = 2: on the plane it is -(x3 - 1)^2
    (ScaledGyrostat(-2, 0, (0, -1, 0)), (Fraction(1, 2), Fraction(1, 4), Fraction(1, 2))),
    (ScaledGyrostat("-0.25", "1.75", (0, -1, 0)), (Fraction(1, 2), 0, Fraction(9, 4)))])
def test_a_force_that_touches_zero_without_changing_sign_leaves_the_spin_up_proved(scene, state):
    assert certificate(scene, state)["motion"]["fate"] == "spin-up"
    assert checked(scene, state).status == "proved"


def test_planes_of_equilibria_are_claimed_with_their_centre():
    # by hand: D = (2, 2, 1), lambda along axis 3: at omega3 = lambda3/(2 - 1) momentum is 2 omega, whatever
    # omega1 and omega2 are
    (plane,) = certificate(Scene(Body((2, 2, 1)), Gyrostat((0, 0, 3)),
                                 ConstantTorque((0, 0, 0))))["equilibria"]["planes"]
    assert plane["base"] == plane["centre"]["at"] == ["0", "0", "3"]
    assert plane["directions"] == [["1", "0", "0"], ["0", "1", "0"]]
    assert plane["verdict"] == "unstable" and plane["centre"]["verdict"] == "stable"
