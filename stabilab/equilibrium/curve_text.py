"""Words about curves of equilibria."""
from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from ..numbers.vectors import Number


def decimal(value: Number) -> str:
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


def sum_of(*terms: Number | str) -> str:
    """A readable sum of numbers and strings such as "2 + t", without zero terms."""
    out = ""
    for term in terms:
        text = term if isinstance(term, str) else decimal(term) if term else ""
        if text:
            out += text if not out else f" - {text[1:]}" if text.startswith("-") else f" + {text}"
    return out or "0"


def line_text(names: Sequence[str], start: Sequence[Fraction], direction: Sequence[Fraction]) -> tuple[str, str]:
    """(equation, parametrisation) of start + t direction."""
    fixed = [f"{n} = {decimal(s)}" for n, s, d in zip(names, start, direction) if not d]
    free = [n for n, d in zip(names, direction) if d]
    moving = []
    for s, d in zip(start, direction):
        term = "t" if d == 1 else "-t" if d == -1 else f"{decimal(d)} t" if d else ""
        moving.append(sum_of(s, term))
    along = f"{free[0]} arbitrary" if len(free) == 1 else f"({', '.join(free)}) on a straight line"
    return ", ".join(fixed + [along]), ", ".join(f"{n} = {v}" for n, v in zip(names, moving))
