"""Amer et al. 2024: the equations, their scaling, the equilibria under any torque (eqs (1)-(12))."""
from __future__ import annotations

from .published import Published, generic, number, parse, symbols

DATA = (2000, 1500, 1000)


def _euler():
    """Printed (1) against D w' = (D w + lambda) x w + M, in symbols."""
    import sympy as sp
    D, w, M, l1 = sp.symbols("D1:4"), sp.symbols("w1:4"), sp.symbols("M1:4"), sp.Symbol("l1")
    H = sp.Matrix([D[0] * w[0] + l1, D[1] * w[1], D[2] * w[2]])
    true = H.cross(sp.Matrix(w)) + sp.Matrix(M)
    printed = sp.Matrix([M[0] - (D[2] - D[1]) * w[1] * w[2],
                         M[1] - (D[0] - D[2]) * w[2] * w[0] - l1 * w[2],
                         M[2] - (D[1] - D[0]) * w[0] * w[1] + l1 * w[1]])
    return float((true - printed).expand().norm()), 0.0


def _scaled_rates(power):
    """Largest mismatch of (5) with the true rates when a, b are divided by u**power; u = 4."""
    import sympy as sp
    D, l1, u = [sp.Integer(d) for d in DATA], sp.Integer(100), sp.Integer(4)
    ks = ((D[1] - D[2]) / D[0], (D[0] - D[2]) / D[1], (D[0] - D[1]) / D[2])
    k = ks[0] * ks[1] * ks[2]
    a = l1 / (D[1] * ks[1] * sp.sqrt(ks[0])) / u**power
    b = l1 / (D[2] * ks[2] * sp.sqrt(ks[0])) / u**power
    x = [sp.Rational(7, 5), sp.Rational(3, 4), sp.Rational(5, 6)]
    w = [sp.sqrt(u * kj) * xj for kj, xj in zip(ks, x)]
    true = [((D[1] - D[2]) * w[1] * w[2]) / D[0], (-(D[0] - D[2]) * w[2] * w[0] - l1 * w[2]) / D[1],
            ((D[0] - D[1]) * w[0] * w[1] + l1 * w[1]) / D[2]]
    scaled = [t / sp.sqrt(u * kj) / sp.sqrt(u * k) for t, kj in zip(true, ks)]
    printed = [x[1] * x[2], -x[2] * (x[0] + a), x[1] * (x[0] + b)]
    return max(abs(float((p - s).evalf(30))) for p, s in zip(printed, scaled))


def _unit_torque():
    import sympy as sp
    u1, u2, u3, k1, k2, k3 = sp.symbols("u1:4 k1:4", positive=True)
    k = k1 * k2 * k3
    u = sp.sqrt(k2 * k3 * u1**2 + k3 * k1 * u2**2 + k1 * k2 * u3**2) / k
    mu = [ui / (u * sp.sqrt(k) * sp.sqrt(ki)) for ui, ki in zip((u1, u2, u3), (k1, k2, k3))]
    return float(sp.simplify(sum(m**2 for m in mu) - 1)), 0.0


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
    """Largest rate at the eight points of (9), and at the two true ones; mu = (1, 2, 2)/3, a = 0.2, b = 0.4."""
    import math
    a, b, mu = 0.2, 0.4, (1 / 3, 2 / 3, 2 / 3)
    true = three_torque_equilibria(a, b, mu)
    printed = [(x1, s2 * math.sqrt(mu[2] * mu[0] * (x1 + a) / (mu[1] * (x1 + b))),
                s3 * math.sqrt(mu[0] * mu[1] * (x1 + b) / (mu[2] * (x1 + a))))
               for x1, _, _ in true for s2 in (1, -1) for s3 in (1, -1)]
    return _largest_rate(printed, a, b, mu), _largest_rate(true, a, b, mu)


def _exists_below_zero():
    """Two equilibria with mu1 mu2 mu3 < 0: the printed rule counts none. Number missed; rate at the true ones."""
    a, b, mu = 0.2, 0.4, (0.95, 0.05, -0.1)
    points = three_torque_equilibria(a, b, mu)
    return len(points), _largest_rate(points, a, b, mu)


