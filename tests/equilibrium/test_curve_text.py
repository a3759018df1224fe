"""What is said of curves of equilibria: equations, parametrisations and crossings, read and checked against
the rates."""
from __future__ import annotations

import re
from fractions import Fraction as F

import mpmath as mp
import numpy as np
import pytest

from stabilab import Body, ScaledGyrostat, Scene, equilibria
from stabilab.equilibrium.description import LINE, Description
from stabilab.equilibrium.gyrostat import WELL
from stabilab.equilibrium.result import RationalCurve, straight_line
from stabilab.equilibrium.stability import curve_with_verdicts
from tests.equilibrium.test_gyrostat import CURVED
from tests.oracles.pairs import physical

LINES = [((4, 3, 2), (1, 5, 14), (0, 7, -5)), ((2, 2, 1), (2, 1, 3), (1, -2, 0)),
         ((2, 2, 1), (2, 1, 3), (-1, 2, 0)),
         ((5, 4, 2), (2, 3, 0), (0, 0, -6)), ((5, 4, 2), (2, 3, 0), (0, 0, 7)),
         ((5, 4, 2), (2, 3, 0), (0, 0, -7)),
         ((5, 4, 5), (2, 3, 0), (0, 0, -6)), ((2, 2, 1), (1, -2, 0), (0, 0, 1)),
         ((3, 3, 3), (1, -2, -3), (0, 0, 0)),
         ((3, 3, 3), (-1, 2.5, 1), (0, 0, 0))]
ON_EVERY_AXIS = [tuple(tuple(v[n] for n in order) for v in case) for case in LINES
                 for order in ((0, 1, 2), (1, 2, 0), (2, 0, 1))]


def said(text, t):
    """{name: value} of the clauses "name = 2 + 3 t" of an equation or a parametrisation, at t; a product as
    its own name."""
    value = lambda e: eval(re.sub(r"([\d.]) t", r"\1*t", e), {"t": t})
    pairs = [c.split(" = ", 1) for c in re.sub(r", N = e x M = \([^)]*\)", "", text).split(", ")
             if " = " in c]
    return {name: value(e) for name, e in pairs if "alpha N" not in e and "omega" not in e}


@pytest.mark.parametrize("D, lam, M", CURVED + ON_EVERY_AXIS)
def test_the_words_about_a_curve_of_equilibria_name_its_points(D, lam, M):
    """Every clause of the equation and of the parametrisation, read as arithmetic, at points where the rates
    vanish."""
    scene, problem = physical(D, lam, M)
    for curve in equilibria(scene).curves:
        for t in (0.375, -2.75, 1.9):
            x = dict(zip(("omega1", "omega2", "omega3"), curve.point(t)))
            sizes = [abs(k * x["omega%d" % (j + 1)] * x["omega%d" % (i + 1)]) + abs(m) + 1 for k, m, (j, i) in
                     zip(problem.kappa, problem.m, ((1, 2), (2, 0), (0, 1)))]
            rates = np.array(problem.rate(list(x.values())), float)
            assert np.abs(rates).max() <= 1e-13 * float(max(sizes)) * max(map(abs, (*lam, 1)))
            if "alpha" in curve.equation:  # oblique: alpha counts in units of N = e x M
                normal = eval(re.search(r"N = e x M = (\([^)]*\))", curve.equation)[1])
                x["alpha"] = sum(n * v for n, v in zip(normal, x.values())) / sum(n * n for n in normal)
            told = said(curve.parametrisation, t) if "s = D" not in curve.parametrisation else {}
            if " turns about " not in curve.parametrisation:
                assert {name: x[name] for name in told} == pytest.approx(told, rel=1e-12, abs=1e-12)
                assert len(told) in (0, 2, 3)
            for name, number in (said(curve.equation, t) if "D omega" not in curve.equation else {}).items():
                left = re.sub(r"([\w)]) ([(\w])", r"\1 * \2", name.replace(" + ", "+").replace(" - ", "-"))
                assert eval(left, dict(x)) == pytest.approx(number, rel=1e-11, abs=1e-11)
            for name in re.findall(r"(\w+) arbitrary", curve.equation):
                assert x[name] == pytest.approx(t, rel=1e-13)


