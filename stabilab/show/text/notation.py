"""The equations of a scene as lines of text and as LaTeX."""
from __future__ import annotations

from ...physics.equations import Equations, Symbolic


def lines(equations: Equations) -> tuple[str, ...]:
    """The equations of motion as plain text, one line each."""
    return tuple(f"{_left(d, x)}' = {right_side(equations, i)}" for i, (d, x) in enumerate(zip(equations.inertia, equations.state)))


def _left(d: Symbolic, x: Symbolic) -> str:
    return str(x) if d == 1 else f"{d} {x}"


def right_side(equations: Equations, i: int) -> Symbolic:
    """What the rate of component i equals, times its moment of inertia where it has one: a sum ordered by the powers of the state."""
    from sympy import Poly, PolynomialError, prod
    total = sum(part[i] for part in equations.torques.values()) if i < 3 else equations.rhs[i]
    try:
        terms = Poly(total, *equations.state).terms()
    except PolynomialError:
        return total
    return sum(factor * prod(x**n for x, n in zip(equations.state, powers)) for powers, factor in terms)


def latex(equations: Equations) -> str:
    """The equations of motion as a LaTeX align* environment."""
    from sympy import latex as tex
    rows = [rf"{'' if d == 1 else tex(d) + ' '}\dot{{{tex(x)}}} &= {tex(right_side(equations, i))}"
            for i, (d, x) in enumerate(zip(equations.inertia, equations.state))]
    return "\\begin{align*}\n" + " \\\\\n".join(rows) + "\n\\end{align*}"
