"""What all views of a motion share: the span of time, and what is drawn in the space of the rates.

The span is long enough to see what the headline says. In the space of the rates every view draws a box, the
separatrix, equilibria (on a curve of these, at places to look at), a motion with its start and its
direction, seen from one place; Matplotlib, VTK and a page only draw it.

Places are rates in the scene's variables. All of it does without NumPy, as a browser does."""
from __future__ import annotations

import math
import sys
from array import array
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import accumulate, combinations, product
from typing import Any

from ..equilibrium.result import Equilibria, EquilibriumCurve
from ..errors import InputError, StabilabError
from ..orbit.result import Fate, Motion
from ..orbit.separatrix.saddles import REACH, PlainBranch, plain_separatrix
from ..packages import present
from ..physics.scene import AnyScene
from . import style
from .assumed import Assumed
from .turns.band import BAND, Grid, Long
from .units import number, with_unit

# --- The span of time
NATURAL = 15.0  # units of the motion's own time, where the case gives no span
PERIODS = 10  # of a motion that repeats, at most
FEWEST = 2  # periods, at least
ALONE = 3  # periods where the case gives no span
BEYOND = 1.25  # of the time to the limit, at least
LATEST = 4.0  # of the time to the limit, at most
GROWTH = 1.5  # of the time from which a spin-up is certain, at least
STRETCHED = 50.0  # times its span: a motion that spins up later than that is not followed so far


def natural(scene: AnyScene, state: Sequence[float]) -> float:
    """Some units of the time in which a torque or the rotation itself moves the body."""
    if scene.variables == "scaled":
        return NATURAL
    torque = math.hypot(*(float(v) for v in scene.vector("constant_torque"))) if scene.plain else 0.0
    rate = math.hypot(*state[:3])
    return NATURAL * (math.sqrt(sum(scene.body.inertia) / 3 / torque) if torque else 1.0 / (rate or 1.0))


def seen(span: tuple[float, ...] | None, motion: Motion, alone: float,
         reached: float | None = None) -> tuple[float, float]:
    """(from, to) in the scene's time: past the limit of the case, past the beginning of a spin-up, past the
    end of a motion that loses energy, some periods of one that repeats; otherwise the span of the case, and
    where it gives none, `alone`. reached: the time to the limit that is assumed where the case states none.
    """
    low, high = span or (0.0, alone)
    if high < low:  # followed backwards, where nothing of the headline lies
        return low, high
    if (limit := limit_time(motion)) is not None:
        return min(low, 0.0), max(BEYOND * limit, min(high, LATEST * limit))
    if motion.ending is not None and motion.ending.until is not None:
        return low, max(high if span else low, BEYOND * motion.ending.until)
    if motion.period:
        wanted = min(high, low + PERIODS * motion.period) if span else low + ALONE * motion.period
        return low, max(wanted, low + FEWEST * motion.period)
    late = max(GROWTH * spin_up_time(motion), BEYOND * (reached or 0.0))
    return low, late if high < late <= low + STRETCHED * (high - low) else high


def limit_time(motion: Motion) -> float | None:
    """When the limit of the case is reached after the start; None where it is not known to be."""
    result = None if motion.first is None else motion.first[1]
    if result is None or not math.isfinite(result.high) or not result.high > 0:
        return None
    return float(result.high)


def spin_up_time(motion: Motion) -> float:
    """From when on a spin-up is certain, or its turn never reverses again; 0 of other motions."""
    if motion.fate is not Fate.SPIN_UP:
        return 0.0
    return max(float(motion.evidence.get(name) or 0.0) for name in ("release_time", "t_certificate"))


def spread(low: float, high: float, number: int, unit: float = 1.0) -> list[float]:
    """Parameters inside (low, high), dense at both ends, geometric towards an infinite end, over four powers
    of ten below and above `unit` or, where that is larger, the other end; towards two infinite ends so many
    on each side of zero."""
    if math.isfinite(low) and math.isfinite(high):
        return [low + (high - low) * (1 - math.cos(1e-3 + (math.pi - 2e-3) * n / (number - 1))) / 2
                for n in range(number)]
    away = [10 ** (-4 + 8 * n / (number - 1)) for n in range(number)]
    if math.isfinite(low):
        return [low + v * max(unit, abs(low)) for v in away]
    if math.isfinite(high):
        return [high - v * max(unit, abs(high)) for v in reversed(away)]
    return [*(-v * unit for v in reversed(away)), *(v * unit for v in away)]


