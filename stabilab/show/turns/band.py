"""A motion that turns more often than lines can show, as what pictures draw of it: a translucent band from
the least to the greatest that its turns reach, and a few turns as lines.

The band is a surface over (time, direction): in each stretch of time, at each of some directions about the
middle of the turns, the least and the greatest distance at which the motion passes. Where its turns drift
farther from one stretch to the next than they are apart within one, least and greatest are one skin, through
the turn at the beginning of each stretch. Places are those of a space of rates, distances in parts of what
the motion fills along each axis. All of it does without NumPy, as a browser does."""
from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

BAND = "least to greatest"  # its words in a legend
MANY = 30  # turns: a motion with more of them is drawn as a band
COLUMNS = 48  # directions of a band
ROUND_AREA = 0.02  # of the square of its extent: a line that encloses less does not go round
SAME_WAY = 0.5  # cosine: from one stretch to the next turns stand about one axis, else they have turned over
APART = 0.06  # of half of what the motion fills: turns that are nearer are one skin
SWAYS, SMALL = 0.3, 0.2  # of the turns, of the swing of another rate: one with less does not go round
# stretches of time, at most and at least; turns in each that are looked at, at least
ROWS, FEWEST, APIECE = 48, 10, 3
SPARE = 1.6  # turns, from which one is cut that is drawn as a line
FEW = 12  # places that a turn needs
STEADY = 0.5  # of all stretches go round: those of a motion that tumbles do not, and it is drawn by lines

Point = Sequence[float]


@dataclass(frozen=True)
class Grid:
    """A surface of rows and columns of places (rows * columns, row by row), as a branch of a separatrix."""

    name: str
    rows: int
    columns: int
    points: list[Point]


@dataclass(frozen=True)
class Long:
    """A motion of many turns. skins: of the band, empty where its turns do not go round steadily; bold: the
    turns that are drawn as lines, each with what is written beside it, the first of them from the start; and
    with nothing beside it what does not go round and is in no band; number: of
    all turns; sampled: how many of them the band is made of."""

    skins: tuple[Grid, ...]
    bold: tuple[tuple[list[Point], str], ...]
    number: int
    sampled: int


def turning(values: Sequence[float]) -> int:
    """How often a curve turns."""
    count, before = 0, 0
    for a, b in pairwise(values):
        step = (b > a) - (b < a)
        if step:
            count += step == -before
            before = step
    return count


