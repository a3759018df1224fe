"""What is drawn in the space of the rates."""
from __future__ import annotations

import math
import sys
from array import array
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import accumulate, combinations, product
from typing import Any

from ...equilibrium.result import Equilibria
from ...orbit.result import Fate, Motion
from ...orbit.separatrix.saddles import PlainBranch
from .. import style
from ..assumed import Assumed
from ..turns.band import BAND, Grid, Long
from ..units import number, with_unit
from .box import LIMIT, MOTION, NEAREST, SHOWN_SIZE, SMALL, Box, Point, cube_about
from .reach import PLACES, curves_of
from .span import BEYOND, limit_time

GROWN = 3.0   # times its first size, up to which a motion that spins up is drawn
ARROWS, ARROW = (0.12, 0.45, 0.8), 0.11  # where: shares of the path; how long: of half of the box
VIEWS = tuple((up, round_) for up in (22, 33) for round_ in (-55, -35, 35, 55))  # deg: elevation, azimuth
BETTER = 1.25  # times as broad as from the first side: from there the path is seen
CROWDED = 0.12  # halves of the box: times nearer than that would lie on each other
ARC = 24  # steps of a sixth of the limit's sphere each way
HALF, BEYOND_SIZE = 4095, 8.0  # half of the box in numbers of a page; what is farther off is moved in


@dataclass(frozen=True)
class Space:
    """names: labels of the axes, in a unit of which `rate` make one of the scene's; branches: (colour,
    branch) of the separatrix; curves and marks: (words of the legend, places or place); path: of the motion;
    arrows: (place, step) along it; view: elevation and azimuth of the eye, deg; caption: what the separatrix
    parts, or why none is drawn; part: what is said where the path is a part of the motion. lines: the path,
    or of a motion of many turns those that are drawn, with their times beside them; veils: (words of the
    legend, colour, surface) of what is seen through: the band of many turns, the sphere of the limit."""

    names: tuple[str, ...]
    rate: float
    box: Box
    branches: tuple[tuple[str, PlainBranch], ...]
    curves: tuple[tuple[str, list[Point]], ...]
    marks: tuple[tuple[str, Point], ...]
    path: list[Point]
    arrows: tuple[tuple[Point, Point], ...]
    view: tuple[float, float]
    caption: str
    part: str = ""
    lines: tuple[list[Point], ...] = ()
    times: tuple[tuple[Point, str], ...] = ()
    veils: tuple[tuple[str, str, Grid], ...] = ()

    @property
    def legend(self) -> dict[str, str]:
        """Words and colour of all that is drawn, each once."""
        kinds = [MOTION] * bool(self.path) + [text for text, _ in (*self.marks, *self.curves)]
        return ({kind: str(look(kind)["color"]) for kind in kinds}
                | {text: colour for text, colour, _ in self.veils}
                | {branch.name: colour for colour, branch in self.branches})


    def shape(self, text: str) -> str:
        """How a key of the legend looks, so that it is told without its colour: "line", "dashed", "dot",
        "square" or, of a surface, "area"."""
        if text in {branch.name for _, branch in self.branches}:
            return "area"
        drawn = look(text)
        if drawn.get("linestyle") == "none":
            return "square" if drawn.get("marker") == "s" else "dot"
        return "line" if drawn.get("linestyle", "-") == "-" else "dashed"


ASSUMED = f"assumed {LIMIT}"  # of a case that states none


def look(text: str) -> dict[str, Any]:
    """How something is drawn, by its words in a legend; behind a comma stands a number."""
    return style.SPACE[BAND if text.startswith(BAND) else text.partition(",")[0]]


