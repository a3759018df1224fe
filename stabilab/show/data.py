"""Data as JSON and CSV, with every digit of a double."""
from __future__ import annotations

import math
from collections.abc import Iterable

from ..reasons import Reason

# numbers by JSON's grammar, beyond all doubles: Python, JavaScript and MATLAB read them as infinite
ENDLESS = {math.inf: "1e999", -math.inf: "-1e999"}
MARK = "\0 endless "  # before such a number in the text until its quotes are taken off


class Endless(float):
    """The end of an interval, written as infinite where it is, where null would stand for not known."""


def endless(values: list) -> list:
    """The values of a column, infinite ones written as such."""
    return [Endless(value) if isinstance(value, float) and math.isinf(value) else value for value in values]


def as_json(value) -> str:
    """JSON with every digit of a double; null: does not exist, and infinity but of `Endless`."""
    import json
    text = json.dumps(plain(value), allow_nan=False, ensure_ascii=False, indent=1)
    for printed in ENDLESS.values():
        text = text.replace(json.dumps(MARK + printed), printed)
    return text


def plain(value):
    """The value in lists, dicts, floats and None: complex numbers as [re, im], infinities and NaN as None.
    What is `Endless` is a marked string where it is infinite."""
    if isinstance(value, dict):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in value]
    if isinstance(value, complex):
        return [plain(value.real), plain(value.imag)]
    if isinstance(value, Endless) and value in ENDLESS:
        return MARK + ENDLESS[value]
    if isinstance(value, float):
        return float(value) + 0.0 if math.isfinite(value) else None
    if isinstance(value, Reason):
        return plain(value.as_dict())
    if hasattr(value, "tolist"):  # NumPy scalars and arrays
        return plain(value.tolist())
    return value


def csv_lines(rows: Iterable[Iterable[float | str]]) -> str:
    """One line per row, each ended: floats with every digit ("inf" where unbounded), an empty cell for None,
    words quoted where needed."""
    import csv  # classify, which shows no table, does without it
    import io
    out = io.StringIO()
    cell = lambda v: "" if v is None else repr(float(v)) if isinstance(v, float) else v
    csv.writer(out, lineterminator="\n").writerows([map(cell, row) for row in rows])
    return out.getvalue()
