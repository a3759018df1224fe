"""A table of bodies (CSV) as a case: a body a row, the names of the numbers with their units in the head.

The rows become a table [sweep] whose keys vary together, so that every command answers all of them. A head
such as `Ixx [kg m^2]` or `wx (deg/s)` names a number and its unit; products of inertia are entries of the
tensor.

SolidWorks' exporter of robot descriptions writes such a table beside each of them, with a link a row and
heads without units (`Link Name`, `Moment Ixx`, `Center of Mass X`): kg, m and kg m^2, about the mass centre,
as in the description.
"""
from __future__ import annotations

import os
import re
from pathlib import Path
from typing import Any, NamedTuple

from ...errors import InputError, printable
from ...numbers.exact import exact
from ...numbers.units import INERTIA, LENGTH, MASS, MOMENTUM, RATE, TORQUE, Dimension, in_dimension
from ..formats import TABLE_HEAD, cells_of, split_head
from ..write import text_of
from .imported import listed


class Column(NamedTuple):
    """key: of the case, with the index of its component; unit: as the head has it; at: its number in a
    row."""

    key: str
    component: int
    unit: str
    at: int
    head: str


AXES = {"x": 0, "1": 0, "p": 0, "y": 1, "2": 1, "q": 1, "z": 2, "3": 2, "r": 2}
# (key of the case, pattern of a head with its axis, dimension of its unit, an example)
VECTORS: tuple[tuple[str, str, Dimension, str], ...] = (
    ("effects.gyrostat.momentum", r"(?:h|wheel|momentum)_?([xyz123])", MOMENTUM, "hx [N m s]"),
    ("effects.constant_torque.torque", r"(?:t|tau|torque)_?([xyz123])", TORQUE, "torque_x [N m]"),
    ("motion.angular_velocity", r"(?:w|omega|rate|angular_velocity)_?([xyz123])|([pqr])", RATE, "wx [deg/s]"),
    ("body.centre_of_mass", r"(?:cent(?:er|re)[ _]of[ _]mass|com)[ _]?([xyz123])", LENGTH, "com_x [m]"))
ENTRY = re.compile(TABLE_HEAD, re.IGNORECASE)
PLACES = {"xx": 0, "yy": 1, "zz": 2, "xy": 3, "yx": 3, "xz": 4, "zx": 4, "yz": 5, "zy": 5}
DIGITS = str.maketrans("123", "xyz")
NAMES = ("name", "body", "id", "title", "object", "spacecraft", "link name")
# what marks a table of SolidWorks' exporter, its units, and columns that are 0 there: the tensor is along the
# axes of the link
EXPORTED = {"link name", "moment ixx", "center of mass x"}
SI: dict[Dimension, str] = {INERTIA: "kg m^2", MASS: "kg", LENGTH: "m"}
UNTURNED = ("center of mass roll", "center of mass pitch", "center of mass yaw")


def read(text: str, path: Path, body: None = None) -> str:
    """The case of all rows as TOML. Raises InputError for a head or a cell that is not understood, with its
    line."""
    (line, head), *data = cells_of(text)
    if not data:
        raise _fault(path, line, "", "the table has no row below its head: add one for each body")
    columns, named, left = _columns(head, line, path)
    empty = [(number, row) for number, row in data if _is_empty(row, columns)]
    data = [item for item in data if item not in empty]
    if not data:
        raise _fault(path, line, "", "every row has the mass 0 and no moments: write those of a body")
    bodies = [_body(row, number, columns, head, path) for number, row in data]
    keys = list(bodies[0])
    tables: dict[str, Any] = {}
    source = f"imported from {os.path.basename(os.fspath(path))}"
    if named is not None:
        source += ": " + ", ".join(f"{n} {row[named].strip()}" for n, (_, row) in enumerate(data, 1)
                                   if named < len(row))
    title = f"{len(data)} bodies" if len(data) > 1 else _title(data[0][1], named, Path(path).stem)
    result: dict[str, Any] = {"title": title, "source": source}
    caveats = [f"columns of the imported table that are not read: {listed(left)}"] if left else []
    if empty:
        rows = [_title(row, named, f"line {number}") for number, row in empty]
        caveats.append(f"rows of the imported table without mass and moments are left out: {listed(rows)}")
    result |= {"caveats": caveats} if caveats else {}
    for key in keys:
        holder = tables
        *names, last = key.split(".")
        for name in names:
            holder = holder.setdefault(name, {})
        holder[last] = bodies[0][key]
    values = {key: [item[key] for item in bodies] for key in keys}
    swept = {key: rows for key, rows in values.items() if any(row != rows[0] for row in rows)}
    result |= tables
    if swept:
        result["sweep"] = {"together": True, **swept}
    return text_of(result)


def _title(row: list[str], named: int | None, otherwise: str) -> str:
    return row[named].strip() if named is not None and named < len(row) else otherwise


