"""An atlas in words: names of directions and fates, their colours, text, CSV and JSON; as a data set of
xarray and a NetCDF file, from which it can be drawn again; and the public question."""
from __future__ import annotations

import math
import os
from collections.abc import Callable, Sequence
from itertools import repeat
from json import dumps, loads
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...answers.caveats import of_case
from ...case.given import Given, Span, Start, written
from ...case.read import read_text
from ...errors import InputError, printable
from ...maps.atlas import LEVEL, REFINE, Asked, Atlas, asked, drawn
from ...maps.columns import CAVEATS, ISLANDS, LEVELS, LIMIT_LEVELS, columns_of, record
from ...maps.pointed import AXES, OWN, THRUSTERS, Leaves, Point, area, corners, directions
from ...orbit.result import Fate
from ...packages import demand
from .. import limiting, style
from ..axes import axes_of
from ..data import as_json, csv_lines, endless
from ..text import questions
from ..units import SHORT, Units, with_unit
from .shades import FATES, limits_of, of_every_point, spinning, unit
from .sweep import COUNTS, checked, column_in, finished, origin, per_cent, write
from .sweep import DOES as OF_POINTS

if TYPE_CHECKING:
    import xarray


# --- How directions, axes and fates of an atlas are named, and the colour of each fate
DOES = OF_POINTS | {Fate.EQUILIBRIUM: ("keep a steady rotation", "keeps a steady rotation")}


def other_axis(atlas: Atlas) -> str:
    """About what a motion spins up that does so about no principal axis: of a sphere every axis is one, and
    the wheel or the torque chooses."""
    if len(set(atlas.asked.case.scene.body.exact)) > 1:  # type: ignore[union-attr]
        return "no principal axis"
    wheels = {any(wheel) for wheel in atlas.asked.wheels}
    return ("the wheel's axis" if wheels == {True} else "the torque's axis" if wheels == {False}
            else "the axis of the wheel, or of the torque")


