"""The equations of a scene as lines of text and as LaTeX."""
from __future__ import annotations

from ...physics.equations import Equations, Symbolic

# parameters whose names are products
PRODUCTS = {"Mgx": "M g x_c", "Mgy": "M g y_c", "Mgz": "M g z_c", "eHl2": "e H l^2",
            "kd": "k_d", "cd": "c_d", "kB2": "k B^2"}
WORDS = ("mass",)  # parameters whose names are words


def lines(equations: Equations) -> tuple[str, ...]:
    """The equations of motion as plain text, one line each."""
    return tuple(f"{_left(d, x)}' = {right_side(equations, i)}" for i,
                 (d, x) in enumerate(zip(equations.inertia, equations.state)))


def _left(d: Symbolic, x: Symbolic) -> str:
    return str(x) if d == 1 else f"({d}) {x}" if d.is_Add else f"{d} {x}"


def right_side(equations: Equations, i: int) -> Symbolic:
    """What the rate of component i equals, times its moment of inertia where it has one: a sum ordered by the
    powers of the state."""
    from sympy import Poly, PolynomialError, prod
    total = sum(part[i] for part in equations.torques.values()) if i < 3 else equations.rhs[i]
    try:
        terms = Poly(total, *equations.state).terms()
    except PolynomialError:
        return total
    return sum(factor * prod(x**n for x, n in zip(equations.state, powers)) for powers, factor in terms)


def latex(equations: Equations) -> str:
    """The equations of motion as a LaTeX align* environment."""
    factor = lambda d: "" if d == 1 else rf"\left({tex(d)}\right) " if d.is_Add else f"{tex(d)} "
    rows = [rf"{factor(d)}\dot{{{tex(x)}}} &= {tex(right_side(equations, i))}"
            for i, (d, x) in enumerate(zip(equations.inertia, equations.state))]
    return "\\begin{align*}\n" + " \\\\\n".join(rows) + "\n\\end{align*}"


def tex(expression: Symbolic) -> str:
    """A formula in LaTeX: words upright, and names that stand for a product as that product."""
    from sympy import latex as of_sympy
    names = {symbol: rf"\mathrm{{{symbol.name}}}" if symbol.name in WORDS else f"{{{PRODUCTS[symbol.name]}}}"
             for symbol in expression.free_symbols if symbol.name in PRODUCTS or symbol.name in WORDS}
    made = of_sympy(expression, symbol_names=names)
    for product in PRODUCTS.values():  # a power is that of all its letters
        made = made.replace(f"{{{product}}}^", rf"\left({product}\right)^").replace(f"{{{product}}}", product)
    return made
