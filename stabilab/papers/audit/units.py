"""Units of printed equations."""
from __future__ import annotations

import re
from fractions import Fraction

from ...errors import InputError
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
            units[name] = unit_of(bound[name], units, time) or {}
        for left, right in raw(paper, row.printed):
            unit_of(sp.Add(left, -right, evaluate=False), units, time)
    except UnitFault as fault:
        return str(fault)
    return ""


def _time_of(paper, data):
    while "time" not in data and "follows" in data and "rates" not in data:
        data = paper.systems[data["follows"]]
    return data.get("time", "s")


# --- Whether the terms of a formula have one unit: dimensions carried through a SymPy tree
BASE = {"m": {"m": 1}, "kg": {"kg": 1}, "s": {"s": 1}, "A": {"A": 1}, "rad": {}, "1": {},
        "N": {"kg": 1, "m": 1, "s": -2}, "J": {"kg": 1, "m": 2, "s": -2}, "W": {"kg": 1, "m": 2, "s": -3},
        "C": {"A": 1, "s": 1}, "T": {"kg": 1, "s": -2, "A": -1}}


class UnitFault(Exception):
    """Two terms of a sum that differ in dimension, or a function of something with one."""


def dimension(words: str) -> dict:
    """Exponents of the base units of "kg m^2 s^-1" or "N m/s". InputError for unknown ones."""
    total: dict = {}
    for sign, part in zip((1, -1, -1), words.split("/")):
        for word in part.split():
            found = re.fullmatch(r"([A-Za-z]+|1)(?:\^(-?[\d/]+))?", word)
            if not found or found[1] not in BASE:
                raise InputError(
                    f"unknown unit {word!r} in {words!r}: known are {', '.join(BASE)} with exponents as in "
                    f"m^2 or s^-1")
            total = times(total, BASE[found[1]], sign * Fraction(found[2] or 1))
    return total


def times(first: dict, second: dict, power=1) -> dict:
    out = dict(first)
    for name, exponent in second.items():
        out[name] = out.get(name, 0) + exponent * power
    return {name: exponent for name, exponent in out.items() if exponent}


def told(unit: dict) -> str:
    return (" ".join(name if power == 1 else f"{name}^{power}" for name, power in sorted(unit.items()))
            or "no unit")


def unit_of(expression, units: dict, time: dict):
    """Dimension of a raw formula; units: symbol name -> dimension; time: dimension of the motion's time. None
    for a zero. Raises UnitFault."""
    import sympy as sp

    def visit(e):
        if e.is_Number:
            return None if e == 0 else {}
        if e.is_Symbol:
            return units.get(e.name, {})
        if e.is_Add:
            found = [(term, visit(term)) for term in e.args]
            found = [(term, unit) for term, unit in found if unit is not None]
            for term, unit in found[1:]:
                if unit != found[0][1]:
                    raise UnitFault(f"{found[0][0]} [{told(found[0][1])}] is added to {term} [{told(unit)}]")
            return found[0][1] if found else None
        if e.is_Mul:
            out: dict = {}
            for factor in e.args:
                unit = visit(factor)
                if unit is None:
                    return None
                out = times(out, unit)
            return out
        if e.is_Pow and not e.args[1].free_symbols and e.args[1].is_Rational:
            unit = visit(e.args[0])
            return unit and times({}, unit, Fraction(int(e.args[1].p), int(e.args[1].q)))
        name = e.func.__name__
        if name in ("rate", "diff", "integral", "mean", "at", "conjugate", "re", "im", "Abs"):
            unit = visit(e.args[0])
            if unit is None or name not in ("rate", "diff", "integral"):
                return unit
            if name == "rate":
                return times(unit, time, -int(e.args[1]) if len(e.args) > 1 else -1)
            return times(unit, visit(e.args[1]) or {}, -1 if name == "diff" else 1)
        if name == "atan2":
            first, second = map(visit, e.args)
            if None not in (first, second) and first != second:
                raise UnitFault(f"atan2 of {e.args[0]} [{told(first)}] and {e.args[1]} [{told(second)}]")
            return {}
        if isinstance(e, (sp.NumberSymbol, sp.core.numbers.ImaginaryUnit)):
            return {}
        for argument in e.args:
            unit = visit(argument)
            if unit:
                raise UnitFault(f"{e.func.__name__}({argument}): its argument has the unit {told(unit)}")
        return {}

    return visit(expression)