def space(names: Iterable[str], rate: tuple[str, float], box: Box, branches: Iterable[PlainBranch],
          path: list[Point], marks: Iterable[tuple[str, Point]], curves: Iterable[tuple[str, list[Point]]],
          text: str, more: str = "", limit: tuple[str, float] | None = None,
          long: Long | None = None) -> Space:
    """What is drawn in a box. names, rate: of the components, and their unit (name, how many make one of the
    scene's). branches: those that come into it are drawn, in the colours of their numbers; more: behind their
    names; text: of the separatrix. limit: its words, and of |omega| its size, drawn where it comes into the
    box, and fills a part of it. long: what is drawn of a motion of many turns in place of its path."""
    (unit, per), shares = rate, [box.share(at) for at in path]
    named = tuple(with_unit(name, unit) for name in names)
    called, size = limit or ("", 0.0)
    veils = [(f"{called}, {number(per * size)} {unit}".rstrip(), called, part)
             for part in (_sphere(size, box) if size > SMALL * max(box.half) else ())]
    veils += [(part.name, BAND, part) for part in (() if long is None else long.skins)]
    shown = [(style.SURFACES[n % len(style.SURFACES)],
              replace(branch, name=f"{branch.name.capitalize()} of the separatrix{more}"))
             for n, branch in enumerate(branches) if _comes_in(branch, box)]
    view = _view(shares)
    lines = ((path,) if path else ()) if long is None else tuple(line for line, _ in long.bold)
    arrows = (_arrows(path, shares) if long is None
              else tuple(arrow for line in lines for arrow in _arrow_of(line, box)))
    return Space(named, per, box, tuple(shown), tuple(curves),
                 tuple((kind, at) for kind, at in marks if box.holds(at)), path, arrows, view, text,
                 lines=lines, times=_beside(() if long is None else long.bold, box, view),
                 veils=tuple((name, str(look(kind)["color"]), part) for name, kind, part in veils))


def _comes_in(branch: PlainBranch, box: Box) -> bool:
    """Whether more of a branch is in a box than its crest, the saddles at the ends of its rows, along which
    it meets its neighbour."""
    return any(0 < n % branch.columns < branch.columns - 1 and box.holds(at)
               for n, at in enumerate(branch.points))


def _sphere(size: float, box: Box) -> Iterator[Grid]:
    """The parts of the sphere of |omega| = size that may come into a box: on each of its six sides, parted by
    the component that is the largest there, as far as the box reaches."""
    for axis, side in product(range(3), (1, -1)):
        out = sorted((side * box.low[axis], side * box.high[axis]))
        low, high = max(out[0], size / math.sqrt(3)), out[1]
        if low > high:
            continue
        spans = []
        for n in ((axis + 1) % 3, (axis + 2) % 3):
            slopes = [edge / far for edge in (box.low[n], box.high[n]) for far in (low, high)]
            spans.append((max(min(slopes), -1.0), min(max(slopes), 1.0)))
        if any(first >= last for first, last in spans):
            continue
        points: list[Point] = []
        for m, n in product(range(ARC + 1), repeat=2):
            at = [0.0] * 3
            at[axis] = float(side)
            for place, part, (first, last) in zip(((axis + 1) % 3, (axis + 2) % 3), (m, n), spans):
                at[place] = first + (last - first) * part / ARC
            points.append(tuple(size * v / math.hypot(*at) for v in at))
        if any(map(box.holds, points)):
            yield Grid(LIMIT, ARC + 1, ARC + 1, points)


def beside_limit(limit: tuple[str, float] | None, path: list[Point]) -> list[tuple[str, Point]]:
    """The place on the sphere of a limit of |omega|, (words, size), behind a motion's farthest, as a mark for
    its box; of one that is assumed, and not reached, none."""
    far = max(path, key=lambda at: math.hypot(*at), default=(0.0,) * 3)
    called, size = limit or ("", 0.0)
    if not size or not any(far) or called == ASSUMED and math.hypot(*far) < size:
        return []
    return [(called, tuple(v * size / math.hypot(*far) for v in far))]


def limit_of(case: Any, assumed: Assumed | None = None) -> tuple[str, float] | None:
    """(words, size) of the limit of |omega| that a case states; of the one assumed where it states none."""
    declared = None if case is None or case.limits is None else case.limits.rate
    if declared is not None:
        return LIMIT, float(declared)
    return None if assumed is None else (ASSUMED, assumed.rate)


