"""Claims of Amer et al. 2024 that a typed formula cannot say, on the scaled gyrostat under a unit torque: of
any direction (eqs (1)-(12)), on the major axis (eqs (41)-(43), Figs 8-15), on the middle axis (eqs
(44)-(84)); and claims that compare: how a quantity goes as a parameter grows, on which side of zero it is."""
from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from ....answers.simulate import trajectory
from ....physics.coefficients import scaling
from ....physics.scene import Body, ScaledGyrostat

GOES = {"rises": lambda change, size: change > size, "falls": lambda change, size: change < -size,
        "stays": lambda change, size: abs(change) <= size}
ROUNDING = 1e-9  # a smaller relative change is none


def missed(values, goes: str) -> int:
    """How many steps between neighbouring values do not go as the word says."""
    return sum(not GOES[goes](after - before, ROUNDING * max(abs(before), abs(after)))
               for before, after in zip(values, values[1:]))


def trend(values, goes: str, truth: str = "") -> tuple[int, int]:
    """The two residuals of a claim that values go as `goes`, while they go as `truth`."""
    return missed(values, goes), missed(values, truth or goes)


def side(value: float, lies: str) -> tuple[float, float]:
    """The two residuals of a claim that a value is "above" or "below" zero; the second of its opposite."""
    below, above = max(0.0, -value), max(0.0, value)
    return (below, above) if lies == "above" else (above, below)


# -- the true equations, and a state at which nothing is special

AXES = {"major": (1, 0, 0), "middle": (0, 1, 0), "minor": (0, 0, 1)}


@lru_cache
def symbols():
    """SymPy symbols x1, x2, x3, a, b by name, with c = b - a."""
    import sympy as sp
    names = {s: sp.Symbol(s, real=True) for s in ("x1", "x2", "x3", "a", "b")}
    names["c"] = names["b"] - names["a"]
    return names


def generic():
    """A rational state and the paper's a, b at lambda1 = 100."""
    import sympy as sp
    s, r = symbols(), sp.Rational
    return {s["x1"]: r(7, 5), s["x2"]: r(3, 4), s["x3"]: r(5, 6), s["a"]: r(1, 5), s["b"]: r(2, 5)}


def parse(formula: str, **more):
    """A SymPy expression in x1, x2, x3, a, b, c and any further names."""
    import sympy as sp
    names = {**symbols(), "pi": sp.pi, **{f: getattr(sp, f) for f in
             ("sin", "cos", "sinh", "cosh", "exp", "log", "sqrt", "atan", "atanh", "asin")}, **more}
    return sp.sympify(formula, locals=names)


def number(expression, at=None) -> float:
    """Value with 30 digits, rounded."""
    return float(expression.subs(generic() if at is None else at).evalf(30))


def spectrum_is_stable(x, a: float, b: float) -> bool:
    """Whether no eigenvalue of the Jacobian at x has a positive real part; x away from the folds."""
    jacobian = [[0, x[2], x[1]], [-x[2], 0, -(x[0] + a)], [x[1], x[0] + b, 0]]
    return bool(np.linalg.eigvals(jacobian).real.max() < 1e-7)


def misjudged(rule, equilibria, a: float, b: float) -> float:
    """Share of the equilibria at which `rule(x)` differs from the spectrum."""
    return sum(bool(rule(x)) != spectrum_is_stable(x, a, b) for x in equilibria) / len(equilibria)


def minor_equilibria(b: float, heights=(-3, -1.5, -0.7, -0.3, 0.3, 0.7, 1.5, 3)):
    """True equilibria of the minor axis: x2 = h, x1 + b = -1/h, x3 = 0."""
    return [(-1 / h - b, h, 0.0) for h in heights]


def middle_equilibria(a: float, heights=(-3, -1.5, -0.7, -0.3, 0.3, 0.7, 1.5, 3)):
    """True equilibria of the middle axis: x3 = g, x1 + a = 1/g, x2 = 0."""
    return [(1 / g - a, 0.0, g) for g in heights]


# -- a torque of any direction


def three_torque_equilibria(a, b, mu):
    """All equilibria for three nonzero torques: X = x1 + a solves X (X + b - a) = mu2 mu3 / mu1."""
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


# -- on the major and on the middle axis

# Figs 8-11: ranges of x2 and x3 over tau in [0, 15] from (4.5, 1.8, 3.4); lambda1 -> ((x2), (x3)); printed in
# the text, and from the equations (Taylor integration; the smallest and largest value of the dense output).
RANGES_PRINTED = {100: ((-4, 4), (-4.1, 4)), 300: ((-4.2, 4), (-5, 4)), 500: ((-4.5, 4), (-6, 4))}
RANGES_TRUE = {100: ((-3.8126, 3.8127), (-3.8591, 3.8642)), 300: ((-3.7568, 3.7571), (-3.8839, 3.8946)),
               500: ((-3.7127, 3.7123), (-3.9075, 3.9206))}