def often(path: Sequence[Point]) -> int:
    """How many turns a motion makes, two turning points a turn: those of the slowest rate that goes round."""
    rates = list(zip(*path))
    counts = [(turning(rate) + 1) // 2 for rate in rates]
    swings = [max(rate) - min(rate) if count >= SWAYS * max(counts) else 0.0
              for rate, count in zip(rates, counts)]
    steady = [count for count, swing in zip(counts, swings) if swing and swing >= SMALL * max(swings)]
    return min(steady, default=0)


@dataclass(frozen=True)
class _Frame:
    """The middle of some turns, the axis about which they go, and two directions across it."""

    middle: Point
    axis: Point
    across: Point
    upward: Point


def _cross(a: Point, b: Point) -> tuple[float, float, float]:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def _dot(a: Point, b: Point) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _unit(a: Point) -> tuple[float, ...]:
    size = math.hypot(*a)
    return tuple(v / size for v in a)


def _frame(points: Sequence[Point], before: _Frame | None) -> _Frame | None:
    """That of a line which goes round, by the area that it encloses; None of one that does not. before: that
    of the stretch before, whose directions it keeps as far as it can."""
    middle = tuple((min(v) + max(v)) / 2 for v in zip(*points))
    off = [tuple(a - b for a, b in zip(at, middle)) for at in points]
    extent = max(math.hypot(*at) for at in off)
    area = [sum(v) / 2 for v in zip(*(_cross(a, b) for a, b in pairwise(off)))]
    if not math.hypot(*area) > ROUND_AREA * extent**2:
        return None
    axis = _unit(area)
    if before is None or abs(_dot(axis, before.axis)) < SAME_WAY:
        least = min(range(3), key=lambda n: abs(axis[n]))
        rough: Point = tuple(float(n == least) for n in range(3))
    else:
        rough = before.across
        if _dot(axis, before.axis) < 0:  # it goes the other way round about the same axis
            axis = tuple(-v for v in axis)
    along = _dot(rough, axis)
    across = _unit([a - along * b for a, b in zip(rough, axis)])
    return _Frame(middle, axis, across, _cross(axis, across))


def _round(points: Sequence[Point], frame: _Frame) -> list[tuple[float, float, float]]:
    """(angle, distance, height) of each place about the axis of a frame; angles go on beyond a turn."""
    out: list[tuple[float, float, float]] = []
    for at in points:
        off = [a - b for a, b in zip(at, frame.middle)]
        x, y = _dot(off, frame.across), _dot(off, frame.upward)
        angle = math.atan2(y, x)
        if out:
            angle = out[-1][0] + math.remainder(angle - out[-1][0], math.tau)
        out.append((angle, math.hypot(x, y), _dot(off, frame.axis)))
    return out


def _passages(rounds: list[tuple[float, float, float]]) -> list[list[tuple[float, float]]] | None:
    """[(distance, height), ...] at each of the directions, in the order of time; None where one has none."""
    step = math.tau / COLUMNS
    out: list[list[tuple[float, float]]] = [[] for _ in range(COLUMNS)]
    for (a, r, h), (b, s, k) in pairwise(rounds):
        low, high = sorted((a, b))
        columns = range(math.ceil(low / step), math.floor(high / step) + 1)
        for column in columns if b >= a else reversed(columns):
            part = (column * step - a) / (b - a) if b != a else 0.0
            # chords: the distance of a straight piece, which is shorter between two places
            out[column % COLUMNS].append((r + part * (s - r), h + part * (k - h)))
    return out if all(out) else None


@dataclass(frozen=True)
class _Row:
    """Of a stretch of time: its first turn, and the least and greatest that its turns reach, at each of the
    directions."""

    frame: _Frame
    first: list[Point]
    low: list[Point]
    high: list[Point]
    last: list[Point]


def _row(points: Sequence[Point], before: _Frame | None) -> _Row | None:
    frame = _frame(points, before)
    passages = None if frame is None else _passages(_round(points, frame))
    if frame is None or passages is None:
        return None
    broad = sum(max(r for r, _ in column) - min(r for r, _ in column) for column in passages)
    tall = sum(max(h for _, h in column) - min(h for _, h in column) for column in passages)

    def ring(choose) -> list[Point]:
        return [_place(frame, n, *choose(column)) for n, column in enumerate(passages)]

    def mean(values) -> float:
        listed = list(values)
        return sum(listed) / len(listed)
    if broad >= tall:
        low = ring(lambda column: (min(r for r, _ in column), mean(h for _, h in column)))
        high = ring(lambda column: (max(r for r, _ in column), mean(h for _, h in column)))
    else:
        low = ring(lambda column: (mean(r for r, _ in column), min(h for _, h in column)))
        high = ring(lambda column: (mean(r for r, _ in column), max(h for _, h in column)))
    return _Row(frame, ring(lambda column: column[0]), low, high, ring(lambda column: column[-1]))


def _place(frame: _Frame, column: int, distance: float, height: float) -> Point:
    c, s = (distance * f(math.tau * column / COLUMNS) for f in (math.cos, math.sin))
    return tuple(m + c * u + s * v + height * w for m, u, v, w
                 in zip(frame.middle, frame.across, frame.upward, frame.axis))


def _apart(a: list[Point], b: list[Point]) -> float:
    return sum(math.dist(*pair) for pair in zip(a, b)) / COLUMNS


def skins(stretches: Sequence[Sequence[Point]], name: str) -> tuple[Grid, ...]:
    """The band of a motion: of each stretch of time the places (n, 3) along it, some turns of them, in order.
    Empty where its turns do not go round steadily."""
    return band_of(stretches, name)[0]


def band_of(stretches: Sequence[Sequence[Point]], name: str) -> tuple[tuple[Grid, ...], list[bool]]:
    """The same, and of each stretch whether its turns go round, so that it is in the band: of the others the
    line of the motion itself is to be drawn."""
    size = [max(v) - min(v) for v in zip(*(at for points in stretches for at in points))]
    scale = [v / 2 if v > 1e-9 * max(size) else max(size) / 2 for v in size]
    rows: list[_Row | None] = []
    before: _Frame | None = None
    for points in stretches:
        row = _row([tuple(a / b for a, b in zip(at, scale)) for at in points], before)
        before = before if row is None else row.frame
        rows.append(row)
    goes = [row is not None for row in rows]
    if sum(goes) < STEADY * len(rows):
        return (), goes
    grids = [grid for strip in _strips(rows) for grid in _skins_of(strip)]
    return tuple(Grid(name, len(grid), COLUMNS + 1,
                      [tuple(a * b for a, b in zip(at, scale)) for ring in grid for at in (*ring, ring[0])])
                 for grid in grids), goes


def _strips(rows: Sequence[_Row | None]) -> Iterator[list[_Row]]:
    """The rows in groups that go round about one axis, each after the other."""
    strip: list[_Row] = []
    for row in (*rows, None):
        if strip and (row is None or abs(_dot(row.frame.axis, strip[-1].frame.axis)) < SAME_WAY):
            yield strip
            strip = []
        if row is not None:
            strip.append(row)


def _skins_of(strip: list[_Row]) -> list[list[list[Point]]]:
    """Grids of rings: one skin of turns that drift, else the inner and the outer one, joined at both ends."""
    thick = sum(_apart(row.low, row.high) for row in strip) / len(strip)
    drift = sum(_apart(a.first, b.first) for a, b in pairwise(strip)) / max(1, len(strip) - 1)
    if thick < max(APART, 2 * drift):
        return [[*(row.first for row in strip), strip[-1].last]]
    return [[strip[0].high, *(row.low for row in strip), strip[-1].high, *(row.high for row in strip[::-1])]]


def one_turn(points: Sequence[Point], backwards: bool = False) -> list[Point]:
    """The first turn of a line, or the last, as far as it goes round; all of it where it does not."""
    line = list(points)[::-1] if backwards else list(points)
    size = [(max(v) - min(v)) / 2 for v in zip(*line)]
    scale = [v if v > 1e-9 * max(size) else max(size) or 1.0 for v in size]
    scaled = [tuple(a / b for a, b in zip(at, scale)) for at in line]
    frame = _frame(scaled, None)
    if frame is not None:
        rounds = _round(scaled, frame)
        end = next((n for n, (angle, *_) in enumerate(rounds) if abs(angle - rounds[0][0]) >= math.tau),
                   len(line) - 1)
        line = line[:end + 1]
    return line[::-1] if backwards else line


def along(times: Sequence[float], path: Sequence[Point], clock: tuple[str, float],
          matters: tuple[float, str] | None) -> Long | None:
    """What is drawn of a motion by its places (n, 3) at times (n,); None of one of few turns, and of places
    too few to show each. clock: the unit of times; matters: the moment of which a turn is drawn, and what
    happens then."""
    number = often(path) if len(path) > FEW * MANY else 0
    if not number > MANY or len(path) < FEW * number:
        return None
    turn, last = len(path) / number, len(path) - 1
    count = rows_of(number)
    edges = [round(n * last / count) for n in range(count + 1)]
    band, goes = band_of([path[a:max(b, round(a + APIECE * turn)) + 1] for a, b in zip(edges, edges[1:])],
                         name_of(number, number))
    bold, length = [], (times[-1] - times[0]) / number
    for low, high, backwards, text in bold_turns(times[0], times[-1], lambda at: length, clock, matters):
        part = path[bisect_left(times, low):bisect_left(times, high) + 1]
        bold += [(one_turn(part, backwards), text)] if len(part) > 2 else []
    bold += [(list(path[edges[a]:edges[b] + 1]), "") for a, b in outside(goes)]
    return Long(band, tuple(bold), number, number) if band else None


def outside(goes: Sequence[bool]) -> list[tuple[int, int]]:
    """(from, to) of each run of stretches that do not go round, the end not included."""
    edges = [n for n, (a, b) in enumerate(pairwise((True, *goes, True))) if a != b]
    return list(zip(edges[::2], edges[1::2]))


def rows_of(number: int) -> int:
    """Into how many stretches of time so many turns are parted."""
    return min(ROWS, max(FEWEST, number // APIECE))


def name_of(number: int, sampled: int) -> str:
    """What a legend has of the band of so many turns."""
    return f"{BAND}, samples of {f'{sampled} of {number}' if sampled < number else number} turns"


def bold_turns(low: float, high: float, turn: Callable[[float], float], clock: tuple[str, float],
               matters: tuple[float, str] | None) -> list[tuple[float, float, bool, str]]:
    """(from, to, whether the last turn of these is meant, words) of the turns that are drawn as lines: at the
    start, at the moment that matters (the middle of the time where there is none), and at the end. turn: how
    long one is at a time."""
    unit, per = clock
    at, name = matters if matters is not None and low < matters[0] < high else ((low + high) / 2, "")
    result = []
    for time, text, before in ((low, "start", 0.0), (at, name, 0.5), (high, "", 1.0)):
        width = min(SPARE * turn(time), high - low)
        first = min(max(time - before * width, low), high - width)
        shown = f"{time * per:.4g} {unit}".replace("$\\tau$", "τ").strip()
        result.append((first, first + width, before == 1.0, f"{text}, {shown}" if text else shown))
    return result