# --- The box, and what is drawn in it
SHOWN_SIZE = 2.0     # times the motion's own size: a separatrix or an equilibrium so near is in the picture
ROOM = 1.25    # of a box about the things in it
SMALL = 0.22   # of a box: a motion that fills less gets a box of its own, a limit that does is not drawn
# of the longest side: an axis along which less happens has a scale of its own, of which that fills a share
FLAT, FILLED, EVEN = 0.3, 0.6, 1e-6
WHOLE = 1.6    # times the box of the motion: a surface no larger is shown whole
GROWN = 3.0   # times its first size, up to which a motion that spins up is drawn
FARTHEST = 1e4  # times the fold's radius: how far a branch is followed for a large box
ARROWS, ARROW = (0.12, 0.45, 0.8), 0.11  # where: shares of the path; how long: of half of the box
SHAPE = (48, 97)  # rows and columns of a branch
# places on a piece of a curve of equilibria: to find what is in the box, and to draw it
PLACES = (40, 90)
# of half of the box: no two places that are drawn are farther apart than this, as far as halvings go
CHORD, HALVINGS = 0.02, 16
VIEWS = tuple((up, round_) for up in (22, 33) for round_ in (-55, -35, 35, 55))  # deg: elevation, azimuth
BETTER = 1.25  # times as broad as from the first side: from there the path is seen
RIM = 0.88  # of half of the box: up to here numbers stand at its edges, the corners are crowded
ALIKE = 5e3  # steps from zero: ticks so far from it differ in their last digits
CROWDED = 0.12  # halves of the box: times nearer than that would lie on each other
ARC = 24  # steps of a sixth of the limit's sphere each way
HALF, BEYOND_SIZE = 4095, 8.0  # half of the box in numbers of a page; what is farther off is moved in

Point = Sequence[float]
Known = dict[tuple[int, float], Point | None]  # places of curves by their number and the parameter


@dataclass(frozen=True)
class Box:
    """A box of rates: its middle and half of its edges."""

    middle: tuple[float, ...]
    half: tuple[float, ...]

    @property
    def low(self) -> tuple[float, ...]:
        """Its lower corner."""
        return tuple(m - h for m, h in zip(self.middle, self.half))

    @property
    def high(self) -> tuple[float, ...]:
        """Its upper corner."""
        return tuple(m + h for m, h in zip(self.middle, self.half))

    @property
    def farthest(self) -> float:
        """Of all its places, the largest component."""
        return max(abs(m) + h for m, h in zip(self.middle, self.half))

    def share(self, at: Point) -> list[float]:
        """A place in halves of the edges from the middle."""
        return [(float(v) - m) / h for v, m, h in zip(at, self.middle, self.half)]

    def holds(self, at: Point, room: float = 1.0) -> bool:
        """Whether a place is inside a box so many times as large."""
        return all(abs(v) <= room for v in self.share(at))

    def scaled(self, per: float) -> Box:
        """The same in another unit."""
        return Box(tuple(per * v for v in self.middle), tuple(per * v for v in self.half))

    def ticks(self, axis: int, least: int = 3) -> list[float]:
        """Round numbers to stand along an edge of it: the largest step of which so many fit."""
        middle, half = self.middle[axis], self.half[axis]
        ten = 10.0 ** math.floor(math.log10(half))
        for step in (many * ten for many in (10, 5, 2, 1, 0.5, 0.2, 0.1)):
            first, last = math.ceil((middle - RIM * half) / step), math.floor((middle + RIM * half) / step)
            if last - first + 1 >= least:
                break
        return [n * step for n in range(first, last + 1)]


def shifted(ticks: list[float], name: str) -> tuple[list[float], str]:
    """(what stands at ticks, the name of their axis): differences from a round number, which the name says,
    where the ticks themselves would differ in their last digits alone."""
    apart = min((b - a for a, b in zip(ticks, ticks[1:])), default=0.0)
    if not apart or max(map(abs, ticks)) < ALIKE * apart:
        return ticks, name
    ten = 10.0 ** math.ceil(math.log10(ticks[-1] - ticks[0]))
    base = round((ticks[0] + ticks[-1]) / 2 / ten) * ten
    before, bracket, unit = name.partition(" (")
    sign = "\u2212" if base > 0 else "+"
    return ([round((v - base) / apart) * apart for v in ticks],
            f"{before} {sign} {abs(base):.12g}{bracket}{unit}")


