"""A box of rates, the numbers at its edges, and the box about what is shown."""
from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from ...errors import InputError
from ...orbit.separatrix.saddles import PlainBranch

SHOWN_SIZE = 2.0     # times the motion's own size: a separatrix or an equilibrium so near is in the picture
ROOM = 1.25    # of a box about the things in it
SMALL = 0.22   # of a box: a motion that fills less gets a box of its own, a limit that does is not drawn
# of the longest side: an axis along which less happens has a scale of its own, of which that fills a share
FLAT, FILLED, EVEN = 0.3, 0.6, 1e-6
WHOLE = 1.6    # times the box of the motion: a surface no larger is shown whole
RIM = 0.88  # of half of the box: up to here numbers stand at its edges, the corners are crowded
ALIKE = 5e3  # steps from zero: ticks so far from it differ in their last digits
Point = Sequence[float]


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


MOTION, NEAREST, LIMIT = "this motion", "nearest point of the separatrix", "limit of |ω|"


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
    own = cube_about(shown)
    nearby = [at for text, at in marks if reaching and text == NEAREST or own.holds(at, SHOWN_SIZE)]
    box, full = _about([*shown, *nearby]), _about([*shown, *nearby, *surface])
    return full if max(full.half) <= largest * max(box.half) else box


def cube_about(points: list[Point]) -> Box:
    """The cube about points."""
    sides = [(min(v), max(v)) for v in zip(*points)]
    half = max(b - a for a, b in sides) / 2 or 0.06 * max(abs(v) for pair in sides for v in pair) or 1.0
    return Box(tuple((a + b) / 2 for a, b in sides), (half,) * 3)


def _about(points: list[Point]) -> Box:
    """A box with some room: a cube, but along an axis on which little happens."""
    cube = cube_about(points)
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
