"""Amer et al. 2024: the equations, their scaling, the equilibria under any torque (eqs (1)-(12))."""
from __future__ import annotations

from .constant_torque import generic, number, parse, symbols

DATA = (2000, 1500, 1000)


def three_torque_equilibria(a, b, mu):
    """All equilibria for three nonzero torques: X = x1 + a solves X (X + b - a) = mu2 mu3 / mu1."""
    import math
    mean, product = (b - a) / 2, mu[1] * mu[2] / mu[0]
    square = mean * mean + product
    if square < 0:
        return []
    roots = {-mean - math.sqrt(square), -mean + math.sqrt(square)}
    return [(X - a, -mu[2] / (X + b - a), mu[1] / X) for X in roots]


def _largest_rate(points, a, b, mu):
    return max(max(abs(x2 * x3 + mu[0]), abs(-x3 * (x1 + a) + mu[1]), abs(x2 * (x1 + b) + mu[2]))
               for x1, x2, x3 in points)


def _printed_eight():
    """Largest rate at the eight points of (9), and at the two true ones; mu = (1, 2, 2)/3, a = 0.2, b = 0.4.
    """
    import math
    a, b, mu = 0.2, 0.4, (1 / 3, 2 / 3, 2 / 3)
    true = three_torque_equilibria(a, b, mu)
    printed = [(x1, s2 * math.sqrt(mu[2] * mu[0] * (x1 + a) / (mu[1] * (x1 + b))),
                s3 * math.sqrt(mu[0] * mu[1] * (x1 + b) / (mu[2] * (x1 + a))))
               for x1, _, _ in true for s2 in (1, -1) for s3 in (1, -1)]
    return _largest_rate(printed, a, b, mu), _largest_rate(true, a, b, mu)


def _exists_below_zero():
    """Two equilibria with mu1 mu2 mu3 < 0: the printed rule counts none. Number missed; rate at the true
    ones."""
    a, b, mu = 0.2, 0.4, (0.95, 0.05, -0.1)
    points = three_torque_equilibria(a, b, mu)
    return len(points), _largest_rate(points, a, b, mu)


def major_axis_ideal(a, b):
    """1 where the equilibrium equations of a torque on axis 1 contradict each other (Groebner basis {1}),
    else 0."""
    import sympy as sp
    x1, x2, x3 = sp.symbols("x1:4")
    a, b = sp.Rational(a), sp.Rational(b)
    basis = sp.groebner([x2 * x3 + 1, x3 * (x1 + a), x2 * (x1 + b)], x1, x2, x3)
    return float(basis.exprs == [1])


def _zero_product():
    """The contradiction for a != b (print: equilibria exist), and for a = b (corrected: they do)."""
    import sympy as sp
    return major_axis_ideal(sp.Rational(1, 5),
                            sp.Rational(2, 5)), major_axis_ideal(sp.Rational(1, 5), sp.Rational(1, 5))


def _characteristic():
    import sympy as sp
    s, z = symbols(), sp.Symbol("zeta")
    x1, x2, x3, a, b = (s[n] for n in ("x1", "x2", "x3", "a", "b"))
    rates = sp.Matrix([x2 * x3, -x3 * (x1 + a), x2 * (x1 + b)])
    true = rates.jacobian([x1, x2, x3]).charpoly(z).as_expr()
    printed = parse("zeta**3 + zeta*((x1+a)*(x1+b) - x2**2 + x3**2) + x2*x3*(2*x1+a+b)", zeta=z)
    return number(sp.expand(true - printed), {**generic(), z: sp.Rational(2, 7)}), 0.0


TESTS = {
    "existence": _exists_below_zero,
    "no product": _zero_product,
    "eight": _printed_eight,
    "characteristic": _characteristic,
}
