"""The separatrix and the curves of equilibria, as far as a box reaches."""
from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from ...equilibrium.result import Equilibria, EquilibriumCurve
from ...errors import InputError, StabilabError
from ...orbit.separatrix.saddles import REACH, PlainBranch, plain_separatrix
from ...packages import present
from ...physics.scene import AnyScene
from .. import style
from .box import Box, Point


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


FARTHEST = 1e4  # times the fold's radius: how far a branch is followed for a large box
SHAPE = (48, 97)  # rows and columns of a branch
# places on a piece of a curve of equilibria: to find what is in the box, and to draw it
PLACES = (40, 90)
# of half of the box: no two places that are drawn are farther apart than this, as far as halvings go
CHORD, HALVINGS = 0.02, 16
Known = dict[tuple[int, float], Point | None]  # places of curves by their number and the parameter


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
    from ...orbit.separatrix.branches import separatrix
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