def near_part(times: Sequence[float], path: list[Point], motion: Motion | None,
              reached: float | None = None) -> list[Point]:
    """A motion that spins up as long as it is near where it was in the first twentieth of its time, and past
    the limit of its case; all of it of any other, also where that goes far and comes back. reached: as of
    `seen`."""
    if motion is not None and motion.fate is not Fate.SPIN_UP or not path:
        return path
    early = abs(times[-1] - times[0]) / 20
    size = max(math.hypot(*x) for t, x in zip(times, path) if abs(t - times[0]) <= early)
    if motion is not None and motion.margin_velocity is not None and math.isfinite(motion.margin_velocity):
        size = max(size, motion.margin_velocity)
    limit = BEYOND * ((motion and limit_time(motion)) or reached or 0.0)
    late = (next((n for n, (t, x) in enumerate(zip(times, path)) if math.hypot(*x) > GROWN * size
                  and t > limit), len(path)) if size else len(path))
    return path[:late + 1] if late > 20 else path


def marks_of(start: Point | None, motion: Motion | None,
             result: Equilibria | None) -> list[tuple[str, Point]]:
    """Start, nearest point of the separatrix, isolated equilibria."""
    marks: list[tuple[str, Point]] = [] if start is None else [("start", tuple(start[:3]))]
    if motion is not None and motion.velocity_witness is not None:
        marks.append((NEAREST, motion.velocity_witness))
    return marks + [(style.EQUILIBRIA[style.kind_of(point)], point.at[:3])
                    for point in (result.points if result is not None else ())]


def nearest(result: Equilibria | None, path: list[Point]) -> list[tuple[str, Point]]:
    """Of each curve of equilibria that comes near a motion the nearest place, as a mark for its box."""
    own = cube_about(path)
    wide = Box(own.middle, tuple(SHOWN_SIZE * h for h in own.half))
    return [(text, min(places, key=lambda at: math.dist(at, own.middle)))
            for text, places in curves_of(result, wide, PLACES[0], PLACES[0])]


def _arrows(path: list[Point], shares: list[list[float]]) -> tuple[tuple[Point, Point], ...]:
    """(place, step) at shares of the length of a path, steps as long as arrows are drawn; none on a path that
    they would hide."""
    if not path or max(max(v) - min(v) for v in zip(*shares)) < 3 * ARROW:
        return ()
    steps = [math.dist(a, b) for a, b in zip(shares, shares[1:])]
    length = [0.0, *accumulate(steps)]
    rows = []
    for arrow in ARROWS if math.isfinite(length[-1]) else ():
        n = next(n for n, far in enumerate(length[1:]) if far >= arrow * length[-1])
        if all(abs(v) <= 1 for v in shares[n]):
            ends = list(zip(path[n], path[n + 1]))
            rows.append((tuple((a + b) / 2 for a, b in ends), tuple(ARROW * (b - a) / steps[n]
                                                                     for a, b in ends)))
    return tuple(rows)


def _arrow_of(line: list[Point], box: Box) -> Iterator[tuple[Point, Point]]:
    """(place, step) in the middle of a turn; nothing where that is too small for an arrow."""
    shares = [box.share(at) for at in line]
    if len(line) < 2 or max(max(v) - min(v) for v in zip(*shares)) < 1.5 * ARROW:
        return
    n = len(line) // 2 - 1
    step = math.dist(shares[n], shares[n + 1])
    if step and all(abs(v) <= 1 for v in shares[n]):
        ends = list(zip(line[n], line[n + 1]))
        yield (tuple((a + b) / 2 for a, b in ends), tuple(ARROW * (b - a) / step for a, b in ends))


def _beside(bold: Iterable[tuple[list[Point], str]], box: Box,
            view: tuple[float, float]) -> tuple[tuple[Point, str], ...]:
    """(place, words) beside each of the turns that are drawn: at the start, or at the end of the turn, seen
    from a side, that is farthest from what is written already, the smallest turns first; at one place, words
    are joined."""
    seen_from = lambda at: across(box.share(at), view)
    bold = [(line, text) for line, text in bold if text]
    ends = [(line[:1] if not n else
             [choose(line, key=lambda at: seen_from(at)[n]) for n in (0, 1) for choose in (max, min)], text)
            for n, (line, text) in enumerate(bold)]
    ends.sort(key=lambda row: sum(math.dist(seen_from(a), seen_from(b)) for a, b in combinations(row[0], 2)))
    out: list[tuple[Point, list[str]]] = []
    for places, text in ends:
        free = lambda at: min((math.dist(seen_from(at), seen_from(other)) for other, _ in out), default=1.0)
        best = max(places, key=free)
        if free(best) > CROWDED:
            out.append((best, [text]))
        else:
            min(out, key=lambda row: math.dist(seen_from(best), seen_from(row[0])))[1].append(text)
    return tuple((at, "; ".join(text for _, text in bold if text in texts)) for at, texts in out)


