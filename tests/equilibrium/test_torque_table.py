"""The table of torque directions against the equilibria themselves, pattern by pattern."""
from __future__ import annotations

import random
from fractions import Fraction as F

import pytest

from stabilab import ScaledGyrostat, equilibria
from stabilab.equilibrium.torque_table import torque_table

GYROSTATS = {"a != b": (F(1, 3), F(5, 2)), "a = b": (F(1, 3), F(1, 3)), "a = b = 0": (F(0), F(0))}
PAIRS = [(name, row) for name, (a, b) in GYROSTATS.items() for row in torque_table(a, b)]


def magnitudes(row, seed):
    rng = random.Random(seed)
    return [{"-": -1, "0": 0, "+": 1}[s] * F(rng.randint(1, 40), rng.choice((7, 11, 13))) for s in row.mu]


def numbers(a, b, mu, x):
    return dict(zip("a b mu1 mu2 mu3 x1 x2 x3".split(), map(float, (a, b, *mu, *x))))


def evaluate(text, values):
    """A formula of the table as a number: its own notation read by SymPy's implicit multiplication."""
    from sympy import Symbol
    from sympy.parsing.sympy_parser import implicit_multiplication, parse_expr, standard_transformations
    names = {n: Symbol(n) for n in values}
    return complex(parse_expr(text.replace("^", "**"), names,
                              (*standard_transformations, implicit_multiplication)).subs(values))


@pytest.mark.parametrize("name", GYROSTATS)
def test_the_table_has_each_of_the_27_patterns_once(name):
    rows = torque_table(*GYROSTATS[name])
    assert len({r.mu for r in rows}) == len(rows) == 27 and {r.gyrostat for r in rows} == {name}


@pytest.mark.one_in(4)
@pytest.mark.parametrize("name, row", PAIRS)
def test_each_row_is_what_the_equilibria_say(name, row):
    for seed in range(4):
        found = equilibria(ScaledGyrostat(*GYROSTATS[name], magnitudes(row, seed)))
        assert found.kind in row.kinds
        assert not row.counts or len(found.points) in row.counts
        if found.points:
            assert all(p.verdict == "unstable" for p in found.points) and row.nonlinear.startswith("unstable")


@pytest.mark.one_in(4)
@pytest.mark.parametrize("name, row", [(n, r) for n, r in PAIRS if r.polynomial != "-"])
def test_the_polynomial_of_each_row_has_the_eigenvalues_as_roots(name, row):
    a, b = GYROSTATS[name]
    mu = magnitudes(row, 1)
    found = equilibria(ScaledGyrostat(a, b, mu))
    parts = dict(piece.split(" = ") for piece in row.polynomial.split(", ")[1:])
    for k, p in enumerate((*found.points, *(s for c in found.curves for s in c.samples[::4]))):
        values = numbers(a, b, mu, p.at)
        m = evaluate(parts["m"], values).real
        n = evaluate(parts["n"].replace("-+", "-" if k else ""), values).real if "n" in parts else 0.0
        for z in p.eigenvalues:
            size = abs(z) ** 3 + abs(m * z) + abs(n)
            # m of a far sample is a difference of large squares: its rounding is that of x2^2 + x3^2
            slack = 1e-13 * abs(z) * sum(v * v for v in p.at)
            assert abs(z**3 + m * z + n) <= 1e-12 * size + slack


@pytest.mark.parametrize("name, row",
                         [(n, r) for n, r in PAIRS if r.form.startswith("(") and r.counts == (1,)])
def test_the_printed_form_of_a_single_equilibrium_is_its_place(name, row):
    a, b = GYROSTATS[name]
    mu = magnitudes(row, 2)
    (p,) = equilibria(ScaledGyrostat(a, b, mu)).points
    values = numbers(a, b, mu, p.at)
    assert [evaluate(t, values).real for t in row.form[1:-1].split(", ")] == pytest.approx(p.at, rel=1e-14)


@pytest.mark.one_in(4)
@pytest.mark.parametrize("name, row", [(n, r) for n, r in PAIRS if " = " in r.form])
def test_the_printed_equations_of_every_form_hold_at_the_equilibria(name, row):
    a, b = GYROSTATS[name]
    mu = magnitudes(row, 3)
    found = equilibria(ScaledGyrostat(a, b, mu))
    for k, p in enumerate((*found.points, *(s for c in found.curves for s in c.samples[::4]))):
        values = numbers(a, b, mu, p.at)
        for equation in row.form.split(", "):
            left, right = (evaluate(side.replace("+-", "+" if k else "-"), values).real
                           for side in equation.split(" = "))
            # a product of a far coordinate and a nearly cancelled one keeps the rounding of the far one
            assert left == pytest.approx(right, rel=1e-11,
                                         abs=1e-10 * max(1, *map(abs, p.at)) / max(1, abs(p.at[0])))


def test_the_number_for_three_torques_turns_where_the_row_says():
    """(b-a)^2 against 4 |mu2 mu3/mu1|."""
    count = lambda mu1: len(equilibria(ScaledGyrostat(0, 2, (mu1, 1, 1))).points)
    assert [count(F(-11, 10)), count(-1), count(F(-9, 10))] == [2, 1, 0]