def major_axis_ideal(a, b):
    """1 where the equilibrium equations of a torque on axis 1 contradict each other (Groebner basis {1}), else 0."""
    import sympy as sp
    x1, x2, x3 = sp.symbols("x1:4")
    a, b = sp.Rational(a), sp.Rational(b)
    basis = sp.groebner([x2 * x3 + 1, x3 * (x1 + a), x2 * (x1 + b)], x1, x2, x3)
    return float(basis.exprs == [1])


def _zero_product():
    """The contradiction for a != b (print: equilibria exist), and for a = b (corrected: they do)."""
    import sympy as sp
    return major_axis_ideal(sp.Rational(1, 5), sp.Rational(2, 5)), major_axis_ideal(sp.Rational(1, 5), sp.Rational(1, 5))


def _characteristic():
    import sympy as sp
    s, z = symbols(), sp.Symbol("zeta")
    x1, x2, x3, a, b = (s[n] for n in ("x1", "x2", "x3", "a", "b"))
    rates = sp.Matrix([x2 * x3, -x3 * (x1 + a), x2 * (x1 + b)])
    true = rates.jacobian([x1, x2, x3]).charpoly(z).as_expr()
    printed = parse("zeta**3 + zeta*((x1+a)*(x1+b) - x2**2 + x3**2) + x2*x3*(2*x1+a+b)", zeta=z)
    return number(sp.expand(true - printed), {**generic(), z: sp.Rational(2, 7)}), 0.0


ROWS = (
    Published("eq. (1)", "D1 ω1' + (D3−D2) ω2 ω3 = M1, D2 ω2' + (D1−D3) ω3 ω1 + λ1 ω3 = M2, "
              "D3 ω3' + (D2−D1) ω1 ω2 − λ1 ω2 = M3", "equations of motion", "right", "",
              "difference from D ω' = (Dω + λ) × ω + M", _euler),
    Published("eqs (2)-(5)", "a = λ1/(D2 k2 √k1), b = λ1/(D3 k3 √k1) kept when time and rates are scaled with u",
              "(5) no longer depends on the size of the torque", "right only for these data",
              "a = λ1/(D2 k2 √(u k1)), b = λ1/(D3 k3 √(u k1)); the paper's own data have u = 1",
              "the rates at u = 4", lambda: (_scaled_rates(0), _scaled_rates(0.5))),
    Published("eq. (6)", "μ1² + μ2² + μ3² = 1", "with u of the text before (4)", "right", "",
              "μ1² + μ2² + μ3² − 1 in symbols", _unit_torque),
    Published("after eq. (8)", "equilibria exist if and only if μ1 μ2 μ3 ≥ 0", "existence", "wrong",
              "for three nonzero torques they exist if and only if ((b−a)/2)² + μ2 μ3/μ1 ≥ 0",
              "number of equilibria missed at a=0.2, b=0.4, μ=(0.95, 0.05, −0.1); rate at them", _exists_below_zero),
    Published("after eq. (8)", "equilibria exist if μ1 μ2 μ3 = 0", "existence for a torque on axis 1 alone", "wrong",
              "a torque along the wheel's axis has no equilibrium unless a = b", "whether the three equations "
              "contradict each other (Gröbner basis {1}): at a ≠ b; at a = b", _zero_product),
    Published("eq. (9)", "eight equilibria: ± before both roots", "number of equilibria", "wrong",
              "at most two: (X1+a)(X1+b) = μ2 μ3/μ1, X2 = −μ3/(X1+b), X3 = μ2/(X1+a)",
              "largest rate at the points named", _printed_eight),
    Published("eqs (11), (12)", "ζ³ + ζ[(X1+a)(X1+b) − X2² + X3²] + X2 X3 (2X1+a+b) = 0", "characteristic equation",
              "right", "", "difference from det(ζ − J)", _characteristic),
)
