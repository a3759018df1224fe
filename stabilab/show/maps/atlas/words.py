"""What an atlas says in words, the answer first, and as CSV and JSON of every cell."""
from __future__ import annotations

import math
from typing import Any

import numpy as np

from ....errors import printable
from ....maps.atlas.cells import area
from ....maps.atlas.pointed import AXES, THRUSTERS
from ....maps.atlas.run import Atlas
from ....maps.columns import ISLANDS, LEVELS, LIMIT_LEVELS, columns_of
from ....orbit.result import Fate
from ... import limiting
from ...axes import axes_of
from ...files import comma
from ...text.answers import Endless, as_json
from ...units import SHORT, Units
from ..labels import limiting as caveats_of
from ..labels import unit
from ..words import COUNTS
from .labels import DOES, direction_words, kinds, other_axis, point_name, wheel_words

SCHEMA = "stabilab.atlas/1"
ROWS = 12  # wheel momenta that are told one by one


def text(atlas: Atlas, units: Units) -> str:
    """The answer in the first line; then what is behind it."""
    told = limiting.lines(caveats_of(atlas.asked.case, _all(atlas)), units)
    return "\n".join([f"{atlas.asked.case.name}: {answer(atlas, units)}", *told, *_wheels(atlas, units), *_details(atlas, units), *_named(atlas, units)])


def _all(atlas: Atlas) -> np.ndarray:
    """The answers of cells and of directions with a name."""
    return np.concatenate([atlas.records, atlas.named_records])


def answer(atlas: Atlas, units: Units, rows: np.ndarray | None = None) -> str:
    """"78 % of directions spin up about z (minor axis), 22 % about x (major axis); shortest time to 30 deg/s: 2.1 min at direction (...)"."""
    shares = _by_axis(atlas, rows)
    what = "directions" if len(atlas.asked.wheels) == 1 or rows is not None else "directions and wheel momenta"
    parts = []
    for n, ((fate, axis), share) in enumerate(shares):
        about = axes_of(atlas.asked.case).whole(axis) if axis else other_axis(atlas)
        verb = f"about {about}" if n and shares[n - 1][0][0] == fate == Fate.SPIN_UP else f"spin up about {about}" if fate == Fate.SPIN_UP else DOES[Fate(fate)]
        parts.append(f"{_per_cent(share)} of {what} {verb}" if not n else f"{_per_cent(share)} {verb}")
    if len(shares) == 1:
        parts = [parts[0].replace("100 % of", "all", 1)]
    return ", ".join(parts) + _shortest(atlas, units, rows)


def _by_axis(atlas: Atlas, rows: np.ndarray | None) -> list[tuple[tuple[int, int], float]]:
    """((fate, axis), share), both senses of an axis together; spin-ups beside each other, in order of what most do."""
    found: dict[tuple[int, int], float] = {}
    for (fate, axis, _), _, share in kinds(atlas, rows):
        found[fate, abs(axis)] = found.get((fate, abs(axis)), 0.0) + share
    total = {fate: sum(share for (other, _), share in found.items() if other == fate) for fate, _ in found}
    return sorted(found.items(), key=lambda one: (-total[one[0][0]], one[0][0], -one[1]))


def _per_cent(share: float) -> str:
    percent = 100 * share
    if percent > 99 and share < 1 - 1e-12:
        return f"{min(percent, 99.99):.2f} %"
    return f"{percent:.0f} %" if percent >= 1 else f"{percent:.2g} %"


def _shortest(atlas: Atlas, units: Units, rows: np.ndarray | None = None) -> str:
    if atlas.asked.stated_limit is None:
        return ""
    low = atlas.records["when_low"] if rows is None else atlas.records["when_low"][rows]
    known = np.isfinite(low) & np.isfinite(atlas.records["when_high"] if rows is None else atlas.records["when_high"][rows])
    if not known.any():
        return f"; {limit_words(atlas, units)} is not known to be reached"
    at = int(np.flatnonzero(known)[np.argmin(low[known])]) if rows is None else int(rows[np.flatnonzero(known)[np.argmin(low[known])]])
    beside = f", wheel {wheel_words(atlas, int(atlas.leaves.wheel[at]))}" if atlas.asked.momenta and rows is None else ""
    where = direction_words(atlas.in_file(atlas.directions[at:at + 1])[0])
    return f"; shortest time to {limit_words(atlas, units)}: {units.time(float(atlas.records['when_low'][at]), SHORT)} at direction {where}{beside}"


def limit_words(atlas: Atlas, units: Units) -> str:
    """"30 deg/s", "5 J", "a tilt of 20 deg"."""
    limit = atlas.asked.stated_limit
    if limit is None:
        return "no limit"
    if limit.kind == "energy":
        return units.energy(limit.limits[0], SHORT)
    if limit.kind == "tilt":
        return f"{limit.names[0]} by {units.angle(limit.limits[0], SHORT)}"
    told = " or ".join(dict.fromkeys(units.rate(one, SHORT) for one in limit.limits))
    return told if limit.kind == "rate" else f"{' or '.join(limit.names)} = {told}"


