"""The checker of certificates: it proves what is right and refutes what is wrong, with code of its own."""
import ast
import copy
import json
import sys
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from stabilab import Body, ConstantTorque, Gyrostat, ScaledGyrostat, Scene, extremes, fate, period
from stabilab.answers.certificate import certificate
from stabilab.verify import verify
from stabilab.verify.numbers import Malformed

FOLDER = Path(__file__).parents[2] / "stabilab" / "verify"


def text(value) -> str:
    return str(Fraction(float(value)))


def around(value, share=1e-9):
    """A bracket about a number that was worked out in doubles by the analysis."""
    reach = share * (1 + abs(value))
    return [text(value - reach), text(value + reach)]


def motion_certificate(D, lam, M, state):
    """What the fast analysis says of a state, as a certificate."""
    scene = Scene(Body(D), Gyrostat(lam), ConstantTorque(M))
    found, ends, time = fate(scene, state), extremes(scene, state), float(period(scene, state))
    return {"schema": "stabilab.certificate/1",
            "scene": {"variables": "physical", "inertia": list(map(text, D)),
                      "momentum": list(map(text, lam)), "torque": list(map(text, M))},
            "motion": {"state": list(map(text, state)),
                       "fate": ["bounded", "spin-up", "separatrix", "equilibrium"][int(found.labels)],
                       "axis": int(found.axis), "sense": int(found.sense),
                       "extremes": [[around(v) if np.isfinite(v) else None for v in pair] for pair in ends],
                       "period": around(time) if 0 < time < np.inf else None}}


def random_motions(count, seed):
    rng = np.random.default_rng(seed)
    for number in range(count):
        D, axis = tuple(map(float, rng.uniform(1, 2, 3))), int(rng.integers(3))
        lam, M = rng.normal(size=3), np.zeros(3)
        lam[axis], M[axis] = 0.0, rng.normal() if number % 4 else 0.0
        lam *= number % 3 > 0
        yield D, tuple(map(float, lam)), tuple(map(float, M)), rng.normal(size=3) * 10 ** rng.uniform(-1, 1.5)


@pytest.mark.one_in(2)
@pytest.mark.parametrize("seed", range(4))
def test_fast_answers_are_proved_by_separate_code(seed):
    # the checker shares nothing with fate, extremes and period: other variables, other potential, other
    # quadrature
    for arguments in random_motions(8, seed):
        found = verify(motion_certificate(*arguments))
        assert found.status == "proved", [f for f in found.findings if f.status != "proved"]


BOUNDED = {"schema": "stabilab.certificate/1",
           "scene": {"variables": "scaled", "a": "0.2", "b": "0.4", "mu": ["0", "0", "1"]},
           "motion": {"state": ["3", "-1.5", "0.3"], "fate": "bounded", "axis": 0, "sense": 0,
                      "extremes": [[["-9", "9"], ["-9", "9"]]] * 3, "period": ["1", "30"]}}


@pytest.mark.parametrize("scene, state", [
    (Scene(Body((1.5, 2, 1))), (-2, -3, 0)),  # no force at the start, nor a whole turn on
    # the same, with a torque that the start holds in balance: (3 - 4)(-1)(-1) = -1
    (Scene(Body((3, 4, 2)), ConstantTorque((0, 0, 1))), (-1, -1, 0.5)),
    # another rate turns where the motion turns
    (ScaledGyrostat(-2, -1, (0, 2, 0)), (0, 0, 0)), (ScaledGyrostat(0, 1, (0, 0, 0)), (0, 0.5, 0)),
    (Scene(Body((5, 3, 4)), Gyrostat((0, 2, 1.5)), ConstantTorque((-3, 0, 0))), (0, 1, -4)),
    # the force vanishes a whole number of units on
    (Scene(Body((3, 2, 2)), Gyrostat((2, 0, 0)), ConstantTorque((0, 0, 0.5))), (-3, -3, -4))])
def test_a_motion_of_small_numbers_is_proved_where_signs_vanish_at_the_ends_of_a_search(scene, state):
    found = verify(json.loads(json.dumps(certificate(scene, state))))
    assert found.status == "proved", [f for f in found.findings if f.status != "proved"]


# theory: minor axis, equilibria x3 = 0, x2 (x1 + b) = -1; with a = b = 0 the hyperbola x1 = -1/t, x2 = t, m =
# 1/t^2 - t^2
HYPERBOLA = {"schema": "stabilab.certificate/1",
             "scene": {"variables": "scaled", "a": "0", "b": "0", "mu": ["0", "0", "1"]},
             "equilibria": {"kind": "curves", "points": [], "curves": [{
                 "numerators": [["-1"], ["0", "0", "1"], []], "denominator": ["0", "1"],
                 "segments": [{"t": [None, ["-1", "-1"]], "linear": "unstable", "verdict": "unstable"},
                              {"t": [["-1", "-1"], ["0", "0"]], "linear": "stable", "verdict": "stable"},
                              {"t": [["0", "0"], ["1", "1"]], "linear": "stable", "verdict": "stable"},
                              {"t": [["1", "1"], None], "linear": "unstable", "verdict": "unstable"}],
                 "folds": [{"t": [n, n], "linear": "degenerate", "verdict": "unstable"}
                           for n in ("-1", "1")]}]}}


def test_the_equilibrium_hyperbola_is_proved():
    found = verify(HYPERBOLA)
    assert found.status == "proved" and any("complete" in f.claim for f in found.findings)


# (x1 + a)(x1 + b) = mu2 mu3/mu1, x2 = -mu3/(x1 + b), x3 = mu2/(x1 + a) (theory.md, section 1); a = b = 0, mu
# = (1, 1, 1): x = +-(1, -1, 1)
POINTS = {"schema": "stabilab.certificate/1",
          "scene": {"variables": "scaled", "a": "0", "b": "0", "mu": ["1", "1", "1"]},
          "equilibria": {"kind": "points", "curves": [], "points": [
              {"box": [["0.99", "1.01"], ["-1.01", "-0.99"], ["0.99", "1.01"]], "linear": "unstable",
               "verdict": "unstable"},
              {"box": [["-1.01", "-0.99"], ["0.99", "1.01"], ["-1.01", "-0.99"]], "linear": "unstable",
               "verdict": "unstable"}]}}


def test_two_isolated_equilibria_are_proved_in_their_boxes():
    assert verify(POINTS).status == "proved"


@pytest.mark.parametrize("spoil, word", [
    (lambda c: c.update(schema="other"), "schema"), (lambda c: c["scene"].update(a="1e999999999"), "scene.a"),
    (lambda c: c["scene"].update(mu=["0", "0"]), "scene.mu"), (lambda c: c["scene"].update(a=0.2), "scene.a"),
    (lambda c: c["motion"].update(state=["x", "0", "0"]), "motion.state"),
    (lambda c: c["motion"].update(period=["3", "1"]), "motion.period")])
def test_a_malformed_certificate_is_refused_with_its_key(spoil, word):
    wrong = copy.deepcopy(BOUNDED)
    spoil(wrong)
    with pytest.raises(Malformed, match=word):
        verify(wrong)


def test_the_checker_shares_only_flint():
    for path in FOLDER.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom):
                from_package = node.module.partition(".")[0] if not node.level else "flint"
                assert from_package in {"flint", *sys.stdlib_module_names}, (path, node.module)
                assert node.level <= len(path.relative_to(FOLDER).parts), path  # its own modules
            elif isinstance(node, ast.Import):
                assert all(alias.name in {"flint", *sys.stdlib_module_names} for alias in node.names), path
