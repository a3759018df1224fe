"""The space of the rates as a page draws it: separatrix, equilibria, motion and marks in a box that stays while a hand moves.

Places are whole numbers of 16 bits along each axis, 4095 for half of the box, as on a page of the report. All of it does without NumPy.
"""
from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from ...equilibrium.result import Equilibria
from ...errors import InputError
from ...orbit.result import Fate, Motion
from ...orbit.separatrix.plain_sheets import PlainSheet
from ...verify.numbers import shown
from .. import style
from .bag import Bag

HALF = 4095      # of the box in a packed place
BEYOND = 8.0     # boxes: what is farther off is moved in, outside what is drawn
ROOM = 1.9       # half of the box, of the farthest point of the motion from its middle
SMALL = 0.22     # of the box: a motion that fills less gets a box of its own
LATEST = 3.0     # times its first size, up to which a motion that spins up is drawn

Point = Sequence[float]


@dataclass(frozen=True)
class Box:
    """A cube of rates: its middle and half of its edge."""

    middle: tuple[float, ...]
    half: float

    def share(self, at: Point) -> list[float]:
        """A place in halves of the edge from the middle."""
        return [(float(v) - m) / self.half for v, m in zip(at, self.middle)]

    def holds(self, at: Point, room: float = 1.0) -> bool:
        """Whether a place is inside a box so many times as large."""
        return all(abs(v) <= room for v in self.share(at))

    @property
    def farthest(self) -> float:
        """Of all its places, the largest component."""
        return max(map(abs, self.middle)) + self.half


