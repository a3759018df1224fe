"""Certificates of diagrams: what resultants and balls found is proved by trace forms and Sturm's sequences,
and nothing else is."""
from __future__ import annotations

import json
from fractions import Fraction as F

import numpy as np
import pytest
from flint import fmpq_poly

from stabilab.commands.maps import bifurcation as command
from stabilab.errors import InputError
from stabilab.verify import verify
from stabilab.verify.diagram.check import check_diagram
from stabilab.verify.diagram.claims import claims_of
from stabilab.verify.diagram.equations import System, count_at, critical
from stabilab.verify.numbers import Malformed, q
from stabilab.verify.roots import MOST_BITS, Root, Work, roots
from tests.shared import CASES
from tests.verify.diagrams import certified, drawn, forgeries

KNOWN = {"a circle of a motion": ("wheel-and-thruster", {"torque[3]": "0:2000"}, False),
         "off the axes": ("off-axis-two", {"torque[3]": "-0.3:0.3"}, False),
         "a moment of inertia": ("wheel-and-thruster", {"inertia[1]": "780:860"}, False),
         "a cusp": ("middle-axis-double-well", {"b": "0:4"}, True),
         "a curve at one value": ("thruster-stuck-major-axis", {"torque[2]": "-1:1"}, False), 
         "a start": ("wheel-and-thruster", {"angular_velocity[2]": "-9:9 deg/s"}, False)}


def made(name):
    case, vary, curve = KNOWN[name]
    return certified(CASES / f"{case}.toml", vary, curve)


def status_of(claims):
    try:
        return verify(claims).status
    except Malformed:
        return "refused"


@pytest.mark.parametrize("degenerate", [False, True], ids=["generic", "degenerate"])
@pytest.mark.parametrize("seeds", [range(20), pytest.param(range(100, 300), marks=pytest.mark.slow),
                                   pytest.param(range(300, 1100), marks=[pytest.mark.slow, pytest.mark.long])],
                         ids=["some", "two hundred", "eight hundred"])
def test_what_elimination_finds_is_what_trace_forms_count(tmp_path, seeds, degenerate):
    proved = 0
    for seed in seeds:
        claims = drawn(tmp_path, seed, degenerate)
        if claims is not None:
            found = verify(claims)
            assert found.status == "proved", (seed, [f for f in found.findings if f.status != "proved"])
            proved += 1
    assert proved > 0.7 * len(seeds)


@pytest.mark.slow
@pytest.mark.parametrize("seeds, most", [((0, 2, 3, 5, 7), 200),
                                         pytest.param(range(150), 2000, marks=pytest.mark.long)],
                         ids=["some", "thousands"])
def test_forgeries_are_refuted(tmp_path, seeds, most):
    rng, tried = np.random.default_rng(1), 0
    degenerate = lambda seed: most < 2000 or seed % 2 == 0
    for claims in (*map(made, KNOWN), *(drawn(tmp_path, seed, degenerate(seed)) for seed in seeds)):
        if claims is None:
            continue
        assert status_of(claims) == "proved", verify(claims).findings
        for words, forged in forgeries(claims, rng):
            assert status_of(forged) in ("refuted", "refused"), (words, claims)
            tried += 1
    assert tried > most


JUNK = [None, True, 5, -1, 1.5, "x", "1/0", [], {}, [[]], ["1"], ["2", "1"], "9" * 5000, ["0", "1e400000"],
        [["1"] * 3] * 3, float("nan")]


@pytest.mark.one_in(2)
@pytest.mark.parametrize("key", ["scene", "counted", "axis", "start", "range", "pieces", "events"])
def test_junk_is_refused_or_refuted_and_never_proved(key):
    claims = made("a circle of a motion")
    for bad in JUNK:
        assert status_of(claims | {key: bad}) in ("refuted", "refused"), bad
    for inner in claims[key] if isinstance(claims[key], dict) else ():
        for bad in JUNK:
            assert status_of(claims
                             | {key: claims[key] | {inner: bad}}) in ("refuted", "refused"), (inner, bad)
    for entry in ({"t": bad, "equilibria": 1, "stable": 1} for bad in JUNK):
        if isinstance(claims[key], list):
            assert status_of(claims | {key: [entry, *claims[key][1:]]}) in ("refuted", "refused"), entry


def test_a_key_without_a_meaning_is_not_checked():
    assert status_of(made("off the axes") | {"folds": "none"}) == "partly"


def test_a_body_whose_moment_vanishes_in_the_range_is_refuted():
    claims = made("off the axes")
    claims["scene"]["inertia"][0] = ["0", "1"]
    assert status_of(claims) == "refuted"


def test_a_diagram_over_two_numbers_has_no_certificate():
    with pytest.raises(InputError, match="over one number"):
        command(CASES / "wheel-and-thruster.toml", ["torque[3]=0:1", "torque[1]=0:1"], False, None, None, None,
                "diagram.json", False, False)