def _ranges(table):
    """Largest distance of the table's ranges from those of the motion."""
    worst = 0.0
    for lam, limits in table.items():
        run = trajectory(ScaledGyrostat(lam / 500, lam / 250, (1, 0, 0)), (4.5, 1.8, 3.4),
                         np.linspace(0, 15, 60001))
        for row, (low, high) in zip((1, 2), limits):
            states = np.asarray(run.states)[:, row]
            worst = max(worst, abs(states.min() - low), abs(states.max() - high))
    return worst


STARTS = {"8": (4.5, 1.8, 3.4), "12": (0.0, -1.0, 5.0)}  # of Figs 8-11 and 12-15
QUANTITIES = {"least x1": lambda x: x[:, 0].min(), "least x3": lambda x: x[:, 2].min(),
              "width of x1": lambda x: np.ptp(x[:, 0]), "last x1": lambda x: x[-1, 0],
              "sign changes of x2": lambda x: int((np.diff(np.sign(x[:, 1])) != 0).sum())}


@lru_cache
def _quantity(name, figure, lambda1, end=15):
    """A quantity of the motion of Fig. 8 or 12 over tau in [0, end]."""
    run = trajectory(ScaledGyrostat(lambda1 / 500, lambda1 / 250, (1, 0, 0)), STARTS[figure],
                     np.linspace(0, end, 15001))
    return float(QUANTITIES[name](np.asarray(run.states)))


def _trend(quantity, figure, goes, truth="", wheels=(100, 300, 500)):
    return trend([_quantity(quantity, figure, lam) for lam in wheels], goes, truth)


def _side(quantity, figure, lambda1, lies):
    return side(_quantity(quantity, figure, lambda1), lies)


def _spins_up():
    """How many of the motions of Fig. 8 do not gain 100 of x1, to 1 %, over tau from 300 to 400."""
    gains = [_quantity("last x1", "8", lam, 400) - _quantity("last x1", "8", lam, 300)
             for lam in (100, 300, 500)]
    return sum(abs(gain - 100) > 1 for gain in gains), 0


def _capture():
    """J of the end state minus J of the start, plus 2 c tau: the law that forbids a bounded motion. Fig. 12,
    lambda1 = 100: the print's "stable" would keep J; start (0, -1, 5), tau = 15."""
    c = 0.2
    run = trajectory(ScaledGyrostat(0.2, 0.4, (1, 0, 0)), (0.0, -1.0, 5.0), (0.0, 15.0))
    first, last = (x2 * x2 + x3 * x3 - 2 * c * x1 for x1, x2, x3 in (run.states[0], run.states[-1]))
    return last - first, last - first + 2 * c * 15


def _major_rule():
    """The printed rule on the line of equilibria that a = b has: x1 = -a, x2 x3 = -1."""
    points = [(-0.2, -1 / g, g) for g in (-3, -1.6, -0.6, -0.3, 0.3, 0.6, 1.6, 3)]
    return (misjudged(lambda x: x[2] > 1, points, 0.2, 0.2),
            misjudged(lambda x: abs(x[2]) > abs(x[1]), points, 0.2, 0.2))


def _always_stable():
    """Equilibria with c = 2.5 (a = 0.5, b = 3): share that "all are stable" misjudges."""
    points = middle_equilibria(0.5, (-3, -2, -1.5, -1, -0.8, -0.5, 0.5, 1.5))
    return (misjudged(lambda x: True, points, 0.5, 3.0),
            misjudged(lambda x: (x[0] + 0.5) * (x[0] + 3) + x[2] ** 2 > 0, points, 0.5, 3.0))


def _paper_data_all_stable(line):
    """Share of equilibria misjudged for the paper's data (lambda1 = 100, 300, 500)."""
    total = 0.0
    for lam in (100, 300, 500):
        a, b = lam / 500, lam / 250
        rule = (lambda x: x[0] > x[2]) if line else (lambda x: True)
        total += misjudged(rule, middle_equilibria(a), a, b) / 3
    return total


def _time_scale():
    """Seconds in one tau, from the scaling of the package (u = 1)."""
    return float(scaling(Body((2000, 1500, 1000)), 1).time)


TESTS = {
    "existence": _exists_below_zero,
    "no product": _zero_product,
    "eight": _printed_eight,
    "characteristic": _characteristic,
    "major equilibria": lambda: (major_axis_ideal("1/5", "2/5"), major_axis_ideal("1/5", "1/5")),
    "major stability": _major_rule,
    "trend": _trend,
    "side": _side,
    "spin-up": _spins_up,
    "ranges": lambda: (_ranges(RANGES_PRINTED), _ranges(RANGES_TRUE)),
    "capture": _capture,
    "seconds": lambda: (1 - math.sqrt(1 / 12), _time_scale() - math.sqrt(12)),
    "always stable": _always_stable,
    "middle dividing line": lambda: (_paper_data_all_stable(True), _paper_data_all_stable(False)),
}
