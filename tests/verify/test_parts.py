"""Parts of the checker on their own: enclosures that close or say that they do not, and what each proof
needs."""
import copy
from fractions import Fraction as F
from types import SimpleNamespace

import pytest

from stabilab import Body, ConstantTorque, Gyrostat, ScaledGyrostat, Scene
from stabilab.answers.certificate import certificate
from stabilab.verify import curves as degenerate
from stabilab.verify import equilibria as complete
from stabilab.verify import motion, verify
from stabilab.verify import orbit as period
from stabilab.verify.curves import Curve, judged
from stabilab.verify.numbers import Malformed, Open, above, ball, below, hull, narrowed
from stabilab.verify.rates import Rates

ZERO, ONE = F(0), F(1)
TOP = Rates.of("physical", [F(5), F(4), F(2)], [ZERO, F(2), ZERO], [ZERO] * 3)


def holds(value, exact):
    return below(value) <= exact <= above(value) and above(value) - below(value) < F(1, 10**9)


def test_newton_halves_where_the_slope_vanishes_and_gives_up_where_there_is_no_zero():
    assert holds(narrowed(lambda x: x**3 - ball(F(1, 8)), lambda x: 3 * x * x, F(-1), F(2)), F(1, 2))
    with pytest.raises(Open):
        narrowed(lambda x: x + 5, lambda x: x * 0 + 1, ZERO, ONE)
    for low in (F(-1), ZERO):  # the zero itself has slope 0; and a zero at the end
        with pytest.raises(Open):
            narrowed(lambda x: x**3, lambda x: 3 * x * x, low, F(2))
    with pytest.raises(Open):
        narrowed(lambda x: x * 0, lambda x: x, F(-1), F(2))


def test_integrals_change_as_the_conditions_say():
    # d/dt sum (a x^2/2 + b x) = sum (a x + b) x' is normal.x + constant for every x (by hand; theory.md,
    # section 1)
    for rates in (Rates.of("physical", [F(3), F(2), F(4)], [ONE, F(2), F(5)], [F(1), F(7), F(-2)]),
                  Rates.of("scaled", [F(1, 3)], [F(2)], [ONE, F(2), F(3)])):
        for (quad, linear), (normal, constant) in zip(rates.integrals, rates.conditions):
            x = [F(3, 7), F(-2, 5), F(11, 3)]
            change = sum((a * v + b) * r for a, b, v, r in zip(quad, linear, x, rates.at(x)))
            assert change == sum(n * v for n, v in zip(normal, x)) + constant


def test_level_sets_decide_only_at_equilibria_and_with_less_than_three_signs():
    # the two gradients are not parallel: no equilibrium
    assert degenerate.on_common_level(TOP, [ONE, F(2), F(3)]) is None
    assert degenerate._meets_surface([ONE, ONE, -ONE], [ONE, ZERO, ZERO], [ONE] * 3) is None
    # the third axis is free
    assert degenerate._meets_surface([ONE, -ONE, ZERO], [ONE, ZERO, ZERO], [ONE, ONE, ZERO]) is None
    # a plane meets the surface in curves
    assert degenerate._meets_surface([ONE, ZERO, ZERO], [ONE, ZERO, ZERO], [ONE, ONE, -ONE]) is None
    assert degenerate._meets_surface([ONE, ZERO, ZERO], [ONE, ZERO, ZERO], [ONE, ONE, ONE])[0] == "stable"


def test_an_orbit_without_force_decides_nothing():
    free = Rates.of("physical", [F(3), F(2), ONE], [ZERO] * 3, [ZERO] * 3)
    axis = [ONE, ZERO, ZERO]
    # no direction: the orbit stays
    assert degenerate.on_own_orbit(free, axis, [ZERO] * 3) is None
    # turns about axis 3, no rate along it
    sphere = Rates.of("physical", [ONE] * 3, [ZERO, ZERO, ONE], [ZERO] * 3)
    assert degenerate.on_own_orbit(sphere, axis, [ZERO, ZERO, ONE]) is None


def test_a_double_root_without_a_leading_term_decides_nothing():
    still = Rates.of("physical", [ONE] * 3, [ZERO] * 3, [ZERO] * 3)
    assert degenerate.leaves_double_root(still, [ONE, ZERO, ZERO], ZERO) is None   # J = 0
    sphere = Rates.of("physical", [ONE] * 3, [ZERO, ZERO, ONE], [ZERO] * 3)
    # linear: no quadratic term at all
    assert degenerate.leaves_double_root(sphere, [ZERO] * 3, ONE) is None


def test_an_open_claim_is_not_checked_and_a_missing_proof_says_so():
    assert judged("undecided", ("stable", "why"),
                  "")[0] == "not checked" and "stable" in judged("undecided", ("stable", "why"), "")[1]
    assert judged("stable", None,
                  "three zero eigenvalues") == ("not checked",
                                                "three zero eigenvalues: no proof is known here")


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


def test_rates_that_are_no_multiples_of_one_conic_are_not_checked():
    odd = Rates([ONE] * 3, [ZERO] * 3, [ZERO] * 3, [ZERO, ONE, ONE],
                (([ONE, ZERO, ZERO], ZERO), ([F(2), ZERO, ZERO], ZERO)), True, ())
    assert complete.whole_conic(odd, "curves", [], [])[0] == "not checked"
    line = Curve({"numerators": [["0"], ["0", "1"], ["0"]], "denominator": ["1"]} | CURVE, "here")
    assert degenerate.reducing_direction(odd, line) is None


BASE = certificate(ScaledGyrostat("0.2", "0.4", (0, 0, 1)), (3, F(-3, 2), F(3, 10)))


@pytest.mark.parametrize("path, bad", [
    (("scene", "variables"), "other"), (("equilibria", "curves", 0, "numerators"), [["1"]]),
    (("equilibria", "curves", 0, "denominator"), ["0"]),
    (("equilibria", "curves", 0, "segments", 0, "t"), [None]),
    (("equilibria", "planes"), [{"base": ["0"] * 3, "directions": [["1", "0", "0"]]}]),
    (("equilibria", "planes"), [{"base": ["0"] * 3, "directions": [["1", "0", "0"], ["2", "0", "0"]]}]),
    (("equilibria", "points"), [{"box": [["0", "1"]], "linear": "stable", "verdict": "stable"}]),
    (("motion", "extremes"), [[["0", "1"]]]),
    (("scene",), {"variables": "physical", "inertia": ["1", "0", "1"], "momentum": ["0"] * 3,
                  "torque": ["0"] * 3}), (("motion", "state"), "0")])
def test_what_is_of_the_wrong_form_is_refused(path, bad):
    wrong = copy.deepcopy(BASE)
    place = wrong
    for key in path[:-1]:
        place = place[key]
    place[path[-1]] = bad
    with pytest.raises(Malformed):
        verify(wrong)


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


def test_a_period_needs_two_ends_apart_and_a_force_at_each():
    unknown = SimpleNamespace(force=lambda alpha: hull(F(-1), ONE))  # the force's sign at the ends is open
    for ends in ((ball(ONE), ball(ONE)), (ball(F(-4)), ball(F(4)))):
        with pytest.raises(Open):
            period.period_of(unknown, ends, 48)


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