def _is_empty(row: list[str], columns: list[Column]) -> bool:
    """Whether the mass and all moments of a row are written as 0, as a frame without a body has them."""
    texts = [row[column.at] for column in columns if column.key in ("body.mass", "body.inertia")
             and column.at < len(row)]
    return bool(texts) and all(re.fullmatch(r"\s*[-+]?0*\.?0+(e[-+]?\d+)?\s*", text, re.I) for text in texts)


def _fault(path: Path, line: int, key: str, words: str) -> InputError:
    return InputError(f"{printable(str(path))}:{line}: "
                      f"{f'{printable(key)}: ' if key else ''}{printable(words)}")


def _columns(head: list[str], line: int, path: Path) -> tuple[list[Column], int | None, list[str]]:
    """(columns, the number of that with names, heads that are not read)."""
    columns: list[Column] = []
    named, left = None, []
    exported = {*map(str.lower, map(str.strip, head))} >= EXPORTED
    for at, cell in enumerate(head):
        name, unit = split_head(cell)
        column = _column(name, unit, at, cell.strip(), line, path, exported)
        if column is None and name.lower() in NAMES and named is None:
            named = at
        elif column is None and name.lower() not in UNTURNED:
            left.append(cell.strip())
        elif column is None:
            continue
        elif any((column.key, column.component) == (other.key, other.component) for other in columns):
            raise _fault(path, line, cell.strip(), "a second column with this number: leave one")
        else:
            columns.append(column)
    given = {(column.key, column.component) for column in columns}
    missing = [f"I{axes} [kg "
               "m^2]" for axes, n in list(PLACES.items())[:3] if ("body.inertia", n) not in given]
    if missing:
        raise _fault(path, line, "", f"the head has no {', '.join(missing)}: add the moments of inertia")
    for key, _, _, example in VECTORS:
        parts = [n for n in range(3) if (key, n) in given]
        if parts and len(parts) < 3:
            raise _fault(path, line, key, f"expected three components, such as {example} and the others, got "
                                          f"{len(parts)}")
    return columns, named, left


def _column(name: str, unit: str, at: int, cell: str, line: int, path: Path, exported: bool) -> Column | None:
    entry = ENTRY.fullmatch(name)
    dimension: Dimension
    if entry:
        axes = entry[1].lower().translate(DIGITS)
        key, index, dimension = "body.inertia", PLACES[axes if len(axes) == 2 else axes * 2], INERTIA
    elif name.lower() in ("m", "mass"):
        key, index, dimension = "body.mass", 0, MASS
    else:
        matches = ((re.fullmatch(row[1], name, re.IGNORECASE), row) for row in VECTORS)
        match, row = next(((match, row) for match, row in matches if match), (None, VECTORS[0]))
        if match is None:
            return None
        key, dimension = row[0], row[2]
        index = AXES[next(part for part in match.groups() if part).lower()]
    unit = unit or exported and SI.get(dimension, "") or ""
    try:
        if not unit:
            raise InputError("a unit is missing")
        in_dimension(unit, dimension)
    except InputError as error:
        raise _fault(path, line, cell, f"{error}; write the unit behind the name, as in Ixx [kg m^2], wx "
                                       "[deg/s]") from None
    return Column(key, index, unit, at, cell)


def _body(row: list[str], line: int, columns: list[Column], head: list[str], path: Path) -> dict[str, Any]:
    """The values of a row, by the keys of the case."""
    if len(row) != len(head):
        raise _fault(path, line, "", f"expected {len(head)} cells as in the head, got {len(row)}")
    for name, cell in zip(head, row):
        if name.strip().lower() in UNTURNED and cell.strip().strip("-0.") not in ("",):
            raise _fault(path, line, name.strip(), f"expected 0, got {cell.strip()[:40]}: write the moments "
                                                   "along the axes of the body")
    parts: dict[str, dict[int, Any]] = {}
    for column in columns:
        try:
            exact(row[column.at].strip())
        except InputError as error:
            raise _fault(path, line, column.head, str(error)) from None
        parts.setdefault(column.key, {})[column.component] = f"{row[column.at].strip()} {column.unit}".strip()
    result: dict[str, Any] = {}
    for key, numbers in parts.items():
        if key == "body.mass":
            result[key] = numbers[0]
        elif key == "body.inertia":
            result[key] = _tensor(numbers)
        else:
            result[key] = [numbers[n] for n in range(3)]
    return result


def _tensor(numbers: dict[int, str]) -> list[Any]:
    """Three moments, or three rows where there are columns of products."""
    if max(numbers) < 3:
        return [numbers[n] for n in range(3)]
    zero = f"0 {numbers[0].partition(' ')[2]}"
    xx, yy, zz, xy, xz, yz = (numbers.get(n, zero) for n in range(6))
    return [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
