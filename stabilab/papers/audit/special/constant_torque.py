"""The scaled gyrostat of Amer et al. 2024 under a unit torque, for claims that a typed formula cannot say."""
from __future__ import annotations

from functools import lru_cache

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
    import numpy as np
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