def near_part(path: list[tuple[float, ...]], motion: Motion | None) -> list[tuple[float, ...]]:
    """A motion that spins up as long as it is near where it began; all of it of any other, also where that goes far and comes back."""
    if motion is not None and motion.fate is not Fate.SPIN_UP:
        return path
    size = max(math.hypot(*x) for x in path[:max(2, len(path) // 20)])
    if motion is not None and motion.margin_velocity is not None and math.isfinite(motion.margin_velocity):
        size = max(size, motion.margin_velocity)
    late = next((n for n, x in enumerate(path) if math.hypot(*x) > LATEST * size), len(path)) if size else len(path)
    return path[:late + 1] if late > 20 else path


def box_of(asked: Any, points: list[Point], kept: bool) -> Box:
    """The box that was asked for (middle and half), as long as the points are inside and, unless it is kept, fill a part of it; else a new one about
    them."""
    low, high = ([pick(p[n] for p in points) for n in range(3)] for pick in (min, max))
    extent = max(b - a for a, b in zip(low, high)) / 2
    if asked is not None:
        box = _given(asked)
        if all(box.holds(p) for p in points) and (kept or extent > SMALL * box.half):
            return box
    return Box(tuple((a + b) / 2 for a, b in zip(low, high)), ROOM * extent or max(map(abs, high)) or 1.0)


def _given(asked: Any) -> Box:
    """The box of a request."""
    try:
        numbers = [float(v) for v in (*asked["middle"], asked["half"])]
    except (KeyError, OverflowError, TypeError, ValueError):
        numbers = []
    if len(numbers) != 4 or not all(map(math.isfinite, numbers)) or not numbers[3] > 0:
        raise InputError(f"box: expected a middle of three numbers and half an edge, got {shown(asked)}")
    return Box(tuple(numbers[:3]), numbers[3])


def packed(points: Iterable[Point], box: Box) -> list[int]:
    """The places as whole numbers."""
    (a, b, c), per = box.middle, HALF / box.half
    far = int(BEYOND * HALF)
    return [min(max(round(v), -far), far) for x, y, z in points for v in ((x - a) * per, (y - b) * per, (z - c) * per)]


def seen(sheet: PlainSheet, box: Box) -> bool:
    """Whether any place of a sheet is in the box."""
    return any(box.holds(p) for p in sheet.points)


def drawn(bag: Bag, box: Box, names: list[str], one: float, sheets: Sequence[tuple[int, PlainSheet]], rests: list[tuple[str, list[Point]]],
          path: list[tuple[float, ...]], marks: list[dict[str, Any]], ghost: bool) -> dict[str, Any]:
    """What the view takes. one: how many of the unit of the labels make one of the scene's; sheets: each with its number among all that there are, which
    tells its colour; ghost: they are those of the torque without its tilt; rests: of `lines`."""
    curves: list[dict[str, Any]] = [{"kind": style.EQUILIBRIA[kind], "colour": style.colour_of(kind), "at": bag.add("int16", packed(places, box))}
                                    for kind, places in rests]
    if path:
        curves.append({"kind": "this motion", "colour": style.MEANING["this motion"]["color"], "at": bag.add("int16", packed(path, box))})
    surfaces = [{"name": _sheet_name(sheet, ghost), "colour": style.BESIDE[n % len(style.BESIDE)], "rows": sheet.rows, "columns": sheet.columns,
                 "at": bag.add("int16", packed(sheet.points, box))} for n, sheet in sheets]
    points = [mark | {"at": [round(v, 5) for v in box.share(mark["at"])]} for mark in marks if box.holds(mark["at"])]
    legend: dict[str, str] = {row.get("name") or row["kind"]: row["colour"] for row in (*surfaces, *curves, *points)}
    return {"names": names, "middle": [v * one for v in box.middle], "half": box.half * one, "sheets": surfaces, "curves": curves, "points": points,
            "legend": list(legend.items())}


def _sheet_name(sheet: PlainSheet, ghost: bool) -> str:
    return f"{sheet.name.capitalize()} of the separatrix{' without the tilt' if ghost else ''}"


def marks_of(start: Point, motion: Motion | None, found: Equilibria | None) -> list[dict[str, Any]]:
    """Start, nearest point of the separatrix, isolated equilibria."""
    marks = [{"kind": "start", "colour": style.BLACK, "at": list(start)}]
    if motion is not None and motion.velocity_witness is not None:
        marks.append({"kind": "nearest point of the separatrix", "colour": style.YELLOW, "at": list(motion.velocity_witness)})
    for point in found.points if found is not None else ():
        kind = style.kind_of(point)
        marks.append({"kind": style.EQUILIBRIA[kind], "colour": style.colour_of(kind), "at": list(point.at[:3])})
    return marks


def lines(found: Equilibria | None, box: Box, coarse: int, fine: int) -> list[tuple[str, list[Point]]]:
    """[(kind, places)] of the pieces of the curves of equilibria that come into the box, looked for at `coarse` places of each piece and drawn through
    `fine`."""
    out: list[tuple[str, list[Point]]] = []
    for curve in found.curves if found is not None else ():
        for segment in curve.segments:
            kind = style.kind_of(segment)
            for low, high in _inside(curve, _spread(*segment.t, coarse), box):
                places = [_place(curve, low + (high - low) * n / fine) for n in range(fine + 1)]
                out.append((kind, [at for at in places if at is not None]))
    return out


def _place(curve: Any, t: float) -> Point | None:
    """The rates at a place of a curve (a field adds the vertical behind them); None at an end that belongs to it no more."""
    try:
        return curve.point(t)[:3]
    except InputError:
        return None


def _inside(curve: Any, ts: list[float], box: Box) -> list[tuple[float, float]]:
    """The runs of parameters whose places are in or near the box, each one step longer."""
    near = [at is not None and box.holds(at, 1.05) for at in (_place(curve, t) for t in ts)]
    near = [near[n] or any(near[max(0, n - 1):n + 2]) for n in range(len(ts))]
    runs, first = [], None
    for n, inside in enumerate([*near, False]):
        if inside and first is None:
            first = n
        if not inside and first is not None:
            if n - 1 > first:
                runs.append((ts[first], ts[n - 1]))
            first = None
    return runs


def _spread(low: float, high: float, number: int) -> list[float]:
    """Parameters inside (low, high), dense at both ends, geometric towards infinite ones; `show.sampling` does so in arrays."""
    if math.isfinite(low) and math.isfinite(high):
        return [low + (high - low) * (1 - math.cos(1e-3 + (math.pi - 2e-3) * n / (number - 1))) / 2 for n in range(number)]
    away = [10 ** (-4 + 8 * n / (number - 1)) for n in range(number)]
    if math.isfinite(low):
        return [low + v * max(1.0, abs(low)) for v in away]
    if math.isfinite(high):
        return [high - v * max(1.0, abs(high)) for v in reversed(away)]
    return [*(-v for v in reversed(away)), *away]
