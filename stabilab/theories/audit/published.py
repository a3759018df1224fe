"""A published formula as data, and the tools that try it on the true equations of motion.

Every row carries a test with two residuals, of the printed formula and of the corrected one. A residual is a number
that vanishes when the formula is true; each row says of what it is the residual.
"""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

TRUE_BELOW = 1e-12   # residuals are evaluated with 30 digits or as exact counts; a false formula leaves 1e-3 or more
FALSE_ABOVE = 1e-3
VERDICTS = ("right", "wrong", "misprint", "right only for these data")


@dataclass(frozen=True)
class Published:
    """One formula or claim of a paper.

    where: equation, figure or paragraph. printed: what the paper prints; claim: what it says the formula does.
    verdict: one of VERDICTS. corrected: the true statement ("" where the printed one is right). residual_of: what the
    numbers of `test` measure; test() -> (residual of the printed formula, residual of the corrected one).
    """

    where: str
    printed: str
    claim: str
    verdict: str
    corrected: str
    residual_of: str
    test: Callable[[], tuple[float, float]]
    bound: float = TRUE_BELOW


@dataclass(frozen=True)
class Finding:
    """A row after its test: `confirmed` says that the verdict agrees with the residuals."""

    row: Published
    printed_residual: float
    corrected_residual: float
    confirmed: bool


def examine(row: Published) -> Finding:
    """Run the row's test and hold its verdict to it."""
    printed, corrected = (abs(float(v)) for v in row.test())
    if row.verdict == "right":
        confirmed = printed <= row.bound
    else:
        confirmed = printed >= FALSE_ABOVE and corrected <= row.bound
    return Finding(row, printed, corrected, confirmed)


# -- the true equations, and a state at which nothing is special ------------------------------------------------------

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


def field(axis: str):
    """The true rates (x1', x2', x3') for a unit torque on the axis, as SymPy expressions."""
    s, mu = symbols(), AXES[axis]
    return (s["x2"] * s["x3"] + mu[0], -s["x3"] * (s["x1"] + s["a"]) + mu[1], s["x2"] * (s["x1"] + s["b"]) + mu[2])


def parse(formula: str, **more):
    """A SymPy expression in x1, x2, x3, a, b, c and any further names."""
    import sympy as sp
    names = {**symbols(), "pi": sp.pi, **{f: getattr(sp, f) for f in
             ("sin", "cos", "sinh", "cosh", "exp", "log", "sqrt", "atan", "atanh", "asin")}, **more}
    return sp.sympify(formula, locals=names)


def number(expression, at=None) -> float:
    """Value with 30 digits, rounded."""
    return float(expression.subs(generic() if at is None else at).evalf(30))


def drift(integral: str, axis: str, at=None) -> float:
    """Rate of change of a claimed constant of motion along the true motion, at one state."""
    s = symbols()
    expression = parse(integral)
    rate = sum(expression.diff(s[f"x{i + 1}"]) * f for i, f in enumerate(field(axis)))
    return number(rate, at)


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
