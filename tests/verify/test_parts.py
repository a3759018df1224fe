"""Parts of the checker on their own: enclosures that close or say that they do not, and what each proof
needs."""
import copy
from fractions import Fraction as F

import pytest

from stabilab import Body, ConstantTorque, Gyrostat, ScaledGyrostat, Scene
from stabilab.answers.certificate import certificate
from stabilab.verify import motion, verify
from stabilab.verify.numbers import Open


def physical(D, lam=(0, 0, 0), M=(0, 0, 0)):
    return certificate(Scene(Body(D), Gyrostat(lam), ConstantTorque(M)))


CURVE = {"segments": [], "folds": []}


@pytest.mark.parametrize("made, curves", [
    # the point of rest alone; s itself as parameter, so that rest lies at infinity (D x + lambda = s x, by
    # hand)
    (physical((5, 4, 2), (0, 2, 0)), [{"numerators": [[], [], []], "denominator": ["1"]}]),
    (physical((5, 4, 2), (0, 2, 0)), [{"numerators": [[], ["2"], []], "denominator": ["-4", "1"]}]),
    # a line that is run over twice, t^2, or with one point left out, 1/t
    (physical((5, 4, 2)), [{"numerators": [["0", "0", "1"], [], []], "denominator": ["1"]}]),
    (physical((5, 4, 5), (2, 3, 0), (0, 0, -6)),
     [{"numerators": [["-1/2"], ["0", "0", "1"], []], "denominator": ["1"]}] * 3)])
def test_curves_that_leave_something_out_are_refuted(made, curves):
    forged = copy.deepcopy(made)
    forged["equilibria"]["curves"] = [CURVE | c for c in curves]
    assert verify(forged).status == "refuted"


def test_lines_of_a_conic_that_falls_apart_must_be_straight_and_two():
    made = physical((5, 4, 5), (2, 3, 0), (0, 0, -6))
    first, second = made["equilibria"]["curves"]
    squared = ({"numerators": [[r[0], "0", *r[1:]] if len(r) == 2 else r for r in first["numerators"]],
                "denominator": ["1"]} | CURVE)
    for curves in ([squared, second], [first, second, first], [first]):
        assert verify(made | {"equilibria": made["equilibria"] | {"curves": curves}}).status == "refuted"


BASE = certificate(ScaledGyrostat("0.2", "0.4", (0, 0, 1)), (3, F(-3, 2), F(3, 10)))


def test_a_motion_without_a_reduction_is_not_checked():
    oblique = {"variables": "scaled", "a": "0", "b": "1", "mu": ["1", "2", "3"]}
    claims = {"schema": BASE["schema"], "scene": oblique,
              "motion": {"state": ["1", "2", "3"], "fate": "bounded"}}
    assert [f.status for f in verify(claims).findings] == ["not checked"]
    assert verify(claims | {"motion": claims["motion"] | {"fate": "undecided"}}).status == "partly"
    along = claims | {"scene": oblique | {"mu": ["1", "0", "0"]}}  # a torque along the gyrostatic moment
    assert verify(along).status == "partly"


def test_too_few_bits_leave_fate_and_period_not_checked(monkeypatch):
    only = {k: v for k, v in BASE.items() if k != "equilibria"}
    monkeypatch.setattr(motion, "BITS", 2)
    monkeypatch.setattr(motion, "MOST_BITS", 2)
    # fate, six extremes, period
    assert {f.status for f in verify(only).findings} == {"not checked"} and len(verify(only).findings) == 8
    monkeypatch.undo()

    def open_(*_):
        raise Open
    monkeypatch.setattr(motion, "period_of", open_)
    monkeypatch.setattr(motion, "MOST_BITS", 192)
    assert {f.claim: f.status for f in verify(only).findings}["period"] == "not checked"


def test_a_box_of_any_width_is_judged_by_the_exact_zeros_in_it():
    # by hand: x = (t, -1, 1) + ..., two zeros a sign apart; test_random_scenes compares them with elimination
    # in fractions
    made = certificate(ScaledGyrostat(0, 0, (1, 2, 1)))
    for box, words in ((["-9", "9"], "holds 2 zeros"), (["0", "1/1000"], "holds 0 zeros")):
        forged = copy.deepcopy(made)
        forged["equilibria"]["points"] = [made["equilibria"]["points"][0] | {"box": [box] * 3}]
        assert verify(forged).status == "refuted" and any(words in f.reason for f in verify(forged).findings)
    half = copy.deepcopy(made)
    for point in half["equilibria"]["points"]:  # half of space each: wide, and true
        point["box"] = [["-900", "900"]] * 2 + [["-900", "0"] if F(point["box"][2][0]) < 0 else ["0", "900"]]
    assert verify(half).status == "proved" and any("one of the exact zeros" in f.reason
                                                   for f in verify(half).findings)