def numbers(ticks: list[float]) -> list[str]:
    """What stands at ticks: six digits, more where these would round them."""
    apart = min((b - a for a, b in zip(ticks, ticks[1:])), default=0.0)
    digits = next(n for n in range(6, 18) if all(abs(float(f"{v:.{n}g}") - v) <= apart / 100 for v in ticks)
                  or n == 17)
    return [f"{v:.{digits}g}".replace("-", "\u2212") for v in ticks]


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


MOTION, NEAREST, LIMIT = "this motion", "nearest point of the separatrix", "limit of |ω|"
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


def box_of(path: list[Point], marks: Iterable[tuple[str, Point]], branches: Iterable[PlainBranch] = (),
           largest: float = WHOLE, reaching: bool = False, asked: Any = None, kept: bool = False) -> Box:
    """A box about a motion and the marks near it, and about the branches where that is no more than so many
    times as large. reaching: to the nearest point of the separatrix, however far it is. asked: that of the
    picture before (middle and half of the edges), which stays while the motion is inside and, unless it is
    kept, fills a part of it."""
    start = [at for text, at in marks if text == "start"]
    shown = [*path, *start] or [at for _, at in marks]
    around = [(min(v), max(v)) for s in branches for v in zip(*s.points)]
    surface: list[Point] = [v for n in range(0, len(around), 3) for v in zip(*around[n:n + 3])]
    if not shown:
        return _about(surface or [(1.0,) * 3, (-1.0,) * 3])
    if asked is not None:
        box, own = _given(asked), _about(shown)
        if all(box.holds(p) for p in shown) and (
                kept or any(a > SMALL * b for a, b in zip(own.half, box.half))):
            return box
    own = _cube(shown)
    nearby = [at for text, at in marks if reaching and text == NEAREST or own.holds(at, SHOWN_SIZE)]
    box, full = _about([*shown, *nearby]), _about([*shown, *nearby, *surface])
    return full if max(full.half) <= largest * max(box.half) else box


def _cube(points: list[Point]) -> Box:
    """The cube about points."""
    sides = [(min(v), max(v)) for v in zip(*points)]
    half = max(b - a for a, b in sides) / 2 or 0.06 * max(abs(v) for pair in sides for v in pair) or 1.0
    return Box(tuple((a + b) / 2 for a, b in sides), (half,) * 3)


def _about(points: list[Point]) -> Box:
    """A box with some room: a cube, but along an axis on which little happens."""
    cube = _cube(points)
    halves = [(max(v) - min(v)) / 2 for v in zip(*points)]
    longest = cube.half[0]
    return Box(cube.middle, tuple(
        ROOM * (own / FILLED if EVEN * longest < own < FLAT * longest else longest) for own in halves))


def _given(request: Any) -> Box:
    """The box of a request."""
    try:
        numbers = [float(v) for v in (*request["middle"], *request["half"])]
    except (KeyError, OverflowError, TypeError, ValueError):
        numbers = []
    if len(numbers) != 6 or not all(map(math.isfinite, numbers)) or not min(numbers[3:]) > 0:
        raise InputError(f"box: expected a middle and half of the edges, three numbers each, got "
                         f"{request!r:.80}")
    return Box(tuple(numbers[:3]), tuple(numbers[3:]))


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
    own = _cube(path)
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


# --- The separatrix and the curves of equilibria, as far as the box reaches
def branches_of(scene: AnyScene, box: Box | None = None, shape: tuple[int, int] = SHAPE,
              plain: tuple[int, int] | None = None,
              reach: float = REACH) -> tuple[Sequence[PlainBranch], str, float]:
    """(branches of the separatrix as far as a box reaches, or as `reach` says; what they part, or why there
    are none; the reach that was enough). plain: the shape of coarse ones in plain floats, None for graded
    ones of `shape` by NumPy."""
    try:
        result, text = _surface(scene, reach, shape, plain)
        far = max((abs(v) for branch in result for p in branch.points for v in p), default=0.0)
        if box is not None and far and not box.farthest <= far <= 8 * box.farthest:
            wanted = min(reach * 1.3 * box.farthest / far, FARTHEST)
            if wanted > 1.01:
                reach = wanted
                result, text = _surface(scene, reach, shape, plain)
    except StabilabError as error:
        result, text = (), str(error)
    return result, text if result else f"no separatrix is drawn: {text}", reach


