"""The facts that a case's test asserts: equilibria, verdicts, fate and extremes, each known before the program ran."""
from __future__ import annotations

from .table import Table, Written, described

KINDS = ("none", "points", "curves", "all")
FATES = ("bounded", "spin-up", "separatrix", "equilibrium", "undecided")
VERDICTS = ("stable", "unstable", "undecided")
KEYS = ("kind", "points", "fate", "axis", "verdicts", "extremes", "period")


def expected(table: Table | None) -> dict:
    """[expect] with its numbers as floats; faults are kept by the table.

    kind, points (how many), verdicts (one per point), fate, axis (1, 2, 3), period, extremes: three pairs [min, max]
    (inf where unbounded).
    """
    if table is None:
        return {}
    table.known(KEYS)
    return {key: READERS[key](table, key) for key in table.data if key in KEYS}


def _word(words):
    def read(table: Table, key: str):
        value = table.data[key]
        if value not in words or isinstance(value, Written):
            table.fault(f"expected one of {', '.join(words)}; got {described(value)}", key)
        return value
    return read


def _whole(lowest: int, highest: int):
    def read(table: Table, key: str):
        value = table.data[key]
        if isinstance(value, bool) or not isinstance(value, int) or not lowest <= value <= highest:
            table.fault(f"expected a whole number from {lowest} to {highest}, got {described(value)}", key)
        return value
    return read


def _verdicts(table: Table, key: str):
    value = table.data[key]
    if not isinstance(value, list) or not all(isinstance(v, str) and v in VERDICTS for v in value):
        table.fault(f"expected a list of the words {', '.join(VERDICTS)}; got {described(value)}", key)
    return value


def _extremes(table: Table, key: str):
    value = table.data[key]
    if not isinstance(value, list) or len(value) != 3 or not all(isinstance(p, list) and len(p) == 2 for p in value):
        table.fault(f"expected three pairs [min, max], got {described(value)}", key)
        return None
    return [[_float(table, v, key) for v in pair] for pair in value]


def _period(table: Table, key: str):
    return _float(table, table.data[key], key)


def _float(table: Table, value, key: str) -> float | None:
    """A number, or inf; a string is read as an exact number."""
    if isinstance(value, Written) and value.lstrip("+-") == "inf":
        return float(value)
    number = Table(table.path, {key: value}, table.faults).number(key)
    return None if number is None else float(number)


READERS = {"kind": _word(KINDS), "points": _whole(0, 10**6), "fate": _word(FATES), "axis": _whole(1, 3),
           "verdicts": _verdicts, "extremes": _extremes, "period": _period}