def _view(shares: list[list[float]]) -> tuple[float, float]:
    """From where a path is seen at its broadest; the first of VIEWS where others are hardly better."""
    points = shares[::max(1, len(shares) // 200)]
    if len(points) < 3:
        return VIEWS[0]
    breadth = {view: _breadth([across(at, view) for at in points]) for view in VIEWS}
    best = max(VIEWS, key=lambda view: breadth[view])
    return best if breadth[best] > BETTER * breadth[VIEWS[0]] else VIEWS[0]


def across(at: Point, view: tuple[float, float]) -> tuple[float, float]:
    """How far a place is to the right and up, seen from a side."""
    up, turn = map(math.radians, view)
    nearby = at[0] * math.cos(turn) + at[1] * math.sin(turn)
    return at[1] * math.cos(turn) - at[0] * math.sin(turn), at[2] * math.cos(up) - nearby * math.sin(up)


def _breadth(flat: list[tuple[float, float]]) -> float:
    """The lesser of the two mean squares about the middle of points in a plane."""
    number = len(flat)
    x, y = (sum(v) / number for v in zip(*flat))
    xx, yy, xy = (sum(v) / number for v in zip(*(((a - x) ** 2, (b - y) ** 2, (a - x) * (b - y))
                                                 for a, b in flat)))
    return (xx + yy) / 2 - math.hypot((xx - yy) / 2, xy)


# --- For the script of a page
def data(drawn: Space, row: Callable[[bytes], Any]) -> dict[str, Any]:
    """What `space.js` takes: places as whole numbers of 16 bits (the low byte first), HALF for half of the
    box, each list of them as `row` packs it."""
    box, packed = drawn.box, lambda places: row(_packed(places, drawn.box))
    curves = [*drawn.curves, *((MOTION, line) for line in drawn.lines)]
    return {"names": drawn.names, "middle": box.scaled(drawn.rate).middle,
            "half": box.scaled(drawn.rate).half, "view": drawn.view,
            "branches": [{"name": item.name, "colour": colour, "rows": item.rows, "columns": item.columns,
                          "at": packed(item.points)} for colour, item in drawn.branches],
            "veils": [{"name": name, "colour": colour, "rows": item.rows, "columns": item.columns,
                       "at": packed(item.points)} for name, colour, item in drawn.veils],
            "times": [[_round(box.share(at)), text] for at, text in drawn.times],
            "curves": [{"kind": text, "colour": look(text)["color"], "at": packed(places)}
                       for text, places in curves],
            "points": [{"kind": text, "colour": look(text)["color"], "at": _round(box.share(at))}
                       for text, at in drawn.marks],
            "arrows": [[_round(box.share(at)), _round([v / h for v, h in zip(step, box.half)])]
                       for at, step in drawn.arrows],
            "legend": list(drawn.legend.items())}


def _packed(points: Iterable[Point], box: Box) -> bytes:
    far = int(BEYOND_SIZE * HALF)
    (a, b, c), (p, q, r) = box.middle, (HALF / h for h in box.half)
    return packed("h", (min(max(round(v), -far), far) for x, y, z in points
                        for v in ((x - a) * p, (y - b) * q, (z - c) * r)))


def packed(kind: str, values: Iterable[float]) -> bytes:
    """Numbers of a kind of `array`, the low byte first."""
    built = array(kind, values)
    if sys.byteorder == "big":
        built.byteswap()
    return built.tobytes()


def _round(values: Iterable[float]) -> list[float]:
    return [round(v, 5) for v in values]