def _wheels(atlas: Atlas, units: Units) -> list[str]:
    """A line for each wheel momentum, where they are few."""
    if not atlas.asked.momenta:
        return []
    numbers = range(len(atlas.asked.wheels))
    shown = numbers if len(numbers) <= ROWS else [int(n) for n in np.unique(np.linspace(0, len(numbers) - 1, ROWS).round())]
    lines = [f"  wheel {wheel_words(atlas, n)}: {answer(atlas, units, np.flatnonzero(atlas.leaves.wheel == n))}" for n in shown]
    return lines + ([f"  and {len(numbers) - len(shown)} more wheel momenta between"] if len(shown) < len(numbers) else [])


def _details(atlas: Atlas, units: Units) -> list[str]:
    records, whole = atlas.records, atlas.share.sum()
    levels = np.unique(atlas.leaves.level)
    size = math.degrees(math.sqrt(float(area(int(levels[-1])))))
    lines = [f"  torque {units.torque(float(atlas.asked.torque))}; {len(records):,} cells of equal area at each of {len(levels)} depths, the smallest some "
             f"{size:.2g} deg wide" if len(levels) > 1 else
             f"  torque {units.torque(float(atlas.asked.torque))}; {len(records):,} cells of equal area, some {size:.2g} deg wide"]
    spun = records["fate"] == Fate.SPIN_UP
    if spun.any():
        lines.append("  spin-up about " + _listed(atlas, records["spin_axis"], spun, whole, lambda axis: _signed(atlas, axis)))
    lines.append("  the fate is known as " + _listed(atlas, records["level"], records["level"] >= 0, whole, lambda level: LEVELS[level]))
    if atlas.asked.stated_limit is not None:
        lines.append(_times(atlas, units, whole))
    lines.append("  number of equilibria: " + _listed(atlas, records["equilibria"], records["equilibria"] > -9, whole,
                                                      lambda n: COUNTS.get(n) or str(n)))
    suspected = records["island"] > 0
    if suspected.any():
        lines.append("  bounded islands: " + _listed(atlas, records["island"], suspected, whole, lambda n: ("", "may exist", "one is seen")[n]))
    return lines


def _listed(atlas: Atlas, values: np.ndarray, rows: np.ndarray, whole: float, words: Any) -> str:
    shares = {int(value): float(atlas.share[rows & (values == value)].sum() / whole) for value in np.unique(values[rows])}
    return ", ".join(f"{words(value)} ({_per_cent(share)})" for value, share in sorted(shares.items(), key=lambda one: -one[1]))


def _times(atlas: Atlas, units: Units, whole: float) -> str:
    low, high = atlas.records["when_low"], atlas.records["when_high"]
    known = np.isfinite(low) & np.isfinite(high)
    told = f"  time to {limit_words(atlas, units)}: "
    if known.any():
        least, most = float(low[known].min()), float(high[known].max())
        levels = _listed(atlas, atlas.records["when_level"], known, whole, lambda level: LIMIT_LEVELS[level])
        told += f"{units.time(least, SHORT)} to {units.time(most, SHORT)}, {levels}"
    rest = [(words, float(atlas.share[rows].sum() / whole)) for words, rows in
            (("never", np.isinf(low)), ("not known", ~known & ~np.isinf(low))) if rows.any()]
    return told + ("; " if known.any() and rest else "") + ", ".join(f"{words} ({_per_cent(share)})" for words, share in rest)


def _named(atlas: Atlas, units: Units) -> list[str]:
    """A line for the principal axes and one for each thruster; where wheels vary, of the first of them alone."""
    first = [n for n, point in enumerate(atlas.named) if point.wheel == 0]
    beside = f", wheel {wheel_words(atlas, 0)}" if atlas.asked.momenta else ""
    axes = [f"{point_name(atlas, atlas.named[n])} {does(atlas, n)}" for n in first if atlas.named[n].level == AXES]
    lines = [f"  exactly on an axis{beside}: {', '.join(axes)}"]
    for n in first:
        point = atlas.named[n]
        if point.level != AXES:
            name = f"thruster {printable(point_name(atlas, point))}" if point.level == THRUSTERS else point_name(atlas, point)
            where = direction_words(atlas.in_file(atlas.named_directions[n:n + 1])[0])
            lines.append(f"  {name}, direction {where}{beside}: {does(atlas, n)}{in_time(atlas, n, units)}")
    return lines


def does(atlas: Atlas, n: int) -> str:
    """What the motion does under the n-th direction with a name."""
    record = atlas.named_records[n]
    fate, axis = Fate(int(record["fate"])), int(record["spin_axis"])
    if fate != Fate.SPIN_UP:
        return {Fate.BOUNDED: "stays bounded", Fate.SEPARATRIX: "lies on the separatrix", Fate.EQUILIBRIUM: "keeps a steady rotation",
                Fate.UNDECIDED: "is undecided"}[fate]
    return f"spins up about {_signed(atlas, axis)}"


def _signed(atlas: Atlas, axis: int) -> str:
    return axes_of(atlas.asked.case).signed(abs(axis), axis) or other_axis(atlas)