def _surface(scene, reach, shape, plain) -> tuple[Sequence[PlainBranch], str]:
    if plain is not None or not present("numpy"):
        branches, reason = plain_separatrix(scene, reach, *(plain or (40, 33)))
        return branches, reason.text()
    from ..orbit.separatrix.branches import separatrix
    result = separatrix(scene, reach=reach, shape=shape)
    return [PlainBranch(branch.name, *branch.points.shape[:2], branch.points.reshape(-1, 3).tolist())
            for branch in result.branches], result.because


def curves_of(result: Equilibria | None, box: Box, coarse: int = PLACES[0], fine: int = PLACES[1],
              known: Known | None = None) -> list[tuple[str, list[Point]]]:
    """(words, places) of the pieces of the curves of equilibria that come into the box, looked for at
    `coarse` places of each piece and drawn through `fine`, and more where it runs fast, as beside an
    asymptote, where it would end before the box does. known: the places of these curves that were formed
    before, to which new ones are added: a box that grows keeps most of them."""
    out: list[tuple[str, list[Point]]] = []
    known = {} if known is None else known
    unit = 10.0 ** round(math.log10(box.farthest))  # that a box that grows has again
    for n, curve in enumerate(result.curves if result is not None else ()):
        def place(t: float, n: int = n, curve: EquilibriumCurve = curve) -> Point | None:
            if (n, t) not in known:
                known[n, t] = _place(curve, t)
            return known[n, t]
        for segment in curve.segments:
            for low, high in _inside(place, spread(*segment.t, coarse, unit), box):
                out.append((style.EQUILIBRIA[style.kind_of(segment)], _drawn(place, low, high, fine, box)))
    return [(text, places) for text, places in out if any(map(box.holds, places))]


def _place(curve: EquilibriumCurve, t: float) -> Point | None:
    """The rates at a place of a curve (a field adds the vertical behind them); None at an end that belongs to
    it no more."""
    try:
        return curve.point(t)[:3]
    except InputError:
        return None


def _drawn(place: Callable[[float], Point | None], low: float, high: float, fine: int,
           box: Box) -> list[Point]:
    """Places of a curve for evenly spaced parameters, and between two of which one is in the box as many more
    as part them by no more than CHORD."""
    ts = [low + (high - low) * n / fine for n in range(fine + 1)]
    out: list[Point] = []
    last: tuple[float, Point] | None = None
    for t in ts:
        at = place(t)
        if at is None:
            continue
        if last is not None:
            out += _between(place, last, (t, at), box, HALVINGS)
        out.append(at)
        last = t, at
    return out


def _between(place: Callable[[float], Point | None], first: tuple[float, Point], last: tuple[float, Point],
             box: Box, halvings: int) -> list[Point]:
    """The places between two of a curve."""
    apart = max(abs(a - b) / half for a, b, half in zip(first[1], last[1], box.half))
    if not halvings or apart <= CHORD or not (box.holds(first[1]) or box.holds(last[1])):
        return []
    t = (first[0] + last[0]) / 2
    if (at := place(t)) is None:
        return []
    return [*_between(place, first, (t, at), box, halvings - 1), at,
            *_between(place, (t, at), last, box, halvings - 1)]


def _inside(place: Callable[[float], Point | None], ts: list[float], box: Box) -> list[tuple[float, float]]:
    """The runs of parameters whose places are in or near the box, each one step longer."""
    nearby = [at is not None and box.holds(at, 1.05) for at in map(place, ts)]
    nearby = [nearby[n] or any(nearby[max(0, n - 1):n + 2]) for n in range(len(ts))]
    runs, first = [], None
    for n, inside in enumerate([*nearby, False]):
        if inside and first is None:
            first = n
        if not inside and first is not None:
            if n - 1 > first:
                runs.append((ts[first], ts[n - 1]))
            first = None
    return runs


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
