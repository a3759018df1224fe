"""The angles of body axes to the angular momentum and to their directions at the start, in words, JSON and
CSV."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ..limiting import Line
from ..units import DIGITS, Units, number

if TYPE_CHECKING:
    from ...answers.motions.angles import Angles
    from ...case.read import Case

WIDE = 14


def angle_lines(result: Angles, units: Units) -> list[str]:
    """A line an axis under a head."""
    unit, item = units.angles
    most = "at most" if result.for_all_time else "greatest"
    cells = [[f"{number(value * item, DIGITS):>{WIDE}}" for value in row] for row in _values(result)]
    rows = [f"  {axis:<8}{''.join(row)}  {unit}" for axis, row in zip(result.axes, cells)]
    return [f"  angles over {units.said(result.over)}: to the angular momentum, least and greatest; to the "
            f"direction at the start, {most}", *rows, f"  {units.said(result.reason)}"]


def _values(result: Angles) -> list[tuple[float, float, float]]:
    return [(float(low), float(high), float(apart))
            for (low, high), apart in zip(result.momentum, result.start)]


def angles_dict(result: Angles) -> dict[str, Any]:
    """The key "angles" of a JSON object, rad."""
    return {"axes": list(result.axes), "momentum": [row[:2] for row in _values(result)],
            "start": [row[2] for row in _values(result)], "over": str(result.over), "level": result.level,
            "reason": result.reason.as_dict()}


def angle_rows(case: Case, result: Angles) -> list[Line]:
    """Two lines of CSV an axis, rad."""
    over = str(result.over)
    return [Line((case.name, f"{axis} to {what}", low, high, over))
            for axis, (low, high, apart) in zip(result.axes, _values(result))
            for what, low, high in (("angular momentum", low, high), ("its start", 0.0, apart))]
