"""What curves of equilibria are called, their equations and parametrisations, with the numbers in them."""
from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import reduce

from ..reasons import Coefficient, Formula, Reason, Sentence

RATE, RATE_SQUARED, ANGLE = "rad/s", "(rad/s)^2", "rad"  # of numbers and parameters of curves

# Their names
LINE = Sentence("equilibrium-line", "equilibrium line")()
HYPERBOLA = Sentence("equilibrium-hyperbola", "equilibrium hyperbola")()
LINE_ALONG = Sentence("equilibrium-line-along", "equilibrium line along {component}")
AXIS_LINE = Sentence("line-along", "line along {component}")
LINE_ALONG_WHEEL = Sentence("line-along-wheel", "line along the gyrostatic moment")()
PLANE = Sentence("plane-of-equilibria", "plane {component} = {value}")
LESSER = Sentence("lesser-rate", "lesser Ω")()
GREATER = Sentence("greater-rate", "greater Ω")()
FOR_ANGLES = Sentence("for-angles", "for t in ({low}, {high})")
ALONG_ROTATION = Sentence("curve-along-rotation", "curve of momentum along rotation")()

# Clauses of their equations and parametrisations
IS = Sentence("component-is", "{component} = {value}")
ARBITRARY = Sentence("component-arbitrary", "{component} arbitrary")
ON_A_LINE = Sentence("on-straight-line", "({components}) on a straight line")
OVER_RATE = Sentence("over-rate", "t = Ω from {low} to {high} {unit}")
PRODUCT_IS = Sentence("product-is", "{first} {second} = {product}")
TURNS = Sentence("and-its-turns", "and its turns about {axis}")
OBLIQUE_PLANE = Sentence("oblique-plane", "ω = α N + {component} e, N = e x M = {normal}")
ALONG_ROTATION_EQUATION = Sentence("curve-along-rotation-equation", "D ω + λ = s ω")()
ALONG_ROTATION_RUN = Sentence("curve-along-rotation-run",
                              "ωᵢ = λᵢ/(s - Dᵢ), s = D{number} + 1/t, t = {component}/λ{number}")


@dataclass(frozen=True)
class Description:
    """A curve of equilibria in symbols, with its numbers. name, equation, parametrisation: sentences, whose
    clauses are equations; symbol: of the parameter, and unit: that of its values in SI ("" of a number)."""

    name: Reason
    equation: Reason
    parametrisation: Reason
    symbol: str = "t"
    unit: str = RATE

    @property
    def measured(self) -> bool:
        """Whether its numbers, or its parameter, are rates."""
        return self.unit == RATE or holds_rates(self.equation)


def holds_rates(reason: Reason) -> bool:
    """Whether a formula has numbers that are rates, or products of two, and do not vanish."""
    return any(part.value and part.unit in (RATE, RATE_SQUARED)
               for _, clause in reason.clauses() for _, value in clause.filled
               for part in (value.parts if isinstance(value, Formula) else (value,))
               if isinstance(part, Coefficient))


def component(name: str) -> Formula:
    """A symbol."""
    return Formula((name,))


def shifted(name: str, centre: Fraction) -> Formula:
    """"x1", "(x1 + 0.4)" or "(x1 - 0.4)" for the distance of a component from its centre."""
    if not centre:
        return component(name)
    return Formula((f"({name} {'-' if centre > 0 else '+'} ", Coefficient(abs(centre), RATE), ")"))


def over_parameter(constant: Fraction, number: Fraction, behind: str = " t",
                   unit: str = "") -> Formula | Coefficient:
    """A constant and a number before the parameter, such as "2 + 3 t", without terms that vanish. behind: the
    parameter as it stands behind its number; unit: of the number."""
    if not number:
        return Coefficient(constant, RATE)
    item = behind == " t" and abs(number) == 1
    term: tuple[str | Coefficient, ...] = ("t",) if item else (Coefficient(abs(number), unit), behind)
    if not constant:
        return Formula(("-", *term) if number < 0 else term)
    return Formula((Coefficient(constant, RATE), " - " if number < 0 else " + ", *term))


def clauses(result: Iterable[Reason]) -> Reason:
    """Equations one after the other."""
    return reduce(lambda before, item: before.then(item, ", "), result)


def line_text(names: Sequence[str], start: Sequence[Fraction],
              direction: Sequence[Fraction]) -> tuple[Reason, Reason]:
    """(equation, parametrisation) of start + t direction."""
    fixed = [IS(component=component(n), value=Coefficient(s, RATE))
             for n, s, d in zip(names, start, direction) if not d]
    free = [n for n, d in zip(names, direction) if d]
    along = (ARBITRARY(component=component(free[0])) if len(free) == 1
             else ON_A_LINE(components=component(", ".join(free))))
    moving = (IS(component=component(n), value=over_parameter(s, d))
              for n, s, d in zip(names, start, direction))
    return clauses([*fixed, along]), clauses(moving)
