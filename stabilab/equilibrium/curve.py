"""A curve of equilibria in exact form: rational in its parameter, cut where stability changes."""
from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction
from typing import Callable, NamedTuple

from ..errors import InputError
from ..numbers.polynomial import Poly

T = Poly((0, 1))
ONE_POLY = Poly((1,))
Verdict = tuple[str, str]  # (word, because)


class Grounds(NamedTuple):
    """Why a curve's points are what they are: verdicts for m > 0 and for a zero of m by the signs of m beside it."""

    positive: Verdict
    odd: Verdict        # m changes sign
    minimum: Verdict    # m > 0 on both sides
    maximum: Verdict    # m < 0 on both sides


@dataclass(frozen=True)
class RationalCurve:
    """x_i(t) = numerators[i](t)/denominator(t). crossings: parameter where another curve meets this one -> verdict.
    poles: zeros of the denominator, rising, all rational. scale: a parameter size at which something happens."""

    name: str
    equation: str
    parametrisation: str
    numerators: tuple[Poly, Poly, Poly]
    grounds: Grounds
    denominator: Poly = ONE_POLY
    poles: tuple[Fraction, ...] = ()
    crossings: dict[Fraction, Verdict] = field(default_factory=dict)
    scale: Fraction = Fraction(1)

    def exact_point(self, t: Fraction) -> tuple[Fraction, Fraction, Fraction]:
        """The equilibrium at a rational t that is not a pole."""
        bottom = self.denominator(t)
        return tuple(n(t) / bottom for n in self.numerators)

    def float_point(self) -> Callable[[float], tuple[float, float, float]]:
        """point(t) for a float t, each coordinate rounded once; InputError at a pole or a t that is not finite."""
        def point(t: float):
            try:
                return tuple(float(v) for v in self.exact_point(Fraction(t)))
            except (ZeroDivisionError, OverflowError, ValueError):
                raise InputError(f"t = {t!r} lies at an end of the curve ({self.name}): no equilibrium there") from None
        return point


def decimal(value) -> str:
    """A number for the user's eye: the shortest decimal that reads back as the same double; six digits beyond the doubles."""
    try:
        number = float(value)
    except OverflowError:
        number = 0.0
    if value and not number:
        from decimal import Context
        digits, value = Context(prec=6, Emin=-10**6, Emax=10**6), Fraction(value)
        return f"{digits.divide(digits.create_decimal(value.numerator), digits.create_decimal(value.denominator)):e}"
    return repr(number + 0.0).removesuffix(".0")


def shifted(name: str, centre: Fraction) -> str:
    """"x1", "(x1 + 0.4)" or "(x1 - 0.4)" for the distance of a component from its centre."""
    return name if not centre else f"({name} {'-' if centre > 0 else '+'} {decimal(abs(centre))})"


def sum_of(*terms) -> str:
    """A readable sum of numbers and strings such as "2 + t", without zero terms."""
    out = ""
    for term in terms:
        text = term if isinstance(term, str) else decimal(term) if term else ""
        if text:
            out += text if not out else f" - {text[1:]}" if text.startswith("-") else f" + {text}"
    return out or "0"


def straight_line(start, direction) -> tuple[Poly, Poly, Poly]:
    """start + t direction as polynomials."""
    return tuple(Poly((s, d)) for s, d in zip(start, direction))


def line_text(names, start, direction) -> tuple[str, str]:
    """(equation, parametrisation) of start + t direction."""
    fixed = [f"{n} = {decimal(s)}" for n, s, d in zip(names, start, direction) if not d]
    free = [n for n, d in zip(names, direction) if d]
    moving = []
    for s, d in zip(start, direction):
        term = "t" if d == 1 else "-t" if d == -1 else f"{decimal(d)} t" if d else ""
        moving.append(sum_of(s, term))
    along = f"{free[0]} arbitrary" if len(free) == 1 else f"({', '.join(free)}) on a straight line"
    return ", ".join(fixed + [along]), ", ".join(f"{n} = {v}" for n, v in zip(names, moving))


def size_of(*vectors) -> Fraction:
    """The largest entry in size, 1 where all vanish: a scale for the parameter of a line."""
    return max((abs(v) for vector in vectors for v in vector), default=Fraction(0)) or Fraction(1)
