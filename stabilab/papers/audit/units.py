"""Units of printed equations."""
from __future__ import annotations

from fractions import Fraction

from ...numbers.units import unit_of
from ...theories.printed.claims import Paper, Row
from .checks import bound_of, raw


# --- Whether the printed formulas of a row add like to like
def unit_fault(paper: Paper, row: Row) -> str:
    """Which terms of the printed formulas differ in unit; "" where none do."""
    import sympy as sp
    if row.options.get("units") is False or row.kind not in ("holds", "solves", "equilibrium", "order"):
        return ""
    data = paper.systems.get(row.system or "", {})
    time = dimension(_time_of(paper, data))
    units = {name: dimension(words) for name, words in paper.units.items()}
    bound = bound_of(paper, row)
    try:
        for name in [n for n in bound if n not in units]:
            units[name] = formula_unit(bound[name], units, time) or NONE
        for left, right in raw(paper, row.printed):
            formula_unit(sp.Add(left, -right, evaluate=False), units, time)
    except UnitFault as fault:
        return str(fault)
    return ""


def _time_of(paper, data):
    while "time" not in data and "follows" in data and "rates" not in data:
        data = paper.systems[data["follows"]]
    return data.get("time", "s")


# --- Whether the terms of a formula have one unit: dimensions carried through a SymPy tree, exponents of m,
# kg, s, A
BASE = ("m", "kg", "s", "A")
NONE: tuple = (0,) * len(BASE)


class UnitFault(Exception):
    """Two terms of a sum that differ in dimension, or a function of something with one."""


def dimension(words: str) -> tuple:
    """Of "kg m^2 s^-1" or "N m/s", an angle being a number. InputError for unknown units."""
    return unit_of(words).dimension[:len(BASE)]


def times(first: tuple, second: tuple, power=1) -> tuple:
    return tuple(a + b * power for a, b in zip(first, second))


def told(unit: tuple) -> str:
    return " ".join(name if power == 1 else f"{name}^{power}" for name, power in sorted(zip(BASE, unit))
                    if power) or "no unit"


def formula_unit(expression, units: dict, time: tuple):
    """Dimension of a raw formula; units: symbol name -> dimension; time: dimension of the motion's time. None
    for a zero. Raises UnitFault."""
    import sympy as sp

    def visit(e):
        if e.is_Number:
            return None if e == 0 else NONE
        if e.is_Symbol:
            return units.get(e.name, NONE)
        if e.is_Add:
            found = [(term, visit(term)) for term in e.args]
            found = [(term, unit) for term, unit in found if unit is not None]
            for term, unit in found[1:]:
                if unit != found[0][1]:
                    raise UnitFault(f"{found[0][0]} [{told(found[0][1])}] is added to {term} [{told(unit)}]")
            return found[0][1] if found else None
        if e.is_Mul:
            out = NONE
            for factor in e.args:
                unit = visit(factor)
                if unit is None:
                    return None
                out = times(out, unit)
            return out
        if e.is_Pow and not e.args[1].free_symbols and e.args[1].is_Rational:
            unit = visit(e.args[0])
            return unit and times(NONE, unit, Fraction(int(e.args[1].p), int(e.args[1].q)))
        name = e.func.__name__
        if name in ("rate", "diff", "integral", "mean", "at", "conjugate", "re", "im", "Abs"):
            unit = visit(e.args[0])
            if unit is None or name not in ("rate", "diff", "integral"):
                return unit
            if name == "rate":
                return times(unit, time, -int(e.args[1]) if len(e.args) > 1 else -1)
            return times(unit, visit(e.args[1]) or NONE, -1 if name == "diff" else 1)
        if name == "atan2":
            first, second = map(visit, e.args)
            if None not in (first, second) and first != second:
                raise UnitFault(f"atan2 of {e.args[0]} [{told(first)}] and {e.args[1]} [{told(second)}]")
            return NONE
        if isinstance(e, (sp.NumberSymbol, sp.core.numbers.ImaginaryUnit)):
            return NONE
        for argument in e.args:
            unit = visit(argument)
            if any(unit or ()):
                raise UnitFault(f"{e.func.__name__}({argument}): its argument has the unit {told(unit)}")
        return NONE

    return visit(expression)