def in_time(atlas: Atlas, n: int, units: Units) -> str:
    """When it reaches the limit there; nothing where that is not known."""
    if atlas.asked.stated_limit is None or not math.isfinite(atlas.named_records["when_high"][n]):
        return ""
    return f", reaches {limit_words(atlas, units)} in {units.time(float(atlas.named_records['when_high'][n]), SHORT)}"


def undecided(atlas: Atlas) -> bool:
    """Whether a fate is."""
    return bool((atlas.records["fate"] == Fate.UNDECIDED).any() or (atlas.named_records["fate"] == Fate.UNDECIDED).any())


def csv(atlas: Atlas) -> str:
    """A line for each direction with a name, then one for each cell."""
    plan = atlas.asked.plan(())
    columns = columns_of(atlas.asked.answers)[1:]
    told = lambda column: column.name if unit(plan, column) == "1" else f"{column.name} ({unit(plan, column)})"
    heads = ["name", "wheel", "level", "number", "share", *(f"direction{n}" for n in (1, 2, 3)), *(f"file_{n}" for n in "xyz"), *map(told, columns)]
    rows = [[point_name(atlas, point), _momentum(atlas, point.wheel), "", "", "", *direction, *of_file, *_cells(columns, record)]
            for point, direction, of_file, record in zip(atlas.named, atlas.named_directions.tolist(), atlas.in_file(atlas.named_directions).tolist(),
                                                         atlas.named_records)]
    leaves = atlas.leaves
    for wheel, level, number, share, direction, of_file, record in zip(
            leaves.wheel.tolist(), leaves.level.tolist(), leaves.number.tolist(), atlas.share.tolist(), atlas.directions.tolist(),
            atlas.in_file(atlas.directions).tolist(), atlas.records):
        rows.append(["", _momentum(atlas, wheel), level, number, share, *direction, *of_file, *_cells(columns, record)])
    return comma.lines([heads, *rows])


def _momentum(atlas: Atlas, wheel: int) -> Any:
    return atlas.asked.momenta[wheel] if atlas.asked.momenta else ""


def _cells(columns: Any, record: Any) -> list[Any]:
    values = [record[column.name].item() for column in columns]
    return [column.flags[value] if column.flags else value for column, value in zip(columns, values)]


def json(atlas: Atlas, units: Units) -> str:
    """Everything: what was asked, the answer, directions with a name, each column of the cells in one list."""
    asked, plan = atlas.asked, atlas.asked.plan(())
    wheels = [{"momentum": momentum, "unit": asked.unit, "vector": list(map(float, vector))}
              for momentum, vector in zip(asked.momenta or (None,) * len(asked.wheels), asked.wheels)]
    axes = axes_of(asked.case)
    shares = [{"fate": Fate(fate).word, **axes.key(abs(axis)), "sense": (axis > 0) - (axis < 0) or None, "island": ISLANDS[island], "share": share}
              for (fate, axis, island), _, share in kinds(atlas)]
    limit = asked.stated_limit
    cells = {"wheel": atlas.leaves.wheel, "level": atlas.leaves.level, "number": atlas.leaves.number, "share": atlas.share,
             "direction": atlas.directions, "direction_in_file": atlas.in_file(atlas.directions)}
    named = [{"name": point_name(atlas, point), "kind": {AXES: "axis", THRUSTERS: "thruster"}.get(point.level, "case"), "wheel": point.wheel,
              "direction": direction, "direction_in_file": of_file} | _as_dict(asked, record)
             for point, direction, of_file, record in zip(atlas.named, atlas.named_directions.tolist(), atlas.in_file(atlas.named_directions).tolist(),
                                                          atlas.named_records)]
    frame = asked.case.frame
    told: dict[str, Any] = {
        "schema": SCHEMA, "case": asked.case.name, "command": asked.command, "answer": answer(atlas, units), "torque": float(asked.torque),
        "moments": list(map(float, asked.case.scene.body.exact)),  # type: ignore[union-attr]
        "axes": [[float(v) for v in row] for row in frame.axes] if frame is not None else None, "wheels": wheels,
        "limit": None if limit is None else {"kind": limit.kind, "names": list(limit.names), "values": list(limit.limits)}, "shares": shares, "named": named,
        "flags": {column.name: list(column.flags) for column in columns_of(asked.answers)[1:] if column.flags},
        "units": {column.name: unit(plan, column) for column in columns_of(asked.answers)[1:] if column.kind == "f8"},
        "cells": cells | {column.name: _plain(atlas.records[column.name]) for column in columns_of(asked.answers)[1:]}}
    return as_json(told | limiting.key(asked.case, caveats_of(asked.case, _all(atlas))))


def _as_dict(asked: Any, record: Any) -> dict[str, Any]:
    return {column.name: value for column, value in zip(columns_of(asked.answers)[1:], _words(_cells(columns_of(asked.answers)[1:], record)))}


def _words(values: list[Any]) -> list[Any]:
    return [Endless(value) if isinstance(value, float) and math.isinf(value) else value for value in values]


def _plain(values: np.ndarray) -> list[Any]:
    return _words(values.tolist())