def test_a_certificate_is_of_its_case_and_of_no_other(tmp_path, stabilab):
    case, out = CASES / "off-axis-two.toml", tmp_path / "diagram.json"
    assert stabilab("bifurcation", case, "--vary", "torque[3]=-0.3:0.3", "--certify", out)[0] == 0
    code, told, _ = stabilab("verify", out, "--case", case)
    assert code == 0 and told.startswith("PROVED: ") and "torque 1/10 1/5 *" in told
    code, _, error = stabilab("verify", out, "--case", CASES / "off-axis-one.toml")
    assert code == 5 and "of another case" in error
    claims = json.loads(out.read_text())
    claims["events"][0]["equilibria"] = 2
    out.write_text(json.dumps(claims))
    assert stabilab("verify", out)[0] == 5


# -- files from strangers


def heavy(rng, counted, degree, digits):
    """A diagram's certificate in which every number varies, with coefficients of so many digits."""
    row = lambda: [str(int(rng.choice((-1, 1)))) + "".join(map(str, rng.integers(0, 10, digits - 1)))
                   for _ in range(degree + 1)]
    axis = 0 if counted == "isolated" else 3
    rows = lambda here: [row() if axis == 0 or (n == 2) == here else ["0"] for n in range(3)]
    inertia = [[f"9{constant[1 - digits:]}", *rest] for constant, *rest in (row() for _ in range(3))]
    scene = {"variables": "physical", "inertia": inertia, "momentum": rows(False), "torque": rows(True)}
    start = {"start": [row() for _ in range(3)]} if counted == "motion" else {}
    return {"schema": "stabilab.diagram-certificate/1", "number": "t", "scene": scene, "counted": counted,
            "axis": axis, "range": ["-1/9", "1/8"],
            "events": [], "pieces": [{"equilibria": 2, "stable": None if counted == "borders" else 1}],
            **start}


class Counted(Work):
    """Work that keeps what was asked for at once."""

    largest = 0

    def spend(self, count):
        self.largest = max(self.largest, count)
        super().spend(count)


@pytest.mark.parametrize("counted, degree, digits",
                         [("motion", 1, 9), ("borders", 3, 60), ("isolated", 3, 90), ("motion", 3, 399)])
def test_a_certificate_that_asks_for_too_much_work_is_not_checked(counted, degree, digits):
    work, findings = Counted(MOST_BITS // 20), []
    check_diagram(claims_of(heavy(np.random.default_rng(3), counted, degree, digits)),
                  lambda *found: findings.append(found), work)
    claim, status, reason = findings[-1]
    assert (claim, status) == ("1 pieces and 0 events",
                               "not checked") and reason.startswith("too large") and work.left < 0
    assert all(status != "refuted" for _, status, _ in findings)
    again = Counted(MOST_BITS // 20)
    check_diagram(claims_of(heavy(np.random.default_rng(3), counted, degree, digits)), lambda *found: None,
                  again)
    # no clock: the same file ends at the same place
    assert (again.left, again.largest) == (work.left, work.largest)


@pytest.mark.parametrize("name", KNOWN)
def test_known_diagrams_take_an_eighth_of_the_work_that_is_given_at_most(name):
    work = Counted()
    check_diagram(claims_of(made(name)), lambda *found: None, work)
    assert 0 < MOST_BITS - work.left < MOST_BITS / 8


# -- the parts by hand


def test_a_trace_form_counts_the_points_of_a_circle_on_a_line():
    """x^2 + y^2 = 1 and y = t: two points for |t| < 1, one at the ends, none beyond; x > 0 at one of them."""
    p = lambda *c: fmpq_poly(list(c))
    system = System(2, [{(2, 0): p(1), (0, 2): p(1), (0, 0): p(-1)}, {(0, 1): p(1), (0, 0): p(0, -1)}],
                    [{(1, 0): p(1)}])
    found = {t: count_at(system, Root(fmpq_poly([-q(F(t)), 1]), F(t), F(t), Work()), Work())
             for t in (0, F(3, 5), 1, 2)}
    assert [found[t].real for t in found] == [2, 2, 1, 0] and found[0].tests == ((0, True), )
    assert found[1].tests == ((0, False),)
    assert {(root.low, root.high) for root in roots(critical(system, Work()), F(-3), F(3),
                                                    Work())} == {(F(-1), F(-1)), (F(1), F(1))}


def test_zeros_of_a_chebyshev_polynomial_are_cosines():
    f, last = fmpq_poly([0, 1]), fmpq_poly([1])
    for _ in range(10):
        f, last = fmpq_poly([0, 2]) * f - last, f
    found = roots([f], F(-1), F(1), Work())
    expected = sorted(np.cos((2 * k + 1) * np.pi / 22) for k in range(11))
    assert len(found) == 11 and all(float(r.low) - 1e-12 <= x <= float(r.high) + 1e-12 for r,
                                    x in zip(found, expected))


def test_the_sign_of_a_polynomial_at_a_zero_of_another_is_exact():
    root = Root(fmpq_poly([-2, 0, 1]), F(1), F(2), Work())  # the square root of two
    # its convergents from both sides
    assert [root.sign(fmpq_poly(c))
            for c in ([-2, 0, 1], [-577, 408], [-1393, 985], [0, 0, 0, 1])] == [0, -1, 1, 1]