def point_name(atlas: Atlas, point: Point) -> str:
    """"+z" and "-z" for the axes (of a full tensor "+minor" and "-minor"), a thruster's name, "torque of the
    case"."""
    if point.level == AXES:
        return axes_of(atlas.asked.case).signed(point.number // 2 + 1, -1 if point.number % 2 else 1)
    return "torque of the case" if point.level == OWN else atlas.asked.case.thrusters[point.number].name


def shown_name(atlas: Atlas, point: Point) -> str:
    """The name of a direction for a picture: that of an axis has the minus of a book."""
    name = point_name(atlas, point)
    return name.replace("-", "−") if point.level == AXES else name


def kind_words(atlas: Atlas, fate: int, axis: int, island: int = 0) -> str:
    """What a cell does, for a legend: "spins up about −z (minor)"."""
    if fate == Fate.SPIN_UP:
        if not axis:
            return f"{FATES[Fate.SPIN_UP][0]} about {other_axis(atlas)}"
        axes, sign = axes_of(atlas.asked.case), "−" if axis < 0 else "+"
        return f"{FATES[Fate.SPIN_UP][0]} about {sign}{axes.name(abs(axis))}"
    return FATES[Fate(fate)][0] + ("", ", an island may exist", ", an island is seen")[island]


def kind_colour(fate: int, axis: int) -> str:
    """The colour of its cells; which axis and which island, a hatch says (`kind_hatch`)."""
    if fate == Fate.SPIN_UP:
        return spinning(axis)
    return FATES[Fate(fate)][1]


def kind_hatch(fate: int, axis: int, island: int = 0) -> str:
    """The hatch of its cells: that of the axis of a spin-up, or of where an island may exist, or is seen."""
    return style.HATCH[abs(axis)] if fate == Fate.SPIN_UP else ("", "o", "O")[island]


def kinds(atlas: Atlas,
          rows: np.ndarray | None = None) -> list[tuple[tuple[int, int, int], np.ndarray, float]]:
    """((fate, axis with its sense, island), rows of cells, share of the sphere and of the wheels) of all that
    occurs, the most first."""
    chosen = np.arange(len(atlas.records)) if rows is None else rows
    records = atlas.records[chosen]
    visited = np.where(records["fate"] == Fate.UNDECIDED, records["island"], 0)
    keys = np.stack([records["fate"].astype(int), records["spin_axis"].astype(int), visited], axis=1)
    result, which = np.unique(keys, axis=0, return_inverse=True)
    which = which.ravel()
    full = atlas.share[chosen].sum()
    printed = [((int(key[0]), int(key[1]), int(key[2])), chosen[which == n],
             float(atlas.share[chosen][which == n].sum() / full))
            for n, key in enumerate(result)]
    return sorted(printed, key=lambda item: (-item[2], item[0]))


def wheel_words(atlas: Atlas, number: int) -> str:
    """A wheel's momentum as it was asked: "0.5 N m s"."""
    return f"{atlas.asked.momenta[number]:.6g} {atlas.asked.unit}"


def direction_words(vector: np.ndarray) -> str:
    """Three digits of a direction."""
    return ("(" + ", ".join(f"{v + 0.0:.3g}" if abs(v) >= 5e-4 else "0" for v in np.asarray(vector).tolist())
            + ")")


# --- What an atlas says in words, the answer first, and as CSV and JSON of every cell
ATLAS_SCHEMA = "stabilab.atlas/1"
ROWS = 12  # wheel momenta that are listed one by one


def text(atlas: Atlas, units: Units) -> str:
    """The answer in the first line; then what is behind it."""
    printed = limiting.lines(limits_of(atlas.asked.case, _all(atlas)), units)
    return limiting.ahead(of_case(atlas.asked.case), "\n".join([
        f"{atlas.asked.case.name}: {answer(atlas, units)}", *printed, *_wheels(atlas, units),
        *_details(atlas, units), *_named(atlas, units)]))


def _all(atlas: Atlas) -> np.ndarray:
    """The answers of cells and of directions with a name."""
    return np.concatenate([atlas.records, atlas.named_records])


def answer(atlas: Atlas, units: Units, rows: np.ndarray | None = None) -> str:
    """"78 % of directions spin up about z (minor axis), 22 % about x (major axis); shortest time to 30 deg/s:
    2.1 min at direction (...)"."""
    shares = _by_axis(atlas, rows)
    what = ("directions" if len(atlas.asked.wheels) == 1 or rows is not None
            else "directions and wheel momenta")
    parts = []
    for n, ((fate, axis), fraction) in enumerate(shares):
        about = axes_of(atlas.asked.case).head(axis) if axis else other_axis(atlas)
        verb = (f"about {about}" if n and shares[n - 1][0][0] == fate == Fate.SPIN_UP
                else f"spin up about {about}" if fate == Fate.SPIN_UP else DOES[Fate(fate)][0])
        parts.append(f"{per_cent(fraction)} of {what} {verb}" if not n else f"{per_cent(fraction)} {verb}")
    if len(shares) == 1:
        parts = [parts[0].replace("100 % of", "all", 1)]
    where = [axes_of(atlas.asked.case).direction_clause(axis) for (_, axis), _ in shares if rows is None]
    return "; ".join([*parts, *filter(None, (_shortest(atlas, units, rows), *where))])


def _by_axis(atlas: Atlas, rows: np.ndarray | None) -> list[tuple[tuple[int, int], float]]:
    """((fate, axis), share), both senses of an axis together; spin-ups beside each other, in order of what
    most do."""
    result: dict[tuple[int, int], float] = {}
    for (fate, axis, _), _, fraction in kinds(atlas, rows):
        result[fate, abs(axis)] = result.get((fate, abs(axis)), 0.0) + fraction
    total = {fate: sum(value for (other, _), value in result.items() if other == fate) for fate, _ in result}
    return sorted(result.items(), key=lambda item: (-total[item[0][0]], item[0][0], -item[1]))


def _shortest(atlas: Atlas, units: Units, rows: np.ndarray | None = None) -> str:
    if atlas.asked.stated_limit is None:
        return ""
    chosen = np.arange(len(atlas.records)) if rows is None else rows
    low, high = (atlas.records[name][chosen] for name in ("when_low", "when_high"))
    resolved = np.isfinite(low) & np.isfinite(high)
    if not resolved.any():
        return f"{limit_words(atlas, units)} is not known to be reached"
    at = int(chosen[resolved][np.argmin(low[resolved])])
    beside = (f", wheel {wheel_words(atlas, int(atlas.leaves.wheel[at]))}" if atlas.asked.momenta
              and rows is None else "")
    where = direction_words(atlas.in_file(atlas.directions[at:at + 1])[0])
    return (f"shortest time to {limit_words(atlas, units)}: "
            f"{units.time(float(atlas.records['when_low'][at]), SHORT)} at direction {where}{beside}")


def limit_words(atlas: Atlas, units: Units) -> str:
    """"30 deg/s", "5 J", "a tilt of 20 deg"."""
    limit = atlas.asked.stated_limit
    if limit is None:
        return "no limit"
    if limit.kind == "energy":
        return units.energy(limit.limits[0], SHORT)
    if limit.kind == "below":
        return f"|ω| < {units.rate(limit.limits[0], SHORT)}"
    if limit.kind in ("tilt", "nutation", "nutation_below"):
        return f"{limit.names[0]} by {units.angle(limit.limits[0], SHORT)}"
    return units.rate(limit.limits[0], SHORT) if limit.kind == "rate" else questions.asked(limit, units)


def _wheels(atlas: Atlas, units: Units) -> list[str]:
    """A line for each wheel momentum, where they are few."""
    if not atlas.asked.momenta:
        return []
    numbers = range(len(atlas.asked.wheels))
    shown = (numbers if len(numbers) <= ROWS
             else [int(n) for n in np.unique(np.linspace(0, len(numbers) - 1, ROWS).round())])
    lines = [
        f"  wheel {wheel_words(atlas, n)}: {answer(atlas, units, np.flatnonzero(atlas.leaves.wheel == n))}"
        for n in shown]
    return (lines + ([f"  and {len(numbers) - len(shown)} more wheel momenta between"]
                     if len(shown) < len(numbers) else []))


def _details(atlas: Atlas, units: Units) -> list[str]:
    records, full = atlas.records, atlas.share.sum()
    levels, size = np.unique(atlas.leaves.level), math.degrees(_smallest(atlas))
    lines = [f"  torque {units.torque(float(atlas.asked.torque))}; {len(records):,} cells of equal area at "
             f"each of {len(levels)} depths, the smallest some "
             f"{size:.2g} deg wide" if len(levels) > 1 else
             f"  torque {units.torque(float(atlas.asked.torque))}; {len(records):,} cells of equal area, "
             f"some {size:.2g} deg wide"]
    spun = records["fate"] == Fate.SPIN_UP
    if spun.any():
        lines.append("  spin-up about " + _listed(_shares(atlas, "spin_axis", spun),
                                                  lambda axis: _signed(atlas, axis)))
    lines.append("  the fate is known as " + _listed(_shares(atlas, "level"), lambda level: LEVELS[level]))
    if atlas.asked.stated_limit is not None:
        lines.append(_times(atlas, units, full))
    lines.append("  number of equilibria: "
                 + _listed(_shares(atlas, "equilibria"), lambda n: COUNTS.get(n) or str(n)))
    suspected = records["island"] > 0
    if suspected.any():
        lines.append("  bounded islands: " + _listed(_shares(atlas, "island", suspected),
                                                     lambda n: ("", "may exist", "one is seen")[n]))
    return lines


def _smallest(atlas: Atlas) -> float:
    """How wide the smallest cells are, rad: the root of their area."""
    return math.sqrt(float(area(int(atlas.leaves.level.max()))))


def _shares(atlas: Atlas, name: str, rows: np.ndarray | bool = True) -> dict[int, float]:
    """{value of a column: share of the sphere and of the wheels} of all values in these rows, the most first.
    """
    values, full = atlas.records[name], atlas.share.sum()
    shares = {int(value): float(atlas.share[rows & (values == value)].sum() / full)
              for value in np.unique(values[rows & (values == values)])}
    return dict(sorted(shares.items(), key=lambda item: -item[1]))


def _listed(shares: dict[int, float], phrase: Callable[[int], str]) -> str:
    return ", ".join(f"{phrase(value)} ({per_cent(fraction)})" for value, fraction in shares.items())


def _times(atlas: Atlas, units: Units, full: float) -> str:
    low, high = atlas.records["when_low"], atlas.records["when_high"]
    settled = np.isfinite(low) & np.isfinite(high)
    printed = f"  time to {limit_words(atlas, units)}: "
    if settled.any():
        smallest, largest = float(low[settled].min()), float(high[settled].max())
        levels = _listed(_shares(atlas, "when_level", settled), lambda level: LIMIT_LEVELS[level])
        printed += f"{units.time(smallest, SHORT)} to {units.time(largest, SHORT)}, {levels}"
    rest = [(phrase, float(atlas.share[rows].sum() / full)) for phrase, rows in
            (("never", np.isinf(low)), ("not known", ~settled & ~np.isinf(low))) if rows.any()]
    return (printed + ("; " if settled.any() and rest else "")
            + ", ".join(f"{phrase} ({per_cent(fraction)})" for phrase, fraction in rest))


def _named(atlas: Atlas, units: Units) -> list[str]:
    """A line for the principal axes and one for each thruster; where wheels vary, of the first of them alone.
    """
    first = [n for n, point in enumerate(atlas.named) if point.wheel == 0]
    beside = f", wheel {wheel_words(atlas, 0)}" if atlas.asked.momenta else ""
    axes = [f"{point_name(atlas, atlas.named[n])} {does(atlas, n)}" for n in first
            if atlas.named[n].level == AXES]
    lines = [f"  exactly on an axis{beside}: {', '.join(axes)}"]
    for n in first:
        point = atlas.named[n]
        if point.level != AXES:
            name = (f"thruster {printable(point_name(atlas, point))}" if point.level == THRUSTERS
                    else point_name(atlas, point))
            where = direction_words(atlas.in_file(atlas.named_directions[n:n + 1])[0])
            lines.append(f"  {name}, direction {where}{beside}: {does(atlas, n)}{in_time(atlas, n, units)}")
    return lines


def does(atlas: Atlas, n: int) -> str:
    """What the motion does under the n-th direction with a name."""
    record = atlas.named_records[n]
    fate, axis = Fate(int(record["fate"])), int(record["spin_axis"])
    about = f" about {_signed(atlas, axis)}" if fate == Fate.SPIN_UP else ""
    return DOES[fate][1] + about


def _signed(atlas: Atlas, axis: int) -> str:
    return axes_of(atlas.asked.case).signed(abs(axis), axis) or other_axis(atlas)


def in_time(atlas: Atlas, n: int, units: Units) -> str:
    """When it reaches the limit there; nothing where that is not known."""
    if atlas.asked.stated_limit is None or not math.isfinite(atlas.named_records["when_high"][n]):
        return ""
    return (f", reaches {limit_words(atlas, units)} in "
            f"{units.time(float(atlas.named_records['when_high'][n]), SHORT)}")


def undecided(atlas: Atlas) -> bool:
    """Whether a fate is."""
    return bool((atlas.records["fate"] == Fate.UNDECIDED).any()
                or (atlas.named_records["fate"] == Fate.UNDECIDED).any())


def csv(atlas: Atlas) -> str:
    """A line for each direction with a name, then one for each cell."""
    plan = atlas.asked.plan(())
    columns = columns_of(atlas.asked.answers)[1:]
    heads = ["name", "wheel", "level", "number", "share", "direction1", "direction2", "direction3",
             "file_x", "file_y", "file_z",
             *(with_unit(column.name, unit(plan, column)) for column in columns)]
    ends = atlas.leaves
    points = zip((point_name(atlas, point) for point in atlas.named), (point.wheel for point in atlas.named),
                 repeat(("", "", "")))
    cells = zip(repeat(""), ends.wheel.tolist(),
                zip(ends.level.tolist(), ends.number.tolist(), atlas.share.tolist()))
    momenta = atlas.asked.momenta
    case = atlas.asked.case
    every = limiting.cell(case, of_every_point(case, atlas.records))
    rows = [[name, momenta[wheel] if momenta else "", *about, *direction, *of_file,
             *_with(every, columns, _cells(columns, answered))]
            for first, directions, records in ((points, atlas.named_directions, atlas.named_records),
                                               (cells, atlas.directions, atlas.records))
            for (name, wheel, about), direction, of_file, answered in zip(
                first, directions.tolist(), atlas.in_file(directions).tolist(), records)]
    return csv_lines([heads, *rows])


def _with(every: str, columns: Any, values: list[Any]) -> list[Any]:
    """The cells of a line, before its own caveats those of all lines."""
    return [("; ".join(filter(None, (every, value))) if column is CAVEATS else value)
            for column, value in zip(columns, values)]


def _cells(columns: Any, record: Any) -> list[Any]:
    values = [record[column.name].item() for column in columns]
    return [column.flags[value] if column.flags else value for column, value in zip(columns, values)]


def json(atlas: Atlas, units: Units) -> str:
    """Everything: what was asked, the answer, directions with a name, each column of the cells in one list.
    """
    query, plan, columns = atlas.asked, atlas.asked.plan(()), columns_of(atlas.asked.answers)[1:]
    wheels = [{"momentum": momentum, "unit": query.unit, "vector": list(map(float, vector))}
              for momentum, vector in zip(query.momenta or (None,) * len(query.wheels), query.wheels)]
    axes = axes_of(query.case)
    shares = [{"fate": Fate(fate).word, **axes.key(abs(axis)),
               "sense": (axis > 0) - (axis < 0) or None, "island": ISLANDS[island], "share": fraction}
              for (fate, axis, island), _, fraction in kinds(atlas)]
    by_axis = [{"fate": Fate(fate).word, **axes.key(axis), "share": fraction}
               for (fate, axis), fraction in _by_axis(atlas, None)]
    counts = [{"equilibria": COUNTS.get(count) or count, "share": fraction}
              for count, fraction in _shares(atlas, "equilibria").items()]
    limit = query.stated_limit
    cells = {"wheel": atlas.leaves.wheel, "level": atlas.leaves.level, "number": atlas.leaves.number,
             "share": atlas.share,
             "direction": atlas.directions, "direction_in_file": atlas.in_file(atlas.directions)}
    named = [{"name": point_name(atlas, point),
              "kind": {AXES: "axis", THRUSTERS: "thruster"}.get(point.level, "case"), "wheel": point.wheel,
              "direction": direction, "direction_in_file": of_file}
             | dict(zip((column.name for column in columns), endless(_cells(columns, record))))
             for point, direction, of_file, record in zip(
                 atlas.named, atlas.named_directions.tolist(),
                 atlas.in_file(atlas.named_directions).tolist(), atlas.named_records)]
    frame = query.case.frame
    printed: dict[str, Any] = {
        "schema": ATLAS_SCHEMA, "case": query.case.name, "command": query.command,
        "answer": answer(atlas, units),
        "torque": float(query.torque),
        "moments": list(map(float, query.case.scene.body.exact)),  # type: ignore[union-attr]
        "axes": [[float(v) for v in row] for row in frame.axes] if frame is not None else None,
        "wheels": wheels, "smallest_cell": _smallest(atlas),
        "limit": None if limit is None else {"kind": limit.kind, "names": list(limit.names),
                                             "values": list(limit.limits)},
        "shares": shares, "shares_by_axis": by_axis, "equilibria": counts, "named": named,
        "flags": {column.name: list(column.flags) for column in columns if column.flags},
        "units": {column.name: unit(plan, column) for column in columns if column.kind == "f8"},
        "cells": cells | {column.name: endless(atlas.records[column.name].tolist()) for column in columns}}
    return as_json(printed | limiting.key(query.case, limits_of(query.case, _all(atlas))))


# --- As a data set


def atlas(case: Given, torque: Any = None, wheel: str | None = None,
          level: int = LEVEL, refine: int = REFINE,
          certify: bool = False, follow: str | None = None, out: str | os.PathLike[str] | None = None,
          workers: int | None = 1, scheduler: str | None = None,
          timed: bool = True, *, state: Start | None = None, span: Span | None = None,
          **limit: str | None) -> xarray.Dataset:
    """What becomes of a case's motion under a torque of every direction: cells of equal area on the sphere,
    smaller ones along the boundaries.

    case: in any form, or a scene with `state` and `span`. torque: its size, "1 N m"; None: that of the case.
    wheel: momenta beside each of which all directions are asked, "0:2:5" along the wheel of the case, or
    "z=0:2:5"; None: the case's own. level: 8 4^level cells at first; refine: how often those along a boundary
    are cut in four. limit: rate, component, energy, tilt, below or until, as the options of `stabilab when`;
    without any, that of [limits] of the case, if it has one; timed: whether that time is asked. certify:
    prove what can be. follow: how long motions are followed that only a run decides. out: a .nc file; workers
    and scheduler: as of `stabilab.sweep`; the numbers are the same whoever computes them. Raises InputError
    for what cannot be asked.
    """
    case = written(case, state, span)
    demand("xarray")
    plan = asked(case, torque, wheel, level, refine, certify, follow, timed, **limit)
    path = None if out is None else checked(out)
    with drawn(plan, path, workers, scheduler) as result:
        built = dataset(result)
        if path is not None:
            write(built, path)
        return built


def dataset(result: Atlas) -> xarray.Dataset:
    """The cells with directions, corners, shares and answers; directions with a name beside them."""
    def numbers(dims: str | Sequence[str], values: np.ndarray | list[str], phrase: str, **of: str) -> Any:
        return dims, values, {"long_name": phrase, **of}

    plan, columns, ends = result.asked.plan(()), columns_of(result.asked.answers)[1:], result.leaves
    cell, point = ("cell", "axis"), ("point", "axis")
    values = {
        "wheel": numbers("cell", ends.wheel.astype(np.int32), "number of the wheel momentum"),
        "number": numbers("cell", ends.number.astype(np.int32), "number of the cell at its depth"),
        "depth": numbers("cell", ends.level.astype(np.int32),
                         "depth of the cell: 8 4^depth of them make the sphere"),
        "share": numbers("cell", result.share, "share of the sphere", units="1"),
        "direction": numbers(cell, result.directions, "middle of the cell along the principal axes",
                             units="1"),
        "direction_in_file": numbers(cell, result.in_file(result.directions),
                                     "the same in the frame of the file", units="1"),
        "corners": numbers(("cell", "corner", "axis"), _corners(ends),
                           "corners of the cell along the principal axes", units="1"),
        **{column.name: column_in("cell", column, result.records, unit(plan, column)) for column in columns},
        "point_direction": numbers(point, result.named_directions,
                                   "direction with a name, along the principal axes", units="1"),
        "point_wheel": numbers("point", np.array([item.wheel for item in result.named], np.int32),
                               "number of the wheel momentum"),
        **{f"point_{column.name}": column_in("point", column, result.named_records, unit(plan, column))
           for column in columns},
        "wheel_momentum": numbers(("wheels", "axis"), np.array(result.asked.wheels, float),
                                  "momentum of the wheel along the principal axes", units="N m s")}
    coordinates = {"axis": numbers("axis", np.array([1, 2, 3], np.int8), "principal axis"),
                   "point": numbers("point", [point_name(result, item) for item in result.named],
                                    "name of the direction")}
    return finished(values, coordinates, _attributes(result))


def _corners(ends: Leaves) -> np.ndarray:
    out = np.empty((len(ends.level), 3, 3))
    for level in np.unique(ends.level):
        rows = ends.level == level
        out[rows] = directions(corners(int(level),
                                       ends.number[rows]).reshape(-1, 3) / 2.0**level).reshape(-1, 3, 3)
    return out


def _attributes(result: Atlas) -> dict[str, Any]:
    of = result.asked
    shown = {"path": os.path.basename(of.path), "options": dict(of.options), "level": of.level,
            "refine": of.refine, "certify": of.certify,
            "limit": dict(of.limit), "timed": of.timed, "computed": result.asked_points}
    return {**origin(of.case, of.command), "torque": float(of.torque), "case": of.text, "atlas": dumps(shown),
            "caveats": limiting.cell(of.case, limits_of(of.case, result.records))}


def atlas_of(data: xarray.Dataset, path: Path) -> Atlas:
    """The atlas that a data set of `dataset` holds. Raises InputError for one that was changed."""
    try:
        shown = loads(data.attrs["atlas"])
        of = asked(read_text(shown["path"], data.attrs["case"]), **shown["options"], level=shown["level"],
                   refine=shown["refine"], certify=shown["certify"],
                   timed=shown.get("timed", True), **shown["limit"])
        ends = Leaves(*(data[name].values.astype(np.int64) for name in ("wheel", "depth", "number")))
        result = Atlas(of, ends, _records(data, of, "cell"), of.named, _records(data, of, "point"),
                      shown["computed"], 0)
        complete = (len(result.named_records) == len(result.named)
                    and abs(result.share.sum() - len(of.wheels)) < 1e-9)
    except Exception:  # of any kind: what stands there is none, or of another version
        complete = False
    if not complete:
        raise InputError(
            f"{printable(str(path))}: what it says of its atlas cannot be read: was it changed, or made by "
            f"another version?")
    return result


def _records(data: xarray.Dataset, of: Asked, dimension: str) -> np.ndarray:
    out = np.zeros(data.sizes[dimension], record(of.answers))
    out["valid"] = 1
    for column in columns_of(of.answers)[1:]:
        name = f"point_{column.name}" if dimension == "point" else column.name
        out[column.name] = data[name].values
    return out
