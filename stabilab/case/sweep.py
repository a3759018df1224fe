"""[sweep] of a case file: keys that take several values, every combination of them one case."""
from __future__ import annotations

import copy
from itertools import product

from .table import Table, described

MOST = 10_000  # combinations; a sweep beyond that is a program's work, not a file's
SWEPT = ("body", "effects", "scaled", "motion", "thrusters", "wheels", "limits")


def combinations(top: Table) -> list[tuple[str, dict]]:
    """(suffix, data) of every combination, the last key running fastest; empty without [sweep]. Suffix "-2-1": the
    second value of the first key, the first of the second. Faults are kept by the table."""
    paths, choices = swept(top)
    plain = {key: value for key, value in top.data.items() if key not in ("sweep", "expect")}
    return [("".join(f"-{i}" for i, _ in pick), _with(plain, paths, pick)) for pick in product(*choices)] if paths else []


def swept(top: Table) -> tuple[list[tuple], list[list]]:
    """The paths that [sweep] replaces and the numbered values of each, both empty where it cannot be run; keeps the faults."""
    table = top.table("sweep")
    if table is None:
        return [], []
    paths, choices = [], []
    for key, values in table.data.items():
        path = place(top.data, key)
        if not isinstance(values, list) or not values:
            table.fault(f"expected a list of the values that {key} takes, got {described(values)}", key)
        elif _holder(top.data, path) is None:
            table.fault(f"this file has no key {key}; write it as \"effects.gyrostat.momentum\" or \"thrusters.NAME.force\", "
                        "with a value in its place", key)
        else:
            paths.append(path)
            choices.append(list(enumerate(values, 1)))
    count = 1
    for values in choices:
        count *= len(values)
    if count > MOST:
        table.fault(f"{count} combinations; at most {MOST} are run from one file")
        return [], []
    return paths, choices


def place(data, key: str) -> tuple:
    """The path of a key of [sweep]; a thruster or wheel is named, and stands at its index."""
    path = tuple(key.split("."))
    if len(path) == 3 and isinstance(data.get(path[0]), list):
        at = [i for i, one in enumerate(data[path[0]]) if isinstance(one, dict) and one.get("name") == path[1]]
        return (path[0], at[0], path[2]) if at else path
    return path


def _holder(data, path):
    """The table that holds the key of this path, or None."""
    if len(path) < 2 or path[0] not in SWEPT:
        return None
    for part in path[:-1]:
        if isinstance(data, list):
            data = data[part] if isinstance(part, int) else None
        else:
            data = data.get(part) if isinstance(data, dict) else None
    return data if isinstance(data, dict) and path[-1] in data else None


def _with(plain, paths, pick):
    data = copy.deepcopy(plain)
    for path, (_, value) in zip(paths, pick):
        _holder(data, path)[path[-1]] = value
    return data
