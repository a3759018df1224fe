"""Whether the printed formulas of a row add like to like."""
from __future__ import annotations

from ...theories.printed.claims import Paper, Row
from .checks import bound_of, raw
from .units import UnitFault, dimension, unit_of


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
        for name in bound:
            if name not in units:
                units[name] = None
        for name in [n for n, u in units.items() if u is None]:
            units[name] = unit_of(bound[name], {k: v for k, v in units.items() if v is not None}, time) or {}
        for left, right in raw(paper, row.printed):
            unit_of(sp.Add(left, -right, evaluate=False), units, time)
    except UnitFault as fault:
        return str(fault)
    return ""


def _time_of(paper, data):
    while "time" not in data and "follows" in data and "rates" not in data:
        data = paper.systems[data["follows"]]
    return data.get("time", "s")