@pytest.mark.one_in(3)
@pytest.mark.parametrize("D, lam, M, expected", [
    ((5, 4, 2), (2, 3, 0), (0, 0, -6), "unstable"), ((2, 5, 4), (0, 2, 3), (-6, 0, 0), "unstable"),
    ((7, 4, 6), (3, 2, 0), (0, 0, -2), "unstable"),
    ((9, 4, 6), (1, 10, 0), (0, 0, -2), "unstable"), ((9, 4, 6), (10, -1, 0), (0, 0, 2), "unstable"),
    ((4, 9, 6), (10, 1, 0), (0, 0, 2), "unstable"), ((6, 5, 10), (1, -10, 0), (0, 0, 10), "unstable"),
    ((5, 4, 5), (2, 3, 0), (0, 0, -6), "stable"),
    ((4, 5, 5), (3, 0, 2), (0, -6, 0), "stable"), ((5, 5, 4), (0, 2, 3), (-6, 0, 0), "stable")])
def test_where_two_lines_cross_the_potential_has_the_power_and_the_sign_that_are_named(D, lam, M, expected):
    """dx/dalpha = J(x) e by mpmath from the oracle's rates (a quadratic's central difference is its
    derivative), U' = -e.x'."""
    scene, problem = physical(D, lam, M)
    crossings = {(p.at, p.verdict, p.because) for c in equilibria(scene).curves for p in c.samples
                 if "U ~" in p.because}
    assert {verdict for _, verdict, _ in crossings} == {expected}
    for at, verdict, because in crossings:
        sign, power = re.search(r"U ~ ([+-])alpha\^(\d+)", because).groups()
        assert (verdict == "stable") == (sign == "+" and int(power) % 2 == 0)
        with mp.workdps(25):
            def along(_, x):
                ahead, behind = (problem.rate([mp.mpf(v) + s * m for v, m in zip(x, M)]) for s in (1, -1))
                return [(u - v) / 2 for u, v in zip(ahead, behind)]
            flow = {s: mp.odefun(lambda t, x, s=s: [s * v for v in along(t, x)], 0, [mp.mpf(v) for v in at])
                    for s in (1, -1)}
            pull = lambda t: -sum(m * v for m, v in zip(M, problem.rate(flow[1 if t > 0 else -1](abs(t)))))
            step = mp.mpf(1) / 1024 / max(map(abs, M))
            assert mp.sign(pull(step)) == (1 if sign == "+" else -1)
            assert mp.log(abs(pull(step) / pull(step / 2)), 2) == pytest.approx(int(power) - 1, abs=0.1)
            assert mp.sign(pull(-step)) == mp.sign(pull(step)) * (-1) ** (int(power) - 1)


@pytest.mark.parametrize("a", ["0.25", "-1.5"])
def test_the_free_scaled_body_without_a_wheel_rests_where_its_three_axes_meet(a):
    """x2 x3 = 0, x3 (x1 + a) = 0, x2 (x1 + a) = 0: three lines through (-a, 0, 0), where alone all are at
    rest."""
    curves = equilibria(ScaledGyrostat(a, a, (0, 0, 0))).curves
    assert len(curves) == 3
    for curve in curves:
        assert curve.folds == ((-float(a), 0.0, 0.0),)
        (rest,) = (p for p in curve.samples if p.at == curve.folds[0])
        assert (rest.linear, rest.verdict) == ("degenerate", "stable")


def test_a_line_on_which_the_motion_is_degenerate_all_along_is_left_undecided():
    """A free sphere at any rate: the Jacobian is 0, and no ground was given for such a curve."""
    line = RationalCurve(Description(LINE, LINE, LINE), straight_line((F(0),) * 3, (F(1), F(0), F(0))), WELL)
    found = curve_with_verdicts(Scene(Body((1, 1, 1))).quadratic(), line)
    assert {(s.linear, s.verdict) for s in (*found.segments, *found.samples)} == {("degenerate", "undecided")}
    assert all(p.eigenvalues == (0, 0, 0)
               for p in found.samples) and len(found.segments) == 1 and not found.folds
