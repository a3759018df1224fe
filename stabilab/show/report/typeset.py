"""Formulas as MathML, which a browser sets by itself: no script, no font, nothing from a network."""
from __future__ import annotations

from functools import lru_cache

from ...physics.equations import Equations
from ..text.notation import right_side

LONG = 40  # operations: a law of more is told in words alone


def equations_of_motion(equations: Equations) -> list:
    """An equation a component of the state, its rate with a dot: what multiplies it on the left, the sum on the right."""
    rows = []
    for number, (moment, part) in enumerate(zip(equations.inertia, equations.state)):
        left = ("" if moment == 1 else inner(moment)) + f"<mover>{inner(part)}<mo>&#x2D9;</mo></mover>"
        rows.append(display(f"{left}<mo>=</mo>{inner(right_side(equations, number))}"))
    return rows


def display(content: str):
    """A line of its own."""
    from markupsafe import Markup
    return Markup(f'<math display="block"><mrow>{content}</mrow></math>')


def inline(expression):
    """An expression within a sentence."""
    from markupsafe import Markup
    return Markup(f"<math><mrow>{inner(expression)}</mrow></math>")


def symbol(name: str):
    """A symbol by its name: lambda1 with its Greek letter and its index."""
    return inline(_symbol(name))


@lru_cache(maxsize=256)
def _symbol(name):
    from sympy import Symbol
    return Symbol(name)


def law(balance) -> str:
    """The quantity that a law speaks of, and its rate where that is not zero; empty where the formula is too long to be read."""
    from sympy import Integer, count_ops
    quantity, rate = rounded(balance.quantity), rounded(Integer(0) + balance.rate)
    if count_ops(quantity) + count_ops(rate) > LONG:
        return ""
    changes = "<mtext>&#x2009;constant</mtext>" if rate == 0 else f"<mo>)</mo><mo>&#x2D9;</mo><mo>=</mo>{inner(rate)}"
    return display(f"{'' if rate == 0 else '<mo>(</mo>'}{inner(quantity)}{changes}")


def rounded(expression):
    """The expression with numbers of many digits rounded to six."""
    from sympy import Float, Integer, Rational
    expression = Integer(0) + expression
    return expression.xreplace({number: Float(number, 6) for number in expression.atoms(Rational) if len(str(number)) > 8})


def inner(expression) -> str:
    """The expression as presentation MathML, without the element around it."""
    from sympy import Integer
    from sympy.printing.mathml import mathml
    return mathml(Integer(0) + expression, printer="presentation").replace("<mo>-</mo>", "<mo>&#x2212;</mo>")
